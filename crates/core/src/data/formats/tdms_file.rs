//! The segments of a TDMS file (LabVIEW, DIAdem, FlexLogger): its objects, their properties and where their
//! numbers are.
//!
//! ```text
//! segment   "TDSm", u32 flags (always little endian), u32 version, u64 length behind this head (all bits
//!           set where the program died), u64 length of the metadata, metadata, raw data
//! flags     2 has metadata, 4 a new list of objects, 8 has raw data, 32 interleaved, 64 big endian, 128 DAQmx
//! metadata  u32 objects, each: text path, u32 length of the index or 0xffffffff for no data, 0 for the same
//!           index as before, 0x1269 and 0x126a for DAQmx; index: u32 type, u32 1, u64 values, (u64 bytes of
//!           texts); u32 properties, each: text name, u32 type, value
//! text      u32 length, UTF-8;  path  /'group'/'channel', a quotation mark twice
//! raw data  the values of all objects of the list, one object after the other, again and again until the
//!           segment ends; interleaved: a value of each object, again and again
//! types     1 to 4 i8 … i64, 5 to 8 u8 … u64, 9 f32, 10 f64 (0x19, 0x1a with units), 0x20 text, 0x21 switch,
//!           0x44 stamp: u64 parts of 2⁻⁶⁴ s, i64 seconds since 1904 (in the other order in big endian)
//! ```
//!
//! A segment without metadata, or without a new list, goes on with the objects of the one before. A file is
//! passed through twice, first for its objects, then for the values that are wanted; nothing is set aside by
//! what the file says of its sizes.

use std::collections::BTreeMap;

use crate::data::formats::bytes::{Cursor, Fault, Order, bits, number};
use crate::data::formats::tdms_objects::{
    Index, Kind, Object, Property, Stamp, index, names, text,
};

const HEAD_BYTES: usize = 28;
const HAS_METADATA: u32 = 1 << 1;
const HAS_NEW_LIST: u32 = 1 << 2;
const HAS_DATA: u32 = 1 << 3;
const IS_INTERLEAVED: u32 = 1 << 5;
const IS_BIG: u32 = 1 << 6;
const IS_DAQMX: u32 = 1 << 7;

const NO_DATA: u32 = u32::MAX;
const SAME_INDEX: u32 = 0;

/// Objects of a file.
const MAX_OBJECTS: usize = 8192;
/// Steps over the objects of all segments with metadata.
const MAX_STEPS: usize = 100_000_000;

/// Beginnings of the names of properties that are kept.
const KEPT: [&str; 4] = ["wf_", "unit_string", "NI_Scal", "NI_Number_Of_Scales"];

const DAQMX: &str = "the file has raw data of DAQmx, which are not read; save its scaled values, or export the \
     channels as CSV";

/// A file with its objects.
pub(super) struct TdmsFile<'a> {
    bytes: &'a [u8],
    pub objects: Vec<Object>,
    /// Bytes of raw data or of a segment that are not whole, at the end of a segment.
    pub n_bytes_cut: u64,
    /// Whether the last segment was not finished.
    pub is_cut: bool,
}

/// A value as it is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Cell {
    Number(f64),
    Stamp(Stamp),
}

/// The segments of a file in their order.
struct Walk<'a> {
    bytes: &'a [u8],
    objects: Vec<Object>,
    by_path: BTreeMap<Vec<u8>, usize>,
    /// Objects with raw data, by their indices.
    list: Vec<(usize, Index)>,
    /// Where in the list each object is, if it is there.
    place: Vec<usize>,
    n_steps: usize,
    n_bytes_cut: u64,
    is_cut: bool,
}

/// Raw data of a segment.
struct Raw<'a, 'b> {
    data: &'a [u8],
    list: &'b [(usize, Index)],
    order: Order,
    is_interleaved: bool,
    /// Bytes after which the list begins again.
    chunk: usize,
}

impl<'a> TdmsFile<'a> {
    /// # Errors
    /// [`Fault`] where the file does not follow its format, or has data that are not read.
    pub(super) fn parse(bytes: &'a [u8]) -> Result<Self, Fault> {
        let mut counts: Vec<u64> = Vec::new();
        let walk = Walk::run(bytes, &mut |raw| {
            for (object, index) in raw.list {
                if counts.len() <= *object {
                    counts.resize(object + 1, 0);
                }
                let n = match raw.is_interleaved {
                    true => raw.n_chunks() as u64,
                    false => index.n_values.saturating_mul(raw.n_chunks() as u64),
                };
                if let Some(count) = counts.get_mut(*object) {
                    *count = count.saturating_add(n);
                }
            }
        })?;
        let mut objects = walk.objects;
        for (object, n_values) in objects.iter_mut().zip(counts) {
            object.n_values = n_values;
        }
        Ok(Self { bytes, objects, n_bytes_cut: walk.n_bytes_cut, is_cut: walk.is_cut })
    }

