//! Where the answers hold, and what restricts them: each restriction with its sentence and a remedy.

use std::collections::BTreeSet;

use crate::report::build::{VariantParts, parts_of};
use crate::report::method::Method;
use crate::report::numbers::{Wording, fill};
use crate::report::parts::Part;
use crate::report::{Block, Table};
use impactlab_core::uncertainty::{Badge, BadgeKind};
use impactlab_core::units::significant;

/// The limits of each method, how far networks apply, and every restriction once.
pub(super) fn validity_blocks(
    variants: &[VariantParts],
    methods: &BTreeSet<Method>,
    wording: &Wording,
) -> Vec<Block> {
    let words = wording.words;
    let mut blocks = vec![Block::paragraph(words.validity_text)];
    let limits = methods.iter().map(|of| format!("{}: {}", of.name(wording), of.limits(wording)));
    let limits: Vec<String> = limits.collect();
    if !limits.is_empty() {
        blocks.push(Block::List { items: limits });
    }
    let domain = each_once(variants, |part| part.domain.iter().collect());
    if !domain.is_empty() {
        let rows = domain.into_iter().map(|(text, of)| [text.clone(), of.join("; ")]).collect();
        let columns = [words.sentence, words.holds_for];
        blocks.push(Block::Table(Table::new(words.domain_caption, columns, rows)));
    }
    let rows = badge_rows(variants, wording);
    if rows.is_empty() {
        blocks.push(Block::paragraph(words.no_badges));
    } else {
        let columns = [words.restriction, words.sentence, words.remedy, words.holds_for];
        blocks.push(Block::Table(Table::new(words.badges_caption, columns, rows)));
    }
    blocks
}

/// What the answers have, each once, with the answers that have it.
fn each_once<'a, T: PartialEq>(
    variants: &'a [VariantParts],
    of: impl Fn(&'a Part) -> Vec<&'a T>,
) -> Vec<(&'a T, Vec<String>)> {
    let mut found: Vec<(&T, Vec<String>)> = Vec::new();
    for variant in variants {
        for part in parts_of(variant) {
            let name = match variants.len() {
                1 => part.kind.clone(),
                _ => format!("{}: {}", variant.name, part.kind),
            };
            for item in of(part) {
                match found.iter_mut().find(|(known, _)| *known == item) {
                    Some((_, names)) if !names.contains(&name) => names.push(name.clone()),
                    Some(_) => {}
                    None => found.push((item, vec![name.clone()])),
                }
            }
        }
    }
    found
}

/// Every badge once, warnings first, with the answers that have it.
fn badge_rows(variants: &[VariantParts], wording: &Wording) -> Vec<[String; 4]> {
    let words = wording.words;
    let mut found = each_once(variants, |part| part.badges.iter().collect());
    found.sort_by_key(|(badge, _)| !badge.kind.is_warning());
    let row = |(badge, of): (&Badge, Vec<String>)| {
        let severity = if badge.kind.is_warning() { words.warning } else { words.note };
        let label = format!("{severity}: {}", wording.term(badge.kind.label()));
        [label, sentence(badge, wording), remedy(badge.kind, wording).to_owned(), of.join("; ")]
    };
    found.into_iter().map(row).collect()
}

/// What a badge says, with the value that is concerned and those that would raise none.
fn sentence(badge: &Badge, wording: &Wording) -> String {
    let words = wording.words;
    let mut text = wording.quoted(&badge.text);
    // A whole number of the text, so that 0 is not said by 10.
    let is_number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    let is_said = |value: f64| {
        let (said, mut numbers) = (significant(value), badge.text.split(|c| !is_number(c)));
        numbers.any(|number| number.trim_end_matches('.') == said)
    };
    if let (Some(quantity), Some(value)) = (&badge.quantity, badge.value)
        && !is_said(value)
    {
        let range = match badge.range {
            Some([Some(low), Some(high)]) => {
                format!("{} {} {}", wording.number(low), words.to, wording.number(high))
            }
            Some([Some(low), None]) => fill(words.at_least, &[("low", &wording.number(low))]),
            Some([None, Some(high)]) => fill(words.at_most, &[("high", &wording.number(high))]),
            _ => return text,
        };
        let quantity = wording.quoted(quantity);
        let values =
            [("quantity", &*quantity), ("value", &*wording.number(value)), ("range", &*range)];
        text = format!("{text}. {}.", fill(words.allowed_range, &values));
    }
    text
}

/// What can be done about a restriction.
fn remedy(kind: BadgeKind, wording: &Wording) -> &'static str {
    let words = wording.words;
    match kind {
        BadgeKind::OutsideDomain => words.remedy_outside_domain,
        BadgeKind::ImplausibleContact => words.remedy_implausible_contact,
        BadgeKind::Disagreement => words.remedy_disagreement,
        BadgeKind::Overlap => words.remedy_overlap,
        BadgeKind::SecondContact => words.remedy_second_contact,
        BadgeKind::ContactNotEnded => words.remedy_contact_not_ended,
        BadgeKind::EnergyGain => words.remedy_energy_gain,
        BadgeKind::WheelLift => words.remedy_wheel_lift,
        BadgeKind::RollLimit => words.remedy_roll_limit,
        BadgeKind::NotAtRest => words.remedy_not_at_rest,
        BadgeKind::EvidenceUnexplained => words.remedy_evidence_unexplained,
        BadgeKind::FewParticles => words.remedy_few_particles,
        BadgeKind::HardlyValidated => words.remedy_hardly_validated,
        BadgeKind::LeftOut => words.remedy_left_out,
        BadgeKind::TrainedOn => words.remedy_trained_on,
        BadgeKind::Assumed => words.remedy_assumed,
        BadgeKind::NotUsed => words.remedy_not_used,
    }
}
