//! Numbers of recorders that are doubted, or not taken.

use super::*;

/// Seconds under a heading of milliseconds, and the other way round.
#[test]
fn times_before_a_crash_in_another_unit_are_said() {
    let is_said = |unit: &str, factor: i32| {
        let (first, second) = (-5 * factor, -2 * factor);
        let text = format!("Time [{unit}],Speed [mph]\n{first},45\n{second},45\n0,45\n");
        let record = read(&text, None).unwrap();
        record.doubts.iter().any(|doubt| doubt.contains("unit of their times"))
    };
    assert!(is_said("ms", 1) && is_said("s", 1000));
    assert!(!is_said("s", 1) && !is_said("ms", 1000));
}

/// A wrong unit of time or of the change itself, two events, and a record that begins within the impact.
#[test]
fn a_change_of_velocity_that_is_none_of_one_crash_is_refused() {
    for (unit, rows, word) in [
        ("[s],Delta-V Longitudinal [mph]", "0,0\n1,-0.5\n80,-20\n120,-20\n", "unit of the times"),
        ("[ms],Delta-V Longitudinal [mph]", "0,0\n100,-9\n0,0\n130,-3\n", "one event"),
        ("[ms],Delta-V Longitudinal [mph]", "100,-9\n50,-5\n0,0\n", "one event"),
        ("[ms],Delta-V Longitudinal [mph]", "0,-20\n40,-8\n120,-0.5\n", "begin with the impact"),
        ("[ms],Delta-V Longitudinal [kN]", "0,0\n100,-9\n130,-9\n", "no unit of speed"),
    ] {
        let error = read(&format!("Time {unit}\n{rows}"), None).unwrap_err().to_string();
        assert!(error.contains(word) && error.contains("edr.csv"), "{rows}: {error}");
    }
}

/// Which of two columns was read was said, and not that they contradict each other; nor was that of a column
/// with the largest change.
#[test]
fn columns_of_a_change_of_velocity_that_contradict_each_other_are_said() {
    let doubts = |other: &str, end: &str| {
        let text = format!(
            "Time [ms],Delta-V Longitudinal [km/h],{other} [km/h]\n\
             0,0,0\n50,-16,-9\n100,-30,-14\n120,-32,{end}\n"
        );
        let record = read(&text, None).unwrap();
        assert!((record.delta_v_ahead.unwrap().delta_v_m_s + 32.0 / 3.6).abs() < 1e-9);
        record.doubts.iter().filter(|doubt| doubt.contains("contradict")).count()
    };
    let second = "Delta-V Longitudinal of the Second Sensor";
    assert_eq!([doubts(second, "-15"), doubts(second, "-31")], [1, 0]);
    let largest = "Maximum Delta-V Longitudinal";
    assert_eq!([doubts(largest, "-15"), doubts(largest, "-33")], [1, 0]);
    // Without a sign it may be the size.
    let sizes = |end| {
        let text = format!(
            "Time [ms],Delta-V Longitudinal [km/h],{largest} [km/h]\n\
             0,0,{end}\n50,-16,\n100,-30,\n120,-32,\n"
        );
        let doubts = read(&text, None).unwrap().doubts;
        doubts.iter().filter(|doubt| doubt.contains("contradict")).count()
    };
    assert_eq!([sizes("33"), sizes("15")], [0, 1]);
}

#[test]
fn a_change_of_velocity_that_goes_back_is_said() {
    let is_said = |last: &str| {
        let text = format!("Time [s],Delta-V Longitudinal [mph]\n0,0\n0.06,-20\n0.2,{last}\n");
        let record = read(&text, None).unwrap();
        record.doubts.iter().any(|doubt| doubt.contains("more than one impact"))
    };
    assert!(is_said("-0.5") && !is_said("-19"));
}

/// The change in each 10 ms of a crash with a change of 25 km/h in all: it was read as one of 0 km/h without a word.
#[test]
fn a_column_of_changes_from_sample_to_sample_is_said() {
    let steps = [0, -2, -4, -5, -6, -4, -3, -1, 0, 0];
    let rows = |value: &dyn Fn(usize) -> i32| -> String {
        (0..steps.len()).map(|row| format!("{},{}\n", 10 * row, value(row))).collect()
    };
    let is_said = |rows: &str| {
        let text = format!("Time [ms],Delta-V Longitudinal [km/h]\n{rows}");
        let record = read(&text, None).unwrap();
        record.doubts.iter().any(|doubt| doubt.contains("add them up"))
    };
    assert!(is_said(&rows(&|row| steps[row])));
    assert!(!is_said(&rows(&|row| steps[..=row].iter().sum())));
}

/// Zeros after the end of a record, and the 127 km/h that stand for no value.
#[test]
fn rows_that_fill_up_a_record_are_no_change_of_velocity() {
    for (fill, word) in [("0", "zero at its end"), ("127", "as in no crash")] {
        let text = format!(
            "Time [ms],Delta-V Longitudinal [km/h],Delta-V Lateral [km/h]\n\
             0,0,0\n50,-16,1\n100,-30,2\n120,-32,2\n150,{fill},2\n200,{fill},2\n"
        );
        let record = read(&text, None).unwrap();
        assert!(record.delta_v_ahead.is_none() && record.delta_v_right.is_some(), "{record:?}");
        assert!(record.doubts.iter().any(|doubt| doubt.contains(word)), "{record:?}");
    }
    // A small change to the side does go back to zero.
    let text = "Time [ms],Delta-V Lateral [km/h]\n0,0\n50,1\n100,0\n150,0\n";
    assert_eq!(read(text, None).unwrap().delta_v_right.unwrap().delta_v_m_s, 0.0);
}

