use std::io::Cursor;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use crate::site::{
    CloudFormat, CloudOptions, CloudReport, LengthUnit, Site, SiteError, import_cloud,
    read_picture, survey_cloud,
};

/// Easting, northing, height and colour of 8 bits of the points: a road of 4 × 2 m in squares of 0.5 m, its
/// east half lighter, and a branch above one of them.
fn points() -> Vec<([f64; 3], u8)> {
    let mut points = vec![([512_345.75, 5_423_456.25, 105.0], 255)];
    for column in 0..8_u8 {
        for row in 0..4_u8 {
            let at = [f64::from(column), f64::from(row)].map(|idx| 0.25 + 0.5 * idx);
            let height_m = 100.0 + 0.01 * f64::from(column);
            let grey = if column < 4 { 40 } else { 200 };
            points.push(([512_345.0 + at[0], 5_423_456.0 + at[1], height_m], grey));
        }
    }
    points
}

fn las(version: (u8, u8), format: u8, is_compressed: bool, color_scale: u16) -> Vec<u8> {
    let mut builder = las::Builder::from(version);
    builder.point_format = las::point::Format::new(format).unwrap();
    builder.point_format.is_compressed = is_compressed;
    let format = builder.point_format;
    builder.transforms.x.offset = 512_000.0;
    builder.transforms.y.offset = 5_423_000.0;
    let header = builder.into_header().unwrap();
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).unwrap();
    for ([x, y, z], grey) in points() {
        let [red, green, blue] = [u16::from(grey) * color_scale; 3];
        let point = las::Point {
            x,
            y,
            z,
            intensity: u16::from(grey),
            gps_time: format.has_gps_time.then_some(0.0),
            color: format.has_color.then_some(las::Color { red, green, blue }),
            ..las::Point::default()
        };
        writer.write_point(point).unwrap();
    }
    writer.into_inner().unwrap().into_inner()
}

/// The same as E57: the coordinates from a scanner that stands elsewhere.
fn e57_file() -> Vec<u8> {
    e57_scans(&[Some([512_000.0, 5_423_000.0, 0.0])])
}

/// The same as scans from several places.
fn e57_scans(places: &[Option<[f64; 3]>]) -> Vec<u8> {
    e57_in_system(places, None)
}

/// The same with the coordinate system that the file states.
fn e57_in_system(places: &[Option<[f64; 3]>], system: Option<&str>) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = e57::E57Writer::new(&mut file, "file").unwrap();
    writer.set_coordinate_metadata(system.map(str::to_owned));
    for place in places {
        let records = vec![
            e57::Record::CARTESIAN_X_F64,
            e57::Record::CARTESIAN_Y_F64,
            e57::Record::CARTESIAN_Z_F64,
            e57::Record::COLOR_RED_U8,
            e57::Record::COLOR_GREEN_U8,
            e57::Record::COLOR_BLUE_U8,
        ];
        let mut cloud = writer.add_pointcloud("cloud", records).unwrap();
        cloud.set_transform(place.map(|[x, y, z]| e57::Transform {
            rotation: e57::Quaternion { w: 1.0, x: 0.0, y: 0.0, z: 0.0 },
            translation: e57::Translation { x, y, z },
        }));
        for ([x, y, z], grey) in points() {
            let at = [x - 512_000.0, y - 5_423_000.0, z].map(e57::RecordValue::Double);
            let color = [grey; 3].map(|part| e57::RecordValue::Integer(i64::from(part)));
            cloud.add_point(at.into_iter().chain(color).collect()).unwrap();
        }
        cloud.finalize().unwrap();
    }
    writer.finalize().unwrap();
    drop(writer);
    file.into_inner()
}

struct Imported {
    _folder: tempfile::TempDir,
    report: CloudReport,
    site: PathBuf,
}

fn import(bytes: &[u8], options: &CloudOptions) -> Result<Imported, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan");
    std::fs::write(&path, bytes).unwrap();
    let format = CloudFormat::from_path(&path).expect("a format that is known");
    let out = folder.path().join("out");
    std::fs::create_dir(&out).unwrap();
    let report = import_cloud(&path, format, options, &out, &mut |_| ControlFlow::Continue(()));
    match report {
        Ok(report) => Ok(Imported { report, site: out.join("site.toml"), _folder: folder }),
        Err(error) => Err(error.to_string()),
    }
}

fn coarse() -> CloudOptions {
    CloudOptions { pixel_m: 0.5, ..CloudOptions::default() }
}

/// Degrees without a coordinate system became a picture of one pixel.
#[test]
fn a_cloud_of_a_fingertip_is_told() {
    let is_told = |options: &CloudOptions| {
        let notes = import(&las((1, 2), 2, false, 257), options).unwrap().report.notes;
        notes.iter().any(|note| note.contains("all of its points lie within 3.5 mm: are its"))
    };
    assert!(is_told(&CloudOptions { unit: Some(LengthUnit::Millimetre), ..coarse() }));
    assert!(!is_told(&coarse()));
}

