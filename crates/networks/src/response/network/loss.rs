//! What training minimises.
//!
//! ```text
//! L = L_data + λ_nll L_nll + λ_p λ(epoch) L_physics + λ_cons L_diversity
//!     + λ_traj L_trajectory + λ_smooth L_smoothness + λ_bound L_boundary
//! ```
//!
//! - *data*: Huber's loss `√(1 + e²) − 1` of velocities and rates, in units of which errors count;
//! - *likelihood*: `−ln Σ_j ω_j N(…)`, of the next state or of a whole rollout;
//! - *physics*: the components obey the 4DOF equations up to the learned correction δ_j. Inside the
//!   step `(x̂(t+1) − x̂(t))/Δt − f(x̂) − δ_j` is what the network adds, so that the mean square of
//!   it, in its units, is the loss;
//! - *diversity*: `Σ_{j<k} exp(−‖μ_j − μ_k‖²/2τ²)` on standardised values;
//! - *trajectory*: Huber's loss of heading and position along a rollout;
//! - *smoothness*: mean square of the second difference of the velocities along a rollout;
//! - *boundary*: `Σ softplus((|x̂_i| − b_i)/s_i)²`, s_i learned.
//!
//! Source: after `eq:consistency_loss` and `eq:all_loss` of
//! [`PitPinnPaper`](impactlab_core::bibliography::PitPinnPaper), which mixes units in the diversity and has no
//! likelihood.

use candle_core::{D, Device, Tensor};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::nn::{NnError, softmax};
use crate::response::network::response_network::{BOUNDED_STATES, ResponseOutput};
use crate::response::{N_RESIDUAL, ResponseLossWeights};

/// τ of the diversity.
const DIVERSITY_SCALE: f64 = 2.0;

/// Terms of the loss, each before its weight.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResponseLossTerms {
    /// The weighted sum.
    pub total: f64,
    /// Error of velocities and rates.
    pub data: f64,
    /// Negative log-likelihood.
    pub likelihood: f64,
    /// Size of what the network adds to 4DOF model and effects.
    pub physics: f64,
    /// Components that coincide.
    pub diversity: f64,
    /// Error of heading and position.
    pub trajectory: f64,
    /// Second derivative.
    pub smoothness: f64,
    /// States near or beyond what is physical.
    pub boundary: f64,
}

