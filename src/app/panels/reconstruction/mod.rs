//! The panes of the reconstruction: the evidence, the scene, and the speeds.

mod backdrop;
mod cards;
mod evidence;
mod fields;
mod findings;
mod priors;
mod scene;
mod scene_edit;
mod speeds;

pub use evidence::evidence_ui;
pub use scene::reconstructed_scene_ui;
pub use speeds::speeds_ui;

/// What is said of an answer whose evidence or settings have been changed since.
const OUTDATED: &str = "The evidence or the settings were changed since the last run: Run again";
