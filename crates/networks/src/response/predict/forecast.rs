//! The forecast of a motion: whole motions that are drawn.
//!
//! Mean and covariance of a velocity in the axes of the vehicle mean nothing once the vehicle may point
//! anywhere, and where most motions stay straight they miss those that spin. So evaluation and calibration
//! take what is drawn here: as many motions as a forecast for a person has.

use crate::response::{MotionDistribution, Predictor};
use impactlab_core::vehicle::{VehicleInput, VehicleState};

/// Whole motions of a forecast at the least: the end of a 90 % interval is then uncertain by 1.4 % of
/// probability.
pub const LEAST_MOTIONS: usize = 240;
/// Seed of the draws.
const SEED: u64 = 0;

impl Predictor {
    /// The distribution of the motion, of [`LEAST_MOTIONS`] coherent draws. They have the same random
    /// numbers with every width of the distribution.
    ///
    /// - `inputs`: the input over each step.
    pub fn forecast(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> MotionDistribution {
        let draws = self.sample(initial, inputs, LEAST_MOTIONS, SEED);
        MotionDistribution::new(draws, inputs.len() + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::LatentScales;
    use crate::response::predict::test_motions::{driving, predictor, released};

    /// Ends of other draws: X, Y, m, and heading, rad.
    fn ends(predictor: &Predictor, initial: &VehicleState<f64>, n: usize) -> Vec<[f64; 3]> {
        let others = predictor.sample(initial, &released(500), n, 77);
        let ends = others.iter().filter_map(|states| states.last());
        ends.map(|state| [state.x_m, state.y_m, state.yaw_rad]).collect()
    }

    /// One whose cars may spin or recover.
    fn uncertain() -> Predictor {
        let scales = LatentScales { step_noise: 0.003, ..LatentScales::default() };
        predictor().with_latents(scales.widened(12.0))
    }

    #[test]
    fn the_regions_hold_as_many_draws_as_they_say() {
        let certain = predictor();
        for (predictor, initial) in [(certain, driving(0.3)), (uncertain(), driving(4.5))] {
            let forecast = predictor.forecast(&initial, &released(500));
            assert_eq!(forecast.n_instants(), 501);
            let position = forecast.position(500);
            let ends = ends(&predictor, &initial, 400);
            let levels: Vec<f64> =
                ends.iter().map(|&[x, y, _]| position.level_of([x, y])).collect();
            for level in [0.5, 0.9] {
                let inside = levels.iter().filter(|reached| **reached <= level).count();
                let held = inside as f64 / ends.len() as f64;
                assert!((held - level).abs() < 0.1, "{held} of {level}, {initial:?}");
            }
        }
    }

    #[test]
    fn mean_and_deviation_are_those_of_many_more_draws_within_their_errors() {
        let (predictor, initial) = (predictor(), driving(0.3));
        let forecast = predictor.forecast(&initial, &released(500));
        let (mean, covariance) = (forecast.mean(500).planar(), forecast.covariance(500));
        let ends = ends(&predictor, &initial, 4000);
        for axis in 0..3 {
            let n = ends.len() as f64;
            let expected = ends.iter().map(|end| end[axis]).sum::<f64>() / n;
            let square = ends.iter().map(|end| (end[axis] - expected).powi(2)).sum::<f64>() / n;
            let std = square.sqrt();
            // Four standard errors of 240 draws: 0.26 and, of a normal distribution, 0.18 of a deviation.
            assert!(
                (mean[axis] - expected).abs() < 0.27 * std,
                "{axis}: {} {expected}",
                mean[axis]
            );
            let ratio = covariance[(axis, axis)].sqrt() / std;
            assert!((ratio - 1.0).abs() < 0.25, "{axis}: deviation off by {ratio}");
        }
    }

    #[test]
    fn the_same_random_numbers_hold_with_another_width() {
        let scales = LatentScales { step_noise: 0.0, ..LatentScales::default() };
        let off = |factor: f64| {
            let [certain, drawn] = [0.0, factor].map(|factor| {
                let predictor = predictor().with_latents(scales.widened(factor));
                let end = predictor.sample(&driving(0.3), &released(100), 1, 0)[0][100];
                [end.x_m, end.y_m]
            });
            [drawn[0] - certain[0], drawn[1] - certain[1]]
        };
        let ([x, y], [x_twice, y_twice]) = (off(0.5), off(1.0));
        let [once, twice] = [x.hypot(y), x_twice.hypot(y_twice)];
        assert!(once > 0.0 && (twice / once - 2.0).abs() < 0.2, "{once} {twice}");
        assert!(x * x_twice + y * y_twice > 0.9 * once * twice);
    }
}
