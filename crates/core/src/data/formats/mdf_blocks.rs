//! The blocks of an MDF file of version 4 (ASAM MDF, `.mf4`): groups of channels and what they are.
//!
//! ```text
//! head      "MDF     " ("UnFinMF " if it was not finished), text of the version, program, at byte 28 u16 of the
//!           version; at byte 64 the first block, HD; little endian
//! block     "##" and two letters, u32, u64 length (itself included), u64 links, the links (u64 places in the
//!           file, 0 for none), data
//! HD        links: first DG …
//! DG        links: next, first CG, data, comment; data: u8 bytes of the id of a record
//! CG        links: next, first CN, name, …; data: u64 id, u64 records, u16 flags (1 texts of variable length,
//!           8 times in another group), u16, u32, u32 bytes of a record, u32 bytes of invalidation bits behind
//! CN        links: next, composition, name, source, conversion, data, unit …; data: u8 kind (0 fixed, 2 master,
//!           3 and 6 counted), u8 of what it is master (1 time), u8 type, u8 first bit, u32 first byte, u32 bits,
//!           u32 flags (1 all invalid, 2 has an invalidation bit), u32 its place
//! type      0/1 whole, 2/3 with a sign, 4/5 float, each little and big endian; others are no numbers
//! CC        links: name, unit …; data: u8 kind (0 none, 1 line, 2 quotient), u8, u16, u16, u16 values, 2 f64, f64
//!           values: intercept, slope; of a quotient a, b, c, d, e, f of (a x² + b x + c) / (d x² + e x + f)
//! TX, MD    text that ends with 0; in MD as XML with the text in TX
//! ```

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::data::budget::MAX_COLUMNS;
use crate::data::formats::bytes::{Cursor, Encoding, Fault, Order, plain};

/// First bytes of finished and of other files.
const FINISHED: &[u8] = b"MDF     ";
const UNFINISHED: &[u8] = b"UnFinMF ";

const FIRST_BLOCK: u64 = 64;
const HEAD_BYTES: usize = 24;

/// Groups and channels of a file.
const MAX_GROUPS: usize = 16_384;
const MAX_CHANNELS: usize = 65_536;
/// Bytes of a text that are looked at.
const MAX_TEXT_BYTES: usize = 1024;

const HAS_VARIABLE_LENGTH: u16 = 1;
const HAS_REMOTE_TIME: u16 = 8;
const ALL_INVALID: u32 = 1;
const HAS_INVALID_BIT: u32 = 2;

/// What kind of file this is by its first bytes; `None` if it is no MDF file of version 4 that is finished.
pub(super) fn version(bytes: &[u8]) -> Option<u16> {
    let version = Cursor::new(bytes, 28, Order::Little).u16().ok()?;
    (bytes.starts_with(FINISHED) && (400..500).contains(&version)).then_some(version)
}

/// Whether a file begins as an MDF file does.
pub(super) fn is_mdf(first: &[u8]) -> bool {
    first.starts_with(FINISHED) || first.starts_with(UNFINISHED)
}

/// Whether it was not finished by its writer.
pub(super) fn is_unfinished(first: &[u8]) -> bool {
    first.starts_with(UNFINISHED)
}

/// A block of a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block<'a> {
    pub at: usize,
    /// Its letters, such as `DG`.
    pub id: [u8; 2],
    links: &'a [u8],
    pub data: &'a [u8],
    /// Where its data begin.
    pub data_at: usize,
}

