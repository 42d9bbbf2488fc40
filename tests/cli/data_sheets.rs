//! Tests of vehicles of which only a data sheet is known: files, library, uncertainty.

use std::fs;
use std::path::Path;

use impactlab_core::vehicle::Preset;
use serde_json::Value;
use tempfile::TempDir;

use crate::program::{SCENARIO, answer, program};

/// Standard output of a command that must succeed.
fn out(args: &[&str]) -> String {
    let output = program().args(args).output().expect("the program can be started");
    let err = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(0), "{args:?}: {err}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn json(args: &[&str]) -> Value {
    serde_json::from_str(&out(&[args, &["--json"]].concat())).expect("the output is JSON")
}

fn sheet(folder: &TempDir, lines: &str) -> String {
    let path = folder.path().join("car.toml");
    fs::write(&path, format!("name = \"my car\"\n\n[data_sheet]\n{lines}\n"))
        .expect("a temporary folder can be written");
    path.to_str().expect("temporary paths are UTF-8").to_owned()
}

#[test]
fn the_library_is_listed_printed_and_read_back() {
    let list = json(&["vehicles"]);
    let vehicles = list["vehicles"].as_array().unwrap();
    let library: Vec<&Value> = vehicles.iter().filter(|v| v["kind"] == "library").collect();
    assert_eq!(library.len(), 38);
    let folder = TempDir::new().unwrap();
    for vehicle in library.iter().take(6) {
        let id = vehicle["id"].as_str().unwrap();
        let file = folder.path().join("car.toml");
        fs::write(&file, out(&["vehicles", id])).unwrap();
        let speed = ["simulate", "--speed", "10", "--vehicle-draws", "5", "--vehicle"];
        let by_name = json(&[&speed[..], &[id]].concat());
        assert_eq!(by_name, json(&[&speed[..], &[file.to_str().unwrap()]].concat()), "{id}");
        let estimates = &json(&["vehicles", id])["data_sheet_estimates"];
        assert!(estimates.as_array().unwrap().iter().all(|e| e["source"].is_string()), "{id}");
    }
    let printed = out(&["vehicles", "ford-explorer-2004", "--estimates"]);
    assert!(
        printed.contains("yaw inertia [kg m²]") && printed.contains("Heydinger 1999"),
        "{printed}"
    );
}

/// Masses were in kg whatever the units of the reader, and an inertia of about 4200 kg m² had four decimals.
#[test]
fn the_list_and_the_estimates_are_in_the_units_of_the_reader() {
    let list = out(&["vehicles", "--units", "us"]);
    let of = |id: &str| list.lines().find(|line| line.starts_with(id)).unwrap().to_owned();
    assert!(list.lines().next().unwrap().contains("mass [lb]"), "{list}");
    assert!(of("target-2000").contains(" 4409 "), "{list}");
    assert!(of("target-2000").ends_with("FEA target (4409 lb)"), "{list}");
    let inertia = |units: &str| {
        let printed = out(&["vehicles", "ford-explorer-2004", "--estimates", "--units", units]);
        let line = printed.lines().find(|line| line.starts_with("yaw inertia"));
        let cells = line.unwrap().split("  ").map(str::trim).filter(|cell| !cell.is_empty());
        let cells: Vec<&str> = cells.collect();
        assert!(!cells[1].contains('.'), "{printed}");
        (cells[0].to_owned(), cells[1].parse::<f64>().unwrap())
    };
    let [(si_name, kg_m2), (us_name, slug_ft2)] = ["si", "us"].map(inertia);
    assert_eq!([si_name.as_str(), &us_name], ["yaw inertia [kg m²]", "yaw inertia [slug ft²]"]);
    assert!((kg_m2 / slug_ft2 - 1.355_82).abs() < 0.03, "{kg_m2} kg m², {slug_ft2} slug ft²");
}

