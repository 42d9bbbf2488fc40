//! Recorders of motions that are known.

use std::fmt::Write as _;
use std::ops::ControlFlow;

use tempfile::TempDir;

use crate::{Answer, Library, Question, ReplayReport, ReplayRequest, StudyError, VehicleChoice};
use impactlab_core::uncertainty::CaveatKind;
use impactlab_core::units::Estimate;
use impactlab_core::vehicle::{
    DrivenAxle, Integrator, Preset, RecordedDrive, RecordedMotion, built_in_vehicle,
};

const RATIO: f64 = 15.0;

/// Braking from 22 m/s out of a turn to the left, as it was.
fn truth() -> RecordedMotion {
    let vehicle = Preset::Reference.parameters();
    let n = 60;
    let time_s: Vec<f64> = (0..=n).map(|i| -5.0 * f64::from(n - i) / f64::from(n)).collect();
    let speed_m_s = time_s.iter().map(|t| 22.0 - 4.0 * (t + 2.5).max(0.0)).collect();
    let steer_rad = time_s.iter().map(|t| wheel_rad(*t) / RATIO).collect();
    let drive = RecordedDrive { time_s, speed_m_s, steer_rad };
    let manoeuvre = drive.manoeuvre(DrivenAxle::Front);
    let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap();
    drive.motion(&vehicle, &motion).unwrap()
}

/// The steering wheel over time to the contact.
fn wheel_rad(time_s: f64) -> f64 {
    0.5 * (-(time_s + 2.5).powi(2) / 2.0).exp()
}

/// What a recorder keeps of it, the last sample 0.2 s before the contact.
///
/// - `yaw_sign`: 1 to the right.
fn table(motion: &RecordedMotion, yaw_sign: f64) -> String {
    let header =
        "Time [s],Speed [km/h],Steering Wheel Angle [deg],Yaw Rate [deg/s],Service Brake\n";
    let mut text = header.to_owned();
    for idx in 0..=9 {
        let recorder_s = -4.5 + 0.5 * f64::from(idx);
        let point = motion.at(recorder_s - 0.2).unwrap();
        let speed = (point.vx_body_m_s * 3.6).round();
        let wheel = (wheel_rad(recorder_s - 0.2).to_degrees() / 5.0).round() * 5.0;
        let rate = -yaw_sign * point.yaw_rate_rad_s.to_degrees().round();
        let brake = if recorder_s > -2.2 { "On" } else { "Off" };
        writeln!(text, "{recorder_s},{speed},{wheel},{rate},{brake}").unwrap();
    }
    text
}

fn replayed(
    text: &str,
    change: impl FnOnce(&mut ReplayRequest),
) -> Result<Answer<ReplayReport>, StudyError> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("edr.csv");
    std::fs::write(&path, text).unwrap();
    let mut request = ReplayRequest {
        vehicle: VehicleChoice::named("reference-2000"),
        steering_ratio: Some(RATIO),
        draws: 100,
        ..ReplayRequest::new(path)
    };
    change(&mut request);
    let answer = request.answer(&Library::default(), &mut |_| ControlFlow::Continue(()))?;
    Ok(answer.complete().unwrap().report)
}

fn told(answer: &Answer<ReplayReport>, words: &str) -> bool {
    answer.caveats.iter().any(|of| of.text.contains(words))
}

fn holds(estimate: &Estimate, value: f64) -> bool {
    let [low, high] = estimate.ninety();
    (low..=high).contains(&value)
}

#[test]
fn the_way_that_was_driven_is_in_the_interval_and_the_yaw_rate_agrees() {
    let truth = truth();
    let answer = replayed(&table(&truth, 1.0), |_| {}).unwrap();
    let (start, end) = (truth.at(-4.7).unwrap(), truth.at(0.0).unwrap());
    let turn_rad = end.yaw_rad - start.yaw_rad;
    let (sin, cos) = start.yaw_rad.sin_cos();
    let (dx, dy) = (end.x_m - start.x_m, end.y_m - start.y_m);
    let way = &answer.travelled;
    assert!(holds(&way.ahead_m, cos * dx + sin * dy), "{way:?}");
    assert!(holds(&way.left_m, cos * dy - sin * dx), "{way:?}");
    assert!(holds(&way.turn_rad, turn_rad), "{way:?} {turn_rad}");
    assert!(holds(&answer.at_contact.speed_m_s, end.vx_body_m_s), "{:?}", answer.at_contact);
    assert!(holds(&answer.at_contact.yaw_rate_rad_s, end.yaw_rate_rad_s), "{answer:?}");
    let check = answer.yaw_rate.as_ref().unwrap();
    assert!(!check.disagrees, "{check:?}");
    assert!(holds(check.implied_steering_ratio.as_ref().unwrap(), RATIO), "{check:?}");
    assert!(!answer.caveats.has(CaveatKind::Disagreement), "{:?}", answer.caveats);
    assert!(!told(&answer, "does not keep the recorded speed"), "{:?}", answer.caveats);
    // An interval is as wide as what is not known, and no wider than the speed and the moment make it.
    let [low, high] = way.ahead_m.ninety();
    assert!((3.0..25.0).contains(&(high - low)), "{low} to {high}");
}

