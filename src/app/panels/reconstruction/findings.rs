//! What the answer says beside the speeds: which courses of events the evidence leaves possible, and
//! what further evidence would bring.

use egui::Ui;
use impactlab_core::uncertainty::Caveats;

use crate::app::command::Command;
use crate::app::looks;
use crate::app::reconstruction::ReconstructionCommand;
use crate::app::widgets::{facts_ui, figure_frame};
use impactlab_core::units::{NumberFormat, UnitSystem};
use impactlab_document::figure::budget_figure;
use impactlab_draw::FigureOptions;
use impactlab_reconstruct::BudgetItem;
use impactlab_study::{ReconstructAnswer, ReconstructReport};

/// Height of a bar of the budget, and of its axis and heading, points.
const BAR_HEIGHT: f32 = 24.0;
const AXIS_HEIGHT: f32 = 70.0;

/// Draws the courses of events with their probabilities. A click shows one of them alone in the scene.
///
/// - `shown`: the one that is shown alone.
pub fn modes_ui(
    ui: &mut Ui,
    report: &ReconstructReport,
    shown: Option<usize>,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    heading(ui, "Courses of events");
    for (idx, mode) in report.modes.iter().enumerate() {
        let format = NumberFormat::english(units);
        ui.horizontal(|ui| {
            let chance = format.chance(mode.probability, Some(mode.standard_error));
            ui.strong(chance).on_hover_text("One standard error");
            if let Some(speed) = mode.quantities.first() {
                let text = format.drawn_in_words(speed.quantity(), &speed.estimate);
                let car = if report.kind.is_collision() { "struck car" } else { "car" };
                ui.label(format!("{car} {text}")).on_hover_text("Median and 90 %");
            }
        });
        let is_shown = shown == Some(idx);
        let name = egui::Button::selectable(is_shown, mode.name.as_str()).wrap();
        if ui.add(name).on_hover_text("Show it alone in the scene").clicked() {
            let mode = (!is_shown).then_some(idx);
            commands.push(Command::Reconstruct(ReconstructionCommand::ShowMode(mode)));
        }
    }
}

/// Draws what further measurements would bring, as bars and as a table.
pub fn budget_ui(
    ui: &mut Ui,
    answer: &ReconstructAnswer,
    caveats: &Caveats,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    heading(ui, "What further evidence would bring");
    let mut items: Vec<&BudgetItem> =
        answer.report.budget.iter().filter(|item| item.believable).collect();
    if items.is_empty() {
        ui.weak("There are too few particles to say.");
        return;
    }
    items.sort_by(|a, b| a.then_m_s.total_cmp(&b.then_m_s));
    let figure = budget_figure(answer, caveats, units);
    let options = FigureOptions {
        id: "budget".to_owned(),
        height: Some(AXIS_HEIGHT + BAR_HEIGHT * items.len() as f32),
        ..FigureOptions::default()
    };
    let title = match answer.report.kind.is_collision() {
        true => "Half of the 90 % interval of the struck car's speed",
        false => "Half of the 90 % interval of the speed",
    };
    figure_frame(ui, title, &figure, &options, commands);
    facts_ui(ui, "budget", answer.report.budget_table().as_slice(), units);
}

fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(looks::PART);
    ui.separator();
    ui.strong(text);
}
