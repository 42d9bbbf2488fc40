//! Rows as Parquet files, which the same rows always give the same bytes.
//!
//! A row group for each chunk, compressed by zstd, numbers with their bytes in streams; no time, no name of
//! a machine. What the columns mean stands in the metadata.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use parquet::basic::{
    Compression, ConvertedType, Encoding, LogicalType, Repetition, Type as PhysicalType, ZstdLevel,
};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::{FileMetaData, KeyValue};
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{ColumnDescPtr, ColumnPath, PrimitiveTypeBuilder, Type, TypePtr};

use crate::rows::{Column, Rows, RowsMeta};
use crate::{Plan, SweepError};
use impactlab_core::data::open_file;
use impactlab_core::numerics::sha256_hex;

/// Column of the numbers of the rows.
const ROW: &str = "row";

/// Column of what restricts the answers of rows.
pub(crate) const CAVEATS: &str = "caveats";

/// Column of the reasons of rows that failed.
const REASON: &str = "reason";

/// What a file has the digests of its row groups under: compressed pages have no sum of their own.
const DIGEST: &str = "rows_sha256";

/// Level of zstd.
const ZSTD_LEVEL: i32 = 3;

/// Largest file that is read at once, bytes.
const MOST_BYTES: u64 = 1 << 32;

/// Most rows that are read at once.
const MOST_ROWS: i64 = 50_000_000;

/// Most columns of a table, and most numbers in it: eight gigabytes of them.
const MOST_COLUMNS: usize = 10_000;
const MOST_NUMBERS: i64 = 1 << 30;

/// The file of a chunk in the folder of a sweep.
pub fn chunk_path(folder: &Path, chunk: u64) -> PathBuf {
    folder.join(format!("part-{chunk:06}.parquet"))
}

/// What is written to, and taken out again as it grows.
#[derive(Clone, Default)]
struct Buffer(Arc<Mutex<Vec<u8>>>);

impl Buffer {
    fn take(&self) -> Vec<u8> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Write for Buffer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes tables one after the other, each as a row group of one file.
pub(crate) struct RowsWriter {
    buffer: Buffer,
    writer: SerializedFileWriter<Buffer>,
    digests: Vec<String>,
}

impl RowsWriter {
    /// - `like`: a table with the columns; its metadata are those of the file.
    pub fn new(like: &Rows) -> Result<Self, ParquetError> {
        let buffer = Buffer::default();
        let properties = Arc::new(properties(like)?);
        let writer = SerializedFileWriter::new(buffer.clone(), schema(like)?, properties)?;
        Ok(Self { buffer, writer, digests: Vec::new() })
    }

    /// Adds rows, and gives the bytes that are due.
    pub fn add(&mut self, rows: &Rows) -> Result<Vec<u8>, ParquetError> {
        let mut group = self.writer.next_row_group()?;
        let index: Vec<i64> =
            rows.index.iter().map(|&index| i64::try_from(index).unwrap_or(i64::MAX)).collect();
        put::<Int64Type>(&mut group, &index)?;
        for column in rows.columns() {
            put::<DoubleType>(&mut group, &column.values)?;
        }
        for texts in rows.caveats.iter().chain([&rows.reasons]) {
            let texts: Vec<ByteArray> =
                texts.iter().map(|text| ByteArray::from(text.as_str())).collect();
            put::<ByteArrayType>(&mut group, &texts)?;
        }
        group.close()?;
        self.digests.push(rows.sha256(0..rows.len()));
        self.writer.flush().map_err(|error| ParquetError::External(Box::new(error)))?;
        Ok(self.buffer.take())
    }

    /// The last bytes.
    pub fn finish(mut self) -> Result<Vec<u8>, ParquetError> {
        let digest = digest_of(&self.digests);
        self.writer.append_key_value_metadata(KeyValue::new(DIGEST.to_owned(), digest));
        self.writer.close()?;
        Ok(self.buffer.take())
    }
}

/// One digest of those of all row groups.
fn digest_of(groups: &[String]) -> String {
    sha256_hex(groups.iter().map(String::as_bytes))
}

fn put<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Buffer>,
    values: &[T::T],
) -> Result<(), ParquetError> {
    let missing = || ParquetError::General("there is one column too many".to_owned());
    let mut column = group.next_column()?.ok_or_else(missing)?;
    column.typed::<T>().write_batch(values, None, None)?;
    column.close()
}

