//! What stands in a phrase: names, labels, and numbers that are written in the units of the reader.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::units::{
    Estimate, Language, NumberFormat, Phrase, Quantity, Unit, percent, significant, trimmed,
};

/// What stands in a [`Phrase`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PhraseValue {
    /// A name or a count, as it is.
    Name(String),
    /// A label of the program, which reports have in their language.
    Term(String),
    /// The name of a quantity with its SI unit, such as `mass [kg]`.
    Heading(String),
    /// A text in English only: in quotation marks in another language.
    English(String),
    /// A number with its unit.
    Number(PhraseNumber),
    /// A share of one, in per cent.
    Share(f64),
    /// A probability.
    Chance {
        /// The probability, 0 to 1.
        share: f64,
        /// Standard error of a share of draws; none where nothing was drawn.
        error: Option<f64>,
    },
    /// A median with its interval of 90 %.
    Estimate {
        /// What it is of.
        #[schemars(with = "String")]
        quantity: Quantity,
        /// Median, SI.
        median: f64,
        /// Ends of the interval, SI.
        ninety: Option<[f64; 2]>,
    },
    /// Phrases one after the other.
    Phrases {
        /// The phrases.
        of: Vec<Phrase>,
        /// What stands between two of them.
        between: String,
    },
}

/// A number of a phrase.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PhraseNumber {
    /// What it measures.
    #[schemars(with = "String")]
    quantity: Quantity,
    /// Value, SI.
    value: f64,
    /// The unit in English with SI units; elsewhere that of display.
    unit: String,
    /// How it is rounded.
    digits: PhraseDigits,
    /// Whether the number stands without its unit.
    is_bare: bool,
}

/// Digits of a number of a phrase.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum PhraseDigits {
    /// Decimals in the unit of the phrase; in another unit as many as are no finer than these.
    Decimals(u8),
    /// Three significant digits without zeros at the end.
    Three,
    /// Four significant digits.
    Four,
    /// Those that it was given with; in another unit four significant digits without zeros at the end.
    Given,
}

impl PhraseValue {
    /// A number with decimals in the SI unit.
    pub fn fixed(quantity: Quantity, value_si: f64, decimals: u8) -> Self {
        Self::number(quantity, value_si, PhraseDigits::Decimals(decimals))
    }

    /// A number with three significant digits and no zeros at their end.
    pub fn three_digits(quantity: Quantity, value_si: f64) -> Self {
        Self::number(quantity, value_si, PhraseDigits::Three)
    }

    /// A number with four significant digits.
    pub fn significant(quantity: Quantity, value_si: f64) -> Self {
        Self::number(quantity, value_si, PhraseDigits::Four)
    }

    /// A number with the digits that it was given with.
    pub fn given(quantity: Quantity, value_si: f64) -> Self {
        Self::number(quantity, value_si, PhraseDigits::Given)
    }

    /// A number with four significant digits beside the name of its quantity, which has the unit: without
    /// one itself.
    ///
    /// - `name`: such as `mass [kg]`.
    pub fn of_named(name: &str, value_si: f64) -> Self {
        let quantity = named_unit(name).and_then(|(_, unit)| Quantity::from_si_symbol(unit));
        Self::significant(quantity.unwrap_or(Quantity::Ratio), value_si).bare()
    }

    /// A phrase within another one.
    pub fn phrase(phrase: Phrase) -> Self {
        Self::Phrases { of: vec![phrase], between: String::new() }
    }

    /// A median with its interval of 90 %.
    pub fn estimate(quantity: Quantity, estimate: &Estimate) -> Self {
        Self::Estimate { quantity, median: estimate.median, ninety: estimate.interval(0.9) }
    }

    /// The same number, in another unit where it is in English with SI units; decimals are of this unit.
    ///
    /// - `symbol`: of a unit of the quantity.
    #[must_use]
    pub fn in_unit(mut self, symbol: &str) -> Self {
        if let Self::Number(number) = &mut self {
            symbol.clone_into(&mut number.unit);
        }
        self
    }

    /// The same number without its unit.
    #[must_use]
    pub fn bare(mut self) -> Self {
        if let Self::Number(number) = &mut self {
            number.is_bare = true;
        }
        self
    }

    fn number(quantity: Quantity, value: f64, digits: PhraseDigits) -> Self {
        let unit = quantity.si_unit().symbol.to_owned();
        Self::Number(PhraseNumber { quantity, value, unit, digits, is_bare: false })
    }

