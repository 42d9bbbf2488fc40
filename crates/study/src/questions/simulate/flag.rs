//! What is flagged in a simulated motion: wheel lift, roll beyond the limit, energy that grows, a second
//! contact.

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::SecondContacts;
use crate::word;
use impactlab_core::collision::SecondContact;
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::percent;
use impactlab_core::vehicle::{MotionFlag, ROLL_LIMIT_RAD};

/// A [`MotionFlag`] or a [`SecondContact`]: the caveat that it is, and its numbers.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(into = "FlagJson")]
pub struct FlagReport {
    /// What it says of the motion.
    pub caveat: Caveat,
    /// When it is first raised, s.
    pub time_s: f64,
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
    /// Share of the draws in which they do; time, place and speed are then medians. None where
    /// nothing is drawn.
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
    fn from(FlagReport { caveat, time_s, wheel, contact }: FlagReport) -> Self {
        let Caveat { kind, value, text, .. } = caveat;
        Self {
            kind,
            time_s,
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
    fn new(kind: CaveatKind, time_s: f64, message: String) -> Self {
        let caveat = Caveat::new(kind, message).with_value("time [s]", time_s);
        Self { caveat, time_s, wheel: None, contact: None }
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
const NOT_COMPUTED: &str = "a second contact, which is not computed; the motions after it are not \
                            those of the vehicles, and no position after it has a probability";

/// Share of the draws with a second contact from which on positions after it have no probability: half of
/// what an interval of 90 % leaves out.
const MOST_SECOND_CONTACTS: f64 = 0.05;

impl From<&SecondContact> for FlagReport {
    fn from(second: &SecondContact) -> Self {
        let ([x, y], speed) = (second.point_m, second.closing_speed_m_s);
        let how = if second.was_apart { "meet again" } else { "go deeper into each other" };
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
fn second_contact_text(how: &str, time_s: f64, [x, y]: [f64; 2], speed_m_s: f64) -> String {
    format!(
        "the vehicles {how} at {time_s:.2} s, near x {x:.1} m, y {y:.1} m, closing at \
         {speed_m_s:.1} m/s: {NOT_COMPUTED}"
    )
}

impl From<&SecondContacts> for FlagReport {
    fn from(met: &SecondContacts) -> Self {
        let (x, y, speed) = (met.x_m.median, met.y_m.median, met.closing_speed_m_s.median);
        let how = match 2.0 * met.apart_share > 1.0 {
            true => "meet again",
            false => "go deeper into each other",
        };
        let time_s = met.time_s.median;
        let ([from_s, to_s], [slow, fast]) = (met.time_s.ninety(), met.closing_speed_m_s.ninety());
        let message = match met.n_draws {
            // One known force on one known vehicle: nothing is drawn.
            1 => second_contact_text(how, time_s, [x, y], speed),
            n_draws => format!(
                "the vehicles {how} in {} of {n_draws} draws, at {time_s:.2} s (90 %: {from_s:.2} to \
                 {to_s:.2}), near x {x:.1} m, y {y:.1} m, closing at {speed:.1} m/s (90 %: \
                 {slow:.1} to {fast:.1}): {NOT_COMPUTED}",
                percent(met.probability),
            ),
        };
        let contact = FlaggedContact {
            position_m: [x, y],
            closing_speed_m_s: speed,
            probability: Some(met.probability),
            from_s,
        };
        let flag = Self::new(CaveatKind::SecondContact, time_s, message);
        Self { contact: Some(contact), ..flag }
    }
}

impl From<&MotionFlag> for FlagReport {
    fn from(flag: &MotionFlag) -> Self {
        let flagged = |kind, time_s: f64| Self::new(kind, time_s, flag.to_string());
        match flag {
            MotionFlag::WheelLift { wheel, time_s } => {
                Self { wheel: Some(word(wheel)), ..flagged(CaveatKind::WheelLift, *time_s) }
            }
            MotionFlag::RollLimit { time_s, roll_rad } => {
                let caveat = Caveat::new(CaveatKind::RollLimit, flag.to_string())
                    .with_value("roll angle [rad]", *roll_rad)
                    .with_range([-ROLL_LIMIT_RAD, ROLL_LIMIT_RAD]);
                Self { caveat, ..flagged(CaveatKind::RollLimit, *time_s) }
            }
            MotionFlag::EnergyGain { time_s } => flagged(CaveatKind::EnergyGain, *time_s),
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use impactlab_core::vehicle::Wheel;

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
    fn a_flag_is_written_with_its_numbers_and_is_a_caveat() {
        let roll = FlagReport::from(&MotionFlag::RollLimit { time_s: 0.4, roll_rad: 0.6 });
        let lift = MotionFlag::WheelLift { wheel: Wheel::FrontLeft, time_s: 0.3 };
        let lift = FlagReport::from(&lift);
        let json = serde_json::to_value([&roll, &lift]).unwrap();
        let form = |flag: &FlagReport, kind: &str, wheel: Option<&str>, roll_rad: Option<f64>| {
            json!({
                "kind": kind, "time_s": flag.time_s, "wheel": wheel, "roll_rad": roll_rad,
                "position_m": null, "closing_speed_m_s": null, "probability": null,
                "message": flag.caveat.text,
            })
        };
        assert_eq!(json[0], form(&roll, "roll_limit", None, Some(0.6)));
        assert_eq!(json[1], form(&lift, "wheel_lift", Some("front_left"), None));
        assert_eq!(lift.caveat.value, Some(0.3));
    }
}
