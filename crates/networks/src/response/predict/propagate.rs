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
//! column leaves alone what comes before it in ξ: those of the latents see what the mean sees, those of
//! the pose have the mean's step turned and shifted. All points
//! of a step go through the equations of motion side by side. The paper restarts from a certain pose at every step, so that its
//! spread never grows along the path; with a certain pose this is its formula.
//!
//! Source: `eq:sigma_points_gmm` to `eq:complete_trajectory_gmm` of
//! [`PitPinnPaper`](impactlab_core::bibliography::PitPinnPaper).

use nalgebra::{SMatrix, SVector};

use crate::response::STEP_S;
use crate::response::predict::dynamics::{Dynamics, NetworkBatch};
use crate::response::predict::joint_state::{
    Covariance, LEAST_VARIANCE, Mean, N_DYNAMIC, N_JOINT, N_SEEN, NOISY, OF_COLLISION, PSI, X, Y,
    forget, latents_of, mean_of, state_of, turned,
};
use crate::response::predict::latents::{N_LATENTS, width_pair};
use crate::response::predict::side_by_side::{Advance, EvaluatedPoint, Evaluation, StepStart};
use impactlab_core::numerics::Lanes;
use impactlab_core::uncertainty::{Unscented, UnscentedWeights};
use impactlab_core::vehicle::{N_STATE, VehicleInput, VehicleState};

const N: usize = N_JOINT;
/// Points about the mean.
const N_POINTS: usize = 2 * N;
/// Sides of the mean on which the points of a pair lie.
const SIDES: [f64; 2] = [1.0, -1.0];

/// Normal distribution of the state at an instant, of one component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateDistribution {
    /// Mean; the heading goes on beyond a turn.
    pub mean: VehicleState<f64>,
    /// Covariance of [X, Y, ψ, v_x, v_y, r], m, rad, m/s, rad/s.
    pub covariance: SMatrix<f64, 6, 6>,
    /// What of the mean of [X, Y, ψ, v_x, v_y, r] comes from the component's part of the latent factor
    /// that the components share out: `E[z] ∂x/∂z`. It grows with the width of the distribution.
    pub by_share: SVector<f64, 6>,
}

/// A normal distribution of [X, Y, ψ, v_x, v_y, r], with its probability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlanarState {
    pub weight: f64,
    pub mean: SVector<f64, 6>,
    pub covariance: SMatrix<f64, 6, 6>,
}

/// Where the vehicle goes by one component, with how sure that is.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentMotion {
    /// Probability.
    pub weight: f64,
    /// Every [`STEP_S`].
    pub states: Vec<StateDistribution>,
    /// Ratio of the two widths of the distribution, which are equally likely; see
    /// [`Widths`](crate::response::Widths).
    pub tail_ratio: f64,
}

impl ComponentMotion {
    /// The normal distributions of both widths at an instant; one where they are equal.
    ///
    /// All that is uncertain scales with a width s, to first order also the state:
    ///
    /// ```text
    /// m_s = m + (s − 1) E[z] ∂x/∂z        P_s = s² P
    /// ```
    pub(crate) fn at(&self, instant: usize) -> impl Iterator<Item = PlanarState> + use<> {
        let widths = width_pair(self.tail_ratio);
        let [narrow, wide] = widths;
        let n_widths = if narrow < wide { 2 } else { 1 };
        let (weight, state) = (self.weight / n_widths as f64, self.states.get(instant).copied());
        widths.into_iter().take(n_widths).filter_map(move |width| {
            let state = state?;
            let mean = SVector::from(state.mean.planar()) + state.by_share * (width - 1.0);
            Some(PlanarState { weight, mean, covariance: state.covariance * (width * width) })
        })
    }
}

/// Buffers that the steps of a motion share.
#[derive(Default)]
struct StepBuffers {
    batch: NetworkBatch,
    /// The mean, and the points that are evaluated themselves.
    states: Vec<[f64; N_STATE]>,
    points: Vec<EvaluatedPoint>,
    /// The mean, and the points whose step is taken.
    starts: Vec<StepStart>,
    ends: Vec<VehicleState<f64>>,
}

/// Which results of the mean point can be reused for a sigma point, by the first component of ξ in
/// which the two differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PointReuse {
    /// Nothing: vehicle model, effects and network are evaluated at the point.
    None,
    /// The evaluation: only the step is taken again, with other latent factors.
    Evaluation,
    /// The whole step, which is turned and shifted to the pose of the point.
    Step,
}

