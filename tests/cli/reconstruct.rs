//! `reconstruct`, and the figures of a reconstruction.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::PathBuf;

use serde_json::Value;
use tempfile::TempDir;

use crate::program::{json, ok, program, text};

/// A car that spun to rest, with few marks.
const EVIDENCE: &str = r#"
case = "spin"
[road]
friction = 0.7
[struck_car]
mass_kg = 1900
[striking_car]
mass_kg = 1700
[damage]
side = "right"
x_m = -1.7
[rest]
x_m = 30
y_m = -6
heading_deg = 190
[after]
blocked_wheels = []
[edr]
speed_before_m_s = 17
"#;

/// The evidence in a file, with some text in the place of another.
fn evidence(folder: &TempDir, (from, to): (&str, &str)) -> PathBuf {
    let path = folder.path().join("evidence.toml");
    fs::write(&path, EVIDENCE.replace(from, to)).unwrap();
    path
}

fn report(args: &[&str]) -> Value {
    json(&ok(program().args(args).output().unwrap()))
}

#[test]
fn speeds_have_intervals_and_the_same_seed_gives_the_same() {
    let folder = TempDir::new().unwrap();
    let file = evidence(&folder, ("", ""));
    let out = folder.path().join("out");
    let args = ["reconstruct", text(&file), "--particles", "60", "--seed", "3", "--json"];
    let with_files = [&args[..], &["--out", text(&out)]].concat();
    let (mut first, mut second) = (report(&with_files), report(&args));
    for name in [
        "target_speed_m_s",
        "bullet_speed_m_s",
        "closing_speed_m_s",
        "heading_difference_rad",
        "road_friction",
        "delta_v_target_m_s",
    ] {
        let quantities = first["quantities"].as_array().unwrap();
        let of = quantities.iter().find(|of| of["name"] == name).unwrap();
        let end = |key: &str, i: usize| of[key][i].as_f64().unwrap();
        let (low, high) = (end("interval_90", 0), end("interval_90", 1));
        assert!(low < high && low <= of["median"].as_f64().unwrap(), "{of}");
        assert!(end("interval_95", 0) <= low && high <= end("interval_95", 1), "{of}");
    }
    for key in ["modes", "fit", "budget", "badges"] {
        assert!(first[key].is_array(), "{key}");
    }
    assert_eq!(first["seed"], 3);
    let particles = fs::read_to_string(out.join("particles.csv")).unwrap();
    let header = particles.lines().next().unwrap();
    assert!(header.contains("target_speed_m_s"), "{header}");
    for of in [&mut first, &mut second] {
        of.as_object_mut().unwrap().remove("out");
    }
    assert_eq!(first, second);
}

#[test]
fn what_cannot_be_is_refused_with_file_line_and_key() {
    let folder = TempDir::new().unwrap();
    for (change, line, expected) in [
        (("friction = 0.7", "friction = 3"), 4, "friction"),
        (("x_m = 30", "x_m = 5000"), 13, "x_m"),
        (("y_m = -6", "y_m = -6\nposition_sigma_m = 0"), 15, "position_sigma_m"),
        (("[edr]", "[edr]\ncolour = 1"), 19, "colour"),
    ] {
        let file = evidence(&folder, change);
        let refused = program().args(["reconstruct", text(&file)]).output().unwrap();
        assert_eq!(refused.status.code(), Some(1), "{change:?}");
        let said = String::from_utf8(refused.stderr).unwrap();
        let place = format!("evidence.toml:{line}");
        assert!(said.contains(&place) && said.contains(expected), "{said}");
    }
}

#[test]
fn a_figure_shows_the_paths_a_quantity_or_the_budget() {
    let folder = TempDir::new().unwrap();
    let file = evidence(&folder, ("", ""));
    for (plot, column) in [
        ("scene", "found at rest, with its 90 % ellipse"),
        ("target-speed", "before the evidence"),
        ("budget", "would narrow to"),
    ] {
        let out = folder.path().join(format!("{plot}.csv"));
        let args = ["--plot", plot, "--particles", "60", "--out", text(&out)];
        ok(program().args(["render", "reconstruction", text(&file)]).args(args).output().unwrap());
        let table = fs::read_to_string(&out).unwrap();
        assert!(table.contains(column), "{plot}: {}", table.lines().next().unwrap_or_default());
    }
}
