//! Two vehicles on their tires with the contact force of their outlines between them, to the end.
//!
//! Both are 4DOF vehicles with their own controls, ground and end. Over each step the contact force is
//! held, evaluated at the poses that the vehicles reach in the middle of the step with their present
//! velocities:
//!
//! ```text
//! F = F(q + h/2 q̇, q̇)      then one step of length h of both vehicles under F
//! ```
//!
//! That is the leapfrog method: of second order, and an elastic contact neither gains nor loses energy by
//! it. While the vehicles are apart, both take steps of the classical Runge–Kutta method that follow their
//! speed (`vehicle/held_force.rs`). Force and moments are equal and opposite, so that momentum and angular momentum
//! of both vehicles together change by the tires alone.
//! The step is 0.5 ms in contact, 0.25 ms where ω h would exceed 0.2, with ω from the stiffness of the
//! contact on unloading and the masses at the contact point or from friction and damping, and 1 or 2 ms
//! where ω h stays below 0.1 and the outlines slide along each other by less than a quarter of an element.
//! It is 1 ms while the outlines are near each other, and 10 ms while they cannot meet within that time.
//! Contact may begin anew at any time. Where the force of the first contact is known, it drives both
//! vehicles while it lasts (`first_force.rs`).

use crate::collision::Role;
use crate::collision::contact::first_force::FirstForce;
use crate::collision::contact::phases::PhaseWatch;
use crate::collision::contact::{
    ContactConditions, ContactEnergy, ContactForce, FULL_FRICTION_SPEED_M_S, HandOver, PairContact,
    PairError, PairMotion, PairVehicle, PlanarMotion, USUAL_ELEMENT_M, VehiclePair,
};
use crate::vehicle::frames::body_from_world;
use crate::vehicle::{
    CollisionForce, ContactPoint, HeldForceRun, N_ACCELERATION, N_STATE, OUTPUT_INTERVAL_S,
    VehicleInput, VehicleState,
};

/// Steps of the shortest kind in an output interval.
const TICKS_PER_OUTPUT: usize = 40;

/// Ticks of the steps there are, from the longest on.
const STEP_TICKS: [usize; 5] =
    [TICKS_PER_OUTPUT, LONGEST_CONTACT_TICKS, NEAR_TICKS, USUAL_TICKS, 1];

/// Ticks of the longest step in contact.
const LONGEST_CONTACT_TICKS: usize = 8;

/// Ticks of a step while the outlines are near each other.
const NEAR_TICKS: usize = 4;

/// Ticks of a step as a contact begins and under a known force.
const USUAL_TICKS: usize = 2;

/// Largest ω h of a contact, and of the decay of velocities in it.
const MAX_RATE_TIMES_STEP: f64 = 0.2;

/// The same of steps that are longer than usual.
const LONG_RATE_TIMES_STEP: f64 = 0.1;

/// How much larger these bounds, and the way below, are where steps are long.
const LONGER: f64 = 4.0;

/// Longest way that the outlines may slide along each other over a step of a contact, m: a quarter of an
/// element.
const LONGEST_SLIDE_M: f64 = USUAL_ELEMENT_M / 4.0;

/// Distance of the outlines from which on a vehicle at rest is left behind by one that moves away, m.
const LEFT_M: f64 = 1.0;

/// Distance of the outlines below which steps are those of a contact, m.
const NEAR_M: f64 = 0.05;

/// States of both vehicles, in the order of `eq:state_vector`.
type States = [[f64; N_STATE]; 2];

/// Residual accelerations of vehicles that move by the equations of motion alone.
const NO_RESIDUAL: [[f64; N_ACCELERATION]; 2] = [[0.0; N_ACCELERATION]; 2];

impl VehiclePair<'_> {
    /// Simulates both vehicles for their duration or, if their manoeuvres end at rest, until the struck
    /// one is at rest and the striking one is so, too, or moves away from it (see
    /// [`CoupledSettings`](crate::collision::contact::CoupledSettings)). The
    /// result is deterministic.
    ///
    /// # Errors
    /// [`PairError`] if a number is out of range, the manoeuvres do not go together, or a motion cannot
    /// be computed.
    pub fn simulate(&self) -> Result<PairMotion, PairError> {
        let mut run = PairRun::new(self)?;
        while run.goes_on(&NO_RESIDUAL)? {}
        run.finish()
    }
}