impl<'a> Block<'a> {
    /// Reads the block at a place.
    ///
    /// # Errors
    /// [`Fault`] if none is there, or it is longer than the file.
    pub(super) fn at(bytes: &'a [u8], at: u64) -> Result<Self, Fault> {
        let at = usize::try_from(at).unwrap_or(usize::MAX);
        let mut cursor = Cursor::new(bytes, at, Order::Little);
        let &[b'#', b'#', first, second] = cursor.take(4)? else {
            return Err(Fault::new(at, "expected a block of MDF here, which begins with ##"));
        };
        let (_, length, n_links) = (cursor.u32()?, cursor.u64()?, cursor.u64()?);
        let why = "a block is longer than the file, or its links than the block";
        let fault = || Fault::new(at, why);
        let end = usize::try_from(length).ok().and_then(|length| at.checked_add(length));
        let body = bytes.get(at + HEAD_BYTES..end.ok_or_else(fault)?).ok_or_else(fault)?;
        let n_bytes = usize::try_from(n_links).ok().and_then(|links| links.checked_mul(8));
        let split = body.split_at_checked(n_bytes.ok_or_else(fault)?);
        let (links, data) = split.ok_or_else(fault)?;
        let data_at = at + HEAD_BYTES + links.len();
        Ok(Self { at, id: [first, second], links, data, data_at })
    }

    /// A link, if it leads anywhere.
    pub(super) fn link(&self, idx: usize) -> Option<u64> {
        let at = idx.checked_mul(8)?;
        let link = Cursor::new(self.links, at, Order::Little).u64().ok()?;
        (link != 0).then_some(link)
    }

    pub(super) fn n_links(&self) -> usize {
        self.links.len() / 8
    }

    pub(super) fn cursor(&self) -> Cursor<'a> {
        Cursor::new(self.data, 0, Order::Little)
    }

    /// The block to which a link leads, if it is one of these letters.
    fn linked(&self, bytes: &'a [u8], idx: usize, id: [u8; 2]) -> Option<Self> {
        let block = Self::at(bytes, self.link(idx)?).ok()?;
        (block.id == id).then_some(block)
    }
}

/// How the numbers of a channel are found in a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Source {
    /// In these bits.
    Bits { byte: usize, bit: u32, n_bits: u32, encoding: Encoding, order: Order },
    /// The number of the record, from 0.
    Count,
}

/// A channel of numbers.
#[derive(Debug, Clone)]
pub(super) struct MdfChannel {
    /// Its name with its unit.
    pub header: String,
    pub is_time: bool,
    pub source: Source,
    /// The place of its invalidation bit behind the record.
    pub invalid_bit: Option<usize>,
    /// Intercept and slope.
    pub line: [f64; 2],
}

/// Bytes of a record by its id; `None` for one that says its length itself.
pub(super) type RecordSizes = BTreeMap<u64, Option<usize>>;

/// A group of channels over one time.
#[derive(Debug, Clone)]
pub(super) struct MdfGroup {
    pub name: String,
    /// Where its data are.
    pub data: Option<u64>,
    /// Bytes of the id before each record; 0 if the group has its data for itself.
    pub id_bytes: usize,
    pub id: u64,
    /// All records among those of this group.
    pub sizes: Rc<RecordSizes>,
    /// Bytes of a record before its invalidation bits.
    pub n_bytes: usize,
    /// Records as the file says.
    pub n_records: u64,
    pub channels: Vec<MdfChannel>,
    /// Channels that are no numbers or not read, each with the reason.
    pub left_out: Vec<String>,
}

