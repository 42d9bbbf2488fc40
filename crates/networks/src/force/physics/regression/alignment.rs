//! Shapes of force curves: the curves over a scaled time and in axes along and across their impulse,
//! so that neither impulse nor onset nor length matters.

use serde::{Deserialize, Serialize};

use crate::force::ForceCase;
use impactlab_core::uncertainty::{CURVE_INTERVAL_S, CURVE_N_INSTANTS, ForceCurve};

/// Number of cells of a shape. They start at [`SHAPE_START`] in units of the scaled time and are
/// [`SHAPE_CELL`] wide.
pub(crate) const SHAPE_CELLS: usize = 400;
const SHAPE_START: f64 = -1.0;
const SHAPE_CELL: f64 = 0.0125;

/// The interval of a curve that is the unit of its scaled time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Alignment {
    /// From first touch to last separation.
    Contact,
    /// Between two shares of `∫ |F| dt`, on which weak contact at the ends has little influence.
    ImpulseShares {
        /// Share at the start, 0 to 1.
        from: f64,
        /// Share at the end, above `from`.
        to: f64,
    },
}

/// Interval and impulse of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Placement {
    /// Start of the interval that is its unit of time, s.
    pub start_s: f64,
    /// Length of this interval, s, positive.
    pub length_s: f64,
    /// Size of the impulse, N s.
    pub impulse_n_s: f64,
    /// Direction of the impulse from +y, rad, clockwise: `atan2(P_x, P_y)`.
    pub direction_rad: f64,
}

impl Alignment {
    /// The alignments among which cross-validation chooses.
    pub const CANDIDATES: [Self; 4] = [
        Self::Contact,
        Self::ImpulseShares { from: 0.02, to: 0.90 },
        Self::ImpulseShares { from: 0.02, to: 0.95 },
        Self::ImpulseShares { from: 0.05, to: 0.90 },
    ];

    /// Start and length of the interval of a case, s.
    pub(crate) fn interval_s(self, case: &ForceCase) -> (f64, f64) {
        match self {
            Self::Contact => {
                let grid_s = CURVE_N_INSTANTS as f64 * CURVE_INTERVAL_S;
                (case.onset_s, case.curve.duration_s.clamp(CURVE_INTERVAL_S, grid_s))
            }
            Self::ImpulseShares { from, to } => {
                let [start, end] = impulse_share_times_s(&case.curve, [from, to]);
                (start, (end - start).max(CURVE_INTERVAL_S))
            }
        }
    }

    /// Interval and impulse of a case.
    pub(crate) fn placement(self, case: &ForceCase) -> Placement {
        let (start_s, length_s) = self.interval_s(case);
        let [px, py] = case.impulse_n_s;
        let (impulse_n_s, direction_rad) = (px.hypot(py), px.atan2(py));
        Placement { start_s, length_s, impulse_n_s, direction_rad }
    }
}

/// Times at which `∫ |F| dt` reaches these shares of its total, s.
pub(crate) fn impulse_share_times_s(curve: &ForceCurve, shares: [f64; 2]) -> [f64; 2] {
    let magnitudes = curve.magnitude_n();
    let total: f64 = magnitudes.iter().sum();
    shares.map(|share| {
        let (mut sum, target) = (0.0, share * total);
        for (i, magnitude) in magnitudes.iter().enumerate() {
            if sum + magnitude >= target && *magnitude > 0.0 {
                return (i as f64 + (target - sum) / magnitude) * CURVE_INTERVAL_S;
            }
            sum += magnitude;
        }
        magnitudes.len() as f64 * CURVE_INTERVAL_S
    })
}

impl Placement {
    /// The shape of a curve: the share of the impulse in each cell of the scaled time, per unit of this
    /// time, first across the impulse and then along it, `[2 × cells]`. Without what lies outside of the
    /// cells, the part along the impulse has the sum 1.
    pub(crate) fn shape_of(&self, curve: &ForceCurve) -> Vec<f64> {
        let edges: Vec<f64> = (0..=SHAPE_CELLS)
            .map(|i| self.start_s + shape_edge(i) * self.length_s)
            .map(|time_s| time_s / CURVE_INTERVAL_S)
            .collect();
        let (sin, cos) = self.direction_rad.sin_cos();
        let scale = CURVE_INTERVAL_S / (SHAPE_CELL * self.impulse_n_s);
        let [x, y] = [&curve.fx_n, &curve.fy_n].map(|force| rebin(force, &edges));
        let across = x.iter().zip(&y).map(|(x, y)| (x * cos - y * sin) * scale);
        let along = x.iter().zip(&y).map(|(x, y)| (x * sin + y * cos) * scale);
        across.chain(along).collect()
    }

