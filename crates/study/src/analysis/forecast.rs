//! A predicted impact force in the form in which it is shown: bands, mean curve, drawn curves, and
//! scalar quantities with their intervals.

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use impactlab_core::collision::{PrincipalDirectionOfForce, Pulse, PulseError, PulseShape};
use impactlab_core::numerics::{median, quantile_of_sorted, random_stream, wrap_angle_rad};
use impactlab_core::uncertainty::{
    CURVE_INTERVAL_S, CurveBands, CurveComponent, CurveMixture, ForceCurve, MixtureError,
    NormalMixture,
};
use impactlab_core::units::{Estimate, Interval};
use impactlab_networks::force::metrics::BAND_LEVELS;

/// Number of curves drawn for quantities whose distribution has no closed form; a 5 % tail then has
/// 100 of them.
const N_DRAWS: usize = 2000;
/// The same for the peak of one component, of which the median alone is told.
const N_COURSE_DRAWS: usize = 100;

/// Number of whole curves to show, and seed of the draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ForecastSettings {
    /// Number of curves to show.
    pub n_curves: usize,
    /// Seed of all random draws.
    pub seed: u64,
}

/// One component of the predicted mixture: one of the possible courses of the collision.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Mode {
    /// Probability of the component, 0 to 1.
    pub weight: f64,
    /// Impulse `[P_x, P_y]` of the component's mean curve, N s.
    pub impulse_n_s: [f64; 2],
    /// Largest `|F|` of the component, N: the median of draws with its
    /// [`PeakFactors`](impactlab_core::uncertainty::PeakFactors).
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
    /// Largest `|F|`, N, from draws, with the [`PeakFactors`](impactlab_core::uncertainty::PeakFactors) of
    /// their components.
    pub peak_n: Estimate,
    /// Time at which the largest `|F|` occurs, s, from draws.
    pub peak_time_s: Estimate,
    /// Contact duration, s, from the exact distribution; not below zero.
    pub duration_s: Estimate,
    /// Principal direction of force on the struck vehicle, rad clockwise from straight ahead, from
    /// draws. The median lies in `[0, 2π)`; the ends of the intervals continue from it without a
    /// jump and may lie outside of this range.
    pub pdof_rad: Estimate,
    /// Components of the mixture, in descending order of probability.
    pub modes: Vec<Mode>,
}

/// Median and the intervals at [`BAND_LEVELS`] of a normal mixture.
fn bands_of(distribution: &NormalMixture) -> Estimate {
    estimate(|probability| distribution.quantile(probability))
}

/// Median and the intervals at [`BAND_LEVELS`] of draws; NaN without any.
pub(crate) fn bands_of_draws(mut draws: Vec<f64>) -> Estimate {
    draws.sort_by(f64::total_cmp);
    estimate(|probability| quantile_of_sorted(&draws, probability).unwrap_or(f64::NAN))
}

/// Median and the intervals at [`BAND_LEVELS`] of a distribution.
fn estimate(quantile: impl Fn(f64) -> f64) -> Estimate {
    let interval = |level: f64| Interval {
        level,
        low: quantile((1.0 - level) / 2.0),
        high: quantile((1.0 + level) / 2.0),
    };
    let intervals = BAND_LEVELS.into_iter().map(interval).collect();
    Estimate { median: quantile(0.5), intervals }
}

impl ForceForecast {
    /// Prepares a predicted distribution of curves for display. The curves shown are the first of
    /// the draws from which the intervals are computed.
    ///
    /// # Errors
    /// [`MixtureError`], which does not occur with a mixture that was checked when it was made.
    pub fn new(mixture: &CurveMixture, settings: ForecastSettings) -> Result<Self, MixtureError> {
        let mut rng = random_stream(settings.seed, "draws", 0);
        let n_draws = N_DRAWS.max(settings.n_curves);
        let drawn = || mixture.sample_quantities(n_draws, &mut rng);
        let ((mut curves, draws), modes) = rayon::join(drawn, || modes(mixture, settings.seed));
        curves.truncate(settings.n_curves);
        // As drawn: what lies below zero is zero.
        let duration_s = bands_of(&mixture.duration_s()).mapped(|time_s| time_s.max(0.0));
        let mean = ForceCurve { duration_s: duration_s.median, ..mixture.mean() };
        Ok(Self {
            bands: mixture.bands(&BAND_LEVELS)?,
            impulse_n_s: [0, 1].map(|axis| bands_of(&mixture.impulse(axis))),
            impulse_magnitude_n_s: bands_of_draws(draws.impulse_magnitude_n_s()),
            peak_n: bands_of_draws(draws.peak_n),
            peak_time_s: bands_of_draws(draws.peak_time_s),
            pdof_rad: pdof_rad(mean.impulse_n_s(), &draws.impulse_n_s),
            duration_s,
            mean,
            curves,
            modes: modes?,
        })
    }
}

