//! The forecast of a motion to rest: draws of whole motions over forces, vehicles and what the response
//! network leaves uncertain, each followed until the vehicle stands.
//!
//! The distribution over time is that of the draws: those that end near each other make a component,
//! with their mean and covariance at each instant. A vehicle that has come to rest stays there.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;

use crate::analysis::rest_outcome::{SHARE_AT_REST, poses};
use crate::analysis::{MonteCarloError, MotionEnd, MotionOutcome, RestOutcome, StruckVehicle};
use impactlab_core::data::ForceHistory;
use impactlab_core::uncertainty::pose_groups;
use impactlab_core::units::Estimate;
use impactlab_core::vehicle::VehicleState;
use impactlab_networks::response::{
    Applicability, ComponentMotion, MotionDistribution, Predictor, RESISTANCE_SCATTER, RestSearch,
    STEP_S, SettledMotion, StateDistribution, Widths, weighted_mean,
};

/// Draws of the motion: the end of a 90 % interval is then uncertain by 1.4 % of probability.
const N_DRAWS: usize = 240;

/// What a motion is forecast from.
pub(super) struct ToRest<'a> {
    pub(super) forces: &'a [ForceHistory],
    pub(super) predictors: &'a [Predictor],
    pub(super) struck: &'a StruckVehicle,
    /// Whether the vehicles of the predictors are drawn, with the resistance that they have.
    pub(super) has_drawn_vehicles: bool,
    pub(super) limit_s: f64,
    /// Whether the motion lasts to the limit also where the vehicle has come to rest before.
    pub(super) lasts_to_limit: bool,
    pub(super) seed: u64,
}

/// A motion that was forecast to rest.
pub(super) struct Settled {
    pub(super) distribution: MotionDistribution,
    /// The path with the latent factors at zero for each force and vehicle.
    pub(super) paths: Vec<Vec<VehicleState<f64>>>,
    pub(super) outcome: MotionOutcome,
    pub(super) rest: RestOutcome,
    pub(super) applicabilities: Vec<Applicability>,
}

/// The motions under one force and of one vehicle.
struct Part {
    path: Vec<VehicleState<f64>>,
    draws: Vec<SettledMotion>,
    applicability: Applicability,
}

impl ToRest<'_> {
    /// Follows all draws; `None` where a motion is not finite.
    pub(super) fn settle(&self) -> Option<Settled> {
        let n_parts = self.forces.len().max(self.predictors.len());
        let parts: Vec<Part> =
            (0..n_parts).into_par_iter().filter_map(|part| self.part(part, n_parts)).collect();
        let mut applicabilities = Vec::new();
        let (mut paths, mut draws) = (Vec::new(), Vec::new());
        for part in parts {
            applicabilities.push(part.applicability);
            paths.push(part.path);
            draws.extend(part.draws);
        }
        let lengths = draws.iter().map(|draw| draw.states.len()).chain(paths.iter().map(Vec::len));
        let n_instants = match self.lasts_to_limit {
            true => (self.limit_s / STEP_S).round() as usize + 1,
            false => lengths.max()?,
        };
        for path in &mut paths {
            let last = *path.last()?;
            path.resize(n_instants, last);
        }
        let start_rad = self.struck.initial.yaw_rad;
        let SettledDraws { distribution, outcome, rest } =
            SettledDraws::new(&draws, n_instants, self.limit_s, start_rad)?;
        Some(Settled { distribution, paths, outcome, rest, applicabilities })
    }

    fn part(&self, part: usize, n_parts: usize) -> Option<Part> {
        let force = self.forces.get(part % self.forces.len())?;
        let predictor = self.predictors.get(part % self.predictors.len())?;
        let inputs = self.struck.inputs(force, self.limit_s)?;
        let initial = &self.struck.initial;
        let search = RestSearch {
            seed: self.seed,
            resistance_scatter: match self.has_drawn_vehicles {
                true => [0.0; 2],
                false => RESISTANCE_SCATTER,
            },
        };
        let numbers: Vec<usize> = (part..N_DRAWS.max(n_parts)).step_by(n_parts).collect();
        Some(Part {
            path: mean_path(&predictor.settled_paths(initial, &inputs)),
            draws: predictor.settled(initial, &inputs, &numbers, &search),
            applicability: predictor.applicability(&self.struck.initial, &inputs),
        })
    }
}

/// What draws of a whole motion come to.
pub(super) struct SettledDraws {
    pub(super) distribution: MotionDistribution,
    pub(super) outcome: MotionOutcome,
    pub(super) rest: RestOutcome,
}

impl SettledDraws {
    /// `None` without draws, or where a motion is not finite.
    ///
    /// - `n_instants`: of the distribution;
    /// - `limit_s`: how long the motions were followed at the most;
    /// - `start_rad`: heading at the start.
    pub(super) fn new(
        draws: &[SettledMotion],
        n_instants: usize,
        limit_s: f64,
        start_rad: f64,
    ) -> Option<Self> {
        let ends: Option<Vec<MotionEnd>> = draws.iter().map(end_of).collect();
        let ends = ends?;
        let rest = RestOutcome::from_ends(&ends, limit_s)?;
        let outcome = outcome(&ends, &rest, n_instants, start_rad);
        Some(Self { distribution: distribution(draws, &ends, n_instants), outcome, rest })
    }
}

