//! Tests of the response network in the window: forecasts by the shipped model, a small training
//! and a small comparison.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use impactlab::app::{
    App, Command, DensityChoice, Network, Output, Pane, PlaybackCommand, State, Subject,
    TrainingMode,
};
use impactlab_study::{ConfigChoice, ForceSource, ModelChoice};

use crate::few_cases::few_cases;
use crate::harness::{apply, is_idle, open, open_with, state, step_until};
use crate::pictures::save;
use crate::settings::SMALL_RESPONSE;

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/trajectories-fea");

fn select(harness: &mut Harness<'_, App>, dataset: &str, case: &str) {
    let subject = Subject::Case { dataset: dataset.into(), case: case.to_owned() };
    apply(harness, Command::Select(subject));
    step_until(harness, "the forecast of the case", |state| {
        let forecast = state.motion_forecast();
        is_idle(state) && forecast.is_some_and(|of| of.answer.report.scenario == case)
    });
}

/// Whether the density that is shown is that of the current time or window.
fn is_density_current(state: &State, window_s: [f64; 2]) -> bool {
    let density = state.session.response.density.ok();
    density.map(|density| &density.map).is_some_and(|map| {
        map.window_s.iter().zip(window_s).all(|(got, wanted)| (got - wanted).abs() < 0.006)
    })
}

#[test]
fn a_recorded_case_is_forecast_with_density_and_bands() {
    let mut harness = open(&[DATA]);
    step_until(&mut harness, "the data", is_idle);
    apply(&mut harness, Command::Show(Pane::MotionForecast));
    select(&mut harness, DATA, "FE_c026");
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(2.0)));
    step_until(&mut harness, "the density", |state| is_density_current(state, [2.0, 2.0]));
    harness.get_by_label_contains("FE_c026: position after 2.00 s");
    harness.get_by_label_contains("still moving");
    save(&mut harness, "motion-forecast.png");

    harness.get_by_label("follow").click();
    harness.run_steps(4);
    save(&mut harness, "motion-forecast-follow.png");
    harness.get_by_label("follow").click();
    harness.run_steps(2);

    // The density over a window is shown in the dark theme and in US units.
    {
        let state = harness.state_mut().state_mut();
        state.view.response.density = DensityChoice::Window;
        state.view.dark = true;
        state.view.units = impactlab_core::units::UnitSystem::Us;
    }
    step_until(&mut harness, "the window", |state| is_density_current(state, [0.0, 3.99]));
    harness.run_steps(4);
    save(&mut harness, "motion-forecast-dark.png");
}

#[test]
fn a_predicted_force_spreads_the_forecast_and_playing_moves_it() {
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea"), DATA]);
    step_until(&mut harness, "the data", is_idle);
    apply(&mut harness, Command::Show(Pane::MotionForecast));
    select(&mut harness, concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea"), "c002");
    let area = |state: &State| {
        let answer = &state.motion_forecast().expect("a forecast").answer;
        answer.forecast.outcome.region_90_m2.expect("a region")
    };
    let given = area(state(&harness));
    harness.get_by_label("as predicted").click();
    harness.run_steps(2);
    step_until(&mut harness, "the predicted force", |state| {
        state.motion_forecast().is_some_and(|of| of.is_predicted())
    });
    // The road is uncertain under either force.
    assert!(area(state(&harness)) > 1.2 * given, "{} {given}", area(state(&harness)));
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(1.0)));
    apply(&mut harness, Command::Playback(PlaybackCommand::Toggle));
    harness.run_steps(20);
    assert!(
        state(&harness).session.playback.time_s > 1.2,
        "{}",
        state(&harness).session.playback.time_s
    );
    apply(&mut harness, Command::Playback(PlaybackCommand::Toggle));
    let time_s = state(&harness).session.playback.time_s;
    step_until(&mut harness, "the density", |state| is_density_current(state, [time_s; 2]));
    harness.run_steps(4);
    save(&mut harness, "motion-forecast-predicted.png");
    // What is done within a second is undone at once.
    harness.run_steps(90);
    // A trajectory does not describe its collision. The given force is shown instead, and a message
    // says so.
    select(&mut harness, DATA, "FE_c002");
    harness.get_by_label_contains("The collision is not known here");
    // The choice of force can be undone.
    harness.run_steps(90);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
    harness.run_steps(2);
    let force = &state(&harness).project.predict_motion.force;
    assert!(matches!(force, ForceSource::Predicted(_)), "{force:?}");
}

