//! Surveyed lines and points as a ground: KML, GeoJSON and tables of a total station, and the way back to
//! maps.
//!
//! ```text
//! KML, KMZ, GeoJSON    longitude and latitude (WGS 84) ──> plane at the first point, X east, Y north
//! GeoJSON in a grid    easting and northing, m         ──> an origin of whole metres is subtracted
//! table                name, E, N, Z, code             ──> the same; points of a code of lines are joined
//! ```
//!
//! What a line or an area is follows from its property `impactlab`, which [`map_file`] writes (`lane`,
//! `kerb`, `friction_zone`); an area with a property `friction` is a zone of friction; what is called a
//! kerb is one; the rest are lines and points.

mod doubts;
mod found;

mod features;
mod geojson;
mod kml;
mod table;

mod into_site;
mod maps;

#[cfg(test)]
mod tests;

pub use features::{MapFeature, MapShape, map_features};
pub use into_site::{SurveyFormat, SurveyOptions};
pub use maps::{MapFormat, map_file};
