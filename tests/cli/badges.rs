//! Badges: what an answer cannot promise, in every JSON, in text, with quantity, value and range.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use serde_json::Value;
use tempfile::TempDir;

use crate::answers::scenario_with;
use crate::program::{SCENARIO, TRAJECTORIES, answer, ok, program, text};

/// The badges of a report of one kind, after checking that each badge has all keys.
pub fn badges<'a>(report: &'a Value, kind: &str) -> Vec<&'a Value> {
    let all = report["badges"].as_array().unwrap_or_else(|| panic!("no badges: {report}"));
    for badge in all {
        let keys: Vec<&str> = badge.as_object().unwrap().keys().map(String::as_str).collect();
        let mut sorted = keys.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, ["kind", "quantity", "range", "text", "value"], "{badge}");
        assert!(!badge["text"].as_str().unwrap().is_empty(), "{badge}");
    }
    all.iter().filter(|badge| badge["kind"] == kind).collect()
}

/// Those of an evaluation stand in `force::train_kill_resume_predict`.
#[test]
fn every_answer_with_numbers_has_badges() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let commands: [&[&str]; 5] = [
        &["impact", SCENARIO],
        &["simulate", "--scenario", SCENARIO],
        &["simulate", "--dataset", TRAJECTORIES, "--case", "FE_c001"],
        &["predict", "force", "--scenario", SCENARIO],
        &["predict", "--draws", "2", "--scenario", SCENARIO, "--out", text(&out)],
    ];
    for args in commands {
        let report = answer(args);
        assert_eq!(badges(&report, "energy_gain").len(), 0, "{args:?}: {report}");
    }
    let impact = answer(&["impact", SCENARIO]);
    let assumed = badges(&impact, "assumed");
    assert_eq!(impact["badges"].as_array().unwrap().len(), assumed.len(), "{impact}");
}

#[test]
fn a_second_contact_is_a_badge_of_the_answer() {
    let folder = TempDir::new().unwrap();
    let slow = scenario_with(&folder, "slow.toml", "speed_km_h = 54", "speed_km_h = 0");
    let report = answer(&["simulate", "--one-contact", "--scenario", text(&slow)]);
    let found = badges(&report, "second_contact");
    assert_eq!(found.len(), 1, "{report}");
    assert_eq!(found[0]["value"], report["flags"][0]["time_s"]);
    let printed = ok(program()
        .args(["simulate", "--one-contact", "--scenario"])
        .arg(&slow)
        .output()
        .unwrap());
    assert!(printed.contains("warning: second contact: the vehicles"), "{printed}");
}

#[test]
fn a_collision_outside_the_training_is_named_with_quantity_value_and_range() {
    let folder = TempDir::new().unwrap();
    let heavy = scenario_with(
        &folder,
        "heavy.toml",
        "[bullet]\nmass_kg = 2000",
        "[bullet]\nmass_kg = 3900",
    );
    let report = answer(&["predict", "force", "--scenario", text(&heavy)]);
    let outside = badges(&report, "outside_domain");
    let name = "mass of the striking vehicle [kg]";
    let mass = outside.iter().find(|badge| badge["quantity"] == name).unwrap();
    assert_eq!(mass["value"], 3900.0);
    let high = mass["range"][1].as_f64().unwrap();
    assert!(high < 3900.0, "{mass}");
    let printed =
        ok(program().args(["predict", "force", "--scenario"]).arg(&heavy).output().unwrap());
    assert!(printed.contains(&format!("warning: outside the domain: {name} is 3900")), "{printed}");
}

/// Each of these was answered with a band as tight as in the training, and without a word.
#[test]
fn what_the_force_network_has_never_seen_has_the_band_of_the_physics() {
    let folder = TempDir::new().unwrap();
    let changed =
        |name: &str, old: &str, new: &str| text(&scenario_with(&folder, name, old, new)).to_owned();
    let scenarios = [
        changed("fast.toml", "speed_km_h = 62", "speed_km_h = 288"),
        changed("standing.toml", "speed_km_h = 54", "speed_km_h = 0"),
        changed("slow.toml", "speed_km_h = 54", "speed_km_h = 7"),
        changed("light.toml", "[target]\nmass_kg = 2000", "[target]\nmass_kg = 600"),
        "carpenter-welcher-barrier".to_owned(),
    ];
    for scenario in &scenarios {
        let report = answer(&["predict", "force", "--scenario", scenario]);
        assert_eq!(report["applicability"], 0.0, "{scenario}");
        let outside = badges(&report, "outside_domain");
        // The quantity, and that the physics alone answers.
        assert!(outside.len() > 1, "{scenario}: {report}");
        for badge in outside {
            assert!(badge["quantity"].is_string() && badge["value"].is_number(), "{badge}");
            assert!(badge["range"].is_array(), "{badge}");
        }
        let interval = |level: f64| -> [f64; 2] {
            let all = report["impulse_n_s"]["magnitude"]["intervals"].as_array().unwrap();
            let of = all.iter().find(|of| of["level"] == level).unwrap();
            ["low", "high"].map(|end| of[end].as_f64().unwrap())
        };
        let [low, high] = interval(0.9);
        assert!(high / low > 1.7, "{scenario}: {low} to {high}");
        // The solver with the values of the scenario does not contradict the prediction.
        let momentum = report["implied_contact"]["momentum"]["impulse_n_s"].as_array().unwrap();
        let [x, y] = [0, 1].map(|i| momentum[i].as_f64().unwrap());
        let [low, high] = interval(0.95);
        let size = x.hypot(y);
        assert!((low..=high).contains(&size), "{scenario}: {size} in {low} to {high}");
    }
}
