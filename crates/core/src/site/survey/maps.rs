//! Writes lines, areas and points for maps: KML 2.2 and GeoJSON (RFC 7946), longitude before latitude.
//!
//! The property `impactlab` says what a feature is, so that a ground comes back as what it was. Coordinates
//! have nine decimals of a degree, 0.1 mm. Of a path GeoJSON has the times of its points, KML has not.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::site::{GeographicFrame, MapFeature, MapShape};

/// A format of maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapFormat {
    /// KML.
    Kml,
    /// GeoJSON.
    GeoJson,
}

/// The text of a file.
///
/// - `title`: name of the whole;
/// - `notes`: what restricts it, which stands in its description.
pub fn map_file(
    format: MapFormat,
    (title, notes): (&str, Option<&str>),
    features: &[MapFeature],
    frame: &GeographicFrame,
) -> String {
    match format {
        MapFormat::Kml => kml((title, notes), features, frame),
        MapFormat::GeoJson => geojson((title, notes), features, frame),
    }
}

/// Longitudes and latitudes of a feature, degrees, rounded to what is written; those of an area come back
/// to the first.
fn coordinates(feature: &MapFeature, frame: &GeographicFrame) -> Vec<[f64; 2]> {
    let closing = feature.at_m.first().filter(|_| feature.shape == MapShape::Area);
    let all = feature.at_m.iter().chain(closing);
    let rounded = |value: f64| (value * 1e9).round() / 1e9;
    all.map(|at_m| frame.longitude_latitude_deg(*at_m).map(rounded)).collect()
}

fn geojson(
    (title, notes): (&str, Option<&str>),
    features: &[MapFeature],
    frame: &GeographicFrame,
) -> String {
    let of_feature = |feature: &MapFeature| {
        let at = coordinates(feature, frame);
        let geometry = match feature.shape {
            MapShape::Point => json!({ "type": "Point", "coordinates": at.first() }),
            MapShape::Line => json!({ "type": "LineString", "coordinates": at }),
            MapShape::Area => json!({ "type": "Polygon", "coordinates": [at] }),
        };
        let mut properties = Map::new();
        properties.insert("name".to_owned(), json!(feature.name));
        properties.insert("impactlab".to_owned(), json!(feature.kind));
        for (key, value) in &feature.properties {
            properties.insert((*key).to_owned(), json!(value));
        }
        if !feature.times_s.is_empty() {
            properties.insert("time_s".to_owned(), json!(feature.times_s));
        }
        json!({ "type": "Feature", "properties": properties, "geometry": geometry })
    };
    let features: Vec<Value> = features.iter().map(of_feature).collect();
    let all = json!({
        "type": "FeatureCollection", "name": title, "description": notes, "features": features,
    });
    format!("{all:#}\n")
}

fn kml(
    (title, notes): (&str, Option<&str>),
    features: &[MapFeature],
    frame: &GeographicFrame,
) -> String {
    let mut out = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n",
    );
    // Writing to a text does not fail.
    let _ = writeln!(out, "<name>{}</name>", escaped(title));
    if let Some(notes) = notes {
        let _ = writeln!(out, "<description>{}</description>", escaped(notes));
    }
    for feature in features {
        let _ = writeln!(out, "<Placemark>\n<name>{}</name>", escaped(&feature.name));
        out.push_str("<ExtendedData>\n");
        let kind = [("impactlab", feature.kind.to_owned())];
        for (key, value) in kind.iter().chain(&feature.properties) {
            let value = escaped(value);
            let _ = writeln!(out, "<Data name=\"{key}\"><value>{value}</value></Data>");
        }
        out.push_str("</ExtendedData>\n");
        let at = coordinates(feature, frame);
        let at: Vec<String> = at.iter().map(|[lon, lat]| format!("{lon:.9},{lat:.9}")).collect();
        let at = format!("<coordinates>{}</coordinates>", at.join(" "));
        let _ = match feature.shape {
            MapShape::Point => writeln!(out, "<Point>{at}</Point>"),
            MapShape::Line => {
                writeln!(out, "<LineString><tessellate>1</tessellate>{at}</LineString>")
            }
            MapShape::Area => writeln!(
                out,
                "<Polygon><tessellate>1</tessellate><outerBoundaryIs><LinearRing>{at}</LinearRing>\
                 </outerBoundaryIs></Polygon>"
            ),
        };
        out.push_str("</Placemark>\n");
    }
    out.push_str("</Document>\n</kml>\n");
    out
}

/// A text within an element, without letters that XML does not have.
fn escaped(text: &str) -> String {
    let is_letter = |letter: &char| !letter.is_control() || matches!(letter, '\n' | '\t');
    quick_xml::escape::escape(text.chars().filter(is_letter).collect::<String>()).into_owned()
}
