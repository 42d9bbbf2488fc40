//! The names of what a scene shows.

use egui::{Color32, Painter, Rect, Sense, Stroke, Ui, Vec2, pos2};

use crate::scene::marks::ASPHALT;
use crate::scene::shade::{ground_line_color, mark_color, role_color, zone_color};
use impactlab_document::scene::{AreaKind, CarLook, GroundLineKind, Scene, SceneRole};

/// Draws the names of what the scene shows, each with its colour.
pub fn legend_ui(ui: &mut Ui, scene: &Scene) {
    let dark = ui.visuals().dark_mode;
    let font = egui::TextStyle::Small.resolve(ui.style());
    let (text_color, sample) = (ui.visuals().text_color(), Vec2::new(2.0 * font.size, font.size));
    ui.horizontal_wrapped(|ui| {
        for (name, color, kind) in entries(scene, dark) {
            // A name that is wider than the pane is broken.
            let widest = (ui.max_rect().width() - sample.x - 5.0).max(4.0 * font.size);
            let galley = ui.painter().layout(name.to_owned(), font.clone(), text_color, widest);
            let size = Vec2::new(sample.x + 5.0 + galley.size().x, galley.size().y.max(sample.y));
            let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, name));
            let place = egui::Align2::LEFT_CENTER.anchor_size(rect.left_center(), sample);
            draw_sample(ui.painter(), place, color, kind);
            let at = rect.right_center() - Vec2::new(galley.size().x, galley.size().y / 2.0);
            ui.painter().galley(at, galley, text_color);
        }
    });
}

/// Draws the sample beside a name.
fn draw_sample(painter: &Painter, rect: Rect, color: Color32, kind: Entry) {
    let (from, to, stroke) = (rect.left_center(), rect.right_center(), Stroke::new(2.0, color));
    let inside = rect.shrink2(Vec2::new(1.0, 2.0));
    match kind {
        Entry::Solid => drop(painter.rect_filled(inside, 2.0, color)),
        Entry::Ghost => drop(painter.rect_filled(inside, 2.0, color.gamma_multiply(0.4))),
        Entry::Line => drop(painter.line_segment([from, to], stroke)),
        Entry::OnAsphalt => {
            painter.rect_filled(inside, 2.0, ASPHALT);
            painter.line_segment([from, to], Stroke::new(3.0, color));
        }
        Entry::Dashed => {
            painter.extend(egui::Shape::dashed_line(&[from, to], stroke, 5.0, 3.0));
        }
        Entry::Hatched => {
            painter.rect_filled(inside, 0.0, color.gamma_multiply(0.25));
            let painter = painter.with_clip_rect(inside.intersect(painter.clip_rect()));
            for i in 0..6 {
                let x = inside.left() - inside.height() + 6.0 * i as f32;
                let low = pos2(x, inside.bottom());
                let high = low + Vec2::new(inside.height(), -inside.height());
                painter.line_segment([low, high], Stroke::new(1.2, color));
            }
            painter.rect_stroke(inside, 0.0, Stroke::new(1.0, color), egui::StrokeKind::Inside);
        }
        Entry::Point => drop(painter.circle_filled(rect.center(), 3.0, color)),
        Entry::Cross => {
            for slope in [1.0, -1.0] {
                let arm = Vec2::new(4.0, 4.0 * slope);
                painter.line_segment([rect.center() - arm, rect.center() + arm], stroke);
            }
        }
    }
}

/// How a name is shown in the legend.
#[derive(Clone, Copy)]
enum Entry {
    Solid,
    Ghost,
    Hatched,
    Line,
    /// A line on the picture of a road, whose colour does not depend on the theme.
    OnAsphalt,
    Dashed,
    Point,
    Cross,
}

/// Names of a scene, each once: cars, then lines and points, then what is not a role, then the ground.
fn entries(scene: &Scene, dark: bool) -> Vec<(&str, Color32, Entry)> {
    let mut entries: Vec<(&str, Color32, Entry)> = Vec::new();
    let cars = scene.cars.iter().rev().map(|car| {
        let kind = if car.look == CarLook::Solid { Entry::Solid } else { Entry::Ghost };
        (car.name.as_str(), car.role, kind)
    });
    let lined = |is_dashed| if is_dashed { Entry::Dashed } else { Entry::Line };
    let paths =
        scene.paths.iter().map(|path| (path.name.as_str(), path.role, lined(path.is_dashed)));
    let lines =
        scene.lines.iter().map(|line| (line.name.as_str(), line.role, lined(line.is_dashed)));
    let marks =
        scene.marks.iter().map(|mark| (mark.name.as_str(), SceneRole::TireMark, Entry::Solid));
    let crushes =
        scene.crushes.iter().map(|crush| (crush.name.as_str(), SceneRole::Crush, Entry::Line));
    let points = scene.points.iter().map(|point| (point.name.as_str(), point.role, Entry::Point));
    let arrows = scene.arrows.iter().map(|arrow| ("impulse", arrow.role, Entry::Line));
    let forces = scene.forces.iter().map(|force| (force.name.as_str(), force.role, Entry::Line));
    let crosses =
        scene.crosses.iter().map(|cross| (cross.name.as_str(), SceneRole::Evidence, Entry::Cross));
    let density = scene
        .density
        .iter()
        .map(|density| (density.name.as_str(), SceneRole::Forecast, Entry::Ghost));
    let all = cars
        .chain(paths)
        .chain(marks)
        .chain(crushes)
        .chain(lines)
        .chain(points)
        .chain(arrows)
        .chain(forces)
        .chain(crosses)
        .chain(density);
    let on_picture = scene.ground.as_ref().is_some_and(|site| site.has_picture());
    let all = all.map(|(name, role, kind)| match (role, on_picture) {
        (SceneRole::TireMark, true) => (name, mark_color(false), Entry::OnAsphalt),
        _ => (name, role_color(role, dark), kind),
    });
    for entry in all.chain(ground_entries(scene, dark)).filter(|entry| !entry.0.is_empty()) {
        if entries.iter().all(|other| other.0 != entry.0) {
            entries.push(entry);
        }
    }
    entries
}

/// Names of what is on the ground.
fn ground_entries(scene: &Scene, dark: bool) -> impl Iterator<Item = (&str, Color32, Entry)> {
    let site = scene.ground.iter();
    let areas = site.clone().flat_map(|site| &site.areas);
    let zones = areas.filter(|area| area.kind == AreaKind::FrictionZone);
    let zones = zones.map(move |zone| (zone.name.as_str(), zone_color(dark), Entry::Hatched));
    let lines = site.flat_map(|site| &site.lines).map(move |line| {
        let name = match line.kind {
            GroundLineKind::Drawing => "drawing",
            GroundLineKind::Kerb => "kerb",
            GroundLineKind::Marking => "",
        };
        (name, ground_line_color(line.kind, dark), Entry::Line)
    });
    zones.chain(lines)
}
