//! A predicted force in a report.

use crate::figure::{ForceComponent, ForecastFigure, forecast_figure};
use crate::report::Block;
use crate::report::answer::Context;
use crate::report::answer::facts::{facts_table, facts_with_meaning, provenance_of};
use crate::report::method::Method;
use crate::report::numbers::{Wording, fill};
use crate::report::opinion::opinion_of_force;
use crate::report::parts::{Part, PartPicture};
use impactlab_networks::force::metrics::BAND_LEVELS;
use impactlab_study::PredictForceAnswer;

/// What a predicted force contributes.
pub(super) fn part(answer: &PredictForceAnswer, context: Context<'_>) -> Part {
    let (report, wording) = (&answer.report, context.wording);
    let words = wording.words;
    let question = fill(words.ask_force, &[("name", &report.scenario)]);
    let mut blocks = vec![Block::paragraph(question.clone())];
    let meaning = words.meaning_force;
    blocks.extend(facts_with_meaning(&report.force_table(), meaning, context));
    blocks.extend(report.course_table().map(|table| facts_table(&table, context)));
    Part {
        kind: words.title_force.to_owned(),
        title: format!("{}: {}", words.title_force, report.scenario),
        opinion: Some(opinion_of_force(report, &question, context)),
        answer: blocks,
        pictures: vec![picture(answer, wording)],
        domain: vec![applicability(words.force_network, report.applicability, wording)],
        caveats: report.caveats.clone(),
        provenance: provenance_of(&report.provenance, &[], wording),
        methods: [Method::ForceNetwork].into(),
        ..Part::default()
    }
}

/// How far a network applies.
pub(super) fn applicability(network: &str, share: f64, wording: &Wording) -> String {
    let share = wording.percent(share);
    // Of a network that applies throughout no decimals are told.
    let share = if share.starts_with("100") { "100 %".to_owned() } else { share };
    fill(wording.words.applicability, &[("network", network), ("share", &share)])
}

fn picture(answer: &PredictForceAnswer, wording: &Wording) -> PartPicture {
    let report = &answer.report;
    let caveats = &report.caveats;
    let input = ForecastFigure {
        name: &report.scenario,
        forecast: &answer.forecast,
        levels: &BAND_LEVELS,
        recorded: None,
        physics: None,
        pulses: &[],
        units: wording.units,
        caveats,
    };
    let caption = wording.words.force_forecast_picture.to_owned();
    PartPicture::figure(caption, forecast_figure(ForceComponent::Magnitude, &input))
}
