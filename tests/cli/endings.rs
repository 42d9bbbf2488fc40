//! Endings from the command line: brakes, dragged and locked wheels, rest.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;

use crate::program::{answer, ok, program, text};

/// The error of a command that is refused.
fn refusal(args: &[&str]) -> String {
    let output = program().args(args).output().unwrap();
    assert!(!output.status.success(), "{args:?}");
    String::from_utf8(output.stderr).unwrap()
}

const STRAIGHT: [&str; 5] = ["simulate", "--vehicle", "reference-2000", "--speed", "20"];

#[test]
fn a_car_that_brakes_comes_to_rest_and_the_report_says_where() {
    let args = [&STRAIGHT[..], &["--brake", "1.5", "--brake-start", "1s", "--until-rest"]].concat();
    let stop = answer(&args);
    let rest = &stop["rest"];
    let number = |key: &str| rest[key].as_f64().unwrap();
    // 20 m, what it rolls while the brakes rise, and 20²/(2 · 0.8 · 0.8 g).
    assert!((50.0..58.0).contains(&number("distance_m")), "{rest}");
    assert!((number("time_s") - stop["duration_s"].as_f64().unwrap()).abs() < 0.2, "{stop}");
    let output = program().args(&args).output().unwrap();
    assert!(ok(output).contains("at rest"), "said to a person");
    let coasting = answer(&STRAIGHT);
    assert!(coasting["rest"].is_null() && coasting["duration_s"] == 4.0, "{coasting}");
}

#[test]
fn a_locked_wheel_and_a_scenario_that_brakes_change_the_path_and_coast_undoes_it() {
    let y = |args: &[&str]| answer(args)["end"]["y_m"].as_f64().unwrap();
    assert!(y(&[&STRAIGHT[..], &["--locked", "rear-left"]].concat()) > 0.05);
    assert!(y(&[&STRAIGHT[..], &["--dragged", "front-right=0.5"]].concat()) < -0.05);

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("braked.toml");
    let pit = fs::read_to_string("assets/scenarios/pit_right_rear.toml").unwrap();
    fs::write(&path, pit + "\n[ending]\nbrake_start_s = 0.5\nbrake_share = 0.9\n").unwrap();
    let with = |extra: &[&str]| {
        let args = ["simulate", "--scenario", text(&path), "--duration", "6"];
        answer(&[&args[..], extra].concat())
    };
    let (braked, coasting) = (with(&[]), with(&["--coast"]));
    assert!(braked["rest"].is_object() && coasting["rest"].is_null(), "{braked} {coasting}");
    let plain = answer(&["simulate", "--scenario", "pit-right-rear", "--duration", "6"]);
    assert_eq!(coasting["end"], plain["end"]);
}

#[test]
fn systems_and_drivers_are_said_by_options_or_by_the_scenario() {
    let stop = |extra: &[&str]| {
        answer(&[&STRAIGHT[..], &["--brake", "1.5", "--until-rest"], extra].concat())
    };
    let [locked, held, esc] = [stop(&[]), stop(&["--abs"]), stop(&["--esc"])];
    let marked_m = |stop: &serde_json::Value| -> f64 {
        let marks = stop["tyre_marks"].as_array().unwrap();
        marks.iter().map(|mark| mark["length_m"].as_f64().unwrap()).sum()
    };
    // The wheels lock for the last decimetres alone.
    assert!(marked_m(&locked) > 60.0 && marked_m(&held) < 2.0, "{locked} {held}");
    assert_eq!(held["end"], esc["end"], "a stability control has an anti-lock system");
    assert!(refusal(&[&STRAIGHT[..], &["--abs"]].concat()).contains("--brake"));
    assert!(refusal(&[&STRAIGHT[..], &["--coast", "--esc"]].concat()).contains("--esc"));

    let yaw = |extra: &[&str]| {
        let spun = [&STRAIGHT[..], &["--yaw-rate", "40deg/s"], extra].concat();
        answer(&spun)["end"]["yaw_rad"].as_f64().unwrap()
    };
    let [alone, steered] = [yaw(&[]), yaw(&["--countersteer", "0.3"])];
    assert!((steered - alone).abs() > 0.01, "{steered} {alone}");
    assert!((yaw(&["--countersteer"]) - yaw(&["--countersteer", "0.8s"])).abs() < 1e-12);

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("esc.toml");
    let pit = fs::read_to_string("assets/scenarios/pit_right_rear.toml").unwrap();
    let with = |sections: &str| {
        fs::write(&path, format!("{pit}\n{sections}")).unwrap();
        answer(&["simulate", "--scenario", text(&path), "--duration", "6"])
    };
    let plain = with("");
    let esc = with("[ending]\nesc = true\n");
    assert_ne!(plain["end"], esc["end"]);
    let pushing = with("[bullet_ending]\npit = \"brake\"\npit_longest_s = 1\n");
    assert_ne!(plain["end"], pushing["end"], "the striking driver pushes the struck car");
    fs::write(&path, format!("{pit}\n[ending]\nesc_rise_s = 0.2\n")).unwrap();
    assert!(refusal(&["simulate", "--scenario", text(&path)]).contains("esc is missing"));
}

