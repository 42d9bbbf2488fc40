//! The simulation of one vehicle, as a person reads it.

use std::io::{self, Write};
use std::path::Path;

use crate::cli::console::{
    print_caveats, print_facts, print_table, shown, shown_path, shown_vector,
};
use crate::cli::text::contact::surface;
use crate::cli::text::motion_prediction::{rest_facts, shown_share};
use crate::cli::text::sensitivity::print_sensitivity;
use impactlab_core::units::{Quantity, UnitSystem, percent};
use impactlab_study::analysis::Spread;
use impactlab_study::{
    ForceReport, FrictionZoneReport, RestState, SimulateReport, TireMarkReport, VehicleUncertainty,
};

/// A name and a value.
type Fact = (&'static str, String);

/// Prints what came out.
///
/// - `out`: where the motion was written.
pub(in crate::cli) fn print_simulation(
    text: &mut dyn Write,
    (report, out): (&SimulateReport, Option<&Path>),
    units: UnitSystem,
) -> io::Result<()> {
    let number = |quantity, value| shown(quantity, value, units);
    let vector = |quantity, value| shown_vector(quantity, value, ["x", "y"], units);
    let simulation = format!(
        "{} s, {} equations, {}, friction {}",
        report.duration_s, report.equations, report.integrator, report.friction
    );
    let mut facts: Vec<Fact> =
        vec![("vehicle", report.vehicle.clone()), ("simulation", simulation)];
    let zones = FrictionZoneReport::listed(&report.friction_zones);
    facts.extend(zones.map(|zones| ("friction zones", zones)));
    facts.extend(report.force.iter().flat_map(|force| force_facts(force, &report.name, units)));
    facts.extend(report.momentum.iter().map(|momentum| ("momentum", surface(momentum))));
    if let Some(delta_v) = report.delta_v_m_s {
        facts.push(("Δv over contact", vector(Quantity::Speed, delta_v)));
    }
    if let Some(end) = &report.end {
        facts.push(("end position", vector(Quantity::Length, [end.x_m, end.y_m])));
        facts.extend(report.distance_m.map(|m| ("distance", number(Quantity::Length, m))));
        facts.push(("final heading", number(Quantity::Angle, end.yaw_rad)));
        let change = report.largest_yaw_change_rad;
        facts.extend(change.map(|rad| ("largest yaw change", number(Quantity::Angle, rad))));
        facts.push(("final speed", number(Quantity::Speed, end.speed_m_s)));
        facts.push(("at rest", rest_text(report.rest.as_ref(), units)));
    }
    if let Some(error) = &report.error {
        facts.push(("average error", number(Quantity::Length, error.average_error_m)));
        facts.push(("final error", number(Quantity::Length, error.final_error_m)));
    }
    facts.extend(report.caveats.notes().map(|note| ("note", note.to_owned())));
    facts.extend(out.map(|path| ("written", shown_path(path))));
    print_facts(text, &facts)?;
    print_tire_marks(text, &report.tire_marks, units)?;
    if let Some(uncertainty) = &report.uncertainty {
        print_uncertainty(text, uncertainty, units)?;
    }
    print_caveats(text, &report.caveats)
}

/// Prints the marks that tires leave.
fn print_tire_marks(
    text: &mut dyn Write,
    marks: &[TireMarkReport],
    units: UnitSystem,
) -> io::Result<()> {
    if marks.is_empty() {
        return Ok(());
    }
    let unit = Quantity::Length.display_unit(units);
    let length = |si: f64| format!("{:.1}", unit.from_si(si));
    let row = |mark: &TireMarkReport| {
        let end =
            |time_s: f64, [x, y]: [f64; 2]| vec![format!("{time_s:.2}"), length(x), length(y)];
        let wheel = format!("{}, {}", mark.vehicle, mark.wheel.label());
        let mut row = vec![wheel, mark.kind.label().to_owned(), length(mark.length_m)];
        row.extend(end(mark.from_s, mark.start_m));
        row.extend(end(mark.to_s, mark.end_m));
        row
    };
    let rows: Vec<Vec<String>> = marks.iter().map(row).collect();
    let [long, x, y] = ["length", "X", "Y"].map(|name| format!("{name} [{}]", unit.symbol));
    writeln!(text, "\ntire marks, computed")?;
    print_table(text, &["wheel", "by", &long, "from [s]", &x, &y, "to [s]", &x, &y], &rows)
}

/// Prints how the end varies with what the data sheet leaves open, and what it depends on most.
fn print_uncertainty(
    text: &mut dyn Write,
    uncertainty: &VehicleUncertainty,
    units: UnitSystem,
) -> io::Result<()> {
    let VehicleUncertainty { n_draws, n_failed, x_m, y_m, yaw_rad, speed_m_s, .. } = uncertainty;
    let row = |name: &str, quantity, spread: &Spread| {
        let [low, high] = spread.ninety.map(|value| shown(quantity, value, units));
        vec![name.to_owned(), shown(quantity, spread.median, units), format!("{low} to {high}")]
    };
    let rows = [
        row("end, X", Quantity::Length, x_m),
        row("end, Y", Quantity::Length, y_m),
        row("final heading", Quantity::Angle, yaw_rad),
        row("final speed", Quantity::Speed, speed_m_s),
    ];
    let failed = if *n_failed > 0 { format!(", {n_failed} left out") } else { String::new() };
    writeln!(text, "\nover {n_draws} vehicles drawn from the data sheet{failed}")?;
    print_table(text, &["", "median", "90 %"], &rows)?;
    if let Some(rest) = &uncertainty.rest {
        let mut facts = vec![("over these vehicles", shown_share(rest))];
        facts.extend(rest_facts(rest, units));
        print_facts(text, &facts)?;
    }
    if let Some(probability) = uncertainty.second_contact_probability {
        writeln!(text, "P(second contact) {}", percent(probability))?;
    }
    print_sensitivity(text, &uncertainty.sensitivity)
}

/// When and where the vehicle has come to rest.
fn rest_text(rest: Option<&RestState>, units: UnitSystem) -> String {
    let Some(rest) = rest else { return "no, still moving at the end".to_owned() };
    let position = shown_vector(Quantity::Length, [rest.x_m, rest.y_m], ["x", "y"], units);
    let distance = shown(Quantity::Length, rest.distance_m, units);
    let heading = shown(Quantity::Angle, rest.yaw_rad, units);
    format!("after {:.2} s and {distance}, {position}, heading {heading}", rest.time_s)
}

fn force_facts(force: &ForceReport, name: &str, units: UnitSystem) -> Vec<Fact> {
    let source = force.path.as_ref().map_or(name.to_owned(), |path| shown_path(path));
    let (sampling, axes) = (force.sampling.replace('_', " "), &force.axes);
    let impulse = shown_vector(Quantity::Impulse, force.impulse_n_s, ["x", "y"], units);
    let contact = force.contact_start_s.zip(force.contact_end_s);
    let mut facts = vec![
        ("force", format!("{source} ({axes} axes, {sampling})")),
        ("yaw moment", format!("from the {}", force.yaw_moment.replace('_', " "))),
        ("impulse", impulse),
    ];
    facts.extend(contact.map(|(start, end)| ("contact", format!("{start:.4} s to {end:.4} s"))));
    facts
}
