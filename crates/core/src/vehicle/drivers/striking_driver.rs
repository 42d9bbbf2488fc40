//! A driver who turns the own car into the rear quarter of another one (precision immobilization
//! technique, PIT).
//!
//! The driver runs beside the other car at its speed, turns the steering wheel by a quarter to half a turn
//! within 0.2 to 0.5 s, and holds the throttle such that the speed is kept:
//!
//! ```text
//! F_drive = m min((v₀ − v_x)/T, a_max), 0 or more        v₀: speed at the start, T = 0.5 s
//! ```
//!
//! When the struck car has turned by a stated angle since the first contact, or after a stated time, the
//! driver straightens the wheels and coasts, or straightens them and brakes, or keeps pushing.
//! Source of the technique: policies and training documents of police agencies, which describe matched
//! speeds and a turn of the steering wheel by a quarter to half a turn; the values are ours.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ranges::{
    BRAKE_RISE, BRAKE_SHARE, CONTROL_TIME, PIT_START, Range, STEER_ANGLE, STEERING_RATIO,
    STEERING_WHEEL_ANGLE, STRUCK_TURN, THROTTLE_LIMIT,
};
use crate::units::Phrase;
use crate::vehicle::drivers::numbers::{Number, drawn_words, named, uniform};
use crate::vehicle::drivers::struck_driver::turned_towards;
use crate::vehicle::{
    Braking, DEFAULT_BRAKE_RISE_S, DrivenAxle, USUAL_STEERING_RATIO, VehicleParameters,
    VehicleState, Wheel,
};

/// T: time constant by which the driver keeps the speed, s.
const THROTTLE_TIME_S: f64 = 0.5;

/// What the driver does once the struck car has turned.
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
pub enum PitEnd {
    /// Turns the wheels straight and lets the car coast.
    Straighten,
    /// Turns the wheels straight and brakes.
    #[default]
    Brake,
    /// Holds steering wheel and throttle to the end.
    KeepPushing,
}

impl PitEnd {
    /// All of them.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// Its word in a file and in a list.
    pub fn word(self) -> &'static str {
        self.into()
    }
}

/// The side to which a driver turns.
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
pub enum TurnSide {
    /// To the left.
    #[default]
    Left,
    /// To the right.
    Right,
}

impl TurnSide {
    /// Both of them.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// Its word in a file and in a list.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// 1 to the left, −1 to the right.
    pub fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }
}

/// The driver of the striking car in a PIT: what is stated of him.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PitDriver {
    /// When the steering wheel begins to turn, s after the first contact; less than 0 before it, 0 if not
    /// given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_s: Option<f64>,
    /// The side to which the driver turns, where the angle of the steering wheel does not say it; if not given,
    /// that on which the other car is at the first contact of a scenario, and else the left.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<TurnSide>,
    /// Angle of the steering wheel, rad, positive to the left: 90° to 180° to either side, 135° to `side`
    /// if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steering_wheel_rad: Option<f64>,
    /// Time in which it turns, s: 0.2 to 0.5 s, 0.35 s if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turn_s: Option<f64>,
    /// Angle of the steering wheel over that of the road wheels; 16 if not given. Road wheels turn by at
    /// most 0.9 rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steering_ratio: Option<f64>,
    /// The axle that is driven.
    pub axle: DrivenAxle,
    /// Largest acceleration of the car alone by its engine, m/s²; 3 m/s² if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_acceleration_m_s2: Option<f64>,
    /// What the driver does in the end; he brakes if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end: Option<PitEnd>,
    /// Turn of the struck car since the first contact at which the driver ends the pushing, rad, to
    /// either side; 45° if not given. It counts only where both cars are followed together.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub struck_turn_rad: Option<f64>,
    /// Time after the first contact at which the driver ends the pushing in any case, s; none if `None`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub longest_s: Option<f64>,
    /// Braking force over the largest that the road can hold, of a driver who brakes in the end; 0.8 if not
    /// given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub brake_share: Option<f64>,
}

