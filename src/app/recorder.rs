//! The record of an event data recorder that was opened: what of it is put into the evidence.

use std::path::{Path, PathBuf};

use egui::Context;

use crate::app::command::wake;
use crate::app::dialog::Dialog;
use crate::app::model::file_name;
use crate::app::panes::Pane;
use crate::app::question_job::QuestionJob;
use crate::app::state::{Session, State};
use impactlab_core::collision::Role;
use impactlab_core::data::{DataError, RecorderRecord, Severity};
use impactlab_reconstruct::evidence::{Edr, Evidence};
use impactlab_study::{EvidenceChoice, ReplayRequest};

/// Events of a report that are offered.
const MAX_EVENTS: usize = 32;

/// What of a recorder becomes evidence.
#[derive(Debug, Clone, PartialEq)]
pub struct RecorderForm {
    /// The file.
    pub path: PathBuf,
    /// The records of its events, as far as anything was recorded.
    pub records: Vec<RecorderRecord>,
    /// The event that is chosen, by its index.
    pub event: usize,
    /// The car in which the recorder was.
    pub car: Role,
    /// Whether lateral changes of velocity are positive to the left in the file.
    pub is_lateral_to_left: bool,
}

/// An action on a recorder that was opened.
#[derive(Debug, Clone)]
pub enum RecorderCommand {
    /// Put a record into the evidence of the reconstruction, in place of another one of this car.
    MakeEvidence {
        /// The record, with lateral values positive to the right.
        record: Box<RecorderRecord>,
        /// The car in which the recorder was.
        car: Role,
    },
    /// Open the controls before the crash as a series.
    OpenControls(PathBuf),
    /// Ask for the replay of a file with a vehicle of the project, and run it.
    Replay {
        /// The recorder's file.
        path: PathBuf,
        /// Which event of several, counted from 1; if not given the one that was asked for of this file, else
        /// the first one.
        event: Option<usize>,
        /// The car in which the recorder was.
        car: Role,
    },
    /// Run the replay that is asked for.
    RunReplay,
    /// Stop the replay that is running.
    CancelReplay,
}

impl RecorderForm {
    /// Reads the records of all events.
    ///
    /// # Errors
    /// [`DataError`] if nothing was recorded in any of them.
    fn read(path: &Path) -> Result<Self, DataError> {
        let first = RecorderRecord::read(path, None);
        let mut records: Vec<RecorderRecord> = match &first {
            // Without the remark that one of several was taken unasked.
            Ok(record) if record.events.len() > 1 => Vec::new(),
            Ok(record) => vec![record.clone()],
            Err(_) => Vec::new(),
        };
        let n_events = first.as_ref().map_or(MAX_EVENTS, |record| record.events.len());
        if records.is_empty() {
            let read = |event| RecorderRecord::read(path, Some(event));
            for record in (1..=n_events.min(MAX_EVENTS)).map(read) {
                match record {
                    Err(DataError::NoSheet { .. }) => break,
                    record => records.extend(record),
                }
            }
        }
        if records.is_empty() {
            first?;
        }
        let (path, event, car) = (path.to_owned(), 0, Role::Struck);
        Ok(Self { path, records, event, car, is_lateral_to_left: false })
    }

    /// The record of the chosen event, with lateral values positive to the right.
    pub fn record(&self) -> Option<RecorderRecord> {
        let mut record = self.records.get(self.event)?.clone();
        if self.is_lateral_to_left {
            record.turn_lateral();
        }
        Some(record)
    }

    /// The number of the chosen event, counted from 1; none if the file has one alone.
    pub fn event_number(&self) -> Option<usize> {
        let record = self.records.get(self.event).filter(|record| record.events.len() > 1)?;
        let idx = record.events.iter().position(|event| *event == record.event)?;
        Some(idx + 1)
    }
}

impl State {
    /// Asks what becomes of a recorder's file. A file without a record is opened as a table, and so is another
    /// one as long as that is asked of one.
    pub(super) fn ask_recorder(&mut self, path: PathBuf) {
        let is_open = |dialog: &Dialog| matches!(dialog, Dialog::Recorder(_));
        if self.session.dialogs.iter().any(is_open) {
            return self.load(path, None);
        }
        match RecorderForm::read(&path) {
            Ok(form) => self.session.dialogs.open(Dialog::Recorder(Box::new(form))),
            Err(_) => self.load(path, None),
        }
    }

    /// Carries out what was chosen of a recorder.
    pub(super) fn take_recorder(&mut self, command: RecorderCommand, context: &Context) {
        self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Recorder(_)));
        match command {
            RecorderCommand::OpenControls(path) => {
                self.session.shows_doors = false;
                self.load(path, None);
            }
            RecorderCommand::Replay { path, event, car } => {
                let vehicle = self.project.chosen_vehicle(car).into_owned();
                // What was said of the same file stays.
                let before = self.project.replay.take().filter(|before| before.recorder == path);
                if before.is_none() {
                    self.session.recorder_replay = QuestionJob::default();
                }
                let asked = before.unwrap_or_else(|| ReplayRequest::new(path));
                let event = event.or(asked.event);
                self.project.replay = Some(ReplayRequest { event, vehicle, ..asked });
                self.session.shows_doors = false;
                self.view.workspaces.show_pane(Pane::Replay);
                self.run_recorder_replay(context);
            }
            RecorderCommand::RunReplay => self.run_recorder_replay(context),
            RecorderCommand::CancelReplay => self.session.recorder_replay.cancel(),
            RecorderCommand::MakeEvidence { record, car } => {
                let mut evidence = self.evidence().cloned().unwrap_or_else(Evidence::empty);
                if evidence.is_single_car() {
                    let text = "The evidence is of a single car, which has no record of a crash: add a \
                                recorded speed, or begin with new evidence";
                    return self.say(Severity::Error, text);
                }
                let slot = match car {
                    Role::Struck => &mut evidence.edr,
                    Role::Striking => &mut evidence.striking_edr,
                };
                let before = slot.replace(Edr::from_record(&record));
                self.take_evidence(EvidenceChoice::Inline(Box::new(evidence)));
                let of = match before {
                    Some(_) => "in place of the one that was there",
                    None => "which had none",
                };
                let text = format!(
                    "the record is in the evidence of the {}, {of}; time 0 is when the recorder woke up, and its \
                     sensor is at the CG until its place is entered",
                    car.label()
                );
                self.say(Severity::Info, text);
                for doubt in &record.doubts {
                    self.say(Severity::Warning, doubt.clone());
                }
            }
        }
    }
}

impl State {
    fn run_recorder_replay(&mut self, context: &Context) {
        let Some(request) = self.project.replay.clone() else {
            return self.say(Severity::Warning, "there is no recorder's file to be replayed");
        };
        let Session { recorder_replay, library, .. } = &mut self.session;
        if let Err(error) = recorder_replay.start(request, library, wake(context)) {
            self.say(Severity::Error, error.to_string());
        }
    }

    /// Receives the replay of a recorder, and drops one that nobody asks for any more.
    pub(super) fn update_recorder_replay(&mut self) {
        if self.project.replay.is_none() {
            self.session.recorder_replay = QuestionJob::default();
        } else if self.session.recorder_replay.poll() {
            self.session.fit_plots = true;
        }
    }
}

/// The name of a file as the title of its form.
pub(in crate::app) fn title(form: &RecorderForm) -> String {
    format!("Recorder: {}", file_name(&form.path))
}
