//! The response network for one vehicle, without tensors: what a prediction runs through thousands of
//! times.
//!
//! The vehicle's tokens do not change along a motion, so that their encoders and the projections of
//! the attention fold into two small tables: `scores = S h + s₀` and `h ← h + Σ_hk a_hk U_hk`. Motion
//! and mirrored motion go through side by side. In single precision: the network corrects
//! accelerations of metres per second squared, by which 1e-6 of them is nothing; all mechanics is in
//! double precision.

use candle_core::Tensor;

use crate::nn::NnError;
use crate::response::network::dense::{Dense, Rows};
use crate::response::network::folded_attention::FoldedAttention;
use crate::response::network::response_network::{N_COMPONENT_NUMBERS, ResponseNetwork};
use crate::response::{
    Correction, FEATURE_MIRROR, N_EFFECTS, N_FEATURES, N_RESIDUAL, RESIDUAL_MIRROR,
};
use impactlab_core::numerics::Lanes;
use impactlab_core::vehicle::VehicleParameters;

/// Motion and mirrored motion.
const N_SIDES: usize = 2;

/// The network for one vehicle.
#[derive(Debug, Clone)]
pub(crate) struct VehicleNetwork {
    correction: Correction,
    n_components: usize,
    feature_mask: [f64; N_FEATURES],
    encoder: Vec<Dense>,
    /// S: `[hidden, heads · tokens]`.
    scores: Dense,
    /// Tokens that share a softmax.
    n_tokens: usize,
    /// U: `[heads · tokens, hidden]`, and the bias of the attention's output.
    seen: Dense,
    trunk: Vec<Dense>,
    head: Dense,
    /// `[J, N_EFFECTS]`; none where effects are no part of the network.
    strengths: Option<Vec<[f64; N_EFFECTS]>>,
    bound: Option<[f64; N_RESIDUAL]>,
    unit: [f64; N_RESIDUAL],
    min_std: f64,
    /// How long the motions were that the network has learned from, s.
    learned_s: f64,
}

/// Buffers of a forward pass, and what came out of it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Workspace {
    hidden: Rows,
    next: Rows,
    scores: Rows,
    n_instants: usize,
}

impl VehicleNetwork {
    /// # Errors
    /// [`NnError`] if a tensor cannot be read.
    pub(crate) fn new(
        network: &ResponseNetwork,
        vehicle: &VehicleParameters,
    ) -> Result<Self, NnError> {
        let config = network.config();
        let folded = FoldedAttention::new(network, vehicle)?;
        let dense = |name: String| Dense::from_network(network, &name);
        let layers = |name: &str, n: usize| -> Result<Vec<Dense>, NnError> {
            (0..n).map(|i| dense(format!("{name}.{i}"))).collect()
        };
        let strengths = match config.effects {
            true => Some(rows_of(network.strengths())?),
            false => None,
        };
        Ok(Self {
            correction: config.correction,
            n_components: config.components,
            feature_mask: network.feature_mask_values(),
            encoder: layers("encoder", config.encoder.len())?,
            scores: Dense::from_tensors(&folded.scores, &folded.scores_bias)?,
            n_tokens: folded.n_tokens,
            seen: Dense::from_tensors(&folded.seen, &folded.seen_bias)?,
            trunk: layers("trunk", config.trunk.len())?,
            head: dense("head".to_owned())?,
            strengths,
            bound: config.bound,
            unit: config.unit,
            min_std: config.min_std,
            learned_s: f64::INFINITY,
        })
    }

    /// The same network, of which it is known how long the motions were that it has learned from, s.
    #[must_use]
    pub(crate) fn learned_for(mut self, learned_s: f64) -> Self {
        self.learned_s = learned_s;
        self
    }

    /// How long the motions were that the network has learned from, s.
    pub(crate) fn learned_s(&self) -> f64 {
        self.learned_s
    }

    pub(crate) fn n_components(&self) -> usize {
        self.n_components
    }

    pub(crate) fn correction(&self) -> Correction {
        self.correction
    }

    /// Strengths of the effects in a component.
    pub(crate) fn strengths(&self, component: usize) -> Option<&[f64; N_EFFECTS]> {
        self.strengths.as_ref()?.get(component)
    }

