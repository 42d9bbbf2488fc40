//! What is flagged in a simulated motion: wheel lift, roll beyond the limit, energy that grows, a second
//! contact.

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::{FEWEST_DRAWS, SecondContacts};
use crate::word;
use impactlab_core::collision::{Role, SecondContact};
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatText};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_core::vehicle::{MotionFlag, ROLL_LIMIT_RAD};

/// A [`MotionFlag`] or a [`SecondContact`]: the caveat that it is, and its numbers.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(into = "FlagJson")]
pub struct FlagReport {
    /// What it says of the motion.
    pub caveat: Caveat,
    /// When it is first raised, s.
    pub time_s: f64,
    /// Whose motion it is of, `struck` or `striking`; `None` of both vehicles, and where there is only one.
    pub vehicle: Option<String>,
    /// The wheel that lifts.
    pub wheel: Option<String>,
    /// Where the vehicles meet again.
    pub contact: Option<FlaggedContact>,
}

/// Where and how the vehicles meet again.
#[derive(Debug, Clone, Copy, PartialEq, JsonSchema)]
pub struct FlaggedContact {
    /// Place [x, y], m.
    pub position_m: [f64; 2],
    /// How fast their overlap grows there, m/s.
    pub closing_speed_m_s: f64,
    /// Share of the draws in which they do; time, place and speed are then medians. None of a single
    /// path.
    pub probability: Option<f64>,
    /// When the first of the draws do, s: 5 % of those that do are earlier.
    pub from_s: f64,
}

/// A flag as JSON says it.
#[derive(Serialize, JsonSchema)]
struct FlagJson {
    /// `wheel_lift`, `roll_limit`, `energy_gain` or `second_contact`.
    kind: CaveatKind,
    /// When it is first raised, s.
    time_s: f64,
    /// Whose motion it is of, `struck` or `striking`; null of both vehicles, and where there is only one.
    vehicle: Option<String>,
    /// The wheel that lifts.
    wheel: Option<String>,
    /// Roll angle at that time, rad.
    roll_rad: Option<f64>,
    /// Where the vehicles meet again, [x, y], m.
    position_m: Option<[f64; 2]>,
    /// How fast their overlap grows there, m/s.
    closing_speed_m_s: Option<f64>,
    /// Share of the draws in which they do.
    probability: Option<f64>,
    /// What it says of the motion.
    message: String,
}

impl From<FlagReport> for FlagJson {
    fn from(FlagReport { caveat, time_s, vehicle, wheel, contact }: FlagReport) -> Self {
        let Caveat { kind, value, text, .. } = caveat;
        Self {
            kind,
            time_s,
            vehicle,
            wheel,
            roll_rad: value.filter(|_| kind == CaveatKind::RollLimit),
            position_m: contact.map(|contact| contact.position_m),
            closing_speed_m_s: contact.map(|contact| contact.closing_speed_m_s),
            probability: contact.and_then(|contact| contact.probability),
            message: text,
        }
    }
}

impl FlagReport {
    /// A flag about which no more is known than when it is raised.
    fn new(kind: CaveatKind, time_s: f64, message: impl Into<CaveatText>) -> Self {
        let caveat = Caveat::new(kind, message).with_value("time [s]", time_s);
        Self { caveat, time_s, vehicle: None, wheel: None, contact: None }
    }

    /// What is flagged in the motion of one of two vehicles.
    pub(crate) fn of_vehicle(role: Role, flag: &MotionFlag) -> Self {
        let [struck, striking] = Role::WORDS;
        let (vehicle, text) = match role {
            Role::Struck => {
                (struck, Phrase::new("struck vehicle: {0}", "Gestoßenes Fahrzeug: {0}"))
            }
            Role::Striking => {
                (striking, Phrase::new("striking vehicle: {0}", "Stoßendes Fahrzeug: {0}"))
            }
        };
        let text = text.with(PhraseValue::phrase(flag.phrase()));
        Self { vehicle: Some(vehicle.to_owned()), ..Self::of_motion(flag, text) }
    }

    fn of_motion(flag: &MotionFlag, text: Phrase) -> Self {
        match flag {
            MotionFlag::WheelLift { wheel, time_s } => {
                let flag = Self::new(CaveatKind::WheelLift, *time_s, text);
                Self { wheel: Some(word(wheel)), ..flag }
            }
            MotionFlag::RollLimit { time_s, roll_rad } => {
                let flag = Self::new(CaveatKind::RollLimit, *time_s, text);
                let caveat = flag
                    .caveat
                    .with_value("roll angle [rad]", *roll_rad)
                    .with_range([-ROLL_LIMIT_RAD, ROLL_LIMIT_RAD]);
                Self { caveat, ..flag }
            }
            MotionFlag::EnergyGain { time_s } => Self::new(CaveatKind::EnergyGain, *time_s, text),
        }
    }

