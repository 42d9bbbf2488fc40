//! The command that writes for other programs.

use std::fs;

use serde_json::Value;

use crate::program::{TRAJECTORIES, answer, program, text};

#[test]
fn each_format_is_written_and_nothing_is_replaced_unasked() {
    let folder = tempfile::tempdir().expect("a folder");
    let case = ["export", TRAJECTORIES, "--case", "FE_c002", "--out"];
    for (file, options, format, begins) in [
        ("a.dxf", vec!["--at", "0.5"], "dxf", "  0\r\nSECTION"),
        ("a.glb", vec![], "glb", "glTF"),
        ("a.csv", vec![], "motion", "time_s,"),
        ("pulse.txt", vec!["--format", "hve-pulse"], "hve-pulse", "# FE_c002: collision force"),
        ("motion.txt", vec!["--format", "hve-motion"], "hve-motion", "# FE_c002: motion"),
    ] {
        let out = folder.path().join(file);
        let args = [&case[..], &[text(&out)], &options].concat();
        let report = answer(&args);
        assert_eq!(
            (&report["format"], &report["title"]),
            (&Value::from(format), &"FE_c002".into())
        );
        let written = fs::read(&out).expect("a file");
        let start = String::from_utf8_lossy(&written[..begins.len()]).into_owned();
        assert_eq!(start, begins, "{file}");
        let again = program().args(&args).output().expect("it starts");
        let error = String::from_utf8_lossy(&again.stderr).into_owned();
        assert!(error.contains("exists already; --overwrite replaces it"), "{error}");
    }
    for (file, options, part) in [
        (
            "a.step",
            vec![],
            "expected a name that ends in .dxf, .kml, .geojson, .glb, .csv or .parquet, or --format",
        ),
        // A table was written under the name of a scene.
        ("m.glb", vec!["--format", "motion"], "expected a name that ends in .csv"),
        ("p.dxf", vec!["--format", "hve-pulse"], "expected a name that ends in .txt"),
        ("b.glb", vec!["--at", "1"], "leave it out, or write a drawing (.dxf)"),
        ("b.dxf", vec!["--at", "900"], "--at is 900 s, expected between"),
    ] {
        let out = folder.path().join(file);
        let args = [&case[..], &[text(&out)], &options].concat();
        let output = program().args(&args).output().expect("it starts");
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && error.contains(part), "{error}");
        assert!(!out.exists());
    }
}

#[test]
fn a_reconstruction_is_written_with_what_was_found_and_the_path_of_each_course() {
    let folder = tempfile::tempdir().expect("a folder");
    let evidence = ["export", "tests/data/evidence/spin.toml", "--particles", "60", "--out"];
    for (file, format) in [("a.dxf", "dxf"), ("a.glb", "glb"), ("a.csv", "motion")] {
        let out = folder.path().join(file);
        let report = answer(&[&evidence[..], &[text(&out)]].concat());
        assert_eq!(report["format"], format);
        let notes = report["notes"].to_string();
        assert!(notes.contains("no intervals are given"), "{notes}");
    }
    let read = |file: &str| fs::read(folder.path().join(file)).expect("a file");
    let drawing = String::from_utf8_lossy(&read("a.dxf")).into_owned();
    for part in ["SIMULATED_PATH", "SIMULATED_OUTLINE", "EVIDENCE_LINE", "few particles"] {
        assert!(drawing.contains(part), "{part}");
    }
    let table = String::from_utf8(read("a.csv")).expect("UTF-8");
    let mut lines = table.lines();
    assert!(lines.next().is_some_and(|header| header.starts_with("course,time_s,x_m,y_m,yaw_rad")));
    let last = lines.last().expect("rows");
    // The car comes to rest some 45 m on; what restricts all rows stands in the first.
    let x_m: f64 = last.split(',').nth(2).and_then(|cell| cell.parse().ok()).expect("x");
    assert!((35.0..55.0).contains(&x_m), "{last}");
    assert!(table.lines().nth(1).is_some_and(|first| first.contains("few particles")), "{table}");
    let scene = read("a.glb");
    assert!(scene.windows(22).any(|part| part == b"no intervals are given"), "restrictions");
    let hve = folder.path().join("a.txt");
    let args = [&evidence[..], &[text(&hve), "--format", "hve-pulse"]].concat();
    let output = program().args(&args).output().expect("it starts");
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && error.contains("contact force over time"), "{error}");
    assert!(!hve.exists());
}

/// “the restrictions are in metres and SI units” stood above a height of “1.71 ft above the ground”.
#[test]
fn restrictions_in_a_table_for_hve_have_the_units_that_they_say() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("motion.txt");
    let case = ["export", "pit-right-rear", "--format", "hve-motion", "--units", "us", "--out"];
    answer(&[&case[..], &[text(&out)]].concat());
    let written = fs::read_to_string(&out).expect("a file");
    assert!(written.contains(" ft above the ground"), "{written}");
    assert!(!written.contains("SI units"), "{written}");
}
