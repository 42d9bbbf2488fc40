//! The force network: from a scenario and its physics to the distribution of the whole force history.
//!
//! Source: after `eq:pinn-gmmframework` to `eq:gmmfunction` of
//! [`PitPinnPaper`](impactlab_core::bibliography::PitPinnPaper).
//!
//! ```text
//! e = encoder(θ)                          multi-scale, per case
//! x(t) = W_i [c(t), PE(t)] + W_e e        instants, then attention over time
//! h(t) = trunk([x(t), e])                 16 channels by default
//! F_base = centre ⊙ (1 + β tanh g(t)) + γ tanh a(t), zero outside [0, Δt], impulse tied to P
//! F | k ~ N(F_base + δ_k, U_k U_kᵀ + diag(σ_min² + exp s_k))      k ~ π(θ)
//! ```
//!
//! δ_k, U_k and s_k start from the residuals of the physics
//! ([`ResidualModel`](crate::force::physics::ResidualModel)). The network learns how far each case
//! departs from them.
//!
//! Everything is in units of the centre's peak force; the duration, in units of 0.1 s, is one more
//! value of the curve, so that it varies together with the force.
//!
//! Departures from the paper: the component is chosen once per curve (π does not depend on time)
//! and its covariance has low rank besides the diagonal; the impulse of F_base holds by
//! construction.

use candle_core::{D, DType, Tensor};
use nalgebra::DMatrix;
use rand_chacha::ChaCha8Rng;

use crate::force::network::{N_FEATURES, N_INSTANT_FEATURES};
use crate::force::physics::{CentreCurve, DURATION_UNIT_S};
use crate::force::{Centre, ForceError, NetworkConfig};
use crate::nn::{
    Activation, Attention, AttentionConfig, Init, Linear, Mlp, MultiScaleEncoder, Parameters,
    positional_encoding,
};
use impactlab_core::uncertainty::{
    CURVE_INTERVAL_S, CURVE_N_INSTANTS, CurveComponent, PeakFactors,
};

/// Time over which the curve fades out at the end of the contact, s.
const FADE_S: f64 = 0.006;
/// Largest change of the logarithm of the deviation of single instants. It is small because single
/// instants account for ripple only: if they had to explain longer deviations, which belong to the
/// latent factors, drawn curves would be jagged and their peaks too high.
const STD_LOG_CHANGE: f64 = 0.7;
/// Largest change of the logarithm of the size of a latent factor, for all instants and for one.
const FACTOR_LOG_CHANGE: f64 = 1.0;
const FACTOR_INSTANT_CHANGE: f64 = 0.3;
/// Smallest value of the envelope of expected forces, in peaks of the centre.
const ENVELOPE_FLOOR: f64 = 0.2;
/// Log odds of hooking before training.
const FIRST_HOOKING_LOGIT: f64 = -2.0;
/// Largest correction of the logit of the duration.
const DURATION_CORRECTION: f64 = 0.02;
/// Largest shift of a component's duration in units of 0.1 s. It is nearly zero, since the duration
/// of the physics is more accurate, except for the component of hooking.
const DURATION_SHIFT: f64 = 0.005;
const HOOKING_DURATION_SHIFT: f64 = 1.0;

/// The layers and their parameters.
#[derive(Debug)]
pub(crate) struct ForceNetwork {
    config: NetworkConfig,
    parameters: Parameters,
    layers: Layers,
    position: Tensor,
}

#[derive(Debug, Clone)]
struct Layers {
    encoder: MultiScaleEncoder,
    instant: Linear,
    scenario: Linear,
    attention: Option<Attention>,
    trunk: Mlp,
    shape: Linear,
    component: Linear,
    loading: Linear,
    whole: Linear,
}

/// The inputs of the network for some cases.
#[derive(Debug, Clone)]
pub(crate) struct NetworkInput {
    /// Standardised features, `[cases, features]`.
    pub features: Tensor,
    /// Features of each instant, `[cases, instants, N_INSTANT_FEATURES]`; the first two are the
    /// centre's force in peaks.
    pub instants: Tensor,
    /// Impulse of the centre in peaks × s, its duration in s and its onset in s, `[cases, 4]`.
    pub whole: Tensor,
    /// Shift and variance of the components before any correction, `[cases, K, values]`.
    pub shift: Tensor,
    pub variance: Tensor,
    /// φ, `[cases, K]`.
    pub lag_correlation: Tensor,
    /// Latent factors, `[cases, K, values, q]`; none if q = 0.
    pub factors: Option<Tensor>,
}

