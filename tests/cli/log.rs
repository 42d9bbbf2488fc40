//! Tests of `impactlab fine-tune response --log` with a log of 100 samples of a simulated scaled
//! vehicle.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use impactlab_core::collision::{Pulse, PulseShape};
use impactlab_core::data::{Channel, Existing, TimeSeries, write_series_csv};
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, Controls, Integrator, Manoeuvre, Preset, SteerHistory,
    VehicleParameters, VehicleState, built_in_vehicle,
};
use impactlab_networks::learning::ModelFile;
use impactlab_networks::response::{N_RESIDUAL, ResponseModel, STEP_S, average_error_m, rollout};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use tempfile::TempDir;

use crate::program::{TINY_RESPONSE_NETWORK, TRAJECTORIES, json, ok, program};

const VEHICLE: &str = "scaled-target-100";
const CONTACT_M: &str = "--contact=-0.7,-0.3,0.126";
/// Channels of the log and the standard deviation of their noise: position in m, yaw in rad, yaw
/// rate in rad/s, velocity in m/s.
const NOISE: [(Channel, f64); 6] = [
    (Channel::X, 0.02),
    (Channel::Y, 0.02),
    (Channel::Yaw, 0.008_727),
    (Channel::YawRate, 0.017_453),
    (Channel::Vx, 0.05),
    (Channel::Vy, 0.05),
];
const EFFORT: &str = "\
[single_steps]
epochs = 3

[rollouts]
lengths = [20, 500]
epochs = 2

[effects]
ridge = 0.1
common = 0.99
";

fn truth() -> VehicleParameters {
    let mut vehicle = Preset::ScaledStruck.parameters().with_friction(0.6);
    vehicle.mass.yaw_inertia_kg_m2 *= 1.1;
    vehicle
}

/// Returns a manoeuvre in which a lateral impulse acts on the right rear quarter from `start_s` on.
fn manoeuvre(speed_m_s: f64, impulse_y_n_s: f64, start_s: f64) -> Manoeuvre {
    let pulse = Pulse::new(PulseShape::HalfSine, [10.0, impulse_y_n_s], start_s, 0.09).unwrap();
    let contact = ContactPoint { x_body_m: -0.7, y_body_m: -0.3, height_m: 0.126 };
    let force = pulse.to_history(1e-3).unwrap();
    Manoeuvre {
        initial: VehicleState::driving_straight(speed_m_s),
        contact_load: Some(ContactLoad { force, contact, recorded_moment: false }),
        duration_s: 4.0,
        ..Manoeuvre::default()
    }
}

/// Simulates an impact and writes its log of 100 samples with noise and its force. Returns both
/// paths.
fn write_log(folder: &Path, name: &str, (stride, seed): (usize, u64)) -> [PathBuf; 2] {
    let manoeuvre = manoeuvre(6.0, 90.0, 0.2);
    let motion = truth().simulate(&manoeuvre, Integrator::Rk4).unwrap().series;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let time_s = motion.time_s().iter().copied().step_by(stride).take(100).collect();
    let mut series = TimeSeries::new(time_s).unwrap();
    for (channel, std) in NOISE {
        let exact = motion.get(channel).unwrap().iter().step_by(stride).take(100);
        let noisy = exact.map(|value| value + std * rng.sample::<f64, _>(StandardNormal));
        series.insert(channel, noisy.collect()).unwrap();
    }
    let paths = ["", "_force"].map(|end| folder.join(format!("{name}{end}.csv")));
    write_series_csv(&paths[0], Existing::Replace, &series).unwrap();
    let force = manoeuvre.contact_load.unwrap().force.to_series().unwrap();
    write_series_csv(&paths[1], Existing::Replace, &force).unwrap();
    paths
}

fn fine_tune(folder: &Path) -> Command {
    let config = folder.join("tiny.toml");
    fs::write(&config, [TINY_RESPONSE_NETWORK, EFFORT].concat()).unwrap();
    let mut command = program();
    command.current_dir(folder).args([
        "fine-tune",
        "response",
        "--json",
        "--out",
        "model",
        "--overwrite",
    ]);
    command.arg("--config").arg(&config);
    command
}

fn error(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(!output.status.success());
    String::from_utf8(output.stderr).unwrap()
}

/// Returns the mean errors in other impacts of the same vehicle, of the untuned 4DOF model and of
/// the model in the file, m.
fn errors_m(model: &Path) -> [f64; 2] {
    let model = ResponseModel::load(model).unwrap();
    let data_sheet = Preset::ScaledStruck.parameters();
    let predictor = model.predictor(&data_sheet).unwrap();
    let mut sums = [0.0; 2];
    let next = [(5.0, 110.0), (7.0, 80.0), (6.5, 60.0)];
    for (speed_m_s, impulse_n_s) in next {
        let manoeuvre = manoeuvre(speed_m_s, impulse_n_s, 0.0);
        let inputs = manoeuvre.inputs(STEP_S, 400);
        let drive = |vehicle| rollout(vehicle, manoeuvre.initial, &inputs, [0.0; N_RESIDUAL]);
        let truth = truth();
        let reference = drive(&truth);
        sums[0] += average_error_m(&drive(&data_sheet), &reference);
        sums[1] +=
            average_error_m(&predictor.central_path(&manoeuvre.initial, &inputs), &reference);
    }
    sums.map(|sum| sum / next.len() as f64)
}