    /// Mean over the components of the strengths of the effects; zero where effects are no part of the
    /// network.
    pub(crate) fn mean_strengths(&self) -> [f64; N_EFFECTS] {
        let rows = self.strengths.as_deref().unwrap_or_default();
        let n = rows.len().max(1) as f64;
        std::array::from_fn(|k| rows.iter().map(|row| row[k]).sum::<f64>() / n)
    }

    /// The same network with strengths added in every component, and all that it says beside the bare
    /// physics times a share.
    ///
    /// - `added`: `[N_EFFECTS]`; `share`: 0 to 1.
    #[must_use]
    pub(crate) fn adapted(mut self, added: &[f64], share: f64) -> Self {
        for row in self.strengths.iter_mut().flatten() {
            for (value, added) in row.iter_mut().zip(added) {
                *value = (*value + added) * share;
            }
        }
        self.with_remainder(share)
    }

    /// The same network with a share of its remainder, what it adds to the effects.
    #[must_use]
    pub(crate) fn with_remainder(mut self, share: f64) -> Self {
        self.unit = self.unit.map(|unit| unit * share);
        self
    }

    /// `a_bound ⊙ tanh(a/a_bound)`.
    #[inline(always)]
    pub(crate) fn bounded<T: Lanes>(&self, mut free: [T; N_RESIDUAL]) -> [T; N_RESIDUAL] {
        if let Some(bound) = &self.bound {
            for (value, bound) in free.iter_mut().zip(bound) {
                *value = (*value / *bound).tanh() * *bound;
            }
        }
        free
    }

    /// Evaluates the network at instants; its outputs are left in `work`.
    pub(crate) fn forward(&self, features: &[[f64; N_FEATURES]], work: &mut Workspace) {
        work.n_instants = features.len();
        self.fill(features, &mut work.hidden);
        for layer in &self.encoder {
            layer.forward(&work.hidden, &mut work.next, true);
            std::mem::swap(&mut work.hidden, &mut work.next);
        }
        self.scores.forward(&work.hidden, &mut work.scores, false);
        let n_scores = self.scores.n_out();
        for row in work.scores.iter_mut() {
            for of_head in row[..n_scores].chunks_exact_mut(self.n_tokens.max(1)) {
                softmax_in_place(of_head);
            }
        }
        self.seen.forward(&work.scores, &mut work.next, false);
        for (hidden, seen) in work.hidden.values.iter_mut().zip(&work.next.values) {
            *hidden += seen;
        }
        for layer in &self.trunk {
            layer.forward(&work.hidden, &mut work.next, true);
            std::mem::swap(&mut work.hidden, &mut work.next);
        }
        self.head.forward(&work.hidden, &mut work.next, false);
    }

    /// z_μ of an instant in units of the correction: what is added to the effects before the bound.
    ///
    /// - `at`: instant and component.
    pub(crate) fn remainder(&self, work: &Workspace, at: [usize; 2]) -> [f64; N_RESIDUAL] {
        std::array::from_fn(|i| self.unit[i] * number(work, at, i, RESIDUAL_MIRROR[i]))
    }

    /// σ² of the velocities after a step from an instant, (m/s)², (rad/s)².
    pub(crate) fn variance(&self, work: &Workspace, at: [usize; 2]) -> [f64; N_RESIDUAL] {
        std::array::from_fn(|i| {
            self.min_std * self.min_std + number(work, at, N_RESIDUAL + i, 1.0).exp()
        })
    }

    /// ω of an instant.
    pub(crate) fn weight(&self, work: &Workspace, [instant, component]: [usize; 2]) -> f64 {
        let logit = |component| number(work, [instant, component], 2 * N_RESIDUAL, 1.0);
        let own = logit(component);
        1.0 / (0..self.n_components).map(|other| (logit(other) - own).exp()).sum::<f64>()
    }

