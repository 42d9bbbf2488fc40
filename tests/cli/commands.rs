//! Tests of the commands without networks, of the help and of what all commands have in common.

mod kinds;

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::TempDir;

use crate::program::{SCENARIO, TRAJECTORIES, program};

/// What a command printed, and its exit code.
pub struct Ran {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Ran {
    fn json(&self) -> Value {
        serde_json::from_str(&self.out)
            .unwrap_or_else(|error| panic!("no JSON: {error}\n{}\n{}", self.out, self.err))
    }

    /// Returns the error message, after checking that it is a single line on stderr and that stdout
    /// is empty.
    pub fn error_line(&self) -> &str {
        assert_eq!(self.code, 1, "{}{}", self.out, self.err);
        assert_eq!(self.out, "", "{}", self.err);
        let lines: Vec<&str> = self.err.lines().collect();
        let [line] = lines[..] else { panic!("expected one line: {}", self.err) };
        line.strip_prefix("error: ").expect("an error starts with error:")
    }
}

pub fn impactlab(args: &[&str]) -> Ran {
    let output = program().args(args).output().expect("the program can be started");
    Ran {
        code: output.status.code().expect("no signal ended it"),
        out: String::from_utf8(output.stdout).expect("UTF-8"),
        err: String::from_utf8(output.stderr).expect("UTF-8"),
    }
}

fn write(folder: &TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, text).expect("a temporary folder can be written");
    path
}

fn text(path: &Path) -> &str {
    path.to_str().expect("temporary paths are UTF-8")
}

/// Runs a simulation of 4 s of the reference car with these options and returns its JSON output.
fn simulate(options: &[&str]) -> Value {
    let mut args = vec!["simulate", "--vehicle", "reference-2000", "--json"];
    args.extend(options);
    let ran = impactlab(&args);
    assert_eq!(ran.code, 0, "{options:?}: {}", ran.err);
    ran.json()
}

#[test]
fn every_help_shows_an_example() {
    for command in [
        &[][..],
        &["app"],
        &["check"],
        &["impact"],
        &["simulate"],
        &["render"],
        &["render", "force"],
        &["render", "motion"],
        &["render", "scene"],
        &["render", "impact"],
        &["vehicles"],
        &["stiffness"],
        &["sweep"],
        &["atlas"],
        &["atlas", "cell"],
        &["atlas", "slice"],
        &["atlas", "sensitivity"],
        &["atlas", "make"],
        &["import"],
        &["ranges"],
        &["schema"],
    ] {
        let ran = impactlab(&[command, &["--help"]].concat());
        assert_eq!(ran.code, 0, "{command:?}");
        let example = [&["impactlab"], command].concat().join(" ");
        let examples = ran.out.split("Example").nth(1).unwrap_or_default();
        assert!(examples.contains(&example), "{command:?}: {}", ran.out);
    }
}

#[test]
fn wrong_usage_exits_with_2() {
    for args in [
        &["simulate", "--quick"][..],
        &["nonsense"],
        &["check"],
        &["simulate", "--vehicle", "reference-2000"],
        &["simulate", "--vehicle", "reference-2000", "--speed", "20kPa"],
        &["simulate", "--dataset", TRAJECTORIES, "--speed", "20"],
        &["simulate", "--case", "FE_c001"],
        &["check", ".", "--map", "fx"],
        &["render", "force", "x.csv", "--out", "x.csv", "--cfc", "61"],
    ] {
        let ran = impactlab(args);
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{args:?}: {}", ran.err);
    }
}

