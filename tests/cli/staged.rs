//! `evaluate reconstruction`: staged collisions beside their truths.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::program::{json, ok, program, text};

/// An evaluation with few particles.
const TINY: [&str; 6] =
    ["evaluate", "reconstruction", "datasets/staged", "--particles", "50", "--json"];

/// Two cases: one with a speed in its event data recorder, one without a record.
const BOTH: [&str; 2] = ["s00", "s07"];

fn evaluated(more: &[&str]) -> Value {
    evaluated_of(&BOTH, more)
}

fn evaluated_of(only: &[&str], more: &[&str]) -> Value {
    json(&ok(program().args(TINY).arg("--only").args(only).args(more).output().unwrap()))
}

fn cases(report: &Value) -> impl Iterator<Item = &Value> {
    report["cases"].as_array().unwrap().iter()
}

/// The median speed of the struck car that a row tells, m/s.
fn median(case: &Value) -> f64 {
    case["quantities"][0]["median"].as_f64().unwrap()
}

#[test]
fn each_case_and_part_of_the_evidence_stands_beside_the_truth() {
    let report = evaluated(&["--known", "everything", "--known", "rest-only", "--without-swarm"]);
    assert_eq!((&report["n_cases"], &report["stopped"]), (&2.into(), &false.into()));
    assert_eq!(report["left_out"].as_array().unwrap().len(), 0);
    let rows: Vec<[&str; 3]> = cases(&report)
        .map(|row| ["case", "known", "method"].map(|key| row[key].as_str().unwrap()))
        .collect();
    let mut expected = Vec::new();
    for case in BOTH {
        for known in ["everything", "rest_only"] {
            expected.extend(["reconstruction", "hand"].map(|method| [case, known, method]));
        }
    }
    assert_eq!(rows, expected);
    for row in cases(&report) {
        let target = &row["quantities"][0];
        assert_eq!(target["name"], "target_speed_m_s");
        let truth = if row["case"] == "s00" { 14.9641 } else { 31.5338 };
        assert_eq!(target["truth"], truth);
        assert!(target["crps"].as_f64().unwrap() > 0.0, "{target}");
        // The hand knows no speed of the striking car.
        let n = if row["method"] == "hand" { 2 } else { 6 };
        assert_eq!(row["quantities"].as_array().unwrap().len(), n);
    }
    // |(30.9674 − 31.5338, 3.8806)|.
    let closing = &cases(&report).nth(4).unwrap()["quantities"][1];
    assert!((closing["truth"].as_f64().unwrap() - 3.921_72).abs() < 1e-4, "{closing}");
    let summary = report["summary"].as_array().unwrap();
    assert_eq!(summary.len(), 4);
    for method in summary {
        assert_eq!(method["n_cases"], 2);
        let coverage = method["quantities"][0]["coverage_90"].as_f64().unwrap();
        assert!([0.0, 0.5, 1.0].contains(&coverage), "{method}");
    }
}

#[test]
fn the_optimum_of_a_swarm_has_intervals_too() {
    let report = evaluated(&["--known", "rest-only", "--cases", "tuning"]);
    assert_eq!(cases(&report).count(), 6);
    for swarm in cases(&report).filter(|row| row["method"] == "swarm") {
        assert!(swarm["n_simulations"].as_u64().unwrap() > 10_000, "{swarm}");
        for quantity in swarm["quantities"].as_array().unwrap() {
            let [low, high] = [0, 1].map(|end| quantity["interval_90"][end].as_f64().unwrap());
            assert!(low < high, "{quantity}");
        }
    }
}

#[test]
fn what_is_asked_of_one_case_is_what_reconstruct_answers() {
    let args = ["--known", "everything", "--without-swarm", "--seed", "4"];
    let report = evaluated_of(&["s07"], &args);
    assert_eq!(cases(&report).count(), 2);
    let file = "datasets/staged/evidence/s07.toml";
    let args = ["reconstruct", file, "--particles", "50", "--seed", "4", "--json"];
    let alone = json(&ok(program().args(args).output().unwrap()));
    let of_s07 = cases(&report).find(|row| row["case"] == "s07").unwrap();
    assert_eq!(of_s07["quantities"][0]["median"], alone["quantities"][0]["median"]);
    assert_eq!(of_s07["n_simulations"], alone["n_simulations"]);
    // A number by hand that holds says why; one that does not hold is left out.
    for check in alone["by_hand"].as_array().unwrap() {
        assert!(check["value_m_s"].as_f64().unwrap() > 0.0, "{check}");
        assert!(!check["holds"].as_str().unwrap().is_empty(), "{check}");
    }
}

