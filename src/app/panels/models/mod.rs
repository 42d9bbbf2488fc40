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

use crate::app::kept::Fact;
use crate::app::looks;
use crate::app::panes::PaneContext;
use crate::app::widgets::value_row;

/// Characters of a value that are shown without hovering over it.
const MAX_CHARS: usize = 40;
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

/// The beginning of a text that is too long for a column, with “…”.
fn shortened(text: &str) -> String {
    match text.char_indices().nth(MAX_CHARS) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

/// Draws figures or settings in a two-column grid.
fn facts_ui(ui: &mut Ui, id: impl egui::AsIdSalt, facts: &[Fact]) {
    egui::Grid::new(id).num_columns(2).show(ui, |ui| {
        for fact in facts {
            let shown = shortened(&fact.text);
            if shown == fact.text {
                value_row(ui, &fact.label, &fact.text);
            } else {
                ui.label(&fact.label);
                ui.monospace(shown).on_hover_text(&fact.text);
                ui.end_row();
            }
        }
    });
}
