//! What is not known of two vehicles that push each other, and its draws.
//!
//! Every quantity follows from standard normal values of its own, which fill their space evenly over the
//! draws (Latin hypercube). Factors are lognormal.

use crate::response::{RESISTANCE_SCATTER, with_resistance};
use impactlab_core::collision::contact::{
    ByFace, CONTACT_FRICTION_SIGMA, ContactConditions, ELASTIC_DEPTH_LOG_SIGMA, FaceLaws,
    stiffness_log_sigma,
};
use impactlab_core::numerics::{latin_normals, random_stream};
use impactlab_core::vehicle::{
    ClosedLoop, CrushParameters, Manoeuvre, VehicleParameters, ZONE_FRICTION_LOG_SIGMA,
};

/// Bounds of the coefficient of friction between vehicles.
const CONTACT_FRICTION_RANGE: [f64; 2] = [0.1, 0.9];

/// Bounds of the share that the elastic branch gives back.
const RECOVERY_RANGE: [f64; 2] = [0.0, 0.3];

/// Standard deviations of what is not known of two vehicles that push each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairScatter {
    /// Factor on those of the faces, see
    /// [`STIFFNESS_LOG_SIGMA`](impactlab_core::collision::contact::STIFFNESS_LOG_SIGMA).
    pub faces: f64,
    /// Of the coefficient of friction between the vehicles.
    pub contact_friction: f64,
    /// Of the logarithm of the length of the elastic branch of a vehicle.
    pub elastic_depth_log: f64,
    /// Of the share that the elastic branch gives back.
    pub elastic_recovery: f64,
    /// Of the logarithm of the friction of the tires of a vehicle.
    pub tire_friction_log: f64,
    /// Of the logarithm of the friction of all zones of the ground together, which is that of both vehicles.
    pub zone_friction_log: f64,
    /// Of the logarithm of the cornering stiffness of an axle.
    pub cornering_log: f64,
    /// Of the logarithm of a factor on the steer angle of a vehicle: compliance of its steering.
    pub steer_log: f64,
    /// Of the logarithm of a factor on the brake and drive torques of a vehicle.
    pub torque_log: f64,
    /// Whether numbers of drivers and systems are drawn that are not stated.
    pub drivers: bool,
    /// Of the logarithm of the rolling resistance of a vehicle.
    pub rolling_log: f64,
    /// Of the logarithm of its air drag.
    pub air_log: f64,
    /// Of what the equations of motion miss of the acceleration of a vehicle that turns or slides,
    /// along its body axes, m/s².
    pub missed_m_s2: f64,
    /// The same of its yaw acceleration, rad/s².
    pub missed_rad_s2: f64,
}

impl Default for PairScatter {
    fn default() -> Self {
        Self {
            faces: 1.0,
            contact_friction: CONTACT_FRICTION_SIGMA,
            elastic_depth_log: ELASTIC_DEPTH_LOG_SIGMA,
            elastic_recovery: 0.03,
            tire_friction_log: 0.05,
            zone_friction_log: ZONE_FRICTION_LOG_SIGMA,
            cornering_log: 0.12,
            steer_log: 0.05,
            torque_log: 0.08,
            drivers: true,
            rolling_log: RESISTANCE_SCATTER[0],
            air_log: RESISTANCE_SCATTER[1],
            missed_m_s2: 0.25,
            missed_rad_s2: 0.1,
        }
    }
}

impl PairScatter {
    /// Nothing is uncertain.
    pub const NONE: Self = Self {
        faces: 0.0,
        contact_friction: 0.0,
        elastic_depth_log: 0.0,
        elastic_recovery: 0.0,
        tire_friction_log: 0.0,
        zone_friction_log: 0.0,
        cornering_log: 0.0,
        steer_log: 0.0,
        torque_log: 0.0,
        drivers: false,
        rolling_log: 0.0,
        air_log: 0.0,
        missed_m_s2: 0.0,
        missed_rad_s2: 0.0,
    };

    /// All standard deviations multiplied by a factor.
    #[must_use]
    pub fn widened(self, factor: f64) -> Self {
        Self {
            faces: self.faces * factor,
            contact_friction: self.contact_friction * factor,
            elastic_depth_log: self.elastic_depth_log * factor,
            elastic_recovery: self.elastic_recovery * factor,
            tire_friction_log: self.tire_friction_log * factor,
            zone_friction_log: self.zone_friction_log * factor,
            cornering_log: self.cornering_log * factor,
            steer_log: self.steer_log * factor,
            torque_log: self.torque_log * factor,
            drivers: self.drivers,
            rolling_log: self.rolling_log * factor,
            air_log: self.air_log * factor,
            missed_m_s2: self.missed_m_s2 * factor,
            missed_rad_s2: self.missed_rad_s2 * factor,
        }
    }
}

