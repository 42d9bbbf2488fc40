//! How the path of a recorded motion changes with the strengths of the effects.
//!
//! A trajectory is cut into windows that each start from a recorded state: over a second or two the path
//! depends on the strengths almost linearly, where over the whole motion a car that spins may turn
//! once more or once less.
//!
//! ```text
//! e = y − path(d₀) ≈ J (d − d₀)        y: X, Y, ψ, v_x, v_y, r in the middle and at the end
//! ```
//!
//! d is what is added to the strengths of the network; J is taken by differences, one strength at a
//! time.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::nn::NnError;
use crate::response::network::response_network::ResponseNetwork;
use crate::response::network::vehicle_network::{VehicleNetwork, Workspace};
use crate::response::physics::effects::EffectModel;
use crate::response::physics::features::features_of;
use crate::response::physics::step::StepModel;
use crate::response::{N_EFFECTS, N_RESIDUAL, ResponseCase, STEP_S, average_error_m};
use impactlab_core::vehicle::{VehicleInput, VehicleState};

/// Numbers of a state that are compared.
const N_OBSERVED: usize = 6;
/// Instants of a window at which they are compared, as a share of the window.
const INSTANTS: [f64; 2] = [0.5, 1.0];
/// Rows of a window.
pub(super) const N_ROWS: usize = INSTANTS.len() * N_OBSERVED;
/// Paths that are computed for a linearisation: one, and one for each strength.
pub(super) const PATHS_PER_LINEARIZATION: usize = N_EFFECTS + 1;
/// Change of a strength by which the path is differentiated.
const PROBE: f64 = 0.02;

/// A trajectory and the network for its vehicle.
pub(super) struct Predicted<'a> {
    pub case: &'a ResponseCase,
    model: StepModel,
    effects: EffectModel,
    network: VehicleNetwork,
    /// Mean strengths over the components, `[N_EFFECTS]`.
    pub strengths: DVector<f64>,
}

/// A trajectory, linearised about strengths.
pub(super) struct Linearized {
    /// `e + J d₀`, row after row of every window.
    pub target: DVector<f64>,
    /// J, `[rows, N_EFFECTS]`.
    pub by_strengths: DMatrix<f64>,
}

impl<'a> Predicted<'a> {
    /// - `remainder`: share of the remainder of the network that holds for the car.
    ///
    /// # Errors
    /// [`NnError`] if a tensor cannot be read.
    pub fn new(
        case: &'a ResponseCase,
        network: &ResponseNetwork,
        remainder: f64,
    ) -> Result<Self, NnError> {
        let network = VehicleNetwork::new(network, &case.vehicle)?.with_remainder(remainder);
        let strengths = DVector::from_row_slice(&network.mean_strengths());
        let model = StepModel::new(&case.vehicle);
        let effects = EffectModel::new(&case.vehicle);
        Ok(Self { case, model, effects, network, strengths })
    }

    /// Mean distance between the recorded path and that with the strengths of the network, m.
    ///
    /// - `last_step`: what comes after it is not looked at.
    pub fn error_m(&self, last_step: usize) -> f64 {
        let Some(&initial) = self.case.states.first() else { return 0.0 };
        let n = self.case.inputs.len().min(last_step);
        let strengths = std::array::from_fn(|k| self.strengths[k]);
        let mut work = Workspace::default();
        let mut path = vec![initial];
        let mut x = initial;
        for (i, u) in self.case.inputs[..n].iter().enumerate() {
            x = self.step(&x, u, i as f64 * STEP_S, &strengths, &mut work);
            path.push(x);
        }
        average_error_m(&path, &self.case.states[..self.case.states.len().min(n + 1)])
    }

