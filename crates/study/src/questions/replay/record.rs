//! The seconds before a crash as a recorder has kept them.

use std::path::Path;

use crate::questions::replay::unknowns::SPEED_ROUNDING_M_S;
use crate::{ReplayRequest, StudyError};
use impactlab_core::data::{RecordedControls, RecorderRecord};
use impactlab_core::ranges::STEER_ANGLE;

/// Start of a replay where nobody says it, s on the clock of the recorder.
const EARLIEST_S: f64 = -30.0;

/// Earliest last sample of which a contact is told, s.
const LATEST_SAMPLE_S: f64 = -5.0;

/// Shortest time between two samples, s.
const SHORTEST_STEP_S: f64 = 1e-3;

/// Longest time between two samples, s: what happened between them is not to be known from either.
const LONGEST_STEP_S: f64 = 1.05;

/// Fewest samples of a record: from two nothing is known of how the values change between them.
const MIN_SAMPLES: usize = 3;

/// Most samples of a record.
const MAX_SAMPLES: usize = 5000;

/// A record of which every sample can be followed.
#[derive(Debug, Clone)]
pub(super) struct Record {
    /// What the file is.
    pub description: String,
    /// The event of several; empty if the file says none.
    pub event: String,
    /// What a person should look at before the record is used.
    pub doubts: Vec<String>,
    /// The samples that are followed, with the angle of the steering wheel positive to the left and without the
    /// yaw rate.
    pub samples: RecordedControls,
    /// The yaw rate, rad/s, positive to the left; empty without one.
    pub yaw_rate_rad_s: Vec<f64>,
    /// Earlier samples that are not followed.
    pub n_earlier: usize,
}

impl ReplayRequest {
    /// Reads the recorder's file.
    ///
    /// # Errors
    /// [`StudyError`] if it cannot be read or has not what is needed to follow it.
    pub(super) fn record(&self) -> Result<Record, StudyError> {
        let path = &self.recorder;
        let mut record = RecorderRecord::read(path, self.event)?;
        if self.yaw_rate_left {
            record.turn_yaw_rate();
        }
        if self.steering_right {
            record.turn_steering();
        }
        let from_s = self.from_s.unwrap_or(EARLIEST_S);
        let RecorderRecord { description, event, doubts, before, .. } = record;
        let n_earlier = before.time_s.partition_point(|time_s| *time_s < from_s - 1e-9);
        let mut samples = without_first(before, n_earlier);
        check(path, &doubts, &samples)?;
        let ratio = self.ratio();
        for angle_rad in &samples.steering_wheel_rad {
            STEER_ANGLE.check(angle_rad / ratio).map_err(|source| StudyError::RoadWheel {
                path: path.clone(),
                ratio,
                source,
            })?;
        }
        let to_right = std::mem::take(&mut samples.yaw_rate_right_rad_s);
        let yaw_rate_rad_s = to_right.into_iter().map(|rate| 0.0 - rate).collect();
        Ok(Record { description, event, doubts, samples, yaw_rate_rad_s, n_earlier })
    }
}

impl Record {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.samples.time_s.len()
    }

    /// First and last sample, s on the clock of the recorder.
    pub fn ends_s(&self) -> [f64; 2] {
        let time_s = &self.samples.time_s;
        [time_s.first(), time_s.last()].map(|time_s| time_s.copied().unwrap_or(0.0))
    }

    /// Longest time from the last sample to the first contact, s: the time that the clock says, and one step,
    /// since samples are not taken at the moment of the contact.
    pub fn longest_gap_s(&self) -> f64 {
        let [_, last_s] = self.ends_s();
        self.last_step_s() - last_s
    }

    /// Time between the last two samples, s.
    pub fn last_step_s(&self) -> f64 {
        match self.samples.time_s.as_slice() {
            [.., before_s, last_s] => last_s - before_s,
            _ => 0.0,
        }
    }

    /// Acceleration between the last two samples, m/s².
    pub fn last_acceleration_m_s2(&self) -> f64 {
        self.last_slope(&self.samples.speed_m_s)
    }

    /// Change of a value over time between the last two samples.
    pub fn last_slope(&self, values: &[f64]) -> f64 {
        match (values, self.last_step_s()) {
            ([.., before, last], step_s) if step_s > 0.0 => (last - before) / step_s,
            _ => 0.0,
        }
    }

    /// Whether the vehicle was braked at the last sample: by its switch, else by its speed.
    pub fn ends_braked(&self) -> bool {
        let by_speed = self.last_acceleration_m_s2() < -1.0;
        self.samples.is_braked.last().copied().unwrap_or(by_speed) || by_speed
    }
}

