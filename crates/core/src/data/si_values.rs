//! The numbers of a channel in SI units and in the axes of this program.

use std::f64::consts::FRAC_PI_2;

use crate::data::degree_text::{LATITUDE_LETTERS, LONGITUDE_LETTERS, places_deg};
use crate::data::time_of_day::times_of_day_s;
use crate::data::{
    Channel, ColumnUse, DataError, Formula, Note, ReadSettings, Table, Term, clock, impulse,
};
use crate::numerics::counted_turns_rad;
use crate::ranges::{
    ACCELERATION_SAMPLE, ANGLE_SAMPLE, ANGULAR_VELOCITY_SAMPLE, BRAKE_TORQUE, FORCE_SAMPLE,
    INSTANT, LENGTH_SAMPLE, MOMENT_SAMPLE, Range, SPEED, STEER_ANGLE, STEERING_WHEEL_ANGLE,
};
use crate::units::Quantity;

/// The instants of a table, s, with a remark if the seconds of the file begin again and were let go on.
pub(super) fn instants_s(
    table: &Table,
    column: &ColumnUse,
    settings: &ReadSettings,
) -> Result<(Vec<f64>, Option<Note>), DataError> {
    let mut time_s = si_values(table, column, &[], settings)?;
    let shift_s = settings.time_shift_s.unwrap_or(0.0);
    let mut in_file_s = time_s.clone();
    in_file_s.iter_mut().for_each(|at_s| *at_s -= shift_s);
    let in_digits = clock::from_digits(&mut in_file_s);
    let note = clock::go_on(&mut in_file_s).or(in_digits);
    if note.is_some() {
        time_s = in_file_s.into_iter().map(|at_s| at_s + shift_s).collect();
    }
    Ok((time_s, note))
}

/// The numbers of a channel in SI units and in the axes of this program.
///
/// - `time_s`: the instants, as far as they have been read.
pub(super) fn si_values(
    table: &Table,
    column: &ColumnUse,
    time_s: &[f64],
    settings: &ReadSettings,
) -> Result<Vec<f64>, DataError> {
    let mut sum: Option<Vec<f64>> = None;
    if let Some(formula) = column.formula {
        sum = Some(computed_values(table, column, formula)?);
    }
    let terms = column.terms.iter().filter(|_| column.formula.is_none());
    for term in terms {
        let values = term_values(table, column, term, time_s)?;
        match &mut sum {
            None => sum = Some(values),
            Some(sum) => sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += value),
        }
    }
    let mut values = sum.unwrap_or_else(|| vec![0.0; table.n_rows()]);
    let shift_s = settings.time_shift_s.filter(|_| column.channel == Channel::Time);
    let is_mirrored = settings.y_to_right && changes_sign_with_y(column.channel);
    // A course is turned by its formula.
    let is_course = column.formula == Some(Formula::Course);
    let compass = compass_quantity(column.channel);
    let compass = compass.filter(|_| settings.compass_headings && !is_course);
    let is_heading = compass_quantity(column.channel) == Some(Quantity::Angle);
    let offset_rad = settings.yaw_offset_rad.filter(|_| is_heading).unwrap_or(0.0);
    let range = samples_range(column.channel);
    for (row_idx, value) in values.iter_mut().enumerate() {
        *value += shift_s.unwrap_or(0.0);
        if is_mirrored {
            *value = 0.0 - *value; // No negative zero.
        }
        match compass {
            Some(Quantity::Angle) => *value = FRAC_PI_2 - *value,
            Some(_) => *value = 0.0 - *value,
            None => {}
        }
        *value += offset_rad;
        if let Some(range) = range.filter(|range| !range.contains(*value)) {
            return Err(DataError::ImplausibleValue {
                path: table.path().to_owned(),
                line: table.line(row_idx),
                column: column.number,
                name: column.name.clone(),
                value: *value,
                range: Box::new(range),
            });
        }
    }
    // Everything that interpolates, compares or draws a heading takes it without jumps.
    Ok(match compass_quantity(column.channel) {
        Some(Quantity::Angle) => counted_turns_rad(values),
        _ => values,
    })
}

/// What kind of heading a channel is, an angle or its rate; `None` if it is none.
pub(super) fn compass_quantity(channel: Channel) -> Option<Quantity> {
    use Channel::{StrikingYaw, StrikingYawRate, StruckYaw, StruckYawRate, Yaw, YawRate};
    let is_heading = matches!(
        channel,
        Yaw | YawRate | StruckYaw | StruckYawRate | StrikingYaw | StrikingYawRate
    );
    is_heading.then(|| channel.quantity())
}

