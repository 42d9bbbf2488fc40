//! What the particles say: quantities with their intervals, modes, fit, and what further evidence
//! would bring.

use schemars::JsonSchema;
use serde::Serialize;

use crate::modes::modes_by;
use crate::quantity::{LEVELS, PosteriorPoint};
use crate::sampler::Particles;
use crate::{
    EvidenceFit, ForwardModel, HandSpeed, ImpactState, Latent, LatentValues, Narrowing,
    QuantityEstimate, ReconstructedQuantity, ReconstructionTarget,
};
use impactlab_core::collision::{BodyAfter, ImpactSolution};
use impactlab_core::numerics::quantile_of_sorted;
use impactlab_core::units::{Estimate, NumberFormat, Quantity, UnitSystem};

/// Independent particles that an interval needs: five of these then lie beyond each end of the interval
/// of 90 %. With fewer the ends are those of single particles.
pub const LEAST_ESS_FOR_INTERVALS: f64 = 100.0;

/// A kind of course of events that the evidence leaves possible.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Mode {
    /// What sets it apart.
    pub name: String,
    /// Its probability.
    pub probability: f64,
    /// Standard error of the probability by the number of particles.
    pub standard_error: f64,
    /// The quantities within it.
    pub quantities: Vec<QuantityEstimate>,
    /// Indices of its particles, which are not told.
    #[serde(skip)]
    pub members: Vec<usize>,
}

/// What one more piece of evidence would bring.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct BudgetItem {
    /// The quantity that would be measured, with its unit.
    pub known: &'static str,
    /// How well, one standard deviation in that unit.
    pub sigma: f64,
    /// Half the width of the 90 % interval of the speed that the case is asked for now, m/s.
    pub now_m_s: f64,
    /// The same on the average with the measurement, m/s.
    pub then_m_s: f64,
    /// Effective number of particles that the average rests on.
    pub ess: f64,
    /// Whether these are enough.
    pub believable: bool,
}

/// Particles with what follows from them.
#[derive(Debug, Clone, PartialEq)]
pub struct Posterior {
    /// The quantities of each particle.
    pub values: Vec<LatentValues>,
    /// The impact of each particle; `None` of a single car.
    pub impacts: Vec<Option<ImpactState>>,
    /// Yaw rate of the struck car of each particle at the end of the contact, rad/s; NaN of a single car.
    pub yaw_rates_after_rad_s: Vec<f64>,
    /// Speed at which the single car of each particle began to brake before the start, m/s; NaN where nothing is
    /// said of it, and of a collision.
    pub speeds_before_braking_m_s: Vec<f64>,
    /// Independent particles that all of them are worth; none if the run was stopped before it had some
    /// of the posterior.
    pub ess: f64,
    is_of_single_car: bool,
}

/// Smallest probability of a mode that is told.
const SMALLEST_MODE: f64 = 0.01;

/// Motions by which the fit is judged.
const FIT_PARTICLES: usize = 300;

impl Posterior {
    /// What follows from particles.
    pub fn new(struck: &ReconstructionTarget, particles: &Particles) -> Self {
        let is_told = particles.is_posterior() || particles.is_weakened();
        let ess = if is_told { particles.ess } else { 0.0 };
        Self { ess, ..Self::from_points(struck.model(), &particles.z) }
    }

    /// What follows from independent points.
    ///
    /// - `z`: standard normal variables of each point, `[n][dim]`.
    pub fn from_points(model: &ForwardModel, z: &[Vec<f64>]) -> Self {
        let values: Vec<LatentValues> = z.iter().map(|z| model.prior().values(z)).collect();
        let is_of_single_car = model.is_of_single_car();
        let impact = |values: &LatentValues| (!is_of_single_car).then(|| model.impact(values));
        let impacts = values.iter().map(impact).collect();
        let yaw_rates_after_rad_s = model.yaw_rates_after_rad_s(&values);
        let before_braking = |values: &LatentValues| model.speed_before_braking_m_s(values);
        let speeds_before_braking_m_s = values.iter().map(before_braking).collect();
        let ess = values.len() as f64;
        Self {
            values,
            impacts,
            yaw_rates_after_rad_s,
            speeds_before_braking_m_s,
            ess,
            is_of_single_car,
        }
    }

