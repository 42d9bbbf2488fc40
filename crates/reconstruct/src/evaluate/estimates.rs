//! What had happened as one method estimates it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::evidence::Measured;
use crate::{
    HandCalculation, PointOptimum, Posterior, QuantityEstimate, ReconstructedQuantity,
    ReconstructionTarget,
};
use impactlab_core::numerics::{quantile_of_sorted, unwrapped_rad};
use impactlab_core::uncertainty::{NormalMixture, NormalPart, sample_crps};
use impactlab_core::units::Quantity;

/// The quantities that are compared with the truth.
pub const SCORED: [ReconstructedQuantity; 6] = [
    ReconstructedQuantity::StruckSpeed,
    ReconstructedQuantity::ClosingSpeed,
    ReconstructedQuantity::StrikingSpeed,
    ReconstructedQuantity::HeadingDifference,
    ReconstructedQuantity::DeltaVStruck,
    ReconstructedQuantity::StruckYawRate,
];

/// How a collision is reconstructed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReconstructionMethod {
    /// The particles of the posterior.
    Reconstruction,
    /// The [`HandCalculation`], which knows no speed of the striking car. Its closing speed is that
    /// across the struck side.
    Hand,
    /// The [`PointOptimum`]: the most probable point with its curvature.
    Swarm,
}

/// The distribution of a quantity, in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum QuantityDistribution {
    /// Equally likely values in increasing order.
    Draws(Vec<f64>),
    /// A normal distribution.
    Normal(Measured),
}

/// A quantity with its distribution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EstimatedQuantity {
    /// Which quantity.
    pub quantity: ReconstructedQuantity,
    /// Its distribution.
    pub distribution: QuantityDistribution,
}

/// The estimates of one case by one method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MethodEstimates {
    /// How they are estimated.
    pub method: ReconstructionMethod,
    /// Time that it has taken, s.
    pub seconds: f64,
    /// Effective sample size, of a method that samples.
    pub ess: Option<f64>,
    /// Motions that were simulated.
    pub n_simulations: usize,
    /// The quantities that the method knows.
    pub quantities: Vec<EstimatedQuantity>,
}

impl ReconstructionMethod {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Reconstruction, Self::Hand, Self::Swarm];

    /// A few words for a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::Reconstruction => "reconstruction",
            Self::Hand => "by hand",
            Self::Swarm => "swarm",
        }
    }
}

impl QuantityDistribution {
    /// Equally likely values of a quantity; those of an angle continue without a jump.
    pub fn from_draws(quantity: ReconstructedQuantity, mut draws: Vec<f64>) -> Self {
        if quantity.quantity() == Quantity::Angle {
            draws = unwrapped_rad(&draws);
        }
        draws.sort_by(f64::total_cmp);
        Self::Draws(draws)
    }

    /// The value below which the quantity lies with a probability; `None` without values, and of a
    /// normal distribution without a positive standard deviation.
    pub fn quantile(&self, probability: f64) -> Option<f64> {
        match self {
            Self::Draws(sorted) => quantile_of_sorted(sorted, probability),
            Self::Normal(measured) => Some(normal(*measured)?.quantile(probability)),
        }
    }

    /// Continuous ranked probability score against the truth, in the unit of the quantity; `None`
    /// likewise.
    pub fn crps(&self, truth: f64) -> Option<f64> {
        match self {
            Self::Draws(draws) => (!draws.is_empty()).then(|| sample_crps(draws, truth)),
            Self::Normal(measured) => Some(normal(*measured)?.crps(truth)),
        }
    }

    /// Median and intervals of a quantity that is so distributed; `None` likewise.
    pub fn estimate(&self, quantity: ReconstructedQuantity) -> Option<QuantityEstimate> {
        QuantityEstimate::by(quantity, |probability| self.quantile(probability))
    }
}

fn normal(measured: Measured) -> Option<NormalMixture> {
    let part = NormalPart { weight: 1.0, mean: measured.value, std: measured.sigma };
    NormalMixture::new(vec![part]).ok()
}

impl MethodEstimates {
    /// The quantities of particles.
    ///
    /// - `ess`, `n_simulations`: their effective sample size, and the motions that they have cost.
    pub fn from_posterior(
        posterior: &Posterior,
        ess: f64,
        n_simulations: usize,
        seconds: f64,
    ) -> Self {
        let method = ReconstructionMethod::Reconstruction;
        let quantities = quantities(posterior);
        Self { method, seconds, ess: Some(ess), n_simulations, quantities }
    }

    /// The speeds by hand; none where the rest position is not known.
    pub fn by_hand(hand: Option<&HandCalculation>, seconds: f64) -> Self {
        let estimates = |hand: &HandCalculation| {
            let speed = |quantity, measured| EstimatedQuantity {
                quantity,
                distribution: QuantityDistribution::Normal(measured),
            };
            vec![
                speed(ReconstructedQuantity::StruckSpeed, hand.struck_speed_m_s),
                speed(ReconstructedQuantity::ClosingSpeed, hand.closing_speed_m_s),
            ]
        };
        let method = ReconstructionMethod::Hand;
        Self {
            method,
            seconds,
            ess: None,
            n_simulations: 0,
            quantities: hand.map(estimates).unwrap_or_default(),
        }
    }

    /// The quantities of the most probable point, by draws from the normal distribution about it; none
    /// where the evidence is impossible wherever the swarm has looked.
    ///
    /// - `n_draws`, `seed`: number and seed of the draws.
    pub fn by_swarm(
        struck: &ReconstructionTarget,
        found: Option<&PointOptimum>,
        n_draws: usize,
        seed: u64,
        seconds: f64,
    ) -> Self {
        let drawn = found.and_then(|found| found.draws(n_draws, seed));
        let at = |z: Vec<Vec<f64>>| quantities(&Posterior::from_points(struck.model(), &z));
        Self {
            method: ReconstructionMethod::Swarm,
            seconds,
            ess: None,
            n_simulations: found.map_or(0, |found| found.n_evaluations),
            quantities: drawn.map(at).unwrap_or_default(),
        }
    }
}

fn quantities(posterior: &Posterior) -> Vec<EstimatedQuantity> {
    let estimate = |quantity: ReconstructedQuantity| EstimatedQuantity {
        quantity,
        distribution: QuantityDistribution::from_draws(quantity, posterior.values(quantity)),
    };
    SCORED.map(estimate).into()
}