#[test]
fn a_sheet_is_read_wherever_a_vehicle_file_is() {
    let folder = TempDir::new().unwrap();
    let car = sheet(&folder, "mass_lb = 3300\nlength_in = 182\nwidth_in = 71");
    let checked = out(&["check", &car]);
    assert!(checked.contains("my car"), "{checked}");
    let motion = json(&["simulate", "--scenario", SCENARIO, "--vehicle", &car]);
    assert_eq!(motion["vehicle"], "my car");
    let assumed = motion["assumptions"].as_array().unwrap();
    let estimates: Vec<&Value> =
        assumed.iter().filter(|a| a["quantity"] == "vehicle_parameter").collect();
    assert!(estimates.len() > 15, "{assumed:?}");
    assert!(estimates.iter().all(|a| a["value"].as_str().unwrap().contains("90 %: ")));
    let file = folder.path().join("wrong.toml");
    fs::write(&file, "[data_sheet]\nclass = \"car\"\nmass_lb = -3\n").unwrap();
    let refused = program().args(["simulate", "--speed", "9", "--vehicle"]).arg(&file).output();
    let refused = refused.unwrap();
    assert_eq!(refused.status.code(), Some(1));
    let line = String::from_utf8(refused.stderr).unwrap();
    assert!(line.contains("wrong.toml:3:11: data_sheet.mass_lb is -3, expected 2.2"), "{line}");
}

/// The scenario's 2000 kg were driven on the tires of the Corolla, and ended 15 m away.
#[test]
fn a_chosen_vehicle_gives_the_scenario_its_mass_and_says_what_it_replaces() {
    let folder = TempDir::new().unwrap();
    let own = folder.path().join("own.toml");
    fs::copy("assets/scenarios/pit_right_rear.toml", &own).unwrap();
    let scenario = own.to_str().unwrap();
    let corolla = ["--vehicle", "toyota-corolla-2020"];
    let asked = |more: &[&str]| {
        let args = [&["simulate", "--scenario", scenario, "--print-request"], more].concat();
        json(&args)["source"]["scenario"]["scenario"].clone()
    };
    assert_eq!(asked(&[])["file"], scenario, "left open it is the file");
    let taken = &asked(&corolla)["inline"];
    let mass_kg = json(&["vehicles", corolla[1]])["mass"]["mass_kg"].clone();
    assert_eq!(
        (&taken["target"]["mass_kg"], &taken["target_vehicle"]),
        (&mass_kg, &corolla[1].into())
    );
    assert_eq!(taken["bullet"]["mass_kg"], 2000.0);
    let args = ["simulate", "--scenario", scenario, "--vehicle-draws", "0", "--json"];
    let ran = program().args(args).args(corolla).output().unwrap();
    let note = String::from_utf8(ran.stderr).unwrap();
    assert!(note.starts_with("note: PIT") && note.contains("instead of 2000"), "{note}");
    let report: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert!(!report["caveats"].to_string().contains("other_vehicle"), "{report}");
    // A file that names the car and says another mass means that mass.
    let text = fs::read_to_string(&own).unwrap();
    fs::write(&own, text.replacen("[target]", "[target]\nvehicle = \"toyota-corolla-2020\"", 1))
        .unwrap();
    assert_eq!(asked(&corolla)["inline"]["target"]["mass_kg"], 2000.0);
    let report = json(&[&args[..5], &corolla].concat());
    assert!(report["caveats"].to_string().contains("other_vehicle"), "{report}");
    // The file is an input, although the question has its content.
    let replaced =
        program().args(args).args(corolla).args(["--out", scenario, "--overwrite"]).output();
    let refused = String::from_utf8(replaced.unwrap().stderr).unwrap();
    assert!(refused.contains("own.toml"), "{refused}");
    assert!(fs::read_to_string(&own).unwrap().contains("[contact]"));
}

/// A class says how much its cars differ in mass; with --vehicle the class the mass was taken as known.
#[test]
fn a_mass_that_is_estimated_varies_with_the_vehicle() {
    let args = ["simulate", "--scenario", SCENARIO, "--vehicle", "generic-car"];
    let report = json(&[&args[..], &["--vehicle-draws", "60"]].concat());
    let shares = report["uncertainty"]["sensitivity"].as_array().unwrap();
    assert!(shares.iter().any(|share| share["quantity"] == "mass"), "{shares:?}");
}

