//! Independent streams of random numbers from one seed, and fingerprints of data.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use sha2::{Digest, Sha256};

/// The generator for one purpose, such as `"weights"`, `"split"` or `"shuffle"`.
///
/// The key of the generator is the SHA-256 of seed and purpose, so streams of different purposes
/// share nothing; `number` picks one of 2⁶⁴ streams of that key, for example the epoch or the
/// member of an ensemble. Drawing more from one leaves the others as they were.
///
/// - `seed`: the run's one seed, from its config.
pub fn random_stream(seed: u64, purpose: &str, number: u64) -> ChaCha8Rng {
    let key = Sha256::new().chain_update(seed.to_le_bytes()).chain_update(purpose).finalize();
    let mut rng = ChaCha8Rng::from_seed(key.into());
    rng.set_stream(number);
    rng
}

/// SHA-256 of the parts put together, as 64 hexadecimal digits.
pub fn sha256_hex<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> String {
    let mut hash = Sha256::new();
    parts.into_iter().for_each(|part| hash.update(part));
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;

    fn first(mut rng: ChaCha8Rng) -> u64 {
        rng.next_u64()
    }

    #[test]
    fn a_stream_repeats_and_differs_from_every_other() {
        let draw = |seed, purpose, number| first(random_stream(seed, purpose, number));
        assert_eq!(draw(7, "weights", 0), draw(7, "weights", 0));
        let all = [draw(7, "weights", 0), draw(8, "weights", 0), draw(7, "split", 0)];
        let distinct: std::collections::BTreeSet<_> =
            all.into_iter().chain([draw(7, "weights", 1)]).collect();
        assert_eq!(distinct.len(), 4);
    }

    #[test]
    fn the_stream_of_a_seed_stays_the_same_for_ever() {
        // Changing the derivation would change every trained model.
        assert_eq!(first(random_stream(1, "weights", 0)), 12_778_744_172_020_664_992);
    }

    #[test]
    fn the_hash_is_that_of_the_standard() {
        // FIPS 180-4, example "abc".
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256_hex([b"a".as_slice(), b"bc"]), expected);
    }
}
