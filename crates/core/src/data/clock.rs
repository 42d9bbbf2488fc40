//! The clocks of files: times of day, seconds with a second column for their fraction, and seconds since
//! 1970.

use crate::data::columns::{ColumnUse, Term, open_question};
use crate::data::spelling::{self, letters_and_digits};
use crate::data::{
    Channel, ColumnMap, ColumnRef, ColumnSource, Correction, DataError, FileKind, Note, Table,
    TimeSeries,
};
use crate::numerics::quantile_of_sorted;
use crate::units::Quantity;

const HOUR_S: f64 = 3600.0;
const DAY_S: f64 = 86_400.0;

/// Seconds since 1970 in the years 2001 to 2096, by which such a clock is known.
const UNIX_S: std::ops::Range<f64> = 1e9..4e9;

/// Instant from which a record begins late, and the one from which controls are held too long, s.
const LATE_S: f64 = 10.0;

/// Smallest instant that is not zero, s.
const ZERO_S: f64 = 1e-6;

/// Endings of the names of seconds and of their parts, with the unit.
const ENDINGS: [(&[&str], &str); 4] = [
    (&["nanoseconds", "nanosecs", "nanosec", "nsecs", "nsec", "ns"], "ns"),
    (&["microseconds", "microsecs", "microsec", "usecs", "usec", "us", "µs"], "µs"),
    (&["milliseconds", "millisecs", "millisec", "msecs", "msec", "ms"], "ms"),
    (&["seconds", "secs", "sec", "s", ""], "s"),
];

/// Beginnings of the names of such columns; none if the whole name is an ending.
const STEMS: [&str; 9] =
    ["", "t", "time", "timestamp", "stamp", "headerstamp", "tv", "epoch", "clock"];

/// The time of a table that counts whole seconds in one column and their fraction in another.
pub(super) fn two_columns(table: &Table) -> Option<ColumnUse> {
    let names: Vec<(usize, String, &str)> = table
        .header()
        .iter()
        .enumerate()
        .filter_map(|(idx, name)| {
            let (stem, symbol) = divided(&letters_and_digits(name))?;
            Some((idx, stem, symbol))
        })
        .collect();
    let seconds = names.iter().filter(|(.., symbol)| *symbol == "s");
    let pairs = seconds.flat_map(|whole| {
        names
            .iter()
            .filter(|part| {
                part.2 != "s" && (part.1 == whole.1 || part.1.is_empty() || whole.1.is_empty())
            })
            .map(move |part| (whole, part))
    });
    let (whole, part) = pairs.into_iter().find(|(whole, part)| {
        let Some(unit) = spelling::unit(Quantity::Time, part.2) else { return false };
        let number = |row_idx, idx| table.number(row_idx, idx);
        (0..table.n_rows()).all(|row_idx| {
            let is_whole = number(row_idx, whole.0).is_some_and(|number| number.fract() == 0.0);
            let is_part = |number: f64| (0.0..1.0).contains(&unit.to_si(number));
            is_whole && number(row_idx, part.0).is_some_and(is_part)
        })
    })?;
    // A column of zeros beside whole seconds is a time of its own, or none.
    let terms = [whole, part].map(|(idx, _, symbol)| {
        let unit = spelling::unit(Quantity::Time, symbol);
        let unit = unit.unwrap_or(Quantity::Time.si_unit());
        Term { number: idx + 1, sign: 1.0, unit }
    });
    let name = |idx: usize| table.header().get(idx).cloned().unwrap_or_default();
    Some(ColumnUse {
        channel: Channel::Time,
        number: whole.0 + 1,
        name: format!("{} + {}", name(whole.0), name(part.0)),
        unit: terms[0].unit,
        unit_is_stated: true,
        terms: terms.to_vec(),
        formula: None,
    })
}

