//! Intervals of a forecast's quantities over time.

use rayon::prelude::*;

use crate::response::{MotionDistribution, STEP_S};

/// Probabilities of the intervals, the widest first.
pub const MOTION_BAND_LEVELS: [f64; 2] = [0.9, 0.5];

/// Intervals of X, Y, ψ, v_x, v_y and r over time, m, rad, m/s and rad/s: from quantile to quantile
/// with as much probability on either side.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionBands {
    /// The instants, s.
    pub time_s: Vec<f64>,
    /// At each instant, of each quantity, at each of [`MOTION_BAND_LEVELS`]: lower and upper end.
    pub intervals: Vec<[[[f64; 2]; MOTION_BAND_LEVELS.len()]; 6]>,
}

impl MotionBands {
    /// Of every `stride`-th instant and the last.
    pub fn of(motion: &MotionDistribution, stride: usize) -> Self {
        let last = motion.n_instants().saturating_sub(1);
        let mut instants: Vec<usize> = (0..motion.n_instants()).step_by(stride.max(1)).collect();
        if instants.last().is_some_and(|at| *at != last) {
            instants.push(last);
        }
        let at = |&at: &usize| {
            let mean = motion.mean(at).planar();
            std::array::from_fn(|axis| match motion.marginal(at, axis) {
                Some(marginal) => MOTION_BAND_LEVELS.map(|level| marginal.interval(level)),
                None => [[mean[axis]; 2]; MOTION_BAND_LEVELS.len()],
            })
        };
        Self {
            time_s: instants.iter().map(|at| *at as f64 * STEP_S).collect(),
            intervals: instants.par_iter().map(at).collect(),
        }
    }
}
