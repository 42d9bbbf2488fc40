//! The ground on which a collision happened: a site file with an orthophoto, lanes, kerbs, zones of
//! their own friction and the lines of a drawing, in the axes of the scene.
//!
//! Axes are those of [`frames`](crate::vehicle::frames): X along the road, Y to the left. What a survey
//! gives in easting and northing of 10⁵ to 10⁷ m is turned into these axes in double precision as it is
//! read ([`SiteOrigin`]), so that nothing above this module knows large coordinates.
//!
//! - [`Site`] is what a site file says; [`Site::load`] reads it, with the place of every error.
//! - [`PixelMap`] says where the pixels of an orthophoto lie, by a [`WorldFile`] or two points.
//! - [`read_picture`] decodes an orthophoto, [`read_drawing`] the lines of a DXF drawing.
//! - [`Site::from_survey`] makes a site of KML, GeoJSON or a table of points, [`import_cloud`] an
//!   orthophoto of a point cloud; [`map_file`] writes lines and points for maps.

mod error;

mod geo_tiff;
mod origin;
mod pixel_map;
mod projection_file;
mod world_file;

mod parts;

mod file;
mod write;

mod drawing;
mod drawing_curves;
mod frozen_layers;
mod picture;
mod unread_entities;

mod cloud;
mod survey;

#[cfg(test)]
mod drawing_tests;
#[cfg(test)]
mod file_tests;

pub use cloud::{
    CloudFormat, CloudOptions, CloudReport, CloudSummary, import_cloud, stated_cloud_unit,
    survey_cloud,
};
pub use drawing::{Drawing, DrawingSummary, DrawnLine, read_drawing};
pub use error::SiteError;
pub use origin::{GeographicFrame, SiteOrigin};
pub use parts::extent_of;
pub use parts::{
    DrawingFile, EdgeLine, Kerb, Lane, LengthUnit, Orthophoto, Site, SurveyedLine, SurveyedPoint,
};
pub use picture::{is_picture, is_picture_file, picture_size_px, read_picture};
pub use pixel_map::PixelMap;
pub use survey::{
    MapFeature, MapFormat, MapShape, SurveyFormat, SurveyOptions, map_features, map_file,
};
pub use world_file::{WorldFile, world_file_beside};
pub use write::NotBelow;
