//! Analysis of single files: a recorded motion, or a force and a steer angle that drive a
//! simulation.

use crate::analysis::{Analysis, AnalysisError, Settings, StruckVehicle};
use impactlab_core::collision::Footprint;
use impactlab_core::compare::{MotionError, initial_state};
use impactlab_core::data::{
    ForceHistory, Loaded, SeriesError, TIME_TOLERANCE_S, check_contact_within,
};
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, Controls, Manoeuvre, Motion, SteerHistory, VehicleState,
    WheelHistory,
};

/// A force history and the point where it acts. If the history records a yaw moment, this moment is
/// used instead of the one that follows from the contact point.
pub type ActingForce = (ForceHistory, ContactPoint);

/// Initial state of a vehicle, and what pushes, steers, brakes and drives it.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveSetup {
    /// State of the vehicle at the start of the simulation.
    pub initial: VehicleState<f64>,
    /// Force on the vehicle and the point where it acts.
    pub load: Option<ActingForce>,
    /// Road-wheel angle of the front axle over time.
    pub steer: Option<SteerHistory>,
    /// What brakes and drives the wheels over time.
    pub wheels: Option<WheelHistory>,
    /// Notes for the user on the files that were read.
    pub notes: Vec<String>,
}

/// Simulates a vehicle from a given initial state under a force and a steer angle.
///
/// # Errors
/// [`AnalysisError::ContactOutside`] if the force acts outside the duration,
/// [`AnalysisError::Simulation`] if the motion diverges.
pub fn analyse_drive(
    name: &str,
    setup: DriveSetup,
    settings: &Settings,
) -> Result<Analysis, AnalysisError> {
    let DriveSetup { initial, load, steer, wheels, notes } = setup;
    if let Some((force, _)) = &load {
        check_contact_within(force, settings.duration_s)?;
    }
    let mut controls = settings.ending.controls(&settings.struck);
    controls.steer = steer.or(controls.steer);
    controls.wheels = wheels.or(controls.wheels);
    let motion = simulate(initial, settings.duration_s, load.as_ref(), controls.clone(), settings)?;
    let applied = motion.applied_controls.clone().unwrap_or_else(|| controls.clone());
    Ok(Analysis {
        simulation: Some(motion),
        notes,
        controls: applied,
        ..not_simulated(name, Some(initial), controls, load, settings)
    })
}

/// Analyses a recorded motion, and simulates it from its first sample over the recorded duration if
/// the file records velocities and there is a force. Otherwise a note says why it was not
/// simulated.
///
/// The steer angle is zero: changes of toe that a trajectory records are not steering.
///
/// # Errors
/// [`AnalysisError::Series`] if the recording is to be simulated and does not start at t = 0,
/// [`AnalysisError::Simulation`] if the motion diverges.
pub fn analyse_recording(
    name: &str,
    file: &Loaded,
    load: Option<ActingForce>,
    settings: &Settings,
) -> Result<Analysis, AnalysisError> {
    let mut notes: Vec<String> = file.notes.iter().map(ToString::to_string).collect();
    let duration_s = file.series.time_s().last().copied().unwrap_or(0.0);
    let (initial, simulation) = match (initial_state(&file.series), &load) {
        (Err(SeriesError::Missing { channel }), _) => {
            let (header, label) = (channel.header(), channel.label());
            notes.push(format!(
                "not simulated: the file has no column {header} ({label}); a simulation starts from place, \
                 heading, velocity and yaw rate of the first row"
            ));
            (None, None)
        }
        (Err(error), _) => return Err(error.into()),
        (Ok(initial), None) => {
            notes.push("not simulated: the file records no force".to_owned());
            (Some(initial), None)
        }
        (Ok(initial), Some(_)) => {
            file.series.check_starts_at_zero(TIME_TOLERANCE_S)?;
            let controls = settings.ending.controls(&settings.struck);
            let motion = simulate(initial, duration_s, load.as_ref(), controls, settings)?;
            (Some(initial), Some(motion))
        }
    };
    let between = |motion: &Motion| MotionError::between(&motion.series, &file.series);
    let error = simulation.as_ref().map(between).transpose()?;
    let reference = Some(file.series.clone());
    let controls = settings.ending.controls(&settings.struck);
    let applied = simulation.as_ref().and_then(|motion| motion.applied_controls.clone());
    let controls_of_motion = applied.unwrap_or_else(|| controls.clone());
    let analysis = not_simulated(name, initial, controls, load, settings);
    let controls = controls_of_motion;
    Ok(Analysis { simulation, reference, error, notes, controls, ..analysis })
}

/// Simulates the struck vehicle; a recorded yaw moment takes precedence over that of the contact
/// point.
fn simulate(
    initial: VehicleState<f64>,
    duration_s: f64,
    load: Option<&ActingForce>,
    controls: Controls,
    settings: &Settings,
) -> Result<Motion, AnalysisError> {
    let contact_load = load.map(|(force, contact)| ContactLoad {
        recorded_moment: force.mz_n_m.is_some(),
        force: force.clone(),
        contact: *contact,
    });
    let manoeuvre = Manoeuvre {
        initial,
        contact_load,
        controls,
        duration_s,
        ends_at_rest: settings.ends_at_rest,
        friction_zones: settings.friction_zones.clone(),
    };
    Ok(settings.struck.simulate(&manoeuvre, settings.integrator)?)
}

/// The analysis before anything is simulated.
fn not_simulated(
    name: &str,
    initial: Option<VehicleState<f64>>,
    controls: Controls,
    load: Option<ActingForce>,
    settings: &Settings,
) -> Analysis {
    let struck = initial.zip(load.as_ref()).map(|(initial, (_, contact))| StruckVehicle {
        vehicle: settings.struck.clone(),
        initial,
        contact: *contact,
        controls: controls.clone(),
        friction_zones: settings.friction_zones.clone(),
    });
    Analysis {
        name: name.to_owned(),
        footprint: Footprint::from(&settings.struck.geometry),
        vehicle: settings.struck.clone(),
        struck,
        has_stability_control: controls.has_stability_control(),
        controls,
        friction_zones: settings.friction_zones.clone(),
        force: load.map(|(force, _)| force),
        simulation: None,
        reference: None,
        striking: None,
        pair: None,
        phases: Vec::new(),
        dents_m: Default::default(),
        second_contact: None,
        error: None,
        notes: Vec::new(),
    }
}