    /// Until when positions have a probability, s: to a second contact that is more than a rare one.
    pub(crate) fn known_until_s(&self) -> f64 {
        let contact = self.contact.filter(|contact| is_no_rare_contact(contact.probability));
        contact.map_or(f64::INFINITY, |contact| contact.from_s)
    }
}

/// Whether a second contact is no rare one.
///
/// - `share`: share of the draws in which the vehicles meet again; `None` where nothing is drawn.
pub(crate) fn is_no_rare_contact(share: Option<f64>) -> bool {
    share.is_none_or(|share| share > MOST_SECOND_CONTACTS)
}

/// What a person should know of a second contact.
fn not_computed() -> PhraseValue {
    PhraseValue::phrase(Phrase::new(
        "a second contact, which is not computed; the motions after it are not those of the vehicles, \
         and no position after it has a probability",
        "Dieser zweite Kontakt ist nicht gerechnet. Die Bewegungen danach sind nicht die der Fahrzeuge, \
         und keine Lage danach hat eine Wahrscheinlichkeit",
    ))
}

/// What the vehicles do in a second contact.
fn meeting(was_apart: bool) -> PhraseValue {
    PhraseValue::phrase(match was_apart {
        true => Phrase::new("meet again", "treffen sich wieder"),
        false => Phrase::new("go deeper into each other", "dringen tiefer ineinander"),
    })
}

/// Share of the draws with a second contact from which on positions after it have no probability: half of
/// what an interval of 90 % leaves out.
const MOST_SECOND_CONTACTS: f64 = 0.05;

impl From<&SecondContact> for FlagReport {
    fn from(second: &SecondContact) -> Self {
        let ([x, y], speed) = (second.point_m, second.closing_speed_m_s);
        let how = meeting(second.was_apart);
        let message = second_contact_text(how, second.time_s, [x, y], speed);
        let contact = FlaggedContact {
            position_m: second.point_m,
            closing_speed_m_s: speed,
            probability: None,
            from_s: second.time_s,
        };
        let flag = Self::new(CaveatKind::SecondContact, second.time_s, message);
        Self { contact: Some(contact), ..flag }
    }
}

/// A second contact of a single motion, for a person.
fn second_contact_text(how: PhraseValue, time_s: f64, [x, y]: [f64; 2], speed_m_s: f64) -> Phrase {
    Phrase::new(
        "the vehicles {0} at {1}, near x {2}, y {3}, closing at {4}: {5}",
        "Die Fahrzeuge {0} bei {1}, nahe x {2}, y {3}, mit {4} Annäherungsgeschwindigkeit. {5}",
    )
    .with(how)
    .with(PhraseValue::fixed(Quantity::Time, time_s, 2))
    .with(PhraseValue::fixed(Quantity::Length, x, 1))
    .with(PhraseValue::fixed(Quantity::Length, y, 1))
    .with(PhraseValue::fixed(Quantity::Speed, speed_m_s, 1))
    .with(not_computed())
}

/// The second contacts of draws, for a person; of few of them without intervals, which would be too narrow.
fn second_contacts_text(met: &SecondContacts) -> Phrase {
    let time = |s: f64| PhraseValue::fixed(Quantity::Time, s, 2);
    let speed = |m_s: f64| PhraseValue::fixed(Quantity::Speed, m_s, 1);
    let length = |m: f64| PhraseValue::fixed(Quantity::Length, m, 1);
    let begun = |text: Phrase| {
        text.with(meeting(2.0 * met.apart_share > 1.0))
            .with(PhraseValue::Share(met.probability))
            .with(PhraseValue::Name(met.n_draws.to_string()))
            .with(time(met.time_s.median))
    };
    let n_met = (met.probability * met.n_draws as f64).round() as usize;
    if n_met < FEWEST_DRAWS {
        let text = Phrase::new(
            "the vehicles {0} in {1} of {2} draws, in the median of these few at {3}, near x {4}, y {5}, \
             closing at {6}: {7}",
            "Die Fahrzeuge {0} in {1} von {2} Ziehungen, im Median dieser wenigen bei {3}, nahe x {4}, y {5}, \
             mit {6} Annäherungsgeschwindigkeit. {7}",
        );
        return begun(text)
            .with(length(met.x_m.median))
            .with(length(met.y_m.median))
            .with(speed(met.closing_speed_m_s.median))
            .with(not_computed());
    }
    let ([from_s, to_s], [slow, fast]) = (met.time_s.ninety(), met.closing_speed_m_s.ninety());
    let text = Phrase::new(
        "the vehicles {0} in {1} of {2} draws, at {3} (90 %: {4} to {5}), near x {6}, y {7}, \
         closing at {8} (90 %: {9} to {10}): {11}",
        "Die Fahrzeuge {0} in {1} von {2} Ziehungen, bei {3} (90 %: {4} bis {5}), nahe x {6}, y {7}, \
         mit {8} Annäherungsgeschwindigkeit (90 %: {9} bis {10}). {11}",
    );
    begun(text)
        .with(time(from_s).bare())
        .with(time(to_s).bare())
        .with(length(met.x_m.median))
        .with(length(met.y_m.median))
        .with(speed(met.closing_speed_m_s.median))
        .with(speed(slow).bare())
        .with(speed(fast).bare())
        .with(not_computed())
}

