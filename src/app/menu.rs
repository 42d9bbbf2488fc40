//! The menu at the top of the window and the status line at the bottom.

use std::time::Duration;

use egui::{Align, Button, Layout, MenuBar, Panel, ProgressBar, RichText, Ui};

use crate::app::case::{CaseCommand, Leaving};
use crate::app::command::{Command, ComparisonCommand};
use crate::app::dialog::Purpose;
use crate::app::film::FilmCommand;
use crate::app::ground::OPEN_SITE;
use crate::app::keyboard;
use crate::app::looks::{self, Icon, icon, icon_button};
use crate::app::model::file_name;
use crate::app::network::{Network, TrainedModel};
use crate::app::output::Output;
use crate::app::panels;
use crate::app::panes::Pane;
use crate::app::reconstruction::ReconstructionCommand;
use crate::app::report::ReportCommand;
use crate::app::state::State;
use crate::app::sweep::SweepCommand;
use crate::app::tasks::TaskKey;
use crate::app::training_status::TrainingStatus;
use crate::app::widgets::{notice_in_row_ui, severity_color, severity_icon, with_time_left};
use crate::app::workspaces::Workspace;
use impactlab_core::data::Severity;
use impactlab_core::jobs::{Job, Progress};
use impactlab_core::units::UnitSystem;

/// Whether the project can be undone and redone.
#[derive(Clone, Copy)]
pub struct History {
    /// Whether there is a change to undo.
    pub can_undo: bool,
    /// Whether there is an undone change to redo.
    pub can_redo: bool,
}

/// Draws the menu with the files, the panes, the keys, the theme and the units.
pub fn menu_ui(ui: &mut Ui, state: &mut State, history: History, commands: &mut Vec<Command>) {
    Panel::top("menu").show(ui, |ui| {
        MenuBar::new().ui(ui, |ui| {
            ui.menu_button("File", |ui| file_menu_ui(ui, state, commands));
            ui.menu_button("Edit", |ui| {
                let History { can_undo, can_redo } = history;
                let (undo, redo) = (keyboard::UNDO, keyboard::REDO);
                edit_item(ui, Icon::Undo2, "Undo", undo, can_undo, Command::Undo, commands);
                edit_item(ui, Icon::Redo2, "Redo", redo, can_redo, Command::Redo, commands);
            });
            ui.menu_button("View", |ui| view_menu_ui(ui, state, commands));
            ui.menu_button("Help", |ui| help_menu_ui(ui, commands));
            ui.separator();
            workspaces_ui(ui, state, commands);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                for (system, label) in [(UnitSystem::Us, "US"), (UnitSystem::Si, "SI")] {
                    ui.selectable_value(&mut state.view.units, system, label)
                        .on_hover_text("Units of everything on screen");
                }
                ui.separator();
                let (of, label) = match state.view.dark {
                    true => (Icon::Sun, "Light"),
                    false => (Icon::Moon, "Dark"),
                };
                let button = ui.add(icon_button(of, label));
                if button.on_hover_text("Change the theme").clicked() {
                    state.view.dark = !state.view.dark;
                }
            });
        });
    });
}

/// Draws the workspaces, one of which is shown.
fn workspaces_ui(ui: &mut Ui, state: &State, commands: &mut Vec<Command>) {
    let shown = (!state.session.shows_doors).then_some(state.view.workspaces.shown);
    for workspace in Workspace::ALL {
        let text = RichText::new(workspace.title()).strong();
        let parts = (icon(workspace.icon()), text);
        let label = ui.selectable_label(shown == Some(workspace), parts);
        if label.on_hover_text(workspace.purpose()).clicked() {
            commands.push(Command::ShowWorkspace(workspace));
        }
    }
}

fn edit_item(
    ui: &mut Ui,
    of: Icon,
    label: &str,
    shortcut: egui::KeyboardShortcut,
    enabled: bool,
    command: Command,
    commands: &mut Vec<Command>,
) {
    let button = icon_button(of, label).shortcut_text(ui.ctx().format_shortcut(&shortcut));
    if ui.add_enabled(enabled, button).clicked() {
        commands.push(command);
    }
}

