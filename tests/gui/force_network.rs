//! Tests of the force network in the window, with a small model that is trained within seconds.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{
    App, Command, NamedCollision, Network, Output, Pane, State, Subject, TrainingCommand,
    collision_of,
};
use impactlab_core::data::{Dataset, Existing, Severity};
use impactlab_networks::force::{ForceCase, ForceConfig, ForceScenario, train};
use impactlab_networks::learning::{ModelFile, TrainSettings, TrainingSet};
use impactlab_study::{ConfigChoice, ForceEvaluation};

use crate::few_cases::few_cases;
use crate::harness::{apply, is_idle, open, open_with, state, step_until};
use crate::pictures::save;
use crate::settings::{QUICK_CRUSH, SMALL_FORCE};

/// A training within a second that gives a network good enough to be drawn.
const EPOCHS: &str = "\
[training]
epochs = 8
learning_rate = 3e-3
checkpoint_epochs = 1
";

/// Cases of a training of which nothing but its course in the window is looked at: its physics is fitted before
/// the first epoch, and takes as long as there are cases.
const N_CASES: usize = 24;

struct Small {
    folder: tempfile::TempDir,
}

impl Small {
    fn config(&self) -> PathBuf {
        self.folder.path().join("small.toml")
    }

    fn model(&self) -> PathBuf {
        self.folder.path().join("small.safetensors")
    }
}

/// Returns a model that is trained on the shipped cases, once for all tests.
fn small() -> &'static Small {
    static SMALL_MODEL: OnceLock<Small> = OnceLock::new();
    SMALL_MODEL.get_or_init(|| {
        let small = Small { folder: tempfile::tempdir().expect("a folder") };
        std::fs::write(small.config(), [SMALL_FORCE, EPOCHS, QUICK_CRUSH].concat())
            .expect("a file");
        let mut go_on = |_| ControlFlow::Continue(());
        let dataset = Dataset::load(
            Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")),
            &mut go_on,
        )
        .expect("shipped data");
        let (cases, _) = ForceCase::from_dataset(&dataset.complete().expect("nothing cancels"));
        let set = TrainingSet::from_split("fea", &cases, 0, 0.25);
        let config = ForceConfig::load(&small.config()).expect("a good file");
        let settings = TrainSettings { config, seed: 0, checkpoint: None, resume: false };
        let model = train(&set, &settings, &mut |_| ControlFlow::Continue(())).expect("a model");
        model.save(&small.model(), Existing::Refuse).expect("it is written");
        small
    })
}

/// The collision in the form of the force prediction.
fn collision(harness: &Harness<'_, App>) -> NamedCollision {
    let State { project, session, .. } = state(harness);
    collision_of(&project.predict_force, &session.sources).expect("a collision")
}

/// Changes it as its form does.
fn edit_collision(harness: &mut Harness<'_, App>, edit: impl FnOnce(&mut ForceScenario)) {
    let mut edited = collision(harness);
    edit(&mut edited.numbers);
    edited.put_into(&mut harness.state_mut().state_mut().project.predict_force);
}

/// Opens the window on the shipped force data with the small model and selects a case.
fn open_on(case: &str) -> Harness<'static, App> {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the data", is_idle);
    apply(&mut harness, Command::Open(vec![small().model()]));
    let subject = Subject::Case {
        dataset: concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea").into(),
        case: case.to_owned(),
    };
    apply(&mut harness, Command::Select(subject));
    apply(&mut harness, Command::Show(Pane::ForcePrediction));
    step_until(&mut harness, "a forecast", is_forecast_current);
    harness
}

/// Whether the forecast that is shown answers the current question.
fn is_forecast_current(state: &State) -> bool {
    let forecast = &state.session.force.forecast;
    let is_current = forecast.question.as_ref() == state.force_request().as_ref();
    is_current && !forecast.is_waiting() && forecast.ok().is_some() && is_idle(state)
}

