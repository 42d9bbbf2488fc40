//! The plots of an evaluation of the force network: predicted against observed values, calibration
//! of the predicted distribution, and the force curves of sample cases.

use egui::{Id, Ui};

use crate::app::command::Command;
use crate::app::state::View;
use crate::app::widgets::figure_frame;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::Estimate;
use impactlab_core::units::Quantity;
use impactlab_document::figure::{
    CoveragePoint, Figure, ForceComponent, ForecastFigure, ParityPoint, RecordedCurve, Role,
    coverage_figure, forecast_figure, parity_figure, pit_figure,
};
use impactlab_draw::FigureOptions;
use impactlab_networks::force::ForceCase;
use impactlab_networks::force::metrics::{BAND_LEVELS, IntervalCoverage};
use impactlab_study::{EvaluateForceReport, EvaluatedForceCases};

/// Height of a plot, points.
const PLOT_HEIGHT: f32 = 240.0;
/// Number of plots in a row.
const N_COLUMNS: usize = 3;

/// Draws all plots of an evaluation.
///
/// - `reset`: whether the plots fit their view to the data again.
pub fn plots_ui(
    ui: &mut Ui,
    report: &EvaluateForceReport,
    caveats: &Caveats,
    cases: &EvaluatedForceCases,
    view: &mut View,
    reset: bool,
    commands: &mut Vec<Command>,
) {
    let mut figures = vec![
        parity(cases, "Impulse", "|P|", Quantity::Impulse, view),
        parity(cases, "Peak force", "Peak |F|", Quantity::Force, view),
    ];
    figures.extend(calibration(report));
    let figures: Vec<Figure> =
        figures.into_iter().map(|figure| figure.with_caveats(caveats)).collect();
    rows_ui(ui, &figures, None, reset, commands);
    ui.horizontal(|ui| {
        ui.strong("Sample cases, from the smallest to the largest impulse");
        for component in ForceComponent::ALL {
            ui.radio_value(&mut view.force.sample_component, component, component.label());
        }
    });
    let samples: Vec<Figure> = cases
        .samples
        .iter()
        .map(|(case, forecast)| {
            let input = ForecastFigure {
                name: &case.name,
                forecast,
                levels: &BAND_LEVELS,
                recorded: Some(RecordedCurve {
                    name: "recorded",
                    curve: &case.curve,
                    cut_at_s: case.cut_at_s(),
                }),
                physics: None,
                pulses: &[],
                units: view.units,
                caveats,
            };
            let figure = forecast_figure(view.force.sample_component, &input);
            let kind = if case.is_clean() { "" } else { ", hooked or cut" };
            Figure { title: format!("{}{kind}", case.name), ..figure }
        })
        .collect();
    rows_ui(ui, &samples, Some(Id::unique("samples")), reset, commands);
}

/// Draws figures in rows of [`N_COLUMNS`].
///
/// - `group`: figures with a group share the time axis and the cursor, and only the first of them
///   has a legend; without a group each figure has its own axes and legend.
/// - `reset`: whether the plots fit their view to the data again.
fn rows_ui(
    ui: &mut Ui,
    figures: &[Figure],
    group: Option<Id>,
    reset: bool,
    commands: &mut Vec<Command>,
) {
    for (row, figures) in figures.chunks(N_COLUMNS).enumerate() {
        ui.columns(N_COLUMNS, |columns| {
            for (place, (ui, figure)) in columns.iter_mut().zip(figures).enumerate() {
                let options = FigureOptions {
                    id: format!("evaluation {} {}", group.is_some(), row * N_COLUMNS + place),
                    link: group,
                    height: Some(PLOT_HEIGHT),
                    reset,
                    legend: group.is_none() || row + place == 0,
                    ..FigureOptions::default()
                };
                figure_frame(ui, &figure.title, figure, &options, commands);
            }
        });
    }
}

/// Median of the prediction against the observed value, with the 90 % interval, one point per case.
///
/// - `quantity`: the impulse for [`Quantity::Impulse`], otherwise the peak of the force.
fn parity(
    cases: &EvaluatedForceCases,
    title: &str,
    label: &str,
    quantity: Quantity,
    view: &View,
) -> Figure {
    let point = |(case, impulse_n_s, peak_n): &(ForceCase, Estimate, Estimate)| {
        let [px, py] = case.impulse_n_s;
        let (observed, estimate) = match quantity {
            Quantity::Impulse => (px.hypot(py), impulse_n_s),
            _ => (case.peak_n, peak_n),
        };
        ParityPoint {
            observed,
            predicted: estimate.median,
            interval: estimate.interval(0.9),
            is_clean: case.is_clean(),
        }
    };
    let points: Vec<ParityPoint> = cases.all.iter().map(point).collect();
    parity_figure(title, label, "90 % interval", &points, quantity, view.units)
}

/// Coverage of the intervals and histograms of the probability integral transform (PIT) of force
/// and impulse. The list is empty if the model predicts no distribution.
fn calibration(report: &EvaluateForceReport) -> Vec<Figure> {
    let Some(spread) = &report.evaluation.metrics.overall.probabilistic else {
        return Vec::new();
    };
    let points = |coverage: &[IntervalCoverage]| -> Vec<CoveragePoint> {
        let point = |of: &IntervalCoverage| CoveragePoint {
            level: of.level,
            share: of.share,
            standard_error: of.standard_error,
        };
        coverage.iter().map(point).collect()
    };
    let rows = [
        ("F(t)", Role::Model, points(&spread.force_n)),
        ("|P|", Role::Validation, points(&spread.impulse_n_s)),
        ("peak", Role::Pulse, points(&spread.peak_n)),
        ("duration", Role::Target, points(&spread.duration_s)),
    ];
    vec![
        coverage_figure("Coverage", &rows),
        pit_figure("PIT of F_x(t) and F_y(t)", &spread.pit_force),
        pit_figure("PIT of P_x and P_y", &spread.pit_impulse),
    ]
}
