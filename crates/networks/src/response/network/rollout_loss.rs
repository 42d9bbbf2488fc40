//! The loss of rollouts: gradients through network, effects and 4DOF step over many steps, so that
//! what is small in each does not add up.

use std::sync::Arc;

use candle_core::{D, DType, Device, Tensor};

use crate::nn::{NnError, softmax};
use crate::response::network::loss::{ResponseLoss, boundary, diversity, huber_of_squares};
use crate::response::network::response_network::{Gradients, ResponseNetwork};
use crate::response::physics::effect_operation::effect_rows;
use crate::response::physics::step_operations::{StepRow, feature_rows, step_rows};
use crate::response::{
    N_EFFECTS, N_FEATURES, N_RESIDUAL, N_TOKEN_NUMBERS, N_TOKENS, ResponseCase, STEP_S,
    vehicle_tokens,
};
use impactlab_core::vehicle::{N_STATE, VehicleInput, VehicleParameters};

/// Errors of the order of which a rollout counts, in the order of the state: v_x, v_y, ψ, r, φ, φ̇,
/// X, Y.
const STATE_UNIT: [f64; N_STATE] = [0.3, 0.3, 0.03, 0.1, 0.02, 0.2, 0.1, 0.1];
/// Of these the loss of the data takes the velocities, that of the trajectory heading and position.
const IS_VELOCITY: [f64; N_STATE] = [1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0];
/// Units of the second differences over the squared step, m/s³ and rad/s³.
const JERK_UNIT: [f64; N_STATE] = [100.0, 100.0, 100.0, 50.0, 50.0, 200.0, 100.0, 100.0];
/// Number of instants of a rollout that count as independent in its likelihood.
const N_INDEPENDENT: f64 = 10.0;

/// A trajectory, and the vehicle of its 4DOF model.
pub(crate) struct RolloutCase<'a> {
    pub case: &'a ResponseCase,
    pub vehicle: Arc<VehicleParameters>,
}

/// A stretch of a trajectory.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RolloutWindow {
    pub case_idx: usize,
    /// The first step of the window.
    pub start: usize,
}

