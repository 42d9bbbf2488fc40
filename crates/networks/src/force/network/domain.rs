//! Where a scenario lies among the training cases of a network, and how far it may be trusted there.
//!
//! ```text
//! u = max(d / d₀ − 1, x − x₀, 0)          a = (1 − u)² (1 + 2 u), 0 from u = 1 on
//! ```
//!
//! d is the mean distance to the three nearest training cases in the space of the scenario's features,
//! each in standard deviations of the training cases, and d₀ the largest such distance of a training
//! case from the others; x is how far the features lie beyond the ranges of training, in standard
//! deviations, over all features. So a training case that is left out has a = 1, as have scenarios
//! among the training cases, and one that lies x₀ and a standard deviation outside has a = 0. The
//! cases fill a box nearly evenly, of 3.5 standard deviations a side.
//!
//! The direction of the contact normal is one more feature. All training cases are blows against the
//! side. A feature that is alike in all training cases has a twentieth of itself for its deviation, a yaw
//! rate that is alike in all of them one that moves the contact points as fast as a deviation of the
//! relative velocity: the physics knows the yaw rates even where the network does not.

use crate::force::network::features::{N_SCENARIO, N_TURNING, SCENARIO_NAMES, Standardisation};
use crate::force::network::features::{OutsideTraining, scenario_numbers};
use crate::force::{ForceCase, ForceScenario};

/// Number of nearest training cases whose mean distance counts.
const N_NEAREST: usize = 3;
/// x₀, the distance beyond the ranges within which the network is trusted fully: a tenth of a range
/// that is filled evenly.
const SLACK: f64 = 1.0 / 3.0;
/// Standard deviation that stands for that of a feature which is alike in all training cases, as a
/// share of the feature.
const CONSTANT_SHARE: f64 = 0.05;
/// Name of the direction of the normal among the features.
const NORMAL_NAME: &str = "contact normal from across the struck vehicle [rad]";
/// Index of the striking vehicle's heading, whose deviation is the unit of the normal as well:
/// turning either turns the blow.
const THETA_IDX: usize = 4;

/// Name of the distance from the training cases among the features.
const DISTANCE_NAME: &str = "relative distance from the nearest training cases";
/// Index of the velocity across the struck vehicle.
const CLOSING_IDX: usize = 3;
/// Numbers by which scenarios are compared, the yaw rates last.
const N_NUMBERS: usize = N_SCENARIO + N_TURNING;
/// From a vehicle's CG to where it touches, m.
const USUAL_ARM_M: f64 = 2.0;

/// The training cases of a network as points in the space of the scenario's features.
#[derive(Debug, Clone)]
pub(crate) struct ForceDomain {
    mean: [f64; N_NUMBERS],
    scale: [f64; N_NUMBERS],
    range: [[f64; 2]; N_NUMBERS],
    points: Vec<[f64; N_NUMBERS]>,
    /// d₀.
    spacing: f64,
}

impl ForceDomain {
    /// The domain of a network.
    ///
    /// - `standardisation`: of the network's features;
    /// - `cases`: the training cases. Those without contact point are left out.
    pub(crate) fn from_cases(standardisation: &Standardisation, cases: &[ForceCase]) -> Self {
        let at = |values: &[f64], i: usize| values.get(i).copied().unwrap_or(0.0);
        let indices: [usize; N_NUMBERS] = std::array::from_fn(|i| i);
        // The features of turning, where a model has them, are its last ones.
        let n_features = standardisation.mean.len();
        let feature = |i: usize| match i < N_SCENARIO {
            true => i,
            false if standardisation.n_turning() > 0 => n_features - N_NUMBERS + i,
            false => n_features,
        };
        let mean = indices.map(|i| at(&standardisation.mean, feature(i)));
        let range = indices.map(|i| standardisation.range.get(i).copied().unwrap_or([0.0; 2]));
        let is_varied = |i: usize| range[i][1] - range[i][0] > tolerance(range[i][1]);
        let std = |i: usize| at(&standardisation.std, feature(i));
        let scale = indices.map(|i| match is_varied(i) {
            true => std(i),
            false if i >= N_SCENARIO && is_varied(CLOSING_IDX) => std(CLOSING_IDX) / USUAL_ARM_M,
            false => CONSTANT_SHARE * mean[i].abs().max(1.0),
        });
        let mut domain = Self { mean, scale, range, points: Vec::new(), spacing: 0.0 };
        let point = |case: &ForceCase| Some(domain.point(&case.scenario, case.scenario.contact_m?));
        domain.points = cases.iter().filter_map(point).collect();
        let left_out = |point| nearest(point, &domain.points, 1);
        domain.spacing = domain.points.iter().map(left_out).fold(0.0, f64::max);
        domain
    }

