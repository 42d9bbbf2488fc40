//! Records of recorders, as reports and as tables.

use super::*;

#[path = "recorder_doubt_tests.rs"]
mod doubts;

fn read(text: &str, event: Option<usize>) -> Result<RecorderRecord, DataError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("edr.csv");
    std::fs::write(&path, text).unwrap();
    RecorderRecord::read(&path, event)
}

const REPORT: &str = "CDR FILE INFORMATION\nEDR Device Type,Module 7\n\
    Complete File Recorded,Yes\nPRE-CRASH DATA [2 SAMPLES/SEC] (EVENT RECORD 1)\n\
    Times (sec),\"Speed, Vehicle Indicated (MPH [km/h])\",Steering Input (deg),Service Brake\n\
    -1.0,40 [64],0,Off\n-0.5,36 [58],10,On\n0,30 [48],20,On\n\
    \"DELTA-V, LONGITUDINAL (EVENT RECORD 1)\"\n\
    Time (msec),\"Delta-V, Longitudinal (MPH [km/h])\"\n\
    0,0\n50,-10\n80,-19\n100,-20\n120,-20\n\
    SYSTEM STATUS AT EVENT (EVENT RECORD 2)\n\
    \"Maximum Delta-V, Lateral (MPH [km/h])\",5.0 [8]\n\
    \"Time, Maximum Delta-V, Lateral (msec)\",150\n";

#[test]
fn a_report_gives_evidence_and_controls() {
    let record = read(REPORT, None).unwrap();
    assert_eq!(record.event, "EVENT RECORD 1");
    let mph = 0.447_04;
    let delta_v = record.delta_v_ahead.unwrap();
    assert!((delta_v.delta_v_m_s + 20.0 * mph).abs() < 1e-9, "{delta_v:?}");
    assert_eq!((delta_v.ends_s, delta_v.is_cut), (Some(0.12), false));
    let speed = record.speed_before.unwrap();
    assert!((speed.speed_m_s - 30.0 * mph).abs() < 1e-9 && speed.at_s == 0.0, "{speed:?}");
    assert_eq!(record.before.time_s, [-1.0, -0.5, 0.0]);
    assert!((record.before.steering_wheel_rad[2] - 20_f64.to_radians()).abs() < 1e-12);
    assert_eq!(record.before.is_braked, [false, true, true]);
    assert!(record.doubts.iter().any(|doubt| doubt.starts_with("2 events")), "{record:?}");
    let second = read(REPORT, Some(2)).unwrap();
    let lateral = second.delta_v_right.unwrap();
    assert!((lateral.delta_v_m_s - 5.0 * mph).abs() < 1e-9, "{lateral:?}");
    assert_eq!((lateral.ends_s, second.delta_v_ahead), (Some(0.15), None));
    assert!(read(REPORT, Some(3)).is_err());
}

/// Older modules have the times of the seconds before the crash in a row.
#[test]
fn a_table_before_the_crash_that_lies_on_its_side_is_read_or_said() {
    let with_table = |table: &str| {
        let place = REPORT.find("Times (sec)").unwrap()..REPORT.find("\"DELTA-V, LONG").unwrap();
        let mut text = REPORT.to_owned();
        text.replace_range(place, table);
        read(&text, None).unwrap()
    };
    let is_said = |record: &RecorderRecord| {
        record.doubts.iter().any(|doubt| doubt.contains("no header above"))
    };
    let speeds = "\"Vehicle Speed (MPH [km/h])\",40 [64],36 [58],30 [48]\nBrake,Off,Off,On\n";
    for times in ["Time (sec),-2.6,-1.6,-0.6\n", "Parameter,-2.6 sec,-1.6 sec,-0.6 sec\n"] {
        let record = with_table(&format!("{times}{speeds}"));
        let speed = record.speed_before.unwrap();
        assert_eq!((speed.speed_m_s, speed.at_s), (30.0 * 0.447_04, -0.6), "{times}");
        assert_eq!(record.before.time_s, [-2.6, -1.6, -0.6]);
        assert_eq!(record.before.is_braked, [false, false, true]);
        assert!(record.delta_v_ahead.is_some() && !is_said(&record), "{record:?}");
        assert!(record.description.contains("stand in a row"), "{}", record.description);
    }
    let open = with_table(&format!("Seconds,-2.6,-1.6,-0.6\n{speeds}"));
    assert!(open.speed_before.is_none() && is_said(&open), "{open:?}");
    assert!(!is_said(&read(REPORT, None).unwrap()));
    // The same of any table, and with decimal commas.
    let table = "Time [s];-1,0;-0,5;0\nSpeed [km/h];64,0;58,3;48,7\n";
    let record = read(table, None).unwrap();
    let speed = record.speed_before.unwrap();
    assert!((speed.speed_m_s - 48.7 / 3.6).abs() < 1e-12, "{record:?}");
    assert_eq!(record.before.time_s, [-1.0, -0.5, 0.0]);
}