    /// Whether there are enough particles for intervals.
    pub fn has_intervals(&self) -> bool {
        self.ess >= LEAST_ESS_FOR_INTERVALS
    }

    /// Values of a quantity, one for each particle.
    pub fn values(&self, quantity: ReconstructedQuantity) -> Vec<f64> {
        self.points().map(|point| quantity.value(&point)).collect()
    }

    /// The speed that a check by hand gives, as the particles have it; `None` where these are too few for an
    /// interval, or the case has no such speed.
    pub fn speed_of(&self, checked: HandSpeed) -> Option<Estimate> {
        let after = |body: fn(&ImpactSolution) -> &BodyAfter| -> Vec<f64> {
            let bodies = self.impacts.iter().flatten().map(|impact| body(&impact.solution));
            bodies.map(|BodyAfter { velocity_world_m_s: [x, y], .. }| x.hypot(*y)).collect()
        };
        let mut speeds = match checked {
            HandSpeed::StruckAfter => after(|solution| &solution.struck),
            HandSpeed::StrikingAfter => after(|solution| &solution.striking),
            HandSpeed::Struck => self.values(ReconstructedQuantity::StruckSpeed),
            HandSpeed::Striking => self.values(ReconstructedQuantity::StrikingSpeed),
            HandSpeed::AtStart => self.values(ReconstructedQuantity::CarSpeed),
        };
        speeds.retain(|speed| speed.is_finite());
        let has_interval = self.ess >= LEAST_ESS_FOR_INTERVALS && !speeds.is_empty();
        has_interval.then(|| Estimate::from_draws(speeds))
    }

    /// Whether it is that of a single car, which has no impact.
    pub fn is_of_single_car(&self) -> bool {
        self.is_of_single_car
    }

    /// The speed that the case is asked for: that of the struck car before the impact, or that of a single
    /// car at the start.
    pub fn speed(&self) -> ReconstructedQuantity {
        match self.is_of_single_car() {
            true => ReconstructedQuantity::CarSpeed,
            false => ReconstructedQuantity::StruckSpeed,
        }
    }

    /// The quantities that the case is asked for: those of every collision and the speeds before its skids,
    /// or those of a single car and the speed at which it began to brake before the start.
    pub fn asked(&self) -> Vec<ReconstructedQuantity> {
        if self.is_of_single_car() {
            let brakes =
                self.speeds_before_braking_m_s.first().is_some_and(|speed| !speed.is_nan());
            let before = brakes.then_some(ReconstructedQuantity::CarSpeedBeforeBraking);
            return ReconstructedQuantity::SINGLE_CAR.iter().copied().chain(before).collect();
        }
        let has = |quantity: &&ReconstructedQuantity| {
            self.values(**quantity).iter().all(|value| !value.is_nan())
        };
        let before_skid = ReconstructedQuantity::BEFORE_SKID.iter().filter(has);
        ReconstructedQuantity::ALL.iter().chain(before_skid).copied().collect()
    }

