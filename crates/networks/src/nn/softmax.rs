//! Softmax of scaled scores over the last dimension as one operation.
//!
//! ```text
//! yᵢ = e^(s·xᵢ) / Σⱼ e^(s·xⱼ)        dL/dxᵢ = s·yᵢ·(gᵢ − Σⱼ gⱼ yⱼ)
//! ```

use candle_core::{CpuStorage, CustomOp1, Device, Layout, Result as TensorResult, Shape, Tensor};

use crate::nn::NnError;
use crate::nn::element::{NetworkNumber, max_of, sum_of, vectorized};
use crate::nn::storage::{NumberType, contiguous, cpu_storage, number_type};

/// Softmax of `scale`·x over the last dimension, which must be finite for the result to be.
///
/// - `x`: `[…, n]`.
/// - returns the same shape; each row adds up to 1.
///
/// # Errors
/// [`NnError::NumberType`].
pub fn softmax(x: &Tensor, scale: f64) -> Result<Tensor, NnError> {
    let x = x.contiguous()?;
    Ok(match number_type(&x, "softmax")? {
        NumberType::F32 => x.apply_op1(Softmax { scale: scale as f32 })?,
        NumberType::F64 => x.apply_op1(Softmax { scale })?,
    })
}

struct Softmax<T> {
    scale: T,
}

impl<T: NetworkNumber> CustomOp1 for Softmax<T> {
    fn name(&self) -> &'static str {
        "scaled softmax"
    }

    fn cpu_fwd(&self, x: &CpuStorage, layout: &Layout) -> TensorResult<(CpuStorage, Shape)> {
        let mut y = contiguous::<T>(x, layout, self.name())?.to_vec();
        let width = layout.dims().last().copied().unwrap_or(1).max(1);
        vectorized(
            #[inline(always)]
            || {
                for row in y.chunks_exact_mut(width) {
                    softmax_row(row, self.scale);
                }
            },
        );
        Ok((T::to_cpu_storage_owned(y), layout.shape().clone()))
    }

    fn bwd(&self, x: &Tensor, y: &Tensor, gradient: &Tensor) -> TensorResult<Option<Tensor>> {
        let gradient = gradient.contiguous()?;
        let (storage, layout) = gradient.storage_and_layout();
        let mut dx =
            contiguous::<T>(cpu_storage(&storage, self.name())?, layout, self.name())?.to_vec();
        let (storage, layout) = y.storage_and_layout();
        let y = contiguous::<T>(cpu_storage(&storage, self.name())?, layout, self.name())?;
        let width = layout.dims().last().copied().unwrap_or(1).max(1);
        vectorized(
            #[inline(always)]
            || {
                for (dx, y) in dx.chunks_exact_mut(width).zip(y.chunks_exact(width)) {
                    softmax_backward_row(dx, y, self.scale);
                }
            },
        );
        Ok(Some(Tensor::from_vec(dx, x.shape(), &Device::Cpu)?))
    }
}

/// Softmax of `scale`·x in place.
#[inline(always)]
fn softmax_row<T: NetworkNumber>(row: &mut [T], scale: T) {
    // The largest scaled score, taken off so that no exponential overflows.
    let largest = max_of(row, scale);
    for x in row.iter_mut() {
        *x = (*x * scale - largest).exp();
    }
    let inverse = T::ONE / sum_of(row, row, |x, _| x);
    for x in row {
        *x *= inverse;
    }
}

/// The gradient of x in place of that of y.
#[inline(always)]
fn softmax_backward_row<T: NetworkNumber>(gradient: &mut [T], y: &[T], scale: T) {
    let mean = sum_of(y, gradient, |y, g| y * g);
    for (g, &y) in gradient.iter_mut().zip(y) {
        *g = scale * y * (*g - mean);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::gradient_check::{
        assert_close, assert_gradients, random_tensor, random_variable,
    };
    use candle_core::DType;

    #[test]
    fn the_gradient_is_that_of_central_differences() {
        let x = random_variable(&[2, 3, 5], 1);
        assert_gradients(std::slice::from_ref(&x), || softmax(&x, 1.7).unwrap());
    }

    #[test]
    fn it_equals_the_plain_one() {
        for shape in [[1, 1], [70, 17], [5000, 33]] {
            let x = random_tensor(&shape, DType::F32, 2);
            let plain = candle_nn::ops::softmax(&(&x * 3.0).unwrap(), 1).unwrap();
            assert_close(&softmax(&x, 3.0).unwrap(), &plain, 1e-6);
        }
    }

    #[test]
    fn large_scores_do_not_overflow() {
        let x = Tensor::new(&[1e30_f32, 0.0, -1e30], &candle_core::Device::Cpu).unwrap();
        let y = softmax(&x, 1.0).unwrap().to_vec1::<f32>().unwrap();
        assert_eq!(y[0], 1.0);
        assert!(y[1] < 1e-37 && y[2] < 1e-37);
    }
}
