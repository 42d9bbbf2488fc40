use std::path::Path;

use crate::site::{EdgeLine, LengthUnit, Site, SiteOrigin};
use crate::units::UnitSystem;

const SITE: &str = r#"name = "Crossing"

[origin]
easting_m = 3512345.0
northing_m = 5423456.0
x_axis_azimuth_deg = 90

[orthophoto]
file = "road.png"
points_px = [[100, 100], [300, 100]]
points_m = [[-10, 0], [10, 0]]

[[lane]]
name = "eastbound"
centre_line_m = [[-50, -1.75], [80, -1.75]]
width_ft = 12
left = "dashed"

[[kerb]]
line_m = [[-50, -3.6], [80, -3.6]]

[[friction_zone]]
name = "wet patch"
border_m = [[8, -3.5], [20, -3.5], [20, 3.5], [8, 3.5], [8, -3.5]]
friction = 0.35
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    image::RgbImage::new(400, 200).save(folder.path().join("road.png")).unwrap();
    folder
}

fn read(folder: &Path, text: &str) -> Result<Site, String> {
    let path = folder.join("site.toml");
    std::fs::write(&path, text).unwrap();
    Site::load(&path)
        .map_err(|error| error.to_string().replace(&format!("{}/", folder.display()), ""))
}

#[test]
fn a_site_is_read_with_its_units_and_comes_back() {
    let folder = folder();
    let site = read(folder.path(), SITE).unwrap();
    assert_eq!(site.name, "Crossing");
    assert_eq!(site.origin.unwrap().survey_m, [3_512_345.0, 5_423_456.0]);
    assert!((site.north_rad().unwrap() - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    let photo = site.orthophoto.as_ref().unwrap();
    assert_eq!(photo.size_px, [400, 200]);
    assert_eq!(photo.map.ground_m([200.0, 100.0]), [0.0, 0.0]);
    let lane = &site.lanes[0];
    assert_eq!(lane.edges, [EdgeLine::Dashed, EdgeLine::Solid]);
    assert!((lane.left_m[0][1] - (-1.75 + 6.0 * 0.3048)).abs() < 1e-12, "{lane:?}");
    assert!((lane.right_m[1][1] - (-1.75 - 6.0 * 0.3048)).abs() < 1e-12, "{lane:?}");
    let zone = &site.friction_zones[0];
    assert_eq!((zone.name.as_str(), zone.friction, zone.border_m.len()), ("wet patch", 0.35, 4));
    let text = site.to_toml(folder.path()).unwrap();
    let again = read(folder.path(), &text).unwrap();
    assert_eq!(again, site, "{text}");
    let elsewhere = site.to_toml(Path::new("/elsewhere")).unwrap_err().to_string();
    assert!(elsewhere.contains("is not in /elsewhere or below it"), "{elsewhere}");
}

#[test]
fn the_width_of_a_lane_stays_around_a_bend() {
    let folder = folder();
    let text = "[[lane]]\ncentre_line_m = [[0, 0], [20, 0], [20, 20]]\nwidth_m = 4\n";
    let lane = &read(folder.path(), text).unwrap().lanes[0];
    assert_eq!(lane.left_m, [[0.0, 2.0], [18.0, 2.0], [18.0, 20.0]]);
    assert_eq!(lane.right_m, [[0.0, -2.0], [22.0, -2.0], [22.0, 20.0]]);
}

#[test]
fn world_files_are_in_survey_coordinates() {
    let folder = folder();
    let world = "0.5\n0\n0\n-0.5\n1000.25\n2099.75\n";
    std::fs::write(folder.path().join("road.pgw"), world).unwrap();
    let text = "[origin]\neasting_m = 1000\nnorthing_m = 2000\n[orthophoto]\nfile = \"road.png\"\n";
    let site = read(folder.path(), text).unwrap();
    assert_eq!(site.orthophoto.as_ref().unwrap().map.corner_m, [0.0, 100.0]);
    let site_file = folder.path().join("site.toml");
    let named = ["road.png", "road.pgw"].map(|name| folder.path().join(name));
    assert_eq!(Site::files_named_by(&site_file), named);
    // The picture alone: survey and site are the same.
    let alone = Site::load(&folder.path().join("road.png")).unwrap();
    assert_eq!(alone.orthophoto.as_ref().unwrap().map.corner_m, [1000.0, 2100.0]);
    assert_eq!(Site::files_named_by(&alone.path), named[1..]);
    assert_eq!(alone.origin.unwrap_or_default(), SiteOrigin::default());
}

#[test]
fn the_unit_of_a_world_file_and_feet_of_the_survey_are_read_and_come_back() {
    let folder = folder();
    let world = "0.5\n0\n0\n-0.5\n17000000.25\n1000099.75\n";
    std::fs::write(folder.path().join("road.pgw"), world).unwrap();
    let text = |foot: &str| {
        format!(
            "[origin]\neasting_{foot} = 17000000\nnorthing_{foot} = 1000000\n[orthophoto]\n\
             file = \"road.png\"\nunit = \"{foot}\"\n"
        )
    };
    for (foot, foot_m) in [("ft", 0.3048), ("us_survey_ft", 1200.0 / 3937.0)] {
        let site = read(folder.path(), &text(foot)).unwrap();
        let [easting_m, _] = site.origin.unwrap().survey_m;
        assert!((easting_m - 17e6 * foot_m).abs() < 1e-6, "{foot}: {easting_m}");
        let map = site.orthophoto.as_ref().unwrap().map;
        let off = (map.corner_m[0]).hypot(map.corner_m[1] - 100.0 * foot_m);
        assert!(off < 1e-6, "{foot}: {map:?}");
        assert!((map.per_column_m[0] - 0.5 * foot_m).abs() < 1e-12, "{foot}: {map:?}");
        let again = read(folder.path(), &site.to_toml(folder.path()).unwrap()).unwrap();
        assert_eq!(again.orthophoto, site.orthophoto, "{foot}");
        let contents = site.contents(None, UnitSystem::Si).join("; ");
        assert!(contents.ends_with(&format!("world file in {foot}")), "{contents}");
        let in_feet = site.contents(None, UnitSystem::Us).join("; ");
        assert!(in_feet.contains(" ft, Y ") && !in_feet.contains(" m,"), "{in_feet}");
    }
    let mixed = text("ft").replace("easting_ft", "easting_m = 1\neasting_ft");
    assert!(read(folder.path(), &mixed).unwrap_err().contains("easting_"));
    let unit = SITE.replace("points_px", "unit = \"ft\"\npoints_px");
    let error = read(folder.path(), &unit).unwrap_err();
    assert!(error.contains("orthophoto.unit is \"ft\", expected no unit"), "{error}");
}

/// A picture in feet, or in metres of web maps, was 3.28 or 1.5 times too large without a word.
#[test]
fn the_coordinate_system_beside_a_picture_counts_and_goes_with_it() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("road.pgw"), "0.5\n0\n0\n-0.5\n17000000.25\n1000099.75\n").unwrap();
    let system = |projection: &str| {
        format!("PROJCS[\"a\",PROJECTION[\"{projection}\"],UNIT[\"Foot_US\",0.3048006096012192]]")
    };
    std::fs::write(at("road.prj"), system("Lambert_Conformal_Conic")).unwrap();
    let foot_m = 1200.0 / 3937.0;
    let text = "[orthophoto]\nfile = \"road.png\"\n";
    for site in [Site::load(&at("road.png")).unwrap(), read(folder.path(), text).unwrap()] {
        let map = site.orthophoto.as_ref().unwrap().map;
        assert!((map.per_column_m[0] - 0.5 * foot_m).abs() < 1e-12, "{map:?}");
        assert!(Site::files_named_by(&site.path).contains(&at("road.prj")));
        let again = read(folder.path(), &site.to_toml(folder.path()).unwrap()).unwrap();
        assert_eq!(again.orthophoto, site.orthophoto);
    }
    let error = read(folder.path(), &format!("{text}unit = \"m\"\n")).unwrap_err();
    assert!(error.contains("road.prj: its coordinates are in us_survey_ft"), "{error}");
    std::fs::write(at("road.prj"), system("Mercator_Auxiliary_Sphere")).unwrap();
    assert!(Site::load(&at("road.png")).is_err());
}

