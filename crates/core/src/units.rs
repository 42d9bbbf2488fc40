//! Physical constants, quantities and their units. All numbers inside the program are in SI units
//! and radians; other units occur only where a file is read or a number is shown.
//!
//! The conversion factors are exact by definition: [`Nist2008`](crate::bibliography::Nist2008),
//! table B.8.

use serde::{Deserialize, Serialize};

/// Standard gravity, m/s²; exact by definition (3rd CGPM, 1901).
pub const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// One mile per hour, m/s; exact by definition (international yard and pound agreement, 1959).
pub const MILE_PER_HOUR_M_S: f64 = 0.447_04;

const FOOT_M: f64 = 0.3048;
const INCH_M: f64 = 0.0254;
const KILOMETRE_PER_HOUR_M_S: f64 = 1.0 / 3.6;
const POUND_KG: f64 = 0.453_592_37;
const POUND_FORCE_N: f64 = POUND_KG * STANDARD_GRAVITY_M_S2;
const SLUG_KG: f64 = POUND_FORCE_N / FOOT_M;
const DEGREE_RAD: f64 = std::f64::consts::PI / 180.0;
const REVOLUTION_PER_MINUTE_RAD_S: f64 = std::f64::consts::PI / 30.0;

/// The physical quantity that a number measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Quantity {
    /// Time, s.
    Time,
    /// Length or position, m.
    Length,
    /// Linear velocity, m/s.
    Speed,
    /// Linear acceleration, m/s².
    Acceleration,
    /// Plane angle, rad.
    Angle,
    /// Angular velocity, rad/s.
    AngularVelocity,
    /// Mass, kg.
    Mass,
    /// Moment of inertia, kg m².
    MomentOfInertia,
    /// Force, N.
    Force,
    /// Moment of force, N m.
    Moment,
    /// Linear impulse, N s.
    Impulse,
    /// Angular impulse, N m s.
    AngularImpulse,
    /// Energy, J.
    Energy,
    /// A number without a dimension, such as a coefficient or a share.
    Ratio,
}

/// The system of units in which the user reads and enters numbers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum UnitSystem {
    /// The metric units of European reconstruction practice: m, km/h, deg, kN, kg.
    #[default]
    Si,
    /// US customary units: ft, mph, deg, lbf, lb.
    Us,
}

/// The foot of the United States survey, exactly 1200/3937 m: national grids are in it, while everything
/// else is in feet of 0.3048 m. At 17 000 000 ft the two are 10 m apart.
///
/// Source: National Bureau of Standards, Federal Register 24, 5348 (1959).
pub const US_SURVEY_FOOT: Unit =
    Unit { quantity: Quantity::Length, symbol: "us survey ft", si_per_unit: 1200.0 / 3937.0 };

/// A unit of a [`Quantity`].
///
/// ```text
/// value in SI units = value · si_per_unit
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// The quantity that the unit measures.
    pub quantity: Quantity,
    /// The symbol that is printed after a number; empty for a ratio that is not in per cent.
    pub symbol: &'static str,
    /// The size of the unit in SI units or radians.
    pub si_per_unit: f64,
}

impl Unit {
    /// Converts a number in this unit to SI units.
    pub fn to_si(&self, value: f64) -> f64 {
        value * self.si_per_unit
    }

    /// Converts a number in SI units to this unit.
    pub fn from_si(&self, value_si: f64) -> f64 {
        value_si / self.si_per_unit
    }
}

/// A median and the interval around it as they are shown, without their unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShownInterval {
    /// The median.
    pub median: String,
    /// Lower and upper end.
    pub ends: [String; 2],
    /// Symbol of the unit of all three; empty for a ratio.
    pub symbol: &'static str,
}

impl Quantity {
    /// Every quantity.
    pub const ALL: [Self; 14] = [
        Self::Time,
        Self::Length,
        Self::Speed,
        Self::Acceleration,
        Self::Angle,
        Self::AngularVelocity,
        Self::Mass,
        Self::MomentOfInertia,
        Self::Force,
        Self::Moment,
        Self::Impulse,
        Self::AngularImpulse,
        Self::Energy,
        Self::Ratio,
    ];

    /// The SI unit of the quantity, which is used inside the program and in the files that it
    /// writes.
    pub const fn si_unit(self) -> Unit {
        self.units()[0]
    }

