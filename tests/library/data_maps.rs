//! Columns of which the header does not say all: what is read of them, and what is asked with which answer.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::PI;
use std::fs;

use impactlab_core::data::{
    Channel, ColumnMap, DataError, ForceHistory, Loaded, Note, read_any_series,
};

fn read(text: &str, map: &str) -> Result<Loaded, DataError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.csv");
    fs::write(&path, text).unwrap();
    let map: ColumnMap = map.parse().unwrap();
    read_any_series(&path, (!map.to_string().is_empty()).then_some(&map))
}

/// The map that answers what is asked of a file.
fn answer(text: &str, map: &str) -> String {
    let error = read(text, map).unwrap_err();
    error.answer().unwrap_or_else(|| panic!("{error}")).to_string()
}

fn impulse_n_s(text: &str, map: &str) -> f64 {
    let loaded = read(text, map).unwrap();
    let [x, y] =
        ForceHistory::from_series(&loaded.series, loaded.force_sampling()).unwrap().impulse_n_s();
    x.hypot(y)
}

/// Rows of a half sine of 40 kN over 0.1 s, with as many columns as `cells` gives.
fn pulse(header: &str, cells: impl Fn(f64, f64) -> String) -> String {
    let row = |i: i32| {
        let time_s = f64::from(i) * 1e-3;
        format!("{}\n", cells(time_s, 40e3 * (PI * (time_s / 0.1).min(1.0)).sin()))
    };
    std::iter::once(format!("{header}\n")).chain((0..=120).map(row)).collect()
}

/// 2/π · 40 kN · 0.1 s.
const IMPULSE_N_S: f64 = 2546.5;

fn values(loaded: &Loaded, channel: Channel) -> Vec<f64> {
    loaded.series.get(channel).unwrap().to_vec()
}

#[test]
fn forces_of_one_name_are_asked_for_and_added_up() {
    for header in ["time,Fx,Fy,Fx,Fy", "time,Fx,Fy,Fx.1,Fy.1", "time,Fx1,Fy1,Fx2,Fy2"] {
        let text = pulse(header, |t, f| format!("{t},0,{f},0,{f}"));
        assert_eq!(answer(&text, ""), "fx=2+4,fy=3+5", "{header}");
        let impulse = impulse_n_s(&text, &answer(&text, ""));
        assert!((impulse - 2.0 * IMPULSE_N_S).abs() < 5.0, "{impulse}");
    }
    let text =
        pulse("time,Fx [N],Fy [N],Fx [kN],Fy [kN]", |t, f| format!("{t},0,{f},0,{}", f / 1e3));
    assert_eq!(answer(&text, ""), "fx=2:N+4:kN,fy=3:N+5:kN");
    let impulse = impulse_n_s(&text, &answer(&text, ""));
    assert!((impulse - 2.0 * IMPULSE_N_S).abs() < 5.0, "{impulse}");
}

#[test]
fn a_time_beside_each_force_is_one_time_or_asked_for() {
    let same = pulse("Time,Fx,Time,Fy", |t, f| format!("{t},0,{t},{f}"));
    assert!((impulse_n_s(&same, "") - IMPULSE_N_S).abs() < 3.0);
    let other = pulse("Time,Fx,Time,Fy", |t, f| format!("{t},0,{},{f}", t + 0.01));
    assert_eq!(answer(&other, ""), "time=1");
}

#[test]
fn a_unit_of_one_component_is_asked_for_the_other() {
    let text = pulse("time,Fx,Fy,Mz\ns,kN,,", |t, f| format!("{t},0,{},0", f / 1e3));
    assert_eq!(answer(&text, ""), "fy=3:kN");
    assert!((impulse_n_s(&text, "fy=3:kN") - IMPULSE_N_S).abs() < 3.0);
    // Newtons are what is assumed in any case.
    let stated = pulse("time,Fx [N],Fy", |t, f| format!("{t},0,{f}"));
    assert!((impulse_n_s(&stated, "") - IMPULSE_N_S).abs() < 3.0);
}

