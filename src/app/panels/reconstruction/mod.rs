//! The panes of the reconstruction: the evidence, the scene, and the speeds.

mod backdrop;
mod cards;
mod evidence;
mod fields;
mod findings;
mod priors;
mod scene;
mod scene_edit;
mod speeds;

pub use evidence::evidence_ui;
pub use scene::reconstructed_scene_ui;
pub use speeds::speeds_ui;

use egui::Ui;

use crate::app::looks::{self, Icon};
use impactlab_core::data::Severity;
use impactlab_draw::theme;

/// What is said of an answer whose evidence or settings have been changed since.
const OUTDATED: &str = "The evidence or the settings were changed since the last run: Run again";

/// Draws a line that says what restricts what is shown, with an icon.
fn notice_ui(ui: &mut Ui, severity: Severity, text: &str) {
    let color = theme::severity_color(severity, ui.visuals().dark_mode);
    let icon = match severity {
        Severity::Info => Icon::Info,
        Severity::Warning | Severity::Error => Icon::TriangleAlert,
    };
    ui.horizontal_top(|ui| {
        looks::icon_ui(ui, icon, color);
        ui.add(egui::Label::new(egui::RichText::new(text).color(color)).wrap());
    });
}
