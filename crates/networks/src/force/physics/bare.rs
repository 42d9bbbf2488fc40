//! The distribution of the force by physics alone: the momentum solution as a pulse, with the
//! errors that it was measured to have.
//!
//! ```text
//! F(t) = P g(t / L) / L      P = R(β) P₀ exp(ζ_P)      L = L₀ exp(ζ_L)      Δt = L / s
//! ```
//!
//! P₀ is the impulse of the planar impact with the restitution and friction limit of the scenario, or
//! with their defaults, g the haversine, L₀ = s Δt₀ with the mean duration Δt₀ of the training cases. The errors ζ_P,
//! β and ζ_L are normal and correlated. This is what is left of a force network outside of what it has
//! learned from.
//!
//! Measured by `examples/bare_force.rs` on the 200 shipped finite-element runs: for each of the
//! masses of both vehicles, both components of the relative velocity, heading and contact point,
//! the quarter of the runs with the smallest values and the quarter with the largest are left out
//! in turn, and predicted with the duration and the shape of the others. Root mean squares over the
//! 600 predictions:
//!
//! | | rms | within ±0.674 rms | within ±1.645 rms |
//! | --- | --- | --- | --- |
//! | impulse, ln | 0.26 | 59 % | 92 % |
//! | direction, rad | 0.21 | 62 % | 89 % |
//! | duration, ln | 0.41 | 51 % | 85 % |
//! | peak, ln | 0.42 | 48 % | 90 % |
//!
//! Left out: what the pulse of a certain collision looks like. Assumed: the errors are as large
//! further outside than was measured. No drawn impulse adds kinetic energy.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::DMatrix;

use crate::force::{ContactLaw, ForceScenario, MomentumModel};
use impactlab_core::collision::{
    ContactSurface, Impact, ImpactError, PulseShape, Regime, contact_work_j,
};
use impactlab_core::numerics::normal_quantile;
use impactlab_core::uncertainty::{
    CURVE_INTERVAL_S, CURVE_N_INSTANTS, CurveComponent, ForceCurve, PeakFactors,
};

/// Root mean square of ζ_P, the error of ln |P| of the momentum solution.
pub const IMPULSE_LOG_STD: f64 = 0.26;
/// Root mean square of β, the error of the direction of the momentum solution, rad.
pub const DIRECTION_STD_RAD: f64 = 0.21;
/// Root mean square of ζ_L: that with which the errors of peak and duration come out as measured.
pub(crate) const LENGTH_LOG_STD: f64 = 0.46;
/// Correlations of ζ_P with β and with ζ_L: an impulse that is larger than expected is turned
/// forward, as where the striking vehicle's corner catches, and lasts longer. β is counted in
/// canonical axes.
const IMPULSE_DIRECTION_CORRELATION: f64 = -0.86;
const IMPULSE_LENGTH_CORRELATION: f64 = 0.45;
/// s, length of the haversine over the duration: the median of F_max Δt / |P| is 2.73, of a haversine
/// over its length 2.
const LENGTH_OVER_DURATION: f64 = 2.0 / 2.73;
/// Standard deviation of single instants, as a share of the peak of the pulse, while it lasts and at
/// any time. It makes bands smooth between the drawn pulses.
const RIPPLE: [f64; 2] = [0.1, 0.005];
/// Correlation of the ripple at neighbouring instants.
const RIPPLE_CORRELATION: f64 = 0.8;
/// Largest share of the impulse that neither absorbs nor adds energy.
const MOST_ELASTIC: f64 = 0.95;
/// Smallest variance of a force, N², where there is no impulse.
const LEAST_FORCE_VARIANCE: f64 = 1.0;
/// Standard deviation of the duration of one component, as a share.
const DURATION_RIPPLE: f64 = 0.05;
/// Generalised golden ratios of two dimensions, whose multiples fill a square evenly (M. Roberts, "The
/// unreasonable effectiveness of quasirandom sequences", 2018).
const GOLDEN: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// The momentum solution of a scenario.
#[derive(Debug, Clone)]
pub(crate) struct BareForce {
    impact: Impact,
    /// P₀, N s; zero if the vehicles do not approach each other.
    pub(crate) impulse_n_s: [f64; 2],
    /// Whether the vehicles approach each other at the contact.
    pub(crate) is_approaching: bool,
    /// L₀, s.
    length_s: f64,
}

