//! Measures the speed of the 4DOF vehicle model: one integration step, trajectories one by one and
//! side by side in vector registers, braked and not, and one Jacobian.
//!
//! `cargo bench --bench dynamics`

use std::hint::black_box;
use std::ops::ControlFlow;
use std::path::Path;

use divan::Bencher;
use divan::counter::ItemsCount;
use impactlab_core::compare::recorded_manoeuvre;
use impactlab_core::data::Dataset;
use impactlab_core::numerics::rk4_step;
use impactlab_core::vehicle::{
    Braking, CollisionForce, ContactPoint, Ending, Integrator, LibraryVehicle, Manoeuvre, Preset,
    SimulationRun, VehicleInput, VehicleParameters, VehicleState, simulate_batch,
};
use rayon::prelude::*;

/// Number of trajectories that are simulated in parallel.
const N_TRAJECTORIES: usize = 1000;

/// Number of trajectories on one core.
const N_ON_ONE_CORE: usize = 64;

/// Number of RK4 steps in a trajectory of 4 s.
const N_STEPS: usize = 4000;

fn main() {
    divan::main();
}

/// Returns the state and the input of a car at 20 m/s while a force acts on its right rear quarter.
fn hit() -> (VehicleState<f64>, VehicleInput<f64>) {
    let state = VehicleState {
        vy_body_m_s: 0.5,
        yaw_rate_rad_s: -0.3,
        roll_rad: 0.02,
        ..VehicleState::driving_straight(20.0)
    };
    let input = VehicleInput {
        collision: Some(CollisionForce {
            force_n: [8e3, 4e4],
            in_world_axes: true,
            yaw_moment_n_m: None,
            contact: ContactPoint { x_body_m: -1.5, y_body_m: -0.9, height_m: 0.52 },
        }),
        ..VehicleInput::released()
    };
    (state, input)
}

/// Returns the recorded initial states and forces of the shipped trajectories, repeated up to
/// [`N_TRAJECTORIES`].
fn manoeuvres() -> Vec<Manoeuvre> {
    let mut report = |_| ControlFlow::Continue(());
    let dataset = Dataset::load(Path::new("datasets/trajectories-fea"), &mut report)
        .expect("the shipped data set can be read")
        .complete()
        .expect("nobody cancels");
    let cases = dataset.cases.iter().cycle().take(N_TRAJECTORIES);
    let vehicle = Preset::Reference.parameters();
    let recorded = |case| recorded_manoeuvre(case, &vehicle);
    cases.map(|case| recorded(case).expect("the shipped cases are complete")).collect()
}

/// Cars of the library, which differ in every parameter, with the recorded manoeuvres.
fn cars() -> Vec<(VehicleParameters, Manoeuvre)> {
    let cars = LibraryVehicle::ALL.iter().cycle().map(|car| car.parameters());
    cars.zip(manoeuvres().into_iter().take(N_ON_ONE_CORE)).collect()
}

/// The same, braked until they stand.
fn braked_cars() -> Vec<(VehicleParameters, Manoeuvre)> {
    let brake = Some(Braking::new(0.5, 0.6, 0.3));
    let braked = |(vehicle, manoeuvre): (VehicleParameters, Manoeuvre)| {
        let controls = Ending { brake, ..Ending::default() }.controls(&vehicle);
        (vehicle, Manoeuvre { controls, duration_s: 20.0, ends_at_rest: true, ..manoeuvre })
    };
    cars().into_iter().map(braked).collect()
}

