//! Numbers that lie within their range, which leaves room for every case, and are hardly meant: seconds that are
//! milliseconds, metres that are feet, metres per second that are kilometres per hour.

use crate::ranges::{
    BODY_WIDTH, BRAKE_RISE, BRAKE_SHARE, CONTROL_TIME, CRUSH_DEPTH, DRAG_SHARE, ENGINE_BRAKING,
    EVIDENCE_POSITION, EVIDENCE_SPEED, EVIDENCE_TIME, FRICTION_LIMIT, HAND_GRADE, REACTION_TIME,
    RESTITUTION, ROAD_CROSS_SLOPE, ROAD_FRICTION, ROAD_GRADE, ROLLING_RESISTANCE, Range,
    SKID_LENGTH, SPEED, STEERING_RATIO, STEERING_WHEEL_ANGLE, YAW_RATE,
};
use crate::units::{Phrase, PhraseValue, Unit};

/// Number of units that are named, and the least number in them, as a share of what is usual.
const MOST_UNITS: usize = 3;
const LEAST_SHARE: f64 = 0.005;

/// A range with the part of it that collisions of road vehicles have, and the smallest size that anybody states but
/// zero, SI units.
type Usual = (Range, [f64; 2], f64);

/// A driver brakes seconds after a contact; the fastest road cars reach 120 m/s, and collisions are below 70 m/s; racing
/// tires reach a friction of 1.3 on asphalt; car drivers turn the steering wheel by two turns, and before a collision cars
/// turn slower than in a spin.
const USUAL: [Usual; 23] = [
    (CONTROL_TIME, [0.0, 60.0], 1e-3),
    (BRAKE_RISE, [0.0, 5.0], 0.0),
    (REACTION_TIME, [0.0, 10.0], 1e-3),
    (ENGINE_BRAKING, [0.0, 3.0], 1e-3),
    (STEERING_WHEEL_ANGLE, [-15.0, 15.0], 0.0),
    (STEERING_RATIO, [5.0, 35.0], 0.0),
    (SPEED, [-70.0, 70.0], 0.0),
    (YAW_RATE, [-6.0, 6.0], 0.0),
    (BRAKE_SHARE, [0.0, 3.0], 0.02),
    (DRAG_SHARE, [0.0, 3.0], 0.02),
    (RESTITUTION, [0.0, 1.0], 3e-3),
    (ROAD_FRICTION, [0.04, 1.3], 0.0),
    (ROAD_GRADE, [-0.3, 0.3], 2e-3),
    (HAND_GRADE, [-0.3, 0.3], 2e-3),
    (ROAD_CROSS_SLOPE, [-0.3, 0.3], 2e-3),
    (FRICTION_LIMIT, [0.0, 3.0], 0.0),
    (ROLLING_RESISTANCE, [0.0, 0.15], 0.0),
    (BODY_WIDTH, [0.0, 3.5], 0.0),
    (EVIDENCE_SPEED, [0.0, 70.0], 0.0),
    (EVIDENCE_POSITION, [-500.0, 500.0], 0.0),
    (SKID_LENGTH, [0.0, 150.0], 0.0),
    (CRUSH_DEPTH, [0.0, 1.8], 0.0),
    (EVIDENCE_TIME, [0.0, 30.0], 0.0),
];

impl Range {
    /// Why a number of the range is hardly meant, with the units in which it would be usual; `None` if it is as such
    /// numbers are.
    ///
    /// - `key`: what the number is called;
    /// - `value`: SI units.
    pub fn odd(&self, key: &str, value: f64) -> Option<Phrase> {
        self.odd_of(&PhraseValue::Name(key.to_owned()), value)
    }

    /// The same of a number that has a name in every language.
    pub fn odd_of(&self, name: &PhraseValue, value: f64) -> Option<Phrase> {
        let is_same = |(range, ..): &&Usual| {
            range.name == self.name && range.meaning == self.meaning && range.unit() == self.unit()
        };
        let &(_, [low, high], least) = USUAL.iter().find(is_same)?;
        let is_usual =
            |value: f64| (low..=high).contains(&value) && (value == 0.0 || value.abs() >= least);
        if !self.contains(value) || is_usual(value) {
            return None;
        }
        let number = |value: f64| PhraseValue::given(self.quantity, value);
        let said = |text: Phrase| text.with(name.clone()).with(number(value));
        if (low..=high).contains(&value) {
            let text = Phrase::new(
                "{0} is {1}, which is next to nothing: is it in another unit, or a number of per cent?",
                "{0} ist {1}, also so gut wie nichts: Vielleicht ist eine andere Einheit gemeint oder der Wert \
                 in Prozent zu verstehen",
            );
            return Some(said(text));
        }
        let fits = |unit: &&Unit| {
            let meant = unit.to_si(value);
            unit.is_guessed() && is_usual(meant) && meant.abs() >= LEAST_SHARE * high
        };
        let units: Vec<&str> =
            self.quantity.units().iter().filter(fits).map(|u| u.symbol).collect();
        let named: Vec<&str> = units.into_iter().take(MOST_UNITS).collect();
        let text = match named.is_empty() {
            true => Phrase::new(
                "{0} is {1}, and of collisions {2} to {3} is usual: check the number and its unit",
                "{0} ist {1}, bei Kollisionen üblich sind {2} bis {3}: Zahl und Einheit prüfen",
            ),
            false => Phrase::new(
                "{0} is {1}, and of collisions {2} to {3} is usual: is it in {4}?",
                "{0} ist {1}, bei Kollisionen üblich sind {2} bis {3}: vielleicht in {4} gemeint",
            ),
        };
        let text = said(text).with(number(low).bare()).with(number(high));
        let units = PhraseValue::Name(named.join(", "));
        Some(if named.is_empty() { text } else { text.with(units) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranges::VEHICLE_MASS;

    fn said(range: &Range, value: f64) -> Option<String> {
        range.odd("key", value).map(|text| text.say(&Default::default()))
    }

    #[test]
    fn numbers_in_another_unit_are_named_with_it() {
        for (range, value, expected) in [
            (
                CONTROL_TIME,
                350.0,
                "key is 350 s, and of collisions 0 to 60 s is usual: is it in ms?",
            ),
            (
                SPEED,
                120.0,
                "key is 120 m/s, and of collisions -70 to 70 m/s is usual: is it in km/h, mph, ft/s?",
            ),
            (
                ROAD_FRICTION,
                1.9,
                "key is 1.9, and of collisions 0.04 to 1.3 is usual: check the number and its unit",
            ),
            (
                BRAKE_SHARE,
                0.008,
                "key is 0.008, which is next to nothing: is it in another unit, or a number of per cent?",
            ),
            (
                ROAD_GRADE,
                0.0005,
                "key is 0.0005, which is next to nothing: is it in another unit, or a number of per cent?",
            ),
        ] {
            assert_eq!(said(&range, value).as_deref(), Some(expected));
        }
    }

    #[test]
    fn usual_numbers_lie_in_their_ranges_and_are_not_named() {
        for (range, [low, high], least) in USUAL {
            assert!(low < high && (range.high > high || least > 0.0), "{}", range.name);
            for usual in [low.max(range.low), 0.5 * (low.max(range.low) + high), high] {
                let usual = if usual.abs() < least { 0.0_f64.max(range.low) } else { usual };
                assert_eq!(said(&range, usual), None, "{}: {usual}", range.name);
            }
        }
        for (range, value) in [(CONTROL_TIME, 0.0), (ROAD_GRADE, 0.0), (VEHICLE_MASS, 49_000.0)] {
            assert_eq!(said(&range, value), None, "{}: {value}", range.name);
        }
    }
}
