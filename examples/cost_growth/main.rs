//! Measures how the cost of questions grows with their size, each point in a process of its own,
//! and prints a table for `BENCHMARKS.md` and the points as CSV; all of it takes long.
//!
//! ```text
//! cargo run --release --example cost_growth
//! cargo run --release --example cost_growth -- --only cases --largest 100000
//! ```
//!
//! The cost is the processor time of all threads and the largest memory of the process (Linux).
//! The exponent is the slope of the logarithms by least squares over the upper half of the points,
//! so that what does not grow counts little. A curve is worse than n log n if its exponent lies
//! above that of n log n over the same points by more than two standard errors.

#![allow(clippy::print_stdout, clippy::print_stderr)]

mod curves;
mod fit;
mod inputs;
mod point;

use std::error::Error;
use std::path::Path;

use clap::Parser;

use crate::curves::{CURVES, Curve};
use crate::fit::{Growth, exponent_of_n_log_n, growth, upper_half};
use crate::point::{Cost, Point};

/// What a step of a measurement gives.
type Measured<T> = Result<T, Box<dyn Error>>;

#[derive(Parser)]
struct Arguments {
    /// Only this curve; --only list prints all names
    #[arg(long)]
    only: Option<String>,
    /// Sizes up to this one instead of the curve's own largest
    #[arg(long, requires = "only", value_parser = clap::value_parser!(u64).range(1..))]
    largest: Option<u64>,
    /// Runs of each point, of which the median counts
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u64).range(1..))]
    runs: u64,
    /// Measures one point in this process: a curve, a size and the folder with what is asked about
    #[arg(long, hide = true, num_args = 3, value_names = ["NAME", "SIZE", "DIR"])]
    point: Option<Vec<String>>,
}

fn main() -> Measured<()> {
    let arguments = Arguments::parse();
    if let Some([name, size, folder]) = arguments.point.as_deref() {
        let cost = Cost::here(named(name)?, size.parse()?, Path::new(folder))?;
        println!("{}", serde_json::to_string(&cost)?);
        return Ok(());
    }
    let curves = match arguments.only.as_deref() {
        Some("list") => {
            CURVES.iter().for_each(|curve| println!("{:<10} {}", curve.name, curve.grows));
            return Ok(());
        }
        Some(name) => std::slice::from_ref(named(name)?),
        None => CURVES,
    };
    let mut rows = Vec::new();
    let mut csv = format!("{}\n", Point::CSV_HEADER);
    for curve in curves {
        let points = measured(curve, &arguments)?;
        rows.push(row(curve, &points)?);
        points.iter().for_each(|point| csv.push_str(&point.csv(curve.name)));
    }
    println!("| what grows | sizes | processor time, largest | exponent | of n log n | |");
    println!("| --- | --- | --- | --- | --- | --- |");
    rows.iter().for_each(|row| println!("{row}"));
    println!("\n{csv}");
    Ok(())
}

fn named(name: &str) -> Measured<&'static Curve> {
    let found = CURVES.iter().find(|curve| curve.name == name);
    found.ok_or_else(|| format!("no curve {name:?}; --only list prints all names").into())
}

/// The points of a curve, from the smallest to the largest.
fn measured(curve: &Curve, arguments: &Arguments) -> Measured<Vec<Point>> {
    let mut points = Vec::new();
    for size in curve.sizes(arguments.largest) {
        let folder = tempfile::tempdir()?;
        (curve.prepare)(size, folder.path())?;
        let mut costs = Vec::new();
        for _ in 0..arguments.runs {
            costs.push(Cost::in_child(curve, size, folder.path())?);
        }
        let point = Point::new(size, &costs).ok_or("no run of a point")?;
        eprintln!("{} {size}: {:.3} s", curve.name, point.processor_s);
        points.push(point);
    }
    Ok(points)
}

/// A row of the table.
fn row(curve: &Curve, points: &[Point]) -> Measured<String> {
    let cost = |point: &Point| (point.size as f64, point.cost_s(curve.is_per_motion));
    let costs: Vec<(f64, f64)> = points.iter().map(cost).collect();
    let few = || format!("{}: at least three sizes from 2 on are needed", curve.name);
    let Growth { exponent, standard_error } = growth(upper_half(&costs)).ok_or_else(few)?;
    let limit = exponent_of_n_log_n(upper_half(&costs)).ok_or_else(few)?;
    let verdict = match exponent - 2.0 * standard_error > limit {
        true => "**worse than n log n**",
        false => "",
    };
    let memory: Option<Vec<(f64, f64)>> =
        points.iter().map(|point| Some((point.size as f64, point.peak_mib?))).collect();
    let growth_of_memory = memory.as_deref().and_then(|memory| growth(upper_half(memory)));
    let memory = match (memory.as_deref().and_then(<[_]>::last), growth_of_memory) {
        (Some((_, mib)), Some(growth)) => format!("{mib:.0} MiB, exponent {:.2}", growth.exponent),
        _ => "memory not known".to_owned(),
    };
    let (first, last) = points.first().zip(points.last()).ok_or_else(few)?;
    let of_motion = if curve.is_per_motion { " a motion" } else { "" };
    let sizes = format!("{} to {}", first.size, last.size);
    let time = shown_s(last.cost_s(curve.is_per_motion));
    Ok(format!(
        "| {} | {sizes} | {time}{of_motion} | {exponent:.2} ± {standard_error:.2} | {limit:.2} \
         | {memory} {verdict} |",
        curve.grows,
    ))
}

/// A time in the unit that fits it.
fn shown_s(time_s: f64) -> String {
    match time_s {
        ..1e-3 => format!("{:.1} µs", 1e6 * time_s),
        ..1.0 => format!("{:.3} ms", 1e3 * time_s),
        _ => format!("{time_s:.2} s"),
    }
}
