//! The forecast of a motion: draws of whole motions over forces, vehicles and what the response network
//! leaves uncertain, each followed until the vehicle stands or the time is over.
//!
//! The distribution over time is that of the draws. A vehicle that has come to rest stays there.

use rayon::prelude::*;

use crate::analysis::{MonteCarloError, MotionEnd, MotionOutcome, RestOutcome, StruckVehicle};
use impactlab_core::data::ForceHistory;
use impactlab_core::numerics::{is_half_turn, is_quarter_turn};
use impactlab_core::units::Estimate;
use impactlab_core::vehicle::VehicleState;
use impactlab_networks::response::{
    Applicability, LEAST_MOTIONS, MotionDistribution, Predictor, RESISTANCE_SCATTER, RestSearch,
    STEP_S, SettledMotion, SettledMotions,
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
        let counts = [self.forces.len(), self.predictors.len()];
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
        let start_rad = self.struck.initial.yaw_rad;
        let SettledDraws { distribution, outcome, rest } =
            SettledDraws::new(draws, counts, n_instants, self.limit_s, start_rad)?;
        let rest = Some(rest).filter(|_| !self.lasts_to_limit);
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
        let numbers: Vec<usize> = (part..LEAST_MOTIONS.max(n_parts)).step_by(n_parts).collect();
        let SettledMotions { central, draws } =
            predictor.settled(initial, &inputs, &numbers, &search);
        let applicability = predictor.applicability(initial, &inputs);
        Some(Part { path: central, draws, applicability })
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
    /// - `counts`: forces and vehicles, which take turns, see [`MonteCarloError::from_parts`];
    /// - `n_instants`: of the distribution;
    /// - `limit_s`: how long the motions were followed at the most;
    /// - `start_rad`: heading at the start.
    pub(super) fn new(
        draws: Vec<SettledMotion>,
        counts: [usize; 2],
        n_instants: usize,
        limit_s: f64,
        start_rad: f64,
    ) -> Option<Self> {
        let ends: Option<Vec<MotionEnd>> = draws.iter().map(end_of).collect();
        let ends = ends?;
        let rest = RestOutcome::from_ends(&ends, limit_s)?;
        let outcome = outcome(&ends, &rest, counts, n_instants, start_rad);
        let states = draws.into_iter().map(|draw| draw.states).collect();
        Some(Self { distribution: MotionDistribution::new(states, n_instants), outcome, rest })
    }
}

