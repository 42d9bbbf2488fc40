//! Every size, weight and rate of the force network, as plain data. The defaults are those of the
//! shipped model; [`ForceConfig::paper`] has the sizes of the paper.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::learning::{LearningError, TEST_SHARE, check_relation, check_settings, load_settings};
use impactlab_core::ranges::FORCE_SETTINGS;

/// All settings of the force network. Settings that a TOML file leaves out keep their default.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ForceConfig {
    /// The layers.
    pub network: NetworkConfig,
    /// The weights of the loss.
    pub loss: LossWeights,
    /// The training.
    pub training: TrainingConfig,
    /// The crush model in the centre.
    pub crush: CrushConfig,
}

/// The curve on which the network is centred.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Centre {
    /// The mean of crush model and regressions, with the share that does best on cases left out.
    #[default]
    Committee,
    /// The crush model: its curve and impulse.
    Crush,
    /// A haversine with the impulse of the momentum solution, restitution and friction fitted.
    Momentum,
    /// Zero: an ablation without the physics layer, in which the impulse is not constrained.
    None,
}

impl Centre {
    /// Whether the crush model is a part of this centre.
    pub fn has_crush(self) -> bool {
        matches!(self, Self::Committee | Self::Crush)
    }
}

/// The layers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NetworkConfig {
    /// The curve on which the network is centred.
    pub centre: Centre,
    /// Widths of the three Swish layers of each branch of the encoder.
    pub encoder_branches: Vec<[usize; 3]>,
    /// Channels d of the positional encoding, even.
    pub position_channels: usize,
    /// Whether there is a layer of attention over time.
    pub attention: bool,
    /// Channels of the attention over time.
    pub attention_channels: usize,
    /// Number of heads of the attention.
    pub attention_heads: usize,
    /// Stride of the keys of the attention: every instant attends to each n-th instant, 1 or more.
    pub attention_stride: usize,
    /// Widths of the trunk.
    pub trunk: Vec<usize>,
    /// Components K of the mixture, 1 or more; with two or more the last one is hooking.
    pub components: usize,
    /// Latent factors per component; 0 for independent instants (ablation).
    pub factors: usize,
    /// Largest share by which the learned shape scales the centre's force, 0 to below 1.
    pub shape_correction: f64,
    /// Largest force that the learned shape adds, in peaks of the centre.
    pub force_correction: f64,
    /// Largest correction of the impulse, as a share of the centre's.
    pub impulse_correction: f64,
    /// Largest shift δ of a component's mean, in peaks of the centre.
    pub component_shift: f64,
    /// The same for the component of hooking.
    pub hooking_shift: f64,
    /// Largest duration Δt_max, s.
    pub duration_max_s: f64,
    /// Smallest standard deviation σ_min of a force, in peaks of the centre.
    pub min_std: f64,
}

/// The weights of the loss terms beside the likelihood.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LossWeights {
    /// Negative log-likelihood of whole curves, per value.
    pub likelihood: f64,
    /// Squared error of the mean curve as a share of the squared curve.
    pub data: f64,
    /// λ_imp: squared error of the impulse as a share of the squared impulse.
    pub impulse: f64,
    /// λ_eng: squared error of the absorbed energy, and square of a negative one.
    pub energy: f64,
    /// Squared error of the duration in units of 0.1 s.
    pub duration: f64,
    /// Cross entropy of hooking.
    pub hooking: f64,
}

/// Settings of the training.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TrainingConfig {
    /// Largest number of epochs.
    pub epochs: usize,
    /// Cases per step.
    pub batch_cases: usize,
    /// AdamW's learning rate η.
    pub learning_rate: f64,
    /// AdamW's weight decay λ.
    pub weight_decay: f64,
    /// Largest norm of the gradient; a longer one is scaled down.
    pub max_gradient_norm: f64,
    /// Share of the training cases that are not trained on but decide when to stop, 0 to 0.5.
    pub validation_share: f64,
    /// Epochs without a better validation loss after which training stops.
    pub patience: usize,
    /// Share of all cases that is kept for the test.
    pub test_share: f64,
    /// Epochs between checkpoints.
    pub checkpoint_epochs: usize,
}

/// The crush model in the centre.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CrushConfig {
    /// Number of folds, 2 or more. One law is fitted without each fold; it predicts the cases of this
    /// fold, and the mean of all laws predicts new scenarios.
    pub folds: usize,
    /// Weight of the prior of the parameters.
    pub prior_weight: f64,
    /// Weight of the impulse beside the history.
    pub impulse_weight: f64,
    /// Weight of hooked and unseparated cases, 0 to 1.
    pub hooked_weight: f64,
    /// Largest number of steps of each fit. Thirty take three times as long and predict no better.
    pub max_steps: usize,
}

