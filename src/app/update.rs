//! The work that is done before each frame: results of jobs are received, time advances, and
//! questions that have changed are asked.

use std::path::Path;
use std::time::Duration;

use egui::Context;

use crate::app::command::wake;
use crate::app::found::Found;
use crate::app::source::{Content, OpenedMap, OpenedPath, Source};
use crate::app::state::{Session, State, Subject};
use impactlab_core::data::{DatasetKind, Outcome, Severity};

/// Time after which the window is drawn again while an answer is awaited, so that it can be marked late.
const WAITING_REPAINT: Duration = Duration::from_millis(120);

impl State {
    /// Receives the results of the jobs, asks the questions that have changed and advances the
    /// time.
    ///
    pub fn update(&mut self, context: &Context) {
        for command in self.session.tasks.poll() {
            self.apply(command, context);
        }
        self.poll_replays();
        self.leave_if_written(context);
        let Session { dialogs, tasks, .. } = &mut self.session;
        if let Some(dialog) = dialogs.import_mut() {
            dialog.update(self.view.units, tasks);
        }
        self.select_something();
        self.keep_questions_in_step();
        self.session.chosen_vehicles.update(&self.project);
        let Session { cases, sources, replays, .. } = &mut self.session;
        cases.update(sources, replays, &self.view);
        self.update_ground();
        self.update_simulation(context);
        self.update_hand(context);
        self.update_recorder_replay();
        self.update_force(context);
        self.update_response(context);
        self.update_scene(context);
        self.update_reconstruction(context);
        self.update_known_case();
        self.update_variants(context);
        self.update_report();
        self.update_atlas();
        self.update_sweep();
        self.take_archived_names();
        self.update_costs(context);
        self.advance_time(context);
        if self.session.is_waiting() {
            context.request_repaint_after(WAITING_REPAINT);
        }
    }

    /// Takes what was found at a path that was opened. A doubtful file is asked about and closed until
    /// the user has answered.
    pub(super) fn take_opened(
        &mut self,
        path: &Path,
        result: Result<Outcome<Found<OpenedPath>>, String>,
    ) {
        let is_it = |source: &Source| source.opened == path && !source.is_settled();
        let Some(idx) = self.session.sources.iter().position(is_it) else { return };
        let source = self.session.sources.remove(idx);
        let mut read = vec![path.to_owned()];
        if let Ok(Outcome::Complete(opened)) = &result {
            read.extend(opened.paths().cloned());
        }
        self.ask_again_about(&read);
        let (found, without_map) = match result {
            Ok(Outcome::Cancelled) => return,
            Ok(Outcome::Complete(opened)) => {
                let failure = opened.failure.as_ref();
                if let Some(failure) = failure {
                    self.say(Severity::Error, failure.message.clone());
                }
                let failed = failure.filter(|failure| OpenedPath::is_about_columns(failure));
                let without_map = failed.map(|failure| failure.path.clone());
                match opened.is_doubtful {
                    true => (Vec::new(), Some(source.path.clone())),
                    false => {
                        self.remember_map(&source, &opened);
                        (source.opened(&opened, &self.session.library), without_map)
                    }
                }
            }
            Err(why) => {
                self.say(Severity::Error, format!("{}: {why}", path.display()));
                (vec![Source::failed(path.to_owned(), why)], None)
            }
        };
        self.session.sources.splice(idx..idx, found);
        if let Some(path) = without_map {
            self.ask_mapping(path);
        }
    }

    /// Keeps the map with which a file was opened for files with the same header, and says so if it is
    /// one that was kept.
    fn remember_map(&mut self, source: &Source, opened: &OpenedPath) {
        let Some(OpenedMap { map, fingerprint, is_remembered }) = &opened.map else { return };
        if *is_remembered {
            let text = format!(
                "{}: read as files with this header before, {map}; change it in the Data pane",
                source.path.display()
            );
            self.say(Severity::Info, text);
        }
        if let Some(fingerprint) = fingerprint.clone().filter(|_| opened.failure.is_none()) {
            self.view.column_maps.keep(source.path.clone(), fingerprint, map.clone());
        }
    }

