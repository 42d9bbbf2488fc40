//! The impulse solution of a scenario: `impact`.

use crate::caveats::assumed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::caveats::{bodies, restrictions};
use crate::questions::predict::impulse_rival::Beside;
use crate::{
    Answer, ImpulseRival, Library, ModelChoice, Observer, Provenance, Question, ScenarioChoice,
    StudyError,
};
use impactlab_core::collision::{
    BodyAfter, FrictionModel, ImpactSolution, PrincipalDirectionOfForce, Regime, RestitutionForm,
    Role, Scenario, StruckSurface,
};
use impactlab_core::data::Outcome;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::vehicle::{FixedObject, RoadSlope};

/// Seed of the draws from the force network beside the solution.
const SEED: u64 = 0;

/// Asks for impulse, velocities after the impact, delta-v, energy and direction of force.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ImpactRequest {
    /// The two vehicles and where they meet.
    pub scenario: ScenarioChoice,
    /// Whether the friction is always sliding, as the paper prints it.
    #[serde(default)]
    pub paper: bool,
    /// Whether the momentum solution is asked alone, without the force network beside it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub alone: bool,
}

impl ImpactRequest {
    /// The solution of a scenario about which nothing else is said.
    pub fn new(scenario: ScenarioChoice) -> Self {
        Self { scenario, paper: false, alone: false }
    }
}

/// The solution of an impact in SI units. The impulse acts on the struck vehicle; world axes.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ImpactReport {
    /// Name of the scenario.
    pub name: String,
    /// Coefficient of restitution that was used.
    pub restitution: f64,
    /// What restitution acts on.
    pub restitution_form: RestitutionForm,
    /// Friction limit that was used, also where it is given as a share of the critical impulse
    /// ratio.
    pub friction_limit: f64,
    /// The given share of the critical impulse ratio.
    pub friction_of_critical: Option<f64>,
    /// The smallest friction limit with which the vehicles do not slide; none if they do not
    /// approach, or slide whatever the friction.
    pub critical_impulse_ratio: Option<f64>,
    /// How friction in the contact is modelled.
    pub friction_model: FrictionModel,
    /// Whether the contact sticks or slides.
    pub regime: Regime,
    /// Impulse [x, y], N s.
    pub impulse_n_s: [f64; 2],
    /// Its size, N s.
    pub impulse_magnitude_n_s: f64,
    /// Its component along the normal of the contact, N s.
    pub impulse_normal_n_s: f64,
    /// Its component along the tangent of the contact, N s.
    pub impulse_tangential_n_s: f64,
    /// Velocity at which the contact points approach, normal and tangential, m/s.
    pub closing_velocity_m_s: [f64; 2],
    /// Contact point [x, y], m.
    pub contact_point_m: [f64; 2],
    /// Direction of the normal, rad.
    pub normal_angle_rad: f64,
    /// The side of the struck or the striking vehicle to which the normal is perpendicular, where
    /// the contact comes from outlines.
    pub struck_surface: Option<StruckSurface>,
    /// How far the outlines overlap, m, where the contact comes from outlines.
    pub overlap_m: Option<f64>,
    /// Kinetic energy lost in the contact, J.
    pub dissipated_energy_j: f64,
    /// The struck vehicle after the impact.
    #[serde(rename = "target")]
    pub struck: BodyReport,
    /// The striking vehicle after the impact.
    #[serde(rename = "bullet")]
    pub striking: BodyReport,
    /// What the striking one is, where it is an object that does not move.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fixed: Option<FixedObject>,
    /// The vehicles before skids that end at the first contact.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub skids: Vec<SkidReport>,
    /// The force network beside it; none where it is not asked or has nothing of its own to say.
    pub rival: Option<ImpulseRival>,
}

/// A vehicle before a skid that ends at the first contact, SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SkidReport {
    /// Which vehicle: `target` or `bullet`.
    pub vehicle: &'static str,
    /// Distance over which it skids, m.
    pub length_m: f64,
    /// Deceleration on a level road over that of gravity.
    pub drag_factor: f64,
    /// Speed at the start of the skid, m/s.
    pub speed_before_m_s: f64,
    /// How long the skid lasts, s.
    pub duration_s: f64,
}

impl SkidReport {
    /// The skids of a scenario on a road.
    pub(crate) fn of(scenario: &Scenario, slope: &RoadSlope) -> Vec<Self> {
        let skid = |(role, vehicle)| {
            let before = scenario.before_skid(role, slope)?;
            Some(Self {
                vehicle,
                length_m: before.skid.length_m,
                drag_factor: before.skid.drag_factor,
                speed_before_m_s: before.speed_m_s,
                duration_s: before.duration_s,
            })
        };
        Role::ALL.into_iter().zip(["target", "bullet"]).filter_map(skid).collect()
    }
}

