//! The response network: from state, force, time and vehicle to the distribution of the residual
//! acceleration.
//!
//! ```text
//! h = encoder(features)                              token_k = encoder_k(Θ_k)
//! h ← h + attention(h, tokens)
//! [z_μ, z_σ, z_ω]_j = head(trunk(h))                 j = 1 … J
//! δ_j = Σ_k c_jk e_k(x, u)
//! a_j = a_bound ⊙ tanh((δ_j + u ⊙ z_μ,j)/a_bound)     σ_j² = σ_min² + exp z_σ,j     ω = softmax z_ω
//! ```
//!
//! δ_j is the learned correction of the physics, of known form and with strengths c_j of its own in
//! each component: what makes a component a way to drive off, and not a noise of single steps.
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
use crate::response::one_step::token_tensor;
use crate::response::vehicle_tokens::{N_TOKEN_NUMBERS, N_TOKENS};
use crate::response::{
    Correction, FEATURE_MIRROR, IS_OF_MODEL, N_EFFECTS, N_FEATURES, N_RESIDUAL, RESIDUAL_MIRROR,
    ResponseNetworkConfig,
};
use crate::vehicle::VehicleParameters;

/// Numbers of a component: z_μ, z_σ and z_ω.
const N_COMPONENT_NUMBERS: usize = 2 * N_RESIDUAL + 1;

/// States with soft boundaries, and these: v_x, v_y, m/s, r, φ̇, rad/s, φ, rad. A struck car that
/// moves faster than these, or leans further, is none that is modelled here.
pub(crate) const BOUNDED_STATES: [(usize, f64); 5] =
    [(0, 60.0), (1, 60.0), (3, 8.0), (5, 4.0), (4, 0.5)];

/// s at first, in units of the bound.
const FIRST_BOUNDARY_SCALE: f64 = 0.05;

/// The names of the tokens' encoders.
const TOKEN_NAMES: [&str; N_TOKENS] = ["mass", "geometry", "tires", "suspension"];

/// The network with its parameters.
#[derive(Debug)]
pub(crate) struct ResponseNetwork {
    config: ResponseNetworkConfig,
    parameters: Parameters,
    layers: Layers,
    /// The same, without gradients of the first ones.
    fine_tuned: Layers,
    /// c, `[J, N_EFFECTS]`.
    strengths: Tensor,
    /// ln s of the soft boundaries, `[5]`.
    boundary_log_scale: Tensor,
    feature_mirror: Tensor,
    /// 0 for what is not to be seen.
    feature_mask: Tensor,
    output_mirror: Tensor,
}

#[derive(Debug, Clone)]
struct Layers {
    encoder: Mlp,
    token_encoders: Vec<Mlp>,
    attention: Attention,
    trunk: Mlp,
    head: Linear,
}

impl Layers {
    /// N: those of the encoder, the levels of the token encoders, the attention, those of the trunk
    /// and the head.
    fn count(&self) -> usize {
        let tokens = self.token_encoders.first().map_or(0, |encoder| encoder.layers().len());
        self.encoder.layers().len() + tokens + 1 + self.trunk.layers().len() + 1
    }

    /// The same layers, of which the first `n_layers` ask for no gradients.
    fn frozen_up_to(&self, n_layers: usize) -> Self {
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
    fn frozen_names(&self, n_layers: usize) -> Vec<String> {
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
}

/// Which layers give gradients.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Gradients {
    /// All: pre-training.
    All,
    /// Those that fine-tuning changes.
    FineTuned,
}

/// What the network says of instants.
#[derive(Debug, Clone)]
pub(crate) struct ResponseOutput {
    /// a_j, m/s² and rad/s², `[sequences, instants, J, 4]`.
    pub residual: Tensor,
    /// z_μ,j: what the network adds to the effects, in its units, same shape.
    pub remainder: Tensor,
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
        let effects = [config.components, N_EFFECTS];
        let strengths = root.at("effects").add("strengths", &effects, Init::Zero)?;
        let boundary_log_scale =
            root.at("boundary").add("log_scale", &[BOUNDED_STATES.len()], Init::Zero)?;
        let component: Vec<f64> =
            RESIDUAL_MIRROR.into_iter().chain([1.0; N_RESIDUAL + 1]).collect();
        let layers = Layers { encoder, token_encoders, attention, trunk, head };
        Ok(Self {
            fine_tuned: layers.clone(),
            layers,
            strengths,
            boundary_log_scale,
            feature_mirror: Tensor::new(&FEATURE_MIRROR, &Device::Cpu)?,
            feature_mask: Tensor::new(&feature_mask(config.correction), &Device::Cpu)?,
            output_mirror: Tensor::from_vec(component, N_COMPONENT_NUMBERS, &Device::Cpu)?,
            config: config.clone(),
            parameters,
        })
    }

