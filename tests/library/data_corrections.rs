//! What contradicts itself in a motion comes with changes of the map: after any of them the numbers are right
//! and nothing contradicts itself.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::FRAC_PI_2;
use std::fs;

use impactlab_core::data::{
    Channel, ColumnMap, Correction, DataError, Loaded, Note, read_any_series,
};

/// Radius of the bend, m, speed along it, m/s, and time between two rows, s.
const RADIUS_M: f64 = 50.0;
const SPEED_M_S: f64 = 15.0;
const STEP_S: f64 = 0.02;

fn read(text: &str, map: &ColumnMap) -> Result<Loaded, DataError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.csv");
    fs::write(&path, text).unwrap();
    read_any_series(&path, Some(map))
}

/// A row of a bend to the left: time, x, y, yaw, v_x and v_y in body axes, yaw rate; SI units.
type Row = [f64; 7];

fn bend(idx: u32) -> Row {
    let time_s = f64::from(idx) * STEP_S;
    let rate = SPEED_M_S / RADIUS_M;
    let (sin, cos) = (rate * time_s).sin_cos();
    [time_s, RADIUS_M * sin, RADIUS_M * (1.0 - cos), rate * time_s, SPEED_M_S, 0.0, rate]
}

/// A log of the bend whose numbers were changed.
///
/// - `header`: of the first columns of a row; the others are left out.
fn log(header: &str, change: impl Fn(&mut Row)) -> String {
    let row = |idx| {
        let mut row = bend(idx);
        change(&mut row);
        let shown = row.iter().take(header.split(',').count());
        let cells: Vec<String> = shown.map(f64::to_string).collect();
        format!("{}\n", cells.join(","))
    };
    std::iter::once(format!("{header}\n")).chain((0..200).map(row)).collect()
}

/// The corrections of all remarks, without doubles.
fn corrections(loaded: &Loaded) -> Vec<Correction> {
    let mut found: Vec<Correction> = Vec::new();
    for correction in loaded.notes.iter().flat_map(Note::corrections) {
        if !found.contains(&correction) {
            found.push(correction);
        }
    }
    found
}

const SI: &str = "time_s,x_m,y_m,yaw_rad,vx_m_s,vy_m_s,yaw_rate_rad_s";
const PATH: &str = "time_s,x_m,y_m,yaw_rad";

/// Reads a log that contradicts itself, and makes each of its corrections.
///
/// - `expected`: label and map of each; after the first one the numbers are those of the bend.
fn check(text: &str, expected: &[(&str, &str)]) {
    let empty = ColumnMap::default();
    let loaded = read(text, &empty).unwrap();
    assert!(loaded.notes.iter().any(Note::is_contradiction), "{expected:?}");
    let found = corrections(&loaded);
    let shown: Vec<(String, String)> =
        found.iter().map(|of| (of.label().to_owned(), of.to_string())).collect();
    let shown: Vec<(&str, &str)> = shown.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
    assert_eq!(shown, expected);
    for (idx, correction) in found.iter().enumerate() {
        // A remark names the map that its correction is.
        let text_of = |note: &Note| note.to_string().contains(&correction.to_string());
        assert!(loaded.notes.iter().any(text_of), "{correction}");
        let mut map = empty.clone();
        correction.apply(&mut map);
        assert_eq!(map, correction.to_string().parse().unwrap());
        let corrected = read(text, &map).unwrap();
        let left: Vec<&Note> = corrected.notes.iter().filter(|of| of.is_contradiction()).collect();
        assert!(left.is_empty(), "{correction}: {left:?}");
        let order =
            [Channel::X, Channel::Y, Channel::Yaw, Channel::Vx, Channel::Vy, Channel::YawRate];
        for (at, channel) in order.into_iter().enumerate().filter(|_| idx == 0) {
            let Some(values) = corrected.series.get(channel) else { continue };
            for (i, value) in (0..).zip(values) {
                assert!(
                    (value - bend(i)[at + 1]).abs() < 1e-9,
                    "{correction}: {channel:?} {i} {value}"
                );
            }
        }
        correction.undo(&mut map, &empty);
        assert_eq!(map, empty);
    }
}

#[test]
fn a_bend_needs_no_correction() {
    let loaded = read(&log(SI, |_| ()), &ColumnMap::default()).unwrap();
    assert_eq!(corrections(&loaded), []);
}

