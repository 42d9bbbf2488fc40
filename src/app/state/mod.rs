//! The state of the application. The project and the view are saved between runs, the session is
//! not.

mod saved;
mod session;
mod whole;

pub use saved::{Subject, View};
pub use session::Session;
pub use whole::{RestoreError, State, StateText};
