//! From a scenario to the distribution of its force history.

use candle_core::DType;
use rayon::prelude::*;

use crate::force::network::{OutsideTraining, features};
use crate::force::physics::CentreCurve;
use crate::force::train::{ForceModel, network_input};
use crate::force::{ForceError, ForceScenario};
use crate::uncertainty::{CURVE_N_INSTANTS, CurveComponent, CurveMixture, ForceCurve};

/// The prediction for a scenario, in the axes of this scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct ForcePrediction {
    /// Distribution of the force history and its duration.
    pub mixture: CurveMixture,
    /// The distribution under the condition that the vehicles hook, or that they do not, whichever is
    /// more likely. Point estimates are taken from it, since a mean over both kinds of collision would
    /// be similar to neither.
    pub likely: CurveMixture,
    /// The curve of the centre alone, as the mean over what the scenario leaves open.
    pub centre: ForceCurve,
    /// Impulse of the momentum solution, N s.
    pub momentum_impulse_n_s: [f64; 2],
    /// Probability that the vehicles hook; `None` for a model with a single component.
    pub hooking_probability: Option<f64>,
    /// Features of the scenario that lie outside the range of the training cases.
    pub outside: Vec<OutsideTraining>,
    /// Whether the contact point was left open and drawn from its distribution.
    pub is_contact_open: bool,
    /// Whether the bullet's body was left open and drawn from its distribution.
    pub is_body_open: bool,
}

/// A scenario with contact point and kind of body.
struct Variant {
    probability: f64,
    contact_m: [f64; 2],
    body_idx: usize,
}

impl ForceModel {
    /// Predicts the force of a scenario in any position. The network sees its canonical form, and the
    /// result is turned back.
    ///
    /// Contact point and body that the scenario leaves open are taken from their distribution over the
    /// training cases, and the result is the mixture over it.
    ///
    /// # Errors
    /// [`ForceError::Scenario`] for a number out of range, [`ForceError::UnknownBody`],
    /// [`ForceError::Impact`].
    pub fn predict(&self, scenario: &ForceScenario) -> Result<ForcePrediction, ForceError> {
        check(scenario)?;
        let (canonical, mirrored) = scenario.canonical();
        let variants = self.variants(&canonical)?;
        let n_bodies = self.bodies().len();
        let centre =
            |variant: &Variant| self.centre.curve(&canonical, variant.contact_m, variant.body_idx);
        let centres: Vec<CentreCurve> =
            variants.par_iter().map(centre).collect::<Result<_, _>>()?;
        let row = |(centre, variant): (&CentreCurve, &Variant)| {
            let known = (variant.contact_m, variant.body_idx, n_bodies);
            self.standardisation.apply(&features(&canonical, centre, known))
        };
        let rows = centres.iter().zip(&variants).map(row).collect();
        let number_type = (&self.config.network, DType::F32);
        let input = network_input((&centres, &self.residuals), rows, number_type)?;
        let output = self.network.forward_frozen(&input)?;
        let components = output.components(&centres)?.into_iter().zip(&variants);
        let components: Vec<CurveComponent> = components
            .flat_map(|(components, variant)| {
                components.into_iter().map(|component| CurveComponent {
                    weight: component.weight * variant.probability,
                    ..component
                })
            })
            .collect();
        let k = self.config.network.components;
        // The weights come from a softmax in f32, so that they sum to one to 1e-7 only.
        let total: f64 = components.iter().map(|c| c.weight).sum();
        let hooking = components.iter().skip(k - 1).step_by(k).map(|c| c.weight).sum::<f64>();
        let hooking = (hooking / total).clamp(0.0, 1.0);
        let mean = mean_curve(&centres, &variants);
        let momentum = [0, 1].map(|axis| {
            let part =
                |(c, v): (&CentreCurve, &Variant)| v.probability * c.momentum_impulse_n_s[axis];
            centres.iter().zip(&variants).map(part).sum::<f64>()
        });
        let sign = if mirrored { -1.0 } else { 1.0 };
        let is_hooking = |idx: usize| k > 1 && idx % k + 1 == k;
        let likely = components.iter().enumerate();
        let likely = likely.filter(|(idx, _)| is_hooking(*idx) == (k > 1 && hooking > 0.5));
        let likely = CurveMixture::new(likely.map(|(_, component)| component.clone()).collect())?;
        let [likely, mixture] = [likely, CurveMixture::new(components)?]
            .map(|mixture| self.record.detail.variance_factors.apply(mixture));
        Ok(ForcePrediction {
            mixture: if mirrored { mixture.mirrored() } else { mixture },
            likely: if mirrored { likely.mirrored() } else { likely },
            centre: if mirrored { mean.mirrored() } else { mean },
            momentum_impulse_n_s: [momentum[0], sign * momentum[1]],
            hooking_probability: (k > 1).then_some(hooking),
            outside: self.standardisation.outside(&canonical),
            is_contact_open: canonical.contact_m.is_none(),
            is_body_open: canonical.bullet_body.is_none() && n_bodies > 1,
        })
    }

