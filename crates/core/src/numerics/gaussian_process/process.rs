//! Gaussian process regression for some hundred samples and a few outputs.
//!
//! ```text
//! y = f(x) + ε     f ~ GP(0, k)     k(x, x') = s_f² exp(−½ Σ_j (x_j − x'_j)²/l_j²) + s_l² (x·x' + 1)
//! ε ~ N(0, s_n² + s_u² [sample is unusual])
//! ```
//!
//! Inputs and outputs are standardised. All outputs share the hyperparameters, which maximise the
//! product of the marginal likelihood and a broad prior; the prior prevents that few samples are
//! fitted too closely. Samples of another mode are marked as unusual and have a noise of their own:
//! they influence the function less than the others without being discarded.
//!
//! Source: [`RasmussenWilliams2006`](crate::bibliography::RasmussenWilliams2006), sections 2.2 and
//! 5.4. The regression is implemented here because the crates for it fit only one output at a time,
//! have no noise, or use the same length for all inputs; the optimiser is that of `argmin`.

use nalgebra::linalg::Cholesky;
use nalgebra::{DMatrix, DVector, Dyn};
use serde::{Deserialize, Serialize};

use crate::numerics::gaussian_process::likelihood::{Hyperparameters, Likelihood, N_VARIANCES};

/// The samples to which a Gaussian process is fitted.
#[derive(Debug, Clone, Copy)]
pub struct GaussianProcessData<'a> {
    /// Inputs, one row per sample, all of one length.
    pub inputs: &'a [Vec<f64>],
    /// Outputs, one row per sample, all of one length.
    pub outputs: &'a [Vec<f64>],
    /// Whether each sample is unusual; empty if none is.
    pub unusual: &'a [bool],
    /// Weight of each output in the likelihood of the hyperparameters; empty for a weight of 1
    /// each.
    pub weights: &'a [f64],
}

/// A fitted regression. The Cholesky factor of its covariance is not stored in files, because it
/// follows from the rest.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(into = "StoredProcess", try_from = "StoredProcess")]
pub struct GaussianProcess {
    input_scaling: Scaling,
    output_scaling: Scaling,
    /// Standardised inputs, one row per sample.
    inputs: DMatrix<f64>,
    unusual: Vec<bool>,
    hyperparameters: Hyperparameters,
    cholesky: Cholesky<f64, Dyn>,
    /// Coefficients `K⁻¹ y`, one row per sample and one column per output.
    coefficients: DMatrix<f64>,
}

/// The form of a regression in a file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredProcess {
    input_scaling: Scaling,
    output_scaling: Scaling,
    /// Standardised inputs, one row per sample.
    inputs: Vec<Vec<f64>>,
    unusual: Vec<bool>,
    /// Natural logarithms of the hyperparameters.
    hyperparameters: Vec<f64>,
    /// Coefficients `K⁻¹ y`, one row per sample.
    coefficients: Vec<Vec<f64>>,
}

/// The predicted distribution of the outputs at one input.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussianPrediction {
    /// Mean of each output.
    pub mean: Vec<f64>,
    /// Standard deviation of each output for a usual sample, noise included.
    pub std: Vec<f64>,
    /// Standard deviation of each output for an unusual sample, noise included.
    pub std_unusual: Vec<f64>,
}

/// The reason why samples cannot be fitted or an input cannot be evaluated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GaussianProcessError {
    /// There are too few samples.
    #[error("a regression on {got} samples, expected {expected} or more")]
    TooFew {
        /// Smallest number of samples.
        expected: usize,
        /// Number of samples that were given.
        got: usize,
    },
    /// The lengths of rows or lists do not agree.
    #[error("{what} has {got} entries, expected {expected}")]
    Shape {
        /// The rows or the list whose length is wrong, in words.
        what: &'static str,
        /// Number of entries that is expected.
        expected: usize,
        /// Number of entries that was given.
        got: usize,
    },
    /// A sample contains a number that is not finite.
    #[error("sample {sample_idx} holds a number that is not finite")]
    NotFinite {
        /// Index of the sample, counted from 0.
        sample_idx: usize,
    },
    /// There are more samples than the covariance of all of them is computed for.
    #[error("a regression on {got} samples, at most {limit} are taken")]
    TooMany {
        /// Largest number of samples.
        limit: usize,
        /// Number of samples that were given.
        got: usize,
    },
    /// A standard deviation in a file is negative, or a hyperparameter is out of range.
    #[error("{what} holds {value}, expected {expected}")]
    Stored {
        /// The list, in words.
        what: &'static str,
        /// The number.
        value: f64,
        /// The range, in words.
        expected: &'static str,
    },
    /// The covariance of the samples is not positive definite. This does not occur for finite data,
    /// because noise is always added.
    #[error("the covariance of the samples is not positive definite")]
    Covariance,
}

