//! Collisions at random through the questions that are asked about one: every number finite, every
//! interval in order and around its median, and no energy gained without a badge.
//!
//! `FUZZ_INPUTS` and `FUZZ_SEED` say how many, and which. One in 40 is asked for its motion by the
//! networks, since that takes a second.

use std::collections::BTreeMap;
use std::env;
use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::collision::Scenario;
use impactlab_core::uncertainty::CaveatKind;
use impactlab_study::analysis::PulseSetup;
use impactlab_study::{
    Event, ForceQuestion, ForceSource, ImpactRequest, Library, ModelChoice, MotionSource,
    PredictForceRequest, PredictMotionRequest, Question, ScenarioChoice, SimulateRequest,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;

/// Collisions in a run that nobody says the length of.
const N_COLLISIONS: u64 = 60;

/// A collision as a file: any masses, speeds, angles and places that the program takes, half of them such
/// as cars meet, half of them at the ends of their ranges.
fn collision(rng: &mut ChaCha8Rng) -> String {
    let mut number = |usual: [f64; 2], widest: [f64; 2]| {
        let [from, to] = if rng.random_bool(0.8) { usual } else { widest };
        rng.random_range(from..=to)
    };
    let mut text = String::new();
    for name in ["target", "bullet"] {
        let heading_deg = match name {
            "target" => 0.0,
            _ => number([-40.0, 40.0], [-180.0, 180.0]),
        };
        let mass_kg = number([900.0, 2600.0], [300.0, 40_000.0]);
        let length_m = number([3.6, 5.4], [2.0, 12.0]);
        text += &format!(
            "[{name}]\nmass_kg = {mass_kg}\nyaw_inertia_kg_m2 = {}\nlength_m = {length_m}\n\
             width_m = {}\ncg_from_front_m = {}\nheading_deg = {heading_deg}\nspeed_m_s = {}\n\n",
            mass_kg * number([1.5, 2.2], [0.5, 6.0]),
            number([1.6, 2.0], [1.2, 2.6]),
            length_m * number([0.42, 0.56], [0.2, 0.8]),
            number([8.0, 30.0], [0.0, 80.0]),
        );
    }
    let side = ["left", "right", "rear", "front"][number([0.0, 3.99], [0.0, 3.99]) as usize];
    let offset_m = number([-1.6, 0.8], [-2.0, 2.0]) * if side == "rear" { 0.3 } else { 1.0 };
    text += &format!("[contact]\nfrom = \"side\"\nside = \"{side}\"\noffset_m = {offset_m}\n");
    if number([0.0, 1.0], [0.0, 1.0]) < 0.7 {
        text += &format!(
            "restitution = {}\nfriction_limit = {}\n",
            number([0.0, 0.5], [0.0, 1.0]),
            number([0.1, 0.7], [0.0, 2.0])
        );
    }
    text
}

/// What was wrong with an answer.
fn fault(answer: &Value) -> Option<String> {
    match answer {
        Value::Object(fields) => {
            let median = fields.get("median").and_then(Value::as_f64);
            for interval in fields.get("intervals").and_then(Value::as_array).into_iter().flatten()
            {
                let end = |key: &str| interval[key].as_f64();
                match (end("low"), median, end("high")) {
                    (Some(low), Some(median), Some(high)) if low <= median && median <= high => {}
                    other => return Some(format!("interval {other:?}")),
                }
            }
            let is_chance = |name: &str| name.starts_with("p_") || name.ends_with("probability");
            fields.iter().find_map(|(name, value)| match value.as_f64() {
                Some(p) if is_chance(name) && !(0.0..=1.0).contains(&p) => {
                    Some(format!("{name} = {p}"))
                }
                _ => fault(value).map(|text| format!("{name}: {text}")),
            })
        }
        Value::Array(values) => values.iter().find_map(fault),
        _ => None,
    }
}

/// An answer as JSON, or the error.
fn asked<Q: Question>(question: &Q, library: &Library) -> Result<Value, String>
where
    Q::Report: serde::Serialize + std::fmt::Debug,
{
    let mut go_on = |_: Event<'_>| ControlFlow::Continue(());
    let answer = question.answer(library, &mut go_on).map_err(|error| chain(&error))?;
    let answer = answer.complete().expect("nobody cancels");
    let report = Q::report(&answer);
    if let Some(found) = crate::harness::not_finite(&report) {
        return Err(format!("FAULT not finite: {found}"));
    }
    let value = serde_json::to_value(report).expect("JSON");
    fault(&value).map_or(Ok(value), |found| Err(format!("FAULT {found}")))
}

fn chain(error: &dyn Error) -> String {
    impactlab_core::error_chain(error)
}

/// The energy of a momentum solution is not more than before, or a badge says so.
fn gains_energy(answer: &Value) -> bool {
    let lost_j = answer["dissipated_energy_j"].as_f64().unwrap_or(f64::NAN);
    let is_told = answer["caveats"].as_array().into_iter().flatten().any(|caveat| {
        caveat["kind"] == serde_json::to_value(CaveatKind::EnergyGain).expect("a word")
    });
    (lost_j < -1e-6) != is_told
}

#[test]
fn collisions_at_random_have_finite_ordered_answers() {
    let number = |name: &str| env::var(name).ok().map(|text| text.parse::<u64>().expect(name));
    let seed = number("FUZZ_SEED").unwrap_or(0);
    let n = number("FUZZ_INPUTS").unwrap_or(N_COLLISIONS);
    let library = Library::default();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (mut n_answered, mut refusals) = (0, BTreeMap::<String, u64>::new());
    for idx in 0..n {
        let text = collision(&mut rng);
        let scenario = match Scenario::from_toml(&text, Path::new("collision.toml")) {
            Ok(scenario) => ScenarioChoice::Inline(Box::new(scenario)),
            Err(error) => {
                *refusals.entry(kind(&chain(&error))).or_default() += 1;
                continue;
            }
        };
        let source =
            MotionSource::Scenario { scenario: scenario.clone(), pulse: PulseSetup::default() };
        let mut answers = vec![
            asked(&ImpactRequest::new(scenario.clone()), &library),
            asked(&ImpactRequest { paper: true, ..ImpactRequest::new(scenario.clone()) }, &library),
            asked(&SimulateRequest::new(source.clone()), &library),
        ];
        if idx % 10 == 0 {
            let question = PredictForceRequest::new(ForceQuestion::Scenario(scenario));
            answers.push(asked(&question, &library));
        }
        if idx % 40 == 0 {
            let force = ForceSource::Predicted(ModelChoice::default());
            let question =
                PredictMotionRequest { draws: 3, ..PredictMotionRequest::new(source, force) };
            answers.push(asked(&question, &library));
        }
        for answer in answers {
            match answer {
                Ok(answer) => {
                    n_answered += 1;
                    let is_impact = answer["dissipated_energy_j"].is_number();
                    assert!(!(is_impact && gains_energy(&answer)), "energy\n{answer}\n{text}");
                }
                Err(message) => {
                    assert!(!message.starts_with("FAULT"), "{message}\n{text}");
                    *refusals.entry(kind(&message)).or_default() += 1;
                }
            }
        }
    }
    println!("{n} collisions, {n_answered} answers; refused: {refusals:#?}");
    assert!(n_answered >= n, "{n_answered} answers to {n} collisions: {refusals:?}");
}

/// A message without its numbers.
fn kind(message: &str) -> String {
    let is_number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    message.split(is_number).filter(|part| !part.is_empty()).collect::<Vec<_>>().join("#")
}
