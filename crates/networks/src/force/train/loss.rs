//! The terms of the loss of the force network and their weighted sum.
//!
//! Source: after `eq:physic_cons2` of [`PitPinnPaper`](impactlab_core::bibliography::PitPinnPaper), which
//! has no likelihood.

use std::f64::consts::TAU;

use candle_core::{D, Tensor};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::force::network::NetworkOutput;
use crate::force::physics::DURATION_UNIT_S;
use crate::force::{ForceError, LossWeights};
use crate::nn::product;
use impactlab_core::uncertainty::CURVE_INTERVAL_S;

/// The terms of the loss as unweighted means over cases, and their weighted sum.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LossTerms {
    /// The weighted sum of the terms, which is minimised.
    pub total: f64,
    /// Negative log-likelihood of whole curves per value of the curve; forces in units of the peak
    /// force of the centre.
    pub likelihood: f64,
    /// Relative squared error of the mean curve, ‖F̂ − F‖² / ‖F‖².
    pub data: f64,
    /// Relative squared error of the impulse, |P̂ − P|² / |P|². It is the mean of that of the
    /// constrained impulse and that of the mean curve.
    pub impulse: f64,
    /// Squared error of the absorbed energy, relative to the kinetic energy of approach, plus the
    /// square of a negative absorbed energy in the same unit.
    pub energy: f64,
    /// Squared error of the mean duration of the first component, in units of 0.1 s.
    pub duration: f64,
    /// Cross-entropy of the classification as hooking or not; 0 for a mixture with a single
    /// component.
    pub hooking: f64,
}

/// The recorded values of some cases, with which the output of the network is compared. Forces are
/// in units of the peak force of the centre of each case.
#[derive(Debug, Clone)]
pub(crate) struct Targets {
    /// The curves as `[F_x…, F_y…, duration]`, durations in units of 0.1 s; `[cases, values]`.
    pub values: Tensor,
    /// Impulse of the curve, in units of the peak force times s, `[cases, 2]`.
    pub impulse: Tensor,
    /// 1 for a case with hooking and 0 for others, `[cases]`.
    pub hooked: Tensor,
    /// Velocity of the striking vehicle's contact point relative to the struck vehicle's before the
    /// impact, m/s, `[cases, 2]`.
    pub closing: Tensor,
    /// Inverse mass matrix K times the unit of the impulse, so that K P is in m/s, `[cases, 2, 2]`.
    pub inverse_mass: Tensor,
}

/// The terms of the loss as tensors through which gradients are computed.
pub(crate) struct Loss {
    /// The weighted sum of the terms.
    pub total: Tensor,
    /// Likelihood, data, impulse, energy, duration and hooking, not weighted.
    terms: [Tensor; 6],
}

impl Loss {
    /// Computes the terms and their weighted sum. The likelihood is always part of the sum, the
    /// other terms if their weight is positive.
    ///
    /// # Errors
    /// [`ForceError::Learning`] if a tensor operation fails.
    pub(crate) fn new(
        output: &NetworkOutput,
        targets: &Targets,
        weights: &LossWeights,
    ) -> Result<Self, ForceError> {
        let terms = [
            likelihood(output, targets)?,
            data(output, targets)?,
            impulse(output, targets)?,
            energy(output, targets)?,
            duration(output, targets)?,
            hooking(output, targets)?,
        ];
        let weights = [
            weights.likelihood,
            weights.data,
            weights.impulse,
            weights.energy,
            weights.duration,
            weights.hooking,
        ];
        let mut total = (&terms[0] * weights[0])?;
        for (term, weight) in terms.iter().zip(weights).skip(1).filter(|(_, w)| *w > 0.0) {
            total = (total + (term * weight)?)?;
        }
        Ok(Self { total, terms })
    }

