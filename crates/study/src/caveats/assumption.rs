//! What an answer rests on that nobody said, and what was said that it does not rest on.

use std::fmt;

use serde::{Deserialize, Serialize};

use impactlab_core::collision::{
    DEFAULT_CONTACT_CLOSING_M_S, DEFAULT_FRICTION_LIMIT, DEFAULT_RESTITUTION, Impact, Scenario,
    ScenarioGeometry, TOUCH_TOLERANCE_M,
};
use impactlab_core::vehicle::sheet::Estimate;
use impactlab_core::vehicle::{ContactPoint, VehicleParameters};

/// What was assumed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AssumedQuantity {
    /// The struck vehicle.
    Vehicle,
    /// The striking vehicle.
    #[serde(rename = "bullet")]
    Striking,
    /// A parameter of the struck vehicle that its data sheet does not state.
    VehicleParameter,
    /// Parameters of the striking vehicle that its data sheet does not state.
    #[serde(rename = "bullet_parameter")]
    StrikingParameter,
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
    /// Where vehicles first touched whose outlines overlap.
    FirstTouch,
    /// Restitution and friction between the vehicles.
    Restitution,
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
            Self::Striking => "striking vehicle",
            Self::VehicleParameter => "parameter of the vehicle",
            Self::StrikingParameter => "parameters of the striking vehicle",
            Self::Speed => "speed before the impact",
            Self::ContactPoint => "contact point",
            Self::ContactHeight => "height of the contact",
            Self::Pulse => "force over time",
            Self::StartOfRecord => "start of the recorded motion",
            Self::Steer => "steer angle",
            Self::FirstTouch => "first contact",
            Self::Restitution => "restitution and friction",
            Self::NotUsed => "not used",
        }
    }
}

impl Assumption {
    pub(crate) fn new(
        quantity: AssumedQuantity,
        value: impl Into<String>,
        reason: impl Into<String>,
    ) -> Self {
        Self { quantity, value: value.into(), reason: reason.into() }
    }

    /// Each parameter that was estimated because the data sheet of a vehicle does not state it.
    pub(crate) fn estimates(vehicle: &VehicleParameters) -> Vec<Self> {
        let sheet = vehicle.sheet.as_ref();
        let estimates = sheet.map_or_else(Vec::new, |sheet| sheet.estimates());
        estimates.iter().map(Self::estimate).collect()
    }

    fn estimate(estimate: &Estimate) -> Self {
        let Estimate { quantity, unit, median, ninety: [low, high], rule, source } = estimate;
        let [median, low, high] = [*median, *low, *high].map(three_digits);
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        let value = format!("{} {median}{unit}, 90 %: {low} to {high}", quantity.label());
        Self::new(AssumedQuantity::VehicleParameter, value, format!("{rule}; {source}"))
    }

    /// That the parameters of a vehicle are estimates of which only the medians are used.
    pub(crate) fn medians(quantity: AssumedQuantity, vehicle: &VehicleParameters) -> Option<Self> {
        let n = vehicle.sheet.as_ref()?.estimated().count();
        let value = format!("{n} of {}, at their medians", vehicle.name);
        let reason = "its data sheet does not state them; impactlab vehicles lists the rules";
        (n > 0).then(|| Self::new(quantity, value, reason))
    }

    /// What stands for the contact of vehicles whose outlines overlap.
    pub(crate) fn first_touch(geometry: &ScenarioGeometry) -> Option<Self> {
        let (surface, overlap_m) = geometry.surface.zip(geometry.overlap_m)?;
        let reason = format!(
            "the outlines overlap by {overlap_m:.2} m; they first touched there at their velocities, \
             and the middle of the overlap is the contact point"
        );
        let value = format!("normal {surface}");
        let is_deep = overlap_m > TOUCH_TOLERANCE_M;
        is_deep.then(|| Self::new(AssumedQuantity::FirstTouch, value, reason))
    }

    /// Restitution and friction limit of a scenario where they are the default.
    pub(crate) fn contact_default(scenario: &Scenario, impact: &Impact) -> Option<Self> {
        let contact = &scenario.contact;
        let (e, mu) = (contact.restitution, contact.friction_limit);
        let is_default = [
            ("e", e, e == DEFAULT_RESTITUTION),
            ("μ_c", mu, mu == DEFAULT_FRICTION_LIMIT && contact.friction_of_critical.is_none()),
        ];
        let of_default = is_default.into_iter().filter(|(.., is_default)| *is_default);
        let values: Vec<String> =
            of_default.map(|(name, value, _)| format!("{name} = {value}")).collect();
        if values.is_empty() {
            return None;
        }
        let [low, high] = DEFAULT_CONTACT_CLOSING_M_S;
        let [closing, _] = impact.closing_velocity_m_s();
        let here = match closing {
            closing if closing > high => {
                format!("; here {closing:.1} m/s, where restitution is usually smaller")
            }
            closing => format!("; here {closing:.1} m/s"),
        };
        let reason = format!(
            "the default, fitted to finite-element runs that close at {low} to {high} m/s{here}"
        );
        Some(Self::new(AssumedQuantity::Restitution, values.join(", "), reason))
    }

    /// The contact point that stands for an unknown one.
    pub(crate) fn contact_point(contact: ContactPoint, reason: &str) -> Self {
        let ContactPoint { x_body_m, y_body_m, height_m } = contact;
        let value = format!(
            "x {x_body_m} m, y {y_body_m} m from the CG (x forward, y left), {height_m} m high"
        );
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

/// A number with three digits.
fn three_digits(value: f64) -> String {
    let size = value.abs();
    let decimals = if size < 1e-9 { 0 } else { (2 - size.log10().floor() as i32).clamp(0, 6) };
    let rounded = format!("{value:.*}", decimals as usize);
    match decimals {
        0 => format!("{:.0}", value),
        _ => rounded.trim_end_matches('0').trim_end_matches('.').to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_are_told_with_three_digits() {
        for (value, expected) in [
            (2451.7, "2452"),
            (0.6049, "0.605"),
            (0.0110, "0.011"),
            (0.0, "0"),
            (-74.25, "-74.2"),
            (5.7, "5.7"),
            (12.34, "12.3"),
        ] {
            assert_eq!(three_digits(value), expected);
        }
    }
}