    /// Receives the simulations of whole data sets and shows their problems to the user.
    fn poll_replays(&mut self) {
        let mut problems = Vec::new();
        for replay in self.session.replays.values_mut() {
            problems.extend(replay.poll());
        }
        self.session.replays.retain(|_, replay| !replay.is_empty());
        for problem in problems {
            self.say(Severity::Error, problem);
        }
    }

    /// Offers the first case or file of what the user opened last to the variant, once everything is loaded;
    /// if there is none, that of all sources. Data that the program opened by itself lie beside: which case
    /// is looked at is the user's choice. If no open data set is listed, the first one is.
    fn select_something(&mut self) {
        let Session { sources, select_when_loaded, .. } = &self.session;
        let are_settled = sources.iter().all(Source::is_settled);
        let opened = |source: &&Source| Some(&source.opened) == select_when_loaded.as_ref();
        let is_there = sources.iter().any(|source| opened(&source));
        // It does not wait for data that were opened before, such as those that come with the program.
        if are_settled || (is_there && sources.iter().filter(opened).all(Source::is_settled)) {
            let first = first_subject(sources.iter().filter(opened));
            self.session.select_when_loaded = None;
            if let Some(subject) = first {
                self.offer(subject);
            }
        }
        if !are_settled {
            return;
        }
        // Data of another case are not taken into one that was opened.
        let Session { sources, opened_at_start, .. } = &self.session;
        let is_users = |source: &&Source| !opened_at_start.contains(&source.opened);
        if self.project.subject().is_none()
            && self.case.path.is_none()
            && let Some(subject) = first_subject(sources.iter().filter(is_users))
        {
            self.select(subject);
        }
        let is_listed = |source: &Source| Some(&source.path) == self.view.listed.as_ref();
        if !self.session.sources.iter().any(|s| is_listed(s) && s.dataset().is_some()) {
            let dataset = self.session.sources.iter().find(|source| source.dataset().is_some());
            self.view.listed = dataset.map(|source| source.path.clone());
        }
    }

    /// Asks for the simulation of the subject and for the impulse solution of the scenario, if the
    /// questions have changed.
    fn update_simulation(&mut self, context: &Context) {
        let (simulate, impact) = (self.simulate_request(), self.impact_request());
        let Session { analysis, impact: solution, library, .. } = &mut self.session;
        solution.poll();
        solution.ask(impact, library, wake(context));
        analysis.poll();
        match simulate {
            Some(question) => analysis.ask(question, library, wake(context)),
            None => analysis.forget(),
        }
    }

    /// Asks for the calculation by hand, if the question has changed.
    fn update_hand(&mut self, context: &Context) {
        let Session { hand, library, .. } = &mut self.session;
        hand.poll();
        match &self.project.hand {
            Some(question) => hand.ask(question.clone(), library, wake(context)),
            None => hand.forget(),
        }
    }

    fn advance_time(&mut self, context: &Context) {
        if !self.session.playback.is_playing {
            return;
        }
        let end_s = self.end_time_s();
        let passed_s = f64::from(context.input(|input| input.unstable_dt.min(0.5)));
        self.session.playback.advance(passed_s * self.view.playback_speed, end_s);
        context.request_repaint();
    }
}

/// Returns the first case of the first trajectory data set; without one, that of the first force
/// data set; without either, the first file.
fn first_subject<'a>(sources: impl Iterator<Item = &'a Source>) -> Option<Subject> {
    let subject = |source: &Source| match &source.content {
        Content::Dataset(checked) => {
            let case = checked.dataset.cases.first()?.name.clone();
            let rank = if checked.dataset.kind == DatasetKind::Trajectory { 0 } else { 1 };
            Some((rank, Subject::Case { dataset: source.path.clone(), case }))
        }
        Content::File(_) => Some((2, Subject::File(source.path.clone()))),
        Content::Loading | Content::Failed(_) => None,
    };
    sources.filter_map(subject).min_by_key(|(rank, _)| *rank).map(|(_, subject)| subject)
}
