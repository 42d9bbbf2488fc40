//! What is asked before a film is made.

use impactlab_document::scene::{FilmSection, FilmTiming};
use impactlab_draw::Canvas;
use impactlab_draw::film::Film;
use impactlab_draw::scene::{CameraKey, ScenePicture};

/// Duration and speed of a part in slow motion that is added to a form, s and seconds in a second.
const USUAL_SECTION: (f64, f64) = (0.3, 0.1);

/// What is asked before a film is made.
#[derive(Debug, Clone)]
pub struct FilmForm {
    /// The film as the form has it.
    pub film: Film,
    /// The keys of the camera, which the film has if the camera is to move.
    keys: Vec<CameraKey>,
}

impl FilmForm {
    /// A film of the whole scene at its own speed, as it is seen, or with a camera that moves between keys.
    pub fn new(picture: ScenePicture, keys: Vec<CameraKey>, dark: bool) -> Self {
        let timing = FilmTiming::from_scene(&picture.scene);
        let canvas = Canvas { dark, ..Canvas::default() };
        Self { film: Film { picture, timing, canvas, keys: keys.clone() }, keys }
    }

    /// The keys of the camera, whether the film has them or not.
    pub fn keys(&self) -> &[CameraKey] {
        &self.keys
    }

    /// Says whether the camera moves between its keys.
    pub fn move_camera(&mut self, moves: bool) {
        self.film.keys = if moves { self.keys.clone() } else { Vec::new() };
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
