//! Times that are not one column called time: seconds with a column for their fraction, hours, minutes and seconds in
//! columns of their own, and stamps, whose unit follows from their header or, since 1970, from their size.

use crate::data::columns::{column_use, stated_unit};
use crate::data::error::quoted;
use crate::data::spelling::{self, Meaning, letters_and_digits};
use crate::data::time_of_day::is_time_of_day;
use crate::data::{Channel, ColumnUse, Note, Table, Term, clock};
use crate::units::{Quantity, Unit};

/// Names of stamps and of clocks, in letters and digits.
const STAMPS: [&str; 19] = [
    "timestamp",
    "stamp",
    "timestamputc",
    "unixtime",
    "unixtimestamp",
    "epoch",
    "epochtime",
    "posixtime",
    "utc",
    "utctime",
    "timeutc",
    "datetime",
    "timeofday",
    "gpstime",
    "devicetime",
    "elapsedtime",
    "uhrzeit",
    "zeitstempel",
    "datumuhrzeit",
];

/// Units that stamps name at their end, as in `timestamp_ms`.
const ENDINGS: [&str; 6] = ["ns", "us", "ms", "nsec", "usec", "msec"];

/// Names of the parts of a time of day with the unit, and below which number each of them begins again.
const PARTS: [(&[&str], &str, f64); 3] = [
    (&["hour", "hours", "hh", "h", "hr", "utchour", "stunde", "stunden", "std"], "h", 24.0),
    (&["minute", "minutes", "mm", "m", "min", "utcminute", "minuten"], "min", 60.0),
    (&["second", "seconds", "ss", "s", "sec", "utcsecond", "sekunde", "sekunden"], "s", 61.0),
];

/// Names of their thousandths.
const MILLISECONDS: [&str; 6] =
    ["millisecond", "milliseconds", "millis", "msec", "ms", "millisekunden"];

/// The time of a table that is not one column called time, with what is said of it.
///
/// - `has_time`: whether a column is called time. Only a column for its fraction counts beside it.
pub(super) fn found(table: &Table, has_time: bool) -> Option<(ColumnUse, Option<Note>)> {
    let parts = if has_time { None } else { parts_of_day(table) };
    let plain = parts.or_else(|| clock::two_columns(table)).map(|time| (time, None));
    plain.or_else(|| if has_time { None } else { stamp(table) })
}

/// Whether a column has times of day or dates, which have no unit to be named.
pub(super) fn is_of_day(table: &Table, column: &ColumnUse) -> bool {
    let idx = column.number.checked_sub(1);
    column.channel == Channel::Time && idx.is_some_and(|idx| is_time_of_day(table, idx))
}

/// The time of hours, minutes and seconds in a column each, perhaps with one of milliseconds.
fn parts_of_day(table: &Table) -> Option<ColumnUse> {
    let keys: Vec<String> = table.header().iter().map(|name| bare_key(name)).collect();
    let position = |names: &[&str]| keys.iter().position(|key| names.contains(&key.as_str()));
    let mut terms = Vec::new();
    let mut add = |names: &[&str], symbol: &str, end: f64, is_whole: bool| {
        let idx = position(names)?;
        let is_part =
            |number: f64| (0.0..end).contains(&number) && (!is_whole || number.fract() == 0.0);
        let is_all = (0..table.n_rows()).all(|row| table.number(row, idx).is_some_and(is_part));
        let unit = spelling::unit(Quantity::Time, symbol).filter(|_| is_all)?;
        terms.push(Term { number: idx + 1, sign: 1.0, unit });
        Some(())
    };
    let has_milliseconds = position(&MILLISECONDS).is_some();
    for (names, symbol, end) in PARTS {
        add(names, symbol, end, symbol != "s" || has_milliseconds)?;
    }
    if has_milliseconds {
        add(&MILLISECONDS, "ms", 1000.0, false)?;
    }
    let names = terms.iter().filter_map(|term| table.header().get(term.number.checked_sub(1)?));
    let names: Vec<&str> = names.map(String::as_str).collect();
    let unit = Quantity::Time.si_unit();
    let (number, name) = (terms.first()?.number, names.join(" + "));
    let (unit_is_stated, formula) = (true, None);
    Some(ColumnUse { channel: Channel::Time, number, name, unit, unit_is_stated, terms, formula })
}

/// The time of a stamp: of the day, or a number in a unit that is stated or that follows from its size.
fn stamp(table: &Table) -> Option<(ColumnUse, Option<Note>)> {
    let of_column = |(idx, name): (usize, &String)| {
        let is_time = matches!(spelling::meaning(name), Meaning::WrongUnit(Channel::Time, _));
        let in_key = unit_in_key(&bare_key(name));
        let number = idx + 1;
        let column = |unit| column_use(Channel::Time, number, name.clone(), Some(unit));
        if (is_time || in_key.is_some()) && is_time_of_day(table, idx) {
            return Some((column(Quantity::Time.si_unit()), None));
        }
        // A row of units may call it `unix time`.
        let stated = stated_unit(name, table.unit_text(idx), Quantity::Time).ok().flatten();
        if let Some(unit) = stated.or(in_key?) {
            return Some((column(unit), None));
        }
        let unit = clock::unit_since_1970(table.number(0, idx)?)?;
        let text = format!(
            "column {number} {} names no unit; its numbers count the {} since 1970, to judge by their size",
            quoted(name),
            unit.symbol
        );
        Some((column(unit), Some(Note::Format { text })))
    };
    table.header().iter().enumerate().find_map(of_column)
}

