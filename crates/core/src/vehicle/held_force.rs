//! A motion under a collision force that follows from the motion itself, such as that of two vehicles
//! which push each other. The force is held over steps of any length.

use crate::numerics::{Stage, rk4_step};
use crate::vehicle::frames::Heading;
use crate::vehicle::path_batch::{CONTACT_STEP_S as ZONE_STEP_S, RATE_TIMES_STEP, YAW_ARM_M};
use crate::vehicle::residual_bound::ResidualBound;
use crate::vehicle::run::{Run, StepInputs};
use crate::vehicle::tire::SLIP_ANGLE_SPEED_M_S;
use crate::vehicle::{
    CollisionForce, Integrator, Manoeuvre, Motion, N_ACCELERATION, N_STATE, RestWatch,
    SimulationError, VehicleEvaluation, VehicleInput, VehicleParameters, VehicleState, WheelEffort,
};

/// Largest turn of a vehicle over a step, rad: the momentum of a body that moves freely, whose velocity is
/// in axes that turn with it, then changes by less than 1e-9 of itself.
const LARGEST_TURN_RAD: f64 = 0.02;

/// Share of the longest step of the Runge–Kutta method that one with a single evaluation may have, which is
/// stable up to λ h = 1: it then follows a rate λ h = 0.5.
const PUSHED_SHARE: f64 = 0.35;

/// A motion under a collision force that is held over steps. It stands at an output instant; the states
/// within an output interval belong to the caller.
pub(crate) struct HeldForceRun<'a> {
    run: Run<'a>,
    /// Input over the coming output interval, without a collision force.
    coming: VehicleInput<f64>,
    /// What the equations of motion say under it at the output instant.
    now: VehicleEvaluation<f64>,
    /// K/(λ₀ ε) of [`Self::longest_step_s`], s²/m.
    step_per_speed_s2_m: f64,
    roll_step_s: f64,
    /// Time derivative in the middle of the step before, if a collision force acted.
    before: Option<[f64; N_STATE]>,
    bound: ResidualBound,
}

/// Input over the coming output interval without a collision force, and the equations of motion under it.
fn untouched(run: &Run<'_>) -> (VehicleInput<f64>, VehicleEvaluation<f64>) {
    let coming = VehicleInput { collision: None, ..run.coming() };
    (coming, run.constants.evaluate(&VehicleState::from_array(run.state), &coming))
}

impl<'a> HeldForceRun<'a> {
    /// A vehicle and its manoeuvre, whose own collision force is not used.
    ///
    /// # Errors
    /// [`SimulationError::Duration`], [`SimulationError::Vehicle`] or
    /// [`SimulationError::FrictionZone`].
    pub fn new(
        vehicle: &'a VehicleParameters,
        manoeuvre: &'a Manoeuvre,
    ) -> Result<Self, SimulationError> {
        let run = Run::new(vehicle, manoeuvre, Integrator::Rk4)?;
        let (coming, now) = untouched(&run);
        Ok(Self {
            run,
            coming,
            now,
            step_per_speed_s2_m: RATE_TIMES_STEP
                / (vehicle.tire_rate_at_rest_1_s() * SLIP_ANGLE_SPEED_M_S),
            roll_step_s: vehicle.roll_step_s(),
            before: None,
            bound: ResidualBound::default(),
        })
    }

    /// State at the output instant, in the order of `eq:state_vector`.
    pub fn state(&self) -> &[f64; N_STATE] {
        &self.run.state
    }

    /// Inputs over a step. Wheels that roll freely are braked by nothing, so that every vehicle takes
    /// the same way through the equations, by itself and side by side with others.
    ///
    /// - `state`: at the start of the step.
    fn inputs(
        &self,
        collision: Option<CollisionForce<f64>>,
        start_s: f64,
        step_s: f64,
        state: &[f64; N_STATE],
    ) -> StepInputs<f64> {
        let mut inputs = self.run.inputs_under(collision, start_s, step_s, state);
        for instant in &mut inputs.instants {
            instant.wheels.get_or_insert([WheelEffort::FREE; 4]);
        }
        inputs
    }

    /// Input over the coming output interval, without a collision force.
    pub fn coming(&self) -> VehicleInput<f64> {
        self.coming
    }

    /// Whether a vehicle that has come to rest stays where it is while nothing pushes it.
    ///
    /// - `state`: of the vehicle, in the order of `eq:state_vector`.
    pub fn stays(&self, state: &[f64; N_STATE]) -> bool {
        !self.coming.is_driven() && RestWatch::is_slow(&VehicleState::from_array(*state))
    }

