//! What the parts of the Models pane have in common.

use egui::Ui;

use crate::app::archive::Fact;
use crate::app::widgets::value_row;

/// Characters of a value that are shown without hovering over it.
const MAX_CHARS: usize = 40;

/// The beginning of a text that is too long for a column, with “…”.
pub(super) fn shortened(text: &str) -> String {
    match text.char_indices().nth(MAX_CHARS) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

/// Draws figures or settings in a two-column grid.
pub(super) fn facts_ui(ui: &mut Ui, id: impl egui::AsIdSalt, facts: &[Fact]) {
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
