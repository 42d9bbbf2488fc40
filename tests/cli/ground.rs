//! Site files on the command line: checked, simulated over, drawn.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::program::{json, ok, program, text};

const SITE: &str = "assets/sites/country-road/site.toml";

/// A site that is ice all over.
fn icy(folder: &Path, friction: f64) -> String {
    let path = folder.join("ice.toml");
    let border = "[[-500, -500], [500, -500], [500, 500], [-500, 500]]";
    let zone =
        format!("[[friction_zone]]\nname = \"ice\"\nborder_m = {border}\nfriction = {friction}\n");
    fs::write(&path, zone).unwrap();
    text(&path).to_owned()
}

#[test]
fn check_says_what_a_site_consists_of() {
    let out = ok(program().args(["check", SITE, "--json"]).output().unwrap());
    let model = json(&out)["models"][0].clone();
    assert_eq!(model["kind"], "site");
    assert_eq!(model["name"], "Country road, synthetic");
    let contents = model["contents"].to_string();
    for part in [
        "orthophoto of 1680 x 840 pixels of 0.0800 m, X ",
        "world file in m",
        "2 lanes",
        "2 friction zones",
        "drawing edges.dxf in m, ",
    ] {
        assert!(contents.contains(part), "{contents}");
    }
    let printed = ok(program().args(["check", SITE]).output().unwrap());
    let expected = "site\nname      Country road, synthetic\ncontents  orthophoto of";
    assert!(printed.contains(expected), "{printed}");
}

#[test]
fn a_wrong_site_is_an_error_with_its_place() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("site.toml");
    fs::write(&path, "[[friction_zone]]\nname = \"ice\"\nfriction = 3\nborder_m = []\n").unwrap();
    let simulate = ["simulate", "--scenario", "pit-right-rear", "--site", text(&path)];
    let output = program().args(simulate).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1));
    let expected = "site.toml:3:12: friction_zone[0].friction is 3, expected 0.01 to 2";
    assert!(error.contains(expected), "{error}");
}

#[test]
fn a_ground_that_lies_elsewhere_is_said_to_do_so() {
    let folder = TempDir::new().unwrap();
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sites/country-road");
    for name in ["site.toml", "edges.dxf", "orthophoto.jpg", "orthophoto.jgw"] {
        fs::copy(assets.join(name), folder.path().join(name)).unwrap();
    }
    let path = folder.path().join("site.toml");
    let site = fs::read_to_string(&path).unwrap();
    let out = folder.path().join("out.dxf");
    let notes = || {
        let args = ["export", "pit-right-rear", "--site", text(&path), "--out", text(&out)];
        let printed = ok(program().args(args).args(["--overwrite", "--json"]).output().unwrap());
        json(&printed)["notes"].to_string()
    };
    assert!(!notes().contains("away from the scene"), "{}", notes());
    // Everything is in survey coordinates, which nothing is subtracted from any more.
    let (start, end) = (site.find("[origin]").unwrap(), site.find("[orthophoto]").unwrap());
    fs::write(&path, format!("{}{}", &site[..start], &site[end..])).unwrap();
    let far = notes();
    for name in ["orthophoto.jpg: lies 5447", "edges.dxf: lies 5447"] {
        assert!(far.contains(name), "{name}: {far}");
    }
}

#[test]
fn the_zones_of_a_site_are_what_the_wheels_stand_on() {
    let folder = TempDir::new().unwrap();
    let distance_m = |options: &[&str]| {
        let braked = ["simulate", "--scenario", "pit-right-rear", "--brake", "0.9", "--until-rest"];
        let all = [&braked[..], &["--vehicle-draws", "0", "--json"], options].concat();
        let report = json(&ok(program().args(&all).output().unwrap()));
        report["rest"]["distance_m"].as_f64().unwrap_or(f64::INFINITY)
    };
    let dry_m = distance_m(&[]);
    let icy_m = distance_m(&["--site", &icy(folder.path(), 0.15)]);
    assert!(icy_m > 2.0 * dry_m, "{dry_m} m, on ice {icy_m} m");
    let far = icy(folder.path(), 0.15).replace("ice.toml", "far.toml");
    let border = "[[4000, 4000], [4001, 4000], [4001, 4001]]";
    let zone = format!("[[friction_zone]]\nname = \"far\"\nborder_m = {border}\nfriction = 0.1\n");
    fs::write(&far, zone).unwrap();
    assert_eq!(distance_m(&["--site", &far]), dry_m, "a zone without wheels changes nothing");
}

#[test]
fn a_forecast_says_how_likely_the_vehicles_come_to_each_lane() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let args = ["predict", "--scenario", "pit-right-rear", "--site", SITE, "--draws", "24"];
    let args = [&args[..], &["--until-rest", "--brake", "0.6", "--out", text(&out)]].concat();
    let printed = ok(program().args(&args).output().unwrap());
    let table = "Parts of the ground that the vehicles come to";
    assert!(printed.contains(table) && printed.contains("oncoming lane"), "{printed}");
    let report = json(&ok(program().args(&args).args(["--overwrite", "--json"]).output().unwrap()));
    let places = report["places"].as_array().unwrap();
    let names: Vec<&str> = places.iter().map(|place| place["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["own lane", "oncoming lane", "grass verge, right", "grass verge, left"]);
    for place in places {
        for vehicle in ["struck", "striking"] {
            let share = |what: &str| place[format!("{vehicle}_{what}")].as_f64().unwrap();
            let [enters, ends] = ["enters", "ends"].map(share);
            assert!((0.0..=1.0).contains(&enters) && ends <= enters, "{place}");
        }
    }
    assert_eq!(places[0]["struck_enters"], 1.0, "it drives there");
    // It is struck on the right and turns to the left, over the line.
    let oncoming = places[1]["struck_enters"].as_f64().unwrap();
    let right = places[2]["struck_enters"].as_f64().unwrap();
    assert!(oncoming + right > 0.3, "a car that spins needs more than its lane: {places:?}");
    let bare = [&args[..3], &args[5..], &["--overwrite", "--json"]].concat();
    let bare = json(&ok(program().args(bare).output().unwrap()));
    assert!(bare["places"].is_null(), "{bare}");
}

#[test]
fn scenes_and_reconstructions_are_drawn_on_their_ground() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("scene.png");
    let target = ["--size", "320x240", "--scale", "1", "--out", text(&out), "--overwrite"];
    let drawn = |options: &[&str]| {
        ok(program().args([options, &target].concat()).output().unwrap());
        fs::read(&out).unwrap()
    };
    for view in ["above", "perspective"] {
        let scene = ["render", "scene", "pit-right-rear", "--time", "1", "--view", view];
        let bare = drawn(&scene);
        let on_road = drawn(&[&scene[..], &["--site", SITE]].concat());
        assert!(bare != on_road, "{view}");
        assert!(on_road == drawn(&[&scene[..], &["--site", SITE]].concat()), "the same again");
    }
    let evidence = "datasets/staged/evidence/s05.toml";
    let cars = ["render", "reconstruction", evidence, "--plot", "cars-above", "--particles", "60"];
    let output = program().args([&cars[..], &["--site", SITE], &target].concat()).output().unwrap();
    let printed = ok(output);
    assert!(printed.contains("road friction: zones of the site, all with"), "{printed}");
}
