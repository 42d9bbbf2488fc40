//! The 4DOF vehicle model: axes, parameters, tire forces, vertical loads, the equations of motion
//! and their integration over time.

mod constants;
mod controlled;
mod controls;
mod crush;
mod draws;
mod energy;
mod fixed_object;
pub mod frames;
mod loads;
mod multibody_record;
mod parameters;
mod preset;
mod rest;
mod road_slope;
mod scaled_mass;
mod scaled_size;
pub mod sheet;
mod state;
mod tire;

mod as_printed;
mod four_dof;
mod friction_zone;
mod ground;
mod input;

mod drivers;
mod ending;
mod ending_file;
mod fishhook;
mod held_force;
mod recorder;
mod residual_bound;
mod run;
mod simulate;
mod sine_with_dwell;
mod stability;

mod batch;
mod path_batch;
mod path_point;

mod recorded_drive;

mod tire_marks;

pub use as_printed::Equations;
pub use batch::{SimulationRun, simulate_batch};
pub use constants::VehicleConstants;
pub use controlled::ControlledVehicle;
pub use controls::{BRAKE_TORQUES, Controls, DRIVE_TORQUES, SteerHistory, WheelHistory};
pub use crush::{CrushFace, CrushParameters, CrushStiffness};
pub use draws::{
    LEAST_ROAD_FRICTION_SIGMA, ROAD_FRICTION_SPREAD, RoadDraws, Sensitivity, VehicleDraws,
    usual_road_sigma,
};
pub use drivers::{
    AntiLock, ClosedLoop, Countersteer, FollowedSpeed, Market, PitDriver, PitEnd, StabilityControl,
    TurnSide, esc_is_standard,
};
pub use ending::{
    Braking, DEFAULT_BRAKE_RISE_S, DamagedWheel, DrivenAxle, Driving, Ending, EngineBraking,
    HeldSteer,
};
pub use energy::MAX_ENERGY_GAIN;
pub use fishhook::{USUAL_STEERING_RATIO, angle_at_third_g_rad, fishhook, fishhook_amplitude_rad};
pub use fixed_object::{FIXED_MASS_KG, FIXED_YAW_INERTIA_KG_M2, FixedObject};
pub use four_dof::VehicleEvaluation;
pub use friction_zone::{
    FrictionZone, FrictionZoneError, MAX_BORDER_CORNERS, ZONE_FRICTION_LOG_SIGMA, friction_at,
    hidden_zones,
};
pub(crate) use held_force::HeldForceRun;
pub use input::{CollisionForce, ContactPoint, VehicleInput};
pub use loads::Wheel;
pub use multibody_record::MultibodyRecord;
pub use parameters::{GeometryParameters, MassParameters, SuspensionParameters, VehicleParameters};
pub use path_batch::{MAX_PATH_STEP_S, Path, PathEnd, PathLimit, simulate_paths};
pub use path_point::PathPoint;
pub use preset::{BuiltInVehicle, Preset, built_in_vehicle};
pub use recorded_drive::{RecordedDrive, RecordedMotion};
pub use rest::RestWatch;
pub use rest::{REST_DURATION_S, REST_ON_SLOPE_S, REST_SPEED_M_S, REST_YAW_RATE_RAD_S};
pub use road_slope::{RoadSlope, USUAL_SLOPE};
pub use sheet::{DataSheet, LibraryVehicle, SheetQuantity, VehicleClass};
pub use simulate::{
    ContactLoad, Integrator, Manoeuvre, Motion, MotionFlag, OUTPUT_INTERVAL_S, ROLL_LIMIT_RAD,
    SimulationError,
};
pub use sine_with_dwell::{
    SineWithDwellOutcome, sine_with_dwell, sine_with_dwell_amplitudes_rad, sine_with_dwell_outcome,
};
pub use stability::VehicleMismatch;
pub use state::{N_ACCELERATION, N_STATE, VehicleState};
pub use tire::{SLIP_ANGLE_SPEED_M_S, TIRE_WIDTH_RATIO, TireParameters, WheelEffort, WheelSlip};
pub use tire_marks::leaves_mark;
pub use tire_marks::{
    LARGEST_MARK_GAP_M, MARK_SLIP_RAD, MARK_SPEED_M_S, TireMark, TireMarkKind, TireMarkPoint,
    tire_marks,
};
