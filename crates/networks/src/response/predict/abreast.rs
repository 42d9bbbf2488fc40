//! Motions of one vehicle from the same state under the same input, followed side by side: those of the
//! components of the network, or draws.
//!
//! They differ in component, latent factors and noise. So four or eight of them go through the equations of
//! motion in one vector register, and all of them through the network in one product of matrices. To the
//! last digit each is what it is by itself.

use rand_chacha::ChaCha8Rng;

use crate::response::predict::dynamics::{Dynamics, NetworkBatch};
use crate::response::predict::predictor::normal;
use crate::response::predict::side_by_side::{Advance, EvaluatedPoint, Evaluation, StepStart};
use crate::response::{N_LATENTS, N_RESIDUAL, STEP_S};
use impactlab_core::vehicle::{N_STATE, VehicleInput, VehicleState};

/// What is drawn for a motion.
pub(super) struct MotionDraw {
    pub component: usize,
    /// Drawn once.
    pub latents: [f64; N_LATENTS],
    /// The noise of the steps; `None` without noise.
    pub noise: Option<StepNoise>,
}

/// Noise of the steps of a motion.
pub(super) struct StepNoise {
    pub rng: ChaCha8Rng,
    /// Width of the distribution, see [`Widths`](crate::response::Widths).
    pub width: f64,
}

/// A motion that was followed.
pub(super) struct FollowedMotion {
    pub draw: MotionDraw,
    /// Every [`STEP_S`].
    pub states: Vec<VehicleState<f64>>,
    /// Mean probability of the component over the inputs.
    pub weight: f64,
    /// Probability of the component at each step, as long as the network has a share in them.
    pub probabilities: Vec<f64>,
    /// Index of the state in the batch of which the network was last asked.
    place: usize,
    is_moving: bool,
}

/// Buffers that the steps of the motions share.
#[derive(Default)]
struct Buffers {
    batch: NetworkBatch,
    states: Vec<[f64; N_STATE]>,
    components: Vec<usize>,
    points: Vec<EvaluatedPoint>,
    starts: Vec<StepStart>,
    ends: Vec<VehicleState<f64>>,
}

impl MotionDraw {
    /// A motion without noise.
    pub(super) fn certain(component: usize, latents: [f64; N_LATENTS]) -> Self {
        Self { component, latents, noise: None }
    }

    /// A draw of a standard normal number; 0 without noise.
    pub(super) fn normal(&mut self) -> f64 {
        self.noise.as_mut().map_or(0.0, |noise| normal(&mut noise.rng))
    }

    /// Adds the noise of a step to the velocities after it.
    ///
    /// - `std`: standard deviations of v_x, v_y, r, φ̇.
    pub(super) fn add_noise(&mut self, state: &mut VehicleState<f64>, std: [f64; N_RESIDUAL]) {
        let [vx, vy, yaw, roll] = std.map(|std| match &mut self.noise {
            Some(StepNoise { rng, width }) => std * (*width * normal(rng)),
            None => 0.0,
        });
        state.vx_body_m_s += vx;
        state.vy_body_m_s += vy;
        state.yaw_rate_rad_s += yaw;
        state.roll_rate_rad_s += roll;
    }
}

impl FollowedMotion {
    fn new(draw: MotionDraw, initial: &VehicleState<f64>) -> Self {
        Self {
            draw,
            states: vec![*initial],
            weight: 0.0,
            probabilities: Vec::new(),
            place: 0,
            is_moving: true,
        }
    }

    /// One that was not followed.
    #[cfg(test)]
    pub(super) fn of_states(
        draw: MotionDraw,
        states: Vec<VehicleState<f64>>,
        probabilities: Vec<f64>,
    ) -> Self {
        Self { draw, states, weight: 0.0, probabilities, place: 0, is_moving: false }
    }
}

