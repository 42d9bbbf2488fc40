//! Makes a ground of what a file of lines and points has.

use std::io::Read;
use std::path::Path;

use crate::data::{ARCHIVE_START, GeographicPlace, MAX_SURVEY_BYTES, open_file, read_bytes};
use crate::ranges::SURVEY_COORDINATE;
use crate::site::survey::doubts::doubts;
use crate::site::survey::found::{Found, Thing, wrong};
use crate::site::survey::{geojson, kml, table};
use crate::site::{
    EdgeLine, Kerb, Lane, LengthUnit, MapShape, Site, SiteError, SiteOrigin, SurveyedLine,
    SurveyedPoint,
};
use crate::vehicle::FrictionZone;

/// Bytes at the beginning of a file by which its format is found out.
const HEAD_BYTES: u64 = 4096;

/// Largest distance from the first point, m: what is farther away belongs to another place, or is wrong.
const LARGEST_M: f64 = 100_000.0;

/// Words of the names of kerbs, and of marks of tires, which may lead to a kerb.
const KERBS: [&str; 3] = ["kerb", "curb", "bordstein"];
const MARKS: [&str; 6] = ["skid", "scuff", "tire mark", "tyre mark", "bremsspur", "reifenspur"];

/// A format of lines and points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurveyFormat {
    /// KML.
    Kml,
    /// KML in an archive.
    Kmz,
    /// GeoJSON.
    GeoJson,
    /// A table of points with their names and codes.
    Table,
}

/// What a file of lines and points does not say itself.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SurveyOptions {
    /// Unit of easting, northing and height, instead of what the file says, or of metres if it says none.
    /// Files in degrees have none; GeoJSON with one that does not state degrees is in a grid.
    pub unit: Option<LengthUnit>,
    /// Codes whose points are joined to a line, beside the words for lines.
    pub line_codes: Vec<String>,
}

impl SurveyFormat {
    /// The format of a file; `None` if it is none of them, or cannot be read.
    pub fn from_path(path: &Path) -> Option<Self> {
        let (file, _) = open_file(path, u64::MAX).ok()?;
        let mut head = Vec::new();
        file.take(HEAD_BYTES).read_to_end(&mut head).ok()?;
        let is_kmz = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("kmz"));
        if is_kmz && head.starts_with(ARCHIVE_START) {
            return Some(Self::Kmz);
        }
        Self::from_head(&head)
    }

    /// The format of a file that begins with these bytes; an archive has to be named.
    pub fn from_head(head: &[u8]) -> Option<Self> {
        let text = decoded(head);
        let text = text.trim_start_matches('\u{feff}').trim_start();
        match () {
            () if text.starts_with('<') && has_element(text, "kml") => Some(Self::Kml),
            () if geojson::is_geojson(text) => Some(Self::GeoJson),
            () if table::is_table(text) => Some(Self::Table),
            () => None,
        }
    }
}

/// Whether a text has the beginning of an element, with or without a prefix.
fn has_element(text: &str, name: &str) -> bool {
    let is_end = |rest: &str| !rest.starts_with(|letter: char| letter.is_alphanumeric());
    text.split('<').any(|tag| {
        let tag =
            tag.rsplit_once(':').filter(|(prefix, _)| !prefix.contains(' ')).map_or(tag, |of| of.1);
        tag.strip_prefix(name).is_some_and(is_end)
    })
}

/// A text in UTF-8 or UTF-16, else in the Western code page.
fn decoded(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => encoding_rs::WINDOWS_1252.decode(bytes).0.into_owned(),
    }
}

