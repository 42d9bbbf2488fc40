//! A fully connected layer as one operation: product, bias and activation, with an exact gradient.
//!
//! ```text
//! y = act(x Wᵀ + b)
//! δ = g·dy/dz        dL/dx = δ W        dL/dW = δᵀ x        dL/db = Σ_rows δ
//! ```
//!
//! The products are candle's. What is fused around them spares the passes that dominate a step of
//! training when each is an operation of its own.

use std::sync::OnceLock;

use candle_core::backend::BackendStorage;
use candle_core::{
    CpuStorage, CustomOp3, DType, Device, Layout, Result as TensorResult, Shape, Tensor,
};

use crate::nn::activation::{
    add_bias, bias_silu, bias_silu_with_slope, column_sums, silu_backward,
};
use crate::nn::element::{Element, contiguous, cpu_storage};
use crate::nn::{Activation, Init, NnError, ParameterBuilder};

/// A fully connected layer, `[…, n_in]` to `[…, n_out]`.
#[derive(Debug, Clone)]
pub struct Linear {
    name: String,
    weight: Tensor,
    bias: Tensor,
    activation: Activation,
}

impl Linear {
    /// Adds `weight`, `[n_out, n_in]`, and `bias`, `[n_out]`, to the parameters. Weights start by
    /// Kaiming's rule before Swish and by Xavier's otherwise, biases at zero.
    ///
    /// # Errors
    /// [`NnError::EmptyLayer`], [`NnError::DuplicateParameter`].
    pub fn new(
        builder: &mut ParameterBuilder<'_>,
        widths: [usize; 2],
        activation: Activation,
    ) -> Result<Self, NnError> {
        let init = match activation {
            Activation::None => Init::XavierUniform,
            Activation::Silu => Init::KaimingNormal,
        };
        Self::with_init(builder, widths, activation, init)
    }

    /// Like [`Linear::new`], with the weights as `init` says: [`Init::Zero`] for a head whose
    /// output shall start at zero.
    ///
    /// # Errors
    /// As for [`Linear::new`].
    pub fn with_init(
        builder: &mut ParameterBuilder<'_>,
        widths: [usize; 2],
        activation: Activation,
        init: Init,
    ) -> Result<Self, NnError> {
        let name = builder.prefix().to_owned();
        let [n_in, n_out] = widths;
        if n_in == 0 || n_out == 0 {
            return Err(NnError::EmptyLayer { name, widths: widths.to_vec() });
        }
        let weight = builder.add("weight", &[n_out, n_in], init)?;
        let bias = builder.add("bias", &[n_out], Init::Zero)?;
        Ok(Self { name, weight, bias, activation })
    }

    /// `[n_in, n_out]`.
    pub fn widths(&self) -> [usize; 2] {
        [self.weight.dims()[1], self.weight.dims()[0]]
    }

    /// The same layer, which follows the same parameters but asks for no gradients of them: for
    /// predictions, and for layers that are not trained.
    #[must_use]
    pub fn frozen(&self) -> Self {
        Self { weight: self.weight.detach(), bias: self.bias.detach(), ..self.clone() }
    }

    /// act(x Wᵀ + b).
    ///
    /// - `x`: `[…, n_in]`.
    /// - returns `[…, n_out]`.
    ///
    /// # Errors
    /// [`NnError::InputWidth`], [`NnError::NumberType`].
    pub fn forward(&self, x: &Tensor) -> Result<Tensor, NnError> {
        let [expected, _] = self.widths();
        if x.dims().last() != Some(&expected) {
            let (name, got) = (self.name.clone(), x.dims().to_vec());
            return Err(NnError::InputWidth { name, expected, got });
        }
        let x = x.contiguous()?;
        let tracked = x.track_op() || self.weight.track_op() || self.bias.track_op();
        match x.dtype() {
            DType::F32 => self.apply::<f32>(&x, tracked),
            DType::F64 => self.apply::<f64>(&x, tracked),
            other => Err(NnError::NumberType {
                name: self.name.clone(),
                expected: "f32 or f64",
                got: format!("{other:?}"),
            }),
        }
    }