    /// Mean distance of a training case from the three nearest of the others, in standard deviations.
    pub(crate) fn distance_of_case(&self, case: &ForceCase) -> f64 {
        let point = self.point(&case.scenario, case.scenario.contact_m.unwrap_or_default());
        nearest(&point, &self.points, 1)
    }

    /// Mean distance of a canonical scenario from the three nearest training cases, in standard
    /// deviations.
    ///
    /// - `contact_m`: its contact point, or one that is tried.
    pub(crate) fn distance(&self, scenario: &ForceScenario, contact_m: [f64; 2]) -> f64 {
        nearest(&self.point(scenario, contact_m), &self.points, 0)
    }

    /// Applicability a of the network, 0 to 1.
    ///
    /// - `scenario`: canonical;
    /// - `contact_m`: its contact point, or one that is tried.
    pub(crate) fn applicability(&self, scenario: &ForceScenario, contact_m: [f64; 2]) -> f64 {
        let numbers = scenario_numbers(scenario, contact_m);
        let beyond = |i: usize| (beyond(numbers[i], self.range[i]) / self.scale[i]).powi(2);
        let normal = scenario.normal_turn_rad() / self.scale[THETA_IDX];
        let outside = ((0..N_NUMBERS).map(beyond).sum::<f64>() + normal * normal).sqrt();
        let far = self.spacings_away(scenario, contact_m) - 1.0;
        let u = far.max(outside - SLACK).clamp(0.0, 1.0);
        (1.0 - u).powi(2) * (1.0 + 2.0 * u)
    }

    /// d / d₀ of a scenario; 1 where d₀ is 0.
    fn spacings_away(&self, scenario: &ForceScenario, contact_m: [f64; 2]) -> f64 {
        let distance = self.distance(scenario, contact_m);
        if self.spacing > 0.0 { distance / self.spacing } else { 1.0 }
    }

    /// The features of a canonical scenario that lie outside the range of the training cases; where none
    /// does and no training case is near, the distance. Features that the scenario leaves open are never
    /// listed.
    pub(crate) fn outside(&self, scenario: &ForceScenario) -> Vec<OutsideTraining> {
        let numbers = scenario_numbers(scenario, scenario.contact_m.unwrap_or([f64::NAN; 2]));
        let check = |i: usize| {
            let (value, range) = (numbers[i], self.range[i]);
            let beyond = beyond(value, range);
            (beyond > tolerance(range[1])).then(|| OutsideTraining {
                feature: SCENARIO_NAMES[i],
                value,
                range,
                deviations: beyond / self.scale[i],
            })
        };
        let turn = scenario.normal_turn_rad();
        let normal = (turn.abs() > tolerance(0.0)).then(|| OutsideTraining {
            feature: NORMAL_NAME,
            value: turn,
            range: [0.0; 2],
            deviations: turn.abs() / self.scale[THETA_IDX],
        });
        let mut outside: Vec<_> = (0..N_NUMBERS).filter_map(check).chain(normal).collect();
        let away = scenario.contact_m.map_or(0.0, |contact| self.spacings_away(scenario, contact));
        if outside.is_empty() && away > 1.0 {
            outside.push(OutsideTraining {
                feature: DISTANCE_NAME,
                value: away,
                range: [0.0, 1.0],
                deviations: (away - 1.0) * self.spacing,
            });
        }
        outside
    }