impl Default for NetworkConfig {
    fn default() -> Self {
        Self {
            centre: Centre::Committee,
            encoder_branches: vec![[16, 16, 8], [32, 32, 16]],
            position_channels: 32,
            attention: true,
            attention_channels: 64,
            attention_heads: 4,
            attention_stride: 5,
            trunk: vec![64, 64, 32, 16],
            components: 2,
            factors: 12,
            shape_correction: 0.3,
            force_correction: 0.15,
            impulse_correction: 0.2,
            component_shift: 0.05,
            hooking_shift: 1.0,
            duration_max_s: 0.35,
            min_std: 0.01,
        }
    }
}

impl Default for LossWeights {
    fn default() -> Self {
        Self { likelihood: 1.0, data: 3.0, impulse: 3.0, energy: 0.1, duration: 0.1, hooking: 0.1 }
    }
}

impl Default for TrainingConfig {
    fn default() -> Self {
        Self {
            epochs: 300,
            batch_cases: 16,
            learning_rate: 2e-4,
            weight_decay: 0.3,
            max_gradient_norm: 1.0,
            validation_share: 0.2,
            patience: 40,
            test_share: TEST_SHARE,
            checkpoint_epochs: 10,
        }
    }
}

impl Default for CrushConfig {
    fn default() -> Self {
        Self {
            folds: 5,
            prior_weight: 0.07,
            impulse_weight: 0.5,
            hooked_weight: 0.3,
            max_steps: 10,
        }
    }
}

impl ForceConfig {
    /// The network in the sizes of the paper: an encoder of three scales, attention among all instants
    /// and a trunk of eight layers, 675 000 weights instead of 38 000, and the paper's search. On 75
    /// to 175 cases it predicts no better than the default and takes much longer to train.
    ///
    /// Source: [`PitPinnPaper`](impactlab_core::bibliography::PitPinnPaper). The physics in the centre is that
    /// of the default.
    pub fn paper() -> Self {
        Self {
            network: NetworkConfig {
                encoder_branches: vec![[32, 32, 16], [64, 64, 32], [128, 128, 48]],
                attention_stride: 1,
                trunk: vec![256, 512, 512, 256, 128, 64, 32, 16],
                ..NetworkConfig::default()
            },
            training: TrainingConfig {
                epochs: 500,
                batch_cases: 32,
                learning_rate: 1e-3,
                weight_decay: 0.1,
                ..TrainingConfig::default()
            },
            ..Self::default()
        }
    }

    /// Reads a TOML file.
    ///
    /// # Errors
    /// [`LearningError::Toml`], [`LearningError::Setting`].
    pub fn load(path: &Path) -> Result<Self, LearningError> {
        load_settings(path, Self::check)
    }

    /// Checks every setting against [`FORCE_SETTINGS`], and what several must satisfy together.
    ///
    /// # Errors
    /// [`LearningError::Setting`] with the first setting out of range.
    pub fn check(&self) -> Result<(), LearningError> {
        check_settings(self, &FORCE_SETTINGS)?;
        let channels = self.network.position_channels;
        check_relation(
            "network.position_channels",
            channels,
            channels.is_multiple_of(2),
            "an even number",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_changes_what_it_names_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("c.toml");
        std::fs::write(&path, "[network]\ncomponents = 3\n[training]\nepochs = 7\n").unwrap();
        let config = ForceConfig::load(&path).unwrap();
        assert_eq!((config.network.components, config.training.epochs), (3, 7));
        assert_eq!(config.loss, LossWeights::default());
    }

    #[test]
    fn a_wrong_file_says_where() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("c.toml");
        std::fs::write(&path, "[network]\ncomponents = 2\ncolour = 1\n").unwrap();
        let error = ForceConfig::load(&path).unwrap_err().to_string();
        assert!(error.contains("c.toml:3:1: unknown field `colour`"), "{error}");
        std::fs::write(&path, "[training]\nbatch_cases = 0\n").unwrap();
        let error = ForceConfig::load(&path).unwrap_err().to_string();
        let expected = "c.toml:2:15: training.batch_cases is 0, expected 1 to 100000";
        assert!(error.ends_with(expected), "{error}");
        std::fs::write(&path, "[network]\nposition_channels = 7\n").unwrap();
        let error = ForceConfig::load(&path).unwrap_err().to_string();
        assert!(error.ends_with("network.position_channels is 7, expected an even number"));
        std::fs::write(&path, "[network]\ntrunk = []\n").unwrap();
        let error = ForceConfig::load(&path).unwrap_err().to_string();
        assert!(error.ends_with("c.toml:2:9: network.trunk is [], expected 1 to 32 of them"));
    }
}
