//! Integrates the equations of motion of the 4DOF vehicle over time.
//!
//! The reference method is the classical Runge–Kutta method with a step of 1 ms. The explicit Euler
//! method of the paper with a step of 10 ms is available as its baseline. The collision force in a
//! step is the mean of its history over that step, so that the whole impulse acts on the vehicle
//! for any step. The steer angle is taken at the instants of the stages of the method.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::{ForceHistory, SeriesError, TimeSeries};
use crate::ranges::OutOfRange;
use crate::units::{NumberFormat, Phrase, PhraseValue, Quantity};
use crate::vehicle::controls::Controls;
use crate::vehicle::energy::MAX_ENERGY_GAIN;
use crate::vehicle::run::{Inputs, Run};
use crate::vehicle::{
    ContactPoint, FrictionZone, FrictionZoneError, VehicleInput, VehicleMismatch,
    VehicleParameters, VehicleState, Wheel,
};

/// Roll angle beyond which the roll model is not valid, rad. It is 15°, about three times the angle
/// that the reference car reaches at its handling limit.
pub const ROLL_LIMIT_RAD: f64 = 0.26;

/// Interval between the samples of a simulated motion, s, as in the trajectory data sets.
pub const OUTPUT_INTERVAL_S: f64 = 0.01;

/// Method by which the equations of motion are integrated.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Integrator {
    /// Classical Runge–Kutta method of order 4 with a step of 1 ms.
    #[default]
    #[serde(alias = "rk4")]
    Rk4,
    /// Explicit Euler method with a step of 10 ms, the baseline of the paper (`eq:baseline:4dof`).
    #[serde(alias = "euler")]
    Euler,
}

impl Integrator {
    /// Both methods.
    pub const ALL: [Self; 2] = [Self::Rk4, Self::Euler];

    /// What it is called.
    pub fn label(self) -> &'static str {
        match self {
            Self::Rk4 => "Runge–Kutta, 4th order",
            Self::Euler => "Euler",
        }
    }

    /// Time step of the method, s.
    pub fn step_s(self) -> f64 {
        match self {
            Self::Rk4 => 1e-3,
            Self::Euler => 1e-2,
        }
    }
}

/// A collision force history and its contact point.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactLoad {
    /// History of the force on the vehicle.
    pub force: ForceHistory,
    /// Contact point of the force.
    pub contact: ContactPoint,
    /// Whether the yaw moment that the history contains is used. If this is false, or if the
    /// history contains no moment, the moment follows from the force and the contact point.
    pub recorded_moment: bool,
}

/// The motion to be simulated: initial state, collision force, what acts on the wheels, and when it
/// ends. By default the vehicle stands, nothing acts, and the duration is still to be given.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Manoeuvre {
    /// State at t = 0.
    pub initial: VehicleState<f64>,
    /// Collision force; `None` if there is no impact.
    pub contact_load: Option<ContactLoad>,
    /// What steers, drives, brakes and locks the wheels.
    pub controls: Controls,
    /// Duration of the motion, s, in the range
    /// [`SIMULATED_DURATION`](crate::ranges::SIMULATED_DURATION).
    pub duration_s: f64,
    /// Whether the motion ends before its duration where the vehicle has come to rest: after the end
    /// of the force and the last change of the controls, see [`Motion::rest_s`].
    pub ends_at_rest: bool,
    /// Parts of the ground with their own friction; elsewhere it is that of the vehicle's tires. Each
    /// wheel has the friction of the ground below its centre at the start of a step of the
    /// integration, over the step. The controls do not know of them: a braking force that is a share
    /// of μ m g has the μ of the vehicle.
    pub friction_zones: Vec<FrictionZone>,
}

impl Manoeuvre {
    /// Inputs of the equations of motion for `n_steps` steps of `step_s` seconds from t = 0: the
    /// mean of the collision force over each step, and the steer angle at the start of the step.
    /// They contain neither the friction zones nor drivers and systems, which depend on the motion; see
    /// [`VehicleParameters::applied_controls`].
    pub fn inputs(&self, step_s: f64, n_steps: usize) -> Vec<VehicleInput<f64>> {
        let inputs = Inputs::new(self);
        let over = |i: usize| inputs.over(i as f64 * step_s, step_s).instants[0];
        (0..n_steps).map(over).collect()
    }
}

/// An event of a simulated motion that the model does not cover, or of which the user should know.
/// Events are detected at the output instants only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionFlag {
    /// A wheel lifts off the road: its vertical load is not positive.
    WheelLift {
        /// The first wheel that lifts.
        wheel: Wheel,
        /// First output instant at which the wheel is lifted, s.
        time_s: f64,
    },
    /// The roll angle exceeds [`ROLL_LIMIT_RAD`] in magnitude. A rollover, which is not modelled,
    /// cannot be excluded.
    RollLimit {
        /// First output instant at which the limit is exceeded, s.
        time_s: f64,
        /// Roll angle at this instant, rad.
        roll_rad: f64,
    },
    /// The energy of the vehicle has grown by more than [`MAX_ENERGY_GAIN`] without a force. Only
    /// the baselines are let go on with it: the equations of motion as printed in the paper, and
    /// Euler's method.
    EnergyGain {
        /// First output instant at which it has, s.
        time_s: f64,
    },
}

impl MotionFlag {
    /// The same on a clock that shows another time.
    ///
    /// - `shift_s`: what it shows at the start of the motion.
    #[must_use]
    pub fn later_by(mut self, shift_s: f64) -> Self {
        match &mut self {
            Self::WheelLift { time_s, .. }
            | Self::RollLimit { time_s, .. }
            | Self::EnergyGain { time_s } => *time_s += shift_s,
        }
        self
    }

