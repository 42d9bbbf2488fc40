//! Instants away from the data at which fine-tuning asks for physics: of motions that the 4DOF model
//! drives under the same forces, scaled, at other speeds.

use candle_core::{Device, Tensor};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::nn::NnError;
use crate::response::network::one_step::OneStepData;
use crate::response::train::simulated::{ImpactRecord, simulate};
use crate::response::{
    N_FEATURES, N_TOKEN_NUMBERS, N_TOKENS, ResponseConfig, STEP_S, features, vehicle_tokens,
};

/// Simulated motions.
const N_MOTIONS: usize = 60;
/// Every how many steps an instant of them is taken.
const STRIDE: usize = 7;

/// A pool of instants.
#[derive(Debug)]
pub(crate) struct PhysicsPoints {
    features: Vec<[f64; N_FEATURES]>,
    motion_idx: Vec<usize>,
    tokens: Vec<[[f64; N_TOKEN_NUMBERS]; N_TOKENS]>,
    /// Factor on λ at each point.
    factors: Vec<f64>,
}

/// Some of them as tensors.
pub(crate) struct PhysicsBatch {
    /// `[rows, 1, N_FEATURES]`.
    pub features: Tensor,
    /// `[rows, N_TOKENS, N_TOKEN_NUMBERS]`.
    pub tokens: Tensor,
    /// `[rows]`.
    pub factors: Tensor,
}

impl PhysicsPoints {
    pub(crate) fn about(
        data: &OneStepData,
        records: &[ImpactRecord],
        config: &ResponseConfig,
        seed: u64,
    ) -> Self {
        let motions = simulate(records, N_MOTIONS, false, seed);
        let (mut at, mut motion_idx) = (Vec::new(), Vec::new());
        for (idx, motion) in motions.iter().enumerate() {
            let steps = motion.states.iter().zip(&motion.inputs).enumerate().step_by(STRIDE);
            for (i, (x, u)) in steps {
                at.push(features(&motion.data_sheet, x, u, i as f64 * STEP_S));
                motion_idx.push(idx);
            }
        }
        let seen: Vec<[f64; N_FEATURES]> = data.rows().iter().map(|row| row.features).collect();
        let qualities = config.physics.qualities(&seen, &at);
        Self {
            features: at,
            motion_idx,
            tokens: motions.iter().map(|motion| vehicle_tokens(&motion.vehicle)).collect(),
            factors: qualities.into_iter().map(|q| config.physics.quality_factor(q)).collect(),
        }
    }

    /// `n` of them, drawn with replacement.
    pub(crate) fn draw(&self, n: usize, rng: &mut ChaCha8Rng) -> Result<PhysicsBatch, NnError> {
        let n = if self.features.is_empty() { 0 } else { n };
        let indices: Vec<usize> =
            (0..n).map(|_| rng.random_range(0..self.features.len())).collect();
        let features: Vec<f64> = indices.iter().flat_map(|&idx| self.features[idx]).collect();
        let tokens = indices.iter().map(|&idx| &self.tokens[self.motion_idx[idx]]);
        let tokens: Vec<f64> = tokens.flatten().flatten().copied().collect();
        let factors: Vec<f64> = indices.iter().map(|&idx| self.factors[idx]).collect();
        let device = &Device::Cpu;
        Ok(PhysicsBatch {
            features: Tensor::from_vec(features, (n, 1, N_FEATURES), device)?,
            tokens: Tensor::from_vec(tokens, (n, N_TOKENS, N_TOKEN_NUMBERS), device)?,
            factors: Tensor::from_vec(factors, n, device)?,
        })
    }
}
