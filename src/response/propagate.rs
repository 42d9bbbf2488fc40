//! The distribution of a motion: for each component the joint normal distribution of state and latent
//! factors, carried through the full step, so that what is uncertain about heading and position
//! accumulates.
//!
//! ```text
//! ξ = [v_x, v_y, r, φ, φ̇, z_1 … z_m, ψ, X, Y]
//! (m, P)(t+1) = unscented transform of (Step(x, u; δ_j(z) + u ⊙ z_μ,j), z) + diag(q² σ_j²) on v_x, v_y, r, φ̇
//! ```
//!
//! Points off the mean come in pairs along the columns of a lower triangular root of P, so that a
//! column leaves alone what comes before it in ξ: those of the latents see what the mean sees, and the
//! second of a pair has the first one's step mirrored at the mean's; those of the pose have the mean's
//! step turned and shifted. The paper restarts from a certain pose at every step, so that its
//! spread never grows along the path; with a certain pose this is its formula.
//!
//! Source: `eq:sigma_points_gmm` to `eq:complete_trajectory_gmm` of
//! [`PitPinnPaper`](crate::bibliography::PitPinnPaper).

use nalgebra::SMatrix;

use crate::response::features::features_of;
pub(crate) use crate::response::joint_state::N_JOINT;
use crate::response::joint_state::{
    Covariance, LEAST_VARIANCE, Mean, N_DYNAMIC, N_SEEN, NOISY, OF_COLLISION, PSI, X, Y, forget,
    latents_of, mean_of, state_of, turned,
};
use crate::response::latents::{LatentScales, N_LATENTS};
use crate::response::vehicle_network::{VehicleNetwork, Workspace};
use crate::response::{Correction, N_EFFECTS, N_FEATURES, N_RESIDUAL, STEP_S, combined, effects};
use crate::uncertainty::{Unscented, UnscentedWeights};
use crate::vehicle::{Evaluation, VehicleInput, VehicleParameters, VehicleState};

const N: usize = N_JOINT;
/// Points about the mean.
const N_POINTS: usize = 2 * N;

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
    /// Change of the strengths of the effects with each latent, where there is one.
    directions: [Vec<(usize, f64)>; N_LATENTS],
}

/// Buffers, and what was seen last.
#[derive(Default)]
pub(crate) struct Buffers {
    work: Workspace,
    features: Vec<[f64; N_FEATURES]>,
    seen: Vec<Seen>,
}

/// A state that was looked at.
struct Seen {
    x: VehicleState<f64>,
    now: Evaluation<f64>,
    /// Effects and remainder of the component with all latents none, before the bound.
    value: [f64; N_RESIDUAL],
    /// What a latent of one adds to that.
    by_latents: [[f64; N_RESIDUAL]; N_LATENTS],
}

/// What has to be done for a point that differs from the mean in one number of ξ and those after it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Anew {
    /// All.
    Look,
    /// A step from what is seen at the mean.
    Step,
    /// The mean's step in its place.
    Place,
}

impl<'a> Dynamics<'a> {
    pub(crate) fn new(
        vehicle: &'a VehicleParameters,
        network: &'a VehicleNetwork,
        scales: LatentScales,
    ) -> Self {
        let changed = |strengths: [f64; N_EFFECTS]| {
            strengths.into_iter().enumerate().filter(|(_, change)| *change != 0.0).collect()
        };
        Self { vehicle, network, scales, directions: scales.directions().map(changed) }
    }

    /// One step at given latent factors.
    pub(crate) fn step(
        &self,
        (component, latents): (usize, &[f64; N_LATENTS]),
        (x, u, time_s): (&VehicleState<f64>, &VehicleInput<f64>, f64),
        buffers: &mut Buffers,
    ) -> VehicleState<f64> {
        self.see(component, std::iter::once(*x), (u, time_s), buffers);
        let seen = buffers.seen.first();
        seen.map_or(*x, |seen| self.step_from(seen, self.correction(seen, latents), u))
    }

