//! The “Force prediction” pane: the distribution of the contact force of a collision as the force
//! network predicts it, as bands over time and as numbers.

use egui::{Id, Panel, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::force::ForceSession;
use crate::app::looks;
use crate::app::panels::model_row::{model_row_ui, no_model_ui};
use crate::app::panels::prediction_form::{COLLISION_NOT_KNOWN, form_ui};
use crate::app::panes::PaneContext;
use crate::app::state::View;
use crate::app::widgets::{
    MIN_PLOT_HEIGHT, TITLE_HEIGHT, caveats_ui, count_field, facts_ui, figure_frame, notice_ui,
    seed_field, working_ui,
};
use impactlab_core::data::Severity;
use impactlab_core::ranges::SAMPLES;
use impactlab_document::figure::{ForceComponent, ForecastFigure, RecordedCurve, forecast_figure};
use impactlab_draw::FigureOptions;
use impactlab_networks::force::metrics::BAND_LEVELS;
use impactlab_study::analysis::pulse_curves;
use impactlab_study::{PredictForceAnswer, PredictForceRequest};

/// Width of the form before the user resizes it, points.
const FORM_WIDTH: f32 = 340.0;

/// Draws the form and the numbers on the left, and the plots on the right.
pub fn prediction_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    if session.force.model.current.is_none() {
        let use_of_it =
            "A force model predicts the contact force of a collision, and how sure that is.";
        no_model_ui(ui, &session.force.model, use_of_it, commands);
        return;
    }
    let left = Panel::left("prediction form").default_size(FORM_WIDTH).size_range(260.0..=520.0);
    left.show(ui, |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            model_ui(ui, &session.force, commands);
            form_ui(ui, project, view, session, commands);
            if let Some(answer) = session.force.forecast.ok() {
                ui.separator();
                let is_late = session.force.forecast.is_late();
                super::faded_if(ui, is_late, |ui| {
                    let report = &answer.report;
                    caveats_ui(ui, &report.caveats, view.units, commands);
                    facts_ui(ui, &report.scenario, &report.facts(), view.units);
                });
            }
        });
    });
    egui::CentralPanel::default_margins().frame(egui::Frame::new().inner_margin(looks::GRID)).show(
        ui,
        |ui| match &session.force.forecast.answer {
            None if session.force.forecast.is_waiting() => working_ui(ui, "Predicting…"),
            None if session.sources.iter().any(|source| !source.is_settled()) => {
                working_ui(ui, "Reading…");
            }
            None => drop(ui.label(COLLISION_NOT_KNOWN)),
            Some(Err(problem)) => {
                notice_ui(ui, Severity::Error, format!("Not predicted: {problem}"));
            }
            Some(Ok(answer)) => {
                choices_ui(ui, view, &mut project.predict_force);
                let shown = Shown { answer, session: &session.force, reset: session.fit_plots };
                let is_late = session.force.forecast.is_late();
                super::faded_if(ui, is_late, |ui| plots_ui(ui, shown, view, commands));
            }
        },
    );
}

/// Names the current force model; hovering over it describes its training.
fn model_ui(ui: &mut Ui, force: &ForceSession, commands: &mut Vec<Command>) {
    let Some(current) = &force.model.current else { return };
    let record = current.model.record();
    let hint = format!(
        "Trained on {}: {} cases, {} for validation; {} kept for the test. Weights of epoch {}, the best of {}; seed {}, {} weights, impactlab {}",
        record.data,
        record.train.len(),
        record.detail.validation.len(),
        record.test.len(),
        record.detail.best_epoch,
        record.history.len(),
        record.seed,
        current.model.n_parameters(),
        record.version,
    );
    model_row_ui(ui, &force.model, &hint, commands);
}

