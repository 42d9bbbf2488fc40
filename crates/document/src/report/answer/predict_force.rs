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
    let name = wording.given_name(&report.scenario);
    let question = fill(words.ask_force, &[("name", &name)]);
    let mut blocks = vec![Block::paragraph(question.clone())];
    let meaning = words.meaning_force;
    blocks.extend(facts_with_meaning(&report.force_table(), meaning, context));
    blocks.extend(report.course_table().map(|table| facts_table(&table, context)));
    Part {
        kind: words.title_force.to_owned(),
        title: format!("{}: {name}", words.title_force),
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
    let words = wording.words;
    // A share that is written as all of it leaves no rest.
    let template = if share < 0.9995 { words.applicability } else { words.applies };
    let share = wording.percent(share);
    fill(template, &[("network", network), ("share", &share)])
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

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::UnitSystem;

    /// A network counts in full a little way outside of its ranges, too, of which a warning tells.
    #[test]
    fn a_network_that_counts_in_full_is_not_said_to_have_learned_from_the_like() {
        let wording = Wording::english(UnitSystem::Si);
        let told = |share| applicability("force network", share, &wording);
        assert!(told(0.9996).contains("in full") && !told(0.9996).contains("learned"));
        assert!(told(0.9994).contains("partly outside") && told(0.9994).contains("99.9 %"));
    }
}
