//! One step of a component of the mixture: the correction terms at a state, and the state that follows
//! at given latent factors.

use crate::response::network::vehicle_network::{VehicleNetwork, Workspace};
use crate::response::physics::effects::{EffectAmounts, EffectModel};
use crate::response::physics::features::features_of;
use crate::response::physics::step::StepModel;
use crate::response::predict::latents::{Latents, N_LATENTS};
use crate::response::{Correction, N_FEATURES, N_RESIDUAL};
use impactlab_core::numerics::Lanes;
use impactlab_core::vehicle::{
    VehicleConstants, VehicleEvaluation, VehicleInput, VehicleParameters, VehicleState,
};

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

/// Largest share of the energy which tires and resistance take that the correction gives back after the
/// time that was learned from.
const GIVEN_BACK_SHARE: f64 = 0.5;

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
pub(super) struct CorrectionTerms {
    /// Effects and remainder of the component with every latent factor at zero.
    pub value: [f64; N_RESIDUAL],
    /// Change of that by a latent factor of one.
    pub by_latents: [[f64; N_RESIDUAL]; N_LATENTS],
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

    /// Whether the network has a share in the step.
    pub(super) fn has_share(&self) -> bool {
        self.share > 0.0
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

    /// Time that the network sees: at the latest the end of the motions that it has learned from, s.
    pub(super) fn seen_time_s(&self, time_s: f64) -> f64 {
        time_s.min(self.network.learned_s())
    }

    /// One step at given latent factors.
    #[cfg(test)]
    pub(crate) fn step(
        &self,
        component: usize,
        latents: &[f64; N_LATENTS],
        x: &VehicleState<f64>,
        u: &VehicleInput<f64>,
        time_s: f64,
        batch: &mut NetworkBatch,
    ) -> VehicleState<f64> {
        let correction = self.correction(component, latents, x, u, time_s, batch);
        self.network.correction().step(self.vehicle, x, u, correction)
    }

    /// One step after what was learned from, at given latent factors. The correction does not keep up the
    /// motion of a vehicle that nothing drives.
    pub(crate) fn step_beyond(
        &self,
        component: usize,
        latents: &[f64; N_LATENTS],
        x: &VehicleState<f64>,
        u: &VehicleInput<f64>,
        time_s: f64,
        batch: &mut NetworkBatch,
    ) -> VehicleState<f64> {
        let now = self.model.constants.evaluate(x, u);
        let correction = self.correction_at(component, latents, (x, u, &now), time_s, batch);
        let kind = self.network.correction();
        let step = |value| kind.step_from(&self.model, x, u, &now.derivative, value);
        let corrected = step(correction);
        if kind == Correction::Acceleration && u.collision.is_none() && !u.is_driven() {
            let uncorrected = step([0.0; N_RESIDUAL]);
            return not_kept_up(&self.model.constants, x, &uncorrected, corrected);
        }
        corrected
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
        self.correction_at(component, latents, (x, u, &now), time_s, batch)
    }

    /// [`Dynamics::correction`] where the 4DOF model was evaluated already.
    fn correction_at(
        &self,
        component: usize,
        latents: &[f64; N_LATENTS],
        (x, u, now): (&VehicleState<f64>, &VehicleInput<f64>, &VehicleEvaluation<f64>),
        time_s: f64,
        batch: &mut NetworkBatch,
    ) -> [f64; N_RESIDUAL] {
        batch.begin(self.share_at(time_s));
        let spread = self.latents.spread_at(time_s, u);
        let mut terms = self.effects_at(component, (x, now), spread);
        if batch.has_share() {
            batch.push(features_of(self.vehicle, x, now, self.seen_time_s(time_s)));
            self.evaluate_network(batch);
            self.add_remainder(&mut terms, batch, [0, component]);
        }
        self.network.bounded(self.free_correction(&terms, latents))
    }

    /// The known effects of a component.
    ///
    /// - `spread`: factor on the latent factors over the step.
    fn effects_at(
        &self,
        component: usize,
        (x, now): (&VehicleState<f64>, &VehicleEvaluation<f64>),
        spread: f64,
    ) -> CorrectionTerms {
        let amounts = self.amounts(x, now);
        let value = self.known_effects(component, &amounts);
        CorrectionTerms { value, by_latents: self.effects_by_latents(&amounts, spread) }
    }

    /// How large the known effects are.
    #[inline(always)]
    pub(super) fn amounts<T: Lanes>(
        &self,
        x: &VehicleState<T>,
        now: &VehicleEvaluation<T>,
    ) -> EffectAmounts<T> {
        self.effects.amounts(x, now)
    }

    /// The known effects at the strengths of a component.
    #[inline(always)]
    pub(super) fn known_effects<T: Lanes>(
        &self,
        component: usize,
        amounts: &EffectAmounts<T>,
    ) -> [T; N_RESIDUAL] {
        match self.network.strengths(component) {
            Some(known) => self.effects.combined(amounts, known),
            None => amounts.none(),
        }
    }

    /// Change of the known effects by a latent factor of one.
    ///
    /// - `spread`: factor on the latent factors over the step.
    #[inline(always)]
    pub(super) fn effects_by_latents<T: Lanes>(
        &self,
        amounts: &EffectAmounts<T>,
        spread: f64,
    ) -> [[T; N_RESIDUAL]; N_LATENTS] {
        let mut by_latents = [amounts.none(); N_LATENTS];
        for (latent, by_latent) in by_latents.iter_mut().enumerate() {
            if !self.ignored[latent] {
                let direction = self.latents.directions[latent].map(|change| change * spread);
                *by_latent = self.effects.combined(amounts, &direction);
            }
        }
        by_latents
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

    /// Probability of a component at a state of the batch, as it was when the network had last been
    /// evaluated.
    ///
    /// - `at`: indices of the state in the batch and of the component.
    pub(crate) fn weight(&self, at: [usize; 2], batch: &NetworkBatch) -> f64 {
        self.network.weight(&batch.work, at)
    }

    /// Standard deviation of the noise of a step from a state of the batch.
    ///
    /// - `at`: indices of the state in the batch and of the component.
    pub(crate) fn noise(&self, at: [usize; 2], batch: &NetworkBatch) -> [f64; N_RESIDUAL] {
        let variance = self.network.variance(&batch.work, at);
        let std = variance.map(|variance| variance.min(LARGEST_VARIANCE).sqrt());
        std.map(|std| batch.share * self.latents.step_noise * std)
    }
}

/// The end of a step of a vehicle that nothing drives: of the energy that tires and resistance take, the
/// correction gives back [`GIVEN_BACK_SHARE`] at most.
///
/// - `x`: the state at the beginning;
/// - `uncorrected`, `corrected`: the ends without the correction and with it. Both are looked at and not the
///   powers: what tires take sideways at the beginning of a step is not what they take over it.
fn not_kept_up(
    constants: &VehicleConstants<f64>,
    x: &VehicleState<f64>,
    uncorrected: &VehicleState<f64>,
    corrected: VehicleState<f64>,
) -> VehicleState<f64> {
    let brought_j = |end: &VehicleState<f64>| constants.energy_brought_j(x, end);
    let taken_j = (brought_j(uncorrected) - constants.planar_energy_j(uncorrected)).max(0.0);
    let most_j = brought_j(&corrected) - (1.0 - GIVEN_BACK_SHARE) * taken_j;
    constants.with_energy_up_to(corrected, most_j)
}

/// `sum += factor · values`.
fn add(sum: &mut [f64; N_RESIDUAL], factor: f64, values: &[f64; N_RESIDUAL]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += factor * value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::{Preset, RoadSlope};

    #[test]
    fn a_correction_gives_back_half_of_what_is_taken_at_most() {
        let constants = Preset::Reference.parameters().constants();
        let [start, uncorrected] = [10.0, 9.0].map(VehicleState::driving_straight);
        // v² = 100 − ½ (100 − 81)
        let most_m_s = 90.5_f64.sqrt();
        for (corrected_m_s, expected_m_s) in [(8.5, 8.5), (9.5, 9.5), (10.0, most_m_s)] {
            let corrected = VehicleState::driving_straight(corrected_m_s);
            let end = not_kept_up(&constants, &start, &uncorrected, corrected);
            assert!((end.vx_body_m_s - expected_m_s).abs() < 1e-12, "{corrected_m_s}: {end:?}");
        }
    }

    /// Half a millimetre too far uphill, with no velocity left: no energy may be there, and none is.
    #[test]
    fn a_car_that_turns_round_on_a_slope_stands_there() {
        let mut vehicle = Preset::Reference.parameters();
        vehicle.slope = RoadSlope { grade: 0.05, cross_slope: 0.0 };
        let constants = vehicle.constants();
        let start = VehicleState::driving_straight(0.01);
        let end = VehicleState { x_m: 6e-4, ..VehicleState::default() };
        assert!(constants.energy_brought_j(&start, &end) < 0.0);
        assert_eq!(not_kept_up(&constants, &start, &end, end), end);
        let slow = VehicleState { x_m: 6e-4, ..VehicleState::driving_straight(1e-3) };
        assert_eq!(not_kept_up(&constants, &start, &end, slow), end, "no more than is there");
    }
}
