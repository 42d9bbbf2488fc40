//! A trained force network and its model file.

use std::collections::BTreeMap;

use candle_core::{DType, Device, Tensor};
use serde::{Deserialize, Serialize};

use crate::force::network::{ForceDomain, ForceNetwork, OpenFeatures, Standardisation};
use crate::force::physics::{CentreModel, ResidualModel};
use crate::force::{ForceCase, ForceConfig, ForceError, ForceRecord, ForceScenario};
use crate::learning::ModelFile;
use crate::nn::{
    Checkpoint, Expected, ModelKind, NnError, Parameters, check_numbers, parameter_budget,
};
use impactlab_core::numerics::random_stream;
use impactlab_core::uncertainty::{CURVE_N_INSTANTS, ForceCurve};

/// Name of the tensor with the curves of the training cases in a model file.
const CURVES: &str = "curves";

/// A trained force network with everything that a prediction needs. It contains its training cases,
/// to which the baselines are fitted and by which known cases are recognised.
#[derive(Debug)]
pub struct ForceModel {
    pub(crate) config: ForceConfig,
    pub(crate) centre: CentreModel,
    pub(crate) residuals: ResidualModel,
    pub(crate) standardisation: Standardisation,
    /// Where the training cases lie; follows from them.
    pub(crate) domain: ForceDomain,
    pub(crate) open: OpenFeatures,
    pub(crate) network: ForceNetwork,
    pub(crate) record: ForceRecord,
    pub(crate) cases: Vec<ForceCase>,
}

/// The form of a training case in a model file, without its curve.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredCase {
    name: String,
    scenario: ForceScenario,
    mirrored: bool,
    onset_s: f64,
    hooked: bool,
    separated: bool,
    digest: String,
}

impl ForceModel {
    /// The configuration with which the model was trained.
    pub fn config(&self) -> &ForceConfig {
        &self.config
    }

    /// The record of the training.
    pub fn record(&self) -> &ForceRecord {
        &self.record
    }

    /// The training cases, including those for validation. Forces that were read from a model file
    /// have single precision.
    pub fn training_cases(&self) -> &[ForceCase] {
        &self.cases
    }

    /// The kinds of bodies of the striking vehicle that the model knows; a single empty name if the
    /// training data name none.
    pub fn bodies(&self) -> Vec<String> {
        self.centre.bodies()
    }

    /// The kinds of bodies of the struck vehicle that the model knows, with an empty name for those that
    /// the training data do not name; none where there is one kind only.
    pub fn struck_bodies(&self) -> Vec<String> {
        self.centre.struck_bodies()
    }

    /// Position of the rear axle of the struck vehicle in its body axes, m, from which contact
    /// offsets are measured.
    pub fn rear_axle_x_m(&self) -> f64 {
        self.centre.rear_axle_x_m()
    }

    /// Number of parameters of the network.
    pub fn n_parameters(&self) -> usize {
        self.network.parameters().n_values()
    }

    /// Whether the model was trained on a case with the same content, whatever its name.
    pub fn is_trained_on(&self, case: &ForceCase) -> bool {
        self.cases.iter().any(|known| known.digest == case.digest)
    }
}

impl ModelFile for ForceModel {
    const KIND: ModelKind = ModelKind { name: "force network", version: 4 };

    type Error = ForceError;

    fn put(&self, file: &mut Checkpoint) -> Result<(), ForceError> {
        file.put("config", &self.config)?;
        file.put("centre", &self.centre)?;
        file.put("residuals", &self.residuals)?;
        file.put("standardisation", &self.standardisation)?;
        file.put("open", &self.open)?;
        file.put("record", &self.record)?;
        let stored: Vec<StoredCase> = self.cases.iter().map(StoredCase::from_case).collect();
        file.put("cases", &stored)?;
        file.put_group("network", self.network.parameters().export()?);
        let values: Vec<f32> = self
            .cases
            .iter()
            .flat_map(|case| case.curve.to_values())
            .map(|value| value as f32)
            .collect();
        let shape = (self.cases.len(), 2 * CURVE_N_INSTANTS + 1);
        let curves = Tensor::from_vec(values, shape, &Device::Cpu)?;
        file.put_group("cases", BTreeMap::from([(CURVES.to_owned(), curves)]));
        Ok(())
    }

    fn take(file: &mut Checkpoint) -> Result<Self, ForceError> {
        let config: ForceConfig = file.get("config")?;
        config.check()?;
        let centre: CentreModel = file.get("centre")?;
        centre.check()?;
        let residuals: ResidualModel = file.get("residuals")?;
        residuals.check(config.network.factors)?;
        let stored: Vec<StoredCase> = file.get("cases")?;
        let n_bodies = [centre.bodies().len(), centre.struck_bodies().len()];
        let standardisation: Standardisation = file.get("standardisation")?;
        standardisation.check(n_bodies)?;
        let open: OpenFeatures = file.get("open")?;
        open.check(n_bodies)?;
        let [n_striking, n_struck] = n_bodies;
        let n_kinds = n_striking.saturating_mul(n_struck.max(1));
        let n_variants = open.contact_m.len().saturating_mul(n_kinds);
        config.network.check_memory("variants", n_variants)?;
        let record: ForceRecord = file.get("record")?;
        record.detail.variance_factors.check("record.variance_factors")?;
        let mut rng = random_stream(0, "force network", 0);
        let tensors = file.take_group("network");
        let parameters = Parameters::new(DType::F32).at_most(parameter_budget(&tensors));
        let n_more = n_striking + n_struck + standardisation.n_turning();
        let network = ForceNetwork::new(&config.network, n_more, &mut rng, parameters)?;
        network.parameters().import(&tensors)?;
        let missing = || NnError::MissingTensor { name: format!("cases.{CURVES}") };
        let curves = file.take_group("cases").remove(CURVES).ok_or_else(missing)?;
        let expected = [stored.len(), 2 * CURVE_N_INSTANTS + 1];
        if curves.dims() != expected {
            return Err(ForceError::from(NnError::WrongShape {
                name: format!("cases.{CURVES}"),
                expected: expected.to_vec(),
                got: curves.dims().to_vec(),
            }));
        }
        for (i, case) in stored.iter().enumerate() {
            let name = format!("cases[{i}].scenario.mass_kg");
            check_numbers(&name, &case.scenario.mass_kg, Expected::Positive)?;
        }
        let rows = curves.to_dtype(DType::F64)?.to_vec2::<f64>()?;
        let cases = stored.into_iter().zip(rows).map(|(case, row)| case.with_curve(&row));
        let cases: Vec<ForceCase> = cases.collect();
        Ok(Self {
            domain: ForceDomain::from_cases(&standardisation, &cases),
            standardisation,
            open,
            record,
            cases,
            config,
            centre,
            residuals,
            network,
        })
    }
}

impl StoredCase {
    fn from_case(case: &ForceCase) -> Self {
        Self {
            name: case.name.clone(),
            scenario: case.scenario.clone(),
            mirrored: case.mirrored,
            onset_s: case.onset_s,
            hooked: case.hooked,
            separated: case.separated,
            digest: case.digest.clone(),
        }
    }

    fn with_curve(self, values: &[f64]) -> ForceCase {
        let curve = ForceCurve::from_values(values);
        let (peak_n, peak_time_s) = curve.peak();
        ForceCase {
            name: self.name,
            scenario: self.scenario,
            mirrored: self.mirrored,
            onset_s: self.onset_s,
            impulse_n_s: curve.impulse_n_s(),
            peak_n,
            peak_time_s,
            hooked: self.hooked,
            separated: self.separated,
            digest: self.digest,
            curve,
        }
    }
}