    fn apply<T: Element>(&self, x: &Tensor, tracked: bool) -> Result<Tensor, NnError> {
        let op = FusedLinear::<T> { activation: self.activation, tracked, slope: OnceLock::new() };
        Ok(x.apply_op3(&self.weight, &self.bias, op)?)
    }
}

/// One call of a layer; keeps the slope of the activation for the way back.
struct FusedLinear<T> {
    activation: Activation,
    tracked: bool,
    slope: OnceLock<Vec<T>>,
}

impl<T: Element> CustomOp3 for FusedLinear<T> {
    fn name(&self) -> &'static str {
        "fused linear"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        x_layout: &Layout,
        weight: &CpuStorage,
        weight_layout: &Layout,
        bias: &CpuStorage,
        bias_layout: &Layout,
    ) -> TensorResult<(CpuStorage, Shape)> {
        let (n_out, n_in) = weight_layout.shape().dims2()?;
        let n_rows = x_layout.shape().elem_count() / n_in;
        let rows = Layout::contiguous_with_offset((n_rows, n_in), x_layout.start_offset());
        let z =
            x.matmul(weight, (1, n_rows, n_out, n_in), &rows, &weight_layout.transpose(0, 1)?)?;
        let mut y = T::cpu_storage_data(z)?;
        let bias = contiguous::<T>(bias, bias_layout, self.name())?;
        match self.activation {
            Activation::None => add_bias(&mut y, bias),
            Activation::Silu if self.tracked => {
                // A call has one forward pass, so the slope is not there yet.
                let _ = self.slope.set(bias_silu_with_slope(&mut y, bias));
            }
            Activation::Silu => bias_silu(&mut y, bias),
        }
        let mut dims = x_layout.dims().to_vec();
        if let Some(last) = dims.last_mut() {
            *last = n_out;
        }
        Ok((T::to_cpu_storage_owned(y), dims.into()))
    }

    fn bwd(
        &self,
        x: &Tensor,
        weight: &Tensor,
        bias: &Tensor,
        _y: &Tensor,
        gradient: &Tensor,
    ) -> TensorResult<(Option<Tensor>, Option<Tensor>, Option<Tensor>)> {
        let (n_out, n_in) = weight.dims2()?;
        let gradient = gradient.contiguous()?.reshape(((), n_out))?;
        let (delta, bias_gradient) = self.delta(&gradient, n_out)?;
        let weight_gradient = match weight.track_op() {
            true => Some(delta.t()?.matmul(&x.detach().reshape(((), n_in))?)?),
            false => None,
        };
        let x_gradient = match x.track_op() {
            true => Some(delta.matmul(&weight.detach())?.reshape(x.shape())?),
            false => None,
        };
        Ok((x_gradient, weight_gradient, bias.track_op().then_some(bias_gradient)))
    }
}

