//! Layer normalisation as one operation.
//!
//! ```text
//! x̂ = (x − mean x)/√(var x + ε)      y = γ x̂ + β      over the last dimension
//! h = g γ      dL/dx = (h − mean h − x̂·mean(h x̂))/√(var x + ε)
//! dL/dγ = Σ_rows g x̂      dL/dβ = Σ_rows g
//! ```
//!
//! Source: J. L. Ba et al., Layer Normalization, arXiv:1607.06450.

use candle_core::{CpuStorage, CustomOp3, Device, Layout, Result as TensorResult, Shape, Tensor};
use rayon::prelude::*;

use crate::nn::element::{
    Element, ROWS_PER_BLOCK, min_blocks_per_task, sum_of, sum_of_rows, vectorized,
};
use crate::nn::storage::{NumberType, contiguous, number_type, slices};
use crate::nn::{Init, NnError, ParameterBuilder};

/// ε.
const VARIANCE_FLOOR: f64 = 1e-5;

/// Normalises each row to mean 0 and variance 1, then scales and shifts it by what is learned.
#[derive(Debug, Clone)]
pub struct LayerNorm {
    name: String,
    weight: Tensor,
    bias: Tensor,
}

impl LayerNorm {
    /// Adds `weight` (γ), which starts at one, and `bias` (β), which starts at zero.
    ///
    /// # Errors
    /// [`NnError::EmptyLayer`], [`NnError::DuplicateParameter`].
    pub fn new(builder: &mut ParameterBuilder<'_>, width: usize) -> Result<Self, NnError> {
        let name = builder.prefix().to_owned();
        if width == 0 {
            return Err(NnError::EmptyLayer { name, widths: vec![width] });
        }
        let weight = builder.add("weight", &[width], Init::Constant(1.0))?;
        let bias = builder.add("bias", &[width], Init::Zero)?;
        Ok(Self { name, weight, bias })
    }

    /// The same layer without gradients of its parameters; see [`Linear::frozen`](crate::nn::Linear::frozen).
    #[must_use]
    pub fn frozen(&self) -> Self {
        Self { weight: self.weight.detach(), bias: self.bias.detach(), ..self.clone() }
    }

    /// γ x̂ + β.
    ///
    /// - `x`: `[…, width]`.
    /// - returns the same shape.
    ///
    /// # Errors
    /// [`NnError::InputWidth`], [`NnError::NumberType`].
    pub fn forward(&self, x: &Tensor) -> Result<Tensor, NnError> {
        let expected = self.weight.elem_count();
        if x.dims().last() != Some(&expected) {
            let (name, got) = (self.name.clone(), x.dims().to_vec());
            return Err(NnError::InputWidth { name, expected, got });
        }
        let x = x.contiguous()?;
        Ok(match number_type(&x, &self.name)? {
            NumberType::F32 => x.apply_op3(&self.weight, &self.bias, Normalize::<f32>::new())?,
            NumberType::F64 => x.apply_op3(&self.weight, &self.bias, Normalize::<f64>::new())?,
        })
    }
}

struct Normalize<T> {
    floor: T,
}

impl<T: Element> Normalize<T> {
    fn new() -> Self {
        Self { floor: T::from_f64(VARIANCE_FLOOR) }
    }

    /// Mean and 1/√(var + ε) of a row.
    #[inline(always)]
    fn statistics(&self, row: &[T]) -> (T, T) {
        let n = T::from_f64(row.len() as f64);
        let mean = sum_of(row, row, |x, _| x) / n;
        let variance = sum_of(row, row, |x, _| (x - mean) * (x - mean)) / n;
        (mean, T::ONE / (variance + self.floor).sqrt())
    }

    /// The gradients of x, and of γ and β for this block of rows, one after the other in `sums`.
    #[inline(always)]
    fn block_backward(&self, [dx, sums]: [&mut [T]; 2], [x, g, gamma]: [&[T]; 3]) {
        let width = gamma.len();
        let n = T::from_f64(width as f64);
        let (gamma_sums, beta_sums) = sums.split_at_mut(width);
        let rows = dx.chunks_exact_mut(width).zip(x.chunks_exact(width));
        for ((dx, x), g) in rows.zip(g.chunks_exact(width)) {
            let (mean, inverse) = self.statistics(x);
            // x̂ first, which becomes the gradient in place.
            for (dx, &x) in dx.iter_mut().zip(x) {
                *dx = (x - mean) * inverse;
            }
            let sums = gamma_sums.iter_mut().zip(beta_sums.iter_mut());
            for (((gamma_sum, beta_sum), &normal), &g) in sums.zip(&*dx).zip(g) {
                *gamma_sum += g * normal;
                *beta_sum += g;
            }
            let mean_h = sum_of(g, gamma, |g, gamma| g * gamma) / n;
            let mut lanes = T::ZERO;
            for ((&normal, &g), &gamma) in dx.iter().zip(g).zip(gamma) {
                lanes += g * gamma * normal;
            }
            let mean_hx = lanes / n;
            for ((dx, &g), &gamma) in dx.iter_mut().zip(g).zip(gamma) {
                *dx = inverse * (g * gamma - mean_h - *dx * mean_hx);
            }
        }
    }