/// A report that a spreadsheet with decimal commas has saved, which leaves the text `40 [64.4]` as it is.
const GERMAN: &str = "CDR FILE INFORMATION;;;\nEDR Device Type;Module 7;;\n\
    Complete File Recorded;Yes;;\nPRE-CRASH DATA [2 SAMPLES/SEC] (EVENT RECORD 1);;;\n\
    Times (sec);Speed, Vehicle Indicated (MPH [km/h]);Steering Input (deg);Service Brake\n\
    -1,0;40 [64.4];0,5;Off\n-0,5;36 [57,9];10;Ein\n0;30 [48];20;On\n\
    DELTA-V, LONGITUDINAL (EVENT RECORD 1);;;\n\
    Time (msec);Delta-V, Longitudinal (MPH [km/h]);;\n\
    0;0;;\n50;-10,25;;\n80;-19,5;;\n100;-20,1;;\n120;-20,1;;\n\
    SYSTEM STATUS AT EVENT (EVENT RECORD 2);;;\n\
    Maximum Delta-V, Lateral (MPH [km/h]);5,5 [8,9];;\n";

#[test]
fn a_report_with_decimal_commas_is_read() {
    let mph = 0.447_04;
    let record = read(GERMAN, None).unwrap();
    let delta_v = record.delta_v_ahead.unwrap();
    assert!((delta_v.delta_v_m_s + 20.1 * mph).abs() < 1e-9, "{delta_v:?}");
    assert_eq!((delta_v.ends_s, delta_v.is_cut), (Some(0.12), false));
    assert_eq!(record.before.time_s, [-1.0, -0.5, 0.0]);
    assert!((record.before.speed_m_s[0] - 40.0 * mph).abs() < 1e-9, "{record:?}");
    assert!((record.before.steering_wheel_rad[0] - 0.5_f64.to_radians()).abs() < 1e-12);
    assert_eq!(record.before.is_braked, [false, true, true]);
    let lateral = read(GERMAN, Some(2)).unwrap().delta_v_right.unwrap();
    assert!((lateral.delta_v_m_s - 5.5 * mph).abs() < 1e-9, "{lateral:?}");
    // Commas between the cells, and in numbers within quotation marks.
    let quoted = "CDR FILE INFORMATION\nEDR Device Type,Module 7\nComplete File Recorded,Yes\n\
        PRE-CRASH DATA (EVENT RECORD 1)\nTimes (sec),\"Speed (MPH [km/h])\"\n\
        \"-0,5\",36 [58]\n\"0,0\",\"30,5 [49,1]\"\n";
    let record = read(quoted, None).unwrap();
    assert_eq!(record.before.time_s, [-0.5, 0.0]);
    let speed = record.speed_before.unwrap();
    assert!((speed.speed_m_s - 30.5 * mph).abs() < 1e-9, "{speed:?}");
}

/// A spreadsheet makes the date `04. Mai` of 4.5.
#[test]
fn cells_that_are_no_numbers_are_said() {
    let is_said = |record: &RecorderRecord, words: &str| {
        record.doubts.iter().any(|doubt| doubt.contains("no numbers") && doubt.contains(words))
    };
    let broken =
        REPORT.replace("50,-10\n", "50,10. Feb\n").replace("-0.5,36 [58]", "05. Mai,36 [58]");
    let record = read(&broken, None).unwrap();
    assert!(is_said(&record, "10. Feb") && is_said(&record, "05. Mai"), "{record:?}");
    assert!(!is_said(&read(REPORT, None).unwrap(), ""));
    let table = read("Time [s];Speed [km/h]\n-1;64\n-0.5;SNA\n0;48\n", None).unwrap();
    assert!(is_said(&table, "SNA"), "{table:?}");
    // Nothing says what the comma is.
    let open = read("Time [s];Speed [km/h]\n-1;64\n0;48,125\n", None).unwrap();
    assert!((open.speed_before.unwrap().speed_m_s - 48.125 / 3.6).abs() < 1e-12, "{open:?}");
    assert!(open.doubts.iter().any(|doubt| doubt.contains("48,125")), "{open:?}");
}

