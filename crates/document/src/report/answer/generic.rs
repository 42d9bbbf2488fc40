//! Any other kind of answer in a report: a table of all that is in it.

use serde_json::Value;

use crate::report::answer::Context;
use crate::report::flatten::{FlatRow, flatten};
use crate::report::numbers::fill;
use crate::report::parts::{Part, PartProvenance};
use crate::report::{Block, Table};
use impactlab_core::uncertainty::Badge;
use impactlab_study::{Answer, Assumption, Request};

/// What is told in sections of its own.
const ELSEWHERE: [&str; 4] = ["badges", "assumptions", "version", "model_digests"];

/// What an answer contributes that has no text of its own.
pub(super) fn part(request: &Request, answer: &Answer, context: Context<'_>) -> Part {
    let wording = context.wording;
    let words = wording.words;
    let question = serde_json::to_value(request).unwrap_or_default();
    let kind = question.get("question").and_then(Value::as_str).unwrap_or_default();
    let kind = wording.key(kind);
    let mut told = report_value(answer);
    let badges: Vec<Badge> = typed(told.get("badges"));
    let assumptions: Vec<Assumption> = typed(told.get("assumptions"));
    let version = told.get("version").and_then(Value::as_str).unwrap_or_default().to_owned();
    if let Value::Object(fields) = &mut told {
        fields.retain(|name, _| !ELSEWHERE.contains(&name.as_str()));
    }
    let row = |row: FlatRow| [row.group(wording), wording.key(&row.key), row.value];
    let rows = flatten(&told, wording, context.paths).into_iter().map(row).collect();
    let columns = [words.part_of, words.quantity, words.value];
    Part {
        answer: vec![
            Block::paragraph(fill(words.ask_other, &[("kind", &kind)])),
            Block::Table(Table::new(words.other_caption, columns, rows)),
        ],
        kind: kind.clone(),
        title: kind,
        badges,
        assumptions,
        provenance: PartProvenance { version, seeds: Vec::new() },
        ..Part::default()
    }
}

/// What is told of an answer.
fn report_value(answer: &Answer) -> Value {
    macro_rules! told {
        ($($kind:ident),+) => {
            match answer {
                $(Answer::$kind(answer) => serde_json::to_value(&answer.report),)+
            }
        };
    }
    let told = told!(
        Check,
        Impact,
        Simulate,
        SimulateDataset,
        PredictForce,
        PredictMotion,
        Reconstruct,
        TrainForce,
        TrainResponse,
        FineTune,
        EvaluateForce,
        EvaluateReconstruction,
        EvaluateResponse,
        Compare
    );
    told.unwrap_or_default()
}

fn typed<T: serde::de::DeserializeOwned>(value: Option<&Value>) -> Vec<T> {
    let value = value.cloned().unwrap_or_default();
    serde_json::from_value(value).unwrap_or_default()
}
