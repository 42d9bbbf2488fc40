//! What is not known of a recorded drive, and the drive that follows from a draw of it.
//!
//! ```text
//! v_i = (v̂_i + ε_i) (1 + σ_v z)        δ_i = (δ̂_w,i + η_i + δ_0)/(i_s + σ_i z)
//! ```
//!
//! ε and η are the rounding of the record, ± 1/2 mph and ± 2.5° of the steering wheel, independent at samples
//! half a second apart and linear between these, so that more samples neither average it out nor make an
//! acceleration of it. Between two samples a value departs from the line by up to h² x''/8; that is one
//! standard deviation of its middle, with x'' of the neighbouring samples. The first contact is anywhere within
//! one step after the last sample, or as much later as the clock of the recorder says. Up to it the
//! acceleration is between that of the last step and none, or, of a car that brakes, between half of it and
//! 0.9 μ g; the steering goes on by up to the rate of the last step.

use rand::RngExt as _;

use crate::questions::replay::record::Record;
use impactlab_core::numerics::{
    interpolate, latin_normals, latin_uniforms, normal_quantile, random_stream,
};
use impactlab_core::ranges::STEER_ANGLE;
use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::RecordedDrive;

/// Largest rounding of a recorded speed, m/s: half of 1 mph.
pub(super) const SPEED_ROUNDING_M_S: f64 = 0.223_52;

/// Largest rounding of a recorded angle of the steering wheel, rad: half of 5°.
const WHEEL_ROUNDING_RAD: f64 = 2.5 * std::f64::consts::PI / 180.0;

/// Time after which a rounding is independent of the one before, s.
const ROUNDING_TIME_S: f64 = 0.45;

/// Standard deviation of the zero of the steering wheel, rad: 2°.
const WHEEL_ZERO_SIGMA_RAD: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// Full braking of a driver over μ g.
pub(super) const FULL_BRAKING: f64 = 0.9;

/// Shortest time from the last sample to the first contact, s.
const SHORTEST_GAP_S: f64 = 1e-3;

/// Largest acceleration to which the last step may go on, m/s².
const LARGEST_ACCELERATION_M_S2: f64 = 6.0;

/// How well the numbers beside the record are known.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known {
    pub steering_ratio: f64,
    pub steering_ratio_sigma: f64,
    /// As a share of the speed.
    pub speed_sigma: f64,
}

/// A draw of what is not known of the record.
#[derive(Debug, Clone)]
pub(super) struct Unknowns {
    /// Standard normal: scale of the speed, steering ratio, zero of the steering wheel.
    scale: f64,
    ratio: f64,
    zero: f64,
    /// Standard normal: error of the recorded yaw rate over the whole record.
    pub yaw_rate_error: f64,
    /// From 0 to 1: time from the last sample to the contact, acceleration and steering over it.
    gap: f64,
    acceleration: f64,
    steering: f64,
    /// Of each sample: rounding of speed and steering wheel, from −1 to 1, and the standard normal departure of
    /// both in the middle of the step that follows.
    samples: Vec<[f64; 4]>,
}

impl Unknowns {
    /// Everything as recorded, with the middle of what is open at the end.
    pub fn central(n_samples: usize) -> Self {
        Self {
            scale: 0.0,
            ratio: 0.0,
            zero: 0.0,
            yaw_rate_error: 0.0,
            gap: 0.5,
            acceleration: 0.5,
            steering: 0.5,
            samples: vec![[0.0; 4]; n_samples],
        }
    }

