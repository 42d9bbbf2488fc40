//! What an answer cannot promise and what it rests on, in one form for machines and for people.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::Severity;

/// What a caveat is about.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum CaveatKind {
    /// The answer is not to what is asked any more.
    Outdated,
    /// The question lies outside what a trained network has learned from: the answer goes over to
    /// the bare physics, and its bands to the measured errors of the physics. Or a vehicle of a
    /// reconstruction is none of those that rules and priors are known of.
    OutsideDomain,
    /// No contact of two bodies brings the predicted impulse about.
    ImplausibleContact,
    /// The bare physics says something else than the network, beyond the bands of the network.
    Disagreement,
    /// The collision gives a vehicle that was chosen by name another mass or size than the vehicle has.
    OtherVehicle,
    /// The outlines of the vehicles overlap where they should touch.
    Overlap,
    /// The vehicles meet again; the motion after that is not theirs.
    SecondContact,
    /// The record of a force ends while the vehicles are still in contact: its impulse is not
    /// complete.
    ContactNotEnded,
    /// A check of a file that the answer used found that something is wrong with it.
    DoubtfulData,
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
    /// The draws are so few that their intervals are uncertain themselves.
    FewDraws,
    /// The evidence leaves several courses of events possible: what holds over all of them may be true of
    /// none.
    SeveralCourses,
    /// How often the intervals hold the truth has hardly been tried.
    HardlyValidated,
    /// Cases or draws could not be used and are left out.
    LeftOut,
    /// A network is judged by cases that it has learned from.
    TrainedOn,
    /// A value that the question leaves open and the program chose.
    Assumed,
    /// A value that the question gives and the answer does not depend on.
    NotUsed,
    /// What a person should know about how the answer was made.
    Note,
}

/// What of a question a caveat concerns, so that a person finds where to change it.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum CaveatSubject {
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
    /// Peak friction of the road, or of zones of the ground.
    RoadFriction,
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
}

/// Something for which the numbers of an answer are less reliable than they look, or on which they
/// rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Caveat {
    /// What it is about.
    pub kind: CaveatKind,
    /// How much it matters.
    pub severity: Severity,
    /// What of the question it concerns; of an assumption what was assumed.
    pub subject: Option<CaveatSubject>,
    /// A sentence for a person, without a full stop; of an assumption the value with its unit.
    pub text: String,
    /// The quantity concerned with its unit, such as `mass of the striking vehicle [kg]`.
    pub quantity: Option<String>,
    /// Value of the quantity, in that unit.
    pub value: Option<f64>,
    /// Smallest and largest value that raise no caveat; an end that is open is `None`.
    pub range: Option<[Option<f64>; 2]>,
    /// Of an assumption: why this value, and how another one is given.
    pub reason: Option<String>,
}

impl CaveatKind {
    /// A few words for a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::Outdated => "outdated",
            Self::OutsideDomain => "outside the domain",
            Self::ImplausibleContact => "implausible contact",
            Self::Disagreement => "disagreement",
            Self::OtherVehicle => "other than the vehicle",
            Self::Overlap => "overlap",
            Self::SecondContact => "second contact",
            Self::ContactNotEnded => "contact not ended",
            Self::DoubtfulData => "doubtful data",
            Self::EnergyGain => "energy gain",
            Self::WheelLift => "wheel lift",
            Self::RollLimit => "roll limit",
            Self::NotAtRest => "not at rest",
            Self::EvidenceUnexplained => "evidence unexplained",
            Self::FewParticles => "few particles",
            Self::FewDraws => "few draws",
            Self::SeveralCourses => "several courses of events",
            Self::HardlyValidated => "hardly validated",
            Self::LeftOut => "left out",
            Self::TrainedOn => "trained on",
            Self::Assumed => "assumed",
            Self::NotUsed => "not used",
            Self::Note => "note",
        }
    }

    /// A value that was assumed or is not used.
    pub fn is_assumption(self) -> bool {
        matches!(self, Self::Assumed | Self::NotUsed)
    }

    /// A warning where the numbers may be wrong, rather than rest on something that the user can
    /// supply.
    fn severity(self) -> Severity {
        match self {
            Self::Assumed | Self::NotUsed | Self::Note | Self::NotAtRest | Self::LeftOut => {
                Severity::Info
            }
            _ => Severity::Warning,
        }
    }
}

