//! Channels that are computed from several columns, found by the headers of these.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};

use crate::data::columns::{ColumnUse, Term, column_use, stated_unit};
use crate::data::degree_text::{LATITUDE_LETTERS, LONGITUDE_LETTERS, place_deg};
use crate::data::error::quoted;
use crate::data::formats::OF_COURSE;
use crate::data::spelling::letters_and_digits;
use crate::data::{Channel, DataError, Formula, Note, Table};
use crate::units::{Quantity, significant};

/// Headers of latitude and longitude.
const LATITUDE: [&str; 4] = ["latitude", "lat", "gpslat", "breitengrad"];
const LONGITUDE: [&str; 6] = ["longitude", "lon", "long", "lng", "gpslon", "längengrad"];

/// Headers of the four numbers of a quaternion, w first.
const QUATERNIONS: [[&str; 4]; 4] = [
    ["qw", "qx", "qy", "qz"],
    ["quatw", "quatx", "quaty", "quatz"],
    ["quaternionw", "quaternionx", "quaterniony", "quaternionz"],
    ["orientationw", "orientationx", "orientationy", "orientationz"],
];

/// Headers of a course over ground, which is clockwise from north.
const COURSES: [&str; 9] = [
    "course",
    "courseoverground",
    "cog",
    "gpscourse",
    "bearing",
    "trackangle",
    "angletrack",
    "kurs",
    "kursübergrund",
];

/// Latitude and longitude up to which a place is near that of both 0, where maps of simulators begin, degrees.
const NEAR_ZERO_DEG: f64 = 0.1;

/// End of the header of the position of a ROS message along x.
pub(super) const POSE_X: &str = "posepositionx";

/// Ends of headers of a ROS message with a pose, in SI units (REP 103) unless they say others, with their
/// channels; those of a twist are of `nav_msgs/Odometry`, whose twist is in the axes of the vehicle.
const ROS_CHANNELS: [(&str, Channel); 5] = [
    (POSE_X, Channel::X),
    ("posepositiony", Channel::Y),
    ("twisttwistlinearx", Channel::Vx),
    ("twisttwistlineary", Channel::Vy),
    ("twisttwistangularz", Channel::YawRate),
];

/// The channels of a table that are computed from several of its columns, and those of a ROS message with an
/// orientation, whose headers end in what they are.
pub(super) fn columns(table: &Table) -> Vec<ColumnUse> {
    let keys: Vec<String> = table.header().iter().map(|name| key(name)).collect();
    let is_named = |key: &str, name: &str| key == name || (name.len() > 4 && key.ends_with(name));
    let position = |names: &[&str]| {
        let is = |key: &String| names.iter().any(|name| is_named(key, name));
        keys.iter().position(is).map(|idx| idx + 1)
    };
    let mut found = Vec::new();
    if let Some(place) = position(&LATITUDE).zip(position(&LONGITUDE)) {
        let numbers = [place.0, place.1];
        for (channel, formula) in [(Channel::X, Formula::East), (Channel::Y, Formula::North)] {
            found.push(column(table, channel, formula, &numbers));
        }
    }
    // Of two messages in one table a map says which is that of the vehicle.
    let only = |is: &dyn Fn(&str) -> bool| {
        let mut found = (1..).zip(&keys).filter(|(_, key)| is(key));
        let (number, _) = found.next()?;
        found.next().is_none().then_some(number)
    };
    let quaternion = |names: &[&str; 4]| {
        let numbers = names.map(|name| only(&|key| is_named(key, name)));
        numbers.into_iter().collect::<Option<Vec<usize>>>()
    };
    if let Some(numbers) = QUATERNIONS.iter().find_map(quaternion) {
        found.push(column(table, Channel::Yaw, Formula::Quaternion, &numbers));
        let of_message = ROS_CHANNELS.into_iter().filter_map(|(end, channel)| {
            let number = only(&|key| key.ends_with(end))?;
            plain_column(table, channel, number)
        });
        found.extend(of_message);
    } else if let Some(number) = keys.iter().position(|key| COURSES.contains(&key.as_str()))
        && is_in_degrees(table, number)
    {
        found.push(column(table, Channel::Yaw, Formula::Course, &[number + 1]));
    }
    found
}

