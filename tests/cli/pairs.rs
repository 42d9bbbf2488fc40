//! Recorded pairs of vehicles: what a check says of them, and forecasts beside them.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::commands::impactlab;
use crate::program::{answer, text};

const PAIRS: &str = "datasets/pairs";

fn evaluated(more: &[&str]) -> Value {
    let usual = ["evaluate", "pairs", PAIRS, "--draws", "24"];
    answer(&usual.iter().chain(more).copied().collect::<Vec<_>>())
}

#[test]
fn both_cars_of_a_recorded_pair_are_forecast_beside_their_records() {
    // Contact that is lost early, and a rear-end collision.
    let found = evaluated(&["--only", "d064", "d050"]);
    for (vehicle, error_m) in [("overall", 2.0), ("striking", 2.0)] {
        let of_vehicle = &found[vehicle];
        let mean = of_vehicle["average_error_m"]["mean"].as_f64().unwrap();
        assert!(mean > 0.0 && mean < error_m, "{vehicle}: {mean} m");
        for key in ["quarter_turn_right", "half_turn_right"] {
            let share = of_vehicle[key].as_f64().unwrap();
            assert!((0.0..=1.0).contains(&share), "{vehicle} {key}: {share}");
        }
        for key in ["coverage", "end_coverage"] {
            let [narrow, wide] = ["50", "90"].map(|level| of_vehicle[key][level].as_f64().unwrap());
            assert!(narrow <= wide && wide <= 1.0, "{vehicle} {key}: {narrow} {wide}");
        }
    }
    let cases = found["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 2);
    for case in cases {
        assert_eq!(case["n_draws"], 24, "{case}");
        let [forecast, recorded] =
            ["forecast", "recorded"].map(|which| case["impulse_n_s"][which].as_f64().unwrap());
        assert!((0.4..2.5).contains(&(forecast / recorded)), "{case}");
    }
    assert_eq!(found["cases"], evaluated(&["--only", "d064", "d050"])["cases"], "same seed");
    let other = evaluated(&["--only", "d064", "--seed", "1"]);
    let of_seed_0 = cases.iter().find(|case| case["case"] == "d064").unwrap();
    assert_ne!(other["cases"][0]["struck"], of_seed_0["struck"], "the seed decides");
}

#[test]
fn what_is_no_recorded_pair_is_refused_by_name() {
    for (arguments, words) in [
        (&["evaluate", "pairs", "datasets/fea"][..], "expected a folder with cases.csv, cases/"),
        (&["evaluate", "pairs", PAIRS, "--only", "d999"], "d999"),
        (&["evaluate", "pairs", PAIRS, "--draws", "0"], "draws"),
        (&["simulate", "--dataset", PAIRS], "pairs: impactlab evaluate pairs DIR"),
    ] {
        let ran = impactlab(arguments);
        assert!(ran.code != 0 && ran.err.contains(words), "{arguments:?}: {}", ran.err);
    }
}

#[test]
fn a_check_reads_every_pair_and_names_what_is_wrong_with_one() {
    let ran = impactlab(&["check", PAIRS]);
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    assert!(ran.out.contains("95 cases") && ran.out.contains("evaluate pairs"), "{}", ran.out);
    // One case whose file lacks a column.
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    let table = fs::read_to_string(format!("{PAIRS}/cases.csv")).unwrap();
    let is_kept = |line: &&str| !line.starts_with('d') || line.starts_with("d050,");
    let rows: Vec<&str> = table.lines().filter(is_kept).collect();
    fs::write(path("cases.csv"), rows.join("\n") + "\n").unwrap();
    fs::create_dir(path("cases")).unwrap();
    fs::create_dir(path("vehicles")).unwrap();
    for file in fs::read_dir(format!("{PAIRS}/vehicles")).unwrap() {
        let file = file.unwrap();
        fs::copy(file.path(), path("vehicles").join(file.file_name())).unwrap();
    }
    let motions = fs::read_to_string(format!("{PAIRS}/cases/d050.csv")).unwrap();
    let renamed = motions.replacen("target_yaw_rad", "target_heading_rad", 1);
    fs::write(path("cases/d050.csv"), renamed).unwrap();
    let ran = impactlab(&["check", text(folder.path())]);
    assert_ne!(ran.code, 0, "{}", ran.out);
    let said = format!("{}{}", ran.out, ran.err);
    assert!(said.contains("d050.csv:1") && said.contains("target_yaw_rad"), "{said}");
    let ran = impactlab(&["evaluate", "pairs", text(folder.path()), "--draws", "8"]);
    assert!(ran.out.contains("target_yaw_rad"), "{}{}", ran.out, ran.err);
}
