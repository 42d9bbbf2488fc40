//! Cross-attention to the tokens of one vehicle, which do not change along a motion, as two tables.

use candle_core::Tensor;

use crate::nn::{NnError, product, product_with_transposed};
use crate::response::network::one_step::token_tensor;
use crate::response::network::response_network::ResponseNetwork;
use impactlab_core::vehicle::VehicleParameters;

/// Cross-attention to the tokens of one vehicle, folded: `h ← h + softmax_per_head(h S + s₀) U + u₀`.
pub(crate) struct FoldedAttention {
    /// S: `[hidden, heads · tokens]`, tokens of a head together.
    pub scores: Tensor,
    /// s₀.
    pub scores_bias: Tensor,
    /// U: `[heads · tokens, hidden]`.
    pub seen: Tensor,
    /// u₀.
    pub seen_bias: Tensor,
    /// Tokens.
    pub n_tokens: usize,
}

impl FoldedAttention {
    /// The attention to a vehicle.
    ///
    /// # Errors
    /// [`NnError`] if a tensor cannot be read.
    pub(crate) fn new(
        network: &ResponseNetwork,
        vehicle: &VehicleParameters,
    ) -> Result<Self, NnError> {
        let tokens = network.layers().encoded_tokens(&token_tensor(vehicle)?)?.squeeze(0)?;
        let get = |name: &str| {
            let name = format!("attention.{name}");
            let found =
                network.parameters().get(&name).map(|variable| variable.as_detached_tensor());
            found.ok_or(NnError::MissingTensor { name })
        };
        let project = |name: &str| -> Result<Tensor, NnError> {
            let weighted = product_with_transposed(&tokens, &get(&format!("{name}.weight"))?)?;
            Ok(weighted.broadcast_add(&get(&format!("{name}.bias"))?)?)
        };
        let (keys, values) = (project("key")?, project("value")?);
        let (query, query_bias) = (get("query.weight")?, get("query.bias")?);
        let (output, output_bias) = (get("output.weight")?, get("output.bias")?);
        let heads = network.config().attention_heads;
        let (n_tokens, hidden) = keys.dims2()?;
        let width = hidden / heads.max(1);
        let scale = 1.0 / (width as f64).sqrt();
        let (mut scores, mut biases, mut seen) = (Vec::new(), Vec::new(), Vec::new());
        for head in 0..heads {
            let of_head =
                |tensor: &Tensor, dim: usize| tensor.narrow(dim, head * width, width)?.contiguous();
            let keys = (of_head(&keys, 1)? * scale)?;
            // [tokens, width] · [width, hidden]
            scores.push(product(&keys, &of_head(&query, 0)?)?);
            biases.push(product(&keys, &of_head(&query_bias, 0)?.unsqueeze(1)?)?.squeeze(1)?);
            // [tokens, width] · [width, hidden]
            seen.push(product_with_transposed(&of_head(&values, 1)?, &of_head(&output, 1)?)?);
        }
        Ok(Self {
            scores: Tensor::cat(&scores, 0)?.t()?.contiguous()?.detach(),
            scores_bias: Tensor::cat(&biases, 0)?.detach(),
            seen: Tensor::cat(&seen, 0)?.detach(),
            seen_bias: output_bias,
            n_tokens,
        })
    }
}
