//! How a motion ends: what the driver does after the impact, and what the damage does to the wheels,
//! in everyday terms. [`Ending::controls`] makes histories of steer angle and wheels of it.
//!
//! A vehicle that brakes with deceleration d divides its braking force between the axles so that both
//! reach the limit of friction together (the ideal distribution, [`Gillespie1992`], chapter 3):
//!
//! ```text
//! F_front/F = (l_r + h d/g)/(l_f + l_r)        F = m d, d at most μ g
//! ```
//!
//! A brake without an anti-lock system that asks for more than the road can hold locks its wheels.
//! Anti-lock system, stability control and drivers who react to the motion are in `drivers/`.
//!
//! [`Gillespie1992`]: crate::bibliography::Gillespie1992

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ranges::{
    BRAKE_FRONT_SHARE, BRAKE_RISE, BRAKE_SHARE, CONTROL_TIME, DRAG_SHARE, DRIVE_TORQUE,
    ENGINE_BRAKING, Range, STEER_ANGLE,
};
use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::controls::{Controls, SteerHistory, WheelHistory};
use crate::vehicle::drivers::{AntiLock, ClosedLoop, Countersteer, PitDriver, StabilityControl};
use crate::vehicle::tire::WheelEffort;
use crate::vehicle::{VehicleParameters, Wheel};

/// Time over which the braking force rises where nobody says it, s: from the first touch of the
/// pedal to the full force of an emergency braking.
pub const DEFAULT_BRAKE_RISE_S: f64 = 0.3;

/// Time over which a damaged wheel is caught, s.
const CATCH_S: f64 = 0.01;

/// What happens to the wheels after the first contact. By default the vehicle coasts.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Ending {
    /// The driver brakes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub brake: Option<Braking>,
    /// The engine brakes, in gear and without throttle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub engine: Option<EngineBraking>,
    /// The driver accelerates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drive: Option<Driving>,
    /// Wheels that bent bodywork or a broken suspension drags or locks.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub damage: Vec<DamagedWheel>,
    /// The front wheels are turned.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steer: Option<HeldSteer>,
    /// The vehicle has a stability control, and with it an anti-lock system.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub esc: Option<StabilityControl>,
    /// The driver countersteers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub countersteer: Option<Countersteer>,
    /// The driver turns the vehicle into another one (PIT).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pit: Option<PitDriver>,
}

/// Braking by the driver, with all wheels.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Braking {
    /// When the force begins to rise, s after the first contact.
    pub start_s: f64,
    /// Braking force over what the road can hold at most, μ m g, with the friction μ of the vehicle's
    /// tires: the pedal does not know of friction zones. Without an anti-lock system more than 1 locks all
    /// wheels; on a zone with less friction less does.
    pub share_of_friction: f64,
    /// How long the force rises, s.
    #[serde(default = "default_brake_rise_s")]
    pub rise_s: f64,
    /// Share of the front axle in the braking force; as both axles reach the limit together if `None`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub front_share: Option<f64>,
    /// How long the force stays at what the road can just hold, if it is to be more than that, s: the
    /// wheels go on turning for that time before they lock.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub lock_delay_s: f64,
    /// Anti-lock system; none if `None`, but for a vehicle with a stability control.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub abs: Option<AntiLock>,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn default_brake_rise_s() -> f64 {
    DEFAULT_BRAKE_RISE_S
}

/// An axle of the vehicle, or both.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    strum::IntoStaticStr,
    strum::VariantArray,
    strum::VariantNames,
    JsonSchema,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum DrivenAxle {
    /// The front axle.
    #[default]
    Front,
    /// The rear axle.
    Rear,
    /// Both axles alike.
    All,
}

/// Braking by the engine through an open differential.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EngineBraking {
    /// Deceleration of the whole vehicle that it causes on a straight course, m/s².
    pub deceleration_m_s2: f64,
    /// The axle that is driven.
    #[serde(default)]
    pub axle: DrivenAxle,
}

