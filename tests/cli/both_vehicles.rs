//! Two vehicles of a scenario through all contacts.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use serde_json::Value;
use tempfile::TempDir;

use crate::answers::write;
use crate::commands::impactlab;
use crate::program::{SCENARIO, answer, text};

fn number(value: &Value, place: &str) -> f64 {
    value.pointer(place).and_then(Value::as_f64).unwrap_or_else(|| panic!("{place}: {value}"))
}

fn interval(value: &Value, place: &str) -> [f64; 2] {
    let intervals = value.pointer(place).and_then(|of| of["intervals"].as_array()).unwrap();
    let ninety = intervals.iter().find(|of| of["level"] == 0.9).unwrap();
    ["low", "high"].map(|end| ninety[end].as_f64().unwrap())
}

#[test]
fn a_forecast_follows_both_vehicles_and_says_what_may_become_of_the_struck_one() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let ask = |more: &[&str]| {
        let usual = ["predict", "--scenario", SCENARIO, "--draws", "40", "--out", text(&out)];
        answer(&usual.iter().chain(&["--overwrite"]).chain(more).copied().collect::<Vec<_>>())
    };
    let both = ask(&[]);
    let courses = both["courses"].as_array().unwrap();
    let sum: f64 = courses.iter().map(|course| course["probability"].as_f64().unwrap()).sum();
    assert!((sum - 1.0).abs() < 1e-9 && courses.len() > 1, "{courses:?}");
    assert_eq!(both["flags"], Value::Array(Vec::new()));
    let contacts = &both["contacts"];
    assert!(number(contacts, "/long_contact_probability") > 0.8, "{contacts}");
    let share = number(contacts, "/later_impulse_share/median");
    assert!((0.2..0.95).contains(&share), "a push goes on: {share}");
    assert_eq!(number(contacts, "/in_contact/0/probability"), 1.0, "{contacts}");
    let first = &contacts["phases"][0];
    for vehicle in ["struck", "striking"] {
        assert!(number(first, &format!("/{vehicle}/delta_v_m_s/median")) > 1.0, "{first}");
    }
    // Pushed from the right; pushed back from the left front.
    let clockwise = |place: &str| number(first, place).rem_euclid(std::f64::consts::TAU);
    assert!((1.0..2.6).contains(&clockwise("/struck/pdof_rad/median")), "{first}");
    assert!((4.5..6.3).contains(&clockwise("/striking/pdof_rad/median")), "{first}");
    for place in ["/outcome/x_m", "/striking/outcome/x_m"] {
        let [low, high] = interval(&both, place);
        assert!(high > low + 1.0 && low > 10.0, "{place}: {low} {high}");
    }
    let single = ask(&["--one-contact"]);
    assert!(single["contacts"].is_null() && single["striking"].is_null(), "{single}");
    assert_eq!(single["flags"][0]["kind"], "second_contact");
    assert_eq!(ask(&[])["courses"], both["courses"], "same seed");
    // The striking vehicle counts where it is followed, and draws are made under a given force, too.
    assert!(both["caveats"].to_string().contains("bullet-2000"), "{both}");
    assert!(!single["caveats"].to_string().contains("bullet-2000"), "{single}");
    let given = ask(&["--given-force"])["caveats"].to_string();
    assert!(!given.contains("number of drawn forces"), "{given}");
}

#[test]
fn a_simulation_tells_every_phase_of_contact() {
    let both = answer(&["simulate", "--scenario", SCENARIO]);
    let phase = &both["contacts"][0];
    let impulse = |of: &Value| number(of, "/impulse_n_s/0").hypot(number(of, "/impulse_n_s/1"));
    let momentum = answer(&["impact", SCENARIO]);
    assert!(impulse(phase) > 1.2 * number(&momentum, "/impulse_magnitude_n_s"), "{phase}");
    let single = answer(&["simulate", "--one-contact", "--scenario", SCENARIO]);
    assert_eq!(single["contacts"], Value::Array(Vec::new()));
    assert!(number(&single, "/end/x_m") != number(&both, "/end/x_m"));
    let euler = answer(&["simulate", "--integrator", "euler", "--scenario", SCENARIO]);
    assert_eq!(euler["end"], both["end"]);
    assert!(euler["caveats"].to_string().contains("method of integration"), "{euler}");
}