    pub(crate) fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The settings.
    pub(crate) fn config(&self) -> &ResponseNetworkConfig {
        &self.config
    }

    /// From now on fine-tuning leaves the first `⌊share · N⌋` of the N layers as they are, and, where
    /// they are not wanted, the strengths of the effects.
    pub(crate) fn freeze(&mut self, share: f64) {
        let n_frozen = (share * self.layers.count() as f64).floor() as usize;
        self.fine_tuned = self.layers.frozen_up_to(n_frozen);
        let frozen = self.layers.frozen_names(n_frozen);
        let has_effects = self.config.effects;
        self.parameters.set_trained(|name| {
            let is_frozen = frozen.iter().any(|prefix| name.starts_with(prefix.as_str()));
            !is_frozen && (has_effects || !name.starts_with("effects."))
        });
    }

    /// From now on the network adds nothing to the effects until it is trained again.
    pub(crate) fn silence(&self) -> Result<(), NnError> {
        for (name, variable) in self.parameters.iter() {
            if name.starts_with("head.") {
                variable.set(&variable.zeros_like()?)?;
            }
        }
        Ok(())
    }

    /// Gives all components these strengths of the effects.
    pub(crate) fn set_strengths(&self, strengths: &[f64]) -> Result<(), NnError> {
        let row = Tensor::new(strengths, &Device::Cpu)?.unsqueeze(0)?;
        let all = row.broadcast_as((self.config.components, N_EFFECTS))?.contiguous()?;
        match self.parameters.get("effects.strengths") {
            Some(variable) => Ok(variable.set(&all)?),
            None => Ok(()),
        }
    }

    /// Strengths of the effects in each component, `[J, N_EFFECTS]`.
    pub(crate) fn strengths(&self) -> &Tensor {
        &self.strengths
    }

    /// s of the soft boundaries, positive, `[5]`, in units of the bounds of [`BOUNDED_STATES`].
    pub(crate) fn boundary_scale(&self) -> Result<Tensor, NnError> {
        Ok((self.boundary_log_scale.exp()? * FIRST_BOUNDARY_SCALE)?)
    }

    /// The attention to a vehicle.
    ///
    /// # Errors
    /// [`NnError`] if a tensor cannot be read.
    pub(crate) fn folded_attention(
        &self,
        vehicle: &VehicleParameters,
    ) -> Result<FoldedAttention, NnError> {
        let tokens = self.encoded_tokens(&self.layers, &token_tensor(vehicle)?)?.squeeze(0)?;
        let get = |name: &str| {
            let name = format!("attention.{name}");
            let found = self.parameters.get(&name).map(|variable| variable.as_detached_tensor());
            found.ok_or(NnError::MissingTensor { name })
        };
        let project = |name: &str| -> Result<Tensor, NnError> {
            let weight = get(&format!("{name}.weight"))?;
            Ok(tokens.matmul(&weight.t()?)?.broadcast_add(&get(&format!("{name}.bias"))?)?)
        };
        let (keys, values) = (project("key")?, project("value")?);
        let (query, query_bias) = (get("query.weight")?, get("query.bias")?);
        let (output, output_bias) = (get("output.weight")?, get("output.bias")?);
        let heads = self.config.attention_heads;
        let (n_tokens, hidden) = keys.dims2()?;
        let width = hidden / heads.max(1);
        let scale = 1.0 / (width as f64).sqrt();
        let (mut scores, mut biases, mut seen) = (Vec::new(), Vec::new(), Vec::new());
        for head in 0..heads {
            let of_head =
                |tensor: &Tensor, dim: usize| tensor.narrow(dim, head * width, width)?.contiguous();
            let keys = (of_head(&keys, 1)? * scale)?;
            // [tokens, width] · [width, hidden]
            scores.push(keys.matmul(&of_head(&query, 0)?)?);
            biases.push(keys.matmul(&of_head(&query_bias, 0)?.unsqueeze(1)?)?.squeeze(1)?);
            // [tokens, width] · [width, hidden]
            seen.push(of_head(&values, 1)?.matmul(&of_head(&output, 1)?.t()?.contiguous()?)?);
        }
        Ok(FoldedAttention {
            scores: Tensor::cat(&scores, 0)?.t()?.contiguous()?.detach(),
            scores_bias: Tensor::cat(&biases, 0)?.detach(),
            seen: Tensor::cat(&seen, 0)?.detach(),
            seen_bias: output_bias,
            n_tokens,
        })
    }

