//! The settings of the response network, which are saved between runs.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use impactlab_core::data::DatasetKind;
use impactlab_study::{BadCases, CompareRequest, EvaluatedCases};

/// The initial weights and the data of a training of the response network.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, strum::VariantArray,
)]
pub enum TrainingMode {
    /// Fine-tune the shipped pre-trained network on trajectories.
    #[default]
    FineTuneShipped,
    /// Fine-tune the current model on trajectories.
    FineTuneCurrent,
    /// Tell the current model, which knows how cars differ, trajectories of one: seconds.
    Condition,
    /// Train a network with random initial weights on trajectories alone.
    FromScratch,
    /// Pre-train a network with random initial weights on simulations.
    Pretrain,
}

impl TrainingMode {
    /// All modes.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// Returns the name of the mode, shown to the user.
    pub fn label(self) -> &'static str {
        match self {
            Self::FineTuneShipped => "fine-tune the shipped pre-trained network",
            Self::FineTuneCurrent => "fine-tune the current model",
            Self::Condition => "tell the current model of a car (seconds)",
            Self::FromScratch => "train a new network on trajectories alone",
            Self::Pretrain => "pre-train a new network on simulations",
        }
    }

    /// Whether a training in this mode can learn from a log of one impact.
    pub fn takes_log(self) -> bool {
        self != Self::Pretrain
    }

    /// Returns the kinds of data sets from which a training in this mode can learn.
    pub fn data_kinds(self) -> &'static [DatasetKind] {
        match self {
            Self::FineTuneShipped | Self::FineTuneCurrent | Self::Condition | Self::FromScratch => {
                &[DatasetKind::Trajectory]
            }
            Self::Pretrain => &[DatasetKind::Trajectory, DatasetKind::Force],
        }
    }
}

/// Settings of a training of the response network.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ResponseTrainingForm {
    /// The initial weights and the data of the training.
    #[serde(alias = "course")]
    pub mode: TrainingMode,
    /// Folder of the data set to train on; `None` takes the first one that is open.
    pub dataset: Option<PathBuf>,
    /// A log of one impact, open as a file, to learn from instead of a data set.
    pub log: Option<PathBuf>,
    /// The file with the contact force of the log; `None` estimates it from the motion.
    pub log_force: Option<PathBuf>,
    /// Number of trajectories to train on; `None` takes all that are not kept for the test.
    pub n_trajectories: Option<usize>,
    /// Seed of the split into training and test cases.
    pub seed: u64,
    /// Seed of the choice of trajectories and of all other random draws; `None` takes the seed of
    /// the split.
    pub choice: Option<u64>,
    /// Path of a file with further settings; if empty, those of the model or the defaults.
    pub config: String,
    /// How cases that cannot be used are treated.
    pub bad_cases: BadCases,
}

/// Settings of a comparison of response models.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ComparisonForm {
    /// Folder of the trajectory data set; `None` takes the first one that is open.
    pub dataset: Option<PathBuf>,
    /// Numbers of trajectories to fine-tune on, separated by commas.
    pub trajectories: String,
    /// Number of random choices of trajectories for each of these numbers.
    pub n_choices: u64,
    /// Seed of the split into training and test cases and of the first choice of trajectories.
    pub seed: u64,
    /// Path of a file with settings; empty for the default settings.
    pub config: String,
    /// How cases that cannot be used are treated.
    pub bad_cases: BadCases,
    /// The cases on which the current model is evaluated.
    pub evaluated_cases: EvaluatedCases,
}

impl Default for ComparisonForm {
    fn default() -> Self {
        let usual = CompareRequest::new("");
        let numbers: Vec<String> = usual.trajectories.iter().map(usize::to_string).collect();
        Self {
            dataset: None,
            trajectories: numbers.join(", "),
            n_choices: usual.choices,
            seed: usual.seed,
            config: String::new(),
            bad_cases: usual.bad_cases,
            evaluated_cases: EvaluatedCases::default(),
        }
    }
}

/// The times for which the density of the position is shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum DensityChoice {
    /// The density is not shown.
    Hidden,
    /// The density at the time that is shown in the scene.
    #[default]
    Moment,
    /// The density averaged over a time window.
    Window,
}

/// How the response network is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ResponseView {
    /// The times for which the density is shown.
    pub density: DensityChoice,
    /// First and last time of the window, s.
    pub window_s: [f64; 2],
    /// Whether the scene follows the vehicle and shows only its surroundings at the current time.
    pub follow: bool,
    /// Whether the paths of the mixture components are drawn.
    pub components: bool,
    /// Whether the simulated motion of the 4DOF model is drawn.
    pub simulation: bool,
    /// Whether the recorded motion is drawn.
    pub reference: bool,
    /// Names of the loss terms that are drawn.
    pub loss_terms: Vec<String>,
    /// Whether the axis of the losses is logarithmic.
    pub log_losses: bool,
    /// The case of a comparison whose paths are drawn; `None` leaves the choice to the pane.
    pub compared_case: Option<String>,
    /// Index of the random choice of trajectories whose models are drawn for that case, from 0.
    pub compared_choice: u64,
}

impl Default for ResponseView {
    fn default() -> Self {
        Self {
            density: DensityChoice::default(),
            window_s: [0.0, 4.0],
            follow: false,
            components: true,
            simulation: true,
            reference: true,
            loss_terms: ["total", "data", "trajectory"].map(str::to_owned).to_vec(),
            log_losses: true,
            compared_case: None,
            compared_choice: 0,
        }
    }
}
