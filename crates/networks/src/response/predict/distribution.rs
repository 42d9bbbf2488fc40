//! The distribution of a motion over whole motions that were drawn: those that end near each other make a
//! component, which is normally distributed at every instant.

use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;

use crate::response::weighted_mean;
use impactlab_core::uncertainty::{
    NormalMixture, NormalPart, PlanarMixture, PlanarPart, pose_groups, predictive_factor,
};
use impactlab_core::vehicle::VehicleState;

/// Smallest variance of a component of the state, as at the start, where every component is known.
const LEAST_VARIANCE: f64 = 1e-12;

/// Normal distribution of the state at an instant, of one component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateDistribution {
    /// Mean; the heading goes on beyond a turn.
    pub mean: VehicleState<f64>,
    /// Covariance of [X, Y, ψ, v_x, v_y, r], m, rad, m/s, rad/s.
    pub covariance: SMatrix<f64, 6, 6>,
}

/// Motions that end near each other.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentMotion {
    /// Probability.
    pub weight: f64,
    /// Every [`STEP_S`](crate::response::STEP_S).
    pub states: Vec<StateDistribution>,
}

/// The distribution of a motion: a mixture of normal distributions at every instant.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionDistribution {
    /// The components; their weights sum to one.
    pub components: Vec<ComponentMotion>,
}

impl MotionDistribution {
    /// The mixture of components, whose weights are scaled to sum to one.
    pub fn new(mut components: Vec<ComponentMotion>) -> Self {
        let sum: f64 = components.iter().map(|component| component.weight).sum();
        components.iter_mut().for_each(|component| component.weight /= sum);
        Self { components }
    }

    /// Drawn motions as a mixture: one component for those that end near each other.
    ///
    /// - `draws`: states of each every [`STEP_S`](crate::response::STEP_S); one that is shorter than the
    ///   others stays where it ends;
    /// - `ends`: X, Y, m, and heading, rad, by which they are near each other;
    /// - `n_instants`: of the distribution.
    pub fn from_draws(
        draws: &[&[VehicleState<f64>]],
        ends: &[[f64; 3]],
        n_instants: usize,
    ) -> Self {
        let component = |group: &Vec<usize>| {
            let members: Vec<&[VehicleState<f64>]> =
                group.iter().filter_map(|&idx| draws.get(idx).copied()).collect();
            ComponentMotion {
                weight: members.len() as f64,
                states: (0..n_instants).map(|instant| moments(&members, instant)).collect(),
            }
        };
        Self::new(pose_groups(ends).par_iter().map(component).collect())
    }

    /// Number of instants.
    pub fn n_instants(&self) -> usize {
        self.components.first().map_or(0, |component| component.states.len())
    }

    /// Mean at an instant.
    pub fn mean(&self, instant: usize) -> VehicleState<f64> {
        weighted_mean(self.parts(instant).map(|(weight, state)| (weight, &state.mean)))
    }

    /// Covariance of [X, Y, ψ, v_x, v_y, r] at an instant, within the components and between them.
    pub fn covariance(&self, instant: usize) -> SMatrix<f64, 6, 6> {
        let mean = SVector::from(self.mean(instant).planar());
        let part = |(weight, state): (f64, &StateDistribution)| {
            let off = SVector::from(state.mean.planar()) - mean;
            (state.covariance + off * off.transpose()) * weight
        };
        self.parts(instant).map(part).sum()
    }

    /// The distribution of X, Y, ψ, v_x, v_y or r at an instant; `None` where it is not finite.
    pub fn marginal(&self, instant: usize, axis: usize) -> Option<NormalMixture> {
        let part = |(weight, state): (f64, &StateDistribution)| {
            let std = state.covariance[(axis, axis)].max(LEAST_VARIANCE).sqrt();
            NormalPart { weight, mean: state.mean.planar()[axis], std }
        };
        NormalMixture::new(self.parts(instant).map(part).collect()).ok()
    }

    /// The distribution of the position at an instant.
    pub fn position(&self, instant: usize) -> PlanarMixture {
        let part = |(weight, state): (f64, &StateDistribution)| {
            let p = &state.covariance;
            PlanarPart {
                weight,
                mean: [state.mean.x_m, state.mean.y_m],
                covariance: [p[(0, 0)], p[(0, 1)], p[(1, 1)]],
            }
        };
        PlanarMixture::new(self.parts(instant).map(part).collect())
    }

    /// The distributions of the components at an instant, with their probabilities.
    fn parts(&self, instant: usize) -> impl Iterator<Item = (f64, &StateDistribution)> {
        self.components
            .iter()
            .filter_map(move |component| Some((component.weight, component.states.get(instant)?)))
    }
}

/// Mean and covariance of some motions at an instant.
fn moments(motions: &[&[VehicleState<f64>]], instant: usize) -> StateDistribution {
    let states = || motions.iter().filter_map(|motion| motion.get(instant).or(motion.last()));
    let weight = 1.0 / motions.len().max(1) as f64;
    let mean = weighted_mean(states().map(|state| (weight, state)));
    let centre = SVector::from(mean.planar());
    let squares = |state: &VehicleState<f64>| {
        let off = SVector::from(state.planar()) - centre;
        off * off.transpose()
    };
    let sum: SMatrix<f64, 6, 6> = states().map(squares).sum();
    let factor = predictive_factor(motions.len()) / (motions.len() as f64 - 1.0).max(1.0);
    StateDistribution { mean, covariance: sum * factor }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drawn_motion_that_is_over_stays_where_it_ends() {
        let at = |x_m: f64| VehicleState { x_m, ..VehicleState::default() };
        let draws = [vec![at(0.0), at(1.0)], vec![at(0.0), at(2.0), at(3.0)]];
        let draws: Vec<&[VehicleState<f64>]> = draws.iter().map(Vec::as_slice).collect();
        let motion = MotionDistribution::from_draws(&draws, &[[1.0, 0.0, 0.0], [3.0, 0.0, 0.0]], 3);
        assert_eq!(motion.components.len(), 1);
        let means = [0, 1, 2].map(|instant| motion.mean(instant).x_m);
        assert_eq!(means, [0.0, 1.5, 2.0]);
        let variance = 2.0 * predictive_factor(2);
        assert!((motion.covariance(2)[(0, 0)] - variance).abs() < 1e-12);
    }
}
