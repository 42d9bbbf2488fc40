//! The distribution of a motion: for each component the joint normal distribution of state and latent
//! factors, carried through the full step, so that what is uncertain about heading and position
//! accumulates.
//!
//! ```text
//! ξ = [v_x, v_y, r, φ, φ̇, z_1 … z_m, ψ, X, Y]
//! (m, P)(t+1) = unscented transform of (Step(x, u; δ_j(z) + u ⊙ z_μ,j), z) + diag(q² σ_j²) on v_x, v_y, r, φ̇
//! ```
//!
//! Pose comes last in ξ: the points that move the pose alone have the mean's motion turned and shifted,
//! and need no step of their own. The paper restarts from a certain pose at every step, so that its
//! spread never grows along the path; with a certain pose this is its formula.
//!
//! Source: `eq:sigma_points_gmm` to `eq:complete_trajectory_gmm` of
//! [`PitPinnPaper`](crate::bibliography::PitPinnPaper).

use nalgebra::{SMatrix, SVector};

use crate::response::features::features_of;
use crate::response::latents::{LatentScales, N_LATENTS};
use crate::response::vehicle_network::{ComponentOutput, VehicleNetwork, Workspace};
use crate::response::{Effects, N_EFFECTS, N_FEATURES, N_RESIDUAL, STEP_S, combined, effects};
use crate::uncertainty::{Unscented, UnscentedWeights};
use crate::vehicle::{Evaluation, VehicleInput, VehicleParameters, VehicleState};

/// Numbers of ξ.
pub(crate) const N_JOINT: usize = 8 + N_LATENTS;
const N: usize = N_JOINT;
/// Those that the step depends on: velocities, roll and latents.
const N_DYNAMIC: usize = 5 + N_LATENTS;
const PSI: usize = N_DYNAMIC;
const X: usize = N_DYNAMIC + 1;
const Y: usize = N_DYNAMIC + 2;
/// Of velocities and rates in ξ: v_x, v_y, r, φ̇.
const NOISY: [usize; N_RESIDUAL] = [0, 1, 2, 4];
/// Latent factors of the collision in ξ: they matter as long as a force acts.
const OF_COLLISION: [usize; 2] = [5 + 2, 5 + 3];
/// Variance that is added to every number of ξ so that no covariance is singular.
const LEAST_VARIANCE: f64 = 1e-12;

type Mean = SVector<f64, N>;
type Covariance = SMatrix<f64, N, N>;

/// Normal distribution of the state at an instant, of one component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateDistribution {
    /// Mean; the heading goes on beyond a turn.
    pub mean: VehicleState<f64>,
    /// Covariance of [X, Y, ψ, v_x, v_y, r], m, rad, m/s, rad/s.
    pub covariance: SMatrix<f64, 6, 6>,
}

/// Where the vehicle goes by one component, with how sure that is.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentMotion {
    /// Probability.
    pub weight: f64,
    /// Every [`STEP_S`].
    pub states: Vec<StateDistribution>,
}

/// What a step needs besides the state.
pub(crate) struct Dynamics<'a> {
    pub vehicle: &'a VehicleParameters,
    pub network: &'a VehicleNetwork,
    pub scales: LatentScales,
    pub directions: [[f64; N_EFFECTS]; N_LATENTS],
}

/// Buffers.
#[derive(Default)]
pub(crate) struct Buffers {
    work: Workspace,
    features: Vec<[f64; N_FEATURES]>,
    seen: Vec<(VehicleState<f64>, Evaluation<f64>, [f64; N_LATENTS])>,
    outputs: Vec<ComponentOutput>,
}

impl<'a> Dynamics<'a> {
    pub(crate) fn new(
        vehicle: &'a VehicleParameters,
        network: &'a VehicleNetwork,
        scales: LatentScales,
    ) -> Self {
        Self { vehicle, network, scales, directions: scales.directions() }
    }

    /// Strengths of a component at latent factors.
    fn strengths(&self, component: usize, latents: &[f64; N_LATENTS]) -> [f64; N_EFFECTS] {
        let mut strengths = self.network.strengths(component).copied().unwrap_or([0.0; N_EFFECTS]);
        for (direction, z) in self.directions.iter().zip(latents) {
            for (strength, change) in strengths.iter_mut().zip(direction) {
                *strength += z * change;
            }
        }
        strengths
    }

    /// One step at given latent factors; the network's word on all components is left in `buffers`.
    pub(crate) fn step(
        &self,
        (component, latents): (usize, &[f64; N_LATENTS]),
        (x, u, time_s): (&VehicleState<f64>, &VehicleInput<f64>, f64),
        buffers: &mut Buffers,
    ) -> VehicleState<f64> {
        self.see(std::iter::once((*x, *latents)), (u, time_s), buffers);
        self.step_seen(component, 0, u, buffers)
    }