#[test]
fn the_draws_of_a_simulation_follow_their_seed_and_are_told() {
    let args = ["simulate", "--scenario", SCENARIO, "--vehicle", "toyota-corolla-2020"];
    let with = |more: &[&str]| json(&[&args[..], more].concat())["uncertainty"].clone();
    let draws = ["--vehicle-draws", "40"];
    assert_eq!(with(&draws), with(&draws));
    let other = with(&[&draws[..], &["--seed", "1"]].concat());
    assert_ne!(with(&draws)["x_m"], other["x_m"]);
    assert_eq!(with(&["--vehicle-draws", "0"]), Value::Null);
    let printed = out(&args);
    assert!(
        printed.contains("over vehicles drawn from what the data sheet leaves open"),
        "{printed}"
    );
    assert!(printed.contains("variance of the end") && printed.contains("position"), "{printed}");
}

#[test]
fn a_forecast_is_wider_where_the_vehicle_is_not_known() {
    let folder = TempDir::new().unwrap();
    // The striking vehicle crosses slowly behind the struck one and does not meet it again.
    let scenario = folder.path().join("crossing.toml");
    let pit = fs::read_to_string("assets/scenarios/pit_right_rear.toml").unwrap();
    let crossing = pit.replace("heading_deg = 18", "heading_deg = 50");
    fs::write(&scenario, crossing.replace("speed_km_h = 62", "speed_m_s = 4")).unwrap();
    let predict = |draws: &str| {
        let into = folder.path().join(draws);
        let into: &Path = &into;
        json(&[
            "predict",
            "--scenario",
            scenario.to_str().unwrap(),
            "--given-force",
            "--vehicle",
            "generic-car",
            "--draws",
            "30",
            "--vehicle-draws",
            draws,
            "--duration",
            "2",
            "--out",
            into.to_str().unwrap(),
        ])
    };
    let (known, drawn) = (predict("0"), predict("30"));
    assert_eq!((&known["n_vehicles"], &drawn["n_vehicles"]), (&0.into(), &30.into()));
    assert_eq!(known["sensitivity"], Value::Array(Vec::new()));
    let width = |report: &Value, key: &str| {
        let ninety = &report["outcome"][key]["ninety"];
        ninety[1].as_f64().unwrap() - ninety[0].as_f64().unwrap()
    };
    assert!(width(&drawn, "x_m") > width(&known, "x_m"), "{drawn} {known}");
    assert!(drawn["sensitivity"][0]["position_share"].as_f64().unwrap() > 0.0, "{drawn}");
}

#[test]
fn a_scenario_names_its_vehicles() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("named.toml");
    let text = fs::read_to_string("assets/scenarios/pit_right_rear.toml").unwrap();
    let (head, rest) = text.split_once("mass_kg = 2000").unwrap();
    let (_, tail) = rest.split_once("speed_km_h").unwrap();
    let named = "vehicle = \"toyota-camry-2018\"\nspeed_km_h";
    fs::write(&path, format!("{head}{named}{tail}")).unwrap();
    let scenario = path.to_str().unwrap();
    let motion = json(&["simulate", "--scenario", scenario, "--vehicle-draws", "30"]);
    assert_eq!(motion["vehicle"], "Toyota Camry 2018");
    // Its inertia is an estimate, here as with --vehicle.
    let shares = motion["uncertainty"]["sensitivity"].as_array().unwrap();
    assert!(shares.iter().any(|share| share["quantity"] == "yaw_inertia"), "{shares:?}");
    let other = json(&["simulate", "--scenario", scenario, "--vehicle", "reference-2000"]);
    assert_eq!(other["vehicle"], "Reference car (multibody, 2000 kg)");
}

/// Every multibody car of the fleet was called by the name of one of them.
#[test]
fn a_multibody_car_is_called_by_its_file_or_its_folder() {
    let named = |dataset: &str| {
        let args = ["simulate", "--dataset", dataset, "--case"];
        let cases = std::fs::read_to_string(format!("{dataset}/cases.csv")).unwrap();
        let case = cases.lines().nth(1).unwrap().split(',').next().unwrap().to_owned();
        answer(&[&args[..], &[case.as_str()]].concat())["vehicle"].as_str().unwrap().to_owned()
    };
    assert_eq!(named("datasets/trajectories-fleet/buggy"), "buggy (multibody, 1120 kg)");
    assert_eq!(named("datasets/trajectories-fea"), "Reference car (multibody, 2000 kg)");
}

