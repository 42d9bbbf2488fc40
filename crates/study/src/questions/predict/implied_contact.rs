//! The momentum solution beside a predicted impulse: both describe the same contact.

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::bands_of_draws;
use impactlab_core::collision::{Impact, ImpliedContact, ImpliedContacts, Regime, RestitutionForm};
use impactlab_core::numerics::random_stream;
use impactlab_core::units::{Estimate, NumberFormat, Phrase, PhraseValue};
use impactlab_core::vehicle::frames::{Heading, body_from_world};
use impactlab_networks::force::ForcePrediction;

/// Whole curves drawn from a predicted force, whose impulses imply restitution and impulse ratio.
const N_DRAWS: usize = 500;

/// Share of drawn impulses with a restitution between 0 and 1 below which a prediction is warned of.
pub(crate) const LEAST_P_RIGID: f64 = 0.5;

/// Share of drawn impulses that add energy above which a prediction is warned of.
pub(crate) const MOST_P_ENERGY_GAIN: f64 = 0.05;

/// The momentum solution of a collision: with which restitution and friction, and what it gives.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MomentumReport {
    /// Coefficient of restitution that was used.
    pub restitution: f64,
    /// What restitution acts on.
    pub restitution_form: RestitutionForm,
    /// Friction limit that was used, also where it is given as a share of the critical impulse
    /// ratio.
    pub friction_limit: f64,
    /// The smallest friction limit with which the vehicles do not slide; none if they do not
    /// approach, or slide whatever the friction.
    pub critical_impulse_ratio: Option<f64>,
    /// Whether the contact sticks or slides.
    pub regime: Regime,
    /// Impulse on the struck vehicle [x, y], N s; axes of the report.
    pub impulse_n_s: [f64; 2],
}

/// Restitution and impulse ratio with which the momentum solution would give a predicted impulse.
///
/// Both forms of restitution need the same restitution. The momentum solution gives the impulse if
/// the restitution lies between 0 and 1 and the ratio does not exceed the critical one.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ImpliedContactReport {
    /// Coefficient of restitution e.
    pub restitution: Estimate,
    /// Impulse ratio `P_τ / P_n`; the tangent is the normal turned to the left.
    pub impulse_ratio: Estimate,
    /// Share of the drawn impulses with a restitution between 0 and 1.
    pub p_rigid: f64,
    /// Share of the drawn impulses that would add kinetic energy to the two vehicles.
    pub p_energy_gain: f64,
    /// What is wrong with the predicted impulse, for a person: no contact of two bodies brings it
    /// about. This is so far outside of what the force network has learned from.
    pub warning: Option<String>,
    /// The momentum solution with the values of the collision.
    pub momentum: MomentumReport,
}

impl MomentumReport {
    /// The solution of an impact; `None` if it has none.
    ///
    /// - `heading_rad`: world angle of the x axis of the impulse.
    pub(crate) fn from_impact(impact: &Impact, heading_rad: f64) -> Option<Self> {
        let solution = impact.solve().ok()?;
        let surface = &impact.surface;
        Some(Self {
            restitution: surface.restitution,
            restitution_form: surface.restitution_form,
            friction_limit: surface.friction_limit,
            critical_impulse_ratio: impact.critical_impulse_ratio(),
            regime: solution.regime,
            impulse_n_s: body_from_world(heading_rad, solution.impulse_world_n_s),
        })
    }
}

