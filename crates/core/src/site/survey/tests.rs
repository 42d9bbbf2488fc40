use std::path::Path;

use crate::data::GeographicPlace;
use crate::site::{
    EdgeLine, GeographicFrame, Kerb, Lane, LengthUnit, MapFormat, Site, SiteOrigin, SurveyFormat,
    SurveyOptions, SurveyedLine, SurveyedPoint, map_features, map_file,
};
use crate::units::UnitSystem;
use crate::vehicle::FrictionZone;

fn read_as(name: &str, text: &str, options: &SurveyOptions) -> Result<Site, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    let format = SurveyFormat::from_path(&path).expect("a format that is known");
    Site::from_survey(&path, format, options)
        .map_err(|error| error.to_string().replace(&format!("{}/", folder.path().display()), ""))
}

fn read(name: &str, text: &str) -> Result<Site, String> {
    read_as(name, text, &SurveyOptions::default())
}

fn distance_m(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

const KML: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2"><Document><name>Scene</name>
<Placemark><name>skid &amp; scuff</name><LineString><coordinates>
 -1.0,52.0,100 -1.0,52.0001,100
</coordinates></LineString></Placemark>
<Placemark><name>Kerb east</name><LineString><coordinates>-1,52 -0.9999,52</coordinates></LineString></Placemark>
<Placemark><name>ice</name><ExtendedData><Data name="friction"><value>0.2</value></Data></ExtendedData>
<Polygon><outerBoundaryIs><LinearRing><coordinates>-1,52 -0.9999,52 -0.9999,52.0001 -1,52</coordinates></LinearRing></outerBoundaryIs>
<innerBoundaryIs><LinearRing><coordinates>-1,52 -0.9999,52 -1,52</coordinates></LinearRing></innerBoundaryIs></Polygon></Placemark>
<Placemark><name>gouge</name><Point><coordinates>-1,52,101.5</coordinates></Point></Placemark>
<Placemark><name>a note</name></Placemark>
<GroundOverlay><name>photo</name></GroundOverlay>
</Document></kml>
"#;

/// A ten-thousandth of a degree at 52° is 11.127 m to the north and 6.867 m to the east (WGS 84).
#[test]
fn placemarks_lie_in_metres_about_the_first_point() {
    let site = read("map.kml", KML).unwrap();
    let [skid] = site.lines.as_slice() else { panic!("{:?}", site.lines) };
    assert_eq!((skid.name.as_str(), skid.line_m[0]), ("skid & scuff", [0.0, 0.0]));
    let [east_m, north_m] = skid.line_m[1];
    assert!(east_m.abs() < 1e-6 && (north_m - 11.127).abs() < 0.005, "{:?}", skid.line_m);
    let [kerb] = site.kerbs.as_slice() else { panic!("{:?}", site.kerbs) };
    assert!((kerb.line_m[1][0] - 6.867).abs() < 0.005, "{:?}", kerb.line_m);
    assert_eq!((site.friction_zones[0].friction, site.friction_zones[0].border_m.len()), (0.2, 3));
    assert_eq!((site.points[0].name.as_str(), site.points[0].height_m), ("gouge", Some(101.5)));
    // Points that were drawn on a map have the height 0, which is none.
    let drawn = read("map.kml", &KML.replace("101.5", "0")).unwrap();
    assert_eq!(drawn.points[0].height_m, None);
    let place = site.geographic.unwrap().degrees();
    assert!(distance_m(place, [52.0, -1.0]) < 1e-12, "{place:?}");
    let notes = site.notes.join("; ");
    for part in ["latitude 52.0", "1 GroundOverlay", "1 hole of an area", "1 without geometry"] {
        assert!(notes.contains(part), "{part} in {notes}");
    }
}

/// A mark that leads to a kerb was one, and forecasts told of its crossing.
#[test]
fn a_mark_at_a_kerb_is_no_kerb() {
    let n_kerbs = |map: &str| read("map.kml", map).unwrap().kerbs.len();
    assert_eq!(n_kerbs(KML), 1);
    assert_eq!(n_kerbs(&KML.replace("skid &amp; scuff", "skid from lane to kerb")), 1);
    let said =
        "</name><ExtendedData><Data name=\"impactlab\"><value>line</value></Data></ExtendedData>";
    assert_eq!(n_kerbs(&KML.replace("Kerb east</name>", &format!("Kerb east{said}"))), 0);
}

#[test]
fn coordinates_of_a_grid_are_shifted_by_whole_metres() {
    let map = r#"{"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"name": "edge"}, "geometry": {"type": "LineString",
         "coordinates": [[512345.25, 5423456.5], [512355.25, 5423456.75]]}}]}"#;
    let site = read("map.geojson", map).unwrap();
    assert_eq!(site.origin.unwrap().survey_m, [512_345.0, 5_423_456.0]);
    assert_eq!(site.lines[0].line_m, [[0.25, 0.5], [10.25, 0.75]]);
    assert!(site.geographic.is_none() && site.notes[1].contains("easting and northing"));
    let in_feet = SurveyOptions { unit: Some(LengthUnit::Foot), ..SurveyOptions::default() };
    let site = read_as("map.json", map, &in_feet).unwrap();
    let length_m = distance_m(site.lines[0].line_m[0], site.lines[0].line_m[1]);
    assert!((length_m - 0.3048 * 10.0_f64.hypot(0.25)).abs() < 1e-6, "{length_m}");
}