#[test]
fn a_cloud_becomes_an_orthophoto_in_its_place() {
    for (name, bytes) in [
        ("LAS 1.2", las((1, 2), 2, false, 257)),
        ("LAS 1.2 with 8 bits of colour", las((1, 2), 2, false, 1)),
        ("LAS 1.4", las((1, 4), 7, false, 257)),
        ("LAZ", las((1, 2), 3, true, 257)),
        ("layered LAZ", las((1, 4), 7, true, 257)),
        ("E57", e57_file()),
    ] {
        let Imported { report, site, _folder } = import(&bytes, &coarse()).expect(name);
        assert_eq!(report.summary.n_points, 33, "{name}");
        let is_unit_open = report.notes.iter().any(|note| note.contains("does not say the unit"));
        assert_eq!(is_unit_open, name != "E57", "{name}: {:?}", report.notes);
        assert_eq!((report.size_px, report.filled), ([8, 4], 1.0), "{name}");
        let [low_m, high_m] = report.heights_m;
        let is_road = (low_m - 100.0).abs() < 1e-3 && (high_m - 100.07).abs() < 1e-3;
        assert!(is_road, "{name}: the branch is not the road: {low_m} to {high_m}");
        let site = Site::load(&site).expect(name);
        assert_eq!(site.origin.unwrap().survey_m, [512_345.0, 5_423_456.0], "{name}");
        let photo = site.orthophoto.as_ref().unwrap();
        let [[x0, y0], [x1, y1]] = photo.extent_m();
        for (got, expected) in [(x0, 0.0), (y0, 0.0), (x1, 4.0), (y1, 2.0)] {
            assert!((got - expected).abs() < 2e-3, "{name}: {:?}", photo.extent_m());
        }
        let picture = read_picture(&photo.file).expect(name);
        for (column, grey) in [(0, 40), (1, 40), (3, 40), (4, 200), (7, 200)] {
            let pixel = picture.get_pixel(column, 3).0;
            let is_grey = pixel[..3].iter().all(|part| part.abs_diff(grey) < 2);
            assert!(is_grey && pixel[3] == 255, "{name}: column {column} is {pixel:?}");
        }
    }
}

#[test]
fn a_part_or_a_slice_is_drawn() {
    let bytes = las((1, 2), 2, false, 257);
    let within_m = Some([[512_347.1, 5_423_456.0], [512_360.0, 5_423_460.0]]);
    let part = import(&bytes, &CloudOptions { within_m, ..coarse() }).unwrap();
    assert_eq!(part.report.size_px[1], 4);
    assert!(part.report.size_px[0] <= 5, "{:?}", part.report.size_px);
    let heights_m = Some([104.0, 106.0]);
    let branch = import(&bytes, &CloudOptions { heights_m, ..coarse() }).unwrap();
    assert!((branch.report.heights_m[0] - 105.0).abs() < 1e-3);
    assert!(branch.report.notes.join(" ").contains("larger pixels"), "{:?}", branch.report.notes);
    let heights_m = Some([10.0, 20.0]);
    let error = import(&bytes, &CloudOptions { heights_m, ..coarse() }).err().unwrap();
    assert!(
        error.contains("scan: cannot be read as a point cloud: it has no points within"),
        "{error}"
    );
}

#[test]
fn a_raster_that_is_too_large_is_refused_before_it_is_made() {
    let fine = CloudOptions { pixel_m: 0.0005, ..CloudOptions::default() };
    let error = import(&las((1, 2), 2, false, 257), &fine).err().unwrap();
    assert!(error.contains("scan: spans 3.5 x 1.5 m"), "{error}");
    assert!(error.contains("pixels of 0.0005 m, expected at most 16777216"), "{error}");
    assert!(error.contains("a pixel of 0.001 m or more would do"), "{error}");
}

fn refused(bytes: &[u8]) -> String {
    import(bytes, &coarse()).err().expect("it is refused")
}

/// The bytes with others in a place.
fn with(mut bytes: Vec<u8>, at: usize, new: &[u8]) -> Vec<u8> {
    bytes[at..at + new.len()].copy_from_slice(new);
    bytes
}

