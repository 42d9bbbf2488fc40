//! The site in the “Scene” pane: its menu, and measuring on it.

use std::sync::Arc;

use egui::{Key, Modifiers, Painter, Pos2, Response, Ui, vec2};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::export::{SceneExport, SceneFormat};
use crate::app::ground::{ABOUT_SITES, GroundCommand, GroundSession, OPEN_SITE, REMOVE_SITE, SITE};
use crate::app::looks::{Icon, icon, icon_button};
use crate::app::measure::{Measure, Measurement, Measuring};
use crate::app::output::Output;
use crate::app::widgets::{EmptyField, optional_quantity};
use impactlab_core::data::Severity;
use impactlab_core::ranges::SITE_DISTANCE;
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::Scene;
use impactlab_draw::scene::{SceneView, draw_measure, draw_measure_text, measure_text_place};

/// Draws the menu of the site.
///
/// - `scene`: below which it lies.
pub fn ground_menu_ui(
    ui: &mut Ui,
    ground: &GroundSession,
    scene: &Scene,
    commands: &mut Vec<Command>,
) {
    let menu = ui.menu_button((icon(Icon::Map), SITE), |ui| {
        let shown = ground.shown();
        match (shown, &ground.problem) {
            (Some(loaded), _) => {
                ui.strong(&loaded.site.name);
                for part in loaded.contents(scene.units) {
                    ui.label(part);
                }
                for note in &loaded.notes {
                    ui.weak(note);
                }
                for note in loaded.far_notes(scene.extent_m(), scene.units) {
                    ui.weak(note);
                }
            }
            (None, Some(problem)) => drop(ui.label(problem)),
            (None, None) if ground.is_loading() => drop(ui.weak("loading…")),
            (None, None) => drop(ui.weak(ABOUT_SITES)),
        }
        ui.separator();
        if ui.add(icon_button(Icon::File, OPEN_SITE)).clicked() {
            commands.push(Command::Ask(Purpose::Ground));
        }
        ui.add_enabled_ui(shown.is_some(), |ui| {
            if ui.add(icon_button(Icon::Save, "Save site file…")).clicked() {
                commands.push(Command::Ask(Purpose::Save(Output::Site)));
            }
        });
        if shown.is_some_and(|loaded| loaded.site.geographic.is_some())
            && ui.add(icon_button(Icon::Map, "Save for maps (KML)…")).clicked()
        {
            let (scene, outlines_s) = (Arc::new(scene.clone()), Vec::new());
            let export = SceneExport { scene, format: SceneFormat::Kml, outlines_s };
            commands.push(Command::Ask(Purpose::Save(Output::Exchange(Box::new(export)))));
        }
        ui.add_enabled_ui(shown.is_some() || ground.problem.is_some(), |ui| {
            if ui.button(REMOVE_SITE).clicked() {
                commands.push(Command::Ground(GroundCommand::Remove));
            }
        });
    });
    menu.response.on_hover_text(ABOUT_SITES);
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
            Some(ends_m) => scale_ui(ui, measuring, ends_m, units, commands),
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
    ends_m: [[f64; 2]; 2],
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let name = ui.label("True distance");
    let empty = EmptyField { text: "not entered", start_si: 10.0 };
    optional_quantity(ui, &mut measuring.distance_m, empty, &SITE_DISTANCE, units)
        .labelled_by(name.id);
    // What is typed is taken as soon as the field is left, such as by this click.
    if ui.button("Set scale").clicked() {
        let Some(distance_m) = measuring.distance_m.take() else {
            let why = "enter the distance of the two points first".to_owned();
            return commands.push(Command::Say(Severity::Warning, why));
        };
        commands.push(Command::Ground(GroundCommand::Scale { ends_m, distance_m }));
        measuring.delete();
        measuring.measure = None;
    }
}

/// Takes clicks and keys for what is measured, and draws it over the scene.
pub fn measured_ui(
    ui: &Ui,
    response: &Response,
    view: &SceneView,
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
        let places: Vec<Pos2> =
            seen.points_m.iter().filter_map(|at| self.view.on_screen(*at)).collect();
        draw_measure(&self.painter, &places, of.measure == Measure::Area, self.dark);
        let Some(shown) = seen.in_scene(self.units) else { return };
        let at = match next.and(pointer) {
            Some(pointer) => Some(pointer + vec2(14.0, 12.0)),
            None => measure_text_place(&places, shown.text_at),
        };
        if let Some(at) = at {
            draw_measure_text(&self.painter, shown.text, at, self.dark);
        }
    }
}
