//! The window with the licences of third parties.

use egui::{ScrollArea, TextStyle, Ui};

use crate::app::command::Command;
use impactlab_networks::shipped::LICENCES;

/// Size of the text that is shown at a time, logical pixels.
const SIZE: [f32; 2] = [720.0, 480.0];

/// Draws the notices, of which only the visible lines are laid out.
pub fn licences_ui(ui: &mut Ui, commands: &mut Vec<Command>) {
    ui.heading("Licences of third parties");
    ui.set_width(SIZE[0]);
    let lines: Vec<&str> = LICENCES.lines().collect();
    let height = ui.text_style_height(&TextStyle::Monospace);
    let area = ScrollArea::both().max_height(SIZE[1]).auto_shrink(false);
    area.show_rows(ui, height, lines.len(), |ui, visible| {
        for line in &lines[visible] {
            ui.monospace(*line);
        }
    });
    ui.separator();
    if ui.button("Close").clicked() {
        commands.push(Command::CloseDialog);
    }
}
