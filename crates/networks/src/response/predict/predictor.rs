//! A response network asked about one vehicle: paths, their distribution, and coherent draws.

use std::borrow::Cow;
use std::sync::Arc;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rayon::prelude::*;

use crate::response::network::vehicle_network::VehicleNetwork;
use crate::response::predict::Latents;
use crate::response::predict::abreast::{FollowedMotion, MotionDraw, StepNoise};
use crate::response::predict::dynamics::Dynamics;
use crate::response::{
    Applicability, CarStrengths, LatentScales, MotionDomain, N_EFFECTS, N_LATENTS,
    StrengthPopulation,
};
use impactlab_core::numerics::{MAX_LANES, index_of_share, random_stream};
use impactlab_core::vehicle::{N_STATE, VehicleInput, VehicleParameters, VehicleState};

/// A model for one vehicle.
#[derive(Debug, Clone)]
pub struct Predictor {
    pub(super) vehicle: VehicleParameters,
    pub(super) network: VehicleNetwork,
    pub(super) latents: Latents,
    source: Option<Arc<PredictorSource>>,
}

/// What a predictor is made from again where a motion lies outside of what was learned from.
#[derive(Debug)]
pub(super) struct PredictorSource {
    /// The network for the vehicle as it was trained.
    pub network: VehicleNetwork,
    /// What the model knows of the strengths.
    pub strengths: SourceStrengths,
    /// What was learned from.
    pub domain: MotionDomain,
    /// How far the model holds for the vehicle.
    pub of_vehicle: Applicability,
}

/// What a model knows of the strengths of its effects.
#[derive(Debug)]
pub(super) enum SourceStrengths {
    /// How they are distributed over cars, and those of this one.
    Population(Arc<StrengthPopulation>, CarStrengths),
    /// Those of the car that it was trained on.
    OneCar(LatentScales),
}

impl PredictorSource {
    /// Network and uncertainty at an applicability: what was learned fades to the bare physics.
    fn at(&self, applicability: &Applicability) -> (VehicleNetwork, Latents) {
        let (share, beyond) = (applicability.value, applicability.distance);
        let none = [0.0; N_EFFECTS];
        let (added, remainder, latents) = match &self.strengths {
            SourceStrengths::Population(population, own) => {
                (own.mean.as_slice(), own.remainder, population.latents(own, [share, beyond]))
            }
            SourceStrengths::OneCar(scales) => {
                (none.as_slice(), 1.0, scales.faded([share, beyond]).latents())
            }
        };
        (self.network.clone().with_remainder(remainder).adapted(added, share), latents)
    }
}

/// The motion that one component of the mixture predicts.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentPath {
    /// Mean probability of the component along the path.
    pub weight: f64,
    /// States every [`STEP_S`](crate::response::STEP_S).
    pub states: Vec<VehicleState<f64>>,
}

impl Predictor {
    pub(crate) fn new(
        vehicle: VehicleParameters,
        network: VehicleNetwork,
        latents: Latents,
    ) -> Self {
        Self { vehicle, network, latents, source: None }
    }

    /// A predictor whose learned part fades where a motion lies outside of what was learned from.
    pub(super) fn from_source(vehicle: VehicleParameters, source: PredictorSource) -> Self {
        let (network, latents) = source.at(&source.of_vehicle);
        Self { source: Some(Arc::new(source)), ..Self::new(vehicle, network, latents) }
    }

    /// How far the model holds for a motion of the vehicle.
    pub fn applicability(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> Applicability {
        self.source.as_ref().map_or_else(Applicability::whole, |source| {
            let of_motion = source.domain.motion_applicability(&self.vehicle, initial, inputs);
            source.of_vehicle.and(&of_motion)
        })
    }

    /// The predictor for a motion.
    pub(super) fn fitted_to(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> Cow<'_, Self> {
        let Some(source) = &self.source else { return Cow::Borrowed(self) };
        let applicability = self.applicability(initial, inputs);
        if applicability.distance <= source.of_vehicle.distance {
            return Cow::Borrowed(self);
        }
        let (network, latents) = source.at(&applicability);
        Cow::Owned(Self { network, latents, source: None, ..self.clone() })
    }

    /// The same predictor with another uncertainty.
    #[must_use]
    pub fn with_latents(mut self, latents: LatentScales) -> Self {
        self.latents = latents.latents();
        self.source = None;
        self
    }

    /// The vehicle.
    pub fn vehicle(&self) -> &VehicleParameters {
        &self.vehicle
    }

    /// Number J of components of the mixture.
    pub fn n_components(&self) -> usize {
        self.network.n_components()
    }

    pub(super) fn dynamics(&self) -> Dynamics<'_> {
        Dynamics::new(&self.vehicle, &self.network, &self.latents)
    }

