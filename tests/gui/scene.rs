//! The scene in the window: its views, the mouse, and what is exported.

use egui::{Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, Command, Pane, PlaybackCommand};
use impactlab_draw::scene::{Camera, Follow, ViewKind};

use crate::harness::{apply, is_idle, open, step_until};
use crate::pictures::save;

const PIT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/examples/pit.impactlab");

fn scene() -> Harness<'static, App> {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the first case", is_idle);
    apply(&mut harness, Command::Show(Pane::Scene));
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(0.3)));
    harness.run_steps(4);
    harness
}

fn camera(harness: &Harness<'_, App>) -> Camera {
    harness.state().state().session.scene.view.camera().expect("a scene was drawn")
}

/// Drags with the primary button from the middle of the scene.
fn drag(harness: &mut Harness<'_, App>, from: Pos2, way: Vec2) {
    harness.drag_at(from);
    harness.step();
    harness.hover_at(from + way);
    harness.step();
    harness.drop_at(from + way);
    harness.step();
}

#[test]
fn the_view_is_switched_by_its_label_and_moved_by_the_mouse() {
    let mut harness = scene();
    assert_eq!(camera(&harness).kind, ViewKind::Above);
    save(&mut harness, "scene-above.png");
    let from_above = harness.render().expect("a picture");
    // A point of the ground that no label covers.
    let middle = Pos2::new(760.0, 330.0);
    let before = camera(&harness);
    drag(&mut harness, middle, Vec2::new(60.0, 0.0));
    let after = camera(&harness);
    assert!(after.target_m[0] < before.target_m[0] - 0.1, "{before:?} {after:?}");
    assert_eq!(after.distance_m, before.distance_m);

    harness.get_by_label("Perspective").click();
    harness.run_steps(4);
    let before = camera(&harness);
    assert_eq!(before.kind, ViewKind::Perspective);
    assert_eq!(harness.state().state().view.scene.camera.kind, ViewKind::Perspective);
    save(&mut harness, "scene-perspective.png");
    assert!(harness.render().expect("a picture") != from_above);
    drag(&mut harness, middle, Vec2::new(60.0, 20.0));
    let after = camera(&harness);
    assert!(after.elevation_rad > before.elevation_rad, "{before:?} {after:?}");
    assert!((after.azimuth_rad - before.azimuth_rad).abs() > 0.1, "{before:?} {after:?}");
    assert_eq!(after.target_m, before.target_m);

    harness.get_by_label("From above").click();
    harness.run_steps(4);
    assert_eq!(camera(&harness).kind, ViewKind::Above);
}

#[test]
fn the_time_line_goes_to_start_and_end_of_the_contact() {
    let mut harness = scene();
    let time_s = |harness: &Harness<'_, App>| harness.state().state().session.playback.time_s;
    harness.key_press(egui::Key::End);
    harness.run_steps(2);
    let answer = harness.state().state().analysis().expect("a simulation");
    let force = answer.analysis.force.as_ref().expect("a force");
    let (_, end_s) = impactlab_core::data::contact_interval(force).expect("a contact");
    // The slider has whole milliseconds.
    assert!((time_s(&harness) - end_s).abs() < 1e-3, "{} s, {end_s} s", time_s(&harness));
    assert!((0.02..0.3).contains(&end_s), "{end_s} s");
    harness.key_press(egui::Key::Home);
    harness.run_steps(2);
    assert_eq!(time_s(&harness), 0.0);
}

#[test]
fn the_camera_follows_the_struck_car() {
    let mut harness = scene();
    harness.state_mut().state_mut().view.scene.follow = Follow::Struck;
    for time_s in [0.2, 1.0, 3.0] {
        apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(time_s)));
        harness.run_steps(3);
        let answer = harness.state().state().analysis().expect("a simulation");
        let motion = &answer.analysis.simulation.as_ref().expect("a motion").series;
        let pose = impactlab_core::collision::Pose::from_motion(motion, time_s).expect("a pose");
        let target = camera(&harness).target_m;
        assert!((target[0] - pose.x_m).hypot(target[1] - pose.y_m) < 1e-9, "at {time_s} s");
    }
    harness.state_mut().state_mut().view.dark = true;
    harness.state_mut().state_mut().view.scene.camera.kind = ViewKind::Perspective;
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(0.6)));
    harness.run_steps(4);
    save(&mut harness, "scene-dark.png");
}

#[test]
fn the_wheel_zooms_about_the_pointer() {
    let mut harness = scene();
    let (at, before) = (Pos2::new(760.0, 330.0), camera(&harness));
    harness.hover_at(at);
    harness.step();
    harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 120.0),
        modifiers: egui::Modifiers::NONE,
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
    });
    harness.run_steps(12);
    let after = camera(&harness);
    assert!(after.distance_m < 0.9 * before.distance_m, "{before:?} {after:?}");
}

#[test]
fn the_forecast_stands_in_the_scene_if_it_is_wanted() {
    let mut harness = open(&[PIT]);
    step_until(&mut harness, "the forecast", |state| {
        state.session.response.forecast.ok().is_some()
    });
    apply(&mut harness, Command::Show(Pane::Scene));
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(2.0)));
    harness.run_steps(4);
    let without = harness.render().expect("a picture");
    harness.get_by_label("Forecast").click();
    step_until(&mut harness, "the density at the end", |state| {
        let density = state.session.scene.end_density.ok();
        density.is_some_and(|density| density.map.window_s == [4.0; 2])
    });
    harness.run_steps(4);
    save(&mut harness, "scene-forecast.png");
    assert!(harness.render().expect("a picture") != without);
    assert!(harness.query_by_label("draws of the forecast").is_some());
    assert!(harness.query_by_label("90 % region").is_some());
    assert!(harness.query_by_label("draws of the striking vehicle").is_some());
    harness.get_by_label("Forecast").click();
    harness.run_steps(4);
    assert!(harness.query_by_label("draws of the forecast").is_none());
}
