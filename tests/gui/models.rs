//! The Models pane: what has been finished is kept over a restart, what was interrupted goes on,
//! and nothing is put into use or removed by itself.

use std::fs;
use std::path::{Path, PathBuf};

use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use impactlab::app::{
    App, ArchiveEntry, ArchiveKind, Command, ComparisonCommand, CostPlace, Leaving, Network,
    Output, Pane, State, TrainingCommand, TrainingMode,
};
use impactlab_study::{ConfigChoice, ForceEvaluation, ModelChoice};

use crate::few_cases::few_cases;
use crate::harness::{apply, is_idle, open_with, state, step_until};
use crate::pictures::save;
use crate::settings::{SMALL_FORCE, SMALL_RESPONSE};

const FORCES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea");
const MOTIONS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/trajectories-fea");

/// About the momentum solution, with a checkpoint after each epoch.
const MOMENTUM: &str = "\
centre = \"momentum\"
[training]
epochs = 4
checkpoint_epochs = 1
[crush]
folds = 2
";

/// A user's data folder with the settings of small networks.
struct Desk {
    folder: tempfile::TempDir,
}

impl Desk {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("force.toml"), [SMALL_FORCE, MOMENTUM].concat())
            .expect("a file");
        fs::write(folder.path().join("response.toml"), SMALL_RESPONSE).expect("a file");
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Opens the window with the state and the results of this user.
    fn open(&self, paths: &[&str]) -> Harness<'static, App> {
        let mut harness = open_with(paths, Some(self.path("state.json")));
        step_until(&mut harness, "the data and what is kept", |state| {
            state.session.sources.iter().all(impactlab::app::Source::is_settled)
                && !state.session.archive.is_reading()
                && state.session.force.model.current.is_some()
                && state.session.response.model.current.is_some()
        });
        harness
    }

    /// Opens the window on the force data, with the training form filled in.
    fn open_to_train(&self, epochs: usize) -> Harness<'static, App> {
        let mut harness = self.open(&[FORCES]);
        let form = &mut harness.state_mut().state_mut().project.networks.train_force;
        form.epochs = Some(epochs);
        form.training.config = ConfigChoice::File(self.path("force.toml"));
        harness
    }

    /// Waits until the state of the window is on the disk. The tiles of a workspace stand in no
    /// order, and not in the same one whenever they are drawn: values are compared, not texts.
    fn store(&self, harness: &mut Harness<'_, App>) {
        let file = self.path("state.json");
        let value = |text: String| serde_json::from_str::<serde_json::Value>(&text).ok();
        step_until(harness, "the stored state", |state| {
            let stored = fs::read_to_string(&file).ok().and_then(value);
            stored.is_some() && stored == state.save().ok().and_then(value)
        });
    }

    fn names(&self, name: &str) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.path(name)) else { return Vec::new() };
        let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
        let mut names: Vec<String> = entries.map(|entry| name(entry.expect("an entry"))).collect();
        names.sort();
        names
    }
}

fn entries<'a>(harness: &'a Harness<'_, App>) -> &'a [ArchiveEntry] {
    &state(harness).session.archive.list.entries
}

/// Starts the training of the force network and waits until its model is kept.
fn train(harness: &mut Harness<'_, App>) {
    let n = entries(harness).len();
    apply(harness, Command::Train(Network::Force, TrainingCommand::Start));
    step_until(harness, "the kept model", |state| state.session.archive.list.entries.len() > n);
}

/// What the window refers to the force model in use by, and its name.
fn in_use(harness: &Harness<'_, App>) -> (ModelChoice, String) {
    let current = state(harness).session.force.model.current.as_ref().expect("a model");
    (current.choice.clone(), current.name.clone())
}

/// Whether the force model of a name has been read and is used.
fn is_in_use(name: &str) -> impl Fn(&State) -> bool {
    move |state| state.session.force.model.current.as_ref().is_some_and(|model| model.name == name)
}