#[test]
fn events_are_told_apart_and_their_tables_belong_together() {
    for (title, event) in [
        ("PRE-CRASH DATA (EVENT RECORD 1)", Some("EVENT RECORD 1")),
        ("PRE-CRASH DATA (EVENT RECORD 1 TABLE 2 OF 2)", Some("EVENT RECORD 1")),
        ("PRE-CRASH DATA (MOST RECENT EVENT) (TABLE 1 OF 2)", Some("MOST RECENT EVENT")),
        ("DELTA-V LONGITUDINAL (NON-DEPLOYMENT)", Some("NON-DEPLOYMENT")),
        ("PRE-CRASH DATA (EVENT RECORD 1 - TABLE 2 OF 2)", Some("EVENT RECORD 1")),
        ("PRE-CRASH DATA (EVENT RECORD 1 - NON-DEPLOYMENT)", Some("EVENT RECORD 1")),
        ("PRE-CRASH DATA (EVENT RECORD 1 - DEPLOYMENT - TABLE 1 OF 2)", Some("EVENT RECORD 1")),
        ("PRE-CRASH DATA ([2 SAMPLES/SEC] MOST RECENT EVENT)", Some("MOST RECENT EVENT")),
        ("PRE-CRASH DATA (Most Recent Event - table 1 of 2)", Some("Most Recent Event")),
        (
            "DELTA-V LATERAL (MOST RECENT EVENT - DEPLOYMENT)",
            Some("MOST RECENT EVENT - DEPLOYMENT"),
        ),
        ("PRE-CRASH DATA -5 TO 0 SEC (2 SAMPLES/SEC)", None),
    ] {
        assert_eq!(event_of(title).as_deref(), event, "{title}");
    }
    // Event 2 was the second half of the tables of event 1.
    let divided = REPORT.replace(
        "\"DELTA-V, LONGITUDINAL (EVENT RECORD 1)\"",
        "\"DELTA-V, LONGITUDINAL (EVENT RECORD 1 - TABLE 1 OF 1)\"",
    );
    let [first, second] = [None, Some(2)].map(|event| read(&divided, event).unwrap());
    assert!(first.delta_v_ahead.is_some() && first.events.len() == 2, "{first:?}");
    assert_eq!((second.event.as_str(), second.delta_v_ahead), ("EVENT RECORD 2", None));
    // Δv of a table without an event is that of none of two events.
    let other =
        REPORT.replace("\"DELTA-V, LONGITUDINAL (EVENT RECORD 1)\"", "\"DELTA-V, LONGITUDINAL\"");
    let record = read(&other, None).unwrap();
    assert_eq!(record.delta_v_ahead, None);
    let said = |word: &str| record.doubts.iter().any(|doubt| doubt.contains(word));
    assert!(said("of which event"), "{record:?}");
}

/// A tool divides a wide table of the seconds before the crash; either part may come first.
#[test]
fn parts_of_one_table_before_the_crash_are_read_together() {
    let title =
        |number| format!("PRE-CRASH DATA [2 SAMPLES/SEC] (EVENT RECORD 1 TABLE {number} OF 2)\n");
    let speed = "Times (sec),\"Speed, Vehicle Indicated (MPH [km/h])\"\n-1.0,40 [64]\n-0.5,36 [58]\n0,30 [48]\n";
    let steering = |at: &str| format!("Times (sec),Steering Input (deg)\n-1.0,0\n{at},10\n0,20\n");
    let record = |tables: [&str; 2]| {
        let head = "CDR FILE INFORMATION\nComplete File Recorded,Yes\n";
        let [first, second] = tables;
        read(&format!("{head}{}{first}{}{second}", title(1), title(2)), None).unwrap()
    };
    for tables in [[speed, &steering("-0.5")], [&steering("-0.5"), speed]] {
        let record = record(tables);
        assert_eq!(record.before.time_s, [-1.0, -0.5, 0.0]);
        assert!((record.before.steering_wheel_rad[2] - 20_f64.to_radians()).abs() < 1e-12);
        assert!(record.speed_before.is_some() && record.doubts.is_empty(), "{record:?}");
    }
    // Parts with times of their own are two tables.
    for tables in [[speed, &steering("-0.4")], [&steering("-0.4"), speed]] {
        let record = record(tables);
        assert!(record.speed_before.is_some(), "{record:?}");
        assert!(record.doubts.iter().any(|doubt| doubt.contains("not read")), "{record:?}");
    }
    // Two tables with a speed each may be of two events.
    let twice = record([speed, &speed.replace("40 [64]", "38 [61]")]);
    assert!((twice.before.speed_m_s[0] - 40.0 * 0.447_04).abs() < 1e-9, "{twice:?}");
    assert!(twice.doubts.iter().any(|doubt| doubt.contains("another table")), "{twice:?}");
}

