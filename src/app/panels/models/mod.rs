//! The “Models” pane: the models in use, the work under way, the trainings that can go on, and what
//! has been finished.

mod dialog;
mod finished;
mod in_use;
mod running;
mod unfinished;

pub use dialog::models_dialog_ui;
pub use unfinished::interrupted_ui;

use egui::{RichText, ScrollArea, Ui};

use crate::app::looks;
use crate::app::panes::PaneContext;

/// Space between two parts of the pane, points.
const BETWEEN_PARTS: f32 = 3.0 * looks::GRID;

/// Draws the four parts of the pane.
pub fn models_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        heading_ui(ui, "In use");
        in_use::in_use_ui(ui, pane);
        heading_ui(ui, "Running");
        running::running_ui(ui, pane);
        if unfinished::has_something(pane.session) {
            heading_ui(ui, "Can be resumed");
            unfinished::unfinished_ui(ui, pane.session, pane.commands);
        }
        heading_ui(ui, "Finished");
        finished::finished_ui(ui, pane);
    });
}

fn heading_ui(ui: &mut Ui, title: &str) {
    ui.add_space(BETWEEN_PARTS);
    ui.label(RichText::new(title).heading());
    ui.separator();
}
