//! Bias and activation of a layer as one operation on the rows of a matrix product.
//!
//! ```text
//! z = x Wᵀ + b      y = z·σ(z)      dy/dz = σ(z) + y·(1 − σ(z))      σ(z) = 1/(1 + e⁻ᶻ)
//! ```
//!
//! The slope dy/dz is kept from the forward pass, so that the backward pass has no exponential, and
//! the gradient of the bias is summed in one pass over the rows.

use std::sync::OnceLock;

use candle_core::{
    CpuStorage, CustomOp2, Device, Error, Layout, Result as TensorResult, Shape, Tensor,
};
use serde::{Deserialize, Serialize};

use crate::nn::NnError;
use crate::nn::element::{NetworkNumber, vectorized};
use crate::nn::storage::{NumberType, contiguous, cpu_storage, number_type};

/// The activation function of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Activation {
    /// The identity: y = z.
    None,
    /// Swish with β = 1, also called SiLU: y = z·σ(z).
    Silu,
}

impl Activation {
    /// y of the product `x Wᵀ` and the bias.
    ///
    /// - `product`: `[rows, width]`, contiguous.
    /// - `bias`: `[width]`.
    /// - returns `[rows, width]`.
    ///
    /// # Errors
    /// [`NnError::NumberType`], [`NnError::Tensor`].
    pub(crate) fn apply(self, product: &Tensor, bias: &Tensor) -> Result<Tensor, NnError> {
        Ok(match number_type(product, "layer")? {
            NumberType::F32 => product.apply_op2(bias, BiasActivation::<f32>::new(self))?,
            NumberType::F64 => product.apply_op2(bias, BiasActivation::<f64>::new(self))?,
        })
    }
}

/// One application of bias and activation.
struct BiasActivation<T> {
    activation: Activation,
    /// dy/dz, kept for the backward pass; not set without an activation.
    slope: OnceLock<Vec<T>>,
}

impl<T: NetworkNumber> BiasActivation<T> {
    fn new(activation: Activation) -> Self {
        Self { activation, slope: OnceLock::new() }
    }
}

impl<T: NetworkNumber> CustomOp2 for BiasActivation<T> {
    fn name(&self) -> &'static str {
        "bias and activation"
    }

    fn cpu_fwd(
        &self,
        product: &CpuStorage,
        product_layout: &Layout,
        bias: &CpuStorage,
        bias_layout: &Layout,
    ) -> TensorResult<(CpuStorage, Shape)> {
        let bias = contiguous::<T>(bias, bias_layout, self.name())?;
        let mut y = contiguous::<T>(product, product_layout, self.name())?.to_vec();
        match self.activation {
            Activation::None => add_bias(&mut y, bias),
            Activation::Silu => {
                let mut slope = vec![T::ZERO; y.len()];
                bias_silu_with_slope(&mut y, &mut slope, bias);
                // An operation is applied once, so that no slope is kept yet.
                self.slope.get_or_init(|| slope);
            }
        }
        Ok((T::to_cpu_storage_owned(y), product_layout.shape().clone()))
    }

    fn bwd(
        &self,
        product: &Tensor,
        bias: &Tensor,
        _y: &Tensor,
        gradient: &Tensor,
    ) -> TensorResult<(Option<Tensor>, Option<Tensor>)> {
        let gradient = gradient.contiguous()?;
        let (storage, layout) = gradient.storage_and_layout();
        let storage = cpu_storage(&storage, self.name())?;
        let mut delta = contiguous::<T>(storage, layout, self.name())?.to_vec();
        if self.activation == Activation::Silu {
            let slope = self.slope.get().ok_or(Error::BackwardNotSupported { op: self.name() })?;
            multiply(&mut delta, slope);
        }
        let mut bias_gradient = vec![T::ZERO; bias.elem_count()];
        add_column_sums(&mut bias_gradient, &delta);
        Ok((
            Some(Tensor::from_vec(delta, product.shape(), &Device::Cpu)?),
            Some(Tensor::from_vec(bias_gradient, bias.shape(), &Device::Cpu)?),
        ))
    }
}

/// y = silu(z + b), or z + b, in place. `z`: `[rows, width]`.
pub(crate) fn bias_silu_rows(z: &mut [f32], bias: &[f32], swish: bool) {
    if !swish {
        return add_bias(z, bias);
    }
    vectorized(
        #[inline(always)]
        || {
            for row in z.chunks_exact_mut(bias.len()) {
                for (z, &b) in row.iter_mut().zip(bias) {
                    let sum = *z + b;
                    *z = sum * sum.sigmoid();
                }
            }
        },
    );
}

/// z + b in place. `z`: `[rows, width]`.
fn add_bias<T: NetworkNumber>(z: &mut [T], bias: &[T]) {
    vectorized(
        #[inline(always)]
        || {
            for row in z.chunks_exact_mut(bias.len()) {
                for (z, &b) in row.iter_mut().zip(bias) {
                    *z += b;
                }
            }
        },
    );
}

/// y = silu(z + b) in place, and the slopes dy/dz. `z`, `slope`: `[rows, width]`.
fn bias_silu_with_slope<T: NetworkNumber>(z: &mut [T], slope: &mut [T], bias: &[T]) {
    let width = bias.len();
    vectorized(
        #[inline(always)]
        || {
            for (z, slope) in z.chunks_exact_mut(width).zip(slope.chunks_exact_mut(width)) {
                for ((z, slope), &b) in z.iter_mut().zip(slope).zip(bias) {
                    let sum = *z + b;
                    let sigmoid = sum.sigmoid();
                    *z = sum * sigmoid;
                    *slope = sigmoid + *z * (T::ONE - sigmoid);
                }
            }
        },
    );
}

/// g·dy/dz in place.
fn multiply<T: NetworkNumber>(gradient: &mut [T], slope: &[T]) {
    vectorized(
        #[inline(always)]
        || {
            for (g, &slope) in gradient.iter_mut().zip(slope) {
                *g *= slope;
            }
        },
    );
}

/// Sums over the rows of `[rows, width]`, added to `sums`.
fn add_column_sums<T: NetworkNumber>(sums: &mut [T], values: &[T]) {
    vectorized(
        #[inline(always)]
        || {
            for row in values.chunks_exact(sums.len()) {
                for (sum, &value) in sums.iter_mut().zip(row) {
                    *sum += value;
                }
            }
        },
    );
}