/// One table as the bytes of a file.
///
/// # Errors
/// [`SweepError::Encode`].
pub fn rows_bytes(rows: &Rows) -> Result<Vec<u8>, SweepError> {
    let mut writer = RowsWriter::new(rows)?;
    let mut bytes = writer.add(rows)?;
    bytes.extend(writer.finish()?);
    Ok(bytes)
}

fn required(name: &str, kind: PhysicalType) -> PrimitiveTypeBuilder<'_> {
    Type::primitive_type_builder(name, kind).with_repetition(Repetition::REQUIRED)
}

fn schema(rows: &Rows) -> Result<TypePtr, ParquetError> {
    let mut fields = vec![Arc::new(required(ROW, PhysicalType::INT64).build()?)];
    for column in rows.columns() {
        fields.push(Arc::new(required(&column.name, PhysicalType::DOUBLE).build()?));
    }
    for name in rows.caveats.as_ref().map(|_| CAVEATS).into_iter().chain([REASON]) {
        let text = required(name, PhysicalType::BYTE_ARRAY)
            .with_converted_type(ConvertedType::UTF8)
            .with_logical_type(Some(LogicalType::String));
        fields.push(Arc::new(text.build()?));
    }
    Ok(Arc::new(Type::group_type_builder("rows").with_fields(fields).build()?))
}

fn properties(rows: &Rows) -> Result<WriterProperties, ParquetError> {
    let RowsMeta { plan_sha256, program, chunk, networks } = &rows.meta;
    let units: BTreeMap<&str, &str> =
        rows.columns().map(|column| (column.name.as_str(), column.unit.as_str())).collect();
    let inputs: Vec<&str> = rows.inputs.iter().map(|column| column.name.as_str()).collect();
    let json = |text: serde_json::Result<String>| {
        text.map_err(|error| ParquetError::External(Box::new(error)))
    };
    let pairs = [
        ("plan_sha256", plan_sha256.clone()),
        ("program", program.clone()),
        ("chunk", chunk.map_or_else(|| "all".to_owned(), |chunk| chunk.to_string())),
        ("units", json(serde_json::to_string(&units))?),
        ("inputs", json(serde_json::to_string(&inputs))?),
        ("networks", json(serde_json::to_string(networks))?),
    ];
    let pairs = Vec::from(pairs.map(|(key, value)| KeyValue::new(key.to_owned(), value)));
    let mut builder = WriterProperties::builder()
        .set_created_by("impactlab".to_owned())
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(ZSTD_LEVEL)?))
        .set_dictionary_enabled(false)
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_max_row_group_row_count(None)
        .set_key_value_metadata(Some(pairs))
        .set_column_encoding(ColumnPath::from(ROW), Encoding::DELTA_BINARY_PACKED)
        .set_column_dictionary_enabled(ColumnPath::from(REASON), true);
    if rows.caveats.is_some() {
        builder = builder.set_column_dictionary_enabled(ColumnPath::from(CAVEATS), true);
    }
    for column in rows.columns() {
        let path = ColumnPath::new(vec![column.name.clone()]);
        builder = builder.set_column_encoding(path, Encoding::BYTE_STREAM_SPLIT);
    }
    Ok(builder.build())
}

/// Reads a table of rows: a chunk, or all chunks merged.
///
/// # Errors
/// [`SweepError::Rows`] says what is wrong with the file; [`SweepError::Data`] if it cannot be opened.
pub fn read_rows(path: &Path) -> Result<Rows, SweepError> {
    let wrong = |what: String| SweepError::Rows { path: path.to_owned(), what };
    let (file, _) = open_file(path, MOST_BYTES)?;
    read_file(file).map_err(|error| wrong(error.to_string()))
}

fn refused(what: &str) -> ParquetError {
    ParquetError::General(what.to_owned())
}

