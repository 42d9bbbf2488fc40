//! The impulse solution of a scenario in a report.

use crate::figure::impact_figure;
use crate::report::answer::Context;
use crate::report::answer::facts::{Fact, fact_blocks, provenance_of};
use crate::report::method::Method;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::{Part, PartPicture};
use crate::report::{Block, Table};
use impactlab_core::collision::FrictionModel;
use impactlab_core::units::Quantity;
use impactlab_study::{BodyReport, ImpactAnswer, ImpactReport};

/// What an impulse solution contributes.
pub(super) fn part(answer: &ImpactAnswer, context: Context<'_>) -> Part {
    let (report, wording) = (&answer.report, context.wording);
    let words = wording.words;
    let mut blocks = vec![Block::paragraph(fill(words.ask_impact, &[("name", &report.name)]))];
    blocks.extend(fact_blocks(words.impact_caption, facts(report, wording), wording));
    blocks.push(Block::Table(vehicles(report, wording)));
    let caveats = &report.caveats;
    let figure = impact_figure((&answer.scenario, &answer.solution), caveats, wording.units).ok();
    let caption = || fill(words.impact_picture, &[("name", &report.name)]);
    let picture = figure.map(|figure| PartPicture::figure(caption(), figure));
    Part {
        kind: words.title_impact.to_owned(),
        title: format!("{}: {}", words.title_impact, report.name),
        answer: blocks,
        pictures: picture.into_iter().collect(),
        caveats: report.caveats.clone(),
        provenance: provenance_of(&report.provenance, &[], wording),
        methods: [Method::Impact].into(),
        ..Part::default()
    }
}

/// The contact and what it brings about.
fn facts(report: &ImpactReport, wording: &Wording) -> Vec<Fact> {
    let words = wording.words;
    let impulse = |value| wording.value(Quantity::Impulse, value);
    let closing = report.closing_velocity_m_s;
    let friction = match report.friction_model {
        FrictionModel::Limit => wording.given_number(report.friction_limit),
        FrictionModel::Paper => {
            format!("{}, {}", wording.given_number(report.friction_limit), words.always_sliding)
        }
    };
    let restitution = format!(
        "{} {}",
        wording.given_number(report.restitution),
        wording.term(report.restitution_form.label())
    );
    let mut facts = vec![
        Fact::plain(words.restitution, restitution),
        Fact::plain(words.friction_limit, friction),
        Fact::plain(words.regime, wording.term(report.regime.label())),
        Fact::plain(
            words.closing_velocity,
            wording.vector(Quantity::Speed, closing, [words.normal, words.tangential]),
        ),
        Fact::plain(
            words.impulse_on_struck,
            wording.vector(Quantity::Impulse, report.impulse_n_s, ["x", "y"]),
        ),
        Fact::plain(words.impulse_normal, impulse(report.impulse_normal_n_s)),
        Fact::plain(words.impulse_tangential, impulse(report.impulse_tangential_n_s)),
        Fact::plain(words.energy_loss, wording.value(Quantity::Energy, report.dissipated_energy_j)),
    ];
    let critical = report.critical_impulse_ratio;
    facts.extend(critical.map(|of| Fact::plain(words.critical_ratio, wording.number(of))));
    facts
}

/// Both vehicles after the impact.
fn vehicles(report: &ImpactReport, wording: &Wording) -> Table {
    let words = wording.words;
    let bodies = [&report.struck, &report.striking];
    let row = |label: &str, of: &dyn Fn(&BodyReport) -> String| {
        let [struck, striking] = bodies.map(of);
        [label.to_owned(), struck, striking]
    };
    let vector = |of| wording.vector(Quantity::Speed, of, ["x", "y"]);
    let turning = |of| wording.value(Quantity::AngularVelocity, of);
    let direction = |body: &BodyReport| match body.pdof_deg.zip(body.pdof_clock) {
        Some((deg, clock)) => fill(
            words.direction_value,
            &[
                ("angle", &wording.with_unit(&format!("{deg:.1}"), "deg")),
                ("clock", &clock.to_string()),
            ],
        ),
        None => words.none.to_owned(),
    };
    let rows = vec![
        row(words.delta_v, &|body| vector(body.delta_v_m_s)),
        row(words.velocity_after, &|body| vector(body.velocity_m_s)),
        row(words.yaw_rate_after, &|body| turning(body.yaw_rate_rad_s)),
        row(words.yaw_rate_change, &|body| turning(body.delta_yaw_rate_rad_s)),
        row(words.pdof, &direction),
    ];
    let columns = [words.quantity, words.struck_vehicle, words.striking_vehicle];
    Table::new(words.vehicles_after_impact, columns, rows)
}
