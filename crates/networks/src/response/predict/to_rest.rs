//! Motions that are followed until the vehicle has come to rest, as coherent draws.
//!
//! When and where a vehicle comes to rest is decided by the instant at which its speed reaches zero. It is
//! told of whole motions, each with latent factors of its own that are drawn once.
//!
//! A motion may last longer than those that the network has learned from. From there on its remainder
//! fades within a second, and physics and effects with their strengths go on: these depend on the state,
//! not on time. To a car that nothing drives the effects give back half of what tires and resistance take
//! at most, so that they do not keep up its motion. What then decides is the resistance of a car that rolls
//! on, which motions of a few seconds say little about; rolling resistance and air drag are therefore drawn
//! for that time. As long as the network has a say, motions are followed side by side.

use rand::RngExt;
use rayon::prelude::*;

use crate::response::predict::abreast::{FollowedMotion, MotionDraw};
use crate::response::predict::dynamics::{Dynamics, NetworkBatch};
use crate::response::predict::predictor::central_of;
use crate::response::{N_LATENTS, Predictor, STEP_S};
use impactlab_core::numerics::{MAX_LANES, index_of_share, random_stream};
use impactlab_core::vehicle::{RestWatch, VehicleInput, VehicleParameters, VehicleState};

/// Standard deviations of the logarithms of rolling resistance and air drag of a car on the road, of
/// which nothing more is known: those of the rules for data sheets.
pub const RESISTANCE_SCATTER: [f64; 2] = [0.15, 0.15];

/// A motion that was followed to rest.
#[derive(Debug, Clone, PartialEq)]
pub struct SettledMotion {
    /// States every [`STEP_S`], until the vehicle has been at rest for
    /// [`REST_DURATION_S`](impactlab_core::vehicle::REST_DURATION_S), or to the end of the inputs.
    pub states: Vec<VehicleState<f64>>,
    /// Index of the state since which the vehicle is at rest; `None` if it still moves at the end.
    pub rest: Option<usize>,
}

/// How motions are followed to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RestSearch {
    /// Seed of the draws.
    pub seed: u64,
    /// Standard deviations of the logarithms of rolling resistance and air drag, from where on motions
    /// last longer than those that the network has learned from.
    pub resistance_scatter: [f64; 2],
}

/// Motions of a vehicle that were followed to rest.
#[derive(Debug, Clone, PartialEq)]
pub struct SettledMotions {
    /// The path with every latent factor at zero: [`Predictor::central_path`] as long as it is not at rest,
    /// within the time that was learned from.
    pub central: Vec<VehicleState<f64>>,
    /// Coherent draws.
    pub draws: Vec<SettledMotion>,
}

/// Motions of the components of a network.
struct Components {
    /// The path with every latent factor at zero, followed to rest.
    central: Vec<VehicleState<f64>>,
    /// Probabilities of the components.
    weights: Vec<f64>,
    /// What was followed beside them, as far as the network has learned.
    beside: Vec<(FollowedMotion, RestWatch)>,
}

impl Predictor {
    /// How long the motions were that the model has learned from, s.
    pub fn learned_s(&self) -> f64 {
        self.network.learned_s()
    }

