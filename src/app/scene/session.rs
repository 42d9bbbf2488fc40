//! The scene that is shown, which is built anew when what it is made of changes.

use std::sync::Arc;

use crate::app::latest::Latest;
use crate::app::measure::Measuring;
use crate::app::motion_plots::{Recorded, is_same_recording};
use crate::app::recording::overlaid;
use crate::app::response::{DensityAnswer, DensityQuestion, MotionAnswer};
use crate::app::scene::{KeyedCamera, SceneSettings};
use crate::app::source::Source;
use crate::app::variants::AnsweredVariant;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::{
    ForecastScene, LoadedGround, OtherMotion, Scene, SceneGround, SceneRole, SimulationScene,
    add_forecast, simulation_scene,
};
use impactlab_draw::scene::{CameraKey, SceneView};
use impactlab_study::{PredictMotionAnswer, SimulateAnswer};

/// The scene that is shown, and its picture.
#[derive(Default)]
pub struct SceneSession {
    /// The picture and the camera.
    pub view: SceneView,
    /// The density of the position at the end of the forecast, while the scene shows it.
    pub end_density: Latest<DensityQuestion>,
    /// What is measured on the ground.
    pub measuring: Measuring,
    keyed: KeyedCamera,
    built: Option<(SceneSource, Arc<Scene>)>,
    /// The scene of a ground with nothing on it.
    bare: Option<Arc<Scene>>,
}

/// What a scene is built from. It is built anew when this changes.
pub struct SceneSource {
    /// The simulation.
    pub answer: Arc<SimulateAnswer>,
    /// Simulations of other variants, by name.
    pub others: Vec<(String, Arc<SimulateAnswer>)>,
    /// The forecast, and the density of the position at its end once that is there.
    pub forecast: Option<ShownForecast>,
    /// The recording beside them.
    pub recording: Option<Recorded>,
    /// The ground below it.
    pub ground: Option<Arc<SceneGround>>,
    /// What restricts the simulation.
    pub caveats: Caveats,
    /// System of units of the labels.
    pub units: UnitSystem,
}

/// A forecast that a scene shows.
#[derive(Clone)]
pub struct ShownForecast {
    /// The forecast.
    pub motion: Arc<MotionAnswer>,
    /// The density of the position at its end.
    pub density: Option<Arc<DensityAnswer>>,
}

impl ShownForecast {
    fn is_same(&self, other: &Self) -> bool {
        let of = |shown: &Self| shown.density.as_ref().map(Arc::as_ptr);
        Arc::ptr_eq(&self.motion, &other.motion) && of(self) == of(other)
    }

    /// Adds it to the scene of its simulation.
    fn add_to(&self, scene: &mut Scene) {
        let PredictMotionAnswer { report, analysis, forecast } = &self.motion.answer;
        add_forecast(
            scene,
            &ForecastScene {
                analysis,
                forecast,
                density: self.density.as_ref().map(|density| &density.map),
                n_ghosts: ForecastScene::N_GHOSTS,
                until_s: report.known_until_s(),
            },
        );
        scene.caveats.add_variant("forecast", &report.caveats);
    }
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
            && match (&self.forecast, &other.forecast) {
                (Some(a), Some(b)) => a.is_same(b),
                (a, b) => a.is_none() && b.is_none(),
            }
            && is_same_recording(self.recording.as_ref(), other.recording.as_ref())
            && self.ground.as_ref().map(Arc::as_ptr) == other.ground.as_ref().map(Arc::as_ptr)
            && self.caveats == other.caveats
            && self.units == other.units
    }

    fn build(&self, sources: &[Source]) -> Scene {
        let mut others: Vec<OtherMotion<'_>> = Vec::new();
        let mut caveats = self.caveats.clone();
        for (idx, (name, other)) in self.others.iter().enumerate() {
            caveats.add_variant(name, &other.report.caveats);
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
        let mut scene = simulation_scene(&SimulationScene {
            analysis: &self.answer.analysis,
            others: &others,
            units: self.units,
            caveats: &caveats,
        });
        if let Some(forecast) = &self.forecast {
            forecast.add_to(&mut scene);
        }
        Scene { ground: self.ground.clone(), ..scene }
    }
}

impl SceneSession {
    /// Smallest and largest `[X, Y]` of the scene that was shown last, m.
    pub(in crate::app) fn extent_m(&self) -> Option<[[f64; 2]; 2]> {
        self.built.as_ref().map(|(_, scene)| scene.extent_m())
    }

    /// Places the camera where its keys have it at a time, if that is to be shown.
    pub fn place_by_keys(
        &mut self,
        keys: &[CameraKey],
        settings: &mut SceneSettings,
        at: (&Scene, f64),
    ) {
        if let Some(camera) = self.keyed.at(keys, settings, at) {
            self.view.place_at(camera);
        }
    }

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
        (self.built, self.bare) = (Some((source, Arc::clone(&scene))), None);
        scene
    }

    /// The scene of a ground with nothing on it. Another ground is seen from the start.
    pub fn of_ground(&mut self, loaded: &LoadedGround, units: UnitSystem) -> Arc<Scene> {
        let LoadedGround { site, ground, .. } = loaded;
        let is_on = |scene: &Scene| scene.ground.as_ref().is_some_and(|on| Arc::ptr_eq(on, ground));
        let before = self.bare.take().filter(|scene| is_on(scene));
        if before.is_none() {
            self.view.fit();
        }
        let scene = before.filter(|scene| scene.units == units).unwrap_or_else(|| {
            let (title, ground) = (site.name.clone(), Some(Arc::clone(ground)));
            Arc::new(Scene { title, ground, units, ..Scene::default() })
        });
        (self.built, self.bare) = (None, Some(Arc::clone(&scene)));
        scene
    }
}
