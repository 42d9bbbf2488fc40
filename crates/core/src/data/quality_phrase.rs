//! What the checks of a file or a case say of it.

use std::fmt;

use crate::data::{Flag, FlagKind};
use crate::units::{NumberFormat, Phrase, PhraseValue, Quantity};

impl Flag {
    /// What was found.
    pub fn phrase(&self) -> Phrase {
        let found = self.finding();
        let Some(time_s) = self.time_s else { return found };
        Phrase::new("{0} (at {1})", "{0} (bei {1})")
            .with(PhraseValue::phrase(found))
            .with(PhraseValue::fixed(Quantity::Time, time_s, 4))
    }

    fn finding(&self) -> Phrase {
        let percent =
            |decimals| PhraseValue::fixed(Quantity::Ratio, self.value, decimals).in_unit("%");
        let limit = PhraseValue::given(Quantity::Ratio, self.limit);
        let limit_percent = limit.clone().in_unit("%");
        match self.kind {
            FlagKind::MomentumResidual => Phrase::new(
                "impulse and momentum differ by {0}, limit {1}; check mass, force unit and axes",
                "Kraftstoß und Impulsänderung weichen um {0} voneinander ab, Grenze {1}; Masse, \
                 Krafteinheit und Achsen prüfen",
            )
            .with(percent(2))
            .with(limit_percent),
            FlagKind::SamplingGap => Phrase::new(
                "a step {0} times the median step, limit {1}; samples are missing",
                "Ein Zeitschritt beträgt das {0}-Fache des mittleren, Grenze {1}; es fehlen Messwerte",
            )
            .with(PhraseValue::fixed(Quantity::Ratio, self.value, 1))
            .with(limit),
            FlagKind::NonUniformSampling => Phrase::new(
                "steps differ by {0}, limit {1}",
                "Die Zeitschritte weichen um {0} voneinander ab, Grenze {1}",
            )
            .with(percent(1))
            .with(limit_percent),
            FlagKind::Spike => Phrase::new(
                "one sample stands out by {0} of the peak, limit {1}",
                "Ein einzelner Messwert ragt um {0} des Höchstwerts heraus, Grenze {1}",
            )
            .with(percent(0))
            .with(limit_percent),
            FlagKind::Drift => Phrase::new(
                "force before contact is {0} of the peak, limit {1}; remove the offset",
                "Die Kraft vor dem Kontakt beträgt {0} des Höchstwerts, Grenze {1}; den Nullpunkt \
                 berichtigen",
            )
            .with(percent(1))
            .with(limit_percent),
            FlagKind::ImplausibleForce
            | FlagKind::SmallForce
            | FlagKind::ImplausibleImpulse
            | FlagKind::LongContact
            | FlagKind::NoForce
            | FlagKind::NotSeparated
            | FlagKind::BegunBefore
            | FlagKind::Saturated
            | FlagKind::Hooked => self.finding_of_force(),
            FlagKind::PathJump | FlagKind::SlowPath | FlagKind::FastPath | FlagKind::YawStep => {
                self.finding_of_path()
            }
            FlagKind::SpeedJump
            | FlagKind::YawJump
            | FlagKind::YawRateJump
            | FlagKind::SteerJump => self.finding_of_jump(),
        }
    }

    fn finding_of_path(&self) -> Phrase {
        match self.kind {
            FlagKind::PathJump => Phrase::new(
                "the position jumps by {0} from one row to the next; remove rows without a position, or check \
                 the units of positions and time",
                "Die Position springt von einer Zeile zur nächsten um {0}; Zeilen ohne Position entfernen oder \
                 die Einheiten von Positionen und Zeit prüfen",
            )
            .with(PhraseValue::significant(Quantity::Length, self.value)),
            FlagKind::YawStep => Phrase::new(
                "the yaw angle turns by {0} from one row to the next, which may as well be a turn to the other \
                 side: record it more often, or a yaw rate beside it",
                "Der Gierwinkel ändert sich von einer Zeile zur nächsten um {0}; ebenso gut kann das Fahrzeug \
                 andersherum gedreht haben: öfter aufzeichnen oder die Gierrate dazu",
            )
            .with(PhraseValue::fixed(Quantity::Angle, self.value, 0)),
            FlagKind::FastPath => Phrase::new(
                "the path goes on at {0} on average; check the units of time and positions",
                "Der Weg wird im Mittel mit {0} zurückgelegt; die Einheiten von Zeit und Positionen prüfen",
            )
            .with(PhraseValue::significant(Quantity::Speed, self.value)),
            _ => Phrase::new(
                "nowhere along the path is the vehicle faster than {0}; check the units of time and positions",
                "Nirgends auf dem Weg ist das Fahrzeug schneller als {0}; die Einheiten von Zeit und Positionen \
                 prüfen",
            )
            .with(PhraseValue::significant(Quantity::Speed, self.value)),
        }
    }

    fn finding_of_jump(&self) -> Phrase {
        let angle = PhraseValue::fixed(Quantity::Angle, self.value, 0);
        let ([en, de], value) = match self.kind {
            FlagKind::SpeedJump => (
                ["the speed", "Die Geschwindigkeit"],
                PhraseValue::significant(Quantity::Speed, self.value),
            ),
            FlagKind::YawRateJump => (
                ["the yaw rate", "Die Gierrate"],
                PhraseValue::fixed(Quantity::AngularVelocity, self.value, 0),
            ),
            FlagKind::YawJump => (["the yaw angle", "Der Gierwinkel"], angle),
            _ => (["the steer angle", "Der Lenkwinkel"], angle),
        };
        Phrase::new(
            format!(
                "{en} jumps by {{0}} from one row to the next, which neither a vehicle nor its driver does; remove rows \
                 without a value"
            ),
            format!(
                "{de} springt von einer Zeile zur nächsten um {{0}}, was weder Fahrzeug noch Fahrer tun; Zeilen ohne \
                 Wert entfernen"
            ),
        )
        .with(value)
    }