/// Estimate of the principal direction of force from drawn impulses [x, y], N s. Angles are taken
/// relative to the direction of the impulse `mean`, so that the intervals do not jump at 2π, about a median that
/// is not told as a whole turn.
fn pdof_rad(mean: [f64; 2], impulses: &[[f64; 2]]) -> Estimate {
    let angle = |impulse| PrincipalDirectionOfForce::from_impulse(impulse, 0.0);
    let centre_rad = angle(mean).map_or(0.0, |pdof| pdof.angle_rad);
    let off = |impulse: &[f64; 2]| Some(wrap_angle_rad(angle(*impulse)?.angle_rad - centre_rad));
    let around = bands_of_draws(impulses.iter().filter_map(off).collect());
    let median = around.median + centre_rad;
    let within_a_turn = PrincipalDirectionOfForce::from_angle(median).centre_rad(0);
    let shift = centre_rad + within_a_turn - median;
    around.mapped(|angle| angle + shift)
}

/// Components of a mixture with the quantities that are shown, in descending order of weight.
fn modes(mixture: &CurveMixture, seed: u64) -> Result<Vec<Mode>, MixtureError> {
    let mode = |(idx, component): (usize, &CurveComponent)| -> Result<Mode, MixtureError> {
        let mean = ForceCurve::from_values(&component.mean);
        let alone = CurveMixture::new(vec![CurveComponent { weight: 1.0, ..component.clone() }])?;
        let mut rng = random_stream(seed, "peaks of a course", idx as u64);
        let (_, drawn) = alone.sample_quantities(N_COURSE_DRAWS, &mut rng);
        Ok(Mode {
            weight: component.weight,
            impulse_n_s: mean.impulse_n_s(),
            peak_n: median(drawn.peak_n).unwrap_or(0.0),
            duration_s: mean.duration_s.max(0.0),
        })
    };
    let modes = mixture.components().par_iter().enumerate().map(mode);
    let mut modes = modes.collect::<Result<Vec<Mode>, MixtureError>>()?;
    modes.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    Ok(modes)
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
    use impactlab_core::uncertainty::PeakFactors;

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
            CurveComponent {
                weight,
                mean,
                factors,
                variance,
                lag_correlation: 0.0,
                peak: PeakFactors::default(),
            }
        };
        CurveMixture::new([(0.3, 50e3), (0.7, 80e3)].map(component).to_vec()).unwrap()
    }

    #[test]
    fn numbers_lie_inside_their_intervals_and_the_intervals_in_each_other() {
        let settings = ForecastSettings { n_curves: 5, seed: 3 };
        let forecast = ForceForecast::new(&example(), settings).unwrap();
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
            let [low, high] = spread.half();
            assert!(low <= spread.median && spread.median <= high, "{name}: {spread:?}");
            assert!(spread.ninety()[0] <= low && high <= spread.ninety()[1], "{name}: {spread:?}");
        }
        assert_eq!((forecast.curves.len(), forecast.bands.fx.len()), (5, 4));
        assert!(forecast.modes.windows(2).all(|pair| pair[0].weight >= pair[1].weight));
        assert_eq!(forecast, ForceForecast::new(&example(), settings).unwrap());
    }

    /// The peaks of mean curves stood there, which are lower than those that are told above them.
    #[test]
    fn the_peak_of_a_course_is_told_as_that_of_the_answer() {
        let peak = PeakFactors { scale: 2.0, spread: 1.0 };
        let [plain, doubled] = [PeakFactors::default(), peak].map(|peak| {
            let mixture = example().map_components(|component| component.peak = peak);
            let settings = ForecastSettings { n_curves: 1, seed: 3 };
            ForceForecast::new(&mixture, settings).unwrap()
        });
        let modes = plain.modes.iter().zip(&doubled.modes);
        for (plain, doubled) in modes {
            assert!((doubled.peak_n / plain.peak_n - 2.0).abs() < 1e-9, "{plain:?} {doubled:?}");
        }
        let [low, high] = plain.peak_n.ninety();
        assert!(plain.modes.iter().all(|mode| (low..=high).contains(&mode.peak_n)));
    }

    /// The 90 % interval of a widened distribution began at −0.01 s.
    #[test]
    fn no_contact_lasts_for_less_than_no_time() {
        let wide = example().map_components(|component| {
            let last = component.variance.len() - 1;
            component.variance[last] = 0.05 * 0.05;
        });
        let settings = ForecastSettings { n_curves: 1, seed: 3 };
        let duration_s = ForceForecast::new(&wide, settings).unwrap().duration_s;
        assert!(wide.duration_s().quantile(0.05) < 0.0, "the example has some below");
        assert!(duration_s.ninety()[0] == 0.0 && duration_s.median > 0.05, "{duration_s:?}");
    }

    #[test]
    fn a_direction_from_straight_ahead_does_not_jump() {
        let impulses: Vec<[f64; 2]> = (-10..=10).map(|i| [-1000.0, 20.0 * f64::from(i)]).collect();
        for mean in [[-1000.0, 100.0], [-1000.0, -100.0]] {
            let spread = pdof_rad(mean, &impulses);
            let [low, high] = spread.ninety();
            assert!(spread.median.abs() < 1e-9, "straight ahead is 0, not 360 deg: {spread:?}");
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
