//! Opens, saves and packs cases, and changes between their variants.

use std::path::{Path, PathBuf};

use egui::Context;

use crate::app::case::command::{PackedCase, SavedCase};
use crate::app::case::{CaseCommand, OpenCase, VariantCommand};
use crate::app::command::Command;
use crate::app::dialog::{Dialog, Purpose};
use crate::app::found::Found;
use crate::app::measure::Measuring;
use crate::app::output::Output;
use crate::app::panes::Pane;
use crate::app::project::Project;
use crate::app::question_job::QuestionJob;
use crate::app::report::ReportSession;
use crate::app::source::Source;
use crate::app::state::{Session, State, Subject};
use crate::app::tasks::TaskKey;
use crate::app::widgets::BetweenCursors;
use crate::app::workspaces::Workspace;
use impactlab_core::data::write::ModelDigest;
use impactlab_core::data::{Existing, MAX_RESULTS_BYTES, Severity, read_utf8};
use impactlab_core::error_chain;
use impactlab_core::jobs::ProgressCallback;
use impactlab_study::case_file::{CaseFile, CaseOnDisk, LogEntry, PackedFile, UsedModel, pack};
use impactlab_study::{MotionSource, SeriesFile};

/// The finished example case.
const EXAMPLE: &str = include_str!("../../../assets/examples/pit.impactlab");

/// The largest number of recent cases that are offered.
const MAX_RECENT: usize = 10;

impl State {
    /// Carries out a command on the case as a whole.
    pub(in crate::app) fn change_case(&mut self, command: CaseCommand, context: &Context) {
        match command {
            CaseCommand::Save => self.save_to_own_file(),
            CaseCommand::SaveAndLeave => self.save_and_leave(),
            CaseCommand::Leave(to) => self.leave(to, context),
            CaseCommand::LeaveUnasked(to) => self.go(to, context),
            CaseCommand::OpenTrusted(trusted) => self.open_trusted(*trusted),
            CaseCommand::Changed(path, changes) if self.case.path.as_ref() == Some(&path) => {
                for change in changes {
                    self.say(Severity::Warning, change.to_string());
                }
            }
            CaseCommand::Changed(..) => {}
            CaseCommand::Saved(result) => self.take_saved_case(result),
            CaseCommand::Packed(result) => self.take_packed_case(result),
        }
    }

    /// Writes the case to its file. Asks for one if it has none, and before something of somebody else
    /// is replaced.
    pub(super) fn save_to_own_file(&mut self) {
        match self.case.path.clone() {
            None => self.ask(Purpose::Save(Output::Case)),
            Some(path) if self.is_case_file_foreign() => {
                let why = format!(
                    "{} was changed by somebody else since it was opened or saved here; what is there now is lost if it is replaced",
                    path.display()
                );
                self.say(Severity::Warning, why);
                self.session.dialogs.open(Dialog::Replace(Output::Case, path));
            }
            Some(path) => self.save_case(path, Existing::Replace),
        }
    }

    /// Whether the case has something that is not in its file.
    pub fn is_case_changed(&self) -> bool {
        self.case.is_changed(&self.project_of_questions())
    }

    /// What the case holds, by its content.
    pub(in crate::app) fn case_fingerprint(&self) -> String {
        self.case.fingerprint(&self.project_of_questions())
    }

    /// The project as it is asked: its questions in step, and no force predicted that cannot be.
    pub(in crate::app) fn project_of_questions(&self) -> Project {
        let mut project = self.project.clone();
        project.predict_motion.force = self.driving_force();
        project.keep_in_step();
        project
    }

    /// Whether no variant of the case asks anything.
    pub(in crate::app) fn asks_nothing(&self) -> bool {
        let file = self.case.with_shown(&self.project_of_questions());
        file.variants.iter().all(|variant| variant.questions.is_empty())
    }