#[test]
fn a_log_of_100_samples_makes_the_next_impact_better_known() {
    let folder = TempDir::new().unwrap();
    for (stride, hz, n_states) in [(1, 100, 80), (4, 25, 377)] {
        let [log, force] = write_log(folder.path(), "log", (stride, 1));
        let mut command = fine_tune(folder.path());
        command.arg("--log").arg(&log).arg("--force").arg(&force).args([CONTACT_M, "--vehicle"]);
        let report = json(&ok(command.arg(VEHICLE).output().unwrap()));
        let facts = &report["logs"][0];
        assert_eq!(facts["force"], "recorded", "{hz} Hz");
        assert_eq!(facts["n_samples"], n_states, "{hz} Hz");
        // It is a scaled vehicle: for a car the impulse would be in another unit.
        let is_told = report["caveats"].to_string().contains("log_force.csv: impulse 90.");
        assert!(is_told, "{hz} Hz: {report}");
        let position_m = facts["noise"]["position_m"].as_f64().unwrap();
        assert!((0.015..0.026).contains(&position_m), "{hz} Hz: {position_m}");
        assert_eq!(report["train"], serde_json::json!(["log"]));
        assert_eq!((&report["latents"]["n_calibrated"], &report["n_test"]), (&0.into(), &0.into()));
        let [untuned_m, tuned_m] = errors_m(&folder.path().join("model"));
        assert!(tuned_m < 0.7 * untuned_m, "{hz} Hz: {tuned_m} of {untuned_m}");
    }
}

#[test]
fn without_a_force_the_impulse_is_estimated_and_two_logs_are_calibrated_on() {
    let folder = TempDir::new().unwrap();
    let logs = folder.path().join("logs");
    fs::create_dir(&logs).unwrap();
    for seed in [1, 2] {
        let [_, force] = write_log(&logs, &format!("log_{seed}"), (1, seed));
        fs::remove_file(force).unwrap();
    }
    let mut command = fine_tune(folder.path());
    let report =
        json(&ok(command.args(["--vehicle", VEHICLE, "--log"]).arg(&logs).output().unwrap()));
    assert_eq!(report["train"], serde_json::json!(["log_1", "log_2"]));
    assert_eq!(
        (&report["latents"]["n_calibrated"], &report["keeps_latents"]),
        (&2.into(), &false.into())
    );
    let is_of_force = |caveat: &&serde_json::Value| {
        caveat["reason"].as_str().is_some_and(|reason| reason.contains("log_1.csv has no force"))
    };
    let of_force = report["caveats"].as_array().unwrap().iter().find(is_of_force).unwrap();
    // What is estimated is not told to seventeen digits.
    let impulse = of_force["text"].as_str().unwrap().split(' ').next().unwrap();
    assert!(impulse.len() <= 5, "{of_force}");
    for facts in report["logs"].as_array().unwrap() {
        assert_eq!(facts["force"], "estimated");
        let impulse_n_s = facts["impulse_n_s"][1].as_f64().unwrap();
        assert!((70.0..110.0).contains(&impulse_n_s), "{facts}");
    }
    // With a single log, a model that was calibrated keeps its uncertainty, but no scale falls
    // below its default.
    let start = folder.path().join("start");
    fs::rename(folder.path().join("model"), &start).unwrap();
    let mut command = fine_tune(folder.path());
    command.args(["--vehicle", VEHICLE, "--log"]).arg(logs.join("log_1.csv"));
    let report = json(&ok(command.arg("--model").arg(&start).output().unwrap()));
    assert_eq!(
        (&report["latents"]["n_calibrated"], &report["keeps_latents"]),
        (&0.into(), &true.into())
    );
    for (scale, usual) in
        report["latents"]["scales"].as_array().unwrap().iter().zip([0.02, 0.01, 0.02, 0.02])
    {
        assert!(scale.as_f64().unwrap() >= usual, "{report}");
    }
}

#[test]
fn what_is_wrong_with_a_log_is_said_with_its_place() {
    let folder = TempDir::new().unwrap();
    let [log, force] = write_log(folder.path(), "log", (1, 1));
    let with = |text: &str| {
        let path = folder.path().join("bad.csv");
        fs::write(&path, text).unwrap();
        error(fine_tune(folder.path()).args(["--vehicle", VEHICLE, "--log"]).arg(path))
    };
    let text = with("t [s],x [m],y [m]\n0,0,0\n0.01,0.1,0\n");
    assert!(text.contains("bad.csv:1: no column for time, x, y and yaw"), "{text}");
    let text = with("t [s],x [m],y [m],yaw [deg]\n0,0,0,0\n0.01,0.1,n/a,0\n");
    assert!(text.contains("bad.csv:3:3: ") && text.contains("n/a"), "{text}");
    let mut command = fine_tune(folder.path());
    command.args(["--vehicle", VEHICLE, "--log"]).arg(&log).arg("--force").arg(&force);
    let text = error(&mut command);
    assert!(text.contains("log_force.csv: has no yaw moment"), "{text}");
    let text = error(command.arg("--force").arg(&force));
    assert!(text.contains("2 force files for 1 logs"), "{text}");
    let text = error(fine_tune(folder.path()).arg("--log").arg(&log));
    assert!(text.contains("--vehicle"), "{text}");
    let both = ["--vehicle", VEHICLE, "--data", TRAJECTORIES, "--log"];
    let text = error(fine_tune(folder.path()).args(both).arg(&log));
    assert!(text.contains("cannot be used with"), "{text}");
}