/// What a table says of itself.
struct Stated {
    /// Units of the columns of numbers, by their names.
    units: BTreeMap<String, String>,
    /// Names of the inputs.
    inputs: Vec<String>,
    meta: RowsMeta,
    /// Digest of the rows; none in tables of former programs.
    digest: Option<String>,
}

impl Stated {
    fn read(metadata: &FileMetaData) -> Result<Self, ParquetError> {
        let pairs = metadata.key_value_metadata().into_iter().flatten();
        let pairs: BTreeMap<&str, &str> =
            pairs.filter_map(|it| Some((it.key.as_str(), it.value.as_deref()?))).collect();
        let stated =
            |key: &str| pairs.get(key).copied().ok_or_else(|| refused(&format!("no {key}")));
        let json = |error: serde_json::Error| ParquetError::External(Box::new(error));
        let meta = RowsMeta {
            plan_sha256: stated("plan_sha256")?.to_owned(),
            program: stated("program")?.to_owned(),
            chunk: match stated("chunk")? {
                "all" => None,
                chunk => {
                    let number = chunk.parse().ok();
                    Some(number.ok_or_else(|| refused("a chunk without a number"))?)
                }
            },
            networks: serde_json::from_str(stated("networks")?).map_err(json)?,
        };
        let units = serde_json::from_str(stated("units")?).map_err(json)?;
        let inputs = serde_json::from_str(stated("inputs")?).map_err(json)?;
        let digest = stated(DIGEST).ok().map(str::to_owned);
        Ok(Self { units, inputs, meta, digest })
    }
}

fn read_file(file: File) -> Result<Rows, ParquetError> {
    let reader = SerializedFileReader::new(file)?;
    let metadata = reader.metadata().file_metadata();
    let n_rows = metadata.num_rows();
    if !(0..=MOST_ROWS).contains(&n_rows) {
        return Err(refused(&format!("{n_rows} rows, expected at most {MOST_ROWS}")));
    }
    let Stated { units, inputs: input_names, meta, digest } = Stated::read(metadata)?;
    let schema = metadata.schema_descr();
    let names: Vec<String> =
        schema.columns().iter().map(|column| column.name().to_owned()).collect();
    let is_rows = names.first().is_some_and(|it| it == ROW)
        && names.last().is_some_and(|it| it == REASON)
        && schema.columns().iter().all(|column| column.max_def_level() == 0);
    if !is_rows || names.len() > MOST_COLUMNS {
        return Err(refused("other columns than those of a sweep"));
    }
    let is_of_caveats = |column: &ColumnDescPtr| {
        column.name() == CAVEATS && column.physical_type() == PhysicalType::BYTE_ARRAY
    };
    // Tables of former programs have none.
    let has_caveats = schema.columns().iter().nth_back(1).is_some_and(is_of_caveats);
    let n_numbers = names.len() - 2 - usize::from(has_caveats);
    if n_rows.saturating_mul(n_numbers as i64) > MOST_NUMBERS {
        return Err(refused("more numbers than are read at once; read its chunks one by one"));
    }
    let mut index: Vec<i64> = Vec::new();
    let mut numbers: Vec<Vec<f64>> = vec![Vec::new(); n_numbers];
    let (mut caveats, mut reasons): (Vec<ByteArray>, Vec<ByteArray>) = (Vec::new(), Vec::new());
    let mut groups = Vec::new();
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        let left = n_rows - index.len() as i64;
        let n = Some(group.metadata().num_rows()).filter(|n| (0..=left).contains(n));
        let n = n.ok_or_else(|| refused("more rows than it says"))? as usize;
        groups.push(index.len()..index.len() + n);
        take::<Int64Type>(&*group, 0, n, &mut index)?;
        for (idx, values) in numbers.iter_mut().enumerate() {
            take::<DoubleType>(&*group, idx + 1, n, values)?;
        }
        if has_caveats {
            take::<ByteArrayType>(&*group, n_numbers + 1, n, &mut caveats)?;
        }
        take::<ByteArrayType>(&*group, names.len() - 1, n, &mut reasons)?;
    }
    if index.len() as i64 != n_rows {
        return Err(refused("fewer rows than it says"));
    }
    let index: Option<Vec<u64>> = index.into_iter().map(|row| u64::try_from(row).ok()).collect();
    let index = index.ok_or_else(|| refused("a row with a negative number"))?;
    let caveats = has_caveats.then(|| texts(&caveats)).transpose()?;
    let reasons = texts(&reasons)?;
    let numbers = names.get(1..=n_numbers).unwrap_or_default().iter().zip(numbers);
    let columns = numbers.map(|(name, values)| {
        let unit = units.get(name).cloned().unwrap_or_else(|| "1".to_owned());
        Column { name: name.clone(), unit, values }
    });
    let (inputs, outcomes) = columns.partition(|column| input_names.contains(&column.name));
    let rows = Rows { inputs, outcomes, index, caveats, reasons, meta };
    if let Some(digest) = digest {
        let of_groups: Vec<String> = groups.into_iter().map(|group| rows.sha256(group)).collect();
        if digest_of(&of_groups) != digest {
            return Err(refused("it has other rows than were written"));
        }
    }
    Ok(rows)
}