/// Whether a name is that of a stamp, and the unit at its end.
fn unit_in_key(key: &str) -> Option<Option<Unit>> {
    if STAMPS.contains(&key) {
        return Some(None);
    }
    let ending = ENDINGS
        .into_iter()
        .find(|ending| key.strip_suffix(ending).is_some_and(|stem| STAMPS.contains(&stem)))?;
    Some(spelling::unit(Quantity::Time, ending))
}

/// Letters and digits of a header before its unit.
fn bare_key(name: &str) -> String {
    letters_and_digits(name.split(['[', '(']).next().unwrap_or(name))
}

#[cfg(test)]
mod tests {
    use crate::data::{Loaded, read_any_series};

    fn read(header: &str, rows: [&str; 3]) -> Result<Loaded, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let rows: String =
            rows.iter().enumerate().map(|(i, time)| format!("{time},{i},0\n")).collect();
        std::fs::write(&path, format!("{header},x,y\n{rows}")).unwrap();
        read_any_series(&path, None).map_err(|error| error.to_string())
    }

    #[test]
    fn stamps_have_the_unit_that_they_say_or_that_their_size_tells() {
        for (header, rows, step_s, is_told) in [
            ("timestamp", ["1764500000.00", "1764500000.25", "1764500000.50"], 0.25, true),
            ("Timestamp", ["1764500000000", "1764500000250", "1764500000500"], 0.25, true),
            (
                "time_stamp",
                ["1764500000000000", "1764500000250000", "1764500000500000"],
                0.25,
                true,
            ),
            (
                "epoch",
                ["1764500000000000000", "1764500000250000000", "1764500000500000000"],
                0.25,
                true,
            ),
            ("timestamp_ms", ["0", "250", "500"], 0.25, false),
            ("timestamp [µs]", ["0", "250", "500"], 0.000_25, false),
            (
                "timestamp",
                ["2026-11-30T12:00:00.00Z", "2026-11-30T12:00:00.25Z", "2026-11-30T12:00:00.5Z"],
                0.25,
                false,
            ),
            (
                "Device Time",
                ["30-Nov-2026 12:00:00.00", "30-Nov-2026 12:00:00.25", "30-Nov-2026 12:00:00.50"],
                0.25,
                false,
            ),
            ("elapsed_time [ms]", ["0", "250", "500"], 0.25, false),
            ("Time (UTC)", ["11:59:59.75", "12:00:00.00", "12:00:00.25"], 0.25, false),
            ("Uhrzeit", ["23:59:59.75", "00:00:00.00", "00:00:00.25"], 0.25, false),
            ("hour,minute,second", ["23,59,59.75", "0,0,0.00", "0,0,0.25"], 0.25, false),
            ("hh,mm,ss,ms", ["11,59,59,750", "12,0,0,0", "12,0,0,250"], 0.25, false),
        ] {
            let loaded = read(header, rows).unwrap_or_else(|error| panic!("{header}: {error}"));
            let time_s = loaded.series.time_s();
            for pair in time_s.windows(2) {
                assert!((pair[1] - pair[0] - step_s).abs() < 1e-6, "{header}: {time_s:?}");
            }
            let said: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
            let is_said =
                said.iter().any(|note| note.contains("since 1970, to judge by their size"));
            assert_eq!(is_said, is_told, "{header}: {said:?}");
            assert!(!said.iter().any(|note| note.contains("is left out")), "{header}: {said:?}");
        }
    }

    #[test]
    fn a_time_of_day_has_no_unit_that_is_asked_for() {
        let loaded = read("Time", ["12:00:00.0", "12:00:00.5", "12:00:01.0"]).unwrap();
        let said: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
        assert!(!said.iter().any(|note| note.contains("\"Time\" names no unit")), "{said:?}");
        assert!(said.iter().any(|note| note.contains("\"x\" names no unit")), "{said:?}");
    }

    /// Apps that record with telephones write such a row of units.
    #[test]
    fn a_row_of_units_may_say_what_a_stamp_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let text =
            "timestamp,x,y,speed\nunix time,m,m,m/s\n1764500000.0,0,0,20\n1764500000.5,10,0,20\n";
        std::fs::write(&path, text).unwrap();
        let time_s = read_any_series(&path, None).unwrap().series.time_s().to_vec();
        assert!((time_s[1] - time_s[0] - 0.5).abs() < 1e-6, "{time_s:?}");
    }

    /// Numbers of a stamp may be in any unit, and 75 is no minute.
    #[test]
    fn stamps_and_parts_that_say_no_unit_are_refused() {
        for (header, rows) in [
            ("timestamp", ["12000", "12010", "12020"]),
            ("hour,minute,second", ["12,75,0", "12,75,1", "12,75,2"]),
            ("hour,minute,second,ms", ["12,0,0.5,0", "12,0,1.5,0", "12,0,2.5,0"]),
        ] {
            let error = read(header, rows).unwrap_err();
            assert!(error.contains("no column for time"), "{header}: {error}");
        }
    }
}