/// The groups of a file, and those that are left out.
///
/// # Errors
/// [`Fault`] where a block is damaged.
pub(super) fn groups(bytes: &[u8]) -> Result<(Vec<MdfGroup>, Vec<String>), Fault> {
    let head = Block::at(bytes, FIRST_BLOCK)?;
    if head.id != *b"HD" {
        return Err(Fault::new(head.at, "expected the block HD here"));
    }
    let (mut groups, mut left_out, mut n_groups, mut n_channels) = (Vec::new(), Vec::new(), 0, 0);
    for of_data in chain(bytes, head.link(0), *b"DG", MAX_GROUPS)? {
        let id_bytes = usize::from(of_data.cursor().byte()?);
        if !matches!(id_bytes, 0 | 1 | 2 | 4 | 8) {
            return Err(Fault::new(of_data.data_at, "an id of a record has 0, 1, 2, 4 or 8 bytes"));
        }
        let blocks = chain(bytes, of_data.link(1), *b"CG", MAX_GROUPS)?;
        let heads: Vec<GroupHead> =
            blocks.iter().map(GroupHead::parse).collect::<Result<_, _>>()?;
        let sizes: RecordSizes = heads.iter().map(|head| (head.id, head.size())).collect();
        let is_one = id_bytes > 0 || heads.len() <= 1;
        if sizes.len() != heads.len() || !is_one {
            let why = "records of several groups are here whose ids do not tell them apart; sort the file";
            return Err(Fault::new(of_data.at, why));
        }
        let sizes = Rc::new(sizes);
        for (block, head) in blocks.iter().zip(&heads) {
            n_groups += 1;
            if n_groups > MAX_GROUPS {
                let why = format!("the file has more than {MAX_GROUPS} groups");
                return Err(Fault::new(block.at, why));
            }
            if head.flags & HAS_VARIABLE_LENGTH != 0 {
                continue;
            }
            let own = block.linked(bytes, 2, *b"TX").map(|block| text(&block)).unwrap_or_default();
            let name = format!("group {n_groups} {own}").trim_end().to_owned();
            if head.flags & HAS_REMOTE_TIME != 0 {
                left_out.push(format!("{name} (its times are in another group)"));
                continue;
            }
            let mut group = MdfGroup {
                name,
                data: of_data.link(2),
                id_bytes,
                id: head.id,
                sizes: Rc::clone(&sizes),
                n_bytes: head.n_bytes,
                n_records: head.n_records,
                channels: Vec::new(),
                left_out: Vec::new(),
            };
            for channel in chain(bytes, block.link(1), *b"CN", MAX_COLUMNS)? {
                n_channels += 1;
                if n_channels > MAX_CHANNELS {
                    let why = format!("the file has more than {MAX_CHANNELS} channels");
                    return Err(Fault::new(channel.at, why));
                }
                group.add(bytes, &channel, head)?;
            }
            groups.push(group);
        }
    }
    Ok((groups, left_out))
}

/// Blocks of which each leads to the next one.
fn chain(
    bytes: &[u8],
    mut next: Option<u64>,
    id: [u8; 2],
    limit: usize,
) -> Result<Vec<Block<'_>>, Fault> {
    let mut blocks = Vec::new();
    while let Some(at) = next {
        let block = Block::at(bytes, at)?;
        let name = String::from_utf8_lossy(&id);
        if block.id != id {
            return Err(Fault::new(block.at, format!("expected the block {name} here")));
        }
        if blocks.len() == limit {
            let why = format!("more than {limit} blocks {name} follow each other");
            return Err(Fault::new(block.at, why));
        }
        next = block.link(0);
        blocks.push(block);
    }
    Ok(blocks)
}

/// What a block CG says.
struct GroupHead {
    id: u64,
    n_records: u64,
    flags: u16,
    n_bytes: usize,
    n_invalid_bytes: usize,
}

impl GroupHead {
    fn parse(block: &Block<'_>) -> Result<Self, Fault> {
        let mut cursor = block.cursor();
        let in_block = |fault: Fault| Fault { at: block.data_at + fault.at, ..fault };
        let mut read = || -> Result<Self, Fault> {
            let (id, n_records, flags) = (cursor.u64()?, cursor.u64()?, cursor.u16()?);
            cursor.take(6)?;
            let (n_bytes, n_invalid_bytes) = (cursor.u32()? as usize, cursor.u32()? as usize);
            Ok(Self { id, n_records, flags, n_bytes, n_invalid_bytes })
        };
        read().map_err(in_block)
    }

    fn size(&self) -> Option<usize> {
        let has_own = self.flags & HAS_VARIABLE_LENGTH != 0;
        (!has_own).then_some(self.n_bytes.saturating_add(self.n_invalid_bytes))
    }
}

