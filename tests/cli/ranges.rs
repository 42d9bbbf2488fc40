//! Tests of the table of ranges on the command line: every fault that was accepted once is refused,
//! by the options and by a question in a file, in the same words.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::program::{EVALUATE_SHIPPED, SCENARIO, TRAJECTORIES, json, ok, program, text};

/// Runs a command and returns its exit code and what it prints to the standard error.
fn run(args: &[&str]) -> (Option<i32>, String) {
    let output = program().args(args).output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

/// A force data set of one case, with a cell of its table replaced.
fn dataset(column: &str, cell: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("forces")).unwrap();
    let file = "time_s,fx_n,fy_n\n0,0,0\n0.1,1000,0\n0.2,0,0\n";
    fs::write(folder.path().join("forces/a.csv"), file).unwrap();
    let columns = [
        ("case", "a"),
        ("m_t_kg", "2000"),
        ("m_b_kg", "2000"),
        ("v_tx_m_s", "15"),
        ("v_ty_m_s", "0"),
        ("v_bx_m_s", "17"),
        ("v_by_m_s", "2"),
        ("theta_b_rad", "0.3"),
        ("contact_x_m", "-1.5"),
        ("contact_y_m", "-0.9"),
        ("izz_t_kg_m2", ""),
    ];
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    let cells: Vec<&str> =
        columns.iter().map(|(name, usual)| if *name == column { cell } else { *usual }).collect();
    assert!(column.is_empty() || names.contains(&column), "{column}");
    let table = format!("{}\n{}\n", names.join(","), cells.join(","));
    fs::write(folder.path().join("cases.csv"), table).unwrap();
    folder
}

#[test]
fn a_table_of_cases_with_nonsense_has_problems() {
    let good = dataset("", "");
    assert_eq!(run(&["check", text(good.path())]).0, Some(0));
    for (column, cell, expected) in [
        ("m_t_kg", "-2000", "\"m_t_kg\" is -2000 kg, expected 1 to 1e8 kg"),
        ("m_t_kg", "0", "\"m_t_kg\" is 0 kg, expected 1 to 1e8 kg"),
        ("m_t_kg", "1e300", "\"m_t_kg\" is 1e300 kg, expected 1 to 1e8 kg"),
        ("m_t_kg", "", "\"m_t_kg\" is blank, expected 1 to 1e8 kg"),
        ("m_b_kg", "heavy", "\"m_b_kg\" is \"heavy\", expected 1 to 1e8 kg"),
        ("izz_t_kg_m2", "-1", "\"izz_t_kg_m2\" is -1 kg m²"),
        ("izz_t_kg_m2", "big", "\"izz_t_kg_m2\" is \"big\""),
        ("contact_x_m", "100", "\"contact_x_m\" is 100 m, expected -30 to 30 m"),
        ("v_tx_m_s", "1e999", "\"v_tx_m_s\" is \"1e999\""),
    ] {
        let folder = dataset(column, cell);
        let output = program().args(["check", text(folder.path()), "--json"]).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{column} {cell}");
        let report = json(&String::from_utf8(output.stdout).unwrap());
        let problems = report["datasets"][0]["problems"].as_array().unwrap();
        let problem = problems[0].as_str().unwrap();
        assert_eq!(problems.len(), 1, "{column} {cell}: {problems:?}");
        assert!(problem.contains(expected), "{column} {cell}: {problem}");
        assert!(problem.contains("cases.csv:2:"), "{problem}");
    }
}

#[test]
fn friction_of_a_recorded_case_is_checked() {
    for (mu, expected) in [
        ("-1", "\"mu\" is -1, expected 0.01 to 2"),
        ("0", "\"mu\" is 0, expected 0.01 to 2"),
        ("1e9", "\"mu\" is 1e9, expected 0.01 to 2"),
        ("", "\"mu\" is blank, expected 0.01 to 2"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("trajectories")).unwrap();
        fs::write(folder.path().join("trajectories/a.csv"), "time_s,x_m,y_m\n0,0,0\n1,9,0\n")
            .unwrap();
        let table = format!(
            "case,speed_m_s,mu,contact_x_m,contact_y_m,contact_height_m\na,9,{mu},-1.5,-0.9,0.5\n"
        );
        fs::write(folder.path().join("cases.csv"), table).unwrap();
        let output = program().args(["check", text(folder.path())]).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{mu}");
        let printed = String::from_utf8(output.stdout).unwrap();
        assert!(printed.contains(expected) && printed.contains("cases.csv:2:3: "), "{printed}");
    }
}