impl BareForce {
    /// The momentum solution of a canonical scenario.
    ///
    /// - `momentum`: stands in for what the scenario leaves open: arm of the striking vehicle, yaw
    ///   inertias;
    /// - `contact_m`: the contact point, which the scenario may leave open;
    /// - `duration_s`: mean duration of the training cases.
    ///
    /// # Errors
    /// [`ImpactError`] for masses or velocities out of range.
    pub(crate) fn new(
        momentum: &MomentumModel,
        (scenario, contact_m): (&ForceScenario, [f64; 2]),
        duration_s: f64,
    ) -> Result<Self, ImpactError> {
        let known = ForceScenario { contact_m: Some(contact_m), ..scenario.clone() };
        let mut impact = MomentumModel { uses_contact: true, ..*momentum }.impact(&known);
        if let Some([x, y]) = scenario.striking_position_m {
            impact.striking.contact_arm_world_m = [contact_m[0] - x, contact_m[1] - y];
        }
        for (body, inertia) in
            [&mut impact.struck, &mut impact.striking].into_iter().zip(scenario.yaw_inertia_kg_m2)
        {
            body.yaw_inertia_kg_m2 = inertia.unwrap_or(body.yaw_inertia_kg_m2);
        }
        let law = scenario
            .contact_law
            .unwrap_or_else(|| ContactLaw::at_closing_speed(impact.closing_speed_m_s()));
        impact.surface = ContactSurface {
            normal_angle_world_rad: scenario.normal_rad.unwrap_or(FRAC_PI_2),
            restitution: law.restitution,
            restitution_form: law.restitution_form,
            friction_limit: law.friction_limit,
            ..impact.surface
        };
        let solution = impact.solve()?;
        Ok(Self {
            impact,
            impulse_n_s: solution.impulse_world_n_s,
            is_approaching: solution.regime != Regime::NotApproaching,
            length_s: LENGTH_OVER_DURATION * duration_s.max(CURVE_INTERVAL_S),
        })
    }

    /// Pulses of equal weight whose impulses, directions and lengths are spread as the errors are.
    ///
    /// - `n`: how many, 1 or more;
    /// - `weight`: of all of them together.
    pub(crate) fn components(&self, n: usize, weight: f64) -> Vec<CurveComponent> {
        let component = |i: usize| {
            let curve = self.pulse(errors(i, n));
            component(&curve, weight / n as f64)
        };
        (0..n).map(component).collect()
    }

    /// The pulse without errors.
    pub(crate) fn curve(&self) -> ForceCurve {
        self.pulse([0.0; 3])
    }

    fn pulse(&self, [impulse, direction, length]: [f64; 3]) -> ForceCurve {
        let ([px, py], (sin, cos)) = (self.impulse_n_s, direction.sin_cos());
        let turned = [px * cos - py * sin, px * sin + py * cos];
        let size = impulse.exp().min(MOST_ELASTIC * self.elastic_share(turned));
        let length_s = self.length_s * length.exp();
        let shape: Vec<f64> = (0..CURVE_N_INSTANTS)
            .map(|i| PulseShape::Haversine.density((i as f64 + 0.5) * CURVE_INTERVAL_S / length_s))
            .collect();
        // The impulse holds on the grid, also where a pulse reaches beyond it.
        let sum = shape.iter().sum::<f64>().max(f64::MIN_POSITIVE) * CURVE_INTERVAL_S;
        let force = |p: f64| shape.iter().map(|g| size * p * g / sum).collect();
        ForceCurve {
            fx_n: force(turned[0]),
            fy_n: force(turned[1]),
            duration_s: length_s / LENGTH_OVER_DURATION,
        }
    }

