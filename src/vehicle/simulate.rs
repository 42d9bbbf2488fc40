//! Integrates the equations of motion of the 4DOF vehicle over time.
//!
//! The reference method is the classical Runge–Kutta method with a step of 1 ms. The explicit Euler
//! method of the paper with a step of 10 ms is available as its baseline. The collision force in a
//! step is the mean of its history over that step, so that the whole impulse acts on the vehicle
//! for any step. The steer angle is taken at the instants of the stages of the method.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::data::{Channel, CumulativeImpulse, ForceAxes, ForceHistory, SeriesError, TimeSeries};
use crate::numerics::{Stage, euler_step, rk4_step};
use crate::ranges::{OutOfRange, SIMULATED_DURATION};
use crate::vehicle::controls::Controls;
use crate::vehicle::energy::{EnergyWatch, MAX_ENERGY_GAIN};
use crate::vehicle::rest::RestWatch;
use crate::vehicle::{
    CollisionForce, ContactPoint, Equations, VehicleInput, VehicleMismatch, VehicleParameters,
    VehicleState, Wheel, WheelEffort,
};

/// Roll angle beyond which the roll model is not valid, rad. It is 15°, about three times the angle
/// that the reference car reaches at its handling limit.
pub const ROLL_LIMIT_RAD: f64 = 0.26;

/// Interval between the samples of a simulated motion, s, as in the trajectory data sets.
pub const OUTPUT_INTERVAL_S: f64 = 0.01;

/// Method by which the equations of motion are integrated.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Integrator {
    /// Classical Runge–Kutta method of order 4 with a step of 1 ms.
    #[default]
    Rk4,
    /// Explicit Euler method with a step of 10 ms, the baseline of the paper (`eq:baseline:4dof`).
    Euler,
}

impl Integrator {
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
    /// Duration of the motion, s, in the range [`SIMULATED_DURATION`].
    pub duration_s: f64,
    /// Whether the motion ends before its duration where the vehicle has come to rest: after the end
    /// of the force and the last change of the controls, see [`Motion::rest_s`].
    pub ends_at_rest: bool,
}

