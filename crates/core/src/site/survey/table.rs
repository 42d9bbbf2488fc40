//! Reads the points of a total station or a GNSS receiver: a table with a header.
//!
//! ```text
//! name,E,N,Z,code          E [m] and northing_ft say their unit; metres if none is said
//! 101,512345.12,5423456.78,101.3,KERB1
//! ```
//!
//! Separators are commas, semicolons and tabs; a comma is the decimal sign where it separates nothing.
//! Points with the same code of a line stand in their order along it. A code is one of a line if it is a word
//! for one, such as `kerb` or `skid`, with a number behind it where there are several, or if it is named.

use std::collections::BTreeMap;
use std::path::Path;

use csv::{ReaderBuilder, StringRecord};

use crate::ranges::SURVEY_COORDINATE;
use crate::site::survey::doubts::{Places, doubts};
use crate::site::survey::found::{Found, Thing, kept_text, name_and_unit, wrong};
use crate::site::{LengthUnit, MapShape, SiteError, SurveyOptions};

/// Words of headers, in small letters.
const EAST: [&str; 8] = ["e", "east", "easting", "ost", "ostwert", "rechtswert", "rw", "x"];
const NORTH: [&str; 8] = ["n", "north", "northing", "nord", "nordwert", "hochwert", "hw", "y"];
const HEIGHT: [&str; 8] = ["z", "h", "height", "elevation", "elev", "altitude", "höhe", "hoehe"];
const NAME: [&str; 10] =
    ["name", "point", "pt", "nr", "no", "id", "number", "punkt", "punktnummer", "point_no"];
const CODE: [&str; 8] =
    ["code", "description", "desc", "feature", "type", "layer", "objekt", "codierung"];
/// Headers of what is no list of points.
const OF_SERIES: [&str; 6] = ["t", "time", "zeit", "frame", "timestamp", "yaw"];

/// Codes of lines.
const LINES: [&str; 20] = [
    "kerb",
    "curb",
    "bordstein",
    "edge",
    "lane",
    "line",
    "centreline",
    "centerline",
    "wall",
    "fence",
    "barrier",
    "guardrail",
    "skid",
    "yaw",
    "scuff",
    "mark",
    "tiremark",
    "tyremark",
    "track",
    "rand",
];

/// The columns of a table by their index, with the units of coordinates.
#[derive(Debug, PartialEq)]
struct Columns {
    separator: u8,
    east: usize,
    north: usize,
    height: Option<usize>,
    name: Option<usize>,
    code: Option<usize>,
    units: [Option<LengthUnit>; 3],
    /// Names of the columns that are not read.
    others: Vec<String>,
    /// Whether the columns are called x and y, which some surveys count to the north and to the east.
    is_xy: bool,
}

impl Columns {
    /// The columns that a header names; `None` if it is none of a list of points.
    fn from_header(line: &str) -> Option<Self> {
        let separator =
            [b';', b'\t', b','].into_iter().find(|byte| line.as_bytes().contains(byte))?;
        let cells: Vec<(String, Option<LengthUnit>)> =
            line.split(char::from(separator)).map(name_and_unit).collect();
        let find =
            |words: &[&str]| cells.iter().position(|(name, _)| words.contains(&name.as_str()));
        let east = find(&EAST)?;
        // What only has x and y may be anything. Beside them n is the number of a point.
        let is_plain = cells.get(east).is_some_and(|(name, _)| name == "x");
        let north = if is_plain { find(&["y"])? } else { find(&NORTH)? };
        let name = find(&NAME).or_else(|| find(&["n"]).filter(|_| is_plain));
        let (height, code) = (find(&HEIGHT), find(&CODE));
        let is_list = code.is_some() || !is_plain && (name.is_some() || height.is_some());
        let unit = |idx: Option<usize>| cells.get(idx?)?.1;
        let units = [unit(Some(east)), unit(Some(north)), unit(height)];
        let is_of_series = |name: &str| {
            let word = name.split(|letter: char| !letter.is_alphanumeric()).next();
            word.is_some_and(|word| OF_SERIES.contains(&word))
        };
        let is_series = cells.iter().any(|(name, _)| is_of_series(name));
        let used = [Some(east), Some(north), height, name, code];
        let others = line.split(char::from(separator)).map(kept_text).enumerate();
        let others = others.filter(|(idx, name)| !used.contains(&Some(*idx)) && !name.is_empty());
        let others = others.map(|(_, name)| name).collect();
        (is_list && !is_series).then_some(Self {
            separator,
            east,
            north,
            height,
            name,
            code,
            units,
            others,
            is_xy: is_plain,
        })
    }
}

