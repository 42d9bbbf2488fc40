//! A predicted motion in a report.

use std::sync::Arc;

use crate::figure::{FORECAST_CHANNELS, MotionForecastFigure, forecast_channel_figure};
use crate::report::Block;
use crate::report::answer::Context;
use crate::report::answer::atlas::in_atlas;
use crate::report::answer::facts::{facts_table, facts_with_meaning, provenance_of};
use crate::report::answer::predict_force::applicability;
use crate::report::answer::reconstruct::doubt_of;
use crate::report::answer::stills::forecast_still;
use crate::report::answer::vehicle_inputs::{name_in_question, vehicle_rows};
use crate::report::answer::zone_inputs::zone_rows;
use crate::report::method::Method;
use crate::report::numbers::{Wording, fill};
use crate::report::opinion::opinion_of_forecast;
use crate::report::parts::{InputRow, Part, PartPicture};
use impactlab_core::data::Channel;
use impactlab_core::uncertainty::{CaveatKind, Caveats};
use impactlab_study::analysis::{DensityTask, MotionBands};
use impactlab_study::{PredictMotionAnswer, PredictMotionReport, PredictMotionRequest};

/// That intervals are not to be relied on, where the case lies outside of what the networks have learned from and the
/// methods disagree on it: none that was tried says anything of it.
fn doubt(caveats: &Caveats, n_courses: usize, wording: &Wording) -> Option<String> {
    let kinds = [CaveatKind::OutsideDomain, CaveatKind::Disagreement];
    let labels = kinds.map(|kind| kind.label_in(wording.language));
    let is_doubtful = kinds.into_iter().all(|kind| caveats.has(kind));
    is_doubtful.then(|| doubt_of(&labels, true, n_courses, wording))
}

/// What a predicted motion contributes.
pub(super) fn part(
    request: &PredictMotionRequest,
    answer: &PredictMotionAnswer,
    context: Context<'_>,
) -> Part {
    let (report, wording) = (&answer.report, context.wording);
    let words = wording.words;
    let vehicle = name_in_question(&report.vehicle, &answer.analysis.vehicle, wording);
    let name = wording.given_name(&report.scenario);
    let names = [("name", &*name), ("vehicle", &vehicle)];
    let question = fill(words.ask_motion, &names);
    let mut blocks = vec![Block::paragraph(question.clone())];
    let courses = report.course_table();
    let in_opinion: Vec<Block> = courses
        .iter()
        .chain([&report.answer_table()])
        .map(|table| facts_table(table, context))
        .collect();
    blocks.extend(in_opinion.iter().cloned());
    let force_table = report.force_table();
    let of_first_force: Vec<Block> =
        force_table.iter().map(|table| facts_table(table, context)).collect();
    blocks.extend(of_first_force.iter().cloned());
    let is_one = report.n_forces <= 1 && report.n_vehicles == 0;
    let meaning = if is_one { words.meaning_motion_one } else { words.meaning_motion };
    let doubt = doubt(&report.caveats, report.courses.len(), wording);
    match (report.is_end_known(), &doubt) {
        (true, None) => {
            blocks.extend(facts_with_meaning(&report.motion_table(), meaning, context));
        }
        (true, Some(doubt)) => {
            blocks.push(facts_table(&report.motion_table(), context));
            blocks.push(Block::paragraph(doubt));
        }
        (false, _) => {
            blocks.push(facts_table(&report.motion_table(), context));
            blocks.push(Block::paragraph(words.after_second_contact));
        }
    }
    blocks.extend(report.both_vehicles_tables().iter().map(|table| facts_table(table, context)));
    let has_phases = report.contacts.as_ref().is_some_and(|contacts| !contacts.phases.is_empty());
    blocks.extend(has_phases.then(|| Block::paragraph(words.phases_text)));
    blocks.extend(report.rival_table().iter().map(|table| facts_table(table, context)));
    let shares = report.sensitivity_table();
    let shares = shares.iter().map(|table| facts_table(table, context));
    let in_atlas = in_atlas(request, answer, context);
    let draws = [
        (words.forces_drawn, report.n_forces.to_string()),
        (words.vehicles_drawn, report.n_vehicles.to_string()),
    ];
    let predicted = report.force_model.as_ref().map(|_| Method::ForceNetwork);
    let sheet = (report.n_vehicles > 0).then_some(Method::DataSheet);
    let methods = [Method::ResponseNetwork, Method::FourDof];
    let contact = report.contacts.as_ref().map(|_| Method::ContactLaw);
    let mut opinion = opinion_of_forecast(report, &question, context);
    if let Some(doubt) = doubt {
        opinion.answer = format!("{} {doubt}", opinion.answer);
        opinion.held = None;
        opinion.is_doubtful = true;
    }
    Part {
        kind: words.title_motion.to_owned(),
        title: format!("{}: {name}", words.title_motion),
        opinion: Some(opinion),
        answer: blocks,
        of_first_force,
        in_opinion,
        pictures: pictures(request, answer, context).into_iter().chain(in_atlas.picture).collect(),
        inputs: input_rows(answer, wording),
        sensitivity: shares.chain(in_atlas.blocks).collect(),
        domain: domain(report, wording),
        caveats: report.caveats.clone(),
        provenance: provenance_of(&report.provenance, &draws, wording),
        methods: methods.into_iter().chain(contact).chain(predicted).chain(sheet).collect(),
        ..Part::default()
    }
}

