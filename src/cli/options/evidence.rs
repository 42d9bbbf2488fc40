//! What is reconstructed.

use std::path::PathBuf;

use clap::Args;

use crate::cli::options::{VehicleArg, count};
use impactlab_core::ranges::RECONSTRUCTION_PARTICLES;
use impactlab_study::{EvidenceChoice, ReconstructRequest};

/// The evidence, the cars, and with how many particles the speeds are sampled.
#[derive(Debug, Args)]
pub(in crate::cli) struct EvidenceArgs {
    /// The evidence file
    #[arg(value_name = "EVIDENCE.toml")]
    evidence: PathBuf,
    /// The struck car: stands in where the evidence gives no value
    #[arg(long, value_name = "NAME|FILE")]
    vehicle: Option<VehicleArg>,
    /// The striking car, likewise
    #[arg(long, value_name = "NAME|FILE")]
    striking: Option<VehicleArg>,
    /// The ground in the axes of the evidence: a site file, in whose friction zones the wheels stand
    #[arg(long, value_name = "SITE.toml")]
    pub(in crate::cli) site: Option<PathBuf>,
    /// Follow the cars through the first contact alone, although they meet again
    #[arg(long)]
    one_contact: bool,
    /// Number of particles
    #[arg(long, value_name = "N", default_value_t = ReconstructRequest::DEFAULT_PARTICLES,
        value_parser = count::<usize>(RECONSTRUCTION_PARTICLES))]
    particles: usize,
    /// Seed of all draws
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

impl EvidenceArgs {
    /// The question, without a checkpoint.
    pub(in crate::cli) fn request(&self) -> ReconstructRequest {
        ReconstructRequest {
            vehicle: VehicleArg::choice(&self.vehicle),
            striking: VehicleArg::choice(&self.striking),
            site: self.site.clone(),
            one_contact: self.one_contact,
            particles: self.particles,
            seed: self.seed,
            ..ReconstructRequest::new(EvidenceChoice::File(self.evidence.clone()))
        }
    }
}
