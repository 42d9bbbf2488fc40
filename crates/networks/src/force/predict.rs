//! From a scenario to the distribution of its force history.

use candle_core::DType;
use rayon::prelude::*;

use crate::force::network::{OutsideTraining, features};
use crate::force::physics::{BareForce, Bodies, CentreCurve};
use crate::force::train::{ForceModel, network_input};
use crate::force::{ForceError, ForceScenario};
use impactlab_core::uncertainty::{
    CURVE_N_INSTANTS, Caveat, CaveatKind, CurveComponent, CurveMixture, ForceCurve,
};
use impactlab_core::units::{Phrase, PhraseValue};

/// Name of the applicability of a force network in a caveat.
pub const SHARE_OF_NETWORK: &str = "applicability of the force network";

/// Largest and smallest number of pulses that stand for the physics alone, for each contact point.
const N_BARE: [usize; 2] = [48, 8];

/// The prediction for a scenario, in the axes of this scenario.
///
/// Outside of what the network has learned from, its distribution is mixed with that of the physics
/// alone:
///
/// ```text
/// p(F) = a p_network(F) + (1 − a) p_physics(F)
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ForcePrediction {
    /// Distribution of the force history and its duration.
    pub mixture: CurveMixture,
    /// The part of it that the network has learned; `None` where it says nothing.
    pub learned: Option<CurveMixture>,
    /// The part of it that is the physics alone; `None` where the network applies fully, and where the
    /// vehicles do not approach each other.
    pub bare: Option<CurveMixture>,
    /// The distribution under the condition that the vehicles hook, or that they do not, whichever is
    /// more likely. Point estimates are taken from it, since a mean over both kinds of collision would
    /// be similar to neither.
    pub likely: CurveMixture,
    /// The curve of the centre alone, as the mean over what the scenario leaves open; the pulse of the
    /// physics alone where the network says nothing.
    pub centre: ForceCurve,
    /// Impulse of the momentum solution, N s.
    pub momentum_impulse_n_s: [f64; 2],
    /// Probability that the vehicles hook; `None` for a model with a single component, and where the
    /// network says nothing.
    pub hooking_probability: Option<f64>,
    /// Applicability a of the network, 0 to 1: the mean over what the scenario leaves open.
    pub applicability: f64,
    /// Features of the scenario that lie outside the range of the training cases.
    pub outside: Vec<OutsideTraining>,
    /// What restricts the prediction.
    pub caveats: Vec<Caveat>,
    /// Whether the contact point was left open and drawn from its distribution.
    pub is_contact_open: bool,
    /// Whether the striking vehicle's body was left open, or is none that the model knows, and was drawn
    /// from its distribution.
    pub is_body_open: bool,
    /// Likewise of the struck vehicle's body.
    pub is_struck_body_open: bool,
}

/// A scenario with contact point and kinds of bodies.
struct Variant {
    probability: f64,
    contact_m: [f64; 2],
    bodies: Bodies,
    /// Applicability of the network, 0 to 1.
    applicability: f64,
}

/// The prediction of the network, of the physics alone, or of both for a canonical scenario.
struct CanonicalPrediction {
    mixture: CurveMixture,
    likely: CurveMixture,
    centre: ForceCurve,
    momentum_impulse_n_s: [f64; 2],
    hooking_probability: Option<f64>,
}

