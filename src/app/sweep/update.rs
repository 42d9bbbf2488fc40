//! Reads, times, computes and merges the sweep.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::command::Command;
use crate::app::found::Found;
use crate::app::panes::Pane;
use crate::app::state::State;
use crate::app::sweep::{ReadSweep, SweepCommand, SweepView, work};
use crate::app::tasks::TaskKey;
use crate::app::workspaces::Workspace;
use impactlab_core::data::{Existing, Severity};
use impactlab_sweep::{PLAN_FILE, RunReport};

impl State {
    /// Carries out an action on the sweep.
    pub(in crate::app) fn sweep(&mut self, command: SweepCommand) {
        match command {
            SweepCommand::OpenPlan(path) => self.open_plan(path),
            SweepCommand::Folder(folder) => {
                if !self.is_sweep_busy() {
                    let SweepView { plan, .. } = self.view.sweep.clone();
                    self.show_sweep(SweepView { plan, folder: Some(folder) });
                }
            }
            SweepCommand::Look => self.look_at_sweep(),
            SweepCommand::Read(read) => {
                let session = &mut self.session.sweep;
                if session.reading.as_ref() == Some(&read.of) {
                    let before = session.sweep().map(|sweep| sweep.plan.clone());
                    session.reading = None;
                    session.read = Some(read.take());
                    // Rows of the plan as it was say nothing of those that it has now.
                    if session.sweep().map(|sweep| &sweep.plan) != before.as_ref() {
                        session.timed = None;
                    }
                }
            }
            SweepCommand::Time => self.time_rows(),
            SweepCommand::Timed(of, timed) => {
                if of == self.view.sweep {
                    self.session.sweep.timed = Some(timed);
                }
            }
            SweepCommand::Start => self.start_sweep(),
            SweepCommand::Cancel => {
                for key in [TaskKey::Sweep, TaskKey::MergeSweep, TaskKey::TimeSweep] {
                    self.session.tasks.cancel(&key);
                }
            }
            SweepCommand::Ended(result) => self.end_sweep(result),
        }
    }

    /// Whether a sweep is computed or merged, so that no other takes its place.
    fn is_sweep_busy(&mut self) -> bool {
        let keys = [TaskKey::Sweep, TaskKey::MergeSweep];
        let is_busy = keys.iter().any(|key| self.session.tasks.is_running(key));
        if is_busy {
            let why = "a sweep is being computed: cancel it before another takes its place";
            self.say(Severity::Warning, why);
        }
        is_busy
    }

    /// Shows the plan of a file, or the sweep of the folder whose plan it is.
    fn open_plan(&mut self, path: PathBuf) {
        if self.is_sweep_busy() {
            return;
        }
        let is_in_folder = path.file_name().is_some_and(|name| name == PLAN_FILE);
        let folder = path.parent().map(PathBuf::from).filter(|_| is_in_folder);
        let plan = folder.is_none().then_some(path);
        self.session.shows_doors = false;
        self.view.workspaces.show_pane(Pane::Sweep);
        self.show_sweep(SweepView { plan, folder });
    }

    fn show_sweep(&mut self, of: SweepView) {
        self.view.sweep = of;
        self.session.tasks.stop(&TaskKey::TimeSweep);
        let session = &mut self.session.sweep;
        (session.read, session.timed, session.problem) = (None, None, None);
        self.look_at_sweep();
    }

    /// Reads plan and folder when the workspace is shown.
    pub(in crate::app) fn update_sweep(&mut self) {
        let is_shown = self.view.workspaces.shown == Workspace::Atlas && !self.session.shows_doors;
        let session = &self.session.sweep;
        let is_read = session.read.as_ref().is_some_and(|read| read.of == self.view.sweep);
        let is_reading = session.reading.as_ref() == Some(&self.view.sweep);
        if is_shown && self.view.sweep.is_chosen() && !is_read && !is_reading {
            self.look_at_sweep();
        }
    }

    /// Starts to read the plan and what the folder holds.
    fn look_at_sweep(&mut self) {
        let of = self.view.sweep.clone();
        if !of.is_chosen() {
            return;
        }
        self.session.sweep.reading = Some(of.clone());
        let (read, library) = (of.clone(), Arc::clone(&self.session.library));
        self.session.tasks.start(
            TaskKey::ReadSweep,
            move |_| work::read(&read, &library),
            |sweep| {
                let read = ReadSweep { of, sweep };
                Command::Sweep(SweepCommand::Read(Found::new(read)))
            },
        );
    }

    /// Starts to time some rows.
    fn time_rows(&mut self) {
        let Some(sweep) = self.session.sweep.sweep() else { return };
        let (plan, library) = (sweep.plan.clone(), Arc::clone(&self.session.library));
        let of = self.view.sweep.clone();
        self.session.sweep.timed = None;
        self.session.tasks.start_in_background(
            TaskKey::TimeSweep,
            move |report| work::time(&plan, &library, report),
            |timed| Command::Sweep(SweepCommand::Timed(of, timed)),
        );
    }

    /// Starts to compute what is missing.
    fn start_sweep(&mut self) {
        if self.is_sweep_busy() {
            return;
        }
        let Some(sweep) = self.session.sweep.sweep() else { return };
        let Some(folder) = self.view.sweep.folder.clone() else {
            return self.say(Severity::Warning, "choose a folder for the chunks first");
        };
        let (plan, library) = (sweep.plan.clone(), Arc::clone(&self.session.library));
        self.session.sweep.problem = None;
        self.session.tasks.start_in_background(
            TaskKey::Sweep,
            move |report| work::run(&plan, &folder, &library, report),
            |result| Command::Sweep(SweepCommand::Ended(result)),
        );
    }

    /// Says what a run has done, and looks at what is there now.
    fn end_sweep(&mut self, result: Result<Option<RunReport>, String>) {
        match result {
            Ok(Some(run)) => {
                let (n, rows, failed) = (run.computed.len(), run.rows, run.failed);
                let text = format!(
                    "sweep over: {n} chunks with {rows} rows computed, {failed} of the rows without an \
                     answer"
                );
                self.say(Severity::Info, text);
                for (chunk, what) in run.replaced {
                    let text = format!("chunk {chunk} was broken ({what}) and was computed anew");
                    self.say(Severity::Warning, text);
                }
            }
            Ok(None) => self.say(Severity::Info, "sweep stopped; the finished chunks stay"),
            Err(why) => {
                self.say(Severity::Error, format!("sweep: {why}"));
                self.session.sweep.problem = Some(why);
            }
        }
        self.look_at_sweep();
    }

    /// Starts to put the chunks of the sweep together in one file.
    pub(in crate::app) fn merge_sweep(&mut self, path: PathBuf, existing: Existing) {
        let Some(folder) = self.view.sweep.folder.clone() else { return };
        self.session.tasks.start_in_background(
            TaskKey::MergeSweep,
            move |report| work::merge(&folder, &path, existing, report),
            |merged| match merged {
                Ok(text) => Command::Say(Severity::Info, text),
                Err(why) => Command::Say(Severity::Error, why),
            },
        );
    }
}
