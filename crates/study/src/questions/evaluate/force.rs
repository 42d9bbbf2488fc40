//! How well a force network does on data, beside its baselines: `evaluate force`.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::{ForceForecast, ForecastSettings, bands_of_draws};
use crate::ask::checks::check_count;
use crate::ask::inputs::{UsableCases, force_cases};
use crate::ask::question::progress_of;
use crate::caveats::restrictions;
use crate::{
    Answer, BadCases, EvaluatedCases, Event, Library, ModelChoice, Observer, Provenance, Question,
    StudyError,
};
use impactlab_core::data::Outcome;
use impactlab_core::jobs::Progress;
use impactlab_core::numerics::random_stream;
use impactlab_core::ranges::FOLDS;
use impactlab_core::uncertainty::{Caveat, Caveats, CurveMixture};
use impactlab_core::units::Estimate;
use impactlab_networks::force::metrics::ProbabilisticSettings;
use impactlab_networks::force::{
    ColumnSet, CrossValidation, Evaluation, EvaluationSettings, ForceCase, ForceError, ForceModel,
    cross_validate, evaluate_model,
};

/// Cases that are drawn with their bands.
const N_SAMPLE_CASES: usize = 6;

/// Asks how well a force network predicts the cases of a data set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EvaluateForceRequest {
    /// The force network.
    #[serde(default)]
    pub model: ModelChoice,
    /// The force data set.
    pub data: PathBuf,
    /// Which of its cases.
    #[serde(default)]
    pub split: EvaluatedCases,
    /// What is known of each collision.
    #[serde(default = "all_columns")]
    pub columns: ColumnSet,
    /// Instead: train anew with the model's settings in this many folds of its training cases, so
    /// that no test case is looked at.
    #[serde(default)]
    pub cross_validate: Option<usize>,
    /// Seed of folds, clusters and draws.
    #[serde(default)]
    pub seed: u64,
    /// What happens to cases that cannot be used.
    #[serde(default)]
    pub bad_cases: BadCases,
    /// Whether intervals and bands of single cases are computed for figures. The report does not
    /// depend on it.
    #[serde(default)]
    pub for_figures: bool,
}

fn all_columns() -> ColumnSet {
    ColumnSet::ThetaContactAndBody
}

impl EvaluateForceRequest {
    /// An evaluation of a model on a data set in which nothing else is said.
    pub fn new(model: ModelChoice, data: impl Into<PathBuf>) -> Self {
        Self {
            model,
            data: data.into(),
            split: EvaluatedCases::default(),
            columns: all_columns(),
            cross_validate: None,
            seed: 0,
            bad_cases: BadCases::default(),
            for_figures: false,
        }
    }

    /// The cases that the model is evaluated on, and why others are left out.
    pub(crate) fn test_cases(
        &self,
        model: &ForceModel,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<UsableCases<ForceCase>>, StudyError> {
        let cases = force_cases(&self.data, self.bad_cases, library, observer)?;
        let Outcome::Complete(usable) = cases else { return Ok(Outcome::Cancelled) };
        let is_wanted =
            |case: &ForceCase| self.split == EvaluatedCases::All || !model.is_trained_on(case);
        let cases: Vec<ForceCase> = usable.cases.into_iter().filter(is_wanted).collect();
        if cases.is_empty() {
            return Err(StudyError::NoTestCase { path: self.data.clone() });
        }
        Ok(Outcome::Complete(UsableCases { cases, left_out: usable.left_out }))
    }
}

/// What is told of an evaluation or a cross-validation.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ForceEvaluation {
    /// The model on cases of the data set.
    Cases(Box<EvaluateForceReport>),
    /// Models trained anew, each on the cases that it has not seen.
    Folds(Box<CrossValidateForceReport>),
}

/// A force network on cases of a data set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EvaluateForceReport {
    /// The force network.
    pub model_file: String,
    /// The data set.
    pub data: PathBuf,
    /// Which of its cases.
    pub split: EvaluatedCases,
    /// How many.
    pub n_test: usize,
    /// On how many of them the model was trained.
    pub n_trained_on: usize,
    /// The metrics of the network and its baselines.
    #[serde(flatten)]
    pub evaluation: Evaluation,
    /// Cases that were left out, and why.
    pub left_out: Vec<String>,
}

/// A cross-validation over the training cases of a force network.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CrossValidateForceReport {
    /// The metrics over all folds, and of each fold.
    #[serde(flatten)]
    pub validation: CrossValidation,
}

/// A finished evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluateForceAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<ForceEvaluation>,
    /// Single cases, where figures were asked for.
    pub cases: Option<EvaluatedForceCases>,
}

/// Single test cases with what was predicted for them, canonical.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct EvaluatedForceCases {
    /// Every case with the size of its impulse, N s, and its largest force, N.
    pub all: Vec<(ForceCase, Estimate, Estimate)>,
    /// Some of them from the smallest to the largest impulse, with their bands.
    pub samples: Vec<(ForceCase, ForceForecast)>,
}

impl Question for EvaluateForceRequest {
    type Answer = EvaluateForceAnswer;
    type Report = Answer<ForceEvaluation>;
    const NAME: &'static str = "evaluate";

