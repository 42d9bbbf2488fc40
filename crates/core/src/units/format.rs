//! How numbers are written: one place for the terminal, the window and reports.

use serde::{Deserialize, Serialize};

use crate::units::{Estimate, Interval, Quantity, Unit, UnitSystem};

/// Language of a text.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Language {
    /// English.
    #[default]
    En,
    /// German.
    De,
}

/// How numbers are written: their units, and the language of decimal signs and symbols.
///
/// The digits of a number follow its uncertainty:
///
/// - with an interval, two digits of the width of that, but whole units where it is below 1000
///   ([`NumberFormat::estimate`]);
/// - of draws without an interval, of a single motion, and of an impact beside which the force network
///   has intervals, two significant digits, but all of a place or a heading before the decimal point,
///   which is no better known near zero than far from it ([`NumberFormat::rough`]);
/// - of anything else, four significant digits ([`NumberFormat::value`]).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct NumberFormat {
    /// Units.
    pub units: UnitSystem,
    /// Language.
    pub language: Language,
}

/// A median and its intervals as text, all with the same decimals.
#[derive(Debug, Clone, PartialEq)]
pub struct EstimateText {
    /// `31 m`.
    pub median: String,
    /// The intervals in their order.
    pub intervals: Vec<IntervalText>,
}

/// The ends of an interval as text.
#[derive(Debug, Clone, PartialEq)]
pub struct IntervalText {
    /// Probability that the interval holds the quantity, 0 to 1.
    pub level: f64,
    /// `27 m`.
    pub low: String,
    /// `57 m`.
    pub high: String,
    /// `27 to 57 m`.
    pub range: String,
}

impl Language {
    /// The tag of the language, BCP 47.
    pub fn tag(self) -> &'static str {
        match self {
            Self::En => "en",
            Self::De => "de",
        }
    }
}

/// Digits of a number that was given, at most: more would be those of the conversion of its unit.
const GIVEN_DIGITS: i32 = 8;

/// Digits that somebody states of a number, at most.
const STATED_DIGITS: usize = 6;

/// Speed and rate of turning below which something stands still, in the unit of display.
const STANDSTILL: f64 = 1e-3;

/// Width of an interval below which it is one of rounding, in the unit of display: no decimal that is shown
/// tells its ends apart.
const LEAST_WIDTH: f64 = 1e-6;

/// Width of an interval up to which whole units are told, in the unit of display: a force in lbf has an interval of
/// tens of thousands, and five digits of it say nothing.
const WHOLE_UNITS_BELOW: f64 = 1000.0;

impl EstimateText {
    /// The interval of a level; `None` if there is none.
    pub fn at(&self, level: f64) -> Option<&IntervalText> {
        self.intervals.iter().find(|interval| interval.level == level)
    }
}

