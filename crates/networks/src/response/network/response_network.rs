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
//! [`PitPinnPaper`](impactlab_core::bibliography::PitPinnPaper); the paper's formula leaves the state out of
//! the features and adds z to the state, here it is an acceleration.

use candle_core::{D, DType, Device, Tensor};
use rand_chacha::ChaCha8Rng;

use crate::nn::{Init, MAX_PARAMETERS, NnError, Parameters};
use crate::response::network::layers::ResponseLayers;
use crate::response::{
    Correction, FEATURE_MIRROR, IS_OF_MODEL, N_EFFECTS, N_FEATURES, N_RESIDUAL, RESIDUAL_MIRROR,
    ResponseNetworkConfig,
};

/// Numbers of a component: z_μ, z_σ and z_ω.
pub(crate) const N_COMPONENT_NUMBERS: usize = 2 * N_RESIDUAL + 1;

/// States with soft boundaries, and these: v_x, v_y, m/s, r, φ̇, rad/s, φ, rad. A struck car that
/// moves faster than these, or leans further, is none that is modelled here.
pub(crate) const BOUNDED_STATES: [(usize, f64); 5] =
    [(0, 60.0), (1, 60.0), (3, 8.0), (5, 4.0), (4, 0.5)];

/// s at first, in units of the bound.
const FIRST_BOUNDARY_SCALE: f64 = 0.05;

/// The network with its parameters.
#[derive(Debug)]
pub struct ResponseNetwork {
    config: ResponseNetworkConfig,
    parameters: Parameters,
    layers: ResponseLayers,
    /// The same, without gradients of the first ones.
    fine_tuned: ResponseLayers,
    /// c, `[J, N_EFFECTS]`.
    strengths: Tensor,
    /// ln s of the soft boundaries, `[5]`.
    boundary_log_scale: Tensor,
    feature_mirror: Tensor,
    /// 0 for what is not to be seen.
    feature_mask: Tensor,
    output_mirror: Tensor,
}

/// Which layers give gradients.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Gradients {
    /// Gradients of all layers, for pre-training.
    All,
    /// Gradients of the layers that fine-tuning changes.
    FineTuned,
}

/// The outputs of the network at instants.
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
    /// A network with weights drawn from `rng`; its residual starts at zero.
    ///
    /// # Errors
    /// [`NnError`] for sizes that make no layer.
    pub(crate) fn new(
        config: &ResponseNetworkConfig,
        rng: &mut ChaCha8Rng,
    ) -> Result<Self, NnError> {
        Self::within(MAX_PARAMETERS, config, rng)
    }

    /// The same, for a network of at most `n_values` parameters.
    ///
    /// # Errors
    /// [`NnError`] for sizes that make no layer or more parameters.
    pub(crate) fn within(
        n_values: usize,
        config: &ResponseNetworkConfig,
        rng: &mut ChaCha8Rng,
    ) -> Result<Self, NnError> {
        let mut parameters = Parameters::new(DType::F64).at_most(n_values);
        let mut root = parameters.builder(rng);
        let layers = ResponseLayers::new(&mut root, config)?;
        let effects = [config.components, N_EFFECTS];
        let strengths = root.at("effects").add("strengths", &effects, Init::Zero)?;
        let boundary_log_scale =
            root.at("boundary").add("log_scale", &[BOUNDED_STATES.len()], Init::Zero)?;
        let component: Vec<f64> =
            RESIDUAL_MIRROR.into_iter().chain([1.0; N_RESIDUAL + 1]).collect();
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

    /// Leaves a share of what the network adds to the effects.
    pub(crate) fn keep_remainder(&self, share: f64) -> Result<(), NnError> {
        let is_correction = |column: usize| column % N_COMPONENT_NUMBERS < N_RESIDUAL;
        let n = self.config.components * N_COMPONENT_NUMBERS;
        let shares: Vec<f64> = (0..n).map(|i| if is_correction(i) { share } else { 1.0 }).collect();
        for (name, variable) in self.parameters.iter() {
            if name.starts_with("head.") {
                let shares = Tensor::new(shares.as_slice(), &Device::Cpu)?;
                let shares = shares.to_dtype(variable.dtype())?;
                // A weight is [numbers, hidden], a bias [numbers].
                let shares = if variable.rank() == 2 { shares.unsqueeze(1)? } else { shares };
                variable.set(&variable.broadcast_mul(&shares)?)?;
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

    /// Mean over the components of the strengths of the effects.
    ///
    /// # Errors
    /// [`NnError`] if they cannot be read.
    pub(crate) fn mean_strengths(&self) -> Result<[f64; N_EFFECTS], NnError> {
        let mean: Vec<f64> = self.strengths.mean(0)?.to_dtype(DType::F64)?.to_vec1()?;
        Ok(std::array::from_fn(|k| mean.get(k).copied().unwrap_or(0.0)))
    }

    /// Strengths of the effects in each component, `[J, N_EFFECTS]`.
    pub(crate) fn strengths(&self) -> &Tensor {
        &self.strengths
    }

    /// s of the soft boundaries, positive, `[5]`, in units of the bounds of [`BOUNDED_STATES`].
    pub(crate) fn boundary_scale(&self) -> Result<Tensor, NnError> {
        Ok((self.boundary_log_scale.exp()? * FIRST_BOUNDARY_SCALE)?)
    }

    /// 1 for the features that the network sees, 0 for others.
    pub(crate) fn feature_mask_values(&self) -> [f64; N_FEATURES] {
        feature_mask(self.config.correction)
    }

    /// The layers, all with gradients.
    pub(crate) fn layers(&self) -> &ResponseLayers {
        &self.layers
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
        let tokens = layers.encoded_tokens(tokens)?;
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
    use crate::response::physics::vehicle_tokens::{N_TOKEN_NUMBERS, N_TOKENS};
    use impactlab_core::numerics::random_stream;

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
            let is_frozen = ["encoder.", "token."].iter().any(|prefix| name.starts_with(prefix));
            let is_of_layers = !name.starts_with("effects") && !name.starts_with("boundary");
            assert_eq!(gradients.get(variable).is_some(), is_of_layers && !is_frozen, "{name}");
        }
        let trained: Vec<_> = network.parameters.entries().iter().filter(|e| e.trained).collect();
        assert!(trained.iter().all(|entry| !entry.name.starts_with("token.")));
        assert!(trained.iter().any(|entry| entry.name == "effects.strengths"));
    }
}