fn file_menu_ui(ui: &mut Ui, state: &State, commands: &mut Vec<Command>) {
    for (of, label, shortcut, command) in [
        (
            Icon::FilePlus,
            "New case",
            keyboard::NEW,
            Command::Case(CaseCommand::Leave(Leaving::New)),
        ),
        (Icon::File, "Open files…", keyboard::OPEN, Command::Ask(Purpose::Files)),
        (Icon::FolderOpen, "Open folder…", keyboard::OPEN_FOLDER, Command::Ask(Purpose::Folder)),
        (Icon::Save, "Save case", keyboard::SAVE, Command::Case(CaseCommand::Save)),
        (
            Icon::SaveAll,
            "Save case as…",
            keyboard::SAVE_AS,
            Command::Ask(Purpose::Save(Output::Case)),
        ),
    ] {
        edit_item(ui, of, label, shortcut, true, command, commands);
    }
    if ui.add(icon_button(Icon::FileText, "Report…")).clicked() {
        commands.push(Command::ShowWorkspace(Workspace::Report));
    }
    let package = ui.add(icon_button(Icon::Archive, "Package…"));
    if package.on_hover_text("One zip of the case and all its files").clicked() {
        commands.push(Command::Ask(Purpose::Save(Output::PackedCase)));
    }
    ui.add_enabled_ui(!state.view.recent.is_empty(), |ui| {
        ui.menu_button("Recent cases", |ui| {
            for path in &state.view.recent {
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                    commands.push(Command::Open(vec![path.clone()]));
                }
            }
        });
    });
    ui.separator();
    let session = &state.session;
    let has_force = session.force.model.current.is_some();
    let has_response = session.response.model.current.is_some();
    let has_comparison = session.response.comparison.report().is_some();
    for (label, enabled, purpose) in [
        (OPEN_SITE, true, Purpose::Ground),
        ("Save scenario…", true, Purpose::Save(Output::Scenario)),
        ("Open model…", true, Purpose::OpenModel),
        ("Save force model…", has_force, Purpose::Save(Output::Model(Network::Force))),
        ("Save response model…", has_response, Purpose::Save(Output::Model(Network::Response))),
        ("Open comparison…", true, Purpose::OpenComparison),
        ("Save comparison…", has_comparison, Purpose::Save(Output::Comparison)),
        ("Open atlas…", true, Purpose::OpenAtlas),
        ("Open sweep…", true, Purpose::OpenPlan),
    ] {
        if ui.add_enabled(enabled, Button::new(label)).clicked() {
            commands.push(Command::Ask(purpose));
        }
    }
    ui.separator();
    ui.add_enabled_ui(!state.session.sources.is_empty(), |ui| {
        if ui.button("Close all").clicked() {
            let opened = state.session.sources.iter().map(|source| source.opened.clone());
            commands.extend(opened.map(Command::Close));
        }
    });
    if ui.button("Quit").clicked() {
        ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
    }
}

fn view_menu_ui(ui: &mut Ui, state: &mut State, commands: &mut Vec<Command>) {
    for &pane in Pane::ALL {
        let panel = panels::panel(pane);
        if ui.add(icon_button(panel.icon, panel.title)).clicked() {
            commands.push(Command::Show(pane));
        }
    }
    ui.separator();
    if ui.button("Fit plots to their data").clicked() {
        commands.push(Command::FitPlots);
    }
    if ui.button("Messages…").clicked() {
        commands.push(Command::ShowMessages);
    }
    if ui.button("Put panes back").clicked() {
        commands.push(Command::ResetLayout);
    }
    ui.checkbox(&mut state.view.dark, "Dark theme");
    let shown = &mut state.session.frame_times.is_shown;
    ui.checkbox(shown, "Frames a second")
        .on_hover_text("While something moves, in the status line");
}

fn help_menu_ui(ui: &mut Ui, commands: &mut Vec<Command>) {
    if ui.button("Ways to begin").clicked() {
        commands.push(Command::ShowDoors);
    }
    ui.separator();
    ui.strong("Keys");
    egui::Grid::new("keys").show(ui, |ui| {
        for (key, what) in keyboard::PLAIN_KEYS {
            ui.monospace(key.name());
            ui.label(what);
            ui.end_row();
        }
        for (key, what) in keyboard::SHIFT_KEYS {
            ui.monospace(format!("Shift+{}", key.name()));
            ui.label(what);
            ui.end_row();
        }
        ui.monospace("Ctrl+1, 2, 3, 4, 5, 6");
        ui.label("workspaces");
        ui.end_row();
    });
    ui.separator();
    ui.strong("Scene");
    ui.label(
        "Pointer over it: + and − zoom, Ctrl + arrows move it or turn the view in perspective.",
    );
    ui.separator();
    ui.strong("Plots");
    ui.label("Hover to read values, click or drag in a time plot to move the cursor,");
    ui.label("Shift + drag for the numbers between two cursors,");
    ui.label(
        "wheel in a plan or Ctrl + wheel to zoom, right-drag for a zoom box, double click to fit.",
    );
    ui.separator();
    ui.label(format!("impactlab {}", crate::VERSION));
    ui.label("The shipped data are simulations, not measurements.");
    if ui.button("Licences…").clicked() {
        commands.push(Command::ShowLicences);
    }
}

