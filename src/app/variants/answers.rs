//! The variants of the case with their answers.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::app::latest::Latest;
use crate::app::response::{MotionAnswer, MotionQuestion};
use crate::app::variants::differences::VariantDifferences;
use impactlab_study::case_file::Variant;
use impactlab_study::{SimulateAnswer, SimulateRequest};

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
    /// What the analyst wrote about it.
    pub notes: String,
    /// What it asks otherwise than the first variant; `None` for that itself.
    pub differs: Option<Vec<String>>,
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
    pub(super) fn is_waiting(&self) -> bool {
        self.simulation.is_waiting() || self.forecast.is_waiting()
    }
}

impl AnsweredVariant {
    pub(super) fn new(
        variant: &Variant,
        differences: &VariantDifferences,
        is_shown: bool,
        answers: Option<Answers<'_>>,
        is_waiting: bool,
    ) -> Self {
        let problem = answers.and_then(|(simulation, forecast)| {
            simulation.problem().or(forecast.problem()).map(str::to_owned)
        });
        Self {
            name: variant.name.clone(),
            notes: variant.notes.clone(),
            differs: differences.get(&variant.name).map(<[String]>::to_vec),
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
