//! A case in the window: variants, saving, opening, and what is asked before it is left.

mod chain;
mod example;
mod killed;
mod leaving;
mod names;
mod notes;

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::Key;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{
    App, CaseCommand, Command, Leaving, Output, State, Subject, TaskKey, VariantCommand,
};
use impactlab_core::collision::{ChannelClass, Scenario};
use impactlab_core::data::{Existing, Severity};
use impactlab_core::vehicle::{Braking, Ending};
use impactlab_study::case_file::{CaseFile, Variant, unpack};
use impactlab_study::{CheckRequest, ForceSource, Library, ModelChoice, Report, Request};

use crate::harness::{apply, ask_few_draws, is_idle, open, open_with, state, step_until};

const SCENARIO: &str = "assets/scenarios/pit_right_rear.toml";

/// The scenario in the form, to be edited.
fn scenario<'a>(harness: &'a mut Harness<'_, App>) -> &'a mut Scenario {
    harness.state_mut().state_mut().project.scenario_mut().expect("a scenario")
}

/// The window with the PIT as it is opened, all forecasts answered.
fn pit_as_opened() -> Harness<'static, App> {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the forecast", is_answered);
    harness
}

/// The window with the PIT and a forecast of few draws, for what does not depend on how many there are.
fn pit() -> Harness<'static, App> {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the scenario", is_idle);
    ask_few_draws(&mut harness);
    step_until(&mut harness, "the forecast", is_answered);
    harness
}

fn is_answered(state: &State) -> bool {
    is_idle(state)
        && state.session.response.forecast.ok().is_some()
        && !state.session.response.forecast.is_waiting()
        && state.session.force.forecast.ok().is_some()
        && !state.session.force.forecast.is_waiting()
}

fn save_as(harness: &mut Harness<'_, App>, path: &Path) {
    apply(harness, Command::Write(Output::Case, path.to_owned()));
    step_until(harness, "the case on disk", |state| {
        !state.session.tasks.is_running(&TaskKey::SaveCase) && state.case.path.is_some()
    });
}

fn variant(harness: &mut Harness<'_, App>, command: VariantCommand) {
    apply(harness, Command::Variant(command));
}

/// The answers to a case without a window.
fn answers_of(path: &Path) -> Vec<(String, Vec<Report>)> {
    let case = CaseFile::load(path).expect("a case");
    let report = case.ask(&[], &Library::default(), &mut |_| ControlFlow::Continue(()));
    let report = report.expect("asked").complete().expect("answers");
    assert!(report.is_clean(), "{report:?}");
    let of = |variant: &impactlab_study::case_file::VariantReport| {
        (variant.name.clone(), variant.reports().cloned().collect())
    };
    report.variants.iter().map(of).collect()
}

#[test]
fn variants_have_the_same_numbers_in_the_window_and_without_it_and_in_a_package() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pit.impactlab");
    let mut harness = pit();
    let speed = |state: &State| state.project.scenario().expect("a scenario").struck.vx_world_m_s;
    let before = speed(state(&harness));
    let mut shown = Vec::new();
    for (name, factor) in [("base", 1.0), ("slower", 0.9), ("slow", 0.8)] {
        if name != "base" {
            variant(&mut harness, VariantCommand::Duplicate);
            variant(&mut harness, VariantCommand::Rename(name.to_owned()));
        }
        scenario(&mut harness).struck.vx_world_m_s = before * factor;
        harness.run_steps(2);
        step_until(&mut harness, "the forecast", is_answered);
        let answer = state(&harness).session.response.forecast.ok().expect("a forecast");
        shown.push((name.to_owned(), answer.answer.report.clone()));
    }
    assert!(state(&harness).is_case_changed());
    save_as(&mut harness, &path);
    assert!(!state(&harness).is_case_changed());
    let answers = answers_of(&path);
    assert_eq!(answers.len(), 3);
    for ((name, motion), (variant, reports)) in shown.iter().zip(&answers) {
        assert_eq!(name, variant);
        let found = reports.iter().find_map(|report| match report {
            Report::PredictMotion(report) => Some(report),
            _ => None,
        });
        let same = found.expect("a forecast");
        assert_eq!(serde_json::to_value(same).unwrap(), serde_json::to_value(motion).unwrap());
    }
    // The first variant comes back as it was.
    variant(&mut harness, VariantCommand::Show("base".to_owned()));
    assert_eq!(speed(state(&harness)), before);

    // The package opens elsewhere, with the same numbers.
    let zip = folder.path().join("pit.zip");
    apply(&mut harness, Command::Write(Output::PackedCase, zip.clone()));
    step_until(&mut harness, "the package", |state| !state.session.tasks.is_writing());
    let elsewhere = unpack(&zip, &folder.path().join("elsewhere")).expect("unpacked");
    assert_eq!(answers_of(&elsewhere), answers);
    let text = std::fs::read_to_string(&elsewhere).expect("the case");
    assert!(text.contains("packed into pit.zip"), "{text}");
    assert!(!text.contains(folder.path().to_str().expect("text")), "it says where it was made");
}

