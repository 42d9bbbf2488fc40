//! What can go wrong while a network is built, run, trained or loaded.

/// Why a network could not be built, run, trained or loaded.
#[derive(Debug, thiserror::Error)]
pub enum NnError {
    /// An operation on tensors failed.
    #[error("an operation on tensors failed")]
    Tensor(#[from] candle_core::Error),
    /// Two parameters would have the same name.
    #[error("the parameter {name:?} is defined twice")]
    DuplicateParameter {
        /// The name.
        name: String,
    },
    /// A layer with no inputs, no outputs or no layers.
    #[error("{name}: the widths {widths:?} leave a layer without inputs or outputs")]
    EmptyLayer {
        /// The layer.
        name: String,
        /// Its widths.
        widths: Vec<usize>,
    },
    /// A layer was given rows of another width.
    #[error("{name}: expected {expected} values in the last dimension, got the shape {got:?}")]
    InputWidth {
        /// The layer.
        name: String,
        /// The width that it takes.
        expected: usize,
        /// The shape that it was given.
        got: Vec<usize>,
    },
    /// The channels cannot be shared out evenly.
    #[error("{name}: {channels} channels cannot be divided by {divisor}")]
    Indivisible {
        /// The layer.
        name: String,
        /// The number of channels.
        channels: usize,
        /// Heads of attention, or 2 for pairs of sine and cosine.
        divisor: usize,
    },
    /// A setting outside its range.
    #[error("{name} is {value}, expected {expected}")]
    Setting {
        /// The setting.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The range.
        expected: &'static str,
    },
    /// Only 32- and 64-bit numbers are computed with.
    #[error("{name}: holds {got} numbers, expected {expected}")]
    NumberType {
        /// The tensor or layer.
        name: String,
        /// The type that is taken.
        expected: &'static str,
        /// The type that was given.
        got: String,
    },
    /// A gradient is infinite or not a number; the parameters were left as they were.
    #[error("the gradient of {name:?} is not finite; no step was taken")]
    NonFiniteGradient {
        /// The parameter.
        name: String,
    },
    /// A tensor that the model needs is not there.
    #[error("the tensor {name:?} is missing")]
    MissingTensor {
        /// The tensor.
        name: String,
    },
    /// A tensor that the model does not have.
    #[error("the tensor {name:?} is unexpected; the model has none of this name")]
    UnexpectedTensor {
        /// The tensor.
        name: String,
    },
    /// A tensor of another shape.
    #[error("the tensor {name:?} has the shape {got:?}, expected {expected:?}")]
    WrongShape {
        /// The tensor.
        name: String,
        /// The model's shape.
        expected: Vec<usize>,
        /// The shape that was given.
        got: Vec<usize>,
    },
    /// A number in a tensor is infinite or not a number.
    #[error("the tensor {name:?} holds {value} at index {index}, expected finite numbers")]
    NonFinite {
        /// The tensor.
        name: String,
        /// Where, counted row by row from 0.
        index: usize,
        /// What.
        value: f64,
    },
}
