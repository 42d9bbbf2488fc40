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
    let of_seed_0 = cases.iter().find(|case| case["case"] == "d064").unwrap();
    assert_eq!(&evaluated(&["--only", "d064"])["cases"][0], of_seed_0, "same seed");
    let other = evaluated(&["--only", "d064", "--seed", "1"]);
    assert_ne!(&other["cases"][0], of_seed_0, "the seed decides");
}

/// Twins with and without stability control are forecast with our systems, not with the recorded brakes.
#[test]
fn twins_with_and_without_stability_control_stand_beside_each_other() {
    // One that is saved and one that does not turn anyway; the twins without need not be asked for.
    let asked = ["--only", "d009e", "d064e", "d064"];
    let found = evaluated(&asked);
    assert_eq!(found["cases"].as_array().unwrap().len(), 3);
    let twins = found["twins"].as_array().unwrap();
    let names: Vec<&Value> = twins.iter().map(|twins| &twins["cases"]["with"]).collect();
    assert_eq!(names, ["d009e", "d064e"]);
    let outcome = |twins: &Value, which: &str, key: &str| {
        twins["outcomes"][which][key].as_f64().unwrap_or_else(|| panic!("{which} {key}: {twins}"))
    };
    let saved = &twins[0];
    assert_eq!(saved["cases"]["without"], "d009");
    assert!((outcome(saved, "without", "recorded_turn_rad").to_degrees() - 179.15).abs() < 0.1);
    assert!((outcome(saved, "with", "recorded_turn_rad").to_degrees() - 6.18).abs() < 0.1);
    assert_eq!(saved["saved_recorded"], true);
    assert_eq!(twins[1]["saved_recorded"], false);
    for twins in twins {
        let turns = ["without", "with"].map(|which| outcome(twins, which, "forecast_turn_rad"));
        assert!(turns[1] < turns[0] + 0.05, "{twins}");
        let [without, with] =
            ["without", "with"].map(|which| outcome(twins, which, "quarter_turn_probability"));
        let is_saved = without > 0.5 && with <= 0.5;
        assert_eq!(twins["saved_forecast"], is_saved, "{twins}");
    }
    let summary = &found["overall"]["twins"];
    let saved = &summary["saved"];
    let counts = ["both", "recorded_alone", "forecast_alone", "neither"];
    let counts = counts.map(|key| saved[key].as_u64().unwrap());
    assert_eq!((summary["n"].as_u64(), counts.iter().sum::<u64>()), (Some(2), 2), "{summary}");
    assert_eq!(summary["n_right"].as_u64().unwrap(), counts[0] + counts[3], "{summary}");
    assert_eq!(summary["quarter_turns"]["without"]["recorded"], 1);
    assert_eq!(evaluated(&["--only", "d009e"])["twins"][0], twins[0], "same seed");
    let alone = evaluated(&["--only", "d064"]);
    assert!(alone["twins"].as_array().unwrap().is_empty() && alone["overall"]["twins"].is_null());
    let printed = impactlab(&["evaluate", "pairs", PAIRS, "--draws", "6", "--only", "d064e"]).out;
    for words in ["the same collisions with and without it", "d064e", "effect forecast as recorded"]
    {
        assert!(printed.contains(words), "{words}: {printed}");
    }
}

/// A simulation of a recorded pair is the motion at the medians that a forecast without network has.
#[test]
fn recorded_pairs_are_simulated_like_other_data_sets() {
    let all = answer(&["simulate", "--dataset", PAIRS]);
    let (cases, pairs) = (all["cases"].as_array().unwrap(), &all["pairs"]);
    assert_eq!((cases.len(), all["failures"].as_array().unwrap().len()), (95, 0));
    let median = |of: &Value| of["average_error_m"]["median"].as_f64().unwrap();
    assert!(median(&all["overall"]) < 3.0 && median(&pairs["striking"]) < 3.0, "{pairs}");
    for key in ["contact_ratio", "impulse_ratio"] {
        assert!((0.7..1.4).contains(&pairs[key].as_f64().unwrap()), "{key}: {pairs}");
    }
    let forecast = evaluated(&["--only", "d064", "--physics-only"]);
    let simulated = cases.iter().find(|case| case["case"] == "d064").unwrap();
    let forecast = &forecast["cases"][0];
    for (of_forecast, of_simulation) in [
        ("/struck/end_error_m", "/final_error_m"),
        ("/struck/end_heading_error_rad", "/final_heading_error_rad"),
        ("/striking/end_error_m", "/pair/striking/final_error_m"),
        ("/contact_s/recorded", "/pair/contact_s/recorded"),
        ("/impulse_n_s/recorded", "/pair/impulse_n_s/recorded"),
    ] {
        let [a, b] = [(forecast, of_forecast), (simulated, of_simulation)]
            .map(|(of, key)| of.pointer(key).and_then(Value::as_f64).unwrap());
        assert!((a - b).abs() < 1e-6 * a.abs().max(1.0), "{of_simulation}: {a} {b}");
    }
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let one = ["simulate", "--dataset", PAIRS, "--case", "d064", "--vehicle", "reference-2000"];
    let ran = impactlab(&[&one[..], &["--out", text(&out)]].concat());
    assert_eq!(ran.code, 0, "{}{}", ran.out, ran.err);
    for words in ["d064", "striking: final error", "impulse, recorded", "struck vehicle"] {
        assert!(ran.out.contains(words), "{words}: {}", ran.out);
    }
    let [struck, striking] =
        ["d064.csv", "d064_striking.csv"].map(|file| fs::read_to_string(out.join(file)).unwrap());
    assert!(struck != striking && struck.lines().count() == striking.lines().count());
}

