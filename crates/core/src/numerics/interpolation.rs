//! Interpolation between samples.

/// Interpolates `values` over `grid` linearly at `at`. Outside the grid the first or the last value
/// is returned.
///
/// - `grid`: strictly increasing.
/// - `values`: one per point of the grid.
/// - returns `None` if the grid is empty or a value that is needed is missing.
///
/// ```
/// # use impactlab_core::numerics::interpolate;
/// assert_eq!(interpolate(&[0.0, 2.0], &[10.0, 20.0], 0.5), Some(12.5));
/// assert_eq!(interpolate(&[0.0, 2.0], &[10.0, 20.0], 9.0), Some(20.0));
/// ```
pub fn interpolate(grid: &[f64], values: &[f64], at: f64) -> Option<f64> {
    let after = grid.partition_point(|&g| g <= at);
    let Some(before) = after.checked_sub(1) else {
        return values.first().copied();
    };
    let (&g0, &v0) = (grid.get(before)?, values.get(before)?);
    let (Some(&g1), Some(&v1)) = (grid.get(after), values.get(after)) else {
        return Some(v0);
    };
    Some(v0 + (v1 - v0) * (at - g0) / (g1 - g0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_met_and_ends_are_held() {
        let (grid, values) = ([0.0, 1.0, 3.0], [5.0, 7.0, 1.0]);
        for (at, expected) in [(-1.0, 5.0), (0.0, 5.0), (1.0, 7.0), (2.0, 4.0), (3.0, 1.0)] {
            assert_eq!(interpolate(&grid, &values, at), Some(expected), "at {at}");
        }
        assert_eq!(interpolate(&[], &[], 0.0), None);
    }
}
