//! Numbers and texts as a report writes them.

use crate::report::language::{Words, phrase_of, words_of};
use crate::report::{Language, ReportSettings};
use impactlab_core::units::{Quantity, ShownInterval, UnitSystem, percent, significant};

/// Writes numbers and texts in the language and the units of a report. The digits are those of
/// [`units`](impactlab_core::units).
#[derive(Clone, Copy)]
pub(super) struct Wording {
    /// Language.
    pub language: Language,
    /// Units.
    pub units: UnitSystem,
    /// The texts of the report itself.
    pub words: &'static Words,
}

/// A median and the interval around it.
pub(super) struct IntervalText {
    /// `31 m`.
    pub median: String,
    /// `27 m`.
    pub low: String,
    /// `57 m`.
    pub high: String,
    /// `27 to 57 m`.
    pub range: String,
}

impl Wording {
    /// Texts and numbers by the settings of a report.
    pub fn new(settings: &ReportSettings) -> Self {
        let language = settings.language;
        Self { language, units: settings.units, words: words_of(language) }
    }

    /// The decimal sign of the language in a text of numbers.
    pub fn local(&self, text: &str) -> String {
        if self.language == Language::En {
            return text.to_owned();
        }
        let chars: Vec<char> = text.chars().collect();
        let is_digit = |idx: Option<usize>| {
            idx.and_then(|idx| chars.get(idx)).is_some_and(char::is_ascii_digit)
        };
        let is_decimal = |idx: usize| is_digit(idx.checked_sub(1)) && is_digit(Some(idx + 1));
        let each = chars.iter().enumerate();
        each.map(|(idx, c)| if *c == '.' && is_decimal(idx) { ',' } else { *c }).collect()
    }

    /// A number with its unit.
    pub fn with_unit(&self, number: &str, symbol: &str) -> String {
        let number = self.local(number);
        match (symbol, self.language) {
            ("", _) => number,
            ("deg", Language::De) => format!("{number}°"),
            (symbol, _) => format!("{number} {}", self.symbol(symbol)),
        }
    }

    /// The symbol of a unit.
    pub fn symbol(&self, symbol: &str) -> String {
        match self.language {
            Language::En => symbol.to_owned(),
            Language::De => symbol.replace("deg", "°"),
        }
    }

    /// A number in SI units as the window shows it.
    pub fn value(&self, quantity: Quantity, value_si: f64) -> String {
        let unit = quantity.display_unit(self.units);
        self.with_unit(&significant(unit.from_si(value_si)), unit.symbol)
    }

    /// A pure number.
    pub fn number(&self, value: f64) -> String {
        self.local(&significant(value))
    }

    /// A number that was given, with all its digits up to the eighth and no more than it has.
    pub fn given_number(&self, value: f64) -> String {
        self.local(&in_full(value))
    }

    /// The same with its unit.
    pub fn given(&self, quantity: Quantity, value_si: f64) -> String {
        let unit = quantity.display_unit(self.units);
        self.with_unit(&in_full(unit.from_si(value_si)), unit.symbol)
    }

    /// A number of a rule or an assumption, rounded as on the screen, without zeros at its end.
    pub fn rounded(&self, quantity: Quantity, value_si: f64) -> String {
        let unit = quantity.display_unit(self.units);
        self.with_unit(&trimmed(significant(unit.from_si(value_si))), unit.symbol)
    }

    /// A number with a fixed number of decimals.
    pub fn fixed(&self, value: f64, decimals: usize) -> String {
        self.local(&format!("{:.decimals$}", value + 0.0))
    }

    /// A share of one.
    pub fn percent(&self, share: f64) -> String {
        self.local(&percent(share))
    }

    /// Size and components of a vector.
    pub fn vector(&self, quantity: Quantity, [x, y]: [f64; 2], names: [&str; 2]) -> String {
        let [size, px, py] = [x.hypot(y), x, y].map(|of| self.value(quantity, of));
        let [first, second] = names;
        format!("{size} ({first} {px}, {second} {py})")
    }

