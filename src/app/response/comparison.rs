//! The comparison of response models or the evaluation of one of them: computed in the background
//! or read from a file.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use crate::app::command::{Command, ComparisonCommand};
use crate::app::found::Found;
use crate::app::question_job::QuestionJob;
use crate::app::tasks::{TaskKey, Tasks};
use impactlab_core::data::write::{OutputFolder, RunRecord};
use impactlab_core::data::{DataError, Existing};
use impactlab_core::error_chain;
use impactlab_core::jobs::{Progress, ProgressCallback};
use impactlab_core::uncertainty::Caveats;
use impactlab_networks::response::evaluate::Comparison;
use impactlab_study::{
    Answer, CompareAnswer, CompareReport, CompareRequest, EvaluateResponseRequest, Library,
    Provenance, Question, Request,
};

/// A comparison or an evaluation, running or finished.
#[derive(Default)]
pub struct ComparisonStatus {
    /// The comparison, for which models are trained.
    pub compare: QuestionJob<CompareRequest>,
    /// The evaluation of the current model alone.
    pub evaluate: QuestionJob<EvaluateResponseRequest>,
    is_opening: bool,
    /// The latest result of a comparison, an evaluation or a file, or the reason why there is none.
    pub shown: Option<Result<Arc<CompareAnswer>, String>>,
    /// What was finished since it was asked for last.
    finished: Option<(Request, Arc<CompareAnswer>)>,
    /// The path in the text field for saving, as the user has typed it so far.
    pub typed_path: String,
}

impl ComparisonStatus {
    /// Starts to train and compare models. A comparison or an evaluation that is still running is
    /// cancelled.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn start(
        &mut self,
        request: CompareRequest,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        self.cancel();
        self.compare.start(request, library, wake)
    }

    /// Starts to evaluate the current model. A comparison or an evaluation that is still running is
    /// cancelled.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn evaluate(
        &mut self,
        request: EvaluateResponseRequest,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        self.cancel();
        self.evaluate.start(request, library, wake)
    }

    /// Cancels a running comparison or evaluation.
    pub fn cancel(&self) {
        self.compare.cancel();
        self.evaluate.cancel();
    }

    /// Whether a comparison, an evaluation or the reading of a file is running.
    pub fn is_running(&self) -> bool {
        self.compare.is_running() || self.evaluate.is_running() || self.is_opening
    }

    /// Returns a description of the running comparison or evaluation, its progress and the
    /// estimated time left.
    pub fn progress(&self) -> Option<(&'static str, &Progress, Option<Duration>)> {
        let compare = self.compare.job().map(|job| ("Comparing", job.progress(), job.time_left()));
        let evaluate = self.evaluate.job();
        compare.or_else(|| evaluate.map(|job| ("Evaluating", job.progress(), job.time_left())))
    }

    /// Starts to read a `comparison.json` file.
    pub fn open(&mut self, path: PathBuf, tasks: &mut Tasks) {
        self.is_opening = true;
        let work = move |_: &mut ProgressCallback<'_>| {
            let comparison = Comparison::load(&path).map_err(|error| error_chain(&error))?;
            Ok(Found::new(comparison))
        };
        let take = |result| Command::Compare(ComparisonCommand::Read(result));
        tasks.start(TaskKey::OpenComparison, work, take);
    }

    /// Shows the comparison that was read, or why there is none.
    pub fn take(&mut self, comparison: Result<Comparison, String>) {
        self.is_opening = false;
        self.shown = Some(comparison.map(|comparison| {
            let report = Answer {
                report: CompareReport { comparison, left_out: Vec::new() },
                caveats: Caveats::default(),
                provenance: Provenance::default(),
            };
            Arc::new(CompareAnswer { report })
        }));
    }

    /// Receives the results that have arrived.
    pub fn poll(&mut self) {
        if self.compare.poll() {
            self.shown = self.compare.latest.as_ref().map(|latest| latest.answer.clone());
            self.finished = finished(&self.compare);
        }
        if self.evaluate.poll() {
            self.shown = self.evaluate.latest.as_ref().map(|latest| latest.answer.clone());
            self.finished = finished(&self.evaluate);
        }
    }

    /// Returns the comparison or evaluation that has just been finished, once, with its question.
    pub fn take_finished(&mut self) -> Option<(Request, Arc<CompareAnswer>)> {
        self.finished.take()
    }

    /// Returns the report of the comparison that is shown, if there is one.
    pub fn report(&self) -> Option<&Answer<CompareReport>> {
        self.shown.as_ref()?.as_ref().ok().map(|answer| &answer.report)
    }
}

/// Returns the latest answer with its question; `None` if it is an error.
fn finished<Q>(job: &QuestionJob<Q>) -> Option<(Request, Arc<CompareAnswer>)>
where
    Q: Question<Answer = CompareAnswer> + Into<Request>,
{
    let latest = job.latest.as_ref()?;
    let answer = latest.answer.as_ref().ok()?;
    Some((latest.question.clone().into(), Arc::clone(answer)))
}

/// Writes a comparison into a folder, as JSON, Markdown and tables, with a manifest.
///
/// # Errors
/// [`DataError`] if the folder cannot be written.
pub fn write_comparison_folder(
    folder: &Path,
    existing: Existing,
    report: &Answer<CompareReport>,
) -> Result<(), DataError> {
    let output = OutputFolder::begin(folder, existing, &CompareReport::FILES, Vec::new())?;
    report.write(output.staging())?;
    let Provenance { seed, model_digests: models, .. } = report.provenance_with_seed();
    output.finish(RunRecord { seed, models, ..RunRecord::default() })
}