/// A mixture over the values of a curve `[F_x…, F_y…, duration]`, in peaks and 0.1 s.
#[derive(Debug, Clone)]
pub(crate) struct NetworkOutput {
    /// Logits of π, `[cases, K]`.
    pub logits: Tensor,
    /// Means, `[cases, K, values]`.
    pub mean: Tensor,
    /// Variance that the factors do not explain, `[cases, K, values]`.
    pub variance: Tensor,
    /// Correlation φ of the remainder at neighbouring instants, `[cases, K]`.
    pub lag_correlation: Tensor,
    /// Latent factors U, `[cases, K, values, q]`; none if q = 0.
    pub factors: Option<Tensor>,
    /// Impulse of F_base, peaks × s, `[cases, 2]`.
    pub impulse: Tensor,
    /// Mean duration of the first component, s, `[cases]`.
    pub duration_s: Tensor,
}

impl NetworkOutput {
    /// The components of each case, in N and s.
    ///
    /// - `centres`: of the same cases.
    pub(crate) fn components(
        &self,
        centres: &[CentreCurve],
    ) -> Result<Vec<Vec<CurveComponent>>, ForceError> {
        let to_f64 = |tensor: &Tensor| tensor.to_dtype(DType::F64);
        let weights = candle_nn::ops::softmax(&self.logits, D::Minus1)?;
        let weights = to_f64(&weights)?.to_vec2::<f64>()?;
        let lag_correlation = to_f64(&self.lag_correlation)?.to_vec2::<f64>()?;
        let mean = to_f64(&self.mean)?.to_vec3::<f64>()?;
        let variance = to_f64(&self.variance)?.to_vec3::<f64>()?;
        let factors = match &self.factors {
            Some(factors) => to_f64(&factors.flatten_all()?)?.to_vec1::<f64>()?,
            None => Vec::new(),
        };
        let (_, k, n_values) = self.mean.dims3()?;
        let q = self.factors.as_ref().map_or(0, |factors| factors.dims()[3]);
        let component = |i: usize, j: usize, scale_n: f64| {
            let unit = |v: usize| if v + 1 == n_values { DURATION_UNIT_S } else { scale_n };
            let scaled = |row: &[f64], power: i32| -> Vec<f64> {
                row.iter().enumerate().map(|(v, x)| x * unit(v).powi(power)).collect()
            };
            let first = (i * k + j) * n_values * q;
            CurveComponent {
                weight: weights[i][j],
                mean: scaled(&mean[i][j], 1),
                variance: scaled(&variance[i][j], 2),
                factors: DMatrix::from_fn(n_values, q, |v, f| factors[first + v * q + f] * unit(v)),
                lag_correlation: lag_correlation[i][j],
                peak: PeakFactors::default(),
            }
        };
        let of_case = |(i, centre): (usize, &CentreCurve)| {
            (0..k).map(|j| component(i, j, centre.scale_n)).collect()
        };
        Ok(centres.iter().enumerate().map(of_case).collect())
    }
}

impl ForceNetwork {
    /// A network with random first weights.
    ///
    /// - `n_more`: number of kinds of bodies of the striking vehicle;
    /// - `parameters`: the list to which its parameters are added, empty.
    ///
    /// # Errors
    /// [`ForceError::Learning`] for sizes that make no layer, and for more parameters than the list
    /// takes.
    pub(crate) fn new(
        config: &NetworkConfig,
        n_more: usize,
        rng: &mut ChaCha8Rng,
        mut parameters: Parameters,
    ) -> Result<Self, ForceError> {
        let number_type = parameters.number_type();
        let layers = Layers::new(config, n_more, &mut parameters, rng)?;
        let positions: Vec<f64> = (0..CURVE_N_INSTANTS).map(|t| t as f64).collect();
        let position = positional_encoding(&positions, config.position_channels, number_type)?;
        Ok(Self { config: config.clone(), parameters, layers, position })
    }

    pub(crate) fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The same network without gradients, for predictions.
    pub(crate) fn forward_frozen(&self, input: &NetworkInput) -> Result<NetworkOutput, ForceError> {
        self.forward_with(&self.layers.frozen(), input)
    }

    /// The distribution of the curves of all cases.
    pub(crate) fn forward(&self, input: &NetworkInput) -> Result<NetworkOutput, ForceError> {
        self.forward_with(&self.layers, input)
    }

