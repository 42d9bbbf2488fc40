//! The lines of a drawing in the format DXF, as points on the ground.
//!
//! Read are lines, polylines with their arcs, circles, arcs, ellipses, splines, and what blocks that are
//! inserted have of them, as far as they lie in the plane of the ground and are shown: not on layers that
//! are switched off or frozen, and not made invisible themselves. What else the drawing shows, such as
//! texts and dimensions, is counted.

use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use dxf::entities::{Entity, EntityType};
use dxf::enums::Units;
use dxf::{Point, Vector};

use crate::data::{MAX_DRAWING_BYTES, MAX_DRAWING_OBJECTS, MAX_DRAWING_POINTS, read_bytes};
use crate::ranges::SURVEY_COORDINATE;
use crate::site::drawing_curves::{arc, bulged, spline};
use crate::site::frozen_layers::frozen_layers;
use crate::site::parts::{extent_of, extent_text};
use crate::site::unread_entities::unread_entities;
use crate::site::{DrawingFile, LengthUnit, SiteError, SiteOrigin};
use crate::units::UnitSystem;

/// What the first line of a binary drawing has, and that of a format that drawings are not read in.
const BINARY: &[u8] = b"AutoCAD Binary DXF";
const OTHER_FORMAT: &[u8] = b"AutoCAD DXB";

/// Blocks within blocks, at most.
const MAX_DEPTH: usize = 8;
/// Largest distance between an arc and its chords, m.
const CHORD_ERROR_M: f64 = 0.005;
/// Longer side of a drawing or a picture of a place of a collision, m.
pub(super) const USUAL_SIDE_M: std::ops::RangeInclusive<f64> = 3.0..=10_000.0;
/// Least vertical part of the normal of what lies in the plane of the ground.
const LEAST_NORMAL: f64 = 0.999;

/// The lines of a drawing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drawing {
    /// The lines.
    pub lines: Vec<DrawnLine>,
    /// How much of each kind is left out, by the name of the kind.
    pub left_out: BTreeMap<String, usize>,
    /// Name of its unit.
    pub unit: &'static str,
    /// Whether its frozen layers are not known, so that they are drawn.
    pub has_unknown_frozen: bool,
}

/// What was read of a drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawingSummary {
    /// Name of its unit.
    pub unit: &'static str,
    /// Number of lines.
    pub n_lines: usize,
    /// Smallest and largest `[X, Y]` of the lines, m; `None` without lines.
    pub extent_m: Option<[[f64; 2]; 2]>,
}

impl Drawing {
    /// Unit, number of lines and place.
    pub fn summary(&self) -> DrawingSummary {
        let points = self.lines.iter().flat_map(|line| line.points_m.iter().copied());
        let (unit, n_lines) = (self.unit, self.lines.len());
        DrawingSummary { unit, n_lines, extent_m: extent_of(points) }
    }

    /// What of it is not drawn or may be drawn too much, and that its size is doubtful, in words.
    ///
    /// - `path`: of its file.
    pub fn notes(&self, path: &Path) -> Vec<String> {
        let counts: Vec<String> =
            self.left_out.iter().map(|(kind, n)| format!("{n} {kind}")).collect();
        let left_out = (!counts.is_empty())
            .then(|| format!("{}: not drawn: {}", path.display(), counts.join(", ")));
        let unknown_frozen = self.has_unknown_frozen.then(|| {
            format!(
                "{}: which layers of a binary drawing are frozen is not read; they are drawn, too, unless \
                 [dxf] names the layers",
                path.display()
            )
        });
        let size = self.doubtful_size().map(|text| format!("{}: {text}", path.display()));
        left_out.into_iter().chain(unknown_frozen).chain(size).collect()
    }

    /// That it is as large or as small as no ground of a collision, as where a program states another unit than that of
    /// the numbers; `None` of a usual size.
    fn doubtful_size(&self) -> Option<String> {
        let DrawingSummary { unit, extent_m, .. } = self.summary();
        let [low, high] = extent_m?;
        let [width_m, height_m] = [high[0] - low[0], high[1] - low[1]];
        let is_usual = USUAL_SIDE_M.contains(&width_m.max(height_m));
        (!is_usual).then(|| {
            format!(
                "it is {width_m:.1} x {height_m:.1} m large in {unit}: is that its unit (unit in [dxf] says another one), \
                 or does something in it lie far off?"
            )
        })
    }
}

