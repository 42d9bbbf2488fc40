//! What of the response network is saved.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::data::DatasetKind;
use crate::study::{BadCases, CompareRequest, DEFAULT_DRAWS, EvaluatedCases};

/// What the user works on.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ResponseProject {
    /// File of the model; the shipped one without.
    pub model: Option<PathBuf>,
    /// How a motion is forecast.
    pub forecast: ForecastForm,
    /// How a model is trained.
    pub training: ResponseTrainingForm,
    /// How models are compared.
    pub comparison: ComparisonForm,
}

/// Which force drives a forecast.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum ForceChoice {
    /// That of the case's file; of a scenario the classic pulse.
    #[default]
    Given,
    /// What the force network says of the collision.
    Predicted,
}

/// How a motion is forecast.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ForecastForm {
    /// By which force it is driven.
    pub force: ForceChoice,
    /// Whole force curves that are drawn from a predicted force.
    pub n_curves: usize,
    /// Seed of all draws.
    pub seed: u64,
}

impl Default for ForecastForm {
    fn default() -> Self {
        Self { force: ForceChoice::default(), n_curves: DEFAULT_DRAWS, seed: 0 }
    }
}

/// What a training of the response network starts from and learns from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum TrainingMode {
    /// Fine-tunes the shipped pre-trained network on trajectories.
    #[default]
    FineTuneShipped,
    /// Fine-tunes the current model on trajectories.
    FineTuneCurrent,
    /// Trains random weights on trajectories alone.
    FromScratch,
    /// Pre-trains random weights on simulations.
    Pretrain,
}

impl TrainingMode {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::FineTuneShipped, Self::FineTuneCurrent, Self::FromScratch, Self::Pretrain];

    /// For a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::FineTuneShipped => "fine-tune the shipped pre-trained network",
            Self::FineTuneCurrent => "fine-tune the current model",
            Self::FromScratch => "train a new network on trajectories alone",
            Self::Pretrain => "pre-train a new network on simulations",
        }
    }

    /// The kinds of data sets from which it can learn.
    pub fn data_kinds(self) -> &'static [DatasetKind] {
        match self {
            Self::FineTuneShipped | Self::FineTuneCurrent | Self::FromScratch => {
                &[DatasetKind::Trajectory]
            }
            Self::Pretrain => &[DatasetKind::Trajectory, DatasetKind::Force],
        }
    }
}

/// How a model is trained.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ResponseTrainingForm {
    /// What it starts from and learns from.
    #[serde(alias = "course")]
    pub mode: TrainingMode,
    /// Folder of the data set; the first that is open without.
    pub dataset: Option<PathBuf>,
    /// Trajectories to learn from; all that are not kept for the test if not given.
    pub n_trajectories: Option<usize>,
    /// Seed of the split into training and test.
    pub seed: u64,
    /// Seed of the choice of trajectories and of all other draws; the split's if not given.
    pub choice: Option<u64>,
    /// A file with further settings; the model's own or the defaults if empty.
    pub config: String,
    /// What happens to cases that cannot be used.
    pub bad_cases: BadCases,
    /// Whether to go on from where a training of the same settings was interrupted.
    pub resume: bool,
}

/// How models are compared.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ComparisonForm {
    /// Folder of the trajectory data set; the first that is open without.
    pub dataset: Option<PathBuf>,
    /// Numbers of trajectories to fine-tune on, with commas between them.
    pub trajectories: String,
    /// Choices of the trajectories for each number.
    pub n_choices: u64,
    /// Seed of the split and of the first choice.
    pub seed: u64,
    /// A file with settings; the defaults if empty.
    pub config: String,
    /// What happens to cases that cannot be used.
    pub bad_cases: BadCases,
    /// On which cases the current model is evaluated.
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

/// Of which moments the density is shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum DensityChoice {
    /// Of none.
    Hidden,
    /// Of that of the slider.
    #[default]
    Moment,
    /// Of all in a window.
    Window,
}

/// How it is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ResponseView {
    /// Of which moments the density is shown.
    pub density: DensityChoice,
    /// The window, s.
    pub window_s: [f64; 2],
    /// Whether the scene shows the surroundings of the vehicle at the slider's moment only.
    pub follow: bool,
    /// Whether the paths of the components are drawn.
    pub components: bool,
    /// Whether the 4DOF simulation is drawn.
    pub simulation: bool,
    /// Whether the recorded motion is drawn.
    pub reference: bool,
    /// Names of the loss terms that are drawn.
    pub loss_terms: Vec<String>,
    /// Whether the axis of the losses is logarithmic.
    pub log_losses: bool,
    /// The case of a comparison whose paths are drawn.
    pub compared_case: Option<String>,
    /// The choice of the trajectories whose models are drawn in it, from 0.
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
