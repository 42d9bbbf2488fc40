//! One case against its truth.

use schemars::JsonSchema;
use serde::Serialize;

use crate::QuantityEstimate;
use crate::evaluate::{KnownEvidence, ReconstructionMethod, SpeedEstimates, TrueSpeeds};

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
    /// The speeds that the method knows.
    pub quantities: Vec<ScoredQuantity>,
}

impl CaseScore {
    /// The score of the estimates of a case. A speed without a distribution is left out.
    pub fn new(
        case: &str,
        known: KnownEvidence,
        estimates: &SpeedEstimates,
        truth: &TrueSpeeds,
    ) -> Self {
        let scored = estimates.speeds.iter().filter_map(|speed| {
            let truth = truth.speed_m_s(speed.quantity)?;
            let estimate = speed.distribution.estimate(speed.quantity)?;
            Some(ScoredQuantity { estimate, truth, crps: speed.distribution.crps(truth)? })
        });
        let SpeedEstimates { method, seconds, ess, n_simulations, .. } = *estimates;
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