impl ForceModel {
    /// Predicts the force of a scenario in any position. The network sees its canonical form, and the
    /// result is turned back.
    ///
    /// Contact point and bodies that the scenario leaves open are taken from their distributions over the
    /// training cases, each independently of the others, and the result is the mixture over them.
    ///
    /// # Errors
    /// [`ForceError::Scenario`] for a number out of range, [`ForceError::Impact`].
    pub fn predict(&self, scenario: &ForceScenario) -> Result<ForcePrediction, ForceError> {
        check(scenario)?;
        let (canonical, mirrored) = scenario.canonical();
        let variants = self.variants(&canonical);
        let applicability = share_of_network(&variants);
        let is_inside = applicability == 1.0;
        let (prediction, learned, bare) = match (is_inside, applicability > 0.0) {
            (true, _) => {
                let network = self.predict_by_network(&canonical, &variants)?;
                let learned = Some(network.mixture.clone());
                (network, learned, None)
            }
            (false, true) => {
                let network = self.predict_by_network(&canonical, &variants)?;
                let learned = Some(network.mixture.clone());
                let bare = self.predict_by_physics(&canonical, &variants)?;
                let mixed = network.mixed(applicability, &bare.0)?;
                (mixed, learned, Some((bare.0.mixture, bare.1)))
            }
            (false, false) => {
                let (bare, is_approaching) = self.predict_by_physics(&canonical, &variants)?;
                let mixture = bare.mixture.clone();
                (bare, None, Some((mixture, is_approaching)))
            }
        };
        let outside = self.domain.outside(&canonical);
        let is_approaching = bare.as_ref().map(|(_, is_approaching)| *is_approaching);
        let mut caveats = caveats(applicability, &outside, is_approaching);
        caveats.extend(self.caveats_of_bodies(&canonical));
        let turned = |mixture: CurveMixture| if mirrored { mixture.mirrored() } else { mixture };
        let [px, py] = prediction.momentum_impulse_n_s;
        Ok(ForcePrediction {
            mixture: turned(prediction.mixture),
            learned: learned.map(turned),
            bare: bare.filter(|(_, is_approaching)| *is_approaching).map(|bare| turned(bare.0)),
            likely: turned(prediction.likely),
            centre: if mirrored { prediction.centre.mirrored() } else { prediction.centre },
            momentum_impulse_n_s: [px, if mirrored { -py } else { py }],
            hooking_probability: prediction.hooking_probability,
            applicability,
            outside,
            caveats,
            is_contact_open: canonical.contact_m.is_none(),
            is_body_open: self.is_body_open(&canonical),
            is_struck_body_open: self.is_struck_body_open(&canonical),
        })
    }

    /// How far the network applies to a scenario, 0 to 1: that of [`ForceModel::predict`], without the
    /// prediction.
    ///
    /// # Errors
    /// [`ForceError::Scenario`] for a number out of range.
    pub fn applicability(&self, scenario: &ForceScenario) -> Result<f64, ForceError> {
        check(scenario)?;
        let (canonical, _) = scenario.canonical();
        Ok(share_of_network(&self.variants(&canonical)))
    }

    /// What the network has learned of the force of a scenario, however far it applies:
    /// [`ForcePrediction::learned`] alone.
    ///
    /// # Errors
    /// As for [`ForceModel::predict`].
    pub fn learned(&self, scenario: &ForceScenario) -> Result<CurveMixture, ForceError> {
        check(scenario)?;
        let (canonical, mirrored) = scenario.canonical();
        let learned = self.predict_by_network(&canonical, &self.variants(&canonical))?.mixture;
        Ok(if mirrored { learned.mirrored() } else { learned })
    }

