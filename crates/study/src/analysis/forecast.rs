//! A predicted impact force in the form in which it is shown: bands, mean curve, drawn curves, and
//! scalar quantities with their intervals.

use std::f64::consts::TAU;

use serde::Serialize;

use impactlab_core::collision::{PrincipalDirectionOfForce, Pulse, PulseError, PulseShape};
use impactlab_core::numerics::random_stream;
use impactlab_core::numerics::{quantile_of_sorted, wrap_angle_rad};
use impactlab_core::uncertainty::{
    CURVE_INTERVAL_S, CurveBands, CurveMixture, CurveQuantities, ForceCurve, MixtureError,
    NormalMixture,
};
use impactlab_networks::force::metrics::BAND_LEVELS;

/// Number of curves drawn for quantities whose distribution has no closed form; a 5 % tail then has
/// 100 of them.
const N_DRAWS: usize = 2000;

/// Number of whole curves to show, and seed of the draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ForecastSettings {
    /// Number of curves to show.
    pub n_curves: usize,
    /// Seed of all random draws.
    pub seed: u64,
}

/// Median of a quantity with its central 50 % and 90 % intervals, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// Median: the value that is exceeded with a probability of 50 %.
    pub median: f64,
    /// Lower and upper end of the central interval that holds 50 %.
    pub half: [f64; 2],
    /// Lower and upper end of the central interval that holds 90 %.
    pub ninety: [f64; 2],
}

/// A central interval of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Interval {
    /// Probability that the interval holds the quantity, 0 to 1.
    pub level: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// Median of a quantity with its central intervals at [`BAND_LEVELS`], in SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimate {
    /// Median: the value that is exceeded with a probability of 50 %.
    pub median: f64,
    /// Intervals from the narrowest to the widest.
    pub intervals: Vec<Interval>,
}

/// One component of the predicted mixture: one of the possible courses of the collision.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Mode {
    /// Probability of the component, 0 to 1.
    pub weight: f64,
    /// Impulse `[P_x, P_y]` of the component's mean curve, N s.
    pub impulse_n_s: [f64; 2],
    /// Largest `|F|` of the component's mean curve, N.
    pub peak_n: f64,
    /// Mean contact duration of the component, s.
    pub duration_s: f64,
}

/// A predicted force with the quantities that are shown.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceForecast {
    /// Bands of the force at [`BAND_LEVELS`], in that order.
    pub bands: CurveBands,
    /// Mean curve; its duration is the median duration.
    pub mean: ForceCurve,
    /// Whole curves drawn from the distribution.
    pub curves: Vec<ForceCurve>,
    /// Impulse along x and y, N s, from the exact distribution.
    pub impulse_n_s: [Estimate; 2],
    /// Magnitude of the impulse, N s, from draws.
    pub impulse_magnitude_n_s: Estimate,
    /// Largest `|F|`, N, from draws.
    pub peak_n: Estimate,
    /// Time at which the largest `|F|` occurs, s, from draws.
    pub peak_time_s: Estimate,
    /// Contact duration, s, from the exact distribution.
    pub duration_s: Estimate,
    /// Principal direction of force on the target, rad clockwise from straight ahead, from draws.
    /// The median lies in `[0, 2π)`; the ends of the intervals continue from it without a jump and
    /// may lie outside of this range.
    pub pdof_rad: Estimate,
    /// Components of the mixture, in descending order of probability.
    pub modes: Vec<Mode>,
}

impl Spread {
    /// Median and intervals of a normal mixture.
    pub fn of(distribution: &NormalMixture) -> Self {
        Self {
            median: distribution.quantile(0.5),
            half: distribution.interval(0.5),
            ninety: distribution.interval(0.9),
        }
    }

    /// Median and intervals of draws; NaN without any.
    pub fn of_draws(mut draws: Vec<f64>) -> Self {
        draws.sort_by(f64::total_cmp);
        let at = |probability| quantile_of_sorted(&draws, probability).unwrap_or(f64::NAN);
        Self { median: at(0.5), half: [at(0.25), at(0.75)], ninety: [at(0.05), at(0.95)] }
    }
}

impl Estimate {
    /// Median and intervals from a quantile function, which takes a probability.
    fn of_quantiles(quantile: impl Fn(f64) -> f64) -> Self {
        let interval = |level: f64| Interval {
            level,
            low: quantile((1.0 - level) / 2.0),
            high: quantile((1.0 + level) / 2.0),
        };
        let intervals = BAND_LEVELS.into_iter().map(interval).collect();
        Self { median: quantile(0.5), intervals }
    }

