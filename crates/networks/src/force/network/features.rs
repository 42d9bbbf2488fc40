//! The inputs of the network: numbers that describe a scenario and its physics.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::force::physics::{Bodies, CentreCurve};
use crate::force::{ForceCase, ForceScenario};
use crate::nn::{Expected, NnError, check_length, check_number, check_numbers};
use impactlab_core::uncertainty::{CURVE_N_INSTANTS, Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};

/// Names of the scenario's features as shown to the user, with units.
pub(super) const SCENARIO_NAMES: [&str; N_SCENARIO + N_TURNING] = [
    "mass of the struck vehicle [kg]",
    "mass of the striking vehicle [kg]",
    "speed of the striking over the struck vehicle, along [m/s]",
    "speed of the striking over the struck vehicle, across [m/s]",
    "heading of the striking vehicle [rad]",
    "contact x [m]",
    "yaw rate of the struck vehicle before the impact [rad/s]",
    "yaw rate of the striking vehicle before the impact [rad/s]",
];
/// Number of features of a scenario in which nothing turns.
pub(super) const N_SCENARIO: usize = 6;
/// Number of features by which vehicles that turn are described. Only a model that has learned from such
/// vehicles has them, after all others.
pub(super) const N_TURNING: usize = 2;
/// Number of features of the scenario's physics.
const N_PHYSICS: usize = 6;
/// Number of features of a scenario besides one for each kind of body of either vehicle and those of
/// turning.
pub(crate) const N_FEATURES: usize = N_SCENARIO + N_PHYSICS;
/// Number of features of each instant.
pub(crate) const N_INSTANT_FEATURES: usize = 6;

/// Largest number of contact points of a model, each of which a prediction computes.
const MAX_OPEN_CONTACTS: f64 = 100.0;

/// Units in which crush depth and sliding velocity enter the network.
const DEPTH_UNIT_M: f64 = 0.1;
const SLIP_UNIT_M_S: f64 = 2.0;

/// Mean, deviation and range of every feature over the training cases.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Standardisation {
    /// Mean of each feature.
    pub mean: Vec<f64>,
    /// Standard deviation of each feature; 1 where all are alike.
    pub std: Vec<f64>,
    /// Lowest and highest value of each feature of the scenario.
    pub range: Vec<[f64; 2]>,
}

/// A feature of a scenario that lies outside the range of the training cases.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct OutsideTraining {
    /// Name and unit of the feature in the canonical scenario: striking vehicle on the right,
    /// velocities relative to the struck vehicle.
    pub feature: &'static str,
    /// Its value.
    pub value: f64,
    /// Lowest and highest value in training.
    pub range: [f64; 2],
    /// Distance from the range in standard deviations of the training cases.
    pub deviations: f64,
}

impl OutsideTraining {
    /// The caveat that names the feature.
    pub(crate) fn caveat(&self) -> Caveat {
        let [low, high] = self.range;
        let text = Phrase::new(
            "{0} is {1}, trained on {2} to {3}: {4} standard deviations outside",
            "{0} beträgt {1}; das Kraftnetz wurde mit {2} bis {3} trainiert: {4} Standardabweichungen \
             außerhalb",
        )
        .with(PhraseValue::Heading(self.feature.to_owned()))
        .with(PhraseValue::of_named(self.feature, self.value))
        .with(PhraseValue::of_named(self.feature, low))
        .with(PhraseValue::of_named(self.feature, high))
        .with(PhraseValue::three_digits(Quantity::Ratio, self.deviations));
        Caveat::new(CaveatKind::OutsideDomain, text)
            .with_value(self.feature, self.value)
            .with_range(self.range)
    }
}

