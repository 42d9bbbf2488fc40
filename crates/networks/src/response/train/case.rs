//! Trajectories as the response models learn from them: states and inputs at 100 Hz.

use std::path::Path;

use crate::learning::{
    LoadError, TrainingCase, cases_and_problems, content_digest, load_cases, load_dataset, n_steps,
};
use crate::response::{ImpactRecord, STEP_S};
use impactlab_core::compare::{ReplayError, largest_yaw_change_rad, recorded_manoeuvre};
use impactlab_core::data::{
    Case, Channel, Dataset, DatasetKind, ForceAxes, ForceHistory, Outcome, Sampling, SeriesError,
    TimeSeries, TrajectoryAttributes,
};
use impactlab_core::jobs::ProgressCallback;
use impactlab_core::numerics::{interpolate, is_quarter_turn};
use impactlab_core::ranges::SIMULATED_DURATION;
use impactlab_core::vehicle::{VehicleInput, VehicleParameters, VehicleState};

/// Steps to which numbers are rounded before they are hashed.
const DIGEST_STEP: f64 = 1e-3;

/// A recorded motion after an impact.
#[derive(Debug, Clone, PartialEq)]
pub struct ResponseCase {
    /// The name of the case in its data set.
    pub name: String,
    /// The struck vehicle, on the case's friction.
    pub vehicle: VehicleParameters,
    /// State every [`STEP_S`] from the start of the impact.
    pub states: Vec<VehicleState<f64>>,
    /// Input over each step: one fewer than states.
    pub inputs: Vec<VehicleInput<f64>>,
    /// Whether the vehicle turns by 90° or more.
    pub spins: bool,
    /// SHA-256 in hex of states and forces: the same for the same content under another name.
    pub digest: String,
}

/// A case that cannot be learned from.
#[derive(Debug, thiserror::Error)]
pub enum ResponseCaseError {
    /// The row or the file of the case lacks something.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// The motion is too short.
    #[error("case {case}: {n_samples} samples, expected {least} or more")]
    TooShort {
        /// Name of the case.
        case: String,
        /// Number of samples on the grid of 10 ms.
        n_samples: usize,
        /// Smallest number of samples.
        least: usize,
    },
    /// The motion is longer than any that is simulated; its time is probably wrong.
    #[error("case {case}: lasts {duration_s} s, expected {limit_s} s or less; check its time")]
    TooLong {
        /// Name of the case.
        case: String,
        /// From the first sample to the last, s.
        duration_s: f64,
        /// Longest motion, s.
        limit_s: f64,
    },
}

/// Smallest number of samples of a case.
pub(crate) const MIN_SAMPLES: usize = 10;

/// Steps to which positions are recorded, m, that are told apart from arbitrary numbers.
const RESOLUTIONS_M: [f64; 2] = [0.01, 0.001];

impl ResponseCase {
    /// Step to which its positions are recorded, m; 0 for a finer one. What lies between two samples is half
    /// of it at times.
    pub fn resolution_m(&self) -> f64 {
        let is_of = |resolution_m: &f64| {
            let is_multiple = |value: f64| {
                let halves = 2.0 * value / resolution_m;
                (halves - halves.round()).abs() < 1e-6 * (1.0 + halves.abs())
            };
            self.states.iter().all(|state| is_multiple(state.x_m) && is_multiple(state.y_m))
        };
        RESOLUTIONS_M.into_iter().find(is_of).unwrap_or(0.0)
    }

    /// Whether a wheel is driven, braked, dragged or locked.
    pub fn is_braked(&self) -> bool {
        self.inputs.iter().any(|input| input.wheels.is_some())
    }

    /// The trajectory of a case of a trajectory data set.
    ///
    /// - `vehicle`: the struck vehicle; its friction is replaced by the case's.
    ///
    /// # Errors
    /// [`ResponseCaseError`].
    pub fn from_case(case: &Case, vehicle: &VehicleParameters) -> Result<Self, ResponseCaseError> {
        let manoeuvre = recorded_manoeuvre(case, vehicle)?;
        let attributes = TrajectoryAttributes::read(&case.attributes).map_err(ReplayError::from)?;
        let friction = attributes.mu;
        if let [first_s, .., last_s] = case.series.time_s()
            && last_s - first_s > SIMULATED_DURATION.high
        {
            let (duration_s, limit_s) = (last_s - first_s, SIMULATED_DURATION.high);
            return Err(ResponseCaseError::TooLong {
                case: case.name.clone(),
                duration_s,
                limit_s,
            });
        }
        let in_case = |source| ReplayError::Series { case: case.name.clone(), source };
        let states = states(&case.series).map_err(in_case)?;
        if states.len() < MIN_SAMPLES {
            let (n_samples, least) = (states.len(), MIN_SAMPLES);
            return Err(ResponseCaseError::TooShort { case: case.name.clone(), n_samples, least });
        }
        let inputs = manoeuvre.inputs(STEP_S, states.len() - 1);
        let spins = is_quarter_turn(largest_yaw_change_rad(&case.series).map_err(in_case)?);
        let vehicle = vehicle.clone().with_friction(friction);
        Ok(Self { spins, ..Self::from_motion(case.name.clone(), vehicle, states, inputs) })
    }

