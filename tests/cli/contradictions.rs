//! Motions whose columns contradict each other: each is named with what would mend it, and nothing is made of
//! it before.

use std::path::PathBuf;

use tempfile::TempDir;

use crate::answers::write;
use crate::commands::impactlab;
use crate::program::text;

/// Radius of the bend, m, and speed along it, m/s.
const RADIUS_M: f64 = 50.0;
const SPEED_M_S: f64 = 15.0;

/// A log of a bend to the left; `row` gives the numbers of the columns at an angle along the bend.
fn log(folder: &TempDir, name: &str, header: &str, row: impl Fn(f64, f64) -> String) -> PathBuf {
    let rate = SPEED_M_S / RADIUS_M;
    let rows =
        (0..200).map(|i| f64::from(i) * 0.02).map(|t| format!("{t},{}\n", row(rate * t, rate)));
    write(folder, name, &format!("{header}\n{}", rows.collect::<String>()))
}

fn place(angle: f64) -> String {
    format!("{},{}", RADIUS_M * angle.sin(), RADIUS_M * (1.0 - angle.cos()))
}

#[test]
fn a_compass_heading_is_named_refused_and_mended_by_the_map_that_is_offered() {
    let folder = TempDir::new().unwrap();
    let header = "Time [s],Easting [m],Northing [m],Heading [deg]";
    let file = log(&folder, "compass.csv", header, |angle, _| {
        format!("{},{}", place(angle), 90.0 - angle.to_degrees())
    });
    let checked = impactlab(&["check", text(&file)]);
    assert!(checked.out.contains("compass heading"), "{}", checked.out);
    assert!(checked.out.contains("headings=compass"), "{}", checked.out);
    let out = folder.path().join("path.dxf");
    let simulate = ["simulate", "--trajectory", text(&file), "--vehicle", "generic-car"];
    let export = ["export", text(&file), "--out", text(&out)];
    for args in [&simulate[..], &export[..]] {
        let ran = impactlab(args);
        assert_ne!(ran.code, 0, "{args:?}: {}", ran.out);
        assert!(ran.error_line().contains("headings=compass"), "{args:?}: {}", ran.err);
    }
    let mended = impactlab(&[&simulate[..], &["--map", "headings=compass"]].concat());
    assert_eq!(mended.code, 0, "{}", mended.err);
}

/// The impulse of such a log was (−2322, 1615) N s without a word.
#[test]
fn a_yaw_rate_in_degrees_and_clockwise_is_not_learned_from() {
    let folder = TempDir::new().unwrap();
    let header = "time_s,x_m,y_m,yaw_rad,vx_m_s,vy_m_s,yaw_rate_rad_s";
    let file = log(&folder, "rate.csv", header, |angle, rate| {
        format!("{},{angle},{SPEED_M_S},0,{}", place(angle), -rate.to_degrees())
    });
    let checked = impactlab(&["check", text(&file)]);
    assert!(checked.out.contains("-0.017 times"), "{}", checked.out);
    assert!(checked.out.contains("yaw_rate=-7:deg/s"), "{}", checked.out);
    let out = folder.path().join("car.model");
    let learn = ["condition", "response", "--log", text(&file), "--vehicle", "generic-car"];
    let ran = impactlab(&[&learn[..], &["--out", text(&out)]].concat());
    assert_ne!(ran.code, 0, "{}", ran.out);
    assert!(ran.err.contains("yaw_rate=-7:deg/s"), "{}", ran.err);
    assert!(!out.exists());
    let mended = impactlab(&["check", text(&file), "--map", "yaw_rate=-7:deg/s"]);
    assert!(!mended.out.contains("times what the yaw rate says"), "{}", mended.out);
}

#[test]
fn a_mirrored_axis_and_held_positions_are_named() {
    let folder = TempDir::new().unwrap();
    let header = "time_s,x_m,y_m,yaw_rad";
    let mirrored =
        log(&folder, "mirror.csv", header, |angle, _| format!("{},{}", place(angle), -angle));
    let held = log(&folder, "held.csv", header, |angle, rate| {
        let fix = (angle / (0.2 * rate)).floor() * 0.2 * rate;
        format!("{},{angle}", place(fix))
    });
    for (file, words) in [(mirrored, "turns to one side"), (held, "held between fixes")] {
        let checked = impactlab(&["check", text(&file)]);
        assert!(checked.out.contains(words), "{}", checked.out);
        let simulate = ["simulate", "--trajectory", text(&file), "--vehicle", "generic-car"];
        let ran = impactlab(&simulate);
        assert!(ran.error_line().contains(words), "{}", ran.err);
    }
}

#[test]
fn a_speed_that_is_not_that_of_the_path_is_named_with_its_line() {
    let folder = TempDir::new().unwrap();
    let header = "Time [s],x [m],y [m],Speed [m/s]";
    let file = log(&folder, "speed.csv", header, |angle, _| {
        format!("{},{}", place(angle), 3.6 * SPEED_M_S)
    });
    let checked = impactlab(&["check", text(&file)]);
    let says = "as if km/h were read as m/s; map speed=4:km/h";
    assert!(checked.out.contains(says), "{}", checked.out);
    assert!(checked.out.contains("speed.csv:"), "{}", checked.out);
    let mended = impactlab(&["check", text(&file), "--map", "speed=4:km/h"]);
    assert!(!mended.out.contains("as fast over the whole path"), "{}", mended.out);
}

#[test]
fn a_force_that_pulls_at_its_contact_point_is_named() {
    let folder = TempDir::new().unwrap();
    let pulse = |name: &str, peak_n: f64| {
        let row = |i: i32| {
            let force_n = peak_n * (f64::from(i) / 100.0 * std::f64::consts::PI).sin();
            format!("{},0,{force_n}\n", f64::from(i) * 1e-3)
        };
        let rows: String = (0..=100).map(row).collect();
        write(&folder, name, &format!("time_s,fx_n,fy_n\n{rows}"))
    };
    let out = |file: &PathBuf| {
        let simulate = ["simulate", "--force", text(file), "--vehicle", "generic-car"];
        let ran =
            impactlab(&[&simulate[..], &["--speed", "20", "--contact", "-1.5,-0.9,0.5"]].concat());
        assert_eq!(ran.code, 0, "{}", ran.err);
        format!("{}{}", ran.out, ran.err)
    };
    let says = "the force pulls at its contact point";
    assert!(!out(&pulse("pushes.csv", 4e4)).contains(says));
    assert!(out(&pulse("pulls.csv", -4e4)).contains(says));
}