fn show_models(harness: &mut Harness<'_, App>) {
    apply(harness, Command::Show(Pane::Models));
    harness.run_steps(4);
}

#[test]
fn a_finished_training_is_kept_named_and_used_after_a_restart() {
    let desk = Desk::new();
    let mut harness = desk.open_to_train(3);
    train(&mut harness);
    // It is in use, and from now on by its file, so that a restart does not lose it.
    let [entry] = entries(&harness) else { panic!("{:?}", entries(&harness)) };
    let entry = entry.clone();
    assert_eq!((entry.kind, entry.is_cancelled), (ArchiveKind::ForceModel, false));
    assert_eq!(entry.data, "fea");
    let path =
        state(&harness).project.predict_force.model.path().expect("the kept model").to_owned();
    assert_eq!(path, desk.path("models").join(format!("{}.safetensors", entry.sha256)));
    let (choice, name) = in_use(&harness);
    assert_eq!((choice, name.as_str()), (ModelChoice::file(&path), entry.name.as_str()));
    assert!(state(&harness).reasons_to_stay(&Leaving::Quit).is_empty());
    assert!(desk.names("trainings").is_empty(), "a finished training leaves no checkpoint");
    let fact = |label: &str| {
        let fact = entry.figures.iter().find(|fact| fact.label == label);
        fact.unwrap_or_else(|| panic!("no {label}")).text.clone()
    };
    assert!(fact("best epoch").ends_with("of 3") && fact("cases learned from") == "60");
    assert!(entry.settings.iter().any(|of| of.label == "training.epochs" && of.text == "3"));

    // The same training gives the same weights, which are kept once.
    apply(&mut harness, Command::Train(Network::Force, TrainingCommand::Start));
    step_until(&mut harness, "the same model", |state| {
        let force = &state.session.force;
        !force.training.run.is_running() && !force.model.is_keeping() && force.training.is_over
    });
    assert_eq!(entries(&harness), std::slice::from_ref(&entry));
    apply(&mut harness, Command::UseModel(Network::Force, None));
    step_until(&mut harness, "the shipped model", is_in_use("shipped"));
    desk.store(&mut harness);
    drop(harness);

    let mut harness = desk.open(&[]);
    assert_eq!(in_use(&harness).1, "shipped");
    assert_eq!(entries(&harness), std::slice::from_ref(&entry));
    show_models(&mut harness);
    harness.get_by_label("Rename…").click();
    harness.run_steps(3);
    harness.get_by_label("Name").focus();
    harness.run_steps(2);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    harness.get_by_label("Name").type_text("my PIT model");
    harness.run_steps(2);
    harness.get_by_label("Rename it").click();
    step_until(&mut harness, "the name", |state| {
        state.session.archive.list.entries[0].name == "my PIT model"
    });
    harness.get_by_label("Use").click();
    harness.run_steps(2);
    step_until(&mut harness, "the kept model", is_in_use("my PIT model"));
    assert_eq!(in_use(&harness).0, ModelChoice::file(&path));
    let copy = desk.path("copy.safetensors");
    apply(
        &mut harness,
        Command::Write(Output::Archived(Network::Force, path.clone()), copy.clone()),
    );
    step_until(&mut harness, "the copy", |_| copy.exists());
    assert_eq!(fs::read(&copy).expect("a copy"), fs::read(&path).expect("a model"));
    desk.store(&mut harness);
    drop(harness);

    // The last button of this name is that of the model; another one is of the case's variants.
    // It is in use after the next restart too. It is not removed while it is; another one is, after
    // a question.
    let mut harness = desk.open(&[]);
    step_until(&mut harness, "the name", is_in_use("my PIT model"));
    show_models(&mut harness);
    let is_disabled = |harness: &Harness<'_, App>| {
        harness.query_all_by_label("Remove…").last().expect("one").accesskit_node().is_disabled()
    };
    assert!(is_disabled(&harness));
    apply(&mut harness, Command::UseModel(Network::Force, None));
    harness.run_steps(3);
    assert!(!is_disabled(&harness));
    harness.query_all_by_label("Remove…").last().expect("one").click();
    harness.run_steps(3);
    harness.get_by_label("Keep it").click();
    harness.run_steps(3);
    assert_eq!(desk.names("models").len(), 2);
    harness.query_all_by_label("Remove…").last().expect("one").click();
    harness.run_steps(3);
    harness.get_by_label("Remove it").click();
    step_until(&mut harness, "the removal", |state| state.session.archive.list.entries.is_empty());
    assert!(desk.names("models").is_empty());
}

