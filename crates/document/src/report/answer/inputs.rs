//! What a question says, as rows of the table of inputs.

use std::path::PathBuf;

use serde_json::Value;

use crate::report::InputClass;
use crate::report::answer::Context;
use crate::report::flatten::{FlatRow, flatten};
use crate::report::method::Method;
use crate::report::numbers::Wording;
use crate::report::parts::{InputRow, Part};
use crate::report::paths::ShownPaths;
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};
use impactlab_study::{
    HandRequest, ImpactRequest, PredictForceRequest, PredictMotionRequest, ReconstructRequest,
    ReplayRequest, Request, ScenarioChoice, SimulateRequest,
};

/// What a question is about; everything else in it is a setting.
const SUBJECTS: [&str; 6] = ["scenario", "source", "collision", "force", "evidence", "recorder"];

/// What a value is in; what stands in the question itself belongs to that.
fn group_or(group: String, kind: &str) -> String {
    if group.is_empty() { kind.to_owned() } else { group }
}

/// The settings of a question about the same where nobody changed one; null for a question that asks for
/// no answer of a report.
fn default_settings(request: &Request) -> Value {
    let settings = match request {
        Request::Impact(asked) => serde_json::to_value(ImpactRequest::new(asked.scenario.clone())),
        Request::Hand(asked) => serde_json::to_value(HandRequest::new(asked.method)),
        Request::Replay(asked) => serde_json::to_value(ReplayRequest::new(asked.recorder.clone())),
        Request::Simulate(asked) => {
            serde_json::to_value(SimulateRequest::new(asked.source.clone()))
        }
        Request::PredictForce(asked) => {
            serde_json::to_value(PredictForceRequest::new(asked.collision.clone()))
        }
        Request::PredictMotion(asked) => {
            let (source, force) = (asked.motion.source.clone(), asked.force.clone());
            serde_json::to_value(PredictMotionRequest::new(source, force))
        }
        Request::Reconstruct(asked) => {
            serde_json::to_value(ReconstructRequest::new(asked.evidence.clone()))
        }
        _ => return Value::Null,
    };
    settings.unwrap_or_default()
}

/// Whether a row says what the question is about.
fn is_subject(row: &FlatRow) -> bool {
    row.path.iter().chain([&row.key]).any(|name| SUBJECTS.contains(&name.as_str()))
}

/// What a question says, and the settings that it leaves as the program has them.
///
/// - `kind`: what kind of question it is.
pub(in crate::report) fn given_rows(
    request: &Request,
    kind: &str,
    wording: &Wording,
    paths: &ShownPaths,
) -> Vec<InputRow> {
    let words = wording.words;
    let mut question = serde_json::to_value(request).unwrap_or_default();
    if let Value::Object(fields) = &mut question {
        fields.remove("question");
        // What was found is told with its uncertainty.
        if let Some(Value::Object(evidence)) = fields.get_mut("evidence") {
            evidence.remove("inline");
        }
        // What a method by hand takes is told with its labels.
        if matches!(request, Request::Hand(_)) {
            for told in ["method", "inputs", "points_m"] {
                fields.remove(told);
            }
        }
    }
    tell_files(&mut question);
    tell_speeds(&mut question);
    let defaults = flatten(&default_settings(request), wording, paths);
    let given = |row: FlatRow| {
        let is_file = ["file", "path", "dataset", "recorder"].contains(&row.key.as_str());
        let (class, source) = match !is_subject(&row) && defaults.contains(&row) {
            true => (InputClass::Assumed, words.source_program),
            false if is_file => (InputClass::Given, words.source_file),
            false => (InputClass::Given, words.source_question),
        };
        InputRow {
            group: group_or(row.group(wording), kind),
            label: wording.key(&row.key),
            value: row.value,
            class,
            source: source.to_owned(),
        }
    };
    flatten(&question, wording, paths).into_iter().map(given).collect()
}

/// Puts what a scenario file says beside its name: speeds, masses, contact and drivers are inputs, wherever they
/// stand. A file that cannot be read any more keeps its name alone.
fn tell_files(value: &mut Value) {
    let Value::Object(fields) = value else { return };
    for (name, inner) in fields.iter_mut() {
        let file = inner.get("file").and_then(Value::as_str).map(PathBuf::from);
        match (name == "scenario").then_some(file).flatten() {
            Some(path) => {
                let said = ScenarioChoice::File(path).load().ok();
                let said = said.and_then(|scenario| serde_json::to_value(scenario).ok());
                if let (Value::Object(choice), Some(Value::Object(mut said))) = (inner, said) {
                    // What is left empty there is not said.
                    said.retain(|_, value| value.as_str() != Some(""));
                    choice.insert("inline".to_owned(), Value::Object(said));
                }
            }
            None => tell_files(inner),
        }
    }
}

/// Puts speed and course, as people say them, in the place of the components of each velocity.
fn tell_speeds(value: &mut Value) {
    match value {
        Value::Object(fields) => {
            let component = |key: &str| fields.get(key).and_then(Value::as_f64);
            if let (Some(vx_m_s), Some(vy_m_s)) = (component("vx_m_s"), component("vy_m_s")) {
                fields.remove("vx_m_s");
                fields.remove("vy_m_s");
                fields.insert("speed_m_s".to_owned(), vx_m_s.hypot(vy_m_s).into());
                fields.insert("course_rad".to_owned(), vy_m_s.atan2(vx_m_s).into());
            }
            fields.values_mut().for_each(tell_speeds);
        }
        Value::Array(items) => items.iter_mut().for_each(tell_speeds),
        _ => {}
    }
}

/// Leaves out the settings of a collision that nobody changed, and names the one car.
fn of_single_car(rows: &mut Vec<InputRow>, wording: &Wording) {
    let foreign = ["striking", "one_contact"].map(|key| wording.key(key));
    rows.retain(|row| row.class != InputClass::Assumed || !foreign.contains(&row.label));
    let struck = wording.key("vehicle");
    for row in rows.iter_mut().filter(|row| row.label == struck) {
        row.label = wording.term("car");
    }
}

/// Adds what the question says, in front of what the answer found out.
pub(super) fn with_request(mut part: Part, request: &Request, context: Context<'_>) -> Part {
    let Context { wording, paths, .. } = context;
    let label = |assumption: &Caveat| match assumption.subject {
        Some(subject) => subject.label_in(wording.language),
        None => assumption.kind.label_in(wording.language),
    };
    // What a data sheet leaves open stands among the inputs already, with the rule and its interval.
    let has_estimates = part.inputs.iter().any(|row| row.class == InputClass::Estimated);
    let is_told_once = |assumption: &&Caveat| {
        !has_estimates || assumption.subject != Some(CaveatSubject::VehicleParameter)
    };
    let assumed = part.caveats.assumptions().filter(is_told_once).map(|assumption| {
        // What several answers assume alike is listed once. What is not used was given, and not assumed.
        let (group, class) = match assumption.kind {
            CaveatKind::NotUsed => (wording.words.inputs_not_used, InputClass::Given),
            _ => (wording.words.inputs_assumed, InputClass::Assumed),
        };
        InputRow {
            group: group.to_owned(),
            label: label(assumption).to_owned(),
            value: wording.caveat_text(assumption),
            class,
            source: wording.caveat_reason(assumption),
        }
    });
    let mut rows = given_rows(request, &part.kind, wording, paths);
    if part.methods.contains(&Method::SingleCar) {
        of_single_car(&mut rows, wording);
    }
    rows.append(&mut part.inputs);
    rows.extend(assumed);
    Part { inputs: rows, ..part }
}
