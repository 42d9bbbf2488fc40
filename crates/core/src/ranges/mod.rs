//! The values that numbers from outside may have: the one table of ranges.
//!
//! Files, settings, options of the command line, fields of the window and questions are all checked
//! against it, so that each of them refuses the same numbers in the same words. [`TABLE`] lists
//! every range; `impactlab ranges` prints it.
//!
//! A range says what is physically or technically sensible for a number taken alone, from a model
//! at a scale of 1:10 to a heavy truck. What several numbers must satisfy together, such as a sprung
//! mass that is part of the whole mass, is checked where these numbers are known.

mod range;

mod numbers;
mod settings;

mod table;
mod usual;

pub use numbers::*;
pub use range::{OutOfRange, Range};
pub use settings::{FORCE_SETTINGS, RESPONSE_SETTINGS};
pub use table::{RangeGroup, TABLE};
