//! Questions in words.

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
