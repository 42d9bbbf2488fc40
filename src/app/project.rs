//! What the user works on: the questions of the variant that is shown, which the panels edit in place.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::app::network::NetworkQuestions;
use crate::app::recording::OverlaidRecording;
use crate::app::state::Subject;
use impactlab_core::collision::{ChannelClass, Scenario};
use impactlab_core::site::PixelMap;
use impactlab_core::vehicle::Ending;
use impactlab_draw::scene::CameraKey;
use impactlab_study::analysis::PulseSetup;
use impactlab_study::case_file::Variant;
use impactlab_study::{
    Drive, ForceQuestion, ForceSource, HandRequest, ImpactRequest, ModelChoice, MotionSource,
    PredictForceRequest, PredictMotionRequest, ReconstructRequest, ReplayRequest, Request,
    ScenarioChoice, SeriesFile, SimulateRequest,
};

/// What the user works on. The questions are those that the case stores and the command line asks;
/// [`Project::keep_in_step`] carries what several of them have in common from the one that the panels edit
/// to the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Project {
    /// The impulse solution of the scenario in the scenario pane.
    pub impact: ImpactRequest,
    /// The simulation of what is selected, which is its source.
    pub simulate: SimulateRequest,
    /// The force of the collision in the force prediction pane.
    pub predict_force: PredictForceRequest,
    /// The forecast of the motion that is simulated.
    pub predict_motion: PredictMotionRequest,
    /// The reconstruction; `None` without evidence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reconstruct: Option<ReconstructRequest>,
    /// The calculation by hand; `None` if the variant asks for none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hand: Option<HandRequest>,
    /// The replay of a recorder; `None` if the variant asks for none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub replay: Option<ReplayRequest>,
    /// Questions of the variant for which there is no panel.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub others: Vec<Request>,
    /// What the window keeps of the variant beside its questions.
    pub beside: Beside,
    /// Trainings, evaluations and the comparison.
    pub networks: NetworkQuestions,
}

/// What the window keeps of a variant beside its questions: how it is drawn, and what was entered for
/// subjects that are not selected.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Beside {
    /// The filter of the force plot by its channel frequency class; `None` shows the force unfiltered.
    pub channel_class: Option<ChannelClass>,
    /// A recording that is drawn over the motion.
    pub recording: Option<OverlaidRecording>,
    /// Whether pulses of classic shapes with the same impulse are drawn over the force.
    pub show_pulses: bool,
    /// Angle of the steering wheel over that of the road wheels, where endings are given by the steering
    /// wheel.
    pub steering_ratio: Option<f64>,
    /// Where the orthophoto of the ground was put in the window, instead of where its file says.
    pub orthophoto: Option<PixelMap>,
    /// Start and controls of single files, while none is selected.
    pub start: Drive,
    /// The pulse of the scenario, while that is not selected.
    pub pulse: PulseSetup,
    /// What happens to the wheels after the impact, while something is selected that says it itself.
    pub ending: Option<Ending>,
    /// The road of the scenario, while that is not selected.
    #[serde(skip_serializing_if = "Road::is_open")]
    pub road: Road,
    /// The keys between which the camera moves in films of the scene.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub camera_keys: Vec<CameraKey>,
    /// The same of the reconstructed scene.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub reconstruction_camera_keys: Vec<CameraKey>,
}

/// What is said of the road.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Road {
    /// Peak friction; `None` for that of the vehicle.
    pub friction: Option<f64>,
    /// Its standard deviation; `None` where nobody says how well it is known.
    pub sigma: Option<f64>,
}

impl Road {
    fn is_open(&self) -> bool {
        *self == Self::default()
    }
}

impl Default for Project {
    fn default() -> Self {
        let scenario = ScenarioChoice::Inline(Box::new(Scenario::example()));
        let simulate = SimulateRequest::new(MotionSource::default());
        Self {
            impact: ImpactRequest::new(scenario.clone()),
            predict_force: PredictForceRequest::new(ForceQuestion::Scenario(scenario)),
            predict_motion: PredictMotionRequest::new(MotionSource::default(), ForceSource::Given),
            simulate,
            reconstruct: None,
            hand: None,
            replay: None,
            others: Vec::new(),
            beside: Beside::default(),
            networks: NetworkQuestions::default(),
        }
    }
}

