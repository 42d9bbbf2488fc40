//! Keeps what has been finished, and carries out the commands of the Models pane.

use std::path::PathBuf;
use std::sync::Arc;

use egui::Context;

use crate::app::command::{Command, ModelsCommand, wake};
use crate::app::dialog::Dialog;
use crate::app::kept::{
    Fact, KeptEntry, KeptFolder, KeptKind, KeptStatus, ModelsDialog, OpenedResult,
};
use crate::app::model::{ModelStatus, file_name};
use crate::app::network::TrainedModel;
use crate::app::question_job::Answered;
use crate::app::reconstruction::KeptRuns;
use crate::app::state::State;
use crate::app::training_status::TrainingStatus;
use impactlab_core::data::{Existing, MAX_MODEL_BYTES, Severity, read_bytes, write_atomically};
use impactlab_core::error_chain;
use impactlab_core::jobs::Job;
use impactlab_core::units::{percent, significant};
use impactlab_document::figure::model_name;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{
    CompareAnswer, CompareReport, EvaluateForceAnswer, EvaluateForceReport, ForceEvaluation,
    ModelChoice, Request,
};

/// Disk space of everything that is kept from which on the user is asked to remove something, bytes.
pub(in crate::app) const LIMIT_BYTES: u64 = 2_000_000_000;

impl State {
    /// Takes the folder in which results and trainings are kept and starts to read them.
    ///
    /// - `stores_trainings`: whether this window stores the state of its trainings; a second window
    ///   does not, since it would offer those of the first one.
    pub(in crate::app) fn open_data_folder(
        &mut self,
        (folder, stores_trainings): (PathBuf, bool),
        context: &Context,
    ) {
        if stores_trainings {
            let opened = self.session.unfinished.open(&folder, wake(context));
            self.say_io(opened);
        }
        self.session.reconstruction.kept_runs = Some(KeptRuns::new(&folder));
        let opened = self.session.kept.open(folder, wake(context));
        self.say_io(opened);
    }

    fn say_io(&mut self, result: std::io::Result<()>) {
        self.say_problem(result.err().map(|error| error.to_string()));
    }

    /// Receives what has been kept, read and removed.
    pub(in crate::app) fn update_kept(&mut self, context: &Context) {
        let (opened, removed, problems) = self.session.kept.poll();
        for problem in problems {
            self.say(Severity::Error, problem);
        }
        if let Some(opened) = opened {
            self.show_result(opened, context);
        }
        if !removed.is_empty() {
            self.read_unfinished(context);
        }
        if self.session.unfinished.poll() {
            self.read_unfinished(context);
        }
        self.poll_kept_models(context);
        self.take_kept_names();
    }

    fn poll_kept_models(&mut self, context: &Context) {
        let (project, session) = (&mut self.project, &mut self.session);
        let library = &session.library;
        let force = session.force.model.poll_keeping(library, &mut project.force.model);
        let response = session.response.model.poll_keeping(library, &mut project.response.model);
        for kept in [force, response].into_iter().flatten() {
            match kept {
                Ok(entry) => self.take_kept(entry),
                Err(problem) => self.say(Severity::Error, problem),
            }
            self.read_unfinished(context);
        }
    }

    fn take_kept(&mut self, entry: KeptEntry) {
        let before = self.session.kept.bytes();
        self.session.kept.add(entry);
        let bytes = self.session.kept.bytes();
        if before <= LIMIT_BYTES && bytes > LIMIT_BYTES {
            let text = format!(
                "kept models and comparisons take more than {}; all are kept, remove what you do not need in the Models pane",
                bytes_text(LIMIT_BYTES)
            );
            self.say(Severity::Warning, text);
        }
    }

    /// Names models in use as the user has named them in the list.
    fn take_kept_names(&mut self) {
        let (kept, session) = (&self.session.kept, &self.session);
        let name_of = |choice: Option<&ModelChoice>| match choice {
            Some(ModelChoice::Source(ModelSource::File(path))) => {
                kept.entry_of(path).map(|entry| entry.name.clone())
            }
            _ => None,
        };
        let force = name_of(session.force.model.current.as_ref().map(|of| &of.choice));
        let response = name_of(session.response.model.current.as_ref().map(|of| &of.choice));
        if let (Some(current), Some(name)) = (&mut self.session.force.model.current, force) {
            current.name = name;
        }
        if let (Some(current), Some(name)) = (&mut self.session.response.model.current, response) {
            current.name = name;
        }
    }