    /// Inputs of the steps that begin within the time that the model has learned from, and those after them.
    fn split_at_learned<'a>(
        &self,
        inputs: &'a [VehicleInput<f64>],
    ) -> (&'a [VehicleInput<f64>], &'a [VehicleInput<f64>]) {
        let is_learned = |i: &usize| (*i as f64 * STEP_S) < self.learned_s();
        inputs.split_at((0..inputs.len()).take_while(is_learned).count())
    }

    /// The predictor for motions that begin like this one: what was learned fades where they lie outside
    /// of what was learned from.
    #[must_use]
    pub fn fitted(&self, initial: &VehicleState<f64>, inputs: &[VehicleInput<f64>]) -> Self {
        self.fitted_to(initial, inputs).into_owned()
    }

    /// The path with every latent factor at zero and coherent draws, each followed to rest.
    ///
    /// - `inputs`: the input over each step, as many as the motion may take;
    /// - `draws`: numbers of the draws, which decide on what is drawn.
    pub fn settled(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
        draws: &[usize],
        search: &RestSearch,
    ) -> SettledMotions {
        let fitted = self.fitted_to(initial, inputs);
        let (learned, rest) = fitted.split_at_learned(inputs);
        let stream = |idx: usize| random_stream(search.seed, "motions to rest", idx as u64);
        let with_factors = |mut draw: MotionDraw| {
            let factors = search.resistance_scatter.map(|scatter| (scatter * draw.normal()).exp());
            (draw, factors)
        };
        let go_on =
            |((mut motion, mut watch), factors): ((FollowedMotion, RestWatch), [f64; 2])| {
                if !rest.is_empty() {
                    let resisted = with_resistance(&fitted.vehicle, factors);
                    let beyond = Dynamics::new(&resisted, &fitted.network, &fitted.latents);
                    follow_on(&beyond, &mut motion, &mut watch, inputs, learned.len());
                }
                settled(motion, &watch)
            };
        // By itself a single draw would take as long as all components, one lane of the vector registers and
        // the others empty. So it goes beside them, once in each component, of which one is chosen then.
        if let [idx] = draws {
            let mut rng = stream(*idx);
            let share: f64 = rng.random();
            let in_component = |j: usize| with_factors(fitted.drawn_in(j, rng.clone()));
            let (beside, factors): (Vec<MotionDraw>, Vec<[f64; 2]>) =
                (0..fitted.n_components()).map(in_component).unzip();
            let Components { central, weights, beside } =
                self.settled_components(&fitted, initial, inputs, beside);
            let component = index_of_share(weights, share);
            let chosen = beside.into_iter().zip(factors).nth(component);
            return SettledMotions { central, draws: chosen.map(&go_on).into_iter().collect() };
        }
        let Components { central, weights, .. } =
            self.settled_components(&fitted, initial, inputs, Vec::new());
        let dynamics = fitted.dynamics();
        let settle = |numbers: &[usize]| {
            let draw = |&idx: &usize| with_factors(fitted.drawn_motion(&weights, stream(idx)));
            let (draws, factors): (Vec<MotionDraw>, Vec<[f64; 2]>) =
                numbers.iter().map(draw).unzip();
            let mut watches: Vec<RestWatch> =
                draws.iter().map(|_| watch(&fitted.vehicle, inputs)).collect();
            let motions = dynamics.follow(draws, initial, learned, |idx, time_s, state| {
                !watches.get_mut(idx).is_some_and(|watch| watch.has_settled(time_s, state))
            });
            motions.into_iter().zip(watches).zip(factors).map(&go_on).collect::<Vec<_>>()
        };
        SettledMotions {
            central,
            draws: draws.par_chunks(MAX_LANES).flat_map_iter(settle).collect(),
        }
    }

    /// The path with every latent factor at zero, followed to rest, and the probabilities of the
    /// components: of motions with their mean factors, over all steps, at rest or not.
    ///
    /// - `fitted`: this predictor for motions under these inputs;
    /// - `beside`: motions that are followed in the same registers.
    fn settled_components(
        &self,
        fitted: &Self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
        beside: Vec<MotionDraw>,
    ) -> Components {
        // What a component weighs is known as far as the network is.
        let (learned, rest) = fitted.split_at_learned(inputs);
        let (n, dynamics) = (fitted.n_components(), fitted.dynamics());
        // Where the mean factors are zero, one motion is both.
        let is_both: Vec<bool> =
            (0..n).map(|j| rest.is_empty() && fitted.mean_latents(j) == [0.0; N_LATENTS]).collect();
        let mut draws: Vec<MotionDraw> =
            (0..n).map(|j| MotionDraw::certain(j, [0.0; N_LATENTS])).collect();
        draws.extend(beside);
        let mut watches: Vec<RestWatch> =
            draws.iter().map(|_| watch(&fitted.vehicle, inputs)).collect();
        for (j, _) in is_both.iter().enumerate().filter(|(_, both)| rest.is_empty() && !**both) {
            draws.push(MotionDraw::certain(j, fitted.mean_latents(j)));
        }
        let mut motions = dynamics.follow(draws, initial, learned, |idx, time_s, state| {
            let watch = watches.get_mut(idx).filter(|_| is_both.get(idx) != Some(&true));
            !watch.is_some_and(|watch| watch.has_settled(time_s, state))
        });
        let mut at_means = motions.split_off(watches.len()).into_iter();
        let beside = motions.split_off(n).into_iter().zip(watches.split_off(n)).collect();
        let weights = match rest.is_empty() {
            true => {
                let own = motions.iter().zip(&is_both);
                let weighed = own.filter_map(|(motion, both)| match both {
                    true => Some(motion.weight),
                    false => at_means.next().map(|motion| motion.weight),
                });
                let weights: Vec<f64> = weighed.collect();
                let sum: f64 = weights.iter().sum();
                weights.into_iter().map(|weight| weight / sum).collect()
            }
            false => self.paths(initial, learned).iter().map(|path| path.weight).collect(),
        };
        for ((motion, watch), both) in motions.iter_mut().zip(&mut watches).zip(is_both) {
            if both {
                end_at_rest(motion, watch);
            }
            follow_on(&dynamics, motion, watch, inputs, learned.len());
        }
        Components { central: central_of(&motions), weights, beside }
    }
}

