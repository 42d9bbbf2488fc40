//! Recordings of steering and of brakes that are of another time than the motion: refused with the shift that
//! would mend it, or said.

use tempfile::TempDir;

use crate::answers::write;
use crate::commands::{Ran, impactlab};
use crate::program::{json, text};

/// The steering wheel of a lane change in the five seconds before an impact, as an event data recorder has
/// it.
const BEFORE_IMPACT: &str =
    "Time [s],Steering Wheel Angle [deg]\n-5,0\n-4,-20\n-3,-60\n-2,-60\n-1,-20\n0,0\n";

fn simulate(file: &str, with: &[&str]) -> Ran {
    let start = ["simulate", "--vehicle", "generic-car", "--speed", "50km/h", "--duration", "5"];
    impactlab(&[&start[..], with, &[file]].concat())
}

#[test]
fn the_seconds_before_an_impact_do_not_steer_the_seconds_after_it() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "edr.csv", BEFORE_IMPACT);
    let steer = ["--steering-ratio", "16", "--steer"];
    let refused = simulate(text(&file), &steer);
    assert_ne!(refused.code, 0, "{}", refused.out);
    let error = refused.error_line();
    assert!(error.contains("from -5 s to 0 s") && error.contains("shift=5:s"), "{error}");
    let shifted = [&["--json", "--steer-map", "shift=5:s"][..], &steer].concat();
    let shifted = simulate(text(&file), &shifted);
    assert_eq!(shifted.code, 0, "{}", shifted.err);
    let yaw_rad = json(&shifted.out)["end"]["yaw_rad"].as_f64().unwrap();
    assert!(yaw_rad < -0.3, "to the right: {yaw_rad}");
}

#[test]
fn brakes_that_are_recorded_long_after_the_motion_are_refused() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "late.csv", "time [s],brake_fl [N m]\n100,0\n101,800\n103,800\n");
    let refused = simulate(text(&file), &["--wheels"]);
    assert_ne!(refused.code, 0, "{}", refused.out);
    assert!(refused.error_line().contains("shift=-100:s"), "{}", refused.err);
}

#[test]
fn a_gap_and_what_acts_after_the_end_follow_a_recording_into_the_answer() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "gap.csv", "time [s],steer [deg]\n0,0\n1,0\n9,5\n10,5\n");
    let ran = simulate(text(&file), &["--steer"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let said = format!("{}{}", ran.out, ran.err);
    assert!(said.contains("samples are missing"), "{said}");
    assert!(said.contains("gap, what acts after 5 s"), "{said}");
}
