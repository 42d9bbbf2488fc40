//! Actions on the atlas.

use std::path::PathBuf;

use crate::app::atlas::ReadAtlas;
use crate::app::found::Found;

/// An action on the atlas.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AtlasCommand {
    /// Show the atlas of a file; `None` is the one that comes with the program.
    Show(Option<PathBuf>),
    /// Take an atlas that was read, or why there is none.
    Read(Found<ReadAtlas>),
    /// Make a variant of the case of a cell, and play it: the bin of every axis, `None` for one that is
    /// integrated out.
    Play(Vec<Option<usize>>),
}
