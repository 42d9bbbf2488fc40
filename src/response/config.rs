//! Every size, weight and rate of the response network, as plain data.

use serde::{Deserialize, Serialize};

use crate::response::TuningConfig;

/// The layers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ResponseNetworkConfig {
    /// Widths of the Swish layers that encode state, force and time.
    pub encoder: Vec<usize>,
    /// Widths of the three Swish layers of each vehicle token.
    pub token_encoder: [usize; 3],
    /// Heads of the attention from instants to vehicle tokens.
    pub attention_heads: usize,
    /// Widths of the Swish layers after the attention.
    pub trunk: Vec<usize>,
    /// Components J of the mixture, 1 or more.
    pub components: usize,
    /// a_bound: v̇_x, v̇_y, m/s², ṙ, φ̈, rad/s².
    pub bound: [f64; 4],
    /// σ_min of a step's velocities and rates, m/s and rad/s.
    pub min_std: f64,
}

impl Default for ResponseNetworkConfig {
    fn default() -> Self {
        Self {
            encoder: vec![32],
            token_encoder: [8, 8, 8],
            attention_heads: 2,
            trunk: vec![32],
            components: 3,
            bound: [5.0, 5.0, 5.0, 10.0],
            min_std: 0.01,
        }
    }
}

/// All settings. Read from TOML: what a file leaves out keeps its default.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ResponseConfig {
    /// The layers.
    pub network: ResponseNetworkConfig,
    /// The search on single steps.
    pub training: ResponseTrainingConfig,
    /// The search on rollouts.
    pub rollouts: RolloutTrainingConfig,
    /// The search for the parameters of the 4DOF model.
    pub tuning: TuningConfig,
}

/// The search on rollouts of growing length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RolloutTrainingConfig {
    /// Steps of each rollout, one stage after the other; none for single steps alone.
    pub lengths: Vec<usize>,
    /// Steps of the optimiser in each stage.
    pub steps: u64,
    /// Rollouts per step.
    pub batch_windows: usize,
    /// AdamW's learning rate η at the beginning.
    pub learning_rate: f64,
}

impl Default for RolloutTrainingConfig {
    fn default() -> Self {
        Self { lengths: vec![20, 50, 100], steps: 60, batch_windows: 16, learning_rate: 3e-4 }
    }
}

/// The search on single steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ResponseTrainingConfig {
    /// Steps of the optimiser.
    pub steps: u64,
    /// Instants per step.
    pub batch_instants: usize,
    /// AdamW's learning rate η at its highest.
    pub learning_rate: f64,
    /// AdamW's weight decay λ.
    pub weight_decay: f64,
    /// Longest gradient.
    pub max_gradient_norm: f64,
    /// Standard deviation of the noise on features, whose unit is of the order of one.
    pub feature_noise: f64,
}

impl Default for ResponseTrainingConfig {
    fn default() -> Self {
        Self {
            steps: 4000,
            batch_instants: 256,
            learning_rate: 3e-3,
            weight_decay: 1e-2,
            max_gradient_norm: 1.0,
            feature_noise: 0.02,
        }
    }
}
