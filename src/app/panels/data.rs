//! The “Data” pane: the open data sets with their problems, the open single files, and the
//! scenario.

use std::path::{Path, PathBuf};

use egui::{CollapsingHeader, Id, Response, RichText, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::looks::{Icon, icon_button};
use crate::app::panels::replay::replay_button_ui;
use crate::app::panes::PaneContext;
use crate::app::project::Project;
use crate::app::shipped_datasets;
use crate::app::source::{Content, Source};
use crate::app::state::{Subject, View};
use crate::app::widgets::{notice_ui, severity_color, working_ui};
use impactlab_core::data::{DatasetKind, FileKind, Severity};
use impactlab_core::error_chain;
use impactlab_study::{CheckedDataset, CheckedFile, word};

/// Largest number of problems of one data set that are listed; of further ones the number is shown.
const SHOWN_PROBLEMS: usize = 50;

/// Draws the buttons that open data, and below them the tree of everything that is open.
pub fn data_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    ui.horizontal(|ui| {
        let folder = ui
            .add(icon_button(Icon::FolderOpen, "Open folder…"))
            .on_hover_text("A data set, or a folder of data sets");
        if folder.clicked() {
            commands.push(Command::Ask(Purpose::Folder));
        }
        let files = ui.add(icon_button(Icon::File, "Open files…"));
        if files.on_hover_text("Force, trajectory, steer or scenario files").clicked() {
            commands.push(Command::Ask(Purpose::Files));
        }
    });
    let field = egui::TextEdit::singleline(&mut session.typed_path);
    let hint = "or type a path and press Enter";
    let typed = ui.add(field.hint_text(hint).desired_width(f32::INFINITY));
    if typed.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter)) {
        let path = std::mem::take(&mut session.typed_path);
        if !path.trim().is_empty() {
            commands.push(Command::Open(vec![path.trim().into()]));
        }
    }
    ui.separator();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        if session.sources.is_empty() {
            ui.label("Nothing is open. Open a folder with cases.csv and forces/ or trajectories/, or drop it anywhere in this window.");
            if let Some(path) = shipped_datasets()
                && ui.button("Open the shipped data").clicked()
            {
                commands.push(Command::Open(vec![path]));
            }
        }
        for source in &session.sources {
            source_ui(ui, source, project, view, commands);
        }
        let selected = project.subject() == Some(Subject::Scenario);
        let hint = "Two vehicles of your own: see the Scenario pane";
        if ui.selectable_label(selected, "Scenario").on_hover_text(hint).clicked() {
            commands.push(Command::Select(Subject::Scenario));
        }
    });
}

/// Draws the entry of one opened path according to its state: loading, data set, file, or not
/// readable.
fn source_ui(
    ui: &mut Ui,
    source: &Source,
    project: &Project,
    view: &View,
    commands: &mut Vec<Command>,
) {
    match &source.content {
        Content::Loading => {
            working_ui(ui, source.name());
        }
        Content::Dataset(checked) => {
            let listed = view.listed.as_ref() == Some(&source.path);
            dataset_ui(ui, source, checked, listed, commands);
        }
        Content::File(file) => {
            let subject = Subject::File(source.path.clone());
            let selected = project.subject().as_ref() == Some(&subject);
            file_ui(ui, source, file, selected, commands);
        }
        Content::Failed(why) => {
            let color = severity_color(ui, Severity::Error);
            let header = RichText::new(format!("{} (not read)", source.name())).color(color);
            let header = CollapsingHeader::new(header).id_salt(&source.path);
            let response = header.show(ui, |ui| {
                ui.label(why);
                let can_map = source.path.extension().is_some();
                if can_map && ui.button("Say which column is which…").clicked() {
                    commands.push(Command::AskMapping(source.path.clone()));
                }
                if can_map {
                    replay_button_ui(ui, &source.path, commands);
                }
            });
            source_menu(&response.header_response, source, commands);
        }
    }
}

/// Scrolls to the data set that is listed when it becomes another one, such as one that was just opened.
fn show_once(ui: &Ui, entry: &Response, path: &Path) {
    let id = Id::unique("the data set in view");
    let is_other = ui.data_mut(|data| {
        let before = data.get_temp_mut_or_default::<PathBuf>(id);
        let is_other = before.as_path() != path;
        *before = path.to_owned();
        is_other
    });
    if is_other {
        entry.scroll_to_me(None);
    }
}

