//! Starts, receives and saves reports.

use std::path::Path;
use std::sync::Arc;

use egui::Context;

use crate::app::command::wake;
use crate::app::export;
use crate::app::panes::Pane;
use crate::app::report::make::ReportJob;
use crate::app::report::{ReportCommand, ReportOrigin};
use crate::app::state::State;
use crate::app::workspaces::Workspace;
use impactlab_core::data::{Existing, Outcome, Severity};
use impactlab_document::report::ReportDocument;

impl State {
    /// What a report would be made of now.
    ///
    /// # Errors
    /// A message for the user if the date is none.
    fn report_origin(&self) -> Result<ReportOrigin, String> {
        let view = &self.view.report;
        let variants = match view.shown_variant_only {
            true => vec![self.case.file.shown.clone()],
            false => Vec::new(),
        };
        Ok(ReportOrigin {
            fingerprint: self.case.fingerprint(&self.forms()),
            variants,
            settings: view.settings(self.view.units)?,
        })
    }

    /// Carries out an action on the report.
    pub(in crate::app) fn report(&mut self, command: ReportCommand, context: &Context) {
        match command {
            ReportCommand::Make => self.make_report(context),
            ReportCommand::Cancel => {
                if let Some(job) = self.session.report.job() {
                    job.cancel();
                }
            }
            ReportCommand::ShowSection(kind) => {
                self.session.report.wanted_section = Some(kind);
                self.view.workspaces.show_pane(Pane::ReportPages);
            }
        }
    }

    fn make_report(&mut self, context: &Context) {
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
        let case = self.captured_case();
        let started = ReportJob::start((case, origin), &self.session.library, wake(context));
        match started {
            Ok(job) => self.session.report.running = Some(job),
            Err(error) => self.say(Severity::Error, error.to_string()),
        }
    }

    /// Receives the report, and finds out whether the one that is shown is of the case as it is.
    pub(in crate::app) fn update_report(&mut self) {
        let session = &mut self.session.report;
        if let Some(running) = &mut session.running
            && let Some(result) = running.job.poll().into_result("the report")
        {
            session.running = None;
            match result {
                Ok(Outcome::Complete(made)) => {
                    session.show(made);
                }
                Ok(Outcome::Cancelled) => {}
                Err(why) => session.problem = Some(why),
            }
        }
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

    /// Starts to write a report to a file, in the format of its ending.
    pub(in crate::app) fn save_report(
        &mut self,
        document: Arc<ReportDocument>,
        (path, existing): (&Path, Existing),
        context: &Context,
    ) {
        match export::spawn_report(document, (path.to_owned(), existing), wake(context)) {
            Ok(job) => self.session.exports.push(job),
            Err(error) => self.say(Severity::Error, error.to_string()),
        }
    }
}
