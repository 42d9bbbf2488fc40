//! What the answer says beside the speeds: how well each item of the evidence is explained, which courses
//! of events it leaves possible, and what further evidence would bring.

use egui::{Grid, Ui};
use impactlab_core::uncertainty::Caveats;

use crate::app::command::Command;
use crate::app::looks::{self, Icon};
use crate::app::reconstruction::ReconstructionCommand;
use crate::app::widgets::figure_frame;
use impactlab_core::data::Severity;
use impactlab_core::units::{Quantity, UnitSystem, significant};
use impactlab_document::figure::budget_figure;
use impactlab_draw::{FigureOptions, theme};
use impactlab_reconstruct::{BudgetItem, EvidenceFit};
use impactlab_study::{ReconstructAnswer, ReconstructReport};

/// Height of a bar of the budget, and of its axis and heading, points.
const BAR_HEIGHT: f32 = 24.0;
const AXIS_HEIGHT: f32 = 70.0;

/// Draws what is expected and what was found of each item of the evidence. An item that nothing explains
/// is named with an icon and a word.
pub fn fit_ui(ui: &mut Ui, fit: &[EvidenceFit]) {
    heading(ui, "What each piece of evidence says");
    Grid::new("fit").striped(true).num_columns(5).show(ui, |ui| {
        let of_p = format!(
            "Probability of errors larger than these; below {} the item is unexplained",
            EvidenceFit::UNEXPLAINED_BELOW
        );
        for (title, hint) in [
            ("evidence", ""),
            ("expected", "Median over the particles of what would be found"),
            ("found", "What was found, or how far it lies off"),
            ("p", of_p.as_str()),
            ("", ""),
        ] {
            ui.strong(title).on_hover_text(hint);
        }
        ui.end_row();
        for item in fit {
            let label = match item.unit {
                "" => item.evidence.clone(),
                unit => format!("{} [{unit}]", item.evidence),
            };
            ui.label(label);
            ui.monospace(significant(item.expected));
            ui.monospace(significant(item.found));
            ui.monospace(format!("{:.3}", item.p));
            if item.is_unexplained() {
                let color = theme::severity_color(Severity::Warning, ui.visuals().dark_mode);
                ui.horizontal(|ui| {
                    looks::icon_ui(ui, Icon::TriangleAlert, color);
                    ui.colored_label(color, "unexplained");
                });
            }
            ui.end_row();
        }
    });
}

/// Draws the courses of events with their probabilities. A click shows one of them alone in the scene.
///
/// - `shown`: the one that is shown alone.
pub fn modes_ui(
    ui: &mut Ui,
    (report, shown): (&ReconstructReport, Option<usize>),
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    heading(ui, "Courses of events");
    for (idx, mode) in report.modes.iter().enumerate() {
        let [share, error] = [mode.probability, mode.standard_error].map(|of| 100.0 * of);
        ui.horizontal(|ui| {
            ui.strong(format!("{share:.0} ± {error:.0} %")).on_hover_text("One standard error");
            if let Some(speed) = mode.quantities.first() {
                let text = Quantity::Speed.shown_interval(speed.median, speed.interval_90, units);
                ui.label(format!("struck car {text}")).on_hover_text("Median and 90 %");
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

/// Draws what further measurements would bring, as bars and in words.
pub fn budget_ui(
    ui: &mut Ui,
    answer: &ReconstructAnswer,
    (caveats, units): (&Caveats, UnitSystem),
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
    figure_frame(
        ui,
        ("Half of the 90 % interval of the struck car's speed", &figure),
        &options,
        commands,
    );
    for item in items {
        ui.add(egui::Label::new(sentence(item, units)).wrap());
    }
}

/// What a measurement would bring, in words.
fn sentence(item: &BudgetItem, units: UnitSystem) -> String {
    let unit = Quantity::Speed.display_unit(units);
    let [now, then] = [item.now_m_s, item.then_m_s].map(|m_s| unit.from_si(m_s));
    let mut name = item.shown(units);
    if let Some(first) = name.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    format!("{name}: the speed would narrow from ± {now:.1} to ± {then:.1} {}", unit.symbol)
}

fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(looks::PART);
    ui.separator();
    ui.strong(text);
}
