//! Tensors by name, as they are exported, saved and taken over again.

use std::collections::BTreeMap;

use candle_core::{DType, Tensor};

use crate::nn::NnError;

/// Tensors by name, in the order of their names.
pub type NamedTensors = BTreeMap<String, Tensor>;

/// The numbers that a network may have whose parameters are in a file: twice as many as the file has
/// and some more, so that a file that lacks a tensor is told which.
pub(crate) fn parameter_budget(tensors: &NamedTensors) -> usize {
    2 * tensors.values().map(Tensor::elem_count).sum::<usize>() + 100_000
}

/// The tensor of this name, of this shape and with finite numbers.
///
/// # Errors
/// [`NnError::MissingTensor`], [`NnError::WrongShape`], [`NnError::NonFinite`].
pub(crate) fn find<'a>(
    tensors: &'a NamedTensors,
    name: &str,
    dims: &[usize],
) -> Result<&'a Tensor, NnError> {
    let missing = || NnError::MissingTensor { name: name.to_owned() };
    let tensor = tensors.get(name).ok_or_else(missing)?;
    if tensor.dims() != dims {
        let (expected, got) = (dims.to_vec(), tensor.dims().to_vec());
        return Err(NnError::WrongShape { name: name.to_owned(), expected, got });
    }
    check_finite(name, tensor)?;
    Ok(tensor)
}

/// # Errors
/// [`NnError::UnexpectedTensor`] with the first tensor that is not known.
pub(crate) fn check_no_other(
    tensors: &NamedTensors,
    is_known: impl Fn(&str) -> bool,
) -> Result<(), NnError> {
    match tensors.keys().find(|name| !is_known(name)) {
        None => Ok(()),
        Some(name) => Err(NnError::UnexpectedTensor { name: name.clone() }),
    }
}

/// # Errors
/// [`NnError::NonFinite`] with the first number that is not finite.
pub(crate) fn check_finite(name: &str, tensor: &Tensor) -> Result<(), NnError> {
    let values = tensor.detach().flatten_all()?.to_dtype(DType::F64)?.to_vec1::<f64>()?;
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => {
            Err(NnError::NonFinite { name: name.to_owned(), index, value: values[index] })
        }
    }
}
