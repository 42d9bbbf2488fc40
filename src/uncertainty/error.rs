//! What is no distribution.

/// Numbers that make no mixture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MixtureError {
    /// No components.
    #[error("a mixture of no components")]
    Empty,
    /// A weight below zero or not finite.
    #[error("weight of component {component} is {weight}, expected 0 or more")]
    Weight {
        /// Index of the component.
        component: usize,
        /// Its weight.
        weight: f64,
    },
    /// Weights that sum to zero.
    #[error("the weights sum to zero")]
    NoWeight,
    /// A mean, a row of factors or a variance is missing or too many.
    #[error("component {component}: {what} has {got} values, expected {expected}")]
    Shape {
        /// Index of the component.
        component: usize,
        /// Which of its fields.
        what: &'static str,
        /// Values needed.
        expected: usize,
        /// Values there.
        got: usize,
    },
    /// A variance that is not a positive number.
    #[error(
        "component {component}: variance of value {value_idx} is {variance}, expected more than 0"
    )]
    Variance {
        /// Index of the component.
        component: usize,
        /// Index of the value.
        value_idx: usize,
        /// Its variance.
        variance: f64,
    },
    /// A correlation of neighbouring instants that is none.
    #[error("component {component}: correlation of neighbours is {value}, expected 0 to below 1")]
    LagCorrelation {
        /// Index of the component.
        component: usize,
        /// Its correlation.
        value: f64,
    },
    /// A mean or a factor that is not finite.
    #[error("component {component}: {what} holds a number that is not finite")]
    NotFinite {
        /// Index of the component.
        component: usize,
        /// Which of its fields.
        what: &'static str,
    },
    /// A band that is none.
    #[error("level of a band is {level}, expected between 0 and 1")]
    Level {
        /// The level.
        level: f64,
    },
}

impl MixtureError {
    /// The sum of weights, if they are fit for a mixture.
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
