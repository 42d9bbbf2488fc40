//! The replay of a recorder on the command line: from the file to the path.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::answers::write;
use crate::commands::impactlab;
use crate::program::{answer, json, ok, program, text};

const REPORT: &str = "CDR FILE INFORMATION\nEDR Device Type,Module 7\nComplete File Recorded,Yes\n\
    PRE-CRASH DATA -5 TO 0 SEC [2 SAMPLES/SEC] (EVENT RECORD 1)\n\
    Times (sec),\"Speed, Vehicle Indicated (MPH [km/h])\",Steering Input (deg),Service Brake\n\
    -2.0,40 [64],0,Off\n-1.5,40 [64],10,Off\n-1.0,40 [64],20,Off\n-0.5,36 [58],20,On\n\
    0.0,31 [50],10,On\n";

fn median(report: &Value, place: &str) -> f64 {
    report.pointer(&format!("{place}/median")).unwrap().as_f64().unwrap()
}

/// A table was written under the name of a picture.
#[test]
fn the_path_has_the_name_of_a_table() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "report.csv", REPORT);
    let path = folder.path().join("path.png");
    let args = ["replay", text(&file), "--steering-ratio", "14.5", "--write", text(&path)];
    let output = program().args(args).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("path.png: cannot be made; expected a name that ends in .csv"), "{said}");
    assert!(!output.status.success() && !path.exists());
}

/// A report of a recorder becomes a state at the contact, a path as a file, and the same by its question.
#[test]
fn a_report_becomes_a_state_at_the_contact_and_a_path() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "report.csv", REPORT);
    let path = folder.path().join("path.csv");
    let args =
        ["replay", text(&file), "--vehicle", "toyota-camry-2018", "--steering-ratio", "14.5"];
    let options = ["--draws", "60", "--x", "12", "--heading", "20deg", "--write", text(&path)];
    let args: Vec<&str> = args.into_iter().chain(options).collect();
    let report = answer(&args);
    let speed = median(&report, "/at_contact/speed_m_s");
    assert!((9.0..14.0).contains(&speed), "{speed}");
    assert!(median(&report, "/travelled/turn_rad") > 0.02, "{report}");
    let last = report["path"].as_array().unwrap().last().unwrap();
    assert!((last["x_m"].as_f64().unwrap() - 12.0).abs() < 1e-9, "{last}");
    assert!((last["yaw_rad"].as_f64().unwrap() - 20_f64.to_radians()).abs() < 1e-9, "{last}");
    let written = fs::read_to_string(&path).unwrap();
    assert!(written.lines().count() > 200, "{written}");
    assert!(impactlab(&args).err.contains("path.csv"), "it is there already");
    fs::remove_file(&path).unwrap();

    let asked = program().args(&args).arg("--print-request").output().unwrap();
    let question = json(&ok(asked));
    assert_eq!(question["question"], "replay");
    assert!(!path.exists(), "a question alone writes nothing");
    let question = write(&folder, "question.json", &question.to_string());
    let again = json(&ok(program().args(["ask", text(&question)]).output().unwrap()));
    assert_eq!(again["at_contact"], report["at_contact"]);
}

#[test]
fn the_path_and_what_was_recorded_become_figures() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "report.csv", REPORT);
    for (plot, words) in [
        ("path", &["Y, to the left [m]", "replayed", "90 % band", "first contact"][..]),
        ("speed", &["Speed [km/h]", "recorded", "replayed", "90 % band (low)"]),
        ("yaw-rate", &["Yaw rate [deg/s]", "replayed", "90 % band (high)"]),
        ("steering", &["Steer angle of the road wheels [deg]", "recorded", "replayed"]),
    ] {
        let out = folder.path().join(format!("{plot}.csv"));
        let ratio = ["--steering-ratio", "14.5", "--draws", "60"];
        let render = ["render", "replay", text(&file), "--plot", plot, "--out", text(&out)];
        let report = answer(&render.into_iter().chain(ratio).collect::<Vec<_>>());
        assert!(report["title"].as_str().unwrap().starts_with("report.csv: "), "{report}");
        let numbers = fs::read_to_string(&out).unwrap();
        for word in words {
            assert!(numbers.contains(word), "{plot}: {word}: {numbers}");
        }
        assert!(numbers.contains("driver open"), "what restricts it goes with it: {numbers}");
    }
}

