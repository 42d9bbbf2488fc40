//! Starts the program under test and reads its output.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::io::{self, PipeWriter};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

pub const SCENARIO: &str = "assets/scenarios/pit_right_rear.toml";
pub const TRAJECTORIES: &str = "datasets/trajectories-fea";
/// The evaluation of the shipped force network on the shipped runs.
pub const EVALUATE_SHIPPED: [&str; 6] =
    ["evaluate", "force", "--model", "shipped", "--data", "datasets/fea"];

/// Layers of a response network that is small enough to be trained within seconds.
pub const TINY_RESPONSE_NETWORK: &str = "\
[network]
encoder = [8]
token_encoder = [4, 4, 4]
attention_heads = 2
trunk = [8]
components = 2

";

/// Longest time to wait for a checkpoint. Only a training that hangs exceeds it.
const PATIENCE: Duration = Duration::from_secs(3600);

/// Returns a command that runs the program in the folder of the project.
pub fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_impactlab"));
    command.current_dir(env!("CARGO_MANIFEST_DIR"));
    command
}

/// Returns the standard output of a program, after checking that it succeeded.
pub fn ok(output: Output) -> String {
    let text = |bytes| String::from_utf8(bytes).unwrap();
    assert!(output.status.success(), "{}", text(output.stderr));
    text(output.stdout)
}

pub fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Returns the writing end of a pipe whose reading end is closed, as after `| head -1`.
pub fn closed_pipe() -> PipeWriter {
    io::pipe().unwrap().1
}

/// Kills a training by a signal that cannot be caught, as soon as it has written a checkpoint.
pub fn kill_at_checkpoint(training: &mut Command, model: &Path) {
    let mut child = training.stderr(Stdio::null()).stdout(Stdio::null()).spawn().unwrap();
    let checkpoint = PathBuf::from(format!("{}.training", model.display()));
    let started = Instant::now();
    while !checkpoint.exists() && started.elapsed() < PATIENCE {
        thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(checkpoint.exists(), "no checkpoint within {PATIENCE:?}");
}

/// Runs the program and returns its JSON output, after checking that it succeeded.
pub fn answer(args: &[&str]) -> Value {
    json(&ok(program().args(args).arg("--json").output().unwrap()))
}

/// What a reconstruction tells a person, and its report from the file that the same run writes.
pub fn told_and_reported(args: &[&str]) -> (String, Value) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let told = ok(program().args(args).arg("--out").arg(&out).output().unwrap());
    (told, json(&std::fs::read_to_string(out.join("reconstruction.json")).unwrap()))
}

/// Names of what is in a folder, in order.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = folder.read_dir().unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A path as an argument.
pub fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}
