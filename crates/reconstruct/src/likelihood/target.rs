//! The posterior of a case, for the sampler.

use crate::evidence::Evidence;
use crate::likelihood::{Discrepancy, EvidenceTerm};
use crate::sampler::Target;
use crate::{CollisionMotion, ForwardModel};

/// The likelihood of the evidence of a case over the quantities of its prior.
#[derive(Debug, Clone)]
pub struct ReconstructionTarget {
    evidence: Evidence,
    model: ForwardModel,
    discrepancy: Discrepancy,
}

impl ReconstructionTarget {
    /// The posterior of a case.
    pub fn new(evidence: Evidence, model: ForwardModel, discrepancy: Discrepancy) -> Self {
        Self { evidence, model, discrepancy }
    }

    /// The forward model.
    pub fn model(&self) -> &ForwardModel {
        &self.model
    }

    /// The evidence.
    pub fn evidence(&self) -> &Evidence {
        &self.evidence
    }

    /// What the forward model errs by.
    pub fn discrepancy(&self) -> &Discrepancy {
        &self.discrepancy
    }

    /// Logarithm of the likelihood of a motion, up to a constant. It is −∞ where the cars draw apart,
    /// since damage was found.
    pub fn log_likelihood(&self, motion: &CollisionMotion) -> f64 {
        if !motion.impact.is_collision() {
            return f64::NEG_INFINITY;
        }
        self.evidence.compared(&self.discrepancy, motion, false).0
    }

    /// The evidence item by item against a motion; none where the motion could not be computed.
    pub fn terms(&self, motion: &CollisionMotion) -> Vec<EvidenceTerm> {
        self.evidence.compared(&self.discrepancy, motion, true).1
    }
}

impl Target for ReconstructionTarget {
    fn dim(&self) -> usize {
        self.model.prior().components().len()
    }

    fn log_likelihoods(&self, z: &[Vec<f64>]) -> Vec<f64> {
        self.model.motions(z, |motion| self.log_likelihood(&motion))
    }
}
