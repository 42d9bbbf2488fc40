//! Stills of scenes in a report: the cars on the ground at a moment.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::report::answer::Context;
use crate::report::numbers::fill;
use crate::report::parts::PartPicture;
use crate::scene::{
    ForecastScene, LoadedGround, ReconstructionParts, Scene, SceneStill, SimulationScene, ViewKind,
    add_forecast, reconstruction_scene, simulation_scene,
};
use impactlab_core::error_chain;
use impactlab_core::uncertainty::Caveats;
use impactlab_study::analysis::{Analysis, DensityMap};
use impactlab_study::{
    PredictMotionAnswer, PredictMotionRequest, ReconstructAnswer, ReconstructedPaths,
};

/// Distance of the camera from the struck car at the end of the contact, m: both cars fill the picture.
const NEAR_M: f64 = 16.0;

/// Stills of a simulation: from above at the end of the motion, and in perspective at the end of the
/// contact if a striking vehicle is there.
///
/// - `site`: file of the ground below it;
/// - `[contact_end_s, end_s]`: the moments, s; no contact if it is `None`.
pub(super) fn simulation_stills(
    analysis: &Analysis,
    caveats: &Caveats,
    site: Option<&Path>,
    [contact_end_s, end_s]: [Option<f64>; 2],
    context: Context<'_>,
) -> Vec<PartPicture> {
    let Context { wording, .. } = context;
    let words = wording.words;
    let input = SimulationScene { analysis, others: &[], units: wording.units, caveats };
    let (scene, note) = on_ground(simulation_scene(&input), site, context);
    let still = |caption: &str, time_s, view, near_m: Option<f64>| {
        let (scene, is_half_wide) = (Arc::clone(&scene), near_m.is_some());
        let still = SceneStill { scene, time_s, view, near_m, is_half_wide };
        PartPicture::still(format!("{caption}{note}"), still)
    };
    let contact_s = contact_end_s.filter(|_| scene.striking().is_some());
    let near = contact_s
        .map(|at_s| still(words.contact_picture, at_s, ViewKind::Perspective, Some(NEAR_M)));
    let whole = end_s.map(|at_s| still(words.scene_picture, at_s, ViewKind::Above, None));
    whole.into_iter().chain(near).collect()
}

/// The still of a forecast from above: its draws as ghosts, density and regions at a moment.
pub(super) fn forecast_still(
    request: &PredictMotionRequest,
    answer: &PredictMotionAnswer,
    density: &Arc<DensityMap>,
    caveats: &Caveats,
    context: Context<'_>,
) -> PartPicture {
    let Context { wording, .. } = context;
    let (analysis, report) = (&answer.analysis, &answer.report);
    let input = SimulationScene { analysis, others: &[], units: wording.units, caveats };
    let mut scene = simulation_scene(&input);
    add_forecast(
        &mut scene,
        &ForecastScene {
            analysis,
            forecast: &answer.forecast,
            density: Some(density),
            n_ghosts: ForecastScene::N_GHOSTS,
            until_s: report.known_until_s(),
        },
    );
    let (scene, note) = on_ground(scene, request.motion.site.as_deref(), context);
    let time_s = report.outcome.time_s;
    let template = match report.is_end_known() {
        true => wording.words.forecast_scene_picture,
        false => wording.words.forecast_paths_picture,
    };
    PartPicture::still(format!("{template}{note}"), from_above(scene, time_s))
}

/// The still of a reconstruction from above: the car of a particle of median speed at rest, over what was
/// found.
///
/// - `site`: file of the ground below it.
pub(super) fn reconstruction_still(
    answer: &ReconstructAnswer,
    paths: &ReconstructedPaths,
    site: Option<&Path>,
    caveats: &Caveats,
    context: Context<'_>,
) -> Option<PartPicture> {
    paths.median.as_ref()?;
    let Context { wording, .. } = context;
    let parts = ReconstructionParts::new(answer, paths, wording.units, caveats);
    let scene = reconstruction_scene(&parts);
    let (scene, note) = on_ground(scene, site, context);
    let time_s = scene.end_s;
    let words = wording.words;
    let caption = match answer.report.kind.is_collision() {
        true => words.reconstruction_cars,
        false => words.single_car,
    };
    let caption = format!("{caption}{note}");
    Some(PartPicture::still(caption, from_above(scene, time_s)))
}

/// All of a scene from above, over the width of a page.
fn from_above(scene: Arc<Scene>, time_s: f64) -> SceneStill {
    SceneStill { scene, time_s, view: ViewKind::Above, near_m: None, is_half_wide: false }
}

/// A scene with its ground, and what a caption has to say of it: that it cannot be read, is not to scale, or
/// lies elsewhere.
fn on_ground(
    mut scene: Scene,
    site: Option<&Path>,
    Context { wording, paths, grounds }: Context<'_>,
) -> (Arc<Scene>, String) {
    let quoted = |text: &String| wording.quoted(&paths.shown(text));
    let note = match site.map(|site| grounds.read(site)) {
        None => String::new(),
        Some(Err(why)) => fill(wording.words.ground_not_drawn, &[("why", &quoted(&why))]),
        Some(Ok(loaded)) => {
            let far = loaded.far_notes(scene.extent_m(), scene.units);
            let notes = loaded.notes.iter().chain(&far);
            scene.ground = Some(Arc::clone(&loaded.ground));
            notes.map(|note| format!("; {}", quoted(note))).collect()
        }
    };
    (Arc::new(scene), note)
}

/// A ground, or why it cannot be read.
type ReadGround = Result<Arc<LoadedGround>, String>;

/// The grounds of a report by their site files. Each is read once, since orthophotos are large.
#[derive(Default)]
pub(in crate::report) struct Grounds(RefCell<BTreeMap<PathBuf, ReadGround>>);

impl Grounds {
    fn read(&self, site: &Path) -> ReadGround {
        let mut read = self.0.borrow_mut();
        let load = || LoadedGround::load(site).map(Arc::new).map_err(|error| error_chain(&error));
        read.entry(site.to_owned()).or_insert_with(load).clone()
    }
}
