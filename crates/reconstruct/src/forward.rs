//! From the quantities of a particle to the motion of the cars: the planar impact, its impulse as a
//! pulse on the struck car, and the 4DOF vehicle to rest; of a single car (`single_car.rs`) the 4DOF vehicle
//! alone. Where later contacts are followed (`later_contact.rs`), both cars go on together if they meet again.
//!
//! World axes: origin at the CG of the struck car at first contact, X along its heading, Y to the left.
//!
//! Assumptions: the struck car drives straight ahead before the impact; both cars are rigid during it
//! and touch at one point; the striking car touches with the corner or the front that its heading turns
//! towards the struck side; the contact lies 0.55 m above the road. Where the ground has zones, each wheel
//! stands on the friction of its own; a slope of the road moves both cars.

mod endings;

use rayon::prelude::*;

use crate::evidence::{Evidence, ends};
use crate::forward::endings::contact_load;
use crate::held_wheels::{BLOCKED_FROM_S, HeldWheels, wheels_near};
use crate::later_contact::{FollowedCar, Later, LaterContacts, ParticleContact};
use crate::single_car::StartPlace;
use crate::skid::Skid;
use crate::{Cars, ImpactState, Latent, LatentValues, Prior};
use impactlab_core::collision::Side;
use impactlab_core::numerics::interpolate;
use impactlab_core::vehicle::{
    FrictionZone, Manoeuvre, Path, PathLimit, RoadSlope, SimulationRun, VehicleParameters,
    VehicleState, simulate_paths,
};

/// Height of the contact above the road, m: sills and bumpers of passenger cars. It is a little above that of
/// single impacts and of the law of contact; the intervals of reconstructions were measured with it.
pub(crate) const CONTACT_HEIGHT_M: f64 = 0.55;

/// Time before the start from which on a single car is steered and its held wheels are, s.
const HELD_BEFORE_S: f64 = 0.5;

/// Longest motion that is followed, s.
const LONGEST_MOTION_S: f64 = 40.0;

/// A collision, or the motion of a single car, that was followed to rest.
#[derive(Debug, Clone, PartialEq)]
pub struct CollisionMotion {
    /// The quantities that it follows from.
    pub values: LatentValues,
    /// The impact; `None` of a single car.
    pub impact: Option<ImpactState>,
    /// The struck car, or the single one, as it was simulated.
    pub vehicle: VehicleParameters,
    /// What was done to it.
    pub manoeuvre: Manoeuvre,
    /// Its path.
    pub path: Path,
    /// The striking car, where anything of it is evidence or later contacts are followed.
    pub striking: Option<StrikingMotion>,
    /// Whether the cars meet again after the impact; `None` where later contacts are not looked for.
    pub meet_again: Option<bool>,
}

/// The striking car as it was followed.
#[derive(Debug, Clone, PartialEq)]
pub struct StrikingMotion {
    /// The car as it was simulated.
    pub vehicle: VehicleParameters,
    /// What was done to it.
    pub manoeuvre: Manoeuvre,
    /// Its path.
    pub path: Path,
}

/// The forward model of a case.
#[derive(Debug, Clone)]
pub struct ForwardModel {
    pub(super) cars: Cars,
    pub(super) prior: Prior,
    pub(super) side: Side,
    /// Wheels of the struck and of the striking car that damage may hold.
    wheels: [HeldWheels; 2],
    pub(super) restitution: Option<[f64; 2]>,
    /// Skids of the struck and of the striking car before the impact.
    pub(super) skids: [Option<Skid>; 2],
    /// Where a single car is at the start; `None` for a collision.
    start: Option<StartPlace>,
    follows_striking: bool,
    later: Later,
    zones: Vec<FrictionZone>,
    limit: PathLimit,
}

/// A car and what happens to it, before it is simulated.
struct Prepared {
    values: LatentValues,
    impact: Option<ImpactState>,
    vehicle: VehicleParameters,
    manoeuvre: Manoeuvre,
    striking: Option<(VehicleParameters, Manoeuvre)>,
}

impl ForwardModel {
    /// The model of a case.
    pub fn new(evidence: &Evidence, cars: Cars) -> Self {
        let prior = Prior::new(evidence, &cars);
        let side = evidence.damage.struck_side();
        let start = StartPlace::of(evidence, &cars);
        let [from_x_m, from_y_m] = start.map_or([0.0; 2], |start| start.cg_m());
        let places = evidence.places();
        let points = places.iter().flat_map(|place| &place.points_m);
        let distances_m = points.map(|[x, y]| (x - from_x_m).hypot(y - from_y_m));
        let farthest_m = distances_m.fold(0.0, f64::max);
        let held_from_s = if start.is_some() { -HELD_BEFORE_S } else { BLOCKED_FROM_S };
        // Without anything that says where the cars were, they are followed to rest.
        let distance_m = if farthest_m > 0.0 { 1.5 * farthest_m + 20.0 } else { f64::INFINITY };
        Self {
            prior,
            side,
            wheels: [
                HeldWheels {
                    after: evidence.after.clone(),
                    near: wheels_near(side, cars.is_hit_behind_cg(evidence)),
                    which: Latent::BlockedWheel,
                    drag: Latent::BlockedDrag,
                    from_s: held_from_s,
                },
                HeldWheels {
                    after: evidence.striking_after.clone(),
                    near: wheels_near(Side::Front, false),
                    which: Latent::StrikingBlockedWheel,
                    drag: Latent::StrikingBlockedDrag,
                    from_s: BLOCKED_FROM_S,
                },
            ],
            restitution: ends(evidence.prior.restitution),
            skids: Skid::of_both_cars(evidence),
            start,
            follows_striking: evidence.follows_striking_car(),
            later: Later::LeftOut,
            zones: Vec::new(),
            limit: PathLimit { distance_m },
            cars: cars.on_slope(evidence.slope()),
        }
    }