#[test]
fn a_cancelled_training_is_kept_as_such_and_can_be_resumed_but_is_not_used() {
    let desk = Desk::new();
    let mut harness = desk.open_to_train(100_000);
    apply(&mut harness, Command::Train(Network::Force, TrainingCommand::Start));
    step_until(&mut harness, "epochs", |state| state.session.force.training.history.len() > 2);
    show_models(&mut harness);
    harness.get_by_label_contains("Training of the force model on fea");
    save(&mut harness, "models-running.png");
    harness.get_by_label("Cancel").click();
    step_until(&mut harness, "the kept model", |state| {
        !state.session.archive.list.entries.is_empty()
            && !state.session.unfinished.list.trainings.is_empty()
    });
    assert!(entries(&harness)[0].is_cancelled);
    // “epoch 3 of 3” was told of one that was cancelled after the third of many.
    let reached = &entries(&harness)[0].figures[0];
    assert_eq!(reached.label, "reached");
    assert!(reached.text.ends_with(" of 100000"), "{reached:?}");
    let said = state(&harness).session.log.iter().map(|(_, message)| &message.text);
    let said = said.filter(|text| text.starts_with("training cancelled (epoch ")).count();
    assert_eq!(said, 1);
    assert_eq!(in_use(&harness).1, "shipped");
    desk.store(&mut harness);
    drop(harness);

    let mut harness = desk.open(&[]);
    step_until(&mut harness, "the cancelled training", |state| {
        !state.session.unfinished.list.trainings.is_empty()
    });
    assert_eq!(in_use(&harness).1, "shipped", "nor is it after a restart");
    assert!(entries(&harness)[0].is_cancelled);
    show_models(&mut harness);
    harness.get_by_label("cancelled");
    harness.get_by_label_contains("Cancelled training of a force model on fea");
    // The user has ended it, so that the status line does not speak of it.
    assert!(harness.query_by_label("Later").is_none());
    harness.get_by_label("Discard…").click();
    harness.run_steps(3);
    harness.get_by_label("Remove it").click();
    step_until(&mut harness, "the removal", |state| {
        state.session.unfinished.list.trainings.is_empty()
    });
    assert!(desk.names("trainings").is_empty());
    assert_eq!(entries(&harness).len(), 1, "the model of it stays");
}

