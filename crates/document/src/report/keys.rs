//! Names in JSON and in files: what they mean and in which unit their numbers are.

use crate::report::Language;
use crate::report::labels::{choice_label, name_label};
use crate::report::language::phrase_of;
use crate::report::numbers::Wording;
use impactlab_core::units::Quantity;

/// Names that say only how a question is written down.
const SILENT: [&str; 8] =
    ["", "inline", "source", "motion", "collision", "numbers", "file", "evidence"];

/// Endings of names with their quantities.
const ENDINGS: [(&str, Quantity); 15] = [
    ("_n_per_m2", Quantity::ForcePerArea),
    ("_n_per_m", Quantity::ForcePerLength),
    ("_kg_m2", Quantity::MomentOfInertia),
    ("_rad_s", Quantity::AngularVelocity),
    ("_n_m_s", Quantity::AngularImpulse),
    ("_m_s2", Quantity::Acceleration),
    ("_n_s", Quantity::Impulse),
    ("_n_m", Quantity::Moment),
    ("_m_s", Quantity::Speed),
    ("_rad", Quantity::Angle),
    ("_kg", Quantity::Mass),
    ("_m", Quantity::Length),
    ("_s", Quantity::Time),
    ("_n", Quantity::Force),
    ("_j", Quantity::Energy),
];

/// Endings of names with units that are shown as they are.
const PLAIN_ENDINGS: [(&str, &str); 8] = [
    ("_n_m_s_rad", "N m s/rad"),
    ("_n_m_rad", "N m/rad"),
    ("_n_rad", "N/rad"),
    ("_per_rad", "1/rad"),
    ("_deg_per_g", "deg/g"),
    ("_deg", "deg"),
    ("_m2", "m²"),
    ("_hz", "Hz"),
];

/// Endings that are units by their whole, of names that keep the first part of them.
const WHOLE_ENDINGS: [(&str, &str); 2] = [("_s_m", "s/m"), ("_s2_m2", "s²/m²")];

/// Whether a name is left out where it stands before others.
pub(super) fn is_silent(name: &str) -> bool {
    SILENT.contains(&name)
}

/// The quantity, or the symbol of the unit, that the ending of a name says.
pub(super) fn quantity_of_key(key: &str) -> Option<Result<Quantity, &'static str>> {
    let plain = PLAIN_ENDINGS.iter().chain(&WHOLE_ENDINGS);
    let plain = plain.map(|(ending, symbol)| (ending, Err(*symbol)));
    let quantities = ENDINGS.iter().map(|(ending, quantity)| (ending, Ok(*quantity)));
    let fitting = plain.chain(quantities).filter(|(ending, _)| key.ends_with(*ending));
    fitting.max_by_key(|(ending, _)| ending.len()).map(|(_, unit)| unit)
}

/// A name without the unit at its end, in words.
pub(super) fn bare(key: &str) -> String {
    let endings = PLAIN_ENDINGS.iter().map(|(ending, _)| *ending);
    let endings = endings.chain(ENDINGS.iter().map(|(ending, _)| *ending));
    let longest = endings.filter(|ending| key.ends_with(ending)).max_by_key(|ending| ending.len());
    let bare = longest.and_then(|ending| key.strip_suffix(ending)).unwrap_or(key);
    bare.replace('_', " ")
}

/// The words of a name with the two vehicles called struck and striking, where files call them
/// target and bullet, and with the capitals of CG.
fn in_words_of_the_field(words: &str) -> String {
    let word = |word| match word {
        "target" => "struck vehicle",
        "bullet" => "striking vehicle",
        "cg" => "CG",
        other => other,
    };
    words.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

impl Wording {
    /// A name in the language of the report. In other languages than English a name without a
    /// translation stays as it is, in quotation marks.
    pub fn key(&self, key: &str) -> String {
        // By itself the word is that of axes that turn with a vehicle.
        let words = if key == "body" { "striking body".to_owned() } else { bare(key) };
        match self.language {
            Language::En => {
                name_label(key).map_or_else(|| in_words_of_the_field(&words), str::to_owned)
            }
            Language::De => {
                phrase_of(self.language, &words).unwrap_or_else(|| format!("„{words}“"))
            }
        }
    }

    /// What a choice is called that stands at a name; `None` if the word is none of its choices.
    pub fn choice(&self, key: &str, word: &str) -> Option<String> {
        choice_label(key, word).map(|label| self.term(label))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Paper, ReportDate, ReportSettings};
    use impactlab_core::units::UnitSystem;

    #[test]
    fn the_longest_ending_decides() {
        for (key, expected) in [
            ("yaw_inertia_kg_m2", Some(Ok(Quantity::MomentOfInertia))),
            ("vx_m_s", Some(Ok(Quantity::Speed))),
            ("impulse_n_s", Some(Ok(Quantity::Impulse))),
            ("roll_stiffness_n_m_rad", Some(Err("N m/rad"))),
            ("region_90_m2", Some(Err("m²"))),
            ("rolling_resistance_s_m", Some(Err("s/m"))),
            ("rolling_resistance_s2_m2", Some(Err("s²/m²"))),
            ("onset_n_per_m", Some(Ok(Quantity::ForcePerLength))),
            ("stiffness_n_per_m2", Some(Ok(Quantity::ForcePerArea))),
            ("yaw_rate_rad_s", Some(Ok(Quantity::AngularVelocity))),
            ("restitution", None),
        ] {
            assert_eq!(quantity_of_key(key), expected, "{key}");
        }
        assert_eq!(bare("cg_to_front_axle_m"), "cg to front axle");
        assert_eq!(in_words_of_the_field(&bare("bullet_body")), "striking vehicle body");
    }

    #[test]
    fn bodies_of_both_vehicles_are_named_in_both_languages() {
        let named = |language| {
            let date = ReportDate::new(2026, 1, 2).unwrap();
            let (units, paper) = (UnitSystem::Si, Paper::A4);
            let wording = Wording::new(&ReportSettings { language, units, paper, date });
            ["body", "struck_body"].map(|key| wording.key(key))
        };
        assert_eq!(named(Language::En), ["striking body", "struck body"]);
        let german = ["Aufbau des stoßenden Fahrzeugs", "Aufbau des gestoßenen Fahrzeugs"];
        assert_eq!(named(Language::De), german);
    }
}