#[test]
fn the_system_of_a_grid_is_said_and_that_of_web_maps_refused() {
    let map = |system: &str| {
        format!(
            r#"{{"type": "FeatureCollection", "crs": {{"type": "name", "properties": {{"name": "{system}"}}}},
            "features": [{{"type": "Feature", "properties": {{"name": "edge"}}, "geometry": {{"type": "LineString",
            "coordinates": [[1447153.4, 6800125.5], [1447185.8, 6800125.5]]}}}}]}}"#
        )
    };
    let notes = read("map.geojson", &map("urn:ogc:def:crs:EPSG::25833")).unwrap().notes.join(" ");
    assert!(notes.contains("EPSG::25833, in metres unless another unit"), "{notes}");
    let error = read("map.geojson", &map("urn:ogc:def:crs:EPSG::3857")).unwrap_err();
    assert!(error.contains("web maps"), "{error}");
}

/// Lines of New York were 3.28 times too long, with a note alone.
#[test]
fn a_state_plane_in_feet_is_read_once_its_unit_is_said() {
    let map = r#"{"type": "LineString", "coordinates": [[983456.5, 199123.25], [983556.5, 199123.25]],
        "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2263"}}}"#;
    let error = read("map.geojson", map).unwrap_err();
    for part in ["map.geojson", "EPSG:2263", "State Plane in feet", "--unit us_survey_ft"] {
        assert!(error.contains(part), "{part}: {error}");
    }
    let unit = Some(LengthUnit::SurveyFoot);
    let said = SurveyOptions { unit, ..SurveyOptions::default() };
    let site = read_as("map.geojson", map, &said).unwrap();
    let length_m = distance_m(site.lines[0].line_m[0], site.lines[0].line_m[1]);
    assert!((length_m - 120_000.0 / 3937.0).abs() < 1e-6, "{length_m}");
}

/// A height of 330 ft stood as 330 m in the site file.
#[test]
fn heights_of_a_map_in_feet_are_in_metres_too() {
    let map = r#"{"type": "Point", "coordinates": [983456.5, 199123.25, 330.0]}"#;
    let unit = Some(LengthUnit::Foot);
    let site = read_as("map.geojson", map, &SurveyOptions { unit, ..Default::default() }).unwrap();
    let height_m = site.points[0].height_m.unwrap();
    assert!((height_m - 330.0 * 0.3048).abs() < 1e-9, "{height_m}");
    assert_eq!(read("map.geojson", map).unwrap().points[0].height_m, Some(330.0));
}

