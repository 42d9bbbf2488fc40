//! What happens between frames: jobs report, time runs, a changed request starts a new analysis.

use std::path::PathBuf;
use std::sync::Arc;

use egui::Context;

use crate::analysis::{Analysis, Settings, analyse_case, analyse_file, analyse_scenario};
use crate::app::case_table::FinishedReplay;
use crate::app::command::{Command, wake};
use crate::app::source::{CheckedDataset, CheckedFile, Content, OpenError, Source};
use crate::app::state::{Project, ReplayStatus, Session, State, Subject, VehicleChoice};
use crate::data::{DatasetKind, Outcome, Severity};
use crate::error_chain;
use crate::jobs::{Job, Update};
use crate::vehicle::{Equations, Preset, VehicleParameters};

/// What an analysis is made from, ready to be sent to another thread.
enum Material {
    Case(Arc<CheckedDataset>, String),
    File(Arc<CheckedFile>, PathBuf),
    Scenario,
}

impl State {
    /// Takes in what the jobs report and starts what is due.
    pub fn update(&mut self, context: &Context, commands: &mut Vec<Command>) {
        self.poll_sources(commands);
        self.poll_replays();
        self.poll_exports();
        self.poll_analysis();
        if let Some(answer) = self.session.file_dialog.as_mut().and_then(|dialog| dialog.poll()) {
            self.session.file_dialog = None;
            commands.extend(answer);
        }
        self.select_something();
        let Session { cases, sources, replays, .. } = &mut self.session;
        cases.update(sources, replays, &self.view);
        self.request_analysis(context);
        self.update_force(context);
        self.update_response(context);
        self.advance_time(context);
    }

    fn poll_sources(&mut self, commands: &mut Vec<Command>) {
        let sources = std::mem::take(&mut self.session.sources);
        for mut source in sources {
            let Content::Loading(job) = &mut source.content else {
                self.session.sources.push(source);
                continue;
            };
            match job.poll() {
                Update::Running => self.session.sources.push(source),
                Update::Finished(Ok(contents)) => {
                    for (path, content) in contents {
                        let opened = source.opened.clone();
                        self.session.sources.push(Source { opened, path, content });
                    }
                }
                Update::Finished(Err(OpenError { text, needs_mapping })) => {
                    if needs_mapping {
                        commands.push(Command::AskMapping(source.path.clone()));
                    }
                    self.say(Severity::Error, text.clone());
                    self.session.sources.push(Source::failed(source.opened, text));
                }
                Update::Panicked(text) => self.fail(source, format!("internal error: {text}")),
                Update::Gone => self.fail(source, "the loader is gone".to_owned()),
            }
        }
    }

    fn fail(&mut self, source: Source, why: String) {
        self.say(Severity::Error, format!("{}: {why}", source.opened.display()));
        self.session.sources.push(Source::failed(source.opened, why));
    }

    fn poll_replays(&mut self) {
        let mut news = Vec::new();
        for (path, status) in &mut self.session.replays {
            let ReplayStatus::Running(job) = status else {
                continue;
            };
            match job.poll() {
                Update::Running => {}
                Update::Finished(Err(text)) => news.push((path.clone(), Some(text), true)),
                Update::Finished(Ok(Outcome::Complete(replay))) => {
                    let failures = replay.failures.iter().map(|failure| error_chain(failure));
                    news.extend(failures.map(|text| (path.clone(), Some(text), false)));
                    *status = ReplayStatus::Done(FinishedReplay::new(replay));
                }
                Update::Finished(Ok(Outcome::Cancelled)) => news.push((path.clone(), None, true)),
                Update::Panicked(text) => {
                    news.push((path.clone(), Some(format!("internal error: {text}")), true));
                }
                Update::Gone => news.push((path.clone(), None, true)),
            }
        }
        for (path, text, forget) in news {
            if forget {
                self.session.replays.remove(&path);
            }
            if let Some(text) = text {
                self.say(Severity::Error, text);
            }
        }
    }

    fn poll_exports(&mut self) {
        let mut jobs = std::mem::take(&mut self.session.exports);
        jobs.retain_mut(|job| match job.poll() {
            Update::Running => true,
            Update::Finished(Ok(path)) => {
                self.say(Severity::Info, format!("{} written", path.display()));
                false
            }
            Update::Finished(Err(text)) | Update::Panicked(text) => {
                self.say(Severity::Error, text);
                false
            }
            Update::Gone => false,
        });
        self.session.exports.append(&mut jobs);
    }

    fn poll_analysis(&mut self) {
        let status = &mut self.session.analysis;
        let Some(job) = &mut status.job else { return };
        let result = match job.poll() {
            Update::Running => return,
            Update::Finished(result) => result.map(Arc::new),
            Update::Panicked(text) => Err(format!("internal error: {text}")),
            Update::Gone => Err("the analysis is gone".to_owned()),
        };
        status.result = Some(result);
        status.job = None;
    }

    /// Looks at what the user has just opened, or at anything at all, so that a new user sees
    /// something.
    fn select_something(&mut self) {
        let sources = &self.session.sources;
        if !sources.iter().all(Source::is_settled) {
            return;
        }
        let look_at = self.session.look_at.take();
        let opened = |source: &&Source| Some(&source.opened) == look_at.as_ref();
        let first = first_subject(sources.iter().filter(opened));
        if let Some(subject) = first {
            self.select(subject);
        }
        if self.project.subject.is_none()
            && let Some(subject) = first_subject(self.session.sources.iter())
        {
            self.select(subject);
        }
        let is_listed = |source: &Source| Some(&source.path) == self.view.listed.as_ref();
        if !self.session.sources.iter().any(|s| is_listed(s) && s.dataset().is_some()) {
            let dataset = self.session.sources.iter().find(|source| source.dataset().is_some());
            self.view.listed = dataset.map(|source| source.path.clone());
        }
    }

