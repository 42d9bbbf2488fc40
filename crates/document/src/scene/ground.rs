//! The ground of a scene: picture, lanes, kerbs, zones of friction and the lines of a drawing.

use std::sync::Arc;

use crate::scene::GroundPicture;
use impactlab_core::numerics::line_length;
use impactlab_core::site::{
    Drawing, EdgeLine, GeographicFrame, Lane, MapFeature, Site, SiteOrigin, SurveyedPoint,
    extent_of, map_features,
};
use impactlab_core::vehicle::FrictionZone;

/// Width of the marking of a lane and of a kerb, m.
const MARKING_M: f64 = 0.12;
const KERB_M: f64 = 0.15;
/// Half the size of the cross at a surveyed point, m.
const CROSS_M: f64 = 0.15;
/// Length and gap of a dashed marking, m: those of a road within a town.
const MARKING_DASH_M: [f64; 2] = [3.0, 6.0];

/// What lies below everything else in a scene. All places are in the axes of the scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SceneGround {
    /// A picture from above.
    pub picture: Option<Arc<GroundPicture>>,
    /// Surfaces, from below to above.
    pub areas: Vec<GroundArea>,
    /// Lines, from below to above.
    pub lines: Vec<GroundLine>,
    /// Direction of grid north, counter-clockwise from X, rad.
    pub north_rad: Option<f64>,
    /// Where the scene lies in survey coordinates, if that is known.
    pub origin: Option<SiteOrigin>,
    /// Where it lies on the earth, if that is known, with its lines and points as features of a map.
    pub geographic: Option<Arc<GeographicGround>>,
}

/// A ground whose place on the earth is known.
#[derive(Debug, Clone, PartialEq)]
pub struct GeographicGround {
    /// Where it lies.
    pub frame: GeographicFrame,
    /// Its lanes, kerbs, zones, lines and points.
    pub features: Vec<MapFeature>,
}

/// What a surface is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AreaKind {
    /// A lane, which is not drawn over a picture.
    Lane,
    /// A part of the ground with its own friction.
    FrictionZone,
}

/// A surface on the ground.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundArea {
    /// What it is called, in the legend and on it.
    pub name: String,
    /// What it is.
    pub kind: AreaKind,
    /// Corners `[X, Y]` of its border, m; the last is joined to the first.
    pub border_m: Vec<[f64; 2]>,
}

/// What a line is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GroundLineKind {
    /// The marking at the edge of a lane.
    Marking,
    /// A kerb.
    Kerb,
    /// A line of a drawing.
    Drawing,
    /// A surveyed line, or the cross at a surveyed point.
    Surveyed,
}

/// A line on the ground.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundLine {
    /// What it is.
    pub kind: GroundLineKind,
    /// Points `[X, Y]`, m.
    pub points_m: Vec<[f64; 2]>,
    /// Its width, m; it is drawn as thin as can be seen, if 0.
    pub width_m: f64,
}

impl SceneGround {
    /// The ground of a site.
    ///
    /// - `picture`: its orthophoto;
    /// - `drawing`: its drawing.
    pub fn new(
        site: &Site,
        picture: Option<Arc<GroundPicture>>,
        drawing: Option<&Drawing>,
    ) -> Self {
        let surfaces = site.lanes.iter().map(surface);
        let areas = surfaces.chain(site.friction_zones.iter().map(zone)).collect();
        let of_drawing = drawing.iter().flat_map(|drawing| &drawing.lines).map(|line| GroundLine {
            kind: GroundLineKind::Drawing,
            points_m: line.points_m.clone(),
            width_m: 0.0,
        });
        let kerbs = site.kerbs.iter().map(|kerb| GroundLine {
            kind: GroundLineKind::Kerb,
            points_m: kerb.line_m.clone(),
            width_m: KERB_M,
        });
        let markings = site.lanes.iter().flat_map(markings);
        let surveyed = site.lines.iter().map(|line| line.line_m.clone());
        let surveyed = surveyed
            .chain(site.points.iter().flat_map(cross))
            .map(|points_m| GroundLine { kind: GroundLineKind::Surveyed, points_m, width_m: 0.0 });
        let lines = of_drawing.chain(markings).chain(kerbs).chain(surveyed).collect();
        let geographic = site
            .geographic_frame()
            .map(|frame| Arc::new(GeographicGround { frame, features: map_features(site) }));
        // The origin of a place on the earth has no coordinates of a survey.
        let origin = site.origin.filter(|_| geographic.is_none());
        Self { picture, areas, lines, north_rad: site.north_rad(), origin, geographic }
    }

    /// Smallest and largest `[X, Y]` of all that is drawn of it, m; `None` if nothing is.
    pub fn extent_m(&self) -> Option<[[f64; 2]; 2]> {
        let of_picture = |picture: &Arc<GroundPicture>| {
            picture.map.corners_m(picture.size().map(|side| side as u32))
        };
        let corners = self.picture.iter().flat_map(of_picture);
        let borders = self.areas.iter().flat_map(|area| area.border_m.iter().copied());
        let lines = self.lines.iter().flat_map(|line| line.points_m.iter().copied());
        extent_of(corners.chain(borders).chain(lines))
    }

    /// Whether there is a picture.
    pub fn has_picture(&self) -> bool {
        self.picture.is_some()
    }
}

/// The two lines of the cross at a point.
fn cross(point: &SurveyedPoint) -> [Vec<[f64; 2]>; 2] {
    let [x, y] = point.at_m;
    [1.0, -1.0]
        .map(|slope| vec![[x - CROSS_M, y - slope * CROSS_M], [x + CROSS_M, y + slope * CROSS_M]])
}

