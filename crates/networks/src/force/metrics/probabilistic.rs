//! Scores of the distribution predicted for one case.
//!
//! Forces are compared at every instant and along both axes from the start of the record to the end
//! of the contact. Later instants are left out because curve and bands are zero there, which would
//! improve every score. Impulse, peak and duration count once for each case.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use crate::force::ForceCase;
use impactlab_core::uncertainty::{
    CURVE_INTERVAL_S, CurveMixture, CurveQuantities, MixtureError, energy_score_n, sample_crps,
};

/// Nominal shares of the bands.
pub const BAND_LEVELS: [f64; 4] = [0.5, 0.8, 0.9, 0.95];

/// Number of bins of the histograms of the probability integral transform.
pub const N_PIT_BINS: usize = 10;

/// Settings of the scores that are computed from drawn curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProbabilisticSettings {
    /// Number of curves drawn for each case.
    pub n_samples: usize,
    /// Seed of the draws.
    pub seed: u64,
}

impl Default for ProbabilisticSettings {
    fn default() -> Self {
        Self { n_samples: 400, seed: 0 }
    }
}

/// Whether the intervals of one quantity contain the observed value, for each of [`BAND_LEVELS`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CaseCoverage {
    /// Share of the observed values inside; 0 or 1 for a quantity that counts once.
    pub share: [f64; 4],
    /// Mean width, in the unit of the quantity.
    pub width: [f64; 4],
}

/// Scores of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbabilisticScores {
    /// Coverage of F_x(t) and F_y(t), N.
    pub force_n: CaseCoverage,
    /// Coverage of `|P|`, N s, from draws.
    pub impulse_n_s: CaseCoverage,
    /// Coverage of the largest `|F|`, N, from draws.
    pub peak_n: CaseCoverage,
    /// Coverage of the duration, s, exact.
    pub duration_s: CaseCoverage,
    /// Continuous ranked probability score of F_x(t) and F_y(t), mean, N, exact.
    pub crps_force_n: f64,
    /// The same of `|P|`, N s, by draws.
    pub crps_impulse_n_s: f64,
    /// The same of the largest `|F|`, N, by draws.
    pub crps_peak_n: f64,
    /// The same of the duration, s, exact.
    pub crps_duration_s: f64,
    /// Energy score of the whole curve, N, by draws.
    pub energy_score_n: f64,
    /// Negative log likelihood of the whole curve with its duration, nats (forces in N, duration
    /// in s).
    pub nll_nats: f64,
    /// Probability integral transform of every F_x(t) and F_y(t): counts in equal bins.
    pub pit_force: [u32; N_PIT_BINS],
    /// The same of P_x and P_y, exact.
    pub pit_impulse: [u32; N_PIT_BINS],
}

impl ProbabilisticScores {
    /// Scores of a distribution predicted for a case.
    ///
    /// - `stream`: number of the random stream, different for each case.
    ///
    /// # Errors
    /// [`MixtureError`] if the distribution is over another grid.
    pub fn new(
        case: &ForceCase,
        mixture: &CurveMixture,
        settings: ProbabilisticSettings,
        stream: u64,
    ) -> Result<Self, MixtureError> {
        let mut rng = ChaCha8Rng::seed_from_u64(settings.seed);
        rng.set_stream(stream);
        let nll_nats = -mixture.log_density(&case.curve)?;
        let (draws, quantities) = mixture.sample_quantities(settings.n_samples, &mut rng);
        let [px, py] = case.impulse_n_s;
        let (impulse, duration_s) = (px.hypot(py), case.curve.duration_s);
        let impulses = quantities.impulse_magnitude_n_s();
        let durations = mixture.duration_s();
        let mut pit_impulse = [0; N_PIT_BINS];
        for (axis, observed) in case.impulse_n_s.into_iter().enumerate() {
            pit_impulse[bin(mixture.impulse(axis).cdf(observed))] += 1;
        }
        let force = ForceScores::new(case, mixture)?;
        Ok(Self {
            force_n: force.covered,
            impulse_n_s: CaseCoverage::by_draws(&impulses, impulse),
            peak_n: CaseCoverage::by_draws(&quantities.peak_n, case.peak_n),
            duration_s: CaseCoverage::one(|level| Some(durations.interval(level)), duration_s),
            crps_force_n: force.crps_n,
            crps_impulse_n_s: sample_crps(&impulses, impulse),
            crps_peak_n: sample_crps(&quantities.peak_n, case.peak_n),
            crps_duration_s: durations.crps(duration_s),
            energy_score_n: energy_score_n(&draws, &case.curve),
            nll_nats,
            pit_force: force.pit,
            pit_impulse,
        })
    }
}

impl CaseCoverage {
    fn by_draws(draws: &[f64], observed: f64) -> Self {
        Self::one(|level| CurveQuantities::interval(draws, level), observed)
    }

    fn one(interval: impl Fn(f64) -> Option<[f64; 2]>, observed: f64) -> Self {
        let mut covered = Self::default();
        for (i, &level) in BAND_LEVELS.iter().enumerate() {
            let Some([low, high]) = interval(level) else { continue };
            covered.share[i] = if (low..=high).contains(&observed) { 1.0 } else { 0.0 };
            covered.width[i] = high - low;
        }
        covered
    }
}