    /// The path of each component with its latent factors at their means.
    ///
    /// - `inputs`: the input over each step.
    pub fn paths(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> Vec<ComponentPath> {
        let fitted = self.fitted_to(initial, inputs);
        weighted(fitted.components_at(initial, inputs, |j| fitted.mean_latents(j)))
    }

    /// Means of the latent factors of a component.
    pub(super) fn mean_latents(&self, component: usize) -> [f64; N_LATENTS] {
        let shares = self.latents.component_shares(component, self.n_components());
        shares.map(|share| share.mean)
    }

    /// The motion of each component at given latent factors.
    fn components_at(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
        latents: impl Fn(usize) -> [f64; N_LATENTS],
    ) -> Vec<FollowedMotion> {
        let draw = |j| MotionDraw::certain(j, latents(j));
        let draws = (0..self.n_components()).map(draw).collect();
        self.dynamics().follow(draws, initial, inputs, |_, _, _| true)
    }

    /// Mean over the components of the paths on which one latent factor is one and the others are zero.
    pub(crate) fn path_at(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
        latent: usize,
    ) -> Vec<VehicleState<f64>> {
        let latents = std::array::from_fn(|m| if m == latent { 1.0 } else { 0.0 });
        central_of(&self.components_at(initial, inputs, |_| latents))
    }

    /// The path with every latent factor at zero: the mean over the components.
    ///
    /// It stands for the prediction where one path is asked for. The mean of the distribution would be
    /// none of the possible motions where some of them spin and others do not, and it would depend on
    /// how uncertain the model is.
    pub fn central_path(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> Vec<VehicleState<f64>> {
        let fitted = self.fitted_to(initial, inputs);
        central_of(&fitted.components_at(initial, inputs, |_| [0.0; N_LATENTS]))
    }

    /// Coherent draws: a component, latent factors drawn once, and the noise of each step.
    ///
    /// - `n`: how many; `seed`: of the draws.
    pub fn sample(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
        n: usize,
        seed: u64,
    ) -> Vec<Vec<VehicleState<f64>>> {
        let fitted = self.fitted_to(initial, inputs);
        let dynamics = fitted.dynamics();
        let weights: Vec<f64> =
            self.paths(initial, inputs).iter().map(|path| path.weight).collect();
        let draw = |idx: usize| {
            let rng = random_stream(seed, "coherent motions", idx as u64);
            fitted.drawn_motion(&weights, rng)
        };
        let numbers: Vec<usize> = (0..n).collect();
        let follow = |numbers: &[usize]| {
            let draws = numbers.iter().copied().map(&draw).collect();
            let followed = dynamics.follow(draws, initial, inputs, |_, _, _| true);
            followed.into_iter().map(|motion| motion.states)
        };
        numbers.par_chunks(MAX_LANES).flat_map_iter(follow).collect()
    }

    /// A motion with noise, drawn.
    ///
    /// - `weights`: of the components;
    /// - `rng`: of the motion.
    pub(super) fn drawn_motion(&self, weights: &[f64], mut rng: ChaCha8Rng) -> MotionDraw {
        let component = index_of_share(weights.iter().copied(), rng.random());
        self.drawn_in(component, rng)
    }

    /// A motion of a component with noise, drawn.
    ///
    /// - `rng`: of the motion, after the component was drawn.
    pub(super) fn drawn_in(&self, component: usize, mut rng: ChaCha8Rng) -> MotionDraw {
        let shares = self.latents.component_shares(component, self.n_components());
        let width = self.latents.width(rng.random());
        let latents = std::array::from_fn(|m| {
            width * (shares[m].mean + shares[m].variance.sqrt() * normal(&mut rng))
        });
        MotionDraw { component, latents, noise: Some(StepNoise { rng, width }) }
    }
}

/// Motions of the components as paths, whose weights are scaled to sum to one.
fn weighted(followed: Vec<FollowedMotion>) -> Vec<ComponentPath> {
    let sum: f64 = followed.iter().map(|motion| motion.weight).sum();
    let path = |motion: FollowedMotion| ComponentPath {
        weight: motion.weight / sum,
        states: motion.states,
    };
    followed.into_iter().map(path).collect()
}

/// The mean over the components at each instant. A component weighs its mean probability up to then, so
/// that the path does not depend on how long it is followed; one that has ended stays there.
pub(super) fn central_of(components: &[FollowedMotion]) -> Vec<VehicleState<f64>> {
    let n_instants = components.iter().map(|motion| motion.states.len()).max().unwrap_or(0);
    let mut weights: Vec<f64> = vec![1.0; components.len()];
    let at = |instant: usize| {
        for (weight, motion) in weights.iter_mut().zip(components) {
            let step = instant.checked_sub(1);
            if let Some(probability) = step.and_then(|step| motion.probabilities.get(step)) {
                *weight += (probability - *weight) / instant as f64;
            }
        }
        let sum: f64 = weights.iter().sum();
        let states = components.iter().zip(&weights).filter_map(|(motion, weight)| {
            Some((weight / sum, motion.states.get(instant).or(motion.states.last())?))
        });
        weighted_mean(states)
    };
    (0..n_instants).map(at).collect()
}

pub(super) fn normal(rng: &mut ChaCha8Rng) -> f64 {
    rng.sample(StandardNormal)
}

/// `Σ w x`; the weights sum to one.
pub fn weighted_mean<'a>(
    states: impl Iterator<Item = (f64, &'a VehicleState<f64>)>,
) -> VehicleState<f64> {
    let mut sum = [0.0; N_STATE];
    for (weight, state) in states {
        for (sum, value) in sum.iter_mut().zip(state.to_array()) {
            *sum += weight * value;
        }
    }
    VehicleState::from_array(sum)
}
