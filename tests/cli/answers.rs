//! Answers that must not be wrong without a word: each test is a command whose answer was.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::ops::ControlFlow;
use std::path::PathBuf;

use impactlab_study::{CompareRequest, ConfigChoice, Event, Library, ModelChoice, Question};
use serde_json::Value;
use tempfile::TempDir;

use crate::program::{SCENARIO, TINY_RESPONSE_NETWORK, TRAJECTORIES, answer, ok, program, text};

/// Runs the program and returns its one line of error, after checking that it failed.
pub(crate) fn refusal(args: &[&str]) -> String {
    let output = program().args(args).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    let lines: Vec<&str> = text.lines().collect();
    let [line] = lines[..] else { panic!("expected one line: {text}") };
    line.to_owned()
}

pub(crate) fn write(folder: &TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    path
}

/// The example scenario with a line of it replaced.
pub(crate) fn scenario_with(folder: &TempDir, name: &str, old: &str, new: &str) -> PathBuf {
    let scenario = fs::read_to_string(SCENARIO).unwrap();
    assert!(scenario.contains(old), "{old}");
    write(folder, name, &scenario.replacen(old, new, 1))
}

fn not_used(report: &Value) -> Vec<String> {
    let assumptions = report["assumptions"].as_array().unwrap().iter();
    let unused = assumptions.filter(|of| of["quantity"] == "not_used");
    unused.map(|of| of["value"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn a_parked_car_that_is_struck_moves_before_it_is_at_rest() {
    let folder = TempDir::new().unwrap();
    let parked = scenario_with(&folder, "parked.toml", "speed_km_h = 54", "speed_km_h = 0");
    let out = folder.path().join("out");
    for force in [&["--given-force"][..], &["--draws", "3"]] {
        let args = ["predict", "--scenario", text(&parked), "--overwrite", "--out", text(&out)];
        let outcome = &answer(&[&args[..], force].concat())["outcome"];
        let number = |key: &str| outcome[key].as_f64().unwrap();
        assert!(number("time_s") > 0.5, "{force:?}: {outcome}");
        if outcome["is_at_rest"] == true {
            assert!(number("speed_m_s") < 0.3 && number("yaw_rate_rad_s") < 0.1, "{outcome}");
        } else {
            assert_eq!(number("time_s"), 4.0, "{outcome}");
        }
        let [x, y] = ["x_m", "y_m"].map(|key| outcome[key]["median"].as_f64().unwrap());
        assert!(x.hypot(y) > 0.3, "{force:?}: moved by {x}, {y} m");
    }
}

#[test]
fn a_vehicle_that_still_rolls_at_the_end_is_said_to_move() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let args =
        ["predict", "--scenario", SCENARIO, "--given-force", "--duration", "0.5", "--overwrite"];
    let output = program().args(args).arg("--out").arg(&out).output().unwrap();
    let printed = ok(output);
    assert!(printed.contains("still moving after") && printed.contains(" 0.5 s"), "{printed}");
    assert_eq!(
        answer(&[&args[..], &["--out", text(&out)]].concat())["outcome"]["is_at_rest"],
        false
    );
}

/// Under a locked steering a car rolls in circles: it is followed to the limit and no further, and that it still
/// moves is said once.
#[test]
fn a_car_that_rolls_in_circles_is_followed_to_the_limit_and_no_further() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let few = ["--draws", "2", "--vehicle-draws", "2", "--steer-angle", "5deg"];
    let args = ["predict", "--scenario", SCENARIO, "--until-rest", "--duration", "2", "--out"];
    let report = answer(&[&args[..], &[text(&out)], &few].concat());
    assert_eq!(report["rest"]["limit_s"], 2.0, "{}", report["rest"]);
    assert_eq!(report["rest"]["share_at_rest"], 0.0, "{}", report["rest"]);
    let badges = report["badges"].as_array().unwrap();
    let n_moving = badges.iter().filter(|badge| badge["kind"] == "not_at_rest").count();
    assert_eq!(n_moving, 1, "{badges:?}");
    let motion = fs::read_to_string(out.join("trajectory.csv")).unwrap();
    let end_s: f64 = motion.lines().last().unwrap().split(',').next().unwrap().parse().unwrap();
    assert!((end_s - 2.0).abs() < 0.011, "{end_s}");
}

/// The record of a case stood nowhere beside what methods say of its force.
#[test]
fn five_questions_come_first_and_the_record_stands_beside_both_methods() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let case = ["predict", "--dataset", "datasets/fea", "--case", "c001", "--vehicle-draws", "0"];
    let args = [&case[..], &["--out", text(&out)]].concat();
    let printed = ok(program().args(&args).output().unwrap());
    let at = |text: &str| printed.find(text).unwrap_or_else(|| panic!("{text} in {printed}"));
    let questions = [
        "Will it spin?",
        "Where does it stop?",
        "Does it cross into the next lane?",
        "How sure is that?",
        "What would change it?",
        "The answer in numbers",
        "Force of the first contact by each method",
    ];
    assert!(questions.map(at).is_sorted(), "{printed}");
    let table = &printed[at("Force of the first contact by each method")..];
    let header = table.lines().nth(1).unwrap();
    for column in ["force network", "momentum solution", "record"] {
        assert!(header.contains(column), "{header}");
    }
    let report = answer(&[&args[..], &["--overwrite"]].concat());
    assert!(report["recorded"]["force"]["peak_n"].as_f64().unwrap() > 1e4, "{report}");
    assert!(report["impulses"]["network_peak_n"]["median"].is_number(), "{report}");
}