/// The vehicle with factors on rolling resistance and air drag.
pub(crate) fn with_resistance(
    vehicle: &VehicleParameters,
    [rolling, air]: [f64; 2],
) -> VehicleParameters {
    let mut resisted = vehicle.clone();
    let tires = &mut resisted.tires;
    tires.rolling_resistance *= rolling;
    tires.rolling_resistance_s_m *= rolling;
    tires.rolling_resistance_s2_m2 *= air;
    resisted
}

/// Looks for rest once nothing changes from outside any more.
fn watch(vehicle: &VehicleParameters, inputs: &[VehicleInput<f64>]) -> RestWatch {
    let changes = |pair: &[VehicleInput<f64>]| pair[0] != pair[1];
    let last_change = inputs.windows(2).rposition(changes).map_or(0, |before| before + 1);
    RestWatch::after(last_change as f64 * STEP_S).of(vehicle)
}

/// Ends a motion that was followed to the end of its inputs where its vehicle has come to rest.
fn end_at_rest(motion: &mut FollowedMotion, watch: &mut RestWatch) {
    let FollowedMotion { states, probabilities, .. } = motion;
    let n_steps = states.len().saturating_sub(1);
    let mut instants = states.iter().take(n_steps).enumerate();
    let at_rest = instants.position(|(i, state)| watch.has_settled(i as f64 * STEP_S, state));
    if let Some(step) = at_rest {
        states.truncate(step + 1);
        probabilities.truncate(step);
    }
}

/// Follows a motion further, if it was not over before.
///
/// - `n_done`: inputs under which it was followed.
fn follow_on(
    dynamics: &Dynamics<'_>,
    motion: &mut FollowedMotion,
    watch: &mut RestWatch,
    inputs: &[VehicleInput<f64>],
    n_done: usize,
) {
    let FollowedMotion { draw, states, .. } = motion;
    if states.len() <= n_done {
        return;
    }
    let mut batch = NetworkBatch::default();
    for (i, u) in inputs.iter().enumerate().skip(n_done) {
        let time_s = i as f64 * STEP_S;
        let Some(state) = states.last().filter(|state| !watch.has_settled(time_s, state)) else {
            break;
        };
        let (component, latents) = (draw.component, &draw.latents);
        let mut next = dynamics.step_beyond(component, latents, state, u, time_s, &mut batch);
        draw.add_noise(&mut next, dynamics.noise([0, draw.component], &batch));
        states.push(next);
    }
}

