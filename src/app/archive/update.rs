//! Keeps what has been finished, and carries out the commands of the Models pane.

use std::path::PathBuf;
use std::sync::Arc;

use egui::Context;

use crate::app::archive::{
    ArchiveEntry, ArchiveEvent, ArchiveFolder, ArchiveKind, ArchiveStatus, ModelsDialog,
    OpenedResult, StoredFact,
};
use crate::app::command::{Command, ModelsCommand};
use crate::app::dialog::Dialog;
use crate::app::model::{ModelEvent, ModelNews, ModelStatus, file_name};
use crate::app::network::TrainedModel;
use crate::app::question_job::Answered;
use crate::app::reconstruction::StoredRuns;
use crate::app::state::{Session, State};
use crate::app::tasks::Tasks;
use crate::app::training_status::TrainingStatus;
use impactlab_core::data::Severity;
use impactlab_core::units::{percent, significant};
use impactlab_document::figure::model_name;
use impactlab_networks::force::ForceModel;
use impactlab_networks::response::ResponseModel;
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
    pub(in crate::app) fn open_data_folder(&mut self, folder: PathBuf, stores_trainings: bool) {
        let Session { unfinished, archive, reconstruction, tasks, .. } = &mut self.session;
        if stores_trainings {
            unfinished.open(&folder, tasks);
        }
        reconstruction.stored_runs = Some(StoredRuns::new(&folder));
        archive.open(folder, tasks);
    }

    /// Takes what a task has done with what is kept.
    pub(in crate::app) fn take_archive_event(&mut self, event: ArchiveEvent, context: &Context) {
        let Session { archive, unfinished, tasks, .. } = &mut self.session;
        let problem = match event {
            ArchiveEvent::Trainings(list) => return unfinished.take(list, tasks),
            ArchiveEvent::Listed(list) => {
                archive.end_reading();
                list.map(|list| archive.take_list(list)).err()
            }
            ArchiveEvent::Put(entry) => entry.map(|entry| archive.add(entry)).err(),
            ArchiveEvent::Removed(Ok(removal)) => {
                archive.forget(&removal);
                return self.read_unfinished();
            }
            ArchiveEvent::Opened(Ok(opened)) => return self.show_result(opened, context),
            ArchiveEvent::Removed(Err(problem)) | ArchiveEvent::Opened(Err(problem)) => {
                Some(problem)
            }
        };
        self.say_problem(problem);
    }

    /// Takes what a task has made of a model of the force network.
    pub(in crate::app) fn take_force_model(&mut self, event: &ModelEvent<ForceModel>) {
        let Session { force, library, .. } = &mut self.session;
        let news = force.model.take(event, library, &mut self.project.predict_force.model);
        self.take_model_news(news);
    }

    /// Takes what a task has made of a model of the response network.
    pub(in crate::app) fn take_response_model(&mut self, event: &ModelEvent<ResponseModel>) {
        let Session { response, library, .. } = &mut self.session;
        let wanted = &mut self.project.predict_motion.response_model;
        let news = response.model.take(event, library, wanted);
        self.take_model_news(news);
    }

    fn take_model_news(&mut self, news: ModelNews) {
        match news {
            ModelNews::Nothing => {}
            ModelNews::Problem(problem) => self.say(Severity::Error, problem),
            ModelNews::Saved(written) => self.say_of_file(written),
            ModelNews::Archived(result) => {
                match result {
                    Ok(entry) => self.take_archived(entry),
                    Err(problem) => self.say(Severity::Error, problem),
                }
                self.read_unfinished();
            }
        }
    }

    fn take_archived(&mut self, entry: ArchiveEntry) {
        let before = self.session.archive.bytes();
        self.session.archive.add(entry);
        let bytes = self.session.archive.bytes();
        if before <= LIMIT_BYTES && bytes > LIMIT_BYTES {
            let text = format!(
                "kept models and comparisons take more than {}; all are kept, remove what you do not need in the Models pane",
                bytes_text(LIMIT_BYTES)
            );
            self.say(Severity::Warning, text);
        }
    }

    /// Names models in use as the user has named them in the list.
    pub(in crate::app) fn take_archived_names(&mut self) {
        let (archive, session) = (&self.session.archive, &self.session);
        let name_of = |choice: Option<&ModelChoice>| match choice {
            Some(ModelChoice::Source(ModelSource::File(path))) => {
                archive.entry_of(path).map(|entry| entry.name.clone())
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
    pub(in crate::app) fn read_unfinished(&mut self) {
        self.session.unfinished.read(&mut self.session.tasks);
    }

    /// Keeps a comparison or an evaluation of response models that has just been finished.
    pub(in crate::app) fn keep_comparison(&mut self, question: Request, answer: &CompareAnswer) {
        let content = serde_json::to_vec(&answer.report).map_err(|error| error.to_string());
        let draft = comparison_note(question, &answer.report, &self.session.archive);
        self.keep_result(draft, content);
    }

    /// Keeps the evaluation of the force model that has just been finished.
    pub(in crate::app) fn keep_force_evaluation(&mut self) {
        let Some(latest) = &self.session.force.evaluation.latest else { return };
        let Ok(answer) = &latest.answer else { return };
        let ForceEvaluation::Cases(report) = &answer.report.report else { return };
        let content = serde_json::to_vec(&answer.report).map_err(|error| error.to_string());
        let question = Request::from(latest.question.clone());
        let draft = evaluation_note(question, report, &self.session.archive);
        self.keep_result(draft, content);
    }

    fn keep_result(&mut self, draft: ArchiveEntry, content: Result<Vec<u8>, String>) {
        let Session { archive, tasks, .. } = &mut self.session;
        match content {
            Ok(content) => archive.keep_result(draft, content, tasks),
            Err(problem) => {
                self.say(Severity::Error, format!("{} is not kept: {problem}", draft.name));
            }
        }
    }

    /// Carries out a command of the Models pane.
    pub(in crate::app) fn change_models(&mut self, command: ModelsCommand, context: &Context) {
        let Session { archive, tasks, dialogs, unfinished, .. } = &mut self.session;
        if matches!(command, ModelsCommand::Rename(..) | ModelsCommand::Remove(_)) {
            dialogs.close_if(|dialog| matches!(dialog, Dialog::Models(_)));
        }
        match command {
            ModelsCommand::Ask(dialog) => dialogs.open(Dialog::Models(dialog)),
            ModelsCommand::Rename(entry, name) => archive.rename(*entry, name, tasks),
            ModelsCommand::Remove(removal) => archive.remove(removal, tasks),
            ModelsCommand::Open(entry) => archive.open_result(*entry, tasks),
            ModelsCommand::Resume(checkpoint) => self.resume_training(&checkpoint, context),
            ModelsCommand::HideInterrupted => unfinished.is_hidden = true,
        }
    }

    fn show_result(&mut self, opened: OpenedResult, context: &Context) {
        let pane = match opened {
            OpenedResult::Comparison(report) => {
                let answer = Arc::new(CompareAnswer { report: *report });
                self.session.response.comparison.shown = Some(Ok(answer));
                ArchiveKind::Comparison.pane()
            }
            OpenedResult::ForceEvaluation(of) => {
                let (question, report) = *of;
                let Request::EvaluateForce(question) = question else { return };
                let report = report.map(|report| ForceEvaluation::Cases(Box::new(report)));
                let answer = Ok(Arc::new(EvaluateForceAnswer { report, cases: None }));
                let latest = Answered { question: *question, answer };
                self.session.force.evaluation.latest = Some(latest);
                ArchiveKind::ForceEvaluation.pane()
            }
        };
        if let Some(pane) = pane {
            self.apply(Command::Show(pane), context);
        }
    }
}

impl ModelsDialog {
    /// The question whether to remove something that is kept.
    pub fn remove_entry(entry: &ArchiveEntry, folder: &ArchiveFolder) -> Self {
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
pub(in crate::app) fn keep_trained<M: TrainedModel>(
    status: &mut ModelStatus<M>,
    training: &TrainingStatus<M>,
    model: Arc<M>,
    draft: Option<ArchiveEntry>,
    folder: Option<&ArchiveFolder>,
    tasks: &mut Tasks,
) {
    if let (Some(folder), Some(draft)) = (folder, draft) {
        status.keep(model, draft, folder.clone(), training.checkpoint.clone(), tasks);
    }
}

fn comparison_note(
    question: Request,
    report: &CompareReport,
    archive: &ArchiveStatus,
) -> ArchiveEntry {
    let comparison = &report.comparison;
    let (kind, name) = match &question {
        Request::EvaluateResponse(of) => {
            let model = archive.name_of(&of.model);
            (ArchiveKind::ResponseEvaluation, format!("{model} on {}", comparison.data))
        }
        _ => (ArchiveKind::Comparison, format!("models compared on {}", comparison.data)),
    };
    let mut entry = ArchiveEntry::new(kind, name, comparison.data.clone(), question);
    entry.figures.push(StoredFact::new("Trajectories asked about", comparison.test.len()));
    for model in &comparison.models {
        let name = model_name(&model.name, model.trajectories);
        let error = significant(model.metrics.average_error_m.mean);
        entry.figures.push(StoredFact::new(format!("{name}, average error"), format!("{error} m")));
    }
    entry.settings.push(StoredFact::new("Seed", comparison.seed));
    if let Request::Compare(of) = &entry.question
        && let Some(path) = of.config.file()
    {
        entry.settings.push(StoredFact::new("Settings file", path.display()));
    }
    entry
}

fn evaluation_note(
    question: Request,
    report: &EvaluateForceReport,
    archive: &ArchiveStatus,
) -> ArchiveEntry {
    let data = file_name(&report.data);
    let name = match &question {
        Request::EvaluateForce(of) => format!("{} on {data}", archive.name_of(&of.model)),
        _ => data.clone(),
    };
    let mut entry = ArchiveEntry::new(ArchiveKind::ForceEvaluation, name, data, question);
    let of_model = &report.evaluation.metrics.overall;
    entry.figures = vec![
        StoredFact::new("Cases", report.n_test),
        StoredFact::new("Cases that it has learned from", report.n_trained_on),
        StoredFact::new("Impulse error, median", percent(of_model.impulse_error.median)),
        StoredFact::new("Peak error, median", percent(of_model.peak_error.median)),
        StoredFact::new("History error, median", percent(of_model.history_error.median)),
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
