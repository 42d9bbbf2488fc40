//! The panes of the window.
//!
//! Each pane has one function that draws it. A pane edits its own settings directly and requests
//! everything else with a [`Command`](crate::app::Command). Large panes are divided among several
//! files.

mod atlas_choices;
mod atlas_map;
mod cases;
mod comparison;
mod contents;
mod crush_form;
mod data;
mod doors;
mod ending;
mod evaluation;
mod evaluation_plots;
mod file_start;
mod film;
mod force;
mod hints;
mod list;
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
mod scene_camera;
mod scene_ground;
mod sensitivity;
mod sweep;
mod training;
mod training_force;
mod training_losses;
mod training_parts;
mod training_response;
mod until_rest;
mod variants;
mod vehicle;
mod vehicle_form;

pub use atlas_choices::atlas_choices_ui;
pub use atlas_map::atlas_map_ui;
pub use cases::cases_ui;
pub use comparison::comparison_ui;
pub use contents::contents_ui;
pub use data::data_ui;
pub use doors::doors_ui;
pub use evaluation::evaluation_ui;
pub(in crate::app) use file_start::start_fields;
pub(in crate::app) use film::film_ui;
pub use force::force_ui;
pub use hints::faded;
use hints::{analysis_or_hint, faded_if};
pub use list::panel;
pub use model_comparison::model_comparison_ui;
pub use models::{interrupted_ui, models_dialog_ui, models_ui};
pub use motion::motion_ui;
pub use motion_forecast::motion_forecast_ui;
pub use prediction::prediction_ui;
pub use reconstruction::{evidence_ui, reconstructed_scene_ui, speeds_ui};
pub use report::{report_pages_ui, report_ui};
pub use scenario::scenario_ui;
pub use scene::scene_ui;
pub use sensitivity::sensitivity_ui;
pub use sweep::sweep_ui;
pub use training::training_ui;
pub use variants::variants_ui;
pub(in crate::app) use vehicle::file_vehicle_ui;
pub use vehicle::vehicle_ui;
