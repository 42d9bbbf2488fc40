//! Single files: a recorded motion, or what drives a vehicle.

use crate::analysis::{Analysis, AnalysisError, Settings, StruckVehicle};
use crate::collision::Footprint;
use crate::compare::{MotionError, initial_state};
use crate::data::{ForceHistory, Loaded, SeriesError};
use crate::vehicle::{ContactLoad, ContactPoint, Manoeuvre, Motion, SteerHistory, VehicleState};

/// A force and the point where it acts; a yaw moment that it records overrules the point.
pub type ActingForce = (ForceHistory, ContactPoint);

/// What a vehicle does before it is pushed, and what pushes and steers it.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveSetup {
    /// State at the start.
    pub initial: VehicleState<f64>,
    /// The force on it.
    pub load: Option<ActingForce>,
    /// The road-wheel angle.
    pub steer: Option<SteerHistory>,
    /// What a person should know about the files.
    pub notes: Vec<String>,
}

/// Simulates a vehicle from a given start under a force and a steer angle.
///
/// # Errors
/// [`AnalysisError::Simulation`] if the motion diverges.
pub fn analyse_drive(
    name: &str,
    setup: DriveSetup,
    settings: &Settings,
) -> Result<Analysis, AnalysisError> {
    let DriveSetup { initial, load, steer, notes } = setup;
    let simulation = simulate((initial, settings.duration_s), load.as_ref(), steer, settings)?;
    let simulation = Some(simulation);
    Ok(Analysis { simulation, notes, ..of_load(name, Some(initial), load, settings) })
}

/// Shows a recorded motion, and simulates it from its first sample if it records velocities and a
/// force.
///
/// A trajectory's recorded toe changes are no steering.
///
/// # Errors
/// [`AnalysisError`] if the motion diverges.
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
            notes.push(format!("not simulated: column {} is missing", channel.header()));
            (None, None)
        }
        (Err(error), _) => return Err(error.into()),
        (Ok(initial), None) => {
            notes.push("not simulated: the file records no force".to_owned());
            (Some(initial), None)
        }
        (Ok(initial), Some(_)) => {
            let motion = simulate((initial, duration_s), load.as_ref(), None, settings)?;
            (Some(initial), Some(motion))
        }
    };
    let between = |motion: &Motion| MotionError::between(&motion.series, &file.series).ok();
    let error = simulation.as_ref().and_then(between);
    let reference = Some(file.series.clone());
    let analysis = of_load(name, initial, load, settings);
    Ok(Analysis { simulation, reference, error, notes, ..analysis })
}

fn simulate(
    (initial, duration_s): (VehicleState<f64>, f64),
    load: Option<&ActingForce>,
    steer: Option<SteerHistory>,
    settings: &Settings,
) -> Result<Motion, AnalysisError> {
    let contact_load = load.map(|(force, contact)| ContactLoad {
        recorded_moment: force.mz_n_m.is_some(),
        force: force.clone(),
        contact: *contact,
    });
    let manoeuvre = Manoeuvre { initial, contact_load, steer, duration_s };
    Ok(settings.target.simulate(&manoeuvre, settings.integrator)?)
}

/// What is known before anything is simulated.
fn of_load(
    name: &str,
    initial: Option<VehicleState<f64>>,
    load: Option<ActingForce>,
    settings: &Settings,
) -> Analysis {
    let struck = initial.zip(load.as_ref()).map(|(initial, (_, contact))| StruckVehicle {
        vehicle: settings.target.clone(),
        initial,
        contact: *contact,
    });
    Analysis {
        name: name.to_owned(),
        footprint: Footprint::from(&settings.target.geometry),
        vehicle: settings.target.clone(),
        struck,
        force: load.map(|(force, _)| force),
        simulation: None,
        reference: None,
        bullet: None,
        error: None,
        notes: Vec::new(),
    }
}