    /// The values of some objects, in their order.
    ///
    /// # Errors
    /// As for [`Self::parse`].
    pub(super) fn values(&self, wanted: &[usize]) -> Result<Vec<Vec<Cell>>, Fault> {
        let mut column: Vec<Option<usize>> = vec![None; self.objects.len()];
        for (idx, object) in wanted.iter().enumerate() {
            if let Some(slot) = column.get_mut(*object) {
                *slot = Some(idx);
            }
        }
        let mut values: Vec<Vec<Cell>> = vec![Vec::new(); wanted.len()];
        Walk::run(self.bytes, &mut |raw| {
            raw.each(&mut |object, cell| {
                let column = column.get(object).copied().flatten();
                if let Some(values) = column.and_then(|column| values.get_mut(column)) {
                    values.push(cell);
                }
            });
        })?;
        Ok(values)
    }
}

impl Raw<'_, '_> {
    fn n_chunks(&self) -> usize {
        self.data.len() / self.chunk
    }

    /// Gives the numbers and stamps of all whole chunks.
    fn each(&self, take: &mut dyn FnMut(usize, Cell)) {
        for chunk in self.data.chunks_exact(self.chunk) {
            let mut rest = chunk;
            for (object, index) in self.list {
                let n_bytes = match self.is_interleaved {
                    true => index.kind.n_bytes(),
                    false => index.n_bytes as usize,
                };
                let Some((own, after)) = rest.split_at_checked(n_bytes) else { return };
                rest = after;
                match index.kind {
                    Kind::Number(encoding, size) => {
                        for value in own.chunks_exact(size) {
                            let bits = bits(value, self.order) as u64;
                            let number = number(encoding, bits, 8 * size as u32);
                            take(*object, Cell::Number(number.unwrap_or(f64::NAN)));
                        }
                    }
                    Kind::Stamp => {
                        for value in own.chunks_exact(16) {
                            take(*object, Cell::Stamp(Stamp::parse(value, self.order)));
                        }
                    }
                    Kind::Text | Kind::Other(_) => {}
                }
            }
        }
    }
}

impl<'a> Walk<'a> {
    fn run(bytes: &'a [u8], visit: &mut dyn FnMut(&Raw<'_, '_>)) -> Result<Self, Fault> {
        let mut walk = Self {
            bytes,
            objects: Vec::new(),
            by_path: BTreeMap::new(),
            list: Vec::new(),
            place: Vec::new(),
            n_steps: 0,
            n_bytes_cut: 0,
            is_cut: false,
        };
        let mut at = 0;
        while at < bytes.len() {
            at = walk.segment(at, visit)?;
        }
        Ok(walk)
    }

    /// Reads the segment at a byte.
    ///
    /// - returns where the next one begins.
    fn segment(&mut self, at: usize, visit: &mut dyn FnMut(&Raw<'_, '_>)) -> Result<usize, Fault> {
        let n_bytes = self.bytes.len();
        if at > 0 && n_bytes - at < HEAD_BYTES {
            self.n_bytes_cut += (n_bytes - at) as u64;
            return Ok(n_bytes);
        }
        let mut head = Cursor::new(self.bytes, at, Order::Little);
        if head.take(4)? != b"TDSm" {
            return Err(Fault::new(at, "expected a segment of TDMS here, which begins with TDSm"));
        }
        let flags = head.u32()?;
        let order = if flags & IS_BIG == 0 { Order::Little } else { Order::Big };
        let mut head = Cursor::new(self.bytes, head.at(), order);
        let (_version, length, metadata) = (head.u32()?, head.u64()?, head.u64()?);
        let begin = head.at();
        let until = |length: u64| begin.checked_add(usize::try_from(length).ok()?);
        let stated = until(length).filter(|end| *end <= n_bytes);
        self.is_cut |= stated.is_none();
        let end = stated.unwrap_or(n_bytes);
        let data_at = until(metadata).filter(|data_at| *data_at <= end);
        let Some(data_at) = data_at else {
            if at > 0 && end == n_bytes {
                self.n_bytes_cut += (n_bytes - at) as u64;
                return Ok(n_bytes);
            }
            return Err(Fault::new(at, "the metadata of the segment are longer than the segment"));
        };
        if flags & IS_DAQMX != 0 {
            return Err(Fault::new(at, DAQMX));
        }
        if flags & HAS_METADATA != 0 {
            let bytes = self.bytes.get(..data_at).unwrap_or_default();
            self.metadata(Cursor::new(bytes, begin, order), flags & HAS_NEW_LIST != 0)?;
        }
        if flags & HAS_DATA != 0 {
            let data = self.bytes.get(data_at..end).unwrap_or_default();
            self.data(data, (data_at, order), flags & IS_INTERLEAVED != 0, visit)?;
        }
        Ok(end)
    }