fn without_first(mut all: RecordedControls, n: usize) -> RecordedControls {
    fn cut<T>(values: &mut Vec<T>, n: usize) {
        values.drain(..n.min(values.len()));
    }
    for values in [
        &mut all.time_s,
        &mut all.speed_m_s,
        &mut all.steering_wheel_rad,
        &mut all.yaw_rate_right_rad_s,
    ] {
        cut(values, n);
    }
    cut(&mut all.is_braked, n);
    cut(&mut all.is_anti_lock_active, n);
    all
}

/// Refuses a record that cannot be followed, and says what is missing.
fn check(path: &Path, doubts: &[String], samples: &RecordedControls) -> Result<(), StudyError> {
    let Some((got, expected)) = fault(samples) else { return Ok(()) };
    let got = match doubts {
        [] => got,
        doubts => format!("{got} ({})", doubts.join("; ")),
    };
    Err(StudyError::WrongKind { path: path.to_owned(), got, expected })
}

/// What of the samples cannot be followed, and what is expected.
fn fault(samples: &RecordedControls) -> Option<(String, &'static str)> {
    let time_s = &samples.time_s;
    let n_samples = time_s.len();
    let (Some(last_s), MIN_SAMPLES..) = (time_s.last(), n_samples) else {
        return Some((
            "fewer than three samples of the speed before the crash".to_owned(),
            "a record with columns such as Time [s], Speed [km/h] and Steering Wheel Angle [deg], and a start \
             (--from) before its last samples",
        ));
    };
    if samples.steering_wheel_rad.len() != n_samples {
        return Some((
            "no angle of the steering wheel at every sample".to_owned(),
            "a column such as Steering Wheel Angle [deg] with a number in every row; for a car that went \
             straight, one of zeros",
        ));
    }
    if n_samples > MAX_SAMPLES {
        return Some((
            format!("{n_samples} samples"),
            "at most 5000; begin later (--from) or take every tenth sample",
        ));
    }
    if let Some(speed_m_s) = samples.speed_m_s.iter().find(|speed| **speed < -SPEED_ROUNDING_M_S) {
        return Some((
            format!("a speed of {speed_m_s:.1} m/s, backwards"),
            "a car that goes ahead; one that goes backwards is not followed",
        ));
    }
    let steps = time_s.windows(2).filter_map(|pair| match pair {
        [from_s, to_s] => Some((*from_s, to_s - from_s)),
        _ => None,
    });
    for (from_s, step_s) in steps {
        if step_s < SHORTEST_STEP_S {
            return Some((
                "two samples within a millisecond".to_owned(),
                "samples at least 1 ms apart; recorders have 2 to 10 in a second",
            ));
        }
        if step_s > LONGEST_STEP_S {
            return Some((
                format!("no sample for {step_s:.1} s after {from_s} s"),
                "samples at most 1 s apart; begin later (--from) to leave out what is before a gap",
            ));
        }
    }
    (*last_s < LATEST_SAMPLE_S).then(|| {
        (
            format!("nothing after {last_s} s"),
            "a last sample within 5 s before the crash, which is time 0",
        )
    })
}
