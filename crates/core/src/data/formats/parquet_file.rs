//! Parquet files: columns of numbers by their names, nested ones with points between the names.
//!
//! Read are columns of numbers and switches that are not repeated; texts, lists and decimals of more than 64 bits are
//! left out. A column that says that it holds times since 1970 has their unit; those of 96 bits always are such times.
//! What the file says of its own sizes is checked first ([`parquet_check`](super::parquet_check)). Written by pandas,
//! polars, Spark and DuckDB, and here by
//! [`write_restricted_series_parquet`](crate::data::write_restricted_series_parquet).

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use parquet::basic::{ConvertedType, LogicalType, TimeUnit, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use crate::data::budget::{MAX_COLUMNS, MAX_TABLE_BYTES};
use crate::data::formats::{Converted, Said, number_text, parquet_check};
use crate::data::{DataError, Place, RESTRICTIONS_COLUMN, Sheet, open_file, read_bytes};

/// Cells that any file may have, and how many more for each of its bytes: long runs of one number are packed
/// into a few bytes.
const FREE_CELLS: usize = 500_000;
const CELLS_PER_BYTE: usize = 16;
/// Cells that no file may exceed; each takes 16 bytes of memory, and some 20 as text.
const MAX_CELLS: usize = 32 << 20;

/// Rows that are read at a time.
const BATCH: usize = 8192;

/// Decimal places that numbers of 64 bits may have.
const PLACES: std::ops::RangeInclusive<i32> = 0..=18;

/// Names of columns that are not read which are shown.
const MAX_SHOWN: usize = 12;

/// Names of columns of stamps, which are the time if they have its unit.
const STAMPS: [&str; 5] = ["timestamp", "time", "stamp", "header.stamp", "t"];

/// A column of numbers.
struct NumberColumn {
    /// Its place among all columns.
    idx: usize,
    header: String,
    /// The level of its definition at which a value is there.
    full: i16,
    /// Whether whole numbers have no sign.
    is_unsigned: bool,
    /// How many of what is stored are 1: 100 of a decimal with two places.
    per_unit: f64,
    values: Vec<Option<f64>>,
}

/// Reads a Parquet file as the text of a table.
///
/// # Errors
/// [`DataError::Damaged`] if it cannot be read, [`DataError::DamagedAt`] without numbers, [`DataError::TooLarge`]
/// beyond the limits.
pub(super) fn as_table(path: &Path) -> Result<Converted, DataError> {
    let bytes = read_bytes(path, MAX_TABLE_BYTES)?;
    let damaged =
        |why: String| DataError::Damaged { path: path.to_owned(), format: "the Parquet file", why };
    if parquet_check::footer(&bytes).is_none() {
        return Err(damaged("its footer is damaged".to_owned()));
    }
    let (file, _) = open_file(path, MAX_TABLE_BYTES)?;
    // What the checks above have not foreseen is a panic of the library.
    let read = catch_unwind(AssertUnwindSafe(|| columns(file, &bytes)));
    let (columns, left_out, restrictions) = match read {
        Ok(read) => read.map_err(damaged)?,
        Err(_) => return Err(damaged("its pages are damaged".to_owned())),
    };
    if columns.is_empty() {
        let columns = if left_out.is_empty() { "none".to_owned() } else { some(&left_out) };
        let why = format!(
            "is a Parquet file without a column of single numbers (its columns: {columns}); write the channels over \
             time as double, or export them as CSV"
        );
        return Err(DataError::DamagedAt { path: path.to_owned(), place: Place::Whole, why });
    }
    let mut description = format!("a Parquet file with {} columns of numbers", columns.len());
    if !left_out.is_empty() {
        description += &format!("; left out are columns of other kinds: {}", some(&left_out));
    }
    let doubts = restrictions.map(|text| format!("the file says of itself: {text}"));
    let name = "columns".to_owned();
    let said = Said {
        description,
        doubts: doubts.into_iter().collect(),
        left_out,
        part: Some(Sheet { name: name.clone(), all: vec![name] }),
        device: String::new(),
        keeps_lines: false,
        ..Said::default()
    };
    Ok(Converted { text: text(&columns), said })
}

fn text(columns: &[NumberColumn]) -> String {
    let header: Vec<&str> = columns.iter().map(|column| column.header.as_str()).collect();
    let mut text = header.join("\t") + "\n";
    let n_rows = columns.iter().map(|column| column.values.len()).max().unwrap_or(0);
    for row in 0..n_rows {
        for (idx, column) in columns.iter().enumerate() {
            if idx > 0 {
                text.push('\t');
            }
            if let Some(value) = column.values.get(row).copied().flatten() {
                text.push_str(&number_text(value));
            }
        }
        text.push('\n');
    }
    text
}

/// The columns of numbers, the others with what they hold, and what the file says restricts its numbers.
type Read = (Vec<NumberColumn>, Vec<String>, Option<String>);

/// # Errors
/// What is wrong, in words.
fn columns(file: std::fs::File, bytes: &[u8]) -> Result<Read, String> {
    let said = |error: ParquetError| error.to_string().chars().take(200).collect::<String>();
    let reader = SerializedFileReader::new(file).map_err(said)?;
    let metadata = reader.metadata().file_metadata();
    let schema = metadata.schema_descr();
    if schema.num_columns() > MAX_COLUMNS {
        return Err(format!(
            "it has {} columns, expected {MAX_COLUMNS} at most",
            schema.num_columns()
        ));
    }
    let (mut columns, mut left_out) = (Vec::new(), Vec::new());
    for (idx, column) in schema.columns().iter().enumerate() {
        match is_number(column) {
            true => columns.push(NumberColumn::new(idx, column)),
            false => {
                left_out.push(format!("{} ({})", plain(&column.path().string()), kind(column)))
            }
        }
    }
    let pairs = metadata.key_value_metadata().into_iter().flatten();
    let restrictions = pairs
        .filter(|pair| pair.key == RESTRICTIONS_COLUMN)
        .find_map(|pair| pair.value.clone())
        .map(|text| plain(&text));
    let mut left = (FREE_CELLS + CELLS_PER_BYTE * bytes.len()).min(MAX_CELLS);
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group).map_err(said)?;
        check_pages(&*group, &columns, bytes)?;
        let n_rows = usize::try_from(group.metadata().num_rows()).ok().ok_or("rows below 0")?;
        let n_cells = n_rows.saturating_mul(columns.len());
        left = left.checked_sub(n_cells).ok_or_else(|| {
            format!(
                "it says that it has {n_rows} rows in one part, more than its bytes can hold or than the \
                 {MAX_CELLS} cells that are read"
            )
        })?;
        for column in &mut columns {
            let mut reader = group.get_column_reader(column.idx).map_err(said)?;
            let values = numbers(&mut reader, column, n_rows).map_err(said)?;
            if values.len() != n_rows {
                return Err(format!("{:?} has {} of {n_rows} rows", column.header, values.len()));
            }
            column.values.extend(values);
        }
    }
    Ok((columns, left_out, restrictions))
}

