//! The records of an MDF file ([`mdf_blocks`](super::mdf_blocks)).
//!
//! ```text
//! DT   bytes of records
//! DZ   data: 2 letters of the block that is packed, u8 kind (0 deflate, 1 transposed before), u8, u32 columns,
//!      u64 bytes unpacked, u64 bytes packed, these
//! HL   links: first DL
//! DL   links: next, then the blocks DT or DZ whose bytes follow each other
//! ```
//!
//! Transposed bytes: of a table of so many columns the first column, then the second one; what is left at its
//! end stays as it is. A record may begin with the id of its group; texts of variable length then have their
//! length (u32) before them.

use std::borrow::Cow;
use std::io::Read;

use flate2::bufread::ZlibDecoder;

use crate::data::budget::MAX_TABLE_BYTES;
use crate::data::formats::bytes::{Cursor, Fault, Order, bits, number};
use crate::data::formats::mdf_blocks::{Block, MdfChannel, MdfGroup, Source};

/// Bytes to which any file may be unpacked, and how many more for each of its bytes.
const FREE_BYTES: usize = 4 << 20;
const UNPACKED_PER_BYTE: usize = 64;
/// Blocks of data of a group.
const MAX_BLOCKS: usize = 1 << 20;

/// Records of a group among the bytes of its data.
pub(super) struct Records<'a> {
    bytes: Cow<'a, [u8]>,
    /// Where each begins.
    starts: Vec<u32>,
    n_bytes: usize,
    /// Bytes at the end that are no whole record.
    pub n_bytes_cut: usize,
}

impl<'a> Records<'a> {
    /// # Errors
    /// [`Fault`] where a block is damaged or of another kind, or it unpacks to too much.
    pub(super) fn read(file: &'a [u8], group: &MdfGroup) -> Result<Self, Fault> {
        let bytes: Cow<'a, [u8]> = match group.data {
            Some(at) => data(file, at)?,
            None => Cow::Borrowed(&[]),
        };
        let data_at = group.data.and_then(|at| usize::try_from(at).ok()).unwrap_or(0);
        let n_bytes = group.sizes.get(&group.id).copied().flatten().unwrap_or(0);
        let (mut starts, mut at) = (Vec::new(), 0);
        while at < bytes.len() && n_bytes > 0 {
            let mut cursor = Cursor::new(&bytes, at, Order::Little);
            let Ok(id) = cursor.take(group.id_bytes) else { break };
            let id = bits(id, Order::Little) as u64;
            let id = if group.id_bytes == 0 { group.id } else { id };
            let size = match group.sizes.get(&id) {
                Some(Some(size)) => *size,
                Some(None) => match cursor.u32() {
                    Ok(size) => size as usize,
                    Err(_) => break,
                },
                None => {
                    let why = format!("a record has the id {id}, which no group has");
                    return Err(Fault::new(data_at, why));
                }
            };
            let start = cursor.at();
            let Some(end) = start.checked_add(size).filter(|end| *end <= bytes.len()) else {
                break;
            };
            if id == group.id {
                starts.push(start as u32);
            }
            at = end;
        }
        let n_bytes_cut = bytes.len().saturating_sub(at);
        Ok(Self { bytes, starts, n_bytes, n_bytes_cut })
    }

    pub(super) fn len(&self) -> usize {
        self.starts.len()
    }

    /// The number of a channel in a record; `None` if it is invalid there.
    pub(super) fn value(&self, row: usize, group: &MdfGroup, channel: &MdfChannel) -> Option<f64> {
        let start = *self.starts.get(row)? as usize;
        let record = self.bytes.get(start..start.checked_add(self.n_bytes)?)?;
        if let Some(bit) = channel.invalid_bit {
            let byte = record.get(group.n_bytes.checked_add(bit / 8)?)?;
            if (byte >> (bit % 8)) & 1 == 1 {
                return None;
            }
        }
        let raw = match channel.source {
            Source::Count => row as f64,
            Source::Bits { byte, bit, n_bits, encoding, order } => {
                let n_bytes = (bit + n_bits).div_ceil(8) as usize;
                let own = record.get(byte..byte.checked_add(n_bytes)?)?;
                number(encoding, (bits(own, order) >> bit) as u64, n_bits)?
            }
        };
        let [intercept, slope] = channel.line;
        Some(intercept + slope * raw)
    }
}

