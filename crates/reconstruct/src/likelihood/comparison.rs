//! Collects what one motion says of the evidence; each item adds its own terms
//! ([`evidence`](crate::evidence)).

use crate::evidence::Measured;
use crate::likelihood::discrepancy::{Discrepancy, PathResidual, student};
use crate::likelihood::track::Track;
use crate::{CollisionMotion, Latent};
use impactlab_core::vehicle::{Manoeuvre, VehicleParameters};

/// Degrees of freedom of the Student distributions of single numbers.
pub(crate) const SINGLE_DEGREES_OF_FREEDOM: f64 = 4.0;

/// One item of the evidence against one motion.
#[derive(Debug, Clone, PartialEq)]
pub struct EvidenceTerm {
    /// Name for a person.
    pub name: String,
    /// Symbol of the unit of both numbers; empty for a pure number.
    pub unit: &'static str,
    /// What the motion would leave.
    pub expected: f64,
    /// What was found.
    pub found: f64,
    /// Squared distance between both in units of what measurement and model err by.
    pub distance: f64,
}

/// One of the cars of a motion, with its path.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ComparedCar<'a> {
    /// The car as it was simulated.
    pub vehicle: &'a VehicleParameters,
    /// What was done to it.
    pub manoeuvre: &'a Manoeuvre,
    /// Its path.
    pub track: &'a Track,
    /// Its speed before the impact, m/s.
    pub speed_before_m_s: f64,
    /// What stands before the names of its terms.
    pub prefix: &'static str,
}

/// What a motion says of the evidence of one car so far.
pub(crate) struct Comparison<'a> {
    /// What the forward model errs by.
    pub discrepancy: &'a Discrepancy,
    /// The motion.
    pub motion: &'a CollisionMotion,
    /// The car that the evidence is about.
    pub car: ComparedCar<'a>,
    /// Logarithm of the likelihood, without that of the residuals of the path.
    pub log_likelihood: f64,
    /// Residuals of the path, whose errors go together.
    pub path: Vec<PathResidual>,
    /// The items, if they are wanted.
    pub terms: Vec<EvidenceTerm>,
    wants_terms: bool,
}

impl<'a> Comparison<'a> {
    /// - `wants_terms`: whether the terms are wanted, and not the likelihood alone.
    pub fn new(
        discrepancy: &'a Discrepancy,
        motion: &'a CollisionMotion,
        car: ComparedCar<'a>,
        wants_terms: bool,
    ) -> Self {
        let (path, terms) = (Vec::new(), Vec::new());
        Self { discrepancy, motion, car, log_likelihood: 0.0, path, terms, wants_terms }
    }

    /// Adds what the same motion says of the evidence of the other car.
    pub fn add(&mut self, other: Comparison<'_>) {
        let (log_likelihood, terms) = other.into_terms();
        self.log_likelihood += log_likelihood;
        self.terms.extend(terms);
    }

    /// Logarithm of the likelihood, and the terms.
    pub fn into_terms(self) -> (f64, Vec<EvidenceTerm>) {
        (self.log_likelihood, self.terms)
    }

    /// A quantity of the particle.
    pub fn value(&self, latent: Latent) -> f64 {
        self.motion.values.get(latent)
    }

    /// Standard deviation of the place where a wheel begins or ceases to slide, at a point of the path, m.
    pub fn onset_sigma_m(&self, idx: usize) -> f64 {
        self.discrepancy.onset_sigma_m(self.car.track.travelled_m[idx])
    }

    /// Adds a term that is told.
    ///
    /// - `distance`: squared, in units of what measurement and model err by.
    pub fn tell(
        &mut self,
        name: &str,
        unit: &'static str,
        [expected, found]: [f64; 2],
        distance: f64,
    ) {
        if self.wants_terms {
            let name = format!("{}{name}", self.car.prefix);
            self.terms.push(EvidenceTerm { name, unit, expected, found, distance });
        }
    }

    /// What was measured by itself: it is a part of the prior, and told beside the rest.
    pub fn tell_measured(
        &mut self,
        name: &str,
        unit: &'static str,
        found: Option<Measured>,
        expected: f64,
    ) {
        let Some(Measured { value, sigma }) = found else { return };
        self.tell(name, unit, [expected, value], ((value - expected) / sigma).powi(2));
    }

    /// Adds one coordinate of the path to the block whose errors go together.
    pub fn add_residual(&mut self, name: &str, at: PathResidual, numbers: [f64; 2]) {
        let distance = at.residual * at.residual / self.discrepancy.variance(&at);
        let unit = if at.direction == [0.0; 2] { "rad" } else { "m" };
        self.tell(name, unit, numbers, distance);
        self.path.push(at);
    }

    /// Adds the likelihood of that block.
    pub fn add_path(&mut self) {
        self.log_likelihood += self.discrepancy.log_density(&self.path, self.car.track.whole_m());
    }

    /// A number by itself.
    ///
    /// - `weight`: 1, or less where other numbers err with it.
    pub fn add_single(
        &mut self,
        name: &str,
        unit: &'static str,
        [expected, found]: [f64; 2],
        sigma: f64,
        weight: f64,
    ) {
        let distance = ((found - expected) / sigma).powi(2);
        let density = student(distance, 1.0, SINGLE_DEGREES_OF_FREEDOM) - sigma.ln();
        self.log_likelihood += weight * density;
        self.tell(name, unit, [expected, found], distance);
    }
}
