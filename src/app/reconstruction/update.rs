//! Commands and background work of the reconstruction.

use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;

use egui::Context;

use crate::app::command::wake;
use crate::app::panes::Pane;
use crate::app::project::Project;
use crate::app::reconstruction::live::watch;
use crate::app::reconstruction::preview::EvidencePreview;
use crate::app::reconstruction::{
    FollowedParticle, ReadEvidence, ReconstructionCommand, ReconstructionQuestion,
    ReconstructionSession,
};
use crate::app::state::State;
use impactlab_core::data::{Severity, TomlFile};
use impactlab_core::error_chain;
use impactlab_reconstruct::evidence::{Evidence, FoundPlace};
use impactlab_study::{EvidenceChoice, ReconstructRequest};

/// The evidence of the shipped example.
const EXAMPLE: &str = include_str!("../../../assets/examples/reconstruction.toml");

impl State {
    /// The evidence of the project; `None` if there is none or its file cannot be read.
    pub fn evidence(&self) -> Option<&Evidence> {
        match &self.project.reconstruct.as_ref()?.evidence {
            EvidenceChoice::Inline(evidence) => Some(evidence),
            EvidenceChoice::File(path) => {
                let file = self.session.reconstruction.file.as_ref()?;
                file.evidence.as_ref().ok().filter(|_| file.path == *path)
            }
        }
    }

    /// Receives particles and answer of the run, and reads the evidence that the project names. Evidence
    /// files are small, so that they are read on the window's thread.
    ///
    /// Evidence whose run is kept is answered without being asked.
    pub(in crate::app) fn update_reconstruction(&mut self, context: &Context) {
        self.stand_on_ground();
        let session = &mut self.session.reconstruction;
        while let Some(particles) = session.news.as_ref().and_then(|news| news.try_recv().ok()) {
            session.live = Some(particles);
        }
        if session.run.poll() {
            (session.mode, session.followed) = (None, FollowedParticle::default());
            session.n_answers += 1;
            self.session.fit_plots = true;
        }
        let session = &mut self.session.reconstruction;
        if !session.run.is_running() {
            (session.live, session.news) = (None, None);
        }
        let request = self.project.reconstruct.as_ref();
        if let Some(EvidenceChoice::File(path)) = request.map(|request| &request.evidence)
            && session.file.as_ref().is_none_or(|file| file.path != *path)
        {
            let evidence = Evidence::load(path).map_err(|error| error_chain(&error));
            session.file = Some(ReadEvidence { path: path.clone(), evidence });
        }
        let evidence = self.project.reconstruct.as_ref().zip(self.evidence());
        let known = self.session.reconstruction.preview.as_ref();
        let is_known = match evidence {
            Some((request, evidence)) => {
                known.is_some_and(|of| of.is_of(request) && of.evidence == *evidence)
            }
            None => known.is_none(),
        };
        if !is_known {
            let preview =
                evidence.map(|(request, evidence)| EvidencePreview::new(evidence, request));
            let places = preview.as_ref().map_or_else(Vec::new, |of| of.evidence.places());
            let n_marks = |section| {
                let is_mark = |place: &&FoundPlace| place.is_line && place.section.key == section;
                places.iter().filter(is_mark).count()
            };
            let session = &mut self.session.reconstruction;
            session.preview = preview;
            session.adds_to = session.adds_to.filter(|mark| mark.idx < n_marks(mark.section));
            let is_first = !session.run.is_running() && session.run.latest.is_none();
            let request = self.project.reconstruct.as_ref();
            let runs = session.stored_runs.as_ref().filter(|_| is_first);
            if request.is_some_and(|request| runs.is_some_and(|runs| runs.holds(request))) {
                self.run_reconstruction(context);
            }
        }
    }

