//! A ground as features of a map.

use crate::site::{EdgeLine, Site};

/// What a feature of a map is made of.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum MapShape {
    /// One point.
    #[default]
    Point,
    /// A line.
    Line,
    /// An area by its border; the last corner is joined to the first.
    Area,
}

/// A feature of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapFeature {
    /// What it is, such as `kerb` or `path`; the property `impactlab` of the file.
    pub kind: &'static str,
    /// What it is called.
    pub name: String,
    /// What it is made of.
    pub shape: MapShape,
    /// Its points in the axes of the site, m.
    pub at_m: Vec<[f64; 2]>,
    /// Further properties by their names.
    pub properties: Vec<(&'static str, String)>,
    /// Times of its points, s; empty where it has none.
    pub times_s: Vec<f64>,
}

impl MapFeature {
    /// A feature without further properties.
    pub fn new(kind: &'static str, name: &str, shape: MapShape, at_m: Vec<[f64; 2]>) -> Self {
        let (name, properties, times_s) = (name.to_owned(), Vec::new(), Vec::new());
        Self { kind, name, shape, at_m, properties, times_s }
    }
}

/// Lanes, kerbs, zones of friction, lines and points of a site. Orthophoto and drawing are no features.
pub fn map_features(site: &Site) -> Vec<MapFeature> {
    let lanes = site.lanes.iter().map(|lane| {
        let border = lane.left_m.iter().chain(lane.right_m.iter().rev()).copied().collect();
        let word = |edge| {
            let idx = EdgeLine::ALL.iter().position(|line| *line == edge).unwrap_or_default();
            EdgeLine::WORDS[idx].to_owned()
        };
        let properties = vec![
            ("n_left", lane.left_m.len().to_string()),
            ("left", word(lane.edges[0])),
            ("right", word(lane.edges[1])),
        ];
        MapFeature { properties, ..MapFeature::new("lane", &lane.name, MapShape::Area, border) }
    });
    let zones = site.friction_zones.iter().map(|zone| {
        let properties = vec![("friction", zone.friction.to_string())];
        let border = zone.border_m.clone();
        let kind = "friction_zone";
        MapFeature { properties, ..MapFeature::new(kind, &zone.name, MapShape::Area, border) }
    });
    let kerbs = site.kerbs.iter();
    let kerbs =
        kerbs.map(|kerb| MapFeature::new("kerb", &kerb.name, MapShape::Line, kerb.line_m.clone()));
    let lines = site.lines.iter();
    let lines =
        lines.map(|line| MapFeature::new("line", &line.name, MapShape::Line, line.line_m.clone()));
    let points = site.points.iter();
    let points = points
        .map(|point| MapFeature::new("point", &point.name, MapShape::Point, vec![point.at_m]));
    lanes.chain(zones).chain(kerbs).chain(lines).chain(points).collect()
}
