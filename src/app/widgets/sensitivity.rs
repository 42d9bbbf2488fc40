//! A table of what an answer depends on most, among the estimates of a vehicle.

use egui::{Grid, Ui};

use impactlab_study::analysis::Sensitivity;

/// Draws the shares of the estimates in the variance of the end, as far as they are more than chance,
/// the largest first. Nothing if no vehicles were drawn.
///
/// - `id`: distinguishes the tables of a pane.
pub fn sensitivity_ui(ui: &mut Ui, id: &str, shares: &[Sensitivity]) {
    if shares.is_empty() {
        return;
    }
    ui.strong("What moves the answer most").on_hover_text(
        "Linear share in the variance of the end of what the data sheet leaves open, from vehicles \
         that are drawn from it",
    );
    let clear: Vec<&Sensitivity> = shares.iter().filter(|share| share.is_clear()).collect();
    if clear.is_empty() {
        ui.weak("No estimate moves it by more than chance.");
        return;
    }
    Grid::new(("sensitivity", id)).striped(true).num_columns(3).show(ui, |ui| {
        for title in ["estimate", "position", "heading"] {
            ui.strong(title);
        }
        ui.end_row();
        for share in clear {
            ui.label(share.label);
            for share in [share.position_share, share.heading_share] {
                ui.monospace(format!("{:.0} %", 100.0 * share));
            }
            ui.end_row();
        }
    });
}