/// Δv ahead is cut off at 0.1 s, that to the right goes on to 0.25 s.
#[test]
fn changes_of_velocity_without_a_common_end_are_not_both_taken() {
    let text = |end: &str| {
        format!(
            "Time [ms],Delta-V Longitudinal [km/h],Delta-V Lateral [km/h]\n\
             0,0,0\n50,-10,1\n80,-18,2\n100,{end},3\n200,,4\n250,,4\n"
        )
    };
    let record = read(&text("-25"), None).unwrap();
    assert!(record.delta_v_ahead.is_some() && record.delta_v_right.is_none(), "{record:?}");
    assert!(record.doubts.iter().any(|doubt| doubt.contains("different times")), "{record:?}");
    let settled = read(&text("-18"), None).unwrap();
    assert!(settled.delta_v_ahead.is_some() && settled.delta_v_right.is_some(), "{settled:?}");
}

#[test]
fn a_pulse_that_is_cut_off_is_said_so() {
    let cut = REPORT.replace("100,-20\n120,-20\n", "100,-24\n");
    let record = read(&cut, None).unwrap();
    assert!(record.delta_v_ahead.unwrap().is_cut);
    assert!(record.doubts.iter().any(|doubt| doubt.contains("cut off")), "{record:?}");
}

#[test]
fn a_record_of_a_few_milliseconds_is_no_whole_pulse() {
    let rows = |rows: &str| read(&format!("Time [ms],Delta-V Longitudinal [km/h]\n{rows}"), None);
    let short = rows("0,0\n5,-2\n10,-5\n").unwrap();
    assert!(short.delta_v_ahead.unwrap().is_cut, "{short:?}");
    assert!(short.doubts.iter().any(|doubt| doubt.contains("cut off")), "{short:?}");
    // The largest change alone does not say that it went on.
    assert!(!rows("120,-32\n").unwrap().delta_v_ahead.unwrap().is_cut);
    // Before the crash nothing has changed, which is no change of 0 km/h by it.
    let text = "Time [ms],Speed [km/h],Delta-V Longitudinal [km/h]\n-1000,64,0\n-0,60,0\n";
    let before = read(text, None).unwrap();
    assert_eq!(before.delta_v_ahead, None);
    assert!(before.before.time_s.iter().all(|at_s| at_s.to_bits() != (-0.0_f64).to_bits()));
}

/// Times before the crash that are written positive, from the first sample on or from the crash back.
#[test]
fn times_that_count_back_from_the_crash_are_read_where_their_column_says_so() {
    let down = "1.0,64\n0.5,58\n0,48\n";
    let up = "0,48\n0.5,58\n1.0,64\n";
    for (name, rows) in [
        ("Time before crash [s]", down),
        ("Time before crash [s]", up),
        ("Seconds Before AE", down),
        ("Time prior to AE (s)", up),
        ("Time to impact [s]", down),
        ("Pre-Crash Time [s]", down),
        ("Time [s]", "0,48\n-0.5,58\n-1.0,64\n"),
    ] {
        let record = read(&format!("{name},Speed [km/h]\n{rows}"), None).unwrap();
        let speed = record.speed_before.unwrap();
        assert!((speed.speed_m_s - 48.0 / 3.6).abs() < 1e-12 && speed.at_s == 0.0, "{name}");
        assert_eq!(record.before.time_s, [-1.0, -0.5, 0.0], "{name}");
        assert!((record.before.speed_m_s[0] - 64.0 / 3.6).abs() < 1e-12, "{name}");
        let is_said = record.doubts.iter().any(|doubt| doubt.contains("read as negative"));
        assert_eq!(is_said, name != "Time [s]", "{name}: {:?}", record.doubts);
    }
    // Nothing says that these count back, or that the record does not go on from its first sample to the crash.
    for (name, rows, words) in
        [("Time [s]", down, "Time before crash [s]"), ("Pre-Crash Time [s]", up, "shift the times")]
    {
        let record = read(&format!("{name},Speed [km/h]\n{rows}"), None).unwrap();
        assert_eq!(record.before.time_s, [0.0], "{name}");
        assert!(record.doubts.iter().any(|doubt| doubt.contains(words)), "{:?}", record.doubts);
    }
}

