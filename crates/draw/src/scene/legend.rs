//! The names of what a scene shows.

use std::sync::Arc;

use egui::{Color32, FontId, Galley, Painter, Pos2, Rect, Sense, Stroke, Ui, Vec2, pos2, vec2};

use crate::scene::marks::ASPHALT;
use crate::scene::shade::{ground_line_color, mark_color, role_color, zone_color};
use impactlab_core::units::Language;
use impactlab_document::figure::Dashes;
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

/// Size of the names in the rows below a frame, height of a row, room between names, points.
const ROW_FONT: f32 = 9.5;
const ROW_HEIGHT: f32 = 13.0;
const BETWEEN: f32 = 10.0;
/// Size of a sample there, and room behind it, points.
const SAMPLE: Vec2 = vec2(16.0, 9.0);
const BEHIND_SAMPLE: f32 = 4.0;

/// The names of what a scene shows in rows of a frame, which have the same place at every time.
pub(crate) struct LegendRows {
    rows: Vec<Vec<LegendName>>,
    /// What is said of the names for which there is no room.
    more: Option<Arc<Galley>>,
}

struct LegendName {
    sample: (Color32, Entry),
    name: Arc<Galley>,
}

impl LegendRows {
    /// The names of a scene in rows.
    ///
    /// - `width`: of a row, points;
    /// - `most`: how many rows there may be; names beyond them are counted.
    pub(crate) fn new(ui: &Ui, scene: &Scene, width: f32, most: usize) -> Self {
        let (dark, color) = (ui.visuals().dark_mode, ui.visuals().text_color());
        let galley = |text: String, widest: f32| {
            let font = FontId::proportional(ROW_FONT);
            let mut job = egui::text::LayoutJob::simple_singleline(text, font, color);
            job.wrap = egui::text::TextWrapping::truncate_at_width(widest);
            ui.painter().layout_job(job)
        };
        let names: Vec<LegendName> = entries(scene, dark)
            .into_iter()
            .map(|(name, color, kind)| {
                let name = galley(name.to_owned(), width - SAMPLE.x - BEHIND_SAMPLE);
                LegendName { sample: (color, kind), name }
            })
            .collect();
        let widths: Vec<f32> = names.iter().map(LegendName::width).collect();
        let count = |n: usize| match scene.language {
            Language::En => galley(format!("and {n} more"), width),
            Language::De => galley(format!("und {n} weitere"), width),
        };
        let more_width = count(names.len()).size().x + BETWEEN;
        let n_in_rows = in_rows(&widths, width, (most, more_width));
        let mut names = names.into_iter();
        let rows = n_in_rows.iter().map(|n| names.by_ref().take(*n).collect()).collect();
        let n_more = names.len();
        Self { rows, more: (n_more > 0).then(|| count(n_more)) }
    }

    /// Height of all rows, points.
    pub(crate) fn height(&self) -> f32 {
        ROW_HEIGHT * self.rows.len() as f32
    }

    /// Draws the rows below a place.
    pub(crate) fn draw(&self, painter: &Painter, at: Pos2) {
        let color = painter.ctx().global_style().visuals.text_color();
        let mut end = at + vec2(0.0, ROW_HEIGHT / 2.0);
        for (idx, row) in self.rows.iter().enumerate() {
            end = at + vec2(0.0, ROW_HEIGHT * (idx as f32 + 0.5));
            for LegendName { sample: (tint, kind), name } in row {
                let place = egui::Align2::LEFT_CENTER.anchor_size(end, SAMPLE);
                draw_sample(painter, place, *tint, *kind);
                let left = end + vec2(SAMPLE.x + BEHIND_SAMPLE, -name.size().y / 2.0);
                painter.galley(left, Arc::clone(name), color);
                end.x += SAMPLE.x + BEHIND_SAMPLE + name.size().x + BETWEEN;
            }
        }
        if let Some(more) = &self.more {
            painter.galley(end - vec2(0.0, more.size().y / 2.0), Arc::clone(more), color);
        }
    }
}

