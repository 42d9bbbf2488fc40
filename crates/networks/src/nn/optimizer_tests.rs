//! Tests of [`AdamW`](crate::nn::AdamW): against the formula and candle's, and resumed to the bit.

use candle_core::backprop::GradStore;
use candle_core::{DType, Tensor};
use candle_nn::Optimizer;

use crate::nn::gradient_check::{assert_close, random_tensor};
use crate::nn::{Activation, AdamW, AdamWConfig, Init, Mlp, NnError, Parameters, Schedule};
use impactlab_core::numerics::random_stream;

fn network(seed: u64) -> (Parameters, Mlp) {
    let mut parameters = Parameters::new(DType::F32);
    let mut rng = random_stream(seed, "weights", 0);
    let mut root = parameters.builder(&mut rng);
    let mlp = Mlp::new(&mut root.at("trunk"), &[3, 40, 30, 1], Activation::None).unwrap();
    (parameters, mlp)
}

fn gradients(mlp: &Mlp, batch: u64) -> GradStore {
    let x = random_tensor(&[50, 3], DType::F32, batch);
    mlp.forward(&x).unwrap().sqr().unwrap().mean_all().unwrap().backward().unwrap()
}

fn config() -> AdamWConfig {
    let schedule = Schedule::WarmupCosine { warmup_steps: 3, total_steps: 20, final_share: 0.0 };
    AdamWConfig { max_gradient_norm: Some(0.5), schedule, ..AdamWConfig::default() }
}

fn bits(parameters: &Parameters) -> Vec<u32> {
    let all = parameters.iter();
    let values = all.flat_map(|(_, v)| v.flatten_all().unwrap().to_vec1::<f32>().unwrap());
    values.map(f32::to_bits).collect()
}

#[test]
fn steps_are_those_of_candles_adamw() {
    let ((ours, mlp), (theirs, their_mlp)) = (network(1), network(1));
    let config = AdamWConfig { decay_biases: true, weight_decay: 0.1, ..Default::default() };
    let mut optimizer = AdamW::new(config, &ours).unwrap();
    let settings = candle_nn::ParamsAdamW { weight_decay: 0.1, ..Default::default() };
    let variables = theirs.iter().map(|(_, v)| v.clone()).collect();
    let mut reference = candle_nn::AdamW::new(variables, settings).unwrap();
    for batch in 0..30 {
        optimizer.step(&ours, &gradients(&mlp, batch)).unwrap();
        reference.step(&gradients(&their_mlp, batch)).unwrap();
    }
    for ((_, ours), (_, theirs)) in ours.iter().zip(theirs.iter()) {
        assert_close(ours, theirs, 1e-5);
    }
}

#[test]
fn the_first_step_is_that_of_the_formula() {
    let mut parameters = Parameters::new(DType::F64);
    let mut rng = random_stream(1, "weights", 0);
    let mut root = parameters.builder(&mut rng);
    let weight = root.add("weight", &[1, 1], Init::Constant(2.0)).unwrap();
    let bias = root.add("bias", &[1], Init::Constant(2.0)).unwrap();
    let config = AdamWConfig { max_gradient_norm: Some(1.0), ..AdamWConfig::default() };
    let mut optimizer = AdamW::new(config, &parameters).unwrap();
    // Gradients 6 and 8, so the norm is 10 and they are clipped to 0.6 and 0.8.
    let loss = ((weight.sum_all().unwrap() * 6.0).unwrap()
        + (bias.sum_all().unwrap() * 8.0).unwrap())
    .unwrap();
    let report = optimizer.step(&parameters, &loss.backward().unwrap()).unwrap();
    assert_eq!((report.step, report.gradient_norm, report.learning_rate), (1, 10.0, 1e-3));
    // After one step m/(1 − β₁) = g and v/(1 − β₂) = g².
    let expected_weight = 2.0 * (1.0 - 1e-5) - 1e-3 * 0.6 / (0.6 + 1e-8);
    let expected_bias = 2.0 - 1e-3 * 0.8 / (0.8 + 1e-8);
    let value = |tensor: &Tensor| tensor.sum_all().unwrap().to_scalar::<f64>().unwrap();
    assert!((value(&weight) - expected_weight).abs() < 1e-14, "{}", value(&weight));
    assert!((value(&bias) - expected_bias).abs() < 1e-14, "{}", value(&bias));
}

