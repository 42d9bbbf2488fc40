//! A question of Python, and its answer by the same code as that of the command line.

use std::error::Error;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyString};
use serde::Serialize;
use serde_json::{Value, json};

use crate::error::{ImpactlabError, refused};
use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_study::case_file::begin_paths_at;
use impactlab_study::{Library, Question, Request, json_kinds};

/// How often Python is asked whether Ctrl-C was pressed: a person feels nothing of it, and other threads of
/// Python are hardly disturbed.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);

/// Networks that come with the program, once they were read.
static LIBRARY: LazyLock<Library> = LazyLock::new(Library::default);

/// Answers a question, as the command ``impactlab ask`` does.
///
/// request: the question, as ``--print-request`` prints it: a dictionary or JSON text.
/// folder: where paths of the question that begin with ``./`` or ``../`` begin; without it all relative paths
///     begin at the working directory.
///
/// Returns the answer: the keys that ``impactlab schema QUESTION --answer`` lists.
#[pyfunction]
#[pyo3(signature = (request, folder=None))]
pub(crate) fn ask<'py>(
    request: &Bound<'py, PyAny>,
    folder: Option<PathBuf>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = request.py();
    let question = read(request, folder.as_deref(), None)?;
    let report = reading_anew(question.named_paths(), || {
        detached(py, move |go_on| question.run(&LIBRARY, &mut |_| go_on()))
    })?;
    to_python(py, &report)
}

/// The JSON Schemas of every question and its answer: every key with its meaning and unit.
///
/// Returns ``{name: {"meaning": …, "request": …, "answer": …}}``.
#[pyfunction]
pub(crate) fn schema(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for kind in json_kinds() {
        let of_kind =
            json!({ "meaning": kind.meaning, "request": kind.request, "answer": kind.answer });
        all.set_item(kind.name, to_python(py, &of_kind)?)?;
    }
    Ok(all)
}

/// Reads a question of one kind, which need not say that it is of this kind.
///
/// - `name`: of the kind, as `question` says it;
/// - `take`: the question of this kind, `None` of any other.
pub(crate) fn read_kind<Q>(
    request: &Bound<'_, PyAny>,
    folder: Option<&Path>,
    name: &str,
    take: impl FnOnce(Request) -> Option<Box<Q>>,
) -> PyResult<Q> {
    let other = || ImpactlabError::new_err(format!("request: is another question than {name}"));
    take(read(request, folder, Some(name))?).map(|question| *question).ok_or_else(other)
}

/// Answers a question of one kind.
pub(crate) fn answer<Q>(py: Python<'_>, question: Q) -> PyResult<Q::Answer>
where
    Q: Question + Into<Request>,
{
    let request: Request = question.clone().into();
    reading_anew(request.named_paths(), || {
        detached(py, move |go_on| question.answer(&LIBRARY, &mut |_| go_on()))
    })
}

/// Reads a question.
///
/// - `name`: which question it is where it does not say so.
fn read(
    request: &Bound<'_, PyAny>,
    folder: Option<&Path>,
    name: Option<&str>,
) -> PyResult<Request> {
    let text = text_of(request)?;
    let text = match name {
        Some(name) => of_kind(name, &text),
        None => text,
    };
    let folder = folder.map(absolute).transpose()?;
    // Read as it is, too: of a key that stands twice a value has the last one alone.
    let parsed = serde_json::from_str::<Request>(&text).and_then(|question| match &folder {
        None => Ok(question),
        Some(folder) => {
            let mut value: Value = serde_json::from_str(&text)?;
            begin_paths_at(&mut value, folder);
            serde_json::from_value(value)
        }
    });
    parsed.map_err(|error| {
        ImpactlabError::new_err(format!("request: is no request: {}", error_chain(&error)))
    })
}

/// JSON of a question that says of which kind it is; as it is where it says so already, or is no object.
fn of_kind(name: &str, text: &str) -> String {
    let value: Value = serde_json::from_str(text).unwrap_or_default();
    let fields = value.as_object().filter(|fields| !fields.contains_key("question"));
    match fields.zip(text.trim_start().strip_prefix('{')) {
        Some((fields, rest)) => {
            let comma = if fields.is_empty() { "" } else { "," };
            format!("{{\"question\":\"{name}\"{comma}{rest}")
        }
        None => text.to_owned(),
    }
}

/// A folder from the root on, in text that JSON can hold.
fn absolute(folder: &Path) -> PyResult<PathBuf> {
    let absolute = std::path::absolute(folder).map_err(|error| refused(&error))?;
    match absolute.to_str() {
        Some(_) => Ok(absolute),
        None => {
            let name = folder.display();
            Err(ImpactlabError::new_err(format!("{name}: the name of the folder is no text")))
        }
    }
}

/// JSON of a question: as it is, or of objects of Python.
fn text_of(request: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(text) = request.cast::<PyString>() {
        return text.extract();
    }
    let py = request.py();
    let settings = PyDict::new(py);
    settings.set_item("allow_nan", false)?;
    settings.set_item("default", wrap_pyfunction!(plain, py)?)?;
    py.import("json")?.call_method("dumps", (request,), Some(&settings))?.extract()
}

/// What JSON has no type for: a number or an array of numpy, a mapping that is no dictionary, or a path.
#[pyfunction]
fn plain<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    if value.hasattr("tolist")? {
        return value.call_method0("tolist");
    }
    if value.is_instance_of::<PyMapping>() {
        return py.get_type::<PyDict>().call1((value,));
    }
    // A path of bytes, which JSON has no type for either, is text after that.
    py.import("os")?.call_method1("fsdecode", (value,))
}

/// What is written to JSON, in objects of Python.
pub(crate) fn to_python<'py>(
    py: Python<'py>,
    value: &impl Serialize,
) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| refused(&error))?;
    py.import("json")?.call_method1("loads", (text,))
}

/// Keeps nothing of files in memory: they may have changed when the next question is asked.
fn reading_anew<T>(files: Vec<PathBuf>, answer: impl FnOnce() -> T) -> T {
    let forget = || files.iter().for_each(|path| LIBRARY.forget(path));
    forget();
    let answer = answer();
    forget();
    answer
}

/// Works while other threads of Python go on. Ctrl-C ends the work and raises what Python raises then.
///
/// - `work`: is given what says whether to go on.
pub(crate) fn detached<T: Send, E: Error + Send>(
    py: Python<'_>,
    work: impl FnOnce(&mut dyn FnMut() -> ControlFlow<()>) -> Result<Outcome<T>, E> + Send,
) -> PyResult<T> {
    let mut signals = Signals { asked: Instant::now(), raised: None };
    let outcome = py.detach(|| work(&mut || signals.go_on()));
    if let Some(raised) = signals.raised {
        return Err(raised);
    }
    let outcome = outcome.map_err(|error| refused(&error))?;
    outcome.complete().ok_or_else(|| ImpactlabError::new_err("cancelled"))
}

/// Whether a signal, such as that of Ctrl-C, has come in during the work.
struct Signals {
    asked: Instant,
    raised: Option<PyErr>,
}

impl Signals {
    fn go_on(&mut self) -> ControlFlow<()> {
        if self.raised.is_none() && self.asked.elapsed() >= SIGNAL_INTERVAL {
            self.asked = Instant::now();
            self.raised = Python::attach(|py| py.check_signals()).err();
        }
        match self.raised {
            Some(_) => ControlFlow::Break(()),
            None => ControlFlow::Continue(()),
        }
    }
}
