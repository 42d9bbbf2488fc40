//! Analysis of one case, file or scenario: the recorded motion, the motion simulated with the
//! four-degree-of-freedom (4DOF) vehicle model, and the difference between the two; and forecasts
//! of the impact force and of the motion after it as probability distributions. The command line
//! and the app show the same [`Analysis`].

mod case;
mod contact_pair;
mod contacts;
mod file;
mod forecast;
mod lane_chances;
mod monte_carlo;
mod motion_bands;
mod motion_columns;
mod motion_density;
mod motion_forecast;
mod motion_to_rest;
mod pair_forecast;
mod pair_row;
mod recorded_pair;
mod rest_outcome;
mod rival;
mod scenario;
mod second_contacts;
mod striking;

use impactlab_core::collision::contact::{ContactPhase, FaceLawError, PairError};
use impactlab_core::collision::{
    Footprint, FootprintError, PulseError, ScenarioError, SecondContact,
};
use impactlab_core::compare::{MotionError, ReplayError};
use impactlab_core::data::{ContactOutside, DataError, ForceHistory, SeriesError, TimeSeries};
use impactlab_core::vehicle::{
    ControlledVehicle, Controls, Ending, FrictionZone, Integrator, Motion, MotionFlag,
    SimulationError, VehicleParameters,
};

pub use case::analyse_case;
pub use contact_pair::ContactPair;
pub(crate) use contacts::told;
pub use contacts::{
    ContactPhaseReport, ContactsOutcome, InContact, PhaseForecast, PhaseOfVehicleForecast,
    PhaseOfVehicleReport,
};
pub use file::{DriveSetup, analyse_drive, analyse_recording};
pub(crate) use forecast::bands_of_draws;
pub use forecast::{ForceForecast, ForecastSettings, Mode, pulse_curves};
pub use lane_chances::{PlaceChance, place_chances};
pub(crate) use monte_carlo::FEWEST_DRAWS;
pub use monte_carlo::MonteCarloError;
pub use motion_bands::{MOTION_BAND_LEVELS, MotionBand, MotionBands};
pub use motion_columns::motion_columns;
pub use motion_density::{DensityMap, DensityTask, Region};
pub use motion_forecast::{
    MotionForecast, MotionForecastError, MotionForecastSettings, MotionOutcome, StruckVehicle,
    forecast_collision, forecast_forces,
};
pub(crate) use motion_forecast::{ended, in_world};
pub use pair_forecast::{
    BothVehicles, BothVehiclesQuestion, FirstContact, FirstForces, forecast_both,
};
pub use pair_row::{PairRow, PairRowError, PairRowQuestion, pair_row};
pub use recorded_pair::analyse_recorded_pair;
pub use rest_outcome::{MotionEnd, RestOutcome};
pub use rival::{Rival, RivalForce};
pub use scenario::{PulseSetup, analyse_scenario};
pub(crate) use scenario::{USUAL_CONTACT_HEIGHT_M, scale_of_car};
pub use second_contacts::SecondContacts;

pub(crate) use impactlab_core::vehicle::Sensitivity;

/// Vehicles and settings of the simulation of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Parameters of the struck vehicle. A trajectory case replaces the friction
    /// coefficient by its own; a force case and a scenario replace mass and yaw inertia.
    pub struck: VehicleParameters,
    /// Parameters of the striking vehicle, used where it is simulated. The case or
    /// scenario replaces its mass and yaw inertia.
    pub striking: VehicleParameters,
    /// What happens to the wheels of the struck vehicle after the first contact. A trajectory case
    /// has its own, and a steer angle that is recorded takes precedence.
    pub ending: Ending,
    /// Integration method for the equations of motion.
    pub integrator: Integrator,
    /// Duration of the simulation, s. Trajectory cases and recorded motions are simulated over the
    /// recorded duration instead.
    pub duration_s: f64,
    /// Whether the simulation ends before its duration where the struck vehicle has come to rest.
    /// The striking vehicle is followed as long.
    pub ends_at_rest: bool,
    /// Whether the vehicles of a scenario move after their first contact as if each were alone.
    pub one_contact: bool,
    /// Parts of the ground with their own friction, in the axes in which the motions are simulated;
    /// elsewhere each vehicle has the friction of its tires. Both vehicles move over them.
    pub friction_zones: Vec<FrictionZone>,
}

#[cfg(test)]
impl Settings {
    /// A coasting preset that another one has struck, over 4 s through all contacts.
    fn of_preset(struck: impactlab_core::vehicle::Preset) -> Self {
        Self {
            struck: struck.parameters(),
            striking: impactlab_core::vehicle::Preset::Bullet2000.parameters(),
            ending: Ending::default(),
            integrator: Integrator::Rk4,
            duration_s: 4.0,
            ends_at_rest: false,
            one_contact: false,
            friction_zones: Vec::new(),
        }
    }
}

/// Outline and motion of the striking vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct VehicleTrack {
    /// Outline of the vehicle.
    pub footprint: Footprint,
    /// Parameters, state at first contact, where the force acts, and what its driver and systems are to do.
    pub start: StruckVehicle,
    /// Motion of the vehicle, with at least the channels X, Y and yaw.
    pub motion: TimeSeries,
    /// What steers, drives, brakes and locks its wheels in this motion.
    pub controls: Controls,
    /// What is flagged in this motion, as far as it is simulated.
    pub flags: Vec<MotionFlag>,
}

