//! The ground that is shown: read by a task, and put where the project wants it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::command::Command;
use crate::app::ground::command::GroundCommand;
use crate::app::tasks::{TaskKey, Tasks};
use impactlab_core::data::Severity;
use impactlab_core::error_chain;
use impactlab_core::site::PixelMap;
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::LoadedGround;

/// The ground that was read.
#[derive(Default)]
pub struct GroundSession {
    /// What was asked for last.
    path: Option<PathBuf>,
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
    pub(in crate::app) fn forget(&mut self) {
        *self = Self::default();
    }

    /// Starts to read a ground that has not been asked for, and puts the one that was read where the
    /// project wants it.
    ///
    /// - `file`: the site file, or an orthophoto alone;
    /// - `map`: where the orthophoto was put in the window, instead of where the file says.
    pub(in crate::app) fn update(
        &mut self,
        file: Option<&PathBuf>,
        map: Option<PixelMap>,
        tasks: &mut Tasks,
    ) {
        if file != self.path.as_ref() {
            self.forget();
            self.path = file.cloned();
            if let Some(path) = file.cloned() {
                self.is_loading = true;
                let read_path = path.clone();
                tasks.start(
                    TaskKey::Ground(path.clone()),
                    move |_| match LoadedGround::load(&path) {
                        Ok(ground) => Ok(Arc::new(ground)),
                        Err(error) => Err(error_chain(&error)),
                    },
                    |result| Command::Ground(GroundCommand::Read(read_path, result)),
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
    /// - `extent_m`: smallest and largest `[X, Y]` of the scene, m; `None` if there is no motion;
    /// - returns what the user has to know.
    pub(in crate::app) fn take(
        &mut self,
        path: &Path,
        result: Result<Arc<LoadedGround>, String>,
        extent_m: Option<[[f64; 2]; 2]>,
        units: UnitSystem,
    ) -> Vec<(Severity, String)> {
        if !self.is_loading || self.path.as_deref() != Some(path) {
            return Vec::new();
        }
        self.is_loading = false;
        match result {
            Ok(ground) => {
                let notes = ground.notes.iter().map(|note| (Severity::Info, note.clone()));
                let far = extent_m.map(|extent_m| ground.far_notes(extent_m, units));
                let far = far.into_iter().flatten().map(|note| (Severity::Warning, note));
                let messages = notes.chain(far).collect();
                self.read = Some(ground);
                messages
            }
            Err(why) => {
                self.problem = Some(why.clone());
                vec![(Severity::Error, why)]
            }
        }
    }
}