#[test]
fn an_impulse_in_the_columns_of_a_force_is_recognised() {
    let text = pulse("time,Fx,Fy", |t, _| {
        let share = (1.0 - (PI * (t / 0.1).min(1.0)).cos()) / 2.0;
        format!("{t},{},{}", 500.0 * share, 2000.0 * share)
    });
    assert_eq!(answer(&text, ""), "fx=2:N s,fy=3:N s");
    let impulse = impulse_n_s(&text, &answer(&text, ""));
    assert!((impulse - 2061.6).abs() < 2.0, "{impulse}");
    // Who says that it is a force is believed.
    assert!(read(&text, "fx=2:N,fy=3:N").is_ok());
    let shifted = pulse("time,Fx,Fy,,", |t, f| format!("{t},0,0,0,{f}"));
    assert!(read(&shifted, "").is_ok());
    let shifted = pulse("time,Fx,Fy,,", |t, f| format!("{t},0,0,{},{f}", 0.5 * f));
    assert_eq!(answer(&shifted, ""), "fx=4,fy=5");
}

/// Rows of a straight drive at 15 m/s every 0.02 s.
fn drive(header: &str, cells: impl Fn(f64, f64) -> String) -> String {
    let row = |i: i32| format!("{}\n", cells(f64::from(i) * 0.02, f64::from(i) * 0.3));
    std::iter::once(format!("{header}\n")).chain((0..60).map(row)).collect()
}

#[test]
fn roll_pitch_and_yaw_are_told_from_rates() {
    let text = drive("time,x,y,z,r,p,y", |t, x| format!("{t},{x},0,0,0.1,0.4,0.02"));
    let loaded = read(&text, "").unwrap();
    assert_eq!(values(&loaded, Channel::Roll)[0], 0.1);
    assert_eq!(values(&loaded, Channel::Yaw)[0], 0.02);
    assert_eq!(loaded.series.get(Channel::YawRate), None);
    let text = drive("time,x,y,u,v,r", |t, x| format!("{t},{x},0,15,0,0.02"));
    let loaded = read(&text, "").unwrap();
    assert_eq!(values(&loaded, Channel::YawRate)[0], 0.02);
    assert_eq!(values(&loaded, Channel::Vx)[0], 15.0);
}

#[test]
fn seconds_and_their_fraction_are_one_time() {
    for (header, per_s) in [
        ("secs,nsecs,x,y", 1_000_000_000),
        ("time_s,time_us,x,y", 1_000_000),
        ("stamp_sec,stamp_nanosec,x,y", 1_000_000_000),
    ] {
        let text = drive(header, |t, x| {
            let after_ms = 860 + (t * 1e3).round() as u64;
            let (whole, part_ms) = (1_332_019_828 + after_ms / 1000, after_ms % 1000);
            format!("{whole},{},{x},0", part_ms * (per_s / 1000))
        });
        let loaded = read(&text, "").unwrap();
        let time_s = loaded.series.time_s();
        assert!((time_s[59] - time_s[0] - 1.18).abs() < 1e-6, "{header}: {time_s:?}");
        let begins = |note: &Note| note.to_string().contains("shift=-1332019828.86:s");
        assert!(loaded.notes.iter().any(begins), "{:?}", loaded.notes);
    }
    let text = drive("time,x,y", |t, x| format!("{:.0},{x},0", (1_332_019_828.0 + t) * 1e9));
    let map = answer(&text, "");
    assert!(map.ends_with("time=1:ns") && map.starts_with("shift=-1332019828"), "{map}");
    let loaded = read(&text, &map).unwrap();
    assert!((loaded.series.time_s()[59] - 1.18).abs() < 1e-6);
}

