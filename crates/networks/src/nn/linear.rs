//! A fully connected layer.

use candle_core::Tensor;

use crate::nn::storage::number_type;
use crate::nn::{Activation, Init, NnError, ParameterBuilder, product_with_transposed};

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
        let [n_in, n_out] = self.widths();
        let mut dims = x.dims().to_vec();
        let Some(last) = dims.last_mut().filter(|last| **last == n_in) else {
            let (name, got) = (self.name.clone(), x.dims().to_vec());
            return Err(NnError::InputWidth { name, expected: n_in, got });
        };
        *last = n_out;
        number_type(x, &self.name)?;
        // One product for all rows, whatever the leading dimensions are.
        let product = product_with_transposed(&x.reshape(((), n_in))?, &self.weight)?;
        Ok(self.activation.apply(&product, &self.bias)?.reshape(dims)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::Parameters;
    use crate::nn::gradient_check::{
        assert_close, assert_gradients, random_tensor, random_variable,
    };
    use candle_core::Var;
    use candle_core::{DType, Device};
    use impactlab_core::numerics::random_stream;

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
    fn the_layer_equals_one_of_candles_operations() {
        for activation in [Activation::None, Activation::Silu] {
            for rows in [1, 63, 64, 65, 5000] {
                let (parameters, linear) = layer(DType::F32, activation);
                let x = Var::from_tensor(&random_tensor(&[rows, 3], DType::F32, 2)).unwrap();
                let (own, plain) = (linear.forward(&x).unwrap(), plain(&linear, &x));
                assert_close(&own, &plain, 1e-5);
                assert_close(&linear.frozen().forward(&x.detach()).unwrap(), &own, 0.0);
                let weights = random_tensor(&[rows, 4], DType::F32, 3);
                let weigh = |y: &Tensor| (y * &weights).unwrap().mean_all().unwrap();
                let own = weigh(&own).backward().unwrap();
                let plain = weigh(&plain).backward().unwrap();
                let all = parameters.iter().map(|(_, v)| v).chain([&x]);
                for variable in all {
                    let (own, plain) = (own.get(variable), plain.get(variable));
                    assert_close(own.unwrap(), plain.unwrap(), 1e-5);
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
