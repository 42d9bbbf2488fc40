//! Coordinates of a log with the noise that they share.

use argmin::core::{CostFunction, Error, Executor};
use argmin::solver::neldermead::NelderMead;

use impactlab_core::numerics::{MeasuredTrack, SIGMA_PER_MAD, TrackPoint, TrackSample, median};

/// Spectral density of p⃛ to start with, away from contact and during it, (m/s³)²·s or (rad/s³)²·s:
/// tires change the acceleration by some 5 m/s² within 0.2 s, an impact by 30 m/s² within 0.05 s.
const START_DENSITY: [f64; 2] = [1e2, 2e4];
/// Expected deviation of noise and density from the start, as a logarithm.
const PRIOR_STD: [f64; 2] = [0.5, 1.5];
/// Noise that no sensor is below, m or rad, and m/s or rad/s.
const LEAST_STD: f64 = 1e-4;
/// Third differences of white noise have twenty times its variance.
const THIRD_DIFFERENCE: f64 = 20.0;
const MAX_ITERATIONS: u64 = 150;

/// Noise and liveliness of coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TrackScales {
    /// Standard deviation of the samples of the coordinates and of their velocities.
    pub sample_std: [f64; 2],
    /// Spectral density away from contact and during it.
    pub density: [f64; 2],
}

/// Coordinates that share noise and liveliness.
#[derive(Debug, Clone)]
pub(super) struct Tracks {
    /// Samples of each; their `std` is not looked at.
    pub samples: Vec<Vec<TrackSample>>,
    /// Standard deviations of a coordinate, its velocity and its acceleration, before any sample.
    pub prior_std: [f64; 3],
}

/// Start and end of the contact, s.
pub(super) type LogWindow = Option<[f64; 2]>;

impl Tracks {
    /// One coordinate of values and, where they are there, velocities at the same instants.
    pub(super) fn samples_of(
        time_s: &[f64],
        values: &[f64],
        velocities: Option<&[f64]>,
    ) -> Vec<TrackSample> {
        let samples = |(i, time_s): (usize, &f64)| {
            let sample = |order, value: Option<&f64>| {
                value.map(|&value| TrackSample { time_s: *time_s, order, value, std: 1.0 })
            };
            let velocity = velocities.and_then(|velocities| velocities.get(i));
            [sample(0, values.get(i)), sample(1, velocity)]
        };
        time_s.iter().enumerate().flat_map(samples).flatten().collect()
    }

    /// Without what was sampled before an instant.
    pub(super) fn from(mut self, from_s: f64) -> Self {
        self.samples.iter_mut().for_each(|samples| samples.retain(|s| s.time_s >= from_s));
        self
    }

    /// TrackScales to start with: noise from third differences, which a smooth motion hardly has.
    pub(super) fn start(&self) -> TrackScales {
        let std = |order: usize| {
            let mut sizes: Vec<f64> = Vec::new();
            for samples in &self.samples {
                let of_order = samples.iter().filter(|sample| sample.order == order);
                let values: Vec<f64> = of_order.map(|sample| sample.value).collect();
                let third = |v: &[f64]| (v[3] - 3.0 * v[2] + 3.0 * v[1] - v[0]).abs();
                sizes.extend(values.windows(4).map(third));
            }
            let std = SIGMA_PER_MAD * median(sizes).unwrap_or(0.0) / THIRD_DIFFERENCE.sqrt();
            std.max(LEAST_STD)
        };
        TrackScales { sample_std: [std(0), std(1)], density: START_DENSITY }
    }

    /// TrackScales with which the samples are most likely, held near those to start with.
    pub(super) fn fit(&self, window: LogWindow) -> TrackScales {
        let problem = TrackProblem { tracks: self, start: self.start(), window };
        let start = problem.start;
        let mut simplex = vec![vec![0.0; 4]; 5];
        for (i, corner) in simplex.iter_mut().skip(1).enumerate() {
            corner[i] = 0.5;
        }
        let found = Executor::new(problem, NelderMead::new(simplex))
            .configure(|state| state.max_iters(MAX_ITERATIONS))
            .run();
        // Only a log that is not finite has no best point; smoothing it says so.
        let logs = found.ok().and_then(|found| found.state.best_param);
        logs.map_or(start, |logs| start.times_exp(&logs))
    }

