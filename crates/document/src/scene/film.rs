//! Which instants of a scene a film shows, and how fast it plays them.
//!
//! A film has frames at the same distance in its own time τ. Time t of the scene follows from it by the
//! speed at which the film plays there:
//!
//! ```text
//! dt/dτ = speed(t)        t(0) = from        τₖ = k / frames per second
//! ```
//!
//! The speed is constant outside the sections and within each of them, so that the solution is linear
//! piece by piece and exact. The last frame shows the last instant.

use crate::scene::Scene;
use impactlab_core::ranges::{FILM_FRAMES, FILM_RATE, FILM_SPEED, OutOfRange};

/// An end of a film that is later than the motion by no more than this, s, or by the time of a frame, is
/// taken for the end of the motion: nobody types the instant at which a car comes to rest. An instant that
/// misses the film by no more than this belongs to it, too.
const END_TOLERANCE_S: f64 = 0.05;

/// A part of the scene that is played at a speed of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmSection {
    /// First instant, s of the scene.
    pub from_s: f64,
    /// Last instant, s of the scene.
    pub to_s: f64,
    /// Seconds of the scene that are played in a second, in [`FILM_SPEED`].
    pub speed: f64,
}

/// Which instants of a scene a film shows, and how fast it plays them.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmTiming {
    /// Frames per second of the film, in [`FILM_RATE`].
    pub frames_per_s: u32,
    /// First instant, s of the scene.
    pub from_s: f64,
    /// Last instant, s of the scene.
    pub to_s: f64,
    /// Seconds of the scene that are played in a second outside the sections, in [`FILM_SPEED`].
    pub speed: f64,
    /// Parts with a speed of their own, in any order, each at least partly within the film.
    pub sections: Vec<FilmSection>,
}

/// A frame of a film: the instant that it shows, and how fast the film plays there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmInstant {
    /// Time of the scene, s.
    pub time_s: f64,
    /// Seconds of the scene that are played in a second.
    pub speed: f64,
}

/// The reason why a film cannot be made of a scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FilmTimingError {
    /// A number is outside its range.
    #[error(transparent)]
    Range(#[from] OutOfRange),
    /// The film or a section of it ends before it begins.
    #[error("{what} from {from_s} s to {to_s} s; expected an end after the beginning")]
    Order {
        /// The film, or one of its sections.
        what: &'static str,
        /// First instant, s.
        from_s: f64,
        /// Last instant, s.
        to_s: f64,
    },
    /// The scene knows a single instant.
    #[error("nothing moves in the scene, so that there is nothing to film")]
    NoMotion,
    /// The film shows instants of which the scene knows nothing.
    #[error(
        "the film goes from {from_s} s to {to_s} s, expected times between {start_s:.3} s and {end_s:.3} s"
    )]
    Outside {
        /// First instant of the film, s.
        from_s: f64,
        /// Last instant of the film, s.
        to_s: f64,
        /// First instant of the scene, s.
        start_s: f64,
        /// Last instant of the scene, s.
        end_s: f64,
    },
    /// A section lies before or after the film.
    #[error(
        "a section from {from_s} s to {to_s} s lies outside the film, expected times between {film_from_s:.3} s \
         and {film_to_s:.3} s"
    )]
    SectionOutside {
        /// First instant of the section, s.
        from_s: f64,
        /// Last instant of the section, s.
        to_s: f64,
        /// First instant of the film, s.
        film_from_s: f64,
        /// Last instant of the film, s.
        film_to_s: f64,
    },
    /// Two sections share instants.
    #[error(
        "two sections of the film have a speed at {at_s} s; expected sections that do not overlap"
    )]
    Overlap {
        /// Where the second one begins, s.
        at_s: f64,
    },
}

impl FilmTiming {
    /// Thirty frames per second of a whole scene at its own speed.
    pub fn from_scene(scene: &Scene) -> Self {
        let [from_s, to_s] = interval_s(scene);
        Self { frames_per_s: 30, from_s, to_s, speed: 1.0, sections: Vec::new() }
    }

