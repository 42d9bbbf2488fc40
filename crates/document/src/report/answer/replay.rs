//! The replay of an event data recorder in a report.

use crate::figure::{ReplayCurve, replay_curve_figure, replay_path_figure};
use crate::report::Block;
use crate::report::answer::Context;
use crate::report::answer::facts::{facts_table, facts_with_meaning, provenance_of};
use crate::report::method::Method;
use crate::report::numbers::fill;
use crate::report::opinion::opinion_of_replay;
use crate::report::parts::{Part, PartPicture};
use impactlab_core::uncertainty::CaveatSubject;
use impactlab_study::{Answer, ReplayReport};

/// What the replay of a recorder contributes.
pub(super) fn part(answer: &Answer<ReplayReport>, context: Context<'_>) -> Part {
    let wording = context.wording;
    let words = wording.words;
    let name = [("name", answer.name.as_str()), ("vehicle", answer.vehicle.as_str())];
    let question = fill(words.ask_replay, &name);
    let mut blocks = vec![Block::paragraph(question.clone())];
    blocks.extend(facts_with_meaning(&answer.contact_table(), words.meaning_replay, context));
    let tables = [Some(answer.way_table()), Some(answer.start_table()), answer.yaw_table()];
    let tables = tables.into_iter().flatten().chain([answer.sample_table()]);
    blocks.extend(tables.map(|table| facts_table(&table, context)));
    let draws = [(words.draws_replay, answer.draws.to_string())];
    let is_estimated =
        answer.caveats.iter().any(|caveat| caveat.subject == Some(CaveatSubject::VehicleParameter));
    let sheet = is_estimated.then_some(Method::DataSheet);
    Part {
        kind: wording.key("replay"),
        title: format!("{}: {}", wording.key("replay"), answer.name),
        opinion: Some(opinion_of_replay(answer, &question, context)),
        answer: blocks,
        pictures: pictures(answer, context),
        caveats: answer.caveats.clone(),
        provenance: provenance_of(&answer.provenance, &draws, wording),
        methods: [Method::FourDofAlone].into_iter().chain(sheet).collect(),
        ..Part::default()
    }
}

/// The path from above, then what was recorded beside what was replayed.
fn pictures(answer: &Answer<ReplayReport>, context: Context<'_>) -> Vec<PartPicture> {
    let (words, units) = (context.wording.words, context.wording.units);
    let path = replay_path_figure(answer, units);
    let curve = |curve: ReplayCurve| {
        let quantity = context.wording.term(curve.label());
        let caption = fill(words.replay_picture, &[("quantity", &*quantity)]);
        PartPicture::figure(caption, replay_curve_figure(answer, curve, units))
    };
    let path = PartPicture::figure(words.replay_path_picture.to_owned(), path);
    std::iter::once(path).chain(ReplayCurve::ALL.map(curve)).collect()
}
