//! Says what is wrong with what was typed, and moves nothing that is around it.

use egui::{Label, Response, RichText, Shape, Stroke, StrokeKind, Tooltip, Ui, pos2};

use crate::app::widgets::severity_color;
use impactlab_core::data::Severity;

/// Side of the mark in the corner of the field, points.
const MARK: f32 = 6.0;

/// Draws a line that says what is wrong, with all of it on hovering. The line is always there, so that the
/// fields below it do not move while they are filled in.
pub fn problem_line_ui(ui: &mut Ui, problem: Option<&str>) {
    let text = problem.unwrap_or_default();
    let color = severity_color(ui, Severity::Error);
    let line = ui.add(Label::new(RichText::new(text).color(color)).truncate());
    if !text.is_empty() {
        line.on_hover_text(text);
    }
}

/// Marks a field, by a frame and in its corner, and says below it why its text is not taken, over what stands
/// there: the fields stay where they are.
///
/// - `is_open`: whether it is said now; otherwise on hovering.
/// - returns the response of the field.
pub(super) fn refusal_ui(ui: &Ui, field: Response, why: &str, is_open: bool) -> Response {
    let (rect, color) = (field.rect, severity_color(ui, Severity::Error));
    ui.painter().rect_stroke(rect, 2.0, Stroke::new(1.0, color), StrokeKind::Inside);
    let corner = rect.right_top();
    let ends = [corner, pos2(corner.x - MARK, corner.y), pos2(corner.x, corner.y + MARK)];
    ui.painter().add(Shape::convex_polygon(ends.to_vec(), color, Stroke::NONE));
    field.ctx.accesskit_node_builder(field.id, |node| node.set_description(why));
    let text = RichText::new(why).color(color);
    if !is_open {
        return field.on_hover_text(text);
    }
    // A field that is scrolled out of sight would have it elsewhere.
    if ui.clip_rect().contains(rect.center()) {
        Tooltip::for_widget(&field).show(|ui| ui.label(text));
    }
    field
}
