//! Evidence that cannot be: each is refused with its place, or answered with a badge that says so. None
//! is answered narrowly without a word.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::PathBuf;
use std::process::Output;

use serde_json::Value;
use tempfile::TempDir;

use crate::program::{json, ok, program, text};

const SPIN: &str = include_str!("../data/evidence/spin.toml");

/// The last line of the evidence, after which more can stand.
const END: &str = "speed_before_sigma_m_s = 0.8";

/// A file that is larger than any that is read.
const HUGE_BYTES: usize = 8 << 20;

fn reconstruct(folder: &TempDir, evidence: &[u8]) -> Output {
    let path = folder.path().join("evidence.toml");
    fs::write(&path, evidence).unwrap();
    let args = ["reconstruct", text(&path), "--particles", "50", "--json"];
    program().args(args).output().unwrap()
}

/// The evidence with some text in the place of another.
fn changed(from: &str, to: &str) -> String {
    assert_eq!(SPIN.matches(from).count(), 1, "{from}");
    SPIN.replace(from, to)
}

fn with_mark(rest: &str) -> String {
    changed(END, &format!("{END}\n[[mark]]\n{rest}"))
}

/// Checks that the evidence is refused in one line that names place and reason.
fn check_refused(folder: &TempDir, evidence: &[u8], expected: &[&str]) {
    let refused = reconstruct(folder, evidence);
    let error = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(1), "{expected:?}: {error}");
    assert_eq!((error.lines().count(), refused.stdout.len()), (1, 0), "{error}");
    for part in [&["evidence.toml"], expected].concat() {
        assert!(error.contains(part), "{part:?} is not in {error}");
    }
}

#[test]
fn what_cannot_be_is_refused_with_line_key_and_what_is_expected() {
    let folder = TempDir::new().unwrap();
    for (evidence, place, key, expected) in [
        (changed("x_m = 45", "x_m = 5000"), "12:7", "rest.x_m", "-2000 to 2000 m"),
        (changed("x_m = 45", "x_m = inf"), "12:7", "rest.x_m", "-2000 to 2000 m"),
        (changed("y_m = -6", "y_m = -6\nposition_sigma_m = 0"), "14:20", "sigma_m", "0.001 to"),
        (changed("x_m = 45\ny_m = -6\n", ""), "11:2", "rest.x_m", "missing"),
        (changed("heading_rad = -2.9", "heading_sigma_rad = 1"), "11:2", "heading", "missing"),
        (changed("friction = 0.7", "friction = 3"), "3:12", "road.friction", "0.01 to 2"),
        (changed("friction = 0.7", "friction = nan"), "3:12", "road.friction", "0.01 to 2"),
        (changed("mass_kg = 1900", "mass_kg = -1900"), "5:11", "struck_car.mass_kg", "1 to 50000"),
        (changed("mass_kg = 1700", "mass_kg = nan"), "7:11", "striking_car.mass_kg", "1 to 50000"),
        (changed("[]", "[\"XX\"]"), "16:19", "blocked_wheels", "\"FL\", \"FR\", \"RL\", \"RR\""),
        (changed("_m_s = 20", "_m_s = -5"), "18:20", "speed_before_m_s", "0 to 150 m/s"),
        (
            changed(END, "delta_v_y_min_m_s = 2\ndelta_v_y_max_m_s = 1"),
            "20:21",
            "edr.delta_v_y_max_m_s",
            "delta_v_y_min or more",
        ),
        (changed(END, "delta_v_y_min_m_s = 2"), "17:2", "edr.delta_v_y_max_m_s", "missing"),
        (
            changed(END, "[prior]\ntarget_speed_m_s = [30, 20]"),
            "20:20",
            "prior.target_speed_m_s",
            "[low, high]",
        ),
        (with_mark("wheel = \"XX\""), "21:9", "wheel", "\"FL\" or \"FR\" or \"RL\" or \"RR\""),
        (with_mark("wheel = \"RR\"\npoints_m = [[1, 2]]"), "22:12", "points_m", "two points"),
        (with_mark("wheel = \"RR\"\npoints_m = []"), "22:12", "points_m", "two points"),
        (
            with_mark("wheel = \"RR\"\npoints_m = [[1, 2], [1, 2], [1, 2]]"),
            "22:12",
            "points_m",
            "points that differ",
        ),
        (with_mark("wheel = \"RR\"\npoints_m = [[1, 2], [nan, 2]]"), "22:21", "points_m", "-2000"),
        (
            with_mark("wheel = \"RR\"\nstart_m = [9, 9]\npoints_m = [[1, 2], [9, 9]]"),
            "23:12",
            "points_m",
            "begin at start_m",
        ),
        (String::new(), "1:1", "struck_car", "missing"),
        ("[road]\n".to_owned(), "1:1", "struck_car", "missing"),
        ("{\"case\": 1}".to_owned(), "1:1", "", "expected"),
    ] {
        let place = format!("evidence.toml:{place}: ");
        check_refused(&folder, evidence.as_bytes(), &[&place, key, expected]);
    }
    let huge = format!("{SPIN}# {}", "x".repeat(HUGE_BYTES));
    check_refused(&folder, huge.as_bytes(), &["1048576"]);
    check_refused(&folder, b"case = \"\xff\"", &["not UTF-8 text"]);
    let off = changed("x_m = -1.7", "x_m = -8");
    check_refused(&folder, off.as_bytes(), &["the struck car", "off the outline"]);
    let missing = PathBuf::from("no-evidence.toml");
    let refused = program().args(["reconstruct", text(&missing)]).output().unwrap();
    assert!(String::from_utf8(refused.stderr).unwrap().contains("no-evidence.toml"));
}