/// The loss of windows of `length` steps, each component with its probability.
///
/// - `truncation`: steps after which the gradient is cut.
pub(crate) fn rollout_loss(
    network: &ResponseNetwork,
    cases: &[RolloutCase<'_>],
    windows: &[RolloutWindow],
    [length, truncation]: [usize; 2],
) -> Result<ResponseLoss, NnError> {
    let (n, device) = (windows.len(), &Device::Cpu);
    let n_components = network.n_components();
    let n_rows = n * n_components;
    let tokens = windows.iter().flat_map(|window| vehicle_tokens(&cases[window.case_idx].vehicle));
    let tokens: Vec<f64> = tokens.flatten().collect();
    let tokens = Tensor::from_vec(tokens, (n, N_TOKENS, N_TOKEN_NUMBERS), device)?;
    let strengths = network.strengths().unsqueeze(0)?.expand((n, n_components, N_EFFECTS))?;
    let strengths = strengths.contiguous()?.reshape((n_rows, N_EFFECTS))?;
    let tensor = |values: &[f64; N_STATE]| Tensor::new(values, device);
    let (unit, is_velocity) = (tensor(&STATE_UNIT)?, tensor(&IS_VELOCITY)?);
    let (jerk_unit, is_position) = (tensor(&JERK_UNIT)?, (1.0 - &is_velocity)?);
    let zero = Tensor::zeros((), DType::F64, device)?;
    let (mut data, mut trajectory) = (zero.clone(), zero.clone());
    let (mut physics, mut smoothness) = (zero.clone(), zero.clone());
    let mut distance = Tensor::zeros((n, n_components), DType::F64, device)?;
    let mut logits = distance.clone();
    let mut x = recorded(cases, windows, 0)?.expand((n, n_components, N_STATE))?.contiguous()?;
    let mut past: Vec<Tensor> = Vec::new();
    for t in 0..length {
        let rows = Arc::new(rows(cases, windows, t, n_components));
        let flat = x.reshape((n_rows, N_STATE))?;
        let flat = if t > 0 && t.is_multiple_of(truncation) { flat.detach() } else { flat };
        let seen = feature_rows(&flat, &rows)?.reshape((n, n_components, N_FEATURES))?;
        let effects = if network.config().effects {
            effect_rows(&flat, &strengths, &rows)?
        } else {
            Tensor::zeros((n_rows, N_RESIDUAL), DType::F64, device)?
        };
        let effects = effects.reshape((n, n_components, 1, N_RESIDUAL))?;
        let output = network.forward(Gradients::FineTuned, [&seen, &tokens, &effects])?;
        let value = own_component(&output.residual)?.reshape((n_rows, N_RESIDUAL))?;
        let next = step_rows(network.config().correction, [&flat, &value], &rows)?;
        x = next.reshape((n, n_components, N_STATE))?;

        let off = x.broadcast_sub(&recorded(cases, windows, t + 1)?)?;
        let squares = off.broadcast_div(&unit)?.sqr()?;
        let weights = softmax(&output.logits.mean(1)?, 1.0)?;
        let mean = |factor: &Tensor| -> Result<Tensor, NnError> {
            let loss = huber_of_squares(&squares.broadcast_mul(factor)?)?;
            Ok((loss * &weights)?.sum_all()?)
        };
        data = (data + mean(&is_velocity)?)?;
        trajectory = (trajectory + mean(&is_position)?)?;
        physics = (physics + own_component(&output.remainder)?.sqr()?.mean_all()?)?;
        distance = (distance + huber_of_squares(&squares)?)?;
        logits = (logits + output.logits.mean(1)?)?;
        past.push(x.clone());
        if let [.., before, middle, after] = past.as_slice() {
            let second = ((before + after)? - (middle * 2.0)?)?;
            let scaled = (second / (STEP_S * STEP_S))?.broadcast_div(&jerk_unit)?;
            let of_velocities = scaled.sqr()?.broadcast_mul(&is_velocity)?;
            smoothness = (smoothness + of_velocities.mean_all()?)?;
        }
    }
    let steps = length.max(1) as f64;
    let path_weights = softmax(&(logits / steps)?, 1.0)?;
    let joint = ((path_weights + 1e-12)?.log()? - (distance * (N_INDEPENDENT / steps))?)?;
    let likelihood = (joint.log_sum_exp(D::Minus1)?.mean_all()? * (-1.0 / N_INDEPENDENT))?;
    let per_window = steps * n.max(1) as f64;
    Ok(ResponseLoss {
        data: (data / per_window)?,
        likelihood,
        physics: (physics / steps)?,
        diversity: diversity(&x.broadcast_div(&unit)?)?,
        trajectory: (trajectory / per_window)?,
        smoothness: (smoothness / steps)?,
        boundary: boundary(&x.reshape((n_rows, N_STATE))?, &network.boundary_scale()?)?,
    })
}

/// States `t` steps after the start of each window, `[windows, 1, 8]`.
fn recorded(
    cases: &[RolloutCase<'_>],
    windows: &[RolloutWindow],
    t: usize,
) -> Result<Tensor, NnError> {
    let states = windows.iter().map(|window| {
        let states = &cases[window.case_idx].case.states;
        states.get(window.start + t).or(states.last()).copied().unwrap_or_default().to_array()
    });
    let states: Vec<f64> = states.flatten().collect();
    Ok(Tensor::from_vec(states, (windows.len(), 1, N_STATE), &Device::Cpu)?)
}

/// What each row knows: windows one after the other, the components of each together.
fn rows(
    cases: &[RolloutCase<'_>],
    windows: &[RolloutWindow],
    t: usize,
    n_components: usize,
) -> Vec<StepRow> {
    let window_rows = |window: &RolloutWindow| {
        let at = window.start + t;
        let case = &cases[window.case_idx];
        let input = case.case.inputs.get(at).copied().unwrap_or(VehicleInput::released());
        let row = StepRow { vehicle: case.vehicle.clone(), input, time_s: at as f64 * STEP_S };
        vec![row; n_components]
    };
    windows.iter().flat_map(window_rows).collect()
}

/// Of the path of each component its own part: `[sequences, J, J, 4]` to `[sequences, J, 4]`.
fn own_component(of_all: &Tensor) -> Result<Tensor, NnError> {
    let (_, _, n, _) = of_all.dims4()?;
    let own = Tensor::eye(n, DType::F64, of_all.device())?.reshape((1, n, n, 1))?;
    Ok(of_all.broadcast_mul(&own)?.sum(2)?)
}
