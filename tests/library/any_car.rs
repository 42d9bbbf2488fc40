//! Cars that the shipped response network has not learned from, and inputs far from what it knows.

use std::ops::ControlFlow;
use std::path::Path;

use impactlab::data::{Existing, Outcome};
use impactlab::learning::{LearningError, ModelFile, TEST_SHARE, TrainingReport, TrainingSet};
use impactlab::response::{
    ResponseCase, ResponseConfig, ResponseModel, ResponseTrainSettings, STEP_S, average_error_m,
    condition, fine_tune, rollout, train_fleet,
};
use impactlab::shipped::ModelSource;
use impactlab::vehicle::sheet::{SheetQuantity, VehicleClass};
use impactlab::vehicle::{
    CollisionForce, ContactPoint, DataSheet, Preset, VehicleInput, VehicleParameters, VehicleState,
};
use proptest::prelude::*;

fn shipped() -> ResponseModel {
    ModelSource::Shipped.response_model().expect("the shipped network")
}

fn load(folder: &str) -> Vec<ResponseCase> {
    let mut go_on = |_| ControlFlow::Continue(());
    match ResponseCase::load_all(Path::new(folder), None, &mut go_on).expect("a data set") {
        Outcome::Complete(cases) => cases,
        Outcome::Cancelled => panic!("nothing cancels"),
    }
}

/// A push of a tenth of a second at the rear quarter.
fn struck(
    delta_v_m_s: [f64; 2],
    vehicle: &VehicleParameters,
    n_steps: usize,
) -> Vec<VehicleInput<f64>> {
    let n_struck = 10;
    let force_n = delta_v_m_s.map(|dv| dv * vehicle.mass.mass_kg / (n_struck as f64 * STEP_S));
    let contact = ContactPoint {
        x_m: -vehicle.geometry.cg_to_rear_axle_m,
        y_m: -vehicle.geometry.outer_width_m / 2.0,
        height_m: 0.5,
    };
    let collision = CollisionForce { force_n, in_world_axes: false, yaw_moment_n_m: None, contact };
    let input = |i| VehicleInput {
        collision: (i < n_struck).then_some(collision),
        ..VehicleInput::released()
    };
    (0..n_steps).map(input).collect()
}

fn car(mass_kg: f64, friction: f64) -> VehicleParameters {
    DataSheet::new("drawn", VehicleClass::Any)
        .with(SheetQuantity::Mass, mass_kg)
        .vehicle()
        .with_friction(friction)
}

/// Area of the standard ellipse of the position at the end, m², and the mean end.
fn end(
    model: &ResponseModel,
    (vehicle, initial, inputs): (&VehicleParameters, &VehicleState<f64>, &[VehicleInput<f64>]),
) -> (f64, VehicleState<f64>) {
    let motion = model.predictor(vehicle).expect("a predictor").motion(initial, inputs);
    let covariance = motion.covariance(inputs.len());
    let area = covariance[(0, 0)] * covariance[(1, 1)] - covariance[(0, 1)].powi(2);
    (area.max(0.0).sqrt(), motion.mean(inputs.len()))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn nothing_within_the_ranges_diverges_or_is_answered_without_a_word(
        mass_kg in 700.0..4000.0_f64, speed_m_s in 0.0..70.0_f64, friction in 0.05..1.2_f64,
        push in prop::array::uniform2(-8.0..8.0_f64), yaw_rate_rad_s in -1.0..1.0_f64,
    ) {
        let model = shipped();
        let vehicle = car(mass_kg, friction);
        let initial = VehicleState { yaw_rate_rad_s, ..VehicleState::driving_straight(speed_m_s) };
        let inputs = struck(push, &vehicle, 200);
        let predictor = model.predictor(&vehicle).expect("a predictor");
        let (area, mean) = end(&model, (&vehicle, &initial, &inputs));
        prop_assert!(area.is_finite() && area > 0.0, "{area}");
        prop_assert!(mean.to_array().iter().all(|value| value.is_finite()), "{mean:?}");
        let path = predictor.central_path(&initial, &inputs);
        // After the force nothing gains energy.
        let energy = |x: &VehicleState<f64>| {
            let mass = &vehicle.mass;
            mass.mass_kg * (x.vx_m_s.powi(2) + x.vy_m_s.powi(2))
                + mass.yaw_inertia_kg_m2 * x.yaw_rate_rad_s.powi(2)
        };
        for pair in path[12..].windows(2) {
            prop_assert!(energy(&pair[1]) <= energy(&pair[0]) * (1.0 + 1e-9) + 1e-6);
        }
        let of = predictor.applicability(&initial, &inputs);
        prop_assert_eq!(of.value < 1.0, !of.outside.is_empty());
        let is_slick = friction < 0.25;
        let is_named = |name: &str| of.outside.iter().any(|outside| outside.quantity == name);
        prop_assert!(!is_slick || is_named("friction"), "{of:?}");
        prop_assert!(speed_m_s < 40.0 || is_named("speed [m/s]"), "{of:?}");
        prop_assert!(mass_kg < 3000.0 || is_named("mass [kg]"), "{of:?}");
    }
}

