//! A forecast of both vehicles of a scenario: where the force of the first contact comes from.

use std::f64::consts::FRAC_PI_4;

use crate::analysis::{
    Analysis, BothVehiclesQuestion, ContactPair, FirstContact, FirstForces, MotionForecast,
    MotionForecastSettings, PlaceChance, StruckVehicle, ended, forecast_both, in_world,
    place_chances,
};
use crate::caveats::covered::covered_part;
use crate::caveats::unused::{by_force_network, drawn_drivers, lanes_by_network};
use crate::questions::predict::motion::Noted;
use crate::questions::predict::one_vehicle::given_force;
use crate::{
    Event, ForceSource, InputKind, Library, MotionSource, Observer, PredictMotionRequest,
    SeriesFile, StudyError, TriedMotion,
};
use impactlab_core::collision::Role;
use impactlab_core::data::{ForceHistory, Outcome};
use impactlab_core::jobs::Progress;
use impactlab_core::numerics::random_stream;
use impactlab_core::site::Site;
use impactlab_core::uncertainty::{Caveat, CaveatKind, Caveats, CurveMixture};
use impactlab_core::units::{Phrase, PhraseValue};
use impactlab_core::vehicle::REST_SPEED_M_S;
use impactlab_networks::force::{ForcePrediction, ForceScenario, SHARE_OF_NETWORK};
use impactlab_networks::response::ResponseModel;

/// Share of the draws with a scale that is cut off from which on it is said.
const MOST_CLAMPED: f64 = 0.1;
/// That from which on it is a warning: most draws follow a contact that neither asks for.
const MOSTLY_CLAMPED: f64 = 0.5;

/// Two vehicles that are followed through all contacts, as the simulation has placed them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Both<'a> {
    pair: &'a ContactPair,
    vehicles: [&'a StruckVehicle; 2],
    /// The pulse of the momentum solution.
    own_force: &'a ForceHistory,
}

impl<'a> Both<'a> {
    /// `None` where the simulation has followed one vehicle by itself.
    pub fn of_simulation(analysis: &'a Analysis) -> Option<Self> {
        let striking = &analysis.striking.as_ref()?.start;
        Some(Self {
            pair: analysis.pair.as_ref()?,
            vehicles: [analysis.struck.as_ref()?, striking],
            own_force: analysis.force.as_ref()?,
        })
    }

    /// The forecast.
    fn forecast(
        &self,
        first_forces: &FirstForces,
        response: &ResponseModel,
        settings: &MotionForecastSettings,
        (name, observer): (&str, &mut Observer<'_>),
    ) -> Result<Outcome<MotionForecast>, StudyError> {
        let question = BothVehiclesQuestion {
            pair: self.pair,
            vehicles: self.vehicles,
            first_forces,
            usual_force: first_forces.median.as_ref().unwrap_or(self.own_force),
            response,
            is_corrected: self.is_corrected(response),
        };
        let mut report = |progress: Progress| observer(Event::Progress(progress));
        forecast_both(&question, settings, &mut report).map_err(|source| StudyError::Forecast {
            name: name.to_owned(),
            source: Box::new(source),
        })
    }

    /// Whether the network has learned from vehicles like each of both: one that knows how cars differ has
    /// seen braked ones, another one those that coast alone.
    fn is_corrected(&self, response: &ResponseModel) -> [bool; 2] {
        self.vehicles.map(|it| it.controls.is_coasting() || response.population().is_some())
    }

    /// What is not used of the network, what is drawn of drivers and systems, and how far the contact law
    /// was scaled.
    fn caveats(&self, forecast: &MotionForecast, response: &ResponseModel) -> Vec<Caveat> {
        let uncorrected = self.is_corrected(response).into_iter().zip(Role::ALL);
        let uncorrected = uncorrected.filter(|(is_corrected, _)| !is_corrected).map(|(_, role)| {
            Caveat::not_used(
                Phrase::new("response network for the {0}", "Bewegungsnetz, {0}")
                    .with(PhraseValue::Term(role.label().to_owned())),
                Phrase::new(
                    "it has learned from vehicles that coast; the equations of motion stand alone",
                    "es hat an rollenden Fahrzeugen gelernt; die Bewegungsgleichungen gelten allein",
                ),
            )
        });
        let clamped = forecast.both.as_ref().and_then(|both| {
            let contacts = &both.contacts;
            clamped_scale(contacts.clamped_share, [contacts.n_known_forces, contacts.n_draws])
        });
        uncorrected.chain(drawn_drivers(self.vehicles)).chain(clamped).collect()
    }
}

impl PredictMotionRequest {
    /// Like which of the motions that were tried the forecast is.
    pub(super) fn tried_motion(
        &self,
        struck: &StruckVehicle,
        follows_both: bool,
    ) -> Result<TriedMotion, StudyError> {
        match &self.motion.source {
            MotionSource::Scenario { scenario: choice, .. } if follows_both => {
                let collision = ForceScenario::from_scenario(&choice.load()?);
                let collision = collision.map_err(|source| choice.unsolved(source))?;
                Ok(tried_collision(&collision))
            }
            _ if struck.controls.acts_on_wheels() => Ok(TriedMotion::Braked),
            _ => Ok(TriedMotion::Coasting),
        }
    }