/// Checks the pages of the columns that are read.
fn check_pages(
    group: &dyn RowGroupReader,
    columns: &[NumberColumn],
    bytes: &[u8],
) -> Result<(), String> {
    let mut unpacked = 0;
    for column in columns {
        let chunk = group.metadata().columns().get(column.idx).ok_or("a column is missing")?;
        let start = chunk.dictionary_page_offset().unwrap_or(chunk.data_page_offset());
        let pages = parquet_check::pages(bytes, start, chunk.compressed_size());
        unpacked += pages.ok_or_else(|| format!("a page of {:?} is damaged", column.header))?;
        if unpacked > MAX_TABLE_BYTES {
            return Err(format!("it unpacks to more than {MAX_TABLE_BYTES} bytes"));
        }
    }
    Ok(())
}

impl NumberColumn {
    fn new(idx: usize, column: &ColumnDescriptor) -> Self {
        let is_unsigned = match column.logical_type_ref() {
            Some(LogicalType::Integer(of)) => !of.is_signed,
            _ => matches!(column.converted_type(), ConvertedType::UINT_32 | ConvertedType::UINT_64),
        };
        let per_unit = if is_decimal(column) { 10.0_f64.powi(column.type_scale()) } else { 1.0 };
        let (header, full) = (header(column), column.max_def_level());
        Self { idx, header, full, is_unsigned, per_unit, values: Vec::new() }
    }
}

