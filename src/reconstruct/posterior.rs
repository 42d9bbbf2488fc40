//! What the particles say: quantities with their intervals, modes, fit, and what further evidence
//! would bring.

use serde::Serialize;

use crate::numerics::quantile_of_sorted;
use crate::reconstruct::sampler::Particles;
use crate::reconstruct::{EvidenceFit, ImpactState, Latent, LatentValues, ReconstructionTarget};

macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident: $key:literal, $unit:literal, $of:expr;)+) => {
        /// A quantity that a reconstruction asks for.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
        #[serde(rename_all = "snake_case")]
        pub enum ReconstructedQuantity {
            $($(#[$doc])* $name,)+
        }

        impl ReconstructedQuantity {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$name),+];

            /// Name with its unit.
            pub const fn key(self) -> &'static str {
                match self { $(Self::$name => $key),+ }
            }

            /// Symbol of the unit; empty for a pure number.
            pub const fn unit(self) -> &'static str {
                match self { $(Self::$name => $unit),+ }
            }

            /// Its value of a particle.
            pub fn of(self, values: &LatentValues, impact: &ImpactState) -> f64 {
                let of: fn(&LatentValues, &ImpactState) -> f64 = match self { $(Self::$name => $of),+ };
                of(values, impact)
            }
        }
    };
}

quantities! {
    /// Speed of the struck car before the impact, m/s.
    TargetSpeed: "target_speed_m_s", "m/s", |_, impact| impact.target_speed_m_s;
    /// Speed of the striking car before the impact, m/s.
    BulletSpeed: "bullet_speed_m_s", "m/s", |_, impact| impact.bullet_speed_m_s;
    /// Size of the difference of both velocities, m/s.
    ClosingSpeed: "closing_speed_m_s", "m/s", |_, impact| impact.closing_speed_m_s;
    /// Heading of the striking car against that of the struck car, rad.
    HeadingDifference: "heading_difference_rad", "rad", |_, impact| impact.heading_difference_rad;
    /// Peak friction of the road.
    RoadFriction: "road_friction", "", |values, _| values.get(Latent::RoadFriction);
    /// Change of velocity of the struck car by the contact, m/s.
    DeltaVTarget: "delta_v_target_m_s", "m/s", |_, impact| impact.delta_v_target_m_s();
    /// Yaw rate of the struck car after the impact, rad/s.
    TargetYawRate: "target_yaw_rate_after_rad_s", "rad/s",
        |_, impact| impact.solution.target.yaw_rate_rad_s;
}

/// A quantity with its intervals, which leave out as much below as above.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuantityEstimate {
    /// Name with its unit.
    pub name: &'static str,
    /// Symbol of the unit; empty for a pure number.
    pub unit: &'static str,
    /// Median.
    pub median: f64,
    /// Holds the value with a probability of 50 %.
    pub interval_50: [f64; 2],
    /// … of 80 %.
    pub interval_80: [f64; 2],
    /// … of 90 %.
    pub interval_90: [f64; 2],
    /// … of 95 %.
    pub interval_95: [f64; 2],
}

/// A kind of course of events that the evidence leaves possible.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Mode {
    /// What sets it apart.
    pub name: String,
    /// Its probability.
    pub probability: f64,
    /// The quantities within it.
    pub quantities: Vec<QuantityEstimate>,
}

/// What one more piece of evidence would bring.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BudgetItem {
    /// The quantity that would be measured, with its unit.
    pub known: &'static str,
    /// How well, one standard deviation in that unit.
    pub sigma: f64,
    /// Half the width of the 90 % interval of the struck car's speed now, m/s.
    pub now_m_s: f64,
    /// The same on the average with the measurement, m/s.
    pub then_m_s: f64,
    /// Effective number of particles that the average rests on.
    pub ess: f64,
}

/// Particles with what follows from them.
#[derive(Debug, Clone, PartialEq)]
pub struct Posterior {
    /// The quantities of each particle.
    pub values: Vec<LatentValues>,
    /// The impact of each particle.
    pub impacts: Vec<ImpactState>,
}

/// Smallest probability of a mode that is told.
const SMALLEST_MODE: f64 = 0.01;

/// Outcomes of a measurement over which the budget is averaged.
const BUDGET_OUTCOMES: usize = 100;

