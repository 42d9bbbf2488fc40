//! Probability distribution of a whole force curve and its duration: a mixture of multivariate
//! normal distributions with structured covariances.
//!
//! ```text
//! y = [F_x(t₁) … F_x(t_T), F_y(t₁) … F_y(t_T), duration]
//! p(y) = Σ_k π_k N(y; m_k, U_k U_kᵀ + √D_k R_k √D_k)      D_k = diag d_k
//! R_k[i, j] = φ_k^|i − j| within F_x and within F_y, else δ_ij
//! ```
//!
//! A component k holds for a whole curve, and its few latent factors, the columns of `U_k`, act on
//! all instants. The spread of the curves therefore does not average out in the impulse, as it
//! would with independent draws at each instant.
//!
//! The residual that the factors do not explain is a first-order autoregressive process along each
//! axis: residuals of neighbouring instants have the correlation φ, and φ = 0 gives a diagonal
//! covariance. The force oscillations of a structure are correlated over a few instants; white
//! noise of the same size would make the peaks of drawn curves too high. The paper's mixture
//! ([`PitPinnPaper`](crate::bibliography::PitPinnPaper), `eq:gmmfunction`) has diagonal
//! covariances.
//!
//! Left out: bounds. A duration or a force drawn far from its mean may have the wrong sign.

use nalgebra::DMatrix;

use crate::uncertainty::{
    CURVE_INTERVAL_S, ForceCurve, MixtureError, NormalMixture, NormalPart, PeakFactors,
};

/// One component of a [`CurveMixture`]. With T instants a row has 2T + 1 values: forces in N, then
/// the duration in s.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveComponent {
    /// Weight π of the component in the mixture, 0 to 1.
    pub weight: f64,
    /// Mean curve m, `[2T + 1]`.
    pub mean: Vec<f64>,
    /// Latent factors U, `[2T + 1, q]`: each column is the change of the curve by one standard
    /// deviation of a factor.
    pub factors: DMatrix<f64>,
    /// Variance d of the residual that the factors do not explain, for each value, `[2T + 1]`,
    /// positive.
    pub variance: Vec<f64>,
    /// Correlation φ of the residuals of neighbouring instants, `0 ≤ φ < 1`.
    pub lag_correlation: f64,
    /// How the peak of a drawn curve is told.
    pub peak: PeakFactors,
}

/// A mixture of [`CurveComponent`]s whose weights sum to one, whose shapes are equal and whose
/// variances are positive.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveMixture {
    components: Vec<CurveComponent>,
}

impl CurveMixture {
    /// Makes a mixture of components and scales their weights to sum to one.
    ///
    /// # Errors
    /// [`MixtureError::Empty`], [`MixtureError::Weight`] or [`MixtureError::NoWeight`] for the
    /// weights; [`MixtureError::Shape`], [`MixtureError::NotFinite`],
    /// [`MixtureError::LagCorrelation`] or [`MixtureError::Variance`] for the first component that
    /// is not valid.
    pub fn new(mut components: Vec<CurveComponent>) -> Result<Self, MixtureError> {
        let weights: Vec<f64> = components.iter().map(|component| component.weight).collect();
        let sum = MixtureError::check_weights(&weights)?;
        let expected = components.first().map_or(0, |first| first.mean.len() / 2 * 2 + 1);
        for (idx, component) in components.iter_mut().enumerate() {
            component.weight /= sum;
            component.check(idx, expected)?;
        }
        Ok(Self { components })
    }

    /// Merges several mixtures into one, for example those of an ensemble, or those for several
    /// values of an unknown input.
    ///
    /// - `weighted`: weight (0 or more; scaled to sum to one) and mixture.
    ///
    /// # Errors
    /// [`MixtureError::Empty`], [`MixtureError::Weight`] or [`MixtureError::NoWeight`] for the
    /// weights, [`MixtureError::Shape`] for mixtures over different grids.
    pub fn merge(weighted: Vec<(f64, Self)>) -> Result<Self, MixtureError> {
        let weights: Vec<f64> = weighted.iter().map(|(weight, _)| *weight).collect();
        MixtureError::check_weights(&weights)?;
        let components = weighted.into_iter().flat_map(|(share, mixture)| {
            let scale = move |component: CurveComponent| CurveComponent {
                weight: component.weight * share,
                ..component
            };
            mixture.components.into_iter().map(scale)
        });
        Self::new(components.collect())
    }

    /// Changes each component in place. The result is not checked: `change` must keep shapes and
    /// weights and leave values that are valid.
    pub fn map_components(mut self, change: impl Fn(&mut CurveComponent)) -> Self {
        self.components.iter_mut().for_each(change);
        self
    }

