//! Records of Fortran in a file: the number of bytes, the bytes, and their number again, big endian.

use crate::data::formats::fem::legend::plain_title;

/// The records of a file, and where the next one begins.
pub(super) struct Records<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
}

/// What is wrong, and at which byte.
pub(super) type Wrong = (usize, String);

impl<'a> Records<'a> {
    /// The next record; `None` at the end, also within a record.
    pub(super) fn next(&mut self) -> Result<Option<&'a [u8]>, Wrong> {
        let at = self.at;
        let mark = |at| word(self.bytes, at).map(i32::from_be_bytes);
        let Some(length) = mark(at) else { return Ok(None) };
        let length = usize::try_from(length);
        let length =
            length.map_err(|error| (at, format!("a record of a length that is none: {error}")))?;
        let end = at.saturating_add(4).saturating_add(length);
        let (Some(record), Some(after)) = (self.bytes.get(at + 4..end), mark(end)) else {
            return Ok(None);
        };
        if usize::try_from(after) != Ok(length) {
            return Err((
                at,
                format!("a record of {length} bytes at its start and {after} at its end"),
            ));
        }
        self.at = end + 4;
        Ok(Some(record))
    }

    /// The next record, of which something is said in front of the states.
    pub(super) fn needed(&mut self, what: &str) -> Result<Record<'a>, Wrong> {
        let at = self.at;
        let bytes = self.next()?.ok_or_else(|| (at, format!("the file ends before {what}")))?;
        Ok(Record { bytes, at })
    }
}

/// A record with its place.
#[derive(Clone, Copy)]
pub(super) struct Record<'a> {
    pub bytes: &'a [u8],
    at: usize,
}

impl Record<'_> {
    pub(super) fn integer(&self, idx: usize) -> Result<i32, Wrong> {
        self.integer_at(4 * idx)
    }

    fn integer_at(&self, from: usize) -> Result<i32, Wrong> {
        let n = self.bytes.len();
        let number = word(self.bytes, from).map(i32::from_be_bytes);
        number.ok_or_else(|| (self.at, format!("a record of {n} bytes only")))
    }

    /// A number of things.
    pub(super) fn count(&self, idx: usize) -> Result<usize, Wrong> {
        self.count_at(4 * idx)
    }

    pub(super) fn count_at(&self, from: usize) -> Result<usize, Wrong> {
        let number = self.integer_at(from)?;
        usize::try_from(number).map_err(|error| (self.at, format!("a number of {number}: {error}")))
    }

    pub(super) fn codes(&self) -> Vec<i32> {
        words(self.bytes).map(i32::from_be_bytes).collect()
    }

    pub(super) fn title(&self, from: usize, length: usize) -> String {
        let bytes = self.bytes.get(from..from + length).unwrap_or_default();
        plain_title(&encoding_rs::WINDOWS_1252.decode_without_bom_handling(bytes).0)
    }
}

/// A real number, by its place among the numbers of a record; NaN beyond its end.
pub(super) fn float(record: &[u8], at: usize) -> f64 {
    let bytes = word(record, at.saturating_mul(4));
    bytes.map_or(f64::NAN, |bytes| f64::from(f32::from_be_bytes(bytes)))
}

/// The four bytes from a place on.
pub(super) fn word(bytes: &[u8], at: usize) -> Option<[u8; 4]> {
    bytes.get(at..at.checked_add(4)?)?.try_into().ok()
}

fn words(bytes: &[u8]) -> impl Iterator<Item = [u8; 4]> + '_ {
    (0..bytes.len() / 4).filter_map(|idx| word(bytes, 4 * idx))
}