    /// Median and intervals of a normal mixture.
    pub fn of(distribution: &NormalMixture) -> Self {
        Self::of_quantiles(|probability| distribution.quantile(probability))
    }

    /// Median and intervals of draws; NaN without any.
    pub fn of_draws(mut draws: Vec<f64>) -> Self {
        draws.sort_by(f64::total_cmp);
        Self::of_quantiles(|probability| {
            quantile_of_sorted(&draws, probability).unwrap_or(f64::NAN)
        })
    }

    /// Ends `[low, high]` of the interval at a level; `None` if there is no interval at this level.
    pub fn interval(&self, level: f64) -> Option<[f64; 2]> {
        let of_level = self.intervals.iter().find(|interval| interval.level == level)?;
        Some([of_level.low, of_level.high])
    }

    /// The median with the 50 % and 90 % intervals alone.
    pub fn spread(&self) -> Spread {
        let ends = |level| self.interval(level).unwrap_or([self.median; 2]);
        Spread { median: self.median, half: ends(0.5), ninety: ends(0.9) }
    }

    /// The same estimate in another unit.
    ///
    /// - `factor`: positive; median and ends are multiplied by it.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        self.mapped(|value| value * factor)
    }

    /// Applies an increasing function to the median and the ends.
    fn mapped(&self, map: impl Fn(f64) -> f64) -> Self {
        let intervals = self.intervals.iter();
        let of = |Interval { level, low, high }: &Interval| Interval {
            level: *level,
            low: map(*low),
            high: map(*high),
        };
        Self { median: map(self.median), intervals: intervals.map(of).collect() }
    }
}

impl ForceForecast {
    /// Prepares a predicted distribution of curves for display. The curves shown are the first of
    /// the draws from which the intervals are computed.
    ///
    /// # Errors
    /// [`MixtureError`], which does not occur with a mixture that was checked when it was made.
    pub fn of(mixture: &CurveMixture, settings: ForecastSettings) -> Result<Self, MixtureError> {
        let mut rng = random_stream(settings.seed, "draws", 0);
        let mut curves = mixture.sample(N_DRAWS.max(settings.n_curves), &mut rng);
        let draws = CurveQuantities::of(&curves);
        curves.truncate(settings.n_curves);
        let duration_s = Estimate::of(&mixture.duration_s());
        let mean = ForceCurve { duration_s: duration_s.median, ..mixture.mean() };
        Ok(Self {
            bands: mixture.bands(&BAND_LEVELS)?,
            impulse_n_s: [0, 1].map(|axis| Estimate::of(&mixture.impulse(axis))),
            impulse_magnitude_n_s: Estimate::of_draws(draws.impulse_magnitude_n_s()),
            peak_n: Estimate::of_draws(draws.peak_n),
            peak_time_s: Estimate::of_draws(draws.peak_time_s),
            pdof_rad: pdof_rad(mean.impulse_n_s(), &draws.impulse_n_s),
            duration_s,
            mean,
            curves,
            modes: modes(mixture),
        })
    }
}

/// Estimate of the principal direction of force from drawn impulses [x, y], N s. Angles are taken
/// relative to the direction of the impulse `mean`, so that the intervals do not jump at 2π.
fn pdof_rad(mean: [f64; 2], impulses: &[[f64; 2]]) -> Estimate {
    let angle = |impulse| PrincipalDirectionOfForce::from_impulse(impulse, 0.0);
    let centre_rad = angle(mean).map_or(0.0, |pdof| pdof.angle_rad);
    let off = |impulse: &[f64; 2]| Some(wrap_angle_rad(angle(*impulse)?.angle_rad - centre_rad));
    let around = Estimate::of_draws(impulses.iter().filter_map(off).collect());
    let median = around.median + centre_rad;
    let shift = centre_rad + median.rem_euclid(TAU) - median;
    around.mapped(|angle| angle + shift)
}

/// Components of a mixture with the quantities that are shown, in descending order of weight.
fn modes(mixture: &CurveMixture) -> Vec<Mode> {
    let mode = |component: &impactlab_core::uncertainty::CurveComponent| {
        let mean = ForceCurve::from_values(&component.mean);
        Mode {
            weight: component.weight,
            impulse_n_s: mean.impulse_n_s(),
            peak_n: mean.peak().0,
            duration_s: mean.duration_s,
        }
    };
    let mut modes: Vec<Mode> = mixture.components().iter().map(mode).collect();
    modes.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    modes
}

