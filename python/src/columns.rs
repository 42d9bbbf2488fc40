//! Columns of numbers as arrays of numpy, into which they are moved.

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::refused;
use impactlab_core::collision::Pose;
use impactlab_core::data::{Channel, TimeSeries};
use impactlab_networks::response::STEP_S;

/// The arrays by their names, in the order of the columns.
pub(crate) fn named<N: AsRef<str>>(
    py: Python<'_>,
    columns: impl IntoIterator<Item = (N, Vec<f64>)>,
) -> PyResult<Py<PyDict>> {
    let arrays = PyDict::new(py);
    for (name, values) in columns {
        arrays.set_item(name.as_ref(), values.into_pyarray(py))?;
    }
    Ok(arrays.unbind())
}

/// A time series under the headers of the program's own files.
pub(crate) fn of_series(py: Python<'_>, series: TimeSeries) -> PyResult<Py<PyDict>> {
    named(py, series.into_columns().map(|(channel, values)| (channel.header(), values)))
}

/// Paths side by side: the time from first contact, then X, Y and yaw, each `[n_paths, n_instants]`. A path
/// that ends before the longest one goes on as NaN.
pub(crate) fn of_paths<'py>(py: Python<'py>, paths: &[Vec<Pose>]) -> PyResult<Py<PyDict>> {
    let n_instants = paths.iter().map(Vec::len).max().unwrap_or(0);
    let table = |quantity: fn(&Pose) -> f64| -> PyResult<Bound<'py, PyArray2<f64>>> {
        let of_path = |path: &Vec<Pose>| -> Vec<f64> {
            let missing = std::iter::repeat(f64::NAN);
            path.iter().map(quantity).chain(missing).take(n_instants).collect()
        };
        let values: Vec<f64> = paths.iter().flat_map(of_path).collect();
        let rows = Array2::from_shape_vec((paths.len(), n_instants), values);
        Ok(rows.map_err(|error| refused(&error))?.into_pyarray(py))
    };
    let time_s: Vec<f64> = (0..n_instants).map(|at| at as f64 * STEP_S).collect();
    let arrays = PyDict::new(py);
    arrays.set_item(Channel::Time.header(), time_s.into_pyarray(py))?;
    arrays.set_item(Channel::X.header(), table(|pose| pose.x_m)?)?;
    arrays.set_item(Channel::Y.header(), table(|pose| pose.y_m)?)?;
    arrays.set_item(Channel::Yaw.header(), table(|pose| pose.yaw_rad)?)?;
    Ok(arrays.unbind())
}