/// A skid of 0.8 m in a grid was one of 68 km, and one of 30 m was refused as if a coordinate were mistyped.
#[test]
fn a_grid_that_is_stated_is_one_though_its_coordinates_could_be_degrees() {
    let map = |system: &str, end: &str| {
        let crs = format!(r#""crs": {{"type": "name", "properties": {{"name": "{system}"}}}},"#);
        let crs = if system.is_empty() { String::new() } else { crs };
        format!(r#"{{{crs} "type": "LineString", "coordinates": [[12.5, 40.5], [{end}, 40.5]]}}"#)
    };
    let in_metres = SurveyOptions { unit: Some(LengthUnit::Metre), ..SurveyOptions::default() };
    let unsaid = SurveyOptions::default();
    for (system, end, options) in [
        ("urn:ogc:def:crs:EPSG::25832", "13.3", &unsaid),
        ("EPSG:31467", "13.3", &unsaid),
        ("urn:adv:crs:ETRS89_UTM32", "13.3", &unsaid),
        ("EPSG:5683", "13.3", &in_metres),
        ("", "13.3", &in_metres),
        ("", "42.5", &in_metres),
    ] {
        let site = read_as("map.geojson", &map(system, end), options).unwrap();
        let length_m = distance_m(site.lines[0].line_m[0], site.lines[0].line_m[1]);
        let expected_m = end.parse::<f64>().unwrap() - 12.5;
        assert!((length_m - expected_m).abs() < 1e-9, "{system} {end}: {length_m} m");
        let notes = site.notes.join(" ");
        assert!(site.geographic.is_none() && notes.contains("could be longitude"), "{notes}");
    }
    let error = read("map.geojson", &map("", "42.5")).unwrap_err();
    assert!(error.contains("taken as degrees") && error.contains("--unit m"), "{error}");
    let notes = read("map.geojson", &map("", "13.3")).unwrap().notes.join(" ");
    assert!(notes.contains("states no system") && notes.contains("--unit m"), "{notes}");
    let notes = read("map.geojson", &map("", "12.5001")).unwrap().notes.join(" ");
    assert!(!notes.contains("--unit"), "{notes}");
    // Degrees that are stated have no unit, and neither has KML.
    assert!(
        read_as("map.geojson", &map("EPSG:4326", "12.5001"), &in_metres)
            .unwrap()
            .geographic
            .is_some()
    );
    assert!(read_as("map.kml", KML, &in_metres).unwrap().geographic.is_some());
}

/// A feature by itself and a geometry, as databases give them, have the system that a collection has.
#[test]
fn the_system_of_a_feature_or_a_geometry_counts() {
    let system = r#""crs": {"type": "name", "properties": {"name": "EPSG:3857"}}"#;
    let line =
        r#""type": "LineString", "coordinates": [[1447153.4, 6800125.5], [1447185.8, 6800125.5]]"#;
    for map in [
        format!("{{{system}, {line}}}"),
        format!(r#"{{"type": "Feature", {system}, "properties": {{}}, "geometry": {{{line}}}}}"#),
        format!(r#"{{"type": "Feature", "properties": {{}}, "geometry": {{{system}, {line}}}}}"#),
    ] {
        let error = read("map.geojson", &map).unwrap_err();
        assert!(error.contains("web maps"), "{map}: {error}");
        assert!(read("map.geojson", &map.replace("3857", "25833")).is_ok(), "{map}");
    }
}

/// Some systems count to the north first, and programs write their coordinates in that order.
#[test]
fn northing_before_easting_is_said_of_a_map_too() {
    let map = |from: &str, to: &str| {
        format!(r#"{{"type": "LineString", "coordinates": [[{from}], [{to}]]}}"#)
    };
    let said = |map: &str| read("map.geojson", map).unwrap().notes.join(" ").contains("mirrored");
    assert!(said(&map("5423456.5, 512345.25", "5423456.75, 512355.25")));
    assert!(!said(&map("512345.25, 5423456.5", "512355.25, 5423456.75")));
    // EPSG:31467, zone 3 of Gauss and Krüger.
    assert!(said(&map("5423456.5, 3512345.25", "5423456.75, 3512355.25")));
    assert!(!said(&map("3512345.25, 5423456.5", "3512355.25, 5423456.75")));
}

/// Degrees of another datum, here that of the older German maps, lie beside those of receivers.
#[test]
fn degrees_of_another_system_are_said() {
    let notes = |system: &str| {
        let map = format!(
            r#"{{"type": "FeatureCollection", "crs": {{"type": "name", "properties": {{"name": "{system}"}}}},
            "features": [{{"type": "Feature", "properties": {{"name": "edge"}}, "geometry": {{"type": "LineString",
            "coordinates": [[8.65, 49.87], [8.651, 49.87]]}}}}]}}"#
        );
        read("map.geojson", &map).unwrap().notes.join(" ")
    };
    let other = notes("urn:ogc:def:crs:EPSG::4314");
    assert!(
        other.contains("system urn:ogc:def:crs:EPSG::4314") && other.contains("datum"),
        "{other}"
    );
    for system in ["urn:ogc:def:crs:OGC:1.3:CRS84", "EPSG:4326", "urn:ogc:def:crs:EPSG::4258"] {
        assert!(!notes(system).contains("datum"), "{system}");
    }
}

#[test]
fn points_of_a_code_of_a_line_are_joined_in_their_order() {
    let text = "name;E [m];N [m];Z;code\n1;512345,5;5423456,5;101,3;KERB1\n\
        2;512350,5;5423456,5;101,2;kerb2\n3;512355,5;5423456,5;101,1;KERB1\n\
        4;512350,5;5423460,5;101,0;kerb2\n5;512347,5;5423458,5;100,9;TREE\n6;512346,5;5423456,5;;TL\n\
        7;512346,5;5423459,5;;TL\n";
    let site = read("points.csv", text).unwrap();
    let kerbs: Vec<_> = site.kerbs.iter().map(|kerb| kerb.line_m.clone()).collect();
    assert_eq!(kerbs, [[[0.5, 0.5], [10.5, 0.5]], [[5.5, 0.5], [5.5, 4.5]]]);
    let points: Vec<_> = site.points.iter().map(|point| point.name.as_str()).collect();
    assert_eq!(points, ["5 TREE", "6 TL", "7 TL"]);
    assert_eq!((site.points[0].at_m, site.points[0].height_m), ([2.5, 2.5], Some(100.9)));
    let options = SurveyOptions { line_codes: vec!["tl".to_owned()], ..SurveyOptions::default() };
    let site = read_as("points.csv", text, &options).unwrap();
    assert_eq!((site.lines[0].name.as_str(), site.lines[0].line_m.len()), ("TL", 2));
}

#[test]
fn a_table_says_its_unit_or_is_in_metres() {
    let text = "pt,northing_us_survey_ft,easting_us_survey_ft,code\n1,100,200,a\n2,100,210,a\n";
    let site = read("points.txt", text).unwrap();
    let length_m = distance_m(site.points[0].at_m, site.points[1].at_m);
    assert!((length_m - 12_000.0 / 3937.0).abs() < 1e-9, "{length_m}");
    let site = read("points.txt", &text.replace("_us_survey_ft", "")).unwrap();
    assert_eq!(distance_m(site.points[0].at_m, site.points[1].at_m), 10.0);
    assert!(site.notes.join(" ").contains("no unit is said"), "{:?}", site.notes);
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let header = "name,E,N,code\n";
    for (name, text, expected) in [
        ("a.kml", KML.replace("-1.0,52.0,100", "-1.0;52.0"), "a.kml:5: has a point in coordinates"),
        ("a.kml", KML.replace("</kml>", ""), "a.kml:13: ends within <kml>"),
        ("a.kml", KML.replace("</Document>", "</Folder>"), "a.kml:13: is no XML"),
        ("a.kml", KML.replace(">0.2<", ">much<"), "a.kml:8: has a friction that is no number"),
        ("a.kml", KML.replace(">0.2<", ">20<"), "a.kml:8: friction zone \"ice\""),
        (
            "a.kml",
            KML.replace("-0.9999,52 -0.9999", "-0.9999,52 8.5"),
            "a.kml:8: has a point at 8.5",
        ),
        ("a.kml", "<kml/>".to_owned(), "a.kml: has no points, lines or areas"),
        ("a.csv", format!("{header}1,5,x,a\n"), "a.csv:2:3: is \"x\", expected a coordinate"),
        ("a.csv", format!("{header}1,5,3e9,a\n"), "a.csv:2:3: is \"3e9\""),
        ("a.csv", format!("{header}1,5,6,a\n2,900000,6,a\n"), "a.csv:3: has a point at 900000, 6"),
        (
            "a.csv",
            "name,E [m],N [ft],code\n1,5,6,a\n".to_owned(),
            "a.csv:1: E and N have different",
        ),
        ("a.json", "{\"type\":\"Feature\",\n\"geometry\":}".to_owned(), "a.json:2: is no GeoJSON"),
    ] {
        let error = read(name, &text).unwrap_err();
        assert!(error.starts_with(expected), "expected {expected}\ngot      {error}");
    }
}

fn site() -> Site {
    let place = GeographicPlace::from_degrees(47.123_456_789, 8.987_654_321).unwrap();
    let x_axis_azimuth_rad = 1.2;
    Site {
        origin: Some(SiteOrigin { survey_m: [0.0; 2], x_axis_azimuth_rad }),
        geographic: Some(place),
        lanes: vec![Lane {
            name: "A <eastbound>".to_owned(),
            left_m: vec![[-60.0, 0.0], [0.0, 0.0], [90.0, 2.0]],
            right_m: vec![[-60.0, -3.5], [90.0, -1.5]],
            edges: [EdgeLine::Dashed, EdgeLine::None],
        }],
        kerbs: vec![Kerb { name: "k".to_owned(), line_m: vec![[-60.0, -4.0], [90.0, -2.0]] }],
        friction_zones: vec![FrictionZone {
            name: "wet".to_owned(),
            border_m: vec![[8.0, -3.5], [20.0, -3.5], [20.0, 3.5]],
            friction: 0.35,
        }],
        lines: vec![SurveyedLine {
            name: "skid".to_owned(),
            line_m: vec![[1.0, 1.0], [31.0, 2.0]],
        }],
        points: vec![SurveyedPoint { name: "gouge".to_owned(), at_m: [32.0, 0.5], height_m: None }],
        ..Site::empty(Path::new("site.toml"))
    }
}

#[test]
fn a_ground_comes_back_from_a_map_as_what_it_was() {
    let site = site();
    let frame = site.geographic_frame().unwrap();
    for (format, name) in [(MapFormat::Kml, "a.kml"), (MapFormat::GeoJson, "a.geojson")] {
        let text = map_file(format, ("A & B", Some("not <exact>")), &map_features(&site), &frame);
        let back = read(name, &text).unwrap();
        // Both in degrees, since the axes are others.
        let same = |ours: &[[f64; 2]], theirs: &[[f64; 2]]| {
            assert_eq!(ours.len(), theirs.len(), "{name}");
            let of_back = back.geographic_frame().unwrap();
            for (ours, theirs) in ours.iter().zip(theirs) {
                let theirs = GeographicFrame::longitude_latitude_deg(&of_back, *theirs);
                let off = distance_m(frame.longitude_latitude_deg(*ours), theirs);
                assert!(off < 2e-9, "{name}: {ours:?} is {off} degrees off");
            }
        };
        let ([ours], [theirs]) = (site.lanes.as_slice(), back.lanes.as_slice()) else {
            panic!("{name}: {back:?}")
        };
        assert_eq!((&ours.name, ours.edges), (&theirs.name, theirs.edges), "{name}");
        same(&ours.left_m, &theirs.left_m);
        same(&ours.right_m, &theirs.right_m);
        same(&site.kerbs[0].line_m, &back.kerbs[0].line_m);
        assert_eq!(back.friction_zones[0].friction, 0.35, "{name}");
        same(&site.friction_zones[0].border_m, &back.friction_zones[0].border_m);
        same(&site.lines[0].line_m, &back.lines[0].line_m);
        same(&[site.points[0].at_m], &[back.points[0].at_m]);
    }
}

#[test]
fn a_site_file_has_what_was_surveyed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("site.toml");
    let site = site();
    std::fs::write(&path, site.to_toml(folder.path()).unwrap()).unwrap();
    let back = Site::load(&path).unwrap();
    let parts = |site: &Site| {
        (site.origin, site.geographic, site.lanes.clone(), site.lines.clone(), site.points.clone())
    };
    assert_eq!(parts(&back), parts(&site));
    let contents = back.contents(None, UnitSystem::Si).join("; ");
    assert!(contents.contains("origin at latitude 47.1234568°"), "{contents}");
}

#[test]
fn an_archive_of_a_map_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.kmz");
    let mut archive = zip::ZipWriter::new(std::fs::File::create(&path).unwrap());
    let options = zip::write::SimpleFileOptions::default();
    archive.start_file("files/other.kml", options).unwrap();
    std::io::Write::write_all(&mut archive, KML.replace("skid", "other").as_bytes()).unwrap();
    archive.start_file("doc.kml", options).unwrap();
    std::io::Write::write_all(&mut archive, KML.as_bytes()).unwrap();
    archive.finish().unwrap();
    let site = Site::load(&path).unwrap();
    assert_eq!((site.lines.len(), site.kerbs.len(), site.points.len()), (1, 1, 1));
    assert_eq!(site.lines[0].name, "skid & scuff");
}
