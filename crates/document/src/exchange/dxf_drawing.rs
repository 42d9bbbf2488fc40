//! A scene as a drawing in DXF (AutoCAD 2000), in metres, seen from above.
//!
//! Each role and kind has a layer: `SIMULATED_PATH`, `STRIKING_OUTLINE`, `EVIDENCE_POINT`. Axes are those
//! of the scene: X along the road, Y to the left. Outlines of cars are closed polylines at chosen
//! instants, with the instant beside them. A line that is dashed in the scene has a line type with the
//! same dashes. What restricts the answer stands as text below the drawing, in the layer `RESTRICTIONS`,
//! in the units of the scene as its labels are.
//!
//! Dates and identifiers of the drawing are fixed, so that the same scene gives the same drawing.

use std::collections::BTreeMap;
use std::io::Write;

use dxf::entities::{Entity, EntityType, Line, LwPolyline, ModelPoint, Text};
use dxf::enums::{AcadVersion, DrawingUnits, Units};
use dxf::tables::{Layer, LineType};
use dxf::{Color, Drawing, LwPolylineVertex, Point};

use crate::exchange::ExchangeError;
use crate::exchange::looks::{role_aci, role_name};
use crate::figure::Dashes;
use crate::scene::{Scene, SceneCar, SceneMark, SceneRole};
use impactlab_core::site::SiteOrigin;

/// Height of text, m.
const TEXT_M: f64 = 0.4;
/// Distance between lines of text, m.
const LINE_M: f64 = 0.7;
/// Half the size of the cross at a second contact, m.
const CROSS_M: f64 = 0.6;
/// Length of a dash for each point that it has on the screen, m.
const DASH_M_PER_POINT: f64 = 0.1;
/// Layer of what restricts the answer.
const RESTRICTIONS: &str = "RESTRICTIONS";

/// What a drawing shows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DxfOptions {
    /// Instants at which the outlines of the cars are drawn, s; before a motion begins and after it ends
    /// a car stands.
    pub outlines_s: Vec<f64>,
}

/// Writes a scene as DXF.
///
/// # Errors
/// [`ExchangeError::Dxf`] with the error of the library or of the operating system.
pub fn dxf(scene: &Scene, options: &DxfOptions, out: &mut dyn Write) -> Result<(), ExchangeError> {
    let mut sheet = Sheet::default();
    for path in &scene.paths {
        let places = path.motion.states().iter().map(|state| [state.pose.x_m, state.pose.y_m]);
        let dashes = path.is_dashed.then(|| path.role.dashes());
        sheet.polyline((path.role, "PATH"), dashes, places, false);
    }
    for car in scene.cars.iter().filter(|car| !car.is_draw()) {
        options.outlines_s.iter().for_each(|time_s| sheet.outline(car, *time_s));
    }
    for line in &scene.lines {
        let is_closed = line.points_m.len() > 2 && line.points_m.first() == line.points_m.last();
        let n = line.points_m.len() - usize::from(is_closed);
        let places = line.points_m.iter().take(n).copied();
        let dashes = line.is_dashed.then(|| line.role.dashes());
        sheet.polyline((line.role, "LINE"), dashes, places, is_closed);
    }
    for piece in scene.marks.iter().flat_map(SceneMark::pieces) {
        let places = piece.iter().map(|point| point.place_m);
        sheet.polyline((SceneRole::TireMark, "LINE"), None, places, false);
    }
    for crush in &scene.crushes {
        let pose = crush.motion.at(crush.from_s).pose;
        let places = crush.outline_m.iter().map(|corner| pose.world_from_body(*corner));
        sheet.polyline((SceneRole::Crush, "OUTLINE"), None, places, true);
    }
    for point in &scene.points {
        sheet.add(point.role, "POINT", EntityType::ModelPoint(ModelPoint::new(at(point.at_m))));
        sheet.text(point.role, "TEXT", point.at_m, &point.name);
    }
    for arrow in &scene.arrows {
        let [from, to] = arrow.ends_m;
        sheet.line(arrow.role, "LINE", [from, to]);
        sheet.text(arrow.role, "TEXT", from, &arrow.name);
    }
    for cross in &scene.crosses {
        let [x, y] = cross.at_m;
        for slope in [1.0, -1.0] {
            let ends = [[x - CROSS_M, y - slope * CROSS_M], [x + CROSS_M, y + slope * CROSS_M]];
            sheet.line(SceneRole::Evidence, "LINE", ends);
        }
        let text = format!("{} from {:.3} s", cross.name, cross.time_s);
        sheet.text(SceneRole::Evidence, "TEXT", cross.at_m, &text);
    }
    sheet.notes(scene);
    sheet.save(out)
}

/// A drawing that is being made.
#[derive(Default)]
struct Sheet {
    entities: Vec<Entity>,
    /// Layers and their colours, in a fixed order.
    layers: BTreeMap<String, u8>,
    /// Line types by their names.
    line_types: BTreeMap<String, LineType>,
}

impl Sheet {
    fn add(&mut self, role: SceneRole, kind: &str, specific: EntityType) {
        self.add_to(format!("{}_{kind}", role_name(role)), role_aci(role), specific);
    }

    fn add_to(&mut self, layer: String, aci: u8, specific: EntityType) {
        let mut entity = Entity::new(specific);
        entity.common.layer.clone_from(&layer);
        self.layers.insert(layer, aci);
        self.entities.push(entity);
    }

