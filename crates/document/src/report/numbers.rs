//! Numbers and texts as a report writes them.

use std::ops::Deref;

use crate::report::language::{Words, given_name_of, phrase_of, words_of};
use crate::report::{Language, ReportDate, ReportSettings};
use impactlab_core::uncertainty::Caveat;
use impactlab_core::units::{
    NumberFormat, Phrase, Quantity, UnitSystem, is_converted, significant, trimmed,
};
use impactlab_core::vehicle::BuiltInVehicle;

/// Writes numbers and texts in the language and the units of a report. Numbers are written by the
/// format of the whole program.
#[derive(Clone, Copy)]
pub(super) struct Wording {
    /// Numbers.
    format: NumberFormat,
    /// The texts of the report itself.
    pub words: &'static Words,
}

/// How the remarks begin that the window writes of a cell of the atlas, in English and in German.
const CELL_REMARKS: [(&str, &str); 2] = [
    ("From the atlas. ", "Aus dem Atlas. "),
    ("The middle of a cell of the atlas. ", "Die Mitte einer Zelle des Atlas. "),
];

impl Deref for Wording {
    type Target = NumberFormat;

    fn deref(&self) -> &NumberFormat {
        &self.format
    }
}

impl Wording {
    /// Texts and numbers by the settings of a report.
    pub fn new(settings: &ReportSettings) -> Self {
        let (language, units) = (settings.language, settings.units);
        Self { format: NumberFormat { units, language }, words: words_of(language) }
    }

    /// Texts and numbers of the window.
    pub fn english(units: UnitSystem) -> Self {
        Self { format: NumberFormat::english(units), words: words_of(Language::En) }
    }

    /// A number that was given, with its digits and its unit; one that does not end within six is the
    /// result of a conversion and has those that are shown of a result.
    pub fn given(&self, quantity: Quantity, value_si: f64) -> String {
        let unit = quantity.display_unit(self.units);
        self.with_unit(&self.stated_number(unit.from_si(value_si)), unit.symbol)
    }

    /// The same of a pure number.
    pub fn given_number(&self, value: f64) -> String {
        self.stated_number(value)
    }

    /// From one number that was given to another. Where digits are cut off, the range gets wider.
    pub fn given_range(&self, quantity: Quantity, [low, high]: [f64; 2]) -> String {
        let unit = quantity.display_unit(self.units);
        let [low, high] = [low, high].map(|si| unit.from_si(si));
        let low = self.with_unit(&self.digits_outwards(low, f64::floor), unit.symbol);
        let high = self.with_unit(&self.digits_outwards(high, f64::ceil), unit.symbol);
        format!("{low} {} {high}", self.words.to)
    }

    /// - `outwards`: to the whole number beyond, away from the middle of the range.
    fn digits_outwards(&self, value: f64, outwards: fn(f64) -> f64) -> String {
        if !is_converted(value) || value == 0.0 || !value.is_finite() {
            return self.format.given_number(value);
        }
        let step = 10.0_f64.powi(value.abs().log10().floor() as i32 - 3);
        self.local(&trimmed(significant(outwards(value / step) * step)))
    }

    /// A text that the program has in English only: in quotation marks in a report in another language.
    pub fn quoted(&self, text: &str) -> String {
        match (self.language, text.is_empty()) {
            (Language::En, _) | (_, true) => text.to_owned(),
            (Language::De, false) => format!("„{text}“"),
        }
    }

    /// A label of the program in the language of the report; as [`Wording::quoted`] where it has none.
    pub fn term(&self, text: &str) -> String {
        phrase_of(self.language, text).unwrap_or_else(|| self.quoted(text))
    }

    /// A name in a picture in the language and the units of the report; as it is where it has none, such as that
    /// of a variant.
    pub fn name(&self, text: &str) -> String {
        let parts = || -> Option<Vec<String>> {
            text.split(", ").map(|part| phrase_of(self.language, part)).collect()
        };
        let known = given_name_of(self.language, text).or_else(|| phrase_of(self.language, text));
        let known = known.or_else(|| Some(parts()?.join(", ")));
        let name = known.map_or_else(|| text.to_owned(), |known| self.local(&known));
        BuiltInVehicle::name_in_units(text, &name, &self.format)
    }

    /// A name of a case, a variant or a zone: in the language of the report if the program gave it, else as it is.
    pub fn given_name(&self, name: &str) -> String {
        given_name_of(self.language, name).unwrap_or_else(|| name.to_owned())
    }

    /// What a caveat says, in the units of the report; as [`Wording::quoted`] if in English alone.
    /// Options of the command line and files of the program mean nothing to the reader of a report.
    pub fn caveat_text(&self, caveat: &Caveat) -> String {
        let text = self.said(caveat.text_phrase.as_ref(), &caveat.text);
        without_options(&text).replace(LIMITS_FILE, self.words.at_validation)
    }

