//! How well the evidence is explained, and which courses of events it leaves possible.

use crate::report::Block;
use crate::report::answer::Context;
use crate::report::answer::facts::facts_table;
use crate::report::answer::tire_marks::compared_marks;
use crate::report::numbers::{Wording, fill};
use impactlab_core::units::Quantity;
use impactlab_reconstruct::EvidenceFit;
use impactlab_study::ReconstructReport;
use impactlab_study::facts::FactTable;

/// The fit of each item, and the courses of events with their probabilities.
pub(super) fn evidence_blocks(report: &ReconstructReport, context: Context<'_>) -> Vec<Block> {
    let words = context.wording.words;
    let level = context.wording.given_number(EvidenceFit::UNEXPLAINED_BELOW);
    let table = |table: &FactTable| facts_table(table, context);
    let mut blocks = vec![
        Block::heading(2, report.case.clone()),
        Block::paragraph(fill(words.fit_text, &[("level", &level)])),
    ];
    blocks.extend([report.fit_table(), report.path_fit_table()].iter().flatten().map(table));
    if let Some(left_out) = report.left_out_table() {
        blocks.extend([Block::paragraph(words.left_out_text), table(&left_out)]);
    }
    blocks.extend(compared_marks(report, context));
    if !report.modes.is_empty() {
        blocks.extend([table(&report.course_table()), Block::paragraph(words.modes_text)]);
    }
    blocks.extend(report.course_tables().iter().map(table));
    blocks
}

/// A value with its standard deviation in the units of the report.
pub(super) fn measured(quantity: Quantity, [value, sigma]: [f64; 2], wording: &Wording) -> String {
    wording.measured(quantity, value, sigma)
}
