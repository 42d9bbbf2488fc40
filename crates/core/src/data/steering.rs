//! Steer angles whose header does not say whether they are those of the road wheels or of the steering wheel, which turns
//! 12 to 20 times as far.

use std::collections::BTreeMap;

use crate::data::error::quoted;
use crate::data::refused::Refused;
use crate::data::spelling::letters_and_digits;
use crate::data::{Channel, ColumnMap, ColumnUse, DataError, Note, TimeSeries};
use crate::ranges::STEERING_WHEEL_ANGLE;
use crate::units::{Quantity, Unit};

/// Beginnings of headers, in letters and digits, by which programs name either of the two.
const OPEN: [&str; 2] = ["steerangle", "lenkwinkel"];

/// Angle of a front wheel from which it steers and is not set so, rad.
const STEERED_RAD: f64 = 0.02;

/// Asks whether an angle that no road wheel reaches is that of the steering wheel; any other error stays as it is.
///
/// - `error`: why the column is refused.
pub(super) fn asked(refused: &Refused<'_>, error: DataError) -> DataError {
    let column = refused.column;
    let is_said = refused.map.is_some_and(|map| map.get(Channel::Steer).is_some());
    let (DataError::ImplausibleValue { line, value, range, .. }, Channel::Steer, [_], false) =
        (&error, column.channel, &column.terms[..], is_said)
    else {
        return error;
    };
    let in_degrees = Quantity::Angle.units().iter().find(|unit| unit.symbol == "deg").copied();
    let unit = if column.unit_is_stated { Some(column.unit) } else { in_degrees };
    let is_angle = |unit: &Unit| refused.is_within(&STEERING_WHEEL_ANGLE, *unit);
    let Some(unit) = unit.filter(is_angle) else { return error };
    let what = format!(
        "column {} {} turns further than road wheels do: line {line} has {}, expected {}; an angle of the steering \
         wheel is read as such, with the steering ratio (--steering-ratio)",
        column.number,
        quoted(&column.name),
        range.shown(*value),
        range.explained()
    );
    refused.asked(what, Channel::SteeringWheel, unit)
}

/// Says of an angle whose header is open, and which road wheels may have, that it was taken as theirs.
pub(super) fn note(
    columns: &BTreeMap<Channel, ColumnUse>,
    map: Option<&ColumnMap>,
    series: &TimeSeries,
) -> Option<Note> {
    let column = columns.get(&Channel::Steer)?;
    let key = letters_and_digits(&column.name);
    let is_open = OPEN.iter().any(|name| key.starts_with(name));
    let is_said = map.is_some_and(|map| map.get(Channel::Steer).is_some());
    if !is_open || is_said || columns.contains_key(&Channel::SteeringWheel) {
        return None;
    }
    let largest_rad = largest_rad(series.get(Channel::Steer)?);
    Some(Note::Doubt {
        text: format!(
            "column {} {} is taken as the angle of the road wheels, which turn by up to {:.1} deg; if it is that of the \
             steering wheel: map steering_wheel={}, with the steering ratio",
            column.number,
            quoted(&column.name),
            largest_rad.to_degrees(),
            column.source()
        ),
    })
}

/// The largest size of an angle.
fn largest_rad(angles: &[f64]) -> f64 {
    angles.iter().fold(0.0, |of: f64, angle| of.max(angle.abs()))
}

/// Says that the front wheels turn against each other, so that their mean, which steers a car, is next to nothing: one of
/// them counts to the other side.
pub(super) fn opposed(columns: &BTreeMap<Channel, ColumnUse>, series: &TimeSeries) -> Option<Note> {
    let (left, right) = series.get(Channel::SteerFl).zip(series.get(Channel::SteerFr))?;
    let is_steered = largest_rad(left).min(largest_rad(right)) > STEERED_RAD;
    let together: f64 = left.iter().zip(right).map(|(left, right)| left * right).sum();
    let column = columns.get(&Channel::SteerFr)?;
    (is_steered && together < 0.0).then(|| Note::Doubt {
        text: format!(
            "the front wheels turn against each other, so that their mean hardly steers: if one of them counts to the \
             other side, map steer_fr=-{}:{}",
            column.number, column.unit.symbol
        ),
    })
}
