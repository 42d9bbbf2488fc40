//! Leaving a case that is still being written, and allowing one what it does.

use impactlab::app::{Dialog, LeavingStage};

use super::*;

fn is_waiting(dialog: &Dialog) -> bool {
    matches!(dialog, Dialog::Leave { stage: LeavingStage::Written { .. }, .. })
}

/// The window with a case that is in its file, of which one variant more is being saved while the user
/// quits.
///
/// - `prepare`: what happens before the save, to the folder of the case.
fn quit_while_saving(path: &Path, prepare: impl FnOnce()) -> Harness<'static, App> {
    let mut harness = pit();
    save_as(&mut harness, path);
    variant(&mut harness, VariantCommand::Duplicate);
    prepare();
    let context = harness.ctx.clone();
    let app = harness.state_mut();
    app.apply(Command::Case(CaseCommand::Save), &context);
    app.apply(Command::Case(CaseCommand::Leave(Leaving::Quit)), &context);
    assert!(!app.state().session.may_close && app.state().session.dialogs.is_any_open());
    step_until(&mut harness, "the end of the save", |state| {
        !state.session.dialogs.iter().any(is_waiting)
    });
    harness
}

#[test]
fn a_window_that_is_closed_during_a_save_closes_after_it_unasked() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pit.impactlab");
    let mut harness = quit_while_saving(&path, || {});
    step_until(&mut harness, "the end", |state| state.session.may_close);
    assert!(!state(&harness).session.dialogs.is_any_open());
    assert_eq!(CaseFile::load(&path).expect("a case").variants.len(), 2);
}

/// The window ended, and nobody was told.
#[test]
fn a_save_that_fails_at_quit_keeps_the_window_open_and_says_why() {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = folder.path().join("inside");
    fs::create_dir(&inside).expect("a folder");
    let path = inside.join("pit.impactlab");
    let gone = || fs::remove_dir_all(&inside).expect("removed");
    let mut harness = quit_while_saving(&path, gone);
    assert!(!state(&harness).session.may_close);
    harness.get_by_label("Quit impactlab?");
    harness.get_by_label("The case \"pit\" has changes that are not in its file.");
    let why = state(&harness).session.messages.last().expect("a message").text.clone();
    assert!(why.starts_with("the case was not saved: "), "{why}");
    harness.get_by_label(&why);
    harness.get_by_label("Quit").click();
    harness.run_steps(3);
    assert!(state(&harness).session.may_close);
}

/// The last of what a case does was “and 5 more”, which the user allowed unseen.
#[test]
fn all_that_a_case_does_is_listed_before_it_is_allowed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("case/a.impactlab");
    fs::create_dir(folder.path().join("case")).expect("a folder");
    let paths = (0..25).map(|n| folder.path().join(format!("secret-{n:02}"))).collect();
    let questions = vec![CheckRequest { paths, all: false, map: None }.into()];
    let variant = Variant { name: "base".to_owned(), questions, ..Variant::default() };
    CaseFile::new("a", variant).save(&path, Existing::Refuse).expect("written");
    let phrases = CaseFile::load(&path).expect("a case").reach(&path).phrases();
    assert_eq!(phrases.len(), 25, "{phrases:?}");
    let mut harness = open(&[SCENARIO]);
    apply(&mut harness, Command::Open(vec![path]));
    harness.run_steps(3);
    harness.get_by_label("Open a.impactlab?");
    for phrase in &phrases {
        assert!(harness.query_by_label(phrase).is_some(), "{phrase} is not listed");
    }
}

#[test]
fn cases_that_are_being_saved_are_written_before_the_window_ends() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pit.impactlab");
    let mut harness = pit();
    save_as(&mut harness, &path);
    let context = harness.ctx.clone();
    let app = harness.state_mut();
    for _ in 0..2 {
        app.apply(Command::Variant(VariantCommand::Duplicate), &context);
        app.apply(Command::Case(CaseCommand::Save), &context);
    }
    assert!(!app.state().session.dialogs.is_any_open(), "its own save is nobody else's change");
    eframe::App::on_exit(app, None);
    assert_eq!(CaseFile::load(&path).expect("a case").variants.len(), 3);
    assert!(!state(&harness).session.tasks.is_running(&TaskKey::SaveCase));
    assert!(!state(&harness).is_case_changed());
}

/// The log of the case became that of its file once a save had ended, without what was noted meanwhile.
#[test]
fn what_is_noted_while_a_case_is_saved_stays_in_its_log() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pit.impactlab");
    let mut harness = pit();
    save_as(&mut harness, &path);
    let context = harness.ctx.clone();
    let app = harness.state_mut();
    app.apply(Command::Case(CaseCommand::Save), &context);
    app.apply(Command::Variant(VariantCommand::Duplicate), &context);
    step_until(&mut harness, "the case on disk", |state| {
        !state.session.tasks.is_running(&TaskKey::SaveCase)
    });
    let log = &state(&harness).case.file.log;
    let events: Vec<&str> = log.iter().map(|entry| entry.event.as_str()).collect();
    let copied = "variant \"base 2\" copied from \"base\"";
    assert_eq!(events, ["saved", "saved", copied]);
    assert!(log.is_sorted_by_key(|entry| &entry.time), "{log:?}");
}
