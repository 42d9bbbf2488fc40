//! A reconstruction for a person.

use std::io::{self, Write};

use crate::cli::console::{print_caveats, print_table};
use impactlab_core::units::{Quantity, UnitSystem, percent};
use impactlab_reconstruct::{MarkComparison, QuantityEstimate};
use impactlab_study::{FrictionZoneReport, ReconstructReport};

/// Prints quantities, modes, fit and budget.
pub(in crate::cli) fn print_reconstruction(
    out: &mut dyn Write,
    report: &ReconstructReport,
    units: UnitSystem,
) -> io::Result<()> {
    writeln!(out, "{}\n", report.case)?;
    let rows: Vec<_> = report.quantities.iter().map(|of| quantity_row(of, units)).collect();
    print_table(out, &["quantity", "unit", "median", "50 %", "90 %", "95 %"], &rows)?;
    if let Some([value, sigma]) = report.by_hand_m_s {
        let unit = Quantity::Speed.display_unit(units);
        let [value, sigma] = [value, sigma].map(|si| unit.from_si(si));
        let symbol = unit.symbol;
        writeln!(out, "by hand: struck car {value:.1} ± {sigma:.1} {symbol} (one sigma)")?;
    }
    if let Some(zones) = FrictionZoneReport::listed(&report.friction_zones) {
        writeln!(out, "friction zones: {zones}")?;
    }
    if report.modes.len() > 1 {
        writeln!(out)?;
        let rows: Vec<_> = report
            .modes
            .iter()
            .map(|mode| {
                let first = mode.quantities.first().map(|of| quantity_row(of, units));
                let [median, ninety] = match first {
                    Some(row) => [format!("{} {}", row[2], row[1]), row[4].clone()],
                    None => [String::new(), String::new()],
                };
                vec![percent(mode.probability), mode.name.clone(), median, ninety]
            })
            .collect();
        print_table(out, &["", "course of events", "struck car", "90 %"], &rows)?;
    }
    writeln!(out)?;
    let rows: Vec<_> = report
        .fit
        .iter()
        .map(|item| {
            let numbers = [item.expected, item.found].map(|value| format!("{value:.3}"));
            let [expected, found] = numbers;
            let note = if item.is_unexplained() { "unexplained" } else { "" };
            let p = format!("{:.3}", item.p);
            vec![item.evidence.clone(), item.unit.into(), expected, found, p, note.into()]
        })
        .collect();
    print_table(out, &["evidence", "unit", "expected", "found", "p", ""], &rows)?;
    print_marks(out, &report.marks, units)?;
    print_budget(out, report, units)?;
    let (ess, n) = (report.ess, report.n_simulations);
    writeln!(out, "\n{n} motions, effective sample size {ess:.0}")?;
    print_caveats(out, &report.caveats)
}

/// The marks that were found beside those that are computed.
fn print_marks(out: &mut dyn Write, marks: &[MarkComparison], units: UnitSystem) -> io::Result<()> {
    if marks.is_empty() {
        return Ok(());
    }
    let unit = Quantity::Length.display_unit(units);
    let length = |si: f64| format!("{:.2}", unit.from_si(si));
    let known = |si: Option<f64>| si.map_or_else(|| "no mark".to_owned(), length);
    let row = |mark: &MarkComparison| {
        let lengths = [mark.found_length_m, mark.computed_length_m].map(length);
        let distances = [mark.mean_distance_m, mark.largest_distance_m].map(known);
        [vec![mark.wheel.label().to_owned()], lengths.to_vec(), distances.to_vec()].concat()
    };
    let rows: Vec<_> = marks.iter().map(row).collect();
    writeln!(out, "\ntire marks and those of a particle of median speed, {}", unit.symbol)?;
    let titles = ["wheel", "found", "computed", "mean distance", "largest distance"];
    print_table(out, &titles, &rows)
}

/// What further evidence would bring, the most useful first.
fn print_budget(
    out: &mut dyn Write,
    report: &ReconstructReport,
    units: UnitSystem,
) -> io::Result<()> {
    let mut items: Vec<_> = report.budget.iter().filter(|item| item.believable).collect();
    items.sort_by(|a, b| a.then_m_s.total_cmp(&b.then_m_s));
    let unit = Quantity::Speed.display_unit(units);
    let speed = |si: f64| format!("{:.1}", unit.from_si(si));
    let rows: Vec<_> = items
        .iter()
        .map(|item| {
            let known = format!("{} ± {}", item.known, item.sigma);
            vec![known, speed(item.now_m_s), speed(item.then_m_s)]
        })
        .collect();
    writeln!(out, "\nspeed of the struck car, half of the 90 % interval, {}", unit.symbol)?;
    print_table(out, &["if it were known", "now", "then"], &rows)
}

/// Name, unit, median and intervals in the shown unit.
fn quantity_row(of: &QuantityEstimate, units: UnitSystem) -> Vec<String> {
    let shown = of.shown(units);
    let interval = |[low, high]: &[String; 2]| format!("{low} to {high}");
    let name = of.name.strip_suffix(suffix(of.unit)).unwrap_or(of.name).replace('_', " ");
    vec![
        name,
        shown.unit.to_owned(),
        shown.median.clone(),
        interval(&shown.interval_50),
        interval(&shown.interval_90),
        interval(&shown.interval_95),
    ]
}

/// The unit at the end of a key.
fn suffix(unit: &str) -> &'static str {
    match unit {
        "m/s" => "_m_s",
        "rad" => "_rad",
        "rad/s" => "_rad_s",
        _ => "",
    }
}
