//! The scene of a reconstruction with the cars as bodies.

use std::sync::Arc;

use crate::app::reconstruction::FollowedParticle;
use crate::app::scene::KeyedCamera;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::{ReconstructionParts, Scene, SceneGround, reconstruction_scene};
use impactlab_draw::scene::gpu::WindowDevice;
use impactlab_draw::scene::{CoursesView, SceneCourse, SceneView};
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
    /// Whether its courses of events stand side by side.
    pub has_courses: bool,
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
    /// Those of courses of events that stand side by side.
    pub courses_view: CoursesView,
    /// The camera that moves between keys.
    pub keyed: KeyedCamera,
    built: Option<(CarsSource, BuiltCars)>,
}

/// A scene, and those of its courses of events if they stand side by side.
#[derive(Clone)]
pub struct BuiltCars {
    /// The scene with everything in it.
    pub scene: Arc<Scene>,
    /// The scene of each course of events.
    pub courses: Vec<SceneCourse>,
}

impl ReconstructedCars {
    /// Draws on the graphics processor of the window from now on.
    pub fn draw_on(&mut self, device: &WindowDevice) {
        self.view.draw_on(device.clone());
        self.courses_view.draw_on(device.clone());
    }

    /// Why the graphics processor does not draw any more, once.
    pub fn take_refusals(&mut self) -> [Option<String>; 2] {
        [self.view.take_refusal(), self.courses_view.take_refusal()]
    }

    /// Fits the camera to what is drawn next.
    pub fn fit(&mut self) {
        self.view.fit();
        self.courses_view.fit();
    }

    /// The same without a scene.
    pub fn emptied(self) -> Self {
        Self { built: None, ..self }
    }

    /// The scene of a source. Other evidence is seen from the start: the camera is fitted to it.
    ///
    /// - `parts`: what the source stands for;
    /// - `courses`: the same of each course of events, with its title;
    /// - `ground`: what lies below it.
    pub fn scene(
        &mut self,
        source: CarsSource,
        parts: &ReconstructionParts<'_>,
        courses: &[(String, ReconstructionParts<'_>)],
        ground: Option<&Arc<SceneGround>>,
    ) -> BuiltCars {
        let is_on =
            |scene: &Scene| scene.ground.as_ref().map(Arc::as_ptr) == ground.map(Arc::as_ptr);
        if let Some((of, built)) = &self.built
            && *of == source
            && is_on(&built.scene)
        {
            return built.clone();
        }
        let scene = |parts: &ReconstructionParts<'_>| {
            Arc::new(Scene { ground: ground.cloned(), ..reconstruction_scene(parts) })
        };
        let course = |(name, parts): &(String, ReconstructionParts<'_>)| SceneCourse {
            name: name.clone(),
            scene: scene(parts),
        };
        let built =
            BuiltCars { scene: scene(parts), courses: courses.iter().map(course).collect() };
        let is_same = |(before, _): &(CarsSource, _)| {
            before.evidence == source.evidence && before.paths != ShownPaths::None
        };
        if !self.built.as_ref().is_some_and(is_same) {
            self.fit();
        }
        self.built = Some((source, built.clone()));
        built
    }
}