    /// The same on a road with a slope, in the axes of the evidence.
    #[must_use]
    pub fn on_slope(self, slope: RoadSlope) -> Self {
        Self { cars: self.cars.on_slope(slope), ..self }
    }

    /// The same on a ground with zones of their own friction, in the axes of the evidence.
    #[must_use]
    pub fn on_zones(self, zones: Vec<FrictionZone>) -> Self {
        let prior = if zones.is_empty() { self.prior } else { self.prior.with_zones() };
        Self { prior, zones, ..self }
    }

    /// The same with both cars followed through later contacts.
    #[must_use]
    pub fn through_later_contacts(self, evidence: &Evidence) -> Self {
        let later = LaterContacts::new(&self.cars).map_or(Later::LeftOut, Later::Followed);
        let prior = self.prior.with_coasting_striking_car().with_later_contacts(evidence);
        Self { prior, follows_striking: true, later, ..self }
    }

    /// The same model, which also says of each motion whether the cars meet again, as far as their impact
    /// alone moves them. Where the evidence says nothing of the striking car, it coasts.
    #[must_use]
    pub fn watching_contacts(self) -> Self {
        let later = LaterContacts::new(&self.cars).map_or(Later::LeftOut, Later::Watched);
        let prior = self.prior.with_coasting_striking_car();
        Self { prior, follows_striking: true, later, ..self }
    }

    /// The same prior with motions by the impact alone.
    #[cfg(test)]
    pub(crate) fn with_contacts_left_out(self) -> Self {
        let later = match self.later {
            Later::Followed(contacts) => Later::Watched(contacts),
            other => other,
        };
        Self { later, ..self }
    }

    /// Whether the cars are followed together where they meet again.
    pub fn follows_later_contacts(&self) -> bool {
        self.later.are_followed()
    }

    /// The prior of the case.
    pub fn prior(&self) -> &Prior {
        &self.prior
    }

    /// Whether it is that of a single car, which has no impact.
    pub fn is_of_single_car(&self) -> bool {
        self.start.is_some()
    }

    /// Speed that the case is asked for, m/s: that of the struck car before the impact, or that of a single
    /// car at the start.
    pub fn speed_m_s(&self, values: &LatentValues) -> f64 {
        values.get(if self.is_of_single_car() { Latent::CarSpeed } else { Latent::StruckSpeed })
    }

    /// The vehicles of the case.
    pub fn cars(&self) -> &Cars {
        &self.cars
    }

    /// Parts of the ground with their own friction.
    pub fn zones(&self) -> &[FrictionZone] {
        &self.zones
    }

    /// Simulates the motions of particles side by side and on all cores.
    ///
    /// - `told`: what is kept of each motion;
    /// - returns what is kept, in the order of the particles.
    pub fn motions<R: Send>(
        &self,
        z: &[Vec<f64>],
        evaluate: impl Fn(CollisionMotion) -> R + Sync,
    ) -> Vec<R> {
        let prepared: Vec<Prepared> =
            z.par_iter().map(|z| self.prepared(self.prior.values(z))).collect();
        let runs: Vec<SimulationRun<'_>> = prepared
            .iter()
            .map(|motion| SimulationRun { vehicle: &motion.vehicle, manoeuvre: &motion.manoeuvre })
            .collect();
        let striking_vehicles: Vec<SimulationRun<'_>> = prepared
            .iter()
            .filter_map(|motion| motion.striking.as_ref())
            .map(|(vehicle, manoeuvre)| SimulationRun { vehicle, manoeuvre })
            .collect();
        let striking_paths = simulate_paths(&striking_vehicles, self.limit, |_, path| path);
        let told = |idx: usize, struck: FollowedCar, striking: Option<FollowedCar>, meet_again| {
            let Prepared { values, impact, vehicle, striking: of_striking, .. } = &prepared[idx];
            let striking = of_striking.as_ref().zip(striking);
            evaluate(CollisionMotion {
                values: *values,
                impact: *impact,
                vehicle: vehicle.clone(),
                manoeuvre: struck.manoeuvre,
                path: struck.path,
                striking: striking.map(|((vehicle, _), car)| StrikingMotion {
                    vehicle: vehicle.clone(),
                    manoeuvre: car.manoeuvre,
                    path: car.path,
                }),
                meet_again,
            })
        };
        let alone = simulate_paths(&runs, self.limit, |idx, path| {
            let (motion, striking_path) = (&prepared[idx], striking_paths.get(idx));
            let meet_again = self.meet_again(motion, &path, striking_path);
            if meet_again == Some(true) && self.later.are_followed() {
                return None;
            }
            let striking = motion.striking.as_ref().zip(striking_path);
            let striking = striking
                .map(|((_, manoeuvre), path)| FollowedCar::new(manoeuvre.clone(), path.clone()));
            let struck = FollowedCar::new(motion.manoeuvre.clone(), path);
            Some(told(idx, struck, striking, meet_again))
        });
        let followed = |(idx, alone): (usize, Option<R>)| match alone {
            Some(alone) => alone,
            None => {
                let [struck, striking] = self.through_contacts(&prepared[idx], runs[idx]);
                told(idx, struck, Some(striking), Some(true))
            }
        };
        alone.into_par_iter().enumerate().map(followed).collect()
    }