    /// The prediction of the network alone.
    fn predict_by_network(
        &self,
        canonical: &ForceScenario,
        variants: &[Variant],
    ) -> Result<CanonicalPrediction, ForceError> {
        let n_bodies = [self.bodies().len(), self.struck_bodies().len()];
        let centre =
            |variant: &Variant| self.centre.curve(canonical, variant.contact_m, variant.bodies);
        let centres: Vec<CentreCurve> =
            variants.par_iter().map(centre).collect::<Result<_, _>>()?;
        let row = |(centre, variant): (&CentreCurve, &Variant)| {
            self.standardisation.apply(&features(
                canonical,
                centre,
                variant.contact_m,
                variant.bodies,
                n_bodies,
            ))
        };
        let rows = centres.iter().zip(variants).map(row).collect();
        let input =
            network_input(&centres, &self.residuals, rows, &self.config.network, DType::F32)?;
        let output = self.network.forward_frozen(&input)?;
        let components = output.components(&centres)?.into_iter().zip(variants);
        let components: Vec<CurveComponent> = components
            .flat_map(|(components, variant)| {
                let distance = self.domain.distance(canonical, variant.contact_m);
                let factors = self.record.detail.variance_factors.at(distance);
                components.into_iter().map(move |mut component| {
                    component.weight *= variant.probability;
                    factors.widen(&mut component);
                    component
                })
            })
            .collect();
        let k = self.config.network.components;
        // The weights come from a softmax in f32, so that they sum to one to 1e-7 only.
        let total: f64 = components.iter().map(|c| c.weight).sum();
        let hooking = components.iter().skip(k - 1).step_by(k).map(|c| c.weight).sum::<f64>();
        let hooking = (hooking / total).clamp(0.0, 1.0);
        let momentum_impulse_n_s = [0, 1].map(|axis| {
            let part =
                |(c, v): (&CentreCurve, &Variant)| v.probability * c.momentum_impulse_n_s[axis];
            centres.iter().zip(variants).map(part).sum::<f64>()
        });
        let is_hooking = |idx: usize| k > 1 && idx % k + 1 == k;
        let likely = components.iter().enumerate();
        let likely = likely.filter(|(idx, _)| is_hooking(*idx) == (k > 1 && hooking > 0.5));
        let likely = CurveMixture::new(likely.map(|(_, component)| component.clone()).collect())?;
        let mixture = CurveMixture::new(components)?;
        let curves = centres.iter().map(|centre| &centre.curve);
        Ok(CanonicalPrediction {
            mixture,
            likely,
            centre: mean_curve(curves.zip(variants.iter().map(|variant| variant.probability))),
            momentum_impulse_n_s,
            hooking_probability: (k > 1).then_some(hooking),
        })
    }

    /// What is left without the network, and whether the vehicles approach each other. The kinds of the
    /// bodies play no part in it.
    fn predict_by_physics(
        &self,
        canonical: &ForceScenario,
        variants: &[Variant],
    ) -> Result<(CanonicalPrediction, bool), ForceError> {
        let mut contacts: Vec<([f64; 2], f64)> = Vec::new();
        for variant in variants {
            let share = variant.probability;
            match contacts.iter_mut().find(|(contact_m, _)| *contact_m == variant.contact_m) {
                Some((_, total)) => *total += share,
                None => contacts.push((variant.contact_m, share)),
            }
        }
        let [most, least] = N_BARE;
        let n = (most / contacts.len().max(1)).max(least);
        let bare = |(contact_m, share): &([f64; 2], f64)| {
            Ok((self.centre.bare(canonical, *contact_m)?, *share))
        };
        let bare: Vec<(BareForce, f64)> =
            contacts.iter().map(bare).collect::<Result<_, ForceError>>()?;
        let components = bare.iter().flat_map(|(force, share)| force.components(n, *share));
        let mixture = CurveMixture::new(components.collect())?;
        let curves: Vec<(ForceCurve, f64)> =
            bare.iter().map(|(force, share)| (force.curve(), *share)).collect();
        let momentum_impulse_n_s = [0, 1]
            .map(|axis| bare.iter().map(|(force, share)| share * force.impulse_n_s[axis]).sum());
        let prediction = CanonicalPrediction {
            likely: mixture.clone(),
            mixture,
            centre: mean_curve(curves.iter().map(|(curve, share)| (curve, *share))),
            momentum_impulse_n_s,
            hooking_probability: None,
        };
        Ok((prediction, bare.iter().any(|(force, _)| force.is_approaching)))
    }

    /// Index of the body of a scenario among those that the model knows; `None` if it is left open or is
    /// another one.
    fn body_idx(&self, scenario: &ForceScenario) -> Option<usize> {
        let name = scenario.striking_body.as_ref()?;
        self.bodies().iter().position(|known| known == name)
    }

