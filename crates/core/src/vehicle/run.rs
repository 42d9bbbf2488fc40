//! A motion that is being simulated, by itself or side by side with others.

use crate::data::{CumulativeImpulse, ForceAxes};
use crate::numerics::{Stage, euler_step, rk4_step};
use crate::ranges::SIMULATED_DURATION;
use crate::vehicle::controls::{AppliedControls, Controls};
use crate::vehicle::drivers::{ClosedLoop, ClosedLoopRun};
use crate::vehicle::energy::{EnergyWatch, MAX_ENERGY_GAIN};
use crate::vehicle::ground::Ground;
use crate::vehicle::recorder::{Forces, Recorder};
use crate::vehicle::rest::RestWatch;
use crate::vehicle::{
    CollisionForce, ContactLoad, Equations, FrictionZone, Integrator, Manoeuvre, Motion,
    MotionFlag, N_STATE, OUTPUT_INTERVAL_S, SimulationError, VehicleConstants, VehicleInput,
    VehicleParameters, VehicleState,
};

/// A motion that is being simulated. It stands at an output instant.
pub(super) struct Run<'a> {
    vehicle: &'a VehicleParameters,
    pub constants: VehicleConstants<f64>,
    inputs: Inputs<'a>,
    /// What drivers and systems made of the controls; `None` without them.
    applied: Option<AppliedControls>,
    ground: Ground<'a>,
    ends_at_rest: bool,
    /// Whether the motion goes on where its energy grows.
    is_baseline: bool,
    pub step_s: f64,
    pub steps_per_output: usize,
    n_outputs: usize,
    /// Number of output instants before this one.
    output: usize,
    /// State at this instant, in the order of `eq:state_vector`.
    pub state: [f64; N_STATE],
    recorder: Recorder<'a>,
    energy: EnergyWatch,
    rest: RestWatch,
}

impl<'a> Run<'a> {
    /// # Errors
    /// [`SimulationError::Duration`] or [`SimulationError::Vehicle`].
    pub fn new(
        vehicle: &'a VehicleParameters,
        manoeuvre: &'a Manoeuvre,
        integrator: Integrator,
    ) -> Result<Self, SimulationError> {
        let duration_s = SIMULATED_DURATION.check(manoeuvre.duration_s)?;
        vehicle.check_relations()?;
        manoeuvre.friction_zones.iter().try_for_each(FrictionZone::check)?;
        let inputs = Inputs::with_closed_loop(manoeuvre, vehicle);
        let rest = RestWatch::after(inputs.last_change_s()).of(vehicle);
        let (step_s, steps_per_output) = steps(vehicle, integrator, manoeuvre);
        let n_outputs = (duration_s / OUTPUT_INTERVAL_S).round() as usize + 1;
        let applied = inputs.has_closed_loop().then(AppliedControls::default);
        let mut run = Self {
            vehicle,
            constants: vehicle.constants(),
            inputs,
            applied,
            ground: Ground::new(&manoeuvre.friction_zones, vehicle),
            ends_at_rest: manoeuvre.ends_at_rest,
            is_baseline: integrator == Integrator::Euler || vehicle.equations == Equations::Paper,
            step_s,
            steps_per_output,
            n_outputs,
            output: 0,
            state: manoeuvre.initial.to_array(),
            recorder: Recorder::new(vehicle, n_outputs),
            energy: EnergyWatch::default(),
            rest,
        };
        run.sample();
        Ok(run)
    }

    /// Lets drivers and systems see the motion at the instant at which it stands.
    fn sample(&mut self) {
        let time_s = self.time_s();
        self.inputs.sample(time_s, &self.state, &self.constants, &self.ground);
    }

    /// Tells the driver how far the car that was struck by this one has turned since the first contact,
    /// rad; it counts from the next output instant on.
    pub fn sees_struck_turn(&mut self, struck_turn_rad: Option<f64>) {
        self.inputs.sees_struck_turn(struck_turn_rad);
    }

    /// Whether drivers or systems act on the wheels.
    pub fn has_controlled_wheels(&self) -> bool {
        self.inputs.has_controlled_wheels()
    }

