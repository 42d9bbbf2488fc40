//! A collision in line, of which an exercise has the answer by hand: what is known of either car is said,
//! and what is not known makes the answer wide.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::program::{json, ok, program, text};

const INLINE: &str = include_str!("../data/evidence/inline.toml");

/// Speed of the striking car before the impact, m/s: 83.7 mph.
const STRIKING_M_S: f64 = 37.42;

/// - `particles`: fewer where both cars are followed, which takes minutes.
fn reconstructed(evidence: &str, particles: &str) -> Value {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("inline.toml");
    fs::write(&path, evidence).unwrap();
    let args = ["reconstruct", text(&path), "--particles", particles, "--json"];
    json(&ok(program().args(args).output().unwrap()))
}

fn interval(answer: &Value, name: &str, level: f64) -> [f64; 2] {
    let quantities = answer["quantities"].as_array().unwrap();
    let quantity = quantities.iter().find(|quantity| quantity["name"] == name).unwrap();
    let intervals = quantity["intervals"].as_array().unwrap();
    let of_level = intervals.iter().find(|interval| interval["level"] == level).unwrap();
    ["low", "high"].map(|end| of_level[end].as_f64().unwrap())
}

/// The answer was 67.1 mph, 60 to 74: the braking of the striking car came from a prior that stood in no
/// list and that no key could state.
#[test]
fn what_nobody_says_of_the_striking_car_makes_the_answer_wide_and_is_listed() {
    let answer = reconstructed(INLINE, "300");
    let [low, high] = interval(&answer, "bullet_speed_m_s", 0.95);
    assert!(low < STRIKING_M_S && STRIKING_M_S < high, "{low} to {high} m/s");
    let assumed = answer["assumptions"].to_string();
    for key in ["[striking_after] driver_braked", "bullet_brake_start_s", "[road] drag_factor"] {
        assert!(assumed.contains(key), "{key}: {assumed}");
    }
    // The way of the struck car is all that is known to a hand calculation.
    let by_hand = answer["by_hand"].as_array().unwrap();
    assert_eq!(by_hand.len(), 1, "{by_hand:?}");
    assert_eq!(by_hand[0]["speed"], "struck_after");
    assert!((by_hand[0]["value_m_s"].as_f64().unwrap() - 16.0).abs() < 0.1, "{by_hand:?}");
}

#[test]
fn what_is_known_of_both_cars_gives_the_speed_by_hand() {
    let locked = "[striking_after]\nblocked_wheels = [\"FL\", \"FR\", \"RL\", \"RR\"]\n[prior]";
    let drag = "drag_factor = 0.65\ndrag_factor_sigma = 0.02";
    let evidence = INLINE.replace("friction = 0.65\nfriction_sigma = 0.02", drag);
    let answer = reconstructed(&evidence.replace("[prior]", locked), "120");
    let [low, high] = interval(&answer, "bullet_speed_m_s", 0.90);
    assert!(low < STRIKING_M_S && STRIKING_M_S < high, "{low} to {high} m/s");
    assert!(high - low < 9.0, "{low} to {high} m/s");
    let by_hand = answer["by_hand"].as_array().unwrap();
    let striking = by_hand.iter().find(|check| check["speed"] == "striking").unwrap();
    assert!((striking["value_m_s"].as_f64().unwrap() - STRIKING_M_S).abs() < 1.0, "{striking}");
}
