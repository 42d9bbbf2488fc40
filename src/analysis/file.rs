//! Single files.

use serde::{Deserialize, Serialize};

use crate::analysis::{Analysis, AnalysisError, Settings, StruckVehicle};
use crate::collision::Footprint;
use crate::compare::{MotionError, initial_state};
use crate::data::{Channel, FileKind, ForceHistory, Loaded, SeriesError};
use crate::vehicle::{ContactLoad, ContactPoint, Manoeuvre, SteerHistory, VehicleState};

/// What a single file does not say.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FileSetup {
    /// Speed of the struck vehicle before the impact, m/s.
    pub speed_m_s: f64,
    /// Where the force acts, body axes from the CG, m.
    pub contact_m: [f64; 2],
    /// Height above the ground at which it acts, m.
    pub contact_height_m: f64,
}

impl Default for FileSetup {
    /// A PIT at 72 km/h against the right rear quarter.
    fn default() -> Self {
        Self { speed_m_s: 20.0, contact_m: [-1.5, -0.9], contact_height_m: 0.52 }
    }
}

/// Analyses a single file: a force drives a vehicle straight ahead at the speed of `setup`; a
/// trajectory is shown, and simulated if it records velocities and force; a steer file drives a
/// vehicle without impact.
///
/// # Errors
/// [`AnalysisError`] if the motion diverges.
pub fn analyse_file(
    name: &str,
    file: &Loaded,
    setup: &FileSetup,
    settings: &Settings,
) -> Result<Analysis, AnalysisError> {
    let [x_m, y_m] = setup.contact_m;
    let contact = ContactPoint { x_m, y_m, height_m: setup.contact_height_m };
    let force = ForceHistory::from_series(&file.series, file.force_sampling()).ok();
    let reference = (file.kind == FileKind::Trajectory).then(|| file.series.clone());
    let mut notes: Vec<String> = file.notes.iter().map(ToString::to_string).collect();
    let initial = match file.kind {
        FileKind::Trajectory => initial_state(&file.series),
        FileKind::Force | FileKind::Steer => Ok(VehicleState::driving_straight(setup.speed_m_s)),
    };
    let last_s = file.series.time_s().last().copied().unwrap_or(0.0);
    let duration_s = if reference.is_some() { last_s } else { settings.duration_s };
    let struck = match (&initial, &force) {
        (Ok(initial), Some(_)) => {
            Some(StruckVehicle { vehicle: settings.target.clone(), initial: *initial, contact })
        }
        _ => None,
    };
    let simulation = match (initial, &force, file.kind) {
        (Err(SeriesError::Missing { channel }), ..) => {
            notes.push(format!("not simulated: column {} is missing", channel.header()));
            None
        }
        (Err(error), ..) => return Err(error.into()),
        (Ok(_), None, FileKind::Trajectory) => {
            notes.push("not simulated: the file records no force".to_owned());
            None
        }
        (Ok(initial), _, _) => {
            let manoeuvre = Manoeuvre {
                initial,
                contact_load: force.clone().map(|force| ContactLoad {
                    recorded_moment: force.mz_n_m.is_some(),
                    force,
                    contact,
                }),
                steer: steer_history(file),
                duration_s,
            };
            Some(settings.target.simulate(&manoeuvre, settings.integrator)?)
        }
    };
    let error = simulation.as_ref().zip(reference.as_ref()).and_then(|(simulation, reference)| {
        MotionError::between(&simulation.series, reference).ok()
    });
    Ok(Analysis {
        name: name.to_owned(),
        vehicle: settings.target.name.clone(),
        footprint: Footprint::from(&settings.target.geometry),
        struck,
        force,
        simulation,
        reference,
        bullet: None,
        error,
        notes,
    })
}

/// Steer of a steer file: the front axle's, or the mean of its wheels'. A trajectory's recorded
/// toe changes are no steering.
fn steer_history(file: &Loaded) -> Option<SteerHistory> {
    if file.kind != FileKind::Steer {
        return None;
    }
    let series = &file.series;
    let steer_rad = match series.get(Channel::Steer) {
        Some(steer) => steer.to_vec(),
        None => {
            let (left, right) = (series.get(Channel::SteerFl)?, series.get(Channel::SteerFr)?);
            left.iter().zip(right).map(|(left, right)| (left + right) / 2.0).collect()
        }
    };
    Some(SteerHistory { time_s: series.time_s().to_vec(), steer_rad })
}
