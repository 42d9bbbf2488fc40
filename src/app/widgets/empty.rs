//! What a pane says that has nothing to show.

use egui::{Label, RichText, Ui, WidgetText};

/// Draws what is not there, or what the pane is for, and below it what can be done.
pub fn empty_ui(ui: &mut Ui, title: impl Into<RichText>, text: impl Into<WidgetText>) {
    ui.strong(title);
    ui.add(Label::new(text).wrap());
}
