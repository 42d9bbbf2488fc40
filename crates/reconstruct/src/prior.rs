//! What is taken to be likely before the motion is looked at: a distribution of each quantity that the
//! motion depends on, as a transformation of one standard normal variable each.
//!
//! What was measured by itself (friction, masses, the place of the first contact) enters here with its
//! standard deviation; what follows from the motion enters the likelihood.
//!
//! Defaults where the evidence file of a collision gives nothing, each with its source; those of a single car
//! stand in `single_car`:
//!
//! | quantity | default | source |
//! | --- | --- | --- |
//! | speed of the struck car | uniform, 0 to 60 m/s | nothing is known |
//! | striking car faster by | normal, 1 ± 3 m/s, hit behind the CG; else its speed uniform, 0 to 60 m/s | in a PIT manoeuvre the speeds are matched, by a car that comes from behind |
//! | its heading, turned towards the struck side | normal, 17° ± 14°, hit behind the CG on a flank; else uniform, 0° to 110°; rear 0° ± 17°; front 180° ± 29° | PIT manoeuvre; collisions at an angle; in line |
//! | its direction of motion beside the heading | normal, −6° ± 11° hit behind the CG, else 0° ± 11° | a car that turns in moves less to the side than it points |
//! | restitution | uniform, 0.24 to 0.66 up to 5 m/s of approach, falling to 0 to 0.3 at 15 m/s | [`ContactDistribution`], [`Brach2011`](impactlab_core::bibliography::Brach2011) |
//! | friction of the contact | normal, 0.28 ± 0.15 | [`ContactDistribution`] |
//! | normal of the contact turned towards where the striking car points | normal, 9° ± 7° hit behind the CG, else 0° ± 7° | a corner that digs in: tuning cases |
//! | friction of the tires over that of the road, each car its own | log-normal, 1.02, factor 1.09 | other tires: tuning cases |
//! | friction of a wheel along its plane over that across it | log-normal, 1.15, factor 1.07 | tuning cases |
//! | duration of the contact | log-normal, 0.12 s, factor 1.35 | finite-element runs of the project |
//! | driver brakes | 3 of 4 | assumed |
//! | … from | log-normal, 0.9 s, factor 1.6 | assumed: reaction to a surprise |
//! | … with a share of the largest force | log-normal, 0.8, factor 2.2 | locks the wheels in two of five |
//! | … that rises within | log-normal, 0.4 s, factor 1.6 | usual emergency braking to half-hearted |
//! | … more of it on the front axle than where both axles reach the limit together | normal, 0 ± 0.05 of the whole | either axle may lock first |
//! | … with an anti-lock system | only if the evidence says that it has one | assumed |
//! | engine braking where he does not | uniform, 0 to 0.8 m/s² | neutral to third gear |
//! | front wheels turned by | normal, 0 ± 0.9° | toe, play, a hand on the wheel |
//! | each wheel near the damage blocked | 1 of 5, if nobody looked | assumed |
//! | driver of the striking car brakes | 2 of 5 already at first contact, 2 of 5 later, from log-normal, 0.9 s, factor 1.6 | assumed: many brake before they hit |
//! | … with a share of the largest force | log-normal, 0.8, factor 2.2 | as that of the struck car |
//! | each front wheel of the striking car blocked | 1 of 5, if nobody looked | assumed: its front is bent |
//! | mass of a car of which no mass is known | log-normal, by its length and width where they are known, else 1790 kg, factor 1.19 | vehicles of the library |
//! | one scale that weighed both cars, over what it shows | log-normal, 1, as said | [`Weighing`](crate::evidence::Weighing) |
//! | loads that crush both cars over those of their classes, where later contacts are followed | log-normal, 1, factor 1.49 | [`STIFFNESS_LOG_SIGMA`](impactlab_core::collision::contact::STIFFNESS_LOG_SIGMA) of a side |
//! | yaw rate of a striking car that hits a flank behind the CG, towards it, where later contacts are followed | normal, 0.3 ± 0.2 rad/s | a car that turns in |
//! | … its driver steers in and pushes on | 1 of 2 | assumed: a PIT manoeuvre, or an accident |
//! | … by a turn of the steering wheel of | uniform, 90° to 180°; with a range that ends at 5° or less he does not push | PIT manoeuvre |
//! | … for | log-normal, 0.5 s, factor 2 | PIT manoeuvre |
//! | friction of the zones of a site over that which the site says, in all zones alike | log-normal, 1, factor 1.16 | assumed: grass, gravel and wet patches are known less well than the road |
//! | yaw inertia, tire curves, sliding friction, rolling resistance | the rules of the data sheet with their scatter | [`DataSheet`](impactlab_core::vehicle::DataSheet) |

