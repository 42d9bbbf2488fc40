//! The answer without one part of the evidence, and whether that part goes with the others.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use schemars::JsonSchema;
use serde::Serialize;

use crate::likelihood::Compared;
use crate::posterior::LEAST_ESS_FOR_INTERVALS;
use crate::sampler::{
    LeftOutParticles, Particles, SamplerReport, SamplerSettings, Target, sample_from,
};
use crate::{EvidenceTerm, Posterior, QuantityEstimate, ReconstructionTarget};
use impactlab_core::numerics::{normal_cdf, unwrapped_rad};

/// Independent draws below which nothing is said.
const LEAST_ESS: f64 = 30.0;
/// Largest number of parts that are sampled anew, those with the fewest draws; particles and independent
/// draws of each, and its largest number of motions, of those of the answer.
const MOST_SAMPLED: usize = 2;
const SAMPLED_PARTICLES: usize = 200;
const SAMPLED_ESS: f64 = 100.0;
const SAMPLED_SHARE: f64 = 0.5;

/// The answer without one part of the evidence.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LeftOut {
    /// The part.
    pub evidence: String,
    /// Independent draws that the answer without it rests on.
    pub ess: f64,
    /// Motions that were computed for it alone.
    pub n_simulations: usize,
    /// Speed of the struck or single car without it; `None` with too few draws, and without intervals where they
    /// are too few for these.
    pub struck_speed: Option<QuantityEstimate>,
    /// Upper bound of the probability that the others expect the part as far off as it is, or farther, to either
    /// side: 1 bounds nothing. `None` with too few draws, and of a part that has no sides.
    pub p: Option<f64>,
    /// Whether the part contradicts the others.
    pub is_contradicted: bool,
}

impl LeftOut {
    /// Probability below which a part contradicts the others, over all parts.
    const CONTRADICTED_BELOW: f64 = 0.05;

    /// Each part left out; nothing where there is only one, and of particles that are not of the
    /// posterior.
    ///
    /// ```text
    /// u = mean over the particles without the part of Φ((found − expected)/σ)
    /// p = n · min over its n terms of 2 min(u, 1 − u)
    /// ```
    ///
    /// Its particles are the draws of the whole answer, weighted by the likelihood without the part. A
    /// part that keeps the draws away from where the others lie leaves few of them, so that the posterior
    /// without it is sampled anew, from a wide start.
    ///
    /// - `is_doubtful`: whether an item of the evidence is not explained; else an answer that has too few
    ///   draws itself is not looked into any further;
    /// - `report`: called while a part is sampled anew, with its name; if it breaks, nothing more is said
    ///   than the draws of the answer say.
    ///
    /// Source: [`GelfandDeyChang1992`](impactlab_core::bibliography::GelfandDeyChang1992), cross-validated
    /// predictive densities.
    pub fn each(
        target: &ReconstructionTarget,
        particles: &Particles,
        is_doubtful: bool,
        seed: u64,
        report: &mut dyn FnMut(&str, SamplerReport<'_>) -> ControlFlow<()>,
    ) -> Vec<Self> {
        let n_parts = particles.left_out.len();
        let Some(z) = particles.z.first().filter(|_| n_parts >= 2) else { return Vec::new() };
        let names: Vec<Vec<String>> = target.model().motions(std::slice::from_ref(z), |motion| {
            target.compared(&motion, false).parts.into_iter().map(|part| part.name).collect()
        });
        let names: Vec<String> = names.concat();
        let is_worth_it = is_doubtful || particles.ess >= LEAST_ESS_FOR_INTERVALS;
        let anew = match is_worth_it {
            true => sampled_anew(target, particles, seed, &names, report),
            false => BTreeMap::new(),
        };
        let part = |(idx, (left, name)): (usize, (&LeftOutParticles, &String))| {
            let (left, n_simulations) = match anew.get(&idx) {
                Some((left, n_simulations)) => (left, *n_simulations),
                None => (left, 0),
            };
            Self { n_simulations, ..Self::of(target, left, (idx, name), n_parts) }
        };
        particles.left_out.iter().zip(&names).enumerate().map(part).collect()
    }

    fn of(
        target: &ReconstructionTarget,
        left: &LeftOutParticles,
        (idx, name): (usize, &str),
        n_parts: usize,
    ) -> Self {
        let compared: Vec<Compared> =
            target.model().motions(&left.z, |motion| target.compared(&motion, true));
        let terms: Vec<&[EvidenceTerm]> = compared
            .iter()
            .filter_map(|of| of.terms.get(of.parts.get(idx)?.terms.clone()))
            .collect();
        let is_enough = left.ess >= LEAST_ESS;
        let p = if is_enough { tail_probability(&terms) } else { None };
        let levels = match left.ess.min(left.z.len() as f64) >= LEAST_ESS_FOR_INTERVALS {
            true => &[0.5, 0.9][..],
            false => &[],
        };
        let estimated = || {
            let posterior = Posterior::from_points(target.model(), &left.z);
            let speed = posterior.speed();
            QuantityEstimate::from_values(speed, posterior.values(speed), levels)
        };
        let struck_speed = is_enough.then(estimated).flatten();
        let least = Self::CONTRADICTED_BELOW / n_parts as f64;
        Self {
            evidence: name.to_owned(),
            ess: left.ess,
            n_simulations: 0,
            struck_speed,
            p,
            is_contradicted: p.is_some_and(|p| p < least),
        }
    }
}

/// The likelihood without one part of the evidence.
struct WithoutPart<'a> {
    target: &'a ReconstructionTarget,
    part: usize,
}