/// Drive by the engine, through an open differential.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Driving {
    /// Torque at the wheels of each driven axle together, N m. It does not depend on the speed.
    pub torque_n_m: f64,
    /// The axle that is driven.
    #[serde(default)]
    pub axle: DrivenAxle,
    /// When the torque begins to rise, s after the first contact.
    #[serde(default)]
    pub start_s: f64,
    /// How long it rises, s.
    #[serde(default = "default_brake_rise_s")]
    pub rise_s: f64,
}

/// A wheel that is dragged or locked.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DamagedWheel {
    /// The wheel.
    pub wheel: Wheel,
    /// When it is caught, s after the first contact.
    #[serde(default)]
    pub start_s: f64,
    /// Drag over what the road can hold at the static load of the wheel, μ F_z, with the friction μ of
    /// the vehicle's tires, also on friction zones; a locked wheel if `None`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drag_share_of_friction: Option<f64>,
}

/// A steer angle that is reached and held.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeldSteer {
    /// When the wheels begin to turn, s after the first contact.
    pub start_s: f64,
    /// How long they turn, s.
    #[serde(default = "default_brake_rise_s")]
    pub rise_s: f64,
    /// Angle of the front road wheels, rad, positive to the left.
    pub road_wheel_rad: f64,
}

impl Ending {
    /// Whether nothing acts on the wheels.
    pub fn is_coasting(&self) -> bool {
        *self == Self::default()
    }

    /// Every stated number with its name and its range.
    pub fn ranges(&self) -> Vec<(String, f64, Range)> {
        let mut numbers = Vec::new();
        let mut add = |name: &str, value, range| numbers.push((name.to_owned(), value, range));
        if let Some(brake) = &self.brake {
            add("brake.start_s", brake.start_s, CONTROL_TIME);
            add("brake.share_of_friction", brake.share_of_friction, BRAKE_SHARE);
            add("brake.rise_s", brake.rise_s, BRAKE_RISE);
            if let Some(share) = brake.front_share {
                add("brake.front_share", share, BRAKE_FRONT_SHARE);
            }
            if brake.lock_delay_s > 0.0 {
                add("brake.lock_delay_s", brake.lock_delay_s, CONTROL_TIME);
            }
            for (name, value, range) in brake.abs.iter().flat_map(AntiLock::ranges) {
                add(&format!("brake.abs.{name}"), value, range);
            }
        }
        if let Some(engine) = &self.engine {
            add("engine.deceleration_m_s2", engine.deceleration_m_s2, ENGINE_BRAKING);
        }
        if let Some(drive) = &self.drive {
            add("drive.torque_n_m", drive.torque_n_m, DRIVE_TORQUE);
            add("drive.start_s", drive.start_s, CONTROL_TIME);
            add("drive.rise_s", drive.rise_s, BRAKE_RISE);
        }
        for (i, wheel) in self.damage.iter().enumerate() {
            add(&format!("damage[{i}].start_s"), wheel.start_s, CONTROL_TIME);
            if let Some(share) = wheel.drag_share_of_friction {
                add(&format!("damage[{i}].drag_share_of_friction"), share, DRAG_SHARE);
            }
        }
        if let Some(steer) = &self.steer {
            add("steer.start_s", steer.start_s, CONTROL_TIME);
            add("steer.rise_s", steer.rise_s, BRAKE_RISE);
            add("steer.road_wheel_rad", steer.road_wheel_rad, STEER_ANGLE);
        }
        for (name, value, range) in self.esc.iter().flat_map(StabilityControl::ranges) {
            add(&format!("esc.{name}"), value, range);
        }
        for (name, value, range) in self.countersteer.iter().flat_map(Countersteer::ranges) {
            add(&format!("countersteer.{name}"), value, range);
        }
        for (name, value, range) in self.pit.iter().flat_map(PitDriver::ranges) {
            add(&format!("pit.{name}"), value, range);
        }
        numbers
    }

    /// The anti-lock system of the service brake: its own, or that of the stability control.
    pub fn anti_lock(&self) -> Option<AntiLock> {
        let own = self.brake.and_then(|brake| brake.abs);
        own.or_else(|| self.esc.map(|_| AntiLock::default()))
    }

