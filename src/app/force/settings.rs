//! The settings of the force network, which are saved between runs.

use serde::{Deserialize, Serialize};

use impactlab_document::figure::ForceComponent;

/// How the force network is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ForceView {
    /// Whether the bands at 50, 80, 90 and 95 % are drawn.
    pub bands: [bool; 4],
    /// Whether F_x, F_y and |F| are drawn.
    pub components: [bool; 3],
    /// Whether the recorded force of the selected case is drawn.
    pub recorded: bool,
    /// Whether the centre curve of the physics model is drawn, to which the network adds its
    /// correction.
    pub physics: bool,
    /// Whether pulses of classic shapes with the impulse of the momentum solution are drawn.
    pub pulses: bool,
    /// Whether selecting a case of a force data set predicts its force.
    pub follow_case: bool,
    /// Names of the loss terms that are drawn, see
    /// [`LossTerms::named`](impactlab_networks::force::LossTerms::named).
    pub loss_terms: Vec<String>,
    /// Whether the axis of the losses is logarithmic.
    pub log_losses: bool,
    /// The statistic over the cases that the tables of errors show.
    pub statistic: Statistic,
    /// The component of the force that is drawn for the sample cases of an evaluation.
    pub sample_component: ForceComponent,
}

/// A statistic that summarises the errors of many cases.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Statistic {
    /// The median.
    #[default]
    Median,
    /// The arithmetic mean.
    Mean,
    /// The 90th percentile.
    P90,
}

impl Statistic {
    /// All statistics.
    pub const ALL: [Self; 3] = [Self::Median, Self::Mean, Self::P90];

    /// Returns the name of the statistic, shown to the user.
    pub fn label(self) -> &'static str {
        match self {
            Self::Median => "median",
            Self::Mean => "mean",
            Self::P90 => "90th percentile",
        }
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
            loss_terms: vec!["total".to_owned()],
            log_losses: true,
            statistic: Statistic::default(),
            sample_component: ForceComponent::Magnitude,
        }
    }
}