/// Whether a file that begins like this is a list of points.
pub(super) fn is_table(head: &str) -> bool {
    let first = head.lines().next();
    first.and_then(Columns::from_header).is_some() || first.is_some_and(is_point)
}

/// Whether a line is a point without a header above it: its number or name, three coordinates with decimals, and a
/// code. In which order they are the line does not say.
fn is_point(line: &str) -> bool {
    let Some(separator) = [';', '\t', ','].into_iter().find(|of| line.contains(*of)) else {
        return false;
    };
    let cells: Vec<&str> = line.split(separator).map(str::trim).collect();
    let [name, a, b, c, code] = cells[..] else { return false };
    let is_coordinate = |cell: &str| {
        let cell = if separator == ',' { cell.to_owned() } else { cell.replace(',', ".") };
        cell.contains('.') && cell.parse::<f64>().is_ok_and(f64::is_finite)
    };
    let is_name = name.chars().all(char::is_alphanumeric) && !name.is_empty() && name != "0";
    is_name && [a, b, c].into_iter().all(is_coordinate) && code.starts_with(char::is_alphabetic)
}

/// Reads the text of a table.
///
/// # Errors
/// [`SiteError::Survey`] with line and column, [`SiteError::TooManyPoints`],
/// [`SiteError::TooManyObjects`].
pub(super) fn read(path: &Path, text: &str, options: &SurveyOptions) -> Result<Found, SiteError> {
    let text = text.trim_start_matches('\u{feff}');
    let columns = text.lines().next().and_then(Columns::from_header);
    let columns = columns.ok_or_else(|| {
        let expected = "no header names E and N, with a name or a code: write name,N,E,Z,code above the points, or \
                        name,E,N,Z,code if their eastings stand first";
        wrong(path, Some(1), &expected)
    })?;
    let lengths_m = columns.lengths_m(path, options)?;
    let mut builder = ReaderBuilder::new();
    builder.delimiter(columns.separator).flexible(true).has_headers(true);
    let mut found = Found { is_in_metres: true, ..Found::default() };
    let mut lines: BTreeMap<String, usize> = BTreeMap::new();
    let mut places = Places::default();
    for record in builder.from_reader(text.as_bytes()).records() {
        let record = record.map_err(|error| {
            wrong(path, error.position().map(csv::Position::line), &"is no row of a table")
        })?;
        if record.iter().all(|cell| cell.trim().is_empty()) {
            continue;
        }
        let thing = columns.thing(path, &record, lengths_m)?;
        places.take(&thing);
        let code = thing.properties.get("code").cloned().unwrap_or_default();
        if !options.is_line(&code) {
            found.add(path, thing)?;
            continue;
        }
        match lines.get(&code).and_then(|idx| found.things.get_mut(*idx)) {
            Some(line) => line.at.extend(thing.at),
            None => {
                lines.insert(code.clone(), found.things.len());
                found.add(path, Thing { name: code, shape: MapShape::Line, ..thing })?;
            }
        }
    }
    found.notes.extend(columns.notes(options));
    if !lines.is_empty() {
        let codes: Vec<&str> = lines.keys().map(String::as_str).take(20).collect();
        found.notes.push(format!("the points of these codes are joined: {}", codes.join(", ")));
    }
    for line in found.things.iter_mut().filter(|thing| thing.shape == MapShape::Line) {
        line.at.dedup();
    }
    found.notes.extend(doubts(&found.things, 1.0));
    found.notes.extend(places.note());
    Ok(found)
}

