//! What the models of a report were compared with, and how far they were off.
//!
//! The tables are those of `assets/validation.toml`, header and rows as they stand in
//! `docs/VALIDATION.md` too, but those of methods that answer nothing; a test looks each of their lines up
//! there.

use std::collections::BTreeSet;

use crate::report::method::Method;
use crate::report::numbers::Wording;
use crate::report::{Block, Column, Table};
use impactlab_study::{Measured, Measurement, ValidationTable};

/// Beginnings of lines about methods that answer nothing.
const OTHER_METHODS: [&str; 2] = ["| classic pulse |", "| Gaussian processes |"];

/// What a method was compared with: a paragraph, and tables with their captions. Of a method that the opinion
/// does not rest on the paragraph alone.
pub(super) fn validation_blocks(
    method: Method,
    opinion: &BTreeSet<Method>,
    wording: &Wording,
) -> Vec<Block> {
    let words = wording.words;
    let text = match method {
        Method::Impact => words.validation_impact,
        Method::FourDof | Method::FourDofAlone => words.validation_four_dof,
        Method::ContactLaw => words.validation_contact,
        Method::ForceNetwork => words.validation_force,
        Method::ResponseNetwork => words.validation_response,
        Method::Reconstruction => words.validation_reconstruction,
        Method::SingleCar => words.validation_single_car,
        Method::DataSheet => words.validation_sheet,
    };
    let captions: &[(Measured, &str)] = match method {
        Method::Impact => &[(Measured::Impact, words.table_impact)],
        Method::FourDof | Method::FourDofAlone => &[(Measured::FourDof, words.table_four_dof)],
        Method::ContactLaw => &[(Measured::Pairs, words.table_contact)],
        Method::ForceNetwork => &[
            (Measured::ForceNetwork, words.table_force),
            (Measured::ForceNetwork, words.table_force_coverage),
        ],
        Method::ResponseNetwork => &[(Measured::ResponseNetwork, words.table_response)],
        Method::Reconstruction => &[
            (Measured::ReconstructionOfEverything, words.table_reconstruction),
            (Measured::ReconstructionWithoutEdr, words.table_without_recorder),
            (Measured::ReconstructionOfRest, words.table_rest_alone),
        ],
        Method::SingleCar | Method::DataSheet => &[],
    };
    if !opinion.is_empty() && !opinion.contains(&method) {
        return vec![Block::paragraph(format!("{}: {text}", method.name(wording)))];
    }
    let heading = Block::heading(2, method.name(wording));
    let tables = captions.iter().enumerate().filter_map(|(idx, (subject, caption))| {
        let earlier = captions[..idx].iter().filter(|(other, _)| other == subject).count();
        let measurement = Measurement::shipped(*subject)?;
        let published = measurement.tables.get(earlier)?;
        let day = wording.day(&measurement.date);
        let caption = format!("{caption} ({} {day})", words.measured_on);
        Some(Block::Table(table(&caption, published, wording)))
    });
    [heading, Block::paragraph(text)].into_iter().chain(tables).collect()
}

/// The lines as a table.
fn table(caption: &str, published: &ValidationTable, wording: &Wording) -> Table {
    let cells = |line: &str| -> Vec<String> {
        let inner = line.trim().trim_start_matches('|').trim_end_matches('|');
        inner.split('|').map(|cell| wording.validation_cell(cell.trim())).collect()
    };
    let is_shown = |line: &&String| !OTHER_METHODS.iter().any(|other| line.starts_with(other));
    let mut lines = published.lines.iter().filter(is_shown).map(|line| cells(line));
    let header = lines.next().unwrap_or_default();
    let n = header.len();
    let column = |title| Column { title, is_numeric: false };
    let rows = lines.map(|mut row| {
        row.resize(n, String::new());
        row
    });
    let caption = caption.to_owned();
    Table { caption, columns: header.into_iter().map(column).collect(), rows: rows.collect() }
}

impl Wording {
    /// A cell of these tables: words are translated, numbers get the decimal sign of the language.
    fn validation_cell(&self, cell: &str) -> String {
        let has_words = cell.chars().filter(|c| c.is_alphabetic()).count() > 1;
        if has_words { self.local(&self.term(cell)) } else { self.local(cell) }
    }
}