/// The state of a motion at an instant, at rest after its end.
fn state_at(motion: &SettledMotion, instant: usize) -> Option<&VehicleState<f64>> {
    motion.states.get(instant).or(motion.states.last())
}

/// Mean over the components, which come to rest at different times.
fn mean_path(components: &[SettledMotion]) -> Vec<VehicleState<f64>> {
    let n_instants = components.iter().map(|motion| motion.states.len()).max().unwrap_or(0);
    let weight = 1.0 / components.len().max(1) as f64;
    let at = |instant| {
        let states = components.iter().filter_map(|motion| state_at(motion, instant));
        weighted_mean(states.map(|state| (weight, state)))
    };
    (0..n_instants).map(at).collect()
}

/// Where a motion ends; `None` if it is not finite.
fn end_of(motion: &SettledMotion) -> Option<MotionEnd> {
    let at = motion.rest.unwrap_or(motion.states.len().checked_sub(1)?);
    let state = motion.states.get(at)?;
    let way = motion.states.get(..=at)?.windows(2);
    let distance_m =
        way.map(|pair| (pair[1].x_m - pair[0].x_m).hypot(pair[1].y_m - pair[0].y_m)).sum();
    let end = MotionEnd {
        is_at_rest: motion.rest.is_some(),
        time_s: at as f64 * STEP_S,
        distance_m,
        x_m: state.x_m,
        y_m: state.y_m,
        yaw_rad: state.yaw_rad,
        speed_m_s: state.vx_body_m_s.hypot(state.vy_body_m_s),
        yaw_rate_rad_s: state.yaw_rate_rad_s,
    };
    let is_finite = state.to_array().iter().all(|value| value.is_finite());
    (is_finite && end.distance_m.is_finite()).then_some(end)
}

/// The draws as a mixture: one component for those that end near each other.
fn distribution(
    draws: &[SettledMotion],
    ends: &[MotionEnd],
    n_instants: usize,
) -> MotionDistribution {
    let component = |group: &Vec<usize>| {
        let members: Vec<&SettledMotion> = group.iter().filter_map(|&idx| draws.get(idx)).collect();
        let at = |instant| moments(&members, instant);
        let weight = members.len() as f64;
        let states = (0..n_instants).map(at).collect();
        ComponentMotion { weight, states, tail_ratio: Widths::NORMAL.tail_ratio }
    };
    MotionDistribution::new(pose_groups(&poses(ends)).par_iter().map(component).collect())
}

/// Mean and covariance of some motions at an instant.
fn moments(motions: &[&SettledMotion], instant: usize) -> StateDistribution {
    let states = || motions.iter().filter_map(|motion| state_at(motion, instant));
    let weight = 1.0 / motions.len().max(1) as f64;
    let mean = weighted_mean(states().map(|state| (weight, state)));
    let centre = SVector::from(mean.planar());
    let squares = |state: &VehicleState<f64>| {
        let off = SVector::from(state.planar()) - centre;
        off * off.transpose()
    };
    let sum: SMatrix<f64, 6, 6> = states().map(squares).sum();
    let covariance = sum / (motions.len() as f64 - 1.0).max(1.0);
    StateDistribution { mean, covariance, by_share: SVector::zeros() }
}

/// The end of the forecast, over the draws.
fn outcome(
    ends: &[MotionEnd],
    rest: &RestOutcome,
    n_instants: usize,
    start_rad: f64,
) -> MotionOutcome {
    let turned: Vec<f64> = ends.iter().map(|end| end.yaw_rad - start_rad).collect();
    let share_of = |least_rad: f64| {
        turned.iter().filter(|rad| rad.abs() >= least_rad).count() as f64 / turned.len() as f64
    };
    let mean = |quantity: fn(&MotionEnd) -> f64| {
        ends.iter().map(quantity).sum::<f64>() / ends.len() as f64
    };
    MotionOutcome {
        time_s: n_instants.saturating_sub(1) as f64 * STEP_S,
        is_at_rest: rest.share_at_rest >= SHARE_AT_REST,
        x_m: rest.x_m.clone(),
        y_m: rest.y_m.clone(),
        p_quarter_turn: share_of(FRAC_PI_2),
        p_half_turn: share_of(PI),
        heading_change_rad: Estimate::from_draws(turned),
        speed_m_s: mean(|end| end.speed_m_s),
        yaw_rate_rad_s: mean(|end| end.yaw_rate_rad_s),
        region_90_m2: rest.region_90_m2,
        monte_carlo: MonteCarloError::from_ends(ends, rest.limit_s),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_yaw_rate_at_the_end_has_its_sign() {
        let end = |i: i32| MotionEnd {
            is_at_rest: false,
            time_s: 4.0,
            distance_m: f64::from(i),
            x_m: f64::from(i),
            y_m: 0.1 * f64::from(i),
            yaw_rad: -2.0,
            speed_m_s: 8.0,
            yaw_rate_rad_s: -0.001 * f64::from(i),
        };
        let ends: Vec<MotionEnd> = (1..=100).map(end).collect();
        let rest = RestOutcome::from_ends(&ends, 4.0).unwrap();
        let yaw_rate_rad_s = outcome(&ends, &rest, 101, 0.0).yaw_rate_rad_s;
        assert!((yaw_rate_rad_s + 0.0505).abs() < 1e-9, "{yaw_rate_rad_s}");
    }
}
