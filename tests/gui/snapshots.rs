//! Every kind of figure is compared pixel by pixel with a picture that was inspected. After an
//! intended change, `UPDATE_SNAPSHOTS=1` replaces the pictures.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use egui_kittest::image_snapshot;
use impactlab::app::{Measure, Measuring};
use impactlab_core::collision::{ChannelClass, Scenario};
use impactlab_core::data::{Channel, Dataset};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::{Braking, Ending, Integrator, Preset};
use impactlab_document::figure::{
    Figure, ReplayCurve, analysis_force_figure, analysis_motion_figure, analysis_scene_figure,
    impact_figure, replay_curve_figure, replay_path_figure,
};
use impactlab_document::scene::{Scene, SimulationScene, simulation_scene};
use impactlab_draw::scene::{
    Camera, Follow, SceneCanvas, SceneLook, ScenePicture, ViewKind, scene_image,
};
use impactlab_draw::{Canvas, figure_image};
use impactlab_study::analysis::{Analysis, PulseSetup, Settings, analyse_case, analyse_scenario};
use impactlab_study::{Library, Question, ReplayRequest};

fn analysis(dataset: &str, case: &str) -> Analysis {
    let mut report = |_| ControlFlow::Continue(());
    let root = Path::new("datasets").join(dataset);
    let dataset = Dataset::load(&root, &mut report).expect("shipped data").complete();
    let dataset = dataset.expect("nothing cancels");
    analyse_case(dataset.case(case).expect("a shipped case"), &settings()).expect("it runs")
}

fn settings() -> Settings {
    Settings {
        struck: Preset::Reference.parameters(),
        striking: Preset::Bullet2000.parameters(),
        integrator: Integrator::Rk4,
        duration_s: 4.0,
        ending: impactlab_core::vehicle::Ending::default(),
        ends_at_rest: false,
        one_contact: false,
        friction_zones: Vec::new(),
    }
}

/// A push on the rear quarter, after which the struck car is braked with locked wheels.
pub fn braked_pit() -> Analysis {
    let brake = Some(Braking::new(0.7, 1.4, 0.3));
    let ending = Ending { brake, ..Ending::default() };
    // Each car for itself, so that half of the overlap is shown as a dent of each.
    let settings = Settings { ending, one_contact: true, ..settings() };
    let pulse = PulseSetup::default();
    analyse_scenario(&Scenario::example(), &pulse, &settings).expect("it runs")
}

fn check(figure: &Figure, dark: bool, name: &str) {
    let canvas = Canvas { size_px: [480, 300], scale: 1.0, dark };
    image_snapshot(&figure_image(figure, canvas).expect("a picture"), name);
}

#[test]
fn force() {
    let analysis = analysis("fea", "c002");
    let class = Some(ChannelClass::Cfc60);
    let figure = analysis_force_figure(&analysis, &Caveats::default(), class, &[], UnitSystem::Si)
        .expect("it filters");
    check(&figure.expect("a force"), false, "force");
}

#[test]
fn motion() {
    let analysis = analysis("trajectories-pulse", "P001");
    check(
        &analysis_motion_figure(&analysis, &Caveats::default(), Channel::YawRate, UnitSystem::Us),
        true,
        "motion",
    );
}

#[test]
fn scene_with_striking_and_scene_with_reference() {
    let force_case = analysis("fea", "c002");
    let caveats = Caveats::default();
    check(
        &analysis_scene_figure(&force_case, &caveats, 0.4, UnitSystem::Si),
        false,
        "scene_bullet",
    );
    let trajectory = analysis("trajectories-fea", "FE_c002");
    check(
        &analysis_scene_figure(&trajectory, &caveats, 2.0, UnitSystem::Us),
        true,
        "scene_reference",
    );
}

