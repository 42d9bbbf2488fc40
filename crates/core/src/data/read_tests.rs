//! Single files as programs and people write them, and what is read of them or said.

use crate::data::{Channel, ColumnMap, DataError, Loaded, Note, check_file, read_any_series};

/// Reads a text as a file.
///
/// - `map`: what is said of its columns; empty if nothing is.
fn read(text: &str, map: &str) -> Result<Loaded, DataError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.csv");
    std::fs::write(&path, text).unwrap();
    let map: ColumnMap = map.parse().unwrap();
    read_any_series(&path, Some(&map))
}

fn error(text: &str, map: &str) -> String {
    read(text, map).unwrap_err().to_string()
}

/// The values of a channel, SI units.
fn values(loaded: &Loaded, channel: Channel) -> Vec<f64> {
    let values = loaded.series.get(channel);
    values.unwrap_or_else(|| panic!("{channel:?}: {:?}", loaded.notes)).to_vec()
}

fn is_said(loaded: &Loaded, words: &str) -> bool {
    loaded.notes.iter().any(|note| note.to_string().contains(words))
}

#[test]
fn a_row_of_units_may_stand_above_the_names() {
    let rows = "0;0;1\n10;2;4\n20;1;2\n";
    for head in [
        "[ms];[kN];[kN]\ntime;fx;fy\n",
        "ms;kN;kN\ntime;fx;fy\n",
        "a test;of;Monday\nms;kN;kN\ntime;fx;fy\n",
        "# ms;kN;kN\n# time;fx;fy\n",
        "time;fx;fy\nms;kN;kN\n",
    ] {
        let loaded = read(&format!("{head}{rows}"), "").unwrap();
        assert_eq!(loaded.series.time_s(), [0.0, 0.01, 0.02], "{head}");
        assert_eq!(values(&loaded, Channel::Fx), [0.0, 2e3, 1e3], "{head}");
        assert!(!loaded.notes.iter().any(|note| matches!(note, Note::UnitAssumed(_))), "{head}");
    }
    // Names that are not known are names all the same, and the units are those above them.
    let text = format!("ms;kN;kN\nMesszeit;Kraft quer;Kraft hoch\n{rows}");
    let loaded = read(&text, "time=Messzeit,fx=2,fy=3").unwrap();
    assert_eq!(values(&loaded, Channel::Fy), [1e3, 4e3, 2e3]);
    // The numbers of columns are no units.
    let loaded = read(&format!("(1);(2);(3)\ntime;fx;fy\n{rows}"), "").unwrap();
    assert_eq!(values(&loaded, Channel::Fx), [0.0, 2.0, 1.0]);
    assert!(is_said(&loaded, "names no unit; taken as N"), "{:?}", loaded.notes);
}

#[test]
fn a_header_and_a_row_of_units_that_differ_are_refused() {
    let rows = "0;0;1\n0.1;2;4\n0.2;1;2\n";
    let said = error(&format!("time;Fx [kN];Fy\ns;N;N\n{rows}"), "");
    assert!(said.contains("kN by its header and N by the row of units"), "{said}");
    let mapped = error(&format!("time;Kraft [kN];fy\ns;N;N\n{rows}"), "fx=2");
    assert!(mapped.contains("kN by its header and N by the row of units"), "{mapped}");
    assert!(read(&format!("time;Fx [kN];Fy\ns;N;N\n{rows}"), "fx=2:kN").is_ok());
    assert!(read(&format!("time;Fx [kN];Fy [kN]\ns;kN;kN\n{rows}"), "").is_ok());
}

/// What a person can mend in the file is said with the place.
#[test]
fn units_in_cells_a_second_header_and_scaled_degrees_name_the_remedy() {
    for (text, place, words) in [
        ("time,x,y\n0 s,0 m,0 m\n1 s,10 m,0 m\n", "f.csv:2:1", "unit into the header"),
        ("time [s],x,y\n0,0 m,0\n1,10 m,0\n", "f.csv:2:2", "unit into the header"),
        ("time,x,y\nChannel 1,Channel 2,Channel 3\n0,0,0\n1,10,0\n", "f.csv:2:1", "second line"),
        ("time,lat,lon\n0,525200000,134100000\n1,525201000,134100000\n", "f.csv:2:2", "× 10⁷"),
    ] {
        let said = error(text, "");
        assert!(said.contains(place) && said.contains(words), "{said}");
    }
    let other = error("time,x,y\n0,0,0\n1,n/a,0\n", "");
    assert!(!other.contains("header"), "{other}");
}

/// As spreadsheets write headers of several lines in one cell.
#[test]
fn a_quoted_header_over_several_lines_is_refused_with_the_remedy() {
    let said = error("\"time\n[s]\",\"x\n[m]\",\"y\n[m]\"\n0,0,0\n1,10,0\n", "");
    assert!(said.contains("write the header in one line"), "{said}");
}

