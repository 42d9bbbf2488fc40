//! Evaluates and advances states of several motions of one vehicle side by side, in the vector registers of
//! the machine.

use pulp::{Simd, WithSimd};

use crate::response::physics::features::features_of;
use crate::response::predict::dynamics::{CorrectionTerms, Dynamics, NetworkBatch};
use crate::response::{N_FEATURES, N_LATENTS, N_RESIDUAL};
use impactlab_core::numerics::{MAX_LANES, Packed};
use impactlab_core::vehicle::{N_STATE, VehicleInput, VehicleState};

/// States at which vehicle model, effects and features of the network are evaluated.
pub(super) struct Evaluation<'a, 'b> {
    pub dynamics: &'a Dynamics<'b>,
    /// The component of each state.
    pub components: &'a [usize],
    pub u: &'a VehicleInput<f64>,
    pub time_s: f64,
    /// In the order of `eq:state_vector`.
    pub states: &'a [[f64; N_STATE]],
    /// The features are added here.
    pub batch: &'a mut NetworkBatch,
    /// What comes out is put here, one for each state.
    pub points: &'a mut Vec<EvaluatedPoint>,
}

/// A state with what was evaluated there.
#[derive(Clone, Copy)]
pub(super) struct EvaluatedPoint {
    /// The state, in the order of `eq:state_vector`.
    pub state: [f64; N_STATE],
    /// Its time derivative by the 4DOF model.
    pub derivative: [f64; N_STATE],
    /// The terms of the correction.
    pub terms: CorrectionTerms,
}

impl WithSimd for Evaluation<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { dynamics, components, u, time_s, states, batch, points } = self;
        let seen_time_s = dynamics.seen_time_s(time_s);
        let spread = dynamics.latents.spread_at(time_s, u);
        let u = Splat(simd).input(u);
        let n = Packed::<S>::N;
        for (states, components) in states.chunks(n).zip(components.chunks(n)) {
            let x = VehicleState::from_array(Packed::columns(simd, states));
            let now = dynamics.model.constants.evaluate(&x, &u);
            let features = Packed::rows(&features_of(dynamics.vehicle, &x, &now, seen_time_s));
            let amounts = dynamics.amounts(&x, &now);
            let mut values = [[0.0; N_RESIDUAL]; MAX_LANES];
            for component in 0..dynamics.network.n_components() {
                if components.contains(&component) {
                    let known = Packed::rows(&dynamics.known_effects(component, &amounts));
                    for ((value, own), known) in values.iter_mut().zip(components).zip(known) {
                        if *own == component {
                            *value = known;
                        }
                    }
                }
            }
            let mut by_latents = [[[0.0; N_RESIDUAL]; MAX_LANES]; N_LATENTS];
            let of_lanes = dynamics.effects_by_latents(&amounts, spread);
            for (rows, of_lanes) in by_latents.iter_mut().zip(&of_lanes) {
                *rows = Packed::rows(of_lanes);
            }
            let derivatives = Packed::rows(&now.derivative.to_array());
            for (lane, state) in states.iter().enumerate() {
                let features: [f64; N_FEATURES] = features[lane];
                batch.push(features);
                let by_latents = by_latents.map(|rows| rows[lane]);
                let terms = CorrectionTerms { value: values[lane], by_latents };
                points.push(EvaluatedPoint { state: *state, derivative: derivatives[lane], terms });
            }
        }
    }
}

/// Where a step begins, and with which correction.
#[derive(Clone, Copy)]
pub(super) struct StepStart {
    /// The state, in the order of `eq:state_vector`.
    pub state: [f64; N_STATE],
    /// Its time derivative by the 4DOF model.
    pub derivative: [f64; N_STATE],
    /// Before it is bounded.
    pub correction: [f64; N_RESIDUAL],
}

/// Steps that are taken side by side.
pub(super) struct Advance<'a, 'b> {
    pub dynamics: &'a Dynamics<'b>,
    pub u: &'a VehicleInput<f64>,
    pub starts: &'a [StepStart],
    /// The states after the steps are put here.
    pub ends: &'a mut Vec<VehicleState<f64>>,
}

impl WithSimd for Advance<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { dynamics, u, starts, ends } = self;
        let u = Splat(simd).input(u);
        let mut states = [[0.0; N_STATE]; MAX_LANES];
        let mut derivatives = [[0.0; N_STATE]; MAX_LANES];
        let mut corrections = [[0.0; N_RESIDUAL]; MAX_LANES];
        for starts in starts.chunks(Packed::<S>::N) {
            for (lane, start) in starts.iter().enumerate() {
                states[lane] = start.state;
                derivatives[lane] = start.derivative;
                corrections[lane] = start.correction;
            }
            let n = starts.len();
            let x = VehicleState::from_array(Packed::columns(simd, &states[..n]));
            let now = VehicleState::from_array(Packed::columns(simd, &derivatives[..n]));
            let correction = Packed::columns(simd, &corrections[..n]);
            let correction = dynamics.network.bounded(correction);
            let method = dynamics.network.correction();
            let next = method.step_from(&dynamics.model, &x, &u, &now, correction);
            for end in &Packed::rows(&next.to_array())[..n] {
                ends.push(VehicleState::from_array(*end));
            }
        }
    }
}

/// The same number in every lane.
#[derive(Clone, Copy)]
struct Splat<S>(S);

impl<S: Simd> Splat<S> {
    #[inline(always)]
    fn input(self, u: &VehicleInput<f64>) -> VehicleInput<Packed<S>> {
        u.map(|value| Packed::splat(self.0, value))
    }
}
