//! Films of the scene: the form that asks how, and the task that makes one in the background.

mod form;
mod update;

pub use form::FilmForm;
pub use update::FilmCommand;
