//! The command that reads files of other programs.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use impactlab_core::data::{Channel, read_steer_file, read_trajectory_file};
use impactlab_reconstruct::evidence::{Edr, Evidence};

use crate::program::{TRAJECTORIES, answer, program, text};

const REPORT: &[u8] = include_bytes!("../fuzz/corpus/cdr/report.csv");
const EVIDENCE: &str = "tests/data/evidence/spin.toml";

/// The texts of all notes, and the names of the files.
fn said(report: &serde_json::Value) -> (String, Vec<String>) {
    let texts = |key: &str| -> Vec<String> {
        report[key].as_array().unwrap().iter().map(|of| of.as_str().unwrap().to_owned()).collect()
    };
    (texts("notes").join("\n"), texts("files"))
}

#[test]
fn a_recorder_becomes_evidence_and_controls() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let utf16: Vec<u8> = std::iter::once(0xfeff)
        .chain(std::str::from_utf8(REPORT).unwrap().encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    for (name, bytes) in [("utf8", REPORT.to_vec()), ("utf16", utf16)] {
        let report = file(&format!("{name}.csv"));
        fs::write(&report, bytes).unwrap();
        let out = file(name);
        let args = ["import", text(&report), "--evidence", EVIDENCE, "--car", "striking"];
        let answer = answer(&[&args[..], &["--out", text(&out)]].concat());
        let (notes, files) = said(&answer);
        assert_eq!(files.len(), 2, "{files:?}");
        // That its speed was one under the brake was not said.
        assert!(notes.contains("the brake was on at that speed"), "{notes}");
        for part in ["Module 7", "complete file recorded: Yes", "EVENT RECORD 1 of 2", "cut off"] {
            assert!(notes.contains(part), "{part}: {notes}");
        }
        let before = Evidence::load(EVIDENCE.as_ref()).unwrap();
        let evidence = Evidence::load(&out.join("evidence.toml")).unwrap();
        let Edr { ends_s, sensor_m, .. } = evidence.striking_edr.unwrap();
        assert_eq!((ends_s, sensor_m), (Some(0.1), [None; 2]));
        let [low, high] = evidence.striking_edr.unwrap().delta_v_x().unwrap();
        let delta_v_m_s = -14.9 * 0.447_04;
        assert!((low / delta_v_m_s - 1.1).abs() < 1e-9 && (high / delta_v_m_s - 0.9).abs() < 1e-9);
        let without = Evidence { striking_edr: before.striking_edr, ..evidence };
        assert_eq!(without, before, "the rest of the evidence stays as it is");
        let map = "shift=1:s".parse().unwrap();
        let controls = read_steer_file(&out.join("controls.csv"), Some(&map)).unwrap();
        let steering = controls.series.require(Channel::SteeringWheel).unwrap();
        assert!((steering[2] + 20_f64.to_radians()).abs() < 1e-12, "{steering:?}");
        let speed = controls.series.require(Channel::Speed).unwrap();
        assert!((speed[2] - 27.0 * 0.447_04).abs() < 1e-9, "{speed:?}");
    }
}

/// A record alone is no complete evidence, and can be added to all the same.
#[test]
fn evidence_with_a_record_alone_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let report = file("report.csv");
    fs::write(&report, REPORT).unwrap();
    let first = file("first");
    let (notes, _) = said(&answer(&["import", text(&report), "--out", text(&first)]));
    assert!(notes.contains("the evidence is not complete yet: damage of the struck"), "{notes}");
    let evidence = first.join("evidence.toml");
    let written = fs::read_to_string(&evidence).unwrap();
    assert!(!written.contains("side"), "nobody has said a side: {written}");
    let second = file("second");
    let args = ["import", text(&report), "--evidence", text(&evidence), "--car", "striking"];
    answer(&[&args[..], &["--out", text(&second)]].concat());
    let both = Evidence::load_draft(&second.join("evidence.toml")).unwrap();
    assert!(both.edr.is_some() && both.striking_edr == both.edr, "{both:?}");
    assert_eq!(both.damage.side, None);
    let output = program().args(["reconstruct", text(&evidence)]).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && error.contains("damage.side is missing"), "{error}");
}

#[test]
fn a_table_of_a_report_is_opened_as_any_table() {
    let folder = tempfile::tempdir().unwrap();
    let report = folder.path().join("report.csv");
    fs::write(&report, REPORT).unwrap();
    let checked = answer(&["check", text(&report), "--map", "shift=1:s"]);
    let shown = checked.to_string();
    assert!(shown.contains("Bosch CDR report"), "{shown}");
    assert!(shown.contains("steering_wheel"), "{shown}");
}

#[test]
fn a_table_with_a_change_of_velocity_names_the_option_that_reads_it() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("table.csv");
    let header = "Time [ms],\"Delta-V, Longitudinal [km/h]\"\n";
    fs::write(&table, format!("{header}0,0\n50,-16\n100,-30\n120,-32\n150,-32\n")).unwrap();
    let out = folder.path().join("out");
    let output = program().args(["import", text(&table), "--out", text(&out)]).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && error.contains("impactlab import --recorder"), "{error}");
}

