//! What an answer cannot promise, in a form for machines and for people.

use std::fmt;

use serde::{Deserialize, Serialize};

/// What a badge is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BadgeKind {
    /// The question lies outside what a trained network has learned from: the answer goes over to
    /// the bare physics, and its bands to the measured errors of the physics. Or a vehicle of a
    /// reconstruction is none of those that rules and priors are known of.
    OutsideDomain,
    /// No contact of two bodies brings the predicted impulse about.
    ImplausibleContact,
    /// The bare physics says something else than the network, beyond the bands of the network.
    Disagreement,
    /// The outlines of the vehicles overlap where they should touch.
    Overlap,
    /// The vehicles meet again; the motion after that is not theirs.
    SecondContact,
    /// The record of a force ends while the vehicles are still in contact: its impulse is not
    /// complete.
    ContactNotEnded,
    /// A computed motion gains energy without a force.
    EnergyGain,
    /// A wheel lifts off.
    WheelLift,
    /// The vehicle rolls further than the model of its motion is valid.
    RollLimit,
    /// The motion ends before the vehicle is at rest.
    NotAtRest,
    /// Nothing in the answer explains an item of the evidence.
    EvidenceUnexplained,
    /// The particles are too few, or not of the posterior.
    FewParticles,
    /// How often the intervals hold the truth has hardly been tried.
    HardlyValidated,
    /// Cases or draws could not be used and are left out.
    LeftOut,
    /// A network is judged by cases that it has learned from.
    TrainedOn,
    /// Values were assumed that the question leaves open.
    Assumed,
    /// Values are given that the answer does not depend on.
    NotUsed,
}

/// A restriction of an answer: something for which its numbers are less reliable than they look.
///
/// Every answer with numbers carries a list of badges, which is empty if there is nothing to say.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Badge {
    /// What it is about.
    pub kind: BadgeKind,
    /// A sentence for a person, without a full stop.
    pub text: String,
    /// The quantity concerned with its unit, such as `striking mass [kg]`.
    pub quantity: Option<String>,
    /// Value of the quantity, in that unit.
    pub value: Option<f64>,
    /// Smallest and largest value that raise no badge; an end that is open is `None`.
    pub range: Option<[Option<f64>; 2]>,
}

impl BadgeKind {
    /// A few words for a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::OutsideDomain => "outside the domain",
            Self::ImplausibleContact => "implausible contact",
            Self::Disagreement => "disagreement",
            Self::Overlap => "overlap",
            Self::SecondContact => "second contact",
            Self::ContactNotEnded => "contact not ended",
            Self::EnergyGain => "energy gain",
            Self::WheelLift => "wheel lift",
            Self::RollLimit => "roll limit",
            Self::NotAtRest => "not at rest",
            Self::EvidenceUnexplained => "evidence unexplained",
            Self::FewParticles => "few particles",
            Self::HardlyValidated => "hardly validated",
            Self::LeftOut => "left out",
            Self::TrainedOn => "trained on",
            Self::Assumed => "assumed",
            Self::NotUsed => "not used",
        }
    }

    /// Whether it stands for entries of the list of assumptions of an answer.
    pub fn is_assumption(self) -> bool {
        matches!(self, Self::Assumed | Self::NotUsed)
    }

    /// Whether the numbers may be wrong, rather than rest on something that the user can supply.
    pub fn is_warning(self) -> bool {
        !(self.is_assumption() || matches!(self, Self::NotAtRest | Self::LeftOut))
    }
}

impl Badge {
    /// A badge that concerns no single quantity.
    pub fn new(kind: BadgeKind, text: impl Into<String>) -> Self {
        Self { kind, text: text.into(), quantity: None, value: None, range: None }
    }

    /// The same badge about the value of a quantity. A value that is not finite is left out.
    ///
    /// - `quantity`: name and unit, such as `striking mass [kg]`.
    #[must_use]
    pub fn with_value(self, quantity: impl Into<String>, value: f64) -> Self {
        let value = value.is_finite().then_some(value);
        Self { quantity: Some(quantity.into()), value, ..self }
    }

    /// The same badge with the values that would raise none.
    ///
    /// - `range`: smallest and largest of them; an end that is not finite is open.
    #[must_use]
    pub fn with_range(self, range: [f64; 2]) -> Self {
        Self { range: Some(range.map(|end| end.is_finite().then_some(end))), ..self }
    }
}

impl fmt::Display for Badge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = if self.kind.is_warning() { "warning" } else { "note" };
        write!(f, "{severity}: {}: {}", self.kind.label(), self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_badge_is_plain_json_with_null_for_what_it_does_not_have() {
        let plain = Badge::new(BadgeKind::SecondContact, "they meet again");
        let expected = r#"{"kind":"second_contact","text":"they meet again","quantity":null,"value":null,"range":null}"#;
        assert_eq!(serde_json::to_string(&plain).unwrap(), expected);
        let full = Badge::new(BadgeKind::NotAtRest, "still moving")
            .with_value("speed at the end [m/s]", 3.0)
            .with_range([f64::NEG_INFINITY, 0.05]);
        let text = serde_json::to_string(&full).unwrap();
        assert!(text.ends_with(r#""value":3.0,"range":[null,0.05]}"#), "{text}");
        assert_eq!(serde_json::from_str::<Badge>(&text).unwrap(), full);
        assert_eq!(plain.with_value("depth [m]", f64::NAN).value, None);
    }
}
