//! How fast the networks' shared layers run and train, the trunk and temporal attention; and how
//! fast the shipped force network predicts.
//!
//! `cargo bench --no-default-features --bench networks`

use std::path::Path;

use candle_core::{DType, Device, Tensor};
use divan::Bencher;
use impactlab::force::{ForceModel, ForceScenario};
use impactlab::learning::ModelFile;
use impactlab::nn::{
    Activation, AdamW, AdamWConfig, Attention, AttentionConfig, Mlp, Parameters, random_stream,
};
use rand::RngExt;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The trunk of the force network, its input first.
const WIDTHS: [usize; 9] = [96, 256, 512, 512, 256, 128, 64, 32, 16];

/// A batch of 32 curves of 200 samples.
const N_CURVES: usize = 32;
const N_SAMPLES: usize = 200;

/// One curve on a grid of 1 ms, 250 ms long.
const N_ROWS_OF_A_CURVE: usize = 250;

const ATTENTION: AttentionConfig =
    AttentionConfig { channels: 96, key_channels: 96, heads: 4, layer_norm: true };

fn main() {
    divan::main();
}

struct Network {
    parameters: Parameters,
    attention: Attention,
    trunk: Mlp,
}

fn network() -> Network {
    let mut parameters = Parameters::new(DType::F32);
    let mut rng = random_stream(1, "weights", 0);
    let mut root = parameters.builder(&mut rng);
    let attention = Attention::new(&mut root.at("attention"), ATTENTION).expect("sizes that fit");
    let trunk = Mlp::new(&mut root.at("trunk"), &WIDTHS, Activation::Silu).expect("sizes that fit");
    Network { parameters, attention, trunk }
}

fn input(shape: &[usize]) -> Tensor {
    let mut rng = random_stream(1, "input", 0);
    let values: Vec<f32> =
        (0..shape.iter().product()).map(|_| 2.0 * rng.random::<f32>() - 1.0).collect();
    Tensor::from_vec(values, shape, &Device::Cpu).expect("as many values as the shape says")
}

fn pool(n_threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(n_threads).build().expect("threads can be started")
}

fn forward(bencher: Bencher<'_, '_>, n_rows: usize, n_threads: usize) {
    let (trunk, x) = (network().trunk.frozen(), input(&[n_rows, WIDTHS[0]]));
    let pool = pool(n_threads);
    bencher.bench(|| pool.install(|| trunk.forward(&x).expect("rows that fit")));
}

/// Forward, backward and the step of the optimiser, with the mean square of the result as loss.
fn step(bencher: Bencher<'_, '_>, n_threads: usize, forward: impl Fn(&Network) -> Tensor + Sync) {
    let network = network();
    let mut optimizer =
        AdamW::new(AdamWConfig::default(), &network.parameters).expect("settings in range");
    let pool = pool(n_threads);
    let mut step = || {
        let loss = forward(&network).sqr().and_then(|y| y.mean_all());
        let gradients = loss.and_then(|loss| loss.backward()).expect("a loss");
        optimizer.step(&network.parameters, &gradients).expect("finite gradients")
    };
    bencher.bench_local(|| pool.install(&mut step));
}

#[divan::bench(args = [1, 2], sample_count = 30, sample_size = 1)]
fn trunk_forward_6400_rows(bencher: Bencher<'_, '_>, n_threads: usize) {
    forward(bencher, N_CURVES * N_SAMPLES, n_threads);
}

#[divan::bench(args = [1, 2])]
fn trunk_forward_250_rows(bencher: Bencher<'_, '_>, n_threads: usize) {
    forward(bencher, N_ROWS_OF_A_CURVE, n_threads);
}

#[divan::bench]
fn trunk_forward_1_row(bencher: Bencher<'_, '_>) {
    let (trunk, x) = (network().trunk.frozen(), input(&[1, WIDTHS[0]]));
    bencher.bench(|| trunk.forward(&x).expect("a row that fits"));
}

#[divan::bench(args = [1, 2], sample_count = 20, sample_size = 1)]
fn trunk_step_6400_rows(bencher: Bencher<'_, '_>, n_threads: usize) {
    let x = input(&[N_CURVES * N_SAMPLES, WIDTHS[0]]);
    step(bencher, n_threads, |network| network.trunk.forward(&x).expect("rows that fit"));
}

#[divan::bench(args = [1, 2], sample_count = 20, sample_size = 1)]
fn attention_step_32_curves(bencher: Bencher<'_, '_>, n_threads: usize) {
    let x = input(&[N_CURVES, N_SAMPLES, WIDTHS[0]]);
    step(bencher, n_threads, |network| {
        network.attention.self_attention(&x).expect("curves that fit")
    });
}

#[divan::bench(args = [1, 2], sample_count = 20, sample_size = 1)]
fn attention_and_trunk_step_32_curves(bencher: Bencher<'_, '_>, n_threads: usize) {
    let x = input(&[N_CURVES, N_SAMPLES, WIDTHS[0]]);
    step(bencher, n_threads, |network| {
        let seen = network.attention.self_attention(&x).expect("curves that fit");
        network.trunk.forward(&seen).expect("rows that fit")
    });
}

/// The distribution of the force history with its bands at 1 ms over 250 ms.
///
/// - `is_open`: contact point and body are drawn from their distribution.
#[divan::bench(args = [false, true], sample_count = 50, sample_size = 1)]
fn force_prediction(bencher: Bencher<'_, '_>, is_open: bool) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/models/force.safetensors");
    let model = ForceModel::load(&path).expect("the shipped model");
    let mut scenario = model.training_cases().first().expect("a case").scenario.clone();
    if is_open {
        scenario = ForceScenario { contact_m: None, bullet_body: None, ..scenario };
    }
    bencher.bench(|| {
        let prediction = model.predict(&scenario).expect("a scenario in range");
        prediction.mixture.bands(&[0.5, 0.8, 0.9, 0.95]).expect("levels of bands")
    });
}
