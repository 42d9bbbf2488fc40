//! The force curve and impulse that physics and regressions predict for a collision. The network
//! learns corrections of this curve, which is therefore called the centre.

use serde::{Deserialize, Serialize};

use crate::force::physics::bare::BareForce;
use crate::force::physics::committee::Committee;
use crate::force::physics::crush_laws::{
    Bodies, NO_NAME, body_name, crush_scenario, fit_laws, struck_body_name,
};
use crate::force::{Centre, CrushConfig, ForceCase, ForceError, ForceScenario, MomentumModel};
use crate::learning::{FitSteps, LearningError, Split, TrainingProgress, folds};
use crate::nn::{Expected, NnError, check_length, check_number, check_numbers};
use impactlab_core::collision::crush::{CrushHistory, CrushLaw, CrushScenario};
use impactlab_core::collision::{Impact, PulseShape};
use impactlab_core::uncertainty::{CURVE_INTERVAL_S, CURVE_N_INSTANTS, ForceCurve};

/// Largest length of a side and width of a front, m.
const LONGEST_OUTLINE_M: Expected = Expected::Magnitude(3.0);
/// Largest distance of rear axle and rear end of the struck vehicle from its CG, m.
const LONGEST_TAIL_M: Expected = Expected::Magnitude(50.0);
/// Share of the peak below which a force does not count as contact.
const CONTACT_SHARE: f64 = 0.01;

/// The physics of one scenario on the time grid, in canonical axes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CentreCurve {
    /// Force and its duration.
    pub curve: ForceCurve,
    /// Largest overlap of the outlines, m; zero if the kind of centre does not compute it.
    pub depth_m: Vec<f64>,
    /// Sliding velocity at the contact, m/s; zero if the kind of centre does not compute it.
    pub slip_m_s: Vec<f64>,
    /// Impulse from which the impulse of the network departs by a bounded correction, N s.
    pub impulse_n_s: [f64; 2],
    /// Impulse of the momentum solution, N s.
    pub momentum_impulse_n_s: [f64; 2],
    /// Largest `|F|`, N: the unit of force of the network.
    pub scale_n: f64,
    /// Inverse mass matrix K at the contact point, 1/kg. With the closing velocity it gives the energy
    /// that an impulse absorbs.
    pub inverse_mass_1_kg: [[f64; 2]; 2],
    /// Velocity of the striking vehicle's contact point relative to the struck vehicle's, m/s.
    pub closing_velocity_m_s: [f64; 2],
}

impl CentreCurve {
    /// Checks a curve from a file.
    ///
    /// - `name`: its place in the metadata.
    ///
    /// # Errors
    /// [`NnError`] with the first number or list that is refused.
    pub(crate) fn check(&self, name: &str) -> Result<(), NnError> {
        let lists = [
            ("curve.fx_n", &self.curve.fx_n),
            ("curve.fy_n", &self.curve.fy_n),
            ("depth_m", &self.depth_m),
            ("slip_m_s", &self.slip_m_s),
        ];
        for (list, values) in lists {
            check_length(&format!("{name}.{list}"), values.len(), CURVE_N_INSTANTS)?;
        }
        check_number(&format!("{name}.scale_n"), self.scale_n, Expected::Positive)?;
        let duration = format!("{name}.curve.duration_s");
        check_number(&duration, self.curve.duration_s, Expected::NotNegative)
    }

    /// Time of the first force above 1 % of the peak, s.
    pub fn onset_s(&self) -> f64 {
        let magnitude = self.curve.magnitude_n();
        let is_contact = |force: &f64| *force > CONTACT_SHARE * self.scale_n;
        magnitude.iter().position(is_contact).unwrap_or(0) as f64 * CURVE_INTERVAL_S
    }
}

/// Force and contact of one crush law on the time grid.
struct CentreHistory {
    curve: ForceCurve,
    /// Zero if the kind of centre does not compute them.
    depth_m: Vec<f64>,
    slip_m_s: Vec<f64>,
}

impl CentreHistory {
    fn without_contact(curve: ForceCurve) -> Self {
        let none = vec![0.0; CURVE_N_INSTANTS];
        Self { curve, depth_m: none.clone(), slip_m_s: none }
    }
}

