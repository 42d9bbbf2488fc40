//! The ground of the scene: the site that was opened, and where its orthophoto was put.

mod cloud;
mod command;
mod session;
mod update;

pub use cloud::{CloudForm, MadeGround};
pub use command::GroundCommand;
pub use session::GroundSession;

/// What the ground of a scene is called wherever it is offered: as in answers, files and commands.
pub const SITE: &str = "Site";
/// What opens one.
pub const OPEN_SITE: &str = "Open site…";
/// What takes it away.
pub const REMOVE_SITE: &str = "Remove site";
/// What it is, and what it is for.
pub const ABOUT_SITES: &str = "Where the collision was: lanes, kerbs, zones of friction, a picture from above. A site file \
    (TOML), an orthophoto, KML, GeoJSON, surveyed points or a point cloud; it can be dropped here as well";