    /// The same film with an end that the scene knows, if it ends later than the scene by less than a frame
    /// or 0.05 s; any other film as it is.
    ///
    /// ```text
    /// to' = end    if 0 < to − end < max(0.05 s, speed / frames per second)
    /// ```
    ///
    /// - returns the film, and where it ended before if its end was moved, s.
    pub fn ending_with_scene(mut self, scene: &Scene) -> (Self, Option<f64>) {
        let [_, end_s] = interval_s(scene);
        let wanted_s = self.to_s;
        let frame_s = self.speed / f64::from(self.frames_per_s);
        let is_moved = wanted_s > end_s && wanted_s - end_s < frame_s.max(END_TOLERANCE_S);
        if is_moved {
            self.to_s = end_s;
        }
        (self, is_moved.then_some(wanted_s))
    }

    /// Whether an instant belongs to the film, or misses it by no more than 0.05 s.
    pub fn shows(&self, time_s: f64) -> bool {
        (self.from_s - END_TOLERANCE_S..=self.to_s + END_TOLERANCE_S).contains(&time_s)
    }

    /// Duration of the film, s of its own time.
    ///
    /// # Errors
    /// As for [`FilmTiming::instants`].
    pub fn duration_s(&self, scene: &Scene) -> Result<f64, FilmTimingError> {
        Ok(self.pieces(scene)?.iter().map(Piece::duration_s).sum())
    }

    /// The frames of the film in their order, at least two.
    ///
    /// # Errors
    /// [`FilmTimingError`]: a number outside its range, an end before a beginning, instants outside the
    /// scene, sections that overlap or lie outside the film, or more frames than [`FILM_FRAMES`] permits.
    pub fn instants(&self, scene: &Scene) -> Result<Vec<FilmInstant>, FilmTimingError> {
        let pieces = self.pieces(scene)?;
        let duration_s: f64 = pieces.iter().map(Piece::duration_s).sum();
        let rate = f64::from(self.frames_per_s);
        // A millionth of a frame is the rounding of a sum, not one more frame.
        let n_before_last = (duration_s * rate - 1e-6).ceil().max(1.0);
        FILM_FRAMES.check(n_before_last + 1.0)?;
        let mut instants = Vec::with_capacity(n_before_last as usize + 1);
        let (mut idx, mut begin_s) = (0, 0.0);
        for frame in 0..n_before_last as u64 {
            let film_s = frame as f64 / rate;
            while let Some(piece) = pieces.get(idx)
                && film_s >= begin_s + piece.duration_s()
                && idx + 1 < pieces.len()
            {
                begin_s += piece.duration_s();
                idx += 1;
            }
            let Some(piece) = pieces.get(idx) else { break };
            let time_s = (piece.from_s + (film_s - begin_s) * piece.speed).min(piece.to_s);
            instants.push(FilmInstant { time_s, speed: piece.speed });
        }
        let speed = pieces.last().map_or(self.speed, |piece| piece.speed);
        instants.push(FilmInstant { time_s: self.to_s, speed });
        Ok(instants)
    }

    /// The parts of the film, each with one speed.
    fn pieces(&self, scene: &Scene) -> Result<Vec<Piece>, FilmTimingError> {
        let sections = self.checked_sections(scene)?;
        let mut pieces = Vec::with_capacity(2 * sections.len() + 1);
        let mut at_s = self.from_s;
        for section in sections {
            let (from_s, to_s) = (section.from_s.max(self.from_s), section.to_s.min(self.to_s));
            if at_s < from_s {
                pieces.push(Piece { from_s: at_s, to_s: from_s, speed: self.speed });
            }
            pieces.push(Piece { from_s, to_s, speed: section.speed });
            at_s = to_s;
        }
        if at_s < self.to_s {
            pieces.push(Piece { from_s: at_s, to_s: self.to_s, speed: self.speed });
        }
        Ok(pieces)
    }

