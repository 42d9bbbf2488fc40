//! The posterior of a case, for the sampler.

use crate::evidence::Evidence;
use crate::likelihood::{Compared, Discrepancy, EvidenceTerm};
use crate::sampler::{Likelihood, Target};
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
        self.compared(motion, false).log_likelihood
    }

    /// What a motion says of the evidence.
    ///
    /// - `wants_terms`: whether its terms are wanted, too.
    pub(crate) fn compared(&self, motion: &CollisionMotion, wants_terms: bool) -> Compared {
        if motion.impact.is_some_and(|impact| !impact.is_collision()) {
            return Compared::impossible();
        }
        self.evidence.compared(&self.discrepancy, motion, wants_terms)
    }

    /// The evidence item by item against a motion; none where the motion could not be computed.
    pub fn terms(&self, motion: &CollisionMotion) -> Vec<EvidenceTerm> {
        self.evidence.compared(&self.discrepancy, motion, true).terms
    }
}

impl Target for ReconstructionTarget {
    fn dim(&self) -> usize {
        self.model.prior().components().len()
    }

    fn log_likelihoods(&self, z: &[Vec<f64>]) -> Vec<f64> {
        self.model.motions(z, |motion| self.log_likelihood(&motion))
    }

    fn likelihoods(&self, z: &[Vec<f64>]) -> Vec<Likelihood> {
        self.model.motions(z, |motion| {
            let Compared { log_likelihood: log, parts, .. } = self.compared(&motion, false);
            Likelihood { log, without: parts.into_iter().map(|part| part.log_without).collect() }
        })
    }
}
