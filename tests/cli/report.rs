//! `report`: what it writes and refuses, and that its numbers are those that the commands print.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::{Path, PathBuf};

use impactlab_core::data::Existing;
use impactlab_core::numerics::sha256_hex;
use impactlab_study::case_file::{CaseFile, Variant};
use impactlab_study::{EvidenceChoice, ReconstructRequest};
use tempfile::TempDir;

use crate::program::{json, ok, program, text};

const PIT: &str = "assets/examples/pit.impactlab";
const EVIDENCE: &str = "tests/data/evidence/spin.toml";
const VARIANT: [&str; 4] = ["--variant", "coasts", "--date", "2026-11-24"];

fn written(case: &str, args: &[&str], name: &str, folder: &Path) -> Vec<u8> {
    let out = folder.join(name);
    let args = [&["report", case, "--out", text(&out)], args].concat();
    ok(program().args(args).output().unwrap());
    fs::read(out).unwrap()
}

/// Numbers with a decimal point in a text.
fn numbers(text: &str) -> Vec<f64> {
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-');
    let words = text.split(|c: char| !is_part(c));
    let words = words.map(|word| word.trim_end_matches(['.', '-']));
    words.filter(|word| word.contains('.')).filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn the_numbers_are_those_that_the_commands_print() {
    let folder = TempDir::new().unwrap();
    let report = written(PIT, &VARIANT, "report.md", folder.path());
    let report = String::from_utf8(report).unwrap();
    let in_report = numbers(&report);
    let printed = ok(program().args(["case", "run", PIT, "--variant", "coasts"]).output().unwrap());
    let keys = [
        "change of velocity",
        "Δv over the contact",
        "position at the end",
        "length of the path",
        "heading at the end",
        "speed at the end",
    ];
    let mut n_checked = 0;
    for line in printed.lines().filter(|line| keys.iter().any(|key| line.starts_with(key))) {
        for number in numbers(line) {
            assert!(in_report.contains(&number), "{number} of {line:?} is not in the report");
            n_checked += 1;
        }
    }
    assert!(n_checked >= 10, "{n_checked}");
}

#[test]
fn evidence_by_itself_gives_the_report_of_a_case_that_asks_for_its_reconstruction() {
    let folder = TempDir::new().unwrap();
    let evidence = folder.path().join("spin.toml");
    fs::copy(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(EVIDENCE), &evidence).unwrap();
    let args = ["--date", "2026-11-24", "--particles", "60", "--seed", "3"];
    let of_evidence = written(text(&evidence), &args, "evidence.md", folder.path());
    let choice = EvidenceChoice::File(evidence);
    let name = choice.load().unwrap().case;
    let question = ReconstructRequest { particles: 60, seed: 3, ..ReconstructRequest::new(choice) };
    let variant =
        Variant { name: name.clone(), questions: vec![question.into()], ..Variant::default() };
    let case = folder.path().join("case.impactlab");
    CaseFile::new(name, variant).save(&case, Existing::Refuse).unwrap();
    let of_case = written(text(&case), &args[..2], "case.md", folder.path());
    // Only one of them stands in a file, which the opinion names among its materials.
    let [of_evidence, of_case] = [of_evidence, of_case].map(|of| String::from_utf8(of).unwrap());
    let in_no_file = "- The case itself was not saved to a file.";
    let of_file = of_case.lines().find(|line| line.starts_with("- Case file case.impactlab: "));
    assert_eq!(of_evidence, of_case.replace(of_file.unwrap(), in_no_file));
    let out = folder.path().join("other.md");
    let wrong =
        program().args(["report", text(&case), "--seed", "1", "--out", text(&out)]).output();
    let wrong = wrong.unwrap();
    assert!(!wrong.status.success() && !out.exists());
    assert!(String::from_utf8(wrong.stderr).unwrap().contains("case.impactlab: is a case"));
}

#[test]
fn pages_go_with_the_units_unless_they_are_chosen() {
    let folder = TempDir::new().unwrap();
    let width_pt = |args: &[&str], name: &str| {
        let args = [&VARIANT[..], &["--units", "us"], args].concat();
        let read = lopdf::Document::load_mem(&written(PIT, &args, name, folder.path())).unwrap();
        let page = *read.get_pages().values().next().unwrap();
        let page = read.get_dictionary(page).unwrap();
        let media = page.get(b"MediaBox").and_then(|of| of.as_array()).unwrap();
        media[2].as_float().unwrap().round()
    };
    assert_eq!(width_pt(&[], "us.pdf"), 612.0);
    assert_eq!(width_pt(&["--paper", "a4"], "a4.pdf"), 595.0);
}

#[test]
fn the_same_date_gives_the_same_bytes_and_nothing_is_overwritten_unasked() {
    let folder = TempDir::new().unwrap();
    let first = written(PIT, &VARIANT, "a.pdf", folder.path());
    let again = written(PIT, &VARIANT, "b.pdf", folder.path());
    assert!(first.starts_with(b"%PDF-") && first == again);
    let out = folder.path().join("a.pdf");
    let args = [&["report", PIT, "--out", text(&out), "--json"][..], &VARIANT].concat();
    let refused = program().args(&args).output().unwrap();
    assert_eq!(refused.status.code(), Some(1));
    let error = String::from_utf8(refused.stderr).unwrap();
    assert!(error.contains("a.pdf") && error.contains("--overwrite"), "{error}");
    let printed = json(&ok(program().args(&args).arg("--overwrite").output().unwrap()));
    assert_eq!(printed["date"], "2026-11-24");
    assert_eq!((&printed["sections"], &printed["unanswered"]), (&11.into(), &0.into()));
    assert!(
        printed["pictures"].as_u64().unwrap() >= 5 && printed["changes"] == json("[]"),
        "{printed}"
    );
}

#[test]
fn what_is_wrong_with_the_arguments_is_said_and_nothing_is_written() {
    let folder = TempDir::new().unwrap();
    for (name, args, code, error) in [
        ("report.docx", &[][..], 1, ".pdf, .md or .json"),
        ("report.md", &["--date", "2026-02-30"], 2, "is no day"),
        ("report.md", &["--variant", "nobody"], 1, "nobody"),
        ("report.md", &["--language", "fr"], 2, "fr"),
    ] {
        let out = folder.path().join(name);
        let args = [&["report", PIT, "--out", text(&out)][..], args].concat();
        let refused = program().args(args).output().unwrap();
        assert_eq!(refused.status.code(), Some(code), "{name}");
        let printed = String::from_utf8(refused.stderr).unwrap();
        assert!(printed.contains(error), "{printed}");
        assert!(!out.exists());
    }
}

/// A case was edited in an editor, and nothing said so.
#[test]
fn an_edit_of_a_saved_case_is_said_by_check_and_report() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("pit.impactlab");
    let mut case = CaseFile::load(Path::new(PIT)).unwrap();
    case.variants.iter_mut().for_each(|variant| variant.questions.truncate(1));
    case.save(&path, Existing::Refuse).unwrap();
    let check = || {
        let args = ["case", "check", text(&path), "--json"];
        let output = program().args(args).output().unwrap();
        (output.status.code(), json(&String::from_utf8(output.stdout).unwrap()))
    };
    let (code, saved) = check();
    assert_eq!((code, &saved["is_as_saved"]), (Some(0), &json("true")));
    let digest = |path: &Path| sha256_hex([fs::read(path).unwrap().as_slice()]);
    assert_eq!(saved["sha256"], digest(&path));
    let report = |name: &str| {
        let out = folder.path().join(name);
        let args = ["report", text(&path), "--out", text(&out), "--date", "2026-11-24"];
        let output = program().args(args).output().unwrap();
        (output.status.code(), fs::read_to_string(&out).unwrap())
    };
    let (code, written) = report("saved.md");
    assert_eq!(code, Some(0));
    for part in [digest(&path).as_str(), "its content is what the program saved"] {
        assert!(written.contains(part), "{part}");
    }
    let before = fs::read_to_string(&path).unwrap();
    fs::write(&path, before.replace("PIT at 54 km/h", "PIT at 64 km/h")).unwrap();
    let (code, edited) = check();
    assert_eq!((code, &edited["changes"][0]["kind"]), (Some(1), &json("\"case\"")));
    let (code, written) = report("edited.md");
    assert_eq!(code, Some(1));
    for part in [digest(&path).as_str(), "itself was edited without the program"] {
        assert!(written.contains(part), "{part}");
    }
}