    /// Likewise of the struck vehicle.
    fn struck_body_idx(&self, scenario: &ForceScenario) -> Option<usize> {
        let name = scenario.struck_body.as_ref()?;
        self.struck_bodies().iter().position(|known| known == name)
    }

    /// Whether a prediction draws the body of the striking vehicle: the model knows several kinds, and the
    /// scenario names none of them.
    pub fn is_body_open(&self, scenario: &ForceScenario) -> bool {
        self.body_idx(scenario).is_none() && self.bodies().len() > 1
    }

    /// Likewise of the struck vehicle.
    pub fn is_struck_body_open(&self, scenario: &ForceScenario) -> bool {
        self.struck_body_idx(scenario).is_none() && !self.struck_bodies().is_empty()
    }

    /// What is said of bodies that the model does not know, if those that it has learned from have names.
    fn caveats_of_bodies(&self, scenario: &ForceScenario) -> impl Iterator<Item = Caveat> {
        let of_striking = Phrase::new(
            "the body of the striking vehicle, {0}, is none of those that the network knows \
             ({1}): it is left open",
            "Der Aufbau des stoßenden Fahrzeugs, {0}, gehört nicht zu denen, die das Netz kennt ({1}): \
             Er bleibt offen",
        );
        let of_struck = Phrase::new(
            "the body of the struck vehicle, {0}, is none of those that the network knows ({1}): \
             it is left open",
            "Der Aufbau des gestoßenen Fahrzeugs, {0}, gehört nicht zu denen, die das Netz kennt ({1}): \
             Er bleibt offen",
        );
        let striking =
            scenario.striking_body.as_ref().filter(|_| self.body_idx(scenario).is_none());
        let struck =
            scenario.struck_body.as_ref().filter(|_| self.struck_body_idx(scenario).is_none());
        let caveat = |name: Option<&String>, known: Vec<String>, text: Phrase| {
            let known: Vec<String> = known.into_iter().filter(|name| !name.is_empty()).collect();
            let name = name.filter(|_| !known.is_empty())?;
            let text = text
                .with(PhraseValue::Name(format!("{name:?}")))
                .with(PhraseValue::Name(known.join(", ")));
            Some(Caveat::new(CaveatKind::OutsideDomain, text))
        };
        let caveats = [
            caveat(striking, self.bodies(), of_striking),
            caveat(struck, self.struck_bodies(), of_struck),
        ];
        caveats.into_iter().flatten()
    }

    fn variants(&self, scenario: &ForceScenario) -> Vec<Variant> {
        let bodies: Vec<(usize, f64)> = match self.body_idx(scenario) {
            Some(idx) => vec![(idx, 1.0)],
            None if self.bodies().len() == 1 => vec![(0, 1.0)],
            None => self.open.body.iter().copied().enumerate().collect(),
        };
        let struck: Vec<(Option<usize>, f64)> = match self.struck_body_idx(scenario) {
            Some(idx) => vec![(Some(idx), 1.0)],
            None if self.open.struck_body.is_empty() => vec![(None, 1.0)],
            None => self
                .open
                .struck_body
                .iter()
                .enumerate()
                .map(|(i, share)| (Some(i), *share))
                .collect(),
        };
        let contacts = match scenario.contact_m {
            Some(contact) => vec![contact],
            None => self.open.contact_m.clone(),
        };
        let share = 1.0 / contacts.len().max(1) as f64;
        let kinds = bodies.iter().flat_map(|&(striking, probability)| {
            struck
                .iter()
                .map(move |&(struck, share)| (Bodies { striking, struck }, probability * share))
        });
        let variants = kinds.flat_map(|(bodies, probability)| {
            contacts.iter().map(move |&contact_m| Variant {
                probability: probability * share,
                contact_m,
                bodies,
                applicability: self.domain.applicability(scenario, contact_m),
            })
        });
        variants.filter(|variant| variant.probability > 0.0).collect()
    }
}

