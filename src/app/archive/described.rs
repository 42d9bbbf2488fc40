//! Questions and settings in words.

use serde::Serialize;
use serde_json::Value;

use crate::app::archive::Fact;
use impactlab_study::{Learning, Request};

/// Returns in words how the answer of a question is made, such as “fine-tuned from shipped”.
pub fn how_it_was_made(question: &Request) -> String {
    match question {
        Request::TrainForce(_) => "trained from random weights".to_owned(),
        Request::TrainResponse(_) => "pre-trained on simulations".to_owned(),
        Request::FineTune(of) => {
            let start = of.model.as_ref().map(ToString::to_string);
            match (of.learning, start) {
                (Learning::Network, Some(start)) => format!("fine-tuned from {start}"),
                (Learning::Network, None) => "trained on trajectories alone".to_owned(),
                (Learning::Fleet, start) => {
                    format!("trained on a fleet from {}", start.unwrap_or_default())
                }
                (Learning::Strengths, start) => {
                    format!("conditioned on a car, from {}", start.unwrap_or_default())
                }
            }
        }
        Request::EvaluateForce(of) => format!("{} evaluated", of.model),
        Request::EvaluateResponse(of) => format!("{} evaluated", of.model),
        Request::Compare(of) => {
            let numbers: Vec<String> = of.trajectories.iter().map(usize::to_string).collect();
            format!("on {} trajectories, {} choices", numbers.join(", "), of.choices)
        }
        _ => String::new(),
    }
}

/// Returns the settings that differ from the usual ones, by their names in a settings file.
pub fn differences<C: Serialize>(config: &C, usual: &C) -> Vec<Fact> {
    let mut found = Vec::new();
    if let (Ok(config), Ok(usual)) = (serde_json::to_value(config), serde_json::to_value(usual)) {
        collect(String::new(), &config, Some(&usual), &mut found);
    }
    found
}

fn collect(name: String, value: &Value, usual: Option<&Value>, found: &mut Vec<Fact>) {
    if Some(value) == usual {
        return;
    }
    match value {
        Value::Object(fields) => {
            for (key, field) in fields {
                let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                collect(name, field, usual.and_then(|usual| usual.get(key)), found);
            }
        }
        _ => found.push(Fact::new(name, value)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_networks::force::ForceConfig;

    #[test]
    fn settings_that_differ_are_named_as_in_a_file() {
        let usual = ForceConfig::default();
        assert_eq!(differences(&usual, &usual), []);
        let mut other = usual.clone();
        other.training.epochs = 7;
        other.network.trunk = vec![3];
        let facts = differences(&other, &usual);
        assert_eq!(
            facts,
            [Fact::new("network.trunk", "[3]"), Fact::new("training.epochs", 7)],
            "{facts:?}"
        );
    }
}
