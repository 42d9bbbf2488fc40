//! What trajectories say of single steps.

use candle_core::{Device, Tensor};
use rayon::prelude::*;

use crate::nn::NnError;
use crate::response::{
    Effects, N_EFFECTS, N_FEATURES, N_RESIDUAL, N_TOKEN_NUMBERS, N_TOKENS, ResponseNetworkConfig,
    STEP_S, effects, features, vehicle_tokens,
};
use impactlab_core::vehicle::{N_STATE, VehicleInput, VehicleParameters, VehicleState};

/// A motion to learn from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MotionView<'a> {
    /// The vehicle of the 4DOF model in the centre.
    pub centre: &'a VehicleParameters,
    /// The vehicle that the network is told of.
    pub vehicle: &'a VehicleParameters,
    pub states: &'a [VehicleState<f64>],
    /// Input over each step.
    pub inputs: &'a [VehicleInput<f64>],
}

/// Instants of motions: what the network sees and what it should have said.
#[derive(Debug)]
pub(crate) struct OneStepData {
    rows: Vec<OneStepRow>,
    /// The tokens of the vehicle of each motion.
    tokens: Vec<[[f64; N_TOKEN_NUMBERS]; N_TOKENS]>,
}

#[derive(Debug)]
pub(crate) struct OneStepRow {
    pub features: [f64; N_FEATURES],
    /// The correction that leads to the next state.
    pub target: [f64; N_RESIDUAL],
    /// Boxed: 1.6 kB.
    pub effects: Box<Effects<f64>>,
    /// The recorded state.
    state: [f64; N_STATE],
    motion_idx: usize,
}

/// Some of them as tensors.
pub(crate) struct OneStepBatch {
    /// `[rows, 1, N_FEATURES]`.
    pub features: Tensor,
    /// `[rows, N_TOKENS, N_TOKEN_NUMBERS]`.
    pub tokens: Tensor,
    /// `[rows, 1, 1, N_RESIDUAL]`.
    pub targets: Tensor,
    /// `[rows, 8]`.
    pub states: Tensor,
    /// `[rows, N_EFFECTS, N_RESIDUAL]`.
    effects: Tensor,
}

impl OneStepData {
    /// Every step of the motions.
    pub(crate) fn from_motions(motions: &[MotionView<'_>], config: &ResponseNetworkConfig) -> Self {
        let correction = config.correction;
        let rows = |(motion_idx, motion): (usize, &MotionView<'_>)| -> Vec<OneStepRow> {
            let steps = motion.states.iter().zip(motion.states.iter().skip(1)).zip(motion.inputs);
            let row = |(i, ((x, next), u)): (usize, ((&VehicleState<f64>, _), &_))| {
                let next: &VehicleState<f64> = next;
                let plain = correction.step(motion.centre, x, u, [0.0; N_RESIDUAL]);
                let difference = [
                    next.vx_body_m_s - plain.vx_body_m_s,
                    next.vy_body_m_s - plain.vy_body_m_s,
                    next.yaw_rate_rad_s - plain.yaw_rate_rad_s,
                    next.roll_rate_rad_s - plain.roll_rate_rad_s,
                ];
                let now = motion.centre.evaluate(x, u);
                OneStepRow {
                    features: features(motion.centre, x, u, i as f64 * STEP_S),
                    target: difference.map(|change| change / correction.change_per_unit()),
                    effects: Box::new(effects(motion.centre, x, &now)),
                    state: x.to_array(),
                    motion_idx,
                }
            };
            steps.enumerate().map(row).collect()
        };
        let of_motions: Vec<Vec<OneStepRow>> = motions.par_iter().enumerate().map(rows).collect();
        let tokens = motions.iter().map(|motion| vehicle_tokens(motion.vehicle)).collect();
        Self { rows: of_motions.into_iter().flatten().collect(), tokens }
    }

    pub(crate) fn rows(&self) -> &[OneStepRow] {
        &self.rows
    }

    /// The rows of these indices, below the number of [`OneStepData::rows`].
    pub(crate) fn select(&self, indices: &[usize]) -> Result<OneStepBatch, NnError> {
        let n = indices.len();
        let rows: Vec<&OneStepRow> = indices.iter().filter_map(|&idx| self.rows.get(idx)).collect();
        let features: Vec<f64> = rows.iter().flat_map(|row| row.features).collect();
        let targets: Vec<f64> = rows.iter().flat_map(|row| row.target).collect();
        let states: Vec<f64> = rows.iter().flat_map(|row| row.state).collect();
        let effects = rows.iter().flat_map(|row| row.effects.as_flattened());
        let tokens = rows.iter().filter_map(|row| self.tokens.get(row.motion_idx));
        let tokens: Vec<f64> = tokens.flatten().flatten().copied().collect();
        let device = &Device::Cpu;
        Ok(OneStepBatch {
            features: Tensor::from_vec(features, (n, 1, N_FEATURES), device)?,
            tokens: Tensor::from_vec(tokens, (n, N_TOKENS, N_TOKEN_NUMBERS), device)?,
            targets: Tensor::from_vec(targets, (n, 1, 1, N_RESIDUAL), device)?,
            states: Tensor::from_vec(states, (n, N_STATE), device)?,
            effects: Tensor::from_iter(effects.copied(), device)?
                .reshape((n, N_EFFECTS, N_RESIDUAL))?,
        })
    }
}

impl OneStepBatch {
    /// δ_j: `[rows, 1, J, N_RESIDUAL]`.
    ///
    /// - `strengths`: `[J, N_EFFECTS]`.
    pub(crate) fn correction(&self, strengths: &Tensor) -> Result<Tensor, NnError> {
        let (n_components, _) = strengths.dims2()?;
        let n = self.effects.dim(0)?;
        // [J, N] · [N, rows·4]
        let effects = self.effects.transpose(0, 1)?.contiguous()?;
        let flat = effects.reshape((N_EFFECTS, n * N_RESIDUAL))?;
        let correction = strengths.matmul(&flat)?.reshape((n_components, n, N_RESIDUAL))?;
        Ok(correction.transpose(0, 1)?.contiguous()?.unsqueeze(1)?)
    }
}

/// The tokens of a vehicle, which stay the same over a motion, `[1, N_TOKENS, N_TOKEN_NUMBERS]`.
pub(crate) fn token_tensor(vehicle: &VehicleParameters) -> Result<Tensor, NnError> {
    let tokens: Vec<f64> = vehicle_tokens(vehicle).as_flattened().to_vec();
    Ok(Tensor::from_vec(tokens, (1, N_TOKENS, N_TOKEN_NUMBERS), &Device::Cpu)?)
}