impl Target for WithoutPart<'_> {
    fn dim(&self) -> usize {
        self.target.dim()
    }

    fn log_likelihoods(&self, z: &[Vec<f64>]) -> Vec<f64> {
        self.target.model().motions(z, |motion| {
            let parts = self.target.compared(&motion, false).parts;
            parts.get(self.part).map_or(f64::NEG_INFINITY, |part| part.log_without)
        })
    }
}

/// Particles without the parts that leave too few of the draws of the answer, with the number of motions
/// of each.
fn sampled_anew(
    target: &ReconstructionTarget,
    particles: &Particles,
    seed: u64,
    names: &[String],
    report: &mut dyn FnMut(&str, SamplerReport<'_>) -> ControlFlow<()>,
) -> BTreeMap<usize, (LeftOutParticles, usize)> {
    let mut few: Vec<(usize, f64)> =
        particles.left_out.iter().map(|left| left.ess).enumerate().collect();
    few.retain(|(_, ess)| *ess < LEAST_ESS);
    few.sort_by(|(_, a), (_, b)| a.total_cmp(b));
    let n_evaluations = (SAMPLED_SHARE * particles.n_evaluations as f64) as usize;
    let settings = SamplerSettings {
        n_particles: SAMPLED_PARTICLES,
        seed,
        least_ess: SAMPLED_ESS,
        max_evaluations: n_evaluations.max(SAMPLED_PARTICLES),
    };
    let (mut anew, mut is_stopped) = (BTreeMap::new(), false);
    for (part, _) in few.into_iter().take(MOST_SAMPLED) {
        let name = names.get(part).map_or("", String::as_str);
        let mut watch = |at: SamplerReport<'_>| {
            let flow = report(name, at);
            is_stopped |= flow.is_break();
            flow
        };
        let without = WithoutPart { target, part };
        let sampled = sample_from(Some(&particles.start), &without, &settings, None, &mut watch);
        if is_stopped {
            break;
        }
        if let Ok(sampled) = sampled
            && sampled.is_posterior()
        {
            let Particles { z, ess, n_evaluations, .. } = sampled;
            anew.insert(part, (LeftOutParticles { z, ess }, n_evaluations));
        }
    }
    anew
}

