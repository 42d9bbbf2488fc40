//! The tables of a comparison: as text and as CSV.

use crate::response::evaluate::{
    ClusterModel, ComparedModel, Comparison, CoverageMetrics, MeanStd, RootMeanSquares,
    paper_metrics,
};
use impactlab_core::data::RESTRICTIONS_COLUMN;

/// A table of words and numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ComparisonTable {
    /// Names of the columns, with units.
    pub header: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}

impl ComparisonTable {
    /// The table as CSV.
    ///
    /// - `restrictions`: what restricts its numbers, for the first row of [`RESTRICTIONS_COLUMN`].
    pub fn to_csv(&self, restrictions: Option<&str>) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let texts = [RESTRICTIONS_COLUMN, restrictions.unwrap_or_default()];
        for (i, row) in std::iter::once(&self.header).chain(&self.rows).enumerate() {
            let text = restrictions.map(|_| texts.get(i).copied().unwrap_or_default());
            // Writing to a vector does not fail.
            let _ = writer.write_record(row.iter().map(String::as_str).chain(text));
        }
        writer
            .into_inner()
            .map_or_else(|_| String::new(), |bytes| String::from_utf8_lossy(&bytes).into_owned())
    }
}

/// Titles, file names and tables of a comparison.
pub fn all_tables(comparison: &Comparison) -> Vec<(&'static str, &'static str, ComparisonTable)> {
    let mut tables = vec![
        ("Models", "models.csv", model_table(comparison)),
        ("Distance by horizon", "horizons.csv", horizon_table(comparison)),
        ("Uncertainty", "uncertainty.csv", uncertainty_table(comparison)),
        ("By cluster of impulse", "clusters.csv", cluster_table(comparison)),
    ];
    if !comparison.endings.is_empty() {
        tables.push(("By ending", "endings.csv", ending_table(comparison)));
    }
    tables
}

/// Average error, score, time per step and root mean square errors of each model; what the paper
/// printed in a column of its own.
fn model_table(comparison: &Comparison) -> ComparisonTable {
    let mut header = words(&[
        "model",
        "trajectories",
        "average error, m",
        "median, m",
        "choices, m",
        "score, 1/m",
    ]);
    header.extend(rmse_names());
    header.extend(words(&[
        "final heading, deg",
        "violations",
        "time per step, us",
        "training, s",
        "paper's average error, m (other data)",
    ]));
    let row = |model: &ComparedModel| {
        let metrics = &model.metrics;
        let by_choice = &model.average_error_by_choice_m;
        let choices = MeanStd::from_values(by_choice.iter().copied());
        let mut row = vec![
            model.name.clone(),
            count(model.trajectories),
            mean_std(metrics.average_error_m),
            number(metrics.average_error_m.median),
            if by_choice.len() > 1 { mean_std(choices) } else { String::new() },
            number(metrics.score),
        ];
        row.extend(metrics.rmse.named().map(|(_, value)| mean_std(value)));
        let paper = paper_metrics(model.kind, model.trajectories);
        row.extend([
            mean_std(metrics.final_heading_error_deg),
            metrics.violations.to_string(),
            format!("{:.1}", metrics.time_per_step_us),
            if model.training_s > 0.0 { format!("{:.1}", model.training_s) } else { String::new() },
            paper.map_or(String::new(), |paper| format!("{:.2}", paper.average_error_m)),
        ]);
        row
    };
    ComparisonTable { header, rows: comparison.models.iter().map(row).collect() }
}

/// Distance after 0.5, 1, 2 and 4 s.
fn horizon_table(comparison: &Comparison) -> ComparisonTable {
    let header = words(&["model", "trajectories", "0.5 s, m", "1 s, m", "2 s, m", "4 s, m"]);
    let row = |model: &ComparedModel| {
        let mut row = vec![model.name.clone(), count(model.trajectories)];
        row.extend(model.metrics.horizon_error_m.map(mean_std));
        row
    };
    ComparisonTable { header, rows: comparison.models.iter().map(row).collect() }
}