    /// Reads again which trainings have not ended.
    pub(in crate::app) fn read_unfinished(&mut self, context: &Context) {
        let read = self.session.unfinished.read(wake(context));
        self.say_io(read);
    }

    /// Keeps a comparison or an evaluation of response models that has just been finished.
    pub(in crate::app) fn keep_comparison(
        &mut self,
        (question, answer): (Request, Arc<CompareAnswer>),
        context: &Context,
    ) {
        let content = serde_json::to_vec(&answer.report).map_err(|error| error.to_string());
        let draft = comparison_note(question, &answer.report, &self.session.kept);
        self.keep_result(draft, content, context);
    }

    /// Keeps the evaluation of the force model that has just been finished.
    pub(in crate::app) fn keep_force_evaluation(&mut self, context: &Context) {
        let Some(latest) = &self.session.force.evaluation.latest else { return };
        let Ok(answer) = &latest.answer else { return };
        let ForceEvaluation::Cases(report) = &answer.report else { return };
        let content = serde_json::to_vec(report).map_err(|error| error.to_string());
        let question = Request::from(latest.question.clone());
        let draft = evaluation_note(question, report, &self.session.kept);
        self.keep_result(draft, content, context);
    }

    fn keep_result(
        &mut self,
        draft: KeptEntry,
        content: Result<Vec<u8>, String>,
        context: &Context,
    ) {
        match content {
            Ok(content) => {
                let kept = self.session.kept.keep_result(draft, content, wake(context));
                self.say_io(kept);
            }
            Err(problem) => {
                self.say(Severity::Error, format!("{} is not kept: {problem}", draft.name))
            }
        }
    }

    /// Carries out a command of the Models pane.
    pub(in crate::app) fn change_models(&mut self, command: ModelsCommand, context: &Context) {
        let done = match command {
            ModelsCommand::Ask(dialog) => {
                return self.session.dialogs.open(Dialog::Models(dialog));
            }
            ModelsCommand::Rename(entry, name) => {
                self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Models(_)));
                self.session.kept.rename((*entry, name), wake(context))
            }
            ModelsCommand::Remove(removal) => {
                self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Models(_)));
                self.session.kept.remove(removal, wake(context))
            }
            ModelsCommand::Open(entry) => self.session.kept.open_result(*entry, wake(context)),
            ModelsCommand::Resume(checkpoint) => return self.resume_training(&checkpoint, context),
            ModelsCommand::HideInterrupted => {
                self.session.unfinished.is_hidden = true;
                return;
            }
        };
        self.say_io(done);
    }

    fn show_result(&mut self, opened: OpenedResult, context: &Context) {
        let pane = match opened {
            OpenedResult::Comparison(report) => {
                let answer = Arc::new(CompareAnswer { report: *report });
                self.session.response.comparison.shown = Some(Ok(answer));
                KeptKind::Comparison.pane()
            }
            OpenedResult::ForceEvaluation(of) => {
                let (question, report) = *of;
                let Request::EvaluateForce(question) = question else { return };
                let report = ForceEvaluation::Cases(Box::new(report));
                let answer = Ok(Arc::new(EvaluateForceAnswer { report, cases: None }));
                let latest = Answered { question: *question, answer };
                self.session.force.evaluation.latest = Some(latest);
                KeptKind::ForceEvaluation.pane()
            }
        };
        if let Some(pane) = pane {
            self.apply(Command::Show(pane), context);
        }
    }

    /// Starts to write a copy of a kept model to a file of the user.
    pub(in crate::app) fn copy_kept(
        &mut self,
        (kept, path): (PathBuf, PathBuf),
        existing: Existing,
        context: &Context,
    ) {
        let job = Job::spawn("copy model", wake(context), move |_| {
            let bytes = read_bytes(&kept, MAX_MODEL_BYTES).map_err(|error| error_chain(&error))?;
            write_atomically(&path, existing, |out| out.write_all(&bytes))
                .map_err(|error| error_chain(&error))?;
            Ok(path)
        });
        match job {
            Ok(job) => self.session.exports.push(job),
            Err(error) => self.say(Severity::Error, error.to_string()),
        }
    }
}

