//! Collects what one motion says of the evidence; each item adds its own terms
//! ([`evidence`](crate::evidence)).

use std::ops::Range;

use schemars::JsonSchema;
use serde::Serialize;

use crate::evidence::Measured;
use crate::likelihood::discrepancy::{Discrepancy, PathResidual, student};
use crate::likelihood::track::Track;
use crate::{CollisionMotion, Latent};
use impactlab_core::vehicle::{Manoeuvre, VehicleParameters};

/// Degrees of freedom of the Student distributions of single numbers.
pub(crate) const SINGLE_DEGREES_OF_FREEDOM: f64 = 4.0;

/// By what an item of the evidence is compared with a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ComparedBy {
    /// A number that was found, whatever the motion is.
    Number,
    /// The place on the path that is nearest to where something was found: it is computed with each motion.
    PlaceOnPath,
    /// The distance from the path to what was found: it is computed with each motion, and has no sides.
    DistanceToPath,
}

impl ComparedBy {
    /// Whether it can lie to either side of what is expected.
    pub fn has_sides(self) -> bool {
        self != Self::DistanceToPath
    }

    /// Whether it was found itself, and not computed with a motion.
    pub fn is_found(self) -> bool {
        self == Self::Number
    }
}

/// One item of the evidence against one motion.
#[derive(Debug, Clone, PartialEq)]
pub struct EvidenceTerm {
    /// Name for a person.
    pub name: String,
    /// Symbol of the unit of both numbers; empty for a pure number.
    pub unit: &'static str,
    /// What the motion would leave.
    pub expected: f64,
    /// What was found, or what follows from it with the motion.
    pub found: f64,
    /// Squared distance between both in units of what measurement and model err by.
    pub distance: f64,
    /// What `found` is.
    pub compared_by: ComparedBy,
}

/// A part of the evidence that can be left out.
#[derive(Debug, Clone, PartialEq)]
pub struct EvidencePart {
    /// Name for a person.
    pub name: String,
    /// Its terms among all.
    pub terms: Range<usize>,
    /// Logarithm of the likelihood without it.
    pub log_without: f64,
}

/// What a motion says of the evidence.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Logarithm of the likelihood.
    pub log_likelihood: f64,
    /// The parts of the evidence that can be left out.
    pub parts: Vec<EvidencePart>,
    /// The items, if they were wanted.
    pub terms: Vec<EvidenceTerm>,
}

impl Compared {
    /// Of a motion that cannot be.
    pub fn impossible() -> Self {
        Self { log_likelihood: f64::NEG_INFINITY, parts: Vec::new(), terms: Vec::new() }
    }
}

/// A part of the evidence while it is compared.
struct OpenPart {
    name: String,
    terms: Range<usize>,
    /// Its residuals among those of the path.
    path: Range<usize>,
    /// What it adds to the logarithm of the likelihood.
    adds: f64,
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
    parts: Vec<OpenPart>,
}

impl<'a> Comparison<'a> {
    /// - `wants_terms`: whether the terms are wanted, and not the likelihood alone.
    pub fn new(
        discrepancy: &'a Discrepancy,
        motion: &'a CollisionMotion,
        car: ComparedCar<'a>,
        wants_terms: bool,
    ) -> Self {
        let (path, terms, parts) = (Vec::new(), Vec::new(), Vec::new());
        Self { discrepancy, motion, car, log_likelihood: 0.0, path, terms, wants_terms, parts }
    }

    /// A part of the evidence that can be left out, with all that it adds.
    pub fn part(&mut self, name: &str, compare: impl FnOnce(&mut Self)) {
        let (before, path, terms) = (self.log_likelihood, self.path.len(), self.terms.len());
        compare(self);
        self.parts.push(OpenPart {
            name: format!("{}{name}", self.car.prefix),
            terms: terms..self.terms.len(),
            path: path..self.path.len(),
            adds: self.log_likelihood - before,
        });
    }

    /// Adds what the same motion says of the evidence of the other car.
    pub fn add(&mut self, other: Comparison<'_>) {
        let n_terms = self.terms.len();
        self.log_likelihood += other.log_likelihood;
        self.terms.extend(other.terms);
        self.parts.extend(other.parts.into_iter().map(|part| OpenPart {
            terms: part.terms.start + n_terms..part.terms.end + n_terms,
            ..part
        }));
    }

    /// What the motion says of all of it.
    pub fn finish(self) -> Compared {
        let Self { log_likelihood, terms, parts, .. } = self;
        let part = |OpenPart { name, terms, path: _, adds }| EvidencePart {
            name,
            terms,
            log_without: log_likelihood - adds,
        };
        Compared { log_likelihood, parts: parts.into_iter().map(part).collect(), terms }
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
            let compared_by = ComparedBy::Number;
            self.terms.push(EvidenceTerm { name, unit, expected, found, distance, compared_by });
        }
    }

    /// Says of the term that was told last what it is compared by.
    fn last_is(&mut self, compared_by: ComparedBy) {
        let told = self.terms.last_mut().filter(|_| self.wants_terms);
        told.into_iter().for_each(|term| term.compared_by = compared_by);
    }

    /// Adds a distance to the path that is told, which has no sides.
    ///
    /// - `distance`: squared, in units of what measurement and model err by.
    pub fn tell_distance(&mut self, name: &str, off_m: f64, distance: f64) {
        self.tell(name, "m", [0.0, off_m], distance);
        self.last_is(ComparedBy::DistanceToPath);
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
        let whole_m = self.car.track.whole_m();
        let density = |path: &[PathResidual]| self.discrepancy.log_density(path, whole_m);
        let all = density(&self.path);
        for part in self.parts.iter_mut().filter(|part| !part.path.is_empty()) {
            let others = [&self.path[..part.path.start], &self.path[part.path.end..]].concat();
            part.adds += all - density(&others);
        }
        self.log_likelihood += all;
    }

    /// A place on the path by itself.
    ///
    /// - `[expected_m, found_m]`: along the path;
    /// - `weight`: 1, or less where other places err with it.
    pub fn add_place(
        &mut self,
        name: &str,
        [expected_m, found_m]: [f64; 2],
        sigma_m: f64,
        weight: f64,
    ) {
        let distance = ((found_m - expected_m) / sigma_m).powi(2);
        let density = student(distance, 1.0, SINGLE_DEGREES_OF_FREEDOM) - sigma_m.ln();
        self.log_likelihood += weight * density;
        self.tell(name, "m", [expected_m, found_m], distance);
        self.last_is(ComparedBy::PlaceOnPath);
    }
}
