//! Films of the scene: the form that asks how, and the task that makes one in the background.

use std::path::{Path, PathBuf};

use crate::app::command::Command;
use crate::app::dialog::Dialog;
use crate::app::state::State;
use crate::app::tasks::TaskKey;
use impactlab_core::data::{Existing, Outcome, Severity};
use impactlab_core::error_chain;
use impactlab_document::scene::{FilmSection, FilmTiming};
use impactlab_draw::Canvas;
use impactlab_draw::film::{Film, write_film};
use impactlab_draw::scene::ScenePicture;

/// Duration and speed of a part in slow motion that is added to a form, s and seconds in a second.
const USUAL_SECTION: (f64, f64) = (0.3, 0.1);

/// What is asked before a film is made.
#[derive(Debug, Clone)]
pub struct FilmForm {
    /// The film as the form has it.
    pub film: Film,
}

impl FilmForm {
    /// A film of the whole scene at its own speed, as it is seen.
    pub fn new(picture: ScenePicture, dark: bool) -> Self {
        let timing = FilmTiming::from_scene(&picture.scene);
        let canvas = Canvas { size_px: [1920, 1080], dark, ..Canvas::default() };
        Self { film: Film { picture, timing, canvas } }
    }

    /// Adds a part in slow motion after those that are there.
    pub fn add_section(&mut self) {
        let timing = &mut self.film.timing;
        let ends = timing.sections.iter().map(|section| section.to_s);
        let from_s = ends.fold(timing.from_s, f64::max);
        let (duration_s, speed) = USUAL_SECTION;
        timing.sections.push(FilmSection { from_s, to_s: from_s + duration_s, speed });
    }
}

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
                write_film(&film, (&target, existing), report).map_err(|error| error_chain(&error))
            },
            |result| Command::FilmEnded(path, result),
        );
    }
}
