//! The “By hand” pane: what it answers is what the command answers, and the case keeps its question.

use std::ops::ControlFlow;

use egui_kittest::kittest::Queryable;
use impactlab::app::{Command, Pane};
use impactlab_reconstruct::evidence::Stated;
use impactlab_reconstruct::hand::HandMethod;
use impactlab_study::{HandRequest, Library, Question};

use crate::harness::{apply, open, step_until};

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
    let shown = harness.query_all_by_label_contains("speed at the begin of the slide").count();
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