#[test]
fn a_case_is_predicted_edited_and_left_open() {
    let mut harness = open_on("c002");
    let recorded = state(&harness).session.force.recorded.as_ref().expect("a recorded force");
    assert_eq!(recorded.case, "c002");
    assert_eq!(collision(&harness).numbers, recorded.scenario);
    // With this seed the case belongs to the test part.
    harness.get_by_label("c002, as recorded; the model has not seen it");
    harness.get_by_label("Copy table").click();
    save(&mut harness, "prediction.png");

    // The prediction follows the selection in the case table.
    harness.key_press(egui::Key::ArrowDown);
    step_until(&mut harness, "the next case", |state| {
        let collision = collision_of(&state.project.predict_force, &state.session.sources);
        collision.is_some_and(|collision| collision.name == "c003") && is_forecast_current(state)
    });
    // A heavier striking vehicle gives a larger impulse. A mass far above those of the training is
    // reported.
    let sizes = [1600.0, 2400.0].map(|mass_kg| {
        edit_collision(&mut harness, |numbers| numbers.mass_kg[1] = mass_kg);
        step_until(&mut harness, "another forecast", is_forecast_current);
        let answer = state(&harness).force_forecast().expect("a forecast");
        answer.report.impulse_n_s.magnitude.median
    });
    assert!(sizes[1] > sizes[0], "{sizes:?}");
    assert!(
        harness
            .query_by_label_contains("outside the domain: mass of the striking vehicle")
            .is_none()
    );
    edit_collision(&mut harness, |numbers| numbers.mass_kg[1] = 9000.0);
    step_until(&mut harness, "a forecast far off", is_forecast_current);
    harness.get_by_label_contains("outside the domain: mass of the striking vehicle 9000 kg");

    // An unknown contact point is averaged over, and random curves are drawn.
    apply(&mut harness, Command::PredictCase);
    harness.get_by_label("contact unknown").click();
    harness.get_by_label("Draw").click();
    harness.run_steps(2);
    step_until(&mut harness, "an open contact", is_forecast_current);
    let answer = state(&harness).force_forecast().expect("a forecast");
    assert!(answer.report.is_contact_open && !answer.report.is_body_open);
    assert_eq!(answer.forecast.curves.len(), 10);
    {
        let state = harness.state_mut().state_mut();
        (state.view.dark, state.view.force.pulses, state.view.force.physics) = (true, true, true);
    }
    harness.run_steps(2);
    save(&mut harness, "prediction-dark.png");
}

/// The time that such frames take is measured by `benches/window.rs`.
#[test]
fn the_forecast_stays_while_the_scenario_changes() {
    let mut harness = open_on("c002");
    harness.state_mut().state_mut().project.predict_force.samples = 20;
    step_until(&mut harness, "drawn curves", is_forecast_current);
    for i in 0..60 {
        let velocity_m_s = 3.0 + 0.02 * f64::from(i);
        edit_collision(&mut harness, |numbers| numbers.striking_velocity_m_s[1] = velocity_m_s);
        harness.step();
        let curves = state(&harness).force_forecast().map(|answer| answer.forecast.curves.len());
        assert_eq!(curves, Some(20), "frame {i}");
    }
    step_until(&mut harness, "the last forecast", is_forecast_current);
}

#[test]
fn the_scenario_is_predicted_and_undone() {
    let mut harness = open_on("c001");
    harness.run_steps(90); // the past takes a second to settle
    let before = collision(&harness).numbers;
    harness.get_by_label("From the scenario").click();
    harness.run_steps(2);
    step_until(&mut harness, "the scenario", is_forecast_current);
    assert_ne!(collision(&harness).numbers, before);
    harness.get_by_label_contains("edited or without a recording");
    harness.run_steps(90);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(2);
    assert_eq!(collision(&harness).numbers, before);
}

