//! Restitution and friction limit of a contact of which nobody says them: their defaults, and the
//! distribution from which both are drawn.

use serde::{Deserialize, Serialize};

use crate::collision::ImpliedContact;
use crate::numerics::quantile_of_sorted;
use crate::units::{Phrase, PhraseValue, Quantity};

/// Coefficient of restitution of slow contacts that is used if none is given. Together with
/// [`DEFAULT_FRICTION_LIMIT`] it gives the smallest mean error of the impulse vector over the
/// training cases of the shipped finite-element runs in which the vehicles do not hook, 17.1 %
/// (`examples/fit_contact.rs`). They are pushes at the rear quarter, whose contact points close at
/// up to 5.2 m/s.
pub const DEFAULT_RESTITUTION: f64 = 0.38;

/// Friction limit that is used if none is given; see [`DEFAULT_RESTITUTION`].
pub const DEFAULT_FRICTION_LIMIT: f64 = 0.3;

/// Closing speeds between which restitution falls, m/s: that of the finite-element runs, and that from
/// which it is that of a hard crash.
pub const RESTITUTION_SPEEDS_M_S: [f64; 2] = [5.0, 15.0];

/// Coefficient of restitution of hard crashes: in staged small-overlap crashes at 64 km/h it was 0 to
/// 0.28 with a mean of 0.09.
pub const HARD_RESTITUTION: f64 = 0.1;

/// Bounds of the restitution at both of [`RESTITUTION_SPEEDS_M_S`]: those of 90 % of the
/// finite-element runs, and those of hard crashes ([`Brach2011`](crate::bibliography::Brach2011)).
const RESTITUTION_BOUNDS: [[f64; 2]; 2] = [[0.24, 0.66], [0.0, 0.3]];

/// The coefficient of restitution where none is given: [`DEFAULT_RESTITUTION`] up to the first of
/// [`RESTITUTION_SPEEDS_M_S`], [`HARD_RESTITUTION`] from the second on, and linear in between, to the
/// thousandth.
///
/// - `closing_m_s`: speed at which the contact points approach each other, in all directions, m/s.
pub fn default_restitution(closing_m_s: f64) -> f64 {
    (1e3 * over_closing_speed([DEFAULT_RESTITUTION, HARD_RESTITUTION], closing_m_s)).round() / 1e3
}

/// Lowest and highest coefficient of restitution to be expected at a closing speed.
///
/// - `closing_m_s`: as for [`default_restitution`].
pub fn restitution_bounds(closing_m_s: f64) -> [f64; 2] {
    let [slow, fast] = RESTITUTION_BOUNDS;
    [0, 1].map(|i| over_closing_speed([slow[i], fast[i]], closing_m_s))
}

/// What [`default_restitution`] is, in words.
pub fn default_restitution_in_words() -> Phrase {
    let speeds = RESTITUTION_SPEEDS_M_S.map(|m_s| PhraseValue::given(Quantity::Speed, m_s));
    let [slow, fast] = speeds;
    Phrase::new(
        "{0} up to {1}, fitted to finite-element runs, and {2} from {3} on, as in staged crashes",
        "{0} bis {1}, angepasst an Finite-Elemente-Rechnungen, und {2} ab {3}, wie in Crashversuchen",
    )
    .with(PhraseValue::given(Quantity::Ratio, DEFAULT_RESTITUTION))
    .with(slow)
    .with(PhraseValue::given(Quantity::Ratio, HARD_RESTITUTION))
    .with(fast)
}

fn over_closing_speed([slow, fast]: [f64; 2], closing_m_s: f64) -> f64 {
    let [from, to] = RESTITUTION_SPEEDS_M_S;
    let share = ((closing_m_s - from) / (to - from)).clamp(0.0, 1.0);
    slow + (fast - slow) * share
}

