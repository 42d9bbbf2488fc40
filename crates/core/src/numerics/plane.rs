//! Lines and polygons in the plane.

/// Length of a line through points.
///
/// ```
/// # use impactlab_core::numerics::line_length;
/// assert_eq!(line_length(&[[0.0, 0.0], [3.0, 4.0], [3.0, 5.0]]), 6.0);
/// assert_eq!(line_length(&[[1.0, 2.0]]), 0.0);
/// ```
pub fn line_length(points: &[[f64; 2]]) -> f64 {
    points.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum()
}

/// Area of a polygon whose sides do not cross, in either sense of its corners. Its first corner is
/// subtracted, so that large coordinates lose no digits.
///
/// ```
/// # use impactlab_core::numerics::polygon_area;
/// assert_eq!(polygon_area(&[[1e9, 0.0], [1e9 + 2.0, 0.0], [1e9 + 2.0, 3.0], [1e9, 3.0]]), 6.0);
/// assert_eq!(polygon_area(&[]), 0.0);
/// ```
pub fn polygon_area(corners: &[[f64; 2]]) -> f64 {
    let Some([x0, y0]) = corners.first() else { return 0.0 };
    let twice = corners.windows(2).map(|pair| {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        (ax - x0) * (by - y0) - (bx - x0) * (ay - y0)
    });
    twice.sum::<f64>().abs() / 2.0
}
