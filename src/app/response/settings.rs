//! The settings of the response network, which are saved between runs.

use serde::{Deserialize, Serialize};

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
    /// Whether paths of drawn motions are shown.
    #[serde(alias = "components")]
    pub drawn_motions: bool,
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
            drawn_motions: true,
            simulation: true,
            reference: true,
            loss_terms: ["total", "data", "trajectory"].map(str::to_owned).to_vec(),
            log_losses: true,
            compared_case: None,
            compared_choice: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_that_were_hidden_under_their_former_name_stay_hidden() {
        let view: ResponseView = serde_json::from_str(r#"{"components": false}"#).unwrap();
        assert_eq!(view, ResponseView { drawn_motions: false, ..ResponseView::default() });
    }
}
