//! Simulates the cases of a trajectory dataset from their recorded initial state and force, and
//! compares each with its recorded motion.

use rayon::prelude::*;
use serde::Serialize;

use crate::compare::{
    MotionError, SPIN_YAW_CHANGE_RAD, largest_yaw_change_rad, physical_violations,
};
use crate::data::{
    Case, Channel, DataError, Outcome, SeriesError, TimeSeries, TrajectoryAttributes,
};
use crate::jobs::{Progress, ProgressCallback};
use crate::numerics::Summary;
use crate::vehicle::{
    ContactLoad, ContactPoint, Integrator, Manoeuvre, Motion, OUTPUT_INTERVAL_S, SimulationError,
    VehicleParameters, VehicleState,
};

/// Cases that are simulated in parallel between two reports of progress.
const BLOCK_CASES: usize = 32;

/// One case, simulated and compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// Name of the case.
    pub case: String,
    /// The simulated motion.
    pub motion: Motion,
    /// How far it lies from the recorded one.
    pub error: MotionError,
    /// Whether the recorded motion is a spin.
    pub spin: bool,
    /// How often the simulated kinetic energy grows without a force: see [`physical_violations`].
    pub violations: usize,
}

/// A case that cannot be simulated or compared.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// Its row in the table of cases lacks something.
    #[error(transparent)]
    Attributes(#[from] DataError),
    /// Its file lacks something.
    #[error("case {case}")]
    Series {
        /// Name of the case.
        case: String,
        /// What it lacks.
        source: SeriesError,
    },
    /// The simulation failed.
    #[error("case {case}")]
    Simulation {
        /// Name of the case.
        case: String,
        /// Why.
        source: SimulationError,
    },
}

/// All cases of a dataset, simulated and compared.
#[derive(Debug, Default)]
pub struct DatasetReplay {
    /// The cases, in the dataset's order.
    pub cases: Vec<Replay>,
    /// Those that could not be done.
    pub failures: Vec<ReplayError>,
}

/// Error figures over several cases.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ErrorSummary {
    /// Mean over time of the distance in (X, Y), m.
    pub average_error_m: Summary,
    /// `1/mean` of the average error, 1/m.
    pub score_1_m: f64,
    /// Distance at the last sample, m.
    pub final_error_m: Summary,
    /// Size of the final heading error, rad.
    pub final_heading_error_rad: Summary,
    /// Distance at each of [`HORIZONS_S`](crate::compare::HORIZONS_S), m.
    pub horizon_error_m: [Summary; 4],
    /// Root mean square error of X, m.
    pub rmse_x_m: Summary,
    /// Root mean square error of Y, m.
    pub rmse_y_m: Summary,
    /// Root mean square error of v_x, m/s, where it is known.
    pub rmse_vx_m_s: Option<Summary>,
    /// Root mean square error of v_y, m/s, where it is known.
    pub rmse_vy_m_s: Option<Summary>,
    /// Root mean square error of the yaw rate, rad/s, where it is known.
    pub rmse_yaw_rate_rad_s: Option<Summary>,
    /// Physical violations of all cases.
    pub violations: usize,
}

/// The recorded initial state and force of a case as a manoeuvre of its recorded duration.
///
/// # Errors
/// [`ReplayError`] if an attribute or a column is missing.
pub fn recorded_manoeuvre(case: &Case) -> Result<Manoeuvre, ReplayError> {
    let attributes = TrajectoryAttributes::read(&case.attributes)?;
    let in_case = |source| ReplayError::Series { case: case.name.clone(), source };
    let [x_m, y_m] = attributes.contact_m;
    let contact = ContactPoint { x_m, y_m, height_m: attributes.contact_height_m };
    let force = case.force_history().map_err(in_case)?;
    let time_s = case.series.time_s();
    let last = time_s.last().copied().unwrap_or(0.0);
    Ok(Manoeuvre {
        initial: initial_state(&case.series).map_err(in_case)?,
        contact_load: Some(ContactLoad { force, contact, recorded_moment: true }),
        steer: None,
        duration_s: last.max(OUTPUT_INTERVAL_S),
    })
}

