//! The scene of the simulation that is shown, with the variants and the recording beside it.

mod session;
mod settings;
mod update;

pub use session::{SceneSession, SceneSource};
pub use settings::SceneSettings;
