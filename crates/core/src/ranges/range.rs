//! The range of one number, and the error for a number outside of it.

use crate::units::{Quantity, Unit};

/// Digits of a limit behind its first one in messages.
const LIMIT_DIGITS: i32 = 3;

/// The values that a number may have, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// What the number is called in messages; for a setting its section and name, as in the file.
    pub name: &'static str,
    /// What the number measures; [`Quantity::Ratio`] for a number in a unit that belongs to no
    /// quantity.
    pub quantity: Quantity,
    /// Symbol of the SI unit.
    unit: &'static str,
    /// Smallest permitted value, SI units.
    pub low: f64,
    /// Largest permitted value, SI units.
    pub high: f64,
    /// Whether the number counts something, so that it has no fraction.
    pub is_whole: bool,
    /// Explanation of the number in a few words.
    pub meaning: &'static str,
}

/// A number that lies outside its range.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{} is {}, expected {}", range.name, range.shown(*value), range.explained())]
pub struct OutOfRange {
    /// The range.
    pub range: Box<Range>,
    /// The number, SI units.
    pub value: f64,
}

impl Range {
    /// The range of a number that measures a quantity.
    ///
    /// - `[low, high]`: smallest and largest permitted value, SI units.
    pub const fn real(
        name: &'static str,
        quantity: Quantity,
        [low, high]: [f64; 2],
        meaning: &'static str,
    ) -> Self {
        let unit = quantity.si_unit().symbol;
        Self { name, quantity, unit, low, high, is_whole: false, meaning }
    }

    /// The range of a number in a unit that belongs to no [`Quantity`], such as `1/rad`.
    ///
    /// - `[low, high]`: smallest and largest permitted value in this unit.
    pub const fn in_unit(
        name: &'static str,
        unit: &'static str,
        [low, high]: [f64; 2],
        meaning: &'static str,
    ) -> Self {
        let quantity = Quantity::Ratio;
        Self { name, quantity, unit, low, high, is_whole: false, meaning }
    }

    /// The range of a number that counts something.
    ///
    /// - `[low, high]`: smallest and largest permitted number.
    pub const fn whole(name: &'static str, [low, high]: [u64; 2], meaning: &'static str) -> Self {
        let (low, high) = (low as f64, high as f64);
        Self { name, quantity: Quantity::Ratio, unit: "", low, high, is_whole: true, meaning }
    }

    /// The part of the range between two limits, where other numbers limit this one.
    ///
    /// - `[low, high]`: the limits, SI units; they do not widen the range.
    #[must_use]
    pub const fn within(self, [low, high]: [f64; 2]) -> Self {
        Self { low: self.low.max(low), high: self.high.min(high), ..self }
    }

    /// The same range with a smaller upper limit, where another number limits this one.
    ///
    /// - `high`: the limit, SI units; it does not raise the upper end of the range.
    #[must_use]
    pub const fn at_most(self, high: f64) -> Self {
        self.within([f64::NEG_INFINITY, high])
    }

    /// Symbol of the SI unit; empty for a pure number.
    pub const fn unit(&self) -> &'static str {
        self.unit
    }

    /// Whether the range holds a value; it holds neither NaN nor an infinite value, and a range of
    /// whole numbers holds no fraction.
    ///
    /// - `value`: the number, SI units.
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value) && (!self.is_whole || value.fract() == 0.0)
    }

    /// The number, where it lies in the range or misses it by no more than the rounding of a limit
    /// that was written in another unit; it is then moved to the limit.
    ///
    /// - `value`: the number, SI units.
    pub fn rounded_into(&self, value: f64) -> Option<f64> {
        let slack = 1e-12 * self.low.abs().max(self.high.abs());
        let is_near = value >= self.low - slack && value <= self.high + slack;
        let value = if is_near { value.clamp(self.low, self.high) } else { value };
        self.contains(value).then_some(value)
    }

    /// Checks a number and returns it unchanged.
    ///
    /// - `value`: the number, SI units.
    ///
    /// # Errors
    /// [`OutOfRange`] with the number and the range.
    pub fn check(&self, value: f64) -> Result<f64, OutOfRange> {
        if self.contains(value) {
            return Ok(value);
        }
        Err(OutOfRange { range: Box::new(*self), value })
    }

    /// Checks a number that counts something.
    ///
    /// # Errors
    /// [`OutOfRange`] with the number and the range.
    pub fn check_count(&self, count: u64) -> Result<(), OutOfRange> {
        self.check(count as f64).map(|_| ())
    }

    /// The limits of the range in words, for messages: `1 to 50000 kg`.
    ///
    /// - `unit`: the unit in which the number was given; it must measure the quantity of the range.
    pub fn expected(&self, unit: &Unit) -> String {
        let low = inward(unit.from_si(self.low), f64::ceil);
        let high = inward(unit.from_si(self.high), f64::floor);
        with_unit(&format!("{} to {}", number(low), number(high)), unit.symbol)
    }

    /// The limits of the range in words, in SI units.
    pub fn expected_si(&self) -> String {
        let [low, high] = [self.low, self.high].map(number);
        with_unit(&format!("{low} to {high}"), self.unit)
    }

    /// The limits of the range in words, in SI units, and what the number means.
    pub fn explained(&self) -> String {
        format!("{} ({})", self.expected_si(), self.meaning)
    }

    /// A value of the number in words, in SI units: `5 rad`.
    pub fn shown(&self, value: f64) -> String {
        with_unit(&number(value), self.unit)
    }
}

