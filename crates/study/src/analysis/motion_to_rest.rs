//! The forecast of a motion: draws of whole motions over forces, vehicles and what the response network
//! leaves uncertain, each followed until the vehicle stands or the time is over.
//!
//! The distribution over time is that of the draws: those that end near each other make a component,
//! with their mean and covariance at each instant. A vehicle that has come to rest stays there.

use std::f64::consts::{FRAC_PI_2, PI};

use rayon::prelude::*;

use crate::analysis::rest_outcome::{SHARE_AT_REST, poses};
use crate::analysis::{MonteCarloError, MotionEnd, MotionOutcome, RestOutcome, StruckVehicle};
use impactlab_core::data::{ForceHistory, contact_interval};
use impactlab_core::units::Estimate;
use impactlab_core::vehicle::{Pace, VehicleState, rest_instant};
use impactlab_networks::response::{
    Applicability, LEAST_MOTIONS, MotionDistribution, Predictor, RESISTANCE_SCATTER, RestSearch,
    STEP_S, SettledMotion, SettledMotions, weighted_mean,
};

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

/// A motion that was forecast.
pub(super) struct Settled {
    pub(super) distribution: MotionDistribution,
    /// The path with the latent factors at zero for each force and vehicle.
    pub(super) paths: Vec<Vec<VehicleState<f64>>>,
    pub(super) outcome: MotionOutcome,
    /// Of a motion that is followed to rest.
    pub(super) rest: Option<RestOutcome>,
    pub(super) applicabilities: Vec<Applicability>,
}

/// The motions under one force and of one vehicle.
struct Part {
    path: Vec<VehicleState<f64>>,
    draws: Vec<SettledMotion>,
    applicability: Applicability,
}

impl ToRest<'_> {
    /// Forces or vehicles, whichever are more: the others are taken in turn.
    fn n_parts(&self) -> usize {
        self.forces.len().max(self.predictors.len())
    }

    /// Follows all draws; `None` where a motion is not finite.
    pub(super) fn settle(&self) -> Option<Settled> {
        let n_parts = self.n_parts();
        let parts: Option<Vec<Part>> =
            (0..n_parts).into_par_iter().map(|part| self.part(part, n_parts)).collect();
        let mut applicabilities = Vec::new();
        let (mut paths, mut draws) = (Vec::new(), Vec::new());
        for (part, of_part) in parts?.into_iter().enumerate() {
            applicabilities.push(of_part.applicability);
            paths.push(of_part.path);
            draws.extend((part..).step_by(n_parts).zip(of_part.draws));
        }
        draws.sort_by_key(|(number, _)| *number);
        let draws: Vec<SettledMotion> = draws.into_iter().map(|(_, draw)| draw).collect();
        let lengths = draws.iter().map(|draw| draw.states.len()).chain(paths.iter().map(Vec::len));
        let n_instants = match self.lasts_to_limit {
            true => (self.limit_s / STEP_S).round() as usize + 1,
            false => lengths.max()?,
        };
        for path in &mut paths {
            let last = *path.last()?;
            path.resize(n_instants, last);
        }
        let ends: Option<Vec<MotionEnd>> = draws.iter().map(end_of).collect();
        let ends = ends?;
        let (outcome, rest) = match self.lasts_to_limit {
            true => (self.timed_outcome(&draws, &paths)?, None),
            false => {
                let rest = RestOutcome::from_ends(&ends, self.limit_s)?;
                let start_rad = self.struck.initial.yaw_rad;
                (outcome(&ends, &rest, n_parts, n_instants, start_rad), Some(rest))
            }
        };
        let distribution = distribution(&draws, &ends, n_instants);
        Some(Settled { distribution, paths, outcome, rest, applicabilities })
    }

    /// The outcome at the end of the time, or where the vehicle has come to rest in the mean of the central
    /// paths.
    fn timed_outcome(
        &self,
        draws: &[SettledMotion],
        paths: &[Vec<VehicleState<f64>>],
    ) -> Option<MotionOutcome> {
        let pace = Pace::mean_of(paths);
        let force_end_s = self.forces.iter().filter_map(contact_interval).map(|(_, end_s)| end_s);
        let rest = rest_instant(&pace, STEP_S, force_end_s.fold(0.0, f64::max));
        let at = rest.unwrap_or(pace.len().checked_sub(1)?);
        let ends: Option<Vec<MotionEnd>> = draws.iter().map(|draw| end_at(draw, at)).collect();
        let ends = ends?;
        let place = RestOutcome::from_ends(&ends, self.limit_s)?;
        let weight = 1.0 / paths.len().max(1) as f64;
        let central = weighted_mean(paths.iter().filter_map(|path| Some((weight, path.get(at)?))));
        Some(MotionOutcome {
            is_at_rest: rest.is_some(),
            speed_m_s: pace.get(at)?.speed_m_s,
            yaw_rate_rad_s: central.yaw_rate_rad_s,
            ..outcome(&ends, &place, self.n_parts(), at + 1, self.struck.initial.yaw_rad)
        })
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
        let numbers: Vec<usize> = (part..LEAST_MOTIONS.max(n_parts)).step_by(n_parts).collect();
        let SettledMotions { paths, draws } =
            predictor.settled(initial, &inputs, &numbers, &search);
        let applicability = predictor.applicability(initial, &inputs);
        Some(Part { path: mean_path(&paths), draws, applicability })
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
        let outcome = outcome(&ends, &rest, ends.len(), n_instants, start_rad);
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
    end_at(motion, usize::MAX)
}

