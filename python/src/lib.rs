//! The Python package: the questions of the command line, with numbers over time as arrays of numpy.
//!
//! A question is JSON as for `impactlab ask`, in objects of Python. What it leaves open is decided by
//! [`study`](impactlab_study), not here, and the answer is the same to the last bit. While the program
//! computes, the interpreter is free for other threads.

mod columns;
mod error;
mod forecast;
mod motion;
mod question;
mod reconstruction;
mod sweep;

use pyo3::prelude::*;

/// Version of the program of the same source.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "+", env!("IMPACTLAB_SOURCE"));

/// The compiled part of the package `impactlab`.
#[pymodule]
mod _impactlab {
    use super::{Bound, PyModule, PyModuleMethods, PyResult, VERSION};

    #[pymodule_export]
    use super::error::ImpactlabError;
    #[pymodule_export]
    use super::forecast::{Forecast, predict};
    #[pymodule_export]
    use super::motion::{Motion, simulate};
    #[pymodule_export]
    use super::question::{ask, schema};
    #[pymodule_export]
    use super::reconstruction::{Reconstruction, reconstruct};
    #[pymodule_export]
    use super::sweep::{plan_sweep, run_chunk};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        impactlab_core::program::set_version(VERSION);
        module.add("__version__", VERSION)
    }
}