#[test]
fn a_locked_stop_tells_its_four_marks_and_a_rolling_car_none() {
    let stop = answer(&[&STRAIGHT[..], &["--brake", "1.5", "--until-rest"]].concat());
    let marks = stop["tyre_marks"].as_array().unwrap();
    assert_eq!(marks.len(), 4, "{stop}");
    let end = stop["rest"]["time_s"].as_f64().unwrap();
    for mark in marks {
        assert_eq!((&mark["vehicle"], &mark["kind"]), (&"struck".into(), &"locked".into()));
        let number = |key: &str| mark[key].as_f64().unwrap();
        let x = |key: &str| mark[key][0].as_f64().unwrap();
        // The brake rises over 0.3 s, and asks for more than the road holds from about 0.2 s on.
        assert!((0.1..0.3).contains(&number("from_s")), "{mark}");
        assert!((end - number("to_s")).abs() < 0.3, "{mark}");
        assert!((number("length_m") - (x("end_m") - x("start_m"))).abs() < 1e-6, "{mark}");
        // 20²/(2 · 0.8 · 0.8 g), the sliding friction of dry asphalt, a bit less where it is slower.
        assert!((26.0..34.0).contains(&number("length_m")), "{mark}");
    }
    let shown = ok(program().args(STRAIGHT).args(["--brake", "1.5"]).output().unwrap());
    assert!(
        shown.contains("Tire marks that the simulation leaves")
            && shown.contains("struck, rear left")
    );
    assert_eq!(answer(&STRAIGHT)["tyre_marks"], serde_json::json!([]));
}

#[test]
fn steering_and_drive_are_said_by_options_and_by_the_scenario() {
    let end = |args: &[&str], key: &str| {
        answer(&[&STRAIGHT[..], args].concat())["end"][key].as_f64().unwrap()
    };
    // The steering wheel over its ratio is the road wheel.
    let (of_wheel, of_road_wheel) = (
        end(&["--steering-wheel", "48deg", "--steering-ratio", "16"], "y_m"),
        end(&["--steer-angle", "3deg"], "y_m"),
    );
    assert!(of_wheel > 5.0 && (of_wheel - of_road_wheel).abs() < 1e-9, "{of_wheel}");
    let later = end(&["--steer-angle", "3deg", "--steer-start", "2"], "y_m");
    assert!(later > 0.1 && later < 0.5 * of_wheel, "{later}");
    // 2000 N m at wheels of 0.3 m, 2000 kg: some 3.3 m/s² over 4 s.
    let (rolls, driven) = (end(&[], "vx_m_s"), end(&["--drive-torque", "2000"], "vx_m_s"));
    assert!((8.0..16.0).contains(&(driven - rolls)), "{rolls} {driven}");
    let both = end(&["--drive-torque", "1000", "--driven", "all"], "vx_m_s");
    assert!((both - driven).abs() < 0.1, "{driven} {both}: the torque is that of each axle");

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("driven.toml");
    let pit = fs::read_to_string("assets/scenarios/pit_right_rear.toml").unwrap();
    let ending = "\n[ending]\ndrive_torque_n_m = 2000\ndrive_axle = \"rear\"\n";
    fs::write(&path, pit + ending).unwrap();
    let distance = |args: &[&str]| answer(args)["distance_m"].as_f64().unwrap();
    let scenario = ["simulate", "--scenario", text(&path)];
    let coasts = distance(&[&scenario[..], &["--coast"]].concat());
    assert!((distance(&scenario) - coasts).abs() > 0.5, "{coasts}");
}

