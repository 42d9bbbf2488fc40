//! Numbers with units as arguments: `20`, `72km/h`, `30deg/s`.

use std::ops::RangeInclusive;

use crate::units::Quantity;
use crate::vehicle::ContactPoint;

/// As in scenario files.
const SPEED_RANGE_M_S: RangeInclusive<f64> = -150.0..=150.0;
/// As in scenario files.
const YAW_RATE_RANGE_RAD_S: RangeInclusive<f64> = -50.0..=50.0;
/// As in vehicle files.
const FRICTION_RANGE: RangeInclusive<f64> = 0.01..=2.0;
/// Half the longest and widest vehicle that vehicle files allow for, and a load above it.
const CONTACT_RANGES_M: [RangeInclusive<f64>; 3] = [-30.0..=30.0, -10.0..=10.0, 0.0..=5.0];

/// An argument that is not the number it should be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(in crate::cli) enum QuantityError {
    /// No number at the beginning.
    #[error("expected a number, in {si} or with one of the units {units}")]
    NoNumber { si: &'static str, units: String },
    /// A unit of something else.
    #[error("{unit:?} is not one of the units {units}")]
    Unit { unit: String, units: String },
    /// Beyond what makes sense.
    #[error("{value} {si} is outside {low} to {high} {si}")]
    Range { value: f64, si: &'static str, low: f64, high: f64 },
    /// Not three numbers.
    #[error("expected three numbers x,y,z in m, such as -1.5,-0.9,0.5")]
    NoPoint,
    /// Not two moments.
    #[error("expected two moments in s, such as 0,4")]
    NoWindow,
    /// Not a size.
    #[error("expected width x height in pixels, such as 1600x1000")]
    NoSize,
}

/// A speed, m/s unless it says otherwise.
pub(in crate::cli) fn speed_m_s(text: &str) -> Result<f64, QuantityError> {
    in_range(quantity(text, Quantity::Speed)?, Quantity::Speed, SPEED_RANGE_M_S)
}

/// A yaw rate, rad/s unless it says otherwise.
pub(in crate::cli) fn yaw_rate_rad_s(text: &str) -> Result<f64, QuantityError> {
    let value = quantity(text, Quantity::AngularVelocity)?;
    in_range(value, Quantity::AngularVelocity, YAW_RATE_RANGE_RAD_S)
}

/// A duration or a moment, s unless it says otherwise.
pub(in crate::cli) fn time_s(text: &str) -> Result<f64, QuantityError> {
    quantity(text, Quantity::Time)
}

/// A window of time, s unless it says otherwise: `0,2`.
pub(in crate::cli) fn window_s(text: &str) -> Result<[f64; 2], QuantityError> {
    let (from, to) = text.split_once(',').ok_or(QuantityError::NoWindow)?;
    Ok([time_s(from)?, time_s(to)?])
}

/// Friction of the road.
pub(in crate::cli) fn friction(text: &str) -> Result<f64, QuantityError> {
    in_range(quantity(text, Quantity::Ratio)?, Quantity::Ratio, FRICTION_RANGE)
}

/// Where a force acts: `x,y,z`, m.
pub(in crate::cli) fn contact_point(text: &str) -> Result<ContactPoint, QuantityError> {
    let numbers: Vec<f64> =
        text.split(',').map(|part| quantity(part, Quantity::Length)).collect::<Result<_, _>>()?;
    let [x_m, y_m, height_m] = numbers[..] else {
        return Err(QuantityError::NoPoint);
    };
    for (value, range) in [x_m, y_m, height_m].into_iter().zip(CONTACT_RANGES_M) {
        in_range(value, Quantity::Length, range)?;
    }
    Ok(ContactPoint { x_m, y_m, height_m })
}

/// Width and height in pixels: `1600x1000`.
pub(in crate::cli) fn size_px(text: &str) -> Result<[u32; 2], QuantityError> {
    let (width, height) = text.split_once(['x', '×']).ok_or(QuantityError::NoSize)?;
    let side = |text: &str| text.trim().parse().or(Err(QuantityError::NoSize));
    Ok([side(width)?, side(height)?])
}

/// A finite number and, if there is one, its unit; SI without.
fn quantity(text: &str, quantity: Quantity) -> Result<f64, QuantityError> {
    let text = text.trim();
    let is_number = |c: char| c.is_ascii_digit() || "+-.".contains(c);
    // `1e3`: an e counts only between digits and digits or a sign.
    let is_exponent = |at: usize| {
        let after = text[at..].chars().nth(1);
        at > 0 && after.is_some_and(|c| c.is_ascii_digit() || "+-".contains(c))
    };
    let end = text
        .char_indices()
        .find(|&(at, c)| !(is_number(c) || "eE".contains(c) && is_exponent(at)))
        .map_or(text.len(), |(at, _)| at);
    let (number, unit) = text.split_at(end);
    let Ok(value) = number.parse::<f64>() else {
        return Err(QuantityError::NoNumber {
            si: quantity.si_unit().symbol,
            units: symbols(quantity),
        });
    };
    let unit = unit.trim();
    if unit.is_empty() {
        return Ok(value);
    }
    let known = quantity.units().iter();
    known
        .filter(|known| !known.symbol.is_empty())
        .find(|known| known.symbol.eq_ignore_ascii_case(unit))
        .map(|known| known.to_si(value))
        .ok_or_else(|| QuantityError::Unit { unit: unit.to_owned(), units: symbols(quantity) })
}

fn in_range(
    value: f64,
    quantity: Quantity,
    range: RangeInclusive<f64>,
) -> Result<f64, QuantityError> {
    if range.contains(&value) {
        return Ok(value);
    }
    Err(QuantityError::Range {
        value,
        si: quantity.si_unit().symbol,
        low: *range.start(),
        high: *range.end(),
    })
}

fn symbols(quantity: Quantity) -> String {
    let symbols = quantity.units().iter().map(|unit| unit.symbol);
    symbols.filter(|symbol| !symbol.is_empty()).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_understood_and_si_is_assumed() {
        for (text, expected) in [
            ("20", 20.0),
            ("72km/h", 20.0),
            ("72 KM/H", 20.0),
            ("-45mph", -45.0 * 0.447_04),
            ("2e1", 20.0),
            ("2.5e-1 m/s", 0.25),
        ] {
            let speed = speed_m_s(text).unwrap();
            assert!((speed - expected).abs() < 1e-12, "{text}: {speed}");
        }
        let rate = yaw_rate_rad_s("30deg/s").unwrap();
        assert!((rate.to_degrees() - 30.0).abs() < 1e-12);
        assert_eq!(time_s("250ms"), Ok(0.25));
    }

    #[test]
    fn mistakes_are_named() {
        for (text, part) in [
            ("fast", "expected a number"),
            ("nan", "expected a number"),
            ("inf", "expected a number"),
            ("", "expected a number"),
            ("20 kn", "\"kn\" is not one of the units m/s"),
            ("1e9", "outside -150 to 150 m/s"),
            ("200m/s", "outside"),
        ] {
            let error = speed_m_s(text).unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
        assert_eq!(contact_point("1,2"), Err(QuantityError::NoPoint));
        assert!(contact_point("-1.5,-0.9,-1").is_err());
        assert_eq!(contact_point("-1.5, -0.9, 0.5").unwrap().height_m, 0.5);
        assert_eq!(size_px("1600x1000"), Ok([1600, 1000]));
        assert_eq!(size_px("1600"), Err(QuantityError::NoSize));
    }
}