    /// The trajectory of a motion on the grid of [`STEP_S`].
    ///
    /// - `states`: every [`STEP_S`] from the start of the impact;
    /// - `inputs`: over each step, one fewer than states.
    pub fn from_motion(
        name: String,
        vehicle: VehicleParameters,
        states: Vec<VehicleState<f64>>,
        inputs: Vec<VehicleInput<f64>>,
    ) -> Self {
        let first_rad = states.first().map_or(0.0, |state| state.yaw_rad);
        let turns = |state: &VehicleState<f64>| is_quarter_turn(state.yaw_rad - first_rad);
        let (spins, digest) = (states.iter().any(turns), digest(&states, &inputs));
        Self { name, vehicle, states, inputs, spins, digest }
    }

    /// Vehicle, driving state and forces, without what followed; `None` for a case without states.
    pub fn impact(&self) -> Option<ImpactRecord> {
        let initial = *self.states.first()?;
        let (vehicle, inputs) = (self.vehicle.clone(), self.inputs.clone());
        Some(ImpactRecord { vehicle, initial, inputs })
    }

    /// The force on the struck vehicle, means over steps of 10 ms, as it was recorded.
    pub fn force_history(&self) -> ForceHistory {
        let force = |axis: usize| -> Vec<f64> {
            self.inputs
                .iter()
                .map(|input| input.collision.map_or(0.0, |collision| collision.force_n[axis]))
                .collect()
        };
        let is_in_world = |input: &VehicleInput<f64>| {
            input.collision.is_some_and(|collision| collision.in_world_axes)
        };
        ForceHistory {
            axes: if self.inputs.iter().any(is_in_world) {
                ForceAxes::World
            } else {
                ForceAxes::Body
            },
            sampling: Sampling::ComingMean,
            time_s: (0..self.inputs.len()).map(|i| i as f64 * STEP_S).collect(),
            fx_n: force(0),
            fy_n: force(1),
            mz_n_m: None,
        }
    }

    /// The cases of a trajectory data set that can be learned from, and what is wrong with the rest.
    pub fn from_dataset(
        dataset: &Dataset,
        vehicle: &VehicleParameters,
    ) -> (Vec<Self>, Vec<ResponseCaseError>) {
        cases_and_problems(dataset, |case| Self::from_case(case, vehicle))
    }

    /// All cases of a folder with a trajectory data set.
    ///
    /// - `vehicle`: the struck vehicle; `None` for the data set's own.
    ///
    /// # Errors
    /// [`LoadError`] with the first thing that is wrong.
    pub fn load_all(
        root: &Path,
        vehicle: Option<&VehicleParameters>,
        report: &mut ProgressCallback<'_>,
    ) -> Result<Outcome<Vec<Self>>, LoadError> {
        let Outcome::Complete(dataset) = load_dataset(root, DatasetKind::Trajectory, report)?
        else {
            return Ok(Outcome::Cancelled);
        };
        let vehicle = match (vehicle, &dataset.vehicle_file) {
            (Some(vehicle), _) => vehicle.clone(),
            (None, Some(file)) => VehicleParameters::load(file)?,
            (None, None) => return Err(LoadError::NoVehicle { path: root.to_owned() }),
        };
        let cases = load_cases(&dataset, |case| Self::from_case(case, &vehicle))?;
        Ok(Outcome::Complete(cases))
    }
}

impl TrainingCase for ResponseCase {
    fn name(&self) -> &str {
        &self.name
    }

    fn digest(&self) -> &str {
        &self.digest
    }

    fn is_ordinary(&self) -> bool {
        !self.spins
    }
}