/// Two motions that are being simulated. They stand at an output instant.
pub struct PairRun<'a> {
    pair: VehiclePair<'a>,
    runs: [HeldForceRun<'a>; 2],
    contact: PairContact<'a>,
    /// A known force of the first contact, until the law has taken over.
    first_force: Option<FirstForce>,
    hand_over: Option<HandOver>,
    phases: PhaseWatch,
    /// Number of output instants before this one.
    output: usize,
    tick_s: f64,
    /// Fastest rate of the contact at the last step, 1/s.
    contact_rate_1_s: f64,
    was_pushed: bool,
    /// Whether each vehicle moved at the instant before.
    moves: [bool; 2],
    /// Mean contact force on each vehicle over the interval before.
    last_mean: [Option<CollisionForce<f64>>; 2],
    energy: ContactEnergy,
    normal_work_j: f64,
    /// Heading of the struck vehicle at the first contact, rad; `None` before it.
    first_contact_yaw_rad: Option<f64>,
}

/// Sums of an output interval.
#[derive(Default)]
struct IntervalSums {
    impulse_world_n_s: [f64; 2],
    yaw_impulses_n_m_s: [f64; 2],
    is_pushed: bool,
}

impl<'a> PairRun<'a> {
    /// Two vehicles at the beginning of their motions.
    ///
    /// # Errors
    /// [`PairError`] if a number is out of range or the manoeuvres do not go together.
    pub fn new(pair: &VehiclePair<'a>) -> Result<Self, PairError> {
        pair.check()?;
        let run = |i: usize| {
            let PairVehicle { vehicle, manoeuvre, .. } = pair.vehicles[i];
            HeldForceRun::new(vehicle, manoeuvre)
                .map_err(|source| PairError::Vehicle { role: Role::WORDS[i], source })
        };
        let bodies = pair.vehicles.map(|vehicle| vehicle.body);
        let ticks = (TICKS_PER_OUTPUT * pair.settings.step_divisor) as f64;
        Ok(Self {
            pair: *pair,
            runs: [run(0)?, run(1)?],
            contact: PairContact::new(bodies, pair.conditions),
            first_force: pair.vehicles[0].manoeuvre.contact_load.as_ref().and_then(FirstForce::new),
            hand_over: None,
            phases: PhaseWatch::new(pair.vehicles.map(|it| it.vehicle.mass.mass_kg)),
            output: 0,
            tick_s: OUTPUT_INTERVAL_S / ticks,
            contact_rate_1_s: 0.0,
            was_pushed: false,
            moves: [true; 2],
            last_mean: [None; 2],
            energy: ContactEnergy::default(),
            normal_work_j: 0.0,
            first_contact_yaw_rad: None,
        })
    }

    /// Time of the output instant at which the vehicles stand, s.
    pub fn time_s(&self) -> f64 {
        self.output as f64 * OUTPUT_INTERVAL_S
    }

    /// States of the struck and of the striking vehicle at this instant.
    pub fn states(&self) -> [VehicleState<f64>; 2] {
        [0, 1].map(|i| VehicleState::from_array(*self.runs[i].state()))
    }

    /// Input of a vehicle over the coming output interval. Its contact force is that of a known first
    /// contact, or the mean over the interval before, since that of the coming one follows from the motion.
    ///
    /// - `vehicle`: 0 for the struck, 1 for the striking one.
    pub fn input(&self, vehicle: usize) -> VehicleInput<f64> {
        let known = self.known_force().map(|force| {
            let motions = motions(&[0, 1].map(|i| *self.runs[i].state()));
            let start_s = self.time_s();
            let mean = force.over([start_s, start_s + OUTPUT_INTERVAL_S], &motions);
            self.collision_force(vehicle, &mean, &motions[vehicle])
        });
        let collision = known.or(self.last_mean[vehicle]);
        VehicleInput { collision, ..self.runs[vehicle].coming() }
    }

    /// The force of the first contact at this instant, while a known one lasts.
    fn known_force(&self) -> Option<&FirstForce> {
        self.first_force.as_ref().filter(|force| self.time_s() < force.end_s())
    }

    /// Whether a known force of the first contact drives the vehicles over the coming interval.
    pub fn is_driven_by_known_force(&self) -> bool {
        self.known_force().is_some()
    }

    /// Whether each vehicle had come to rest at the instant before.
    pub fn are_at_rest(&self) -> [bool; 2] {
        self.moves.map(|moves| !moves)
    }

    /// Acceleration of the CG of a vehicle by its tires and what resists its motion at this instant, m/s².
    ///
    /// - `vehicle`: 0 for the struck, 1 for the striking one.
    pub fn tire_acceleration_m_s2(&self, vehicle: usize) -> f64 {
        self.runs[vehicle].tire_acceleration_m_s2()
    }

    /// When the vehicles first touched each other, s; `None` if they have not.
    pub fn first_contact_s(&self) -> Option<f64> {
        self.phases.first_s()
    }