/// The physics fitted to training cases.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CentreModel {
    kind: Centre,
    /// One crush law for each fold, fitted to the cases outside of it.
    laws: Vec<CrushLaw>,
    /// The regression that is averaged with the crush model.
    committee: Option<Committee>,
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
    /// - `report`: called before each step of a fit; if it breaks, the fits end where they are.
    /// - returns the model and, for each training case, the curve of those parts of the model that
    ///   were fitted without the case.
    ///
    /// # Errors
    /// [`ForceError::Learning`] for too few cases, [`ForceError::NoCrushFit`], [`ForceError::Regression`],
    /// [`ForceError::Impact`].
    pub fn fit(
        cases: &[ForceCase],
        kind: Centre,
        config: CrushConfig,
        seed: u64,
        report: &mut TrainingProgress<'_>,
    ) -> Result<(Self, Vec<CentreCurve>), ForceError> {
        let n = cases.len();
        if n < config.folds {
            let least = config.folds;
            return Err(LearningError::TooFewCases { n_cases: n, least }.into());
        }
        let plain: Vec<&ForceCase> = cases.iter().filter(|case| case.is_clean()).collect();
        let plain = if plain.is_empty() { cases.iter().collect() } else { plain };
        let mean = |quantity: &dyn Fn(&ForceCase) -> f64| {
            cases.iter().map(quantity).sum::<f64>() / n as f64
        };
        let mut model = Self {
            kind,
            laws: Vec::new(),
            committee: None,
            duration_s: mean(&|case| case.curve.duration_s),
            peak_n: mean(&|case| case.peak_n),
            momentum: MomentumModel::fit(&plain, true),
        };
        let folds = folds(cases, config.folds, seed);
        let n_crush = if kind.has_crush() { folds.len() * config.max_steps } else { 0 };
        let n_regressions = if kind == Centre::Committee { folds.len() + 1 } else { 0 };
        let mut steps = FitSteps::new(report, false, n_crush + n_regressions);
        model.laws = fit_laws(cases, &folds, kind, config, &mut steps)?;
        let mut histories = model.unseen_histories(cases, &folds)?;
        if kind == Centre::Committee {
            let crush: Vec<ForceCurve> =
                histories.iter().map(|history| history.curve.clone()).collect();
            let mut on_fit = |fit: usize, n_fits: usize| {
                steps.name(format!("fitting regression {} of {n_fits}", fit + 1));
                steps.at(n_crush + fit, None)
            };
            let fitted = Committee::fit(cases, &folds, &crush, seed, &mut on_fit)?;
            if let Some((committee, curves)) = fitted {
                model.committee = Some(committee);
                for (history, curve) in histories.iter_mut().zip(curves) {
                    history.curve = curve;
                }
            }
        }
        let curve = |(case, history): (&ForceCase, CentreHistory)| {
            let (contact_m, _) = model.known(&case.scenario);
            model.centre_curve(history, &case.scenario, contact_m)
        };
        let unseen = cases.iter().zip(histories).map(curve).collect::<Result<_, _>>()?;
        Ok((model, unseen))
    }

    /// Checks the physics from a file.
    ///
    /// # Errors
    /// [`NnError`] with the first number or list that is refused.
    pub(crate) fn check(&self) -> Result<(), NnError> {
        if self.kind.has_crush() && self.laws.is_empty() {
            return Err(NnError::StoredLength {
                name: "centre.laws".to_owned(),
                expected: 1,
                got: 0,
            });
        }
        let bodies = self.bodies();
        for (i, law) in self.laws.iter().enumerate() {
            let name = format!("centre.laws[{i}]");
            check_length(&format!("{name}.bodies"), law.bodies.len(), bodies.len().max(1))?;
            let n_struck = self.struck_bodies().len();
            check_length(&format!("{name}.target_bodies"), law.struck_bodies.len(), n_struck)?;
            for (list, values, knots) in law.lists() {
                check_length(&format!("{name}.knots"), knots.len().min(1), 1)?;
                check_length(&format!("{name}.{list}"), values.len(), knots.len())?;
                let steps: Vec<f64> = knots.windows(2).map(|ends| ends[1] - ends[0]).collect();
                check_numbers(&format!("{name}.knots"), &steps, Expected::Positive)?;
            }
            let first = law.knots.depth_m.first().copied().unwrap_or_default();
            check_number(&format!("{name}.knots.depth_m[0]"), first, Expected::Magnitude(0.0))?;
            check_number(&format!("{name}.rear_axle_x_m"), law.rear_axle_x_m, LONGEST_TAIL_M)?;
            if let Some(rear_end_x_m) = law.rear_end_x_m {
                check_number(&format!("{name}.rear_end_x_m"), rear_end_x_m, LONGEST_TAIL_M)?;
                let overhang = format!("{name}.rear_axle_x_m - rear_end_x_m");
                check_number(&overhang, law.rear_axle_x_m - rear_end_x_m, Expected::Positive)?;
            }
            let outline = format!("{name}.knots.outline_m");
            check_numbers(&outline, &law.knots.side_and_front_m, Expected::Positive)?;
            check_numbers(&outline, &law.knots.side_and_front_m, LONGEST_OUTLINE_M)?;
            // Logarithms of stiffness reach 17, exponents 3 and positions a few metres.
            check_numbers(&name, &law.to_vector(), Expected::Magnitude(50.0))?;
            for (j, body) in law.bodies.iter().enumerate() {
                let nose = format!("{name}.bodies[{j}].nose");
                check_number(&format!("{nose}.radius_m"), body.nose.radius_m, Expected::Positive)?;
                let half_width = format!("{nose}.half_width_m");
                check_number(&half_width, body.nose.half_width_m, Expected::Positive)?;
            }
        }
        if let Some(committee) = &self.committee {
            committee.check("centre.committee")?;
        }
        check_number("centre.duration_s", self.duration_s, Expected::NotNegative)?;
        check_number("centre.peak_n", self.peak_n, Expected::NotNegative)?;
        self.momentum.check("centre.momentum")
    }

    /// The kinds of bodies of the striking vehicle in the training cases, in the order of their
    /// index.
    pub fn bodies(&self) -> Vec<String> {
        let bodies = self.laws.first().map(|law| law.bodies.as_slice()).unwrap_or_default();
        bodies.iter().map(|body| body.name.clone()).collect()
    }

    /// The kinds of bodies of the struck vehicle in the training cases, in the order of their index, with
    /// an empty name for cases that do not name it; none where there is one kind only.
    pub fn struck_bodies(&self) -> Vec<String> {
        let bodies = self.laws.first().map(|law| law.struck_bodies.as_slice()).unwrap_or_default();
        bodies.iter().map(|body| body.name.clone()).collect()
    }

    /// Position of the struck vehicle's rear axle in its body axes, m, from which contact offsets
    /// are measured.
    pub fn rear_axle_x_m(&self) -> f64 {
        self.laws.first().map_or(0.0, |law| law.rear_axle_x_m)
    }

    /// The physics of a scenario: the mean over all crush laws, averaged with the regression if there
    /// is one.
    ///
    /// - `scenario`: canonical.
    /// - `contact_m`, `bodies`: contact point and kinds of bodies, which the scenario may leave open.
    ///
    /// # Errors
    /// [`ForceError::Impact`], [`ForceError::Regression`].
    pub(crate) fn curve(
        &self,
        scenario: &ForceScenario,
        contact_m: [f64; 2],
        bodies: Bodies,
    ) -> Result<CentreCurve, ForceError> {
        let laws: Vec<&CrushLaw> = self.laws.iter().collect();
        let mut history = self.history(&laws, scenario, contact_m, bodies)?;
        if let Some(committee) = &self.committee {
            let name = |names: Vec<String>, idx: Option<usize>| {
                names.into_iter().nth(idx?).filter(|name| name != NO_NAME)
            };
            let known = ForceScenario {
                contact_m: Some(contact_m),
                striking_body: name(self.bodies(), Some(bodies.striking)),
                struck_body: name(self.struck_bodies(), bodies.struck),
                ..scenario.clone()
            };
            history.curve = committee.curve(&history.curve, &known)?;
        }
        self.centre_curve(history, scenario, contact_m)
    }

    /// What physics alone says of a scenario, without anything that was learned but the mean duration.
    ///
    /// - `scenario`: canonical;
    /// - `contact_m`: contact point, which the scenario may leave open.
    ///
    /// # Errors
    /// [`ForceError::Impact`].
    pub(crate) fn bare(
        &self,
        scenario: &ForceScenario,
        contact_m: [f64; 2],
    ) -> Result<BareForce, ForceError> {
        Ok(BareForce::new(&self.momentum, (scenario, contact_m), self.duration_s)?)
    }

    fn unseen_histories(
        &self,
        cases: &[ForceCase],
        folds: &[Split],
    ) -> Result<Vec<CentreHistory>, ForceError> {
        let law_of = |idx: usize| {
            let fold = folds.iter().position(|fold| fold.test.contains(&idx));
            fold.and_then(|fold| self.laws.get(fold)).or(self.laws.first())
        };
        let history = |(idx, case): (usize, &ForceCase)| {
            let laws: Vec<&CrushLaw> = law_of(idx).into_iter().collect();
            let (contact_m, bodies) = self.known(&case.scenario);
            self.history(&laws, &case.scenario, contact_m, bodies)
        };
        cases.iter().enumerate().map(history).collect()
    }

    /// Contact and bodies of a training case.
    fn known(&self, scenario: &ForceScenario) -> ([f64; 2], Bodies) {
        let contact = scenario.contact_m.unwrap_or([self.rear_axle_x_m(), 0.0]);
        let law = self.laws.first();
        let striking = law.and_then(|law| law.body_idx(body_name(scenario))).unwrap_or(0);
        let struck = law.and_then(|law| law.struck_body_idx(struck_body_name(scenario)));
        (contact, Bodies { striking, struck })
    }

    fn history(
        &self,
        laws: &[&CrushLaw],
        scenario: &ForceScenario,
        contact_m: [f64; 2],
        bodies: Bodies,
    ) -> Result<CentreHistory, ForceError> {
        Ok(match self.kind {
            Centre::Committee | Centre::Crush => {
                mean_history(laws, &crush_scenario(scenario, contact_m, bodies))
            }
            Centre::Momentum => {
                let momentum = self.impact(scenario, contact_m).solve()?.impulse_world_n_s;
                CentreHistory::without_contact(self.pulse(momentum))
            }
            Centre::None => CentreHistory::without_contact(self.nothing()),
        })
    }

    fn impact(&self, scenario: &ForceScenario, contact_m: [f64; 2]) -> Impact {
        let known = ForceScenario { contact_m: Some(contact_m), ..scenario.clone() };
        self.momentum.impact(&known)
    }

    /// The centre of a force history, with the quantities that follow from the momentum solution.
    fn centre_curve(
        &self,
        CentreHistory { curve, depth_m, slip_m_s }: CentreHistory,
        scenario: &ForceScenario,
        contact_m: [f64; 2],
    ) -> Result<CentreCurve, ForceError> {
        let impact = self.impact(scenario, contact_m);
        let has_force = self.kind != Centre::None;
        Ok(CentreCurve {
            depth_m,
            slip_m_s,
            impulse_n_s: match has_force {
                true => curve.impulse_n_s(),
                false => [0.0, self.peak_n * self.duration_s / 2.0],
            },
            momentum_impulse_n_s: impact.solve()?.impulse_world_n_s,
            scale_n: if has_force { curve.peak().0.max(1.0) } else { self.peak_n },
            inverse_mass_1_kg: impact.inverse_mass_1_kg(),
            closing_velocity_m_s: impact.relative_velocity_m_s(),
            curve,
        })
    }

    /// A haversine pulse of the mean duration with a given impulse.
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