/// Of columns of fixed widths a cell may be empty, or a name may be two words.
#[test]
fn a_row_between_blanks_with_other_fields_names_what_divides_them() {
    let rows = "0.0  0.0  0.0  start\n1.0  10.0  0.0\n2.0  20.0  0.0  end\n";
    let said = error(&format!("time  x  y  note\n{rows}"), "");
    assert!(said.contains("f.csv:3: ") && said.contains("with semicolons"), "{said}");
    let said = error("time,x,y\n0,0,0\n1,10\n", "");
    assert!(said.ends_with("complete the row or remove it"), "{said}");
}

/// A recorder samples speed and change of velocity at times of their own, and leaves the other cells blank.
#[test]
fn a_blank_cell_of_a_recorder_names_the_option_that_reads_it() {
    let hint = "impactlab import --recorder";
    let table = "Time [s],Speed [mph],\"Delta-V, Longitudinal [km/h]\"\n-1,31,\n0,27,0\n0.1,,-9\n";
    let said = error(table, "");
    assert!(said.contains(hint) && said.contains("f.csv:"), "{said}");
    let steered = "Time [s],Steering Wheel Angle [deg],Speed [mph],Service Brake\n\
        0,0,31,Off\n0.5,,27,On\n";
    let said = error(steered, "");
    assert!(said.contains("f.csv:3:2: ") && said.contains(hint), "{said}");
    let before = error("Time [s],Speed [mph],Service Brake\n-1,31,Off\n0,27,On\n", "");
    assert!(before.contains(hint), "{before}");
    for log in [
        "time [s],x [m],y [m]\n0,0,0\n1,,0\n",
        "time [s],x [m],y [m],speed [m/s],steering_wheel [deg]\n0,0,0,15,0\n1,,0,15,1\n",
        "time [s],latitude [deg],longitude [deg],speed [km/h],throttle [%]\n0,48,11,50,0\n1,,11,50,1\n",
    ] {
        let said = error(log, "");
        assert!(said.contains("f.csv:3:2: ") && !said.contains(hint), "{said}");
    }
}

/// Test logs mean the steering wheel by `Lenkwinkel` more often than not.
#[test]
fn a_steer_angle_that_may_be_that_of_the_steering_wheel_is_said_or_asked_for() {
    let rows = |largest: f64| format!("0,0\n0.5,{largest}\n1,{}\n", -largest);
    let wheel = "steering_wheel=2:deg";
    for header in ["Zeit [s],Lenkwinkel [deg]", "time [s],Steer_Angle [deg]", "t,steer_angle_deg"] {
        let small = read(&format!("{header}\n{}", rows(12.0)), "").unwrap();
        assert!((values(&small, Channel::Steer)[1] - 12_f64.to_radians()).abs() < 1e-12);
        let is_said = |note: &Note| note.is_doubt() && note.to_string().contains(wheel);
        assert!(small.notes.iter().any(is_said), "{header}: {:?}", small.notes);
        let said = error(&format!("{header}\n{}", rows(180.0)), "");
        assert!(said.contains("further than road wheels do") && said.contains(wheel), "{said}");
        let turned = read(&format!("{header}\n{}", rows(180.0)), wheel).unwrap();
        let angle = values(&turned, Channel::SteeringWheel);
        assert!((angle[1] - std::f64::consts::PI).abs() < 1e-12, "{angle:?}");
        assert!(!is_said_any(&turned), "{:?}", turned.notes);
    }
    // A unit that nobody states is asked for with it.
    let said = error(&format!("Zeit [s],Lenkwinkel\n{}", rows(180.0)), "");
    assert!(said.contains(wheel), "{said}");
    // Who says that it is the road wheels' has said it, and other names leave nothing open.
    let text = format!("Zeit [s],Lenkwinkel [deg]\n{}", rows(12.0));
    assert!(!is_said_any(&read(&text, "steer=2").unwrap()));
    let text = format!("time [s],steer [deg]\n{}", rows(12.0));
    assert!(!is_said_any(&read(&text, "").unwrap()));
    let both = "Zeit [s],Lenkwinkel [deg],Lenkradwinkel [deg]\n0,0,0\n0.5,5,80\n1,6,96\n";
    assert!(!is_said_any(&read(both, "").unwrap()));
}

fn is_said_any(loaded: &Loaded) -> bool {
    is_said(loaded, "angle of the road wheels")
}

