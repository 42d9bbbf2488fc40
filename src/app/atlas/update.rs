//! Reads the atlas, makes its maps, and plays the motion of a cell.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::atlas::map::MapsOf;
use crate::app::atlas::{AtlasCommand, ReadAtlas};
use crate::app::command::Command;
use crate::app::found::Found;
use crate::app::panes::Pane;
use crate::app::state::State;
use crate::app::tasks::TaskKey;
use crate::app::workspaces::Workspace;
use impactlab_core::error_chain;
use impactlab_study::Library;
use impactlab_sweep::atlas::Atlas;

impl State {
    /// Carries out an action on the atlas.
    pub(in crate::app) fn change_atlas(&mut self, command: AtlasCommand) {
        match command {
            AtlasCommand::Show(file) => {
                self.view.atlas.file = file;
                // A file is read again, as it may have changed.
                (self.session.atlas.read, self.session.atlas.reading) = (None, None);
                self.session.shows_doors = false;
                self.session.fit_plots = true;
                self.view.workspaces.show_pane(Pane::AtlasMap);
            }
            AtlasCommand::Read(read) => self.take_atlas(read.take()),
            AtlasCommand::Play(bins) => self.play_cell(&bins),
        }
    }

    /// Takes an atlas that was read, if it is the one that is wanted.
    fn take_atlas(&mut self, read: ReadAtlas) {
        let session = &mut self.session.atlas;
        if session.reading.as_ref() == Some(&read.file) {
            session.reading = None;
            session.made_of = None;
            session.maps.clear();
            session.read = Some(read);
            self.session.fit_plots = true;
        }
    }

    /// Reads the atlas that is wanted, and makes the maps that are shown. Plays the motion of a cell once it
    /// is computed.
    pub(in crate::app) fn update_atlas(&mut self) {
        self.play_if_computed();
        if self.view.workspaces.shown != Workspace::Atlas || self.session.shows_doors {
            return;
        }
        self.read_atlas();
        let Some(atlas) = self.session.atlas.atlas().cloned() else { return };
        let of = MapsOf {
            maps: self.view.atlas.maps(&atlas),
            beside: self.view.atlas.beside(&atlas),
            units: self.view.units,
            case: self.case_in(&atlas),
            other_networks: self.session.atlas.other_networks().to_vec(),
        };
        let session = &mut self.session.atlas;
        if session.made_of.as_ref() != Some(&of) {
            let is_same_map = session.made_of.as_ref().is_some_and(|made| made.maps == of.maps);
            session.maps = of.make(&atlas);
            session.made_of = Some(of);
            self.session.fit_plots |= !is_same_map;
        }
    }

    /// Starts to read the atlas that is wanted, unless it has been.
    fn read_atlas(&mut self) {
        let session = &mut self.session.atlas;
        let wanted = &self.view.atlas.file;
        let is_read = session.read.as_ref().is_some_and(|read| read.file == *wanted);
        if is_read || session.reading.as_ref() == Some(wanted) {
            return;
        }
        session.reading = Some(wanted.clone());
        let (file, of) = (wanted.clone(), wanted.clone());
        let library = Arc::clone(&self.session.library);
        self.session.tasks.start(
            TaskKey::ReadAtlas,
            move |_| read(file, &library),
            |found| {
                let (atlas, other_networks) = match found {
                    Ok((atlas, others)) => (Ok(atlas), others),
                    Err(why) => (Err(why), Vec::new()),
                };
                let atlas = ReadAtlas { file: of, atlas, other_networks };
                Command::Atlas(AtlasCommand::Read(Found::new(atlas)))
            },
        );
    }

    /// Plays the motion of a cell once it is computed.
    fn play_if_computed(&mut self) {
        let session = &mut self.session;
        if !session.atlas.plays_next || session.analysis.is_waiting() {
            return;
        }
        session.atlas.plays_next = false;
        if session.analysis.ok().is_some() {
            (session.playback.time_s, session.playback.is_playing) = (0.0, true);
        }
    }
}

/// Reads an atlas, and which networks of the program are not those that computed it.
///
/// - `file`: its file; `None` for the one that comes with the program.
fn read(file: Option<PathBuf>, library: &Library) -> Result<(Arc<Atlas>, Vec<String>), String> {
    let atlas = match file {
        Some(file) => Arc::new(Atlas::read(&file).map_err(|error| error_chain(&error))?),
        None => match Atlas::shipped() {
            Some(atlas) => Arc::new(atlas.clone()),
            None => return Err("no atlas comes with this version".to_owned()),
        },
    };
    let others = atlas.other_networks_in(library).map_err(|error| error_chain(&error))?;
    Ok((atlas, others))
}