/// A test drive has no impact to look for, and is steered by the column that says how.
#[test]
fn a_test_drive_is_learned_from_with_its_steering_and_without_a_force() {
    let folder = TempDir::new().unwrap();
    let amplitude_rad = 0.03;
    let time_s: Vec<f64> = (0..=400).map(|i| f64::from(i) * 0.01).collect();
    let steer_rad: Vec<f64> = time_s.iter().map(|t| amplitude_rad * (3.0 * t).sin()).collect();
    let steer = SteerHistory { time_s, steer_rad };
    let manoeuvre = Manoeuvre {
        initial: VehicleState::driving_straight(15.0),
        controls: Controls { steer: Some(steer), ..Controls::default() },
        duration_s: 4.0,
        ..Manoeuvre::default()
    };
    let car = built_in_vehicle("toyota-camry-2018").unwrap();
    let motion = car.simulate(&manoeuvre, Integrator::Rk4).unwrap().series;
    let mut series = TimeSeries::new(motion.time_s().to_vec()).unwrap();
    for channel in [Channel::X, Channel::Y, Channel::Yaw, Channel::YawRate] {
        series.insert(channel, motion.get(channel).unwrap().to_vec()).unwrap();
    }
    let straight = folder.path().join("straight.csv");
    write_series_csv(&straight, Existing::Refuse, &series).unwrap();
    let angles = motion.time_s().iter().map(|t| 15.0 * amplitude_rad * (3.0 * t).sin());
    series.insert(Channel::SteeringWheel, angles.collect()).unwrap();
    let drive = folder.path().join("drive.csv");
    write_series_csv(&drive, Existing::Refuse, &series).unwrap();

    let condition = |log: &Path, more: &[&str]| {
        let mut command = program();
        command.current_dir(folder.path()).args([
            "condition",
            "response",
            "--json",
            "--out",
            "model",
        ]);
        command
            .args(["--overwrite", "--vehicle", "toyota-camry-2018", "--log"])
            .arg(log)
            .args(more);
        command
    };
    let text = error(&mut condition(&drive, &["--no-impact"]));
    assert!(text.contains("drive.csv") && text.contains("--steering-ratio"), "{text}");
    let report = |log: &Path, more: &[&str]| json(&ok(condition(log, more).output().unwrap()));
    let known = report(&drive, &["--no-impact", "--steering-ratio", "15"]);
    assert_eq!(
        (&known["logs"][0]["force"], &known["logs"][0]["n_samples"]),
        (&"none".into(), &401.into())
    );
    for part in ["has no steering", "has no force"] {
        assert!(!known["caveats"].to_string().contains(part), "{known}");
    }
    // What steers the car is not found in the motion: it is said that nothing was taken to.
    let unknown = report(&straight, &["--no-impact"]);
    assert!(unknown["caveats"].to_string().contains("straight.csv has no steering"), "{unknown}");
    // Neither steering that turns the wheels ten times as far nor a blow goes by without a word.
    let unexplained = "the path in drive.csv is on average";
    assert!(!known["caveats"].to_string().contains(unexplained), "{known}");
    let wrong = report(&drive, &["--no-impact", "--steering-ratio", "1.5"]);
    assert!(wrong["caveats"].to_string().contains(unexplained), "{wrong}");
    // How one wheel is turned does not say it of both, nor that it is the steering wheel.
    let text = fs::read_to_string(&drive).unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let (names, _) = header.rsplit_once(',').unwrap();
    let one = folder.path().join("one.csv");
    fs::write(&one, format!("{names},steer_fl [rad]\n{rows}")).unwrap();
    let text = error(&mut condition(&one, &["--no-impact"]));
    assert!(text.contains("one.csv") && text.contains("steer_fr"), "{text}");
    let both = error(&mut condition(&drive, &["--no-impact", "--impact", "1"]));
    assert!(both.contains("cannot be used with"), "{both}");
}

/// A log in which a car was struck, told to be a test drive, taught the network that the car turns by itself.
#[test]
fn a_blow_in_what_is_said_to_be_a_test_drive_is_told() {
    let folder = TempDir::new().unwrap();
    let [log, _] = write_log(folder.path(), "struck", (4, 1));
    let mut command = program();
    command.current_dir(folder.path()).args(["condition", "response", "--json", "--out", "model"]);
    command.args(["--vehicle", VEHICLE, "--no-impact", "--log"]).arg(&log);
    let report = json(&ok(command.output().unwrap()));
    assert!(report["caveats"].to_string().contains("is on average"), "{report}");
}
