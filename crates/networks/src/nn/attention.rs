//! Multi-head attention, over time or from queries to other tokens.
//!
//! ```text
//! Q = q̂ W_Q   K = k W_K   V = k W_V   A = softmax(Q Kᵀ/√d) per head   y = q + (A V) W_O
//! ```
//!
//! q̂ is the layer norm of q if switched on, else q. There are no masks.
//!
//! Source: A. Vaswani et al., Attention Is All You Need, NeurIPS 2017, section 3.2.

use candle_core::Tensor;
use serde::{Deserialize, Serialize};

use crate::nn::{
    Activation, LayerNorm, Linear, NnError, ParameterBuilder, product, product_with_transposed,
    softmax,
};

/// The sizes of an attention layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct AttentionConfig {
    /// Channels of the queries and of the result.
    pub channels: usize,
    /// Channels of the keys and values before projection; for self-attention those of the queries.
    pub key_channels: usize,
    /// Heads; they share out `channels` evenly.
    pub heads: usize,
    /// Whether the queries are normalised first (for self-attention the keys and values with them).
    pub layer_norm: bool,
}

/// Attention with a residual connection around it.
#[derive(Debug, Clone)]
pub struct Attention {
    config: AttentionConfig,
    norm: Option<LayerNorm>,
    query: Linear,
    key: Linear,
    value: Linear,
    output: Linear,
}

impl Attention {
    /// Adds the layers `norm` (if switched on), `query`, `key`, `value` and `output`.
    ///
    /// # Errors
    /// [`NnError::Indivisible`] if the heads do not share out the channels evenly,
    /// [`NnError::EmptyLayer`], [`NnError::DuplicateParameter`].
    pub fn new(
        builder: &mut ParameterBuilder<'_>,
        config: AttentionConfig,
    ) -> Result<Self, NnError> {
        let AttentionConfig { channels, key_channels, heads, layer_norm } = config;
        if heads == 0 || !channels.is_multiple_of(heads) {
            let name = builder.prefix().to_owned();
            return Err(NnError::Indivisible { name, channels, divisor: heads });
        }
        let norm = match layer_norm {
            true => Some(LayerNorm::new(&mut builder.at("norm"), channels)?),
            false => None,
        };
        let mut linear =
            |name, n_in| Linear::new(&mut builder.at(name), [n_in, channels], Activation::None);
        let (query, key) = (linear("query", channels)?, linear("key", key_channels)?);
        let (value, output) = (linear("value", key_channels)?, linear("output", channels)?);
        Ok(Self { config, norm, query, key, value, output })
    }

    /// The sizes.
    pub fn config(&self) -> AttentionConfig {
        self.config
    }

    /// The same layer without gradients of its parameters; see [`Linear::frozen`].
    #[must_use]
    pub fn frozen(&self) -> Self {
        Self {
            config: self.config,
            norm: self.norm.as_ref().map(LayerNorm::frozen),
            query: self.query.frozen(),
            key: self.key.frozen(),
            value: self.value.frozen(),
            output: self.output.frozen(),
        }
    }

    /// Attention of every instant to every instant of its own sequence.
    ///
    /// - `x`: `[batch, time, channels]`.
    /// - returns the same shape.
    ///
    /// # Errors
    /// [`NnError::InputWidth`], [`NnError::NumberType`], [`NnError::Tensor`] for another rank.
    pub fn self_attention(&self, x: &Tensor) -> Result<Tensor, NnError> {
        let normal = self.normalized(x)?;
        let seen = self.attend(&normal, &normal)?;
        Ok((x + seen)?)
    }

    /// Attention of every query to every token.
    ///
    /// - `queries`: `[batch, n_queries, channels]`.
    /// - `tokens`: `[batch, n_tokens, key_channels]`.
    /// - returns `[batch, n_queries, channels]`.
    ///
    /// # Errors
    /// [`NnError::InputWidth`], [`NnError::NumberType`], [`NnError::Tensor`] for another rank.
    pub fn cross_attention(&self, queries: &Tensor, tokens: &Tensor) -> Result<Tensor, NnError> {
        let seen = self.attend(&self.normalized(queries)?, tokens)?;
        Ok((queries + seen)?)
    }

    fn normalized(&self, x: &Tensor) -> Result<Tensor, NnError> {
        match &self.norm {
            Some(norm) => norm.forward(x),
            None => Ok(x.clone()),
        }
    }

