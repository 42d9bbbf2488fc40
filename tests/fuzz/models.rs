//! Models of both networks and checkpoints of trainings, resealed after a change.
//!
//! The files to begin with are trained here, so that they are always of the present version.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::OnceLock;

use impactlab_core::data::{Dataset, DatasetKind, Existing};
use impactlab_core::vehicle::Preset;
use impactlab_networks::force::{
    ForceCase, ForceConfig, ForceModel, ForceTrainSettings, ForceTrainingSet, train,
};
use impactlab_networks::learning::{ModelFile, TrainingReport};
use impactlab_networks::response::{
    ImpactRecord, ResponseCase, ResponseConfig, ResponseModel, ResponseTrainSettings, pretrain,
};
use impactlab_study::{Library, Request};
use serde_json::{Value, json};

use crate::harness::{Answer, Format, run};
use crate::sealed::mutated;

/// Cases that the networks learn from.
const N_CASES: usize = 12;
const SEED: u64 = 3;

/// A training in files.
struct Trained {
    model: Vec<u8>,
    checkpoint: Vec<u8>,
}

fn format(name: &'static str, n_inputs: u64, seeds: Vec<Vec<u8>>, load: &dyn Fn(&Path) -> Answer) {
    let file_name = "model.safetensors";
    run(&Format { name, n_inputs, file_name, names_file: true, seeds, mutate: mutated, load });
}

fn dataset(name: &str, kind: DatasetKind) -> Dataset {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets").join(name);
    let mut go_on = |_| ControlFlow::Continue(());
    let dataset = Dataset::load(&root, &mut go_on).expect("the shipped data can be read");
    let dataset = dataset.complete().expect("nothing cancels");
    assert_eq!(dataset.kind, kind);
    dataset
}

fn force_set() -> &'static ForceTrainingSet {
    static SET: OnceLock<ForceTrainingSet> = OnceLock::new();
    SET.get_or_init(|| {
        let (cases, _) = ForceCase::from_dataset(&dataset("fea", DatasetKind::Force));
        ForceTrainingSet::from_split("fea", &cases[..N_CASES], SEED, 0.0)
    })
}

fn force_settings(checkpoint: &Path) -> ForceTrainSettings {
    let mut config = ForceConfig::default();
    config.network.encoder_branches = vec![[4, 4, 4]];
    config.network.position_channels = 4;
    config.network.attention = false;
    config.network.trunk = vec![8, 8];
    config.network.factors = 2;
    config.training.epochs = 2;
    config.training.checkpoint_epochs = 1;
    config.crush.folds = 2;
    config.crush.max_steps = 2;
    ForceTrainSettings { config, seed: SEED, checkpoint: Some(checkpoint.to_owned()), resume: true }
}

fn trained_force() -> &'static Trained {
    static TRAINED: OnceLock<Trained> = OnceLock::new();
    TRAINED.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let [checkpoint, path] = ["training", "model"].map(|name| folder.path().join(name));
        let mut go_on = |_: &TrainingReport| ControlFlow::Continue(());
        let model = train(force_set(), &force_settings(&checkpoint), &mut go_on);
        model.and_then(|model| model.save(&path, Existing::Replace)).expect("a model");
        let read = |path| fs::read(path).expect("a file of the training");
        Trained { model: read(path), checkpoint: read(checkpoint) }
    })
}

fn records() -> &'static Vec<ImpactRecord> {
    static RECORDS: OnceLock<Vec<ImpactRecord>> = OnceLock::new();
    RECORDS.get_or_init(|| {
        let dataset = dataset("trajectories-fea", DatasetKind::Trajectory);
        let (cases, _) = ResponseCase::from_dataset(&dataset, &Preset::Reference.parameters());
        cases[..N_CASES].iter().filter_map(ResponseCase::impact).collect()
    })
}

fn response_settings(checkpoint: &Path) -> ResponseTrainSettings {
    let mut config = ResponseConfig::default();
    config.network.encoder = vec![8];
    config.network.token_encoder = [4, 4, 4];
    config.network.attention_heads = 2;
    config.network.trunk = vec![8];
    config.network.components = 2;
    config.pretraining.motions = 2;
    config.pretraining.epochs = 2;
    let checkpoint = Some(checkpoint.to_owned());
    ResponseTrainSettings { config, seed: SEED, checkpoint, resume: true }
}

fn trained_response() -> &'static Trained {
    static TRAINED: OnceLock<Trained> = OnceLock::new();
    TRAINED.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let [checkpoint, path] = ["training", "model"].map(|name| folder.path().join(name));
        let mut go_on = |_: &TrainingReport| ControlFlow::Continue(());
        let settings = response_settings(&checkpoint);
        let model = pretrain("impacts", records(), &settings, &mut go_on);
        model.and_then(|model| model.save(&path, Existing::Replace)).expect("a model");
        let read = |path| fs::read(path).expect("a file of the training");
        Trained { model: read(path), checkpoint: read(checkpoint) }
    })
}

/// What the program answers with an accepted model.
fn answered(answer: Answer, question: Value) -> Answer {
    let request: Request = serde_json::from_value(question).expect("a question");
    match request.run(&Library::default(), &mut |_| ControlFlow::Continue(())) {
        Ok(report) => answer.and(&report),
        // A model of finite numbers may still not answer a question.
        Err(_) => answer,
    }
}

#[test]
fn models_of_forces() {
    format("force-model", 300, vec![trained_force().model.clone()], &|path| {
        let answer = match ForceModel::load(path) {
            Ok(model) => Answer::accepted(&model.record().train),
            Err(error) => return Answer::refused(&error),
        };
        let question = json!({
            "question": "predict_force",
            "collision": {"scenario": {"file": "pit-right-rear"}},
            "model": path,
            "open_contact": false,
            "samples": 2,
            "seed": 0,
        });
        answered(answer, question)
    });
}

#[test]
fn checkpoints_of_force_trainings() {
    force_set();
    format("force-checkpoint", 60, vec![trained_force().checkpoint.clone()], &|path| {
        let mut stop = |_: &TrainingReport| ControlFlow::Break(());
        match train(force_set(), &force_settings(path), &mut stop) {
            Ok(model) => Answer::accepted(&model.record().train.len()),
            Err(error) => Answer::refused(&error),
        }
    });
}

#[test]
fn models_of_motions() {
    format("response-model", 2000, vec![trained_response().model.clone()], &|path| {
        let answer = match ResponseModel::load(path) {
            Ok(model) => Answer::accepted(model.latents()),
            Err(error) => return Answer::refused(&error),
        };
        let pulse = json!({"shape": "haversine", "duration_s": 0.1, "contact_height_m": 0.52});
        let scenario = json!({"scenario": {"file": "pit-right-rear"}, "pulse": pulse});
        let question = json!({
            "question": "predict_motion",
            "motion": {
                "source": {"scenario": scenario},
                "vehicle": "Automatic",
                "bullet": "Automatic",
                "equations": null,
                "integrator": "Rk4",
                "friction": null,
                "duration_s": 0.5,
            },
            "force": "given",
            "response_model": path,
            "draws": 4,
            "seed": 0,
        });
        answered(answer, question)
    });
}

#[test]
fn checkpoints_of_response_trainings() {
    records();
    format("response-checkpoint", 300, vec![trained_response().checkpoint.clone()], &|path| {
        let mut stop = |_: &TrainingReport| ControlFlow::Break(());
        match pretrain("impacts", records(), &response_settings(path), &mut stop) {
            Ok(model) => Answer::accepted(model.latents()),
            Err(error) => Answer::refused(&error),
        }
    });
}
