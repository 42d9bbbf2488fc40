//! Measures the models again and writes `assets/validation.toml`, from which answers and reports state
//! their error rates; the same lines are put into `docs/VALIDATION.md`.
//!
//! ```text
//! cargo run --release --example validation                          # all but reconstructions
//! cargo run --release --example validation -- DIR/evaluation.json   # and reconstructions, if evaluated
//! cargo run --release --example validation -- --same reconstruction_of_rest
//! ```
//!
//! Reconstructions take hours and are read from the files that `impactlab evaluate reconstruction
//! datasets/staged --known WHAT --out DIR` has written; `--same` says that a measurement is that of this
//! build, though its date stays that of the measurement.

#![allow(clippy::print_stdout)]

mod probes;
mod response;
mod tables;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use impactlab_core::data::{Existing, write_bytes};
use impactlab_document::report::ReportDate;
use impactlab_study::{HeldIntervals, Measured, Measurement, Measurements, ValidationTable};
use serde::Deserialize;

/// A measurement that was made: the rows of its tables, and what its intervals held.
struct Found {
    subject: Measured,
    /// Without the headers.
    tables: Vec<Vec<Row>>,
    held: Vec<HeldIntervals>,
    held_in_all: Vec<HeldIntervals>,
}

/// A row of a table.
struct Row {
    /// The cells that name it, with their separators.
    name: String,
    /// The whole line.
    line: String,
}

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = tables::quick(&root.join("datasets"))?;
    let mut same = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument == "--same" {
            let subject = arguments.next().ok_or("expected: --same SUBJECT")?;
            same.push(Measured::deserialize(serde_json::Value::String(subject))?);
        } else {
            found
                .extend(tables::reconstructions(&PathBuf::from(argument), &root.join("datasets"))?);
        }
    }
    let mut all = Measurements { all: Measurements::shipped().to_vec() };
    let today = ReportDate::from_instant(SystemTime::now()).ok_or("no date")?.to_string();
    let document_path = root.join("docs/VALIDATION.md");
    let mut document = fs::read_to_string(&document_path)?;
    for measurement in &mut all.all {
        let of = |found: &&Found| found.subject == measurement.subject;
        match found.iter().find(of) {
            Some(found) => {
                document = replace(measurement, found, document)?;
                measurement.date.clone_from(&today);
            }
            None if same.contains(&measurement.subject) => {}
            None => {
                println!("{:?}: not measured", measurement.subject);
                continue;
            }
        }
        measurement.data_sha256 = probes::data_sha256(root, &measurement.data)?;
        measurement.probe = probes::probe(root, measurement.subject)?;
    }
    let text = format!(
        "# Written by `cargo run --release --example validation`, not by hand.\n\n{}",
        toml::to_string_pretty(&all)?
    );
    let write = |path: &Path, text: &str| write_bytes(path, Existing::Replace, text.as_bytes());
    write(&root.join("assets/validation.toml"), &text)?;
    write(&document_path, &document)?;
    Ok(())
}

/// Puts what was found into a measurement and into the tables of the document. Rows of the document that
/// were not measured stay.
fn replace(
    measurement: &mut Measurement,
    found: &Found,
    mut document: String,
) -> Result<String, Box<dyn Error>> {
    for (table, rows) in measurement.tables.iter_mut().zip(&found.tables) {
        document = replaced(&document, table, rows)?;
        let header = table.lines.iter().take(1).cloned();
        table.lines = header.chain(rows.iter().map(|row| row.line.clone())).collect();
    }
    measurement.held.clone_from(&found.held);
    measurement.held_in_all.clone_from(&found.held_in_all);
    Ok(document)
}

/// The document with the rows of one table replaced by those of the same names.
fn replaced(
    document: &str,
    table: &ValidationTable,
    rows: &[Row],
) -> Result<String, Box<dyn Error>> {
    let missing = || format!("no table {:?} below {}", table.lines.first(), table.heading);
    let lines: Vec<&str> = document.lines().collect();
    let heading = lines.iter().position(|line| *line == table.heading).ok_or_else(missing)?;
    // Rows are found by the header above them, so that one who has typed new rows finds them, too.
    let header = table.lines.first().ok_or_else(missing)?;
    let below = lines.iter().skip(heading).position(|line| line == header).ok_or_else(missing)?;
    let first = (heading + below + 2).min(lines.len());
    let n = lines.iter().skip(first).take_while(|line| line.starts_with('|')).count();
    let (before, rest) = lines.split_at(first);
    let (old, after) = rest.split_at(n);
    let mut missing_rows: Vec<&Row> = rows.iter().collect();
    let mut body = Vec::new();
    for line in old {
        let row = rows.iter().find(|row| line.starts_with(&row.name));
        missing_rows.retain(|of| row.is_none_or(|row| row.name != of.name));
        body.push(row.map_or_else(|| (*line).to_owned(), |row| row.line.clone()));
    }
    body.extend(missing_rows.iter().map(|row| row.line.clone()));
    let all: Vec<String> = before
        .iter()
        .map(|line| (*line).to_owned())
        .chain(body)
        .chain(after.iter().map(|line| (*line).to_owned()))
        .collect();
    Ok(all.join("\n") + "\n")
}
