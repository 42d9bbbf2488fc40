//! Central intervals of the quantities of a motion forecast over time.

use rayon::prelude::*;

use impactlab_networks::response::{MotionDistribution, STEP_S};

/// Probabilities of the intervals, from the widest to the narrowest.
pub const MOTION_BAND_LEVELS: [f64; 2] = [0.9, 0.5];

/// Intervals `[lower, upper]` at an instant by quantity and level of [`MOTION_BAND_LEVELS`].
pub type MotionBand = [[[f64; 2]; MOTION_BAND_LEVELS.len()]; 6];

/// Central intervals of X, Y (m), ψ (rad), v_x, v_y (m/s) and r (rad/s) over time: each end leaves
/// the same probability outside.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionBands {
    /// Times of the instants, s.
    pub time_s: Vec<f64>,
    /// Intervals of the instants.
    pub intervals: Vec<MotionBand>,
}

impl MotionBands {
    /// Intervals of every `stride`-th instant and of the last one. A quantity without a marginal
    /// distribution has its mean for both ends.
    pub fn new(motion: &MotionDistribution, stride: usize) -> Self {
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