    /// Independent draws; what concerns the whole record fills its space evenly.
    pub fn drawn(n_draws: usize, n_samples: usize, seed: u64) -> Vec<Self> {
        let stream = |number| random_stream(seed, "replay of a recorder", number);
        let normals = |number| latin_normals(n_draws, &mut stream(number));
        let uniforms = |number| latin_uniforms(n_draws, &mut stream(number));
        let (scale, ratio, zero) = (normals(0), normals(1), normals(2));
        let (gap, acceleration, steering) = (uniforms(3), uniforms(4), uniforms(5));
        let yaw_rate_error = normals(6);
        let draw = |idx: usize| {
            let mut rng = random_stream(seed, "samples of a recorder", idx as u64);
            let mut uniform = || rng.random::<f64>();
            let mut sample = || {
                let rounding = [uniform(), uniform()].map(|u| 2.0 * u - 1.0);
                let [speed, wheel] = [uniform(), uniform()]
                    .map(|u| normal_quantile(u.clamp(f64::EPSILON, 1.0 - f64::EPSILON)));
                [rounding[0], rounding[1], speed, wheel]
            };
            Self {
                scale: scale[idx],
                ratio: ratio[idx],
                zero: zero[idx],
                yaw_rate_error: yaw_rate_error[idx],
                gap: gap[idx],
                acceleration: acceleration[idx],
                steering: steering[idx],
                samples: (0..n_samples).map(|_| sample()).collect(),
            }
        };
        (0..n_draws).map(draw).collect()
    }

    /// Time from the last sample to the first contact, s.
    pub fn gap_s(&self, record: &Record) -> f64 {
        (record.longest_gap_s() * self.gap).max(SHORTEST_GAP_S)
    }

    /// Angle of the steering wheel over that of the road wheels.
    pub fn steering_ratio(&self, known: &Known) -> f64 {
        let ratio = known.steering_ratio + known.steering_ratio_sigma * self.ratio;
        ratio.max(known.steering_ratio / 4.0)
    }

    /// The drive of this draw.
    ///
    /// - `friction`: of the road in this draw.
    pub fn drive(&self, record: &Record, known: &Known, friction: f64) -> RecordedDrive {
        let gain = (1.0 + known.speed_sigma * self.scale).max(0.1);
        let ratio = self.steering_ratio(known);
        let controls = &record.samples;
        let [of_speed, of_wheel] = self.roundings(&controls.time_s);
        let speeds: Vec<f64> = controls
            .speed_m_s
            .iter()
            .zip(&of_speed)
            .map(|(recorded, z)| gain * (recorded + SPEED_ROUNDING_M_S * z).max(0.0))
            .collect();
        let zero_rad = WHEEL_ZERO_SIGMA_RAD * self.zero;
        let steers: Vec<f64> = controls
            .steering_wheel_rad
            .iter()
            .zip(&of_wheel)
            .map(|(recorded, z)| (recorded + WHEEL_ROUNDING_RAD * z + zero_rad) / ratio)
            .collect();
        let gap_s = self.gap_s(record);
        let [_, last_s] = record.ends_s();
        let mut drive = RecordedDrive { time_s: vec![], speed_m_s: vec![], steer_rad: vec![] };
        let mut push = |time_s: f64, speed_m_s: f64, steer_rad: f64| {
            drive.time_s.push(time_s);
            drive.speed_m_s.push(speed_m_s);
            drive.steer_rad.push(steer_rad.clamp(STEER_ANGLE.low, STEER_ANGLE.high));
        };
        let departures = [&speeds, &steers].map(|values| departures(&controls.time_s, values));
        let shifted = |time_s: &f64| time_s - last_s - gap_s;
        for (idx, time_s) in controls.time_s.iter().enumerate() {
            push(shifted(time_s), speeds[idx], steers[idx]);
            let Some(next_s) = controls.time_s.get(idx + 1) else { break };
            let [.., z_speed, z_wheel] = self.samples[idx];
            let middle = |values: &[f64]| (values[idx] + values[idx + 1]) / 2.0;
            let speed_m_s = middle(&speeds) + departures[0][idx] * z_speed;
            let steer_rad = middle(&steers) + departures[1][idx] * z_wheel;
            let middle_s = (shifted(time_s) + shifted(next_s)) / 2.0;
            push(middle_s, speed_m_s.max(0.0), steer_rad);
        }
        let [speed_m_s, steer_rad] = [&speeds, &steers].map(|of| of.last().copied().unwrap_or(0.0));
        let end_m_s = speed_m_s + self.last_acceleration_m_s2(record, friction) * gap_s;
        let rate_rad_s = record.last_slope(&steers) * self.steering;
        push(0.0, end_m_s.max(0.0), steer_rad + rate_rad_s * gap_s);
        drive
    }

