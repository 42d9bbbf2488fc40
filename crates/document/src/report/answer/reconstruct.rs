//! A reconstruction in a report.

use std::path::Path;

use crate::figure::{
    ReconstructionScene, budget_figure, marginal_figure, prior_values, reconstruction_scene_figure,
};
use crate::report::answer::Context;
use crate::report::answer::evidence::evidence_blocks;
use crate::report::answer::evidence_inputs::evidence_rows;
use crate::report::answer::facts::provenance_of;
use crate::report::answer::stills::reconstruction_still;
use crate::report::method::Method;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::{Part, PartPicture};
use crate::report::{Block, Table};
use impactlab_core::uncertainty::CaveatKind;
use impactlab_core::units::Quantity;
use impactlab_reconstruct::{QuantityEstimate, ReconstructedQuantity};
use impactlab_study::{
    FrictionZoneReport, ReconstructAnswer, ReconstructReport, ReconstructRequest,
    ReconstructedPaths,
};

/// Quantities whose distribution is drawn.
const DRAWN: [ReconstructedQuantity; 2] =
    [ReconstructedQuantity::StruckSpeed, ReconstructedQuantity::ClosingSpeed];

/// Restrictions with which an interval is no answer.
const DOUBTS: [CaveatKind; 2] = [CaveatKind::EvidenceUnexplained, CaveatKind::FewParticles];

/// What a reconstruction contributes.
pub(super) fn part(
    request: &ReconstructRequest,
    answer: &ReconstructAnswer,
    context: Context<'_>,
) -> Part {
    let (report, wording) = (&answer.report, context.wording);
    let words = wording.words;
    let mut blocks = vec![Block::paragraph(fill(words.ask_reconstruct, &[("name", &report.case)]))];
    if let Some(zones) = FrictionZoneReport::listed(&report.friction_zones) {
        let zones = [("zones", &*wording.local(&zones))];
        blocks.push(Block::paragraph(fill(words.zones_reconstructed, &zones)));
    }
    blocks.push(Block::Table(quantities(words.reconstruct_caption, &report.quantities, wording)));
    blocks.push(Block::List { items: meanings(report, wording) });
    let doubts = report.caveats.iter().filter(|caveat| DOUBTS.contains(&caveat.kind));
    let mut doubts: Vec<String> = doubts.map(|of| wording.term(of.kind.label())).collect();
    doubts.dedup();
    for badge in doubts {
        blocks.push(Block::paragraph(fill(words.meaning_doubtful, &[("badge", &badge)])));
    }
    if let Some(by_hand) = report.by_hand_m_s {
        let [value, sigma] = by_hand_text(by_hand, wording);
        let values = [("value", &*value), ("sigma", &*sigma)];
        blocks.push(Block::paragraph(fill(words.by_hand, &values)));
    }
    let draws = [
        (words.particles, report.n_particles.to_string()),
        (words.simulated_motions, report.n_simulations.to_string()),
        (words.ess, format!("{:.0}", report.ess)),
        (words.log_evidence, wording.fixed(report.log_evidence, 2)),
    ];
    Part {
        kind: words.title_reconstruct.to_owned(),
        title: format!("{}: {}", words.title_reconstruct, report.case),
        answer: blocks,
        pictures: pictures(request.site.as_deref(), answer, context),
        inputs: evidence_rows(request, answer, wording),
        evidence: evidence_blocks(report, wording),
        sensitivity: vec![
            Block::paragraph(words.budget_text),
            Block::Table(budget(report, wording)),
        ],
        caveats: report.caveats.clone(),
        provenance: provenance_of(&report.provenance, &draws, wording),
        methods: [Method::Reconstruction, Method::Impact, Method::FourDof, Method::DataSheet]
            .into(),
        ..Part::default()
    }
}

