//! Point clouds of laser scanners and drones as a ground: LAS, LAZ and E57 become an orthophoto with its
//! world file and a picture of heights, at a chosen resolution.
//!
//! A cloud is read twice, point by point: first for its extent, then into the raster, so that the memory
//! depends on the raster alone. Of each pixel the lowest layer is shown, so that trees, wires and roofs do
//! not hide the road. What a header claims is compared with the size of the file before anything is
//! allocated by it.

mod source;

mod e57_points;
mod las_check;
mod las_crs;
mod las_points;
mod las_unit;

mod raster;

mod import;

#[cfg(test)]
mod tests;

pub use import::{CloudOptions, CloudReport, import_cloud};
pub(in crate::site) use las_crs::{StatedUnit, is_in_feet, is_projected, of_keys, of_wkt};
pub(in crate::site) use las_unit::OF_MERCATOR;
pub use las_unit::stated_cloud_unit;
pub use source::{CloudFormat, CloudSummary, survey_cloud};
