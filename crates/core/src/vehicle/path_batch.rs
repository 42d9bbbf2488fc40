//! Many motions of which only the path of the vehicle counts, as particles of a reconstruction: side
//! by side in the lanes of the vector registers, with steps that follow the speed, and without the
//! forces that [`simulate_batch`](crate::vehicle::simulate_batch) records.
//!
//! Each lane has its own step, so that the path of a run does not depend on those beside it:
//!
//! ```text
//! h = min(h_max, K/λ(v)),   at least h_ref        λ(v) = λ₀ ε/(|v| + ε)      |v| = √(v_x² + v_y²) + 1.5 m |r|
//! ```
//!
//! The fastest modes are those of the tires, whose rates λ fall as 1/|v| (`stability.rs`); h_ref is the
//! step of [`VehicleParameters::simulate`]. While a contact force acts and where the ground has friction
//! zones, h is at most 5 ms; the mean of the force over a step keeps the impulse exact.
//! Where drivers or systems act, a step ends at each of their samples, every 10 ms.
//! Below 0.3 m/s a car that only slows down is not followed by small steps: it comes to rest at its
//! present deceleration a, after `|v|/(2 a)` more of its present velocities; on a road with a slope only
//! where it slows down by more than twice what the weight does along the road, so that the road holds it.
//! The largest difference to the reference step is measured by the test of this file.

use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use crate::numerics::{MAX_LANES, Packed, Stage};
use crate::vehicle::batch::steps_side_by_side;
use crate::vehicle::ground::Ground;
use crate::vehicle::run::{Inputs, StepInputs};
use crate::vehicle::tire::SLIP_ANGLE_SPEED_M_S;
use crate::vehicle::{
    Integrator, N_STATE, OUTPUT_INTERVAL_S, PathPoint, RestWatch, SimulationRun, VehicleConstants,
    VehicleInput, VehicleState, WheelEffort,
};

/// Longest step of a path, s.
pub const MAX_PATH_STEP_S: f64 = 0.02;

/// Longest step while a contact force acts or where the ground has friction zones, s.
pub(super) const CONTACT_STEP_S: f64 = 5e-3;

/// K: step times rate of the tires, of 2.8 at the most for stability.
pub(super) const RATE_TIMES_STEP: f64 = 1.4;

/// Speed below which the rest of the way is not followed, m/s.
const STOPPING_SPEED_M_S: f64 = 0.3;

/// Smallest deceleration by which a vehicle is taken to come to rest, m/s²: half of what rolls most
/// easily.
const LEAST_DECELERATION_M_S2: f64 = 0.05;

/// Arm by which the yaw rate counts as a speed, m.
pub(super) const YAW_ARM_M: f64 = 1.5;

/// Runs that one task takes over.
const RUNS_PER_TASK: usize = 64;

/// Why a path ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathEnd {
    /// The vehicle is at rest.
    Rest,
    /// It is farther from where it started than the limit.
    Far,
    /// The duration of the manoeuvre is over.
    Time,
    /// The motion cannot be computed.
    Failed,
}

/// Path of a vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// States from the start to the end.
    pub points: Vec<PathPoint>,
    /// Why it ends.
    pub end: PathEnd,
}

impl Path {
    /// That of a motion that cannot be computed.
    pub fn failed() -> Self {
        Self { points: Vec::new(), end: PathEnd::Failed }
    }
}

/// How far the vehicles are followed, beside the durations of their manoeuvres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathLimit {
    /// Distance from the start beyond which a vehicle is followed no further, m.
    pub distance_m: f64,
}