impl Manoeuvre {
    /// Inputs of the equations of motion for `n_steps` steps of `step_s` seconds from t = 0: the
    /// mean of the collision force over each step, and the steer angle at the start of the step.
    pub fn inputs(&self, step_s: f64, n_steps: usize) -> Vec<VehicleInput<f64>> {
        let inputs = Inputs::new(self);
        let over = |i: usize| inputs.over(i as f64 * step_s, step_s).at(Stage::Start);
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

impl fmt::Display for MotionFlag {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WheelLift { wheel, time_s } => {
                write!(f, "wheel lift: {} carries no load at {time_s:.2} s", wheel.label())
            }
            Self::RollLimit { time_s, roll_rad } => write!(
                f,
                "roll of {:.1} deg at {time_s:.2} s is beyond the model; a rollover is not excluded",
                roll_rad.to_degrees()
            ),
            Self::EnergyGain { time_s } => write!(
                f,
                "energy: at {time_s:.2} s the vehicle has gained more than {:.0} % of its energy \
                 although nothing pushes it",
                100.0 * MAX_ENERGY_GAIN
            ),
        }
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
    /// The samples do not form a valid time series.
    #[error(transparent)]
    Series(#[from] SeriesError),
}

impl VehicleParameters {
    /// Simulates a manoeuvre from t = 0 for its duration, rounded to a multiple of
    /// [`OUTPUT_INTERVAL_S`]. The result is deterministic.
    ///
    /// The steps of [`Integrator::Rk4`] are divided where the vehicle has faster modes than they
    /// follow; ordinary vehicles have none.
    ///
    /// # Errors
    /// [`SimulationError::Duration`] if the duration is out of range, [`SimulationError::Vehicle`]
    /// if two parameters do not go together, [`SimulationError::Diverged`] if the state becomes
    /// infinite or NaN, [`SimulationError::EnergyGain`] if the energy grows without a force,
    /// [`SimulationError::Series`] if the samples do not form a valid time series.
    pub fn simulate(
        &self,
        manoeuvre: &Manoeuvre,
        integrator: Integrator,
    ) -> Result<Motion, SimulationError> {
        let duration_s = SIMULATED_DURATION.check(manoeuvre.duration_s)?;
        self.check_relations()?;
        let inputs = Inputs::new(manoeuvre);
        let (step_s, steps_per_output) = self.steps(integrator, &manoeuvre.controls);
        let mut rest = RestWatch::after(inputs.last_change_s());
        let n_outputs = (duration_s / OUTPUT_INTERVAL_S).round() as usize + 1;
        let mut recorder = Recorder::new(self, n_outputs);
        let mut energy = EnergyWatch::default();
        let is_baseline = integrator == Integrator::Euler || self.equations == Equations::Paper;
        let mut state = manoeuvre.initial.to_array();
        for output in 0..n_outputs {
            let time_s = output as f64 * OUTPUT_INTERVAL_S;
            if !state.iter().all(|value| value.is_finite()) {
                return Err(SimulationError::Diverged { time_s });
            }
            let (now, coming) = (
                VehicleState::from_array(state),
                inputs.over(time_s, OUTPUT_INTERVAL_S).at(Stage::Start),
            );
            recorder.record(time_s, &now, &coming);
            let share = energy.gain(self, &now, coming.collision.is_some() || coming.is_driven());
            let is_kept = share <= MAX_ENERGY_GAIN; // not where it is NaN
            if !is_kept {
                if !is_baseline {
                    return Err(SimulationError::EnergyGain { time_s, share });
                }
                recorder.energy.get_or_insert(MotionFlag::EnergyGain { time_s });
            }
            if rest.has_settled(time_s, &now) && manoeuvre.ends_at_rest {
                break;
            }
            for step in 0..steps_per_output {
                let start_s = time_s + step as f64 * step_s;
                state = self.step(&state, &inputs.over(start_s, step_s), integrator);
            }
        }
        recorder.finish(&rest)
    }

    /// Length of the steps of an integrator for this vehicle, s, and how many make an output
    /// interval.
    fn steps(&self, integrator: Integrator, controls: &Controls) -> (f64, usize) {
        let step_s = integrator.step_s();
        let n_substeps = match integrator {
            Integrator::Rk4 if controls.wheels.is_some() => self.braked_substeps(step_s),
            Integrator::Rk4 => self.substeps(step_s),
            Integrator::Euler => 1,
        };
        let per_output = (OUTPUT_INTERVAL_S / step_s).round() as usize;
        (step_s / n_substeps as f64, per_output * n_substeps)
    }

    fn step(&self, state: &[f64; 8], inputs: &StepInputs, integrator: Integrator) -> [f64; 8] {
        let f = |stage, x: &[f64; 8]| {
            self.evaluate(&VehicleState::from_array(*x), &inputs.at(stage)).derivative.to_array()
        };
        match integrator {
            Integrator::Rk4 => rk4_step(f, state, inputs.step_s),
            Integrator::Euler => euler_step(f, state, inputs.step_s),
        }
    }
}

/// Inputs of a manoeuvre, prepared for evaluation over time steps.
struct Inputs<'a> {
    controls: &'a Controls,
    contact: Option<(CumulativeImpulse, &'a ContactLoad)>,
}

/// Inputs over one time step.
struct StepInputs {
    step_s: f64,
    /// Steer angle at the start, the middle and the end of the step, rad.
    steer_rad: [f64; 3],
    /// The wheels at these instants.
    wheels: [Option<[WheelEffort<f64>; 4]>; 3],
    collision: Option<CollisionForce<f64>>,
}

impl<'a> Inputs<'a> {
    fn new(manoeuvre: &'a Manoeuvre) -> Self {
        let contact = manoeuvre.contact_load.as_ref();
        Self {
            controls: &manoeuvre.controls,
            contact: contact.map(|load| (load.force.cumulative(), load)),
        }
    }

    fn over(&self, start_s: f64, step_s: f64) -> StepInputs {
        let Controls { steer, wheels } = self.controls;
        let instants_s = [start_s, start_s + step_s / 2.0, start_s + step_s];
        StepInputs {
            step_s,
            steer_rad: instants_s.map(|t| steer.as_ref().map_or(0.0, |steer| steer.at(t))),
            wheels: instants_s.map(|t| wheels.as_ref().and_then(|wheels| wheels.at(t))),
            collision: self.collision_over(start_s, step_s),
        }
    }

    /// The last instant at which force, steer angle or wheels change, s; 0 if nothing acts.
    fn last_change_s(&self) -> f64 {
        let Controls { steer, wheels } = self.controls;
        let contact = self.contact.as_ref().map(|(cumulative, _)| cumulative.end_s());
        let steer = steer.as_ref().and_then(|steer| steer.time_s.last().copied());
        let wheels = wheels.as_ref().and_then(|wheels| wheels.time_s.last().copied());
        [contact, steer, wheels].into_iter().flatten().fold(0.0, f64::max)
    }

    /// Mean collision force over a step. It is `None` if neither force nor moment acts, also if the
    /// history continues with zeros, so that rules for a vehicle without a collision force apply.
    fn collision_over(&self, start_s: f64, step_s: f64) -> Option<CollisionForce<f64>> {
        let (cumulative, load) = self.contact.as_ref()?;
        if start_s >= cumulative.end_s() {
            return None;
        }
        let (force_n, moment) = cumulative.mean_over(start_s, start_s + step_s);
        let yaw_moment_n_m = moment.filter(|_| load.recorded_moment);
        let acts = force_n != [0.0; 2] || yaw_moment_n_m.is_some_and(|moment| moment != 0.0);
        acts.then_some(CollisionForce {
            force_n,
            in_world_axes: load.force.axes == ForceAxes::World,
            yaw_moment_n_m,
            contact: load.contact,
        })
    }
}

impl StepInputs {
    fn at(&self, stage: Stage) -> VehicleInput<f64> {
        let instant = match stage {
            Stage::Start => 0,
            Stage::Middle => 1,
            Stage::End => 2,
        };
        VehicleInput {
            steer_rad: self.steer_rad[instant],
            wheels: self.wheels[instant],
            collision: self.collision,
        }
    }
}

/// Collects the samples and the flags of a simulation.
struct Recorder<'a> {
    vehicle: &'a VehicleParameters,
    time_s: Vec<f64>,
    columns: Vec<(Channel, Vec<f64>)>,
    lift: Option<MotionFlag>,
    roll: Option<MotionFlag>,
    energy: Option<MotionFlag>,
}

/// Channels of a simulated motion, in the order in which [`Recorder::record`] lists their values.
const RECORDED: [Channel; 20] = {
    use Channel as C;
    [
        C::X,
        C::Y,
        C::Yaw,
        C::Roll,
        C::Vx,
        C::Vy,
        C::YawRate,
        C::RollRate,
        C::Ax,
        C::Ay,
        C::FxBody,
        C::FyBody,
        C::Mz,
        C::Mx,
        C::SteerFl,
        C::SteerFr,
        C::FzFl,
        C::FzFr,
        C::FzRl,
        C::FzRr,
    ]
};

impl<'a> Recorder<'a> {
    fn new(vehicle: &'a VehicleParameters, n_samples: usize) -> Self {
        let column = |channel| (channel, Vec::with_capacity(n_samples));
        let columns = RECORDED.map(column).into();
        Self {
            vehicle,
            time_s: Vec::with_capacity(n_samples),
            columns,
            lift: None,
            roll: None,
            energy: None,
        }
    }

