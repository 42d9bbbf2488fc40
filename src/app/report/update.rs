//! Starts and receives reports.

use std::sync::Arc;

use crate::app::command::Command;
use crate::app::panes::Pane;
use crate::app::report::make::make_report;
use crate::app::report::{ReportCommand, ReportOrigin};
use crate::app::state::State;
use crate::app::tasks::TaskKey;
use crate::app::workspaces::Workspace;
use impactlab_core::data::Severity;
use impactlab_study::case_file::CaseOnDisk;

impl State {
    /// What a report would be made of now.
    ///
    /// # Errors
    /// A message for the user if the date is none.
    pub(in crate::app) fn report_origin(&self) -> Result<ReportOrigin, String> {
        let view = &self.view.report;
        let variants = match view.shown_variant_only {
            true => vec![self.case.file.shown.clone()],
            false => Vec::new(),
        };
        Ok(ReportOrigin {
            fingerprint: self.case_fingerprint(),
            n_reopened: self.session.n_reopened,
            variants,
            settings: view.settings(self.view.units)?,
        })
    }

    /// Carries out an action on the report.
    pub(in crate::app) fn report(&mut self, command: ReportCommand) {
        match command {
            ReportCommand::Make => self.make_report(),
            ReportCommand::Cancel => {
                self.session.tasks.cancel(&TaskKey::Report);
            }
            ReportCommand::Made(result) => self.session.report.take(result),
            ReportCommand::ShowSection(kind) => {
                self.session.report.wanted_section = Some(kind);
                self.view.workspaces.show_pane(Pane::ReportPages);
            }
        }
    }

    fn make_report(&mut self) {
        let origin = match self.report_origin() {
            Ok(origin) => origin,
            Err(why) => return self.say(Severity::Error, why),
        };
        if self.is_loading() {
            return self.say(
                Severity::Warning,
                "data or networks are still being read; make the report when they are",
            );
        }
        let own = self.case.path.clone().filter(|_| !self.is_case_changed());
        let case = self.captured_case();
        let library = Arc::clone(&self.session.library);
        self.session.report.is_running = true;
        self.session.tasks.start(
            TaskKey::Report,
            move |tell| {
                let on_disk = own.as_deref().and_then(|path| CaseOnDisk::read(path).ok());
                make_report(&case, on_disk.as_ref(), origin, &library, tell)
            },
            |result| Command::Report(ReportCommand::Made(result)),
        );
    }

    /// Finds out whether the report that is shown is of the case as it is.
    pub(in crate::app) fn update_report(&mut self) {
        if self.view.workspaces.shown != Workspace::Report {
            return;
        }
        let origin = self.report_origin().ok();
        let asks_nothing = self.asks_nothing();
        let session = &mut self.session.report;
        let is_other = |made: &Arc<super::MadeReport>| Some(&made.origin) != origin.as_ref();
        session.is_outdated = session.made.as_ref().is_some_and(is_other);
        session.asks_nothing = asks_nothing;
    }
}