    /// The files that the case rests on, with its own and with everything that is open.
    pub(in crate::app) fn files_in_use(&self) -> Vec<PathBuf> {
        let file = self.case.with_shown(&self.project_of_questions());
        let sources = self.session.sources.iter().map(|source| source.path.clone());
        let own = self.case.path.iter().cloned();
        file.input_files().into_iter().chain(sources).chain(own).collect()
    }

    /// The case with the project in the variant that is shown.
    pub(in crate::app) fn captured_case(&mut self) -> CaseFile {
        self.capture();
        self.case.file.clone()
    }

    /// Whether data or networks are still being read, so that not every question can be answered yet.
    pub(in crate::app) fn is_loading(&self) -> bool {
        let Session { sources, force, response, .. } = &self.session;
        let is_settled = sources.iter().all(Source::is_settled);
        !is_settled || force.model.current.is_none() || response.model.current.is_none()
    }

    /// Writes the project into the variant that is shown.
    fn capture(&mut self) {
        self.case.file = self.case.with_shown(&self.project_of_questions());
        let models = self.models_in_use();
        if !models.is_empty() {
            self.case.file.models = models;
        }
    }

    /// The networks of the answers that are shown.
    fn models_in_use(&self) -> Vec<UsedModel> {
        let force = self.session.force.forecast.ok();
        let motion = self.session.response.forecast.ok();
        let force = force.iter().flat_map(|answer| &answer.report.provenance.model_digests);
        let motion =
            motion.iter().flat_map(|answer| &answer.answer.report.provenance.model_digests);
        let mut models: Vec<UsedModel> = Vec::new();
        for ModelDigest { network, name, sha256 } in force.chain(motion) {
            let network = network.to_string();
            let model = UsedModel { network, name: name.clone(), sha256: sha256.clone() };
            if !models.contains(&model) {
                models.push(model);
            }
        }
        models
    }

    /// Takes another project and opens the data that it needs. What was done before cannot be undone after
    /// that.
    fn show_project(&mut self, project: Project) {
        let before = std::mem::replace(&mut self.project, project);
        let (project, session) = (&self.project, &mut self.session);
        if project.predict_force.model != before.predict_force.model {
            session.force.model.reload();
        }
        if project.predict_motion.response_model != before.predict_motion.response_model {
            session.response.model.reload();
        }
        let evidence =
            |project: &Project| project.reconstruct.as_ref().map(|of| of.evidence.clone());
        if evidence(project) != evidence(&before) {
            self.drop_reconstruction();
        }
        if self.project.replay != before.replay {
            self.session.recorder_replay = QuestionJob::default();
        }
        self.drop_answers();
        self.session.offered = None;
        self.session.said_of_files.clear();
        self.session.force.forecast.drop_answer();
        for SeriesFile { path, map } in self.project.sources() {
            let is_open = self.session.sources.iter().any(|source| source.path == path);
            if !is_open {
                self.load(path, map);
            }
        }
        self.session.shows_doors = false;
        self.view.workspaces.shown = Workspace::Case;
        if self.project.subject() == Some(Subject::Scenario) {
            self.view.workspaces.show_pane(Pane::Scenario);
        }
        if self.project.reconstruct.is_some() {
            self.view.workspaces.shown = Workspace::Reconstruct;
        }
        self.session.select_when_loaded = None;
        self.session.history_ends = true;
        self.session.playback.time_s = 0.0;
        self.session.fit_plots = true;
    }

