//! A response network asked about one vehicle: paths, their distribution, and coherent draws.

use std::borrow::Cow;
use std::sync::Arc;

use nalgebra::{SMatrix, SVector};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rayon::prelude::*;

use crate::response::network::vehicle_network::VehicleNetwork;
use crate::response::predict::Latents;
use crate::response::predict::dynamics::{Dynamics, NetworkBatch};
use crate::response::predict::joint_state::N_JOINT;
use crate::response::predict::propagate::PlanarState;
use crate::response::{
    Applicability, CarStrengths, ComponentMotion, LatentScales, MotionDomain, N_EFFECTS, N_LATENTS,
    N_RESIDUAL, STEP_S, StrengthPopulation,
};
use impactlab_core::numerics::random_stream;
use impactlab_core::uncertainty::{
    NormalMixture, NormalPart, PlanarMixture, PlanarPart, Unscented,
};
use impactlab_core::vehicle::{N_STATE, VehicleInput, VehicleParameters, VehicleState};

/// Points two standard deviations from the mean, as in the paper's four dimensions with α = 1, and so
/// many dimensions as there are: κ = 4 − n. The centre then has no part in the covariance, which is
/// positive whatever the step does.
const POINTS: Unscented = Unscented { alpha: 1.0, beta: 2.0, kappa: 4.0 - N_JOINT as f64 };

/// Smallest variance of a component of the state, as at the start, where every component is known.
const LEAST_VARIANCE: f64 = 1e-12;

/// A model for one vehicle.
#[derive(Debug, Clone)]
pub struct Predictor {
    pub(super) vehicle: VehicleParameters,
    pub(super) network: VehicleNetwork,
    pub(super) latents: Latents,
    unscented: Unscented,
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
    /// States every [`STEP_S`].
    pub states: Vec<VehicleState<f64>>,
}

/// The distribution of a motion: a mixture of normal distributions at every instant.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionDistribution {
    /// The components; their weights sum to one.
    pub components: Vec<ComponentMotion>,
}

impl Predictor {
    pub(crate) fn new(
        vehicle: VehicleParameters,
        network: VehicleNetwork,
        latents: Latents,
    ) -> Self {
        Self { vehicle, network, latents, unscented: POINTS, source: None }
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
        let n = self.n_components();
        let fitted = self.fitted_to(initial, inputs);
        fitted.paths_at(initial, inputs, |j| {
            fitted.latents.component_shares(j, n).map(|share| share.mean)
        })
    }

    /// The path of each component at given latent factors.
    fn paths_at(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
        latents: impl Fn(usize) -> [f64; N_LATENTS],
    ) -> Vec<ComponentPath> {
        let (dynamics, mut batch) = (self.dynamics(), NetworkBatch::default());
        let mut none = |std: &mut [f64; N_RESIDUAL]| *std = [0.0; N_RESIDUAL];
        let component_path =
            |j: usize| path(&dynamics, j, &latents(j), &mut none, initial, inputs, &mut batch);
        let mut paths: Vec<ComponentPath> = (0..self.n_components()).map(component_path).collect();
        let sum: f64 = paths.iter().map(|path| path.weight).sum();
        paths.iter_mut().for_each(|path| path.weight /= sum);
        paths
    }

    /// Mean over the components of the paths on which one latent factor is one and the others are zero.
    pub(crate) fn path_at(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
        latent: usize,
    ) -> Vec<VehicleState<f64>> {
        let latents = std::array::from_fn(|m| if m == latent { 1.0 } else { 0.0 });
        mean_of(&self.paths_at(initial, inputs, |_| latents), inputs.len())
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
        let paths = fitted.paths_at(initial, inputs, |_| [0.0; N_LATENTS]);
        mean_of(&paths, inputs.len())
    }

    /// The distribution of the motion.
    ///
    /// - `inputs`: the input over each step.
    pub fn motion(
        &self,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> MotionDistribution {
        let fitted = self.fitted_to(initial, inputs);
        let dynamics = fitted.dynamics();
        let component = |j| dynamics.motion(j, self.unscented, initial, inputs);
        MotionDistribution::new((0..self.n_components()).map(component).collect())
    }

    /// Coherent draws: a component, latent factors drawn once, and the noise of each step. The
    /// reference that [`Predictor::motion`] is compared with.
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
            let mut rng = random_stream(seed, "coherent motions", idx as u64);
            let j = drawn(&weights, rng.random());
            let shares = fitted.latents.component_shares(j, weights.len());
            let width = fitted.latents.width(rng.random());
            let latents: [f64; N_LATENTS] = std::array::from_fn(|m| {
                width * (shares[m].mean + shares[m].variance.sqrt() * normal(&mut rng))
            });
            let mut noise = |std: &mut [f64; N_RESIDUAL]| {
                std.iter_mut().for_each(|std| *std *= width * normal(&mut rng));
            };
            let mut batch = NetworkBatch::default();
            path(&dynamics, j, &latents, &mut noise, initial, inputs, &mut batch).states
        };
        (0..n).into_par_iter().map(draw).collect()
    }
}

