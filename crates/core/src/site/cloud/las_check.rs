//! What the header of a LAS or LAZ file claims, compared with the size of the file.
//!
//! The reader sets memory aside for what the header says: records behind the points, entries of the table of
//! chunks, and layers of a chunk. Here each is found to be in the file first.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use las::point::Format;
use las::raw;
use laz::LazItemType;

use crate::data::{MAX_CLOUD_BYTES, open_file};
use crate::site::SiteError;
use crate::site::cloud::source::damaged;

/// Largest records beside the points, and largest layers of a chunk, bytes.
const MAX_RECORD_BYTES: u64 = 64 << 20;

/// Fewest bytes of a header, those of version 1.0.
const HEADER_BYTES: u64 = 227;

/// Bytes of the head of a record, and of one behind the points.
const RECORD_HEAD: u64 = 54;
const LATE_RECORD_HEAD: u64 = 60;

/// Fewest bits of a compressed point.
const POINTS_PER_BYTE: u64 = 8;

/// Fewest bytes of a chunk: its first point is not compressed.
const CHUNK_BYTES: u64 = 20;

/// A file whose header was read.
pub(super) struct CheckedHeader {
    read: BufReader<File>,
    header: raw::Header,
    bytes: u64,
    n_points: u64,
}

impl CheckedHeader {
    /// Reads the header and compares it with the file.
    ///
    /// # Errors
    /// [`SiteError::Cloud`], [`SiteError::Data`].
    pub fn read(path: &Path) -> Result<Self, SiteError> {
        let wrong = |error: &dyn std::fmt::Display| damaged(path, error);
        let (file, bytes) = open_file(path, MAX_CLOUD_BYTES)?;
        if bytes < HEADER_BYTES {
            let why = format!("it has {bytes} bytes, fewer than the {HEADER_BYTES} of a header");
            return Err(wrong(&why));
        }
        let mut read = BufReader::new(file);
        let header = raw::Header::read_from(&mut read).map_err(|error| wrong(&error))?;
        let n_large = header.large_file.map(|large| large.number_of_point_records);
        let n_points = match header.number_of_point_records {
            0 => n_large.unwrap_or(0),
            n => u64::from(n),
        };
        let mut checked = Self { read, header, bytes, n_points };
        checked.check_records().map_err(|why| wrong(&why))?;
        let format = Format::new(checked.header.point_data_record_format);
        match format.map_err(|error| wrong(&error))?.is_compressed {
            true => checked.check_compressed().map_err(|why| wrong(&why))?,
            false => checked.check_points().map_err(|why| wrong(&why))?,
        }
        Ok(checked)
    }

    /// Records before and behind the points.
    fn check_records(&mut self) -> Result<(), String> {
        let offset = u64::from(self.header.offset_to_point_data);
        if offset > self.bytes.min(MAX_RECORD_BYTES) {
            return Err(format!("its points begin at byte {offset}, the file has {}", self.bytes));
        }
        let n_records = u64::from(self.header.number_of_variable_length_records);
        if n_records * RECORD_HEAD > offset {
            return Err(format!("it says that it has {n_records} records before byte {offset}"));
        }
        let Some(late) = self.header.evlr else { return Ok(()) };
        let start = late.start_of_first_evlr;
        let length = self.number_at(start.saturating_add(20)).unwrap_or(u64::MAX);
        let end = start.saturating_add(LATE_RECORD_HEAD).saturating_add(length);
        if end > self.bytes || length > MAX_RECORD_BYTES {
            return Err(format!(
                "its record behind the points ends at byte {end}, the file has {}",
                self.bytes
            ));
        }
        Ok(())
    }

    /// Points that are not compressed.
    fn check_points(&self) -> Result<(), String> {
        let record = u64::from(self.header.point_data_record_length);
        let offset = u64::from(self.header.offset_to_point_data);
        let n = self.n_points;
        let end = n.checked_mul(record).and_then(|bytes| bytes.checked_add(offset));
        let Some(end) = end.filter(|end| *end <= self.bytes) else {
            let held = (self.bytes - offset) / record.max(1);
            return Err(format!("it says that it has {n} points, the file holds {held} at most"));
        };
        let late = self.header.evlr.map_or(end, |late| late.start_of_first_evlr);
        match late.saturating_sub(end) > MAX_RECORD_BYTES {
            true => {
                Err("there is too much between its points and the record behind them".to_owned())
            }
            false => Ok(()),
        }
    }

