//! A case of somebody else does nothing but read files in its own folder, unless that is allowed.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::io::{Read, Write};
use std::path::Path;

use impactlab_core::data::Existing;
use impactlab_study::case_file::{CaseFile, Variant, pack};
use impactlab_study::{ImpactRequest, ScenarioChoice};
use serde_json::json;
use tempfile::TempDir;

use crate::program::{SCENARIO, json, ok, program, text};

/// A folder with a secret beside the folder of a case that asks these questions.
fn folder_with(questions: &serde_json::Value) -> TempDir {
    let folder = TempDir::new().unwrap();
    let case = json!({
        "format": "impactlab case", "version": 2, "program": "0.1.0", "name": "crossing",
        "shown": "base", "variants": [{"name": "base", "questions": questions}],
    });
    fs::create_dir(folder.path().join("case")).unwrap();
    fs::write(folder.path().join(".netrc"), "machine a login b password hunter2").unwrap();
    fs::write(folder.path().join("case/a.impactlab"), case.to_string()).unwrap();
    fs::copy("tests/data/evidence/spin.toml", folder.path().join("case/spin.toml")).unwrap();
    folder
}

/// What a command says about the case that it refuses.
fn refused(folder: &Path, args: &[&str]) -> String {
    let output = program().current_dir(folder).args(args).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{args:?}");
    String::from_utf8(output.stderr).unwrap()
}

const RUN: [&str; 3] = ["case", "run", "case/a.impactlab"];
const REPORT: [&str; 4] = ["report", "case/a.impactlab", "--out", "report.md"];
const PACK: [&str; 5] = ["case", "pack", "case/a.impactlab", "--out", "a.zip"];

#[test]
fn a_case_reads_nothing_outside_of_its_folder_unasked() {
    let folder = folder_with(&json!([{"question": "check", "paths": ["../.netrc"]}]));
    let here = folder.path();
    for args in [&RUN[..], &REPORT, &PACK] {
        let error = refused(here, args);
        assert!(error.contains(".netrc; --trust allows this"), "{error}");
        assert!(!error.contains("hunter2"), "{error}");
    }
    assert!(!here.join("report.md").exists() && !here.join("a.zip").exists());
    // What is in it is said all the same, and what it would do.
    let check = ["case", "check", "case/a.impactlab"];
    let checked = program().current_dir(here).args(check).output().unwrap();
    assert_eq!(checked.status.code(), Some(1));
    let checked = String::from_utf8(checked.stdout).unwrap();
    assert!(checked.contains("variant base") && checked.contains("warning: reads "), "{checked}");
    let as_json = program().current_dir(here).args(check).arg("--json").output().unwrap();
    let as_json = json(&String::from_utf8(as_json.stdout).unwrap());
    assert!(as_json["reach"]["reads"][0].as_str().unwrap().ends_with(".netrc"), "{as_json}");
    let packed = program().current_dir(here).args(PACK).args(["--trust", "--json"]).output();
    let packed = json(&ok(packed.unwrap()));
    assert_eq!(packed["files"][0]["name"], "files/0/.netrc", "{packed}");
}

#[test]
fn a_case_writes_and_trains_nothing_unasked() {
    let question = |checkpoint: &str| {
        json!([{"question": "reconstruct", "evidence": {"file": "./spin.toml"}, "particles": 50,
                "vehicle": "Automatic", "striking": "Automatic", "checkpoint": checkpoint,
                "resume": true}])
    };
    for checkpoint in ["../outside.bin", "./inside.bin"] {
        let folder = folder_with(&question(checkpoint));
        for args in [&RUN[..], &REPORT, &PACK] {
            let error = refused(folder.path(), args);
            assert!(error.contains("side.bin; --trust allows this"), "{error}");
        }
        let n_files = fs::read_dir(folder.path().join("case")).unwrap().count();
        assert!(n_files == 2 && !folder.path().join("outside.bin").exists());
    }
    let training = json!([{"question": "train_force", "data": "./set"}]);
    let error = refused(folder_with(&training).path(), &RUN);
    assert!(error.contains("a.impactlab: trains a network; --trust"), "{error}");
}

/// A file of a package that was changed on the way was unpacked without a word.
#[test]
fn a_package_that_is_not_what_was_packed_is_told() {
    let folder = TempDir::new().unwrap();
    let [scenario, zip, changed] =
        ["own.toml", "a.zip", "changed.zip"].map(|name| folder.path().join(name));
    fs::copy(SCENARIO, &scenario).unwrap();
    let question = ImpactRequest::new(ScenarioChoice::File(scenario));
    let variant =
        Variant { name: "one".into(), questions: vec![question.into()], ..Variant::default() };
    pack(&CaseFile::new("a", variant), &zip, Existing::Refuse).unwrap();
    let mut archive = zip::ZipArchive::new(fs::File::open(&zip).unwrap()).unwrap();
    let mut out = zip::ZipWriter::new(fs::File::create(&changed).unwrap());
    for idx in 0..archive.len() {
        let mut entry = archive.by_index(idx).unwrap();
        let (name, mut text) = (entry.name().unwrap().into_owned(), String::new());
        entry.read_to_string(&mut text).unwrap();
        if name.ends_with("own.toml") {
            text.push_str("# changed on the way\n");
        }
        out.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
        out.write_all(text.as_bytes()).unwrap();
    }
    out.finish().unwrap();
    for (package, code) in [(&zip, 0), (&changed, 1)] {
        let to = package.with_extension("unpacked");
        let mut command = program();
        let output =
            command.args(["case", "unpack", text(package), "--out", text(&to)]).output().unwrap();
        let said = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(code), "{said}");
        assert_eq!(said.contains("own.toml: has changed since"), code == 1, "{said}");
        assert!(to.join("a.impactlab").is_file(), "it is unpacked all the same");
    }
}

/// The check of a data set that cannot be read was “answered”, with exit code 0.
#[test]
fn a_check_that_finds_something_wrong_is_no_success_in_a_case_either() {
    let folder = folder_with(&json!([{"question": "check", "paths": ["./broken.csv"]}]));
    let here = folder.path();
    fs::write(here.join("case/broken.csv"), "t [s],Fx [N],Fy [N]\n0,0,x\n").unwrap();
    let output = program().current_dir(here).args(RUN).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.contains("problem  ") && told.contains("broken.csv:1: rows"), "{told}");
    let report = program().current_dir(here).args(REPORT).output().unwrap();
    assert_eq!(report.status.code(), Some(1));
    let request = json!({"question": "check", "paths": ["case/broken.csv"]});
    fs::write(here.join("request.json"), request.to_string()).unwrap();
    let asked = program().current_dir(here).args(["ask", "request.json"]).output().unwrap();
    assert_eq!(asked.status.code(), Some(1));
    assert_eq!(json(&String::from_utf8(asked.stdout).unwrap())["ok"], false);
}