impl Site {
    /// A site of surveyed lines and points.
    ///
    /// # Errors
    /// [`SiteError::Survey`] with the line, [`SiteError::Data`], [`SiteError::TooManyPoints`],
    /// [`SiteError::TooManyObjects`].
    pub fn from_survey(
        path: &Path,
        format: SurveyFormat,
        options: &SurveyOptions,
    ) -> Result<Self, SiteError> {
        let bytes = read_bytes(path, MAX_SURVEY_BYTES)?;
        let bytes = match format {
            SurveyFormat::Kmz => kml::unpacked(path, &bytes)?,
            _ => bytes,
        };
        let text = decoded(&bytes);
        drop(bytes);
        let mut found = match format {
            SurveyFormat::Kml | SurveyFormat::Kmz => kml::read(path, &text)?,
            SurveyFormat::GeoJson => geojson::read(path, &text, options)?,
            SurveyFormat::Table => table::read(path, &text, options)?,
        };
        let frame = Frame::new(path, &found, options)?;
        // A table has said them already, in its own units.
        if format == SurveyFormat::GeoJson && frame.place.is_none() {
            found.notes.extend(doubts(&found.things, frame.unit_m));
        }
        let mut site = Self::empty(path);
        (site.origin, site.geographic) = (Some(frame.origin), frame.place);
        let Found { things, left_out, notes, .. } = found;
        for mut thing in things {
            let at_m = frame.places(path, &thing)?;
            thing.height_m = thing.height_m.map(|height| height * frame.unit_m);
            site.add_thing(path, thing, at_m)?;
        }
        let name = site.name.clone();
        site.notes.push(format!("{name}: {}", frame.text()));
        site.notes.extend(notes.into_iter().map(|note| format!("{name}: {note}")));
        if !left_out.is_empty() {
            let counts = left_out.iter().map(|(kind, n)| format!("{n} {kind}"));
            let counts: Vec<String> = counts.collect();
            site.notes.push(format!("{name}: not read: {}", counts.join(", ")));
        }
        Ok(site)
    }

    /// Adds a thing of a file as what it is.
    fn add_thing(
        &mut self,
        path: &Path,
        thing: Thing,
        mut at_m: Vec<[f64; 2]>,
    ) -> Result<(), SiteError> {
        let property =
            |key: &str| thing.properties.get(key).map(String::as_str).unwrap_or_default();
        let kind = property("impactlab");
        let name = full_name(&thing);
        let words = format!("{name} {}", property("layer")).to_lowercase();
        let has = |of: &[&str]| of.iter().any(|word| words.contains(word));
        let is_kerb = kind.is_empty() && has(&KERBS) && !has(&MARKS);
        match thing.shape {
            MapShape::Area if kind == "lane" => {
                self.lanes.push(lane(&thing, name, &at_m).ok_or_else(|| {
                    let expected =
                        "is a lane whose n_left does not divide its border into two edges";
                    wrong(path, thing.line, &expected)
                })?);
            }
            MapShape::Area if thing.properties.contains_key("friction") => {
                let friction = property("friction").trim().replace(',', ".").parse::<f64>().ok();
                let friction = friction
                    .ok_or_else(|| wrong(path, thing.line, &"has a friction that is no number"))?;
                let name = if name.is_empty() { FrictionZone::UNNAMED.to_owned() } else { name };
                let zone = FrictionZone { name, border_m: at_m, friction };
                zone.check()
                    .map_err(|error| wrong(path, thing.line, &crate::error_chain(&error)))?;
                self.friction_zones.push(zone);
            }
            MapShape::Area => {
                let first = at_m.first().copied();
                at_m.extend(first);
                self.add_line(name, at_m, None);
            }
            MapShape::Line if (kind == "kerb" || is_kerb) && at_m.len() > 1 => {
                self.kerbs.push(Kerb { name, line_m: at_m });
            }
            MapShape::Line | MapShape::Point => self.add_line(name, at_m, thing.height_m),
        }
        Ok(())
    }

    /// Adds a line, or a point where it has only one.
    fn add_line(&mut self, name: String, mut at_m: Vec<[f64; 2]>, height_m: Option<f64>) {
        at_m.dedup();
        match (at_m.len(), at_m.first().copied()) {
            (_, None) => {}
            (1, Some(at_m)) => self.points.push(SurveyedPoint { name, at_m, height_m }),
            _ => self.lines.push(SurveyedLine { name, line_m: at_m }),
        }
    }
}

/// What a thing is called, with its code.
fn full_name(thing: &Thing) -> String {
    let code = thing.properties.get("code").map(String::as_str).unwrap_or_default();
    match (thing.name.as_str(), code) {
        (name, "") => name.to_owned(),
        ("", code) => code.to_owned(),
        (name, code) if name == code => name.to_owned(),
        (name, code) => format!("{name} {code}"),
    }
}

