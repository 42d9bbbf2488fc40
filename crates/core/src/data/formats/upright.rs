//! Stands up a table that lies on its side: its times are in a row, and each other row is a quantity.
//!
//! ```text
//! Time (sec),-2.0,-1.0                                  or  Parameter,-2.0 sec,-1.0 sec
//! "Vehicle Speed (MPH [km/h])",40 [64],36 [58]
//! ```

use crate::data::formats::cdr::{Row, column_name, number};
use crate::data::formats::number_text;
use crate::data::spelling::{letters_and_digits, trailing_unit, unit};
use crate::units::{Quantity, Unit};

/// A table whose times are in a row as one with a header and a row for each time, the earliest first, and the index of
/// the row of its times. `None` unless all rows from there on have a quantity and its values, and each time is there
/// once.
pub(super) fn upright(rows: &[Row]) -> Option<(usize, Vec<Row>)> {
    let at = rows.iter().position(|(_, cells)| cells.len() > 2)?;
    let ((_, head), below) = rows.get(at..)?.split_first()?;
    let (name, times) = times_in_row(head)?;
    let of_values = below.iter().map(|(_, cells)| cells.as_slice());
    let quantities: Vec<&[String]> = of_values.filter(|cells| cells.len() > 1).collect();
    let is_quantity = |cells: &[String]| {
        let has_name = cells.first().is_some_and(|name| !name.is_empty() && number(name).is_none());
        has_name && cells.len() <= head.len() && times_in_row(cells).is_none()
    };
    let mut columns: Vec<(f64, usize)> = times.into_iter().zip(1..).collect();
    columns.sort_by(|a, b| a.0.total_cmp(&b.0));
    let is_twice = columns.windows(2).any(|pair| pair[0].0 == pair[1].0);
    if quantities.is_empty() || is_twice || !quantities.iter().all(|cells| is_quantity(cells)) {
        return None;
    }
    let names = quantities.iter().filter_map(|cells| cells.first().cloned());
    let header: Vec<String> = std::iter::once(name).chain(names).collect();
    let row = |(time, idx): (f64, usize)| -> Vec<String> {
        let value = |cells: &&[String]| cells.get(idx).cloned().unwrap_or_default();
        std::iter::once(number_text(time)).chain(quantities.iter().map(value)).collect()
    };
    let rows = std::iter::once(header).chain(columns.into_iter().map(row));
    Some((at, (1..).zip(rows).collect()))
}

/// The name of a time with its unit and the times in a row, which stand behind the name or have their unit each.
fn times_in_row(cells: &[String]) -> Option<(String, Vec<f64>)> {
    let (first, others) = cells.split_first()?;
    let plain: Option<Vec<f64>> = others.iter().map(|cell| number(cell)).collect();
    if let Some(times) = plain {
        let name = column_name(first);
        let has_unit = matches!(trailing_unit(&name, Quantity::Time), Ok(Some(_)));
        let key = letters_and_digits(&name);
        let is_time = has_unit && ["time", "zeit"].iter().any(|word| key.starts_with(word));
        return is_time.then(|| (first.clone(), times));
    }
    let with_unit = |cell: &String| {
        let (time, symbol) = cell.split_at(cell.find(char::is_alphabetic)?);
        Some((number(time)?, unit(Quantity::Time, symbol.trim())?))
    };
    let times: Vec<(f64, Unit)> = others.iter().map(with_unit).collect::<Option<_>>()?;
    let (_, unit) = *times.first()?;
    let is_one = number(first).is_none() && times.iter().all(|(_, of)| *of == unit);
    let times = times.into_iter().map(|(time, _)| time).collect();
    is_one.then(|| (format!("Time ({})", unit.symbol), times))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Vec<Row> {
        let cells = |line: &str| line.split(';').map(str::to_owned).collect();
        (1..).zip(text.lines().map(cells)).collect()
    }

    fn turned(text: &str) -> Option<(usize, Vec<String>)> {
        let (at, rows) = upright(&rows(text))?;
        Some((at, rows.iter().map(|(_, cells)| cells.join(";")).collect()))
    }

    #[test]
    fn times_in_a_row_become_rows_the_earliest_first() {
        let expected = ["Time (sec);Speed (MPH);Brake", "-2;40 [64];Off", "-1;36 [58];"];
        let text = "Time (sec);-1.0;-2.0\nSpeed (MPH);36 [58];40 [64]\nBrake;;Off\n";
        assert_eq!(turned(text), Some((0, expected.map(str::to_owned).to_vec())));
        let expected = ["Time (s);Speed (MPH)", "-2;40", "-1;36"];
        let text = "Lamp;Off\nParameter;-2.0 sec;-1.0 sec\nSpeed (MPH);40;36\nas recorded\n";
        assert_eq!(turned(text), Some((1, expected.map(str::to_owned).to_vec())));
        let expected = ["Zeit vor Kollision (s);Geschwindigkeit (km/h)", "0;36", "1;40"];
        let text = "Zeit vor Kollision (s);1;0\nGeschwindigkeit (km/h);40;36\n";
        assert_eq!(turned(text), Some((0, expected.map(str::to_owned).to_vec())));
    }

    #[test]
    fn what_may_mean_something_else_stays_as_it_is() {
        for text in [
            // A table with a header, and rows without any time or its unit.
            "Time (sec);Speed (MPH);Brake\n-2;40;Off\n",
            "Seconds;-2;-1\nSpeed (MPH);40;36\n",
            "Time;-2;-1\nSpeed (MPH);40;36\n",
            // Times of two tables, a time that is there twice, units that differ, values without a time.
            "Time (sec);-2;-1\nSpeed (MPH);40;36\nTime (sec);-4;-3\nSpeed (MPH);44;42\n",
            "Time (sec);-1;-1\nSpeed (MPH);40;36\n",
            "Parameter;-2 sec;-1000 msec\nSpeed (MPH);40;36\n",
            "Time (sec);-2;-1\nSpeed (MPH);40;36;30\n",
            "Time (sec);-2;-1\n40;36;30\n",
            "Time (sec);-2;-1\n",
        ] {
            assert_eq!(turned(text), None, "{text}");
        }
    }
}