    /// A median and its interval; the interval decides the digits.
    pub fn interval(&self, quantity: Quantity, median_si: f64, ends_si: [f64; 2]) -> IntervalText {
        let ShownInterval { median, ends, symbol } =
            quantity.interval_parts(median_si, ends_si, self.units);
        self.interval_of(&median, &ends, symbol)
    }

    /// The same of numbers that are text already.
    pub fn interval_of(&self, median: &str, ends: &[String; 2], symbol: &str) -> IntervalText {
        let [low, high] = [&ends[0], &ends[1]].map(|end| self.with_unit(end, symbol));
        let first = match (symbol, self.language) {
            ("deg", Language::De) => low.clone(),
            _ => self.local(&ends[0]),
        };
        IntervalText {
            median: self.with_unit(median, symbol),
            range: format!("{first} {} {high}", self.words.to),
            low,
            high,
        }
    }

    /// A text that the program has in English only: marked as such in a report in another language.
    pub fn quoted(&self, text: &str) -> String {
        match (self.language, text.is_empty()) {
            (Language::En, _) | (_, true) => text.to_owned(),
            (Language::De, false) => format!("„{text}“ (engl.)"),
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

/// Digits of a number that was given, at most: more would be those of the conversion of its unit.
const GIVEN_DIGITS: i32 = 8;

/// A number with the digits that it was given with.
fn in_full(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return trimmed(significant(value));
    }
    let size = value.abs().log10().floor() as i32;
    let decimals = (GIVEN_DIGITS - 1 - size).clamp(0, 12) as usize;
    trimmed(format!("{value:.decimals$}"))
}

/// A number without zeros at the end of its decimals.
pub(super) fn trimmed(number: String) -> String {
    match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => number,
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
    use crate::report::{Paper, ReportDate};

    fn wording(language: Language, units: UnitSystem) -> Wording {
        let date = ReportDate::new(2026, 1, 2).unwrap();
        Wording::new(&ReportSettings { language, units, paper: Paper::A4, date })
    }

    #[test]
    fn numbers_are_those_of_the_window_with_the_decimal_sign_of_the_language() {
        let en = wording(Language::En, UnitSystem::Si);
        let de = wording(Language::De, UnitSystem::Us);
        assert_eq!(
            en.value(Quantity::Force, 12_345.0),
            Quantity::Force.shown(12_345.0, UnitSystem::Si)
        );
        assert_eq!(de.value(Quantity::Speed, 44.704), "100,0 mph");
        assert_eq!(de.value(Quantity::Angle, 0.5), "28,65°");
        assert_eq!(de.local("2.5 kN. v1.x 3.0"), "2,5 kN. v1.x 3,0");
        let interval = en.interval(Quantity::Length, 30.741, [26.52, 57.24]);
        assert_eq!((&*interval.median, &*interval.range), ("31 m", "27 to 57 m"));
        let shown = Quantity::Length.shown_interval(30.741, [26.52, 57.24], UnitSystem::Si);
        assert_eq!(shown, "31 (27 to 57) m");
    }

    #[test]
    fn what_was_given_keeps_its_digits() {
        let en = wording(Language::En, UnitSystem::Si);
        assert_eq!(en.given(Quantity::Mass, 1999.4567), "1999.4567 kg");
        assert_eq!(en.given(Quantity::Length, -1.234567), "-1.234567 m");
        assert_eq!(en.given(Quantity::Speed, 15.0), "54 km/h");
        assert_eq!(en.given_number(0.1 + 0.2), "0.3");
        assert_eq!(en.given_number(0.0), "0");
        assert_eq!(en.rounded(Quantity::Mass, 1999.4567), "1999 kg");
    }

    #[test]
    fn a_value_with_braces_is_not_filled_in() {
        assert_eq!(fill("{a} of {b}, {c", &[("a", "{b}"), ("b", "2")]), "{b} of 2, c");
    }
}
