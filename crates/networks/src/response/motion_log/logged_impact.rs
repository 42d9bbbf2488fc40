//! From a log to a trajectory to learn from.

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use crate::response::motion_log::impulse::estimated_load;
use crate::response::motion_log::tracks::LogWindow;
use crate::response::train::case::MIN_SAMPLES;
use crate::response::{LogError, LogNoise, MotionLog, N_RESIDUAL, ResponseCase, STEP_S, step};
use impactlab_core::data::{
    Channel, TIME_TOLERANCE_S, TimeSeries, check_contact_within, contact_interval,
};
use impactlab_core::ranges::SIMULATED_DURATION;
use impactlab_core::vehicle::{
    ContactLoad, Controls, Manoeuvre, SteerHistory, VehicleInput, VehicleParameters, VehicleState,
};

/// Settings for reading a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LogSettings {
    /// The struck vehicle, on its road.
    pub vehicle: VehicleParameters,
    /// Whether the vehicle was struck. Else its steering alone moved it, and no force is looked for.
    pub has_impact: bool,
    /// First contact on the log's clock, s; `None`: from the force, else from the motion.
    pub impact_s: Option<f64>,
    /// Duration of the motion from the first contact on that is learned from, s.
    pub duration_s: f64,
}

/// Where the force of a log comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ForceOrigin {
    /// The force was recorded.
    Recorded,
    /// The force was estimated from the change of momentum.
    Estimated,
    /// The log begins after the contact, or there was none.
    None,
}

/// A log made into a trajectory.
#[derive(Debug, Clone, PartialEq)]
pub struct LoggedImpact {
    /// The trajectory to learn from.
    pub case: ResponseCase,
    /// Where it begins on the log's clock, s: the first contact.
    pub start_s: f64,
    /// First contact and separation on the log's clock, s; `None` without contact.
    pub contact_s: Option<[f64; 2]>,
    /// Where its force comes from.
    pub force: ForceOrigin,
    /// Impulse on the vehicle along the axes of the force, N s: world axes if it was estimated.
    pub impulse_n_s: [f64; 2],
    /// Noise of the channels of the log.
    pub noise: LogNoise,
}

impl LoggedImpact {
    /// Smooths a log and takes or estimates its force.
    ///
    /// - `load`: the force on the log's clock; `None`: estimated, see the module.
    ///
    /// # Errors
    /// [`LogError`].
    pub fn from_log(
        log: &MotionLog,
        load: Option<ContactLoad>,
        settings: &LogSettings,
    ) -> Result<Self, LogError> {
        let [first_s, last_s] = log.ends_s();
        if last_s - first_s > SIMULATED_DURATION.high {
            let (path, duration_s) = (log.path.clone(), last_s - first_s);
            return Err(LogError::TooLong { path, duration_s, limit_s: SIMULATED_DURATION.high });
        }
        let window: LogWindow = match &load {
            Some(load) => contact_interval(&load.force).map(|(start, end)| [start, end]),
            None if settings.has_impact => log.contact(settings.impact_s)?,
            None => None,
        };
        let found_s = settings.impact_s.or(window.map(|window| window[0]));
        let start_s = found_s.unwrap_or(log.ends_s()[0]);
        let times_s = grid(log, start_s, settings.duration_s)?;
        let (states, noise) = log.states_at(&times_s, window)?;
        let vehicle = &settings.vehicle;
        let controls = Controls { steer: steer(&log.series, start_s), ..Controls::default() };
        let (load, force) = match (load, window) {
            (Some(load), _) => (Some(earlier(load, start_s)), ForceOrigin::Recorded),
            (None, None) => (None, ForceOrigin::None),
            (None, Some([from_s, to_s])) => {
                let load = estimated_load(vehicle, &controls, &states, to_s - from_s);
                let path = || log.path.clone();
                (
                    load.map_err(|source| LogError::Pulse { path: path(), source })?,
                    ForceOrigin::Estimated,
                )
            }
        };
        if let Some(load) = &load {
            let duration_s = STEP_S * states.len().saturating_sub(1) as f64;
            check_contact_within(&load.force, duration_s).map_err(|outside| {
                LogError::ForceOutside { path: log.path.clone(), start_s, outside }
            })?;
        }
        let impulse_n_s = load.as_ref().map_or([0.0; 2], |load| load.force.impulse_n_s());
        let manoeuvre = Manoeuvre {
            initial: states.first().copied().unwrap_or_default(),
            contact_load: load,
            controls,
            duration_s: settings.duration_s,
            ..Manoeuvre::default()
        };
        let inputs = manoeuvre.inputs(STEP_S, states.len().saturating_sub(1));
        let states = match log.series.get(Channel::Roll) {
            Some(_) => states,
            None => with_model_roll(vehicle, states, &inputs),
        };
        let case = ResponseCase::from_motion(name(&log.path), vehicle.clone(), states, inputs);
        Ok(Self { case, start_s, contact_s: window, force, impulse_n_s, noise })
    }
}

fn name(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Instants every [`STEP_S`] from the first contact to the end of the log, or of what is taken.
fn grid(log: &MotionLog, start_s: f64, duration_s: f64) -> Result<Vec<f64>, LogError> {
    let [from_s, to_s] = log.ends_s();
    if start_s < from_s - TIME_TOLERANCE_S || start_s > to_s {
        let (path, contact_s) = (log.path.clone(), start_s);
        return Err(LogError::ContactOutside { path, contact_s, from_s, to_s });
    }
    let n_steps = (((to_s - start_s).min(duration_s)) / STEP_S + 1e-6).floor() as usize;
    let least_s = MIN_SAMPLES as f64 * STEP_S;
    if n_steps < MIN_SAMPLES {
        let (path, duration_s) = (log.path.clone(), (to_s - start_s).min(duration_s));
        return Err(LogError::TooShort { path, start_s, duration_s, least_s });
    }
    Ok((0..=n_steps).map(|i| start_s + i as f64 * STEP_S).collect())
}

/// The same load on a clock that starts at `start_s`.
fn earlier(mut load: ContactLoad, start_s: f64) -> ContactLoad {
    load.force.time_s.iter_mut().for_each(|time_s| *time_s -= start_s);
    load
}

/// The steer of the log, if it has one.
fn steer(series: &TimeSeries, start_s: f64) -> Option<SteerHistory> {
    let steer_rad = series.get(Channel::Steer)?.to_vec();
    let time_s = series.time_s().iter().map(|time_s| time_s - start_s).collect();
    Some(SteerHistory { time_s, steer_rad })
}

/// The states with the roll that the 4DOF model has under their motion.
fn with_model_roll(
    vehicle: &VehicleParameters,
    mut states: Vec<VehicleState<f64>>,
    inputs: &[VehicleInput<f64>],
) -> Vec<VehicleState<f64>> {
    let mut roll = (0.0, 0.0);
    for (state, input) in states.iter_mut().zip(inputs) {
        (state.roll_rad, state.roll_rate_rad_s) = roll;
        let next = step(vehicle, state, input, [0.0; N_RESIDUAL]);
        roll = (next.roll_rad, next.roll_rate_rad_s);
    }
    if let Some(last) = states.last_mut() {
        (last.roll_rad, last.roll_rate_rad_s) = roll;
    }
    states
}