    /// Axes of the collision force, and whether its yaw moment is recorded.
    pub fn kind_of_force(&self) -> (bool, bool) {
        self.inputs.kind_of_force()
    }

    /// Input over the interval that begins.
    pub fn coming(&self) -> VehicleInput<f64> {
        let inputs = self.inputs.over(self.time_s(), OUTPUT_INTERVAL_S);
        inputs.on(&self.ground, &self.state).instants[0]
    }

    /// Whether the inputs of the interval that begins may be others than those of a vehicle that
    /// coasts on one ground.
    pub fn is_acted_on(&self) -> bool {
        self.ground.has_zones() || self.inputs.may_act_from(self.time_s())
    }

    /// Whether the ground has zones, so that inputs depend on where the vehicle is.
    pub fn has_zones(&self) -> bool {
        self.ground.has_zones()
    }

    /// Whether a zone of the ground is so near that a wheel may stand in it within the next step.
    pub fn has_zones_near(&self, x: &VehicleState<f64>) -> bool {
        self.ground.has_zones_near(x)
    }

    /// Inputs over a step of the interval that begins.
    ///
    /// - `state`: at the start of the step; it counts where the ground has zones.
    pub fn inputs_of(&self, step: usize, state: &[f64; N_STATE]) -> StepInputs<f64> {
        let start_s = self.time_s() + step as f64 * self.step_s;
        self.inputs.over(start_s, self.step_s).on(&self.ground, state)
    }

    /// Inputs over a step of any length under a collision force that is held over it, instead of that
    /// of the manoeuvre.
    pub fn inputs_under(
        &self,
        collision: Option<CollisionForce<f64>>,
        start_s: f64,
        step_s: f64,
        state: &[f64; N_STATE],
    ) -> StepInputs<f64> {
        let mut inputs = self.inputs.over(start_s, step_s).on(&self.ground, state);
        inputs.instants.iter_mut().for_each(|instant| instant.collision = collision);
        inputs
    }

    fn time_s(&self) -> f64 {
        self.output as f64 * OUTPUT_INTERVAL_S
    }

    /// Whether this is the last output instant of the duration.
    pub fn is_last(&self) -> bool {
        self.output + 1 >= self.n_outputs
    }

    /// Records this instant, and says whether the motion goes on.
    ///
    /// # Errors
    /// [`SimulationError::Diverged`] or [`SimulationError::EnergyGain`].
    pub fn goes_on(&mut self) -> Result<bool, SimulationError> {
        let coming = self.coming();
        let now = self.constants.evaluate(&VehicleState::from_array(self.state), &coming);
        self.record(&coming, &now.into())
    }

    /// [`Run::goes_on`] where the equations of motion were evaluated already.
    ///
    /// - `coming`: input over the interval that begins; `forces`: under it.
    pub fn record(
        &mut self,
        coming: &VehicleInput<f64>,
        forces: &Forces<f64>,
    ) -> Result<bool, SimulationError> {
        self.record_pushed(coming, forces, coming.collision.is_some() || coming.is_driven())
    }

    /// [`Run::record`] where it is known whether the energy may have grown since the last instant.
    pub fn record_pushed(
        &mut self,
        coming: &VehicleInput<f64>,
        forces: &Forces<f64>,
        is_pushed: bool,
    ) -> Result<bool, SimulationError> {
        let (time_s, now) = (self.time_s(), VehicleState::from_array(self.state));
        if !self.state.iter().all(|value| value.is_finite()) {
            return Err(SimulationError::Diverged { time_s });
        }
        self.recorder.record(time_s, &now, coming, forces);
        if let Some(applied) = &mut self.applied {
            applied.record(time_s, coming);
        }
        let share = self.energy.gain(self.vehicle, &now, is_pushed);
        let is_conserved = share <= MAX_ENERGY_GAIN; // not where it is NaN
        if !is_conserved {
            if !self.is_baseline {
                return Err(SimulationError::EnergyGain { time_s, share });
            }
            self.recorder.energy.get_or_insert(MotionFlag::EnergyGain { time_s });
        }
        let has_settled = self.rest.has_settled(time_s, &now);
        let has_ended = has_settled && self.ends_at_rest;
        Ok(!has_ended && !self.is_last())
    }

