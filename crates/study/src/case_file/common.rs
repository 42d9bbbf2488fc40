//! A variant as its file has it: what several of its questions have in common stands once.
//!
//! ```json
//! "common": {
//!   "motion": {"source": {"scenario": {"scenario": "common", …}}, "vehicle": …, "duration_s": …},
//!   "scenario": {"inline": {…}}
//! },
//! "questions": [
//!   {"question": "impact", "scenario": "common", …},
//!   {"question": "simulate", "seed": 0, "vehicle_draws": 100},
//!   {"question": "predict_motion", "motion": {"seed": 0, "vehicle_draws": 30}, …}
//! ]
//! ```
//!
//! - A scenario of several questions is `common.scenario`; where a question has it, stands `"common"`.
//! - What `simulate` and `predict_motion` have in common of the motion is `common.motion`; what a question
//!   says itself comes before it.
//!
//! In memory each question is whole, so that nothing but this file knows of it.

use schemars::JsonSchema;
use serde::ser::Error;
use serde::{Deserialize, Serialize, Serializer};
use serde_json::{Map, Value};

use crate::Request;
use crate::case_file::Variant;

/// What stands in a question for the scenario that it has in common with others.
const COMMON: &str = "common";

/// Where a question can have a scenario.
const SCENARIOS: [&str; 4] = [
    "/scenario",
    "/source/scenario/scenario",
    "/collision/scenario",
    "/motion/source/scenario/scenario",
];

/// What each question about a motion says for itself: its kind, and how its answer is drawn.
const OWN: [&str; 3] = ["question", "vehicle_draws", "seed"];

/// A variant as its file has it.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct VariantText {
    /// What it is called.
    name: String,
    /// What the analyst wrote about it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    notes: String,
    /// What several questions have in common.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    common: Map<String, Value>,
    /// What is asked of it.
    #[serde(default)]
    questions: Vec<QuestionText>,
    /// Questions that are filled in and not asked.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    unasked: Vec<QuestionText>,
    /// How the window draws it.
    #[serde(default, skip_serializing_if = "Value::is_null")]
    view: Value,
    /// How the forms of the window were filled in, in files of version 1.
    #[serde(default, skip_serializing_if = "Value::is_null")]
    forms: Value,
}

/// A question as the file has it, its kind first.
#[derive(Serialize, Deserialize, JsonSchema)]
struct QuestionText {
    /// Which question it is; its other keys are those of `impactlab schema` with this name.
    question: String,
    #[serde(flatten)]
    fields: Map<String, Value>,
}

impl Serialize for Variant {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        VariantText::from_variant(self).map_err(S::Error::custom)?.serialize(serializer)
    }
}

impl VariantText {
    /// # Errors
    /// The name of a file is not Unicode, which JSON cannot hold.
    fn from_variant(variant: &Variant) -> Result<Self, serde_json::Error> {
        let Variant { name, notes, questions, unasked, view, forms } = variant.clone();
        let n_questions = questions.len();
        let questions = questions.iter().chain(&unasked).map(serde_json::to_value::<&Request>);
        let mut questions = questions.collect::<Result<Vec<Value>, _>>()?;
        let common = take_common(&mut questions);
        let mut questions: Vec<QuestionText> =
            questions.into_iter().map(QuestionText::from_value).collect();
        let unasked = questions.split_off(n_questions);
        Ok(Self { name, notes, common, questions, unasked, view, forms })
    }
}

impl TryFrom<VariantText> for Variant {
    type Error = String;

    fn try_from(text: VariantText) -> Result<Self, String> {
        let VariantText { name, notes, common, questions, unasked, view, forms } = text;
        let whole = |questions: Vec<QuestionText>, list: &str| -> Result<Vec<Request>, String> {
            let number = |(i, question): (usize, QuestionText)| {
                let request = serde_json::from_value(question.with_common(&common));
                request.map_err(|error| format!("{list}[{i}] of variant {name:?}: {error}"))
            };
            questions.into_iter().enumerate().map(number).collect()
        };
        let (questions, unasked) = (whole(questions, "questions")?, whole(unasked, "unasked")?);
        Ok(Self { name, notes, questions, unasked, view, forms })
    }
}

impl QuestionText {
    fn from_value(value: Value) -> Self {
        let mut fields = match value {
            Value::Object(fields) => fields,
            _ => Map::new(),
        };
        let question = match fields.remove("question") {
            Some(Value::String(question)) => question,
            _ => String::new(),
        };
        Self { question, fields }
    }

    /// The whole question.
    fn with_common(self, common: &Map<String, Value>) -> Value {
        let Self { question, mut fields } = self;
        if question == "predict_motion" && common.contains_key("motion") {
            fields.entry("motion").or_insert_with(|| Value::Object(Map::new()));
        }
        fields.insert("question".to_owned(), Value::String(question));
        let mut whole = Value::Object(fields);
        if let (Some(motion), Some(Value::Object(shared))) =
            (motion_mut(&mut whole), common.get("motion"))
        {
            for (key, value) in shared {
                motion.entry(key.as_str()).or_insert_with(|| value.clone());
            }
        }
        if let Some(scenario) = common.get("scenario") {
            replace_scenario(&mut whole, &Value::String(COMMON.to_owned()), scenario);
        }
        whole
    }
}

