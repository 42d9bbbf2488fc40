//! The scene of a reconstruction with the cars as bodies.

use std::sync::Arc;

use crate::app::reconstruction::FollowedParticle;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::{ReconstructionParts, Scene, SceneGround, reconstruction_scene};
use impactlab_draw::scene::SceneView;
use impactlab_reconstruct::evidence::Evidence;

/// What a scene is built from. It is built anew when this changes.
#[derive(Debug, Clone, PartialEq)]
pub struct CarsSource {
    /// What was found.
    pub evidence: Evidence,
    /// Which paths are drawn.
    pub paths: ShownPaths,
    /// The particle that is followed.
    pub followed: Option<FollowedParticle>,
    /// System of units of the labels.
    pub units: UnitSystem,
    /// What restricts the answer.
    pub caveats: Caveats,
}

/// Paths that are drawn, told apart from others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShownPaths {
    /// None.
    None,
    /// Those of particles that are not the answer yet: power of the likelihood and ends of their speeds.
    Live(f64, Option<[f64; 2]>),
    /// Those of an answer: its number in the session and the course of events.
    Answer(u64, Option<usize>),
}

/// The scene with the cars, and its picture.
#[derive(Default)]
pub struct ReconstructedCars {
    /// The picture and the camera.
    pub view: SceneView,
    built: Option<(CarsSource, Arc<Scene>)>,
}

impl ReconstructedCars {
    /// The scene of a source. Other evidence is seen from the start: the camera is fitted to it.
    ///
    /// - `parts`: what the source stands for;
    /// - `ground`: what lies below it.
    pub fn scene(
        &mut self,
        source: CarsSource,
        parts: &ReconstructionParts<'_>,
        ground: Option<&Arc<SceneGround>>,
    ) -> Arc<Scene> {
        let is_on =
            |scene: &Scene| scene.ground.as_ref().map(Arc::as_ptr) == ground.map(Arc::as_ptr);
        if let Some((built, scene)) = &self.built
            && *built == source
            && is_on(scene)
        {
            return Arc::clone(scene);
        }
        let scene = Scene { ground: ground.cloned(), ..reconstruction_scene(parts) };
        let scene = Arc::new(scene);
        let is_same = |(before, _): &(CarsSource, _)| {
            before.evidence == source.evidence && before.paths != ShownPaths::None
        };
        if !self.built.as_ref().is_some_and(is_same) {
            self.view.fit();
        }
        self.built = Some((source, Arc::clone(&scene)));
        scene
    }
}
