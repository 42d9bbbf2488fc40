//! What the evidence pane shows of the form before it is run.

use std::path::PathBuf;

use impactlab_core::error_chain;
use impactlab_reconstruct::evidence::Evidence;
use impactlab_reconstruct::{Cars, Prior, PriorComponent};
use impactlab_study::{ReconstructRequest, VehicleChoice};

/// What follows from the evidence before anything is sampled.
pub struct EvidencePreview {
    /// The evidence.
    pub evidence: Evidence,
    /// The choice of the struck and of the striking car.
    chosen: [VehicleChoice; 2],
    /// The site on whose friction zones the wheels stand.
    site: Option<PathBuf>,
    /// Why a chosen vehicle cannot be used.
    pub problem: Option<String>,
    /// The vehicles.
    pub cars: Cars,
    /// What is taken to be likely before the motion is looked at.
    pub priors: Vec<PriorComponent>,
}

impl EvidencePreview {
    pub(super) fn new(evidence: &Evidence, request: &ReconstructRequest) -> Self {
        let chosen = [&request.vehicle, &request.striking].map(VehicleChoice::clone);
        let site = request.site.clone();
        let mut problem = None;
        let [struck, striking] = chosen.each_ref().map(|choice| {
            choice.chosen().unwrap_or_else(|error| {
                problem = Some(error_chain(&error));
                None
            })
        });
        let cars = Cars::new(evidence, struck.as_ref(), striking.as_ref());
        let prior = Prior::new(evidence, &cars);
        let prior = if site.is_some() { prior.with_zones() } else { prior };
        let priors = prior.components().to_vec();
        Self { evidence: evidence.clone(), chosen, site, problem, cars, priors }
    }

    /// Whether it is of these vehicles and of this ground.
    pub(super) fn is_of(&self, request: &ReconstructRequest) -> bool {
        self.chosen.each_ref() == [&request.vehicle, &request.striking] && self.site == request.site
    }
}