    /// A line through places, without those that are not finite.
    ///
    /// - `dashes`: of a line that is dashed.
    fn polyline(
        &mut self,
        (role, kind): (SceneRole, &str),
        dashes: Option<Dashes>,
        places_m: impl Iterator<Item = [f64; 2]>,
        is_closed: bool,
    ) {
        let finite = places_m.filter(|place| place.iter().all(|value| value.is_finite()));
        let vertices: Vec<LwPolylineVertex> =
            finite.map(|[x, y]| LwPolylineVertex { x, y, ..LwPolylineVertex::default() }).collect();
        if vertices.len() < 2 {
            return;
        }
        let mut line = LwPolyline { vertices, ..LwPolyline::default() };
        line.set_is_closed(is_closed);
        // Dashes go on across vertices, which are closer to each other than they are long.
        line.set_is_pline_gen(dashes.is_some());
        self.add(role, kind, EntityType::LwPolyline(line));
        if let (Some(dashes), Some(entity)) = (dashes, self.entities.last_mut()) {
            let of_dashes = line_type(dashes);
            entity.common.line_type_name.clone_from(&of_dashes.name);
            self.line_types.insert(of_dashes.name.clone(), of_dashes);
        }
    }

    fn line(&mut self, role: SceneRole, kind: &str, [from, to]: [[f64; 2]; 2]) {
        self.add(role, kind, EntityType::Line(Line::new(at(from), at(to))));
    }

    fn text(&mut self, role: SceneRole, kind: &str, place_m: [f64; 2], value: &str) {
        if !value.is_empty() {
            self.add(role, kind, EntityType::Text(text(place_m, value)));
        }
    }

    /// The outline of a car with a line from its middle to its front, and the instant beside it.
    fn outline(&mut self, car: &SceneCar, time_s: f64) {
        let (pose, body) = (car.at(time_s).pose, &car.shape.body);
        let (front, rear, side) = (body.front_m, body.rear_m(), body.width_m / 2.0);
        let corners = [[front, side], [rear, side], [rear, -side], [front, -side]];
        let places = corners.iter().map(|corner| pose.world_from_body(*corner));
        self.polyline((car.role, "OUTLINE"), None, places, true);
        self.line(
            car.role,
            "OUTLINE",
            [[0.0, 0.0], [front, 0.0]].map(|end| pose.world_from_body(end)),
        );
        let name = if car.tag.is_empty() { &car.name } else { &car.tag };
        let place = pose.world_from_body([front, side]);
        self.text(car.role, "TEXT", place, &format!("{name}, {time_s:.3} s"));
    }

    /// Title, units and what restricts the answer, below the drawing.
    fn notes(&mut self, scene: &Scene) {
        let [low, _] = scene.extent_m();
        let title = format!("{}, metres, X along the road, Y to the left", scene.title);
        let survey = scene.ground.as_ref().map(|ground| survey_text(ground.origin.as_ref()));
        let caveats = scene.caveats.in_units(scene.units);
        let caveats = caveats.restrictions().into_iter().chain(caveats.assumptions());
        let restrictions =
            caveats.map(|caveat| format!("{}: {}", caveat.kind.label(), caveat.statement()));
        for (idx, value) in std::iter::once(title).chain(survey).chain(restrictions).enumerate() {
            let place = [low[0], low[1] - (idx + 2) as f64 * LINE_M];
            self.add_to(RESTRICTIONS.to_owned(), 1, EntityType::Text(text(place, &value)));
        }
    }

    fn save(self, mut out: &mut dyn Write) -> Result<(), ExchangeError> {
        let mut drawing = Drawing::new();
        let header = &mut drawing.header;
        header.version = AcadVersion::R2000;
        header.default_drawing_units = Units::Meters;
        header.drawing_units = DrawingUnits::Metric;
        let beginning = chrono::DateTime::<chrono::Utc>::UNIX_EPOCH;
        (header.creation_date, header.update_date) = (beginning.into(), beginning.into());
        (header.creation_date_universal, header.update_date_universal) = (beginning, beginning);
        (header.fingerprint_guid, header.version_guid) = (uuid::Uuid::nil(), uuid::Uuid::nil());
        for line_type in self.line_types.into_values() {
            drawing.add_line_type(line_type);
        }
        for (name, aci) in self.layers {
            drawing.add_layer(Layer { name, color: Color::from_index(aci), ..Layer::default() });
        }
        for entity in self.entities {
            drawing.add_entity(entity);
        }
        Ok(drawing.save(&mut out)?)
    }
}

/// The line type of dashes.
fn line_type(dashes: Dashes) -> LineType {
    let Dashes { length, .. } = dashes;
    let [dash_m, gap_m] = [length, dashes.gap()].map(|points| f64::from(points) * DASH_M_PER_POINT);
    LineType {
        name: format!("DASHED_{length:.0}"),
        description: format!("dashes of {dash_m:.1} m"),
        element_count: 2,
        total_pattern_length: dash_m + gap_m,
        // Gaps are negative.
        dash_dot_space_lengths: vec![dash_m, -gap_m],
        ..LineType::default()
    }
}

/// Where a drawing with a ground lies in survey coordinates.
fn survey_text(origin: Option<&SiteOrigin>) -> String {
    let Some(SiteOrigin { survey_m: [easting_m, northing_m], x_axis_azimuth_rad }) = origin else {
        return "in the axes of the site, which has no origin in survey coordinates".to_owned();
    };
    let azimuth_deg = x_axis_azimuth_rad.to_degrees();
    format!(
        "in the axes of the site: origin at easting {easting_m} m, northing {northing_m} m, X at \
         {azimuth_deg:.6} deg clockwise from grid north"
    )
}

/// A line of text in one row, whose line ends would break the file.
fn text(place_m: [f64; 2], value: &str) -> Text {
    let value = value.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    Text { location: at(place_m), text_height: TEXT_M, value, ..Text::default() }
}

fn at([x, y]: [f64; 2]) -> Point {
    Point::new(x, y, 0.0)
}
