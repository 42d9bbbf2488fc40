//! What the trainings of both networks show alike.

use std::time::Duration;

use egui::{ProgressBar, Ui};

use crate::app::command::{Command, TrainingCommand};
use crate::app::network::Network;
use crate::app::widgets::duration_text;
use crate::data::Severity;
use crate::render::theme;

/// What a training is doing, for its buttons.
#[derive(Debug, Clone, Copy)]
pub struct RunState {
    /// Of which network.
    pub network: Network,
    /// Whether there is something to train on.
    pub can_start: bool,
    /// Whether it is under way, paused or not.
    pub is_running: bool,
    /// Whether it waits.
    pub is_paused: bool,
    /// Whether it was told to stop.
    pub is_cancelled: bool,
}

/// Rows of a two-column grid: a file with settings, and whether to go on from a checkpoint.
pub fn settings_rows_ui(ui: &mut Ui, parts: &str, (config, resume): (&mut String, &mut bool)) {
    let name = ui.label("Settings file");
    let field = egui::TextEdit::singleline(config).desired_width(320.0);
    ui.add(field.hint_text(format!("TOML, optional: {parts}")))
        .labelled_by(name.id)
        .on_hover_text("What it leaves out keeps its default; `--print-config` prints them all");
    ui.end_row();
    ui.label("");
    ui.checkbox(resume, "go on where a training of these settings was interrupted")
        .on_hover_text("To the same weights as if it had not been");
    ui.end_row();
}

/// Train, pause, cancel.
pub fn run_buttons_ui(ui: &mut Ui, run: RunState, commands: &mut Vec<Command>) {
    let RunState { network, can_start, is_running, is_paused, is_cancelled } = run;
    ui.horizontal(|ui| {
        if ui.add_enabled(can_start && !is_running, egui::Button::new("Train")).clicked() {
            commands.push(Command::Train(network, TrainingCommand::Start));
        }
        let label = if is_paused { "Resume" } else { "Pause" };
        if ui.add_enabled(is_running, egui::Button::new(label)).clicked() {
            commands.push(Command::Train(network, TrainingCommand::Pause(!is_paused)));
        }
        let cancel = ui.add_enabled(is_running && !is_cancelled, egui::Button::new("Cancel"));
        if cancel.on_hover_text("Ends the training; the weights so far are kept").clicked() {
            commands.push(Command::Train(network, TrainingCommand::Cancel));
        }
    });
}

/// How far it is, with the time left.
pub fn run_progress_ui(ui: &mut Ui, what: &str, (fraction, left): (Option<f32>, Option<Duration>)) {
    let left = left.map_or(String::new(), |left| format!(", {} left", duration_text(left)));
    match fraction {
        Some(fraction) => {
            let bar = ProgressBar::new(fraction).desired_width(420.0);
            ui.add(bar.text(format!("{what}{left}")));
        }
        None => drop(ui.horizontal(|ui| (ui.spinner(), ui.label(what)))),
    }
}

/// Why there is no model, and which cases it has not seen.
pub fn run_problems_ui(ui: &mut Ui, problem: Option<&str>, left_out: &[String]) {
    let dark = ui.visuals().dark_mode;
    if let Some(problem) = problem {
        let color = theme::severity_color(Severity::Error, dark);
        ui.colored_label(color, format!("Not trained: {problem}"));
    }
    for why in left_out {
        let color = theme::severity_color(Severity::Warning, dark);
        ui.colored_label(color, format!("Left out: {why}"));
    }
}

/// Which losses are drawn, and whether their axis is logarithmic.
pub fn loss_choice_ui(
    ui: &mut Ui,
    names: &[&'static str],
    (selected, log): (&mut Vec<String>, &mut bool),
) {
    ui.horizontal_wrapped(|ui| {
        ui.label("Losses");
        for name in names {
            let position = selected.iter().position(|other| other == name);
            let mut is_selected = position.is_some();
            if ui.checkbox(&mut is_selected, *name).changed() {
                match position {
                    Some(position) => drop(selected.remove(position)),
                    None => selected.push((*name).to_owned()),
                }
            }
        }
        ui.separator();
        ui.checkbox(log, "logarithmic")
            .on_hover_text("Where no shown loss is zero or less, as a likelihood may be");
    });
}
