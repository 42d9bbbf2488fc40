//! The command line: one file per command, which parses a request, asks it and prints the report.
//!
//! - Results go to standard output: aligned text, or JSON with `--json` (SI units, the unit in every
//!   key).
//! - Errors go to standard error, once, as one line `error: what: why`; progress too, if standard
//!   error is a terminal.
//! - Exit codes: 0 = all is well; 1 = the work failed or found problems; 2 = wrong usage.
//!
//! What a question leaves open is decided by [`study`](impactlab_study), not here.

mod run;

mod commands;

mod files;
mod options;
mod text;

mod console;
mod error;

pub use error::CliError;
pub use run::run;
