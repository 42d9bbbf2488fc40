//! The time that is shown, and whether it runs.

use crate::app::command::TIME_STEP_S;

/// The time that scenes and plots show.
#[derive(Debug, Default)]
pub struct Playback {
    /// The time, s.
    pub time_s: f64,
    /// Whether it runs.
    pub is_playing: bool,
}

impl Playback {
    /// Stops at a time.
    ///
    /// - `end_s`: end of the motion, s.
    pub fn stop_at(&mut self, time_s: f64, end_s: f64) {
        *self = Self { time_s: time_s.clamp(0.0, end_s), is_playing: false };
    }

    /// Stops some arrow-key steps later; a negative number goes back.
    pub fn step(&mut self, steps: f64, end_s: f64) {
        self.stop_at(self.time_s + steps * TIME_STEP_S, end_s);
    }

    /// Starts or stops. At the end of the motion it starts again from zero.
    pub fn toggle(&mut self, end_s: f64) {
        self.is_playing = !self.is_playing;
        if self.is_playing && self.time_s >= end_s {
            self.time_s = 0.0;
        }
    }

    /// Lets time pass, and stops at the end of the motion.
    pub fn advance(&mut self, passed_s: f64, end_s: f64) {
        self.time_s += passed_s;
        if self.time_s >= end_s {
            *self = Self { time_s: end_s, is_playing: false };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_stops_at_the_ends_and_begins_again() {
        let mut playback = Playback::default();
        playback.toggle(0.5);
        playback.advance(0.2, 0.5);
        assert!(playback.is_playing && playback.time_s == 0.2);
        playback.advance(9.0, 0.5);
        assert!(!playback.is_playing && playback.time_s == 0.5);
        playback.toggle(0.5);
        assert!(playback.is_playing && playback.time_s == 0.0);
        playback.step(-1.0, 0.5);
        assert!(!playback.is_playing && playback.time_s == 0.0);
        playback.step(2.0, 0.5);
        assert!((playback.time_s - 2.0 * TIME_STEP_S).abs() < 1e-12);
    }
}
