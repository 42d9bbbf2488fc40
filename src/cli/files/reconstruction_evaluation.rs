//! The files of `impactlab evaluate reconstruction`.

use std::path::Path;

use crate::cli::CliError;
use crate::cli::files::write_json;
use impactlab_core::data::{Existing, write_restricted_table};
use impactlab_reconstruct::evaluate::{CaseScore, SCORED, ScoredQuantity};
use impactlab_study::{Answer, EvaluateReconstructionReport, word};

/// Files that are written.
pub(in crate::cli) const RECONSTRUCTION_EVALUATION_FILES: [&str; 2] =
    ["evaluation.csv", "evaluation.json"];

/// What the table says of each quantity, before the unit in the name of its column.
const COLUMNS: [&str; 11] = [
    "true", "median", "low_50", "high_50", "low_80", "high_80", "low_90", "high_90", "low_95",
    "high_95", "crps",
];

/// Writes an evaluation as JSON, and as CSV with a row for each case, part of the evidence and method,
/// into a folder that exists.
pub(in crate::cli) fn write_reconstruction_evaluation(
    path: &Path,
    report: &Answer<EvaluateReconstructionReport>,
) -> Result<(), CliError> {
    let restrictions = report.caveats.text();
    let of_quantities = SCORED.iter().flat_map(|quantity| {
        let (name, unit) = name_and_unit(quantity.key());
        COLUMNS.map(|column| format!("{name}_{column}{unit}"))
    });
    let own = ["case", "known", "method", "seconds", "ess", "n_simulations"].map(str::to_owned);
    let header: Vec<String> = own.into_iter().chain(of_quantities).collect();
    let table = path.join("evaluation.csv");
    let rows = report.cases.iter().map(row);
    write_restricted_table(&table, Existing::Refuse, &header, rows, restrictions.as_deref())?;
    write_json(&path.join("evaluation.json"), report)
}

/// The name of a quantity and the unit at its end, both as they stand in the name of a column.
fn name_and_unit(key: &str) -> (&str, &str) {
    let ends = ["_rad_s", "_m_s", "_rad"];
    let unit = ends.into_iter().find(|end| key.ends_with(end)).unwrap_or_default();
    key.split_at(key.len() - unit.len())
}

fn row(score: &CaseScore) -> Vec<String> {
    let mut row = vec![
        score.case.clone(),
        word(&score.known),
        word(&score.method),
        score.seconds.to_string(),
        score.ess.map_or_else(String::new, |ess| ess.to_string()),
        score.n_simulations.to_string(),
    ];
    for quantity in SCORED {
        match score.quantity(quantity.key()) {
            Some(scored) => row.extend(numbers(scored).map(|number| number.to_string())),
            None => row.extend(COLUMNS.map(|_| String::new())),
        }
    }
    row
}

/// The numbers of a quantity in the order of [`COLUMNS`].
fn numbers(ScoredQuantity { estimate, truth, crps }: &ScoredQuantity) -> [f64; COLUMNS.len()] {
    let estimate = &estimate.estimate;
    let ends = |level| estimate.interval(level).unwrap_or([f64::NAN; 2]);
    let [[low_50, high_50], [low_80, high_80], [low_90, high_90], [low_95, high_95]] =
        [0.5, 0.8, 0.9, 0.95].map(ends);
    [
        *truth,
        estimate.median,
        low_50,
        high_50,
        low_80,
        high_80,
        low_90,
        high_90,
        low_95,
        high_95,
        *crps,
    ]
}