/// The scene of a case, drawn as cars.
fn check_scene(
    analysis: &Analysis,
    (kind, time_s): (ViewKind, f64),
    (size_px, dark): ([u32; 2], bool),
    name: &str,
) {
    let (caveats, units) = (Caveats::default(), UnitSystem::Si);
    let input = SimulationScene { analysis, others: &[], units, caveats: &caveats };
    let picture = ScenePicture {
        scene: Arc::new(simulation_scene(&input)),
        courses: Vec::new(),
        time_s,
        camera: Camera { kind, ..Camera::default() },
        is_placed: false,
        seen_aspect: None,
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
    check_scene(&force_case, (ViewKind::Perspective, 0.3), ([440, 240], false), "cars_perspective");
}

/// Pixels that change if a part of a scene is left out.
fn n_drawn(scene: &Scene, time_s: f64, leave_out: fn(&mut Scene)) -> usize {
    let pixels = |scene: Scene| {
        let size_px = [400, 250];
        let camera = Camera { kind: ViewKind::Above, ..Camera::default() };
        let camera = camera.fitted(&scene.places_m(), size_px.map(|side| side as f64));
        let look = SceneLook { size_px, camera, dark: false, pixels_per_point: 1.0 };
        let mut canvas = SceneCanvas::default();
        assert!(canvas.draw(&Arc::new(scene), &look, time_s));
        canvas.pixels().to_vec()
    };
    let mut without = scene.clone();
    leave_out(&mut without);
    let (all, rest) = (pixels(scene.clone()), pixels(without));
    all.iter().zip(&rest).filter(|(a, b)| a != b).count()
}

#[test]
fn marks_grow_and_outlines_are_dented_as_time_passes() {
    let analysis = braked_pit();
    let (caveats, units) = (Caveats::default(), UnitSystem::Si);
    let input = SimulationScene { analysis: &analysis, others: &[], units, caveats: &caveats };
    let scene = simulation_scene(&input);
    let marked = [0.0, 0.5, 1.5, 3.5].map(|time_s| n_drawn(&scene, time_s, |of| of.marks.clear()));
    assert_eq!(marked[0], 0, "nothing has slid yet");
    assert!(marked.windows(2).all(|pair| pair[0] < pair[1]), "{marked:?}");
    let [struck, striking] = &scene.crushes[..] else { panic!("{} outlines", scene.crushes.len()) };
    assert_eq!(struck.from_s, striking.from_s);
    // They go deeper into each other while the force acts, and the legend says so.
    assert!((0.09..0.1).contains(&struck.from_s), "largest overlap at {} s", struck.from_s);
    assert!(struck.name.contains("the overlap still grows"), "{}", struck.name);
    let dented = [struck.from_s - 0.01, struck.from_s, 2.0]
        .map(|time_s| n_drawn(&scene, time_s, |of| of.crushes.clear()));
    assert_eq!(dented[0], 0, "before the largest overlap");
    assert!(dented[1] > 50 && dented[2] > 50, "{dented:?}");
    check_scene(&analysis, (ViewKind::Above, 3.5), ([520, 330], false), "marks_above");
}

#[test]
fn what_was_measured_is_in_the_picture() {
    let analysis = analysis("fea", "c002");
    let caveats = Caveats::default();
    let input = SimulationScene {
        analysis: &analysis,
        others: &[],
        units: UnitSystem::Si,
        caveats: &caveats,
    };
    let scene = simulation_scene(&input);
    let mut measuring = Measuring { measure: Some(Measure::Length), ..Measuring::default() };
    for at_m in [[0.0, -3.0], [8.0, -3.0]] {
        measuring.click(at_m);
    }
    measuring.end();
    let pixels = |scene: &Arc<Scene>| {
        let camera = Camera { kind: ViewKind::Above, ..Camera::default() };
        let (scene, distance_m) = (Arc::clone(scene), None);
        let follow = Follow::Nothing;
        let picture = ScenePicture {
            scene,
            courses: Vec::new(),
            time_s: 0.3,
            camera,
            is_placed: false,
            seen_aspect: None,
            distance_m,
            follow,
        };
        let canvas = Canvas { size_px: [480, 300], scale: 1.0, dark: false };
        scene_image(&picture, canvas).expect("a picture").into_raw()
    };
    let plain = Arc::new(scene);
    let measured = measuring.added_to(&plain);
    assert_eq!(measured.measures[0].text, "8.00 m");
    let (without, with) = (pixels(&plain), pixels(&measured));
    let n_changed = without.chunks(4).zip(with.chunks(4)).filter(|(a, b)| a != b).count();
    assert!((200..8000).contains(&n_changed), "{n_changed} pixels");
}

/// A turn to the left by a recorder, from above and its yaw rate beside the recorded one.
#[test]
fn replay() {
    const TURN: &str = "Time [s],Speed [km/h],Steering Wheel Angle [deg],Yaw Rate [deg/s]\n\
        -2,50,30,-6\n-1.5,50,60,-12\n-1,48,60,-12\n-0.5,44,30,-6\n0,40,0,0\n";
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("edr.csv");
    std::fs::write(&file, TURN).expect("a file");
    let request =
        ReplayRequest { steering_ratio: Some(15.0), draws: 60, ..ReplayRequest::new(file) };
    let mut go_on = |_: impactlab_study::Event<'_>| ControlFlow::Continue(());
    let answer = request.answer(&Library::default(), &mut go_on).expect("an answer");
    let mut report = answer.complete().expect("nobody cancelled").report;
    report.caveats = Caveats::default();
    check(&replay_path_figure(&report, UnitSystem::Si), false, "replay_path");
    let yaw_rate = replay_curve_figure(&report, ReplayCurve::YawRate, UnitSystem::Si);
    check(&yaw_rate, true, "replay_yaw_rate");
}

#[test]
fn impact() {
    let scenario = Scenario::example();
    let solution = scenario.solve().expect("the example is solved");
    let figure = impact_figure(&scenario, &solution, &Caveats::default(), UnitSystem::Si);
    check(&figure.expect("they touch"), false, "impact");
}
