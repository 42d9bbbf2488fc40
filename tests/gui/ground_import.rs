//! Grounds of other programs in the window.

use std::path::PathBuf;

use egui_kittest::kittest::Queryable;
use impactlab::app::{Command, Pane};

use crate::harness::{apply, is_idle, open, step_until};

const SCENARIO: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenarios/pit_right_rear.toml");

#[test]
fn a_map_that_is_dropped_lies_below_the_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let map = folder.path().join("map.geojson");
    let text = r#"{"type": "FeatureCollection", "features": [{"type": "Feature",
        "properties": {"name": "skid"}, "geometry": {"type": "LineString",
        "coordinates": [[8.5, 47.3], [8.5001, 47.3001]]}}]}"#;
    std::fs::write(&map, text).expect("a file");
    let mut harness = open(&[SCENARIO]);
    apply(&mut harness, Command::Open(vec![map]));
    step_until(&mut harness, "the ground", |state| {
        state.session.ground.shown().is_some() && is_idle(state)
    });
    let ground = harness.state().state().session.ground.shown().cloned().expect("a ground");
    assert_eq!(ground.site.lines.len(), 1);
    assert!(ground.notes.join(" ").contains("latitude 47.3"), "{:?}", ground.notes);
}

#[test]
fn a_point_cloud_asks_how_and_becomes_a_ground() {
    let folder = tempfile::tempdir().expect("a folder");
    let cloud = folder.path().join("scan.las");
    std::fs::write(&cloud, scan()).expect("a file");
    let mut harness = open(&[SCENARIO]);
    apply(&mut harness, Command::Show(Pane::Scene));
    apply(&mut harness, Command::Open(vec![cloud]));
    harness.run_steps(4);
    harness.get_by_label("Make site").click();
    step_until(&mut harness, "the ground", |state| {
        state.session.ground.shown().is_some() && is_idle(state)
    });
    let state = harness.state().state();
    let ground = state.session.ground.shown().expect("a ground");
    let site: PathBuf = folder.path().join("scan ground").join("site.toml");
    assert_eq!(ground.site.path, site);
    assert!(ground.ground.has_picture(), "an orthophoto");
    assert!(!state.session.dialogs.is_any_open(), "the dialog is closed");
}

/// The scene stayed empty until a case was chosen.
#[test]
fn a_ground_is_seen_before_anything_is_chosen_that_moves_on_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let cloud = folder.path().join("scan.las");
    std::fs::write(&cloud, scan()).expect("a file");
    let mut harness = open(&[]);
    apply(&mut harness, Command::Show(Pane::Scene));
    harness.run_steps(2);
    assert!(harness.query_by_label("Picture of the scene").is_none());
    apply(&mut harness, Command::Open(vec![cloud]));
    harness.run_steps(4);
    harness.get_by_label("Make site").click();
    step_until(&mut harness, "the ground", |state| state.session.ground.shown().is_some());
    let state = harness.state().state();
    assert!(state.project.subject().is_none(), "no case is chosen");
    let ground = state.session.ground.shown().expect("a ground");
    let [low_m, high_m] = ground.ground.extent_m().expect("an extent");
    let picture = harness.get_by_label("Picture of the scene").rect();
    let [low, high] = [low_m, high_m].map(|at_m| {
        let at = state.session.scene.view.on_screen(at_m).expect("before the camera");
        assert!(picture.contains(at), "{at_m:?} m is at {at:?} of {picture:?}");
        at
    });
    assert!(low.distance(high) > 20.0, "{low:?} {high:?}");
    // A scenario takes the place of the empty road.
    apply(&mut harness, Command::Open(vec![SCENARIO.into()]));
    step_until(&mut harness, "the motion", |state| is_idle(state) && state.analysis().is_some());
    apply(&mut harness, Command::Show(Pane::Scene));
    harness.run_steps(4);
    let title = harness.query_all_by_label_contains("scene from above at").next();
    assert!(title.is_some(), "the heading of the motion");
}

/// A square metre of road.
fn scan() -> Vec<u8> {
    let mut builder = las::Builder::from((1, 2));
    builder.point_format = las::point::Format::new(2).expect("a format");
    let header = builder.into_header().expect("a header");
    let file = std::io::Cursor::new(Vec::new());
    let mut writer = las::Writer::new(file, header).expect("a writer");
    for idx in 0..400_u16 {
        let [x, y] = [idx % 20, idx / 20].map(|side| 0.025 + 0.05 * f64::from(side));
        let color = Some(las::Color { red: 40_000, green: 40_000, blue: 40_000 });
        writer
            .write_point(las::Point { x, y, z: 7.0, color, ..las::Point::default() })
            .expect("a point");
    }
    writer.into_inner().expect("a file").into_inner()
}