/// A motion that was followed to rest, or to the end of its inputs.
fn settled(motion: FollowedMotion, watch: &RestWatch) -> SettledMotion {
    let states = motion.states;
    let end_s = (states.len() - 1) as f64 * STEP_S;
    let rest = watch.since_s(end_s).map(|since_s| (since_s / STEP_S).round() as usize);
    SettledMotion { states, rest }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::predict::test_motions::{driving, predictor, released};
    use crate::shipped::ModelSource;
    use impactlab_core::vehicle::{Preset, RoadSlope};

    /// The motion followed by itself, with its vehicle after the time that was learned from.
    fn by_itself(
        predictor: &Predictor,
        mut draw: MotionDraw,
        search: &RestSearch,
        initial: VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> SettledMotion {
        let factors = search.resistance_scatter.map(|scatter| (scatter * draw.normal()).exp());
        let resisted = with_resistance(&predictor.vehicle, factors);
        let beyond = Dynamics::new(&resisted, &predictor.network, &predictor.latents);
        let within = predictor.dynamics();
        let (mut watch, mut batch) = (watch(&predictor.vehicle, inputs), NetworkBatch::default());
        let (mut state, mut states) = (initial, vec![initial]);
        let (component, latents) = (draw.component, draw.latents);
        for (i, u) in inputs.iter().enumerate() {
            let time_s = i as f64 * STEP_S;
            if watch.has_settled(time_s, &state) {
                break;
            }
            let is_learned = time_s < predictor.learned_s();
            let dynamics = if is_learned { &within } else { &beyond };
            state = match is_learned {
                true => dynamics.step(component, &latents, &state, u, time_s, &mut batch),
                false => dynamics.step_beyond(component, &latents, &state, u, time_s, &mut batch),
            };
            draw.add_noise(&mut state, dynamics.noise([0, component], &batch));
            states.push(state);
        }
        let rest = watch.since_s((states.len() - 1) as f64 * STEP_S);
        SettledMotion { states, rest: rest.map(|since_s| (since_s / STEP_S).round() as usize) }
    }

    #[test]
    fn motions_side_by_side_settle_as_each_does_by_itself() {
        let initial = VehicleState { yaw_rate_rad_s: 0.05, ..VehicleState::driving_straight(0.4) };
        let inputs = released(500);
        let search = RestSearch { seed: 7, resistance_scatter: RESISTANCE_SCATTER };
        let numbers: Vec<usize> = (0..MAX_LANES + 3).collect();
        for learned_s in [0.3, f64::INFINITY] {
            let mut predictor = predictor();
            predictor.network = predictor.network.clone().learned_for(learned_s);
            let n_learned = if learned_s.is_finite() { 30 } else { inputs.len() };
            let paths = predictor.paths(&initial, &inputs[..n_learned]);
            let weights: Vec<f64> = paths.iter().map(|path| path.weight).collect();
            let settled = predictor.settled(&initial, &inputs, &numbers, &search);
            assert_eq!(settled.draws.len(), numbers.len());
            for (idx, motion) in settled.draws.iter().enumerate() {
                let rng = random_stream(search.seed, "motions to rest", idx as u64);
                let draw = predictor.drawn_motion(&weights, rng);
                let expected = by_itself(&predictor, draw, &search, initial, &inputs);
                assert_eq!(*motion, expected, "{learned_s} s, draw {idx}");
            }
            let single = predictor.settled(&initial, &inputs, &numbers[3..4], &search);
            assert_eq!(single.draws, settled.draws[3..4], "{learned_s} s, a single draw");
            assert_eq!(single.central, settled.central, "{learned_s} s, a single draw");
        }
    }

    #[test]
    fn a_step_that_begins_as_the_learned_time_ends_is_not_learned() {
        let mut predictor = predictor();
        let inputs = released(20);
        // 0.07 / 0.01 is more than 7.
        for (learned_s, n_learned) in [(0.07, 7), (0.075, 8), (0.0, 0), (f64::INFINITY, 20)] {
            predictor.network = predictor.network.clone().learned_for(learned_s);
            let (learned, rest) = predictor.split_at_learned(&inputs);
            assert_eq!((learned.len(), rest.len()), (n_learned, 20 - n_learned), "{learned_s}");
        }
    }

    #[test]
    fn the_central_path_does_not_depend_on_how_long_motions_are_followed() {
        let initial = driving(1.5);
        let search = RestSearch { seed: 7, resistance_scatter: RESISTANCE_SCATTER };
        for learned_s in [0.5, f64::INFINITY] {
            let mut predictor = predictor();
            predictor.network = predictor.network.clone().learned_for(learned_s);
            let central =
                |n: usize| predictor.settled(&initial, &released(n), &[0], &search).central;
            let [timed, to_rest] = [150, 1200].map(central);
            assert!(timed.len() == 151 && to_rest.len() > 151, "{}", to_rest.len());
            assert_eq!(timed, to_rest[..151], "{learned_s} s");
            // What was learned does not go on as the driving of a car that nothing drives.
            let n_learned = if learned_s.is_finite() { 50 } else { 150 };
            let path = predictor.central_path(&initial, &released(n_learned));
            assert_eq!(timed[..=n_learned], path, "{learned_s} s");
        }
    }

    /// A tenth of the draws of a car that rolls at 1 m/s rolled on for ever: strengths are drawn that leave
    /// no resistance.
    #[test]
    fn a_car_that_nothing_drives_does_not_roll_for_ever() {
        let model = ModelSource::Shipped.response_model().unwrap();
        let predictor = model.predictor(&Preset::Reference.parameters()).unwrap();
        let search = RestSearch { seed: 1, resistance_scatter: RESISTANCE_SCATTER };
        let numbers: Vec<usize> = (0..60).collect();
        let initial = VehicleState::driving_straight(1.0);
        let settled = predictor.settled(&initial, &released(10_000), &numbers, &search);
        let n_moving = settled.draws.iter().filter(|motion| motion.rest.is_none()).count();
        assert_eq!(n_moving, 0, "of {}", settled.draws.len());
    }

    #[test]
    fn a_car_that_rolls_uphill_turns_round() {
        let mut vehicle = Preset::Reference.parameters();
        vehicle.slope = RoadSlope { grade: 0.05, cross_slope: 0.0 };
        let model = ModelSource::Shipped.response_model().unwrap();
        let mut predictor = model.predictor(&vehicle).unwrap();
        predictor.network = predictor.network.clone().learned_for(0.0);
        let search = RestSearch { seed: 1, resistance_scatter: RESISTANCE_SCATTER };
        let initial = VehicleState::driving_straight(6e-3);
        let settled = predictor.settled(&initial, &released(200), &[0], &search);
        let end = settled.central.last().unwrap();
        assert!(end.vx_body_m_s < -0.1, "{end:?}");
    }

    #[test]
    fn a_likelier_component_has_more_of_the_central_path() {
        let motion = |component: usize, y_m: f64, probability: f64| {
            let draw = MotionDraw::certain(component, [0.0; N_LATENTS]);
            let state = VehicleState { y_m, ..VehicleState::default() };
            FollowedMotion::of_states(draw, vec![state; 4], vec![probability; 2])
        };
        let central = central_of(&[motion(0, 0.0, 0.2), motion(1, 1.0, 0.6)]);
        let y_m: Vec<f64> = central.iter().map(|state| state.y_m).collect();
        assert_eq!(y_m.len(), 4);
        assert!((y_m[0] - 0.5).abs() < 1e-12, "{y_m:?}");
        assert!(y_m[1..].iter().all(|y_m| (y_m - 0.75).abs() < 1e-12), "{y_m:?}");
    }
}
