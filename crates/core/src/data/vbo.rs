//! Reads the files of Racelogic's data loggers (VBO) as tables.
//!
//! A VBO file has sections in brackets. Latitude and longitude are in minutes of arc, the latter positive
//! to the west; the time is HHMMSS.ss, the heading a compass course and the velocity in the unit that `[header]` says,
//! usually km/h.
//!
//! `[channel units]` has a line for each channel that is not one of the logger itself, which may be empty; those
//! of the channels of modules stand at the end of the list as their columns do at the end of a row. Columns that
//! begin with an underscore are those of the receiver alone where the others are those of the logger with its
//! inertial sensor.

use crate::data::Separator;
use crate::data::dialect::Dialect;
use crate::data::formats::{Converted, OF_COURSE, Said};
use crate::data::spelling;
use crate::data::time_of_day::DAY_S;
use crate::data::yaw_rate::{MOVING_M_S, tells_sides};
use crate::numerics::wrap_angle_rad;
use crate::units::Quantity;

/// What a remark says of such a file.
const DESCRIPTION: &str = "a Racelogic VBO file: places from latitude and longitude, yaw from the course over \
     ground, v_x from the velocity along it";

/// What is said of a yaw rate that the course cannot confirm.
const OPEN_SIDE: &str = "the sign of the yaw rate could not be compared with the course, as the car hardly turns \
     where it drives; by the type of the sensor it is positive clockwise or counterclockwise";

/// What is said of a channel that is taken for the angle of the steering wheel.
const OF_STEERING: &str = "the steering angle is taken as that of the steering wheel, positive to the left, \
     which the file does not say";

/// Names of channels with the angle of the steering wheel.
const STEERING: [&str; 3] = ["steeringangle", "steeringwheelangle", "steeringwheel"];

/// The unit of a channel for which the file has one that cannot be its own; no quantity has it, so that the column
/// is left out until a map says its unit.
const UNCLEAR: &str = "unit unclear";

/// Channels of the logger itself, without signs between their letters, none of which has a unit in the list.
const OWN_CHANNELS: [&str; 26] = [
    "sats",
    "satellites",
    "time",
    "lat",
    "latitude",
    "long",
    "longitude",
    "velocity",
    "heading",
    "height",
    "vertvel",
    "verticalvelocity",
    "longacc",
    "latacc",
    "glonasssats",
    "gpssats",
    "beidousats",
    "imukalmanfilterstatus",
    "solutiontype",
    "velocityquality",
    "event1",
    "event2",
    "triggereventtime",
    "avifileindex",
    "avitime",
    "avisynctime",
];

/// Parts of names of channels, with beginnings of the units that they can have.
const KINDS: [(&[&str], &[&str]); 3] = [
    (&["yawrate", "pitchrate", "rollrate"], &["°/s", "º/s", "deg/s", "rad/s"]),
    (&["xaccel", "yaccel", "zaccel", "longacc", "latacc"], &["g", "m/s"]),
    (&["wheelsp", "vehiclespeed"], &["km/h", "kmh", "kph", "m/s", "mph", "kn", "kt"]),
];

/// A column of the file: its kind, and the name and unit that it gets.
enum Column {
    Time,
    Latitude,
    Longitude,
    Heading,
    Velocity,
    Other,
}

/// The unit of the velocities.
struct Velocity {
    /// The header of their column.
    name: String,
    /// Metres per second in the unit of the header; `None` if it is none that is known.
    unit_m_s: Option<f64>,
}

/// The course over ground of the rows in which the car drives.
#[derive(Default)]
struct Course {
    n_rows: usize,
    n_slow: usize,
    last_rad: Option<f64>,
    /// How far it has turned, row by row.
    turned_rad: Vec<f64>,
}

impl Course {
    fn take(&mut self, speed_m_s: Option<f64>, course_rad: Option<f64>) {
        let (Some(speed_m_s), Some(course_rad)) = (speed_m_s, course_rad) else { return };
        self.n_rows += 1;
        if speed_m_s < MOVING_M_S {
            self.n_slow += 1;
            self.last_rad = None;
            return;
        }
        let step_rad = self.last_rad.map_or(0.0, |last_rad| wrap_angle_rad(course_rad - last_rad));
        self.turned_rad.push(self.turned_rad.last().copied().unwrap_or_default() + step_rad);
        self.last_rad = Some(course_rad);
    }