#[test]
fn options_out_of_range_are_wrong_usage() {
    const SIMULATE: &str = "simulate --force datasets/fea/forces/c001.csv";
    const PREDICT: &str = "predict --scenario pit-right-rear --out no";
    const FINE_TUNE: &str = "fine-tune response --data datasets/trajectories-fea --out m";
    const COMPARE: &str = "compare --data datasets/trajectories-fea";
    const EVALUATE: &str = "evaluate force --model shipped --data datasets/fea";
    const TRAIN: &str = "train force --data datasets/fea --out m";
    const SCENE: &str = "render scene datasets/trajectories-fea --case FE_c001 --out s.png";
    const IMPACT: &str = "render impact pit-right-rear --out i.png";
    const PARTICLES: &str = "particles is 3, expected 50 to 100000";
    for (command, option, expected) in [
        (SIMULATE, "--friction=-1", "road friction is -1, expected 0.01 to 2"),
        (SIMULATE, "--friction=1e9", "road friction is 1e9, expected 0.01 to 2"),
        (SIMULATE, "--duration=1e999", "duration is inf s, expected 0.01 to 3600 s"),
        (SIMULATE, "--contact=100,0,0.5", "contact x is 100 m, expected -30 to 30 m"),
        (SCENE, "--time=1e999", "time is inf s"),
        (SCENE, "--elevation=0", "camera elevation is 0 rad"),
        (SCENE, "--distance=0", "camera distance is 0 m"),
        (SCENE, "--azimuth=nan", "expected a number"),
        (SCENE, "--ghosts=1000000", "ghosts is 1e6"),
        (PREDICT, "--friction=-1", "road friction is -1, expected 0.01 to 2"),
        (PREDICT, "--draws=0", "draws is 0, expected 1 to 10000"),
        (PREDICT, "--window=5,2", "5 s to 2 s ends before it starts"),
        (FINE_TUNE, "--test-share=nan", "expected a number"),
        (FINE_TUNE, "--test-share=-1", "test share is -1, expected 0 to 0.9"),
        (FINE_TUNE, "--trajectories=0", "trajectories is 0, expected 1 to 1e6"),
        (COMPARE, "--choices=0", "choices is 0, expected 1 to 1000"),
        (EVALUATE, "--cross-validate=0", "folds is 0, expected 2 to 1000"),
        (EVALUATE, "--cross-validate=2000000000", "folds is 2e9, expected 2 to 1000"),
        (TRAIN, "--epochs=0", "epochs is 0, expected 1 to 100000"),
        (IMPACT, "--size=99999x99999", "picture side is 99999, expected 16 to 16384"),
        (IMPACT, "--size=16384x16384", "expected 256 to 4e7"),
        (IMPACT, "--scale=nan", "expected a number"),
        ("reconstruct evidence.toml", "--particles=3", PARTICLES),
        ("evaluate reconstruction staged", "--particles=3", PARTICLES),
        ("report evidence.toml --out r.pdf", "--particles=3", PARTICLES),
        ("render film evidence.toml --out f.mp4", "--particles=3", PARTICLES),
        ("evaluate pairs datasets/pairs", "--draws=0", "draws is 0, expected 1 to 10000"),
    ] {
        let args: Vec<&str> = command.split(' ').chain([option]).collect();
        let (code, error) = run(&args);
        assert_eq!(code, Some(2), "{command} {option}: {error}");
        assert!(error.contains(expected), "{command} {option}: {error}");
    }
}

