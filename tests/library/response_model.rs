//! Training, saving and use of the response network with short artificial motions.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use impactlab_core::data::Existing;
use impactlab_core::vehicle::{Preset, VehicleInput, VehicleState};
use impactlab_networks::learning::{LearningError, ModelFile, TrainSettings, TrainingReport};
use impactlab_networks::response::evaluate::{MotionModel, evaluate_motion_model};
use impactlab_networks::response::{
    Correction, ImpactRecord, ResponseCase, ResponseConfig, ResponseModel, ResponseStage,
    ResponseTrainSettings, ResponseTrainingSet, average_error_m, fine_tune, pretrain, rollout,
};

/// Returns the motion of a car with an initial yaw rate, whose tires differ from its data sheet.
fn case(yaw_rate_rad_s: f64) -> ResponseCase {
    let vehicle = Preset::Reference.parameters();
    let mut truth = vehicle.clone();
    truth.tires.rolling_resistance *= 4.0;
    truth.tires.cornering_coefficient_front_per_rad *= 0.8;
    let initial = VehicleState { yaw_rate_rad_s, ..VehicleState::driving_straight(20.0) };
    let inputs = vec![VehicleInput::released(); 200];
    let states = rollout(&truth, initial, &inputs, [0.0; 4]);
    let name = format!("{yaw_rate_rad_s}");
    ResponseCase { digest: name.clone(), name, vehicle, states, inputs, spins: false }
}

fn set() -> ResponseTrainingSet {
    let train = [0.2, -0.5, 0.8, -1.1].map(case).to_vec();
    ResponseTrainingSet { name: "made".to_owned(), train, test: Vec::new() }
}

fn small() -> ResponseConfig {
    let mut config = ResponseConfig::default();
    config.network.components = 2;
    config.pretraining.motions = 6;
    config.pretraining.epochs = 2;
    config.single_steps.epochs = 12;
    config.single_steps.batch_instants = 64;
    config.rollouts.lengths = vec![5, 8];
    config.rollouts.epochs = 3;
    config.calibration.folds = 0;
    config
}

fn settings(config: ResponseConfig) -> ResponseTrainSettings {
    TrainSettings::unsaved(config, 3)
}

fn go_on(_: &TrainingReport) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Returns the average errors of the data sheet's 4DOF model and of the network on a motion that
/// was not used for training, m.
fn errors_m(model: &ResponseModel) -> [f64; 2] {
    let unseen = case(0.6);
    let (start, inputs) = (unseen.states[0], &unseen.inputs);
    let plain = rollout(&unseen.vehicle, start, inputs, [0.0; 4]);
    let path = model.predictor(&unseen.vehicle).expect("a predictor").central_path(&start, inputs);
    [plain, path].map(|path| average_error_m(&path, &unseen.states))
}

fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("response_model");
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(name);
    let _ = std::fs::remove_file(&path);
    path
}

#[test]
fn what_the_data_sheet_lacks_is_learned() {
    let model = fine_tune(None, &set(), &settings(small()), &mut go_on).expect("a model");
    let [before, after] = errors_m(&model);
    assert!(after < 0.2 * before, "{before} m before, {after} m after");
    let stages: Vec<ResponseStage> =
        model.record().history.iter().map(|epoch| epoch.detail.stage).collect();
    assert_eq!(stages.len(), 12 + 2 * 3);
    assert_eq!(stages[11], ResponseStage::SingleSteps);
    assert_eq!(stages[17], ResponseStage::Rollouts { length: 8 });
    assert!(model.is_trained_on(&case(0.2)) && !model.is_trained_on(&case(0.6)));
    let unseen = case(0.6);
    let predictor = model.predictor(&unseen.vehicle).expect("a predictor");
    let paths = predictor.paths(&unseen.states[0], &unseen.inputs);
    let weights: f64 = paths.iter().map(|path| path.weight).sum();
    assert!((weights - 1.0).abs() < 1e-9, "{weights}");
}

#[test]
fn a_saved_model_predicts_the_same_bits() {
    let model = fine_tune(None, &set(), &settings(small()), &mut go_on).expect("a model");
    let path = scratch("saved.safetensors");
    model.save(&path, Existing::Replace).expect("saved");
    let again = ResponseModel::load(&path).expect("loaded");
    assert_eq!(errors_m(&model), errors_m(&again));
    let mut record = model.record().clone();
    // What a clock said is not part of a model.
    record.history.iter_mut().for_each(|epoch| epoch.seconds = None);
    assert_eq!(&record, again.record());
    let mut bytes = std::fs::read(&path).expect("read");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    assert!(matches!(ResponseModel::from_bytes(&bytes), Err(LearningError::Network(_))));
    assert!(ResponseModel::from_bytes(&bytes[..100]).is_err());
}

