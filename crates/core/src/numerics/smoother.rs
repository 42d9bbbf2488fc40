//! Estimates a coordinate, its velocity and its acceleration from noisy samples, by a Kalman filter
//! forwards in time and the Rauch–Tung–Striebel smoother backwards.
//!
//! ```text
//! x = [p, ṗ, p̈]      p⃛ = white noise of spectral density q      sample = x[order] + N(0, std²)
//! ```
//!
//! Source: [`RauchTungStriebel1965`](crate::bibliography::RauchTungStriebel1965) for the smoother,
//! [`BarShalom2001`](crate::bibliography::BarShalom2001) for the process noise of a nearly constant
//! acceleration. The samples may be taken at any instants; their noise is assumed to be white.

use nalgebra::{Matrix3, RowVector3, Vector3};

/// A measurement of a coordinate or of one of its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackSample {
    /// Time of the measurement, s.
    pub time_s: f64,
    /// Order of the derivative that was measured: 0 for the coordinate, 1 for the velocity, 2 for
    /// the acceleration. A larger order counts as 2.
    pub order: usize,
    /// The measured value.
    pub value: f64,
    /// Standard deviation of the noise, positive, in the unit of the value.
    pub std: f64,
}

/// Estimated coordinate, velocity and acceleration at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackPoint {
    /// Means of p, ṗ and p̈.
    pub mean: [f64; 3],
    /// Standard deviations of p, ṗ and p̈.
    pub std: [f64; 3],
}

/// Samples of one coordinate with the assumed noise of its third derivative.
pub struct MeasuredTrack<'a> {
    /// The samples in order of time; several samples may have the same time.
    pub samples: &'a [TrackSample],
    /// Spectral density q of p⃛ between two instants in s, (unit/s³)²·s, positive.
    pub density: &'a dyn Fn(f64, f64) -> f64,
    /// Standard deviations of p, ṗ and p̈ at the first instant before any sample is used. Their
    /// means are the first sample of order 0, or zero if there is none, and two zeros.
    pub prior_std: [f64; 3],
}

/// State of the filter at an instant, before and after the samples of that instant were used.
struct Node {
    time_s: f64,
    /// Transition matrix from the previous node to this one.
    transition: Matrix3<f64>,
    /// Mean and covariance before the samples of this instant.
    predicted: (Vector3<f64>, Matrix3<f64>),
    /// Mean and covariance after the samples of this instant.
    filtered: (Vector3<f64>, Matrix3<f64>),
}