#[test]
fn what_goes_wrong_together_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = fs::read_to_string(SCENARIO).unwrap();
    let with = |contact: &str, striking: &str| {
        let path = folder.path().join("s.toml");
        let (vehicles, _) = scenario.split_once("[contact]").unwrap();
        let vehicles =
            vehicles.replace("heading_deg = 18", &format!("heading_deg = 18\n{striking}"));
        fs::write(&path, format!("{vehicles}[contact]\n{contact}\n")).unwrap();
        path
    };
    let impact = |path: &Path| run(&["impact", text(path)]);

    let (code, error) = impact(&with("from = \"footprints\"", "x_m = 1e6\ny_m = 0"));
    assert!(code == Some(1) && error.contains("the vehicles are 99999"), "{error}");

    let point = "from = \"point\"\nx_m = -1.4\ny_m = -0.925\nnormal_deg = 90";
    let (code, error) = impact(&with(point, "x_m = 1e6\ny_m = 0"));
    assert!(
        code == Some(1) && error.contains("touch there: striking vehicle: the contact point ("),
        "{error}"
    );
    let (code, error) = impact(&with(point, "x_m = -3.6\ny_m = -2.3"));
    assert_eq!(code, Some(0), "{error}");

    let far = "from = \"point\"\nx_m = -100\ny_m = -0.925\nnormal_deg = 90";
    let (code, error) = impact(&with(far, "x_m = -103\ny_m = -2.3"));
    assert!(code == Some(1) && error.contains("lies 97.450 m off the outline"), "{error}");

    // Inside every range, but not on the car.
    let force = "datasets/fea/forces/c001.csv";
    let (code, error) = run(&["simulate", "--force", force, "--contact=-20,0,0.5"]);
    assert!(code == Some(1) && error.contains("lies 17.527 m off the outline"), "{error}");

    let (code, error) = run(&[&EVALUATE_SHIPPED[..], &["--cross-validate", "900"]].concat());
    assert!(code == Some(1) && error.contains("900 folds of"), "{error}");

    let out = folder.path().join("prediction");
    let (code, error) =
        run(&["predict", "--scenario", SCENARIO, "--window", "5,6", "--out", text(&out)]);
    assert!(code == Some(1) && error.contains("--window ends at 6 s, after the motion"), "{error}");
    assert!(!out.exists());

    let steer = folder.path().join("steer.csv");
    fs::write(&steer, "time_s,steer_rad\n0,0\n1,5\n").unwrap();
    let (code, error) = run(&["simulate", "--speed", "20", "--steer", text(&steer)]);
    assert!(code == Some(1) && error.contains("steer.csv:1: "), "{error}");
    assert!(error.contains("line 3 has 5 rad, expected -0.9 to 0.9 rad"), "{error}");
    assert!(error.contains("--steer-map \"steering_wheel=2:rad\""), "{error}");
}

#[test]
fn numbers_that_overflow_are_no_answer() {
    let folder = tempfile::tempdir().unwrap();
    // The longest step over the median step was infinite, and the flag of it `null`.
    let path = folder.path().join("f.csv");
    fs::write(&path, "time_s,fx_n,fy_n\n0,0,0\n1e-320,10,0\n2e-320,10,0\n1,0,0\n").unwrap();
    let output = program().args(["check", text(&path)]).output().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{printed}");
    let expected = "f.csv:3:1: time step is 1e-320 s, expected 1e-9 to 1e6 s";
    assert!(printed.contains(expected), "{printed}");

    // The momentum residual over an impulse that is hardly a number was infinite, and so was the
    // flag of the case.
    let dataset = dataset("", "");
    let series = "time_s,fx_n,fy_n,target_vx_m_s,target_vy_m_s\n0,0,0,15,0\n0.1,1e-310,0,16,0\n\
                  0.2,0,0,17,0\n";
    fs::write(dataset.path().join("forces/a.csv"), series).unwrap();
    let (code, error) = run(&["check", text(dataset.path()), "--json"]);
    assert!(code == Some(1) && error.contains("error: check: datasets[0]."), "{error}");
    assert!(error.contains("of the answer is inf"), "{error}");
}

