//! How much of a distribution that is made of draws is chance.

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::RestOutcome;
use crate::analysis::rest_outcome::MotionEnd;
use impactlab_core::numerics::{jackknife_errors, quantile_error_of_sorted, quantile_of_sorted};
use impactlab_core::uncertainty::{NormalMixture, PlanarMixture};
use impactlab_networks::response::MotionDistribution;

/// Groups of draws that are left out in turn.
const N_GROUPS: usize = 10;

/// Standard errors of what is told of the end of a motion, because it is made of a limited number of
/// draws. With other seeds the numbers differ by about as much.
///
/// The ends of intervals of a mixture and the areas of regions are those of a grouped jackknife, which
/// leaves out a tenth of the draws in turn, the ends of intervals of draws those of order statistics.
/// Neither knows that draws fill their space evenly, nor of events that are so rare that no draw has
/// them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct MonteCarloError {
    /// Largest standard error of an end of the 90 % intervals of x, y and heading, as a share of the
    /// width of its interval.
    pub interval_share: f64,
    /// Standard error of the area of the 90 % region, m².
    pub region_90_m2: f64,
}

impl MonteCarloError {
    /// That of a mixture in which each draw has its own parts; `None` of fewer than two draws.
    ///
    /// - `instant`: index of the instant that is told of;
    /// - `n_draws`: forces and vehicles, in the order of which the parts of the mixture are.
    pub(super) fn from_mixture(
        distribution: &MotionDistribution,
        instant: usize,
        n_draws: usize,
    ) -> Option<Self> {
        let position = distribution.position(instant);
        let [x, y, heading] = [0, 1, 2].map(|axis| distribution.marginal(instant, axis));
        let marginals = [x?, y?, heading?];
        let n_parts = position.parts().len();
        let group = |part: usize| part * n_draws / n_parts.max(1) % N_GROUPS;
        let errors: [f64; 7] = jackknife_errors(n_draws.min(N_GROUPS), |left_out| {
            let stays = |part: &usize| group(*part) != left_out;
            let [x, y, heading] = marginals.each_ref().map(|marginal| {
                let parts = (0..n_parts).filter(stays).map(|part| marginal.parts()[part]);
                let some = NormalMixture::new(parts.collect());
                some.map_or([f64::NAN; 2], |some| some.interval(0.9))
            });
            let parts = (0..n_parts).filter(stays).map(|part| position.parts()[part]);
            let region = PlanarMixture::new(parts.collect()).region_m2(0.9);
            [x[0], x[1], y[0], y[1], heading[0], heading[1], region]
        });
        let share = |(axis, marginal): (usize, &NormalMixture)| {
            let [low, high] = marginal.interval(0.9);
            errors[2 * axis].max(errors[2 * axis + 1]) / (high - low)
        };
        let shares = marginals.iter().enumerate().map(share);
        (n_draws >= 2)
            .then(|| Self { interval_share: shares.fold(0.0, f64::max), region_90_m2: errors[6] })
    }

    /// That of draws which are told as they are; `None` of fewer than two.
    ///
    /// - `ends`: in the order of the forces and vehicles of which they are.
    pub(crate) fn from_ends(ends: &[MotionEnd], limit_s: f64) -> Option<Self> {
        let n = ends.len();
        let share = |value: fn(&MotionEnd) -> f64| {
            let mut values: Vec<f64> = ends.iter().map(value).collect();
            values.sort_by(f64::total_cmp);
            let at = |probability| {
                let error = quantile_error_of_sorted(&values, probability).unwrap_or(f64::NAN);
                (quantile_of_sorted(&values, probability).unwrap_or(f64::NAN), error)
            };
            let ((low, error_low), (high, error_high)) = (at(0.05), at(0.95));
            if high > low { error_low.max(error_high) / (high - low) } else { 0.0 }
        };
        let values: [fn(&MotionEnd) -> f64; 3] = [|end| end.x_m, |end| end.y_m, |end| end.yaw_rad];
        let region = |left_out: usize| {
            // Draws of one force and vehicle stand side by side.
            let stays = |(idx, _): &(usize, &MotionEnd)| idx * n.min(N_GROUPS) / n != left_out;
            let some: Vec<MotionEnd> =
                ends.iter().enumerate().filter(stays).map(|(_, end)| *end).collect();
            let rest = RestOutcome::from_ends(&some, limit_s);
            [rest.and_then(|rest| rest.region_90_m2).unwrap_or(f64::NAN)]
        };
        (n >= 2).then(|| Self {
            interval_share: values.into_iter().map(share).fold(0.0, f64::max),
            region_90_m2: jackknife_errors(n.min(N_GROUPS), region)[0],
        })
    }
}
