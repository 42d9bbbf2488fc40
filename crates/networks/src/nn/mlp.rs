//! Stacks of fully connected layers, and several of them side by side.

use candle_core::{D, Tensor};

use crate::nn::{Activation, Linear, NnError, ParameterBuilder};

/// Fully connected layers one after the other, all but perhaps the last with Swish.
#[derive(Debug, Clone)]
pub struct Mlp {
    layers: Vec<Linear>,
}

impl Mlp {
    /// One layer per pair of neighbouring widths; layer i is named `i`.
    ///
    /// - `widths`: the input's first, so at least two.
    /// - `last`: what follows the last layer; all others have Swish.
    ///
    /// # Errors
    /// [`NnError::EmptyLayer`], [`NnError::DuplicateParameter`].
    pub fn new(
        builder: &mut ParameterBuilder<'_>,
        widths: &[usize],
        last: Activation,
    ) -> Result<Self, NnError> {
        let n_layers = widths.len().saturating_sub(1);
        if n_layers == 0 {
            let name = builder.prefix().to_owned();
            return Err(NnError::EmptyLayer { name, widths: widths.to_vec() });
        }
        let mut layers = Vec::with_capacity(n_layers);
        for (i, pair) in widths.windows(2).enumerate() {
            let activation = if i + 1 == n_layers { last } else { Activation::Silu };
            layers.push(Linear::new(&mut builder.at(i), [pair[0], pair[1]], activation)?);
        }
        Ok(Self { layers })
    }

    /// The layers, from the input on.
    pub fn layers(&self) -> &[Linear] {
        &self.layers
    }

    /// How many values a row of the result has.
    pub fn n_out(&self) -> usize {
        self.layers.last().map_or(0, |layer| layer.widths()[1])
    }

    /// The same stack without gradients of its parameters; see [`Linear::frozen`].
    #[must_use]
    pub fn frozen(&self) -> Self {
        self.frozen_up_to(self.layers.len())
    }

    /// The same stack without gradients of the parameters of the first `n_layers`.
    #[must_use]
    pub fn frozen_up_to(&self, n_layers: usize) -> Self {
        let freeze = |(i, layer): (usize, &Linear)| {
            if i < n_layers { layer.frozen() } else { layer.clone() }
        };
        Self { layers: self.layers.iter().enumerate().map(freeze).collect() }
    }

    /// All layers, one after the other.
    ///
    /// - `x`: `[…, n_in]`.
    /// - returns `[…, n_out]`.
    ///
    /// # Errors
    /// [`NnError::InputWidth`], [`NnError::NumberType`].
    pub fn forward(&self, x: &Tensor) -> Result<Tensor, NnError> {
        self.layers.iter().try_fold(x.clone(), |x, layer| layer.forward(&x))
    }
}

/// Several branches of three Swish layers of different widths, side by side: each sees the same
/// features, their results are put together.
#[derive(Debug, Clone)]
pub struct MultiScaleEncoder {
    branches: Vec<Mlp>,
}

impl MultiScaleEncoder {
    /// One branch per triple of widths; branch i is named `i`.
    ///
    /// # Errors
    /// [`NnError::EmptyLayer`], [`NnError::DuplicateParameter`].
    pub fn new(
        builder: &mut ParameterBuilder<'_>,
        n_in: usize,
        branches: &[[usize; 3]],
    ) -> Result<Self, NnError> {
        if branches.is_empty() {
            let name = builder.prefix().to_owned();
            return Err(NnError::EmptyLayer { name, widths: vec![n_in] });
        }
        let mut built = Vec::with_capacity(branches.len());
        for (i, &[first, second, third]) in branches.iter().enumerate() {
            let widths = [n_in, first, second, third];
            built.push(Mlp::new(&mut builder.at(i), &widths, Activation::Silu)?);
        }
        Ok(Self { branches: built })
    }

    /// How many values a row of the result has: the last widths of all branches together.
    pub fn n_out(&self) -> usize {
        self.branches.iter().map(Mlp::n_out).sum()
    }

    /// The same encoder without gradients of its parameters; see [`Linear::frozen`].
    #[must_use]
    pub fn frozen(&self) -> Self {
        Self { branches: self.branches.iter().map(Mlp::frozen).collect() }
    }

