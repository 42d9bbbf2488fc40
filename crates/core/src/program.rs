//! Which program computes: a name and a version that every answer carries.
//!
//! The library is compiled before the program and does not know it, so the program says which one it
//! is when it starts. Nothing that is computed depends on it.

use std::sync::OnceLock;

static VERSION: OnceLock<&str> = OnceLock::new();

/// Sets the version of the program for as long as it runs. Later calls change nothing.
///
/// - `version`: version and, behind the plus sign, the start of the SHA-256 of the source that the
///   program was compiled from: `0.1.0+0123456789ab`.
pub fn set_version(version: &'static str) {
    VERSION.get_or_init(|| version);
}

/// Version of the program. Every answer, file of results and report names it, and unfinished work of
/// another build is not resumed.
///
/// Where no program has set it, which is the case if the library is used by itself, it is the version
/// of the library with `library` in the place of the digest.
pub fn version() -> &'static str {
    VERSION.get().copied().unwrap_or(concat!(env!("CARGO_PKG_VERSION"), "+library"))
}
