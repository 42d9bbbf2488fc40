//! Tests of the export of a Bosch CDR tool.

use super::*;

const REPORT: &str = "CDR FILE INFORMATION\nUser Entered VIN/Frame Number,X1\n\
    EDR Device Type,Module 7\nComplete File Recorded,No\n\
    SYSTEM STATUS AT EVENT (EVENT RECORD 1)\n\
    \"Maximum Delta-V, Longitudinal (MPH [km/h])\",-14.9 [-24.0]\n\
    \"PRE-CRASH DATA -5 TO 0 SEC, TABLE 1 OF 1 (EVENT RECORD 1)\"\n\
    Times (sec),\"Speed, Vehicle Indicated (MPH [km/h])\",Steering Input (deg),Service Brake\n\
    -5.0,31 [50],0,Off\n-4.5,30 [48],-12,On\n\
    PRE-CRASH DATA (EVENT RECORD 2)\nEvent record 2 contains no recorded data\n";

#[test]
fn the_table_before_the_crash_keeps_its_lines() {
    let path = Path::new("r.csv");
    let table = as_table(path, REPORT, &ReadSettings::default()).unwrap().unwrap();
    let lines: Vec<&str> = table.text.lines().collect();
    assert_eq!(lines[7], "time [sec]\tspeed [MPH]\tsteering wheel [deg]\tService Brake");
    assert_eq!(lines[8], "-5\t31\t0\tOff");
    assert_eq!(lines.len(), 10);
    let said = table.said;
    assert_eq!(said.device, "Module 7");
    assert!(said.doubts[0].contains("complete file recorded: No"), "{:?}", said.doubts);
    assert!(said.doubts[1].contains("without recorded data"), "{:?}", said.doubts);
    assert!(said.description.contains("device: Module 7"), "{}", said.description);
    assert!(as_table(path, "t,fx\n0,1\n", &ReadSettings::default()).unwrap().is_none());
}

/// What the first event said was taken for all.
#[test]
fn each_event_says_whether_it_is_complete() {
    let status = |event: u32, complete: &str| {
        format!(
            "SYSTEM STATUS AT EVENT (EVENT RECORD {event})\nComplete File Recorded,{complete}\n"
        )
    };
    let doubts = |second: &str| {
        let text = format!("CDR FILE INFORMATION\n{}{}", status(1, "Yes"), status(2, second));
        Report::parse(Path::new("r.csv"), &text).unwrap().doubts()
    };
    assert!(doubts("Yes").is_empty());
    let [doubt] = <[String; 1]>::try_from(doubts("No")).unwrap();
    assert!(
        doubt.contains("recorded: No, in \"SYSTEM STATUS AT EVENT (EVENT RECORD 2)\""),
        "{doubt}"
    );
}

#[test]
fn keys_have_their_numbers() {
    let report = Report::parse(Path::new("r.csv"), REPORT).unwrap();
    let (name, value) = report.sections[1].number("maximumdeltavlongitudinal").unwrap();
    assert_eq!(
        (column_name(name).as_str(), value),
        ("Maximum Delta-V, Longitudinal [MPH]", -14.9,)
    );
    assert_eq!(report.value("edrdevicetype"), Some("Module 7"));
}

/// Ford has its units without parentheses; 31 mph was read as 31 km/h.
#[test]
fn the_first_of_two_units_is_that_of_the_numbers() {
    for (name, expected) in [
        ("Speed vehicle indicated MPH [km/h]", "speed [MPH]"),
        ("Speed, Vehicle Indicated (MPH [km/h])", "speed [MPH]"),
        ("Maximum delta-V, longitudinal, MPH [km/h]", "Maximum delta-V, longitudinal, [MPH]"),
        ("Speed (MPH) [km/h]", "speed [MPH]"),
        ("km/h [MPH]", " [km/h]"),
        ("Speed [km/h]", "Speed [km/h]"),
        ("Delta V [km/h]", "Delta V [km/h]"),
    ] {
        assert_eq!(column_name(name), expected, "{name}");
    }
    let text = REPORT
        .replace("Speed, Vehicle Indicated (MPH [km/h])", "Speed vehicle indicated MPH [km/h]");
    let table = as_table(Path::new("r.csv"), &text, &ReadSettings::default()).unwrap().unwrap();
    assert!(table.text.contains("time [sec]\tspeed [MPH]\tsteering wheel [deg]"), "{}", table.text);
}