    /// What it says of the motion.
    pub fn phrase(&self) -> Phrase {
        let at = |time_s: f64| PhraseValue::fixed(Quantity::Time, time_s, 2);
        match *self {
            Self::WheelLift { wheel, time_s } => Phrase::new(
                "the {0} wheel carries no load at {1}",
                "Das Rad {0} ist bei {1} ohne Last",
            )
            .with(PhraseValue::Term(wheel.label().to_owned()))
            .with(at(time_s)),
            Self::RollLimit { time_s, roll_rad } => Phrase::new(
                "roll of {0} at {1} is beyond the model; a rollover is not excluded",
                "Ein Wankwinkel von {0} bei {1} liegt außerhalb des Modells; ein Überschlag ist nicht \
                 auszuschließen",
            )
            .with(PhraseValue::fixed(Quantity::Angle, roll_rad, 1).in_unit("deg"))
            .with(at(time_s)),
            Self::EnergyGain { time_s } => Phrase::new(
                "at {0} the vehicle has gained more than {1} of its energy although nothing \
                 pushes it",
                "Bei {0} hat das Fahrzeug mehr als {1} seiner Energie hinzugewonnen, obwohl keine Kraft \
                 es antreibt",
            )
            .with(at(time_s))
            .with(PhraseValue::fixed(Quantity::Ratio, MAX_ENERGY_GAIN, 0).in_unit("%")),
        }
    }
}

impl fmt::Display for MotionFlag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.phrase().say(&NumberFormat::default()))
    }
}

/// A simulated motion of the vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Samples every [`OUTPUT_INTERVAL_S`] with the channels of the trajectory data sets: pose,
    /// velocities, rates, accelerations, collision force as the mean over the following interval,
    /// steer angles and vertical loads of the wheels.
    pub series: TimeSeries,
    /// The first wheel lift, the first excess of the roll limit and the first gain of energy, in
    /// this order, if they occur.
    pub flags: Vec<MotionFlag>,
    /// The instant since which the vehicle is at rest to the end of the motion, s: after the end of
    /// the force and the last change of the controls, its speed is below [`REST_SPEED_M_S`] and its
    /// yaw rate below [`REST_YAW_RATE_RAD_S`]. `None` if it still moves at the end.
    ///
    /// [`REST_SPEED_M_S`]: crate::vehicle::REST_SPEED_M_S
    /// [`REST_YAW_RATE_RAD_S`]: crate::vehicle::REST_YAW_RATE_RAD_S
    pub rest_s: Option<f64>,
    /// Steer angle and wheels as drivers and systems made them, as histories over the output instants;
    /// `None` where the controls of the manoeuvre have no [`ClosedLoop`](crate::vehicle::ClosedLoop).
    pub applied_controls: Option<Controls>,
}

/// Reason why a simulation gives no motion.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// The duration is out of range.
    #[error(transparent)]
    Duration(#[from] OutOfRange),
    /// A component of the state is no longer finite.
    #[error("the motion is no longer finite at {time_s:.2} s; check force, speed and step")]
    Diverged {
        /// First output instant at which the state is not finite, s.
        time_s: f64,
    },
    /// The vehicle gains energy without a force, so that its motion is wrong.
    #[error(
        "at {time_s:.2} s the vehicle has gained {:.1} % of its energy although nothing pushes it: \
         its parameters are outside what the model can follow", 100.0 * share
    )]
    EnergyGain {
        /// First output instant at which the gain exceeds [`MAX_ENERGY_GAIN`], s.
        time_s: f64,
        /// The gain as a share of the energy at the end of the force, or at the start.
        share: f64,
    },
    /// Two parameters of the vehicle do not go together.
    #[error(transparent)]
    Vehicle(#[from] VehicleMismatch),
    /// A friction zone has a friction out of range or no proper border.
    #[error(transparent)]
    FrictionZone(#[from] FrictionZoneError),
    /// The samples do not form a valid time series.
    #[error(transparent)]
    Series(#[from] SeriesError),
}

impl VehicleParameters {
    /// The controls of a manoeuvre as histories: what its drivers and systems do in the motion of this
    /// vehicle. Controls without any are as they are.
    ///
    /// # Errors
    /// Those of [`VehicleParameters::simulate`].
    pub fn applied_controls(&self, manoeuvre: &Manoeuvre) -> Result<Controls, SimulationError> {
        if manoeuvre.controls.closed_loop.is_none() {
            return Ok(manoeuvre.controls.clone());
        }
        let motion = self.simulate(manoeuvre, Integrator::Rk4)?;
        Ok(motion.applied_controls.unwrap_or_default())
    }

    /// Simulates a manoeuvre from t = 0 for its duration, rounded to a multiple of
    /// [`OUTPUT_INTERVAL_S`]. The result is deterministic.
    ///
    /// The steps of [`Integrator::Rk4`] are divided where the vehicle has faster modes than they
    /// follow; ordinary vehicles have none. Several motions are simulated faster side by side, see
    /// [`simulate_batch`](crate::vehicle::simulate_batch).
    ///
    /// # Errors
    /// [`SimulationError::Duration`] if the duration is out of range, [`SimulationError::Vehicle`]
    /// if two parameters do not go together, [`SimulationError::FrictionZone`] if a zone is refused,
    /// [`SimulationError::Diverged`] if the state becomes
    /// infinite or NaN, [`SimulationError::EnergyGain`] if the energy grows without a force,
    /// [`SimulationError::Series`] if the samples do not form a valid time series.
    pub fn simulate(
        &self,
        manoeuvre: &Manoeuvre,
        integrator: Integrator,
    ) -> Result<Motion, SimulationError> {
        let mut run = Run::new(self, manoeuvre, integrator)?;
        while run.goes_on()? {
            run.advance(integrator);
        }
        run.finish()
    }
}