/// Draws the choice of the components, bands and curves that are drawn, and the number and the seed
/// of the curves that are sampled from the prediction.
fn choices_ui(ui: &mut Ui, view: &mut View, request: &mut PredictForceRequest) {
    let view = &mut view.force;
    ui.horizontal_wrapped(|ui| {
        for (component, shown) in ForceComponent::ALL.iter().zip(&mut view.components) {
            ui.checkbox(shown, component.label());
        }
        ui.separator();
        for (level, shown) in BAND_LEVELS.iter().zip(&mut view.bands) {
            let hint = "Band that holds this share of the forces at each instant";
            ui.checkbox(shown, format!("{:.0} %", level * 100.0)).on_hover_text(hint);
        }
        ui.separator();
        ui.checkbox(&mut view.recorded, "Recorded")
            .on_hover_text("The force that was recorded in the selected case");
        ui.checkbox(&mut view.pulses, "Classic pulses").on_hover_text(
            "Half-sine, haversine, triangle and square with the impulse of the momentum solution over the predicted duration",
        );
        ui.checkbox(&mut view.physics, "Centre alone")
            .on_hover_text("Where the network starts: the mean of crush model and regressions");
    });
    ui.horizontal_wrapped(|ui| {
        let name = ui.label("Drawn curves");
        count_field(ui, &mut request.samples, &SAMPLES, 0.2)
            .labelled_by(name.id)
            .on_hover_text("Whole curves drawn from the prediction, as coherent as real ones");
        let name = ui.label("Seed");
        seed_field(ui, &mut request.seed)
            .labelled_by(name.id)
            .on_hover_text("Same seed, same curves; intervals of |P|, peak and PDOF are drawn too");
        if ui.button("Draw").on_hover_text("Draw other curves: the next seed").clicked() {
            if request.samples == 0 {
                request.samples = 10;
            } else {
                request.seed = request.seed.wrapping_add(1);
            }
        }
    });
}

/// The prediction that is drawn, and its surroundings.
#[derive(Clone, Copy)]
struct Shown<'a> {
    /// The predicted force.
    answer: &'a PredictForceAnswer,
    /// The session, which holds the recorded force of the selected case.
    session: &'a ForceSession,
    /// Whether the plots fit their view to the data again.
    reset: bool,
}

/// Draws one plot over time for each chosen component of the force.
fn plots_ui(ui: &mut Ui, shown: Shown<'_>, view: &View, commands: &mut Vec<Command>) {
    let levels: Vec<f64> = BAND_LEVELS
        .iter()
        .zip(view.force.bands)
        .filter_map(|(level, shown)| shown.then_some(*level))
        .collect();
    let recorded = shown.session.recorded.as_ref().filter(|_| view.force.recorded);
    let recorded_name = recorded.map(|recorded| format!("{}, recorded", recorded.case));
    let PredictForceAnswer { report, forecast, prediction, .. } = shown.answer;
    let pulses = if view.force.pulses {
        let impulse_n_s = report.momentum_impulse_n_s;
        pulse_curves(impulse_n_s, report.duration_s.median).unwrap_or_default()
    } else {
        Vec::new()
    };
    let caveats = report.caveats.clone().outdated_if(shown.session.forecast.is_waiting());
    let input = ForecastFigure {
        name: &report.scenario,
        forecast,
        levels: &levels,
        recorded: recorded_name.as_deref().zip(recorded).map(|(name, recorded)| RecordedCurve {
            name,
            curve: &recorded.curve,
            cut_at_s: recorded.canonical.cut_at_s(),
        }),
        pulses: &pulses,
        physics: view.force.physics.then_some(&prediction.centre),
        units: view.units,
        caveats: &caveats,
    };
    let components: Vec<ForceComponent> = ForceComponent::ALL
        .into_iter()
        .zip(view.force.components)
        .filter_map(|(component, shown)| shown.then_some(component))
        .collect();
    let n_plots = components.len().max(1) as f32;
    let height = (ui.available_height() / n_plots - TITLE_HEIGHT).max(MIN_PLOT_HEIGHT);
    ScrollArea::vertical().show(ui, |ui| {
        for (rank, component) in components.into_iter().enumerate() {
            let figure = forecast_figure(component, &input);
            let options = FigureOptions {
                id: format!("forecast {}", component.label()),
                link: Some(Id::unique("forecast")),
                height: Some(height),
                reset: shown.reset,
                legend: rank == 0,
                ..FigureOptions::default()
            };
            figure_frame(ui, &figure.title, &figure, &options, commands);
        }
    });
}