    /// What of it is in doubt, in words.
    fn doubts(&self, names: &[&str]) -> Vec<String> {
        let has = |part: &str| names.iter().any(|name| plain(name).contains(part));
        let slow = (self.n_slow > 0).then(|| {
            format!(
                "{} of {} rows are slower than {MOVING_M_S} m/s: their course over ground is noise, and so is \
                 the yaw angle that is made of it",
                self.n_slow, self.n_rows
            )
        });
        let side = (has("yawrate") && !tells_sides(&self.turned_rad)).then(|| OPEN_SIDE.to_owned());
        let course = has("heading").then(|| OF_COURSE.to_owned());
        let steering = steering(names).map(|_| OF_STEERING.to_owned());
        course.into_iter().chain(slow).chain(side).chain(steering).collect()
    }
}

/// The text as a table whose fields are separated by tabs, with every row in the line in which it stands;
/// `None` if it is no VBO file.
pub(super) fn as_table(text: &str) -> Option<Converted> {
    let is_section = |line: &str, name: &'static str| line.trim().eq_ignore_ascii_case(name);
    let start = text.lines().position(|line| is_section(line, "[data]"))?;
    let section = |name: &'static str| {
        let lines =
            text.lines().take(start).skip_while(move |line| !is_section(line, name)).skip(1);
        lines.map(str::trim).take_while(|line| !line.starts_with('['))
    };
    let names: Vec<&str> = section("[column names]").flat_map(str::split_whitespace).collect();
    if names.is_empty() {
        return None;
    }
    let units = units(&names, section("[channel units]").collect());
    let velocity = velocity(section("[header]"));
    let steering = steering(&names);
    let of_columns = names.iter().zip(units).enumerate();
    let columns: Vec<(Column, String)> = of_columns
        .map(|(idx, (name, unit))| match steering == Some(idx) {
            // Nothing else in the file contradicts an angle that is taken in a wrong unit.
            true => {
                let is_angle = |unit: &&str| spelling::unit(Quantity::Angle, unit).is_some();
                column("steering_wheel", unit.filter(is_angle).or(Some(UNCLEAR)), &velocity)
            }
            false => column(name, unit, &velocity),
        })
        .collect();
    let header: Vec<&str> = columns.iter().map(|(_, name)| name.as_str()).collect();
    let mut table = "\n".repeat(start);
    table.push_str(&header.join("\t"));
    let (mut last_s, mut days_s, mut course) = (0.0, 0.0, Course::default());
    for line in text.lines().skip(start + 1) {
        table.push('\n');
        let mut cells = Vec::new();
        let (mut speed_m_s, mut course_rad) = (None, None);
        for (idx, cell) in line.split_whitespace().enumerate() {
            let (separator, decimal_comma, thousands) = (Separator::Blanks, false, None);
            let plain = Dialect { separator, decimal_comma, thousands };
            let number = plain.number(cell);
            let converted = match (columns.get(idx).map(|(column, _)| column), number) {
                (Some(Column::Time), Some(clock)) => seconds(clock).map(|time_s| {
                    if time_s + days_s < last_s - DAY_S / 2.0 {
                        days_s += DAY_S;
                    }
                    last_s = time_s + days_s;
                    last_s
                }),
                (Some(Column::Latitude), Some(minutes)) => Some(minutes / 60.0),
                (Some(Column::Longitude), Some(minutes)) => Some(0.0 - minutes / 60.0),
                (Some(Column::Heading), Some(heading_deg)) => {
                    course_rad = Some(heading_deg.to_radians());
                    Some(90.0 - heading_deg)
                }
                (Some(Column::Velocity), Some(number)) => {
                    speed_m_s = velocity.unit_m_s.map(|unit_m_s| number.abs() * unit_m_s);
                    None
                }
                _ => None,
            };
            cells.push(converted.map_or_else(|| cell.to_owned(), |number| number.to_string()));
        }
        table.push_str(&cells.join("\t"));
        course.take(speed_m_s, course_rad);
    }
    table.push('\n');
    let said = Said {
        description: DESCRIPTION.to_owned(),
        doubts: course.doubts(&names),
        keeps_lines: true,
        ..Said::default()
    };
    Some(Converted { text: table, said })
}

/// The index of the one channel with the angle of the steering wheel.
fn steering(names: &[&str]) -> Option<usize> {
    let mut found =
        names.iter().enumerate().filter(|(_, name)| STEERING.contains(&plain(name).as_str()));
    let (idx, _) = found.next()?;
    found.next().is_none().then_some(idx)
}

/// The letters and digits of a name, small.
fn plain(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// The unit of the velocities.
///
/// - `lines`: of the list of channels, such as `velocity kmh`.
fn velocity<'a>(mut lines: impl Iterator<Item = &'a str>) -> Velocity {
    let word = lines.find_map(|line| {
        let (name, unit) = line.split_at_checked("velocity".len())?;
        let is_it = name.eq_ignore_ascii_case("velocity") && plain(unit) != "quality";
        is_it.then(|| unit.trim().to_lowercase())
    });
    let word = word.filter(|word| !word.is_empty()).unwrap_or_else(|| "km/h".to_owned());
    let known = spelling::unit(Quantity::Speed, &word);
    Velocity {
        name: format!("vx [{}]", known.map_or(word.as_str(), |unit| unit.symbol)),
        unit_m_s: known.map(|unit| unit.si_per_unit),
    }
}

