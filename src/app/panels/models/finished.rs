//! What has been finished and is kept: models, comparisons and evaluations, the latest first.

use egui::{Frame, Ui};

use crate::app::archive::{
    ArchiveEntry, ArchiveFolder, ArchiveProblem, ArchiveStatus, LIMIT_BYTES, ModelsDialog, Removal,
    StoredFact, bytes_text, how_it_was_made,
};
use crate::app::command::{Command, ModelsCommand};
use crate::app::dialog::Purpose;
use crate::app::network::Network;
use crate::app::output::Output;
use crate::app::panes::PaneContext;
use crate::app::project::Project;
use crate::app::widgets::{facts_ui, notice_in_row_ui, notice_ui, severity_color, working_ui};
use impactlab_core::data::Severity;
use impactlab_core::units::UnitSystem;
use impactlab_study::facts::Term;

/// Number of figures that are shown of an entry without unfolding it.
const N_MAIN_FIGURES: usize = 4;

/// Draws how much is kept where, what is damaged, and the entries.
pub fn finished_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, session, commands, .. } = pane;
    let archive = &session.archive;
    let Some(folder) = archive.folder() else {
        ui.weak("This window has no folder of its own and keeps nothing: save what you need.");
        return;
    };
    summary_ui(ui, archive);
    for problem in &archive.list.problems {
        problem_ui(ui, problem, commands);
    }
    for entry in &archive.list.entries {
        Frame::group(ui.style()).show(ui, |ui| {
            ui.set_width(ui.available_width());
            entry_ui(ui, entry, project, folder, commands);
        });
    }
    if archive.list.entries.is_empty() && !archive.is_reading() {
        ui.weak("What a training, a comparison or an evaluation gives is kept here when it ends.");
    }
}

fn summary_ui(ui: &mut Ui, archive: &ArchiveStatus) {
    if archive.is_reading() {
        return working_ui(ui, "reading what is kept");
    }
    let (n, bytes) = (archive.list.entries.len(), archive.bytes());
    let limit = bytes_text(LIMIT_BYTES);
    if bytes > LIMIT_BYTES {
        let text = format!(
            "{n} kept, {}: more than {limit}. Nothing is removed by itself; remove what you do not need.",
            bytes_text(bytes)
        );
        notice_ui(ui, Severity::Warning, text);
    } else if n > 0 {
        ui.weak(format!(
            "{n} kept, {} of {limit}; nothing is removed by itself.",
            bytes_text(bytes)
        ));
    }
}

fn problem_ui(ui: &mut Ui, problem: &ArchiveProblem, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        notice_in_row_ui(ui, Severity::Error, format!("Cannot be used: {}", problem.reason));
        if let Some(first) = problem.files.first()
            && ui.small_button("Remove…").clicked()
        {
            let name = first.display().to_string();
            let what = "It cannot be used. Its files are removed from the disk.".to_owned();
            let removal = Removal { name, what, files: problem.files.clone() };
            commands.push(Command::Models(ModelsCommand::Ask(ModelsDialog::Remove(removal))));
        }
    });
}

fn entry_ui(
    ui: &mut Ui,
    entry: &ArchiveEntry,
    project: &Project,
    folder: &ArchiveFolder,
    commands: &mut Vec<Command>,
) {
    let path = folder.path_of(entry);
    let wanted = match entry.kind.network() {
        Some(Network::Force) => project.predict_force.model.path(),
        Some(Network::Response) => project.predict_motion.response_model.path(),
        None => None,
    };
    let is_in_use = wanted == Some(path.as_path());
    ui.horizontal_wrapped(|ui| {
        ui.strong(&entry.name);
        if is_in_use {
            ui.colored_label(severity_color(ui, Severity::Info), "in use");
        }
        if entry.is_cancelled {
            ui.colored_label(severity_color(ui, Severity::Warning), "cancelled");
        }
        let (kind, moment) = (entry.kind.label(), entry.finished_text());
        ui.weak(format!("{kind}, {moment}, {}", bytes_text(entry.bytes)));
    });
    ui.horizontal_wrapped(|ui| {
        ui.label(format!("{}; data {}", how_it_was_made(&entry.question), entry.data));
    });
    ui.horizontal_wrapped(|ui| {
        let text = |fact: &StoredFact| format!("{} {}", fact.label, fact.text);
        let main: Vec<String> = entry.figures.iter().take(N_MAIN_FIGURES).map(text).collect();
        ui.weak(main.join(" · "));
    });
    ui.horizontal_wrapped(|ui| buttons_ui(ui, entry, is_in_use, folder, commands));
    let id = ("kept", &entry.sha256);
    egui::CollapsingHeader::new("Figures and settings").id_salt(id).show(ui, |ui| {
        let lists = [(Term::Figures, &entry.figures), (Term::UnusualSettings, &entry.settings)];
        let lists = lists.into_iter().filter(|(_, facts)| !facts.is_empty());
        let tables: Vec<_> = lists.map(|(title, facts)| StoredFact::table(title, facts)).collect();
        facts_ui(ui, &entry.name, &tables, UnitSystem::default());
        if entry.settings.is_empty() {
            ui.weak("The usual settings");
        }
        ui.weak(format!("SHA-256 {}, program {}", entry.sha256, entry.program));
        ui.weak(path.display().to_string());
    });
}

fn buttons_ui(
    ui: &mut Ui,
    entry: &ArchiveEntry,
    is_in_use: bool,
    folder: &ArchiveFolder,
    commands: &mut Vec<Command>,
) {
    let path = folder.path_of(entry);
    match entry.kind.network() {
        Some(network) => {
            if ui.add_enabled(!is_in_use, egui::Button::new("Use")).clicked() {
                commands.push(Command::UseModel(network, Some(path.clone())));
            }
            if ui.button("Save as…").clicked() {
                commands.push(Command::Ask(Purpose::Save(Output::Archived(network, path))));
            }
        }
        None => {
            if ui.button("Open again").clicked() {
                commands.push(Command::Models(ModelsCommand::Open(Box::new(entry.clone()))));
            }
        }
    }
    if ui.button("Rename…").clicked() {
        let dialog =
            ModelsDialog::Rename { entry: Box::new(entry.clone()), name: entry.name.clone() };
        commands.push(Command::Models(ModelsCommand::Ask(dialog)));
    }
    let remove = ui.add_enabled(!is_in_use, egui::Button::new("Remove…"));
    if remove.on_disabled_hover_text("It is in use: use another model first").clicked() {
        let dialog = ModelsDialog::remove_entry(entry, folder);
        commands.push(Command::Models(ModelsCommand::Ask(dialog)));
    }
}
