//! What of the force network is saved.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::collision::Scenario;
use crate::data::StruckSide;
use crate::figure::ForceComponent;
use crate::force::ForceScenario;
use crate::study::{BadCases, EvaluatedCases};

/// What the user works on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ForceProject {
    /// The collision whose force is predicted.
    pub scenario: ForceScenario,
    /// What it was taken from, for titles.
    pub name: String,
    /// File of the model; the shipped one without.
    pub model: Option<PathBuf>,
    /// How a model is trained.
    pub training: ForceTrainingForm,
}

/// How a model is trained.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ForceTrainingForm {
    /// Folder of the force data set, of which some cases are kept for the test; the first that is
    /// open without.
    pub dataset: Option<PathBuf>,
    /// Whether the cases of all other open force data sets are learned from too.
    pub use_others: bool,
    /// Epochs at most, instead of the configured number.
    pub epochs: Option<usize>,
    /// Seed of split and training.
    pub seed: u64,
    /// A file with further settings; the defaults if empty.
    pub config: String,
    /// What happens to cases that cannot be used.
    pub bad_cases: BadCases,
    /// Whether to go on from where a training of the same settings was interrupted.
    pub resume: bool,
}

/// How it is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ForceView {
    /// Whether the bands at 50, 80, 90 and 95 % are drawn.
    pub bands: [bool; 4],
    /// Whether F_x, F_y and |F| are drawn.
    pub components: [bool; 3],
    /// Whether the recorded force of the selected case is drawn.
    pub recorded: bool,
    /// Whether what the network starts from is drawn.
    pub physics: bool,
    /// Whether classic pulses of the momentum solution are drawn.
    pub pulses: bool,
    /// Whether selecting a case of a force data set predicts it.
    pub follow_case: bool,
    /// Whole curves drawn.
    pub n_curves: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// Names of the loss terms that are drawn, see
    /// [`LossTerms::named`](crate::force::LossTerms::named).
    pub loss_terms: Vec<String>,
    /// Whether the axis of the losses is logarithmic.
    pub log_losses: bool,
    /// Folder of the data set on which the model is evaluated; the first that is open without.
    pub evaluated: Option<PathBuf>,
    /// On which of its cases.
    pub evaluated_cases: EvaluatedCases,
    /// What happens to cases that cannot be used.
    pub bad_cases: BadCases,
    /// Which statistic of the errors the tables show.
    pub statistic: Statistic,
    /// What is drawn of the sample cases.
    pub sample_component: ForceComponent,
}

/// What sums up the errors of many cases.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Statistic {
    /// Half of the cases are better.
    #[default]
    Median,
    /// Arithmetic mean.
    Mean,
    /// Nine tenths of the cases are better.
    P90,
}

impl Statistic {
    /// All three.
    pub const ALL: [Self; 3] = [Self::Median, Self::Mean, Self::P90];

    /// For a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::Median => "median",
            Self::Mean => "mean",
            Self::P90 => "90th percentile",
        }
    }
}

impl Default for ForceProject {
    fn default() -> Self {
        let example = Scenario::example();
        // The example's vehicles meet (a test says so); anything else would do as well.
        let scenario = ForceScenario::from_scenario(&example).unwrap_or(ForceScenario {
            mass_kg: [2000.0, 2000.0],
            target_velocity_m_s: [15.0, 0.0],
            bullet_velocity_m_s: [16.0, 3.0],
            theta_b_rad: 0.3,
            side: StruckSide::Right,
            contact_m: None,
            bullet_position_m: None,
            bullet_body: None,
            yaw_inertia_kg_m2: [None; 2],
        });
        Self { scenario, name: example.name, model: None, training: ForceTrainingForm::default() }
    }
}

impl Default for ForceView {
    fn default() -> Self {
        Self {
            bands: [true; 4],
            components: [true; 3],
            recorded: true,
            physics: false,
            pulses: false,
            follow_case: true,
            n_curves: 0,
            seed: 0,
            loss_terms: vec!["total".to_owned()],
            log_losses: true,
            evaluated: None,
            evaluated_cases: EvaluatedCases::default(),
            bad_cases: BadCases::default(),
            statistic: Statistic::default(),
            sample_component: ForceComponent::Magnitude,
        }
    }
}
