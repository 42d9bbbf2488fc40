//! Compares the predicted distribution of a motion with motions drawn by Monte Carlo, each with one
//! mixture component, latent factors that are constant along it, and noise in each step.
//!
//! It prints a Markdown table of the means and standard deviations at several times over the test
//! trajectories of a data set. The arguments are the model, the data set and the number of draws.
//!
//! `cargo run --release --example monte_carlo -- \
//! assets/models/response.safetensors datasets/trajectories-fea 10000`

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::data::Outcome;
use impactlab_networks::learning::{ModelFile, TEST_SHARE, split};
use impactlab_networks::response::{Predictor, ResponseCase, ResponseModel, STEP_S};

/// Seed of the draws and of the split, which is the default of the commands.
const SEED: u64 = 0;
/// Times since the start of the impact at which the distributions are compared, s.
const INSTANTS_S: [f64; 3] = [1.0, 2.0, 3.9];

/// Agreement of the two distributions for one case at one time.
struct Agreement {
    /// Distance of the two mean positions, as a share of the length of the recorded path.
    mean_share: f64,
    /// Predicted standard deviation over that of the draws, for X, Y and heading.
    ratios: [f64; 3],
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [model, data, n_draws] = &arguments[..] else {
        return Err("expected: MODEL DATA_SET DRAWS".into());
    };
    let (model, n_draws) = (ResponseModel::load(Path::new(model))?, n_draws.parse()?);
    let go_on = &mut |_| ControlFlow::Continue(());
    let Outcome::Complete(cases) = ResponseCase::load_all(Path::new(data), None, go_on)? else {
        return Ok(());
    };
    println!("| case | spins | at, s | means apart, % of the path | std X | std Y | std heading |");
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: |");
    let mut all = Vec::new();
    for case in split(&cases, SEED, TEST_SHARE).test.iter().filter_map(|&idx| cases.get(idx)) {
        let predictor = model.predictor(&case.vehicle)?;
        for (at_s, agreement) in agreement(&predictor, case, n_draws) {
            let Agreement { mean_share, ratios: [x, y, yaw] } = agreement;
            let share = 100.0 * mean_share;
            println!(
                "| {} | {} | {at_s} | {share:.2} | {x:.2} | {y:.2} | {yaw:.2} |",
                case.name, case.spins
            );
            all.push(agreement);
        }
    }
    let of_ratios = |low: f64, high: f64| {
        let ratios = all.iter().flat_map(|of| of.ratios);
        let inside = ratios.filter(|ratio| (low..=high).contains(ratio)).count();
        inside as f64 / (3 * all.len()).max(1) as f64
    };
    let within = all.iter().filter(|of| of.mean_share <= 0.01).count();
    println!(
        "\nmeans within 1 % of the path: {within} of {}; deviations within 15 %: {:.0} %, within 30 %: {:.0} %",
        all.len(),
        100.0 * of_ratios(0.85, 1.15),
        100.0 * of_ratios(0.7, 1.3)
    );
    Ok(())
}

/// Compares the predicted distribution of a case with `n_draws` simulated motions. Returns each
/// time with the agreement at it.
fn agreement(predictor: &Predictor, case: &ResponseCase, n_draws: usize) -> Vec<(f64, Agreement)> {
    let Some(initial) = case.states.first() else { return Vec::new() };
    let motion = predictor.motion(initial, &case.inputs);
    let draws = predictor.sample(initial, &case.inputs, n_draws, SEED);
    let at = |at_s: f64| {
        let at = (at_s / STEP_S).round() as usize;
        let planar: Vec<[f64; 6]> =
            draws.iter().filter_map(|states| Some(states.get(at)?.planar())).collect();
        let n = planar.len().max(1) as f64;
        let mean = |axis: usize| planar.iter().map(|of| of[axis]).sum::<f64>() / n;
        let std = |axis: usize| {
            let mean = mean(axis);
            (planar.iter().map(|of| (of[axis] - mean).powi(2)).sum::<f64>() / n).sqrt()
        };
        let (expected, covariance) = (motion.mean(at).planar(), motion.covariance(at));
        let path_m: f64 = case.states[..=at.min(case.states.len() - 1)]
            .windows(2)
            .map(|pair| (pair[1].x_m - pair[0].x_m).hypot(pair[1].y_m - pair[0].y_m))
            .sum();
        let apart_m = (mean(0) - expected[0]).hypot(mean(1) - expected[1]);
        let ratio = |axis: usize| covariance[(axis, axis)].sqrt() / std(axis).max(1e-12);
        let ratios = [0, 1, 2].map(ratio);
        (at_s, Agreement { mean_share: apart_m / path_m.max(1e-9), ratios })
    };
    INSTANTS_S.into_iter().map(at).collect()
}
