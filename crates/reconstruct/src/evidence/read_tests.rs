use impactlab_core::vehicle::Wheel;

use super::*;
use crate::evidence::{DEFAULT_FRICTION_SIGMA, ends};

const CASE: &str = r#"case = "B 27"

[road]
friction = 0.72

[struck_car]
mass_kg = 1520
mass_sigma_kg = 30
cg_to_front_axle_m = 1.25
cg_to_rear_axle_m = 1.45

[striking_car]
mass_lb = 4000

[damage]
side = "right"
x_m = -1.7
y_m = -0.9
angle_deg = 20

[rest]
x_m = 41.2
y_ft = -20
heading_deg = 170

[after]
blocked_wheels = ["RR"]
driver_braked = "unknown"

[[mark]]
wheel = "RR"
kind = "locked"
start_m = [1.0, -0.7]
points_m = [[1.0, -0.7], [6, -0.8]]

[edr]
delta_v_y_min_m_s = 1.0
delta_v_y_max_m_s = 1.3
speed_before_km_h = 72
sensor_x_m = 0.2
ends_s = 0.25

[[position]]
time_s = 1.2
x_m = 20.1
y_m = -2.0

[prior]
target_speed_km_h = [18, 180]

[[striking_mark]]
wheel = "FL"
points_m = [[10, 0], [20, 0]]

[striking_edr]
speed_before_km_h = 90
delta_v_y_min_m_s = -1.3
delta_v_y_max_m_s = -1.0
"#;

fn read(text: &str) -> Result<Evidence, String> {
    let file = TomlFile { path: Path::new("case.toml"), text };
    Evidence::from_toml(file).map_err(|error| error.to_string())
}

#[test]
fn a_file_is_read_with_units_and_defaults() {
    let evidence = read(CASE).unwrap();
    assert_eq!(evidence.road_friction().unwrap().sigma, DEFAULT_FRICTION_SIGMA);
    assert!((evidence.striking_car.mass().unwrap().value - 1814.4).abs() < 0.1);
    let rest = evidence.rest.unwrap();
    assert!((rest.y_m.unwrap() + 6.096).abs() < 1e-9);
    assert_eq!((rest.position_sigma_m, rest.position_sigma_m()), (None, 0.15));
    assert!((rest.heading().unwrap().value - 170_f64.to_radians()).abs() < 1e-9);
    assert_eq!(evidence.after.blocked_wheels, Some(vec![Wheel::RearRight]));
    assert_eq!(evidence.marks[0].points_m, [[1.0, -0.7], [6.0, -0.8]]);
    assert_eq!((evidence.marks[0].sigma_m, evidence.marks[0].sigma_m()), (None, 0.1));
    let edr = evidence.recorder();
    assert_eq!(edr.delta_v_y(), Some([1.0, 1.3]));
    let speed = edr.speed_before().unwrap();
    assert!((speed.value - 20.0).abs() < 1e-9 && speed.sigma == 0.04 * speed.value);
    assert_eq!(edr.sensor_m, [Some(0.2), None]);
    assert_eq!(evidence.positions[0].sigma_m, None);
    let [mark] = &evidence.striking_marks[..] else { panic!("one mark") };
    assert!(mark.points_m == [[10.0, 0.0], [20.0, 0.0]] && mark.wheel == Wheel::FrontLeft);
    let edr = evidence.striking_edr.unwrap();
    assert!((edr.speed_before().unwrap().value - 25.0).abs() < 1e-9);
    assert_eq!(edr.delta_v_y(), Some([-1.3, -1.0]));
    let [low, high] = ends(evidence.prior.struck_speed_m_s).unwrap();
    assert!((low - 5.0).abs() < 1e-9 && (high - 50.0).abs() < 1e-9);
    assert_eq!(evidence.mirrored().mirrored(), evidence);
    assert_ne!(evidence.mirrored(), evidence);
    let moved = CASE.replace("[rest]", "[rest]\nknown = false");
    assert_eq!(read(&moved).unwrap().rest, None);
}

