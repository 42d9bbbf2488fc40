//! The rows that show which model of a network is in use and with which the user opens, saves or
//! trains another one.

use egui::{RichText, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::model::ModelStatus;
use crate::app::network::TrainedModel;
use crate::app::output::Output;
use crate::app::widgets::{empty_ui, notice_ui, severity_color, working_ui};
use impactlab_core::data::Severity;
use impactlab_study::MODEL_ENDING;
use impactlab_study::ModelChoice;

/// Draws the state of a network that has no model: a note while one is loaded, otherwise buttons to
/// open a model, to use the shipped one, or to train one.
///
/// - `use_of_it`: a sentence that tells what a model of this network does.
pub fn no_model_ui<M: TrainedModel>(
    ui: &mut Ui,
    model: &ModelStatus<M>,
    use_of_it: &str,
    commands: &mut Vec<Command>,
) {
    let name = M::NETWORK.model();
    if model.is_loading() {
        return working_ui(ui, format!("Loading the {name}…"));
    }
    let text = format!(
        "{use_of_it} Open one (a file ending in .{MODEL_ENDING}), or train one on data of your own."
    );
    empty_ui(ui, format!("No {name}"), text);
    if let Some(problem) = &model.problem {
        notice_ui(ui, Severity::Warning, problem);
    }
    ui.horizontal_wrapped(|ui| {
        if ui.button("Open model…").clicked() {
            commands.push(Command::Ask(Purpose::OpenModel));
        }
        if ui.button("Use the shipped model").clicked() {
            commands.push(Command::UseModel(M::NETWORK, None));
        }
        if ui.button("Train a model").clicked() {
            commands.push(Command::ShowTraining(M::NETWORK));
        }
    });
}

/// Draws the name of the current model, with buttons to open another model, to save the current
/// one, and to return to the shipped one. Without a current model it draws nothing.
///
/// - `hint`: description of how the model was trained, shown on hover.
pub fn model_row_ui<M: TrainedModel>(
    ui: &mut Ui,
    model: &ModelStatus<M>,
    hint: &str,
    commands: &mut Vec<Command>,
) {
    let Some(current) = &model.current else { return };
    ui.horizontal_wrapped(|ui| {
        ui.strong("Model").on_hover_text(hint);
        ui.label(&current.name).on_hover_text(hint);
        if !current.is_saved {
            ui.weak("(not saved)");
        }
        if ui.small_button("Open…").on_hover_text("Another model").clicked() {
            commands.push(Command::Ask(Purpose::OpenModel));
        }
        if ui.small_button("Save…").clicked() {
            commands.push(Command::Ask(Purpose::Save(Output::Model(M::NETWORK))));
        }
        if current.choice != ModelChoice::default() && ui.small_button("Shipped").clicked() {
            commands.push(Command::UseModel(M::NETWORK, None));
        }
    });
    if let Some(problem) = &model.problem {
        notice_ui(ui, Severity::Error, format!("Not opened: {problem}"));
    }
}

/// Draws the row of the current model for the training pane. In addition to the buttons, it has a
/// text field for the path, for systems without file dialogs, and it offers the model of a
/// training that is not in use.
pub fn save_model_ui<M: TrainedModel>(
    ui: &mut Ui,
    model: &mut ModelStatus<M>,
    commands: &mut Vec<Command>,
) {
    if let Some(set_aside) = &model.set_aside {
        ui.horizontal_wrapped(|ui| {
            ui.label(format!("Not in use, of the last training: {}", set_aside.name));
            let hint = "Answer by it from now on; otherwise the model before stays in use";
            if ui.button("Use it").on_hover_text(hint).clicked() {
                commands.push(Command::UseTrained(M::NETWORK));
            }
        });
    }
    let Some(current) = &model.current else { return };
    ui.horizontal_wrapped(|ui| {
        ui.strong("Model");
        let text = RichText::new(&current.name);
        ui.label(if current.is_saved { text } else { text.italics() });
        if !current.is_saved {
            ui.colored_label(severity_color(ui, Severity::Warning), "not saved");
        }
        if ui.button("Open model…").clicked() {
            commands.push(Command::Ask(Purpose::OpenModel));
        }
        if ui.button("Save model…").clicked() {
            commands.push(Command::Ask(Purpose::Save(Output::Model(M::NETWORK))));
        }
        let field = egui::TextEdit::singleline(&mut model.typed_path).desired_width(240.0);
        let typed = ui.add(field.hint_text("or type a path and press Enter"));
        if typed.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter)) {
            let path = std::mem::take(&mut model.typed_path);
            if !path.trim().is_empty() {
                let path = std::path::PathBuf::from(path.trim());
                let has_ending = path.extension().is_some();
                let path = if has_ending { path } else { path.with_extension(MODEL_ENDING) };
                commands.push(Command::Write(Output::Model(M::NETWORK), path));
            }
        }
    });
}
