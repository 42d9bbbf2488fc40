//! The time that is shown, and whether it runs.

use crate::app::state::State;
use crate::app::workspaces::Workspace;
use impactlab_core::data::contact_interval;
use impactlab_study::SimulateAnswer;

/// Time step of the left and right arrow keys in the scene, s.
pub(in crate::app) const TIME_STEP_S: f64 = 0.05;

/// An action on the time that is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlaybackCommand {
    /// Set the time, in seconds.
    SetTime(f64),
    /// Move the time by this number of arrow-key steps of 0.05 s and stop; negative values move back.
    Step(f64),
    /// Move the time to the end of the contact, if the force is known, and stop.
    ToContactEnd,
    /// Start or stop. At the end of the motion it starts again from zero.
    Toggle,
}

/// The time that scenes and plots show.
#[derive(Debug, Default)]
pub struct Playback {
    /// The time, s.
    pub time_s: f64,
    /// Whether it runs.
    pub is_playing: bool,
}

impl Playback {
    /// Carries out a command.
    ///
    /// - `contact_end_s`: end of the contact, s, if it is known and shown;
    /// - `end_s`: end of the motion, s.
    fn apply(&mut self, command: PlaybackCommand, contact_end_s: Option<f64>, end_s: f64) {
        match command {
            PlaybackCommand::SetTime(time_s) => self.time_s = time_s,
            PlaybackCommand::Step(steps) => self.stop_at(self.time_s + steps * TIME_STEP_S, end_s),
            PlaybackCommand::ToContactEnd => {
                if let Some(time_s) = contact_end_s {
                    self.stop_at(time_s, end_s);
                }
            }
            PlaybackCommand::Toggle => {
                self.is_playing = !self.is_playing;
                if self.is_playing && self.time_s >= end_s {
                    self.time_s = 0.0;
                }
            }
        }
    }

    fn stop_at(&mut self, time_s: f64, end_s: f64) {
        *self = Self { time_s: time_s.clamp(0.0, end_s), is_playing: false };
    }

    /// Lets time pass, and stops at the end of the motion.
    pub fn advance(&mut self, passed_s: f64, end_s: f64) {
        self.time_s += passed_s;
        if self.time_s >= end_s {
            *self = Self { time_s: end_s, is_playing: false };
        }
    }
}

impl State {
    /// Carries out a command on the time that is shown.
    pub(in crate::app) fn play(&mut self, command: PlaybackCommand) {
        let (contact_end_s, end_s) = (self.contact_end_s(), self.end_time_s());
        self.session.playback.apply(command, contact_end_s, end_s);
    }

    fn contact_end_s(&self) -> Option<f64> {
        // The motions of a reconstruction begin with an impact of no duration.
        if self.view.workspaces.shown == Workspace::Reconstruct {
            return None;
        }
        let force = self.analysis()?.analysis.force.as_ref();
        force.and_then(contact_interval).map(|(_, end_s)| end_s)
    }

    /// Returns the last time of the simulation of the subject, or of its recorded motion if it is
    /// not simulated, in seconds; in the workspace of the reconstruction, that of the path that is
    /// followed; 0 without any.
    pub fn end_time_s(&self) -> f64 {
        if self.view.workspaces.shown == Workspace::Reconstruct {
            return self.session.reconstruction.end_time_s();
        }
        let last = |SimulateAnswer { analysis, .. }: &SimulateAnswer| {
            let simulation = analysis.simulation.as_ref().map(|motion| &motion.series);
            let series = simulation.or(analysis.reference.as_ref())?;
            series.time_s().last().copied()
        };
        self.analysis().and_then(last).unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_stops_at_the_ends_and_begins_again() {
        let mut playback = Playback::default();
        playback.apply(PlaybackCommand::Toggle, None, 0.5);
        playback.advance(0.2, 0.5);
        assert!(playback.is_playing && playback.time_s == 0.2);
        playback.advance(9.0, 0.5);
        assert!(!playback.is_playing && playback.time_s == 0.5);
        playback.apply(PlaybackCommand::Toggle, None, 0.5);
        assert!(playback.is_playing && playback.time_s == 0.0);
        playback.apply(PlaybackCommand::Step(-1.0), None, 0.5);
        assert!(!playback.is_playing && playback.time_s == 0.0);
        playback.apply(PlaybackCommand::Step(2.0), None, 0.5);
        assert!((playback.time_s - 2.0 * TIME_STEP_S).abs() < 1e-12);
        playback.apply(PlaybackCommand::ToContactEnd, Some(0.3), 0.5);
        assert_eq!(playback.time_s, 0.3);
    }
}