impl MeasuredTrack<'_> {
    /// Logarithm of the probability density of all samples, by which the noise can be fitted.
    pub fn log_likelihood(&self) -> f64 {
        self.filter(&[]).1
    }

    /// Estimates the state at given instants from all samples, those before and those after the
    /// instant.
    ///
    /// - `at_s`: instants, s, increasing.
    /// - returns one point per instant, or `None` if there are no instants at all or a result is
    ///   not finite.
    pub fn smooth(&self, at_s: &[f64]) -> Option<Vec<TrackPoint>> {
        let (nodes, likelihood) = self.filter(at_s);
        if !likelihood.is_finite() {
            return None;
        }
        let (mut mean, mut covariance) = nodes.last()?.filtered;
        let mut points = Vec::with_capacity(at_s.len());
        let mut wanted = at_s.iter().rev().peekable();
        for (i, node) in nodes.iter().enumerate().rev() {
            if let Some(next) = nodes.get(i + 1) {
                // C = P Fᵀ P⁻¹(predicted)      m += C (m_next − m_predicted)
                let (filtered_mean, filtered) = node.filtered;
                let (predicted_mean, predicted) = next.predicted;
                let gain = filtered * next.transition.transpose() * predicted.try_inverse()?;
                mean = filtered_mean + gain * (mean - predicted_mean);
                covariance = filtered + gain * (covariance - predicted) * gain.transpose();
            }
            while wanted.next_if(|at_s| **at_s >= node.time_s).is_some() {
                let std = covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
                points.push(TrackPoint { mean: mean.into(), std: std.into() });
            }
        }
        points.reverse();
        let is_finite = |point: &TrackPoint| point.mean.iter().all(|value| value.is_finite());
        (points.len() == at_s.len() && points.iter().all(is_finite)).then_some(points)
    }

    /// Runs the filter forwards over the instants of the samples and those in `at_s`.
    ///
    /// - returns the nodes in order of time, and the logarithm of the probability density of the
    ///   samples.
    fn filter(&self, at_s: &[f64]) -> (Vec<Node>, f64) {
        let mut samples = self.samples.iter().peekable();
        let mut wanted = at_s.iter().copied().peekable();
        let first = self.samples.iter().find(|sample| sample.order == 0);
        let mut state = (
            Vector3::new(first.map_or(0.0, |sample| sample.value), 0.0, 0.0),
            Matrix3::from_diagonal(&Vector3::from(self.prior_std.map(|std| std * std))),
        );
        let (mut nodes, mut log_likelihood): (Vec<Node>, f64) = (Vec::new(), 0.0);
        loop {
            let next = [samples.peek().map(|sample| sample.time_s), wanted.peek().copied()];
            let Some(time_s) = next.into_iter().flatten().reduce(f64::min) else { break };
            let mut transition = Matrix3::identity();
            if let Some(before) = nodes.last() {
                let step_s = time_s - before.time_s;
                let density = (self.density)(before.time_s, time_s);
                transition = transition_over(step_s);
                state.0 = transition * state.0;
                state.1 = transition * state.1 * transition.transpose()
                    + process_noise_over(step_s) * density;
            }
            let predicted = state;
            while let Some(sample) = samples.next_if(|sample| sample.time_s <= time_s) {
                log_likelihood += update(&mut state.0, &mut state.1, sample);
            }
            while wanted.next_if(|at_s| *at_s <= time_s).is_some() {}
            nodes.push(Node { time_s, transition, predicted, filtered: state });
        }
        (nodes, log_likelihood)
    }
}

/// Transition matrix F of `[p, ṗ, p̈]` over a step with constant acceleration.
fn transition_over(step_s: f64) -> Matrix3<f64> {
    Matrix3::new(1.0, step_s, step_s * step_s / 2.0, 0.0, 1.0, step_s, 0.0, 0.0, 1.0)
}

/// Covariance that white noise of p⃛ with a spectral density of 1 adds over a step.
fn process_noise_over(step_s: f64) -> Matrix3<f64> {
    let power = |n: i32| step_s.powi(n);
    Matrix3::new(
        power(5) / 20.0,
        power(4) / 8.0,
        power(3) / 6.0,
        power(4) / 8.0,
        power(3) / 3.0,
        power(2) / 2.0,
        power(3) / 6.0,
        power(2) / 2.0,
        step_s,
    )
}