#[test]
fn shipped_data_sets_are_clean_enough() {
    let ran = impactlab(&["check", "datasets", "--json"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let report = ran.json();
    assert_eq!(report["ok"], true);
    let sizes = report["datasets"].as_array().unwrap().iter().map(|set| &set["n_cases"]);
    assert_eq!(sizes.collect::<Vec<_>>(), [100, 190, 67, 100, 40, 100, 100]);
    for set in report["datasets"].as_array().unwrap() {
        assert_eq!(set["problems"].as_array().unwrap().len(), 0);
        assert!(set["columns"][0]["unit"].is_string());
        let severities: Vec<&str> = set["flags"].as_array().unwrap().iter().map(severity).collect();
        let n_warnings = severities.iter().filter(|s| **s == "warning").count();
        assert!(severities[..n_warnings].iter().all(|s| *s == "warning"), "not sorted");
    }
    let all = impactlab(&["check", "datasets/fea", "--all"]).out;
    assert!(all.lines().any(|line| line.trim() == "c001  clean"), "{all}");
}

fn severity(flag: &Value) -> &str {
    flag["severity"].as_str().unwrap_or_default()
}

#[test]
fn columns_that_are_not_recognised_are_proposed_and_can_be_mapped() {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "k.csv", "Zeit [ms];Kraft A;Kraft B\n0;0;0\n1;2,5;3\n2;0;0\n");
    let ran = impactlab(&["check", text(&file)]);
    assert_eq!(ran.code, 1);
    assert!(ran.out.contains("time=1:ms,fx=COLUMN:UNIT,fy=COLUMN:UNIT"), "{}", ran.out);
    let map = "fx=Kraft A:kN,fy=3:kN";
    let ran = impactlab(&["check", text(&file), "--map", map, "--json"]);
    let report = ran.json();
    let columns = report["files"][0]["columns"].as_array().unwrap();
    assert_eq!(columns[1]["channel"], "fx");
    assert_eq!(columns[1]["unit"], "kN");
    assert_eq!(ran.code, 0);
}

#[test]
fn an_impact_is_solved_in_si_and_shown_in_us_units() {
    let answer = impactlab(&["impact", SCENARIO, "--json", "--units", "us"]).json();
    for key in ["impulse_n_s", "regime", "impulse_normal_n_s", "dissipated_energy_j"] {
        assert!(!answer[key].is_null(), "{key}");
    }
    for vehicle in ["target", "bullet"] {
        for key in ["velocity_m_s", "yaw_rate_rad_s", "delta_v_m_s", "pdof_deg", "pdof_clock"] {
            assert!(!answer[vehicle][key].is_null(), "{vehicle} {key}");
        }
    }
    let barrier = "assets/scenarios/carpenter_welcher_barrier.toml";
    let us = impactlab(&["impact", barrier, "--units", "us"]).out;
    for published in ["5936 lbf s", "-351.8 lbf s", "176.4 deg/s", "170422 ft lbf"] {
        assert!(us.contains(published), "{published}: {us}");
    }
    let paper = impactlab(&["impact", barrier, "--paper", "--json"]).json();
    assert_eq!((&paper["friction_model"], &paper["regime"]), (&"paper".into(), &"sliding".into()));
}

#[test]
fn the_shipped_trajectories_are_met() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("simulated");
    let args = ["simulate", "--dataset", TRAJECTORIES, "--json", "--out", text(&out)];
    let ran = impactlab(&args);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let answer = ran.json();
    assert_eq!(answer["cases"].as_array().unwrap().len(), 100);
    assert_eq!(answer["failures"].as_array().unwrap().len(), 0);
    let mean = answer["overall"]["average_error_m"]["mean"].as_f64().unwrap();
    assert!((0.5..=1.3).contains(&mean), "{mean}");
    assert_eq!(answer["spinning"]["average_error_m"]["n"], 24);
    assert_eq!(answer["not_spinning"]["average_error_m"]["n"], 76);
    let case = &answer["cases"][0];
    assert!(case["case"].is_string() && case["spin"].is_boolean());
    assert!(case["final_error_m"].is_number());
    assert_eq!(fs::read_dir(&out).unwrap().count(), 100 + 1, "and the manifest");
    let single = impactlab(&["simulate", "--dataset", TRAJECTORIES, "--case", "FE_c001"]);
    assert!(single.out.contains("FE_c001") && !single.out.contains("FE_c002"));
}