    /// The results of all branches, one after the other.
    ///
    /// - `x`: `[…, n_in]`.
    /// - returns `[…, n_out]`.
    ///
    /// # Errors
    /// [`NnError::InputWidth`], [`NnError::NumberType`].
    pub fn forward(&self, x: &Tensor) -> Result<Tensor, NnError> {
        let branches = self.branches.iter().map(|branch| branch.forward(x));
        let results = branches.collect::<Result<Vec<_>, _>>()?;
        Ok(Tensor::cat(&results, D::Minus1)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::Parameters;
    use crate::nn::gradient_check::{assert_gradients, random_variable};
    use candle_core::{DType, Var};
    use impactlab_core::numerics::random_stream;

    fn build<L>(
        make: impl FnOnce(&mut ParameterBuilder<'_>) -> Result<L, NnError>,
    ) -> (Parameters, Result<L, NnError>) {
        let mut parameters = Parameters::new(DType::F64);
        let mut rng = random_stream(5, "weights", 0);
        let made = make(&mut parameters.builder(&mut rng).at("part"));
        (parameters, made)
    }

    fn variables(parameters: &Parameters, x: &Var) -> Vec<Var> {
        parameters.iter().map(|(_, variable)| variable.clone()).chain([x.clone()]).collect()
    }

    #[test]
    fn a_stack_has_the_gradients_of_central_differences() {
        let (parameters, mlp) = build(|at| Mlp::new(at, &[3, 5, 4, 2], Activation::None));
        let (mlp, x) = (mlp.unwrap(), random_variable(&[6, 3], 1));
        assert_eq!((mlp.n_out(), mlp.layers().len()), (2, 3));
        assert_gradients(&variables(&parameters, &x), || mlp.forward(&x).unwrap());
    }

    /// Result, then gradients of all parameters and of x.
    fn results(parameters: &Parameters, x: &Var, forward: impl Fn(&Var) -> Tensor) -> Vec<Tensor> {
        let y = forward(x);
        let gradients = y.sqr().unwrap().mean_all().unwrap().backward().unwrap();
        let gradient = |variable: &Var| gradients.get(variable).unwrap().clone();
        let all = parameters.iter().map(|(_, variable)| gradient(variable));
        let all: Vec<Tensor> = all.chain([gradient(x)]).collect();
        [vec![y], all].concat()
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let run = |n_threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
            let (parameters, mlp) = build(|at| Mlp::new(at, &[3, 70, 60, 2], Activation::Silu));
            let (mlp, x) = (mlp.unwrap(), random_variable(&[3000, 3], 1));
            let all = pool.install(|| results(&parameters, &x, |x| mlp.forward(x).unwrap()));
            let values = all.iter().map(|t| t.flatten_all().unwrap().to_vec1::<f64>().unwrap());
            values.flatten().map(f64::to_bits).collect::<Vec<_>>()
        };
        let one = run(1);
        assert!(run(1) == one && run(2) == one && run(3) == one);
    }

    #[test]
    fn no_rows_give_no_rows() {
        let (_, mlp) = build(|at| Mlp::new(at, &[3, 5, 2], Activation::Silu));
        let (mlp, x) = (mlp.unwrap(), random_variable(&[0, 3], 1));
        assert_eq!(mlp.forward(&x).unwrap().dims(), [0, 2]);
        assert_eq!(mlp.frozen().forward(&x.detach()).unwrap().dims(), [0, 2]);
    }

    #[test]
    fn the_encoder_puts_its_branches_side_by_side() {
        let branches = [[4, 3, 2], [2, 2, 3]];
        let (parameters, encoder) = build(|at| MultiScaleEncoder::new(at, 3, &branches));
        let (encoder, x) = (encoder.unwrap(), random_variable(&[2, 3, 3], 1));
        let y = encoder.forward(&x).unwrap();
        assert_eq!((y.dims(), encoder.n_out()), ([2, 3, 5].as_slice(), 5));
        assert!(parameters.get("part.1.2.weight").is_some());
        assert_gradients(&variables(&parameters, &x), || encoder.forward(&x).unwrap());
    }

    #[test]
    fn frozen_layers_take_no_gradient() {
        let (parameters, mlp) = build(|at| Mlp::new(at, &[3, 5, 4, 2], Activation::None));
        let (mlp, x) = (mlp.unwrap().frozen_up_to(2), random_variable(&[6, 3], 1));
        let gradients = mlp.forward(&x).unwrap().mean_all().unwrap().backward().unwrap();
        let has = |name| gradients.get(parameters.get(name).unwrap()).is_some();
        assert!(!has("part.0.weight") && !has("part.1.bias") && has("part.2.weight"));
    }

    #[test]
    fn a_stack_needs_widths() {
        for widths in [&[][..], &[3], &[3, 0, 2]] {
            let (_, mlp) = build(|at| Mlp::new(at, widths, Activation::None));
            let error = mlp.unwrap_err();
            assert!(matches!(error, NnError::EmptyLayer { .. }), "{widths:?}: {error}");
        }
        let (_, encoder) = build(|at| MultiScaleEncoder::new(at, 3, &[]));
        assert!(matches!(encoder, Err(NnError::EmptyLayer { .. })));
    }
}