    /// Looks at several states at once.
    fn see(
        &self,
        component: usize,
        states: impl Iterator<Item = VehicleState<f64>>,
        (u, time_s): (&VehicleInput<f64>, f64),
        buffers: &mut Buffers,
    ) {
        let Buffers { work, features, seen } = buffers;
        features.clear();
        seen.clear();
        let strengths = self.network.strengths(component);
        for x in states {
            let now = self.vehicle.evaluate(&x, u);
            features.push(features_of(self.vehicle, &x, &now, time_s));
            let effects = effects(self.vehicle, &x, &now);
            let known = strengths.map(|strengths| combined(&effects, strengths));
            let by_latents = self.directions.each_ref().map(|direction| {
                let mut sum = [0.0; N_RESIDUAL];
                for &(k, change) in direction {
                    add(&mut sum, change, &effects[k]);
                }
                sum
            });
            seen.push(Seen { x, now, value: known.unwrap_or_default(), by_latents });
        }
        self.network.forward(features, work);
        for (idx, seen) in seen.iter_mut().enumerate() {
            add(&mut seen.value, 1.0, &self.network.remainder(work, [idx, component]));
        }
    }

    /// The correction at a state that was looked at.
    fn correction(&self, seen: &Seen, latents: &[f64; N_LATENTS]) -> [f64; N_RESIDUAL] {
        let mut value = seen.value;
        for (z, by_latent) in latents.iter().zip(&seen.by_latents) {
            add(&mut value, *z, by_latent);
        }
        self.network.bounded(value)
    }

    /// A step from a state that was looked at, with a correction.
    fn step_from(
        &self,
        seen: &Seen,
        value: [f64; N_RESIDUAL],
        u: &VehicleInput<f64>,
    ) -> VehicleState<f64> {
        self.network.correction().step_from(self.vehicle, (&seen.x, u, &seen.now), value)
    }

    /// Probability of a component at the first of the states that were seen last.
    pub(crate) fn weight(&self, component: usize, buffers: &Buffers) -> f64 {
        self.network.weight(&buffers.work, [0, component])
    }

    /// Deviation of the noise of a step from the first of the states that were seen last.
    pub(crate) fn noise(&self, component: usize, buffers: &Buffers) -> [f64; N_RESIDUAL] {
        let variance = self.network.variance(&buffers.work, [0, component]);
        variance.map(|variance| self.scales.step_noise * variance.sqrt())
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
        let mut mean = mean_of(initial, &[0.0; N_LATENTS]);
        let mut covariance = Covariance::identity() * LEAST_VARIANCE;
        let shares = self.scales.of_component(component, n_components);
        for (m, share) in shares.into_iter().enumerate() {
            mean[N_SEEN + m] = share.mean;
            covariance[(N_SEEN + m, N_SEEN + m)] = share.variance.max(LEAST_VARIANCE);
        }
        let weights = unscented.weights(N);
        let last_struck = inputs.iter().rposition(|u| u.collision.is_some());
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
            weight += self.weight(component, buffers) / inputs.len() as f64;
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
        let depends_on_pose =
            !is_free && u.collision.is_some_and(|collision| collision.in_world_axes);
        let anew = |i: usize| match i {
            _ if depends_on_pose => Anew::Look,
            i if i < N_SEEN => Anew::Look,
            i if i < N_DYNAMIC && !(is_free && OF_COLLISION.contains(&i)) => Anew::Step,
            _ => Anew::Place,
        };
        let mut offsets: [Mean; N_POINTS] = std::array::from_fn(|k| {
            let column = root.column(k / 2).into_owned();
            if k.is_multiple_of(2) { column } else { -column }
        });
        // Where the pose does not matter, a step starts from the mean's and is turned afterwards.
        let start = |offset: &Mean| {
            let mut start = *offset;
            if !depends_on_pose {
                start.fixed_rows_mut::<3>(PSI).fill(0.0);
            }
            start
        };
        let looks = offsets.iter().enumerate().filter(|(k, _)| anew(k / 2) == Anew::Look);
        let looks = looks.map(|(_, offset)| state_of(&(mean + start(offset))));
        let states = std::iter::once(state_of(mean)).chain(looks);
        self.see(component, states, (u, time_s), buffers);
        let mut seen = buffers.seen.iter();
        let at_mean = seen.next();
        let here =
            at_mean.map_or([0.0; N_RESIDUAL], |seen| self.correction(seen, &latents_of(mean)));
        let of_mean = at_mean.map_or(state_of(mean), |seen| self.step_from(seen, here, u));
        let centre = mean_of(&of_mean, &latents_of(mean));
        let correction = self.network.correction();
        // Of the point before.
        let (mut next, mut value, mut turn) = (centre, here, [0.0, 1.0]);
        for (k, offset) in offsets.iter_mut().enumerate() {
            let point = mean + *offset;
            let latents = latents_of(&point);
            let from = match anew(k / 2) {
                Anew::Look => seen.next(),
                Anew::Step => at_mean,
                Anew::Place => None,
            };
            next = match (from, anew(k / 2)) {
                (Some(seen), Anew::Step) if !k.is_multiple_of(2) => {
                    let own = self.correction(seen, &latents);
                    opposite(correction, [&next, &centre], [&value, &here, &own])
                }
                (Some(seen), _) => {
                    value = self.correction(seen, &latents);
                    mean_of(&self.step_from(seen, value, u), &latents)
                }
                (None, _) => mean_of(&of_mean, &latents),
            };
            let way = [next[X] - mean[X], next[Y] - mean[Y]];
            let pose = *offset - start(offset);
            turn = match k.is_multiple_of(2) {
                true => pose[PSI].sin_cos().into(),
                false => [-turn[0], turn[1]],
            };
            *offset = turned(next - centre, way, (&pose, turn));
        }
        let (shift, mut covariance) = moments(offsets, weights);
        for (idx, std) in NOISY.into_iter().zip(self.noise(component, buffers)) {
            covariance[(idx, idx)] += std * std;
        }
        for i in 0..N {
            covariance[(i, i)] += LEAST_VARIANCE * STEP_S;
        }
        (centre + shift, covariance)
    }
}