#[test]
fn a_speed_may_have_a_unit() {
    assert_eq!(simulate(&["--speed", "20"]), simulate(&["--speed", "72km/h"]));
}

#[test]
fn positive_steer_turns_left() {
    let folder = TempDir::new().unwrap();
    let steer = write(&folder, "steer.csv", "time_s,steer_deg\n0,0\n0.5,2\n4,2\n");
    let left = simulate(&["--speed", "15", "--steer", text(&steer)]);
    assert!(left["end"]["yaw_rad"].as_f64().unwrap() > 0.3, "{left}");
    assert!(left["end"]["y_m"].as_f64().unwrap() > 3.0, "{left}");
    assert!(left["force"].is_null() && left["delta_v_m_s"].is_null());
}

#[test]
fn a_force_without_moment_and_contact_point_is_assumed_to_act_somewhere() {
    let folder = TempDir::new().unwrap();
    let force =
        write(&folder, "f.csv", "time_s,fx_n,fy_n\n0,0,0\n0.05,0,40000\n0.1,0,0\n0.2,0,0\n");
    let args = ["simulate", "--vehicle", "target-2000", "--speed", "15", "--force"];
    let ran = impactlab(&[&args[..], &[text(&force)]].concat());
    assert!(ran.out.contains("assumed contact point: x -1.5 m, y -0.9 m"), "{}", ran.out);
    let out = folder.path().join("t.csv");
    let contact = ["--contact", "-1.5,-0.9,0.5", "--out", text(&out), "--json"];
    let ran = impactlab(&[&args[..], &[text(&force)], &contact].concat());
    let answer = ran.json();
    assert_eq!(answer["force"]["sampling"], "instant");
    assert_eq!(answer["force"]["yaw_moment"], "contact_point");
    assert_eq!(answer["assumptions"].as_array().map(Vec::len), Some(0), "{answer}");
    let impulse = answer["force"]["impulse_n_s"][1].as_f64().unwrap();
    assert!((impulse - 2000.0).abs() < 1e-9, "{impulse}");
    assert!(answer["end"]["yaw_rad"].as_f64().unwrap() < -0.1, "{answer}");
    let written = fs::read_to_string(&out).unwrap();
    let recorded =
        fs::read_to_string("datasets/trajectories-fea/trajectories/FE_c001.csv").unwrap();
    assert_eq!(written.lines().next(), recorded.lines().next());
    let short = ["--contact", "-1.5,-0.9,0.5", "--duration", "0.05"];
    let ran = impactlab(&[&args[..], &[text(&force)], &short].concat());
    assert!(ran.error_line().contains("contact from 0 s to 0.1 s"), "{}", ran.err);
}

#[test]
fn what_a_force_sample_stands_for_follows_from_the_columns() {
    for (file, sampling) in [
        ("datasets/fea/forces/c001.csv", "centred_mean"),
        ("datasets/trajectories-fea/trajectories/FE_c001.csv", "coming_mean"),
    ] {
        let answer = simulate(&["--speed", "12.6", "--force", file]);
        assert_eq!(answer["force"]["sampling"], sampling, "{file}");
    }
    let file = "datasets/fea/forces/c001.csv";
    let answer = simulate(&["--speed", "12.6", "--force", file, "--sampling", "instant"]);
    assert_eq!(answer["force"]["sampling"], "instant");
}