#[test]
fn a_largest_change_of_velocity_beyond_the_record_is_said() {
    let status = "SYSTEM STATUS AT EVENT (EVENT RECORD 1)\n\
        \"Maximum Delta-V, Longitudinal (MPH [km/h])\",";
    let is_said = |largest: &str| {
        let record = read(&format!("{REPORT}{status}{largest}\n"), None).unwrap();
        record.doubts.iter().any(|doubt| doubt.contains("the largest change of velocity"))
    };
    assert!(is_said("-35 [-56]"));
    assert!(!is_said("-20 [-32]"));
}

/// A change of velocity that stays at the end of the range, and the 127 km/h of a status that stand for no value.
#[test]
fn a_change_of_velocity_at_the_end_of_the_range_is_said() {
    let is_said = |text: &str| {
        let record = read(text, None).unwrap();
        assert!(record.delta_v_ahead.is_some() || record.delta_v_right.is_some(), "{record:?}");
        record.doubts.iter().any(|doubt| doubt.contains("may have been larger"))
    };
    let rows = |end: i32| {
        format!("Time [ms],Delta-V Longitudinal [km/h]\n0,0\n60,-60\n110,{end}\n150,{end}\n")
    };
    assert!(is_said(&rows(-100)) && !is_said(&rows(-98)));
    let status = |largest: &str| {
        format!(
            "CDR FILE INFORMATION\nSYSTEM STATUS AT EVENT (EVENT RECORD 1)\n\
             \"Maximum Delta-V, Lateral (MPH [km/h])\",{largest}\n"
        )
    };
    assert!(is_said(&status("79 [127]")) && !is_said(&status("5 [8]")));
}

/// A driver who steers away from a crash turns the wheel further than that.
#[test]
fn a_steering_wheel_at_the_end_of_the_range_is_said() {
    let is_said = |end: i32| {
        let text = format!(
            "Time [s],Speed [km/h],Steering Wheel Angle [deg]\n-1,40,0\n-0.5,38,-120\n0,36,{end}\n"
        );
        let record = read(&text, None).unwrap();
        assert_eq!(record.before.steering_wheel_rad.len(), 3);
        record.doubts.iter().any(|doubt| doubt.contains("turned further"))
    };
    assert!(is_said(-250) && !is_said(-245) && !is_said(-300));
}

/// Some modules call the column by its unit alone, and others record an acceleration.
#[test]
fn a_table_of_the_crash_of_which_nothing_is_read_is_said() {
    let is_said = |column: &str| {
        let column = format!("Time (msec),{column}\n");
        let text = REPORT.replace("Time (msec),\"Delta-V, Longitudinal (MPH [km/h])\"\n", &column);
        let record = read(&text, None).unwrap();
        record.doubts.iter().any(|doubt| doubt.contains("nothing is read of the table"))
    };
    assert!(is_said("km/h") && is_said("Longitudinal Acceleration (g)"));
    assert!(!is_said("\"Delta-V, Longitudinal (MPH [km/h])\""));
    // What is wrong with a column is said of it.
    assert!(!is_said("Longitudinal Delta-V"));
}

/// Wheels that lock, and the 255 km/h that stand for no value: neither is the speed of the car.
#[test]
fn a_speed_that_tires_cannot_reach_is_not_taken() {
    for wrong in ["0", "255"] {
        let text = format!("Time [s],Speed [km/h]\n-1,64\n-0.5,{wrong}\n0,{wrong}\n");
        let record = read(&text, None).unwrap();
        assert_eq!((record.speed_before, record.before.time_s.len()), (None, 3));
        assert!(record.doubts.iter().any(|doubt| doubt.contains("tires")), "{record:?}");
    }
    let braking = read("Time [s],Speed [km/h]\n-1,64\n-0.5,48\n0,31\n", None).unwrap();
    assert!(braking.speed_before.is_some() && braking.doubts.is_empty(), "{braking:?}");
}

/// A recorder whose speed stays at the last number that it has.
#[test]
fn a_speed_at_the_limit_of_a_recorder_is_not_taken() {
    for (unit, limit) in [("mph", "126"), ("mph", "127"), ("km/h", "255"), ("km/h", "202.78")] {
        let text = format!("Time [s],Speed [{unit}]\n-1,{limit}\n-0.5,{limit}\n0,{limit}\n");
        let record = read(&text, None).unwrap();
        assert_eq!((record.speed_before, record.before.time_s.len()), (None, 3), "{limit}");
        assert!(record.doubts.iter().any(|doubt| doubt.contains("stop counting")), "{record:?}");
    }
    // Braked from there, the last speed is one.
    let braked = read("Time [s],Speed [mph]\n-1,126\n-0.5,120\n0,112\n", None).unwrap();
    assert!(braked.speed_before.is_some() && braked.doubts.is_empty(), "{braked:?}");
    let fast = read("Time [s],Speed [km/h]\n-1,250\n-0.5,250\n0,250\n", None).unwrap();
    assert!(fast.speed_before.is_some() && fast.doubts.is_empty(), "{fast:?}");
}

#[test]
fn a_speed_after_the_time_of_the_crash_is_said() {
    let record = read("Time [s],Speed [km/h]\n0,64\n0.5,58\n1,48\n", None).unwrap();
    assert!(record.doubts.iter().any(|doubt| doubt.contains("after 0 s")), "{record:?}");
}