impl LegendName {
    fn width(&self) -> f32 {
        SAMPLE.x + BEHIND_SAMPLE + self.name.size().x
    }
}

/// How many of the names go into each row, from the first one on.
///
/// - `widths`: of the names, `width`: of a row, points;
/// - `most`: how many rows there may be, and the room that is kept at the end of the last one where not
///   all names have a place, points.
fn in_rows(widths: &[f32], width: f32, (most, more): (usize, f32)) -> Vec<usize> {
    let filled = |last: f32| {
        let (mut rows, mut used) = (Vec::new(), f32::INFINITY);
        for of_name in widths {
            let room = if rows.len() == most { last } else { width };
            if used + of_name <= room {
                if let Some(n) = rows.last_mut() {
                    *n += 1;
                }
                used += of_name + BETWEEN;
            } else if rows.len() < most {
                rows.push(1);
                used = of_name + BETWEEN;
            } else {
                break;
            }
        }
        rows
    };
    let all = filled(width);
    match all.iter().sum::<usize>() == widths.len() {
        true => all,
        false => filled(width - more),
    }
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
        Entry::Dashed(dashes) => {
            for ends in dashes.sample {
                let ends = ends.map(|share| rect.center() + vec2(share * rect.width(), 0.0));
                painter.line_segment(ends, stroke);
            }
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
    Dashed(Dashes),
    Point,
    Cross,
}

/// Names of a scene, each once: cars, then lines and points, then what is not a role, then the ground.
fn entries(scene: &Scene, dark: bool) -> Vec<(&str, Color32, Entry)> {
    let mut entries: Vec<(&str, Color32, Entry)> = Vec::new();
    let cars = scene.cars.iter().rev().map(|car| {
        let kind = match (car.role, car.look) {
            // Its colour may come again: its dashes are those of its path.
            (SceneRole::Variant(_), _) => Entry::Dashed(car.role.dashes()),
            (_, CarLook::Solid) => Entry::Solid,
            (_, CarLook::Ghost) => Entry::Ghost,
        };
        (car.name.as_str(), car.role, kind)
    });
    let lined = |role: SceneRole, is_dashed: bool| match is_dashed {
        true => Entry::Dashed(role.dashes()),
        false => Entry::Line,
    };
    let paths = scene
        .paths
        .iter()
        .map(|path| (path.name.as_str(), path.role, lined(path.role, path.is_dashed)));
    let lines = scene
        .lines
        .iter()
        .map(|line| (line.name.as_str(), line.role, lined(line.role, line.is_dashed)));
    let marks =
        scene.marks.iter().map(|mark| (mark.name.as_str(), SceneRole::TireMark, Entry::Solid));
    let crushes =
        scene.crushes.iter().map(|crush| (crush.name.as_str(), SceneRole::Crush, Entry::Line));
    let points = scene.points.iter().map(|point| (point.name.as_str(), point.role, Entry::Point));
    let impulse = match scene.language {
        Language::En => "impulse",
        Language::De => "Impuls",
    };
    let arrows = scene.arrows.iter().map(|arrow| (impulse, arrow.role, Entry::Line));
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
            GroundLineKind::Surveyed => "surveyed",
            GroundLineKind::Marking => "",
        };
        (name, ground_line_color(line.kind, dark), Entry::Line)
    });
    zones.chain(lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_fill_rows_and_what_is_left_keeps_room_for_its_number() {
        for (widths, expected) in [
            (&[][..], &[][..]),
            (&[40.0, 40.0, 40.0], &[2, 1]),
            (&[40.0, 40.0, 40.0, 40.0], &[2, 2]),
            // The fifth name has no place, so that the fourth gives way to the number.
            (&[40.0, 40.0, 40.0, 40.0, 40.0], &[2, 1]),
            // A name that is as wide as a row has one of its own.
            (&[100.0, 100.0], &[1, 1]),
        ] {
            assert_eq!(in_rows(widths, 100.0, (2, 30.0)), expected, "{widths:?}");
        }
    }
}