    fn check(&self) -> Result<(), StudyError> {
        self.cross_validate.map_or(Ok(()), |n| check_count("cross_validate", &FOLDS, n))
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn has_problems(report: &Self::Report) -> bool {
        match &report.report {
            ForceEvaluation::Cases(of_cases) => !of_cases.evaluation.problems.is_empty(),
            ForceEvaluation::Folds(_) => false,
        }
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<EvaluateForceAnswer>, StudyError> {
        let model = library.force_model(&self.model)?;
        let digest = library.force_model_digest(&self.model)?;
        let provenance = Provenance::from_seed(self.seed).with_models([digest]);
        let settings = EvaluationSettings {
            columns: self.columns,
            seed: self.seed,
            ..EvaluationSettings::default()
        };
        if let Some(n_folds) = self.cross_validate {
            let cases = model.training_cases();
            if n_folds > cases.len() {
                return Err(StudyError::TooManyFolds { n_folds, n_cases: cases.len() });
            }
            let mut report = progress_of(observer);
            let validated = cross_validate(cases, model.config(), n_folds, &settings, &mut report)?;
            return Ok(validated.map(|validation| {
                let what = format!("data set {}", self.data.display());
                let reason = "a cross-validation uses the training cases that the model holds";
                let caveats = Caveats::from(vec![Caveat::not_used(what, reason)]);
                let report = CrossValidateForceReport { validation };
                let report = ForceEvaluation::Folds(Box::new(report));
                let report = Answer { report, caveats, provenance };
                EvaluateForceAnswer { report, cases: None }
            }));
        }
        let cases = self.test_cases(&model, library, observer)?;
        let Outcome::Complete(UsableCases { cases: test, left_out }) = cases else {
            return Ok(Outcome::Cancelled);
        };
        let n_left_out = left_out.len();
        let evaluated = evaluate_model(&model, &test, &settings, &mut progress_of(observer))?;
        let Outcome::Complete(evaluation) = evaluated else { return Ok(Outcome::Cancelled) };
        let cases = if self.for_figures {
            match EvaluatedForceCases::evaluate(&model, &test, self.seed, observer)? {
                Outcome::Complete(cases) => Some(cases),
                Outcome::Cancelled => return Ok(Outcome::Cancelled),
            }
        } else {
            None
        };
        let n_trained_on = test.iter().filter(|case| model.is_trained_on(case)).count();
        let trained_on = restrictions::trained_on_caveat(n_trained_on, test.len()).into_iter();
        let is_open = |case: &&ForceCase| {
            model.is_body_open(&case.scenario) || model.is_struck_body_open(&case.scenario)
        };
        // Without these columns all bodies are open, as it was asked for.
        let n_open = match self.columns {
            ColumnSet::ThetaContactAndBody => test.iter().filter(is_open).count(),
            ColumnSet::Theta => 0,
        };
        let open = restrictions::open_bodies_caveat(n_open, test.len());
        let report = EvaluateForceReport {
            model_file: self.model.to_string(),
            data: self.data.clone(),
            split: self.split,
            n_test: test.len(),
            n_trained_on,
            evaluation,
            left_out,
        };
        let report = Answer {
            report: ForceEvaluation::Cases(Box::new(report)),
            caveats: trained_on
                .chain(restrictions::left_out_caveat(n_left_out, "cases"))
                .chain(open)
                .collect(),
            provenance,
        };
        Ok(Outcome::Complete(EvaluateForceAnswer { report, cases }))
    }
}

impl EvaluatedForceCases {
    /// Draws curves of all cases and computes the bands of some.
    pub(crate) fn evaluate(
        model: &ForceModel,
        cases: &[ForceCase],
        seed: u64,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Self>, StudyError> {
        let n_draws = ProbabilisticSettings::default().n_samples;
        let mut all = Vec::new();
        for (done, case) in cases.iter().enumerate() {
            let progress = Progress::new(done as u64, cases.len() as u64, "drawing curves");
            if observer(Event::Progress(progress)).is_break() {
                return Ok(Outcome::Cancelled);
            }
            let mut rng = random_stream(seed, "draws", done as u64);
            let (_, draws) = distribution(model, case)?.sample_quantities(n_draws, &mut rng);
            let impulse = bands_of_draws(draws.impulse_magnitude_n_s());
            all.push((case.clone(), impulse, bands_of_draws(draws.peak_n)));
        }
        Ok(Outcome::Complete(Self { all, samples: samples(model, cases, seed)? }))
    }
}

fn distribution(model: &ForceModel, case: &ForceCase) -> Result<CurveMixture, StudyError> {
    Ok(model.predict(&case.scenario)?.mixture)
}

/// Cases at equal steps of rank by impulse, with their bands.
fn samples(
    model: &ForceModel,
    cases: &[ForceCase],
    seed: u64,
) -> Result<Vec<(ForceCase, ForceForecast)>, StudyError> {
    let mut ranked: Vec<&ForceCase> = cases.iter().collect();
    let size = |case: &ForceCase| case.impulse_n_s[0].hypot(case.impulse_n_s[1]);
    ranked.sort_by(|a, b| size(a).total_cmp(&size(b)));
    let (last, n_samples) = (ranked.len().saturating_sub(1), N_SAMPLE_CASES.min(ranked.len()));
    let ranks = (0..n_samples).map(|i| i * last / n_samples.saturating_sub(1).max(1));
    let chosen = ranks.filter_map(|rank| ranked.get(rank));
    let settings = ForecastSettings { n_curves: 0, seed };
    let estimate = |case: &&ForceCase| {
        let forecast = ForceForecast::new(&distribution(model, case)?, settings);
        Ok(((*case).clone(), forecast.map_err(ForceError::from)?))
    };
    chosen.map(estimate).collect()
}
