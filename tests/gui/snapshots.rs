//! Every kind of figure is compared pixel by pixel with a picture that was inspected. After an
//! intended change, `UPDATE_SNAPSHOTS=1` replaces the pictures.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use egui_kittest::image_snapshot;
use impactlab::analysis::{Analysis, Settings, analyse_case};
use impactlab::collision::{ChannelClass, Scenario};
use impactlab::data::{Channel, Dataset};
use impactlab::figure::{
    Figure, analysis_force_figure, analysis_motion_figure, analysis_scene_figure, impact_figure,
};
use impactlab::render::scene::{Camera, Follow, ScenePicture, ViewKind, scene_image};
use impactlab::render::{Canvas, figure_image};
use impactlab::scene::{SimulationScene, simulation_scene};
use impactlab::study::Trust;
use impactlab::units::UnitSystem;
use impactlab::vehicle::{Integrator, Preset};

fn analysis(dataset: &str, case: &str) -> Analysis {
    let mut report = |_| ControlFlow::Continue(());
    let root = Path::new("datasets").join(dataset);
    let dataset = Dataset::load(&root, &mut report).expect("shipped data").complete();
    let settings = Settings {
        target: Preset::Reference.parameters(),
        bullet: Preset::Bullet2000.parameters(),
        integrator: Integrator::Rk4,
        duration_s: 4.0,
        ending: impactlab::vehicle::Ending::default(),
        ends_at_rest: false,
        friction_zones: Vec::new(),
    };
    let dataset = dataset.expect("nothing cancels");
    analyse_case(dataset.case(case).expect("a shipped case"), &settings).expect("it runs")
}

fn check(figure: &Figure, dark: bool, name: &str) {
    let canvas = Canvas { size_px: [480, 300], scale: 1.0, dark };
    image_snapshot(&figure_image(figure, canvas).expect("a picture"), name);
}

#[test]
fn force() {
    let analysis = analysis("fea", "c002");
    let class = Some(ChannelClass::Cfc60);
    let shown = (&analysis, &Trust::default());
    let figure = analysis_force_figure(shown, class, &[], UnitSystem::Si).expect("it filters");
    check(&figure.expect("a force"), false, "force");
}

#[test]
fn motion() {
    let analysis = analysis("trajectories-pulse", "P001");
    let shown = (&analysis, &Trust::default());
    check(&analysis_motion_figure(shown, Channel::YawRate, UnitSystem::Us), true, "motion");
}

#[test]
fn scene_with_bullet_and_scene_with_reference() {
    let force_case = analysis("fea", "c002");
    let shown = (&force_case, &Trust::default());
    check(&analysis_scene_figure(shown, 0.4, UnitSystem::Si), false, "scene_bullet");
    let trajectory = analysis("trajectories-fea", "FE_c002");
    let shown = (&trajectory, &Trust::default());
    check(&analysis_scene_figure(shown, 2.0, UnitSystem::Us), true, "scene_reference");
}

/// The scene of a case, drawn as cars.
fn check_scene(
    analysis: &Analysis,
    (kind, time_s): (ViewKind, f64),
    (size_px, dark): ([u32; 2], bool),
    name: &str,
) {
    let (trust, units) = (Trust::default(), UnitSystem::Si);
    let input = SimulationScene { analysis, others: &[], units, trust: &trust };
    let picture = ScenePicture {
        scene: Arc::new(simulation_scene(&input)),
        time_s,
        camera: Camera { kind, ..Camera::default() },
        is_placed: false,
        distance_m: (kind == ViewKind::Perspective).then_some(14.0),
        follow: Follow::Struck,
    };
    let canvas = Canvas { size_px, scale: 1.0, dark };
    image_snapshot(&scene_image(&picture, canvas).expect("a picture"), name);
}

#[test]
fn cars_from_above_and_in_perspective() {
    let recorded = analysis("trajectories-fea", "FE_c002");
    check_scene(&recorded, (ViewKind::Above, 2.0), ([320, 210], true), "cars_above");
    let force_case = analysis("fea", "c002");
    check_scene(&force_case, (ViewKind::Perspective, 0.3), ([220, 130], false), "cars_perspective");
}

#[test]
fn impact() {
    let scenario = Scenario::example();
    let solution = scenario.solve().expect("the example is solved");
    let figure = impact_figure((&scenario, &solution), &Trust::default(), UnitSystem::Si);
    check(&figure.expect("they touch"), false, "impact");
}
