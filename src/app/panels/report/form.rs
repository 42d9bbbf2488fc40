//! The “Report” pane: how the report is written, its sections, and its files.

use std::sync::Arc;

use egui::{ComboBox, Grid, Label, ProgressBar, RichText, ScrollArea, TextEdit, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::looks::{self, Icon, icon_button};
use crate::app::output::Output;
use crate::app::panes::PaneContext;
use crate::app::report::{MadeReport, ReportCommand, ReportView};
use crate::app::state::Session;
use crate::app::tasks::TaskKey;
use crate::app::widgets::{notice_ui, problem_line_ui, with_time_left};
use impactlab_core::data::Severity;
use impactlab_core::units::UnitSystem;
use impactlab_document::report::{Language, Paper};
use impactlab_study::case_file::Expert;

/// Languages with their names in themselves.
const LANGUAGES: [(Language, &str); 2] = [(Language::En, "English"), (Language::De, "Deutsch")];
/// Sizes of pages.
const PAPERS: [(Paper, &str); 2] = [(Paper::A4, "A4"), (Paper::Letter, "Letter")];

/// Draws the settings, the button that makes the report, and its sections.
pub fn report_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { view, session, expert, commands, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        settings_ui(ui, &mut view.report, view.units);
        ui.add_space(looks::PART);
        expert_ui(ui, expert);
        ui.add_space(looks::PART);
        run_ui(ui, session, &view.report, commands);
        let Some(made) = &session.report.made else { return };
        ui.add_space(looks::PART);
        made_ui(ui, made, session.report.is_outdated, commands);
    });
}

fn settings_ui(ui: &mut Ui, view: &mut ReportView, units: UnitSystem) {
    Grid::new("report settings").num_columns(2).show(ui, |ui| {
        ui.label("Language");
        choice_ui(ui, "report language", &mut view.language, &LANGUAGES);
        ui.end_row();
        ui.label("Pages");
        let before = view.pages.unwrap_or_else(|| Paper::usual(units));
        let mut pages = before;
        choice_ui(ui, "report paper", &mut pages, &PAPERS);
        if pages != before {
            view.pages = Some(pages);
        }
        ui.end_row();
        ui.label("Units");
        let name = match units {
            UnitSystem::Si => "SI",
            UnitSystem::Us => "US",
        };
        ui.label(name).on_hover_text("Those of the window: SI or US at the right of the menu");
        ui.end_row();
        let name = ui.label("Date");
        let date = TextEdit::singleline(&mut view.date).hint_text("today").desired_width(96.0);
        ui.add(date)
            .labelled_by(name.id)
            .on_hover_text("YYYY-MM-DD; the same case, files and date give the same bytes");
        ui.end_row();
    });
    problem_line_ui(ui, view.report_date().err().as_deref());
    ui.checkbox(&mut view.shown_variant_only, "Only the variant that is shown")
        .on_hover_text("Otherwise the report tells of all variants of the case");
}

/// Draws the fields for who gives the opinion, and for whom; an empty one says nothing.
fn expert_ui(ui: &mut Ui, expert: &mut Expert) {
    let Expert { name, qualifications, instruction } = expert;
    let fields =
        [("Expert", name), ("Qualifications", qualifications), ("Instruction", instruction)];
    for (label, text) in fields {
        let label = ui.label(label);
        let mut typed = text.clone().unwrap_or_default();
        if ui.text_edit_singleline(&mut typed).labelled_by(label.id).changed() {
            *text = (!typed.is_empty()).then_some(typed);
        }
    }
}

fn choice_ui<T: Copy + PartialEq>(ui: &mut Ui, id: &str, chosen: &mut T, all: &[(T, &str)]) {
    let name = all.iter().find(|(of, _)| of == chosen).map_or("", |(_, name)| *name);
    ComboBox::from_id_salt(id).width(96.0).selected_text(name).show_ui(ui, |ui| {
        for (of, name) in all {
            ui.selectable_value(chosen, *of, *name);
        }
    });
}

/// Draws the button that makes the report, or its progress.
fn run_ui(ui: &mut Ui, session: &Session, view: &ReportView, commands: &mut Vec<Command>) {
    let report = &session.report;
    if let Some((progress, left)) = session.tasks.progress(&TaskKey::Report) {
        match progress.fraction() {
            Some(fraction) => drop(ui.add(ProgressBar::new(fraction).show_percentage())),
            None => drop(ui.spinner()),
        }
        let text = with_time_left(&progress.message, left);
        ui.add(Label::new(RichText::new(text).weak()).wrap());
        if ui.add(icon_button(Icon::X, "Cancel")).clicked() {
            commands.push(Command::Report(ReportCommand::Cancel));
        }
        return;
    }
    let label = if report.made.is_some() { "Make again" } else { "Make the report" };
    let is_possible = !report.asks_nothing && view.report_date().is_ok();
    let button = ui.add_enabled(is_possible, icon_button(Icon::FileText, label));
    let button = button.on_hover_text("Asks every question of the case and lays out the answers");
    if button.on_disabled_hover_text("There is nothing to report, or the date is none").clicked() {
        commands.push(Command::Report(ReportCommand::Make));
    }
    if report.asks_nothing {
        ui.add(
            Label::new(
                "This case asks nothing yet. Set up a scenario in Case, or enter evidence in \
                 Reconstruct; the report tells of every question that the case asks.",
            )
            .wrap(),
        );
    }
    if let Some(problem) = &report.problem {
        notice_ui(ui, Severity::Error, problem);
    }
}

/// Draws what there is to say of a report, the button that saves it, and its sections.
fn made_ui(ui: &mut Ui, made: &Arc<MadeReport>, is_outdated: bool, commands: &mut Vec<Command>) {
    if is_outdated {
        notice_ui(
            ui,
            Severity::Warning,
            "The case or these settings were changed, or a file was opened again, after this report was made: make it again to save it",
        );
    }
    let unanswered = match made.n_unanswered {
        0 => None,
        1 => Some("A question of the case has no answer".to_owned()),
        n => Some(format!("{n} questions of the case have no answer")),
    };
    for text in unanswered.into_iter().chain(made.changes.iter().map(ToString::to_string)) {
        notice_ui(ui, Severity::Warning, text);
    }
    let save = ui.add_enabled(!is_outdated, icon_button(Icon::Save, "Save…"));
    let save = save.on_hover_text("As PDF, Markdown or JSON, by the ending of the name");
    if save.on_disabled_hover_text("It is not of the case as it is").clicked() {
        commands.push(Command::Ask(Purpose::Save(Output::Report(Arc::clone(&made.document)))));
    }
    ui.add_space(looks::PART);
    ui.strong("Sections");
    for section in &made.document.sections {
        if ui.add(egui::Button::new(&section.title).frame(false).wrap()).clicked() {
            commands.push(Command::Report(ReportCommand::ShowSection(section.kind)));
        }
    }
}
