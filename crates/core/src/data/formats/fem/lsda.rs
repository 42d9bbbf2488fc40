//! LSDA, the container of LS-DYNA's `binout`: named arrays in folders.
//!
//! ```text
//! header   u8 length of the header, of a length, of an offset, of a command, of a type;
//!          u8 1 for little endian; u8 0 for IEEE numbers; u8 0
//! record   length (itself included), command, body
//!          2: path of the folder of what follows, absolute or relative
//!          3: u8 type, u8 length of the name, name, values
//!          1, 4 to 7: nothing, variable, tables of symbols; they are not needed and skipped
//! types    1 to 4 i8 … i64, 5 to 8 u8 … u64, 9 f32, 10 f64, 11 link
//! ```
//!
//! One pass over folders and values reads everything. Only arrays that are asked for are held.

use std::io::{BufReader, Read};
use std::path::Path;

use crate::data::budget::{MAX_BINOUT_BYTES, MAX_TABLE_BYTES};
use crate::data::{DataError, Place, open_file};

/// Bytes of the header.
const HEAD_BYTES: usize = 8;

/// What an array takes beside its values, bytes: its name, and its place among others. A file may hold many that
/// are empty.
const ARRAY_BYTES: u64 = 128;

/// Longest path of a folder, bytes.
const MAX_PATH_BYTES: u64 = 4096;

const CHANGE_FOLDER: u64 = 2;
const VALUES: u64 = 3;
const LAST_COMMAND: u64 = 7;

/// Values of an array.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Values {
    /// Bytes, mostly letters.
    Bytes(Vec<u8>),
    Numbers(Vec<f64>),
}

impl Values {
    pub(super) fn into_numbers(self) -> Vec<f64> {
        match self {
            Self::Bytes(bytes) => bytes.into_iter().map(f64::from).collect(),
            Self::Numbers(numbers) => numbers,
        }
    }

    pub(super) fn into_bytes(self) -> Vec<u8> {
        match self {
            Self::Bytes(bytes) => bytes,
            Self::Numbers(_) => Vec::new(),
        }
    }
}

/// Sizes and order of the bytes of numbers.
#[derive(Debug, Clone, Copy)]
struct Layout {
    length_bytes: usize,
    command_bytes: usize,
    type_bytes: usize,
    is_little: bool,
}

impl Layout {
    fn from_head(head: &[u8]) -> Option<Self> {
        let &[8, length, offset, command, kind, endian, 0, _] = head.get(..HEAD_BYTES)? else {
            return None;
        };
        let is_size = |size: u8| matches!(size, 4 | 8);
        let is_small = |size: u8| matches!(size, 1 | 2 | 4);
        let is_head = is_size(length) && is_size(offset) && is_small(command) && is_small(kind);
        (is_head && endian <= 1).then_some(Self {
            length_bytes: usize::from(length),
            command_bytes: usize::from(command),
            type_bytes: usize::from(kind),
            is_little: endian == 1,
        })
    }

    fn unsigned(self, bytes: &[u8]) -> u64 {
        let add = |sum: u64, byte: &u8| (sum << 8) | u64::from(*byte);
        match self.is_little {
            true => bytes.iter().rev().fold(0, add),
            false => bytes.iter().fold(0, add),
        }
    }

    /// A number of a type of values; bytes are one after the other as in the file.
    fn number(self, kind: u64, bytes: &[u8]) -> f64 {
        let bits = self.unsigned(bytes);
        match kind {
            2 => f64::from(bits as u16 as i16),
            3 => f64::from(bits as u32 as i32),
            4 => bits as i64 as f64,
            9 => f64::from(f32::from_bits(bits as u32)),
            10 => f64::from_bits(bits),
            _ => bits as f64,
        }
    }
}

/// Whether the first bytes of a file are those of this format.
pub(super) fn is_lsda(head: &[u8]) -> bool {
    Layout::from_head(head).is_some()
}

/// Whether an array is held, by its folder and name.
type Wanted<'a> = dyn Fn(&[String], &str) -> bool + 'a;

/// A file that is read from its beginning to its end.
struct Reader<'a> {
    path: &'a Path,
    file: BufReader<std::fs::File>,
    layout: Layout,
    at: u64,
}

/// A named array.
pub(super) struct Array<'a> {
    /// The folders in which it stands, the outermost first.
    pub folder: &'a [String],
    pub name: &'a str,
    pub values: Values,
}

