//! Measures how far the momentum solution and a pulse of the mean duration err on collisions outside
//! of those that the duration was taken from.
//!
//! ```text
//! cargo run --release --example bare_force -- datasets/fea datasets/fea-wide
//! ```
//!
//! For each feature of a collision, the quarter of the cases with the smallest values and the quarter
//! with the largest are left out in turn. What is printed are the constants of
//! `crates/networks/src/force/physics/bare.rs`.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::numerics::{NORMAL_QUANTILE_95, median};
use impactlab_networks::force::{ForceCase, ForceScenario};

type Feature = fn(&ForceScenario) -> f64;

const FEATURES: [Feature; 6] = [
    |of| of.mass_kg[0],
    |of| of.mass_kg[1],
    |of| of.relative_velocity_m_s()[0],
    |of| of.relative_velocity_m_s()[1],
    |of| of.theta_b_rad,
    |of| of.contact_m.map_or(0.0, |[x, _]| x),
];

/// Logarithm of the impulse, its direction, logarithm of duration and of peak: observed less
/// predicted.
type Errors = [f64; 4];

/// The errors of the cases `test` with the medians of duration and shape of `train`; `None` if a case
/// has no momentum solution.
fn errors(train: &[&ForceCase], test: &[&ForceCase]) -> Option<Vec<Errors>> {
    let clean = || train.iter().filter(|case| case.is_clean());
    let duration = train.iter().map(|case| case.curve.duration_s).sum::<f64>() / train.len() as f64;
    let size = |[x, y]: [f64; 2]| x.hypot(y);
    let shape = |case: &&&ForceCase| case.peak_n * case.curve.duration_s / size(case.impulse_n_s);
    let shape = median(clean().map(|case| shape(&case))).unwrap_or(f64::NAN);
    let of = |case: &&ForceCase| {
        let impact = case.scenario.likely_impact()?;
        let (p, q) = (case.impulse_n_s, impact.solve().ok()?.impulse_world_n_s);
        let turn = p[1].atan2(p[0]) - q[1].atan2(q[0]);
        Some([
            (size(p) / size(q)).ln(),
            (turn + PI).rem_euclid(2.0 * PI) - PI,
            (case.curve.duration_s / duration).ln(),
            (case.peak_n * duration / (size(q) * shape)).ln(),
        ])
    };
    println!("{} left out; F_max Δt / |P| of the others {shape:.3}", test.len());
    test.iter().map(of).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut cases = Vec::new();
    for root in std::env::args().skip(1) {
        let read = ForceCase::load_all(Path::new(&root), &mut |_| ControlFlow::Continue(()))?;
        cases.extend(read.complete().ok_or("cancelled")?);
    }
    let mut all = Vec::new();
    for feature in FEATURES {
        let mut order: Vec<&ForceCase> = cases.iter().collect();
        order.sort_by(|a, b| feature(&a.scenario).total_cmp(&feature(&b.scenario)));
        let n = order.len() / 4;
        let (low, rest) = order.split_at(n);
        all.extend(errors(rest, low).ok_or("a case has no momentum solution")?);
        let (rest, high) = order.split_at(order.len() - n);
        all.extend(errors(rest, high).ok_or("a case has no momentum solution")?);
    }
    let n = all.len() as f64;
    let rms = |i: usize| (all.iter().map(|of| of[i] * of[i]).sum::<f64>() / n).sqrt();
    for (i, name) in
        ["impulse, ln", "direction, rad", "duration, ln", "peak, ln"].iter().enumerate()
    {
        let within = |z: f64| all.iter().filter(|of| of[i].abs() < z * rms(i)).count() as f64 / n;
        let mean = all.iter().map(|of| of[i]).sum::<f64>() / n;
        let [half, ninety] = [within(0.674), within(NORMAL_QUANTILE_95)].map(|share| 100.0 * share);
        println!(
            "{name}: rms {:.3}, mean {mean:.3}, {half:.0} % within 0.674 rms, {ninety:.0} % within 1.645 rms",
            rms(i)
        );
        for j in 0..i {
            let product = all.iter().map(|of| of[i] * of[j]).sum::<f64>() / n;
            println!("  correlation with number {j}: {:.2}", product / (rms(i) * rms(j)));
        }
    }
    Ok(())
}