    /// A phrase in the language and the units of the report; else the English text.
    fn said(&self, phrase: Option<&Phrase>, text: &str) -> String {
        match phrase {
            Some(phrase) => phrase.say_shown(&self.format, &|label| self.label(label)),
            None => self.note(text),
        }
    }

    /// A note, a rule or a source of the program in the language and the units of the report, part by part;
    /// as [`Wording::quoted`] where a part has no translation.
    pub fn note(&self, text: &str) -> String {
        let said = text.split("; ").map(|part| self.part_in_units(part));
        let parts: Option<Vec<String>> = said.map(|part| phrase_of(self.language, &part)).collect();
        parts.map_or_else(|| self.quoted(text), |parts| self.local(&parts.join("; ")))
    }

    /// A part of a note with what a collision replaces in the units of the report.
    fn part_in_units(&self, part: &str) -> String {
        let before = part.strip_prefix(SAID_INSTEAD).and_then(|value| self.in_units(value));
        if let Some(value) = before {
            return format!("{SAID_INSTEAD}{value}");
        }
        let masses = part.strip_prefix(SCALED).and_then(|masses| masses.split_once(" to "));
        let masses = masses.and_then(|(from, to)| {
            Some([self.in_units(&format!("{from} kg"))?, self.in_units(to)?])
        });
        masses.map_or_else(|| part.to_owned(), |[from, to]| format!("{SCALED}{from} to {to}"))
    }

