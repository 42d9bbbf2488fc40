//! A generic electronic stability control (ESC), which brakes single wheels of a vehicle that turns
//! more than its driver asks for.
//!
//! ```text
//! r_ref = U δ/(L + K_us U²), at most 0.85 μ g/U        K_us = (1/c_f − 1/c_r)/g, at least 0
//! e     = r − r_ref, smoothed with 50 ms               oversteer: e in the direction of the turn
//! F     = F_full e/e_full                              F_full = μ m g/2
//! F    ≤ κ μ(α) F_z sin(atan(C s)) σ/s                  s = √(σ² + tan²α)
//! ```
//!
//! U is the speed along the vehicle, δ the steer angle of the road wheels, L the wheelbase, r the yaw
//! rate, c the cornering coefficients and C = c/μ. The control comes on where the oversteer exceeds a
//! threshold and goes off at a third of it. It brakes the outer front wheel, and the outer rear wheel as
//! well beyond 10° of side slip. A wheel that is held at the slip ratio σ beside the slip angle α has no
//! more than the part of its friction that points along its slip, as of a tire that slips alike in all
//! directions.
//!
//! The system knows the friction μ of the vehicle's tires, and no friction zones. It acts on oversteer
//! alone: it neither brakes an inner wheel where the vehicle turns too little nor throttles the engine.
//! It is no system of a maker; its public anchor is the test of the standard,
//! [`sine_with_dwell`](crate::vehicle::sine_with_dwell).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ranges::{
    BRAKE_RISE, DEAD_TIME, ESC_ACCELERATION_SHARE, ESC_FILTER, ESC_FULL_ERROR, ESC_OFF_SHARE,
    ESC_SPEED, ESC_THRESHOLD, REAR_BRAKE_SHARE, Range, SIDESLIP, SLIP_RATIO,
};
use crate::units::{KILOMETRE_PER_HOUR_M_S, Phrase, STANDARD_GRAVITY_M_S2};
use crate::vehicle::drivers::numbers::{Number, drawn_words, named, uniform};
use crate::vehicle::{OUTPUT_INTERVAL_S, VehicleParameters, VehicleState, Wheel};

/// An electronic stability control: what is stated of it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StabilityControl {
    /// Time constant by which the error of the yaw rate is smoothed, s; 0.05 s if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub filter_s: Option<f64>,
    /// Oversteer beyond which it comes on, rad/s; 4 to 8 deg/s in cars, 6 deg/s if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threshold_rad_s: Option<f64>,
    /// Share of the threshold below which it goes off, 0 to 1; a third if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub off_share: Option<f64>,
    /// Speed below which it does nothing, m/s; 20 km/h if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub least_speed_m_s: Option<f64>,
    /// Lateral acceleration of the largest reference yaw rate over μ g; 0.85 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration_share: Option<f64>,
    /// Oversteer at which it asks for the full braking force of a wheel, rad/s; 0.25 rad/s if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub full_error_rad_s: Option<f64>,
    /// Slip ratio at which the wheels are held; 0.1 to 0.15 in cars, 0.125 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slip_ratio: Option<f64>,
    /// Side slip of the vehicle beyond which it brakes the outer rear wheel as well, rad; 10° if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rear_sideslip_rad: Option<f64>,
    /// Braking force of the outer rear wheel over that of the outer front wheel, 0 to 1; 0.5 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rear_share: Option<f64>,
    /// Time from coming on to the first force of the brakes, s; 0.1 to 0.2 s in cars, 0.15 s if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dead_time_s: Option<f64>,
    /// Time in which the force of a brake rises from nothing to its full value, or falls, s; 0.2 s if not
    /// given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rise_s: Option<f64>,
    /// Side slip beyond which it gives up, rad: 30° to 60°, 45° if not given. A system with 90° never does,
    /// as it does not act on a vehicle that rolls backwards.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gives_up_sideslip_rad: Option<f64>,
}