fn with_unit(text: &str, unit: &str) -> String {
    if unit.is_empty() { text.to_owned() } else { format!("{text} {unit}") }
}

/// A limit with as many digits as a person reads; one that has more is moved into the range.
fn inward(limit: f64, round: fn(f64) -> f64) -> f64 {
    let size = limit.abs().log10().floor();
    if !size.is_finite() {
        return limit;
    }
    // Powers of ten are exact where they are whole, so that 1e-4 stays 1e-4.
    let (digits, power) = (LIMIT_DIGITS - size as i32, |digits: i32| 10_f64.powi(digits));
    let counted = if digits >= 0 { limit * power(digits) } else { limit / power(-digits) };
    let whole = counted.round();
    let whole = if (counted - whole).abs() < 1e-6 { whole } else { round(counted) };
    if digits >= 0 { whole / power(digits) } else { whole * power(-digits) }
}

/// A number as a person reads it: without the digits that a conversion of units leaves, and with an
/// exponent where it is very large or very small.
fn number(value: f64) -> String {
    let size = value.abs();
    if size >= 1e6 || (size > 0.0 && size < 1e-3) || !value.is_finite() {
        return format!("{value:e}");
    }
    format!("{}", (value * 1e6).round() / 1e6 + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEED: Range = Range::real("speed", Quantity::Speed, [-150.0, 150.0], "of a vehicle");
    const DRAWS: Range = Range::whole("draws", [1, 10_000], "curves");

    #[test]
    fn limits_are_inside_and_everything_else_is_not() {
        for inside in [-150.0, 0.0, 150.0] {
            assert_eq!(SPEED.check(inside), Ok(inside));
        }
        for outside in [-150.001, 150.001, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(SPEED.check(outside).is_err(), "{outside}");
        }
        assert!(DRAWS.contains(2.0) && !DRAWS.contains(2.5));
        assert!(DRAWS.check_count(0).is_err() && DRAWS.check_count(u64::MAX).is_err());
        assert_eq!(DRAWS.at_most(5.0).high, 5.0);
        assert_eq!(DRAWS.at_most(5e9), DRAWS);
    }

    #[test]
    fn a_message_has_value_unit_range_and_meaning() {
        let error = SPEED.check(1e9).unwrap_err().to_string();
        assert_eq!(error, "speed is 1e9 m/s, expected -150 to 150 m/s (of a vehicle)");
        let error = DRAWS.check_count(0).unwrap_err().to_string();
        assert_eq!(error, "draws is 0, expected 1 to 10000 (curves)");
        let km_h = Quantity::Speed.units().iter().find(|unit| unit.symbol == "km/h").unwrap();
        assert_eq!(SPEED.expected(km_h), "-540 to 540 km/h");
        let mph = Quantity::Speed.units().iter().find(|unit| unit.symbol == "mph").unwrap();
        assert_eq!(SPEED.expected(mph), "-335.5 to 335.5 mph", "335.540444 inside of the range");
        for small in [1e-4, 2e-4, 1e-6, 1e-9] {
            let range = Range::real("share", Quantity::Ratio, [small, 1.0], "of all");
            let unit = &Quantity::Ratio.units()[0];
            assert!(range.expected(unit).starts_with(&format!("{small:e} to 1")), "{small}");
        }
    }
}
