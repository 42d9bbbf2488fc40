//! The scene of the simulation that is shown, with the variants and the recording beside it.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::app::recording::{OverlaidRecording, overlaid};
use crate::app::source::Source;
use crate::app::variants::AnsweredVariant;
use crate::render::scene::{Camera, Follow, SceneView};
use crate::scene::{OtherMotion, Scene, SceneRole, SimulationScene, simulation_scene};
use crate::study::{SimulateAnswer, Trust};
use crate::units::UnitSystem;

/// From where the scene is seen, which is saved.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SceneSettings {
    /// Kind of view and directions; the place follows the scene.
    pub camera: Camera,
    /// Which car stays in the middle.
    pub follow: Follow,
}

/// The scene that is shown, and its picture.
#[derive(Default)]
pub struct SceneSession {
    /// The picture and the camera.
    pub view: SceneView,
    built: Option<(SceneSource, Arc<Scene>)>,
}

/// What a scene is built from. It is built anew when this changes.
pub struct SceneSource {
    /// The simulation.
    pub answer: Arc<SimulateAnswer>,
    /// Simulations of other variants, by name.
    pub others: Vec<(String, Arc<SimulateAnswer>)>,
    /// The recording beside them, with the number of its samples.
    pub recording: Option<(OverlaidRecording, usize)>,
    /// What restricts the simulation.
    pub trust: Trust,
    /// System of units of the labels.
    pub units: UnitSystem,
}

impl SceneSource {
    /// Those variants that are not in the forms and have a simulation.
    pub fn others(variants: &[AnsweredVariant]) -> Vec<(String, Arc<SimulateAnswer>)> {
        let others = variants.iter().filter(|variant| !variant.is_shown);
        others
            .filter_map(|of| Some((of.name.clone(), Arc::clone(of.simulation.as_ref()?))))
            .collect()
    }

    fn is_same(&self, other: &Self) -> bool {
        let are_same = |a: &[(String, Arc<SimulateAnswer>)],
                        b: &[(String, Arc<SimulateAnswer>)]| {
            a.len() == b.len()
                && a.iter().zip(b).all(|(a, b)| a.0 == b.0 && Arc::ptr_eq(&a.1, &b.1))
        };
        Arc::ptr_eq(&self.answer, &other.answer)
            && are_same(&self.others, &other.others)
            && self.recording == other.recording
            && self.trust == other.trust
            && self.units == other.units
    }

    fn build(&self, sources: &[Source]) -> Scene {
        let mut others: Vec<OtherMotion<'_>> = Vec::new();
        let mut trust = self.trust.clone();
        for (idx, (name, other)) in self.others.iter().enumerate() {
            let said = Trust::new(&other.report.badges, &other.report.assumptions);
            trust.add_variant(name, &said);
            let motion = other.analysis.simulation.as_ref();
            others.extend(motion.map(|motion| OtherMotion {
                name,
                role: SceneRole::Variant(idx),
                motion: &motion.series,
                offset_s: 0.0,
                of: Some(&other.analysis),
            }));
        }
        let recorded = overlaid(self.recording.as_ref().map(|(of, _)| of), sources);
        if let Some((name, motion, offset_s)) = &recorded {
            let (role, of) = (SceneRole::Recorded, None);
            others.push(OtherMotion { name, role, motion, offset_s: *offset_s, of });
        }
        simulation_scene(&SimulationScene {
            analysis: &self.answer.analysis,
            others: &others,
            units: self.units,
            trust: &trust,
        })
    }
}

impl SceneSession {
    /// The scene of a source. Another subject is seen from the start: the camera is fitted to it.
    pub fn scene(&mut self, source: SceneSource, sources: &[Source]) -> Arc<Scene> {
        if let Some((built, scene)) = &self.built
            && built.is_same(&source)
        {
            return Arc::clone(scene);
        }
        let scene = Arc::new(source.build(sources));
        let is_new = self.built.as_ref().is_none_or(|(_, before)| before.title != scene.title);
        if is_new {
            self.view.fit();
        }
        self.built = Some((source, Arc::clone(&scene)));
        scene
    }
}