    /// The unit in which the quantity is shown to the user.
    pub fn display_unit(self, system: UnitSystem) -> Unit {
        let symbol = match (self, system) {
            (Self::Length, UnitSystem::Us) => "ft",
            (Self::Speed, UnitSystem::Si) => "km/h",
            (Self::Speed, UnitSystem::Us) => "mph",
            (Self::Acceleration, _) => "g",
            (Self::Angle, _) => "deg",
            (Self::AngularVelocity, _) => "deg/s",
            (Self::Mass, UnitSystem::Us) => "lb",
            (Self::MomentOfInertia, UnitSystem::Us) => "slug ft²",
            (Self::Force, UnitSystem::Si) => "kN",
            (Self::Force, UnitSystem::Us) => "lbf",
            (Self::Moment, UnitSystem::Si) => "kN m",
            (Self::Moment, UnitSystem::Us) => "lbf ft",
            (Self::Impulse, UnitSystem::Si) => "kN s",
            (Self::Impulse, UnitSystem::Us) => "lbf s",
            (Self::AngularImpulse, UnitSystem::Si) => "kN m s",
            (Self::AngularImpulse, UnitSystem::Us) => "lbf ft s",
            (Self::Energy, UnitSystem::Si) => "kJ",
            (Self::Energy, UnitSystem::Us) => "ft lbf",
            _ => return self.si_unit(),
        };
        *self.units().iter().find(|unit| unit.symbol == symbol).unwrap_or(&self.units()[0])
    }

    /// A number in SI units as text for the user, with four significant digits and the unit of
    /// display, such as `12.35 kN`.
    pub fn shown(self, value_si: f64, system: UnitSystem) -> String {
        let unit = self.display_unit(system);
        let number = significant(unit.from_si(value_si));
        if unit.symbol.is_empty() { number } else { format!("{number} {}", unit.symbol) }
    }

    /// A median with the interval around it as text for the user, such as `31 (27 to 57) m`. The interval
    /// decides the digits: two of its width, and none that it makes meaningless.
    pub fn shown_interval(self, median_si: f64, ends_si: [f64; 2], system: UnitSystem) -> String {
        let ShownInterval { median, ends: [low, high], symbol } =
            self.interval_parts(median_si, ends_si, system);
        if ends_si[0] == ends_si[1] {
            return format!("{median} {symbol}").trim_end().to_owned();
        }
        format!("{median} ({low} to {high}) {symbol}").trim_end().to_owned()
    }

    /// The numbers of [`Quantity::shown_interval`], to be put into a table or into words.
    pub fn interval_parts(
        self,
        median_si: f64,
        ends_si: [f64; 2],
        system: UnitSystem,
    ) -> ShownInterval {
        let unit = self.display_unit(system);
        let [low, high] = ends_si.map(|end| unit.from_si(end));
        let median = unit.from_si(median_si);
        let width = (high - low).abs();
        // Adding zero turns a negative zero into a positive one.
        let text = |value: f64| match width {
            0.0 => significant(value),
            width if !width.is_finite() => value.to_string(),
            width => {
                let decimals = (1 - width.log10().floor() as i32).clamp(0, 6) as usize;
                let scale = 10.0_f64.powi(decimals as i32);
                format!("{:.decimals$}", (value * scale).round() / scale + 0.0)
            }
        };
        let (median, ends) = (text(median), [text(low), text(high)]);
        ShownInterval { median, ends, symbol: unit.symbol }
    }

    /// The two components of a vector in SI units as text for the user with one unit, such as
    /// `(1.124, 2.810) kN s`.
    pub fn shown_vector(self, [x_si, y_si]: [f64; 2], system: UnitSystem) -> String {
        let unit = self.display_unit(system);
        let [x, y] = [x_si, y_si].map(|value| significant(unit.from_si(value)));
        format!("({x}, {y}) {}", unit.symbol)
    }

