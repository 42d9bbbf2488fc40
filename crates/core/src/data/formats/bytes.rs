//! Numbers in the bytes of binary files.

use std::path::Path;

use crate::data::{DataError, Place};

/// What is wrong with a file, at which byte, and why.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fault {
    /// Counted from 0.
    pub at: usize,
    /// In words.
    pub why: String,
}

impl Fault {
    pub(super) fn new(at: usize, why: impl Into<String>) -> Self {
        Self { at, why: why.into() }
    }

    pub(super) fn in_file(self, path: &Path) -> DataError {
        let (path, place) = (path.to_owned(), Place::Byte(self.at as u64));
        DataError::DamagedAt { path, place, why: self.why }
    }
}

/// The order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

/// How the bits of a number are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Unsigned,
    Signed,
    /// IEEE 754, of 32 or 64 bits.
    Float,
}

/// The bits of a number of at most 16 bytes.
pub(super) fn bits(bytes: &[u8], order: Order) -> u128 {
    let add = |sum: u128, byte: &u8| (sum << 8) | u128::from(*byte);
    match order {
        Order::Little => bytes.iter().rev().fold(0, add),
        Order::Big => bytes.iter().fold(0, add),
    }
}

/// The number that the lowest bits stand for; `None` for a float of another length.
pub(super) fn number(encoding: Encoding, bits: u64, n_bits: u32) -> Option<f64> {
    let above = 64_u32.checked_sub(n_bits).filter(|above| *above < 64)?;
    let cut = (bits << above) >> above;
    match (encoding, n_bits) {
        (Encoding::Unsigned, _) => Some(cut as f64),
        (Encoding::Signed, _) => Some((((bits << above) as i64) >> above) as f64),
        (Encoding::Float, 32) => Some(f64::from(f32::from_bits(cut as u32))),
        (Encoding::Float, 64) => Some(f64::from_bits(cut)),
        (Encoding::Float, _) => None,
    }
}

/// Bytes of a file that are taken one after the other.
#[derive(Debug, Clone)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    order: Order,
}

impl<'a> Cursor<'a> {
    /// - `bytes`: the file up to the end of what may be taken.
    pub(super) fn new(bytes: &'a [u8], at: usize, order: Order) -> Self {
        Self { bytes, at, order }
    }

    pub(super) fn at(&self) -> usize {
        self.at
    }

    pub(super) fn order(&self) -> Order {
        self.order
    }

    pub(super) fn take(&mut self, n_bytes: usize) -> Result<&'a [u8], Fault> {
        let end = self.at.checked_add(n_bytes);
        let taken = end.and_then(|end| self.bytes.get(self.at..end));
        let taken = taken.ok_or_else(|| Fault::new(self.at, "the file ends too early"))?;
        self.at += n_bytes;
        Ok(taken)
    }

    fn whole(&mut self, n_bytes: usize) -> Result<u64, Fault> {
        let order = self.order;
        Ok(bits(self.take(n_bytes)?, order) as u64)
    }

    pub(super) fn byte(&mut self) -> Result<u8, Fault> {
        Ok(self.whole(1)? as u8)
    }

    pub(super) fn u16(&mut self) -> Result<u16, Fault> {
        Ok(self.whole(2)? as u16)
    }

    pub(super) fn u32(&mut self) -> Result<u32, Fault> {
        Ok(self.whole(4)? as u32)
    }

    pub(super) fn u64(&mut self) -> Result<u64, Fault> {
        self.whole(8)
    }

    pub(super) fn f64(&mut self) -> Result<f64, Fault> {
        Ok(f64::from_bits(self.whole(8)?))
    }
}

/// A text without what would end a cell, a line or a part of a map, cut to a length that is shown.
pub(super) fn plain(text: &str) -> String {
    let is_mark = |c: char| c.is_control() || matches!(c, '"' | ',');
    let plain: String = text.chars().map(|c| if is_mark(c) { ' ' } else { c }).take(80).collect();
    plain.trim().to_owned()
}

/// The first of some names, and how many more there are.
pub(super) fn some(names: &[String]) -> String {
    let shown: Vec<&str> = names.iter().take(6).map(String::as_str).collect();
    match names.len().saturating_sub(shown.len()) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_their_signs_and_orders() {
        let of = |encoding, bytes: &[u8], order| {
            number(encoding, bits(bytes, order) as u64, 8 * bytes.len() as u32)
        };
        assert_eq!(of(Encoding::Signed, &[0xfe, 0xff], Order::Little), Some(-2.0));
        assert_eq!(of(Encoding::Unsigned, &[0xff, 0xfe], Order::Big), Some(65_534.0));
        assert_eq!(of(Encoding::Float, &1.5_f32.to_be_bytes(), Order::Big), Some(1.5));
        assert_eq!(of(Encoding::Float, &(-2.5_f64).to_le_bytes(), Order::Little), Some(-2.5));
        assert_eq!(of(Encoding::Float, &[0, 0], Order::Little), None);
        assert_eq!(number(Encoding::Signed, 0b1101, 3), Some(-3.0));
        assert_eq!(number(Encoding::Signed, u64::MAX, 64), Some(-1.0));
        assert_eq!(number(Encoding::Unsigned, 1, 0), None);
        let mut cursor = Cursor::new(&[1, 0, 0], 0, Order::Little);
        assert_eq!((cursor.u16(), cursor.at()), (Ok(1), 2));
        assert_eq!(cursor.u32().unwrap_err().at, 2);
    }
}
