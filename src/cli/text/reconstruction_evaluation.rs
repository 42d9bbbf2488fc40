//! How well staged collisions are reconstructed, table by table.

use std::io::{self, Write};

use crate::cli::console::{print_caveats, print_table};
use impactlab_core::units::{Quantity, UnitSystem, percent};
use impactlab_reconstruct::ReconstructedQuantity;
use impactlab_reconstruct::evaluate::{MethodSummary, QuantitySummary, SPEEDS, SUFFICIENT_ESS};
use impactlab_study::{Answer, EvaluateReconstructionReport, word};

/// Prints the summary of each speed, the time that it takes, and what is left out.
pub(in crate::cli) fn print_reconstruction_evaluation(
    out: &mut dyn Write,
    report: &Answer<EvaluateReconstructionReport>,
    units: UnitSystem,
) -> io::Result<()> {
    let (data, split) = (report.data.display(), word(&report.split));
    let (n, particles) = (report.n_cases, report.n_particles);
    writeln!(out, "{data}: {n} cases ({split}), {particles} particles")?;
    if report.stopped {
        writeln!(out, "stopped before all cases were done")?;
    }
    for speed in SPEEDS {
        print_speed(out, speed, report, units)?;
    }
    let rows: Vec<_> = report.summary.iter().map(time_row).collect();
    let enough = format!("ESS {SUFFICIENT_ESS} or more");
    let header = ["known", "method", "cases", "median [s]", "90 % within [s]", &*enough];
    writeln!(out, "\ntime of a case")?;
    print_table(out, &header, &rows)?;
    for case in &report.left_out {
        writeln!(out, "left out: {case}")?;
    }
    print_caveats(out, &report.caveats)
}

fn print_speed(
    out: &mut dyn Write,
    speed: ReconstructedQuantity,
    report: &EvaluateReconstructionReport,
    units: UnitSystem,
) -> io::Result<()> {
    let unit = Quantity::Speed.display_unit(units);
    let row = |summary: &MethodSummary, of: &QuantitySummary| {
        let coverage = [of.coverage_50, of.coverage_80, of.coverage_90, of.coverage_95];
        let sizes = [of.median_absolute_error, of.median_error, of.median_width_90, of.mean_crps];
        let labels = [summary.known.label().to_owned(), summary.method.label().to_owned()];
        labels
            .into_iter()
            .chain([of.n.to_string()])
            .chain(coverage.map(percent))
            .chain(sizes.map(|si| format!("{:.2}", unit.from_si(si))))
            .collect()
    };
    let found = report.summary.iter().filter_map(|summary| {
        let of = summary.quantities.iter().find(|of| of.name == speed.key())?;
        Some(row(summary, of))
    });
    let rows: Vec<Vec<String>> = found.collect();
    if rows.is_empty() {
        return Ok(());
    }
    let symbol = unit.symbol;
    writeln!(out, "\n{}: truths within intervals of 50 to 95 %, sizes in {symbol}", speed.label())?;
    let header = [
        "known",
        "method",
        "n",
        "50 %",
        "80 %",
        "90 %",
        "95 %",
        "|error|, median",
        "error, median",
        "width of 90 %, median",
        "CRPS, mean",
    ];
    print_table(out, &header, &rows)
}

fn time_row(summary: &MethodSummary) -> Vec<String> {
    vec![
        summary.known.label().to_owned(),
        summary.method.label().to_owned(),
        summary.n_cases.to_string(),
        format!("{:.1}", summary.median_seconds),
        format!("{:.1}", summary.p90_seconds),
        summary.n_sufficient_ess.map_or_else(String::new, |n| n.to_string()),
    ]
}