/// Scores of the forces over the contact.
struct ForceScores {
    covered: CaseCoverage,
    crps_n: f64,
    pit: [u32; N_PIT_BINS],
}

impl ForceScores {
    fn new(case: &ForceCase, mixture: &CurveMixture) -> Result<Self, MixtureError> {
        let n_instants = mixture.n_instants();
        let n_contact = n_contact_instants(case).min(n_instants);
        let bands = mixture.bands(&BAND_LEVELS)?;
        let mut scores =
            Self { covered: CaseCoverage::default(), crps_n: 0.0, pit: [0; N_PIT_BINS] };
        let n_values = (2 * n_contact).max(1) as f64;
        let axes = [(&case.curve.fx_n, &bands.fx), (&case.curve.fy_n, &bands.fy)];
        for (axis, (observed, bands)) in axes.into_iter().enumerate() {
            for (i, &observed) in observed.iter().enumerate().take(n_contact) {
                let Some(value) = mixture.value(axis * n_instants + i) else { continue };
                scores.crps_n += value.crps(observed) / n_values;
                scores.pit[bin(value.cdf(observed))] += 1;
                for (k, band) in bands.iter().enumerate() {
                    let (low, high) = (band.lower_n[i], band.upper_n[i]);
                    scores.covered.width[k] += (high - low) / n_values;
                    if (low..=high).contains(&observed) {
                        scores.covered.share[k] += 1.0 / n_values;
                    }
                }
            }
        }
        Ok(scores)
    }
}

/// Instants from the start of the record to the end of the contact.
fn n_contact_instants(case: &ForceCase) -> usize {
    let end_s = case.onset_s + case.curve.duration_s;
    ((end_s / CURVE_INTERVAL_S).ceil().max(1.0) as usize).min(case.curve.n_instants())
}

fn bin(probability: f64) -> usize {
    ((probability * N_PIT_BINS as f64) as usize).min(N_PIT_BINS - 1)
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::force::input::shipped;
    use impactlab_core::uncertainty::{CurveComponent, ForceCurve, PeakFactors};

    /// A coherent normal distribution about a curve.
    fn about(curve: &ForceCurve) -> CurveMixture {
        let mean = curve.to_values();
        let n = mean.len();
        let factor = mean.iter().map(|value| 0.2 * value);
        let factors = DMatrix::from_iterator(n, 1, factor);
        let mut variance = vec![4e4; n];
        variance[n - 1] = 1e-4;
        let lag_correlation = 0.0;
        let component = CurveComponent {
            weight: 1.0,
            mean,
            factors,
            variance,
            lag_correlation,
            peak: PeakFactors::default(),
        };
        CurveMixture::new(vec![component]).unwrap()
    }

    /// Curves drawn from the predicted distribution itself are covered as often as the levels say.
    #[test]
    fn a_true_distribution_is_calibrated() {
        let mut case = shipped("fea")[0].clone();
        let mixture = about(&case.curve);
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        let n = 200;
        let mut shares = [[0.0; 4]; 4];
        for (stream, curve) in mixture.sample(n, &mut rng).into_iter().enumerate() {
            case.impulse_n_s = curve.impulse_n_s();
            (case.peak_n, case.peak_time_s) = curve.peak();
            case.curve = curve;
            let settings = ProbabilisticSettings { n_samples: 300, seed: 1 };
            let scores =
                ProbabilisticScores::new(&case, &mixture, settings, stream as u64).unwrap();
            let quantities = [scores.force_n, scores.impulse_n_s, scores.peak_n, scores.duration_s];
            for (sums, covered) in shares.iter_mut().zip(quantities) {
                for (sum, share) in sums.iter_mut().zip(covered.share) {
                    *sum += share / n as f64;
                }
            }
        }
        for (name, shares) in ["force", "impulse", "peak", "duration"].iter().zip(shares) {
            for (share, level) in shares.into_iter().zip(BAND_LEVELS) {
                // Three standard errors of a share, and that of the drawn quantiles.
                let bound = 3.0 * (level * (1.0 - level) / n as f64).sqrt() + 0.02;
                assert!((share - level).abs() < bound, "{name} {level}: {share}");
            }
        }
    }

    #[test]
    fn a_better_distribution_scores_better() {
        let cases = shipped("fea");
        let (case, other) = (&cases[0], &cases[1]);
        let score = |curve: &ForceCurve| {
            let settings = ProbabilisticSettings { n_samples: 100, seed: 1 };
            ProbabilisticScores::new(case, &about(curve), settings, 0).unwrap()
        };
        let (good, bad) = (score(&case.curve), score(&other.curve));
        assert!(good.crps_force_n < bad.crps_force_n && good.nll_nats < bad.nll_nats);
        assert!(good.energy_score_n < bad.energy_score_n);
        assert_eq!(good.pit_force.iter().sum::<u32>() as usize, 2 * n_contact_instants(case));
        assert_eq!(good.pit_impulse.iter().sum::<u32>(), 2);
    }
}