    /// Looks at several states at once.
    fn see(
        &self,
        states: impl Iterator<Item = (VehicleState<f64>, [f64; N_LATENTS])>,
        (u, time_s): (&VehicleInput<f64>, f64),
        buffers: &mut Buffers,
    ) {
        buffers.seen.clear();
        buffers.features.clear();
        for (x, latents) in states {
            let now = self.vehicle.evaluate(&x, u);
            buffers.features.push(features_of(self.vehicle, &x, &now, time_s));
            buffers.seen.push((x, now, latents));
        }
        self.network.forward(&buffers.features, &mut buffers.work, &mut buffers.outputs);
    }

    /// A step from one of the states that were seen last.
    fn step_seen(
        &self,
        component: usize,
        idx: usize,
        u: &VehicleInput<f64>,
        buffers: &Buffers,
    ) -> VehicleState<f64> {
        let Some((x, now, latents)) = buffers.seen.get(idx) else {
            return VehicleState::default();
        };
        let of_effects: Effects<f64> = effects(self.vehicle, x, now);
        let known = combined(&of_effects, &self.strengths(component, latents));
        let output = buffers.outputs.get(idx * self.network.n_components() + component);
        let remainder = output.map_or([0.0; N_RESIDUAL], |output| output.remainder);
        let value = self.network.bounded(std::array::from_fn(|i| known[i] + remainder[i]));
        self.network.correction().step_from(self.vehicle, (x, u, now), value)
    }

    /// Probabilities of the components at the first of the states that were seen last.
    pub(crate) fn weights(&self, buffers: &Buffers) -> Vec<f64> {
        let of_first = buffers.outputs.iter().take(self.network.n_components());
        let logits = of_first.map(|output| output.logit);
        let largest = logits.clone().fold(f64::NEG_INFINITY, f64::max);
        let shares: Vec<f64> = logits.map(|logit| (logit - largest).exp()).collect();
        let sum: f64 = shares.iter().sum();
        shares.into_iter().map(|share| share / sum).collect()
    }

    /// Deviation of the noise of a step from the first of the states that were seen last.
    pub(crate) fn noise(&self, component: usize, buffers: &Buffers) -> [f64; N_RESIDUAL] {
        let output = buffers.outputs.get(component);
        output.map_or([0.0; N_RESIDUAL], |output| {
            output.variance.map(|variance| self.scales.step_noise * variance.sqrt())
        })
    }

    /// The distribution of a component's motion.
    pub(crate) fn motion(
        &self,
        (component, unscented): (usize, Unscented),
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
        buffers: &mut Buffers,
    ) -> ComponentMotion {
        let n_components = self.network.n_components();
        let mut mean = mean_of(initial, [0.0; N_LATENTS]);
        let mut covariance = Covariance::identity() * LEAST_VARIANCE;
        let shares = self.scales.of_component(component, n_components);
        for (m, share) in shares.into_iter().enumerate() {
            mean[5 + m] = share.mean;
            covariance[(5 + m, 5 + m)] = share.variance.max(LEAST_VARIANCE);
        }
        let weights = unscented.weights(N);
        let last_struck = inputs.iter().rposition(|input| input.collision.is_some());
        let n_struck = last_struck.map_or(0, |last| last + 1);
        let mut states = Vec::with_capacity(inputs.len() + 1);
        states.push(StateDistribution::of(&mean, &covariance));
        let mut weight = 0.0;
        for (i, u) in inputs.iter().enumerate() {
            if i == n_struck {
                forget(&mut covariance);
            }
            let at = (u, i as f64 * STEP_S, i >= n_struck);
            (mean, covariance) =
                self.propagate((component, &weights), (&mean, &covariance), at, buffers);
            let share = self.weights(buffers).get(component).copied();
            weight += share.unwrap_or(0.0) / inputs.len() as f64;
            states.push(StateDistribution::of(&mean, &covariance));
        }
        ComponentMotion { weight, states }
    }