#[test]
fn an_anti_lock_system_that_was_at_work_is_read() {
    let text = "Time [s],Speed [mph],Service Brake,ABS Activity\n\
        -1,31,Off,Non-Engaged\n-0.5,27,On,Engaged\n0,20,On,Engaged\n";
    let before = read(text, None).unwrap().before;
    assert_eq!(before.is_anti_lock_active, [false, true, true]);
    assert_eq!(before.is_braked, [false, true, true]);
}

#[test]
fn a_table_needs_units() {
    let text = "Time [s],Speed [mph],Yaw Rate [deg/s],Steering Wheel Angle [deg]\n\
        -1,31,0,0\n-0.5,27,-2,-10\n0,26,0,0\n";
    let record = read(text, None).unwrap();
    assert!((record.speed_before.unwrap().speed_m_s - 26.0 * 0.447_04).abs() < 1e-9);
    assert_eq!(record.before.yaw_rate_right_rad_s.len(), 3);
    let without = "Time [s],Speed,Steering Wheel Angle [deg]\n-1,31,0\n0,26,1\n";
    let error = read(without, None).unwrap_err().to_string();
    assert!(error.contains("no record of an event data recorder"), "{error}");
}

#[test]
fn a_table_has_one_event_and_times_that_increase() {
    let text = "Time [s],Speed [mph]\n-1,31\n-0.5,27\n0,26\n";
    assert!(read(text, Some(1)).is_ok());
    let error = read(text, Some(2)).unwrap_err().to_string();
    assert!(error.contains("edr.csv") && error.contains("event 2"), "{error}");
    for text in ["Time [s],Speed [mph]\n0,26\n-1,31\n", "Time [s],Speed [mph]\n-1,31\n-1,31\n"] {
        let error = read(text, None).unwrap_err().to_string();
        assert!(error.contains("do not increase") && error.contains("edr.csv"), "{error}");
    }
}

#[test]
fn rows_without_a_speed_between_others_are_counted() {
    let text = "Time [s],Speed [mph]\n-2,\n-1.5,31\n-1,\n-0.5,27\n0,\n";
    let record = read(text, None).unwrap();
    assert_eq!(record.before.time_s, [-1.5, -0.5]);
    let doubt = record.doubts.iter().find(|doubt| doubt.contains("have no speed")).unwrap();
    assert!(doubt.contains(": 1;"), "{doubt}");
}

/// Columns that stand before that of the car's own speed and of its service brake.
#[test]
fn a_speed_is_that_of_the_car_and_a_brake_that_of_the_driver() {
    let text = |extra: &str, brake: &str| {
        let row =
            |at: i32, on: &str| format!("{at},20,20.4,Off,{},{on},{}\n", 60 + 2 * at, 2 * (at + 3));
        format!(
            "Time [s],{extra} [km/h],Brake Pedal Position [%],Parking Brake,Vehicle Speed [km/h],{brake},Stability \
             Control Yaw Rate [deg/s]\n{}{}{}",
            row(-2, "Off"),
            row(-1, "On"),
            row(0, "On")
        )
    };
    for extra in ["Speed Wheel LF", "ACC Speed", "Relative Speed", "GPS Speed"] {
        let record = read(&text(extra, "Service Brake"), None).unwrap();
        let speed = record.speed_before.unwrap();
        assert!((speed.speed_m_s - 60.0 / 3.6).abs() < 1e-9, "{extra}: {speed:?}");
        assert_eq!(record.before.is_braked, [false, true, true], "{extra}");
        assert_eq!(record.before.yaw_rate_right_rad_s.len(), 3);
    }
    let said = |record: &RecorderRecord, word: &str| {
        record.doubts.iter().any(|doubt| doubt.contains(word))
    };
    let two = read(&text("Speed over ground", "Service Brake"), None).unwrap();
    assert!(said(&two, "and not \"Vehicle Speed"), "{two:?}");
    let open = text("ACC Speed", "Service Brake").replace("On", "Circuit open");
    let open = read(&open, None).unwrap();
    assert!(open.before.is_braked.is_empty() && said(&open, "on or off throughout"), "{open:?}");
}