    fn points(&self) -> impl Iterator<Item = PosteriorPoint<'_>> {
        let rates = self.yaw_rates_after_rad_s.iter().zip(&self.speeds_before_braking_m_s);
        let points = self.values.iter().zip(&self.impacts).zip(rates);
        points.map(|((values, impact), (yaw_rate, before_braking))| PosteriorPoint {
            values,
            impact: impact.as_ref(),
            yaw_rate_after_rad_s: *yaw_rate,
            speed_before_braking_m_s: *before_braking,
        })
    }

    /// The interval that holds 90 % of a quantity that the motion depends on; `None` where the case does
    /// not have it, or with too few particles.
    pub fn interval_90_of(&self, latent: Latent) -> Option<[f64; 2]> {
        if !self.has_intervals() {
            return None;
        }
        let mut values: Vec<f64> = self.values.iter().map(|values| values.get(latent)).collect();
        values.sort_by(f64::total_cmp);
        let ends = [quantile_of_sorted(&values, 0.05)?, quantile_of_sorted(&values, 0.95)?];
        ends.iter().all(|end| end.is_finite()).then_some(ends)
    }

    /// The particle whose speed is nearest to a median, among some of them.
    ///
    /// - `members`: numbers of these particles;
    /// - `quantities`: their quantities, with the median.
    pub fn nearest_to_median(
        &self,
        members: &[usize],
        quantities: &[QuantityEstimate],
    ) -> Option<usize> {
        let speed = self.speed();
        let median =
            quantities.iter().find(|quantity| quantity.name == speed.key())?.estimate.median;
        let speeds = self.values(speed);
        let off = |idx: &usize| speeds.get(*idx).map_or(f64::INFINITY, |v| (v - median).abs());
        members.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)))
    }

    /// Every quantity with its intervals.
    pub fn quantities(&self) -> Vec<QuantityEstimate> {
        self.quantities_of(&(0..self.values.len()).collect::<Vec<_>>())
    }

    fn quantities_of(&self, chosen: &[usize]) -> Vec<QuantityEstimate> {
        let ess = self.ess * chosen.len() as f64 / self.values.len().max(1) as f64;
        let levels = if ess >= LEAST_ESS_FOR_INTERVALS { &LEVELS[..] } else { &[] };
        let estimate = |quantity: &ReconstructedQuantity| {
            let all = self.values(*quantity);
            let value = |&idx: &usize| all[idx];
            QuantityEstimate::from_values(*quantity, chosen.iter().map(value).collect(), levels)
        };
        self.asked().iter().filter_map(estimate).collect()
    }

    /// The kinds of courses of events, the most probable one first; none of particles that are not of the
    /// posterior.
    ///
    /// - `turned_rad`: by how much the struck or single car of each particle has turned at rest, rad.
    pub fn modes(&self, particles: &Particles, turned_rad: &[f64]) -> Vec<Mode> {
        let name = |idx: usize| match (self.values.get(idx), turned_rad.get(idx)) {
            (Some(values), Some(turned)) => mode_name(values, *turned),
            _ => String::new(),
        };
        if self.ess <= 0.0 {
            return Vec::new();
        }
        modes_by(particles, name)
            .into_iter()
            .filter(|mode| mode.probability >= SMALLEST_MODE)
            .map(|mode| Mode {
                name: mode.key,
                probability: mode.probability,
                standard_error: mode.standard_error,
                quantities: self.quantities_of(&mode.members),
                members: mode.members,
            })
            .collect()
    }

    /// What further measurements would bring, by [`Narrowing`]; nothing is known with too few particles.
    ///
    /// - `seed`: seed of the errors of measurements.
    pub fn budget(&self, seed: u64) -> Vec<BudgetItem> {
        if !self.has_intervals() {
            return Vec::new();
        }
        let speeds = self.values(self.speed());
        let latent = |latent: Latent| self.values.iter().map(|v| v.get(latent)).collect::<Vec<_>>();
        let quantity = |quantity: ReconstructedQuantity| self.values(quantity);
        let of_single_car = [
            ("road_friction", 0.02, latent(Latent::RoadFriction)),
            ("tire_friction_factor", 0.02, latent(Latent::TireFrictionFactor)),
            ("brake_start_s", 0.1, latent(Latent::BrakeStart)),
            ("steer_angle_rad", 0.01, latent(Latent::SteerAngle)),
            ("speed_m_s", 0.9, speeds.clone()),
        ];
        let of_collision = [
            ("road_friction", 0.02, latent(Latent::RoadFriction)),
            ("tire_friction_factor", 0.02, latent(Latent::TireFrictionFactor)),
            ("target_mass_kg", 20.0, latent(Latent::StruckMass)),
            ("bullet_mass_kg", 20.0, latent(Latent::StrikingMass)),
            ("contact_along_m", 0.03, latent(Latent::ContactAlong)),
            ("brake_start_s", 0.1, latent(Latent::BrakeStart)),
            ("delta_v_target_m_s", 0.1, quantity(ReconstructedQuantity::DeltaVStruck)),
            ("heading_difference_rad", 0.05, quantity(ReconstructedQuantity::HeadingDifference)),
            ("target_speed_m_s", 0.9, speeds.clone()),
        ];
        let known = match self.is_of_single_car() {
            true => Vec::from(of_single_car),
            false => Vec::from(of_collision),
        };
        known
            .into_iter()
            .filter_map(|(known, sigma, x)| {
                let is_fixed = x.iter().all(|value| Some(value) == x.first());
                if is_fixed || !x.iter().all(|x| x.is_finite()) {
                    return None; // The quantity is not open.
                }
                let narrowing = Narrowing::by(&speeds, (&x, sigma), self.ess, seed)?;
                Some(BudgetItem {
                    known,
                    sigma,
                    now_m_s: narrowing.width_90_now / 2.0,
                    then_m_s: narrowing.width_90_then / 2.0,
                    ess: narrowing.ess,
                    believable: narrowing.believable(),
                })
            })
            .collect()
    }
}