/// What a block CN says.
struct ChannelHead {
    kind: u8,
    master_of: u8,
    data_type: u8,
    bit: u32,
    byte: usize,
    n_bits: u32,
    flags: u32,
    invalid_bit: usize,
}

impl ChannelHead {
    fn parse(block: &Block<'_>) -> Result<Self, Fault> {
        let mut cursor = block.cursor();
        let in_block = |fault: Fault| Fault { at: block.data_at + fault.at, ..fault };
        let mut read = || -> Result<Self, Fault> {
            Ok(Self {
                kind: cursor.byte()?,
                master_of: cursor.byte()?,
                data_type: cursor.byte()?,
                bit: u32::from(cursor.byte()?),
                byte: cursor.u32()? as usize,
                n_bits: cursor.u32()?,
                flags: cursor.u32()?,
                invalid_bit: cursor.u32()? as usize,
            })
        };
        read().map_err(in_block)
    }

    /// # Errors
    /// Why it has no numbers that are read.
    fn source(&self, group: &GroupHead) -> Result<Source, &'static str> {
        match self.kind {
            0 | 2 => {}
            3 | 6 => return Ok(Source::Count),
            1 => return Err("values of variable length"),
            _ => return Err("another kind of channel"),
        }
        let (encoding, order) = match self.data_type {
            0 => (Encoding::Unsigned, Order::Little),
            1 => (Encoding::Unsigned, Order::Big),
            2 => (Encoding::Signed, Order::Little),
            3 => (Encoding::Signed, Order::Big),
            4 => (Encoding::Float, Order::Little),
            5 => (Encoding::Float, Order::Big),
            6..=9 => return Err("texts"),
            _ => return Err("no plain numbers"),
        };
        let is_length = match encoding {
            Encoding::Float => matches!(self.n_bits, 32 | 64),
            _ => (1..=64).contains(&self.n_bits),
        };
        if !is_length || self.bit > 7 {
            return Err("numbers of another length");
        }
        let n_bytes = (self.bit + self.n_bits).div_ceil(8) as usize;
        if self.byte.checked_add(n_bytes).is_none_or(|end| end > group.n_bytes) {
            return Err("beyond its record");
        }
        let (byte, bit, n_bits) = (self.byte, self.bit, self.n_bits);
        Ok(Source::Bits { byte, bit, n_bits, encoding, order })
    }
}

impl MdfGroup {
    fn add(&mut self, bytes: &[u8], block: &Block<'_>, group: &GroupHead) -> Result<(), Fault> {
        let head = ChannelHead::parse(block)?;
        let name = block.linked(bytes, 2, *b"TX").map(|block| text(&block)).unwrap_or_default();
        let name = if name.is_empty() { format!("channel {}", block.at) } else { name };
        let conversion = match block.link(4) {
            Some(at) => Some(Block::at(bytes, at)?),
            None => None,
        };
        let line = conversion.map_or(Ok([0.0, 1.0]), |block| line(&block));
        let found = match (head.source(group), line) {
            _ if block.link(1).is_some() => Err("a structure or an array"),
            _ if head.flags & ALL_INVALID != 0 => Err("all of its samples are invalid"),
            (Ok(source), Ok(line)) => Ok((source, line)),
            (Err(why), _) | (_, Err(why)) => Err(why),
        };
        let (source, line) = match found {
            Ok(found) => found,
            Err(why) => {
                self.left_out.push(format!("{name} ({why})"));
                return Ok(());
            }
        };
        let is_time = matches!(head.kind, 2 | 3) && head.master_of == 1;
        let unit = unit(bytes, block, conversion.as_ref());
        let header = match (is_time, unit.is_empty()) {
            (true, true) => "time [s]".to_owned(),
            (true, false) => format!("time [{unit}]"),
            (false, true) => name,
            (false, false) => format!("{name} [{unit}]"),
        };
        let invalid_bit = (head.flags & HAS_INVALID_BIT != 0).then_some(head.invalid_bit);
        self.channels.push(MdfChannel { header, is_time, source, invalid_bit, line });
        Ok(())
    }
}