/// A package that could not be made stood in the log, which reports print.
#[test]
fn the_log_has_the_packages_that_were_made_and_no_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = pit();
    let is_packed = |state: &State| {
        state.case.file.log.iter().any(|entry| entry.event.starts_with("packed into"))
    };
    let mut pack = |zip: PathBuf, packed: bool| {
        apply(&mut harness, Command::Write(Output::PackedCase, zip));
        step_until(&mut harness, "the package", |state| {
            !state.session.tasks.is_writing() && (is_packed(state) || !packed)
        });
        harness.step();
        assert_eq!(is_packed(state(&harness)), packed);
    };
    pack(folder.path().join("no folder/pit.zip"), false);
    pack(folder.path().join("pit.zip"), true);
}

/// The questions of the first variant of a case file.
fn questions_in(path: &Path) -> Vec<Request> {
    CaseFile::load(path).expect("a case").variants[0].questions.clone()
}

/// Opens a case, and saves it to another file as it is.
fn saved_again(from: &Path, to: &Path) -> Harness<'static, App> {
    let mut harness = open(&[from.to_str().expect("text")]);
    step_until(&mut harness, "the forecast", is_answered);
    assert!(!state(&harness).is_case_changed(), "the case is as it was opened");
    apply(&mut harness, Command::Write(Output::Case, to.to_owned()));
    step_until(&mut harness, "the case on disk", |state| state.case.path.as_deref() == Some(to));
    harness
}

#[test]
fn questions_that_were_edited_in_the_file_are_those_of_the_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let [one, two] = ["one", "two"].map(|name| folder.path().join(format!("{name}.impactlab")));
    save_as(&mut pit(), &one);
    let mut text = fs::read_to_string(&one).expect("a case");
    let before = questions_in(&one);
    for (from, to) in [
        ("\"restitution\": 0.15", "\"restitution\": 0.35"),
        ("\"duration_s\": 4.0", "\"duration_s\": 3.0"),
        ("\"draws\": 20", "\"draws\": 12"),
    ] {
        assert_eq!(text.matches(from).count(), 1, "{from} stands once in {text}");
        text = text.replace(from, to);
    }
    fs::write(&one, &text).expect("edited");
    let (edited, answers) = (questions_in(&one), answers_of(&one));
    assert!(before.iter().zip(&edited).all(|(before, edited)| before != edited), "{edited:?}");

    let mut harness = saved_again(&one, &two);
    let project = &state(&harness).project;
    assert_eq!(project.scenario().expect("a scenario").contact.restitution, Some(0.35));
    assert_eq!((project.simulate.duration_s, project.predict_motion.draws), (3.0, 12));
    assert_eq!(questions_in(&two), edited);
    assert_eq!(answers_of(&two), answers);

    // What is edited in the window is in every question that has it.
    scenario(&mut harness).contact.restitution = Some(0.25);
    harness.step();
    apply(&mut harness, Command::Case(CaseCommand::Save));
    step_until(&mut harness, "the case on disk", |state| !state.is_case_changed());
    let text = serde_json::to_string(&questions_in(&two)).expect("JSON");
    assert_eq!(text.matches("\"restitution\":0.25").count(), 4, "{text}");
}

#[test]
fn questions_for_which_there_is_no_form_stay_in_their_variant() {
    let folder = tempfile::tempdir().expect("a folder");
    let [one, two] = ["one", "two"].map(|name| folder.path().join(format!("{name}.impactlab")));
    save_as(&mut pit(), &one);
    let mut case = CaseFile::load(&one).expect("a case");
    let check = CheckRequest { paths: vec![one.clone()], all: false, map: None };
    let questions = &mut case.variants[0].questions;
    // Two simulations that do not go together, and nothing about the force.
    let mut longer = questions[1].clone();
    if let Request::Simulate(longer) = &mut longer {
        longer.duration_s = 6.0;
    }
    questions.remove(2);
    questions.extend([longer, check.into()]);
    let made = questions.clone();
    case.save(&one, Existing::Replace).expect("written");
    let mut harness = saved_again(&one, &two);
    assert_eq!(questions_in(&two), made);
    harness.state_mut().state_mut().project.simulate.duration_s = 3.0;
    harness.step();
    apply(&mut harness, Command::Case(CaseCommand::Save));
    step_until(&mut harness, "the case on disk", |state| !state.is_case_changed());
    let questions = questions_in(&two);
    assert!(made[3..].iter().all(|question| questions.contains(question)), "{questions:?}");
}

