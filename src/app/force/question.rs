//! What the force network is asked and what it answers.

use std::sync::Arc;

use crate::analysis::{ForceForecast, ForecastSettings, pulse_curves};
use crate::app::latest::Question;
use crate::collision::PulseShape;
use crate::error_chain;
use crate::force::{ForceModel, ForceScenario, OutsideTraining};
use crate::uncertainty::ForceCurve;

/// What is to be predicted.
#[derive(Clone)]
pub struct ForceQuestion {
    /// By whom.
    pub model: Arc<ForceModel>,
    /// The collision.
    pub scenario: ForceScenario,
    /// Curves to draw.
    pub settings: ForecastSettings,
}

/// What the network says of a collision.
#[derive(Debug, Clone, PartialEq)]
pub struct Forecast {
    /// The collision.
    pub scenario: ForceScenario,
    /// How many curves were drawn, and from which seed.
    pub settings: ForecastSettings,
    /// Bands, curves and numbers.
    pub force: ForceForecast,
    /// What the network starts from: its centre.
    pub physics: ForceCurve,
    /// Classic pulses with the momentum solution's impulse over the predicted duration.
    pub pulses: Vec<(PulseShape, ForceCurve)>,
    /// Impulse of the momentum solution, N s.
    pub momentum_impulse_n_s: [f64; 2],
    /// Where the collision is unlike all that was learned from.
    pub outside: Vec<OutsideTraining>,
    /// Probability that the bullet's corner stays caught, where the model tells.
    pub hooking_probability: Option<f64>,
    /// What was left open and averaged over.
    pub open: Vec<&'static str>,
}

impl Question for ForceQuestion {
    type Answer = Forecast;
    const NAME: &'static str = "predict force";

    fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.model, &other.model)
            && self.scenario == other.scenario
            && self.settings == other.settings
    }

    fn answer(&self) -> Result<Forecast, String> {
        predict(self)
    }
}

/// # Errors
/// A message for the user.
fn predict(question: &ForceQuestion) -> Result<Forecast, String> {
    let prediction =
        question.model.predict(&question.scenario).map_err(|error| error_chain(&error))?;
    let force = ForceForecast::of(&prediction.mixture, question.settings)
        .map_err(|error| error_chain(&error))?;
    let pulses = pulse_curves(prediction.momentum_impulse_n_s, force.duration_s.median)
        .map_err(|error| error_chain(&error))?;
    let open = [
        (prediction.is_contact_open, "the contact point"),
        (prediction.is_body_open, "the bullet's body"),
    ];
    Ok(Forecast {
        scenario: question.scenario.clone(),
        settings: question.settings,
        force,
        physics: prediction.centre,
        pulses,
        momentum_impulse_n_s: prediction.momentum_impulse_n_s,
        outside: prediction.outside,
        hooking_probability: prediction.hooking_probability,
        open: open.into_iter().filter_map(|(is_open, what)| is_open.then_some(what)).collect(),
    })
}