/// The beginning of a name and the symbol of the unit that its ending is.
fn divided(key: &str) -> Option<(String, &'static str)> {
    ENDINGS.iter().find_map(|(endings, symbol)| {
        endings.iter().find_map(|ending| {
            let stem = key.strip_suffix(ending)?;
            let is_known = STEMS.contains(&stem) && !(stem.is_empty() && ending.len() < 2);
            is_known.then(|| (stem.to_owned(), *symbol))
        })
    })
}

/// The times of day in a column, such as `12:59:59.9`, in seconds; they go on over midnight, and over the
/// hour where no hours are given. `None` if the first cell is no such time.
///
/// # Errors
/// The index of the first row that holds something else.
pub(super) fn times_of_day_s(table: &Table, column_idx: usize) -> Option<Result<Vec<f64>, usize>> {
    let (_, period_s) = time_of_day_s(&table.cell(0, column_idx))?;
    let mut values: Vec<f64> = Vec::with_capacity(table.n_rows());
    let mut turns_s = 0.0;
    for row_idx in 0..table.n_rows() {
        let Some((time_s, _)) = time_of_day_s(&table.cell(row_idx, column_idx)) else {
            return Some(Err(row_idx));
        };
        let last_s = values.last().copied().unwrap_or(time_s);
        if time_s + turns_s < last_s - period_s / 2.0 {
            turns_s += period_s;
        }
        values.push(time_s + turns_s);
    }
    Some(Ok(values))
}

/// Seconds and period of a time of day: hours, minutes and seconds, or minutes and seconds, perhaps after
/// a date. One that says its distance from UTC is turned into UTC.
fn time_of_day_s(text: &str) -> Option<(f64, f64)> {
    let text = text.trim().trim_end_matches(['Z', 'z']);
    let time = text.rsplit(['T', ' ']).next()?;
    if let Some(at) = time.find(['+', '-']) {
        let (clock, offset) = time.split_at_checked(at)?;
        let (time_s, period_s) = plain_time_s(clock)?;
        let in_utc_s = (time_s - offset_s(offset)?).rem_euclid(DAY_S);
        return (period_s == DAY_S).then_some((in_utc_s, DAY_S));
    }
    plain_time_s(time)
}

/// Seconds of `+hh:mm`, `+hhmm` or `+hh`.
fn offset_s(text: &str) -> Option<f64> {
    let sign = if text.starts_with('-') { -1.0 } else { 1.0 };
    let digits: String = text.get(1..)?.chars().filter(|c| *c != ':').collect();
    let is_plain = digits.bytes().all(|byte| byte.is_ascii_digit());
    let (hours, minutes) = digits.split_at_checked(2).filter(|_| is_plain)?;
    let hours = hours.parse::<f64>().ok().filter(|hours| *hours < 24.0)?;
    let minutes = match minutes.len() {
        0 => 0.0,
        2 => minutes.parse::<f64>().ok().filter(|minutes| *minutes < 60.0)?,
        _ => return None,
    };
    Some(sign * (HOUR_S * hours + 60.0 * minutes))
}

fn plain_time_s(time: &str) -> Option<(f64, f64)> {
    let time = time.replace(',', ".");
    let parts: Vec<&str> = time.split(':').collect();
    let (seconds, whole) = parts.split_last()?;
    let is_plain = |part: &&str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    let is_second = seconds.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.');
    let seconds: f64 = seconds.parse().ok().filter(|s| is_second && (0.0..61.0).contains(s))?;
    let whole: Vec<f64> = whole
        .iter()
        .map(|part| part.parse().ok().filter(|_| is_plain(part)))
        .collect::<Option<_>>()?;
    match whole[..] {
        [minutes] if minutes < 60.0 => Some((60.0 * minutes + seconds, HOUR_S)),
        [hours, minutes] if hours < 24.0 && minutes < 60.0 => {
            Some((HOUR_S * hours + 60.0 * minutes + seconds, DAY_S))
        }
        _ => None,
    }
}

/// Seconds after which a clock of plain numbers begins again at 0: at the minute, the hour and midnight.
const PERIODS_S: [f64; 3] = [60.0, HOUR_S, DAY_S];

