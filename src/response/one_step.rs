//! What the recorded trajectories say of single steps.

use candle_core::{Device, Tensor};
use rayon::prelude::*;

use crate::nn::NnError;
use crate::response::{
    N_FEATURES, N_RESIDUAL, N_TOKEN_NUMBERS, N_TOKENS, ResponseCase, STEP_S, Tuning, features,
    step, vehicle_tokens,
};
use crate::vehicle::VehicleState;

/// Instants of trajectories: what the network sees and what it should have said.
pub(crate) struct OneStepData {
    /// Rows of [`N_FEATURES`].
    features: Vec<[f64; N_FEATURES]>,
    /// Residual accelerations that lead to the next recorded state.
    targets: Vec<[f64; N_RESIDUAL]>,
    /// Vehicle of each row, an index into the tokens.
    vehicle_idx: Vec<usize>,
    tokens: Vec<[[f64; N_TOKEN_NUMBERS]; N_TOKENS]>,
}

/// Some of them as tensors.
pub(crate) struct OneStepBatch {
    /// `[rows, 1, N_FEATURES]`.
    pub features: Tensor,
    /// `[rows, N_TOKENS, N_TOKEN_NUMBERS]`.
    pub tokens: Tensor,
    /// `[rows, 1, 1, N_RESIDUAL]`.
    pub targets: Tensor,
}

impl OneStepData {
    /// Every step of the cases, around the 4DOF model with this tuning.
    pub(crate) fn of(cases: &[&ResponseCase], tuning: &Tuning) -> Self {
        let rows = |case: &&ResponseCase| -> Vec<_> {
            let vehicle = tuning.apply(&case.vehicle);
            let steps = case.states.iter().zip(case.states.iter().skip(1)).zip(&case.inputs);
            let row = |(i, ((x, next), u)): (usize, ((&VehicleState<f64>, _), &_))| {
                let next: &VehicleState<f64> = next;
                let plain = step(&vehicle, x, u, [0.0; N_RESIDUAL]);
                let target = [
                    next.vx_m_s - plain.vx_m_s,
                    next.vy_m_s - plain.vy_m_s,
                    next.yaw_rate_rad_s - plain.yaw_rate_rad_s,
                    next.roll_rate_rad_s - plain.roll_rate_rad_s,
                ];
                let seen = features(&vehicle, x, u, i as f64 * STEP_S);
                (seen, target.map(|difference| difference / STEP_S))
            };
            steps.enumerate().map(row).collect()
        };
        let of_cases: Vec<Vec<_>> = cases.par_iter().map(rows).collect();
        let vehicle_idx = of_cases.iter().enumerate().flat_map(|(i, rows)| vec![i; rows.len()]);
        let vehicle_idx = vehicle_idx.collect();
        let (features, targets) = of_cases.into_iter().flatten().unzip();
        let tokens = cases.iter().map(|case| vehicle_tokens(&tuning.apply(&case.vehicle)));
        Self { features, targets, vehicle_idx, tokens: tokens.collect() }
    }

    pub(crate) fn n_rows(&self) -> usize {
        self.features.len()
    }

    /// The rows of these indices, below [`OneStepData::n_rows`].
    pub(crate) fn select(&self, rows: &[usize]) -> Result<OneStepBatch, NnError> {
        let n = rows.len();
        let features: Vec<f64> = rows.iter().flat_map(|&row| self.features[row]).collect();
        let targets: Vec<f64> = rows.iter().flat_map(|&row| self.targets[row]).collect();
        let tokens = rows.iter().map(|&row| &self.tokens[self.vehicle_idx[row]]);
        let tokens: Vec<f64> = tokens.flatten().flatten().copied().collect();
        let device = &Device::Cpu;
        Ok(OneStepBatch {
            features: Tensor::from_vec(features, (n, 1, N_FEATURES), device)?,
            tokens: Tensor::from_vec(tokens, (n, N_TOKENS, N_TOKEN_NUMBERS), device)?,
            targets: Tensor::from_vec(targets, (n, 1, 1, N_RESIDUAL), device)?,
        })
    }
}