    /// Lets the wheels of the reconstruction stand on the friction zones of the ground that is shown. A
    /// ground without zones changes no answer.
    fn stand_on_ground(&mut self) {
        let Project { simulate, reconstruct: Some(request), .. } = &mut self.project else {
            return;
        };
        let site = match (&simulate.site, self.session.ground.shown()) {
            // The same file may be read again; the zones of another one are no longer those of the scene.
            (Some(file), None) => request.site.clone().filter(|site| site == file),
            (Some(file), Some(ground)) => {
                let has_zones = !ground.site.friction_zones.is_empty();
                has_zones.then(|| file.clone())
            }
            (None, _) => None,
        };
        if request.site != site {
            request.site = site;
        }
    }

    /// Opens an evidence file, or says what is wrong with it.
    pub(in crate::app) fn open_evidence(&mut self, path: PathBuf, evidence: Evidence) {
        self.session.reconstruction.file =
            Some(ReadEvidence { path: path.clone(), evidence: Ok(evidence) });
        self.take_evidence(EvidenceChoice::File(path));
    }

    /// Puts other evidence into the form, and shows it. An answer about the last one is not about it.
    pub(in crate::app) fn take_evidence(&mut self, evidence: EvidenceChoice) {
        match &mut self.project.reconstruct {
            Some(request) => request.evidence = evidence,
            none => *none = Some(ReconstructRequest::new(evidence)),
        }
        self.drop_reconstruction();
        self.session.shows_doors = false;
        self.session.fit_plots = true;
        self.view.workspaces.show_pane(Pane::Evidence);
    }

    /// Drops the run and the answer, which are about other evidence.
    pub(in crate::app) fn drop_reconstruction(&mut self) {
        let session = &mut self.session.reconstruction;
        *session = ReconstructionSession {
            file: session.file.take(),
            stored_runs: session.stored_runs.take(),
            cars: std::mem::take(&mut session.cars).emptied(),
            ..ReconstructionSession::default()
        };
    }

    /// Carries out an action on the reconstruction.
    pub(in crate::app) fn reconstruct(
        &mut self,
        command: ReconstructionCommand,
        context: &Context,
    ) {
        match command {
            ReconstructionCommand::New => {
                self.take_evidence(EvidenceChoice::Inline(Box::new(Evidence::empty())));
            }
            ReconstructionCommand::NewSingleCar => {
                let evidence = Box::new(Evidence::empty_single_car());
                self.take_evidence(EvidenceChoice::Inline(evidence));
            }
            ReconstructionCommand::Example => {
                let path = Path::new("example");
                match Evidence::from_toml(TomlFile { path, text: EXAMPLE }) {
                    Ok(evidence) => self.take_evidence(EvidenceChoice::Inline(Box::new(evidence))),
                    Err(error) => self.say(Severity::Error, error_chain(&error)),
                }
            }
            ReconstructionCommand::Run => self.run_reconstruction(context),
            ReconstructionCommand::Cancel => self.session.reconstruction.run.cancel(),
            ReconstructionCommand::ShowMode(mode) => {
                let session = &mut self.session.reconstruction;
                (session.mode, session.followed) = (mode, FollowedParticle::default());
            }
            ReconstructionCommand::Play(followed) => {
                self.session.reconstruction.followed = followed;
                (self.session.playback.time_s, self.session.playback.is_playing) = (0.0, true);
            }
            ReconstructionCommand::AddPoints(mark) => self.session.reconstruction.adds_to = mark,
        }
    }

    fn run_reconstruction(&mut self, context: &Context) {
        let refused = self.evidence().map(Evidence::missing);
        let request = self.project.reconstruct.clone();
        let request = match (request, refused) {
            (Some(request), Some(None)) => request,
            (_, Some(Some(why))) => return self.say(Severity::Warning, why),
            _ => return self.say(Severity::Warning, "there is no evidence to reconstruct from"),
        };
        let (sender, news) = channel();
        let session = &mut self.session.reconstruction;
        (session.live, session.news) = (None, Some(news));
        let question = ReconstructionQuestion { request, stored_runs: session.stored_runs.clone() };
        let (library, watch) = (&self.session.library, watch(sender));
        if let Err(error) = session.run.start_watched(question, library, wake(context), watch) {
            self.say(Severity::Error, error.to_string());
        }
    }
}
