//! Cases of version 1 had the forms of the window beside the questions. What no question says is taken
//! from them.

use std::path::PathBuf;

use serde::Deserialize;
use serde_json::Value;

use crate::app::project::Beside;
use crate::app::recording::OverlaidRecording;
use impactlab_core::collision::{ChannelClass, Scenario};
use impactlab_core::site::PixelMap;
use impactlab_core::vehicle::{ContactPoint, Ending};
use impactlab_networks::force::ForceScenario;
use impactlab_study::analysis::PulseSetup;
use impactlab_study::case_file::Variant;
use impactlab_study::{
    DEFAULT_DRAWS, Drive, ForceQuestion, ForceSource, ImpactRequest, ModelChoice, MotionSource,
    PredictForceRequest, PredictMotionRequest, Request, ScenarioChoice, SeriesFile,
    SimulateRequest,
};

/// The forms of a variant.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Forms {
    project: FormsProject,
    sources: Vec<SeriesFile>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct FormsProject {
    subject: Option<FormsSubject>,
    scenario: Option<Box<Scenario>>,
    pulse: PulseSetup,
    file_start: FormsStart,
    ending: Option<Ending>,
    steering_ratio: Option<f64>,
    channel_class: Option<ChannelClass>,
    recording: Option<FormsRecording>,
    show_pulses: bool,
    site: Option<FormsSite>,
    force: FormsForce,
    response: FormsResponse,
}

