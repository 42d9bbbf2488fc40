//! How much of a distribution that is made of draws is chance.

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::RestOutcome;
use crate::analysis::rest_outcome::MotionEnd;
use impactlab_core::numerics::{jackknife_errors, quantile_error_of_sorted, quantile_of_sorted};

/// Groups of draws that are left out in turn.
const N_GROUPS: usize = 10;

/// Fewest draws that have an interval of 90 %: one of them lies beyond each of its ends.
pub(crate) const FEWEST_DRAWS: usize = 20;

/// Standard errors of what is told of the end of a motion, because it is made of a limited number of
/// draws. With other seeds the numbers differ by about as much.
///
/// The ends of intervals are those of order statistics, the areas of regions those of a grouped jackknife,
/// which leaves out a tenth of the draws in turn. Where several motions are drawn under each of several
/// forces, which are then not independent, both are those of the jackknife, which leaves out forces with all
/// their motions; so with vehicles, and the larger error is told. Neither knows that draws fill their space
/// evenly, nor of events that are so rare that no draw has them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct MonteCarloError {
    /// Largest standard error of an end of the 90 % intervals of x, y and heading, as a share of the
    /// width of its interval.
    pub interval_share: f64,
    /// Standard error of the area of the 90 % region, m².
    pub region_90_m2: f64,
}

impl MonteCarloError {
    /// That of independent draws; `None` of fewer than two.
    ///
    /// - `ends`: in the order of the forces and vehicles of which they are.
    pub(crate) fn from_ends(ends: &[MotionEnd], limit_s: f64) -> Option<Self> {
        Self::from_parts(ends, [1, 1], limit_s)
    }

    /// That of draws under several forces and of several vehicles, which take turns; `None` of fewer than
    /// two.
    ///
    /// - `ends`: draw i is of part p = i mod the larger count, with force and vehicle p mod their counts;
    /// - `counts`: forces and vehicles; draws of a single one are independent.
    pub(super) fn from_parts(ends: &[MotionEnd], counts: [usize; 2], limit_s: f64) -> Option<Self> {
        let n = ends.len();
        if n < 2 {
            return None;
        }
        let n_parts = counts.into_iter().max().filter(|count| *count > 1).map_or(n, |it| it.min(n));
        let drawn = counts.into_iter().filter(|count| *count > 1).map(|count| count.min(n));
        let of_counts = drawn.map(|count| Self::over(ends, n_parts, count, limit_s));
        let larger = |a: Self, b: Self| Self {
            interval_share: a.interval_share.max(b.interval_share),
            region_90_m2: a.region_90_m2.max(b.region_90_m2),
        };
        Some(of_counts.reduce(larger).unwrap_or_else(|| Self::over(ends, n, n, limit_s)))
    }

    /// That over draws of which those of one force, or of one vehicle, belong together.
    ///
    /// - `ends`: two or more; draw i is of force or vehicle i mod `n_parts` mod `count`.
    fn over(ends: &[MotionEnd], n_parts: usize, count: usize, limit_s: f64) -> Self {
        let n_groups = count.min(N_GROUPS);
        let without = |left_out: usize| -> Vec<MotionEnd> {
            let stays = |(idx, _): &(usize, &MotionEnd)| {
                idx % n_parts % count * n_groups / count != left_out
            };
            ends.iter().enumerate().filter(stays).map(|(_, end)| *end).collect()
        };
        let region = |left_out: usize| {
            let rest = RestOutcome::from_ends(&without(left_out), limit_s);
            [rest.and_then(|rest| rest.region_90_m2).unwrap_or(f64::NAN)]
        };
        let share = |value: fn(&MotionEnd) -> f64| {
            let (all, at) = (sorted(ends, value), [0.05, 0.95]);
            let edges = |values: &[f64]| {
                at.map(|probability| quantile_of_sorted(values, probability).unwrap_or(f64::NAN))
            };
            let errors = match count < ends.len() {
                true => jackknife_errors(n_groups, |idx| edges(&sorted(&without(idx), value))),
                false => at.map(|p| quantile_error_of_sorted(&all, p).unwrap_or(f64::NAN)),
            };
            let [low, high] = edges(&all);
            if high > low { errors[0].max(errors[1]) / (high - low) } else { 0.0 }
        };
        let values: [fn(&MotionEnd) -> f64; 3] = [|end| end.x_m, |end| end.y_m, |end| end.yaw_rad];
        Self {
            interval_share: values.into_iter().map(share).fold(0.0, f64::max),
            region_90_m2: jackknife_errors(n_groups, region)[0],
        }
    }
}