/// Standard normal values of a vehicle.
const N_OF_VEHICLE: usize = 12;

/// Further values of a vehicle: rolling resistance and air drag.
const N_OF_RESISTANCE: usize = 2;

/// Standard normal values of a draw: friction and recovery of the contact, then both vehicles, then the
/// resistance of both, then their drivers and systems, then the zones of the ground.
const N_LATENTS: usize = ZONE_FRICTION + 1;

const FIRST_OF_RESISTANCE: usize = 2 + 2 * N_OF_VEHICLE;
const FIRST_OF_DRIVER: usize = FIRST_OF_RESISTANCE + 2 * N_OF_RESISTANCE;
const ZONE_FRICTION: usize = FIRST_OF_DRIVER + 2 * ClosedLoop::N_DRAWN;

/// Standard normal values of all draws.
pub(super) struct PairLatents {
    /// Of each quantity over the draws.
    columns: Vec<Vec<f64>>,
}

impl PairLatents {
    pub fn new(n_draws: usize, seed: u64) -> Self {
        let column = |idx: usize| {
            latin_normals(n_draws, &mut random_stream(seed, "pair of vehicles", idx as u64))
        };
        Self { columns: (0..N_LATENTS).map(column).collect() }
    }

    fn at(&self, draw: usize, idx: usize) -> f64 {
        self.columns.get(idx).and_then(|column| column.get(draw)).copied().unwrap_or(0.0)
    }

    /// The conditions of the contact of a draw.
    pub fn conditions(
        &self,
        draw: usize,
        median: ContactConditions,
        scatter: &PairScatter,
    ) -> ContactConditions {
        let [low, high] = CONTACT_FRICTION_RANGE;
        let friction = median.friction + scatter.contact_friction * self.at(draw, 0);
        ContactConditions { friction: friction.clamp(low, high), ..median }
    }

    /// The faces of a vehicle of a draw.
    ///
    /// - `vehicle`: 0 for the struck, 1 for the striking one;
    /// - `said`: what is known of them.
    pub fn faces(
        &self,
        draw: usize,
        vehicle: usize,
        (median, said): (FaceLaws, &CrushParameters),
        scatter: &PairScatter,
    ) -> FaceLaws {
        let z = |idx: usize| self.at(draw, 2 + vehicle * N_OF_VEHICLE + idx);
        let latents = ByFace { front: z(0), side: z(1), rear: z(2) };
        let depth = (scatter.elastic_depth_log * z(3)).exp();
        let recovery = scatter.elastic_recovery * self.at(draw, 1);
        let [low, high] = RECOVERY_RANGE;
        let sigma = stiffness_log_sigma(said);
        median.drawn(latents.map(|z| scatter.faces * z), sigma).map(|law| {
            let share = (law.elastic_recovery() + recovery).clamp(low, high);
            law.with_elastic_depth(depth).with_elastic_recovery(share)
        })
    }

    /// What a driver did on which ground, of a draw: the same with factors on steer angles, torques and the
    /// friction of zones, and with numbers of drivers and systems that are not stated.
    pub fn manoeuvre(
        &self,
        draw: usize,
        vehicle: usize,
        median: &Manoeuvre,
        scatter: &PairScatter,
    ) -> Manoeuvre {
        let z = |idx: usize| self.at(draw, 2 + vehicle * N_OF_VEHICLE + 7 + idx);
        let mut drawn = median.clone();
        let steer = (scatter.steer_log * z(0)).exp();
        let torque = (scatter.torque_log * z(1)).exp();
        if let Some(closed_loop) = drawn.controls.closed_loop.as_mut().filter(|_| scatter.drivers) {
            let first = FIRST_OF_DRIVER + vehicle * ClosedLoop::N_DRAWN;
            *closed_loop = closed_loop.drawn(std::array::from_fn(|idx| self.at(draw, first + idx)));
        }
        let zones = (scatter.zone_friction_log * self.at(draw, ZONE_FRICTION)).exp();
        drawn.friction_zones.iter_mut().for_each(|zone| *zone = zone.scaled(zones));
        if let Some(history) = &mut drawn.controls.steer {
            history.steer_rad.iter_mut().for_each(|angle| *angle *= steer);
        }
        if let Some(history) = &mut drawn.controls.wheels {
            for wheel in history.wheels.iter_mut().flatten() {
                wheel.braking_n *= torque;
                wheel.drive_n *= torque;
            }
        }
        drawn
    }

