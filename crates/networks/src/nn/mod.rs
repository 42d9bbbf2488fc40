//! What the networks share: layers, named parameters, the optimiser, seeds, and the file that holds
//! a trained model. Layers are made of candle's operations, except for matrix product, bias with
//! activation, and softmax, which take much longer as operations of candle (BENCHMARKS.md).
//!
//! Everything runs on the CPU, in 32 or 64 bits, and gives the same bits for the same seed on the
//! same machine, whatever the number of threads: weights are drawn from a generator that the
//! caller passes, in the order of the layers, and every sum is taken in a fixed order.
//!
//! ```
//! use candle_core::{DType, Device, Tensor};
//! use impactlab_networks::nn::{Activation, AdamW, AdamWConfig, Mlp, Parameters};
//! use impactlab_core::numerics::{random_stream};
//!
//! let mut parameters = Parameters::new(DType::F32);
//! let mut rng = random_stream(7, "weights", 0);
//! let mut root = parameters.builder(&mut rng);
//! let trunk = Mlp::new(&mut root.at("trunk"), &[3, 8, 1], Activation::None)?;
//! let mut optimizer = AdamW::new(AdamWConfig::default(), &parameters)?;
//!
//! let x = Tensor::ones((4, 3), DType::F32, &Device::Cpu)?;
//! let loss = trunk.forward(&x)?.sqr()?.mean_all()?;
//! optimizer.step(&parameters, &loss.backward()?)?;
//! assert_eq!(parameters.n_values(), 3 * 8 + 8 + 8 + 1);
//! # Ok::<(), impactlab_networks::nn::NnError>(())
//! ```

mod activation;
mod attention;
mod checkpoint;
mod checkpoint_bytes;
#[cfg(test)]
mod checkpoint_tests;
mod element;
mod encoding;
mod error;
#[cfg(test)]
pub(crate) mod gradient_check;
mod init;
mod layer_norm;
mod linear;
mod mlp;
mod named_tensors;
mod optimizer;
#[cfg(test)]
mod optimizer_tests;
mod parameters;
mod product;
mod schedule;
mod softmax;
pub(crate) mod storage;
mod stored;

pub use activation::Activation;
pub(crate) use activation::bias_silu_rows;
pub use attention::{Attention, AttentionConfig};
pub use checkpoint::{Checkpoint, ModelKind, kind_of_file};
pub use encoding::positional_encoding;
pub use error::NnError;
pub use init::Init;
pub use layer_norm::LayerNorm;
pub use linear::Linear;
pub use mlp::{Mlp, MultiScaleEncoder};
pub use named_tensors::NamedTensors;
pub(crate) use named_tensors::parameter_budget;
pub use optimizer::{AdamW, AdamWConfig, OptimizerState, StepReport};
pub use parameters::{MAX_PARAMETER_TENSORS, MAX_PARAMETERS, ParameterBuilder, Parameters};
pub use product::{product, product_with_transposed};
pub use schedule::Schedule;
pub use softmax::softmax;
pub(crate) use stored::{Expected, check_length, check_number, check_numbers};
