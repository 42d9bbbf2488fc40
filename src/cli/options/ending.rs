//! Options that say what happens to the wheels after the first contact.

use std::str::FromStr;

use clap::{ArgGroup, Args};

use crate::cli::CliError;
use crate::cli::options::choices::{AXLES, Values, one_value_of, typed_word};
use crate::cli::options::quantity::{QuantityError, number};
use impactlab_core::ranges::{
    BRAKE_RISE, BRAKE_SHARE, CONTROL_TIME, DRAG_SHARE, DRIVE_TORQUE, ENGINE_BRAKING, REACTION_TIME,
    STEER_ANGLE, STEERING_RATIO, STEERING_WHEEL_ANGLE,
};
use impactlab_core::vehicle::{
    AntiLock, Braking, Countersteer, DEFAULT_BRAKE_RISE_S, DamagedWheel, DrivenAxle, Driving,
    Ending, EngineBraking, HeldSteer, StabilityControl, Wheel,
};

/// What the driver does and what the damage does to the wheels.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Driver and damage")]
#[command(group(ArgGroup::new("engine").multiple(true).args(["engine_braking", "drive_torque"])))]
#[command(group(ArgGroup::new("turned").args(["steer_angle", "steering_wheel"])))]
pub(in crate::cli) struct EndingArgs {
    /// The vehicle coasts, also where the scenario says something else
    #[arg(long, conflicts_with_all = ["brake", "engine_braking", "drive_torque", "locked",
        "dragged", "steer_angle", "steering_wheel", "esc", "countersteer", "brake_start", "brake_rise", "abs",
        "drive_start", "driven", "steer_start", "steer_rise"])]
    coast: bool,
    /// The driver brakes with this share of what the road can hold (more than 1 locks the wheels,
    /// unless there is --abs or --esc)
    #[arg(long, value_name = "SHARE", value_parser = number(BRAKE_SHARE))]
    brake: Option<f64>,
    /// When the braking begins, s
    #[arg(long, value_name = "TIME", value_parser = number(CONTROL_TIME), default_value = "0",
        requires = "brake")]
    brake_start: f64,
    /// How long the braking force rises, s
    #[arg(long, value_name = "TIME", value_parser = number(BRAKE_RISE),
        default_value_t = DEFAULT_BRAKE_RISE_S, requires = "brake")]
    brake_rise: f64,
    /// The brakes have an anti-lock system
    #[arg(long, requires = "brake")]
    abs: bool,
    /// The vehicle has a stability control, and with it an anti-lock system; standard in cars from the
    /// model year 2012 on in the United States, and from 2015 on in the European Union
    #[arg(long)]
    esc: bool,
    /// The driver countersteers, after this reaction time if it is known
    #[arg(long, value_name = "TIME", value_parser = number(REACTION_TIME), num_args = 0..=1)]
    countersteer: Option<Option<f64>>,
    /// The engine brakes with this deceleration: 0.5, 0.05g
    #[arg(long, value_name = "DECELERATION", value_parser = number(ENGINE_BRAKING))]
    engine_braking: Option<f64>,
    /// The driver accelerates with this torque at the wheels of each driven axle together, N m
    #[arg(long, value_name = "TORQUE", value_parser = number(DRIVE_TORQUE))]
    drive_torque: Option<f64>,
    /// When the driver accelerates, s
    #[arg(long, value_name = "TIME", value_parser = number(CONTROL_TIME), default_value = "0",
        requires = "drive_torque")]
    drive_start: f64,
    /// The driven axle
    #[arg(long, value_parser = one_value_of(AXLES), default_value = "front", requires = "engine")]
    driven: DrivenAxle,
    /// A wheel that cannot turn from the first contact on; may be given several times
    #[arg(long, value_parser = one_value_of(WHEELS), value_name = "WHEEL")]
    locked: Vec<Wheel>,
    /// A wheel that bent bodywork drags with this share of what the road can hold, such as
    /// rear-left=0.5; may be given several times
    #[arg(long, value_name = "WHEEL=SHARE")]
    dragged: Vec<DraggedArg>,
    /// The front road wheels turn to this angle, positive to the left: 3deg
    #[arg(long, value_name = "ANGLE", value_parser = number(STEER_ANGLE),
        allow_hyphen_values = true, conflicts_with = "steering_ratio")]
    steer_angle: Option<f64>,
    /// The steering wheel turns to this angle, positive to the left: 90deg
    #[arg(long, value_name = "ANGLE", value_parser = number(STEERING_WHEEL_ANGLE),
        allow_hyphen_values = true, requires = "steering_ratio")]
    steering_wheel: Option<f64>,
    /// Angle of the steering wheel over that of the road wheels; 12 to 20 in cars
    #[arg(long, value_name = "RATIO", value_parser = number(STEERING_RATIO),
        allow_hyphen_values = true, requires = "steering")]
    pub(in crate::cli) steering_ratio: Option<f64>,
    /// When the steering begins, s
    #[arg(long, value_name = "TIME", value_parser = number(CONTROL_TIME), default_value = "0",
        requires = "turned")]
    steer_start: f64,
    /// How long the wheels turn, s
    #[arg(long, value_name = "TIME", value_parser = number(BRAKE_RISE),
        default_value_t = DEFAULT_BRAKE_RISE_S, requires = "turned")]
    steer_rise: f64,
}