/// Where a motion ends; `None` if it is not finite.
fn end_of(motion: &SettledMotion) -> Option<MotionEnd> {
    let last = motion.states.len().checked_sub(1)?;
    let at = motion.rest.unwrap_or(last).min(last);
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

/// The end of the forecast, over the draws: where nearly all are at rest, its time is that of the last to end.
///
/// - `counts`: forces and vehicles, which take turns in the draws.
fn outcome(
    ends: &[MotionEnd],
    rest: &RestOutcome,
    counts: [usize; 2],
    n_instants: usize,
    start_rad: f64,
) -> MotionOutcome {
    let turned: Vec<f64> = ends.iter().map(|end| end.yaw_rad - start_rad).collect();
    let share_of = |counts: fn(f64) -> bool| {
        turned.iter().filter(|rad| counts(**rad)).count() as f64 / turned.len() as f64
    };
    let mean = |quantity: fn(&MotionEnd) -> f64| {
        ends.iter().map(quantity).sum::<f64>() / ends.len() as f64
    };
    let is_at_rest = rest.is_nearly_all_at_rest();
    MotionOutcome {
        // A draw that still moves ends with the forecast.
        time_s: match is_at_rest {
            true => ends.iter().map(|end| end.time_s).fold(0.0, f64::max),
            false => n_instants.saturating_sub(1) as f64 * STEP_S,
        },
        is_at_rest,
        x_m: rest.x_m.clone(),
        y_m: rest.y_m.clone(),
        p_quarter_turn: Some(share_of(is_quarter_turn)),
        p_half_turn: Some(share_of(is_half_turn)),
        heading_change_rad: Estimate::from_draws(turned),
        speed_m_s: mean(|end| end.speed_m_s),
        yaw_rate_rad_s: mean(|end| end.yaw_rate_rad_s),
        region_90_m2: rest.region_90_m2,
        monte_carlo: MonteCarloError::from_parts(ends, counts, rest.limit_s),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::{MotionForecast, MotionForecastSettings, forecast_forces};
    use impactlab_core::data::{ForceAxes, Sampling};
    use impactlab_core::vehicle::{ContactPoint, Controls, Preset, REST_DURATION_S};
    use impactlab_networks::shipped::ModelSource;

    /// A car that rolls out at 1 m/s, hardly struck.
    fn rolling(duration_s: f64, until_rest: bool) -> MotionForecast {
        let force = ForceHistory {
            axes: ForceAxes::World,
            sampling: Sampling::Instant,
            time_s: vec![0.0, 0.05, 0.1],
            fx_n: vec![0.0; 3],
            fy_n: vec![0.0, 1e3, 0.0],
            mz_n_m: None,
        };
        let struck = StruckVehicle {
            vehicle: Preset::Reference.parameters(),
            initial: VehicleState::driving_straight(1.0),
            contact: ContactPoint { x_body_m: 0.0, y_body_m: -0.8, height_m: 0.5 },
            controls: Controls::default(),
            friction_zones: Vec::new(),
        };
        let settings = MotionForecastSettings {
            n_curves: 1,
            n_vehicles: 0,
            duration_s,
            until_rest,
            road: None,
            seed: 1,
        };
        let model = ModelSource::Shipped.response_model().unwrap();
        forecast_forces(&[force], &model, &struck, &settings).unwrap()
    }

    #[test]
    fn a_timed_forecast_is_not_at_rest_while_a_quarter_of_its_draws_moves() {
        let to_rest = rolling(100.0, true);
        let rest = to_rest.rest.as_ref().unwrap();
        assert!(rest.share_at_rest > 0.95, "{rest:?}");
        // A quarter of the draws still moves then, and most do not.
        let [_, late_s] = rest.time_s.interval(0.5).unwrap();
        let duration_s = ((late_s + REST_DURATION_S) / STEP_S).round() * STEP_S;
        let timed = rolling(duration_s, false);
        assert!(!timed.outcome.is_at_rest, "{:?}", timed.outcome);
        assert!((timed.outcome.time_s - duration_s).abs() < 1e-9, "{:?}", timed.outcome);
        // Both move for two seconds, on the same path.
        for (one, other) in timed.central.iter().zip(&to_rest.central).take(200) {
            for (a, b) in one.to_array().into_iter().zip(other.to_array()) {
                assert!((a - b).abs() < 1e-9, "{one:?} {other:?}");
            }
        }
        assert!(timed.outcome.time_s > 2.0 && to_rest.outcome.time_s > late_s);
    }

    /// A motion along X with its heading at the end, which rests after 3 steps if it does.
    fn motion(end_m: f64, yaw_rad: f64, rest: Option<usize>) -> SettledMotion {
        let state = |i: usize| VehicleState {
            x_m: end_m * i.min(rest.unwrap_or(5)) as f64,
            yaw_rad: yaw_rad * i as f64 / 5.0,
            vx_body_m_s: if rest.is_some() { 0.0 } else { 8.0 },
            ..VehicleState::default()
        };
        SettledMotion { states: (0..6).map(state).collect(), rest }
    }

    #[test]
    fn a_motion_ends_where_it_comes_to_rest() {
        let end = |rest| end_of(&motion(1.0, 0.0, rest)).unwrap();
        let [rests, moves] = [Some(3), None].map(end);
        assert_eq!((rests.is_at_rest, rests.x_m, rests.distance_m), (true, 3.0, 3.0));
        assert_eq!((moves.is_at_rest, moves.x_m, moves.distance_m), (false, 5.0, 5.0));
        assert_eq!([rests, moves].map(|end| end.time_s), [3.0 * STEP_S, 5.0 * STEP_S]);
    }

    #[test]
    fn draws_that_move_on_after_the_others_rest_end_where_they_are_at_the_end_of_the_time() {
        let draw = |i: usize| match i % 5 {
            0 => motion(2.0, 3.0, None),
            _ => motion(1.0 + 0.01 * i as f64, 0.0, Some(3)),
        };
        let draws: Vec<SettledMotion> = (0..100).map(draw).collect();
        let outcome = SettledDraws::new(draws, [1, 1], 6, 0.05, 0.0).unwrap().outcome;
        assert_eq!((outcome.is_at_rest, outcome.time_s), (false, 5.0 * STEP_S));
        assert!((outcome.p_quarter_turn.unwrap() - 0.2).abs() < 1e-12, "{outcome:?}");
        assert!((outcome.speed_m_s - 1.6).abs() < 1e-12, "{outcome:?}");
        assert!(outcome.x_m.ninety()[1] > 9.9, "{outcome:?}");
    }

    #[test]
    fn a_forecast_is_at_rest_since_the_last_draw_is() {
        let draw = |i: usize| motion(1.0 + 0.01 * i as f64, 0.0, Some(if i == 7 { 4 } else { 3 }));
        let draws: Vec<SettledMotion> = (0..100).map(draw).collect();
        let outcome = SettledDraws::new(draws, [1, 1], 400, 4.0, 0.0).unwrap().outcome;
        assert_eq!((outcome.is_at_rest, outcome.time_s), (true, 4.0 * STEP_S));
    }

    /// Places of the end were those of one time, and the density was that of another.
    #[test]
    fn where_a_few_draws_still_move_the_end_is_that_of_the_forecast() {
        let draw = |i: usize| motion(1.0 + 0.01 * i as f64, 0.0, (i > 2).then_some(3));
        let draws: Vec<SettledMotion> = (0..100).map(draw).collect();
        let outcome = SettledDraws::new(draws, [1, 1], 6, 4.0, 0.0).unwrap().outcome;
        assert_eq!((outcome.is_at_rest, outcome.time_s), (true, 5.0 * STEP_S));
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
        let yaw_rate_rad_s = outcome(&ends, &rest, [1, 1], 101, 0.0).yaw_rate_rad_s;
        assert!((yaw_rate_rad_s + 0.0505).abs() < 1e-9, "{yaw_rate_rad_s}");
    }
}
