//! The panes of the window.
//!
//! Each pane has one function that draws it. A pane edits its own settings directly and requests
//! everything else with a [`Command`](crate::app::Command). Large panes are divided among several
//! files.

mod cases;
mod comparison;
mod contents;
mod data;
mod doors;
mod ending;
mod evaluation;
mod evaluation_plots;
mod evaluation_tables;
mod file_start;
mod film;
mod force;
mod model_comparison;
mod model_comparison_plots;
mod model_row;
mod models;
mod motion;
mod motion_forecast;
mod prediction;
mod prediction_form;
mod reconstruction;
mod report;
mod scenario;
mod scenario_plan;
mod scene;
mod scene_ground;
mod training;
mod training_force;
mod training_losses;
mod training_parts;
mod training_response;
mod variants;
mod vehicle;
mod vehicle_form;

pub use cases::cases_ui;
pub use comparison::comparison_ui;
pub use contents::contents_ui;
pub use data::data_ui;
pub use doors::doors_ui;
pub use evaluation::evaluation_ui;
pub(in crate::app) use file_start::start_fields;
pub(in crate::app) use film::film_ui;
pub use force::force_ui;
pub use model_comparison::model_comparison_ui;
pub use models::{interrupted_ui, models_dialog_ui, models_ui};
pub use motion::motion_ui;
pub use motion_forecast::motion_forecast_ui;
pub use prediction::prediction_ui;
pub use reconstruction::{evidence_ui, reconstructed_scene_ui, speeds_ui};
pub use report::{report_pages_ui, report_ui};
pub use scenario::scenario_ui;
pub use scene::scene_ui;
pub use training::training_ui;
pub use variants::variants_ui;
pub(in crate::app) use vehicle::file_vehicle_ui;
pub use vehicle::vehicle_ui;

use egui::{RichText, Ui};

use crate::app::state::Session;
use impactlab_draw::theme;
use impactlab_study::SimulateAnswer;

/// Share of its colour that an answer keeps which is not of what is asked any more.
const FADED: f32 = 0.35;

/// Draws an answer, greyed if it is not of what is asked any more.
fn faded_if<R>(ui: &mut Ui, is_late: bool, draw: impl FnOnce(&mut Ui) -> R) -> R {
    let drawn = ui.scope(|ui| {
        if is_late {
            ui.multiply_opacity(FADED);
        }
        draw(ui)
    });
    drawn.inner
}

/// Draws an answer, greyed and marked as being computed if it is not of what is asked any more.
pub fn faded<R>(ui: &mut Ui, is_late: bool, draw: impl FnOnce(&mut Ui) -> R) -> R {
    let area = ui.available_rect_before_wrap();
    let drawn = faded_if(ui, is_late, draw);
    if is_late {
        let corner = area.right_top() + egui::vec2(-6.0, 4.0);
        let font = egui::TextStyle::Body.resolve(ui.style());
        let color = ui.visuals().strong_text_color();
        let text = ui.painter().layout_no_wrap("computing…".to_owned(), font, color);
        let place = egui::Align2::RIGHT_TOP.anchor_size(corner, text.size());
        ui.painter().rect_filled(place.expand(4.0), 3.0, ui.visuals().extreme_bg_color);
        ui.painter().galley(place.min, text, color);
    }
    drawn
}

/// Returns the simulation of the selected subject. If there is none, it draws the reason (an error,
/// a simulation that is still running, or no selection) and returns `None`.
fn analysis_or_hint<'a>(ui: &mut Ui, session: &'a Session) -> Option<&'a SimulateAnswer> {
    match &session.analysis.answer {
        Some(Ok(answer)) => return Some(answer),
        Some(Err(error)) => {
            let dark = ui.visuals().dark_mode;
            let color = theme::severity_color(impactlab_core::data::Severity::Error, dark);
            ui.colored_label(color, format!("Not computed: {error}"));
        }
        None if session.analysis.is_waiting()
            || session.sources.iter().any(|s| !s.is_settled()) =>
        {
            ui.horizontal(|ui| (ui.spinner(), ui.label("Working…")));
        }
        None => {
            ui.label(RichText::new("Nothing selected").strong());
            ui.label("Open a data set (File, or drop a folder here) and pick a case, or set up a scenario.");
        }
    }
    None
}
