//! The ground in the “Scene” pane: its menu, and measuring on it.

use egui::{
    Align2, Color32, DragValue, FontId, Key, Modifiers, Painter, Pos2, Rect, Response, Stroke, Ui,
    vec2,
};

use crate::app::command::Command;
use crate::app::dialogs::Purpose;
use crate::app::ground::{GroundCommand, GroundSession};
use crate::app::looks::{Icon, icon, icon_button};
use crate::app::measure::{Measure, Measurement, Measuring};
use crate::render::scene::SceneView;
use crate::units::{Quantity, UnitSystem};

/// Size of the values beside what is measured, points.
const TEXT_POINTS: f32 = 12.0;

/// Draws the menu of the ground.
pub fn ground_menu_ui(ui: &mut Ui, ground: &GroundSession, commands: &mut Vec<Command>) {
    let menu = ui.menu_button((icon(Icon::Map), "Ground"), |ui| {
        let shown = ground.shown();
        match (shown, &ground.problem) {
            (Some(loaded), _) => {
                ui.strong(&loaded.site.name);
                for part in loaded.site.contents() {
                    ui.label(part);
                }
                for note in &loaded.notes {
                    ui.weak(note);
                }
            }
            (None, Some(problem)) => drop(ui.label(problem)),
            (None, None) if ground.is_loading() => drop(ui.weak("loading…")),
            (None, None) => {
                drop(ui.weak("A site file (TOML) or an orthophoto; drop it here as well"))
            }
        }
        ui.separator();
        if ui.add(icon_button(Icon::File, "Open ground…")).clicked() {
            commands.push(Command::Ask(Purpose::Ground));
        }
        ui.add_enabled_ui(shown.is_some(), |ui| {
            if ui.add(icon_button(Icon::Save, "Save site file…")).clicked() {
                commands.push(Command::Ask(Purpose::Site));
            }
        });
        ui.add_enabled_ui(shown.is_some() || ground.problem.is_some(), |ui| {
            if ui.button("Remove ground").clicked() {
                commands.push(Command::Ground(GroundCommand::Remove));
            }
        });
    });
    menu.response.on_hover_text("Orthophoto, lanes, drawing and zones of friction below the scene");
}

/// Draws the menu of what is measured.
pub fn measure_menu_ui(ui: &mut Ui, measuring: &mut Measuring, has_photo: bool) {
    let menu = ui.menu_button((icon(Icon::Ruler), "Measure"), |ui| {
        for measure in Measure::ALL {
            let is_possible = measure != Measure::Scale || has_photo;
            let is_chosen = measuring.measure == Some(measure);
            let label = egui::Button::selectable(is_chosen, measure.label());
            let label = ui.add_enabled(is_possible, label).on_hover_text(measure.hint());
            if label.clicked() {
                measuring.choose((!is_chosen).then_some(measure));
            }
        }
        ui.separator();
        ui.add_enabled_ui(!measuring.done.is_empty(), |ui| {
            if ui.button("Clear").on_hover_text("Remove everything that was measured").clicked() {
                measuring.done.clear();
            }
        });
    });
    menu.response.on_hover_text("Lengths, angles and areas on the ground");
}

/// Draws what the user does next while something is measured, and the distance by which an orthophoto is
/// scaled.
pub fn measure_bar_ui(
    ui: &mut Ui,
    measuring: &mut Measuring,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let Some(measure) = measuring.measure else { return };
    ui.horizontal_wrapped(|ui| {
        ui.strong(measure.label());
        match measuring.scale_ends_m() {
            Some(ends_m) => scale_ui(ui, measuring, (ends_m, units), commands),
            None => drop(ui.weak(measure.hint())),
        }
        if ui.button("Done").on_hover_text("Stop measuring; what was measured stays").clicked() {
            measuring.choose(None);
        }
    });
}

/// Draws the field of the distance of two points of the orthophoto.
fn scale_ui(
    ui: &mut Ui,
    measuring: &mut Measuring,
    (ends_m, units): ([[f64; 2]; 2], UnitSystem),
    commands: &mut Vec<Command>,
) {
    let unit = Quantity::Length.display_unit(units);
    let name = ui.label(format!("True distance [{}]", unit.symbol));
    let field = DragValue::new(&mut measuring.typed_distance).speed(0.1).range(0.0..=1e6);
    ui.add(field.max_decimals(3)).labelled_by(name.id);
    let is_typed = measuring.typed_distance > 0.0;
    if ui.add_enabled(is_typed, egui::Button::new("Set scale")).clicked() {
        let distance_m = unit.to_si(measuring.typed_distance);
        commands.push(Command::Ground(GroundCommand::Scale { ends_m, distance_m }));
        measuring.delete();
        measuring.measure = None;
    }
}