#[test]
fn an_interrupted_training_is_offered_after_a_restart_and_goes_on_to_its_end() {
    let desk = Desk::new();
    let mut harness = desk.open_to_train(60);
    apply(&mut harness, Command::Train(Network::Force, TrainingCommand::Start));
    step_until(&mut harness, "epochs", |state| state.session.force.training.history.len() > 2);
    apply(&mut harness, Command::Train(Network::Force, TrainingCommand::Pause(true)));
    step_until(&mut harness, "the pause", |state| state.session.force.training.run.is_at_rest());
    // What a kill at this moment leaves on the disk.
    let killed = Desk::new();
    fs::create_dir(killed.path("trainings")).expect("a folder");
    for name in desk.names("trainings").iter().filter(|name| !name.starts_with('.')) {
        let name = Path::new("trainings").join(name);
        fs::copy(desk.folder.path().join(&name), killed.folder.path().join(&name)).expect("a copy");
    }
    drop(harness);

    let mut harness = killed.open(&["assets/scenarios/pit_right_rear.toml"]);
    step_until(&mut harness, "what was interrupted", |state| {
        state.session.unfinished.interrupted().next().is_some()
    });
    let of = state(&harness).session.unfinished.interrupted().next().expect("a training");
    let (n_epochs, checkpoint) = (of.n_epochs, of.checkpoint.clone());
    assert!(n_epochs > 2 && of.progress() == format!("epoch {n_epochs} of 60"), "{of:?}");
    // Outside the Models pane: in the status line, with a way to it.
    harness.get_by_label_contains("Interrupted training of a force model on fea: epoch");
    save(&mut harness, "models-interrupted.png");
    harness.get_by_label("Later").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("Later").is_none());
    show_models(&mut harness);
    // The form of this user has other settings and no data are open: the note has everything.
    harness.get_by_label("Resume training").click();
    step_until(&mut harness, "the kept model", |state| {
        !state.session.archive.list.entries.is_empty()
    });
    let training = &state(&harness).session.force.training;
    assert_eq!(training.problem, None);
    let entry = &entries(&harness)[0];
    let epochs = entry.figures.iter().find(|of| of.label == "best epoch").expect("a figure");
    assert!(epochs.text.ends_with("of 60"), "{epochs:?}");
    step_until(&mut harness, "the end of it", |state| {
        state.session.unfinished.list.trainings.is_empty()
    });
    step_until(&mut harness, "a folder without its state", |_| {
        !checkpoint.exists() && killed.names("trainings").is_empty()
    });
    assert!(!entry_is_cancelled(&harness));
}

fn entry_is_cancelled(harness: &Harness<'_, App>) -> bool {
    entries(harness)[0].is_cancelled
}

#[test]
fn comparisons_and_evaluations_are_opened_again_after_a_restart() {
    let desk = Desk::new();
    let motions = few_cases(desk.folder.path(), "trajectories-fea", 16);
    let forces = few_cases(desk.folder.path(), "fea", 24);
    let uncalibrated = SMALL_RESPONSE.replace("folds = 2", "folds = 0");
    fs::write(desk.path("response.toml"), uncalibrated).expect("a file");
    let mut harness = desk.open(&[motions.as_str(), forces.as_str()]);
    step_until(&mut harness, "the data", is_idle);
    {
        let form = &mut harness.state_mut().state_mut().project.networks;
        form.compare.config = ConfigChoice::File(desk.path("response.toml"));
        (form.compare.trajectories, form.compare.choices) = (vec![3], 1);
        form.train_force.epochs = Some(2);
        form.train_force.training.config = ConfigChoice::File(desk.path("force.toml"));
    }
    // The baselines of an evaluation are fitted to what the model has learned from: here to few cases.
    train(&mut harness);
    let n_archived = |n: usize| move |state: &State| state.session.archive.list.entries.len() == n;
    apply(&mut harness, Command::Compare(ComparisonCommand::Start));
    step_until(&mut harness, "the comparison", n_archived(2));
    let compared = state(&harness).session.response.comparison.report().expect("one").clone();
    apply(&mut harness, Command::Compare(ComparisonCommand::Evaluate));
    step_until(&mut harness, "the evaluation of the response model", n_archived(3));
    apply(&mut harness, Command::Evaluate);
    step_until(&mut harness, "the evaluation of the force model", n_archived(4));
    let evaluated = state(&harness).session.force.evaluation.ok().expect("one").report.clone();
    desk.store(&mut harness);
    drop(harness);

    let mut harness = desk.open(&[]);
    let of_kind = |harness: &Harness<'_, App>, kind: ArchiveKind| {
        let entry = entries(harness).iter().find(|entry| entry.kind == kind);
        entry.unwrap_or_else(|| panic!("no {kind:?}")).clone()
    };
    assert!(state(&harness).session.response.comparison.report().is_none());
    show_models(&mut harness);
    assert_eq!(harness.query_all_by_label("Open again").count(), 3);
    save(&mut harness, "models-results.png");
    let open = |harness: &mut Harness<'_, App>, kind: ArchiveKind| {
        let entry = Box::new(of_kind(harness, kind));
        apply(harness, Command::Models(impactlab::app::ModelsCommand::Open(entry)));
    };
    open(&mut harness, ArchiveKind::Comparison);
    step_until(&mut harness, "the comparison", |state| {
        state.session.response.comparison.report().is_some()
    });
    // With everything: also badges, assumptions and the digests of the models.
    // The texts, since the error at a time that was not reached is no number.
    let again = state(&harness).session.response.comparison.report().expect("one");
    assert_eq!(format!("{again:?}"), format!("{compared:?}"));
    let n_test = compared.comparison.test.len();
    harness.get_by_label_contains(&format!("{n_test} trajectories that no model has seen"));
    open(&mut harness, ArchiveKind::ForceEvaluation);
    step_until(&mut harness, "the evaluation", |state| {
        state.session.force.evaluation.ok().is_some()
    });
    let again = state(&harness).session.force.evaluation.ok().expect("one");
    assert_eq!(format!("{:?}", again.report), format!("{evaluated:?}"));
    let ForceEvaluation::Cases(report) = &evaluated.report else { panic!("folds") };
    harness.get_by_label_contains(&format!("on {} cases of fea", report.n_test));
    harness.get_by_label_contains("The plots of single cases are not kept");
}