mod single_car;
mod wheels;

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::Serialize;

use crate::cars::{Car, Cars};
use crate::evidence::{
    Bounds, DEFAULT_FRICTION, DEFAULT_FRICTION_SIGMA, DEFAULT_MASS_SHARE, Evidence, Measured, ends,
};
use crate::{Distribution, Latent, LatentValues};
use impactlab_core::collision::{ContactDistribution, Side};
use impactlab_core::vehicle::ZONE_FRICTION_LOG_SIGMA;
use impactlab_core::vehicle::sheet::SheetQuantity;

/// A quantity with its prior distribution.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct PriorComponent {
    /// The quantity.
    pub latent: Latent,
    /// Its distribution.
    pub distribution: Distribution,
    /// Who says so.
    pub source: PriorSource,
}

/// Where a distribution of the prior comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PriorSource {
    /// Given as a range or a scatter with the evidence, or as a value of the chosen vehicle.
    Given,
    /// A measured value of the evidence and its standard deviation; the usual one where the evidence says
    /// none.
    Measured,
    /// A rule with its scatter: of the data sheet, or that of a road of which the drag of locked wheels is known.
    Estimated,
    /// Nobody said it: a default of the program, in the table of [`Prior`].
    Assumed,
}

/// The prior: independent distributions of the quantities that are open.
#[derive(Debug, Clone, PartialEq)]
pub struct Prior {
    components: Vec<PriorComponent>,
    fixed: LatentValues,
    is_pit: bool,
}

/// Highest speed that the prior takes to be possible, m/s.
const HIGHEST_SPEED_M_S: f64 = 60.0;

/// Peak friction of a road that is taken to be possible where none higher was measured.
const HIGHEST_FRICTION: f64 = 1.6;

/// Friction of a tire over that which was measured on the road, and its scatter: other tires differ.
const TIRE_FRICTION_FACTOR: f64 = 1.02;
const TIRE_FRICTION_SCATTER: f64 = 0.09;

/// Friction of a wheel along its plane over that across it, and its scatter. The multibody cars of the
/// tuning cases have 1.15 to 1.2 at the peak and 1.15 on locked wheels.
const LONGITUDINAL_FRICTION_RATIO: f64 = 1.15;
const LONGITUDINAL_FRICTION_SCATTER: f64 = 0.07;

/// Scatter of the loads that crush both cars about those of their classes: that of a side.
const CONTACT_STIFFNESS_SCATTER: f64 = 0.4;

/// Least scatter of sliding over peak friction, for the same reason.
const SLIDING_SCATTER: f64 = 0.08;

/// Sliding over peak friction where nothing says it.
pub(crate) const USUAL_SLIDING_RATIO: f64 = 0.8;

/// How far the peak friction may be off where drag is measured and it is not.
const FRICTION_SIGMA_BY_DRAG: f64 = 0.2;

impl Prior {
    /// The prior of a case.
    pub fn new(evidence: &Evidence, cars: &Cars) -> Self {
        if evidence.is_single_car() {
            return Self::of_single_car(evidence, cars);
        }
        let is_pit = cars.is_hit_behind_cg(evidence);
        let mut prior = Self { components: Vec::new(), fixed: LatentValues::NONE, is_pit };
        prior.add_speeds(evidence);
        prior.add_contact(evidence, cars);
        prior.add_road(evidence);
        prior.add_masses(evidence, cars);
        prior.add_struck_car(cars);
        prior.add_ending(evidence);
        prior.add_skids(evidence);
        prior
    }

