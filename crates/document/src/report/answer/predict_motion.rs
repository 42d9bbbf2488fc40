//! A predicted motion in a report.

use std::sync::Arc;

use crate::figure::{FORECAST_CHANNELS, MotionForecastFigure, forecast_channel_figure};
use crate::report::Block;
use crate::report::answer::Context;
use crate::report::answer::facts::{Fact, Meaning, fact_blocks, provenance_of};
use crate::report::answer::predict_force::{applicability, implied_facts};
use crate::report::answer::simulate::{rest_facts, sensitivity_table};
use crate::report::answer::stills::forecast_still;
use crate::report::answer::vehicle_inputs::vehicle_rows;
use crate::report::method::Method;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::{Part, PartPicture};
use impactlab_core::data::Channel;
use impactlab_core::units::Quantity;
use impactlab_study::analysis::{DensityTask, MotionBands, Spread};
use impactlab_study::{PredictMotionAnswer, PredictMotionReport, PredictMotionRequest};

/// Every how many steps the bands over time have an edge.
const BAND_STRIDE: usize = 5;

/// What a predicted motion contributes.
pub(super) fn part(
    request: &PredictMotionRequest,
    answer: &PredictMotionAnswer,
    context: Context<'_>,
) -> Part {
    let (report, wording) = (&answer.report, context.wording);
    let words = wording.words;
    let asked = [("name", &*report.scenario), ("vehicle", &*report.vehicle)];
    let mut blocks = vec![Block::paragraph(fill(words.ask_motion, &asked))];
    blocks.extend(fact_blocks(words.forecast_caption, facts(report, context), wording));
    let draws = [
        (words.forces_drawn, report.n_forces.to_string()),
        (words.vehicles_drawn, report.n_vehicles.to_string()),
    ];
    let predicted = report.force_model.as_ref().map(|_| Method::ForceNetwork);
    let sheet = (report.n_vehicles > 0).then_some(Method::DataSheet);
    let methods = [Method::ResponseNetwork, Method::FourDof];
    Part {
        kind: words.title_motion.to_owned(),
        title: format!("{}: {}", words.title_motion, report.scenario),
        answer: blocks,
        pictures: pictures(request, answer, context),
        inputs: vehicle_rows(&answer.analysis.vehicle, words.struck_vehicle, wording),
        sensitivity: sensitivity_table(&report.sensitivity, wording).into_iter().collect(),
        domain: domain(report, wording),
        caveats: report.caveats.clone(),
        provenance: provenance_of(&report.provenance, &draws, wording),
        methods: methods.into_iter().chain(predicted).chain(sheet).collect(),
        ..Part::default()
    }
}

fn facts(report: &PredictMotionReport, context: Context<'_>) -> Vec<Fact> {
    let wording = context.wording;
    let words = wording.words;
    let outcome = &report.outcome;
    let is_one = report.n_forces <= 1 && report.n_vehicles == 0;
    let meaning = Meaning(if is_one { words.meaning_motion_one } else { words.meaning_motion });
    let moved_by = match report.force_model {
        Some(_) => fill(words.moved_by_network, &[("n", &report.n_forces.to_string())]),
        None => words.moved_by_given.to_owned(),
    };
    let spread = |label: &str, quantity, of: &Spread| {
        Fact::ninety(wording, (label, quantity), (of.median, of.ninety), meaning)
    };
    let time = wording.value(Quantity::Time, outcome.time_s);
    let end = if outcome.is_at_rest { words.at_rest_after } else { words.moving_after };
    let mut facts = vec![
        Fact::plain(words.moved_by, moved_by),
        Fact::plain(words.end, fill(end, &[("time", &time)])),
    ];
    let force = report.force.as_ref().map(|path| context.paths.name(path));
    facts.extend(force.map(|name| Fact::plain(words.force_file, name)));
    facts.extend(report.rest.iter().flat_map(|rest| rest_facts(rest, meaning, wording)));
    facts.extend([
        spread(words.end_x, Quantity::Length, &outcome.x_m),
        spread(words.end_y, Quantity::Length, &outcome.y_m),
        spread(words.heading_change, Quantity::Angle, &outcome.heading_change_rad),
        Fact::plain(words.speed_at_end, wording.value(Quantity::Speed, outcome.speed_m_s)),
        Fact::plain(
            words.yaw_rate_at_end,
            wording.value(Quantity::AngularVelocity, outcome.yaw_rate_rad_s),
        ),
        Fact::plain(words.region_90, shown_area(outcome.region_90_m2, wording)),
        Fact::plain(words.p_quarter_turn, wording.percent(outcome.p_quarter_turn)),
        Fact::plain(words.p_half_turn, wording.percent(outcome.p_half_turn)),
    ]);
    let hooking = report.hooking_probability;
    facts.extend(hooking.map(|p| Fact::plain(words.p_hooking, wording.percent(p))));
    facts.extend(report.implied_contact.iter().flat_map(|of| implied_facts(of, wording)));
    facts
}

/// An area in squares of the unit of lengths.
fn shown_area(area_m2: f64, wording: &Wording) -> String {
    let unit = Quantity::Length.display_unit(wording.units);
    let area = area_m2 / unit.to_si(1.0).powi(2);
    wording.with_unit(&format!("{area:.1}"), &format!("{}²", unit.symbol))
}

fn domain(report: &PredictMotionReport, wording: &Wording) -> Vec<String> {
    let words = wording.words;
    let learned = wording.value(Quantity::Time, report.learned_duration_s);
    let force = report.force_applicability;
    let mut lines = vec![applicability(words.response_network, report.applicability, wording)];
    lines.extend(force.map(|share| applicability(words.force_network, share, wording)));
    lines.push(fill(words.learned_duration, &[("time", &learned)]));
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
    let bands = MotionBands::of(&forecast.distribution, BAND_STRIDE);
    let caveats = &report.caveats;
    let still = forecast_still((request, answer), (&density, caveats), context);
    let shown = (at_s, wording.units);
    let input = MotionForecastFigure::of(answer, (&bands, caveats), shown).with_motions(analysis);
    let yaw = FORECAST_CHANNELS.into_iter().find(|of| of.channel == Channel::Yaw);
    let yaw = yaw.map(|channel| {
        let caption = fill(words.forecast_yaw_picture, &[("name", &report.scenario)]);
        PartPicture::figure(caption, forecast_channel_figure(&input, channel))
    });
    [still].into_iter().chain(yaw).collect()
}
