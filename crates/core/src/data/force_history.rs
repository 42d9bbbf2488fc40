//! The contact force on the struck vehicle over time, and its impulse.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::{Channel, SeriesError, TimeSeries};
use crate::numerics::interpolate;

/// The axes in which the components of a force history are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ForceAxes {
    /// World axes. The force is turned into body axes by the yaw angle at the instant of
    /// evaluation.
    World,
    /// Heading axes of the struck vehicle, x forward and y left, which turn with it.
    Body,
}

/// What one sample of a force history stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sampling {
    /// The force at the instant of the sample; it varies linearly between samples.
    Instant,
    /// The mean force over an interval around the instant of the sample. Its ends are midway
    /// between neighbouring samples.
    CentredMean,
    /// The mean force over the interval from the instant of the sample to that of the next one.
    ComingMean,
}

/// A sampled history of the contact force ON the struck vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceHistory {
    /// The axes of `fx_n` and `fy_n`.
    pub axes: ForceAxes,
    /// What one sample stands for.
    pub sampling: Sampling,
    /// Instants of the samples, s, strictly increasing.
    pub time_s: Vec<f64>,
    /// Force along x, N.
    pub fx_n: Vec<f64>,
    /// Force along y, N.
    pub fy_n: Vec<f64>,
    /// Yaw moment of the contact force about the centre of gravity of the struck vehicle, N m;
    /// `None` if the source has not recorded it.
    pub mz_n_m: Option<Vec<f64>>,
}

impl ForceHistory {
    /// Takes the force from a series: in world axes, or in body axes if the series has `fx_body_n`
    /// but no `fx_n`.
    ///
    /// # Errors
    /// [`SeriesError::Missing`] if the series has neither pair of components completely.
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

    /// The history as a time series, which can be written to a file.
    ///
    /// # Errors
    /// [`SeriesError::TimeOrder`] if time does not increase, and [`SeriesError::Length`] if a
    /// component has another number of samples.
    pub fn to_series(&self) -> Result<TimeSeries, SeriesError> {
        let [x, y] = match self.axes {
            ForceAxes::World => [Channel::Fx, Channel::Fy],
            ForceAxes::Body => [Channel::FxBody, Channel::FyBody],
        };
        let mut series = TimeSeries::new(self.time_s.clone())?;
        series.insert(x, self.fx_n.clone())?;
        series.insert(y, self.fy_n.clone())?;
        if let Some(mz) = &self.mz_n_m {
            series.insert(Channel::Mz, mz.clone())?;
        }
        Ok(series)
    }

    /// The largest magnitude of the sampled force, N, and its time, s; `None` for an empty history.
    pub fn peak(&self) -> Option<(f64, f64)> {
        let magnitudes = self.fx_n.iter().zip(&self.fy_n).map(|(x, y)| x.hypot(*y));
        magnitudes.zip(self.time_s.iter().copied()).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The impulse of the whole history along x and y of [`ForceHistory::axes`], N s: `P = ∫ F dt`.
    pub fn impulse_n_s(&self) -> [f64; 2] {
        self.cumulative().total_n_s()
    }

    /// The impulse up to each instant, by the integral that is exact for the meaning of the
    /// samples: the trapezoidal rule for [`Sampling::Instant`], and the mean times the length of
    /// the interval otherwise.
    pub fn cumulative(&self) -> CumulativeImpulse {
        let knots_s = self.knots_s();
        let integrate = |values: &[f64]| self.integrate(&knots_s, values);
        CumulativeImpulse {
            px_n_s: integrate(&self.fx_n),
            py_n_s: integrate(&self.fy_n),
            angular_n_m_s: self.mz_n_m.as_deref().map(integrate),
            knots_s,
        }
    }

    /// The ends of the intervals over which the samples give the mean force, s: one more than there
    /// are intervals. With fewer than two samples they are the instants themselves.
    fn knots_s(&self) -> Vec<f64> {
        let time = &self.time_s;
        let (&[first, second, ..], &[.., before_last, last]) = (time.as_slice(), time.as_slice())
        else {
            return time.clone();
        };
        match self.sampling {
            Sampling::Instant => time.clone(),
            Sampling::CentredMean => {
                let middles = time.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0);
                let start = first - (second - first) / 2.0;
                let end = last + (last - before_last) / 2.0;
                std::iter::once(start).chain(middles).chain([end]).collect()
            }
            Sampling::ComingMean => {
                time.iter().copied().chain([last + (last - before_last)]).collect()
            }
        }
    }

