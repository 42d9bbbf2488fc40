//! Tests of the commands of the force network: training, resuming after a kill, prediction and
//! evaluation.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

use crate::badges::badges;
use crate::program::{SCENARIO, closed_pipe, json, kill_at_checkpoint, ok, program};

const DATA: &str = "datasets/fea";

const TINY: &str = "\
[network]
encoder_branches = [[8, 8, 4]]
position_channels = 8
attention_channels = 8
attention_heads = 2
attention_stride = 25
trunk = [16, 8]
factors = 2

[training]
epochs = 6
checkpoint_epochs = 1

[crush]
folds = 2
max_steps = 1
";

pub fn train(folder: &TempDir, model: &Path) -> Command {
    let config = folder.path().join("tiny.toml");
    fs::write(&config, TINY).unwrap();
    let mut command = program();
    command.args(["train", "force", "--data", DATA, "--seed", "4"]);
    command.arg("--config").arg(config).arg("--out").arg(model);
    command
}

fn predict(model: &Path, extra: &[&str]) -> Output {
    let mut command = program();
    command.args(["predict", "force", "--scenario", SCENARIO, "--json", "--model"]).arg(model);
    command.args(extra).output().unwrap()
}

/// Returns the JSON output of a prediction without the names of the model.
fn answer(model: &Path) -> Value {
    let mut answer = json(&ok(predict(model, &["--body", "A"])));
    answer.as_object_mut().unwrap().remove("model");
    answer["model_digests"][0].as_object_mut().unwrap().remove("name");
    answer
}

#[test]
fn train_kill_resume_predict() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, killed] = ["whole", "killed"].map(|name| folder.path().join(name));
    let report = json(&ok(train(&folder, &whole).arg("--json").output().unwrap()));
    assert_eq!((&report["n_test"], &report["epochs"]), (&Value::from(25), &Value::from(6)));
    assert_eq!(report["n_train"].as_u64().unwrap() + report["n_validation"].as_u64().unwrap(), 75);

    kill_at_checkpoint(&mut train(&folder, &killed), &killed);
    // Nobody reads the output of the resumed training, which must not stop it.
    let mut resumed = train(&folder, &killed);
    resumed.arg("--resume").stdout(closed_pipe()).stderr(closed_pipe());
    assert_eq!(resumed.status().unwrap().code(), Some(0));
    assert_eq!(answer(&killed), answer(&whole), "bit for bit");
    // Neither the clock nor the kill has left a trace in the model.
    assert!(fs::read(&killed).unwrap() == fs::read(&whole).unwrap(), "the models differ");

    files_of_a_prediction(&whole, folder.path());
    let evaluate = ["evaluate", "force", "--data", DATA, "--json", "--model"];
    let out = folder.path().join("evaluation");
    let mut evaluation = program();
    evaluation.args(evaluate).arg(&whole).arg("--out").arg(&out);
    let measured = json(&ok(evaluation.output().unwrap()));
    assert!(out.join("evaluation.json").is_file());
    assert_eq!(badges(&measured, "energy_gain").len(), 0, "{measured}");
    assert_eq!((&measured["n_test"], &measured["n_trained_on"]), (&25.into(), &0.into()));
    for who in [&measured, &measured["baselines"]["pulse"], &measured["baselines"]["nearest"]] {
        let error = who["overall"]["rmse_over_peak"]["mean"].as_f64().unwrap();
        assert!((0.0..1.0).contains(&error), "{error}");
    }
    let unknown = ok(predict(&whole, &["--body", "Z"]));
    assert!(unknown.contains("is none of those that the network knows (A, B)"), "{unknown}");
}

fn files_of_a_prediction(model: &Path, folder: &Path) {
    let out = folder.join("prediction");
    ok(predict(model, &["--open-contact", "--samples", "2", "--out", out.to_str().unwrap()]));
    let bands = fs::read_to_string(out.join("bands.csv")).unwrap();
    assert_eq!(bands.lines().count(), 251);
    assert!(bands.starts_with("time_s,fx_mean_n,fx_low_50_n,fx_high_50_n,"), "{bands:.80}");
    assert!(out.join("sample_002.csv").exists() && !out.join("sample_003.csv").exists());
    let mean = out.join("mean.csv");
    ok(program().args(["check", mean.to_str().unwrap()]).output().unwrap());
    let answer = json(&fs::read_to_string(out.join("prediction.json")).unwrap());
    assert_eq!((&answer["is_contact_open"], &answer["is_body_open"]), (&true.into(), &true.into()));
}

#[test]
fn what_is_no_model_is_said_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.safetensors");
    fs::write(&path, "case,m_t_kg\n").unwrap();
    let output = predict(&path, &[]);
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(error.lines().count(), 1, "{error}");
    assert!(error.contains("x.safetensors: cannot be used as a model"), "{error}");
}

#[test]
fn the_settings_can_be_printed_and_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["train", "force", "--data", DATA, "--out", "x", "--print-config"];
    let printed = ok(program().args(arguments).output().unwrap());
    let path = folder.path().join("config.toml");
    fs::write(&path, &printed).unwrap();
    let again = ok(program().args(arguments).arg("--config").arg(path).output().unwrap());
    assert_eq!(again, printed);
    let paper = ok(program().args(arguments).arg("--paper").output().unwrap());
    assert!(paper != printed && paper.contains("512"), "{paper}");
}