    /// Goes on to the next output instant.
    pub fn advance(&mut self, integrator: Integrator) {
        for step in 0..self.steps_per_output {
            let inputs = self.inputs_of(step, &self.state);
            let f = |stage, x: &[f64; N_STATE]| self.constants.derivative(x, inputs.at(stage));
            self.state = match integrator {
                Integrator::Rk4 => rk4_step(f, &self.state, self.step_s),
                Integrator::Euler => euler_step(f, &self.state, self.step_s),
            };
        }
        self.output += 1;
        self.sample();
    }

    /// Goes on to the next output instant, where the state is known.
    pub fn advanced_to(&mut self, state: [f64; N_STATE]) {
        self.state = state;
        self.output += 1;
        self.sample();
    }

    /// # Errors
    /// [`SimulationError::Series`] if the samples do not form a valid time series.
    pub fn finish(self) -> Result<Motion, SimulationError> {
        let motion = self.recorder.finish(&self.rest)?;
        Ok(Motion { applied_controls: self.applied.map(AppliedControls::finish), ..motion })
    }
}

/// Length of the steps of an integrator for a vehicle, s, and how many make an output interval.
fn steps(
    vehicle: &VehicleParameters,
    integrator: Integrator,
    manoeuvre: &Manoeuvre,
) -> (f64, usize) {
    let step_s = integrator.step_s();
    let n_substeps = match integrator {
        Integrator::Rk4 if manoeuvre.controls.acts_on_wheels() => {
            vehicle.braked_substeps(step_s, &manoeuvre.friction_zones)
        }
        Integrator::Rk4 => vehicle.substeps(step_s),
        Integrator::Euler => 1,
    };
    let per_output = (OUTPUT_INTERVAL_S / step_s).round() as usize;
    (step_s / n_substeps as f64, per_output * n_substeps)
}

/// Inputs of a manoeuvre, prepared for evaluation over time steps.
#[derive(Clone)]
pub(super) struct Inputs<'a> {
    controls: &'a Controls,
    contact: Option<(CumulativeImpulse, &'a ContactLoad)>,
    /// Drivers and systems, whose part counts from the first sample on.
    closed_loop: Option<ClosedLoopRun<'a>>,
}

/// Inputs over one time step.
#[derive(Clone, Copy)]
pub(super) struct StepInputs<T> {
    /// Inputs at the start, the middle and the end of the step.
    pub instants: [VehicleInput<T>; 3],
}

impl<'a> Inputs<'a> {
    /// Inputs by the histories alone.
    pub fn new(manoeuvre: &'a Manoeuvre) -> Self {
        let contact = manoeuvre.contact_load.as_ref();
        Self {
            controls: &manoeuvre.controls,
            contact: contact.map(|load| (load.force.cumulative(), load)),
            closed_loop: None,
        }
    }

    /// Inputs by the histories and by what drivers and systems see of the motion.
    pub fn with_closed_loop(manoeuvre: &'a Manoeuvre, vehicle: &'a VehicleParameters) -> Self {
        let closed_loop = manoeuvre.controls.closed_loop.as_ref();
        let closed_loop = closed_loop.map(|it| ClosedLoopRun::new(it, vehicle));
        Self { closed_loop, ..Self::new(manoeuvre) }
    }

    /// Whether there are drivers or systems.
    pub fn has_closed_loop(&self) -> bool {
        self.closed_loop.is_some()
    }

    /// Whether there are some that act on the wheels.
    pub fn has_controlled_wheels(&self) -> bool {
        self.closed_loop.as_ref().is_some_and(ClosedLoopRun::acts_on_wheels)
    }

    /// See [`Run::sees_struck_turn`].
    fn sees_struck_turn(&mut self, struck_turn_rad: Option<f64>) {
        if let Some(closed_loop) = &mut self.closed_loop {
            closed_loop.struck_turn_rad = struck_turn_rad;
        }
    }