impl CaveatSubject {
    /// For a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::Vehicle => "struck vehicle",
            Self::Striking => "striking vehicle",
            Self::VehicleParameter => "parameter of the vehicle",
            Self::StrikingParameter => "parameters of the striking vehicle",
            Self::RoadFriction => "road friction",
            Self::Speed => "speed before the impact",
            Self::ContactPoint => "contact point",
            Self::ContactHeight => "height of the contact",
            Self::Pulse => "force over time",
            Self::StartOfRecord => "start of the recorded motion",
            Self::Steer => "steer angle",
            Self::FirstTouch => "first contact",
            Self::Restitution => "restitution and friction",
        }
    }
}

impl Caveat {
    /// A caveat that concerns no single quantity.
    pub fn new(kind: CaveatKind, text: impl Into<String>) -> Self {
        let (severity, text) = (kind.severity(), text.into());
        let (subject, quantity, value, range, reason) = (None, None, None, None, None);
        Self { kind, severity, subject, text, quantity, value, range, reason }
    }

    /// A value that the question leaves open.
    ///
    /// - `value`: with its SI unit;
    /// - `reason`: why this one, and how another one is given.
    pub fn assumed(
        subject: CaveatSubject,
        value: impl Into<String>,
        reason: impl Into<String>,
    ) -> Self {
        let (subject, reason) = (Some(subject), Some(reason.into()));
        Self { subject, reason, ..Self::new(CaveatKind::Assumed, value) }
    }

    /// Something that the question gives and the answer does not depend on.
    pub fn not_used(what: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { reason: Some(reason.into()), ..Self::new(CaveatKind::NotUsed, what) }
    }

    /// The same caveat about the value of a quantity. A value that is not finite is left out.
    ///
    /// - `quantity`: name and unit, such as `mass of the striking vehicle [kg]`.
    #[must_use]
    pub fn with_value(self, quantity: impl Into<String>, value: f64) -> Self {
        let value = value.is_finite().then_some(value);
        Self { quantity: Some(quantity.into()), value, ..self }
    }

    /// The same caveat with the values that would raise none.
    ///
    /// - `range`: smallest and largest of them; an end that is not finite is open.
    #[must_use]
    pub fn with_range(self, range: [f64; 2]) -> Self {
        Self { range: Some(range.map(|end| end.is_finite().then_some(end))), ..self }
    }

    /// Whether the numbers may be wrong.
    pub fn is_warning(&self) -> bool {
        self.severity > Severity::Info
    }

    /// What stands behind the label of its kind: the sentence, and for an assumption what was assumed
    /// with its value. Many sentences begin with the label, which is left out.
    pub fn statement(&self) -> String {
        let begin = format!("{}: ", self.kind.label());
        match self.subject {
            Some(subject) => format!("{}: {}", subject.label(), self.text),
            None => self.text.strip_prefix(&begin).unwrap_or(&self.text).to_owned(),
        }
    }
}

impl fmt::Display for Caveat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (label, text) = (self.kind.label(), &self.text);
        match (self.kind, self.subject, &self.reason) {
            (CaveatKind::Note, ..) => f.write_str(text),
            (_, Some(subject), Some(reason)) => {
                write!(f, "{label} {}: {text} ({reason})", subject.label())
            }
            (_, None, Some(reason)) => write!(f, "{label}: {text} ({reason})"),
            _ if self.is_warning() => write!(f, "warning: {label}: {text}"),
            _ => write!(f, "note: {label}: {text}"),
        }
    }
}
