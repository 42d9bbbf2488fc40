//! Columns of a sensor that is slower than the table in which it stands, as a receiver of 10 Hz beside an inertial unit
//! of 100 Hz: most of their cells are blank. Each is read at its own instants and interpolated between them.
//!
//! Nothing is extrapolated: rows before the first or after the last value of such a column are left out. A gap that is
//! longer than a few steps of the sensor is none of its steps, and the column is refused as any other with a blank cell.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::data::error::quoted;
use crate::data::si_values::{compass_quantity, instants_s};
use crate::data::{Channel, ColumnUse, Formula, Note, ReadSettings, Table};
use crate::numerics::{counted_turns_rad, median, quantile_of_sorted};
use crate::units::{Quantity, three_digits};

/// Longest time between two values of a column, in steps that are usual there, and least number of its values.
const LONGEST_STEP: f64 = 2.5;
const LEAST_VALUES: usize = 4;

/// Number of columns that a note names.
const MOST_NAMED: usize = 6;

/// The numbers of a column in the rows that have one.
struct Slow {
    column_idx: usize,
    /// Rows and their numbers.
    own: Vec<(usize, f64)>,
    /// Usual time between two of them, s.
    step_s: f64,
    /// Of a heading, which goes on over whole turns: its unit.
    rad_per_number: Option<f64>,
}

/// The table with every blank cell of slower columns filled, from the first to the last row that all of them reach, and
/// a note that says so; `None` if no column is slower, or if one has blank cells for another reason.
pub(super) fn filled(
    table: &Table,
    columns: &BTreeMap<Channel, ColumnUse>,
    settings: &ReadSettings,
) -> Option<(Table, Note)> {
    let time = columns.get(&Channel::Time)?;
    let (time_s, _) = instants_s(table, time, settings).ok()?;
    let mut found: Vec<Slow> = Vec::new();
    for column in columns.values().filter(|column| column.channel != Channel::Time) {
        for term in &column.terms {
            let column_idx = term.number.checked_sub(1)?;
            let own = own_numbers(table, column_idx)?;
            let is_known = found.iter().any(|slow| slow.column_idx == column_idx);
            if own.len() == table.n_rows() || is_known {
                continue;
            }
            let step_s = usual_step_s(&own, &time_s).filter(|_| is_of_motion(column))?;
            let is_heading = compass_quantity(column.channel) == Some(Quantity::Angle);
            let rad_per_number = match column.formula {
                None => Some(term.unit.si_per_unit),
                Some(Formula::Course) => Some(1_f64.to_radians()),
                Some(_) => None,
            };
            let rad_per_number = rad_per_number.filter(|_| is_heading);
            found.push(Slow { column_idx, own, step_s, rad_per_number });
        }
    }
    let first = found.iter().filter_map(|slow| slow.own.first()).map(|(row, _)| *row).max()?;
    let last = found.iter().filter_map(|slow| slow.own.last()).map(|(row, _)| *row).min()?;
    let rows = first..last + 1;
    if rows.len() < LEAST_VALUES {
        return None;
    }
    let note = note(table, &found, &rows);
    let numbers =
        found.iter().map(|slow| (slow.column_idx, slow.interpolated(&time_s, rows.clone())));
    Some((table.with_numbers(numbers.collect(), rows.clone()), note))
}

/// The numbers of a column in the rows where it has one; `None` if another cell than a blank one has none.
fn own_numbers(table: &Table, column_idx: usize) -> Option<Vec<(usize, f64)>> {
    let mut own = Vec::new();
    for row_idx in 0..table.n_rows() {
        match table.number(row_idx, column_idx) {
            Some(number) => own.push((row_idx, number)),
            None if table.cell(row_idx, column_idx).is_empty() => {}
            None => return None,
        }
    }
    Some(own)
}

/// Whether a column is of what moves steadily. A force does not, and what it sums up to says nothing in a blank cell.
fn is_of_motion(column: &ColumnUse) -> bool {
    matches!(
        column.channel.quantity(),
        Quantity::Length
            | Quantity::Angle
            | Quantity::Speed
            | Quantity::AngularVelocity
            | Quantity::Acceleration
    )
}

/// The usual time between two values of a column, s, if it is slower than the table and has no longer gap, neither
/// between its values nor at both ends of the table.
fn usual_step_s(own: &[(usize, f64)], time_s: &[f64]) -> Option<f64> {
    let at_s = |row: usize| time_s.get(row).copied();
    let mut n_rows = Vec::new();
    let mut steps_s = Vec::new();
    for pair in own.windows(2) {
        n_rows.push((pair[1].0 - pair[0].0) as f64);
        steps_s.push(at_s(pair[1].0)? - at_s(pair[0].0)?);
    }
    let head_s = at_s(own.first()?.0)? - time_s.first()?;
    let tail_s = time_s.last()? - at_s(own.last()?.0)?;
    steps_s.sort_by(f64::total_cmp);
    let usual_s = quantile_of_sorted(&steps_s, 0.5)?;
    let longest_s = steps_s.last()?.max(head_s).max(tail_s);
    let is_slower = median(n_rows)? >= 2.0 && own.len() >= LEAST_VALUES;
    (is_slower && longest_s <= LONGEST_STEP * usual_s).then_some(usual_s)
}