/// A stability control as it acts; see [`StabilityControl`] for the fields.
#[derive(Debug, Clone, Copy)]
pub struct ActingStabilityControl {
    pub filter_s: f64,
    pub threshold_rad_s: f64,
    pub off_share: f64,
    pub least_speed_m_s: f64,
    pub acceleration_share: f64,
    pub full_error_rad_s: f64,
    pub slip_ratio: f64,
    pub rear_sideslip_rad: f64,
    pub rear_share: f64,
    pub dead_time_s: f64,
    pub rise_s: f64,
    pub gives_up_sideslip_rad: f64,
}

/// Share of the systems that never give up, where nothing is known.
const NEVER_SHARE: f64 = 1.0 / 3.0;

impl StabilityControl {
    /// Number of standard normal variables that [`StabilityControl::drawn`] takes.
    pub const N_DRAWN: usize = 7;

    /// The same with what is not stated drawn. Uniform are the threshold (4 to 8 deg/s), the error of full
    /// braking (0.15 to 0.35 rad/s), the slip (0.1 to 0.15), the rear share (0.25 to 0.75), the dead time
    /// (0.1 to 0.2 s), the rise (0.15 to 0.25 s) and the side slip at which it gives up (30° to 60°; a
    /// third of the systems never do).
    pub fn drawn(&self, z: [f64; Self::N_DRAWN]) -> Self {
        let [threshold, full_error, slip, rear, dead_time, rise, gives_up] = z;
        // The upper third of the last variable is that of systems which never give up.
        let gives_up_deg = uniform(gives_up, [30.0, 30.0 + 30.0 / (1.0 - NEVER_SHARE)]);
        let gives_up_deg = if gives_up_deg > 60.0 { 90.0 } else { gives_up_deg };
        let gives_up_rad = gives_up_deg.to_radians();
        let threshold_rad_s = uniform(threshold, [4.0, 8.0]).to_radians();
        Self {
            threshold_rad_s: self.threshold_rad_s.or(Some(threshold_rad_s)),
            full_error_rad_s: self.full_error_rad_s.or(Some(uniform(full_error, [0.15, 0.35]))),
            slip_ratio: self.slip_ratio.or(Some(uniform(slip, [0.1, 0.15]))),
            rear_share: self.rear_share.or(Some(uniform(rear, [0.25, 0.75]))),
            dead_time_s: self.dead_time_s.or(Some(uniform(dead_time, [0.1, 0.2]))),
            rise_s: self.rise_s.or(Some(uniform(rise, [0.15, 0.25]))),
            gives_up_sideslip_rad: self.gives_up_sideslip_rad.or(Some(gives_up_rad)),
            ..*self
        }
    }

    /// What [`StabilityControl::drawn`] draws, in words.
    pub(super) fn distributions(&self) -> Vec<Phrase> {
        drawn_words([
            (self.threshold_rad_s.is_some(), ["threshold 4 to 8 deg/s", "Schwelle 4 bis 8 °/s"]),
            (
                self.full_error_rad_s.is_some(),
                [
                    "full braking from 0.15 to 0.35 rad/s of error",
                    "volle Bremsung ab 0,15 bis 0,35 rad/s Abweichung",
                ],
            ),
            (self.slip_ratio.is_some(), ["slip 0.1 to 0.15", "Schlupf 0,1 bis 0,15"]),
            (
                self.rear_share.is_some(),
                ["rear share 0.25 to 0.75", "hinterer Anteil 0,25 bis 0,75"],
            ),
            (self.dead_time_s.is_some(), ["dead time 0.1 to 0.2 s", "Totzeit 0,1 bis 0,2 s"]),
            (self.rise_s.is_some(), ["rise 0.15 to 0.25 s", "Anstieg 0,15 bis 0,25 s"]),
            (
                self.gives_up_sideslip_rad.is_some(),
                [
                    "gives up at 30 to 60 deg of side slip or, in a third, never",
                    "gibt bei 30° bis 60° Schwimmwinkel auf, in einem Drittel nie",
                ],
            ),
        ])
    }

