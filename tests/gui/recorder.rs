//! The record of an event data recorder, opened in the window.

use std::path::Path;

use egui::OutputCommand;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, Command, Dialog, Pane, RecorderCommand};
use impactlab_core::collision::Role;
use impactlab_core::collision::contact::BarrierTest;
use impactlab_core::data::{CrashTest, RecorderRecord, Severity};
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_study::{EvidenceChoice, VehicleChoice};

use crate::harness::{apply, open, step_until};

const REPORT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fuzz/corpus/cdr/report.csv");

#[test]
fn a_report_becomes_evidence_that_can_be_undone() {
    let mut harness = open(&[]);
    // What stays for a second can be brought back.
    harness.run_steps(80);
    let before = harness.state().state().project.reconstruct.clone();
    apply(&mut harness, Command::Open(vec![REPORT.into()]));
    harness.run_steps(4);
    let dialogs = &harness.state().state().session.dialogs;
    assert!(dialogs.is_any_open());
    harness.get_by_label("Make evidence of it").click();
    harness.run_steps(4);
    let state = harness.state().state();
    assert!(!state.session.dialogs.is_any_open());
    let evidence = state.evidence().expect("evidence");
    let edr = evidence.edr.expect("a record");
    assert_eq!((edr.ends_s, evidence.striking_edr), (Some(0.1), None));
    let request = state.project.reconstruct.as_ref().expect("a question");
    assert!(matches!(request.evidence, EvidenceChoice::Inline(_)));
    let said = &state.session.messages;
    assert!(said.iter().any(|message| message.text.contains("cut off")));
    assert!(said.iter().any(|message| message.severity == Severity::Info));
    apply(&mut harness, Command::Undo);
    assert_eq!(harness.state().state().project.reconstruct, before);
}

#[test]
fn a_record_of_the_other_car_leaves_the_evidence_that_is_there() {
    let mut harness = open(&["tests/data/evidence/spin.toml"]);
    let before = harness.state().state().evidence().cloned().expect("evidence");
    let record = Box::new(RecorderRecord::read(Path::new(REPORT), None).expect("a record"));
    let command = RecorderCommand::MakeEvidence { record, car: Role::Striking };
    apply(&mut harness, Command::Recorder(command));
    let mut after = harness.state().state().evidence().cloned().expect("evidence");
    assert!(after.striking_edr.is_some());
    after.striking_edr = before.striking_edr;
    assert_eq!(after, before);
}

/// Seconds before a crash in which the driver turns to the left and brakes.
pub const BEFORE: &str = "CDR FILE INFORMATION\nEDR Device Type,Module 7\nComplete File Recorded,Yes\n\
    PRE-CRASH DATA -5 TO 0 SEC [2 SAMPLES/SEC] (EVENT RECORD 1)\n\
    Times (sec),\"Speed, Vehicle Indicated (MPH [km/h])\",Steering Input (deg),Service Brake\n\
    -2.0,40 [64],0,Off\n-1.5,40 [64],10,Off\n-1.0,40 [64],20,Off\n-0.5,36 [58],20,On\n\
    0.0,31 [50],10,On\n";

#[test]
fn a_recorder_is_replayed_with_the_car_and_the_case_keeps_the_question() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("report.csv");
    std::fs::write(&path, BEFORE).expect("a file");
    let mut harness = open(&[]);
    apply(&mut harness, Command::Show(Pane::Replay));
    harness.run_steps(2);
    assert!(harness.query_by_label("What did a car do before the contact?").is_some());
    assert!(harness.query_by_label_contains("Steering Wheel Angle [deg]").is_some());
    let car = VehicleChoice::Preset("toyota-camry-2018".to_owned());
    apply(&mut harness, Command::ChooseVehicle(Role::Struck, Box::new(car.clone())));
    harness.run_steps(80);
    apply(&mut harness, Command::Open(vec![path.clone()]));
    harness.run_steps(4);
    harness.get_by_label("Replay it with this car").click();
    step_until(&mut harness, "the replay", |state| state.session.recorder_replay.ok().is_some());
    let state = harness.state().state();
    assert!(!state.session.dialogs.is_any_open());
    let request = state.project.replay.clone().expect("a question");
    assert_eq!((&request.recorder, &request.vehicle, request.event), (&path, &car, None));
    for label in ["speed at the first contact", "steering ratio", "driver open", "From above"] {
        assert!(harness.query_all_by_label_contains(label).next().is_some(), "{label}");
    }
    let state = harness.state().state();
    let variant = state.project.to_variant("replay");
    assert!(variant.questions.contains(&request.clone().into()));
    let read = state.project.with_variant(&variant).expect("it is read");
    assert_eq!((read.replay.as_ref(), read.others.len()), (Some(&request), 0));
    crate::pictures::save(&mut harness, "window-replay.png");

    // An answer to other settings is marked, and asked again by a person alone.
    let asked = harness.state_mut().state_mut().project.replay.as_mut().expect("a question");
    (asked.steering_ratio, asked.event) = (Some(14.5), Some(1));
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("Replay again").is_some());
    let command = Command::Recorder(RecorderCommand::RunReplay);
    apply(&mut harness, command.clone());
    step_until(&mut harness, "the other replay", |state| {
        let latest = state.session.recorder_replay.latest.as_ref();
        latest.is_some_and(|latest| latest.question.steering_ratio == Some(14.5))
    });
    assert!(harness.query_by_label_contains("Replay again").is_none());

    // One that is cancelled leaves the answer that was there.
    apply(&mut harness, command);
    apply(&mut harness, Command::Recorder(RecorderCommand::CancelReplay));
    step_until(&mut harness, "the end", |state| !state.session.recorder_replay.is_running());
    assert!(harness.state().state().session.recorder_replay.ok().is_some());

    // Another vehicle of the Vehicle pane is taken by a click alone.
    assert!(harness.query_by_label("As the struck vehicle of the Vehicle pane").is_some());
    let other = VehicleChoice::Preset("toyota-corolla-2020".to_owned());
    apply(&mut harness, Command::ChooseVehicle(Role::Struck, Box::new(other.clone())));
    harness.run_steps(2);
    let vehicle = |harness: &Harness<'_, App>| {
        harness.state().state().project.replay.as_ref().map(|of| of.vehicle.clone())
    };
    assert_eq!(vehicle(&harness), Some(car.clone()));
    assert!(harness.query_by_label_contains("Of the replay alone").is_some());
    harness.get_by_label("Take the struck vehicle").click();
    harness.run_steps(2);
    assert_eq!(vehicle(&harness), Some(other));
    assert!(harness.query_by_label_contains("Replay again").is_some());
    apply(&mut harness, Command::ChooseVehicle(Role::Struck, Box::new(car.clone())));

    // Asked for again, the same file keeps what was said of it, and its last answer until the next is there.
    let again = RecorderCommand::Replay { path, event: None, car: Role::Struck };
    apply(&mut harness, Command::Recorder(again));
    assert!(harness.state().state().session.recorder_replay.ok().is_some());
    let request = harness.state().state().project.replay.clone().expect("a question");
    assert_eq!((request.steering_ratio, request.event), (Some(14.5), Some(1)));
    assert_eq!(request.vehicle, car);
}