#[test]
fn times_of_day_go_on_over_midnight() {
    let text = drive("time,x,y", |t, x| {
        let time_s = (86_399.5 + t) % 86_400.0;
        let (hours, minutes) = ((time_s / 3600.0).floor(), (time_s / 60.0).floor() % 60.0);
        format!("{hours:02}:{minutes:02}:{:05.2},{x},0", time_s % 60.0)
    });
    let time_s = read(&text, "").unwrap().series.time_s().to_vec();
    assert!((time_s[59] - time_s[0] - 1.18).abs() < 1e-6, "{time_s:?}");
}

#[test]
fn controls_that_do_not_begin_at_zero_are_asked_for() {
    let edr = "Time [s],Steering Wheel Angle [deg]\n-5,0\n-4,-12\n-3,-75\n0,-100\n";
    assert_eq!(answer(edr, ""), "shift=5:s");
    assert_eq!(read(edr, "shift=5:s").unwrap().series.time_s()[0], 0.0);
    assert_eq!(read(edr, "shift=0:s").unwrap().series.time_s()[0], -5.0);
    let late = "time_s,brake_fl [N m]\n100,0\n101,800\n103,800\n";
    assert_eq!(answer(late, ""), "shift=-100:s");
    let held = "time_s,brake_fl [N m]\n0.5,800\n1,800\n";
    assert_eq!(answer(held, ""), "shift=-0.5:s");
    assert!(read("time_s,brake_fl [N m]\n0.5,0\n1,800\n", "").is_ok());
}

#[test]
fn spellings_of_numbers_and_headers_are_read() {
    let comma = |number: f64| format!("\"{number:.3}\"").replace('.', ",");
    let quoted =
        pulse("\"t\",\"fx\",\"fy\"", |t, f| format!("{},{},{}", comma(t), comma(0.0), comma(f)));
    assert!((impulse_n_s(&quoted, "") - IMPULSE_N_S).abs() < 3.0);
    let in_comments = pulse(
        "# group: 1\n# id: c1 id: c2 id: c3\n# name: Time  name: Fx  name: Fy\n# unit: s unit: kN unit: kN",
        |t, f| format!(" {t:.3} 0.0 {:.4}", f / 1e3),
    );
    assert!((impulse_n_s(&in_comments, "") - IMPULSE_N_S).abs() < 3.0);
    let trailing = pulse("time,Fx,Fy,,,", |t, f| format!("{t},0,{f}"));
    assert!((impulse_n_s(&trailing, "") - IMPULSE_N_S).abs() < 3.0);
    let fortran = "t fx fy\n0.0D+00 0.0 1.0-103\n1.0D-01 0.0 1.0D+03\n2.0D-01 0.0 0.0\n";
    assert_eq!(values(&read(fortran, "").unwrap(), Channel::Fy), [1e-103, 1000.0, 0.0]);
}

#[test]
fn places_and_headings_follow_from_several_columns() {
    let text = drive("time,latitude,longitude,qw,qx,qy,qz", |t, x| {
        format!("{t},{},-1.0,{},0,0,{}", 52.0 + x / 111_267.0, 0.35_f64.cos(), 0.35_f64.sin())
    });
    let loaded = read(&text, "").unwrap();
    let y = values(&loaded, Channel::Y);
    assert!((y[59] - 17.7).abs() < 0.02 && values(&loaded, Channel::X)[59].abs() < 1e-6, "{y:?}");
    assert!((values(&loaded, Channel::Yaw)[0] - 0.7).abs() < 1e-9);
    let note = "x and y are metres to the east and to the north of the first row (latitude 52°, longitude \
        -1°), in the plane that touches the ellipsoid WGS 84 there";
    assert!(loaded.notes.iter().any(|of| of.to_string() == note), "{:?}", loaded.notes);
    let map = "time=1,x=east(2 3),y=north(2 3),yaw=quaternion(4 5 6 7)";
    assert_eq!(read(&text, map).unwrap().series, loaded.series);
    let minutes = text.replace(",52.", ",3120.");
    let error = read(&minutes, "").unwrap_err().to_string();
    assert!(error.contains("expected a latitude from −90° to 90°"), "{error}");
}

