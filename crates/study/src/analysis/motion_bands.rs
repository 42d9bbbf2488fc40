//! Central intervals of the quantities of a motion forecast over time.

use rayon::prelude::*;

use impactlab_core::units::Estimate;
use impactlab_networks::response::{MotionDistribution, STEP_S};

/// Probabilities of the intervals, from the widest to the narrowest.
pub const MOTION_BAND_LEVELS: [f64; 2] = [0.9, 0.5];

/// Intervals `[lower, upper]` at an instant by quantity and level of [`MOTION_BAND_LEVELS`].
pub type MotionBand = [[[f64; 2]; MOTION_BAND_LEVELS.len()]; 6];

/// Central intervals of X, Y (m), ψ (rad), v_x, v_y (m/s) and r (rad/s) over time: each end leaves
/// the same probability outside. They are quantiles of the draws, as are the intervals of the outcome.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionBands {
    /// Times of the instants, s.
    pub time_s: Vec<f64>,
    /// Intervals of the instants.
    pub intervals: Vec<MotionBand>,
}

/// Steps between two instants of the bands of a figure, which makes 50 ms.
const FIGURE_STRIDE: usize = 5;

impl MotionBands {
    /// Intervals as a figure shows them.
    pub fn for_figure(motion: &MotionDistribution) -> Self {
        Self::new(motion, FIGURE_STRIDE)
    }

    /// Intervals of every `stride`-th instant and of the last one.
    pub fn new(motion: &MotionDistribution, stride: usize) -> Self {
        let last = motion.n_instants().saturating_sub(1);
        let mut instants: Vec<usize> = (0..motion.n_instants()).step_by(stride.max(1)).collect();
        if instants.last().is_some_and(|at| *at != last) {
            instants.push(last);
        }
        let at = |&at: &usize| {
            std::array::from_fn(|axis| {
                let drawn = Estimate::from_draws(motion.values(at, axis));
                MOTION_BAND_LEVELS.map(|level| drawn.interval(level).unwrap_or([f64::NAN; 2]))
            })
        };
        Self {
            time_s: instants.iter().map(|at| *at as f64 * STEP_S).collect(),
            intervals: instants.par_iter().map(at).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::VehicleState;

    #[test]
    fn bands_are_the_intervals_that_are_said_of_the_draws() {
        let draw = |i: i32| -> Vec<VehicleState<f64>> {
            let state = |at: i32| VehicleState {
                x_m: f64::from(at * i),
                vx_body_m_s: f64::from(i * i),
                ..VehicleState::default()
            };
            (0..4).map(state).collect()
        };
        let motion = MotionDistribution::new((0..41).map(draw).collect(), 4);
        let bands = MotionBands::new(&motion, 2);
        assert_eq!(bands.time_s, [0.0, 2.0 * STEP_S, 3.0 * STEP_S]);
        let said = Estimate::from_draws((0..41).map(|i| f64::from(3 * i)).collect());
        assert_eq!(bands.intervals[2][0], [said.ninety(), said.half()]);
        assert_eq!(bands.intervals[2][0], [[6.0, 114.0], [30.0, 90.0]]);
        assert_eq!(bands.intervals[1][3], [[4.0, 1444.0], [100.0, 900.0]]);
        assert_eq!(bands.intervals[0][0], [[0.0; 2]; 2]);
    }
}
