//! The “By hand” pane: what it answers is what the command answers, and the case keeps its question.

use std::ops::ControlFlow;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, CaseCommand, Command, Leaving, Pane};
use impactlab_reconstruct::evidence::Stated;
use impactlab_reconstruct::hand::HandMethod;
use impactlab_study::{HandRequest, Library, Question};

use crate::harness::{apply, open, step_until, type_into};

#[test]
fn a_calculation_by_hand_is_answered_and_kept() {
    let mut harness = open(&[]);
    apply(&mut harness, Command::Show(Pane::Hand));
    harness.run_steps(2);
    assert!(harness.query_all_by_label("Method").next().is_some());

    let mut request = HandRequest::new(HandMethod::Skid);
    let mut state = |key: &str, value: f64| {
        let stated = Stated { value: Some(value), sigma: Some(0.05 * value) };
        request.inputs.insert(key.to_owned(), stated);
    };
    state("distance_m", 30.0);
    harness.state_mut().state_mut().project.hand = Some(request.clone());
    step_until(&mut harness, "what is missing", |state| state.session.hand.problem().is_some());
    let problem = harness.state().state().session.hand.problem().unwrap_or_default().to_owned();
    assert!(problem.contains("drag factor of locked wheels"), "{problem}");

    let friction = Stated { value: Some(0.7), sigma: Some(0.05) };
    request.inputs.insert("friction".to_owned(), friction);
    harness.state_mut().state_mut().project.hand = Some(request.clone());
    step_until(&mut harness, "the answer", |state| state.session.hand.ok().is_some());
    harness.run_steps(2);
    let shown = harness.query_all_by_label_contains("speed at the start of the slide").count();
    assert!(shown > 0);

    let mut go_on = |_: impactlab_study::Event<'_>| ControlFlow::Continue(());
    let answer = request.answer(&Library::default(), &mut go_on).expect("an answer");
    let answer = answer.complete().expect("nobody cancelled");
    let state = harness.state().state();
    assert_eq!(state.session.hand.ok().expect("an answer").report, answer.report);
    let variant = state.project.to_variant("by hand");
    assert!(variant.questions.contains(&request.into()));
    let read = state.project.with_variant(&variant).expect("it is read");
    assert_eq!(read.hand, state.project.hand);
}

/// A crash test asks for its crush energy with one click, and the energy is that of the test.
#[test]
fn the_crush_energy_of_a_crash_test_is_checked_by_hand() {
    const TEST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fuzz/corpus/ev5/v1.EV5");
    let mut harness = open(&[]);
    let entered = Stated { value: Some(1500.0), sigma: None };
    let mut before = HandRequest::new(HandMethod::CrushEnergy);
    before.inputs.insert("mass_1_kg".to_owned(), entered);
    harness.state_mut().state_mut().project.hand = Some(before.clone());
    // What stays for a second can be brought back.
    harness.run_steps(80);
    apply(&mut harness, Command::Open(vec![TEST.into()]));
    step_until(&mut harness, "the test", |state| state.session.dialogs.is_any_open());
    harness.run_steps(4);
    // No vehicle is chosen that could get the stiffness, which is said before a click.
    assert!(harness.query_all_by_label_contains("whose data can be edited").next().is_some());
    harness.get_by_label("Crush energy by hand").click();
    harness.run_steps(2);
    step_until(&mut harness, "the answer", |state| state.session.hand.ok().is_some());
    let state = harness.state().state();
    assert!(!state.session.dialogs.is_any_open());
    let report = &state.session.hand.ok().expect("an answer").report;
    let energy =
        report.results.iter().find(|result| result.key == "energy_1_j").expect("an energy");
    // ½ · 1000 kg · (10 m/s)²; the crush is the same all over the width.
    assert!((energy.value - 50_000.0).abs() < 1.0, "{}", energy.value);
    // What was entered before is not lost without a word.
    assert!(state.session.messages.iter().any(|of| of.text.contains("Undo brings back")));
    apply(&mut harness, Command::Undo);
    assert_eq!(harness.state().state().project.hand.as_ref(), Some(&before));
}