impl Dynamics<'_> {
    /// Follows motions.
    ///
    /// - `inputs`: the input over each step;
    /// - `goes_on`: whether a motion is followed for another step, by its index, the time, s, and its state.
    pub(super) fn follow(
        &self,
        draws: Vec<MotionDraw>,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
        mut goes_on: impl FnMut(usize, f64, &VehicleState<f64>) -> bool,
    ) -> Vec<FollowedMotion> {
        let started = |draw| FollowedMotion::new(draw, initial);
        let mut motions: Vec<FollowedMotion> = draws.into_iter().map(started).collect();
        let mut buffers = Buffers::default();
        for (i, u) in inputs.iter().enumerate() {
            let time_s = i as f64 * STEP_S;
            buffers.states.clear();
            buffers.components.clear();
            for (idx, motion) in motions.iter_mut().enumerate().filter(|(_, it)| it.is_moving) {
                let state = motion.states.last().copied().unwrap_or(*initial);
                motion.is_moving = goes_on(idx, time_s, &state);
                if motion.is_moving {
                    buffers.states.push(state.to_array());
                    buffers.components.push(motion.draw.component);
                }
            }
            if buffers.states.is_empty() {
                break;
            }
            self.step_abreast(&mut motions, u, time_s, &mut buffers);
            for motion in motions.iter_mut().filter(|motion| motion.is_moving) {
                let at = [motion.place, motion.draw.component];
                let probability = self.weight(at, &buffers.batch);
                motion.weight += probability / inputs.len() as f64;
                if buffers.batch.has_share() {
                    motion.probabilities.push(probability);
                }
                let std = match &motion.draw.noise {
                    Some(_) => self.noise(at, &buffers.batch),
                    None => [0.0; N_RESIDUAL],
                };
                if let Some(state) = motion.states.last_mut() {
                    motion.draw.add_noise(state, std);
                }
            }
        }
        motions
    }

    /// Takes a step of all that move, without noise.
    fn step_abreast(
        &self,
        motions: &mut [FollowedMotion],
        u: &VehicleInput<f64>,
        time_s: f64,
        Buffers { batch, states, components, points, starts, ends }: &mut Buffers,
    ) {
        batch.begin(self.share_at(time_s));
        points.clear();
        pulp::Arch::new().dispatch(Evaluation {
            dynamics: self,
            components,
            u,
            time_s,
            states,
            batch,
            points,
        });
        let has_share = batch.has_share();
        if has_share {
            self.evaluate_network(batch);
        }
        starts.clear();
        let moving = motions.iter_mut().filter(|motion| motion.is_moving);
        for (place, (motion, point)) in moving.zip(points.iter_mut()).enumerate() {
            if has_share {
                motion.place = place;
                self.add_remainder(&mut point.terms, batch, [place, motion.draw.component]);
            }
            starts.push(StepStart {
                state: point.state,
                derivative: point.derivative,
                correction: self.free_correction(&point.terms, &motion.draw.latents),
            });
        }
        ends.clear();
        pulp::Arch::new().dispatch(Advance { dynamics: self, u, starts, ends });
        let moving = motions.iter_mut().filter(|motion| motion.is_moving);
        for (motion, end) in moving.zip(ends.iter()) {
            motion.states.push(*end);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::predict::test_motions::{driving, predictor, released};
    use impactlab_core::numerics::{MAX_LANES, random_stream};

    #[test]
    fn each_motion_is_what_it_is_by_itself_to_the_last_digit() {
        const STOPPED: usize = 4;
        let (predictor, initial, inputs) = (predictor(), driving(1.5), released(60));
        let dynamics = predictor.dynamics();
        let draw = |idx: usize| {
            predictor.drawn_motion(&[0.3, 0.4, 0.3], random_stream(3, "test", idx as u64))
        };
        let draws: Vec<MotionDraw> = (0..2 * MAX_LANES - 3).map(draw).collect();
        assert!((0..3).all(|component| draws.iter().any(|draw| draw.component == component)));
        let goes_on = |idx: usize, time_s: f64, _: &VehicleState<f64>| {
            idx != STOPPED || time_s < 29.5 * STEP_S
        };
        let motions = dynamics.follow(draws, &initial, &inputs, goes_on);
        for (idx, motion) in motions.iter().enumerate() {
            let n_steps = if idx == STOPPED { 30 } else { 60 };
            let (mut draw, mut batch) = (draw(idx), NetworkBatch::default());
            let (mut states, mut weight) = (vec![initial], 0.0);
            for (i, u) in inputs.iter().enumerate().take(n_steps) {
                let (component, time_s) = (draw.component, i as f64 * STEP_S);
                let mut state =
                    dynamics.step(component, &draw.latents, &states[i], u, time_s, &mut batch);
                weight += dynamics.weight([0, component], &batch) / 60.0;
                draw.add_noise(&mut state, dynamics.noise([0, component], &batch));
                states.push(state);
            }
            assert_eq!(motion.states, states, "{idx}");
            assert_eq!(motion.weight, weight, "{idx}");
        }
    }
}