/// Whether a column holds one plain number, stamp or switch in a row.
fn is_number(column: &ColumnDescriptor) -> bool {
    let is_plain = matches!(
        column.physical_type(),
        Type::BOOLEAN | Type::INT32 | Type::INT64 | Type::INT96 | Type::FLOAT | Type::DOUBLE
    );
    let is_scaled = !is_decimal(column) || PLACES.contains(&column.type_scale());
    is_plain && is_scaled && column.max_rep_level() == 0
}

/// What a column that is not read holds.
fn kind(column: &ColumnDescriptor) -> &'static str {
    match () {
        () if column.max_rep_level() > 0 => "list",
        () if is_decimal(column) => "decimal that is too long",
        () => "text or bytes",
    }
}

/// The first names of many, and how many more there are.
fn some(names: &[String]) -> String {
    let shown = names.iter().take(MAX_SHOWN).map(String::as_str).collect::<Vec<_>>().join(", ");
    match names.len().saturating_sub(MAX_SHOWN) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

/// Whether whole numbers of a column stand for decimals.
fn is_decimal(column: &ColumnDescriptor) -> bool {
    column.converted_type() == ConvertedType::DECIMAL
        || matches!(column.logical_type_ref(), Some(LogicalType::Decimal(_)))
}

/// The name of a column, with the unit of its stamps.
fn header(column: &ColumnDescriptor) -> String {
    let name = plain(&column.path().string());
    let unit = match column.logical_type_ref() {
        Some(LogicalType::Timestamp(of) | LogicalType::Time(of)) => match of.unit {
            TimeUnit::MILLIS => Some("ms"),
            TimeUnit::MICROS => Some("us"),
            TimeUnit::NANOS => Some("ns"),
        },
        _ if column.physical_type() == Type::INT96 => Some("ns"),
        _ => match column.converted_type() {
            ConvertedType::TIMESTAMP_MILLIS | ConvertedType::TIME_MILLIS => Some("ms"),
            ConvertedType::TIMESTAMP_MICROS | ConvertedType::TIME_MICROS => Some("us"),
            _ => None,
        },
    };
    match unit {
        Some(unit) if STAMPS.contains(&name.to_lowercase().as_str()) => format!("time [{unit}]"),
        Some(unit) => format!("{name} [{unit}]"),
        None => name,
    }
}

fn numbers(
    reader: &mut ColumnReader,
    column: &NumberColumn,
    n_rows: usize,
) -> Result<Vec<Option<f64>>, ParquetError> {
    use ColumnReader::{
        BoolColumnReader, DoubleColumnReader, FloatColumnReader, Int32ColumnReader,
        Int64ColumnReader, Int96ColumnReader,
    };
    let extent = (column.full, n_rows);
    let (is_unsigned, per_unit) = (column.is_unsigned, column.per_unit);
    match reader {
        BoolColumnReader(reader) => all(reader, extent, |value| f64::from(u8::from(*value))),
        Int32ColumnReader(reader) => all(reader, extent, |value| match is_unsigned {
            true => f64::from(value.cast_unsigned()),
            false => f64::from(*value) / per_unit,
        }),
        Int64ColumnReader(reader) => all(reader, extent, |value| match is_unsigned {
            true => value.cast_unsigned() as f64,
            false => *value as f64 / per_unit,
        }),
        Int96ColumnReader(reader) => all(reader, extent, |value| value.to_nanos() as f64),
        FloatColumnReader(reader) => all(reader, extent, |value| f64::from(*value)),
        DoubleColumnReader(reader) => all(reader, extent, |value| *value),
        _ => Ok(Vec::new()),
    }
}

/// The values of a column in all rows of a group; `None` where there is none.
///
/// - `full`: the level at which a value is there.
fn all<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    (full, n_rows): (i16, usize),
    to_number: impl Fn(&T::T) -> f64,
) -> Result<Vec<Option<f64>>, ParquetError> {
    let mut numbers: Vec<Option<f64>> = Vec::new();
    let (mut levels, mut values): (Vec<i16>, Vec<T::T>) = (Vec::new(), Vec::new());
    while numbers.len() < n_rows {
        levels.clear();
        values.clear();
        let most = BATCH.min(n_rows - numbers.len());
        let (n_records, ..) = reader.read_records(most, Some(&mut levels), None, &mut values)?;
        if n_records == 0 {
            break;
        }
        let mut next = values.iter().map(&to_number);
        match full {
            0 => numbers.extend(next.map(Some)),
            _ => {
                let number = |level: &i16| if *level == full { next.next() } else { None };
                numbers.extend(levels.iter().map(number));
            }
        }
    }
    Ok(numbers)
}

fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || c == '"' { ' ' } else { c }).take(120).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type, Int96, Int96Type};
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::parser::parse_message_type;

    use crate::data::{Channel, read_any_series};

    /// Spark writes stamps of 96 bits, databases decimals.
    #[test]
    fn stamps_of_96_bits_and_decimals_are_read() {
        let schema = "message log {
            required int96 time;
            required int64 x_m (DECIMAL(10,2));
            required double y_m;
        }";
        let schema = Arc::new(parse_message_type(schema).unwrap());
        let mut writer =
            SerializedFileWriter::new(Vec::<u8>::new(), schema, Arc::default()).unwrap();
        let mut group = writer.next_row_group().unwrap();
        // Nanoseconds of a day of 2025, which is counted as astronomers do.
        let stamps = [0, 500_000_000, 1_000_000_000].map(|ns| Int96::from(vec![ns, 0, 2_461_000]));
        let mut column = group.next_column().unwrap().unwrap();
        column.typed::<Int96Type>().write_batch(&stamps, None, None).unwrap();
        column.close().unwrap();
        let mut column = group.next_column().unwrap().unwrap();
        column.typed::<Int64Type>().write_batch(&[0, 1025, 2050], None, None).unwrap();
        column.close().unwrap();
        let mut column = group.next_column().unwrap().unwrap();
        column.typed::<DoubleType>().write_batch(&[0.0; 3], None, None).unwrap();
        column.close().unwrap();
        group.close().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.parquet");
        std::fs::write(&path, writer.into_inner().unwrap()).unwrap();
        let series = read_any_series(&path, None).unwrap().series;
        assert_eq!(series.require(Channel::X).unwrap(), [0.0, 10.25, 20.5]);
        let since_s = series.time_s()[2] - series.time_s()[0];
        assert!((since_s - 1.0).abs() < 1e-5, "{since_s}");
        assert!((series.time_s()[0] - 20_412.0 * 86_400.0).abs() < 1e-5);
    }

    /// A column that is missing in what is read is in the file, as text or as a decimal of 128 bits.
    #[test]
    fn an_error_names_the_columns_that_hold_no_numbers() {
        let read = |columns: &[&str]| {
            let schema = format!("message log {{ {} }}", columns.join(" "));
            let schema = Arc::new(parse_message_type(&schema).unwrap());
            let mut writer =
                SerializedFileWriter::new(Vec::<u8>::new(), schema, Arc::default()).unwrap();
            let mut group = writer.next_row_group().unwrap();
            for column in columns {
                let mut writer = group.next_column().unwrap().unwrap();
                let written = match column.contains("double") {
                    true => writer.typed::<DoubleType>().write_batch(&[0.0, 1.0], None, None),
                    false => {
                        let texts = ["0", "1"].map(ByteArray::from);
                        writer.typed::<ByteArrayType>().write_batch(&texts, None, None)
                    }
                };
                assert_eq!(written.unwrap(), 2);
                writer.close().unwrap();
            }
            group.close().unwrap();
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("log.parquet");
            std::fs::write(&path, writer.into_inner().unwrap()).unwrap();
            read_any_series(&path, None).unwrap_err().to_string()
        };
        let [text, decimal] =
            ["required binary x_m (UTF8);", "required binary y_m (DECIMAL(38,2));"];
        let error = read(&["required double time_s;", "required double q;", text, decimal]);
        for expected in
            ["\"x_m (text or bytes), not read\"", "\"y_m (decimal that is too long), not read\""]
        {
            assert!(error.contains(expected), "{error}");
        }
        let error = read(&[text]);
        assert!(error.contains("(its columns: x_m (text or bytes))"), "{error}");
    }
}