/// The time that such frames take is measured by `benches/window.rs`.
#[test]
fn forecast_and_density_stay_while_time_runs() {
    let mut harness = open(&[DATA]);
    step_until(&mut harness, "the data", is_idle);
    apply(&mut harness, Command::Show(Pane::MotionForecast));
    select(&mut harness, DATA, "FE_c002");
    step_until(&mut harness, "a density", |state| state.session.response.density.ok().is_some());
    for i in 0..60 {
        apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(0.05 * f64::from(i))));
        harness.step();
        let state = state(&harness);
        assert!(state.motion_forecast().is_some(), "frame {i}: no forecast");
        assert!(state.session.response.density.ok().is_some(), "frame {i}: no density");
    }
    step_until(&mut harness, "the density", |state| is_density_current(state, [2.95; 2]));
}

#[test]
fn a_response_model_is_trained_paused_cancelled_and_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let config = folder.path().join("small.toml");
    std::fs::write(&config, SMALL_RESPONSE.replace("epochs = 2", "epochs = 400")).expect("a file");
    let mut harness = open_with(&[DATA], Some(folder.path().join("state.json")));
    step_until(&mut harness, "the data", is_idle);
    apply(&mut harness, Command::ShowTraining(Network::Response));
    {
        let form = &mut harness.state_mut().state_mut().project.networks;
        (form.mode, form.fine_tune.trajectories) = (TrainingMode::FromScratch, Some(3));
        form.fine_tune.training.config = ConfigChoice::File(config);
    }
    harness.run_steps(2);
    harness.get_by_label("Train").click();
    let n_epochs = |state: &State| state.session.response.training.history.len();
    step_until(&mut harness, "epochs", |state| n_epochs(state) > 3);
    harness.get_by_label("Pause").click();
    harness.run_steps(2);
    assert!(state(&harness).session.response.training.run.is_paused());
    // A paused training first completes the current epoch.
    let is_at_rest = |state: &State| state.session.response.training.run.is_at_rest();
    step_until(&mut harness, "the end of the epoch", is_at_rest);
    let paused = n_epochs(state(&harness));
    harness.run_steps(20);
    assert!(is_at_rest(state(&harness)));
    assert_eq!(n_epochs(state(&harness)), paused, "it went on");
    harness.get_by_label_contains("paused: single steps, epoch");
    harness.get_by_label("Resume").click();
    step_until(&mut harness, "more epochs", |state| n_epochs(state) > paused + 20);
    save(&mut harness, "training-response.png");
    harness.get_by_label("Cancel").click();
    let is_over = |state: &State| !state.session.response.training.run.is_running();
    step_until(&mut harness, "the end", is_over);
    assert!(state(&harness).session.response.training.is_over);
    let name = |harness: &Harness<'_, App>| {
        state(harness).session.response.model.current.as_ref().expect("a model").name.clone()
    };
    // The model of a cancelled training is used only when the user asks for it.
    assert_eq!(name(&harness), "shipped");
    harness.get_by_label("Use it").click();
    harness.run_steps(2);
    assert_eq!(name(&harness), "trained on 3 trajectories of trajectories-fea");
    let path = folder.path().join("mine.safetensors");
    apply(&mut harness, Command::Write(Output::Model(Network::Response), path.clone()));
    step_until(&mut harness, "the file", |state| !state.session.response.model.is_saving());
    assert_eq!(state(&harness).project.predict_motion.response_model.path(), Some(path.as_path()));
    // A model file is used for the network that its header names.
    apply(&mut harness, Command::UseModel(Network::Response, None));
    apply(&mut harness, Command::Open(vec![path.clone()]));
    assert_eq!(state(&harness).project.predict_motion.response_model.path(), Some(path.as_path()));
    assert_eq!(state(&harness).project.predict_force.model, ModelChoice::default());
}

