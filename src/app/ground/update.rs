//! Opens, changes and saves the ground of the scene.

use std::path::{Path, PathBuf};

use crate::app::command::Command;
use crate::app::dialog::Dialog;
use crate::app::ground::cloud::{CloudForm, MadeGround, make_ground};
use crate::app::ground::command::GroundCommand;
use crate::app::panes::Pane;
use crate::app::state::{Session, State};
use crate::app::tasks::TaskKey;
use crate::app::workspaces::Workspace;
use impactlab_core::data::{Existing, Severity, write_bytes};
use impactlab_core::error_chain;
use impactlab_core::ranges::SITE_DISTANCE;

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
            GroundCommand::MakeOfCloud(form) => self.session.tasks.start_in_background(
                TaskKey::MakeGround,
                move |report| make_ground(&form, report),
                |made| Command::Ground(GroundCommand::CloudMade(made)),
            ),
            GroundCommand::StopCloud => self.session.tasks.cancel(&TaskKey::MakeGround),
            GroundCommand::CloudMade(made) => self.take_made_ground(made),
            GroundCommand::Read(path, result) => {
                let extent_m = self.session.scene.extent_m();
                let extent_m = self.project.subject().map(|_| extent_m.unwrap_or_default());
                let units = self.view.units;
                for (severity, text) in self.session.ground.take(&path, result, extent_m, units) {
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

    /// Asks how a point cloud becomes a ground.
    pub(in crate::app) fn ask_cloud(&mut self, path: PathBuf) {
        self.session.dialogs.open(Dialog::Cloud(Box::new(CloudForm::new(path))));
    }

    /// Shows the ground that was made of a point cloud. If there is none, the dialog stays open.
    fn take_made_ground(&mut self, made: Result<Option<MadeGround>, String>) {
        match made {
            Ok(Some(MadeGround { site, notes })) => {
                self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Cloud(_)));
                self.say(Severity::Info, format!("{} written", site.display()));
                notes.into_iter().for_each(|note| self.say(Severity::Info, note));
                self.open_ground(site);
            }
            Ok(None) => {}
            Err(why) => self.say(Severity::Error, why),
        }
    }

    /// Writes the site that is shown as a site file, which becomes that of the project.
    pub(in crate::app) fn save_site(&mut self, path: &Path, existing: Existing) {
        let Some(ground) = self.session.ground.shown().cloned() else { return };
        let text = match ground.site.to_toml(path.parent().unwrap_or(Path::new(""))) {
            Ok(text) => text,
            Err(error) => return self.say(Severity::Error, error.to_string()),
        };
        match write_bytes(path, existing, text.as_bytes()) {
            Ok(()) => {
                self.say(Severity::Info, format!("{} written", path.display()));
                self.project.put_on_site(Some(path.to_owned()));
                self.session.ground.forget();
            }
            Err(error) => self.say(Severity::Error, error_chain(&error)),
        }
    }
}
