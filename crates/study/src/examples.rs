//! Evidence for tests.

use std::path::Path;

use impactlab_reconstruct::evidence::Evidence;

/// A car that spun to rest after a push behind its CG, with its speed from an event data recorder.
pub(crate) fn spin() -> Evidence {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/evidence/spin.toml");
    Evidence::load(Path::new(file)).unwrap()
}