    /// The factor on an impulse with which it neither absorbs nor adds kinetic energy; zero if any
    /// such impulse adds some, infinite for none.
    fn elastic_share(&self, impulse_n_s: [f64; 2]) -> f64 {
        let (v, k) = (self.impact.relative_velocity_m_s(), self.impact.inverse_mass_1_kg());
        // W(s P) = s v·P − s² PᵀKP / 2, so that W(P) and W(2 P) give both terms.
        let [one, two] =
            [1.0, 2.0].map(|factor| contact_work_j(v, k, impulse_n_s.map(|p| factor * p)));
        let (linear, square) = (2.0 * one - two / 2.0, one - two / 2.0);
        if square > 0.0 { (linear / square).max(0.0) } else { f64::INFINITY }
    }
}

/// The errors ζ_P, β and ζ_L of draw i of n: quantiles of ζ_P at equal steps, of the others by a
/// sequence that fills the square evenly.
fn errors(i: usize, n: usize) -> [f64; 3] {
    let first = (i as f64 + 0.5) / n as f64;
    let [second, third] = GOLDEN.map(|step| (0.5 + step * (i as f64 + 1.0)).fract());
    let [p, b, l] = [first, second, third].map(|u| normal_quantile(u.clamp(1e-3, 1.0 - 1e-3)));
    let along = |correlation: f64, own: f64| {
        correlation * p + (1.0 - correlation * correlation).sqrt() * own
    };
    [
        IMPULSE_LOG_STD * p,
        (DIRECTION_STD_RAD * along(IMPULSE_DIRECTION_CORRELATION, b)).clamp(-TAU / 4.0, TAU / 4.0),
        LENGTH_LOG_STD * along(IMPULSE_LENGTH_CORRELATION, l),
    ]
}

