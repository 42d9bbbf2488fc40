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
    assert!(error.contains("from -5 s to 0 s"), "{error}");
    assert!(error.contains("e.g. --steer-map \"shift=5:s\""), "{error}");
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
    assert!(refused.error_line().contains("e.g. --wheels-map \"shift=-100:s\""), "{}", refused.err);
    let shifted = ["--wheels-map", "shift=-100:s", "--wheels"];
    let shifted = simulate(text(&file), &[&["--json"][..], &shifted].concat());
    assert_eq!(shifted.code, 0, "{}", shifted.err);
    let braked_m_s = json(&shifted.out)["end"]["speed_m_s"].as_f64().unwrap();
    let coasting = json(&simulate("--json", &[]).out)["end"]["speed_m_s"].as_f64().unwrap();
    assert!(braked_m_s < coasting - 1.0, "{braked_m_s} {coasting}");
}

/// A file without units was refused for the angle alone, so that the shift was asked for only afterwards.
#[test]
fn unit_and_shift_of_a_record_without_units_are_offered_together() {
    let folder = TempDir::new().unwrap();
    let text_without = BEFORE_IMPACT.replace(" [s]", "").replace(" [deg]", "");
    let file = write(&folder, "edr.csv", &text_without);
    let steer = ["--json", "--steering-ratio", "16", "--steer"];
    let refused = simulate(text(&file), &steer);
    assert_ne!(refused.code, 0, "{}", refused.out);
    let map = "shift=5:s,steering_wheel=2:deg";
    let error = refused.error_line();
    assert!(error.contains(&format!("e.g. --steer-map \"{map}\"")), "{error}");
    assert!(error.contains("column 2 \"Steering Wheel Angle\" names no unit"), "{error}");
    let mended = simulate(text(&file), &[&["--steer-map", map][..], &steer].concat());
    let with_units = write(&folder, "units.csv", BEFORE_IMPACT);
    let shifted = ["--steer-map", "shift=5:s"];
    let stated = simulate(text(&with_units), &[&shifted[..], &steer].concat());
    let yaw_rad = |ran: &Ran| json(&ran.out)["end"]["yaw_rad"].as_f64().unwrap();
    assert_eq!(yaw_rad(&mended), yaw_rad(&stated), "{}", mended.err);
}

/// Half a degree that is read as half a radian turns the car, so that the answer says how it was read.
#[test]
fn units_that_nobody_states_follow_a_recording_into_the_answer() {
    let folder = TempDir::new().unwrap();
    let steer = write(&folder, "half.csv", "time,steer\n0,0\n1,0.5\n5,0.5\n");
    let brakes = write(&folder, "brakes.csv", "time,brake_fl\n0,0.5\n5,0.5\n");
    let ran = simulate(text(&brakes), &["--steer", text(&steer), "--wheels"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let said = format!("{}{}", ran.out, ran.err);
    assert!(said.contains("half: column 2 \"steer\" names no unit; taken as rad"), "{said}");
    assert!(said.contains("brakes: column 2 \"brake_fl\" names no unit; taken as N m"), "{said}");
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