    /// Logarithm of the density of the samples between two instants.
    pub(super) fn log_likelihood(
        &self,
        scales: &TrackScales,
        window: LogWindow,
        within: [f64; 2],
    ) -> f64 {
        let log_likelihood = |samples: &Vec<TrackSample>| {
            let from = samples.partition_point(|sample| sample.time_s < within[0]);
            let to = samples.partition_point(|sample| sample.time_s <= within[1]);
            let samples = scaled(samples.get(from..to).unwrap_or_default(), scales);
            let density = |a, b| scales.density_between(window, [a, b]);
            let prior_std = self.prior_std;
            MeasuredTrack { samples: &samples, density: &density, prior_std }.log_likelihood()
        };
        self.samples.iter().map(log_likelihood).sum()
    }

    /// Each coordinate at some instants, rising; `None` where a number is not finite.
    pub(super) fn smooth(
        &self,
        scales: &TrackScales,
        window: LogWindow,
        at_s: &[f64],
    ) -> Option<Vec<Vec<TrackPoint>>> {
        let smoothed = |samples: &Vec<TrackSample>| {
            let samples = scaled(samples, scales);
            let density = |a, b| scales.density_between(window, [a, b]);
            MeasuredTrack { samples: &samples, density: &density, prior_std: self.prior_std }
                .smooth(at_s)
        };
        self.samples.iter().map(smoothed).collect()
    }
}

impl TrackScales {
    fn times_exp(&self, logs: &[f64]) -> Self {
        let factor = |i: usize| logs.get(i).copied().unwrap_or(0.0).clamp(-8.0, 8.0).exp();
        Self {
            sample_std: [self.sample_std[0] * factor(0), self.sample_std[1] * factor(1)],
            density: [self.density[0] * factor(2), self.density[1] * factor(3)],
        }
    }

    /// Mean over an interval that may lie in the window in part.
    fn density_between(&self, window: LogWindow, [from_s, to_s]: [f64; 2]) -> f64 {
        let [quiet, lively] = self.density;
        let Some([start_s, end_s]) = window else { return quiet };
        let overlap = (to_s.min(end_s) - from_s.max(start_s)).max(0.0);
        let share = if to_s > from_s { overlap / (to_s - from_s) } else { 0.0 };
        quiet + (lively - quiet) * share
    }
}

fn scaled(samples: &[TrackSample], scales: &TrackScales) -> Vec<TrackSample> {
    let with_scale = |sample: &TrackSample| TrackSample {
        std: scales.sample_std[sample.order.min(1)],
        ..*sample
    };
    samples.iter().map(with_scale).collect()
}

struct TrackProblem<'a> {
    tracks: &'a Tracks,
    start: TrackScales,
    window: LogWindow,
}

impl CostFunction for TrackProblem<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, logs: &Vec<f64>) -> Result<f64, Error> {
        let scales = self.start.times_exp(logs);
        let whole = [f64::NEG_INFINITY, f64::INFINITY];
        let fit = self.tracks.log_likelihood(&scales, self.window, whole);
        let prior = logs.iter().enumerate().map(|(i, log)| (log / PRIOR_STD[i / 2]).powi(2));
        let cost = 0.5 * prior.sum::<f64>() - fit;
        Ok(if cost.is_finite() { cost } else { f64::MAX })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Third differences of 1 and 3 cm: the noise to start with was by the larger one.
    #[test]
    fn the_noise_of_few_samples_is_by_the_median_of_their_differences() {
        let times_s = [0.0, 0.1, 0.2, 0.3, 0.4];
        let samples = Tracks::samples_of(&times_s, &[0.0, 0.0, 0.0, 0.01, 0.0], None);
        let tracks = Tracks { samples: vec![samples], prior_std: [1.0; 3] };
        let [std, of_velocities] = tracks.start().sample_std;
        assert!((std - 1.4826 * 0.02 / 20.0_f64.sqrt()).abs() < 1e-9, "{std}");
        assert_eq!(of_velocities, LEAST_STD);
    }
}