    /// Carries out an action on the variants.
    pub(in crate::app) fn change_variant(&mut self, command: VariantCommand) {
        self.capture();
        let file = &mut self.case.file;
        match command {
            VariantCommand::Show(name) => file.shown = name,
            VariantCommand::Duplicate => {
                let Some(mut copy) = file.variant(&file.shown).cloned() else { return };
                copy.name = file.free_name(&copy.name);
                file.note(format!("variant {:?} copied from {:?}", copy.name, file.shown));
                file.shown = copy.name.clone();
                file.variants.push(copy);
                return;
            }
            VariantCommand::Rename(name) => {
                let (before, name) = (file.shown.clone(), name.trim().to_owned());
                if name == before {
                    return;
                }
                if name.is_empty() || file.variant(&name).is_some() {
                    let why = format!(
                        "a variant cannot be called {name:?}: expected a name that no other has"
                    );
                    return self.say(Severity::Warning, why);
                }
                if let Some(variant) = file.variant_mut(&before) {
                    variant.name = name.clone();
                }
                file.note(format!("variant {before:?} renamed to {name:?}"));
                file.shown = name;
                return;
            }
            VariantCommand::Note { name, notes } => {
                if let Some(variant) = file.variant_mut(&name) {
                    variant.notes = notes;
                }
                return;
            }
            VariantCommand::Remove => {
                if file.variants.len() < 2 {
                    return self.say(Severity::Warning, "a case has at least one variant");
                }
                let removed = file.shown.clone();
                file.variants.retain(|variant| variant.name != removed);
                file.note(format!("variant {removed:?} removed"));
                file.shown = file.variants.first().map_or(removed, |first| first.name.clone());
            }
        }
        self.show_variant();
    }

    /// Shows the variant of the case that is to be shown.
    fn show_variant(&mut self) {
        let file = &self.case.file;
        let Some(variant) = file.variant(&file.shown) else { return };
        match self.project.with_variant(variant) {
            Ok(project) => self.show_project(project),
            Err(error) => {
                let name = &file.shown;
                let why =
                    format!("the variant {name:?} cannot be shown, and stays as it is: {error}");
                self.say(Severity::Error, why);
                // What was shown before is of another variant, or of another case.
                let networks = self.project.networks.clone();
                self.show_project(Project { networks, ..Project::default() });
            }
        }
    }

    /// Puts another case in the place of the one that is open. What was entered or made for that one alone,
    /// beside what is saved with it, is not of the other.
    fn replace_case(&mut self, case: OpenCase) {
        self.case = case;
        self.forget_files_of_case();
        self.view.report.date.clear();
        let session = &mut self.session;
        session.n_cases += 1;
        session.tasks.stop(&TaskKey::Report);
        session.tasks.stop(&TaskKey::FileDialog);
        session.report = ReportSession::default();
        session.scene.measuring = Measuring::default();
        session.between = BetweenCursors::default();
        session.other_variants.clear();
        // What they would write is of the case before, or under a name that was meant for it.
        let writes =
            |of: &Dialog| matches!(of, Dialog::Film(_) | Dialog::Replace(..) | Dialog::Path(_));
        session.dialogs.close_if(writes);
    }

    /// Begins a case with nothing in it.
    pub(in crate::app) fn new_case(&mut self) {
        self.replace_case(OpenCase::default());
        let networks = self.project.networks.clone();
        let mut project = Project { networks, ..Project::default() };
        let (scenario, pulse) = (project.impact.scenario.clone(), project.beside.pulse);
        project.take_up(MotionSource::Scenario { scenario, pulse }, false);
        self.show_project(project);
    }

    /// Begins a case with a PIT, and shows its scene.
    pub(in crate::app) fn open_pit(&mut self) {
        self.new_case();
        self.view.workspaces.show_pane(Pane::Scene);
    }

    /// Begins a case with a reconstruction, and shows where its evidence comes from. It asks about no
    /// scenario: one that nobody has entered would be computed, saved and reported beside the evidence.
    pub(in crate::app) fn begin_reconstruction(&mut self) {
        self.replace_case(OpenCase::default());
        let networks = self.project.networks.clone();
        self.show_project(Project { networks, ..Project::default() });
        self.view.workspaces.show_pane(Pane::Evidence);
    }

    /// Opens the finished example case, which has no file of its own yet.
    pub(in crate::app) fn open_example(&mut self) {
        let beside = std::env::current_dir().unwrap_or_default().join("example.impactlab");
        match CaseFile::parse(EXAMPLE, &beside) {
            Ok(file) => {
                self.take_case(OpenCase::from_file(file));
                self.show_variant();
                self.case.saved = Some(self.case_fingerprint());
                self.view.workspaces.show_pane(Pane::MotionForecast);
            }
            Err(error) => self.say(Severity::Error, error_chain(&error)),
        }
    }

