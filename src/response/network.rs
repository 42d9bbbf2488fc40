//! The response network: from state, force, time and vehicle to the distribution of the residual
//! acceleration.
//!
//! ```text
//! h = encoder(features)                              token_k = encoder_k(Θ_k)
//! h ← h + attention(h, tokens)
//! [z_μ, z_σ, z_ω]_j = head(trunk(h))                 j = 1 … J
//! a_j = a_bound ⊙ tanh(z_μ,j)     σ_j² = σ_min² + exp z_σ,j     ω = softmax z_ω
//! ```
//!
//! Mirror symmetry by construction: z is the mean of the answers to the motion and, mirrored back,
//! to the mirrored motion.
//!
//! Source: `eq:Adaptive_pinn` to `eq:VSD_PINN_swish` of
//! [`PitPinnPaper`](crate::bibliography::PitPinnPaper); the paper's formula leaves the state out of
//! the features and adds z to the state, here it is an acceleration.

use candle_core::{D, DType, Device, Tensor};
use rand_chacha::ChaCha8Rng;

use crate::nn::{Activation, Attention, AttentionConfig, Init, Linear, Mlp, NnError, Parameters};
use crate::response::vehicle_tokens::{N_TOKEN_NUMBERS, N_TOKENS};
use crate::response::{
    FEATURE_MIRROR, N_FEATURES, N_RESIDUAL, RESIDUAL_MIRROR, ResponseNetworkConfig,
};

/// Numbers of a component: z_μ, z_σ and z_ω.
const N_COMPONENT_NUMBERS: usize = 2 * N_RESIDUAL + 1;

/// The names of the tokens' encoders.
const TOKEN_NAMES: [&str; N_TOKENS] = ["mass", "geometry", "tires", "suspension"];

/// The network with its parameters.
#[derive(Debug)]
pub(crate) struct ResponseNetwork {
    config: ResponseNetworkConfig,
    parameters: Parameters,
    layers: Layers,
    /// The same, for predictions.
    frozen: Layers,
    feature_mirror: Tensor,
    output_mirror: Tensor,
}

#[derive(Debug)]
struct Layers {
    encoder: Mlp,
    token_encoders: Vec<Mlp>,
    attention: Attention,
    trunk: Mlp,
    head: Linear,
}

impl Layers {
    /// The same layers, which ask for no gradients.
    fn frozen(&self) -> Self {
        Self {
            encoder: self.encoder.frozen(),
            token_encoders: self.token_encoders.iter().map(Mlp::frozen).collect(),
            attention: self.attention.frozen(),
            trunk: self.trunk.frozen(),
            head: self.head.frozen(),
        }
    }
}

/// What the network says of instants.
#[derive(Debug, Clone)]
pub(crate) struct ResponseOutput {
    /// a_j, m/s² and rad/s², `[sequences, instants, J, 4]`.
    pub residual: Tensor,
    /// z_σ,j, `[sequences, instants, J, 4]`.
    pub log_variance: Tensor,
    /// z_ω,j, `[sequences, instants, J]`.
    pub logits: Tensor,
}

impl ResponseNetwork {
    /// With weights drawn from `rng`; its residual starts at zero.
    ///
    /// # Errors
    /// [`NnError`] for sizes that make no layer.
    pub(crate) fn new(
        config: &ResponseNetworkConfig,
        rng: &mut ChaCha8Rng,
    ) -> Result<Self, NnError> {
        let mut parameters = Parameters::new(DType::F64);
        let mut root = parameters.builder(rng);
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
        let n_out = config.components * N_COMPONENT_NUMBERS;
        let head = Linear::with_init(
            &mut root.at("head"),
            [trunk.n_out(), n_out],
            Activation::None,
            Init::Zero,
        )?;
        let component: Vec<f64> =
            RESIDUAL_MIRROR.into_iter().chain([1.0; N_RESIDUAL + 1]).collect();
        let layers = Layers { encoder, token_encoders, attention, trunk, head };
        Ok(Self {
            frozen: layers.frozen(),
            layers,
            feature_mirror: Tensor::new(&FEATURE_MIRROR, &Device::Cpu)?,
            output_mirror: Tensor::from_vec(component, N_COMPONENT_NUMBERS, &Device::Cpu)?,
            config: config.clone(),
            parameters,
        })
    }

    pub(crate) fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// J.
    pub(crate) fn n_components(&self) -> usize {
        self.config.components
    }

    /// The distribution of the residual acceleration.
    ///
    /// - `features`: `[sequences, instants, N_FEATURES]`, f64;
    /// - `tokens`: of each sequence's vehicle, `[sequences, N_TOKENS, N_TOKEN_NUMBERS]`, f64.
    ///
    /// # Errors
    /// [`NnError`] for other shapes.
    pub(crate) fn forward(
        &self,
        features: &Tensor,
        tokens: &Tensor,
    ) -> Result<ResponseOutput, NnError> {
        self.forward_by(&self.layers, features, tokens)
    }

