//! Comparison of simulated with recorded motions: error metrics, and the replay of trajectory data
//! sets.

mod metrics;
mod replay;

pub use metrics::{
    HORIZONS_S, MotionError, SPIN_YAW_CHANGE_RAD, largest_yaw_change_rad, physical_violations,
};
pub use replay::{
    DatasetReplay, ErrorSummary, Replay, ReplayError, initial_state, recorded_manoeuvre,
    replay_case, replay_dataset,
};
