//! Which estimates of a vehicle the end of its motion depends on, as a person reads it.

use std::io::{self, Write};

use crate::analysis::Sensitivity;
use crate::cli::console::print_table;

/// Estimates with less than this share in the position and in the heading are not printed.
const SMALL_SHARE: f64 = 0.02;

/// Prints the shares of the estimates in the variance of the end; nothing if there are none.
pub(super) fn print_sensitivity(out: &mut dyn Write, shares: &[Sensitivity]) -> io::Result<()> {
    let percent = |share: f64| format!("{:.0} %", share * 100.0);
    let is_large =
        |share: &&Sensitivity| share.position_share.max(share.heading_share) >= SMALL_SHARE;
    let row = |share: &Sensitivity| {
        let (position, heading) = (percent(share.position_share), percent(share.heading_share));
        vec![share.label.to_owned(), position, heading]
    };
    let rows: Vec<_> = shares.iter().filter(is_large).map(row).collect();
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nof the variance of the end, by what the data sheet leaves open")?;
    print_table(out, &["estimate", "position", "heading"], &rows)?;
    writeln!(out)
}
