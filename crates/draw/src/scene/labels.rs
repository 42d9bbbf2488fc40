//! Text and symbols over a scene: metres along the grid, a scale bar, the directions of the axes, the
//! time, and the names of cars.

use std::sync::Arc;

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, Vec2, pos2, vec2};

use crate::scene::Projection;
use crate::scene::grid::grid_step;
use crate::scene::measures::{draw_measure, draw_measure_text, measure_text_place};
use crate::scene::shade::{ground_color, role_color, zone_color};
use impactlab_core::data::Severity;
use impactlab_core::numerics::polygon_holds;
use impactlab_core::uncertainty::Caveat;
use impactlab_core::units::{Language, Quantity};
use impactlab_document::scene::{AreaKind, CarLook, GroundArea, Scene, SceneRole};

/// Sizes of text, points.
const SMALL: f32 = 10.0;
const USUAL: f32 = 12.0;
/// Distance of labels from the edge, points.
const EDGE: f32 = 6.0;
/// Labels along an axis, at most.
const MAX_LABELS: usize = 60;
/// Places along and up a picture at which the name of a zone may stand.
const PLACES: [usize; 2] = [24, 18];
/// Steps by which a name gives way to others.
const MAX_MOVES: usize = 8;
/// Wanted length of the scale bar, points.
const BAR_POINTS: f64 = 110.0;
/// Radius of the plate below the axes, points: a share of the height of the picture within limits.
const AXES_SHARE: f32 = 0.16;
const AXES_RADII: [f32; 2] = [24.0, 40.0];
/// Length of the arrows of the axes over the radius of their plate.
const ARROW_SHARE: f32 = 0.65;
/// Width of what the time stamp takes, and height of each of its lines, points.
const STAMP_WIDTH: f32 = 150.0;
const STAMP_LINE: f32 = 17.0;
/// Width and height of what the scale bar takes, points.
const BAR_SIZE: Vec2 = vec2(150.0, 46.0);
/// Half the length of the needle that points north, and width of the plate below it, points.
const NORTH_POINTS: f32 = 13.0;
const NORTH_PLATE: f32 = 2.0 * NORTH_POINTS + 22.0;
/// Opacity of what lies behind text.
const PLATE: f32 = 0.78;

/// A scene in a rectangle of the window.
pub struct Labels<'a> {
    /// Where the picture is.
    pub rect: Rect,
    /// The projection, in pixels of the picture.
    pub projection: &'a Projection,
    /// Pixels per point.
    pub points: f32,
    /// Whether the theme is dark.
    pub dark: bool,
    /// Whether the time and what restricts the scene stand over the picture; in a frame of a film they
    /// stand beside it.
    pub is_stamped: bool,
}

