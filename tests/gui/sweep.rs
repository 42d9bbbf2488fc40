//! The Sweep pane: a plan of few rows is computed, goes on where it stopped, and is merged.

use std::path::{Path, PathBuf};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, Command, Output, State, SweepCommand, TaskKey, Workspace};
use impactlab_sweep::{chunk_path, read_rows};

use crate::harness::{apply, open, state, step_until};
use crate::pictures::save;

/// A plan of a PIT that is followed for a moment.
fn plan_in(folder: &Path, name: &str, n: u64, chunk: u64) -> PathBuf {
    let text = format!(
        "name = \"a few PITs\"\nquestion = \"pit\"\nn = {n}\nchunk = {chunk}\nseed = 3\n\n\
         [pit]\nscenario = \"pit-right-rear\"\nlimit_s = 2\n\n\
         [vary.target_speed_m_s]\nuniform = [14.0, 16.0]\n"
    );
    let path = folder.join(name);
    std::fs::write(&path, text).expect("written");
    path
}

/// The window with a plan, and a folder for its chunks.
fn opened(plan: PathBuf, folder: &Path) -> Harness<'static, App> {
    let mut harness = open(&[]);
    apply(&mut harness, Command::Open(vec![plan]));
    step_until(&mut harness, "the plan", |state| state.session.sweep.sweep().is_some());
    assert_eq!(state(&harness).view.workspaces.shown, Workspace::Atlas);
    apply(&mut harness, Command::Sweep(SweepCommand::Folder(folder.to_owned())));
    step_until(&mut harness, "the folder", is_known);
    harness
}

fn is_known(state: &State) -> bool {
    let is_running = |key| state.session.tasks.is_running(&key);
    !is_running(TaskKey::Sweep)
        && !is_running(TaskKey::MergeSweep)
        && !is_running(TaskKey::ReadSweep)
        && state.session.sweep.sweep().is_some()
}

fn n_missing(state: &State) -> u64 {
    state.session.sweep.sweep().expect("a sweep").n_missing()
}

#[test]
fn a_sweep_is_computed_goes_on_and_is_merged() {
    let folder = tempfile::tempdir().expect("a folder");
    let chunks = folder.path().join("chunks");
    let mut harness = opened(plan_in(folder.path(), "plan.toml", 4, 2), &chunks);
    harness.run_steps(3);
    harness.get_by_label("4 rows in 2 chunks of at most 2 rows");
    assert!(harness.query_all_by_label_contains("is unknown until").next().is_some());
    save(&mut harness, "sweep.png");
    harness.get_by_label("Start").click();
    harness.run_steps(2);
    step_until(&mut harness, "the chunks", |state| is_known(state) && n_missing(state) == 0);
    let before = std::fs::read(chunk_path(&chunks, 1)).expect("a chunk");

    std::fs::remove_file(chunk_path(&chunks, 1)).expect("removed");
    harness.get_by_label("Look again").click();
    harness.run_steps(2);
    step_until(&mut harness, "what is missing", |state| is_known(state) && n_missing(state) == 1);
    harness.run_steps(2);
    harness.get_by_label("Go on").click();
    harness.run_steps(2);
    step_until(&mut harness, "the chunk", |state| is_known(state) && n_missing(state) == 0);
    assert_eq!(std::fs::read(chunk_path(&chunks, 1)).expect("a chunk"), before, "the same bytes");

    let merged = folder.path().join("rows.parquet");
    apply(&mut harness, Command::Write(Output::SweepRows, merged.clone()));
    step_until(&mut harness, "the rows", is_known);
    harness.run_steps(2);
    let said: Vec<&str> =
        state(&harness).session.log.iter().map(|(_, message)| message.text.as_str()).collect();
    let expected = "with 4 rows, 0 of them without an answer";
    assert!(said.iter().any(|text| text.contains(expected)), "{said:?}");
    let rows = read_rows(&merged).expect("rows");
    assert_eq!(rows.index, [0, 1, 2, 3]);
    assert_eq!(rows.inputs.len(), 1);

    // The folder says by itself what it is.
    harness = open(&[]);
    apply(&mut harness, Command::Open(vec![chunks.join("plan.json")]));
    step_until(&mut harness, "the sweep of the folder", is_known);
    assert_eq!(n_missing(state(&harness)), 0);
}

#[test]
fn rows_are_timed_on_request_and_the_view_is_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let chunks = folder.path().join("chunks");
    let mut harness = opened(plan_in(folder.path(), "plan.toml", 4, 2), &chunks);
    harness.run_steps(3);
    harness.get_by_label("Time some rows").click();
    harness.run_steps(2);
    step_until(&mut harness, "the time", |state| state.session.sweep.timed().is_some());
    let timed = state(&harness).session.sweep.timed().expect("timed").clone().expect("a time");
    assert_eq!(timed.n_rows, 4);
    assert!(!chunks.exists(), "nothing is left behind");
    let view = state(&harness).view.sweep.clone();
    let (restored, _) = State::restore(&state(&harness).save().expect("saved")).expect("restored");
    assert_eq!(restored.view.sweep, view);
}

#[test]
fn a_sweep_that_is_cancelled_writes_no_part_of_a_chunk() {
    let folder = tempfile::tempdir().expect("a folder");
    let chunks = folder.path().join("chunks");
    let mut harness = opened(plan_in(folder.path(), "plan.toml", 20_000, 20_000), &chunks);
    apply(&mut harness, Command::Sweep(SweepCommand::Start));
    apply(&mut harness, Command::Sweep(SweepCommand::Cancel));
    step_until(&mut harness, "the end", is_known);
    let said: Vec<&str> =
        state(&harness).session.log.iter().map(|(_, message)| message.text.as_str()).collect();
    assert!(said.iter().any(|text| text.contains("finished chunks stay")), "{said:?}");
    assert!(!chunk_path(&chunks, 0).exists());
    assert_eq!(n_missing(state(&harness)), 1);
}

#[test]
fn the_folder_of_another_sweep_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let chunks = folder.path().join("chunks");
    let mut harness = opened(plan_in(folder.path(), "one.toml", 2, 2), &chunks);
    apply(&mut harness, Command::Sweep(SweepCommand::Start));
    step_until(&mut harness, "the chunk", |state| is_known(state) && n_missing(state) == 0);
    apply(&mut harness, Command::Open(vec![plan_in(folder.path(), "other.toml", 3, 3)]));
    step_until(&mut harness, "the other plan", is_known);
    apply(&mut harness, Command::Sweep(SweepCommand::Folder(chunks)));
    step_until(&mut harness, "a refusal", |state| state.session.sweep.refusal().is_some());
    let why = state(&harness).session.sweep.refusal().expect("a reason");
    assert!(why.contains("another plan"), "{why}");
    harness.run_steps(2);
    assert!(harness.query_by_label("Start").is_none());
}
