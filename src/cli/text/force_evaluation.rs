//! How well a force network does, table by table.

use std::io::{self, Write};

use crate::cli::console::{print_caveats, print_table};
use impactlab_networks::force::CrossValidation;
use impactlab_networks::force::metrics::CurveMetrics;
use impactlab_study::{Answer, EvaluateForceReport, ForceEvaluation};

/// Prints the tables below each other.
pub(in crate::cli) fn print_force_evaluation(
    out: &mut dyn Write,
    answer: &Answer<ForceEvaluation>,
) -> io::Result<()> {
    match &answer.report {
        ForceEvaluation::Cases(report) => {
            print_cases(out, report)?;
            print_caveats(out, &answer.caveats)
        }
        ForceEvaluation::Folds(report) => print_folds(out, &report.validation),
    }
}

fn print_cases(out: &mut dyn Write, report: &EvaluateForceReport) -> io::Result<()> {
    writeln!(out, "{}", report.evaluation.to_text())?;
    for case in &report.left_out {
        writeln!(out, "left out: {case}")?;
    }
    Ok(())
}

fn print_folds(out: &mut dyn Write, validation: &CrossValidation) -> io::Result<()> {
    let parts = [("all cases", &validation.overall), ("clean cases", &validation.separated)];
    for (title, compared) in parts {
        let Some(compared) = compared else { continue };
        writeln!(out, "{title}, {} folds", validation.folds.len())?;
        let row = |(name, metrics): (&str, &CurveMetrics)| {
            let percent = |x: f64| format!("{:.1}", 100.0 * x);
            vec![
                name.to_owned(),
                percent(metrics.rmse_over_peak.mean),
                format!("{:.3}", metrics.history_error.mean),
                percent(metrics.impulse_error.median),
                percent(metrics.peak_error.median),
                percent(metrics.duration_error.median),
            ]
        };
        let rows: Vec<Vec<String>> = compared.named().into_iter().map(row).collect();
        let header = [
            "model",
            "RMSE/peak, mean [%]",
            "history, mean",
            "impulse, median [%]",
            "peak, median [%]",
            "duration, median [%]",
        ];
        print_table(out, &header, &rows)?;
        writeln!(out)?;
    }
    Ok(())
}