/// Takes clicks and keys for what is measured, and draws it over the scene.
pub fn measured_ui(
    ui: &Ui,
    (response, view): (&Response, &SceneView),
    measuring: &mut Measuring,
    units: UnitSystem,
) {
    if measuring.measure.is_some() {
        if let Some(at) = response.interact_pointer_pos().filter(|_| response.clicked())
            && let Some(at_m) = view.ground_at(at)
        {
            measuring.click(at_m);
        }
        if response.hovered() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::Crosshair);
        }
    }
    let has_any = measuring.measure.is_some() || !measuring.done.is_empty();
    if has_any && !ui.ctx().text_edit_focused() {
        let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        if measuring.measure.is_some() && pressed(Key::Escape) {
            measuring.end();
        }
        if pressed(Key::Delete) {
            measuring.delete();
        }
    }
    let painter = ui.painter().with_clip_rect(response.rect);
    let drawn = Drawn { painter, view, units, dark: ui.visuals().dark_mode };
    measuring.done.iter().for_each(|of| drawn.draw(of, None));
    if let Some(begun) = &measuring.begun {
        drawn.draw(begun, response.hover_pos());
    }
}

/// Draws measurements over the scene.
struct Drawn<'a> {
    painter: Painter,
    view: &'a SceneView,
    units: UnitSystem,
    dark: bool,
}

impl Drawn<'_> {
    /// - `pointer`: where the next point would be.
    fn draw(&self, of: &Measurement, pointer: Option<Pos2>) {
        let mut seen = of.clone();
        let is_open = of.measure != Measure::Scale || of.points_m.len() < 2;
        let next = pointer.filter(|_| is_open).and_then(|at| self.view.ground_at(at));
        seen.points_m.extend(next);
        let (line, edge) = match self.dark {
            true => (Color32::WHITE, Color32::from_black_alpha(170)),
            false => (Color32::from_rgb(20, 22, 24), Color32::from_white_alpha(190)),
        };
        let places: Vec<Pos2> =
            seen.points_m.iter().filter_map(|at| self.view.on_screen(*at)).collect();
        let mut path = places.clone();
        if of.measure == Measure::Area && places.len() > 2 {
            path.extend(places.first().copied());
        }
        for (width, color) in [(4.0, edge), (1.6, line)] {
            self.painter.line(path.clone(), Stroke::new(width, color));
        }
        for place in &places {
            self.painter.circle_filled(*place, 3.5, edge);
            self.painter.circle_filled(*place, 2.2, line);
        }
        let Some(text) = seen.text(self.units) else { return };
        let at = match (next.and(pointer), of.measure) {
            (Some(pointer), _) => Some(pointer + vec2(14.0, 12.0)),
            (None, Measure::Angle) => places.get(1).map(|at| *at + vec2(10.0, 8.0)),
            (None, Measure::Area) => middle(&places),
            (None, _) => places.last().map(|at| *at + vec2(10.0, 8.0)),
        };
        let Some(at) = at else { return };
        let galley = self.painter.layout_no_wrap(text, FontId::proportional(TEXT_POINTS), line);
        let place = Align2::LEFT_TOP.anchor_size(at, galley.size());
        let place = within(place, self.painter.clip_rect().shrink(4.0));
        self.painter.rect_filled(place.expand2(vec2(4.0, 2.0)), 2.0, edge);
        self.painter.galley(place.min, galley, line);
    }
}

fn middle(places: &[Pos2]) -> Option<Pos2> {
    let sum = places.iter().fold(egui::Vec2::ZERO, |sum, at| sum + at.to_vec2());
    (!places.is_empty()).then(|| (sum / places.len() as f32).to_pos2())
}

/// A rectangle moved so that it lies within another, as far as it fits.
fn within(rect: Rect, outer: Rect) -> Rect {
    let over = (rect.max - outer.max).max(egui::Vec2::ZERO);
    let rect = rect.translate(-over);
    rect.translate((outer.min - rect.min).max(egui::Vec2::ZERO))
}