    /// Puts a case that was read in the place of the one that is open.
    fn take_case(&mut self, (case, problems): (OpenCase, Vec<String>)) {
        self.replace_case(case);
        problems.into_iter().for_each(|problem| self.say(Severity::Warning, problem));
    }

    /// Opens a case in the place of the one that is open. One that does more than read files in its own
    /// folder is opened once the user has allowed it.
    pub(in crate::app) fn open_case(&mut self, path: &Path) {
        let read = || -> Result<_, String> {
            let path = std::path::absolute(path).map_err(|error| error.to_string())?;
            let text = read_utf8(&path, MAX_RESULTS_BYTES).map_err(|error| error_chain(&error))?;
            let file = CaseFile::parse(&text, &path).map_err(|error| error_chain(&error))?;
            Ok((path, text, file))
        };
        let (path, text, file) = match read() {
            Ok(read) => read,
            Err(why) => return self.say(Severity::Error, why),
        };
        let opened = OpenCase::from_file(file);
        if !self.may_reach(&path, opened.0.file.reach(&path)) {
            return;
        }
        self.take_case(opened);
        self.look_for_changes(path.clone());
        self.case.path = Some(path.clone());
        self.show_variant();
        self.case.saved = Some(self.case_fingerprint());
        let edited = CaseOnDisk::from_text(&text, &path).change();
        let event = if edited.is_some() { "opened; edited since it was saved" } else { "opened" };
        edited.iter().for_each(|change| self.say(Severity::Warning, change.to_string()));
        self.case.on_disk = Some(text);
        self.case.file.note(event);
        self.remember_case(path);
    }

    /// Starts to compare the files of the case with what they were when it was saved.
    fn look_for_changes(&mut self, path: PathBuf) {
        let file = self.case.file.clone();
        self.session.tasks.start(
            TaskKey::CheckCase,
            move |_| Ok(file.changes()),
            |changes| match changes {
                Ok(changes) => Command::Case(CaseCommand::Changed(path, changes)),
                Err(why) => Command::Say(Severity::Error, why),
            },
        );
    }

    fn remember_case(&mut self, path: PathBuf) {
        let recent = &mut self.view.recent;
        recent.retain(|known| *known != path);
        recent.insert(0, path);
        recent.truncate(MAX_RECENT);
    }

    /// Whether saving to the case's own file would replace what somebody else has written there since.
    pub(in crate::app) fn is_case_file_foreign(&self) -> bool {
        let Some(path) = &self.case.path else { return false };
        if self.session.tasks.is_running(&TaskKey::SaveCase) {
            // What is in the file at this moment may be what this window has just written.
            return false;
        }
        match read_utf8(path, MAX_RESULTS_BYTES) {
            Ok(text) => self.case.on_disk.as_ref() != Some(&text),
            Err(_) => path.exists(),
        }
    }

