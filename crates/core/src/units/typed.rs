//! Numbers as people type them: `20`, `72km/h`, `1,5 t`, `30°`.

use crate::units::{Quantity, Unit};

/// A text that is no number of a quantity.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TypedError {
    /// No number at the beginning.
    #[error("expected a number, in {unit} or with one of the units {units}")]
    NoNumber {
        /// The unit of a number without one.
        unit: &'static str,
        /// Those that may be typed.
        units: String,
    },
    /// No number, of a quantity without units.
    #[error("expected a number")]
    NoRatio,
    /// A comma that may be a decimal comma or one between thousands.
    #[error("{number} may be {} or {}: write it without the comma", .number.replace(',', ""), .number.replace(',', "."))]
    Comma {
        /// What was typed.
        number: String,
    },
    /// A unit of something else.
    #[error("{unit:?} is not one of the units {units}")]
    Unit {
        /// What was typed.
        unit: String,
        /// Those that may be typed.
        units: String,
    },
}

/// What else a unit is called.
const OTHER_NAMES: &[(&str, &str)] = &[
    ("°", "deg"),
    ("°/s", "deg/s"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("kph", "km/h"),
    ("kmh", "km/h"),
    ("mps", "m/s"),
    ("m/sec", "m/s"),
    ("mi/h", "mph"),
    ("fps", "ft/s"),
    ("ips", "in/s"),
    ("kt", "kn"),
    ("kts", "kn"),
    ("knot", "kn"),
    ("knots", "kn"),
    ("'", "ft"),
    ("feet", "ft"),
    ("foot", "ft"),
    ("\"", "in"),
    ("inch", "in"),
    ("inches", "in"),
    ("yard", "yd"),
    ("yards", "yd"),
    ("mile", "mi"),
    ("miles", "mi"),
    ("lbs", "lb"),
    ("pound", "lb"),
    ("pounds", "lb"),
    ("slugs", "slug"),
    ("tonne", "t"),
    ("tonnes", "t"),
    ("sec", "s"),
    ("us", "µs"),
    ("hr", "h"),
    ("hour", "h"),
    ("hours", "h"),
    ("nm", "n m"),
    ("ftlb", "ft lbf"),
    ("lbft", "lbf ft"),
    ("lbfts2", "slug ft²"),
    ("ftlbs2", "slug ft²"),
    ("lbffts2", "slug ft²"),
    ("lbins2", "lbf in s²"),
    ("kp", "kgf"),
    ("kips", "kip"),
    ("psi", "lbf/in²"),
    ("lb/in", "lbf/in"),
    ("lb/in2", "lbf/in²"),
    ("percent", "%"),
];

impl Quantity {
    /// A number as a person types it, in SI units.
    ///
    /// It may have any unit of the quantity, a decimal comma and groups of thousands. A comma that may be
    /// either, as in 1,860, is an error.
    ///
    /// - `without_unit`: the unit of a number that has none.
    ///
    /// # Errors
    /// [`TypedError`] says what is expected.
    pub fn parse(self, text: &str, without_unit: &Unit) -> Result<f64, TypedError> {
        let text = text.trim().replace('\u{2212}', "-");
        let (number, unit) = text.split_at(end_of_number(&text));
        let value = match plain_number(number.trim_end()) {
            Some(plain) => plain?.parse::<f64>().ok(),
            None => None,
        };
        let value = value.ok_or_else(|| self.no_number(without_unit))?;
        let unit = unit.trim();
        if unit.is_empty() {
            return Ok(without_unit.to_si(value));
        }
        let found = self.units().iter().find(|known| is_called(known.symbol, unit));
        let unknown = || TypedError::Unit { unit: unit.to_owned(), units: self.symbols() };
        found.map(|known| known.to_si(value)).ok_or_else(unknown)
    }

    fn no_number(self, unit: &Unit) -> TypedError {
        match self {
            Self::Ratio => TypedError::NoRatio,
            _ => TypedError::NoNumber { unit: unit.symbol, units: self.symbols() },
        }
    }

    /// The units that may be typed.
    fn symbols(self) -> String {
        let symbols = self.units().iter().map(|unit| unit.symbol);
        symbols.filter(|symbol| !symbol.is_empty()).collect::<Vec<_>>().join(", ")
    }
}

/// Where the number at the beginning of a text ends.
fn end_of_number(text: &str) -> usize {
    let next = |at: usize| text[at..].chars().nth(1);
    let is_sign_or_digit = |c: char| c.is_ascii_digit() || "+-".contains(c);
    let is_part = |at: usize, c: char| match c {
        // `1e3`: an e counts only between digits and digits or a sign.
        'e' | 'E' => at > 0 && next(at).is_some_and(is_sign_or_digit),
        // `1 860`: a space or an apostrophe counts only between digits.
        ' ' | '\u{a0}' | '\u{202f}' | '\'' => {
            at > 0 && next(at).is_some_and(|c| c.is_ascii_digit())
        }
        c => is_sign_or_digit(c) || c == '.' || c == ',',
    };
    text.char_indices().find(|&(at, c)| !is_part(at, c)).map_or(text.len(), |(at, _)| at)
}

/// A number with a decimal point and without groups; `None` if it is none.
fn plain_number(typed: &str) -> Option<Result<String, TypedError>> {
    let (digits, exponent) = match typed.find(['e', 'E']) {
        Some(at) => typed.split_at(at),
        None => (typed, ""),
    };
    let unsigned = digits.trim_start_matches(['+', '-']);
    let sign = &digits[..digits.len() - unsigned.len()];
    let separators: Vec<char> = unsigned.chars().filter(|c| !c.is_ascii_digit()).collect();
    let last = separators.last().copied();
    let n_last = separators.iter().filter(|c| Some(**c) == last).count();
    // The last separator is the decimal one if there is one of its kind, and it is a point or a comma.
    let decimal = last.filter(|c| n_last == 1 && (*c == '.' || *c == ','));
    let (whole, fraction) = match decimal.and_then(|c| unsigned.rsplit_once(c)) {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (unsigned, None),
    };
    let is_alone = separators.len() == 1;
    if decimal == Some(',') && is_alone && is_group(fraction?) && is_first_group(whole) {
        return Some(Err(TypedError::Comma { number: format!("{sign}{unsigned}") }));
    }
    let whole = without_groups(whole)?;
    let fraction = fraction.map_or_else(String::new, |fraction| format!(".{fraction}"));
    Some(Ok(format!("{sign}{whole}{fraction}{exponent}")))
}

/// Three digits.
fn is_group(text: &str) -> bool {
    text.len() == 3 && text.bytes().all(|c| c.is_ascii_digit())
}

/// One to three digits that do not begin with a zero.
fn is_first_group(text: &str) -> bool {
    (1..=3).contains(&text.len())
        && text.bytes().all(|c| c.is_ascii_digit())
        && !text.starts_with('0')
}

/// Digits without what stands between groups of three; `None` where something else stands there.
fn without_groups(whole: &str) -> Option<String> {
    let Some(separator) = whole.chars().find(|c| !c.is_ascii_digit()) else {
        return Some(whole.to_owned());
    };
    let mut groups = whole.split(separator);
    let is_grouped = ".,' \u{a0}\u{202f}".contains(separator)
        && groups.next().is_some_and(is_first_group)
        && groups.all(is_group);
    is_grouped.then(|| whole.replace(separator, ""))
}

/// Whether a unit is meant by what was typed.
fn is_called(symbol: &str, typed: &str) -> bool {
    let plain = |text: &str| -> String {
        let kept = text.to_lowercase().replace('²', "2");
        kept.chars().filter(|c| !c.is_whitespace() && !"·*^-".contains(*c)).collect()
    };
    // A kilonewton is no knot.
    let is_kilonewton = symbol == "kn" && typed.contains('N') && plain(typed) == symbol;
    let typed = plain(typed);
    let other = OTHER_NAMES.iter().find(|(name, _)| *name == typed).map(|(_, symbol)| *symbol);
    !symbol.is_empty()
        && !is_kilonewton
        && (plain(symbol) == typed || other.is_some_and(|other| plain(symbol) == plain(other)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::UnitSystem;

    fn pounds(text: &str) -> Result<f64, TypedError> {
        Quantity::Mass.parse(text, &Quantity::Mass.display_unit(UnitSystem::Us))
    }

    #[test]
    fn any_unit_of_the_quantity_and_none_are_understood() {
        let is = |quantity: Quantity, text: &str, expected: f64| {
            let value = quantity.parse(text, &quantity.si_unit()).unwrap();
            assert!((value - expected).abs() < 1e-9 * expected.abs().max(1.0), "{text}: {value}");
        };
        for (text, expected) in [
            ("20", 20.0),
            (" 72 KM/H ", 20.0),
            ("72kph", 20.0),
            ("−45mph", -45.0 * 0.447_04),
            ("2.5e-1 m/s", 0.25),
            ("2e1", 20.0),
            ("12,5", 12.5),
            ("36 kn", 18.52),
            ("36 Knots", 18.52),
        ] {
            is(Quantity::Speed, text, expected);
        }
        is(Quantity::Force, "36 kn", 36e3);
        assert!(Quantity::Speed.parse("36 kN", &Quantity::Speed.si_unit()).is_err());
        is(Quantity::Angle, "30°", 30_f64.to_radians());
        is(Quantity::MomentOfInertia, "2 500 kgm2", 2500.0);
        is(
            Quantity::MomentOfInertia,
            "1000 slug·ft²",
            1000.0 * 14.593_902_937_206_37 * 0.3048 * 0.3048,
        );
        is(Quantity::Length, "15'", 15.0 * 0.3048);
        is(Quantity::Length, "6 in", 0.1524);
        is(Quantity::MomentOfInertia, "1000 ft-lb-s²", 1_355.817_948_331);
        is(Quantity::MomentOfInertia, "2400 lb-in-s²", 271.163_589_666_3);
        is(Quantity::Angle, "100 gon", 90_f64.to_radians());
        is(Quantity::Speed, "900 ips", 22.86);
        is(Quantity::Length, "12 yd", 10.9728);
        is(Quantity::ForcePerArea, "1 psi", 6_894.757_293_168);
        is(Quantity::Ratio, "0,55", 0.55);
        is(Quantity::Ratio, "55 %", 0.55);
        assert_eq!(pounds("1860 kg"), Ok(1860.0));
        assert!((pounds("4100").unwrap() - 4100.0 * 0.453_592_37).abs() < 1e-9);
    }

    #[test]
    fn groups_of_thousands_are_understood_and_a_comma_that_may_be_either_is_not() {
        for (text, expected) in [
            ("1,860.5 kg", 1860.5),
            ("1.860,5 kg", 1860.5),
            ("1 860 kg", 1860.0),
            ("1'860 kg", 1860.0),
            ("1,234,567 kg", 1_234_567.0),
            ("0,550 kg", 0.55),
            ("1860,000 kg", 1860.0),
            ("18,60 kg", 18.6),
        ] {
            assert_eq!(pounds(text), Ok(expected), "{text}");
        }
        let ambiguous = pounds("1,860 kg").unwrap_err().to_string();
        assert_eq!(ambiguous, "1,860 may be 1860 or 1.860: write it without the comma");
        for text in [
            "",
            "kg",
            "1,86,0",
            "12 34",
            "1.2.3",
            "--5",
            "five",
            "1,2345,678",
            "5-300",
            "nan",
            "inf",
            "e5",
        ] {
            let error = pounds(text).unwrap_err().to_string();
            assert!(error.starts_with("expected a number, in lb or"), "{text}: {error}");
        }
        let error = pounds("1860 km").unwrap_err().to_string();
        assert_eq!(error, "\"km\" is not one of the units kg, g, t, lb, slug");
    }
}