/// Simulates paths side by side and on all cores, each to rest, to its duration or to the limit.
///
/// - `runs`: their contact forces are all in the same axes and all with or all without a recorded
///   yaw moment; others are simulated apart;
/// - `told`: what is kept of the path of the run of a number;
/// - returns what is kept of each path, in the order of `runs`.
pub fn simulate_paths<R: Send>(
    runs: &[SimulationRun<'_>],
    limit: PathLimit,
    evaluate: impl Fn(usize, Path) -> R + Sync,
) -> Vec<R> {
    let lanes: Vec<Lane<'_>> =
        runs.iter().enumerate().map(|(idx, run)| Lane::new(idx, run)).collect();
    let kind = |lane: &Lane<'_>| (lane.inputs.kind_of_force(), lane.constants.slope_m_s2.is_some());
    let parts: Vec<&[Lane<'_>]> = lanes
        .chunk_by(|a, b| kind(a) == kind(b))
        .flat_map(|alike| alike.chunks(RUNS_PER_TASK))
        .collect();
    let ended = parts.into_par_iter().map(|part| {
        let paths = Task { waiting: part, limit }.paths();
        paths.into_iter().map(|(idx, path)| (idx, evaluate(idx, path))).collect::<Vec<_>>()
    });
    let mut ended: Vec<(usize, R)> = ended.flatten_iter().collect();
    ended.sort_by_key(|(idx, _)| *idx);
    ended.into_iter().map(|(_, value)| value).collect()
}

/// A run that waits for a lane, or is in one.
#[derive(Clone)]
struct Lane<'a> {
    idx: usize,
    constants: VehicleConstants<f64>,
    inputs: Inputs<'a>,
    ground: Ground<'a>,
    /// Whether the friction zones are such that the motion can be computed.
    has_proper_ground: bool,
    last_change_s: f64,
    force_end_s: f64,
    duration_s: f64,
    shortest_step_s: f64,
    longest_step_s: f64,
    rest_duration_s: f64,
    /// Deceleration below which a vehicle is not taken to come to rest, m/s².
    least_deceleration_m_s2: f64,
    /// K/(λ₀ ε), s²/m.
    step_per_speed_s2_m: f64,
    time_s: f64,
    step_s: f64,
    start_m: [f64; 2],
    state: [f64; N_STATE],
    /// Speed at the start of the last step, m/s.
    speed_m_s: f64,
    slow_since_s: Option<f64>,
    /// How often drivers and systems have seen the motion.
    n_samples: usize,
    points: Vec<PathPoint>,
}

impl<'a> Lane<'a> {
    fn new(idx: usize, run: &SimulationRun<'a>) -> Self {
        let (vehicle, manoeuvre) = (run.vehicle, run.manoeuvre);
        let inputs = Inputs::with_closed_loop(manoeuvre, vehicle);
        let reference_s = Integrator::Rk4.step_s();
        let initial = manoeuvre.initial;
        let [g_x, g_y] = vehicle.slope.gravity_m_s2();
        Self {
            idx,
            constants: vehicle.constants(),
            last_change_s: inputs.last_change_s(),
            force_end_s: inputs.force_end_s(),
            inputs,
            ground: Ground::new(&manoeuvre.friction_zones, vehicle),
            has_proper_ground: manoeuvre.friction_zones.iter().all(|zone| zone.check().is_ok()),
            duration_s: manoeuvre.duration_s,
            shortest_step_s: reference_s
                / vehicle.braked_substeps(reference_s, &manoeuvre.friction_zones) as f64,
            longest_step_s: MAX_PATH_STEP_S.min(vehicle.roll_step_s()),
            rest_duration_s: vehicle.rest_duration_s(),
            least_deceleration_m_s2: LEAST_DECELERATION_M_S2 + 2.0 * g_x.hypot(g_y),
            step_per_speed_s2_m: RATE_TIMES_STEP
                / (vehicle.tire_rate_at_rest_1_s() * SLIP_ANGLE_SPEED_M_S),
            time_s: 0.0,
            step_s: 0.0,
            start_m: [initial.x_m, initial.y_m],
            state: initial.to_array(),
            speed_m_s: 0.0,
            slow_since_s: None,
            n_samples: 0,
            points: Vec::new(),
        }
    }

    fn now(&self) -> VehicleState<f64> {
        VehicleState::from_array(self.state)
    }

    /// Notes where the vehicle is, and says why the path ends, if it does.
    fn record(&mut self, limit: PathLimit) -> Option<PathEnd> {
        let x = self.now();
        if !self.state.iter().all(|value| value.is_finite()) || !self.has_proper_ground {
            return Some(PathEnd::Failed);
        }
        self.points.push(PathPoint {
            time_s: self.time_s,
            x_m: x.x_m,
            y_m: x.y_m,
            yaw_rad: x.yaw_rad,
            vx_body_m_s: x.vx_body_m_s,
            vy_body_m_s: x.vy_body_m_s,
            yaw_rate_rad_s: x.yaw_rate_rad_s,
        });
        let is_slow = self.time_s >= self.last_change_s && RestWatch::is_slow(&x);
        match (is_slow, self.slow_since_s) {
            (false, _) => self.slow_since_s = None,
            (true, None) => self.slow_since_s = Some(self.time_s),
            (true, Some(since_s)) if self.time_s >= since_s + self.rest_duration_s => {
                return Some(PathEnd::Rest);
            }
            (true, Some(_)) => {}
        }
        let [x0, y0] = self.start_m;
        if (x.x_m - x0).hypot(x.y_m - y0) > limit.distance_m {
            return Some(PathEnd::Far);
        }
        if self.time_s >= self.duration_s {
            return Some(PathEnd::Time);
        }
        let speed_m_s = speed_m_s(&x);
        if speed_m_s < STOPPING_SPEED_M_S
            && self.time_s >= self.last_change_s
            && let Some(stop_s) = self.stop_s(speed_m_s)
        {
            self.stop_after(stop_s);
            return Some(PathEnd::Rest);
        }
        self.speed_m_s = speed_m_s;
        let is_short = self.time_s < self.force_end_s || self.ground.has_zones_near(&x);
        let longest_s =
            if is_short { self.longest_step_s.min(CONTACT_STEP_S) } else { self.longest_step_s };
        let by_tires_s = self.step_per_speed_s2_m * (speed_m_s + SLIP_ANGLE_SPEED_M_S);
        self.step_s = by_tires_s.min(longest_s).max(self.shortest_step_s);
        if self.inputs.has_closed_loop() {
            self.sample();
        }
        None
    }

    /// Lets drivers and systems see the motion where it is time, and shortens the step such that it ends
    /// not after their next sample.
    fn sample(&mut self) {
        let next_s = self.n_samples as f64 * OUTPUT_INTERVAL_S;
        if self.time_s >= next_s - 1e-9 {
            self.inputs.sample(next_s, &self.state, &self.constants, &self.ground);
            self.n_samples += 1;
        }
        let left_s = self.n_samples as f64 * OUTPUT_INTERVAL_S - self.time_s;
        self.step_s = self.step_s.min(left_s);
    }

    /// Time to rest at the deceleration of the last step, s; `None` if the vehicle hardly slows down.
    fn stop_s(&self, speed_m_s: f64) -> Option<f64> {
        let deceleration_m_s2 = (self.speed_m_s - speed_m_s) / self.step_s;
        (deceleration_m_s2 > self.least_deceleration_m_s2).then(|| speed_m_s / deceleration_m_s2)
    }

    /// Notes where the vehicle stands after it has stopped within a time.
    fn stop_after(&mut self, stop_s: f64) {
        let x = self.now();
        let (sin, cos) = x.yaw_rad.sin_cos();
        let half_s = stop_s / 2.0;
        self.points.push(PathPoint {
            time_s: self.time_s + stop_s,
            x_m: x.x_m + (x.vx_body_m_s * cos - x.vy_body_m_s * sin) * half_s,
            y_m: x.y_m + (x.vx_body_m_s * sin + x.vy_body_m_s * cos) * half_s,
            yaw_rad: x.yaw_rad + x.yaw_rate_rad_s * half_s,
            vx_body_m_s: 0.0,
            vy_body_m_s: 0.0,
            yaw_rate_rad_s: 0.0,
        });
    }

    /// The number of the run, and its path.
    fn ended(self, end: PathEnd) -> (usize, Path) {
        (self.idx, Path { points: self.points, end })
    }

    /// Inputs over the coming step. Wheels that roll freely are braked by nothing, so that every lane
    /// takes the same way through the equations.
    fn coming(&self) -> StepInputs<f64> {
        let inputs = self.inputs.over(self.time_s, self.step_s);
        let mut inputs = inputs.on(&self.ground, &self.state);
        for instant in &mut inputs.instants {
            instant.wheels.get_or_insert([WheelEffort::FREE; 4]);
        }
        inputs
    }
}

/// Runs that one core takes over.
struct Task<'l, 'a> {
    waiting: &'l [Lane<'a>],
    limit: PathLimit,
}

