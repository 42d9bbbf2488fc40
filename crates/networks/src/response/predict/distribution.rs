//! The distribution of a motion: whole motions that were drawn, each as likely as the others.
//!
//! Mean, covariance and values of a quantity are those of the draws. The position is distributed as that
//! of a further draw, by groups of draws that are near each other at the instant: those that end near each
//! other need not have been so on their way.

use nalgebra::{SMatrix, SVector};

use crate::response::weighted_mean;
use impactlab_core::uncertainty::PlanarMixture;
use impactlab_core::vehicle::VehicleState;

/// The distribution of a motion: draws of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MotionDistribution {
    draws: Vec<Vec<VehicleState<f64>>>,
    n_instants: usize,
}

impl MotionDistribution {
    /// - `draws`: states of each every [`STEP_S`](crate::response::STEP_S), at least one; a draw that is
    ///   shorter than the others stays where it ends;
    /// - `n_instants`: of the distribution.
    pub fn new(draws: Vec<Vec<VehicleState<f64>>>, n_instants: usize) -> Self {
        Self { draws, n_instants }
    }

    /// The draws, every [`STEP_S`](crate::response::STEP_S) until they are over. Forces and vehicles take
    /// turns in them, so that the first few are of different ones; every n-th may be of the same.
    pub fn draws(&self) -> &[Vec<VehicleState<f64>>] {
        &self.draws
    }

    /// Number of instants.
    pub fn n_instants(&self) -> usize {
        self.n_instants
    }

    /// State of each draw at an instant.
    pub fn states(&self, instant: usize) -> impl Iterator<Item = &VehicleState<f64>> {
        self.draws.iter().filter_map(move |states| states.get(instant).or(states.last()))
    }

    /// X, Y, ψ, v_x, v_y or r of each draw at an instant.
    pub fn values(&self, instant: usize, axis: usize) -> Vec<f64> {
        self.states(instant).map(|state| state.planar()[axis]).collect()
    }

    /// Mean at an instant.
    pub fn mean(&self, instant: usize) -> VehicleState<f64> {
        let weight = 1.0 / self.draws.len().max(1) as f64;
        weighted_mean(self.states(instant).map(|state| (weight, state)))
    }

    /// Covariance of [X, Y, ψ, v_x, v_y, r] at an instant, from the squares over the number of draws less
    /// one.
    pub fn covariance(&self, instant: usize) -> SMatrix<f64, 6, 6> {
        let mean = SVector::from(self.mean(instant).planar());
        let squares = |state: &VehicleState<f64>| {
            let off = SVector::from(state.planar()) - mean;
            off * off.transpose()
        };
        let sum: SMatrix<f64, 6, 6> = self.states(instant).map(squares).sum();
        sum / (self.draws.len() as f64 - 1.0).max(1.0)
    }

    /// The distribution of the position of a further draw at an instant.
    pub fn position(&self, instant: usize) -> PlanarMixture {
        let pose = |state: &VehicleState<f64>| [state.x_m, state.y_m, state.yaw_rad];
        PlanarMixture::from_poses(&self.states(instant).map(pose).collect::<Vec<_>>())
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;
    use rand_distr::StandardNormal;

    use super::*;
    use crate::response::LEAST_MOTIONS;
    use impactlab_core::numerics::random_stream;

    fn at(x_m: f64) -> VehicleState<f64> {
        VehicleState { x_m, ..VehicleState::default() }
    }

    #[test]
    fn a_drawn_motion_that_is_over_stays_where_it_ends() {
        let draws = vec![vec![at(0.0), at(1.0)], vec![at(0.0), at(2.0), at(3.0)]];
        let motion = MotionDistribution::new(draws, 3);
        assert_eq!([0, 1, 2].map(|instant| motion.mean(instant).x_m), [0.0, 1.5, 2.0]);
        assert_eq!(motion.values(2, 0), [1.0, 3.0]);
    }

    #[test]
    fn the_covariance_is_that_of_the_draws() {
        let draws = [1.0, 2.0, 6.0].map(|x_m| vec![at(x_m)]).to_vec();
        let covariance = MotionDistribution::new(draws, 1).covariance(0);
        assert!((covariance[(0, 0)] - 7.0).abs() < 1e-12, "{covariance}");
        assert!(covariance[(1, 1)].abs() < 1e-12, "{covariance}");
    }

    /// Motions of three instants, whose places half way have nothing to do with where they end: where `bends`,
    /// they lie along a bend then.
    fn made(stream: u64, n: usize, bends: bool) -> Vec<Vec<VehicleState<f64>>> {
        let mut rng = random_stream(5, "made motions", stream);
        let mut state = || {
            let [a, b, c] = [(); 3].map(|()| rng.sample::<f64, _>(StandardNormal));
            let bent = if bends { 0.4 * a * a } else { 0.0 };
            VehicleState {
                x_m: 5.0 * a,
                y_m: 0.4 * b - bent,
                yaw_rad: 0.3 * c,
                ..VehicleState::default()
            }
        };
        (0..n).map(|_| vec![VehicleState::default(), state(), state()]).collect()
    }

    #[test]
    fn regions_half_way_hold_as_many_other_draws_as_they_say_though_the_ends_do_not_explain_them() {
        for bends in [false, true] {
            let levels = (0..20).flat_map(|set| {
                let motion = MotionDistribution::new(made(set, LEAST_MOTIONS, bends), 3);
                let position = motion.position(1);
                let others = MotionDistribution::new(made(100 + set, 60, bends), 3);
                let places: Vec<[f64; 2]> =
                    others.states(1).map(|state| [state.x_m, state.y_m]).collect();
                places.into_iter().map(move |place| position.level_of(place))
            });
            let levels: Vec<f64> = levels.collect();
            let [half, most] = [0.5, 0.9].map(|level| {
                let n_inside = levels.iter().filter(|reached| **reached <= level).count();
                n_inside as f64 / levels.len() as f64
            });
            assert!((half - 0.5).abs() < 0.07, "{half} of a half, {bends}");
            assert!((most - 0.9).abs() < 0.04, "{most} of 0.9, {bends}");
        }
    }
}
