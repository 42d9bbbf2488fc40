//! The ground of the scene: the site that was opened, read on another thread, and where its orthophoto
//! was put.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::command::Command;
use crate::app::panes::Pane;
use crate::app::state::{Session, State};
use crate::app::tasks::{TaskKey, Tasks};
use crate::app::workspaces::Workspace;
use impactlab_core::data::{Existing, Severity, write_atomically};
use impactlab_core::error_chain;
use impactlab_core::ranges::SITE_DISTANCE;
use impactlab_core::site::PixelMap;
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
}

/// The ground that was read.
#[derive(Default)]
pub struct GroundSession {
    /// What was asked for last.
    asked: Option<PathBuf>,
    is_loading: bool,
    read: Option<Arc<LoadedGround>>,
    /// The ground with its orthophoto where the project puts it.
    shown: Option<(Option<PixelMap>, Arc<LoadedGround>)>,
    /// Why it cannot be shown.
    pub problem: Option<String>,
}

impl GroundSession {
    /// The ground that is shown.
    pub fn shown(&self) -> Option<&Arc<LoadedGround>> {
        self.shown.as_ref().map(|(_, ground)| ground)
    }

    /// Whether a ground is being read.
    pub fn is_loading(&self) -> bool {
        self.is_loading
    }

    /// Reads the ground again, since its files may have changed.
    fn forget(&mut self) {
        *self = Self::default();
    }

    /// Starts to read a ground that has not been asked for, and puts the one that was read where the
    /// project wants it.
    ///
    /// - `file`: the site file, or an orthophoto alone;
    /// - `map`: where the orthophoto was put in the window, instead of where the file says.
    fn update(&mut self, file: Option<&PathBuf>, map: Option<PixelMap>, tasks: &mut Tasks) {
        if file != self.asked.as_ref() {
            self.forget();
            self.asked = file.cloned();
            if let Some(path) = file.cloned() {
                self.is_loading = true;
                let asked = path.clone();
                tasks.start(
                    TaskKey::Ground,
                    move |_| match LoadedGround::load(&path) {
                        Ok(ground) => Ok(Arc::new(ground)),
                        Err(error) => Err(error_chain(&error)),
                    },
                    |result| Command::Ground(GroundCommand::Read(asked, result)),
                );
            }
        }
        if self.shown.as_ref().map(|(map, _)| map) != Some(&map) || self.read.is_none() {
            let placed = |read: &Arc<LoadedGround>| match map {
                Some(map) => Arc::new(read.placed(map)),
                None => Arc::clone(read),
            };
            self.shown = self.read.as_ref().map(|read| (map, placed(read)));
        }
    }

    /// Takes what was read, unless another ground was asked for meanwhile.
    ///
    /// - `extent_m`: smallest and largest `[X, Y]` of the scene, m;
    /// - returns what the user has to know.
    fn take(
        &mut self,
        path: &Path,
        result: Result<Arc<LoadedGround>, String>,
        extent_m: [[f64; 2]; 2],
    ) -> Vec<(Severity, String)> {
        if !self.is_loading || self.asked.as_deref() != Some(path) {
            return Vec::new();
        }
        self.is_loading = false;
        match result {
            Ok(ground) => {
                let notes = ground.notes.iter().map(|note| (Severity::Info, note.clone()));
                let far = ground.far_notes(extent_m);
                let far = far.into_iter().map(|note| (Severity::Warning, note));
                let said = notes.chain(far).collect();
                self.read = Some(ground);
                said
            }
            Err(why) => {
                self.problem = Some(why.clone());
                vec![(Severity::Error, why)]
            }
        }
    }
}

impl State {
    /// Puts a site, or an orthophoto alone, below the scene.
    pub(in crate::app) fn open_ground(&mut self, path: PathBuf) {
        // A file that is opened again is read again, and an answer is of what it said before.
        self.session.ground.forget();
        let of_reconstruction = self.project.reconstruct.as_ref().and_then(|of| of.site.as_ref());
        if of_reconstruction == Some(&path) {
            self.drop_reconstruction();
        }
        self.project.put_on_site(Some(path));
        self.ask_again();
        self.session.shows_doors = false;
        match self.view.workspaces.shown {
            // It lies below the cars there, too.
            Workspace::Reconstruct => self.view.reconstruction.shows_cars = true,
            _ => self.view.workspaces.show_pane(Pane::Scene),
        }
    }

    /// Reads the ground of the project where that has changed.
    pub(in crate::app) fn update_ground(&mut self) {
        let Session { ground, tasks, .. } = &mut self.session;
        let (site, map) = (self.project.simulate.site.as_ref(), self.project.beside.orthophoto);
        ground.update(site, map, tasks);
    }

    /// Carries out a command on the ground.
    pub(in crate::app) fn change_ground(&mut self, command: GroundCommand) {
        match command {
            GroundCommand::Remove => self.project.put_on_site(None),
            GroundCommand::Read(path, result) => {
                let extent_m = self.session.scene.extent_m().unwrap_or_default();
                for (severity, text) in self.session.ground.take(&path, result, extent_m) {
                    self.say(severity, text);
                }
            }
            GroundCommand::Scale { ends_m: [from, to], distance_m } => {
                let photo = self.session.ground.shown().and_then(|of| of.site.orthophoto.as_ref());
                let shown_m = (to[0] - from[0]).hypot(to[1] - from[1]);
                let Some(photo) = photo else { return };
                let map = photo.map.scaled_about(from, distance_m / shown_m);
                let is_possible = SITE_DISTANCE.contains(distance_m) && shown_m > 0.0;
                match map.problem().filter(|_| is_possible) {
                    None if is_possible => self.project.beside.orthophoto = Some(map),
                    problem => {
                        let expected = problem.unwrap_or("a distance of 0.05 m to 100 km");
                        let text = format!("the orthophoto keeps its scale, expected {expected}");
                        self.say(Severity::Warning, text);
                    }
                }
            }
        }
    }

    /// Writes the site that is shown as a site file, which becomes that of the project.
    pub(in crate::app) fn save_site(&mut self, path: &Path, existing: Existing) {
        let Some(ground) = self.session.ground.shown().cloned() else { return };
        let text = match ground.site.to_toml(path.parent().unwrap_or(Path::new(""))) {
            Ok(text) => text,
            Err(error) => return self.say(Severity::Error, error.to_string()),
        };
        match write_atomically(path, existing, |out| out.write_all(text.as_bytes())) {
            Ok(()) => {
                self.say(Severity::Info, format!("{} written", path.display()));
                self.project.put_on_site(Some(path.to_owned()));
                self.session.ground.forget();
            }
            Err(error) => self.say(Severity::Error, error_chain(&error)),
        }
    }
}