    /// The components of the mixture.
    pub fn components(&self) -> &[CurveComponent] {
        &self.components
    }

    /// Number of instants T of the time grid.
    pub fn n_instants(&self) -> usize {
        self.components.first().map_or(0, |first| first.mean.len() / 2)
    }

    /// Mean curve and mean duration of the mixture.
    pub fn mean(&self) -> ForceCurve {
        let mut mean = vec![0.0; 2 * self.n_instants() + 1];
        for component in &self.components {
            for (sum, value) in mean.iter_mut().zip(&component.mean) {
                *sum += component.weight * value;
            }
        }
        ForceCurve::from_values(&mean)
    }

    /// Standard deviation of each force and of the duration, from the spread within the components
    /// and between them.
    pub fn std(&self) -> ForceCurve {
        let mean = self.mean().to_values();
        let mut variance = vec![0.0; mean.len()];
        for component in &self.components {
            let within = component.total_variance();
            let values = variance.iter_mut().zip(&mean).zip(component.mean.iter().zip(within));
            for ((sum, mean), (value, within)) in values {
                *sum += component.weight * (within + (value - mean).powi(2));
            }
        }
        let std: Vec<f64> = variance.into_iter().map(f64::sqrt).collect();
        ForceCurve::from_values(&std)
    }

    /// The distribution for the collision mirrored left to right: `F_y` changes its sign.
    #[must_use]
    pub fn mirrored(mut self) -> Self {
        let n_instants = self.n_instants();
        for component in &mut self.components {
            for value in component.mean.iter_mut().skip(n_instants).take(n_instants) {
                *value = -*value;
            }
            component.factors.rows_mut(n_instants, n_instants).neg_mut();
        }
        self
    }

    /// Marginal distribution of one value of the row: F_x at instant i for index i, F_y for T + i,
    /// the duration for 2T. `None` for an index beyond the row.
    pub fn value(&self, value_idx: usize) -> Option<NormalMixture> {
        let part = |component: &CurveComponent| {
            let row = component.factors.row_iter().nth(value_idx)?;
            let variance = component.variance.get(value_idx)? + row.norm_squared();
            let (weight, mean) = (component.weight, *component.mean.get(value_idx)?);
            Some(NormalPart { weight, mean, std: variance.sqrt() })
        };
        let parts: Option<Vec<_>> = self.components.iter().map(part).collect();
        Some(NormalMixture::from_checked(parts?))
    }

    /// Distribution of the contact duration, s.
    pub fn duration_s(&self) -> NormalMixture {
        self.linear(&|value_idx| if value_idx == 2 * self.n_instants() { 1.0 } else { 0.0 })
    }

    /// Distribution of the impulse along x (`axis` 0) or y (`axis` 1), N s. It is exact, because
    /// the impulse is a weighted sum of the forces.
    pub fn impulse(&self, axis: usize) -> NormalMixture {
        let n_instants = self.n_instants();
        self.linear(&|value_idx| match value_idx.checked_sub(axis * n_instants) {
            Some(idx) if idx < n_instants => CURVE_INTERVAL_S,
            _ => 0.0,
        })
    }

    /// Exact distribution of the linear combination `Σ_i c_i y_i` of the values of a row.
    ///
    /// ```text
    /// Σ_k π_k N(cᵀ m_k, |U_kᵀ c|² + cᵀ √D_k R_k √D_k c)
    /// ```
    ///
    /// - `coefficient`: gives c_i for the index i of a value, 0 to 2T.
    pub fn linear(&self, coefficient: &dyn Fn(usize) -> f64) -> NormalMixture {
        let part = |component: &CurveComponent| {
            let c: Vec<f64> = (0..component.mean.len()).map(coefficient).collect();
            let dot = |values: &mut dyn Iterator<Item = &f64>| -> f64 {
                values.zip(&c).map(|(value, c)| value * c).sum()
            };
            let factors = component.factors.column_iter();
            let shared: f64 = factors.map(|column| dot(&mut column.iter()).powi(2)).sum();
            // A quadratic form of a covariance: below zero by rounding errors alone.
            let own = component.own_variance_of(&c).max(0.0);
            NormalPart {
                weight: component.weight,
                mean: dot(&mut component.mean.iter()),
                std: (shared + own).sqrt(),
            }
        };
        NormalMixture::from_checked(self.components.iter().map(part).collect())
    }
}

impl CurveComponent {
    /// Variance of each value, `[2T + 1]`: the sum of the squared factors and the residual
    /// variance.
    pub(crate) fn total_variance(&self) -> Vec<f64> {
        let mut variance = self.variance.clone();
        for column in self.factors.column_iter() {
            for (sum, factor) in variance.iter_mut().zip(column.iter()) {
                *sum += factor * factor;
            }
        }
        variance
    }

