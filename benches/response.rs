//! Measures how fast the shipped response network predicts on one core: the paths of its
//! components, one step of the joint distribution, and the distribution of a motion of 4 s. The
//! model has three components, and the car spins.
//!
//! `cargo bench --bench response`

use std::ops::ControlFlow;
use std::path::Path;

use divan::Bencher;
use divan::counter::ItemsCount;
use impactlab_core::data::Outcome;
use impactlab_core::vehicle::VehicleInput;
use impactlab_networks::learning::ModelFile;
use impactlab_networks::response::{Predictor, ResponseCase, ResponseModel};

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

/// Computes one step of the distribution of all components.
///
/// - `is_struck`: whether the contact force acts during the step.
#[divan::bench(args = [true, false])]
fn full_step(bencher: Bencher<'_, '_>, is_struck: bool) {
    let (predictor, case) = spinning();
    let acts = |input: &&VehicleInput<f64>| input.collision.is_some() == is_struck;
    let input = *case.inputs.iter().find(acts).expect("a force that ends");
    bencher.bench_local(|| predictor.motion(&case.states[0], &[input]));
}

/// Computes the distribution of a motion of 4 s. The items counted are steps of all components
/// together.
#[divan::bench]
fn motion_of_4_s(bencher: Bencher<'_, '_>) {
    let (predictor, case) = spinning();
    bencher
        .counter(ItemsCount::new(N_STEPS))
        .bench_local(|| predictor.motion(&case.states[0], &case.inputs));
}