    fn encoded_tokens(&self, layers: &Layers, tokens: &Tensor) -> Result<Tensor, NnError> {
        let token = |(i, encoder): (usize, &Mlp)| -> Result<Tensor, NnError> {
            encoder.forward(&tokens.narrow(1, i, 1)?.contiguous()?)
        };
        let tokens: Vec<Tensor> =
            layers.token_encoders.iter().enumerate().map(token).collect::<Result<_, _>>()?;
        Ok(Tensor::cat(&tokens, 1)?)
    }

    /// 1 for the features that the network sees, 0 for others.
    pub(crate) fn feature_mask_values(&self) -> [f64; N_FEATURES] {
        feature_mask(self.config.correction)
    }

    /// J.
    pub(crate) fn n_components(&self) -> usize {
        self.config.components
    }

    /// The distribution of the residual acceleration.
    ///
    /// - `features`: `[sequences, instants, N_FEATURES]`, f64;
    /// - `tokens`: of each sequence's vehicle, `[sequences, N_TOKENS, N_TOKEN_NUMBERS]`, f64;
    /// - `effects`: δ_j, `[sequences, instants, J or 1, 4]`, f64.
    ///
    /// # Errors
    /// [`NnError`] for other shapes.
    pub(crate) fn forward(
        &self,
        gradients: Gradients,
        [features, tokens, effects]: [&Tensor; 3],
    ) -> Result<ResponseOutput, NnError> {
        let layers = match gradients {
            Gradients::All => &self.layers,
            Gradients::FineTuned => &self.fine_tuned,
        };
        let (n_sequences, n_instants, _) = features.dims3()?;
        let features = features.broadcast_mul(&self.feature_mask)?;
        let mirrored = features.broadcast_mul(&self.feature_mirror)?;
        let hidden = layers.encoder.forward(&Tensor::cat(&[features, mirrored], 1)?)?;
        let tokens = self.encoded_tokens(layers, tokens)?;
        let hidden = layers.attention.cross_attention(&hidden, &tokens)?;
        let raw = layers.head.forward(&layers.trunk.forward(&hidden)?)?;
        let shape = (n_sequences, 2 * n_instants, self.config.components, N_COMPONENT_NUMBERS);
        let raw = raw.reshape(shape)?;
        let other = raw.narrow(1, n_instants, n_instants)?.broadcast_mul(&self.output_mirror)?;
        let raw = ((raw.narrow(1, 0, n_instants)? + other)? * 0.5)?;
        let mean = raw.narrow(D::Minus1, 0, N_RESIDUAL)?;
        let remainder = mean.broadcast_mul(&Tensor::new(&self.config.unit, &Device::Cpu)?)?;
        let free = remainder.broadcast_add(effects)?;
        let residual = match self.config.bound {
            Some(bound) => {
                let bound = Tensor::new(&bound, &Device::Cpu)?;
                free.broadcast_div(&bound)?.tanh()?.broadcast_mul(&bound)?
            }
            None => free,
        };
        Ok(ResponseOutput {
            residual,
            remainder: mean,
            log_variance: raw.narrow(D::Minus1, N_RESIDUAL, N_RESIDUAL)?,
            logits: raw.narrow(D::Minus1, 2 * N_RESIDUAL, 1)?.squeeze(D::Minus1)?,
        })
    }
}

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

