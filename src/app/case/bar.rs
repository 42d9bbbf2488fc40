//! The bar below the menu: the case that is open and its variants.

use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Button, Panel, PopupCloseBehavior, RichText, Ui};

use crate::app::case::{CaseCommand, VariantCommand};
use crate::app::command::Command;
use crate::app::keyboard;
use crate::app::state::State;
use crate::app::tasks::TaskKey;

/// Draws the name of the case, whether it is saved, and its variants.
pub fn case_bar_ui(ui: &mut Ui, state: &mut State, commands: &mut Vec<Command>) {
    Panel::top("case").show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            let (is_changed, file) = (state.session.known_case.is_changed, &state.case.file);
            let mark = if is_changed { " •" } else { "" };
            let path = state.case.path.as_ref().map(|path| path.display().to_string());
            let hint = match (&path, is_changed) {
                (None, _) if state.session.keeps_state => {
                    "This case has no file yet. It is kept for the next start.".to_owned()
                }
                (None, _) => {
                    "This case has no file yet, and this window keeps nothing for the next \
                              start: save it."
                        .to_owned()
                }
                (Some(path), true) => format!("{path}\nhas changes that are not saved"),
                (Some(path), false) => format!("{path}\nis saved"),
            };
            ui.label("Case");
            ui.label(RichText::new(format!("{}{mark}", file.name)).strong()).on_hover_text(hint);
            let save = Button::new("Save").small();
            let shortcut = ui.ctx().format_shortcut(&keyboard::SAVE);
            let can_save = is_changed && !state.session.tasks.is_running(&TaskKey::SaveCase);
            let saved =
                ui.add_enabled(can_save, save).on_hover_text(format!("Save the case ({shortcut})"));
            if saved.clicked() {
                commands.push(Command::Case(CaseCommand::Save));
            }
            ui.separator();
            ui.label("Variant");
            for variant in &file.variants {
                let is_shown = variant.name == file.shown;
                if ui.selectable_label(is_shown, &variant.name).clicked() && !is_shown {
                    commands.push(Command::Variant(VariantCommand::Show(variant.name.clone())));
                }
            }
            let copy =
                ui.small_button("Copy").on_hover_text("A copy of this variant, to be changed");
            if copy.clicked() {
                commands.push(Command::Variant(VariantCommand::Duplicate));
            }
            // A click into one of its fields leaves it open.
            let stays = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
            let names = MenuButton::new("Name…").config(stays);
            names.ui(ui, |ui| rename_ui(ui, state, commands));
            let can_remove = state.case.file.variants.len() > 1;
            ui.add_enabled_ui(can_remove, |ui| {
                ui.menu_button("Remove…", |ui| {
                    ui.label(format!(
                        "Remove the variant {:?}? It cannot be undone.",
                        state.case.file.shown
                    ));
                    if ui.button("Remove it").clicked() {
                        commands.push(Command::Variant(VariantCommand::Remove));
                        ui.close();
                    }
                });
            });
        });
    });
}

/// Draws the fields for the name of the variant, and for the notes of it and of the case.
fn rename_ui(ui: &mut Ui, state: &mut State, commands: &mut Vec<Command>) {
    let name = ui.label("Name of the variant");
    let shown = state.case.file.shown.clone();
    let id = egui::Id::unique("variant name").with((state.session.n_cases, &shown));
    let mut typed = ui.data(|data| data.get_temp::<String>(id)).unwrap_or(shown);
    let field = ui.text_edit_singleline(&mut typed).labelled_by(name.id);
    let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
    if ui.button("Rename").clicked() || is_entered {
        commands.push(Command::Variant(VariantCommand::Rename(typed.clone())));
        ui.data_mut(|data| data.remove::<String>(id));
        ui.close();
    } else {
        ui.data_mut(|data| data.insert_temp(id, typed));
    }
    ui.separator();
    let shown = state.case.file.shown.clone();
    if let Some(variant) = state.case.file.variant_mut(&shown) {
        let notes = ui.label("Notes of the variant");
        ui.text_edit_multiline(&mut variant.notes).labelled_by(notes.id);
    }
    let notes = ui.label("Notes of the case");
    ui.text_edit_multiline(&mut state.case.file.notes).labelled_by(notes.id);
}
