//! What forms will cost, as far as it has been measured.

use std::collections::BTreeMap;
use std::time::Duration;

use crate::app::cost::place::CostPlace;
use crate::app::tasks::{TaskKey, Tasks};
use impactlab_core::data::Outcome;
use impactlab_study::{Cost, Request};

/// Time for which the settings have to rest before they are measured.
pub(super) const REST: Duration = Duration::from_secs(1);

/// What has been measured of a question; `None` if it takes a moment.
pub type MeasuredCost = Result<Option<Cost>, String>;

/// What forms will cost.
#[derive(Default)]
pub struct Costs {
    /// The forms that the last frame has drawn.
    pub(super) seen: Vec<CostPlace>,
    /// The question of each form, and since when it is that, in seconds of the window's clock.
    current: BTreeMap<CostPlace, (Request, f64)>,
    pub(super) running: Option<(CostPlace, Request)>,
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
        if let Some((_, since)) = self.current.get_mut(&place) {
            *since = f64::NEG_INFINITY;
        }
    }

    /// Whether a form is being measured.
    pub fn is_measuring(&self, place: CostPlace) -> bool {
        self.running.as_ref().is_some_and(|(running, ..)| *running == place)
    }

    /// Returns what a form costs with its present settings; `None` if it has not been measured.
    pub fn get(&self, place: CostPlace) -> Option<&MeasuredCost> {
        let (current, _) = self.current.get(&place)?;
        let (question, cost) = self.measured.get(&place)?;
        (question == current).then_some(cost)
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
    pub(super) fn ask(&mut self, place: CostPlace, question: Option<Request>, now_s: f64) {
        let Some(question) = question else {
            self.current.remove(&place);
            return;
        };
        if self.current.get(&place).is_none_or(|(current, _)| *current != question) {
            self.current.insert(place, (question, now_s));
        }
    }

    /// Cancels a measurement of a form that has changed or is out of view.
    pub(super) fn drop_outdated(&mut self, tasks: &mut Tasks) {
        if let Some((place, question)) = &self.running {
            let is_current =
                self.current.get(place).is_some_and(|(current, _)| current == question);
            if !is_current || !self.seen.contains(place) {
                self.stop(tasks);
            }
        }
    }

    pub(super) fn stop(&mut self, tasks: &mut Tasks) {
        self.running = None;
        tasks.stop(&TaskKey::Cost);
    }

    /// Returns a form whose settings have rested and that is to be measured.
    pub(super) fn due(&self, now_s: f64) -> Option<(CostPlace, Request)> {
        if self.running.is_some() {
            return None;
        }
        let is_due = |place: &&CostPlace| {
            let current = self.current.get(place);
            let has_rested = current.is_some_and(|(_, since)| now_s - since >= REST.as_secs_f64());
            has_rested && self.get(**place).is_none()
        };
        let place = self.seen.iter().find(is_due)?;
        Some((*place, self.current.get(place)?.0.clone()))
    }
}
