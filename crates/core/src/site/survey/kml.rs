//! Reads KML, and KMZ, which is KML in an archive.
//!
//! ```text
//! <Placemark><name>skid</name>
//!   <ExtendedData><Data name="impactlab"><value>line</value></Data></ExtendedData>
//!   <LineString><coordinates>-0.975,51.985,100 -0.974,51.985,100</coordinates></LineString>
//! </Placemark>
//! ```
//!
//! Read are the points, lines, areas (their outer borders) and tracks (`gx:Track`) of placemarks, with their
//! names and data. Overlays, models, network links, styles and holes are not.
//! This is the whole of what is needed, on the reader of XML that is here already: the crate `kml` would
//! bring a second version of it, and holds styles and all else in memory.

use std::io::{Cursor, Read};
use std::path::Path;

use quick_xml::events::{BytesStart, Event};
use zip::ZipArchive;

use crate::data::{DataError, MAX_SURVEY_BYTES};
use crate::site::survey::found::{Found, PROPERTIES, Thing, kept_text, wrong};
use crate::site::{MapShape, SiteError};

/// Elements within elements, at most.
const MAX_DEPTH: usize = 64;

/// The KML of an archive: `doc.kml`, else the first file of that ending.
///
/// # Errors
/// [`SiteError::Survey`] for another archive, [`DataError::TooLarge`] for too much text.
pub(super) fn unpacked(path: &Path, bytes: &[u8]) -> Result<Vec<u8>, SiteError> {
    let damaged = |error: &dyn std::fmt::Display| {
        wrong(path, None, &format!("the archive cannot be read: {error}"))
    };
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| damaged(&error))?;
    let mut chosen = None;
    for idx in 0..archive.len() {
        let part = archive.by_index(idx).map_err(|error| damaged(&error))?;
        // Others are those to which this one links.
        if part.name().is_ok_and(|name| name.to_lowercase() == "doc.kml") {
            chosen = Some(idx);
            break;
        }
        let is_kml = part.name().is_ok_and(|name| name.to_lowercase().ends_with(".kml"));
        chosen = chosen.or(is_kml.then_some(idx));
    }
    let Some(idx) = chosen else {
        return Err(wrong(path, None, &"is an archive without a .kml file"));
    };
    let part = archive.by_index(idx).map_err(|error| damaged(&error))?;
    let mut text = Vec::new();
    part.take(MAX_SURVEY_BYTES + 1).read_to_end(&mut text).map_err(|error| damaged(&error))?;
    if text.len() as u64 > MAX_SURVEY_BYTES {
        let (bytes, limit) = (text.len() as u64, MAX_SURVEY_BYTES);
        return Err(DataError::TooLarge { path: path.to_owned(), bytes, limit }.into());
    }
    Ok(text)
}

/// Reads the text of a KML file.
///
/// # Errors
/// [`SiteError::Survey`] with the line, [`SiteError::TooManyPoints`], [`SiteError::TooManyObjects`].
pub(super) fn read(path: &Path, text: &str) -> Result<Found, SiteError> {
    let text = text.trim_start_matches('\u{feff}');
    let mut xml = quick_xml::Reader::from_str(text);
    let mut reader = Reader::new(path);
    let mut lines = Lines { text, line: 1, counted: 0 };
    loop {
        let line = lines.at(xml.buffer_position());
        let event = xml.read_event().map_err(|error| {
            let line = Lines { text, line: 1, counted: 0 }.at(xml.error_position());
            wrong(path, Some(line), &format!("is no XML: {error}"))
        })?;
        match event {
            Event::Start(_) if reader.open.len() >= MAX_DEPTH => {
                return Err(wrong(path, Some(line), &"has elements within elements without end"));
            }
            Event::Start(element) => reader.start(&element, line),
            Event::Empty(element) => {
                reader.start(&element, line);
                reader.end(line)?;
            }
            Event::End(_) => reader.end(line)?,
            Event::Text(part) => reader.text.push_str(&part),
            Event::CData(part) => reader.text.push_str(&part),
            Event::GeneralRef(part) => {
                reader.text.push_str(letter_of(&part).as_deref().unwrap_or_default());
            }
            Event::Eof => break,
            _ => {}
        }
    }
    if let Some(open) = reader.open.last() {
        let line = lines.at(u64::MAX);
        return Err(wrong(path, Some(line), &format!("ends within <{}>", kept_text(open))));
    }
    Ok(Found { is_geographic: true, ..reader.found })
}

/// The letters of a reference such as `&amp;`.
fn letter_of(name: &str) -> Option<String> {
    let number = name.strip_prefix('#').map(|digits| match digits.strip_prefix('x') {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => digits.parse().ok(),
    });
    match number {
        Some(number) => char::from_u32(number?).map(String::from),
        None => quick_xml::escape::resolve_predefined_entity(name).map(str::to_owned),
    }
}

/// Counts lines up to a byte, each byte once.
struct Lines<'a> {
    text: &'a str,
    line: u64,
    counted: usize,
}

impl Lines<'_> {
    /// The line of a byte that is not before the last one asked for, from 1.
    fn at(&mut self, position: u64) -> u64 {
        let end = usize::try_from(position).unwrap_or(usize::MAX).min(self.text.trim_end().len());
        let passed = self.text.as_bytes().get(self.counted..end).unwrap_or_default();
        self.line += passed.iter().filter(|byte| **byte == b'\n').count() as u64;
        self.counted = self.counted.max(end);
        self.line
    }
}