#[test]
fn a_mirrored_axis_is_mirrored_back() {
    let both = [("Mirror y", "y=-3:m"), ("Mirror yaw", "yaw=-4:rad")];
    check(&log(PATH, |row| row[2] = -row[2]), &both);
    check(&log(PATH, |row| row[1] = -row[1]), &[("Mirror x", "x=-2:m")]);
    let with_rate =
        [("Mirror y", "y=-3:m"), ("Mirror yaw and yaw rate", "yaw=-4:rad,yaw_rate=-7:rad/s")];
    check(&log(SI, |row| row[2] = -row[2]), &with_rate);
    // Velocities in world axes are mirrored with the place.
    let text = log(SI, |row| {
        let (sin, cos) = row[3].sin_cos();
        (row[2], row[4], row[5]) = (-row[2], SPEED_M_S * cos, -SPEED_M_S * sin);
    });
    let world: ColumnMap = "velocities=world".parse().unwrap();
    let found = corrections(&read(&text, &world).unwrap());
    assert_eq!(found[0].label(), "Mirror y and v_y");
    let mut map = world.clone();
    found[0].apply(&mut map);
    assert_eq!(map.to_string(), "velocities=world,y=-3:m,vy=-6:m/s");
    let corrected = read(&text, &map).unwrap();
    assert_eq!(corrections(&corrected), []);
    assert!(corrected.series.get(Channel::Vx).unwrap().iter().all(|vx| (vx - 15.0).abs() < 1e-9));
}

#[test]
fn a_compass_heading_becomes_a_yaw_angle() {
    let compass = [("Heading is a compass heading", "headings=compass")];
    check(&log(PATH, |row| row[3] = FRAC_PI_2 - row[3]), &compass);
    let all = log(SI, |row| (row[3], row[6]) = (FRAC_PI_2 - row[3], -row[6]));
    check(&all, &compass);
    // Who has said so wrongly is offered the other way.
    let said: ColumnMap = "headings=compass".parse().unwrap();
    let found = corrections(&read(&log(PATH, |_| ()), &said).unwrap());
    let shown: Vec<String> = found.iter().map(Correction::to_string).collect();
    assert_eq!(
        (found[0].label(), shown),
        ("Heading is a yaw angle", vec!["headings=yaw".to_owned()])
    );
}

/// An angle from another axis turns with the path; one along an axis that does not turn may be that of a compass, too.
#[test]
fn a_yaw_angle_from_another_axis_is_turned() {
    check(&log(PATH, |row| row[3] += FRAC_PI_2), &[("Turn yaw by −90 deg", "yaw_offset=-90:deg")]);
    check(&log(SI, |row| row[3] -= FRAC_PI_2), &[("Turn yaw by 90 deg", "yaw_offset=90:deg")]);
    let straight = log(PATH, |row| {
        (row[1], row[2], row[3]) = (SPEED_M_S * row[0], 0.0, FRAC_PI_2);
    });
    let loaded = read(&straight, &ColumnMap::default()).unwrap();
    let shown: Vec<String> = corrections(&loaded).iter().map(Correction::to_string).collect();
    assert_eq!(shown, ["headings=compass", "yaw_offset=-90:deg"]);
    for map in shown {
        let corrected = read(&straight, &map.parse().unwrap()).unwrap();
        assert_eq!(corrections(&corrected), [], "{map}");
        let yaw = corrected.series.get(Channel::Yaw).unwrap();
        assert!(yaw.iter().all(|yaw| yaw.abs() < 1e-9), "{map}: {yaw:?}");
    }
    // A car that drifts, or another axis: it is said, and read.
    let drift = read(&log(PATH, |row| row[3] += 0.7), &ColumnMap::default()).unwrap();
    assert!(!drift.notes.iter().any(Note::is_contradiction), "{:?}", drift.notes);
    let said = |note: &Note| note.is_doubt() && note.to_string().contains("yaw_offset=-40:deg");
    assert!(drift.notes.iter().any(said), "{:?}", drift.notes);
}

#[test]
fn units_that_are_off_get_their_unit() {
    let yaw = log("time_s,x_m,y_m,yaw", |row| row[3] = row[3].to_degrees());
    check(&yaw, &[("Yaw is in deg", "yaw=4:deg")]);
    let rate = log(SI, |row| row[6] = -row[6].to_degrees());
    check(&rate, &[("Yaw rate is in deg/s, mirror yaw rate", "yaw_rate=-7:deg/s")]);
    let rate = log(SI, |row| row[6] = row[6].to_degrees());
    check(&rate, &[("Yaw rate is in deg/s", "yaw_rate=7:deg/s")]);
    let speed = log(SI, |row| row[4] *= 3.6);
    check(&speed, &[("v_x and v_y are in km/h", "vx=5:km/h,vy=6:km/h")]);
    let places = log(SI, |row| (row[1], row[2]) = (row[1] * 1e3, row[2] * 1e3));
    check(&places, &[("x and y are in mm", "x=2:mm,y=3:mm")]);
}

