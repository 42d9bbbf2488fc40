//! The force curve that the force models predict: a contact force on a fixed time grid.

use serde::{Deserialize, Serialize};

use crate::data::{ForceAxes, ForceHistory, Sampling};

/// Width of the intervals of the time grid, s. Each value of a curve is the mean force over an
/// interval.
pub const CURVE_INTERVAL_S: f64 = 1e-3;

/// Number of intervals of the time grid: 0 to 0.25 s, about twice the median contact duration of
/// the shipped runs.
pub const CURVE_N_INSTANTS: usize = 250;

/// Contact force on the struck vehicle, as means over intervals of [`CURVE_INTERVAL_S`], and the
/// duration of the contact. Interval i is centred at `(i + ½)` intervals after the first contact.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ForceCurve {
    /// Force along x, N, one value for each interval.
    pub fx_n: Vec<f64>,
    /// Force along y, N; as many values as `fx_n`.
    pub fy_n: Vec<f64>,
    /// Time from first contact to final separation, s.
    pub duration_s: f64,
}

impl ForceCurve {
    /// The curve whose values are the row `[F_x(t₁) … F_x(t_T), F_y(t₁) … F_y(t_T), duration]` of
    /// 2T + 1 values. A duration that is missing is zero.
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

    /// The row of 2T + 1 values that [`ForceCurve::from_values`] takes.
    pub fn to_values(&self) -> Vec<f64> {
        let forces = self.fx_n.iter().chain(&self.fy_n).copied();
        forces.chain([self.duration_s]).collect()
    }

    /// Number of intervals of the curve's time grid.
    pub fn n_instants(&self) -> usize {
        self.fx_n.len()
    }

    /// Time of the middle of each interval, s.
    pub fn time_s(&self) -> Vec<f64> {
        (0..self.n_instants()).map(instant_s).collect()
    }

    /// Magnitude `|F|` in each interval, N.
    pub fn magnitude_n(&self) -> Vec<f64> {
        self.fx_n.iter().zip(&self.fy_n).map(|(x, y)| x.hypot(*y)).collect()
    }

    /// Impulse `∫ F dt` over the grid as `[P_x, P_y]`, N s.
    pub fn impulse_n_s(&self) -> [f64; 2] {
        [&self.fx_n, &self.fy_n].map(|force| force.iter().sum::<f64>() * CURVE_INTERVAL_S)
    }

    /// Largest `|F|`, N, and the time at which it occurs, s; both are zero for an empty curve.
    pub fn peak(&self) -> (f64, f64) {
        let squares = self.fx_n.iter().zip(&self.fy_n).map(|(x, y)| x * x + y * y);
        let largest = squares
            .enumerate()
            .fold((0, 0.0), |best, (i, square)| if square > best.1 { (i, square) } else { best });
        if self.fx_n.is_empty() { (0.0, 0.0) } else { (largest.1.sqrt(), instant_s(largest.0)) }
    }

    /// The curve of the collision mirrored left to right: `F_y` changes its sign.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self { fy_n: self.fy_n.iter().map(|f| -f).collect(), ..self.clone() }
    }

    /// The curve as a force history whose axes are called world axes, with samples that are means
    /// over the interval around their time. There is no yaw moment.
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

/// Time of the middle of an interval, s.
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
