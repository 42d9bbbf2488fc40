//! Cases: what they hold comes back, and what has changed is said.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use impactlab_core::data::Existing;
use impactlab_study::case_file::{CaseError, CaseFile, Change, UsedFile, Variant, pack};
use impactlab_study::{
    Drive, Event, ImpactRequest, Library, MotionSource, Report, Request, ScenarioChoice,
    SeriesFile, SimulateRequest,
};

/// A folder of the test's own, empty.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("case_file").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// A pulse of 60 kN over 80 ms.
pub(crate) fn force_file(folder: &Path) -> PathBuf {
    let mut text = "t [s],Fx [N],Fy [N]\n".to_owned();
    for i in 0..=120 {
        let time_s = i as f64 * 1e-3;
        let newtons = 60e3 * (std::f64::consts::PI * time_s / 0.08).sin().max(0.0);
        let newtons = if time_s < 0.08 { newtons } else { 0.0 };
        text += &format!("{time_s},0,{newtons}\n");
    }
    let path = folder.join("force.csv");
    fs::write(&path, text).expect("written");
    path
}

/// A case of two variants: a scenario of the program, and a force file of its own.
pub(crate) fn case(force: &Path) -> CaseFile {
    let scenario = ScenarioChoice::File("pit-right-rear".into());
    let impact = Request::from(ImpactRequest::new(scenario));
    let drive =
        Drive { speed_m_s: Some(20.0), force: Some(SeriesFile::new(force)), ..Drive::default() };
    let simulate = SimulateRequest::new(MotionSource::Drive(drive));
    let struck =
        Variant { name: "struck".to_owned(), questions: vec![impact], ..Variant::default() };
    let mut case = CaseFile::new("Crossing", struck);
    case.variants.push(Variant {
        name: "measured".to_owned(),
        questions: vec![simulate.into()],
        view: serde_json::json!({"file": force, "speed": 20.0}),
        ..Variant::default()
    });
    case.notes = "two lines\nof notes".to_owned();
    case.record_files();
    case.note("made");
    case
}

#[test]
fn a_case_is_saved_with_relative_paths_and_comes_back() {
    let folder = folder("saved");
    let case = case(&force_file(&folder));
    let path = folder.join("crossing.impactlab");
    case.save(&path, Existing::Refuse).expect("saved");
    let text = fs::read_to_string(&path).expect("text");
    assert!(text.contains("\"./force.csv\"") && !text.contains(folder.to_str().unwrap()), "{text}");
    let again = CaseFile::load(&path).expect("loaded");
    assert_eq!(again, case);
    assert!(again.changes().is_empty());
    // What is there is not replaced unless that is said.
    assert!(matches!(case.save(&path, Existing::Refuse), Err(CaseError::Data(_))));
    // Saved again it is the same text.
    again.save(&path, Existing::Replace).expect("saved");
    assert_eq!(fs::read_to_string(&path).expect("text"), text);
}

#[test]
fn a_case_and_its_files_can_be_moved_together() {
    let [old, new] = [folder("old"), folder("new")];
    let case = case(&force_file(&old));
    case.save(&old.join("a.impactlab"), Existing::Refuse).expect("saved");
    for name in ["a.impactlab", "force.csv"] {
        fs::rename(old.join(name), new.join(name)).expect("moved");
    }
    let moved = CaseFile::load(&new.join("a.impactlab")).expect("loaded");
    assert_eq!(moved.used_paths(), [new.join("force.csv")]);
    assert!(moved.changes().is_empty());
    let report = moved.ask(&[], &Library::default(), &mut |_| ControlFlow::Continue(()));
    let report = report.expect("asked").complete().expect("answers");
    assert!(report.is_clean(), "{report:?}");
}

