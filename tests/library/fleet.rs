//! Trainings of a response network on the cars of a fleet.

use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::data::Existing;
use impactlab_core::vehicle::{Preset, VehicleState};
use impactlab_networks::learning::{LearningError, ModelFile, TrainingReport, TrainingSet};
use impactlab_networks::response::{
    ResponseCase, ResponseConfig, ResponseModel, ResponseTrainSettings, average_error_m, condition,
    fine_tune, recalibrate, rollout, train_fleet,
};

use crate::any_car::{car, end, struck};

/// Motions of a car whose tires grip less than its data sheet says.
fn slippery_car(mass_kg: f64, grip: f64) -> Vec<ResponseCase> {
    let vehicle = car(mass_kg, 0.8);
    let mut truth = vehicle.clone();
    truth.tires.friction *= grip;
    let motion = |yaw_rate_rad_s: f64| {
        let initial = VehicleState { yaw_rate_rad_s, ..VehicleState::driving_straight(20.0) };
        let inputs = struck([0.0, 2.5], &vehicle, 200);
        let states = rollout(&truth, initial, &inputs, [0.0; 4]);
        ResponseCase::from_motion(yaw_rate_rad_s.to_string(), vehicle.clone(), states, inputs)
    };
    [0.3, -0.6, 0.9].map(motion).into()
}

/// Motions of four cars whose tires grip less than their data sheets say, each by a share of its own.
fn small_fleet() -> TrainingSet<ResponseCase> {
    let cars = [(1200.0, 0.95), (1400.0, 0.9), (1600.0, 0.85), (1800.0, 0.8)];
    let train = cars.into_iter().flat_map(|(mass_kg, grip)| slippery_car(mass_kg, grip)).collect();
    TrainingSet { name: "made".to_owned(), train, test: Vec::new() }
}

/// Widths are calibrated on what a model has learned from, and nothing else of it changes.
fn check_calibrated_anew(model: &ResponseModel, learned: &[ResponseCase], new: &[ResponseCase]) {
    let mut anew = model.copied().expect("a copy");
    let error = recalibrate(&mut anew, new, &mut |_| ControlFlow::Continue(()))
        .expect_err("it has not learned from these");
    assert!(matches!(error, LearningError::TooFewCases { .. }), "{error}");
    assert_eq!(anew.population(), model.population());
    recalibrate(&mut anew, learned, &mut |_| ControlFlow::Break(())).expect("broken off");
    assert_eq!(anew.population(), model.population());
    recalibrate(&mut anew, learned, &mut |_| ControlFlow::Continue(())).expect("calibrated");
    let [before, after] = [model, &anew].map(|model| model.population().expect("how cars differ"));
    assert!(after.widths().widening > 0.0 && after.widths().tail_ratio >= 1.0);
    assert_eq!(after.cars().len(), before.cars().len());
    for (after_car, before_car) in after.cars().iter().zip(before.cars()) {
        assert_eq!(after_car.strengths.widths, after.widths());
        assert_eq!(after_car.strengths.mean, before_car.strengths.mean);
        assert_eq!(after_car.strengths.covariance, before_car.strengths.covariance);
    }
}

/// A model is the same once it is saved and read again.
fn check_saved(model: &ResponseModel, case: &ResponseCase) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fleet");
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("fleet.safetensors");
    model.save(&path, Existing::Replace).expect("saved");
    let again = ResponseModel::load(&path).expect("loaded");
    assert_eq!(again.population(), model.population());
    let of = |model: &ResponseModel| end(model, (&case.vehicle, &case.states[0], &case.inputs));
    assert_eq!(of(&again), of(model));
}

/// Broken off after an epoch of any of the trainings, it is the network of the epoch under way.
fn check_broken_off(
    start: &ResponseModel,
    set: &TrainingSet<ResponseCase>,
    settings: &ResponseTrainSettings,
) {
    let mut cut = |_: &TrainingReport| ControlFlow::Break(());
    let ended = train_fleet(start, set, settings, &mut cut).expect("a model");
    assert_eq!(ended.record().history.len(), start.record().history.len() + 1);
    assert!(ended.population().is_none());
}

