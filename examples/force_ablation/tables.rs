//! What is printed: Markdown tables of rows that are done.

use std::collections::BTreeMap;
use std::f64::consts::LN_2;

use impactlab_core::numerics::Summary;

use crate::curve::PowerLaw;
use crate::judged::{
    Judged, JudgedCase, Mean, QUANTITIES, Quantity, difference, level_percent, mean,
};
use crate::rows::{PHYSICS, Row, SHIPPED};
use crate::store::Store;
use crate::tasks::{ALL, Task};

/// A row with what it predicted after learning from so many cases.
#[derive(Clone)]
struct Done<'a> {
    row: &'a Row,
    /// Mean number of cases that it learned from.
    n_train: f64,
    judged: Judged<'a>,
}

/// Prints all tables.
pub fn print(tasks: &[Task], rows: &[Row], store: &Store) {
    let mut sizes: Vec<usize> = tasks.iter().map(|task| task.size).collect();
    sizes.dedup();
    let mut curves: BTreeMap<usize, Vec<Done<'_>>> = BTreeMap::new();
    for size in sizes {
        let of_size: Vec<&Task> = tasks.iter().filter(|task| task.size == size).collect();
        let mut done = Vec::new();
        for (place, row) in rows.iter().enumerate() {
            match gathered(row, &of_size, store) {
                Ok(found) => {
                    curves.entry(place).or_default().push(found.clone());
                    done.push(found);
                }
                Err(n_missing) => eprintln!(
                    "{}, {}: {n_missing} of {} parts are not done",
                    row.name,
                    size_label(size),
                    of_size.len()
                ),
            }
        }
        print_size(size, &done);
    }
    for done in curves.values().filter(|done| done.len() > 1) {
        print_curve(done);
    }
}

/// What a row predicted in all tasks of a size; else how many of them are not done.
fn gathered<'a>(row: &'a Row, tasks: &[&Task], store: &'a Store) -> Result<Done<'a>, usize> {
    let (mut judged, mut n_missing) = (Judged::new(), 0);
    for task in tasks {
        match store.find(&task.identity(row)) {
            Some(part) => {
                let keyed = |case: &'a JudgedCase| ((task.seed, case.digest.as_str()), case);
                judged.extend(part.cases.iter().map(keyed));
            }
            None => n_missing += 1,
        }
    }
    let n_train = tasks.iter().map(|task| task.n_train() as f64).sum::<f64>() / tasks.len() as f64;
    if n_missing > 0 { Err(n_missing) } else { Ok(Done { row, n_train, judged }) }
}

fn size_label(size: usize) -> String {
    if size == ALL { "all cases".to_owned() } else { format!("{size} cases") }
}

/// Prints what rows are worth after learning from so many cases.
fn print_size(size: usize, done: &[Done<'_>]) {
    let Some(first) = done.first() else { return };
    println!("\n## {} to learn from, {:.0} in the mean", size_label(size), first.n_train);
    println!(
        "\n| | history | all cases | RMSE | impulse | peak | duration | F(t) in {0:.0} % | impulse in | \
         peak in | CRPS [kN] | NLL |",
        level_percent()
    );
    println!("|{}", " --- |".repeat(12));
    done.iter().for_each(print_row);
    for (name, title) in [(PHYSICS, "over the physics alone"), (SHIPPED, "against the default")] {
        let Some(reference) = done.iter().find(|done| done.row.name == name) else { continue };
        let others: Vec<&Done<'_>> = done.iter().filter(|done| done.row.name != name).collect();
        if !others.is_empty() {
            print_differences(title, reference, &others);
        }
    }
}

/// Prints errors in %, shares of the recorded values inside intervals in %, CRPS in kN and negative
/// log-likelihood in nats.
fn print_row(done: &Done<'_>) {
    let cases = || done.judged.values().copied();
    let clean = || cases().filter(|case| case.is_clean);
    let percent = |share: f64| format!("{:.1}", 100.0 * share);
    let cells = [
        percent(mean_of(clean().map(|case| case.errors.history_error))),
        percent(mean_of(cases().map(|case| case.errors.history_error))),
        percent(mean_of(clean().map(|case| case.errors.rmse_over_peak))),
        percent(median_of(clean().map(|case| case.errors.impulse_error))),
        percent(median_of(clean().map(|case| case.errors.peak_error))),
        percent(median_of(clean().map(|case| case.errors.duration_error))),
        percent(mean_of(cases().map(|case| case.held[0]))),
        percent(mean_of(cases().map(|case| case.held[1]))),
        percent(mean_of(cases().map(|case| case.held[2]))),
        format!("{:.2}", mean_of(cases().map(|case| case.crps_force_n / 1e3))),
        format!("{:.0}", median_of(cases().map(|case| case.nll_nats))),
    ];
    println!("| {} | {} |", done.row.label, cells.join(" | "));
}

fn mean_of(values: impl Iterator<Item = f64>) -> f64 {
    Summary::from_values(values).map_or(f64::NAN, |summary| summary.mean)
}

fn median_of(values: impl Iterator<Item = f64>) -> f64 {
    Summary::from_values(values).map_or(f64::NAN, |summary| summary.median)
}

/// Prints how much larger the mean errors are than those of another row, on the same cases; bold where it
/// is more than twice its standard error.
fn print_differences(title: &str, reference: &Done<'_>, others: &[&Done<'_>]) {
    let names: Vec<&str> = QUANTITIES.iter().map(|quantity| quantity.name).collect();
    println!("\n| mean error {title}, less is better | {} |", names.join(" | "));
    println!("|{}", " --- |".repeat(1 + QUANTITIES.len()));
    for done in others {
        let cell = |quantity: &Quantity| {
            difference(&done.judged, &reference.judged, quantity)
                .map_or("–".to_owned(), |mean| difference_text(&mean))
        };
        let cells: Vec<String> = QUANTITIES.iter().map(cell).collect();
        println!("| {} | {} |", done.row.label, cells.join(" | "));
    }
}