    /// How likely the vehicles come to the lanes and kerbs of the site.
    pub(super) fn places(
        &self,
        forecast: &MotionForecast,
        analysis: &Analysis,
        caveats: &mut Caveats,
    ) -> Result<Vec<PlaceChance>, StudyError> {
        let Some(path) = &self.motion.site else { return Ok(Vec::new()) };
        let site = InputKind::Site.explain(path, Site::load(path))?;
        let (Some(_), Some(striking)) = (&forecast.both, &analysis.striking) else {
            caveats.extend(lanes_by_network(&site));
            return Ok(Vec::new());
        };
        Ok(place_chances(&site, forecast, [analysis.footprint, striking.footprint]))
    }

    /// The forecast of both vehicles.
    pub(super) fn of_both_vehicles(
        &self,
        both: &Both<'_>,
        model: &ResponseModel,
        settings: &MotionForecastSettings,
        (library, observer): (&Library, &mut Observer<'_>),
        noted: &mut Noted,
    ) -> Result<Outcome<MotionForecast>, StudyError> {
        let [struck, _] = both.vehicles;
        let first = match &self.force {
            ForceSource::Predicted(_) => {
                self.first_forces(struck, library, observer, &mut noted.unused)?
            }
            ForceSource::Given => Outcome::Complete(FirstForces::given(both.own_force.clone())),
            ForceSource::File(path) => {
                let file = SeriesFile { path: path.clone(), map: self.force_map.clone() };
                let duration_s = settings.duration_s;
                let force = given_force(&file, struck, duration_s, library, &mut noted.of_force)?;
                Outcome::Complete(FirstForces::given(force))
            }
        };
        let Outcome::Complete(first) = first else { return Ok(Outcome::Cancelled) };
        let name = self.motion.source.name();
        let forecast = both.forecast(&first, model, settings, (&name, observer))?;
        if let Outcome::Complete(forecast) = &forecast {
            noted.unused.extend(both.caveats(forecast, model));
        }
        Ok(forecast)
    }

    /// The force of the first contact as the force network says it: in so many draws as it applies, and
    /// the contact law in the others. Where that is no push on a flank, on which the law was tried, every
    /// other one of these has the momentum solution instead.
    fn first_forces(
        &self,
        struck: &StruckVehicle,
        library: &Library,
        observer: &mut Observer<'_>,
        caveats: &mut Vec<Caveat>,
    ) -> Result<Outcome<FirstForces>, StudyError> {
        let ForceSource::Predicted(choice) = &self.force else {
            return Ok(Outcome::Complete(FirstForces::law()));
        };
        if let MotionSource::Scenario { scenario, .. } = &self.motion.source {
            caveats.extend(by_force_network(scenario, &scenario.load()?)?);
        }
        let predicted = self.predicted(choice, library, observer)?;
        let Outcome::Complete((force_model, collision)) = predicted else {
            return Ok(Outcome::Cancelled);
        };
        let prediction =
            force_model.predict(&collision).map_err(|source| StudyError::Forecast {
                name: self.motion.source.name(),
                source: Box::new(source.into()),
            })?;
        let heading_rad = struck.initial.yaw_rad;
        let has_pulses = !collision.is_push_on_flank();
        if let (MotionSource::Scenario { scenario, .. }, true) = (&self.motion.source, has_pulses) {
            caveats.extend(covered_part(&scenario.load()?));
        }
        let settings = (self.draws, self.seed);
        let forces = FirstForces::predicted(prediction, has_pulses, heading_rad, settings);
        Ok(Outcome::Complete(forces))
    }
}

impl FirstForces {
    /// The contact law from the start on.
    fn law() -> Self {
        Self { median: None, draws: Vec::new(), prediction: None }
    }

