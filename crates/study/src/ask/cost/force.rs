//! What a training and an evaluation of the force network will cost.

use std::ops::ControlFlow;
use std::time::Duration;

use crate::ask::cost::{Cost, Watch};
use crate::{
    EvaluateForceRequest, EvaluatedForceCases, Event, Library, Observer, Question, StudyError,
    TrainForceRequest,
};
use impactlab_core::data::Outcome;
use impactlab_core::jobs::Progress;
use impactlab_networks::force::{
    EvaluationSettings, ForceTrainSettings, ForceTrainingSet, evaluate_model, fit_physics,
    train_around,
};
use impactlab_networks::learning::TrainingReport;

/// Epochs that are measured; the first of them, which is slower, does not count.
const MEASURED_EPOCHS: usize = 3;
/// Time after which an evaluation that is measured ends and the rest is extrapolated.
const MEASURED_EVALUATION: Duration = Duration::from_secs(3);
/// Cases for which curves are drawn to measure it.
const MEASURED_CASES: usize = 2;

impl TrainForceRequest {
    /// Measures one step of each fit of the crush model, one regression and some epochs.
    pub(super) fn cost(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Cost>, StudyError> {
        self.check()?;
        let Outcome::Complete((set, _)) = self.training_set(library, observer)? else {
            return Ok(Outcome::Cancelled);
        };
        let config = self.settings()?;
        let mut measured = config.clone();
        measured.crush.max_steps = 1;
        measured.training.epochs = MEASURED_EPOCHS;
        let settings = ForceTrainSettings::unsaved(measured, self.training.seed);
        let mut cost = Cost { is_most: true, ..Cost::default() };
        let fits = Fits::measure(&set, &settings, observer)?;
        let Some((fits, physics)) = fits else { return Ok(Outcome::Cancelled) };
        if config.network.centre.has_crush() {
            let n_steps = config.crush.folds * config.crush.max_steps;
            cost.add("steps of the crush fits", n_steps as f64, fits.step_s);
        }
        if let Some(seconds) = fits.regression_s {
            cost.add("regressions", (config.crush.folds + 1) as f64, seconds);
        }

        let (mut epochs_s, mut watch) = (Vec::new(), Watch::start());
        train_around(physics, &set, &settings, &mut |report| {
            if let TrainingReport::Epoch(epoch) = report {
                epochs_s.extend(epoch.summary.seconds);
            }
            let flow = observer(Event::Progress(Progress::new(0, 0, "measuring epochs")));
            watch.is_broken |= flow.is_break();
            flow
        })?;
        if watch.is_broken {
            return Ok(Outcome::Cancelled);
        }
        let around_s = watch.seconds() - epochs_s.iter().sum::<f64>();
        cost.add("epochs", config.training.epochs as f64, mean_without_first(&epochs_s));
        cost.add("preparation and calibration", 1.0, around_s.max(0.0));
        Ok(Outcome::Complete(cost))
    }
}

/// The mean of all values but the first, which is the only one if there are no others.
pub(super) fn mean_without_first(values: &[f64]) -> f64 {
    let counted = if values.len() > 1 { &values[1..] } else { values };
    counted.iter().sum::<f64>() / counted.len().max(1) as f64
}

/// Times of the fits before the first epoch.
struct Fits {
    /// One step of the fit of one crush law, s.
    step_s: f64,
    /// One regression, s; `None` without regressions.
    regression_s: Option<f64>,
}

/// The physics as `fit_physics` gives it.
type Physics =
    (impactlab_networks::force::CentreModel, Vec<impactlab_networks::force::CentreCurve>);

impl Fits {
    /// Fits the crush laws with one step each, and then the first regression. `None` if the
    /// observer has broken.
    fn measure(
        set: &ForceTrainingSet,
        settings: &ForceTrainSettings,
        observer: &mut Observer<'_>,
    ) -> Result<Option<(Self, Physics)>, StudyError> {
        let mut watch = Watch::start();
        let (mut crush_s, mut regression_s) = (None, None);
        let physics = fit_physics(set, settings, &mut |report| {
            let TrainingReport::Fit(fit) = report else {
                return ControlFlow::Continue(());
            };
            let what = format!("measuring: {}", fit.what);
            let flow = observer(Event::Progress(Progress::new(0, 0, what)));
            watch.is_broken |= flow.is_break();
            // Crush laws come first and have a cost; regressions have none.
            if fit.cost.is_some() {
                return flow;
            }
            let now_s = watch.seconds();
            let Some(before_s) = crush_s else {
                crush_s = Some(now_s);
                return flow;
            };
            regression_s = Some(now_s - before_s);
            ControlFlow::Break(())
        })?;
        if watch.is_broken {
            return Ok(None);
        }
        let step_s = crush_s.unwrap_or_else(|| watch.seconds());
        let n_fits = settings.config.crush.folds.max(1) as f64;
        Ok(Some((Self { step_s: step_s / n_fits, regression_s }, physics)))
    }
}

impl EvaluateForceRequest {
    /// Measures the evaluation for some seconds, and the curves of some cases.
    pub(super) fn cost(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Cost>, StudyError> {
        self.check()?;
        let model = library.force_model(&self.model)?;
        let cases = self.test_cases(&model, library, observer)?;
        let Outcome::Complete(usable) = cases else { return Ok(Outcome::Cancelled) };
        let test = usable.cases;
        let settings = EvaluationSettings {
            columns: self.columns,
            seed: self.seed,
            ..EvaluationSettings::default()
        };
        let (mut cost, mut watch) = (Cost::default(), Watch::start());
        let mut latest = Progress::default();
        evaluate_model(&model, &test, &settings, &mut |progress| {
            latest = progress.clone();
            let flow = observer(Event::Progress(progress));
            watch.is_broken |= flow.is_break();
            match watch.elapsed() > MEASURED_EVALUATION {
                true => ControlFlow::Break(()),
                false => flow,
            }
        })?;
        if watch.is_broken {
            return Ok(Outcome::Cancelled);
        }
        let left = latest.time_left(watch.elapsed()).filter(|_| latest.done < latest.total);
        let evaluation = watch.elapsed() + left.unwrap_or_default();
        cost.add("evaluation", 1.0, evaluation.as_secs_f64());
        if self.for_figures {
            let (watch, n) = (Watch::start(), MEASURED_CASES.min(test.len()));
            EvaluatedForceCases::evaluate(&model, &test[..n], self.seed, observer)?;
            cost.add("curves of cases", test.len() as f64, watch.seconds() / n.max(1) as f64);
        }
        Ok(Outcome::Complete(cost))
    }
}