    /// The system with usual values where nothing is stated.
    pub fn acting(&self) -> ActingStabilityControl {
        ActingStabilityControl {
            filter_s: self.filter_s.unwrap_or(0.05),
            threshold_rad_s: self.threshold_rad_s.unwrap_or(6_f64.to_radians()),
            off_share: self.off_share.unwrap_or(1.0 / 3.0),
            least_speed_m_s: self.least_speed_m_s.unwrap_or(20.0 * KILOMETRE_PER_HOUR_M_S),
            acceleration_share: self.acceleration_share.unwrap_or(0.85),
            full_error_rad_s: self.full_error_rad_s.unwrap_or(0.25),
            slip_ratio: self.slip_ratio.unwrap_or(0.125),
            rear_sideslip_rad: self.rear_sideslip_rad.unwrap_or(10_f64.to_radians()),
            rear_share: self.rear_share.unwrap_or(0.5),
            dead_time_s: self.dead_time_s.unwrap_or(0.15),
            rise_s: self.rise_s.unwrap_or(0.2),
            gives_up_sideslip_rad: self.gives_up_sideslip_rad.unwrap_or(45_f64.to_radians()),
        }
    }

    /// Every number with its name without the unit, and its range.
    pub(in crate::vehicle) fn numbers(&mut self) -> [Number<'_>; 12] {
        [
            ("filter", &mut self.filter_s, ESC_FILTER),
            ("threshold", &mut self.threshold_rad_s, ESC_THRESHOLD),
            ("off_share", &mut self.off_share, ESC_OFF_SHARE),
            ("least_speed", &mut self.least_speed_m_s, ESC_SPEED),
            ("acceleration_share", &mut self.acceleration_share, ESC_ACCELERATION_SHARE),
            ("full_error", &mut self.full_error_rad_s, ESC_FULL_ERROR),
            ("slip_ratio", &mut self.slip_ratio, SLIP_RATIO),
            ("rear_sideslip", &mut self.rear_sideslip_rad, SIDESLIP),
            ("rear_share", &mut self.rear_share, REAR_BRAKE_SHARE),
            ("dead_time", &mut self.dead_time_s, DEAD_TIME),
            ("rise", &mut self.rise_s, BRAKE_RISE),
            ("gives_up_sideslip", &mut self.gives_up_sideslip_rad, SIDESLIP),
        ]
    }

    /// Every stated number with its name and its range.
    pub fn ranges(&self) -> Vec<(String, f64, Range)> {
        let mut copy = *self;
        named(copy.numbers())
    }
}

impl ActingStabilityControl {
    /// Yaw rate that the driver asks for, rad/s.
    ///
    /// - `speed_m_s`: U, more than 0; `steer_rad`: δ.
    pub fn reference_yaw_rate_rad_s(
        &self,
        vehicle: &VehicleParameters,
        speed_m_s: f64,
        steer_rad: f64,
    ) -> f64 {
        let tires = &vehicle.tires;
        let understeer_rad_g = 1.0 / tires.cornering_coefficient_front_per_rad
            - 1.0 / tires.cornering_coefficient_rear_per_rad;
        // A maker lays a car out such that it does not oversteer.
        let understeer_s2_m = understeer_rad_g.max(0.0) / STANDARD_GRAVITY_M_S2;
        let wheelbase_m = vehicle.geometry.wheelbase_m();
        let asked = speed_m_s * steer_rad / (wheelbase_m + understeer_s2_m * speed_m_s * speed_m_s);
        let held_m_s2 = self.acceleration_share * tires.friction * STANDARD_GRAVITY_M_S2;
        let largest = held_m_s2 / speed_m_s;
        asked.clamp(-largest, largest)
    }

    /// Largest braking force of a wheel that is held at the slip ratio of the system, N.
    ///
    /// - `held_n`: what the road holds along the plane of the wheel, κ μ(α) F_z;
    /// - `stiffness_1_rad`: C of the wheel; `slip_angle_rad`: α.
    pub(super) fn slip_held_n(
        &self,
        held_n: f64,
        stiffness_1_rad: f64,
        slip_angle_rad: f64,
    ) -> f64 {
        let slip = self.slip_ratio.hypot(slip_angle_rad.tan());
        held_n * (stiffness_1_rad * slip).atan().sin() * self.slip_ratio / slip
    }
}

