//! The dialog in which the user says how a file is read, with the curve as it will be read, and the
//! choices of earlier files.

mod answer;
mod choices;
mod column_row;
mod dialog;
mod dialog_ui;
mod preview;
mod preview_ui;
mod remembered;
mod said;
mod signs_ui;

pub use answer::ImportAnswer;
pub use dialog::ImportDialog;
pub use remembered::ColumnMaps;
pub(in crate::app) use remembered::fingerprint;
pub use said::SaidOfFile;