/// Whether a column is in degrees or names no unit.
fn is_in_degrees(table: &Table, idx: usize) -> bool {
    let name = table.header().get(idx).map_or("", String::as_str);
    let stated = stated_unit(name, table.unit_text(idx), Quantity::Angle);
    stated.is_ok_and(|unit| unit.is_none_or(|unit| unit.symbol == "deg"))
}

/// Says that the yaw angle is a course over ground.
fn course_note(columns: &BTreeMap<Channel, ColumnUse>) -> Option<Note> {
    let yaw = columns.get(&Channel::Yaw)?;
    let is_course = yaw.formula == Some(Formula::Course);
    is_course.then(|| Note::Doubt {
        text: format!("column {}, clockwise from north: {OF_COURSE}", yaw.number),
    })
}

/// The letters of a header without its unit.
pub(super) fn key(name: &str) -> String {
    let name = name.split(['[', '(']).next().unwrap_or(name).trim();
    let lower = name.to_lowercase();
    let name = lower.strip_suffix("_deg").or(lower.strip_suffix(" deg")).unwrap_or(&lower);
    letters_and_digits(name)
}

/// A channel that a formula gives.
///
/// - `numbers`: the numbers of the columns, counted from 1, in the order of the formula.
pub(super) fn column(
    table: &Table,
    channel: Channel,
    formula: Formula,
    numbers: &[usize],
) -> ColumnUse {
    let unit = channel.quantity().si_unit();
    let names = numbers.iter().filter_map(|number| table.header().get(number.checked_sub(1)?));
    let names: Vec<&str> = names.map(String::as_str).collect();
    ColumnUse {
        channel,
        number: numbers.first().copied().unwrap_or_default(),
        name: format!("{} of {}", formula.name(), names.join(", ")),
        unit,
        unit_is_stated: true,
        terms: numbers.iter().map(|&number| Term { number, sign: 1.0, unit }).collect(),
        formula: Some(formula),
    }
}

/// A channel that a column holds in the unit that the file states, else in SI units; `None` where the unit does
/// not measure it.
fn plain_column(table: &Table, channel: Channel, number: usize) -> Option<ColumnUse> {
    let idx = number.checked_sub(1)?;
    let name = table.header().get(idx)?;
    let quantity = channel.quantity();
    let stated = stated_unit(name, table.unit_text(idx), quantity).ok()?;
    let unit = stated.unwrap_or_else(|| quantity.si_unit());
    Some(column_use(channel, number, name.clone(), Some(unit)))
}

/// What is said of channels that are computed.
pub(super) fn notes(
    table: &Table,
    columns: &BTreeMap<Channel, ColumnUse>,
) -> impl Iterator<Item = Note> {
    let places = places_note(table, columns);
    let at_sea = places.as_ref().and_then(at_sea);
    places.into_iter().chain(at_sea).chain(course_note(columns))
}

/// That a place lies where radians lie that are read as degrees, and degrees that are read as minutes of arc: in the Gulf
/// of Guinea, which has no land up to these limits.
fn at_sea(places: &Note) -> Option<Note> {
    let Note::Places { origin_deg: [latitude, longitude] } = places else { return None };
    let is_there = latitude.abs() <= FRAC_PI_2 && longitude.abs() <= PI;
    let is_near_zero = latitude.abs().max(longitude.abs()) < NEAR_ZERO_DEG;
    (is_there && !is_near_zero).then(|| Note::Doubt {
        text: format!(
            "latitude {} and longitude {} deg lie in the Gulf of Guinea: are they in radians, or in degrees where the format \
             has minutes of arc, as VBO does?",
            significant(*latitude),
            significant(*longitude)
        ),
    })
}

/// Says from where positions are counted that follow from latitude and longitude.
fn places_note(table: &Table, columns: &BTreeMap<Channel, ColumnUse>) -> Option<Note> {
    let is_place = |channel: &Channel| {
        let formula = columns.get(channel)?.formula?;
        matches!(formula, Formula::East | Formula::North).then_some(&columns[channel].terms)
    };
    let &[latitude, longitude] = [Channel::X, Channel::Y].iter().find_map(is_place)?.as_slice()
    else {
        return None;
    };
    let degrees = |term: Term, letters| place_deg(table, 0, term.number.checked_sub(1)?, letters);
    let latitude_deg = degrees(latitude, LATITUDE_LETTERS)?;
    Some(Note::Places { origin_deg: [latitude_deg, degrees(longitude, LONGITUDE_LETTERS)?] })
}

