//! What goes wrong, as Python is told.

use std::error::Error;

use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use impactlab_core::error_chain;

create_exception!(
    impactlab,
    ImpactlabError,
    PyValueError,
    "A question that has no answer: the line that the command prints behind `error: `."
);

/// The exception with the line that the command prints.
pub(crate) fn refused(error: &dyn Error) -> PyErr {
    ImpactlabError::new_err(error_chain(error))
}
