//! One step of a component of the mixture: the correction terms at a state, and the state that follows
//! at given latent factors.

use crate::response::network::vehicle_network::{VehicleNetwork, Workspace};
use crate::response::physics::effects::EffectModel;
use crate::response::physics::features::features_of;
use crate::response::physics::step::StepModel;
use crate::response::predict::latents::{Latents, N_LATENTS};
use crate::response::{N_FEATURES, N_RESIDUAL};
use impactlab_core::numerics::Lanes;
use impactlab_core::vehicle::{VehicleEvaluation, VehicleInput, VehicleParameters, VehicleState};

/// Vehicle, network and latent factors: all that a step needs besides the state.
pub(crate) struct Dynamics<'a> {
    pub vehicle: &'a VehicleParameters,
    pub model: StepModel,
    pub network: &'a VehicleNetwork,
    pub latents: &'a Latents,
    effects: EffectModel,
    /// Whether the step does not depend on a latent factor.
    ignored: [bool; N_LATENTS],
}

/// Time over which the remainder of the network fades where a motion goes on for longer than those
/// that were learned from, s.
const FADE_S: f64 = 1.0;

/// Largest variance of the noise of a step, (m/s)², (rad/s)². Within what was learned from it is some
/// 1e-4; in a crash far outside of that, the network's exponential knows no bound.
const LARGEST_VARIANCE: f64 = 1.0;

/// The states of a step at which the network is evaluated, as features, and the results.
#[derive(Default)]
pub(crate) struct NetworkBatch {
    work: Workspace,
    features: Vec<[f64; N_FEATURES]>,
    /// Share of the network's remainder and noise at the time of the step.
    share: f64,
}

/// The terms of the correction at a state, before it is bounded.
#[derive(Clone, Copy)]
pub(super) struct CorrectionTerms<T = f64> {
    /// Effects and remainder of the component with every latent factor at zero.
    pub value: [T; N_RESIDUAL],
    /// Change of that by a latent factor of one.
    pub by_latents: [[T; N_RESIDUAL]; N_LATENTS],
}

impl NetworkBatch {
    /// Begins a step at which the network has a share.
    pub(super) fn begin(&mut self, share: f64) {
        self.features.clear();
        self.share = share;
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
        Self {
            vehicle,
            model: StepModel::new(vehicle),
            network,
            latents,
            effects: EffectModel::new(vehicle),
            ignored: latents
                .directions
                .map(|direction| direction.iter().all(|change| *change == 0.0)),
        }
    }

    /// Share of the network's remainder and noise at a time: the motions that it has learned from were
    /// not longer. What follows them is the physics with its strengths, which do not depend on time.
    pub(super) fn share_at(&self, time_s: f64) -> f64 {
        (1.0 - (time_s - self.network.learned_s()) / FADE_S).clamp(0.0, 1.0)
    }

    /// What the network sees, at the latest at the end of the motions that it has learned from.
    #[inline(always)]
    pub(super) fn features<T: Lanes>(
        &self,
        x: &VehicleState<T>,
        now: &VehicleEvaluation<T>,
        time_s: f64,
    ) -> [T; N_FEATURES] {
        features_of(self.vehicle, x, now, time_s.min(self.network.learned_s()))
    }

    /// Whether the step does not depend on each latent factor.
    pub(super) fn ignored(&self) -> [bool; N_LATENTS] {
        self.ignored
    }

    /// One step at given latent factors.
    pub(crate) fn step(
        &self,
        component: usize,
        latents: &[f64; N_LATENTS],
        x: &VehicleState<f64>,
        u: &VehicleInput<f64>,
        time_s: f64,
        batch: &mut NetworkBatch,
    ) -> VehicleState<f64> {
        let now = self.model.constants.evaluate(x, u);
        let correction = self.correction_at(component, latents, (x, &now), time_s, batch);
        self.network.correction().step_from(&self.model, x, u, &now.derivative, correction)
    }

    /// The correction over a step at given latent factors, bounded.
    pub(super) fn correction(
        &self,
        component: usize,
        latents: &[f64; N_LATENTS],
        x: &VehicleState<f64>,
        u: &VehicleInput<f64>,
        time_s: f64,
        batch: &mut NetworkBatch,
    ) -> [f64; N_RESIDUAL] {
        let now = self.model.constants.evaluate(x, u);
        self.correction_at(component, latents, (x, &now), time_s, batch)
    }

    /// [`Dynamics::correction`] where the 4DOF model was evaluated already.
    fn correction_at(
        &self,
        component: usize,
        latents: &[f64; N_LATENTS],
        (x, now): (&VehicleState<f64>, &VehicleEvaluation<f64>),
        time_s: f64,
        batch: &mut NetworkBatch,
    ) -> [f64; N_RESIDUAL] {
        batch.begin(self.share_at(time_s));
        let mut terms = self.effects_at(component, (x, now), time_s);
        if batch.share > 0.0 {
            batch.push(self.features(x, now, time_s));
            self.evaluate_network(batch);
            self.add_remainder(&mut terms, batch, [0, component]);
        }
        self.network.bounded(self.free_correction(&terms, latents))
    }

    /// The known effects of a component.
    #[inline(always)]
    pub(super) fn effects_at<T: Lanes>(
        &self,
        component: usize,
        (x, now): (&VehicleState<T>, &VehicleEvaluation<T>),
        time_s: f64,
    ) -> CorrectionTerms<T> {
        let amounts = self.effects.amounts(x, now);
        let none = [x.vx_body_m_s.constant(0.0); N_RESIDUAL];
        let mut terms = CorrectionTerms { value: none, by_latents: [none; N_LATENTS] };
        if let Some(known) = self.network.strengths(component) {
            terms.value = self.effects.combined(&amounts, known);
        }
        let growth = self.latents.growth_at(time_s);
        for (latent, by_latent) in terms.by_latents.iter_mut().enumerate() {
            if !self.ignored[latent] {
                let direction = self.latents.directions[latent].map(|change| change * growth);
                *by_latent = self.effects.combined(&amounts, &direction);
            }
        }
        terms
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
        add(&mut terms.value, batch.share, &self.network.remainder(&batch.work, at));
    }

    /// The correction at given latent factors, before it is bounded.
    pub(super) fn free_correction(
        &self,
        terms: &CorrectionTerms,
        latents: &[f64; N_LATENTS],
    ) -> [f64; N_RESIDUAL] {
        let mut value = terms.value;
        for (z, by_latent) in latents.iter().zip(&terms.by_latents) {
            add(&mut value, *z, by_latent);
        }
        value
    }

    /// Probability of a component at the first state of the batch, as it was when the network had last
    /// been evaluated.
    pub(crate) fn weight(&self, component: usize, batch: &NetworkBatch) -> f64 {
        self.network.weight(&batch.work, [0, component])
    }

    /// Standard deviation of the noise of a step from the first state of the batch.
    pub(crate) fn noise(&self, component: usize, batch: &NetworkBatch) -> [f64; N_RESIDUAL] {
        let variance = self.network.variance(&batch.work, [0, component]);
        let std = variance.map(|variance| variance.min(LARGEST_VARIANCE).sqrt());
        std.map(|std| batch.share * self.latents.step_noise * std)
    }
}

/// `sum += factor · values`.
fn add(sum: &mut [f64; N_RESIDUAL], factor: f64, values: &[f64; N_RESIDUAL]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += factor * value;
    }
}