/// A network without the 4DOF model sees nothing of it.
fn feature_mask(correction: Correction) -> [f64; N_FEATURES] {
    match correction {
        Correction::Whole => IS_OF_MODEL.map(|is_of_model| 1.0 - is_of_model),
        Correction::Acceleration | Correction::StateOffset => [1.0; N_FEATURES],
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
        let effects = random_tensor(&[2, 3, 1, N_RESIDUAL], DType::F64, 102);
        let signs = Tensor::new(&RESIDUAL_MIRROR, &Device::Cpu).unwrap();
        let plain = network.forward(Gradients::All, [&features, &tokens, &effects]).unwrap();
        let mirrored = features.broadcast_mul(&network.feature_mirror).unwrap();
        let effects = effects.broadcast_mul(&signs).unwrap();
        let other = network.forward(Gradients::All, [&mirrored, &tokens, &effects]).unwrap();
        assert_close(&other.residual.broadcast_mul(&signs).unwrap(), &plain.residual, 1e-12);
        assert_close(&other.log_variance, &plain.log_variance, 1e-12);
        assert_close(&other.logits, &plain.logits, 1e-12);
    }

    #[test]
    fn the_residual_starts_at_the_effects_and_stays_within_its_bound() {
        let config = ResponseNetworkConfig::default();
        let fresh = ResponseNetwork::new(&config, &mut random_stream(3, "test", 0)).unwrap();
        let features = (random_tensor(&[1, 4, N_FEATURES], DType::F64, 1) * 1e3).unwrap();
        let tokens = random_tensor(&[1, N_TOKENS, N_TOKEN_NUMBERS], DType::F64, 2);
        let none = Tensor::zeros((1, 4, 1, N_RESIDUAL), DType::F64, &Device::Cpu).unwrap();
        let values = |network: &ResponseNetwork, effects: &Tensor| -> Vec<f64> {
            let output = network.forward(Gradients::All, [&features, &tokens, effects]).unwrap();
            output.residual.flatten_all().unwrap().to_vec1().unwrap()
        };
        assert!(values(&fresh, &none).iter().all(|value| *value == 0.0));
        let some = (&none + 0.01).unwrap();
        assert!(values(&fresh, &some).iter().all(|value| (value - 0.01).abs() < 1e-6));
        let bound = config.bound.unwrap();
        let far = (&none + 1e3).unwrap();
        let bounded = |(i, value): (usize, &f64)| value.abs() <= bound[i % N_RESIDUAL];
        assert!(values(&network(), &far).iter().enumerate().all(bounded));
    }

    #[test]
    fn sixty_percent_of_the_layers_are_left_alone_by_fine_tuning() {
        let mut network = network();
        assert_eq!(network.layers.count(), 7);
        network.freeze(0.6);
        let features = random_tensor(&[1, 2, N_FEATURES], DType::F64, 1);
        let tokens = random_tensor(&[1, N_TOKENS, N_TOKEN_NUMBERS], DType::F64, 2);
        let effects = Tensor::zeros((1, 2, 1, N_RESIDUAL), DType::F64, &Device::Cpu).unwrap();
        let input = [&features, &tokens, &effects];
        let loss = network.forward(Gradients::FineTuned, input).unwrap();
        let gradients = loss.residual.sqr().unwrap().sum_all().unwrap().backward().unwrap();
        for (name, variable) in network.parameters.iter() {
            let is_frozen = ["encoder.", "token."].iter().any(|of| name.starts_with(of));
            let is_of_layers = !name.starts_with("effects") && !name.starts_with("boundary");
            assert_eq!(gradients.get(variable).is_some(), is_of_layers && !is_frozen, "{name}");
        }
        let trained: Vec<_> = network.parameters.entries().iter().filter(|e| e.trained).collect();
        assert!(trained.iter().all(|entry| !entry.name.starts_with("token.")));
        assert!(trained.iter().any(|entry| entry.name == "effects.strengths"));
    }
}