impl Columns {
    /// Lengths of the units of E, N and Z, m.
    fn lengths_m(&self, path: &Path, options: &SurveyOptions) -> Result<[f64; 3], SiteError> {
        let [east, north, height] = self.units;
        let plane = options.unit.or(east).or(north);
        if options.unit.is_none() && east.zip(north).is_some_and(|(east, north)| east != north) {
            return Err(wrong(path, Some(1), &"E and N have different units"));
        }
        if plane.is_none() && height.is_some_and(|unit| unit != LengthUnit::Metre) {
            let expected = "the header says the unit of the heights and not that of E and N; write it there, too, or \
                            say one for all (--unit)";
            return Err(wrong(path, Some(1), &expected));
        }
        let plane = plane.unwrap_or_default();
        let height = options.unit.or(height).unwrap_or(plane);
        Ok([plane.length_m(), plane.length_m(), height.length_m()])
    }

    fn notes(&self, options: &SurveyOptions) -> Vec<String> {
        let mut notes = Vec::new();
        if options.unit.is_none() && self.units.iter().take(2).all(Option::is_none) {
            notes.push("no unit is said; coordinates are taken as metres".to_owned());
        }
        if self.is_xy {
            notes.push(
                "x is taken as easting and y as northing; a survey whose x counts to the north (as Hochwert) would be \
                 mirrored: call its columns N and E"
                    .to_owned(),
            );
        }
        if !self.others.is_empty() {
            notes.push(format!("columns that are not read: {}", self.others.join(", ")));
        }
        if self.code.is_none() {
            notes.push("there is no column of codes, so that all are points".to_owned());
        }
        notes
    }

    /// The point of a row.
    fn thing(
        &self,
        path: &Path,
        record: &StringRecord,
        lengths_m: [f64; 3],
    ) -> Result<Thing, SiteError> {
        let line = record.position().map(csv::Position::line);
        let cell = |idx: usize| record.get(idx).unwrap_or_default().trim();
        let number = |idx: usize, length_m: f64| {
            let text = match self.separator {
                b',' => cell(idx).to_owned(),
                _ => cell(idx).replace(',', "."),
            };
            let number = text.parse::<f64>().ok().map(|number| number * length_m);
            let found = number.filter(|number| SURVEY_COORDINATE.contains(*number));
            found.ok_or_else(|| {
                let (line, column) = (line.unwrap_or(1), idx + 1);
                SiteError::Survey {
                    path: path.to_owned(),
                    place: format!(":{line}:{column}"),
                    message: format!(
                        "is {:?}, expected a coordinate of -2e7 to 2e7 m",
                        kept_text(cell(idx))
                    ),
                }
            })
        };
        let at = [number(self.east, lengths_m[0])?, number(self.north, lengths_m[1])?];
        let height = self.height.filter(|idx| !cell(*idx).is_empty());
        let height_m = height.map(|idx| number(idx, lengths_m[2])).transpose()?;
        let name = self.name.map(|idx| kept_text(cell(idx))).unwrap_or_default();
        let code = self.code.map(|idx| kept_text(cell(idx))).unwrap_or_default();
        let properties = [("code".to_owned(), code)].into_iter().collect();
        let shape = MapShape::Point;
        Ok(Thing { name, shape, at: vec![at], height_m, properties, line })
    }
}

