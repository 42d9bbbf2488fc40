//! Makes films in the background.

use std::path::{Path, PathBuf};

use crate::app::command::Command;
use crate::app::dialog::Dialog;
use crate::app::state::State;
use crate::app::tasks::TaskKey;
use impactlab_core::data::{Existing, Outcome, Severity};
use impactlab_core::error_chain;
use impactlab_draw::film::{Film, write_film};

impl State {
    /// Tells the user how a film has ended.
    pub(in crate::app) fn say_of_film(&mut self, path: &Path, result: Result<Outcome<()>, String>) {
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
            |result| Command::FilmEnded(path, result),
        );
    }
}