/// What has been read of the file.
struct Reader<'a> {
    path: &'a Path,
    found: Found,
    /// Local names of the elements that are open.
    open: Vec<String>,
    /// Text of the element that is open.
    text: String,
    /// Name of the `Data` element that is open.
    data: String,
    /// Whether a placemark is open, and what it says of itself.
    placemark: Option<Thing>,
    /// Its geometries.
    geometries: Vec<Thing>,
    /// Points of a track.
    track: Vec<[f64; 2]>,
}

impl<'a> Reader<'a> {
    fn new(path: &'a Path) -> Self {
        Self {
            path,
            found: Found::default(),
            open: Vec::new(),
            text: String::new(),
            data: String::new(),
            placemark: None,
            geometries: Vec::new(),
            track: Vec::new(),
        }
    }

    fn is_in(&self, name: &str) -> bool {
        self.open.iter().any(|open| open == name)
    }

    fn start(&mut self, element: &BytesStart<'_>, line: u64) {
        let name = element.local_name().into_inner().to_owned();
        match name.as_str() {
            "Placemark" => {
                self.placemark = Some(Thing { line: Some(line), ..Thing::default() });
                self.geometries.clear();
            }
            "Data" | "SimpleData" => {
                let key = element.try_get_attribute("name").ok().flatten();
                let key = key.map(|key| key.value.to_lowercase());
                self.data = key.unwrap_or_default();
            }
            "Track" => self.track.clear(),
            "GroundOverlay" | "PhotoOverlay" | "Model" | "NetworkLink" => {
                self.found.leave_out(&name);
            }
            _ => {}
        }
        self.text.clear();
        self.open.push(name);
    }

    fn end(&mut self, line: u64) -> Result<(), SiteError> {
        let name = self.open.pop().unwrap_or_default();
        let text = std::mem::take(&mut self.text);
        let within = self.open.last().cloned().unwrap_or_default();
        match (name.as_str(), &mut self.placemark) {
            ("name", Some(placemark)) if within == "Placemark" => placemark.name = kept_text(&text),
            ("value", Some(placemark)) if PROPERTIES.contains(&self.data.as_str()) => {
                placemark.properties.insert(self.data.clone(), kept_text(&text));
            }
            ("SimpleData", Some(placemark)) if PROPERTIES.contains(&self.data.as_str()) => {
                placemark.properties.insert(self.data.clone(), kept_text(&text));
            }
            ("coordinates", Some(_)) => self.coordinates(&text, line)?,
            ("coord", Some(_)) if within == "Track" => {
                let point = numbers(self.path, text.split_whitespace(), line)?;
                self.track.push([point.0, point.1]);
            }
            ("Track", Some(_)) => {
                let at = std::mem::take(&mut self.track);
                let shape = MapShape::Line;
                self.geometries.push(Thing { shape, at, line: Some(line), ..Thing::default() });
            }
            ("Placemark", Some(_)) => self.add_placemark()?,
            _ => {}
        }
        Ok(())
    }

    /// Adds what the placemark that ends consists of.
    fn add_placemark(&mut self) -> Result<(), SiteError> {
        let Some(placemark) = self.placemark.take() else { return Ok(()) };
        let geometries = std::mem::take(&mut self.geometries);
        if geometries.is_empty() {
            self.found.leave_out("without geometry");
        }
        for geometry in geometries {
            let (name, properties) = (placemark.name.clone(), placemark.properties.clone());
            self.found.add(self.path, Thing { name, properties, ..geometry })?;
        }
        Ok(())
    }

    /// Longitude, latitude and perhaps altitude of each point, with commas between them.
    fn coordinates(&mut self, text: &str, line: u64) -> Result<(), SiteError> {
        if self.is_in("innerBoundaryIs") {
            self.found.leave_out("hole of an area");
            return Ok(());
        }
        let shape = match () {
            () if self.is_in("Polygon") => MapShape::Area,
            () if self.is_in("Point") => MapShape::Point,
            () if self.is_in("LineString") || self.is_in("LinearRing") => MapShape::Line,
            () => return Ok(()),
        };
        let points =
            text.split_whitespace().map(|point| numbers(self.path, point.split(','), line));
        let points: Vec<(f64, f64, Option<f64>)> = points.collect::<Result<_, _>>()?;
        // Programs write 0 where they know no height.
        let height_m = points.first().and_then(|point| point.2).filter(|height| *height != 0.0);
        let thing = Thing {
            shape,
            at: points.iter().map(|point| [point.0, point.1]).collect(),
            height_m: height_m.filter(|_| shape == MapShape::Point),
            line: Some(line),
            ..Thing::default()
        };
        self.geometries.push(thing);
        Ok(())
    }
}

/// Longitude, latitude and altitude of a point.
fn numbers<'a>(
    path: &Path,
    mut parts: impl Iterator<Item = &'a str>,
    line: u64,
) -> Result<(f64, f64, Option<f64>), SiteError> {
    let number = |part: Option<&str>| part.and_then(|part| part.trim().parse::<f64>().ok());
    let (longitude, latitude) = (number(parts.next()), number(parts.next()));
    let is_place = |lon: &f64, lat: &f64| lon.abs() <= 180.0 && lat.abs() <= 90.0;
    let altitude = number(parts.next()).filter(|altitude| altitude.is_finite());
    match longitude.zip(latitude).filter(|(lon, lat)| is_place(lon, lat)) {
        Some((longitude, latitude)) => Ok((longitude, latitude, altitude)),
        None => {
            let expected = "has a point in coordinates that is no longitude,latitude in degrees";
            Err(wrong(path, Some(line), &expected))
        }
    }
}
