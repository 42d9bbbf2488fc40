//! The tables of an evaluation of the force network: errors, coverage of the intervals, and errors
//! by cluster of impulse.

use egui::{Grid, Ui};

use crate::app::force::{ForceView, Statistic};
use crate::app::looks;
use impactlab_core::numerics::Summary;
use impactlab_core::units::{Quantity, UnitSystem, percent};
use impactlab_networks::force::metrics::{
    BAND_LEVELS, CurveMetrics, DistributionMetrics, IntervalCoverage,
};
use impactlab_networks::force::{Evaluation, ForceMetrics};

/// Draws the tables of errors, of coverage and of errors by cluster, for the model and its three
/// baselines, and the choice of the statistic over the cases that is shown.
pub fn tables_ui(ui: &mut Ui, evaluation: &Evaluation, view: &mut ForceView, units: UnitSystem) {
    ui.horizontal(|ui| {
        ui.label("Errors, over cases");
        for statistic in Statistic::ALL {
            ui.radio_value(&mut view.statistic, statistic, statistic.label());
        }
    });
    let models = [
        (evaluation.model.as_str(), &evaluation.metrics),
        ("classic pulse", &evaluation.baselines.pulse),
        ("nearest case", &evaluation.baselines.nearest),
        ("Gaussian processes", &evaluation.baselines.statistical),
    ];
    errors_ui(ui, models, view.statistic);
    coverage_ui(ui, models);
    clusters_ui(ui, evaluation, view.statistic, units);
}

/// Draws the relative errors of each model, over all cases and over those in which the vehicles
/// separate.
fn errors_ui(ui: &mut Ui, models: [(&str, &ForceMetrics); 4], statistic: Statistic) {
    type Choose = fn(&ForceMetrics) -> Option<&CurveMetrics>;
    let groups: [(&str, Choose); 2] =
        [("all cases", |of| Some(&of.overall)), ("separated", |of| of.separated.as_ref())];
    Grid::new("force errors").striped(true).show(ui, |ui| {
        titles_ui(
            ui,
            &[
                ("", ""),
                (
                    "RMSE/peak",
                    "Root mean square error over the 250 ms, both axes, over the peak of |F|",
                ),
                ("history", "‖F̂ − F‖ / ‖F‖, both axes"),
                ("impulse", "|P̂ − P| / |P| of the impulse vector"),
                ("peak", "Error of the largest |F| over the largest |F|"),
                ("duration", "Error of the duration over the duration"),
            ],
        );
        for (group, choose) in groups {
            let Some(first) = choose(models[0].1) else { continue };
            ui.strong(format!("{group}, {}", first.n_cases))
                .on_hover_text("Separated: without cases that hook or are still in contact");
            ui.end_row();
            for (name, of) in models {
                if let Some(metrics) = choose(of) {
                    error_row_ui(ui, name, metrics, statistic);
                }
            }
        }
    });
}

/// Draws the share of the observed values that lie inside the predicted intervals. Models that
/// predict no distribution have no rows.
fn coverage_ui(ui: &mut Ui, models: [(&str, &ForceMetrics); 4]) {
    ui.add_space(looks::PART);
    ui.strong("Share of observed values inside the intervals, ± its standard error");
    Grid::new("force coverage").striped(true).show(ui, |ui| {
        let levels = BAND_LEVELS.map(|level| format!("{:.0} %", level * 100.0));
        let titles: Vec<(&str, &str)> = ["", "of"]
            .into_iter()
            .chain(levels.iter().map(String::as_str))
            .map(|t| (t, ""))
            .collect();
        titles_ui(ui, &titles);
        for (name, of) in models {
            if let Some(spread) = &of.overall.probabilistic {
                coverage_rows_ui(ui, name, spread);
            }
        }
    });
}

/// Draws the errors of the model in each cluster of impulse, beside those of the Gaussian
/// processes.
fn clusters_ui(ui: &mut Ui, evaluation: &Evaluation, statistic: Statistic, units: UnitSystem) {
    ui.add_space(looks::PART);
    ui.strong("By cluster of impulse")
        .on_hover_text("k-means of the training cases by impulse and force, ordered by impulse");
    Grid::new("force clusters").striped(true).show(ui, |ui| {
        titles_ui(
            ui,
            &[
                ("", ""),
                ("cases", ""),
                ("centre", "Impulse at the cluster's centre"),
                ("history", "Error of the model"),
                ("impulse", "Error of the model"),
                ("peak", "Error of the model"),
                ("history, Gaussian processes", "Error of the strongest baseline"),
            ],
        );
        for cluster in &evaluation.clusters {
            ui.label(&cluster.name);
            ui.monospace(cluster.model.n_cases.to_string());
            ui.monospace(Quantity::Impulse.shown(cluster.impulse_n_s, units));
            for error in [
                &cluster.model.history_error,
                &cluster.model.impulse_error,
                &cluster.model.peak_error,
                &cluster.statistical.history_error,
            ] {
                ui.monospace(percent(statistic.value_in(error)));
            }
            ui.end_row();
        }
    });
}

/// Draws the heading row of a grid.
///
/// - `titles`: pairs of the title of a column and its explanation on hover, which may be empty.
fn titles_ui(ui: &mut Ui, titles: &[(&str, &str)]) {
    for (title, hint) in titles {
        let label = ui.strong(*title);
        if !hint.is_empty() {
            label.on_hover_text(*hint);
        }
    }
    ui.end_row();
}

/// Draws the errors of one model; hovering over an error shows all statistics of it.
fn error_row_ui(ui: &mut Ui, name: &str, metrics: &CurveMetrics, statistic: Statistic) {
    ui.label(name);
    for error in [
        &metrics.rmse_over_peak,
        &metrics.history_error,
        &metrics.impulse_error,
        &metrics.peak_error,
        &metrics.duration_error,
    ] {
        let all = Statistic::ALL.map(|s| format!("{} {}", s.label(), percent(s.value_in(error))));
        ui.monospace(percent(statistic.value_in(error))).on_hover_text(all.join("\n"));
    }
    ui.end_row();
}

fn coverage_rows_ui(ui: &mut Ui, name: &str, spread: &DistributionMetrics) {
    let quantities = [
        ("F(t)", &spread.force_n),
        ("|P|", &spread.impulse_n_s),
        ("peak", &spread.peak_n),
        ("duration", &spread.duration_s),
    ];
    for (quantity, coverage) in quantities {
        ui.label(name);
        ui.label(quantity);
        for IntervalCoverage { share, standard_error, .. } in coverage {
            ui.monospace(format!("{:.0} ± {:.0} %", share * 100.0, standard_error * 100.0));
        }
        ui.end_row();
    }
}

impl Statistic {
    /// Reads this statistic from a summary over cases.
    fn value_in(self, summary: &Summary) -> f64 {
        match self {
            Self::Median => summary.median,
            Self::Mean => summary.mean,
            Self::P90 => summary.p90,
        }
    }
}