/// A speed by satellites, or of a wheel, is not that of the car as its recorder has it.
#[test]
fn a_speed_that_may_not_be_that_of_the_car_is_said() {
    let row = |at: i32| format!("{},60,{}\n", 10 * at, -4 * at);
    let rows: String = (-3..12).map(row).collect();
    let text =
        |name: &str| format!("Time [ms],{name} [km/h],\"Delta-V, longitudinal [km/h]\"\n{rows}");
    let record = read(&text("GPS Speed"), None).unwrap();
    assert!(record.speed_before.is_none(), "{record:?}");
    let is_said =
        |doubt: &String| doubt.starts_with("\"GPS Speed") && doubt.contains("is not read");
    assert!(record.doubts.iter().any(is_said), "{record:?}");
    let own = read(&text("Vehicle Speed"), None).unwrap();
    assert!(!own.doubts.iter().any(|doubt| doubt.contains("is not read")), "{own:?}");
}

/// A change from sample to sample is none over time, and a direction that is not named is none that is known.
#[test]
fn a_change_of_velocity_that_is_not_read_is_said() {
    let text = |name: &str| {
        let row = |at: i32| format!("{},{},{}\n", 10 * at, -4 * at, -3 * at);
        let rows: String = (0..12).map(row).collect();
        format!("Time [ms],\"Delta-V, longitudinal [km/h]\",\"{name} [km/h]\"\n{rows}")
    };
    for name in ["Delta-V Y", "Delta-V, lateral Change Per Sample"] {
        let record = read(&text(name), None).unwrap();
        assert!(record.delta_v_ahead.is_some() && record.delta_v_right.is_none(), "{record:?}");
        let is_said = |doubt: &String| doubt.contains(name) && doubt.ends_with("it is not read");
        assert!(record.doubts.iter().any(is_said), "{record:?}");
    }
    let plain = read(&text("Delta-V, lateral"), None).unwrap();
    assert!(plain.delta_v_right.is_some(), "{plain:?}");
    assert!(!plain.doubts.iter().any(|doubt| doubt.ends_with("it is not read")), "{plain:?}");
}

/// A column that names its side is turned where that is not the usual one, and no option turns it again.
#[test]
fn a_side_that_a_column_names_counts() {
    let text = |lateral: &str, yaw_rate: &str, steering: &str| {
        format!(
            "Time [s],Speed [km/h],\"Steering wheel angle{steering} [deg]\",Yaw rate{yaw_rate} [deg/s],\
             \"Delta-V lateral{lateral} [km/h]\"\n-0.5,60,10,2,\n0,58,20,4,0\n0.05,,,,9\n0.1,,,,9\n0.15,,,,9\n"
        )
    };
    let usual = read(&text("", "", ""), None).unwrap();
    let values = |record: &RecorderRecord| {
        let lateral = record.delta_v_right.unwrap().delta_v_m_s;
        [lateral, record.before.yaw_rate_right_rad_s[1], record.before.steering_wheel_rad[1]]
    };
    let turned = values(&usual).map(|value| 0.0 - value);
    assert_eq!((usual.sides, usual.doubts.len()), (RecordedSides::default(), 0), "{usual:?}");
    let named = text(" (left positive)", " (CCW positive)", ", positive to the right");
    let mut other = read(&named, None).unwrap();
    assert_eq!(values(&other), turned, "{other:?}");
    assert_eq!(other.doubts.iter().filter(|doubt| doubt.contains("it is turned")).count(), 3);
    other.turn_lateral();
    other.turn_yaw_rate();
    other.turn_steering();
    assert_eq!((values(&other), other.doubts.len()), (turned, 3), "{other:?}");
    let mut same = read(&text(" (right positive)", "", ""), None).unwrap();
    assert_eq!(values(&same), values(&usual));
    same.turn_lateral();
    same.turn_steering();
    let [lateral, _, steering] = values(&same);
    assert_eq!((lateral, steering), (values(&usual)[0], turned[2]));
    assert!(same.doubts.iter().any(|doubt| doubt.contains("the column counts")), "{same:?}");
    // The angle of the road wheels is none of the steering wheel.
    let road = text("", "", "").replace("Steering wheel angle", "Steering angle of a road wheel");
    let road = read(&road, None).unwrap();
    assert!(road.before.steering_wheel_rad.is_empty(), "{road:?}");
    assert!(road.doubts.iter().any(|doubt| doubt.contains("road wheels")), "{road:?}");
}