    /// One step with strengths added, in the mean over the components.
    fn step(
        &self,
        x: &VehicleState<f64>,
        u: &VehicleInput<f64>,
        time_s: f64,
        strengths: &[f64; N_EFFECTS],
        work: &mut Workspace,
    ) -> VehicleState<f64> {
        let vehicle = &self.case.vehicle;
        let now = self.model.constants.evaluate(x, u);
        self.network.forward(&[features_of(vehicle, x, &now, time_s)], work);
        let amounts = self.effects.amounts(x, &now);
        let mut free = self.effects.combined(&amounts, strengths);
        let n = self.network.n_components();
        for component in 0..n {
            let remainder = self.network.remainder(work, [0, component]);
            for i in 0..N_RESIDUAL {
                free[i] += remainder[i] / n as f64;
            }
        }
        self.network.correction().step_from(
            &self.model,
            x,
            u,
            &now.derivative,
            self.network.bounded(free),
        )
    }

    /// Linearises the trajectory.
    ///
    /// - `added`: d₀, `[N_EFFECTS]`;
    /// - `last_step`: what comes after it is not looked at;
    /// - `window_steps`: of a window; the next one begins where it ends, so that nothing is counted twice.
    pub fn linearized(
        &self,
        added: &DVector<f64>,
        last_step: usize,
        window_steps: usize,
    ) -> Linearized {
        let n = self.case.inputs.len().min(last_step);
        let last_start = n.saturating_sub(window_steps);
        let starts: Vec<usize> = (0..=last_start).step_by(window_steps).collect();
        let windows: Vec<_> = starts
            .par_iter()
            .map(|&start| self.window(added, [start, (start + window_steps).min(n)]))
            .collect();
        let n_rows = windows.len() * N_ROWS;
        let mut target = DVector::zeros(n_rows);
        let mut by_strengths = DMatrix::zeros(n_rows, N_EFFECTS);
        for (i, (error, jacobian)) in windows.into_iter().enumerate() {
            target.rows_mut(i * N_ROWS, N_ROWS).copy_from(&(error + &jacobian * added));
            by_strengths.rows_mut(i * N_ROWS, N_ROWS).copy_from(&jacobian);
        }
        Linearized { target, by_strengths }
    }

    /// Error and Jacobian of a window.
    fn window(
        &self,
        added: &DVector<f64>,
        [start, end]: [usize; 2],
    ) -> (DVector<f64>, DMatrix<f64>) {
        let n_steps = (end - start) as f64;
        let at = INSTANTS.map(|share| (n_steps * share).round() as usize);
        let state = |i: usize| self.case.states.get(start + i).copied().unwrap_or_default();
        let mut work = Workspace::default();
        let mut path = |strengths: &DVector<f64>| -> DVector<f64> {
            let strengths = std::array::from_fn(|k| strengths[k]);
            let mut seen = DVector::zeros(N_ROWS);
            let mut x = state(0);
            for (i, u) in self.case.inputs[start..end].iter().enumerate() {
                let time_s = (start + i) as f64 * STEP_S;
                x = self.step(&x, u, time_s, &strengths, &mut work);
                for (k, _) in at.iter().enumerate().filter(|(_, at)| **at == i + 1) {
                    seen.rows_mut(k * N_OBSERVED, N_OBSERVED).copy_from_slice(&x.planar());
                }
            }
            seen
        };
        let mut strengths = &self.strengths + added;
        let predicted = path(&strengths);
        let mut recorded = DVector::zeros(N_ROWS);
        for (k, at) in at.into_iter().enumerate() {
            recorded.rows_mut(k * N_OBSERVED, N_OBSERVED).copy_from_slice(&state(at).planar());
        }
        let mut jacobian = DMatrix::zeros(N_ROWS, N_EFFECTS);
        for k in 0..N_EFFECTS {
            strengths[k] += PROBE;
            jacobian.set_column(k, &((path(&strengths) - &predicted) / PROBE));
            strengths[k] -= PROBE;
        }
        (recorded - predicted, jacobian)
    }
}

impl Linearized {
    /// Number of rows.
    pub fn n_rows(&self) -> usize {
        self.target.len()
    }
}