    /// Goes on to the next output instant and records this one, and says whether there is more to do.
    ///
    /// - `residuals`: accelerations of each vehicle that the equations of motion leave out, held over
    ///   the interval: v̇_x, v̇_y in m/s², ṙ, φ̈ in rad/s². They are scaled back where they would give a
    ///   vehicle that nothing drives more than half of what its tires and resistance take.
    ///
    /// # Errors
    /// [`PairError::Vehicle`] if a motion cannot be computed.
    pub fn goes_on(&mut self, residuals: &[[f64; N_ACCELERATION]; 2]) -> Result<bool, PairError> {
        let residuals = &[0, 1].map(|i| self.runs[i].bounded_residual(residuals[i]));
        let mut states: States = [0, 1].map(|i| *self.runs[i].state());
        let mut sums = IntervalSums::default();
        let is_last = self.runs[0].is_last();
        if !is_last {
            let mut left = TICKS_PER_OUTPUT * self.pair.settings.step_divisor;
            let first = self.output * left;
            while left > 0 {
                let ticks = self.step_ticks(&states, left);
                let start_tick = first + TICKS_PER_OUTPUT * self.pair.settings.step_divisor - left;
                states = self.step(&states, start_tick, ticks, (&mut sums, residuals));
                left -= ticks;
            }
            if !sums.is_pushed && *residuals != NO_RESIDUAL {
                states = [0, 1].map(|i| self.runs[i].without_energy_gain(states[i]));
            }
        }
        let mut moves = [false; 2];
        for (i, role) in Role::WORDS.into_iter().enumerate() {
            let mean = sums.is_pushed.then(|| self.mean_force(i, &sums));
            self.last_mean[i] = mean;
            moves[i] = self.runs[i]
                .record(mean, self.was_pushed || residuals[i] != NO_RESIDUAL[i])
                .map_err(|source| PairError::Vehicle { role, source })?;
        }
        let is_left_behind = !self.pair.settings.until_both_rest && self.is_left_behind(&sums);
        let goes_on = moves[0] || moves[1] && !is_left_behind;
        if sums.is_pushed {
            let yaw_rad = VehicleState::from_array(*self.runs[0].state()).yaw_rad;
            self.first_contact_yaw_rad.get_or_insert(yaw_rad);
        }
        if goes_on {
            let yaw_rad = VehicleState::from_array(states[0]).yaw_rad;
            self.runs[1].sees_struck_turn(self.first_contact_yaw_rad.map(|first| yaw_rad - first));
            for (run, state) in self.runs.iter_mut().zip(states) {
                run.advanced_to(state);
            }
            self.output += 1;
        }
        (self.was_pushed, self.moves) = (sums.is_pushed, moves);
        Ok(goes_on)
    }

    /// Whether the striking vehicle, as far as it still moves, moves away from the struck one.
    fn is_left_behind(&self, sums: &IntervalSums) -> bool {
        let motions = motions(&[0, 1].map(|i| *self.runs[i].state()));
        let [struck, striking] = &motions;
        let way = |axis: usize| {
            (striking.position_m[axis] - struck.position_m[axis]) * striking.velocity_m_s[axis]
        };
        !sums.is_pushed && way(0) + way(1) > 0.0 && self.contact.is_apart(&motions, LEFT_M)
    }

    /// Length of the next step in ticks. Steps begin at multiples of their length.
    fn step_ticks(&self, states: &States, left: usize) -> usize {
        let motions = motions(states);
        let speed_m_s = relative_speed_m_s(&motions);
        let is_apart = |ticks: usize| {
            let way_m = speed_m_s * self.tick_s * ticks as f64;
            self.contact.is_apart(&motions, NEAR_M + way_m)
        };
        let longest = if self.first_force.is_some() {
            USUAL_TICKS
        } else if self.contact_rate_1_s > 0.0 {
            // As without a divisor, so that one divides every step.
            let tick_s = self.tick_s * self.pair.settings.step_divisor as f64;
            let usual_s = tick_s * USUAL_TICKS as f64;
            let longer = if self.pair.settings.has_long_steps { LONGER } else { 1.0 };
            let is_stiff = self.contact_rate_1_s * usual_s > longer * MAX_RATE_TIMES_STEP;
            let by_rate_s = longer * LONG_RATE_TIMES_STEP / self.contact_rate_1_s;
            let by_slide_s = longer * LONGEST_SLIDE_M / speed_m_s;
            let ticks = (by_rate_s.min(by_slide_s) / tick_s) as usize;
            ticks.clamp(if is_stiff { 1 } else { USUAL_TICKS }, LONGEST_CONTACT_TICKS)
        } else if is_apart(TICKS_PER_OUTPUT) {
            TICKS_PER_OUTPUT
        } else if is_apart(NEAR_TICKS) {
            NEAR_TICKS
        } else {
            USUAL_TICKS
        };
        let fits = |ticks: &usize| *ticks <= longest && left.is_multiple_of(*ticks);
        STEP_TICKS.into_iter().find(fits).unwrap_or(1)
    }

