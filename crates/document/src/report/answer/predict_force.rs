//! A predicted force in a report.

use crate::figure::{ForceComponent, ForecastFigure, forecast_figure};
use crate::report::answer::Context;
use crate::report::answer::facts::{Fact, Meaning, fact_blocks, provenance_of};
use crate::report::method::Method;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::{Part, PartPicture};
use crate::report::{Block, Table};
use impactlab_core::units::Quantity;
use impactlab_networks::force::metrics::BAND_LEVELS;
use impactlab_study::analysis::Estimate;
use impactlab_study::{ImpliedContactReport, PredictForceAnswer, PredictForceReport};

/// What a predicted force contributes.
pub(super) fn part(answer: &PredictForceAnswer, context: Context<'_>) -> Part {
    let (report, wording) = (&answer.report, context.wording);
    let words = wording.words;
    let mut blocks = vec![Block::paragraph(fill(words.ask_force, &[("name", &report.scenario)]))];
    blocks.extend(fact_blocks(words.force_caption, facts(report, wording), wording));
    if report.is_contact_open {
        blocks.push(Block::paragraph(words.contact_open));
    }
    if report.is_body_open {
        blocks.push(Block::paragraph(words.body_open));
    }
    if report.modes.len() > 1 {
        blocks.push(Block::Table(modes(report, wording)));
    }
    Part {
        kind: words.title_force.to_owned(),
        title: format!("{}: {}", words.title_force, report.scenario),
        answer: blocks,
        pictures: vec![picture(answer, wording)],
        domain: vec![applicability(words.force_network, report.applicability, wording)],
        caveats: report.caveats.clone(),
        provenance: provenance_of(&report.provenance, &[], wording),
        methods: [Method::ForceNetwork].into(),
        ..Part::default()
    }
}

fn facts(report: &PredictForceReport, wording: &Wording) -> Vec<Fact> {
    let words = wording.words;
    let estimate =
        |label: &str, quantity, of: &Estimate| estimate_fact(label, quantity, of, wording);
    let impulse = &report.impulse_n_s;
    let direction = [
        ("angle", &*wording.with_unit(&format!("{:.1}", report.pdof_deg), "deg")),
        ("clock", &*report.pdof_clock.to_string()),
    ];
    let mut facts = vec![
        estimate(words.impulse_size, Quantity::Impulse, &impulse.magnitude),
        estimate(words.impulse_x, Quantity::Impulse, &impulse.x),
        estimate(words.impulse_y, Quantity::Impulse, &impulse.y),
        estimate(words.peak_force, Quantity::Force, &report.peak_n),
        estimate(words.peak_time, Quantity::Time, &report.peak_time_s),
        estimate(words.contact_duration, Quantity::Time, &report.duration_s),
        Fact::plain(words.pdof, fill(words.direction_value, &direction)),
    ];
    let hooking = report.hooking_probability;
    facts.extend(hooking.map(|p| Fact::plain(words.p_hooking, wording.percent(p))));
    facts.extend(report.implied_contact.iter().flat_map(|of| implied_facts(of, wording)));
    facts
}

/// A median with its interval of 90 %, where it has one.
fn estimate_fact(label: &str, quantity: Quantity, of: &Estimate, wording: &Wording) -> Fact {
    match of.interval(0.9) {
        Some(ends) => {
            let meaning = Meaning(wording.words.meaning_force);
            Fact::ninety(wording, (label, quantity), (of.median, ends), meaning)
        }
        None => Fact::plain(label, wording.value(quantity, of.median)),
    }
}

/// Restitution and impulse ratio that a predicted impulse implies, and what the momentum solution with
/// the collision's own values says.
pub(super) fn implied_facts(implied: &ImpliedContactReport, wording: &Wording) -> Vec<Fact> {
    let words = wording.words;
    let momentum = &implied.momentum;
    let surface = format!(
        "{}; e {} {}, μ {}: {}",
        wording.vector(Quantity::Impulse, momentum.impulse_n_s, ["x", "y"]),
        wording.given_number(momentum.restitution),
        wording.term(momentum.restitution_form.label()),
        wording.given_number(momentum.friction_limit),
        wording.term(momentum.regime.label()),
    );
    vec![
        estimate_fact(words.implied_restitution, Quantity::Ratio, &implied.restitution, wording),
        estimate_fact(words.implied_ratio, Quantity::Ratio, &implied.impulse_ratio, wording),
        Fact::plain(words.momentum_beside, surface),
    ]
}

/// How far a network applies.
pub(super) fn applicability(network: &str, share: f64, wording: &Wording) -> String {
    let share = wording.fixed(share, 2);
    fill(wording.words.applicability, &[("network", network), ("share", &share)])
}

fn modes(report: &PredictForceReport, wording: &Wording) -> Table {
    let words = wording.words;
    let rows = report.modes.iter().map(|mode| {
        [
            wording.percent(mode.weight),
            wording.vector(Quantity::Impulse, mode.impulse_n_s, ["x", "y"]),
            wording.value(Quantity::Force, mode.peak_n),
            wording.value(Quantity::Time, mode.duration_s),
        ]
    });
    let columns = [words.probability, words.impulse_size, words.peak_force, words.contact_duration];
    Table::new(words.force_modes, columns, rows.collect())
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
    let caption = fill(wording.words.force_forecast_picture, &[("name", &report.scenario)]);
    PartPicture::figure(caption, forecast_figure(ForceComponent::Magnitude, &input))
}