impl Labels<'_> {
    /// Draws everything over the scene at a time, no text on another: first what has its place, then
    /// names, which give way, then the numbers along the grid where there is room.
    pub fn draw(&self, painter: &Painter, scene: &Scene, time_s: f64) {
        let mut taken = vec![self.scale_bar(painter, scene), self.axes(painter)];
        taken.extend(self.north(painter, scene));
        if self.is_stamped {
            self.stamp(painter, scene, time_s, &mut taken);
        }
        self.names(painter, scene, time_s, &mut taken);
        self.arrows(painter, scene, &mut taken);
        self.zones(painter, scene, &mut taken);
        self.measures(painter, scene);
        match self.projection.is_parallel() {
            true => self.ticks_from_above(painter, scene, &mut taken),
            false => self.ticks_on_ground(painter, scene, &mut taken),
        }
    }

    fn measures(&self, painter: &Painter, scene: &Scene) {
        for measure in &scene.measures {
            let on_screen = |[x, y]: &[f64; 2]| self.on_screen([*x, *y, 0.0]);
            let places: Vec<Pos2> = measure.points_m.iter().filter_map(on_screen).collect();
            draw_measure(painter, &places, measure.is_closed, self.dark);
            if let Some(at) = measure_text_place(&places, measure.text_at) {
                draw_measure_text(painter, measure.text.clone(), at, self.dark);
            }
        }
    }

    fn text_color(&self) -> Color32 {
        if self.dark { Color32::from_gray(205) } else { Color32::from_gray(60) }
    }

    fn plate_color(&self) -> Color32 {
        ground_color(self.dark).gamma_multiply(PLATE)
    }

    /// A place of the ground on the screen.
    fn on_screen(&self, [x, y, z]: [f64; 3]) -> Option<Pos2> {
        let [px, py, _] = self.projection.project([x, y, z])?;
        let at = vec2(px as f32, py as f32) / self.points;
        (at.x.is_finite() && at.y.is_finite()).then(|| self.rect.min + at)
    }

    fn text(
        &self,
        painter: &Painter,
        at: Pos2,
        align: Align2,
        text: &str,
        size: f32,
        color: Color32,
    ) -> Rect {
        let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(size), color);
        let rect = align.anchor_size(at, galley.size());
        painter.rect_filled(rect.expand2(vec2(3.0, 1.0)), 2.0, self.plate_color());
        painter.galley(rect.min, galley, color);
        rect
    }

    /// Coordinates along the lower and the left edge.
    fn ticks_from_above(&self, painter: &Painter, scene: &Scene, taken: &mut Vec<Rect>) {
        let unit = Quantity::Length.display_unit(scene.units);
        let (step, step_m) = grid_step(self.projection, f64::from(self.points), scene.units);
        let size = self.rect.size() * self.points;
        let corner = [0.0, f64::from(size.y)];
        let far = [f64::from(size.x), 0.0];
        let (Some(low), Some(high)) =
            (self.projection.ground_at(corner), self.projection.ground_at(far))
        else {
            return;
        };
        for axis in 0..2 {
            let first = (low[axis] / step_m).ceil();
            let last = (high[axis] / step_m).floor();
            for idx in 0..=(last - first).clamp(0.0, MAX_LABELS as f64) as usize {
                let line = first + idx as f64;
                let mut at_m = low;
                at_m[axis] = line * step_m;
                let Some(at) = self.on_screen([at_m[0], at_m[1], 0.0]) else { continue };
                let label = number(line * step, step);
                let (at, align) = match axis {
                    0 => (pos2(at.x, self.rect.bottom() - 3.0), Align2::CENTER_BOTTOM),
                    _ => (pos2(self.rect.left() + EDGE, at.y), Align2::LEFT_CENTER),
                };
                let room = self.rect.shrink2(vec2(34.0, 22.0));
                let is_clear = if axis == 0 {
                    room.x_range().contains(at.x)
                } else {
                    room.y_range().contains(at.y)
                };
                if is_clear {
                    self.tick(painter, at, align, &label, taken);
                }
            }
        }
        let corner = pos2(self.rect.left() + EDGE, self.rect.bottom() - 3.0);
        self.tick(painter, corner, Align2::LEFT_BOTTOM, unit.symbol, taken);
    }

    /// Draws a text along the grid, if there is room for it.
    fn tick(&self, painter: &Painter, at: Pos2, align: Align2, label: &str, taken: &mut Vec<Rect>) {
        let color = self.text_color();
        let galley = painter.layout_no_wrap(label.to_owned(), FontId::proportional(SMALL), color);
        let place = align.anchor_size(at, galley.size());
        if taken.iter().all(|other| !other.intersects(place.expand(2.0))) {
            painter.rect_filled(place.expand2(vec2(3.0, 1.0)), 2.0, self.plate_color());
            painter.galley(place.min, galley, color);
            taken.push(place);
        }
    }

    /// Coordinates on the ground along the two edges of the scene that are nearest to the camera.
    fn ticks_on_ground(&self, painter: &Painter, scene: &Scene, taken: &mut Vec<Rect>) {
        let unit = Quantity::Length.display_unit(scene.units);
        let (step, step_m) = grid_step(self.projection, f64::from(self.points), scene.units);
        let [low, high] = scene.extent_m();
        let low = low.map(|value| (value / step_m).floor() * step_m);
        let high = high.map(|value| (value / step_m).ceil() * step_m);
        let eye = self.projection.eye_m();
        for axis in 0..2 {
            let other = 1 - axis;
            // The edge on the side of the camera.
            let is_low = eye[other] < (low[other] + high[other]) / 2.0;
            let edge = if is_low { low[other] } else { high[other] };
            let n = ((high[axis] - low[axis]) / step_m).round().clamp(0.0, MAX_LABELS as f64);
            let mut shown: Vec<(Pos2, String)> = Vec::new();
            let mut rooms: Vec<Rect> = Vec::new();
            for idx in 0..=n as usize {
                let along = low[axis] + idx as f64 * step_m;
                let mut at_m = [edge; 2];
                at_m[axis] = along;
                let Some(at) = self.on_screen([at_m[0], at_m[1], 0.0]) else { continue };
                let room = Rect::from_center_size(at + vec2(0.0, 9.0), vec2(44.0, 16.0));
                let is_free = taken.iter().chain(&rooms).all(|other| !other.intersects(room));
                if is_free && self.rect.shrink(4.0).contains_rect(room) {
                    rooms.push(room);
                    shown.push((at, number((along / step_m).round() * step, step)));
                }
            }
            // The last one names axis and unit.
            if let Some((_, last)) = shown.last_mut() {
                let letter = if axis == 0 { "X" } else { "Y" };
                *last = format!("{letter} {last} {}", unit.symbol);
            }
            for (at, label) in shown {
                self.tick(painter, at + vec2(0.0, 3.0), Align2::CENTER_TOP, &label, taken);
            }
        }
    }

    /// A bar of a round length, at the right bottom.
    fn scale_bar(&self, painter: &Painter, scene: &Scene) -> Rect {
        let unit = Quantity::Length.display_unit(scene.units);
        let per_m =
            self.projection.pixels_per_m(self.projection.target_m()) / f64::from(self.points);
        let wanted = unit.from_si(BAR_POINTS / per_m).max(1e-6);
        let power = 10.0_f64.powf(wanted.log10().floor());
        let steps = [5.0, 2.0, 1.0].map(|factor| factor * power);
        let length = steps.into_iter().find(|step| *step <= wanted).unwrap_or(power);
        let points = (unit.to_si(length) * per_m) as f32;
        let color = self.text_color();
        let text = format!("{} {}", number(length, length), unit.symbol);
        let text = match (self.projection.is_parallel(), scene.language) {
            (true, _) => text,
            (false, Language::En) => format!("{text} in the middle"),
            (false, Language::De) => format!("{text} in der Mitte"),
        };
        let galley = painter.layout_no_wrap(text, FontId::proportional(SMALL), color);
        let half = points.max(galley.size().x) / 2.0;
        let middle = self.rect.right_bottom() + vec2(-14.0 - half, -28.0);
        let plate = Rect::from_center_size(middle - vec2(0.0, 5.0), vec2(2.0 * half + 14.0, 32.0));
        painter.rect_filled(plate, 3.0, self.plate_color());
        let stroke = Stroke::new(1.6, color);
        let [left, right] = [-0.5, 0.5].map(|side| middle + vec2(side * points, 2.0));
        painter.line_segment([left, right], stroke);
        for end in [left, right] {
            painter.line_segment([end - vec2(0.0, 4.0), end + vec2(0.0, 4.0)], stroke);
        }
        let place = Align2::CENTER_BOTTOM.anchor_size(middle - vec2(0.0, 3.0), galley.size());
        painter.galley(place.min, galley, color);
        plate
    }

    /// Names of zones of friction, each within its zone: of two verges, neither has the name of the other.
    fn zones(&self, painter: &Painter, scene: &Scene, taken: &mut Vec<Rect>) {
        let areas = scene.ground.iter().flat_map(|site| &site.areas);
        for zone in areas.filter(|area| area.kind == AreaKind::FrictionZone) {
            let wanted = zone.label_m().and_then(|[x, y]| self.on_screen([x, y, 0.0]));
            let Some(wanted) = wanted else { continue };
            let (font, color) = (FontId::proportional(SMALL + 1.0), zone_color(self.dark));
            let galley = painter.layout_no_wrap(zone.name.clone(), font, color);
            if let Some(place) = self.place_in_zone(zone, wanted, galley.size(), taken) {
                self.name(painter, place, galley, color, taken);
            }
        }
    }

    /// The free place for a name that is nearest to where it is wanted and has its middle in its zone.
    fn place_in_zone(
        &self,
        zone: &GroundArea,
        wanted: Pos2,
        size: Vec2,
        taken: &[Rect],
    ) -> Option<Rect> {
        let is_free = |at: &Pos2| {
            let place = Align2::CENTER_CENTER.anchor_size(*at, size).expand(2.0);
            let pixel = (*at - self.rect.min) * self.points;
            let ground_m = self.projection.ground_at([f64::from(pixel.x), f64::from(pixel.y)]);
            self.rect.contains_rect(place)
                && taken.iter().all(|other| !other.intersects(place))
                && ground_m.is_some_and(|at_m| polygon_holds(&zone.border_m, at_m))
        };
        let along = |n: usize| (0..=n).map(move |i| i as f32 / n as f32);
        let shares = along(PLACES[0]).flat_map(|x| along(PLACES[1]).map(move |y| vec2(x, y)));
        let places = shares.map(|share| self.rect.min + share * self.rect.size());
        let free = std::iter::once(wanted).chain(places).filter(is_free);
        let nearest = free.min_by(|a, b| {
            let off = |at: &Pos2| at.distance_sq(wanted);
            off(a).total_cmp(&off(b))
        });
        nearest.map(|at| Align2::CENTER_CENTER.anchor_size(at, size))
    }

    /// The direction of grid north, below those of the axes.
    fn north(&self, painter: &Painter, scene: &Scene) -> Option<Rect> {
        let (sin, cos) = scene.ground.as_ref()?.north_rad?.sin_cos();
        let [x, y] = self.projection.target_m();
        let [middle, end] =
            [0.0, 1.0].map(|way| self.on_screen([x + way * cos, y + way * sin, 0.0]));
        let along = (end? - middle?).normalized() * NORTH_POINTS;
        let axes = axes_plate(self.rect);
        let size = Vec2::splat(NORTH_PLATE);
        let origin = axes.center_bottom() + vec2(0.0, 2.0 + size.y / 2.0);
        let plate = Rect::from_center_size(origin, size);
        painter.circle_filled(origin, plate.width() / 2.0, self.plate_color());
        let (color, side) = (self.text_color(), vec2(-along.y, along.x) * 0.45);
        let tail = origin - along * 0.75;
        let needle = vec![origin + along * 0.6, tail + side, origin - along * 0.4, tail - side];
        painter.add(egui::Shape::convex_polygon(
            vec![needle[0], needle[1], needle[2]],
            color,
            Stroke::NONE,
        ));
        painter.add(egui::Shape::closed_line(needle, Stroke::new(1.0, color)));
        let font = FontId::proportional(SMALL);
        painter.text(origin + along * 1.25, Align2::CENTER_CENTER, "N", font, color);
        Some(plate)
    }

    /// The directions of X and Y at the right top.
    fn axes(&self, painter: &Painter) -> Rect {
        let color = self.text_color();
        let plate = axes_plate(self.rect);
        let (origin, radius) = (plate.center(), plate.width() / 2.0);
        painter.circle_filled(origin, radius, self.plate_color());
        let [x, y] = self.projection.target_m();
        let Some(middle) = self.on_screen([x, y, 0.0]) else { return plate };
        // A metre at the target, whatever its size in the picture.
        for (name, [dx, dy]) in [("X", [1.0, 0.0]), ("Y", [0.0, 1.0])] {
            let Some(end) = self.on_screen([x + dx, y + dy, 0.0]) else { continue };
            let per_m = self.projection.pixels_per_m([x, y]) as f32 / self.points;
            let along: Vec2 = (end - middle) / per_m.max(1e-6) * radius * ARROW_SHARE;
            let tip = origin + along;
            let stroke = Stroke::new(1.6, color);
            painter.line_segment([origin, tip], stroke);
            if along.length() > 6.0 {
                let back = along.normalized() * 6.0;
                for side in [1.0, -1.0] {
                    let wing = tip - back + vec2(-back.y, back.x) * 0.5 * side;
                    painter.line_segment([wing, tip], stroke);
                }
            }
            let beyond = along.normalized() * 8.0;
            painter.text(
                tip + beyond,
                Align2::CENTER_CENTER,
                name,
                FontId::proportional(SMALL),
                color,
            );
        }
        plate
    }

    /// Short names beside cars, apart from each other.
    fn names(&self, painter: &Painter, scene: &Scene, time_s: f64, taken: &mut Vec<Rect>) {
        let solid_first = [CarLook::Solid, CarLook::Ghost];
        let named = solid_first.into_iter().flat_map(|look| {
            scene.cars.iter().rev().filter(move |car| car.look == look && !car.tag.is_empty())
        });
        for car in named {
            let state = car.at(time_s);
            let (pose, body) = (state.pose, &car.shape.body);
            let Some(top) = self.on_screen([pose.x_m, pose.y_m, body.height_m]) else { continue };
            let per_m = self.projection.pixels_per_m([pose.x_m, pose.y_m]) as f32 / self.points;
            let side = match self.projection.is_parallel() {
                true => {
                    let (sin, cos) = pose.yaw_rad.sin_cos();
                    let long = body.front_m.max(-body.rear_m());
                    let wide = body.width_m / 2.0;
                    (sin.abs() * long + cos.abs() * wide) as f32
                }
                false => 0.25,
            };
            let color = role_color(car.role, self.dark);
            let galley =
                painter.layout_no_wrap(car.tag.clone(), FontId::proportional(SMALL + 1.0), color);
            let mut at = top - vec2(0.0, side * per_m + 8.0);
            let mut place = Align2::CENTER_BOTTOM.anchor_size(at, galley.size());
            for _ in 0..8 {
                let Some(hit) = taken.iter().find(|other| other.intersects(place.expand(3.0)))
                else {
                    break;
                };
                at.y = hit.top() - 4.0;
                place = Align2::CENTER_BOTTOM.anchor_size(at, galley.size());
            }
            self.name(painter, place, galley, color, taken);
        }
    }

    /// Draws a name at a place, unless it would leave the picture or stand on another text.
    fn name(
        &self,
        painter: &Painter,
        place: Rect,
        galley: Arc<egui::Galley>,
        color: Color32,
        taken: &mut Vec<Rect>,
    ) {
        let is_free = taken.iter().all(|other| !other.intersects(place));
        if is_free && self.rect.contains_rect(place) {
            painter.rect_filled(place.expand2(vec2(3.0, 1.0)), 2.0, self.plate_color());
            painter.galley(place.min, galley, color);
            taken.push(place);
        }
    }

    /// Names of arrows at their tails, and of crosses.
    fn arrows(&self, painter: &Painter, scene: &Scene, taken: &mut Vec<Rect>) {
        let color = role_color(SceneRole::Evidence, self.dark);
        let arrows = scene.arrows.iter().map(|arrow| (arrow.ends_m[0], arrow.name.as_str()));
        let crosses = scene.crosses.iter().map(|cross| (cross.at_m, cross.name.as_str()));
        for ([x, y], name) in arrows.chain(crosses) {
            let Some(at) = self.on_screen([x, y, 0.0]) else { continue };
            let galley =
                painter.layout_no_wrap(name.to_owned(), FontId::proportional(SMALL), color);
            let place = Align2::CENTER_TOP.anchor_size(at + vec2(0.0, 9.0), galley.size());
            let place = below_others(place, taken);
            self.name(painter, place, galley, color, taken);
        }
    }

    /// The time at the left top, and below it one warning with the number of the others.
    fn stamp(&self, painter: &Painter, scene: &Scene, time_s: f64, taken: &mut Vec<Rect>) {
        let at = self.rect.left_top() + vec2(EDGE + 2.0, EDGE);
        let text = format!("t = {time_s:.3} s");
        let color = self.text_color();
        let place = self.text(painter, at, Align2::LEFT_TOP, &text, USUAL + 1.0, color);
        taken.push(place);
        let mut warnings = scene.caveats.iter().filter(|caveat| caveat.is_warning());
        let Some(first) = warnings.next() else { return };
        let label = match warnings.count() {
            0 => first.kind.label().to_owned(),
            n => format!("{} and {n} more", first.kind.label()),
        };
        let color = crate::theme::severity_color(Severity::Warning, self.dark);
        let at = place.left_bottom() + vec2(0.0, 4.0);
        taken.push(self.text(painter, at, Align2::LEFT_TOP, &label, SMALL, color));
    }
}