    /// The curve of a shape, which is the inverse of [`Placement::shape_of`] up to the width of the
    /// cells. The duration is not set.
    pub(crate) fn curve_of(&self, shape: &[f64]) -> ForceCurve {
        let cell_of =
            |time_s: f64| ((time_s - self.start_s) / self.length_s - SHAPE_START) / SHAPE_CELL;
        let edges: Vec<f64> =
            (0..=CURVE_N_INSTANTS).map(|i| cell_of(i as f64 * CURVE_INTERVAL_S)).collect();
        let (across, along) = shape.split_at(shape.len() / 2);
        let (sin, cos) = self.direction_rad.sin_cos();
        let scale = self.impulse_n_s * SHAPE_CELL / CURVE_INTERVAL_S;
        let [across, along] = [across, along].map(|part| rebin(part, &edges));
        let turned =
            |x: f64, y: f64| across.iter().zip(&along).map(move |(a, b)| (a * x + b * y) * scale);
        ForceCurve {
            fx_n: turned(cos, sin).collect(),
            fy_n: turned(-sin, cos).collect(),
            duration_s: 0.0,
        }
    }
}

fn shape_edge(idx: usize) -> f64 {
    SHAPE_START + idx as f64 * SHAPE_CELL
}

/// Sums of the contents of cells between rising edges, which are positions in cells. Outside of the
/// cells the content is zero.
fn rebin(cells: &[f64], edges: &[f64]) -> Vec<f64> {
    let mut sums = Vec::with_capacity(cells.len() + 1);
    let mut sum = 0.0;
    sums.push(sum);
    for cell in cells {
        sum += cell;
        sums.push(sum);
    }
    let until = |edge: f64| {
        let edge = edge.clamp(0.0, cells.len() as f64);
        let idx = (edge as usize).min(cells.len().saturating_sub(1));
        sums.get(idx).copied().unwrap_or(0.0)
            + cells.get(idx).copied().unwrap_or(0.0) * (edge - idx as f64)
    };
    let mut before = edges.first().map_or(0.0, |edge| until(*edge));
    let step = |edge: &f64| {
        let now = until(*edge);
        let share = now - before;
        before = now;
        share
    };
    edges.iter().skip(1).map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::input::shipped;
    use impactlab_core::uncertainty::distance_n;

    #[test]
    fn a_curve_comes_back_from_its_shape() {
        for case in shipped("fea").iter().filter(|case| case.is_clean()) {
            for alignment in Alignment::CANDIDATES {
                let placement = alignment.placement(case);
                let shape = placement.shape_of(&case.curve);
                let back = placement.curve_of(&shape);
                let (off, peak) = (distance_n(&back, &case.curve), case.peak_n);
                assert!(off < 0.02 * peak, "{} {alignment:?}: {off} of {peak}", case.name);
                // What lies later than four units of time is left out.
                let along: f64 = shape[SHAPE_CELLS..].iter().sum::<f64>() * SHAPE_CELL;
                assert!((along - 1.0).abs() < 1e-2, "{} {alignment:?}: {along}", case.name);
            }
        }
    }

    #[test]
    fn shares_of_a_square_pulse() {
        let mut curve = ForceCurve { fx_n: vec![0.0; 30], fy_n: vec![0.0; 30], duration_s: 0.02 };
        curve.fy_n[5..25].fill(-3.0);
        let [from, to] = impulse_share_times_s(&curve, [0.1, 0.95]);
        assert!((from - 0.007).abs() < 1e-12 && (to - 0.024).abs() < 1e-12, "{from} {to}");
    }

    #[test]
    fn rebinning_keeps_the_sum() {
        let cells = [1.0, 4.0, 2.0];
        assert_eq!(rebin(&cells, &[-1.0, 0.5, 1.5, 9.0]), [0.5, 2.5, 4.0]);
        assert_eq!(rebin(&cells, &[0.0, 1.0, 2.0, 3.0]), cells);
    }
}
