//! Physical constants, quantities and their units, medians with their intervals, and how numbers are
//! written. All numbers inside the program are in SI units and radians; other units occur only where a
//! file is read or a number is shown.

mod estimate;
mod format;
mod phrase;
mod phrase_value;
mod quantity;
mod typed;

pub use estimate::{Estimate, Interval};
pub use format::{
    EstimateText, IntervalText, Language, NumberFormat, is_converted, percent, significant,
    trimmed, two_digits,
};
pub use phrase::Phrase;
pub use phrase_value::{PhraseNumber, PhraseValue, named_unit, three_digits};
pub use quantity::{
    FOOT_M, INCH_M, KILOMETRE_PER_HOUR_M_S, KNOT_M_S, MILE_PER_HOUR_M_S, POUND_FORCE_N, Quantity,
    STANDARD_GRAVITY_M_S2, US_SURVEY_FOOT, Unit, UnitSystem,
};
pub use typed::TypedError;
