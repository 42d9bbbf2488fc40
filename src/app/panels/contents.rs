//! The “Contents” pane: the case as a tree, with what is missing for the next answer.

use egui::{CollapsingHeader, Label, RichText, ScrollArea, Sense, Ui};

use crate::app::command::Command;
use crate::app::contents::{ContentsEntry, Group};
use crate::app::looks::{self, Icon};
use crate::app::panes::PaneContext;
use crate::app::widgets::severity_color;
use impactlab_core::data::Severity;

/// Draws the parts of the case; a click on one shows the panel in which it is changed.
pub fn contents_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { contents, commands, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for &group in Group::ALL {
            let entries: Vec<_> = contents.iter().filter(|entry| entry.group == group).collect();
            let n_missing = entries.iter().filter(|entry| entry.missing.is_some()).count();
            let warning = severity_color(ui, Severity::Warning);
            let title = match n_missing {
                0 => RichText::new(group.title()),
                1 => RichText::new(format!("{}: 1 open point", group.title())).color(warning),
                n => RichText::new(format!("{}: {n} open points", group.title())).color(warning),
            };
            let title = title.strong();
            let header = CollapsingHeader::new(title).id_salt(group.title()).default_open(true);
            let shown = header.show(ui, |ui| {
                for entry in entries {
                    entry_ui(ui, entry, commands);
                }
            });
            let line = shown.header_response.rect;
            looks::icon_at(ui, group.icon(), [ui.max_rect().right(), line.center().y]);
        }
    });
}

fn entry_ui(ui: &mut Ui, entry: &ContentsEntry, commands: &mut Vec<Command>) {
    let text = match entry.detail.is_empty() {
        true => entry.label.clone(),
        false => format!("{}: {}", entry.label, entry.detail),
    };
    let warning = severity_color(ui, Severity::Warning);
    let text = match entry.missing {
        Some(_) => RichText::new(text).color(warning),
        None => RichText::new(text),
    };
    let line = ui.horizontal_top(|ui| {
        if entry.missing.is_some() {
            looks::icon_ui(ui, Icon::TriangleAlert, warning);
        }
        ui.add(Label::new(text).wrap().selectable(false).sense(Sense::click()))
    });
    let line = line.inner;
    let line = line.on_hover_cursor(egui::CursorIcon::PointingHand);
    let line = match &entry.missing {
        Some(missing) => line.on_hover_text(missing),
        None => line.on_hover_text("Click to show the panel in which it is changed"),
    };
    if line.clicked() {
        commands.push(entry.command.clone());
    }
}
