//! Panes that have nothing to show say why, and what can be done.

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, Command, Pane, State, Subject};

use crate::harness::{apply, is_idle, open, step_until};

const FORCES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea");

fn says(harness: &Harness<'_, App>, text: &str) -> bool {
    harness.query_all_by_label_contains(text).next().is_some()
}

fn select(harness: &mut Harness<'_, App>, case: &str) {
    let subject = Subject::Case { dataset: FORCES.into(), case: case.to_owned() };
    apply(harness, Command::Select(subject));
    harness.run_steps(4);
}

fn is_simulated(name: &'static str) -> impl Fn(&State) -> bool {
    move |state| state.analysis().is_some_and(|of| of.report.name == name) && is_idle(state)
}

#[test]
fn a_case_whose_data_are_not_open_is_not_called_none() {
    let mut harness = open(&[FORCES]);
    step_until(&mut harness, "the first case", is_simulated("c001"));
    apply(&mut harness, Command::Show(Pane::Scene));
    select(&mut harness, "c999");
    assert!(says(&harness, "fea has no case c999"));
    assert!(!says(&harness, "No case chosen"));

    apply(&mut harness, Command::Close(FORCES.into()));
    select(&mut harness, "c002");
    assert!(says(&harness, "fea is not open") && !says(&harness, "No case chosen"));
    harness.query_all_by_label("Open fea").next().expect("a button").click();
    harness.run_steps(2);
    step_until(&mut harness, "the case", is_simulated("c002"));
    assert!(!says(&harness, "fea is not open"));
}

#[test]
fn panes_without_anything_to_show_say_where_to_begin() {
    let mut harness = open(&[FORCES]);
    step_until(&mut harness, "the model", |state| {
        is_idle(state) && state.session.force.model.current.is_some()
    });
    apply(&mut harness, Command::Close(FORCES.into()));
    for (pane, text) in [
        (Pane::Cases, "Open a data set in the Data pane"),
        (Pane::Comparison, "No trajectory data set is open"),
        (Pane::ReconstructedScene, "Begin in the Evidence pane"),
        (Pane::Speeds, "There is no evidence yet"),
        (Pane::Hand, "Choose a method: "),
        (Pane::Evaluation, "No force data set is open"),
    ] {
        apply(&mut harness, Command::Show(pane));
        harness.run_steps(3);
        assert!(says(&harness, text), "{pane:?}");
    }
}
