//! The form that asks how a film of the scene is to be made.

use egui::{Grid, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::film::FilmForm;
use crate::app::output::Output;
use crate::app::widgets::{count_field, notice_ui, quantity_field, quantity_value};
use impactlab_core::data::Severity;
use impactlab_core::error_chain;
use impactlab_core::ranges::{FILM_RATE, FILM_SIDE, FILM_SPEED, INSTANT};
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::FilmTiming;
use impactlab_draw::Canvas;
use impactlab_draw::film::Film;

/// Sizes that are offered, pixels.
const SIZES: [[u32; 2]; 3] = [[1280, 720], [1920, 1080], [3840, 2160]];

/// Draws the form, and adds a command when the user has answered.
///
/// - `is_busy`: whether another film is being made.
pub fn film_ui(ui: &mut Ui, form: &mut FilmForm, is_busy: bool, commands: &mut Vec<Command>) {
    ui.heading("Save a film");
    let film = &mut form.film;
    let view = film.picture.camera.kind.phrase();
    let camera = if film.keys.is_empty() { ", as it is seen now" } else { "" };
    ui.weak(format!("{}, {view}{camera}", film.picture.scene.title));
    Grid::new("film").num_columns(2).show(ui, |ui| {
        size_row(ui, film);
        timing_rows(ui, film);
    });
    film.canvas.scale = Canvas::scene_scale(film.canvas.size_px);
    sections_ui(ui, form);
    keys_ui(ui, form);
    ui.separator();
    let is_possible = summary_ui(ui, &form.film);
    ui.horizontal(|ui| {
        let save = egui::Button::new("Save film…");
        let hint =
            if is_busy { "Another film is being made" } else { "The film cannot be made so" };
        let save = ui.add_enabled(is_possible && !is_busy, save).on_disabled_hover_text(hint);
        if save.clicked() {
            commands.push(Command::Ask(Purpose::Save(Output::Film(Box::new(form.film.clone())))));
        }
        if ui.button("Cancel").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}

fn size_row(ui: &mut Ui, film: &mut Film) {
    ui.label("Size [pixels]");
    ui.horizontal(|ui| {
        let size = &mut film.canvas.size_px;
        for (side, name) in size.iter_mut().zip(["Width", "Height"]) {
            let name = ui.label(name);
            count_field(ui, side, &FILM_SIDE, 2.0).labelled_by(name.id);
        }
        for offered in SIZES {
            let [width, height] = offered;
            ui.selectable_value(size, offered, format!("{width} × {height}"));
        }
    });
    ui.end_row();
}

fn timing_rows(ui: &mut Ui, film: &mut Film) {
    let FilmTiming { from_s, to_s, .. } = FilmTiming::from_scene(&film.picture.scene);
    let instants = INSTANT.within([from_s, to_s]);
    let timing = &mut film.timing;
    let name = ui.label("Frames per second");
    count_field(ui, &mut timing.frames_per_s, &FILM_RATE, 0.2).labelled_by(name.id);
    ui.end_row();
    quantity_field(ui, "From", &mut timing.from_s, &instants, UnitSystem::Si);
    quantity_field(ui, "To", &mut timing.to_s, &instants, UnitSystem::Si);
    quantity_field(ui, "Speed ×", &mut timing.speed, &FILM_SPEED, UnitSystem::Si);
}

/// Draws the parts with a speed of their own.
fn sections_ui(ui: &mut Ui, form: &mut FilmForm) {
    let mut removed = None;
    Grid::new("slow motion").num_columns(4).show(ui, |ui| {
        for (idx, section) in form.film.timing.sections.iter_mut().enumerate() {
            let fields = [
                (format!("Part {} from", idx + 1), &mut section.from_s, &INSTANT),
                ("to".to_owned(), &mut section.to_s, &INSTANT),
                ("speed ×".to_owned(), &mut section.speed, &FILM_SPEED),
            ];
            for (label, value, range) in fields {
                ui.horizontal(|ui| {
                    let name = ui.label(label);
                    let (field, _) = quantity_value(ui, value, range, UnitSystem::Si);
                    field.labelled_by(name.id);
                });
            }
            if ui.small_button(format!("Remove part {}", idx + 1)).clicked() {
                removed = Some(idx);
            }
            ui.end_row();
        }
    });
    if let Some(idx) = removed {
        form.film.timing.sections.remove(idx);
    }
    let hint = "A part of the motion at a speed of its own; the time stamp says it";
    if ui.button("Add slow motion").on_hover_text(hint).clicked() {
        form.add_section();
    }
}

/// Draws the choice whether the camera moves between its keys, if it has any.
fn keys_ui(ui: &mut Ui, form: &mut FilmForm) {
    if form.keys().is_empty() {
        return;
    }
    let mut moves = !form.film.keys.is_empty();
    if ui.checkbox(&mut moves, "Move the camera from key to key").changed() {
        form.move_camera(moves);
    }
    for (idx, key) in form.keys().iter().enumerate() {
        ui.weak(format!("Key {} of the camera at {:.3} s", idx + 1, key.time_s));
    }
}

/// Says how long the film will be, or why it cannot be made; returns whether it can.
fn summary_ui(ui: &mut Ui, film: &Film) -> bool {
    match film.instants() {
        Ok(instants) => {
            let duration_s = instants.len() as f64 / f64::from(film.timing.frames_per_s);
            ui.label(format!("{} frames, {duration_s:.1} s", instants.len()));
            true
        }
        Err(error) => {
            notice_ui(ui, Severity::Error, error_chain(&error));
            false
        }
    }
}
