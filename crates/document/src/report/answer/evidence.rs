//! How well the evidence is explained, and which courses of events it leaves possible.

use crate::report::answer::reconstruct::quantities;
use crate::report::answer::tire_marks::compared_marks;
use crate::report::numbers::{Wording, fill};
use crate::report::{Block, Table};
use impactlab_core::units::{Quantity, significant};
use impactlab_reconstruct::{EvidenceFit, Mode};
use impactlab_study::ReconstructReport;

/// Probability below which a table says only that it is smaller.
const LEAST_SHOWN_P: f64 = 0.001;

/// The fit of each item, and the courses of events with their probabilities.
pub(super) fn evidence_blocks(report: &ReconstructReport, wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    let level = wording.given_number(EvidenceFit::UNEXPLAINED_BELOW);
    let mut blocks = vec![
        Block::heading(2, report.case.clone()),
        Block::paragraph(fill(words.fit_text, &[("level", &level)])),
        Block::Table(fit(report, wording)),
    ];
    blocks.extend(compared_marks(report, wording));
    blocks.extend([Block::Table(modes(report, wording)), Block::paragraph(words.modes_text)]);
    if report.modes.len() > 1 {
        blocks.extend(report.modes.iter().map(|mode| {
            let caption = fill(words.mode_caption, &[("mode", &wording.phrase(&mode.name))]);
            Block::Table(quantities(&caption, &mode.quantities, wording))
        }));
    }
    blocks
}

/// A number of an item of the evidence, whose unit is that of SI, in the units of the report.
fn in_unit(value: f64, unit: &str, wording: &Wording) -> String {
    let of_unit = |quantity: &&Quantity| quantity.si_unit().symbol == unit && !unit.is_empty();
    match Quantity::ALL.iter().find(of_unit) {
        Some(quantity) => wording.value(*quantity, value),
        None => wording.with_unit(&significant(value), unit),
    }
}

fn fit(report: &ReconstructReport, wording: &Wording) -> Table {
    let words = wording.words;
    let row = |item: &EvidenceFit| {
        let explained = if item.is_unexplained() { words.unexplained } else { words.explained };
        [
            wording.phrase(&item.evidence),
            in_unit(item.found, item.unit, wording),
            in_unit(item.expected, item.unit, wording),
            shown_p(item.p, wording),
            explained.to_owned(),
        ]
    };
    let columns = [words.evidence_item, words.found, words.expected, "p", words.verdict];
    Table::new(words.fit_caption, columns, report.fit.iter().map(row).collect()).numeric(&[1, 2, 3])
}

/// A probability with three decimals, and never as nothing.
fn shown_p(p: f64, wording: &Wording) -> String {
    match p < LEAST_SHOWN_P {
        true => format!("< {}", wording.fixed(LEAST_SHOWN_P, 3)),
        false => wording.fixed(p, 3),
    }
}

fn modes(report: &ReconstructReport, wording: &Wording) -> Table {
    let words = wording.words;
    let row = |mode: &Mode| {
        let speed = mode.quantities.first().map(|of| {
            let shown = of.shown(wording.units);
            let text = wording.interval_of(&shown.median, &shown.interval_90, shown.unit);
            [text.median, text.range]
        });
        let [median, range] = speed.unwrap_or_default();
        [
            wording.phrase(&mode.name),
            wording.percent(mode.probability),
            wording.percent(mode.standard_error),
            median,
            range,
        ]
    };
    let columns = [
        words.course_of_events,
        words.probability,
        words.standard_error,
        words.struck_speed,
        words.interval_90,
    ];
    let caption = words.modes_caption;
    Table::new(caption, columns, report.modes.iter().map(row).collect()).numeric(&[1, 2])
}

/// A value with its standard deviation in the units of the report.
pub(super) fn measured(quantity: Quantity, [value, sigma]: [f64; 2], wording: &Wording) -> String {
    let unit = quantity.display_unit(wording.units);
    let [value, sigma] = [value, sigma].map(|si| unit.from_si(si));
    let decimals = match sigma > 0.0 && sigma.is_finite() {
        true => (1 - sigma.log10().floor() as i32).clamp(0, 6) as usize,
        false => 3,
    };
    let text = format!("{value:.decimals$} ± {sigma:.decimals$}");
    wording.with_unit(&text, unit.symbol)
}
