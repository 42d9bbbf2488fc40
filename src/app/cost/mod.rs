//! What the work that a form describes will cost, measured in the background.
//!
//! It is measured once the settings of a form that is in view have rested for a moment. One form is
//! measured at a time, on threads of the lowest priority, and not while other work is running,
//! which would make it slower. When the settings change or the form is out of view, the measurement
//! is cancelled.

mod costs;
mod place;
mod update;

pub use costs::Costs;
pub use place::CostPlace;
