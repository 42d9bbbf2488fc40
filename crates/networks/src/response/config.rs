//! Every size, weight and rate of the response network, as plain data.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::learning::{LearningError, check_relation, check_settings, load_settings};
use crate::response::{Correction, EffectsConfig, TuningConfig};
use impactlab_core::ranges::RESPONSE_SETTINGS;

/// All settings of the response network and its training. Read from TOML: what a file leaves out keeps
/// its default.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ResponseConfig {
    /// Sizes of the layers, and the bounds of the correction.
    pub network: ResponseNetworkConfig,
    /// Training on simulations, before any trajectory is seen.
    pub pretraining: PretrainingConfig,
    /// Fine-tuning on single steps.
    pub single_steps: SingleStepConfig,
    /// Fine-tuning on rollouts.
    pub rollouts: RolloutConfig,
    /// Weights of the loss terms.
    pub loss: ResponseLossWeights,
    /// How strongly the physics loss weighs, epoch by epoch.
    pub physics: PhysicsSchedule,
    /// The fit of the effects' strengths.
    pub effects: EffectsConfig,
    /// How the uncertainty is calibrated.
    pub calibration: CalibrationConfig,
    /// The search for the parameters of the tuned 4DOF model, the baseline.
    pub tuning: TuningConfig,
}

/// Sizes of the layers, and the bounds of the correction.
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
    /// The quantity that the network corrects.
    pub correction: Correction,
    /// Whether the effects of known form that the 4DOF model leaves out are part of the network.
    pub effects: bool,
    /// Bound a_bound of the correction: of v̇_x, v̇_y, m/s², ṙ, φ̈, rad/s²; without one, the correction
    /// is not bounded. Where offsets of the state are corrected: their bounds, m/s and rad/s.
    pub bound: Option<[f64; 4]>,
    /// The correction at a network output of one, in the units of the bound.
    pub unit: [f64; 4],
    /// Smallest standard deviation σ_min of the velocities and rates after a step, m/s and rad/s.
    pub min_std: f64,
}

/// Training on simulations of the 4DOF model under recorded forces, with vehicles, frictions and
/// speeds drawn at random: the network learns what another vehicle does differently.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PretrainingConfig {
    /// Number of simulated motions.
    pub motions: usize,
    /// Passes over the simulated motions; 0 leaves the pre-training out.
    pub epochs: usize,
    /// Highest learning rate η of AdamW.
    pub learning_rate: f64,
}

/// Fine-tuning on single steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SingleStepConfig {
    /// Passes over the instants of the trajectories.
    pub epochs: usize,
    /// Instants per step of the optimiser.
    pub batch_instants: usize,
    /// Highest learning rate η of AdamW.
    pub learning_rate: f64,
    /// Weight decay λ of AdamW.
    pub weight_decay: f64,
    /// Norm to which a longer gradient is shortened.
    pub max_gradient_norm: f64,
    /// Standard deviation of the noise that is added to the features, whose unit is of the order of one.
    pub feature_noise: f64,
    /// Share of the layers, counted from the input, that fine-tuning does not change.
    pub frozen_share: f64,
}

/// Fine-tuning on rollouts of growing length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RolloutConfig {
    /// Steps of each rollout, one stage after the other; an empty list leaves the rollouts out.
    pub lengths: Vec<usize>,
    /// Passes over the trajectories in each stage; a pass takes one window of each trajectory.
    pub epochs: usize,
    /// Rollouts per step of the optimiser.
    pub batch_windows: usize,
    /// Learning rate η of AdamW at the beginning of a stage.
    pub learning_rate: f64,
    /// Steps after which the gradient is no longer propagated back.
    pub truncation: usize,
}

/// Calibration of what is uncertain along a motion, on trajectories that a training has not seen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CalibrationConfig {
    /// Number of trainings that each leave out a part of the trajectories; below 2 nothing is calibrated
    /// and the usual scales are taken.
    pub folds: usize,
    /// Standard deviation of the logarithm of a scale about the usual one, before any trajectory.
    pub prior_std: f64,
}

/// Weights of the loss terms.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ResponseLossWeights {
    /// Weight of the negative log-likelihood.
    pub likelihood: f64,
    /// Weight of the physics, times the scheduled λ.
    pub physics: f64,
    /// Weight λ_cons of the penalty on components that coincide.
    pub diversity: f64,
    /// Weight λ_traj of the position error of rollouts.
    pub trajectory: f64,
    /// Weight λ_smooth of the second derivative of rollouts.
    pub smoothness: f64,
    /// Weight λ_bound of states near or beyond what is physical.
    pub boundary: f64,
}