/// Smallest number of samples of a regression.
const MIN_SAMPLES: usize = 4;

/// Largest number of samples, whose covariance takes 32 MB and a few seconds to factorise.
const MAX_SAMPLES: usize = 2_000;

/// Largest magnitude of the logarithm of a hyperparameter in a file.
const MAX_LOG: f64 = 50.0;

impl GaussianProcess {
    /// Fits the hyperparameters and the coefficients to samples.
    ///
    /// # Errors
    /// [`GaussianProcessError::TooFew`] for fewer than four samples,
    /// [`GaussianProcessError::Shape`] if lengths do not agree or there is no output,
    /// [`GaussianProcessError::NotFinite`] for a value that is not finite, and
    /// [`GaussianProcessError::Covariance`] if the covariance cannot be factorised.
    pub fn fit(data: &GaussianProcessData<'_>) -> Result<Self, GaussianProcessError> {
        let n_outputs = check(data)?;
        let usual = |sample_idx: usize| !data.unusual.get(sample_idx).copied().unwrap_or(false);
        let input_scaling = Scaling::fit(data.inputs, |_| true);
        let output_scaling = Scaling::fit(data.outputs, usual);
        let inputs = input_scaling.standardise(data.inputs);
        let outputs = output_scaling.standardise(data.outputs);
        let weights = match data.weights {
            [] => vec![1.0; n_outputs],
            weights => weights.to_vec(),
        };
        let unusual: Vec<bool> = (0..inputs.nrows()).map(|idx| !usual(idx)).collect();
        let likelihood = Likelihood::new(inputs.clone(), outputs.clone(), unusual.clone(), weights);
        let hyperparameters = likelihood.maximise();
        let cholesky = hyperparameters
            .covariance(&inputs, &unusual)
            .cholesky()
            .ok_or(GaussianProcessError::Covariance)?;
        let coefficients = cholesky.solve(&outputs);
        Ok(Self {
            input_scaling,
            output_scaling,
            inputs,
            unusual,
            hyperparameters,
            cholesky,
            coefficients,
        })
    }

    /// Number of outputs.
    pub fn n_outputs(&self) -> usize {
        self.coefficients.ncols()
    }

    /// Predicts mean and standard deviation of the outputs at an input.
    ///
    /// ```text
    /// mean = kᵀ K⁻¹ y        variance = k(x, x) − kᵀ K⁻¹ k + noise
    /// ```
    ///
    /// - `input`: as long as the inputs of the samples, in their units.
    ///
    /// # Errors
    /// [`GaussianProcessError::Shape`] for an input of another length.
    pub fn predict(&self, input: &[f64]) -> Result<GaussianPrediction, GaussianProcessError> {
        let (expected, got) = (self.input_scaling.mean.len(), input.len());
        if got != expected {
            return Err(GaussianProcessError::Shape { what: "an input", expected, got });
        }
        let x = self.input_scaling.standardise(std::slice::from_ref(&input.to_vec()));
        let h = &self.hyperparameters;
        let kernel = |i: usize| h.kernel(&x.row(0), &self.inputs.row(i));
        let k = DVector::from_iterator(self.inputs.nrows(), (0..self.inputs.nrows()).map(kernel));
        let known = self.cholesky.solve(&k).dot(&k);
        let own = (h.kernel(&x.row(0), &x.row(0)) - known).max(0.0);
        let [usual, unusual] = [false, true].map(|unusual| (own + h.noise(unusual)).sqrt());
        let mean = self.coefficients.tr_mul(&k);
        let scaling = &self.output_scaling;
        let outputs = mean.iter().zip(scaling.mean.iter().zip(&scaling.std));
        let spread = |factor: f64| scaling.std.iter().map(|std| factor * std).collect();
        Ok(GaussianPrediction {
            mean: outputs.map(|(value, (mean, std))| mean + std * value).collect(),
            std: spread(usual),
            std_unusual: spread(unusual),
        })
    }
}