    fn record(&mut self, time_s: f64, x: &VehicleState<f64>, u: &VehicleInput<f64>) {
        let now = self.vehicle.evaluate(x, u);
        let contact_arm_m =
            u.collision.map_or(0.0, |c| c.contact.height_m - self.vehicle.geometry.cg_height_m);
        let [ax, ay] = now.acceleration_m_s2;
        let [fx, fy] = now.collision_force_n;
        let [fl, fr, rl, rr] = now.vertical_loads_n;
        let mx = -contact_arm_m * fy;
        let sample = [
            x.x_m,
            x.y_m,
            x.yaw_rad,
            x.roll_rad,
            x.vx_m_s,
            x.vy_m_s,
            x.yaw_rate_rad_s,
            x.roll_rate_rad_s,
            ax,
            ay,
            fx,
            fy,
            now.collision_yaw_moment_n_m,
            mx,
            u.steer_rad,
            u.steer_rad,
            fl,
            fr,
            rl,
            rr,
        ];
        self.time_s.push(time_s);
        for ((_, column), value) in self.columns.iter_mut().zip(sample) {
            column.push(value);
        }
        let lifted =
            Wheel::ALL.into_iter().zip(now.vertical_loads_n).find(|(_, load)| *load <= 0.0);
        if let Some((wheel, _)) = lifted {
            self.lift.get_or_insert(MotionFlag::WheelLift { wheel, time_s });
        }
        if x.roll_rad.abs() > ROLL_LIMIT_RAD {
            self.roll.get_or_insert(MotionFlag::RollLimit { time_s, roll_rad: x.roll_rad });
        }
    }

    fn finish(self, rest: &RestWatch) -> Result<Motion, SimulationError> {
        let rest_s = self.time_s.last().and_then(|&end_s| rest.since_s(end_s));
        let mut series = TimeSeries::new(self.time_s)?;
        for (channel, column) in self.columns {
            series.insert(channel, column)?;
        }
        Ok(Motion {
            series,
            flags: self.lift.into_iter().chain(self.roll).chain(self.energy).collect(),
            rest_s,
        })
    }
}
