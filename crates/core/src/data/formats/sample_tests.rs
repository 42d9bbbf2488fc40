//! The files in `tests/data/formats`, which are made by hand in the public layouts, and the numbers in them.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use crate::data::{Channel, ColumnMap, Loaded, RecorderRecord, read_any_series};

/// One mile per hour, m/s.
const MPH: f64 = 0.447_04;

fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/formats").join(name)
}

fn read(name: &str, map: &str) -> Loaded {
    let map: ColumnMap = map.parse().unwrap();
    read_any_series(&sample(name), Some(&map)).unwrap()
}

fn assert_near(got: &[f64], expected: impl IntoIterator<Item = f64>, reach: f64) {
    let expected: Vec<f64> = expected.into_iter().collect();
    assert_eq!(got.len(), expected.len(), "{got:?}");
    for (got, expected) in got.iter().zip(expected) {
        assert!((got - expected).abs() <= reach, "{got}, expected {expected}");
    }
}

#[test]
fn a_report_of_a_recorder_has_its_numbers() {
    let record = RecorderRecord::read(&sample("cdr-report.csv"), Some(1)).unwrap();
    assert_eq!((record.event.as_str(), record.events.len()), ("EVENT RECORD 1", 2));
    let ahead = record.delta_v_ahead.unwrap();
    assert!((ahead.delta_v_m_s + 21.0 * MPH).abs() < 1e-9, "{ahead:?}");
    assert_eq!((ahead.ends_s, ahead.is_cut), (Some(0.25), false));
    let right = record.delta_v_right.unwrap();
    assert!((right.delta_v_m_s - 3.0 * MPH).abs() < 1e-9, "{right:?}");
    let before = &record.before;
    assert_near(&before.time_s, (0..11).map(|i| -5.0 + 0.5 * f64::from(i)), 1e-12);
    let mph = [45, 45, 45, 44, 43, 41, 38, 35, 31, 27, 23];
    assert_near(&before.speed_m_s, mph.map(|mph| f64::from(mph) * MPH), 1e-9);
    let deg = [0, 0, 0, 2, 4, 4, -2, -10, -18, -20, -20];
    let rad = deg.map(|deg| f64::from(deg).to_radians());
    assert_near(&before.steering_wheel_rad, rad, 1e-12);
    assert_eq!(before.is_braked.iter().filter(|on| **on).count(), 7);
    assert_eq!(before.is_anti_lock_active.iter().filter(|on| **on).count(), 2);
    let speed = record.speed_before.unwrap();
    assert!((speed.speed_m_s - 23.0 * MPH).abs() < 1e-9 && speed.at_s == 0.0, "{speed:?}");
    assert_eq!(record.doubts, ["events and tables without recorded data: 1"]);
    assert!(RecorderRecord::read(&sample("cdr-report.csv"), Some(2)).is_err());
}

#[test]
fn a_table_of_49_cfr_563_has_its_numbers() {
    let record = RecorderRecord::read(&sample("table-563.csv"), None).unwrap();
    assert_eq!(record.doubts, Vec::<String>::new());
    let [ahead, right] = [record.delta_v_ahead, record.delta_v_right].map(Option::unwrap);
    assert!((ahead.delta_v_m_s + 34.0 / 3.6).abs() < 1e-9, "{ahead:?}");
    assert!((right.delta_v_m_s - 5.0 / 3.6).abs() < 1e-9, "{right:?}");
    assert_eq!([ahead.ends_s, right.ends_s], [Some(0.25); 2]);
    let km_h = [72, 72, 72, 71, 69, 66, 61, 56, 50, 43, 37];
    assert_near(&record.before.speed_m_s, km_h.map(|km_h| f64::from(km_h) / 3.6), 1e-9);
    // As any table it is refused at its first blank cell, with the option that reads it.
    let error = read_any_series(&sample("table-563.csv"), None).unwrap_err().to_string();
    assert!(error.contains("impactlab import --recorder"), "{error}");
}

#[test]
fn forces_of_contacts_and_sections_have_their_numbers() {
    let slave = read("rcforc", "deck=t-mm-s,sheet=contact 3 slave");
    let half_sine = |peak_n: f64, at_s: &[f64]| -> Vec<f64> {
        let force = |at_s: &f64| peak_n * (PI * at_s / 0.08).sin();
        at_s.iter().map(force).collect()
    };
    let time_s = slave.series.time_s().to_vec();
    assert_near(&time_s, (0..17).map(|i| 0.005 * f64::from(i)), 1e-9);
    let get = |of: &Loaded, channel: Channel| of.series.require(channel).unwrap().to_vec();
    assert_near(&get(&slave, Channel::Fx), half_sine(150e3, &time_s), 1.0);
    assert_near(&get(&slave, Channel::Fy), half_sine(-37.5e3, &time_s), 1.0);
    let master = read("rcforc", "deck=t-mm-s,sheet=contact 3 master");
    assert_near(&get(&master, Channel::Fx), half_sine(-150e3, &time_s), 1.0);
    let right = read("secforc", "deck=t-mm-s,sheet=section 4");
    let time_s = right.series.time_s().to_vec();
    assert_near(&get(&right, Channel::Fx), half_sine(-40e3, &time_s), 1.0);
    assert_near(&get(&right, Channel::Fy), half_sine(4e3, &time_s), 1.0);
}

#[test]
fn a_rigid_body_has_its_numbers() {
    let body = read("rbdout", "deck=t-mm-s,sheet=body 5 along x").series;
    let time_s = body.time_s().to_vec();
    assert_near(&time_s, (0..9).map(|i| 0.06 * f64::from(i)), 1e-9);
    let over_time = |of: &dyn Fn(f64) -> f64| time_s.iter().map(|t| of(*t)).collect::<Vec<f64>>();
    for (channel, expected) in [
        (Channel::X, over_time(&|t| 15.0 * t)),
        (Channel::Y, over_time(&|t| 0.1 + 0.5 * t * t)),
        (Channel::Yaw, over_time(&|t| 2.0 * t)),
        (Channel::YawRate, over_time(&|_| 2.0)),
        // In body axes the car slides across its heading.
        (Channel::Vx, over_time(&|t| 15.0 * (2.0 * t).cos() + t * (2.0 * t).sin())),
        (Channel::Vy, over_time(&|t| t * (2.0 * t).cos() - 15.0 * (2.0 * t).sin())),
        (Channel::Ay, over_time(&|t| (2.0 * t).cos())),
    ] {
        assert_near(body.require(channel).unwrap(), expected, 2e-3);
    }
}
