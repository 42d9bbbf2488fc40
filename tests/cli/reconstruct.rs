//! `reconstruct`, and the figures of a reconstruction.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::program::{json, ok, program, text, told_and_reported};

/// A car that spun to rest.
const EVIDENCE: &str = "tests/data/evidence/spin.toml";

fn report(args: &[&str]) -> Value {
    json(&ok(program().args(args).output().unwrap()))
}

#[test]
fn speeds_have_intervals_and_the_same_seed_gives_the_same() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let args = ["reconstruct", EVIDENCE, "--particles", "120", "--seed", "3", "--json"];
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
    assert_eq!(first["hinges"][0]["input"], "road_friction");
    for key in ["modes", "fit", "budget", "badges"] {
        assert!(first[key].is_array(), "{key}");
    }
    assert_eq!(first["seed"], 3);
    assert_eq!(first["marks"], Value::Array(Vec::new()), "no mark was found");
    let particles = fs::read_to_string(out.join("particles.csv")).unwrap();
    let header = particles.lines().next().unwrap();
    assert!(header.contains("target_speed_m_s"), "{header}");
    for of in [&mut first, &mut second] {
        of.as_object_mut().unwrap().remove("out");
    }
    assert_eq!(first, second);
}

/// That the checkpoint had the name of a result was found after the run, which was lost with it.
#[test]
fn a_checkpoint_in_place_of_a_result_is_refused_before_the_run() {
    let folder = TempDir::new().unwrap();
    let (out, below) = (folder.path().join("r"), folder.path().join("below"));
    fs::create_dir(&below).unwrap();
    for checkpoint in ["r/particles.csv", "below/../r/reconstruction.json", "r/manifest.json"] {
        let checkpoint = folder.path().join(checkpoint);
        let args = ["--particles", "60", "--out", text(&out), "--checkpoint", text(&checkpoint)];
        let ran = program().args(["reconstruct", EVIDENCE]).args(args).output().unwrap();
        let error = String::from_utf8(ran.stderr).unwrap();
        assert!(!ran.status.success(), "{error}");
        let expected = "is a file of the results in --out, so it cannot be the checkpoint";
        assert!(error.contains(expected), "{error}");
        assert!(!out.exists(), "nothing is left of a run that was not begun");
    }
}

/// The answer of sixty particles held a speed "with a probability of 90 %".
#[test]
fn few_particles_have_no_interval_and_say_what_to_do() {
    let args = ["reconstruct", EVIDENCE, "--particles", "60", "--seed", "3"];
    let (printed, report) = told_and_reported(&args);
    assert!(report["ess"].as_f64().unwrap() < 100.0, "{}", report["ess"]);
    for quantity in report["quantities"].as_array().unwrap() {
        assert!(quantity["median"].is_number(), "{quantity}");
        assert_eq!(quantity["intervals"], Value::Array(Vec::new()), "{quantity}");
        assert!(quantity.get("interval_90").is_none(), "{quantity}");
    }
    assert_eq!(report["budget"], Value::Array(Vec::new()));
    assert!(printed.contains("no intervals are given"), "{printed}");
    // Ranges of what is assumed beforehand are none of the answer.
    let mut of_answer = printed.lines().filter(|line| !line.contains("assumed"));
    assert!(of_answer.all(|line| !line.contains("90 %")), "{printed}");
}

#[test]
fn a_figure_shows_the_paths_a_quantity_or_the_budget() {
    let folder = TempDir::new().unwrap();
    // Few particles tell no budget that can be believed.
    for (plot, particles, column) in [
        ("scene", "60", "struck car at rest, 90 % ellipse"),
        ("cars-above", "60", "struck car at rest, 90 % ellipse"),
        ("target-speed", "60", "before the evidence"),
        ("budget", "200", "with the measurement"),
    ] {
        let out = folder.path().join(format!("{plot}.csv"));
        let args = ["--plot", plot, "--particles", particles, "--out", text(&out)];
        ok(program().args(["render", "reconstruction", EVIDENCE]).args(args).output().unwrap());
        let table = fs::read_to_string(&out).unwrap();
        assert!(table.contains(column), "{plot}: {}", table.lines().next().unwrap_or_default());
    }
    {
        let out = folder.path().join("cars.png");
        let args = ["--plot", "cars-perspective", "--particles", "60", "--json"];
        let struck = ["--size", "320x240", "--scale", "1", "--out", text(&out)];
        let ran = ok(program()
            .args(["render", "reconstruction", EVIDENCE])
            .args(args)
            .args(struck)
            .output()
            .unwrap());
        assert!(json(&ran)["title"].as_str().unwrap().contains("in perspective"), "{ran}");
        assert!(out.metadata().unwrap().len() > 5_000);
    }
}
