//! The force network beside the momentum solution of a scenario: do they agree?
//!
//! ```text
//! |P| exp(± z σ_P)      φ ± z σ_φ      Δv = |P| / m
//! ```
//!
//! are the intervals of the momentum solution: σ_P and σ_φ are the root mean squares of the errors that
//! its impulse and the direction of that were measured to have on the shipped finite-element runs, and z
//! the quantile of the normal distribution. Those of the force network are its own.

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::StruckVehicle;
use crate::caveats::restrictions::learned_case_caveat;
use crate::caveats::unused::network_of_fixed;
use crate::{
    Answer, ForceQuestion, ForceSource, Library, ModelChoice, MotionSource, Observer,
    PredictForceReport, PredictForceRequest, PredictMotionRequest, Question, ScenarioChoice,
    StudyError,
};
use impactlab_core::collision::{ImpactSolution, PrincipalDirectionOfForce, Regime, Scenario};
use impactlab_core::data::write::ModelDigest;
use impactlab_core::data::{DatasetKind, Outcome};
use impactlab_core::error_chain;
use impactlab_core::numerics::{normal_quantile, wrap_angle_rad};
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Estimate, Phrase, PhraseValue, Quantity};
use impactlab_networks::force::{MOMENTUM_DIRECTION_STD_RAD, MOMENTUM_IMPULSE_LOG_STD};

/// The impulse on the struck vehicle by the momentum solution and by the force network, SI units.
///
/// Directions are principal directions of force, clockwise from straight ahead. The ends of their
/// intervals continue from the median without a jump.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ImpulseRival {
    /// The force network.
    pub model: String,
    /// Share of the force network in its answer, 0 to 1; the rest is the momentum solution with its
    /// measured errors.
    pub applicability: f64,
    /// Size of the impulse by the momentum solution, with its measured errors, N s.
    pub momentum_impulse_n_s: Estimate,
    /// Size of the impulse by the force network, N s.
    pub network_impulse_n_s: Estimate,
    /// Change of velocity of the struck vehicle by the impulse of the momentum solution, m/s.
    pub momentum_delta_v_m_s: Estimate,
    /// Change of velocity of the struck vehicle by the impulse of the force network, m/s.
    pub network_delta_v_m_s: Estimate,
    /// Largest size of the force by the force network, N; the momentum solution has no course of the force.
    pub network_peak_n: Estimate,
    /// From first touch to last separation by the force network, s; likewise.
    pub network_duration_s: Estimate,
    /// Direction of the force by the momentum solution, degrees.
    pub momentum_pdof_deg: Estimate,
    /// Direction of the force by the force network, degrees.
    pub network_pdof_deg: Estimate,
    /// Whether size and direction by the momentum solution lie in the 90 % intervals of the force
    /// network.
    pub is_in_network_intervals: bool,
    /// Whether size and direction by the force network lie in the 90 % intervals of the momentum
    /// solution.
    pub is_in_momentum_intervals: bool,
}

/// What stands beside a momentum solution.
#[derive(Default)]
pub(crate) struct Beside {
    /// The force network; `None` where it has nothing of its own to say.
    pub rival: Option<ImpulseRival>,
    /// Why it has not, or that the two do not agree, or that it has learned from the case.
    pub caveats: Vec<Caveat>,
    /// The force network that was asked.
    pub model: Option<ModelDigest>,
}

