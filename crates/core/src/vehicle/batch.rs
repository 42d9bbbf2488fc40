//! Simulates many motions side by side, each in a lane of the vector registers of the machine: draws of
//! a vehicle whose data sheet leaves something open, cases of a data set, particles of a
//! reconstruction.
//!
//! Vehicle, forces, steer angle, brakes and end may differ from lane to lane. A motion that ends leaves
//! its lane, and the next one that waits takes it over. Every motion is to the last digit what
//! [`VehicleParameters::simulate`] gives, but where a wheel is braked in one lane and rolls freely in
//! another one: the two ways to its force differ by rounding. Motions with drivers or systems that act on
//! the wheels go beside each other, so that they are always what they are alone.

use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use crate::numerics::{MAX_LANES, Packed, rk4_step};
use crate::vehicle::recorder::Forces;
use crate::vehicle::run::{Run, StepInputs};
use crate::vehicle::{
    CollisionForce, ContactPoint, Equations, Integrator, Manoeuvre, Motion, N_STATE,
    SimulationError, VehicleConstants, VehicleInput, VehicleParameters, VehicleState, WheelEffort,
};

/// A vehicle and its manoeuvre.
#[derive(Debug, Clone, Copy)]
pub struct SimulationRun<'a> {
    /// The vehicle.
    pub vehicle: &'a VehicleParameters,
    /// What it does, and what is done to it.
    pub manoeuvre: &'a Manoeuvre,
}

/// Simulates motions side by side and on all cores, by [`Integrator::Rk4`].
///
/// - returns for each motion, in their order, what [`VehicleParameters::simulate`] returns.
pub fn simulate_batch(runs: &[SimulationRun<'_>]) -> Vec<Result<Motion, SimulationError>> {
    let mut motions: Vec<Numbered<Result<Motion, SimulationError>>> = Vec::new();
    let mut started: Vec<Numbered<Run<'_>>> = Vec::new();
    for (idx, run) in runs.iter().enumerate() {
        match Run::new(run.vehicle, run.manoeuvre, Integrator::Rk4) {
            Ok(run) => started.push(Numbered { idx, item: run }),
            Err(error) => motions.push(Numbered { idx, item: Err(error) }),
        }
    }
    for runs in alike(started) {
        let n_each = runs.len().div_ceil(rayon::current_num_threads()).max(MAX_LANES);
        let mut parts: Vec<Vec<Numbered<Run<'_>>>> = Vec::new();
        for run in runs {
            match parts.last_mut().filter(|part| part.len() < n_each) {
                Some(part) => part.push(run),
                None => parts.push(vec![run]),
            }
        }
        let ended = parts.into_par_iter().map(|runs| pulp::Arch::new().dispatch(Batch { runs }));
        motions.par_extend(ended.flatten_iter());
    }
    motions.sort_by_key(|motion| motion.idx);
    motions.into_iter().map(|motion| motion.item).collect()
}

/// Something that belongs to the motion of a number.
struct Numbered<T> {
    idx: usize,
    item: T,
}

/// Runs that can go side by side: they have the same number of steps, the same form of the equations,
/// the same kind of force, and all or none are on a slope or have drivers or systems that act on the
/// wheels.
fn alike(mut runs: Vec<Numbered<Run<'_>>>) -> Vec<Vec<Numbered<Run<'_>>>> {
    let kind = |run: &Numbered<Run<'_>>| {
        let is_printed = run.item.constants.equations == Equations::Paper;
        let is_controlled = run.item.has_controlled_wheels();
        let is_sloped = run.item.constants.slope_m_s2.is_some();
        (run.item.steps_per_output, is_printed, is_controlled, is_sloped, run.item.kind_of_force())
    };
    runs.sort_by_key(kind);
    let mut groups: Vec<Vec<Numbered<Run<'_>>>> = Vec::new();
    for run in runs {
        match groups
            .last_mut()
            .filter(|group| group.first().is_some_and(|first| kind(first) == kind(&run)))
        {
            Some(group) => group.push(run),
            None => groups.push(vec![run]),
        }
    }
    groups
}

/// Runs that go side by side.
struct Batch<'a> {
    runs: Vec<Numbered<Run<'a>>>,
}

type Ended = Vec<Numbered<Result<Motion, SimulationError>>>;