/// Where a motion is at an instant, or where it has ended before; `None` if that is not finite.
fn end_at(motion: &SettledMotion, instant: usize) -> Option<MotionEnd> {
    let last = motion.states.len().checked_sub(1)?;
    let at = instant.min(motion.rest.unwrap_or(last));
    let state = motion.states.get(at)?;
    let way = motion.states.get(..=at)?.windows(2);
    let distance_m =
        way.map(|pair| (pair[1].x_m - pair[0].x_m).hypot(pair[1].y_m - pair[0].y_m)).sum();
    let end = MotionEnd {
        is_at_rest: motion.rest.is_some_and(|rest| rest <= at),
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

/// The draws as a mixture.
fn distribution(
    draws: &[SettledMotion],
    ends: &[MotionEnd],
    n_instants: usize,
) -> MotionDistribution {
    let states: Vec<&[VehicleState<f64>]> =
        draws.iter().map(|draw| draw.states.as_slice()).collect();
    MotionDistribution::from_draws(&states, &poses(ends), n_instants)
}

/// The end of the forecast, over the draws.
///
/// - `n_parts`: forces and vehicles, which take turns in the draws.
fn outcome(
    ends: &[MotionEnd],
    rest: &RestOutcome,
    n_parts: usize,
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
        monte_carlo: MonteCarloError::from_parts(ends, n_parts, rest.limit_s),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_at_an_instant_is_at_rest_if_it_has_come_to_rest_by_then() {
        let state = |i: usize| VehicleState { x_m: i.min(3) as f64, ..VehicleState::default() };
        let motion = SettledMotion { states: (0..6).map(state).collect(), rest: Some(3) };
        let [before, after] = [2, 5].map(|at| end_at(&motion, at).unwrap());
        assert_eq!((before.is_at_rest, before.x_m, before.distance_m), (false, 2.0, 2.0));
        assert_eq!((after.is_at_rest, after.x_m, after.time_s), (true, 3.0, 3.0 * STEP_S));
        assert_eq!(end_of(&motion), Some(after));
        let moving = SettledMotion { rest: None, ..motion };
        assert_eq!(
            end_at(&moving, 9).map(|end| (end.is_at_rest, end.time_s)),
            Some((false, 5.0 * STEP_S))
        );
    }

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
        let yaw_rate_rad_s = outcome(&ends, &rest, ends.len(), 101, 0.0).yaw_rate_rad_s;
        assert!((yaw_rate_rad_s + 0.0505).abs() < 1e-9, "{yaw_rate_rad_s}");
    }
}