/// The unit of each column, if it has one.
///
/// - `lines`: of the list of units, with empty ones.
fn units<'a>(names: &[&str], mut lines: Vec<&'a str>) -> Vec<Option<&'a str>> {
    // An empty line stands between the list and the next section.
    lines.pop_if(|last| last.is_empty());
    let is_own = |name: &str| name.starts_with('_') || OWN_CHANNELS.contains(&plain(name).as_str());
    let n_of_modules = names.iter().rev().take_while(|name| !is_own(name)).count();
    let n_before = names.len() - n_of_modules;
    let of_modules = lines.len().checked_sub(n_of_modules).and_then(|from| lines.get(from..));
    let suits = |(name, unit): (&&str, &&str)| {
        let (name, unit) = (plain(name), unit.to_lowercase());
        let kind = KINDS.iter().find(|(words, _)| words.iter().any(|word| name.contains(word)));
        kind.is_none_or(|(_, units)| units.iter().any(|of| unit.starts_with(of)))
    };
    let of_names = names.get(n_before..).unwrap_or_default();
    let known = of_modules.filter(|units| of_names.iter().zip(*units).all(suits));
    let of_module = |idx: usize| match known {
        Some(units) => units.get(idx).copied().filter(|unit| !unit.is_empty()),
        None if lines.is_empty() => None,
        None => Some(UNCLEAR),
    };
    let before = std::iter::repeat_n(None, n_before);
    before.chain((0..n_of_modules).map(of_module)).collect()
}

fn column(name: &str, unit: Option<&str>, velocity: &Velocity) -> (Column, String) {
    let named = |name: &str| name.to_owned();
    match name.to_lowercase().as_str() {
        "time" => (Column::Time, named("time [s]")),
        "lat" | "latitude" => (Column::Latitude, named("latitude [deg]")),
        "long" | "longitude" => (Column::Longitude, named("longitude [deg]")),
        "heading" => (Column::Heading, named("yaw [deg]")),
        "velocity" => (Column::Velocity, velocity.name.clone()),
        own if own.starts_with('_') => (Column::Other, format!("receiver alone{name}")),
        _ => match unit {
            Some(unit) => (Column::Other, format!("{name} [{unit}]")),
            None => (Column::Other, named(name)),
        },
    }
}

