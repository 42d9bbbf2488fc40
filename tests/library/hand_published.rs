//! The methods by hand compared with exercises whose answers are published: books, manuals, pages.
//!
//! `tests/data/hand_published.toml` has their numbers in the units of the publication, and where
//! they are.

use std::collections::{BTreeMap, BTreeSet};

use impactlab_core::units::Quantity;
use impactlab_reconstruct::evidence::Stated;
use impactlab_reconstruct::hand::{HandAnswer, HandInputs, HandMethod, HandQuestion};
use serde::Deserialize;

const EXERCISES: &str = include_str!("../data/hand_published.toml");
const GUIDE: &str = include_str!("../../docs/guide/hand-methods.md");

/// Exercises that each method has at least.
const FEWEST: usize = 3;
/// Share of an answer beyond which a tolerance says nothing.
const WIDEST: f64 = 0.05;
const DRAWS: usize = 2000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Published {
    source: BTreeMap<String, Source>,
    exercise: Vec<Exercise>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Source {
    title: String,
    author: String,
    year: Option<u16>,
    address: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Exercise {
    method: HandMethod,
    source: String,
    place: String,
    inputs: Vec<BTreeMap<String, String>>,
    answers: BTreeMap<String, String>,
    #[serde(default)]
    rounded: BTreeSet<String>,
    #[serde(default)]
    constants: f64,
    #[serde(default)]
    interval: bool,
}

fn published() -> Published {
    toml::from_str(EXERCISES).expect("the exercises")
}

/// A number with its unit, in SI units.
fn si(quantity: Quantity, text: &str) -> f64 {
    let parsed = quantity.parse(text, &quantity.si_unit());
    parsed.unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// Half a unit of the last digit of a number, in SI units.
fn half_a_digit(quantity: Quantity, text: &str) -> f64 {
    let number = text.split(' ').next().unwrap_or_default();
    let decimals = number.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    let unit = text.strip_prefix(number).unwrap_or_default();
    let digit = format!("0.{}5{unit}", "0".repeat(decimals));
    si(quantity, &digit)
}

impl Exercise {
    fn named(&self, key: &str) -> String {
        format!("{}, {}, {}: {key}", self.method.word(), self.source, self.place)
    }

    /// What an input measures, and its key.
    fn input(&self, word: &str) -> (Quantity, String) {
        let field = self.method.fields().iter().find(|field| field.word() == word);
        let field = field.unwrap_or_else(|| panic!("no such input: {}", self.named(word)));
        (field.range.quantity, field.si_key())
    }

    fn output(&self, key: &str) -> Quantity {
        let output = self.method.outputs().iter().find(|output| output.key == key);
        output.unwrap_or_else(|| panic!("no such answer: {}", self.named(key))).quantity
    }

    /// The inputs of each part without an error, and one of them moved.
    fn parts(&self, moved: &str, by: f64) -> Vec<HandInputs> {
        let of_part = |part: &BTreeMap<String, String>| -> HandInputs {
            let stated = part.iter().map(|(word, text)| {
                let (quantity, key) = self.input(word);
                let step = if word == moved { by * half_a_digit(quantity, text) } else { 0.0 };
                let value = Some(si(quantity, text) + step);
                (key, Stated { value, sigma: Some(0.0) })
            });
            stated.collect()
        };
        self.inputs.iter().map(of_part).collect()
    }

    fn answered(&self, inputs: &HandInputs) -> HandAnswer {
        let question = HandQuestion { method: self.method, inputs, points_m: &[] };
        let answer = question.answer(DRAWS, 0);
        answer.unwrap_or_else(|error| panic!("{}: {error}", self.named("")))
    }

    /// What each part gives.
    fn found(&self, key: &str, moved: &str, by: f64) -> Vec<f64> {
        let of_part = |inputs: &HandInputs| {
            let answer = self.answered(inputs);
            let quantity = answer.quantities.iter().find(|of| of.output.key == key);
            quantity.unwrap_or_else(|| panic!("no answer: {}", self.named(key))).value
        };
        self.parts(moved, by).iter().map(of_part).collect()
    }

    /// How far the publication may be off by its digits and its constants, in SI units.
    fn tolerance(&self, key: &str, text: &str) -> f64 {
        let quantity = self.output(key);
        let of_input = |word: &String| -> f64 {
            let [low, high] = [-1.0, 1.0].map(|by| self.found(key, word, by));
            low.iter().zip(&high).map(|(low, high)| (high - low).abs() / 2.0).sum()
        };
        let of_inputs: f64 = self.rounded.iter().map(of_input).sum();
        let of_constants = self.constants * si(quantity, text).abs();
        half_a_digit(quantity, text) + of_constants + of_inputs
    }
}

#[test]
fn published_answers_are_found() {
    let published = published();
    for exercise in published.exercise.iter().filter(|exercise| !exercise.interval) {
        for (key, text) in &exercise.answers {
            let named = exercise.named(key);
            let expected = si(exercise.output(key), text);
            let found: f64 = exercise.found(key, "", 0.0).iter().sum();
            let tolerance = exercise.tolerance(key, text);
            assert!(tolerance < WIDEST * expected.abs(), "{named}: ± {tolerance} of {expected}");
            let off = (found - expected).abs();
            assert!(off <= tolerance, "{named}: {found}, expected {expected} ± {tolerance}");
        }
    }
}

/// Of a spin-out the publication knows the resistance of each wheel, and the rolling factor of the
/// program is a mean: the answers lie in its interval, on both sides of its middle.
#[test]
fn published_answers_of_another_method_lie_in_the_interval() {
    let published = published();
    let mut sides = BTreeSet::new();
    for exercise in published.exercise.iter().filter(|exercise| exercise.interval) {
        for (key, text) in &exercise.answers {
            let named = exercise.named(key);
            let expected = si(exercise.output(key), text);
            let parts = exercise.parts("", 0.0);
            assert_eq!(parts.len(), 1, "{named}");
            let answer = exercise.answered(&parts[0]);
            assert!(answer.violated.is_empty(), "{named}: {:?}", answer.violated);
            let quantity = answer.quantities.iter().find(|of| of.output.key == key).unwrap();
            let [low, high] = quantity.estimate.interval(0.9).unwrap();
            assert!((low..=high).contains(&expected), "{named}: {expected}, {low} to {high}");
            sides.insert(expected > quantity.value);
        }
    }
    assert_eq!(sides.len(), 2, "every answer lies on one side of ours");
}

#[test]
fn every_method_has_three_exercises_with_their_source() {
    let published = published();
    for method in HandMethod::ALL {
        let of_method = published.exercise.iter().filter(|exercise| exercise.method == *method);
        let places: BTreeSet<(&str, &str)> =
            of_method.map(|exercise| (exercise.source.as_str(), exercise.place.as_str())).collect();
        assert!(places.len() >= FEWEST, "{method:?}: {places:?}");
    }
    let used: BTreeSet<&String> = published.exercise.iter().map(|of| &of.source).collect();
    let listed: BTreeSet<&String> = published.source.keys().collect();
    assert_eq!(used, listed, "sources");
    for (key, source) in &published.source {
        assert!(!source.title.is_empty() && !source.author.is_empty(), "{key}");
        assert!(source.address.starts_with("http"), "{key}: {}", source.address);
        assert!(source.year.is_none_or(|year| (1970..=2030).contains(&year)), "{key}");
        // The guide says what was compared.
        assert!(GUIDE.contains(&source.title), "{key}: {} is missing in the guide", source.title);
    }
}
