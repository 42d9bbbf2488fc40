//! Measures the duration of an epoch of the force network in its default size, without attention
//! and in the paper's size, and of a prediction by the shipped model.
//!
//! `cargo bench --bench networks`

#![allow(clippy::print_stdout)]

use std::ops::ControlFlow;
use std::path::Path;

use divan::Bencher;
use impactlab_networks::force::{
    Centre, ForceCase, ForceConfig, ForceModel, ForceScenario, ForceTrainingSet, train,
};
use impactlab_networks::learning::{ModelFile, TrainSettings};

/// Number of epochs for each size, among them the first ones, which run with cold caches.
const N_EPOCHS: usize = 20;

fn main() {
    println!("| one epoch on 75 cases | weights | fastest | median | slowest |");
    println!("| --- | --- | --- | --- | --- |");
    print_epoch("default", ForceConfig::default());
    print_epoch("without attention", without_attention());
    print_epoch("paper", ForceConfig::paper());
    divan::main();
}

fn without_attention() -> ForceConfig {
    let mut config = ForceConfig::default();
    config.network.attention = false;
    config
}

/// Trains a network for some epochs and prints a row with its number of weights and the durations
/// of its epochs.
///
/// The centre is the momentum solution, because its fit takes hardly any time. The network itself
/// is the same for every centre.
fn print_epoch(name: &str, mut config: ForceConfig) {
    config.network.centre = Centre::Momentum;
    config.training.epochs = N_EPOCHS;
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/fea");
    let mut go_on = |_| ControlFlow::Continue(());
    let cases = ForceCase::load_all(&root, &mut go_on).expect("the shipped data set can be read");
    let cases = cases.complete().expect("nothing cancels");
    let set = ForceTrainingSet::from_split("fea", &cases, 0, config.training.test_share);
    let settings = TrainSettings::unsaved(config, 0);
    let model = train(&set, &settings, &mut |_| ControlFlow::Continue(())).expect("a training");
    let mut seconds: Vec<f64> =
        model.record().history.iter().filter_map(|epoch| epoch.seconds).collect();
    seconds.sort_by(f64::total_cmp);
    let ms = |idx: usize| 1e3 * seconds[idx];
    println!(
        "| {name} | {} | {:.0} ms | {:.0} ms | {:.0} ms |",
        model.n_parameters(),
        ms(0),
        ms(seconds.len() / 2),
        ms(seconds.len() - 1)
    );
}

/// Predicts the distribution of the force history with its bands, every 1 ms over 250 ms.
///
/// - `is_open`: whether contact point and body are unknown and drawn from the training cases.
#[divan::bench(args = [false, true], sample_count = 50, sample_size = 1)]
fn force_prediction(bencher: Bencher<'_, '_>, is_open: bool) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/models/force.safetensors");
    let model = ForceModel::load(&path).expect("the shipped model");
    let mut scenario = model.training_cases().first().expect("a case").scenario.clone();
    if is_open {
        scenario =
            ForceScenario { contact_m: None, striking_body: None, struck_body: None, ..scenario };
    }
    bencher.bench(|| {
        let prediction = model.predict(&scenario).expect("a scenario in range");
        prediction.mixture.bands(&[0.5, 0.8, 0.9, 0.95]).expect("levels of bands")
    });
}
