//! Measures the speed of the 4DOF vehicle model: one integration step, one trajectory, a thousand
//! trajectories in parallel, and one Jacobian.
//!
//! `cargo bench --no-default-features --bench dynamics`

use std::hint::black_box;
use std::ops::ControlFlow;
use std::path::Path;

use divan::Bencher;
use divan::counter::ItemsCount;
use impactlab::compare::recorded_manoeuvre;
use impactlab::data::Dataset;
use impactlab::numerics::rk4_step;
use impactlab::vehicle::{
    CollisionForce, ContactPoint, Integrator, Manoeuvre, Preset, VehicleInput, VehicleState,
};
use rayon::prelude::*;

/// Number of trajectories that are simulated in parallel.
const N_TRAJECTORIES: usize = 1000;

/// Number of RK4 steps in a trajectory of 4 s.
const N_STEPS: usize = 4000;

fn main() {
    divan::main();
}

/// Returns the state and the input of a car at 20 m/s while a force acts on its right rear quarter.
fn hit() -> (VehicleState<f64>, VehicleInput<f64>) {
    let state = VehicleState {
        vy_m_s: 0.5,
        yaw_rate_rad_s: -0.3,
        roll_rad: 0.02,
        ..VehicleState::driving_straight(20.0)
    };
    let input = VehicleInput {
        collision: Some(CollisionForce {
            force_n: [8e3, 4e4],
            in_world_axes: true,
            yaw_moment_n_m: None,
            contact: ContactPoint { x_m: -1.5, y_m: -0.9, height_m: 0.52 },
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
