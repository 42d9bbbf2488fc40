//! A time series as a Parquet file, for pandas, polars and other programs that read columns.

use std::io;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, Repetition, Type as Physical, ZstdLevel};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use crate::data::{Channel, DataError, Existing, RESTRICTIONS_COLUMN, TimeSeries, write_bytes};

/// Writes a time series as Parquet with the columns that
/// [`write_series_csv`](crate::data::write_series_csv) has, as numbers of 64 bits without a missing one. What
/// restricts them is a pair of the file's own metadata, named [`RESTRICTIONS_COLUMN`].
///
/// - `existing`: what happens to a file that exists already.
///
/// # Errors
/// As for [`write_bytes`].
pub fn write_restricted_series_parquet(
    path: &Path,
    existing: Existing,
    series: &TimeSeries,
    restrictions: Option<&str>,
) -> Result<(), DataError> {
    let bytes = bytes(series, restrictions)
        .map_err(|error| DataError::io(path, io::Error::other(error.to_string())))?;
    write_bytes(path, existing, &bytes)
}

fn bytes(series: &TimeSeries, restrictions: Option<&str>) -> Result<Vec<u8>, ParquetError> {
    let channels: Vec<Channel> = series.channels().collect();
    let columns: Vec<&[f64]> = channels.iter().filter_map(|&channel| series.get(channel)).collect();
    let column = |channel: Channel| {
        let column = Type::primitive_type_builder(channel.header(), Physical::DOUBLE);
        column.with_repetition(Repetition::REQUIRED).build().map(Arc::new)
    };
    let named = std::iter::once(Channel::Time).chain(channels.iter().copied());
    let fields = named.map(column).collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("series").with_fields(fields).build()?;
    let pair = |text: &str| KeyValue::new(RESTRICTIONS_COLUMN.to_owned(), text.to_owned());
    let properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::default()))
        .set_key_value_metadata(restrictions.map(|text| vec![pair(text)]))
        .build();
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for values in std::iter::once(series.time_s()).chain(columns) {
        let Some(mut column) = group.next_column()? else { break };
        column.typed::<DoubleType>().write_batch(values, None, None)?;
        column.close()?;
    }
    group.close()?;
    writer.close()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{ColumnMap, read_force_file};

    #[test]
    fn a_series_is_read_again_with_the_same_numbers() {
        let mut series = TimeSeries::new(vec![0.0, 0.1, 0.2]).unwrap();
        for (channel, size) in [(Channel::Fx, 1.0), (Channel::Fy, -1e-7)] {
            series.insert(channel, vec![0.0, size / 3.0, 0.0]).unwrap();
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("force.parquet");
        let restrictions = Some("warning: outside of the domain");
        write_restricted_series_parquet(&path, Existing::Refuse, &series, restrictions).unwrap();
        let loaded = read_force_file(&path, None).unwrap();
        assert_eq!(loaded.series, series);
        let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
        assert!(notes.iter().any(|note| note.ends_with("outside of the domain")), "{notes:?}");
        let map: ColumnMap = "fx=fy_n:kN,fy=fx_n:N".parse().unwrap();
        let turned = read_force_file(&path, Some(&map)).unwrap();
        assert_eq!(turned.series.require(Channel::Fy).unwrap()[1], 1.0 / 3.0);
        let again = write_restricted_series_parquet(&path, Existing::Refuse, &series, None);
        assert!(again.is_err());
    }

    #[test]
    fn a_damaged_file_is_refused() {
        let series = TimeSeries::new(vec![0.0, 0.1]).unwrap();
        let whole = bytes(&series, None).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("f.parquet");
        for cut in 5..whole.len() {
            std::fs::write(&path, &whole[..cut]).unwrap();
            let error = read_force_file(&path, None).unwrap_err().to_string();
            assert!(error.contains("the Parquet file cannot be read"), "{cut}: {error}");
        }
    }
}