/// State at the first sample; a rate or a roll angle that the file lacks is zero.
///
/// # Errors
/// [`SeriesError::Missing`] without pose or velocity.
pub fn initial_state(series: &TimeSeries) -> Result<VehicleState<f64>, SeriesError> {
    let first = |values: &[f64]| values.first().copied().unwrap_or(0.0);
    let needed = |channel| series.require(channel).map(first);
    let known = |channel| series.get(channel).map_or(0.0, first);
    Ok(VehicleState {
        vx_m_s: needed(Channel::Vx)?,
        vy_m_s: needed(Channel::Vy)?,
        yaw_rad: needed(Channel::Yaw)?,
        yaw_rate_rad_s: known(Channel::YawRate),
        roll_rad: known(Channel::Roll),
        roll_rate_rad_s: known(Channel::RollRate),
        x_m: needed(Channel::X)?,
        y_m: needed(Channel::Y)?,
    })
}

/// Simulates a case with a vehicle on the case's own friction, and compares.
///
/// # Errors
/// [`ReplayError`].
pub fn replay_case(
    case: &Case,
    vehicle: &VehicleParameters,
    integrator: Integrator,
) -> Result<Replay, ReplayError> {
    let in_case = |source| ReplayError::Series { case: case.name.clone(), source };
    let manoeuvre = recorded_manoeuvre(case)?;
    let friction = TrajectoryAttributes::read(&case.attributes)?.mu;
    let vehicle = vehicle.clone().with_friction(friction);
    let motion = vehicle
        .simulate(&manoeuvre, integrator)
        .map_err(|source| ReplayError::Simulation { case: case.name.clone(), source })?;
    let error = MotionError::between(&motion.series, &case.series).map_err(in_case)?;
    let spin = largest_yaw_change_rad(&case.series).map_err(in_case)? > SPIN_YAW_CHANGE_RAD;
    let violations = physical_violations(&motion.series, &vehicle).map_err(in_case)?;
    Ok(Replay { case: case.name.clone(), motion, error, spin, violations })
}

/// Simulates and compares cases of a data set in parallel. A case that fails does not stop
/// the others.
pub fn replay_dataset(
    cases: &[Case],
    vehicle: &VehicleParameters,
    integrator: Integrator,
    report: &mut ProgressCallback<'_>,
) -> Outcome<DatasetReplay> {
    let mut all = DatasetReplay::default();
    let n_cases = cases.len() as u64;
    for block in cases.chunks(BLOCK_CASES) {
        let results: Vec<_> =
            block.par_iter().map(|case| replay_case(case, vehicle, integrator)).collect();
        for result in results {
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
    /// Sums up the cases that `choose` takes; `None` if it takes none.
    pub fn of<'a>(
        replays: impl IntoIterator<Item = &'a Replay>,
        choose: impl Fn(&Replay) -> bool,
    ) -> Option<Self> {
        let replays: Vec<&Replay> = replays.into_iter().filter(|replay| choose(replay)).collect();
        let errors = || replays.iter().map(|replay| &replay.error);
        let of = |figure: &dyn Fn(&MotionError) -> f64| Summary::of(errors().map(figure));
        let known =
            |figure: fn(&MotionError) -> Option<f64>| Summary::of(errors().filter_map(figure));
        let average_error_m = of(&|error| error.average_error_m)?;
        let horizon = |index: usize| of(&|error| error.horizon_error_m[index]);
        Some(Self {
            average_error_m,
            score_1_m: 1.0 / average_error_m.mean,
            final_error_m: of(&|error| error.final_error_m)?,
            final_heading_error_rad: of(&|error| error.final_heading_error_rad.abs())?,
            horizon_error_m: [horizon(0)?, horizon(1)?, horizon(2)?, horizon(3)?],
            rmse_x_m: of(&|error| error.rmse_x_m)?,
            rmse_y_m: of(&|error| error.rmse_y_m)?,
            rmse_vx_m_s: known(|error| error.rmse_vx_m_s),
            rmse_vy_m_s: known(|error| error.rmse_vy_m_s),
            rmse_yaw_rate_rad_s: known(|error| error.rmse_yaw_rate_rad_s),
            violations: replays.iter().map(|replay| replay.violations).sum(),
        })
    }
}
