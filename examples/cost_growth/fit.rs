//! How a cost grows: a straight line through logarithms.

/// Exponent b of `cost = a nᵇ`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    /// b.
    pub exponent: f64,
    /// Its standard error, from the scatter about the line.
    pub standard_error: f64,
}

/// The larger half of points in the order of their sizes, but at least three.
pub fn upper_half<T>(points: &[T]) -> &[T] {
    let n = points.len().div_ceil(2).max(3);
    points.get(points.len().saturating_sub(n)..).unwrap_or_default()
}

/// The exponent by least squares.
///
/// - `points`: size and cost, both more than 0; at least three;
/// - returns `None` where they do not determine a line.
pub fn growth(points: &[(f64, f64)]) -> Option<Growth> {
    let logarithms: Vec<[f64; 2]> = points.iter().map(|&(n, cost)| [n.ln(), cost.ln()]).collect();
    if logarithms.len() < 3 || !logarithms.as_flattened().iter().all(|of| of.is_finite()) {
        return None;
    }
    let n = logarithms.len() as f64;
    let mean = |axis: usize| logarithms.iter().map(|at| at[axis]).sum::<f64>() / n;
    let (mean_x, mean_y) = (mean(0), mean(1));
    let product = |of: fn([f64; 2]) -> f64| -> f64 {
        logarithms.iter().map(|[x, y]| of([x - mean_x, y - mean_y])).sum()
    };
    let (xx, xy, yy) = (product(|[x, _]| x * x), product(|[x, y]| x * y), product(|[_, y]| y * y));
    let exponent = xy / xx;
    let unexplained = (yy - exponent * xy).max(0.0);
    let standard_error = (unexplained / (n - 2.0) / xx).sqrt();
    // Sizes that are all the same determine nothing but their rounding.
    (xx > 1e-12).then_some(Growth { exponent, standard_error })
}

/// The exponent that n log n has over the sizes of these points.
pub fn exponent_of_n_log_n(points: &[(f64, f64)]) -> Option<f64> {
    let points: Vec<(f64, f64)> = points.iter().map(|&(n, _)| (n, n * n.ln())).collect();
    Some(growth(&points)?.exponent)
}