impl Task<'_, '_> {
    /// The numbers of the runs and their paths. It is not generic and never inlined, so that it is
    /// compiled here and not once more in each crate that simulates.
    #[inline(never)]
    fn paths(self) -> Vec<(usize, Path)> {
        pulp::Arch::new().dispatch(self)
    }
}

impl WithSimd for Task<'_, '_> {
    type Output = Vec<(usize, Path)>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let mut waiting = self.waiting.iter();
        let mut running: Vec<Lane<'_>> = Vec::with_capacity(Packed::<S>::N);
        let mut ended = Vec::with_capacity(self.waiting.len());
        let mut constants: Option<VehicleConstants<Packed<S>>> = None;
        // Of lanes in which nothing changes any more.
        let mut settled: Option<StepInputs<Packed<S>>> = None;
        loop {
            while running.len() < Packed::<S>::N {
                let Some(mut lane) = waiting.next().cloned() else { break };
                match lane.record(self.limit) {
                    None => running.push(lane),
                    Some(end) => ended.push(lane.ended(end)),
                }
                (constants, settled) = (None, None);
            }
            let Some(last) = running.len().checked_sub(1) else { return ended };
            let of_lane = |lane: usize| &running[lane.min(last)].constants;
            let of_all =
                constants.take().unwrap_or_else(|| VehicleConstants::packed(simd, of_lane));
            let inputs = settled.take().unwrap_or_else(|| {
                let mut of_lanes = [const { StepInputs::RELEASED }; MAX_LANES];
                for (of_lane, lane) in of_lanes.iter_mut().zip(&running) {
                    *of_lane = lane.coming();
                }
                steps_side_by_side(simd, &of_lanes)
            });
            let is_settled = running.iter().all(|lane| {
                let depends_on_motion = lane.ground.has_zones() || lane.inputs.has_closed_loop();
                lane.time_s >= lane.last_change_s && !depends_on_motion
            });
            step(simd, &of_all, &inputs, &mut running);
            if !end_lanes(&mut running, self.limit, &mut ended) {
                constants = Some(of_all);
                settled = is_settled.then_some(inputs);
            }
        }
    }
}