    /// The sections in the order of time.
    fn checked_sections(&self, scene: &Scene) -> Result<Vec<FilmSection>, FilmTimingError> {
        FILM_RATE.check_count(u64::from(self.frames_per_s))?;
        FILM_SPEED.check(self.speed)?;
        let Self { from_s, to_s, .. } = *self;
        let [start_s, end_s] = interval_s(scene);
        if start_s >= end_s {
            return Err(FilmTimingError::NoMotion);
        }
        let within = start_s..=end_s;
        if !(within.contains(&from_s) && within.contains(&to_s)) {
            return Err(FilmTimingError::Outside { from_s, to_s, start_s, end_s });
        }
        if from_s >= to_s {
            return Err(FilmTimingError::Order { what: "the film goes", from_s, to_s });
        }
        let mut sections = self.sections.clone();
        for FilmSection { from_s, to_s, speed } in &sections {
            FILM_SPEED.check(*speed)?;
            // A number that is none is no end after the beginning either.
            if !(from_s.is_finite() && to_s.is_finite() && from_s < to_s) {
                let (what, from_s, to_s) = ("a section goes", *from_s, *to_s);
                return Err(FilmTimingError::Order { what, from_s, to_s });
            }
            let (film_from_s, film_to_s) = (self.from_s, self.to_s);
            if *to_s <= film_from_s || film_to_s <= *from_s {
                let (from_s, to_s) = (*from_s, *to_s);
                return Err(FilmTimingError::SectionOutside {
                    from_s,
                    to_s,
                    film_from_s,
                    film_to_s,
                });
            }
        }
        sections.sort_by(|a, b| a.from_s.total_cmp(&b.from_s));
        match sections.windows(2).find(|pair| pair[1].from_s < pair[0].to_s) {
            Some(pair) => Err(FilmTimingError::Overlap { at_s: pair[1].from_s }),
            None => Ok(sections),
        }
    }
}

/// A part of a film with one speed.
struct Piece {
    from_s: f64,
    to_s: f64,
    speed: f64,
}

impl Piece {
    /// Duration in the film, s.
    fn duration_s(&self) -> f64 {
        (self.to_s - self.from_s) / self.speed
    }
}