/// With 8 and with 11 the computed car slides away while it is braked, which has no factor: the samples before
/// that say which ratio it is.
#[test]
fn a_wrong_steering_ratio_is_found_by_the_yaw_rate_before_the_tires_slide() {
    let truth = truth();
    for stated in [8.0, 11.0, 25.0] {
        let answer = replayed(&table(&truth, 1.0), |of| of.steering_ratio = Some(stated)).unwrap();
        let check = answer.yaw_rate.as_ref().unwrap();
        let implied = check.implied_steering_ratio.as_ref().unwrap();
        assert!(holds(implied, RATIO) && !check.is_opposite(), "{stated}: {check:?}");
        let nearer = (implied.median - RATIO).abs() < (stated - RATIO).abs();
        let [low, high] = implied.ninety();
        assert!(nearer && high - low > 2.0, "{stated}: {check:?}");
    }
    let tells = |stated: f64| {
        let answer = replayed(&table(&truth, 1.0), |of| of.steering_ratio = Some(stated)).unwrap();
        told(&answer, "with a steering ratio of")
    };
    assert!([8.0, 10.0, 25.0].into_iter().all(tells) && !tells(RATIO));
    let answer = replayed(&table(&truth, 1.0), |of| of.steering_ratio = Some(8.0)).unwrap();
    let check = answer.yaw_rate.as_ref().unwrap();
    assert!(check.disagrees && answer.caveats.has(CaveatKind::Disagreement), "{check:?}");
    assert!(told(&answer, "with a steering ratio of"), "{:?}", answer.caveats);
}

#[test]
fn a_wrong_side_is_seen_in_the_yaw_rate() {
    let turned = table(&truth(), -1.0);
    let answer = replayed(&turned, |_| {}).unwrap();
    let check = answer.yaw_rate.as_ref().unwrap();
    assert!(check.disagrees && check.is_opposite(), "{check:?}");
    assert!(check.implied_steering_ratio.is_none() && told(&answer, "to the other side"));
    let answer = replayed(&turned, |of| of.yaw_rate_left = true).unwrap();
    assert!(!answer.yaw_rate.as_ref().unwrap().disagrees);
}

/// A single sample that is lower than what the brakes can do, between steps that show no such change.
#[test]
fn a_recorded_speed_that_the_motion_does_not_keep_is_said() {
    let rows: String = [80, 80, 80, 60, 80, 80, 80, 80]
        .iter()
        .enumerate()
        .map(|(idx, speed)| format!("{:.1},{speed},0\n", 0.1 * idx as f64 - 0.7))
        .collect();
    let text = format!("Time [s],Speed [km/h],Steering Wheel Angle [deg]\n{rows}");
    let answer = replayed(&text, |_| {}).unwrap();
    assert!(told(&answer, "does not keep the recorded speed"), "{:?}", answer.caveats);
}

/// Rows without a speed leave a gap, over which nothing is known; the rest can be followed.
#[test]
fn a_gap_in_the_record_is_not_bridged() {
    let text = "Time [s],Speed [km/h],Steering Wheel Angle [deg]\n\
        -3,80,0\n-2.5,80,0\n-2,,0\n-1.5,,0\n-1,80,0\n-0.5,78,0\n0,76,0\n";
    let error = replayed(text, |_| {}).unwrap_err().to_string();
    assert!(error.contains("no sample for 1.5 s after -2.5 s"), "{error}");
    let answer = replayed(text, |of| of.from_s = Some(-1.0)).unwrap();
    assert!(told(&answer, "that have no speed"), "{:?}", answer.caveats);
}