impl Slow {
    /// The numbers in rows of the table, linear over the time between those of the column.
    fn interpolated(&self, time_s: &[f64], rows: Range<usize>) -> Vec<f64> {
        let mut values: Vec<f64> = self.own.iter().map(|(_, number)| *number).collect();
        if let Some(rad) = self.rad_per_number {
            let angles_rad = values.iter().map(|value| value * rad).collect();
            values =
                counted_turns_rad(angles_rad).iter().map(|angle_rad| angle_rad / rad).collect();
        }
        let at_s = |row: usize| time_s.get(row).copied().unwrap_or(f64::NAN);
        let value_at = |row: usize| {
            let above = self.own.partition_point(|(own, _)| *own < row).min(self.own.len() - 1);
            let below = above.saturating_sub(1);
            let [from, to] = [self.own[below].0, self.own[above].0];
            match to == row || to == from {
                true => values[above],
                false => {
                    let share = (at_s(row) - at_s(from)) / (at_s(to) - at_s(from));
                    values[below] + share * (values[above] - values[below])
                }
            }
        };
        rows.map(value_at).collect()
    }
}

/// What is said of the columns and of the rows that are left out.
fn note(table: &Table, found: &[Slow], rows: &Range<usize>) -> Note {
    let name = |slow: &Slow| {
        let name = table.header().get(slow.column_idx).map_or("", String::as_str);
        format!("{} {} (every {} s)", slow.column_idx + 1, quoted(name), three_digits(slow.step_s))
    };
    let mut names: Vec<String> = found.iter().take(MOST_NAMED).map(name).collect();
    if found.len() > MOST_NAMED {
        names.push(format!("{} more", found.len() - MOST_NAMED));
    }
    let n_left_out = table.n_rows() - rows.len();
    let ends = match n_left_out {
        0 => String::new(),
        n => format!("; rows before their first or after their last value are left out: {n}"),
    };
    let text = format!(
        "columns of slower sensors, whose other cells are blank: {}; between their values they are interpolated{ends}",
        names.join(", ")
    );
    Note::Format { text }
}

#[cfg(test)]
mod tests {
    use crate::data::{Channel, Loaded, read_any_series};

    /// A car that drives at 10 m/s and turns, with an inertial unit of 100 Hz and a receiver of 10 Hz whose first value
    /// stands in the third row.
    fn log(is_blank: impl Fn(usize) -> bool) -> Result<Loaded, String> {
        let row = |i: usize| {
            let t = 0.01 * i as f64;
            let receiver = match i % 10 == 2 && !is_blank(i) {
                true => format!("{},{},{}", 10.0 * t, 0.0, (355.0 + 10.0 * t) % 360.0),
                false => ",,".to_owned(),
            };
            format!("{t},{receiver},0.1\n")
        };
        let rows: String = (0..128).map(row).collect();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        std::fs::write(&path, format!("t [s],x [m],y [m],yaw [deg],ax [m/s²]\n{rows}")).unwrap();
        read_any_series(&path, None).map_err(|error| error.to_string())
    }

    #[test]
    fn a_slower_sensor_is_read_at_its_own_instants() {
        let loaded = log(|_| false).unwrap();
        let said: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
        assert!(said.iter().any(|note| note.contains("2 \"x [m]\" (every 0.1")), "{said:?}");
        assert!(said.iter().any(|note| note.contains("are left out: 7")), "{said:?}");
        let time_s = loaded.series.time_s();
        assert_eq!(time_s.len(), 121);
        assert!((time_s[0] - 0.02).abs() < 1e-9 && (time_s[120] - 1.22).abs() < 1e-9);
        let [x, yaw] = [Channel::X, Channel::Yaw].map(|of| loaded.series.get(of).unwrap());
        for (at, t) in time_s.iter().enumerate() {
            assert!((x[at] - 10.0 * t).abs() < 1e-9, "{t}: {}", x[at]);
            let turned = yaw[at] - yaw[0] - (10.0 * (t - 0.02)).to_radians();
            assert!(turned.abs() < 1e-9, "{t}: {turned}");
        }
    }

    #[test]
    fn a_sensor_that_drops_out_and_a_single_blank_cell_are_refused() {
        for is_blank in [|i: usize| (50..90).contains(&i), |i: usize| i < 40, |i: usize| i > 80] {
            let error = log(is_blank).unwrap_err();
            assert!(error.contains("\"x [m]\" is \"\", expected a finite number"), "{error}");
        }
    }
}
