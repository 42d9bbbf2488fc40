//! Films of the scene: the form that asks how, and the job that makes one in the background.

use std::path::{Path, PathBuf};

use egui::Context;

use crate::app::command::wake;
use crate::app::dialog::Dialog;
use crate::app::state::State;
use impactlab_core::data::{Existing, Outcome, Severity};
use impactlab_core::error_chain;
use impactlab_core::jobs::Job;
use impactlab_document::scene::{FilmSection, FilmTiming};
use impactlab_draw::Canvas;
use impactlab_draw::film::{Film, write_film};
use impactlab_draw::scene::ScenePicture;

/// Duration and speed of a part in slow motion that is added to a form, s and seconds in a second.
const USUAL_SECTION: (f64, f64) = (0.3, 0.1);

/// The thread that makes a film.
type FilmJob = Job<Result<Outcome<()>, String>>;

/// The film that is being made.
#[derive(Default)]
pub struct FilmSession {
    running: Option<(PathBuf, FilmJob)>,
}

/// What is asked before a film is made.
#[derive(Debug, Clone)]
pub struct FilmForm {
    /// The film as the form has it.
    pub film: Film,
}

impl FilmForm {
    /// A film of the whole scene at its own speed, as it is seen.
    pub fn new(picture: ScenePicture, dark: bool) -> Self {
        let timing = FilmTiming::of_scene(&picture.scene);
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

impl FilmSession {
    /// The film that is being made: its file, and the job, which knows its progress.
    pub fn running(&self) -> Option<(&Path, &FilmJob)> {
        self.running.as_ref().map(|(path, job)| (path.as_path(), job))
    }

    /// Cancels the film that is being made. Nothing is written then.
    pub fn cancel(&self) {
        if let Some((_, job)) = &self.running {
            job.cancel();
        }
    }

    /// Whether the film that is being made has been cancelled, or what there is to say of its end.
    fn poll(&mut self) -> Option<(Severity, String)> {
        let (_, job) = self.running.as_mut()?;
        let result = job.poll().into_result("the film")?;
        let (path, _) = self.running.take()?;
        Some(match result {
            Ok(Outcome::Complete(())) => (Severity::Info, format!("{} written", path.display())),
            Ok(Outcome::Cancelled) => {
                (Severity::Info, format!("{} not written: cancelled", path.display()))
            }
            Err(why) => (Severity::Error, why),
        })
    }
}

impl State {
    /// Receives the end of the film that is being made.
    pub(in crate::app) fn poll_film(&mut self) {
        if let Some((severity, text)) = self.session.film.poll() {
            self.say(severity, text);
        }
    }

    /// Starts to make a film and closes its form, unless another one is being made.
    pub(in crate::app) fn make_film(
        &mut self,
        film: Film,
        (path, existing): (PathBuf, Existing),
        context: &Context,
    ) {
        if let Some((other, _)) = self.session.film.running() {
            let text = format!("{} is being made; wait for it or cancel it", other.display());
            self.say(Severity::Warning, text);
            return;
        }
        let target = path.clone();
        let job = Job::spawn_in_background("film", wake(context), move |report| {
            write_film(&film, (&target, existing), report).map_err(|error| error_chain(&error))
        });
        match job {
            Ok(job) => {
                self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Film(_)));
                self.session.film.running = Some((path, job));
            }
            Err(error) => self.say(Severity::Error, error.to_string()),
        }
    }
}