/// What nobody said of a driver or a system is drawn, and the answer says so.
#[test]
fn drivers_and_systems_act_in_a_forecast_and_are_drawn() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let notes = |more: &[&str]| {
        let usual = ["predict", "--scenario", SCENARIO, "--draws", "12", "--out", text(&out)];
        let all: Vec<&str> = usual.iter().chain(&["--overwrite"]).chain(more).copied().collect();
        answer(&all)["caveats"].to_string()
    };
    let plain = notes(&[]);
    assert!(!plain.contains("stability control"), "{plain}");
    let controlled = notes(&["--esc", "--countersteer"]);
    for words in ["stability control: threshold 4 to 8", "countersteering: after 0.4 to 1.8 s"] {
        assert!(controlled.contains(words), "{words}: {controlled}");
    }
    // The usual reaction time is stated, and therefore not drawn.
    let stated = notes(&["--countersteer", "0.8"]);
    assert!(stated.contains("countersteering: at most 180 to 540 deg"), "{stated}");
    assert!(!stated.contains("after 0.4 to 1.8 s"), "{stated}");
}

/// The assumption told to name another one by an option that `simulate` alone had.
#[test]
fn the_striking_vehicle_of_a_forecast_is_the_one_that_is_named() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let ask = |more: &[&str]| {
        let usual = ["predict", "--scenario", SCENARIO, "--draws", "8", "--out", text(&out)];
        answer(&usual.iter().chain(&["--overwrite"]).chain(more).copied().collect::<Vec<_>>())
    };
    let assumed = |report: &Value| report["assumptions"].to_string().contains("--bullet");
    let [open, named] = [&[][..], &["--bullet", "ford-explorer-2004"]].map(ask);
    assert!(assumed(&open) && !assumed(&named), "{named}");
    assert_ne!(open["striking"], named["striking"], "its tires carry it elsewhere");
    let refused =
        impactlab(&["predict", "--dataset", "datasets/fea", "--case", "c001", "--bullet", "x"]);
    assert!(refused.code != 0 && refused.err.contains("cannot be used with"), "{}", refused.err);
}

#[test]
fn a_test_against_a_barrier_says_how_stiff_a_face_is_and_a_vehicle_file_takes_it() {
    let folder = TempDir::new().unwrap();
    let test = ["stiffness", "--mass", "1719", "--width", "1.837", "--speed", "57.09km/h"];
    let crush = ["--crush", "380mm,466mm,511mm,518mm,489mm,370mm"];
    let ask = |more: &[&str]| impactlab(&[&test[..], &crush[..], more].concat());
    let found: Value = serde_json::from_str(&ask(&["--json"]).out).unwrap();
    assert!((number(&found, "/onset_n_per_m") / 604e2 - 1.0).abs() < 2e-3, "{found}");
    assert!((number(&found, "/stiffness_n_per_m2") / 78e4 - 1.0).abs() < 2e-3, "{found}");
    let section = ask(&["--face", "side"]).out;
    assert!(section.starts_with("[crush.side]\nonset_n_per_m = 60"), "{section}");
    let soft = "[crush.side]\nonset_n_per_m = 2000\nstiffness_n_per_m2 = 30000\n";
    let end = |crush: &str| {
        let file = impactlab(&["vehicles", "reference-2000"]).out + "\n" + crush;
        let vehicle = write(&folder, "car.toml", &file);
        answer(&["simulate", "--scenario", SCENARIO, "--vehicle", text(&vehicle)])["end"].clone()
    };
    assert_ne!(end(soft), end(&section), "the stiffness of the struck side counts");
    for (wrong, words) in [
        (&["--crush", "1,2,3"][..], "3 depths, expected 6"),
        (&["--crush", "0,0,0,0,0,0"], "mean crush is 0, expected more than 0"),
        (&["--crush", "0.1,0.1,0.1,0.1,0.1,9"], "crush depth is 9 m"),
    ] {
        let ran = impactlab(&[&test[..], wrong].concat());
        assert!(ran.code != 0 && ran.err.contains(words), "{wrong:?}: {}", ran.err);
    }
}

/// Of five draws asked for, “draw 6 of the forecast” was the first of the striking vehicle.
#[test]
fn draws_of_each_vehicle_are_named_as_its_own_in_the_numbers_of_a_scene() {
    let folder = TempDir::new().unwrap();
    let csv = folder.path().join("scene.csv");
    let scene = ["render", "scene", "pit-right-rear", "--time", "1", "--ghosts", "2", "--out"];
    answer(&[&scene[..], &[text(&csv)]].concat());
    let numbers = std::fs::read_to_string(&csv).unwrap();
    for whose in ["the forecast", "the striking vehicle"] {
        for (number, is_there) in [(1, true), (2, true), (3, false)] {
            let name = format!("\ndraw {number} of {whose},");
            assert_eq!(numbers.contains(&name), is_there, "{name}");
        }
    }
}
