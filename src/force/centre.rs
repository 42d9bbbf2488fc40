//! What physics says of a collision before any network does: the curve on which the network is
//! centred, and its impulse.

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};

use crate::collision::PulseShape;
use crate::collision::crush::{BodyCrush, CrushFit, CrushLaw, CrushSample, CrushScenario, Nose};
use crate::force::{
    Centre, CrushConfig, ForceCase, ForceError, ForceScenario, MomentumModel, Split, folds,
};
use crate::uncertainty::{CURVE_INTERVAL_S, CURVE_N_INSTANTS, ForceCurve};

/// Yaw inertia over mass where none is known, m²: a uniform body of 4.5 m × 1.8 m has 1.96, cars
/// 1.5 to 2.1 (MacInnis et al., SAE 970951); the shipped runs have 1.8.
const YAW_INERTIA_PER_MASS_M2: f64 = 1.8;
/// Where the rear axle is if no case says, target's body axes, m: the middle of the contacts.
const NO_NAME: &str = "";
/// A force below this share of the peak is no contact.
const CONTACT_SHARE: f64 = 0.01;

/// The physics of one scenario, on the time grid. Canonical axes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CentreCurve {
    /// Force; its duration from the first to the last force above 1 % of the peak.
    pub curve: ForceCurve,
    /// Greatest overlap of the outlines, m; zero where the centre knows none.
    pub depth_m: Vec<f64>,
    /// Sliding velocity at the contact, m/s; zero where the centre knows none.
    pub slip_m_s: Vec<f64>,
    /// Impulse to which the network's is tied, N s.
    pub impulse_n_s: [f64; 2],
    /// Impulse of the momentum solution, N s.
    pub momentum_impulse_n_s: [f64; 2],
    /// Largest `|F|`, N: the unit of force of the network.
    pub scale_n: f64,
    /// Inverse mass K at the contact, 1/kg, and closing velocity there, m/s: energy of an impulse.
    pub inverse_mass_1_kg: [[f64; 2]; 2],
    /// Velocity of the bullet's contact point relative to the target's, m/s.
    pub closing_velocity_m_s: [f64; 2],
}

impl CentreCurve {
    /// The first force above 1 % of the peak, s.
    pub fn onset_s(&self) -> f64 {
        let magnitude = self.curve.magnitude_n();
        let is_contact = |force: &f64| *force > CONTACT_SHARE * self.scale_n;
        magnitude.iter().position(is_contact).unwrap_or(0) as f64 * CURVE_INTERVAL_S
    }
}

/// The fitted physics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CentreModel {
    kind: Centre,
    /// One per fold, each fitted without it.
    laws: Vec<CrushLaw>,
    /// Mean contact duration of the training cases, s.
    duration_s: f64,
    /// Mean peak of the training cases, N.
    peak_n: f64,
    /// The momentum solution, fitted on the training cases.
    momentum: MomentumModel,
}

impl CentreModel {
    /// Fits the physics on training cases.
    ///
    /// - `report`: fold and cost of each accepted step; breaking ends the fits where they are.
    /// - returns the model and, for each training case, the curve of a law that has not seen it.
    ///
    /// # Errors
    /// [`ForceError::TooFewCases`], [`ForceError::NoCrushFit`], [`ForceError::Impact`].
    pub fn fit(
        cases: &[ForceCase],
        (kind, config): (Centre, CrushConfig),
        seed: u64,
        report: &mut dyn FnMut(usize, f64) -> ControlFlow<()>,
    ) -> Result<(Self, Vec<CentreCurve>), ForceError> {
        let n = cases.len();
        if n < config.folds {
            return Err(ForceError::TooFewCases { n_cases: n, least: config.folds });
        }
        let plain: Vec<&ForceCase> = cases.iter().filter(|case| case.is_clean()).collect();
        let plain = if plain.is_empty() { cases.iter().collect() } else { plain };
        let mean = |of: &dyn Fn(&ForceCase) -> f64| cases.iter().map(of).sum::<f64>() / n as f64;
        let mut model = Self {
            kind,
            laws: Vec::new(),
            duration_s: mean(&|case| case.curve.duration_s),
            peak_n: mean(&|case| case.peak_n),
            momentum: MomentumModel::fit(&plain, true),
        };
        let prior = prior_law(cases);
        let folds = folds(cases, config.folds, seed);
        for (i, fold) in folds.iter().enumerate().filter(|_| kind == Centre::Crush) {
            let samples: Vec<CrushSample> = fold
                .train
                .iter()
                .filter_map(|&idx| cases.get(idx))
                .filter_map(|case| sample(case, &prior, config.hooked_weight))
                .collect();
            let settings = CrushFit {
                dt_s: CURVE_INTERVAL_S,
                prior_weight: config.prior_weight,
                impulse_weight: config.impulse_weight,
                max_steps: config.max_steps,
            };
            let law = prior.fit(&samples, settings, &mut |cost| report(i, cost));
            model.laws.push(law.ok_or(ForceError::NoCrushFit { n_cases: samples.len() })?);
        }
        if model.laws.is_empty() {
            model.laws.push(prior);
        }
        let unseen = model.unseen_curves(cases, &folds)?;
        Ok((model, unseen))
    }

