//! Headers that say to which side their numbers are positive, such as `Yaw Rate [deg/s] (CCW positive)`.

use crate::data::si_values::{changes_sign_with_y, compass_quantity};
use crate::data::spelling::{self, Meaning, letters_and_digits};
use crate::data::{Channel, RecordedSide};
use crate::units::Quantity;

/// Words of a column, in letters and digits, that is positive to the left or counterclockwise, and to the right.
const TO_LEFT: [&str; 8] = [
    "leftpositive",
    "positiveleft",
    "positivetoleft",
    "positivetotheleft",
    "ccwpositive",
    "positiveccw",
    "counterclockwisepositive",
    "positivecounterclockwise",
];
const TO_RIGHT: [&str; 8] = [
    "rightpositive",
    "positiveright",
    "positivetoright",
    "positivetotheright",
    "cwpositive",
    "positivecw",
    "clockwisepositive",
    "positiveclockwise",
];

/// The same in German, with the English words that are looked for.
const GERMAN: [(&str, &str); 10] = [
    ("gegendenuhrzeigersinn", "counterclockwise"),
    ("gegenuhrzeigersinn", "counterclockwise"),
    ("imuhrzeigersinn", "clockwise"),
    ("mathematischpositiv", "counterclockwise"),
    ("linkspositiv", "leftpositive"),
    ("positivlinks", "positiveleft"),
    ("positivnachlinks", "positivetoleft"),
    ("rechtspositiv", "rightpositive"),
    ("positivrechts", "positiveright"),
    ("positivnachrechts", "positivetoright"),
];

/// Letters and digits of a header with one English word for each side.
fn key_of(text: &str) -> String {
    let key = letters_and_digits(text).replace("anticlockwise", "counterclockwise");
    GERMAN.iter().fold(key, |key, (german, english)| key.replace(*german, english))
}

/// The side to which a column says that it is positive; `None` also where it names both sides, or one to which it is
/// negative.
pub(super) fn stated_side(name: &str) -> Option<RecordedSide> {
    // `right positive, left negative` without its comma has `positive left` in it.
    let mut parts = name.split([',', ';', '/', '(', ')']).map(key_of);
    let in_part = parts.find_map(|key| {
        let others = key.replace("counterclockwise", "").replace("ccw", "");
        let has = |key: &str, words: &[&str]| words.iter().any(|word| key.contains(word));
        one_side(has(&key, &TO_LEFT), has(&others, &TO_RIGHT))
    });
    in_part.or_else(|| {
        let key = key_of(name);
        let others = key.replace("counterclockwise", "");
        let side = one_side(others.len() < key.len(), others.contains("clockwise"));
        // In German, too.
        side.filter(|_| !key.contains("negativ"))
    })
}

/// The one of both sides that is named alone.
fn one_side(is_left: bool, is_right: bool) -> Option<RecordedSide> {
    match (is_left, is_right) {
        (true, false) => Some(RecordedSide::Left),
        (false, true) => Some(RecordedSide::Right),
        _ => None,
    }
}

/// A header without what it says of sides in brackets or behind a comma, with the side to which it is positive; `None`
/// if it says none there.
pub(super) fn without_side(header: &str) -> Option<(String, RecordedSide)> {
    let parts = || header.split(['(', ')', '[', ']', ',', ';']).skip(1);
    let side = parts().find_map(stated_side)?;
    let is_of_sides =
        |part: &&str| stated_side(part).is_some() || part.to_lowercase().contains("negativ");
    let drop = |name: String, part: &str| name.replacen(part, "", 1);
    Some((parts().filter(is_of_sides).fold(header.to_owned(), drop), side))
}

/// The header without its side, if that is read with it. A heading that is positive to the right is more often that of a
/// compass, which its path tells.
pub(super) fn bare_header(header: &str) -> Option<String> {
    let (bare, _) = without_side(header)?;
    let Meaning::Channel(channel, _) = spelling::meaning(&bare) else { return None };
    side_of(header, channel).map(|_| bare)
}

/// The side to which a header says that its numbers are positive, of a channel that is positive to the left here.
pub(super) fn side_of(header: &str, channel: Channel) -> Option<RecordedSide> {
    let (_, side) = without_side(header)?;
    let is_compass =
        compass_quantity(channel) == Some(Quantity::Angle) && side == RecordedSide::Right;
    (changes_sign_with_y(channel) && !is_compass).then_some(side)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_side_of_a_column_is_the_one_to_which_it_is_positive() {
        use RecordedSide::{Left, Right};
        for (words, side) in [
            ("counterclockwise", Some(Left)),
            ("Anticlockwise Positive", Some(Left)),
            ("CCW positive", Some(Left)),
            ("positive to the left", Some(Left)),
            ("clockwise", Some(Right)),
            ("positive clockwise", Some(Right)),
            ("clockwise positive, counterclockwise negative", Some(Right)),
            ("anticlockwise positive, clockwise negative", Some(Left)),
            ("left negative, right positive", Some(Right)),
            ("(right positive, left negative)", Some(Right)),
            ("right positive left negative", None),
            ("links positiv", Some(Left)),
            ("positiv nach rechts", Some(Right)),
            ("rechts negativ, links positiv", Some(Left)),
            ("gegen den Uhrzeigersinn", Some(Left)),
            ("im Uhrzeigersinn positiv", Some(Right)),
            ("links negativ", None),
            // Which sign is meant stands in signs, or only that of the negative side is told.
            ("clockwise +, counterclockwise -", None),
            ("clockwise negative", None),
            ("", None),
        ] {
            let name = format!("Steering Wheel Angle, {words} [deg]");
            assert_eq!(stated_side(&name), side, "{words}");
        }
    }

    #[test]
    fn a_header_is_read_without_its_side() {
        use RecordedSide::{Left, Right};
        for (header, bare, side) in [
            ("Yaw Rate [deg/s] (CCW positive)", "Yaw Rate [deg/s] ()", Left),
            ("Yaw Rate (CW positive) [deg/s]", "Yaw Rate () [deg/s]", Right),
            ("Yaw Rate, positive left [deg/s]", "Yaw Rate,[deg/s]", Left),
            ("ay (left negative, right positive) [g]", "ay (,) [g]", Right),
            ("Gierrate [Grad/s] (rechts positiv)", "Gierrate [Grad/s] ()", Right),
            ("Gierrate (links positiv) [Grad/s]", "Gierrate () [Grad/s]", Left),
        ] {
            assert_eq!(without_side(header), Some((bare.to_owned(), side)), "{header}");
            assert_eq!(bare_header(header).as_deref(), Some(bare), "{header}");
        }
        assert_eq!(bare_header("Heading (clockwise positive) [deg]"), None);
        assert_eq!(bare_header("Speed (left positive) [m/s]"), None);
        assert_eq!(without_side("Yaw Rate [deg/s]"), None);
    }
}