impl Project {
    /// What is shown and simulated; `None` if nothing is selected.
    pub fn subject(&self) -> Option<Subject> {
        let file = |file: &SeriesFile| Subject::File(file.path.clone());
        match &self.simulate.source {
            MotionSource::Case { dataset, case } => {
                Some(Subject::Case { dataset: dataset.clone(), case: case.clone() })
            }
            MotionSource::Trajectory { file: of, .. } => Some(file(of)),
            MotionSource::Drive(drive) => match own_file(drive) {
                Some(of) => Some(file(of)),
                None if *drive == Drive::default() => None,
                None => Some(Subject::Manoeuvre),
            },
            MotionSource::Scenario { .. } => Some(Subject::Scenario),
        }
    }

    /// Puts away what was entered for what was selected, so that another source can take its place.
    ///
    /// - `takes_ending`: whether what was selected leaves open what happens to the wheels.
    pub(in crate::app) fn put_aside(&mut self, takes_ending: bool) {
        let Self { simulate, predict_motion, beside, .. } = self;
        if !matches!(simulate.source, MotionSource::Case { .. }) {
            predict_motion.force = ForceSource::Given;
        }
        let road =
            Road { friction: simulate.friction.take(), sigma: simulate.friction_sigma.take() };
        match std::mem::take(&mut simulate.source) {
            MotionSource::Drive(mut drive) if drive != Drive::default() => {
                let own = [&mut drive.force, &mut drive.steer, &mut drive.wheels];
                if let Some(own) = own.into_iter().find(|file| file.is_some()) {
                    *own = None;
                }
                beside.start = drive;
            }
            MotionSource::Scenario { pulse, .. } => {
                (beside.pulse, beside.road) = (pulse, road);
            }
            MotionSource::Case { .. }
            | MotionSource::Drive(_)
            | MotionSource::Trajectory { .. } => {}
        }
        let ending = simulate.ending.take();
        if takes_ending {
            beside.ending = ending;
        }
    }

    /// Selects another source, which has taken over what was put aside for its kind.
    ///
    /// - `takes_ending`: whether it leaves open what happens to the wheels.
    pub(in crate::app) fn take_up(&mut self, source: MotionSource, takes_ending: bool) {
        let Self { simulate, beside, .. } = self;
        match source {
            MotionSource::Drive(_) => beside.start = Drive::default(),
            MotionSource::Scenario { .. } => {
                beside.pulse = PulseSetup::default();
                // What else is selected is not on the road of the scenario.
                let Road { friction, sigma } = std::mem::take(&mut beside.road);
                (simulate.friction, simulate.friction_sigma) = (friction, sigma);
            }
            MotionSource::Case { .. } | MotionSource::Trajectory { .. } => {}
        }
        simulate.ending = if takes_ending { beside.ending.take() } else { None };
        simulate.source = source;
        self.take_usual_force();
    }

    /// Drives the forecast by the force that drives it where nobody says which, unless a force of the network
    /// that was asked for goes on to another case.
    fn take_usual_force(&mut self) {
        let is_case = matches!(self.simulate.source, MotionSource::Case { .. });
        if !is_case || !matches!(self.predict_motion.force, ForceSource::Predicted(_)) {
            self.predict_motion.force = ForceSource::usual(&self.simulate.source);
        }
        self.keep_in_step();
    }

    /// The scenario in the scenario pane; `None` if its file cannot be read.
    pub fn scenario(&self) -> Option<&Scenario> {
        self.impact.scenario.inline()
    }

    /// The same, to be edited.
    pub fn scenario_mut(&mut self) -> Option<&mut Scenario> {
        self.impact.scenario.inline_mut()
    }

    /// The pulse over which the impulse of the scenario is spread.
    pub fn pulse_mut(&mut self) -> &mut PulseSetup {
        match &mut self.simulate.source {
            MotionSource::Scenario { pulse, .. } => pulse,
            _ => &mut self.beside.pulse,
        }
    }

    /// The road of the scenario: its friction and the standard deviation of that.
    pub fn road_mut(&mut self) -> [&mut Option<f64>; 2] {
        match &self.simulate.source {
            MotionSource::Scenario { .. } => {
                [&mut self.simulate.friction, &mut self.simulate.friction_sigma]
            }
            _ => [&mut self.beside.road.friction, &mut self.beside.road.sigma],
        }
    }

