//! What can go wrong while a network is built, run, trained, saved or loaded.

use std::path::PathBuf;

use impactlab_core::data::DataError;

/// Why a network could not be built, run, trained, saved or loaded.
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
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] DataError),
    /// A file was read, but holds no model that can be used.
    #[error("{}: cannot be used as a model", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// Why.
        source: Box<NnError>,
    },
    /// More bytes than a model has.
    #[error("has {bytes} bytes or more, at most {limit} are read")]
    TooLarge {
        /// Bytes that were seen.
        bytes: u64,
        /// The largest size that is read.
        limit: u64,
    },
    /// The first bytes are not those of the format.
    #[error("is not a safetensors file")]
    NotSafetensors,
    /// The header cannot be understood.
    #[error("the header is damaged")]
    Header(#[source] serde_json::Error),
    /// Header and contents contradict each other.
    #[error("the tensors are damaged")]
    Layout(#[source] safetensors::SafeTensorError),
    /// The end is missing.
    #[error("is truncated: expected {expected} bytes, has {got}")]
    Truncated {
        /// As the header says; at least so many if the header itself ends early.
        expected: u64,
        /// The size.
        got: u64,
    },
    /// Something follows the end.
    #[error("is too long: expected {expected} bytes, has {got}")]
    TrailingBytes {
        /// As the header says.
        expected: u64,
        /// The size.
        got: u64,
    },
    /// The contents are not those that were written.
    #[error("is damaged: the checksum is {got}, expected {expected}")]
    Checksum {
        /// SHA-256 as it was written.
        expected: String,
        /// SHA-256 of what is there.
        got: String,
    },
    /// A piece of metadata is not there.
    #[error("the metadata key {key:?} is missing")]
    MissingMetadata {
        /// Its key.
        key: String,
    },
    /// A piece of metadata has another form than expected, or cannot be written.
    #[error("the metadata {key:?} cannot be understood")]
    Metadata {
        /// Its key.
        key: String,
        /// Why.
        source: serde_json::Error,
    },
    /// A model for something else.
    #[error("is a model of the kind {got:?}, expected {expected:?}")]
    WrongKind {
        /// The kind that is needed.
        expected: String,
        /// The kind that it is.
        got: String,
    },
    /// A model as another version of the program writes it.
    #[error("has format version {got} of {kind:?}, this program reads version {expected}")]
    WrongVersion {
        /// The kind of model.
        kind: String,
        /// The version that is read.
        expected: u32,
        /// The version that it has.
        got: u32,
    },
    /// A network with more parameters than the memory is meant for, or than its file holds.
    #[error("{name}: the network has more than {limit} {what}; reduce its layers and widths")]
    TooManyParameters {
        /// The parameter that is one too many or too large.
        name: String,
        /// Numbers, or tensors.
        what: &'static str,
        /// How many there may be.
        limit: usize,
    },
    /// A number in the metadata is none with which a prediction can be made.
    #[error("{name} is {value}, expected {expected}")]
    StoredNumber {
        /// Its place in the metadata.
        name: String,
        /// Its value.
        value: f64,
        /// The range, in words.
        expected: String,
    },
    /// A list in the metadata has more or fewer entries than the model needs.
    #[error("{name} has {got} entries, expected {expected}")]
    StoredLength {
        /// Its place in the metadata.
        name: String,
        /// The number that is needed.
        expected: usize,
        /// The number that there are.
        got: usize,
    },
    /// A tensor with a dimension of length 0.
    #[error("the tensor {name:?} is empty: its shape is {shape:?}")]
    EmptyTensor {
        /// The tensor.
        name: String,
        /// Its shape.
        shape: Vec<usize>,
    },
}