impl ImpliedContactReport {
    /// What a predicted force implies; `None` if the impact has no solution, or if the force pulls
    /// the vehicles together.
    ///
    /// - `impact`: the impact in world axes;
    /// - `heading_rad`: heading of the struck vehicle, along which x of the predicted force lies;
    /// - `seed`: of the draws.
    pub(crate) fn from_prediction(
        prediction: &ForcePrediction,
        impact: &Impact,
        heading_rad: f64,
        seed: u64,
    ) -> Option<Self> {
        let mut rng = random_stream(seed, "implied contact", 0);
        let curves = prediction.mixture.sample(N_DRAWS, &mut rng);
        let heading = Heading::new(heading_rad);
        let impulses_world_n_s: Vec<[f64; 2]> =
            curves.iter().map(|curve| heading.world_from_body(curve.impulse_n_s())).collect();
        let ImpliedContacts { contacts, p_rigid, p_energy_gain } =
            impact.implied_contacts(&impulses_world_n_s);
        if contacts.is_empty() {
            return None;
        }
        let estimate = |value: fn(&ImpliedContact) -> f64| {
            bands_of_draws(contacts.iter().map(value).collect())
        };
        Some(Self {
            restitution: estimate(|contact| contact.restitution),
            impulse_ratio: estimate(|contact| contact.impulse_ratio),
            p_rigid,
            p_energy_gain,
            warning: warning(p_rigid, p_energy_gain),
            momentum: MomentumReport::from_impact(impact, heading_rad)?,
        })
    }
}

/// Names what the drawn impulses have against them, if they have.
fn warning(p_rigid: f64, p_energy_gain: f64) -> Option<String> {
    let is_wrong = p_rigid < LEAST_P_RIGID || p_energy_gain > MOST_P_ENERGY_GAIN;
    is_wrong.then(|| warning_phrase(p_rigid, p_energy_gain).say(&NumberFormat::default()))
}

/// What the drawn impulses have against them.
pub(crate) fn warning_phrase(p_rigid: f64, p_energy_gain: f64) -> Phrase {
    Phrase::new(
        "the predicted impulse is not that of a contact: {0} of it have a restitution between 0 \
         and 1, {1} would add kinetic energy; do not rely on it",
        "Der vorhergesagte Stoßantrieb ist nicht der eines Kontakts: {0} davon haben eine Stoßziffer \
         zwischen 0 und 1, {1} führten Bewegungsenergie zu. Er ist nicht verwertbar",
    )
    .with(PhraseValue::Share(p_rigid))
    .with(PhraseValue::Share(p_energy_gain))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use impactlab_core::collision::Scenario;
    use impactlab_core::vehicle::frames::world_from_body;
    use impactlab_networks::force::ForceScenario;
    use impactlab_networks::shipped::ModelSource;

    /// The medians, put into the solver, give the predicted impulse back, whichever way the struck
    /// vehicle heads.
    #[test]
    fn the_solver_with_the_implied_values_gives_the_predicted_impulse() {
        let model = ModelSource::Shipped.force_model().unwrap();
        let mut seen = Vec::new();
        for turn_rad in [0.0, FRAC_PI_2] {
            let mut scenario = Scenario::example();
            for vehicle in [&mut scenario.struck, &mut scenario.striking] {
                vehicle.heading_rad += turn_rad;
                let velocity_m_s = [vehicle.vx_world_m_s, vehicle.vy_world_m_s];
                [vehicle.vx_world_m_s, vehicle.vy_world_m_s] =
                    world_from_body(turn_rad, velocity_m_s);
            }
            let numbers = ForceScenario::from_scenario(&scenario).unwrap();
            let prediction = model.predict(&numbers).unwrap();
            let mut impact = scenario.impact().unwrap();
            let heading_rad = scenario.struck.heading_rad;
            let report =
                ImpliedContactReport::from_prediction(&prediction, &impact, heading_rad, 0)
                    .unwrap();
            assert!((report.momentum.restitution - impact.surface.restitution).abs() < 1e-12);
            impact.surface.restitution = report.restitution.median;
            impact.surface.friction_limit = report.impulse_ratio.median.abs();
            let [x, y] = body_from_world(heading_rad, impact.solve().unwrap().impulse_world_n_s);
            let [mean_x, mean_y] = [0, 1].map(|axis| prediction.mixture.impulse(axis).mean());
            let off = (x - mean_x).hypot(y - mean_y) / mean_x.hypot(mean_y);
            assert!(off < 0.05, "{off}: {report:?}");
            seen.push(report.restitution.median);
        }
        assert!((seen[0] - seen[1]).abs() < 1e-6, "{seen:?}");
    }
}