/// Longest step over such a beginning, in steps that are usual.
const LONGEST_STEP: f64 = 5.0;

/// Lets a time go on whose seconds begin again at 0 after a minute, an hour or a day. A time that goes back
/// for another reason stays as it is.
///
/// - `time_s`: as it stands in the file, without a shift, s;
/// - returns the remark on it if it was changed.
pub(super) fn go_on(time_s: &mut [f64]) -> Option<Note> {
    let steps = || time_s.windows(2).map(|pair| pair[1] - pair[0]);
    let n_turns = steps().filter(|step_s| *step_s < 0.0).count();
    if n_turns == 0 {
        return None;
    }
    let mut forward: Vec<f64> = steps().filter(|step_s| *step_s > 0.0).collect();
    forward.sort_by(f64::total_cmp);
    let longest_s = LONGEST_STEP * quantile_of_sorted(&forward, 0.5)?;
    let fits = |period_s: &f64| {
        let turn = |step_s: f64| step_s >= 0.0 || (0.0..=longest_s).contains(&(step_s + period_s));
        time_s.iter().all(|t| (-ZERO_S..*period_s).contains(t)) && steps().all(turn)
    };
    let period_s = PERIODS_S.into_iter().find(fits)?;
    let (mut turned_s, mut last_s) = (0.0, f64::NEG_INFINITY);
    for time_s in time_s {
        turned_s += if *time_s < last_s { period_s } else { 0.0 };
        last_s = *time_s;
        *time_s += turned_s;
    }
    Some(Note::GoesOn { period_s, n_turns })
}

/// Asks for the unit of a clock that nobody has stated and that counts parts of seconds since 1970.
///
/// # Errors
/// [`DataError::Open`] with the unit and a shift to zero.
pub(super) fn check_unit(
    table: &Table,
    time: &ColumnUse,
    map: Option<&ColumnMap>,
) -> Result<(), DataError> {
    let [Term { number, .. }] = time.terms[..] else { return Ok(()) };
    let first = number.checked_sub(1).and_then(|idx| table.number(0, idx));
    let Some(first) = first.filter(|_| !time.unit_is_stated) else { return Ok(()) };
    let parts = || Quantity::Time.units().iter().filter(|unit| unit.si_per_unit < 1.0);
    let Some(unit) = parts().find(|unit| UNIX_S.contains(&unit.to_si(first))) else {
        return Ok(());
    };
    let what = format!(
        "column {number} {:?} counts the {} since 1970, to judge by its numbers; name its unit, and a shift \
         that lets the record begin at 0",
        time.name, unit.symbol
    );
    let answer = ColumnSource { column: ColumnRef::Number(number), unit: Some(*unit) };
    let mut map = map.cloned().unwrap_or_default();
    if map.settings.time_shift_s.is_none() {
        map.settings.time_shift_s = Some(0.0 - unit.to_si(first));
    }
    Err(open_question(table, Some(&map), what, [(Channel::Time, answer)]))
}

/// The shift with which a record begins at zero, if it begins elsewhere: at the seconds of a clock, or
/// before the instant to which it counts.
pub(super) fn offered_shift_s(series: &TimeSeries) -> Option<f64> {
    let first_s = series.time_s().first().copied()?;
    (!(-ZERO_S..LATE_S).contains(&first_s)).then_some(0.0 - first_s)
}

/// Asks for a shift of controls of which a motion that begins at 0 would hold or leave out a part.
///
/// # Errors
/// [`DataError::Open`] with the shift.
pub(super) fn check_controls(
    table: &Table,
    series: &TimeSeries,
    kind: FileKind,
    map: Option<&ColumnMap>,
) -> Result<(), DataError> {
    let Some(shift_s) = controls_shift_s(series, kind, map) else { return Ok(()) };
    let last_s = series.time_s().last().copied().unwrap_or(0.0 - shift_s);
    let first_s = 0.0 - shift_s;
    let what = format!(
        "the record runs from {first_s} s to {last_s} s, and a motion begins at 0 s; say by how much its \
         times are shifted, or shift=0:s if they are not"
    );
    let mut map = map.cloned().unwrap_or_default();
    map.settings.time_shift_s = Some(shift_s);
    Err(open_question(table, Some(&map), what, []))
}