    /// Rows of the motions, then of the mirrored ones.
    fn fill(&self, features: &[[f64; N_FEATURES]], rows: &mut Rows) {
        rows.reset(N_SIDES * features.len(), N_FEATURES);
        let signs = [[1.0; N_FEATURES], FEATURE_MIRROR];
        let sides = signs.iter().flat_map(|signs| features.iter().map(move |row| (signs, row)));
        for (row, (signs, features)) in rows.iter_mut().zip(sides) {
            for (i, value) in row.iter_mut().enumerate().take(N_FEATURES) {
                *value = (features[i] * self.feature_mask[i] * signs[i]) as f32;
            }
        }
    }
}

/// A number of a component: the mean of the heads of motion and mirrored motion.
fn number(work: &Workspace, [instant, component]: [usize; 2], i: usize, mirror: f64) -> f64 {
    let column = component * N_COMPONENT_NUMBERS + i;
    let head = |row: usize| {
        let value = work.next.row(row).get(column).copied();
        f64::from(value.unwrap_or(0.0))
    };
    0.5 * (head(instant) + mirror * head(work.n_instants + instant))
}

fn softmax_in_place(values: &mut [f32]) {
    let largest = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let mut sum = 0.0;
    for value in values.iter_mut() {
        *value = (*value - largest).exp();
        sum += *value;
    }
    values.iter_mut().for_each(|value| *value /= sum);
}

fn rows_of(tensor: &Tensor) -> Result<Vec<[f64; N_EFFECTS]>, NnError> {
    let rows = tensor.detach().to_vec2::<f64>()?;
    Ok(rows.into_iter().map(|row| std::array::from_fn(|i| row[i])).collect())
}

#[cfg(test)]
mod tests {
    use candle_core::{DType, Device};

    use super::*;
    use crate::nn::gradient_check::random_tensor;
    use crate::response::ResponseNetworkConfig;
    use crate::response::network::one_step::token_tensor;
    use crate::response::network::response_network::Gradients;
    use impactlab_core::numerics::random_stream;
    use impactlab_core::vehicle::Preset;

    #[test]
    fn it_says_what_the_network_says() {
        for config in [ResponseNetworkConfig::default(), ResponseNetworkConfig::default().plain()] {
            let network = ResponseNetwork::new(&config, &mut random_stream(3, "test", 0)).unwrap();
            for (i, (_, variable)) in network.parameters().iter().enumerate() {
                let values = random_tensor(variable.dims(), DType::F64, i as u64);
                variable.set(&(values * 0.5).unwrap()).unwrap();
            }
            let vehicle = Preset::ALL[1].parameters();
            let quick = VehicleNetwork::new(&network, &vehicle).unwrap();
            let features = random_tensor(&[1, 1, N_FEATURES], DType::F64, 100);
            let effects = Tensor::zeros((1, 1, 1, N_RESIDUAL), DType::F64, &Device::Cpu).unwrap();
            let tokens = token_tensor(&vehicle).unwrap();
            let slow = network.forward(Gradients::All, [&features, &tokens, &effects]).unwrap();
            let values =
                |tensor: &Tensor| -> Vec<f64> { tensor.flatten_all().unwrap().to_vec1().unwrap() };
            let features = values(&features);
            let mut work = Workspace::default();
            let row: [f64; N_FEATURES] = std::array::from_fn(|i| features[i]);
            let mut other = row;
            other[0] += 1.0;
            quick.forward(&[row, other], &mut work);
            assert_ne!(quick.remainder(&work, [0, 0]), quick.remainder(&work, [1, 0]));
            let (residual, logits) = (values(&slow.residual), values(&slow.logits));
            let variance = values(&slow.log_variance);
            let sum: f64 = logits.iter().map(|logit| logit.exp()).sum();
            for j in 0..config.components {
                let value = quick.bounded(quick.remainder(&work, [0, j]));
                let got = quick.variance(&work, [0, j]);
                for i in 0..N_RESIDUAL {
                    let off = value[i] - residual[j * N_RESIDUAL + i];
                    assert!(off.abs() < 1e-4, "{j} {i}: {off}");
                    let expected = variance[j * N_RESIDUAL + i].exp() + 1e-4;
                    assert!((got[i] / expected - 1.0).abs() < 1e-4);
                }
                let weight = quick.weight(&work, [0, j]);
                assert!((weight - logits[j].exp() / sum).abs() < 1e-4, "{j}: {weight}");
            }
        }
    }
}
