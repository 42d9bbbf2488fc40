//! What is not known of a recorded drive, and the drive that follows from a draw of it.
//!
//! ```text
//! v_i = (v̂_i + ε_i) (1 + σ_v z)        δ_i = (δ̂_w,i + η_i + δ_0)/(i_s + σ_i z)
//! ```
//!
//! ε and η are the rounding of the record, ± 1/2 mph and ± 2.5° of the steering wheel. Between two samples a
//! value departs from the line by up to h² x''/8; that is one standard deviation of its middle, with x'' of
//! the neighbouring samples. The first contact is anywhere within one step after the last sample, or as much
//! later as the clock of the recorder says. Up to it the acceleration is between that of the last step and
//! none, or, of a car that brakes, between half of it and 0.9 μ g; the steering goes on by up to the rate of
//! the last step.

use rand::RngExt as _;

use crate::questions::replay::record::Record;
use impactlab_core::numerics::{latin_normals, latin_uniforms, normal_quantile, random_stream};
use impactlab_core::ranges::STEER_ANGLE;
use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::RecordedDrive;

/// Largest rounding of a recorded speed, m/s: half of 1 mph.
pub(super) const SPEED_ROUNDING_M_S: f64 = 0.223_52;

/// Largest rounding of a recorded angle of the steering wheel, rad: half of 5°.
const WHEEL_ROUNDING_RAD: f64 = 2.5 * std::f64::consts::PI / 180.0;

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

    /// The drive of this draw.
    ///
    /// - `friction`: of the road in this draw.
    pub fn drive(&self, record: &Record, known: &Known, friction: f64) -> RecordedDrive {
        let gain = (1.0 + known.speed_sigma * self.scale).max(0.1);
        let ratio = known.steering_ratio + known.steering_ratio_sigma * self.ratio;
        let ratio = ratio.max(known.steering_ratio / 4.0);
        let controls = &record.samples;
        let speeds: Vec<f64> = controls
            .speed_m_s
            .iter()
            .zip(&self.samples)
            .map(|(recorded, z)| gain * same_sign(recorded + SPEED_ROUNDING_M_S * z[0], *recorded))
            .collect();
        let zero_rad = WHEEL_ZERO_SIGMA_RAD * self.zero;
        let steers: Vec<f64> = controls
            .steering_wheel_rad
            .iter()
            .zip(&self.samples)
            .map(|(recorded, z)| (recorded + WHEEL_ROUNDING_RAD * z[1] + zero_rad) / ratio)
            .collect();
        let gap_s = self.gap_s(record);
        let [_, last_s] = record.ends_s();
        let mut drive = RecordedDrive { time_s: vec![], speed_m_s: vec![], steer_rad: vec![] };
        let mut push = |time_s: f64, speed_m_s: f64, steer_rad: f64| {
            drive.time_s.push(time_s);
            drive.speed_m_s.push(speed_m_s);
            drive.steer_rad.push(steer_rad.clamp(STEER_ANGLE.low, STEER_ANGLE.high));
        };
        let departures = [&speeds, &steers].map(|values| departures(values));
        let shifted = |time_s: &f64| time_s - last_s - gap_s;
        for (idx, time_s) in controls.time_s.iter().enumerate() {
            push(shifted(time_s), speeds[idx], steers[idx]);
            let Some(next_s) = controls.time_s.get(idx + 1) else { break };
            let [.., z_speed, z_wheel] = self.samples[idx];
            let middle = |values: &[f64]| (values[idx] + values[idx + 1]) / 2.0;
            let speed_m_s = middle(&speeds) + departures[0][idx] * z_speed;
            let steer_rad = middle(&steers) + departures[1][idx] * z_wheel;
            let middle_s = (shifted(time_s) + shifted(next_s)) / 2.0;
            push(middle_s, same_sign(speed_m_s, middle(&speeds)), steer_rad);
        }
        let [speed_m_s, steer_rad] = [&speeds, &steers].map(|of| of.last().copied().unwrap_or(0.0));
        let end_m_s = speed_m_s + self.last_acceleration_m_s2(record, friction) * gap_s;
        let rate_rad_s = record.last_slope(&steers) * self.steering;
        push(0.0, same_sign(end_m_s, speed_m_s), steer_rad + rate_rad_s * gap_s);
        drive
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

/// A speed that does not go beyond standstill.
fn same_sign(value: f64, of: f64) -> f64 {
    if of >= 0.0 { value.max(0.0) } else { value.min(0.0) }
}

/// By how much the middle of each step may depart from the line between its samples: an eighth of the second
/// differences of the values. All steps are taken to be alike.
fn departures(values: &[f64]) -> Vec<f64> {
    let second = |idx: usize| match values.get(idx.wrapping_sub(1)..idx.saturating_add(2)) {
        Some([before, at, after]) => (before - 2.0 * at + after).abs(),
        _ => 0.0,
    };
    (0..values.len()).map(|idx| second(idx).max(second(idx + 1)) / 8.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_no_departures_and_a_corner_those_of_its_neighbours() {
        assert_eq!(departures(&[1.0, 2.0, 3.0, 4.0]), [0.0; 4]);
        assert_eq!(departures(&[0.0, 0.0, 0.0, 8.0, 8.0]), [0.0, 1.0, 1.0, 1.0, 0.0]);
        assert_eq!(departures(&[]), [0.0; 0]);
    }
}