    /// Lets drivers and systems see the motion. What they ask for is held until the next sample, which
    /// is taken [`OUTPUT_INTERVAL_S`] later.
    pub fn sample(
        &mut self,
        time_s: f64,
        state: &[f64; N_STATE],
        constants: &VehicleConstants<f64>,
        ground: &Ground<'_>,
    ) {
        if self.closed_loop.is_none() {
            return;
        }
        let x = VehicleState::from_array(*state);
        let mut histories = self.histories_at(time_s);
        histories.friction_share = ground.friction_share(&x);
        if let Some(closed_loop) = &mut self.closed_loop {
            closed_loop.sample(time_s, &x, &histories, constants);
        }
    }

    /// The inputs by the histories at an instant, without a collision force.
    fn histories_at(&self, time_s: f64) -> VehicleInput<f64> {
        let Controls { steer, wheels, .. } = self.controls;
        VehicleInput {
            steer_rad: steer.as_ref().map_or(0.0, |steer| steer.at(time_s)),
            wheels: wheels.as_ref().and_then(|wheels| wheels.at(time_s)),
            friction_share: None,
            collision: None,
        }
    }

    pub fn over(&self, start_s: f64, step_s: f64) -> StepInputs<f64> {
        let collision = self.collision_over(start_s, step_s);
        let instants_s = [start_s, start_s + step_s / 2.0, start_s + step_s];
        let at = |time_s: f64| {
            let histories = VehicleInput { collision, ..self.histories_at(time_s) };
            match &self.closed_loop {
                Some(closed_loop) => closed_loop.applied_to(histories),
                None => histories,
            }
        };
        StepInputs { instants: instants_s.map(at) }
    }

    /// Whether something may act from an instant on.
    pub fn may_act_from(&self, start_s: f64) -> bool {
        let Controls { steer, wheels, closed_loop } = self.controls;
        let is_pushed =
            self.contact.as_ref().is_some_and(|(cumulative, _)| start_s < cumulative.end_s());
        steer.is_some() || wheels.is_some() || closed_loop.is_some() || is_pushed
    }

    /// Axes of the collision force, and whether its yaw moment is recorded.
    pub fn kind_of_force(&self) -> (bool, bool) {
        self.contact.as_ref().map_or((false, false), |(cumulative, load)| {
            let is_recorded = load.recorded_moment && cumulative.angular_n_m_s.is_some();
            (load.force.axes == ForceAxes::World, is_recorded)
        })
    }

    /// The last instant at which force, steer angle or wheels change, s; 0 if nothing acts.
    pub fn last_change_s(&self) -> f64 {
        let Controls { steer, wheels, closed_loop } = self.controls;
        let contact = self.contact.as_ref().map(|(cumulative, _)| cumulative.end_s());
        let steer = steer.as_ref().and_then(|steer| steer.time_s.last().copied());
        let wheels = wheels.as_ref().and_then(|wheels| wheels.time_s.last().copied());
        let closed_loop = closed_loop.as_ref().map(ClosedLoop::last_change_s);
        [contact, steer, wheels, closed_loop].into_iter().flatten().fold(0.0, f64::max)
    }

    /// The end of the collision force, s; 0 without one.
    pub fn force_end_s(&self) -> f64 {
        self.contact.as_ref().map_or(0.0, |(cumulative, _)| cumulative.end_s())
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

impl StepInputs<f64> {
    /// Inputs of a vehicle that coasts.
    pub const RELEASED: Self = Self { instants: [VehicleInput::RELEASED; 3] };

    /// The same inputs with the friction of the ground under the wheels.
    ///
    /// - `state`: at the start of the step.
    #[inline(always)]
    pub fn on(mut self, ground: &Ground<'_>, state: &[f64; N_STATE]) -> Self {
        if !ground.has_zones() {
            return self;
        }
        let share = ground.friction_share(&VehicleState::from_array(*state));
        self.instants.iter_mut().for_each(|instant| instant.friction_share = share);
        self
    }
}

impl<T> StepInputs<T> {
    #[inline(always)]
    pub fn at(&self, stage: Stage) -> &VehicleInput<T> {
        let [start, middle, end] = &self.instants;
        match stage {
            Stage::Start => start,
            Stage::Middle => middle,
            Stage::End => end,
        }
    }
}
