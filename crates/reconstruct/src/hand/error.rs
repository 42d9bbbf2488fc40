//! Why a method by hand gives nothing.

use impactlab_core::ranges::OutOfRange;

/// Inputs from which a method gives nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HandError {
    /// An input that the method does not know.
    #[error("{key:?} is no input of the method {method}; it takes {known}")]
    Unknown {
        /// The method.
        method: String,
        /// The input.
        key: String,
        /// Those that it knows.
        known: String,
    },
    /// An input is missing.
    #[error("the method {method} needs {missing}; it takes {known}")]
    Missing {
        /// The method.
        method: String,
        /// What is missing.
        missing: String,
        /// Its inputs.
        known: String,
    },
    /// A number is out of range.
    #[error("{key}")]
    OutOfRange {
        /// The input.
        key: String,
        /// The number and its range.
        source: OutOfRange,
    },
    /// Points for a method that takes none, or too many.
    #[error("{n} points, expected {expected}")]
    Points {
        /// Number of points.
        n: usize,
        /// What is expected.
        expected: &'static str,
    },
    /// Inputs that do not go together.
    #[error("{method}: {why}")]
    Refused {
        /// The method.
        method: String,
        /// Why.
        why: &'static str,
    },
    /// An input that has no meaning without another one.
    #[error("{method}: {key} has no meaning without {needs}; give both, or leave it out")]
    Alone {
        /// The method.
        method: String,
        /// The input.
        key: String,
        /// The other one.
        needs: String,
    },
    /// Nothing follows from the inputs, or from too much of what they may be.
    #[error(
        "{method}: nothing follows from these numbers in {share:.0} % of the draws; they do not go together, or \
         their standard deviations are too large"
    )]
    Unsolved {
        /// The method.
        method: String,
        /// Share of the draws without an answer, per cent.
        share: f64,
    },
}
