//! Gradients against central differences, for the tests of every layer.

use candle_core::{DType, Tensor, Var};
use rand::RngExt;

use impactlab_core::numerics::random_stream;

/// Step of the central difference; its error is about h², rounding about 1e-16/h.
const STEP: f64 = 1e-5;

/// Numbers within ±1 from a fixed stream.
pub(crate) fn random_tensor(shape: &[usize], number_type: DType, number: u64) -> Tensor {
    let mut rng = random_stream(11, "test", number);
    let n = shape.iter().product();
    let values: Vec<f64> = (0..n).map(|_| 2.0 * rng.random::<f64>() - 1.0).collect();
    let tensor = Tensor::from_vec(values, shape, &candle_core::Device::Cpu).unwrap();
    tensor.to_dtype(number_type).unwrap()
}

pub(crate) fn random_variable(shape: &[usize], number: u64) -> Var {
    Var::from_tensor(&random_tensor(shape, DType::F64, number)).unwrap()
}

fn values(tensor: &Tensor) -> Vec<f64> {
    let tensor = tensor.to_dtype(DType::F64).unwrap();
    tensor.flatten_all().unwrap().to_vec1().unwrap()
}

/// Same shape, and no value farther than `tolerance`, absolute or relative.
pub(crate) fn assert_close(got: &Tensor, expected: &Tensor, tolerance: f64) {
    assert_eq!(got.elem_count(), expected.elem_count());
    for (i, (got, expected)) in values(got).into_iter().zip(values(expected)).enumerate() {
        let bound = tolerance * expected.abs().max(1.0);
        assert!((got - expected).abs() <= bound, "at {i}: {got} instead of {expected}");
    }
}

/// The gradients of Σ c·y with fixed random c with respect to every value of every variable.
pub(crate) fn assert_gradients(variables: &[Var], output: impl Fn() -> Tensor) {
    let weights = random_tensor(output().dims(), DType::F64, 99);
    let loss = || (output() * &weights).unwrap().sum_all().unwrap();
    let gradients = loss().backward().unwrap();
    for (which, variable) in variables.iter().enumerate() {
        let gradient = values(gradients.get(variable).expect("a gradient of every variable"));
        let start = values(variable);
        let at = |i: usize, value: f64| {
            let mut changed = start.clone();
            changed[i] = value;
            let changed = Tensor::from_vec(changed, variable.shape(), variable.device()).unwrap();
            variable.set(&changed).unwrap();
            loss().to_scalar::<f64>().unwrap()
        };
        for i in 0..start.len() {
            let difference = at(i, start[i] + STEP) - at(i, start[i] - STEP);
            let expected = difference / (2.0 * STEP);
            let error = (gradient[i] - expected).abs();
            let bound = 1e-8 * expected.abs().max(1.0);
            assert!(error < bound, "variable {which}, {i}: {} not {expected}", gradient[i]);
        }
        at(0, start[0]);
    }
}