/// Updates mean and covariance by a sample, and returns the logarithm of the probability density of
/// the sample before the update.
fn update(mean: &mut Vector3<f64>, covariance: &mut Matrix3<f64>, sample: &TrackSample) -> f64 {
    let mut row = RowVector3::zeros();
    row[sample.order.min(2)] = 1.0;
    let variance = sample.std * sample.std;
    let spread = (row * *covariance * row.transpose())[0] + variance;
    let surprise = sample.value - (row * *mean)[0];
    let gain = *covariance * row.transpose() / spread;
    *mean += gain * surprise;
    // The form of Joseph keeps the covariance positive definite in spite of rounding.
    let remaining = Matrix3::identity() - gain * row;
    *covariance =
        remaining * *covariance * remaining.transpose() + gain * gain.transpose() * variance;
    -0.5 * (surprise * surprise / spread + (std::f64::consts::TAU * spread).ln())
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::*;

    fn track<'a>(
        samples: &'a [TrackSample],
        density: &'a dyn Fn(f64, f64) -> f64,
    ) -> MeasuredTrack<'a> {
        MeasuredTrack { samples, density, prior_std: [1e3, 1e2, 1e2] }
    }

    #[test]
    fn a_parabola_without_process_noise_is_the_fit_by_least_squares() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let samples: Vec<TrackSample> = (0..60)
            .map(|i| {
                let t = 0.03 * f64::from(i);
                let noise: f64 = rng.sample(StandardNormal);
                let value = 2.0 - 3.0 * t + 1.5 * t * t + 0.1 * noise;
                TrackSample { time_s: t, order: 0, value, std: 0.1 }
            })
            .collect();
        let density = |_, _| 1e-12;
        let points = track(&samples, &density).smooth(&[0.0, 0.9]).unwrap();
        // Normal equations of the same fit about t = 0.
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for sample in &samples {
            let t = sample.time_s;
            let row = Vector3::new(1.0, t, t * t / 2.0);
            normal += row * row.transpose();
            right += row * sample.value;
        }
        let inverse = normal.try_inverse().unwrap();
        let [p, v, a]: [f64; 3] = (inverse * right).into();
        for (got, expected) in points[0].mean.into_iter().zip([p, v, a]) {
            assert!((got - expected).abs() < 1e-3, "{:?} {p} {v} {a}", points[0]);
        }
        assert!((points[1].mean[0] - (p + 0.9 * v + 0.405 * a)).abs() < 1e-4, "{points:?}");
        for (got, variance) in points[0].std.into_iter().zip(inverse.diagonal().iter()) {
            assert!((got / (0.1 * variance.sqrt()) - 1.0).abs() < 1e-2, "{points:?} {inverse}");
        }
    }

    #[test]
    fn the_spread_is_that_of_the_errors() {
        // The motions are drawn from the model itself, so that errors divided by their standard
        // deviations must have a variance of one.
        let (density, step_s, n) = (50.0_f64, 0.02, 100);
        let root = process_noise_over(step_s).cholesky().unwrap().l() * density.sqrt();
        let mut squares = [0.0; 3];
        let n_motions = 60;
        for seed in 0..n_motions {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut normal = || -> f64 { rng.sample(StandardNormal) };
            let mut state = Vector3::new(0.0, 5.0, -1.0);
            let (mut truth, mut samples) = (Vec::new(), Vec::new());
            for i in 0..n {
                let time_s = step_s * f64::from(i);
                truth.push(state);
                let value = state[0] + 0.02 * normal();
                samples.push(TrackSample { time_s, order: 0, value, std: 0.02 });
                let value = state[1] + 0.1 * normal();
                samples.push(TrackSample { time_s, order: 1, value, std: 0.1 });
                let noise = root * Vector3::from_fn(|_, _| normal());
                state = transition_over(step_s) * state + noise;
            }
            let density = |_, _| density;
            let at = [10, 50, 90];
            let times = at.map(|i| step_s * f64::from(i));
            let points = track(&samples, &density).smooth(&times).unwrap();
            for (i, point) in at.into_iter().zip(points) {
                for k in 0..3 {
                    squares[k] += ((point.mean[k] - truth[i as usize][k]) / point.std[k]).powi(2);
                }
            }
        }
        // The standard error of the mean of 180 squares is about √(2/180) = 0.11.
        for square in squares.map(|sum| sum / (3.0 * n_motions as f64)) {
            assert!((square - 1.0).abs() < 0.35, "{squares:?}");
        }
    }

    #[test]
    fn the_likelihood_knows_the_noise() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let noise: Vec<f64> =
            (0..200).map(|_| 0.05 * rng.sample::<f64, _>(StandardNormal)).collect();
        let likelihood = |std: f64| {
            let sample = |(i, noise): (usize, &f64)| {
                let time_s = 0.01 * i as f64;
                TrackSample { time_s, order: 0, value: 3.0 * time_s + noise, std }
            };
            let samples: Vec<TrackSample> = noise.iter().enumerate().map(sample).collect();
            track(&samples, &|_, _| 1.0).log_likelihood()
        };
        assert!(likelihood(0.05) > likelihood(0.03) && likelihood(0.05) > likelihood(0.08));
    }

    #[test]
    fn nothing_comes_of_nothing() {
        assert_eq!(track(&[], &|_, _| 1.0).smooth(&[]), None);
        let bad = [TrackSample { time_s: 0.0, order: 0, value: f64::NAN, std: 1.0 }];
        assert_eq!(track(&bad, &|_, _| 1.0).smooth(&[0.0]), None);
    }
}