/// First and last instant of a scene, s: from the first one of the car that is followed by default.
fn interval_s(scene: &Scene) -> [f64; 2] {
    let first = scene.struck().and_then(|car| car.motion.time_s().first().copied());
    [first.unwrap_or(0.0).min(scene.end_s), scene.end_s]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(end_s: f64) -> Scene {
        Scene { end_s, ..Scene::default() }
    }

    fn timing(to_s: f64, sections: &[(f64, f64, f64)]) -> FilmTiming {
        let section = |&(from_s, to_s, speed)| FilmSection { from_s, to_s, speed };
        let sections = sections.iter().map(section).collect();
        FilmTiming { frames_per_s: 10, from_s: 0.0, to_s, speed: 1.0, sections }
    }

    #[test]
    fn a_film_without_sections_has_equal_steps_and_ends_at_the_end() {
        let instants = timing(1.0, &[]).instants(&scene(1.0)).unwrap();
        assert_eq!(instants.len(), 11);
        for (idx, instant) in instants.iter().enumerate() {
            assert!((instant.time_s - idx as f64 / 10.0).abs() < 1e-12, "{idx}: {instant:?}");
            assert_eq!(instant.speed, 1.0);
        }
        let instants = timing(0.95, &[]).instants(&scene(1.0)).unwrap();
        assert_eq!(instants.last().map(|last| last.time_s), Some(0.95));
        assert_eq!(instants.len(), 11);
    }

    #[test]
    fn a_slow_section_takes_as_much_longer_as_it_is_slower() {
        // 0.2 s at 1, 0.4 s at a tenth, 0.4 s at 1: 4.6 s.
        let slow = timing(1.0, &[(0.2, 0.6, 0.1)]);
        assert!((slow.duration_s(&scene(1.0)).unwrap() - 4.6).abs() < 1e-9);
        let instants = slow.instants(&scene(1.0)).unwrap();
        assert_eq!(instants.len(), 47);
        for pair in instants.windows(2) {
            let step_s = pair[1].time_s - pair[0].time_s;
            assert!(step_s > 0.0 && step_s < 0.1 + 1e-9, "{pair:?}");
        }
        let inside: Vec<_> = instants.iter().filter(|instant| instant.speed == 0.1).collect();
        assert_eq!(inside.len(), 40);
        assert!(inside.iter().all(|instant| (0.2 - 1e-9..=0.6 + 1e-9).contains(&instant.time_s)));
    }

    #[test]
    fn sections_beyond_the_film_are_refused_and_others_cut() {
        for (from_s, to_s) in [(2.0, 3.0), (1.0, 1.5), (-2.0, 0.0)] {
            let error = timing(1.0, &[(from_s, to_s, 0.1)]).instants(&scene(5.0)).unwrap_err();
            let expected = format!(
                "a section from {from_s} s to {to_s} s lies outside the film, expected times between 0.000 s and 1.000 s"
            );
            assert_eq!(error.to_string(), expected);
        }
        let film = timing(1.0, &[(0.95, 3.0, 0.01), (0.9, 4.0, 0.5), (-1.0, 0.1, 2.0)]);
        let overlapping = film.instants(&scene(5.0));
        assert_eq!(overlapping, Err(FilmTimingError::Overlap { at_s: 0.95 }));
        let film = timing(1.0, &[(0.9, 4.0, 0.5), (-1.0, 0.1, 2.0)]);
        assert!((film.duration_s(&scene(5.0)).unwrap() - (0.05 + 0.8 + 0.2)).abs() < 1e-9);
    }

    #[test]
    fn an_end_just_after_the_motion_is_its_end_and_a_later_one_is_refused() {
        let whole = scene(3.99);
        for (to_s, frames_per_s, speed, moved) in [
            (4.0, 30, 1.0, true),
            (4.039, 120, 0.1, true),
            (4.041, 120, 0.1, false),
            (4.08, 10, 1.0, true),
            (4.1, 10, 1.0, false),
            (3.99, 30, 1.0, false),
            (3.0, 30, 1.0, false),
            (900.0, 30, 1.0, false),
            (f64::NAN, 30, 1.0, false),
        ] {
            let wanted = FilmTiming { frames_per_s, speed, ..timing(to_s, &[]) };
            let (film, before_s) = wanted.ending_with_scene(&whole);
            assert_eq!(before_s, moved.then_some(to_s), "{to_s} s, {frames_per_s} in a second");
            let is_known = moved || to_s <= 3.99;
            assert_eq!(film.instants(&whole).is_ok(), is_known, "{to_s} s, {frames_per_s}");
            if moved {
                let last = film.instants(&whole).unwrap().pop().map(|instant| instant.time_s);
                assert_eq!(last, Some(3.99));
            }
        }
    }

    #[test]
    fn a_scene_in_which_nothing_moves_is_not_filmed() {
        let still = scene(0.0);
        let error = FilmTiming::from_scene(&still).instants(&still);
        assert_eq!(error, Err(FilmTimingError::NoMotion));
    }

    #[test]
    fn nonsense_is_refused() {
        let whole = scene(2.0);
        let outside = timing(2.5, &[]).instants(&whole).unwrap_err().to_string();
        assert!(outside.contains("between 0.000 s and 2.000 s"), "{outside}");
        for (to_s, sections) in [
            (0.0, vec![]),
            (f64::NAN, vec![]),
            (1.0, vec![(0.5, 0.5, 1.0)]),
            (1.0, vec![(f64::NAN, 0.5, 1.0)]),
            (1.0, vec![(0.1, 0.5, 0.0)]),
            (1.0, vec![(0.1, 0.5, f64::NAN)]),
        ] {
            assert!(timing(to_s, &sections).instants(&whole).is_err(), "{to_s} {sections:?}");
        }
        let endless = FilmTiming { speed: 0.001, frames_per_s: 120, ..timing(2.0, &[]) };
        let error = endless.instants(&whole).unwrap_err().to_string();
        assert!(error.starts_with("frames of a film is 240001"), "{error}");
        let never = FilmTiming { frames_per_s: 0, ..timing(2.0, &[]) };
        assert!(never.instants(&whole).is_err());
    }
}
