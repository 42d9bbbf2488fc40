//! What an answer rests on that nobody said, and what was said that it does not rest on.

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
    /// Yaw rate, roll angle or roll rate at the start of a recorded motion.
    StartOfRecord,
    /// Road-wheel angle before or after its recording.
    Steer,
    /// Not a value that was assumed, but one that was given and is not used.
    NotUsed,
}

/// A value that the question left open and the program chose, or one that the question gives and the
/// answer does not depend on ([`AssumedQuantity::NotUsed`]).
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
            Self::StartOfRecord => "start of the recorded motion",
            Self::Steer => "steer angle",
            Self::NotUsed => "not used",
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
        let Self { quantity, value, reason } = self;
        match quantity {
            AssumedQuantity::NotUsed => write!(f, "not used: {value} ({reason})"),
            quantity => write!(f, "assumed {}: {value} ({reason})", quantity.label()),
        }
    }
}