impl ResponseLossTerms {
    /// Names and values.
    pub fn named(self) -> [(&'static str, f64); 8] {
        [
            ("total", self.total),
            ("data", self.data),
            ("likelihood", self.likelihood),
            ("physics", self.physics),
            ("diversity", self.diversity),
            ("trajectory", self.trajectory),
            ("smoothness", self.smoothness),
            ("boundary", self.boundary),
        ]
    }

    /// Mean over batches of equal weight.
    pub(crate) fn mean(batches: &[Self]) -> Self {
        let n = batches.len().max(1) as f64;
        let mean = |term: fn(&Self) -> f64| batches.iter().map(term).sum::<f64>() / n;
        Self {
            total: mean(|terms| terms.total),
            data: mean(|terms| terms.data),
            likelihood: mean(|terms| terms.likelihood),
            physics: mean(|terms| terms.physics),
            diversity: mean(|terms| terms.diversity),
            trajectory: mean(|terms| terms.trajectory),
            smoothness: mean(|terms| terms.smoothness),
            boundary: mean(|terms| terms.boundary),
        }
    }
}

/// The terms as tensors.
pub(crate) struct ResponseLoss {
    pub data: Tensor,
    pub likelihood: Tensor,
    pub physics: Tensor,
    pub diversity: Tensor,
    pub trajectory: Tensor,
    pub smoothness: Tensor,
    pub boundary: Tensor,
}

impl ResponseLoss {
    /// The weighted sum, and the values of all terms.
    ///
    /// - `physics_weight`: λ(epoch).
    pub(crate) fn total(
        &self,
        weights: &ResponseLossWeights,
        physics_weight: f64,
    ) -> Result<(Tensor, ResponseLossTerms), NnError> {
        let weighted = [
            (&self.likelihood, weights.likelihood),
            (&self.physics, weights.physics * physics_weight),
            (&self.diversity, weights.diversity),
            (&self.trajectory, weights.trajectory),
            (&self.smoothness, weights.smoothness),
            (&self.boundary, weights.boundary),
        ];
        let mut total = self.data.clone();
        for (term, weight) in weighted {
            // A term without weight costs no gradient.
            if weight != 0.0 {
                total = (total + (term * weight)?)?;
            }
        }
        let value = |term: &Tensor| term.to_scalar::<f64>();
        let terms = ResponseLossTerms {
            total: value(&total)?,
            data: value(&self.data)?,
            likelihood: value(&self.likelihood)?,
            physics: value(&self.physics)?,
            diversity: value(&self.diversity)?,
            trajectory: value(&self.trajectory)?,
            smoothness: value(&self.smoothness)?,
            boundary: value(&self.boundary)?,
        };
        Ok((total, terms))
    }
}

/// `√(1 + Σ_last e²) − 1`.
pub(crate) fn huber_of_squares(squares: &Tensor) -> Result<Tensor, NnError> {
    Ok(((squares.sum(D::Minus1)? + 1.0)?.sqrt()? - 1.0)?)
}

/// The data terms of single steps: Huber's loss of the mean residual, and the likelihood of the next
/// state.
///
/// - `targets`: `[rows, 1, 1, 4]`;
/// - `unit`: errors of the order of which count, as the correction is; `change`: what a unit of it
///   changes the velocities by over a step.
pub(crate) fn single_step_terms(
    output: &ResponseOutput,
    targets: &Tensor,
    unit: [f64; N_RESIDUAL],
    change: f64,
    min_std: f64,
) -> Result<[Tensor; 2], NnError> {
    let device = output.residual.device();
    let weights = softmax(&output.logits, 1.0)?;
    let off = output.residual.broadcast_sub(targets)?;
    let mean = off.broadcast_mul(&weights.unsqueeze(D::Minus1)?)?.sum(2)?;
    let scaled = mean.broadcast_div(&Tensor::new(&unit, device)?)?;
    let data = ((scaled.sqr()? + 1.0)?.sqrt()? - 1.0)?.mean_all()?;

    let variance = (output.log_variance.exp()? + min_std * min_std)?;
    let distance = ((off * change)?.sqr()? / &variance)?;
    let exponent = ((distance + variance.log()?)?.sum(D::Minus1)? * -0.5)?;
    let joint = (exponent + (weights + 1e-12)?.log()?)?;
    let likelihood = (joint.log_sum_exp(D::Minus1)?.mean_all()? * (-1.0 / N_RESIDUAL as f64))?;
    Ok([data, likelihood])
}

/// `Σ_{j<k} exp(−‖μ_j − μ_k‖²/2τ²)`, the mean over rows.
///
/// - `standardised`: `[rows, J, n]`.
pub(crate) fn diversity(standardised: &Tensor) -> Result<Tensor, NnError> {
    let (n_rows, n_components, _) = standardised.dims3()?;
    let mut sum = Tensor::zeros((), standardised.dtype(), &Device::Cpu)?;
    for j in 0..n_components {
        for k in j + 1..n_components {
            let off = (standardised.narrow(1, j, 1)? - standardised.narrow(1, k, 1)?)?;
            let squared = off.sqr()?.sum(D::Minus1)?;
            let near = (squared * (-0.5 / (DIVERSITY_SCALE * DIVERSITY_SCALE)))?.exp()?;
            sum = (sum + near.sum_all()?)?;
        }
    }
    Ok((sum / n_rows.max(1) as f64)?)
}

/// `Σ_i softplus((|x̂_i| − b_i)/s_i)²`, the mean over rows.
///
/// - `states`: `[rows, 8]`; `scale`: s in units of the bounds, `[5]`.
pub(crate) fn boundary(states: &Tensor, scale: &Tensor) -> Result<Tensor, NnError> {
    let mut columns = Vec::with_capacity(BOUNDED_STATES.len());
    for (idx, bound) in BOUNDED_STATES {
        columns.push(((states.narrow(1, idx, 1)?.abs()? / bound)? - 1.0)?);
    }
    let beyond = Tensor::cat(&columns, 1)?.broadcast_div(scale)?;
    // softplus without overflow: max(z, 0) + ln(1 + e^{−|z|})
    let softplus = (beyond.relu()? + ((beyond.abs()?.neg()?.exp()? + 1.0)?.log()?))?;
    Ok(softplus.sqr()?.sum(D::Minus1)?.mean_all()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_that_coincide_cost_one_a_pair() {
        let same = Tensor::zeros((2, 3, 4), candle_core::DType::F64, &Device::Cpu).unwrap();
        assert!((diversity(&same).unwrap().to_scalar::<f64>().unwrap() - 3.0).abs() < 1e-12);
        let apart = Tensor::new(&[[[0.0f64], [20.0]]], &Device::Cpu).unwrap();
        assert!(diversity(&apart).unwrap().to_scalar::<f64>().unwrap() < 1e-12);
    }

    #[test]
    fn the_boundary_costs_little_inside_and_much_beyond() {
        let scale = Tensor::new(&[0.05f64; 5], &Device::Cpu).unwrap();
        let penalty = |vx: f64| {
            let x = Tensor::new(&[[vx, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]], &Device::Cpu).unwrap();
            boundary(&x, &scale).unwrap().to_scalar::<f64>().unwrap()
        };
        assert!(
            penalty(30.0) < 1e-6 && penalty(60.0) > 0.4 && penalty(-66.0) > 3.0,
            "{} {}",
            penalty(30.0),
            penalty(60.0)
        );
        assert!(penalty(1e9).is_finite());
    }
}
