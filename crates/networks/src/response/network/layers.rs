//! The layers of the response network, and which of them fine-tuning changes.

use candle_core::Tensor;

use crate::nn::{
    Activation, Attention, AttentionConfig, Init, Linear, Mlp, NnError, ParameterBuilder,
};
use crate::response::network::response_network::N_COMPONENT_NUMBERS;
use crate::response::physics::vehicle_tokens::{N_TOKEN_NUMBERS, N_TOKENS};
use crate::response::{N_FEATURES, ResponseNetworkConfig};

/// The names of the tokens' encoders.
const TOKEN_NAMES: [&str; N_TOKENS] = ["mass", "geometry", "tires", "suspension"];

/// The layers, in the order in which fine-tuning leaves them alone.
#[derive(Debug, Clone)]
pub(crate) struct ResponseLayers {
    pub encoder: Mlp,
    pub token_encoders: Vec<Mlp>,
    pub attention: Attention,
    pub trunk: Mlp,
    pub head: Linear,
}

impl ResponseLayers {
    /// Adds them to the parameters; the head starts at zero.
    ///
    /// # Errors
    /// [`NnError`] for sizes that make no layer.
    pub(crate) fn new(
        root: &mut ParameterBuilder<'_>,
        config: &ResponseNetworkConfig,
    ) -> Result<Self, NnError> {
        let widths = |n_in: usize, widths: &[usize]| -> Vec<usize> {
            std::iter::once(n_in).chain(widths.iter().copied()).collect()
        };
        let hidden = config.encoder.last().copied().unwrap_or(N_FEATURES);
        let encoder = Mlp::new(
            &mut root.at("encoder"),
            &widths(N_FEATURES, &config.encoder),
            Activation::Silu,
        )?;
        let mut token_encoders = Vec::with_capacity(N_TOKENS);
        for name in TOKEN_NAMES {
            let widths = widths(N_TOKEN_NUMBERS, &config.token_encoder);
            token_encoders.push(Mlp::new(
                &mut root.at("token").at(name),
                &widths,
                Activation::Silu,
            )?);
        }
        let attention = AttentionConfig {
            channels: hidden,
            key_channels: config.token_encoder[2],
            heads: config.attention_heads,
            layer_norm: false,
        };
        let attention = Attention::new(&mut root.at("attention"), attention)?;
        let trunk =
            Mlp::new(&mut root.at("trunk"), &widths(hidden, &config.trunk), Activation::Silu)?;
        let n_out = config.components.saturating_mul(N_COMPONENT_NUMBERS);
        let head = Linear::with_init(
            &mut root.at("head"),
            [trunk.n_out(), n_out],
            Activation::None,
            Init::Zero,
        )?;
        Ok(Self { encoder, token_encoders, attention, trunk, head })
    }

    /// N: those of the encoder, the levels of the token encoders, the attention, those of the trunk
    /// and the head.
    pub(crate) fn count(&self) -> usize {
        let tokens = self.token_encoders.first().map_or(0, |encoder| encoder.layers().len());
        self.encoder.layers().len() + tokens + 1 + self.trunk.layers().len() + 1
    }

    /// The same layers, of which the first `n_layers` ask for no gradients.
    pub(crate) fn frozen_up_to(&self, n_layers: usize) -> Self {
        let mut left = n_layers;
        let mut take = |count: usize| {
            let taken = left.min(count);
            left -= taken;
            taken
        };
        let n_encoder = take(self.encoder.layers().len());
        let n_tokens = take(self.token_encoders.first().map_or(0, |mlp| mlp.layers().len()));
        let (n_attention, n_trunk) = (take(1), take(self.trunk.layers().len()));
        let n_head = take(1);
        let attention = &self.attention;
        Self {
            encoder: self.encoder.frozen_up_to(n_encoder),
            token_encoders: self
                .token_encoders
                .iter()
                .map(|encoder| encoder.frozen_up_to(n_tokens))
                .collect(),
            attention: if n_attention > 0 { attention.frozen() } else { attention.clone() },
            trunk: self.trunk.frozen_up_to(n_trunk),
            head: if n_head > 0 { self.head.frozen() } else { self.head.clone() },
        }
    }

    /// Names of the parameters of the first `n_layers`, as prefixes.
    pub(crate) fn frozen_names(&self, n_layers: usize) -> Vec<String> {
        let n_encoder = self.encoder.layers().len();
        let n_tokens = self.token_encoders.first().map_or(0, |mlp| mlp.layers().len());
        let encoder = (0..n_encoder).map(|i| vec![format!("encoder.{i}.")]);
        let tokens = (0..n_tokens)
            .map(|i| TOKEN_NAMES.iter().map(|name| format!("token.{name}.{i}.")).collect());
        let trunk = (0..self.trunk.layers().len()).map(|i| vec![format!("trunk.{i}.")]);
        let attention = std::iter::once(vec!["attention.".to_owned()]);
        let head = std::iter::once(vec!["head.".to_owned()]);
        let all = encoder.chain(tokens).chain(attention).chain(trunk).chain(head);
        all.take(n_layers).flatten().collect()
    }

    /// Encoded tokens of vehicles: `[sequences, N_TOKENS, N_TOKEN_NUMBERS]` to
    /// `[sequences, N_TOKENS, n]`.
    ///
    /// # Errors
    /// [`NnError`] for another shape.
    pub(crate) fn encoded_tokens(&self, tokens: &Tensor) -> Result<Tensor, NnError> {
        let token = |(i, encoder): (usize, &Mlp)| -> Result<Tensor, NnError> {
            encoder.forward(&tokens.narrow(1, i, 1)?.contiguous()?)
        };
        let tokens: Vec<Tensor> =
            self.token_encoders.iter().enumerate().map(token).collect::<Result<_, _>>()?;
        Ok(Tensor::cat(&tokens, 1)?)
    }
}
