//! What a variant says otherwise than the first one.

use std::collections::BTreeSet;

use crate::report::InputClass;
use crate::report::answer::{given_rows, stated_rows};
use crate::report::numbers::Wording;
use crate::report::opinion::words::{OpinionWords, opinion_words};
use crate::report::parts::{InputRow, Part};
use crate::report::paths::ShownPaths;
use impactlab_core::units::UnitSystem;
use impactlab_reconstruct::evidence::Evidence;
use impactlab_study::case_file::Variant;
use impactlab_study::{EvidenceChoice, Request};

/// Differences that are named; more are counted.
const MOST_NAMED: usize = 5;

/// What the questions of a variant say otherwise than those of the first one: values that are other or
/// more, and values that are missing.
pub(super) fn differences(first: &[&Part], other: &[&Part], wording: &Wording) -> String {
    let words = opinion_words(wording.language);
    let mut named = named_differences(&asked(first, wording), &asked(other, wording), words);
    let n_more = named.len().saturating_sub(MOST_NAMED);
    named.truncate(MOST_NAMED);
    let mut text = named.join("; ");
    if n_more > 0 {
        text.push_str(&words.more.replace("{n}", &n_more.to_string()));
    }
    if text.is_empty() { words.asked_alike.to_owned() } else { text }
}

/// What a variant asks otherwise than the first one, each difference in words with its units; nothing where
/// they ask the same.
pub fn variant_differences(first: &Variant, other: &Variant, units: UnitSystem) -> Vec<String> {
    let (wording, paths) = (Wording::english(units), ShownPaths::default());
    let rows = |variant: &Variant| -> Vec<InputRow> {
        let rows = |request| {
            let evidence = evidence_in(request).map(|found| stated_rows(found, &wording));
            [given_rows(request, "", &wording, &paths), evidence.unwrap_or_default()].concat()
        };
        variant.questions.iter().flat_map(rows).collect()
    };
    let [before, now] = [rows(first), rows(other)];
    let [before, now] = [&before, &now].map(|rows| rows.iter().collect::<Vec<_>>());
    named_differences(&before, &now, opinion_words(wording.language))
}

/// What was found, where it stands in the question itself.
fn evidence_in(request: &Request) -> Option<&Evidence> {
    match request {
        Request::Reconstruct(request) => match &request.evidence {
            EvidenceChoice::Inline(evidence) => Some(evidence),
            EvidenceChoice::File(_) => None,
        },
        _ => None,
    }
}

/// Values that are other or more, and values that are missing, each once; a part of which several values stood
/// there and none is left is named by itself.
fn named_differences(before: &[&InputRow], now: &[&InputRow], words: &OpinionWords) -> Vec<String> {
    let mut named: Vec<String> = Vec::new();
    let mut add = |text: String| {
        if !named.contains(&text) {
            named.push(text);
        }
    };
    for row in now.iter().filter(|row| !before.contains(row)) {
        add(format!("{}: {}", name(row), row.value));
    }
    for what in missing_inputs(before, now) {
        add(format!("{} {what}", words.without));
    }
    named
}

/// Values of which nothing is left, each once; a part of which several values stood there and none is left is
/// named by itself.
pub(in crate::report) fn missing_inputs(before: &[&InputRow], now: &[&InputRow]) -> Vec<String> {
    let is_gone = |row: &&&InputRow| !now.iter().any(|other| key(other) == key(row));
    let what = |row: &&InputRow| {
        let is_like = |other: &&&InputRow| other.group == row.group;
        let is_whole = !inner(row).is_empty()
            && before.iter().filter(is_like).count() > 1
            && !now.iter().any(|it| is_like(&it));
        if is_whole { inner(row).to_owned() } else { name(row) }
    };
    let mut seen = BTreeSet::new();
    before.iter().filter(is_gone).map(what).filter(|what| seen.insert(what.clone())).collect()
}

/// What the questions say; what follows from it by rule is not.
fn asked<'a>(parts: &[&'a Part], wording: &Wording) -> Vec<&'a InputRow> {
    let words = wording.words;
    let sources = [
        words.source_question,
        words.source_question_sigma,
        words.source_file,
        words.source_evidence,
        words.source_evidence_sigma,
        words.source_default_sigma,
    ];
    let is_asked = |row: &&InputRow| match row.class {
        InputClass::Given | InputClass::Measured => sources.contains(&row.source.as_str()),
        // A setting that another variant may have changed.
        _ => row.source == words.source_program,
    };
    parts.iter().flat_map(|part| &part.inputs).filter(is_asked).collect()
}

fn key(row: &InputRow) -> (&str, &str) {
    (&row.group, &row.label)
}

/// The innermost thing that a value belongs to, and the value.
fn name(row: &InputRow) -> String {
    let inner = inner(row);
    if inner.is_empty() { row.label.clone() } else { format!("{inner}, {}", row.label) }
}