const WHEELS: Values<Wheel> = &[
    (Wheel::FrontLeft, ""),
    (Wheel::FrontRight, ""),
    (Wheel::RearLeft, ""),
    (Wheel::RearRight, ""),
];

/// A wheel and its drag.
#[derive(Debug, Clone, Copy, PartialEq)]
struct DraggedArg {
    wheel: Wheel,
    share: f64,
}

/// An argument that is not a wheel with its drag.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
enum DraggedError {
    #[error(
        "expected a wheel and a share, such as rear-left=0.5; wheels: front-left, front-right, \
             rear-left, rear-right"
    )]
    Form,
    #[error(transparent)]
    Share(#[from] QuantityError),
}

impl FromStr for DraggedArg {
    type Err = DraggedError;

    fn from_str(text: &str) -> Result<Self, DraggedError> {
        let (wheel, share) = text.split_once('=').ok_or(DraggedError::Form)?;
        let is_it = |of: &Wheel| typed_word(of).eq_ignore_ascii_case(wheel.trim());
        let wheel = Wheel::ALL.into_iter().find(is_it).ok_or(DraggedError::Form)?;
        Ok(Self { wheel, share: number(DRAG_SHARE)(share)? })
    }
}

impl EndingArgs {
    /// The ending that the options say; `None` if they say none.
    ///
    /// # Errors
    /// [`CliError::SteeringWheel`] for a steering-wheel angle that no road wheel follows,
    /// [`CliError::WheelTwice`].
    pub(in crate::cli) fn ending(&self) -> Result<Option<Ending>, CliError> {
        let of_wheel = self.steering_wheel.zip(self.steering_ratio);
        let road_wheel_rad = match of_wheel {
            Some((angle_rad, ratio)) => Some(STEER_ANGLE.check(angle_rad / ratio)?),
            None => self.steer_angle,
        };
        let locked = self.locked.iter().map(|&wheel| (wheel, None));
        let dragged = self.dragged.iter().map(|dragged| (dragged.wheel, Some(dragged.share)));
        let damaged =
            |(wheel, share)| DamagedWheel { wheel, start_s: 0.0, drag_share_of_friction: share };
        let damage: Vec<DamagedWheel> = locked.chain(dragged).map(damaged).collect();
        let is_twice =
            |idx: usize, wheel: Wheel| damage.iter().take(idx).any(|it| it.wheel == wheel);
        if let Some((_, twice)) =
            damage.iter().enumerate().find(|(idx, it)| is_twice(*idx, it.wheel))
        {
            return Err(CliError::WheelTwice { name: typed_word(&twice.wheel) });
        }
        let ending = Ending {
            brake: self.brake.map(|share_of_friction| {
                let abs = self.abs.then(AntiLock::default);
                Braking {
                    abs,
                    ..Braking::new(self.brake_start, share_of_friction, self.brake_rise)
                }
            }),
            engine: self
                .engine_braking
                .map(|deceleration_m_s2| EngineBraking { deceleration_m_s2, axle: self.driven }),
            drive: self.drive_torque.map(|torque_n_m| Driving {
                torque_n_m,
                axle: self.driven,
                start_s: self.drive_start,
                rise_s: DEFAULT_BRAKE_RISE_S,
            }),
            damage,
            steer: road_wheel_rad.map(|road_wheel_rad| HeldSteer {
                start_s: self.steer_start,
                rise_s: self.steer_rise,
                road_wheel_rad,
            }),
            esc: self.esc.then(StabilityControl::default),
            countersteer: self.countersteer.map(|delay_s| Countersteer {
                delay_s,
                steering_ratio: self.steering_ratio,
                ..Countersteer::default()
            }),
            pit: None,
        };
        Ok((self.coast || !ending.is_coasting()).then_some(ending))
    }
}
