//! What a training, an evaluation or a comparison will cost: minutes on this machine, with the data
//! and the settings of the question.
//!
//! Every kind of work that repeats is done once or twice and its time is taken: a step of the fit of
//! the crush model, an epoch of each stage, a move of the swarm. What is measured takes seconds and
//! leaves nothing behind.

mod force;
mod response;

use std::time::{Duration, Instant};

use serde::Serialize;

use crate::{Library, Observer, Request, StudyError};
use impactlab_core::data::Outcome;

/// What an answer will cost.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Cost {
    /// The parts of the work, in their order.
    pub parts: Vec<CostPart>,
    /// Whether the work may end sooner: a fit that settles, a validation loss that stops falling.
    pub is_most: bool,
}

/// Work that is done several times.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CostPart {
    /// What is done, such as “epochs”.
    pub what: String,
    /// How often.
    pub n: f64,
    /// The measured time of each, s.
    pub seconds_each: f64,
}

impl Cost {
    /// The time in all, s.
    pub fn seconds(&self) -> f64 {
        self.parts.iter().map(CostPart::seconds).sum()
    }

    fn add(&mut self, what: impl Into<String>, n: f64, seconds_each: f64) {
        self.parts.push(CostPart { what: what.into(), n, seconds_each });
    }

    /// Adds the work of another question, done several times.
    fn add_all(&mut self, name: &str, other: &Self, n: f64) {
        let part = |part: &CostPart| CostPart {
            what: format!("{name}: {}", part.what),
            n: n * part.n,
            seconds_each: part.seconds_each,
        };
        self.parts.extend(other.parts.iter().map(part));
    }
}

impl CostPart {
    /// The time of all, s.
    pub fn seconds(&self) -> f64 {
        self.n * self.seconds_each
    }
}

impl Request {
    /// Measures what the answer will cost. Nothing is stored.
    ///
    /// - `observer`: when it breaks, the measurement ends as [`Outcome::Cancelled`] soon after;
    /// - returns `None` for a question whose answer takes a moment, and for what is not measured: the
    ///   training on a fleet, cross-validations, comparisons that leave out cars.
    ///
    /// # Errors
    /// [`StudyError`] says what is wrong with the question or with a file, as its answer would.
    pub fn cost(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Option<Cost>>, StudyError> {
        let cost = match self {
            Self::EvaluateForce(request) if request.cross_validate.is_some() => {
                return Ok(Outcome::Complete(None));
            }
            Self::Compare(request) if request.leave_one_car_out => {
                return Ok(Outcome::Complete(None));
            }
            Self::TrainForce(request) => request.cost(library, observer)?,
            Self::EvaluateForce(request) => request.cost(library, observer)?,
            Self::TrainResponse(request) => request.cost(library, observer)?,
            Self::FineTune(request) => return request.cost(library, observer),
            Self::EvaluateResponse(request) => request.cost(library, observer)?,
            Self::Compare(request) => request.cost(library, observer)?,
            _ => return Ok(Outcome::Complete(None)),
        };
        Ok(cost.map(Some))
    }
}

/// Whether an observer has broken, and the time that something took.
struct Watch {
    started: Instant,
    is_broken: bool,
}

impl Watch {
    fn start() -> Self {
        Self { started: Instant::now(), is_broken: false }
    }

    fn elapsed(&self) -> Duration {
        self.started.elapsed()
    }

    fn seconds(&self) -> f64 {
        self.elapsed().as_secs_f64()
    }
}