impl CanonicalPrediction {
    /// What the network and the physics alone say together.
    ///
    /// - `share`: of the network.
    fn mixed(self, share: f64, bare: &Self) -> Result<Self, ForceError> {
        let mix = |network: CurveMixture, bare: &CurveMixture| {
            CurveMixture::merge(vec![(share, network), (1.0 - share, bare.clone())])
        };
        Ok(Self {
            mixture: mix(self.mixture, &bare.mixture)?,
            likely: mix(self.likely, &bare.likely)?,
            ..self
        })
    }
}

/// Mean of the applicability over what a scenario leaves open; exactly 1 where it is that throughout.
fn share_of_network(variants: &[Variant]) -> f64 {
    if variants.iter().all(|variant| variant.applicability == 1.0) {
        return 1.0;
    }
    let share = variants.iter().map(|variant| variant.probability * variant.applicability);
    share.sum::<f64>().clamp(0.0, 1.0)
}

/// The caveats of a prediction.
///
/// - `bare`: whether the vehicles approach each other, where the physics alone has a share.
fn caveats(applicability: f64, outside: &[OutsideTraining], bare: Option<bool>) -> Vec<Caveat> {
    let mut caveats: Vec<Caveat> = outside.iter().map(OutsideTraining::caveat).collect();
    if applicability < 1.0 {
        let text = match applicability > 0.0 {
            true => Phrase::new(
                "{0} of the force is that of the physics alone, with its measured errors",
                "Die Kraft ist zu {0} die der Physik allein, mit deren gemessenen Fehlern",
            )
            .with(PhraseValue::Share(1.0 - applicability)),
            false => Phrase::new(
                "the force is that of the physics alone, the momentum solution as a pulse \
                 with its measured errors; the network says nothing here",
                "Die Kraft ist die der Physik allein: die Impulslösung als Kraftverlauf mit ihren \
                 gemessenen Fehlern. Das Netz macht hierzu keine Aussage",
            ),
        };
        let caveat = Caveat::new(CaveatKind::OutsideDomain, text)
            .with_value(SHARE_OF_NETWORK, applicability)
            .with_range([1.0, 1.0]);
        caveats.push(caveat);
    }
    if bare == Some(false) {
        let text = Phrase::new(
            "the vehicles do not approach each other at the contact: no force",
            "Die Fahrzeuge nähern sich am Kontakt nicht: Es wirkt keine Kraft",
        );
        caveats.push(Caveat::new(CaveatKind::ImplausibleContact, text));
    }
    caveats
}

/// The mean of curves with weights that sum to one.
fn mean_curve<'a>(curves: impl Iterator<Item = (&'a ForceCurve, f64)>) -> ForceCurve {
    let mut sum = vec![0.0; 2 * CURVE_N_INSTANTS + 1];
    for (curve, weight) in curves {
        for (total, value) in sum.iter_mut().zip(curve.to_values()) {
            *total += weight * value;
        }
    }
    ForceCurve::from_values(&sum)
}

/// Checks the ranges within which the physics can be solved.
fn check(scenario: &ForceScenario) -> Result<(), ForceError> {
    let [struck, striking] = scenario.mass_kg;
    let [vx, vy] = scenario.relative_velocity_m_s();
    let within = |value: f64, low: f64, high: f64| (low..=high).contains(&value);
    let [x, y] = scenario.contact_m.unwrap_or_default();
    let checks = [
        ("mass of the struck vehicle [kg]", struck, within(struck, 1.0, 1e8), "1 to 1e8"),
        ("mass of the striking vehicle [kg]", striking, within(striking, 1.0, 1e8), "1 to 1e8"),
        (
            "speed of the striking over the struck vehicle, along [m/s]",
            vx,
            within(vx, -150.0, 150.0),
            "-150 to 150",
        ),
        (
            "speed of the striking over the struck vehicle, across [m/s]",
            vy,
            within(vy, -150.0, 150.0),
            "-150 to 150",
        ),
        (
            "heading of the striking vehicle [rad]",
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