    /// The values of the terms.
    ///
    /// # Errors
    /// [`ForceError::Learning`] if a tensor operation fails.
    pub(crate) fn values(&self) -> Result<LossTerms, ForceError> {
        let number = |tensor: &Tensor| -> Result<f64, ForceError> {
            Ok(tensor.to_dtype(candle_core::DType::F64)?.to_scalar::<f64>()?)
        };
        let [likelihood, data, impulse, energy, duration, hooking] = &self.terms;
        Ok(LossTerms {
            total: number(&self.total)?,
            likelihood: number(likelihood)?,
            data: number(data)?,
            impulse: number(impulse)?,
            energy: number(energy)?,
            duration: number(duration)?,
            hooking: number(hooking)?,
        })
    }
}

impl LossTerms {
    /// Name and value of each term, with the sum first.
    pub fn named(&self) -> [(&'static str, f64); 7] {
        [
            ("total", self.total),
            ("likelihood", self.likelihood),
            ("data", self.data),
            ("impulse", self.impulse),
            ("energy", self.energy),
            ("duration", self.duration),
            ("hooking", self.hooking),
        ]
    }

    /// Mean over batches, each weighted by its number of cases.
    pub(crate) fn mean(batches: &[(usize, Self)]) -> Self {
        let n: usize = batches.iter().map(|(n, _)| n).sum();
        let mean = |term: fn(&Self) -> f64| {
            batches.iter().map(|(n, terms)| *n as f64 * term(terms)).sum::<f64>() / n.max(1) as f64
        };
        Self {
            total: mean(|t| t.total),
            likelihood: mean(|t| t.likelihood),
            data: mean(|t| t.data),
            impulse: mean(|t| t.impulse),
            energy: mean(|t| t.energy),
            duration: mean(|t| t.duration),
            hooking: mean(|t| t.hooking),
        }
    }
}

/// Negative log-likelihood of the mixture per value of the curve, as the mean over cases:
///
/// ```text
/// −ln Σ_k π_k N(y; μ_k, D_k^½ R_k D_k^½ + U_k U_kᵀ) / values
/// ```
///
/// D contains the variances that the factors U do not explain, and R the correlation of
/// neighbouring instants.
fn likelihood(output: &NetworkOutput, targets: &Targets) -> Result<Tensor, ForceError> {
    let n_values = targets.values.dim(1)? as f64;
    let log_weight = candle_nn::ops::log_softmax(&output.logits, D::Minus1)?;
    let joint = (log_weight + log_normal(output, &targets.values)?)?;
    Ok((joint.log_sum_exp(D::Minus1)?.mean_all()? / -n_values)?)
}

/// Logarithm of the normal density of the values under each component, `[cases, K]`, by Woodbury's
/// identity, with z and W the whitened residual and factors:
///
/// ```text
/// rᵀ Σ⁻¹ r = |z|² − vᵀ M⁻¹ v     ln |Σ| = ln |D R| + ln |M|     M = 1 + Wᵀ W,  v = Wᵀ z
/// ```
///
/// D and R are those of the likelihood above.
///
/// - `values`: in the units of [`Targets::values`], `[cases, values]`.
pub(crate) fn log_normal(output: &NetworkOutput, values: &Tensor) -> Result<Tensor, ForceError> {
    let residual = values.unsqueeze(1)?.broadcast_sub(&output.mean)?;
    let deviation = output.variance.sqrt()?;
    let residual = whitened(&(residual / &deviation)?.unsqueeze(3)?, &output.lag_correlation)?;
    let mut square = residual.sqr()?.sum(3)?.sum(2)?;
    let n_steps = 2.0 * ((values.dim(1)? - 1) / 2 - 1) as f64;
    let log_fresh = ((1.0 - output.lag_correlation.sqr()?)?.log()? * n_steps)?;
    let mut log_det = (output.variance.log()?.sum(2)? + log_fresh)?;
    if let Some(factors) = &output.factors {
        let (n_cases, k, n_values, q) = factors.dims4()?;
        let flat = (n_cases * k, n_values, q);
        let scaled = factors.broadcast_div(&deviation.unsqueeze(3)?)?;
        let factors = whitened(&scaled, &output.lag_correlation)?.reshape(flat)?;
        let factors_t = factors.transpose(1, 2)?.contiguous()?;
        let m = product(&factors_t, &factors)?;
        let v = product(&factors_t, &residual.reshape((n_cases * k, n_values, 1))?)?;
        let (m_square, m_log_det) = quadratic_form_and_log_det(&m, &v)?;
        square = (square - m_square.reshape((n_cases, k))?)?;
        log_det = (log_det + m_log_det.reshape((n_cases, k))?)?;
    }
    let constant = values.dim(1)? as f64 * TAU.ln();
    Ok((((square + log_det)? + constant)? * -0.5)?)
}

/// Removes the correlation of neighbouring instants from rows that were divided by their standard
/// deviations.
///
/// ```text
/// z_i = (x_i − φ x_(i−1)) / √(1 − φ²)      z = x for the first instant of an axis and the duration
/// ```
///
/// - `rows`: x, `[cases, K, values, n]`.
/// - `lag_correlation`: φ, `[cases, K]`.
fn whitened(rows: &Tensor, lag_correlation: &Tensor) -> Result<Tensor, ForceError> {
    let n_instants = (rows.dim(2)? - 1) / 2;
    let phi = lag_correlation.unsqueeze(2)?.unsqueeze(3)?;
    let fresh = (1.0 - phi.sqr()?)?.sqrt()?;
    let mut parts = Vec::with_capacity(5);
    for first in [0, n_instants] {
        let before = rows.narrow(2, first, n_instants - 1)?;
        let after = rows.narrow(2, first + 1, n_instants - 1)?;
        parts.push(rows.narrow(2, first, 1)?);
        parts.push((after - before.broadcast_mul(&phi)?)?.broadcast_div(&fresh)?);
    }
    parts.push(rows.narrow(2, 2 * n_instants, 1)?);
    Ok(Tensor::cat(&parts, 2)?)
}

/// Computes `vᵀ (1 + m)⁻¹ v` and `ln |1 + m|`, both `[batch]`, by Gaussian elimination, through
/// which gradients are computed:
///
/// ```text
/// ⎡1 + m  v⎤   eliminating the first q rows leaves −vᵀ (1 + m)⁻¹ v in the last one,
/// ⎣ vᵀ    0⎦   and the product of the pivots is |1 + m|
/// ```
///
/// - `m`: positive semidefinite, `[batch, q, q]`.
/// - `v`: `[batch, q, 1]`.
fn quadratic_form_and_log_det(m: &Tensor, v: &Tensor) -> Result<(Tensor, Tensor), ForceError> {
    let (batch, q, _) = m.dims3()?;
    let one = Tensor::eye(q, m.dtype(), m.device())?.unsqueeze(0)?;
    let corner = Tensor::zeros((batch, 1, 1), m.dtype(), m.device())?;
    let upper = Tensor::cat(&[&m.broadcast_add(&one)?, v], 2)?;
    let lower = Tensor::cat(&[&v.transpose(1, 2)?, &corner], 2)?;
    let mut left = Tensor::cat(&[upper, lower], 1)?;
    let mut log_det = corner.flatten_all()?;
    for n in (1..=q).rev() {
        let pivot = left.narrow(1, 0, 1)?.narrow(2, 0, 1)?;
        let row = left.narrow(1, 0, 1)?.narrow(2, 1, n)?;
        let eliminated = row.transpose(1, 2)?.broadcast_mul(&row.broadcast_div(&pivot)?)?;
        left = (left.narrow(1, 1, n)?.narrow(2, 1, n)? - eliminated)?;
        log_det = (log_det + pivot.flatten_all()?.log()?)?;
    }
    Ok((left.flatten_all()?.neg()?, log_det))
}

/// Weights π_k of the components, `[cases, K, 1]`.
fn weights(output: &NetworkOutput) -> Result<Tensor, ForceError> {
    Ok(candle_nn::ops::softmax(&output.logits, D::Minus1)?.unsqueeze(2)?)
}

/// Relative squared error of the forces of the mean curve.
fn data(output: &NetworkOutput, targets: &Targets) -> Result<Tensor, ForceError> {
    let n_forces = targets.values.dim(1)? - 1;
    let mean = output.mean.broadcast_mul(&weights(output)?)?.sum(1)?.narrow(1, 0, n_forces)?;
    let truth = targets.values.narrow(1, 0, n_forces)?;
    let error = (mean - &truth)?.sqr()?.sum(1)?;
    Ok((error / (truth.sqr()?.sum(1)? + 1e-9)?)?.mean_all()?)
}

/// Relative squared error of the impulse: the mean of that of F_base, which the physics layer
/// holds, and that of the mean curve.
fn impulse(output: &NetworkOutput, targets: &Targets) -> Result<Tensor, ForceError> {
    let (n_cases, _, n_values) = output.mean.dims3()?;
    let n_instants = (n_values - 1) / 2;
    let mean = output.mean.broadcast_mul(&weights(output)?)?.sum(1)?;
    let mean = mean.narrow(1, 0, 2 * n_instants)?.reshape((n_cases, 2, n_instants))?;
    let of_mean = (mean.sum(2)? * CURVE_INTERVAL_S)?;
    let size = (targets.impulse.sqr()?.sum(1)? + 1e-12)?;
    let share = |impulse: &Tensor| -> Result<Tensor, ForceError> {
        let error = (impulse - &targets.impulse)?.sqr()?.sum(1)?;
        Ok((error / &size)?.mean_all()?)
    };
    Ok(((share(&output.impulse)? + share(&of_mean)?)? * 0.5)?)
}

/// Error of the energy W that the contact absorbs, in units of ½ v·v / K̄, where K̄ is the mean of
/// the diagonal of K. The energy is compared with that of the recorded impulse and must not be
/// negative.
///
/// ```text
/// W = v·P − ½ PᵀKP
/// ```
fn energy(output: &NetworkOutput, targets: &Targets) -> Result<Tensor, ForceError> {
    let work = |impulse: &Tensor| -> Result<Tensor, ForceError> {
        let velocity = product(&targets.inverse_mass, &impulse.unsqueeze(2)?)?.squeeze(2)?;
        let first = (&targets.closing * impulse)?.sum(1)?;
        Ok((first - ((impulse * velocity)?.sum(1)? * 0.5)?)?)
    };
    let trace = (targets.inverse_mass.narrow(1, 0, 1)?.narrow(2, 0, 1)?.flatten_all()?
        + targets.inverse_mass.narrow(1, 1, 1)?.narrow(2, 1, 1)?.flatten_all()?)?;
    let unit = (targets.closing.sqr()?.sum(1)? / trace)?;
    let unit = (unit + 1e-12)?;
    let got = (work(&output.impulse)? / &unit)?;
    let known = (work(&targets.impulse)? / &unit)?;
    let from_nothing = got.neg()?.relu()?.sqr()?;
    Ok(((got - known)?.sqr()? + from_nothing)?.mean_all()?)
}

/// Squared error of the mean duration of the first component, in units of 0.1 s.
fn duration(output: &NetworkOutput, targets: &Targets) -> Result<Tensor, ForceError> {
    let known = targets.values.narrow(1, targets.values.dim(1)? - 1, 1)?.squeeze(1)?;
    let got = (&output.duration_s / DURATION_UNIT_S)?;
    Ok((got - known)?.sqr()?.mean_all()?)
}

/// Negative logarithm of the total weight π of the components of the recorded kind, the last
/// component for hooking and the others for no hooking; 0 for a single component.
fn hooking(output: &NetworkOutput, targets: &Targets) -> Result<Tensor, ForceError> {
    let k = output.logits.dim(1)?;
    if k < 2 {
        return Ok(targets.hooked.zeros_like()?.mean_all()?);
    }
    let log_weight = candle_nn::ops::log_softmax(&output.logits, D::Minus1)?;
    let of_hooking = log_weight.narrow(1, k - 1, 1)?.squeeze(1)?;
    let of_others = log_weight.narrow(1, 0, k - 1)?.log_sum_exp(D::Minus1)?;
    let others = (1.0 - &targets.hooked)?;
    Ok(((&targets.hooked * of_hooking)? + (others * of_others)?)?.mean_all()?.neg()?)
}

#[cfg(test)]
mod tests {
    use candle_core::{DType, Device};

