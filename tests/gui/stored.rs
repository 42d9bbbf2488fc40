//! What the window writes: nothing is replaced unasked, and no stored state is lost.

use std::fs;
use std::path::Path;

use egui::Key;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{App, CaseCommand, Command, Leaving, Network, Output, Pane, Subject};
use impactlab_core::data::Severity;

use crate::harness::{apply, is_idle, open, open_with, state, step_until};

const SCENARIO: &str = "assets/scenarios/pit_right_rear.toml";

/// The messages of the status line as one text.
fn messages(harness: &Harness<'_, App>) -> String {
    let texts = state(harness).session.messages.iter().map(|message| message.text.clone());
    texts.collect::<Vec<_>>().join("\n")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn the_window_never_writes_over_a_file_that_the_case_rests_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("force.csv");
    let recording = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/fea/forces/c001.csv");
    fs::copy(recording, &path).expect("a recording");
    let before = fs::read(&path).expect("a recording");
    let mut harness = open(&[path.to_str().expect("UTF-8")]);
    step_until(&mut harness, "the recording", is_idle);
    for output in [Output::Scenario, Output::Case] {
        for command in [Command::Write, Command::Replace] {
            apply(&mut harness, command(output.clone(), path.clone()));
            harness.run_steps(3);
            assert!(messages(&harness).contains("is an input ("), "{}", messages(&harness));
            assert!(state(&harness).session.dialogs.replacing().is_none(), "nothing to be asked");
        }
    }
    assert!(fs::read(&path).expect("a recording") == before);
}

#[test]
fn the_window_asks_before_it_replaces_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scenario.toml");
    fs::write(&path, "mine").expect("a file");
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the scenario", is_idle);
    let save = Command::Write(Output::Scenario, path.clone());

    apply(&mut harness, save.clone());
    harness.step();
    harness.get_by_label("Replace scenario.toml?");
    harness.get_by_label("Keep it").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("Replace scenario.toml?").is_none());
    apply(&mut harness, save.clone());
    harness.step();
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(state(&harness).session.dialogs.replacing().is_none(), "Escape keeps it too");
    assert_eq!(fs::read_to_string(&path).expect("a file"), "mine");

    apply(&mut harness, save);
    harness.step();
    harness.get_by_label("Replace").click();
    harness.run_steps(3);
    assert!(fs::read_to_string(&path).expect("a file").contains("[target"));
    assert!(state(&harness).session.dialogs.replacing().is_none());

    // A figure, a model and a folder of results are asked about alike; a new name is not.
    step_until(&mut harness, "the models", |state| state.session.force.model.current.is_some());
    for (name, command) in [
        ("model", Command::Write(Output::Model(Network::Force), folder.path().join("model"))),
        ("results", Command::Write(Output::Comparison, folder.path().join("results"))),
    ] {
        match name {
            "results" => {
                fs::create_dir(folder.path().join(name)).expect("a folder");
                fs::write(folder.path().join("results/comparison.json"), "{}").expect("a file");
            }
            _ => fs::write(folder.path().join(name), "mine").expect("a file"),
        }
        apply(&mut harness, command);
        assert!(state(&harness).session.dialogs.replacing().is_some(), "{name}");
        apply(&mut harness, Command::CloseDialog);
    }
    assert_eq!(fs::read_to_string(folder.path().join("model")).expect("a file"), "mine");
    apply(&mut harness, Command::Write(Output::Scenario, folder.path().join("new.toml")));
    assert!(
        folder.path().join("new.toml").exists()
            && state(&harness).session.dialogs.replacing().is_none()
    );
}

/// Opens the app on the example scenario and waits until its state is stored.
fn open_and_store(state_file: &Path) -> Harness<'static, App> {
    let mut harness = open_with(&[SCENARIO], Some(state_file.to_owned()));
    step_until(&mut harness, "the scenario", is_idle);
    harness.run_steps(90);
    let file = state_file.to_owned();
    step_until(&mut harness, "the stored state", move |_| file.exists());
    harness
}

#[test]
fn a_second_window_says_that_it_stores_nothing_and_stores_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let state_file = folder.path().join("state.json");
    let first = open_and_store(&state_file);
    let stored = fs::read_to_string(&state_file).expect("a state");

    let mut second = open_with(&[], Some(state_file.clone()));
    let text = messages(&second);
    let who = format!("process {} is writing it", std::process::id());
    assert!(text.contains("what is changed in this window will not be kept"), "{text}");
    assert!(text.contains(&who) && text.contains("state.json"), "{text}");
    assert_eq!(state(&second).project.subject(), Some(Subject::Scenario), "the state is restored");
    assert!(state(&second).session.unfinished.folder().is_none(), "nor does it share trainings");
    second.state_mut().state_mut().project.simulate.duration_s = 1.25;
    second.run_steps(180);
    drop(second);
    assert_eq!(fs::read_to_string(&state_file).expect("a state"), stored);

    // When the first window is closed, the next one stores its state again.
    drop(first);
    assert_eq!(names(folder.path()), ["state.json"]);
    let mut third = open_and_store(&state_file);
    assert_eq!(messages(&third), "");
    third.state_mut().state_mut().project.simulate.duration_s = 1.25;
    third.run_steps(90);
    step_until(&mut third, "the change", move |_| {
        fs::read_to_string(&state_file).expect("a state").contains("\"duration_s\":1.25")
    });
}