    /// Mean and covariance after a step.
    ///
    /// - `is_free`: whether no force will act any more, so that what is uncertain about the collision
    ///   has had its effect.
    fn propagate(
        &self,
        (component, weights): (usize, &UnscentedWeights),
        (mean, covariance): (&Mean, &Covariance),
        (u, time_s, is_free): (&VehicleInput<f64>, f64, bool),
        buffers: &mut Buffers,
    ) -> (Mean, Covariance) {
        let root = root_of(covariance) * weights.reach;
        // A force in world axes pushes a car that is turned otherwise from another side.
        let depends_on_pose = u.collision.is_some_and(|collision| collision.in_world_axes);
        let matters = |i: &usize| match *i {
            i if i >= N_DYNAMIC => depends_on_pose,
            i => !is_free || !OF_COLLISION.contains(&i),
        };
        let stepped: Vec<usize> = (0..N).filter(matters).collect();
        let points = stepped.iter().flat_map(|&i| {
            let column = root.column(i);
            [mean + column, mean - column]
        });
        let points = std::iter::once(*mean).chain(points).map(|point| state_of(&point));
        self.see(points, (u, time_s), buffers);
        let next = |idx: usize| -> Mean {
            let latents =
                buffers.seen.get(idx).map_or([0.0; N_LATENTS], |(_, _, latents)| *latents);
            mean_of(&self.step_seen(component, idx, u, buffers), latents)
        };
        let centre = next(0);
        let mut offsets = [Mean::zeros(); 2 * N];
        for (k, &i) in stepped.iter().enumerate() {
            offsets[2 * i] = next(1 + 2 * k) - centre;
            offsets[2 * i + 1] = next(2 + 2 * k) - centre;
        }
        let moved = [centre[X] - mean[X], centre[Y] - mean[Y]];
        for i in (0..N).filter(|i| !matters(i)) {
            for (sign, slot) in [(1.0, 2 * i), (-1.0, 2 * i + 1)] {
                offsets[slot] = turned(moved, &(root.column(i) * sign).into_owned());
            }
        }
        let noise = self.noise(component, buffers);
        let shift: Mean = offsets.iter().sum::<Mean>() * weights.other;
        let mut covariance = Covariance::zeros();
        for offset in &offsets {
            let off = offset - shift;
            covariance.syger(weights.other, &off, &off, 1.0);
        }
        covariance.syger(weights.centre_covariance, &shift, &shift, 1.0);
        covariance.fill_upper_triangle_with_lower_triangle();
        for (idx, std) in NOISY.into_iter().zip(noise) {
            covariance[(idx, idx)] += std * std;
        }
        for i in 0..N {
            covariance[(i, i)] += LEAST_VARIANCE * STEP_S;
        }
        (centre + shift, covariance)
    }
}

/// What is uncertain about a collision that is over: its latent factors are no longer part of the
/// distribution.
fn forget(covariance: &mut Covariance) {
    for i in OF_COLLISION {
        covariance.fill_row(i, 0.0);
        covariance.fill_column(i, 0.0);
        covariance[(i, i)] = LEAST_VARIANCE;
    }
}

/// A lower triangular root of a covariance; what rounding took from its being positive is put back.
fn root_of(covariance: &Covariance) -> Covariance {
    let mut added = 0.0;
    loop {
        let lifted = covariance + Covariance::from_diagonal(&(covariance.diagonal() * added));
        if let Some(root) = lifted.cholesky() {
            return root.unpack();
        }
        if added > 1.0 {
            // Not finite: nothing is known any more.
            return Covariance::identity();
        }
        added = if added == 0.0 { 1e-12 } else { added * 100.0 };
    }
}

/// Where a point goes, against the mean, that differs from it in the pose alone.
///
/// - `moved`: way of the mean over the step, m; `pose`: the point against the mean.
fn turned([dx, dy]: [f64; 2], pose: &Mean) -> Mean {
    let (sin, cos) = pose[PSI].sin_cos();
    let mut offset = *pose;
    offset[X] += cos * dx - sin * dy - dx;
    offset[Y] += sin * dx + cos * dy - dy;
    offset
}

fn mean_of(x: &VehicleState<f64>, latents: [f64; N_LATENTS]) -> Mean {
    let mut mean = Mean::zeros();
    let state = [x.vx_m_s, x.vy_m_s, x.yaw_rate_rad_s, x.roll_rad, x.roll_rate_rad_s];
    for (slot, value) in mean.iter_mut().zip(state.into_iter().chain(latents)) {
        *slot = value;
    }
    mean[PSI] = x.yaw_rad;
    mean[X] = x.x_m;
    mean[Y] = x.y_m;
    mean
}

fn state_of(point: &Mean) -> (VehicleState<f64>, [f64; N_LATENTS]) {
    let state = VehicleState {
        vx_m_s: point[0],
        vy_m_s: point[1],
        yaw_rate_rad_s: point[2],
        roll_rad: point[3],
        roll_rate_rad_s: point[4],
        yaw_rad: point[PSI],
        x_m: point[X],
        y_m: point[Y],
    };
    (state, std::array::from_fn(|m| point[5 + m]))
}

impl StateDistribution {
    fn of(mean: &Mean, covariance: &Covariance) -> Self {
        let order = [X, Y, PSI, 0, 1, 2];
        let covariance = SMatrix::from_fn(|i, j| covariance[(order[i], order[j])]);
        Self { mean: state_of(mean).0, covariance }
    }
}
