//! Where the answers hold, and what restricts them: each restriction with its sentence and a remedy.

use std::collections::BTreeSet;

use crate::report::answer::capitalized;
use crate::report::build::{VariantParts, parts_of};
use crate::report::holders::AnswerNames;
use crate::report::method::Method;
use crate::report::numbers::{Wording, fill};
use crate::report::opinion::{are_by_hand, considered_methods};
use crate::report::parts::Part;
use crate::report::{Block, Table};
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatQuantity};
use impactlab_core::units::{significant, trimmed};

/// How the name of a p begins, and the least one that is told.
const P_OF: &str = "p of ";
const LEAST_P: f64 = 0.001;

/// The limits of each method, how far networks apply, and every restriction once.
pub(super) fn validity_blocks(
    variants: &[VariantParts],
    methods: &BTreeSet<Method>,
    wording: &Wording,
) -> Vec<Block> {
    let words = wording.words;
    let text = if are_by_hand(variants) { words.validity_by_hand } else { words.validity_text };
    let mut blocks = vec![Block::paragraph(text)];
    let considered = considered_methods(variants);
    let others = methods.difference(&considered);
    let limits = others.map(|it| format!("{}: {}", it.name(wording), it.limits(wording)));
    let limits: Vec<String> = limits.collect();
    if !limits.is_empty() {
        blocks.push(Block::paragraph(words.validity_models));
        blocks.push(Block::List { items: limits });
    }
    let domain = each_once(variants, |part| part.domain.clone());
    let holders_of = |holders: &[AnswerNames<'_>]| holders_text(holders, variants, wording);
    if !domain.is_empty() {
        let rows = domain.into_iter().map(|(text, holders)| [text, holders_of(&holders)]).collect();
        let columns = [words.sentence, words.holds_for];
        blocks.push(Block::Table(Table::new(words.domain_caption, columns, rows)));
    }
    let rows = caveat_rows(variants, wording);
    if rows.is_empty() {
        blocks.push(Block::paragraph(words.no_badges));
    } else {
        let columns = [words.restriction, words.sentence, words.remedy, words.holds_for];
        blocks.push(Block::Table(Table::new(words.badges_caption, columns, rows)));
    }
    blocks
}

/// What the answers have, each once, with the answers that have it.
fn each_once<T: PartialEq>(
    variants: &[VariantParts],
    items: impl Fn(&Part) -> Vec<T>,
) -> Vec<(T, Vec<AnswerNames<'_>>)> {
    let mut found: Vec<(T, Vec<AnswerNames<'_>>)> = Vec::new();
    for variant in variants {
        for part in parts_of(variant) {
            for item in items(part) {
                match found.iter_mut().find(|(known, _)| *known == item) {
                    Some((_, holders)) => add_holder(holders, &part.kind, &variant.name),
                    None => {
                        let mut holders = Vec::new();
                        add_holder(&mut holders, &part.kind, &variant.name);
                        found.push((item, holders));
                    }
                }
            }
        }
    }
    found
}

/// Adds an answer by the kind of its question.
fn add_holder<'a>(holders: &mut Vec<AnswerNames<'a>>, kind: &'a str, variant: &'a str) {
    match holders.iter_mut().find(|it| it.title == kind) {
        Some(it) => it.add(variant),
        None => holders.push(AnswerNames { title: kind, variants: vec![variant] }),
    }
}

fn holders_text(
    holders: &[AnswerNames<'_>],
    variants: &[VariantParts],
    wording: &Wording,
) -> String {
    holders.iter().map(|it| it.text(variants, wording)).collect::<Vec<_>>().join("; ")
}

/// Every restriction once, warnings first, with the answers that have it; of what was assumed and what is
/// not used a summary, since the inputs list them.
fn caveat_rows(variants: &[VariantParts], wording: &Wording) -> Vec<[String; 4]> {
    let words = wording.words;
    let mut found = each_once(variants, |part| {
        let restrictions = part.caveats.restrictions().into_iter().cloned();
        restrictions.chain(part.caveats.summaries()).collect()
    });
    found.sort_by_key(|(caveat, _)| !caveat.is_warning());
    let row = |(caveat, holders): (Caveat, Vec<AnswerNames<'_>>)| {
        let severity = if caveat.is_warning() { words.warning } else { words.note };
        let label = format!("{severity}: {}", caveat.kind.label_in(wording.language));
        [
            label,
            sentence(&caveat, wording),
            remedy(caveat.kind, wording).to_owned(),
            holders_text(&holders, variants, wording),
        ]
    };
    found.into_iter().map(row).collect()
}

/// What a caveat says, with the value that is concerned and those that would raise none.
fn sentence(caveat: &Caveat, wording: &Wording) -> String {
    let words = wording.words;
    let mut text = wording.caveat_text(caveat);
    if let Some(CaveatQuantity { name, unit, value, range }) = caveat.quantity_in(wording)
        && !caveat.value.is_some_and(|value_si| has_number(&caveat.text, value_si))
        && !has_number(&text.replace(',', "."), value)
    {
        let is_p = name.starts_with(P_OF);
        let number = |value: f64| match is_p {
            true => p_text(value, wording),
            false => wording.local(&trimmed(significant(value))),
        };
        let range = match range {
            // One course of events is the only number of them that raises no warning.
            Some([Some(low), Some(high)]) if low == high => number(low),
            Some([Some(low), Some(high)]) => {
                format!("{} {} {}", number(low), words.to, number(high))
            }
            Some([Some(low), None]) => fill(words.at_least, &[("low", &number(low))]),
            Some([None, Some(high)]) => fill(words.at_most, &[("high", &number(high))]),
            _ => return text,
        };
        let quantity = format!("{}{unit}", wording.label(name));
        let quantity = if is_p { quantity } else { capitalized(&quantity) };
        let value = number(value);
        let values = [("quantity", &*quantity), ("value", &*value), ("range", &*range)];
        text = format!("{text}. {}.", fill(words.allowed_range, &values));
    }
    text
}

/// A p, as the tables of the evidence have it.
fn p_text(p: f64, wording: &Wording) -> String {
    match p < LEAST_P {
        true => format!("< {}", wording.given_number(LEAST_P)),
        false => wording.local(&trimmed(format!("{p:.3}"))),
    }
}

/// Whether a text has a value as a whole number of its own, so that 0 is not said by 10.
fn has_number(text: &str, value: f64) -> bool {
    let is_number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    let numbers = text.split(|c| !is_number(c));
    let mut numbers = numbers.map(|number| number.trim_end_matches('.'));
    numbers.any(|number| number == significant(value) || is_rounded(number, value))
}

/// Whether a text says a value, or that in per cent, with fewer digits, of which there are two or more.
fn is_rounded(number: &str, value: f64) -> bool {
    let decimals = number.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let digits = number.trim_start_matches(['-', '0', '.']);
    let n_digits = digits.chars().filter(char::is_ascii_digit).count();
    n_digits > 1 && [value, 100.0 * value].iter().any(|it| format!("{it:.decimals$}") == number)
}

/// What can be done about a restriction.
fn remedy(kind: CaveatKind, wording: &Wording) -> &'static str {
    let words = wording.words;
    match kind {
        CaveatKind::Outdated => words.remedy_outdated,
        CaveatKind::Note => words.none,
        CaveatKind::OutsideDomain => words.remedy_outside_domain,
        CaveatKind::ImplausibleContact => words.remedy_implausible_contact,
        CaveatKind::Disagreement => words.remedy_disagreement,
        CaveatKind::OtherVehicle => words.remedy_other_vehicle,
        CaveatKind::Overlap => words.remedy_overlap,
        CaveatKind::SecondContact => words.remedy_second_contact,
        CaveatKind::ContactNotEnded => words.remedy_contact_not_ended,
        CaveatKind::DoubtfulData => words.remedy_doubtful_data,
        CaveatKind::EnergyGain => words.remedy_energy_gain,
        CaveatKind::WheelLift => words.remedy_wheel_lift,
        CaveatKind::RollLimit => words.remedy_roll_limit,
        CaveatKind::NotAtRest => words.remedy_not_at_rest,
        CaveatKind::EvidenceUnexplained => words.remedy_evidence_unexplained,
        CaveatKind::FewParticles => words.remedy_few_particles,
        CaveatKind::FewDraws => words.remedy_few_draws,
        CaveatKind::SeveralCourses => words.remedy_several_courses,
        CaveatKind::DriverOpen => words.remedy_driver_open,
        CaveatKind::HardlyValidated => words.remedy_hardly_validated,
        CaveatKind::NoInterval => words.remedy_no_interval,
        CaveatKind::LeftOut => words.remedy_left_out,
        CaveatKind::TrainedOn => words.remedy_trained_on,
        CaveatKind::Assumed => words.remedy_assumed,
        CaveatKind::NotUsed => words.remedy_not_used,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::UnitSystem;

    /// “P of EDR speed: 0.000001” stood beside “p: < 0.001”.
    #[test]
    fn a_p_has_the_digits_of_the_tables() {
        let wording = Wording::english(UnitSystem::Si);
        let told = |p| {
            let caveat = Caveat::new(CaveatKind::EvidenceUnexplained, "rest x: found 1.00 m");
            sentence(&caveat.with_value("p of rest x", p).with_range([0.05, 1.0]), &wording)
        };
        assert!(told(1e-6).ends_with("p of rest x: < 0.001, without restriction 0.05 to 1."));
        assert!(told(0.008_259).contains("p of rest x: 0.008,"), "{}", told(0.008_259));
    }

    /// “Courses of events: 5, without restriction 1 to 1” was told.
    #[test]
    fn a_range_of_one_number_is_told_as_that_number() {
        let caveat = Caveat::new(CaveatKind::SeveralCourses, "several are possible");
        let caveat = caveat.with_value("courses of events", 5.0).with_range([1.0, 1.0]);
        let told = sentence(&caveat, &Wording::english(UnitSystem::Si));
        assert!(told.ends_with("Courses of events: 5, without restriction 1."), "{told}");
    }

    /// “it still moves at 7.9 m/s … speed at the end: 7.914” said one thing twice.
    #[test]
    fn a_value_that_the_sentence_has_with_fewer_digits_is_not_told_again() {
        assert!(is_rounded("7.9", 7.914) && is_rounded("10.3", 0.1031) && is_rounded("4.00", 4.0));
        assert!(!is_rounded("7.8", 7.914) && !is_rounded("8", 7.914) && !is_rounded("0.0", 0.01));
        assert!(!is_rounded("", 0.2));
        assert!(has_number("it still moves at 2.1 km/h", 2.072) && !has_number("10 m", 0.0));
    }
}