#[test]
fn a_force_outside_the_time_of_the_motion_is_refused_by_every_question() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let force = |name: &str, shift_s: f64| {
        let rows = [(0.0, 0.0), (0.05, 4e4), (0.1, 0.0)];
        let rows = rows.map(|(t, fy)| format!("{},0,{fy},{}\n", t + shift_s, -1.5 * fy));
        write(&folder, name, &format!("time_s,fx_n,fy_n,mz_n_m\n{}", rows.concat()))
    };
    for (name, shift_s) in [("early.csv", -0.05), ("late.csv", 3.95), ("outside.csv", 7.0)] {
        let force = force(name, shift_s);
        let scenario = ["predict", "--scenario", SCENARIO, "--out", text(&out)];
        let record = "datasets/trajectories-fea/trajectories/FE_c001.csv";
        let trajectory = ["predict", "--trajectory", record, "--out", text(&out)];
        let case = ["predict", "--dataset", "datasets/fea", "--case", "c001", "--out", text(&out)];
        for question in [&["simulate"][..], &scenario, &trajectory, &case] {
            let line = refusal(&[question, &["--force", text(&force)]].concat());
            assert!(line.contains(&format!("{name}: contact from ")), "{question:?}: {line}");
        }
    }
    // A drawn force that goes on after the end of the forecast is none of that motion either.
    let args = ["predict", "--scenario", SCENARIO, "--duration", "0.1", "--out", text(&out)];
    assert!(refusal(&args).contains("contact from 0"));
    assert!(!out.join("trajectory.csv").exists(), "nothing is written");
}

#[test]
fn a_recording_on_another_clock_is_not_simulated_from_zero() {
    let folder = TempDir::new().unwrap();
    let recorded =
        fs::read_to_string("datasets/trajectories-fea/trajectories/FE_c001.csv").unwrap();
    let later = recorded.lines().enumerate().map(|(i, line)| match line.split_once(',') {
        Some((time, rest)) if i > 0 => format!("{},{rest}\n", time.parse::<f64>().unwrap() + 10.0),
        _ => format!("{line}\n"),
    });
    let later = write(&folder, "later.csv", &later.collect::<String>());
    for question in [&["simulate"][..], &["predict", "--out", text(folder.path())]] {
        let args = [question, &["--trajectory", text(&later)]].concat();
        let output = program().args(&args).output().unwrap();
        let line = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success(), "{args:?}");
        assert!(line.contains("later.csv") && line.contains("starts at 10 s"), "{line}");
    }
}

