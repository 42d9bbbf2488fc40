//! The simulation of one vehicle in a report.

use std::path::Path;

use crate::figure::{analysis_force_figure, analysis_motion_figure};
use crate::report::answer::Context;
use crate::report::answer::facts::{Fact, Meaning, fact_blocks, provenance_of};
use crate::report::answer::stills::simulation_stills;
use crate::report::answer::tire_marks::computed_marks;
use crate::report::answer::vehicle_inputs::vehicle_rows;
use crate::report::answer::zone_inputs::zone_rows;
use crate::report::method::Method;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::{Part, PartPicture};
use crate::report::{Block, Table};
use impactlab_core::data::Channel;
use impactlab_core::units::Quantity;
use impactlab_study::analysis::{RestOutcome, Sensitivity, Spread};
use impactlab_study::{
    FrictionZoneReport, SimulateAnswer, SimulateReport, SimulateRequest, VehicleUncertainty,
};

/// What a simulation contributes.
pub(super) fn part(
    request: &SimulateRequest,
    answer: &SimulateAnswer,
    context: Context<'_>,
) -> Part {
    let (report, wording) = (&answer.report, context.wording);
    let words = wording.words;
    let asked = [("name", &*report.name), ("vehicle", &*report.vehicle)];
    let mut blocks = vec![Block::paragraph(fill(words.ask_simulate, &asked))];
    blocks.extend(fact_blocks(words.motion_caption, facts(report, context), wording));
    blocks.extend(computed_marks(report, wording));
    let mut sensitivity = Vec::new();
    let mut draws = Vec::new();
    if let Some(uncertainty) = &report.uncertainty {
        blocks.extend(uncertainty_blocks(uncertainty, wording));
        sensitivity.extend(sensitivity_table(&uncertainty.sensitivity, wording));
        draws.push((words.vehicles_drawn, uncertainty.n_draws.to_string()));
    }
    let noted = |note: &str| fill(words.noted, &[("note", &wording.quoted(note))]);
    blocks.extend(report.caveats.notes().map(|note| Block::paragraph(noted(note))));
    let scenario = report.momentum.as_ref().map(|_| Method::Impact);
    let sheet = report.uncertainty.as_ref().map(|_| Method::DataSheet);
    Part {
        kind: words.title_simulate.to_owned(),
        title: format!("{}: {}", words.title_simulate, report.name),
        answer: blocks,
        pictures: pictures(request.site.as_deref(), answer, context),
        inputs: [
            vehicle_rows(&answer.analysis.vehicle, words.struck_vehicle, wording),
            zone_rows(&answer.analysis.friction_zones, wording),
        ]
        .concat(),
        sensitivity,
        caveats: report.caveats.clone(),
        provenance: provenance_of(&report.provenance, &draws, wording),
        methods: [Method::FourDof].into_iter().chain(scenario).chain(sheet).collect(),
        ..Part::default()
    }
}

/// How the motion goes, for the vehicle with the medians of what its data sheet leaves open.
fn facts(report: &SimulateReport, context: Context<'_>) -> Vec<Fact> {
    let wording = context.wording;
    let words = wording.words;
    let value = |quantity, si| wording.value(quantity, si);
    let mut facts = vec![
        Fact::plain(words.equations, wording.term(&report.equations)),
        Fact::plain(words.integrator, wording.term(&report.integrator)),
        Fact::plain(words.road_friction, wording.given_number(report.friction)),
        Fact::plain(words.duration, wording.given(Quantity::Time, report.duration_s)),
    ];
    let zones = FrictionZoneReport::listed(&report.friction_zones);
    facts.extend(zones.map(|zones| Fact::plain(words.friction_zones, zones)));
    if let Some(force) = &report.force {
        let source = force.path.as_ref().map(|path| context.paths.name(path));
        facts.extend(source.map(|name| Fact::plain(words.force_file, name)));
        let impulse = wording.vector(Quantity::Impulse, force.impulse_n_s, ["x", "y"]);
        facts.push(Fact::plain(words.impulse_on_struck, impulse));
        facts.push(Fact::plain(words.peak_force, value(Quantity::Force, force.peak_n)));
    }
    let delta_v = report.delta_v_m_s;
    facts.extend(delta_v.map(|of| {
        Fact::plain(words.delta_v_contact, wording.vector(Quantity::Speed, of, ["x", "y"]))
    }));
    if let Some(end) = &report.end {
        let position = wording.vector(Quantity::Length, [end.x_m, end.y_m], ["x", "y"]);
        facts.push(Fact::plain(words.end_position, position));
        let distance = report.distance_m;
        facts.extend(distance.map(|of| Fact::plain(words.distance, value(Quantity::Length, of))));
        facts.push(Fact::plain(words.final_heading, value(Quantity::Angle, end.yaw_rad)));
        let turn = report.largest_yaw_change_rad;
        facts.extend(turn.map(|of| Fact::plain(words.largest_turn, value(Quantity::Angle, of))));
        facts.push(Fact::plain(words.final_speed, value(Quantity::Speed, end.speed_m_s)));
        facts.push(Fact::plain(words.at_rest, rest(report, wording)));
    }
    if let Some(error) = &report.error {
        let length = |of| value(Quantity::Length, of);
        facts.push(Fact::plain(words.average_error, length(error.average_error_m)));
        facts.push(Fact::plain(words.final_error, length(error.final_error_m)));
    }
    facts
}