#[test]
fn a_training_that_was_cut_goes_on_to_the_same_weights() {
    let whole = fine_tune(None, &set(), &settings(small()), &mut go_on).expect("a model");
    // The training is interrupted in the first stage, between two stages, and in the last.
    for cut_at in [7, 12, 16] {
        let checkpoint = scratch(&format!("cut_{cut_at}.training"));
        let mut settings = settings(small());
        settings.checkpoint = Some(checkpoint);
        let mut cut = |progress: &TrainingReport| match progress {
            TrainingReport::Epoch(epoch) if epoch.summary.epoch == cut_at => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        };
        let part = fine_tune(None, &set(), &settings, &mut cut).expect("a model");
        assert_eq!(part.record().history.len(), cut_at);
        settings.resume = true;
        let resumed = fine_tune(None, &set(), &settings, &mut go_on).expect("a model");
        assert_eq!(errors_m(&resumed), errors_m(&whole), "cut after epoch {cut_at}");
        let losses = |model: &ResponseModel| -> Vec<_> {
            model.record().history.iter().map(|epoch| epoch.detail).collect()
        };
        assert_eq!(losses(&resumed), losses(&whole));
        settings.seed = 4;
        let other = fine_tune(None, &set(), &settings, &mut go_on).unwrap_err();
        assert!(other.to_string().ends_with("had another seed"), "{other}");
    }
}

#[test]
fn pre_training_comes_before_and_the_plain_network_learns_without_the_4dof_model() {
    let train = set();
    let records: Vec<ImpactRecord> = train.train.iter().filter_map(ResponseCase::impact).collect();
    for config in [small(), small().plain()] {
        let settings = settings(config);
        let pretrained = pretrain("made", &records, &settings, &mut go_on).expect("a model");
        assert_eq!(pretrained.record().detail.n_simulated, 6);
        assert!(pretrained.record().train.is_empty());
        let model = fine_tune(Some(&pretrained), &train, &settings, &mut go_on).expect("a model");
        assert_eq!(model.record().detail.n_simulated, 6);
        assert_eq!(model.record().history.len(), 2 + 12 + 2 * 3);
        let [before, after] = errors_m(&model);
        match settings.config.network.correction {
            Correction::Whole => assert!(after.is_finite()),
            _ => assert!(after < 0.2 * before, "{before} m before, {after} m after"),
        }
    }
}

#[test]
fn nothing_is_learned_from_nothing() {
    let nothing = ResponseTrainingSet::default();
    let fitted = fine_tune(None, &nothing, &settings(small()), &mut go_on);
    assert!(matches!(fitted, Err(LearningError::TooFewCases { .. })));
    let fitted = pretrain("none", &[], &settings(small()), &mut go_on);
    assert!(matches!(fitted, Err(LearningError::TooFewCases { .. })));
}

/// The shipped model reaches the accuracy that docs/VALIDATION.md states on its test trajectories.
#[test]
fn the_shipped_model_keeps_its_word() {
    let model = ResponseModel::load(Path::new("assets/models/response.safetensors")).unwrap();
    let mut inside = [0.0; 2];
    for (data, most_m) in [("trajectories-fea", 0.23), ("trajectories-pulse", 0.23)] {
        let path = Path::new("datasets").join(data);
        let mut go_on = |_| ControlFlow::Continue(());
        let cases = ResponseCase::load_all(&path, None, &mut go_on).unwrap().complete().unwrap();
        let left_out = &model.record().test;
        let is_left_out = |case: &&ResponseCase| left_out.iter().any(|id| id.digest == case.digest);
        let test: Vec<&ResponseCase> = cases.iter().filter(is_left_out).collect();
        assert_eq!(test.len(), 25, "{data}");
        assert!(test.iter().all(|case| !model.is_trained_on(case)));
        let copy = Box::new(model.copied().unwrap());
        let compared =
            evaluate_motion_model(data, &test, &MotionModel::Network(copy), 150, 0).unwrap();
        let metrics = &compared.models[0].metrics;
        assert!(metrics.average_error_m.mean < most_m, "{data}: {:?}", metrics.average_error_m);
        assert_eq!(metrics.violations, 0);
        let coverage = metrics.coverage.as_ref().unwrap();
        let shares = [coverage.path_90, coverage.end_90];
        // All of 25 ends are held by regions that hold 0.87 or more of them.
        assert!(shares.iter().all(|share| (0.78..=1.0).contains(share)), "{data}: {coverage:?}");
        inside.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share / 2.0);
    }
    // 0.96 and 1.00: cars differ by more than two sets of one car tell, and its regions are too wide, which
    // docs/VALIDATION.md says.
    let [path, ends] = inside;
    assert!((0.87..=0.99).contains(&path) && ends >= 0.87, "{inside:?}");
}
