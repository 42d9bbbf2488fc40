//! The objects of a TDMS file: their names, properties and types of values. Where they are in the bytes is
//! described in [`tdms_file`](super::tdms_file).

use std::collections::BTreeMap;

use crate::data::formats::bytes::{Cursor, Encoding, Fault, Order, bits};

/// A stamp: seconds since 1904 and parts of 2⁻⁶⁴ s.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stamp {
    pub seconds: i64,
    pub parts: u64,
}

impl Stamp {
    pub(super) fn parse(bytes: &[u8], order: Order) -> Self {
        // In both orders it is one number of 128 bits.
        let bits = bits(bytes, order);
        Self { seconds: (bits >> 64) as u64 as i64, parts: bits as u64 }
    }

    /// Time after another stamp, s.
    pub(super) fn after_s(self, other: Self) -> f64 {
        let parts = (self.parts as f64 - other.parts as f64) / 2.0_f64.powi(64);
        self.seconds.wrapping_sub(other.seconds) as f64 + parts
    }
}

/// What a value is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A number of so many bytes.
    Number(Encoding, usize),
    Stamp,
    Text,
    /// Something else of so many bytes.
    Other(usize),
}

impl Kind {
    pub(super) fn from_code(code: u32) -> Option<Self> {
        Some(match code {
            0 => Self::Other(0),
            1..=4 => Self::Number(Encoding::Signed, 1 << (code - 1)),
            5..=8 => Self::Number(Encoding::Unsigned, 1 << (code - 5)),
            9 | 0x19 => Self::Number(Encoding::Float, 4),
            10 | 0x1a => Self::Number(Encoding::Float, 8),
            0x20 => Self::Text,
            0x21 => Self::Number(Encoding::Unsigned, 1),
            0x44 => Self::Stamp,
            0x08_000c => Self::Other(8),
            0x10_000d => Self::Other(16),
            _ => return None,
        })
    }

    /// Bytes of a value; texts have none of their own.
    pub(super) fn n_bytes(self) -> usize {
        match self {
            Self::Number(_, n_bytes) | Self::Other(n_bytes) => n_bytes,
            Self::Stamp => 16,
            Self::Text => 0,
        }
    }
}

/// A value of a property.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Property {
    Number(f64),
    Text(String),
    Stamp(Stamp),
}

/// A group or a channel.
#[derive(Debug, Clone)]
pub(super) struct Object {
    /// The names of the group and of the channel.
    pub path: Vec<String>,
    /// Kept properties by their names.
    pub properties: BTreeMap<String, Property>,
    /// What its values are, if it has any; `None` too if they change.
    pub kind: Option<Kind>,
    /// Number of its values in the whole file.
    pub n_values: u64,
    pub is_mixed: bool,
    pub index: Option<Index>,
}

impl Object {
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        match self.properties.get(name) {
            Some(Property::Number(number)) => Some(*number),
            _ => None,
        }
    }

    pub(super) fn text(&self, name: &str) -> Option<&str> {
        match self.properties.get(name) {
            Some(Property::Text(text)) => Some(text),
            _ => None,
        }
    }

    pub(super) fn stamp(&self, name: &str) -> Option<Stamp> {
        match self.properties.get(name) {
            Some(Property::Stamp(stamp)) => Some(*stamp),
            _ => None,
        }
    }
}

/// How the values of an object lie in a chunk of raw data.
#[derive(Debug, Clone, Copy)]
pub(super) struct Index {
    pub kind: Kind,
    pub n_values: u64,
    pub n_bytes: u64,
}

/// A text with its length before it.
pub(super) fn text<'a>(cursor: &mut Cursor<'a>) -> Result<&'a [u8], Fault> {
    let n_bytes = cursor.u32()? as usize;
    cursor.take(n_bytes)
}

pub(super) fn index(cursor: &mut Cursor<'_>) -> Result<Index, Fault> {
    let at = cursor.at();
    let code = cursor.u32()?;
    let kind = Kind::from_code(code).ok_or_else(|| {
        Fault::new(at, format!("values of the type {code:#x} are not read; export them as CSV"))
    })?;
    let (dimension, n_values) = (cursor.u32()?, cursor.u64()?);
    if dimension != 1 {
        return Err(Fault::new(at, format!("an object has {dimension} dimensions, expected 1")));
    }
    let n_bytes = match kind {
        Kind::Text => Some(cursor.u64()?),
        _ => n_values.checked_mul(kind.n_bytes() as u64),
    };
    let why = "an object says that it has more values than a file can hold";
    let n_bytes = n_bytes.ok_or_else(|| Fault::new(at, why))?;
    Ok(Index { kind, n_values, n_bytes })
}

/// The names in `/'group'/'channel'`.
pub(super) fn names(path: &str) -> Vec<String> {
    let (mut names, mut rest) = (Vec::new(), path);
    while let Some(start) = rest.strip_prefix("/'") {
        let (mut name, mut letters) = (String::new(), start.char_indices().peekable());
        let mut end = start.len();
        while let Some((at, letter)) = letters.next() {
            match letter {
                '\'' if letters.next_if(|(_, next)| *next == '\'').is_some() => name.push('\''),
                '\'' => {
                    end = at + 1;
                    break;
                }
                _ => name.push(letter),
            }
        }
        names.push(name);
        rest = start.get(end..).unwrap_or_default();
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_their_quotation_marks() {
        assert_eq!(names("/'a b'/'it''s'"), ["a b", "it's"]);
        assert_eq!(names("/'open"), ["open"]);
        assert!(names("/").is_empty());
    }

    #[test]
    fn stamps_are_one_number_in_both_orders() {
        let little = [[0, 0, 0, 0, 0, 0, 0, 0x80], [5, 0, 0, 0, 0, 0, 0, 0]].concat();
        let big: Vec<u8> = little.iter().rev().copied().collect();
        let stamp = Stamp { seconds: 5, parts: 1 << 63 };
        assert_eq!(Stamp::parse(&little, Order::Little), stamp);
        assert_eq!(Stamp::parse(&big, Order::Big), stamp);
        assert_eq!(stamp.after_s(Stamp { seconds: 3, parts: 0 }), 2.5);
    }
}
