//! Whole paths drawn from a forecast, to be looked at.
//!
//! A draw is at the same place of the distribution at every instant: for a component with mean m and
//! covariance P of [X, Y, ψ],
//!
//! ```text
//! p_t = m_t + L_t z        L_t L_tᵀ = P_t        z normal, the same at all instants
//! ```
//!
//! so that the draws have the distribution of the forecast at each instant, and are as smooth as it is.
//! How the error of one instant goes with that of another is not known from it: the draws take it as the
//! same error that grows.

use crate::response::predict::predictor::normal;
use crate::response::{MotionDistribution, StateDistribution};
use impactlab_core::collision::Pose;
use impactlab_core::numerics::random_stream;

impl MotionDistribution {
    /// Draws whole paths. Components come in proportion to their weights.
    ///
    /// - `n_draws`: how many;
    /// - `seed`: of the draws;
    /// - returns positions and headings at intervals of [`STEP_S`](crate::response::STEP_S).
    pub fn draws(&self, n_draws: usize, seed: u64) -> Vec<Vec<Pose>> {
        let weights: Vec<f64> = self.components.iter().map(|component| component.weight).collect();
        let draw = |idx: usize| {
            let mut rng = random_stream(seed, "drawn paths", idx as u64);
            let component = super::predictor::drawn(&weights, (idx as f64 + 0.5) / n_draws as f64);
            let component = self.components.get(component)?;
            let z: [f64; 3] = std::array::from_fn(|_| normal(&mut rng));
            let pose = |instant: usize| {
                let StateDistribution { mean, covariance: p } = component.states.get(instant)?;
                let root = root([p[(0, 0)], p[(1, 0)], p[(1, 1)], p[(2, 0)], p[(2, 1)], p[(2, 2)]]);
                let off = |row: &[f64]| row.iter().zip(&z).map(|(l, z)| l * z).sum::<f64>();
                let [x, y, yaw] = [&root[0..1], &root[1..3], &root[3..6]].map(off);
                Some(Pose { x_m: mean.x_m + x, y_m: mean.y_m + y, yaw_rad: mean.yaw_rad + yaw })
            };
            (0..self.n_instants()).map(pose).collect::<Option<Vec<Pose>>>()
        };
        (0..n_draws).filter_map(draw).collect()
    }
}

/// Lower triangular root of a covariance of three numbers, both row by row; what has no variance left
/// has none in the root.
fn root([xx, yx, yy, zx, zy, zz]: [f64; 6]) -> [f64; 6] {
    let over = |value: f64, by: f64| if by > 0.0 { value / by } else { 0.0 };
    let a = xx.max(0.0).sqrt();
    let b = over(yx, a);
    let c = (yy - b * b).max(0.0).sqrt();
    let d = over(zx, a);
    let e = over(zy - b * d, c);
    [a, b, c, d, e, (zz - d * d - e * e).max(0.0).sqrt()]
}

#[cfg(test)]
mod tests {
    use nalgebra::SMatrix;

    use super::*;
    use crate::response::ComponentMotion;
    use impactlab_core::vehicle::VehicleState;

    #[test]
    fn draws_have_the_moments_of_the_forecast_at_every_instant() {
        let state = |t: f64| {
            let mut covariance = SMatrix::<f64, 6, 6>::identity() * 1e-6;
            let [sx, sy, syaw] = [0.5 * t, 0.2 * t, 0.1 * t];
            covariance[(0, 0)] = sx * sx;
            covariance[(1, 1)] = sy * sy;
            covariance[(2, 2)] = syaw * syaw;
            covariance[(1, 0)] = 0.6 * sx * sy;
            covariance[(0, 1)] = 0.6 * sx * sy;
            covariance[(2, 1)] = -0.5 * sy * syaw;
            covariance[(1, 2)] = -0.5 * sy * syaw;
            let mean =
                VehicleState { x_m: 10.0 * t, y_m: t, yaw_rad: 0.3 * t, ..VehicleState::default() };
            StateDistribution { mean, covariance }
        };
        let states = vec![state(0.0), state(1.0), state(2.0)];
        let forecast = MotionDistribution::new(vec![ComponentMotion { weight: 1.0, states }]);
        let draws = forecast.draws(4000, 7);
        assert_eq!((draws.len(), draws[0].len()), (4000, 3));
        let mean = |coordinate: &dyn Fn(&Pose) -> f64| {
            draws.iter().map(|path| coordinate(&path[2])).sum::<f64>() / 4000.0
        };
        let x = mean(&|pose| pose.x_m);
        // Four standard errors.
        assert!((x - 20.0).abs() < 4.0 / 4000_f64.sqrt(), "{x}");
        let xx = mean(&|pose| (pose.x_m - 20.0).powi(2));
        let xy = mean(&|pose| (pose.x_m - 20.0) * (pose.y_m - 2.0));
        let zy = mean(&|pose| (pose.yaw_rad - 0.6) * (pose.y_m - 2.0));
        assert!((xx - 1.0).abs() < 0.1 && (xy - 0.24).abs() < 0.04, "{xx}, {xy}");
        assert!((zy + 0.04).abs() < 0.008, "{zy}");
        assert_eq!(draws[5][0], Pose { x_m: 0.0, y_m: 0.0, yaw_rad: 0.0 });
        assert_eq!(draws[5], forecast.draws(4000, 7)[5]);
    }
}