#[test]
fn a_damaged_kept_file_is_named_and_the_others_are_there() {
    let desk = Desk::new();
    let mut harness = desk.open_to_train(2);
    train(&mut harness);
    harness.state_mut().state_mut().project.networks.train_force.training.seed = 1;
    train(&mut harness);
    apply(&mut harness, Command::UseModel(Network::Force, None));
    desk.store(&mut harness);
    let damaged = desk.path("models").join(format!("{}.safetensors", entries(&harness)[0].sha256));
    let whole = entries(&harness)[1].clone();
    drop(harness);
    let mut bytes = fs::read(&damaged).expect("a model");
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    fs::write(&damaged, &bytes).expect("one flipped bit");
    let trainings = desk.path("trainings");
    fs::create_dir_all(&trainings).expect("a folder");
    fs::write(trainings.join("force-1.safetensors"), "no checkpoint").expect("a file");

    let mut harness = desk.open(&[]);
    assert_eq!(entries(&harness), [whole]);
    show_models(&mut harness);
    let name = damaged.display().to_string();
    harness.get_by_label_contains(&format!("Cannot be used: {name}: is damaged: its SHA-256"));
    harness.get_by_label_contains("Cannot be resumed:");
    save(&mut harness, "models-damaged.png");
    assert!(damaged.exists(), "it stays until the user removes it");
}

#[test]
fn the_pane_shows_what_is_in_use_running_and_finished() {
    let desk = Desk::new();
    let mut harness = desk.open_to_train(3);
    train(&mut harness);
    {
        let form = &mut harness.state_mut().state_mut().project.networks;
        (form.mode, form.fine_tune.trajectories) = (TrainingMode::FromScratch, Some(3));
        form.fine_tune.training.config = ConfigChoice::File(desk.path("response.toml"));
    }
    apply(&mut harness, Command::Open(vec![MOTIONS.into()]));
    step_until(&mut harness, "the trajectories", is_idle);
    apply(&mut harness, Command::Train(Network::Response, TrainingCommand::Start));
    step_until(&mut harness, "the response model", |state| {
        state.session.archive.list.entries.len() == 2
    });
    let form = &mut harness.state_mut().state_mut().project.networks.train_force;
    form.epochs = Some(100_000);
    apply(&mut harness, Command::Train(Network::Force, TrainingCommand::Start));
    step_until(&mut harness, "epochs", |state| state.session.force.training.history.len() > 2);
    show_models(&mut harness);
    for text in ["In use", "Running", "Finished", "Force network", "Response network"] {
        assert!(harness.query_all_by_label(text).count() > 0, "{text}");
    }
    save(&mut harness, "models.png");
    harness.state_mut().state_mut().view.dark = true;
    harness.run_steps(4);
    save(&mut harness, "models-dark.png");
}