    /// The kinds of bullet bodies that were seen, in the order of their index.
    pub fn bodies(&self) -> Vec<String> {
        let bodies = self.laws.first().map(|law| law.bodies.as_slice()).unwrap_or_default();
        bodies.iter().map(|body| body.name.clone()).collect()
    }

    /// The rear axle of the target, body axes, m: contact offsets count from it.
    pub fn rear_axle_x_m(&self) -> f64 {
        self.laws.first().map_or(0.0, |law| law.rear_axle_x_m)
    }

    /// The physics of a scenario: the mean over all laws.
    ///
    /// - `scenario`: canonical.
    /// - `contact_m`, `body_idx`: what the scenario may leave open.
    ///
    /// # Errors
    /// [`ForceError::Impact`].
    pub fn curve(
        &self,
        scenario: &ForceScenario,
        contact_m: [f64; 2],
        body_idx: usize,
    ) -> Result<CentreCurve, ForceError> {
        let laws: Vec<&CrushLaw> = self.laws.iter().collect();
        self.curve_of(&laws, scenario, (contact_m, body_idx))
    }

    fn unseen_curves(
        &self,
        cases: &[ForceCase],
        folds: &[Split],
    ) -> Result<Vec<CentreCurve>, ForceError> {
        let law_of = |idx: usize| {
            let fold = folds.iter().position(|fold| fold.test.contains(&idx));
            fold.and_then(|fold| self.laws.get(fold)).or(self.laws.first())
        };
        let curve = |(idx, case): (usize, &ForceCase)| {
            let laws: Vec<&CrushLaw> = law_of(idx).into_iter().collect();
            let known = self.known(&case.scenario);
            self.curve_of(&laws, &case.scenario, known)
        };
        cases.iter().enumerate().map(curve).collect()
    }

    /// Contact and body of a training case.
    fn known(&self, scenario: &ForceScenario) -> ([f64; 2], usize) {
        let contact = scenario.contact_m.unwrap_or([self.rear_axle_x_m(), 0.0]);
        let body = self.laws.first().and_then(|law| law.body_idx(body_name(scenario)));
        (contact, body.unwrap_or(0))
    }

    fn curve_of(
        &self,
        laws: &[&CrushLaw],
        scenario: &ForceScenario,
        (contact_m, body_idx): ([f64; 2], usize),
    ) -> Result<CentreCurve, ForceError> {
        let known = ForceScenario { contact_m: Some(contact_m), ..scenario.clone() };
        let impact = self.momentum.impact(&known);
        let momentum = impact.solve()?.impulse_n_s;
        let n = CURVE_N_INSTANTS;
        let (mut curve, mut depth_m, mut slip_m_s) = match self.kind {
            Centre::Crush => mean_history(laws, &crush_scenario(scenario, contact_m, body_idx)),
            Centre::Momentum => (self.pulse(momentum), vec![0.0; n], vec![0.0; n]),
            Centre::None => (self.nothing(), vec![0.0; n], vec![0.0; n]),
        };
        depth_m.resize(n, 0.0);
        slip_m_s.resize(n, 0.0);
        let peak = curve.peak().0;
        let magnitude = curve.magnitude_n();
        let in_contact = |force: &f64| *force > CONTACT_SHARE * peak && peak > 0.0;
        let first = magnitude.iter().position(in_contact).unwrap_or(0);
        let last = magnitude.iter().rposition(in_contact).unwrap_or(0);
        curve.duration_s = match self.kind {
            Centre::None => self.duration_s,
            _ => (last + 1 - first) as f64 * CURVE_INTERVAL_S,
        };
        let impulse_n_s = match self.kind {
            Centre::Crush => curve.impulse_n_s(),
            Centre::Momentum => momentum,
            Centre::None => [0.0, self.peak_n * self.duration_s / 2.0],
        };
        let scale_n = if self.kind == Centre::None { self.peak_n } else { peak.max(1.0) };
        Ok(CentreCurve {
            depth_m,
            slip_m_s,
            impulse_n_s,
            momentum_impulse_n_s: momentum,
            scale_n,
            inverse_mass_1_kg: impact.inverse_mass_1_kg(),
            closing_velocity_m_s: impact.relative_velocity_m_s(),
            curve,
        })
    }

    /// A haversine of the mean duration that carries an impulse.
    fn pulse(&self, [px, py]: [f64; 2]) -> ForceCurve {
        let shape = |i: usize| {
            let at = (i as f64 + 0.5) * CURVE_INTERVAL_S / self.duration_s;
            PulseShape::Haversine.density(at) / self.duration_s
        };
        let force = |p: f64| (0..CURVE_N_INSTANTS).map(|i| p * shape(i)).collect();
        ForceCurve { fx_n: force(px), fy_n: force(py), duration_s: self.duration_s }
    }

    fn nothing(&self) -> ForceCurve {
        let none = vec![0.0; CURVE_N_INSTANTS];
        ForceCurve { fx_n: none.clone(), fy_n: none, duration_s: self.duration_s }
    }
}

