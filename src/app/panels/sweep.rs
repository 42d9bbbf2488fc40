//! The “Sweep” pane: one question many times, with what it costs before it is started.

use std::time::Duration;

use egui::{Button, Grid, Label, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::looks::{self, Icon, icon_button};
use crate::app::model::file_name;
use crate::app::output::Output;
use crate::app::panes::PaneContext;
use crate::app::state::Session;
use crate::app::sweep::{KnownSweep, SweepCommand, SweepView, TimedRows};
use crate::app::tasks::TaskKey;
use crate::app::widgets::{duration_text, empty_ui, notice_ui, run_progress_ui, working_ui};
use impactlab_core::data::Severity;
use impactlab_sweep::{Design, SweptQuestion};

/// Width of texts, points.
const TEXT_WIDTH: f32 = 620.0;

/// Draws plan, cost and folder, and the buttons that compute, go on, cancel and merge.
pub fn sweep_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { view, session, commands, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.set_max_width(TEXT_WIDTH.min(ui.available_width()));
        if !view.sweep.is_chosen() {
            return no_sweep_ui(ui, commands);
        }
        let is_busy =
            [TaskKey::Sweep, TaskKey::MergeSweep].iter().any(|key| session.tasks.is_running(key));
        files_ui(ui, &view.sweep, is_busy, commands);
        ui.add_space(looks::PART);
        match (session.sweep.sweep(), session.sweep.refusal()) {
            (Some(sweep), _) => {
                plan_ui(ui, sweep);
                ui.add_space(looks::PART);
                cost_ui(ui, sweep, session, commands);
                ui.add_space(looks::PART);
                work_ui(ui, sweep, (&view.sweep, session), commands);
            }
            (None, Some(why)) => drop(notice_ui(ui, Severity::Error, why)),
            (None, None) => working_ui(ui, "Reading…"),
        }
    });
}

/// Draws what a sweep is and how to begin one.
fn no_sweep_ui(ui: &mut Ui, commands: &mut Vec<Command>) {
    empty_ui(
        ui,
        "One question, many times",
        "A sweep asks one question with inputs that vary, such as a PIT over speeds, angles and roads, \
         and writes a row for each run. Its rows make an atlas, or a table for your own programs.",
    );
    ui.label(
        "It begins with a plan, a short text file that says what varies. It is computed in chunks that \
         stay when it is stopped, and the same plan can go on here, by command or on a cluster.",
    );
    ui.add_space(looks::PART);
    open_ui(ui, true, commands);
}

fn open_ui(ui: &mut Ui, is_enabled: bool, commands: &mut Vec<Command>) {
    ui.add_enabled_ui(is_enabled, |ui| {
        ui.horizontal_wrapped(|ui| {
            if ui.add(icon_button(Icon::FolderOpen, "Open a plan…")).clicked() {
                commands.push(Command::Ask(Purpose::OpenPlan));
            }
            let save = ui.button("Save an example plan…");
            let hint = "The plan of the shipped atlas, to be changed: it has 32 768 rows";
            if save.on_hover_text(hint).clicked() {
                commands.push(Command::Ask(Purpose::Save(Output::ExamplePlan)));
            }
        });
    });
}

/// Draws the file of the plan and the folder.
fn files_ui(ui: &mut Ui, view: &SweepView, is_busy: bool, commands: &mut Vec<Command>) {
    Grid::new("sweep files").num_columns(2).show(ui, |ui| {
        ui.label("Plan");
        let plan = view.plan.as_deref().map_or_else(|| "that of the folder".to_owned(), file_name);
        let shown = ui.add(Label::new(plan).truncate());
        if let Some(path) = &view.plan {
            shown.on_hover_text(path.display().to_string());
        }
        ui.end_row();
        ui.label("Folder");
        let folder = view.folder.as_ref().map(|folder| folder.display().to_string());
        ui.add(Label::new(folder.unwrap_or_else(|| "not chosen yet".to_owned())).wrap());
        ui.end_row();
    });
    open_ui(ui, !is_busy, commands);
    ui.add_enabled_ui(!is_busy, |ui| {
        let choose = ui.add(icon_button(Icon::FolderOpen, "Choose the folder…"));
        if choose.on_hover_text("The plan and a file for each chunk are written there").clicked() {
            commands.push(Command::Ask(Purpose::SweepFolder));
        }
    });
}

