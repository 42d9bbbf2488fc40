//! A log as it was read, and what can be wrong with it.

use std::path::PathBuf;

use impactlab_core::collision::PulseError;
use impactlab_core::data::{ContactOutside, SeriesError, TimeSeries};

/// A log as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionLog {
    /// The file of the log.
    pub path: PathBuf,
    /// Time, x, y, yaw, and perhaps yaw rate, v_x and v_y, roll, roll rate, steer of the road wheels; the
    /// rest is not looked at.
    pub series: TimeSeries,
}

/// A log from which nothing can be learned.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// The log lacks a column.
    #[error("{}: cannot be used", path.display())]
    Series {
        /// The log.
        path: PathBuf,
        /// What the log lacks.
        source: SeriesError,
    },
    /// The log is longer than the search for an impact is meant for; its time is probably wrong.
    #[error("{}: lasts {duration_s} s, expected {limit_s} s or less; check its time or cut it", path.display())]
    TooLong {
        /// The log.
        path: PathBuf,
        /// From the first sample to the last, s.
        duration_s: f64,
        /// Longest log, s.
        limit_s: f64,
    },
    /// The log ends too soon after the impact.
    #[error("{}: {duration_s:.3} s of motion from the first contact at {start_s} s on, expected {least_s} s or more", path.display())]
    TooShort {
        /// The log.
        path: PathBuf,
        /// First contact, s.
        start_s: f64,
        /// Time that the log goes on after the impact, s.
        duration_s: f64,
        /// Shortest time that is needed, s.
        least_s: f64,
    },
    /// The contact lies outside.
    #[error("{}: first contact at {contact_s} s, expected between {from_s} s and {to_s} s as the log; force and log need one clock", path.display())]
    ContactOutside {
        /// The log.
        path: PathBuf,
        /// First contact, s.
        contact_s: f64,
        /// The log's first instant, s.
        from_s: f64,
        /// The log's last instant, s.
        to_s: f64,
    },
    /// A part of the force acts before or after the motion that is learned from.
    #[error(
        "{}: the motion from {start_s} s on, counted from there, does not hold the whole force: {outside}",
        path.display()
    )]
    ForceOutside {
        /// The log.
        path: PathBuf,
        /// Where the motion begins on the log's clock, s.
        start_s: f64,
        /// When the force acts, counted from there, and how long the motion is.
        outside: ContactOutside,
    },
    /// The numbers make no motion.
    #[error("{}: no motion goes through the samples; check units and signs", path.display())]
    NoMotion {
        /// The log.
        path: PathBuf,
    },
    /// The impulse makes no pulse.
    #[error("{}: no pulse explains the change of momentum", path.display())]
    Pulse {
        /// The log.
        path: PathBuf,
        /// Why.
        source: PulseError,
    },
}

impl MotionLog {
    /// First and last instant, s.
    pub(super) fn ends_s(&self) -> [f64; 2] {
        let time_s = self.series.time_s();
        [time_s.first(), time_s.last()].map(|time| time.copied().unwrap_or_default())
    }
}