/// Draws a data set with its flags, its vehicle file and its problems.
///
/// - `listed`: whether its cases are shown in the case table.
fn dataset_ui(
    ui: &mut Ui,
    source: &Source,
    checked: &CheckedDataset,
    listed: bool,
    commands: &mut Vec<Command>,
) {
    let dataset = &checked.dataset;
    let kind = match dataset.kind {
        DatasetKind::Force => "force curves",
        DatasetKind::Trajectory => "trajectories",
    };
    let text = format!("{} · {} {kind}", source.name(), dataset.cases.len());
    let response = ui.selectable_label(listed, text);
    let response = response.on_hover_text(source.path.display().to_string());
    if listed {
        show_once(ui, &response, &source.path);
    }
    if response.clicked() {
        commands.push(Command::List(source.path.clone()));
    }
    source_menu(&response, source, commands);
    let flagged = checked.flags.iter().filter(|flags| !flags.is_empty()).count();
    if flagged == 0 && checked.vehicle.is_none() && dataset.problems.is_empty() {
        return;
    }
    ui.indent(&source.path, |ui| {
        if flagged > 0 {
            ui.weak(format!("{flagged} cases with flags"));
        }
        match &checked.vehicle {
            Some(Ok(vehicle)) => drop(ui.weak(format!("vehicle: {vehicle}"))),
            Some(Err(error)) => drop(notice_ui(ui, Severity::Error, error)),
            None => {}
        }
        let problems = &dataset.problems;
        if !problems.is_empty() {
            let title = format!("{} problems", problems.len());
            CollapsingHeader::new(title).id_salt((&source.path, "problems")).show(ui, |ui| {
                for problem in problems.iter().take(SHOWN_PROBLEMS) {
                    notice_ui(ui, Severity::Error, error_chain(problem));
                }
                if problems.len() > SHOWN_PROBLEMS {
                    let n_more = problems.len() - SHOWN_PROBLEMS;
                    ui.weak(format!("and {n_more} more, which impactlab check lists"));
                }
            });
        }
    });
}

/// Draws a single file with its flags. Hovering over it shows how its columns were read.
///
/// - `selected`: whether the file is the selected subject.
fn file_ui(
    ui: &mut Ui,
    source: &Source,
    file: &CheckedFile,
    selected: bool,
    commands: &mut Vec<Command>,
) {
    let kind = word(&file.loaded.kind);
    let n_samples = file.loaded.series.n_samples();
    let response =
        ui.selectable_label(selected, format!("{} · {kind}, {n_samples} samples", source.name()));
    let response = response.on_hover_ui(|ui| {
        ui.label(source.path.display().to_string());
        for column in &file.loaded.columns {
            ui.label(format!(
                "{} ← {:?} in {}",
                column.channel.label(),
                column.name,
                column.unit.symbol
            ));
        }
        for note in &file.loaded.notes {
            ui.label(note.to_string());
        }
    });
    if response.clicked() {
        commands.push(Command::Select(Subject::File(source.path.clone())));
    }
    source_menu(&response, source, commands);
    if file.loaded.kind == FileKind::Steer {
        ui.indent((&source.path, "replay"), |ui| replay_button_ui(ui, &source.path, commands));
    }
    for flag in &file.flags {
        let text = flag.to_string();
        ui.indent((&source.path, &text), |ui| notice_ui(ui, flag.severity, &text));
    }
}

/// Adds the context menu with which a data set or a file is loaded again or closed.
fn source_menu(response: &Response, source: &Source, commands: &mut Vec<Command>) {
    response.context_menu(|ui| {
        if source.path.is_absolute() || source.path.components().count() > 0 {
            let is_file = matches!(source.content, Content::File(_) | Content::Failed(_));
            if is_file && ui.button("Columns…").clicked() {
                commands.push(Command::AskMapping(source.path.clone()));
            }
            if is_file {
                replay_button_ui(ui, &source.path, commands);
            }
            if ui.button("Load again").clicked() {
                commands.push(Command::Open(vec![source.opened.clone()]));
            }
            if ui.button("Close").clicked() {
                commands.push(Command::Close(source.path.clone()));
            }
        }
    });
}
