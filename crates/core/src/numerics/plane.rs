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

/// Whether a polygon holds a place: a ray from there crosses its sides an odd number of times. Of a place
/// on a side nothing is promised.
///
/// - `corners`: in either sense; the last is joined to the first.
///
/// ```
/// # use impactlab_core::numerics::polygon_holds;
/// let triangle = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
/// assert!(polygon_holds(&triangle, [1.0, 1.0]) && !polygon_holds(&triangle, [3.0, 3.0]));
/// ```
pub fn polygon_holds(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let Some(mut a) = corners.last() else { return false };
    let mut holds = false;
    for b in corners {
        if (a[1] > y) != (b[1] > y) {
            let x_at_y = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            holds ^= x < x_at_y;
        }
        a = b;
    }
    holds
}