/// A quantity of draws, in ascending order.
fn sorted(ends: &[MotionEnd], value: fn(&MotionEnd) -> f64) -> Vec<f64> {
    let mut values: Vec<f64> = ends.iter().map(value).collect();
    values.sort_by(f64::total_cmp);
    values
}

#[cfg(test)]
mod tests {
    use rand::RngExt;
    use rand_distr::StandardNormal;

    use super::*;
    use impactlab_core::numerics::random_stream;

    #[test]
    fn motions_under_one_force_are_not_as_good_as_forces() {
        // Each of four forces has its own place, about which its 60 motions scatter little.
        let end = |idx: usize| MotionEnd {
            is_at_rest: false,
            time_s: 4.0,
            distance_m: 10.0,
            x_m: (idx % 4) as f64 + 1e-3 * (idx / 4) as f64,
            y_m: 1e-3 * (idx / 4) as f64,
            yaw_rad: 0.0,
            speed_m_s: 8.0,
            yaw_rate_rad_s: 0.0,
        };
        let ends: Vec<MotionEnd> = (0..240).map(end).collect();
        let share = |n_forces| {
            MonteCarloError::from_parts(&ends, [n_forces, 1], 4.0).unwrap().interval_share
        };
        assert_eq!(
            MonteCarloError::from_parts(&ends, [240, 1], 4.0),
            MonteCarloError::from_ends(&ends, 4.0)
        );
        assert_eq!(share(1), share(240));
        // Without the first or the last force an end of the interval of x is 1 m further in, of 3 m.
        assert!(share(240) < 0.05 && share(4) > 0.2, "{} {}", share(240), share(4));
        assert_eq!(MonteCarloError::from_ends(&ends[..1], 4.0), None);
    }

    #[test]
    fn drawn_vehicles_make_few_forces_no_better_known() {
        // Ten forces, each with its own place, about which motions scatter little.
        let errors = |n_vehicles: usize| {
            let of_set = |set: u64| {
                let mut rng = random_stream(5, "forces", set);
                let mut normal = || rng.sample::<f64, _>(StandardNormal);
                let forces: Vec<[f64; 3]> = (0..10).map(|_| [(); 3].map(|()| normal())).collect();
                let end = |idx: usize| {
                    let [x_m, y_m, yaw_rad] = forces[idx % n_vehicles.max(10) % 10];
                    MotionEnd {
                        is_at_rest: false,
                        time_s: 4.0,
                        distance_m: 10.0,
                        x_m: x_m + 0.1 * normal(),
                        y_m: y_m + 0.1 * normal(),
                        yaw_rad: yaw_rad + 0.1 * normal(),
                        speed_m_s: 8.0,
                        yaw_rate_rad_s: 0.0,
                    }
                };
                let ends: Vec<MotionEnd> = (0..240).map(end).collect();
                let error = MonteCarloError::from_parts(&ends, [10, n_vehicles], 4.0).unwrap();
                [error.interval_share, error.region_90_m2]
            };
            let of_sets: Vec<[f64; 2]> = (0..30).map(of_set).collect();
            [0, 1].map(|i| of_sets.iter().map(|error| error[i]).sum::<f64>() / 30.0)
        };
        for (one, many) in errors(1).into_iter().zip(errors(32)) {
            assert!(many > 0.85 * one, "{one} {many}");
        }
    }
}