    /// The same for a ground on which there are zones with their own friction.
    #[must_use]
    pub fn with_zones(mut self) -> Self {
        let reach = (3.0 * ZONE_FRICTION_LOG_SIGMA).exp();
        let factor = log_normal(1.0, ZONE_FRICTION_LOG_SIGMA, 1.0 / reach, reach);
        self.assume(Latent::ZoneFrictionFactor, factor);
        self
    }

    /// The same with a striking car that coasts where nothing is said of it, so that it can be followed.
    #[must_use]
    pub fn with_coasting_striking_car(mut self) -> Self {
        for (latent, value) in [
            (Latent::StrikingTireFrictionFactor, TIRE_FRICTION_FACTOR),
            (Latent::StrikingBrakeDecision, 1.0),
        ] {
            if self.fixed.get(latent).is_nan() {
                self.fixed.set(latent, value);
            }
        }
        self
    }

    /// The same for cars whose later contacts are followed: how hard they are, and what driver and damage do
    /// to the striking one.
    #[must_use]
    pub fn with_later_contacts(mut self, evidence: &Evidence) -> Self {
        let stiffness = log_normal(1.0, CONTACT_STIFFNESS_SCATTER, 0.3, 3.0);
        self.assume(Latent::ContactStiffnessFactor, stiffness);
        if self.is_pit {
            self.add_push(evidence);
        }
        if !evidence.follows_striking_car() {
            self.add_striking_ending(evidence);
        }
        self
    }

    /// Its components, in the order of z.
    pub fn components(&self) -> &[PriorComponent] {
        &self.components
    }

    /// Whether the defaults are those of a push behind the CG, as in a PIT manoeuvre.
    pub fn is_pit(&self) -> bool {
        self.is_pit
    }

    /// The quantities at standard normal variables.
    pub fn values(&self, z: &[f64]) -> LatentValues {
        let mut values = self.fixed;
        for (component, z) in self.components.iter().zip(z) {
            values.set(component.latent, component.distribution.at(*z));
        }
        let scale = values.get(Latent::MassScaleFactor);
        if !scale.is_nan() {
            for mass in [Latent::StruckMass, Latent::StrikingMass] {
                values.set(mass, scale * values.get(mass));
            }
        }
        values
    }

    fn add(&mut self, latent: Latent, source: PriorSource, distribution: Distribution) {
        self.components.push(PriorComponent { latent, distribution, source });
    }

    /// A default of the program.
    fn assume(&mut self, latent: Latent, distribution: Distribution) {
        self.add(latent, PriorSource::Assumed, distribution);
    }

    /// A range of the user, or what is known without one.
    fn open(
        &mut self,
        latent: Latent,
        range: Option<Bounds>,
        otherwise: (PriorSource, Distribution),
    ) {
        let of_user = ends(range)
            .map(|[low, high]| (PriorSource::Given, Distribution::Uniform { low, high }));
        let (source, distribution) = of_user.unwrap_or(otherwise);
        self.add(latent, source, distribution);
    }

    fn add_speeds(&mut self, evidence: &Evidence) {
        let ranges = &evidence.prior;
        let any = Distribution::Uniform { low: 0.0, high: HIGHEST_SPEED_M_S };
        let any = (PriorSource::Assumed, any);
        self.open(Latent::StruckSpeed, ranges.struck_speed_m_s, any);
        match ranges.striking_speed_m_s {
            None if self.is_pit => {
                self.assume(Latent::SpeedDifference, normal(1.0, 3.0, -20.0, 20.0));
            }
            range => self.open(Latent::StrikingSpeed, range, any),
        }
        // Angles are turned towards the struck side, so that the mirror of a case is the same prior.
        let turned = |[low, high]: Bounds| match towards(evidence.damage.struck_side()) > 0.0 {
            true => [low, high],
            false => [high.map(|end| -end), low.map(|end| -end)],
        };
        let by_side = match evidence.damage.struck_side() {
            Side::Front => normal(PI, 0.5, PI - 1.6, PI + 1.6),
            Side::Rear => normal(0.0, 0.3, -1.6, 1.6),
            Side::Left | Side::Right if self.is_pit => normal(0.30, 0.25, -0.5, 1.6),
            Side::Left | Side::Right => Distribution::Uniform { low: 0.0, high: 1.92 },
        };
        let by_damage = evidence.damage.angle().map(|angle| {
            let mean = angle.value * towards(evidence.damage.struck_side());
            (PriorSource::Measured, normal(mean, angle.sigma, mean - PI, mean + PI))
        });
        let by_side = (PriorSource::Assumed, by_side);
        let heading = ranges.heading_difference_rad.map(turned);
        self.open(Latent::HeadingTowards, heading, by_damage.unwrap_or(by_side));
        let sideslip = ranges.striking_sideslip_rad.map(turned);
        let mean = if self.is_pit { -0.10 } else { 0.0 };
        let usual = (PriorSource::Assumed, normal(mean, 0.20, -0.8, 0.8));
        self.open(Latent::SideslipTowards, sideslip, usual);
    }

