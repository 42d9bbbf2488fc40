//! One step of a component of the mixture: the correction terms at a state, and the state that follows
//! at given latent factors.

use crate::response::network::vehicle_network::{VehicleNetwork, Workspace};
use crate::response::physics::features::features_of;
use crate::response::physics::step::StepModel;
use crate::response::predict::latents::{Latents, N_LATENTS};
use crate::response::{N_EFFECTS, N_FEATURES, N_RESIDUAL, combined, effects};
use crate::vehicle::{VehicleEvaluation, VehicleInput, VehicleParameters, VehicleState};

/// Vehicle, network and latent factors: all that a step needs besides the state.
pub(crate) struct Dynamics<'a> {
    pub vehicle: &'a VehicleParameters,
    pub model: StepModel,
    pub network: &'a VehicleNetwork,
    pub latents: &'a Latents,
    /// Change of the strengths of the effects with each latent, where there is one.
    directions: [Vec<(usize, f64)>; N_LATENTS],
}

/// The states of a step at which the network is evaluated, as features, and the results.
#[derive(Default)]
pub(crate) struct NetworkBatch {
    work: Workspace,
    features: Vec<[f64; N_FEATURES]>,
}

/// The terms of the correction at a state, before it is bounded.
#[derive(Clone, Copy)]
pub(super) struct CorrectionTerms {
    /// Effects and remainder of the component with every latent factor at zero.
    value: [f64; N_RESIDUAL],
    /// Change of that by a latent factor of one.
    by_latents: [[f64; N_RESIDUAL]; N_LATENTS],
}

impl NetworkBatch {
    pub(super) fn clear(&mut self) {
        self.features.clear();
    }

    pub(super) fn push(&mut self, features: [f64; N_FEATURES]) {
        self.features.push(features);
    }
}

impl<'a> Dynamics<'a> {
    pub(crate) fn new(
        vehicle: &'a VehicleParameters,
        network: &'a VehicleNetwork,
        latents: &'a Latents,
    ) -> Self {
        let changed = |strengths: [f64; N_EFFECTS]| {
            strengths.into_iter().enumerate().filter(|(_, change)| *change != 0.0).collect()
        };
        let model = StepModel::of(vehicle);
        Self { vehicle, model, network, latents, directions: latents.directions.map(changed) }
    }

    /// Whether the step does not depend on a latent factor.
    pub(super) fn ignores(&self, latent: usize) -> bool {
        self.directions.get(latent).is_none_or(Vec::is_empty)
    }

    /// One step at given latent factors.
    pub(crate) fn step(
        &self,
        (component, latents): (usize, &[f64; N_LATENTS]),
        (x, u, time_s): (&VehicleState<f64>, &VehicleInput<f64>, f64),
        batch: &mut NetworkBatch,
    ) -> VehicleState<f64> {
        let now = self.model.constants.evaluate(x, u);
        batch.clear();
        batch.push(features_of(self.vehicle, x, &now, time_s));
        let mut terms = self.effects_at(component, x, &now);
        self.evaluate_network(batch);
        self.add_remainder(&mut terms, batch, [0, component]);
        self.advance((x, &now), self.correction(&terms, latents), u)
    }

    /// The known effects of a component.
    pub(super) fn effects_at(
        &self,
        component: usize,
        x: &VehicleState<f64>,
        now: &VehicleEvaluation<f64>,
    ) -> CorrectionTerms {
        let effects = effects(self.vehicle, x, now);
        let known = self.network.strengths(component).map(|known| combined(&effects, known));
        let by_latents = self.directions.each_ref().map(|direction| {
            let mut sum = [0.0; N_RESIDUAL];
            for &(k, change) in direction {
                add(&mut sum, change, &effects[k]);
            }
            sum
        });
        CorrectionTerms { value: known.unwrap_or_default(), by_latents }
    }

    /// Evaluates the network at every state of the batch.
    pub(super) fn evaluate_network(&self, batch: &mut NetworkBatch) {
        self.network.forward(&batch.features, &mut batch.work);
    }

    /// Adds the network's remainder.
    ///
    /// - `at`: indices of the state in the batch and of the component.
    pub(super) fn add_remainder(
        &self,
        terms: &mut CorrectionTerms,
        batch: &NetworkBatch,
        at: [usize; 2],
    ) {
        add(&mut terms.value, 1.0, &self.network.remainder(&batch.work, at));
    }

    /// The correction at given latent factors.
    pub(super) fn correction(
        &self,
        terms: &CorrectionTerms,
        latents: &[f64; N_LATENTS],
    ) -> [f64; N_RESIDUAL] {
        let mut value = terms.value;
        for (z, by_latent) in latents.iter().zip(&terms.by_latents) {
            add(&mut value, *z, by_latent);
        }
        self.network.bounded(value)
    }

    /// The state after a step with a correction.
    ///
    /// - `now`: the 4DOF model at the beginning.
    pub(super) fn advance(
        &self,
        (x, now): (&VehicleState<f64>, &VehicleEvaluation<f64>),
        correction: [f64; N_RESIDUAL],
        u: &VehicleInput<f64>,
    ) -> VehicleState<f64> {
        self.network.correction().step_from(&self.model, (x, u, now), correction)
    }

    /// Probability of a component at the first state of the batch.
    pub(crate) fn weight(&self, component: usize, batch: &NetworkBatch) -> f64 {
        self.network.weight(&batch.work, [0, component])
    }

    /// Standard deviation of the noise of a step from the first state of the batch.
    pub(crate) fn noise(&self, component: usize, batch: &NetworkBatch) -> [f64; N_RESIDUAL] {
        let variance = self.network.variance(&batch.work, [0, component]);
        variance.map(|variance| self.latents.step_noise * variance.sqrt())
    }
}

/// `sum += factor · values`.
fn add(sum: &mut [f64; N_RESIDUAL], factor: f64, values: &[f64; N_RESIDUAL]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += factor * value;
    }
}
