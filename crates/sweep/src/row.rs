//! The answer of one row.

use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

use serde::Deserialize;
use serde_json::Value;

use crate::SweepError;
use crate::outcome::outcomes;
use crate::pit::{PitInput, PitRow, PitVehicles};
use crate::plan::{PitQuestion, Plan, RequestQuestion, RowInputs, SweptQuestion};
use crate::vary::listed;
use impactlab_core::data::Outcome as Ended;
use impactlab_core::data::write::with_name_for_path;
use impactlab_core::error_chain;
use impactlab_core::uncertainty::{CaveatKind, Caveats};
use impactlab_networks::force::ForceModel;
use impactlab_networks::response::ResponseModel;
use impactlab_study::analysis::{PairRowQuestion, pair_row};
use impactlab_study::{Library, ModelChoice, Request};

/// Longest reason of a row that failed, bytes.
const MAX_REASON_BYTES: usize = 500;

/// A row with its inputs and, if it could be answered, its outcomes.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its number.
    pub index: u64,
    /// Numbers of the inputs.
    pub inputs: Vec<f64>,
    /// The outcomes, or why there are none.
    pub outcomes: Result<Vec<f64>, String>,
    /// The kinds of what restricts the answer of a request, each once, as the answer has them in JSON, with `;`
    /// between them; empty if nothing does.
    pub caveats: String,
}

/// What answers the rows of a plan: networks and vehicles, read once.
pub struct Answerer<'a> {
    plan: &'a Plan,
    kind: Kind<'a>,
}

enum Kind<'a> {
    Pit {
        question: &'a PitQuestion,
        vehicles: PitVehicles,
        force: Arc<ForceModel>,
        response: Arc<ResponseModel>,
    },
    Request {
        question: &'a RequestQuestion,
        library: &'a Library,
    },
}

impl<'a> Answerer<'a> {
    /// # Errors
    /// [`SweepError::Study`] if a network cannot be read.
    pub fn new(plan: &'a Plan, library: &'a Library) -> Result<Self, SweepError> {
        let kind = match &plan.question {
            SweptQuestion::Pit(question) => Kind::Pit {
                question,
                vehicles: PitVehicles::new(question),
                force: library.force_model(&ModelChoice::default())?,
                response: library.response_model(&ModelChoice::default())?,
            },
            SweptQuestion::Request(question) => Kind::Request { question, library },
        };
        Ok(Self { plan, kind })
    }

    /// Answers a row, which follows from (plan, seed, row) alone.
    pub fn row(&self, index: u64) -> Row {
        let inputs = self.plan.inputs(index);
        let answered = match &self.kind {
            Kind::Pit { question, vehicles, force, response } => {
                let outcomes = self.pit((*question, vehicles), &inputs, force, response);
                outcomes.map(|outcomes| (outcomes, String::new()))
            }
            Kind::Request { question, library } => self.asked(question, library, &inputs),
        };
        let inputs = inputs.values.iter().map(|value| value.number).collect();
        let (outcomes, caveats) = match answered {
            Ok((outcomes, caveats)) => (Ok(outcomes), caveats),
            Err(reason) => (Err(shortened(reason)), String::new()),
        };
        Row { index, inputs, outcomes, caveats }
    }

    fn pit(
        &self,
        (question, vehicles): (&PitQuestion, &PitVehicles),
        inputs: &RowInputs,
        force: &ForceModel,
        response: &ResponseModel,
    ) -> Result<Vec<f64>, String> {
        let number = |input: PitInput| {
            let idx = self.plan.vary.iter().position(|vary| vary.name == input.name())?;
            inputs.values.get(idx).map(|value| value.number)
        };
        let row = PitRow::new(question, vehicles, number).ok_or("no such pair of vehicles")?;
        // That of a scenario is stated.
        let is_drawn = number(PitInput::Driver).is_some();
        let row = if is_drawn { row.with_drawn_reaction(inputs.seed) } else { row };
        let asked = PairRowQuestion {
            scenario: &row.scenario,
            vehicles: row.vehicles.each_ref(),
            road_sigma: question.road_sigma,
            limit_s: question.limit_s,
            seed: inputs.seed,
        };
        let drawn = pair_row(&asked, force, response).map_err(|error| error_chain(&error))?;
        Ok(outcomes(&drawn))
    }

    /// Checks that a request reads no files but those whose content the plan knows, and writes none.
    fn check_files_of(&self, request: &Request) -> Result<(), String> {
        if let Some(path) = request.written_path() {
            return Err(format!("the question would write {}", path.display()));
        }
        let is_known = |path: &PathBuf| self.plan.files.iter().any(|file| file.path == *path);
        match request.files_read().iter().find(|path| !is_known(path)) {
            None => Ok(()),
            Some(path) => Err(format!("{}: the plan does not know its content", path.display())),
        }
    }