    /// Starts an analysis if the project has changed since the last one, and the data are there.
    fn request_analysis(&mut self, context: &Context) {
        let settled = self.session.sources.iter().filter(|source| source.is_settled()).count();
        let status = &mut self.session.analysis;
        if let Some(requested) = &mut status.requested {
            // no part of an analysis
            requested.force.clone_from(&self.project.force);
            requested.response.clone_from(&self.project.response);
        }
        let is_current =
            status.requested.as_deref() == Some(&self.project) && status.sources_seen == settled;
        if is_current {
            return;
        }
        let Some(material) = self.material() else {
            let status = &mut self.session.analysis;
            (status.result, status.job, status.requested) = (None, None, None);
            return;
        };
        let project = self.project.clone();
        let job = Job::spawn("analyse", wake(context), move |_| analyse(&material, &project));
        let status = &mut self.session.analysis;
        status.requested = Some(Box::new(self.project.clone()));
        status.sources_seen = settled;
        match job {
            Ok(job) => status.job = Some(job),
            Err(error) => (status.job, status.result) = (None, Some(Err(error.to_string()))),
        }
    }

    fn material(&self) -> Option<Material> {
        let find = |path: &PathBuf| self.session.sources.iter().find(|s| s.path == *path);
        match self.project.subject.as_ref()? {
            Subject::Case { dataset, case } => {
                let checked = find(dataset)?.dataset()?;
                checked.dataset.case(case)?;
                Some(Material::Case(Arc::clone(checked), case.clone()))
            }
            Subject::File(path) => match &find(path)?.content {
                Content::File(file) => Some(Material::File(Arc::clone(file), path.clone())),
                _ => None,
            },
            Subject::Scenario => Some(Material::Scenario),
        }
    }

    fn advance_time(&mut self, context: &Context) {
        if !self.session.playing {
            return;
        }
        let end = self.end_time_s();
        self.session.time_s += f64::from(context.input(|input| input.unstable_dt.min(0.5)));
        if self.session.time_s >= end {
            self.session.time_s = end;
            self.session.playing = false;
        }
        context.request_repaint();
    }
}

/// The first case of recorded motions, else the first case or file.
fn first_subject<'a>(sources: impl Iterator<Item = &'a Source>) -> Option<Subject> {
    let subject = |source: &Source| match &source.content {
        Content::Dataset(checked) => {
            let case = checked.dataset.cases.first()?.name.clone();
            let rank = if checked.dataset.kind == DatasetKind::Trajectory { 0 } else { 1 };
            Some((rank, Subject::Case { dataset: source.path.clone(), case }))
        }
        Content::File(_) => Some((2, Subject::File(source.path.clone()))),
        Content::Loading(_) | Content::Failed(_) => None,
    };
    sources.filter_map(subject).min_by_key(|(rank, _)| *rank).map(|(_, subject)| subject)
}

fn analyse(material: &Material, project: &Project) -> Result<Analysis, String> {
    let own = match material {
        Material::Case(checked, _) => Some(checked.as_ref()),
        Material::File(..) | Material::Scenario => None,
    };
    let bullet = Preset::from_id(&project.bullet_preset).unwrap_or(Preset::Bullet2000);
    let settings = Settings {
        target: target_vehicle(project, own)?,
        bullet: bullet.parameters(),
        integrator: project.integrator,
        duration_s: project.duration_s,
    };
    let result = match material {
        Material::Case(checked, name) => {
            let Some(case) = checked.dataset.case(name) else {
                return Err(format!("there is no case {name:?}"));
            };
            analyse_case(case, &settings)
        }
        Material::File(file, path) => {
            let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
            analyse_file(&name, &file.loaded, &project.file_setup, &settings)
        }
        Material::Scenario => analyse_scenario(&project.scenario, &project.pulse, &settings),
    };
    result.map_err(|error| error_chain(&error))
}

/// The struck vehicle, as chosen. May read a file: for jobs only.
///
/// # Errors
/// A message, if its file cannot be read.
pub fn target_vehicle(
    project: &Project,
    own: Option<&CheckedDataset>,
) -> Result<VehicleParameters, String> {
    let vehicle = chosen_vehicle(&project.vehicle, own)?;
    Ok(match project.equations {
        Equations::Corrected => vehicle, // or as its file says
        Equations::Paper => vehicle.with_equations(Equations::Paper),
    })
}

fn chosen_vehicle(
    choice: &VehicleChoice,
    own: Option<&CheckedDataset>,
) -> Result<VehicleParameters, String> {
    match choice {
        VehicleChoice::Automatic => match own.and_then(|checked| checked.vehicle.clone()) {
            Some(vehicle) => vehicle,
            None => Ok(Preset::Target.parameters()),
        },
        VehicleChoice::Preset(id) => Preset::from_id(id)
            .map(Preset::parameters)
            .ok_or_else(|| format!("there is no vehicle {id:?}")),
        VehicleChoice::File(path) => {
            VehicleParameters::load(path).map_err(|error| error_chain(&error))
        }
    }
}
