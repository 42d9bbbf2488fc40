//! The force network from training to prediction with a tiny network: training, resuming, files,
//! symmetry, and predictions with unknown quantities.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use candle_core::Tensor;
use impactlab_core::data::Existing;
use impactlab_core::error_chain;
use impactlab_core::uncertainty::Caveat;
use impactlab_networks::force::{
    Centre, ForceCase, ForceConfig, ForceModel, ForcePrediction, ForceScenario, ForceTrainSettings,
    ForceTrainingSet, fit_physics, train,
};
use impactlab_networks::learning::{ModelFile, TrainingReport};
use impactlab_networks::nn::{Checkpoint, ModelKind};

const N_CASES: usize = 16;
const EPOCHS: usize = 6;

fn set() -> &'static ForceTrainingSet {
    static SET: OnceLock<ForceTrainingSet> = OnceLock::new();
    SET.get_or_init(|| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/fea");
        let mut go_on = |_| ControlFlow::Continue(());
        let cases = ForceCase::load_all(&root, &mut go_on).expect("the shipped data can be read");
        let cases = cases.complete().expect("nothing cancels");
        ForceTrainingSet::from_split("fea", &cases[..N_CASES], 3, 0.25)
    })
}

fn config() -> ForceConfig {
    let mut config = ForceConfig::default();
    config.network.encoder_branches = vec![[8, 8, 4], [8, 8, 4]];
    config.network.position_channels = 8;
    config.network.attention_channels = 8;
    config.network.attention_heads = 2;
    config.network.attention_stride = 25;
    config.network.trunk = vec![16, 8];
    config.network.factors = 2;
    config.training.epochs = EPOCHS;
    config.training.batch_cases = 4;
    config.training.checkpoint_epochs = 2;
    config.crush.folds = 2;
    config.crush.max_steps = 2;
    config
}

fn settings(checkpoint: Option<PathBuf>) -> ForceTrainSettings {
    ForceTrainSettings { config: config(), seed: 5, checkpoint, resume: true }
}

/// Trains until an epoch is over and stops, as if the training were killed then.
fn train_until(epoch: usize, settings: &ForceTrainSettings) -> ForceModel {
    let model = train(set(), settings, &mut |progress| match progress {
        TrainingReport::Epoch(progress) if progress.summary.epoch == epoch => {
            ControlFlow::Break(())
        }
        _ => ControlFlow::Continue(()),
    });
    model.expect("the training works")
}

fn saved(model: &ForceModel, path: &Path) -> Vec<u8> {
    model.save(path, Existing::Replace).expect("the model can be written");
    fs::read(path).expect("the model can be read")
}

fn model() -> &'static ForceModel {
    static MODEL: OnceLock<ForceModel> = OnceLock::new();
    MODEL.get_or_init(|| train_until(EPOCHS, &settings(None)))
}

/// Returns the losses of each epoch, without the durations, which differ between runs.
fn losses(model: &ForceModel) -> Vec<String> {
    let history = model.record().history.iter();
    history
        .map(|record| {
            format!("{} {:?} {:?}", record.epoch, record.detail.train, record.detail.validation)
        })
        .collect()
}

fn scenario() -> ForceScenario {
    set().train[0].scenario.clone()
}

#[test]
fn the_fits_before_the_epochs_report_every_step() {
    let mut fits = Vec::new();
    let physics = fit_physics(set(), &settings(None), &mut |report| {
        if let TrainingReport::Fit(fit) = report {
            fits.push(fit.clone());
        }
        ControlFlow::Continue(())
    });
    physics.expect("the physics can be fitted");
    // Two laws of two steps each, and three regressions.
    assert!(fits.iter().all(|fit| fit.n_steps == 7 && !fit.is_after_epochs), "{fits:?}");
    assert!(fits.is_sorted_by_key(|fit| fit.done), "{fits:?}");
    let of_first = fits.iter().filter(|fit| fit.what == "fitting crush law 1 of 2");
    assert!(of_first.clone().count() >= 1 && of_first.clone().all(|fit| fit.cost.is_some()));
    let done: Vec<usize> =
        fits.iter().filter(|fit| fit.what.contains("regression")).map(|fit| fit.done).collect();
    assert_eq!(done, [4, 5, 6]);
}

