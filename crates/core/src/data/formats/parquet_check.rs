//! Checks what a Parquet file says of its own sizes before a library allocates anything by it: the tree of its
//! columns in the footer, and the heads of its pages, both in the compact protocol of Thrift.
//!
//! ```text
//! field     u8: (difference of the id << 4) | type, or the id as a varint where the difference is 0; 0 ends
//! integer   varint, zigzag
//! text      varint of its length, bytes
//! list      u8: (size << 4) | type, or the size as a varint where it is 15
//! footer    … metadata, u32 of its length, "PAR1"; field 2 of it is the list of the columns
//! page      1 kind, 2 bytes unpacked, 3 bytes packed, 4 CRC-32 of the packed bytes or nothing,
//!           5/7/8 heads with the number of values in field 1
//! ```

use flate2::Crc;

/// Depth of nested values and of nested columns.
const MAX_DEPTH: usize = 24;

/// Nodes of the tree of columns.
const MAX_NODES: u64 = 8192;

/// Bytes of a page when it is unpacked; writers make pages of 1 MiB.
const MAX_PAGE_BYTES: i64 = 16 << 20;

/// The type of a field that holds a struct.
const STRUCT: u8 = 12;

/// Bytes from which values are taken in their order; each step gives nothing at their end.
struct Compact<'a> {
    bytes: &'a [u8],
    at: usize,
}

/// A head of a page, as far as it is checked.
#[derive(Default)]
struct PageHead {
    unpacked: i64,
    packed: i64,
    /// The checksum of the packed bytes, if one is stated.
    crc: Option<i64>,
    n_values: i64,
    is_dictionary: bool,
}

impl Compact<'_> {
    fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    fn varint(&mut self) -> Option<u64> {
        let mut value = 0_u64;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(value);
            }
        }
        None
    }

    fn integer(&mut self) -> Option<i64> {
        let value = self.varint()?;
        let half = i64::try_from(value >> 1).ok()?;
        Some(if value & 1 == 0 { half } else { -1 - half })
    }

    fn pass(&mut self, n_bytes: u64) -> Option<()> {
        let end = self.at.checked_add(usize::try_from(n_bytes).ok()?)?;
        self.at = Some(end).filter(|end| *end <= self.bytes.len())?;
        Some(())
    }

    /// The type and the id of the next field; `Some(None)` at the end of a struct.
    fn field(&mut self, last: &mut i64) -> Option<Option<(u8, i64)>> {
        let head = self.byte()?;
        if head == 0 {
            return Some(None);
        }
        let id = match head >> 4 {
            0 => self.integer()?,
            difference => last.checked_add(i64::from(difference))?,
        };
        *last = id;
        Some(Some((head & 0x0f, id)))
    }

    /// The type of the elements of a list, and their number.
    fn list(&mut self) -> Option<(u8, u64)> {
        let head = self.byte()?;
        let size = match head >> 4 {
            15 => self.varint()?,
            size => u64::from(size),
        };
        let left = (self.bytes.len() - self.at) as u64;
        (size <= left).then_some((head & 0x0f, size))
    }

    fn skip(&mut self, kind: u8, depth: usize) -> Option<()> {
        if depth > MAX_DEPTH {
            return None;
        }
        match kind {
            1 | 2 => Some(()),
            3 => self.pass(1),
            4..=6 => self.varint().map(|_| ()),
            7 => self.pass(8),
            8 => {
                let length = self.varint()?;
                self.pass(length)
            }
            9 | 10 => {
                let (kind, size) = self.list()?;
                (0..size).try_for_each(|_| match kind {
                    1 | 2 => self.pass(1),
                    kind => self.skip(kind, depth + 1),
                })
            }
            11 => {
                let size = self.varint()?;
                let kinds = if size == 0 { 0 } else { self.byte()? };
                if size > (self.bytes.len() - self.at) as u64 {
                    return None;
                }
                (0..size).try_for_each(|_| {
                    self.skip(kinds >> 4, depth + 1)?;
                    self.skip(kinds & 0x0f, depth + 1)
                })
            }
            STRUCT => {
                let mut last = 0;
                while let Some((kind, _)) = self.field(&mut last)? {
                    self.skip(kind, depth + 1)?;
                }
                Some(())
            }
            _ => None,
        }
    }

    /// A field of a struct as a number; the others are passed.
    fn number_in_struct(&mut self, wanted: i64) -> Option<Option<i64>> {
        let (mut last, mut found) = (0, None);
        while let Some((kind, id)) = self.field(&mut last)? {
            match (id, kind) {
                (id, 4..=6) if id == wanted => found = Some(self.integer()?),
                _ => self.skip(kind, 1)?,
            }
        }
        Some(found)
    }
}

/// Checks the footer of a file; `None` if it says something that cannot be.
pub(super) fn footer(bytes: &[u8]) -> Option<()> {
    let end = bytes.len().checked_sub(8)?;
    let (_, tail) = bytes.split_at_checked(end)?;
    let (length, magic) = tail.split_first_chunk::<4>()?;
    let length = usize::try_from(u32::from_le_bytes(*length)).ok()?;
    let metadata = bytes.get(end.checked_sub(length)?..end).filter(|_| magic == b"PAR1")?;
    let mut compact = Compact { bytes: metadata, at: 0 };
    let mut last = 0;
    while let Some((kind, id)) = compact.field(&mut last)? {
        match (id, kind) {
            (2, 9) => tree(&mut compact)?,
            _ => compact.skip(kind, 0)?,
        }
    }
    Some(())
}