#[test]
fn a_case_of_version_1_is_its_questions_and_what_only_its_forms_say() {
    let old = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/cases/version-1.impactlab");
    let folder = tempfile::tempdir().expect("a folder");
    let new = folder.path().join("new.impactlab");
    let harness = saved_again(&old, &new);
    let project = &state(&harness).project;
    // The questions were edited; the forms have 0.15.
    assert_eq!(project.scenario().expect("a scenario").contact.restitution, Some(0.35));
    assert_eq!(project.beside.channel_class, Some(ChannelClass::Cfc60));
    assert_eq!(project.beside.start.speed_m_s, Some(12.5));
    assert_eq!(questions_in(&new), questions_in(&old));
    let text = fs::read_to_string(&new).expect("a case");
    assert!(text.contains("\"version\": 2") && !text.contains("\"forms\""), "{text}");
    assert_eq!(text.matches("\"restitution\"").count(), 1, "{text}");
    assert_eq!(answers_of(&new), answers_of(&old));
}

#[test]
fn what_is_entered_for_another_subject_is_kept_with_the_case() {
    let folder = tempfile::tempdir().expect("a folder");
    let [force, path] = ["force.csv", "one.impactlab"].map(|name| folder.path().join(name));
    fs::copy("datasets/fea/forces/c001.csv", &force).expect("a force");
    let mut harness = open(&[force.to_str().unwrap()]);
    step_until(&mut harness, "the force", is_idle);
    let brake = Some(Braking::new(0.7, 0.8, 0.2));
    let project = &mut harness.state_mut().state_mut().project;
    project.start_mut().speed_m_s = Some(12.5);
    project.simulate.ending = Some(Ending { brake, ..Ending::default() });
    apply(&mut harness, Command::Select(Subject::Scenario));
    assert_eq!(state(&harness).project.simulate.ending, None, "a scenario says it itself");
    let project = &mut harness.state_mut().state_mut().project;
    project.pulse_mut().duration_s = 0.12;
    project.scenario_mut().expect("a scenario").contact.restitution = Some(0.25);
    apply(&mut harness, Command::Select(Subject::File(force.clone())));
    step_until(&mut harness, "the force", is_idle);
    save_as(&mut harness, &path);
    let mut harness = open(&[path.to_str().unwrap()]);
    step_until(&mut harness, "the force", is_idle);
    let project = &state(&harness).project;
    assert_eq!((project.start().speed_m_s, &project.beside.ending), (Some(12.5), &None));
    assert!(project.simulate.ending.is_some());
    assert_eq!(project.scenario().expect("a scenario").contact.restitution, Some(0.25));
    apply(&mut harness, Command::Select(Subject::Scenario));
    assert_eq!(harness.state_mut().state_mut().project.pulse_mut().duration_s, 0.12);
    assert!(state(&harness).project.beside.ending.is_some());
}

#[test]
fn a_case_that_is_saved_before_its_data_are_read_keeps_its_questions() {
    let folder = tempfile::tempdir().expect("a folder");
    let [force, one, two] =
        ["force.csv", "one.impactlab", "two.impactlab"].map(|name| folder.path().join(name));
    fs::copy("datasets/fea/forces/c001.csv", &force).expect("a force");
    let mut harness = open(&[force.to_str().unwrap()]);
    step_until(&mut harness, "the forecast", |state| {
        is_idle(state) && state.session.response.forecast.ok().is_some()
    });
    save_as(&mut harness, &one);
    let questions = CaseFile::load(&one).expect("a case").variants[0].questions.clone();
    assert_eq!(questions.len(), 2, "{questions:?}");
    // Another window saves it again before it has read anything.
    let mut harness = open(&[one.to_str().unwrap()]);
    apply(&mut harness, Command::Write(Output::Case, two.clone()));
    step_until(&mut harness, "the case on disk", |state| state.case.path.as_ref() == Some(&two));
    assert_eq!(CaseFile::load(&two).expect("a case").variants[0].questions, questions);
}