#[test]
fn far_outside_only_the_physics_is_left_and_the_bands_are_wider() {
    let model = shipped();
    let initial = VehicleState::driving_straight(20.0);
    let known = car(1500.0, 0.7);
    let slick = car(1500.0, 0.05);
    let [near, far] = [&known, &slick].map(|vehicle| {
        let inputs = struck([0.5, 2.0], vehicle, 300);
        let (area, _) = end(&model, (vehicle, &initial, &inputs));
        let path = model.predictor(vehicle).unwrap().central_path(&initial, &inputs);
        let physics = rollout(vehicle, initial, &inputs, |_, _| [0.0; 4]);
        (area, average_error_m(&path, &physics))
    });
    assert!(far.1 < 0.1, "{} m from the 4DOF model", far.1);
    assert!(near.1 > 0.2, "{} m from the 4DOF model", near.1);
    // On ice the tyres hardly matter; of a heavy car nothing is known of them.
    let of = |mass_kg: f64| {
        let vehicle = car(mass_kg, 0.7);
        let inputs = struck([0.5, 2.0], &vehicle, 300);
        end(&model, (&vehicle, &initial, &inputs)).0
    };
    assert!(of(4000.0) > of(2000.0), "{} {}", of(4000.0), of(2000.0));
}

#[test]
fn trajectories_of_a_car_narrow_its_bands_and_leave_other_cars_alone() {
    let model = shipped();
    let cases = load("datasets/trajectories-fleet/van");
    // As another car, of which the network knows nothing.
    let cases: Vec<ResponseCase> = cases
        .into_iter()
        .map(|mut case| {
            case.vehicle.mass.yaw_inertia_kg_m2 *= 1.001;
            case.digest = format!("other {}", case.digest);
            case
        })
        .collect();
    let set = TrainingSet::of_split("van".to_owned(), &cases, 0, TEST_SHARE);
    let set = set.choose(Some(3), 0).expect("three trajectories");
    let told = condition(&model, &set).expect("a conditioned network");
    let known = told.known_car(&cases[0].vehicle).expect("a known car");
    assert_eq!(known.n_trajectories, 3);
    let unseen = cases.iter().find(|case| !told.is_trained_on(case)).expect("another trajectory");
    let n = unseen.inputs.len().min(300);
    let ask = |model: &ResponseModel| {
        end(model, (&unseen.vehicle, &unseen.states[0], &unseen.inputs[..n])).0
    };
    assert!(ask(&told) < ask(&model), "{} {}", ask(&told), ask(&model));
    let other = car(1500.0, 0.7);
    let inputs = struck([0.5, 2.0], &other, 100);
    let initial = VehicleState::driving_straight(20.0);
    let of = |model: &ResponseModel| end(model, (&other, &initial, &inputs));
    assert_eq!(of(&told), of(&model));
    // The same trajectories say nothing twice.
    let again = condition(&told, &set).unwrap_err();
    assert!(matches!(again, LearningError::NothingNew), "{again}");
}

/// Motions of a car whose tyres grip less than its data sheet says.
fn slippery_car(mass_kg: f64, grip: f64) -> Vec<ResponseCase> {
    let vehicle = car(mass_kg, 0.8);
    let mut truth = vehicle.clone();
    truth.tires.friction *= grip;
    let motion = |yaw_rate_rad_s: f64| {
        let initial = VehicleState { yaw_rate_rad_s, ..VehicleState::driving_straight(20.0) };
        let inputs = struck([0.0, 2.5], &vehicle, 200);
        let states = rollout(&truth, initial, &inputs, |_, _| [0.0; 4]);
        ResponseCase::of_motion(yaw_rate_rad_s.to_string(), vehicle.clone(), states, inputs)
    };
    [0.3, -0.6, 0.9].map(motion).into()
}

/// Motions of four cars whose tyres grip less than their data sheets say, each by a share of its own.
fn small_fleet() -> TrainingSet<ResponseCase> {
    let cars = [(1200.0, 0.95), (1400.0, 0.9), (1600.0, 0.85), (1800.0, 0.8)];
    let train = cars.into_iter().flat_map(|(mass_kg, grip)| slippery_car(mass_kg, grip)).collect();
    TrainingSet { name: "made".to_owned(), train, test: Vec::new() }
}

