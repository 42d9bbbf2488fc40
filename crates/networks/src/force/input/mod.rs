//! What force models learn from and are asked: scenarios in canonical form, and cases with a
//! recorded force.

mod contact_law;

mod scenario;

mod case;

#[cfg(test)]
pub(crate) use case::tests::shipped;
pub use case::{ForceCase, ForceCaseError, curve_on_grid};
pub use contact_law::ContactLaw;
pub use scenario::ForceScenario;
#[cfg(test)]
pub(crate) use scenario::tests::example;