    /// Puts another ground below the scene.
    ///
    /// - `file`: the site file, or an orthophoto alone; `None` takes the ground away.
    pub(in crate::app) fn put_on_site(&mut self, file: Option<PathBuf>) {
        self.simulate.site = file;
        self.beside.orthophoto = None;
    }

    /// Start and controls of single files.
    pub fn start(&self) -> &Drive {
        match &self.simulate.source {
            MotionSource::Drive(drive) if *drive != Drive::default() => drive,
            _ => &self.beside.start,
        }
    }

    /// The same, to be edited.
    pub fn start_mut(&mut self) -> &mut Drive {
        match &mut self.simulate.source {
            MotionSource::Drive(drive) if *drive != Drive::default() => drive,
            _ => &mut self.beside.start,
        }
    }

    /// Carries what several questions have in common to all of them: the scenario is edited in the
    /// question for its impulse, the motion in the simulation, the force network in the question for the
    /// force, and the contact point of a recorded motion beside them.
    pub fn keep_in_step(&mut self) {
        let Self { impact, simulate, predict_force, predict_motion, beside, .. } = self;
        match &mut simulate.source {
            MotionSource::Scenario { scenario, .. } => scenario.clone_from(&impact.scenario),
            MotionSource::Trajectory { contact, .. } => *contact = beside.start.contact,
            MotionSource::Case { .. } | MotionSource::Drive(_) => {}
        }
        if let ForceQuestion::Scenario(scenario) = &mut predict_force.collision {
            scenario.clone_from(&impact.scenario);
        }
        if let ForceSource::Predicted(model) = &mut predict_motion.force {
            model.clone_from(&predict_force.model);
        }
        let SimulateRequest { vehicle_draws, seed, .. } = predict_motion.motion;
        predict_motion.motion = SimulateRequest { vehicle_draws, seed, ..simulate.clone() };
    }

    /// The variant with its questions, as the case stores it. Those about the scenario are asked while it
    /// is selected.
    pub fn to_variant(&self, name: &str) -> Variant {
        let start = Self::default();
        let subject = self.subject();
        let is_scenario = subject == Some(Subject::Scenario);
        let [impact, impact_at_start] = [self, &start].map(|of| of.impact.clone().into());
        let [simulate, simulate_at_start] = [self, &start].map(|of| of.simulate.clone().into());
        let [force, force_at_start] = [self, &start].map(|of| of.predict_force.clone().into());
        let [motion, motion_at_start] = [self, &start].map(|of| of.predict_motion.clone().into());
        let filled_in: [(Request, Request, bool); 4] = [
            (impact, impact_at_start, is_scenario),
            (simulate, simulate_at_start, subject.is_some()),
            (force, force_at_start, is_scenario),
            (motion, motion_at_start, subject.is_some()),
        ];
        let mut variant = Variant { name: name.to_owned(), ..Variant::default() };
        for (request, at_start, is_question) in filled_in {
            if is_question {
                variant.questions.push(request);
            } else if request != at_start {
                variant.unasked.push(request);
            }
        }
        variant.questions.extend(self.reconstruct.clone().map(Request::from));
        variant.questions.extend(self.hand.clone().map(Request::from));
        variant.questions.extend(self.replay.clone().map(Request::from));
        variant.questions.extend(self.others.iter().cloned());
        if self.beside != start.beside {
            variant.view = serde_json::to_value(&self.beside).unwrap_or_default();
        }
        variant
    }

    /// The project with another variant. The questions about networks are of none.
    ///
    /// # Errors
    /// What is wrong with what the window keeps beside the questions.
    pub fn with_variant(&self, variant: &Variant) -> Result<Self, serde_json::Error> {
        let mut project = Self { networks: self.networks.clone(), ..Self::default() };
        if !variant.view.is_null() {
            project.beside = Beside::deserialize(&variant.view)?;
        }
        let mut found = FoundQuestions::default();
        for request in variant.questions.iter().cloned() {
            project.others.extend(found.take(request));
        }
        for request in variant.unasked.iter().cloned() {
            // A question of this kind is asked, too, and is the one that is edited.
            drop(found.take(request));
        }
        found.fill_in(&mut project);
        Ok(project)
    }

    /// Asks the shipped networks instead of those that were in the memory of an earlier run alone.
    ///
    /// - returns the names of those that are not asked any more.
    pub(in crate::app) fn forget_held_models(&mut self) -> Vec<String> {
        let mut forgotten = Vec::new();
        for model in [&mut self.predict_force.model, &mut self.predict_motion.response_model] {
            if let ModelChoice::Held { held } = model {
                forgotten.push(std::mem::take(held));
                *model = ModelChoice::default();
            }
        }
        self.keep_in_step();
        forgotten
    }

