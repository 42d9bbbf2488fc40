//! The crush model: contact force over time of two vehicles whose structures crush each other.
//!
//! The momentum solution of [`Impact`](crate::collision::Impact) gives the impulse of a collision
//! but not its course over time. The crush model takes the vehicles as rigid bodies in the plane
//! too, but lets their outlines overlap. The front of the striking vehicle is a row of independent
//! springs (a Winkler foundation) that are loaded by the overlap and recover only part of their
//! crush. Integration of the motion gives onset, duration, shape and impulse of the force together.
//! Linear and angular momentum are conserved by construction, because both vehicles receive
//! opposite forces at the same points. The parameters of the springs are fitted to known force
//! histories by least squares ([`CrushLaw::fit`]), without a network.
//!
//! - [`CrushLaw`]: the parameters of the model and their meaning;
//! - [`CrushLaw::simulate`]: force over time for a [`CrushScenario`];
//! - [`CrushLaw::fit`]: non-linear least squares on known force histories.
//!
//! Assumptions: the motion is planar; the side of the struck vehicle is straight; neighbouring
//! springs do not influence each other; tire forces are neglected during contact. Left out: the
//! rotation of wheels, parts that tear off, and the height of the contact. Validated by
//! cross-validation on the shipped finite-element runs (`docs/VALIDATION.md`).

mod fit;
mod knots;
mod law;
mod outline;
mod simulate;

pub use fit::{CrushFit, CrushSample};
pub use knots::CrushKnots;
pub use law::{BodyCrush, CrushLaw, StruckBodyCrush};
pub use outline::Nose;
pub use simulate::{CrushHistory, CrushScenario};