#[test]
fn check_says_impulse_peak_and_contact_of_a_force_file() {
    let folder = TempDir::new().unwrap();
    let table = "t [ms],Fx [kN],Fy [kN]\n0,0,0\n50,0,0\n100,3,40\n150,0,0\n200,0,0\n";
    let file = write(&folder, "f.csv", table);
    let ran = impactlab(&["check", text(&file)]);
    for line in [
        "axes of the force     world",
        "impulse               2.006 kN s (x 0.1500, y 2.000)",
        "peak force            40.11 kN",
        "time of the peak      0.1000 s",
    ] {
        assert!(ran.out.lines().any(|printed| printed == line), "{line}\n{}", ran.out);
    }
    let force = &impactlab(&["check", "--json", text(&file)]).json()["files"][0]["force"];
    let number = |value: &Value| value.as_f64().unwrap_or_else(|| panic!("{force}"));
    for (got, expected) in [
        (&force["impulse_n_s"][0], 150.0),
        (&force["impulse_n_s"][1], 2000.0),
        (&force["peak_n"], 3000_f64.hypot(40_000.0)),
        (&force["peak_time_s"], 0.1),
        (&force["contact_s"][0], 0.05),
        (&force["contact_s"][1], 0.15),
    ] {
        assert!((number(got) - expected).abs() < 1e-9 * expected, "{expected}: {force}");
    }
    let steering = impactlab(&["check", "--json", "docs/guide/examples/steering.csv"]).json();
    assert!(steering["files"][0]["force"].is_null(), "{steering}");
}

#[test]
fn bad_files_are_named_with_line_and_column() {
    let folder = TempDir::new().unwrap();
    let force = write(&folder, "f.csv", "time_s,fx_n,fy_n,mz_nm\n0,1,2,0\n0.1,x,3,0\n");
    let vehicle = write(&folder, "v.toml", "name = \"x\"\n[mass]\nmass_kg = \"a\"\n");
    let scenario = fs::read_to_string(SCENARIO).unwrap();
    let scenario = scenario.replace("restitution = 0.15", "restitution = 15");
    let scenario = write(&folder, "s.toml", &scenario);
    let preset = ["--vehicle", "target-2000", "--speed", "15"];
    let simulate = |args: &[&str]| impactlab(&[&["simulate"], args].concat());
    for (ran, place) in [
        (simulate(&[&preset[..], &["--force", text(&force)]].concat()), "f.csv:3:2: "),
        (simulate(&["--vehicle", text(&vehicle), "--speed", "15"]), "v.toml:3:11: "),
        (impactlab(&["impact", text(&scenario)]), "s.toml:28:15: "),
    ] {
        assert!(ran.error_line().contains(place), "{place} {}", ran.err);
    }
    let checked = impactlab(&["check", text(&force), text(&scenario)]);
    assert_eq!(checked.code, 1);
    assert!(checked.out.contains("f.csv:3:2: ") && checked.out.contains("s.toml:28:15: "));
}

#[test]
fn names_that_do_not_exist_are_errors() {
    for (args, part) in [
        (&["simulate", "--vehicle", "nix", "--speed", "9"][..], "one of reference-2000"),
        (&["simulate", "--dataset", "datasets/fea"], "expected one of trajectories"),
        (&["simulate", "--dataset", TRAJECTORIES, "--case", "nix"], "no case \"nix\""),
        (&["vehicles", "nix"], "one of reference-2000"),
        (&["impact", "nix.toml"], "nix.toml: does not exist; check the name"),
        (&["check", ".", "--map", "fx=1"], "--map is for single files"),
    ] {
        let ran = impactlab(args);
        assert!(ran.error_line().contains(part), "{args:?}: {}", ran.err);
    }
}

#[test]
fn a_case_that_cannot_be_read_is_a_failure() {
    let folder = TempDir::new().unwrap();
    let root = folder.path();
    fs::create_dir(root.join("trajectories")).unwrap();
    let table = fs::read_to_string(format!("{TRAJECTORIES}/cases.csv")).unwrap();
    let table: Vec<&str> = table.lines().take(3).collect();
    write(&folder, "cases.csv", &table.join("\n"));
    for file in ["vehicle.toml", "trajectories/FE_c001.csv"] {
        fs::copy(format!("{TRAJECTORIES}/{file}"), root.join(file)).unwrap();
    }
    write(&folder, "trajectories/FE_c002.csv", "time_s,x_m,y_m\n0,0,0\n1,a,0\n");
    let ran = impactlab(&["simulate", "--dataset", text(root), "--json"]);
    assert_eq!(ran.code, 1, "{}", ran.err);
    let answer = ran.json();
    assert_eq!(answer["cases"].as_array().unwrap().len(), 1);
    assert!(answer["failures"][0].as_str().unwrap().contains("FE_c002.csv:3:2: "));
    let ran = impactlab(&["simulate", "--dataset", text(root), "--case", "FE_c002"]);
    assert!(ran.error_line().contains("FE_c002.csv:3:2: "), "{}", ran.err);
}