/// The report, and the width of the 90 % interval of the struck car's speed, m/s; infinite where the
/// particles are too few for one.
fn answered(folder: &TempDir, evidence: &str) -> (Value, f64) {
    let report = json(&ok(reconstruct(folder, evidence.as_bytes())));
    let interval = &report["quantities"][0]["interval_90"];
    let end = |idx: usize| interval[idx].as_f64();
    let width = end(0).zip(end(1)).map_or(f64::INFINITY, |(low, high)| high - low);
    (report, width)
}

fn badges<'a>(report: &'a Value, kind: &str) -> Vec<&'a Value> {
    let all = report["badges"].as_array().unwrap();
    all.iter().filter(|badge| badge["kind"] == kind).collect()
}

#[test]
fn what_nothing_explains_is_a_badge() {
    let folder = TempDir::new().unwrap();
    let marks = "wheel = \"RR\"\npoints_m = [[40, -5], [27, -2.5], [15, -1], [5, -0.9]]";
    for evidence in [
        // The recorder says 20 m/s, and the car lies 1.9 km away, or behind where it was struck.
        changed("x_m = 45", "x_m = 1900"),
        changed("x_m = 45", "x_m = -150"),
        // It says 3 m/s, and the car came 45 m far.
        changed("_m_s = 20", "_m_s = 3"),
        // It was pushed to the side from which it was hit.
        changed(END, &format!("{END}\ndelta_v_y_min_m_s = -12\ndelta_v_y_max_m_s = -11")),
        // A mark against the order of time, and one of another car.
        with_mark(marks),
        with_mark("wheel = \"RR\"\npoints_m = [[5, 40], [20, 42]]"),
    ] {
        let (report, _) = answered(&folder, &evidence);
        let caveats = badges(&report, "evidence_unexplained");
        assert!(!caveats.is_empty(), "{evidence}: {}", report["fit"]);
    }
}

#[test]
fn where_nothing_is_known_the_answer_is_wide() {
    let folder = TempDir::new().unwrap();
    let (start, _) = SPIN.split_once("[rest]").unwrap();
    let (rest, _) = SPIN.split_once("[edr]").unwrap();
    // Nothing, and a rest pose that takes a course of events of its own.
    for evidence in [start.to_owned(), rest.replace("y_m = -6", "y_m = -300")] {
        let (report, width) = answered(&folder, &evidence);
        let caveats = badges(&report, "evidence_unexplained");
        assert!(width > 8.0 || !caveats.is_empty(), "{evidence}: {width} m/s wide");
    }
}

#[test]
fn a_lorry_is_outside_of_what_is_known() {
    let folder = TempDir::new().unwrap();
    let (report, _) = answered(&folder, &changed("mass_kg = 1900", "mass_kg = 20170"));
    let mut caveats = badges(&report, "outside_domain");
    // Its way of meeting the other car is none that was tried, either.
    caveats.retain(|caveat| !caveat["quantity"].is_null());
    assert_eq!(caveats.len(), 3, "{caveats:?}");
    assert_eq!(caveats[0]["quantity"], "mass of the struck car [kg]");
    assert_eq!((&caveats[0]["value"], &caveats[0]["range"][1]), (&20_170.0.into(), &2750.0.into()));
}