/// Broken off in any of the fits after the epochs, it is the network of the last epoch, which knows one kind of
/// car. The network is a small one, since nobody looks at what it has learned.
fn check_broken_off_in_a_fit(set: &TrainingSet<ResponseCase>, settings: &ResponseTrainSettings) {
    let mut settings = settings.clone();
    let network = &mut settings.config.network;
    (network.encoder, network.trunk) = (vec![8], vec![8]);
    (network.token_encoder, network.attention_heads) = ([4; 3], 2);
    let mut go_on = |_: &TrainingReport| ControlFlow::Continue(());
    let start = fine_tune(None, set, &settings, &mut go_on).expect("a start");
    let cut_after = |n_before: usize| {
        let mut n_fits = 0;
        let mut cut = |progress: &TrainingReport| match progress {
            TrainingReport::Fit(_) if n_fits == n_before => ControlFlow::Break(()),
            TrainingReport::Fit(_) => {
                n_fits += 1;
                ControlFlow::Continue(())
            }
            TrainingReport::Epoch(_) => ControlFlow::Continue(()),
        };
        let ended = train_fleet(&start, set, &settings, &mut cut).expect("a model");
        (n_fits, ended.population().is_some())
    };
    let (n_fits, knows_cars) = cut_after(usize::MAX);
    assert!(n_fits > 25 && knows_cars, "{n_fits}");
    for n_before in [0, 6, n_fits - 1] {
        assert_eq!(cut_after(n_before), (n_before, false), "of {n_fits}");
    }
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
    let mut go_on = |conditioned: &TrainingReport| {
        if let TrainingReport::Epoch(epoch) = conditioned {
            trainings.push([epoch.training_idx, epoch.n_trainings]);
        }
        ControlFlow::Continue(())
    };
    let start = fine_tune(None, &set, &settings, &mut go_on).expect("a start");
    trainings.clear();
    let (mut fits, mut shares_done) = (Vec::new(), Vec::new());
    let mut go_on = |conditioned: &TrainingReport| {
        match conditioned {
            TrainingReport::Epoch(epoch) => {
                trainings.push([epoch.training_idx, epoch.n_trainings]);
                shares_done.push(epoch.share_done());
            }
            TrainingReport::Fit(fit) => fits.push(fit.clone()),
        }
        ControlFlow::Continue(())
    };
    let model = train_fleet(&start, &set, &settings, &mut go_on).expect("a model");
    // They run side by side.
    trainings.sort_unstable();
    trainings.dedup();
    assert_eq!(trainings, [[0, 5], [1, 5], [2, 5], [3, 5], [4, 5]]);
    assert!(shares_done.is_sorted() && shares_done.last() == Some(&1.0), "{shares_done:?}");
    assert!(fits.iter().all(|fit| fit.is_after_epochs && !fit.what.is_empty()), "{fits:?}");
    assert!(fits.is_sorted_by_key(|fit| fit.done), "{fits:?}");
    let last = fits.last().expect("what is learned after the epochs");
    assert!(fits.len() > 25 && last.done == last.n_steps, "{last:?} of {} reports", fits.len());
    check_broken_off(&start, &set, &settings);
    check_broken_off_in_a_fit(&set, &settings);
    let population = model.population().expect("how cars differ");
    assert_eq!(population.cars().len(), 4);
    check_saved(&model, &set.train[0]);
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
    let physics = rollout(&fifth[2].vehicle, fifth[2].states[0], &fifth[2].inputs, [0.0; 4]);
    let physics_m = average_error_m(&physics, &fifth[2].states);
    let two = TrainingSet { train: fifth[..2].to_vec(), ..set.clone() };
    let conditioned = condition(&model, &two).expect("a conditioned model");
    let (unseen_m, conditioned_m) = (error_m(&model), error_m(&conditioned));
    assert!(unseen_m < 0.6 * physics_m, "{unseen_m} m, by the data sheet {physics_m} m");
    assert!(conditioned_m < 0.8 * unseen_m, "{conditioned_m} m, before {unseen_m} m");
    check_calibrated_anew(&model, &set.train, &fifth);
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