    /// Whether something drives, brakes or locks wheels at its own times. A stability control does not.
    pub fn acts_on_wheels(&self) -> bool {
        let by_driver = self.brake.is_some() || self.drive.is_some() || self.pit.is_some();
        by_driver || self.engine.is_some() || !self.damage.is_empty()
    }

    /// Whether something steers.
    pub fn steers(&self) -> bool {
        self.steer.is_some() || self.countersteer.is_some() || self.pit.is_some()
    }

    /// Steer angle and wheels over time for a vehicle, and what acts by its motion. A brake with an
    /// anti-lock system is part of the latter.
    pub fn controls(&self, vehicle: &VehicleParameters) -> Controls {
        let steer = self.steer.map(|steer| SteerHistory {
            time_s: vec![steer.start_s, steer.start_s + steer.rise_s],
            steer_rad: vec![0.0, steer.road_wheel_rad],
        });
        let closed_loop = ClosedLoop::from_ending(self);
        let is_watched = closed_loop.as_ref().is_some_and(|it| it.brake.is_some());
        let brake = self.brake.filter(|_| !is_watched);
        let histories = Self { brake, esc: None, pit: None, ..self.clone() };
        Controls { steer, wheels: histories.wheels(vehicle), closed_loop }
    }

    fn wheels(&self, vehicle: &VehicleParameters) -> Option<WheelHistory> {
        if !self.acts_on_wheels() {
            return None;
        }
        let brake = self.brake.iter().flat_map(|it| it.rises(vehicle).map(|(time_s, _)| time_s));
        let drive = self.drive.into_iter().flat_map(|it| [it.start_s, it.start_s + it.rise_s]);
        let damage = self.damage.iter().flat_map(|it| [it.start_s, it.start_s + CATCH_S]);
        let mut time_s: Vec<f64> = brake.chain(drive).chain(damage).chain([0.0]).collect();
        time_s.sort_by(f64::total_cmp);
        time_s.dedup();
        let wheels = time_s.iter().map(|&t| self.at(vehicle, t)).collect();
        Some(WheelHistory { time_s, wheels })
    }

    /// The wheels at an instant. Between the instants of [`Ending::wheels`] all of it is linear.
    fn at(&self, vehicle: &VehicleParameters, time_s: f64) -> [WheelEffort<f64>; 4] {
        let risen = |start_s: f64, rise_s: f64| ((time_s - start_s) / rise_s).clamp(0.0, 1.0);
        let static_loads_n = vehicle.static_loads_n();
        Wheel::ALL.map(|wheel| {
            let mut effort = WheelEffort::<f64>::none();
            if let Some(brake) = &self.brake {
                effort.braking_n += brake.force_n(vehicle, wheel, time_s);
            }
            if let Some(engine) = &self.engine {
                effort.braking_n += engine.force_n(vehicle, wheel);
            }
            if let Some(drive) = &self.drive {
                let full_n = drive.torque_n_m / 2.0 / vehicle.tires.rolling_radius_m;
                let risen = risen(drive.start_s, drive.rise_s);
                effort.drive_n += if drive.axle.drives(wheel) { full_n * risen } else { 0.0 };
            }
            for damaged in self.damage.iter().filter(|damaged| damaged.wheel == wheel) {
                let caught = risen(damaged.start_s, CATCH_S);
                match damaged.drag_share_of_friction {
                    None => effort.locked = effort.locked.max(caught),
                    Some(share) => {
                        let load_n = static_loads_n[wheel.index()];
                        effort.braking_n += share * vehicle.tires.friction * load_n * caught;
                    }
                }
            }
            effort
        })
    }
}

/// Braking force over the largest that the road can hold at which wheels just turn, and at which all
/// of them are locked.
const HELD_AND_LOCKED: [f64; 2] = [0.97, 1.25];

/// Shortest time in which wheels that have stopped turning are locked, s.
const LOCKING_S: f64 = 0.05;