impl BudgetItem {
    /// The measurement that would give the quantity.
    pub fn measurement(&self) -> &'static str {
        match self.known {
            "road_friction" => "friction test",
            "tire_friction_factor" => "tire test",
            "target_mass_kg" => "struck car weighed",
            "bullet_mass_kg" => "striking car weighed",
            "contact_along_m" => "damage measured",
            "brake_start_s" => "braking timed",
            "delta_v_target_m_s" => "Δv recorded",
            "heading_difference_rad" => "angle measured",
            "target_speed_m_s" | "speed_m_s" => "speed recorded",
            "steer_angle_rad" => "steering recorded",
            other => other,
        }
    }

    /// What kind of quantity it is.
    pub fn quantity(&self) -> Quantity {
        let reconstructed =
            ReconstructedQuantity::EVERY.iter().find(|quantity| quantity.key() == self.known);
        let open = Latent::ALL.iter().find(|latent| latent.key() == self.known);
        let open = open.map_or(Quantity::Ratio, |latent| latent.quantity());
        reconstructed.map_or(open, |quantity| quantity.quantity())
    }

    /// The measurement with its standard deviation, such as `friction test, ± 0.02`.
    pub fn shown(&self, units: UnitSystem) -> String {
        let sigma = NumberFormat::english(units).sigma(self.quantity(), self.sigma);
        format!("{}, ± {sigma}", self.measurement())
    }
}

impl ReconstructionTarget {
    /// Share of the particles whose cars meet again after the impact, as far as it alone moves them, and
    /// its standard error; `None` for cars whose dimensions make no outline.
    pub fn meet_again_share(&self, particles: &Particles) -> Option<[f64; 2]> {
        let model = self.model().clone().watching_contacts();
        let meet: Option<Vec<bool>> =
            model.motions(&particles.z, |motion| motion.meet_again).into_iter().collect();
        let meet = meet?;
        let modes = modes_by(particles, |idx| meet.get(idx) == Some(&true));
        // It is that of the others, too.
        let standard_error = modes.first()?.standard_error;
        let share = modes.iter().find(|mode| mode.key).map_or(0.0, |mode| mode.probability);
        Some([share, standard_error])
    }

    /// How well the posterior explains each item of the evidence, and by how much the struck or
    /// single car of each particle has turned at rest, rad.
    pub fn fit(&self, particles: &Particles) -> (Vec<EvidenceFit>, Vec<f64>) {
        let every = particles.z.len().div_ceil(FIT_PARTICLES).max(1);
        let evaluated = self.model().motions(&particles.z, |motion| {
            let points = &motion.path.points;
            let ends = points.first().zip(points.last());
            let turned = ends.map_or(f64::NAN, |(first, last)| last.yaw_rad - first.yaw_rad);
            (self.terms(&motion), turned)
        });
        let turned = evaluated.iter().map(|(_, turned)| *turned).collect();
        let terms: Vec<_> = evaluated.into_iter().step_by(every).map(|(terms, _)| terms).collect();
        (EvidenceFit::from_particles(&terms), turned)
    }
}