    fn finding_of_force(&self) -> Phrase {
        let value = |quantity| PhraseValue::significant(quantity, self.value);
        let limit = |quantity| PhraseValue::given(quantity, self.limit);
        let fixed = |quantity, decimals| PhraseValue::fixed(quantity, self.value, decimals);
        match self.kind {
            FlagKind::ImplausibleForce => Phrase::new(
                "peak force {0}, limit {1}; check the unit",
                "Die größte Kraft beträgt {0}, Grenze {1}; die Einheit prüfen",
            )
            .with(fixed(Quantity::Force, 2).in_unit("MN"))
            .with(limit(Quantity::Force).in_unit("MN")),
            FlagKind::SmallForce => Phrase::new(
                "peak force {0}, less than cars have that touch at walking speed ({1}); \
                 is the column in kN?",
                "Die größte Kraft beträgt {0}, weniger als bei einer Berührung in \
                 Schrittgeschwindigkeit ({1}); steht die Spalte in kN?",
            )
            .with(value(Quantity::Force))
            .with(limit(Quantity::Force)),
            FlagKind::ImplausibleImpulse => implausible_impulse(self.value < self.limit)
                .with(value(Quantity::Impulse))
                .with(limit(Quantity::Impulse)),
            FlagKind::LongContact => Phrase::new(
                "contact takes {0}, limit {1}; check the unit of time",
                "Der Kontakt dauert {0}, Grenze {1}; die Zeiteinheit prüfen",
            )
            .with(fixed(Quantity::Time, 1))
            .with(limit(Quantity::Time)),
            FlagKind::NoForce => {
                Phrase::new("the force is zero throughout", "Die Kraft ist durchweg null")
            }
            FlagKind::NotSeparated => Phrase::new(
                "still in contact at the end: the impulse is not complete",
                "Am Ende besteht noch Kontakt: Der Stoßantrieb ist unvollständig",
            ),
            FlagKind::BegunBefore => Phrase::new(
                "the force is {0} of the peak at the first row: what came before it is missing in the impulse",
                "In der ersten Zeile beträgt die Kraft {0} des Höchstwerts: Was vorher war, fehlt im Stoßantrieb",
            )
            .with(PhraseValue::fixed(Quantity::Ratio, self.value, 0).in_unit("%")),
            FlagKind::Saturated => Phrase::new(
                "the force stays at its largest value, {0}, over several rows between steep flanks: its transducer \
                 was at its limit, and the impulse is too small",
                "Die Kraft verharrt zwischen steilen Flanken mehrere Zeilen lang bei ihrem Höchstwert {0}: Der \
                 Aufnehmer war an seiner Messgrenze, und der Stoßantrieb ist zu klein",
            )
            .with(value(Quantity::Force)),
            _ => Phrase::new(
                "the striking vehicle's corner stays caught",
                "Die Ecke des stoßenden Fahrzeugs bleibt verhakt",
            ),
        }
    }
}

fn implausible_impulse(is_small: bool) -> Phrase {
    match is_small {
        true => Phrase::new(
            "impulse {0}, below the {1} of any collision of cars; check the units of force and time",
            "Der Kraftstoß beträgt {0}, unter den {1} jeder Kollision von Pkw; die Einheiten von Kraft \
             und Zeit prüfen",
        ),
        false => Phrase::new(
            "impulse {0}, above the {1} of any collision of cars; check the units of force and time",
            "Der Kraftstoß beträgt {0}, über den {1} jeder Kollision von Pkw; die Einheiten von Kraft \
             und Zeit prüfen",
        ),
    }
}

impl fmt::Display for Flag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.phrase().say(&NumberFormat::default()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Severity;
    use crate::units::{Language, UnitSystem};

    #[test]
    fn a_finding_is_told_in_the_language_and_the_units_of_the_reader() {
        let flag = |kind, value, limit, time_s| Flag {
            kind,
            severity: Severity::Warning,
            value,
            limit,
            time_s,
        };
        let us = NumberFormat::english(UnitSystem::Us);
        let german = NumberFormat { units: UnitSystem::Si, language: Language::De };
        let small = flag(FlagKind::SmallForce, 123.4, 1e3, None);
        let expected = "peak force 123.4 N, less than cars have that touch at walking speed (1000 N); \
                        is the column in kN?";
        assert_eq!(small.to_string(), expected);
        assert!(small.phrase().say(&us).starts_with("peak force 27.74 lbf"), "{small}");
        let force = flag(FlagKind::ImplausibleForce, 2.5e6, 2e6, Some(0.05));
        let expected = "peak force 2.50 MN, limit 2 MN; check the unit (at 0.0500 s)";
        assert_eq!(force.to_string(), expected);
        let expected =
            "Die größte Kraft beträgt 2500 kN, Grenze 2000 kN; die Einheit prüfen (bei 0,0500 s)";
        assert_eq!(force.phrase().say(&german), expected);
        let drift = flag(FlagKind::Drift, 0.123, 0.05, None);
        let expected = "force before contact is 12.3 % of the peak, limit 5 %; remove the offset";
        assert_eq!(drift.to_string(), expected);
        let impulse = flag(FlagKind::ImplausibleImpulse, 12.0, 100.0, None);
        let expected = "impulse 12.00 N s, below the 100 N s of any collision of cars; check the units \
                        of force and time";
        assert_eq!(impulse.to_string(), expected);
    }
}
