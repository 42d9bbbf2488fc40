//! Whether the posterior explains the evidence.

use schemars::JsonSchema;
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::likelihood::{ComparedBy, EvidenceTerm};
use impactlab_core::numerics::{median, wrap_angle_rad};

/// One item of the evidence against the whole posterior.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct EvidenceFit {
    /// The item.
    pub evidence: String,
    /// Symbol of the unit of both numbers.
    pub unit: &'static str,
    /// Median over the posterior of what would be found.
    pub expected: f64,
    /// What was found; where that depends on the motion, as the distance from the path to a mark, its median
    /// over the posterior.
    pub found: f64,
    /// What `found` is.
    pub compared_by: ComparedBy,
    /// Posterior predictive p: the probability that measurement and model err by more than they do here.
    pub p: f64,
}

impl EvidenceFit {
    /// Probability below which an item counts as unexplained. The mean over the particles is seldom small
    /// by chance, since the particles follow the evidence, so that the usual level of 5 % is a careful one.
    pub const UNEXPLAINED_BELOW: f64 = 0.05;

    /// The fit of each item.
    ///
    /// ```text
    /// p = mean over the particles of P(χ²₁ > D)
    /// ```
    ///
    /// Source: [`GelmanMengStern1996`](impactlab_core::bibliography::GelmanMengStern1996), realized
    /// discrepancies.
    ///
    /// - `particles`: the terms of each particle; those of motions that could not be computed are empty.
    pub fn from_particles(particles: &[Vec<EvidenceTerm>]) -> Vec<Self> {
        let of_motions: Vec<&Vec<EvidenceTerm>> =
            particles.iter().filter(|terms| !terms.is_empty()).collect();
        let Some(first) = of_motions.first() else { return Vec::new() };
        let items = first.iter().enumerate();
        items
            .map(|(idx, item)| {
                let all: Vec<&EvidenceTerm> =
                    of_motions.iter().filter_map(|terms| terms.get(idx)).collect();
                let tail = |term: &&EvidenceTerm| survival(term.distance);
                let middle = |value: &dyn Fn(&EvidenceTerm) -> f64| {
                    median(all.iter().copied().map(value)).unwrap_or(f64::NAN)
                };
                let p = all.iter().map(tail).sum::<f64>() / all.len() as f64;
                Self {
                    evidence: item.name.clone(),
                    unit: item.unit,
                    expected: middle(&|term| around(term.expected, item)),
                    found: middle(&|term| term.found),
                    compared_by: item.compared_by,
                    p: p.clamp(0.0, 1.0),
                }
            })
            .collect()
    }

    /// Whether nothing in the posterior explains the item.
    pub fn is_unexplained(&self) -> bool {
        self.p < Self::UNEXPLAINED_BELOW
    }
}

/// An angle within half a turn of what was found, so that medians of directions make sense.
fn around(value: f64, item: &EvidenceTerm) -> f64 {
    match item.unit {
        "rad" => item.found + wrap_angle_rad(value - item.found),
        _ => value,
    }
}

fn survival(distance: f64) -> f64 {
    ChiSquared::new(1.0).map_or(0.0, |chi| chi.sf(distance.min(1e6)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_far_off_for_every_particle_is_unexplained() {
        let term = |name: &str, distance| EvidenceTerm {
            name: name.into(),
            unit: "m",
            expected: 1.0,
            found: 2.0,
            distance,
            compared_by: ComparedBy::Number,
        };
        let particles = vec![vec![term("near", 0.5), term("far", 16.0)]; 3];
        let fit = EvidenceFit::from_particles(&particles);
        assert!((fit[0].p - 0.4795).abs() < 1e-3 && !fit[0].is_unexplained(), "{fit:?}");
        assert!(fit[1].p < 1e-4 && fit[1].is_unexplained(), "{fit:?}");
        assert!(EvidenceFit::from_particles(&[]).is_empty());
        // Of two motions the median lies between; the larger was told.
        let off = |expected| vec![EvidenceTerm { expected, ..term("rest", 0.5) }];
        let fit = EvidenceFit::from_particles(&[off(3.0), off(1.0)]);
        assert_eq!((fit[0].expected, fit[0].found), (2.0, 2.0));
    }
}
