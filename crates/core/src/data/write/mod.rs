//! Writes files in such a way that nothing is lost: a reader never finds an incomplete file, nothing
//! that exists is replaced unasked, and what a killed write has left is removed by the next one.
//!
//! - [`write_atomically`] writes one file, [`write_bytes`] one whose content is there as a whole;
//!   [`check_target`] says beforehand what they would refuse, [`check_inputs`] whether they would
//!   replace what the content is computed from, [`check_ending`] whether the name says what it holds.
//! - [`OutputFolder`] writes a folder of files that belong together, with a [`Manifest`] of how they
//!   were made.
//! - [`WriterLock`] keeps two writers apart.

mod digest;
mod error;
mod file;
mod folder;
mod inputs;
mod lock;
mod machine;
mod manifest;
mod parquet_series;
mod series;
mod temporary;

pub use digest::FileDigest;
pub use error::WriteError;
pub use file::{Existing, check_ending, check_target, sync_folder, write_atomically, write_bytes};
pub use folder::OutputFolder;
pub use inputs::check_inputs;
pub use lock::WriterLock;
pub use machine::{json_without_machine, replace_strings, with_name_for_path};
pub use manifest::{MANIFEST_FILE, Manifest, ModelDigest, RunRecord};
pub use parquet_series::write_restricted_series_parquet;
pub use series::{
    RESTRICTIONS_COLUMN, write_restricted_series_csv, write_restricted_table, write_series_csv,
};
