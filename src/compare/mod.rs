//! Simulation against reference.

mod metrics;

pub use metrics::{HORIZONS_S, MotionError, SPIN_YAW_CHANGE_RAD, largest_yaw_change_rad};
