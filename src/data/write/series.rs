//! A time series as a file.

use std::path::Path;

use crate::data::{Channel, DataError, Existing, TimeSeries, write_atomically};

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
    let channels: Vec<Channel> = series.channels().collect();
    let columns: Vec<&[f64]> = channels.iter().filter_map(|&channel| series.get(channel)).collect();
    write_atomically(path, existing, |out| {
        let headers = channels.iter().map(|channel| channel.header());
        let header: Vec<&str> = std::iter::once(Channel::Time.header()).chain(headers).collect();
        writeln!(out, "{}", header.join(","))?;
        for (i, time) in series.time_s().iter().enumerate() {
            write!(out, "{time}")?;
            for value in columns.iter().filter_map(|column| column.get(i)) {
                write!(out, ",{value}")?;
            }
            writeln!(out)?;
        }
        Ok(())
    })
}
