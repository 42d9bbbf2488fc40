//! Training on single steps: the residual acceleration that leads from each recorded state to the
//! next.

use std::ops::ControlFlow;

use candle_core::{D, Tensor};
use rand::RngExt;
use rand_distr::StandardNormal;

use crate::nn::{AdamW, AdamWConfig, Schedule, random_stream};
use crate::response::network::{ResponseNetwork, ResponseOutput};
use crate::response::one_step::{OneStepBatch, OneStepData};
use crate::response::{N_RESIDUAL, ResponseConfig, ResponseError, STEP_S};

/// Residual accelerations of the order of which errors count: m/s² and rad/s².
const RESIDUAL_UNIT: [f64; N_RESIDUAL] = [0.3, 0.3, 0.3, 1.0];

/// Weight of the likelihood beside the error.
const LIKELIHOOD_WEIGHT: f64 = 0.05;

/// Optimiser steps between two reports.
const STEPS_PER_REPORT: u64 = 50;

/// Share of the steps over which the learning rate rises.
const WARMUP_SHARE: f64 = 0.1;

/// How far a fit has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ResponseProgress {
    /// The 4DOF model is being tuned.
    Tuning {
        /// Moves of the swarm done.
        done: u64,
        /// How many.
        of: u64,
        /// Best cost so far.
        cost: f64,
    },
    /// The network learns single steps.
    SingleSteps {
        /// Steps of the optimiser done.
        done: u64,
        /// How many.
        of: u64,
        /// Mean loss since the last report.
        loss: f64,
    },
    /// The network learns rollouts.
    Rollouts {
        /// Steps of the optimiser done.
        done: u64,
        /// How many.
        of: u64,
        /// Steps of a rollout.
        length: usize,
        /// Loss of the latest.
        loss: f64,
    },
}

/// Trains the network's weights in place.
pub(crate) fn train_single_steps(
    network: &ResponseNetwork,
    data: &OneStepData,
    (config, seed): (&ResponseConfig, u64),
    report: &mut dyn FnMut(ResponseProgress) -> ControlFlow<()>,
) -> Result<(), ResponseError> {
    let training = config.training;
    let schedule = Schedule::WarmupCosine {
        warmup_steps: (training.steps as f64 * WARMUP_SHARE) as u64,
        total_steps: training.steps,
        final_share: 0.0,
    };
    let settings = AdamWConfig {
        learning_rate: training.learning_rate,
        weight_decay: training.weight_decay,
        max_gradient_norm: Some(training.max_gradient_norm),
        schedule,
        ..AdamWConfig::default()
    };
    let mut optimizer = AdamW::new(settings, network.parameters())?;
    let mut rng = random_stream(seed, "single steps", 0);
    let mut sum = 0.0;
    for done in 1..=training.steps {
        let draw = |_| rng.random_range(0..data.n_rows());
        let rows: Vec<usize> = (0..training.batch_instants).map(draw).collect();
        let batch = data.select(&rows)?;
        let noise: Vec<f64> = (0..batch.features.elem_count())
            .map(|_| training.feature_noise * rng.sample::<f64, _>(StandardNormal))
            .collect();
        let noise = Tensor::from_vec(noise, batch.features.shape(), batch.features.device())?;
        let output = network.forward(&(&batch.features + noise)?, &batch.tokens)?;
        let loss = single_step_loss(&output, &batch, config.network.min_std)?;
        sum += loss.to_scalar::<f64>()?;
        optimizer.step(network.parameters(), &loss.backward()?)?;
        if done.is_multiple_of(STEPS_PER_REPORT) || done == training.steps {
            let n = (done - 1) % STEPS_PER_REPORT + 1;
            let loss = std::mem::take(&mut sum) / n as f64;
            let told = ResponseProgress::SingleSteps { done, of: training.steps, loss };
            if report(told).is_break() {
                break;
            }
        }
    }
    Ok(())
}

/// Huber's loss of the mean residual, and the likelihood of the next state.
///
/// ```text
/// L = mean_i h((ā − r)_i/u_i) − ln Σ_j ω_j N(v(t+1) | v̂_j, σ_j²)/n       h(e) = √(1 + e²) − 1
/// ```
///
/// To first order in the step the predicted velocities differ from the recorded ones by
/// `(a_j − r) Δt`.
fn single_step_loss(
    output: &ResponseOutput,
    batch: &OneStepBatch,
    min_std: f64,
) -> Result<Tensor, ResponseError> {
    let device = output.residual.device();
    let weights = crate::nn::softmax(&output.logits, 1.0)?;
    let off = output.residual.broadcast_sub(&batch.targets)?;
    let mean = off.broadcast_mul(&weights.unsqueeze(D::Minus1)?)?.sum(2)?;
    let scaled = mean.broadcast_div(&Tensor::new(&RESIDUAL_UNIT, device)?)?;
    let data = ((scaled.sqr()? + 1.0)?.sqrt()? - 1.0)?.mean_all()?;

    let variance = (output.log_variance.exp()? + min_std * min_std)?;
    let distance = ((off * STEP_S)?.sqr()? / &variance)?;
    let exponent = ((distance + variance.log()?)?.sum(D::Minus1)? * -0.5)?;
    let joint = (exponent + (weights + 1e-12)?.log()?)?;
    let likelihood = (joint.log_sum_exp(D::Minus1)?.mean_all()? * (-1.0 / N_RESIDUAL as f64))?;
    Ok((data + (likelihood * LIKELIHOOD_WEIGHT)?)?)
}