    /// One known history.
    fn given(force: ForceHistory) -> Self {
        Self { median: Some(force), draws: Vec::new(), prediction: None }
    }

    /// - `has_pulses`: whether every other draw without the network has the momentum solution with its
    ///   errors in place of the contact law;
    /// - `heading_rad`: of the struck vehicle, along which a predicted force has its axes.
    fn predicted(
        prediction: ForcePrediction,
        has_pulses: bool,
        heading_rad: f64,
        (n_draws, seed): (usize, u64),
    ) -> Self {
        let share = prediction.applicability;
        let sample = |mixture: Option<&CurveMixture>, stream: &str| {
            let mut rng = random_stream(seed, stream, 0);
            mixture.map_or_else(Vec::new, |mixture| mixture.sample(n_draws, &mut rng))
        };
        let curves = sample(prediction.learned.as_ref(), "force curves");
        let pulses = sample(prediction.bare.as_ref().filter(|_| has_pulses), "momentum pulses");
        // Spread evenly over the draws.
        let is_learned =
            |draw: usize| (share * (draw + 1) as f64).floor() > (share * draw as f64).floor();
        let (mut curves, mut pulses) = (curves.iter(), pulses.iter());
        let mut is_pulse = true;
        let draws = (0..n_draws)
            .map(|draw| {
                if is_learned(draw) {
                    let curve = curves.next().map(|curve| in_world(curve, heading_rad));
                    return curve.map_or(FirstContact::Law, FirstContact::Network);
                }
                is_pulse = !is_pulse;
                let pulse = if is_pulse { pulses.next() } else { None };
                let pulse = pulse.map(|pulse| in_world(&ended(pulse), heading_rad));
                pulse.map_or(FirstContact::Law, FirstContact::Momentum)
            })
            .collect();
        let likely = prediction.learned.as_ref().filter(|_| share >= 0.5);
        let median = likely.map(|_| in_world(&prediction.likely.mean(), heading_rad));
        Self { median, draws, prediction: Some(prediction) }
    }
}

/// Like which of the pairs that were tried a collision is. Of these both travelled, in a push on a flank within 45° of
/// each other, and none came towards the other.
fn tried_collision(collision: &ForceScenario) -> TriedMotion {
    let angle_rad = angle_of_travel_rad(collision);
    match (collision.is_push_on_flank(), collision.is_hit_in_front()) {
        (true, _) if angle_rad.is_some_and(|angle_rad| angle_rad <= FRAC_PI_4) => {
            TriedMotion::PushOnFlank
        }
        (false, false) if angle_rad.is_none_or(|angle_rad| angle_rad <= 3.0 * FRAC_PI_4) => {
            TriedMotion::AcrossOrBehind
        }
        _ => TriedMotion::Untried,
    }
}

/// Angle between the directions in which the vehicles travel, rad, 0 to π; `None` where one of them stands.
fn angle_of_travel_rad(collision: &ForceScenario) -> Option<f64> {
    let [a, b] = [collision.struck_velocity_m_s, collision.striking_velocity_m_s];
    let is_moving = [a, b].iter().all(|[x, y]| x.hypot(*y) > REST_SPEED_M_S);
    let [along, across] = [a[0] * b[0] + a[1] * b[1], a[0] * b[1] - a[1] * b[0]];
    is_moving.then(|| across.atan2(along).abs())
}

/// What restricts a predicted force where the contact law stands for what the network does not say.
///
/// - `has_pulses`: whether the momentum solution does so in half of these draws.
pub(super) fn with_contact_law(caveats: &[Caveat], has_pulses: bool) -> Vec<Caveat> {
    let restated = |caveat: &Caveat| {
        let is_share = caveat.quantity.as_deref() == Some(SHARE_OF_NETWORK);
        match caveat.value.filter(|_| is_share) {
            Some(share) => {
                let text = if has_pulses { shared_text(share) } else { law_text(share) };
                let Caveat { text, text_phrase, .. } = Caveat::new(caveat.kind, text);
                Caveat { text, text_phrase, ..caveat.clone() }
            }
            None => caveat.clone(),
        }
    };
    let no_force = |caveat: &&Caveat| caveat.kind != CaveatKind::ImplausibleContact;
    caveats.iter().filter(no_force).map(restated).collect()
}

/// That the scale of the contact law is cut off: in most draws a disagreement of force and law, in some a note.
///
/// - `clamped_share`: of the draws with a known force, of which there are `n_known` among `n_draws`.
fn clamped_scale(clamped_share: f64, [n_known, n_draws]: [usize; 2]) -> Option<Caveat> {
    let share = clamped_share * n_known as f64 / n_draws.max(1) as f64;
    let (kind, text) = if share > MOSTLY_CLAMPED {
        let text = Phrase::new(
            "force and contact law do not go together: in {0} of the draws the scale of the faces' \
             stiffness was outside of 0.3 to 3 and is cut off there",
            "Kraft und Kontaktgesetz passen nicht zusammen: In {0} der Ziehungen lag der Maßstab der \
             Steifigkeit außerhalb von 0,3 bis 3 und ist dort abgeschnitten",
        );
        (CaveatKind::Disagreement, text)
    } else {
        let text = Phrase::new(
            "in {0} of the draws the scale of the faces' stiffness was outside of 0.3 to 3 and is cut \
             off there",
            "In {0} der Ziehungen lag der Maßstab der Steifigkeit außerhalb von 0,3 bis 3 und ist dort \
             abgeschnitten",
        );
        (CaveatKind::Note, text)
    };
    (share > MOST_CLAMPED).then(|| Caveat::new(kind, text.with(PhraseValue::Share(share))))
}

fn law_text(share: f64) -> Phrase {
    match share > 0.0 {
        true => Phrase::new(
            "in {0} of the draws the first contact follows from the contact law, since the force \
             network has not learned from such collisions",
            "In {0} der Ziehungen folgt der erste Kontakt aus dem Kontaktgesetz, da das Kraftnetz an \
             solchen Kollisionen nicht gelernt hat",
        )
        .with(PhraseValue::Share(1.0 - share)),
        false => Phrase::new(
            "the first contact follows from the contact law, since the force network has not \
             learned from such collisions",
            "Der erste Kontakt folgt aus dem Kontaktgesetz, da das Kraftnetz an solchen Kollisionen nicht \
             gelernt hat",
        ),
    }
}

fn shared_text(share: f64) -> Phrase {
    Phrase::new(
        "the force network has not learned from such collisions: in {0} of the draws the first contact \
         follows in equal parts from the contact law and from the momentum solution with its measured \
         errors. The law was fitted to pushes on a flank and was too sure of other collisions: of seven its \
         regions of 90 % held 56 % of the path",
        "Das Kraftnetz hat an solchen Kollisionen nicht gelernt: In {0} der Ziehungen folgt der erste \
         Kontakt je zur Hälfte aus dem Kontaktgesetz und aus der Impulslösung mit deren gemessenen Fehlern. \
         Das Gesetz ist an Stöße gegen eine Flanke angepasst und war sich anderer Kollisionen zu sicher: Bei \
         sieben enthielten seine Bereiche zu 90 % nur 56 % des Wegs",
    )
    .with(PhraseValue::Share(1.0 - share))
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::collision::{ContactLocation, Scenario, Side};

    /// “In 60 % of the draws” was told where 6 of 200 draws were cut off, and one sentence was a note or a warning.
    #[test]
    fn a_scale_that_is_cut_off_is_told_as_a_share_of_all_draws() {
        assert_eq!(clamped_scale(0.6, [10, 200]), None);
        let [some, most] = [100, 200].map(|n_known| clamped_scale(0.6, [n_known, 200]).unwrap());
        assert_eq!([some.kind, most.kind], [CaveatKind::Note, CaveatKind::Disagreement]);
        let disagrees = "force and contact law do not go together";
        assert!(some.text.starts_with("in 30.0 % of the draws") && !some.text.contains(disagrees));
        assert!(most.text.starts_with(disagrees) && most.text.contains("in 60.0 % of the draws"));
    }

    /// T-bone, rear-end and frontal collisions were told how often regions had held of PITs.
    #[test]
    fn a_t_bone_and_a_rear_end_collision_are_no_push_on_a_flank() {
        let kind = |side, heading_deg: f64, speed_m_s: f64| {
            let mut scenario = Scenario::example();
            let heading_rad = heading_deg.to_radians();
            scenario.striking.heading_rad = heading_rad;
            scenario.striking.vx_world_m_s = speed_m_s * heading_rad.cos();
            scenario.striking.vy_world_m_s = speed_m_s * heading_rad.sin();
            scenario.contact.location = ContactLocation::Side { side, offset_m: 0.0 };
            let collision = ForceScenario::from_scenario(&scenario).unwrap();
            (collision.is_push_on_flank(), collision.is_hit_in_front())
        };
        assert_eq!(kind(Side::Right, 18.0, 17.0), (true, false));
        assert_eq!(kind(Side::Right, 90.0, 12.0), (false, false));
        assert_eq!(kind(Side::Rear, 0.0, 22.0), (false, false));
        assert_eq!(kind(Side::Front, 180.0, 12.0), (false, true));
    }

    /// A standing car and one that rolled back were told how often regions had held of PITs, cars that scraped past
    /// each other in opposite directions how often of T-bones.
    #[test]
    fn vehicles_that_do_not_travel_alike_are_like_none_that_was_tried() {
        let tried = |side, heading_deg: f64, [struck_m_s, striking_m_s]: [f64; 2]| {
            let mut scenario = Scenario::example();
            let (sin, cos) = heading_deg.to_radians().sin_cos();
            scenario.struck.vx_world_m_s = struck_m_s;
            scenario.striking.heading_rad = heading_deg.to_radians();
            scenario.striking.vx_world_m_s = striking_m_s * cos;
            scenario.striking.vy_world_m_s = striking_m_s * sin;
            scenario.contact.location = ContactLocation::Side { side, offset_m: 0.0 };
            tried_collision(&ForceScenario::from_scenario(&scenario).unwrap())
        };
        use TriedMotion::{AcrossOrBehind, PushOnFlank, Untried};
        for (side, heading_deg, speeds_m_s, expected) in [
            (Side::Right, 18.0, [15.0, 17.0], PushOnFlank),
            (Side::Right, 18.0, [0.0, 17.0], Untried),
            (Side::Right, 18.0, [-5.0, 17.0], Untried),
            (Side::Right, 90.0, [15.0, 12.0], AcrossOrBehind),
            (Side::Right, 90.0, [0.0, 12.0], AcrossOrBehind),
            (Side::Right, 180.0, [15.0, 17.0], Untried),
            (Side::Rear, 0.0, [0.0, 22.0], AcrossOrBehind),
            (Side::Rear, 0.0, [-5.0, 22.0], Untried),
            (Side::Front, 180.0, [15.0, 12.0], Untried),
        ] {
            let found = tried(side, heading_deg, speeds_m_s);
            assert_eq!(found, expected, "{side:?} {heading_deg} {speeds_m_s:?}");
        }
    }
}