fn difference_text(mean: &Mean) -> String {
    let n_decimals = if mean.standard_error < 1.0 { 2 } else { 0 };
    let text = format!("{:+.n_decimals$} ± {:.n_decimals$}", mean.value, mean.standard_error);
    if mean.value.abs() > 2.0 * mean.standard_error { format!("**{text}**") } else { text }
}

/// Prints the learning curve of a row.
fn print_curve(done: &[Done<'_>]) {
    let Some(first) = done.first() else { return };
    println!("\n## Learning curve: {}", first.row.label);
    for quantity in &QUANTITIES {
        println!("\n| cases | {} | exponent | gain by doubling |", quantity.name);
        println!("|{}", " --- |".repeat(4));
        let mut points: Vec<[f64; 2]> = Vec::new();
        let mut gains: Vec<[f64; 2]> = Vec::new();
        let mut before: Option<&Done<'_>> = None;
        for done in done {
            let Some(error) = mean(&done.judged, quantity) else { continue };
            let gain = before.and_then(|before| gain(before, done, quantity));
            let exponent = points
                .last()
                .map_or(f64::NAN, |[n, last]| -(error / last).ln() / (done.n_train / n).ln());
            let exponent =
                if exponent.is_finite() { format!("{exponent:.2}") } else { "–".into() };
            let text = gain.map_or("–".to_owned(), |gain| difference_text(&gain));
            println!("| {:.0} | {error:.2} | {exponent} | {text} |", done.n_train);
            points.push([done.n_train, error]);
            gains.extend(gain.map(|gain| [gain.value, gain.standard_error]));
            before = Some(done);
        }
        println!("\n{}", verdict(&points, &gains));
    }
}

/// How much twice as many cases take off an error, from the step between two numbers of cases.
fn gain(before: &Done<'_>, after: &Done<'_>, quantity: &Quantity) -> Option<Mean> {
    let gain = difference(&before.judged, &after.judged, quantity)?;
    let n_doublings = (after.n_train / before.n_train).ln() / LN_2;
    (n_doublings > 0.0).then(|| Mean {
        value: gain.value / n_doublings,
        standard_error: gain.standard_error / n_doublings,
    })
}

/// The power law, and where more cases stop paying.
///
/// - `points`: number of cases and error; `gains`: gain by doubling and its standard error.
fn verdict(points: &[[f64; 2]], gains: &[[f64; 2]]) -> String {
    let stops = gains.iter().position(|[gain, error]| gain < error).and_then(|i| points.get(i));
    let measured = match stops {
        Some([n, _]) => {
            format!("From {n:.0} cases on a doubling gained less than its standard error.")
        }
        None => "Every doubling gained more than its standard error.".to_owned(),
    };
    let Some((law, [_, error])) = PowerLaw::fit(points).zip(gains.last().copied()) else {
        return format!("{measured} No power law fits.");
    };
    let n = law.n_of_gain(error);
    let of_law = match points.last() {
        Some([most, _]) if n > *most => format!("from {n:.0} cases on, beyond those measured"),
        _ => format!("from {n:.0} cases on"),
    };
    let PowerLaw { a, b, c } = law;
    format!(
        "{measured} Power law {a:.3} n^−{b:.2} + {c:.3}; by it a doubling gains less than {error:.2} \
         {of_law}."
    )
}