#[test]
fn a_killed_training_goes_on_to_the_same_weights() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoint = folder.path().join("model.training");
    // The training is killed after epoch 3, when the checkpoint is that of epoch 2. Stopping a
    // training saves its last epoch, so that the checkpoint of epoch 2 is put back.
    train_until(2, &settings(Some(checkpoint.clone())));
    let at_2 = fs::read(&checkpoint).unwrap();
    train_until(3, &settings(Some(checkpoint.clone())));
    fs::write(&checkpoint, at_2).unwrap();
    let resumed = train_until(EPOCHS, &settings(Some(checkpoint)));
    assert_eq!(losses(&resumed), losses(model()));
    let prediction = |model: &ForceModel| model.predict(&scenario()).unwrap();
    assert_eq!(prediction(&resumed), prediction(model()), "bit for bit");
}

#[test]
fn a_training_cut_short_in_its_physics_leaves_nothing_to_go_on_from() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoint = folder.path().join("model.training");
    let settings = settings(Some(checkpoint.clone()));
    let model = train(set(), &settings, &mut |_| ControlFlow::Break(())).unwrap();
    assert_eq!(model.record().history.len(), 1, "what there is can be used");
    assert!(!checkpoint.exists());
    train_until(1, &settings);
    assert!(checkpoint.exists());
}

#[test]
fn the_same_seed_gives_the_same_weights_and_another_one_others() {
    let again = train_until(EPOCHS, &settings(None));
    assert_eq!(losses(&again), losses(model()));
    let other = train_until(EPOCHS, &ForceTrainSettings { seed: 6, ..settings(None) });
    assert_ne!(losses(&other), losses(model()));
}

#[test]
fn training_lowers_the_loss() {
    let history = &model().record().history;
    let [first, last] = [&history[0], &history[EPOCHS - 1]].map(|record| record.detail.train.total);
    assert!(last < first, "{first} {last}");
}

#[test]
fn a_checkpoint_of_another_training_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoint = folder.path().join("model.training");
    train_until(1, &settings(Some(checkpoint.clone())));
    let other = ForceTrainSettings { seed: 6, ..settings(Some(checkpoint.clone())) };
    let error = train(set(), &other, &mut |_| ControlFlow::Continue(())).unwrap_err();
    assert_eq!(
        error.to_string(),
        format!("{}: the training to resume had another seed", checkpoint.display())
    );
}

/// A checkpoint of finite numbers whose predictions are not was refused after the last epoch, without
/// its name.
#[test]
fn a_checkpoint_that_predicts_no_distribution_is_refused_with_its_name() {
    const KIND: ModelKind = ModelKind { name: "training of a force network", version: 1 };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.training");
    train_until(1, &settings(Some(path.clone())));
    let untouched = fs::read(&path).unwrap();
    for group in ["best", "parameters"] {
        let mut file = Checkpoint::from_bytes(&untouched, KIND).unwrap();
        let tensors = file.take_group(group).into_iter();
        let huge = |(name, tensor): (String, Tensor)| (name, (tensor * 1e25).unwrap());
        file.put_group(group, tensors.map(huge).collect());
        file.write(&path, Existing::Replace).unwrap();
        let mut n_epochs = 0;
        let progress = train(set(), &settings(Some(path.clone())), &mut |progress| {
            n_epochs += usize::from(matches!(progress, TrainingReport::Epoch(_)));
            ControlFlow::Continue(())
        });
        let error = error_chain(&progress.unwrap_err());
        let expected = format!("{}: cannot be used as a training: ", path.display());
        assert!(error.starts_with(&expected), "{group}: {error}");
        assert!(error.contains("component 0 is NaN"), "{group}: {error}");
        assert_eq!(n_epochs, 0, "{group}: refused before any work");
    }
}

#[test]
fn test_cases_never_reach_the_model() {
    let record = model().record();
    assert_eq!(record.train.len() + record.detail.validation.len() + record.test.len(), N_CASES);
    let learned = model().training_cases();
    assert!(record.test.iter().all(|id| learned.iter().all(|case| case.digest != id.digest)));
}