#[test]
fn an_error_names_file_line_key_and_what_is_expected() {
    for (good, bad, expected) in [
        ("friction = 0.72", "friction = 3", "4: road.friction is 3, expected 0.01 to 2"),
        (
            "friction = 0.72",
            "friction = 70",
            "4: road.friction is 70, expected 0.01 to 2; is it friction_percent?",
        ),
        ("mass_sigma_kg = 30", "mass_sigma_kg = 0", "8: struck_car.mass_sigma_kg is 0, expected"),
        ("x_m = 41.2", "x_m = 5000", "22: rest.x_m is 5000, expected -2000 to 2000"),
        ("heading_deg = 170", "heading_deg = 170\nheading_sigma_rad = 0", "25: rest.heading_sigma"),
        ("case =", "cases =", "1: cases is not known here"),
        ("side = \"right\"", "side = \"top\"", "16: damage.side is \"top\", expected \"left\" or"),
        ("side = \"right\"", "", "15: damage.side is missing"),
        ("x_m = -1.7", "", "15: damage.x_m is missing"),
        ("[damage]", "[weighing]\n[damage]", "15: weighing.shared_scale_sigma is missing"),
        ("y_m = -0.9", "y_m = 0.9", "18: damage.y_m is 0.9, expected a point on the right"),
        ("cg_to_rear_axle_m = 1.45", "", "6: struck_car.cg_to_rear_axle_m is missing"),
        ("x_m = 41.2", "", "21: rest.x_m is missing"),
        ("[\"RR\"]", "[\"RR\", \"RR\"]", "27: after.blocked_wheels is \"RR\", expected a list"),
        ("[\"RR\"]", "\"RR\"", "27: after.blocked_wheels is \"RR\", expected a list"),
        ("\"unknown\"", "\"perhaps\"", "28: after.driver_braked is \"perhaps\""),
        ("wheel = \"RR\"", "wheel = \"R\"", "31: mark[0].wheel is \"R\", expected \"FL\""),
        ("kind = \"locked\"", "kind = 1", "32: mark[0].kind is 1, expected \"side-slip\""),
        (", [6, -0.8]]", "]", "34: mark[0].points_m is [[1.0, -0.7]], expected at least two"),
        ("[6, -0.8]", "[6]", "34: mark[0].points_m is [6], expected points [x, y]"),
        ("[6, -0.8]", "[6, nan]", "34: mark[0].points_m is [6, nan], expected points"),
        ("start_m = [1.0, -0.7]", "start_m = [2, 0]", "34: mark[0].points_m is [[1.0,"),
        ("y_max_m_s = 1.3", "y_max_m_s = 0.3", "38: edr.delta_v_y_max_m_s is 0.3, expected"),
        ("delta_v_y_max_m_s = 1.3", "", "36: edr.delta_v_y_max_m_s is missing"),
        ("ends_s = 0.25", "ends_s = 0", "41: edr.ends_s is 0, expected 0.005 to 5 s"),
        (
            "ends_s = 0.25",
            "ends_s = 250",
            "41: edr.ends_s is 250, expected 0.005 to 5 s; is it ends_ms?",
        ),
        ("time_s = 1.2", "", "43: position[0].time_s is missing"),
        ("[18, 180]", "[180, 18]", "49: prior.target_speed_km_h is [180, 18], expected the low"),
        ("[18, 180]", "[18, 1800]", "49: prior.target_speed_km_h is 1800, expected 0 to 540"),
        ("[18, 180]", "18", "49: prior.target_speed_km_h is 18, expected the lower and"),
        ("[[mark]]", "[mark]", "30: mark is "),
        ("wheel = \"FL\"", "wheel = 1", "52: striking_mark[0].wheel is 1, expected \"FL\""),
        (", [20, 0]]", "]", "53: striking_mark[0].points_m is [[10, 0]], expected at least two"),
        (
            "speed_before_km_h = 90",
            "speed_before_km_h = -1",
            "56: striking_edr.speed_before_km_h is -1",
        ),
        ("delta_v_y_max_m_s = -1.0", "", "55: striking_edr.delta_v_y_max_m_s is missing"),
        (
            "[striking_edr]",
            "[striking_edr]\nspeed_km_h = 3",
            "56: striking_edr.speed_km_h is not known",
        ),
        ("[striking_car]", "[struck]", "1: [striking_car] is missing"),
    ] {
        assert!(CASE.contains(good), "{good}");
        let error = read(&CASE.replacen(good, bad, 1)).unwrap_err();
        let (line, message) = expected.split_once(": ").unwrap();
        let is_there = error.starts_with(&format!("case.toml:{line}:")) && error.contains(message);
        assert!(is_there, "{error}\n{expected}");
    }
}