    /// Every unit of the quantity that is read from files or shown, the SI unit first.
    pub const fn units(self) -> &'static [Unit] {
        macro_rules! units {
            ($quantity:ident: $($symbol:literal = $si:expr),+ $(,)?) => {
                &[$(Unit { quantity: Quantity::$quantity, symbol: $symbol, si_per_unit: $si }),+]
            };
        }
        match self {
            Self::Time => units!(Time: "s" = 1.0, "ms" = 1e-3, "µs" = 1e-6, "min" = 60.0),
            Self::Length => units!(Length: "m" = 1.0, "mm" = 1e-3, "cm" = 1e-2, "km" = 1e3,
                "ft" = FOOT_M, "in" = INCH_M),
            Self::Speed => units!(Speed: "m/s" = 1.0, "mm/s" = 1e-3, "mm/ms" = 1.0,
                "km/h" = KILOMETRE_PER_HOUR_M_S, "mph" = MILE_PER_HOUR_M_S, "ft/s" = FOOT_M),
            Self::Acceleration => units!(Acceleration: "m/s²" = 1.0, "mm/s²" = 1e-3,
                "g" = STANDARD_GRAVITY_M_S2, "ft/s²" = FOOT_M),
            Self::Angle => units!(Angle: "rad" = 1.0, "deg" = DEGREE_RAD),
            Self::AngularVelocity => units!(AngularVelocity: "rad/s" = 1.0, "deg/s" = DEGREE_RAD,
                "rpm" = REVOLUTION_PER_MINUTE_RAD_S),
            Self::Mass => units!(Mass: "kg" = 1.0, "g" = 1e-3, "t" = 1e3, "lb" = POUND_KG,
                "slug" = SLUG_KG),
            Self::MomentOfInertia => units!(MomentOfInertia: "kg m²" = 1.0,
                "slug ft²" = SLUG_KG * FOOT_M * FOOT_M, "lb ft²" = POUND_KG * FOOT_M * FOOT_M),
            Self::Force => units!(Force: "N" = 1.0, "kN" = 1e3, "MN" = 1e6, "lbf" = POUND_FORCE_N,
                "kip" = 1e3 * POUND_FORCE_N),
            Self::Moment => units!(Moment: "N m" = 1.0, "kN m" = 1e3, "N mm" = 1e-3,
                "lbf ft" = POUND_FORCE_N * FOOT_M),
            Self::Impulse => units!(Impulse: "N s" = 1.0, "kN s" = 1e3, "lbf s" = POUND_FORCE_N),
            Self::AngularImpulse => units!(AngularImpulse: "N m s" = 1.0, "kN m s" = 1e3,
                "lbf ft s" = POUND_FORCE_N * FOOT_M),
            Self::Energy => units!(Energy: "J" = 1.0, "kJ" = 1e3,
                "ft lbf" = POUND_FORCE_N * FOOT_M),
            Self::Ratio => units!(Ratio: "" = 1.0, "%" = 0.01),
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

/// A share of 1 as text in per cent with one decimal, such as `12.3 %`. A value that rounds to zero
/// has no sign.
pub fn percent(share: f64) -> String {
    let tenths = (1000.0 * share).round() + 0.0;
    format!("{:.1} %", tenths / 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_unit_is_si_and_all_round_trip() {
        for quantity in Quantity::ALL {
            assert_eq!(quantity.si_unit().si_per_unit, 1.0, "{quantity:?}");
            for unit in quantity.units() {
                let back = unit.from_si(unit.to_si(12.5));
                assert!((back - 12.5).abs() < 1e-12, "{quantity:?} {}", unit.symbol);
            }
        }
    }

    #[test]
    fn shown_units_are_the_ones_asked_for() {
        let speed = Quantity::Speed.display_unit(UnitSystem::Us);
        assert_eq!(speed.symbol, "mph");
        assert!((speed.from_si(44.704) - 100.0).abs() < 1e-12);
        assert_eq!(Quantity::Impulse.display_unit(UnitSystem::Si).symbol, "kN s");
        for quantity in Quantity::ALL {
            let us = quantity.display_unit(UnitSystem::Us);
            assert!(quantity.units().contains(&us), "{quantity:?}");
        }
    }

    #[test]
    fn numbers_are_shown_with_four_digits() {
        for (value, expected) in [
            (123_456.7, "123457"),
            (12.3456, "12.35"),
            (-0.012_345_6, "-0.01235"),
            (0.0, "0"),
            (-1e-9, "0"),
        ] {
            assert_eq!(significant(value), expected);
        }
        assert_eq!(Quantity::Force.shown(12_345.0, UnitSystem::Si), "12.35 kN");
    }

    #[test]
    fn an_interval_decides_the_digits() {
        let shown = |median, ends| Quantity::Length.shown_interval(median, ends, UnitSystem::Si);
        assert_eq!(shown(30.741, [26.52, 57.24]), "31 (27 to 57) m");
        assert_eq!(shown(-0.004, [-0.31, 0.27]), "0.00 (-0.31 to 0.27) m");
        assert_eq!(shown(52.22, [51.55, 52.86]), "52.2 (51.6 to 52.9) m");
        assert_eq!(shown(2.0, [2.0, 2.0]), "2.000 m");
        assert_eq!(shown(2.0, [1.0, f64::INFINITY]), "2 (1 to inf) m");
    }

    #[test]
    fn a_share_has_one_decimal_and_no_negative_zero() {
        assert_eq!(
            [0.1234, 1.0, -1e-17, -0.0].map(percent),
            ["12.3 %", "100.0 %", "0.0 %", "0.0 %"]
        );
        assert_eq!(percent(-0.05), "-5.0 %");
    }
}