/// The number of times that a part of the measured work of a form is done.
fn n_of(state: &State, place: CostPlace, what: &str) -> Option<f64> {
    let cost = state.session.costs.get(place)?.as_ref().expect("a measurement").as_ref()?;
    assert!(cost.seconds() > 0.0 && cost.parts.iter().all(|part| part.seconds_each >= 0.0));
    let sum: f64 = cost.parts.iter().map(|part| part.n * part.seconds_each).sum();
    assert!((cost.seconds() - sum).abs() < 1e-9, "{cost:?}");
    let part = cost.parts.iter().find(|part| part.what == what);
    Some(part.unwrap_or_else(|| panic!("no {what}: {cost:?}")).n)
}

#[test]
fn a_form_says_what_its_work_will_take_and_measures_again_when_it_changes() {
    let desk = Desk::new();
    let mut harness = desk.open_to_train(50);
    apply(&mut harness, Command::ShowTraining(Network::Force));
    let place = CostPlace::ForceTraining;
    step_until(&mut harness, "a measurement", |state| n_of(state, place, "epochs") == Some(50.0));
    harness.get_by_label_contains("Training: at most about");
    assert!(!state(&harness).session.force.training.run.is_running());
    let form = &mut harness.state_mut().state_mut().project.networks.train_force;
    form.epochs = Some(5000);
    harness.run_steps(2);
    assert!(state(&harness).session.costs.get(place).is_none(), "it is of other settings");
    step_until(&mut harness, "a measurement", |state| n_of(state, place, "epochs") == Some(5000.0));
    save(&mut harness, "training-cost.png");
    // Settings that cannot be read are said instead.
    let form = &mut harness.state_mut().state_mut().project.networks.train_force;
    form.training.config = ConfigChoice::File("no/such.toml".into());
    step_until(&mut harness, "the problem", |state| {
        state.session.costs.get(place).is_some_and(Result::is_err)
    });
    harness.get_by_label_contains("cannot be measured: no/such.toml");
    assert!(desk.names("trainings").is_empty() && desk.names("models").is_empty());
}

#[test]
fn the_forms_of_the_response_network_say_what_their_work_will_take() {
    let desk = Desk::new();
    let mut harness = desk.open(&[MOTIONS]);
    step_until(&mut harness, "the data", is_idle);
    {
        let form = &mut harness.state_mut().state_mut().project.networks;
        let config = ConfigChoice::File(desk.path("response.toml"));
        (form.mode, form.fine_tune.trajectories) = (TrainingMode::FromScratch, Some(3));
        form.fine_tune.training.config = config.clone();
        form.compare.config = config;
        (form.compare.trajectories, form.compare.choices) = (vec![3, 6], 2);
    }
    apply(&mut harness, Command::ShowTraining(Network::Response));
    let part = "epochs of rollouts of 5 steps";
    let place = CostPlace::ResponseTraining;
    step_until(&mut harness, "a measurement", |state| n_of(state, place, part) == Some(2.0));
    let n = n_of(state(&harness), place, &format!("calibration: {part}"));
    assert_eq!(n, Some(2.0), "one training less than the two folds, of two epochs");
    apply(&mut harness, Command::Show(Pane::ModelComparison));
    let place = CostPlace::Comparison;
    step_until(&mut harness, "the comparison", |state| {
        n_of(state, place, &format!("PINN on 6: {part}")) == Some(4.0)
    });
    assert_eq!(n_of(state(&harness), place, "4DOF tuned on 3, moves"), Some(6.0));
    let place = CostPlace::ResponseEvaluation;
    step_until(&mut harness, "the evaluation", |state| {
        n_of(state, place, "trajectories") == Some(25.0)
    });
}