    fn forward_with(
        &self,
        layers: &Layers,
        input: &NetworkInput,
    ) -> Result<NetworkOutput, ForceError> {
        let (n_cases, n_instants, _) = input.instants.dims3()?;
        let encoded = layers.encoder.forward(&input.features)?;
        let hidden = self.hidden(layers, input, &encoded)?;
        let pooled = Tensor::cat(&[&hidden.mean(1)?, &encoded], D::Minus1)?;
        let whole = layers.whole.forward(&pooled)?;
        let duration_s = self.duration_s(&whole, &input.whole)?;
        let impulse = self.impulse(&whole, &input.whole)?;
        let base = self.base(layers, input, &hidden, &impulse, &duration_s)?;

        let (k, q) = (self.config.components, self.config.factors);
        let number_type = self.parameters.number_type();
        let raw = self.by_component(&layers.component.forward(&hidden)?, 2)?;
        let n_forces = 2 * n_instants;
        let envelope = self.envelope(input)?.reshape((n_cases, 1, 1, n_instants))?;
        let per_force = |i: usize| -> Result<Tensor, ForceError> {
            Ok(raw.narrow(4, i, 1)?.squeeze(4)?.tanh()?)
        };
        let largest = self.per_component(self.config.component_shift, self.config.hooking_shift)?;
        let shift = per_force(0)?.broadcast_mul(&envelope)?;
        let shift = shift.reshape((n_cases, k, n_forces))?.broadcast_mul(&largest)?;
        let change = per_force(1)?.reshape((n_cases, k, n_forces))?;

        let per_component = whole.narrow(1, 3, k * (3 + q))?.reshape((n_cases, k, 3 + q))?;
        let of_component = |i: usize| per_component.narrow(2, i, 1);
        let rare = self.per_component(0.0, FIRST_HOOKING_LOGIT)?.squeeze(2)?;
        let logits = of_component(0)?.squeeze(2)?.broadcast_add(&rare)?;
        let largest = self.per_component(DURATION_SHIFT, HOOKING_DURATION_SHIFT)?;
        let duration_shift = of_component(1)?.tanh()?.broadcast_mul(&largest)?;
        let duration = (&duration_s / DURATION_UNIT_S)?.reshape((n_cases, 1, 1))?;
        let mean = Tensor::cat(
            &[
                &base.reshape((n_cases, 1, n_forces))?.broadcast_add(&shift)?,
                &duration.broadcast_add(&duration_shift)?,
            ],
            2,
        )?;
        let mean = (mean + &input.shift)?;
        // That of the first component, shifts included: what the loss compares.
        let duration_s = (mean.narrow(1, 0, 1)?.narrow(2, n_forces, 1)? * DURATION_UNIT_S)?;
        let duration_s = duration_s.flatten_all()?;
        let change = Tensor::cat(&[&change, &of_component(2)?.tanh()?], 2)?;
        let variance = (&input.variance * (change * (2.0 * STD_LOG_CHANGE))?.exp()?)?;
        let variance = (variance + self.config.min_std.powi(2))?;
        let sizes = per_component.narrow(2, 3, q)?;
        let factors = self.factors(layers, input, &hidden, &sizes)?;
        let logits = logits.to_dtype(number_type)?;
        let lag_correlation = input.lag_correlation.clone();
        Ok(NetworkOutput { logits, mean, variance, lag_correlation, factors, impulse, duration_s })
    }

    /// `[cases, instants, K · 2 · n]` to `[cases, K, axis, instants, n]`.
    fn by_component(&self, raw: &Tensor, n: usize) -> Result<Tensor, ForceError> {
        let (n_cases, n_instants, _) = raw.dims3()?;
        let raw = raw.reshape((n_cases, n_instants, self.config.components, 2, n))?;
        Ok(raw.permute((0, 2, 3, 1, 4))?.contiguous()?)
    }

    /// The latent factors of the residuals, each scaled as a whole by `sizes`, `[cases, K, q]`, and at
    /// each instant; `[cases, K, values, q]`.
    fn factors(
        &self,
        layers: &Layers,
        input: &NetworkInput,
        hidden: &Tensor,
        sizes: &Tensor,
    ) -> Result<Option<Tensor>, ForceError> {
        let Some(start) = &input.factors else { return Ok(None) };
        let (n_cases, k, n_values, q) = start.dims4()?;
        let size = (sizes.tanh()? * FACTOR_LOG_CHANGE)?.exp()?;
        let instants = self.by_component(&layers.loading.forward(hidden)?, q)?;
        let instants = ((instants.tanh()? * FACTOR_INSTANT_CHANGE)? + 1.0)?;
        let instants = instants.reshape((n_cases, k, n_values - 1, q))?;
        let of_duration = Tensor::ones((n_cases, k, 1, q), start.dtype(), start.device())?;
        let change = Tensor::cat(&[&instants, &of_duration], 2)?;
        Ok(Some((start * change)?.broadcast_mul(&size.unsqueeze(2)?)?))
    }