impl ModelsDialog {
    /// The question whether to remove something that is kept.
    pub fn of_entry(entry: &KeptEntry, folder: &KeptFolder) -> Self {
        let path = folder.path_of(entry);
        let note = path.with_extension(super::NOTE_ENDING);
        let what = format!(
            "This {} of {} is removed from the disk. Cases that use it will miss it.",
            entry.kind.label(),
            entry.finished_text()
        );
        let files = vec![note, path];
        Self::Remove(super::Removal { name: entry.name.clone(), what, files })
    }
}

/// Starts to keep a model that was just trained.
///
/// - returns a message for the user if that is not possible.
pub(in crate::app) fn keep_trained<M: TrainedModel>(
    (status, training): (&mut ModelStatus<M>, &TrainingStatus<M>),
    (model, draft): (Arc<M>, Option<KeptEntry>),
    folder: Option<&KeptFolder>,
    context: &Context,
) -> Option<String> {
    let (folder, draft) = (folder?.clone(), draft?);
    let checkpoint = training.checkpoint.clone();
    let started = status.keep((model, draft), (folder, checkpoint), wake(context));
    started.err().map(|error| error.to_string())
}

fn comparison_note(question: Request, report: &CompareReport, kept: &KeptStatus) -> KeptEntry {
    let comparison = &report.comparison;
    let (kind, name) = match &question {
        Request::EvaluateResponse(of) => {
            let model = kept.name_of(&of.model);
            (KeptKind::ResponseEvaluation, format!("{model} on {}", comparison.data))
        }
        _ => (KeptKind::Comparison, format!("models compared on {}", comparison.data)),
    };
    let mut entry = KeptEntry::new(kind, (name, comparison.data.clone()), question);
    entry.figures.push(Fact::new("Trajectories asked about", comparison.test.len()));
    for model in &comparison.models {
        let name = model_name(&model.name, model.trajectories);
        let error = significant(model.metrics.average_error_m.mean);
        entry.figures.push(Fact::new(format!("{name}, average error"), format!("{error} m")));
    }
    entry.settings.push(Fact::new("Seed", comparison.seed));
    if let Request::Compare(of) = &entry.question
        && let Some(path) = of.config.file()
    {
        entry.settings.push(Fact::new("Settings file", path.display()));
    }
    entry
}

fn evaluation_note(
    question: Request,
    report: &EvaluateForceReport,
    kept: &KeptStatus,
) -> KeptEntry {
    let data = file_name(&report.data);
    let name = match &question {
        Request::EvaluateForce(of) => format!("{} on {data}", kept.name_of(&of.model)),
        _ => data.clone(),
    };
    let mut entry = KeptEntry::new(KeptKind::ForceEvaluation, (name, data), question);
    let of_model = &report.evaluation.metrics.overall;
    entry.figures = vec![
        Fact::new("Cases", report.n_test),
        Fact::new("Cases that it has learned from", report.n_trained_on),
        Fact::new("Impulse error, median", percent(of_model.impulse_error.median)),
        Fact::new("Peak error, median", percent(of_model.peak_error.median)),
        Fact::new("History error, median", percent(of_model.history_error.median)),
    ];
    entry
}

/// A size for a person, such as `1.2 MB`.
pub(in crate::app) fn bytes_text(bytes: u64) -> String {
    const UNITS: [(&str, f64); 3] = [("GB", 1e9), ("MB", 1e6), ("kB", 1e3)];
    let value = bytes as f64;
    match UNITS.into_iter().find(|(_, size)| value >= *size) {
        Some((unit, size)) => format!("{:.1} {unit}", value / size),
        None => format!("{bytes} B"),
    }
}
