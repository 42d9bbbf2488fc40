//! From candle's tensors to slices of numbers, for the kernels.

use candle_core::backend::BackendStorage;
use candle_core::{CpuStorage, DType, Error, Layout, Result, Storage, StorageRef, Tensor};

use crate::nn::NnError;
use crate::nn::element::Element;

/// The types that the kernels are compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NumberType {
    F32,
    F64,
}

/// # Errors
/// [`NnError::NumberType`] for a type that no kernel is compiled for.
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

/// The numbers of several tensors that each lie in one piece.
pub(crate) fn slices<'a, T: Element>(
    tensors: &'a [(StorageRef<'_>, &Layout)],
    op: &'static str,
) -> Result<Vec<&'a [T]>> {
    let slice = |(storage, layout): &'a (StorageRef<'_>, &Layout)| {
        contiguous::<T>(cpu_storage(storage, op)?, layout, op)
    };
    tensors.iter().map(slice).collect()
}

/// The numbers behind a tensor on the CPU.
pub(crate) fn cpu_storage<'a>(storage: &'a Storage, op: &'static str) -> Result<&'a CpuStorage> {
    match storage {
        Storage::Cpu(storage) => Ok(storage),
        _ => Err(Error::BackwardNotSupported { op }),
    }
}

/// The numbers of a tensor that lies in one piece.
pub(crate) fn contiguous<'a, T: Element>(
    storage: &'a CpuStorage,
    layout: &Layout,
    op: &'static str,
) -> Result<&'a [T]> {
    let (start, end) = layout.contiguous_offsets().ok_or(Error::RequiresContiguous { op })?;
    let all = T::cpu_storage_as_slice(storage)?;
    all.get(start..end).ok_or(Error::RequiresContiguous { op })
}

/// The numbers of a tensor that lies in one piece, to be changed.
pub(crate) fn contiguous_mut<'a, T: Element>(
    storage: &'a mut CpuStorage,
    layout: &Layout,
    op: &'static str,
) -> Result<&'a mut [T]> {
    let (start, end) = layout.contiguous_offsets().ok_or(Error::RequiresContiguous { op })?;
    let got = storage.dtype();
    let wrong_type = Error::UnexpectedDType { expected: T::DTYPE, got, msg: op };
    let all = T::slice_mut(storage).ok_or(wrong_type)?;
    all.get_mut(start..end).ok_or(Error::RequiresContiguous { op })
}
