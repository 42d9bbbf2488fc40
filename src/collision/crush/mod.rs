//! Two cars that crush each other: how the contact force grows and fades while they do.
//!
//! The momentum solution of [`Impact`](crate::collision::Impact) knows the impulse but no time.
//! Here the vehicles are rigid in the plane, as there, and their skins give way where they overlap:
//! the bullet's outline is a row of springs that crush and do not come back all the way (a Winkler
//! foundation). Integrating the motion gives onset, duration, shape and impulse of the force at
//! once, and conserves linear and angular momentum by construction. What the springs are like is
//! learned from force histories ([`CrushLaw::fit`]); no network is needed for that.
//!
//! - [`CrushLaw`]: the parameters and what they mean;
//! - [`CrushLaw::simulate`]: force over time of a [`CrushScenario`];
//! - [`CrushLaw::fit`]: non-linear least squares on known histories.
//!
//! Assumptions: planar motion; the target's side is straight; springs do not feel their neighbours;
//! tyres play no part during contact. Left out: wheels that turn, parts that tear off, height.
//! Validated by cross-validation on the shipped finite-element runs (`docs/VALIDATION.md`).

mod fit;
mod law;
mod outline;
mod simulate;

pub use fit::{CrushFit, CrushSample};
pub use law::{BodyCrush, CrushLaw};
pub use outline::Nose;
pub use simulate::{CrushHistory, CrushScenario};