    fn point(&self, scenario: &ForceScenario, contact_m: [f64; 2]) -> [f64; N_NUMBERS] {
        let numbers = scenario_numbers(scenario, contact_m);
        std::array::from_fn(|i| (numbers[i] - self.mean[i]) / self.scale[i])
    }
}

/// How far a value lies beyond a range; zero inside and for a value that is not a number.
fn beyond(value: f64, [low, high]: [f64; 2]) -> f64 {
    (low - value).max(value - high).max(0.0)
}

/// A range that was never varied allows for rounding.
fn tolerance(high: f64) -> f64 {
    1e-6 * (1.0 + high.abs())
}

/// Mean distance to the nearest points; zero if there is none.
///
/// - `n_own`: how many of the points are this one.
fn nearest(point: &[f64; N_NUMBERS], others: &[[f64; N_NUMBERS]], n_own: usize) -> f64 {
    let square = |other: &[f64; N_NUMBERS]| {
        point.iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
    };
    let mut distances: Vec<f64> = others.iter().map(|other| square(other).sqrt()).collect();
    distances.sort_by(f64::total_cmp);
    let near = distances.get(n_own..).unwrap_or_default();
    let near = near.get(..N_NEAREST).unwrap_or(near);
    near.iter().sum::<f64>() / near.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::force::input::shipped;

    fn standardisation(cases: &[ForceCase]) -> Standardisation {
        let row = |case: &ForceCase| {
            scenario_numbers(&case.scenario, case.scenario.contact_m.unwrap()).to_vec()
        };
        Standardisation::from_rows(&cases.iter().map(row).collect::<Vec<_>>())
    }

    fn domain(cases: &[ForceCase]) -> ForceDomain {
        ForceDomain::from_cases(&standardisation(cases), cases)
    }

    /// Five folds of both data sets: cases that a domain has not seen lie within it, with 1 for nearly
    /// all of them.
    #[test]
    fn training_cases_that_are_left_out_lie_in_the_domain() {
        let cases = [shipped("fea"), shipped("fea-wide")].concat();
        let mut applicability = Vec::new();
        for fold in 0..5 {
            let is_test = |i: &usize| i % 5 == fold;
            let of_part = |test: bool| -> Vec<ForceCase> {
                let part = (0..cases.len()).filter(|i| is_test(i) == test);
                part.map(|i| cases[i].clone()).collect()
            };
            let domain = domain(&of_part(false));
            applicability.extend(of_part(true).iter().map(|case| {
                domain.applicability(&case.scenario, case.scenario.contact_m.unwrap())
            }));
        }
        let mean = applicability.iter().sum::<f64>() / applicability.len() as f64;
        let full = applicability.iter().filter(|a| **a == 1.0).count();
        assert!(mean > 0.99 && full >= 185, "{mean} {full} {applicability:?}");
    }

    #[test]
    fn applicability_falls_to_zero_outside_and_the_quantity_is_named() {
        let cases = [shipped("fea"), shipped("fea-wide")].concat();
        let (domain, seen) = (domain(&cases), cases[10].scenario.clone());
        let contact = seen.contact_m.unwrap();
        assert_eq!(domain.applicability(&seen, contact), 1.0);
        assert_eq!(domain.outside(&seen), vec![]);
        let mut before = 1.0;
        for mass_kg in [2500.0, 2600.0, 2700.0, 2800.0, 2900.0, 3000.0, 4000.0] {
            let heavy = ForceScenario { mass_kg: [seen.mass_kg[0], mass_kg], ..seen.clone() };
            let now = domain.applicability(&heavy, contact);
            assert!(now <= before, "{mass_kg}: {now} after {before}");
            let outside = domain.outside(&heavy);
            assert_eq!(outside.len(), usize::from(mass_kg > 2500.0), "{outside:?}");
            let expected = "mass of the striking vehicle [kg]";
            assert!(outside.iter().all(|found| found.feature == expected), "{outside:?}");
            before = now;
        }
        assert_eq!(before, 0.0);
        for (normal_rad, expected) in [(FRAC_PI_2, 1.0), (0.0, 0.0), (std::f64::consts::PI, 0.0)] {
            let turned = ForceScenario { normal_rad: Some(normal_rad), ..seen.clone() };
            assert_eq!(domain.applicability(&turned, contact), expected, "{normal_rad}");
            assert_eq!(domain.outside(&turned).len(), usize::from(expected == 0.0));
        }
        let mut before = 1.0;
        for rate in [0.0, 0.05, 0.2, 0.5, 2.0] {
            let turning = ForceScenario { yaw_rate_rad_s: [rate, -rate], ..seen.clone() };
            let now = domain.applicability(&turning, contact);
            assert!(now <= before, "{rate}: {now} after {before}");
            let outside = domain.outside(&turning);
            assert_eq!(outside.len(), if rate > 0.0 { 2 } else { 0 }, "{outside:?}");
            assert!(outside.iter().all(|found| found.feature.starts_with("yaw rate of the")));
            before = now;
        }
        assert_eq!(before, 0.0);
        let fast = ForceScenario { striking_velocity_m_s: [70.0, 3.0], ..seen };
        assert_eq!(domain.applicability(&fast, contact), 0.0);
    }

    #[test]
    fn yaw_rates_of_the_training_cases_are_inside_and_features_of_the_network() {
        let mut cases = shipped("fea");
        assert_eq!(standardisation(&cases).n_turning(), 0);
        for (i, case) in cases.iter_mut().enumerate() {
            case.scenario.yaw_rate_rad_s = [0.6 * (i as f64).sin(), 0.6 * (1.7 * i as f64).cos()];
        }
        assert_eq!(standardisation(&cases).n_turning(), N_TURNING);
        let (domain, seen) = (domain(&cases), cases[10].scenario.clone());
        let contact = seen.contact_m.unwrap();
        assert_eq!(domain.applicability(&seen, contact), 1.0);
        assert_eq!(domain.outside(&seen), vec![]);
        let fast = ForceScenario { yaw_rate_rad_s: [3.0, 0.0], ..seen };
        assert_eq!(domain.applicability(&fast, contact), 0.0);
        assert_eq!(domain.outside(&fast)[0].feature, SCENARIO_NAMES[N_SCENARIO]);
    }

    /// Half of the cases turn to the left, half to the right: one that does not turn is like none of them.
    #[test]
    fn a_scenario_between_the_cases_is_far_from_all_of_them_and_that_is_said() {
        let template = shipped("fea").swap_remove(10);
        let case = |i: usize| {
            let mut case = template.clone();
            case.scenario.striking_velocity_m_s[1] += 0.05 * i as f64;
            case.scenario.yaw_rate_rad_s = [if i.is_multiple_of(2) { 1.0 } else { -1.0 }, 0.0];
            case
        };
        let cases: Vec<ForceCase> = (0..20).map(case).collect();
        let (domain, seen) = (domain(&cases), &cases[10].scenario);
        let straight = ForceScenario { yaw_rate_rad_s: [0.0; 2], ..seen.clone() };
        let a = domain.applicability(&straight, seen.contact_m.unwrap());
        assert!(a < 1.0 && domain.outside(seen) == vec![], "{a}");
        let outside = domain.outside(&straight);
        assert_eq!(outside.len(), 1, "{outside:?}");
        assert!(outside[0].feature == DISTANCE_NAME && outside[0].value > 1.0, "{outside:?}");
    }

    /// A quantity that no training case varies says nothing about other values of it.
    #[test]
    fn a_mass_that_was_never_varied_is_the_only_one_known() {
        let cases = shipped("fea");
        let (domain, seen) = (domain(&cases), &cases[10].scenario);
        let light = ForceScenario { mass_kg: [1700.0, seen.mass_kg[1]], ..seen.clone() };
        assert_eq!(domain.applicability(&light, seen.contact_m.unwrap()), 0.0);
        assert_eq!(domain.outside(&light)[0].feature, "mass of the struck vehicle [kg]");
    }
}