/// Motions by which the fit is judged.
const FIT_PARTICLES: usize = 300;

impl Posterior {
    /// What follows from particles.
    pub fn of(target: &ReconstructionTarget, particles: &Particles) -> Self {
        let model = target.model();
        let values: Vec<LatentValues> =
            particles.z.iter().map(|z| model.prior().values(z)).collect();
        let impacts = values.iter().map(|values| model.impact(values)).collect();
        Self { values, impacts }
    }

    /// Values of a quantity, one for each particle.
    pub fn of_quantity(&self, quantity: ReconstructedQuantity) -> Vec<f64> {
        self.values.iter().zip(&self.impacts).map(|(v, impact)| quantity.of(v, impact)).collect()
    }

    /// Every quantity with its intervals.
    pub fn quantities(&self) -> Vec<QuantityEstimate> {
        self.quantities_of(&(0..self.values.len()).collect::<Vec<_>>())
    }

    fn quantities_of(&self, chosen: &[usize]) -> Vec<QuantityEstimate> {
        let of = |quantity: &ReconstructedQuantity| {
            let value = |&idx: &usize| quantity.of(&self.values[idx], &self.impacts[idx]);
            QuantityEstimate::of(*quantity, chosen.iter().map(value).collect())
        };
        ReconstructedQuantity::ALL.iter().filter_map(of).collect()
    }

    /// The kinds of courses of events, the most probable one first.
    ///
    /// - `turned_rad`: by how much the struck car of each particle has turned at rest, rad.
    pub fn modes(&self, turned_rad: &[f64]) -> Vec<Mode> {
        let mut names: Vec<(String, Vec<usize>)> = Vec::new();
        for (idx, (values, turned)) in self.values.iter().zip(turned_rad).enumerate() {
            let name = mode_name(values, *turned);
            match names.iter_mut().find(|(known, _)| *known == name) {
                Some((_, members)) => members.push(idx),
                None => names.push((name, vec![idx])),
            }
        }
        let n = self.values.len() as f64;
        let mut modes: Vec<Mode> = names
            .into_iter()
            .map(|(name, members)| Mode {
                name,
                probability: members.len() as f64 / n,
                quantities: self.quantities_of(&members),
            })
            .filter(|mode| mode.probability >= SMALLEST_MODE)
            .collect();
        modes.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        modes
    }

    /// What further measurements would bring.
    ///
    /// ```text
    /// w_ij ∝ exp(−(x_j − y_i)²/2σ²)      y_i = x_i: outcomes as the particles have them
    /// ```
    pub fn budget(&self) -> Vec<BudgetItem> {
        let speeds = self.of_quantity(ReconstructedQuantity::TargetSpeed);
        let latent = |latent: Latent| self.values.iter().map(|v| v.get(latent)).collect::<Vec<_>>();
        let quantity = |quantity: ReconstructedQuantity| self.of_quantity(quantity);
        [
            ("road_friction", 0.02, latent(Latent::RoadFriction)),
            ("tire_friction_factor", 0.02, latent(Latent::TireFrictionFactor)),
            ("target_mass_kg", 20.0, latent(Latent::TargetMass)),
            ("bullet_mass_kg", 20.0, latent(Latent::BulletMass)),
            ("contact_along_m", 0.03, latent(Latent::ContactAlong)),
            ("brake_start_s", 0.1, latent(Latent::BrakeStart)),
            ("delta_v_target_m_s", 0.1, quantity(ReconstructedQuantity::DeltaVTarget)),
            ("heading_difference_rad", 0.05, quantity(ReconstructedQuantity::HeadingDifference)),
            ("target_speed_m_s", 0.9, speeds.clone()),
        ]
        .into_iter()
        .filter_map(|(known, sigma, x)| budget_item((known, sigma), &x, &speeds))
        .collect()
    }
}

impl QuantityEstimate {
    /// Intervals of equally likely values; `None` without values.
    fn of(quantity: ReconstructedQuantity, mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| quantile_of_sorted(&values, share);
        let interval = |share: f64| Some([at((1.0 - share) / 2.0)?, at((1.0 + share) / 2.0)?]);
        Some(Self {
            name: quantity.key(),
            unit: quantity.unit(),
            median: at(0.5)?,
            interval_50: interval(0.5)?,
            interval_80: interval(0.8)?,
            interval_90: interval(0.9)?,
            interval_95: interval(0.95)?,
        })
    }
}