#[test]
fn a_model_is_trained_paused_cancelled_saved_and_there_after_a_restart() {
    let folder = tempfile::tempdir().expect("a folder");
    let state_file = folder.path().join("state.json");
    let forces = few_cases(folder.path(), "fea", N_CASES);
    let mut harness = open_with(&[forces.as_str()], Some(state_file.clone()));
    step_until(&mut harness, "the data", is_idle);
    apply(&mut harness, Command::Show(Pane::Training));
    {
        let form = &mut harness.state_mut().state_mut().project.networks.train_force;
        form.epochs = Some(100_000);
        form.training.config = ConfigChoice::File(small().config());
    }
    harness.run_steps(2);
    harness.get_by_label("Train").click();
    step_until(&mut harness, "an epoch", |state| state.session.force.training.history.len() > 2);
    harness.get_by_label("Pause").click();
    harness.run_steps(2);
    assert!(state(&harness).session.force.training.run.is_paused());
    // A paused training first completes the current epoch.
    let is_at_rest = |state: &State| state.session.force.training.run.is_at_rest();
    step_until(&mut harness, "the end of the epoch", is_at_rest);
    let n_epochs = state(&harness).session.force.training.history.len();
    harness.run_steps(20);
    assert!(is_at_rest(state(&harness)));
    assert_eq!(state(&harness).session.force.training.history.len(), n_epochs, "it went on");
    harness.get_by_label_contains("paused: epoch");
    harness.get_by_label("Resume").click();
    step_until(&mut harness, "more epochs", |state| {
        state.session.force.training.history.len() > n_epochs + 2
    });
    save(&mut harness, "training.png");
    harness.get_by_label("Cancel").click();
    step_until(&mut harness, "the end", |state| !state.session.force.training.run.is_running());
    assert!(state(&harness).session.force.training.is_over);
    let current = |harness: &Harness<'_, App>| {
        let current = state(harness).session.force.model.current.as_ref().expect("a model");
        (current.name.clone(), current.is_saved)
    };
    // The model of a cancelled training is used only when the user asks for it.
    assert_eq!(current(&harness), ("shipped".to_owned(), true));
    harness.get_by_label("Use it").click();
    harness.run_steps(2);
    let (name, _) = current(&harness);
    assert!(name.starts_with("trained on fea"), "{name}");
    assert!(harness.query_by_label("Use it").is_none());

    let path = folder.path().join("mine.safetensors");
    apply(&mut harness, Command::Write(Output::Model(Network::Force), path.clone()));
    step_until(&mut harness, "the file", |state| !state.session.force.model.is_saving());
    assert_eq!(state(&harness).project.predict_force.model.path(), Some(path.as_path()));
    harness.run_steps(90);
    step_until(&mut harness, "the saved state", |_| state_file.exists());
    drop(harness);
    let mut harness = open_with(&[], Some(state_file));
    step_until(&mut harness, "the model again", |state| {
        state.session.force.model.current.as_ref().is_some_and(|m| m.name == "mine.safetensors")
    });
}

#[test]
fn a_running_training_learns_from_the_data_in_use_and_shows_its_own_losses_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let paths = ["fea-road", "fea"].map(|name| few_cases(folder.path(), name, N_CASES));
    let mut harness = open(&[&*paths[0], &*paths[1]]);
    step_until(&mut harness, "the data", is_idle);
    apply(&mut harness, Command::List(paths[1].as_str().into()));
    apply(&mut harness, Command::Show(Pane::Training));
    {
        let form = &mut harness.state_mut().state_mut().project.networks.train_force;
        form.epochs = Some(100_000);
        form.training.config = ConfigChoice::File(small().config());
    }
    let command = |command| Command::Train(Network::Force, command);
    let context = harness.ctx.clone();
    harness.state_mut().apply(command(TrainingCommand::Start), &context);
    // It stops at its first report, before any epoch.
    harness.state_mut().apply(command(TrainingCommand::Pause(true)), &context);
    let is_at_rest = |state: &State| state.session.force.training.run.is_at_rest();
    step_until(&mut harness, "the first report", is_at_rest);
    assert_eq!(state(&harness).session.force.training.data, "fea");
    assert!(harness.query_by_label_contains("Losses while training on").is_none());
    harness.get_by_label("The losses of this training are drawn here from its first epoch on.");
    apply(&mut harness, command(TrainingCommand::Pause(false)));
    step_until(&mut harness, "an epoch", |state| state.session.force.training.history.len() > 2);
    harness.get_by_label_contains("Losses while training on fea");
    apply(&mut harness, command(TrainingCommand::Cancel));
    step_until(&mut harness, "the end", |state| !state.session.force.training.run.is_running());
}

