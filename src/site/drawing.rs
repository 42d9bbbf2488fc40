//! The lines of a drawing in the format DXF, as points on the ground.
//!
//! Read are lines, polylines with their arcs, circles, arcs, ellipses, splines, and what blocks that are
//! inserted have of them, as far as they lie in the plane of the ground. What else the drawing holds, such
//! as texts and dimensions, is counted.

use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};

use dxf::entities::{Entity, EntityType};
use dxf::enums::Units;
use dxf::{Point, Vector};

use crate::data::{MAX_DRAWING_BYTES, MAX_DRAWING_POINTS, read_bytes};
use crate::ranges::SURVEY_COORDINATE;
use crate::site::drawing_curves::{arc, bulged, spline};
use crate::site::{DrawingFile, DrawingUnit, SiteError, SiteOrigin};

/// Blocks within blocks, at most.
const MAX_DEPTH: usize = 8;
/// Least vertical part of the normal of what lies in the plane of the ground.
const LEAST_NORMAL: f64 = 0.999;

/// The lines of a drawing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drawing {
    /// The lines.
    pub lines: Vec<DrawnLine>,
    /// How much of each kind is left out, by the name of the kind.
    pub left_out: BTreeMap<String, usize>,
}

/// A line of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnLine {
    /// Its layer.
    pub layer: String,
    /// Its points in the axes of the site, m.
    pub points_m: Vec<[f64; 2]>,
}

/// Reads a drawing.
///
/// - `origin`: of the site, whose survey coordinates the drawing has.
///
/// # Errors
/// [`SiteError`] with what is wrong.
pub fn read_drawing(of: &DrawingFile, origin: &SiteOrigin) -> Result<Drawing, SiteError> {
    let path = of.file.as_path();
    let wrong = |message: String| SiteError::Drawing { path: path.to_owned(), message };
    let bytes = read_bytes(path, MAX_DRAWING_BYTES)?;
    // The reader may panic where a file is damaged.
    let loaded = catch_unwind(AssertUnwindSafe(|| dxf::Drawing::load(&mut bytes.as_slice())));
    let drawing = match loaded {
        Ok(loaded) => loaded.map_err(|error| wrong(error.to_string()))?,
        Err(_) => return Err(wrong("it is damaged".to_owned())),
    };
    let stated = stated_unit_m(drawing.header.default_drawing_units);
    let unit_m = of.unit.map(DrawingUnit::length_m).or(stated);
    let unit_m = unit_m.ok_or_else(|| SiteError::NoUnit { path: path.to_owned() })?;
    let mut reader = Reader::new(&drawing, of.layers.as_deref());
    let whole = Placed { along: [1.0, 0.0], across: [0.0, 1.0], at: [0.0; 2] };
    reader.entities(drawing.entities(), (&whole, None), 0);
    if reader.n_points > MAX_DRAWING_POINTS {
        return Err(SiteError::TooManyPoints { path: path.to_owned(), limit: MAX_DRAWING_POINTS });
    }
    let known = &reader.seen_layers;
    let missing = of.layers.iter().flatten().find(|layer| !known.contains(layer.as_str()));
    if let Some(layer) = missing {
        let known = known.iter().take(40).map(|name| (*name).to_owned()).collect();
        return Err(SiteError::NoLayer { path: path.to_owned(), layer: layer.clone(), known });
    }
    let mut found = Drawing { lines: reader.lines, left_out: reader.left_out };
    for point in found.lines.iter_mut().flat_map(|line| &mut line.points_m) {
        let survey_m = point.map(|value| value * unit_m);
        if !survey_m.iter().all(|value| SURVEY_COORDINATE.contains(*value)) {
            return Err(SiteError::FarPoint { path: path.to_owned(), at_m: survey_m });
        }
        *point = origin.site_from_survey(survey_m);
    }
    Ok(found)
}

/// Length of the unit that a drawing states, m; `None` if it states none, or one that no drawing of a
/// road has.
fn stated_unit_m(unit: Units) -> Option<f64> {
    match unit {
        Units::Meters => Some(DrawingUnit::Metre.length_m()),
        Units::Decimeters => Some(0.1),
        Units::Centimeters => Some(DrawingUnit::Centimetre.length_m()),
        Units::Millimeters => Some(DrawingUnit::Millimetre.length_m()),
        Units::Kilometers => Some(1000.0),
        Units::Feet => Some(DrawingUnit::Foot.length_m()),
        Units::USSurveyFeet => Some(DrawingUnit::SurveyFoot.length_m()),
        Units::Inches => Some(DrawingUnit::Inch.length_m()),
        Units::Yards => Some(0.9144),
        _ => None,
    }
}

/// Where a block is inserted: `p ↦ at + x · along + y · across`.
struct Placed {
    along: [f64; 2],
    across: [f64; 2],
    at: [f64; 2],
}