    /// Starts to write the case to a file, which becomes its own.
    pub(in crate::app) fn save_case(&mut self, path: PathBuf, existing: Existing) {
        self.capture();
        let mut file = self.case.file.clone();
        if self.case.path.as_ref() != Some(&path) {
            file.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        }
        let (fingerprint, n_cases) = (super::fingerprint_of(&file), self.session.n_cases);
        let n_noted = file.log.len();
        file.note("saved");
        let write = move |_: &mut ProgressCallback<'_>| {
            file.record_files();
            let path = std::path::absolute(&path).map_err(|error| error.to_string())?;
            let on_disk = file.to_text(&path).map_err(|error| error_chain(&error))?;
            file.save(&path, existing).map_err(|error| error_chain(&error))?;
            let reach = file.reach(&path);
            let saved = SavedCase { file, path, on_disk, reach, fingerprint, n_cases, n_noted };
            Ok(Found::new(saved))
        };
        self.session
            .tasks
            .start(TaskKey::SaveCase, write, |saved| Command::Case(CaseCommand::Saved(saved)));
    }

    /// Starts to write one zip of the case and its files.
    pub(in crate::app) fn pack_case(&mut self, path: PathBuf, existing: Existing) {
        self.capture();
        // The file of the case goes to others, the folders of this machine do not.
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let event = format!("packed into {name}");
        let (mut file, n_cases) = (self.case.file.clone(), self.session.n_cases);
        file.note(event.as_str());
        self.session.tasks.start(
            TaskKey::Write(path.clone()),
            move |_| {
                let files = pack(&file, &path, existing).map_err(|error| error_chain(&error))?;
                let from = |file: &PackedFile| file.path.display().to_string();
                let files = listed(&files.iter().map(from).collect::<Vec<_>>());
                let message = format!("{} written, with the case and {files}", path.display());
                Ok(PackedCase { event, message, n_cases })
            },
            |packed| Command::Case(CaseCommand::Packed(packed)),
        );
    }

    /// Writes down that the case was packed. The log says nothing of a package that could not be made.
    fn take_packed_case(&mut self, packed: Result<PackedCase, String>) {
        match packed {
            Ok(PackedCase { event, message, n_cases }) => {
                self.say(Severity::Info, message);
                if n_cases == self.session.n_cases {
                    self.case.file.note(event);
                    self.say_unsaved_networks();
                }
            }
            Err(why) => self.say(Severity::Error, why),
        }
    }

    /// Receives the case that was written. What was changed since is not in its file.
    pub(in crate::app) fn take_saved_case(&mut self, written: Result<Found<SavedCase>, String>) {
        match written.map(Found::take) {
            // Another case was opened meanwhile, whose file it is not.
            Ok(SavedCase { path, reach, n_cases, .. }) if n_cases != self.session.n_cases => {
                self.trust_own(path.clone(), reach);
                self.say(Severity::Info, format!("{} written", path.display()));
                self.remember_case(path);
            }
            Ok(SavedCase { file, path, on_disk, reach, fingerprint, n_noted, .. }) => {
                self.trust_own(path.clone(), reach);
                let case = &mut self.case;
                case.file.name = file.name;
                case.file.files = file.files;
                note_saved(&mut case.file.log, file.log, n_noted);
                case.path = Some(path.clone());
                (case.on_disk, case.saved) = (Some(on_disk), Some(fingerprint));
                self.say(Severity::Info, format!("{} written", path.display()));
                self.remember_case(path);
                self.say_unsaved_networks();
            }
            Err(why) => self.say(Severity::Error, format!("the case was not saved: {why}")),
        }
    }

    /// Says which networks of the case are in no file, so that nobody else can ask them.
    fn say_unsaved_networks(&mut self) {
        if !self.case.file.networks_in_no_file().is_empty() {
            let why = "a network of this case was trained here and is in no file: save it (File, Save … model) so that the case can be run elsewhere";
            self.say(Severity::Warning, why);
        }
    }
}

/// Takes what a save has noted into the log of its case, before what was noted while it was written.
///
/// - `in_file`: the log in the file that was written; from its entry `n_noted` on it is about the save.
fn note_saved(log: &mut Vec<LogEntry>, mut in_file: Vec<LogEntry>, n_noted: usize) {
    let of_save = in_file.split_off(n_noted.min(in_file.len()));
    let later = log.get(n_noted..).unwrap_or_default();
    // A save that was begun earlier and noted meanwhile stays before this one.
    let is_earlier = |of: &&LogEntry| of_save.first().is_some_and(|saved| of.time < saved.time);
    let at = (n_noted + later.iter().take_while(is_earlier).count()).min(log.len());
    log.splice(at..at, of_save);
}

/// The files in a package, the first ones by their paths.
fn listed(files: &[String]) -> String {
    const MAX_LISTED: usize = 10;
    match files.len() {
        0 => "no other file".to_owned(),
        n if n > MAX_LISTED => {
            format!("{n} files: {} and {} more", files[..MAX_LISTED].join(", "), n - MAX_LISTED)
        }
        _ => files.join(", "),
    }
}