#[test]
fn figures_are_written_as_numbers() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("figure.csv");
    let yaw_rate = ["--case", "FE_c002", "--channel", "yaw-rate"];
    for (args, header, series) in [
        (
            [&["force", "datasets/fea", "--case", "c001"][..], &["--cfc", "60"]].concat(),
            "series,Time [ms],Force on the struck vehicle [kN]",
            "unfiltered,",
        ),
        (
            [&["motion", TRAJECTORIES][..], &yaw_rate].concat(),
            "series,Time [s],Yaw rate r [deg/s]",
            "recorded,",
        ),
        (
            vec!["scene", TRAJECTORIES, "--case", "FE_c002", "--time", "1.5"],
            "series,\"X, along the road [m]\",\"Y, to the left [m]\",Time [s],Heading [deg]",
            "4DOF simulation,",
        ),
        (
            vec!["impact", SCENARIO],
            "series,\"X, along the road [m]\",\"Y, to the left [m]\"",
            "impulse on the struck vehicle,",
        ),
    ] {
        let ran = impactlab(
            &[&["render"], &args[..], &["--out", text(&out), "--overwrite", "--json"]].concat(),
        );
        assert_eq!(ran.code, 0, "{args:?}: {}", ran.err);
        assert!(ran.json()["title"].is_string());
        let csv = fs::read_to_string(&out).unwrap();
        let first = csv.lines().next().unwrap();
        assert_eq!(first.trim_end_matches(",restrictions"), header, "{args:?}");
        assert!(csv.lines().any(|line| line.starts_with(series)), "{args:?}");
    }
    let late = ["render", "scene", TRAJECTORIES, "--case", "FE_c002", "--time", "9", "--out"];
    let ran = impactlab(&[&late[..], &[text(&out), "--overwrite"]].concat());
    assert!(ran.error_line().starts_with("--time is 9 s"), "{}", ran.err);
    let ran = impactlab(&["render", "impact", SCENARIO, "--out", "figure.gif"]);
    assert!(ran.error_line().contains(".png or .csv"), "{}", ran.err);
}

#[test]
fn a_scene_is_drawn_from_above_and_in_perspective() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("scene.png");
    let scene = ["render", "scene", TRAJECTORIES, "--case", "FE_c002", "--time", "1.5", "--json"];
    let struck = ["--size", "320x240", "--scale", "1", "--out", text(&out), "--overwrite"];
    let mut pictures = Vec::new();
    for (options, seen) in [
        (&["--view", "above"][..], "from above"),
        (&["--view", "perspective"][..], "in perspective"),
        (&["--view", "perspective", "--azimuth=40deg", "--elevation=20deg"][..], "in perspective"),
        (
            &["--view", "perspective", "--distance", "15", "--follow", "struck"][..],
            "in perspective",
        ),
        (&["--ghosts", "8"][..], "from above"),
    ] {
        let ran = impactlab(&[&scene[..], options, &struck].concat());
        assert_eq!(ran.code, 0, "{options:?}: {}", ran.err);
        assert_eq!(ran.json()["title"], format!("FE_c002: scene {seen} at 1.50 s"));
        let picture = fs::read(&out).unwrap();
        assert!(!pictures.contains(&picture), "{options:?} changes the picture");
        pictures.push(picture);
    }
    let csv = folder.path().join("scene.csv");
    let ghosts = ["--ghosts", "3", "--out", text(&csv)];
    let ran = impactlab(&[&scene[..], &ghosts].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    let numbers = fs::read_to_string(&csv).unwrap();
    assert!(numbers.lines().any(|line| line.starts_with("draw 3 of the forecast,")));
    assert!(!numbers.contains("draw 4 of"));
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_display_the_headless_commands_are_named() {
    let mut command = program();
    command.env("DISPLAY", "").env_remove("WAYLAND_DISPLAY");
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.lines().count() == 1 && err.contains("impactlab check datasets"), "{err}");
}

