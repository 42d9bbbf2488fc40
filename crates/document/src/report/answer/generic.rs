//! Any other kind of answer in a report: a table of all that is in it.

use serde_json::Value;

use crate::report::answer::Context;
use crate::report::answer::facts::provenance_of;
use crate::report::flatten::{FlatRow, flatten};
use crate::report::numbers::fill;
use crate::report::parts::Part;
use crate::report::{Block, Table};
use impactlab_study::{AnyAnswer, Request};

/// What is told in sections of its own.
const ELSEWHERE: [&str; 7] =
    ["caveats", "notes", "badges", "assumptions", "version", "seed", "model_digests"];

/// What an answer contributes that has no text of its own.
pub(super) fn part(request: &Request, answer: &AnyAnswer, context: Context<'_>) -> Part {
    let wording = context.wording;
    let words = wording.words;
    let question = serde_json::to_value(request).unwrap_or_default();
    let kind = question.get("question").and_then(Value::as_str).unwrap_or_default();
    let kind = wording.key(kind);
    let mut report = serde_json::to_value(answer).unwrap_or_default();
    if let Value::Object(fields) = &mut report {
        fields.retain(|name, _| !ELSEWHERE.contains(&name.as_str()));
    }
    let row = |row: FlatRow| [row.group(wording), wording.key(&row.key), row.value];
    let rows = flatten(&report, wording, context.paths).into_iter().map(row).collect();
    let columns = [words.part_of, words.quantity, words.value];
    Part {
        answer: vec![
            Block::paragraph(fill(words.ask_other, &[("kind", &kind)])),
            Block::Table(Table::new(words.other_caption, columns, rows)),
        ],
        kind: kind.clone(),
        title: kind,
        caveats: answer.caveats().clone(),
        provenance: provenance_of(answer.provenance(), &[], wording),
        ..Part::default()
    }
}