#[test]
fn a_picture_as_large_as_no_place_is_said() {
    let folder = folder();
    let contents = |pixel: &str| {
        let world = format!("{pixel}\n0\n0\n-{pixel}\n500000\n5400000\n");
        std::fs::write(folder.path().join("road.pgw"), world).unwrap();
        let site = Site::load(&folder.path().join("road.png")).unwrap();
        site.contents(None, UnitSystem::Si).join("; ")
    };
    assert!(contents("50").ends_with("world file in m: is that its unit?"), "{}", contents("50"));
    assert!(contents("0.05").ends_with("world file in m"), "{}", contents("0.05"));
}

#[test]
fn a_wrong_file_is_refused_with_line_and_key() {
    let folder = folder();
    let with = |from: &str, to: &str| SITE.replace(from, to);
    for (text, expected) in [
        (with("northing_m = 5423456.0\n", ""), "site.toml:3:2: origin.northing_m is missing"),
        (
            with("easting_m = 3512345.0", "easting_m = 3e7"),
            "site.toml:4:13: origin.easting_m is 3e7",
        ),
        (
            with("\"road.png\"", "\"../road.png\""),
            "site.toml:9:8: orthophoto.file is \"../road.png\", expected a file beside",
        ),
        (
            with("\"road.png\"", "\"/road.png\""),
            "site.toml:9:8: orthophoto.file is \"/road.png\", expected a file beside",
        ),
        (
            with("\"road.png\"", "\"road.bmp\""),
            "site.toml:9:8: orthophoto.file is \"road.bmp\", expected a .png",
        ),
        (with("\"road.png\"", "\"none.png\""), "none.png: does not exist"),
        (with("[300, 100]]", "[400.5, 100]]"), "site.toml: orthophoto.points_px has [400.5, 100]"),
        (with("[300, 100]]", "[100, 100]]"), "site.toml:10:13: orthophoto.points_px is"),
        (
            with("[[-10, 0], [10, 0]]", "[[-10, 0], [-10, 0]]"),
            "site.toml:11:12: orthophoto.points_m is",
        ),
        (
            with("points_m = [[-10, 0], [10, 0]]\n", ""),
            "site.toml:8:2: orthophoto.points_m or distance_m is missing",
        ),
        (
            with("points_m = [[-10, 0], [10, 0]]\n", "distance_m = 0.001\n"),
            "site.toml:11:14: orthophoto.distance_m is 0.001, expected 0.05 to 100000",
        ),
        (with("width_ft = 12\n", ""), "site.toml:13:1: lane[0].width_m is missing"),
        (
            with("width_ft = 12", "width_m = 0.1"),
            "site.toml:16:11: lane[0].width_m is 0.1, expected 0.5 to 50",
        ),
        (with("\"dashed\"", "\"dotted\""), "site.toml:17:8: lane[0].left is \"dotted\""),
        (
            with("line_m = [[-50, -3.6], [80, -3.6]]", "line_m = [[1, 1]]"),
            "site.toml:20:10: kerb[0].line_m is [[1, 1]]",
        ),
        (
            with("friction = 0.35", "friction = 35"),
            "site.toml:25:12: friction_zone[0].friction is 35",
        ),
        (
            with("friction = 0.35", "mu = 0.35"),
            "site.toml:22:1: friction_zone[0].friction is missing",
        ),
        (
            with("[20, 3.5], [8, 3.5]", "[8, 3.5], [20, 3.5]"),
            "site.toml:24:12: friction_zone[0].border_m is",
        ),
        (with("[[kerb]]", "[[curb]]"), "site.toml:19:3: curb is not known here"),
    ] {
        let error = read(folder.path(), &text).unwrap_err();
        assert!(error.starts_with(expected), "expected {expected}\ngot      {error}");
    }
}

