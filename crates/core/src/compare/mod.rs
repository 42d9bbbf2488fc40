//! Comparison of simulated with recorded motions: error metrics, the replay of trajectory data sets,
//! and recorded pairs of vehicles.

mod metrics;
mod pairs;
mod replay;

pub use metrics::{HORIZONS_S, MotionError, largest_yaw_change_rad, physical_violations};
pub use pairs::{PairAttributes, PairCase, PairCaseError, PairRecords, RecordedContact};
pub use replay::{
    DatasetReplay, ErrorSummary, Replay, ReplayError, initial_state, recorded_manoeuvre,
    replay_case, replay_dataset,
};
