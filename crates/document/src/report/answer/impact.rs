//! The impulse solution of a scenario in a report.

use crate::figure::impact_figure;
use crate::report::Block;
use crate::report::answer::Context;
use crate::report::answer::facts::{facts_table, provenance_of};
use crate::report::method::Method;
use crate::report::numbers::fill;
use crate::report::opinion::opinion_of_impact;
use crate::report::parts::{Part, PartPicture};
use impactlab_study::ImpactAnswer;

/// What an impulse solution contributes.
pub(super) fn part(answer: &ImpactAnswer, context: Context<'_>) -> Part {
    let (report, wording) = (&answer.report, context.wording);
    let words = wording.words;
    let name = wording.given_name(&report.name);
    let question = fill(words.ask_impact, &[("name", &name)]);
    let mut blocks = vec![Block::paragraph(question.clone())];
    blocks.extend(report.solution_tables().iter().map(|table| facts_table(table, context)));
    blocks.push(Block::paragraph(words.no_intervals));
    blocks.extend(report.rival.iter().map(|rival| facts_table(&rival.table(), context)));
    let caveats = &report.caveats;
    let figure = impact_figure(&answer.scenario, &answer.solution, caveats, wording.units).ok();
    let picture = figure.map(|figure| PartPicture::figure(words.impact_picture.to_owned(), figure));
    let network = report.rival.as_ref().map(|_| Method::ForceNetwork);
    Part {
        kind: words.title_impact.to_owned(),
        title: format!("{}: {name}", words.title_impact),
        opinion: Some(opinion_of_impact(report, &question, context)),
        answer: blocks,
        pictures: picture.into_iter().collect(),
        caveats: report.caveats.clone(),
        provenance: provenance_of(&report.provenance, &[], wording),
        methods: [Method::Impact].into_iter().chain(network).collect(),
        ..Part::default()
    }
}