/// The unit of a channel, or of its conversion.
fn unit(bytes: &[u8], channel: &Block<'_>, conversion: Option<&Block<'_>>) -> String {
    let of = |block: &Block<'_>, idx: usize| {
        let text_block = block.linked(bytes, idx, *b"TX");
        let block = text_block.or_else(|| block.linked(bytes, idx, *b"MD"))?;
        Some(text(&block)).filter(|unit| !unit.is_empty())
    };
    of(channel, 6).or_else(|| of(conversion?, 1)).unwrap_or_default()
}

/// Intercept and slope of a conversion.
///
/// # Errors
/// What it is if it is no line.
fn line(block: &Block<'_>) -> Result<[f64; 2], &'static str> {
    let mut cursor = block.cursor();
    let mut read = || -> Result<Option<[f64; 2]>, Fault> {
        let kind = cursor.byte()?;
        cursor.take(5)?;
        let n_values = cursor.u16()?;
        cursor.take(16)?;
        match (kind, n_values) {
            (0, _) => Ok(Some([0.0, 1.0])),
            (1, 2..) => Ok(Some([cursor.f64()?, cursor.f64()?])),
            (2, 6..) => {
                let mut read = || cursor.f64();
                let [a, b, c] = [read()?, read()?, read()?];
                let [d, e, f] = [read()?, read()?, read()?];
                // Many programs write a line so.
                let is_line = [a, d, e].iter().all(|factor| *factor == 0.0) && f != 0.0;
                Ok(is_line.then(|| [c / f, b / f]))
            }
            _ => Ok(None),
        }
    };
    match read() {
        _ if block.id != *b"CC" => Err("its conversion is damaged"),
        Ok(Some(line)) if line.iter().all(|number| number.is_finite()) => Ok(line),
        Ok(_) => Err("its conversion is no line"),
        Err(_) => Err("its conversion is damaged"),
    }
}

/// The text of a block TX, or that in the XML of a block MD.
fn text(block: &Block<'_>) -> String {
    let bytes = block.data.get(..MAX_TEXT_BYTES).unwrap_or(block.data);
    let bytes = bytes.split(|byte| *byte == 0).next().unwrap_or_default();
    let text = String::from_utf8_lossy(bytes);
    let inside = match block.id {
        [b'M', b'D'] => text.split_once("<TX").and_then(|(_, rest)| {
            let (_, rest) = rest.split_once('>')?;
            rest.split_once("</TX>").map(|(inside, _)| inside.trim())
        }),
        _ => Some(&*text),
    };
    plain(inside.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quotient_that_is_a_line_is_read_as_one() {
        let of = |kind: u8, values: &[f64]| {
            let n_values = (values.len() as u16).to_le_bytes();
            let head = [&[kind, 0, 0, 0, 0, 0][..], &n_values, &[0; 16]].concat();
            let numbers: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            let data = [head, numbers].concat();
            line(&Block { at: 0, id: *b"CC", links: &[], data: &data, data_at: 0 })
        };
        assert_eq!(of(1, &[3.0, 0.5]), Ok([3.0, 0.5]));
        assert_eq!(of(2, &[0.0, 1.0, 6.0, 0.0, 0.0, 2.0]), Ok([3.0, 0.5]));
        for curve in [
            [1.0, 1.0, 6.0, 0.0, 0.0, 2.0],
            [0.0, 1.0, 6.0, 0.0, 1.0, 2.0],
            [0.0, 1.0, 6.0, 0.0, 0.0, 0.0],
        ] {
            assert_eq!(of(2, &curve), Err("its conversion is no line"), "{curve:?}");
        }
        assert_eq!(of(2, &[0.0, 1.0]), Err("its conversion is no line"));
    }
}