/// The points of a mark that were clicked in the plan are those of the calculation.
#[test]
fn a_yaw_mark_of_the_evidence_gives_its_points() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("yaw.toml");
    let spin = std::fs::read_to_string("tests/data/evidence/spin.toml").expect("evidence");
    // On a circle of 50 m.
    let points: Vec<String> = (0..5)
        .map(|i| {
            let angle = 0.08 * f64::from(i);
            format!("[{:.3}, {:.3}]", 50.0 * angle.sin(), 50.0 * (1.0 - angle.cos()))
        })
        .collect();
    let mark = format!("[[mark]]\nwheel = \"RR\"\npoints_m = [{}]\n", points.join(", "));
    std::fs::write(&path, format!("{spin}\n{mark}")).expect("a file");
    let mut harness = open(&[path.to_str().expect("a plain name")]);
    harness.run_steps(4);
    let mut request = HandRequest::new(HandMethod::YawMark);
    let chord = Stated { value: Some(20.0), sigma: None };
    request.inputs.insert("chord_m".to_owned(), chord);
    let friction = Stated { value: Some(0.7), sigma: Some(0.05) };
    request.inputs.insert("friction".to_owned(), friction);
    harness.state_mut().state_mut().project.hand = Some(request);
    apply(&mut harness, Command::Show(Pane::Hand));
    harness.run_steps(2);
    harness.get_by_label("Take mark 1").click();
    harness.run_steps(2);
    step_until(&mut harness, "the answer", |state| {
        state.session.hand.ok().is_some_and(|answer| answer.report.n_points == 5)
    });
    let report = &harness.state().state().session.hand.ok().expect("an answer").report;
    let radius = report.results.iter().find(|of| of.key == "radius_m").expect("a radius");
    // Half a track less is that of the path of the CG.
    assert!((radius.value - 49.25).abs() < 0.2, "{}", radius.value);
}

/// The points of the mark in the question.
fn points_m(harness: &Harness<'_, App>) -> Vec<[f64; 2]> {
    let request = harness.state().state().project.hand.as_ref().expect("a calculation by hand");
    request.points_m.clone()
}

/// Asks for the speed of a yaw mark.
fn ask_for_yaw_mark(harness: &mut Harness<'_, App>) {
    apply(harness, Command::Show(Pane::Hand));
    let request = HandRequest::new(HandMethod::YawMark);
    harness.state_mut().state_mut().project.hand = Some(request);
    harness.run_steps(3);
}

/// Points could only be clicked.
#[test]
fn points_are_typed_changed_and_removed() {
    let mut harness = open(&[]);
    ask_for_yaw_mark(&mut harness);
    type_into(&mut harness, "x of the next point", "1.5");
    assert!(points_m(&harness).is_empty(), "its y is not known");
    type_into(&mut harness, "y of the next point", "-2");
    assert_eq!(points_m(&harness), [[1.5, -2.0]]);
    type_into(&mut harness, "y of the next point", "8");
    type_into(&mut harness, "x of the next point", "3");
    assert_eq!(points_m(&harness), [[1.5, -2.0], [3.0, 8.0]]);
    type_into(&mut harness, "y of point 1", "4");
    harness.get_by_label("Remove point 2").click();
    harness.run_steps(4);
    assert_eq!(points_m(&harness), [[1.5, 4.0]]);
}

/// A point of which x was typed in one case was completed by y in the next.
#[test]
fn what_is_half_typed_does_not_go_into_another_case() {
    let mut harness = open(&[]);
    ask_for_yaw_mark(&mut harness);
    type_into(&mut harness, "x of the next point", "1.5");
    apply(&mut harness, Command::Case(CaseCommand::LeaveUnasked(Leaving::New)));
    ask_for_yaw_mark(&mut harness);
    type_into(&mut harness, "y of the next point", "-2");
    assert!(points_m(&harness).is_empty(), "its x is of another case");
    type_into(&mut harness, "x of the next point", "3");
    assert_eq!(points_m(&harness), [[3.0, -2.0]]);
}