/// How λ_physics changes with the epochs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PhysicsTrend {
    /// Grows with the epochs, and is least where data are far: the formula as printed.
    Paper,
    /// Falls with the epochs, as the paper's words say.
    Decay,
    /// Falls with the epochs, and is largest where data are far.
    #[default]
    InverseQuality,
}

/// λ_physics over the epochs of fine-tuning.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PhysicsSchedule {
    /// How the weight changes with the epochs.
    pub trend: PhysicsTrend,
    /// Smallest weight λ_min.
    pub min: f64,
    /// Largest weight λ_max.
    pub max: f64,
    /// Epoch t₀ at the middle of the change.
    pub midpoint_epoch: f64,
    /// Width τ of the change, epochs.
    pub epoch_scale: f64,
    /// Distance h in DataQuality = exp(−d/h), where d is the distance to the nearest instant of the
    /// data: the root mean square over the standardised features.
    pub quality_distance: f64,
    /// Instants of simulated motions, away from the data, at which the physics loss is evaluated in each
    /// step of the optimiser.
    pub batch_instants: usize,
}

impl Default for ResponseNetworkConfig {
    fn default() -> Self {
        Self {
            encoder: vec![32],
            token_encoder: [8, 8, 8],
            attention_heads: 2,
            trunk: vec![32],
            components: 3,
            correction: Correction::Acceleration,
            effects: true,
            bound: Some([5.0, 5.0, 5.0, 10.0]),
            unit: [0.3, 0.3, 0.3, 1.0],
            min_std: 0.01,
        }
    }
}

impl ResponseNetworkConfig {
    /// The plain network of the comparison: the same layers without guard, without the 4DOF centre.
    #[must_use]
    pub fn plain(&self) -> Self {
        Self {
            correction: Correction::Whole,
            effects: false,
            bound: None,
            unit: [5.0, 5.0, 2.0, 5.0],
            ..self.clone()
        }
    }
}

impl Default for PretrainingConfig {
    fn default() -> Self {
        Self { motions: 200, epochs: 30, learning_rate: 3e-3 }
    }
}

impl Default for SingleStepConfig {
    fn default() -> Self {
        Self {
            epochs: 100,
            batch_instants: 256,
            learning_rate: 3e-3,
            weight_decay: 1e-2,
            max_gradient_norm: 1.0,
            feature_noise: 0.02,
            frozen_share: 0.6,
        }
    }
}

impl Default for RolloutConfig {
    fn default() -> Self {
        Self {
            lengths: vec![20, 50, 100],
            epochs: 40,
            batch_windows: 10,
            learning_rate: 3e-4,
            truncation: 100,
        }
    }
}

impl Default for CalibrationConfig {
    fn default() -> Self {
        Self { folds: 5, prior_std: 1.0 }
    }
}

impl Default for ResponseLossWeights {
    fn default() -> Self {
        Self {
            likelihood: 0.05,
            physics: 0.01,
            diversity: 0.01,
            trajectory: 1.0,
            smoothness: 1e-3,
            boundary: 0.1,
        }
    }
}

impl Default for PhysicsSchedule {
    fn default() -> Self {
        Self {
            trend: PhysicsTrend::default(),
            min: 0.1,
            max: 10.0,
            midpoint_epoch: 50.0,
            epoch_scale: 15.0,
            quality_distance: 0.1,
            batch_instants: 64,
        }
    }
}

impl ResponseConfig {
    /// The settings of the plain network of the comparison: the same layers, data and effort,
    /// without guard, 4DOF centre and losses of physics.
    #[must_use]
    pub fn plain(&self) -> Self {
        let loss = ResponseLossWeights { physics: 0.0, boundary: 0.0, ..self.loss };
        Self { network: self.network.plain(), loss, ..self.clone() }
    }

    /// Reads settings.
    ///
    /// # Errors
    /// [`LearningError::Toml`] with the line, [`LearningError::Setting`].
    pub fn load(path: &Path) -> Result<Self, LearningError> {
        load_settings(path, Self::check)
    }

    /// Checks every setting against [`RESPONSE_SETTINGS`], and what several must satisfy together.
    ///
    /// # Errors
    /// [`LearningError::Setting`] with the first setting out of range.
    pub fn check(&self) -> Result<(), LearningError> {
        check_settings(self, &RESPONSE_SETTINGS)?;
        let network = &self.network;
        let heads = network.attention_heads;
        let hidden = network.encoder.last().copied().unwrap_or(0);
        check_relation(
            "network.attention_heads",
            heads,
            hidden.is_multiple_of(heads),
            "a divisor of the encoder's last width",
        )?;
        check_relation(
            "network.effects",
            network.effects,
            !network.effects || network.correction == Correction::Acceleration,
            "false where the correction is no acceleration",
        )
    }
}