    /// Longest step that follows the tires at the speed of a state and the roll, s, as along
    /// [`simulate_paths`](crate::vehicle::simulate_paths); at least the reference step of the vehicle.
    fn longest_step_s(&self, state: &[f64; N_STATE]) -> f64 {
        let x = VehicleState::from_array(*state);
        let speed_m_s = x.vx_body_m_s.hypot(x.vy_body_m_s) + YAW_ARM_M * x.yaw_rate_rad_s.abs();
        let by_tires_s = self.step_per_speed_s2_m * (speed_m_s + SLIP_ANGLE_SPEED_M_S);
        let by_turn_s = LARGEST_TURN_RAD / x.yaw_rate_rad_s.abs().max(f64::MIN_POSITIVE);
        let longest_s = by_tires_s.min(by_turn_s).min(self.roll_step_s).max(self.run.step_s);
        if self.run.has_zones_near(&x) { longest_s.min(ZONE_STEP_S) } else { longest_s }
    }

    /// State at the end of a step, which is divided where the vehicle has faster modes than it follows.
    ///
    /// Without a collision force each part is one of the classical Runge–Kutta method. Under one, whose
    /// steps are short for the sake of the contact, each takes one evaluation:
    ///
    /// ```text
    /// x_m = x + h/2 ẋ_b        ẋ_b: in the middle of the step before
    /// v' = v + h a(x_m)        X' = X + h (v + v')/2        in world axes
    /// ```
    ///
    /// so that a force changes the momentum by its impulse, to rounding.
    ///
    /// - `residual`: acceleration that the equations of motion leave out: v̇_x, v̇_y, m/s², ṙ, φ̈, rad/s².
    pub fn stepped(
        &mut self,
        collision: Option<CollisionForce<f64>>,
        [start_s, step_s]: [f64; 2],
        state: &[f64; N_STATE],
        residual: [f64; N_ACCELERATION],
    ) -> [f64; N_STATE] {
        let longest_s = match collision {
            Some(_) => (PUSHED_SHARE * self.longest_step_s(state)).max(self.run.step_s),
            None => self.longest_step_s(state),
        };
        let n_parts = (step_s / longest_s - 1e-9).ceil().max(1.0);
        let part_s = step_s / n_parts;
        let mut x = *state;
        for part in 0..n_parts as usize {
            let inputs = self.inputs(collision, start_s + part as f64 * part_s, part_s, &x);
            x = match collision {
                Some(_) => self.pushed(&inputs, &x, part_s, residual),
                None => self.free(&inputs, &x, part_s, residual),
            };
        }
        x
    }

    fn derivative(
        &self,
        x: &[f64; N_STATE],
        u: &VehicleInput<f64>,
        residual: [f64; N_ACCELERATION],
    ) -> [f64; N_STATE] {
        let by_model = self.run.constants.derivative(x, u);
        VehicleState::from_array(by_model).accelerated(residual).to_array()
    }

    fn free(
        &mut self,
        inputs: &StepInputs<f64>,
        x: &[f64; N_STATE],
        step_s: f64,
        residual: [f64; N_ACCELERATION],
    ) -> [f64; N_STATE] {
        self.before = None;
        rk4_step(|stage, x| self.derivative(x, inputs.at(stage), residual), x, step_s)
    }

