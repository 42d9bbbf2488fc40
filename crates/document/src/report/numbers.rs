//! Numbers and texts as a report writes them.

use std::ops::Deref;

use crate::report::language::{Words, phrase_of, words_of};
use crate::report::{Language, ReportSettings};
use impactlab_core::units::{NumberFormat, UnitSystem};

/// Writes numbers and texts in the language and the units of a report. Numbers are written by the
/// format of the whole program.
#[derive(Clone, Copy)]
pub(super) struct Wording {
    /// Numbers.
    format: NumberFormat,
    /// The texts of the report itself.
    pub words: &'static Words,
}

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

    /// The same of parts that are joined by commas.
    pub fn phrase(&self, text: &str) -> String {
        let parts: Option<Vec<String>> =
            text.split(", ").map(|part| phrase_of(self.language, part)).collect();
        parts.map_or_else(|| self.quoted(text), |parts| self.local(&parts.join(", ")))
    }
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

    #[test]
    fn a_value_with_braces_is_not_filled_in() {
        assert_eq!(fill("{a} of {b}, {c", &[("a", "{b}"), ("b", "2")]), "{b} of 2, c");
    }
}
