//! What the speeds hinge on: by how much they move if one quantity is larger.
//!
//! ```text
//! b = cov(x, v) / var(x)      s_b = √((var(v) − b cov(x, v)) / (ESS var(x)))      Δv = b Δx
//! ```
//!
//! This is the slope of the line through the particles of the posterior by least squares: what a speed is
//! on the average, given the evidence, if the quantity x is known to be larger by Δx. What else goes with x
//! in the evidence moves along.

use schemars::JsonSchema;
use serde::Serialize;

use crate::latent::LatentValues;
use crate::{Latent, Posterior, ReconstructedQuantity};
use impactlab_core::units::Quantity;

/// What a speed hinges on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum HingeInput {
    /// Drag factor of the struck or the single car with all wheels locked: the product of the friction of
    /// the road and what tires make of it, which evidence of a drag factor holds together.
    LockedDrag,
    /// A quantity that is drawn.
    #[serde(untagged)]
    Drawn(Latent),
}

impl HingeInput {
    /// What it is called.
    pub fn label(self) -> &'static str {
        match self {
            Self::LockedDrag => "drag factor of locked wheels",
            Self::Drawn(latent) => latent.label(),
        }
    }

    fn quantity(self) -> Quantity {
        match self {
            Self::LockedDrag => Quantity::Ratio,
            Self::Drawn(latent) => latent.quantity(),
        }
    }

    fn value(self, values: &LatentValues) -> f64 {
        match self {
            Self::LockedDrag => values.locked_drag(),
            Self::Drawn(latent) => values.get(latent),
        }
    }
}

/// The quantities, and how much larger each one is taken to be.
const STEPS: [(Latent, f64); 16] = [
    (Latent::RoadFriction, 0.1),
    (Latent::ZoneFrictionFactor, 0.1),
    (Latent::TireFrictionFactor, 0.1),
    (Latent::StrikingTireFrictionFactor, 0.1),
    (Latent::SlidingRatio, 0.1),
    (Latent::LongitudinalFrictionRatio, 0.1),
    (Latent::StruckMass, 100.0),
    (Latent::StrikingMass, 100.0),
    (Latent::YawInertiaFactor, 0.1),
    (Latent::ContactAlong, 0.1),
    (Latent::ContactFriction, 0.1),
    (Latent::RestitutionShare, 0.1),
    (Latent::BrakeStart, 0.5),
    (Latent::BrakeShare, 0.1),
    (Latent::StrikingBrakeShare, 0.1),
    (Latent::CarSideslip, 0.05),
];

/// How much larger the drag factor of locked wheels is taken to be.
const DRAG_STEP: f64 = 0.1;

/// Number of standard errors beyond which a slope is no chance: one of 400 slopes that are none is.
const CLEAR: f64 = 3.0;

/// Quantities that are told, beside the friction of the road.
const MOST: usize = 5;

/// By how much the speeds before the impact move if a quantity is larger.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct SpeedHinge {
    /// The quantity.
    pub input: HingeInput,
    /// By how much it is larger, in its SI unit.
    pub step: f64,
    /// By how much the speed of the struck car, or of a single one, is larger then, m/s.
    #[serde(rename = "target_speed")]
    pub struck_speed: SpeedChange,
    /// The same of the striking car, where there is one.
    #[serde(rename = "bullet_speed", skip_serializing_if = "Option::is_none")]
    pub striking_speed: Option<SpeedChange>,
}

/// A change of a speed with its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct SpeedChange {
    /// The change, m/s.
    pub change_m_s: f64,
    /// Its standard error by the number of particles, m/s.
    pub standard_error_m_s: f64,
}

impl SpeedHinge {
    /// What kind of quantity the input is.
    pub fn quantity(&self) -> Quantity {
        self.input.quantity()
    }

    /// Whether a speed moves by more than chance.
    fn is_clear(&self) -> bool {
        let is_clear =
            |change: SpeedChange| change.change_m_s.abs() > CLEAR * change.standard_error_m_s;
        is_clear(self.struck_speed) || self.striking_speed.is_some_and(is_clear)
    }

    fn largest_m_s(&self) -> f64 {
        let striking_m_s = self.striking_speed.map_or(0.0, |of| of.change_m_s.abs());
        self.struck_speed.change_m_s.abs().max(striking_m_s)
    }
}

