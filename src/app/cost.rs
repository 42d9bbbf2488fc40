//! What the work that a form describes will cost, measured in the background.
//!
//! It is measured once the settings of a form that is in view have rested for a moment. One form is
//! measured at a time, on threads of the lowest priority, and not while other work is running,
//! which would make it slower. When the settings change or the form is out of view, the measurement
//! is cancelled.

use std::collections::BTreeMap;
use std::time::Duration;

use egui::Context;

use crate::app::command::Command;
use crate::app::state::{Session, State};
use crate::app::tasks::{TaskKey, Tasks};
use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_study::{Cost, Event, Request};

/// Time for which the settings have to rest before they are measured.
const REST: Duration = Duration::from_secs(1);

/// A form with work that takes a while.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum CostPlace {
    /// The training of the force network.
    ForceTraining,
    /// The training of the response network.
    ResponseTraining,
    /// The evaluation of the force network.
    ForceEvaluation,
    /// The comparison of response models.
    Comparison,
    /// The evaluation of the response network.
    ResponseEvaluation,
}

impl CostPlace {
    const ALL: [Self; 5] = [
        Self::ForceTraining,
        Self::ResponseTraining,
        Self::ForceEvaluation,
        Self::Comparison,
        Self::ResponseEvaluation,
    ];
}

/// What has been measured of a question; `None` if it takes a moment.
pub type MeasuredCost = Result<Option<Cost>, String>;

/// What forms will cost.
#[derive(Default)]
pub struct Costs {
    /// The forms that the last frame has drawn.
    seen: Vec<CostPlace>,
    /// The question of each form, and since when it is that, in seconds of the window's clock.
    asked: BTreeMap<CostPlace, (Request, f64)>,
    running: Option<(CostPlace, Request)>,
    measured: BTreeMap<CostPlace, (Request, MeasuredCost)>,
}

impl Costs {
    /// Notes that a form is in view.
    pub fn see(&mut self, place: CostPlace) {
        self.seen.push(place);
    }

    /// Makes a form be measured again, at once.
    pub fn measure_again(&mut self, place: CostPlace) {
        self.measured.remove(&place);
        if let Some((_, since)) = self.asked.get_mut(&place) {
            *since = f64::NEG_INFINITY;
        }
    }

    /// Whether a form is being measured.
    pub fn is_measuring(&self, place: CostPlace) -> bool {
        self.running.as_ref().is_some_and(|(running, ..)| *running == place)
    }

    /// Returns what a form costs with its present settings; `None` if it has not been measured.
    pub fn of(&self, place: CostPlace) -> Option<&MeasuredCost> {
        let (asked, _) = self.asked.get(&place)?;
        let (question, cost) = self.measured.get(&place)?;
        (question == asked).then_some(cost)
    }

    /// Takes what has been measured.
    pub(in crate::app) fn take(
        &mut self,
        place: CostPlace,
        question: Request,
        result: Result<Outcome<Option<Cost>>, String>,
    ) {
        self.running = None;
        let cost = match result {
            Ok(Outcome::Cancelled) => return,
            Ok(Outcome::Complete(cost)) => Ok(cost),
            Err(problem) => Err(problem),
        };
        self.measured.insert(place, (question, cost));
    }

    /// Takes the present question of a form.
    fn ask(&mut self, place: CostPlace, question: Option<Request>, now_s: f64) {
        let Some(question) = question else {
            self.asked.remove(&place);
            return;
        };
        if self.asked.get(&place).is_none_or(|(asked, _)| *asked != question) {
            self.asked.insert(place, (question, now_s));
        }
    }

    /// Cancels a measurement of a form that has changed or is out of view.
    fn drop_outdated(&mut self, tasks: &mut Tasks) {
        if let Some((place, question)) = &self.running {
            let is_asked = self.asked.get(place).is_some_and(|(asked, _)| asked == question);
            if !is_asked || !self.seen.contains(place) {
                self.stop(tasks);
            }
        }
    }

    fn stop(&mut self, tasks: &mut Tasks) {
        self.running = None;
        tasks.stop(&TaskKey::Cost);
    }

    /// Returns a form whose settings have rested and that is to be measured.
    fn due(&self, now_s: f64) -> Option<(CostPlace, Request)> {
        if self.running.is_some() {
            return None;
        }
        let is_due = |place: &&CostPlace| {
            let asked = self.asked.get(place);
            let has_rested = asked.is_some_and(|(_, since)| now_s - since >= REST.as_secs_f64());
            has_rested && self.of(**place).is_none()
        };
        let place = self.seen.iter().find(is_due)?;
        Some((*place, self.asked.get(place)?.0.clone()))
    }
}

impl Session {
    /// Whether a training, an evaluation or a comparison is running.
    fn is_working(&self) -> bool {
        self.force.training.run.is_running()
            || self.response.training.run.is_running()
            || self.force.evaluation.is_running()
            || self.response.comparison.is_running()
    }
}

impl State {
    /// Starts to measure a form whose settings have rested.
    pub(in crate::app) fn update_costs(&mut self, context: &Context) {
        let now_s = context.input(|input| input.time);
        for place in CostPlace::ALL {
            if self.session.costs.seen.contains(&place) {
                let question = self.question_of(place);
                self.session.costs.ask(place, question, now_s);
            }
        }
        let is_working = self.session.is_working();
        let Session { costs, tasks, .. } = &mut self.session;
        costs.drop_outdated(tasks);
        if is_working {
            costs.stop(tasks);
        } else if let Some((place, question)) = self.session.costs.due(now_s) {
            self.measure(place, question);
        } else if !self.session.costs.seen.is_empty() && self.session.costs.running.is_none() {
            context.request_repaint_after(REST);
        }
        self.session.costs.seen.clear();
    }

    fn measure(&mut self, place: CostPlace, question: Request) {
        let (asked, library) = (question.clone(), self.session.library.clone());
        self.session.costs.running = Some((place, question.clone()));
        self.session.tasks.start_in_background(
            TaskKey::Cost,
            move |report| {
                let mut observer = |event: Event<'_>| match event {
                    Event::Progress(progress) => report(progress),
                    Event::Training(_) | Event::Sampling(_) => std::ops::ControlFlow::Continue(()),
                };
                asked.cost(&library, &mut observer).map_err(|error| error_chain(&error))
            },
            move |result| Command::Measured(place, Box::new(question), result),
        );
    }

    /// Returns the question that a form asks; `None` if something is missing.
    fn question_of(&self, place: CostPlace) -> Option<Request> {
        match place {
            CostPlace::ForceTraining => Some(self.force_training()?.0),
            CostPlace::ResponseTraining => Some(self.response_training().ok()?.0),
            CostPlace::ForceEvaluation => self.force_evaluation().map(Request::from),
            CostPlace::Comparison => {
                self.compare_request(self.data_to_compare()?).ok().map(Request::from)
            }
            CostPlace::ResponseEvaluation => {
                self.evaluate_response_request(self.data_to_compare()?).map(Request::from)
            }
        }
    }
}