impl Braking {
    /// Braking by both axles alike that locks the wheels as soon as the road cannot hold them.
    pub const fn new(start_s: f64, share_of_friction: f64, rise_s: f64) -> Self {
        let (front_share, lock_delay_s, abs) = (None, 0.0, None);
        Self { start_s, share_of_friction, rise_s, front_share, lock_delay_s, abs }
    }

    /// Instants between which the force is linear over time, and its share of μ m g there.
    fn rises(&self, vehicle: &VehicleParameters) -> [(f64, f64); 4] {
        let Self { start_s, share_of_friction: full, rise_s, lock_delay_s: delay_s, .. } = *self;
        let ratio = vehicle.tires.longitudinal_friction_ratio;
        let [held, locked] = HELD_AND_LOCKED.map(|share| share * ratio);
        if delay_s <= 0.0 || full <= held {
            let end = (start_s + rise_s, full);
            return [(start_s, 0.0), end, end, end];
        }
        let held_s = start_s + rise_s * held / full;
        let locking_s = (rise_s * (1.0 - held / full)).max(LOCKING_S);
        [
            (start_s, 0.0),
            (held_s, held),
            (held_s + delay_s, held),
            (held_s + delay_s + locking_s, full.max(locked)),
        ]
    }

    /// Force over μ m g at an instant.
    fn share_at(&self, vehicle: &VehicleParameters, time_s: f64) -> f64 {
        let rises = self.rises(vehicle);
        match rises.windows(2).find(|pair| time_s < pair[1].0) {
            Some(&[(from_s, from), (to_s, to)]) => {
                from + (to - from) * ((time_s - from_s) / (to_s - from_s)).max(0.0)
            }
            _ => rises[3].1,
        }
    }

    /// Braking force of a wheel at an instant, N.
    pub(super) fn force_n(&self, vehicle: &VehicleParameters, wheel: Wheel, time_s: f64) -> f64 {
        let front = self.front_share.unwrap_or_else(|| self.ideal_front_share(vehicle));
        let of_axle = if wheel.is_front() { front } else { 1.0 - front };
        let weight_n = vehicle.mass.mass_kg * STANDARD_GRAVITY_M_S2;
        let total_n = self.share_at(vehicle, time_s) * vehicle.tires.friction * weight_n;
        total_n * of_axle.clamp(0.0, 1.0) / 2.0
    }

    /// Share of the front axle with which both axles reach the limit of friction together.
    pub fn ideal_front_share(&self, vehicle: &VehicleParameters) -> f64 {
        let geometry = &vehicle.geometry;
        let wheelbase_m = geometry.cg_to_front_axle_m + geometry.cg_to_rear_axle_m;
        // The brakes are laid out for the limit of friction; beyond it both axles get more alike.
        let deceleration_g = self.share_of_friction.min(1.0) * vehicle.tires.friction;
        (geometry.cg_to_rear_axle_m + geometry.cg_height_m * deceleration_g) / wheelbase_m
    }
}

impl DrivenAxle {
    /// All of them.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;
    /// Their words in a file, in the order of [`DrivenAxle::ALL`].
    pub const WORDS: &'static [&'static str] = <Self as strum::VariantNames>::VARIANTS;

    /// Its word in a file and in a list.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// A force that the driven wheels share, N.
    pub(super) fn shared_n(self, force_n: f64) -> [f64; 4] {
        let n_driven = Wheel::ALL.into_iter().filter(|wheel| self.drives(*wheel)).count();
        Wheel::ALL.map(|wheel| if self.drives(wheel) { force_n / n_driven as f64 } else { 0.0 })
    }

    fn drives(self, wheel: Wheel) -> bool {
        match self {
            Self::All => true,
            Self::Front => wheel.is_front(),
            Self::Rear => !wheel.is_front(),
        }
    }
}

impl EngineBraking {
    fn force_n(&self, vehicle: &VehicleParameters, wheel: Wheel) -> f64 {
        self.axle.shared_n(vehicle.mass.mass_kg * self.deceleration_m_s2)[wheel.index()]
    }
}
