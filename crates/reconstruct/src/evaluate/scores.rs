//! One case against its truth.

use schemars::JsonSchema;
use serde::Serialize;

use crate::QuantityEstimate;
use crate::evaluate::{
    EstimatedQuantity, KnownEvidence, MethodEstimates, ReconstructionMethod, TrueQuantities,
};
use impactlab_core::numerics::wrap_angle_rad;
use impactlab_core::units::Quantity;

/// A quantity beside its true value.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ScoredQuantity {
    /// What was estimated.
    #[serde(flatten)]
    pub estimate: QuantityEstimate,
    /// The true value.
    pub truth: f64,
    /// Continuous ranked probability score.
    pub crps: f64,
}

/// A case by one method beside its truth.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CaseScore {
    /// Name of the case.
    pub case: String,
    /// How much of the evidence was used.
    pub known: KnownEvidence,
    /// How the speeds were estimated.
    pub method: ReconstructionMethod,
    /// Time that it has taken, s.
    pub seconds: f64,
    /// Effective sample size, of a method that samples.
    pub ess: Option<f64>,
    /// Motions that were simulated.
    pub n_simulations: usize,
    /// The quantities that the method knows.
    pub quantities: Vec<ScoredQuantity>,
}

impl CaseScore {
    /// The score of the estimates of a case. A quantity without a distribution or a true value is left
    /// out; an angle is compared with the turn of the truth that is nearest to its median.
    pub fn new(
        case: &str,
        known: KnownEvidence,
        estimates: &MethodEstimates,
        truth: &TrueQuantities,
    ) -> Self {
        let scored = estimates.quantities.iter().filter_map(|estimated| {
            let EstimatedQuantity { quantity, distribution } = estimated;
            let estimate = distribution.estimate(*quantity)?;
            let mut truth = truth.value(*quantity)?;
            if quantity.quantity() == Quantity::Angle {
                let median = estimate.estimate.median;
                truth = median + wrap_angle_rad(truth - median);
            }
            Some(ScoredQuantity { estimate, truth, crps: distribution.crps(truth)? })
        });
        let MethodEstimates { method, seconds, ess, n_simulations, .. } = *estimates;
        let (case, quantities) = (case.to_owned(), scored.collect());
        Self { case, known, method, seconds, ess, n_simulations, quantities }
    }

    /// A quantity by its name; `None` if the method does not know it.
    pub fn quantity(&self, name: &str) -> Option<&ScoredQuantity> {
        self.quantities.iter().find(|scored| scored.estimate.name == name)
    }
}

impl ScoredQuantity {
    /// Estimated less true value.
    pub fn error(&self) -> f64 {
        self.estimate.estimate.median - self.truth
    }

    /// Width of the interval of 90 %.
    pub fn width_90(&self) -> f64 {
        let [low, high] = self.estimate.estimate.ninety();
        high - low
    }
}
