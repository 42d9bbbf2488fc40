//! The crush laws of the centre curve: fitted to the cases outside of each fold.

use crate::force::{Centre, CrushConfig, ForceCase, ForceError, ForceScenario};
use crate::learning::{FitSteps, Split};
use impactlab_core::collision::crush::{
    BodyCrush, CrushFit, CrushKnots, CrushLaw, CrushSample, CrushScenario, Nose, StruckBodyCrush,
};
use impactlab_core::numerics::quantile_of_sorted;
use impactlab_core::uncertainty::CURVE_INTERVAL_S;

/// Yaw inertia over mass where none is known, m²: a uniform body of 4.5 m × 1.8 m has 1.96, cars
/// 1.5 to 2.1 (MacInnis et al., SAE 970951); the shipped runs have 1.8.
const YAW_INERTIA_PER_MASS_M2: f64 = 1.8;
/// From the rear axle of a car to its rear end, m, and from the hindmost point of contact at least.
const USUAL_REAR_END_M: f64 = -0.96;
const BEHIND_CONTACTS_M: f64 = 0.1;
/// Name of the body of cases that do not name it.
pub(super) const NO_NAME: &str = "";

fn yaw_inertia(scenario: &ForceScenario) -> [f64; 2] {
    [0, 1].map(|i| {
        scenario.yaw_inertia_kg_m2[i].unwrap_or(YAW_INERTIA_PER_MASS_M2 * scenario.mass_kg[i])
    })
}

pub(super) fn body_name(scenario: &ForceScenario) -> Option<&str> {
    Some(scenario.striking_body.as_deref().unwrap_or(NO_NAME))
}

pub(super) fn struck_body_name(scenario: &ForceScenario) -> &str {
    scenario.struck_body.as_deref().unwrap_or(NO_NAME)
}

/// Kinds of the bodies of both vehicles, by their indices among those that a model knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bodies {
    pub striking: usize,
    /// None where the model knows one kind only.
    pub struck: Option<usize>,
}

pub(super) fn crush_scenario(
    scenario: &ForceScenario,
    contact_m: [f64; 2],
    bodies: Bodies,
) -> CrushScenario {
    CrushScenario {
        mass_kg: scenario.mass_kg,
        yaw_inertia_kg_m2: yaw_inertia(scenario),
        relative_velocity_m_s: scenario.relative_velocity_m_s(),
        yaw_rate_rad_s: scenario.yaw_rate_rad_s,
        theta_b_rad: scenario.theta_b_rad,
        contact_m,
        body_idx: bodies.striking,
        struck_body_idx: bodies.struck,
    }
}

fn sample(case: &ForceCase, law: &CrushLaw, hooked_weight: f64) -> Option<CrushSample> {
    let contact_m = case.scenario.contact_m?;
    let bodies = Bodies {
        striking: law.body_idx(body_name(&case.scenario))?,
        struck: law.struck_body_idx(struck_body_name(&case.scenario)),
    };
    let weight = if case.is_clean() { 1.0 } else { hooked_weight };
    (weight > 0.0).then(|| CrushSample {
        scenario: crush_scenario(&case.scenario, contact_m, bodies),
        fx_n: case.curve.fx_n.clone(),
        fy_n: case.curve.fy_n.clone(),
        weight,
    })
}

/// The prior of the crush model with the bodies that the cases name, their noses from the points
/// of first contact, the median of the contacts for the rear axle, from which its fit starts, and a rear
/// end behind all of them.
fn prior_law(cases: &[ForceCase]) -> CrushLaw {
    let mut names: Vec<&str> = cases.iter().filter_map(|case| body_name(&case.scenario)).collect();
    names.sort_unstable();
    names.dedup();
    let knots = CrushKnots::default();
    let bodies = names.iter().map(|name| {
        let contacts: Vec<(f64, [f64; 2])> = cases
            .iter()
            .filter(|case| body_name(&case.scenario) == Some(*name))
            .filter_map(|case| nose_contact(&case.scenario))
            .collect();
        BodyCrush::prior(*name, Nose::fit(&contacts).unwrap_or_default(), &knots)
    });
    let mut struck: Vec<&str> = cases.iter().map(|case| struck_body_name(&case.scenario)).collect();
    struck.sort_unstable();
    struck.dedup();
    let struck = match struck.as_slice() {
        [_] => Vec::new(),
        names => names.iter().map(|name| StruckBodyCrush::prior(*name, &knots)).collect(),
    };
    let mut contacts: Vec<f64> =
        cases.iter().filter_map(|case| case.scenario.contact_m.map(|[x, _]| x)).collect();
    contacts.sort_by(f64::total_cmp);
    // Of the median, which a few contacts far ahead of the axle do not move.
    let middle = quantile_of_sorted(&contacts, 0.5).unwrap_or(0.0);
    let hindmost = contacts.first().copied().unwrap_or(middle);
    let rear_end = (middle + USUAL_REAR_END_M).min(hindmost - BEHIND_CONTACTS_M);
    CrushLaw::prior(bodies.collect(), struck, [middle, rear_end])
}

/// Angle of the struck vehicle's side against the striking vehicle, and where the striking vehicle
/// touches it in its own axes.
fn nose_contact(scenario: &ForceScenario) -> Option<(f64, [f64; 2])> {
    let ([x, y], [striking_x, striking_y]) = (scenario.contact_m?, scenario.striking_position_m?);
    let (sin, cos) = scenario.theta_b_rad.sin_cos();
    let [dx, dy] = [x - striking_x, y - striking_y];
    Some((scenario.theta_b_rad, [cos * dx + sin * dy, cos * dy - sin * dx]))
}

/// One crush law for each fold, fitted to the cases outside of it; none is fitted, and the prior
/// stands alone, if the kind of centre has no crush model.
pub(super) fn fit_laws(
    cases: &[ForceCase],
    folds: &[Split],
    kind: Centre,
    config: CrushConfig,
    steps: &mut FitSteps<'_, '_>,
) -> Result<Vec<CrushLaw>, ForceError> {
    let prior = prior_law(cases);
    if !kind.has_crush() {
        return Ok(vec![prior]);
    }
    let n_fits = folds.len();
    let settings = CrushFit {
        dt_s: CURVE_INTERVAL_S,
        prior_weight: config.prior_weight,
        impulse_weight: config.impulse_weight,
        max_steps: config.max_steps,
    };
    let law = |(fit, fold): (usize, &Split)| {
        let train = fold.train.iter().filter_map(|&idx| cases.get(idx));
        let samples: Vec<CrushSample> =
            train.filter_map(|case| sample(case, &prior, config.hooked_weight)).collect();
        let mut done = fit * config.max_steps;
        steps.name(format!("fitting crush law {} of {n_fits}", fit + 1));
        let mut on_fit = |cost| {
            let flow = steps.at(done, Some(cost));
            done += 1;
            flow
        };
        let law = prior.fit(&samples, settings, &mut on_fit);
        law.ok_or(ForceError::NoCrushFit { n_cases: samples.len() })
    };
    folds.iter().enumerate().map(law).collect()
}