    /// The outcomes of a request, and the kinds of what restricts its answer.
    fn asked(
        &self,
        question: &RequestQuestion,
        library: &Library,
        inputs: &RowInputs,
    ) -> Result<(Vec<f64>, String), String> {
        // JSON has no infinity: the row would be asked without the value.
        let mut each = self.plan.vary.iter().zip(&inputs.values);
        if let Some((vary, value)) = each.find(|(_, value)| !value.number.is_finite()) {
            return Err(format!("{} is {}, expected a finite number", vary.name, value.number));
        }
        let request = with_inputs(question, self.plan, inputs);
        let request: Request =
            serde_json::from_value(request).map_err(|error| error_chain(&error))?;
        let checked = self.check_files_of(&request);
        let answered = checked.and_then(|()| {
            let answered = request.run(library, &mut |_| ControlFlow::Continue(()));
            answered.map_err(|error| error_chain(&error))
        });
        let answered = answered.map_err(|reason| without_folders(reason, &request))?;
        let Ended::Complete(report) = answered else { return Err("cancelled".to_owned()) };
        let report = serde_json::to_value(&report).map_err(|error| error_chain(&error))?;
        let picked = question.outcomes.iter().map(|outcome| match report.pointer(&outcome.at) {
            Some(Value::Null) => Ok(f64::NAN),
            Some(Value::Bool(holds)) => Ok(f64::from(u8::from(*holds))),
            Some(value) => value.as_f64().ok_or_else(|| format!("{} is no number", outcome.at)),
            None => Err(format!("the answer has no {}", outcome.at)),
        });
        let picked = picked.collect::<Result<Vec<f64>, String>>()?;
        let caveats = caveats_of(&report).map_err(|error| error_chain(&error))?;
        Ok((picked, caveats))
    }
}

/// The kinds of what restricts an answer, each once and in one order, with `;` between them.
fn caveats_of(report: &Value) -> Result<String, serde_json::Error> {
    let caveats = Caveats::deserialize(report)?;
    let kinds: BTreeSet<CaveatKind> =
        caveats.restrictions().into_iter().map(|caveat| caveat.kind).collect();
    let keys: Result<Vec<Value>, serde_json::Error> =
        kinds.into_iter().map(serde_json::to_value).collect();
    let keys = keys?;
    let keys: Vec<&str> = keys.iter().filter_map(Value::as_str).collect();
    Ok(keys.join(";"))
}

/// The request of the first row, and the same with each text that is varied, which may name a file.
///
/// # Errors
/// [`serde_json::Error`] if one of them is no request.
pub(crate) fn sampled_requests(
    question: &RequestQuestion,
    plan: &Plan,
) -> Result<Vec<Request>, serde_json::Error> {
    let first = plan.inputs(0);
    let mut all = vec![first.clone()];
    for (idx, vary) in plan.vary.iter().enumerate() {
        let values = vary.distribution.list().unwrap_or_default();
        for (place, _) in values.iter().enumerate().filter(|(_, value)| value.is_string()) {
            let mut inputs = first.clone();
            if let Some(slot) = inputs.values.get_mut(idx) {
                *slot = listed(values, place);
            }
            all.push(inputs);
        }
    }
    let requests = all.iter().map(|inputs| with_inputs(question, plan, inputs));
    requests.map(serde_json::from_value).collect()
}

/// The request of a row.
pub(crate) fn with_inputs(question: &RequestQuestion, plan: &Plan, inputs: &RowInputs) -> Value {
    let mut request = question.request.clone();
    let mut put = |at: &str, value: Value| {
        if let Some(place) = request.pointer_mut(at) {
            *place = value;
        }
    };
    for (vary, input) in plan.vary.iter().zip(&inputs.values) {
        vary.at.iter().for_each(|at| put(at, input.value.clone()));
    }
    // Numbers of JSON that every program reads whole.
    let seed = inputs.seed >> 11;
    question.seed_at.iter().for_each(|at| put(at, Value::from(seed)));
    request
}

/// A reason with the names of files in place of their paths: a table of rows goes to others.
fn without_folders(reason: String, request: &Request) -> String {
    let mut paths = [request.named_paths(), request.files_read()].concat();
    paths.extend(request.written_path().map(PathBuf::from));
    // The longest first, so that a file is replaced before its folder.
    paths.sort_by_key(|path| Reverse(path.as_os_str().len()));
    paths.iter().fold(reason, |reason, path| match path.file_name() {
        Some(name) if path.is_absolute() => {
            let [path, name] = [path.as_os_str(), name].map(|part| part.to_string_lossy());
            with_name_for_path(&reason, &path, &name)
        }
        _ => reason,
    })
}

/// A reason within its length, in one line.
fn shortened(reason: String) -> String {
    let reason = reason.replace(['\n', '\r'], " ");
    let end = reason.floor_char_boundary(MAX_REASON_BYTES);
    reason.get(..end).unwrap_or_default().to_owned()
}
