//! What restricts an answer is in every picture and table of it, and the program reads such tables again.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::answers::scenario_with;
use crate::program::{SCENARIO, ok, program, text};

const SENTENCE: &str = "outside the domain: mass of the striking vehicle [kg] is 3900";

fn run(args: &[&str]) -> String {
    ok(program().args(args).output().unwrap())
}

/// A collision with a striking vehicle that is heavier than any that the force network knows.
fn heavy(folder: &TempDir) -> PathBuf {
    let from = "[bullet]\nmass_kg = 2000";
    scenario_with(folder, "heavy.toml", from, "[bullet]\nmass_kg = 3900")
}

/// The header of a table and what its last column says, each row's after the other.
fn last_column(path: &Path) -> (String, String) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let header = reader.headers().unwrap().iter().next_back().unwrap().to_owned();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert!(rows.iter().skip(1).all(|row| row.iter().next_back() == Some("")), "{path:?}");
    (header, rows[0].iter().next_back().unwrap().to_owned())
}

/// Number of pixels in the lower part of a picture with the colour of a warning.
fn n_warning_pixels(path: &Path) -> usize {
    let image = image::open(path).unwrap().to_rgba8();
    let is_warning = |pixel: &image::Rgba<u8>| {
        pixel.0.iter().zip([160_u8, 90, 0]).all(|(is, wanted)| is.abs_diff(wanted) < 12)
    };
    let lower = image.enumerate_pixels().filter(|(_, y, _)| *y > image.height() * 6 / 10);
    lower.filter(|(_, _, pixel)| is_warning(pixel)).count()
}

#[test]
fn every_table_and_picture_of_a_prediction_says_what_restricts_it() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let scenario = heavy(&folder);
    run(&["predict", "--draws", "2", "--scenario", text(&scenario), "--out", text(&out)]);
    let mut n_tables = 0;
    for entry in fs::read_dir(&out).unwrap() {
        let path = entry.unwrap().path();
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("csv") => {
                let (header, restriction) = last_column(&path);
                assert_eq!(header, "restrictions", "{path:?}");
                assert!(restriction.contains(SENTENCE), "{path:?}: {restriction}");
                n_tables += 1;
            }
            Some("png") => assert!(n_warning_pixels(&path) > 100, "{path:?}"),
            _ => {}
        }
    }
    assert_eq!(n_tables, 9, "trajectory, density, scene and six channels");
}

#[test]
fn a_restricted_force_is_read_again_and_says_so() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let scenario = heavy(&folder);
    let args = ["predict", "force", "--samples", "1", "--scenario", text(&scenario), "--out"];
    run(&[&args[..], &[text(&out)]].concat());
    for name in ["bands.csv", "mean.csv", "sample_001.csv"] {
        let (header, restriction) = last_column(&out.join(name));
        assert!(
            header == "restrictions" && restriction.contains(SENTENCE),
            "{name}: {restriction}"
        );
    }
    let printed = run(&["check", text(&out.join("mean.csv"))]);
    assert!(printed.contains("the file says of itself: warning: outside the domain"), "{printed}");
    assert!(printed.contains("\nproblems   0\n"), "{printed}");
}

/// The table of a plan had neither time nor heading.
#[test]
fn the_table_of_a_plan_has_time_and_heading_of_every_path() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("scene.csv");
    let data = ["render", "scene", "datasets/trajectories-fea", "--case", "FE_c002"];
    run(&[&data[..], &["--time", "1.5", "--out", text(&path)]].concat());
    let mut reader = csv::Reader::from_path(&path).unwrap();
    let header: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let of_path = ["X, along the road [m]", "Y, to the left [m]", "Time [s]", "Heading [deg]"];
    assert_eq!(header[1..5], of_path);
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    for name in ["recorded", "4DOF simulation"] {
        let path: Vec<f64> = rows
            .iter()
            .filter(|row| &row[0] == name && !row[3].is_empty())
            .map(|row| {
                assert!(row[4].parse::<f64>().unwrap().is_finite());
                row[3].parse().unwrap()
            })
            .collect();
        assert!(path.len() > 100 && path.is_sorted(), "{name}: {path:?}");
    }
}

/// A car that steers along a file has struck nothing, and nobody has struck it.
#[test]
fn the_vehicle_of_a_drive_without_a_collision_is_no_struck_one() {
    let steer = "docs/guide/examples/steering.csv";
    let printed = run(&["simulate", "--steer", steer, "--speed", "50km/h"]);
    assert!(printed.contains("assumed vehicle: reference-2000"), "{printed}");
    assert!(!printed.contains("struck"), "{printed}");
}

#[test]
fn what_was_assumed_is_in_the_table_of_a_simulation() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("motion.csv");
    run(&["simulate", "--scenario", SCENARIO, "--out", text(&path)]);
    let (header, restriction) = last_column(&path);
    assert_eq!(header, "restrictions");
    assert!(restriction.contains("note: assumed: struck vehicle: "), "{restriction}");
    let printed = run(&["check", text(&path)]);
    let has_no_problem = printed.contains("\nproblems   0\n");
    assert!(printed.contains("trajectory file") && has_no_problem, "{printed}");
}

/// A record that ends during the contact was a force that comes to zero.
#[test]
fn a_record_that_ends_during_the_contact_is_said_to_be_cut() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("cut.csv");
    fs::write(&path, "time_s,fx_n,fy_n\n0,0,0\n0.02,0,40000\n0.04,0,30000\n").unwrap();
    let picture = folder.path().join("cut.png");
    let printed = run(&["render", "force", text(&path), "--out", text(&picture)]);
    let restriction = "contact not ended: the record ends after 0.040 s at 75.0 % of the peak";
    assert!(printed.contains(restriction), "{printed}");
    assert!(n_warning_pixels(&picture) > 100);
    let printed =
        run(&["simulate", "--force", text(&path), "--speed", "15", "--contact=-1.5,-0.9,0.5"]);
    assert!(printed.contains(&format!("warning: {restriction}")), "{printed}");
}
