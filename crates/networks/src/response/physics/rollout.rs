//! The vehicle over many steps.

use crate::response::physics::step::StepModel;
use crate::response::{Correction, N_RESIDUAL};
use impactlab_core::vehicle::{VehicleInput, VehicleParameters, VehicleState};

/// The states at the beginning of each step and at the end: one more than inputs.
///
/// - `residual`: the residual acceleration of every step.
pub fn rollout(
    vehicle: &VehicleParameters,
    initial: VehicleState<f64>,
    inputs: &[VehicleInput<f64>],
    residual: [f64; N_RESIDUAL],
) -> Vec<VehicleState<f64>> {
    let mut states = Vec::with_capacity(inputs.len() + 1);
    let model = StepModel::new(vehicle);
    let mut state = initial;
    states.push(state);
    for input in inputs {
        let now = model.constants.evaluate(&state, input);
        let correction = Correction::Acceleration;
        state = correction.step_from(&model, &state, input, &now.derivative, residual);
        states.push(state);
    }
    states
}

/// Mean over time of the distance in (X, Y), m; infinite where a state is not finite.
pub fn average_error_m(states: &[VehicleState<f64>], reference: &[VehicleState<f64>]) -> f64 {
    let pairs = states.iter().zip(reference);
    let distances = pairs.map(|(a, b)| (a.x_m - b.x_m).hypot(a.y_m - b.y_m));
    let mean = distances.sum::<f64>() / reference.len().max(1) as f64;
    if mean.is_finite() { mean } else { f64::INFINITY }
}