fn yaw_inertia(scenario: &ForceScenario) -> [f64; 2] {
    [0, 1].map(|i| {
        scenario.yaw_inertia_kg_m2[i].unwrap_or(YAW_INERTIA_PER_MASS_M2 * scenario.mass_kg[i])
    })
}

fn body_name(scenario: &ForceScenario) -> Option<&str> {
    Some(scenario.bullet_body.as_deref().unwrap_or(NO_NAME))
}

fn crush_scenario(scenario: &ForceScenario, contact_m: [f64; 2], body_idx: usize) -> CrushScenario {
    CrushScenario {
        mass_kg: scenario.mass_kg,
        yaw_inertia_kg_m2: yaw_inertia(scenario),
        relative_velocity_m_s: scenario.relative_velocity_m_s(),
        theta_b_rad: scenario.theta_b_rad,
        contact_m,
        body_idx,
    }
}

fn sample(case: &ForceCase, law: &CrushLaw, hooked_weight: f64) -> Option<CrushSample> {
    let contact_m = case.scenario.contact_m?;
    let body_idx = law.body_idx(body_name(&case.scenario))?;
    let weight = if case.is_clean() { 1.0 } else { hooked_weight };
    (weight > 0.0).then(|| CrushSample {
        scenario: crush_scenario(&case.scenario, contact_m, body_idx),
        fx_n: case.curve.fx_n.clone(),
        fy_n: case.curve.fy_n.clone(),
        weight,
    })
}

/// The prior of the crush model with the bodies that the cases name, their noses from the points
/// of first contact, and the middle of the contacts for the rear axle.
fn prior_law(cases: &[ForceCase]) -> CrushLaw {
    let mut names: Vec<&str> = cases.iter().filter_map(|case| body_name(&case.scenario)).collect();
    names.sort_unstable();
    names.dedup();
    let bodies = names.iter().map(|name| {
        let contacts: Vec<(f64, [f64; 2])> = cases
            .iter()
            .filter(|case| body_name(&case.scenario) == Some(*name))
            .filter_map(|case| nose_contact(&case.scenario))
            .collect();
        BodyCrush::prior(*name, Nose::fit(&contacts).unwrap_or_default())
    });
    let contacts: Vec<f64> =
        cases.iter().filter_map(|case| case.scenario.contact_m.map(|[x, _]| x)).collect();
    let (low, high) = contacts
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    let middle = if low.is_finite() { (low + high) / 2.0 } else { 0.0 };
    CrushLaw::prior(bodies.collect(), middle)
}

/// Angle of the target's side against the bullet, and where the bullet touches it in its own axes.
fn nose_contact(scenario: &ForceScenario) -> Option<(f64, [f64; 2])> {
    let ([x, y], [bullet_x, bullet_y]) = (scenario.contact_m?, scenario.bullet_position_m?);
    let (sin, cos) = scenario.theta_b_rad.sin_cos();
    let [dx, dy] = [x - bullet_x, y - bullet_y];
    Some((scenario.theta_b_rad, [cos * dx + sin * dy, cos * dy - sin * dx]))
}

/// The mean over the laws of force, depth and slip.
fn mean_history(laws: &[&CrushLaw], scenario: &CrushScenario) -> (ForceCurve, Vec<f64>, Vec<f64>) {
    let n = CURVE_N_INSTANTS;
    let histories: Vec<_> =
        laws.iter().filter_map(|law| law.simulate(scenario, n, CURVE_INTERVAL_S)).collect();
    let mean = |of: &dyn Fn(usize) -> Option<f64>| -> f64 {
        (0..histories.len()).filter_map(of).sum::<f64>() / histories.len().max(1) as f64
    };
    let series = |which: usize| -> Vec<f64> {
        (0..n)
            .map(|t| {
                mean(&|i| {
                    let history = histories.get(i)?;
                    let row = [&history.fx_n, &history.fy_n, &history.depth_m, &history.slip_m_s];
                    row[which].get(t).copied()
                })
            })
            .collect()
    };
    let curve = ForceCurve { fx_n: series(0), fy_n: series(1), duration_s: 0.0 };
    (curve, series(2), series(3))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A haversine along y from the first instant on.
    pub(crate) fn haversine_centre(duration_s: f64, peak_n: f64) -> CentreCurve {
        let n = CURVE_N_INSTANTS;
        let force = |i: usize| {
            let share = (i as f64 + 0.5) * CURVE_INTERVAL_S / duration_s;
            peak_n * PulseShape::Haversine.density(share) / PulseShape::Haversine.density(0.5)
        };
        let fy_n: Vec<f64> = (0..n).map(force).collect();
        let curve = ForceCurve { fx_n: vec![0.0; n], fy_n, duration_s };
        CentreCurve {
            impulse_n_s: curve.impulse_n_s(),
            momentum_impulse_n_s: curve.impulse_n_s(),
            scale_n: peak_n,
            depth_m: vec![0.0; n],
            slip_m_s: vec![0.0; n],
            inverse_mass_1_kg: [[1e-3, 0.0], [0.0, 1e-3]],
            closing_velocity_m_s: [0.0, 3.0],
            curve,
        }
    }
}
