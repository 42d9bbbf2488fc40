//! The figures of a comparison of motion models, and the browser that shows its cases one by one.

use egui::{DragValue, Grid, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::state::View;
use crate::app::widgets::figure_frame;
use impactlab_core::numerics::share_standard_error;
use impactlab_core::units::{KILOMETRE_PER_HOUR_M_S, Quantity, UnitSystem, significant};
use impactlab_document::figure::{
    CoveragePoint, Figure, Role, cluster_figure, compared_case_figure, coverage_figure,
    horizon_figure, model_name, pit_figure, ranking_figure,
};
use impactlab_draw::FigureOptions;
use impactlab_networks::response::evaluate::{
    ComparedModel, Comparison, CoverageMetrics, MeanStd, MotionModelKind, TestCase,
};
use impactlab_study::{Answer, CompareReport};

/// Height of a plot, points.
const PLOT_HEIGHT: f32 = 220.0;
/// Height of the case browser, points.
const BROWSER_HEIGHT: f32 = 420.0;
/// Number of bins of the histogram of the levels at which the recorded ends lie.
const N_BINS: usize = 10;

/// Draws the ranking of the models by average error, the errors by horizon, by variable and by
/// cluster of impulse, and the calibration of the networks.
///
/// - `reset`: whether the plots fit their view to the data again.
pub fn overview_ui(
    ui: &mut Ui,
    report: &Answer<CompareReport>,
    units: UnitSystem,
    reset: bool,
    commands: &mut Vec<Command>,
) {
    let (comparison, caveats) = (&report.comparison, &report.caveats);
    let mut row_ui = |ui: &mut Ui, id: &str, figures: Vec<Figure>| {
        let figures: Vec<Figure> =
            figures.into_iter().map(|figure| figure.with_caveats(caveats)).collect();
        row_ui(ui, id, &figures, reset, commands);
    };
    ui.weak("Point: mean over trajectories; bar: ± standard deviation; tick: median.");
    let first = vec![ranking(comparison, units), horizon_figure(comparison, units)];
    row_ui(ui, "ranking", first);
    row_ui(ui, "variables", variables(comparison, units));
    ui.weak("By cluster of impulse. Box: quartiles; line: median; whiskers: least and largest.");
    let clusters = 0..comparison.clusters.len();
    let clusters: Vec<Figure> = clusters.map(|of| cluster_figure(comparison, of, units)).collect();
    row_ui(ui, "clusters", clusters);
    let calibration = calibration(comparison);
    if !calibration.is_empty() {
        ui.weak("Whether regions hold as many positions as they say.");
        row_ui(ui, "calibration", calibration);
    }
}

/// Draws figures in rows of three, or in rows of two if there are one, two or four of them.
///
/// - `id`: distinguishes these figures from the others of the panel.
fn row_ui(ui: &mut Ui, id: &str, figures: &[Figure], reset: bool, commands: &mut Vec<Command>) {
    let n_columns = if matches!(figures.len(), 1 | 2 | 4) { 2 } else { 3 };
    for (row, part) in figures.chunks(n_columns).enumerate() {
        ui.columns(n_columns, |columns| {
            for (place, (ui, figure)) in columns.iter_mut().zip(part).enumerate() {
                let options = FigureOptions {
                    id: format!("compared {id} {row} {place}"),
                    height: Some(PLOT_HEIGHT),
                    reset,
                    // Figures with named rows carry the names of the models on the axis.
                    legend: figure.y.names.is_empty(),
                    ..FigureOptions::default()
                };
                figure_frame(ui, &figure.title, figure, &options, commands);
            }
        });
    }
}

/// Average position error of each model.
fn ranking(comparison: &Comparison, units: UnitSystem) -> Figure {
    let unit = Quantity::Length.display_unit(units);
    let of = |model: &ComparedModel| model.metrics.average_error_m.times(unit.from_si(1.0));
    ranking_figure(comparison, "Average error", "Average error", unit, of)
}

/// Root mean square error of each model in X, Y, v_x, v_y and yaw rate, one figure per variable.
fn variables(comparison: &Comparison, units: UnitSystem) -> Vec<Figure> {
    type Of = fn(&ComparedModel) -> MeanStd;
    let rows: [(&str, Quantity, f64, Of); 5] = [
        ("X", Quantity::Length, 1.0, |of| of.metrics.rmse.x_m),
        ("Y", Quantity::Length, 1.0, |of| of.metrics.rmse.y_m),
        ("v_x", Quantity::Speed, KILOMETRE_PER_HOUR_M_S, |of| of.metrics.rmse.vx_km_h),
        ("v_y", Quantity::Speed, KILOMETRE_PER_HOUR_M_S, |of| of.metrics.rmse.vy_km_h),
        ("yaw rate", Quantity::AngularVelocity, 1.0_f64.to_radians(), |of| {
            of.metrics.rmse.yaw_rate_deg_s
        }),
    ];
    let figure = |(name, quantity, si, of): (&str, Quantity, f64, Of)| {
        let unit = quantity.display_unit(units);
        let title = format!("RMSE of {name}");
        ranking_figure(comparison, &title, &title, unit, |model| of(model).times(unit.from_si(si)))
    };
    rows.into_iter().map(figure).collect()
}

/// Calibration of the position distribution of each response network: the share of recorded
/// positions inside the 50 % and 90 % regions, along the path and at the end, and a histogram of
/// the levels of the smallest regions that hold the recorded ends.
///
/// The bars are the standard errors of shares of the trajectories.
fn calibration(comparison: &Comparison) -> Vec<Figure> {
    let networks = comparison.models.iter().filter(|model| model.kind == MotionModelKind::Network);
    let points = |model: &ComparedModel, of: &CoverageMetrics, is_end: bool| {
        let shares = if is_end { [of.end_50, of.end_90] } else { [of.path_50, of.path_90] };
        // The instants of one trajectory are correlated, so each trajectory counts once.
        let n = model.metrics.n.max(1) as f64;
        let point = |(level, share): (f64, f64)| CoveragePoint {
            level,
            share,
            standard_error: share_standard_error(share, n),
        };
        [0.5, 0.9].into_iter().zip(shares).map(point).collect::<Vec<CoveragePoint>>()
    };
    let mut figures = Vec::new();
    for model in networks {
        let Some(of) = &model.metrics.coverage else { continue };
        let name = model_name(&model.name, model.trajectories);
        let rows = [
            ("along the path", Role::Model, points(model, of, false)),
            ("at the end", Role::Validation, points(model, of, true)),
        ];
        figures.push(coverage_figure(&format!("Coverage of positions: {name}"), &rows));
        let mut counts = [0_u32; N_BINS];
        let of_model = comparison
            .cases
            .iter()
            .filter(|case| case.kind == model.kind && case.trajectories == model.trajectories);
        for level in of_model.filter_map(|case| Some(case.metrics.coverage?.end_level)) {
            let bin = (level * N_BINS as f64) as usize;
            counts[bin.min(N_BINS - 1)] += 1;
        }
        let mut levels = pit_figure(&format!("Level of the region at the end: {name}"), &counts);
        levels.x.label = "Smallest region that holds the recorded end".to_owned();
        figures.push(levels);
    }
    figures
}

/// Draws the table of the cases, and a figure with the recorded path of the chosen case and the
/// paths that all models predict for it.
///
/// - `reset`: whether the plot fits its view to the data again.
pub fn browser_ui(
    ui: &mut Ui,
    report: &Answer<CompareReport>,
    view: &mut View,
    reset: bool,
    commands: &mut Vec<Command>,
) {
    let comparison = &report.comparison;
    let units = view.units;
    let view = &mut view.response;
    ui.horizontal(|ui| {
        ui.strong("Cases");
        let name = ui.label("choice of trajectories");
        let last = comparison.n_choices.saturating_sub(1);
        ui.add(DragValue::new(&mut view.compared_choice).range(0..=last).speed(0.05))
            .labelled_by(name.id)
            .on_hover_text("Whose models are drawn, from 0");
    });
    let chosen = view.compared_case.as_deref();
    let known = comparison.test.iter().find(|case| Some(case.name.as_str()) == chosen);
    let Some(case) = known.or(comparison.test.first()) else { return };
    let choice = comparison.seed + view.compared_choice;
    let mut clicked = None;
    ui.columns(2, |columns| {
        clicked = cases_ui(&mut columns[0], comparison, case, choice, units);
        if let Some(figure) = compared_case_figure(comparison, &case.name, choice, units) {
            let figure = figure.with_caveats(&report.caveats);
            let options = FigureOptions {
                id: "compared case".to_owned(),
                height: Some(BROWSER_HEIGHT),
                reset: reset || clicked.is_some(),
                ..FigureOptions::default()
            };
            figure_frame(&mut columns[1], &figure.title, &figure, &options, commands);
        }
    });
    if clicked.is_some() {
        view.compared_case = clicked;
    }
}

/// Draws the table of the average error of each model on each case, and returns the name of the
/// case that the user clicked, if any.
///
/// - `chosen`: the case that is marked.
/// - `choice`: seed of the choice of training trajectories whose models are shown. Models that were
///   trained on no trajectories are shown for every choice.
fn cases_ui(
    ui: &mut Ui,
    comparison: &Comparison,
    chosen: &TestCase,
    choice: u64,
    units: UnitSystem,
) -> Option<String> {
    let unit = Quantity::Length.display_unit(units);
    let mut clicked = None;
    ui.label(format!("Average error [{}]", unit.symbol));
    let area = ScrollArea::both().id_salt("compared cases").max_height(BROWSER_HEIGHT);
    area.min_scrolled_height(BROWSER_HEIGHT).show(ui, |ui| {
        Grid::new("compared cases").striped(true).show(ui, |ui| {
            for title in ["case", "spins", "cluster"] {
                ui.strong(title);
            }
            for model in &comparison.models {
                ui.strong(model_name(&model.name, model.trajectories));
            }
            ui.end_row();
            for case in &comparison.test {
                if ui.selectable_label(case.name == chosen.name, &case.name).clicked() {
                    clicked = Some(case.name.clone());
                }
                ui.label(if case.spins { "yes" } else { "" });
                ui.label(comparison.clusters.get(case.cluster).map_or("", |of| of.name.as_str()));
                for model in &comparison.models {
                    let answer = comparison.cases.iter().find(|answer| {
                        answer.case == case.name
                            && (answer.kind, answer.trajectories)
                                == (model.kind, model.trajectories)
                            && (answer.trajectories == 0 || answer.choice == choice)
                    });
                    let error = answer.map(|of| of.metrics.error.average_error_m);
                    ui.monospace(error.map_or(String::new(), |m| significant(unit.from_si(m))));
                }
                ui.end_row();
            }
        });
    });
    clicked
}