/// Checks the list of the columns: how many children each node has.
fn tree(compact: &mut Compact<'_>) -> Option<()> {
    let (kind, size) = compact.list()?;
    if kind != STRUCT || size > MAX_NODES {
        return None;
    }
    let mut open: Vec<u64> = Vec::new();
    for _ in 0..size {
        let n_children = compact.number_in_struct(5)?.unwrap_or(0);
        let n_children = u64::try_from(n_children).ok().filter(|n| *n <= size)?;
        if let Some(left) = open.last_mut() {
            *left = left.checked_sub(1)?;
        }
        if n_children > 0 {
            open.push(n_children);
        }
        if open.len() > MAX_DEPTH {
            return None;
        }
        while open.last() == Some(&0) {
            open.pop();
        }
    }
    Some(())
}

/// Checks the heads of the pages of a column; gives the bytes of all of them when they are unpacked.
///
/// - `start`, `length`: where the column lies in the file.
pub(super) fn pages(bytes: &[u8], start: i64, length: i64) -> Option<u64> {
    let start = usize::try_from(start).ok()?;
    let end = start.checked_add(usize::try_from(length).ok()?)?;
    let mut compact = Compact { bytes: bytes.get(start..end)?, at: 0 };
    let mut unpacked = 0;
    while compact.at < compact.bytes.len() {
        let head = page_head(&mut compact)?;
        // A value of a dictionary of numbers takes four bytes or more.
        let is_good = (0..=MAX_PAGE_BYTES).contains(&head.unpacked)
            && head.n_values >= 0
            && (!head.is_dictionary || head.n_values <= head.unpacked / 4);
        let start = compact.at;
        compact.pass(u64::try_from(head.packed).ok().filter(|_| is_good)?)?;
        let packed = compact.bytes.get(start..compact.at)?;
        if head.crc.is_some_and(|stated| !is_crc_of(packed, stated)) {
            return None;
        }
        unpacked += u64::try_from(head.unpacked).ok()?;
    }
    Some(unpacked)
}

/// Whether a checksum, which is stored as a number with a sign, is that of some bytes.
fn is_crc_of(bytes: &[u8], stated: i64) -> bool {
    let mut crc = Crc::new();
    crc.update(bytes);
    i32::try_from(stated).is_ok_and(|stated| stated.cast_unsigned() == crc.sum())
}

fn page_head(compact: &mut Compact<'_>) -> Option<PageHead> {
    let (mut head, mut last) = (PageHead::default(), 0);
    while let Some((kind, id)) = compact.field(&mut last)? {
        match (id, kind) {
            (2, 4..=6) => head.unpacked = compact.integer()?,
            (3, 4..=6) => head.packed = compact.integer()?,
            (4, 4..=6) => head.crc = Some(compact.integer()?),
            (5 | 7 | 8, STRUCT) => {
                head.n_values = compact.number_in_struct(1)?.unwrap_or(0);
                head.is_dictionary |= id == 7;
            }
            _ => compact.skip(kind, 0)?,
        }
    }
    Some(head)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A footer whose tree has a root that says how many children it has, and two columns.
    fn file(n_children: u8) -> Vec<u8> {
        let node = |children: Option<u8>| {
            let mut node = vec![0x48, 1, b'a'];
            node.extend(children.map(|n| [0x15, 2 * n]).into_iter().flatten());
            node.push(0);
            node
        };
        let mut metadata = vec![0x15, 2, 0x19, 0x3c];
        metadata.extend(node(Some(n_children)));
        metadata.extend(node(None));
        metadata.extend(node(None));
        metadata.push(0);
        let length = u32::try_from(metadata.len()).unwrap().to_le_bytes();
        [b"PAR1", metadata.as_slice(), &length, b"PAR1"].concat()
    }

    #[test]
    fn a_tree_that_cannot_be_is_refused() {
        assert_eq!(footer(&file(2)), Some(()));
        assert_eq!(footer(&file(60)), None);
        assert_eq!(footer(b"PAR1"), None);
        let whole = file(2);
        for cut in 0..whole.len() {
            assert_eq!(footer(&whole[..cut]), None, "{cut}");
        }
    }

    #[test]
    fn a_page_whose_checksum_is_wrong_is_refused() {
        // Kind 0, 9 bytes unpacked and packed, and the CRC-32 of "123456789", 0xcbf43926, as a zigzag varint.
        let head = [0x15, 0, 0x15, 18, 0x15, 18, 0x15, 0xb3, 0x9b, 0xde, 0xc0, 0x06, 0];
        let read = |content: &[u8]| {
            let page = [&head[..], content].concat();
            pages(&page, 0, i64::try_from(page.len()).unwrap())
        };
        assert_eq!(read(b"123456789"), Some(9));
        assert_eq!(read(b"123456780"), None);
    }

    #[test]
    fn a_page_that_unpacks_to_too_much_is_refused() {
        // Kind 0, 2 bytes packed, and so many unpacked.
        let page =
            |unpacked: &[u8]| [&[0x15, 0, 0x15][..], unpacked, &[0x15, 4, 0, 9, 9][..]].concat();
        let small = page(&[20]);
        let length = i64::try_from(small.len()).unwrap();
        assert_eq!(pages(&small, 0, length), Some(10));
        let large = page(&[0xfe, 0xff, 0xff, 0xff, 0x0f]);
        assert_eq!(pages(&large, 0, i64::try_from(large.len()).unwrap()), None);
        assert_eq!(pages(&small, 0, length + 1), None);
        assert_eq!(pages(&small, -1, length), None);
    }
}
