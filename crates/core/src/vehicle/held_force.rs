//! A motion under a collision force that follows from the motion itself, such as that of two vehicles
//! which push each other. The force is held over steps of any length.

use crate::numerics::rk4_step;
use crate::vehicle::run::{Run, StepInputs};
use crate::vehicle::{
    CollisionForce, Integrator, Manoeuvre, Motion, N_STATE, SimulationError, VehicleParameters,
    VehicleState, WheelEffort,
};

/// A motion under a collision force that is held over steps. It stands at an output instant; the states
/// within an output interval belong to the caller.
pub(crate) struct HeldForceRun<'a> {
    run: Run<'a>,
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
        Ok(Self { run: Run::new(vehicle, manoeuvre, Integrator::Rk4)? })
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

    /// State at the end of a step, which is divided where the vehicle has faster modes than it follows.
    pub fn stepped(
        &self,
        collision: Option<CollisionForce<f64>>,
        start_s: f64,
        step_s: f64,
        state: &[f64; N_STATE],
    ) -> [f64; N_STATE] {
        let n_parts = (step_s / self.run.step_s - 1e-9).ceil().max(1.0);
        let part_s = step_s / n_parts;
        let mut x = *state;
        for part in 0..n_parts as usize {
            let inputs = self.inputs(collision, start_s + part as f64 * part_s, part_s, &x);
            let f = |stage, x: &[f64; N_STATE]| self.run.constants.derivative(x, inputs.at(stage));
            x = rk4_step(f, &x, part_s);
        }
        x
    }

    /// Whether the motion ends at this output instant, since its duration is over.
    pub fn is_last(&self) -> bool {
        self.run.is_last()
    }

    /// Records the output instant, and says whether the vehicle still moves.
    ///
    /// - `mean`: mean collision force over the coming interval; `None` without a force;
    /// - `was_pushed`: whether a force acted over the interval before.
    ///
    /// # Errors
    /// [`SimulationError::Diverged`] or [`SimulationError::EnergyGain`].
    pub fn record(
        &mut self,
        mean: Option<CollisionForce<f64>>,
        was_pushed: bool,
    ) -> Result<bool, SimulationError> {
        let mut coming = self.run.coming();
        coming.collision = mean;
        let now = VehicleState::from_array(self.run.state);
        let forces = self.run.constants.evaluate(&now, &coming).into();
        let is_pushed = was_pushed || mean.is_some() || coming.is_driven();
        self.run.record_pushed(&coming, &forces, is_pushed)
    }

    /// Goes on to the next output instant.
    pub fn advanced_to(&mut self, state: [f64; N_STATE]) {
        self.run.advanced_to(state);
    }

    /// The recorded motion.
    ///
    /// # Errors
    /// [`SimulationError::Series`] if the samples do not form a valid time series.
    pub fn finish(self) -> Result<Motion, SimulationError> {
        self.run.finish()
    }
}