impl NumberFormat {
    /// Numbers in English, in the units of a system.
    pub fn english(units: UnitSystem) -> Self {
        Self { units, language: Language::En }
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
            ("deg" | "°", Language::De) => format!("{number}°"),
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

    /// A number in SI units without an interval: four significant digits and the unit of display, such
    /// as `12.35 kN`.
    pub fn value(&self, quantity: Quantity, value_si: f64) -> String {
        let (value, symbol) = self.displayed(quantity, value_si);
        self.with_unit(&significant(value), symbol)
    }

    /// A number in its unit of display, in which what hardly moves stands still, and the symbol of that.
    fn displayed(&self, quantity: Quantity, value_si: f64) -> (f64, &'static str) {
        let unit = quantity.display_unit(self.units);
        let value = unit.from_si(value_si);
        let is_rate = matches!(quantity, Quantity::Speed | Quantity::AngularVelocity);
        let stands = is_rate && value.abs() < STANDSTILL;
        (if stands { 0.0 } else { value }, unit.symbol)
    }

    /// A pure number with four significant digits.
    pub fn number(&self, value: f64) -> String {
        self.local(&significant(value))
    }

    /// A number that was given, with all its digits up to the eighth and no more than it has.
    pub fn given_number(&self, value: f64) -> String {
        self.local(&in_full(value))
    }

    /// A number that was stated, with its digits; with four where it has more than anybody states.
    pub fn stated_number(&self, value: f64) -> String {
        match is_converted(value) {
            true => self.local(&trimmed(significant(value))),
            false => self.given_number(value),
        }
    }

    /// A number that was given, with its unit: as [`NumberFormat::given_number`] in that of SI, and as
    /// [`NumberFormat::stated_number`] in another one, so that 30 m are 98.43 ft.
    pub fn given(&self, quantity: Quantity, value_si: f64) -> String {
        let unit = quantity.display_unit(self.units);
        let value = unit.from_si(value_si);
        let number = match unit == quantity.si_unit() {
            true => in_full(value),
            false => self.stated_number(value),
        };
        self.with_unit(&number, unit.symbol)
    }

    /// A number of a rule or an assumption, rounded as on the screen, without zeros at its end.
    pub fn rounded(&self, quantity: Quantity, value_si: f64) -> String {
        let unit = quantity.display_unit(self.units);
        self.with_unit(&trimmed(significant(unit.from_si(value_si))), unit.symbol)
    }

    /// A number with a fixed number of decimals.
    pub fn fixed(&self, value: f64, decimals: usize) -> String {
        let text = format!("{value:.decimals$}");
        let is_digit = |character: char| ('1'..='9').contains(&character);
        let is_zero = value.is_finite() && !text.contains(is_digit);
        // What rounds to zero has no sign.
        self.local(if is_zero { text.trim_start_matches('-') } else { &text })
    }

    /// A number of draws that has no interval, such as the median of a forecast, or of a motion of which
    /// nothing was drawn, see [`NumberFormat`].
    pub fn rough(&self, quantity: Quantity, value_si: f64) -> String {
        let (value, symbol) = self.displayed(quantity, value_si);
        self.with_unit(&rough_number(quantity, value), symbol)
    }

    /// The same of a vector, such as `3.0 kN s (x 1.1, y 2.8)`.
    pub fn rough_vector(&self, quantity: Quantity, [x, y]: [f64; 2], names: [&str; 2]) -> String {
        let unit = quantity.display_unit(self.units);
        let [px, py] = [x, y].map(|si| self.local(&rough_number(quantity, unit.from_si(si))));
        let length = self.rough(quantity, x.hypot(y));
        self.with_components(&length, [&px, &py], names)
    }

    /// The same of a place, such as `(44; -5.8) m`.
    pub fn rough_place(&self, place_m: [f64; 2]) -> String {
        let unit = Quantity::Length.display_unit(self.units);
        let [x, y] = place_m.map(|m| rough_number(Quantity::Length, unit.from_si(m)));
        self.with_unit(&format!("({x}; {y})"), unit.symbol)
    }

    /// A share of one.
    pub fn percent(&self, share: f64) -> String {
        self.local(&percent(share))
    }

    /// A probability, such as `12.3 % ± 4.5 %` with its standard error and `> 99.9 %` without one: never
    /// one of 0 or 100 % without an error.
    ///
    /// - `error`: standard error of a share of draws; `None` where nothing was drawn.
    pub fn chance(&self, chance: f64, error: Option<f64>) -> String {
        let text = percent(chance);
        let text = match (error, text.as_str()) {
            (Some(error), _) => format!("{text} ± {}", percent_up(error)),
            (None, "100.0 %") => "> 99.9 %".to_owned(),
            (None, "0.0 %") => "< 0.1 %".to_owned(),
            (None, _) => text,
        };
        self.local(&text)
    }

    /// Size and components of a vector, such as `3.026 kN s (x 1.124, y 2.810)`.
    pub fn vector(&self, quantity: Quantity, [x, y]: [f64; 2], names: [&str; 2]) -> String {
        let unit = quantity.display_unit(self.units);
        let [px, py] = [x, y].map(|si| self.number(unit.from_si(si)));
        let length = self.value(quantity, x.hypot(y));
        self.with_components(&length, [&px, &py], names)
    }

    fn with_components(&self, length: &str, [x, y]: [&str; 2], names: [&str; 2]) -> String {
        let [first, second] = names;
        // A comma is the decimal sign of German.
        let between = if self.language == Language::De { ";" } else { "," };
        format!("{length} ({first} {x}{between} {second} {y})")
    }

    /// A median with its intervals. The interval of 90 %, or the widest if there is none, decides the
    /// digits of all: two of its width, and none that it makes meaningless. Bounds are rounded outwards.
    pub fn estimate(&self, quantity: Quantity, estimate: &Estimate) -> EstimateText {
        self.estimate_in(quantity.display_unit(self.units), estimate)
    }

    /// The same in a unit of its own.
    pub fn estimate_in(&self, unit: Unit, estimate: &Estimate) -> EstimateText {
        let in_unit = estimate.mapped(|si| unit.from_si(si));
        let deciding = in_unit.interval(0.9).or(in_unit.intervals.last().map(Interval::ends));
        let width = deciding.map_or(0.0, |[low, high]| (high - low).abs());
        let interval = |interval: &Interval| {
            let [low, high] = bounds(interval.ends(), width);
            let texts = [&low, &high].map(|end| self.with_unit(end, unit.symbol));
            let first = match (unit.symbol, self.language) {
                ("deg", Language::De) => texts[0].clone(),
                _ => self.local(&low),
            };
            let range = format!("{first} {} {}", self.to(), texts[1]);
            let [low, high] = texts;
            IntervalText { level: interval.level, low, high, range }
        };
        EstimateText {
            median: self.with_unit(&with_width(in_unit.median, width), unit.symbol),
            intervals: in_unit.intervals.iter().map(interval).collect(),
        }
    }

    /// The median with its interval of 90 % in one text, such as `31 (27 to 57) m`; the median alone
    /// where there is no such interval, or one without a width.
    pub fn estimate_in_words(&self, quantity: Quantity, estimate: &Estimate) -> String {
        let unit = quantity.display_unit(self.units);
        let Some(ends) = estimate.interval(0.9) else {
            return self.value(quantity, estimate.median);
        };
        let [low, high] = ends.map(|si| unit.from_si(si));
        let width = (high - low).abs();
        let median = self.local(&with_width(unit.from_si(estimate.median), width));
        if width < LEAST_WIDTH {
            return self.with_unit(&median, unit.symbol);
        }
        let [low, high] = bounds([low, high], width).map(|bound| self.local(&bound));
        if (unit.symbol, self.language) == ("deg", Language::De) {
            return format!("{median}° ({low}° {} {high}°)", self.to());
        }
        let text = format!("{median} ({low} {} {high})", self.to());
        self.with_unit(&text, unit.symbol)
    }

    /// The same of what is computed with draws: where an interval cannot be told, the median is as
    /// [`NumberFormat::rough`] writes it.
    pub fn drawn_in_words(&self, quantity: Quantity, estimate: &Estimate) -> String {
        match estimate.has_interval() {
            true => self.estimate_in_words(quantity, estimate),
            false => self.rough(quantity, estimate.median),
        }
    }

    /// A value with its standard deviation, such as `46.2 ± 3.1 km/h`; that decides the digits.
    pub fn measured(&self, quantity: Quantity, value_si: f64, sigma_si: f64) -> String {
        let unit = quantity.display_unit(self.units);
        let [value, sigma] = [value_si, sigma_si].map(|si| unit.from_si(si));
        let text = format!("{} ± {}", with_width(value, sigma), with_width(sigma, sigma));
        self.with_unit(&text, unit.symbol)
    }

    /// A standard deviation with two digits, such as `0.02`.
    pub fn sigma(&self, quantity: Quantity, sigma_si: f64) -> String {
        let unit = quantity.display_unit(self.units);
        let sigma = unit.from_si(sigma_si);
        self.with_unit(&trimmed(with_width(sigma, sigma)), unit.symbol)
    }

    fn to(&self) -> &'static str {
        match self.language {
            Language::En => "to",
            Language::De => "bis",
        }
    }
}

