//! Reads GeoJSON (RFC 7946): features with their geometries, longitude before latitude.
//!
//! Files of the draft of 2008 may have a member `crs` and the coordinates of a grid. Coordinates of a grid that is stated,
//! those whose unit is said, and those that are no degrees are taken as easting and northing in metres. Those of web maps
//! have metres that grow with the latitude and are refused; those of a State Plane in feet are until the unit is said.

use std::path::Path;

use geojson::{Feature, GeoJson, GeometryValue, JsonObject, Position};

use crate::site::cloud::{is_in_feet, is_projected};
use crate::site::survey::found::{Found, PROPERTIES, Thing, kept_text, wrong};
use crate::site::{MapShape, SiteError, SurveyOptions};

/// Members of properties that name a feature, in the order in which they are looked for.
const NAMES: [&str; 5] = ["name", "Name", "NAME", "title", "id"];

/// Codes of the Mercator projection of web maps.
const OF_WEB_MAPS: [&str; 5] = ["3857", "3785", "900913", "102100", "102113"];

/// Extent of coordinates from which they may as well be lengths of a local grid: 2 km as degrees.
const DOUBTFUL_EXTENT: f64 = 0.02;

/// Codes of the systems of receivers and maps, and of those that are within two metres of them: ETRS89, NAD 83.
const OF_DEGREES: [&str; 7] = ["CRS84", "CRS84h", "4326", "4979", "4258", "4269", "WGS84"];

/// Whether a text that begins like this is GeoJSON.
///
/// - `head`: its beginning, without blanks.
pub(super) fn is_geojson(head: &str) -> bool {
    let has = |word: &str| head.contains(&format!("\"{word}\""));
    let is_of_features = has("FeatureCollection") || has("Feature") && has("geometry");
    head.starts_with('{') && has("type") && (is_of_features || has("coordinates"))
}

/// Reads the text of a file.
///
/// # Errors
/// [`SiteError::Survey`] with the line, [`SiteError::TooManyPoints`], [`SiteError::TooManyObjects`].
pub(super) fn read(path: &Path, text: &str, options: &SurveyOptions) -> Result<Found, SiteError> {
    let parsed = serde_json::from_str::<GeoJson>(text.trim_start_matches('\u{feff}').trim_end());
    let parsed = parsed.map_err(|error| {
        let line = (error.line() > 0).then_some(error.line() as u64);
        wrong(path, line, &format!("is no GeoJSON: {error}"))
    })?;
    let mut system = None;
    let features = match parsed {
        GeoJson::FeatureCollection(collection) => {
            system = collection.foreign_members.as_ref().and_then(stated_system);
            collection.features
        }
        GeoJson::Feature(feature) => vec![feature],
        GeoJson::Geometry(geometry) => {
            vec![Feature { geometry: Some(geometry), ..Feature::default() }]
        }
    };
    let mut found = Found::default();
    for feature in features {
        // Databases state it with each geometry.
        let of_geometry = feature.geometry.as_ref().and_then(|of| of.foreign_members.as_ref());
        let members = [feature.foreign_members.as_ref(), of_geometry];
        system = system.or_else(|| members.into_iter().flatten().find_map(stated_system));
        let of = Described::new(feature.properties.unwrap_or_default());
        match feature.geometry {
            Some(geometry) => add(path, &mut found, &of, geometry.value, 0)?,
            None => found.leave_out("without geometry"),
        }
    }
    let code = system.as_deref().and_then(|name| name.rsplit(':').next()).unwrap_or_default();
    let is_of_degrees = OF_DEGREES.iter().any(|of| of.eq_ignore_ascii_case(code));
    let is_of_grid = OF_WEB_MAPS.contains(&code)
        || code.to_uppercase().contains("UTM")
        || code.parse::<u16>().is_ok_and(|number| is_projected(&number))
        || options.unit.is_some() && !is_of_degrees;
    let are_degrees = coordinates_are_degrees(&found);
    found.is_geographic = are_degrees && !is_of_grid;
    found.may_be_grid = found.is_geographic && system.is_none();
    if !found.is_geographic && OF_WEB_MAPS.contains(&code) {
        let expected = "has the coordinates of web maps (EPSG:3857), whose metres are too short by the cosine of the \
                        latitude; export it in degrees (EPSG:4326) or in a grid of the country";
        return Err(wrong(path, None, &expected));
    }
    let in_feet = code.parse().ok().filter(is_in_feet);
    if let (false, None, Some(number)) = (found.is_geographic, options.unit, in_feet) {
        let expected = format!(
            "states the system EPSG:{number}, which is one of the State Plane in feet; look the system up, and say the \
             unit of its coordinates (--unit us_survey_ft in most states, or ft)"
        );
        return Err(wrong(path, None, &expected));
    }
    let is_other = !code.is_empty() && !is_of_degrees;
    if let Some(name) = system.as_ref().filter(|_| found.is_geographic && is_other) {
        found.notes.push(format!(
            "it states the system {name}, and its coordinates are read as longitude and latitude of WGS 84: of another \
             datum the place is off by up to some hundred metres, and of a grid it is wrong; export it in degrees of \
             WGS 84 (EPSG:4326), or say the unit of the grid (--unit m)"
        ));
    }
    if found.may_be_grid && extent(&found) > DOUBTFUL_EXTENT {
        found.notes.push(
            "it states no system, and its coordinates are taken as longitude and latitude, in which they reach over \
             kilometres; if they are lengths of a local grid, say their unit (--unit m)"
                .to_owned(),
        );
    }
    if !found.is_geographic {
        let of = system.map(|name| format!(" of the system {name}")).unwrap_or_default();
        let why = match are_degrees {
            true => "coordinates could be longitude and latitude, but a grid or a unit is stated",
            false => "coordinates are no longitude and latitude",
        };
        found.notes.push(format!(
            "{why}; taken as easting and northing{of}, in metres unless another unit is said (--unit)"
        ));
    }
    Ok(found)
}

