//! From candle's tensors to slices of numbers, for operations of our own.

use candle_core::{CpuStorage, DType, Error, Layout, Result, Storage, Tensor};

use crate::nn::NnError;
use crate::nn::element::NetworkNumber;

/// The types of numbers that operations of our own compute with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NumberType {
    F32,
    F64,
}

/// # Errors
/// [`NnError::NumberType`] for any other type.
pub(crate) fn number_type(x: &Tensor, name: &str) -> std::result::Result<NumberType, NnError> {
    match x.dtype() {
        DType::F32 => Ok(NumberType::F32),
        DType::F64 => Ok(NumberType::F64),
        other => {
            let (name, got) = (name.to_owned(), format!("{other:?}"));
            Err(NnError::NumberType { name, expected: "f32 or f64", got })
        }
    }
}

/// The numbers behind a tensor on the CPU.
pub(crate) fn cpu_storage<'a>(storage: &'a Storage, op: &'static str) -> Result<&'a CpuStorage> {
    match storage {
        Storage::Cpu(storage) => Ok(storage),
        _ => Err(Error::BackwardNotSupported { op }),
    }
}

/// The numbers of a tensor that lies in one piece.
pub(crate) fn contiguous<'a, T: NetworkNumber>(
    storage: &'a CpuStorage,
    layout: &Layout,
    op: &'static str,
) -> Result<&'a [T]> {
    let (start, end) = layout.contiguous_offsets().ok_or(Error::RequiresContiguous { op })?;
    let all = T::cpu_storage_as_slice(storage)?;
    all.get(start..end).ok_or(Error::RequiresContiguous { op })
}
