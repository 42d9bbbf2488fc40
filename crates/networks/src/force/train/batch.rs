//! Converts cases to tensors for the training of the force network.

use candle_core::{DType, Device, Tensor};

use crate::force::network::{N_INSTANT_FEATURES, NetworkInput, instant_features};
use crate::force::physics::{CentreCurve, DURATION_UNIT_S, ResidualModel};
use crate::force::train::loss::Targets;
use crate::force::{ForceCase, ForceError, NetworkConfig};
use impactlab_core::uncertainty::CURVE_N_INSTANTS;

/// All cases of a training as tensors, from which batches are selected.
#[derive(Debug, Clone)]
pub(crate) struct CaseTensors {
    input: NetworkInput,
    targets: Targets,
}

/// Computes the inputs of the network for scenarios.
///
/// - `centres`, `residuals`: the physics of each scenario, and the distribution of its residuals
///   with which the components start. The last of several components starts with the residuals of
///   hooking cases.
/// - `features`: standardised features, one row per centre.
/// - `config`, `number_type`: number of components and latent factors, and number type of the
///   tensors.
///
/// # Errors
/// [`ForceError::Learning`] if a tensor operation fails.
pub(crate) fn network_input(
    centres: &[CentreCurve],
    residuals: &ResidualModel,
    features: Vec<Vec<f32>>,
    config: &NetworkConfig,
    number_type: DType,
) -> Result<NetworkInput, ForceError> {
    let n = centres.len();
    let (k, q, n_values) = (config.components, config.factors, 2 * CURVE_N_INSTANTS + 1);
    let width = features.first().map_or(0, Vec::len);
    let tensor = |data: Vec<f32>, shape: &[usize]| -> Result<Tensor, ForceError> {
        Ok(Tensor::from_vec(data, shape, &Device::Cpu)?.to_dtype(number_type)?)
    };
    let instants = centres.iter().flat_map(instant_features).collect();
    let whole = centres.iter().flat_map(|centre| {
        let [px, py] = centre.impulse_n_s.map(|p| (p / centre.scale_n) as f32);
        [px, py, centre.curve.duration_s as f32, centre.onset_s() as f32]
    });
    let (mut start, mut lag) = ([const { Vec::<f32>::new() }; 3], Vec::new());
    for centre in centres {
        let curves = [false, true].map(|hooks| residuals.curve(centre, hooks));
        for component in 0..k {
            let curve = &curves[usize::from(k > 1 && component + 1 == k)];
            for (all, values) in
                start.iter_mut().zip([&curve.mean, &curve.variance, &curve.factors])
            {
                all.extend(values.iter().map(|value| *value as f32));
            }
            lag.push(curve.lag_correlation as f32);
        }
    }
    let [shift, variance, factors] = start;
    Ok(NetworkInput {
        features: tensor(features.concat(), &[n, width])?,
        instants: tensor(instants, &[n, CURVE_N_INSTANTS, N_INSTANT_FEATURES])?,
        whole: tensor(whole.collect(), &[n, 4])?,
        shift: tensor(shift, &[n, k, n_values])?,
        variance: tensor(variance, &[n, k, n_values])?,
        lag_correlation: tensor(lag, &[n, k])?,
        factors: (q > 0).then(|| tensor(factors, &[n, k, n_values, q])).transpose()?,
    })
}

impl CaseTensors {
    /// Converts cases to tensors. The arguments are those of [`network_input`], for the same cases
    /// in the same order.
    ///
    /// # Errors
    /// [`ForceError::Learning`] if a tensor operation fails.
    pub(crate) fn new(
        cases: &[&ForceCase],
        centres: &[CentreCurve],
        residuals: &ResidualModel,
        features: Vec<Vec<f32>>,
        config: &NetworkConfig,
        number_type: DType,
    ) -> Result<Self, ForceError> {
        let n = cases.len();
        let tensor = |data: Vec<f64>, shape: &[usize]| -> Result<Tensor, ForceError> {
            Ok(Tensor::from_vec(data, shape, &Device::Cpu)?.to_dtype(number_type)?)
        };
        let pairs = || cases.iter().zip(centres);
        let values: Vec<f64> = pairs()
            .flat_map(|(case, centre)| {
                let forces = case.curve.fx_n.iter().chain(&case.curve.fy_n);
                let duration = case.curve.duration_s / DURATION_UNIT_S;
                forces.map(|f| f / centre.scale_n).chain([duration]).collect::<Vec<f64>>()
            })
            .collect();
        let impulse =
            pairs().flat_map(|(case, centre)| case.impulse_n_s.map(|p| p / centre.scale_n));
        let inverse_mass = centres.iter().flat_map(|centre| {
            let [[a, b], [c, d]] = centre.inverse_mass_1_kg;
            [a, b, c, d].map(|k| k * centre.scale_n)
        });
        let hooked = cases.iter().map(|case| f64::from(u8::from(case.hooked)));
        let closing = centres.iter().flat_map(|centre| centre.closing_velocity_m_s);
        let targets = Targets {
            values: tensor(values, &[n, 2 * CURVE_N_INSTANTS + 1])?,
            impulse: tensor(impulse.collect(), &[n, 2])?,
            hooked: tensor(hooked.collect(), &[n])?,
            closing: tensor(closing.collect(), &[n, 2])?,
            inverse_mass: tensor(inverse_mass.collect(), &[n, 2, 2])?,
        };
        let input = network_input(centres, residuals, features, config, number_type)?;
        Ok(Self { input, targets })
    }

    /// Selects cases by their indices, in the order of the indices.
    ///
    /// # Errors
    /// [`ForceError::Learning`] if a tensor operation fails.
    pub(crate) fn select(&self, indices: &[usize]) -> Result<(NetworkInput, Targets), ForceError> {
        let indices: Vec<u32> = indices.iter().map(|i| *i as u32).collect();
        let indices = Tensor::new(indices, &Device::Cpu)?;
        let pick = |tensor: &Tensor| tensor.index_select(&indices, 0);
        let input = NetworkInput {
            features: pick(&self.input.features)?,
            instants: pick(&self.input.instants)?,
            whole: pick(&self.input.whole)?,
            shift: pick(&self.input.shift)?,
            variance: pick(&self.input.variance)?,
            lag_correlation: pick(&self.input.lag_correlation)?,
            factors: self.input.factors.as_ref().map(pick).transpose()?,
        };
        let targets = Targets {
            values: pick(&self.targets.values)?,
            impulse: pick(&self.targets.impulse)?,
            hooked: pick(&self.targets.hooked)?,
            closing: pick(&self.targets.closing)?,
            inverse_mass: pick(&self.targets.inverse_mass)?,
        };
        Ok((input, targets))
    }
}