impl Beside {
    /// Asks a force network about a scenario. That it cannot be asked is no error: the momentum
    /// solution stands without it.
    ///
    /// - `choice`: the scenario as the network is asked about it, `scenario` the same as it was solved;
    /// - `model`, `seed`: the network, and the seed of its draws.
    ///
    /// # Errors
    /// [`StudyError`] if the network cannot be read.
    pub fn ask(
        (choice, scenario): (&ScenarioChoice, &Scenario),
        solution: &ImpactSolution,
        (model, seed): (ModelChoice, u64),
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Self>, StudyError> {
        let heading_rad = scenario.struck.heading_rad;
        let impulse_n_s = solution.impulse_world_n_s;
        let pdof = PrincipalDirectionOfForce::from_impulse(impulse_n_s, heading_rad);
        // Where the vehicles do not approach each other, there is nothing to compare.
        let Some(pdof) = pdof.filter(|_| solution.regime != Regime::NotApproaching) else {
            return Ok(Outcome::Complete(Self::default()));
        };
        if let Some(unknown) = network_of_fixed(scenario) {
            return Ok(Outcome::Complete(Self { caveats: vec![unknown], ..Self::default() }));
        }
        let digest = library.force_model_digest(&model)?;
        let alone = |why: &str| {
            let text = Phrase::new(
                "no other method stands beside the momentum solution: {0}",
                "Neben der Impulslösung steht kein anderes Verfahren: {0}",
            )
            .with(PhraseValue::Term(why.to_owned()));
            let caveats = vec![Caveat::new(CaveatKind::Note, text)];
            Ok(Outcome::Complete(Self { caveats, ..Self::default() }))
        };
        let collision = ForceQuestion::Scenario(choice.clone());
        let predicted = match ask_network(collision, (model, seed), library, observer) {
            Outcome::Complete(Ok(predicted)) => predicted.report,
            Outcome::Complete(Err(why)) => return alone(&why),
            Outcome::Cancelled => return Ok(Outcome::Cancelled),
        };
        let rival = ImpulseRival::new(impulse_n_s, pdof, scenario.struck.mass_kg, &predicted);
        let caveats = rival.caveat().into_iter().collect();
        Ok(Outcome::Complete(Self { rival: Some(rival), caveats, model: Some(digest) }))
    }

    /// The same of a case of a force data set, whose momentum solution is the one beside the network. Where
    /// that has nothing to say, nothing stands beside the record. A motion by the record needs neither of
    /// them, and it is no restriction of it that they disagree or are known.
    ///
    /// - `mass_kg`: of the struck vehicle;
    /// - `is_driving`: whether the network moves the vehicle.
    ///
    /// # Errors
    /// [`StudyError`] if the network cannot be read.
    pub fn ask_case(
        collision: ForceQuestion,
        (mass_kg, is_driving): (f64, bool),
        (model, seed): (ModelChoice, u64),
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Self>, StudyError> {
        let digest = library.force_model_digest(&model)?;
        let predicted = match ask_network(collision, (model, seed), library, observer) {
            Outcome::Complete(Ok(predicted)) => predicted,
            Outcome::Complete(Err(_)) => return Ok(Outcome::Complete(Self::default())),
            Outcome::Cancelled => return Ok(Outcome::Cancelled),
        };
        let kind = if is_driving { CaveatKind::TrainedOn } else { CaveatKind::Note };
        let learned = predicted.caveats.has(CaveatKind::TrainedOn);
        let learned = learned.then(|| learned_case_caveat(kind));
        let predicted = predicted.report;
        let impulse_n_s = predicted.momentum_impulse_n_s;
        let pdof = PrincipalDirectionOfForce::from_impulse(impulse_n_s, 0.0);
        let rival = pdof.map(|pdof| ImpulseRival::new(impulse_n_s, pdof, mass_kg, &predicted));
        let Some(rival) = rival else { return Ok(Outcome::Complete(Self::default())) };
        let disagreement = rival.caveat().filter(|_| is_driving);
        let caveats = disagreement.into_iter().chain(learned).collect();
        Ok(Outcome::Complete(Self { rival: Some(rival), caveats, model: Some(digest) }))
    }
}

impl PredictMotionRequest {
    /// The impulse of a scenario, or of a case of a force data set, by the momentum solution and by the force
    /// network that moves the vehicle, or the shipped one; nothing for a motion of another source.
    pub(super) fn impulses(
        &self,
        struck: &StruckVehicle,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Beside>, StudyError> {
        let nothing = Ok(Outcome::Complete(Beside::default()));
        let model = match &self.force {
            ForceSource::Predicted(model) => model.clone(),
            ForceSource::Given | ForceSource::File(_) => ModelChoice::default(),
        };
        match &self.motion.source {
            MotionSource::Scenario { scenario: choice, .. } => {
                let scenario = choice.load()?;
                let Ok(solution) = scenario.solve() else { return nothing };
                let asked = (model, self.seed);
                Beside::ask((choice, &scenario), &solution, asked, library, observer)
            }
            MotionSource::Case { dataset, case }
                if DatasetKind::from_folder(dataset) == Some(DatasetKind::Force) =>
            {
                let (dataset, case) = (dataset.clone(), case.clone());
                let collision = ForceQuestion::Case { dataset, case };
                let is_driving = matches!(self.force, ForceSource::Predicted(_));
                let struck = (struck.vehicle.mass.mass_kg, is_driving);
                Beside::ask_case(collision, struck, (model, self.seed), library, observer)
            }
            _ => nothing,
        }
    }
}

/// What a force network says of a collision, or why it says nothing.
fn ask_network(
    collision: ForceQuestion,
    (model, seed): (ModelChoice, u64),
    library: &Library,
    observer: &mut Observer<'_>,
) -> Outcome<Result<Answer<PredictForceReport>, String>> {
    let request = PredictForceRequest { model, seed, ..PredictForceRequest::new(collision) };
    match request.answer(library, observer) {
        Ok(Outcome::Complete(predicted)) if predicted.report.applicability <= 0.0 => {
            let why = "the force network has learned from no collision like this one";
            Outcome::Complete(Err(why.to_owned()))
        }
        Ok(Outcome::Complete(predicted)) => Outcome::Complete(Ok(predicted.report)),
        Ok(Outcome::Cancelled) => Outcome::Cancelled,
        Err(error) => Outcome::Complete(Err(error_chain(&error))),
    }
}

impl ImpulseRival {
    /// - `impulse_n_s`: by the momentum solution, in any axes;
    /// - `mass_kg`: of the struck vehicle.
    fn new(
        [x, y]: [f64; 2],
        pdof: PrincipalDirectionOfForce,
        mass_kg: f64,
        predicted: &PredictForceReport,
    ) -> Self {
        let size_n_s = x.hypot(y);
        let spread = |value: &dyn Fn(f64) -> f64| {
            let ends = |level: f64| {
                let z = normal_quantile((1.0 + level) / 2.0);
                [value(-z), value(z)]
            };
            Estimate::new(value(0.0), ends(0.5), ends(0.9))
        };
        let momentum_impulse_n_s = spread(&|z| size_n_s * (MOMENTUM_IMPULSE_LOG_STD * z).exp());
        let direction_std_deg = MOMENTUM_DIRECTION_STD_RAD.to_degrees();
        let centre_deg = pdof.centre_rad(0).to_degrees();
        let momentum_pdof_deg = spread(&|z| centre_deg + direction_std_deg * z);
        let network_impulse_n_s = predicted.impulse_n_s.magnitude.clone();
        let network_pdof_deg = predicted.pdof_interval_deg.clone();
        let holds = |size: &Estimate, direction_deg: &Estimate, of: [&Estimate; 2]| {
            let [low, high] = size.ninety();
            let is_size = (low..=high).contains(&of[0].median);
            is_size && holds_angle(direction_deg, of[1].median)
        };
        let [momentum, network] = [
            [&momentum_impulse_n_s, &momentum_pdof_deg],
            [&network_impulse_n_s, &network_pdof_deg],
        ];
        Self {
            model: predicted.model.clone(),
            applicability: predicted.applicability,
            is_in_network_intervals: holds(network[0], network[1], momentum),
            is_in_momentum_intervals: holds(momentum[0], momentum[1], network),
            momentum_delta_v_m_s: momentum_impulse_n_s.scaled(1.0 / mass_kg),
            network_delta_v_m_s: network_impulse_n_s.scaled(1.0 / mass_kg),
            network_peak_n: predicted.peak_n.clone(),
            network_duration_s: predicted.duration_s.clone(),
            momentum_impulse_n_s,
            network_impulse_n_s,
            momentum_pdof_deg,
            network_pdof_deg,
        }
    }

    /// That each lies outside of what the other allows, if so.
    fn caveat(&self) -> Option<Caveat> {
        if self.is_in_network_intervals || self.is_in_momentum_intervals {
            return None;
        }
        let ratio = self.network_impulse_n_s.median / self.momentum_impulse_n_s.median;
        let turned_deg = self.network_pdof_deg.median - self.momentum_pdof_deg.median;
        let turned_rad = wrap_angle_rad(turned_deg.to_radians());
        let text = Phrase::new(
            "the impulse of the force network is {0} times that of the momentum solution, turned by \
             {1}, each outside of the 90 % intervals of the other: network and physics do \
             not say the same",
            "Der Stoßantrieb des Kraftnetzes beträgt das {0}-Fache dessen der Impulslösung und ist um {1} \
             gedreht; jeder liegt außerhalb der 90-%-Intervalle des anderen: Netz und Physik widersprechen \
             sich",
        )
        .with(PhraseValue::fixed(Quantity::Ratio, ratio, 2))
        .with(PhraseValue::fixed(Quantity::Angle, turned_rad, 0).in_unit("deg"));
        let high = (MOMENTUM_IMPULSE_LOG_STD * normal_quantile(0.95)).exp();
        let caveat = Caveat::new(CaveatKind::Disagreement, text)
            .with_value("impulse of the force network over that of the momentum solution", ratio)
            .with_range([1.0 / high, high]);
        Some(caveat)
    }
}

/// Whether the 90 % interval of a direction, degrees, holds another, which may be given one turn
/// further.
fn holds_angle(interval_deg: &Estimate, angle_deg: f64) -> bool {
    let off = |deg: f64| deg - interval_deg.median;
    let [low, high] = interval_deg.ninety().map(off);
    let angle = wrap_angle_rad(off(angle_deg).to_radians()).to_degrees();
    (low..=high).contains(&angle)
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;

    fn asked(scenario: &Scenario) -> Beside {
        let choice = ScenarioChoice::Inline(Box::new(scenario.clone()));
        let solution = scenario.solve().unwrap();
        let library = Library::default();
        let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
        let asked = (ModelChoice::default(), 0);
        let beside = Beside::ask((&choice, scenario), &solution, asked, &library, &mut go_on);
        beside.unwrap().complete().unwrap()
    }

    /// The intervals of the momentum solution are those of its measured errors, 0.26 in ln |P| and
    /// 0.21 rad: 90 % of a normal distribution lie within 1.645 of them.
    #[test]
    fn the_momentum_solution_has_its_measured_errors_and_the_network_its_own() {
        let scenario = Scenario::example();
        let rival = asked(&scenario).rival.unwrap();
        let [x, y] = scenario.solve().unwrap().impulse_world_n_s;
        let size = x.hypot(y);
        assert!((rival.momentum_impulse_n_s.median - size).abs() < 1e-9 * size);
        let [low, high] = rival.momentum_impulse_n_s.ninety();
        assert!((low / size - 0.6520).abs() < 1e-3 && (high / size - 1.5337).abs() < 1e-3);
        let [low, high] = rival.momentum_pdof_deg.ninety();
        assert!((high - low - 39.58).abs() < 0.01, "{low} to {high}");
        let mass_kg = scenario.struck.mass_kg;
        let delta_v_m_s = rival.momentum_delta_v_m_s.median;
        assert!((delta_v_m_s - size / mass_kg).abs() < 1e-12);
        assert!(rival.network_impulse_n_s.median > size, "{rival:?}");
    }

    #[test]
    fn an_interval_of_directions_holds_what_is_a_turn_further() {
        let interval = Estimate::new(355.0, [350.0, 360.0], [340.0, 370.0]);
        for (angle_deg, is_held) in [
            (5.0, true),
            (365.0, true),
            (11.0, false),
            (341.0, true),
            (339.0, false),
            (-19.0, true),
        ] {
            assert_eq!(holds_angle(&interval, angle_deg), is_held, "{angle_deg}");
        }
    }

    /// Ten times the stiffness of an impact turns the impulse aside: what neither allows is a warning.
    #[test]
    fn that_neither_allows_the_other_is_a_warning() {
        let (mut scenario, same) = (Scenario::example(), asked(&Scenario::example()));
        assert!(same.caveats.is_empty(), "{:?}", same.caveats);
        scenario.contact.restitution = Some(1.0);
        scenario.contact.friction_limit = Some(2.0);
        let beside = asked(&scenario);
        let rival = beside.rival.unwrap();
        assert!(!rival.is_in_network_intervals && !rival.is_in_momentum_intervals, "{rival:?}");
        assert_eq!(beside.caveats[0].kind, CaveatKind::Disagreement);
    }

    /// At 60 m/s across nothing is left of the network: nothing stands beside the momentum solution, and
    /// that is said. Where the vehicles part, there is nothing to stand beside.
    #[test]
    fn where_the_network_says_nothing_that_is_said() {
        let mut scenario = Scenario::example();
        scenario.striking.vy_world_m_s = 60.0;
        let beside = asked(&scenario);
        assert!(beside.rival.is_none());
        let note = &beside.caveats[0];
        assert!(note.kind == CaveatKind::Note && note.text.contains("like this one"), "{note:?}");
        scenario.striking.vy_world_m_s = -5.0;
        let beside = asked(&scenario);
        assert!(beside.rival.is_none() && beside.caveats.is_empty());
    }
}
