//! Methods by hand on the command line: numbers in any unit, what is assumed, and what is refused.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::answers::write;
use crate::commands::impactlab;
use crate::program::{answer, ok, program, text};

fn result<'a>(report: &'a Value, key: &str) -> &'a Value {
    let results = report["results"].as_array().unwrap();
    results.iter().find(|result| result["key"] == key).unwrap()
}

/// 30 m on 0.7 are 73.06 km/h, in whatever unit they are said.
#[test]
fn a_skid_has_one_speed_in_every_unit() {
    for distance in ["distance=30", "distance=3000cm", "distance_m=98.4251968504ft"] {
        let report = answer(&["hand", "skid", distance, "friction=70%±5%"]);
        let speed = result(&report, "speed_m_s");
        let value = speed["value"].as_f64().unwrap();
        assert!((value - 411.8793_f64.sqrt()).abs() < 1e-6, "{distance}: {speed}");
        let interval = &speed["estimate"]["intervals"][1];
        assert_eq!(interval["level"], 0.9);
        let [low, high] = ["low", "high"].map(|end| interval[end].as_f64().unwrap());
        assert!(low < value && value < high, "{speed}");
    }
    let ran = impactlab(&["hand", "skid", "distance=30±0.5", "friction=0.7±0.05", "--units", "us"]);
    assert!(ran.out.contains("mph") && ran.out.contains("speed at the start"), "{}", ran.out);
}

/// What the text assumes stands in the answer, and ±0 is exact.
#[test]
fn what_nobody_states_is_assumed_aloud() {
    let ran = impactlab(&["hand", "spin-out", "distance=25", "friction=0.7+-0.05"]);
    assert!(ran.out.contains("rolling factor: 0.5 ± 0.15"), "{}", ran.out);
    assert!(ran.out.contains("standard deviation of distance of the slide"), "{}", ran.out);
    let exact = ["distance=25±0", "friction=0.7±0", "rolling-factor=0.5±0", "grade=0±0"];
    let exact: Vec<&str> =
        ["hand", "spin-out"].into_iter().chain(exact).chain(["end-speed=0±0"]).collect();
    let report = answer(&exact);
    assert_eq!(result(&report, "speed_m_s")["estimate"]["intervals"], json!([]));
    assert!(report["caveats"].to_string().contains("no interval"), "{report}");
}

#[test]
fn a_violated_condition_is_a_warning() {
    let args = ["hand", "spin-out", "distance=25", "friction=0.7", "turn=20deg"];
    let ran = impactlab(&args);
    assert!(ran.out.contains("warning: outside the domain"), "{}", ran.out);
    assert!(ran.out.contains("turned by 20 deg only"), "{}", ran.out);
}