    /// One value for hooking (the last of two or more components), another for the others,
    /// `[1, K, 1]`.
    fn per_component(&self, usual: f64, hooking: f64) -> Result<Tensor, ForceError> {
        let k = self.config.components;
        let value = |i: usize| if k > 1 && i + 1 == k { hooking } else { usual };
        let values: Vec<f64> = (0..k).map(value).collect();
        let values = Tensor::from_vec(values, (1, k, 1), self.position.device())?;
        Ok(values.to_dtype(self.parameters.number_type())?)
    }

    /// The output of the trunk at each instant, `[cases, instants, width]`.
    fn hidden(
        &self,
        layers: &Layers,
        input: &NetworkInput,
        encoded: &Tensor,
    ) -> Result<Tensor, ForceError> {
        let (n_cases, n_instants, _) = input.instants.dims3()?;
        let position = self.position.narrow(0, 0, n_instants)?.unsqueeze(0)?;
        let position =
            position.broadcast_as((n_cases, n_instants, self.config.position_channels))?;
        let instants = Tensor::cat(&[&input.instants, &position.contiguous()?], 2)?;
        let scenario = layers.scenario.forward(encoded)?.unsqueeze(1)?;
        let mut x = layers.instant.forward(&instants)?.broadcast_add(&scenario)?;
        if let Some(attention) = &layers.attention {
            x = if self.config.attention_stride == 1 {
                attention.self_attention(&x)?
            } else {
                let seen: Vec<u32> =
                    (0..n_instants as u32).step_by(self.config.attention_stride).collect();
                let seen = Tensor::new(seen, x.device())?;
                attention.cross_attention(&x, &x.index_select(&seen, 1)?)?
            };
        }
        let width = encoded.dim(1)?;
        let encoded = encoded.unsqueeze(1)?.broadcast_as((n_cases, n_instants, width))?;
        let x = Tensor::cat(&[&x, &encoded.contiguous()?], 2)?;
        Ok(layers.trunk.forward(&x)?)
    }

    /// Δt = σ(z) Δt_max, z around that of the centre's duration; `[cases]`.
    fn duration_s(&self, whole: &Tensor, centre: &Tensor) -> Result<Tensor, ForceError> {
        let longest = self.config.duration_max_s;
        let share = (centre.narrow(1, 2, 1)? / longest)?.clamp(0.02, 0.98)?;
        let logit = (share.log()? - (1.0 - &share)?.log()?)?;
        let correction = (whole.narrow(1, 2, 1)?.tanh()? * DURATION_CORRECTION)?;
        Ok((candle_nn::ops::sigmoid(&(logit + correction)?)? * longest)?.squeeze(1)?)
    }

    /// P = P_centre + κ |P_centre| tanh(z); `[cases, 2]`.
    fn impulse(&self, whole: &Tensor, centre: &Tensor) -> Result<Tensor, ForceError> {
        let impulse = centre.narrow(1, 0, 2)?;
        let size = impulse.sqr()?.sum_keepdim(1)?.sqrt()?;
        let correction = (whole.narrow(1, 0, 2)?.tanh()? * self.config.impulse_correction)?;
        Ok((impulse + correction.broadcast_mul(&size)?)?)
    }

    /// F_base, `[cases, 2, instants]`.
    fn base(
        &self,
        layers: &Layers,
        input: &NetworkInput,
        hidden: &Tensor,
        impulse: &Tensor,
        duration_s: &Tensor,
    ) -> Result<Tensor, ForceError> {
        let (n_cases, n_instants, _) = input.instants.dims3()?;
        let shape = layers.shape.forward(hidden)?.transpose(1, 2)?.contiguous()?;
        if self.config.centre == Centre::None {
            return Ok(shape.narrow(1, 0, 2)?);
        }
        let centre = input.instants.narrow(2, 0, 2)?.transpose(1, 2)?.contiguous()?;
        let scale = ((shape.narrow(1, 0, 2)?.tanh()? * self.config.shape_correction)? + 1.0)?;
        let envelope = self.envelope(input)?.unsqueeze(1)?;
        let added = (shape.narrow(1, 2, 2)?.tanh()? * self.config.force_correction)?;
        let raw = ((centre * scale)? + added.broadcast_mul(&envelope)?)?;
        let window = self.window(input, duration_s)?.unsqueeze(1)?;
        let raw = raw.broadcast_mul(&window)?;
        // What the impulse lacks goes where the centre's force is.
        let carrier = self.magnitude(input)?.reshape((n_cases, 1, n_instants))?;
        let carrier = carrier.broadcast_mul(&window)?;
        let area = ((carrier.sum_keepdim(2)? * CURVE_INTERVAL_S)? + 1e-9)?;
        let lacking = (impulse.unsqueeze(2)? - (raw.sum_keepdim(2)? * CURVE_INTERVAL_S)?)?;
        let amount = lacking.broadcast_div(&area)?;
        Ok((raw + amount.broadcast_mul(&carrier)?)?)
    }