/// A trial of a few epochs took the place of the shipped network in the variant, and its answer moved.
#[test]
fn a_training_changes_no_answer_about_a_scenario_until_it_is_put_into_use() {
    let folder = tempfile::tempdir().expect("a folder");
    let forces = few_cases(folder.path(), "fea", N_CASES);
    let mut harness = open(&[forces.as_str()]);
    step_until(&mut harness, "the data", is_idle);
    apply(&mut harness, Command::Select(Subject::Scenario));
    apply(&mut harness, Command::Show(Pane::Training));
    step_until(&mut harness, "the scenario", is_idle);
    let asked = state(&harness).project.predict_force.model.clone();
    let form = &mut harness.state_mut().state_mut().project.networks.train_force;
    form.epochs = Some(2);
    form.training.config = ConfigChoice::File(small().config());
    apply(&mut harness, Command::Train(Network::Force, TrainingCommand::Start));
    step_until(&mut harness, "the end", |state| {
        let force = &state.session.force;
        !force.training.run.is_running() && force.model.set_aside.is_some()
    });
    assert_eq!(state(&harness).project.predict_force.model, asked);
    let is_said = |state: &State| {
        let mut messages = state.session.messages.iter();
        messages.any(|message| message.text.contains("changes no answer about the scenario"))
    };
    assert!(is_said(state(&harness)));
    harness.run_steps(2);
    harness.get_by_label("Use it").click();
    harness.run_steps(2);
    assert_ne!(state(&harness).project.predict_force.model, asked);
}

#[test]
fn a_bad_model_and_bad_settings_say_what_is_wrong() {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the data", is_idle);
    apply(&mut harness, Command::Open(vec!["no/such.safetensors".into()]));
    step_until(&mut harness, "the error", |state| {
        state
            .session
            .messages
            .iter()
            .any(|m| m.severity == Severity::Error && m.text.contains("no/such.safetensors"))
    });
    let form = &mut harness.state_mut().state_mut().project.networks.train_force;
    form.training.config = ConfigChoice::File("Cargo.toml".into());
    apply(&mut harness, Command::Train(Network::Force, TrainingCommand::Start));
    step_until(&mut harness, "the problem", |state| !state.session.force.training.run.is_running());
    let problem = state(&harness).session.force.training.problem.clone().expect("a problem");
    assert!(problem.contains("Cargo.toml:") && problem.contains("unknown field"), "{problem}");
}

#[test]
fn a_model_is_evaluated_beside_the_baselines() {
    let mut harness = open_on("c001");
    apply(&mut harness, Command::Show(Pane::Evaluation));
    harness.run_steps(2);
    harness.get_by_label("Evaluate").click();
    harness.run_steps(2);
    assert!(state(&harness).session.force.evaluation.is_running());
    step_until(&mut harness, "the evaluation", |state| {
        !state.session.force.evaluation.is_running()
    });
    let answer = state(&harness).session.force.evaluation.ok().expect("an evaluation");
    let ForceEvaluation::Cases(report) = &answer.report.report else { panic!("folds") };
    let cases = answer.cases.as_ref().expect("single cases");
    assert_eq!((report.n_test, report.n_trained_on), (25, 0));
    assert_eq!((cases.all.len(), cases.samples.len()), (25, 6));
    harness.get_by_label_contains("on 25 cases of fea");
    assert!(harness.query_all_by_label("Gaussian processes").count() >= 2);
    harness.run_steps(4);
    save(&mut harness, "evaluation.png");
    harness.get_by_label("Copy as Markdown").click();
    harness.run_steps(2);
    harness.state_mut().state_mut().view.dark = true;
    // The tall window also shows what otherwise needs scrolling.
    harness.set_size(egui::vec2(1440.0, 1700.0));
    harness.run_steps(6);
    save(&mut harness, "evaluation-dark.png");
}

#[test]
fn the_collision_follows_the_scenario_until_it_is_edited() {
    let mut harness = open(&[]);
    apply(&mut harness, Command::Select(Subject::Scenario));
    step_until(&mut harness, "the scenario", is_idle);
    apply(&mut harness, Command::PredictScenario);
    harness.run_steps(2);
    let mass_kg = |harness: &Harness<'_, App>| collision(harness).numbers.mass_kg[0];
    for of_struck in [1500.0, 1800.0] {
        harness
            .state_mut()
            .state_mut()
            .project
            .scenario_mut()
            .expect("a scenario")
            .struck
            .mass_kg = of_struck;
        harness.run_steps(2);
        assert_eq!(mass_kg(&harness), of_struck, "the mass of the scenario");
    }
    edit_collision(&mut harness, |numbers| numbers.mass_kg[0] = 1234.0);
    harness.run_steps(2);
    harness.state_mut().state_mut().project.scenario_mut().expect("a scenario").struck.mass_kg =
        2000.0;
    harness.run_steps(2);
    assert_eq!(mass_kg(&harness), 1234.0, "what was edited stays");
}
