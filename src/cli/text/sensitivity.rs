//! Which estimates of a vehicle the end of its motion depends on, as a person reads it.

use std::io::{self, Write};

use crate::cli::console::print_table;
use impactlab_study::analysis::Sensitivity;

/// Prints the shares of the estimates in the variance of the end, as far as they are more than chance;
/// nothing if there are none.
pub(super) fn print_sensitivity(out: &mut dyn Write, shares: &[Sensitivity]) -> io::Result<()> {
    let percent = |share: f64| format!("{:.0} %", share * 100.0);
    let row = |share: &Sensitivity| {
        let (position, heading) = (percent(share.position_share), percent(share.heading_share));
        vec![share.label.to_owned(), position, heading]
    };
    let rows: Vec<_> = shares.iter().filter(|share| share.is_clear()).map(row).collect();
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nlinear share in the variance of the end of what the data sheet leaves open")?;
    print_table(out, &["estimate", "position", "heading"], &rows)?;
    writeln!(out)
}
