//! Columns as arrays of `NumPy` (`.npy`, version 1.0), so that `numpy.load` reads an atlas.

use crate::atlas::AtlasFileError;

const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";

/// Multiple of which a head is long.
const ALIGNMENT: usize = 64;

/// The head of an array of a type.
///
/// - `shape`: rows, and columns where there are several.
fn head(kind: &str, shape: [usize; 2]) -> Vec<u8> {
    let [rows, columns] = shape;
    let shape = if columns == 1 { format!("({rows},)") } else { format!("({rows}, {columns})") };
    let text = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    // Magic, two bytes of length, text and a line end.
    let length = (MAGIC.len() + 2 + text.len() + 1).next_multiple_of(ALIGNMENT);
    let padding = length - (MAGIC.len() + 2 + text.len() + 1);
    let inner = text.len() + padding + 1;
    let mut head = MAGIC.to_vec();
    head.extend((inner as u16).to_le_bytes());
    head.extend(text.as_bytes());
    head.extend(std::iter::repeat_n(b' ', padding));
    head.push(b'\n');
    head
}

/// Whole numbers in the fewest bytes that hold them all.
pub(super) fn of_counts(values: &[u32], shape: [usize; 2]) -> Vec<u8> {
    let largest = values.iter().copied().max().unwrap_or(0);
    if largest <= u32::from(u8::MAX) {
        return [head("|u1", shape), values.iter().map(|value| *value as u8).collect()].concat();
    }
    if largest <= u32::from(u16::MAX) {
        let bytes = values.iter().flat_map(|value| (*value as u16).to_le_bytes());
        return [head("<u2", shape), bytes.collect()].concat();
    }
    [head("<u4", shape), values.iter().flat_map(|value| value.to_le_bytes()).collect()].concat()
}

/// Numbers of 32 bits.
pub(super) fn of_numbers(values: &[f32]) -> Vec<u8> {
    let bytes = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    [head("<f4", [values.len(), 1]), bytes].concat()
}

/// Most bytes that an array of this shape has.
pub(super) fn most_bytes([rows, columns]: [usize; 2]) -> u64 {
    let head = head("<u4", [rows, columns]).len() as u64;
    head.saturating_add((rows as u64).saturating_mul(columns as u64).saturating_mul(4))
}

/// Reads whole numbers of a shape.
pub(super) fn counts(
    name: &str,
    bytes: &[u8],
    shape: [usize; 2],
) -> Result<Vec<u32>, AtlasFileError> {
    let values = if let Some(rest) = bytes.strip_prefix(&*head("|u1", shape)) {
        rest.iter().map(|byte| u32::from(*byte)).collect()
    } else if let Some(rest) = bytes.strip_prefix(&*head("<u2", shape)) {
        chunks(rest).map(|bytes| u32::from(u16::from_le_bytes(bytes))).collect()
    } else if let Some(rest) = bytes.strip_prefix(&*head("<u4", shape)) {
        chunks(rest).map(u32::from_le_bytes).collect()
    } else {
        return Err(AtlasFileError::NotThisArray { name: name.to_owned() });
    };
    whole(name, values, shape)
}

/// Reads numbers of 32 bits, which must be finite.
pub(super) fn numbers(name: &str, bytes: &[u8], n: usize) -> Result<Vec<f32>, AtlasFileError> {
    let not_this = || AtlasFileError::NotThisArray { name: name.to_owned() };
    let rest = bytes.strip_prefix(&*head("<f4", [n, 1])).ok_or_else(not_this)?;
    let values: Vec<f32> = chunks(rest).map(f32::from_le_bytes).collect();
    if let Some(cell) = values.iter().position(|value| !value.is_finite()) {
        return Err(AtlasFileError::NotFinite { name: name.to_owned(), cell });
    }
    whole(name, values, [n, 1])
}

fn chunks<const N: usize>(bytes: &[u8]) -> impl Iterator<Item = [u8; N]> {
    bytes.chunks_exact(N).filter_map(|chunk| chunk.try_into().ok())
}

fn whole<T>(
    name: &str,
    values: Vec<T>,
    [n, columns]: [usize; 2],
) -> Result<Vec<T>, AtlasFileError> {
    let (got, expected) = (values.len(), n.saturating_mul(columns));
    if got != expected {
        return Err(AtlasFileError::Length { name: name.to_owned(), got, expected });
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_come_back_and_a_head_is_that_of_numpy() {
        for largest in [3_u32, 300, 70_000] {
            let values = [0, 1, largest, 2, 7, 5];
            let bytes = of_counts(&values, [3, 2]);
            assert_eq!(counts("a", &bytes, [3, 2]).unwrap(), values);
            assert!(bytes.len() as u64 <= most_bytes([3, 2]));
            assert!(counts("a", &bytes, [2, 3]).is_err());
            assert!(counts("a", &bytes[..bytes.len() - 1], [3, 2]).is_err());
        }
        let bytes = of_numbers(&[1.5, -2.0]);
        assert_eq!(numbers("a", &bytes, 2).unwrap(), [1.5, -2.0]);
        assert!(numbers("a", &of_numbers(&[f32::NAN, 0.0]), 2).is_err());
        // What `numpy.save` writes of `numpy.array([1.5, -2], "<f4")`.
        let head =
            b"\x93NUMPY\x01\x00v\x00{'descr': '<f4', 'fortran_order': False, 'shape': (2,), }";
        assert!(bytes.starts_with(head), "{bytes:?}");
        assert_eq!((bytes.len(), bytes[127]), (128 + 8, b'\n'));
    }
}