fn rest(report: &SimulateReport, wording: &Wording) -> String {
    let words = wording.words;
    let Some(rest) = &report.rest else { return words.still_moving.to_owned() };
    let values = [
        ("time", wording.value(Quantity::Time, rest.time_s)),
        ("distance", wording.value(Quantity::Length, rest.distance_m)),
        ("position", wording.vector(Quantity::Length, [rest.x_m, rest.y_m], ["x", "y"])),
        ("heading", wording.value(Quantity::Angle, rest.yaw_rad)),
    ];
    let values = values.each_ref().map(|(name, value)| (*name, value.as_str()));
    fill(words.rest_value, &values)
}

/// How the end varies with what the data sheet leaves open.
fn uncertainty_blocks(of: &VehicleUncertainty, wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    let meaning = Meaning(words.meaning_draws);
    let fact = |label: &str, quantity, spread: &Spread| {
        Fact::ninety(wording, (label, quantity), (spread.median, spread.ninety), meaning)
    };
    let mut facts = vec![
        fact(words.end_x, Quantity::Length, &of.x_m),
        fact(words.end_y, Quantity::Length, &of.y_m),
        fact(words.final_heading, Quantity::Angle, &of.yaw_rad),
        fact(words.final_speed, Quantity::Speed, &of.speed_m_s),
    ];
    if let Some(rest) = &of.rest {
        facts.extend(rest_facts(rest, meaning, wording));
    }
    let second = of.second_contact_probability;
    facts.extend(second.map(|p| Fact::plain(words.p_second_contact, wording.percent(p))));
    let left_out = match of.n_failed {
        0 => String::new(),
        n => fill(words.left_out, &[("n", &n.to_string())]),
    };
    let values = [("n", &*of.n_draws.to_string()), ("left_out", &*left_out)];
    fact_blocks(&fill(words.draws_caption, &values), facts, wording)
}

/// When, where and after what distance the vehicle comes to rest.
pub(super) fn rest_facts(rest: &RestOutcome, meaning: Meaning, wording: &Wording) -> Vec<Fact> {
    let words = wording.words;
    let fact = |label: &str, quantity, spread: &Spread| {
        Fact::ninety(wording, (label, quantity), (spread.median, spread.ninety), meaning)
    };
    let limit = wording.value(Quantity::Time, rest.limit_s);
    let values = [
        ("share", &*wording.percent(rest.share_at_rest)),
        ("n", &*rest.n_draws.to_string()),
        ("limit", &*limit),
    ];
    vec![
        Fact::plain(words.at_rest, fill(words.share_at_rest, &values)),
        fact(words.time_to_rest, Quantity::Time, &rest.time_s),
        fact(words.distance_to_rest, Quantity::Length, &rest.distance_m),
        fact(words.rest_x, Quantity::Length, &rest.x_m),
        fact(words.rest_y, Quantity::Length, &rest.y_m),
        fact(words.heading_at_rest, Quantity::Angle, &rest.yaw_rad),
        Fact::plain(words.region_90, wording.with_unit(&format!("{:.1}", rest.region_90_m2), "m²")),
    ]
}

/// Shares in the variance of the end, as far as they are more than chance.
pub(super) fn sensitivity_table(shares: &[Sensitivity], wording: &Wording) -> Option<Block> {
    let words = wording.words;
    let clear = shares.iter().filter(|share| share.is_clear());
    let percent = |share: f64| wording.with_unit(&format!("{:.0}", share * 100.0), "%");
    let row = |share: &Sensitivity| {
        let (position, heading) = (percent(share.position_share), percent(share.heading_share));
        [wording.term(share.label), position, heading]
    };
    let rows: Vec<_> = clear.map(row).collect();
    let columns = [words.estimate, words.position, words.heading];
    let table = Table::new(words.sensitivity_caption, columns, rows).numeric(&[1, 2]);
    (!table.rows.is_empty()).then_some(Block::Table(table))
}

fn pictures(
    site: Option<&Path>,
    answer: &SimulateAnswer,
    context: Context<'_>,
) -> Vec<PartPicture> {
    let (words, units) = (context.wording.words, context.wording.units);
    let (report, analysis) = (&answer.report, &answer.analysis);
    let caveats = &report.caveats;
    let name = [("name", &*report.name)];
    let picture = |caption, figure| PartPicture::figure(fill(caption, &name), figure);
    let end_s = report.rest.as_ref().map_or(report.duration_s, |rest| rest.time_s);
    let has_motion = analysis.simulation.is_some() || analysis.reference.is_some();
    let contact_end_s = report.force.as_ref().and_then(|force| force.contact_end_s);
    let moments = [contact_end_s.filter(|_| has_motion), has_motion.then_some(end_s)];
    let mut pictures = simulation_stills((analysis, caveats), site, moments, context);
    let force = analysis_force_figure((analysis, caveats), None, &[], units).ok().flatten();
    pictures.extend(force.map(|figure| picture(words.force_picture, figure)));
    let yaw_rate = analysis_motion_figure((analysis, caveats), Channel::YawRate, units);
    if !yaw_rate.elements.is_empty() {
        pictures.push(picture(words.yaw_rate_picture, yaw_rate));
    }
    pictures
}