#[test]
fn finished_cases_are_kept_and_taken_by_the_same_question_only() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let finished = out.join("finished/s07-everything.json");
    let ask = |only: &[&str], more: &[&str]| {
        let args = ["--known", "everything", "--without-swarm", "--overwrite", "--out", text(&out)];
        evaluated_of(only, &[&args[..], more].concat())
    };
    let first = ask(&BOTH, &[]);
    let table = fs::read_to_string(out.join("evaluation.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 4, "{table}");
    assert!(table.starts_with("case,known,method,seconds,ess,n_simulations,target_speed_true_m_s"));
    // As if the evaluation had been killed between the two cases: the times show what was taken.
    let made_last = ["manifest.json", "evaluation.csv", "evaluation.json"];
    for name in made_last.iter().chain(&["finished/s00-everything.json"]) {
        fs::remove_file(out.join(name)).unwrap();
    }
    let seconds = |report: &Value, idx: usize| cases(report).nth(idx).unwrap()["seconds"].clone();
    let second = ask(&BOTH, &[]);
    assert_eq!(seconds(&second, 2), seconds(&first, 2));
    assert_ne!(seconds(&second, 0), seconds(&first, 0));
    for (a, b) in cases(&first).zip(cases(&second)) {
        assert_eq!(a["quantities"], b["quantities"]);
    }
    // Another seed is another question; a file that is cut short is none.
    let before = fs::read(&finished).unwrap();
    let other = ask(&["s07"], &["--seed", "1"]);
    assert_ne!(fs::read(&finished).unwrap(), before);
    let of_other = median(cases(&other).next().unwrap());
    assert_ne!(of_other, median(cases(&first).nth(2).unwrap()));
    let whole = fs::read(&finished).unwrap();
    fs::write(&finished, &whole[..whole.len() / 2]).unwrap();
    let again = ask(&["s07"], &["--seed", "1"]);
    assert_eq!(median(cases(&again).next().unwrap()), of_other);
}

#[test]
fn what_cannot_be_evaluated_is_said_before_any_work() {
    let folder = TempDir::new().unwrap();
    let copy = |from: &str, to: &str| {
        let to = folder.path().join(to);
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(Path::new("datasets/staged").join(from), to).unwrap();
    };
    copy("evidence/s00.toml", "evidence/s00.toml");
    let refused = |args: &[&str]| {
        let ran = program().args(["evaluate", "reconstruction"]).args(args).output().unwrap();
        assert_eq!(ran.status.code(), Some(1), "{args:?}");
        String::from_utf8(ran.stderr).unwrap()
    };
    let own = text(folder.path());
    let error = refused(&[own]);
    assert!(error.contains("truth/s00.toml") && error.contains("is not there"), "{error}");
    let error = refused(&["datasets/staged", "--only", "s99"]);
    assert!(error.contains("no case \"s99\"") && error.contains("40 cases"), "{error}");
    let error = refused(&["datasets/staged", "--only", "s00", "--cases", "reported"]);
    assert!(error.contains("no case is chosen"), "{error}");
    assert!(refused(&["datasets/fea"]).contains("evidence"));
    // What is wrong with one case is told beside the others.
    copy("evidence/s07.toml", "evidence/s07.toml");
    copy("truth/s00.toml", "truth/s00.toml");
    fs::write(folder.path().join("truth/s07.toml"), "case = \"s07\"\n").unwrap();
    let args = [own, "--particles", "50", "--without-swarm", "--known", "rest-only"];
    let ran = program().args(["evaluate", "reconstruction"]).args(args).output().unwrap();
    assert_eq!(ran.status.code(), Some(1));
    let printed = String::from_utf8(ran.stdout).unwrap();
    assert!(printed.contains("\ns07") && printed.contains("[struck_car] is missing"), "{printed}");
    assert!(printed.contains("rest only  reconstruction"), "{printed}");
}
