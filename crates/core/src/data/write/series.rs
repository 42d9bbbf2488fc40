//! A time series as a file, and tables that say what restricts their numbers.

use std::path::Path;

use crate::data::{Channel, DataError, Existing, TimeSeries, write_atomically};

/// Name of the last column of a table whose numbers are restricted by something. Its first row says
/// by what, its other rows are empty.
///
/// A column, and not comment lines above the header: the header stays in the first line, where
/// spreadsheets and scripts look for it, and no reader has to know a sign of comments.
pub const RESTRICTIONS_COLUMN: &str = "restrictions";

/// Writes a time series as CSV with the headers of [`Channel::header`], SI units. Time is the first
/// column, the others follow in the order of [`Channel::ALL`]. Every number has the fewest digits
/// that give the same number when it is read.
///
/// - `existing`: what happens to a file that exists already.
///
/// # Errors
/// As for [`write_atomically`].
pub fn write_series_csv(
    path: &Path,
    existing: Existing,
    series: &TimeSeries,
) -> Result<(), DataError> {
    write_restricted_series_csv(path, existing, series, None)
}

/// As [`write_series_csv`], with a last column that says what restricts the series.
///
/// # Errors
/// As for [`write_atomically`].
pub fn write_restricted_series_csv(
    path: &Path,
    existing: Existing,
    series: &TimeSeries,
    restrictions: Option<&str>,
) -> Result<(), DataError> {
    let channels: Vec<Channel> = series.channels().collect();
    let columns: Vec<&[f64]> = channels.iter().filter_map(|&channel| series.get(channel)).collect();
    let headers = channels.iter().map(|channel| channel.header().to_owned());
    let header: Vec<String> =
        std::iter::once(Channel::Time.header().to_owned()).chain(headers).collect();
    let rows = series.time_s().iter().enumerate().map(|(i, time)| {
        let values = columns.iter().filter_map(|column| column.get(i));
        std::iter::once(time).chain(values).map(ToString::to_string).collect()
    });
    write_restricted_table(path, existing, &header, rows, restrictions)
}

/// Writes a table as CSV.
///
/// - `restrictions`: what restricts its numbers, for the first row of [`RESTRICTIONS_COLUMN`]; the
///   table has no such column without.
///
/// # Errors
/// As for [`write_atomically`].
pub fn write_restricted_table(
    path: &Path,
    existing: Existing,
    header: &[String],
    rows: impl Iterator<Item = Vec<String>>,
    restrictions: Option<&str>,
) -> Result<(), DataError> {
    write_atomically(path, existing, |out| {
        let mut csv = csv::Writer::from_writer(out);
        let mut header = header.to_vec();
        header.extend(restrictions.map(|_| RESTRICTIONS_COLUMN.to_owned()));
        csv.write_record(&header)?;
        let mut restrictions = restrictions.map(str::to_owned);
        for mut row in rows {
            row.extend(restrictions.as_mut().map(std::mem::take));
            csv.write_record(&row)?;
        }
        csv.flush()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::read_force_file;

    #[test]
    fn a_restricted_series_is_read_again_with_the_same_numbers() {
        let mut series = TimeSeries::new(vec![0.0, 0.1, 0.2]).unwrap();
        for channel in [Channel::Fx, Channel::Fy] {
            series.insert(channel, vec![0.0, 1.0 / 3.0, 0.0]).unwrap();
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("force.csv");
        let restrictions = "warning: outside the domain: mass, \"bullet\" | note: assumed: 1, 2";
        write_restricted_series_csv(&path, Existing::Refuse, &series, Some(restrictions)).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.starts_with("time_s,fx_n,fy_n,restrictions\n0,0,0,\"warning: "), "{text}");
        let loaded = read_force_file(&path, None).unwrap();
        assert_eq!(loaded.series, series);
        let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
        assert_eq!(notes, [format!("the file says of itself: {restrictions}")]);
    }
}