/// The driver of a PIT as he acts; see [`PitDriver`] for the fields.
#[derive(Debug, Clone, Copy)]
pub struct ActingPitDriver {
    pub start_s: f64,
    pub steering_wheel_rad: f64,
    pub turn_s: f64,
    pub steering_ratio: f64,
    pub axle: DrivenAxle,
    pub largest_acceleration_m_s2: f64,
    pub end: PitEnd,
    pub struck_turn_rad: f64,
    pub longest_s: Option<f64>,
    pub brake_share: f64,
}

impl PitDriver {
    /// Number of standard normal variables that [`PitDriver::drawn`] takes.
    pub const N_DRAWN: usize = 5;

    /// The same with what is not stated drawn, but for the moment from which he steers. Uniform are the
    /// angle of the steering wheel (90° to 180°), the time of the turn (0.2 to 0.5 s), the largest
    /// acceleration (2 to 4 m/s²) and the turn of the struck car (30° to 90°); each end has the same
    /// probability.
    pub fn drawn(&self, z: [f64; Self::N_DRAWN]) -> Self {
        let [angle, turn, acceleration, struck_turn, end] = z;
        let angle_rad = (self.sign() * uniform(angle, [90.0, 180.0])).to_radians();
        let acceleration_m_s2 = uniform(acceleration, [2.0, 4.0]);
        let struck_turn_rad = uniform(struck_turn, [30.0, 90.0]).to_radians();
        let n_ends = PitEnd::ALL.len();
        let end_idx = uniform(end, [0.0, n_ends as f64]) as usize;
        Self {
            steering_wheel_rad: self.steering_wheel_rad.or(Some(angle_rad)),
            turn_s: self.turn_s.or(Some(uniform(turn, [0.2, 0.5]))),
            largest_acceleration_m_s2: self.largest_acceleration_m_s2.or(Some(acceleration_m_s2)),
            struck_turn_rad: self.struck_turn_rad.or(Some(struck_turn_rad)),
            end: self.end.or(Some(PitEnd::ALL[end_idx.min(n_ends - 1)])),
            ..*self
        }
    }

    fn sign(&self) -> f64 {
        self.side.unwrap_or_default().sign()
    }

    /// What [`PitDriver::drawn`] draws, in words.
    pub(super) fn distributions(&self) -> Vec<Phrase> {
        drawn_words([
            (
                self.steering_wheel_rad.is_some(),
                ["90 to 180 deg of the steering wheel", "90° bis 180° am Lenkrad"],
            ),
            (
                self.turn_s.is_some(),
                ["turned within 0.2 to 0.5 s", "eingelenkt innerhalb von 0,2 bis 0,5 s"],
            ),
            (
                self.largest_acceleration_m_s2.is_some(),
                ["up to 2 to 4 m/s²", "Beschleunigung bis 2 bis 4 m/s²"],
            ),
            (
                self.struck_turn_rad.is_some(),
                [
                    "until the struck car has turned by 30 to 90 deg",
                    "bis sich das gestoßene Fahrzeug um 30° bis 90° gedreht hat",
                ],
            ),
            (self.end.is_some(), ["each end equally likely", "jedes Ende gleich wahrscheinlich"]),
        ])
    }

    /// The driver with usual values where nothing is stated.
    pub fn acting(&self) -> ActingPitDriver {
        let usual_rad = (self.sign() * 135.0).to_radians();
        ActingPitDriver {
            start_s: self.start_s.unwrap_or(0.0),
            steering_wheel_rad: self.steering_wheel_rad.unwrap_or(usual_rad),
            turn_s: self.turn_s.unwrap_or(0.35),
            steering_ratio: self.steering_ratio.unwrap_or(USUAL_STEERING_RATIO),
            axle: self.axle,
            largest_acceleration_m_s2: self.largest_acceleration_m_s2.unwrap_or(3.0),
            end: self.end.unwrap_or_default(),
            struck_turn_rad: self.struck_turn_rad.unwrap_or(45_f64.to_radians()),
            longest_s: self.longest_s,
            brake_share: self.brake_share.unwrap_or(0.8),
        }
    }

