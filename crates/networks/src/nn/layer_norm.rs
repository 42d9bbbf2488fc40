//! Layer normalisation.
//!
//! ```text
//! y = γ (x − mean x)/√(var x + ε) + β      over the last dimension
//! ```
//!
//! Source: J. L. Ba et al., Layer Normalization, arXiv:1607.06450.

use candle_core::Tensor;

use crate::nn::{Init, NnError, ParameterBuilder};

/// ε.
const VARIANCE_FLOOR: f32 = 1e-5;

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

    /// Normalised, scaled and shifted rows.
    ///
    /// - `x`: `[…, width]`.
    /// - returns the same shape.
    ///
    /// # Errors
    /// [`NnError::InputWidth`], [`NnError::Tensor`].
    pub fn forward(&self, x: &Tensor) -> Result<Tensor, NnError> {
        let expected = self.weight.elem_count();
        if x.dims().last() != Some(&expected) {
            let (name, got) = (self.name.clone(), x.dims().to_vec());
            return Err(NnError::InputWidth { name, expected, got });
        }
        // Of candle's two versions the one that has a gradient.
        Ok(candle_nn::ops::layer_norm_slow(x, &self.weight, &self.bias, VARIANCE_FLOOR)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::Parameters;
    use crate::nn::gradient_check::{assert_gradients, random_tensor, random_variable};
    use candle_core::{DType, Var};
    use impactlab_core::numerics::random_stream;

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
    fn it_equals_the_formula_written_out() {
        let (_, norm) = layer(DType::F64, 7);
        let x = random_tensor(&[3, 7], DType::F64, 2);
        let values = |tensor: &Tensor| tensor.flatten_all().unwrap().to_vec1::<f64>().unwrap();
        let (gamma, beta) = (values(&norm.weight), values(&norm.bias));
        let got = norm.forward(&x).unwrap().to_vec2::<f64>().unwrap();
        for (row, got) in x.to_vec2::<f64>().unwrap().iter().zip(got) {
            let mean = row.iter().sum::<f64>() / 7.0;
            let variance = row.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 7.0;
            for i in 0..7 {
                let expected = gamma[i] * (row[i] - mean) / (variance + 1e-5).sqrt() + beta[i];
                assert!((got[i] - expected).abs() < 1e-9, "{i}: {} not {expected}", got[i]);
            }
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