/// Steering of the rollover test needed a file made by hand.
#[test]
fn an_ordinary_vehicle_steers_the_fishhook_of_the_nhtsa() {
    let fishhook = |vehicle: &str, args: &[&str]| {
        let of = ["simulate", "--fishhook", "--duration", "7", "--vehicle", vehicle];
        answer(&[&of[..], args].concat())
    };
    let fast = fishhook("ford-explorer-2004", &["--speed", "45mph"]);
    let slow = fishhook("ford-explorer-2004", &["--speed", "20mph"]);
    // To the left first, then a tighter turn to the right.
    assert!(fast["end"]["yaw_rad"].as_f64().unwrap() < -1.0, "{fast}");
    assert!(fast["uncertainty"]["n_failed"] == 0, "{fast}");
    let assumed = |report: &serde_json::Value| report["assumptions"].to_string();
    assert!(assumed(&fast).contains("ratio 16"), "{fast}");
    let with_ratio =
        fishhook("ford-explorer-2004", &["--speed", "45mph", "--steering-ratio", "18"]);
    assert!(!assumed(&with_ratio).contains("ratio 16"), "{with_ratio}");
    let lifts = |report: &serde_json::Value| report["flags"].to_string().contains("wheel_lift");
    assert!(!lifts(&slow), "{slow}");
    for vehicle in ["toyota-camry-2018", "generic-van", "reference-2000"] {
        let report = fishhook(vehicle, &["--speed", "35mph"]);
        assert!(report["distance_m"].as_f64().unwrap() > 30.0, "{vehicle}: {report}");
    }
    let message = refusal(&[&STRAIGHT[..], &["--fishhook", "--steer-angle", "3deg"]].concat());
    assert!(message.contains("cannot be used with"), "{message}");
}

#[test]
fn files_of_steering_wheel_and_torques_steer_and_brake() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path
    };
    let steer = |header: &str, full: f64, args: &[&str]| {
        let path = file("steer.csv", &format!("time_s,{header}\n0,0\n1,{full}\n4,{full}\n"));
        program().args(STRAIGHT).args(["--steer", text(&path), "--json"]).args(args).output()
    };
    let y_m = |output: std::io::Result<std::process::Output>| -> f64 {
        let report: serde_json::Value = serde_json::from_str(&ok(output.unwrap())).unwrap();
        report["end"]["y_m"].as_f64().unwrap()
    };
    let of_road_wheels = y_m(steer("steer_deg", 3.0, &[]));
    let of_steering_wheel = y_m(steer("steering_wheel_deg", 48.0, &["--steering-ratio", "16"]));
    assert!((of_road_wheels - of_steering_wheel).abs() < 1e-9, "{of_road_wheels}");
    for (header, full, args, expected) in [
        ("steering_wheel_deg", 48.0, &[][..], "say the steering ratio (--steering-ratio"),
        ("steer_deg", 3.0, &["--steering-ratio", "16"], "holds angles of the road wheels"),
        ("steering_wheel_deg", 720.0, &["--steering-ratio", "2"], "steer angle is 6.283185 rad"),
        ("steer_deg", 270.0, &[], "--steer-map \"steering_wheel=2:deg\""),
    ] {
        let output = steer(header, full, args).unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success() && message.contains(expected), "{header}: {message}");
    }

    // 4 · 600 N m over the rolling radius brake 2000 kg.
    let header = "time_s,brake_fl_nm,brake_fr_nm,brake_rl_nm,brake_rr_nm";
    let brakes = file("brakes.csv", &format!("{header}\n0,600,600,600,600\n9,600,600,600,600\n"));
    let stop = answer(&[&STRAIGHT[..], &["--wheels", text(&brakes), "--until-rest"]].concat());
    let vehicle = impactlab_core::vehicle::Preset::Reference.parameters();
    let deceleration = 4.0 * 600.0 / vehicle.tires.rolling_radius_m / vehicle.mass.mass_kg;
    let (expected_m, got_m) =
        (20.0 * 20.0 / (2.0 * deceleration), stop["rest"]["distance_m"].as_f64().unwrap());
    // Rolling resistance and drag help.
    assert!(got_m < expected_m && got_m > 0.9 * expected_m, "{expected_m} {got_m}");
    let drive = file("drive.csv", "time_s,drive_rl_nm,drive_rr_nm\n0,300,300\n4,300,300\n");
    let driven = answer(&[&STRAIGHT[..], &["--wheels", text(&drive)]].concat());
    assert!(driven["end"]["vx_m_s"].as_f64().unwrap() > 22.0, "{driven}");
    let message =
        refusal(&[&STRAIGHT[..], &["--wheels", text(&brakes), "--brake", "0.5"]].concat());
    assert!(message.contains("more than one of file, fishhook and ending brake"), "{message}");
    let negative = file("negative.csv", "time_s,brake_fl_nm\n0,-5\n1,0\n");
    let message = refusal(&[&STRAIGHT[..], &["--wheels", text(&negative)]].concat());
    assert!(
        message.contains("negative.csv:2:2") && message.contains("torque of the brake"),
        "{message}"
    );
}