#[test]
fn what_is_no_recorded_pair_is_refused_by_name() {
    for (arguments, words) in [
        (&["evaluate", "pairs", "datasets/fea"][..], "expected a folder with cases.csv, cases/"),
        (&["evaluate", "pairs", PAIRS, "--only", "d999"], "d999"),
        (&["evaluate", "pairs", PAIRS, "--draws", "0"], "draws"),
        (&["simulate", "--dataset", PAIRS, "--case", "d999"], "d999"),
        (
            &["evaluate", "response", "--model", "shipped", "--data", PAIRS],
            "pairs: impactlab evaluate pairs DIR",
        ),
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

/// A single pair is drawn like any other case: what the drivers did, both cars, the record beside them.
#[test]
fn a_recorded_pair_is_drawn_with_what_its_drivers_did() {
    let folder = TempDir::new().unwrap();
    let drawn = |more: &[&str]| {
        let out = folder.path().join(format!("{}.csv", more[0]));
        let answer = answer(&[&["render"], more, &["--out", text(&out)]].concat());
        (answer, fs::read_to_string(&out).unwrap())
    };
    let case = [PAIRS, "--case", "d041e"];
    let (steering, table) = drawn(&[&["controls"], &case[..], &["--plot", "steering"]].concat());
    assert_eq!(steering["title"], "d041e: Steer angle of the road wheels over time");
    assert!(table.contains("striking vehicle"), "{table}");
    let (_, motion) = drawn(&[&["motion"], &case[..], &["--channel", "yaw-rate"]].concat());
    assert!(motion.contains("recorded"), "{motion}");
    let picture = folder.path().join("scene.png");
    let args =
        ["render", "scene", PAIRS, "--case", "d041e", "--time", "1", "--bullet", "bullet-1500"];
    let size = ["--size", "300x200", "--scale", "1", "--out", text(&picture)];
    let scene = answer(&[&args[..], &size].concat());
    let notes = scene["notes"].to_string();
    assert!(notes.contains("each recorded pair says itself which vehicles it has"), "{notes}");
    for (args, expected) in [
        (&["scene", PAIRS, "--time", "1"][..], "say which case with --case NAME"),
        (&["scene", PAIRS, "--case", "zz", "--time", "1"], "has no case \"zz\""),
        (&["controls", "pit-right-rear", "--plot", "drive"], "zero throughout, nothing to show"),
    ] {
        let out = folder.path().join("none.png");
        let ran = impactlab(&[&["render"], args, &["--out", text(&out)]].concat());
        assert!(ran.code != 0 && !out.exists(), "{args:?}");
        assert!(ran.err.contains(expected), "{args:?}: {}", ran.err);
    }
}

/// A result is never written over a file that the question reads, whichever part of the folder it is.
#[test]
fn no_file_of_a_pair_is_replaced_by_its_result() {
    let folder = TempDir::new().unwrap();
    let root = folder.path();
    for part in ["cases", "vehicles"] {
        fs::create_dir(root.join(part)).unwrap();
    }
    let cars = ["vehicles/micro.toml", "vehicles/sedan-wishbone.toml"];
    for file in ["cases.csv", "cases/d041.csv", cars[0], cars[1]] {
        fs::copy(format!("{PAIRS}/{file}"), root.join(file)).unwrap();
    }
    for file in ["cases.csv", "cases/d041.csv"] {
        let read = root.join(file);
        let before = fs::read(&read).unwrap();
        let args = ["render", "controls", text(root), "--case", "d041", "--plot", "steering"];
        let out = ["--out", text(&read), "--overwrite"];
        let ran = impactlab(&[&args[..], &out].concat());
        assert!(ran.code != 0 && ran.err.contains(file), "{file}: {}", ran.err);
        assert_eq!(fs::read(&read).unwrap(), before, "{file}");
    }
}