/// Whether all coordinates could be longitude and latitude.
fn coordinates_are_degrees(found: &Found) -> bool {
    let is_degree = |[lon, lat]: &[f64; 2]| lon.abs() <= 180.0 && lat.abs() <= 90.0;
    found.things.iter().flat_map(|thing| &thing.at).all(is_degree)
}

/// Largest distance from the first point along one of the coordinates, in their unit.
fn extent(found: &Found) -> f64 {
    let mut all = found.things.iter().flat_map(|thing| &thing.at);
    let Some([x, y]) = all.next() else { return 0.0 };
    all.map(|at| (at[0] - x).abs().max((at[1] - y).abs())).fold(0.0, f64::max)
}

/// The name of the reference system that a file of the draft of 2008 states.
fn stated_system(members: &JsonObject) -> Option<String> {
    members.get("crs")?.get("properties")?.get("name")?.as_str().map(kept_text)
}

/// What the properties of a feature say.
struct Described {
    name: String,
    properties: Vec<(String, String)>,
}

impl Described {
    fn new(properties: JsonObject) -> Self {
        let text = |value: &serde_json::Value| match value {
            serde_json::Value::String(text) => Some(kept_text(text)),
            serde_json::Value::Number(number) => Some(number.to_string()),
            _ => None,
        };
        let name = NAMES.iter().find_map(|key| text(properties.get(*key)?)).unwrap_or_default();
        let kept = properties.iter().filter_map(|(key, value)| {
            let key = key.to_lowercase();
            PROPERTIES.contains(&key.as_str()).then_some(())?;
            Some((key, text(value)?))
        });
        Self { name, properties: kept.collect() }
    }
}

/// Geometries within geometries, at most.
const MAX_DEPTH: usize = 8;

fn add(
    path: &Path,
    found: &mut Found,
    of: &Described,
    value: GeometryValue,
    depth: usize,
) -> Result<(), SiteError> {
    match value {
        GeometryValue::Point { coordinates } => {
            one(path, found, of, &[coordinates], MapShape::Point)
        }
        GeometryValue::MultiPoint { coordinates } => coordinates
            .iter()
            .try_for_each(|at| one(path, found, of, std::slice::from_ref(at), MapShape::Point)),
        GeometryValue::LineString { coordinates } => {
            one(path, found, of, &coordinates, MapShape::Line)
        }
        GeometryValue::MultiLineString { coordinates } => {
            coordinates.iter().try_for_each(|line| one(path, found, of, line, MapShape::Line))
        }
        GeometryValue::Polygon { coordinates } => area(path, found, of, &coordinates),
        GeometryValue::MultiPolygon { coordinates } => {
            coordinates.iter().try_for_each(|rings| area(path, found, of, rings))
        }
        GeometryValue::GeometryCollection { geometries } if depth < MAX_DEPTH => geometries
            .into_iter()
            .try_for_each(|geometry| add(path, found, of, geometry.value, depth + 1)),
        GeometryValue::GeometryCollection { .. } => {
            found.leave_out("nested collection");
            Ok(())
        }
    }
}

/// The border of an area; its holes are counted.
fn area(
    path: &Path,
    found: &mut Found,
    of: &Described,
    rings: &[Vec<Position>],
) -> Result<(), SiteError> {
    (1..rings.len()).for_each(|_| found.leave_out("hole of an area"));
    match rings.first() {
        Some(border) => one(path, found, of, border, MapShape::Area),
        None => Ok(()),
    }
}

fn one(
    path: &Path,
    found: &mut Found,
    of: &Described,
    positions: &[Position],
    shape: MapShape,
) -> Result<(), SiteError> {
    let pair = |position: &Position| match position.as_slice() {
        [x, y, ..] if x.is_finite() && y.is_finite() => Ok([*x, *y]),
        _ => Err(wrong(path, None, &"has a position without two numbers")),
    };
    let at = positions.iter().map(pair).collect::<Result<_, _>>()?;
    let first = positions.first().map(Position::as_slice).unwrap_or_default();
    let height_m = first.get(2).copied().filter(|height| height.is_finite());
    let thing = Thing {
        name: of.name.clone(),
        shape,
        at,
        height_m: height_m.filter(|_| shape == MapShape::Point),
        properties: of.properties.iter().cloned().collect(),
        line: None,
    };
    found.add(path, thing)
}