/// A 1:10 car was refused for the drag area of a car of full size, under a key that its sheet does not have.
#[test]
fn a_model_of_a_car_has_estimates_of_its_scale() {
    let folder = TempDir::new().unwrap();
    let model = sheet(
        &folder,
        "mass_kg = 4\nlength_m = 0.6\nwidth_m = 0.3\nwheelbase_m = 0.33\ncg_height_m = 0.07\n\
         yaw_inertia_kg_m2 = 0.05\nfriction = 1",
    );
    let steer = folder.path().join("steer.csv");
    fs::write(&steer, "t [s],steer [deg]\n0,0\n0.2,10\n2,10\n").unwrap();
    let steer = steer.to_str().unwrap();
    let args = ["--speed", "3", "--duration", "2", "--steer", steer, "--vehicle", &model];
    let report = json(&[&["simulate"][..], &args].concat());
    assert!(report["end"]["speed_m_s"].as_f64().unwrap() > 1.5, "{report}");
    let assumed = report["assumptions"].to_string();
    assert!(assumed.contains("in the scale of the width squared"), "{assumed}");
    // A force that does not say where it acts: on a car 1.5 m behind the CG, where no model of 0.6 m is.
    let force = folder.path().join("force.csv");
    fs::write(&force, "t [s],fx [N],fy [N]\n0,0,0\n0.01,0,60\n0.02,0,0\n").unwrap();
    let force = force.to_str().unwrap();
    let args = ["simulate", "--speed", "3", "--force", force, "--vehicle", &model];
    let assumed = json(&args)["assumptions"].to_string();
    let scale = 0.6 / Preset::Reference.parameters().geometry.outer_length_m;
    assert!(assumed.contains(&format!("x {:.3} m", -1.5 * scale)), "{assumed}");
}

/// The striking car of full size that stands in for one of 1:10 was far too light for its axles.
#[test]
fn a_collision_of_two_models_of_cars_is_predicted() {
    let folder = TempDir::new().unwrap();
    let model = sheet(
        &folder,
        "mass_kg = 4\nlength_m = 0.6\nwidth_m = 0.3\nwheelbase_m = 0.33\ncg_height_m = 0.07\n\
         yaw_inertia_kg_m2 = 0.05\nfriction = 1\nfront_overhang_m = 0.135\n\
         cg_to_front_axle_m = 0.165",
    );
    let body = |heading_deg: f64, speed_km_h: f64| {
        format!(
            "mass_kg = 4\nyaw_inertia_kg_m2 = 0.05\nlength_m = 0.6\nwidth_m = 0.3\n\
             cg_from_front_m = 0.3\nheading_deg = {heading_deg}\nspeed_km_h = {speed_km_h}\n"
        )
    };
    let scenario = folder.path().join("models.toml");
    let contact = "from = \"side\"\nside = \"right\"\noffset_m = -0.1\nrestitution = 0.15\n\
                   friction_limit = 0.4\n";
    let text = format!(
        "name = \"models\"\n[target]\n{}[bullet]\n{}[contact]\n{contact}",
        body(0.0, 10.0),
        body(18.0, 14.0)
    );
    fs::write(&scenario, text).unwrap();
    let scenario = scenario.to_str().unwrap();
    let report =
        json(&["simulate", "--scenario", scenario, "--vehicle", &model, "--duration", "1"]);
    // 10 km/h and the 1.1 km/h across that it gets: 2.8 m/s, which a second of rolling hardly slows.
    let speed_m_s = report["end"]["speed_m_s"].as_f64().unwrap();
    assert!((2.2..2.9).contains(&speed_m_s), "{speed_m_s}");
    // 0.52 m on cars of the length of the reference car; a model of 0.6 m was struck that high, too.
    let length_m = Preset::Reference.parameters().geometry.outer_length_m;
    let height = format!("{:.3} m above the ground", 0.52 * 0.6 / length_m);
    let assumed = report["assumptions"].to_string();
    assert!(assumed.contains(&height), "{height}: {assumed}");
    assert!(assumed.contains("that of cars, 0.52 m, at 1:"), "{assumed}");
    let folder = folder.path().join("prediction");
    let prediction = folder.to_str().unwrap();
    let few = ["--draws", "10", "--vehicle-draws", "10", "--duration", "1"];
    let args = ["predict", "--scenario", scenario, "--vehicle", &model, "--out", prediction];
    out(&[&args[..], &few].concat());
    assert!(folder.read_dir().unwrap().count() > 1);
}
