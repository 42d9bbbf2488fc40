//! Pictures of the whole window, which are written below `target/pictures` for inspection.

use std::path::{Path, PathBuf};

use egui_kittest::Harness;
use impactlab::app::{App, Command, Pane, PlaybackCommand, Subject};

use crate::harness::{apply, is_idle, open, step_until};

/// The folder of the pictures.
pub fn picture_folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pictures");
    std::fs::create_dir_all(&folder).expect("a folder for pictures");
    folder
}

/// Draws the window into a file.
pub fn save(harness: &mut Harness<'_, App>, name: &str) {
    let image = harness.render().expect("the software renderer always draws");
    image.save(picture_folder().join(name)).expect("a picture is written");
    let first = image.get_pixel(0, 0);
    assert!(image.pixels().any(|pixel| pixel != first), "{name} is blank");
}

#[test]
fn the_window_on_the_shipped_data() {
    let mut harness = open(&["datasets"]);
    step_until(&mut harness, "the shipped data", is_idle);
    let case = Subject::Case {
        dataset: concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/trajectories-fea").into(),
        case: "FE_c002".into(),
    };
    apply(&mut harness, Command::Select(case));
    step_until(&mut harness, "a trajectory case", |state| {
        state.analysis().is_some_and(|answer| answer.report.name == "FE_c002") && is_idle(state)
    });
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(2.0)));
    harness.step();
    save(&mut harness, "window.png");
    apply(
        &mut harness,
        Command::ReplayDataset(
            concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/trajectories-fea").into(),
        ),
    );
    step_until(&mut harness, "the replay", |state| {
        state.session.replays.values().all(|replay| replay.report().is_some())
    });
    harness.state_mut().state_mut().view.dark = true;
    let fea = Subject::Case {
        dataset: concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea").into(),
        case: "c002".into(),
    };
    apply(&mut harness, Command::Select(fea));
    step_until(&mut harness, "a force case", |state| {
        state.analysis().is_some_and(|answer| answer.report.name == "c002") && is_idle(state)
    });
    save(&mut harness, "window-dark.png");
    harness.state_mut().state_mut().view.dark = false;
    apply(&mut harness, Command::Select(Subject::Scenario));
    apply(&mut harness, Command::Show(Pane::Scenario));
    step_until(&mut harness, "the scenario", is_idle);
    harness.run_steps(6);
    save(&mut harness, "window-scenario.png");
}

#[test]
fn the_empty_window() {
    let mut harness = open(&["no/such/folder"]);
    step_until(&mut harness, "the error", |state| !state.session.messages.is_empty());
    save(&mut harness, "window-empty.png");
}

#[test]
fn the_mapping_dialog_and_the_vehicle_pane() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("export.csv");
    let text = "Zeit;Kraft A;Kraft B\n0;0;0\n1;2,5;40\n2;3,5;55\n3;0;0\n";
    std::fs::write(&path, text).expect("a file");
    let mut harness = open(&[path.to_str().expect("a plain name")]);
    step_until(&mut harness, "the dialog", |state| state.session.dialogs.import().is_some());
    harness.run_steps(4);
    save(&mut harness, "mapping.png");
    apply(&mut harness, Command::CloseDialog);
    harness.state_mut().state_mut().project.simulate.vehicle =
        impactlab_study::VehicleChoice::Preset("scaled-target-100".to_owned());
    apply(&mut harness, Command::Show(Pane::Vehicle));
    harness.run_steps(4);
    save(&mut harness, "vehicle.png");
    let state = harness.state_mut().state_mut();
    state.view.dark = true;
    state.project.start_mut().speed_m_s = Some(15.0);
    state.project.start_mut().contact = Some(impactlab_study::ASSUMED_CONTACT);
    harness.run_steps(4);
    save(&mut harness, "vehicle-dark.png");
}
