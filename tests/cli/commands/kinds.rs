//! What a file is said to be, and what it was taken for.

use super::*;

#[test]
fn a_file_of_another_kind_is_called_what_it_is() {
    let evidence = "assets/examples/reconstruction.toml";
    let vehicle = "assets/vehicles/target-2000.toml";
    let site = "assets/sites/country-road/site.toml";
    let scenario = "assets/scenarios/pit_right_rear.toml";
    let case = "assets/examples/pit.impactlab";
    for (args, expected) in [
        (&["impact", evidence][..], "is the evidence of a reconstruction, expected a scenario"),
        (&["impact", case], "is a case, expected a scenario"),
        (&["reconstruct", scenario], "is a scenario, expected the evidence of a reconstruction"),
        (&["simulate", "--scenario", vehicle], "is a vehicle, expected a scenario"),
        (&["reconstruct", evidence, "--vehicle", site], "is a site, expected a vehicle"),
        (&["reconstruct", evidence, "--site", vehicle], "is a vehicle, expected a site"),
    ] {
        let ran = impactlab(args);
        assert_eq!(ran.code, 1, "{args:?}: {}", ran.err);
        assert!(ran.err.contains(expected), "{args:?}: {}", ran.err);
    }
    // One that is not there is not said to be of another kind.
    let ran = impactlab(&["impact", "no-such.impactlab"]);
    assert!(!ran.err.contains("is a case"), "{}", ran.err);
}

/// The evidence that comes with the program was refused as a bad vehicle.
#[test]
fn check_recognises_every_kind_of_file_by_its_content() {
    for (path, kind, name) in [
        ("assets/examples/reconstruction.toml", "evidence", "example"),
        ("assets/examples/pit.impactlab", "case", "pit"),
        (SCENARIO, "scenario", "PIT, right rear quarter"),
        ("assets/vehicles/target-2000.toml", "vehicle", "FEA target (2000 kg)"),
        ("assets/models/force.safetensors", "network", "force"),
        ("assets/models/response.toml", "settings", "response"),
    ] {
        let ran = impactlab(&["check", "--json", path]);
        assert_eq!(ran.code, 0, "{path}: {}{}", ran.out, ran.err);
        let model = &ran.json()["models"][0];
        assert_eq!((&model["kind"], &model["name"]), (&kind.into(), &name.into()), "{path}");
    }
}

#[test]
fn check_says_what_a_bad_file_was_taken_for() {
    let folder = TempDir::new().unwrap();
    let shipped = |path: &str| fs::read_to_string(path).unwrap();
    let evidence = shipped("assets/examples/reconstruction.toml");
    let vehicle = shipped("assets/vehicles/target-2000.toml");
    let scenario = shipped(SCENARIO);
    for (text_of_file, kind, message) in [
        (evidence.replace("mass_kg = 1530", "mass_kg = -1"), "evidence", "a reconstruction"),
        (vehicle.replace("friction = 0.8", "friction = = 0.8"), "vehicle", "a vehicle"),
        (scenario.replace("[contact]", "[contract]"), "scenario", "a scenario"),
        (
            "colour = \"red\"\n".to_owned(),
            "unknown_toml",
            "is neither evidence (struck_car, damage)",
        ),
    ] {
        let file = write(&folder, "f.toml", &text_of_file);
        let ran = impactlab(&["check", "--json", text(&file)]);
        assert_eq!(ran.code, 1, "{kind}: {}", ran.out);
        let problem = &ran.json()["problems"][0];
        assert_eq!(problem["kind"], kind, "{problem}");
        assert!(problem["message"].as_str().unwrap().contains(message), "{problem}");
    }
}

/// A friction that is misspelt was left out, and the answer was that of another road.
#[test]
fn a_question_with_a_key_that_it_does_not_have_is_refused() {
    let folder = TempDir::new().unwrap();
    let drive = "{\"question\": \"simulate\", \"source\": {\"drive\": {\"speed_m_s\": 20";
    for (key, rest) in
        [("frictoin", "}}, \"frictoin\": 0.3}"), ("speed_km_h", ", \"speed_km_h\": 9}}}")]
    {
        let wrong = write(&folder, "wrong.json", &format!("{drive}{rest}"));
        let ran = impactlab(&["ask", text(&wrong)]);
        let error = ran.error_line();
        assert!(error.contains(&format!("unknown field `{key}`")), "{}", ran.err);
    }
}
