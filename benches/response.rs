//! Measures how fast the shipped response network predicts: the paths of its components, a forecast of 4 s,
//! and the motions under one force that it consists of. The model has three components, and the car spins.
//!
//! `cargo bench --bench response`

use std::ops::ControlFlow;
use std::path::Path;

use divan::Bencher;
use divan::counter::ItemsCount;
use impactlab_core::data::Outcome;
use impactlab_core::vehicle::VehicleInput;
use impactlab_networks::learning::ModelFile;
use impactlab_networks::response::{
    LEAST_MOTIONS, Predictor, RESISTANCE_SCATTER, ResponseCase, ResponseModel, RestSearch,
};

/// Number of steps in 4 s.
const N_STEPS: usize = 400;

fn main() {
    divan::main();
}

/// Returns the predictor of the shipped model and the first shipped trajectory in which the car
/// spins. The record is extended to 4 s, during which the car rolls freely without a force.
fn spinning() -> (Predictor, ResponseCase) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut report = |_| ControlFlow::Continue(());
    let data = root.join("datasets/trajectories-fea");
    let Outcome::Complete(cases) =
        ResponseCase::load_all(&data, None, &mut report).expect("the shipped data set can be read")
    else {
        panic!("nobody cancels");
    };
    let mut case = cases.into_iter().find(|case| case.spins).expect("some cars spin");
    case.inputs.resize(N_STEPS, VehicleInput::released());
    let model = ResponseModel::load(&root.join("assets/models/response.safetensors"))
        .expect("the shipped model");
    let predictor = model.predictor(&case.vehicle).expect("a vehicle in range");
    assert_eq!(predictor.n_components(), 3);
    (predictor, case)
}

/// Computes the paths of all components without their distribution. The items counted are steps of
/// one path.
#[divan::bench]
fn path_steps(bencher: Bencher<'_, '_>) {
    let (predictor, case) = spinning();
    bencher
        .counter(ItemsCount::new(predictor.n_components() * N_STEPS))
        .bench_local(|| predictor.paths(&case.states[0], &case.inputs));
}

/// Computes the distribution of a motion of 4 s, of 240 whole motions. The items counted are steps of all
/// motions together.
#[divan::bench(sample_count = 10)]
fn forecast_of_4_s(bencher: Bencher<'_, '_>) {
    let (predictor, case) = spinning();
    bencher
        .counter(ItemsCount::new(LEAST_MOTIONS * N_STEPS))
        .bench_local(|| predictor.forecast(&case.states[0], &case.inputs));
}

/// Computes motions of 4 s under one force: those of the components, and draws.
///
/// - `n_draws`: 1 where a forecast draws many forces and vehicles, 8 where it draws 30.
#[divan::bench(args = [1, 8])]
fn motions_of_4_s(bencher: Bencher<'_, '_>, n_draws: usize) {
    let (predictor, case) = spinning();
    let search = RestSearch { seed: 1, resistance_scatter: RESISTANCE_SCATTER };
    let draws: Vec<usize> = (0..n_draws).collect();
    bencher
        .counter(ItemsCount::new(N_STEPS))
        .bench_local(|| predictor.settled(&case.states[0], &case.inputs, &draws, &search));
}
