//! What an answer cannot promise and what it rests on, in one form for machines and for people.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::Severity;
use crate::uncertainty::{CaveatKind, CaveatSubject};
use crate::units::{Language, NumberFormat, Phrase, PhraseValue, Quantity, UnitSystem, named_unit};

/// Something for which the numbers of an answer are less reliable than they look, or on which they
/// rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Caveat {
    /// What it is about.
    pub kind: CaveatKind,
    /// How much it matters.
    pub severity: Severity,
    /// What of the question it concerns; of an assumption what was assumed.
    pub subject: Option<CaveatSubject>,
    /// A sentence for a person, without a full stop; of an assumption the value with its unit.
    pub text: String,
    /// The quantity concerned with its unit, such as `mass of the striking vehicle [kg]`.
    pub quantity: Option<String>,
    /// Value of the quantity, in that unit.
    pub value: Option<f64>,
    /// Smallest and largest value that raise no caveat; an end that is open is `None`.
    pub range: Option<[Option<f64>; 2]>,
    /// Of an assumption: why this value, and how another one is given.
    pub reason: Option<String>,
    /// The text in every language and in all units, where the program has it so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text_phrase: Option<Phrase>,
    /// The same of the reason.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason_phrase: Option<Phrase>,
}

/// A text of a caveat: in English with SI units, or a [`Phrase`].
#[derive(Debug, Clone, PartialEq)]
pub struct CaveatText {
    text: String,
    phrase: Option<Phrase>,
}

/// The quantity that a caveat is about, in the units of a reader.
#[derive(Debug, Clone, PartialEq)]
pub struct CaveatQuantity<'a> {
    /// What it is called, in English and without its unit.
    pub name: &'a str,
    /// The symbol of its unit in brackets, with a space before them; empty if it has none.
    pub unit: String,
    /// Its value.
    pub value: f64,
    /// Smallest and largest value that raise no caveat.
    pub range: Option<[Option<f64>; 2]>,
}

impl From<&str> for CaveatText {
    fn from(text: &str) -> Self {
        Self { text: text.to_owned(), phrase: None }
    }
}

impl From<&String> for CaveatText {
    fn from(text: &String) -> Self {
        Self::from(text.as_str())
    }
}

impl From<String> for CaveatText {
    fn from(text: String) -> Self {
        Self { text, phrase: None }
    }
}

impl From<Phrase> for CaveatText {
    /// A phrase with a number that is not finite is its English text alone.
    fn from(phrase: Phrase) -> Self {
        let text = phrase.say(&NumberFormat::default());
        Self { text, phrase: Some(phrase).filter(Phrase::is_finite) }
    }
}

impl Caveat {
    /// A caveat that concerns no single quantity.
    pub fn new(kind: CaveatKind, text: impl Into<CaveatText>) -> Self {
        let (severity, CaveatText { text, phrase }) = (kind.severity(), text.into());
        Self {
            kind,
            severity,
            subject: None,
            text,
            quantity: None,
            value: None,
            range: None,
            reason: None,
            text_phrase: phrase,
            reason_phrase: None,
        }
    }

    /// A value that the question leaves open.
    ///
    /// - `value`: with its SI unit;
    /// - `reason`: why this one, and how another one is given.
    pub fn assumed(
        subject: CaveatSubject,
        value: impl Into<CaveatText>,
        reason: impl Into<CaveatText>,
    ) -> Self {
        Self { subject: Some(subject), ..Self::new(CaveatKind::Assumed, value).because(reason) }
    }

    /// Something that the question gives and the answer does not depend on.
    pub fn not_used(what: impl Into<CaveatText>, reason: impl Into<CaveatText>) -> Self {
        Self::new(CaveatKind::NotUsed, what).because(reason)
    }

    fn because(self, reason: impl Into<CaveatText>) -> Self {
        let CaveatText { text, phrase } = reason.into();
        Self { reason: Some(text), reason_phrase: phrase, ..self }
    }

    /// The text as a phrase.
    pub(super) fn phrase(&self) -> Phrase {
        let english = || Phrase::of(PhraseValue::English(self.text.clone()));
        self.text_phrase.clone().unwrap_or_else(english)
    }

