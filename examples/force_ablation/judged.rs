//! How well a model predicted a case, and how two models differ on the same cases.

use std::collections::BTreeMap;

use impactlab_core::numerics::Summary;
use impactlab_networks::force::metrics::{
    BAND_LEVELS, PointErrors, ProbabilisticScores, ProbabilisticSettings,
};
use impactlab_networks::force::{CurvePrediction, ForceCase, ForceModel, ForceScenario};
use serde::{Deserialize, Serialize};

use crate::{Answer, told};

/// Number of curves drawn from a prediction to compute its probabilistic scores, and their seed.
pub const N_DRAWS: usize = 500;
const DRAW_SEED: u64 = 0;
/// Place of the level of the intervals among [`BAND_LEVELS`]: 90 %.
pub const LEVEL: usize = 2;

/// How well a model predicted a case that it has not seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JudgedCase {
    /// Digest of the case.
    pub digest: String,
    /// Whether the vehicles separate without hooking.
    pub is_clean: bool,
    pub errors: PointErrors,
    /// What 90 % intervals hold: share of F(t), impulse, peak, duration.
    pub held: [f64; 4],
    pub crps_force_n: f64,
    pub nll_nats: f64,
}

impl JudgedCase {
    /// - `stream`: number of the random stream of the draws.
    pub fn new(
        model: &ForceModel,
        case: &ForceCase,
        is_theta_alone: bool,
        stream: u64,
    ) -> Answer<Self> {
        let scenario = match is_theta_alone {
            false => case.scenario.clone(),
            true => ForceScenario {
                contact_m: None,
                striking_position_m: None,
                striking_body: None,
                struck_body: None,
                ..case.scenario.clone()
            },
        };
        let predicted = model.predict(&scenario).map_err(told)?;
        let settings = ProbabilisticSettings { n_samples: N_DRAWS, seed: DRAW_SEED };
        let scores = ProbabilisticScores::new(case, &predicted.mixture, settings, stream);
        let scores = scores.map_err(told)?;
        let prediction = CurvePrediction::from_mixture(predicted.mixture, &predicted.likely);
        let quantities = [scores.force_n, scores.impulse_n_s, scores.peak_n, scores.duration_s];
        let judged = Self {
            digest: case.digest.clone(),
            is_clean: case.is_clean(),
            errors: PointErrors::new(case, &prediction),
            held: quantities.map(|held| held.share[LEVEL]),
            crps_force_n: scores.crps_force_n,
            nll_nats: scores.nll_nats,
        };
        match QUANTITIES.iter().find(|quantity| !(quantity.of)(&judged).is_finite()) {
            Some(quantity) => Err(format!("case {}: {} is not finite", case.name, quantity.name)),
            None => Ok(judged),
        }
    }
}

/// Level of the intervals, %.
pub fn level_percent() -> f64 {
    100.0 * BAND_LEVELS[LEVEL]
}

/// A quantity by which models are compared.
pub struct Quantity {
    /// Its name with its unit.
    pub name: &'static str,
    /// Whether only cases count in which the vehicles separate without hooking.
    pub of_clean: bool,
    pub of: fn(&JudgedCase) -> f64,
}

/// Errors and scores, the smaller the better.
pub static QUANTITIES: [Quantity; 6] = [
    Quantity { name: "history [%]", of_clean: true, of: |case| 100.0 * case.errors.history_error },
    Quantity { name: "impulse [%]", of_clean: true, of: |case| 100.0 * case.errors.impulse_error },
    Quantity { name: "peak [%]", of_clean: true, of: |case| 100.0 * case.errors.peak_error },
    Quantity {
        name: "duration [%]",
        of_clean: true,
        of: |case| 100.0 * case.errors.duration_error,
    },
    Quantity { name: "CRPS [kN]", of_clean: false, of: |case| case.crps_force_n / 1e3 },
    Quantity { name: "NLL [nats]", of_clean: false, of: |case| case.nll_nats },
];

/// The cases that a row predicted, by seed of the training and digest.
pub type Judged<'a> = BTreeMap<(u64, &'a str), &'a JudgedCase>;

/// A mean with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    pub value: f64,
    /// From the spread over cases and over seeds; over cases alone with one seed.
    pub standard_error: f64,
}

/// Mean of a quantity over cases and seeds; `None` without a case.
pub fn mean(judged: &Judged<'_>, quantity: &Quantity) -> Option<f64> {
    let counted = judged.values().filter(|case| case.is_clean || !quantity.of_clean);
    Some(Summary::from_values(counted.map(|case| (quantity.of)(case)))?.mean)
}

/// How much larger a quantity is than that of another row on the same cases with the same seeds.
/// `None` with fewer than two cases.
pub fn difference(of: &Judged<'_>, other: &Judged<'_>, quantity: &Quantity) -> Option<Mean> {
    let (mut by_case, mut by_seed) = (BTreeMap::new(), BTreeMap::new());
    for (key, case) in of.iter().filter(|(_, case)| case.is_clean || !quantity.of_clean) {
        let Some(other) = other.get(key) else { continue };
        let difference = (quantity.of)(case) - (quantity.of)(other);
        by_case.entry(key.1).or_insert_with(Vec::new).push(difference);
        by_seed.entry(key.0).or_insert_with(Vec::new).push(difference);
    }
    let over_cases = of_means(by_case.into_values())?;
    let over_seeds = of_means(by_seed.into_values())?;
    if over_cases.n < 2 {
        return None;
    }
    let error = |of: Summary| of.std / (of.n as f64).sqrt();
    let standard_error = error(over_cases).hypot(error(over_seeds));
    Some(Mean { value: over_cases.mean, standard_error })
}

fn of_means(groups: impl Iterator<Item = Vec<f64>>) -> Option<Summary> {
    Summary::from_values(groups.map(|group| group.iter().sum::<f64>() / group.len() as f64))
}