    /// Whether the cars meet again; `None` where that is not looked for.
    fn meet_again(&self, motion: &Prepared, path: &Path, striking: Option<&Path>) -> Option<bool> {
        let from_s = motion.values.get(Latent::PulseDuration);
        Some(self.later.contacts()?.meet_again([path, striking?], from_s))
    }

    /// Both cars through all contacts, with failed paths where they cannot be computed.
    fn through_contacts(&self, motion: &Prepared, struck: SimulationRun<'_>) -> [FollowedCar; 2] {
        let contact = ParticleContact {
            stiffness_factor: motion.values.get(Latent::ContactStiffnessFactor),
            friction: motion.values.get(Latent::ContactFriction),
            normal_rad: motion.impact.map_or(0.0, |impact| impact.normal_rad),
        };
        let striking = motion.striking.as_ref();
        let striking = striking.map(|(vehicle, manoeuvre)| SimulationRun { vehicle, manoeuvre });
        let cars = self.later.contacts().zip(striking);
        let followed = cars
            .and_then(|(later, striking)| later.follow([struck, striking], &contact, self.limit));
        followed.unwrap_or_else(|| {
            let failed = |of: &Manoeuvre| FollowedCar::new(of.clone(), Path::failed());
            [failed(struck.manoeuvre), failed(striking.map_or(struck.manoeuvre, |it| it.manoeuvre))]
        })
    }

    /// Yaw rate of the struck car at the end of the contact, rad/s, of each point: that of the impulse less
    /// what the tires take from it until then. None of them is a number of a single car.
    pub fn yaw_rates_after_rad_s(&self, values: &[LatentValues]) -> Vec<f64> {
        if self.is_of_single_car() {
            return vec![f64::NAN; values.len()];
        }
        let contact_only = |values: &LatentValues| {
            let mut prepared = self.prepared(*values);
            prepared.manoeuvre.duration_s = values.get(Latent::PulseDuration);
            prepared
        };
        let prepared: Vec<Prepared> = values.par_iter().map(contact_only).collect();
        let runs: Vec<SimulationRun<'_>> = prepared
            .iter()
            .map(|motion| SimulationRun { vehicle: &motion.vehicle, manoeuvre: &motion.manoeuvre })
            .collect();
        simulate_paths(&runs, self.limit, |idx, path| {
            let (motion, points) = (&prepared[idx], &path.points);
            let times: Vec<f64> = points.iter().map(|point| point.time_s).collect();
            let rates: Vec<f64> = points.iter().map(|point| point.yaw_rate_rad_s).collect();
            let of_impulse = motion.impact.map(|impact| impact.solution.struck.yaw_rate_rad_s);
            // The last step may reach beyond the contact.
            let at_end = interpolate(&times, &rates, motion.manoeuvre.duration_s);
            at_end.or(of_impulse).unwrap_or(f64::NAN)
        })
    }

    fn prepared(&self, values: LatentValues) -> Prepared {
        let vehicle = self.vehicle(&values);
        let ending = self.ending(&values, &vehicle);
        let impact = self.start.is_none().then(|| self.impact(&values));
        let standing = VehicleState::default();
        let start = self.start.map_or(standing, |start| start.state(&values));
        let initial =
            impact.map_or(start, |impact| VehicleState::driving_straight(impact.struck_speed_m_s));
        let load = |impact: ImpactState| {
            contact_load(impact.solution.impulse_world_n_s, &values, impact.contact_m)
        };
        let manoeuvre = Manoeuvre {
            initial,
            contact_load: impact.map(load),
            controls: ending.controls(&vehicle),
            duration_s: LONGEST_MOTION_S,
            ends_at_rest: true,
            friction_zones: self.zones_under(&values, values.get(Latent::TireFrictionFactor)),
        };
        let followed = impact.filter(|_| self.follows_striking);
        let striking = followed.map(|impact| self.striking(&values, &impact));
        Prepared { values, impact, vehicle, manoeuvre, striking }
    }
}

#[cfg(test)]
#[path = "forward_tests.rs"]
mod tests;
