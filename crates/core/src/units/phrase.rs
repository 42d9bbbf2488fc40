//! Sentences in every language of a report, whose values are written in the units of the reader.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::units::{Language, NumberFormat, PhraseValue};

/// A sentence in every language of a report. `{0}` in it stands for the first value, `{1}` for the
/// second.
///
/// In English with SI units each value has the unit and the digits that it was given with; otherwise
/// the unit of display, with digits that are no finer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Phrase {
    /// English.
    en: String,
    /// German.
    de: String,
    /// What stands for the numbers in braces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    values: Vec<PhraseValue>,
}

impl Phrase {
    /// A sentence without values.
    pub fn new(en: impl Into<String>, de: impl Into<String>) -> Self {
        Self { en: en.into(), de: de.into(), values: Vec::new() }
    }

    /// One value, in every language alike.
    pub fn of(value: PhraseValue) -> Self {
        Self::new("{0}", "{0}").with(value)
    }

    /// Sentences one after the other.
    pub fn joined(phrases: impl IntoIterator<Item = Self>, between: &str) -> Self {
        let (of, between) = (phrases.into_iter().collect(), between.to_owned());
        Self::of(PhraseValue::Phrases { of, between })
    }

    /// The same with the next value.
    #[must_use]
    pub fn with(mut self, value: PhraseValue) -> Self {
        self.values.push(value);
        self
    }

    /// The text; labels of the program stay English.
    pub fn say(&self, format: &NumberFormat) -> String {
        self.say_with(format, &str::to_owned)
    }

    /// The text.
    ///
    /// - `term`: a label of the program in the language of the format.
    pub fn say_with(&self, format: &NumberFormat, term: &dyn Fn(&str) -> String) -> String {
        let is_canonical = *format == NumberFormat::default();
        self.written(format, term, is_canonical)
    }

    /// The same with the units in which numbers are shown also in English with SI units: `28.4 km/h` for
    /// `7.9 m/s`.
    pub fn say_shown(&self, format: &NumberFormat, term: &dyn Fn(&str) -> String) -> String {
        self.written(format, term, false)
    }

    /// - `is_canonical`: whether numbers have the units of the phrase, and not those of the reader.
    pub(super) fn written(
        &self,
        format: &NumberFormat,
        term: &dyn Fn(&str) -> String,
        is_canonical: bool,
    ) -> String {
        let template = match format.language {
            Language::En => &self.en,
            Language::De => &self.de,
        };
        let values = self.values.iter().map(|it| it.say(format, term, is_canonical));
        filled(template, &values.collect::<Vec<String>>())
    }

    /// Whether every number is finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.values.iter().all(PhraseValue::is_finite)
    }
}

/// A template with its values.
fn filled(template: &str, values: &[String]) -> String {
    let mut text = String::with_capacity(template.len());
    let mut rest = template;
    while let Some((before, after)) = rest.split_once('{') {
        text.push_str(before);
        let place = after.split_once('}').and_then(|(idx, after)| {
            let value = values.get(idx.parse::<usize>().ok()?)?;
            Some((value.as_str(), after))
        });
        let (value, after) = place.unwrap_or(("{", after));
        text.push_str(value);
        rest = after;
    }
    text.push_str(rest);
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::{Quantity, UnitSystem};

    const EN: NumberFormat = NumberFormat { units: UnitSystem::Si, language: Language::En };
    const EN_US: NumberFormat = NumberFormat { units: UnitSystem::Us, language: Language::En };
    const DE: NumberFormat = NumberFormat { units: UnitSystem::Si, language: Language::De };

    fn said(phrase: &Phrase) -> [String; 3] {
        [EN, EN_US, DE].map(|format| phrase.say(&format))
    }

    #[test]
    fn values_are_written_in_the_units_and_the_language_of_the_reader() {
        let phrase = Phrase::new("{0} after {1}", "nach {1} noch {0}")
            .with(PhraseValue::fixed(Quantity::Speed, 12.34, 1))
            .with(PhraseValue::fixed(Quantity::Time, 1.5, 2));
        let expected =
            ["12.3 m/s after 1.50 s", "27.6 mph after 1.50 s", "nach 1,50 s noch 44,4 km/h"];
        assert_eq!(said(&phrase), expected);
        assert_eq!(phrase.say_shown(&EN, &str::to_owned), "44.4 km/h after 1.50 s");
        let mass = Phrase::of(PhraseValue::three_digits(Quantity::Mass, 1500.0));
        assert_eq!(said(&mass), ["1500 kg", "3307 lb", "1500 kg"]);
        let roll = Phrase::of(PhraseValue::fixed(Quantity::Angle, 0.6, 1).in_unit("deg"));
        assert_eq!(said(&roll), ["34.4 deg", "34.4 deg", "34,4°"]);
        let share = Phrase::of(PhraseValue::fixed(Quantity::Ratio, 0.123, 0).in_unit("%"));
        assert_eq!(said(&share), ["12 %", "12 %", "12 %"]);
        let force = Phrase::of(PhraseValue::fixed(Quantity::Force, 2.345e6, 2).in_unit("MN"));
        assert_eq!(said(&force), ["2.35 MN", "527177 lbf", "2345 kN"]);
    }

    #[test]
    fn a_name_with_a_unit_and_its_numbers_are_of_one_unit() {
        let name = "speed at the end [m/s]";
        let phrase = Phrase::new("{0} is {1}", "{0} ist {1}")
            .with(PhraseValue::Heading(name.to_owned()))
            .with(PhraseValue::of_named(name, 10.0));
        let [en, us, de] = said(&phrase);
        assert_eq!(en, "speed at the end [m/s] is 10.00");
        assert_eq!(us, "speed at the end [mph] is 22.37");
        assert_eq!(de, "speed at the end [km/h] ist 36,00");
        let term =
            |text: &str| if text == "speed at the end" { "v".to_owned() } else { text.into() };
        assert_eq!(phrase.say_with(&DE, &term), "v [km/h] ist 36,00");
        assert_eq!(phrase.say_shown(&EN, &str::to_owned), "speed at the end [km/h] is 36.00");
        let odd = PhraseValue::of_named("roll gradient [rad/g]", 0.1);
        assert_eq!(Phrase::of(odd).say(&DE), "0,1000");
    }

    #[test]
    fn phrases_stand_in_phrases_and_english_is_quoted() {
        let parts = [Phrase::new("one", "eins"), Phrase::new("two", "zwei")];
        let all = Phrase::new("all: {0}; {1}", "alle: {0}; {1}")
            .with(PhraseValue::Phrases { of: parts.to_vec(), between: ", ".to_owned() })
            .with(PhraseValue::English("{0} is no place".to_owned()));
        assert_eq!(all.say(&EN), "all: one, two; {0} is no place");
        assert_eq!(all.say(&DE), "alle: eins, zwei; „{0} is no place“");
        assert_eq!(Phrase::new("{x} {9}", "").say(&EN), "{x} {9}");
    }

    #[test]
    fn a_phrase_comes_back_from_json() {
        let phrase = Phrase::new("{0} {1}", "{1} {0}")
            .with(PhraseValue::significant(Quantity::Impulse, 2345.0))
            .with(PhraseValue::Chance { share: 0.3, error: None });
        let written = serde_json::to_string(&phrase).unwrap();
        assert_eq!(serde_json::from_str::<Phrase>(&written).unwrap(), phrase);
        assert!(phrase.is_finite());
        assert!(!Phrase::of(PhraseValue::Share(f64::NAN)).is_finite());
    }
}
