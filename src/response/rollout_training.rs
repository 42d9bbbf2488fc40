//! Training on rollouts of growing length: gradients through the network and the 4DOF step over
//! many steps, so that what is small in each does not add up.

use std::ops::ControlFlow;
use std::sync::Arc;

use candle_core::{D, DType, Device, Tensor};
use rand::RngExt;

use crate::nn::{AdamW, AdamWConfig, NnError, Schedule, random_stream, softmax};
use crate::response::network::{ResponseNetwork, ResponseOutput};
use crate::response::step_operations::{Row, feature_rows, step_rows};
use crate::response::{
    N_FEATURES, N_RESIDUAL, N_TOKEN_NUMBERS, N_TOKENS, ResponseCase, ResponseConfig, ResponseError,
    ResponseProgress, STEP_S, Tuning, vehicle_tokens,
};
use crate::vehicle::{N_STATE, VehicleParameters};

/// Errors of the order of which a rollout counts, in the order of the state: v_x, v_y, ψ, r, φ, φ̇,
/// X, Y.
const STATE_UNIT: [f64; N_STATE] = [0.3, 0.3, 0.03, 0.1, 0.02, 0.2, 0.1, 0.1];

/// Trains the network's weights in place.
pub(crate) fn train_rollouts(
    network: &ResponseNetwork,
    (cases, tuning): (&[&ResponseCase], &Tuning),
    (config, seed): (&ResponseConfig, u64),
    report: &mut dyn FnMut(ResponseProgress) -> ControlFlow<()>,
) -> Result<(), ResponseError> {
    let rollouts = &config.rollouts;
    let total = rollouts.steps * rollouts.lengths.len() as u64;
    let settings = AdamWConfig {
        learning_rate: rollouts.learning_rate,
        weight_decay: config.training.weight_decay,
        max_gradient_norm: Some(config.training.max_gradient_norm),
        schedule: Schedule::WarmupCosine { warmup_steps: 0, total_steps: total, final_share: 0.05 },
        ..AdamWConfig::default()
    };
    let mut optimizer = AdamW::new(settings, network.parameters())?;
    let mut rng = random_stream(seed, "rollouts", 0);
    let vehicles: Vec<Arc<VehicleParameters>> =
        cases.iter().map(|case| Arc::new(tuning.apply(&case.vehicle))).collect();
    let mut done = 0;
    for &length in &rollouts.lengths {
        for _ in 0..rollouts.steps {
            let draw = |_| {
                let case_idx = rng.random_range(0..cases.len());
                let last = cases[case_idx].inputs.len().saturating_sub(length);
                Window { case_idx, start: rng.random_range(0..=last) }
            };
            let windows: Vec<Window> = (0..rollouts.batch_windows).map(draw).collect();
            let loss = rollout_loss(network, (cases, &vehicles), &windows, length)?;
            let value = loss.to_scalar::<f64>()?;
            optimizer.step(network.parameters(), &loss.backward()?)?;
            done += 1;
            let told = ResponseProgress::Rollouts { done, of: total, length, loss: value };
            if report(told).is_break() {
                return Ok(());
            }
        }
    }
    Ok(())
}

/// A stretch of a trajectory.
struct Window {
    case_idx: usize,
    /// Its first step.
    start: usize,
}

/// Mean over windows and instants of Huber's loss of the state, each component with its
/// probability.
fn rollout_loss(
    network: &ResponseNetwork,
    (cases, vehicles): (&[&ResponseCase], &[Arc<VehicleParameters>]),
    windows: &[Window],
    length: usize,
) -> Result<Tensor, ResponseError> {
    let (n, device) = (windows.len(), &Device::Cpu);
    let n_components = network.n_components();
    let tokens = windows.iter().flat_map(|window| vehicle_tokens(&vehicles[window.case_idx]));
    let tokens: Vec<f64> = tokens.flatten().collect();
    let tokens = Tensor::from_vec(tokens, (n, N_TOKENS, N_TOKEN_NUMBERS), device)?;
    let unit = Tensor::new(&STATE_UNIT, device)?;
    // [windows, components, state] of recorded states
    let recorded = |t: usize| -> Result<Tensor, NnError> {
        let states = windows.iter().map(|window| {
            let states = &cases[window.case_idx].states;
            states.get(window.start + t).or(states.last()).copied().unwrap_or_default().to_array()
        });
        let states: Vec<f64> = states.flatten().collect();
        let states = Tensor::from_vec(states, (n, 1, N_STATE), device)?;
        Ok(states.broadcast_as((n, n_components, N_STATE))?.contiguous()?)
    };
    let mut x = recorded(0)?.reshape((n * n_components, N_STATE))?;
    let mut sum = Tensor::zeros((), DType::F64, device)?;
    for t in 0..length {
        let rows = Arc::new(rows((cases, vehicles), windows, t, n_components));
        let seen = feature_rows(&x, &rows)?.reshape((n, n_components, N_FEATURES))?;
        let output = network.forward(&seen, &tokens)?;
        let residual = own_component(&output)?.reshape((n * n_components, N_RESIDUAL))?;
        x = step_rows(&x, &residual, &rows)?;
        let off = (x.reshape((n, n_components, N_STATE))? - recorded(t + 1)?)?;
        let squared = off.broadcast_div(&unit)?.sqr()?.sum(D::Minus1)?;
        let loss = ((squared + 1.0)?.sqrt()? - 1.0)?;
        let weights = softmax(&output.logits.mean(1)?, 1.0)?;
        sum = (sum + (loss * weights)?.sum_all()?)?;
    }
    Ok((sum / (n * length).max(1) as f64)?)
}

/// What each row knows: windows one after the other, the components of each together.
fn rows(
    (cases, vehicles): (&[&ResponseCase], &[Arc<VehicleParameters>]),
    windows: &[Window],
    t: usize,
    n_components: usize,
) -> Vec<Row> {
    let of = |window: &Window| {
        let at = window.start + t;
        let inputs = &cases[window.case_idx].inputs;
        let input = inputs.get(at).copied().unwrap_or(crate::vehicle::VehicleInput::released());
        let vehicle = vehicles[window.case_idx].clone();
        vec![Row { vehicle, input, time_s: at as f64 * STEP_S }; n_components]
    };
    windows.iter().flat_map(of).collect()
}

/// Of the path of each component its own residual: `[sequences, J, J, 4]` to `[sequences, J, 4]`.
fn own_component(output: &ResponseOutput) -> Result<Tensor, NnError> {
    let (_, _, n, _) = output.residual.dims4()?;
    let own = Tensor::eye(n, DType::F64, output.residual.device())?.reshape((1, n, n, 1))?;
    Ok(output.residual.broadcast_mul(&own)?.sum(2)?)
}
