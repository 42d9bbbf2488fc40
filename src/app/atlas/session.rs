//! The atlas that is shown with its maps, which is not saved.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::atlas::map::{MapsOf, ShownMap};
use impactlab_sweep::atlas::Atlas;

/// An atlas that was read.
#[derive(Clone)]
pub struct ReadAtlas {
    /// Its file; `None` for the one that comes with the program.
    pub file: Option<PathBuf>,
    /// The atlas, or why there is none.
    pub atlas: Result<Arc<Atlas>, String>,
    /// The networks of the program that are not those that computed it.
    pub other_networks: Vec<String>,
}

/// The atlas that is shown with its maps.
#[derive(Default)]
pub struct AtlasSession {
    /// The atlas that was read last.
    pub(super) read: Option<ReadAtlas>,
    /// The file of which the atlas is being read.
    pub(super) reading: Option<Option<PathBuf>>,
    /// What the maps are of.
    pub(super) made_of: Option<MapsOf>,
    pub(super) maps: Vec<ShownMap>,
    /// Whether the motion is played as soon as it is computed.
    pub(super) plays_next: bool,
}

impl AtlasSession {
    /// The atlas; `None` while it is read or where there is none.
    pub fn atlas(&self) -> Option<&Arc<Atlas>> {
        self.read.as_ref()?.atlas.as_ref().ok()
    }

    /// Why there is no atlas.
    pub fn problem(&self) -> Option<&str> {
        self.read.as_ref()?.atlas.as_ref().err().map(String::as_str)
    }

    /// The networks of the program that are not those that computed the atlas.
    pub fn other_networks(&self) -> &[String] {
        self.read.as_ref().map_or(&[], |read| read.other_networks.as_slice())
    }

    /// That the atlas was computed with other networks than those of the program, where it was.
    pub fn warning(&self) -> Option<String> {
        let others = self.other_networks();
        (!others.is_empty()).then(|| {
            let others = others.join(", ");
            format!(
                "This atlas was computed with other networks than those of this version ({others}): \
                 its numbers and a prediction may differ for that reason alone."
            )
        })
    }

    /// The maps that are shown, from left to right.
    pub fn maps(&self) -> &[ShownMap] {
        &self.maps
    }

    /// The bins in which the case at hand lies, for each axis; `None` where it lies in none, or does not say
    /// it.
    pub fn bins_of_case(&self) -> &[Option<usize>] {
        self.made_of.as_ref().map_or(&[], |of| of.case.bins.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_atlas_of_other_networks_has_a_warning() {
        let mut session = AtlasSession::default();
        assert_eq!(session.warning(), None);
        let read =
            |other_networks| ReadAtlas { file: None, atlas: Err(String::new()), other_networks };
        session.read = Some(read(Vec::new()));
        assert_eq!(session.warning(), None);
        session.read = Some(read(vec!["response".to_owned()]));
        assert!(session.warning().unwrap().contains("(response)"));
    }
}
