//! What a question says, as rows of the table of inputs.

use serde_json::Value;

use crate::report::InputClass;
use crate::report::answer::Context;
use crate::report::flatten::flatten;
use crate::report::parts::{InputRow, Part};
use impactlab_core::uncertainty::CaveatSubject;
use impactlab_study::Request;

/// What a value is in; what stands in the question itself belongs to that.
fn group_or(group: String, kind: &str) -> String {
    if group.is_empty() { kind.to_owned() } else { group }
}

/// Adds what the question says, in front of what the answer found out.
pub(super) fn with_request(mut part: Part, request: &Request, context: Context<'_>) -> Part {
    let Context { wording, paths, .. } = context;
    let words = wording.words;
    let mut question = serde_json::to_value(request).unwrap_or_default();
    if let Value::Object(fields) = &mut question {
        fields.remove("question");
        // What was found is told with its uncertainty.
        if let Some(Value::Object(evidence)) = fields.get_mut("evidence") {
            evidence.remove("inline");
        }
    }
    let given = flatten(&question, wording, paths).into_iter().map(|row| {
        let is_file = row.key == "file" || row.key == "path" || row.key == "dataset";
        let source = if is_file { words.source_file } else { words.source_question };
        InputRow {
            group: group_or(row.group(wording), &part.kind),
            label: wording.key(&row.key),
            value: row.value,
            class: InputClass::Given,
            source: source.to_owned(),
        }
    });
    let assumed = part.caveats.assumptions().map(|assumption| InputRow {
        group: part.kind.clone(),
        label: wording
            .term(assumption.subject.map_or(assumption.kind.label(), CaveatSubject::label)),
        value: wording.quoted(&assumption.text),
        class: InputClass::Assumed,
        source: wording.quoted(assumption.reason.as_deref().unwrap_or_default()),
    });
    let mut rows: Vec<InputRow> = given.collect();
    rows.append(&mut part.inputs);
    rows.extend(assumed);
    Part { inputs: rows, ..part }
}