    fn add_contact(&mut self, evidence: &Evidence, cars: &Cars) {
        let damage = &evidence.damage;
        // What is not entered yet cannot be reconstructed from, but the rest of the prior can be shown.
        if let Some(Measured { value, sigma }) = damage.along() {
            let along = normal(value, sigma, value - 2.0, value + 2.0);
            self.add(Latent::ContactAlong, PriorSource::Measured, along);
        }
        let across = damage.depth_m.unwrap_or_else(|| cars.depth_of(damage.struck_side()));
        self.fixed.set(Latent::ContactAcross, across);
        // Its bounds are a range of the user, or those of the program.
        let source = match evidence.prior.restitution {
            Some(_) => PriorSource::Given,
            None => PriorSource::Assumed,
        };
        self.add(Latent::RestitutionShare, source, Distribution::Uniform { low: 0.0, high: 1.0 });
        let [low, high] = ContactDistribution::default().friction_limit;
        let friction = normal((low + high) / 2.0, (high - low) / 2.9, 0.0, 1.0);
        let friction = (PriorSource::Assumed, friction);
        self.open(Latent::ContactFriction, evidence.prior.contact_friction, friction);
        let mean = if self.is_pit { 0.15 } else { 0.0 };
        self.assume(Latent::NormalTilt, normal(mean, 0.12, -0.5, 0.8));
        self.assume(Latent::PulseDuration, log_normal(0.12, 0.30, 0.04, 0.30));
    }

    /// Friction of the road and of the tires of the struck car on it.
    fn add_road(&mut self, evidence: &Evidence) {
        let usual = Measured { value: DEFAULT_FRICTION, sigma: DEFAULT_FRICTION_SIGMA };
        let (source, friction) = match (evidence.road_friction(), evidence.drag_factor()) {
            (Some(measured), _) => (PriorSource::Measured, measured),
            (None, Some(drag)) => (PriorSource::Estimated, friction_by_drag(drag)),
            (None, None) => (PriorSource::Assumed, usual),
        };
        let high = HIGHEST_FRICTION.max(friction.value + 4.0 * friction.sigma);
        self.add(Latent::RoadFriction, source, normal(friction.value, friction.sigma, 0.03, high));
        self.assume(
            Latent::TireFrictionFactor,
            log_normal(TIRE_FRICTION_FACTOR, TIRE_FRICTION_SCATTER, 0.7, 1.4),
        );
        self.assume(
            Latent::LongitudinalFrictionRatio,
            log_normal(LONGITUDINAL_FRICTION_RATIO, LONGITUDINAL_FRICTION_SCATTER, 0.8, 1.5),
        );
    }

    fn add_masses(&mut self, evidence: &Evidence, cars: &Cars) {
        for (latent, measured, vehicle) in [
            (Latent::StruckMass, evidence.struck_car.mass(), &cars.struck),
            (Latent::StrikingMass, evidence.striking_car.mass(), &cars.striking),
        ] {
            let (source, distribution) = mass_of(measured, vehicle);
            self.add(latent, source, distribution);
        }
        if let Some(sigma) = evidence.weighing.and_then(|scale| scale.shared_scale_sigma) {
            let reach = (4.0 * sigma).exp();
            let scale = log_normal(1.0, sigma, 1.0 / reach, reach);
            self.add(Latent::MassScaleFactor, PriorSource::Given, scale);
        }
    }

