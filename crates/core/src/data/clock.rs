//! The clocks of files: seconds with a second column for their fraction, and seconds since 1970. Times of day
//! have a [module of their own](super::time_of_day).

use crate::data::columns::{ColumnUse, Term, open_question};
use crate::data::spelling::{self, letters_and_digits};
use crate::data::time_of_day::{DAY_S, HOUR_S};
use crate::data::{
    Channel, ColumnMap, ColumnRef, ColumnSource, Correction, DataError, FileKind, Note,
    SeriesError, Table, TimeSeries,
};
use crate::numerics::{median, quantile_of_sorted};
use crate::ranges::TIME_STEP;
use crate::units::{Quantity, Unit};

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
    let longest_s = LONGEST_STEP * median(steps().filter(|step_s| *step_s > 0.0))?;
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

/// Turns times of day that are written as one number, `120059.95` for 12:00:59.95, into seconds. They are known by the steps
/// over a minute, which are 40 s too long as seconds and usual as times of day.
///
/// - `time_s`: as it stands in the file, without a shift, s;
/// - returns the remark on it if it was changed.
pub(super) fn from_digits(time_s: &mut [f64]) -> Option<Note> {
    let of_day_s = |number: f64| {
        let [hours, minutes] = [(number / 1e4).floor(), (number / 100.0).floor() % 100.0];
        let seconds = number % 100.0;
        let is_time = (0.0..24e4).contains(&number) && minutes < 60.0 && seconds < 60.0;
        is_time.then_some(HOUR_S * hours + 60.0 * minutes + seconds)
    };
    let times_s: Vec<f64> = time_s.iter().map(|number| of_day_s(*number)).collect::<Option<_>>()?;
    let steps = |times_s: &[f64]| -> Vec<f64> {
        let steps = times_s.windows(2).map(|pair| pair[1] - pair[0]);
        let mut steps: Vec<f64> = steps.filter(|step_s| *step_s > 0.0).collect();
        steps.sort_by(f64::total_cmp);
        steps
    };
    let (as_seconds, as_times) = (steps(time_s), steps(&times_s));
    let longest_s = LONGEST_STEP * quantile_of_sorted(&as_times, 0.5)?;
    let is_known = *as_seconds.last()? > longest_s.max(40.0) && *as_times.last()? <= longest_s;
    is_known.then(|| {
        time_s.copy_from_slice(&times_s);
        let text = "the time is written as hours, minutes and seconds in one number, hhmmss; it is read so";
        Note::Format { text: text.to_owned() }
    })
}

/// How far the first instant of a second record may lie from that of the first one, as a share of its duration.
const AGAIN_SHARE: f64 = 0.1;

/// Refuses a time that goes back to where it began, as that of a second event or run below the first one.
///
/// - `time_s`: of all rows, s.
pub(super) fn second_record(table: &Table, time: &ColumnUse, time_s: &[f64]) -> Option<DataError> {
    let goes_back = |pair: &[f64]| pair[1] < pair[0];
    let at = 1 + time_s.windows(2).position(goes_back)?;
    let (first_s, before_s, after_s) = (*time_s.first()?, time_s[at - 1], time_s[at]);
    let is_again = (after_s - first_s).abs() <= AGAIN_SHARE * (before_s - first_s);
    let n_records = 1 + time_s.windows(2).filter(|pair| goes_back(pair)).count();
    is_again.then(|| {
        let expected = format!(
            "a time after {before_s} s in the row before: it goes back to where the record began, at {first_s} s, \
             so that this is another event or run; of {n_records} below each other, put each into a file of its \
             own, the first one up to line {}",
            table.line(at - 1)
        );
        table.cell_error(at, time.number.saturating_sub(1), &expected)
    })
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
    let Some(unit) = unit_since_1970(first).filter(|unit| unit.si_per_unit < 1.0) else {
        return Ok(());
    };
    let what = format!(
        "column {number} {:?} counts the {} since 1970, to judge by its numbers; name its unit, and a shift \
         that lets the record begin at 0",
        time.name, unit.symbol
    );
    let answer = ColumnSource { column: ColumnRef::Number(number), unit: Some(unit) };
    let mut map = map.cloned().unwrap_or_default();
    if map.settings.time_shift_s.is_none() {
        map.settings.time_shift_s = Some(0.0 - unit.to_si(first));
    }
    Err(open_question(table, Some(&map), what, [(Channel::Time, answer)]))
}

