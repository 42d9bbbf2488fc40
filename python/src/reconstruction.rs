//! A reconstruction as arrays.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::columns::named;
use crate::question::{answer, read_kind, to_python};
use impactlab_study::Request;

/// The speeds before a collision as a distribution.
#[pyclass(frozen, get_all, module = "impactlab")]
pub(crate) struct Reconstruction {
    /// What ``ask`` answers.
    report: Py<PyAny>,
    /// The particles, with one number of each array for each: the columns of ``particles.csv``, such as
    /// ``target_speed_m_s``. All are equally likely.
    particles: Py<PyDict>,
}

/// Reconstructs the speeds before a collision, as the command ``impactlab reconstruct`` does.
///
/// request: a question ``reconstruct``, as for ``ask``; it need not say ``"question"``.
/// folder: as for ``ask``.
#[pyfunction]
#[pyo3(signature = (request, folder=None))]
pub(crate) fn reconstruct(
    request: &Bound<'_, PyAny>,
    folder: Option<PathBuf>,
) -> PyResult<Reconstruction> {
    let py = request.py();
    let name = "reconstruct";
    let question = read_kind(request, folder.as_deref(), name, |request| match request {
        Request::Reconstruct(question) => Some(question),
        _ => None,
    })?;
    let answer = answer(py, question)?;
    Ok(Reconstruction {
        report: to_python(py, &answer.report)?.unbind(),
        particles: named(py, answer.particle_columns())?,
    })
}