#[test]
fn a_window_that_keeps_nothing_asks_about_a_case_without_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let state_file = folder.path().join("state.json");
    let mut first = open_and_store(&state_file);
    let mut second = open_with(&[SCENARIO], Some(state_file));
    for harness in [&mut first, &mut second] {
        harness.state_mut().state_mut().project.simulate.duration_s = 1.25;
        step_until(harness, "the change", is_idle);
        assert!(state(harness).is_case_changed() && state(harness).case.path.is_none());
    }
    let reasons = |harness: &Harness<'_, App>| state(harness).reasons_to_stay(&Leaving::Quit);
    assert_eq!(reasons(&first), [""; 0], "it is there again at the next start");
    let told = reasons(&second);
    assert!(told.iter().any(|why| why.contains("keeps nothing for the next start")), "{told:?}");

    apply(&mut second, Command::Case(CaseCommand::Leave(Leaving::Quit)));
    second.run_steps(3);
    second.get_by_label("Quit impactlab?");
    second.get_by_label("Stay").click();
    second.run_steps(3);
    assert!(!state(&second).session.may_close);
}

#[test]
fn a_case_that_could_not_be_stored_is_asked_about() {
    let folder = tempfile::tempdir().expect("a folder");
    let state_file = folder.path().join("stored/state.json");
    let mut harness = open_and_store(&state_file);
    fs::remove_dir_all(folder.path().join("stored")).expect("removed");
    harness.state_mut().state_mut().project.simulate.duration_s = 1.25;
    // A second of the window's clock until it is written.
    harness.run_steps(90);
    step_until(&mut harness, "the failure", |state| !state.session.keeps_state);
    let told = state(&harness).reasons_to_stay(&Leaving::Quit);
    assert!(told.iter().any(|why| why.contains("keeps nothing for the next start")), "{told:?}");

    // Nothing is changed once more, and what was not written is written as soon as that is possible.
    fs::create_dir(folder.path().join("stored")).expect("a folder");
    step_until(&mut harness, "the second attempt", |state| state.session.keeps_state);
    let text = fs::read_to_string(&state_file).expect("a state");
    assert!(text.contains("\"duration_s\":1.25"), "{text}");
    assert_eq!(messages(&harness).matches("state.json").count(), 1, "said once");
}

#[test]
fn a_damaged_state_is_kept_under_another_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let state_file = folder.path().join("state.json");
    for (n, damaged) in [&b"{\"version\":1,\"proj"[..], b"", b"\xff\xfe"].into_iter().enumerate() {
        fs::write(&state_file, damaged).expect("a file");
        let harness = open_and_store(&state_file);
        let renamed = folder.path().join(format!("state.json.damaged-{}", n + 1));
        let text = messages(&harness);
        assert!(text.contains("the state of the last run cannot be restored"), "{text}");
        assert!(text.contains(&renamed.display().to_string()), "{text}");
        assert_eq!(fs::read(&renamed).expect("the damaged state"), damaged);
        assert_eq!(state(&harness).session.messages[0].severity, Severity::Warning);
    }
    let left = ["state.json", "state.json.damaged-1", "state.json.damaged-2"];
    assert_eq!(names(folder.path()), [&left[..], &["state.json.damaged-3"]].concat());
}

#[test]
fn a_state_of_a_later_version_stays_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let state_file = folder.path().join("state.json");
    let later = "{\"version\":99,\"project\":\"of the future\"}";
    fs::write(&state_file, later).expect("a file");
    let mut harness = open_with(&[SCENARIO], Some(state_file.clone()));
    step_until(&mut harness, "the scenario", is_idle);
    let text = messages(&harness);
    assert!(text.contains("stored by a later version of the program"), "{text}");
    apply(&mut harness, Command::Show(Pane::Scenario));
    harness.run_steps(180);
    drop(harness);
    assert_eq!(fs::read_to_string(&state_file).expect("a state"), later);
    assert_eq!(names(folder.path()), ["state.json"]);
}

#[test]
fn a_state_that_is_no_file_or_too_large_blocks_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo");
    assert!(made.success());
    let large = folder.path().join("large");
    fs::File::create(&large).and_then(|file| file.set_len(1 << 40)).expect("a sparse file");
    for (path, what) in [(pipe, "is a pipe"), (large, "bytes, at most")] {
        let harness = open_with(&[], Some(path));
        let text = messages(&harness);
        assert!(text.contains("will not be kept") && text.contains(what), "{text}");
    }
    assert_eq!(names(folder.path()), ["large", "pipe"]);
}

#[test]
fn what_was_being_read_when_the_program_died_is_not_opened_unasked() {
    let folder = tempfile::tempdir().expect("a folder");
    let [state_file, force] = ["state.json", "force.csv"].map(|name| folder.path().join(name));
    fs::copy("datasets/fea/forces/c001.csv", &force).expect("a force");
    let mut harness = open_with(&[force.to_str().expect("text")], Some(state_file.clone()));
    let file = state_file.clone();
    step_until(&mut harness, "the stored state", move |state| {
        is_idle(state) && fs::read_to_string(&file).is_ok_and(|text| text.contains("force.csv"))
    });
    drop(harness);
    let record = folder.path().join("reading.json");
    assert!(!record.exists(), "nothing is being read any more");
    fs::write(&record, serde_json::to_string(&[&force]).expect("JSON")).expect("written");
    let mut harness = open_with(&[], Some(state_file));
    harness.run_steps(3);
    harness.get_by_label("Not opened again");
    assert!(state(&harness).session.sources.is_empty());
    harness.get_by_label("Open all the same").click();
    step_until(&mut harness, "the force", |state| {
        is_idle(state) && state.session.sources.iter().any(|source| source.path == force)
    });
    assert!(!record.exists());
}
