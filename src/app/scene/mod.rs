//! The scene of the simulation that is shown, with the variants and the recording beside it.

mod keyed;
mod session;
mod settings;
mod update;

pub use keyed::KeyedCamera;
pub use session::{SceneSession, SceneSource};
pub use settings::SceneSettings;
