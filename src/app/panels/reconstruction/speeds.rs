//! The “Speeds” pane: what the evidence says of the speeds.

use egui::{ComboBox, ScrollArea, Ui};
use impactlab_core::uncertainty::Caveats;

use crate::app::command::Command;
use crate::app::looks;
use crate::app::panels::faded_if;
use crate::app::panels::reconstruction::OUTDATED;
use crate::app::panels::reconstruction::findings::{budget_ui, modes_ui};
use crate::app::panes::PaneContext;
use crate::app::reconstruction::{PreparedReconstruction, ReconstructionView};
use crate::app::widgets::{
    evidence_assumptions_ui, facts_ui, figure_frame, notice_ui, restrictions_ui,
};
use impactlab_core::data::Severity;
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{marginal_figure, pair_figure};
use impactlab_draw::FigureOptions;
use impactlab_reconstruct::ReconstructedQuantity;
use impactlab_study::facts::FactTable;
use impactlab_study::{Answer, ReconstructReport};

/// Heights of the plots, points.
const MARGINAL_HEIGHT: f32 = 190.0;
const PAIR_HEIGHT: f32 = 230.0;

/// Draws the courses of events where there are several, the quantities with their intervals and
/// distributions, the fit of the evidence, and what further evidence would bring.
pub fn speeds_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    let of = &session.reconstruction;
    let is_outdated = of.is_outdated(project.reconstruct.as_ref());
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let Some(answer) = of.answer() else {
            ui.weak(match (of.run.is_running(), of.preview.is_some()) {
                (true, _) => {
                    "The speeds stand here when the run has ended; its particles are in the scene."
                }
                (false, true) => {
                    "What the evidence says of the speeds stands here, once it has been run: with the \
                     button Run of the Evidence pane."
                }
                (false, false) => {
                    "What the evidence says of the speeds stands here, once it has been run. There is no \
                     evidence yet: begin in the Evidence pane."
                }
            });
            return;
        };
        if of.run.is_running() {
            notice_ui(ui, Severity::Info, "The answer of the last run, until this one ends");
        } else if is_outdated {
            notice_ui(ui, Severity::Warning, OUTDATED);
        }
        let report = &answer.answer.report;
        let caveats = report.caveats.clone().outdated_if(is_outdated || of.run.is_running());
        faded_if(ui, is_outdated, |ui| {
            restrictions_ui(ui, &report.caveats, view.units);
            if report.modes.len() > 1 {
                modes_ui(ui, report, of.mode, view.units, commands);
            }
            numbers_ui(ui, report, view.units, commands);
            let units = view.units;
            let options = |id: &str, height| FigureOptions {
                id: id.to_owned(),
                height: Some(height),
                reset: session.fit_plots,
                ..FigureOptions::default()
            };
            let marginal = options("marginal", MARGINAL_HEIGHT);
            let pair = options("pair", PAIR_HEIGHT);
            plots_ui(
                ui,
                answer,
                &caveats,
                units,
                &mut view.reconstruction,
                [marginal, pair],
                commands,
            );
            let found = [
                report.fit_table(),
                report.path_fit_table(),
                report.left_out_table(),
                report.mark_table(),
            ];
            let found: Vec<FactTable> = found.into_iter().flatten().collect();
            ui.add_space(looks::PART);
            facts_ui(ui, "evidence", &found, units);
            if report.modes.len() == 1 {
                modes_ui(ui, report, of.mode, units, commands);
            }
            budget_ui(ui, &answer.answer, &caveats, units, commands);
        });
    });
}

/// Draws the table of quantities, what the speeds hinge on, and what was assumed.
fn numbers_ui(
    ui: &mut Ui,
    report: &Answer<ReconstructReport>,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let tables = [Some(report.speed_table()), report.hinge_table(), report.hand_table()];
    let tables: Vec<FactTable> = tables.into_iter().flatten().collect();
    facts_ui(ui, &report.case, &tables, units);
    evidence_assumptions_ui(ui, &report.caveats, units, commands);
}

/// Draws the distribution of one quantity, and of two against each other.
fn plots_ui(
    ui: &mut Ui,
    answer: &PreparedReconstruction,
    caveats: &Caveats,
    units: UnitSystem,
    view: &mut ReconstructionView,
    [marginal, pair]: [FigureOptions; 2],
    commands: &mut Vec<Command>,
) {
    ui.add_space(looks::PART);
    let quantity = quantity_ui(ui, "Distribution of", answer, &mut view.quantity);
    let prior = answer.prior_of(quantity);
    let figure = marginal_figure(&answer.answer, quantity, prior, caveats, units);
    figure_frame(ui, "Before and after the evidence", &figure, &marginal, commands);
    ui.add_space(looks::PART);
    let against = quantity_ui(ui, "The same over", answer, &mut view.against);
    let quantities = [against, quantity];
    let priors = quantities.map(|of| answer.prior_of(of));
    let figure = pair_figure(&answer.answer, quantities, priors, caveats, units);
    figure_frame(ui, "Two quantities of each particle", &figure, &pair, commands);
}

/// Draws the choice of a quantity of the answer; returns it, or the speed where a quantity of another kind
/// of case was chosen.
fn quantity_ui(
    ui: &mut Ui,
    label: &str,
    answer: &PreparedReconstruction,
    chosen: &mut ReconstructedQuantity,
) -> ReconstructedQuantity {
    let quantities = answer.quantities();
    let speed = answer.answer.posterior.speed();
    let mut shown = if quantities.contains(chosen) { *chosen } else { speed };
    ui.horizontal(|ui| {
        let name = ui.label(label);
        ComboBox::from_id_salt(label)
            .selected_text(shown.label())
            .width(220.0)
            .show_ui(ui, |ui| {
                for quantity in quantities {
                    if ui.selectable_value(&mut shown, *quantity, quantity.label()).clicked() {
                        *chosen = *quantity;
                    }
                }
            })
            .response
            .labelled_by(name.id);
    });
    shown
}