#[test]
fn training_goes_on_with_the_same_bits_after_saving() {
    let (parameters, mlp) = network(1);
    let mut optimizer = AdamW::new(config(), &parameters).unwrap();
    let train = |optimizer: &mut AdamW, parameters: &Parameters, mlp: &Mlp, batches| {
        for batch in batches {
            optimizer.step(parameters, &gradients(mlp, batch)).unwrap();
        }
    };
    train(&mut optimizer, &parameters, &mlp, 0..5);
    let (state, weights) = (optimizer.export(), parameters.export().unwrap());
    train(&mut optimizer, &parameters, &mlp, 5..10);

    let (resumed, resumed_mlp) = network(2);
    resumed.import(&weights).unwrap();
    let mut resumed_optimizer = AdamW::new(config(), &resumed).unwrap();
    resumed_optimizer.import(&state).unwrap();
    assert_eq!(resumed_optimizer.steps_taken(), 5);
    train(&mut resumed_optimizer, &resumed, &resumed_mlp, 5..10);
    assert_eq!(bits(&parameters), bits(&resumed));
}

#[test]
fn what_is_not_trained_stays() {
    let (mut parameters, mlp) = network(1);
    let before = parameters.export().unwrap();
    assert_eq!(parameters.set_trained(|name| name.starts_with("trunk.2")), 2);
    let mut optimizer = AdamW::new(config(), &parameters).unwrap();
    optimizer.step(&parameters, &gradients(&mlp, 0)).unwrap();
    for (name, value) in parameters.export().unwrap() {
        let difference = (&value - &before[&name]).unwrap().abs().unwrap().max_all().unwrap();
        let moved = difference.to_scalar::<f32>().unwrap() > 0.0;
        assert_eq!(moved, name.starts_with("trunk.2"), "{name}");
    }
}

#[test]
fn a_gradient_that_is_not_finite_changes_nothing() {
    let (parameters, mlp) = network(1);
    let before = bits(&parameters);
    let mut optimizer = AdamW::new(config(), &parameters).unwrap();
    let loss = mlp.forward(&random_tensor(&[5, 3], DType::F32, 0)).unwrap();
    let loss = (loss.sum_all().unwrap() * f64::INFINITY).unwrap();
    let error = optimizer.step(&parameters, &loss.backward().unwrap()).unwrap_err();
    assert!(error.to_string().ends_with("is not finite; no step was taken"), "{error}");
    assert_eq!((bits(&parameters), optimizer.steps_taken()), (before, 0));
}

#[test]
fn a_state_of_another_network_is_refused() {
    let (parameters, _) = network(1);
    let mut optimizer = AdamW::new(config(), &parameters).unwrap();
    let mut state = optimizer.export();
    let removed = state.moments.remove("second_moment.trunk.0.bias").unwrap();
    let error = optimizer.import(&state).unwrap_err().to_string();
    assert_eq!(error, "the tensor \"second_moment.trunk.0.bias\" is missing");
    state.moments.insert("second_moment.trunk.0.bias".into(), removed.clone());
    state.moments.insert("second_moment.head.bias".into(), removed);
    let error = optimizer.import(&state).unwrap_err();
    assert!(matches!(error, NnError::UnexpectedTensor { .. }), "{error}");
    let error = optimizer.step(&Parameters::new(DType::F32), &gradients(&network(1).1, 0));
    assert!(matches!(error, Err(NnError::MissingTensor { .. })));
}

#[test]
fn settings_out_of_range_are_named() {
    let (parameters, _) = network(1);
    let config = AdamWConfig { beta_2: 1.0, ..AdamWConfig::default() };
    let error = AdamW::new(config, &parameters).unwrap_err().to_string();
    assert_eq!(error, "beta_2 is 1, expected at least 0 and below 1");
    let config = AdamWConfig { max_gradient_norm: Some(f64::NAN), ..AdamWConfig::default() };
    assert!(AdamW::new(config, &parameters).is_err());
}