#[test]
fn every_question_is_answered_as_its_command_answers_it() {
    let folder = folder("asked");
    let mut case = case(&force_file(&folder));
    let library = Library::default();
    let mut go_on = |_: Event<'_>| ControlFlow::Continue(());
    let report = case.ask(&[], &library, &mut go_on).expect("asked").complete().expect("answers");
    for (variant, answered) in case.variants.iter().zip(&report.variants) {
        for (request, answer) in variant.questions.iter().zip(&answered.answers) {
            let alone = request.run(&library, &mut go_on).expect("an answer").complete();
            assert_eq!(answer.report, alone);
        }
    }
    assert!(matches!(report.variants[0].answers[0].report, Some(Report::Impact(_))));
    // One question without an answer leaves the others theirs.
    fs::remove_file(folder.join("force.csv")).expect("removed");
    let report = case.ask(&[], &Library::default(), &mut go_on).expect("asked").complete();
    let report = report.expect("answers");
    assert!(report.variants[0].answers[0].error.is_none());
    let error = report.variants[1].answers[0].error.clone().expect("an error");
    assert!(error.contains("force.csv"), "{error}");
    assert!(!report.is_clean());
    // Of one variant alone.
    let only = case.ask(&["struck".to_owned()], &library, &mut go_on).expect("asked").complete();
    assert_eq!(only.expect("answers").variants.len(), 1);
    let wrong = case.ask(&["strukc".to_owned()], &library, &mut go_on).expect_err("no variant");
    assert_eq!(
        wrong.to_string(),
        "there is no variant \"strukc\", expected one of: struck, measured"
    );
    case.variants[1].name = "struck".to_owned();
    let path = folder.join("twice.impactlab");
    case.save(&path, Existing::Refuse).expect("saved");
    assert!(matches!(CaseFile::load(&path), Err(CaseError::SameName { .. })));
}

#[test]
fn files_that_are_missing_or_have_changed_are_named() {
    let folder = folder("changed");
    let force = force_file(&folder);
    let case = case(&force);
    fs::write(&force, "t [s],Fx [N],Fy [N]\n0,0,0\n0.1,0,9\n").expect("changed");
    assert_eq!(case.changes(), [Change::Changed { path: force.clone() }]);
    fs::remove_file(&force).expect("removed");
    assert!(matches!(case.changes()[..], [Change::Missing { .. }]));
    let error = pack(&case, &folder.join("a.zip"), Existing::Refuse).expect_err("missing");
    assert!(matches!(error, CaseError::Missing { .. }), "{error}");
    assert!(!folder.join("a.zip").exists());
}

#[test]
fn a_file_that_never_was_there_is_missing_too() {
    let folder = folder("never");
    let case = case(&folder.join("nowhere.csv"));
    assert!(case.files.is_empty());
    assert!(
        matches!(&case.changes()[..], [Change::Missing { path, .. }] if path.ends_with("nowhere.csv"))
    );
    let error = pack(&case, &folder.join("a.zip"), Existing::Refuse).expect_err("missing");
    assert!(matches!(error, CaseError::Missing { .. }), "{error}");
    assert!(!folder.join("a.zip").exists());
}

#[test]
fn a_folder_and_its_table_are_known_by_the_files_of_their_cases() {
    let set = folder("dataset").join("set");
    fs::create_dir_all(set.join("forces")).expect("a folder");
    fs::write(set.join("cases.csv"), "case\n1\n").expect("written");
    fs::write(set.join("forces/1.csv"), "b").expect("written");
    for path in [set.clone(), set.join("cases.csv")] {
        let before = UsedFile::read(&path).expect("read");
        assert_eq!(before.bytes, 8);
        for stray in [".hidden", "letter.txt", "forces/2.csv"] {
            fs::write(set.join(stray), "x").expect("written");
        }
        assert_eq!(UsedFile::read(&path).expect("read"), before);
        fs::write(set.join("forces/1.csv"), "c").expect("written");
        assert_ne!(UsedFile::read(&path).expect("read").sha256, before.sha256);
        fs::write(set.join("forces/1.csv"), "b").expect("written");
    }
}

#[test]
fn what_is_no_case_is_refused_with_its_place() {
    let path = Path::new("/cases/a.impactlab");
    let error = |text: &str| CaseFile::parse(text, path).expect_err("no case");
    let says = |text: &str, message: &str| {
        let error = error(text).to_string();
        assert!(error.contains(message), "{error}");
    };
    says("{\"format\": \"impactlab case\",\n  \"version\": 1,,", "/cases/a.impactlab:2:");
    says("{\"format\": \"gpx\", \"version\": 1}", "format is \"gpx\"");
    says("{\"format\": \"impactlab case\", \"version\": 9}", "version 9");
    let case = CaseFile::new("a", Variant { name: "b".to_owned(), ..Variant::default() });
    let text = case.to_text(path).expect("text");
    says(&text.replace("\"shown\": \"b\"", "\"shown\": \"c\""), "no variant \"c\"");
    let unknown = error(&text.replace("\"notes\"", "\"note\""));
    assert!(matches!(unknown, CaseError::Syntax { .. }));
    // “a.impactlab:6:8: is no case: unknown field `note` at line 6 column 8”
    let told = impactlab_core::error_chain(&unknown);
    assert!(told.contains("unknown field `note`") && !told.contains("at line"), "{told}");
}
