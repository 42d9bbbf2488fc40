//! Files whose header says nothing are read with a map of their own option, which the refusal names.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::PathBuf;

use serde_json::Value;
use tempfile::TempDir;

use crate::answers::write;
use crate::commands::{Ran, impactlab};
use crate::program::{json, text};

const MOTION: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/trajectories-fea/trajectories/FE_c001.csv");
const FORCE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea/forces/c001.csv");

/// Some columns of a file under headers that say nothing.
fn without_names(folder: &TempDir, file: &str, columns: &[usize]) -> PathBuf {
    let full = fs::read_to_string(file).unwrap();
    let mut lines = full.lines().skip(1).peekable();
    let header: Vec<String> = columns.iter().map(|column| format!("Kanal {column}")).collect();
    let mut plain = header.join(",") + "\n";
    while let Some(line) = lines.next() {
        let cells: Vec<&str> = line.split(',').collect();
        let chosen: Vec<&str> = columns.iter().map(|column| cells[*column]).collect();
        plain += &(chosen.join(",") + if lines.peek().is_some() { "\n" } else { "" });
    }
    write(folder, "plain.csv", &plain)
}

fn predict(folder: &TempDir, name: &str, with: &[&str]) -> Ran {
    let out = folder.path().join(name);
    let start = ["predict", "--json", "--vehicle-draws", "0", "--draws", "1", "--out", text(&out)];
    impactlab(&[&start[..], with].concat())
}

fn outcome(ran: &Ran) -> Value {
    assert_eq!(ran.code, 0, "{}", ran.err);
    json(&ran.out)["outcome"].clone()
}

#[test]
fn a_recorded_motion_without_names_is_predicted_with_its_map() {
    let folder = TempDir::new().unwrap();
    let plain = without_names(&folder, MOTION, &[0, 1, 2, 3, 5, 6, 7, 11, 12, 13]);
    let given = ["--given-force", "--trajectory"];
    let refused = predict(&folder, "refused", &[&given[..], &[text(&plain)]].concat());
    assert_ne!(refused.code, 0, "{}", refused.out);
    assert!(refused.error_line().contains("--map time=COLUMN"), "{}", refused.err);
    let map = "time=1:s,x=2:m,y=3:m,yaw=4:rad,vx=5:m/s,vy=6:m/s,yaw_rate=7:rad/s,fx_body=8:N,\
               fy_body=9:N,mz=10:N m";
    let mapped = predict(&folder, "m", &[&given[..], &[text(&plain), "--map", map]].concat());
    let named = fs::read_to_string(&plain).unwrap();
    let (_, numbers) = named.split_once('\n').unwrap();
    let header = "time_s,x_m,y_m,yaw_rad,vx_m_s,vy_m_s,yaw_rate_rad_s,fx_body_n,fy_body_n,mz_nm";
    let named = write(&folder, "named.csv", &format!("{header}\n{numbers}"));
    let of_header = predict(&folder, "h", &[&given[..], &[text(&named)]].concat());
    assert_eq!(outcome(&mapped), outcome(&of_header));
}

#[test]
fn a_force_without_names_is_read_with_its_map_and_the_hint_names_the_option() {
    let folder = TempDir::new().unwrap();
    let plain = without_names(&folder, FORCE, &[0, 1, 2, 3]);
    let scenario = ["--scenario", "pit-right-rear", "--force"];
    let refused = predict(&folder, "refused", &[&scenario[..], &[text(&plain)]].concat());
    assert_ne!(refused.code, 0, "{}", refused.out);
    assert!(refused.error_line().contains("--force-map time=COLUMN"), "{}", refused.err);
    let map = "time=1:s,fx=2:N,fy=3:N,mz=4:N m";
    let with_map = [text(&plain), "--force-map", map];
    let mapped = predict(&folder, "m", &[&scenario[..], &with_map].concat());
    let named = fs::read_to_string(&plain).unwrap().replacen(
        "Kanal 0,Kanal 1,Kanal 2,Kanal 3",
        "time_s,fx_n,fy_n,mz_nm",
        1,
    );
    let named = write(&folder, "named.csv", &named);
    let of_header = predict(&folder, "h", &[&scenario[..], &[text(&named)]].concat());
    assert_eq!(outcome(&mapped), outcome(&of_header));
}

#[test]
fn the_force_of_a_log_is_read_with_its_map_and_the_hint_names_the_option() {
    let folder = TempDir::new().unwrap();
    let plain = without_names(&folder, FORCE, &[0, 1, 2, 3]);
    let out = folder.path().join("car.model");
    let learn = ["condition", "response", "--vehicle", "reference-2000", "--log", MOTION];
    let force = ["--force", text(&plain), "--out", text(&out)];
    let refused = impactlab(&[&learn[..], &force].concat());
    assert_ne!(refused.code, 0, "{}", refused.out);
    assert!(refused.error_line().contains("--force-map time=COLUMN"), "{}", refused.err);
    let map = ["--json", "--force-map", "time=1:s,fx=2:N,fy=3:N,mz=4:N m"];
    let learned = impactlab(&[&learn[..], &force, &map].concat());
    assert_eq!(learned.code, 0, "{}", learned.err);
    let impulse = &json(&learned.out)["logs"][0]["impulse_n_s"];
    let rows = fs::read_to_string(FORCE).unwrap();
    let fy = rows.lines().skip(1).map(|row| row.split(',').nth(2).unwrap().parse::<f64>().unwrap());
    let expected_n_s = fy.sum::<f64>() * 5e-4;
    let got_n_s = impulse[1].as_f64().unwrap();
    assert!((got_n_s / expected_n_s - 1.0).abs() < 0.01, "{got_n_s} {expected_n_s}");
}

#[test]
fn a_force_without_a_collision_is_told_what_it_lacks() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    for with in [&[][..], &["--out", text(&out)]] {
        let ran = impactlab(&[&["predict", "--force", FORCE], with].concat());
        assert_ne!(ran.code, 0, "{}", ran.out);
        for word in ["a force alone", "--scenario FILE", "impactlab simulate --force"] {
            assert!(ran.error_line().contains(word), "{}", ran.err);
        }
    }
    assert!(!out.exists(), "nothing was predicted");
    let without_folder = impactlab(&["predict", "--force", FORCE, "--scenario", "pit-right-rear"]);
    assert!(without_folder.err.contains("--out <DIR>"), "{}", without_folder.err);
}

#[test]
fn check_shows_the_columns_of_the_part_that_the_map_names() {
    let folder = TempDir::new().unwrap();
    write(&folder, "a.mme", "Data format edition number  :1.6\nLaboratory name             :L\n");
    for (file, code, interval) in
        [("a.001", "11HEAD000000ACXP", "0.001"), ("a.002", "11CHST000000ACXP", "0.002")]
    {
        let text = format!(
            "Channel code                :{code}\nReference channel           :implicit\n\
             Sampling interval           :{interval}\nUnit                        :m/s^2\n1\n2\n3\n"
        );
        write(&folder, file, &text);
    }
    let test = folder.path().join("a.mme");
    let checked = impactlab(&["check", text(&test), "--map", "sheet=2"]);
    assert_eq!(checked.code, 1, "{}", checked.err);
    let (_, columns) = checked.out.split_once("--map \"sheet=2,time=1").expect(&checked.out);
    let shown = ["11HEAD000000ACXP", "11CHST000000ACXP"].map(|code| columns.contains(code));
    assert_eq!(shown, [false, true], "{}", checked.out);
}