/// Where a step ends with a correction about as far to the other side of the centre's as that of
/// another step from the same state: it is constant over the step, so that it moves the end in
/// proportion to itself, to the third order of the step's length.
///
/// - `ends`: with the other correction, with the centre's; `values`: the other one, the centre's, its
///   own.
pub(super) fn opposite(
    correction: Correction,
    [other, centre]: [&Mean; 2],
    [there, here, own]: [&[f64; N_RESIDUAL]; 3],
) -> Mean {
    let per_unit = correction.change_per_unit();
    let mut end = centre * 2.0 - other;
    for (i, idx) in NOISY.into_iter().enumerate() {
        end[idx] += per_unit * (there[i] + own[i] - 2.0 * here[i]);
    }
    end
}

/// Mean and covariance of points about the centre.
fn moments(mut offsets: [Mean; N_POINTS], weights: &UnscentedWeights) -> (Mean, Covariance) {
    let shift = offsets.iter().sum::<Mean>() * weights.other;
    offsets.iter_mut().for_each(|offset| *offset -= shift);
    let spread = pulp::Arch::new().dispatch(SumOfSquares(&offsets));
    let of_centre = shift * shift.transpose() * weights.centre_covariance;
    (shift, spread * weights.other + of_centre)
}

/// `Σ x xᵀ`, compiled with the machine's vector instructions, a few columns at a time, so that they
/// stay in registers.
struct SumOfSquares<'a>(&'a [Mean; N_POINTS]);

impl pulp::NullaryFnOnce for SumOfSquares<'_> {
    type Output = Covariance;

    #[inline(always)]
    fn call(self) -> Covariance {
        const COLUMNS: usize = 4;
        const { assert!(N.is_multiple_of(COLUMNS)) };
        let mut columns = [[0.0; N]; N];
        for (block_idx, block) in columns.as_chunks_mut::<COLUMNS>().0.iter_mut().enumerate() {
            let mut sums = [[0.0; N]; COLUMNS];
            for x in self.0 {
                let [x] = x.data.0;
                for (c, sums) in sums.iter_mut().enumerate() {
                    for (sum, value) in sums.iter_mut().zip(x) {
                        *sum += x[block_idx * COLUMNS + c] * value;
                    }
                }
            }
            *block = sums;
        }
        Covariance::from(columns)
    }
}

/// `sum += factor · values`.
fn add(sum: &mut [f64; N_RESIDUAL], factor: f64, values: &[f64; N_RESIDUAL]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += factor * value;
    }
}

/// A lower triangular root of a covariance; what rounding took from its being positive is put back.
fn root_of(covariance: &Covariance) -> Covariance {
    let mut lifted = *covariance;
    let mut added = 1e-12;
    loop {
        if let Some(root) = lifted.cholesky() {
            return root.unpack();
        }
        if added > 1.0 {
            // Not finite: nothing is known any more.
            return Covariance::identity();
        }
        lifted = covariance + Covariance::from_diagonal(&(covariance.diagonal() * added));
        added *= 100.0;
    }
}

impl StateDistribution {
    fn of(mean: &Mean, covariance: &Covariance) -> Self {
        let order = [X, Y, PSI, 0, 1, 2];
        let covariance = SMatrix::from_fn(|i, j| covariance[(order[i], order[j])]);
        Self { mean: state_of(mean), covariance }
    }
}
