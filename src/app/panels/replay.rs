//! The “Replay” pane: how the record of an event data recorder is followed, and what the car did by it up to the
//! first contact.

use std::path::Path;

use egui::{Button, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::looks::{self, Icon, icon_button};
use crate::app::model::file_name;
use crate::app::panels::faded_if;
use crate::app::panels::replay_form::settings_ui;
use crate::app::panes::PaneContext;
use crate::app::question_job::QuestionJob;
use crate::app::recorder::RecorderCommand;
use crate::app::source::{Content, Source};
use crate::app::widgets::{
    empty_ui, facts_ui, figure_frame, notice_ui, replay_assumptions_ui, restrictions_ui,
    run_progress_ui,
};
use impactlab_core::collision::Role;
use impactlab_core::data::Severity;
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{ReplayCurve, replay_curve_figure, replay_path_figure};
use impactlab_draw::FigureOptions;
use impactlab_study::{Answer, ReplayReport, ReplayRequest};

/// What the buttons say that ask for a replay.
pub(in crate::app) const REPLAY: &str = "Replay it with this car";

/// What is said of an answer to another question.
const OUTDATED: &str = "The settings were changed since the last run: Replay again";

/// Heights of the plots, points.
const PATH_HEIGHT: f32 = 260.0;
const CURVE_HEIGHT: f32 = 200.0;

/// Draws the settings of the replay, its run and its answer.
pub fn replay_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    let of_pane = Role::ALL.map(|role| (role, project.chosen_vehicle(role).into_owned()));
    let asked = &mut project.replay;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let Some(request) = &mut *asked else { return start_ui(ui, &session.sources, commands) };
        let is_removed = file_ui(ui, request, commands);
        settings_ui(ui, request, &of_pane, view.units);
        run_ui(ui, request, &session.recorder_replay, commands);
        ui.add_space(looks::PART);
        answer_ui(ui, request, &session.recorder_replay, view.units, session.fit_plots, commands);
        if is_removed {
            *asked = None;
        }
    });
}

/// Draws the button that asks for the replay of a file with the struck car.
pub(super) fn replay_button_ui(ui: &mut Ui, path: &Path, commands: &mut Vec<Command>) {
    let hint = "Follow speed and steering wheel of a recorder up to the first contact, with the struck car";
    if ui.button(REPLAY).on_hover_text(hint).clicked() {
        commands.push(asks_for(path));
    }
}

fn asks_for(path: &Path) -> Command {
    let (path, event, car) = (path.to_owned(), None, Role::Struck);
    Command::Recorder(RecorderCommand::Replay { path, event, car })
}

/// Says what is needed, and offers the files that are open.
fn start_ui(ui: &mut Ui, sources: &[Source], commands: &mut Vec<Command>) {
    let needs = "By the speed and the steering wheel of its event data recorder: how it met the other car, its way \
                 there, and where it came from. Needed: a Bosch CDR report as CSV, or a table with Time [s], Speed \
                 [km/h] and Steering Wheel Angle [deg], in which time 0 is the crash; a yaw rate and the brake \
                 switch are used if they are there.";
    empty_ui(ui, "What did a car do before the contact?", needs);
    ui.add_space(looks::PART);
    if ui.add(icon_button(Icon::FolderOpen, "Open a recorder's file…")).clicked() {
        commands.push(Command::Ask(Purpose::Files));
    }
    let is_file = |of: &&Source| matches!(of.content, Content::File(_) | Content::Failed(_));
    let files: Vec<&Source> = sources.iter().filter(is_file).collect();
    if !files.is_empty() {
        ui.label("Or one of the open files:");
    }
    for source in files {
        let button = ui.button(file_name(&source.path));
        if button.on_hover_text(source.path.display().to_string()).clicked() {
            commands.push(asks_for(&source.path));
        }
    }
}

/// Draws the name of the file.
///
/// - returns whether the replay is to be removed.
fn file_ui(ui: &mut Ui, request: &ReplayRequest, commands: &mut Vec<Command>) -> bool {
    ui.horizontal_wrapped(|ui| {
        ui.strong(file_name(&request.recorder))
            .on_hover_text(request.recorder.display().to_string());
        if ui.button("Open…").on_hover_text("Open another recorder's file").clicked() {
            commands.push(Command::Ask(Purpose::Files));
        }
        let remove = ui.add(Button::new("Remove").small());
        remove.on_hover_text("The case asks for no replay any more").clicked()
    })
    .inner
}

/// Draws the button that starts the run, its progress, and why there is no answer.
fn run_ui(
    ui: &mut Ui,
    request: &ReplayRequest,
    run: &QuestionJob<ReplayRequest>,
    commands: &mut Vec<Command>,
) {
    ui.horizontal(|ui| {
        let Some(job) = run.job() else {
            if ui.add(icon_button(Icon::Play, "Replay")).clicked() {
                commands.push(Command::Recorder(RecorderCommand::RunReplay));
            }
            return;
        };
        let cancel = ui.add_enabled(!job.is_cancelled(), Button::new("Cancel"));
        if cancel.on_hover_text("The last answer is kept").clicked() {
            commands.push(Command::Recorder(RecorderCommand::CancelReplay));
        }
        let progress = job.progress();
        run_progress_ui(ui, &progress.message, progress.fraction(), job.time_left());
    });
    let is_asked = run.latest.as_ref().is_some_and(|latest| latest.question == *request);
    if let Some(problem) = run.problem().filter(|_| is_asked) {
        notice_ui(ui, Severity::Error, format!("Not replayed: {problem}"));
    }
}

/// Draws the answer, greyed if it is not of what is asked now.
fn answer_ui(
    ui: &mut Ui,
    request: &ReplayRequest,
    run: &QuestionJob<ReplayRequest>,
    units: UnitSystem,
    fits: bool,
    commands: &mut Vec<Command>,
) {
    let (Some(answer), Some(latest)) = (run.ok(), &run.latest) else { return };
    let is_outdated = latest.question != *request;
    if is_outdated && !run.is_running() {
        notice_ui(ui, Severity::Warning, OUTDATED);
    }
    let report = &answer.report;
    faded_if(ui, is_outdated, |ui| {
        restrictions_ui(ui, &report.caveats, units);
        facts_ui(ui, &report.name, &report.facts(), units);
        replay_assumptions_ui(ui, &report.caveats, units, commands);
        figures_ui(ui, report, is_outdated, (units, fits), commands);
    });
}

/// Draws the path, and what was recorded beside what was replayed.
fn figures_ui(
    ui: &mut Ui,
    report: &Answer<ReplayReport>,
    is_outdated: bool,
    (units, fits): (UnitSystem, bool),
    commands: &mut Vec<Command>,
) {
    let caveats = report.caveats.in_units(units).outdated_if(is_outdated);
    let options = |id: &str, height: f32| FigureOptions {
        id: format!("replay {id}"),
        height: Some(height),
        reset: fits,
        ..FigureOptions::default()
    };
    ui.add_space(looks::PART);
    let path = replay_path_figure(report, units).with_caveats(&caveats);
    figure_frame(ui, "From above", &path, &options("path", PATH_HEIGHT), commands);
    for curve in ReplayCurve::ALL {
        ui.add_space(looks::PART);
        let figure = replay_curve_figure(report, curve, units).with_caveats(&caveats);
        figure_frame(ui, curve.label(), &figure, &options(curve.label(), CURVE_HEIGHT), commands);
    }
}