/// Notes where the vehicles are, and takes the paths that end out of their lanes.
///
/// - returns whether there is one.
fn end_lanes(
    running: &mut Vec<Lane<'_>>,
    limit: PathLimit,
    ended: &mut Vec<(usize, Path)>,
) -> bool {
    let n_before = running.len();
    let mut lane = 0;
    while lane < running.len() {
        match running[lane].record(limit) {
            None => lane += 1,
            Some(end) => ended.push(running.remove(lane).ended(end)),
        }
    }
    running.len() < n_before
}

/// Takes one step of the classical Runge–Kutta method in every lane, each of its own length.
#[inline(always)]
fn step<S: Simd>(
    simd: S,
    constants: &VehicleConstants<Packed<S>>,
    inputs: &StepInputs<Packed<S>>,
    running: &mut [Lane<'_>],
) {
    let mut steps_s = [0.0; MAX_LANES];
    let mut values = [[0.0; MAX_LANES]; N_STATE];
    for (lane, run) in running.iter().enumerate() {
        steps_s[lane] = run.step_s;
        for (values, value) in values.iter_mut().zip(run.state) {
            values[lane] = value;
        }
    }
    let h = Packed::new(simd, &steps_s);
    let mut x = [h; N_STATE];
    for (x, values) in x.iter_mut().zip(&values) {
        *x = Packed::new(simd, values);
    }
    let half = h * 0.5;
    let f = |x: &[Packed<S>; N_STATE], u: &VehicleInput<Packed<S>>| constants.derivative(x, u);
    let k1 = f(&x, inputs.at(Stage::Start));
    let k2 = f(&moved(&x, &k1, half), inputs.at(Stage::Middle));
    let k3 = f(&moved(&x, &k2, half), inputs.at(Stage::Middle));
    let k4 = f(&moved(&x, &k3, h), inputs.at(Stage::End));
    let sixth = h * (1.0 / 6.0);
    for i in 0..N_STATE {
        let slope = k1[i] + (k2[i] + k3[i]) * 2.0 + k4[i];
        values[i] = (x[i] + slope * sixth).to_array();
    }
    for (lane, run) in running.iter_mut().enumerate() {
        run.time_s += run.step_s;
        run.state = values.map(|values| values[lane]);
    }
}

/// Speed of the CG and of a point that turns with the vehicle, m/s.
fn speed_m_s(x: &VehicleState<f64>) -> f64 {
    x.vx_body_m_s.hypot(x.vy_body_m_s) + YAW_ARM_M * x.yaw_rate_rad_s.abs()
}

#[inline(always)]
fn moved<S: Simd>(
    x: &[Packed<S>; N_STATE],
    slope: &[Packed<S>; N_STATE],
    h: Packed<S>,
) -> [Packed<S>; N_STATE] {
    let mut to = *x;
    for (to, slope) in to.iter_mut().zip(slope) {
        *to += *slope * h;
    }
    to
}

#[cfg(test)]
#[path = "path_batch_tests.rs"]
mod tests;