/// Types into the field of the numbers of trajectories in the place of what it holds.
fn type_numbers(harness: &mut Harness<'_, App>, numbers: &str) {
    harness.get_by_role_and_label(Role::TextInput, "trajectories").focus();
    harness.run_steps(2);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    harness.get_by_role_and_label(Role::TextInput, "trajectories").type_text(numbers);
    harness.run_steps(2);
}

#[test]
fn models_are_compared_saved_and_opened_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let config = folder.path().join("small.toml");
    let uncalibrated = SMALL_RESPONSE.replace("folds = 2", "folds = 0");
    std::fs::write(&config, uncalibrated).expect("a file");
    let trajectories = few_cases(folder.path(), "trajectories-fea", 16);
    let mut harness = open(&[trajectories.as_str()]);
    step_until(&mut harness, "the data", is_idle);
    apply(&mut harness, Command::Show(Pane::ModelComparison));
    {
        let form = &mut harness.state_mut().state_mut().project.networks.compare;
        form.config = ConfigChoice::File(config);
        form.choices = 1;
    }
    harness.run_steps(2);
    type_numbers(&mut harness, "three");
    harness.get_by_label_contains("\"three\" is no number of trajectories");
    assert!(harness.get_by_label("Compare").accesskit_node().is_disabled());
    assert_eq!(state(&harness).project.networks.compare.trajectories, [5, 20]);
    type_numbers(&mut harness, "3, 6");
    assert_eq!(state(&harness).project.networks.compare.trajectories, [3, 6]);
    let is_over = |state: &State| !state.session.response.comparison.is_running();
    harness.get_by_label("Compare").click();
    harness.run_steps(2);
    step_until(&mut harness, "the comparison", is_over);
    let report = state(&harness).session.response.comparison.report().expect("a result");
    assert_eq!((report.comparison.models.len(), report.comparison.test.len()), (7, 4));
    harness.get_by_label_contains("4 trajectories that no model has seen");
    harness.run_steps(4);
    save(&mut harness, "compare.png");
    let out = folder.path().join("saved");
    apply(&mut harness, Command::Write(Output::Comparison, out.clone()));
    step_until(&mut harness, "the files", |_| out.join("comparison.md").is_file());
    // The tall window also shows what otherwise needs scrolling.
    apply(&mut harness, Command::Open(vec![out.join("comparison.json")]));
    step_until(&mut harness, "the file", is_over);
    harness.set_size(egui::vec2(1440.0, 2000.0));
    harness.state_mut().state_mut().view.dark = true;
    harness.run_steps(6);
    save(&mut harness, "compare-dark.png");
    apply(&mut harness, Command::Open(vec!["Cargo.json".into()]));
    step_until(&mut harness, "the error", is_over);
    let result = state(&harness).session.response.comparison.shown.as_ref();
    assert!(result.is_some_and(|result| result.as_ref().is_err_and(|e| e.contains("Cargo.json"))));
}

#[test]
fn the_current_model_is_evaluated_alone() {
    let mut harness = open(&[DATA]);
    step_until(&mut harness, "the data", is_idle);
    step_until(&mut harness, "the shipped model", |state| {
        state.session.response.model.current.is_some()
    });
    apply(&mut harness, Command::Show(Pane::ModelComparison));
    harness.run_steps(2);
    harness.get_by_label("Evaluate current model").click();
    harness.run_steps(2);
    step_until(&mut harness, "the evaluation", |state| {
        !state.session.response.comparison.is_running()
    });
    let report = state(&harness).session.response.comparison.report().expect("an evaluation");
    assert_eq!((report.comparison.models.len(), report.comparison.test.len()), (1, 25));
    harness.get_by_label_contains("one model on 25 trajectories");
    harness.run_steps(4);
    save(&mut harness, "evaluate-response.png");
}