/// Evidence with the record of a recorder alone, to which another car's is added.
#[test]
fn a_draft_may_lack_what_a_reconstruction_needs_and_nobody_invents_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("draft.toml");
    let draft = |text: &str| {
        std::fs::write(&path, text).unwrap();
        Evidence::load_draft(&path).map_err(|error| error.to_string())
    };
    let edr = "[edr]\nspeed_before_km_h = 72\n";
    let found = draft(edr).unwrap();
    assert_eq!((found.damage.side, found.damage.along_m), (None, None));
    let text = found.to_toml();
    assert!(!text.contains("side"), "{text}");
    assert_eq!(draft(&text).unwrap(), found);
    let lack = found.missing().unwrap_or_default();
    assert!(lack.contains("damage of the struck car"), "{lack}");
    assert!(read(&text).unwrap_err().contains("damage.side is missing"), "{text}");
    // What is said is kept, and a slip is one in a draft, too.
    let sided = draft(&format!("{edr}[damage]\nside = \"front\"\n")).unwrap();
    assert_eq!(sided.damage.side, Some(impactlab_core::collision::Side::Front));
    assert!(sided.to_toml().contains("side = \"front\""));
    let slip = draft(&format!("{edr}[damage]\nsite = \"front\"\n")).unwrap_err();
    assert!(slip.contains("damage.site is not known"), "{slip}");
    assert_eq!(draft(CASE).unwrap(), read(CASE).unwrap());
}

#[test]
fn a_mark_that_stands_twice_is_refused() {
    let mark = "[[mark]]\nwheel = \"RR\"\nkind = \"locked\"\npoints_m = [[1.0, -0.7], [6, -0.8]]\n";
    let error = read(&format!("{CASE}\n{mark}")).unwrap_err();
    assert!(error.contains("number 2 is number 1 again"), "{error}");
    let other = mark.replace("-0.8", "-0.9");
    assert_eq!(read(&format!("{CASE}\n{other}")).unwrap().marks.len(), 2);
}

/// A standard deviation of the size of the program's is one that was stated.
#[test]
fn what_is_stated_differs_from_what_the_program_takes() {
    let stated = CASE
        .replace("y_ft = -20", "y_ft = -20\nposition_sigma_m = 0.15")
        .replace("kind = \"locked\"", "kind = \"locked\"\nsigma_m = 0.10");
    let evidence = read(&stated).unwrap();
    assert_eq!(evidence.rest.unwrap().position_sigma_m, Some(0.15));
    assert_eq!(evidence.marks[0].sigma_m, Some(0.1));
    assert_eq!(evidence.damage.along_m.unwrap().sigma, None);
}

#[test]
fn evidence_in_json_of_an_earlier_version_is_read() {
    let evidence = read(CASE).unwrap();
    let mut json = serde_json::to_value(&evidence).unwrap();
    json["rest"]["position_sigma_m"] = 0.15.into();
    json["edr"] = serde_json::json!({
        "delta_v_x_m_s": null,
        "delta_v_y_m_s": [1.0, 1.3],
        "speed_before_m_s": { "value": 20.0, "sigma": 0.8 },
        "sensor_m": [0.0, 0.0],
        "ends_s": null,
    });
    let found: Evidence = serde_json::from_value(json.clone()).unwrap();
    assert_eq!(found.recorder().speed_before().unwrap().sigma, 0.8);
    json["edr"] = serde_json::json!({
        "delta_v_x_m_s": null,
        "delta_v_y_m_s": null,
        "speed_before_m_s": null,
        "sensor_m": [0.0, 0.0],
        "ends_s": null,
    });
    let [marks, edr] = ["striking_marks", "striking_edr"];
    let fields = json.as_object_mut().unwrap();
    assert!(fields.remove(marks).is_some() && fields.remove(edr).is_some());
    let found: Evidence = serde_json::from_value(json).unwrap();
    assert_eq!(found.edr, None);
    assert_eq!((found.striking_marks, found.striking_edr), (Vec::new(), None));
}

