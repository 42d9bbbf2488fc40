//! Asks for a path by keyboard where the desktop has no file dialog.

use std::path::{Path, PathBuf};

use egui::{Key, Ui};

use crate::app::command::Command;
use crate::app::dialog::purpose::Purpose;
use crate::app::output::Output;

/// A question for a path.
pub struct PathDialog {
    purpose: Purpose,
    typed: String,
}

impl PathDialog {
    /// A question with the usual name in the current folder.
    pub fn new(purpose: Purpose) -> Self {
        let folder = std::env::current_dir().unwrap_or_default();
        let name = purpose.output().map(Output::usual_name).unwrap_or_default();
        let typed = folder.join(name).display().to_string();
        Self { purpose, typed }
    }

    /// Draws the question and adds commands when the user has answered.
    pub fn ui(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        ui.heading(self.purpose.title());
        ui.weak("This desktop showed no file dialog (xdg-desktop-portal brings one).");
        let name = ui.label("Path");
        let field = egui::TextEdit::singleline(&mut self.typed).desired_width(560.0);
        let field = ui.add(field).labelled_by(name.id);
        let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if !field.has_focus() && ui.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
        let path = PathBuf::from(self.typed.trim());
        let writes = self.purpose.output().is_some();
        ui.weak(state_of(&path, writes));
        ui.separator();
        ui.horizontal(|ui| {
            let label = if writes { "Save" } else { "Open" };
            let is_typed = !self.typed.trim().is_empty();
            let is_clicked = ui.add_enabled(is_typed, egui::Button::new(label)).clicked();
            if is_clicked || is_entered && is_typed {
                commands.push(Command::CloseDialog);
                commands.extend(self.purpose.command(vec![path], false));
            }
            if ui.button("Cancel").clicked() {
                commands.push(Command::CloseDialog);
            }
        });
    }
}

/// What is at the path.
fn state_of(path: &Path, writes: bool) -> &'static str {
    let has_folder = path.parent().is_some_and(|folder| folder.is_dir());
    match (path.is_dir(), path.exists(), writes) {
        (_, false, true) if !has_folder => "The folder does not exist.",
        (_, false, true) => "A new file.",
        (_, true, true) => "Exists already; you are asked before it is replaced.",
        (true, _, false) => "A folder.",
        (_, true, false) => "A file.",
        (_, false, false) => "Does not exist.",
    }
}