/// The numbers of an ending that a question holds were not checked where a scenario holds them.
#[test]
fn an_ending_in_a_question_is_checked() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("question.json");
    let args = ["simulate", "--scenario", "pit-right-rear", "--print-request"];
    let printed_request = ok(program().args(args).output().unwrap());
    let mut question: serde_json::Value = serde_json::from_str(&printed_request).unwrap();
    let toml = fs::read_to_string("assets/scenarios/pit_right_rear.toml").unwrap();
    let file = std::path::Path::new("pit.toml");
    let scenario = impactlab_core::collision::Scenario::from_toml(&toml, file).unwrap();
    let mut scenario = serde_json::to_value(scenario).unwrap();
    scenario["bullet_ending"] = serde_json::json!({
        "brake": {"start_s": 0.1, "share_of_friction": -5.0, "rise_s": 0.3}
    });
    question["source"]["scenario"]["scenario"] = serde_json::json!({"inline": scenario});
    fs::write(&path, question.to_string()).unwrap();
    let message = refusal(&["ask", text(&path)]);
    assert!(message.contains("bullet_ending.brake.share_of_friction: braking is -5"), "{message}");
}

#[test]
fn a_forecast_of_a_braked_car_is_not_that_of_one_that_coasts() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("braked.toml");
    let pit = fs::read_to_string("assets/scenarios/pit_right_rear.toml").unwrap();
    fs::write(&path, pit + "\n[ending]\nrear_right = \"locked\"\n").unwrap();
    let out = folder.path().join("out");
    let end_speed_m_s = |path: &str, out: &str| {
        let args = [
            "predict",
            "--scenario",
            path,
            "--draws",
            "3",
            "--out",
            text(&folder.path().join(out)),
        ]
        .map(str::to_owned);
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        answer(&args)["outcome"]["speed_m_s"].as_f64().unwrap()
    };
    let braked_m_s = end_speed_m_s(text(&path), "braked");
    let coasting_m_s = end_speed_m_s("pit-right-rear", "coasting");
    assert!(braked_m_s < coasting_m_s - 0.3, "{braked_m_s} {coasting_m_s}");
    // A network that has not learned from braked vehicles refuses.
    let model = ["--response-model", "shipped-pretrained"];
    let args = ["predict", "--one-contact", "--scenario", text(&path), "--out", text(&out)];
    let message = refusal(&[&args[..], &model].concat());
    assert!(message.contains("has learned from vehicles that coast"), "{message}");
    assert!(!out.join("trajectory.csv").exists());
    // Nor is a steered one: its bands were as narrow as if the network knew it.
    fs::write(
        &path,
        fs::read_to_string("assets/scenarios/pit_right_rear.toml").unwrap()
            + "\n[ending]\nsteer_deg = 5\n",
    )
    .unwrap();
    assert!(refusal(&args).contains("wheels are steered"));
    // Followed through all contacts, what no network knows stands on the equations of motion.
    let both = ["predict", "--scenario", text(&path), "--draws", "4", "--out", text(&out)];
    let unused = answer(&[&both[..], &model].concat())["caveats"].to_string();
    assert!(unused.contains("response network for the struck vehicle"), "{unused}");
    assert!(!unused.contains("response network for the striking vehicle"), "{unused}");
}

