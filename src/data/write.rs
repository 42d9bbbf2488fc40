//! Writes files in such a way that a reader never finds an incomplete file.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::data::{Channel, DataError, TimeSeries};

/// Writes a file through a temporary file in the same folder, which replaces `path` in one step at
/// the end. If anything fails, `path` remains as it was.
///
/// - `write`: writes the content.
///
/// # Errors
/// [`DataError`] with the error of the operating system or of `write`.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), DataError> {
    let to_error = |source| DataError::io(path, source);
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut file = NamedTempFile::new_in(folder).map_err(to_error)?;
    let mut buffered = BufWriter::new(file.as_file_mut());
    write(&mut buffered).and_then(|()| buffered.flush()).map_err(to_error)?;
    drop(buffered);
    file.as_file().sync_all().map_err(to_error)?;
    file.persist(path).map_err(|error| to_error(error.error))?;
    Ok(())
}

/// Writes a time series as CSV with the headers of [`Channel::header`], SI units. Time is the first
/// column, the others follow in the order of [`Channel::ALL`]. Every number has the fewest digits
/// that give the same number when it is read.
///
/// # Errors
/// [`DataError`] with the error of the operating system.
pub fn write_series_csv(path: &Path, series: &TimeSeries) -> Result<(), DataError> {
    let channels: Vec<Channel> = series.channels().collect();
    let columns: Vec<&[f64]> = channels.iter().filter_map(|&channel| series.get(channel)).collect();
    write_atomically(path, |out| {
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
