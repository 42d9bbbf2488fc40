//! Asks the questions of the variants that are not in the forms.

use egui::Context;

use crate::app::command::wake;
use crate::app::response::MotionQuestion;
use crate::app::state::{Session, State};
use crate::app::variants::answers::{AnsweredVariant, VariantAnswers};
use impactlab_study::case_file::Variant;
use impactlab_study::{PredictMotionRequest, Request, SimulateRequest};

impl State {
    /// Receives the answers of the variants that are not in the forms and asks for the next one. They
    /// are asked one after the other, and after those of the variant in the forms, which they would
    /// make wait.
    pub(in crate::app) fn update_variants(&mut self, context: &Context) {
        self.find_differences();
        let is_busy = self.session.is_waiting();
        let (file, session) = (&self.case.file, &mut self.session);
        let is_other = |variant: &&Variant| variant.name != file.shown;
        let Session { other_variants, library, .. } = session;
        let shows_all = self.view.shows_all_variants;
        other_variants
            .retain(|name, _| shows_all && *name != file.shown && file.variant(name).is_some());
        for answers in other_variants.values_mut() {
            answers.simulation.poll();
            answers.forecast.poll();
        }
        if !shows_all || is_busy || other_variants.values().any(VariantAnswers::is_waiting) {
            return;
        }
        for variant in file.variants.iter().filter(is_other) {
            let (simulate, predict) = questions(variant);
            let answers = other_variants.entry(variant.name.clone()).or_default();
            match simulate {
                Some(question) => answers.simulation.ask(question.clone(), library, wake(context)),
                None => answers.simulation.forget(),
            }
            match predict.map(|request| MotionQuestion { request: request.clone() }) {
                Some(question) => answers.forecast.ask(question, library, wake(context)),
                None => answers.forecast.forget(),
            }
            if answers.is_waiting() {
                return;
            }
        }
    }

    /// Finds what the variants ask otherwise than the first one; of one alone there is nothing to find.
    fn find_differences(&mut self) {
        let Session { known_case, variant_differences, .. } = &mut self.session;
        let variants: &[Variant] = match known_case.variants.as_slice() {
            [] | [_] => &[],
            several => several,
        };
        variant_differences.update(variants, self.view.units);
    }

    /// Every variant of the case with its answers, in the order of the case. Those of another variant
    /// than the one in the forms are there if all variants are to be shown.
    pub fn answered_variants(&self) -> Vec<AnsweredVariant> {
        let session = &self.session;
        let shown = &self.case.file.shown;
        let differences = &session.variant_differences;
        let answered = |variant: &Variant| {
            if variant.name == *shown {
                let is_waiting = session.is_simulation_late() || session.is_motion_late();
                let answers = (&session.analysis, &session.response.forecast);
                return AnsweredVariant::new(variant, differences, true, Some(answers), is_waiting);
            }
            let answers = session.other_variants.get(&variant.name);
            let is_waiting = match answers {
                Some(answers) => answers.is_waiting(),
                None => self.view.shows_all_variants,
            };
            let answers = answers.map(|of| (&of.simulation, &of.forecast));
            AnsweredVariant::new(variant, differences, false, answers, is_waiting)
        };
        self.case.file.variants.iter().map(answered).collect()
    }
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