/// The innermost thing that a value belongs to; empty if there is none.
fn inner(row: &InputRow) -> &str {
    row.group.rsplit(", ").next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::collision::Scenario;
    use impactlab_study::{ImpactRequest, ReconstructRequest, ScenarioChoice};

    fn part(rows: &[[&str; 2]]) -> Part {
        let wording = Wording::english(UnitSystem::Si);
        let row = |[label, value]: &[&str; 2]| InputRow {
            group: "motion, brake".to_owned(),
            label: (*label).to_owned(),
            value: (*value).to_owned(),
            class: InputClass::Given,
            source: wording.words.source_question.to_owned(),
        };
        Part { inputs: rows.iter().map(row).collect(), ..Part::default() }
    }

    #[test]
    fn what_is_other_more_and_missing_is_named_and_nothing_else() {
        let wording = Wording::english(UnitSystem::Si);
        let first = part(&[["mass", "2000 kg"], ["start", "0 s"], ["side", "left"]]);
        let other = part(&[["mass", "1500 kg"], ["start", "0 s"], ["share", "0.8"]]);
        let text = differences(&[&first], &[&other], &wording);
        assert_eq!(text, "brake, mass: 1500 kg; brake, share: 0.8; without brake, side");
        assert_eq!(differences(&[&first], &[&first], &wording), "asked as the first variant");
        let text = differences(&[&first], &[&Part::default()], &wording);
        assert_eq!(text, "without brake", "what has no value left is named once");
    }

    /// Of a friction of 0.4 ± 0.05 in place of 0.7 ± 0.05 the opinion said “asked as the first variant”.
    #[test]
    fn what_is_measured_is_asked_too() {
        let wording = Wording::english(UnitSystem::Si);
        let words = wording.words;
        let measured = |friction: &str, source: &str| {
            let mut part = part(&[["friction", friction]]);
            part.inputs[0].class = InputClass::Measured;
            part.inputs[0].source = source.to_owned();
            part
        };
        for source in [
            words.source_question,
            words.source_question_sigma,
            words.source_evidence,
            words.source_default_sigma,
        ] {
            let [dry, wet] = ["0.70 ± 0.05", "0.40 ± 0.05"].map(|value| measured(value, source));
            let text = differences(&[&dry], &[&wet], &wording);
            assert_eq!(text, "brake, friction: 0.40 ± 0.05", "{source}");
        }
        let rule = measured("0.70 ± 0.05", words.source_prior_rule);
        let other = measured("0.40 ± 0.05", words.source_prior_rule);
        let text = differences(&[&rule], &[&other], &wording);
        assert_eq!(text, "asked as the first variant", "what follows by rule is not asked");
    }

    /// A question about the same collision says nothing new; units are those that are asked for.
    #[test]
    fn variants_differ_in_what_their_questions_say() {
        let variant = |mass_kg: f64, restitution| {
            let mut scenario = Scenario::example();
            scenario.struck.mass_kg = mass_kg;
            scenario.contact.restitution = restitution;
            let asked = ImpactRequest::new(ScenarioChoice::Inline(Box::new(scenario)));
            let questions = vec![asked.clone().into(), asked.into()];
            Variant { questions, ..Variant::default() }
        };
        let first = variant(2000.0, Some(0.15));
        let of = |other: &Variant, units| variant_differences(&first, other, units);
        assert_eq!(of(&first, UnitSystem::Si), [""; 0]);
        let heavy = variant(2500.0, Some(0.15));
        let in_kilograms = of(&heavy, UnitSystem::Si);
        assert!(in_kilograms.len() == 1, "{in_kilograms:?}");
        assert!(in_kilograms[0].starts_with("struck vehicle, mass: 2500"), "{in_kilograms:?}");
        let in_pounds = of(&heavy, UnitSystem::Us);
        assert!(in_pounds.len() == 1 && in_pounds[0].ends_with(" lb"), "{in_pounds:?}");
        let mut scenario = Scenario::example();
        let [vx_m_s, vy_m_s] = [scenario.striking.vx_world_m_s, scenario.striking.vy_world_m_s];
        scenario.striking.vx_world_m_s *= 20.0 / vx_m_s.hypot(vy_m_s);
        scenario.striking.vy_world_m_s *= 20.0 / vx_m_s.hypot(vy_m_s);
        scenario.contact.restitution = Some(0.15);
        let asked = ImpactRequest::new(ScenarioChoice::Inline(Box::new(scenario)));
        let fast = Variant { questions: vec![asked.into()], ..Variant::default() };
        let told = of(&fast, UnitSystem::Si);
        assert!(told.len() == 1 && told[0].starts_with("striking vehicle, speed: 72"), "{told:?}");
        let open = of(&variant(2000.0, None), UnitSystem::Si);
        assert!(open.len() == 1 && open[0].starts_with("without "), "{open:?}");
    }

    /// “nothing” differed between two variants of which one has another friction of the road.
    #[test]
    fn variants_differ_in_the_evidence_of_their_questions() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../datasets/staged/evidence/s03.toml");
        let found = Evidence::load(std::path::Path::new(file)).unwrap();
        let variant = |found: &Evidence| {
            let evidence = EvidenceChoice::Inline(Box::new(found.clone()));
            let questions = vec![ReconstructRequest::new(evidence).into()];
            Variant { questions, ..Variant::default() }
        };
        let mut other = found.clone();
        other.friction.as_mut().unwrap().value = Some(0.4);
        other.edr = None;
        let differ = |other: &Variant| variant_differences(&variant(&found), other, UnitSystem::Si);
        assert_eq!(differ(&variant(&found)), [""; 0]);
        let told = differ(&variant(&other));
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told[0].starts_with("friction of the road, peak friction: 0.4"), "{told:?}");
        assert!(told[1].starts_with("without event data recorder"), "{told:?}");
    }
}
