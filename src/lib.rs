//! The program: the command line and the window, which ask the same questions of the library and
//! show the same answers.

pub mod app;
pub mod cli;

/// Version of the program and, behind the plus sign, the start of the SHA-256 of the source that it was
/// compiled from (`build.rs`): `0.1.0+0123456789ab`. Every answer, file of results and report names it,
/// and unfinished work of another build is not gone on with.
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "+", env!("IMPACTLAB_SOURCE"));
