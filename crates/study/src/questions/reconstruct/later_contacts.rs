//! Whether a reconstruction follows both cars through later contacts.

use schemars::JsonSchema;
use serde::Serialize;

use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue};
use impactlab_reconstruct::ForwardModel;
use impactlab_reconstruct::evidence::Evidence;

/// Share of the particles whose cars meet again from which on a person hears of it: as much as the intervals
/// of 90 % leave out at one end.
const TOLD_FROM: f64 = 0.05;

/// What a reconstruction makes of later contacts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct LaterContactsReport {
    /// Share of the particles of a reconstruction from the first contact alone whose cars meet again. A
    /// striking car of which nothing is known then coasts.
    pub meet_again_share: f64,
    /// Standard error of that share.
    pub meet_again_standard_error: f64,
    /// Whether both cars were then followed through all contacts.
    pub are_followed: bool,
    #[serde(skip)]
    why_not: Option<WhyNot>,
}

/// Why later contacts are left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum WhyNot {
    /// It is asked.
    Asked,
    /// Nothing of the way of the striking car is among the evidence, so that nothing says whether the cars
    /// met again.
    NoEvidence,
    /// Nobody says what the driver of the striking car did, and it is no push of a flank behind the CG: cars
    /// that were found close to each other would be taken to have pushed each other, although two that
    /// braked alike were found so, too.
    DriverUnknown,
    /// The run was stopped before.
    Stopped,
}

impl WhyNot {
    /// Why later contacts are left out; `None` where they are not.
    ///
    /// - `one_contact`: whether it is asked;
    /// - `is_stopped`: whether the run was.
    pub(super) fn of(
        one_contact: bool,
        evidence: &Evidence,
        model: &ForwardModel,
        is_stopped: bool,
    ) -> Option<Self> {
        let is_driver_open = !model.prior().is_pit() && !evidence.tells_striking_driver();
        [
            (one_contact, Self::Asked),
            (!evidence.follows_striking_car(), Self::NoEvidence),
            (is_stopped, Self::Stopped),
            (is_driver_open, Self::DriverUnknown),
        ]
        .into_iter()
        .find_map(|(holds, why_not)| holds.then_some(why_not))
    }
}

impl LaterContactsReport {
    /// What is done where some of the particles of the first contact alone meet again.
    ///
    /// - `share`: their share, and its standard error.
    pub(super) fn new(share: [f64; 2], why_not: Option<WhyNot>) -> Self {
        let [meet_again_share, meet_again_standard_error] = share;
        let are_followed = why_not.is_none() && meet_again_share >= TOLD_FROM;
        Self { meet_again_share, meet_again_standard_error, are_followed, why_not }
    }

    /// Whether a person hears of it.
    pub fn is_told(&self) -> bool {
        self.meet_again_share >= TOLD_FROM
    }