/// Refuses places without a fix, and those whose latitude or longitude is no number of degrees to the north and to the
/// east: one in another unit, or one that counts to the south or to the west by its header or by a letter in the next
/// column.
///
/// # Errors
/// [`DataError::Contradiction`].
pub(super) fn check_places(
    table: &Table,
    columns: &BTreeMap<Channel, ColumnUse>,
) -> Result<(), DataError> {
    let is_place =
        |column: &&ColumnUse| matches!(column.formula, Some(Formula::East | Formula::North));
    let Some(place) = columns.values().find(is_place) else { return Ok(()) };
    if let Some(row_idx) = row_without_fix(table, place) {
        let what = format!(
            "line {} has latitude 0 and longitude 0, as receivers write them without a fix: remove such rows",
            table.line(row_idx)
        );
        return Err(DataError::Contradiction { path: table.path().to_owned(), what });
    }
    let letter = |row_idx: usize, idx: usize| table.cell(row_idx, idx).trim().to_lowercase();
    let negative = [(["south", "s"], LATITUDE_LETTERS), (["west", "w"], LONGITUDE_LETTERS)];
    for (term, ([word, short], letters)) in place.terms.iter().zip(negative) {
        let Some(idx) = term.number.checked_sub(1) else { continue };
        let Some(name) = table.header().get(idx) else { continue };
        let stated = stated_unit(name, table.unit_text(idx), Quantity::Angle);
        let is_other_unit = matches!(stated, Ok(Some(unit)) if unit.symbol != "deg");
        let lower = name.to_lowercase();
        let mut words = lower.split(|c: char| !c.is_alphanumeric());
        let is_named = lower.contains(word) || words.any(|of| of == short);
        let is_lettered = |row_idx: usize| letter(row_idx, idx + 1) == short;
        let is_positive =
            |row_idx: usize| place_deg(table, row_idx, idx, letters).is_some_and(|of| of > 0.0);
        let is_turned = |row_idx: usize| (is_named || is_lettered(row_idx)) && is_positive(row_idx);
        if is_other_unit || (0..table.n_rows()).any(is_turned) {
            let what = format!(
                "column {} {} counts to the {word} or is not in degrees; latitudes are read in degrees to the north \
                 and longitudes in degrees to the east: write them so, with a minus to the {word}",
                idx + 1,
                quoted(name)
            );
            return Err(DataError::Contradiction { path: table.path().to_owned(), what });
        }
    }
    Ok(())
}

/// The first row at latitude and longitude 0, of a table with places elsewhere.
fn row_without_fix(table: &Table, place: &ColumnUse) -> Option<usize> {
    let &[latitude, longitude] = place.terms.as_slice() else { return None };
    let columns = [(latitude, LATITUDE_LETTERS), (longitude, LONGITUDE_LETTERS)];
    let size_deg = |row_idx: usize| {
        let degrees = |(term, letters): (Term, _)| {
            place_deg(table, row_idx, term.number.checked_sub(1)?, letters)
        };
        let [latitude, longitude] = columns.map(degrees);
        Some(latitude?.abs().max(longitude?.abs()))
    };
    let rows = || (0..table.n_rows()).filter_map(|row_idx| Some((row_idx, size_deg(row_idx)?)));
    let (row_idx, _) = rows().find(|(_, size_deg)| *size_deg == 0.0)?;
    rows().any(|(_, size_deg)| size_deg > NEAR_ZERO_DEG).then_some(row_idx)
}

/// Whether a formula gives this channel.
pub(super) fn is_of(formula: Formula, channel: Channel) -> bool {
    match formula {
        Formula::Quaternion | Formula::Course => channel == Channel::Yaw,
        Formula::East | Formula::North => matches!(channel, Channel::X | Channel::Y),
    }
}

#[cfg(test)]
mod tests {
    use crate::data::{Channel, ColumnMap, read_any_series};

