//! JSON: comparisons, the state of the window, questions.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::error_chain;
use impactlab_networks::response::evaluate::Comparison;
use impactlab_study::{Library, Request};

use crate::harness::{Answer, Format, run};
use crate::mutation::Mutator;

#[test]
fn comparisons() {
    // A metric that does not exist is NaN on purpose.
    let load = |path: &Path| match Comparison::load(path) {
        Ok(_) => Answer { is_accepted: true, ..Answer::default() },
        Err(error) => Answer::refused(&error),
    };
    run(&Format {
        name: "comparison",
        n_inputs: 3_000,
        file_name: "comparison.json",
        names_file: true,
        seeds: Vec::new(),
        mutate: Mutator::json,
        load: &load,
    });
}

#[test]
fn questions() {
    let load = |path: &Path| {
        let text = fs::read(path).expect("the file can be read");
        let request: Request = match serde_json::from_slice(&text) {
            Ok(request) => request,
            Err(error) => return Answer::refused(&error),
        };
        let answer = Answer::accepted(&request);
        let written = serde_json::to_string(&request).expect("a question can be written");
        let again: Request = serde_json::from_str(&written).expect("what is written can be read");
        assert_eq!(again, request, "a question changes when it is written");
        // Of the questions whose answers take no time.
        if !matches!(request, Request::Impact(_)) {
            return answer;
        }
        match request.run(&Library::default(), &mut |_| ControlFlow::Continue(())) {
            Ok(report) => answer.and(&report),
            Err(error) => Answer { messages: vec![error_chain(&error)], ..answer },
        }
    };
    run(&Format {
        name: "request",
        n_inputs: 20_000,
        file_name: "request.json",
        names_file: false,
        seeds: Vec::new(),
        mutate: Mutator::json,
        load: &load,
    });
}

#[test]
fn states_of_the_window() {
    let load = |path: &Path| {
        let text = fs::read(path).expect("the file can be read");
        let Ok(text) = String::from_utf8(text) else {
            return Answer { messages: vec!["is no text".to_owned()], ..Answer::default() };
        };
        match impactlab::app::State::restore(&text) {
            Ok((state, sources)) => {
                assert!(state.save().is_ok(), "a state that was read cannot be written");
                Answer::accepted(&(&state.project, &state.view.filter, sources))
            }
            Err(error) => Answer::refused(&error),
        }
    };
    run(&Format {
        name: "state",
        n_inputs: 3_000,
        file_name: "state.json",
        names_file: false,
        seeds: Vec::new(),
        mutate: Mutator::json,
        load: &load,
    });
}