    fn backward(&self, [x, g, gamma]: [&[T]; 3]) -> (Vec<T>, Vec<T>) {
        let width = gamma.len();
        let size = ROWS_PER_BLOCK * width;
        let mut dx = vec![T::ZERO; x.len()];
        let mut sums = vec![T::ZERO; x.len().div_ceil(size) * 2 * width];
        let blocks = dx.par_chunks_mut(size).zip(sums.par_chunks_mut(2 * width));
        let blocks = blocks.zip(x.par_chunks(size)).zip(g.par_chunks(size));
        blocks.with_min_len(min_blocks_per_task(x.len())).for_each(|(((dx, sums), x), g)| {
            vectorized(
                #[inline(always)]
                || self.block_backward([dx, sums], [x, g, gamma]),
            );
        });
        (dx, sum_of_rows(&sums, 2 * width))
    }
}

impl<T: Element> CustomOp3 for Normalize<T> {
    fn name(&self) -> &'static str {
        "layer norm"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        x_layout: &Layout,
        gamma: &CpuStorage,
        gamma_layout: &Layout,
        beta: &CpuStorage,
        beta_layout: &Layout,
    ) -> TensorResult<(CpuStorage, Shape)> {
        let x = contiguous::<T>(x, x_layout, self.name())?;
        let gamma = contiguous::<T>(gamma, gamma_layout, self.name())?;
        let beta = contiguous::<T>(beta, beta_layout, self.name())?;
        let width = gamma.len();
        let (size, mut y) = (ROWS_PER_BLOCK * width, vec![T::ZERO; x.len()]);
        let blocks = y.par_chunks_mut(size).zip(x.par_chunks(size));
        blocks.with_min_len(min_blocks_per_task(x.len())).for_each(|(y, x)| {
            vectorized(
                #[inline(always)]
                || {
                    for (y, x) in y.chunks_exact_mut(width).zip(x.chunks_exact(width)) {
                        let (mean, inverse) = self.statistics(x);
                        let row = y.iter_mut().zip(x).zip(gamma).zip(beta);
                        for (((y, &x), &gamma), &beta) in row {
                            *y = (x - mean) * inverse * gamma + beta;
                        }
                    }
                },
            );
        });
        Ok((T::to_cpu_storage_owned(y), x_layout.shape().clone()))
    }

    fn bwd(
        &self,
        x: &Tensor,
        gamma: &Tensor,
        beta: &Tensor,
        _y: &Tensor,
        gradient: &Tensor,
    ) -> TensorResult<(Option<Tensor>, Option<Tensor>, Option<Tensor>)> {
        let gradient = gradient.contiguous()?;
        let width = gamma.elem_count();
        let guards = [x, &gradient, gamma].map(Tensor::storage_and_layout);
        let slices = slices::<T>(&guards, self.name())?;
        let (dx, sums) = self.backward([slices[0], slices[1], slices[2]]);
        let (gamma_gradient, beta_gradient) = sums.split_at(width);
        let to_tensor = |values: &[T]| Tensor::from_slice(values, width, &Device::Cpu);
        let dx = Tensor::from_vec(dx, x.shape(), &Device::Cpu)?;
        Ok((
            x.track_op().then_some(dx),
            gamma.track_op().then(|| to_tensor(gamma_gradient)).transpose()?,
            beta.track_op().then(|| to_tensor(beta_gradient)).transpose()?,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::gradient_check::{
        assert_close, assert_gradients, random_tensor, random_variable,
    };
    use crate::nn::{Parameters, random_stream};
    use candle_core::{DType, Var};

    fn layer(number_type: DType, width: usize) -> (Parameters, LayerNorm) {
        let mut parameters = Parameters::new(number_type);
        let mut rng = random_stream(5, "weights", 0);
        let norm = LayerNorm::new(&mut parameters.builder(&mut rng).at("norm"), width).unwrap();
        for (i, (_, variable)) in parameters.iter().enumerate() {
            variable.set(&random_tensor(&[width], number_type, 20 + i as u64)).unwrap();
        }
        (parameters, norm)
    }

    #[test]
    fn gradients_are_those_of_central_differences() {
        let (parameters, norm) = layer(DType::F64, 5);
        let x = random_variable(&[2, 3, 5], 1);
        let variables = parameters.iter().map(|(_, v)| v.clone()).chain([x.clone()]);
        let variables: Vec<Var> = variables.collect();
        assert_gradients(&variables, || norm.forward(&x).unwrap());
    }

    #[test]
    fn it_equals_the_plain_one() {
        for (rows, width) in [(1, 1), (65, 7), (3000, 40)] {
            let (_, norm) = layer(DType::F32, width);
            let x = random_tensor(&[rows, width], DType::F32, 2);
            let plain = candle_nn::ops::layer_norm_slow(&x, &norm.weight, &norm.bias, 1e-5);
            assert_close(&norm.forward(&x).unwrap(), &plain.unwrap(), 1e-5);
        }
    }

    #[test]
    fn rows_of_another_width_are_refused() {
        let (_, norm) = layer(DType::F32, 4);
        let error = norm.forward(&random_tensor(&[2, 3], DType::F32, 1)).unwrap_err();
        let expected = "norm: expected 4 values in the last dimension, got the shape [2, 3]";
        assert_eq!(error.to_string(), expected);
    }
}