impl From<GaussianProcess> for StoredProcess {
    fn from(process: GaussianProcess) -> Self {
        let rows = |matrix: &DMatrix<f64>| {
            matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
        };
        Self {
            inputs: rows(&process.inputs),
            coefficients: rows(&process.coefficients),
            hyperparameters: process.hyperparameters.into_log(),
            input_scaling: process.input_scaling,
            output_scaling: process.output_scaling,
            unusual: process.unusual,
        }
    }
}

impl StoredProcess {
    /// Checks what is divided by, taken the root of, or an exponent.
    ///
    /// # Errors
    /// [`GaussianProcessError::Stored`].
    fn check_numbers(&self) -> Result<(), GaussianProcessError> {
        let refused = |value: &&f64, most: f64, least: f64| !(least..=most).contains(*value);
        let std = self.input_scaling.std.iter().chain(&self.output_scaling.std);
        let lists = [
            ("the deviations", std.copied().collect(), [0.0, f64::MAX], "0 or more"),
            ("the hyperparameters", self.hyperparameters.clone(), [-MAX_LOG, MAX_LOG], "-50 to 50"),
        ];
        for (what, values, [least, most], expected) in lists {
            let values: Vec<f64> = values;
            if let Some(&value) = values.iter().find(|value| refused(value, most, least)) {
                return Err(GaussianProcessError::Stored { what, value, expected });
            }
        }
        Ok(())
    }
}

impl TryFrom<StoredProcess> for GaussianProcess {
    type Error = GaussianProcessError;

    fn try_from(stored: StoredProcess) -> Result<Self, GaussianProcessError> {
        let data = GaussianProcessData {
            inputs: &stored.inputs,
            outputs: &stored.coefficients,
            unusual: &stored.unusual,
            weights: &[],
        };
        let n_outputs = check(&data)?;
        let n_inputs = stored.inputs.first().map_or(0, Vec::len);
        let lengths = [
            ("the means of the inputs", n_inputs, stored.input_scaling.mean.len()),
            ("the deviations of the inputs", n_inputs, stored.input_scaling.std.len()),
            ("the means of the outputs", n_outputs, stored.output_scaling.mean.len()),
            ("the deviations of the outputs", n_outputs, stored.output_scaling.std.len()),
            ("the hyperparameters", n_inputs + N_VARIANCES, stored.hyperparameters.len()),
            ("unusual", stored.inputs.len(), stored.unusual.len()),
        ];
        if let Some((what, expected, got)) = lengths.into_iter().find(|(_, a, b)| a != b) {
            return Err(GaussianProcessError::Shape { what, expected, got });
        }
        stored.check_numbers()?;
        let matrix = |rows: &[Vec<f64>], n_columns| {
            DMatrix::from_row_iterator(rows.len(), n_columns, rows.iter().flatten().copied())
        };
        let inputs = matrix(&stored.inputs, n_inputs);
        let hyperparameters = Hyperparameters::new(stored.hyperparameters);
        let covariance = hyperparameters.covariance(&inputs, &stored.unusual);
        Ok(Self {
            cholesky: covariance.cholesky().ok_or(GaussianProcessError::Covariance)?,
            coefficients: matrix(&stored.coefficients, n_outputs),
            inputs,
            hyperparameters,
            input_scaling: stored.input_scaling,
            output_scaling: stored.output_scaling,
            unusual: stored.unusual,
        })
    }
}

/// Mean and standard deviation of each column, by which values are standardised. The standardised
/// value of a column that does not vary is zero.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Scaling {
    mean: Vec<f64>,
    std: Vec<f64>,
}

