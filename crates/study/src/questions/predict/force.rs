//! The distribution of an impact force history: `predict force`.

use crate::caveats::assumed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::{ForceForecast, ForecastSettings, Mode};
use crate::ask::checks::{check_all, check_count};
use crate::caveats::unused::{by_force_network, contact_by_force_network};
use crate::caveats::{bodies, restrictions};
use crate::questions::simulate::dataset::take_case;
use crate::{
    Answer, ImpliedContactReport, Library, ModelChoice, Observer, Provenance, Question,
    ScenarioChoice, StudyError,
};
use impactlab_core::collision::{Impact, PrincipalDirectionOfForce, ScenarioContact};
use impactlab_core::data::{DatasetKind, Outcome};
use impactlab_core::ranges::SAMPLES;
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Estimate, Phrase, PhraseValue};
use impactlab_networks::force::{
    ForceCase, ForceError, ForcePrediction, ForceScenario, OutsideTraining,
};

/// Asks which force a collision brings about, and how sure that is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PredictForceRequest {
    /// The collision.
    pub collision: ForceQuestion,
    /// The force network.
    #[serde(default)]
    pub model: ModelChoice,
    /// Kind of body of the striking vehicle as the training data name it, where the collision
    /// leaves it open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// Kind of body of the struck vehicle as the training data name it, where the collision leaves
    /// it open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub struck_body: Option<String>,
    /// Whether the contact point is left open: it is drawn from that of the training cases.
    #[serde(default)]
    pub open_contact: bool,
    /// Whole curves to give back.
    #[serde(default)]
    pub samples: usize,
    /// Seed of all draws.
    #[serde(default)]
    pub seed: u64,
}

/// The collision whose force is asked about.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ForceQuestion {
    /// A scenario of two vehicles.
    Scenario(ScenarioChoice),
    /// A case of a force data set, by what was known before it.
    Case {
        /// The data set.
        dataset: std::path::PathBuf,
        /// Name of the case.
        case: String,
    },
    /// The numbers that a force network knows, and what they are called.
    Numbers {
        /// For titles.
        name: String,
        /// Masses, velocities, angle, contact point, body.
        numbers: Box<ForceScenario>,
    },
}

/// The predicted force of a collision, SI units, axes along the heading of the struck vehicle.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PredictForceReport {
    /// What the collision is called.
    pub scenario: String,
    /// The force network.
    pub model: String,
    /// Impulse on the struck vehicle, N s.
    pub impulse_n_s: ImpulseReport,
    /// Largest size of the force, N.
    pub peak_n: Estimate,
    /// When it is reached, s.
    pub peak_time_s: Estimate,
    /// From first touch to last separation, s.
    pub duration_s: Estimate,
    /// Principal direction of force, degrees clockwise from straight ahead: the median.
    pub pdof_deg: f64,
    /// The same as an hour of the clock.
    pub pdof_clock: u8,
    /// The same with its intervals, degrees.
    pub pdof_interval_deg: Estimate,
    /// Impulse of the momentum solution [x, y], N s: with the restitution and the friction of the
    /// collision; where its contact is open, with those that are fitted to the training cases.
    pub momentum_impulse_n_s: [f64; 2],
    /// Restitution and impulse ratio with which a momentum solution would give the impulse, beside
    /// the one with the values of the collision; none where the contact is open.
    pub implied_contact: Option<ImpliedContactReport>,
    /// Probability that the striking vehicle's corner stays caught; none for a single component.
    pub hooking_probability: Option<f64>,
    /// The components of the mixture, the likeliest first.
    pub modes: Vec<Mode>,
    /// How far the force network applies to the collision, 0 to 1. The rest of the distribution is
    /// that of the physics alone.
    pub applicability: f64,
    /// Where the collision lies outside what was learned from.
    pub outside_training: Vec<OutsideTraining>,
    /// Whether the contact point is open and drawn from that of the training cases.
    pub is_contact_open: bool,
    /// Whether the striking vehicle's body is open and drawn from that of the training cases.
    pub is_body_open: bool,
    /// Whether the struck vehicle's body is open and drawn from that of the training cases.
    pub is_struck_body_open: bool,
}