/// A number in the unit of its quantity as [`NumberFormat::rough`] writes it.
fn rough_number(quantity: Quantity, value: f64) -> String {
    match quantity {
        Quantity::Length | Quantity::Angle if value.abs() >= 100.0 => format!("{value:.0}"),
        // No motion is known to the hundredth of a degree, however little it has turned.
        Quantity::Angle if value.abs() < 1.0 => {
            let tenths = (10.0 * value).round();
            if tenths == 0.0 { "0".to_owned() } else { format!("{:.1}", tenths / 10.0) }
        }
        _ => two_digits(value),
    }
}

/// A number with two digits of a width, so that no digit is shown that the width makes meaningless;
/// with four significant digits if the width is none but rounding.
fn with_width(value: f64, width: f64) -> String {
    rounded_by(value, width, f64::round)
}

/// Both ends of an interval with two digits of a width, rounded outwards: the interval that is shown
/// holds the one that was computed.
fn bounds([low, high]: [f64; 2], width: f64) -> [String; 2] {
    // What conversions of units leave at the last digits moves no bound.
    let near = |steps: f64| (steps - steps.round()).abs() < 1e-6;
    let down = |steps: f64| if near(steps) { steps.round() } else { steps.floor() };
    [rounded_by(low, width, down), rounded_by(high, width, |steps| -down(-steps))]
}