/// The shift that lets controls begin at 0 of which a motion that begins there would hold or leave out a part;
/// `None` if they do not, or if the map says where they begin.
pub(super) fn controls_shift_s(
    series: &TimeSeries,
    kind: FileKind,
    map: Option<&ColumnMap>,
) -> Option<f64> {
    let is_said = map.is_some_and(|map| map.settings.time_shift_s.is_some());
    if is_said || !matches!(kind, FileKind::Steer | FileKind::Wheels) {
        return None;
    }
    let first_s = series.time_s().first().copied()?;
    let is_held = || {
        let mut columns = series.channels().filter_map(|channel| series.get(channel)?.first());
        first_s > ZERO_S && columns.any(|value| *value != 0.0)
    };
    (offered_shift_s(series).is_some() || is_held()).then_some(0.0 - first_s)
}

/// Whether an instant is one of a clock that counts the seconds since 1970.
pub(super) fn is_since_1970(at_s: f64) -> bool {
    UNIX_S.contains(&at_s)
}

/// What says that a record begins elsewhere than at 0.
pub(super) fn shift_text(first_s: f64) -> String {
    let clock = if is_since_1970(first_s) { ", on a clock that counts since 1970" } else { "" };
    let shift = shift_to_zero(first_s);
    format!("the record begins at {first_s} s{clock}; it begins at 0 with the map {shift}")
}

/// The shift with which a record begins at 0.
pub(super) fn shift_to_zero(first_s: f64) -> Correction {
    Correction::shift(0.0 - first_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_that_begin_again_go_on() {
        for (period_s, step_s) in [(60.0, 1.0), (60.0, 0.5), (3600.0, 1.0), (86_400.0, 2.0)] {
            let true_s = |i: u32| period_s - 3.0 * step_s + f64::from(i) * step_s;
            let mut time_s: Vec<f64> = (0..200).map(|i| true_s(i) % period_s).collect();
            let n_turns = ((true_s(199)) / period_s).floor() as usize;
            let note = go_on(&mut time_s);
            assert_eq!(note, Some(Note::GoesOn { period_s, n_turns }));
            let expected: Vec<f64> = (0..200).map(true_s).collect();
            assert_eq!(time_s, expected, "{period_s}");
        }
        for mut unknown in [
            vec![0.0, 1.0, 2.0, 3.0],
            vec![57.0, 58.0, 0.0, 1.0, 30.0, 2.0, 3.0],
            vec![5.0, 6.0, 7.0, 3.0, 4.0],
        ] {
            let before = unknown.clone();
            assert_eq!(go_on(&mut unknown), None);
            assert_eq!(unknown, before);
        }
    }

    #[test]
    fn times_of_day_are_read() {
        for (text, seconds) in [
            ("12:59:59.9", Some((46_799.9, DAY_S))),
            ("2026-11-25T00:00:01,5Z", Some((1.5, DAY_S))),
            ("25.11.2026 00:01:00", Some((60.0, DAY_S))),
            ("2026-11-25T00:30:01.5+01:00", Some((84_601.5, DAY_S))),
            ("12:00:00-0330", Some((55_800.0, DAY_S))),
            ("59:59.5", Some((3599.5, HOUR_S))),
            ("59:59+01:00", None),
            ("12:00:00+1:00:00", None),
            ("12:00:00-", None),
            ("12:60:00", None),
            ("12:+5:00", None),
            ("1.5", None),
            ("a:b", None),
        ] {
            assert_eq!(time_of_day_s(text), seconds, "{text}");
        }
    }
}