impl From<&SecondContacts> for FlagReport {
    fn from(met: &SecondContacts) -> Self {
        let (x, y, speed) = (met.x_m.median, met.y_m.median, met.closing_speed_m_s.median);
        let (time_s, [from_s, _]) = (met.time_s.median, met.time_s.ninety());
        let message = match met.n_draws {
            // One known force on one known vehicle: nothing is drawn.
            1 => second_contact_text(meeting(2.0 * met.apart_share > 1.0), time_s, [x, y], speed),
            _ => second_contacts_text(met),
        };
        let contact = FlaggedContact {
            position_m: [x, y],
            closing_speed_m_s: speed,
            // One path either meets the other vehicle or does not.
            probability: (met.n_draws > 1).then_some(met.probability),
            from_s,
        };
        let flag = Self::new(CaveatKind::SecondContact, time_s, message);
        Self { contact: Some(contact), ..flag }
    }
}

impl From<&MotionFlag> for FlagReport {
    fn from(flag: &MotionFlag) -> Self {
        Self::of_motion(flag, flag.phrase())
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use impactlab_core::units::{Estimate, Language, NumberFormat, UnitSystem};
    use impactlab_core::vehicle::Wheel;

    /// “warning: wheel lift: wheel lift: rear left carries no load” was told.
    #[test]
    fn a_flag_does_not_say_its_kind_twice() {
        for flag in [
            MotionFlag::WheelLift { wheel: Wheel::RearLeft, time_s: 0.04 },
            MotionFlag::RollLimit { time_s: 0.4, roll_rad: 0.6 },
            MotionFlag::EnergyGain { time_s: 0.4 },
        ] {
            let FlagReport { caveat, .. } = FlagReport::from(&flag);
            let first = caveat.kind.label().split(' ').next().unwrap();
            let is_prefix = caveat.text.split_once(": ").is_some_and(|(of, _)| of.contains(first));
            assert!(!is_prefix, "{caveat}");
        }
    }

    #[test]
    fn positions_have_a_probability_until_the_vehicles_meet_again_in_more_than_a_few_draws() {
        let flag = |probability, from_s| FlagReport {
            contact: Some(FlaggedContact {
                position_m: [1.0, 2.0],
                closing_speed_m_s: 0.5,
                probability,
                from_s,
            }),
            ..FlagReport::new(CaveatKind::SecondContact, 0.4, String::new())
        };
        assert_eq!(flag(Some(0.9), 0.3).known_until_s(), 0.3);
        assert_eq!(flag(None, 0.3).known_until_s(), 0.3);
        assert_eq!(flag(Some(0.05), 0.3).known_until_s(), f64::INFINITY);
        let lift = FlagReport::new(CaveatKind::WheelLift, 0.4, String::new());
        assert_eq!(lift.known_until_s(), f64::INFINITY);
    }

    #[test]
    fn a_second_contact_of_a_single_path_has_no_probability() {
        let flag = |n_draws: usize| {
            let estimate = |value: f64| Estimate::from_draws(vec![value; n_draws]);
            FlagReport::from(&SecondContacts {
                n_draws,
                probability: 1.0,
                time_s: estimate(0.3),
                x_m: estimate(1.0),
                y_m: estimate(2.0),
                closing_speed_m_s: estimate(0.5),
                apart_share: 1.0,
            })
        };
        let [one, many] = [1, 10].map(flag);
        let probability = |flag: &FlagReport| flag.contact.and_then(|it| it.probability);
        assert_eq!((probability(&one), probability(&many)), (None, Some(1.0)));
        assert_eq!(one.known_until_s(), 0.3);
    }

    #[test]
    fn a_flag_is_written_with_its_numbers_and_is_a_caveat() {
        let roll = FlagReport::from(&MotionFlag::RollLimit { time_s: 0.4, roll_rad: 0.6 });
        let lift = MotionFlag::WheelLift { wheel: Wheel::FrontLeft, time_s: 0.3 };
        let lift = FlagReport::from(&lift);
        let json = serde_json::to_value([&roll, &lift]).unwrap();
        let form = |flag: &FlagReport, kind: &str, wheel: Option<&str>, roll_rad: Option<f64>| {
            json!({
                "kind": kind, "time_s": flag.time_s, "vehicle": flag.vehicle, "wheel": wheel,
                "roll_rad": roll_rad,
                "position_m": null, "closing_speed_m_s": null, "probability": null,
                "message": flag.caveat.text,
            })
        };
        assert_eq!(json[0], form(&roll, "roll_limit", None, Some(0.6)));
        assert_eq!(json[1], form(&lift, "wheel_lift", Some("front_left"), None));
        assert_eq!(lift.caveat.value, Some(0.3));
        let german = NumberFormat { units: UnitSystem::Si, language: Language::De };
        let german = |flag: &FlagReport| flag.caveat.text_in(&german, &str::to_owned).unwrap();
        assert!(german(&roll).starts_with("Ein Wankwinkel von 34,4° bei 0,40 s"), "{roll:?}");
        assert!(german(&lift).contains("front left"), "{lift:?}");
    }

    /// That a wheel lifts was told of recorded pairs without a word of which vehicle.
    #[test]
    fn a_flag_of_one_of_two_vehicles_says_whose_it_is() {
        let lift = MotionFlag::WheelLift { wheel: Wheel::FrontLeft, time_s: 0.3 };
        let english = NumberFormat::english(UnitSystem::Si);
        let german = NumberFormat { units: UnitSystem::Si, language: Language::De };
        for (role, word, said) in [
            (
                Role::Struck,
                "struck",
                ["struck vehicle: the front left", "Gestoßenes Fahrzeug: Das"],
            ),
            (
                Role::Striking,
                "striking",
                ["striking vehicle: the front left", "Stoßendes Fahrzeug: Das"],
            ),
        ] {
            let flag = FlagReport::of_vehicle(role, &lift);
            assert_eq!(serde_json::to_value(&flag).unwrap()["vehicle"], word);
            for (format, said) in [english, german].iter().zip(said) {
                let text = flag.caveat.text_in(format, &str::to_owned).unwrap();
                assert!(text.starts_with(said), "{text}");
            }
            // Its numbers are those of a vehicle alone.
            let alone = FlagReport::from(&lift);
            assert_eq!((flag.time_s, &flag.wheel), (alone.time_s, &alone.wheel));
            assert_eq!(flag.caveat.value, alone.caveat.value);
            assert_eq!(alone.vehicle, None);
        }
    }

    /// “at 1.20 s (90 %: 1.20 to 1.20)” was said of one draw of 60.
    #[test]
    fn second_contacts_of_few_draws_have_no_intervals() {
        let said = |n_met: usize| {
            let estimate = |value: f64| Estimate::from_draws(vec![value; n_met]);
            let text = second_contacts_text(&SecondContacts {
                n_draws: 60,
                probability: n_met as f64 / 60.0,
                time_s: estimate(1.2),
                x_m: estimate(3.0),
                y_m: estimate(-1.0),
                closing_speed_m_s: estimate(5.0),
                apart_share: 1.0,
            });
            text.say(&NumberFormat::english(UnitSystem::Si))
        };
        let expected = "of 60 draws, in the median of these few at 1.20 s, near x 3.0 m, y -1.0 m, \
                        closing at 5.0 m/s: ";
        let few = said(1);
        assert!(few.contains(expected) && !few.contains("90 %"), "{few}");
        let many = said(FEWEST_DRAWS);
        assert!(many.contains("at 1.20 s (90 %: 1.20 to 1.20), near x 3.0 m"), "{many}");
    }

    #[test]
    fn a_second_contact_is_told_in_the_units_of_the_reader() {
        let second = second_contact_text(meeting(true), 0.4, [3.0, -1.0], 5.0);
        let [si, us] =
            [UnitSystem::Si, UnitSystem::Us].map(|units| second.say(&NumberFormat::english(units)));
        let expected =
            "the vehicles meet again at 0.40 s, near x 3.0 m, y -1.0 m, closing at 5.0 m/s: ";
        assert!(si.starts_with(expected), "{si}");
        assert!(us.contains("near x 9.8 ft, y -3.3 ft, closing at 11.2 mph: "), "{us}");
    }
}