/// Classic pulses of all shapes that carry a given impulse, from the start of the time grid.
///
/// - `impulse_n_s`: [P_x, P_y], N s.
/// - `duration_s`: positive.
///
/// # Errors
/// [`PulseError`] for a duration that is not positive.
pub fn pulse_curves(
    impulse_n_s: [f64; 2],
    duration_s: f64,
) -> Result<Vec<(PulseShape, ForceCurve)>, PulseError> {
    let curve = |shape: PulseShape| {
        let history =
            Pulse::new(shape, impulse_n_s, 0.0, duration_s)?.to_history(CURVE_INTERVAL_S)?;
        Ok((shape, ForceCurve { fx_n: history.fx_n, fy_n: history.fy_n, duration_s }))
    };
    PulseShape::ALL.into_iter().map(curve).collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use impactlab_core::uncertainty::CurveComponent;

    /// Half-sine pulses along y, with a share along x, whose height is changed by one latent
    /// factor.
    fn example() -> CurveMixture {
        let component = |(weight, height_n): (f64, f64)| {
            let sine = |i: usize| (std::f64::consts::PI * (i as f64 + 0.5) / 60.0).sin();
            let force: Vec<f64> = (0..60).map(|i| height_n * sine(i)).collect();
            let mean = [force.iter().map(|f| 0.2 * f).collect(), force, vec![0.06]].concat();
            let factor: Vec<f64> = mean.iter().map(|value| 0.1 * value).collect();
            let mut variance = vec![1e4; 121];
            variance[120] = 1e-6;
            let factors = DMatrix::from_column_slice(121, 1, &factor);
            CurveComponent { weight, mean, factors, variance, lag_correlation: 0.0 }
        };
        CurveMixture::new([(0.3, 50e3), (0.7, 80e3)].map(component).to_vec()).unwrap()
    }

    #[test]
    fn numbers_lie_inside_their_intervals_and_the_intervals_in_each_other() {
        let settings = ForecastSettings { n_curves: 5, seed: 3 };
        let forecast = ForceForecast::of(&example(), settings).unwrap();
        let [px, py] = &forecast.impulse_n_s;
        for (name, spread) in [
            ("P_x", px.clone()),
            ("P_y", py.clone()),
            ("|P|", forecast.impulse_magnitude_n_s.clone()),
            ("peak", forecast.peak_n.clone()),
            ("its time", forecast.peak_time_s.clone()),
            ("duration", forecast.duration_s.clone()),
            ("PDOF", forecast.pdof_rad.clone()),
        ] {
            let spread = spread.spread();
            let [low, high] = spread.half;
            assert!(low <= spread.median && spread.median <= high, "{name}: {spread:?}");
            assert!(spread.ninety[0] <= low && high <= spread.ninety[1], "{name}: {spread:?}");
        }
        assert_eq!((forecast.curves.len(), forecast.bands.fx.len()), (5, 4));
        assert!(forecast.modes.windows(2).all(|pair| pair[0].weight >= pair[1].weight));
        assert_eq!(forecast, ForceForecast::of(&example(), settings).unwrap());
    }

    #[test]
    fn a_direction_from_straight_ahead_does_not_jump() {
        let impulses: Vec<[f64; 2]> = (-10..=10).map(|i| [-1000.0, 20.0 * f64::from(i)]).collect();
        for mean in [[-1000.0, 100.0], [-1000.0, -100.0]] {
            let spread = pdof_rad(mean, &impulses).spread();
            let [low, high] = spread.ninety;
            assert!((0.0..TAU).contains(&spread.median), "{spread:?}");
            assert!((high - low - 0.358).abs() < 0.01, "{spread:?}");
        }
    }

    #[test]
    fn pulses_carry_the_impulse() {
        for (shape, curve) in pulse_curves([500.0, -3000.0], 0.0834).unwrap() {
            let [px, py] = curve.impulse_n_s();
            assert!((px - 500.0).abs() < 1e-9 && (py + 3000.0).abs() < 1e-9, "{shape:?}");
        }
        assert!(pulse_curves([1.0, 1.0], 0.0).is_err());
    }
}