    /// The same caveat about the value of a quantity. A value that is not finite is left out.
    ///
    /// - `quantity`: name and unit, such as `mass of the striking vehicle [kg]`.
    #[must_use]
    pub fn with_value(self, quantity: impl Into<String>, value: f64) -> Self {
        let value = value.is_finite().then_some(value);
        Self { quantity: Some(quantity.into()), value, ..self }
    }

    /// The same caveat with the values that would raise none.
    ///
    /// - `range`: smallest and largest of them; an end that is not finite is open.
    #[must_use]
    pub fn with_range(self, range: [f64; 2]) -> Self {
        Self { range: Some(range.map(|end| end.is_finite().then_some(end))), ..self }
    }

    /// Whether the numbers may be wrong.
    pub fn is_warning(&self) -> bool {
        self.severity > Severity::Info
    }

    /// The text in a language and in units; `None` if the program has it in English alone and that is
    /// not the language.
    ///
    /// - `term`: a label of the program in the language.
    pub fn text_in(&self, format: &NumberFormat, term: &dyn Fn(&str) -> String) -> Option<String> {
        text_in((&self.text, self.text_phrase.as_ref()), format, term)
    }

    /// The reason, as [`Self::text_in`] has the text; empty if there is none.
    pub fn reason_in(
        &self,
        format: &NumberFormat,
        term: &dyn Fn(&str) -> String,
    ) -> Option<String> {
        let reason = self.reason.as_deref().unwrap_or_default();
        text_in((reason, self.reason_phrase.as_ref()), format, term)
    }

    /// The same caveat with its texts in English in the units of a reader, as numbers stand beside it.
    #[must_use]
    pub fn in_units(&self, units: UnitSystem) -> Self {
        let format = NumberFormat::english(units);
        let shown = |phrase: &Phrase| phrase.say_shown(&format, &str::to_owned);
        let text = self.text_phrase.as_ref().map_or_else(|| self.text.clone(), shown);
        let reason = self.reason_phrase.as_ref().map(shown).or_else(|| self.reason.clone());
        Self { text, reason, ..self.clone() }
    }

    /// The quantity that it is about, in the units of a reader; `None` if there is none, or no value.
    pub fn quantity_in(&self, format: &NumberFormat) -> Option<CaveatQuantity<'_>> {
        let (quantity, value) = (self.quantity.as_deref()?, self.value?);
        let Some((name, symbol)) = named_unit(quantity) else {
            let (name, unit, range) = (quantity, String::new(), self.range);
            return Some(CaveatQuantity { name, unit, value, range });
        };
        let shown = Quantity::from_si_symbol(symbol);
        let unit = shown.map(|quantity| quantity.display_unit(format.units));
        let in_unit = |si: f64| unit.map_or(si, |unit| unit.from_si(si));
        let range = self.range.map(|range| range.map(|end| end.map(in_unit)));
        let symbol = format.symbol(unit.map_or(symbol, |unit| unit.symbol));
        Some(CaveatQuantity { name, unit: format!(" [{symbol}]"), value: in_unit(value), range })
    }

    /// What stands behind the label of its kind: the sentence, and for an assumption what was assumed
    /// with its value. Many sentences begin with the label, which is left out.
    pub fn statement(&self) -> String {
        self.statement_in(Language::En)
    }

    /// The same of a caveat whose text is in a language.
    pub fn statement_in(&self, language: Language) -> String {
        let begin = format!("{}: ", self.kind.label_in(language));
        match self.subject {
            Some(subject) => format!("{}: {}", subject.label_in(language), self.text),
            None => self.text.strip_prefix(&begin).unwrap_or(&self.text).to_owned(),
        }
    }
}

fn text_in(
    (text, phrase): (&str, Option<&Phrase>),
    format: &NumberFormat,
    term: &dyn Fn(&str) -> String,
) -> Option<String> {
    match phrase {
        Some(phrase) if *format != NumberFormat::default() => Some(phrase.say_with(format, term)),
        _ => (format.language == Language::En || text.is_empty()).then(|| text.to_owned()),
    }
}