#[derive(Deserialize)]
enum FormsSubject {
    Case { dataset: PathBuf, case: String },
    File(PathBuf),
    Scenario,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct FormsStart {
    speed_m_s: Option<f64>,
    contact: Option<ContactPoint>,
    steer: Option<PathBuf>,
    steering_ratio: Option<f64>,
    wheels: Option<PathBuf>,
}

#[derive(Deserialize)]
struct FormsRecording {
    path: PathBuf,
    offset_s: f64,
}

#[derive(Deserialize)]
struct FormsSite {
    file: PathBuf,
    #[serde(default)]
    map: Option<PixelMap>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct FormsForce {
    name: String,
    scenario: Option<Box<ForceScenario>>,
    model: Option<PathBuf>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct FormsResponse {
    model: Option<PathBuf>,
    forecast: FormsForecast,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct FormsForecast {
    force: FormsForceChoice,
    n_curves: Option<usize>,
    seed: u64,
}

#[derive(Default, Deserialize, PartialEq)]
enum FormsForceChoice {
    #[default]
    Given,
    Predicted,
}

/// Takes from the forms of a variant of version 1 what its questions do not say: how it is drawn, and what
/// was entered for subjects that are not selected. The settings of trainings are of no variant and are
/// left. A variant without forms stays as it is, and so does one with forms that cannot be read.
///
/// # Errors
/// What is wrong with the forms.
pub(super) fn take_forms(variant: &mut Variant) -> Result<(), serde_json::Error> {
    let forms = variant.forms.clone();
    if forms.is_null() {
        return Ok(());
    }
    let Forms { project: shown, sources } = Forms::deserialize(&forms)?;
    let series = |path: &PathBuf| {
        let open = sources.iter().find(|file| file.path == *path);
        open.cloned().unwrap_or_else(|| SeriesFile::new(path))
    };
    let FormsStart { speed_m_s, contact, steer, steering_ratio, wheels } = &shown.file_start;
    let start = Drive {
        speed_m_s: *speed_m_s,
        contact: *contact,
        steer: steer.as_ref().map(series),
        steering_ratio: *steering_ratio,
        wheels: wheels.as_ref().map(series),
        ..Drive::default()
    };
    let mut kinds = QuestionKinds::default();
    variant.questions.iter().for_each(|request| kinds.add(request));
    if !kinds.has_motion
        && let Some(subject) = &shown.subject
    {
        let source = source_of(subject, &shown, &start, &series);
        let simulate = simulation(&forms, source, &shown)?;
        variant.questions.push(forecast(&simulate, &shown).into());
        variant.questions.push(simulate.into());
    }
    if let Some(scenario) = shown.scenario.clone().filter(|_| !kinds.has_scenario) {
        let scenario = ScenarioChoice::Inline(scenario);
        variant.unasked.push(ImpactRequest::new(scenario).into());
    }
    variant.unasked.extend(force_question(&shown).filter(|_| !kinds.has_force).map(Request::from));
    let beside = Beside {
        channel_class: shown.channel_class,
        recording: shown.recording.map(|FormsRecording { path, offset_s }| OverlaidRecording {
            file: series(&path),
            offset_s,
        }),
        show_pulses: shown.show_pulses,
        steering_ratio: shown.steering_ratio,
        orthophoto: shown.site.and_then(|site| site.map),
        start,
        pulse: shown.pulse,
        ending: shown.ending,
        ..Beside::default()
    };
    variant.view = serde_json::to_value(beside)?;
    variant.forms = Value::Null;
    Ok(())
}

/// What the questions of a variant are about.
#[derive(Default)]
struct QuestionKinds {
    has_motion: bool,
    has_scenario: bool,
    has_force: bool,
}

impl QuestionKinds {
    fn add(&mut self, request: &Request) {
        match request {
            Request::Impact(_) => self.has_scenario = true,
            Request::Simulate(_) | Request::PredictMotion(_) => self.has_motion = true,
            Request::PredictForce(_) => self.has_force = true,
            _ => {}
        }
    }
}

fn source_of(
    subject: &FormsSubject,
    shown: &FormsProject,
    start: &Drive,
    series: &impl Fn(&PathBuf) -> SeriesFile,
) -> MotionSource {
    match subject {
        FormsSubject::Case { dataset, case } => {
            MotionSource::Case { dataset: dataset.clone(), case: case.clone() }
        }
        // What the file is about is found when it is read.
        FormsSubject::File(path) => {
            MotionSource::Drive(Drive { force: Some(series(path)), ..start.clone() })
        }
        FormsSubject::Scenario => {
            let scenario = shown.scenario.clone().unwrap_or_else(|| Box::new(Scenario::example()));
            MotionSource::Scenario {
                scenario: ScenarioChoice::Inline(scenario),
                pulse: shown.pulse,
            }
        }
    }
}

/// What the forms and the question about a motion say under the same names.
const OF_MOTION: [&str; 11] = [
    "vehicle",
    "bullet",
    "equations",
    "integrator",
    "friction",
    "friction_sigma",
    "duration_s",
    "ending",
    "until_rest",
    "vehicle_draws",
    "seed",
];

/// The simulation of the forms, whose settings had the names of those of the question.
fn simulation(
    forms: &Value,
    source: MotionSource,
    shown: &FormsProject,
) -> Result<SimulateRequest, serde_json::Error> {
    let is_open = matches!(source, MotionSource::Drive(_));
    let mut settings = forms["project"].clone();
    if let Some(fields) = settings.as_object_mut() {
        fields.retain(|key, _| OF_MOTION.contains(&key.as_str()));
        fields.insert("source".to_owned(), serde_json::to_value(source)?);
    }
    let simulate: SimulateRequest = serde_json::from_value(settings)?;
    Ok(SimulateRequest {
        site: shown.site.as_ref().map(|site| site.file.clone()),
        ending: simulate.ending.clone().filter(|_| is_open),
        ..simulate
    })
}

fn forecast(simulate: &SimulateRequest, shown: &FormsProject) -> PredictMotionRequest {
    let FormsResponse { model, forecast, .. } = &shown.response;
    let force = match forecast.force {
        FormsForceChoice::Given => ForceSource::Given,
        FormsForceChoice::Predicted => ForceSource::Predicted(model_of(&shown.force.model)),
    };
    PredictMotionRequest {
        motion: SimulateRequest { vehicle_draws: None, ..simulate.clone() },
        response_model: model_of(model),
        draws: forecast.n_curves.unwrap_or(DEFAULT_DRAWS),
        seed: forecast.seed,
        ..PredictMotionRequest::new(simulate.source.clone(), force)
    }
}

/// The question for the force of the form, which is that of the scenario where its numbers are.
fn force_question(shown: &FormsProject) -> Option<PredictForceRequest> {
    let FormsForce { name, scenario: numbers, model, .. } = &shown.force;
    let numbers = numbers.clone()?;
    let scenario = shown.scenario.clone().filter(|scenario| {
        let is_of = |of_scenario: ForceScenario| of_scenario == *numbers;
        scenario.name == *name && ForceScenario::from_scenario(scenario).is_ok_and(is_of)
    });
    let collision = match scenario {
        Some(scenario) => ForceQuestion::Scenario(ScenarioChoice::Inline(scenario)),
        None => ForceQuestion::Numbers { name: name.clone(), numbers },
    };
    let model = model_of(model);
    Some(PredictForceRequest { model, ..PredictForceRequest::new(collision) })
}

fn model_of(file: &Option<PathBuf>) -> ModelChoice {
    file.as_ref().map_or_else(ModelChoice::default, ModelChoice::file)
}
