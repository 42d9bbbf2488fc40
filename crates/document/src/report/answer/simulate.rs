//! The simulation of one vehicle in a report.

use std::path::Path;

use crate::figure::{analysis_force_figure, analysis_motion_figure, control_figures};
use crate::report::Block;
use crate::report::answer::Context;
use crate::report::answer::facts::{facts_table, facts_with_meaning, provenance_of};
use crate::report::answer::stills::simulation_stills;
use crate::report::answer::tire_marks::computed_marks;
use crate::report::answer::vehicle_inputs::{name_in_question, vehicle_rows};
use crate::report::answer::zone_inputs::zone_rows;
use crate::report::method::Method;
use crate::report::numbers::fill;
use crate::report::opinion::opinion_of_simulation;
use crate::report::parts::{Part, PartPicture};
use impactlab_core::data::Channel;
use impactlab_study::{SimulateAnswer, SimulateRequest};

/// What a simulation contributes.
pub(super) fn part(
    request: &SimulateRequest,
    answer: &SimulateAnswer,
    context: Context<'_>,
) -> Part {
    let (report, wording) = (&answer.report, context.wording);
    let words = wording.words;
    let vehicle = name_in_question(&report.vehicle, &answer.analysis.vehicle, wording);
    let name = wording.given_name(&report.name);
    let names = [("name", &*name), ("vehicle", &vehicle)];
    let is_alone = answer.analysis.is_alone();
    let ask = if is_alone { words.ask_drive } else { words.ask_simulate };
    let question = fill(ask, &names);
    let mut blocks = vec![Block::paragraph(question.clone())];
    blocks.extend(facts_with_meaning(&report.motion_table(), "", context));
    let beside = report.rival.as_ref();
    blocks.extend(beside.map(|rival| facts_table(&rival.table(), context)));
    if let Some(phases) = report.contact_table() {
        blocks.extend([facts_table(&phases, context), Block::paragraph(words.phases_text)]);
    }
    blocks.extend(computed_marks(report, context));
    let mut sensitivity = Vec::new();
    let mut draws = Vec::new();
    if let Some(uncertainty) = &report.uncertainty {
        let drawn = uncertainty.draw_table();
        blocks.extend(facts_with_meaning(&drawn, words.meaning_draws, context));
        let shares = uncertainty.sensitivity_table();
        sensitivity.extend(shares.map(|table| facts_table(&table, context)));
        draws.push((words.vehicles_drawn, uncertainty.n_draws.to_string()));
    }
    let scenario = report.momentum.as_ref().map(|_| Method::Impact);
    let contact = (!report.contacts.is_empty()).then_some(Method::ContactLaw);
    let network = beside.map(|_| Method::ForceNetwork);
    let sheet = report.uncertainty.as_ref().map(|_| Method::DataSheet);
    let motion = if is_alone { Method::FourDofAlone } else { Method::FourDof };
    let car = wording.term("car");
    let of_car: &str = if is_alone { &car } else { words.struck_vehicle };
    Part {
        kind: words.title_simulate.to_owned(),
        title: format!("{}: {name}", words.title_simulate),
        opinion: Some(opinion_of_simulation(report, &question, context)),
        answer: blocks,
        pictures: pictures(request.site.as_deref(), answer, context),
        inputs: [
            vehicle_rows(&answer.analysis.vehicle, of_car, wording),
            zone_rows(&answer.analysis.friction_zones, wording),
        ]
        .concat(),
        sensitivity,
        caveats: report.caveats.clone(),
        provenance: provenance_of(&report.provenance, &draws, wording),
        methods: [motion]
            .into_iter()
            .chain(scenario)
            .chain(contact)
            .chain(network)
            .chain(sheet)
            .collect(),
        ..Part::default()
    }
}

fn pictures(
    site: Option<&Path>,
    answer: &SimulateAnswer,
    context: Context<'_>,
) -> Vec<PartPicture> {
    let (words, units) = (context.wording.words, context.wording.units);
    let (report, analysis) = (&answer.report, &answer.analysis);
    let caveats = &report.caveats;
    let end_s = report.rest.as_ref().map_or(report.duration_s, |rest| rest.time_s);
    let has_motion = analysis.simulation.is_some() || analysis.reference.is_some();
    let contact_end_s = report.force.as_ref().and_then(|force| force.contact_end_s);
    let moments = [contact_end_s.filter(|_| has_motion), has_motion.then_some(end_s)];
    let mut pictures = simulation_stills(analysis, caveats, site, moments, context);
    let force = analysis_force_figure(analysis, caveats, None, &[], units).ok().flatten();
    let axes =
        report.force.as_ref().map_or(String::new(), |force| context.wording.term(&force.axes));
    let force_caption = fill(words.force_picture, &[("axes", &axes)]);
    pictures.extend(force.map(|figure| PartPicture::figure(force_caption, figure)));
    let yaw_rate = analysis_motion_figure(analysis, caveats, Channel::YawRate, units);
    if !yaw_rate.elements.is_empty() {
        let alone = analysis.is_alone();
        let caption = if alone { words.yaw_rate_alone_picture } else { words.yaw_rate_picture };
        pictures.push(PartPicture::figure(caption.to_owned(), yaw_rate));
    }
    pictures.extend(control_figures(analysis, caveats, units).into_iter().map(|figure| {
        let quantity = context.wording.term(&figure.y.label);
        let names = [("quantity", &*quantity)];
        PartPicture::figure(fill(words.controls_picture, &names), figure)
    }));
    pictures
}