    /// - `is_canonical`: whether numbers have the units of the phrase, and not those of the reader.
    pub(super) fn say(
        &self,
        format: &NumberFormat,
        term: &dyn Fn(&str) -> String,
        is_canonical: bool,
    ) -> String {
        match self {
            Self::Name(name) => name.clone(),
            Self::Term(label) => term(label),
            Self::Heading(name) => heading(name, format, term, is_canonical),
            Self::English(text) => match format.language {
                Language::En => text.clone(),
                Language::De => format!("„{text}“"),
            },
            Self::Number(number) => number.say(format, is_canonical),
            Self::Share(share) => format.local(&percent(*share)),
            Self::Chance { share, error } => format.chance(*share, *error),
            Self::Estimate { quantity, median, ninety } => {
                let estimate = match ninety {
                    Some(ends) => Estimate::new(*median, *ends, *ends),
                    None => Estimate { median: *median, intervals: Vec::new() },
                };
                format.estimate_in_words(*quantity, &estimate)
            }
            Self::Phrases { of, between } => {
                let said = of.iter().map(|it| it.written(format, term, is_canonical));
                said.collect::<Vec<String>>().join(between)
            }
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        match self {
            Self::Name(_) | Self::Term(_) | Self::Heading(_) | Self::English(_) => true,
            Self::Number(number) => number.value.is_finite(),
            Self::Share(share) => share.is_finite(),
            Self::Chance { share, error } => share.is_finite() && error.is_none_or(f64::is_finite),
            Self::Estimate { median, ninety, .. } => {
                median.is_finite() && ninety.iter().flatten().all(|end| end.is_finite())
            }
            Self::Phrases { of, .. } => of.iter().all(Phrase::is_finite),
        }
    }
}

impl PhraseNumber {
    fn say(&self, format: &NumberFormat, is_canonical: bool) -> String {
        let units = self.quantity.units();
        let named = units.iter().find(|unit| unit.symbol == self.unit);
        let of_phrase = named.copied().unwrap_or(self.quantity.si_unit());
        let is_of_phrase = is_canonical || self.quantity == Quantity::Ratio;
        let unit = match is_of_phrase {
            true => of_phrase,
            false => self.quantity.display_unit(format.units),
        };
        let value = unit.from_si(self.value);
        let number = match self.digits {
            PhraseDigits::Decimals(decimals) => {
                let decimals = decimals_in(&unit, &of_phrase, decimals);
                format!("{value:.decimals$}")
            }
            PhraseDigits::Three => three_digits(value),
            PhraseDigits::Four => significant(value),
            PhraseDigits::Given if unit.symbol != of_phrase.symbol => trimmed(significant(value)),
            PhraseDigits::Given if is_of_phrase && unit.si_per_unit == 1.0 => value.to_string(),
            PhraseDigits::Given => NumberFormat::default().given_number(value),
        };
        match self.is_bare {
            true => format.local(&number),
            false => format.with_unit(&number, unit.symbol),
        }
    }
}

/// The decimals with which a number in a unit is no finer than with others in another unit.
fn decimals_in(unit: &Unit, other: &Unit, decimals: u8) -> usize {
    let more = (unit.si_per_unit / other.si_per_unit).log10();
    let decimals = f64::from(decimals) + (more - 1e-9).ceil();
    decimals.clamp(0.0, 6.0) as usize
}

/// The name of a quantity and the symbol of the unit behind it, such as of `mass [kg]`.
pub fn named_unit(name: &str) -> Option<(&str, &str)> {
    name.strip_suffix(']').and_then(|name| name.rsplit_once(" ["))
}

fn heading(
    name: &str,
    format: &NumberFormat,
    term: &dyn Fn(&str) -> String,
    is_canonical: bool,
) -> String {
    let Some((bare, symbol)) = named_unit(name) else { return term(name) };
    let shown = Quantity::from_si_symbol(symbol).filter(|_| !is_canonical);
    let symbol = shown.map_or(symbol, |quantity| quantity.display_unit(format.units).symbol);
    format!("{} [{}]", term(bare), format.symbol(symbol))
}

/// A number with three significant digits, and no zeros at the end of its decimals.
pub fn three_digits(value: f64) -> String {
    let size = value.abs();
    let decimals = if size < 1e-9 { 0 } else { (2 - size.log10().floor() as i32).clamp(0, 6) };
    trimmed(format!("{value:.*}", decimals as usize))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        for (value, expected) in [
            (2451.7, "2452"),
            (0.6049, "0.605"),
            (0.0110, "0.011"),
            (0.0, "0"),
            (-74.25, "-74.2"),
            (5.7, "5.7"),
            (12.34, "12.3"),
        ] {
            assert_eq!(three_digits(value), expected);
        }
    }
}