    fn pushed(
        &mut self,
        inputs: &StepInputs<f64>,
        start: &[f64; N_STATE],
        step_s: f64,
        residual: [f64; N_ACCELERATION],
    ) -> [f64; N_STATE] {
        let u = inputs.at(Stage::Middle);
        let before = self.before.unwrap_or_else(|| self.derivative(start, u, residual));
        let half: [f64; N_STATE] = std::array::from_fn(|i| start[i] + step_s / 2.0 * before[i]);
        let rates = self.derivative(&half, u, residual);
        self.before = Some(rates);
        let [x, half, rates] = [*start, half, rates].map(VehicleState::from_array);
        let acceleration = Heading::new(half.yaw_rad).world_from_body([
            rates.vx_body_m_s - half.vy_body_m_s * half.yaw_rate_rad_s,
            rates.vy_body_m_s + half.vx_body_m_s * half.yaw_rate_rad_s,
        ]);
        let old = Heading::new(x.yaw_rad).world_from_body([x.vx_body_m_s, x.vy_body_m_s]);
        let new = [0, 1].map(|axis| old[axis] + step_s * acceleration[axis]);
        let mean = |old: f64, new: f64| step_s * (old + new) / 2.0;
        let yaw_rate_rad_s = x.yaw_rate_rad_s + step_s * rates.yaw_rate_rad_s;
        let roll_rate_rad_s = x.roll_rate_rad_s + step_s * rates.roll_rate_rad_s;
        let yaw_rad = x.yaw_rad + mean(x.yaw_rate_rad_s, yaw_rate_rad_s);
        let [vx_body_m_s, vy_body_m_s] = Heading::new(yaw_rad).body_from_world(new);
        VehicleState {
            vx_body_m_s,
            vy_body_m_s,
            yaw_rad,
            yaw_rate_rad_s,
            roll_rad: x.roll_rad + mean(x.roll_rate_rad_s, roll_rate_rad_s),
            roll_rate_rad_s,
            x_m: x.x_m + mean(old[0], new[0]),
            y_m: x.y_m + mean(old[1], new[1]),
        }
        .to_array()
    }

    /// A residual acceleration over the coming output interval, scaled back where it would drive a vehicle
    /// that nothing drives.
    pub fn bounded_residual(&mut self, residual: [f64; N_ACCELERATION]) -> [f64; N_ACCELERATION] {
        if self.coming.is_driven() || residual == [0.0; N_ACCELERATION] {
            return residual;
        }
        let x = VehicleState::from_array(self.run.state);
        let constants = &self.run.constants;
        let given_w = constants.planar_power_w(&x, residual);
        let taken_w = -constants.planar_power_w(&x, constants.acceleration_by_tires(&x, &self.now));
        let share = self.bound.share(given_w, taken_w.max(0.0));
        residual.map(|acceleration| share * acceleration)
    }

    /// Acceleration of the CG by tires and resistance at the output instant, m/s².
    pub fn tire_acceleration_m_s2(&self) -> f64 {
        let x = VehicleState::from_array(self.run.state);
        let [along, across, ..] = self.run.constants.acceleration_by_tires(&x, &self.now);
        along.hypot(across)
    }

    /// The state at the end of an output interval without a collision force, with the planar energy of
    /// its beginning, and what the weight has given on a slope, where a residual acceleration has made it
    /// grow.
    pub fn without_energy_gain(&self, state: [f64; N_STATE]) -> [f64; N_STATE] {
        if self.coming.is_driven() {
            return state;
        }
        let [before, after] = [self.run.state, state].map(VehicleState::from_array);
        self.run.constants.without_energy_gain(&before, after).to_array()
    }

    /// Tells the driver how far the car that this one has struck has turned since the first contact, rad;
    /// `None` before it. It counts from the next output instant on.
    pub fn sees_struck_turn(&mut self, struck_turn_rad: Option<f64>) {
        self.run.sees_struck_turn(struck_turn_rad);
    }

    /// Whether the motion ends at this output instant, since its duration is over.
    pub fn is_last(&self) -> bool {
        self.run.is_last()
    }

    /// Records the output instant, and says whether the vehicle still moves.
    ///
    /// - `mean`: mean collision force over the coming interval; `None` without a force;
    /// - `was_pushed`: whether a force acted over the interval before, or a residual acceleration acts over
    ///   the coming one, which bounds the energy of the planar motion by itself.
    ///
    /// # Errors
    /// [`SimulationError::Diverged`] or [`SimulationError::EnergyGain`].
    pub fn record(
        &mut self,
        mean: Option<CollisionForce<f64>>,
        was_pushed: bool,
    ) -> Result<bool, SimulationError> {
        let coming = VehicleInput { collision: mean, ..self.coming };
        let forces = match mean {
            None => self.now,
            Some(_) => {
                self.run.constants.evaluate(&VehicleState::from_array(self.run.state), &coming)
            }
        };
        let is_pushed = was_pushed || mean.is_some() || coming.is_driven();
        self.run.record_pushed(&coming, &forces.into(), is_pushed)
    }

    /// Goes on to the next output instant.
    pub fn advanced_to(&mut self, state: [f64; N_STATE]) {
        self.run.advanced_to(state);
        (self.coming, self.now) = untouched(&self.run);
    }

    /// The recorded motion.
    ///
    /// # Errors
    /// [`SimulationError::Series`] if the samples do not form a valid time series.
    pub fn finish(self) -> Result<Motion, SimulationError> {
        self.run.finish()
    }
}
