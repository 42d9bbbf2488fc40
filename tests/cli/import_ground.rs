//! Grounds of other programs: surveyed lines and points, and point clouds.

use std::fs;

use serde_json::Value;

use crate::program::{answer, program, text};

const POINTS: &str = "name,E,N,Z,code\n\
    1,512345.5,5423456.5,101.3,KERB1\n2,512355.5,5423456.5,101.2,KERB1\n\
    3,512350.0,5423458.0,101.1,gouge\n4,512346.0,5423457.0,,TL\n5,512349.0,5423457.5,,TL\n";

#[test]
fn surveyed_points_become_a_site_that_is_checked() {
    let folder = tempfile::tempdir().expect("a folder");
    let (points, out) = (folder.path().join("points.csv"), folder.path().join("ground"));
    fs::write(&points, POINTS).expect("a file");
    let args = ["import", text(&points), "--line", "TL", "--out", text(&out)];
    let report = answer(&args);
    assert_eq!(report["kind"], "ground");
    let site = out.join("site.toml");
    assert_eq!(report["files"][0], Value::from(text(&site)));
    let notes = report["notes"].to_string();
    for part in
        ["1 kerb", "surveyed lines: 1, points: 1", "easting less 512345 m", "no unit is said"]
    {
        assert!(notes.contains(part), "{part} in {notes}");
    }
    let written = fs::read_to_string(&site).expect("a site file");
    assert!(written.contains("easting_m = 512345.0"), "{written}");
    for path in [&site, &points] {
        let checked = answer(&["check", text(path)]);
        assert_eq!(checked["ok"], true, "{checked}");
        assert!(checked.to_string().contains("surveyed lines:"), "{checked}");
    }
    let again = program().args(args).output().expect("it starts");
    assert!(!again.status.success(), "nothing is replaced unasked");
}

#[test]
fn an_option_that_the_file_does_not_take_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let (points, out) = (folder.path().join("points.csv"), folder.path().join("ground"));
    fs::write(&points, POINTS).expect("a file");
    let args = ["import", text(&points), "--resolution", "5cm", "--out", text(&out)];
    let refused = program().args(args).output().expect("it starts");
    let error = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(error.contains("is no file that takes --resolution; leave it out"), "{error}");
    assert!(!out.exists(), "no folder is left behind");
}

#[test]
fn a_point_cloud_becomes_a_ground_that_is_checked() {
    let folder = tempfile::tempdir().expect("a folder");
    let (cloud, out) = (folder.path().join("scan.las"), folder.path().join("ground"));
    fs::write(&cloud, scan()).expect("a file");
    let checked = answer(&["check", text(&cloud)]);
    assert!(checked.to_string().contains("100 points with colours"), "{checked}");
    let report = answer(&["import", text(&cloud), "--resolution", "0.1", "--out", text(&out)]);
    assert_eq!(report["files"].as_array().map(Vec::len), Some(5), "{report}");
    let checked = answer(&["check", text(&out.join("site.toml"))]);
    assert_eq!(checked["ok"], true, "{checked}");
    assert!(checked.to_string().contains("orthophoto of 10 x 10 pixels of 0.1000 m"), "{checked}");
}

/// A square metre of road.
fn scan() -> Vec<u8> {
    let mut builder = las::Builder::from((1, 2));
    builder.point_format = las::point::Format::new(2).expect("a format");
    let header = builder.into_header().expect("a header");
    let file = std::io::Cursor::new(Vec::new());
    let mut writer = las::Writer::new(file, header).expect("a writer");
    for idx in 0..100_u16 {
        let [x, y] = [idx % 10, idx / 10].map(|side| 1000.05 + 0.1 * f64::from(side));
        let color = Some(las::Color { red: 40_000, green: 40_000, blue: 40_000 });
        writer
            .write_point(las::Point { x, y, z: 7.0, color, ..las::Point::default() })
            .expect("a point");
    }
    writer.into_inner().expect("a file").into_inner()
}
