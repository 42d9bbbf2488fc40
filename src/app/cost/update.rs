//! Measures a form whose settings have rested.

use egui::Context;
use strum::VariantArray;

use crate::app::command::Command;
use crate::app::cost::costs::REST;
use crate::app::cost::place::CostPlace;
use crate::app::state::{Session, State};
use crate::app::tasks::TaskKey;
use impactlab_core::error_chain;
use impactlab_study::{Event, Request};

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
        for &place in CostPlace::VARIANTS {
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
        let (request, library) = (question.clone(), self.session.library.clone());
        self.session.costs.running = Some((place, question.clone()));
        self.session.tasks.start_in_background(
            TaskKey::Cost,
            move |report| {
                let mut observer = |event: Event<'_>| match event {
                    Event::Progress(progress) => report(progress),
                    Event::Training(_) | Event::Sampling(_) => std::ops::ControlFlow::Continue(()),
                };
                request.cost(&library, &mut observer).map_err(|error| error_chain(&error))
            },
            move |result| Command::Measured(place, Box::new(question), result),
        );
    }

    /// Returns the question that a form asks; `None` if something is missing.
    fn question_of(&self, place: CostPlace) -> Option<Request> {
        match place {
            CostPlace::ForceTraining => Some(self.train_force_request().ok()?.0),
            CostPlace::ResponseTraining => Some(self.train_response_request().ok()?.0),
            CostPlace::ForceEvaluation => self.evaluate_force_request().map(Request::from),
            CostPlace::Comparison => self.compare_request().ok().map(Request::from),
            CostPlace::ResponseEvaluation => {
                self.evaluate_response_request().ok().map(Request::from)
            }
        }
    }
}