/// Width of the bar of a job in the status line, points.
const JOB_WIDTH: f32 = 300.0;

/// Draws the status line: the work in progress with its progress bars, and the latest message beside it,
/// so that the panes keep their place when work begins or ends.
pub fn status_ui(ui: &mut Ui, state: &State, commands: &mut Vec<Command>) {
    Panel::bottom("status").show(ui, |ui| {
        panels::interrupted_ui(ui, &state.session, commands);
        ui.horizontal_wrapped(|ui| {
            jobs_ui(ui, state, commands);
            if state.session.frame_times.is_shown {
                ui.weak(state.session.frame_times.text());
            }
            message_ui(ui, state, commands);
        });
    });
}

/// Draws the jobs that are running.
fn jobs_ui(ui: &mut Ui, state: &State, commands: &mut Vec<Command>) {
    let tasks = &state.session.tasks;
    for source in &state.session.sources {
        if let Some((progress, left)) = tasks.progress(&TaskKey::Load(source.opened.clone())) {
            let cancel = Command::Close(source.opened.clone());
            let what = format!("Loading {}", source.name());
            progress_ui(ui, &what, progress, left, cancel, commands);
        }
    }
    for (path, replay) in &state.session.replays {
        if let Some(job) = replay.question.job() {
            let cancel = Command::CancelReplay(path.clone());
            let name = file_name(path);
            job_ui(ui, &format!("Simulating {name}"), job, cancel, commands);
        }
    }
    let (force, response) = (&state.session.force.training, &state.session.response.training);
    if force.run.is_running() {
        training_job_ui(ui, force, commands);
    }
    if response.run.is_running() {
        training_job_ui(ui, response, commands);
    }
    if let Some((what, progress, left)) = state.session.response.comparison.progress() {
        let what = format!("{what}, {}", progress.message);
        let cancel = Command::Compare(ComparisonCommand::Cancel);
        progress_ui(ui, &what, progress, left, cancel, commands);
    }
    // In its own workspace the reconstruction shows its progress itself.
    if let Some(job) = state.session.reconstruction.run.job()
        && state.view.workspaces.shown != Workspace::Reconstruct
    {
        let cancel = Command::Reconstruct(ReconstructionCommand::Cancel);
        let left = state.session.reconstruction.time_left();
        progress_ui(ui, "Reconstructing", job.progress(), left, cancel, commands);
    }
    if let Some((progress, left)) = tasks.progress(&TaskKey::Report)
        && state.view.workspaces.shown != Workspace::Report
    {
        let cancel = Command::Report(ReportCommand::Cancel);
        progress_ui(ui, "Making the report", progress, left, cancel, commands);
    }
    for (key, what) in [(TaskKey::Sweep, "Sweep"), (TaskKey::MergeSweep, "Merging the sweep")] {
        if let Some((progress, left)) = tasks.progress(&key) {
            let cancel = Command::Sweep(SweepCommand::Cancel);
            progress_ui(ui, what, progress, left, cancel, commands);
        }
    }
    if let Some(path) = tasks.film()
        && let Some((progress, left)) = tasks.progress(&TaskKey::Film(path.to_owned()))
    {
        let name = file_name(path);
        let what = format!("Making {name}");
        progress_ui(ui, &what, progress, left, Command::Film(FilmCommand::Cancel), commands);
    }
}

/// Draws the latest message.
fn message_ui(ui: &mut Ui, state: &State, commands: &mut Vec<Command>) {
    let Some(latest) = state.session.messages.last() else {
        ui.weak("Ready. Drop a folder or a file here to open it.");
        return;
    };
    if ui.small_button("Dismiss").clicked() {
        commands.push(Command::DismissMessage);
    }
    let older = state.session.messages.len() - 1;
    if older > 0 {
        let others = state.session.messages.iter().rev().skip(1).take(20);
        let text: Vec<&str> = others.map(|message| message.text.as_str()).collect();
        let all = ui.small_button(format!("+{older}")).on_hover_text(text.join("\n"));
        if all.clicked() {
            commands.push(Command::ShowMessages);
        }
    }
    let color = severity_color(ui, latest.severity);
    looks::icon_ui(ui, severity_icon(latest.severity), color);
    let text = match latest.severity {
        Severity::Error => format!("Error: {}", latest.text),
        Severity::Warning => format!("Warning: {}", latest.text),
        Severity::Info => latest.text.clone(),
    };
    ui.add(egui::Label::new(RichText::new(text).color(color)).wrap());
}

