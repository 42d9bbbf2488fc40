//! Controllers that see the motion of the vehicle: drivers who react to it, stability control and
//! anti-lock system. They are sampled every 10 ms, and what they ask for is held until the next sample.

mod antilock;
mod closed_loop;
mod closed_loop_run;
mod file;
mod numbers;
mod speed_follower;
mod stability_control;
mod striking_driver;
mod struck_driver;

pub use antilock::AntiLock;
pub use closed_loop::ClosedLoop;
pub(super) use closed_loop_run::ClosedLoopRun;
pub(super) use file::{entries, read_abs, read_countersteer, read_esc, read_pit};
pub use speed_follower::FollowedSpeed;
pub use stability_control::{Market, StabilityControl, esc_is_standard};
pub use striking_driver::{PitDriver, PitEnd, TurnSide};
pub use struck_driver::Countersteer;

#[cfg(test)]
mod tests;