/// - `particles`: the terms of the part for each particle.
fn tail_probability(particles: &[&[EvidenceTerm]]) -> Option<f64> {
    let n_terms = particles.first()?.len();
    let tail = |idx: usize| {
        let terms: Vec<&EvidenceTerm> =
            particles.iter().filter_map(|terms| terms.get(idx)).collect();
        terms.iter().all(|term| term.compared_by.has_sides()).then(|| {
            let below = standard_differences(&terms).into_iter().map(normal_cdf);
            let u = below.sum::<f64>() / terms.len() as f64;
            2.0 * u.min(1.0 - u)
        })
    };
    let tails: Vec<f64> = (0..n_terms).filter_map(tail).collect();
    let least = tails.iter().copied().min_by(f64::total_cmp)?;
    Some((least * tails.len() as f64).min(1.0))
}

/// What was found less what each particle expects, in standard deviations. Whole turns of an angle do
/// not count: all of its differences are told about their mean direction, so that half a turn, which is
/// as far off as an angle can be, lies to one side of all particles.
fn standard_differences(terms: &[&EvidenceTerm]) -> Vec<f64> {
    let differences: Vec<f64> = terms.iter().map(|term| term.found - term.expected).collect();
    let is_angle = terms.first().is_some_and(|term| term.unit == "rad");
    let about_middle = match is_angle {
        true => unwrapped_rad(&differences),
        false => differences.clone(),
    };
    let standard = |((difference, about_middle), term): ((&f64, f64), &&EvidenceTerm)| {
        match difference.abs() {
            0.0 => 0.0,
            size => about_middle / size * term.distance.sqrt(),
        }
    };
    differences.iter().zip(about_middle).zip(terms).map(standard).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ComparedBy;
    use impactlab_core::numerics::wrap_angle_rad;
    use std::f64::consts::PI;

    fn term(found: f64, expected: f64, sigma: f64) -> EvidenceTerm {
        let distance = ((found - expected) / sigma).powi(2);
        EvidenceTerm {
            name: String::new(),
            unit: "m/s",
            expected,
            found,
            distance,
            compared_by: ComparedBy::Number,
        }
    }

    /// A number that is exact is no contradiction in the middle of what is expected widely.
    #[test]
    fn what_lies_among_the_particles_is_expected_and_what_lies_beyond_all_is_not() {
        let expected: Vec<f64> = (0..=100).map(f64::from).collect();
        let p = |found: f64| {
            let of: Vec<[EvidenceTerm; 1]> =
                expected.iter().map(|expected| [term(found, *expected, 0.1)]).collect();
            let of: Vec<&[EvidenceTerm]> = of.iter().map(|terms| &terms[..]).collect();
            tail_probability(&of).unwrap()
        };
        assert!((p(50.0) - 1.0).abs() < 0.02 && (p(5.0) - 0.11).abs() < 0.02, "{}", p(5.0));
        assert!(p(101.0) < 1e-6 && p(-1.0) < 1e-6);
        let compared_by = ComparedBy::DistanceToPath;
        let distance = EvidenceTerm { compared_by, ..term(3.0, 0.0, 1.0) };
        assert_eq!(tail_probability(&[&[distance]]), None);
    }

    /// A heading that is off by half a turn lies at the border at which angles are told anew, so that
    /// half of the particles expect it to the left and half to the right.
    #[test]
    fn half_a_turn_is_a_contradiction_and_whole_turns_are_none() {
        let p = |off: f64| {
            let of: Vec<[EvidenceTerm; 1]> = (-50..=50)
                .map(|k| {
                    let expected = f64::from(k) * 0.002;
                    let found = expected + wrap_angle_rad(off - expected);
                    [EvidenceTerm { unit: "rad", ..term(found, expected, 0.04) }]
                })
                .collect();
            let of: Vec<&[EvidenceTerm]> = of.iter().map(|terms| &terms[..]).collect();
            tail_probability(&of).unwrap()
        };
        assert!(p(PI) < 1e-6 && p(-PI) < 1e-6 && p(PI / 2.0) < 1e-6, "{}", p(PI));
        assert!(p(0.0) > 0.95 && p(2.0 * PI) > 0.95, "{}", p(0.0));
    }
}