/// Conditions that decide on the reuse of results in a step.
#[derive(Clone, Copy)]
struct ReusePlan {
    /// The latent factors on which the step does not depend.
    ignored: [bool; N_LATENTS],
    /// No force will act any more: what is uncertain about the collision has had its effect.
    is_free: bool,
    /// A force in world axes acts on a car that is turned otherwise from another side.
    depends_on_pose: bool,
}

/// A step of the distribution of a component.
#[derive(Clone, Copy)]
struct PropagatedStep<'a> {
    component: usize,
    /// What acts during the step, which begins at `time_s`.
    u: &'a VehicleInput<f64>,
    time_s: f64,
    plan: ReusePlan,
}

impl ReusePlan {
    fn new(u: &VehicleInput<f64>, is_free: bool, ignored: [bool; N_LATENTS]) -> Self {
        let in_world = u.collision.is_some_and(|collision| collision.in_world_axes);
        Self { ignored, is_free, depends_on_pose: !is_free && in_world }
    }

    /// The results that can be reused for the points of a column of the root.
    ///
    /// - `i`: index of the column, and of the first component of ξ in which the points differ from the
    ///   mean.
    fn reuse(self, i: usize) -> PointReuse {
        match i {
            i if (N_SEEN..N_DYNAMIC).contains(&i) && self.ignored[i - N_SEEN] => PointReuse::Step,
            _ if self.depends_on_pose => PointReuse::None,
            i if i < N_SEEN => PointReuse::None,
            i if i < N_DYNAMIC && !(self.is_free && OF_COLLISION.contains(&i)) => {
                PointReuse::Evaluation
            }
            _ => PointReuse::Step,
        }
    }

    /// The state from which the step of a point is taken: where the pose does not matter, it is the mean's
    /// pose, and the result is turned afterwards.
    fn start(self, offset: &Mean) -> Mean {
        let mut start = *offset;
        if !self.depends_on_pose {
            start.fixed_rows_mut::<3>(PSI).fill(0.0);
        }
        start
    }
}