impl VehicleTrack {
    /// The vehicle with what acted on its wheels in this motion and the ground under them.
    pub fn controlled(&self) -> ControlledVehicle<'_> {
        ControlledVehicle {
            vehicle: &self.start.vehicle,
            controls: &self.controls,
            friction_zones: &self.start.friction_zones,
        }
    }

    /// The motion as it is written to a file: with the torques at the wheels, if there are any.
    ///
    /// # Errors
    /// [`SeriesError`] if the torques do not fit the motion.
    pub fn written_motion(&self) -> Result<TimeSeries, SeriesError> {
        with_torques(&self.motion, self.controlled())
    }
}

fn with_torques(
    motion: &TimeSeries,
    vehicle: ControlledVehicle<'_>,
) -> Result<TimeSeries, SeriesError> {
    let mut series = motion.clone();
    let radius_m = vehicle.vehicle.tires.rolling_radius_m;
    for (channel, torque_n_m) in vehicle.controls.torques_n_m(series.time_s(), radius_m) {
        series.insert(channel, torque_n_m)?;
    }
    Ok(series)
}

/// Recorded and computed data of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct Analysis {
    /// Name of the case, file or scenario.
    pub name: String,
    /// Parameters with which the struck vehicle was simulated, including what the case sets.
    pub vehicle: VehicleParameters,
    /// Outline of the struck vehicle.
    pub footprint: Footprint,
    /// Contact force on the struck vehicle; `None` if no force acts or none is known.
    pub force: Option<ForceHistory>,
    /// The struck vehicle at the start of the impact: its state, the point where the force acts, and what its
    /// driver and systems are to do, of which `controls` is what came in the motion. `None` without a force,
    /// but for pairs that are followed by the contact law alone.
    pub struck: Option<StruckVehicle>,
    /// What steers, drives, brakes and locks the wheels of the struck vehicle in the simulation.
    pub controls: Controls,
    /// Whether some of that is the work of a stability control, which `controls` do not tell apart.
    pub has_stability_control: bool,
    /// Parts of the ground with their own friction, over which the vehicles were simulated.
    pub friction_zones: Vec<FrictionZone>,
    /// Motion of the struck vehicle simulated with the 4DOF model; `None` if it could not be
    /// simulated, for the reason given in `notes`.
    pub simulation: Option<Motion>,
    /// Recorded motion of the struck vehicle; `None` if there is no recording.
    pub reference: Option<TimeSeries>,
    /// Outline and motion of the striking vehicle, if known.
    pub striking: Option<VehicleTrack>,
    /// The vehicles as the contact law sees them, where both were followed through all contacts.
    pub pair: Option<ContactPair>,
    /// Phases of contact between them; empty where they were not.
    pub phases: Vec<ContactPhase>,
    /// Depth of the dents that stay, of the elements of each outline of the pair, m; likewise.
    pub dents_m: [Vec<f64>; 2],
    /// Where the two vehicles meet again after the contact, if they do and their motions do not know of
    /// it.
    pub second_contact: Option<SecondContact>,
    /// Errors of the simulated motion against the recorded one; `None` unless both exist.
    pub error: Option<MotionError>,
    /// Notes on the analysis for the user.
    pub notes: Vec<String>,
}

impl Analysis {
    /// The struck vehicle with what acts on its wheels and the ground under them.
    pub fn controlled(&self) -> ControlledVehicle<'_> {
        ControlledVehicle {
            vehicle: &self.vehicle,
            controls: &self.controls,
            friction_zones: &self.friction_zones,
        }
    }

    /// Whether the car is driven and touches nothing: no force acts, and there is no other vehicle.
    pub fn is_alone(&self) -> bool {
        self.force.is_none() && self.struck.is_none() && self.striking.is_none()
    }

    /// When the vehicles are in contact, s.
    ///
    /// - `end_s`: the end of a contact that lasts to the end of the motions.
    pub fn contacts_s(&self, end_s: f64) -> Vec<[f64; 2]> {
        let phases = self.phases.iter();
        phases.map(|phase| [phase.start_s, phase.end_s.unwrap_or(end_s)]).collect()
    }

    /// The simulated motion as it is written to a file: with the torques at the wheels, if there are any.
    /// `None` if it could not be simulated.
    ///
    /// # Errors
    /// [`SeriesError`] if the torques do not fit the motion.
    pub fn written_motion(&self) -> Result<Option<TimeSeries>, SeriesError> {
        let motion = self.simulation.as_ref();
        motion.map(|motion| with_torques(&motion.series, self.controlled())).transpose()
    }
}

/// Reason for which a case cannot be analysed.
#[derive(Debug, thiserror::Error)]
pub enum AnalysisError {
    /// An attribute of the case in the table of cases is missing or invalid.
    #[error(transparent)]
    Attributes(#[from] DataError),
    /// A column of the case's file is missing or invalid.
    #[error(transparent)]
    Series(#[from] SeriesError),
    /// The trajectory case cannot be replayed.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// The force acts outside the time of the motion.
    #[error(transparent)]
    ContactOutside(#[from] ContactOutside),
    /// The simulation of the motion failed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The collision of the scenario cannot be solved.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The shape or duration of the force pulse is invalid.
    #[error(transparent)]
    Pulse(#[from] PulseError),
    /// The dimensions of a vehicle give no outline for the contact.
    #[error(transparent)]
    Outline(#[from] FootprintError),
    /// A face of a vehicle has no law of its load.
    #[error(transparent)]
    Faces(#[from] FaceLawError),
    /// The vehicles cannot be followed through their contacts.
    #[error("the vehicles cannot be followed through their contacts")]
    Pair(#[from] PairError),
}