    /// Takes one step of both vehicles under the contact force in its middle. A fixed object stays where it
    /// is, and a vehicle at rest does until it is pushed.
    fn step(
        &mut self,
        states: &States,
        start_tick: usize,
        ticks: usize,
        (sums, residuals): (&mut IntervalSums, &[[f64; N_ACCELERATION]; 2]),
    ) -> States {
        let start_s = start_tick as f64 * self.tick_s;
        let step_s = ticks as f64 * self.tick_s;
        let middle = motions(states).map(|motion| motion.after(step_s / 2.0));
        let of_law = self.contact.advance(&middle);
        let end_s = start_s + step_s;
        self.first_force.take_if(|first| first.share_of_law(start_s) >= 1.0);
        let first = self.first_force.as_ref();
        let known = first.filter(|first| start_s < first.end_s());
        let is_known = known.is_some();
        let force = match known {
            Some(first) => Some(first.over([start_s, end_s], &middle)),
            None => {
                let share = first.map_or(1.0, |first| first.share_of_law(start_s));
                of_law.map(|law| law.scaled(share)).filter(|_| share > 0.0)
            }
        };
        self.contact_rate_1_s = force.as_ref().map_or(0.0, |it| self.rate_1_s(it, &middle));
        self.phases.add([start_s, end_s], force.as_ref(), &middle);
        let mut next = *states;
        for i in 0..2 {
            if self.pair.vehicles[i].vehicle.fixed.is_some() {
                continue;
            }
            if force.is_none() && !self.moves[i] && self.runs[i].stays(&states[i]) {
                next[i] = VehicleState::from_array(next[i]).at_rest().to_array();
                continue;
            }
            let collision = force.map(|force| self.collision_force(i, &force, &middle[i]));
            next[i] = self.runs[i].stepped(collision, [start_s, step_s], &states[i], residuals[i]);
        }
        if let Some(force) = force {
            sums.add(&force, step_s);
            self.energy.friction_heat_j += force.friction_power_w * step_s;
            self.normal_work_j += force.normal_power_w * step_s;
            let lost_j = -work_j(&force, states, &next);
            self.energy.absorbed_j += lost_j;
            if is_known {
                self.energy.first_force_j += lost_j;
                self.follow_known_force((&force, lost_j), of_law.as_ref(), [step_s, end_s]);
            }
        }
        next
    }

    /// Takes note of a step under the known force, and scales the law at its end.
    fn follow_known_force(
        &mut self,
        (known, lost_j): (&ContactForce, f64),
        of_law: Option<&ContactForce>,
        [step_s, end_s]: [f64; 2],
    ) {
        let Some(first) = &mut self.first_force else { return };
        first.add(known, lost_j, of_law, step_s);
        if end_s >= first.end_s() {
            let hand_over = first.hand_over();
            self.contact.scale_loads(hand_over.scale);
            if self.pair.settings.first_force_is_whole {
                self.contact.unload();
            }
            self.hand_over = Some(hand_over);
        }
    }

    /// The contact force as the equations of motion take it.
    ///
    /// - `middle`: motion of the vehicle in the middle of the step.
    fn collision_force(
        &self,
        vehicle: usize,
        force: &ContactForce,
        middle: &PlanarMotion,
    ) -> CollisionForce<f64> {
        let sign = if vehicle == 0 { 1.0 } else { -1.0 };
        let ([px, py], [x, y]) = (force.point_world_m, middle.position_m);
        let [x_body_m, y_body_m] = body_from_world(middle.yaw_rad, [px - x, py - y]);
        let height_m = self.pair.conditions.height_m;
        CollisionForce {
            force_n: force.force_world_n.map(|force_n| sign * force_n),
            in_world_axes: true,
            yaw_moment_n_m: Some(force.yaw_moments_n_m[vehicle]),
            contact: ContactPoint { x_body_m, y_body_m, height_m },
        }
    }