/// Draws the list of all messages since the start, the newest first.
pub fn messages_ui(ui: &mut Ui, state: &State, commands: &mut Vec<Command>) {
    ui.heading("Messages");
    egui::ScrollArea::vertical().max_height(480.0).show(ui, |ui| {
        if state.session.log.is_empty() {
            ui.weak("Nothing has been said since the start.");
        }
        for (time, message) in state.session.log.iter().rev() {
            ui.horizontal_wrapped(|ui| {
                ui.monospace(time);
                notice_in_row_ui(ui, message.severity, &message.text);
            });
        }
    });
    ui.separator();
    if ui.button("Close").clicked() {
        commands.push(Command::CloseDialog);
    }
}

/// Draws a training in progress, with a button that brings the training pane to the
/// front.
fn training_job_ui<M: TrainedModel>(
    ui: &mut Ui,
    status: &TrainingStatus<M>,
    commands: &mut Vec<Command>,
) {
    if ui.small_button("Show").clicked() {
        commands.push(Command::ShowTraining(M::NETWORK));
    }
    let paused = if status.run.is_paused() { ", paused" } else { "" };
    let part = match status.fit() {
        Some(fit) if fit.is_after_epochs => ", fits after the epochs",
        Some(_) => ", fits before the epochs",
        None => "",
    };
    let what = format!("{}{paused}{part}", M::NETWORK.label());
    match status.progress() {
        (Some(fraction), left) => {
            job_bar_ui(ui, fraction, &with_time_left(&what, left));
        }
        (None, _) => drop((ui.spinner(), ui.label(what))),
    }
    ui.separator();
}

/// Draws the share of a job that is done, as wide as its text.
fn job_bar_ui(ui: &mut Ui, fraction: f32, text: &str) -> egui::Response {
    let font = egui::TextStyle::Button.resolve(ui.style());
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, egui::Color32::PLACEHOLDER);
    let width = JOB_WIDTH.max(galley.size().x + 2.0 * ui.spacing().item_spacing.x);
    ui.add(ProgressBar::new(fraction).desired_width(width).text(text))
}

/// Draws a running job: a button to cancel, the share done and the time left.
fn job_ui<T>(ui: &mut Ui, what: &str, job: &Job<T>, cancel: Command, commands: &mut Vec<Command>) {
    progress_ui(ui, what, job.progress(), job.time_left(), cancel, commands);
}

fn progress_ui(
    ui: &mut Ui,
    what: &str,
    progress: &Progress,
    left: Option<Duration>,
    cancel: Command,
    commands: &mut Vec<Command>,
) {
    if ui.small_button("Cancel").clicked() {
        commands.push(cancel);
    }
    match progress.fraction() {
        Some(fraction) => {
            let text = format!("{what}: {:.0} %", 100.0 * fraction);
            job_bar_ui(ui, fraction, &with_time_left(&text, left));
        }
        None => drop((ui.spinner(), ui.label(what))),
    }
    ui.separator();
}

/// Draws a hint over the window that says what can be dropped, while the user drags a file over it.
pub fn drop_hint_ui(ui: &Ui) {
    if ui.ctx().input(|input| input.raw.hovered_files.is_empty()) {
        return;
    }
    let area = ui.ctx().content_rect();
    let painter = ui
        .ctx()
        .layer_painter(egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("drop hint")));
    painter.rect_filled(area, 0.0, egui::Color32::from_black_alpha(160));
    let font = egui::TextStyle::Heading.resolve(ui.style());
    let text = "Drop to open: a case, a data set folder, a force or trajectory file, a scenario, a site, a model, a comparison, an atlas, a plan";
    painter.text(area.center(), egui::Align2::CENTER_CENTER, text, font, egui::Color32::WHITE);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// “Making PIT right rear quarter.mp4: 19 %, 2 min 27 s” ended at the bar.
    #[test]
    fn a_job_with_a_long_name_is_told_in_full() {
        let text = "Making the second of two PIT on a wet road.mp4: 19 %, 2 min 27 s left";
        let mut widths = [0.0; 2];
        let _ = egui::Context::default().run_ui(egui::RawInput::default(), |ui| {
            let (bar, label) = (job_bar_ui(ui, 0.2, text), ui.label(text));
            widths = [bar, label].map(|response| response.rect.width());
        });
        assert!(widths[0] > widths[1] && widths[1] > JOB_WIDTH, "{widths:?}");
    }
}