/// MotionCoverage and scores of the models that have a distribution.
fn uncertainty_table(comparison: &Comparison) -> ComparisonTable {
    let header = words(&[
        "model",
        "trajectories",
        "in 50 % along the path",
        "in 90 %",
        "in 50 % at the end",
        "in 90 %",
        "CRPS X, m",
        "CRPS Y, m",
        "CRPS heading, deg",
        "energy score, m",
    ]);
    let row = |model: &ComparedModel| {
        let coverage = model.metrics.coverage?;
        let share = |value: f64| format!("{:.0} %", 100.0 * value);
        Some(vec![
            model.name.clone(),
            count(model.trajectories),
            share(coverage.path_50),
            share(coverage.path_90),
            share(coverage.end_50),
            share(coverage.end_90),
            number(coverage.crps_x_m),
            number(coverage.crps_y_m),
            number(coverage.crps_yaw_deg),
            number(coverage.energy_score_m),
        ])
    };
    ComparisonTable { header, rows: comparison.models.iter().filter_map(row).collect() }
}

/// Average error and root mean square errors by cluster of impulse.
fn cluster_table(comparison: &Comparison) -> ComparisonTable {
    let mut header = words(&[
        "cluster",
        "cases",
        "impulse, N s",
        "model",
        "trajectories",
        "average error, m",
        "median, m",
    ]);
    header.extend(rmse_names());
    let mut rows = Vec::new();
    for cluster in &comparison.clusters {
        for ClusterModel { name, trajectories, metrics } in &cluster.models {
            let mut row = vec![
                cluster.name.clone(),
                cluster.n.to_string(),
                cluster.impulse_n_s.map_or(String::new(), |impulse| format!("{impulse:.0}")),
                name.clone(),
                count(*trajectories),
                mean_std(metrics.average_error_m),
                number(metrics.average_error_m.median),
            ];
            row.extend(metrics.rmse.named().map(|(_, value)| mean_std(value)));
            rows.push(row);
        }
    }
    ComparisonTable { header, rows }
}

/// Errors over 4 s, over whole recordings and of the rest position, and coverage, by kind of ending.
fn ending_table(comparison: &Comparison) -> ComparisonTable {
    let header = words(&[
        "ending",
        "cases",
        "model",
        "trajectories",
        "average error over 4 s, m",
        "median, m",
        "over all, m",
        "median, m",
        "at rest",
        "rest position, m",
        "median, m",
        "in 50 % along the path",
        "in 90 %",
    ]);
    let mut rows = Vec::new();
    for ending in &comparison.endings {
        for ClusterModel { name, trajectories, metrics } in &ending.models {
            let share = |quantity: fn(&CoverageMetrics) -> f64| {
                metrics
                    .coverage
                    .map_or(String::new(), |all| format!("{:.0} %", 100.0 * quantity(&all)))
            };
            let median = |summary: MeanStd| {
                if summary.median.is_nan() { String::new() } else { number(summary.median) }
            };
            rows.push(vec![
                ending.name.clone(),
                ending.n.to_string(),
                name.clone(),
                count(*trajectories),
                mean_std(metrics.average_error_4_s_m),
                median(metrics.average_error_4_s_m),
                mean_std(metrics.average_error_m),
                median(metrics.average_error_m),
                metrics.n_at_rest.to_string(),
                mean_std(metrics.rest_error_m),
                median(metrics.rest_error_m),
                share(|coverage| coverage.path_50),
                share(|coverage| coverage.path_90),
            ]);
        }
    }
    ComparisonTable { header, rows }
}

fn rmse_names() -> Vec<String> {
    let named = RootMeanSquares::default().named();
    named.into_iter().map(|(name, _)| format!("RMSE {name}")).collect()
}

fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

fn count(n: usize) -> String {
    if n == 0 { String::new() } else { n.to_string() }
}

fn number(value: f64) -> String {
    format!("{value:.3}")
}

/// Empty where no trajectory has the value.
fn mean_std(value: MeanStd) -> String {
    if value.mean.is_nan() {
        String::new()
    } else {
        format!("{:.3} ± {:.3}", value.mean, value.std)
    }
}
