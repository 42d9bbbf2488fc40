//! Motions that are followed until the vehicle has come to rest, as coherent draws.
//!
//! When and where a vehicle comes to rest is decided by the instant at which its speed reaches zero. It is
//! told of whole motions, each with latent factors of its own that are drawn once.
//!
//! A motion may last longer than those that the network has learned from. From there on its remainder
//! fades within a second, and physics and effects with their strengths go on: these depend on the state,
//! not on time. What then decides is the resistance of a car that rolls on, which motions of a few
//! seconds say little about; rolling resistance and air drag are therefore drawn for that time. As long as
//! the network has a say, motions are followed side by side.

use rayon::prelude::*;

use crate::response::predict::abreast::{FollowedMotion, MotionDraw};
use crate::response::predict::dynamics::{Dynamics, NetworkBatch};
use crate::response::predict::predictor::weighted;
use crate::response::{N_LATENTS, Predictor, STEP_S};
use impactlab_core::numerics::{MAX_LANES, random_stream};
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
    /// That of each component with every latent factor at zero.
    pub paths: Vec<SettledMotion>,
    /// Coherent draws.
    pub draws: Vec<SettledMotion>,
}

impl Predictor {
    /// How long the motions were that the model has learned from, s.
    pub fn learned_s(&self) -> f64 {
        self.network.learned_s()
    }

    /// The predictor for motions that begin like this one: what was learned fades where they lie outside
    /// of what was learned from.
    #[must_use]
    pub fn fitted(&self, initial: &VehicleState<f64>, inputs: &[VehicleInput<f64>]) -> Self {
        self.fitted_to(initial, inputs).into_owned()
    }

    /// The motions of the components and coherent draws, each followed to rest.
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
        let dynamics = fitted.dynamics();
        let (paths, weights) = self.settled_components(&fitted, initial, inputs);
        let learned_s = fitted.network.learned_s();
        let is_learned = |i: &usize| (*i as f64 * STEP_S) < learned_s;
        let (learned, rest) = inputs.split_at((0..inputs.len()).take_while(is_learned).count());
        let draw = |&idx: &usize| {
            let rng = random_stream(search.seed, "motions to rest", idx as u64);
            let mut draw = fitted.drawn_motion(&weights, rng);
            let factors = search.resistance_scatter.map(|scatter| (scatter * draw.normal()).exp());
            (draw, factors)
        };
        let settle = |numbers: &[usize]| {
            let (draws, factors): (Vec<MotionDraw>, Vec<[f64; 2]>) =
                numbers.iter().map(&draw).unzip();
            let mut watches: Vec<RestWatch> =
                draws.iter().map(|_| watch(&fitted.vehicle, inputs)).collect();
            let motions = settling(&dynamics, draws, &mut watches, initial, learned);
            let go_on = |((mut motion, mut watch), factors): ((FollowedMotion, RestWatch), _)| {
                if !rest.is_empty() && motion.states.len() > learned.len() {
                    let resisted = with_resistance(&fitted.vehicle, factors);
                    let beyond = Dynamics::new(&resisted, &fitted.network, &fitted.latents);
                    follow_on(&beyond, &mut motion, &mut watch, inputs, learned.len());
                }
                settled(motion, &watch)
            };
            motions.into_iter().zip(watches).zip(factors).map(go_on).collect::<Vec<_>>()
        };
        SettledMotions { paths, draws: draws.par_chunks(MAX_LANES).flat_map_iter(settle).collect() }
    }

    /// The motion of each component with every latent factor at zero, followed to rest, and the
    /// probabilities of the components.
    ///
    /// - `fitted`: this predictor for motions under these inputs.
    fn settled_components(
        &self,
        fitted: &Self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> (Vec<SettledMotion>, Vec<f64>) {
        // What a component weighs is known as far as the network is.
        let n_learned = ((fitted.network.learned_s() / STEP_S).ceil() as usize).min(inputs.len());
        let (learned, rest) = inputs.split_at(n_learned);
        let n = fitted.n_components();
        let mut draws: Vec<MotionDraw> =
            (0..n).map(|j| MotionDraw::certain(j, [0.0; N_LATENTS])).collect();
        if rest.is_empty() {
            draws.extend((0..n).map(|j| MotionDraw::certain(j, fitted.mean_latents(j))));
        }
        let mut watches: Vec<RestWatch> = (0..n).map(|_| watch(&fitted.vehicle, inputs)).collect();
        let mut motions = settling(&fitted.dynamics(), draws, &mut watches, initial, inputs);
        let at_means = motions.split_off(n);
        let paths = match rest.is_empty() {
            true => weighted(at_means),
            false => self.paths(initial, learned),
        };
        let weights = paths.iter().map(|path| path.weight).collect();
        let of_components = motions.into_iter().zip(&watches);
        (of_components.map(|(motion, watch)| settled(motion, watch)).collect(), weights)
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

/// Follows motions side by side.
///
/// - `watches`: of the first ones, which end where they have come to rest; the others are followed to the
///   end of the inputs.
fn settling(
    dynamics: &Dynamics<'_>,
    draws: Vec<MotionDraw>,
    watches: &mut [RestWatch],
    initial: &VehicleState<f64>,
    inputs: &[VehicleInput<f64>],
) -> Vec<FollowedMotion> {
    dynamics.follow(draws, initial, inputs, |idx, time_s, state| {
        !watches.get_mut(idx).is_some_and(|watch| watch.has_settled(time_s, state))
    })
}

/// Follows a motion further.
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
    let mut batch = NetworkBatch::default();
    for (i, u) in inputs.iter().enumerate().skip(n_done) {
        let time_s = i as f64 * STEP_S;
        let Some(state) = states.last().filter(|state| !watch.has_settled(time_s, state)) else {
            break;
        };
        let mut next = dynamics.step(draw.component, &draw.latents, state, u, time_s, &mut batch);
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
    use crate::response::predict::test_motions::{predictor, released};

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
        for (i, u) in inputs.iter().enumerate() {
            let time_s = i as f64 * STEP_S;
            if watch.has_settled(time_s, &state) {
                break;
            }
            let dynamics = if time_s < predictor.learned_s() { &within } else { &beyond };
            state = dynamics.step(draw.component, &draw.latents, &state, u, time_s, &mut batch);
            draw.add_noise(&mut state, dynamics.noise([0, draw.component], &batch));
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
            for (component, motion) in settled.paths.iter().enumerate() {
                let draw = MotionDraw::certain(component, [0.0; N_LATENTS]);
                let expected = by_itself(&predictor, draw, &search, initial, &inputs);
                assert_eq!(*motion, expected, "{learned_s} s, component {component}");
            }
        }
    }
}