/// Takes out of questions what they have in common.
fn take_common(questions: &mut [Value]) -> Map<String, Value> {
    let mut common = Map::new();
    let scenarios: Vec<Value> = questions.iter().flat_map(scenarios).cloned().collect();
    let is_shared =
        |scenario: &&Value| scenarios.iter().filter(|other| other == scenario).count() > 1;
    if let Some(scenario) = scenarios.iter().find(is_shared) {
        let place = Value::String(COMMON.to_owned());
        questions.iter_mut().for_each(|question| replace_scenario(question, scenario, &place));
        common.insert("scenario".to_owned(), scenario.clone());
    }
    let mut motions: Vec<&mut Map<String, Value>> =
        questions.iter_mut().filter_map(motion_mut).collect();
    if let [first, others @ ..] = &motions[..]
        && !others.is_empty()
    {
        let is_shared = |(key, value): &(&String, &Value)| {
            let is_alike = others.iter().all(|other| other.get(*key) == Some(*value));
            is_alike && !OWN.contains(&key.as_str())
        };
        let shared: Map<String, Value> = first
            .iter()
            .filter(is_shared)
            .map(|(key, value)| (key.clone(), value.clone()))
            .collect();
        motions.iter_mut().for_each(|motion| motion.retain(|key, _| !shared.contains_key(key)));
        common.insert("motion".to_owned(), Value::Object(shared));
    }
    common
}

fn scenarios(question: &Value) -> impl Iterator<Item = &Value> {
    SCENARIOS.iter().filter_map(|place| question.pointer(place))
}

fn replace_scenario(question: &mut Value, from: &Value, to: &Value) {
    for place in SCENARIOS {
        if let Some(scenario) = question.pointer_mut(place).filter(|scenario| *scenario == from) {
            *scenario = to.clone();
        }
    }
}

/// The settings of the motion in a question about one.
fn motion_mut(question: &mut Value) -> Option<&mut Map<String, Value>> {
    match question.get("question").and_then(Value::as_str) {
        Some("simulate") => question.as_object_mut(),
        Some("predict_motion") => question.get_mut("motion")?.as_object_mut(),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ForceSource, ImpactRequest, MotionSource, PredictMotionRequest, ScenarioChoice,
        SimulateRequest,
    };
    use impactlab_core::collision::Scenario;

    /// A variant with the questions of a scenario.
    fn variant(duration_s: [f64; 2]) -> Variant {
        let scenario = ScenarioChoice::Inline(Box::new(Scenario::example()));
        let source =
            MotionSource::Scenario { scenario: scenario.clone(), pulse: Default::default() };
        let simulate =
            SimulateRequest { duration_s: duration_s[0], ..SimulateRequest::new(source.clone()) };
        let mut predict = PredictMotionRequest::new(source, ForceSource::Given);
        predict.motion.duration_s = duration_s[1];
        let impact = ImpactRequest::new(scenario);
        let questions = vec![impact.into(), simulate.into(), predict.into()];
        Variant { name: "base".to_owned(), questions, ..Variant::default() }
    }

    #[test]
    fn what_questions_have_in_common_stands_once_and_comes_back() {
        for duration_s in [[4.0, 4.0], [4.0, 3.0]] {
            let variant = variant(duration_s);
            let text = serde_json::to_string_pretty(&variant).unwrap();
            assert_eq!(text.matches("\"restitution\"").count(), 1, "{text}");
            assert_eq!(text.matches("\"equations\"").count(), 1, "{text}");
            let is_alike = duration_s[0] == duration_s[1];
            let n_durations = if is_alike { 1 } else { 2 };
            // The pulse has a duration, too.
            assert_eq!(text.matches("\"duration_s\"").count(), n_durations + 1, "{text}");
            assert_eq!(serde_json::from_str::<Variant>(&text).unwrap(), variant);
        }
    }

    #[test]
    fn what_is_changed_once_in_the_file_is_changed_in_every_question() {
        let text = serde_json::to_string_pretty(&variant([4.0, 4.0])).unwrap();
        let edited = text.replace("\"restitution\": 0.15", "\"restitution\": 0.35");
        assert_ne!(text, edited);
        let edited: Variant = serde_json::from_str(&edited).unwrap();
        let whole = serde_json::to_string(&edited.questions).unwrap();
        assert_eq!(whole.matches("\"restitution\":0.35").count(), 3, "{whole}");
    }

    /// A file that was written before variants had notes has none, and one without notes says nothing.
    #[test]
    fn notes_stand_in_the_file_where_there_are_any() {
        let without = variant([4.0, 4.0]);
        let file = serde_json::to_value(&without).unwrap();
        assert_eq!(file.get("notes"), None);
        assert_eq!(serde_json::from_value::<Variant>(file).unwrap().notes, "");
        let with = Variant { notes: "wet\nroad".to_owned(), ..without };
        let text = serde_json::to_string(&with).unwrap();
        assert_eq!(serde_json::from_str::<Variant>(&text).unwrap(), with);
    }

    #[test]
    fn a_question_that_is_wrong_is_named() {
        let mut text = serde_json::to_value(variant([4.0, 4.0])).unwrap();
        text["common"]["motion"]["duration_s"] = "long".into();
        let error = serde_json::from_value::<Variant>(text.clone()).unwrap_err().to_string();
        assert!(error.contains("questions[1] of variant \"base\""), "{error}");
        text.as_object_mut().unwrap().remove("common");
        let error = serde_json::from_value::<Variant>(text).unwrap_err().to_string();
        assert!(error.contains("questions[0] of variant \"base\""), "{error}");
    }
}