/// The bytes of a block of data, or of a list of them.
fn data(file: &[u8], at: u64) -> Result<Cow<'_, [u8]>, Fault> {
    let limit = FREE_BYTES.saturating_add(UNPACKED_PER_BYTE.saturating_mul(file.len()));
    let limit = limit.min(usize::try_from(MAX_TABLE_BYTES).unwrap_or(usize::MAX));
    let mut block = Block::at(file, at)?;
    if block.id == *b"DT" {
        return Ok(Cow::Borrowed(block.data));
    }
    let mut unpacked = Vec::new();
    if block.id == *b"HL" {
        let Some(list) = block.link(0) else { return Ok(Cow::Owned(unpacked)) };
        block = Block::at(file, list)?;
    }
    if block.id != *b"DL" {
        add(&block, limit, &mut unpacked)?;
        return Ok(Cow::Owned(unpacked));
    }
    let mut n_blocks = 0;
    let too_many =
        |block: &Block<'_>| Fault::new(block.at, format!("more than {MAX_BLOCKS} blocks of data"));
    loop {
        for idx in 1..block.n_links() {
            let Some(at) = block.link(idx) else { continue };
            add(&Block::at(file, at)?, limit, &mut unpacked)?;
            n_blocks += 1;
            if n_blocks > MAX_BLOCKS {
                return Err(too_many(&block));
            }
        }
        n_blocks += 1;
        if n_blocks > MAX_BLOCKS {
            return Err(too_many(&block));
        }
        let Some(next) = block.link(0) else { return Ok(Cow::Owned(unpacked)) };
        block = Block::at(file, next)?;
        if block.id != *b"DL" {
            return Err(Fault::new(block.at, "expected the block DL here"));
        }
    }
}

/// Adds the bytes of a block of data.
fn add(block: &Block<'_>, limit: usize, to: &mut Vec<u8>) -> Result<(), Fault> {
    let too_large =
        || Fault::new(block.at, format!("its data unpack to more than {limit} bytes; thin it out"));
    let left = limit.saturating_sub(to.len());
    match &block.id {
        b"DT" if block.data.len() <= left => {
            to.extend_from_slice(block.data);
            Ok(())
        }
        b"DT" => Err(too_large()),
        b"DZ" => {
            let mut cursor = block.cursor();
            let in_block = |fault: Fault| Fault { at: block.data_at + fault.at, ..fault };
            let packed = Packed::parse(&mut cursor).map_err(in_block)?;
            if packed.n_unpacked > left as u64 {
                return Err(too_large());
            }
            let unpacked = packed.unpack().map_err(|why| Fault::new(block.at, why))?;
            to.extend_from_slice(&unpacked);
            Ok(())
        }
        id => {
            let name = String::from_utf8_lossy(&id[..]).into_owned();
            let why = format!("data in blocks {} are not read", name.escape_default());
            Err(Fault::new(block.at, why))
        }
    }
}

/// A packed block of data.
struct Packed<'a> {
    of: [u8; 2],
    kind: u8,
    n_columns: usize,
    n_unpacked: u64,
    bytes: &'a [u8],
}

impl<'a> Packed<'a> {
    fn parse(cursor: &mut Cursor<'a>) -> Result<Self, Fault> {
        let at = cursor.at();
        let &[first, second] = cursor.take(2)? else {
            return Err(Fault::new(at, "the file ends too early"));
        };
        let kind = cursor.byte()?;
        cursor.byte()?;
        let n_columns = cursor.u32()? as usize;
        let (n_unpacked, n_packed) = (cursor.u64()?, cursor.u64()?);
        let bytes = cursor.take(usize::try_from(n_packed).unwrap_or(usize::MAX))?;
        Ok(Self { of: [first, second], kind, n_columns, n_unpacked, bytes })
    }

    /// # Errors
    /// What is wrong, in words.
    fn unpack(&self) -> Result<Vec<u8>, String> {
        if self.of != *b"DT" || self.kind > 1 {
            return Err("it is packed in a way that is not read".to_owned());
        }
        let mut unpacked = Vec::new();
        // One byte more, so that more than was said is found.
        let mut decoder = ZlibDecoder::new(self.bytes).take(self.n_unpacked.saturating_add(1));
        decoder.read_to_end(&mut unpacked).map_err(|error| format!("it is damaged ({error})"))?;
        if unpacked.len() as u64 != self.n_unpacked {
            return Err("it does not unpack to as many bytes as it says".to_owned());
        }
        Ok(match self.kind {
            0 => unpacked,
            _ => untransposed(&unpacked, self.n_columns),
        })
    }
}

/// The rows of a table that stands column by column.
fn untransposed(bytes: &[u8], n_columns: usize) -> Vec<u8> {
    let n_rows = bytes.len().checked_div(n_columns).unwrap_or(0);
    let (table, rest) = bytes.split_at_checked(n_rows * n_columns).unwrap_or_default();
    let cell = |row: usize, column: usize| table.get(column * n_rows + row).copied();
    let rows = (0..n_rows).flat_map(|row| (0..n_columns).filter_map(move |of| cell(row, of)));
    rows.chain(rest.iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_become_rows_and_the_rest_stays() {
        assert_eq!(untransposed(b"adbecfxy", 3), b"abcdefxy");
        assert_eq!(untransposed(b"ab", 0), b"ab");
        assert_eq!(untransposed(b"ab", 5), b"ab");
    }
}
