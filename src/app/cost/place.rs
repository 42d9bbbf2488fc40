//! The forms with work that takes a while.

/// A form with work that takes a while.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, strum::VariantArray)]
pub enum CostPlace {
    /// The training of the force network.
    ForceTraining,
    /// The training of the response network.
    ResponseTraining,
    /// The evaluation of the force network.
    ForceEvaluation,
    /// The comparison of response models.
    Comparison,
    /// The evaluation of the response network.
    ResponseEvaluation,
}
