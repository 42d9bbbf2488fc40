//! Marks of tires in a report: those that a simulation leaves, and those that were found beside computed
//! ones.

use crate::report::numbers::{Wording, fill};
use crate::report::{Block, Table};
use impactlab_core::units::Quantity;
use impactlab_core::vehicle::{MARK_SLIP_RAD, MARK_SPEED_M_S};
use impactlab_reconstruct::MarkComparison;
use impactlab_study::{ReconstructReport, SimulateReport, TireMarkReport, word};

/// The marks that the tires leave in a simulation, with what they are; nothing without marks.
pub(super) fn computed_marks(report: &SimulateReport, wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    let row = |mark: &TireMarkReport| {
        let place = |[x, y]: [f64; 2]| {
            let [x, y] = [x, y].map(|of| wording.value(Quantity::Length, of));
            format!("({x}; {y})")
        };
        let time = |of| wording.value(Quantity::Time, of);
        [
            format!("{}, {}", wording.term(mark.vehicle), wording.term(&word(&mark.wheel))),
            wording.term(mark.kind.label()),
            wording.value(Quantity::Length, mark.length_m),
            format!("{} {} {}", time(mark.from_s), words.to, time(mark.to_s)),
            format!("{} {} {}", place(mark.start_m), words.to, place(mark.end_m)),
        ]
    };
    let rows: Vec<_> = report.tire_marks.iter().map(row).collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let columns =
        [words.wheel, words.mark_cause, words.mark_length, words.mark_time, words.mark_places];
    let table = Table::new(words.marks_computed_caption, columns, rows).numeric(&[2]);
    let limits = [
        ("slip", &*wording.given(Quantity::Angle, MARK_SLIP_RAD)),
        ("speed", &*wording.given(Quantity::Speed, MARK_SPEED_M_S)),
    ];
    vec![Block::Table(table), Block::paragraph(fill(words.marks_computed_text, &limits))]
}

/// The marks that were found beside those of a particle of median speed; nothing if none was found.
pub(super) fn compared_marks(report: &ReconstructReport, wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    let length = |si| wording.value(Quantity::Length, si);
    let known = |si: Option<f64>| si.map_or_else(|| words.no_mark.to_owned(), length);
    let row = |mark: &MarkComparison| {
        // A wheel that leaves no mark has no computed length, and not one of 0 m.
        let computed = mark.mean_distance_m.map(|_| mark.computed_length_m);
        [
            wording.term(&word(&mark.wheel)),
            length(mark.found_length_m),
            known(computed),
            known(mark.mean_distance_m),
            known(mark.largest_distance_m),
        ]
    };
    let rows: Vec<_> = report.marks.iter().map(row).collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let columns = [
        words.wheel,
        words.mark_found_length,
        words.mark_computed_length,
        words.mark_mean_distance,
        words.mark_largest_distance,
    ];
    let table = Table::new(words.marks_compared_caption, columns, rows).numeric(&[1, 2, 3, 4]);
    vec![Block::Table(table), Block::paragraph(words.marks_compared_text)]
}
