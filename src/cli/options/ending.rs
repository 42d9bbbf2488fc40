//! Options that say what happens to the wheels after the first contact.

use std::str::FromStr;

use clap::{Args, ValueEnum};

use crate::cli::options::quantity::{QuantityError, number};
use crate::ranges::{BRAKE_RISE, BRAKE_SHARE, CONTROL_TIME, DRAG_SHARE, ENGINE_BRAKING};
use crate::vehicle::{
    Braking, DEFAULT_BRAKE_RISE_S, DamagedWheel, DrivenAxle, Ending, EngineBraking, Wheel,
};

/// What the driver does and what the damage does to the wheels.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "After the first contact")]
pub(in crate::cli) struct EndingArgs {
    /// The vehicle coasts, also where the scenario says something else
    #[arg(long, conflicts_with_all = ["brake", "engine_braking", "locked", "dragged"])]
    coast: bool,
    /// The driver brakes with this share of what the road can hold (without an anti-lock system:
    /// more than 1 locks the wheels)
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
    /// The engine brakes with this deceleration: 0.5, 0.05g
    #[arg(long, value_name = "DECELERATION", value_parser = number(ENGINE_BRAKING))]
    engine_braking: Option<f64>,
    /// The driven axle
    #[arg(long, value_enum, default_value_t, requires = "engine_braking")]
    driven: AxleArg,
    /// A wheel that cannot turn from the first contact on; may be given several times
    #[arg(long, value_enum, value_name = "WHEEL")]
    locked: Vec<WheelArg>,
    /// A wheel that bent bodywork drags with this share of what the road can hold, such as
    /// rear-left=0.5; may be given several times
    #[arg(long, value_name = "WHEEL=SHARE")]
    dragged: Vec<DraggedArg>,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum AxleArg {
    #[default]
    Front,
    Rear,
    All,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum WheelArg {
    FrontLeft,
    FrontRight,
    RearLeft,
    RearRight,
}

/// A wheel and its drag.
#[derive(Debug, Clone, Copy, PartialEq)]
struct DraggedArg {
    wheel: WheelArg,
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
        let wheel = WheelArg::from_str(wheel.trim(), true).or(Err(DraggedError::Form))?;
        Ok(Self { wheel, share: number(DRAG_SHARE)(share)? })
    }
}

impl From<WheelArg> for Wheel {
    fn from(wheel: WheelArg) -> Self {
        match wheel {
            WheelArg::FrontLeft => Self::FrontLeft,
            WheelArg::FrontRight => Self::FrontRight,
            WheelArg::RearLeft => Self::RearLeft,
            WheelArg::RearRight => Self::RearRight,
        }
    }
}

impl From<AxleArg> for DrivenAxle {
    fn from(axle: AxleArg) -> Self {
        match axle {
            AxleArg::Front => Self::Front,
            AxleArg::Rear => Self::Rear,
            AxleArg::All => Self::All,
        }
    }
}

impl EndingArgs {
    /// The ending that the options say; `None` if they say none.
    pub(in crate::cli) fn ending(&self) -> Option<Ending> {
        let locked = self.locked.iter().map(|&wheel| (wheel, None));
        let dragged = self.dragged.iter().map(|dragged| (dragged.wheel, Some(dragged.share)));
        let damaged = |(wheel, share): (WheelArg, Option<f64>)| DamagedWheel {
            wheel: wheel.into(),
            start_s: 0.0,
            drag_share_of_friction: share,
        };
        let ending = Ending {
            brake: self.brake.map(|share_of_friction| Braking {
                start_s: self.brake_start,
                share_of_friction,
                rise_s: self.brake_rise,
            }),
            engine: self.engine_braking.map(|deceleration_m_s2| EngineBraking {
                deceleration_m_s2,
                axle: self.driven.into(),
            }),
            damage: locked.chain(dragged).map(damaged).collect(),
            steer: None,
        };
        (self.coast || !ending.is_coasting()).then_some(ending)
    }
}