/// A column of texts.
fn texts(column: &[ByteArray]) -> Result<Vec<String>, ParquetError> {
    column.iter().map(|text| text.as_utf8().map(str::to_owned)).collect()
}

/// Reads one column of a row group.
fn take<T: DataType>(
    group: &dyn RowGroupReader,
    idx: usize,
    n: usize,
    values: &mut Vec<T::T>,
) -> Result<(), ParquetError> {
    let reader: ColumnReader = group.get_column_reader(idx)?;
    let Some(mut reader): Option<ColumnReaderImpl<T>> = T::get_column_reader(reader) else {
        return Err(refused("a column of another type"));
    };
    let before = values.len();
    while values.len() - before < n {
        let (_, read, _) = reader.read_records(n - (values.len() - before), None, None, values)?;
        if read == 0 {
            return Err(refused("a column that ends early"));
        }
    }
    Ok(())
}

/// Reads the chunk of a plan, and checks that it is that and whole.
///
/// # Errors
/// [`SweepError::Rows`] says what is wrong.
pub fn read_chunk(folder: &Path, plan: &Plan, chunk: u64) -> Result<Rows, SweepError> {
    let path = chunk_path(folder, chunk);
    let rows = read_rows(&path)?;
    match chunk_fault(&rows, plan, chunk) {
        None => Ok(rows),
        Some(what) => Err(SweepError::Rows { path, what }),
    }
}

/// What is wrong with a chunk; `None` if nothing is.
fn chunk_fault(rows: &Rows, plan: &Plan, chunk: u64) -> Option<String> {
    let sha256 = plan.sha256();
    if rows.meta.plan_sha256 != sha256 {
        return Some(format!("it is of plan {}, not of {sha256}", rows.meta.plan_sha256));
    }
    if rows.meta.chunk != Some(chunk) {
        return Some(format!("it is chunk {:?}, not {chunk}", rows.meta.chunk));
    }
    if rows.meta.program != plan.program || rows.meta.networks != plan.networks {
        return Some("another program or other networks have answered".to_owned());
    }
    let expected = plan.rows_of(chunk);
    if !rows.index.iter().copied().eq(expected.clone()) {
        return Some(format!(
            "it has {} rows, not those from {} to {}",
            rows.len(),
            expected.start,
            expected.end.saturating_sub(1)
        ));
    }
    let inputs = plan.vary.iter().map(|vary| vary.name.as_str());
    let outcomes = plan.outcomes();
    let names = inputs.chain(outcomes.iter().map(|(name, _)| name.as_str()));
    let is_same = rows.columns().map(|column| column.name.as_str()).eq(names);
    (!is_same).then(|| "it has other columns".to_owned())
}

#[cfg(test)]
mod tests {
    use rand::Rng as _;

    use super::*;
    use impactlab_core::numerics::random_stream;