#[test]
fn settings_out_of_range_have_a_place_in_their_file() {
    let folder = tempfile::tempdir().unwrap();
    let config = folder.path().join("c.toml");
    for (network, section, key, value) in [
        ("force", "training", "weight_decay", "nan"),
        ("force", "training", "weight_decay", "inf"),
        ("force", "crush", "impulse_weight", "nan"),
        ("force", "crush", "impulse_weight", "-inf"),
        ("force", "training", "test_share", "nan"),
        ("force", "network", "attention_heads", "0"),
        ("force", "crush", "max_steps", "0"),
        ("response", "calibration", "prior_std", "nan"),
        ("response", "calibration", "prior_std", "inf"),
        ("response", "tuning", "prior_std", "nan"),
        ("response", "single_steps", "weight_decay", "inf"),
        ("response", "single_steps", "feature_noise", "nan"),
        ("response", "loss", "trajectory", "nan"),
        ("response", "physics", "max", "inf"),
        ("response", "pretraining", "learning_rate", "nan"),
    ] {
        fs::write(&config, format!("[{section}]\n{key} = {value}\n")).unwrap();
        let (code, error) = run(&[
            "train",
            network,
            "--data",
            "datasets/fea",
            "--out",
            "m",
            "--config",
            text(&config),
        ]);
        let expected = format!("c.toml:2:{}: {section}.{key} is {value}, expected ", key.len() + 4);
        assert!(code == Some(1) && error.contains(&expected), "{error}\n{expected}");
    }
}

/// A question as its command prints it, with the value at a place replaced.
fn question(args: &[&str], place: &str, value: Value) -> Value {
    let mut question = json(&ok(program().args(args).arg("--print-request").output().unwrap()));
    *question.pointer_mut(place).unwrap_or_else(|| panic!("no {place}")) = value;
    question
}

#[test]
fn a_question_in_a_file_is_refused_in_the_same_words() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("question.json");
    let simulate = ["simulate", "--scenario", SCENARIO];
    let predict = ["predict", "--scenario", SCENARIO, "--out", "no"];
    let evaluate = ["evaluate", "force", "--model", "shipped", "--data", "datasets/fea"];
    let compare = ["compare", "--data", TRAJECTORIES];
    for (args, place, value, expected) in [
        (
            &simulate[..],
            "/friction",
            Value::from(-1.0),
            "friction: road friction is -1, expected 0.01 to 2",
        ),
        (
            &simulate,
            "/duration_s",
            Value::from(1e9),
            "duration_s: duration is 1e9 s, expected 0.01 to 3600 s",
        ),
        (
            &simulate,
            "/source/scenario/pulse/duration_s",
            Value::from(0),
            "pulse.duration_s: pulse duration is 0 s, expected 0.001 to 2 s",
        ),
        (&predict, "/draws", Value::from(0), "draws: draws is 0, expected 1 to 10000"),
        (
            &predict,
            "/draws",
            Value::from(1_000_000_000),
            "draws: draws is 1e9, expected 1 to 10000",
        ),
        (
            &evaluate,
            "/cross_validate",
            Value::from(0),
            "cross_validate: folds is 0, expected 2 to 1000",
        ),
        (&compare, "/choices", Value::from(0), "choices: choices is 0, expected 1 to 1000"),
        (&compare, "/trajectories", Value::Array(Vec::new()), "expected 1 to 100"),
    ] {
        let question = question(args, place, value);
        fs::write(&path, question.to_string()).unwrap();
        let (code, error) = run(&["ask", text(&path)]);
        assert_eq!(code, Some(1), "{place}: {error}");
        assert!(error.contains(expected), "{place}: {error}");
    }
}

#[test]
fn the_table_is_printed_and_can_be_searched() {
    let all = json(&ok(program().args(["ranges", "--json"]).output().unwrap()));
    let ranges = all["ranges"].as_array().unwrap();
    assert!(ranges.len() > 100, "{}", ranges.len());
    let friction = ranges.iter().find(|range| range["name"] == "road friction").unwrap();
    assert_eq!(friction["low"], 0.01);
    assert_eq!(friction["high"], 2.0);
    let printed = ok(program().args(["ranges", "pictures"]).output().unwrap());
    assert!(printed.contains("picture side") && !printed.contains("friction"), "{printed}");
    let (code, error) = run(&["ranges", "colour"]);
    assert!(code == Some(1) && error.contains("no range has \"colour\" in its name"), "{error}");
}