    /// [`ResponseNetwork::forward`] without a graph for gradients.
    ///
    /// # Errors
    /// As for [`ResponseNetwork::forward`].
    pub(crate) fn forward_frozen(
        &self,
        features: &Tensor,
        tokens: &Tensor,
    ) -> Result<ResponseOutput, NnError> {
        self.forward_by(&self.frozen, features, tokens)
    }

    fn forward_by(
        &self,
        layers: &Layers,
        features: &Tensor,
        tokens: &Tensor,
    ) -> Result<ResponseOutput, NnError> {
        let (n_sequences, n_instants, _) = features.dims3()?;
        let mirrored = features.broadcast_mul(&self.feature_mirror)?;
        let hidden = layers.encoder.forward(&Tensor::cat(&[features, &mirrored], 1)?)?;
        let token = |(i, encoder): (usize, &Mlp)| -> Result<Tensor, NnError> {
            encoder.forward(&tokens.narrow(1, i, 1)?.contiguous()?)
        };
        let tokens: Vec<Tensor> =
            layers.token_encoders.iter().enumerate().map(token).collect::<Result<_, _>>()?;
        let hidden = layers.attention.cross_attention(&hidden, &Tensor::cat(&tokens, 1)?)?;
        let raw = layers.head.forward(&layers.trunk.forward(&hidden)?)?;
        let shape = (n_sequences, 2 * n_instants, self.config.components, N_COMPONENT_NUMBERS);
        let raw = raw.reshape(shape)?;
        let other = raw.narrow(1, n_instants, n_instants)?.broadcast_mul(&self.output_mirror)?;
        let raw = ((raw.narrow(1, 0, n_instants)? + other)? * 0.5)?;
        let mean = raw.narrow(D::Minus1, 0, N_RESIDUAL)?;
        let bound = Tensor::new(&self.config.bound, &Device::Cpu)?;
        Ok(ResponseOutput {
            residual: mean.tanh()?.broadcast_mul(&bound)?,
            log_variance: raw.narrow(D::Minus1, N_RESIDUAL, N_RESIDUAL)?,
            logits: raw.narrow(D::Minus1, 2 * N_RESIDUAL, 1)?.squeeze(D::Minus1)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::gradient_check::{assert_close, random_tensor};
    use crate::nn::random_stream;

    fn network() -> ResponseNetwork {
        let config = ResponseNetworkConfig::default();
        let network = ResponseNetwork::new(&config, &mut random_stream(3, "test", 0)).unwrap();
        // A head that says something.
        for (i, (_, variable)) in network.parameters.iter().enumerate() {
            let values = random_tensor(variable.dims(), DType::F64, i as u64);
            variable.set(&(values * 0.3).unwrap()).unwrap();
        }
        network
    }

    #[test]
    fn mirrored_in_mirrored_out() {
        let network = network();
        let features = random_tensor(&[2, 3, N_FEATURES], DType::F64, 100);
        let tokens = random_tensor(&[2, N_TOKENS, N_TOKEN_NUMBERS], DType::F64, 101);
        let plain = network.forward(&features, &tokens).unwrap();
        let mirrored = features.broadcast_mul(&network.feature_mirror).unwrap();
        let other = network.forward(&mirrored, &tokens).unwrap();
        let signs = Tensor::new(&RESIDUAL_MIRROR, &Device::Cpu).unwrap();
        assert_close(&other.residual.broadcast_mul(&signs).unwrap(), &plain.residual, 1e-12);
        assert_close(&other.log_variance, &plain.log_variance, 1e-12);
        assert_close(&other.logits, &plain.logits, 1e-12);
    }

    #[test]
    fn the_residual_starts_at_zero_and_stays_within_its_bound() {
        let config = ResponseNetworkConfig::default();
        let fresh = ResponseNetwork::new(&config, &mut random_stream(3, "test", 0)).unwrap();
        let features = (random_tensor(&[1, 4, N_FEATURES], DType::F64, 1) * 1e3).unwrap();
        let tokens = random_tensor(&[1, N_TOKENS, N_TOKEN_NUMBERS], DType::F64, 2);
        let values = |network: &ResponseNetwork| -> Vec<f64> {
            let output = network.forward(&features, &tokens).unwrap();
            output.residual.flatten_all().unwrap().to_vec1().unwrap()
        };
        assert!(values(&fresh).iter().all(|value| *value == 0.0));
        let bounded = |(i, value): (usize, &f64)| value.abs() <= config.bound[i % N_RESIDUAL];
        assert!(values(&network()).iter().enumerate().all(bounded));
    }
}