/// What sets the course of events of a particle apart.
fn mode_name(values: &LatentValues, turned_rad: f64) -> String {
    let is_single_car = !values.get(Latent::CarSpeed).is_nan();
    let car = if is_single_car { "the car" } else { "the struck car" };
    let spin = turn_name(car, turned_rad);
    let braked = if values.brakes() { "the driver brakes" } else { "the driver does not brake" };
    let blocked = match (
        values.get(Latent::BlockedWheel).is_nan(),
        values.blocked_of_two(Latent::BlockedWheel),
    ) {
        (true, _) => "",
        (false, None) => ", no wheel blocked",
        (false, Some(0)) => ", the wheel at the damage blocked",
        (false, Some(_)) => ", the other wheel near the damage blocked",
    };
    format!("{spin}, {braked}{blocked}")
}

/// How far a car has turned at rest, by the nearest number of half turns: within 90° of it.
fn turn_name(car: &str, turned_rad: f64) -> String {
    let halves = (turned_rad / std::f64::consts::PI).round() as i64;
    let side = if halves > 0 { "left" } else { "right" };
    let degrees = 180 * halves.abs();
    match degrees {
        0 => format!("{car} turns by less than 90°"),
        _ => format!("{car} turns {side} by {}° to {}°", degrees - 90, degrees + 90),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Cars;
    use crate::evidence::examples::{SPIN, read};

    /// Twenty particles were said to hold a speed with a probability of 90 %.
    #[test]
    fn few_particles_have_a_median_and_no_intervals() {
        let evidence = read(SPIN);
        let model = ForwardModel::new(&evidence, Cars::new(&evidence, None, None));
        let dim = model.prior().components().len();
        let z = |n: usize| -> Vec<Vec<f64>> {
            (0..n).map(|i| vec![(i as f64 + 0.5) / n as f64 - 0.5; dim]).collect()
        };
        for (n, has_intervals) in [(20, false), (99, false), (100, true)] {
            let posterior = Posterior::from_points(&model, &z(n));
            assert_eq!(posterior.has_intervals(), has_intervals, "{n}");
            let [speed, ..] = &posterior.quantities()[..] else { panic!("quantities") };
            assert!(speed.estimate.median.is_finite());
            assert_eq!(speed.estimate.interval(0.9).is_some(), has_intervals, "{n}");
            let friction = posterior.interval_90_of(Latent::RoadFriction);
            assert_eq!(friction.is_some(), has_intervals, "{n}");
            assert_eq!(posterior.budget(0).is_empty(), !has_intervals, "{n}");
            let written = serde_json::to_value(speed).unwrap();
            assert_eq!(written.get("interval_90").is_some(), has_intervals, "{written}");
        }
    }

    /// A car that had turned by 100° “turns left by about 180°”, and nothing said which car, or what “recovers” is.
    #[test]
    fn a_course_of_events_says_which_car_turns_and_by_how_much() {
        for (degrees, expected) in [
            (80.0_f64, "the struck car turns by less than 90°"),
            (-80.0, "the struck car turns by less than 90°"),
            (100.0, "the struck car turns left by 90° to 270°"),
            (-260.0, "the struck car turns right by 90° to 270°"),
            (-300.0, "the struck car turns right by 270° to 450°"),
        ] {
            assert_eq!(turn_name("the struck car", degrees.to_radians()), expected, "{degrees}");
        }
    }

    /// A head-on collision had a median of −148° with an interval of nearly the whole circle.
    #[test]
    fn an_angle_about_half_a_turn_has_an_interval_without_a_jump() {
        let degrees = [150.0_f64, 165.0, 175.0, -178.0, -170.0, -160.0, 179.0];
        let values = degrees.map(f64::to_radians).to_vec();
        let heading = ReconstructedQuantity::HeadingDifference;
        let estimate = QuantityEstimate::from_values(heading, values, &LEVELS).unwrap().estimate;
        let median = estimate.median.to_degrees();
        assert!((median.rem_euclid(360.0) - 179.0).abs() < 1e-9, "{median}");
        let [low, high] = estimate.ninety().map(f64::to_degrees);
        assert!(low < median && median < high && high - low < 60.0, "{low} to {high}");
    }
}
