//! The memory that settings ask for, compared with a budget before any of it is allocated.

use crate::learning::LearningError;

/// Memory that a training or a prediction may take by its settings, bytes.
pub const MAX_MEMORY_BYTES: u64 = 8 << 30;

/// Checks the memory of a list of numbers.
///
/// - `what`: the settings and sizes that are multiplied, in words;
/// - `bytes`: memory of each entry;
/// - `sizes`: their product is the number of entries. It may be too large for a number.
///
/// # Errors
/// [`LearningError::TooMuchMemory`].
pub(crate) fn check_memory(
    what: &'static str,
    bytes: u64,
    sizes: &[usize],
) -> Result<(), LearningError> {
    let product = sizes.iter().try_fold(bytes, |all, size| all.checked_mul(*size as u64));
    let bytes = product.unwrap_or(u64::MAX);
    if bytes <= MAX_MEMORY_BYTES {
        return Ok(());
    }
    let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
    Err(LearningError::TooMuchMemory { what, gib: gib(bytes), limit_gib: gib(MAX_MEMORY_BYTES) })
}

/// The sum of sizes from a file, at most the largest number.
pub(crate) fn sum(sizes: impl IntoIterator<Item = usize>) -> usize {
    sizes.into_iter().fold(0, usize::saturating_add)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_of_any_sizes_is_one_clear_error() {
        assert!(check_memory("a × b", 8, &[1 << 15, 1 << 15]).is_ok());
        let error = check_memory("a × b", 8, &[1 << 15, 1 << 16]).unwrap_err().to_string();
        assert_eq!(error, "a × b take 16.0 GiB of memory, at most 8.0 GiB are meant for it");
        for sizes in [[usize::MAX, usize::MAX], [1 << 40, 1 << 40]] {
            assert!(check_memory("a × b", 8, &sizes).is_err(), "{sizes:?}");
        }
        assert!(check_memory("a × b", 8, &[usize::MAX, 0]).is_err());
        assert_eq!(sum([usize::MAX, 1]), usize::MAX);
    }
}