/// Measures motions on one core. The items counted are RK4 steps.
///
/// - `is_side_by_side`: whether they go side by side, or one after the other.
fn on_one_core(
    bencher: Bencher<'_, '_>,
    motions: &[(VehicleParameters, Manoeuvre)],
    is_side_by_side: bool,
) {
    let runs: Vec<SimulationRun<'_>> =
        motions.iter().map(|(vehicle, manoeuvre)| SimulationRun { vehicle, manoeuvre }).collect();
    let n_intervals: usize = simulate_batch(&runs)
        .into_iter()
        .map(|motion| motion.expect("the motions are finite").series.n_samples() - 1)
        .sum();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    bencher.counter(ItemsCount::new(10 * n_intervals)).bench_local(|| {
        pool.install(|| match is_side_by_side {
            true => simulate_batch(black_box(&runs)).len(),
            false => {
                let simulate =
                    |run: &SimulationRun<'_>| run.vehicle.simulate(run.manoeuvre, Integrator::Rk4);
                runs.iter().filter(|run| simulate(run).is_ok()).count()
            }
        })
    });
}

/// Different cars on one core, one after the other and side by side.
#[divan::bench(args = [false, true], sample_count = 20)]
fn cars_on_one_core(bencher: Bencher<'_, '_>, is_side_by_side: bool) {
    on_one_core(bencher, &cars(), is_side_by_side);
}

/// Different cars that brake until they stand, one after the other and side by side.
#[divan::bench(args = [false, true], sample_count = 20)]
fn braked_cars_on_one_core(bencher: Bencher<'_, '_>, is_side_by_side: bool) {
    on_one_core(bencher, &braked_cars(), is_side_by_side);
}

#[divan::bench]
fn rk4_step_with_contact(bencher: Bencher<'_, '_>) {
    let vehicle = Preset::Reference.parameters();
    let (state, input) = hit();
    let x = state.to_array();
    bencher.counter(ItemsCount::new(1_usize)).bench_local(|| {
        let f = |_, x: &[f64; 8]| {
            let state = VehicleState::from_array(*x);
            vehicle.evaluate(&state, &input).derivative.to_array()
        };
        rk4_step(f, black_box(&x), 1e-3)
    });
}

#[divan::bench]
fn jacobian(bencher: Bencher<'_, '_>) {
    let vehicle = Preset::Reference.parameters();
    let (state, input) = hit();
    bencher
        .counter(ItemsCount::new(1_usize))
        .bench_local(|| vehicle.jacobian(black_box(&state), black_box(&input)));
}

/// The items counted are RK4 steps.
#[divan::bench]
fn trajectory_of_4_s(bencher: Bencher<'_, '_>) {
    let vehicle = Preset::Reference.parameters();
    let manoeuvre = &manoeuvres()[0];
    bencher
        .counter(ItemsCount::new(N_STEPS))
        .bench_local(|| vehicle.simulate(black_box(manoeuvre), Integrator::Rk4));
}

/// The items counted are trajectories of 4 s.
#[divan::bench(sample_count = 10)]
fn thousand_trajectories_in_parallel(bencher: Bencher<'_, '_>) {
    let vehicle = Preset::Reference.parameters();
    let manoeuvres = manoeuvres();
    bencher.counter(ItemsCount::new(N_TRAJECTORIES)).bench_local(|| {
        let simulate = |manoeuvre| vehicle.simulate(manoeuvre, Integrator::Rk4).is_ok();
        let n_done = manoeuvres.par_iter().map(simulate).filter(|ok| *ok).count();
        assert_eq!(n_done, N_TRAJECTORIES);
        n_done
    });
}

/// The items counted are trajectories of 4 s.
#[divan::bench(sample_count = 10)]
fn thousand_trajectories_side_by_side(bencher: Bencher<'_, '_>) {
    let vehicle = Preset::Reference.parameters();
    let manoeuvres = manoeuvres();
    let runs: Vec<SimulationRun<'_>> =
        manoeuvres.iter().map(|manoeuvre| SimulationRun { vehicle: &vehicle, manoeuvre }).collect();
    bencher.counter(ItemsCount::new(N_TRAJECTORIES)).bench_local(|| {
        let n_done = simulate_batch(&runs).iter().filter(|motion| motion.is_ok()).count();
        assert_eq!(n_done, N_TRAJECTORIES);
        n_done
    });
}