#[test]
fn a_recording_without_rates_says_with_which_it_is_simulated() {
    let folder = TempDir::new().unwrap();
    let recorded =
        fs::read_to_string("datasets/trajectories-fea/trajectories/FE_c001.csv").unwrap();
    let bare = recorded.replacen("yaw_rate_rad_s", "comment", 1);
    let bare = bare.lines().map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let others = cells.iter().enumerate().filter(|(i, _)| *i != 7).map(|(_, cell)| *cell);
        format!("{}\n", others.collect::<Vec<_>>().join(","))
    });
    let bare = write(&folder, "bare.csv", &bare.collect::<String>());
    let report = answer(&["simulate", "--trajectory", text(&bare)]);
    let printed = report["assumptions"].to_string();
    assert!(printed.contains("start_of_record") && printed.contains("Yaw rate r = 0"), "{printed}");
}

#[test]
fn what_the_force_network_does_not_know_is_said() {
    let folder = TempDir::new().unwrap();
    // The example gives its own restitution and friction, which the momentum solution alone uses.
    let of_example = not_used(&answer(&["predict", "force", "--scenario", SCENARIO]));
    assert_eq!(of_example, ["restitution, 0.15", "friction limit, 0.4"]);
    let hard = scenario_with(&folder, "hard.toml", "restitution = 0.15", "restitution = 0.5");
    let truck = scenario_with(&folder, "truck.toml", "length_m = 4.9", "length_m = 9");
    let out = folder.path().join("out");
    for (scenario, unused) in [(&hard, "restitution, 0.5"), (&truck, "size of the struck vehicle")]
    {
        let of_force = answer(&["predict", "force", "--scenario", text(scenario)]);
        let motion = ["predict", "--draws", "2", "--scenario", text(scenario), "--out", text(&out)];
        let motion = [&motion[..], &["--overwrite"]].concat();
        for report in [of_force, answer(&motion)] {
            assert!(not_used(&report).iter().any(|of| of.starts_with(unused)), "{report}");
        }
        // The momentum solution depends on the restitution, the simulation on nothing of the size.
        let simulated = answer(&["simulate", "--scenario", text(scenario)]);
        assert_eq!(not_used(&simulated), [] as [&str; 0]);
    }
}

/// The network fades where turning moves the points of contact; the physics about it knows yaw rates.
#[test]
fn a_vehicle_that_turns_before_the_impact_is_outside_of_what_the_force_network_knows() {
    let folder = TempDir::new().unwrap();
    let turning = |rate: &str| {
        let with = format!("speed_km_h = 54\nyaw_rate_deg_s = {rate}");
        scenario_with(&folder, &format!("turning{rate}.toml"), "speed_km_h = 54", &with)
    };
    let force = |rate: &str| answer(&["predict", "force", "--scenario", text(&turning(rate))]);
    let share = |report: &Value| report["applicability"].as_f64().unwrap();
    let [still, slow, spinning] = ["0", "70", "200"].map(force);
    assert!(share(&still) >= share(&slow) && share(&slow) > share(&spinning), "{slow}");
    assert_eq!(share(&spinning), 0.0, "{spinning}");
    for report in [&slow, &spinning] {
        let outside = report["outside_training"].to_string();
        assert!(outside.contains("yaw rate of the str"), "{outside}");
    }
    // What is left is the momentum solution of turning vehicles.
    let impulse = |report: &Value| report["impulse_n_s"]["y"]["median"].as_f64();
    assert!(impulse(&spinning) != impulse(&still), "{spinning}");
    let out = folder.path().join("out");
    let spinning = turning("200");
    let predict = ["predict", "--scenario", text(&spinning), "--draws", "8", "--out", text(&out)];
    let by_law = answer(&predict);
    assert_eq!(by_law["contacts"]["n_known_forces"], 0);
    assert!(by_law["badges"].to_string().contains("yaw rate of the str"), "{by_law}");
    let given = answer(&[&predict[..], &["--given-force", "--overwrite"]].concat());
    assert!(given["outcome"].is_object() && given["contacts"]["n_known_forces"] == 8, "{given}");
}