#[test]
fn a_fleet_is_learned_from_saved_and_read_again() {
    let mut config = ResponseConfig::default();
    config.network.components = 2;
    config.single_steps.epochs = 2;
    config.rollouts.lengths = vec![5];
    config.rollouts.epochs = 1;
    config.calibration.folds = 0;
    let settings = ResponseTrainSettings { config, seed: 3, checkpoint: None, resume: false };
    let set = small_fleet();
    let mut trainings = Vec::new();
    let mut go_on = |told: &TrainingReport| {
        if let TrainingReport::Epoch(epoch) = told {
            trainings.push([epoch.training_idx, epoch.n_trainings]);
        }
        ControlFlow::Continue(())
    };
    let start = fine_tune(None, &set, &settings, &mut go_on).expect("a start");
    trainings.clear();
    let mut go_on = |told: &TrainingReport| {
        if let TrainingReport::Epoch(epoch) = told {
            trainings.push([epoch.training_idx, epoch.n_trainings]);
        }
        ControlFlow::Continue(())
    };
    let model = train_fleet(&start, &set, &settings, &mut go_on).expect("a model");
    trainings.dedup();
    assert_eq!(trainings, [[0, 5], [1, 5], [2, 5], [3, 5], [4, 5]]);
    let population = model.population().expect("how cars differ");
    assert_eq!(population.cars().len(), 4);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("any_car");
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("fleet.safetensors");
    model.save(&path, Existing::Replace).expect("saved");
    let again = ResponseModel::load(&path).expect("loaded");
    assert_eq!(again.population(), model.population());
    let case = &set.train[0];
    let of = |model: &ResponseModel| end(model, (&case.vehicle, &case.states[0], &case.inputs));
    assert_eq!(of(&again), of(&model));
    // A car that is like them is better predicted than by its data sheet, and better still once two
    // of its motions are known.
    let fifth = slippery_car(1500.0, 0.84);
    let error_m = |model: &ResponseModel| {
        let predictor = model.predictor(&fifth[2].vehicle).expect("a predictor");
        average_error_m(
            &predictor.central_path(&fifth[2].states[0], &fifth[2].inputs),
            &fifth[2].states,
        )
    };
    let physics = rollout(&fifth[2].vehicle, fifth[2].states[0], &fifth[2].inputs, |_, _| [0.0; 4]);
    let physics_m = average_error_m(&physics, &fifth[2].states);
    let two = TrainingSet { train: fifth[..2].to_vec(), ..set.clone() };
    let told = condition(&model, &two).expect("a conditioned model");
    let (unseen_m, told_m) = (error_m(&model), error_m(&told));
    assert!(unseen_m < 0.6 * physics_m, "{unseen_m} m, by the data sheet {physics_m} m");
    assert!(told_m < 0.8 * unseen_m, "{told_m} m, before {unseen_m} m");
    // One car is no fleet, and a network of one car cannot be told of another.
    let of_one = TrainingSet { train: set.train[..3].to_vec(), ..set.clone() };
    let mut go_on = |_: &TrainingReport| ControlFlow::Continue(());
    assert!(matches!(
        train_fleet(&start, &of_one, &settings, &mut go_on),
        Err(LearningError::TooFewCases { .. })
    ));
    assert!(matches!(condition(&start, &set), Err(LearningError::NoPopulation)));
}

#[test]
fn a_network_of_one_car_fades_for_others() {
    let mut config = ResponseConfig::default();
    config.single_steps.epochs = 2;
    config.rollouts.lengths.clear();
    config.calibration.folds = 0;
    let settings = ResponseTrainSettings { config, seed: 3, checkpoint: None, resume: false };
    let fleet = small_fleet();
    let set = TrainingSet { train: fleet.train[..3].to_vec(), ..fleet };
    let mut go_on = |_: &TrainingReport| ControlFlow::Continue(());
    let model = fine_tune(None, &set, &settings, &mut go_on).expect("a model");
    let case = &set.train[0];
    let own = model.predictor(&case.vehicle).expect("a predictor");
    assert_eq!(own.applicability(&case.states[0], &case.inputs).value, 1.0);
    let other = Preset::Reference.parameters().with_mass(3000.0, None);
    let of = model.predictor(&other).expect("a predictor");
    let of = of.applicability(&case.states[0], &case.inputs);
    assert!(of.value < 0.1 && of.outside.iter().any(|of| of.quantity == "mass [kg]"), "{of:?}");
}
