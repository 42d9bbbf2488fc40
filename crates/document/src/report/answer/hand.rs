//! A method by hand in a report.

use crate::report::answer::Context;
use crate::report::answer::facts::{facts_table, facts_with_meaning, provenance_of};
use crate::report::method::citation;
use crate::report::numbers::fill;
use crate::report::opinion::{condition_of_hand, opinion_of_hand};
use crate::report::parts::{InputRow, Part};
use crate::report::{Block, InputClass};
use impactlab_study::{Answer, HandInputReport, HandReport};

/// What a method by hand contributes.
pub(super) fn part(answer: &Answer<HandReport>, context: Context<'_>) -> Part {
    let wording = context.wording;
    let words = wording.words;
    let name = wording.term(answer.name);
    let question = fill(words.ask_hand, &[("name", &name)]);
    let mut blocks = vec![
        Block::paragraph(question.clone()),
        Block::paragraph(format!("{}. {}", answer.equation, condition_of_hand(answer, context))),
    ];
    blocks.extend(facts_with_meaning(&answer.result_table(), words.meaning_hand, context));
    blocks.extend(answer.bias_table().iter().map(|table| facts_table(table, context)));
    blocks.extend(answer.sources.iter().map(|text| Block::paragraph(citation(text, wording))));
    let points = (answer.n_points > 0).then(|| InputRow {
        group: name.clone(),
        label: wording.term("points of the mark"),
        value: answer.n_points.to_string(),
        class: InputClass::Measured,
        source: words.source_question.to_owned(),
    });
    let input = |input: &HandInputReport| InputRow {
        group: name.clone(),
        label: wording.term(input.label),
        value: match input.sigma == 0.0 {
            true => wording.given(input.quantity, input.value),
            false => wording.measured(input.quantity, input.value, input.sigma),
        },
        class: match (input.is_value_assumed, input.sigma == 0.0) {
            (true, _) => InputClass::Assumed,
            (false, true) => InputClass::Given,
            (false, false) => InputClass::Measured,
        },
        source: match (input.is_value_assumed, input.is_sigma_assumed && input.sigma > 0.0) {
            (true, _) => words.source_program.to_owned(),
            (false, true) => words.source_question_sigma.to_owned(),
            (false, false) => words.source_question.to_owned(),
        },
    };
    Part {
        kind: wording.key("hand"),
        title: format!("{}: {name}", wording.key("hand")),
        opinion: Some(opinion_of_hand(answer, &question, context)),
        answer: blocks,
        inputs: answer.inputs.iter().map(input).chain(points).collect(),
        caveats: answer.caveats.clone(),
        sensitivity: answer
            .sensitivity_table()
            .iter()
            .map(|table| facts_table(table, context))
            .collect(),
        provenance: provenance_of(&answer.provenance, &[], wording),
        ..Part::default()
    }
}