    /// Rounding of speed and steering wheel at each sample, from −1 to 1.
    fn roundings(&self, time_s: &[f64]) -> [Vec<f64>; 2] {
        let mut knots_s: Vec<f64> = Vec::new();
        let mut knots = [Vec::new(), Vec::new()];
        for (at_s, [speed, wheel, ..]) in time_s.iter().zip(&self.samples) {
            if knots_s.last().is_none_or(|last_s| at_s - last_s >= ROUNDING_TIME_S) {
                knots_s.push(*at_s);
                knots[0].push(*speed);
                knots[1].push(*wheel);
            }
        }
        knots.map(|knots| {
            let at = |at_s: &f64| interpolate(&knots_s, &knots, *at_s).unwrap_or(0.0);
            time_s.iter().map(at).collect()
        })
    }

    /// Acceleration after the last sample, m/s².
    fn last_acceleration_m_s2(&self, record: &Record, friction: f64) -> f64 {
        let largest = LARGEST_ACCELERATION_M_S2;
        let recorded = record.last_acceleration_m_s2().clamp(-2.0 * largest, largest);
        let [low, high] = match record.ends_braked() {
            true => {
                let full = -FULL_BRAKING * friction * STANDARD_GRAVITY_M_S2;
                [recorded.min(full), recorded.min(0.0) / 2.0]
            }
            false => [recorded.min(0.0), recorded.max(0.0)],
        };
        low + (high - low) * self.acceleration
    }
}

/// By how much the middle of each step may depart from the line between its samples, h² |x''|/8 with the larger
/// x'' of both.
fn departures(time_s: &[f64], values: &[f64]) -> Vec<f64> {
    let slope = |idx: usize| {
        let (step_s, step) = (time_s[idx + 1] - time_s[idx], values[idx + 1] - values[idx]);
        step / step_s
    };
    let last = values.len().saturating_sub(1);
    let second = |idx: usize| match (1..last).contains(&idx) {
        true => (slope(idx) - slope(idx - 1)) / (0.5 * (time_s[idx + 1] - time_s[idx - 1])),
        false => 0.0,
    };
    let departure = |idx: usize| {
        let step_s = time_s[idx + 1] - time_s[idx];
        step_s * step_s * second(idx).abs().max(second(idx + 1).abs()) / 8.0
    };
    (0..last).map(departure).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_no_departures_and_a_corner_those_of_its_neighbours() {
        let time_s = [0.0, 0.5, 1.0, 1.5, 2.0];
        assert_eq!(departures(&time_s[..4], &[1.0, 2.0, 3.0, 4.0]), [0.0; 3]);
        assert_eq!(departures(&time_s, &[0.0, 0.0, 0.0, 8.0, 8.0]), [0.0, 1.0, 1.0, 1.0]);
        assert_eq!(departures(&[], &[]), [0.0; 0]);
    }

    #[test]
    fn roundings_are_of_each_sample_at_two_a_second_and_change_slowly_at_a_hundred() {
        let one = |rate_hz: f64| {
            let time_s: Vec<f64> = (0..=200).map(|idx| f64::from(idx) / rate_hz).collect();
            let drawn = Unknowns::drawn(1, time_s.len(), 3);
            let unknowns = drawn.first().unwrap();
            let of_samples: Vec<f64> = unknowns.samples.iter().map(|sample| sample[0]).collect();
            let [speed, _] = unknowns.roundings(&time_s);
            let steps = speed.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            (speed == of_samples, steps.fold(0.0, f64::max))
        };
        let [(is_each, _), (is_each_of_many, step)] = [one(2.0), one(100.0)];
        assert!(is_each && !is_each_of_many);
        assert!(step > 0.0 && step <= 2.0 / 45.0, "{step}");
    }

    /// x = t², whose middle of a step departs by h²/4, with a sample that is missing.
    #[test]
    fn a_longer_step_departs_by_its_square() {
        let time_s = [0.0, 1.0, 3.0, 4.0];
        assert_eq!(departures(&time_s, &time_s.map(|t| t * t)), [0.25, 1.0, 0.25]);
    }
}