#[test]
fn a_model_says_the_same_after_a_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.safetensors");
    let bytes = saved(model(), &path);
    let read = ForceModel::load(&path).unwrap();
    assert_eq!(read.predict(&scenario()).unwrap(), model().predict(&scenario()).unwrap());
    let mut record = model().record().clone();
    // What a clock said is not part of a model.
    record.history.iter_mut().for_each(|epoch| epoch.seconds = None);
    assert_eq!(read.record(), &record);
    assert_eq!(saved(&ForceModel::from_bytes(&bytes).unwrap(), &path), bytes);
    assert!(set().train.iter().all(|case| read.is_trained_on(case)));
}

#[test]
fn damaged_models_say_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.safetensors");
    let bytes = saved(model(), &path);
    let error = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        error_chain(&ForceModel::load(&path).unwrap_err())
    };
    let truncated = error(&bytes[..bytes.len() / 2]);
    assert!(truncated.contains("truncated"), "{truncated}");
    let mut flipped = bytes.clone();
    let last = flipped.len() - 5;
    flipped[last] ^= 0x10;
    let flipped = error(&flipped);
    assert!(flipped.contains("checksum"), "{flipped}");
    let text = error(b"mass,velocity\n1,2\n");
    assert!(text.contains("safetensors"), "{text}");
    assert!(error(b"").contains("model.safetensors"));
}

#[test]
fn a_training_is_no_model() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoint = folder.path().join("model.training");
    train_until(1, &settings(Some(checkpoint.clone())));
    let error = error_chain(&ForceModel::load(&checkpoint).unwrap_err());
    assert!(error.contains("training of a force network"), "{error}");
}

#[test]
fn a_mirrored_scenario_has_the_mirrored_force() {
    let right = model().predict(&scenario()).unwrap();
    let left = model().predict(&scenario().mirrored()).unwrap();
    let (right, left) = (right.mixture.mean(), left.mixture.mean());
    assert_eq!(right.fx_n, left.fx_n);
    assert!(right.fy_n.iter().zip(&left.fy_n).all(|(r, l)| r == &-l));
}

#[test]
fn a_common_speed_changes_nothing() {
    let mut faster = scenario();
    faster.struck_velocity_m_s[0] += 8.0;
    faster.striking_velocity_m_s[0] += 8.0;
    assert_eq!(model().predict(&faster).unwrap(), model().predict(&scenario()).unwrap());
}

#[test]
fn what_is_left_open_widens_the_bands() {
    // The spread is summed over the cases, because a single known contact point may be one with a
    // wide distribution.
    let spread = |open: bool| -> f64 {
        let ask = |case: &ForceCase| {
            let known = case.scenario.clone();
            let left_open = ForceScenario {
                contact_m: None,
                striking_body: None,
                struck_body: None,
                ..known.clone()
            };
            let prediction = model().predict(if open { &left_open } else { &known }).unwrap();
            assert_eq!([prediction.is_contact_open, prediction.is_body_open], [open, open]);
            prediction.mixture.std().fy_n.iter().sum::<f64>()
        };
        set().train.iter().map(ask).sum()
    };
    let (open, known) = (spread(true), spread(false));
    assert!(open > known, "{open} {known}");
}

#[test]
fn the_force_vanishes_after_the_contact() {
    let prediction = model().predict(&scenario()).unwrap();
    let std = prediction.mixture.std();
    let mean = prediction.mixture.mean();
    let peak = mean.peak().0;
    assert!(mean.fy_n[249].abs() < 0.05 * peak, "{} of {peak}", mean.fy_n[249]);
    assert!(std.fy_n.iter().all(|std| *std > 0.0));
}