/// Independent uniform distributions of the coefficient of restitution e and of the friction limit
/// μ_c.
///
/// By default they are what the impulses of the shipped finite-element runs imply, of the training
/// cases in which the vehicles do not hook (`examples/fit_contact.rs`): 90 % lie within e from 0.24 to
/// 0.66 and impulse ratios from 0.07 to 0.50. In impacts at higher closing speeds restitution is
/// smaller, 0 to 0.3 ([`Brach2011`](crate::bibliography::Brach2011)). Where impulses are known,
/// [`ContactDistribution::fit`] gives ranges that replace the default.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactDistribution {
    /// Lowest and highest coefficient of restitution e, 0 to 1.
    pub restitution: [f64; 2],
    /// Lowest and highest friction limit μ_c, 0 or more.
    pub friction_limit: [f64; 2],
}

impl Default for ContactDistribution {
    fn default() -> Self {
        let [slow, _] = RESTITUTION_BOUNDS;
        Self { restitution: slow, friction_limit: [0.07, 0.5] }
    }
}

impl ContactDistribution {
    /// Returns the coefficient of restitution and the friction limit at the given quantiles, each
    /// from 0 to 1. Independent uniform random numbers as quantiles draw a sample; 0.5 gives the
    /// median.
    pub fn quantile(&self, [u_restitution, u_friction]: [f64; 2]) -> (f64, f64) {
        let at = |[low, high]: [f64; 2], u: f64| low + (high - low) * u;
        (at(self.restitution, u_restitution), at(self.friction_limit, u_friction))
    }

    /// The ranges between the 5 % and the 95 % quantile of the values that known impulses imply
    /// ([`Impact::implied_contact`](crate::collision::Impact::implied_contact)).
    ///
    /// The limits of e are clamped to the interval from 0 to 1. The range of μ_c is taken from the
    /// magnitudes of the impulse ratios. It is too low if many of the impacts end without sliding,
    /// because their impulse ratio is only a lower bound of μ_c. Returns `None` if there are no
    /// samples.
    pub fn fit(samples: &[ImpliedContact]) -> Option<Self> {
        let middle = |value: fn(&ImpliedContact) -> f64| {
            let mut values: Vec<f64> = samples.iter().map(value).collect();
            values.sort_by(f64::total_cmp);
            Some([quantile_of_sorted(&values, 0.05)?, quantile_of_sorted(&values, 0.95)?])
        };
        Some(Self {
            restitution: middle(|s| s.restitution)?.map(|e| e.clamp(0.0, 1.0)),
            friction_limit: middle(|s| s.impulse_ratio.abs())?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_single_defaults_lie_within_the_ranges() {
        let ContactDistribution { restitution, friction_limit } = ContactDistribution::default();
        for ([low, high], single) in
            [(restitution, DEFAULT_RESTITUTION), (friction_limit, DEFAULT_FRICTION_LIMIT)]
        {
            assert!(low < single && single < high, "{single}");
        }
    }

    #[test]
    fn restitution_falls_with_the_closing_speed() {
        for (closing_m_s, expected) in [(0.0, 0.38), (5.0, 0.38), (10.0, 0.24), (17.9, 0.1)] {
            let got = default_restitution(closing_m_s);
            assert!((got - expected).abs() < 1e-12, "{closing_m_s}: {got}");
            let [low, high] = restitution_bounds(closing_m_s);
            assert!(low < got && got < high, "{closing_m_s}: {low} to {high}");
        }
    }

    #[test]
    fn a_fit_holds_the_middle_of_the_samples() {
        let samples: Vec<_> = (0..=100)
            .map(|i| ImpliedContact {
                restitution: f64::from(i) / 100.0 - 0.2,
                impulse_ratio: -f64::from(i) / 100.0,
            })
            .collect();
        let fit = ContactDistribution::fit(&samples).unwrap();
        assert_eq!(fit.restitution[0], 0.0);
        assert!((fit.restitution[1] - 0.75).abs() < 1e-12, "{fit:?}");
        assert!((fit.friction_limit[0] - 0.05).abs() < 1e-12, "{fit:?}");
        assert!((fit.friction_limit[1] - 0.95).abs() < 1e-12, "{fit:?}");
        assert!(ContactDistribution::fit(&[]).is_none());
    }
}