impl fmt::Display for Caveat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (label, text) = (self.kind.label(), &self.text);
        match (self.kind, self.subject, &self.reason) {
            (CaveatKind::Note, ..) => f.write_str(text),
            (_, Some(subject), Some(reason)) => {
                write!(f, "{label} {}: {text} ({reason})", subject.label())
            }
            (_, None, Some(reason)) => write!(f, "{label}: {text} ({reason})"),
            _ if self.is_warning() => write!(f, "warning: {label}: {text}"),
            _ => write!(f, "note: {label}: {text}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const US: NumberFormat = NumberFormat { units: UnitSystem::Us, language: Language::En };
    const DE: NumberFormat = NumberFormat { units: UnitSystem::Si, language: Language::De };

    fn moving() -> Caveat {
        let phrase = Phrase::new("not at rest: at {0}", "Das Fahrzeug fährt noch {0}")
            .with(PhraseValue::fixed(Quantity::Speed, 5.0, 1));
        Caveat::new(CaveatKind::NotAtRest, phrase)
            .with_value("speed at the end [m/s]", 5.0)
            .with_range([f64::NEG_INFINITY, 0.05])
    }

    #[test]
    fn a_caveat_is_read_in_the_language_and_the_units_of_a_reader() {
        let (caveat, own) = (moving(), str::to_owned);
        assert_eq!(caveat.text, "not at rest: at 5.0 m/s");
        let german = caveat.text_in(&DE, &own).unwrap();
        assert_eq!(german, "Das Fahrzeug fährt noch 18,0 km/h");
        let us = caveat.in_units(UnitSystem::Us);
        assert_eq!(us.text, "not at rest: at 11.2 mph");
        assert_eq!(us.statement(), "at 11.2 mph");
        assert_eq!(caveat.in_units(UnitSystem::Si).text, "not at rest: at 18.0 km/h");
        let english = Caveat::new(CaveatKind::Note, "sampled at 1 kHz");
        assert_eq!(english.text_in(&DE, &own), None);
        assert_eq!(english.text_in(&US, &own).unwrap(), "sampled at 1 kHz");
        let assumed = Caveat::assumed(CaveatSubject::Speed, Phrase::new("a", "b"), "why");
        assert_eq!(assumed.text_in(&DE, &own).unwrap(), "b");
        assert_eq!(assumed.reason_in(&DE, &own), None);
        assert_eq!(assumed.in_units(UnitSystem::Us).reason.unwrap(), "why");
    }

    #[test]
    fn the_quantity_of_a_caveat_has_the_units_of_a_reader() {
        let caveat = moving();
        let si = caveat.quantity_in(&NumberFormat::default()).unwrap();
        assert_eq!((si.name, &*si.unit, si.value), ("speed at the end", " [km/h]", 18.0));
        let us = caveat.quantity_in(&US).unwrap();
        assert_eq!(us.unit, " [mph]");
        assert!((us.value - 11.185).abs() < 1e-3, "{us:?}");
        assert!(matches!(us.range, Some([None, Some(high)]) if (high - 0.1118).abs() < 1e-3));
        let odd = Caveat::new(CaveatKind::OutsideDomain, "x").with_value("roll [rad/g]", 0.1);
        assert_eq!(odd.quantity_in(&US).unwrap().unit, " [rad/g]");
        assert_eq!(Caveat::new(CaveatKind::Note, "").quantity_in(&US), None);
    }

    #[test]
    fn the_texts_of_earlier_versions_are_read_and_a_phrase_comes_back() {
        let mut written = serde_json::to_value(moving()).unwrap();
        assert_eq!(serde_json::from_value::<Caveat>(written.clone()).unwrap(), moving());
        written.as_object_mut().unwrap().remove("text_phrase");
        let read: Caveat = serde_json::from_value(written).unwrap();
        assert_eq!((read.text, read.text_phrase), (moving().text, None));
        let plain = serde_json::to_value(Caveat::new(CaveatKind::Note, "x")).unwrap();
        assert_eq!((plain.get("text_phrase"), plain.get("reason_phrase")), (None, None));
        let unknown = Phrase::of(PhraseValue::Share(f64::NAN));
        let caveat = Caveat::new(CaveatKind::FewDraws, unknown);
        assert_eq!((&*caveat.text, caveat.text_phrase), ("NaN %", None));
    }
}
