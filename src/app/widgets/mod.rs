//! Controls, tables and lists that several panels use.

mod assumptions;
mod bad_cases;
mod caveats;
mod choice;
mod cost;
mod dataset_choice;
mod empty;
mod facts;
mod figure_frame;
mod notice;
mod number;
mod points;
mod progress;
mod quantity;
mod refusal;
mod time_figure;
mod vehicle_picker;
mod written;

pub use assumptions::{assumptions_ui, evidence_assumptions_ui, replay_assumptions_ui};
pub use bad_cases::bad_cases_ui;
pub use caveats::{caveats_ui, restrictions_ui};
pub use choice::{choice_row, salted_choice_row};
pub use cost::cost_ui;
pub use dataset_choice::{dataset_choice, no_dataset_ui};
pub use empty::empty_ui;
pub use facts::{OUTDATED_TABLE, facts_text, facts_ui, sentences_ui};
pub use figure_frame::{MIN_PLOT_HEIGHT, OUTDATED, TITLE_HEIGHT, figure_frame};
pub use notice::{notice_in_row_ui, notice_ui, severity_color, severity_icon};
pub use points::PointRows;
pub use progress::{run_progress_ui, with_time_left, working_ui};
pub use quantity::{
    EmptyField, SliderRange, count_field, duration_text, optional_count, optional_quantity,
    quantity_field, quantity_slider, quantity_value, seed_field, value_row, value_ui, within_view,
};
pub use refusal::problem_line_ui;
pub use time_figure::{BetweenCursors, time_figure};
pub use vehicle_picker::{VehiclePicker, name_in_units, vehicle_label, vehicle_name};
pub use written::{config_field, written_field};