/// A number with two digits of a width, or with four significant ones if that is none but rounding. Whole units
/// stand up to a width of [`WHOLE_UNITS_BELOW`].
///
/// - `round`: to a whole number of steps of the last digit.
fn rounded_by(value: f64, width: f64, round: impl Fn(f64) -> f64) -> String {
    match width {
        width if width < LEAST_WIDTH => significant(value),
        width if !width.is_finite() => value.to_string(),
        width => {
            let wanted = (1 - width.log10().floor() as i32).min(6);
            let is_wide = width >= WHOLE_UNITS_BELOW;
            let digits = if is_wide { wanted } else { wanted.max(0) };
            let (scale, decimals) = (10.0_f64.powi(digits), digits.max(0) as usize);
            // Adding zero turns a negative zero into a positive one.
            format!("{:.decimals$}", round(value * scale) / scale + 0.0)
        }
    }
}

/// A number as text with four significant digits, without an exponent. All digits before the
/// decimal point are shown, and at most six after it.
pub fn significant(value: f64) -> String {
    // Adding zero turns a negative zero into a positive one.
    let value = value + 0.0;
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = (3 - value.abs().log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{value:.decimals$}");
    let is_zero = text.chars().all(|character| !('1'..='9').contains(&character));
    if is_zero { "0".to_owned() } else { text }
}

/// A number as text with two significant digits, without an exponent.
pub fn two_digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return significant(value);
    }
    let scale = 10.0_f64.powi(1 - value.abs().log10().floor() as i32);
    let rounded = (value * scale).round() / scale;
    // 9.96 is 10, which has no decimals.
    let decimals = (1 - rounded.abs().log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{rounded:.decimals$}");
    let is_zero = text.chars().all(|character| !('1'..='9').contains(&character));
    if is_zero { "0".to_owned() } else { text }
}

/// A share of 1 as text in per cent with one decimal, such as `12.3 %`. A value that rounds to zero
/// has no sign.
pub fn percent(share: f64) -> String {
    let tenths = (1000.0 * share).round() + 0.0;
    format!("{:.1} %", tenths / 10.0)
}

/// The same, rounded up to the next tenth.
fn percent_up(share: f64) -> String {
    percent((1000.0 * share).ceil() / 1000.0)
}

/// A number with the digits that it was given with.
fn in_full(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return trimmed(significant(value));
    }
    let size = value.abs().log10().floor() as i32;
    let decimals = (GIVEN_DIGITS - 1 - size).clamp(0, 12) as usize;
    trimmed(format!("{value:.decimals$}"))
}

/// Whether a number has more digits than anybody states: it was computed, or converted from another unit.
pub fn is_converted(value: f64) -> bool {
    let digits = in_full(value);
    let significant = digits.trim_start_matches(|c: char| !('1'..='9').contains(&c));
    significant.chars().filter(char::is_ascii_digit).count() > STATED_DIGITS
}

/// A number without zeros at the end of its decimals.
pub fn trimmed(number: String) -> String {
    match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => number,
    }
}

#[cfg(test)]
#[path = "format_tests.rs"]
mod tests;
