//! The anti-lock system of a service brake.
//!
//! ```text
//! F_brake ≤ s F_max        F_max = κ μ(α) F_z |u|/√(u² + w²)        s = 0.95
//! ```
//!
//! F_max is the largest force that the road holds against the rotation of the wheel (`tire.rs`), where
//! the wheel begins to lock. What the friction ellipse leaves beside 0.95 of it is 0.31 of the side
//! force, so that the vehicle can be steered while it brakes. Real systems let the force swing about
//! the peak some five to ten times a second; this is the mean that they reach on an even road.
//! The friction is that of the ground under each wheel, on friction zones too.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ranges::{ESC_SPEED, PEAK_SHARE, Range};
use crate::units::Phrase;
use crate::vehicle::drivers::numbers::{Number, drawn_words, named, uniform};

/// An anti-lock system: what is stated of it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct AntiLock {
    /// Largest braking force that it allows over the largest that the road holds, 0.1 to 1; 0.95 if not
    /// given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub share_of_peak: Option<f64>,
    /// Speed below which it lets the wheels lock, m/s, so that the vehicle stops; 2 m/s if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least_speed_m_s: Option<f64>,
}

/// An anti-lock system as it acts; see [`AntiLock`] for the fields.
#[derive(Debug, Clone, Copy)]
pub struct ActingAntiLock {
    pub share_of_peak: f64,
    pub least_speed_m_s: f64,
}

impl AntiLock {
    /// Number of standard normal variables that [`AntiLock::drawn`] takes.
    pub const N_DRAWN: usize = 1;

    /// The same with what is not stated drawn: the share of the peak is uniform from 0.9 to 0.98.
    pub fn drawn(&self, [share]: [f64; Self::N_DRAWN]) -> Self {
        let share_of_peak = self.share_of_peak.or(Some(uniform(share, [0.9, 0.98])));
        Self { share_of_peak, ..*self }
    }

    /// What [`AntiLock::drawn`] draws, in words.
    pub(super) fn distributions(&self) -> Vec<Phrase> {
        let share =
            ["0.9 to 0.98 of the peak friction", "das 0,9- bis 0,98-Fache der größten Reibung"];
        drawn_words([(self.share_of_peak.is_some(), share)])
    }

    /// The system with usual values where nothing is stated.
    pub fn acting(&self) -> ActingAntiLock {
        ActingAntiLock {
            share_of_peak: self.share_of_peak.unwrap_or(0.95),
            least_speed_m_s: self.least_speed_m_s.unwrap_or(2.0),
        }
    }

    /// Every number with its name without the unit, and its range.
    pub(in crate::vehicle) fn numbers(&mut self) -> [Number<'_>; 2] {
        [
            ("share_of_peak", &mut self.share_of_peak, PEAK_SHARE),
            ("least_speed", &mut self.least_speed_m_s, ESC_SPEED),
        ]
    }

    /// Every stated number with its name and its range.
    pub fn ranges(&self) -> Vec<(String, f64, Range)> {
        let mut copy = *self;
        named(copy.numbers())
    }
}

impl ActingAntiLock {
    /// Braking force that is left of what the pedal asks for, N.
    ///
    /// - `pedal_n`: force that the pedal asks for;
    /// - `other_n`: what else brakes the wheel, such as the engine, which the system cannot release;
    /// - `largest_n`: F_max;
    /// - `speed_m_s`: speed of the vehicle.
    pub(super) fn allowed_n(
        &self,
        pedal_n: f64,
        other_n: f64,
        largest_n: f64,
        speed_m_s: f64,
    ) -> f64 {
        if speed_m_s < self.least_speed_m_s {
            return pedal_n;
        }
        pedal_n.min((self.share_of_peak * largest_n - other_n).max(0.0))
    }
}
