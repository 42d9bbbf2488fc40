//! Numbers as a person would write them.

/// The nearest multiple of a step. Where a whole number of steps make 1, as of 0.01, it is the nearest to
/// that of the decimals, so that it is written with no more of them.
///
/// ```
/// # use impactlab_core::numerics::nearest_multiple;
/// assert_eq!(nearest_multiple(0.571, 0.01), 0.57);
/// assert_eq!(nearest_multiple(17.0, 5.0), 15.0);
/// ```
pub fn nearest_multiple(value: f64, step: f64) -> f64 {
    let per_unit = step.recip();
    let whole = per_unit.round();
    match whole > 0.0 && (per_unit - whole).abs() < 1e-9 * whole {
        true => (value * whole).round() / whole,
        false => (value / step).round() * step,
    }
}