/// The struck cars of every second case are called vans, and pushed back with half as much again.
#[test]
fn the_body_of_the_struck_vehicle_is_learned_and_may_be_open() {
    let mut set = set().clone();
    for (i, case) in set.train.iter_mut().enumerate() {
        let (name, factor) = if i % 2 == 0 { ("saloon", 1.0) } else { ("van", 1.5) };
        case.scenario.struck_body = Some(name.to_owned());
        let curve = &mut case.curve;
        curve.fx_n.iter_mut().chain(&mut curve.fy_n).for_each(|force| *force *= factor);
        case.impulse_n_s = case.impulse_n_s.map(|impulse| factor * impulse);
        case.peak_n *= factor;
    }
    let mut settings = settings(None);
    settings.config.crush.max_steps = 4;
    let trained = train(&set, &settings, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(trained.struck_bodies(), ["saloon", "van"]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bodies.safetensors");
    saved(&trained, &path);
    let model = ForceModel::load(&path).unwrap();
    let named = |name: Option<&str>| {
        let struck_body = name.map(str::to_owned);
        model.predict(&ForceScenario { struck_body, ..scenario() }).unwrap()
    };
    let [saloon, van, open, tank] = [Some("saloon"), Some("van"), None, Some("tank")].map(named);
    let peak = |prediction: &ForcePrediction| prediction.centre.peak().0;
    assert!(peak(&saloon) < peak(&open) && peak(&open) < peak(&van));
    assert!(!van.is_struck_body_open && open.is_struck_body_open && tank.is_struck_body_open);
    assert_eq!(tank.mixture, open.mixture);
    let is_said = |caveat: &Caveat| caveat.text.contains("(saloon, van)");
    assert!(tank.caveats.iter().any(is_said) && !open.caveats.iter().any(is_said));
}

#[test]
fn a_body_that_the_model_does_not_know_is_left_open_and_said() {
    let named = |name: Option<&str>| {
        let striking_body = name.map(str::to_owned);
        model().predict(&ForceScenario { striking_body, ..scenario() }).unwrap()
    };
    let [unknown, open] = [named(Some("tank")), named(None)];
    assert!(unknown.is_body_open && unknown.mixture == open.mixture);
    let said = |prediction: &ForcePrediction| {
        let texts = prediction.caveats.iter().map(|caveat| caveat.text.clone());
        texts.filter(|text| text.contains("\"tank\"") && text.contains("(A, B)")).count()
    };
    assert_eq!([said(&unknown), said(&open)], [1, 0], "{:?}", unknown.caveats);
}

#[test]
fn wrong_questions_are_answered_with_what_is_wrong() {
    let light = ForceScenario { mass_kg: [0.0, 1500.0], ..scenario() };
    let error = model().predict(&light).unwrap_err().to_string();
    assert_eq!(error, "mass of the struck vehicle [kg] is 0, expected 1 to 1e8");
    for nonsense in [f64::NAN, f64::INFINITY, 1e300] {
        let mut broken = scenario();
        broken.striking_velocity_m_s[1] = nonsense;
        assert!(model().predict(&broken).is_err(), "{nonsense}");
    }
}

#[test]
fn every_ablation_trains() {
    let variants: [fn(&mut ForceConfig); 6] = [
        |config| config.network.centre = Centre::None,
        |config| config.network.centre = Centre::Crush,
        |config| config.network.centre = Centre::Momentum,
        |config| config.network.attention = false,
        |config| config.network.factors = 0,
        |config| config.network.components = 1,
    ];
    for change in variants {
        let mut settings = settings(None);
        change(&mut settings.config);
        settings.config.training.epochs = 1;
        let model = train(set(), &settings, &mut |_| ControlFlow::Continue(()))
            .unwrap_or_else(|error| panic!("{error} with {:?}", settings.config.network));
        let impulse = model.predict(&scenario()).unwrap().mixture.impulse(1).mean();
        assert!(impulse.is_finite(), "{:?}", settings.config.network);
    }
}

#[test]
fn the_shipped_model_has_the_default_settings() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/models/force.safetensors");
    let shipped = ForceModel::load(&path).unwrap();
    assert_eq!(shipped.config(), &ForceConfig::default());
}

#[test]
fn the_network_of_the_paper_trains() {
    let paper = ForceConfig::paper();
    let mut settings = settings(None);
    settings.config = ForceConfig { crush: settings.config.crush, ..paper };
    settings.config.network.centre = Centre::Momentum;
    settings.config.training.epochs = 3;
    let model = train(set(), &settings, &mut |_| ControlFlow::Continue(())).unwrap();
    assert!(model.n_parameters() > 600_000, "{}", model.n_parameters());
    let losses: Vec<f64> =
        model.record().history.iter().map(|record| record.detail.train.total).collect();
    assert!(losses[2] < losses[0], "{losses:?}");
    assert!(model.predict(&scenario()).unwrap().mixture.impulse(1).mean().is_finite());
}
