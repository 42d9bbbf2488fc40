//! Writes a site as a file.

use std::path::Path;

use toml::{Table, Value};

use crate::site::{
    EdgeLine, Kerb, Lane, LengthUnit, Orthophoto, Site, SurveyedLine, SurveyedPoint,
};
use crate::vehicle::FrictionZone;

/// A file of a site that its site file cannot name, because it is in another folder.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}: is not in {folder} or below it, where the site file is to be saved")]
pub struct NotBelow {
    /// The orthophoto, the world file or the drawing.
    pub file: String,
    /// The folder of the site file.
    pub folder: String,
}

impl Site {
    /// The text of a file from which [`Site::load`] reads the same site, numbers with all their digits.
    /// Lanes are written by their edges.
    ///
    /// - `folder`: where the file will be.
    ///
    /// # Errors
    /// [`NotBelow`] if orthophoto, world file or drawing are not in this folder or below it.
    pub fn to_toml(&self, folder: &Path) -> Result<String, NotBelow> {
        let mut top = Table::new();
        set(&mut top, "name", self.name.as_str());
        if let Some(origin) = self.origin {
            let mut table = Table::new();
            match self.geographic {
                Some(place) => {
                    set(&mut table, "latitude_rad", place.latitude_rad);
                    set(&mut table, "longitude_rad", place.longitude_rad);
                }
                None => {
                    let [easting_m, northing_m] = origin.survey_m;
                    set(&mut table, "easting_m", easting_m);
                    set(&mut table, "northing_m", northing_m);
                }
            }
            set(&mut table, "x_axis_azimuth_rad", origin.x_axis_azimuth_rad);
            set(&mut top, "origin", table);
        }
        if let Some(orthophoto) = &self.orthophoto {
            set(&mut top, "orthophoto", orthophoto_table(orthophoto, folder)?);
        }
        set_all(&mut top, "lane", self.lanes.iter().map(lane_table));
        set_all(&mut top, "kerb", self.kerbs.iter().map(kerb_table));
        set_all(&mut top, "friction_zone", self.friction_zones.iter().map(zone_table));
        if let Some(slope) = self.slope {
            let mut table = Table::new();
            slope.entries().into_iter().for_each(|(key, value)| set(&mut table, key, value));
            set(&mut top, "road", table);
        }
        set_all(&mut top, "line", self.lines.iter().map(line_table));
        set_all(&mut top, "point", self.points.iter().map(point_table));
        if let Some(drawing) = &self.drawing {
            let mut table = Table::new();
            set(&mut table, "file", name_below(&drawing.file, folder)?);
            if let Some(unit) = drawing.unit {
                set(&mut table, "unit", unit.word());
            }
            if let Some(layers) = &drawing.layers {
                set(&mut table, "layers", layers.clone());
            }
            set(&mut top, "dxf", table);
        }
        Ok(top.to_string())
    }
}

fn orthophoto_table(orthophoto: &Orthophoto, folder: &Path) -> Result<Table, NotBelow> {
    let mut table = Table::new();
    set(&mut table, "file", name_below(&orthophoto.file, folder)?);
    match &orthophoto.world_file {
        Some(world) => {
            set(&mut table, "world_file", name_below(world, folder)?);
            if orthophoto.world_unit != LengthUnit::Metre {
                set(&mut table, "unit", orthophoto.world_unit.word());
            }
        }
        None => {
            set(&mut table, "corner_m", pair(orthophoto.map.corner_m));
            set(&mut table, "per_column_m", pair(orthophoto.map.per_column_m));
            set(&mut table, "per_row_m", pair(orthophoto.map.per_row_m));
        }
    }
    Ok(table)
}

fn lane_table(lane: &Lane) -> Table {
    let mut table = Table::new();
    set(&mut table, "name", lane.name.as_str());
    set(&mut table, "left_edge_m", pairs(&lane.left_m));
    set(&mut table, "right_edge_m", pairs(&lane.right_m));
    let word = |edge| {
        let idx = EdgeLine::ALL.iter().position(|line| *line == edge).unwrap_or_default();
        EdgeLine::WORDS[idx]
    };
    set(&mut table, "left", word(lane.edges[0]));
    set(&mut table, "right", word(lane.edges[1]));
    table
}

fn kerb_table(kerb: &Kerb) -> Table {
    let mut table = Table::new();
    set(&mut table, "name", kerb.name.as_str());
    set(&mut table, "line_m", pairs(&kerb.line_m));
    table
}

fn zone_table(zone: &FrictionZone) -> Table {
    let mut table = Table::new();
    set(&mut table, "name", zone.name.as_str());
    set(&mut table, "friction", zone.friction);
    set(&mut table, "border_m", pairs(&zone.border_m));
    table
}

fn line_table(line: &SurveyedLine) -> Table {
    let mut table = Table::new();
    set(&mut table, "name", line.name.as_str());
    set(&mut table, "line_m", pairs(&line.line_m));
    table
}

fn point_table(point: &SurveyedPoint) -> Table {
    let mut table = Table::new();
    set(&mut table, "name", point.name.as_str());
    set(&mut table, "at_m", pair(point.at_m));
    if let Some(height_m) = point.height_m {
        set(&mut table, "height_m", height_m);
    }
    table
}

fn set(table: &mut Table, key: &str, value: impl Into<Value>) {
    table.insert(key.to_owned(), value.into());
}

fn set_all(table: &mut Table, key: &str, tables: impl Iterator<Item = Table>) {
    let tables: Vec<Table> = tables.collect();
    if !tables.is_empty() {
        set(table, key, tables);
    }
}

fn pair(point: [f64; 2]) -> Value {
    Value::Array(point.map(Value::Float).to_vec())
}

fn pairs(points: &[[f64; 2]]) -> Value {
    Value::Array(points.iter().map(|point| pair(*point)).collect())
}

/// The name of a file as a site file in a folder says it, with `/` between its parts.
fn name_below(file: &Path, folder: &Path) -> Result<String, NotBelow> {
    let below = file.strip_prefix(folder).ok();
    let parts: Option<Vec<&str>> =
        below.and_then(|below| below.iter().map(|part| part.to_str()).collect());
    parts.map(|parts| parts.join("/")).ok_or_else(|| NotBelow {
        file: file.display().to_string(),
        folder: folder.display().to_string(),
    })
}
