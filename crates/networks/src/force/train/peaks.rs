//! Factors on peaks: with them the peaks that are told hold what their intervals promise.

use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use crate::force::train::calibration::{CalibrationCase, Tried, VarianceFactors};
use crate::force::train::held_shares::Held;
use impactlab_core::numerics::{median, random_stream};
use impactlab_core::uncertainty::PeakFactors;

/// Factors on the deviation of peaks that are tried.
const PEAK_SPREAD: Tried = Tried { n: 31, range: [0.25, 8.0] };
/// Number of draws of a case for its peak.
const N_PEAK_DRAWS: usize = 200;

/// Logarithms of the peaks of a case: observed, and of each draw that of the mean curve of its component
/// and of what the draw has more.
struct LogPeaks {
    observed: f64,
    drawn: Vec<[f64; 2]>,
}

impl LogPeaks {
    fn new(case: &CalibrationCase<'_>, factors: VarianceFactors, idx: usize, seed: u64) -> Self {
        let [means, peaks] = [0.0, 1.0].map(|spread| {
            let peak = PeakFactors { scale: 1.0, spread };
            let mixture = VarianceFactors { peak, ..factors }.apply(case.mixture.clone());
            let mut rng: ChaCha8Rng = random_stream(seed, "calibration of peaks", idx as u64);
            mixture.sample_quantities(N_PEAK_DRAWS, &mut rng).1.peak_n
        });
        let pair = |(mean, peak): (&f64, &f64)| [mean.ln(), (peak / mean).ln()];
        let drawn = means.iter().zip(&peaks).map(pair).collect();
        Self { observed: case.case.peak_n.ln(), drawn }
    }

    /// How far the observed peak lies above those that are told with a factor on their deviation.
    fn above(&self, spread: f64) -> Vec<f64> {
        self.drawn.iter().map(|[mean, more]| self.observed - mean - spread * more).collect()
    }
}

/// Factors on the peaks of curves with given factors.
pub(super) fn peak_factors(
    cases: &[CalibrationCase<'_>],
    factors: VarianceFactors,
    seed: u64,
) -> PeakFactors {
    let of_case = |(idx, case)| LogPeaks::new(case, factors, idx, seed);
    let peaks: Vec<LogPeaks> = cases.par_iter().enumerate().map(of_case).collect();
    let middle = |values: &[f64]| median(values.iter().copied()).unwrap_or(0.0);
    let mut best = (f64::INFINITY, PeakFactors::default());
    for spread in PEAK_SPREAD.factors() {
        let above: Vec<Vec<f64>> = peaks.iter().map(|case| case.above(spread)).collect();
        let log_scale = middle(&above.iter().map(|case| middle(case)).collect::<Vec<_>>());
        let below = above.iter().map(|case| {
            let n_below = case.iter().filter(|above| **above > log_scale).count();
            n_below as f64 / case.len().max(1) as f64
        });
        let off = Held::of(&below.collect::<Vec<f64>>()).off();
        // Of equal ones the widest.
        if off <= best.0 && log_scale.is_finite() {
            best = (off, PeakFactors { scale: log_scale.exp(), spread });
        }
    }
    best.1
}