#[test]
fn what_is_assumed_and_what_is_missing_is_said() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "report.csv", REPORT);
    let ran = impactlab(&["replay", text(&file), "--draws", "60"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    for words in
        ["steering ratio 16 ± 2", "no yaw rate is recorded", "sideslip at the first contact"]
    {
        assert!(ran.out.contains(words), "{words}: {}", ran.out);
    }
    let without = REPORT.replace("Steering Input (deg)", "Engine Throttle (%)");
    let file = write(&folder, "without.csv", &without);
    let ran = impactlab(&["replay", text(&file)]);
    let error = ran.error_line();
    assert!(
        error.contains("without.csv") && error.contains("Steering Wheel Angle [deg]"),
        "{error}"
    );
    let ran = impactlab(&["replay", text(&file), "--steering-ratio", "100"]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    let table = write(&folder, "table.csv", "Time [s],Speed [km/h]\n-1,50\n-0.5,50\n0,50\n");
    let ran = impactlab(&["replay", text(&table), "--event", "7"]);
    assert!(ran.error_line().contains("event 7"), "{}", ran.err);
}

/// What the import writes is followed, with its own side of the yaw rate.
#[test]
fn the_controls_of_an_import_are_followed() {
    let folder = TempDir::new().unwrap();
    let turning = "Time [s],Speed [km/h],Steering Wheel Angle [deg],Yaw Rate [deg/s],ABS Activity\n\
        -3,50,60,-16,Off\n-2,50,60,-16,Off\n-1,50,60,-16,Off\n0,50,60,-16,On\n";
    let file = write(&folder, "edr.csv", turning);
    let out = folder.path().join("record");
    ok(program()
        .args(["import", text(&file), "--recorder", "--out", text(&out)])
        .output()
        .unwrap());
    let controls = out.join("controls.csv");
    let of = |file: &str, side: &str| {
        answer(&["replay", file, "--steering-ratio", "15", "--draws", "60", "--yaw-rate", side])
    };
    let [imported, direct] = [of(text(&controls), "left"), of(text(&file), "right")];
    assert_eq!(imported["yaw_rate"], direct["yaw_rate"]);
    assert_eq!(imported["at_contact"], direct["at_contact"]);
    assert!(imported["caveats"].to_string().contains("anti-lock system was at work"), "{imported}");
    assert!(imported["samples"][0]["recorded_yaw_rate_rad_s"].as_f64().unwrap() > 0.0);
}

/// A note, such as that of another steering ratio, stood in the answer and not in the report.
#[test]
fn a_report_of_a_replay_has_its_notes() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "report.csv", REPORT);
    let asked = ["replay", text(&file), "--steering-ratio", "14.5", "--draws", "60"];
    let request = ok(program().args(asked).arg("--print-request").output().unwrap());
    let head = r#"{"format": "impactlab case", "version": 2, "program": "0", "name": "replay","#;
    let variant = format!(r#"{{"name": "a", "questions": [{request}]}}"#);
    let case = format!(r#"{head} "notes": "", "shown": "a", "variants": [{variant}]}}"#);
    let case = write(&folder, "replay.impactlab", &case);
    let out = folder.path().join("de.md");
    let args = ["report", text(&case), "--date", "2026-01-01", "--language", "de", "--out"];
    ok(program().args(args).arg(&out).output().unwrap());
    let told = fs::read_to_string(&out).unwrap();
    assert!(told.contains("Hinweis: Es ist keine Gierrate aufgezeichnet"), "{told}");
    // The opinion had no answer, no method and no figure of it.
    let (opinion, annex) = told.split_once("Jede Zahl dieses Gutachtens").unwrap();
    assert!(opinion.contains("Geschwindigkeit beim ersten Kontakt: "), "{opinion}");
    assert!(!opinion.contains("Keine Antwort des Falls"), "{opinion}");
    assert!(annex.contains("4DOF-Fahrzeugmodell eines einzelnen Fahrzeugs"), "{annex}");
    for wrong in
        ["Keine Antwort stammt aus einem Modell", "gezogene Kräfte", "Gierrate, aufgezeichnet"]
    {
        assert!(!annex.contains(wrong), "{wrong}: {annex}");
    }
}