/// An impulse with its intervals, N s.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ImpulseReport {
    /// Mean [x, y].
    pub mean: [f64; 2],
    /// Component along the heading of the struck vehicle.
    pub x: Estimate,
    /// Component to its left.
    pub y: Estimate,
    /// Size.
    pub magnitude: Estimate,
}

/// A predicted force.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictForceAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<PredictForceReport>,
    /// The collision as the network was asked.
    pub collision: ForceScenario,
    /// Bands, mean and whole curves.
    pub forecast: ForceForecast,
    /// What the network says.
    pub prediction: ForcePrediction,
}

/// A collision as a force network is asked about it.
struct CollisionInput {
    name: String,
    numbers: ForceScenario,
    /// Its planar impact in world axes and the heading of the struck vehicle, where the contact is
    /// known.
    impact: Option<(Impact, f64)>,
    /// What a scenario says of the contact.
    contact: Option<ScenarioContact>,
    /// Restitution and friction that it leaves open.
    default: Option<Caveat>,
    /// What the network does not use of what the question says.
    unused: Vec<Caveat>,
    /// That its outlines overlap.
    overlap: Option<Caveat>,
    /// The case of a data set, by which a network knows whether it has learned from it.
    case: Option<ForceCase>,
}

impl PredictForceRequest {
    /// The force of a collision about which nothing else is said.
    pub fn new(collision: ForceQuestion) -> Self {
        Self {
            collision,
            model: ModelChoice::default(),
            body: None,
            struck_body: None,
            open_contact: false,
            samples: 0,
            seed: 0,
        }
    }
}

impl ForceQuestion {
    /// What the network is asked, and what the collision is called.
    fn numbers(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<CollisionInput>, StudyError> {
        let (mut unused, mut overlap) = (Vec::new(), None);
        let (mut contact, mut default, mut known) = (None, None, None);
        let across = |numbers: &ForceScenario| Some((numbers.likely_impact()?, 0.0));
        let (name, numbers, impact) = match self {
            Self::Scenario(choice) => {
                choice.refuse_fixed()?;
                let scenario = choice.load()?;
                unused = by_force_network(choice, &scenario)?;
                contact = Some(scenario.contact);
                let geometry = scenario.geometry().ok();
                unused.extend(bodies::doubtful(&scenario));
                unused.extend(geometry.as_ref().and_then(assumed::first_touch));
                overlap = geometry.as_ref().and_then(restrictions::overlap_caveat);
                let numbers = ForceScenario::from_scenario(&scenario);
                let numbers = numbers.map_err(|source| choice.unsolved(source))?;
                let impact = scenario.impact().map_err(|source| choice.unsolved(source))?;
                default = assumed::contact_default(&scenario, &impact);
                (scenario.name, numbers, Some((impact, scenario.struck.heading_rad)))
            }
            Self::Case { dataset: root, case } => {
                let Outcome::Complete(dataset) = library.dataset(root, observer)? else {
                    return Ok(Outcome::Cancelled);
                };
                if dataset.kind != DatasetKind::Force {
                    return Err(StudyError::NoCollision { name: case.clone() });
                }
                let taken = take_case(&dataset, case)?;
                let numbers = ForceScenario::from_case(taken)?;
                // What cannot be learned from is none that was.
                known = ForceCase::from_case(taken).ok();
                let impact = across(&numbers);
                (case.clone(), numbers, impact)
            }
            Self::Numbers { name, numbers } => {
                (name.clone(), numbers.as_ref().clone(), across(numbers))
            }
        };
        Ok(Outcome::Complete(CollisionInput {
            name,
            numbers,
            impact,
            contact,
            default,
            unused,
            overlap,
            case: known,
        }))
    }
}

/// That a body is not used, since the network knows one kind only.
fn one_kind(what: Phrase, body: &str) -> Caveat {
    let reason = Phrase::new(
        "the cases that the force network has learned from have one kind",
        "die Fälle, an denen das Kraftnetz gelernt hat, haben nur eine Art",
    );
    Caveat::not_used(what.with(PhraseValue::Name(body.to_owned())), reason)
}

impl Question for PredictForceRequest {
    type Answer = PredictForceAnswer;
    type Report = Answer<PredictForceReport>;
    const NAME: &'static str = "predict force";

