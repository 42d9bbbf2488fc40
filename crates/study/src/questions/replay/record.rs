//! The seconds before a crash as a recorder has kept them.

use std::path::Path;

use crate::{ReplayRequest, StudyError};
use impactlab_core::data::{RecordedControls, RecorderRecord};
use impactlab_core::ranges::STEER_ANGLE;

/// Start of a replay where nobody says it, s on the clock of the recorder.
const EARLIEST_S: f64 = -30.0;

/// Earliest last sample of which a contact is told, s.
const LATEST_SAMPLE_S: f64 = -5.0;

/// Shortest time between two samples, s.
const SHORTEST_STEP_S: f64 = 1e-3;

/// Most samples of a record.
const MAX_SAMPLES: usize = 5000;

/// A record of which every sample can be followed.
#[derive(Debug, Clone)]
pub(super) struct Record {
    /// What the recorder has kept of the event.
    pub record: RecorderRecord,
    /// The samples that are followed, with the angle of the steering wheel positive to the left.
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
        let from_s = self.from_s.unwrap_or(EARLIEST_S);
        let all = &record.before;
        let n_earlier = all.time_s.partition_point(|time_s| *time_s < from_s - 1e-9);
        let mut samples = without_first(all, n_earlier);
        check(path, &record, &samples)?;
        if self.steering_right {
            samples
                .steering_wheel_rad
                .iter_mut()
                .for_each(|angle_rad| *angle_rad = 0.0 - *angle_rad);
        }
        let ratio = self.ratio();
        for angle_rad in &samples.steering_wheel_rad {
            STEER_ANGLE.check(angle_rad / ratio).map_err(|source| StudyError::RoadWheel {
                path: path.clone(),
                ratio,
                source,
            })?;
        }
        let to_left = |rate: &f64| 0.0 - rate;
        let yaw_rate_rad_s = samples.yaw_rate_right_rad_s.iter().map(to_left).collect();
        Ok(Record { record, samples, yaw_rate_rad_s, n_earlier })
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

fn without_first(all: &RecordedControls, n: usize) -> RecordedControls {
    fn rest<T: Clone>(values: &[T], n: usize) -> Vec<T> {
        values.get(n..).map(<[T]>::to_vec).unwrap_or_default()
    }
    RecordedControls {
        time_s: rest(&all.time_s, n),
        speed_m_s: rest(&all.speed_m_s, n),
        steering_wheel_rad: rest(&all.steering_wheel_rad, n),
        yaw_rate_right_rad_s: rest(&all.yaw_rate_right_rad_s, n),
        is_braked: rest(&all.is_braked, n),
        is_anti_lock_active: rest(&all.is_anti_lock_active, n),
    }
}

/// Refuses a record that cannot be followed, and says what is missing.
fn check(
    path: &Path,
    record: &RecorderRecord,
    samples: &RecordedControls,
) -> Result<(), StudyError> {
    let refuse = |got: String, expected| {
        let got = match record.doubts.is_empty() {
            true => got,
            false => format!("{got} ({})", record.doubts.join("; ")),
        };
        Err(StudyError::WrongKind { path: path.to_owned(), got, expected })
    };
    let time_s = &samples.time_s;
    if time_s.len() < 2 {
        return refuse(
            "fewer than two samples of the speed before the crash".to_owned(),
            "a record with columns such as Time [s], Speed [km/h] and Steering Wheel Angle [deg], and a start \
             (--from) before its last samples",
        );
    }
    if samples.steering_wheel_rad.len() != time_s.len() {
        return refuse(
            "no angle of the steering wheel at every sample".to_owned(),
            "a column such as Steering Wheel Angle [deg] with a number in every row; for a car that went \
             straight, one of zeros",
        );
    }
    if time_s.len() > MAX_SAMPLES {
        return refuse(
            format!("{} samples", time_s.len()),
            "at most 5000; begin later (--from) or take every tenth sample",
        );
    }
    if time_s.windows(2).any(|pair| pair[1] - pair[0] < SHORTEST_STEP_S) {
        return refuse(
            "two samples within a millisecond".to_owned(),
            "samples at least 1 ms apart; recorders have 2 to 10 in a second",
        );
    }
    match time_s.last() {
        Some(last_s) if *last_s < LATEST_SAMPLE_S => refuse(
            format!("nothing after {last_s} s"),
            "a last sample within 5 s before the crash, which is time 0",
        ),
        _ => Ok(()),
    }
}
