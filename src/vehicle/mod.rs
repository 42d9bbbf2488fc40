//! The 4DOF vehicle model: axes, parameters, tyre forces, vertical loads, the equations of motion
//! and their integration over time.

mod energy;
pub mod frames;
mod loads;
mod multibody_record;
mod parameters;
mod preset;
pub mod sheet;
mod state;
mod tire;

mod as_printed;
mod four_dof;
mod simulate;
mod stability;

pub use as_printed::Equations;
pub use energy::MAX_ENERGY_GAIN;
pub use four_dof::{CollisionForce, ContactPoint, VehicleEvaluation, VehicleInput};
pub use loads::Wheel;
pub use multibody_record::MultibodyRecord;
pub use parameters::{GeometryParameters, MassParameters, SuspensionParameters, VehicleParameters};
pub use preset::{Preset, built_in_vehicle};
pub use sheet::{DataSheet, LibraryVehicle};
pub use simulate::{
    ContactLoad, Integrator, Manoeuvre, Motion, MotionFlag, OUTPUT_INTERVAL_S, ROLL_LIMIT_RAD,
    SimulationError, SteerHistory,
};
pub use stability::VehicleMismatch;
pub use state::{N_STATE, VehicleState};
pub use tire::{TireParameters, WheelSlip};