/// Whether a channel has the other sign in axes whose y points to the right and whose z points down
/// (SAE J670). A roll is the same in both.
pub(super) fn changes_sign_with_y(channel: Channel) -> bool {
    use Channel::{
        Ay, Fy, FyBody, Mz, Steer, SteerFl, SteerFr, SteeringWheel, StrikingVy, StrikingYaw,
        StrikingYawRate, StruckVy, StruckYaw, StruckYawRate, Vy, Y, Yaw, YawRate,
    };
    matches!(
        channel,
        Y | Yaw
            | Vy
            | YawRate
            | Ay
            | Fy
            | FyBody
            | Mz
            | Steer
            | SteerFl
            | SteerFr
            | SteeringWheel
            | StruckVy
            | StruckYaw
            | StruckYawRate
            | StrikingVy
            | StrikingYaw
            | StrikingYawRate
    )
}

/// The values that the samples of a channel may have; `None` for a quantity that no channel has.
/// Values that are merely unusual are flagged by [`crate::data::check_file`].
fn samples_range(channel: Channel) -> Option<Range> {
    Some(match (channel, channel.quantity()) {
        (Channel::Steer | Channel::SteerFl | Channel::SteerFr, _) => STEER_ANGLE,
        (Channel::SteeringWheel, _) => STEERING_WHEEL_ANGLE,
        (Channel::BrakeFl | Channel::BrakeFr | Channel::BrakeRl | Channel::BrakeRr, _) => {
            BRAKE_TORQUE
        }
        (_, Quantity::Force) => FORCE_SAMPLE,
        (_, Quantity::Moment) => MOMENT_SAMPLE,
        (_, Quantity::Speed) => SPEED,
        (_, Quantity::Acceleration) => ACCELERATION_SAMPLE,
        (_, Quantity::AngularVelocity) => ANGULAR_VELOCITY_SAMPLE,
        (_, Quantity::Angle) => ANGLE_SAMPLE,
        (_, Quantity::Length) => LENGTH_SAMPLE,
        (_, Quantity::Time) => INSTANT,
        // No channel measures these.
        (
            _,
            Quantity::Mass
            | Quantity::MomentOfInertia
            | Quantity::Impulse
            | Quantity::AngularImpulse
            | Quantity::Energy
            | Quantity::ForcePerLength
            | Quantity::ForcePerArea
            | Quantity::Ratio,
        ) => return None,
    })
}

/// The numbers of a column in SI units.
fn term_values(
    table: &Table,
    column: &ColumnUse,
    term: &Term,
    time_s: &[f64],
) -> Result<Vec<f64>, DataError> {
    let idx = term.number.saturating_sub(1);
    if column.channel == Channel::Time
        && let Some(times) = times_of_day_s(table, idx)
    {
        return times.map_err(|row_idx| {
            table.cell_error(
                row_idx,
                idx,
                "a time of day, and a date that can be read where the day changes",
            )
        });
    }
    let mut values = table.numbers(idx, term.unit.symbol)?;
    values.iter_mut().for_each(|value| *value = term.sign * term.unit.to_si(*value));
    match term.unit.quantity == Quantity::Impulse {
        true => Ok(impulse::rate_n(&values, time_s)),
        false => Ok(values),
    }
}

/// The numbers of a channel that is computed from several columns.
fn computed_values(
    table: &Table,
    column: &ColumnUse,
    formula: Formula,
) -> Result<Vec<f64>, DataError> {
    let numbers = |(at, term): (usize, &Term)| {
        let idx = term.number.saturating_sub(1);
        match (formula, at) {
            (Formula::East | Formula::North, 0) => places_deg(table, idx, LATITUDE_LETTERS),
            (Formula::East | Formula::North, _) => places_deg(table, idx, LONGITUDE_LETTERS),
            _ => table.numbers(idx, ""),
        }
    };
    let terms = column.terms.iter().enumerate().map(numbers);
    let terms: Vec<Vec<f64>> = terms.collect::<Result<_, _>>()?;
    let idx = column.number.saturating_sub(1);
    formula.values(&terms).map_err(|row_idx| table.cell_error(row_idx, idx, formula.expected()))
}