/// Both vehicles, where both are followed, and the zones in which their wheels stand.
fn input_rows(answer: &PredictMotionAnswer, wording: &Wording) -> Vec<InputRow> {
    let (analysis, words) = (&answer.analysis, wording.words);
    let striking = analysis.striking.as_ref().filter(|_| answer.report.striking.is_some());
    let striking =
        striking.map(|track| vehicle_rows(&track.start.vehicle, words.striking_vehicle, wording));
    [
        vehicle_rows(&analysis.vehicle, words.struck_vehicle, wording),
        striking.unwrap_or_default(),
        zone_rows(&analysis.friction_zones, wording),
    ]
    .concat()
}

fn domain(report: &PredictMotionReport, wording: &Wording) -> Vec<String> {
    let words = wording.words;
    let learned = wording.with_unit(&wording.fixed(report.learned_duration_s, 1), "s");
    let force = report.force_applicability;
    let mut lines = vec![applicability(words.response_network, report.applicability, wording)];
    lines.extend(force.map(|share| applicability(words.force_network, share, wording)));
    // A forecast that ends before says nothing of what comes after.
    if report.outcome.time_s > report.learned_duration_s {
        lines.push(fill(words.learned_duration, &[("time", &learned)]));
    }
    lines
}

fn pictures(
    request: &PredictMotionRequest,
    answer: &PredictMotionAnswer,
    context: Context<'_>,
) -> Vec<PartPicture> {
    let Context { wording, .. } = context;
    let (words, report) = (wording.words, &answer.report);
    let (forecast, analysis) = (&answer.forecast, &answer.analysis);
    let at_s = report.outcome.time_s;
    let density = Arc::new(DensityTask::new(&forecast.distribution, [at_s; 2]).on_cpu());
    let bands = MotionBands::for_figure(&forecast.distribution);
    let caveats = &report.caveats;
    let still = forecast_still(request, answer, &density, caveats, context);
    let input = MotionForecastFigure::new(answer, &bands, caveats, at_s, wording.units)
        .with_motions(analysis);
    let yaw = FORECAST_CHANNELS.into_iter().find(|shown| shown.channel == Channel::Yaw);
    let yaw = yaw.map(|channel| {
        let cut = input.cut().map_or(String::new(), |cut| format!(", {}", wording.term(cut)));
        let caption = format!("{}{cut}", words.forecast_yaw_picture);
        PartPicture::figure(caption, forecast_channel_figure(&input, channel))
    });
    [still].into_iter().chain(yaw).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::uncertainty::Caveat;
    use impactlab_core::units::UnitSystem;

    /// Of a frontal collision the opinion told “the interval that holds with a probability of 90 %” below the warning
    /// that the other method ends 49.9 m away.
    #[test]
    fn a_forecast_outside_of_the_domain_on_which_the_methods_disagree_is_doubted() {
        let wording = Wording::english(UnitSystem::Si);
        let told = |kinds: &[CaveatKind]| {
            let caveats = kinds.iter().map(|kind| Caveat::new(*kind, String::new()));
            doubt(&caveats.collect(), 1, &wording)
        };
        let (outside, disagree) = (CaveatKind::OutsideDomain, CaveatKind::Disagreement);
        assert_eq!([told(&[outside]), told(&[disagree])], [None, None]);
        let both = told(&[outside, disagree]).unwrap();
        assert!(both.contains("not to be relied on") && both.contains("disagreement"), "{both}");
    }
}