/// One vehicle after the impact, world axes.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct BodyReport {
    /// Velocity [x, y], m/s.
    pub velocity_m_s: [f64; 2],
    /// Its size, m/s.
    pub speed_m_s: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Change of velocity [x, y], m/s.
    pub delta_v_m_s: [f64; 2],
    /// Its size, m/s.
    pub delta_v_magnitude_m_s: f64,
    /// Change of the yaw rate, rad/s.
    pub delta_yaw_rate_rad_s: f64,
    /// Principal direction of force, degrees clockwise from straight ahead.
    pub pdof_deg: Option<f64>,
    /// The same as an hour of the clock.
    pub pdof_clock: Option<u8>,
}

/// A solved impact.
#[derive(Debug, Clone, PartialEq)]
pub struct ImpactAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<ImpactReport>,
    /// The scenario that was solved.
    pub scenario: Scenario,
    /// Its solution.
    pub solution: ImpactSolution,
}

impl Question for ImpactRequest {
    type Answer = ImpactAnswer;
    type Report = Answer<ImpactReport>;
    const NAME: &'static str = "impact";

    fn check(&self) -> Result<(), StudyError> {
        self.scenario.check()
    }

    /// Without the force network, which takes longer than all else.
    fn coarse(&self) -> Option<Self> {
        (!self.alone).then(|| Self { alone: true, ..self.clone() })
    }

    const IS_COARSE_PART: bool = true;

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<ImpactAnswer>, StudyError> {
        let mut scenario = self.scenario.load()?;
        if self.paper {
            scenario.contact.friction_model = FrictionModel::Paper;
        }
        let unsolved = |source| self.scenario.unsolved(source);
        let geometry = scenario.geometry().map_err(unsolved)?;
        let impact = scenario.impact().map_err(unsolved)?;
        let solution = scenario.solve().map_err(unsolved)?;
        let [x, y] = solution.impulse_world_n_s;
        let beside = match self.alone {
            true => Outcome::Complete(Beside::default()),
            false => {
                let asked = (&self.scenario, &scenario);
                let network = (ModelChoice::default(), SEED);
                Beside::ask(asked, &solution, network, library, observer)?
            }
        };
        let Outcome::Complete(Beside { rival, caveats: beside, model }) = beside else {
            return Ok(Outcome::Cancelled);
        };
        let caveats: Caveats = assumed::first_touch(&geometry)
            .into_iter()
            .chain(assumed::contact_default(&scenario, &impact))
            .chain(bodies::doubtful(&scenario))
            .chain(restrictions::overlap_caveat(&geometry))
            .chain(restrictions::energy_gain_caveat(solution.dissipated_energy_j))
            .chain(beside)
            .collect();
        let report = ImpactReport {
            name: scenario.name.clone(),
            restitution: impact.surface.restitution,
            restitution_form: impact.surface.restitution_form,
            friction_limit: impact.surface.friction_limit,
            friction_of_critical: scenario.contact.friction_of_critical,
            critical_impulse_ratio: impact.critical_impulse_ratio(),
            friction_model: scenario.contact.friction_model,
            regime: solution.regime,
            impulse_n_s: solution.impulse_world_n_s,
            impulse_magnitude_n_s: x.hypot(y),
            impulse_normal_n_s: solution.impulse_normal_n_s,
            impulse_tangential_n_s: solution.impulse_tangential_n_s,
            closing_velocity_m_s: solution.closing_velocity_m_s,
            contact_point_m: geometry.contact_point_world_m,
            normal_angle_rad: geometry.normal_angle_world_rad,
            struck_surface: geometry.surface,
            overlap_m: geometry.overlap_m,
            dissipated_energy_j: solution.dissipated_energy_j,
            struck: (&solution.struck).into(),
            striking: (&solution.striking).into(),
            fixed: scenario.striking.fixed,
            skids: SkidReport::of(&scenario, &scenario.road.unwrap_or_default()),
            rival,
        };
        let provenance = match model {
            Some(model) => Provenance::from_seed(SEED).with_models([model]),
            None => Provenance::default(),
        };
        let report = Answer { report, caveats, provenance };
        Ok(Outcome::Complete(ImpactAnswer { report, scenario, solution }))
    }
}

impl From<&BodyAfter> for BodyReport {
    fn from(after: &BodyAfter) -> Self {
        let size = |[x, y]: [f64; 2]| x.hypot(y);
        Self {
            velocity_m_s: after.velocity_world_m_s,
            speed_m_s: size(after.velocity_world_m_s),
            yaw_rate_rad_s: after.yaw_rate_rad_s,
            delta_v_m_s: after.delta_v_world_m_s,
            delta_v_magnitude_m_s: size(after.delta_v_world_m_s),
            delta_yaw_rate_rad_s: after.delta_yaw_rate_rad_s,
            pdof_deg: after.pdof.map(PrincipalDirectionOfForce::angle_deg),
            pdof_clock: after.pdof.map(PrincipalDirectionOfForce::clock),
        }
    }
}
