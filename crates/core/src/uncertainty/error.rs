//! Errors of invalid mixtures of distributions.

/// Reason for which numbers do not define a mixture, or for which a mixture cannot answer a
/// question.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MixtureError {
    /// The mixture has no components.
    #[error("a mixture of no components")]
    Empty,
    /// A weight is negative or not finite.
    #[error("weight of component {component} is {weight}, expected 0 or more")]
    Weight {
        /// Index of the component, from 0.
        component: usize,
        /// Weight of the component.
        weight: f64,
    },
    /// All weights are zero.
    #[error("the weights sum to zero")]
    NoWeight,
    /// The mean, the factors, the variances or a curve do not have the number of values that the
    /// mixture requires.
    #[error("component {component}: {what} has {got} values, expected {expected}")]
    Shape {
        /// Index of the component, from 0.
        component: usize,
        /// Name of the quantity that has the wrong length.
        what: &'static str,
        /// Number of values required.
        expected: usize,
        /// Number of values found.
        got: usize,
    },
    /// A variance is not a positive finite number.
    #[error(
        "component {component}: variance of value {value_idx} is {variance}, expected more than 0"
    )]
    Variance {
        /// Index of the component, from 0.
        component: usize,
        /// Index of the value within the row.
        value_idx: usize,
        /// Variance of the value.
        variance: f64,
    },
    /// The correlation of neighbouring instants is outside `0 ≤ φ < 1`.
    #[error("component {component}: correlation of neighbours is {value}, expected 0 to below 1")]
    LagCorrelation {
        /// Index of the component, from 0.
        component: usize,
        /// Correlation of the component.
        value: f64,
    },
    /// A mean or a factor is not finite.
    #[error("component {component}: {what} holds a number that is not finite")]
    NotFinite {
        /// Index of the component, from 0.
        component: usize,
        /// Name of the field that holds the value.
        what: &'static str,
    },
    /// The level of a band is not strictly between 0 and 1.
    #[error("level of a band is {level}, expected between 0 and 1")]
    Level {
        /// Level that was asked for.
        level: f64,
    },
}

impl MixtureError {
    /// Checks weights and returns their sum.
    ///
    /// # Errors
    /// [`MixtureError::Weight`] for a weight that is negative or not finite,
    /// [`MixtureError::Empty`] without weights, [`MixtureError::NoWeight`] if they sum to zero.
    pub(crate) fn check_weights(weights: &[f64]) -> Result<f64, Self> {
        for (component, &weight) in weights.iter().enumerate() {
            if !(weight >= 0.0 && weight.is_finite()) {
                return Err(Self::Weight { component, weight });
            }
        }
        let sum: f64 = weights.iter().sum();
        match (weights.is_empty(), sum > 0.0) {
            (true, _) => Err(Self::Empty),
            (_, false) => Err(Self::NoWeight),
            _ => Ok(sum),
        }
    }
}
