//! The contact force on the target over time, as the physics wants it.

use crate::data::{Channel, SeriesError, TimeSeries};

/// The axes in which a force history is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ForceAxes {
    /// World axes: turned into the body by the yaw angle at every evaluation.
    World,
    /// Heading axes of the target: they turn with it.
    Body,
}

/// What one sample of a force history stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampling {
    /// The value at the sample's instant; linear in between. Impulse by the trapezoid rule.
    Instant,
    /// The mean over an interval centred at the sample's instant.
    CentredMean,
    /// The mean over the interval from the sample's instant to the next one.
    ComingMean,
}

/// Contact force ON the target.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceHistory {
    /// Axes of `fx_n`, `fy_n`.
    pub axes: ForceAxes,
    /// Meaning of a sample.
    pub sampling: Sampling,
    /// Time, s, strictly rising.
    pub time_s: Vec<f64>,
    /// Force along x, N.
    pub fx_n: Vec<f64>,
    /// Force along y, N.
    pub fy_n: Vec<f64>,
    /// Yaw moment about the target's CG, N m, where the source recorded it.
    pub mz_n_m: Option<Vec<f64>>,
}

impl ForceHistory {
    /// Takes the force out of a series: world axes if `fx_n`, `fy_n` are there, else the body axes.
    ///
    /// # Errors
    /// [`SeriesError::Missing`] if neither pair is complete.
    pub fn from_series(series: &TimeSeries, sampling: Sampling) -> Result<Self, SeriesError> {
        let (axes, x, y) = match (series.get(Channel::Fx), series.get(Channel::FxBody)) {
            (None, Some(_)) => (ForceAxes::Body, Channel::FxBody, Channel::FyBody),
            _ => (ForceAxes::World, Channel::Fx, Channel::Fy),
        };
        Ok(Self {
            axes,
            sampling,
            time_s: series.time_s().to_vec(),
            fx_n: series.require(x)?.to_vec(),
            fy_n: series.require(y)?.to_vec(),
            mz_n_m: series.get(Channel::Mz).map(<[f64]>::to_vec),
        })
    }

    /// Width of the interval that each sample stands for, s: sums with these weights are the
    /// integrals over time (trapezoid weights for instants; interval widths for means).
    pub fn weights_s(&self) -> Vec<f64> {
        let time = &self.time_s;
        let n = time.len();
        if n < 2 {
            return vec![0.0; n];
        }
        let step = |i: usize| time[i + 1] - time[i];
        (0..n)
            .map(|i| {
                let (before, after) = (i.checked_sub(1).map(step), (i + 1 < n).then(|| step(i)));
                let (edge, full) = (before.or(after).unwrap_or(0.0), after.or(before));
                match self.sampling {
                    Sampling::Instant => (before.unwrap_or(0.0) + after.unwrap_or(0.0)) / 2.0,
                    Sampling::CentredMean => (before.unwrap_or(edge) + after.unwrap_or(edge)) / 2.0,
                    Sampling::ComingMean => full.unwrap_or(0.0),
                }
            })
            .collect()
    }

    /// Impulse `P = ∫ F dt`, N s, along x and y of [`ForceHistory::axes`].
    pub fn impulse_n_s(&self) -> [f64; 2] {
        let weights = self.weights_s();
        let sum = |force: &[f64]| force.iter().zip(&weights).map(|(f, w)| f * w).sum();
        [sum(&self.fx_n), sum(&self.fy_n)]
    }

    /// Largest `|F|`, N, and its time, s. `None` for an empty history.
    pub fn peak(&self) -> Option<(f64, f64)> {
        let magnitudes = self.fx_n.iter().zip(&self.fy_n).map(|(x, y)| x.hypot(*y));
        magnitudes
            .zip(self.time_s.iter().copied())
            .max_by(|a, b| a.0.total_cmp(&b.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history(sampling: Sampling) -> ForceHistory {
        ForceHistory {
            axes: ForceAxes::World,
            sampling,
            time_s: vec![0.0, 0.1, 0.2, 0.3],
            fx_n: vec![1.0, 1.0, 1.0, 1.0],
            fy_n: vec![0.0, 30.0, 40.0, 0.0],
            mz_n_m: None,
        }
    }

    #[test]
    fn the_impulse_is_the_integral_that_the_samples_mean() {
        for (sampling, duration) in [
            (Sampling::Instant, 0.3),
            (Sampling::CentredMean, 0.4),
            (Sampling::ComingMean, 0.4),
        ] {
            let [px, py] = history(sampling).impulse_n_s();
            assert!((px - duration).abs() < 1e-12, "{sampling:?}: {px}");
            assert!((py - 7.0).abs() < 1e-12, "{sampling:?}: {py}");
        }
    }

    #[test]
    fn the_peak_is_of_the_resultant() {
        let (peak, at) = history(Sampling::Instant).peak().unwrap();
        assert!((peak - 1.0_f64.hypot(40.0)).abs() < 1e-12);
        assert_eq!(at, 0.2);
    }
}
