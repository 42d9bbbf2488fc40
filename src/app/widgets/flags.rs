//! What a simulated motion warns of.

use egui::Ui;

use crate::data::Severity;
use crate::render::theme;
use crate::study::FlagReport;

/// Draws each flag as a line in the colour of a warning.
pub fn flags_ui<'a>(ui: &mut Ui, flags: impl IntoIterator<Item = &'a FlagReport>) {
    let color = theme::severity_color(Severity::Warning, ui.visuals().dark_mode);
    for flag in flags {
        ui.colored_label(color, &flag.message);
    }
}