impl ReconstructionTarget {
    /// How well the posterior explains each item of the evidence, and by how much the struck car of
    /// each particle has turned at rest, rad.
    pub fn fit(&self, particles: &Particles) -> (Vec<EvidenceFit>, Vec<f64>) {
        let every = particles.z.len().div_ceil(FIT_PARTICLES).max(1);
        let told = self.model().motions(&particles.z, |motion| {
            let turned = motion.path.points.last().map_or(f64::NAN, |last| last.yaw_rad);
            (self.terms(&motion), turned)
        });
        let turned = told.iter().map(|(_, turned)| *turned).collect();
        let terms: Vec<_> = told.into_iter().step_by(every).map(|(terms, _)| terms).collect();
        (EvidenceFit::of(&terms), turned)
    }
}

/// What sets the course of events of a particle apart.
fn mode_name(values: &LatentValues, turned_rad: f64) -> String {
    let halves = (turned_rad / std::f64::consts::PI).round().abs();
    let spin = match (halves as i64, turned_rad > 0.0) {
        (0, _) => "recovers".to_owned(),
        (halves, true) => format!("turns left by about {}°", 180 * halves),
        (halves, false) => format!("turns right by about {}°", 180 * halves),
    };
    let braked = if values.brakes() { "the driver brakes" } else { "the driver does not brake" };
    let blocked = match (values.get(Latent::BlockedWheel).is_nan(), values.blocked_of_two()) {
        (true, _) => "",
        (false, None) => ", no wheel blocked",
        (false, Some(0)) => ", the wheel at the damage blocked",
        (false, Some(_)) => ", the other wheel near the damage blocked",
    };
    format!("{spin}, {braked}{blocked}")
}

/// Expected width of the speed if a quantity were measured; `None` where the quantity is not open.
fn budget_item(
    (known, sigma): (&'static str, f64),
    x: &[f64],
    speeds: &[f64],
) -> Option<BudgetItem> {
    let spread = |values: &[f64], weights: &[f64]| {
        let total: f64 = weights.iter().sum();
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let at = |share: f64| {
            let mut sum = 0.0;
            order.iter().find(|&&idx| {
                sum += weights[idx];
                sum >= share * total
            })
        };
        Some((values[*at(0.95)?] - values[*at(0.05)?]) / 2.0)
    };
    if x.is_empty() || !x.iter().all(|x| x.is_finite()) {
        return None;
    }
    let now_m_s = spread(speeds, &vec![1.0; speeds.len()])?;
    let every = x.len().div_ceil(BUDGET_OUTCOMES);
    let (mut sum, mut worth, mut n) = (0.0, 0.0, 0.0);
    for outcome in x.iter().step_by(every) {
        let weights: Vec<f64> =
            x.iter().map(|x| (-0.5 * ((x - outcome) / sigma).powi(2)).exp()).collect();
        let total: f64 = weights.iter().sum();
        worth += total * total / weights.iter().map(|w| w * w).sum::<f64>();
        sum += spread(speeds, &weights)?;
        n += 1.0;
    }
    Some(BudgetItem { known, sigma, now_m_s, then_m_s: sum / n, ess: worth / n })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_decides_the_speed_narrows_it_and_what_does_not_leaves_it() {
        let speeds: Vec<f64> = (0..2000).map(|i| 10.0 + f64::from(i) * 0.001).collect();
        let other: Vec<f64> = (0..2000).map(|i| f64::from(i * 7919 % 2000) * 0.001).collect();
        let same = budget_item(("same", 0.1), &speeds, &speeds).unwrap();
        let none = budget_item(("other", 0.1), &other, &speeds).unwrap();
        assert!((same.now_m_s - 0.9).abs() < 0.01, "{same:?}");
        assert!(same.then_m_s < 0.25 * same.now_m_s, "{same:?}");
        assert!(none.then_m_s > 0.9 * none.now_m_s, "{none:?}");
        assert!(budget_item(("open", 0.1), &[f64::NAN; 3], &[1.0; 3]).is_none());
    }
}