#[test]
fn a_data_set_does_not_take_an_ending_without_a_word() {
    for args in [&["--brake", "1"][..], &["--locked", "rear-left"], &["--until-rest"]] {
        let args = [&["simulate", "--dataset", "datasets/trajectories-fea"][..], args].concat();
        assert!(refusal(&args).contains("say themselves what happens to the wheels"), "{args:?}");
    }
}

#[test]
fn an_ending_that_cannot_be_is_refused_by_its_name() {
    for (args, expected) in [
        (&["--brake", "9"][..], "braking is 9, expected 0 to 3"),
        (&["--dragged", "rear-left"], "such as rear-left=0.5"),
        (&["--dragged", "rear-left=-1"], "drag is -1"),
        (&["--locked", "spare"], "rear-left"),
        // Their drags were added.
        (&["--dragged", "rear-left=0.5", "--dragged", "rear-left=1"], "rear-left is given twice"),
        (&["--locked", "rear-left", "--dragged", "rear-left=0.5"], "rear-left is given twice"),
        (&["--engine-braking", "2g"], "engine braking is"),
        (&["--coast", "--brake", "0.5"], "cannot be used with"),
        (&["--brake-start", "1"], "--brake <SHARE>"),
        (&["--steer-angle", "90deg"], "steer angle is 1.570796 rad, expected -0.9 to 0.9 rad"),
        (&["--steering-wheel", "90deg"], "--steering-ratio <RATIO>"),
        (&["--steering-ratio", "16"], "--steer-angle <ANGLE>|--steering-wheel <ANGLE>"),
        (
            &["--steering-wheel", "720deg", "--steering-ratio", "2"],
            "no angle of a road wheel: steer angle is 6.283185 rad, expected -0.9 to 0.9 rad",
        ),
        (&["--steering-wheel", "90deg", "--steer-angle", "3deg"], "cannot be used with"),
        (&["--drive-torque=-5"], "drive torque is -5"),
        (&["--driven", "rear"], "--drive-torque <TORQUE>"),
    ] {
        let message = refusal(&[&STRAIGHT[..], args].concat());
        assert!(message.contains(expected), "{args:?}: {message}");
    }
}

/// A forecast to rest of a scenario with an ending, in a folder of its own.
fn to_rest(folder: &std::path::Path, ending: &str, args: &[&str]) -> serde_json::Value {
    let path = folder.join("scenario.toml");
    // The striking vehicle crosses slowly behind the struck one and does not meet it again.
    let pit = fs::read_to_string("assets/scenarios/pit_right_rear.toml").unwrap();
    let crossing = pit.replace("heading_deg = 18", "heading_deg = 50");
    let crossing = crossing.replace("speed_km_h = 62", "speed_m_s = 4");
    fs::write(&path, crossing + ending).unwrap();
    let out = folder.join("out");
    let fixed = ["predict", "--scenario", text(&path), "--until-rest", "--overwrite", "--out"];
    answer(&[&fixed[..], &[text(&out)], args].concat())
}

