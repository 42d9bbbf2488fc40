//! Makes films in the background.

use std::path::{Path, PathBuf};

use crate::app::command::Command;
use crate::app::dialog::Dialog;
use crate::app::film::FilmForm;
use crate::app::state::{Session, State};
use crate::app::tasks::TaskKey;
use impactlab_core::data::{Existing, Outcome, Severity};
use impactlab_core::error_chain;
use impactlab_draw::film::{Film, write_film};
use impactlab_draw::scene::{CameraKey, ScenePicture};

/// An action on the film of a scene.
#[derive(Debug, Clone)]
pub enum FilmCommand {
    /// Ask how a film is to be made of a scene as it is seen, with the keys of its camera.
    Ask(Box<ScenePicture>, Vec<CameraKey>),
    /// Cancel the film that is being made.
    Cancel,
    /// Say how the film for a file has ended.
    Ended(PathBuf, Result<Outcome<()>, String>),
}

impl State {
    /// Carries out a command on the film of a scene.
    pub(in crate::app) fn film(&mut self, command: FilmCommand) {
        let Session { dialogs, tasks, .. } = &mut self.session;
        match command {
            FilmCommand::Ask(picture, keys) => {
                let form = FilmForm::new(*picture, keys, self.view.dark);
                dialogs.open(Dialog::Film(Box::new(form)));
            }
            FilmCommand::Cancel => {
                if let Some(path) = tasks.film() {
                    tasks.cancel(&TaskKey::Film(path.to_owned()));
                }
            }
            FilmCommand::Ended(path, result) => self.say_of_film(&path, result),
        }
    }

    /// Tells the user how a film has ended.
    fn say_of_film(&mut self, path: &Path, result: Result<Outcome<()>, String>) {
        match result {
            Ok(Outcome::Complete(())) => self.say_of_file(Ok(path.to_owned())),
            Ok(Outcome::Cancelled) => {
                self.say(Severity::Info, format!("{} not written: cancelled", path.display()));
            }
            Err(why) => self.say(Severity::Error, why),
        }
    }

    /// Starts to make a film and closes its form, unless another one is being made.
    pub(in crate::app) fn make_film(&mut self, film: Film, path: PathBuf, existing: Existing) {
        if let Some(other) = self.session.tasks.film() {
            let text = format!("{} is being made; wait for it or cancel it", other.display());
            self.say(Severity::Warning, text);
            return;
        }
        self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Film(_)));
        let target = path.clone();
        self.session.tasks.start_in_background(
            TaskKey::Film(path.clone()),
            move |report| {
                write_film(&film, &target, existing, report).map_err(|error| error_chain(&error))
            },
            |result| Command::Film(FilmCommand::Ended(path, result)),
        );
    }
}
