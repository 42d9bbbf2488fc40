//! Simulation-based calibration of reconstructions: collisions are drawn from the program's own prior,
//! evidence of them from its own likelihood, and both are reconstructed. The rank of the true value
//! among the particles is then uniform.
//!
//! ```text
//! cargo run --release --example reconstruction_calibration -- datasets/staged/evidence/s24.toml 500
//! ```
//!
//! A third and a fourth argument are the number of particles, 150 without, and of motions that each
//! reconstruction may take, 8000 without; a fifth one is a site file, in whose friction zones the wheels
//! stand.
//!
//! The case gives cars, road, damage and the accuracies. Half of the collisions leave rest pose and
//! recorded speed, half rest pose and three positions in a video. What is printed is a line for each
//! quantity: p of χ² over 10 bins of its ranks, and how many ranks fell into each bin. While it runs,
//! a line on the error stream for each collision says its number, the effective sample size, the number
//! of motions, and for each quantity the share of the particles that lie below the true value.

#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::site::Site;
use impactlab_core::vehicle::FrictionZone;
use impactlab_reconstruct::evidence::{Edr, Evidence, Measured, RestPose, VideoPosition};
use impactlab_reconstruct::sampler::{SamplerSettings, sample};
use impactlab_reconstruct::{
    Cars, Discrepancy, ForwardModel, Posterior, RankedQuantity, ReconstructedQuantity,
    ReconstructionTarget, ranks_of_cases,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

const QUANTITIES: [ReconstructedQuantity; 6] = [
    ReconstructedQuantity::StruckSpeed,
    ReconstructedQuantity::StrikingSpeed,
    ReconstructedQuantity::ClosingSpeed,
    ReconstructedQuantity::HeadingDifference,
    ReconstructedQuantity::RoadFriction,
    ReconstructedQuantity::DeltaVStruck,
];

/// Draws of a collision until one can be simulated to rest.
const MAX_DRAWS: usize = 100;

/// The items that a collision of an index leaves, with their accuracies; the values come later.
fn kinds_of_evidence(case: &Evidence, idx: usize) -> Evidence {
    let mut evidence = case.without_edr().rest_only();
    let (x_m, y_m) = (Some(0.0), Some(0.0));
    let heading_rad = Some(Measured { value: 0.0, sigma: 0.035 }.into());
    evidence.rest =
        Some(RestPose { x_m, y_m, position_sigma_m: Some(0.15), heading_rad, stopped_by: None });
    match idx % 2 {
        0 => {
            let speed_before_m_s = Some(Measured { value: 0.0, sigma: 1.0 }.into());
            evidence.edr = Some(Edr { speed_before_m_s, ..Edr::default() });
        }
        _ => {
            let at = |time_s| VideoPosition { time_s: Some(time_s), x_m, y_m, sigma_m: Some(0.3) };
            evidence.positions = [0.5, 1.0, 1.5].map(at).to_vec();
        }
    }
    evidence
}

fn model(evidence: &Evidence, zones: &[FrictionZone]) -> ForwardModel {
    ForwardModel::new(evidence, Cars::new(evidence, None, None)).on_zones(zones.to_vec())
}

fn target(evidence: &Evidence, zones: &[FrictionZone]) -> ReconstructionTarget {
    let model = model(evidence, zones);
    ReconstructionTarget::new(evidence.clone(), model, Discrepancy::default())
}

/// - `size`: number of particles, and of motions at the most.
fn ranked(
    (case, zones): (&Evidence, &[FrictionZone]),
    [n_particles, max_evaluations]: [usize; 2],
    idx: usize,
) -> Result<Vec<RankedQuantity>, Box<dyn Error + Send + Sync>> {
    let mut rng = ChaCha8Rng::seed_from_u64(idx as u64);
    let open = {
        let mut evidence = kinds_of_evidence(case, idx);
        // Nothing that says where the car was, so that every motion is followed to rest.
        let (rest, positions) = (evidence.rest.take(), std::mem::take(&mut evidence.positions));
        let model = model(&evidence, zones);
        let evidence = Evidence { rest, positions, ..evidence };
        ReconstructionTarget::new(evidence, model, Discrepancy::default())
    };
    let mut drawn = None;
    for _ in 0..MAX_DRAWS {
        let dim = open.model().prior().components().len();
        let z: Vec<f64> = (0..dim).map(|_| StandardNormal.sample(&mut rng)).collect();
        let motion = open.model().motions(std::slice::from_ref(&z), |motion| motion).pop();
        let evidence = motion.and_then(|motion| open.drawn(&motion, &mut rng));
        if let Some(evidence) = evidence {
            drawn = Some((z, evidence));
            break;
        }
    }
    let (truth, evidence) = drawn.ok_or("no collision of the prior can be simulated")?;
    let target = target(&evidence, zones);
    let settings = SamplerSettings {
        n_particles,
        seed: idx as u64,
        least_ess: 0.4 * n_particles as f64,
        max_evaluations,
    };
    let particles = sample(&target, &settings, None, &mut |_| ControlFlow::Continue(()))?;
    let model = target.model();
    let of = |quantity: ReconstructedQuantity, z: &[f64]| {
        Posterior::from_points(model, &[z.to_vec()]).values(quantity)[0]
    };
    let us: Vec<f64> = QUANTITIES.iter().map(|_| rng.random()).collect();
    let quantities = QUANTITIES.iter().zip(us);
    let ranked = quantities.map(|(q, u)| RankedQuantity::new(&particles, &truth, u, |z| of(*q, z)));
    let ranked: Vec<RankedQuantity> = ranked.collect();
    let below: Vec<String> = ranked.iter().map(|of| format!("{:.3}", share_below(of))).collect();
    let (ess, n_motions) = (particles.ess, particles.n_evaluations);
    eprintln!("{idx} {ess:.0} {n_motions} {}", below.join(" "));
    Ok(ranked)
}

/// Share of the particles whose value is less than the true one.
fn share_below(of: &RankedQuantity) -> f64 {
    let n_below = of.values.iter().filter(|value| **value < of.truth).count();
    n_below as f64 / of.values.len() as f64
}

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let mut args = std::env::args().skip(1);
    let path = args.next().ok_or("expected an evidence file and a number of collisions")?;
    let mut number = |default: usize| args.next().map_or(Ok(default), |n| n.parse::<usize>());
    let (n, size) = (number(500)?, [number(150)?, number(8000)?]);
    let case = Evidence::load(Path::new(&path))?;
    let site = args.next().map(|site| Site::load(Path::new(&site))).transpose()?;
    let zones = site.map_or_else(Vec::new, |site| site.friction_zones);
    let all: Result<Vec<_>, _> =
        (0..n).into_par_iter().map(|idx| ranked((&case, &zones), size, idx)).collect();
    for (quantity, ranks) in QUANTITIES.iter().zip(&ranks_of_cases(&all?)) {
        let p = ranks.p_value(10).ok_or("no collision")?;
        println!("{:<24} p = {p:.3}  {:?}", quantity.key(), ranks.counts(10));
    }
    Ok(())
}
