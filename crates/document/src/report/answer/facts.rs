//! Tables of facts in a report, and what their intervals mean in words.

use std::path::Path;

use crate::report::answer::Context;
use crate::report::language::phrase_of;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::PartProvenance;
use crate::report::{Block, Column, Table};
use impactlab_core::uncertainty::{Caveat, CaveatKind, Caveats};
use impactlab_study::Provenance;
use impactlab_study::facts::{FactTable, FactWriter, TextTable};

/// A table of facts.
pub(in crate::report) fn facts_table(table: &FactTable, context: Context<'_>) -> Block {
    with_writer(context, |writer| Block::Table(table.to_text(writer).into()))
}

/// A table of facts, and below it one sentence that says what its intervals mean, or that there are none.
pub(super) fn facts_with_meaning(
    table: &FactTable,
    meaning: &str,
    context: Context<'_>,
) -> [Block; 2] {
    let has_intervals = with_writer(context, |writer| !table.intervals(0.9, writer).is_empty());
    let sentence = if has_intervals { meaning } else { context.wording.words.no_intervals };
    [facts_table(table, context), Block::paragraph(sentence)]
}

/// Calls a function with the writer of facts in the language of a report.
pub(in crate::report) fn with_writer<T>(
    context: Context<'_>,
    write: impl FnOnce(&FactWriter<'_>) -> T,
) -> T {
    let Context { wording, paths, .. } = context;
    write(&FactWriter {
        format: **wording,
        phrase: &|text: &str| {
            let whole = phrase_of(wording.language, text);
            whole.unwrap_or_else(|| wording.phrase(text))
        },
        name: &|text: &str| wording.name(text),
        english: &|text: &str| wording.quoted(text),
        file: &|path: &Path| paths.name(path),
    })
}

/// What a person should know of how an answer was made, a paragraph each.
pub(super) fn notes(caveats: &Caveats, wording: &Wording) -> Vec<Block> {
    let noted = |note: &Caveat| {
        let note = wording.caveat_text(note);
        Block::paragraph(fill(wording.words.noted, &[("note", note.trim_end_matches('.'))]))
    };
    let notes = caveats.iter().filter(|caveat| caveat.kind == CaveatKind::Note);
    notes.map(noted).collect()
}

/// Version, seeds and numbers of draws of an answer.
pub(super) fn provenance_of(
    provenance: &Provenance,
    draws: &[(&str, String)],
    wording: &Wording,
) -> PartProvenance {
    let seed = provenance.seed.map(|seed| format!("{} {seed}", wording.words.seed));
    let draws = draws.iter().map(|(name, n)| format!("{name} {n}"));
    PartProvenance {
        version: provenance.version.to_string(),
        seeds: seed.into_iter().chain(draws).collect(),
    }
}

impl From<TextTable> for Table {
    /// The first letter of a title is a capital one, as in the other tables of a report.
    fn from(table: TextTable) -> Self {
        let is_list = table.is_list();
        let is_number =
            |cell: &str| cell.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '+'));
        let column = |(idx, title): (usize, &String)| {
            let mut cells = table.rows.iter().filter_map(|row| row.cells.get(idx));
            let is_numeric = idx > 0 && !is_list && cells.all(|cell| is_number(cell));
            Column { title: capitalized(title), is_numeric }
        };
        let columns = table.header.iter().enumerate().map(column).collect();
        Self {
            caption: table.title,
            columns,
            rows: table.rows.into_iter().map(|row| row.cells).collect(),
        }
    }
}

/// A text that begins with a capital letter; a symbol, such as p, stays as it is.
pub(in crate::report) fn capitalized(title: &str) -> String {
    if title.chars().count() == 1 {
        return title.to_owned();
    }
    let mut chars = title.chars();
    let first = chars.next().map(|first| first.to_uppercase().collect::<String>());
    first.unwrap_or_default() + chars.as_str()
}