    fn integrate(&self, knots_s: &[f64], values: &[f64]) -> Vec<f64> {
        let trapezoid: Vec<f64>;
        let means = if self.sampling == Sampling::Instant {
            trapezoid = values.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0).collect();
            trapezoid.as_slice()
        } else {
            values
        };
        let widths = knots_s.windows(2).map(|pair| pair[1] - pair[0]);
        let running = means.iter().zip(widths).scan(0.0, |sum, (mean, width)| {
            *sum += mean * width;
            Some(*sum)
        });
        std::iter::once(0.0).chain(running).collect()
    }
}

/// The impulse from the start of a force history up to each of its knots. The impulse varies
/// linearly between knots.
#[derive(Debug, Clone, PartialEq)]
pub struct CumulativeImpulse {
    /// Instants of the knots, s, increasing.
    pub knots_s: Vec<f64>,
    /// Impulse along x up to each knot, N s.
    pub px_n_s: Vec<f64>,
    /// Impulse along y up to each knot, N s.
    pub py_n_s: Vec<f64>,
    /// Angular impulse about the centre of gravity of the struck vehicle up to each knot, N m s;
    /// `None` if the moment is not known.
    pub angular_n_m_s: Option<Vec<f64>>,
}

impl CumulativeImpulse {
    /// Impulse `[x, y]` of the whole history, N s.
    pub fn total_n_s(&self) -> [f64; 2] {
        [&self.px_n_s, &self.py_n_s].map(|sum| sum.last().copied().unwrap_or(0.0))
    }

    /// The mean force `[F_x, F_y]`, N, and the mean yaw moment, N m, over the interval from
    /// `from_s` to `to_s`, s. A simulation that applies the mean over each of its steps receives
    /// the whole impulse whatever the length of the step. The force is zero outside the history.
    ///
    /// ```text
    /// F̄ = (P(to) − P(from)) / (to − from)
    /// ```
    ///
    /// - `to_s`: later than `from_s`.
    pub fn mean_over(&self, from_s: f64, to_s: f64) -> ([f64; 2], Option<f64>) {
        let mean = |sum: &[f64]| {
            let at = |time| interpolate(&self.knots_s, sum, time).unwrap_or(0.0);
            (at(to_s) - at(from_s)) / (to_s - from_s)
        };
        ([mean(&self.px_n_s), mean(&self.py_n_s)], self.angular_n_m_s.as_deref().map(mean))
    }

    /// The end of the history, s; −∞ for an empty history.
    pub fn end_s(&self) -> f64 {
        self.knots_s.last().copied().unwrap_or(f64::NEG_INFINITY)
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
        for (sampling, duration) in
            [(Sampling::Instant, 0.3), (Sampling::CentredMean, 0.4), (Sampling::ComingMean, 0.4)]
        {
            let [px, py] = history(sampling).impulse_n_s();
            assert!((px - duration).abs() < 1e-12, "{sampling:?}: {px}");
            assert!((py - 7.0).abs() < 1e-12, "{sampling:?}: {py}");
        }
    }

    #[test]
    fn no_impulse_is_lost_between_steps() {
        for sampling in [Sampling::Instant, Sampling::CentredMean, Sampling::ComingMean] {
            let history = history(sampling);
            let cumulative = history.cumulative();
            let step = 0.007;
            let sum: f64 = (-20..100)
                .map(|k| step * cumulative.mean_over(k as f64 * step, (k + 1) as f64 * step).0[1])
                .sum();
            assert!((sum - history.impulse_n_s()[1]).abs() < 1e-12, "{sampling:?}: {sum}");
        }
    }

    #[test]
    fn an_empty_or_single_sample_has_no_impulse() {
        for n in [0, 1] {
            let mut short = history(Sampling::CentredMean);
            for column in [&mut short.time_s, &mut short.fx_n, &mut short.fy_n] {
                column.truncate(n);
            }
            assert_eq!(short.impulse_n_s(), [0.0, 0.0]);
        }
    }

    #[test]
    fn the_peak_is_of_the_resultant() {
        let (peak, at) = history(Sampling::Instant).peak().unwrap();
        assert!((peak - 1.0_f64.hypot(40.0)).abs() < 1e-12);
        assert_eq!(at, 0.2);
    }
}
