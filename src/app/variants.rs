//! The answers of the variants that are not in the forms, so that all variants are shown side by side.

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::Context;

use crate::app::command::wake;
use crate::app::latest::Latest;
use crate::app::response::{MotionAnswer, MotionQuestion};
use crate::app::state::{Session, State};
use impactlab_study::case_file::Variant;
use impactlab_study::{PredictMotionRequest, Request, SimulateAnswer, SimulateRequest};

/// The answers of one variant.
#[derive(Default)]
pub struct VariantAnswers {
    /// The simulation of its subject.
    pub simulation: Latest<SimulateRequest>,
    /// The forecast of the motion.
    pub forecast: Latest<MotionQuestion>,
}

/// The answers of the variants that are not in the forms, by their names.
pub type OtherVariants = BTreeMap<String, VariantAnswers>;

/// Simulation and forecast of a variant.
type Answers<'a> = (&'a Latest<SimulateRequest>, &'a Latest<MotionQuestion>);

/// A variant with the answers that there are.
pub struct AnsweredVariant {
    /// What it is called.
    pub name: String,
    /// Whether it is the one in the forms.
    pub is_shown: bool,
    /// The simulation of its subject.
    pub simulation: Option<Arc<SimulateAnswer>>,
    /// The forecast of the motion.
    pub forecast: Option<Arc<MotionAnswer>>,
    /// Why there is none of these.
    pub problem: Option<String>,
    /// Whether an answer is awaited.
    pub is_waiting: bool,
}

impl VariantAnswers {
    fn is_waiting(&self) -> bool {
        self.simulation.is_waiting() || self.forecast.is_waiting()
    }
}

impl State {
    /// Receives the answers of the variants that are not in the forms and asks for the next one. They
    /// are asked one after the other, and after those of the variant in the forms, which they would
    /// make wait.
    pub(in crate::app) fn update_variants(&mut self, context: &Context) {
        let is_busy = self.session.is_waiting();
        let (file, session) = (&self.case.file, &mut self.session);
        let is_other = |variant: &&Variant| variant.name != file.shown;
        let Session { other_variants, library, .. } = session;
        let is_asked = self.view.shows_all_variants;
        other_variants
            .retain(|name, _| is_asked && *name != file.shown && file.variant(name).is_some());
        for answers in other_variants.values_mut() {
            answers.simulation.poll();
            answers.forecast.poll();
        }
        if !is_asked || is_busy || other_variants.values().any(VariantAnswers::is_waiting) {
            return;
        }
        for variant in file.variants.iter().filter(is_other) {
            let (simulate, predict) = questions(variant);
            let answers = other_variants.entry(variant.name.clone()).or_default();
            if let Some(question) = simulate {
                answers.simulation.ask(question.clone(), library, wake(context));
            }
            if let Some(request) = predict {
                let question = MotionQuestion { request: request.clone() };
                answers.forecast.ask(question, library, wake(context));
            }
            if answers.is_waiting() {
                return;
            }
        }
    }

    /// Every variant of the case with its answers, in the order of the case. Those of another variant
    /// than the one in the forms are there if all variants are to be shown.
    pub fn answered_variants(&self) -> Vec<AnsweredVariant> {
        let session = &self.session;
        let shown = &self.case.file.shown;
        let answered = |variant: &Variant| {
            let name = variant.name.clone();
            if name == *shown {
                let is_waiting = session.is_simulation_late() || session.is_motion_late();
                let answers = (&session.analysis, &session.response.forecast);
                return AnsweredVariant::new(name, true, (Some(answers), is_waiting));
            }
            let answers = session.other_variants.get(&name);
            let is_waiting = match answers {
                Some(answers) => answers.is_waiting(),
                None => self.view.shows_all_variants,
            };
            let answers = answers.map(|of| (&of.simulation, &of.forecast));
            AnsweredVariant::new(name, false, (answers, is_waiting))
        };
        self.case.file.variants.iter().map(answered).collect()
    }
}

impl AnsweredVariant {
    fn new(
        name: String,
        is_shown: bool,
        (answers, is_waiting): (Option<Answers<'_>>, bool),
    ) -> Self {
        let problem = answers.and_then(|(simulation, forecast)| {
            simulation.problem().or(forecast.problem()).map(str::to_owned)
        });
        Self {
            name,
            is_shown,
            simulation: answers.and_then(|(simulation, _)| simulation.ok().cloned()),
            forecast: answers.and_then(|(_, forecast)| forecast.ok().cloned()),
            problem,
            is_waiting,
        }
    }
}

/// Whether an answer about a variant that is not in the forms is awaited, so that figures over which
/// these are drawn are not complete.
pub fn are_others_awaited(variants: &[AnsweredVariant]) -> bool {
    variants.iter().any(|variant| !variant.is_shown && variant.is_waiting)
}

/// The simulations of the variants that are not in the forms, by the names of these.
pub fn other_simulations(
    variants: &[AnsweredVariant],
) -> impl Iterator<Item = (&str, &SimulateAnswer)> {
    let others = variants.iter().filter(|variant| !variant.is_shown);
    others.filter_map(|variant| Some((variant.name.as_str(), &**variant.simulation.as_ref()?)))
}

/// The forecasts of the variants that are not in the forms, by the names of these.
pub fn other_forecasts(
    variants: &[AnsweredVariant],
) -> impl Iterator<Item = (&str, &MotionAnswer)> {
    let others = variants.iter().filter(|variant| !variant.is_shown);
    others.filter_map(|variant| Some((variant.name.as_str(), &**variant.forecast.as_ref()?)))
}

/// The questions of a variant that are shown beside those of another.
fn questions(variant: &Variant) -> (Option<&SimulateRequest>, Option<&PredictMotionRequest>) {
    let mut found = (None, None);
    for request in &variant.questions {
        match request {
            Request::Simulate(request) => found.0 = Some(&**request),
            Request::PredictMotion(request) => found.1 = Some(&**request),
            _ => {}
        }
    }
    found
}
