//! Marks of tires in a report: those that a simulation leaves, and those that were found beside computed
//! ones.

use crate::report::Block;
use crate::report::answer::Context;
use crate::report::answer::facts::facts_table;
use crate::report::numbers::fill;
use impactlab_core::units::Quantity;
use impactlab_core::vehicle::{MARK_SLIP_RAD, MARK_SPEED_M_S};
use impactlab_study::{ReconstructReport, SimulateReport};

/// The marks that the tires leave in a simulation, with what they are; nothing without marks.
pub(super) fn computed_marks(report: &SimulateReport, context: Context<'_>) -> Vec<Block> {
    let Some(marks) = report.mark_table() else { return Vec::new() };
    let wording = context.wording;
    let limits = [
        ("slip", &*wording.given(Quantity::Angle, MARK_SLIP_RAD)),
        ("speed", &*wording.given(Quantity::Speed, MARK_SPEED_M_S)),
    ];
    let text = fill(wording.words.marks_computed_text, &limits);
    vec![facts_table(&marks, context), Block::paragraph(text)]
}

/// The marks that were found beside those of a particle of median speed; nothing if none was found.
pub(super) fn compared_marks(report: &ReconstructReport, context: Context<'_>) -> Vec<Block> {
    let Some(marks) = report.mark_table() else { return Vec::new() };
    vec![facts_table(&marks, context), Block::paragraph(context.wording.words.marks_compared_text)]
}