    use super::*;
    use impactlab_core::uncertainty::{CurveComponent, CurveMixture, ForceCurve, PeakFactors};

    /// A small output with two components, two factors and three instants.
    fn output() -> (NetworkOutput, Tensor) {
        let (k, q, values) = (2, 2, 7);
        let wave = |n: usize, a: f64| -> Vec<f64> {
            (0..n).map(|i| (a * (i as f64 + 1.0)).sin()).collect()
        };
        let tensor =
            |data: Vec<f64>, shape: &[usize]| Tensor::from_vec(data, shape, &Device::Cpu).unwrap();
        let variance = wave(k * values, 0.7).into_iter().map(|x| 0.5 + x * x).collect();
        let output = NetworkOutput {
            logits: tensor(vec![0.3, -0.4], &[1, k]),
            mean: tensor(wave(k * values, 1.3), &[1, k, values]),
            variance: tensor(variance, &[1, k, values]),
            lag_correlation: tensor(vec![0.0, 0.6], &[1, k]),
            factors: Some(tensor(wave(k * values * q, 0.9), &[1, k, values, q])),
            impulse: tensor(vec![0.1, 0.2], &[1, 2]),
            duration_s: tensor(vec![0.1], &[1]),
        };
        (output, tensor(wave(values, 2.1), &[1, values]))
    }

