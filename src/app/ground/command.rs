//! The actions on the ground.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::ground::{CloudForm, MadeGround};
use impactlab_document::scene::LoadedGround;

/// An action on the ground.
#[derive(Debug, Clone, PartialEq)]
pub enum GroundCommand {
    /// Scale the orthophoto so that two places that are shown have a distance; the first one stays.
    Scale {
        /// The places as they are shown now, m.
        ends_m: [[f64; 2]; 2],
        /// Their true distance, m.
        distance_m: f64,
    },
    /// Take the ground away.
    Remove,
    /// Take the ground that was read of this file, or why it cannot be shown.
    Read(PathBuf, Result<Arc<LoadedGround>, String>),
    /// Make a ground of a point cloud.
    MakeOfCloud(CloudForm),
    /// Stop that; nothing is left behind.
    StopCloud,
    /// Take the ground that was made; `None` if it was stopped.
    CloudMade(Result<Option<MadeGround>, String>),
}