    fn attend(&self, queries: &Tensor, tokens: &Tensor) -> Result<Tensor, NnError> {
        let (batch, n_queries, channels) = queries.dims3()?;
        let head_channels = channels / self.config.heads;
        let heads = |x: Tensor| -> Result<Tensor, NnError> {
            let (batch, n, _) = x.dims3()?;
            let x = x.reshape((batch, n, self.config.heads, head_channels))?;
            Ok(x.transpose(1, 2)?.contiguous()?)
        };
        let query = heads(self.query.forward(queries)?)?;
        let key = heads(self.key.forward(tokens)?)?;
        let value = heads(self.value.forward(tokens)?)?;
        let scale = 1.0 / (head_channels as f64).sqrt();
        let weights = softmax(&product_with_transposed(&query, &key)?, scale)?;
        let seen = product(&weights, &value)?.transpose(1, 2)?;
        self.output.forward(&seen.reshape((batch, n_queries, channels))?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::Parameters;
    use crate::nn::gradient_check::{
        assert_close, assert_gradients, random_tensor, random_variable,
    };
    use candle_core::{D, DType, IndexOp, Var};
    use impactlab_core::numerics::random_stream;

    fn layer(config: AttentionConfig, number_type: DType) -> (Parameters, Attention) {
        let mut parameters = Parameters::new(number_type);
        let mut rng = random_stream(5, "weights", 0);
        let mut root = parameters.builder(&mut rng);
        let attention = Attention::new(&mut root.at("attention"), config).unwrap();
        for (i, (_, variable)) in parameters.iter().enumerate() {
            variable.set(&random_tensor(variable.dims(), number_type, 40 + i as u64)).unwrap();
        }
        (parameters, attention)
    }

    fn config(layer_norm: bool) -> AttentionConfig {
        AttentionConfig { channels: 4, key_channels: 3, heads: 2, layer_norm }
    }

    #[test]
    fn self_attention_has_the_gradients_of_central_differences() {
        for layer_norm in [false, true] {
            let config = AttentionConfig { key_channels: 4, ..config(layer_norm) };
            let (parameters, attention) = layer(config, DType::F64);
            let x = random_variable(&[2, 3, 4], 1);
            let all = parameters.iter().map(|(_, v)| v.clone()).chain([x.clone()]);
            let all: Vec<Var> = all.collect();
            assert_gradients(&all, || attention.self_attention(&x).unwrap());
        }
    }

    #[test]
    fn cross_attention_has_the_gradients_of_central_differences() {
        for layer_norm in [false, true] {
            let (parameters, attention) = layer(config(layer_norm), DType::F64);
            let (x, tokens) = (random_variable(&[2, 3, 4], 1), random_variable(&[2, 5, 3], 2));
            let all = parameters.iter().map(|(_, v)| v.clone()).chain([x.clone(), tokens.clone()]);
            let all: Vec<Var> = all.collect();
            assert_gradients(&all, || attention.cross_attention(&x, &tokens).unwrap());
        }
    }

    /// The formula written out for one batch and one head after the other.
    fn plain(attention: &Attention, queries: &Tensor, tokens: &Tensor) -> Tensor {
        let project = |layer: &Linear, x: &Tensor| layer.forward(x).unwrap();
        let (q, k) = (project(&attention.query, queries), project(&attention.key, tokens));
        let v = project(&attention.value, tokens);
        let head = |b: usize, h: usize| {
            let part = |x: &Tensor| x.i((b, .., 2 * h..2 * h + 2)).unwrap().contiguous().unwrap();
            let scores = part(&q).matmul(&part(&k).t().unwrap()).unwrap();
            let scores = (scores / 2f64.sqrt()).unwrap();
            candle_nn::ops::softmax(&scores, D::Minus1).unwrap().matmul(&part(&v)).unwrap()
        };
        let batches: Vec<Tensor> =
            (0..2).map(|b| Tensor::cat(&[head(b, 0), head(b, 1)], 1).unwrap()).collect();
        let seen = Tensor::stack(&batches, 0).unwrap();
        (queries + project(&attention.output, &seen)).unwrap()
    }

    #[test]
    fn it_equals_the_formula_written_out() {
        let (_, attention) = layer(config(false), DType::F32);
        let queries = random_tensor(&[2, 7, 4], DType::F32, 1);
        let tokens = random_tensor(&[2, 5, 3], DType::F32, 2);
        let got = attention.cross_attention(&queries, &tokens).unwrap();
        assert_close(&got, &plain(&attention, &queries, &tokens), 1e-5);
    }

    #[test]
    fn sequences_of_other_shapes_are_refused() {
        let (_, attention) = layer(config(false), DType::F32);
        let queries = random_tensor(&[2, 7, 4], DType::F32, 1);
        for dims in [&[3, 5, 3][..], &[10, 3], &[2, 5, 4]] {
            let tokens = random_tensor(dims, DType::F32, 2);
            assert!(attention.cross_attention(&queries, &tokens).is_err(), "{dims:?}");
        }
    }

    #[test]
    fn heads_must_share_out_the_channels() {
        let mut parameters = Parameters::new(DType::F32);
        let mut rng = random_stream(5, "weights", 0);
        let mut root = parameters.builder(&mut rng);
        for heads in [0, 3] {
            let config = AttentionConfig { heads, ..config(false) };
            let error = Attention::new(&mut root.at("a"), config).unwrap_err().to_string();
            assert_eq!(error, format!("a: 4 channels cannot be divided by {heads}"));
        }
    }
}
