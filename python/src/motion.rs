//! The motion of one vehicle as arrays.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::columns::of_series;
use crate::error::refused;
use crate::question::{answer, read_kind, to_python};
use impactlab_study::{Request, SimulateAnswer};

/// A motion by the 4DOF model. Its arrays have the names of the columns of the program's own files, which end
/// in the SI unit: ``time_s``, ``x_m``, ``yaw_rate_rad_s``.
#[pyclass(frozen, get_all, module = "impactlab")]
pub(crate) struct Motion {
    /// What ``ask`` answers.
    report: Py<PyAny>,
    /// The struck vehicle; empty where it could not be simulated, for the reason that a note of the report
    /// gives.
    columns: Py<PyDict>,
    /// The striking vehicle; None where it is not simulated.
    striking: Option<Py<PyDict>>,
    /// The motion that was recorded; None where nothing was.
    recorded: Option<Py<PyDict>>,
}

/// Simulates the motion of a struck vehicle, as the command ``impactlab simulate`` does.
///
/// request: a question ``simulate``, as for ``ask``; it need not say ``"question"``.
/// folder: as for ``ask``.
#[pyfunction]
#[pyo3(signature = (request, folder=None))]
pub(crate) fn simulate(request: &Bound<'_, PyAny>, folder: Option<PathBuf>) -> PyResult<Motion> {
    let py = request.py();
    let question = read_kind(request, folder.as_deref(), "simulate", |request| match request {
        Request::Simulate(question) => Some(question),
        _ => None,
    })?;
    let SimulateAnswer { report, analysis } = answer(py, question)?;
    let simulated = analysis.written_motion().map_err(|error| refused(&error))?;
    let striking = analysis.striking.map(|track| track.written_motion()).transpose();
    let striking = striking.map_err(|error| refused(&error))?;
    Ok(Motion {
        report: to_python(py, &report)?.unbind(),
        columns: simulated.map_or_else(|| Ok(PyDict::new(py).unbind()), |of| of_series(py, of))?,
        striking: striking.map(|series| of_series(py, series)).transpose()?,
        recorded: analysis.reference.map(|series| of_series(py, series)).transpose()?,
    })
}
