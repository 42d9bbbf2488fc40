//! What panes show in the place of an answer, or over one that is late.

use egui::{RichText, Ui};

use crate::app::state::Session;
use impactlab_draw::theme;
use impactlab_study::SimulateAnswer;

/// Share of its colour that an answer keeps which is not of what is asked any more.
const FADED: f32 = 0.35;

/// Draws an answer, greyed if it is not of what is asked any more; the bar of its tab says that it is being
/// computed.
pub(super) fn faded_if<R>(ui: &mut Ui, is_late: bool, draw: impl FnOnce(&mut Ui) -> R) -> R {
    let drawn = ui.scope(|ui| {
        if is_late {
            ui.multiply_opacity(FADED);
        }
        draw(ui)
    });
    drawn.inner
}

/// Returns the simulation of the selected subject. If there is none, it draws the reason (an error,
/// a simulation that is still running, or no selection) and returns `None`.
pub(super) fn analysis_or_hint<'a>(
    ui: &mut Ui,
    session: &'a Session,
) -> Option<&'a SimulateAnswer> {
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
            ui.label(RichText::new("No case chosen").strong());
            ui.label("Choose a case in the Data workspace, open a file (File, or drop it here), or set up a scenario.");
        }
    }
    None
}