impl Scaling {
    /// Computes them from the rows whose index `choose` accepts, or from all rows if it accepts
    /// fewer than two.
    fn fit(rows: &[Vec<f64>], choose: impl Fn(usize) -> bool) -> Self {
        let chosen: Vec<&Vec<f64>> =
            rows.iter().enumerate().filter(|(idx, _)| choose(*idx)).map(|(_, row)| row).collect();
        let chosen = if chosen.len() < 2 { rows.iter().collect() } else { chosen };
        let n = chosen.len() as f64;
        let n_columns = chosen.first().map_or(0, |row| row.len());
        let column = |j: usize| chosen.iter().filter_map(move |row| row.get(j));
        let mean: Vec<f64> = (0..n_columns).map(|j| column(j).sum::<f64>() / n).collect();
        let square = |j: usize, mean: f64| column(j).map(|v| (v - mean).powi(2)).sum::<f64>() / n;
        let std = mean.iter().enumerate().map(|(j, mean)| square(j, *mean).sqrt()).collect();
        Self { mean, std }
    }

    /// The standardised rows, `[sample, column]`.
    fn standardise(&self, rows: &[Vec<f64>]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), self.mean.len(), |i, j| {
            let (value, std) = (rows[i][j] - self.mean[j], self.std[j]);
            if std > 1e-12 * self.mean[j].abs() && std > 0.0 { value / std } else { 0.0 }
        })
    }
}

