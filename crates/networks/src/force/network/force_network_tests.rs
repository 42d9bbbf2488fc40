//! Gradients of the force network against central differences.

use candle_core::Var;

use super::*;
use crate::force::ForceConfig;
use crate::nn::gradient_check::{assert_gradients, random_tensor};
use impactlab_core::numerics::random_stream;

const N_INSTANTS: usize = 6;

/// Layers as many as the paper has, each a few numbers wide.
fn narrow(config: NetworkConfig) -> NetworkConfig {
    NetworkConfig {
        encoder_branches: config.encoder_branches.iter().map(|_| [2, 2, 2]).collect(),
        position_channels: 2,
        attention_channels: 4,
        attention_heads: 2,
        trunk: config.trunk.iter().map(|_| 3).collect(),
        factors: 1,
        ..config
    }
}

/// One case with a force that ends within the instants.
fn input(config: &NetworkConfig) -> NetworkInput {
    let n_values = 2 * N_INSTANTS + 1;
    let components = [1, config.components, n_values];
    let random = |shape: &[usize], number| random_tensor(shape, DType::F64, number);
    let positive = |tensor: Tensor| (tensor.sqr().unwrap() + 0.1).unwrap();
    let whole = [0.002, 0.003, 0.0043, 0.0];
    let whole = Tensor::new(&whole, &candle_core::Device::Cpu).unwrap();
    let factors = [&components[..], &[config.factors]].concat();
    NetworkInput {
        features: random(&[1, N_FEATURES + 1], 1),
        instants: random(&[1, N_INSTANTS, N_INSTANT_FEATURES], 2),
        whole: whole.unsqueeze(0).unwrap(),
        shift: random(&components, 3),
        variance: positive(random(&components, 4)),
        lag_correlation: random(&[1, config.components], 5),
        factors: Some(random(&factors, 6)),
    }
}

/// Everything that the loss is computed from.
fn all(output: &NetworkOutput) -> Tensor {
    let NetworkOutput { logits, mean, variance, factors, impulse, duration_s, .. } = output;
    let factors = factors.as_ref().unwrap();
    let tensors = [logits, mean, variance, factors, impulse, duration_s];
    let flat: Vec<Tensor> = tensors.iter().map(|tensor| tensor.flatten_all().unwrap()).collect();
    Tensor::cat(&flat, 0).unwrap()
}

#[test]
fn gradients_are_those_of_central_differences() {
    let plain = NetworkConfig { attention: false, ..NetworkConfig::default() };
    for config in [NetworkConfig::default(), plain, ForceConfig::paper().network] {
        let (config, mut rng) = (narrow(config), random_stream(1, "test", 0));
        let network = ForceNetwork::new(&config, 1, &mut rng, Parameters::new(DType::F64)).unwrap();
        let parameters: Vec<Var> =
            network.parameters().iter().map(|(_, variable)| variable.clone()).collect();
        for (number, variable) in (10..).zip(&parameters) {
            variable.set(&random_tensor(variable.dims(), DType::F64, number)).unwrap();
        }
        let input = input(&config);
        assert_gradients(&parameters, || all(&network.forward(&input).unwrap()));
    }
}