/// Draws what the plan says.
fn plan_ui(ui: &mut Ui, sweep: &KnownSweep) {
    let plan = &sweep.plan;
    if !plan.name.is_empty() {
        ui.strong(&plan.name);
    }
    let question = match &plan.question {
        SweptQuestion::Pit(_) => "a PIT, one draw of both cars a row",
        SweptQuestion::Request(_) => "a request, with numbers of its answer",
    };
    let design = match plan.design {
        Design::Sobol => "scrambled Sobol points",
        Design::Saltelli => "Saltelli, for Sobol indices",
        Design::Grid => "every combination of the values of lists",
    };
    let inputs: Vec<&str> = plan.vary.iter().map(|vary| vary.name.as_str()).collect();
    Grid::new("sweep plan").num_columns(2).show(ui, |ui| {
        for (label, text) in [
            ("Question", question.to_owned()),
            ("Layout", format!("{design}, seed {}", plan.seed)),
            ("Varies", inputs.join(", ")),
            ("Outcomes", format!("{} numbers a row", plan.outcomes().len())),
        ] {
            ui.label(label);
            ui.add(Label::new(text).wrap());
            ui.end_row();
        }
    });
}

/// Draws how much work the sweep is, before it is started.
fn cost_ui(ui: &mut Ui, sweep: &KnownSweep, session: &Session, commands: &mut Vec<Command>) {
    let plan = &sweep.plan;
    let (n_rows, n_chunks) = (plan.n_rows(), plan.n_chunks());
    ui.strong(format!("{n_rows} rows in {n_chunks} chunks of at most {} rows", plan.chunk));
    ui.horizontal_wrapped(|ui| {
        if session.tasks.is_running(&TaskKey::TimeSweep) {
            ui.spinner();
            ui.weak("Timing rows…");
            return;
        }
        match session.sweep.timed() {
            None => {
                drop(ui.label("How long it takes is unknown until rows are timed, or computed."))
            }
            Some(Ok(timed)) => drop(ui.label(cost_text(timed, sweep.rows_left()))),
            Some(Err(why)) => drop(ui.label(format!("How long it takes is not known: {why}"))),
        }
        let is_idle = !session.tasks.is_running(&TaskKey::Sweep);
        let time = ui.add_enabled(is_idle, Button::new("Time some rows").small());
        if time.on_hover_text("A few rows of the plan, with nothing left behind").clicked() {
            commands.push(Command::Sweep(SweepCommand::Time));
        }
    });
}

fn cost_text(timed: &TimedRows, rows_left: u64) -> String {
    let left = Duration::try_from_secs_f64(timed.seconds_of(rows_left));
    let left = left.map_or_else(|_| "more than this program can say".to_owned(), duration_text);
    let n = timed.n_rows;
    format!(
        "About {left} on this machine for what is missing ({n} rows took {:.1} s)",
        timed.seconds
    )
}

/// Draws what is there, and the buttons.
fn work_ui(
    ui: &mut Ui,
    sweep: &KnownSweep,
    (view, session): (&SweepView, &Session),
    commands: &mut Vec<Command>,
) {
    let running = [(TaskKey::Sweep, "computing"), (TaskKey::MergeSweep, "merging")];
    let running =
        running.iter().find_map(|(key, what)| Some((session.tasks.progress(key)?, *what)));
    if let Some(((progress, left), what)) = running {
        let message = if progress.message.is_empty() { what } else { progress.message.as_str() };
        run_progress_ui(ui, message, progress.fraction(), left);
        let cancel = ui.button("Cancel");
        if cancel.on_hover_text("Chunks that are finished stay, and it can go on").clicked() {
            commands.push(Command::Sweep(SweepCommand::Cancel));
        }
        return;
    }
    for line in sweep.status_lines() {
        ui.add(Label::new(line).wrap());
    }
    if let Some(why) = session.sweep.problem() {
        notice_ui(ui, Severity::Error, why);
    }
    ui.horizontal_wrapped(|ui| {
        let is_complete = sweep.n_missing() == 0;
        let label = if sweep.has_begun() { "Go on" } else { "Start" };
        let start = ui.add_enabled(view.folder.is_some() && !is_complete, Button::new(label));
        let why = match is_complete {
            true => "All chunks are there",
            false => "Choose the folder first",
        };
        if start.on_disabled_hover_text(why).clicked() {
            commands.push(Command::Sweep(SweepCommand::Start));
        }
        let merge = ui.add_enabled(is_complete, Button::new("Merge…"));
        let merge = merge.on_disabled_hover_text("Chunks are missing");
        if merge.on_hover_text("One table of all rows, checked").clicked() {
            commands.push(Command::Ask(Purpose::Save(Output::SweepRows)));
        }
        let look = ui.button("Look again");
        if look.on_hover_text("What the folder holds now, if others compute into it").clicked() {
            commands.push(Command::Sweep(SweepCommand::Look));
        }
    });
}