/// The lane whose border is its left edge and then its right edge backwards.
fn lane(thing: &Thing, name: String, border_m: &[[f64; 2]]) -> Option<Lane> {
    let n_left: usize = thing.properties.get("n_left")?.parse().ok()?;
    let is_possible = n_left >= 2 && border_m.len() >= n_left.checked_add(2)?;
    let (left, right) = border_m.split_at_checked(n_left).filter(|_| is_possible)?;
    let edge = |key: &str| {
        let word = thing.properties.get(key)?;
        let idx = EdgeLine::WORDS.iter().position(|known| known == word)?;
        EdgeLine::ALL.get(idx).copied()
    };
    Some(Lane {
        name,
        left_m: left.to_vec(),
        right_m: right.iter().rev().copied().collect(),
        edges: [edge("left").unwrap_or_default(), edge("right").unwrap_or_default()],
    })
}

/// From the coordinates of a file to the axes of its site.
struct Frame {
    place: Option<GeographicPlace>,
    origin: SiteOrigin,
    /// Length of the unit of a file in a grid, m; that of a table is in its numbers already.
    unit_m: f64,
    /// Whether degrees may be lengths of a local grid.
    may_be_grid: bool,
}

impl Frame {
    /// # Errors
    /// [`SiteError::Survey`] for a file without any point.
    fn new(path: &Path, found: &Found, options: &SurveyOptions) -> Result<Self, SiteError> {
        let first = found.things.iter().find_map(|thing| thing.at.first().copied());
        let Some([x, y]) = first else {
            return Err(wrong(path, None, &"has no points, lines or areas"));
        };
        if found.is_geographic {
            let place = GeographicPlace::from_degrees(y, x);
            let (origin, may_be_grid) = (SiteOrigin::default(), found.may_be_grid);
            return Ok(Self { place, origin, unit_m: 1.0, may_be_grid });
        }
        let unit = options.unit.filter(|_| !found.is_in_metres).unwrap_or_default();
        let survey_m = [x, y].map(|value| (value * unit.length_m()).floor());
        let origin = SiteOrigin { survey_m, ..SiteOrigin::default() };
        Ok(Self { place: None, origin, unit_m: unit.length_m(), may_be_grid: false })
    }

    /// The points of a thing, m.
    fn places(&self, path: &Path, thing: &Thing) -> Result<Vec<[f64; 2]>, SiteError> {
        let place = |at: &[f64; 2]| {
            let at_m = self.site_m(*at).filter(|[x, y]| x.hypot(*y) <= LARGEST_M);
            at_m.ok_or_else(|| {
                let ask = match self.may_be_grid {
                    true => "they are taken as degrees; if they are a local grid, say its unit (--unit m)",
                    false => "are the coordinates right?",
                };
                let message = format!(
                    "has a point at {}, {}, expected one within 100 km of the first; {ask}",
                    at[0], at[1]
                );
                wrong(path, thing.line, &message)
            })
        };
        thing.at.iter().map(place).collect()
    }

    fn site_m(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        if let Some(place) = self.place {
            let there = GeographicPlace::from_degrees(y, x)?;
            // The other side of the earth is above the same point of the plane.
            let turn_rad = (there.longitude_rad - place.longitude_rad).abs();
            let is_near = (there.latitude_rad - place.latitude_rad).abs() < 0.1;
            let is_same_side = turn_rad.cos() > 0.0;
            return (is_near && is_same_side)
                .then(|| [place.to_east_m(there), place.to_north_m(there)]);
        }
        let survey_m = [x, y].map(|value| value * self.unit_m);
        let is_possible = survey_m.iter().all(|value| SURVEY_COORDINATE.contains(*value));
        is_possible.then(|| self.origin.site_from_survey(survey_m))
    }

    /// Where the site lies, in words.
    fn text(&self) -> String {
        match self.place {
            Some(place) => {
                let [latitude_deg, longitude_deg] = place.degrees();
                format!(
                    "X is metres to the east and Y to the north of latitude {latitude_deg:.7}°, longitude \
                     {longitude_deg:.7}°, its first point"
                )
            }
            None => {
                let [easting_m, northing_m] = self.origin.survey_m;
                format!("X is easting less {easting_m} m, Y is northing less {northing_m} m")
            }
        }
    }
}
