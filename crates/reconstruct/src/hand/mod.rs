//! What one computes by hand.
//!
//! - [`HandMethod`]: the methods that an analyst knows from the books, each with its inputs, its equation,
//!   the conditions under which it holds and its sources; [`HandQuestion`] asks one of them;
//! - [`YawMarkBias`]: how far the critical speed is off on marks of the 4DOF model;
//! - [`HandCheck`]: the methods that hold for the evidence of a collision, beside its posterior;
//! - [`HandCalculation`]: the classic calculation as the baseline of an evaluation.

mod airborne;
mod baseline;
mod calculation;
mod checks;
mod crush;
mod error;
mod field;
mod method;
mod momentum;
mod slide;
mod spread;
mod time_distance;
mod values;
mod yaw_bias;
mod yaw_mark;

pub use baseline::HandCalculation;
pub use calculation::{
    HandAnswer, HandInputs, HandNumber, HandQuantity, HandQuestion, HandSensitivity,
};
pub use checks::{HandCheck, HandSpeed};
pub use error::HandError;
pub use field::{HandDefault, HandField};
pub use method::{HandMethod, HandOutput};
pub use yaw_bias::{YawMarkBias, YawMarkRun};
pub use yaw_mark::MarkCircle;
