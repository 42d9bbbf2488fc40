//! `reconstruct` of a single car that struck nothing.

use std::fs;

use tempfile::TempDir;

use crate::program::{ok, program, text, told_and_reported};

const EVIDENCE: &str = "docs/guide/examples/single_car.toml";

/// What only a collision has.
const OF_IMPACTS: [&str; 6] = ["striking", "bullet", "closing", "delta_v", "Δv", "impulse"];

fn without(told: &str, words: &[&str]) {
    for word in words {
        let line = told.lines().find(|line| line.contains(word));
        assert_eq!(line, None, "{word}");
    }
}

#[test]
fn a_single_car_has_a_speed_at_the_start_and_nothing_of_an_impact() {
    let args = ["reconstruct", EVIDENCE, "--particles", "150"];
    let (told, report) = told_and_reported(&args);
    without(&told, &OF_IMPACTS);
    without(&told, &["struck car"]);
    assert!(told.contains("speed of the car at the start"), "{told}");
    // Places are told to the centimetre that they are measured to, and no further.
    let rest = told.lines().find(|line| line.starts_with("rest y")).unwrap();
    assert!(rest.contains("0.00 m"), "{rest}");

    without(&serde_json::to_string_pretty(&report).unwrap(), &OF_IMPACTS[1..]);
    assert_eq!(report["kind"], "single_car");
    let names: Vec<&str> = report["quantities"]
        .as_array()
        .unwrap()
        .iter()
        .map(|of| of["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["speed_m_s", "sideslip_rad", "yaw_rate_rad_s", "road_friction"]);
    let expected_m_s = (2.0 * 0.66 * 9.80665 * 31.5_f64).sqrt();
    let [low, high] = [0, 1].map(|i| report["quantities"][0]["interval_90"][i].as_f64().unwrap());
    assert!(low < expected_m_s && expected_m_s < high, "{low} to {high}, {expected_m_s} m/s");
    let by_hand = report["by_hand_m_s"][0].as_f64().unwrap();
    assert!((by_hand - expected_m_s).abs() < 0.01, "{by_hand} {expected_m_s} m/s");
    assert_eq!(report["by_hand"][0]["speed"], "at_start");
}

#[test]
fn a_recorded_change_of_velocity_and_a_dent_are_refused_by_name() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("case.toml");
    let evidence = fs::read_to_string(EVIDENCE).unwrap();
    for (table, reason) in [
        ("[edr]\ndelta_v_x_min_m_s = -3\ndelta_v_x_max_m_s = -2\n", "no Δv without an impact"),
        ("[damage]\nside = \"front\"\ny_m = 0\n", "strikes nothing"),
    ] {
        fs::write(&path, format!("{evidence}\n{table}")).unwrap();
        let output = program().args(["reconstruct", text(&path)]).output().unwrap();
        assert!(!output.status.success());
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.contains(reason) && error.contains("case.toml:"), "{error}");
    }
}

#[test]
fn a_figure_of_a_collision_is_refused_and_the_speed_is_drawn() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("speed.csv");
    let draw = |plot: &str| {
        let mut command = program();
        command.args(["render", "reconstruction", EVIDENCE, "--particles", "60", "--plot", plot]);
        command.args(["--out", text(&out)]).output().unwrap()
    };
    let refused = draw("delta-v");
    assert!(!refused.status.success() && !out.exists());
    let error = String::from_utf8(refused.stderr).unwrap();
    assert!(error.contains("is of a single car"), "{error}");
    ok(draw("target-speed"));
    assert!(fs::read_to_string(&out).unwrap().contains("speed of the car at the start"));
}

/// The axes, the 4DOF model, the known error and the settings were told of a struck car.
#[test]
fn a_report_of_a_single_car_speaks_of_no_collision() {
    const SOURCES: &str = "Precision Immobilization";
    let folder = TempDir::new().unwrap();
    for (language, words) in [
        ("en", &["truck", "triking", "ollision", "mpact", "irst contact", "both vehicles"][..]),
        (
            "de",
            &["estoßen", "toßend", "ollision", "ufprall", "Anstoß", "rster Kontakt", "Unfall"][..],
        ),
    ] {
        let out = folder.path().join(format!("{language}.md"));
        let mut command = program();
        command.args(["report", EVIDENCE, "--particles", "60", "--date", "2026-01-01"]);
        ok(command.args(["--language", language, "--out", text(&out)]).output().unwrap());
        let told = fs::read_to_string(&out).unwrap().replace("impactlab", "");
        let told: Vec<&str> = told.lines().filter(|line| !line.contains(SOURCES)).collect();
        // What the models were measured on is told in section 7.
        let end = told.iter().position(|line| line.starts_with("## 7 ")).unwrap();
        assert!(end > 50);
        without(&told[..end].join("\n"), words);
    }
}

/// A car that is driven and touches nothing was called struck, and was asked about after an impact.
#[test]
fn a_report_of_a_driven_car_speaks_of_no_collision() {
    let drive = ["simulate", "--vehicle", "reference-2000", "--speed", "54km/h", "--brake", "0.8"];
    let request = ok(program().args(drive).arg("--print-request").output().unwrap());
    let folder = TempDir::new().unwrap();
    let case = folder.path().join("drive.impactlab");
    let head = r#"{"format": "impactlab case", "version": 2, "program": "0", "name": "drive","#;
    let variant = format!(r#"{{"name": "a", "questions": [{request}]}}"#);
    fs::write(&case, format!(r#"{head} "notes": "", "shown": "a", "variants": [{variant}]}}"#))
        .unwrap();
    for (language, words) in [
        ("en", &["truck", "triking", "ollision", "mpact", "ontact"][..]),
        ("de", &["estoßen", "toßend", "ollision", "ufprall", "Anstoß", "Kontakt", "Unfall"][..]),
    ] {
        let out = folder.path().join(format!("{language}.md"));
        let args = ["report", text(&case), "--date", "2026-01-01", "--language", language];
        ok(program().args(args).args(["--out", text(&out)]).output().unwrap());
        let told = fs::read_to_string(&out).unwrap().replace("impactlab", "");
        let (told, _) = told.split_once("\n## 2 ").expect("scenes and curves");
        without(told, words);
    }
}

#[test]
fn marks_without_a_place_of_rest_are_warned_of() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("case.toml");
    let evidence = fs::read_to_string(EVIDENCE).unwrap();
    let rest = "[rest]\nx_m = 31.5\ny_m = 0.0\nheading_deg = 0\n";
    assert!(evidence.contains(rest));
    fs::write(&path, evidence.replace(rest, "")).unwrap();
    let told = |path: &str| {
        ok(program().args(["reconstruct", path, "--particles", "60"]).output().unwrap())
    };
    let warning = "no place of rest is stated";
    assert!(told(text(&path)).contains(warning) && !told(EVIDENCE).contains(warning));
}