    /// What a person should know of it; `None` where the cars part for good.
    pub(super) fn caveat(&self) -> Option<Caveat> {
        if !self.is_told() {
            return None;
        }
        let error = Some(self.meet_again_standard_error);
        let share = PhraseValue::Chance { share: self.meet_again_share, error };
        Some(match self.why_not {
            None => {
                let text = Phrase::new(
                    "after the first contact alone the cars meet again in {0} of the motions: both were \
                     followed through all contacts, the first one by momentum, later ones by the crush of \
                     their outlines; how often such intervals hold the truth was not tried",
                    "Nach dem ersten Kontakt allein treffen sich die Fahrzeuge in {0} der Bewegungen \
                     wieder. Beide wurden durch alle Kontakte verfolgt, der erste nach dem Impulssatz, \
                     spätere nach der Eindrückung ihrer Umrisse. Wie oft solche Intervalle zutreffen, ist \
                     nicht geprüft",
                )
                .with(share);
                Caveat::new(CaveatKind::Note, text)
            }
            Some(WhyNot::NoEvidence) => {
                let text = Phrase::new(
                    "after the first contact alone the cars meet again in {0} of the motions if the \
                     striking car coasts; later contacts are not followed, since nothing of its way is \
                     among the evidence ([striking_rest], [[striking_mark]], [striking_edr])",
                    "Nach dem ersten Kontakt allein treffen sich die Fahrzeuge in {0} der Bewegungen \
                     wieder, wenn das stoßende Fahrzeug ungebremst ausrollt. Spätere Kontakte sind nicht verfolgt, da \
                     Anknüpfungstatsachen zu seinem Weg fehlen (Endlage, Reifenspuren oder Unfalldatenspeicher)",
                )
                .with(share);
                Caveat::new(CaveatKind::Note, text)
            }
            Some(why @ (WhyNot::Asked | WhyNot::DriverUnknown | WhyNot::Stopped)) => {
                let instead = match why {
                    WhyNot::Stopped => {
                        Phrase::new("let the run end", "Die Rechnung ist bis zum Ende zu führen")
                    }
                    WhyNot::DriverUnknown => Phrase::new(
                        "to have them followed, say what its driver did: [striking_after] driver_braked",
                        "Sie werden verfolgt, sobald feststeht, was der Fahrer des stoßenden Fahrzeugs tat",
                    ),
                    _ => Phrase::new(
                        "leave out --one-contact",
                        "Gefragt ist allein nach dem ersten Kontakt",
                    ),
                };
                let text = Phrase::new(
                    "after the first contact alone the cars meet again in {0} of the motions, which is \
                     left out here: the speeds are those of motions that end otherwise; {1}",
                    "Nach dem ersten Kontakt allein treffen sich die Fahrzeuge in {0} der Bewegungen \
                     wieder, was hier außer Betracht bleibt: Die Geschwindigkeiten gehören zu Bewegungen, \
                     die anders enden. {1}",
                )
                .with(share)
                .with(PhraseValue::phrase(instead));
                let told = "share of the motions in which the cars meet again";
                Caveat::new(CaveatKind::SecondContact, text)
                    .with_value(told, self.meet_again_share)
                    .with_range([0.0, TOLD_FROM])
            }
        })
    }
}

/// What a person should know where nobody can tell whether the cars meet again.
pub(super) fn not_looked_for() -> Option<Caveat> {
    let text = Phrase::new(
        "whether the cars meet again after the impact was not looked for: the outer dimensions of one of \
         them make no outline",
        "Ob sich die Fahrzeuge nach dem Anstoß wieder treffen, wurde nicht geprüft: Die Außenmaße eines \
         von ihnen ergeben keinen Umriss",
    );
    Some(Caveat::new(CaveatKind::SecondContact, text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::{Language, NumberFormat, UnitSystem};

    /// “Ohne --one-contact werden sie verfolgt” and “[striking_rest]” stood in German reports.
    #[test]
    fn no_german_text_names_an_option_or_a_key() {
        let german = NumberFormat { units: UnitSystem::Si, language: Language::De };
        let all = [WhyNot::Asked, WhyNot::NoEvidence, WhyNot::DriverUnknown, WhyNot::Stopped];
        for why_not in all.map(Some).into_iter().chain([None]) {
            let caveat = LaterContactsReport::new([0.3, 0.02], why_not).caveat().unwrap();
            let text = caveat.text_in(&german, &str::to_owned).unwrap();
            assert!(!text.contains('[') && !text.contains("--"), "{text}");
        }
    }

    #[test]
    fn later_contacts_are_followed_where_the_evidence_tells_and_a_person_hears_of_them() {
        let kind = |share, why_not| {
            let report = LaterContactsReport::new([share, 0.02], why_not);
            (report.are_followed, report.caveat().map(|caveat| caveat.kind))
        };
        assert_eq!(kind(0.01, None), (false, None));
        assert_eq!(kind(0.3, None), (true, Some(CaveatKind::Note)));
        assert_eq!(kind(0.3, Some(WhyNot::NoEvidence)), (false, Some(CaveatKind::Note)));
        for why_not in [WhyNot::Asked, WhyNot::DriverUnknown, WhyNot::Stopped] {
            assert_eq!(kind(0.3, Some(why_not)), (false, Some(CaveatKind::SecondContact)));
        }
    }
    /// “80 %” stood there, as if no number of particles had been counted.
    #[test]
    fn the_share_of_the_cars_that_meet_again_has_its_standard_error() {
        for why_not in [None, Some(WhyNot::NoEvidence), Some(WhyNot::Asked)] {
            let caveat = LaterContactsReport::new([0.8, 0.0125], why_not).caveat().unwrap();
            assert!(caveat.text.contains("80.0 % ± 1.3 %"), "{caveat}");
        }
    }
}