    /// A car that turns from north over west: a course counts clockwise from north, a yaw angle from the east.
    #[test]
    fn a_course_becomes_a_yaw_angle() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let row = |i: u32| {
            let turned = 0.02 * f64::from(i);
            let [east, north] = [100.0 * (turned.cos() - 1.0), 100.0 * turned.sin()];
            let course_deg = (360.0 - turned.to_degrees()).rem_euclid(360.0);
            format!("{},{east},{north},{course_deg},20\n", 0.1 * f64::from(i))
        };
        let rows: String = (0..50).map(row).collect();
        std::fs::write(
            &path,
            format!("Time [s],East [m],North [m],Course [°],Speed [m/s]\n{rows}"),
        )
        .unwrap();
        let loaded = read_any_series(&path, None).unwrap();
        let yaw = loaded.series.get(Channel::Yaw).unwrap();
        for (i, yaw_rad) in yaw.iter().enumerate() {
            let turned = yaw_rad - yaw[0];
            assert!((turned - 0.02 * i as f64).abs() < 1e-9, "{i}: {turned}");
        }
        let at_start = yaw[0].rem_euclid(std::f64::consts::TAU);
        assert!((at_start - std::f64::consts::FRAC_PI_2).abs() < 1e-9, "{at_start}");
        assert!(loaded.check_consistent(&path).is_ok(), "{:?}", loaded.notes);
        let is_told =
            loaded.notes.iter().any(|note| note.to_string().contains("course over ground"));
        assert!(is_told, "{:?}", loaded.notes);
        let map: ColumnMap = "yaw=course(4),headings=compass".parse().unwrap();
        let mapped = read_any_series(&path, Some(&map)).unwrap();
        assert_eq!(mapped.series.get(Channel::Yaw), loaded.series.get(Channel::Yaw));
    }

    #[test]
    fn places_to_the_west_without_a_minus_and_radians_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let read = |header: &str, side: &str, longitude: &str| {
            let row = |at: u32| format!("{at},40.0,{longitude}{at},{side}\n");
            let text = format!("time [s],{header},side\n{}{}{}", row(0), row(1), row(2));
            std::fs::write(&path, text).unwrap();
            read_any_series(&path, None).map_err(|error| error.to_string())
        };
        assert!(read("latitude,longitude", "E", "83.000").is_ok());
        assert!(read("latitude,longitude", "W", "-83.000").is_ok());
        assert!(read("latitude [deg],longitude [deg]", "x", "-83.000").is_ok());
        for (header, side) in [
            ("latitude,longitude", "W"),
            ("latitude,longitude (W)", "x"),
            ("latitude (N) [deg],longitude (W) [deg]", "x"),
            ("latitude [rad],longitude [rad]", "x"),
        ] {
            let error = read(header, side, "0.000").unwrap_err();
            assert!(error.contains("degrees to the east"), "{header}, {side}: {error}");
        }
    }

    /// The path of a log whose first rows had no fix was that of a car at sea, and shorter by a third.
    #[test]
    fn places_without_a_fix_are_refused_and_those_at_sea_said() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let read = |places: [[f64; 2]; 3]| {
            let row = |(at, [latitude, longitude]): (usize, &[f64; 2])| {
                format!("{at},{latitude},{longitude}\n")
            };
            let rows: String = places.iter().enumerate().map(row).collect();
            std::fs::write(&path, format!("time [s],latitude,longitude\n{rows}")).unwrap();
            read_any_series(&path, None).map_err(|error| error.to_string())
        };
        let is_at_sea = |places| {
            let notes = read(places).unwrap().notes;
            notes.iter().any(|note| note.to_string().contains("Gulf of Guinea"))
        };
        let error = read([[0.0, 0.0], [52.0, 13.0], [52.0001, 13.0]]).unwrap_err();
        assert!(error.contains("line 2 has latitude 0"), "{error}");
        assert!(is_at_sea([[0.9076, 0.2269], [0.9077, 0.2269], [0.9078, 0.2269]]));
        assert!(!is_at_sea([[0.0, 0.0], [0.0001, 0.0], [0.0002, 0.0]]));
        assert!(!is_at_sea([[0.3476, 32.5825], [0.3477, 32.5825], [0.3478, 32.5825]]));
        let rows: String =
            (0..4).map(|i| format!("10000{i}.00 51.985{i} 0.975 40.0 0.0\n")).collect();
        let text = format!("[column names]\ntime lat long velocity heading\n\n[data]\n{rows}");
        std::fs::write(&path, text).unwrap();
        let notes = read_any_series(&path, None).unwrap().notes;
        assert!(notes.iter().any(|note| note.to_string().contains("as VBO does")), "{notes:?}");
    }
}