/// `predict --until-rest` was an unknown option.
#[test]
fn a_forecast_goes_on_to_rest_and_says_how_far_that_is() {
    let folder = tempfile::tempdir().unwrap();
    let braking = "\n[ending]\nbrake_start_s = 0\nbrake_rise_s = 0.01\nbrake_share = 1.5\n";
    let braked = to_rest(folder.path(), braking, &["--draws", "10"]);
    let rest = &braked["rest"];
    assert_eq!(rest["share_at_rest"], 1.0, "{rest}");
    let spread = |key: &str| -> [f64; 5] {
        let ends = |level: &str| [0, 1].map(|end| rest[key][level][end].as_f64().unwrap());
        let ([low, high], [from, to]) = (ends("ninety"), ends("half"));
        [low, from, rest[key]["median"].as_f64().unwrap(), to, high]
    };
    for key in ["time_s", "distance_m", "x_m", "y_m", "yaw_rad"] {
        assert!(spread(key).is_sorted(), "{key}: {:?}", spread(key));
    }
    // 15 m/s with locked wheels on μ = 0.8, of which 0.72 slides: v²/2μg, less what the impact takes.
    let vehicle = impactlab_core::vehicle::Preset::Reference.parameters();
    let sliding = vehicle.tires.friction * vehicle.tires.sliding_friction_ratio;
    let expected_m = 15.0 * 15.0 / (2.0 * sliding * 9.81);
    let [low, .., median, _, high] = spread("distance_m");
    assert!((median / expected_m - 1.0).abs() < 0.2, "{expected_m} {rest}");
    assert!(low > 0.6 * expected_m && high < 1.5 * expected_m, "{expected_m} {rest}");
    let [_, _, time_s, ..] = spread("time_s");
    assert!((time_s / (2.0 * expected_m / 15.0) - 1.0).abs() < 0.2, "{rest}");
    let [half, ninety] = ["region_50_m2", "region_90_m2"].map(|key| rest[key].as_f64().unwrap());
    assert!(half > 0.0 && half < ninety, "{rest}");
    let is_beyond = |report: &serde_json::Value| {
        report["badges"].to_string().contains("duration of the motion [s]")
    };
    assert!(!is_beyond(&braked) && braked["learned_duration_s"] == 11.98, "{braked}");
    // The forecast ends where the last draw has stopped and the striking car has left it behind, and its
    // files with it.
    let motion = fs::read_to_string(folder.path().join("out/trajectory.csv")).unwrap();
    let end_s: f64 = motion.lines().last().unwrap().split(',').next().unwrap().parse().unwrap();
    assert!(end_s >= high / 15.0 && end_s < 6.0 * time_s, "{end_s} {rest}");

    // A car that coasts takes minutes; what was not seen to its end is said.
    let coasting = to_rest(folder.path(), "", &["--draws", "3", "--duration", "25"]);
    let share = coasting["rest"]["share_at_rest"].as_f64().unwrap();
    assert!(share < 0.9 && coasting["rest"]["moving_speed_m_s"].as_f64().unwrap() > 0.05);
    let printed = coasting["badges"].to_string();
    assert!(
        printed.contains("not_at_rest") && printed.contains("still moves after 25.00 s"),
        "{printed}"
    );
    assert!(
        is_beyond(&coasting) && printed.contains("learned from motions of up to 11.98 s"),
        "{printed}"
    );
    let plain = answer(&[
        "predict",
        "--scenario",
        "pit-right-rear",
        "--draws",
        "3",
        "--overwrite",
        "--out",
        text(&folder.path().join("out")),
    ]);
    assert!(plain["rest"].is_null() && !is_beyond(&plain), "{plain}");
    let message = refusal(&[
        "predict",
        "--scenario",
        "pit-right-rear",
        "--until-rest",
        "--duration",
        "200",
        "--out",
        text(&folder.path().join("out")),
    ]);
    assert!(message.contains("time to rest is 200"), "{message}");
}

/// Over the vehicles drawn from a data sheet the simulation said its end alone.
#[test]
fn the_vehicles_of_a_data_sheet_come_to_rest_one_by_one() {
    let args = [
        "simulate",
        "--vehicle",
        "toyota-camry-2018",
        "--speed",
        "15",
        "--brake",
        "1.5",
        "--vehicle-draws",
        "40",
    ];
    let stop = answer(&[&args[..], &["--until-rest"]].concat());
    let rest = &stop["uncertainty"]["rest"];
    assert!(rest["n_draws"] == 40 && rest["share_at_rest"] == 1.0, "{rest}");
    let at = |end: usize| rest["distance_m"]["ninety"][end].as_f64().unwrap();
    let own = stop["rest"]["distance_m"].as_f64().unwrap();
    assert!(at(0) < own && own < at(1), "{own} {rest}");
    assert!(answer(&args)["uncertainty"]["rest"].is_null());
}