impl Placed {
    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|i| x * self.along[i] + y * self.across[i])
    }

    fn placed(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.turned(point);
        [self.at[0] + x, self.at[1] + y]
    }
}

/// Collects the lines of a drawing.
struct Reader<'a> {
    layers: Option<&'a [String]>,
    blocks: BTreeMap<&'a str, &'a dxf::Block>,
    /// Names of layers that are switched off.
    hidden: BTreeSet<&'a str>,
    seen_layers: BTreeSet<&'a str>,
    lines: Vec<DrawnLine>,
    n_points: usize,
    left_out: BTreeMap<String, usize>,
}

impl<'a> Reader<'a> {
    fn new(drawing: &'a dxf::Drawing, layers: Option<&'a [String]>) -> Self {
        let hidden = drawing.layers().filter(|layer| !layer.is_layer_on);
        Self {
            blocks: drawing.blocks().map(|block| (block.name.as_str(), block)).collect(),
            layers,
            hidden: hidden.map(|layer| layer.name.as_str()).collect(),
            seen_layers: BTreeSet::new(),
            lines: Vec::new(),
            n_points: 0,
            left_out: BTreeMap::new(),
        }
    }

    /// - `block_layer`: the layer of the inserted block, which what is on layer 0 in it takes.
    fn entities(
        &mut self,
        entities: impl Iterator<Item = &'a Entity>,
        (placed, block_layer): (&Placed, Option<&'a str>),
        depth: usize,
    ) {
        for entity in entities {
            if entity.common.is_in_paper_space || self.n_points > MAX_DRAWING_POINTS {
                continue;
            }
            let own = entity.common.layer.as_str();
            let layer = block_layer.filter(|_| own == "0").unwrap_or(own);
            if let EntityType::Insert(insert) = &entity.specific {
                self.insert(insert, (placed, layer), depth);
                continue;
            }
            match points_of(&entity.specific) {
                Some(points) => self.add(&points, placed, layer),
                None => self.leave_out(kind_of(&entity.specific)),
            }
        }
    }

    fn add(&mut self, points: &[[f64; 2]], placed: &Placed, layer: &'a str) {
        self.seen_layers.insert(layer);
        let is_shown = match self.layers {
            Some(layers) => layers.iter().any(|wanted| wanted == layer),
            None => !self.hidden.contains(layer),
        };
        if is_shown && points.len() > 1 {
            self.n_points += points.len();
            let points_m = points.iter().map(|point| placed.placed(*point)).collect();
            self.lines.push(DrawnLine { layer: layer.to_owned(), points_m });
        }
    }

    fn insert(
        &mut self,
        insert: &'a dxf::entities::Insert,
        (placed, layer): (&Placed, &'a str),
        depth: usize,
    ) {
        // Blocks of nothing but blocks are counted, too.
        self.n_points += 1;
        let block = self.blocks.get(insert.name.as_str()).copied();
        let is_plain = insert.column_count <= 1 && insert.row_count <= 1;
        let Some(block) = block.filter(|_| is_plain && depth < MAX_DEPTH) else {
            return self.leave_out("INSERT".to_owned());
        };
        let Some(mirror) = mirror(&insert.extrusion_direction) else {
            return self.leave_out("INSERT".to_owned());
        };
        let (sin, cos) = insert.rotation.to_radians().sin_cos();
        let own = Placed {
            along: [mirror * cos * insert.x_scale_factor, sin * insert.x_scale_factor],
            across: [-mirror * sin * insert.y_scale_factor, cos * insert.y_scale_factor],
            at: [mirror * insert.location.x, insert.location.y],
        };
        let [bx, by] = own.turned([-block.base_point.x, -block.base_point.y]);
        let at = placed.placed([own.at[0] + bx, own.at[1] + by]);
        let inner =
            Placed { along: placed.turned(own.along), across: placed.turned(own.across), at };
        self.entities(block.entities.iter(), (&inner, Some(layer)), depth + 1);
    }

    fn leave_out(&mut self, kind: String) {
        *self.left_out.entry(kind).or_default() += 1;
    }
}

/// The name of a kind of entity.
fn kind_of(entity: &EntityType) -> String {
    let text = format!("{entity:?}");
    text.chars().take_while(|c| c.is_alphanumeric()).collect()
}

/// The points of an entity; `None` for what is no line in the plane of the ground.
fn points_of(entity: &EntityType) -> Option<Vec<[f64; 2]>> {
    let flat = |point: &Point| [point.x, point.y];
    let points = match entity {
        EntityType::Line(line) => vec![flat(&line.p1), flat(&line.p2)],
        EntityType::LwPolyline(line) => {
            let vertices = line.vertices.iter().map(|of| ([of.x, of.y], of.bulge));
            mirrored(polyline(vertices.collect(), line.is_closed()), &line.extrusion_direction)?
        }
        EntityType::Polyline(line) => {
            if line.is_3d_polygon_mesh() || line.is_polyface_mesh() {
                return None;
            }
            let vertices = line.vertices().map(|of| (flat(&of.location), of.bulge));
            mirrored(polyline(vertices.collect(), line.is_closed()), &line.normal)?
        }
        EntityType::Circle(of) => {
            let axes = [[of.radius, 0.0], [0.0, of.radius]];
            let points = arc(flat(&of.center), axes, [0.0, std::f64::consts::TAU]);
            mirrored(points, &of.normal)?
        }
        EntityType::Arc(of) => {
            let axes = [[of.radius, 0.0], [0.0, of.radius]];
            let ends = [of.start_angle, of.end_angle].map(f64::to_radians);
            mirrored(arc(flat(&of.center), axes, ends), &of.normal)?
        }
        EntityType::Ellipse(of) => {
            let mirror = mirror(&of.normal)?;
            let ([x, y], ratio) = ([of.major_axis.x, of.major_axis.y], of.minor_axis_ratio);
            let axes = [[x, y], [-mirror * ratio * y, mirror * ratio * x]];
            arc(flat(&of.center), axes, [of.start_parameter, of.end_parameter])
        }
        EntityType::Spline(of) => {
            let control: Vec<[f64; 2]> = of.control_points.iter().map(flat).collect();
            let knots = (of.knot_values.as_slice(), of.weight_values.as_slice());
            spline(usize::try_from(of.degree_of_curve).ok()?, knots, &control)?
        }
        _ => return None,
    };
    points.iter().flatten().all(|value| value.is_finite()).then_some(points)
}

/// 1 for what is drawn from above, −1 from below, which mirrors x; `None` for what is tilted.
fn mirror(normal: &Vector) -> Option<f64> {
    let length = normal.x.hypot(normal.y).hypot(normal.z);
    (normal.z.abs() >= LEAST_NORMAL * length && length > 0.0).then(|| normal.z.signum())
}

fn mirrored(points: Vec<[f64; 2]>, normal: &Vector) -> Option<Vec<[f64; 2]>> {
    let mirror = mirror(normal)?;
    Some(points.into_iter().map(|[x, y]| [mirror * x, y]).collect())
}

/// The points of a polyline.
///
/// - `vertices`: each with the bulge of the side that follows.
fn polyline(vertices: Vec<([f64; 2], f64)>, is_closed: bool) -> Vec<[f64; 2]> {
    let Some(first) = vertices.first().copied() else { return Vec::new() };
    let mut points = vec![first.0];
    for pair in vertices.windows(2) {
        points.extend(bulged([pair[0].0, pair[1].0], pair[0].1));
    }
    if let Some(last) = vertices.last().filter(|_| is_closed) {
        points.extend(bulged([last.0, first.0], last.1));
    }
    points
}

#[cfg(test)]
mod tests {
    use dxf::LwPolylineVertex;
    use dxf::entities::{Circle, Insert, Line, LwPolyline, Text};
    use dxf::enums::AcadVersion;

    use super::*;

    fn on(layer: &str, specific: EntityType) -> Entity {
        let mut entity = Entity::new(specific);
        entity.common.layer = layer.to_owned();
        entity
    }

    fn line(from: [f64; 2], to: [f64; 2]) -> EntityType {
        let point = |[x, y]: [f64; 2]| Point::new(x, y, 0.0);
        EntityType::Line(Line::new(point(from), point(to)))
    }

    fn saved(drawing: &dxf::Drawing) -> (tempfile::TempDir, DrawingFile) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("survey.dxf");
        drawing.save_file(&file).unwrap();
        (folder, DrawingFile { file, unit: None, layers: None })
    }

    #[test]
    fn lines_come_back_in_metres_and_in_the_axes_of_the_site() {
        let mut drawing = dxf::Drawing::new();
        drawing.header.version = AcadVersion::R2010;
        drawing.header.default_drawing_units = Units::Millimeters;
        let far = [3.5e9, 5.4e9];
        let at = |x: f64, y: f64| [far[0] + x, far[1] + y];
        drawing.add_entity(on("KERB", line(at(0.0, 0.0), at(10_000.0, 0.0))));
        let vertex = |x: f64, y: f64, bulge| LwPolylineVertex {
            x: far[0] + x,
            y: far[1] + y,
            bulge,
            ..Default::default()
        };
        let vertices =
            vec![vertex(0.0, 0.0, 0.0), vertex(2000.0, 0.0, 1.0), vertex(2000.0, 4000.0, 0.0)];
        let mut closed = LwPolyline { vertices, ..LwPolyline::default() };
        closed.set_is_closed(true);
        drawing.add_entity(on("ROAD", EntityType::LwPolyline(closed)));
        drawing.add_entity(on("ROAD", EntityType::Text(Text::default())));
        let (_folder, mut of) = saved(&drawing);
        let origin = SiteOrigin { survey_m: [3.5e6, 5.4e6], ..SiteOrigin::default() };
        let read = read_drawing(&of, &origin).unwrap();
        assert_eq!(read.lines.len(), 2);
        let [from, to] = [read.lines[0].points_m[0], read.lines[0].points_m[1]];
        assert!(from[0].hypot(from[1]) < 1e-6 && (to[0] - 10.0).hypot(to[1]) < 1e-6, "{to:?}");
        let outline = &read.lines[1].points_m;
        assert_eq!(outline.first(), outline.last());
        let widest = outline.iter().map(|point| point[0]).fold(0.0, f64::max);
        assert!((widest - 4.0).abs() < 1e-6, "the arc reaches 2 m beyond its chord: {widest}");
        assert_eq!(read.left_out.get("Text"), Some(&1));
        of.layers = Some(vec!["KERB".to_owned()]);
        assert_eq!(read_drawing(&of, &origin).unwrap().lines.len(), 1);
        of.layers = Some(vec!["WALL".to_owned()]);
        let error = read_drawing(&of, &origin).unwrap_err().to_string();
        assert!(error.ends_with("has no layer \"WALL\", expected one of KERB, ROAD"), "{error}");
    }

    #[test]
    fn the_unit_has_to_be_known_and_the_coordinates_possible() {
        let mut drawing = dxf::Drawing::new();
        drawing.header.version = AcadVersion::R2010;
        drawing.add_entity(on("0", line([0.0, 0.0], [3.0e7, 1.0])));
        let (_folder, mut of) = saved(&drawing);
        let origin = SiteOrigin::default();
        let error = read_drawing(&of, &origin).unwrap_err().to_string();
        assert!(error.contains("does not say in which unit it is drawn"), "{error}");
        of.unit = Some(DrawingUnit::Metre);
        let error = read_drawing(&of, &origin).unwrap_err().to_string();
        assert!(error.contains("is the unit right?"), "{error}");
        of.unit = Some(DrawingUnit::Foot);
        let read = read_drawing(&of, &origin).unwrap();
        assert!((read.lines[0].points_m[1][0] - 9.144e6).abs() < 1e-6);
    }

    #[test]
    fn blocks_are_turned_scaled_and_placed() {
        let mut drawing = dxf::Drawing::new();
        drawing.header.version = AcadVersion::R2010;
        drawing.header.default_drawing_units = Units::Meters;
        let mut block = dxf::Block { name: "SIGN".to_owned(), ..Default::default() };
        block.base_point = Point::new(1.0, 0.0, 0.0);
        block.entities.push(on("0", line([1.0, 0.0], [2.0, 0.0])));
        let circle = Circle::new(Point::new(1.0, 1.0, 0.0), 0.5);
        block.entities.push(on("0", EntityType::Circle(circle)));
        drawing.add_block(block);
        let insert = Insert {
            name: "SIGN".to_owned(),
            location: Point::new(10.0, 20.0, 0.0),
            rotation: 90.0,
            x_scale_factor: 2.0,
            y_scale_factor: 2.0,
            ..Insert::default()
        };
        drawing.add_entity(on("SIGNS", EntityType::Insert(insert)));
        let (_folder, of) = saved(&drawing);
        let read = read_drawing(&of, &SiteOrigin::default()).unwrap();
        assert_eq!(read.lines.len(), 2);
        assert!(read.lines.iter().all(|line| line.layer == "SIGNS"));
        let [from, to] = [read.lines[0].points_m[0], read.lines[0].points_m[1]];
        assert!((from[0] - 10.0).hypot(from[1] - 20.0) < 1e-9, "{from:?}");
        assert!((to[0] - 10.0).hypot(to[1] - 22.0) < 1e-9, "{to:?}");
        let circle = &read.lines[1].points_m;
        assert!(circle.iter().all(|p| ((p[0] - 8.0).hypot(p[1] - 20.0) - 1.0).abs() < 1e-9));
    }

    #[test]
    fn a_damaged_drawing_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("bad.dxf");
        for text in ["", "not a drawing", "0\nSECTION\n2\nENTITIES\n0\nLINE\n10\nabc\n"] {
            std::fs::write(&file, text).unwrap();
            let unit = Some(DrawingUnit::Metre);
            let of = DrawingFile { file: file.clone(), unit, layers: None };
            match read_drawing(&of, &SiteOrigin::default()) {
                Ok(read) => assert_eq!(read, Drawing::default(), "{text:?}"),
                Err(error) => {
                    assert!(error.to_string().contains("bad.dxf: cannot be read"), "{error}")
                }
            }
        }
    }
}