    /// Variance `cᵀ √D R √D c` of the residual's part of `Σ_i c_i y_i`, computed in one pass along
    /// each axis.
    fn own_variance_of(&self, c: &[f64]) -> f64 {
        let scaled: Vec<f64> = self.variance.iter().zip(c).map(|(d, c)| c * d.sqrt()).collect();
        let n_instants = scaled.len() / 2;
        let of_axis = |axis: &[f64]| {
            let (mut sum, mut carried) = (0.0, 0.0);
            for value in axis {
                carried = value + self.lag_correlation * carried;
                sum += value * (2.0 * carried - value);
            }
            sum
        };
        scaled.chunks(n_instants.max(1)).map(of_axis).sum()
    }

    /// Whitens a row: if its covariance is √D R √D, the covariance of the result is the identity.
    ///
    /// ```text
    /// z_i = (x_i/√d_i − φ x_(i−1)/√d_(i−1)) / √(1 − φ²)      z = x/√d at the first of an axis
    /// ```
    pub(super) fn whitened<'a>(&self, row: impl Iterator<Item = &'a f64>) -> Vec<f64> {
        let mut z: Vec<f64> = row.zip(&self.variance).map(|(x, d)| x / d.sqrt()).collect();
        let (n_instants, phi) = (z.len() / 2, self.lag_correlation);
        let scale = (1.0 - phi * phi).sqrt();
        for axis in z.chunks_mut(n_instants.max(1)) {
            for i in (1..axis.len()).rev() {
                axis[i] = (axis[i] - phi * axis[i - 1]) / scale;
            }
        }
        z
    }

    /// Checks the shapes and values of a component.
    ///
    /// - `component`: its index, for error messages.
    /// - `expected`: number of values of a row, 2T + 1.
    fn check(&self, component: usize, expected: usize) -> Result<(), MixtureError> {
        for (what, got) in [
            ("mean", self.mean.len()),
            ("factors", self.factors.nrows()),
            ("variance", self.variance.len()),
        ] {
            if got != expected {
                return Err(MixtureError::Shape { component, what, expected, got });
            }
        }
        let finite = [
            ("mean", self.mean.iter().all(|value| value.is_finite())),
            ("factors", self.factors.iter().all(|value| value.is_finite())),
            ("peak factors", self.peak.scale.is_finite() && self.peak.spread.is_finite()),
        ];
        if let Some((what, _)) = finite.into_iter().find(|(_, finite)| !finite) {
            return Err(MixtureError::NotFinite { component, what });
        }
        if !(0.0..1.0).contains(&self.lag_correlation) {
            return Err(MixtureError::LagCorrelation { component, value: self.lag_correlation });
        }
        let is_bad = |variance: &f64| !(*variance > 0.0 && variance.is_finite());
        match self.variance.iter().copied().enumerate().find(|(_, variance)| is_bad(variance)) {
            Some((value_idx, variance)) => {
                Err(MixtureError::Variance { component, value_idx, variance })
            }
            None => Ok(()),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Mixture of smooth curves over `n_instants`, with two factors and components that differ.
    pub(crate) fn example(n_components: usize, n_instants: usize) -> CurveMixture {
        let component = |k: usize| {
            let (k, n) = (k as f64, n_instants as f64);
            let row = |values_at: &dyn Fn(f64) -> [f64; 3]| -> Vec<f64> {
                let values: Vec<[f64; 3]> =
                    (0..n_instants).map(|i| values_at(i as f64 / n)).collect();
                let axis = |axis: usize| values.iter().map(move |value| value[axis]);
                axis(0).chain(axis(1)).chain([values_at(0.0)[2]]).collect()
            };
            let bump = |u: f64| (std::f64::consts::PI * u).sin();
            let mean = row(&|u| [(4.0 + k) * 1e3 * bump(u), (20.0 - 3.0 * k) * 1e3 * bump(u), 0.1]);
            let first = row(&|u| [500.0 * bump(u), 3e3 * bump(u), 0.01]);
            let second = row(&|u| [800.0 * bump(2.0 * u), 1e3 * bump(2.0 * u), -0.02]);
            let variance = row(&|u| [1e4 + 2e4 * u, 4e4 + k, 1e-4]);
            let factors = DMatrix::from_iterator(mean.len(), 2, first.into_iter().chain(second));
            let lag_correlation = 0.9 * k / (1.0 + k);
            let peak = PeakFactors::default();
            CurveComponent { weight: 1.0 + k, mean, factors, variance, lag_correlation, peak }
        };
        CurveMixture::new((0..n_components).map(component).collect()).unwrap()
    }

    /// Full covariance matrix of a component, `[2T + 1, 2T + 1]`.
    pub(crate) fn covariance(component: &CurveComponent) -> DMatrix<f64> {
        let (n, d) = (component.mean.len(), &component.variance);
        let own = DMatrix::from_fn(n, n, |i, j| {
            let axis = |idx: usize| idx / (n / 2);
            let lag = if i == j { 0 } else { i.abs_diff(j) };
            let correlation = match axis(i) == axis(j) {
                true => component.lag_correlation.powi(lag as i32),
                false => 0.0,
            };
            correlation * (d[i] * d[j]).sqrt()
        });
        &component.factors * component.factors.transpose() + own
    }

    #[test]
    fn moments_agree_with_those_of_each_value() {
        let mixture = example(3, 5);
        let (mean, std) = (mixture.mean().to_values(), mixture.std().to_values());
        for (i, (mean, std)) in mean.iter().zip(&std).enumerate() {
            let value = mixture.value(i).unwrap();
            assert!((value.mean() - mean).abs() <= 1e-9 * mean.abs(), "value {i}");
            assert!((value.std() - std).abs() < 1e-9 * std, "value {i}");
        }
        assert_eq!(mixture.value(11), None);
        assert!((mixture.duration_s().std() - std[10]).abs() < 1e-15);
    }

    #[test]
    fn the_impulse_has_the_covariance_of_the_sum() {
        let mixture = example(2, 40);
        for axis in [0, 1] {
            for (k, part) in mixture.impulse(axis).parts().iter().enumerate() {
                let component = &mixture.components()[k];
                let dense = covariance(component);
                let block = dense.view((axis * 40, axis * 40), (40, 40));
                let expected = block.sum().sqrt() * CURVE_INTERVAL_S;
                assert!((part.std - expected).abs() < 1e-9 * expected, "axis {axis}, {k}");
            }
            let [p_mean, p] = [mixture.mean().impulse_n_s()[axis], mixture.impulse(axis).mean()];
            assert!((p_mean - p).abs() < 1e-9, "axis {axis}: {p_mean} {p}");
        }
    }

    #[test]
    fn merging_weights_the_parts() {
        let (one, two) = (example(1, 4), example(3, 4));
        let merged = CurveMixture::merge(vec![(1.0, one.clone()), (3.0, two.clone())]).unwrap();
        assert_eq!(merged.components().len(), 4);
        let expected = (one.mean().fy_n[1] + 3.0 * two.mean().fy_n[1]) / 4.0;
        assert!((merged.mean().fy_n[1] - expected).abs() < 1e-9);
        assert!(CurveMixture::merge(vec![(1.0, one), (1.0, example(1, 5))]).is_err());
        assert_eq!(CurveMixture::merge(vec![]), Err(MixtureError::Empty));
    }

    #[test]
    fn mirrored_twice_is_the_same() {
        let mixture = example(2, 4);
        let mirrored = mixture.clone().mirrored();
        assert_eq!(mirrored.mean(), mixture.mean().mirrored());
        assert_eq!(mirrored.impulse(1).mean(), -mixture.impulse(1).mean());
        assert_eq!(mirrored.mirrored(), mixture);
    }

    #[test]
    fn senseless_components_are_refused() {
        let good = || example(1, 2).components()[0].clone();
        let refused = |bad: CurveComponent| CurveMixture::new(vec![bad]).unwrap_err();
        let mut bad = good();
        bad.variance[1] = 0.0;
        assert!(matches!(refused(bad), MixtureError::Variance { value_idx: 1, .. }));
        let mut bad = good();
        bad.variance.pop();
        assert!(matches!(refused(bad), MixtureError::Shape { expected: 5, got: 4, .. }));
        let bad = CurveComponent { lag_correlation: 1.0, ..good() };
        assert!(matches!(refused(bad), MixtureError::LagCorrelation { .. }));
        let mut bad = good();
        bad.mean[0] = f64::NAN;
        assert!(matches!(refused(bad), MixtureError::NotFinite { what: "mean", .. }));
        let peak = PeakFactors { scale: f64::NAN, spread: 1.0 };
        let bad = CurveComponent { peak, ..good() };
        assert!(matches!(refused(bad), MixtureError::NotFinite { what: "peak factors", .. }));
        let bad = CurveComponent { weight: -1.0, ..good() };
        assert!(matches!(refused(bad), MixtureError::Weight { .. }));
        assert_eq!(refused(CurveComponent { weight: 0.0, ..good() }), MixtureError::NoWeight);
        assert_eq!(CurveMixture::new(vec![]), Err(MixtureError::Empty));
    }
}
