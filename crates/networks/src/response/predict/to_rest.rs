//! Motions that are followed until the vehicle has come to rest, as coherent draws.
//!
//! When and where a vehicle comes to rest is decided by the instant at which its speed reaches zero,
//! which is not normally distributed, even where the state is at every instant before. So it is not
//! taken from the propagated moments of the state, but from whole motions, each with latent factors of
//! its own that are drawn once.
//!
//! A motion may last longer than those that the network has learned from. From there on its remainder
//! fades within a second, and physics and effects with their strengths go on: these depend on the state,
//! not on time. What then decides is the resistance of a car that rolls on, which motions of a few
//! seconds say little about; rolling resistance and air drag are therefore drawn for that time.

use rand::RngExt;
use rayon::prelude::*;

use crate::response::predict::dynamics::{Dynamics, NetworkBatch};
use crate::response::predict::predictor::{drawn, normal};
use crate::response::{N_LATENTS, Predictor, STEP_S};
use impactlab_core::numerics::random_stream;
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

/// What is drawn once for a motion.
struct MotionDraw {
    component: usize,
    latents: [f64; N_LATENTS],
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

    /// Coherent draws, each followed to rest.
    ///
    /// - `inputs`: the input over each step, as many as the motion may take;
    /// - `draws`: numbers of the draws, which decide on what is drawn.
    pub fn settled(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
        draws: &[usize],
        search: &RestSearch,
    ) -> Vec<SettledMotion> {
        let fitted = self.fitted_to(initial, inputs);
        let dynamics = fitted.dynamics();
        // What a component weighs is known as far as the network is.
        let n_learned = ((fitted.network.learned_s() / STEP_S).ceil() as usize).min(inputs.len());
        let paths = self.paths(initial, inputs.get(..n_learned).unwrap_or(inputs));
        let weights: Vec<f64> = paths.iter().map(|path| path.weight).collect();
        let draw = |&idx: &usize| {
            let mut rng = random_stream(search.seed, "motions to rest", idx as u64);
            let component = drawn(&weights, rng.random());
            let shares = fitted.latents.component_shares(component, weights.len());
            let width = fitted.latents.width(rng.random());
            let latents = std::array::from_fn(|m| {
                width * (shares[m].mean + shares[m].variance.sqrt() * normal(&mut rng))
            });
            let [rolling, air] =
                search.resistance_scatter.map(|scatter| (scatter * normal(&mut rng)).exp());
            let resisted = with_resistance(&fitted.vehicle, [rolling, air]);
            let beyond = Dynamics::new(&resisted, &fitted.network, &fitted.latents);
            let draw = MotionDraw { component, latents };
            follow([&dynamics, &beyond], &draw, initial, inputs, || width * normal(&mut rng))
        };
        draws.par_iter().map(draw).collect()
    }

    /// The path of each component with every latent factor at zero, followed to rest, with its
    /// probability.
    pub fn settled_paths(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> Vec<SettledMotion> {
        let fitted = self.fitted_to(initial, inputs);
        let dynamics = fitted.dynamics();
        let path = |component| {
            let draw = MotionDraw { component, latents: [0.0; N_LATENTS] };
            follow([&dynamics; 2], &draw, initial, inputs, || 0.0)
        };
        (0..self.n_components()).map(path).collect()
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

/// Follows one motion.
///
/// - `dynamics`: as long as the network has learned from motions, and after that;
/// - `normal`: draws of the noise, in standard deviations.
fn follow(
    dynamics: [&Dynamics<'_>; 2],
    draw: &MotionDraw,
    initial: &VehicleState<f64>,
    inputs: &[VehicleInput<f64>],
    mut normal: impl FnMut() -> f64,
) -> SettledMotion {
    let changes = |pair: &[VehicleInput<f64>]| pair[0] != pair[1];
    let last_change = inputs.windows(2).rposition(changes).map_or(0, |before| before + 1);
    let [within, _] = dynamics;
    let mut watch = RestWatch::after(last_change as f64 * STEP_S).of(within.vehicle);
    let mut batch = NetworkBatch::default();
    let (mut state, mut states) = (*initial, vec![*initial]);
    for (i, u) in inputs.iter().enumerate() {
        let time_s = i as f64 * STEP_S;
        if watch.has_settled(time_s, &state) {
            break;
        }
        let dynamics = dynamics[usize::from(time_s >= within.network.learned_s())];
        state = dynamics.step(draw.component, &draw.latents, &state, u, time_s, &mut batch);
        let [vx, vy, yaw, roll] = dynamics.noise(draw.component, &batch).map(|std| std * normal());
        state.vx_body_m_s += vx;
        state.vy_body_m_s += vy;
        state.yaw_rate_rad_s += yaw;
        state.roll_rate_rad_s += roll;
        states.push(state);
    }
    let end_s = (states.len() - 1) as f64 * STEP_S;
    let rest = watch.since_s(end_s).map(|since_s| (since_s / STEP_S).round() as usize);
    SettledMotion { states, rest }
}