impl<T: Element> FusedLinear<T> {
    /// The gradient of the pre-activations, `[rows, n_out]`, and of the bias, `[n_out]`.
    fn delta(&self, gradient: &Tensor, n_out: usize) -> TensorResult<(Tensor, Tensor)> {
        let (storage, layout) = gradient.storage_and_layout();
        let storage = cpu_storage(&storage, self.name())?;
        let values = contiguous::<T>(storage, layout, self.name())?;
        let (delta, sums) = match self.slope.get() {
            Some(slope) => {
                let (delta, sums) = silu_backward(values, slope, n_out);
                (Tensor::from_vec(delta, gradient.shape(), &Device::Cpu)?, sums)
            }
            None => (gradient.clone(), column_sums(values, n_out)),
        };
        Ok((delta, Tensor::from_vec(sums, n_out, &Device::Cpu)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::gradient_check::{
        assert_close, assert_gradients, random_tensor, random_variable,
    };
    use crate::nn::{Parameters, random_stream};
    use candle_core::Var;

    fn layer(number_type: DType, activation: Activation) -> (Parameters, Linear) {
        let mut parameters = Parameters::new(number_type);
        let mut rng = random_stream(5, "weights", 0);
        let mut root = parameters.builder(&mut rng);
        let linear = Linear::new(&mut root.at("layer"), [3, 4], activation).unwrap();
        let bias = parameters.get("layer.bias").unwrap();
        bias.set(&random_tensor(&[4], number_type, 6)).unwrap();
        (parameters, linear)
    }

    /// The same layer from candle's own operations.
    fn plain(linear: &Linear, x: &Tensor) -> Tensor {
        let n_in = linear.widths()[0];
        let rows = x.reshape(((), n_in)).unwrap();
        let z = rows.matmul(&linear.weight.t().unwrap()).unwrap();
        let z = z.broadcast_add(&linear.bias).unwrap();
        match linear.activation {
            Activation::None => z,
            Activation::Silu => (&z * candle_nn::ops::sigmoid(&z).unwrap()).unwrap(),
        }
    }

    #[test]
    fn gradients_are_those_of_central_differences() {
        for activation in [Activation::None, Activation::Silu] {
            let (parameters, linear) = layer(DType::F64, activation);
            let x = random_variable(&[2, 5, 3], 1);
            let mut variables: Vec<Var> = parameters.iter().map(|(_, v)| v.clone()).collect();
            variables.push(x.clone());
            assert_gradients(&variables, || linear.forward(&x).unwrap());
        }
    }

    #[test]
    fn the_fused_layer_equals_the_plain_one() {
        for activation in [Activation::None, Activation::Silu] {
            for rows in [0, 1, 63, 64, 65, 5000] {
                let (parameters, linear) = layer(DType::F32, activation);
                let x = Var::from_tensor(&random_tensor(&[rows, 3], DType::F32, 2)).unwrap();
                let (fused, plain) = (linear.forward(&x).unwrap(), plain(&linear, &x));
                assert_close(&fused, &plain, 1e-5);
                let weights = random_tensor(&[rows, 4], DType::F32, 3);
                let weigh = |y: &Tensor| (y * &weights).unwrap().mean_all().unwrap();
                let fused = weigh(&fused).backward().unwrap();
                let plain = weigh(&plain).backward().unwrap();
                let all = parameters.iter().map(|(_, v)| v).chain([&x]);
                for variable in all {
                    let (fused, plain) = (fused.get(variable), plain.get(variable));
                    assert_close(fused.unwrap(), plain.unwrap(), 1e-5);
                }
            }
        }
    }

    #[test]
    fn two_runs_give_the_same_bits() {
        let run = || {
            let (parameters, linear) = layer(DType::F32, Activation::Silu);
            let x = random_tensor(&[20_000, 3], DType::F32, 2);
            let y = linear.forward(&x).unwrap();
            let gradients = y.sqr().unwrap().mean_all().unwrap().backward().unwrap();
            let all = parameters.iter().map(|(_, v)| gradients.get(v).unwrap().clone()).chain([y]);
            let values = all.flat_map(|t| t.flatten_all().unwrap().to_vec1::<f32>().unwrap());
            values.map(f32::to_bits).collect::<Vec<_>>()
        };
        assert_eq!(run(), run());
    }

    #[test]
    fn a_frozen_layer_follows_the_parameters_and_takes_no_gradient() {
        let (parameters, linear) = layer(DType::F32, Activation::Silu);
        let frozen = linear.frozen();
        let x = Var::from_tensor(&random_tensor(&[2, 3], DType::F32, 2)).unwrap();
        let bias = parameters.get("layer.bias").unwrap();
        bias.set(&random_tensor(&[4], DType::F32, 9)).unwrap();
        let (y, expected) = (frozen.forward(&x).unwrap(), linear.forward(&x).unwrap());
        assert_close(&y, &expected, 0.0);
        let gradients = y.mean_all().unwrap().backward().unwrap();
        assert!(gradients.get(bias).is_none() && gradients.get(&x).is_some());
    }

    #[test]
    fn rows_of_another_width_or_type_are_refused() {
        let (_, linear) = layer(DType::F32, Activation::None);
        let error = linear.forward(&random_tensor(&[7, 2], DType::F32, 1)).unwrap_err();
        let expected = "layer: expected 3 values in the last dimension, got the shape [7, 2]";
        assert_eq!(error.to_string(), expected);
        let x = Tensor::zeros((7, 3), DType::U32, &Device::Cpu).unwrap();
        let error = linear.forward(&x).unwrap_err().to_string();
        assert_eq!(error, "layer: holds U32 numbers, expected f32 or f64");
        assert!(linear.forward(&random_tensor(&[7, 3], DType::F64, 1)).is_err());
    }
}