#[test]
fn a_header_that_lies_is_refused() {
    let plain = || las((1, 2), 2, false, 257);
    let layered = || las((1, 4), 7, true, 257);
    let many = u32::MAX.to_le_bytes();
    for (what, bytes, expected) in [
        (
            "points",
            with(plain(), 107, &many),
            "says that it has 4294967295 points, the file holds 33",
        ),
        ("records", with(plain(), 100, &many), "says that it has 4294967295 records"),
        ("offset", with(plain(), 96, &many), "its points begin at byte 4294967295"),
        ("scale", with(plain(), 131, &f64::NAN.to_le_bytes()), "it has no points with a place"),
        ("scale", with(plain(), 131, &1e9_f64.to_le_bytes()), "is the unit right?"),
        ("compressed points", with(layered(), 107, &many), "says that it has 4294967295 points in"),
        ("cut", plain()[..300].to_vec(), "the file holds"),
        ("head", plain()[..90].to_vec(), "it has 90 bytes, fewer than the 227 of a header"),
    ] {
        let error = refused(&bytes);
        assert!(error.contains("scan: ") && error.contains(expected), "{what}: {error}");
    }
    let mut late = with(layered(), 235, &(1_u64 << 40).to_le_bytes());
    late = with(late, 243, &1_u32.to_le_bytes());
    assert!(refused(&late).contains("its record behind the points ends at byte"));
}

#[test]
fn a_layer_longer_than_the_file_is_refused() {
    let bytes = las((1, 4), 7, true, 257);
    let offset = u32::from_le_bytes(bytes[96..100].try_into().unwrap()) as usize;
    // The offset of the table, the first point of 36 bytes and the number of points come before the sizes.
    let error = refused(&with(bytes, offset + 8 + 36 + 4, &u32::MAX.to_le_bytes()));
    assert!(error.contains("layers of a chunk are longer than the file"), "{error}");
}

#[test]
fn a_page_of_e57_whose_checksum_is_wrong_is_refused() {
    let bytes = e57_file();
    let at = 1024 + 100;
    let changed = [bytes[at] ^ 1];
    assert!(refused(&with(bytes, at, &changed)).contains("checksum"));
}

#[test]
fn feet_are_turned_into_metres_and_work_is_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.las");
    std::fs::write(&path, las((1, 2), 2, false, 257)).unwrap();
    let survey =
        |path: &Path, unit, flow| survey_cloud(path, CloudFormat::Las, unit, &mut |_| flow);
    let go_on = ControlFlow::Continue(());
    let metres = survey(&path, None, go_on).unwrap();
    let feet = survey(&path, Some(LengthUnit::Foot), go_on).unwrap();
    assert!((feet.low_m[0] - 0.3048 * metres.low_m[0]).abs() < 1e-6);
    let stopped = survey(&path, None, ControlFlow::Break(()));
    assert!(matches!(stopped, Err(SiteError::Cancelled)), "{stopped:?}");
}

/// A set that was registered has one scan at its origin at most.
#[test]
fn scans_that_may_lie_on_top_of_each_other_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.e57");
    let there = Some([512_000.0, 5_423_000.0, 0.0]);
    let origin = Some([0.0; 3]);
    for (places, expected) in [
        (vec![None], None),
        (vec![there, there], None),
        (vec![there, None], None),
        (vec![there, None, origin], Some("2 of its 3 scans stand at the origin")),
    ] {
        std::fs::write(&path, e57_scans(&places)).unwrap();
        let summary =
            survey_cloud(&path, CloudFormat::E57, None, &mut |_| ControlFlow::Continue(()));
        let note = summary.unwrap().unit_note;
        let is_as_expected = match expected {
            Some(said) => note.as_ref().is_some_and(|note| note.contains(said)),
            None => note.is_none(),
        };
        assert!(is_as_expected, "{places:?}: {note:?}");
    }
}

/// Coordinates about the centre of the earth lie on no plane; their third one is no height.
#[test]
fn points_where_no_ground_is_are_refused() {
    let error = refused(&e57_scans(&[Some([4_000_000.0, 700_000.0, 4_900_000.0])]));
    assert!(error.contains("more than 4900100 m") && error.contains("geocentric"), "{error}");
    let error = refused(&e57_scans(&[Some([4_000_000.0, 700_000.0, -4_900_000.0])]));
    assert!(error.contains("above or below 0"), "{error}");
}

/// Some programs write E57 in the feet of its system, against the format.
#[test]
fn a_system_of_e57_in_feet_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.e57");
    for (unit, expected) in [("\"metre\",1", None), ("\"foot\",0.3048", Some("written in ft"))] {
        let system = format!("PROJCS[\"a\",GEOGCS[\"b\"],PROJECTION[\"Lambert\"],UNIT[{unit}]]");
        let place = [Some([512_000.0, 5_423_000.0, 0.0])];
        std::fs::write(&path, e57_in_system(&place, Some(&system))).unwrap();
        let summary =
            survey_cloud(&path, CloudFormat::E57, None, &mut |_| ControlFlow::Continue(()));
        let note = summary.unwrap().unit_note;
        let is_as_expected = match expected {
            Some(said) => note.as_ref().is_some_and(|note| note.contains(said)),
            None => note.is_none(),
        };
        assert!(is_as_expected, "{unit}: {note:?}");
    }
}
