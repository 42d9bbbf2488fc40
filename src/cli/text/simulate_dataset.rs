//! The simulation of a data set, as a person reads it.

use std::io::{self, Write};
use std::path::Path;

use crate::cli::console::{print_caveats, print_table, shown_path};
use impactlab_core::numerics::Summary;
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_study::{Answer, ReplayedCaseReport, SimulateDatasetReport};

/// Prints the errors case by case and over all.
///
/// - `folder`: where the motions were written.
pub(in crate::cli) fn print_dataset_simulation(
    out: &mut dyn Write,
    report: &Answer<SimulateDatasetReport>,
    folder: Option<&Path>,
    units: UnitSystem,
) -> io::Result<()> {
    let length = Quantity::Length.display_unit(units);
    let degrees = Quantity::Angle.display_unit(units);
    writeln!(out, "{}: {}, {}\n", shown_path(&report.dataset), report.vehicle, report.integrator)?;
    let row = |case: &ReplayedCaseReport| {
        let flags: Vec<&str> = case.flags.iter().map(|f| f.caveat.text.as_str()).collect();
        let error = &case.error;
        vec![
            case.case.clone(),
            if case.spin { "spin" } else { "" }.to_owned(),
            format!("{:.3}", length.from_si(error.average_error_m)),
            format!("{:.3}", length.from_si(error.final_error_m)),
            format!("{:.1}", degrees.from_si(error.final_heading_error_rad)),
            flags.join("; "),
        ]
    };
    let rows: Vec<_> = report.cases.iter().map(row).collect();
    let average = format!("average error [{}]", length.symbol);
    let last = format!("final error [{}]", length.symbol);
    let heading = format!("final heading error [{}]", degrees.symbol);
    let header = ["case", "motion", &average, &last, &heading, "flags"];
    print_table(out, &header, &rows)?;
    writeln!(out)?;
    let groups = [
        ("all", &report.overall),
        ("spinning", &report.spinning),
        ("not spinning", &report.not_spinning),
    ];
    let summaries =
        groups.into_iter().filter_map(|(name, summary)| Some((name, summary.as_ref()?)));
    let rows: Vec<_> = summaries
        .flat_map(|(name, summary)| {
            [
                summary_row(name, &average, &summary.average_error_m, length.si_per_unit),
                summary_row(name, &last, &summary.final_error_m, length.si_per_unit),
                summary_row(name, &heading, &summary.final_heading_error_rad, degrees.si_per_unit),
            ]
        })
        .collect();
    let header = ["cases", "", "n", "mean", "std", "median", "p90", "max"];
    print_table(out, &header, &rows)?;
    for failure in &report.failures {
        writeln!(out, "failed: {failure}")?;
    }
    if let Some(folder) = folder {
        writeln!(out, "written: {}", shown_path(folder))?;
    }
    print_caveats(out, &report.caveats)
}

fn summary_row(name: &str, what: &str, summary: &Summary, si_per_unit: f64) -> Vec<String> {
    let Summary { n, mean, std, median, p90, max, .. } = *summary;
    let figures = [mean, std, median, p90, max].map(|value| format!("{:.3}", value / si_per_unit));
    let words = [name.to_owned(), what.to_owned(), n.to_string()];
    words.into_iter().chain(figures).collect()
}