#[test]
fn what_was_said_for_another_question_is_not_used() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let record = "datasets/trajectories-fea/trajectories/FE_c001.csv";
    let args = ["predict", "--trajectory", record, "--duration", "9", "--draws", "7"];
    let unused = not_used(&answer(&[&args[..], &["--out", text(&out)]].concat()));
    assert_eq!(unused, ["duration, 9 s", "number of drawn forces, 7"]);
}

#[test]
fn a_vehicle_that_cannot_be_is_refused_with_its_place() {
    let folder = TempDir::new().unwrap();
    let reference = fs::read_to_string("assets/vehicles/reference-2000.toml").unwrap();
    let record = fs::read_to_string("datasets/trajectories-fea/vehicle.toml").unwrap();
    for (name, vehicle, old, new, expected) in [
        (
            "light.toml",
            &reference,
            "yaw_inertia_kg_m2 = 3961.6",
            "yaw_inertia_kg_m2 = 20",
            ":7:21: ",
        ),
        ("tall.toml", &reference, "roll_arm_m = 0.454446", "roll_arm_m = 2.9", ":8:22: "),
        (
            "record.toml",
            &record,
            "total = 2000.0",
            "total = -2000.0",
            ":6:9: mass.total is -2000.0",
        ),
    ] {
        assert!(vehicle.contains(old));
        let path = write(&folder, name, &vehicle.replacen(old, new, 1));
        let line = refusal(&["simulate", "--speed", "10", "--vehicle", text(&path)]);
        assert!(line.contains(&format!("{name}{expected}")), "{line}");
    }
}

#[test]
fn a_recorded_motion_with_one_component_of_its_force_is_refused() {
    let folder = TempDir::new().unwrap();
    let half = "time_s,x_m,y_m,yaw_rad,vx_m_s,vy_m_s,fx_n\n0,0,0,0,10,0,5\n0.01,0.1,0,0,10,0,5\n\
                0.02,0.2,0,0,10,0,0\n";
    let half = write(&folder, "half.csv", half);
    let output = program().args(["simulate", "--trajectory", text(&half)]).output().unwrap();
    let line = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && line.contains("half.csv"), "{line}");
    assert!(line.contains("fy_n"), "{line}");
}

/// A comparison, and how often a training has told something before the answer.
fn compare(request: &CompareRequest) -> (Result<(), String>, usize) {
    let mut n_trained = 0;
    let mut observer = |event: Event<'_>| {
        let is_training = match event {
            Event::Training(_) => true,
            Event::Progress(progress) => progress.message.contains("train"),
            Event::Sampling(_) => false,
        };
        n_trained += usize::from(is_training);
        ControlFlow::Continue(())
    };
    let answer = request.answer(&Library::default(), &mut observer);
    (answer.map(|_| ()).map_err(|error| impactlab_core::error_chain(&error)), n_trained)
}

#[test]
fn a_comparison_that_must_fail_fails_before_it_trains() {
    let folder = TempDir::new().unwrap();
    let request = CompareRequest::new(TRAJECTORIES);
    let many = CompareRequest { trajectories: vec![5, 99_999], ..request.clone() };
    let (answer, n_trained) = compare(&many);
    let error = answer.unwrap_err();
    assert!(error.contains("99999"), "{error}");
    assert_eq!(n_trained, 0, "{error}");

    let other_layers = write(&folder, "other.toml", TINY_RESPONSE_NETWORK);
    let model = Some(ModelChoice::default());
    let config = ConfigChoice::File(other_layers);
    let (answer, n_trained) = compare(&CompareRequest { model, config, ..request });
    assert!(answer.is_err());
    assert_eq!(n_trained, 0, "{answer:?}");
}