/// The features of a canonical scenario: its numbers, then its physics, then the bodies of the striking and
/// of the struck vehicle, then the yaw rates.
///
/// - `n_bodies`: kinds of bodies of the striking and of the struck vehicle; of the latter 0 where there is
///   one only.
pub(crate) fn features(
    scenario: &ForceScenario,
    centre: &CentreCurve,
    contact_m: [f64; 2],
    bodies: Bodies,
    n_bodies: [usize; 2],
) -> Vec<f64> {
    let numbers = scenario_numbers(scenario, contact_m);
    let [px, py] = centre.impulse_n_s;
    let [mx, my] = centre.momentum_impulse_n_s;
    let size = px.hypot(py).max(1.0);
    let physics = [
        size.ln(),
        px.atan2(py),
        (mx.hypot(my).max(1.0) / size).ln(),
        centre.curve.duration_s.max(1e-3).ln(),
        centre.scale_n.max(1.0).ln(),
        centre.curve.peak().1,
    ];
    let [n_striking, n_struck] = n_bodies;
    let is = |is_it: bool| f64::from(u8::from(is_it));
    let striking = (0..n_striking).map(|i| is(i == bodies.striking));
    let struck = (0..n_struck).map(|i| is(Some(i) == bodies.struck));
    let numbers = &numbers[..N_SCENARIO];
    let all = numbers.iter().copied().chain(physics).chain(striking).chain(struck);
    all.chain(scenario.yaw_rate_rad_s).collect()
}

pub(super) fn scenario_numbers(
    scenario: &ForceScenario,
    [contact_x, _]: [f64; 2],
) -> [f64; N_SCENARIO + N_TURNING] {
    let [vx, vy] = scenario.relative_velocity_m_s();
    let [struck_mass, striking_mass] = scenario.mass_kg;
    let [struck_yaw_rate, striking_yaw_rate] = scenario.yaw_rate_rad_s;
    [
        struck_mass,
        striking_mass,
        vx,
        vy,
        scenario.theta_b_rad,
        contact_x,
        struck_yaw_rate,
        striking_yaw_rate,
    ]
}

/// The features of each instant, row by row, `[CURVE_N_INSTANTS, N_INSTANT_FEATURES]`.
pub(crate) fn instant_features(centre: &CentreCurve) -> Vec<f32> {
    let size = centre.impulse_n_s[0].hypot(centre.impulse_n_s[1]).max(1.0);
    let magnitude = centre.curve.magnitude_n();
    let mut impulse = 0.0;
    (0..CURVE_N_INSTANTS)
        .flat_map(|t| {
            impulse += magnitude[t] * 1e-3 / size;
            [
                centre.curve.fx_n[t] / centre.scale_n,
                centre.curve.fy_n[t] / centre.scale_n,
                centre.depth_m[t] / DEPTH_UNIT_M,
                (centre.slip_m_s[t] / SLIP_UNIT_M_S).tanh(),
                impulse,
                (t as f64 + 0.5) * 1e-3 / centre.curve.duration_s.max(1e-3) - 0.5,
            ]
            .map(|value| value as f32)
        })
        .collect()
}

impl Standardisation {
    /// Checks the statistics from a file.
    ///
    /// # Errors
    /// [`NnError`] with the first number or list that is refused.
    pub(crate) fn check(&self, [n_striking, n_struck]: [usize; 2]) -> Result<(), NnError> {
        let n_turning = self.n_turning();
        let n_features = N_FEATURES + n_striking + n_struck + n_turning;
        check_length("standardisation.mean", self.mean.len(), n_features)?;
        check_length("standardisation.std", self.std.len(), n_features)?;
        check_length("standardisation.range", self.range.len(), N_SCENARIO + n_turning)?;
        check_numbers("standardisation.std", &self.std, Expected::Positive)
    }

    /// Number of features of turning: none for a model that has not learned from vehicles that turn.
    pub(crate) fn n_turning(&self) -> usize {
        if self.range.len() > N_SCENARIO { N_TURNING } else { 0 }
    }