#[test]
fn a_change_of_variant_cannot_be_undone_into_another() {
    let mut harness = pit();
    variant(&mut harness, VariantCommand::Duplicate);
    harness.state_mut().state_mut().project.simulate.duration_s = 2.0;
    harness.run_steps(90); // the past takes a second to settle
    harness.state_mut().state_mut().project.simulate.duration_s = 3.0;
    harness.run_steps(90);
    variant(&mut harness, VariantCommand::Show("base".to_owned()));
    let base = state(&harness).project.simulate.duration_s;
    harness.run_steps(90);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
    harness.run_steps(4);
    assert_eq!(state(&harness).project.simulate.duration_s, base);
    variant(&mut harness, VariantCommand::Show("base 2".to_owned()));
    assert_eq!(state(&harness).project.simulate.duration_s, 3.0);
    // A name that another variant has is refused, and the last variant stays.
    variant(&mut harness, VariantCommand::Rename("base".to_owned()));
    assert_eq!(state(&harness).case.file.shown, "base 2");
    variant(&mut harness, VariantCommand::Remove);
    variant(&mut harness, VariantCommand::Remove);
    assert_eq!(state(&harness).case.file.variants.len(), 1);
}

#[test]
fn a_case_that_is_not_saved_is_asked_about_before_it_is_left() {
    let folder = tempfile::tempdir().expect("a folder");
    let [one, two] = ["one", "two"].map(|name| folder.path().join(format!("{name}.impactlab")));
    let mut harness = pit();
    save_as(&mut harness, &one);
    save_as(&mut harness, &two);
    harness.state_mut().state_mut().project.simulate.duration_s = 2.0;
    harness.step();
    apply(&mut harness, Command::Open(vec![one.clone()]));
    harness.run_steps(3);
    harness.get_by_label("The case \"two\" has changes that are not in its file.");
    harness.get_by_label("Stay").click();
    harness.run_steps(3);
    assert_eq!(state(&harness).project.simulate.duration_s, 2.0);
    assert_eq!(state(&harness).case.path.as_ref(), Some(&two));

    // Saved on the way, it is found as it was left.
    apply(&mut harness, Command::Open(vec![one.clone()]));
    harness.run_steps(3);
    harness.get_by_label("Save the case").click();
    step_until(&mut harness, "the other case", |state| state.case.path.as_ref() == Some(&one));
    assert_ne!(state(&harness).project.simulate.duration_s, 2.0);
    step_until(&mut harness, "nothing unsaved", |state| !state.is_case_changed());
    apply(&mut harness, Command::Open(vec![two.clone()]));
    step_until(&mut harness, "the saved case", |state| state.case.path.as_ref() == Some(&two));
    assert_eq!(state(&harness).project.simulate.duration_s, 2.0);
    assert_eq!(state(&harness).project.subject(), Some(Subject::Scenario));
    assert_eq!(state(&harness).view.recent, [two, one]);
}

#[test]
fn a_file_that_somebody_else_has_changed_is_not_replaced_unasked() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pit.impactlab");
    let mut harness = pit();
    save_as(&mut harness, &path);
    harness.state_mut().state_mut().project.simulate.duration_s = 2.0;
    fs::write(&path, "theirs").expect("written");
    apply(&mut harness, Command::Case(CaseCommand::Save));
    harness.run_steps(3);
    harness.get_by_label("Replace pit.impactlab?");
    let said = &state(&harness).session.messages.last().expect("a message").text;
    assert!(said.contains("pit.impactlab was changed by somebody else"), "{said}");
    harness.get_by_label("Keep it").click();
    harness.run_steps(3);
    assert_eq!(fs::read_to_string(&path).expect("text"), "theirs");
    assert!(state(&harness).is_case_changed());
}