/// Where the plate below the axes is in a picture.
fn axes_plate(picture: Rect) -> Rect {
    let [least, most] = AXES_RADII;
    let radius = (AXES_SHARE * picture.height()).clamp(least, most);
    let origin = picture.right_top() + vec2(-radius - EDGE, radius + EDGE);
    Rect::from_center_size(origin, Vec2::splat(2.0 * radius))
}

/// What text and symbols cover of a picture, wherever its camera is: the axes with north, the scale bar,
/// the time with a warning.
///
/// - `is_stamped`: whether the time stands over the picture.
pub fn covered(picture: Rect, scene: &Scene, is_stamped: bool) -> Vec<Rect> {
    let has_north = scene.ground.as_ref().is_some_and(|ground| ground.north_rad.is_some());
    let mut axes = axes_plate(picture);
    axes.max.y += if has_north { NORTH_PLATE } else { 0.0 };
    let lines = 1 + usize::from(scene.caveats.iter().any(Caveat::is_warning));
    let stamp = Vec2::new(STAMP_WIDTH, EDGE + STAMP_LINE * lines as f32);
    let stamp = is_stamped.then(|| Rect::from_min_size(picture.min, stamp));
    let bar = Rect::from_min_max(picture.max - BAR_SIZE, picture.max);
    [axes, bar].into_iter().chain(stamp).collect()
}

/// A number with the decimals that its step requires.
fn number(value: f64, step: f64) -> String {
    let decimals = (-step.log10().floor()).clamp(0.0, 6.0) as usize;
    // Adding zero turns a negative zero into a positive one.
    format!("{:.decimals$}", value + 0.0)
}

/// The place of a name, moved down until it stands on none of those that are there.
fn below_others(mut place: Rect, taken: &[Rect]) -> Rect {
    for _ in 0..MAX_MOVES {
        let Some(hit) = taken.iter().find(|other| other.intersects(place.expand(2.0))) else {
            break;
        };
        place = place.translate(vec2(0.0, hit.bottom() + 4.0 - place.top()));
    }
    place
}
