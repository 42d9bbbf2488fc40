//! Physical constants, quantities and their units.
//!
//! The conversion factors are exact by definition: [`Nist2008`](crate::bibliography::Nist2008),
//! table B.8.

use serde::{Deserialize, Serialize};

use crate::units::{NumberFormat, significant};

/// Standard gravity, m/s²; exact by definition (3rd CGPM, 1901).
pub const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// One mile per hour, m/s; exact by definition (international yard and pound agreement, 1959).
pub const MILE_PER_HOUR_M_S: f64 = 0.447_04;

/// One knot, m/s: an international nautical mile of 1852 m per hour.
pub const KNOT_M_S: f64 = 1852.0 / 3600.0;

/// One kilometre per hour, m/s.
pub const KILOMETRE_PER_HOUR_M_S: f64 = 1.0 / 3.6;

/// One foot, m; exact by definition (international yard and pound agreement, 1959).
pub const FOOT_M: f64 = 0.3048;
/// One inch, m.
pub const INCH_M: f64 = 0.0254;
const YARD_M: f64 = 3.0 * FOOT_M;
const MILE_M: f64 = 5280.0 * FOOT_M;
const POUND_KG: f64 = 0.453_592_37;
/// One pound-force, N: the weight of a pound of 0.45359237 kg under standard gravity.
pub const POUND_FORCE_N: f64 = POUND_KG * STANDARD_GRAVITY_M_S2;
const SLUG_KG: f64 = POUND_FORCE_N / FOOT_M;
const DEGREE_RAD: f64 = std::f64::consts::PI / 180.0;
/// The gon, of which a right angle has 100: total stations are in it.
const GON_RAD: f64 = std::f64::consts::PI / 200.0;
const REVOLUTION_PER_MINUTE_RAD_S: f64 = std::f64::consts::PI / 30.0;

/// Units that are so near to others, the metre and the degree, that nobody guesses them from noisy numbers.
const NEVER_GUESSED: [&str; 4] = ["yd", "yd/s", "gon", "gon/s"];

/// The physical quantity that a number measures.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "snake_case")]
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
    /// Force over the width on which it acts, N/m.
    ForcePerLength,
    /// Growth of a force per width with a depth, N/m².
    ForcePerArea,
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

    /// Whether it may be proposed for numbers whose size it would explain; others are read where they are stated.
    pub fn is_guessed(&self) -> bool {
        !NEVER_GUESSED.contains(&self.symbol)
    }
}