    /// The files and data sets that the questions and the plots need.
    pub fn sources(&self) -> Vec<SeriesFile> {
        let mut files = match &self.simulate.source {
            MotionSource::Case { dataset, .. } => vec![SeriesFile::new(dataset)],
            MotionSource::Trajectory { file, .. } => vec![file.clone()],
            MotionSource::Drive(Drive { force, steer, wheels, .. }) => {
                [force, steer, wheels].into_iter().flatten().cloned().collect()
            }
            MotionSource::Scenario { .. } => Vec::new(),
        };
        if let ForceQuestion::Case { dataset, .. } = &self.predict_force.collision {
            files.push(SeriesFile::new(dataset));
        }
        files.extend(self.beside.recording.as_ref().map(|recording| recording.file.clone()));
        files.dedup();
        files
    }
}

/// The file that a start with files is about.
fn own_file(drive: &Drive) -> Option<&SeriesFile> {
    drive.force.as_ref().or(drive.steer.as_ref()).or(drive.wheels.as_ref())
}

/// The first question of each kind that panels edit.
#[derive(Default)]
struct FoundQuestions {
    impact: Option<ImpactRequest>,
    simulate: Option<SimulateRequest>,
    predict_force: Option<PredictForceRequest>,
    predict_motion: Option<PredictMotionRequest>,
    reconstruct: Option<ReconstructRequest>,
    hand: Option<HandRequest>,
    replay: Option<ReplayRequest>,
}

impl FoundQuestions {
    /// Takes a question if it is the first of its kind, and gives back any other.
    fn take(&mut self, request: Request) -> Option<Request> {
        match request {
            Request::Impact(of) if self.impact.is_none() => self.impact = Some(*of),
            Request::Simulate(of) if self.simulate.is_none() => self.simulate = Some(*of),
            Request::PredictForce(of) if self.predict_force.is_none() => {
                self.predict_force = Some(*of);
            }
            Request::PredictMotion(of) if self.predict_motion.is_none() => {
                self.predict_motion = Some(*of);
            }
            Request::Reconstruct(of) if self.reconstruct.is_none() => self.reconstruct = Some(*of),
            Request::Hand(of) if self.hand.is_none() => self.hand = Some(*of),
            Request::Replay(of) if self.replay.is_none() => self.replay = Some(*of),
            other => return Some(other),
        }
        None
    }

    /// Puts the questions into a project. One that is not there is like the others where it has something
    /// in common with them.
    fn fill_in(self, project: &mut Project) {
        let Self { impact, simulate, predict_force, predict_motion, reconstruct, hand, replay } =
            self;
        let of_motion = || {
            let motion = predict_motion.as_ref()?.motion.clone();
            Some(SimulateRequest { vehicle_draws: None, ..motion })
        };
        if let Some(simulate) = simulate.or_else(of_motion) {
            project.simulate = simulate;
        }
        let of_others = || match (&project.simulate.source, predict_force.as_ref()?) {
            (MotionSource::Scenario { scenario, .. }, _) => Some(scenario.clone()),
            (_, PredictForceRequest { collision: ForceQuestion::Scenario(scenario), .. }) => {
                Some(scenario.clone())
            }
            _ => None,
        };
        if let Some(impact) = impact {
            project.impact = impact;
        } else if let Some(scenario) = of_others() {
            project.impact.scenario = scenario;
        }
        // A scenario is edited as it stands in its file.
        if let Ok(scenario) = project.impact.scenario.load() {
            project.impact.scenario = ScenarioChoice::Inline(Box::new(scenario));
        }
        if let Some(motion) = predict_motion {
            if let ForceSource::Predicted(model) = &motion.force {
                project.predict_force.model = model.clone();
            }
            project.predict_motion = motion;
        } else {
            project.take_usual_force();
        }
        if let Some(force) = predict_force {
            project.predict_force = force;
        }
        if let MotionSource::Trajectory { contact, .. } = &project.simulate.source {
            project.beside.start.contact = *contact;
        }
        project.reconstruct = reconstruct;
        project.hand = hand;
        project.replay = replay;
        project.keep_in_step();
    }
}