    fn rows() -> Rows {
        let column = |name: &str, unit: &str, values: Vec<f64>| Column {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values,
        };
        Rows {
            inputs: vec![column("speed_m_s", "m/s", vec![1.5, 2.5, -0.0])],
            outcomes: vec![column("x_m", "m", vec![1e300, f64::NAN, 3.0])],
            index: vec![4, 5, 6],
            caveats: Some(vec!["wheel_lift;not_at_rest".to_owned(), String::new(), String::new()]),
            reasons: vec![String::new(), "the vehicles do not meet".to_owned(), String::new()],
            meta: RowsMeta {
                plan_sha256: "ab".to_owned(),
                program: "0".to_owned(),
                chunk: Some(2),
                networks: BTreeMap::from([("force".to_owned(), "cd".to_owned())]),
            },
        }
    }

    #[test]
    fn rows_come_back_to_the_bit_and_have_the_same_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.parquet");
        let bytes = rows_bytes(&rows()).unwrap();
        assert_eq!(bytes, rows_bytes(&rows()).unwrap());
        std::fs::write(&path, &bytes).unwrap();
        let read = read_rows(&path).unwrap();
        let bits = |rows: &Rows| -> Vec<u64> {
            rows.columns().flat_map(|column| column.values.iter().map(|it| it.to_bits())).collect()
        };
        assert_eq!(bits(&read), bits(&rows()));
        assert_eq!((&read.index, &read.reasons), (&rows().index, &rows().reasons));
        assert_eq!(read.caveats, rows().caveats);
        assert_eq!((read.meta.clone(), read.n_failed()), (rows().meta, 1));
        assert_eq!(read.inputs[0].unit, "m/s");
        assert_eq!(read.column("x_m").map(|column| column.values[2]), Some(3.0));
    }

    #[test]
    fn a_table_without_caveats_is_read_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.parquet");
        let former = Rows { caveats: None, ..rows() };
        std::fs::write(&path, rows_bytes(&former).unwrap()).unwrap();
        let read = read_rows(&path).unwrap();
        assert_eq!((read.caveats, read.reasons), (None, former.reasons));
        assert_eq!(read.outcomes.len(), 1);
        // An outcome of that name, as a former program had it, is one.
        let mut named = Rows { caveats: None, ..rows() };
        named.outcomes[0].name = CAVEATS.to_owned();
        std::fs::write(&path, rows_bytes(&named).unwrap()).unwrap();
        let read = read_rows(&path).unwrap();
        assert_eq!((read.caveats, read.outcomes[0].values[2]), (None, 3.0));
    }

    /// A row with a number that nothing has computed was one like any other.
    #[test]
    fn a_bit_that_has_turned_in_the_numbers_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.parquet");
        let mut rng = random_stream(5, "numbers that cannot be compressed", 0);
        let values: Vec<f64> = (0..200).map(|_| f64::from_bits(rng.next_u64())).collect();
        // The lowest bytes of all numbers stand together, as they are.
        let lowest: Vec<u8> = values.iter().map(|value| value.to_bits() as u8).collect();
        let mut table = Rows {
            index: (0..200).collect(),
            caveats: None,
            reasons: vec![String::new(); 200],
            ..rows()
        };
        table.inputs[0].values = values;
        table.outcomes[0].values = vec![0.0; 200];
        let mut bytes = rows_bytes(&table).unwrap();
        std::fs::write(&path, &bytes).unwrap();
        assert_eq!(read_rows(&path).unwrap().index, table.index);
        let at = bytes.windows(lowest.len()).position(|window| window == lowest).unwrap();
        bytes[at + 77] ^= 1;
        std::fs::write(&path, &bytes).unwrap();
        let refused = read_rows(&path).unwrap_err().to_string();
        assert!(refused.ends_with("it has other rows than were written"), "{refused}");
    }

    #[test]
    fn a_file_that_was_cut_off_or_changed_is_no_table() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.parquet");
        let bytes = rows_bytes(&rows()).unwrap();
        for n in [0, 3, bytes.len() / 2, bytes.len() - 1] {
            std::fs::write(&path, &bytes[..n]).unwrap();
            assert!(matches!(read_rows(&path), Err(SweepError::Rows { .. })), "{n}");
        }
    }
}
