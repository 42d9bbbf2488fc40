//! The settings of the reconstruction, which are saved between runs.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::app::scene::SceneSettings;
use impactlab_reconstruct::ReconstructedQuantity;
use impactlab_study::{EvidenceChoice, ReconstructRequest, VehicleChoice};

/// What the user works on in a reconstruction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ReconstructionProject {
    /// The evidence: a file as long as nothing of it was changed here.
    pub evidence: Option<EvidenceChoice>,
    /// The struck car, where the evidence leaves it open.
    pub vehicle: VehicleChoice,
    /// The striking car, likewise.
    pub striking: VehicleChoice,
    /// The site file of the ground, if that has friction zones.
    pub site: Option<PathBuf>,
    /// Number of particles.
    pub particles: usize,
    /// Seed of all draws.
    pub seed: u64,
}

impl Default for ReconstructionProject {
    fn default() -> Self {
        Self {
            evidence: None,
            vehicle: VehicleChoice::default(),
            striking: VehicleChoice::default(),
            site: None,
            particles: ReconstructRequest::DEFAULT_PARTICLES,
            seed: 0,
        }
    }
}

impl ReconstructionProject {
    /// Whether nothing was set.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// The question of the form; `None` without evidence.
    pub fn request(&self) -> Option<ReconstructRequest> {
        let evidence = self.evidence.clone()?;
        Some(ReconstructRequest {
            vehicle: self.vehicle.clone(),
            striking: self.striking.clone(),
            site: self.site.clone(),
            particles: self.particles,
            seed: self.seed,
            ..ReconstructRequest::new(evidence)
        })
    }
}

/// How a reconstruction is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ReconstructionView {
    /// The quantity whose distribution is drawn.
    pub quantity: ReconstructedQuantity,
    /// The quantity that is drawn against it.
    pub against: ReconstructedQuantity,
    /// Whether the scene has the cars as bodies instead of the plan in which evidence is placed.
    pub shows_cars: bool,
    /// From where these cars are seen.
    pub scene: SceneSettings,
}

impl Default for ReconstructionView {
    fn default() -> Self {
        Self {
            quantity: ReconstructedQuantity::StruckSpeed,
            against: ReconstructedQuantity::RoadFriction,
            shows_cars: false,
            scene: SceneSettings::default(),
        }
    }
}