#[test]
fn front_wheels_that_turn_against_each_other_are_said() {
    let text = |sign: f64| {
        let row = |i: u32| {
            let angle = 5.0 * (0.1 * f64::from(i)).sin();
            format!("{},{angle},{}\n", 0.1 * f64::from(i), 0.9 * sign * angle)
        };
        let rows: String = (0..40).map(row).collect();
        format!("time [s],steer_fl [deg],steer_fr [deg]\n{rows}")
    };
    let words = "map steer_fr=-3:deg";
    assert!(is_said(&read(&text(-1.0), "").unwrap(), words));
    assert!(!is_said(&read(&text(1.0), "").unwrap(), words));
    assert!(!is_said(&read(&text(-1.0), "steer_fr=-3:deg").unwrap(), words));
}

/// What a receiver or a sensor writes where it has no value.
#[test]
fn numbers_that_stand_for_none_are_flagged_in_a_file() {
    let row = |i: u32| {
        let (t, none) = (0.02 * f64::from(i), (50..53).contains(&i));
        let angle = if none { -999.0 } else { 60.0 * t.sin() };
        format!("{t},{angle}\n")
    };
    let rows: String = (0..200).map(row).collect();
    let loaded = read(&format!("time [s],steering wheel [deg]\n{rows}"), "").unwrap();
    let flags: Vec<String> = check_file(&loaded).iter().map(ToString::to_string).collect();
    assert!(flags.iter().any(|flag| flag.contains("the steer angle jumps by")), "{flags:?}");
}

/// A column that says to which side it is positive is turned by that, and by the axes of a map not once more.
#[test]
fn a_column_that_names_its_side_is_read_by_it() {
    let (right, left) = (
        "Steering wheel angle (right positive) [deg]",
        "Steering wheel angle [deg] (left positive)",
    );
    for (name, map, expected_deg) in [
        (right, "", -9.0),
        (left, "", 9.0),
        (right, "y_axis=right", -9.0),
        (left, "y_axis=right", 9.0),
        // A map says the sign itself.
        (right, "steering_wheel=2:deg", 9.0),
    ] {
        let loaded = read(&format!("t [s];{name}\n0;0\n1;9\n"), map).unwrap();
        let angle_deg = values(&loaded, Channel::SteeringWheel)[1].to_degrees();
        assert!((angle_deg - expected_deg).abs() < 1e-9, "{name} {map}: {angle_deg}");
        assert_eq!(is_said(&loaded, "as it says"), !map.contains('2'), "{name} {map}");
    }
}

/// One unit that is not known neither hides the others nor makes another kind of file of it.
#[test]
fn a_unit_that_is_not_known_is_named_with_its_column() {
    let loaded = read("t;x;y;yaw\ns;m;m;mils\n0;0;0;0\n1;9;0;0\n", "").unwrap();
    assert_eq!(values(&loaded, Channel::X), [0.0, 9.0]);
    assert!(is_said(&loaded, "\"mils\" is no unit of angle"), "{:?}", loaded.notes);
    let said = error("t [s];x [rod];y [rod]\n0;0;0\n1;9;0\n", "");
    assert!(said.contains("is in \"rod\", expected a unit of length"), "{said}");
}

/// Maps write longitude and latitude as x and y.
#[test]
fn degrees_that_are_read_as_metres_are_said() {
    let drive = |x: f64, y: f64, step: f64| {
        let row = |i: u32| format!("{};{};{y}\n", 0.5 * f64::from(i), x + step * f64::from(i));
        let rows: String = (0..20).map(row).collect();
        read(&format!("t;x;y\n{rows}"), "").unwrap()
    };
    let degrees = drive(9.0, 52.0, 1e-4);
    assert!(is_said(&degrees, "map x=east(3 2),y=north(3 2)"), "{:?}", degrees.notes);
    for metres in [drive(9.0, 52.0, 5.0), drive(9.0, 52.0, 0.0), drive(0.0, 0.0, 1e-4)] {
        assert!(!is_said(&metres, "longitude"), "{:?}", metres.notes);
    }
}

/// Two runs below each other are told as such, whether the header stands between them or not.
#[test]
fn a_second_record_below_the_first_one_is_told() {
    let rows = |from: f64| -> String {
        (0..10).map(|i| format!("{},{},0\n", from + 0.1 * f64::from(i), 2 * i)).collect()
    };
    let head = "t [s],x [m],y [m]\n";
    let said = error(&format!("{head}{}{}", rows(-0.9), rows(-0.9)), "");
    assert!(said.contains(":12:1: \"t [s]\" is \"-0.9\""), "{said}");
    assert!(said.contains("of 2 below each other") && said.contains("up to line 11"), "{said}");
    let said = error(&format!("{head}{}{head}{}", rows(0.0), rows(0.0)), "");
    assert!(said.contains("the header stands here again"), "{said}");
    // A row out of order is one.
    let said = error(&format!("{head}0,0,0\n1,9,0\n0.5,4,0\n2,18,0\n"), "");
    assert!(said.contains("sort the rows"), "{said}");
}