/// What a stability control remembers from sample to sample.
#[derive(Debug, Clone, Default)]
pub(super) struct StabilityState {
    /// Smoothed error of the yaw rate, rad/s.
    error_rad_s: f64,
    /// Direction of the turn that it acts against, 1 to the left, and the time since when, s.
    active: Option<(f64, f64)>,
    /// Braking forces of the wheels over F_full.
    shares: [f64; 4],
}

impl StabilityState {
    /// Takes a sample and returns the braking forces that are asked for, N, without the limit of slip.
    ///
    /// - `steer_rad`: steer angle of the road wheels.
    pub fn sample(
        &mut self,
        control: &ActingStabilityControl,
        vehicle: &VehicleParameters,
        time_s: f64,
        x: &VehicleState<f64>,
        steer_rad: f64,
    ) -> [f64; 4] {
        let oversteer = |error: f64, direction: f64| match direction * x.yaw_rate_rad_s > 0.0 {
            true => direction * error,
            false => 0.0,
        };
        let sideslip_rad = x.vy_body_m_s.atan2(x.vx_body_m_s).abs();
        let may_act = x.vx_body_m_s > 0.0
            && x.vx_body_m_s.hypot(x.vy_body_m_s) >= control.least_speed_m_s
            && sideslip_rad <= control.gives_up_sideslip_rad;
        if may_act {
            let speed_m_s = x.vx_body_m_s;
            let asked = control.reference_yaw_rate_rad_s(vehicle, speed_m_s, steer_rad);
            let share = match control.filter_s > 0.0 {
                true => -(-OUTPUT_INTERVAL_S / control.filter_s).exp_m1(),
                false => 1.0,
            };
            self.error_rad_s += share * (x.yaw_rate_rad_s - asked - self.error_rad_s);
            let off_rad_s = control.threshold_rad_s * control.off_share;
            let error = self.error_rad_s;
            self.active = self.active.filter(|(turn, _)| oversteer(error, *turn) > off_rad_s);
            let turn = x.yaw_rate_rad_s.signum();
            if oversteer(error, turn) > control.threshold_rad_s {
                self.active.get_or_insert((turn, time_s));
            }
        } else {
            (self.error_rad_s, self.active) = (0.0, None);
        }
        let targets = match self.active {
            Some((turn, since_s)) if time_s >= since_s + control.dead_time_s - 1e-9 => {
                let front = (oversteer(self.error_rad_s, turn) / control.full_error_rad_s).min(1.0);
                let is_sideways = sideslip_rad > control.rear_sideslip_rad;
                let rear = if is_sideways { front * control.rear_share } else { 0.0 };
                // In a turn to the left the right wheels are the outer ones.
                if turn > 0.0 { [0.0, front, 0.0, rear] } else { [front, 0.0, rear, 0.0] }
            }
            _ => [0.0; 4],
        };
        let largest_change = OUTPUT_INTERVAL_S / control.rise_s;
        let full_n = vehicle.tires.friction * vehicle.mass.mass_kg * STANDARD_GRAVITY_M_S2 / 2.0;
        for wheel in Wheel::ALL.map(Wheel::index) {
            let change = targets[wheel] - self.shares[wheel];
            self.shares[wheel] += change.clamp(-largest_change, largest_change);
        }
        self.shares.map(|share| share * full_n)
    }
}

/// Where a car was sold when it was new.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Market {
    /// The United States of America.
    UnitedStates,
    /// The European Union.
    EuropeanUnion,
}

/// Whether every new car of a year has a stability control by law; earlier ones may have one.
///
/// In the United States all light vehicles that were built from 1 September 2011 on have it, which are
/// those of the model year 2012 (Federal Motor Vehicle Safety Standard 126, 49 CFR 571.126, section S8).
/// In the European Union new types have it since 1 November 2011 and all new cars since 1 November 2014
/// (Regulation (EC) No 661/2009, article 13), so that 2015 is the first whole year.
///
/// - `year`: model year in the United States, year of the first registration in the European Union.
pub fn esc_is_standard(year: u32, market: Market) -> bool {
    match market {
        Market::UnitedStates => year >= 2012,
        Market::EuropeanUnion => year >= 2015,
    }
}
