//! Tests of scenario files.

use super::*;

const PIT: &str = include_str!("../../../../assets/scenarios/pit_right_rear.toml");

fn read(text: &str) -> Result<Scenario, TomlError> {
    Scenario::from_toml(text, Path::new("scenario.toml"))
}

/// The error message for the shipped scenario with one line replaced.
fn refusal(line: &str, instead: &str) -> String {
    assert!(PIT.contains(line), "{line}");
    read(&PIT.replacen(line, instead, 1)).unwrap_err().to_string()
}

#[test]
fn units_are_in_the_keys() {
    let pit = read(PIT).unwrap();
    assert!((pit.struck.vx_world_m_s - 15.0).abs() < 1e-12, "{pit:?}");
    assert!((pit.striking.heading_rad - 18_f64.to_radians()).abs() < 1e-15, "{pit:?}");
    let speed = pit.striking.vx_world_m_s.hypot(pit.striking.vy_world_m_s);
    assert!((speed * 3.6 - 62.0).abs() < 1e-9, "{pit:?}");
    for (key, value) in [
        ("speed_m_s", "15"),
        ("speed_mph", "33.554044380816"),
        ("vy_m_s = 0\nvx_km_h", "54.0"),
        ("speed_m_s", "0xF"),
    ] {
        let text = PIT.replacen("speed_km_h = 54", &format!("{key} = {value}"), 1);
        let other = read(&text).unwrap();
        assert!((other.struck.vx_world_m_s - 15.0).abs() < 1e-9, "{key}: {other:?}");
    }
}

#[test]
fn a_named_vehicle_gives_what_the_scenario_does_not() {
    let (head, rest) = PIT.split_once("mass_kg = 2000").unwrap();
    let (_, tail) = rest.split_once("speed_km_h").unwrap();
    let named = "vehicle = \"toyota-camry-2018\"\n";
    let scenario = read(&format!("{head}{named}speed_km_h{tail}")).unwrap();
    let camry = built_in_vehicle("toyota-camry-2018").unwrap();
    assert_eq!(scenario.struck_vehicle.as_deref(), Some("toyota-camry-2018"));
    assert_eq!(scenario.struck.mass_kg, camry.mass.mass_kg);
    assert_eq!(scenario.struck.yaw_inertia_kg_m2, camry.mass.yaw_inertia_kg_m2);
    assert_eq!(scenario.struck.length_m, camry.geometry.outer_length_m);
    assert_eq!(read(&scenario.to_toml()).unwrap(), scenario);
    // The inertia follows the mass that the scenario gives.
    let heavy = read(&format!("{head}{named}mass_kg = 1900\nspeed_km_h{tail}")).unwrap();
    let ratio = heavy.struck.yaw_inertia_kg_m2 / camry.mass.yaw_inertia_kg_m2;
    assert!((ratio - 1900.0 / camry.mass.mass_kg).abs() < 1e-9, "{heavy:?}");
    let error = read(&format!("{head}vehicle = \"camry\"\nspeed_km_h{tail}")).unwrap_err();
    let error = error.to_string();
    assert!(error.starts_with("scenario.toml:7:11: target.vehicle is \"camry\", expected a veh"));
}

#[test]
fn a_refusal_names_file_place_key_value_and_range() {
    for (line, instead, expected) in [
        ("mass_kg = 2000", "mass_kg = -3", "7:11: target.mass_kg is -3, expected 1 to 1e8 kg"),
        (
            "speed_km_h = 54",
            "speed_mph = 1e3",
            "13:13: target.speed_mph is 1e3, expected -335.5 to 335.5 mph",
        ),
        (
            "cg_from_front_m = 2.35",
            "cg_from_front_m = 5.0",
            "11:19: target.cg_from_front_m is 5.0, expected 0 to 4.9 m",
        ),
        ("width_m = 1.85", "width_m = nan", "10:11: target.width_m is nan, expected 0.05 to 20 m"),
        (
            "width_m = 1.85",
            "width_m = \"wide\"",
            "10:11: target.width_m is \"wide\", expected 0.05 to 20 m",
        ),
        ("length_m", "lenght_m", "6:2: target.length_m is missing"),
        ("heading_deg", "haeding_deg", "12:1: target.haeding_deg is not known here"),
        (
            "speed_km_h = 54",
            "speed_km_h = 54\nspeed_m_s = 15",
            "13:1: target.speed_km_h and speed_m_s say the same thing, expected one",
        ),
        (
            "speed_km_h = 54",
            "speed_km_h = 54\nvx_m_s = 15",
            "14:1: target.vx_m_s and speed_km_h say the same thing, expected one",
        ),
        ("speed_km_h = 54", "vx_m_s = 15", "6:2: target.vy_m_s is missing"),
        (
            "speed_km_h = 54",
            "speed_kmh = 54",
            "6:2: target.speed_m_s (or vx_m_s and vy_m_s), instead of speed_kmh, is missing",
        ),
        (
            "restitution = 0.15",
            "restitution_form = \"newton\"",
            "28:20: contact.restitution_form is \"newton\", expected \"normal\" or \
             \"common_velocity\"",
        ),
        (
            "friction_limit = 0.4",
            "friction_of_critical_percent = 101",
            "29:32: contact.friction_of_critical_percent is 101, expected 0 to 100 %",
        ),
        (
            "friction_limit = 0.4",
            "friction_limit = 0.4\nfriction_of_critical = 0.5",
            "30:1: contact.friction_of_critical and friction_limit say the same thing, \
             expected one",
        ),
        ("[contact]", "[kontact]", "1:1: [contact] is missing"),
        (
            "side = \"right\"",
            "side = \"starboard\"",
            "26:8: contact.side is \"starboard\", expected \"front\" or \"left\" or \"rear\" or \
             \"right\"",
        ),
        ("mass_kg = 2000", "mass_kg = ", "7:11: "),
    ] {
        let error = refusal(line, instead);
        let expected = format!("scenario.toml:{expected}");
        assert!(error.starts_with(&expected), "{error}\n{expected}");
    }
}

#[test]
fn friction_is_a_limit_or_a_share_of_the_critical_impulse_ratio() {
    let given = read(&PIT.replacen("friction_limit = 0.4", "friction_of_critical_percent = 80", 1));
    let given = given.unwrap();
    assert!((given.contact.friction_of_critical.unwrap() - 0.8).abs() < 1e-12, "{given:?}");
    let impact = given.impact().unwrap();
    let critical = impact.critical_impulse_ratio().unwrap();
    let solution = given.solve().unwrap();
    let ratio = solution.impulse_tangential_n_s.abs() / solution.impulse_normal_n_s;
    assert!((ratio / critical - 0.8).abs() < 1e-12, "{ratio} of {critical}");
    assert_eq!(read(&given.to_toml()).unwrap(), given);
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = Scenario::load(Path::new("no/such/scenario.toml")).unwrap_err();
    assert_eq!(error.to_string(), "no/such/scenario.toml: does not exist; check the name");
}
