//! Questions of motion on the command line: a slope of the road, a skid before the impact, a fixed object.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::program::{answer, program, text};

const PIT: &str = "assets/scenarios/pit_right_rear.toml";

fn refusal(args: &[&str]) -> String {
    let output = program().args(args).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{args:?}");
    String::from_utf8(output.stderr).unwrap()
}

fn written(folder: &TempDir, name: &str, text: &str) -> String {
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

fn with_road(road: &str) -> String {
    format!("{}\n[road]\n{road}\n", fs::read_to_string(Path::new(PIT)).unwrap())
}

#[test]
fn a_scenario_on_a_slope_goes_farther_downhill_and_says_so() {
    let folder = TempDir::new().unwrap();
    let end = |road: &str| {
        let path = written(&folder, "pit.toml", &with_road(road));
        let brakes = ["--brake", "1.2", "--brake-start", "0.2s", "--one-contact", "--until-rest"];
        let report = answer(&[&["simulate", "--scenario", &path], &brakes[..]].concat());
        (report["distance_m"].as_f64().unwrap(), report)
    };
    let (down_m, down) = end("grade_percent = -6");
    let (up_m, _) = end("grade = 0.06");
    assert!(down_m > up_m + 1.0, "{down_m} and {up_m} m");
    assert_eq!(down["slope"]["grade"], -0.06);
    let (_, steep) = end("grade_percent = 14");
    assert!(steep["caveats"].to_string().contains("a slope of 14"), "{}", steep["caveats"]);
}

#[test]
fn two_slopes_that_differ_are_refused() {
    let folder = TempDir::new().unwrap();
    let scenario = written(&folder, "pit.toml", &with_road("grade = 0.05"));
    let site = written(&folder, "site.toml", "name = \"hill\"\n[road]\ngrade = 0.04\n");
    let error = refusal(&["simulate", "--scenario", &scenario, "--site", &site]);
    assert!(error.contains("another slope than the site"), "{error}");
    let level = answer(&["simulate", "--scenario", PIT, "--site", &site]);
    assert_eq!(level["slope"]["grade"], 0.04);
}

#[test]
fn a_skid_before_the_impact_has_a_speed_of_its_own() {
    let folder = TempDir::new().unwrap();
    let spin = fs::read_to_string("tests/data/evidence/spin.toml").unwrap();
    let text_of = format!("{spin}\n[skid_before]\nlength_m = 20\n");
    let evidence = written(&folder, "spin.toml", &text_of);
    let out = folder.path().join("out");
    let settings = ["--particles", "120", "--seed", "3", "--out", text(&out)];
    let report = answer(&[&["reconstruct", &evidence], &settings[..]].concat());
    let quantities = report["quantities"].as_array().unwrap();
    let median = |name: &str| {
        let found = quantities.iter().find(|of| of["name"] == name);
        found.unwrap_or_else(|| panic!("{name}"))["median"].as_f64().unwrap()
    };
    let (before, at) = (median("target_speed_before_skid_m_s"), median("target_speed_m_s"));
    // 20 m on locked wheels of some 0.66 g.
    let gained = before * before - at * at;
    assert!((180.0..360.0).contains(&gained), "{before} and {at} m/s");
    assert!(quantities.iter().all(|of| of["name"] != "bullet_speed_before_skid_m_s"));
    let particles = fs::read_to_string(out.join("particles.csv")).unwrap();
    assert!(particles.lines().next().unwrap().contains("skid_before_m"), "{particles:.300}");
}

#[test]
fn a_wall_is_solved_and_followed_and_the_networks_do_not_know_it() {
    let folder = TempDir::new().unwrap();
    let scenario = written(
        &folder,
        "wall.toml",
        "[target]\nvehicle = \"toyota-camry-2018\"\nspeed_km_h = 50\n[bullet]\nfixed = \"wall\"\n\
         [contact]\nfrom = \"side\"\nside = \"front\"\noffset_m = 0\nrestitution = 0.1\n",
    );
    let impact = answer(&["impact", &scenario]);
    let delta_v = impact["target"]["delta_v_magnitude_m_s"].as_f64().unwrap();
    assert!((delta_v - 1.1 * 50.0 / 3.6).abs() < 0.01, "{delta_v} m/s");
    assert_eq!(impact["rival"], Value::Null);
    assert!(impact["caveats"].to_string().contains("does not move"), "{}", impact["caveats"]);
    // What does not move is no vehicle that has a velocity afterwards.
    assert_eq!(impact["fixed"], "wall");
    let printed = String::from_utf8(program().args(["impact", &scenario]).output().unwrap().stdout);
    let printed = printed.unwrap();
    assert!(printed.contains("Struck vehicle after the impact"), "{printed}");
    assert!(!printed.contains("striking vehicle"), "{printed}");
    let simulated = answer(&["simulate", "--scenario", &scenario]);
    let x_m = simulated["end"]["x_m"].as_f64().unwrap();
    assert!((-8.0..0.5).contains(&x_m), "it rolls back from the wall: {x_m} m");
    let out = folder.path().join("out");
    let error = refusal(&["predict", "--scenario", &scenario, "--out", text(&out)]);
    assert!(error.contains("meets a wall, which does not move"), "{error}");
}
