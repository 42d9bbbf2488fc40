//! One case from its file to a motion: what is recorded, what the 4DOF model makes of it, and how
//! far the two lie apart. The command line and the app show the same [`Analysis`].

mod bullet;
mod case;
mod file;
mod forecast;
mod motion_bands;
mod motion_density;
mod motion_forecast;
mod scenario;

use crate::collision::{Footprint, PulseError, ScenarioError};
use crate::compare::{MotionError, ReplayError};
use crate::data::{DataError, ForceHistory, SeriesError, TimeSeries};
use crate::vehicle::{Integrator, Motion, SimulationError, VehicleParameters};

pub use case::analyse_case;
pub use file::{DriveSetup, analyse_drive, analyse_recording};
pub use forecast::{
    Estimate, ForceForecast, ForecastSettings, Interval, Mode, Spread, pulse_curves,
};
pub use motion_bands::{MOTION_BAND_LEVELS, MotionBands};
pub use motion_density::{DensityMap, DensityTask, Region};
pub use motion_forecast::{
    MotionForecast, MotionForecastError, MotionForecastSettings, MotionOutcome, StruckVehicle,
    forecast_collision, forecast_forces,
};
pub use scenario::{PulseSetup, analyse_scenario};

/// With what a case is simulated.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The struck vehicle; friction, and for force cases mass and yaw inertia, are the case's own.
    pub target: VehicleParameters,
    /// The striking vehicle, where it is simulated; its mass and yaw inertia are the case's own.
    pub bullet: VehicleParameters,
    /// How the equations of motion are integrated.
    pub integrator: Integrator,
    /// How long, s; trajectory cases take the recorded duration.
    pub duration_s: f64,
}

/// A vehicle that moves: its outline and its motion.
#[derive(Debug, Clone, PartialEq)]
pub struct VehicleTrack {
    /// Its outline.
    pub footprint: Footprint,
    /// Its motion, with X, Y and yaw at least.
    pub motion: TimeSeries,
}

/// What is known and computed of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct Analysis {
    /// Name of the case.
    pub name: String,
    /// The struck vehicle that was simulated, with the mass and friction of the case.
    pub vehicle: VehicleParameters,
    /// Its outline.
    pub footprint: Footprint,
    /// The force on the target.
    pub force: Option<ForceHistory>,
    /// The struck vehicle as the force meets it; none without a force.
    pub struck: Option<StruckVehicle>,
    /// The 4DOF simulation.
    pub simulation: Option<Motion>,
    /// The recorded motion.
    pub reference: Option<TimeSeries>,
    /// The striking vehicle.
    pub bullet: Option<VehicleTrack>,
    /// How far the simulation lies from the reference.
    pub error: Option<MotionError>,
    /// What the user should know about how this was made.
    pub notes: Vec<String>,
}

/// A case that cannot be analysed.
#[derive(Debug, thiserror::Error)]
pub enum AnalysisError {
    /// Its row in the table of cases lacks something.
    #[error(transparent)]
    Attributes(#[from] DataError),
    /// Its file lacks something.
    #[error(transparent)]
    Series(#[from] SeriesError),
    /// It cannot be replayed.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// The motion cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The impact cannot be solved.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The pulse is not one.
    #[error(transparent)]
    Pulse(#[from] PulseError),
}