    fn variants(&self, scenario: &ForceScenario) -> Result<Vec<Variant>, ForceError> {
        let names = self.bodies();
        let bodies: Vec<(usize, f64)> = match (&scenario.bullet_body, names.len()) {
            (_, 1) => vec![(0, 1.0)],
            (None, _) => self.open.body.iter().copied().enumerate().collect(),
            (Some(name), _) => match names.iter().position(|known| known == name) {
                Some(idx) => vec![(idx, 1.0)],
                None => {
                    return Err(ForceError::UnknownBody { name: name.clone(), known: names });
                }
            },
        };
        let contacts = match scenario.contact_m {
            Some(contact) => vec![contact],
            None => self.open.contact_m.clone(),
        };
        let share = 1.0 / contacts.len().max(1) as f64;
        let pairs = bodies.iter().flat_map(|&(body_idx, probability)| {
            contacts.iter().map(move |&contact_m| Variant {
                probability: probability * share,
                contact_m,
                body_idx,
            })
        });
        Ok(pairs.filter(|variant| variant.probability > 0.0).collect())
    }
}

fn mean_curve(centres: &[CentreCurve], variants: &[Variant]) -> ForceCurve {
    let mut sum = vec![0.0; 2 * CURVE_N_INSTANTS + 1];
    for (centre, variant) in centres.iter().zip(variants) {
        for (total, value) in sum.iter_mut().zip(centre.curve.to_values()) {
            *total += variant.probability * value;
        }
    }
    ForceCurve::from_values(&sum)
}

/// Checks the ranges within which the physics can be solved.
fn check(scenario: &ForceScenario) -> Result<(), ForceError> {
    let [target, bullet] = scenario.mass_kg;
    let [vx, vy] = scenario.relative_velocity_m_s();
    let within = |value: f64, low: f64, high: f64| (low..=high).contains(&value);
    let [x, y] = scenario.contact_m.unwrap_or_default();
    let checks = [
        ("target mass [kg]", target, within(target, 1.0, 1e8), "1 to 1e8"),
        ("bullet mass [kg]", bullet, within(bullet, 1.0, 1e8), "1 to 1e8"),
        ("v_bx − v_tx [m/s]", vx, within(vx, -150.0, 150.0), "-150 to 150"),
        ("v_by − v_ty [m/s]", vy, within(vy, -150.0, 150.0), "-150 to 150"),
        (
            "θ_b [rad]",
            scenario.theta_b_rad,
            within(scenario.theta_b_rad, -std::f64::consts::PI, std::f64::consts::PI),
            "-π to π",
        ),
        ("contact x [m]", x, within(x, -100.0, 100.0), "-100 to 100"),
        ("contact y [m]", y, within(y, -100.0, 100.0), "-100 to 100"),
    ];
    match checks.into_iter().find(|(_, _, is_good, _)| !is_good) {
        None => Ok(()),
        Some((name, value, _, expected)) => Err(ForceError::Scenario { name, value, expected }),
    }
}