impl DrawingSummary {
    /// In words, after the name of the drawing.
    pub fn contents(&self, units: UnitSystem) -> String {
        let Self { unit, n_lines, extent_m } = self;
        let lines = if *n_lines == 1 { "line" } else { "lines" };
        let place = extent_m.map(|extent_m| extent_text(extent_m, units)).unwrap_or_default();
        format!(" in {unit}, {n_lines} {lines}{place}")
    }
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
pub fn read_drawing(file: &DrawingFile, origin: &SiteOrigin) -> Result<Drawing, SiteError> {
    let path = file.file.as_path();
    let wrong = |message: String| SiteError::Drawing { path: path.to_owned(), message };
    let bytes = read_bytes(path, MAX_DRAWING_BYTES)?;
    if first_line_has(&bytes, OTHER_FORMAT) {
        return Err(wrong("it is a DXB file; save it as DXF".to_owned()));
    }
    let got = count_objects(&bytes);
    if got > MAX_DRAWING_OBJECTS {
        let (path, limit) = (path.to_owned(), MAX_DRAWING_OBJECTS);
        return Err(SiteError::TooManyObjects { path, got, limit });
    }
    // The reader may panic where a file is damaged.
    let loaded = catch_unwind(AssertUnwindSafe(|| dxf::Drawing::load(&mut bytes.as_slice())));
    let drawing = match loaded {
        Ok(loaded) => loaded.map_err(|error| wrong(error.to_string()))?,
        Err(_) => return Err(wrong("it is damaged".to_owned())),
    };
    let chosen = file.unit.map(|unit| (unit.word(), unit.length_m()));
    let unit = chosen.or_else(|| stated_unit(drawing.header.default_drawing_units));
    let (unit, unit_m) = unit.ok_or_else(|| SiteError::NoUnit { path: path.to_owned() })?;
    let frozen = frozen_layers(&bytes);
    let mut reader = Reader::new(&drawing, file.layers.as_deref());
    reader.hide(&drawing, frozen.as_deref().unwrap_or_default());
    reader.chord_error = CHORD_ERROR_M / unit_m;
    let whole = Placed { along: [1.0, 0.0], across: [0.0, 1.0], at: [0.0; 2] };
    reader.entities(drawing.entities(), &whole, None, 0);
    for (layer, kind) in unread_entities(&bytes) {
        reader.leave_out(&layer, kind);
    }
    if reader.n_points > MAX_DRAWING_POINTS {
        return Err(SiteError::TooManyPoints { path: path.to_owned(), limit: MAX_DRAWING_POINTS });
    }
    let known = &reader.seen_layers;
    let missing = file.layers.iter().flatten().find(|layer| !known.contains(layer.as_str()));
    if let Some(layer) = missing {
        let known = known.iter().take(40).map(|name| (*name).to_owned()).collect();
        return Err(SiteError::NoLayer { path: path.to_owned(), layer: layer.clone(), known });
    }
    let (lines, left_out) = (reader.lines, reader.left_out);
    let has_unknown_frozen = frozen.is_none() && file.layers.is_none();
    let mut found = Drawing { lines, left_out, unit, has_unknown_frozen };
    for point in found.lines.iter_mut().flat_map(|line| &mut line.points_m) {
        let survey_m = point.map(|value| value * unit_m);
        if !survey_m.iter().all(|value| SURVEY_COORDINATE.contains(*value)) {
            return Err(SiteError::FarPoint { path: path.to_owned(), at_m: survey_m });
        }
        *point = origin.site_from_survey(survey_m);
    }
    Ok(found)
}

/// Number of objects in the text or the bytes of a drawing, before any of them is read: each begins with the
/// group code 0. It may be a few too many.
fn count_objects(bytes: &[u8]) -> usize {
    if is_binary(bytes) {
        let is_object = |at: &[u8]| at[..2] == [0, 0] && at[2].is_ascii_uppercase();
        return bytes.windows(3).filter(|at| is_object(at)).count();
    }
    let is_code_0 = |line: &&[u8]| {
        let mut digits = line.iter().filter(|byte| byte.is_ascii_alphanumeric()).peekable();
        digits.peek().is_some() && digits.all(|digit| *digit == b'0')
    };
    bytes.split(|byte| *byte == b'\n').step_by(2).filter(is_code_0).count()
}

/// Whether a drawing is in binary form.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    first_line_has(bytes, BINARY)
}

fn first_line_has(bytes: &[u8], words: &[u8]) -> bool {
    let line = bytes.split(|byte| *byte == b'\n').next().unwrap_or_default();
    line.windows(words.len()).any(|part| part == words)
}