#[test]
fn what_a_check_finds_is_said_of_a_series_that_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log.csv");
    let row = |i: u32| {
        let x_m = if i == 30 { -9999.0 } else { 0.4 * f64::from(i) };
        format!("{},{x_m},0\n", 0.02 * f64::from(i))
    };
    let rows: String = (0..100).map(row).collect();
    fs::write(&log, format!("time [s],x [m],y [m]\n{rows}")).unwrap();
    let out = folder.path().join("out");
    let (notes, _) = said(&answer(&["import", text(&log), "--out", text(&out)]));
    assert!(notes.contains("the position jumps by"), "{notes}");
    let series = fs::read_to_string(out.join("series.csv")).unwrap();
    assert!(series.contains("the position jumps by"), "{series}");
}

#[test]
fn a_crash_test_gives_the_stiffness_of_its_front() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    fs::copy("tests/fuzz/corpus/ev5/v1.EV5", file("v1.EV5")).unwrap();
    let curve: String = (-10..=200)
        .map(|i| {
            let t = f64::from(i) * 1e-3;
            let inside = (0..100).contains(&i);
            format!("{t:.4}\t{}\n", if inside { -110_000.0 } else { 0.0 })
        })
        .collect();
    fs::write(file("v1.001"), curve).unwrap();
    let out = file("out");
    let report = answer(&["import", text(&file("v1.EV5")), "--out", text(&out)]);
    let (notes, files) = said(&report);
    assert_eq!(files.len(), 2, "{files:?}");
    assert!(notes.contains("1.100 times the momentum"), "{notes}");
    assert!(notes.contains("no valid data"), "{notes}");
    assert!(notes.contains("CFC 60"), "{notes}");
    // Kv = m V²/(L C²) = 1000 · 10² / (1.8 · 0.4²).
    assert!(notes.contains("Kv = 347222 N/m²"), "{notes}");
    let section = fs::read_to_string(out.join("crush.toml")).unwrap();
    assert!(section.starts_with("[crush.front]\nonset_n_per_m = "), "{section}");
    let again = program().args(["import", text(&file("v1.EV5")), "--out", text(&out)]).output();
    assert!(!again.unwrap().status.success(), "nothing is replaced unasked");
}

/// Evidence that was written by hand was replaced by that of a recorder, which has the record alone.
#[test]
fn evidence_that_was_written_or_completed_by_hand_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    fs::write(file("report.csv"), REPORT).unwrap();
    let (report, out) = (file("report.csv"), file("out"));
    let evidence = out.join("evidence.toml");
    let import = ["import", text(&report), "--overwrite", "--out", text(&out)];
    fs::create_dir(&out).unwrap();
    fs::copy(EVIDENCE, &evidence).unwrap();
    let refused = |what: &str| {
        let before = fs::read(&evidence).unwrap();
        let output = program().args(import).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{what}: {error}");
        assert!(error.contains("evidence.toml: was not written by an earlier run"), "{error}");
        assert!(fs::read(&evidence).unwrap() == before, "{what}: it is as it was");
    };
    refused("by hand");
    fs::remove_file(&evidence).unwrap();
    answer(&import);
    answer(&import);
    let written = fs::read_to_string(&evidence).unwrap();
    fs::write(&evidence, format!("# Completed by hand.\n{written}")).unwrap();
    refused("completed");
}

#[test]
fn a_motion_goes_out_as_parquet_and_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let case = ["export", TRAJECTORIES, "--case", "FE_c002", "--out"];
    for name in ["a.csv", "a.parquet"] {
        answer(&[&case[..], &[text(&file(name))]].concat());
    }
    let read = |name: &str| read_trajectory_file(&file(name), None).unwrap().series;
    assert_eq!(read("a.parquet"), read("a.csv"));
    let out = file("out");
    answer(&["import", text(&file("a.parquet")), "--out", text(&out)]);
    let back = read_trajectory_file(&out.join("series.csv"), None).unwrap().series;
    assert_eq!(back, read("a.csv"));
}

#[test]
fn a_side_of_lateral_values_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("table.csv");
    let rows = "-1,50,10,0\n0,40,10,0\n0.1,,,12\n0.2,,,18\n0.3,,,18\n";
    let header = "Time [s],Speed [km/h],Yaw Rate [deg/s],\"Delta-V, Lateral [km/h]\"\n";
    fs::write(&table, header.to_owned() + rows).unwrap();
    for (side, sign) in [("right", -1.0), ("left", 1.0)] {
        let out = folder.path().join(side);
        let args = ["import", text(&table), "--recorder", "--lateral", side, "--yaw-rate", side];
        let answer = answer(&[&args[..], &["--out", text(&out)]].concat());
        let (notes, _) = said(&answer);
        assert!(
            notes.contains(&format!("lateral Δv is taken as positive to the {side}")),
            "{notes}"
        );
        assert!(!notes.contains("the brake was on"), "{notes}");
        let evidence: toml::Table =
            fs::read_to_string(out.join("evidence.toml")).unwrap().parse().unwrap();
        // Both are positive to the left in this program.
        let bound = |key: &str| evidence["edr"][key].as_float().unwrap();
        let [low, high] = ["delta_v_y_min_m_s", "delta_v_y_max_m_s"].map(bound);
        let middle = (low + high) / 2.0 * 3.6;
        assert!((middle - sign * 18.0).abs() < 1e-9, "{side}: {middle}");
        let controls = fs::read_to_string(out.join("controls.csv")).unwrap();
        let yaw_rate_deg_s: f64 =
            controls.lines().nth(1).unwrap().split(',').nth(2).unwrap().parse().unwrap();
        assert!((yaw_rate_deg_s.to_degrees() - sign * 10.0).abs() < 1e-9, "{side}: {controls}");
    }
}