/// Reads the arrays of a file.
///
/// - `wanted`: whether an array is held, by its folder and name;
/// - `left`: how many bytes of values may be held; what is taken is subtracted;
/// - `take`: what is done with an array that is held; its error says what is wrong with it.
/// - returns whether the file ends within a record, as that of a run that was killed.
///
/// # Errors
/// [`DataError::DamagedAt`] with the place, [`DataError::TooLarge`].
pub(super) fn read(
    path: &Path,
    wanted: &Wanted<'_>,
    left: &mut u64,
    take: &mut dyn FnMut(Array<'_>) -> Result<(), String>,
) -> Result<bool, DataError> {
    let (file, size) = open_file(path, MAX_BINOUT_BYTES)?;
    let mut file = BufReader::new(file);
    let mut head = [0; HEAD_BYTES];
    let is_read = size >= HEAD_BYTES as u64;
    if is_read {
        file.read_exact(&mut head).map_err(|source| DataError::io(path, source))?;
    }
    let layout = Layout::from_head(&head).filter(|_| is_read).ok_or_else(|| {
        let why = "is no part of a binout, which begins with the header of LSDA".to_owned();
        DataError::DamagedAt { path: path.to_owned(), place: Place::Byte(0), why }
    })?;
    let mut reader = Reader { path, file, layout, at: HEAD_BYTES as u64 };
    let mut folder: Vec<String> = Vec::new();
    while reader.at < size {
        let (start, head_bytes) = (reader.at, layout.length_bytes + layout.command_bytes);
        if size - start < head_bytes as u64 {
            return Ok(true);
        }
        let length = reader.number(layout.length_bytes)?;
        let command = reader.number(layout.command_bytes)?;
        let body = match length.checked_sub(head_bytes as u64) {
            Some(body) => body,
            // A place that was made larger and never written.
            None if length == 0 => return Ok(true),
            None => return Err(reader.damaged(start, format!("a record of {length} bytes"))),
        };
        if body > size - reader.at {
            return Ok(true);
        }
        match command {
            CHANGE_FOLDER if body > MAX_PATH_BYTES => {
                return Err(reader.damaged(start, format!("a path of {body} bytes")));
            }
            CHANGE_FOLDER => {
                let bytes = reader.bytes(body)?;
                change(&mut folder, &String::from_utf8_lossy(&bytes));
            }
            VALUES => reader.array(body, (folder.as_slice(), wanted), left, take)?,
            1 | 4..=LAST_COMMAND => reader.skip(body)?,
            _ => return Err(reader.damaged(start, format!("a record with the command {command}"))),
        }
    }
    Ok(false)
}

/// Goes to a folder.
fn change(folder: &mut Vec<String>, path: &str) {
    let path = path.trim_end_matches('\0');
    if path.starts_with('/') {
        folder.clear();
    }
    for part in path.split('/').filter(|part| !matches!(*part, "" | ".")) {
        match part {
            ".." => drop(folder.pop()),
            name => folder.push(name.to_owned()),
        }
    }
}

impl Reader<'_> {
    fn damaged(&self, at: u64, why: String) -> DataError {
        let place = Place::Byte(at);
        DataError::DamagedAt { path: self.path.to_owned(), place, why }
    }

    /// Bytes that are known to be within the file.
    fn bytes(&mut self, n: u64) -> Result<Vec<u8>, DataError> {
        let mut bytes = Vec::new();
        let read = (&mut self.file).take(n).read_to_end(&mut bytes);
        let read = read.map_err(|source| DataError::io(self.path, source))? as u64;
        if read < n {
            return Err(self.damaged(self.at, "the file has become shorter".to_owned()));
        }
        self.at += n;
        Ok(bytes)
    }

    fn skip(&mut self, n: u64) -> Result<(), DataError> {
        let n_signed = i64::try_from(n).unwrap_or(i64::MAX);
        let sought = self.file.seek_relative(n_signed);
        sought.map_err(|source| DataError::io(self.path, source))?;
        self.at += n;
        Ok(())
    }

    fn number(&mut self, n_bytes: usize) -> Result<u64, DataError> {
        let bytes = self.bytes(n_bytes as u64)?;
        Ok(self.layout.unsigned(&bytes))
    }

    /// Reads an array, or skips it.
    fn array(
        &mut self,
        body: u64,
        (folder, wanted): (&[String], &Wanted<'_>),
        left: &mut u64,
        take: &mut dyn FnMut(Array<'_>) -> Result<(), String>,
    ) -> Result<(), DataError> {
        let start = self.at;
        let head = self.layout.type_bytes as u64 + 1;
        if body < head {
            return Err(self.damaged(start, format!("an array of {body} bytes")));
        }
        let kind = self.number(self.layout.type_bytes)?;
        let name_bytes = self.number(1)?;
        let Some(data_bytes) = (body - head).checked_sub(name_bytes) else {
            return Err(self.damaged(start, format!("a name of {name_bytes} bytes")));
        };
        let name = self.bytes(name_bytes)?;
        let name = String::from_utf8_lossy(&name);
        let Some(width) = width(kind).filter(|_| wanted(folder, &name)) else {
            return self.skip(data_bytes);
        };
        if data_bytes % width as u64 != 0 {
            let why = format!("{data_bytes} bytes of numbers of {width} bytes");
            return Err(self.damaged(start, why));
        }
        let held = ARRAY_BYTES + data_bytes / width as u64 * 8;
        *left = left.checked_sub(held).ok_or_else(|| {
            let (path, limit) = (self.path.to_owned(), MAX_TABLE_BYTES);
            DataError::TooLarge { path, bytes: limit + held, limit }
        })?;
        let bytes = self.bytes(data_bytes)?;
        let values = match width {
            1 => Values::Bytes(bytes),
            width => {
                let numbers = bytes.chunks_exact(width);
                Values::Numbers(numbers.map(|bytes| self.layout.number(kind, bytes)).collect())
            }
        };
        take(Array { folder, name: &name, values }).map_err(|why| self.damaged(start, why))
    }
}

/// Bytes of a number of a type of values; `None` for a type that is none.
fn width(kind: u64) -> Option<usize> {
    Some(match kind {
        1 | 5 => 1,
        2 | 6 => 2,
        3 | 7 | 9 => 4,
        4 | 8 | 10 => 8,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(command: u8, body: &[u8]) -> Vec<u8> {
        let length = 9 + body.len() as u64;
        [&length.to_le_bytes()[..], &[command], body].concat()
    }

    fn array(name: &str, kind: u8, values: &[u8]) -> Vec<u8> {
        record(3, &[&[kind, name.len() as u8][..], name.as_bytes(), values].concat())
    }

    const HEAD: [u8; 8] = [8, 8, 8, 1, 1, 1, 0, 0];

    fn walk(bytes: &[u8]) -> Result<(Vec<String>, bool), DataError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("binout");
        std::fs::write(&path, bytes).unwrap();
        let mut found = Vec::new();
        let mut left = 1 << 20;
        let is_cut = read(&path, &|_, name| name != "not", &mut left, &mut |array| {
            let Array { folder, name, values } = array;
            found.push(format!("/{}/{name} {values:?}", folder.join("/")));
            Ok(())
        })?;
        Ok((found, is_cut))
    }

    #[test]
    fn folders_are_followed_and_types_told_apart() {
        let file = [
            HEAD.to_vec(),
            record(2, b"/rcforc/metadata"),
            array("ids", 3, &[7_i32.to_le_bytes(), (-8_i32).to_le_bytes()].concat()),
            record(1, b"xx"),
            record(2, b"../d000001"),
            array("not", 10, &[0; 8]),
            array("x_force", 9, &1.5_f32.to_le_bytes()),
            array("title", 1, b"ab"),
            record(4, b"anything"),
        ]
        .concat();
        let (found, is_cut) = walk(&file).unwrap();
        assert_eq!(
            found,
            [
                "/rcforc/metadata/ids Numbers([7.0, -8.0])",
                "/rcforc/d000001/x_force Numbers([1.5])",
                "/rcforc/d000001/title Bytes([97, 98])",
            ]
        );
        assert!(!is_cut);
        assert!(walk(&file[..file.len() - 1]).unwrap().1);
        for bad in
            [record(9, b""), record(3, &[10]), record(3, &[10, 200, 1]), array("a", 10, b"1")]
        {
            let error = walk(&[&HEAD[..], &bad].concat()).unwrap_err().to_string();
            assert!(error.contains("binout: at byte "), "{error}");
        }
        assert!(walk(b"\x08\x08").is_err());
    }
}