/// The path ends where the contact is said to be, and the first sample is where it came from.
#[test]
fn a_path_is_placed_backwards() {
    let text = table(&truth(), 1.0);
    let [free, placed] = [0.0, 1.2].map(|yaw_rad| {
        let change = |of: &mut ReplayRequest| {
            (of.contact.x_m, of.contact.yaw_rad) = (10.0 * yaw_rad, yaw_rad);
        };
        replayed(&text, change).unwrap()
    });
    let last = placed.path.last().unwrap();
    assert!((last.x_m - 12.0).abs() < 1e-9 && (last.yaw_rad - 1.2).abs() < 1e-9, "{last:?}");
    assert!((last.time_s, last.x_range_m[1] - last.x_range_m[0]) == (0.0, 0.0), "{last:?}");
    let length = |of: &ReplayReport| {
        let (first, last) = (of.path.first().unwrap(), of.path.last().unwrap());
        (last.x_m - first.x_m).hypot(last.y_m - first.y_m)
    };
    assert!((length(&free) - length(&placed)).abs() < 1e-6);
    let [one, other] = [&free, &placed].map(|of| of.travelled.left_m.median);
    assert!((one - other).abs() < 1e-6, "{one} {other}");
}

#[test]
fn wheels_that_lock_are_no_speed_over_ground() {
    let text = "Time [s],Speed [km/h],Steering Wheel Angle [deg],ABS Activity\n\
        -2,72,0,Off\n-1.5,72,0,Off\n-1,72,0,Off\n-0.5,20,0,Off\n0,0,0,Off\n";
    let answer = replayed(text, |_| {}).unwrap();
    assert!(told(&answer, "not the speed over ground"), "{:?}", answer.caveats);
    // Half a second at the limit of the road is not enough to stop from there.
    assert!(answer.at_contact.speed_m_s.median > 4.0, "{:?}", answer.at_contact);
    let slow = text.replace("-0.5,20,0,Off\n0,0,0,Off", "-0.5,66,0,On\n0,60,0,On");
    let answer = replayed(&slow, |_| {}).unwrap();
    assert!(told(&answer, "anti-lock system was at work"), "{:?}", answer.caveats);
}

#[test]
fn a_vehicle_of_a_data_sheet_is_drawn_with_it_and_the_seed_decides() {
    let text = table(&truth(), 1.0);
    let sheet = "toyota-camry-2018";
    assert!(built_in_vehicle(sheet).is_some_and(|vehicle| vehicle.sheet.is_some()));
    let ask = |seed| {
        let change = |of: &mut ReplayRequest| {
            (of.vehicle, of.seed) = (VehicleChoice::named(sheet), seed);
        };
        replayed(&text, change).unwrap()
    };
    let answer = ask(1);
    let told = |words: &str| answer.caveats.assumptions().any(|of| of.text.contains(words));
    assert!(told("cornering coefficient"), "{:?}", answer.caveats);
    let same = ask(1);
    assert_eq!(answer.travelled, same.travelled);
    assert!(answer.travelled != ask(2).travelled);
}

#[test]
fn a_record_that_cannot_be_followed_is_refused_with_what_is_missing() {
    for (text, words) in [
        ("Time [s],Speed [km/h]\n-1,50\n-0.5,49\n0,48\n", "Steering Wheel Angle [deg]"),
        (
            "Time [s],Speed [km/h],Steering Wheel Angle [deg]\n-40,50,0\n-35,48,0\n",
            "fewer than three samples",
        ),
        (
            "Time [s],Speed [km/h],Steering Wheel Angle [deg]\n-20,50,0\n-19.5,50,0\n-19,50,0\n",
            "within 5 s before the crash",
        ),
        (
            "Time [s],Speed [km/h],Steering Wheel Angle [deg]\n-1,50,0\n-0.0001,50,0\n0,50,0\n",
            "at least 1 ms apart",
        ),
        (
            "Time [s],Speed [km/h],Steering Wheel Angle [deg]\n-1,50,0\n-0.5,50,9\n0,50,1000\n",
            "steer angle",
        ),
        (
            "Time [s],Speed [km/h],Steering Wheel Angle [deg]\n-1,-20,0\n-0.5,-20,0\n0,-20,0\n",
            "backwards",
        ),
        (
            "Time [s],Speed [km/h],Steering Wheel Angle [deg]\n-1,50,0\n-2,50,0\n0,50,0\n",
            "do not increase",
        ),
    ] {
        let error = replayed(text, |_| {}).unwrap_err();
        let error = impactlab_core::error_chain(&error);
        assert!(error.contains(words) && error.contains("edr.csv"), "{words}: {error}");
    }
    let text = table(&truth(), 1.0);
    let error = replayed(&text, |of| of.draws = 3).unwrap_err().to_string();
    assert!(error.contains("draws"), "{error}");
}
