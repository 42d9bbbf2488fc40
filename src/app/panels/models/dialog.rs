//! The questions of the Models pane: a name, and whether something is to be removed.

use egui::{Key, Ui};

use crate::app::archive::ModelsDialog;
use crate::app::command::{Command, ModelsCommand};

/// Draws the question and adds a command when the user has answered.
pub fn models_dialog_ui(ui: &mut Ui, dialog: &mut ModelsDialog, commands: &mut Vec<Command>) {
    match dialog {
        ModelsDialog::Rename { entry, name } => {
            ui.heading("Rename");
            let label = ui.label("Name");
            let field = ui.text_edit_singleline(name).labelled_by(label.id);
            let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            ui.separator();
            let typed = name.trim().to_owned();
            ui.horizontal(|ui| {
                let rename = ui.add_enabled(!typed.is_empty(), egui::Button::new("Rename it"));
                if rename.clicked() || is_entered && !typed.is_empty() {
                    let command = ModelsCommand::Rename(entry.clone(), typed);
                    commands.push(Command::Models(command));
                }
                if ui.button("Leave it").clicked() {
                    commands.push(Command::CloseDialog);
                }
            });
        }
        ModelsDialog::Remove(removal) => {
            ui.heading(format!("Remove {}?", removal.name));
            ui.label(&removal.what);
            ui.separator();
            ui.horizontal(|ui| {
                if ui.button("Remove it").clicked() {
                    commands.push(Command::Models(ModelsCommand::Remove(removal.clone())));
                }
                if ui.button("Keep it").clicked() {
                    commands.push(Command::CloseDialog);
                }
            });
        }
    }
}
