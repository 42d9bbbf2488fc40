//! The force of the first contact where it is known, and how the contact law takes over from it.
//!
//! While a known history F(t) of the force on the struck vehicle lasts, it drives both vehicles, and the
//! elements of the outlines record their overlap. The loads of the face laws are then scaled by work:
//!
//! ```text
//! s = ∫F · v dt / ∫F_law · v dt        0.3 ≤ s ≤ 3
//! ```
//!
//! with the velocity v of one vehicle relative to the other one where each force acts, and the force F_law
//! (normal loads and friction) that the law would have exerted along the same motion. Work says how stiff
//! the faces were; the impulse is set by the kinematics and does not. At the end of F the scaled law takes
//! over within 10 ms, and the same s holds in every later contact. Where F is the whole of the first
//! contact, the faces have given back at its end what they give: each strip lies at its dent.
//!
//! Assumes that F acts at one place of the struck vehicle, as a recorded history has it.

use crate::collision::contact::{ContactForce, PlanarMotion};
use crate::data::{CumulativeImpulse, ForceAxes, contact_interval};
use crate::vehicle::ContactLoad;
use crate::vehicle::frames::Heading;

/// Bounds of the scale s of the face laws.
pub const LAW_SCALE_RANGE: [f64; 2] = [0.3, 3.0];

/// Time within which the law takes over, s.
const HAND_OVER_S: f64 = 0.01;

/// How the contact law took over from a known force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandOver {
    /// When the known force ended, s.
    pub time_s: f64,
    /// Scale s of the loads of the law, within [`LAW_SCALE_RANGE`].
    pub scale: f64,
    /// Whether s was outside of its range.
    pub is_clamped: bool,
    /// Work of the known force that both vehicles lost, J.
    pub work_j: f64,
    /// Impulse `[P_X, P_Y]` of the known force on the struck vehicle, world axes, N s.
    pub impulse_world_n_s: [f64; 2],
}

/// A known force of the first contact along a run.
#[derive(Debug, Clone)]
pub(super) struct FirstForce {
    impulse: CumulativeImpulse,
    is_in_world_axes: bool,
    uses_moment: bool,
    place_body_m: [f64; 2],
    end_s: f64,
    work_j: f64,
    work_of_law_j: f64,
    impulse_world_n_s: [f64; 2],
}

impl FirstForce {
    /// `None` for a force that is zero throughout.
    pub fn new(load: &ContactLoad) -> Option<Self> {
        let (_, end_s) = contact_interval(&load.force)?;
        Some(Self {
            impulse: load.force.cumulative(),
            is_in_world_axes: load.force.axes == ForceAxes::World,
            uses_moment: load.recorded_moment && load.force.mz_n_m.is_some(),
            place_body_m: [load.contact.x_body_m, load.contact.y_body_m],
            end_s,
            work_j: 0.0,
            work_of_law_j: 0.0,
            impulse_world_n_s: [0.0; 2],
        })
    }

    /// When it ends, s.
    pub fn end_s(&self) -> f64 {
        self.end_s
    }

    /// Its mean over a step. The moment on the striking vehicle is the opposite one about the same place.
    ///
    /// - `motions`: in the middle of the step.
    pub fn over(&self, [from_s, to_s]: [f64; 2], motions: &[PlanarMotion; 2]) -> ContactForce {
        let (components_n, moment_n_m) = self.impulse.mean_over(from_s, to_s);
        let [struck, striking] = motions;
        let heading = Heading::new(struck.yaw_rad);
        let [fx, fy] = match self.is_in_world_axes {
            true => components_n,
            false => heading.world_from_body(components_n),
        };
        let [x, y] = heading.world_from_body(self.place_body_m);
        let of_place = x * fy - y * fx;
        let on_struck = moment_n_m.filter(|_| self.uses_moment).unwrap_or(of_place);
        let [dx, dy] = [0, 1].map(|axis| struck.position_m[axis] - striking.position_m[axis]);
        ContactForce {
            force_world_n: [fx, fy],
            yaw_moments_n_m: [on_struck, -on_struck - (dx * fy - dy * fx)],
            point_world_m: [struck.position_m[0] + x, struck.position_m[1] + y],
            normal_load_n: 0.0,
            overlap_m: 0.0,
            unloading_stiffness_n_per_m: 0.0,
            friction_power_w: 0.0,
            normal_power_w: 0.0,
        }
    }

