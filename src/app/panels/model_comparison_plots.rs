//! The figures of a comparison, and its cases one by one.

use egui::{DragValue, Grid, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::state::View;
use crate::app::widgets::figure_frame;
use crate::figure::{
    CoveragePoint, Figure, Role, cluster_figure, compared_case_figure, coverage_figure,
    horizon_figure, model_name, pit_figure, ranking_figure,
};
use crate::render::FigureOptions;
use crate::response::evaluate::{
    ComparedModel, Comparison, CoverageMetrics, MeanStd, MotionModelKind, TestCase,
};
use crate::units::{Quantity, UnitSystem, significant};

/// Height of a plot, points.
const PLOT_HEIGHT: f32 = 220.0;
/// Height of the case browser, points.
const BROWSER_HEIGHT: f32 = 420.0;
/// Bins of the histogram of levels.
const N_BINS: usize = 10;
const KM_H_PER_M_S: f64 = 3.6;

/// Ranking, errors of each variable, horizons, clusters, calibration.
pub fn overview_ui(
    ui: &mut Ui,
    comparison: &Comparison,
    (units, reset): (UnitSystem, bool),
    commands: &mut Vec<Command>,
) {
    ui.weak("Point: mean over trajectories; bar: ± standard deviation; tick: median.");
    let first = [ranking(comparison, units), horizon_figure(comparison, units)];
    row_ui(ui, ("ranking", &first), reset, commands);
    let variables = variables(comparison, units);
    row_ui(ui, ("variables", &variables), reset, commands);
    ui.weak("By cluster of impulse. Box: quartiles; line: median; whiskers: least and largest.");
    let clusters = 0..comparison.clusters.len();
    let clusters: Vec<Figure> = clusters.map(|of| cluster_figure(comparison, of, units)).collect();
    row_ui(ui, ("clusters", &clusters), reset, commands);
    let calibration = calibration(comparison);
    if !calibration.is_empty() {
        ui.weak("Whether regions hold as many positions as they say.");
        row_ui(ui, ("calibration", &calibration), reset, commands);
    }
}

/// Figures side by side, three in a row, or two where that fills the rows.
fn row_ui(ui: &mut Ui, (id, figures): (&str, &[Figure]), reset: bool, commands: &mut Vec<Command>) {
    let n_columns = if matches!(figures.len(), 1 | 2 | 4) { 2 } else { 3 };
    for (row, part) in figures.chunks(n_columns).enumerate() {
        ui.columns(n_columns, |columns| {
            for (place, (ui, figure)) in columns.iter_mut().zip(part).enumerate() {
                let options = FigureOptions {
                    id: format!("compared {id} {row} {place}"),
                    height: Some(PLOT_HEIGHT),
                    reset,
                    // Rows are named on the axis.
                    legend: figure.y.names.is_empty(),
                    ..FigureOptions::default()
                };
                figure_frame(ui, (&figure.title, figure), &options, commands);
            }
        });
    }
}

fn ranking(comparison: &Comparison, units: UnitSystem) -> Figure {
    let unit = Quantity::Length.display_unit(units);
    let of = |model: &ComparedModel| model.metrics.average_error_m.times(unit.from_si(1.0));
    ranking_figure(comparison, ("Average error", "Average error", unit), of)
}

fn variables(comparison: &Comparison, units: UnitSystem) -> Vec<Figure> {
    type Of = fn(&ComparedModel) -> MeanStd;
    let rows: [(&str, Quantity, f64, Of); 5] = [
        ("X", Quantity::Length, 1.0, |of| of.metrics.rmse.x_m),
        ("Y", Quantity::Length, 1.0, |of| of.metrics.rmse.y_m),
        ("v_x", Quantity::Speed, 1.0 / KM_H_PER_M_S, |of| of.metrics.rmse.vx_km_h),
        ("v_y", Quantity::Speed, 1.0 / KM_H_PER_M_S, |of| of.metrics.rmse.vy_km_h),
        ("yaw rate", Quantity::AngularVelocity, 1.0_f64.to_radians(), |of| {
            of.metrics.rmse.yaw_rate_deg_s
        }),
    ];
    let figure = |(name, quantity, si, of): (&str, Quantity, f64, Of)| {
        let unit = quantity.display_unit(units);
        let title = format!("RMSE of {name}");
        ranking_figure(comparison, (&title, &title, unit), |model| {
            of(model).times(unit.from_si(si))
        })
    };
    rows.into_iter().map(figure).collect()
}

/// Coverage along the path and at the end, and at which level of its region each end lies.
fn calibration(comparison: &Comparison) -> Vec<Figure> {
    let networks = comparison.models.iter().filter(|model| model.kind == MotionModelKind::Network);
    let points = |model: &ComparedModel, of: &CoverageMetrics, is_end: bool| {
        let shares = if is_end { [of.end_50, of.end_90] } else { [of.path_50, of.path_90] };
        // Instants of one trajectory are no independent observations.
        let n = model.metrics.n.max(1) as f64;
        let point = |(level, share): (f64, f64)| CoveragePoint {
            level,
            share,
            standard_error: (share * (1.0 - share) / n).sqrt(),
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

/// A table of the cases, and what all models say of the one that is chosen.
pub fn browser_ui(
    ui: &mut Ui,
    comparison: &Comparison,
    (view, reset): (&mut View, bool),
    commands: &mut Vec<Command>,
) {
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
        clicked = cases_ui(&mut columns[0], comparison, (case, choice, units));
        if let Some(figure) = compared_case_figure(comparison, (&case.name, choice), units) {
            let options = FigureOptions {
                id: "compared case".to_owned(),
                height: Some(BROWSER_HEIGHT),
                reset: reset || clicked.is_some(),
                ..FigureOptions::default()
            };
            figure_frame(&mut columns[1], (&figure.title, &figure), &options, commands);
        }
    });
    if clicked.is_some() {
        view.compared_case = clicked;
    }
}

/// The name that was clicked.
fn cases_ui(
    ui: &mut Ui,
    comparison: &Comparison,
    (chosen, choice, units): (&TestCase, u64, UnitSystem),
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
