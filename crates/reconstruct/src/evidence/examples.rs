//! Evidence for tests.

use std::path::Path;

use crate::evidence::Evidence;
use impactlab_core::data::TomlFile;

/// A car that spun to rest after a push behind its CG, with its speed from an event data recorder.
pub(crate) const SPIN: &str = include_str!("../../../../tests/data/evidence/spin.toml");

/// Reads the text of an evidence file without an error.
pub(crate) fn read(text: &str) -> Evidence {
    Evidence::from_toml(TomlFile { path: Path::new("case.toml"), text }).unwrap()
}