    fn metadata(&mut self, mut cursor: Cursor<'a>, is_new: bool) -> Result<(), Fault> {
        if is_new {
            self.list.clear();
        }
        let n_objects = cursor.u32()?;
        for _ in 0..n_objects {
            let at = cursor.at();
            let path = text(&mut cursor)?;
            let object = self.object(path, at)?;
            let at = cursor.at();
            let index = match cursor.u32()? {
                NO_DATA => None,
                SAME_INDEX => {
                    let known = self.objects.get(object).and_then(|object| object.index);
                    let why = "the object has no index before, of which this is to be the same";
                    Some(known.ok_or_else(|| Fault::new(at, why))?)
                }
                0x1269 | 0x126a => return Err(Fault::new(at, DAQMX)),
                _ => Some(index(&mut cursor)?),
            };
            self.put(object, index);
            let n_properties = cursor.u32()?;
            for _ in 0..n_properties {
                self.property(object, &mut cursor)?;
            }
            self.n_steps += 1;
            if self.n_steps > MAX_STEPS {
                let why = "the file has too many objects in its segments";
                return Err(Fault::new(cursor.at(), why));
            }
        }
        Ok(())
    }

    /// The index of the object of a path.
    fn object(&mut self, path: &[u8], at: usize) -> Result<usize, Fault> {
        if let Some(object) = self.by_path.get(path) {
            return Ok(*object);
        }
        let object = self.objects.len();
        if object == MAX_OBJECTS {
            return Err(Fault::new(at, format!("the file has more than {MAX_OBJECTS} objects")));
        }
        self.by_path.insert(path.to_owned(), object);
        self.place.push(usize::MAX);
        self.objects.push(Object {
            path: names(&String::from_utf8_lossy(path)),
            properties: BTreeMap::new(),
            kind: None,
            n_values: 0,
            is_mixed: false,
            index: None,
        });
        Ok(object)
    }

    /// Puts an object into the list, or takes it out of it.
    fn put(&mut self, idx: usize, index: Option<Index>) {
        let Some(object) = self.objects.get_mut(idx) else { return };
        let index = index.inspect(|index| {
            object.index = Some(*index);
            object.is_mixed |= object.kind.is_some_and(|kind| kind != index.kind);
            object.kind = Some(index.kind).filter(|_| !object.is_mixed);
        });
        // Without a byte it would be passed for nothing, again and again.
        let index = index.filter(|index| index.n_bytes > 0);
        let place = self.place.get(idx).copied().unwrap_or(usize::MAX);
        let is_listed = self.list.get(place).is_some_and(|(object, _)| *object == idx);
        match (is_listed, index) {
            (true, Some(index)) => {
                if let Some(own) = self.list.get_mut(place) {
                    own.1 = index;
                }
            }
            (false, Some(index)) => {
                if let Some(place) = self.place.get_mut(idx) {
                    *place = self.list.len();
                }
                self.list.push((idx, index));
            }
            (true, None) => {
                self.n_steps += self.list.len();
                self.list.remove(place);
                for (at, (object, _)) in self.list.iter().enumerate().skip(place) {
                    if let Some(place) = self.place.get_mut(*object) {
                        *place = at;
                    }
                }
            }
            (false, None) => {}
        }
    }

    fn property(&mut self, object: usize, cursor: &mut Cursor<'a>) -> Result<(), Fault> {
        let name = String::from_utf8_lossy(text(cursor)?);
        let at = cursor.at();
        let order = cursor.order();
        let kind = Kind::from_code(cursor.u32()?);
        let value = match kind {
            Some(Kind::Text) => {
                let text = String::from_utf8_lossy(text(cursor)?);
                Some(Property::Text(text.chars().take(80).collect()))
            }
            Some(Kind::Stamp) => Some(Property::Stamp(Stamp::parse(cursor.take(16)?, order))),
            Some(Kind::Number(encoding, size)) => {
                let bits = bits(cursor.take(size)?, order) as u64;
                number(encoding, bits, 8 * size as u32).map(Property::Number)
            }
            Some(Kind::Other(size)) => {
                cursor.take(size)?;
                None
            }
            None => return Err(Fault::new(at, "a property of a type that is not known")),
        };
        let is_kept = KEPT.iter().any(|start| name.starts_with(start));
        if let Some((object, value)) = self.objects.get_mut(object).zip(value)
            && is_kept
        {
            object.properties.insert(name.into_owned(), value);
        }
        Ok(())
    }

    fn data(
        &mut self,
        data: &'a [u8],
        (at, order): (usize, Order),
        is_interleaved: bool,
        visit: &mut dyn FnMut(&Raw<'_, '_>),
    ) -> Result<(), Fault> {
        if data.is_empty() {
            return Ok(());
        }
        let lengths = self.list.iter().map(|(_, index)| match is_interleaved {
            true => index.kind.n_bytes() as u64,
            false => index.n_bytes,
        });
        let mut sum = 0_u64;
        for length in lengths {
            sum = sum.saturating_add(length);
            if sum > data.len() as u64 {
                break;
            }
        }
        let has_texts = self.list.iter().take(data.len()).any(|(_, of)| of.kind == Kind::Text);
        if is_interleaved && has_texts {
            return Err(Fault::new(at, "texts in interleaved data are not read"));
        }
        let chunk = usize::try_from(sum).ok().filter(|chunk| (1..=data.len()).contains(chunk));
        let Some(chunk) = chunk else {
            self.n_bytes_cut += data.len() as u64;
            return Ok(());
        };
        self.n_bytes_cut += (data.len() % chunk) as u64;
        visit(&Raw { data, list: &self.list, order, is_interleaved, chunk });
        Ok(())
    }
}