#[test]
fn a_pose_of_ros_is_read_without_a_map() {
    let header = "time_s,field.child_frame_id,field.pose.pose.position.x,field.pose.pose.position.y,\
        field.pose.pose.orientation.x,field.pose.pose.orientation.y,field.pose.pose.orientation.z,\
        field.pose.pose.orientation.w,field.twist.twist.linear.x,field.twist.twist.linear.y,\
        field.twist.twist.angular.z";
    let row = |t: f64, x: f64| {
        format!(
            "{t},base_link,{},{},0,0,{},{},15,0,0",
            x * 0.6,
            x * 0.8,
            0.2_f64.sqrt(),
            0.8_f64.sqrt()
        )
    };
    let loaded = read(&drive(header, row), "").unwrap();
    assert!((values(&loaded, Channel::X)[59] - 0.6 * 17.7).abs() < 0.02);
    assert!((values(&loaded, Channel::Y)[59] - 0.8 * 17.7).abs() < 0.02);
    assert!((values(&loaded, Channel::Yaw)[0] - 0.8_f64.atan2(0.6)).abs() < 1e-9);
    assert!((values(&loaded, Channel::Vx)[0] - 15.0).abs() < 1e-9);
    assert!(values(&loaded, Channel::YawRate)[0].abs() < 1e-9);
    // The poses of two messages: a map says which is the car's.
    let two = drive(&format!("{header},other.pose.position.x,other.pose.position.y"), |t, x| {
        format!("{},1,2", row(t, x))
    });
    let error = read(&two, "").unwrap_err().to_string();
    assert!(error.contains("no column"), "{error}");
    let map = "x=field.pose.pose.position.x:m,y=field.pose.pose.position.y:m";
    assert_eq!(read(&two, map).unwrap().series, loaded.series);
    // Nor is the orientation of one put beside the place of the other.
    let orientation = ["x", "y", "z", "w"].map(|part| format!("other.orientation.{part}"));
    let two = drive(&format!("{header},{}", orientation.join(",")), |t, x| {
        format!("{},0,0,0,1", row(t, x))
    });
    let error = read(&two, "").unwrap_err().to_string();
    assert!(error.contains("no column"), "{error}");
    // A unit in a header counts.
    let degrees = header.replace("angular.z", "angular.z [deg/s]");
    let turning = drive(&degrees, |t, x| row(t, x).replace(",15,0,0", ",15,0,1"));
    let rate = values(&read(&turning, "").unwrap(), Channel::YawRate)[0];
    assert!((rate - 1_f64.to_radians()).abs() < 1e-9, "{rate}");
}

#[test]
fn a_racelogic_file_is_read_and_a_crash_report_is_named() {
    let header = "File created on 25/11/2026\n\n[header]\ntime\n\n[column names]\n\
        sats time lat long velocity heading\n\n[data]";
    let text = drive(header, |t, x| {
        format!("011 {:.2} +03120.0 {:.7} 054.0 090.0", 95_956.0 + t, 60.0 - x / 1145.2)
    });
    let loaded = read(&text, "").unwrap();
    let x = values(&loaded, Channel::X);
    assert!((x[59] - 17.7).abs() < 0.02, "{x:?}");
    assert!((values(&loaded, Channel::Vx)[0] - 15.0).abs() < 1e-9);
    assert!(values(&loaded, Channel::Yaw)[0].abs() < 1e-9);
    assert!(loaded.notes.iter().any(|note| note.to_string().contains("Racelogic VBO")));
    let error = read("CDR File Information\nUser Entered VIN,1G1\n", "").unwrap_err().to_string();
    assert!(
        error.contains("is the report of a Bosch CDR tool; it holds no table of recorded data"),
        "{error}"
    );
}

