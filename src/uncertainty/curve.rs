//! A contact force over a fixed time grid: what the force models predict.

use serde::{Deserialize, Serialize};

use crate::data::{ForceAxes, ForceHistory, Sampling};

/// Width of the intervals of the time grid, s. A value of a curve is the mean force over one.
pub const CURVE_INTERVAL_S: f64 = 1e-3;

/// Intervals of the time grid: 0 to 0.25 s, about twice the median contact of the shipped runs.
pub const CURVE_N_INSTANTS: usize = 250;

/// Force ON the target as means over [`CURVE_INTERVAL_S`], interval i around `(i + ½)` intervals
/// from the start, and how long the contact lasts.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceCurve {
    /// Along x, N.
    pub fx_n: Vec<f64>,
    /// Along y, N; as long as `fx_n`.
    pub fy_n: Vec<f64>,
    /// From first touch to last separation, s.
    pub duration_s: f64,
}

impl ForceCurve {
    /// The curve in a row `[F_x(t₁) … F_x(t_T), F_y(t₁) … F_y(t_T), duration]`.
    pub fn from_values(values: &[f64]) -> Self {
        let n_instants = values.len().saturating_sub(1) / 2;
        let (fx, rest) = values.split_at(n_instants);
        let (fy, duration) = rest.split_at(n_instants.min(rest.len()));
        Self {
            fx_n: fx.to_vec(),
            fy_n: fy.to_vec(),
            duration_s: duration.first().copied().unwrap_or(0.0),
        }
    }

    /// The row that [`ForceCurve::from_values`] takes.
    pub fn to_values(&self) -> Vec<f64> {
        let forces = self.fx_n.iter().chain(&self.fy_n).copied();
        forces.chain([self.duration_s]).collect()
    }

    /// Intervals of its time grid.
    pub fn n_instants(&self) -> usize {
        self.fx_n.len()
    }

    /// Middle of each interval, s.
    pub fn time_s(&self) -> Vec<f64> {
        (0..self.n_instants()).map(instant_s).collect()
    }

    /// `|F|` at each instant, N.
    pub fn magnitude_n(&self) -> Vec<f64> {
        self.fx_n.iter().zip(&self.fy_n).map(|(x, y)| x.hypot(*y)).collect()
    }

    /// Impulse `∫ F dt` over the grid, N s.
    pub fn impulse_n_s(&self) -> [f64; 2] {
        [&self.fx_n, &self.fy_n].map(|force| force.iter().sum::<f64>() * CURVE_INTERVAL_S)
    }

    /// Largest `|F|`, N, and its time, s; zeros for an empty curve.
    pub fn peak(&self) -> (f64, f64) {
        let squares = self.fx_n.iter().zip(&self.fy_n).map(|(x, y)| x * x + y * y);
        let largest = squares
            .enumerate()
            .fold((0, 0.0), |best, (i, square)| if square > best.1 { (i, square) } else { best });
        if self.fx_n.is_empty() { (0.0, 0.0) } else { (largest.1.sqrt(), instant_s(largest.0)) }
    }

    /// The mirror image left to right: `F_y` changes its sign.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self { fy_n: self.fy_n.iter().map(|f| -f).collect(), ..self.clone() }
    }

    /// As a force history in world axes.
    pub fn to_history(&self) -> ForceHistory {
        ForceHistory {
            axes: ForceAxes::World,
            sampling: Sampling::CentredMean,
            time_s: self.time_s(),
            fx_n: self.fx_n.clone(),
            fy_n: self.fy_n.clone(),
            mz_n_m: None,
        }
    }
}

fn instant_s(idx: usize) -> f64 {
    (idx as f64 + 0.5) * CURVE_INTERVAL_S
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve() -> ForceCurve {
        ForceCurve { fx_n: vec![0.0, 3e3, 1e3], fy_n: vec![0.0, -4e3, 2e3], duration_s: 0.002 }
    }

    #[test]
    fn impulse_and_peak_are_those_of_the_history() {
        let (curve, history) = (curve(), curve().to_history());
        for (a, b) in curve.impulse_n_s().into_iter().zip(history.impulse_n_s()) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
        assert_eq!(Some(curve.peak()), history.peak());
        assert_eq!(curve.peak(), (5e3, 1.5e-3));
        assert_eq!(ForceCurve::default().peak(), (0.0, 0.0));
    }

    #[test]
    fn rows_and_mirrors_go_there_and_back() {
        let curve = curve();
        assert_eq!(ForceCurve::from_values(&curve.to_values()), curve);
        assert_eq!(curve.mirrored().mirrored(), curve);
        assert_eq!(curve.mirrored().impulse_n_s()[1], -curve.impulse_n_s()[1]);
        assert_eq!(ForceCurve::from_values(&[]), ForceCurve::default());
    }
}