    /// Adds what both forces did over a step.
    ///
    /// - `known`: the known force, by which the vehicles lost `work_j`;
    /// - `of_law`: what the law would have exerted.
    pub fn add(
        &mut self,
        known: &ContactForce,
        work_j: f64,
        of_law: Option<&ContactForce>,
        step_s: f64,
    ) {
        self.work_j += work_j;
        for (sum, force) in self.impulse_world_n_s.iter_mut().zip(known.force_world_n) {
            *sum += force * step_s;
        }
        let power_w = of_law.map_or(0.0, |law| law.friction_power_w + law.normal_power_w);
        self.work_of_law_j += power_w * step_s;
    }

    /// How the law takes over. Where one of both did no work, nothing is known of the faces, and the law
    /// stays as it is.
    pub fn hand_over(&self) -> HandOver {
        let scale = match self.work_j > 0.0 && self.work_of_law_j > 0.0 {
            true => self.work_j / self.work_of_law_j,
            false => 1.0,
        };
        let [low, high] = LAW_SCALE_RANGE;
        HandOver {
            time_s: self.end_s,
            scale: scale.clamp(low, high),
            is_clamped: !(low..=high).contains(&scale),
            work_j: self.work_j,
            impulse_world_n_s: self.impulse_world_n_s,
        }
    }

