//! How well the current model does on a data set, beside the baselines.

use std::sync::Arc;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::analysis::{ForceForecast, ForecastSettings, Spread};
use crate::app::source::CheckedDataset;
use crate::data::Outcome;
use crate::error_chain;
use crate::force::metrics::ProbabilisticSettings;
use crate::force::{
    ColumnSet, Evaluation, EvaluationSettings, ForceCase, ForceModel, evaluate_model,
};
use crate::jobs::{Job, Progress, Report, Update};
use crate::uncertainty::CurveMixture;

/// Cases that are drawn with their bands.
const N_SAMPLES: usize = 6;
/// Seed of the drawn curves behind intervals.
const SEED: u64 = 0;

/// What is to be evaluated.
pub struct EvaluationRequest {
    /// The model.
    pub model: Arc<ForceModel>,
    /// Name of its file, for titles.
    pub name: String,
    /// What the data are called.
    pub data: String,
    /// The data.
    pub dataset: Arc<CheckedDataset>,
    /// Whether cases that the model has learned from count too.
    pub all: bool,
}

/// A test case with what was predicted for it, canonical.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluatedCase {
    /// The case.
    pub case: ForceCase,
    /// Size of the impulse, N s.
    pub impulse_n_s: Spread,
    /// Largest `|F|`, N.
    pub peak_n: Spread,
}

/// A finished evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct FinishedEvaluation {
    /// Name of the model's file and of the data.
    pub names: [String; 2],
    /// The figures.
    pub evaluation: Evaluation,
    /// The test cases.
    pub cases: Vec<EvaluatedCase>,
    /// How many of them the model has learned from.
    pub n_known: usize,
    /// Some of them from the smallest to the largest impulse, with their bands.
    pub samples: Vec<(ForceCase, ForceForecast)>,
    /// Cases that could not be read.
    pub left_out: Vec<String>,
}

/// An evaluation, under way or over.
#[derive(Default)]
pub struct EvaluationStatus {
    /// Under way.
    pub job: Option<Job<Result<Outcome<FinishedEvaluation>, String>>>,
    /// The latest that is over, or why it failed.
    pub result: Option<Result<Arc<FinishedEvaluation>, String>>,
}

impl EvaluationStatus {
    /// Starts an evaluation; one that is under way is dropped.
    ///
    /// # Errors
    /// The operating system's, if no thread can be started.
    pub fn start(
        &mut self,
        request: EvaluationRequest,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        self.job =
            Some(Job::spawn_in_background("evaluate", wake, move |report| run(&request, report))?);
        Ok(())
    }

    /// Takes in what was reported.
    pub fn poll(&mut self) {
        let Some(job) = &mut self.job else { return };
        let result = match job.poll() {
            Update::Running => return,
            Update::Finished(Ok(Outcome::Complete(finished))) => Some(Ok(Arc::new(finished))),
            Update::Finished(Ok(Outcome::Cancelled)) => None,
            Update::Finished(Err(text)) => Some(Err(text)),
            Update::Panicked(text) => Some(Err(format!("internal error: {text}"))),
            Update::Gone => Some(Err("the evaluation is gone".to_owned())),
        };
        self.job = None;
        if result.is_some() {
            self.result = result;
        }
    }
}

/// # Errors
/// A message for the user.
fn run(
    request: &EvaluationRequest,
    report: &mut Report<'_>,
) -> Result<Outcome<FinishedEvaluation>, String> {
    let (model, data) = (&request.model, request.data.clone());
    let (cases, problems) = ForceCase::of_dataset(&request.dataset.dataset);
    let is_tested = |case: &ForceCase| request.all || !model.is_trained_on(case);
    let cases: Vec<ForceCase> = cases.into_iter().filter(is_tested).collect();
    if cases.is_empty() {
        return Err(format!("the model has learned from every case of {data}"));
    }
    let settings = EvaluationSettings {
        columns: ColumnSet::ThetaContactAndBody, // all that the network knows
        ..EvaluationSettings::default()
    };
    let evaluation =
        evaluate_model(model, &cases, &settings, report).map_err(|error| error_chain(&error))?;
    let Outcome::Complete(evaluation) = evaluation else { return Ok(Outcome::Cancelled) };
    let Some(evaluated) = predict(model, &cases, report)? else { return Ok(Outcome::Cancelled) };
    Ok(Outcome::Complete(FinishedEvaluation {
        names: [request.name.clone(), data],
        evaluation,
        n_known: cases.iter().filter(|case| model.is_trained_on(case)).count(),
        samples: samples(model, &cases)?,
        cases: evaluated,
        left_out: problems.iter().map(|problem| error_chain(problem)).collect(),
    }))
}

/// Intervals of impulse and peak; `None` if cancelled.
fn predict(
    model: &ForceModel,
    cases: &[ForceCase],
    report: &mut Report<'_>,
) -> Result<Option<Vec<EvaluatedCase>>, String> {
    let n_samples = ProbabilisticSettings::default().n_samples;
    let mut evaluated = Vec::new();
    for (done, case) in cases.iter().enumerate() {
        let progress = Progress::new(done as u64, cases.len() as u64, "drawing curves");
        if report(progress).is_break() {
            return Ok(None);
        }
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        rng.set_stream(done as u64);
        let figures = distribution(model, case)?.sample_figures(n_samples, &mut rng);
        evaluated.push(EvaluatedCase {
            impulse_n_s: Spread::of_draws(figures.impulse_magnitude_n_s()),
            peak_n: Spread::of_draws(figures.peak_n),
            case: case.clone(),
        });
    }
    Ok(Some(evaluated))
}

fn distribution(model: &ForceModel, case: &ForceCase) -> Result<CurveMixture, String> {
    let prediction = model.predict(&case.scenario);
    let named = |error| format!("case {}: {}", case.name, error_chain(&error));
    prediction.map(|prediction| prediction.mixture).map_err(named)
}

/// Cases at equal steps of rank by impulse.
fn samples(
    model: &ForceModel,
    cases: &[ForceCase],
) -> Result<Vec<(ForceCase, ForceForecast)>, String> {
    let mut ranked: Vec<&ForceCase> = cases.iter().collect();
    let size = |case: &ForceCase| case.impulse_n_s[0].hypot(case.impulse_n_s[1]);
    ranked.sort_by(|a, b| size(a).total_cmp(&size(b)));
    let (last, n_samples) = (ranked.len().saturating_sub(1), N_SAMPLES.min(ranked.len()));
    let ranks = (0..n_samples).map(|i| i * last / n_samples.saturating_sub(1).max(1));
    let chosen = ranks.filter_map(|rank| ranked.get(rank));
    let settings = ForecastSettings { n_curves: 0, seed: SEED };
    let of = |case: &&ForceCase| {
        let forecast = ForceForecast::of(&distribution(model, case)?, settings);
        Ok(((*case).clone(), forecast.map_err(|error| error_chain(&error))?))
    };
    chosen.map(of).collect()
}