#[test]
fn what_keeps_a_recorder_from_being_replayed_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("report.csv");
    std::fs::write(&path, BEFORE.replace("Steering Input", "Engine Throttle")).expect("a file");
    let mut harness = open(&[]);
    let command = RecorderCommand::Replay { path, event: None, car: Role::Struck };
    apply(&mut harness, Command::Recorder(command));
    step_until(&mut harness, "why", |state| state.session.recorder_replay.problem().is_some());
    harness.run_steps(2);
    let is_said = |harness: &Harness<'_, App>| {
        harness.query_all_by_label_contains("Not replayed: ").next().is_some()
    };
    assert!(is_said(&harness));
    // It says nothing of other settings.
    let asked = harness.state_mut().state_mut().project.replay.as_mut().expect("a question");
    asked.event = Some(1);
    harness.run_steps(2);
    assert!(!is_said(&harness));
}

#[test]
fn the_form_of_a_recorder_has_the_units_of_the_window() {
    for (units, symbol, other) in [(UnitSystem::Si, "km/h", "mph"), (UnitSystem::Us, "mph", "km/h")]
    {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("report.csv");
        std::fs::write(&path, BEFORE).expect("a file");
        let mut harness = open(&[]);
        harness.state_mut().state_mut().view.units = units;
        apply(&mut harness, Command::Open(vec![path]));
        harness.run_steps(4);
        let is_shown =
            |of: &str| harness.query_all_by_label_contains(&format!(" {of} at ")).next().is_some();
        assert!(is_shown(symbol) && !is_shown(other) && !is_shown("m/s"), "{symbol}");
    }
}

fn is_recorder(dialog: &Dialog) -> bool {
    matches!(dialog, Dialog::Recorder(_))
}

#[test]
fn controls_of_a_report_are_a_series() {
    let mut harness = open(&[]);
    apply(&mut harness, Command::Open(vec![REPORT.into()]));
    harness.run_steps(4);
    harness.get_by_label("Controls as a series").click();
    harness.run_steps(2);
    let path = Path::new(REPORT);
    step_until(&mut harness, "the series", |state| {
        state.session.sources.iter().any(|source| source.path == path && source.is_settled())
    });
    assert!(!harness.state().state().session.dialogs.iter().any(is_recorder));
}

#[test]
fn the_stiffness_of_a_crash_test_goes_into_a_vehicle() {
    const TEST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fuzz/corpus/ev5/v1.EV5");
    let mut harness = open(&[]);
    let choice = VehicleChoice::Preset("toyota-corolla-2020".to_owned());
    apply(&mut harness, Command::ChooseVehicle(Role::Striking, Box::new(choice.clone())));
    harness.run_steps(80);
    apply(&mut harness, Command::Open(vec![TEST.into()]));
    step_until(&mut harness, "the test", |state| state.session.dialogs.is_any_open());
    harness.run_steps(4);
    let test = CrashTest::read(Path::new(TEST)).expect("a test");
    let found = BarrierTest::from_crash_test(&test).expect("a stiffness").stiffness();
    let found = found.expect("a stiffness");
    let onset = Quantity::ForcePerLength.shown(found.onset_n_per_m, UnitSystem::Si);
    harness.get_by_label(&onset).click();
    let copied = (0..4).find_map(|_| {
        harness.step();
        harness.output().platform_output.commands.iter().find_map(|command| match command {
            OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        })
    });
    assert_eq!(copied, Some(onset), "a click copies a number, as it does of an answer");
    harness.get_by_label("Stiffness into the vehicle").click();
    harness.run_steps(4);
    let state = harness.state().state();
    let VehicleChoice::Sheet(sheet) = &state.project.simulate.striking else {
        panic!("{:?}", state.project.simulate.striking);
    };
    let front = sheet.crush.front.expect("a front");
    assert_eq!(front.onset_n_per_m, found.onset_n_per_m);
    assert_eq!(front.stiffness_n_per_m2, found.stiffness_n_per_m2);
    apply(&mut harness, Command::Undo);
    assert_eq!(harness.state().state().project.simulate.striking, choice);
}
