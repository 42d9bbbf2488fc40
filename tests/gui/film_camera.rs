//! The camera of a film: its keys are set in the scene, which shows what the film will.

use std::f64::consts::FRAC_PI_2;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, Command, Pane, PlaybackCommand};
use impactlab_core::units::UnitSystem;
use impactlab_draw::scene::{Camera, CameraKey, Follow};

use crate::film::{ask_film, film_of_form};
use crate::harness::{apply, is_idle, open, step_until, type_into};
use crate::pictures::save;

/// The camera of the scene on screen.
fn camera_of_scene(harness: &Harness<'_, App>) -> Camera {
    harness.state().state().session.scene.view.camera().expect("it was drawn")
}

/// Moves the camera of the scene on screen.
fn move_camera(harness: &mut Harness<'_, App>, distance_m: f64) {
    let camera = Camera { distance_m, ..camera_of_scene(harness) };
    harness.state_mut().state_mut().session.scene.view.place_at(camera);
    harness.run_steps(3);
}

/// Time and distance of the keys of the camera.
fn camera_keys(harness: &Harness<'_, App>) -> Vec<(f64, f64)> {
    let keys = &harness.state().state().project.beside.camera_keys;
    keys.iter().map(|key| (key.time_s, key.distance_m)).collect()
}

#[test]
fn the_camera_is_keyed_in_the_scene_and_goes_with_the_time() {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the first case", is_idle);
    apply(&mut harness, Command::Show(Pane::Scene));
    harness.run_steps(4);
    harness.get_by_label("Camera keys").click();
    harness.run_steps(3);
    for (time_s, distance_m) in [(0.4, 12.0), (0.0, 80.0)] {
        apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(time_s)));
        move_camera(&mut harness, distance_m);
        harness.get_by_label("Key the camera here").click();
        harness.run_steps(3);
    }
    assert_eq!(camera_keys(&harness), [(0.0, 80.0), (0.4, 12.0)]);

    harness.get_by_label("Show the keyed camera").click();
    harness.run_steps(3);
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(0.2)));
    harness.run_steps(3);
    let distance_m = camera_of_scene(&harness).distance_m;
    assert!((13.0..79.0).contains(&distance_m), "{distance_m} m");
    move_camera(&mut harness, 5.0);
    assert_eq!(camera_of_scene(&harness).distance_m, 5.0, "it is free while the time stands");
    harness.get_by_label_contains("Key 2: 0.400 s").click();
    harness.run_steps(3);
    assert_eq!(harness.state().state().session.playback.time_s, 0.4);
    assert_eq!(camera_of_scene(&harness).distance_m, 12.0);
    save(&mut harness, "scene-camera-keys.png");

    // What stays for a second can be brought back.
    harness.run_steps(80);
    harness.get_by_label("Remove key 2").click();
    harness.run_steps(3);
    assert_eq!(camera_keys(&harness), [(0.0, 80.0)]);
    apply(&mut harness, Command::Undo);
    assert_eq!(camera_keys(&harness), [(0.0, 80.0), (0.4, 12.0)]);
    let project = &harness.state().state().project;
    let read = project.with_variant(&project.to_variant("base")).expect("what was written");
    assert_eq!(read.beside.camera_keys, project.beside.camera_keys, "they are part of the case");

    // A click elsewhere closes the menu and does nothing else.
    harness.get_by_label("Camera keys").click();
    harness.run_steps(3);
    ask_film(&mut harness);
    let film = film_of_form(&harness);
    assert!(film.keys.len() == 2 && film.instants().is_ok());
    harness.get_by_label("Move the camera from key to key").click();
    harness.run_steps(3);
    assert!(film_of_form(&harness).keys.is_empty(), "the camera is the one on screen");
}

#[test]
fn the_numbers_of_a_camera_key_are_typed_and_its_place_follows_its_time() {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the first case", is_idle);
    apply(&mut harness, Command::Show(Pane::Scene));
    harness.run_steps(4);
    let camera = camera_of_scene(&harness);
    let key = |time_s: f64, distance_m: f64| {
        CameraKey::new(time_s, &Camera { distance_m, ..camera }, Follow::Nothing)
    };
    let keys = &mut harness.state_mut().state_mut().project.beside.camera_keys;
    *keys = vec![key(0.0, 80.0), key(0.4, 12.0)];
    harness.get_by_label("Camera keys").click();
    harness.run_steps(3);

    type_into(&mut harness, "Distance of key 2", "25");
    assert_eq!(camera_keys(&harness), [(0.0, 80.0), (0.4, 25.0)]);
    let seen =
        (camera_of_scene(&harness).distance_m, harness.state().state().session.playback.time_s);
    assert_eq!(seen, (25.0, 0.4), "what is changed is seen");
    type_into(&mut harness, "Time of key 1", "600 ms");
    assert_eq!(camera_keys(&harness), [(0.4, 25.0), (0.6, 80.0)]);
    // Neither over another key nor beyond the range.
    type_into(&mut harness, "Time of key 2", "0.4");
    assert_eq!(camera_keys(&harness), [(0.4, 25.0), (0.6, 80.0)]);
    let said = harness.state().state().session.messages.last().map(|message| message.text.clone());
    assert_eq!(said.as_deref(), Some("there is a camera key at 0.400 s already"));
    let before = harness.state().state().project.beside.camera_keys.clone();
    type_into(&mut harness, "Elevation of key 1", "200");
    assert_eq!(harness.state().state().project.beside.camera_keys, before);
    assert!(harness.query_by_label_contains("not possible").is_some());

    harness.run_steps(80);
    type_into(&mut harness, "Azimuth of key 1", "90");
    let azimuth_rad = harness.state().state().project.beside.camera_keys[0].azimuth_rad;
    assert!((azimuth_rad - FRAC_PI_2).abs() < 1e-9, "{azimuth_rad}");
    apply(&mut harness, Command::Undo);
    assert_eq!(harness.state().state().project.beside.camera_keys, before);

    harness.state_mut().state_mut().view.units = UnitSystem::Us;
    harness.run_steps(3);
    type_into(&mut harness, "Centre X of key 1", "10");
    let target_m = harness.state().state().project.beside.camera_keys[0].target_m;
    assert!((target_m[0] - 3.048).abs() < 1e-9, "{target_m:?}");
    save(&mut harness, "scene-camera-key-table.png");
}