impl WithSimd for Batch<'_> {
    type Output = Ended;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Ended {
        let mut waiting = self.runs.into_iter();
        let mut batch = Lanes { running: Vec::with_capacity(Packed::<S>::N), ended: Vec::new() };
        let mut constants: Option<VehicleConstants<Packed<S>>> = None;
        loop {
            let n_running = batch.running.len();
            batch.fill(&mut waiting, Packed::<S>::N);
            let Some(last) = batch.running.len().checked_sub(1) else { return batch.ended };
            if batch.running.len() > n_running {
                constants = None;
            }
            let of_lane = |lane: usize| &batch.running[lane.min(last)].item.constants;
            let of_all = constants.unwrap_or_else(|| VehicleConstants::packed(simd, of_lane));
            advance(simd, &of_all, &mut batch.running);
            let forces = forces(simd, &of_all, &batch.running);
            constants = (!batch.record(&forces)).then_some(of_all);
        }
    }
}

/// The runs in the lanes, and those that have left theirs.
struct Lanes<'a> {
    running: Vec<Numbered<Run<'a>>>,
    ended: Ended,
}

impl<'a> Lanes<'a> {
    /// Takes runs that wait into lanes that are free.
    fn fill(&mut self, waiting: &mut impl Iterator<Item = Numbered<Run<'a>>>, n_lanes: usize) {
        while self.running.len() < n_lanes {
            let Some(mut run) = waiting.next() else { return };
            let goes_on = run.item.goes_on();
            self.settle(goes_on, run);
        }
    }

    /// Records the instant at which all runs stand, and says whether one of them has ended.
    fn record(&mut self, forces: &Forces<[f64; MAX_LANES]>) -> bool {
        let n_running = self.running.len();
        for (lane, mut run) in std::mem::take(&mut self.running).into_iter().enumerate() {
            let coming = run.item.coming();
            let goes_on = run.item.record(&coming, &forces.map(|values| values[lane]));
            self.settle(goes_on, run);
        }
        self.running.len() < n_running
    }

    fn settle(&mut self, goes_on: Result<bool, SimulationError>, run: Numbered<Run<'a>>) {
        let Numbered { idx, item: run } = run;
        match goes_on {
            Ok(true) => self.running.push(Numbered { idx, item: run }),
            Ok(false) => self.ended.push(Numbered { idx, item: run.finish() }),
            Err(error) => self.ended.push(Numbered { idx, item: Err(error) }),
        }
    }
}

