//! Trainings, evaluations and comparisons of networks in the window and on the command line.

use std::path::PathBuf;

use egui_kittest::Harness;
use impactlab::app::{
    App, Command, ComparisonCommand, Network, State, TrainingCommand, TrainingMode,
};
use impactlab_study::ConfigChoice;

use crate::both_faces::{CommandLine, finished, open_on, write};
use crate::few_cases::few_cases;
use crate::harness::{apply, is_idle, open, state, step_until};
use crate::settings::{QUICK_CRUSH, SMALL_FORCE, SMALL_RESPONSE};

/// Cases of a data set to learn from and to be evaluated on: both faces give the same report of many or few.
const N_FORCES: usize = 24;
const N_TRAJECTORIES: usize = 16;

fn train(harness: &mut Harness<'_, App>, network: Network) {
    apply(harness, Command::Train(network, TrainingCommand::Start));
    step_until(harness, "the model", |state| {
        !state.session.force.training.run.is_running()
            && !state.session.response.training.run.is_running()
    });
}

#[test]
fn a_force_network_is_trained_and_evaluated_alike() {
    let folder = tempfile::tempdir().expect("a folder");
    let config = write(folder.path(), "tiny.toml", &[SMALL_FORCE, QUICK_CRUSH].concat());
    let model = folder.path().join("force.safetensors").display().to_string();
    let forces: &str = &few_cases(folder.path(), "fea", N_FORCES);
    let mut harness = open_on(forces);
    {
        let form = &mut harness.state_mut().state_mut().project.networks.train_force;
        (form.epochs, form.training.seed) = (Some(2), 3);
        form.training.config = ConfigChoice::File(config.clone().into());
    }
    train(&mut harness, Network::Force);
    let training = &state(&harness).session.force.training;
    let request = training.request.clone().expect("a question");
    let report = training.report.as_ref().expect("a report");
    let args = ["train", "force", "--data", forces, "--config", &config, "--epochs", "2"];
    CommandLine::new(&[&args[..], &["--seed", "3", "--out", &model]].concat())
        .prints(&["model"])
        .asks_differently(&["checkpoint", "overwrite"])
        .compare(request, report);

    apply(&mut harness, Command::Open(vec![PathBuf::from(&model)]));
    step_until(&mut harness, "the model that the command wrote", |state| {
        let current = state.session.force.model.current.as_ref();
        current.is_some_and(|current| current.choice.to_string() == model)
    });
    apply(&mut harness, Command::Evaluate);
    step_until(&mut harness, "the evaluation", |state| {
        !state.session.force.evaluation.is_running()
    });
    let (request, answer) = finished(&state(&harness).session.force.evaluation);
    CommandLine::new(&["evaluate", "force", "--model", &model, "--data", forces])
        .asks_differently(&["for_figures"])
        .compare(request, &answer.report);
}

#[test]
fn a_response_network_is_trained_fine_tuned_and_evaluated_alike() {
    let folder = tempfile::tempdir().expect("a folder");
    let config = write(folder.path(), "tiny.toml", SMALL_RESPONSE);
    let file = |name: &str| folder.path().join(name).display().to_string();
    let (pretrained, tuned) = (file("pretrained.safetensors"), file("tuned.safetensors"));
    let forces: &str = &few_cases(folder.path(), "fea", N_FORCES);
    let trajectories: &str = &few_cases(folder.path(), "trajectories-fea", N_TRAJECTORIES);
    let mut harness = open(&[forces, trajectories]);
    step_until(&mut harness, "the data", is_idle);
    {
        let form = &mut harness.state_mut().state_mut().project.networks;
        (form.mode, form.fine_tune.data) = (TrainingMode::Pretrain, vec![forces.into()]);
        form.fine_tune.training.config = ConfigChoice::File(config.clone().into());
        form.fine_tune.training.seed = 1;
    }
    train(&mut harness, Network::Response);
    let training = &state(&harness).session.response.training;
    let request = training.request.clone().expect("a question");
    let report = training.report.as_ref().expect("a report");
    let args = ["train", "response", "--data", forces, "--config", &config, "--seed", "1"];
    CommandLine::new(&[&args[..], &["--out", &pretrained]].concat())
        .prints(&["model"])
        .asks_differently(&["checkpoint", "overwrite"])
        .compare(request, report);

    let has_model = |path: String| {
        move |state: &State| {
            let current = state.session.response.model.current.as_ref();
            current.is_some_and(|current| current.choice.to_string() == path)
        }
    };
    apply(&mut harness, Command::Open(vec![PathBuf::from(&pretrained)]));
    step_until(&mut harness, "the pre-trained model", has_model(pretrained.clone()));
    {
        let form = &mut harness.state_mut().state_mut().project.networks;
        (form.mode, form.fine_tune.data) = (TrainingMode::FineTuneCurrent, Vec::new());
        (form.fine_tune.trajectories, form.fine_tune.choice) = (Some(3), Some(2));
    }
    train(&mut harness, Network::Response);
    let training = &state(&harness).session.response.training;
    let request = training.request.clone().expect("a question");
    let report = training.report.as_ref().expect("a report");
    let args = ["fine-tune", "response", "--model", &pretrained, "--data", trajectories];
    let numbers = ["--trajectories", "3", "--seed", "1", "--choice", "2", "--config", &config];
    CommandLine::new(&[&args[..], &numbers, &["--out", &tuned]].concat())
        .prints(&["model"])
        .asks_differently(&["checkpoint", "overwrite"])
        .compare(request, report);

    apply(&mut harness, Command::Open(vec![PathBuf::from(&tuned)]));
    step_until(&mut harness, "the fine-tuned model", has_model(tuned.clone()));
    apply(&mut harness, Command::Compare(ComparisonCommand::Evaluate));
    let is_over = |state: &State| !state.session.response.comparison.is_running();
    step_until(&mut harness, "the evaluation", is_over);
    let (request, answer) = finished(&state(&harness).session.response.comparison.evaluate);
    CommandLine::new(&["evaluate", "response", "--model", &tuned, "--data", trajectories])
        .compare(request, &answer.report);
}

#[test]
fn models_are_compared_alike() {
    let folder = tempfile::tempdir().expect("a folder");
    let uncalibrated = SMALL_RESPONSE.replace("folds = 2", "folds = 0");
    let config = write(folder.path(), "tiny.toml", &uncalibrated);
    let trajectories: &str = &few_cases(folder.path(), "trajectories-fea", N_TRAJECTORIES);
    let mut harness = open_on(trajectories);
    {
        let form = &mut harness.state_mut().state_mut().project.networks.compare;
        form.config = ConfigChoice::File(config.clone().into());
        (form.trajectories, form.choices) = (vec![3], 1);
    }
    apply(&mut harness, Command::Compare(ComparisonCommand::Start));
    let is_over = |state: &State| !state.session.response.comparison.is_running();
    step_until(&mut harness, "the comparison", is_over);
    let (request, answer) = finished(&state(&harness).session.response.comparison.compare);
    let args = ["compare", "--data", trajectories, "--trajectories", "3", "--choices", "1"];
    CommandLine::new(&[&args[..], &["--config", &config]].concat())
        .compare(request, &answer.report);
}