    /// The number of compressed points, and the table of their chunks.
    fn check_compressed(&mut self) -> Result<(), String> {
        let (n, bytes) = (self.n_points, self.bytes);
        if n > bytes.saturating_mul(POINTS_PER_BYTE) {
            return Err(format!("it says that it has {n} points in {bytes} bytes"));
        }
        let Some(table) = self.table_start() else { return Ok(()) };
        if table > bytes {
            return Err(format!(
                "its table of chunks begins at byte {table}, the file has {bytes}"
            ));
        }
        let n_chunks = self.number_at(table).map_or(0, |number| number >> 32);
        match n_chunks > bytes / CHUNK_BYTES {
            true => Err(format!("it says that it has {n_chunks} chunks in {bytes} bytes")),
            false => Ok(()),
        }
    }

    /// Where the table of chunks begins, as the reader finds it.
    fn table_start(&mut self) -> Option<u64> {
        let offset = u64::from(self.header.offset_to_point_data);
        let is_behind = |table: &u64| *table > offset && *table <= i64::MAX as u64;
        let stated = self.number_at(offset).filter(is_behind);
        stated.or_else(|| self.number_at(self.bytes.checked_sub(8)?).filter(is_behind))
    }

    /// The layers of all chunks of a layered file, each of which is read whole.
    ///
    /// - `header`: of the same file, with its records.
    ///
    /// # Errors
    /// [`SiteError::Cloud`].
    pub fn check_layers(&mut self, path: &Path, header: &las::Header) -> Result<(), SiteError> {
        if !header.point_format().is_compressed {
            return Ok(());
        }
        let wrong = |error: &dyn std::fmt::Display| damaged(path, error);
        let vlr = header.laz_vlr().map_err(|error| wrong(&error))?;
        let record = u64::from(self.header.point_data_record_length);
        if vlr.items_size() != record || record == 0 {
            return Err(wrong(&"the parts of its points have not the size of a point"));
        }
        let is_layered = vlr.items().iter().any(|item| item.version() >= 3);
        if !is_layered {
            return Ok(());
        }
        let n_layers: u64 = vlr.items().iter().map(|item| layers_of(item.item_type())).sum();
        let end = self.table_start().unwrap_or(self.bytes).min(self.bytes);
        let mut at = u64::from(self.header.offset_to_point_data) + 8;
        let sizes_at = record + 4;
        // The number of points of a chunk, and the sizes of its layers.
        let mut sizes = vec![0; usize::try_from(4 + 4 * n_layers).unwrap_or(0)];
        let mut n_points = 0;
        while at + sizes_at + 4 * n_layers <= end {
            let read = self.read.seek(SeekFrom::Start(at + record));
            read.and_then(|_| self.read.read_exact(&mut sizes)).map_err(|error| wrong(&error))?;
            let size =
                |bytes: &[u8]| u64::from(u32::from_le_bytes(bytes.try_into().unwrap_or_default()));
            let mut sizes = sizes.chunks_exact(4).map(size);
            n_points += sizes.next().unwrap_or(0);
            let layers: u64 = sizes.sum();
            at += sizes_at + 4 * n_layers + layers;
            if layers > MAX_RECORD_BYTES || at > end {
                return Err(wrong(&"the layers of a chunk are longer than the file"));
            }
        }
        if self.n_points > n_points {
            let said = self.n_points;
            let why = format!("it says that it has {said} points, its chunks have {n_points}");
            return Err(wrong(&why));
        }
        Ok(())
    }

    /// Eight bytes as a number; `None` beyond the end of the file.
    fn number_at(&mut self, at: u64) -> Option<u64> {
        let mut number = [0; 8];
        self.read.seek(SeekFrom::Start(at)).ok()?;
        self.read.read_exact(&mut number).ok()?;
        Some(u64::from_le_bytes(number))
    }
}

/// Number of layers of a part of a point.
fn layers_of(item: LazItemType) -> u64 {
    match item {
        LazItemType::Point14 => 9,
        LazItemType::RGB14 | LazItemType::WavePacket14 => 1,
        LazItemType::RGBNIR14 => 2,
        LazItemType::Byte14(n) => u64::from(n),
        LazItemType::Byte(_)
        | LazItemType::Point10
        | LazItemType::GpsTime
        | LazItemType::RGB12
        | LazItemType::WavePacket13 => 0,
    }
}