/// A normal distribution about a pulse.
fn component(curve: &ForceCurve, weight: f64) -> CurveComponent {
    let (magnitude, peak_n) = (curve.magnitude_n(), curve.peak().0);
    let [while_it_lasts, always] = RIPPLE;
    let variance = |force: &f64| {
        let std = while_it_lasts * force + always * peak_n;
        (std * std).max(LEAST_FORCE_VARIANCE)
    };
    let forces: Vec<f64> = magnitude.iter().map(variance).collect();
    let of_duration = (DURATION_RIPPLE * curve.duration_s).powi(2);
    let variance = [forces.clone(), forces, vec![of_duration]].concat();
    CurveComponent {
        weight,
        mean: curve.to_values(),
        factors: DMatrix::zeros(variance.len(), 0),
        variance,
        lag_correlation: RIPPLE_CORRELATION,
        peak: PeakFactors::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::ForceCase;
    use crate::force::input::{example, shipped};
    use impactlab_core::data::StruckSide;
    use impactlab_core::numerics::quantile_of_sorted;

    fn force(scenario: &ForceScenario, duration_s: f64) -> BareForce {
        let contact_m = scenario.contact_m.unwrap();
        BareForce::new(&MomentumModel::prior(true), (scenario, contact_m), duration_s).unwrap()
    }

    /// Whether the central half and the central 90 % of values hold one.
    fn holds(mut values: Vec<f64>, observed: f64) -> [bool; 2] {
        values.sort_by(f64::total_cmp);
        let at = |probability| quantile_of_sorted(&values, probability).unwrap();
        [[0.25, 0.75], [0.05, 0.95]].map(|[low, high]| (at(low)..=at(high)).contains(&observed))
    }

    /// For each feature the quarters of the runs with the smallest and the largest values are left out
    /// in turn: the spread of the pulses holds the impulses and peaks of those that were left out.
    #[test]
    fn the_spread_is_that_of_the_errors_on_runs_left_out() {
        let cases = [shipped("fea"), shipped("fea-wide")].concat();
        let features: [fn(&ForceScenario) -> f64; 6] = [
            |of| of.mass_kg[0],
            |of| of.mass_kg[1],
            |of| of.relative_velocity_m_s()[0],
            |of| of.relative_velocity_m_s()[1],
            |of| of.theta_b_rad,
            |of| of.contact_m.unwrap()[0],
        ];
        let (mut impulse, mut peak, mut n) = ([0_usize; 2], [0_usize; 2], 0);
        for feature in features {
            let mut order: Vec<&ForceCase> = cases.iter().collect();
            order.sort_by(|a, b| feature(&a.scenario).total_cmp(&feature(&b.scenario)));
            for (test, rest) in [(&order[..50], &order[50..]), (&order[150..], &order[..150])] {
                let duration_s =
                    rest.iter().map(|case| case.curve.duration_s).sum::<f64>() / rest.len() as f64;
                for case in test {
                    let pulses = force(&case.scenario, duration_s).components(48, 1.0);
                    let curves: Vec<ForceCurve> =
                        pulses.iter().map(|of| ForceCurve::from_values(&of.mean)).collect();
                    let size = |[x, y]: [f64; 2]| x.hypot(y);
                    let sizes = curves.iter().map(|curve| size(curve.impulse_n_s())).collect();
                    let peaks = curves.iter().map(|curve| curve.peak().0).collect();
                    for (held, of) in [
                        (&mut impulse, holds(sizes, size(case.impulse_n_s))),
                        (&mut peak, holds(peaks, case.peak_n)),
                    ] {
                        held.iter_mut().zip(of).for_each(|(n, is_held)| *n += usize::from(is_held));
                    }
                    n += 1;
                }
            }
        }
        let share = |held: [usize; 2]| held.map(|count| count as f64 / f64::from(n));
        let (impulse, peak) = (share(impulse), share(peak));
        for [half, ninety] in [impulse, peak] {
            assert!((0.40..0.65).contains(&half), "impulse {impulse:?}, peak {peak:?}");
            assert!((0.85..0.95).contains(&ninety), "impulse {impulse:?}, peak {peak:?}");
        }
    }

    /// At 70 m/s a force as well as at 5 m/s; no impulse adds energy, and none is there where the
    /// vehicles part.
    #[test]
    fn pulses_carry_their_impulse_and_add_no_energy() {
        let seen = example(StruckSide::Right);
        for speed_m_s in [3.0, 70.0] {
            let scenario = ForceScenario {
                struck_velocity_m_s: [0.0; 2],
                striking_velocity_m_s: [0.2 * speed_m_s, speed_m_s],
                ..seen.clone()
            };
            let bare = force(&scenario, 0.13);
            let curve = bare.curve();
            for (axis, p) in curve.impulse_n_s().into_iter().enumerate() {
                assert!((p - bare.impulse_n_s[axis]).abs() < 1e-6 * p.abs(), "{p}");
            }
            assert!(bare.is_approaching && (curve.duration_s - 0.13).abs() < 1e-12);
            let (v, k) = (bare.impact.relative_velocity_m_s(), bare.impact.inverse_mass_1_kg());
            for component in bare.components(48, 1.0) {
                let impulse = ForceCurve::from_values(&component.mean).impulse_n_s();
                assert!(contact_work_j(v, k, impulse) >= 0.0, "{speed_m_s}: {impulse:?}");
            }
        }
        let apart = force(&ForceScenario { striking_velocity_m_s: [15.0, -3.0], ..seen }, 0.13);
        assert!(!apart.is_approaching && apart.impulse_n_s == [0.0; 2]);
        assert!(apart.components(8, 1.0).iter().all(|of| of.mean[..500] == [0.0; 500]));
    }
}