/// Mean of paths of `n_steps` steps.
fn mean_of(paths: &[ComponentPath], n_steps: usize) -> Vec<VehicleState<f64>> {
    let at = |i: usize| {
        let states = paths.iter().filter_map(|path| Some((path.weight, path.states.get(i)?)));
        weighted_mean(states)
    };
    (0..=n_steps).map(at).collect()
}

pub(super) fn normal(rng: &mut ChaCha8Rng) -> f64 {
    rng.sample(StandardNormal)
}

/// The component that a number from 0 to 1 falls upon.
pub(super) fn drawn(weights: &[f64], share: f64) -> usize {
    let mut sum = 0.0;
    let found = weights.iter().position(|weight| {
        sum += weight;
        share < sum
    });
    found.unwrap_or(weights.len().saturating_sub(1))
}

/// Turns the standard deviations of the velocities after a step into draws.
type Noise<'a> = dyn FnMut(&mut [f64; N_RESIDUAL]) + 'a;

/// One path.
fn path(
    dynamics: &Dynamics<'_>,
    component: usize,
    latents: &[f64; N_LATENTS],
    noise: &mut Noise<'_>,
    initial: &VehicleState<f64>,
    inputs: &[VehicleInput<f64>],
    batch: &mut NetworkBatch,
) -> ComponentPath {
    let mut states = Vec::with_capacity(inputs.len() + 1);
    let mut state = *initial;
    states.push(state);
    let mut weight = 0.0;
    for (i, u) in inputs.iter().enumerate() {
        let next = dynamics.step(component, latents, &state, u, i as f64 * STEP_S, batch);
        weight += dynamics.weight(component, batch) / inputs.len() as f64;
        state = next;
        let mut off = dynamics.noise(component, batch);
        noise(&mut off);
        let [vx, vy, yaw, roll] = off;
        state.vx_body_m_s += vx;
        state.vy_body_m_s += vy;
        state.yaw_rate_rad_s += yaw;
        state.roll_rate_rad_s += roll;
        states.push(state);
    }
    ComponentPath { weight, states }
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

impl MotionDistribution {
    /// The mixture of components, whose weights are scaled to sum to one.
    pub fn new(mut components: Vec<ComponentMotion>) -> Self {
        let sum: f64 = components.iter().map(|component| component.weight).sum();
        components.iter_mut().for_each(|component| component.weight /= sum);
        Self { components }
    }

    /// The mixture of several distributions that are equally likely, such as one for each drawn force
    /// curve.
    pub fn mixed(parts: Vec<Self>) -> Self {
        Self::new(parts.into_iter().flat_map(|part| part.components).collect())
    }

    /// Number of instants.
    pub fn n_instants(&self) -> usize {
        self.components.first().map_or(0, |component| component.states.len())
    }

    /// Mean at an instant.
    pub fn mean(&self, instant: usize) -> VehicleState<f64> {
        let states = self
            .components
            .iter()
            .filter_map(|component| Some((component.weight, &component.states.get(instant)?.mean)));
        weighted_mean(states)
    }

    /// Covariance of [X, Y, ψ, v_x, v_y, r] at an instant, within the components and between them.
    pub fn covariance(&self, instant: usize) -> SMatrix<f64, 6, 6> {
        let mean = SVector::from(self.mean(instant).planar());
        let part = |part: PlanarState| {
            let off = part.mean - mean;
            (part.covariance + off * off.transpose()) * part.weight
        };
        self.parts(instant).map(part).sum()
    }

    /// The distribution of the heading at an instant, rad, beyond a turn; `None` where it is not
    /// finite.
    pub fn heading(&self, instant: usize) -> Option<NormalMixture> {
        self.marginal(instant, 2)
    }

    /// The distribution of X, Y, ψ, v_x, v_y or r at an instant; `None` where it is not finite.
    pub fn marginal(&self, instant: usize, axis: usize) -> Option<NormalMixture> {
        let part = |part: PlanarState| {
            let std = part.covariance[(axis, axis)].max(LEAST_VARIANCE).sqrt();
            NormalPart { weight: part.weight, mean: part.mean[axis], std }
        };
        NormalMixture::new(self.parts(instant).map(part).collect()).ok()
    }

    /// The distribution of the position at an instant.
    pub fn position(&self, instant: usize) -> PlanarMixture {
        let part = |PlanarState { weight, mean, covariance: p }: PlanarState| PlanarPart {
            weight,
            mean: [mean[0], mean[1]],
            covariance: [p[(0, 0)], p[(0, 1)], p[(1, 1)]],
        };
        PlanarMixture::new(self.parts(instant).map(part).collect())
    }

    /// The normal distributions of [X, Y, ψ, v_x, v_y, r] at an instant, of both widths of every
    /// component.
    fn parts(&self, instant: usize) -> impl Iterator<Item = PlanarState> + '_ {
        let parts = move |component: &ComponentMotion| component.at(instant);
        self.components.iter().flat_map(parts)
    }
}