/// Checks the samples and returns the number of outputs.
///
/// # Errors
/// All variants of [`GaussianProcessError`] but [`GaussianProcessError::Covariance`].
fn check(data: &GaussianProcessData<'_>) -> Result<usize, GaussianProcessError> {
    let n = data.inputs.len();
    if n < MIN_SAMPLES {
        return Err(GaussianProcessError::TooFew { expected: MIN_SAMPLES, got: n });
    }
    if n > MAX_SAMPLES {
        return Err(GaussianProcessError::TooMany { limit: MAX_SAMPLES, got: n });
    }
    let width = |rows: &[Vec<f64>]| rows.first().map_or(0, Vec::len);
    let (n_inputs, n_outputs) = (width(data.inputs), width(data.outputs));
    if n_outputs == 0 {
        return Err(GaussianProcessError::Shape { what: "an output", expected: 1, got: 0 });
    }
    let optional = |got: usize, expected| if got == 0 { expected } else { got };
    let lengths = [("outputs", n, data.outputs.len())].into_iter();
    let lengths = lengths
        .chain([("unusual", n, optional(data.unusual.len(), n))])
        .chain([("weights", n_outputs, optional(data.weights.len(), n_outputs))])
        .chain(data.inputs.iter().map(|row| ("an input", n_inputs, row.len())))
        .chain(data.outputs.iter().map(|row| ("an output", n_outputs, row.len())));
    for (what, expected, got) in lengths {
        if got != expected {
            return Err(GaussianProcessError::Shape { what, expected, got });
        }
    }
    let mut rows = data.inputs.iter().zip(data.outputs);
    match rows.position(|(x, y)| x.iter().chain(y).any(|value| !value.is_finite())) {
        Some(sample_idx) => Err(GaussianProcessError::NotFinite { sample_idx }),
        None => Ok(n_outputs),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize) -> Vec<Vec<f64>> {
        (0..n).map(|i| vec![i as f64 / n as f64 * 6.0, (i * 7 % n) as f64, 5.0]).collect()
    }

    fn data<'a>(inputs: &'a [Vec<f64>], outputs: &'a [Vec<f64>]) -> GaussianProcessData<'a> {
        GaussianProcessData { inputs, outputs, unusual: &[], weights: &[] }
    }

    #[test]
    fn a_smooth_function_is_learned_and_an_idle_input_ignored() {
        let inputs = grid(40);
        let truth = |x: &[f64]| 100.0 + 20.0 * x[0].sin() + 3.0 * x[0];
        let outputs: Vec<Vec<f64>> = inputs.iter().map(|x| vec![truth(x), -truth(x)]).collect();
        let process = GaussianProcess::fit(&data(&inputs, &outputs)).unwrap();
        for x0 in [0.4, 2.2, 4.9] {
            let at = process.predict(&[x0, 11.3, 7.0]).unwrap();
            let expected = truth(&[x0]);
            assert!((at.mean[0] - expected).abs() < 0.5, "{x0}: {at:?}, expected {expected}");
            assert!((at.mean[0] + at.mean[1]).abs() < 1e-6, "{x0}: {at:?}");
        }
    }

    #[test]
    fn far_from_the_samples_it_is_less_sure() {
        let inputs: Vec<Vec<f64>> = (0..20).map(|i| vec![f64::from(i) / 10.0]).collect();
        let outputs: Vec<Vec<f64>> = inputs.iter().map(|x| vec![(3.0 * x[0]).sin()]).collect();
        let process = GaussianProcess::fit(&data(&inputs, &outputs)).unwrap();
        let [near, far] = [1.0, 6.0].map(|x| process.predict(&[x]).unwrap().std[0]);
        assert!(far > 3.0 * near, "{near} {far}");
    }

    #[test]
    fn unusual_samples_do_not_bend_the_function() {
        let inputs: Vec<Vec<f64>> = (0..40).map(|i| vec![f64::from(i) / 8.0]).collect();
        let unusual: Vec<bool> = (0..40).map(|i| i % 6 == 3).collect();
        let outputs: Vec<Vec<f64>> = inputs
            .iter()
            .zip(&unusual)
            .map(|(x, unusual)| vec![x[0].cos() + if *unusual { 8.0 } else { 0.0 }])
            .collect();
        let known = GaussianProcessData { unusual: &unusual, ..data(&inputs, &outputs) };
        let worst = |data: &GaussianProcessData<'_>| {
            let process = GaussianProcess::fit(data).unwrap();
            let off = |x: &Vec<f64>| (process.predict(x).unwrap().mean[0] - x[0].cos()).abs();
            inputs.iter().map(off).fold(0.0, f64::max)
        };
        let (with, without) = (worst(&known), worst(&data(&inputs, &outputs)));
        assert!(with < 0.3 && with < 0.5 * without, "{with} with, {without} without");
        let at = GaussianProcess::fit(&known).unwrap().predict(&[2.0]).unwrap();
        assert!(at.std_unusual[0] > 3.0 * at.std[0], "{at:?}");
    }

    #[test]
    fn a_stored_process_predicts_the_same_and_a_broken_one_is_refused() {
        let inputs = grid(12);
        let outputs: Vec<Vec<f64>> = inputs.iter().map(|x| vec![x[0].sin(), x[1]]).collect();
        let unusual: Vec<bool> = (0..12).map(|i| i == 5).collect();
        let unusual_data = GaussianProcessData { unusual: &unusual, ..data(&inputs, &outputs) };
        let process = GaussianProcess::fit(&unusual_data).unwrap();
        let text = serde_json::to_string(&process).unwrap();
        let back: GaussianProcess = serde_json::from_str(&text).unwrap();
        let at = [1.1, 4.0, 5.0];
        assert_eq!(back.predict(&at).unwrap(), process.predict(&at).unwrap());
        let broken = text.replacen("\"unusual\":[false,", "\"unusual\":[", 1);
        assert_ne!(broken, text);
        let error = serde_json::from_str::<GaussianProcess>(&broken).unwrap_err().to_string();
        assert!(error.contains("unusual has 11 entries, expected 12"), "{error}");
    }

    #[test]
    fn samples_that_do_not_fit_together_are_refused() {
        let (inputs, outputs) = (grid(6), vec![vec![1.0]; 6]);
        let refused = |data| GaussianProcess::fit(&data).unwrap_err();
        let few = refused(data(&inputs[..2], &outputs[..2]));
        assert_eq!(few, GaussianProcessError::TooFew { expected: 4, got: 2 });
        let short = refused(data(&inputs, &outputs[..5]));
        assert!(matches!(short, GaussianProcessError::Shape { what: "outputs", .. }));
        let mut bad = inputs.clone();
        bad[3][0] = f64::NAN;
        let bad = refused(data(&bad, &outputs));
        assert_eq!(bad, GaussianProcessError::NotFinite { sample_idx: 3 });
        let constant = GaussianProcess::fit(&data(&inputs, &outputs)).unwrap();
        assert!((constant.predict(&inputs[0]).unwrap().mean[0] - 1.0).abs() < 1e-9);
        assert!(constant.predict(&[1.0]).is_err());
    }
}
