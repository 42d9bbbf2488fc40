//! What must not be overlooked: a line with an icon, or a few words in the colour of their severity.

use egui::{Color32, Label, Response, RichText, Ui};

use crate::app::looks::{self, Icon};
use impactlab_core::data::Severity;
use impactlab_draw::theme;

/// The colour of a severity on the ground of the window.
pub fn severity_color(ui: &Ui, severity: Severity) -> Color32 {
    theme::severity_color(severity, ui.visuals().dark_mode)
}

/// The icon of a severity, which is not told by its colour alone.
pub fn severity_icon(severity: Severity) -> Icon {
    match severity {
        Severity::Info => Icon::Info,
        Severity::Warning => Icon::TriangleAlert,
        Severity::Error => Icon::CircleX,
    }
}

/// Draws a text with the icon and in the colour of its severity, in as many lines as it needs.
///
/// - returns the response of the text, which a hint can be added to.
pub fn notice_ui(ui: &mut Ui, severity: Severity, text: impl Into<RichText>) -> Response {
    let color = severity_color(ui, severity);
    let text = text.into().color(color);
    let line = ui.horizontal_top(|ui| {
        looks::icon_ui(ui, severity_icon(severity), color);
        ui.add(Label::new(text).wrap())
    });
    line.inner
}

/// The same among other parts of a row, in the layout of the row.
pub fn notice_in_row_ui(ui: &mut Ui, severity: Severity, text: impl Into<RichText>) -> Response {
    let color = severity_color(ui, severity);
    looks::icon_ui(ui, severity_icon(severity), color);
    ui.colored_label(color, text)
}

#[cfg(test)]
mod tests {
    use egui::{Context, RawInput, Shape};

    use super::*;

    #[test]
    fn a_notice_has_the_icon_and_the_colour_of_its_severity() {
        let context = Context::default();
        looks::install(&context);
        for (severity, icon) in [
            (Severity::Info, Icon::Info),
            (Severity::Warning, Icon::TriangleAlert),
            (Severity::Error, Icon::CircleX),
        ] {
            let mut color = Color32::PLACEHOLDER;
            let output = context.run_ui(RawInput::default(), |ui| {
                color = severity_color(ui, severity);
                notice_ui(ui, severity, "a reason");
                notice_in_row_ui(ui, severity, "in a row");
            });
            let drawn = output.shapes.iter().filter_map(|clipped| match &clipped.shape {
                Shape::Text(text) => Some(&text.galley),
                _ => None,
            });
            let drawn: Vec<_> = drawn.collect();
            let texts: Vec<&str> = drawn.iter().map(|galley| galley.text()).collect();
            let icon = char::from(icon).to_string();
            assert_eq!(texts, [&*icon, "a reason", &*icon, "in a row"], "{severity:?}");
            for galley in drawn {
                let is_colored = galley.job.sections.iter().all(|part| part.format.color == color);
                assert!(is_colored, "{severity:?}: {}", galley.text());
            }
        }
    }
}
