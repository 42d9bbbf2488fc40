//! The brakes of a trajectory case: the columns `braking`, `braking_start_s` and
//! `braking_torque_n_m` of `cases.csv`.
//!
//! ```text
//! braking           none or blank: the vehicle coasts; driver-brake: all wheels by the pedal;
//!                   any other word: a dragged wheel, the engine
//! braking_start_s   when it begins
//! braking_torque    front 618 rear 309 a wheel    N m at each wheel of an axle
//!                   RL 212                         at one wheel: FL, FR, RL or RR
//!                   RL 1368 locked                 at a wheel that cannot turn
//! ```

use crate::data::{AttributeColumn, Attributes, DataError};
use crate::ranges::CONTROL_TIME;

/// Time over which the torque of a pedal rises, s; the data sets state it in their README.
const PEDAL_RISE_S: f64 = 0.3;
/// Time over which any other torque rises, s.
const CATCH_S: f64 = 0.01;
/// Largest torque at a wheel, N m.
const MAX_TORQUE_N_M: f64 = 1e6;

const START: AttributeColumn = AttributeColumn::optional("braking_start_s", CONTROL_TIME);

const TORQUE: &str = "braking_torque_n_m";

/// What brakes the wheels of a case. Arrays over wheels are front left, front right, rear left, rear
/// right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CaseBraking {
    /// When it begins, s.
    pub start_s: f64,
    /// How long the torque rises, s.
    pub rise_s: f64,
    /// Full torque at each wheel against its rotation, N m.
    pub torque_n_m: [f64; 4],
    /// Which wheels cannot turn.
    pub locked: [bool; 4],
}

impl CaseBraking {
    /// Reads what a row says; `None` for a vehicle that coasts.
    ///
    /// # Errors
    /// [`DataError::Attribute`] if a cell holds something else than the module documentation says.
    pub fn read(attributes: &Attributes) -> Result<Option<Self>, DataError> {
        let kind = match attributes.text("braking").map(str::trim) {
            None | Some("none" | "no") => return Ok(None),
            Some(kind) => kind,
        };
        let refused = |got: &str| {
            let expected = "such as “front 618 rear 309 a wheel”, “RL 212” or “RL 1368 locked”";
            attributes.refused(TORQUE, got.to_owned(), expected.to_owned())
        };
        let start_s = attributes.optional(&START)?.unwrap_or(0.0);
        let text = attributes.text(TORQUE).ok_or_else(|| refused("blank"))?;
        let (torque_n_m, locked) = torques(text).ok_or_else(|| refused(&format!("{text:?}")))?;
        let rise_s = if kind == "driver-brake" { PEDAL_RISE_S } else { CATCH_S };
        Ok(Some(Self { start_s, rise_s, torque_n_m, locked }))
    }
}

/// Torques and locked wheels; `None` if the text is something else.
fn torques(text: &str) -> Option<([f64; 4], [bool; 4])> {
    let (mut torque_n_m, mut locked) = ([0.0; 4], [false; 4]);
    let mut words = text.trim().trim_end_matches("a wheel").split_whitespace().peekable();
    words.peek()?;
    while let Some(word) = words.next() {
        let wheels: &[usize] = match word.to_ascii_lowercase().as_str() {
            "front" => &[0, 1],
            "rear" => &[2, 3],
            "fl" => &[0],
            "fr" => &[1],
            "rl" => &[2],
            "rr" => &[3],
            _ => return None,
        };
        let torque: f64 = words.next()?.parse().ok()?;
        if !(0.0..=MAX_TORQUE_N_M).contains(&torque) {
            return None;
        }
        let is_locked = words.next_if_eq(&"locked").is_some();
        for &wheel in wheels {
            (torque_n_m[wheel], locked[wheel]) = (torque, is_locked);
        }
    }
    Some((torque_n_m, locked))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn torques_are_those_of_the_wheels_that_are_named() {
        let none = [false; 4];
        for (text, expected) in [
            ("front 618 rear 309 a wheel", Some(([618.0, 618.0, 309.0, 309.0], none))),
            ("front 90 a wheel", Some(([90.0, 90.0, 0.0, 0.0], none))),
            ("RL 212", Some(([0.0, 0.0, 212.0, 0.0], none))),
            ("RR 1368 locked", Some(([0.0, 0.0, 0.0, 1368.0], [false, false, false, true]))),
            ("", None),
            ("a wheel", None),
            ("RL", None),
            ("RL -3", None),
            ("RL nan", None),
            ("middle 3", None),
            ("locked", None),
        ] {
            assert_eq!(torques(text), expected, "{text:?}");
        }
    }
}