#[test]
fn velocities_in_world_axes_are_read_as_such() {
    let text = log(SI, |row| {
        let (sin, cos) = row[3].sin_cos();
        (row[4], row[5]) = (SPEED_M_S * cos, SPEED_M_S * sin);
    });
    check(&text, &[("Velocities are in world axes", "velocities=world")]);
}

/// Two contradictions at once: each correction removes its own, and both together all.
#[test]
fn corrections_of_several_contradictions_go_together() {
    let text = log(SI, |row| {
        row[4] *= 3.6;
        row[6] = row[6].to_degrees();
    });
    let mut map = ColumnMap::default();
    let mut made = Vec::new();
    while let Some(correction) = corrections(&read(&text, &map).unwrap()).first() {
        correction.apply(&mut map);
        made.push(correction.label().to_owned());
        assert!(made.len() <= 2, "{made:?}");
    }
    assert_eq!(made, ["v_x and v_y are in km/h", "Yaw rate is in deg/s"]);
    assert_eq!(map.to_string(), "vx=5:km/h,vy=6:km/h,yaw_rate=7:deg/s");
    let loaded = read(&text, &map).unwrap();
    assert!(loaded.series.get(Channel::Vx).unwrap().iter().all(|vx| (vx - 15.0).abs() < 1e-9));
}

#[test]
fn times_of_a_clock_are_shifted_to_zero() {
    let text = log(PATH, |row| row[0] += 1.6e9);
    let loaded = read(&text, &ColumnMap::default()).unwrap();
    let [shift] = &corrections(&loaded)[..] else { panic!("{:?}", loaded.notes) };
    assert_eq!(shift.label(), "Shift the time by −1600000000 s");
    let mut map = ColumnMap::default();
    shift.apply(&mut map);
    assert_eq!(read(&text, &map).unwrap().series.time_s()[0], 0.0);
    // Controls are refused until it is said, and the refusal has the same change.
    for (header, unit, label) in [
        ("Time [s],Steering Wheel Angle [deg]", "", "Shift the time by 5 s"),
        (
            "Time,Steering Wheel Angle",
            ":deg",
            "Shift the time by 5 s and read steering_wheel=2:deg",
        ),
    ] {
        let text = format!("{header}\n-5,0\n-4,-12\n-3,-75\n0,-100\n");
        let error = read(&text, &ColumnMap::default()).unwrap_err();
        let [correction] = &error.corrections(None)[..] else { panic!("{error}") };
        assert_eq!(correction.label(), label);
        assert_eq!(correction.to_string().ends_with(":deg"), !unit.is_empty(), "{correction}");
        assert!(error.to_string().contains(&format!("--map \"{correction}\"")), "{error}");
        let mut map = ColumnMap::default();
        correction.apply(&mut map);
        let loaded = read(&text, &map).unwrap();
        assert_eq!(loaded.series.time_s(), [0.0, 1.0, 2.0, 5.0]);
        let angle = loaded.series.get(Channel::SteeringWheel).unwrap();
        assert!((angle[2] + 75.0_f64.to_radians()).abs() < 1e-12, "{angle:?}");
    }
}

#[test]
fn seconds_that_begin_again_go_on() {
    let text = log(PATH, |row| row[0] = (row[0] + 58.0) % 60.0);
    let loaded = read(&text, &"shift=-58:s".parse().unwrap()).unwrap();
    let time_s = loaded.series.time_s();
    assert!((0..200).zip(time_s).all(|(i, t)| (t - bend(i)[0]).abs() < 1e-9), "{time_s:?}");
    let says = "the seconds of the time begin again at 0 after 60 s, once; they were let go on";
    assert!(loaded.notes.iter().any(|note| note.to_string() == says), "{:?}", loaded.notes);
    // Rows that are out of order are not those of a clock.
    let text = log(PATH, |row| row[0] = if row[0] > 2.0 { row[0] - 1.5 } else { row[0] });
    let error = read(&text, &ColumnMap::default()).unwrap_err().to_string();
    assert!(error.contains("or let a clock go on that begins again there"), "{error}");
}
