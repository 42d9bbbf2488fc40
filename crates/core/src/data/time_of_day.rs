//! Times of day, such as `12:59:59.9`, `12:59:59 PM` or `2026-11-25T12:59:59.9+01:00`.

use crate::data::Table;
use crate::data::workbook::days_of;

pub(super) const HOUR_S: f64 = 3600.0;
pub(super) const DAY_S: f64 = 86_400.0;
/// Half of a day, after which a clock of twelve hours begins again.
const HALF_S: f64 = DAY_S / 2.0;

/// The times of day in a column, such as `12:59:59.9` or those of a workbook, in seconds. With a date they count from the midnight before
/// the first one; without, they go on over midnight, and over the hour where no hours are given. `None` if the first
/// cell is no such time.
///
/// # Errors
/// The index of the first row that holds something else, or another date that cannot be read.
pub(super) fn times_of_day_s(table: &Table, column_idx: usize) -> Option<Result<Vec<f64>, usize>> {
    let cell = |row_idx: usize| table.cell(row_idx, column_idx);
    if let Some(first) = days_of(&cell(0)) {
        let since_midnight_s = |days: f64| DAY_S * (days - first.floor());
        let time_s = |row_idx| days_of(&cell(row_idx)).map(since_midnight_s).ok_or(row_idx);
        return Some((0..table.n_rows()).map(time_s).collect());
    }
    Stamp::read(&cell(0))?;
    let stamp = |row_idx| Stamp::read(&cell(row_idx)).ok_or(row_idx);
    let stamps: Result<Vec<Stamp>, usize> = (0..table.n_rows()).map(stamp).collect();
    Some(stamps.and_then(|stamps| instants_s(&stamps)))
}

/// Whether the first cell of a column is such a time.
pub(super) fn is_time_of_day(table: &Table, column_idx: usize) -> bool {
    let cell = table.cell(0, column_idx);
    days_of(&cell).is_some() || Stamp::read(&cell).is_some()
}

/// As [`times_of_day_s`], of cells that were read.
fn instants_s(stamps: &[Stamp]) -> Result<Vec<f64>, usize> {
    if let Some(days) = days(stamps) {
        let in_utc_s = |(day, stamp): (i64, &Stamp)| day as f64 * DAY_S + stamp.in_utc_s();
        let mut times_s: Vec<f64> = days.into_iter().zip(stamps).map(in_utc_s).collect();
        let midnight_s = times_s.first().map_or(0.0, |first_s| DAY_S * (first_s / DAY_S).floor());
        times_s.iter_mut().for_each(|time_s| *time_s -= midnight_s);
        return Ok(times_s);
    }
    let mut times_s: Vec<f64> = Vec::with_capacity(stamps.len());
    let mut turns_s = 0.0;
    for (row_idx, stamp) in stamps.iter().enumerate() {
        if stamps.first().is_some_and(|first| first.date != stamp.date) {
            return Err(row_idx);
        }
        let time_s = match stamp.period_s == DAY_S {
            true => stamp.in_utc_s().rem_euclid(DAY_S),
            false => stamp.time_s,
        };
        let last_s = times_s.last().copied().unwrap_or(time_s);
        if time_s + turns_s < last_s - stamp.period_s / 2.0 {
            turns_s += stamp.period_s;
        }
        times_s.push(time_s + turns_s);
    }
    Ok(times_s)
}

/// A time of day: hours, minutes and seconds, or minutes and seconds, perhaps after a date and before its distance
/// from UTC.
struct Stamp {
    /// As it is written, empty without one.
    date: String,
    /// Since midnight, or since the hour.
    time_s: f64,
    /// After what the time begins again: a day or an hour.
    period_s: f64,
    /// How far the clock is ahead of UTC.
    offset_s: f64,
}

impl Stamp {
    fn read(text: &str) -> Option<Self> {
        let (text, half_s) = without_half(text.trim().trim_end_matches(['Z', 'z']));
        let (date, time) = text.rsplit_once(['T', ' ']).unwrap_or(("", text));
        let (clock, offset_s) = match time.find(['+', '-']) {
            Some(at) => {
                let (clock, offset) = time.split_at_checked(at)?;
                (clock, Some(offset_s(offset)?))
            }
            None => (time, None),
        };
        let (time_s, period_s) = plain_time_s(clock)?;
        let time_s = match half_s {
            Some(half_s) if period_s == DAY_S && time_s < HALF_S + HOUR_S => {
                time_s % HALF_S + half_s
            }
            Some(_) => return None,
            None if offset_s.is_some() && period_s != DAY_S => return None,
            None => time_s,
        };
        let date = date.trim().trim_end_matches(',').to_owned();
        Some(Self { date, time_s, period_s, offset_s: offset_s.unwrap_or(0.0) })
    }

    fn in_utc_s(&self) -> f64 {
        self.time_s - self.offset_s
    }
}

/// A time without its `AM` or `PM`, and when that half of the day begins, s; `None` of a time that has neither.
fn without_half(text: &str) -> (&str, Option<f64>) {
    let halves = [("am", 0.0), ("pm", HALF_S)];
    let found = halves.into_iter().find_map(|(word, start_s)| {
        let (time, end) = text.split_at_checked(text.len().checked_sub(word.len())?)?;
        end.eq_ignore_ascii_case(word).then_some((time.trim_end(), Some(start_s)))
    });
    found.unwrap_or((text, None))
}