/// The opinion of a case with a method by hand alone said that no answer allows one, and its source was in English.
#[test]
fn a_report_of_a_method_by_hand_has_an_opinion() {
    let folder = TempDir::new().unwrap();
    let asked = ["hand", "skid", "distance=30±0.5", "friction=0.7±0.05", "--print-request"];
    let request = ok(program().args(asked).output().unwrap());
    let head = r#"{"format": "impactlab case", "version": 2, "program": "0", "name": "hand","#;
    let variant = format!(r#"{{"name": "a", "questions": [{request}]}}"#);
    let case = format!(r#"{head} "notes": "", "shown": "a", "variants": [{variant}]}}"#);
    let case = write(&folder, "hand.impactlab", &case);
    let out = folder.path().join("de.md");
    let args = ["report", text(&case), "--date", "2026-01-01", "--language", "de", "--out"];
    ok(program().args(args).arg(&out).output().unwrap());
    let told = std::fs::read_to_string(&out).unwrap();
    let (opinion, annex) = told.split_once("Jede Zahl dieses Gutachtens").unwrap();
    for part in ["am Beginn des Rutschens: 7", "Voraussetzung: Die Spuren beginnen dort"] {
        assert!(opinion.contains(part), "{part}: {opinion}");
    }
    for wrong in ["Keine Antwort des Falls", "nicht berücksichtigt", "Fehler der Modelle"] {
        assert!(!opinion.contains(wrong), "{wrong}: {opinion}");
    }
    assert!(annex.contains("Stoßziffer und Impulsverhältnis."), "{annex}");
}

/// The same mark as chord and as points.
#[test]
fn points_of_a_mark_give_what_chord_and_ordinate_do() {
    let friction = "friction=0.7±0.05";
    let of_chord = answer(&["hand", "yaw-mark", "chord=24", "middle-ordinate=1.5", friction]);
    let radius = 48.75_f64;
    let half = 12.0_f64;
    let points: Vec<String> = (0..9)
        .map(|i| {
            let x = -half + 3.0 * f64::from(i);
            let y = (radius * radius - x * x).sqrt() - (radius * radius - half * half).sqrt();
            format!("{x},{y}")
        })
        .collect();
    let mut args = vec!["hand", "yaw-mark", friction];
    for point in &points {
        args.extend(["--point", point.as_str()]);
    }
    let of_points = answer(&args);
    let speed = |report: &Value| result(report, "speed_m_s")["value"].as_f64().unwrap();
    assert!((speed(&of_chord) / speed(&of_points) - 1.0).abs() < 1e-6, "{of_points}");
    assert_eq!(of_points["n_points"], 9);
    // Either stands beside marks of the model, whose speed is known.
    for report in [&of_chord, &of_points] {
        let bias = &report["yaw_mark_bias"];
        assert!(bias["mean_ratio"].as_f64().unwrap() > 0.0, "{report}");
    }
}

#[test]
fn what_is_wrong_is_refused_in_one_line() {
    for (args, part) in [
        (&["skid", "distance=30"][..], "needs drag factor of locked wheels (friction)"),
        (&["skid", "distance=30m", "friction=0.7", "speed=3"], "\"speed\" is no input"),
        (&["skid", "distance=30kg", "friction=0.7"], "\"kg\" is not one of the units"),
        (&["skid", "distance=30", "distance_m=3", "friction=0.7"], "given twice"),
        (&["skid", "distance=30", "friction=7"], "friction"),
        (&["yaw-mark", "friction=0.7"], "the radius is open"),
        (&["airborne", "distance=20", "drop=-1"], "no speed explains"),
        (
            &[
                "crush-energy",
                "mass-1=1500",
                "stiffness-a=5e4",
                "stiffness-b=6e5",
                "width=1.5",
                "c1=0.4",
                "c2=0.4",
                "c4=0.4",
            ],
            "without a gap",
        ),
    ] {
        let args: Vec<&str> = ["hand"].into_iter().chain(args.iter().copied()).collect();
        let ran = impactlab(&args);
        assert!(ran.error_line().contains(part), "{part}: {}", ran.err);
    }
}

/// The question of the command is one that a file asks, and that a case holds.
#[test]
fn a_question_by_hand_is_asked_again_and_stands_in_a_case() {
    let folder = TempDir::new().unwrap();
    let asked = ["hand", "time-distance", "speed=50km/h", "deceleration=8±0.5", "distance=30"];
    let printed = impactlab(&asked.into_iter().chain(["--print-request"]).collect::<Vec<_>>());
    let request = write(&folder, "request.json", &printed.out);
    let again = impactlab(&["ask", text(&request)]);
    let answer: Value = serde_json::from_str(&again.out).unwrap();
    assert_eq!(answer, crate::program::answer(&asked));
    assert!((0.0..=1.0).contains(&answer["avoided_share"].as_f64().unwrap()), "{answer}");

    let question: Value = serde_json::from_str(&printed.out).unwrap();
    assert_eq!(question["question"], "hand");
    let schema = impactlab(&["schema", "hand", "--request"]);
    assert!(schema.out.contains("input_draws"), "{}", schema.out);
}
