//! Why two vehicles have no motion.

use crate::vehicle::SimulationError;

/// Reason why two vehicles have no motion.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PairError {
    /// One of the motions cannot be computed.
    #[error("{role} vehicle")]
    Vehicle {
        /// `struck` or `striking`.
        role: &'static str,
        /// Why.
        #[source]
        source: SimulationError,
    },
    /// The striking vehicle has a collision force of its own.
    #[error(
        "the striking vehicle has a collision force of its own, which is that on the struck one"
    )]
    CollisionForce,
    /// The manoeuvres do not last equally long.
    #[error(
        "the manoeuvres of both vehicles last {struck_s} s and {striking_s} s, expected one duration"
    )]
    Durations {
        /// Of the struck vehicle, s.
        struck_s: f64,
        /// Of the striking vehicle, s.
        striking_s: f64,
    },
    /// A number of the contact is out of range.
    #[error("{name} is {value}, expected {expected}")]
    Range {
        /// Name of the number.
        name: &'static str,
        /// Its value, SI units.
        value: f64,
        /// The permitted range.
        expected: &'static str,
    },
}
