//! How much of a distribution that is made of draws is chance.

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::RestOutcome;
use crate::analysis::rest_outcome::MotionEnd;
use impactlab_core::numerics::{jackknife_errors, quantile_error_of_sorted, quantile_of_sorted};

/// Groups of draws that are left out in turn.
const N_GROUPS: usize = 10;

/// Standard errors of what is told of the end of a motion, because it is made of a limited number of
/// draws. With other seeds the numbers differ by about as much.
///
/// The ends of intervals are those of order statistics, the areas of regions those of a grouped jackknife,
/// which leaves out a tenth of the draws in turn. Where several motions are drawn under each of several
/// forces, which are then not independent, both are those of the jackknife, which leaves out forces with all
/// their motions. Neither knows that draws fill their space evenly, nor of events that are so rare that no
/// draw has them.
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
        Self::from_parts(ends, ends.len(), limit_s)
    }

    /// That of draws under several forces and of several vehicles, which take turns; `None` of fewer than
    /// two.
    ///
    /// - `ends`: draw i is of force and vehicle i mod `n_parts`; those of a single one are independent.
    pub(super) fn from_parts(ends: &[MotionEnd], n_parts: usize, limit_s: f64) -> Option<Self> {
        let n = ends.len();
        let n_parts = if n_parts > 1 { n_parts.min(n) } else { n };
        if n < 2 {
            return None;
        }
        let n_groups = n_parts.min(N_GROUPS);
        let without = |left_out: usize| -> Vec<MotionEnd> {
            let stays =
                |(idx, _): &(usize, &MotionEnd)| idx % n_parts * n_groups / n_parts != left_out;
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
            let errors = match n_parts < n {
                true => jackknife_errors(n_groups, |idx| edges(&sorted(&without(idx), value))),
                false => at.map(|p| quantile_error_of_sorted(&all, p).unwrap_or(f64::NAN)),
            };
            let [low, high] = edges(&all);
            if high > low { errors[0].max(errors[1]) / (high - low) } else { 0.0 }
        };
        let values: [fn(&MotionEnd) -> f64; 3] = [|end| end.x_m, |end| end.y_m, |end| end.yaw_rad];
        Some(Self {
            interval_share: values.into_iter().map(share).fold(0.0, f64::max),
            region_90_m2: jackknife_errors(n_groups, region)[0],
        })
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
    use super::*;

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
        let share =
            |n_parts| MonteCarloError::from_parts(&ends, n_parts, 4.0).unwrap().interval_share;
        assert_eq!(
            MonteCarloError::from_parts(&ends, 240, 4.0),
            MonteCarloError::from_ends(&ends, 4.0)
        );
        assert_eq!(share(1), share(240));
        // Without the first or the last force an end of the interval of x is 1 m further in, of 3 m.
        assert!(share(240) < 0.05 && share(4) > 0.2, "{} {}", share(240), share(4));
        assert_eq!(MonteCarloError::from_ends(&ends[..1], 4.0), None);
    }
}