/// The order of the three numbers of a date that does not begin with the year: whether the month comes first.
const MONTH_FIRST: [bool; 2] = [false, true];

/// The days of stamps, counted from some day. Of the two orders of day and month, where the numbers allow both, the
/// one over which fewer days pass; `None` without dates that can be read.
fn days(stamps: &[Stamp]) -> Option<Vec<i64>> {
    let in_order = |is_month_first| {
        let days = stamps.iter().map(|stamp| day_number(&stamp.date, is_month_first));
        let days: Vec<i64> = days.collect::<Option<_>>()?;
        let span = days.last()?.abs_diff(*days.first()?);
        Some((span, days))
    };
    let orders = MONTH_FIRST.into_iter().filter_map(in_order);
    orders.min_by_key(|(span, _)| *span).map(|(_, days)| days)
}

/// The number of the day of `2026-11-25`, `25.11.2026` or `11/25/2026` since some day.
fn day_number(date: &str, is_month_first: bool) -> Option<i64> {
    let parts = date.split(['-', '.', '/']).map(|part| part.parse().ok());
    let numbers: Vec<i64> = parts.collect::<Option<_>>()?;
    let [first, second, third] = numbers[..] else { return None };
    let (year, month, day) = match (first > 31, is_month_first) {
        (true, _) => (first, second, third),
        (false, true) if !date.contains('.') => (third, first, second),
        (false, false) => (third, second, first),
        (false, true) => return None,
    };
    let is_date =
        (1900..3000).contains(&year) && (1..=12).contains(&month) && (1..=31).contains(&day);
    // Years that begin in March have the day that is inserted at their end.
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    let leap_days = year / 4 - year / 100 + year / 400;
    is_date.then_some(365 * year + leap_days + (153 * month + 2) / 5 + day)
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

/// Seconds and period of hours, minutes and seconds, or of minutes and seconds.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_day_are_read() {
        for (text, seconds) in [
            ("12:59:59.9", Some((46_799.9, DAY_S))),
            ("2026-11-25T00:00:01,5Z", Some((1.5, DAY_S))),
            ("25.11.2026 00:01:00", Some((60.0, DAY_S))),
            ("2026-11-25T00:30:01.5+01:00", Some((-1_798.5, DAY_S))),
            ("12:00:00-0330", Some((55_800.0, DAY_S))),
            ("59:59.5", Some((3599.5, HOUR_S))),
            ("11/30/2026 1:30:00.5 PM", Some((48_600.5, DAY_S))),
            ("12:00:01am", Some((1.0, DAY_S))),
            ("12:30:00 pm", Some((45_000.0, DAY_S))),
            ("13:00:00 PM", None),
            ("59:59 PM", None),
            ("59:59+01:00", None),
            ("12:00:00+1:00:00", None),
            ("12:00:00-", None),
            ("12:60:00", None),
            ("12:+5:00", None),
            ("1.5", None),
            ("a:b", None),
        ] {
            let read = Stamp::read(text).map(|stamp| (stamp.in_utc_s(), stamp.period_s));
            assert_eq!(read, seconds, "{text}");
        }
    }

    #[test]
    fn dates_count_the_days_between_two_times() {
        let read = |texts: &[&str]| {
            let stamps: Vec<Stamp> = texts.iter().map(|text| Stamp::read(text).unwrap()).collect();
            instants_s(&stamps)
        };
        for (texts, expected) in [
            (["2026-11-25T23:59:59Z", "2026-11-28T00:00:01Z"], [86_399.0, 259_201.0]),
            (["25.11.2026 10:00:00", "26.11.2026 11:00:00"], [36_000.0, 126_000.0]),
            (["28.02.2028 00:00:00", "01.03.2028 00:00:00"], [0.0, 172_800.0]),
            (["2026/12/31 23:00:00", "2027/01/01 01:00:00"], [82_800.0, 90_000.0]),
            // Day and month in either order, by what they can be or by the days that pass.
            (["11/25/2026 10:00:00", "11/26/2026 10:00:00"], [36_000.0, 122_400.0]),
            (["04/03/2026 10:00:00", "05/03/2026 10:00:00"], [36_000.0, 122_400.0]),
            (["03/04/2026 10:00:00", "03/05/2026 10:00:00"], [36_000.0, 122_400.0]),
            // The midnight of a clock ahead of UTC lies on the day before.
            (["2026-11-26T00:30:00+01:00", "2026-11-26T01:30:00+01:00"], [84_600.0, 88_200.0]),
            // Without a date they go on over midnight.
            (["23:59:59", "00:00:01"], [86_399.0, 86_401.0]),
            (["Wed 23:59:59", "Wed 23:59:59.5"], [86_399.0, 86_399.5]),
        ] {
            assert_eq!(read(&texts), Ok(expected.to_vec()), "{texts:?}");
        }
        assert_eq!(read(&["Wed 10:00:00", "Wed 10:00:01", "Thu 10:00:02"]), Err(2));
        assert_eq!(read(&["2026-11-25 10:00:00", "10:00:01"]), Err(1));
    }
}