/// The part of a velocity to the side and a brake assistant stand before what is wanted in some tables.
#[test]
fn a_lateral_speed_and_a_brake_assistant_are_others() {
    let text = "Time [s],Lateral Speed [km/h],Speed [km/h],Brake Assist,Emergency Brake,Brake\n\
        -0.5,1,60,Off,Off,Off\n0,2,58,Off,Off,On\n";
    let record = read(text, None).unwrap();
    let speed = record.speed_before.unwrap();
    assert!((speed.speed_m_s - 58.0 / 3.6).abs() < 1e-12, "{record:?}");
    assert_eq!(record.before.is_braked, [false, true]);
}

/// Headers as a German workshop writes them, with the columns that are not meant before those that are.
#[test]
fn headers_in_german_are_read() {
    let text = "Zeit vor Kollision [s];Quergeschwindigkeit [km/h];Radgeschwindigkeit vorne links [km/h];\
        Fahrzeuggeschwindigkeit [km/h];Bremsassistent;Feststellbremse;Betriebsbremse;\
        Lenkradwinkel (rechts positiv) [Grad];Gierrate [Grad/s]\n\
        1,0;1;70;60;aus;aus;aus;10;2\n0,5;1;70;58;aus;aus;ein;20;4\n0,0;1;70;50;aus;aus;ein;20;4\n";
    let record = read(text, None).unwrap();
    let speed = record.speed_before.unwrap();
    assert!((speed.speed_m_s - 50.0 / 3.6).abs() < 1e-12 && speed.at_s == 0.0, "{record:?}");
    assert_eq!(record.before.time_s, [-1.0, -0.5, 0.0]);
    assert_eq!(record.before.is_braked, [false, true, true]);
    assert!((record.before.steering_wheel_rad[2] + 20_f64.to_radians()).abs() < 1e-12);
    assert!((record.before.yaw_rate_right_rad_s[2] - 4_f64.to_radians()).abs() < 1e-12);
    let delta_v = |header: &str| {
        let rows: String = (0..12).map(|at| format!("{};{};{}\n", 10 * at, -4 * at, -at)).collect();
        let record = read(&format!("{header}\n{rows}"), None).unwrap();
        (record.delta_v_ahead, record.delta_v_right)
    };
    let english = delta_v("Time [ms];Delta-V longitudinal [km/h];Delta-V lateral [km/h]");
    assert!(english.0.is_some() && english.1.is_some(), "{english:?}");
    for [ahead, right] in [
        ["Delta-V l\u{e4}ngs", "Delta-V quer"],
        ["Geschwindigkeits\u{e4}nderung l\u{e4}ngs", "Geschwindigkeitsaenderung seitlich"],
    ] {
        let german = delta_v(&format!("Zeit [ms];{ahead} [km/h];{right} [km/h]"));
        assert_eq!(german, english, "{ahead}");
    }
}

/// Such a table is opened as that of a recorder without being told.
#[test]
fn a_change_of_velocity_in_german_makes_a_record() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("edr.csv");
    for (header, expected) in [
        ("Zeit [ms];Geschwindigkeits\u{e4}nderung l\u{e4}ngs [km/h]", true),
        ("Zeit [ms];Delta-V l\u{e4}ngs [km/h]", true),
        ("Zeit [ms];Geschwindigkeit [km/h]", false),
    ] {
        std::fs::write(&path, format!("{header}\n0;0\n10;-4\n20;-8\n")).unwrap();
        assert_eq!(RecorderRecord::is_record(&path), expected, "{header}");
    }
}