/// The home folder stood in the title of a report, of pictures and of drawings.
#[test]
fn evidence_without_a_name_is_called_by_its_file_and_not_by_its_path() {
    let path = Path::new("/home/ann/cases/crossing.toml");
    let text = format!("{SINGLE}[[mark]]\nwheel = \"FL\"\npoints_m = [[0, 0], [9, 0]]\n");
    let named = |text: &str| Evidence::from_toml(TomlFile { path, text }).unwrap().case;
    assert_eq!(named(&text), "crossing.toml");
    assert_eq!(named(&format!("case = \"/ a\"\n{text}")), "/ a");
}

const SINGLE: &str = "kind = \"single_car\"\n[car]\nmass_kg = 1500\n";

#[test]
fn a_single_car_has_nothing_of_an_impact_and_says_where_it_was() {
    let error = |rest: &str| {
        let text = format!("{SINGLE}{rest}");
        let file = TomlFile { path: Path::new("case.toml"), text: &text };
        Evidence::from_toml(file).unwrap_err().to_string()
    };
    let mark = "[[mark]]\nwheel = \"FL\"\npoints_m = [[0, 0], [9, 0]]\n";
    let edr = format!("{mark}[edr]\ndelta_v_x_min_m_s = 1\ndelta_v_x_max_m_s = 2\n");
    for (rest, parts) in [
        (edr.as_str(), ["case.toml:", "edr", "no Δv without an impact"]),
        ("[damage]\nside = \"left\"\nx_m = 0\n", ["case.toml:", "damage", "strikes nothing"]),
        ("[striking_car]\nmass_kg = 1500\n", ["case.toml:", "striking_car", "strikes nothing"]),
        ("[[striking_mark]]\nwheel = \"FL\"\n", ["case.toml:", "striking_mark", "strikes nothing"]),
        ("[struck_car]\n", ["case.toml:", "struck_car", "[car]"]),
        ("[after]\n", ["case.toml:", "after", "[wheels]"]),
        ("[prior]\n", ["case.toml:", "prior", "[start]"]),
        ("[rest]\nx_m = 9\ny_m = 0\n", ["case.toml:", "start.x_m", "missing"]),
        ("[start]\nx_m = 0\n", ["case.toml:", "start.y_m", "missing"]),
    ] {
        let error = error(rest);
        assert!(parts.iter().all(|part| error.contains(part)), "{rest}: {error}");
    }
    let evidence = read(&format!("{SINGLE}{mark}")).unwrap();
    assert!(evidence.is_single_car() && evidence.missing().is_none());
    assert_eq!(read(&evidence.to_toml()).unwrap(), evidence, "{}", evidence.to_toml());
    // What no file says is refused, too.
    let with_damage = Evidence { damage: read(CASE).unwrap().damage, ..evidence.clone() };
    let lack = with_damage.missing().unwrap_or_default();
    assert!(
        lack.contains("damage of the struck car") && lack.contains("strikes nothing"),
        "{lack}"
    );
    let with_record = Evidence { edr: read(CASE).unwrap().edr, ..evidence };
    let lack = with_record.missing().unwrap_or_default();
    assert!(lack.contains("event data recorder"), "{lack}");
}

#[test]
fn a_collision_has_nothing_of_a_single_car() {
    for (table, hint) in [("start", "single_car"), ("wheels", "[after]"), ("car", "[struck_car]")] {
        let text = format!("{CASE}\n[{table}]\n");
        let file = TomlFile { path: Path::new("case.toml"), text: &text };
        let error = Evidence::from_toml(file).unwrap_err().to_string();
        assert!(error.contains(table) && error.contains(hint), "{error}");
    }
    let start = crate::evidence::Start { x_m: Some(0.0), y_m: Some(0.0), ..Default::default() };
    let lack = Evidence { start, ..read(CASE).unwrap() }.missing().unwrap_or_default();
    assert!(lack.contains("car at the start"), "{lack}");
}
