//! Tables of figures with their intervals, and what these mean in words.

use crate::report::numbers::{Wording, fill};
use crate::report::parts::PartProvenance;
use crate::report::{Block, Table};
use impactlab_core::units::Quantity;
use impactlab_study::Provenance;

/// A figure of an answer.
pub(super) struct Fact {
    label: String,
    value: String,
    interval: String,
    meaning: Option<String>,
}

/// What a central interval of 90 % says, as a template with `{quantity}`, `{low}` and `{high}`.
#[derive(Clone, Copy)]
pub(super) struct Meaning(pub &'static str);

impl Fact {
    /// A figure without an interval.
    pub fn plain(label: impl Into<String>, value: impl Into<String>) -> Self {
        let (label, value) = (label.into(), value.into());
        Self { label, value, interval: String::new(), meaning: None }
    }

    /// A median with the interval that holds 90 %.
    pub fn ninety(
        wording: &Wording,
        (label, quantity): (&str, Quantity),
        (median, ends): (f64, [f64; 2]),
        meaning: Meaning,
    ) -> Self {
        let text = wording.interval(quantity, median, ends);
        let values = [("quantity", label), ("low", &text.low), ("high", &text.high)];
        Self {
            label: label.to_owned(),
            value: text.median,
            meaning: Some(fill(meaning.0, &values)),
            interval: text.range,
        }
    }
}

/// A table of figures, and below it what the intervals mean, a sentence each.
pub(super) fn fact_blocks(caption: &str, facts: Vec<Fact>, wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    let has_intervals = facts.iter().any(|fact| !fact.interval.is_empty());
    let meanings: Vec<String> = facts.iter().filter_map(|fact| fact.meaning.clone()).collect();
    let table = if has_intervals {
        let rows = facts.into_iter().map(|fact| [fact.label, fact.value, fact.interval]);
        Table::new(caption, [words.quantity, words.value, words.interval_90], rows.collect())
    } else {
        let rows = facts.into_iter().map(|fact| [fact.label, fact.value]);
        Table::new(caption, [words.quantity, words.value], rows.collect())
    };
    let mut blocks = vec![Block::Table(table)];
    match meanings.is_empty() {
        true => blocks.push(Block::paragraph(words.no_intervals)),
        false => blocks.push(Block::List { items: meanings }),
    }
    blocks
}

/// Version, seeds and numbers of draws of an answer.
pub(super) fn provenance_of(
    of: &Provenance,
    draws: &[(&str, String)],
    wording: &Wording,
) -> PartProvenance {
    let seed = of.seed.map(|seed| format!("{} {seed}", wording.words.seed));
    let draws = draws.iter().map(|(name, n)| format!("{name} {n}"));
    PartProvenance {
        version: of.version.to_string(),
        seeds: seed.into_iter().chain(draws).collect(),
    }
}