    /// What the equations of motion miss of a vehicle of a draw: v̇_x, v̇_y, m/s², ṙ, rad/s².
    pub fn missed(&self, draw: usize, vehicle: usize, scatter: &PairScatter) -> [f64; 3] {
        let z = |idx: usize| self.at(draw, 2 + vehicle * N_OF_VEHICLE + 9 + idx);
        [scatter.missed_m_s2 * z(0), scatter.missed_m_s2 * z(1), scatter.missed_rad_s2 * z(2)]
    }

    /// A vehicle of a draw: its tires and what resists its motion.
    pub fn vehicle(
        &self,
        draw: usize,
        vehicle: usize,
        median: &VehicleParameters,
        scatter: &PairScatter,
    ) -> VehicleParameters {
        let z = |idx: usize| self.at(draw, 2 + vehicle * N_OF_VEHICLE + 4 + idx);
        let mut drawn = median.clone();
        let tires = &mut drawn.tires;
        tires.friction *= (scatter.tire_friction_log * z(0)).exp();
        tires.cornering_coefficient_front_per_rad *= (scatter.cornering_log * z(1)).exp();
        tires.cornering_coefficient_rear_per_rad *= (scatter.cornering_log * z(2)).exp();
        let of_resistance =
            |idx: usize| self.at(draw, FIRST_OF_RESISTANCE + vehicle * N_OF_RESISTANCE + idx);
        let rolling = (scatter.rolling_log * of_resistance(0)).exp();
        let air = (scatter.air_log * of_resistance(1)).exp();
        with_resistance(&drawn, [rolling, air])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::{FrictionZone, Preset};

    #[test]
    fn draws_have_the_stated_scatter_and_none_has_the_medians() {
        let latents = PairLatents::new(400, 3);
        let vehicle = Preset::Reference.parameters();
        let faces = FaceLaws::by_class(&vehicle).unwrap();
        let conditions = ContactConditions::default();
        let none = PairScatter::NONE;
        assert_eq!(latents.conditions(7, conditions, &none), conditions);
        assert_eq!(latents.vehicle(7, 1, &vehicle, &none), vehicle);
        let unknown = CrushParameters::default();
        let median = latents.faces(7, 0, (faces, &unknown), &none);
        assert!((median.side.onset_n_per_m() / faces.side.onset_n_per_m() - 1.0).abs() < 1e-12);
        let scatter = PairScatter::default();
        let std = |values: Vec<f64>| {
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let square: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
            (square / (values.len() as f64 - 1.0)).sqrt()
        };
        let sides = (0..400).map(|draw| {
            let drawn = latents.faces(draw, 0, (faces, &unknown), &scatter).side.onset_n_per_m();
            (drawn / faces.side.onset_n_per_m()).ln()
        });
        assert!((std(sides.collect()) - 0.4).abs() < 0.02);
        let frictions =
            (0..400).map(|draw| latents.conditions(draw, conditions, &scatter).friction);
        assert!((std(frictions.collect()) - CONTACT_FRICTION_SIGMA).abs() < 0.01);
        let tires = (0..400).map(|draw| {
            (latents.vehicle(draw, 1, &vehicle, &scatter).tires.friction / vehicle.tires.friction)
                .ln()
        });
        assert!((std(tires.collect()) - scatter.tire_friction_log).abs() < 0.005);
    }

    /// Zones counted as known exactly, and intervals of what slid over them were too narrow.
    #[test]
    fn the_friction_of_zones_is_drawn_and_is_that_of_both_vehicles() {
        let latents = PairLatents::new(400, 3);
        let border_m = vec![[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]];
        let zone = |name: &str, friction| FrictionZone {
            name: name.to_owned(),
            border_m: border_m.clone(),
            friction,
        };
        let friction_zones = vec![zone("ice", 0.1), zone("grass", 0.4)];
        let median = Manoeuvre { friction_zones, ..Manoeuvre::default() };
        assert_eq!(latents.manoeuvre(7, 0, &median, &PairScatter::NONE), median);
        let scatter = PairScatter::default();
        let mut logs = Vec::new();
        for draw in 0..400 {
            let [struck, striking] =
                [0, 1].map(|i| latents.manoeuvre(draw, i, &median, &scatter).friction_zones);
            assert_eq!(struck, striking, "one ground");
            let [ice, grass] = [struck[0].friction / 0.1, struck[1].friction / 0.4];
            assert!((ice / grass - 1.0).abs() < 1e-12, "all zones alike: {ice} {grass}");
            logs.push(ice.ln());
        }
        let sigma = (logs.iter().map(|log| log * log).sum::<f64>() / 400.0).sqrt();
        assert!((sigma / ZONE_FRICTION_LOG_SIGMA - 1.0).abs() < 0.03, "{sigma}");
    }
}
