//! What an answer rests on that nobody said.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::vehicle::ContactPoint;

/// What was assumed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AssumedQuantity {
    /// The struck vehicle.
    Vehicle,
    /// The striking vehicle.
    Bullet,
    /// Speed of the struck vehicle before the impact.
    Speed,
    /// Where the force acts on the struck vehicle.
    ContactPoint,
    /// How high above the ground the force acts.
    ContactHeight,
    /// Shape and duration of a pulse that carries a known impulse.
    Pulse,
}

/// A value that the question left open and the program chose.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Assumption {
    /// What was assumed.
    pub quantity: AssumedQuantity,
    /// The value, with its SI unit.
    pub value: String,
    /// Why this value, and how another one is given.
    pub reason: String,
}

impl AssumedQuantity {
    /// For a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::Vehicle => "struck vehicle",
            Self::Bullet => "striking vehicle",
            Self::Speed => "speed before the impact",
            Self::ContactPoint => "contact point",
            Self::ContactHeight => "height of the contact",
            Self::Pulse => "force over time",
        }
    }
}

impl Assumption {
    pub(super) fn new(
        quantity: AssumedQuantity,
        value: impl Into<String>,
        reason: impl Into<String>,
    ) -> Self {
        Self { quantity, value: value.into(), reason: reason.into() }
    }

    /// The contact point that stands for an unknown one.
    pub(super) fn contact_point(contact: ContactPoint, reason: &str) -> Self {
        let ContactPoint { x_m, y_m, height_m } = contact;
        let value =
            format!("x {x_m} m, y {y_m} m from the CG (x forward, y left), {height_m} m high");
        Self::new(AssumedQuantity::ContactPoint, value, reason)
    }
}

impl fmt::Display for Assumption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} ({})", self.quantity.label(), self.value, self.reason)
    }
}