    /// Share of the law at an instant, 0 to 1.
    pub fn share_of_law(&self, time_s: f64) -> f64 {
        ((time_s - self.end_s) / HAND_OVER_S).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::collision::Footprint;
    use crate::collision::contact::test_pairs::{
        TestCar, alike, free_body, last_state, simulate, state_at,
    };
    use crate::collision::contact::{
        ContactConditions, CoupledSettings, FaceLaw, PairError, PairMotion, Recovery, VehiclePair,
    };
    use crate::data::{ForceHistory, Sampling};
    use crate::vehicle::{ContactPoint, VehicleState};

    const BOX: Footprint = Footprint { length_m: 4.2, width_m: 1.6, cg_from_front_m: 2.0 };

    /// The force of the closed form of linear springs (oracle 1 of the contact law): peak, N, and the ends
    /// of loading and unloading, s.
    const CLOSED_FORM: (f64, [f64; 2]) = (243.06e3, [51.701e-3, 60.686e-3]);

    /// A car of 1500 kg that stands, struck from behind by one of 1200 kg with 12 m/s under a known force.
    ///
    /// - `factor`: on the stiffness of the law;
    /// - `offset_m`: of the place of the force to the left.
    fn struck_from_behind(factor: f64, offset_m: f64) -> [TestCar; 2] {
        let mut cars = [(1500.0, 1.6e6, 0.0, 0.0), (1200.0, 1.0e6, -4.2, 12.0)].map(
            |(mass_kg, k, x_m, vx_body_m_s)| {
                let recovery = Recovery::constant(0.0302);
                let law = FaceLaw::linear(factor * k / BOX.width_m, recovery).unwrap();
                let initial = VehicleState { x_m, vx_body_m_s, ..VehicleState::default() };
                let body = free_body(mass_kg, 2500.0, BOX);
                TestCar::new(body, [0.0, 0.1], alike(law), initial)
            },
        );
        let (peak_n, [loaded_s, end_s]) = CLOSED_FORM;
        let time_s: Vec<f64> = (0..=400).map(|i| end_s * f64::from(i) / 400.0).collect();
        let force_n = |t: &f64| match *t < loaded_s {
            true => peak_n * (FRAC_PI_2 * t / loaded_s).sin(),
            false => peak_n * (FRAC_PI_2 * (t - loaded_s) / (end_s - loaded_s)).cos(),
        };
        let force = ForceHistory {
            axes: ForceAxes::Body,
            sampling: Sampling::Instant,
            fx_n: time_s.iter().map(force_n).collect(),
            fy_n: vec![0.0; time_s.len()],
            mz_n_m: None,
            time_s,
        };
        let contact = ContactPoint { x_body_m: -2.2, y_body_m: offset_m, height_m: 0.5 };
        let load = ContactLoad { force, contact, recorded_moment: false };
        cars[0].manoeuvre.contact_load = Some(load);
        cars
    }

    const UNDAMPED: ContactConditions =
        ContactConditions { friction: 0.4, damping_s_m: 0.0, height_m: 0.5 };

    fn moved(cars: &[TestCar; 2]) -> PairMotion {
        simulate([&cars[0], &cars[1]], UNDAMPED, 1).unwrap()
    }

    #[test]
    fn the_law_is_scaled_to_the_work_of_the_known_force() {
        for (factor, expected) in [(1.0, 1.0), (0.5, 2.0), (2.0, 0.5), (0.1, 3.0), (10.0, 0.3)] {
            let motion = moved(&struck_from_behind(factor, 0.0));
            let hand_over = motion.hand_over.unwrap();
            assert!((hand_over.scale / expected - 1.0).abs() < 0.02, "{factor}: {hand_over:?}");
            assert_eq!(hand_over.is_clamped, !(0.4..=2.5).contains(&expected), "{hand_over:?}");
            let phase = motion.phases[0];
            assert!((phase.impulse_world_n_s[0] - 9390.3).abs() < 10.0, "{factor}: {phase:?}");
            let energy = motion.energy;
            assert!((energy.first_force_j - 46.55e3).abs() < 300.0, "{factor}: {energy:?}");
            assert!(hand_over.work_j == energy.first_force_j, "{hand_over:?} {energy:?}");
        }
    }

    #[test]
    fn a_force_that_is_the_whole_of_the_first_contact_leaves_nothing_to_give_back() {
        let mut cars = struck_from_behind(1.0, 0.0);
        let force = &mut cars[0].manoeuvre.contact_load.as_mut().unwrap().force;
        // As far as both have the same speed: an impulse without restitution.
        let loaded = force.time_s.iter().filter(|time_s| **time_s < CLOSED_FORM.1[0]).count();
        for column in [&mut force.time_s, &mut force.fx_n, &mut force.fy_n] {
            column.truncate(loaded);
        }
        let alone_n_s = 9390.3 / 1.173_78;
        let [whole, part] = [true, false].map(|first_force_is_whole| {
            let vehicles = [&cars[0], &cars[1]].map(TestCar::in_pair);
            let pair = VehiclePair {
                vehicles,
                conditions: UNDAMPED,
                settings: CoupledSettings { first_force_is_whole, ..CoupledSettings::default() },
            };
            pair.simulate().unwrap().phases[0].impulse_world_n_s[0]
        });
        assert!((whole / alone_n_s - 1.0).abs() < 0.01, "{whole}, expected {alone_n_s}");
        assert!((part / alone_n_s - 1.0).abs() > 0.1, "the faces give back: {part}");
    }

    #[test]
    fn momentum_is_kept_under_a_known_force_and_as_the_law_takes_over() {
        // Half of the force leaves the cars pushing each other, so that the law has to go on.
        let mut cars = struck_from_behind(1.0, 0.4);
        let load = cars[0].manoeuvre.contact_load.as_mut().unwrap();
        load.force.fx_n.iter_mut().for_each(|force| *force *= 0.5);
        let motion = moved(&cars);
        let total = |sample: &dyn Fn(usize) -> VehicleState<f64>| -> [f64; 3] {
            let of_car = [0, 1].map(|i| cars[i].momentum(&sample(i)));
            [0, 1, 2].map(|i| of_car[0][i] + of_car[1][i])
        };
        let before = total(&|i| state_at(&motion.motions[i], 0));
        let after = total(&|i| last_state(&motion.motions[i]));
        for (before, after) in before.iter().zip(after) {
            assert!((before - after).abs() < 1e-9 * 14_400.0 * 5.0, "{before} {after}");
        }
        let by_law_j = motion.energy.absorbed_j - motion.energy.first_force_j;
        assert!(by_law_j > 1e3, "{:?}", motion.energy);
        let first = motion.phases[0].vehicles[0].delta_v_m_s;
        assert!(first > 0.6 * 9390.3 / 1500.0, "the push goes on: {:?}", motion.phases);
    }

    #[test]
    fn the_striking_vehicle_has_no_force_of_its_own() {
        let mut cars = struck_from_behind(1.0, 0.0);
        cars[1].manoeuvre.contact_load = cars[0].manoeuvre.contact_load.clone();
        let found = simulate([&cars[0], &cars[1]], ContactConditions::default(), 1);
        assert_eq!(found.unwrap_err(), PairError::CollisionForce);
    }
}
