//! What caveats are about, with their labels in every language.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::Severity;
use crate::units::{Language, Phrase};

/// What a caveat is about.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    JsonSchema,
    strum::VariantArray,
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
    /// The bare physics says something else than the network, beyond the bands of the network; or the law of
    /// the contact, for most draws.
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
    /// The end of a motion is asked for, and nobody has said what the driver does, who decides by far the
    /// most where it is.
    DriverOpen,
    /// How often the intervals hold the truth has hardly been tried.
    HardlyValidated,
    /// Every input counts as exact, so that nothing says how far the answer may be off.
    NoInterval,
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
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    JsonSchema,
    strum::VariantArray,
)]
#[serde(rename_all = "snake_case")]
pub enum CaveatSubject {
    /// The struck vehicle.
    Vehicle,
    /// A vehicle that drives and has struck nothing.
    Driven,
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
    /// How a single car moves where its motion begins.
    Start,
    /// What driver and wheels of a single car do.
    Wheels,
}

impl CaveatKind {
    /// Every kind.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

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
            Self::DriverOpen => "driver open",
            Self::HardlyValidated => "no real-world validation",
            Self::NoInterval => "no interval",
            Self::LeftOut => "left out",
            Self::TrainedOn => "trained on",
            Self::Assumed => "assumed",
            Self::NotUsed => "not used",
            Self::Note => "note",
        }
    }

    /// The same in a language.
    pub fn label_in(self, language: Language) -> &'static str {
        if language == Language::En {
            return self.label();
        }
        match self {
            Self::Outdated => "überholt",
            Self::OutsideDomain => "außerhalb des Gültigkeitsbereichs",
            Self::ImplausibleContact => "unplausibler Kontakt",
            Self::Disagreement => "Widerspruch",
            Self::OtherVehicle => "abweichendes Fahrzeug",
            Self::Overlap => "Überdeckung",
            Self::SecondContact => "zweiter Kontakt",
            Self::ContactNotEnded => "Kontakt nicht beendet",
            Self::DoubtfulData => "zweifelhafte Daten",
            Self::EnergyGain => "Energiezunahme",
            Self::WheelLift => "abgehobenes Rad",
            Self::RollLimit => "Wankgrenze",
            Self::NotAtRest => "nicht im Stillstand",
            Self::EvidenceUnexplained => "Spur nicht erklärt",
            Self::FewParticles => "wenige Partikel",
            Self::FewDraws => "wenige Ziehungen",
            Self::SeveralCourses => "mehrere Geschehensabläufe",
            Self::DriverOpen => "Fahrer offen",
            Self::HardlyValidated => "nicht an realen Fällen validiert",
            Self::NoInterval => "ohne Bereich",
            Self::LeftOut => "ausgelassen",
            Self::TrainedOn => "im Training enthalten",
            Self::Assumed => "angenommen",
            Self::NotUsed => "nicht verwendet",
            Self::Note => "Hinweis",
        }
    }

    /// A value that was assumed or is not used.
    pub fn is_assumption(self) -> bool {
        matches!(self, Self::Assumed | Self::NotUsed)
    }

    /// A warning where the numbers may be wrong, rather than rest on something that the user can
    /// supply.
    pub(super) fn severity(self) -> Severity {
        match self {
            Self::Assumed | Self::NotUsed | Self::Note | Self::NotAtRest | Self::LeftOut => {
                Severity::Info
            }
            _ => Severity::Warning,
        }
    }
}

impl CaveatSubject {
    /// Every subject.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// For a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::Vehicle => "struck vehicle",
            Self::Driven => "vehicle",
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
            Self::Start => "start of the motion",
            Self::Wheels => "driver and wheels",
        }
    }

    /// The same in a language.
    pub fn label_in(self, language: Language) -> &'static str {
        if language == Language::En {
            return self.label();
        }
        match self {
            Self::Vehicle => "gestoßenes Fahrzeug",
            Self::Driven => "Fahrzeug",
            Self::Striking => "stoßendes Fahrzeug",
            Self::VehicleParameter => "Parameter des Fahrzeugs",
            Self::StrikingParameter => "Parameter des stoßenden Fahrzeugs",
            Self::RoadFriction => "Reibbeiwert der Fahrbahn",
            Self::Speed => "Geschwindigkeit vor dem Anstoß",
            Self::ContactPoint => "Kontaktpunkt",
            Self::ContactHeight => "Höhe des Kontakts",
            Self::Pulse => "Kraft über der Zeit",
            Self::StartOfRecord => "Anfang der aufgezeichneten Bewegung",
            Self::Steer => "Lenkwinkel",
            Self::FirstTouch => "erster Kontakt",
            Self::Restitution => "Stoßziffer und Reibbeiwert",
            Self::Start => "Beginn der Bewegung",
            Self::Wheels => "Fahrer und Räder",
        }
    }

    /// The label in every language.
    pub(super) fn phrase(self) -> Phrase {
        Phrase::new(self.label_in(Language::En), self.label_in(Language::De))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_and_subject_has_a_label_in_every_language() {
        for kind in CaveatKind::ALL {
            assert_eq!(kind.label_in(Language::En), kind.label());
            assert_ne!(kind.label_in(Language::De), kind.label(), "{kind:?}");
        }
        for subject in CaveatSubject::ALL {
            assert_eq!(subject.label_in(Language::En), subject.label());
            assert_ne!(subject.label_in(Language::De), subject.label(), "{subject:?}");
        }
    }
}