impl SurveyOptions {
    /// Whether points of a code are joined to a line.
    fn is_line(&self, code: &str) -> bool {
        let code = code.trim().to_lowercase();
        let word = code.trim_end_matches(|letter: char| !letter.is_alphabetic());
        let mut named = self.line_codes.iter().map(|named| named.trim().to_lowercase());
        !code.is_empty()
            && (LINES.contains(&word) || named.any(|named| named == code || named == word))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_of_points_is_known_and_that_of_a_motion_is_not() {
        for header in [
            "name,E,N,Z,code",
            "Punkt;Rechtswert [m];Hochwert [m];Höhe [m]",
            "point_no\teasting_ft\tnorthing_ft\tdescription",
            "id,x,y,z,code",
            // Points without a header, which are asked for it.
            "101,5423456.78,512345.12,101.3,KERB1",
            "A7;1000,25;2000,50;101,30;Baum",
        ] {
            assert!(is_table(header), "{header}");
        }
        let headerless = "101,5423456.78,512345.12,101.3,KERB1\n";
        let options = SurveyOptions::default();
        let error = read(Path::new("points.csv"), headerless, &options).unwrap_err().to_string();
        assert!(error.contains("write name,N,E,Z,code above"), "{error}");
        for header in [
            "t,x,y",
            "t (s);x (m);y (m);code",
            "time_s,x_m,y_m,code",
            "x,y,z",
            "name = \"E\"",
            "",
            "fx,fy",
            "E,N",
            "frame,e,n,name",
            "0.1,5.25,2.5,101.3,ok",
            "1,5.25,2.5,101.3,7",
            "1,5,2,101,ok",
        ] {
            assert!(!is_table(header), "{header}");
        }
    }

    #[test]
    fn x_and_y_are_said_to_be_east_and_north() {
        let notes = |header: &str| {
            let text = format!("{header}\n1,2,3,4,TREE\n");
            read(Path::new("points.csv"), &text, &SurveyOptions::default()).unwrap().notes
        };
        let is_said = |notes: Vec<String>| notes.iter().any(|note| note.contains("mirrored"));
        assert!(is_said(notes("id,x,y,z,code")));
        assert!(!is_said(notes("id,E,N,Z,code")));
    }

    #[test]
    fn a_number_that_stands_at_two_places_is_said() {
        let notes = |second: &str| {
            let text = format!(
                "id,E,N,code\n101,2,3,KERB\n102,4,3,KERB\nTree,0,0,\nTree,9,9,\n{second}\n"
            );
            let read = read(Path::new("points.csv"), &text, &SurveyOptions::default());
            read.unwrap().notes.join("; ")
        };
        let twice = notes("101,2,8,STONE");
        assert!(twice.contains("more than one place: 101 (5.00 m apart); which"), "{twice}");
        for other in ["103,2,8,STONE", "101,2.02,3,STONE"] {
            assert!(!notes(other).contains("more than one place"), "{other}");
        }
    }

    /// The number of a point was read as its northing.
    #[test]
    fn n_beside_x_and_y_is_a_number() {
        let text = "N,X,Y,Z,Desc\n101,2,3,4,TREE\n";
        let found = read(Path::new("points.csv"), text, &SurveyOptions::default()).unwrap();
        let [tree] = found.things.as_slice() else { panic!("{:?}", found.things) };
        assert_eq!((tree.name.as_str(), tree.at.as_slice()), ("101", [[2.0, 3.0]].as_slice()));
        assert!(!is_table("N,X,Z,Desc"));
    }

    #[test]
    fn a_unit_of_heights_alone_is_asked_for_and_columns_that_are_left_out_are_said() {
        let read = |header: &str, unit: Option<LengthUnit>| {
            let text = format!("{header}\n1,2,3,4,TREE\n");
            let options = SurveyOptions { unit, ..SurveyOptions::default() };
            read(Path::new("points.csv"), &text, &options)
        };
        let in_feet = "pt,E,N,Z [ft],code";
        let error = read(in_feet, None).unwrap_err().to_string();
        assert!(error.contains("the unit of the heights"), "{error}");
        assert!(read(in_feet, Some(LengthUnit::Foot)).is_ok());
        assert!(read("pt,E (US ft),N (US ft),Z (US ft),code", None).is_ok());
        let found = read("pt,E [m],N [m],Orthometric Height,code", None).unwrap();
        assert_eq!(found.notes, ["columns that are not read: Orthometric Height"]);
    }

    #[test]
    fn a_number_behind_a_code_keeps_its_lines_apart() {
        let options = SurveyOptions { line_codes: vec!["TL".to_owned()], ..Default::default() };
        for code in ["KERB", "kerb1", "Skid 2", "TL", "tl.3"] {
            assert!(options.is_line(code), "{code}");
        }
        for code in ["", "TREE", "12", "kerbside", "debris"] {
            assert!(!options.is_line(code), "{code}");
        }
    }
}
