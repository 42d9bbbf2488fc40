//! Drawn curves as one component of a mixture.

use nalgebra::DMatrix;

use impactlab_core::uncertainty::{CurveComponent, ForceCurve, PeakFactors};

/// Number of latent factors of a component.
const N_FACTORS: usize = 8;

/// Smallest standard deviation of a force as a share of the peak. Finite-element runs repeated with
/// nearly the same speed and offset differ by 2 % of the peak and more.
pub(super) const FLOOR_SHARE_OF_PEAK: f64 = 0.01;

/// Smallest standard deviation of a duration, s: a step of the time grid.
const FLOOR_DURATION_S: f64 = 1e-3;

/// Mean of the rows of curves with their durations.
pub(super) fn mean_values(draws: &[ForceCurve]) -> Vec<f64> {
    let n = draws.len().max(1) as f64;
    let mut mean = draws.first().map_or(Vec::new(), |first| vec![0.0; first.to_values().len()]);
    for draw in draws {
        for (sum, value) in mean.iter_mut().zip(draw.to_values()) {
            *sum += value / n;
        }
    }
    mean
}

/// Peak of the mean curve, N.
pub(super) fn mean_peak_n(draws: &[ForceCurve]) -> f64 {
    ForceCurve::from_values(&mean_values(draws)).peak().0
}

/// The normal distribution with mean and variances of draws, and with the covariances of their leading
/// factors. Its weight is one.
///
/// - `own_std_n`: standard deviation that each force has besides that of the draws, N.
pub(super) fn component(draws: &[ForceCurve], own_std_n: Vec<f64>) -> CurveComponent {
    let mean = mean_values(draws);
    let scale = (draws.len().max(1) as f64).sqrt();
    let rows: Vec<Vec<f64>> = draws.iter().map(ForceCurve::to_values).collect();
    let centred = DMatrix::from_fn(mean.len(), rows.len(), |i, j| (rows[j][i] - mean[i]) / scale);
    let gram = centred.tr_mul(&centred).symmetric_eigen();
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by(|a, b| gram.eigenvalues[*b].total_cmp(&gram.eigenvalues[*a]));
    order.truncate(N_FACTORS);
    let leading =
        DMatrix::from_fn(rows.len(), order.len(), |i, j| gram.eigenvectors[(i, order[j])]);
    let factors = &centred * leading;
    let own = own_std_n.into_iter().chain([FLOOR_DURATION_S]);
    let left = centred.row_iter().zip(factors.row_iter());
    let variance = left
        .zip(own)
        .map(|((all, known), own)| (all.norm_squared() - known.norm_squared()).max(0.0) + own * own)
        .collect();
    CurveComponent {
        weight: 1.0,
        mean,
        factors,
        variance,
        lag_correlation: 0.0,
        peak: PeakFactors::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::uncertainty::CurveMixture;

    #[test]
    fn the_component_has_the_moments_of_the_draws() {
        let draws: Vec<ForceCurve> = (0..50)
            .map(|i| {
                let (a, b) = (f64::from(i).sin(), f64::from(i * i).cos());
                let fy_n: Vec<f64> =
                    (0..6).map(|t| 1e4 + 1e3 * a * f64::from(t) + 500.0 * b).collect();
                ForceCurve { fx_n: vec![200.0 * b; 6], fy_n, duration_s: 0.1 + 0.01 * a }
            })
            .collect();
        let mixture = CurveMixture::new(vec![component(&draws, vec![1.0; 12])]).unwrap();
        let n = draws.len() as f64;
        let impulses: Vec<f64> = draws.iter().map(|draw| draw.impulse_n_s()[1]).collect();
        let mean = impulses.iter().sum::<f64>() / n;
        let std = (impulses.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / n).sqrt();
        let impulse = mixture.impulse(1);
        assert!((impulse.mean() - mean).abs() < 1e-9, "{} {mean}", impulse.mean());
        assert!((impulse.std() / std - 1.0).abs() < 1e-3, "{} {std}", impulse.std());
        let durations = mixture.duration_s();
        assert!((durations.mean() - mean_values(&draws)[12]).abs() < 1e-12);
        assert!((0.005..0.01).contains(&durations.std()), "{}", durations.std());
    }
}
