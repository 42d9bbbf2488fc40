//! The record of an event data recorder, opened in the window.

use std::path::Path;

use egui_kittest::kittest::Queryable;
use impactlab::app::{Command, Dialog, RecorderCommand};
use impactlab_core::collision::Role;
use impactlab_core::collision::contact::BarrierTest;
use impactlab_core::data::{CrashTest, RecorderRecord, Severity};
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
    harness.run_steps(4);
    harness.get_by_label("Stiffness into the vehicle").click();
    harness.run_steps(4);
    let state = harness.state().state();
    let VehicleChoice::Sheet(sheet) = &state.project.simulate.striking else {
        panic!("{:?}", state.project.simulate.striking);
    };
    let test = CrashTest::read(Path::new(TEST)).expect("a test");
    let found = BarrierTest::from_crash_test(&test).expect("a stiffness").stiffness();
    let found = found.expect("a stiffness");
    let front = sheet.crush.front.expect("a front");
    assert_eq!(front.onset_n_per_m, found.onset_n_per_m);
    assert_eq!(front.stiffness_n_per_m2, found.stiffness_n_per_m2);
    apply(&mut harness, Command::Undo);
    assert_eq!(harness.state().state().project.simulate.striking, choice);
}
