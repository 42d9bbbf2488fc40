//! Replay of trajectory data sets: each case is simulated with the 4DOF model from its recorded
//! initial state under its recorded force, and compared with its recorded motion.

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::collision::{Footprint, OffOutline};
use crate::compare::{MotionError, largest_yaw_change_rad, physical_violations};
use crate::data::{
    Case, CaseBraking, CaseSteering, Channel, DataError, Outcome, SeriesError, TIME_TOLERANCE_S,
    TimeSeries, TrajectoryAttributes,
};
use crate::jobs::{Progress, ProgressCallback};
use crate::numerics::{Summary, is_quarter_turn};
use crate::vehicle::{
    ContactLoad, ContactPoint, Controls, Integrator, Manoeuvre, Motion, OUTPUT_INTERVAL_S,
    SimulationError, SimulationRun, SteerHistory, VehicleParameters, VehicleState, WheelEffort,
    WheelHistory, simulate_batch,
};

/// Number of cases that are simulated in parallel between two reports of progress.
const BLOCK_CASES: usize = 32;

/// Simulation of a case and its comparison with the recorded motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// Name of the case.
    pub case: String,
    /// The simulated motion.
    pub motion: Motion,
    /// Errors of the simulated motion against the recorded one.
    pub error: MotionError,
    /// Whether the recorded motion is a spin: its yaw changes by a quarter turn or more.
    pub spin: bool,
    /// Number of samples after which the simulated kinetic energy grows without a force, see
    /// [`physical_violations`].
    pub violations: usize,
}

/// Reason for which a case cannot be simulated or compared.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// An attribute of the case in the table of cases is missing or invalid.
    #[error(transparent)]
    Attributes(#[from] DataError),
    /// A column of the case's file is missing or invalid.
    #[error("case {case}")]
    Series {
        /// Name of the case.
        case: String,
        /// The underlying error.
        source: SeriesError,
    },
    /// The force of the case does not act on the vehicle.
    #[error("case {case}")]
    Contact {
        /// Name of the case.
        case: String,
        /// How far the contact point lies off.
        source: OffOutline,
    },
    /// The simulation of the case failed.
    #[error("case {case}")]
    Simulation {
        /// Name of the case.
        case: String,
        /// The underlying error.
        source: SimulationError,
    },
}

/// Simulations and comparisons of all cases of a data set.
#[derive(Debug, Default)]
pub struct DatasetReplay {
    /// Replays of the cases, in the order of the data set.
    pub cases: Vec<Replay>,
    /// Errors of the cases that could not be simulated or compared.
    pub failures: Vec<ReplayError>,
}

/// Error metrics summarised over several cases.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ErrorSummary {
    /// Mean over time of the distance between the positions (X, Y), m.
    pub average_error_m: Summary,
    /// Score of the method: the inverse of the mean over the cases of the average error, 1/m.
    pub score_1_m: f64,
    /// Distance between the positions at the last sample, m.
    pub final_error_m: Summary,
    /// Absolute value of the wrapped heading error at the last sample, rad.
    pub final_heading_error_rad: Summary,
    /// Distance between the positions at each of [`HORIZONS_S`](crate::compare::HORIZONS_S), m, over
    /// the cases that last as long.
    pub horizon_error_m: [Option<Summary>; 4],
    /// Root mean square error of X, m.
    pub rmse_x_m: Summary,
    /// Root mean square error of Y, m.
    pub rmse_y_m: Summary,
    /// Root mean square error of v_x, m/s, over the cases that have it.
    #[serde(rename = "rmse_vx_m_s")]
    pub rmse_vx_body_m_s: Option<Summary>,
    /// Root mean square error of v_y, m/s, over the cases that have it.
    #[serde(rename = "rmse_vy_m_s")]
    pub rmse_vy_body_m_s: Option<Summary>,
    /// Root mean square error of the yaw rate, rad/s, over the cases that have it.
    pub rmse_yaw_rate_rad_s: Option<Summary>,
    /// Total number of physical violations in all cases; `None` where they are not counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub violations: Option<usize>,
}