fn surface(lane: &Lane) -> GroundArea {
    let back = lane.right_m.iter().rev();
    let border_m = lane.left_m.iter().chain(back).copied().collect();
    GroundArea { name: lane.name.clone(), kind: AreaKind::Lane, border_m }
}

fn zone(zone: &FrictionZone) -> GroundArea {
    GroundArea {
        name: format!("{}, μ {}", zone.name, zone.friction),
        kind: AreaKind::FrictionZone,
        border_m: zone.border_m.clone(),
    }
}

/// The markings of a lane; dashes are lines of their own.
fn markings(lane: &Lane) -> Vec<GroundLine> {
    let line =
        |points_m| GroundLine { kind: GroundLineKind::Marking, points_m, width_m: MARKING_M };
    let edges = [(&lane.left_m, lane.edges[0]), (&lane.right_m, lane.edges[1])];
    let of_edge = |(points, edge): (&Vec<[f64; 2]>, EdgeLine)| match edge {
        EdgeLine::None => Vec::new(),
        EdgeLine::Solid => vec![line(points.clone())],
        EdgeLine::Dashed => dashes(points, MARKING_DASH_M).into_iter().map(line).collect(),
    };
    edges.into_iter().flat_map(of_edge).collect()
}

/// Most dashes of one line.
const MAX_DASHES: f64 = 20_000.0;

/// The dashes along a line.
fn dashes(points_m: &[[f64; 2]], [dash_m, gap_m]: [f64; 2]) -> Vec<Vec<[f64; 2]>> {
    let mut along_m = vec![0.0];
    for pair in points_m.windows(2) {
        along_m.push(along_m.last().copied().unwrap_or(0.0) + line_length(pair));
    }
    let end_m = along_m.last().copied().unwrap_or(0.0);
    let at = |way_m: f64| {
        let after = along_m.partition_point(|along| *along <= way_m).clamp(1, along_m.len() - 1);
        let (from, to) = (points_m[after - 1], points_m[after]);
        let share = (way_m - along_m[after - 1]) / (along_m[after] - along_m[after - 1]);
        std::array::from_fn(|i| from[i] + (to[i] - from[i]) * share)
    };
    let n = (end_m / (dash_m + gap_m)).ceil().clamp(0.0, MAX_DASHES) as usize;
    let one = |idx: usize| {
        let from_m = idx as f64 * (dash_m + gap_m);
        let to_m = (from_m + dash_m).min(end_m);
        let between = along_m.iter().zip(points_m);
        let corners = between.filter(|(along, _)| from_m < **along && **along < to_m);
        let mut dash = vec![at(from_m)];
        dash.extend(corners.map(|(_, point)| *point));
        dash.push(at(to_m));
        dash
    };
    if points_m.len() < 2 { Vec::new() } else { (0..n).map(one).collect() }
}

impl GroundArea {
    /// A place within the border for its name: the middle of the longest line along X through it at half
    /// its height, m.
    pub fn label_m(&self) -> Option<[f64; 2]> {
        let ys = self.border_m.iter().map(|corner| corner[1]);
        let (low, high) = ys.fold((f64::MAX, f64::MIN), |(l, h), y| (l.min(y), h.max(y)));
        // Off the corners, which often lie at half the height.
        let y = low + 0.493 * (high - low);
        let sides = self.border_m.iter().zip(self.border_m.iter().cycle().skip(1));
        let crossing = |(from, to): (&[f64; 2], &[f64; 2])| {
            ((from[1] > y) != (to[1] > y))
                .then(|| from[0] + (to[0] - from[0]) * (y - from[1]) / (to[1] - from[1]))
        };
        let mut xs: Vec<f64> = sides.filter_map(crossing).collect();
        xs.sort_by(f64::total_cmp);
        let inside = xs.chunks_exact(2);
        let longest = inside.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
        Some([(longest[0] + longest[1]) / 2.0, y])
    }
}

#[cfg(test)]
mod tests {
    use impactlab_core::numerics::polygon_holds;

    use super::*;

    #[test]
    fn dashes_have_their_length_around_corners_and_end_with_the_line() {
        let line = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]];
        let found = dashes(&line, [3.0, 6.0]);
        assert_eq!(found.len(), 3);
        assert_eq!(found[0], [[0.0, 0.0], [3.0, 0.0]]);
        assert_eq!(found[1], [[9.0, 0.0], [10.0, 0.0], [10.0, 2.0]]);
        assert_eq!(found[2], [[10.0, 8.0], [10.0, 10.0]]);
        assert!(dashes(&line[..1], [3.0, 6.0]).is_empty());
    }

    #[test]
    fn the_name_of_a_zone_lies_within_it() {
        // The letter U, whose middle is outside of it.
        let border_m = vec![
            [0.0, 0.0],
            [10.0, 0.0],
            [10.0, 8.0],
            [7.0, 8.0],
            [7.0, 2.0],
            [2.0, 2.0],
            [2.0, 8.0],
            [0.0, 8.0],
        ];
        let area = GroundArea { name: String::new(), kind: AreaKind::FrictionZone, border_m };
        let [x, y] = area.label_m().unwrap();
        assert!((7.0..10.0).contains(&x) && (2.0..8.0).contains(&y), "{x}, {y}");
        assert!(polygon_holds(&area.border_m, [x, y]));
    }
}
