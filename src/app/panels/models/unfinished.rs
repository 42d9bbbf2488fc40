//! The trainings that can go on: those that the end of the program has interrupted, and those that
//! the user has cancelled.

use egui::{RichText, Ui};

use crate::app::archive::{ModelsDialog, Removal, how_it_was_made, moment_text};
use crate::app::command::{Command, ModelsCommand};
use crate::app::network::Network;
use crate::app::panes::Pane;
use crate::app::state::Session;
use crate::app::unfinished::Unfinished;
use crate::app::widgets::{notice_in_row_ui, severity_color};
use impactlab_core::data::Severity;

/// Whether there is a training that can go on, or a checkpoint that cannot be used.
pub fn has_something(session: &Session) -> bool {
    let list = &session.unfinished.list;
    !list.trainings.is_empty() || !list.lost.is_empty()
}

/// Draws the trainings with the buttons that go on with them or discard them.
pub fn unfinished_ui(ui: &mut Ui, session: &Session, commands: &mut Vec<Command>) {
    for of in &session.unfinished.list.trainings {
        ui.horizontal_wrapped(|ui| {
            ui.strong(title(of));
            ui.label(of.progress());
            buttons_ui(ui, of, session, commands);
        });
        let how = how_it_was_made(&of.note.question);
        ui.weak(format!("{how}; started {}", moment_text(&of.note.started)));
    }
    for lost in &session.unfinished.list.lost {
        ui.horizontal_wrapped(|ui| {
            notice_in_row_ui(ui, Severity::Error, format!("Cannot be resumed: {}", lost.reason));
            if !lost.files.is_empty() && ui.small_button("Discard…").clicked() {
                let name = lost.files[0].display().to_string();
                let what = "The checkpoint is removed from the disk.".to_owned();
                let files = lost.files.clone();
                ask(Removal { name, what, files }, commands);
            }
        });
    }
}

fn buttons_ui(ui: &mut Ui, of: &Unfinished, session: &Session, commands: &mut Vec<Command>) {
    let is_running = match of.note.network {
        Network::Force => session.force.training.run.is_running(),
        Network::Response => session.response.training.run.is_running(),
    };
    let resume = ui.add_enabled(!is_running, egui::Button::new("Resume training"));
    let hint = "To the same weights as without the interruption";
    if resume.on_hover_text(hint).clicked() {
        commands.push(Command::Models(ModelsCommand::Resume(of.checkpoint.clone())));
    }
    if ui.button("Discard…").clicked() {
        let what = format!("{} is removed from the disk and cannot go on.", of.progress());
        ask(Removal { name: title(of), what, files: of.files() }, commands);
    }
}

fn ask(removal: Removal, commands: &mut Vec<Command>) {
    commands.push(Command::Models(ModelsCommand::Ask(ModelsDialog::Remove(removal))));
}

fn title(of: &Unfinished) -> String {
    let state = if of.note.is_cancelled { "Cancelled" } else { "Interrupted" };
    format!("{state} training of a {} on {}", of.note.network.model(), of.note.data)
}

/// Draws a row of the status line that says which training the end of the program has interrupted,
/// with the ways to it. Without one it draws nothing.
pub fn interrupted_ui(ui: &mut Ui, session: &Session, commands: &mut Vec<Command>) {
    if session.unfinished.is_hidden {
        return;
    }
    let mut interrupted = session.unfinished.interrupted();
    let Some(first) = interrupted.next() else { return };
    let n_more = interrupted.count();
    ui.horizontal(|ui| {
        buttons_ui(ui, first, session, commands);
        if ui.button("Show models").clicked() {
            commands.push(Command::Show(Pane::Models));
        }
        if ui.button("Later").on_hover_text("It stays in the Models pane").clicked() {
            commands.push(Command::Models(ModelsCommand::HideInterrupted));
        }
        let more = if n_more > 0 { format!(", and {n_more} more") } else { String::new() };
        let color = severity_color(ui, Severity::Warning);
        let text = format!("{}: {}{more}", title(first), first.progress());
        ui.add(egui::Label::new(RichText::new(text).color(color)).truncate());
    });
}
