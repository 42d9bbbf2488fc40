//! A predicted force, as a person reads it.

use std::io::{self, Write};

use crate::cli::console::{print_caveats, print_facts, shown};
use crate::cli::text::contact::implied_facts;
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_study::PredictForceReport;
use impactlab_study::analysis::Estimate;

/// Prints medians and 90 % intervals, and where the collision lies outside what was learned from.
pub(in crate::cli) fn print_force_prediction(
    out: &mut dyn Write,
    report: &PredictForceReport,
    units: UnitSystem,
) -> io::Result<()> {
    let number = |quantity, value| shown(quantity, value, units);
    let estimate = |quantity, of: &Estimate| {
        let interval = of.interval(0.9).map_or(String::new(), |ends| {
            let [low, high] = ends.map(|end| number(quantity, end));
            format!(" (90 %: {low} to {high})")
        });
        format!("{}{interval}", number(quantity, of.median))
    };
    writeln!(out, "{}\n", report.scenario)?;
    let [px, py] = report.impulse_n_s.mean.map(|p| number(Quantity::Impulse, p));
    let pdof = format!("{:.1} deg, {} o'clock", report.pdof_deg, report.pdof_clock);
    let hooking = report.hooking_probability;
    let facts = [
        ("impulse", format!("x {px}, y {py}")),
        ("|impulse|", estimate(Quantity::Impulse, &report.impulse_n_s.magnitude)),
        ("peak", estimate(Quantity::Force, &report.peak_n)),
        ("duration", estimate(Quantity::Time, &report.duration_s)),
        ("PDOF", pdof),
        ("hooking", hooking.map_or("unknown".to_owned(), |p| format!("{:.0} %", 100.0 * p))),
    ];
    let mut facts = facts.to_vec();
    facts.extend(report.implied_contact.iter().flat_map(|of| implied_facts(of, units)));
    print_facts(out, &facts)?;
    let open = [("contact point", report.is_contact_open), ("bullet body", report.is_body_open)];
    for (what, _) in open.into_iter().filter(|(_, is_open)| *is_open) {
        writeln!(out, "\nThe {what} is open: drawn from the training cases.")?;
    }
    print_caveats(out, &report.caveats)
}
