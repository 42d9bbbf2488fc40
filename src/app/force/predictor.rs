//! Predicts on a thread of its own, so that the window keeps its pace: while a slider moves, only
//! the latest question is answered, and the last answer stays until the next one comes.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use crate::analysis::{ForceForecast, ForecastSettings, pulse_curves};
use crate::collision::PulseShape;
use crate::error_chain;
use crate::force::{ForceModel, ForceScenario, OutsideTraining};
use crate::jobs::{Job, Progress, Update};
use crate::uncertainty::ForceCurve;

/// What is to be predicted.
#[derive(Clone)]
pub struct Question {
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

/// A thread that answers questions.
pub struct Predictor {
    job: Job<()>,
    questions: Sender<Question>,
    answers: Receiver<Result<Forecast, String>>,
}

impl Question {
    /// Whether the answer would be the same.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.model, &other.model)
            && self.scenario == other.scenario
            && self.settings == other.settings
    }
}

impl Predictor {
    /// Starts the thread. `wake` is called after every answer.
    ///
    /// # Errors
    /// The operating system's, if no thread can be started.
    pub fn spawn(wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let (questions, asked) = channel::<Question>();
        let (answer, answers) = channel();
        let job = Job::spawn("predict", wake, move |report| {
            let mut n_answers = 0;
            while let Ok(mut question) = asked.recv() {
                while let Ok(newer) = asked.try_recv() {
                    question = newer;
                }
                n_answers += 1;
                let progress = Progress::new(n_answers, 0, "predicting");
                if answer.send(predict(&question)).is_err() || report(progress).is_break() {
                    break;
                }
            }
        })?;
        Ok(Self { job, questions, answers })
    }

    /// Asks; `false` if the thread is gone.
    pub fn ask(&self, question: Question) -> bool {
        self.questions.send(question).is_ok()
    }

    /// The latest answer since the last call. A panic comes as the inner error, after which the
    /// thread is gone.
    pub fn answer(&mut self) -> Option<Result<Forecast, String>> {
        let latest = self.answers.try_iter().last();
        match self.job.poll() {
            Update::Panicked(text) => Some(Err(format!("internal error: {text}"))),
            _ => latest,
        }
    }
}

/// # Errors
/// A message for the user.
fn predict(question: &Question) -> Result<Forecast, String> {
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