impl Dynamics<'_> {
    /// The distribution of a component's motion.
    pub(crate) fn motion(
        &self,
        component: usize,
        unscented: Unscented,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> ComponentMotion {
        let mut buffers = StepBuffers::default();
        let n_components = self.network.n_components();
        let mut mean = mean_of(initial, &[0.0; N_LATENTS]);
        let mut covariance = Covariance::identity() * LEAST_VARIANCE;
        let shares = self.latents.component_shares(component, n_components);
        for (m, share) in shares.into_iter().enumerate() {
            mean[N_SEEN + m] = share.mean;
            covariance[(N_SEEN + m, N_SEEN + m)] = share.variance.max(LEAST_VARIANCE);
        }
        let weights = unscented.weights(N);
        let last_struck = inputs.iter().rposition(|u| u.collision.is_some());
        let n_struck = last_struck.map_or(0, |last| last + 1);
        let mut states = Vec::with_capacity(inputs.len() + 1);
        let (shared_out, tail_ratio) = (self.latents.shared_out, self.latents.tail_ratio);
        states.push(StateDistribution::new(&mean, &covariance, shared_out));
        let mut weight = 0.0;
        for (i, u) in inputs.iter().enumerate() {
            if i == n_struck {
                forget(&mut covariance);
            }
            let plan = ReusePlan::new(u, i >= n_struck, self.ignored());
            let step = PropagatedStep { component, u, time_s: i as f64 * STEP_S, plan };
            (mean, covariance) = self.propagate(step, &weights, &mean, &covariance, &mut buffers);
            weight += self.weight(component, &buffers.batch) / inputs.len() as f64;
            states.push(StateDistribution::new(&mean, &covariance, shared_out));
        }
        ComponentMotion { weight, states, tail_ratio }
    }

    /// Mean and covariance after a step.
    fn propagate(
        &self,
        step: PropagatedStep<'_>,
        weights: &UnscentedWeights,
        mean: &Mean,
        covariance: &Covariance,
        buffers: &mut StepBuffers,
    ) -> (Mean, Covariance) {
        let PropagatedStep { component, plan, .. } = step;
        let root = root_of(covariance) * weights.reach;
        let columns: [Mean; N] = std::array::from_fn(|i| root.column(i).into_owned());
        self.evaluate_points(step, mean, &columns, buffers);
        self.advance_points(step, mean, &columns, buffers);
        let StepBuffers { batch, ends, .. } = buffers;
        let of_mean = ends[0];
        let centre = mean_of(&of_mean, &latents_of(mean));
        let mut pairs = ends[1..].as_chunks::<2>().0.iter();
        let mut offsets = [Mean::zeros(); N_POINTS];
        for (i, (column, offsets)) in columns.iter().zip(offsets.as_chunks_mut::<2>().0).enumerate()
        {
            let own = match plan.reuse(i) {
                PointReuse::Step => None,
                PointReuse::None | PointReuse::Evaluation => pairs.next(),
            };
            let ends = own.copied().unwrap_or([of_mean; 2]);
            let pose = column - plan.start(column);
            let (sin, cos) = Lanes::sin_cos(pose[PSI]);
            for ((offset, end), side) in offsets.iter_mut().zip(&ends).zip(SIDES) {
                let next = mean_of(end, &latents_of(&(mean + column * side)));
                let way = [next[X] - mean[X], next[Y] - mean[Y]];
                *offset = turned(&(next - centre), way, &(pose * side), [sin * side, cos]);
            }
        }
        let (shift, mut covariance) = moments(offsets, weights);
        for (idx, std) in NOISY.into_iter().zip(self.noise(component, batch)) {
            covariance[(idx, idx)] += std * std;
        }
        for i in 0..N {
            covariance[(i, i)] += LEAST_VARIANCE * STEP_S;
        }
        (centre + shift, covariance)
    }

    /// Evaluates vehicle model, effects and network at the mean and at the points that do not reuse what
    /// the mean sees.
    fn evaluate_points(
        &self,
        PropagatedStep { component, u, time_s, plan }: PropagatedStep<'_>,
        mean: &Mean,
        columns: &[Mean; N],
        buffers: &mut StepBuffers,
    ) {
        let StepBuffers { batch, states, points, .. } = buffers;
        states.clear();
        states.push(state_of(mean).to_array());
        for (_, column) in
            columns.iter().enumerate().filter(|(i, _)| plan.reuse(*i) == PointReuse::None)
        {
            let offset = plan.start(column);
            states.extend(SIDES.map(|side| state_of(&(mean + offset * side)).to_array()));
        }
        batch.begin(self.share_at(time_s));
        points.clear();
        let dynamics = self;
        pulp::Arch::new().dispatch(Evaluation {
            dynamics,
            component,
            u,
            time_s,
            states,
            batch,
            points,
        });
        self.evaluate_network(batch);
        for (i, point) in points.iter_mut().enumerate() {
            self.add_remainder(&mut point.terms, batch, [i, component]);
        }
    }

    /// Takes the steps of the mean and of the points that do not reuse that of the mean.
    fn advance_points(
        &self,
        PropagatedStep { u, plan, .. }: PropagatedStep<'_>,
        mean: &Mean,
        columns: &[Mean; N],
        buffers: &mut StepBuffers,
    ) {
        let StepBuffers { points, starts, ends, .. } = buffers;
        let start = |from: &EvaluatedPoint, latents: &[f64; N_LATENTS]| StepStart {
            state: from.state,
            derivative: from.derivative,
            correction: self.free_correction(&from.terms, latents),
        };
        let at_mean = &points[0];
        starts.clear();
        starts.push(start(at_mean, &latents_of(mean)));
        let mut evaluated = points[1..].iter();
        for (i, column) in columns.iter().enumerate() {
            for side in SIDES {
                let from = match plan.reuse(i) {
                    PointReuse::None => evaluated.next(),
                    PointReuse::Evaluation => Some(at_mean),
                    PointReuse::Step => None,
                };
                if let Some(from) = from {
                    starts.push(start(from, &latents_of(&(mean + column * side))));
                }
            }
        }
        ends.clear();
        pulp::Arch::new().dispatch(Advance { dynamics: self, u, starts, ends });
    }
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
    /// - `shared_out`: the latent factor that the components share out.
    fn new(mean: &Mean, covariance: &Covariance, shared_out: usize) -> Self {
        let order = [X, Y, PSI, 0, 1, 2];
        let latent = N_SEEN + shared_out.min(N_LATENTS - 1);
        let per_variance = mean[latent] / covariance[(latent, latent)];
        Self {
            mean: state_of(mean),
            covariance: SMatrix::from_fn(|i, j| covariance[(order[i], order[j])]),
            by_share: SVector::from_fn(|i, _| covariance[(order[i], latent)] * per_variance),
        }
    }
}