/// The recorded initial state and contact force of a case as a manoeuvre of the recorded duration.
///
/// # Errors
/// [`ReplayError::Attributes`] if an attribute, [`ReplayError::Series`] if a column is missing or the
/// recording does not start at t = 0, [`ReplayError::Contact`] if the force does not act on the
/// vehicle.
pub fn recorded_manoeuvre(
    case: &Case,
    vehicle: &VehicleParameters,
) -> Result<Manoeuvre, ReplayError> {
    let attributes = TrajectoryAttributes::read(&case.attributes)?;
    let in_case = |source| ReplayError::Series { case: case.name.clone(), source };
    let [x_body_m, y_body_m] = attributes.contact_m;
    let contact = ContactPoint { x_body_m, y_body_m, height_m: attributes.contact_height_m };
    Footprint::from(&vehicle.geometry)
        .check_contact([x_body_m, y_body_m])
        .map_err(|source| ReplayError::Contact { case: case.name.clone(), source })?;
    let force = case.force_history().map_err(in_case)?;
    case.series.check_starts_at_zero(TIME_TOLERANCE_S).map_err(in_case)?;
    let time_s = case.series.time_s();
    let last = time_s.last().copied().unwrap_or(0.0);
    Ok(Manoeuvre {
        initial: initial_state(&case.series).map_err(in_case)?,
        contact_load: Some(ContactLoad { force, contact, recorded_moment: true }),
        controls: Controls {
            steer: attributes.steering.map(steered),
            wheels: braked(attributes.braking, vehicle),
            closed_loop: None,
        },
        duration_s: last.max(OUTPUT_INTERVAL_S),
        ..Manoeuvre::default()
    })
}

/// The wheels of a case that is braked.
fn braked(braking: Option<CaseBraking>, vehicle: &VehicleParameters) -> Option<WheelHistory> {
    let CaseBraking { start_s, rise_s, torque_n_m, locked } = braking?;
    let full = |wheel: usize| WheelEffort {
        braking_n: torque_n_m[wheel] / vehicle.tires.rolling_radius_m,
        locked: f64::from(u8::from(locked[wheel])),
        drive_n: 0.0,
    };
    Some(WheelHistory {
        time_s: vec![start_s, start_s + rise_s],
        wheels: vec![[WheelEffort::none(); 4], std::array::from_fn(full)],
    })
}

/// The front wheels of a case that is steered.
fn steered(steering: CaseSteering) -> SteerHistory {
    let CaseSteering { start_s, angle_rad, .. } = steering;
    SteerHistory { time_s: vec![start_s, steering.end_s()], steer_rad: vec![0.0, angle_rad] }
}

/// Vehicle state at the first sample of a recorded motion. Yaw rate, roll angle and roll rate are
/// zero where the file does not record them.
///
/// # Errors
/// [`SeriesError::Missing`] without position, yaw or velocity.
pub fn initial_state(series: &TimeSeries) -> Result<VehicleState<f64>, SeriesError> {
    let first = |values: &[f64]| values.first().copied().unwrap_or(0.0);
    let needed = |channel| series.require(channel).map(first);
    let known = |channel| series.get(channel).map_or(0.0, first);
    Ok(VehicleState {
        vx_body_m_s: needed(Channel::Vx)?,
        vy_body_m_s: needed(Channel::Vy)?,
        yaw_rad: needed(Channel::Yaw)?,
        yaw_rate_rad_s: known(Channel::YawRate),
        roll_rad: known(Channel::Roll),
        roll_rate_rad_s: known(Channel::RollRate),
        x_m: needed(Channel::X)?,
        y_m: needed(Channel::Y)?,
    })
}

/// Simulates a case with the friction coefficient of the case, and compares the result with the
/// recorded motion.
///
/// # Errors
/// [`ReplayError::Attributes`] or [`ReplayError::Series`] if an attribute or a column is missing,
/// [`ReplayError::Simulation`] if the motion diverges.
pub fn replay_case(
    case: &Case,
    vehicle: &VehicleParameters,
    integrator: Integrator,
) -> Result<Replay, ReplayError> {
    let (vehicle, manoeuvre) = prepared(case, vehicle)?;
    let motion = vehicle.simulate(&manoeuvre, integrator);
    compared(case, &vehicle, motion)
}

/// The vehicle of a case, on the road of the case, and its manoeuvre.
fn prepared(
    case: &Case,
    vehicle: &VehicleParameters,
) -> Result<(VehicleParameters, Manoeuvre), ReplayError> {
    let manoeuvre = recorded_manoeuvre(case, vehicle)?;
    let friction = TrajectoryAttributes::read(&case.attributes)?.mu;
    Ok((vehicle.clone().with_friction(friction), manoeuvre))
}