impl Quantity {
    /// Every quantity.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

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
            (Self::ForcePerLength, UnitSystem::Si) => "kN/m",
            (Self::ForcePerLength, UnitSystem::Us) => "lbf/in",
            (Self::ForcePerArea, UnitSystem::Si) => "kN/m²",
            (Self::ForcePerArea, UnitSystem::Us) => "lbf/in²",
            _ => return self.si_unit(),
        };
        *self.units().iter().find(|unit| unit.symbol == symbol).unwrap_or(&self.units()[0])
    }

    /// The quantity whose SI unit has a symbol; `None` for another symbol, and for none.
    pub fn from_si_symbol(symbol: &str) -> Option<Self> {
        let is_unit = |quantity: &Self| quantity.si_unit().symbol == symbol && !symbol.is_empty();
        Self::ALL.iter().copied().find(is_unit)
    }

    /// A number in SI units as text for the user, as [`NumberFormat::value`] writes it in English.
    pub fn shown(self, value_si: f64, system: UnitSystem) -> String {
        NumberFormat::english(system).value(self, value_si)
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
            Self::Time => units!(Time: "s" = 1.0, "ms" = 1e-3, "µs" = 1e-6, "ns" = 1e-9,
                "min" = 60.0, "h" = 3600.0),
            Self::Length => units!(Length: "m" = 1.0, "mm" = 1e-3, "cm" = 1e-2, "km" = 1e3,
                "ft" = FOOT_M, "in" = INCH_M, "yd" = YARD_M, "mi" = MILE_M),
            Self::Speed => units!(Speed: "m/s" = 1.0, "mm/s" = 1e-3, "mm/ms" = 1.0,
                "km/h" = KILOMETRE_PER_HOUR_M_S, "mph" = MILE_PER_HOUR_M_S, "ft/s" = FOOT_M,
                "kn" = KNOT_M_S, "cm/s" = 1e-2, "in/s" = INCH_M, "yd/s" = YARD_M),
            Self::Acceleration => units!(Acceleration: "m/s²" = 1.0, "mm/s²" = 1e-3,
                "g" = STANDARD_GRAVITY_M_S2, "ft/s²" = FOOT_M, "cm/s²" = 1e-2, "in/s²" = INCH_M,
                "mg" = 1e-3 * STANDARD_GRAVITY_M_S2),
            Self::Angle => units!(Angle: "rad" = 1.0, "deg" = DEGREE_RAD, "mrad" = 1e-3,
                "gon" = GON_RAD),
            Self::AngularVelocity => units!(AngularVelocity: "rad/s" = 1.0, "deg/s" = DEGREE_RAD,
                "rpm" = REVOLUTION_PER_MINUTE_RAD_S, "mrad/s" = 1e-3, "gon/s" = GON_RAD),
            Self::Mass => units!(Mass: "kg" = 1.0, "g" = 1e-3, "t" = 1e3, "lb" = POUND_KG,
                "slug" = SLUG_KG),
            Self::MomentOfInertia => units!(MomentOfInertia: "kg m²" = 1.0,
                "slug ft²" = SLUG_KG * FOOT_M * FOOT_M, "lb ft²" = POUND_KG * FOOT_M * FOOT_M,
                "lb in²" = POUND_KG * INCH_M * INCH_M, "lbf in s²" = POUND_FORCE_N * INCH_M),
            Self::Force => units!(Force: "N" = 1.0, "kN" = 1e3, "MN" = 1e6, "lbf" = POUND_FORCE_N,
                "kip" = 1e3 * POUND_FORCE_N, "daN" = 10.0, "kgf" = STANDARD_GRAVITY_M_S2,
                "tf" = 1e3 * STANDARD_GRAVITY_M_S2, "US tonf" = 2e3 * POUND_FORCE_N),
            Self::Moment => units!(Moment: "N m" = 1.0, "kN m" = 1e3, "N mm" = 1e-3,
                "lbf ft" = POUND_FORCE_N * FOOT_M, "lbf in" = POUND_FORCE_N * INCH_M,
                "kip ft" = 1e3 * POUND_FORCE_N * FOOT_M, "daN m" = 10.0,
                "kgf m" = STANDARD_GRAVITY_M_S2),
            Self::Impulse => units!(Impulse: "N s" = 1.0, "kN s" = 1e3, "lbf s" = POUND_FORCE_N),
            Self::AngularImpulse => units!(AngularImpulse: "N m s" = 1.0, "kN m s" = 1e3,
                "lbf ft s" = POUND_FORCE_N * FOOT_M),
            Self::Energy => units!(Energy: "J" = 1.0, "kJ" = 1e3,
                "ft lbf" = POUND_FORCE_N * FOOT_M),
            Self::ForcePerLength => units!(ForcePerLength: "N/m" = 1.0, "kN/m" = 1e3, "N/cm" = 1e2,
                "lbf/in" = POUND_FORCE_N / INCH_M, "N/mm" = 1e3, "lbf/ft" = POUND_FORCE_N / FOOT_M),
            Self::ForcePerArea => units!(ForcePerArea: "N/m²" = 1.0, "kN/m²" = 1e3, "N/cm²" = 1e4,
                "lbf/in²" = POUND_FORCE_N / (INCH_M * INCH_M)),
            Self::Ratio => units!(Ratio: "" = 1.0, "%" = 0.01),
        }
    }
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

    /// Factors of table B.8 of NIST SP 811, rounded there to seven digits.
    #[test]
    fn units_of_surveys_and_of_the_us_have_their_sizes() {
        for (quantity, symbol, expected) in [
            (Quantity::Time, "h", 3600.0),
            (Quantity::Length, "yd", 0.9144),
            (Quantity::Length, "mi", 1_609.344),
            (Quantity::Speed, "in/s", 0.0254),
            (Quantity::Angle, "gon", 0.015_707_96),
            (Quantity::MomentOfInertia, "lb in²", 2.926_397e-4),
            (Quantity::MomentOfInertia, "lbf in s²", 0.112_984_8),
            (Quantity::Force, "US tonf", 8_896.443),
            (Quantity::Moment, "kip ft", 1_355.818),
            (Quantity::ForcePerLength, "lbf/ft", 14.593_90),
        ] {
            let unit = quantity.units().iter().find(|unit| unit.symbol == symbol).unwrap();
            let off = unit.si_per_unit / expected - 1.0;
            assert!(off.abs() < 1e-6, "{symbol}: {}", unit.si_per_unit);
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
}