    /// 1 during the contact and 0 after it, `[cases, instants]`. Over the last 6 ms it falls linearly, so
    /// that the end of the contact has a gradient.
    fn window(&self, input: &NetworkInput, duration_s: &Tensor) -> Result<Tensor, ForceError> {
        let n_instants = input.instants.dim(1)?;
        let number_type = self.parameters.number_type();
        let device = input.instants.device();
        let end = (duration_s.unsqueeze(1)? + input.whole.narrow(1, 3, 1)?)?;
        let time: Vec<f64> = (0..n_instants).map(|t| (t as f64 + 0.5) * CURVE_INTERVAL_S).collect();
        let time = Tensor::from_vec(time, (1, n_instants), device)?.to_dtype(number_type)?;
        Ok((end.broadcast_sub(&time)? / FADE_S)?.clamp(0.0, 1.0)?)
    }

    /// |centre|, peaks, `[cases, instants]`.
    fn magnitude(&self, input: &NetworkInput) -> Result<Tensor, ForceError> {
        Ok((input.instants.narrow(2, 0, 2)?.sqr()?.sum(2)? + 1e-12)?.sqrt()?)
    }

    /// Envelope of expected forces, `[cases, instants]`: |centre| and a constant; 1 without a centre.
    fn envelope(&self, input: &NetworkInput) -> Result<Tensor, ForceError> {
        let magnitude = self.magnitude(input)?;
        if self.config.centre == Centre::None {
            return Ok(magnitude.ones_like()?);
        }
        Ok((magnitude + ENVELOPE_FLOOR)?)
    }
}

impl Layers {
    fn new(
        config: &NetworkConfig,
        n_more: usize,
        parameters: &mut Parameters,
        rng: &mut ChaCha8Rng,
    ) -> Result<Self, ForceError> {
        let mut root = parameters.builder(rng);
        let n_in = N_FEATURES + n_more;
        let encoder =
            MultiScaleEncoder::new(&mut root.at("encoder"), n_in, &config.encoder_branches)?;
        let channels = config.attention_channels;
        let (none, width) = (Activation::None, encoder.n_out());
        let n_instant = config.position_channels.saturating_add(N_INSTANT_FEATURES);
        let instant = Linear::new(&mut root.at("instant"), [n_instant, channels], none)?;
        let scenario = Linear::new(&mut root.at("scenario"), [width, channels], none)?;
        let sizes = AttentionConfig {
            channels,
            key_channels: channels,
            heads: config.attention_heads,
            layer_norm: config.attention_stride == 1,
        };
        let attention = match config.attention {
            true => Some(Attention::new(&mut root.at("attention"), sizes)?),
            false => None,
        };
        let widths: Vec<usize> =
            std::iter::once(channels + width).chain(config.trunk.iter().copied()).collect();
        let trunk = Mlp::new(&mut root.at("trunk"), &widths, Activation::Silu)?;
        let hidden = trunk.n_out();
        // Products of sizes from a file may be too large for a number; the parameters then are too many.
        let (k, q) = (config.components, config.factors);
        let per = |n: usize| k.saturating_mul(n);
        let zero = Init::Zero;
        let shape = Linear::with_init(&mut root.at("shape"), [hidden, 4], none, zero)?;
        let component = Linear::with_init(&mut root.at("component"), [hidden, per(4)], none, zero)?;
        let n_loading = per(q.max(1).saturating_mul(2));
        let loading = Linear::with_init(&mut root.at("loading"), [hidden, n_loading], none, zero)?;
        let n_whole = per(q.saturating_add(3)).saturating_add(3);
        let whole =
            Linear::with_init(&mut root.at("whole"), [hidden + width, n_whole], none, zero)?;
        Ok(Self { encoder, instant, scenario, attention, trunk, shape, component, loading, whole })
    }

    fn frozen(&self) -> Self {
        Self {
            encoder: self.encoder.frozen(),
            instant: self.instant.frozen(),
            scenario: self.scenario.frozen(),
            attention: self.attention.as_ref().map(Attention::frozen),
            trunk: self.trunk.frozen(),
            shape: self.shape.frozen(),
            component: self.component.frozen(),
            loading: self.loading.frozen(),
            whole: self.whole.frozen(),
        }
    }
}

#[cfg(test)]
#[path = "force_network_tests.rs"]
mod tests;