    #[test]
    fn the_likelihood_is_that_of_the_mixture() {
        let (output, values) = output();
        let weights = candle_nn::ops::softmax(&output.logits, 1).unwrap();
        let weights = weights.to_vec2::<f64>().unwrap();
        let rows = |tensor: &Tensor| tensor.squeeze(0).unwrap().to_vec2::<f64>().unwrap();
        let factors = output.factors.as_ref().unwrap().squeeze(0).unwrap();
        let factors = factors.to_vec3::<f64>().unwrap();
        let components = (0..2).map(|k| CurveComponent {
            weight: weights[0][k],
            mean: rows(&output.mean)[k].clone(),
            variance: rows(&output.variance)[k].clone(),
            lag_correlation: output.lag_correlation.to_vec2::<f64>().unwrap()[0][k],
            factors: nalgebra::DMatrix::from_fn(7, 2, |i, j| factors[k][i][j]),
            peak: PeakFactors::default(),
        });
        let mixture = CurveMixture::new(components.collect()).unwrap();
        let curve = ForceCurve::from_values(&values.to_vec2::<f64>().unwrap()[0]);
        let expected = mixture.log_density(&curve).unwrap();
        let log_weight = candle_nn::ops::log_softmax(&output.logits, 1).unwrap();
        let joint = (log_weight + log_normal(&output, &values).unwrap()).unwrap();
        let got = joint.log_sum_exp(1).unwrap().to_vec1::<f64>().unwrap()[0];
        assert!((got - expected).abs() < 1e-9, "{got} {expected}");
    }

    #[test]
    fn energy_out_of_nothing_costs() {
        let (mut output, values) = output();
        let tensor = |data: &[f64], shape: &[usize]| {
            Tensor::from_vec(data.to_vec(), shape, &Device::Cpu).unwrap()
        };
        let targets = Targets {
            values,
            impulse: tensor(&[0.0, 1.0], &[1, 2]),
            hooked: Tensor::zeros(1, DType::F64, &Device::Cpu).unwrap(),
            closing: tensor(&[0.0, 1.0], &[1, 2]),
            inverse_mass: tensor(&[1.0, 0.0, 0.0, 1.0], &[1, 2, 2]),
        };
        let mut at = |py: f64| {
            output.impulse = tensor(&[0.0, py], &[1, 2]);
            energy(&output, &targets).unwrap().to_scalar::<f64>().unwrap()
        };
        // W(P) = P − P²/2 in units of ½ is that of the struck vehicle at P = 1 and negative for P >
        // 2.
        assert!(at(1.0).abs() < 1e-12);
        assert!(at(0.5) > 0.0 && at(3.0) > at(2.0) + 1.0);
    }
}
