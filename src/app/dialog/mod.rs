//! What the user is asked: dialogs within the window, one over the other, and the desktop's dialogs
//! for files.

mod native;
mod path;
mod purpose;
mod stack;
mod ui;

pub use native::ask_for_path;
pub use path::PathDialog;
pub use purpose::Purpose;
pub use stack::{Dialog, Dialogs};
pub use ui::dialogs_ui;