/// The mean over the laws. Its duration lasts from the first to the last force above 1 % of the peak.
fn mean_history(laws: &[&CrushLaw], scenario: &CrushScenario) -> CentreHistory {
    let n = CURVE_N_INSTANTS;
    let histories: Vec<_> =
        laws.iter().filter_map(|law| law.simulate(scenario, n, CURVE_INTERVAL_S)).collect();
    let series = |column: fn(&CrushHistory) -> &[f64]| -> Vec<f64> {
        let at = |t: usize| histories.iter().filter_map(move |history| column(history).get(t));
        (0..n).map(|t| at(t).sum::<f64>() / histories.len().max(1) as f64).collect()
    };
    let mut curve = ForceCurve {
        fx_n: series(|history| &history.fx_n),
        fy_n: series(|history| &history.fy_n),
        duration_s: 0.0,
    };
    let (magnitude, peak_n) = (curve.magnitude_n(), curve.peak().0);
    let in_contact = |force: &f64| *force > CONTACT_SHARE * peak_n && peak_n > 0.0;
    let first = magnitude.iter().position(in_contact).unwrap_or(0);
    let last = magnitude.iter().rposition(in_contact).unwrap_or(0);
    curve.duration_s = (last + 1 - first) as f64 * CURVE_INTERVAL_S;
    CentreHistory {
        curve,
        depth_m: series(|history| &history.depth_m),
        slip_m_s: series(|history| &history.slip_m_s),
    }
}

#[cfg(test)]
pub(crate) mod tests {
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