    /// Remarks of a person, which stay as they are, but for those that the window writes of a cell of the atlas.
    pub fn remarks(&self, text: &str) -> String {
        let of_cell = || {
            let of = |(en, de): &(&str, &'static str)| Some((text.strip_prefix(en)?, *de));
            let (cell, before) = CELL_REMARKS.iter().find_map(of)?;
            let parts: Option<Vec<String>> =
                cell.split("; ").map(|part| self.axis_with_bin(part)).collect();
            Some(format!("{before}{}", parts?.join("; ")))
        };
        let german = (self.language == Language::De).then(of_cell).flatten();
        german.unwrap_or_else(|| text.to_owned())
    }

    /// An axis of the atlas with one of its bins, such as `Closing speed across the lane: 10 to 15 km/h`.
    fn axis_with_bin(&self, text: &str) -> Option<String> {
        let (axis, bin) = text.split_once(": ")?;
        let axis = phrase_of(self.language, axis)?;
        let ends = bin.split_once(" to ").filter(|(low, _)| low.parse::<f64>().is_ok());
        let bin = match ends {
            Some((low, high)) => {
                let (high, symbol) = high.split_once(' ').unwrap_or((high, ""));
                self.with_unit(&format!("{low} {} {high}", self.words.to), symbol)
            }
            // Pairs of vehicles are names.
            None => phrase_of(self.language, bin).unwrap_or_else(|| bin.to_owned()),
        };
        Some(format!("{axis}: {bin}"))
    }

    /// A number with its SI unit, as notes of vehicle data have it, in the units of the report.
    fn in_units(&self, value: &str) -> Option<String> {
        let (number, symbol) = value.split_once(' ')?;
        let quantity = Quantity::from_si_symbol(symbol)?;
        Some(self.given(quantity, number.parse().ok()?))
    }

    /// A day of the calendar, as YYYY-MM-DD; as it is if it is none.
    pub fn day(&self, day: &str) -> String {
        let day_of = |day: ReportDate| day.written(self.language);
        day.parse().map_or_else(|_| day.to_owned(), day_of)
    }

    /// A time in UTC, as YYYY-MM-DDThh:mm:ssZ; as it is if it is none.
    pub fn moment(&self, time: &str) -> String {
        let parts = time.split_once('T');
        let parts = parts.and_then(|(day, clock)| Some((day, clock.strip_suffix('Z')?)));
        parts.map_or_else(|| time.to_owned(), |(day, clock)| format!("{} {clock}", self.day(day)))
    }

    /// The same of why something was assumed or is not used.
    pub fn caveat_reason(&self, caveat: &Caveat) -> String {
        let reason = caveat.reason.as_deref().unwrap_or_default();
        without_options(&self.said(caveat.reason_phrase.as_ref(), reason))
    }

    /// A label, whole or of parts that are joined by commas.
    pub fn label(&self, text: &str) -> String {
        phrase_of(self.language, text).unwrap_or_else(|| self.phrase(text))
    }

    /// The same of parts that are joined by commas.
    pub fn phrase(&self, text: &str) -> String {
        let parts: Option<Vec<String>> =
            text.split(", ").map(|part| phrase_of(self.language, part)).collect();
        parts.map_or_else(|| self.quoted(text), |parts| self.local(&parts.join(", ")))
    }
}

/// Where the guide says how often intervals held, as section 7 of a report does.
const LIMITS_FILE: &str = "docs/guide/limits.md";

/// How the note of a value begins that a collision states in place of that of the vehicle.
const SAID_INSTEAD: &str = "said with the collision, instead of ";

/// How the rule of a value begins that follows the mass of a collision.
const SCALED: &str = "scaled in proportion to the mass, from ";

/// Words of what names nothing but an option or a key of a file, such as “another one: --vehicle”.
const WORDS_OF_OPTION: usize = 3;

/// A sentence without the options of the command line and the keys of files that it names: in brackets, behind
/// a colon, or as a clause of its own.
pub fn without_options(text: &str) -> String {
    let text = without_brackets(&without_brackets(text, " (--"), " ([");
    let named_before = |part: &str| {
        let (named, _) = part.split_once(": --").or_else(|| part.split_once(": ["))?;
        Some(named.to_owned())
    };
    let kept = text.split("; ").filter_map(|part| match named_before(part) {
        None => (!names_option(part)).then(|| part.to_owned()),
        Some(named) => (named.split(' ').count() > WORDS_OF_OPTION).then_some(named),
    });
    kept.collect::<Vec<_>>().join("; ")
}

/// Whether a clause is about an option of the command line or a key of a file. A unit in brackets stands behind
/// what it is of, and a key before all else.
fn names_option(clause: &str) -> bool {
    clause.starts_with('[') || clause.starts_with("--") || clause.contains(" --")
}

/// A text without what stands in brackets that begin so.
fn without_brackets(text: &str, begin: &str) -> String {
    let mut text = text.to_owned();
    while let Some((before, behind)) = text.split_once(begin) {
        let Some((_, behind)) = behind.split_once(')') else { break };
        text = format!("{before}{behind}");
    }
    text
}

/// A template with `{name}` replaced by values.
pub(super) fn fill(template: &str, values: &[(&str, &str)]) -> String {
    let mut text = String::with_capacity(template.len());
    let mut rest = template;
    // One pass, so that a value that holds braces is not filled in again.
    while let Some((before, after)) = rest.split_once('{') {
        text.push_str(before);
        let Some((name, behind)) = after.split_once('}') else {
            rest = after;
            continue;
        };
        match values.iter().find(|(key, _)| *key == name) {
            Some((_, value)) => text.push_str(value),
            None => text.push_str(&format!("{{{name}}}")),
        }
        rest = behind;
    }
    text.push_str(rest);
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::uncertainty::CaveatKind;
    use impactlab_core::units::PhraseValue;
    use impactlab_sweep::atlas::Axis;

    /// 62 km/h at 18° were told as 58.965504 km/h, and 1 m/s as 2.2369363 mph.
    #[test]
    fn a_given_number_has_its_digits_and_not_those_of_a_conversion() {
        let [si, us] = [UnitSystem::Si, UnitSystem::Us].map(Wording::english);
        assert_eq!(si.given(Quantity::Speed, 16.379_306_669_527_644), "58.97 km/h");
        assert_eq!(si.given(Quantity::Speed, 15.0), "54 km/h");
        assert_eq!(si.given(Quantity::Mass, 123_456.0), "123456 kg");
        assert_eq!(si.given(Quantity::Length, 0.000_021), "0.000021 m");
        assert_eq!(us.given(Quantity::Speed, 1.0), "2.237 mph");
        assert_eq!(si.given_number(1.0 / 3.0), "0.3333");
    }

    #[test]
    fn a_range_whose_digits_are_cut_off_gets_wider() {
        let [si, us] = [UnitSystem::Si, UnitSystem::Us].map(Wording::english);
        assert_eq!(us.given_range(Quantity::Speed, [1.0, 2.0]), "2.236 mph to 4.474 mph");
        assert_eq!(us.given_range(Quantity::Speed, [-1.0, 0.0]), "-2.237 mph to 0 mph");
        assert_eq!(si.given_range(Quantity::Speed, [1.0, 2.0]), "3.6 km/h to 7.2 km/h");
    }

    #[test]
    fn a_caveat_is_told_in_the_language_and_the_units_of_the_report() {
        let format = NumberFormat { units: UnitSystem::Us, language: Language::De };
        let german = Wording { format, words: words_of(Language::De) };
        let name = "mass of the struck vehicle [kg]";
        let text = Phrase::new("{0} is {1}", "{0} beträgt {1}")
            .with(PhraseValue::Heading(name.to_owned()))
            .with(PhraseValue::of_named(name, 1000.0));
        let caveat = Caveat::new(CaveatKind::OutsideDomain, text);
        let expected = "Masse des gestoßenen Fahrzeugs [lb] beträgt 2205";
        assert_eq!(german.caveat_text(&caveat), expected);
        let english = Wording::english(UnitSystem::Us);
        assert_eq!(english.caveat_text(&caveat), "mass of the struck vehicle [lb] is 2205");
        let unknown = Caveat::not_used("what", "why");
        let told = [german.caveat_text(&unknown), german.caveat_reason(&unknown)];
        assert_eq!(told, ["„what“", "„why“"]);
    }

    /// The value before was in SI units where all else was in those of the United States.
    #[test]
    fn what_a_collision_replaces_is_in_the_units_of_the_report() {
        let note = "said with the collision, instead of 1000 kg; dry asphalt";
        let told = Wording::english(UnitSystem::Us).note(note);
        assert_eq!(told, "said with the collision, instead of 2205 lb; dry asphalt");
        let format = NumberFormat { units: UnitSystem::Si, language: Language::De };
        let german = Wording { format, words: words_of(Language::De) };
        let told = german.note("said with the collision, instead of 2.0468 m");
        assert_eq!(told, "mit der Kollision angegeben, statt 2,0468 m");
        // A rule was in kg in a report in pounds, with all digits of 3400 lb.
        let rule = "scaled in proportion to the mass, from 2000 to 1542 kg";
        let told = Wording::english(UnitSystem::Us).note(rule);
        assert_eq!(told, "scaled in proportion to the mass, from 4409 lb to 3400 lb");
        assert_eq!(
            german.note(rule),
            "im Verhältnis der Masse umgerechnet, von 2000 kg auf 1542 kg"
        );
    }

    /// A car of “2000 kg” stood beside masses in pounds. What somebody calls a car is theirs.
    #[test]
    fn the_mass_in_the_name_of_a_shipped_vehicle_is_in_the_units_of_the_report() {
        let name = "Reference car (multibody, 2000 kg)";
        let us = Wording::english(UnitSystem::Us);
        assert_eq!(us.name(name), "Reference car (multibody, 4409 lb)");
        assert_eq!(Wording::english(UnitSystem::Si).name(name), name);
        let format = NumberFormat { units: UnitSystem::Us, language: Language::De };
        let german = Wording { format, words: words_of(Language::De) };
        assert_eq!(german.name(name), "Referenzfahrzeug (Mehrkörpermodell, 4409 lb)");
        assert_eq!(us.name("our van (2000 kg)"), "our van (2000 kg)");
    }

    /// What the window writes of a cell of the atlas stood in English in a German opinion.
    #[test]
    fn remarks_on_a_cell_of_the_atlas_are_german_and_others_stay() {
        let format = NumberFormat { units: UnitSystem::Si, language: Language::De };
        let german = Wording { format, words: words_of(Language::De) };
        let axes = Axis::pit().unwrap();
        let cell: Vec<String> = axes
            .iter()
            .map(|axis| format!("{}: {}", axis.label, axis.bin_text(0, UnitSystem::Si)))
            .collect();
        let english = format!("From the atlas. {}", cell.join("; "));
        let told = german.remarks(&english);
        assert!(told.starts_with("Aus dem Atlas. "), "{told}");
        for axis in &axes {
            assert!(!told.contains(&axis.label), "{}: {told}", axis.label);
        }
        assert!(told.contains(" bis ") && !told.contains(" to "), "{told}");
        assert_eq!(Wording::english(UnitSystem::Si).remarks(&english), english);
        let own = "From the atlas. What I saw: nothing";
        assert_eq!(german.remarks(own), own);
    }

    /// “another one: --vehicle” stood in an opinion that is read in court.
    #[test]
    fn no_option_of_the_command_line_is_told() {
        for (text, told) in [
            ("no vehicle was named; another one: --vehicle", "no vehicle was named"),
            ("as of dry asphalt, 7.5 % of it: --friction-sigma", "as of dry asphalt, 7.5 % of it"),
            (
                "say that it brakes (--brake 0.8), or rolls (--coast)",
                "say that it brakes, or rolls",
            ),
            (
                "by the struck side; otherwise: [damage] angle_deg or [prior] a",
                "by the struck side",
            ),
            ("X; Y: and no more", "X; Y: and no more"),
            // Keys of the evidence stood where a reader expects words.
            (
                "nothing of its way is among the evidence ([rest], [[mark]]), so that it coasts",
                "nothing of its way is among the evidence, so that it coasts",
            ),
            ("it coasts; [bullet_ending] of the scenario says it", "it coasts"),
            ("left out here; leave out --one-contact", "left out here"),
            ("track [m] is 1.5; mass [kg] is 2", "track [m] is 1.5; mass [kg] is 2"),
        ] {
            assert_eq!(without_options(text), told);
        }
    }

    #[test]
    fn a_value_with_braces_is_not_filled_in() {
        assert_eq!(fill("{a} of {b}, {c", &[("a", "{b}"), ("b", "2")]), "{b} of 2, c");
    }
}