/// Seconds since midnight of HHMMSS.ss; `None` for a number that is none.
fn seconds(clock: f64) -> Option<f64> {
    let (hours, minutes, seconds) =
        ((clock / 1e4).floor(), (clock % 1e4 / 100.0).floor(), clock % 100.0);
    let is_clock = (0.0..24.0).contains(&hours) && minutes < 60.0 && seconds < 61.0;
    // The remainder of a binary number has digits that nobody wrote.
    is_clock.then(|| ((hours * 3600.0 + minutes * 60.0 + seconds) * 1e6).round() / 1e6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_keep_their_lines_and_get_their_units() {
        let text = "File created\n\n[channel units]\ndeg/s\n[column names]\n\
            sats time lat long velocity heading Yaw_Rate\n[data]\n\
            011 235959.90 +03120.0 +00060.0 054.000 090.00 +17.2\n\
            011 000000.00 +03120.6 -00060.0 054.000 000.00 +17.2\n";
        let table = as_table(text).unwrap().text;
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(
            lines[6],
            "sats\ttime [s]\tlatitude [deg]\tlongitude [deg]\tvx [km/h]\tyaw [deg]\tYaw_Rate [deg/s]"
        );
        assert_eq!(lines[7], "011\t86399.9\t52\t-1\t054.000\t0\t+17.2");
        assert_eq!(lines[8], "011\t86400\t52.01\t1\t054.000\t90\t+17.2");
        assert!(as_table("[data]\n1 2\n").is_none());
        assert!(as_table("t,fx\n1,2\n").is_none());
    }

    #[test]
    fn units_are_those_of_their_channels_or_unclear() {
        let header = |units: &str, names: &str| {
            let text = format!("[channel units]\n{units}\n[column names]\n{names}\n\n[data]\n1\n");
            let table = as_table(&text).unwrap().text;
            table.lines().find(|line| !line.is_empty()).unwrap().replace('\t', "|")
        };
        // A channel of the logger with a unit, an empty line, and modules of which one has an empty unit.
        assert_eq!(
            header(
                "volts\n\n°/s\ng\n\nkm/h\n",
                "sats AD1 GPS_Sats _lat YawRate X_Accel QF WheelSpeed"
            ),
            "sats|AD1|GPS_Sats|receiver alone_lat|YawRate [°/s]|X_Accel [g]|QF|WheelSpeed [km/h]"
        );
        // The list is one short.
        assert_eq!(
            header("g\nkm/h\n", "sats YawRate X_Accel WheelSpeed"),
            "sats|YawRate [unit unclear]|X_Accel [unit unclear]|WheelSpeed [unit unclear]"
        );
        // It says of a yaw rate that it is in volts.
        assert_eq!(
            header("volts\nkm/h\n", "sats YawRate WheelSpeed"),
            "sats|YawRate [unit unclear]|WheelSpeed [unit unclear]"
        );
        assert_eq!(header("", "sats YawRate"), "sats|YawRate");
    }

    #[test]
    fn one_steering_angle_is_that_of_the_steering_wheel() {
        let read = |names: &str| {
            let n = names.split_whitespace().count() - 1;
            let units = "deg\n".repeat(n);
            let text = format!("[channel units]\n{units}\n[column names]\n{names}\n\n[data]\n1\n");
            let table = as_table(&text).unwrap();
            let header = table.text.lines().find(|line| !line.is_empty()).unwrap().to_owned();
            (header, table.said.doubts.contains(&OF_STEERING.to_owned()))
        };
        assert_eq!(
            read("time Steering_Angle"),
            ("time [s]\tsteering_wheel [deg]".to_owned(), true)
        );
        // Without a list of units degrees would be taken for radians.
        let text = "[column names]\ntime Steering_Angle\n\n[data]\n1\n";
        assert!(as_table(text).unwrap().text.contains("steering_wheel [unit unclear]"));
        for unit in ["%", "counts", "V"] {
            let text = format!(
                "[channel units]\n{unit}\n[column names]\ntime Steering_Angle\n\n[data]\n1 2\n"
            );
            assert!(as_table(&text).unwrap().text.contains("[unit unclear]"), "{unit}");
        }
        // Which of two it is, is asked by a map.
        let (header, is_said) = read("time Steering_Angle SteeringWheel");
        assert!(header.contains("Steering_Angle [deg]") && !is_said, "{header}");
    }

    #[test]
    fn velocities_have_the_unit_of_the_list_of_channels() {
        let read = |line: &str| {
            let text = format!(
                "[header]\nVelocity Quality\n{line}\nvertical velocity m/s\n\n[column names]\n\
                 time velocity\n\n[data]\n100000.00 010.000\n"
            );
            let table = as_table(&text).unwrap().text;
            let lines: Vec<String> =
                table.lines().filter(|line| !line.is_empty()).map(str::to_owned).collect();
            lines.iter().map(|line| line.split_once('\t').unwrap().1.to_owned()).collect::<Vec<_>>()
        };
        for (line, expected) in [
            ("velocity kmh", ["vx [km/h]", "010.000"]),
            ("velocity", ["vx [km/h]", "010.000"]),
            ("Velocity mph", ["vx [mph]", "010.000"]),
            ("velocity m/s", ["vx [m/s]", "010.000"]),
            ("velocity knots", ["vx [kn]", "010.000"]),
            ("velocity furlongs", ["vx [furlongs]", "010.000"]),
            ("", ["vx [km/h]", "010.000"]),
        ] {
            assert_eq!(read(line), expected, "{line}");
        }
    }

    #[test]
    fn a_course_at_rest_and_a_yaw_rate_without_a_turn_are_in_doubt() {
        let doubts = |rows: &str| {
            let names = "time velocity heading YawRate";
            let text = format!("[column names]\n{names}\n\n[data]\n{rows}");
            as_table(&text).unwrap().said.doubts.join("\n")
        };
        let row = |i: u32, speed: u32, course: u32| format!("10000{i}.00 {speed} {course} 0.1\n");
        let bend: String = (0..9).map(|i| row(i, 54, (355 + 5 * i) % 360)).collect();
        let turned = doubts(&bend);
        assert!(turned.contains("slides or spins") && !turned.contains("noise"), "{turned}");
        assert!(!turned.contains("sign of the yaw rate"), "{turned}");
        let straight: String = (0..9).map(|i| row(i, 54, 90)).collect();
        assert!(doubts(&straight).contains("sign of the yaw rate"), "{}", doubts(&straight));
        // At rest the course goes round, which tells nothing.
        let at_rest: String = (0..9).map(|i| row(i, 54 * (i / 8), (130 * i) % 360)).collect();
        let at_rest = doubts(&at_rest);
        assert!(at_rest.contains("8 of 9 rows are slower than 1 m/s"), "{at_rest}");
        assert!(at_rest.contains("sign of the yaw rate"), "{at_rest}");
    }
}
