//! What trainings, evaluations and comparisons have given. It is kept in the user's data folder, so
//! that it is there after a restart, until the user removes it.
//!
//! ```text
//! models/SHA-256.safetensors     the model, as `Save model…` writes it
//! models/SHA-256.note            what it is: name, date, question, data, settings, figures
//! comparisons/SHA-256.json       the report of a comparison or evaluation
//! comparisons/SHA-256.note
//! ```
//!
//! The name of a file is the digest of its content, so that nothing is ever replaced by something
//! else, and two windows can keep results in the same folder.

mod described;
mod entry;
mod error;
mod event;
mod folder;
mod status;
mod update;

pub use described::how_it_was_made;
pub(in crate::app) use entry::moment_text;
pub use entry::{ArchiveEntry, ArchiveKind, StoredFact};
pub use error::ArchiveError;
pub use event::{ArchiveEvent, ModelsDialog, OpenedResult, Removal};
pub use folder::{ArchiveFolder, ArchiveList, ArchiveProblem, NOTE_ENDING, name_of};
pub use status::ArchiveStatus;
pub(in crate::app) use update::{LIMIT_BYTES, bytes_text, keep_trained};
