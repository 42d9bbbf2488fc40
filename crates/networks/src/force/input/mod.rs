//! What force models learn from and are asked: scenarios in canonical form, and cases with a
//! recorded force.

mod scenario;

mod case;

#[cfg(test)]
pub(crate) use case::tests::shipped;
pub use case::{ForceCase, ForceCaseError, curve_on_grid};
#[cfg(test)]
pub(crate) use scenario::tests::example;
pub use scenario::{ContactLaw, ForceScenario};