    /// What a data sheet leaves open of the struck car beside its mass.
    fn add_struck_car(&mut self, cars: &Cars) {
        for (latent, quantity) in [
            (Latent::YawInertiaFactor, SheetQuantity::YawInertia),
            (Latent::FrontCorneringFactor, SheetQuantity::FrontCornering),
            (Latent::RearCorneringFactor, SheetQuantity::RearCornering),
        ] {
            match cars.struck.scatter(quantity) {
                Some(sigma) => {
                    let reach = (3.0 * sigma).exp();
                    let factor = log_normal(1.0, sigma, 1.0 / reach, reach);
                    self.add(latent, PriorSource::Estimated, factor);
                }
                None => self.fixed.set(latent, 1.0),
            }
        }
        let tires = &cars.struck.parameters.tires;
        for (latent, quantity, value, [low, high]) in [
            (
                Latent::SlidingRatio,
                SheetQuantity::SlidingRatio,
                tires.sliding_friction_ratio,
                [0.5, 1.0],
            ),
            (
                Latent::RollingResistance,
                SheetQuantity::RollingResistance,
                tires.rolling_resistance,
                [0.004, 0.05],
            ),
        ] {
            match cars.struck.scatter(quantity) {
                Some(sigma) => {
                    let is_sliding = latent == Latent::SlidingRatio;
                    let sigma = if is_sliding { sigma.max(SLIDING_SCATTER) } else { sigma };
                    self.add(latent, PriorSource::Estimated, log_normal(value, sigma, low, high));
                }
                None => self.fixed.set(latent, value),
            }
        }
    }

    /// Skids before the impact: what was measured of them.
    fn add_skids(&mut self, evidence: &Evidence) {
        for (skid, length, drag) in [
            (&evidence.skid_before, Latent::SkidLength, Latent::SkidDrag),
            (&evidence.striking_skid_before, Latent::StrikingSkidLength, Latent::StrikingSkidDrag),
        ] {
            let Some(skid) = skid else { continue };
            for (latent, measured) in [(length, skid.length()), (drag, skid.drag_factor())] {
                let Some(Measured { value, sigma }) = measured else { continue };
                let low = (value - 4.0 * sigma).max(0.0);
                let distribution = normal(value, sigma, low, value + 4.0 * sigma);
                self.add(latent, PriorSource::Measured, distribution);
            }
        }
        if evidence.striking_skid_before.is_some() {
            self.assume_striking_tires();
        }
    }
}

/// Peak friction of a road of which the drag of locked wheels is known; how well it is known is left to the
/// comparison with the drag.
fn friction_by_drag(drag: Measured) -> Measured {
    let locked = TIRE_FRICTION_FACTOR * LONGITUDINAL_FRICTION_RATIO * USUAL_SLIDING_RATIO;
    Measured { value: drag.value / locked, sigma: FRICTION_SIGMA_BY_DRAG * drag.value / locked }
}

/// The sign of a turn to the left that is a turn towards the struck side.
pub(super) fn towards(side: Side) -> f64 {
    match side {
        Side::Left | Side::Rear => -1.0,
        Side::Right | Side::Front => 1.0,
    }
}

/// The mass of a car: as it was weighed, by the rule of its data sheet, or that of the chosen vehicle.
fn mass_of(measured: Option<Measured>, vehicle: &Car) -> (PriorSource, Distribution) {
    let kg = vehicle.parameters.mass.mass_kg;
    let weighed =
        |Measured { value, sigma }: Measured| normal(value, sigma, 0.5 * value, 1.5 * value);
    match (measured, vehicle.mass_scatter()) {
        (Some(measured), _) => (PriorSource::Measured, weighed(measured)),
        (None, Some(sigma)) => (PriorSource::Estimated, log_normal(kg, sigma, 0.5 * kg, 2.0 * kg)),
        (None, None) => {
            let of_sheet = Measured { value: kg, sigma: DEFAULT_MASS_SHARE * kg };
            (PriorSource::Given, weighed(of_sheet))
        }
    }
}

fn normal(mean: f64, sigma: f64, low: f64, high: f64) -> Distribution {
    Distribution::Normal { mean, sigma, low, high }
}

fn log_normal(median: f64, sigma: f64, low: f64, high: f64) -> Distribution {
    Distribution::LogNormal { median, sigma, low, high }
}