/// The quantities with their intervals.
pub(super) fn quantities(
    caption: &str,
    quantities: &[QuantityEstimate],
    wording: &Wording,
) -> Table {
    let words = wording.words;
    let row = |of: &QuantityEstimate| {
        let shown = of.shown(wording.units);
        let range = |ends: &[String; 2]| wording.interval_of(&shown.median, ends, shown.unit).range;
        [
            wording.term(label(of)),
            wording.with_unit(&shown.median, shown.unit),
            range(&shown.interval_50),
            range(&shown.interval_90),
            range(&shown.interval_95),
        ]
    };
    let columns =
        [words.quantity, words.median, words.interval_50, words.interval_90, words.interval_95];
    Table::new(caption, columns, quantities.iter().map(row).collect())
}

/// What a quantity is called.
fn label(of: &QuantityEstimate) -> &'static str {
    let known = ReconstructedQuantity::ALL.iter().find(|quantity| quantity.key() == of.name);
    known.map_or(of.name, |quantity| quantity.label())
}

/// What the interval of each quantity means, a sentence each.
fn meanings(report: &ReconstructReport, wording: &Wording) -> Vec<String> {
    let meaning = |of: &QuantityEstimate| {
        let shown = of.shown(wording.units);
        let text = wording.interval_of(&shown.median, &shown.interval_90, shown.unit);
        let values =
            [("quantity", &*wording.term(label(of))), ("low", &*text.low), ("high", &*text.high)];
        fill(wording.words.meaning_posterior, &values)
    };
    report.quantities.iter().map(meaning).collect()
}

/// Speed by hand and its standard deviation, with the digits of the command line.
fn by_hand_text(by_hand_m_s: [f64; 2], wording: &Wording) -> [String; 2] {
    let unit = Quantity::Speed.display_unit(wording.units);
    by_hand_m_s.map(|si| wording.with_unit(&format!("{:.1}", unit.from_si(si)), unit.symbol))
}

/// What further evidence would bring, the most useful first; what cannot be believed is marked.
fn budget(report: &ReconstructReport, wording: &Wording) -> Table {
    let words = wording.words;
    let mut items: Vec<_> = report.budget.iter().collect();
    items.sort_by(|a, b| b.believable.cmp(&a.believable).then(a.then_m_s.total_cmp(&b.then_m_s)));
    let unit = Quantity::Speed.display_unit(wording.units);
    let half = |si: f64| wording.with_unit(&format!("{:.1}", unit.from_si(si)), unit.symbol);
    let rows = items.into_iter().map(|item| {
        let shown = item.shown(wording.units);
        let then = match item.believable {
            true => half(item.then_m_s),
            false => words.not_believable.to_owned(),
        };
        [wording.phrase(&shown), half(item.now_m_s), then]
    });
    let columns = [words.measurement, words.half_width_now, words.half_width_then];
    Table::new(words.budget_caption, columns, rows.collect())
}

fn pictures(
    site: Option<&Path>,
    answer: &ReconstructAnswer,
    context: Context<'_>,
) -> Vec<PartPicture> {
    let Context { wording, .. } = context;
    let (words, units, report) = (wording.words, wording.units, &answer.report);
    let caveats = &report.caveats;
    let name = ("name", &*report.case);
    let paths = ReconstructedPaths::of(answer);
    let scene = ReconstructionScene::of(answer, &paths);
    let plan = PartPicture::figure(
        fill(words.reconstruction_picture, &[name]),
        reconstruction_scene_figure(&scene, caveats, units),
    );
    let still = reconstruction_still((answer, &paths), site, caveats, context);
    let mut pictures: Vec<PartPicture> = still.into_iter().chain([plan]).collect();
    for quantity in DRAWN {
        let prior = prior_values(&answer.target, quantity);
        let label = wording.term(quantity.label());
        pictures.push(PartPicture::figure(
            fill(words.marginal_picture, &[name, ("quantity", &label)]),
            marginal_figure(answer, (quantity, &prior), caveats, units),
        ));
    }
    if report.budget.iter().any(|item| item.believable) {
        pictures.push(PartPicture::figure(
            fill(words.budget_picture, &[name]),
            budget_figure(answer, caveats, units),
        ));
    }
    pictures
}