#[test]
fn a_case_that_reads_elsewhere_is_asked_about_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("case/a.impactlab");
    fs::create_dir(folder.path().join("case")).expect("a folder");
    let check = CheckRequest { paths: vec![folder.path().join("secret")], all: false, map: None };
    let questions = vec![check.into()];
    let variant = Variant { name: "base".to_owned(), questions, ..Variant::default() };
    CaseFile::new("a", variant).save(&path, Existing::Refuse).expect("written");
    let mut harness = pit_as_opened();
    let open = Command::Open(vec![path.clone()]);
    apply(&mut harness, open.clone());
    harness.run_steps(3);
    harness.get_by_label("Open a.impactlab?");
    harness.get_by_label("Do not open").click();
    harness.run_steps(3);
    assert_eq!(state(&harness).case.path, None);
    apply(&mut harness, open.clone());
    harness.run_steps(3);
    harness.get_by_label("Open and allow this").click();
    harness.run_steps(3);
    assert_eq!(state(&harness).case.path.as_ref(), Some(&path));
    // What was allowed is remembered, over a restart too.
    let (restored, _) = State::restore(&state(&harness).save().expect("text")).expect("a state");
    *harness.state_mut().state_mut() = restored;
    apply(&mut harness, Command::Case(CaseCommand::LeaveUnasked(Leaving::New)));
    apply(&mut harness, open);
    harness.run_steps(3);
    assert_eq!(state(&harness).case.path.as_ref(), Some(&path));
    assert!(!state(&harness).session.dialogs.is_any_open());
}

#[test]
fn a_training_that_runs_is_asked_about_before_the_window_closes() {
    let mut harness = open(&["datasets/trajectories-fea"]);
    step_until(&mut harness, "the data", is_idle);
    assert!(state(&harness).reasons_to_stay(&Leaving::Quit).is_empty());
    let path = state(&harness).session.sources[0].path.clone();
    apply(&mut harness, Command::ReplayDataset(path.clone()));
    let reasons = state(&harness).reasons_to_stay(&Leaving::Quit);
    assert!(
        reasons.iter().any(|reason| reason.contains("simulation of a data set")),
        "{reasons:?}"
    );
    apply(&mut harness, Command::Case(CaseCommand::Leave(Leaving::Quit)));
    harness.run_steps(3);
    harness.get_by_label("Quit impactlab?");
    harness.get_by_label("Stay").click();
    harness.run_steps(3);
    assert!(!state(&harness).session.may_close);
    apply(&mut harness, Command::CancelReplay(path));
    step_until(&mut harness, "the end", |state| state.reasons_to_stay(&Leaving::Quit).is_empty());
}

/// Of two saves in quick succession, the first was dropped, and neither was waited for when the window
/// ended.
#[test]
fn what_is_not_saved_is_there_again_after_a_restart() {
    let folder = tempfile::tempdir().expect("a folder");
    let (store, path) = (folder.path().join("state.json"), folder.path().join("pit.impactlab"));
    let mut harness = open_with(&[SCENARIO], Some(store.clone()));
    step_until(&mut harness, "the forecast", is_answered);
    save_as(&mut harness, &path);
    variant(&mut harness, VariantCommand::Duplicate);
    harness.state_mut().state_mut().project.simulate.duration_s = 2.0;
    step_until(&mut harness, "the stored state", |_| {
        fs::read_to_string(&store).is_ok_and(|text| text.contains("\"duration_s\":2.0"))
    });
    // Killed: no exit is gone through.
    std::mem::forget(harness);
    let copy = folder.path().join("state-2.json");
    fs::copy(&store, &copy).expect("a copy");
    let harness = open_with(&[], Some(copy));
    assert_eq!(state(&harness).project.simulate.duration_s, 2.0);
    assert_eq!(state(&harness).case.file.shown, "base 2");
    assert_eq!(state(&harness).case.path, Some(path));
    assert!(state(&harness).is_case_changed());
}

#[test]
fn without_a_file_dialog_a_path_is_asked_for_in_the_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("typed");
    let mut harness = pit();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::S);
    step_until(&mut harness, "the question for a path", |state| {
        state.session.dialogs.is_any_open()
    });
    let field = harness.get_by_label("Path");
    field.focus();
    harness.run_steps(2);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    harness.get_by_label("Path").type_text(path.to_str().expect("text"));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    let written = path.with_extension("impactlab");
    step_until(&mut harness, "the case", |state| state.case.path.is_some());
    assert_eq!(state(&harness).case.path.as_ref(), Some(&written));
    assert!(CaseFile::load(&written).is_ok());
}

#[test]
fn a_message_that_is_dismissed_stays_in_the_list() {
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the scenario", is_idle);
    for text in ["the first", "the second"] {
        apply(&mut harness, Command::Say(Severity::Warning, text.to_owned()));
    }
    harness.get_by_label("Dismiss").click();
    harness.run_steps(3);
    harness.get_by_label("Warning: the first");
    apply(&mut harness, Command::ShowMessages);
    harness.run_steps(3);
    harness.get_by_label("the second");
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(!state(&harness).session.dialogs.is_any_open());
}