/// The unit in which a number counts the time since 1970; `None` if it does not, to judge by its size.
pub(super) fn unit_since_1970(number: f64) -> Option<Unit> {
    let units = Quantity::Time.units().iter().filter(|unit| unit.si_per_unit <= 1.0);
    units.copied().find(|unit| UNIX_S.contains(&unit.to_si(number)))
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

/// Checks the time between the samples.
///
/// # Errors
/// [`DataError::TimeStep`] at the first one that no instrument and no record has.
pub(super) fn check_steps(
    table: &Table,
    column: &ColumnUse,
    time_s: &[f64],
) -> Result<(), DataError> {
    for (row_idx, pair) in time_s.windows(2).enumerate() {
        TIME_STEP.check(pair[1] - pair[0]).map_err(|step| DataError::TimeStep {
            path: table.path().to_owned(),
            line: table.line(row_idx + 1),
            column: column.number,
            step,
        })?;
    }
    Ok(())
}

/// The error for a time that does not rise.
pub(super) fn out_of_order(table: &Table, time: &ColumnUse, error: SeriesError) -> DataError {
    let path = table.path().to_owned();
    match error {
        SeriesError::TimeOrder { sample_idx, before, after } => DataError::TimeOrder {
            path,
            line: table.line(sample_idx),
            column: time.number,
            before_s: before,
            after_s: after,
        },
        source => DataError::Series { path, source },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_of_a_stamp_follows_from_its_size() {
        for (number, symbol) in [(1.7e9, "s"), (1.7e12, "ms"), (1.7e15, "µs"), (1.7e18, "ns")] {
            assert_eq!(unit_since_1970(number).map(|unit| unit.symbol), Some(symbol));
        }
        for number in [0.0, -1.7e18, 5e8, 9e9, 1e30, f64::NAN] {
            assert_eq!(unit_since_1970(number), None, "{number}");
        }
    }

    #[test]
    fn times_of_day_in_one_number_are_known_by_their_minutes() {
        let number = |at_s: f64| {
            let [hours, minutes] = [(at_s / HOUR_S).floor(), (at_s / 60.0).floor() % 60.0];
            1e4 * hours + 100.0 * minutes + at_s % 60.0
        };
        for (begin_s, step_s) in [(43_190.0, 0.5), (3599.0, 0.25), (50.0, 1.0)] {
            let at_s = |i: u32| begin_s + step_s * f64::from(i);
            let mut time_s: Vec<f64> = (0..100).map(|i| number(at_s(i))).collect();
            assert!(from_digits(&mut time_s).is_some(), "{begin_s}");
            for (i, time_s) in (0..100).zip(&time_s) {
                assert!((time_s - at_s(i)).abs() < 1e-6, "{i}: {time_s}");
            }
        }
        // Seconds, seconds with a gap, and times of day within one minute, which are seconds as well.
        let seconds: Vec<f64> = (0..100).map(|i| 0.5 * f64::from(i)).collect();
        let gap: Vec<f64> = seconds.iter().map(|t| if *t > 20.0 { t + 37.0 } else { *t }).collect();
        let minute: Vec<f64> = seconds.iter().map(|t| 120_000.0 + t).collect();
        for mut time_s in [seconds, gap, minute] {
            let before = time_s.clone();
            assert_eq!(from_digits(&mut time_s), None, "{before:?}");
            assert_eq!(time_s, before);
        }
    }

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
}
