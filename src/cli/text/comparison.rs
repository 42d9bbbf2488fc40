//! A comparison of response models, table by table.

use std::io::{self, Write};

use crate::cli::console::{print_caveats, print_table};
use impactlab_networks::response::evaluate::all_tables;
use impactlab_study::{Answer, CompareReport};

/// Prints the tables below each other.
pub(in crate::cli) fn print_comparison(
    out: &mut dyn Write,
    report: &Answer<CompareReport>,
) -> io::Result<()> {
    let comparison = &report.comparison;
    writeln!(
        out,
        "{}: {} trajectories that no model has seen, seed {}",
        comparison.data,
        comparison.test.len(),
        comparison.seed
    )?;
    for (title, _, table) in all_tables(comparison) {
        if table.rows.is_empty() {
            continue;
        }
        writeln!(out, "\n{title}")?;
        let header: Vec<&str> = table.header.iter().map(String::as_str).collect();
        print_table(out, &header, &table.rows)?;
    }
    for case in &report.left_out {
        writeln!(out, "left out: {case}")?;
    }
    print_caveats(out, &report.caveats)
}