/// The simulated motion of a case beside the recorded one.
fn compared(
    case: &Case,
    vehicle: &VehicleParameters,
    motion: Result<Motion, SimulationError>,
) -> Result<Replay, ReplayError> {
    let in_case = |source| ReplayError::Series { case: case.name.clone(), source };
    let motion =
        motion.map_err(|source| ReplayError::Simulation { case: case.name.clone(), source })?;
    let error = MotionError::between(&motion.series, &case.series).map_err(in_case)?;
    let spin = is_quarter_turn(largest_yaw_change_rad(&case.series).map_err(in_case)?);
    let violations = physical_violations(&motion.series, vehicle).map_err(in_case)?;
    Ok(Replay { case: case.name.clone(), motion, error, spin, violations })
}

/// Simulates and compares cases, side by side where the method allows it.
fn replay_block(
    cases: &[Case],
    vehicle: &VehicleParameters,
    integrator: Integrator,
) -> Vec<Result<Replay, ReplayError>> {
    if integrator != Integrator::Rk4 {
        return cases.par_iter().map(|case| replay_case(case, vehicle, integrator)).collect();
    }
    let prepared: Vec<_> = cases.par_iter().map(|case| prepared(case, vehicle)).collect();
    let runs: Vec<SimulationRun<'_>> = prepared
        .iter()
        .flatten()
        .map(|(vehicle, manoeuvre)| SimulationRun { vehicle, manoeuvre })
        .collect();
    let mut motions = simulate_batch(&runs).into_iter();
    let of_cases = cases.iter().zip(prepared).filter_map(|(case, prepared)| match prepared {
        Ok((vehicle, _)) => Some(compared(case, &vehicle, motions.next()?)),
        Err(error) => Some(Err(error)),
    });
    of_cases.collect()
}

/// Simulates and compares the cases of a data set in parallel. A case that fails does not stop the
/// others.
///
/// - `report`: called after each block of cases; the replay is cancelled if it breaks.
pub fn replay_dataset(
    cases: &[Case],
    vehicle: &VehicleParameters,
    integrator: Integrator,
    report: &mut ProgressCallback<'_>,
) -> Outcome<DatasetReplay> {
    let mut all = DatasetReplay::default();
    let n_cases = cases.len() as u64;
    for block in cases.chunks(BLOCK_CASES) {
        for result in replay_block(block, vehicle, integrator) {
            match result {
                Ok(replay) => all.cases.push(replay),
                Err(error) => all.failures.push(error),
            }
        }
        let done = (all.cases.len() + all.failures.len()) as u64;
        if report(Progress::new(done, n_cases, "simulating")).is_break() {
            return Outcome::Cancelled;
        }
    }
    Outcome::Complete(all)
}

impl ErrorSummary {
    /// Summarises the cases for which `choose` returns true; `None` if there are none.
    pub fn from_replays<'a>(
        replays: impl IntoIterator<Item = &'a Replay>,
        choose: impl Fn(&Replay) -> bool,
    ) -> Option<Self> {
        let replays: Vec<&Replay> = replays.into_iter().filter(|replay| choose(replay)).collect();
        let violations = replays.iter().map(|replay| replay.violations).sum();
        let summary = Self::from_errors(replays.iter().map(|replay| &replay.error))?;
        Some(Self { violations: Some(violations), ..summary })
    }

    /// Summarises errors; `None` if there are none.
    pub fn from_errors<'a>(errors: impl IntoIterator<Item = &'a MotionError>) -> Option<Self> {
        let all: Vec<&MotionError> = errors.into_iter().collect();
        let errors = || all.iter().copied();
        let summary =
            |figure: &dyn Fn(&MotionError) -> f64| Summary::from_values(errors().map(figure));
        let known = |figure: fn(&MotionError) -> Option<f64>| {
            Summary::from_values(errors().filter_map(figure))
        };
        let average_error_m = summary(&|error| error.average_error_m)?;
        let horizon = |index: usize| {
            let reached = errors().map(|error| error.horizon_error_m[index]);
            Summary::from_values(reached.filter(|distance_m| !distance_m.is_nan()))
        };
        Some(Self {
            average_error_m,
            score_1_m: 1.0 / average_error_m.mean,
            final_error_m: summary(&|error| error.final_error_m)?,
            final_heading_error_rad: summary(&|error| error.final_heading_error_rad.abs())?,
            horizon_error_m: std::array::from_fn(horizon),
            rmse_x_m: summary(&|error| error.rmse_x_m)?,
            rmse_y_m: summary(&|error| error.rmse_y_m)?,
            rmse_vx_body_m_s: known(|error| error.rmse_vx_body_m_s),
            rmse_vy_body_m_s: known(|error| error.rmse_vy_body_m_s),
            rmse_yaw_rate_rad_s: known(|error| error.rmse_yaw_rate_rad_s),
            violations: None,
        })
    }
}