impl Posterior {
    /// What the speeds hinge on: the friction of the road, then those quantities with which they clearly
    /// move, the one that moves them most first. Nothing is known with too few particles.
    pub fn hinges(&self) -> Vec<SpeedHinge> {
        if !self.has_intervals() {
            return Vec::new();
        }
        let struck_m_s = self.values(self.speed());
        let of_striking = ReconstructedQuantity::StrikingSpeed;
        let striking_m_s = (!self.is_of_single_car()).then(|| self.values(of_striking));
        let hinge = |(input, step): (HingeInput, f64)| {
            let x: Vec<f64> = self.values.iter().map(|values| input.value(values)).collect();
            let change = |speeds_m_s: &[f64]| {
                let [slope, error] = slope(&x, speeds_m_s, self.ess)?;
                Some(SpeedChange { change_m_s: slope * step, standard_error_m_s: error * step })
            };
            let struck_speed = change(&struck_m_s)?;
            let striking_speed = striking_m_s.as_deref().and_then(change);
            Some(SpeedHinge { input, step, struck_speed, striking_speed })
        };
        let drawn = STEPS.iter().map(|&(latent, step)| (HingeInput::Drawn(latent), step));
        let inputs = drawn.chain([(HingeInput::LockedDrag, DRAG_STEP)]);
        let all: Vec<SpeedHinge> = inputs.filter_map(hinge).collect();
        let road = HingeInput::Drawn(Latent::RoadFriction);
        let is_friction = |hinge: &SpeedHinge| hinge.input == road;
        let (mut hinges, others): (Vec<SpeedHinge>, Vec<SpeedHinge>) =
            all.into_iter().partition(is_friction);
        let mut others: Vec<SpeedHinge> = others.into_iter().filter(SpeedHinge::is_clear).collect();
        others.sort_by(|a, b| b.largest_m_s().total_cmp(&a.largest_m_s()));
        others.truncate(MOST);
        hinges.extend(others);
        hinges
    }
}

/// Slope of a line by least squares with its standard error; `None` where x is not open in the case or does
/// not vary.
fn slope(x: &[f64], y: &[f64], ess: f64) -> Option<[f64; 2]> {
    let n = x.len().min(y.len()) as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
    let (x_mean, y_mean) = (mean(x), mean(y));
    let product = |a: &[f64], a_mean: f64, b: &[f64], b_mean: f64| {
        a.iter().zip(b).map(|(a, b)| (a - a_mean) * (b - b_mean)).sum::<f64>() / n
    };
    let variance = product(x, x_mean, x, x_mean);
    let is_varied = variance > 1e-12 * x_mean * x_mean && variance.is_finite();
    if !is_varied {
        return None;
    }
    let covariance = product(x, x_mean, y, y_mean);
    let slope = covariance / variance;
    let rest = (product(y, y_mean, y, y_mean) - slope * covariance).max(0.0);
    Some([slope, (rest / (ess.min(n) * variance)).sqrt()])
}

#[cfg(test)]
mod tests {
    use rand::RngExt;
    use rand_distr::StandardNormal;

    use super::*;
    use crate::evidence::examples::{SPIN, read};
    use crate::{Cars, ForwardModel};
    use impactlab_core::numerics::random_stream;

    #[test]
    fn a_slope_has_its_standard_error() {
        let x: Vec<f64> = (0..400).map(|i| f64::from(i % 20)).collect();
        // Noise of ± 1 that has nothing to do with x.
        let y: Vec<f64> = x
            .iter()
            .enumerate()
            .map(|(i, x)| 3.0 * x + if (i / 20) % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        let [b, error] = slope(&x, &y, 1e9).unwrap();
        assert!((b - 3.0).abs() < 1e-9, "{b}");
        // σ / (√n σ_x) with the variance (20² − 1)/12 of whole numbers.
        assert!((error - 1.0 / (20.0 * 33.25_f64.sqrt())).abs() < 1e-9, "{error}");
        let [_, fewer] = slope(&x, &y, 100.0).unwrap();
        assert!((fewer / error - 2.0).abs() < 1e-9, "{fewer}");
        assert_eq!(slope(&[0.7; 400], &y, 400.0), None);
        assert_eq!(slope(&[f64::NAN; 400], &y, 400.0), None);
    }

    #[test]
    fn the_friction_of_the_road_is_told_first_and_what_is_chance_is_not() {
        let evidence = read(SPIN);
        let model = ForwardModel::new(&evidence, Cars::new(&evidence, None, None));
        let dim = model.prior().components().len();
        let point = |i: u64| -> Vec<f64> {
            let mut rng = random_stream(3, "hinges", i);
            (0..dim).map(|_| rng.sample(StandardNormal)).collect()
        };
        let z: Vec<Vec<f64>> = (0..400).map(point).collect();
        let mut posterior = Posterior::from_points(&model, &z);
        // Draws of the prior, in which speeds depend on nothing else: they are made to hinge on friction.
        for (values, impact) in posterior.values.iter().zip(&mut posterior.impacts) {
            let impact = impact.as_mut().unwrap();
            impact.struck_speed_m_s = 20.0 * values.get(Latent::RoadFriction);
        }
        let hinges = posterior.hinges();
        let road = HingeInput::Drawn(Latent::RoadFriction);
        assert_eq!((hinges[0].input, hinges[0].step), (road, 0.1));
        assert!((hinges[0].struck_speed.change_m_s - 2.0).abs() < 1e-9, "{hinges:?}");
        assert!(hinges.len() < 3, "{hinges:?}");
        let few = Posterior::from_points(&model, &z[..99]);
        assert_eq!(few.hinges(), []);
    }
}