    /// Mean force over an output interval. Its yaw moment is given, so that its place does not count.
    fn mean_force(&self, vehicle: usize, sums: &IntervalSums) -> CollisionForce<f64> {
        let sign = if vehicle == 0 { 1.0 } else { -1.0 };
        let height_m = self.pair.conditions.height_m;
        CollisionForce {
            force_n: sums.impulse_world_n_s.map(|impulse| sign * impulse / OUTPUT_INTERVAL_S),
            in_world_axes: true,
            yaw_moment_n_m: Some(sums.yaw_impulses_n_m_s[vehicle] / OUTPUT_INTERVAL_S),
            contact: ContactPoint { x_body_m: 0.0, y_body_m: 0.0, height_m },
        }
    }

    /// Rate of the contact: the larger one of ω on unloading and of the decay of velocities by friction
    /// and damping, 1/s.
    fn rate_1_s(&self, force: &ContactForce, motions: &[PlanarMotion; 2]) -> f64 {
        let [fx, fy] = force.force_world_n;
        let size_n = fx.hypot(fy);
        let mut inverse_mass_1_kg = 0.0;
        for (i, motion) in motions.iter().enumerate() {
            let mass = &self.pair.vehicles[i].vehicle.mass;
            let [dx, dy] = [0, 1].map(|axis| force.point_world_m[axis] - motion.position_m[axis]);
            let arm_m = (dx * fy - dy * fx) / size_n;
            inverse_mass_1_kg += 1.0 / mass.mass_kg + arm_m * arm_m / mass.yaw_inertia_kg_m2;
        }
        let ContactConditions { friction, damping_s_m, .. } = self.pair.conditions;
        let per_speed_s_m = friction / FULL_FRICTION_SPEED_M_S + damping_s_m;
        let by_damping = per_speed_s_m * force.normal_load_n * inverse_mass_1_kg;
        by_damping.max((force.unloading_stiffness_n_per_m * inverse_mass_1_kg).sqrt())
    }

    /// The motions so far.
    ///
    /// # Errors
    /// [`PairError::Vehicle`] if the samples do not form a valid time series.
    pub fn finish(self) -> Result<PairMotion, PairError> {
        let Self { runs, contact, phases, output, .. } = self;
        let [struck, striking] = runs;
        let finish = |run: HeldForceRun<'_>, i: usize| {
            run.finish().map_err(|source| PairError::Vehicle { role: Role::WORDS[i], source })
        };
        let stored_j = contact.stored_energy_j();
        let crush_heat_j = self.normal_work_j - stored_j;
        let law_work_j = contact.law_work_j();
        Ok(PairMotion {
            motions: [finish(struck, 0)?, finish(striking, 1)?],
            phases: phases.finish(output as f64 * OUTPUT_INTERVAL_S),
            energy: ContactEnergy { crush_heat_j, stored_j, law_work_j, ..self.energy },
            hand_over: self.hand_over,
            dents_m: contact.dents_m(),
        })
    }
}

impl IntervalSums {
    fn add(&mut self, force: &ContactForce, step_s: f64) {
        self.is_pushed = true;
        for axis in 0..2 {
            self.impulse_world_n_s[axis] += force.force_world_n[axis] * step_s;
        }
        for (sum, moment) in self.yaw_impulses_n_m_s.iter_mut().zip(force.yaw_moments_n_m) {
            *sum += moment * step_s;
        }
    }
}

fn motions(states: &States) -> [PlanarMotion; 2] {
    [0, 1].map(|i| PlanarMotion::from(&VehicleState::from_array(states[i])))
}

/// Largest speed at which any two points of the outlines may approach each other, m/s.
fn relative_speed_m_s([struck, striking]: &[PlanarMotion; 2]) -> f64 {
    let [dx, dy] = [0, 1].map(|axis| striking.velocity_m_s[axis] - struck.velocity_m_s[axis]);
    let arm_m = 4.0;
    dx.hypot(dy) + arm_m * (struck.yaw_rate_rad_s.abs() + striking.yaw_rate_rad_s.abs())
}

/// Work of a held contact force on the planar motion of both vehicles over a step, J.
fn work_j(force: &ContactForce, from: &States, to: &States) -> f64 {
    let [fx, fy] = force.force_world_n;
    let [from, to] = [from, to].map(|states| states.map(VehicleState::from_array));
    let of_vehicle = |i: usize, sign: f64| {
        let (from, to) = (&from[i], &to[i]);
        sign * (fx * (to.x_m - from.x_m) + fy * (to.y_m - from.y_m))
            + force.yaw_moments_n_m[i] * (to.yaw_rad - from.yaw_rad)
    };
    of_vehicle(0, 1.0) + of_vehicle(1, -1.0)
}

#[cfg(test)]
#[path = "coupled_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "coupled_rest_tests.rs"]
mod rest_tests;

#[cfg(test)]
#[path = "edsmac_tests.rs"]
mod edsmac_tests;