    /// Every number with its name without the unit, and its range.
    pub(in crate::vehicle) fn numbers(&mut self) -> [Number<'_>; 7] {
        [
            ("start", &mut self.start_s, PIT_START),
            ("steering_wheel", &mut self.steering_wheel_rad, STEERING_WHEEL_ANGLE),
            ("turn", &mut self.turn_s, BRAKE_RISE),
            ("steering_ratio", &mut self.steering_ratio, STEERING_RATIO),
            ("largest_acceleration", &mut self.largest_acceleration_m_s2, THROTTLE_LIMIT),
            ("struck_turn", &mut self.struck_turn_rad, STRUCK_TURN),
            ("brake_share", &mut self.brake_share, BRAKE_SHARE),
        ]
    }

    /// Every stated number with its name and its range.
    pub fn ranges(&self) -> Vec<(String, f64, Range)> {
        let mut copy = *self;
        let longest = self.longest_s.map(|it| ("longest_s".to_owned(), it, CONTROL_TIME));
        named(copy.numbers()).into_iter().chain(longest).collect()
    }
}

impl ActingPitDriver {
    /// Full steer angle of the road wheels, rad.
    pub fn road_wheel_rad(&self) -> f64 {
        (self.steering_wheel_rad / self.steering_ratio).clamp(STEER_ANGLE.low, STEER_ANGLE.high)
    }
}

/// What the driver remembers from sample to sample.
#[derive(Debug, Clone, Default)]
pub(super) struct PitState {
    /// Speed that is kept, m/s.
    speed_m_s: Option<f64>,
    /// Since when the driver has ended the pushing, s.
    ended_s: Option<f64>,
    /// Whether the wheels are straight again.
    is_straight: bool,
}

/// What the driver asks for.
pub(super) struct PitDemand {
    /// Steer angle of the road wheels, rad; `None` once they are straight after the pushing, so that
    /// something else may steer.
    pub steer_rad: Option<f64>,
    /// Drive forces of the wheels, N.
    pub drive_n: [f64; 4],
    /// Braking by the pedal.
    pub brake: Option<Braking>,
}

impl PitState {
    /// Takes a sample.
    ///
    /// - `steer_rad`: steer angle of the road wheels until now;
    /// - `struck_turn_rad`: how far the struck car has turned since the first contact; `None` where it is
    ///   not followed, or not touched yet.
    pub fn sample(
        &mut self,
        driver: &ActingPitDriver,
        vehicle: &VehicleParameters,
        time_s: f64,
        x: &VehicleState<f64>,
        steer_rad: f64,
        struck_turn_rad: Option<f64>,
    ) -> PitDemand {
        let speed_m_s = *self.speed_m_s.get_or_insert(x.vx_body_m_s);
        let has_turned = struck_turn_rad.is_some_and(|turn| turn.abs() >= driver.struck_turn_rad);
        let is_over = driver.longest_s.is_some_and(|longest_s| time_s >= longest_s - 1e-9);
        if driver.end != PitEnd::KeepPushing && (has_turned || is_over) {
            self.ended_s.get_or_insert(time_s);
        }
        let full_rad = driver.road_wheel_rad();
        let Some(ended_s) = self.ended_s else {
            let turned = ((time_s - driver.start_s) / driver.turn_s).clamp(0.0, 1.0);
            let wanted_m_s2 = (speed_m_s - x.vx_body_m_s) / THROTTLE_TIME_S;
            let drive_m_s2 = wanted_m_s2.clamp(0.0, driver.largest_acceleration_m_s2);
            return PitDemand {
                steer_rad: Some(full_rad * turned),
                drive_n: driver.axle.shared_n(vehicle.mass.mass_kg * drive_m_s2),
                brake: None,
            };
        };
        self.is_straight |= steer_rad == 0.0 && time_s > ended_s;
        let rate_rad_s = full_rad.abs() / driver.turn_s;
        let is_braking = driver.end == PitEnd::Brake;
        PitDemand {
            steer_rad: (!self.is_straight).then(|| turned_towards(steer_rad, 0.0, rate_rad_s)),
            drive_n: [0.0; Wheel::ALL.len()],
            brake: is_braking
                .then(|| Braking::new(ended_s, driver.brake_share, DEFAULT_BRAKE_RISE_S)),
        }
    }
}