#[test]
fn a_heading_that_a_recorder_keeps_within_a_turn_is_read_without_jumps() {
    let rows = |wrapped: [f64; 4]| {
        let row = |(i, yaw): (usize, &f64)| format!("0.{i},{i},0,{yaw}\n");
        let rows: String = wrapped.iter().enumerate().map(row).collect();
        format!("t [s],x [m],y [m],yaw [deg]\n{rows}")
    };
    let yaw_deg = |text: String| -> Vec<f64> {
        let loaded = read(&text, "").unwrap();
        let yaw = loaded.series.get(Channel::Yaw).unwrap();
        yaw.iter().map(|yaw| yaw.to_degrees().round()).collect()
    };
    assert_eq!(yaw_deg(rows([170.0, 178.0, -174.0, -166.0])), [170.0, 178.0, 186.0, 194.0]);
    assert_eq!(yaw_deg(rows([10.0, 2.0, 354.0, 346.0])), [10.0, 2.0, -6.0, -14.0]);
    // This one counts its turns: a fast spin, seldom recorded.
    assert_eq!(yaw_deg(rows([0.0, 200.0, 400.0, 600.0])), [0.0, 200.0, 400.0, 600.0]);
}

/// A car stands, where the course of its receiver goes round, and drives a bend to the right. Its sensor counts a
/// yaw rate clockwise.
#[test]
fn a_racelogic_yaw_rate_is_mirrored_by_the_map_that_is_offered() {
    let mut text =
        "File created on 25/11/2026\n\n[header]\nvelocity knots\n\n[channel units]\ndeg/s\n\n\
        [column names]\nsats time lat long velocity heading YawRate\n\n[data]\n"
            .to_owned();
    let (mut east_m, mut north_m, mut course_rad) = (0.0, 0.0, 0.0_f64);
    for i in 0..700_i32 {
        let (speed_m_s, rate_rad_s) = if i < 300 { (0.0, 0.0) } else { (15.0, 0.4) };
        course_rad += 0.01 * rate_rad_s;
        east_m += 0.01 * speed_m_s * course_rad.sin();
        north_m += 0.01 * speed_m_s * course_rad.cos();
        let course_deg = if i < 300 { f64::from(137 * i % 360) } else { course_rad.to_degrees() };
        text += &format!(
            "011 {:.2} {:.8} {:.8} {:.4} {course_deg:.3} {:.4}\n",
            100_000.0 + 0.01 * f64::from(i),
            3120.0 + north_m / 1854.6,
            60.0 - east_m / 1145.2,
            speed_m_s * 3600.0 / 1852.0,
            f64::to_degrees(rate_rad_s)
        );
    }
    let said = |loaded: &Loaded| -> String {
        loaded.notes.iter().map(|note| format!("{note}\n")).collect()
    };
    let loaded = read(&text, "").unwrap();
    let notes = said(&loaded);
    assert!(notes.contains("one of them is clockwise; map yaw_rate=-7:deg/s"), "{notes}");
    assert!(notes.contains("300 of 700 rows are slower than 1 m/s"), "{notes}");
    assert!(loaded.notes.iter().any(Note::is_contradiction), "{notes}");
    let loaded = read(&text, "yaw_rate=-7:deg/s").unwrap();
    assert!(!loaded.notes.iter().any(Note::is_contradiction), "{}", said(&loaded));
    assert!((values(&loaded, Channel::Vx)[699] - 15.0).abs() < 1e-3);
    assert!((values(&loaded, Channel::YawRate)[699] + 0.4).abs() < 1e-4);
}

#[test]
fn a_gap_of_days_between_two_dated_rows_is_kept() {
    let text = "time,x [m],y [m]\n2026-11-25 10:00:00,0,0\n2026-11-26 11:00:00,5,0\n\
        2026-11-29 12:00:00,6,0\n";
    let loaded = read(text, "").unwrap();
    assert_eq!(values(&loaded, Channel::X).len(), 3);
    assert_eq!(loaded.series.time_s(), [36_000.0, 126_000.0, 388_800.0]);
}