#[test]
fn a_printed_vehicle_is_a_vehicle_file() {
    let list = impactlab(&["vehicles", "--json"]).json();
    let id = list["vehicles"][0]["id"].as_str().unwrap();
    assert!(list["vehicles"][0]["mass_kg"].is_number());
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "my-car.toml", &impactlab(&["vehicles", id]).out);
    let ran = impactlab(&["simulate", "--vehicle", text(&file), "--speed", "10", "--json"]);
    assert_eq!(ran.json(), simulate(&["--speed", "10"]));
}

#[test]
fn the_licences_of_crates_and_fonts_are_printed() {
    let notices = impactlab(&["licences"]).out;
    for part in ["nalgebra", "Apache License", "Ubuntu-Light.ttf", "SIL OPEN FONT LICENSE"] {
        assert!(notices.contains(part), "{part}");
    }
    assert_eq!(impactlab(&["licenses", "--json"]).json()["licences"], notices);
}

#[test]
fn what_nobody_said_is_listed_as_assumed() {
    let assumed = |args: &[&str]| -> Vec<String> {
        let ran = impactlab(&[args, &["--json"]].concat());
        assert_eq!(ran.code, 0, "{args:?}: {}", ran.err);
        let answer = ran.json();
        let list = answer["assumptions"].as_array().unwrap().iter();
        list.map(|of| format!("{}: {}", of["quantity"].as_str().unwrap(), of["value"])).collect()
    };
    let force = "datasets/fea/forces/c001.csv";
    assert_eq!(
        assumed(&["simulate", "--force", force]),
        ["vehicle: \"reference-2000\"", "speed: \"20 m/s\""]
    );
    let all_given = ["simulate", "--force", force, "--vehicle", "target-2000", "--speed", "20"];
    assert_eq!(assumed(&all_given), [] as [&str; 0]);
    let scenario = assumed(&["simulate", "--scenario", SCENARIO]);
    let quantities: Vec<&str> = scenario.iter().filter_map(|text| text.split(':').next()).collect();
    assert_eq!(quantities, ["pulse", "contact_height", "vehicle", "bullet", "bullet"]);
    assert_eq!(
        assumed(&["simulate", "--dataset", TRAJECTORIES, "--case", "FE_c001"]),
        [] as [&str; 0]
    );
}

#[test]
fn a_question_that_is_printed_has_the_same_answer_when_it_is_asked() {
    let folder = TempDir::new().unwrap();
    let args = ["simulate", "--dataset", "datasets/fea", "--case", "c001", "--json"];
    let answer = impactlab(&args).json();
    let request = impactlab(&[&args[..], &["--print-request"]].concat());
    assert_eq!(request.json()["question"], "simulate");
    let path = write(&folder, "request.json", &request.out);
    let mut answered = impactlab(&["ask", text(&path)]).json();
    answered["out"] = Value::Null;
    assert_eq!(answered, answer);
    // Windows PowerShell writes a byte order mark before what it is given.
    let marked = write(&folder, "marked.json", &format!("\u{feff}{}", request.out));
    assert_eq!(impactlab(&["ask", "--print-request", text(&marked)]).json(), request.json());
    let checked = impactlab(&["check", text(&marked)]);
    assert_eq!(checked.code, 0, "{}", checked.out);
    let wrong = write(&folder, "wrong.json", "{\"question\": \"simulate\"}");
    let ran = impactlab(&["ask", text(&wrong)]);
    assert!(ran.error_line().contains("is no request"), "{}", ran.err);
}