    /// Statistics over the training cases.
    ///
    /// - `rows`: their features, all of one length. Those of turning are left out where none turns.
    pub(crate) fn from_rows(rows: &[Vec<f64>]) -> Self {
        let n = rows.len().max(1) as f64;
        let width = rows.first().map_or(0, Vec::len);
        let of_turning = width.saturating_sub(N_TURNING)..width;
        let turns = |row: &Vec<f64>| row.iter().skip(of_turning.start).any(|rate| *rate != 0.0);
        let width = if rows.iter().any(turns) { width } else { of_turning.start };
        let column = |i: usize| rows.iter().filter_map(move |row| row.get(i).copied());
        let mean: Vec<f64> = (0..width).map(|i| column(i).sum::<f64>() / n).collect();
        let std = (0..width).map(|i| {
            let variance = column(i).map(|x| (x - mean[i]).powi(2)).sum::<f64>() / n;
            if variance.sqrt() > 1e-9 * (1.0 + mean[i].abs()) { variance.sqrt() } else { 1.0 }
        });
        let range = (0..N_SCENARIO.min(width)).chain(of_turning.filter(|i| *i < width)).map(|i| {
            let low = column(i).fold(f64::INFINITY, f64::min);
            [low, column(i).fold(f64::NEG_INFINITY, f64::max)]
        });
        let (std, range) = (std.collect(), range.collect());
        Self { mean, std, range }
    }

    /// (x − mean) / deviation, without the features that the training cases have not.
    pub(crate) fn apply(&self, row: &[f64]) -> Vec<f32> {
        let scaled = row.iter().zip(&self.mean).zip(&self.std);
        scaled.map(|((x, mean), std)| ((x - mean) / std) as f32).collect()
    }
}

/// Distributions of contact point and kinds of bodies over the training cases, for scenarios that leave
/// them open.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OpenFeatures {
    /// Contact points of equal probability, body axes of the struck vehicle, canonical, m.
    pub contact_m: Vec<[f64; 2]>,
    /// Probability of each body of the striking vehicle.
    pub body: Vec<f64>,
    /// Probability of each body of the struck vehicle; none where there is one kind only.
    #[serde(default, rename = "target_body", skip_serializing_if = "Vec::is_empty")]
    pub struck_body: Vec<f64>,
}

impl OpenFeatures {
    /// Checks the distribution from a file.
    ///
    /// # Errors
    /// [`NnError`] with the first number or list that is refused.
    pub(crate) fn check(&self, n_bodies: [usize; 2]) -> Result<(), NnError> {
        let lists = [("open.body", &self.body), ("open.target_body", &self.struck_body)];
        for ((name, shares), n) in lists.into_iter().zip(n_bodies) {
            check_length(name, shares.len(), n)?;
            check_numbers(name, shares, Expected::Share)?;
            if n > 1 {
                check_number(&format!("{name} (sum)"), shares.iter().sum(), Expected::Positive)?;
            }
        }
        let n_contacts = self.contact_m.len() as f64;
        check_number("open.contact_m (number)", n_contacts, Expected::Magnitude(MAX_OPEN_CONTACTS))
    }

    /// The distribution over the training cases: contacts at the middles of `n_contacts` equal
    /// shares of the cases ordered by x, bodies by frequency.
    ///
    /// - `bodies`: kinds of bodies of the striking and of the struck vehicle.
    pub(crate) fn from_cases(
        cases: &[ForceCase],
        bodies: [&[String]; 2],
        n_contacts: usize,
    ) -> Self {
        let mut contacts: Vec<[f64; 2]> =
            cases.iter().filter_map(|case| case.scenario.contact_m).collect();
        contacts.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let n = contacts.len();
        let n_contacts = n_contacts.min(n);
        let contact_m = (0..n_contacts)
            .filter_map(|i| contacts.get((2 * i + 1) * n / (2 * n_contacts)).copied())
            .collect();
        let shares = |names: &[String], of: fn(&ForceScenario) -> &Option<String>| {
            let share = |name: &String| {
                let is_it =
                    |case: &&ForceCase| of(&case.scenario).as_deref().unwrap_or_default() == name;
                cases.iter().filter(is_it).count() as f64 / cases.len().max(1) as f64
            };
            names.iter().map(share).collect()
        };
        let [striking, struck] = bodies;
        Self {
            contact_m,
            body: shares(striking, |scenario| &scenario.striking_body),
            struck_body: shares(struck, |scenario| &scenario.struck_body),
        }
    }
}