/// Goes on to the next output instant.
#[inline(always)]
fn advance<S: Simd>(
    simd: S,
    constants: &VehicleConstants<Packed<S>>,
    running: &mut [Numbered<Run<'_>>],
) {
    let Some(Numbered { item: first, .. }) = running.first() else { return };
    let (step_s, n_steps) = (first.step_s, first.steps_per_output);
    let is_acted_on = running.iter().any(|run| run.item.is_acted_on());
    let has_zones = running.iter().any(|run| run.item.has_zones());
    let mut of_lanes = [const { StepInputs::RELEASED }; MAX_LANES];
    let mut inputs = steps_side_by_side(simd, &of_lanes);
    let mut x = states(simd, running);
    for step in 0..n_steps {
        if is_acted_on {
            let now = match has_zones {
                true => x.map(Packed::to_array),
                false => [[0.0; MAX_LANES]; N_STATE],
            };
            for (lane, (of_lane, run)) in of_lanes.iter_mut().zip(running.iter()).enumerate() {
                *of_lane = run.item.inputs_of(step, &now.map(|values| values[lane]));
            }
            inputs = steps_side_by_side(simd, &of_lanes);
        }
        let f = |stage, x: &[Packed<S>; N_STATE]| constants.derivative(x, inputs.at(stage));
        x = rk4_step(f, &x, step_s);
    }
    let mut values = [[0.0; MAX_LANES]; N_STATE];
    for (values, x) in values.iter_mut().zip(x) {
        *values = x.to_array();
    }
    for (lane, run) in running.iter_mut().enumerate() {
        run.item.advanced_to(values.map(|values| values[lane]));
    }
}

/// The equations of motion at the output instant at which the runs stand.
#[inline(always)]
fn forces<S: Simd>(
    simd: S,
    constants: &VehicleConstants<Packed<S>>,
    running: &[Numbered<Run<'_>>],
) -> Forces<[f64; MAX_LANES]> {
    let mut of_lanes = [const { VehicleInput::RELEASED }; MAX_LANES];
    for (of_lane, run) in of_lanes.iter_mut().zip(running) {
        *of_lane = run.item.coming();
    }
    let x = VehicleState::from_array(states(simd, running));
    let now = constants.evaluate(&x, &side_by_side(simd, |lane| &of_lanes[lane]));
    Forces::from(now).map(Packed::to_array)
}

/// The states of the runs; lanes without one stand still.
#[inline(always)]
fn states<S: Simd>(simd: S, running: &[Numbered<Run<'_>>]) -> [Packed<S>; N_STATE] {
    let mut x = [Packed::splat(simd, 0.0); N_STATE];
    for (i, x) in x.iter_mut().enumerate() {
        let mut values = [0.0; MAX_LANES];
        for (value, run) in values.iter_mut().zip(running) {
            *value = run.item.state[i];
        }
        *x = Packed::new(simd, &values);
    }
    x
}

/// The inputs over a step, side by side.
#[inline(always)]
pub(super) fn steps_side_by_side<S: Simd>(
    simd: S,
    of_lanes: &[StepInputs<f64>; MAX_LANES],
) -> StepInputs<Packed<S>> {
    StepInputs {
        instants: [
            side_by_side(simd, |lane| &of_lanes[lane].instants[0]),
            side_by_side(simd, |lane| &of_lanes[lane].instants[1]),
            side_by_side(simd, |lane| &of_lanes[lane].instants[2]),
        ],
    }
}

/// The inputs of all lanes, whose collision forces are of the same kind.
#[expect(clippy::manual_map, reason = "a closure would be compiled without vector instructions")]
#[inline(always)]
fn side_by_side<'a, S: Simd>(
    simd: S,
    input: impl Fn(usize) -> &'a VehicleInput<f64> + Copy,
) -> VehicleInput<Packed<S>> {
    let pack = Pack { simd, input };
    let is_braked = (0..MAX_LANES).any(|lane| input(lane).wheels.is_some());
    let is_on_zones = (0..MAX_LANES).any(|lane| input(lane).friction_share.is_some());
    let struck = (0..MAX_LANES).find_map(|lane| input(lane).collision);
    VehicleInput {
        steer_rad: pack.number(|u| u.steer_rad),
        wheels: match is_braked {
            true => Some([pack.wheel(0), pack.wheel(1), pack.wheel(2), pack.wheel(3)]),
            false => None,
        },
        friction_share: match is_on_zones {
            true => Some([pack.share(0), pack.share(1), pack.share(2), pack.share(3)]),
            false => None,
        },
        collision: match struck {
            Some(kind) => Some(pack.collision(&kind)),
            None => None,
        },
    }
}

/// Puts numbers of the inputs of all lanes side by side.
#[derive(Clone, Copy)]
struct Pack<S, F> {
    simd: S,
    input: F,
}

impl<'a, S: Simd, F: Fn(usize) -> &'a VehicleInput<f64>> Pack<S, F> {
    #[inline(always)]
    fn number(&self, number: impl Fn(&VehicleInput<f64>) -> f64) -> Packed<S> {
        let mut values = [0.0; MAX_LANES];
        for (lane, value) in values[..Packed::<S>::N].iter_mut().enumerate() {
            *value = number((self.input)(lane));
        }
        Packed::new(self.simd, &values)
    }

    #[inline(always)]
    fn wheel(&self, wheel: usize) -> WheelEffort<Packed<S>> {
        let effort = |u: &VehicleInput<f64>| {
            u.wheels.as_ref().map_or(WheelEffort::FREE, |wheels| wheels[wheel])
        };
        WheelEffort {
            drive_n: self.number(|u| effort(u).drive_n),
            braking_n: self.number(|u| effort(u).braking_n),
            locked: self.number(|u| effort(u).locked),
        }
    }

    #[inline(always)]
    fn share(&self, wheel: usize) -> Packed<S> {
        self.number(|u| u.friction_share.map_or(1.0, |shares| shares[wheel]))
    }

    /// - `kind`: the collision force of a lane.
    #[expect(
        clippy::manual_map,
        reason = "a closure would be compiled without vector instructions"
    )]
    #[inline(always)]
    fn collision(&self, kind: &CollisionForce<f64>) -> CollisionForce<Packed<S>> {
        let number = |number: fn(&CollisionForce<f64>) -> f64| {
            move |u: &VehicleInput<f64>| u.collision.as_ref().map_or(0.0, number)
        };
        CollisionForce {
            force_n: [
                self.number(number(|it| it.force_n[0])),
                self.number(number(|it| it.force_n[1])),
            ],
            in_world_axes: kind.in_world_axes,
            yaw_moment_n_m: match kind.yaw_moment_n_m {
                Some(_) => Some(self.number(number(|it| it.yaw_moment_n_m.unwrap_or(0.0)))),
                None => None,
            },
            contact: ContactPoint {
                x_body_m: self.number(number(|it| it.contact.x_body_m)),
                y_body_m: self.number(number(|it| it.contact.y_body_m)),
                height_m: self.number(number(|it| it.contact.height_m)),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{ForceAxes, ForceHistory, Sampling};
    use crate::vehicle::{
        Braking, ContactLoad, DamagedWheel, Ending, FrictionZone, HeldSteer, LibraryVehicle,
        Preset, Wheel,
    };

    fn struck(force_n: [f64; 2], axes: ForceAxes, mz_n_m: Option<f64>) -> ContactLoad {
        let time_s: Vec<f64> = (0..12).map(|i| f64::from(i) * 0.01).collect();
        let shape = |peak: f64| {
            time_s.iter().map(|t| peak * (t / 0.11 * std::f64::consts::PI).sin()).collect()
        };
        let force = ForceHistory {
            axes,
            sampling: Sampling::Instant,
            fx_n: shape(force_n[0]),
            fy_n: shape(force_n[1]),
            mz_n_m: mz_n_m.map(shape),
            time_s: time_s.clone(),
        };
        let contact = ContactPoint { x_body_m: -1.6, y_body_m: -0.8, height_m: 0.5 };
        ContactLoad { force, contact, recorded_moment: mz_n_m.is_some() }
    }

    fn endings() -> [Ending; 5] {
        let brake = Some(Braking::new(0.3, 1.4, 0.2));
        let caught = |drag_share_of_friction| {
            let wheel = Wheel::FrontLeft;
            vec![DamagedWheel { wheel, start_s: 0.1, drag_share_of_friction }]
        };
        let steer = Some(HeldSteer { start_s: 0.2, rise_s: 0.3, road_wheel_rad: 0.1 });
        [
            Ending::default(),
            Ending { brake, ..Ending::default() },
            Ending { damage: caught(None), ..Ending::default() },
            Ending { damage: caught(Some(0.6)), steer, ..Ending::default() },
            Ending { brake, steer, ..Ending::default() },
        ]
    }

    /// No zones, and ice on the right beside and over a strip of gravel across the road.
    fn zones() -> [Vec<FrictionZone>; 3] {
        let zone = |name: &str, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], friction| FrictionZone {
            name: name.to_owned(),
            border_m: vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]],
            friction,
        };
        let ice = zone("ice", [-50.0, -40.0], [80.0, 0.3], 0.08);
        let gravel = zone("gravel", [4.0, -40.0], [9.0, 40.0], 0.55);
        [Vec::new(), vec![ice.clone()], vec![ice, gravel]]
    }

    /// Motions of different cars, on different roads, struck and not, that stand, roll, spin, brake and
    /// slide, on one ground or on several, until they rest or for a time.
    fn motions() -> Vec<(VehicleParameters, Manoeuvre)> {
        let mut cars: Vec<VehicleParameters> =
            Preset::ALL.iter().map(|preset| preset.parameters()).collect();
        cars.extend(LibraryVehicle::ALL.iter().take(5).map(|car| car.parameters()));
        // Its steps are divided.
        let mut stiff = Preset::Reference.parameters();
        stiff.suspension.roll_damping_n_m_s_rad *= 60.0;
        cars.push(stiff);
        cars.push(Preset::Reference.parameters().with_equations(Equations::Paper));
        let endings = endings();
        let zones = zones();
        (0..70)
            .map(|i| {
                let vehicle = cars[i % cars.len()].clone().with_friction(0.3 + 0.01 * i as f64);
                let load = match i % 4 {
                    0 => None,
                    1 => Some(struck([2e4, 6e4], ForceAxes::World, None)),
                    2 => Some(struck([1e4, -5e4], ForceAxes::Body, None)),
                    _ => Some(struck([-1e4, 7e4], ForceAxes::World, Some(-4e4))),
                };
                let is_printed = vehicle.equations == Equations::Paper;
                let manoeuvre = Manoeuvre {
                    initial: VehicleState {
                        vx_body_m_s: if i % 7 == 6 { 0.0 } else { (i % 6) as f64 * 5.0 },
                        vy_body_m_s: if i % 3 == 0 { 0.0 } else { 1.0 },
                        yaw_rate_rad_s: if i % 5 == 4 { 2.5 } else { 0.0 },
                        ..VehicleState::default()
                    },
                    contact_load: load,
                    controls: endings[i % endings.len()].controls(&vehicle),
                    duration_s: if is_printed { 0.3 } else { 1.0 + (i % 9) as f64 * 0.37 },
                    ends_at_rest: i % 2 == 0,
                    friction_zones: zones[i % zones.len()].clone(),
                };
                (vehicle, manoeuvre)
            })
            .collect()
    }

    #[test]
    fn every_motion_is_the_one_by_itself() {
        let motions = motions();
        let runs: Vec<SimulationRun<'_>> = motions
            .iter()
            .map(|(vehicle, manoeuvre)| SimulationRun { vehicle, manoeuvre })
            .collect();
        let mut n_rested = 0;
        for (i, (run, got)) in runs.iter().zip(simulate_batch(&runs)).enumerate() {
            let expected = run.vehicle.simulate(run.manoeuvre, Integrator::Rk4);
            let (got, expected) = match (got, expected) {
                (Ok(got), Ok(expected)) => (got, expected),
                (got, expected) => {
                    assert_eq!(got.err(), expected.err(), "motion {i}");
                    continue;
                }
            };
            n_rested += usize::from(expected.rest_s.is_some());
            assert_eq!(got.series.time_s(), expected.series.time_s(), "motion {i}");
            assert_eq!((&got.flags, got.rest_s), (&expected.flags, expected.rest_s), "motion {i}");
            for channel in expected.series.channels() {
                let [got, expected] =
                    [&got, &expected].map(|motion| motion.series.require(channel).unwrap());
                let size = expected.iter().fold(1e-3, |size: f64, value| size.max(value.abs()));
                let off = got.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(off <= 1e-9 * size, "motion {i}: {channel:?} is off by {off} of {size}");
            }
        }
        assert!(n_rested > 10, "{n_rested} came to rest");
    }

    #[test]
    fn motions_that_coast_are_the_same_to_the_last_digit() {
        let mut motions = motions();
        motions.iter_mut().for_each(|(_, manoeuvre)| manoeuvre.controls.wheels = None);
        let runs: Vec<SimulationRun<'_>> = motions
            .iter()
            .map(|(vehicle, manoeuvre)| SimulationRun { vehicle, manoeuvre })
            .collect();
        for (i, (run, got)) in runs.iter().zip(simulate_batch(&runs)).enumerate() {
            let expected = run.vehicle.simulate(run.manoeuvre, Integrator::Rk4);
            assert!(got == expected, "motion {i}");
        }
    }

    #[test]
    fn what_cannot_be_simulated_spoils_nothing() {
        let good = Preset::Reference.parameters();
        let mut falls_over = good.clone();
        falls_over.suspension.roll_stiffness_n_m_rad = 1.0;
        let initial = VehicleState::driving_straight(20.0);
        let manoeuvre = Manoeuvre { initial, duration_s: 1.0, ..Manoeuvre::default() };
        let endless = Manoeuvre { duration_s: f64::NAN, ..manoeuvre.clone() };
        let lost = VehicleState { vx_body_m_s: f64::INFINITY, ..initial };
        let lost = Manoeuvre { initial: lost, ..manoeuvre.clone() };
        let runs = [
            SimulationRun { vehicle: &good, manoeuvre: &manoeuvre },
            SimulationRun { vehicle: &falls_over, manoeuvre: &manoeuvre },
            SimulationRun { vehicle: &good, manoeuvre: &endless },
            SimulationRun { vehicle: &good, manoeuvre: &lost },
            SimulationRun { vehicle: &good, manoeuvre: &manoeuvre },
        ];
        let motions = simulate_batch(&runs);
        let expected = good.simulate(&manoeuvre, Integrator::Rk4);
        assert!(matches!(motions[1], Err(SimulationError::Vehicle(_))), "{:?}", motions[1]);
        assert!(matches!(motions[2], Err(SimulationError::Duration(_))), "{:?}", motions[2]);
        assert_eq!(motions[3], Err(SimulationError::Diverged { time_s: 0.0 }));
        assert_eq!([&motions[0], &motions[4]], [&expected; 2]);
        assert!(simulate_batch(&[]).is_empty());
    }
}