    fn check(&self) -> Result<(), StudyError> {
        check_count("samples", &SAMPLES, self.samples)?;
        match &self.collision {
            ForceQuestion::Scenario(scenario) => scenario.check(),
            ForceQuestion::Case { .. } => Ok(()),
            ForceQuestion::Numbers { numbers, .. } => check_all(numbers.ranges()),
        }
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<PredictForceAnswer>, StudyError> {
        let model = library.force_model(&self.model)?;
        let numbers = self.collision.numbers(library, observer)?;
        let Outcome::Complete(collision) = numbers else {
            return Ok(Outcome::Cancelled);
        };
        let learned = collision.case.as_ref().filter(|case| model.is_trained_on(case));
        let learned = learned.map(|_| restrictions::learned_case_caveat(CaveatKind::TrainedOn));
        let CollisionInput {
            name, numbers, mut impact, contact, default, mut unused, overlap, ..
        } = collision;
        let mut collision = numbers;
        if let Some(body) = &self.body {
            collision.striking_body = Some(body.clone());
            let what = Phrase::new(
                "body of the striking vehicle, {0}",
                "Aufbau des stoßenden Fahrzeugs, {0}",
            );
            unused.extend((model.bodies().len() == 1).then(|| one_kind(what, body)));
        }
        if let Some(body) = &self.struck_body {
            collision.struck_body = Some(body.clone());
            let what = Phrase::new(
                "body of the struck vehicle, {0}",
                "Aufbau des gestoßenen Fahrzeugs, {0}",
            );
            unused.extend(model.struck_bodies().is_empty().then(|| one_kind(what, body)));
        }
        if self.open_contact {
            (collision.contact_m, collision.normal_rad) = (None, None);
            (collision.striking_position_m, impact) = (None, None);
        }
        let prediction = model.predict(&collision)?;
        let share = prediction.applicability;
        unused.extend(contact.iter().flat_map(|contact| contact_by_force_network(contact, share)));
        unused.extend(default.filter(|_| share < 1.0));
        let settings = ForecastSettings { n_curves: self.samples, seed: self.seed };
        let forecast =
            ForceForecast::new(&prediction.mixture, settings).map_err(ForceError::from)?;
        let provenance = Provenance::from_seed(self.seed)
            .with_models([library.force_model_digest(&self.model)?]);
        let mut report = PredictForceReport::new(name, &self.model, &prediction, &forecast);
        report.implied_contact = impact.and_then(|(impact, heading_rad)| {
            ImpliedContactReport::from_prediction(&prediction, &impact, heading_rad, self.seed)
        });
        if let Some(implied) = &report.implied_contact {
            report.momentum_impulse_n_s = implied.momentum.impulse_n_s;
        }
        let restrictions = restrictions::predicted_force_caveats(&report, &prediction.caveats);
        let caveats =
            restrictions.into_iter().chain(learned).chain(unused).chain(overlap).collect();
        let report = Answer { report, caveats, provenance };
        Ok(Outcome::Complete(PredictForceAnswer { report, collision, forecast, prediction }))
    }
}

impl PredictForceReport {
    fn new(
        scenario: String,
        model: &ModelChoice,
        prediction: &ForcePrediction,
        forecast: &ForceForecast,
    ) -> Self {
        let pdof = PrincipalDirectionOfForce::from_angle(forecast.pdof_rad.median);
        let [x, y] = forecast.impulse_n_s.clone();
        let magnitude = forecast.impulse_magnitude_n_s.clone();
        let mean = [0, 1].map(|axis| prediction.mixture.impulse(axis).mean());
        Self {
            scenario,
            model: model.to_string(),
            impulse_n_s: ImpulseReport { mean, x, y, magnitude },
            peak_n: forecast.peak_n.clone(),
            peak_time_s: forecast.peak_time_s.clone(),
            duration_s: forecast.duration_s.clone(),
            pdof_deg: pdof.angle_deg(),
            pdof_clock: pdof.clock(),
            pdof_interval_deg: forecast.pdof_rad.scaled(1.0_f64.to_degrees()),
            momentum_impulse_n_s: prediction.momentum_impulse_n_s,
            implied_contact: None,
            hooking_probability: prediction.hooking_probability,
            modes: forecast.modes.clone(),
            applicability: prediction.applicability,
            outside_training: prediction.outside.clone(),
            is_contact_open: prediction.is_contact_open,
            is_body_open: prediction.is_body_open,
            is_struck_body_open: prediction.is_struck_body_open,
        }
    }
}
