//! One recorded impact, as a receiver of satellite signals and an inertial sensor log it, made into a
//! trajectory to learn from.
//!
//! ```text
//! log ──> samples of ψ, X, Y ──> when was contact? ──> noise, liveliness ──> smoothed states, 100 Hz
//!                                                                               │
//! force file, or the impulse that explains the change of momentum ──────────────┴──> trajectory
//! ```
//!
//! - *States*: ψ, then X and Y, each by the smoother of [`MeasuredTrack`](impactlab_core::numerics::MeasuredTrack); velocities
//!   in body axes are turned into world axes by the smoothed ψ before that. Accelerations are left
//!   out: what a sensor says holds gravity by roll and pitch, and its place on the car.
//! - *Contact*: the window in which a livelier motion explains the samples best; none where nothing
//!   is gained by one.
//! - *Force*, where no file gives it: a haversine pulse over that window, with the impulse and the
//!   angular impulse that lead the 4DOF model, tire forces included, to the velocities after it.
//!   No force after the contact. It acts at the height of the CG.
//! - *Roll*, where the log has none: as the 4DOF model rolls under the recorded motion, so that
//!   nothing is learned from it.
//!
//! The log's noise is taken as white; an outlier is not thrown out.

mod log;
mod tracks;

mod contact;
mod smoothing;

mod impulse;
mod logged_impact;
#[cfg(test)]
mod tests;

pub use log::{LogError, MotionLog};
pub use logged_impact::{ForceOrigin, LogSettings, LoggedImpact};
pub use smoothing::LogNoise;