/// The states on the grid; a rate or a roll angle that the file lacks is zero.
fn states(series: &TimeSeries) -> Result<Vec<VehicleState<f64>>, SeriesError> {
    let time_s = series.time_s();
    let (start_s, end_s) = (time_s.first().copied(), time_s.last().copied());
    let (start_s, end_s) = (start_s.unwrap_or(0.0), end_s.unwrap_or(0.0));
    let n = ((end_s - start_s) / STEP_S + 1e-6).floor() as usize + 1;
    let on_grid = |values: &[f64]| -> Vec<f64> {
        let at = |i: usize| interpolate(time_s, values, (start_s + i as f64 * STEP_S).min(end_s));
        (0..n).map(|i| at(i).unwrap_or(0.0)).collect()
    };
    let needed = |channel| series.require(channel).map(on_grid);
    let known = |channel| series.get(channel).map_or_else(|| vec![0.0; n], on_grid);
    let (vx, vy, yaw) = (needed(Channel::Vx)?, needed(Channel::Vy)?, needed(Channel::Yaw)?);
    let (x, y) = (needed(Channel::X)?, needed(Channel::Y)?);
    let (yaw_rate, roll) = (known(Channel::YawRate), known(Channel::Roll));
    let roll_rate = known(Channel::RollRate);
    Ok((0..n)
        .map(|i| VehicleState {
            vx_body_m_s: vx[i],
            vy_body_m_s: vy[i],
            yaw_rad: yaw[i],
            yaw_rate_rad_s: yaw_rate[i],
            roll_rad: roll[i],
            roll_rate_rad_s: roll_rate[i],
            x_m: x[i],
            y_m: y[i],
        })
        .collect())
}

fn digest(states: &[VehicleState<f64>], inputs: &[VehicleInput<f64>]) -> String {
    let states = states.iter().flat_map(|state| state.to_array());
    let forces = inputs.iter().filter_map(|input| input.collision);
    let forces = forces.flat_map(|collision| collision.force_n).map(|force| force * DIGEST_STEP);
    content_digest(states.chain(forces).map(|value| n_steps(value, DIGEST_STEP)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::Preset;

    #[test]
    fn the_step_to_which_positions_are_recorded_is_seen() {
        let of = |positions: &[f64]| {
            let states = positions.iter().map(|x_m| VehicleState {
                x_m: *x_m,
                y_m: -2.0 * x_m,
                ..VehicleState::default()
            });
            let case = ResponseCase {
                name: "a".to_owned(),
                vehicle: Preset::Reference.parameters(),
                states: states.collect(),
                inputs: Vec::new(),
                spins: false,
                digest: String::new(),
            };
            case.resolution_m()
        };
        // Half of a step lies between two samples.
        assert_eq!(of(&[0.0, 0.12, 0.185, 0.25]), 0.01);
        assert_eq!(of(&[0.0, 0.12, 250.183]), 0.001);
        assert_eq!(of(&[0.0, 0.12, 0.183_417]), 0.0);
    }

    #[test]
    fn the_shipped_trajectories_are_read_with_their_forces_and_frictions() {
        let go_on = &mut |_| std::ops::ControlFlow::Continue(());
        let path =
            Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../datasets/trajectories-pulse"));
        let Outcome::Complete(dataset) = Dataset::load(path, go_on).unwrap() else {
            panic!("nothing cancels");
        };
        let (cases, problems) =
            ResponseCase::from_dataset(&dataset, &Preset::Reference.parameters());
        assert_eq!((cases.len(), problems.len()), (100, 0));
        assert_eq!(cases.iter().filter(|case| case.spins).count(), 52);
        let first = &cases[0];
        assert_eq!((first.name.as_str(), first.vehicle.tires.friction), ("P000", 0.71));
        assert_eq!((first.states.len(), first.inputs.len()), (400, 399));
        let impulse: f64 = first
            .inputs
            .iter()
            .filter_map(|input| input.collision)
            .map(|collision| collision.force_n[1] * STEP_S)
            .sum();
        assert!((impulse / 811.5 - 1.0).abs() < 1e-3, "{impulse} N s");
        // The record goes on with zeros; nothing pushes then, and energy must not grow.
        let last_pushed = first.inputs.iter().rposition(|input| input.collision.is_some());
        assert!(last_pushed.is_some_and(|last| last < 40), "{last_pushed:?}");
        let again = ResponseCase::from_case(&dataset.cases[0], &first.vehicle).unwrap();
        assert_eq!(again.digest, first.digest);
        assert_ne!(cases[1].digest, first.digest);
    }
}