#[test]
fn a_distance_of_two_points_is_enough() {
    let folder = folder();
    let text =
        "[orthophoto]\nfile = \"road.png\"\npoints_px = [[0, 200], [400, 200]]\ndistance_m = 40\n";
    let site = read(folder.path(), text).unwrap();
    let map = site.orthophoto.as_ref().unwrap().map;
    assert_eq!((map.ground_m([0.0, 200.0]), map.per_column_m), ([0.0, 0.0], [0.1, 0.0]));
}

#[test]
fn the_slope_of_the_road_is_read_told_and_comes_back() {
    let folder = folder();
    let site = read(folder.path(), "[road]\ngrade_percent = 4\ncross_slope = -0.02\n").unwrap();
    let slope = site.slope.unwrap();
    assert!((slope.grade - 0.04).abs() < 1e-15 && slope.cross_slope == -0.02, "{slope:?}");
    assert_eq!(site.contents(None, UnitSystem::Si), ["slope of 4.0 % along X, -2.0 % along Y"]);
    let text = site.to_toml(folder.path()).unwrap();
    assert_eq!(read(folder.path(), &text).unwrap(), site, "{text}");
}

#[test]
fn the_words_of_units_stand_beside_their_units() {
    for (word, unit) in LengthUnit::WORDS.into_iter().zip(LengthUnit::ALL) {
        assert_eq!(word.replace('-', "_"), unit.word(), "{unit:?}");
    }
    let (words, units) = LengthUnit::OF_WORLD_FILES;
    assert_eq!(words, units.map(LengthUnit::word));
}