/// Name and length of the unit that a drawing states, m; `None` if it states none, or one that no drawing
/// of a road has.
fn stated_unit(unit: Units) -> Option<(&'static str, f64)> {
    let named = |unit: LengthUnit| Some((unit.word(), unit.length_m()));
    match unit {
        Units::Meters => named(LengthUnit::Metre),
        Units::Decimeters => Some(("dm", 0.1)),
        Units::Centimeters => named(LengthUnit::Centimetre),
        Units::Millimeters => named(LengthUnit::Millimetre),
        Units::Kilometers => Some(("km", 1000.0)),
        Units::Feet => named(LengthUnit::Foot),
        Units::USSurveyFeet => named(LengthUnit::SurveyFoot),
        Units::Inches => named(LengthUnit::Inch),
        Units::Yards => Some(("yd", 0.9144)),
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
    /// The most by which it enlarges a length.
    fn scale(&self) -> f64 {
        self.along[0].hypot(self.along[1]).max(self.across[0].hypot(self.across[1]))
    }

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
    off: BTreeSet<&'a str>,
    /// Names of layers that are frozen: what is on them is not shown even as a part of a block.
    frozen: BTreeSet<&'a str>,
    /// Largest distance between an arc and its chords, in the unit of the drawing.
    chord_error: f64,
    seen_layers: BTreeSet<&'a str>,
    lines: Vec<DrawnLine>,
    n_points: usize,
    left_out: BTreeMap<String, usize>,
}

impl<'a> Reader<'a> {
    fn new(drawing: &'a dxf::Drawing, layers: Option<&'a [String]>) -> Self {
        Self {
            blocks: drawing.blocks().map(|block| (block.name.as_str(), block)).collect(),
            layers,
            off: BTreeSet::new(),
            frozen: BTreeSet::new(),
            chord_error: CHORD_ERROR_M,
            seen_layers: BTreeSet::new(),
            lines: Vec::new(),
            n_points: 0,
            left_out: BTreeMap::new(),
        }
    }

    /// Hides the layers that are switched off or frozen.
    ///
    /// - `is_frozen`: of each layer, in the order of the drawing.
    fn hide(&mut self, drawing: &'a dxf::Drawing, is_frozen: &[bool]) {
        let off = drawing.layers().filter(|layer| !layer.is_layer_on);
        self.off = off.map(|layer| layer.name.as_str()).collect();
        let frozen = drawing.layers().zip(is_frozen).filter(|(_, is_frozen)| **is_frozen);
        self.frozen = frozen.map(|(layer, _)| layer.name.as_str()).collect();
    }

    /// Whether what is on a layer is drawn: the layers that are asked for, or those that are shown.
    fn is_shown(&self, layer: &str) -> bool {
        match self.layers {
            Some(layers) => layers.iter().any(|wanted| wanted == layer),
            None => !self.off.contains(layer) && !self.frozen.contains(layer),
        }
    }

    /// - `block_layer`: the layer of the inserted block, which what is on layer 0 in it takes.
    fn entities(
        &mut self,
        entities: impl Iterator<Item = &'a Entity>,
        placed: &Placed,
        block_layer: Option<&'a str>,
        depth: usize,
    ) {
        for entity in entities {
            let is_seen = !entity.common.is_in_paper_space && entity.common.is_visible;
            if !is_seen || self.n_points > MAX_DRAWING_POINTS {
                continue;
            }
            let own = entity.common.layer.as_str();
            let layer = block_layer.filter(|_| own == "0").unwrap_or(own);
            if let EntityType::Insert(insert) = &entity.specific {
                self.insert(insert, placed, layer, depth);
                continue;
            }
            match points_of(&entity.specific, self.chord_error / placed.scale()) {
                Some(points) => self.add(&points, placed, layer),
                None => self.leave_out(layer, kind_of(&entity.specific)),
            }
        }
    }

    fn add(&mut self, points: &[[f64; 2]], placed: &Placed, layer: &'a str) {
        self.seen_layers.insert(layer);
        if self.is_shown(layer) && points.len() > 1 {
            self.n_points += points.len();
            let points_m = points.iter().map(|point| placed.placed(*point)).collect();
            self.lines.push(DrawnLine { layer: layer.to_owned(), points_m });
        }
    }

    fn insert(
        &mut self,
        insert: &'a dxf::entities::Insert,
        placed: &Placed,
        layer: &'a str,
        depth: usize,
    ) {
        // Blocks of nothing but blocks are counted, too.
        self.n_points += 1;
        // What a frozen insert holds is not shown, on whatever layer it is.
        if self.layers.is_none() && self.frozen.contains(layer) {
            return;
        }
        let block = self.blocks.get(insert.name.as_str()).copied();
        let is_plain = insert.column_count <= 1 && insert.row_count <= 1;
        let Some(block) = block.filter(|_| is_plain && depth < MAX_DEPTH) else {
            return self.leave_out(layer, "INSERT".to_owned());
        };
        // What another drawing has stands in its own file.
        if block.entities.is_empty() && (block.is_xref() || block.is_xref_overlay()) {
            return self.leave_out(layer, "INSERT of another drawing".to_owned());
        }
        let Some(mirror) = mirror(&insert.extrusion_direction) else {
            return self.leave_out(layer, "INSERT".to_owned());
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
        self.entities(block.entities.iter(), &inner, Some(layer), depth + 1);
    }

    fn leave_out(&mut self, layer: &str, kind: String) {
        if self.is_shown(layer) {
            *self.left_out.entry(kind).or_default() += 1;
        }
    }
}

/// The name of a kind of entity.
fn kind_of(entity: &EntityType) -> String {
    let text = format!("{entity:?}");
    text.chars().take_while(|c| c.is_alphanumeric()).collect()
}

/// The points of an entity; `None` for what is no line in the plane of the ground.
///
/// - `error`: largest distance between an arc and its chords.
fn points_of(entity: &EntityType, error: f64) -> Option<Vec<[f64; 2]>> {
    let flat = |point: &Point| [point.x, point.y];
    let points = match entity {
        EntityType::Line(line) => vec![flat(&line.p1), flat(&line.p2)],
        EntityType::LwPolyline(line) => {
            let vertices = line.vertices.iter().map(|vertex| ([vertex.x, vertex.y], vertex.bulge));
            let points = polyline(vertices.collect(), line.is_closed(), error);
            mirrored(points, &line.extrusion_direction)?
        }
        EntityType::Polyline(line) => {
            if line.is_3d_polygon_mesh() || line.is_polyface_mesh() {
                return None;
            }
            // The frame of a curve, which is not drawn, stands among its points.
            let drawn = line.vertices().filter(|vertex| !vertex.is_spline_frame_control_point());
            let vertices = drawn.map(|vertex| (flat(&vertex.location), vertex.bulge));
            mirrored(polyline(vertices.collect(), line.is_closed(), error), &line.normal)?
        }
        EntityType::Circle(circle) => {
            let axes = [[circle.radius, 0.0], [0.0, circle.radius]];
            let points = arc(flat(&circle.center), axes, [0.0, std::f64::consts::TAU], error);
            mirrored(points, &circle.normal)?
        }
        EntityType::Arc(part) => {
            let axes = [[part.radius, 0.0], [0.0, part.radius]];
            let ends = [part.start_angle, part.end_angle].map(f64::to_radians);
            mirrored(arc(flat(&part.center), axes, ends, error), &part.normal)?
        }
        EntityType::Ellipse(ellipse) => {
            let mirror = mirror(&ellipse.normal)?;
            let ([x, y], ratio) =
                ([ellipse.major_axis.x, ellipse.major_axis.y], ellipse.minor_axis_ratio);
            let axes = [[x, y], [-mirror * ratio * y, mirror * ratio * x]];
            arc(
                flat(&ellipse.center),
                axes,
                [ellipse.start_parameter, ellipse.end_parameter],
                error,
            )
        }
        EntityType::Spline(curve) => {
            let control: Vec<[f64; 2]> = curve.control_points.iter().map(flat).collect();
            spline(
                usize::try_from(curve.degree_of_curve).ok()?,
                curve.knot_values.as_slice(),
                curve.weight_values.as_slice(),
                &control,
            )?
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

/// The points of a polyline, at most a few more than a drawing may have.
///
/// - `vertices`: each with the bulge of the side that follows.
fn polyline(vertices: Vec<([f64; 2], f64)>, is_closed: bool, error: f64) -> Vec<[f64; 2]> {
    let Some(first) = vertices.first().copied() else { return Vec::new() };
    let mut points = vec![first.0];
    for pair in vertices.windows(2) {
        points.extend(bulged([pair[0].0, pair[1].0], pair[0].1, error));
        if points.len() > MAX_DRAWING_POINTS {
            return points;
        }
    }
    if let Some(last) = vertices.last().filter(|_| is_closed) {
        points.extend(bulged([last.0, first.0], last.1, error));
    }
    points
}
