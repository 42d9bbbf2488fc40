//! The distribution of a motion as arrays.

use std::path::PathBuf;

use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::columns::{named, of_paths};
use crate::question::{answer, read_kind, to_python};
use impactlab_core::vehicle::VehicleState;
use impactlab_networks::response::MotionDistribution;
use impactlab_study::analysis::{MotionBands, motion_columns};
use impactlab_study::{PredictMotionAnswer, Request};

/// A motion as a distribution.
///
/// Bands have the columns of ``trajectory.csv``: ``time_s`` and, of X, Y, yaw, v_x, v_y and yaw rate, the
/// central path, mean, standard deviation and the edges of the 90 and 50 % bands, such as ``x_m_low_90``. NaN
/// is what is not known, after a contact that is not computed.
/// Paths have ``time_s`` and, for each draw in a row, ``x_m``, ``y_m`` and ``yaw_rad``.
#[pyclass(frozen, get_all, module = "impactlab")]
pub(crate) struct Forecast {
    /// What ``ask`` answers.
    report: Py<PyAny>,
    /// Bands of the struck vehicle over time.
    bands: Py<PyDict>,
    /// Its path in each draw; of a car that is followed by itself the central path under each force, or of each
    /// vehicle where these are more.
    paths: Py<PyDict>,
    /// Bands of the striking vehicle; None where it is not followed.
    striking_bands: Option<Py<PyDict>>,
    /// Its path in each draw, in the same order; None likewise.
    striking_paths: Option<Py<PyDict>>,
}

/// Predicts the motion after an impact, as the command ``impactlab predict`` does.
///
/// request: a question ``predict_motion``, as for ``ask``; it need not say ``"question"``.
/// folder: as for ``ask``.
#[pyfunction]
#[pyo3(signature = (request, folder=None))]
pub(crate) fn predict(request: &Bound<'_, PyAny>, folder: Option<PathBuf>) -> PyResult<Forecast> {
    let py = request.py();
    let name = "predict_motion";
    let question = read_kind(request, folder.as_deref(), name, |request| match request {
        Request::PredictMotion(question) => Some(question),
        _ => None,
    })?;
    let PredictMotionAnswer { report, forecast, .. } = answer(py, question)?;
    let known_s = report.known_until_s();
    let (bands, of_striking) = py.detach(|| {
        let of_striking = forecast
            .both
            .as_ref()
            .map(|both| columns(&both.striking, &both.striking_central, f64::INFINITY));
        (columns(&forecast.distribution, &forecast.central, known_s), of_striking)
    });
    let striking_paths = forecast.both.as_ref().map(|both| of_paths(py, &both.striking_paths));
    Ok(Forecast {
        report: to_python(py, &report)?.unbind(),
        bands: named(py, bands)?,
        paths: of_paths(py, &forecast.paths)?,
        striking_bands: of_striking.map(|bands| named(py, bands)).transpose()?,
        striking_paths: striking_paths.transpose()?,
    })
}

fn columns(
    distribution: &MotionDistribution,
    central: &[VehicleState<f64>],
    known_s: f64,
) -> Vec<(String, Vec<f64>)> {
    motion_columns(distribution, central, &MotionBands::new(distribution, 1), known_s)
}
