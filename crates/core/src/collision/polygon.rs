//! Convex polygons in the plane: their reach, their intersection and its centroid.
//!
//! Source: the intersection is found by polygon clipping
//! ([`SutherlandHodgman1974`](crate::bibliography::SutherlandHodgman1974)).

/// Unit vector at an angle from the x axis.
pub(super) fn direction(angle_rad: f64) -> [f64; 2] {
    let (sin, cos) = angle_rad.sin_cos();
    [cos, sin]
}

/// Scalar product.
pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Largest coordinate of the corners along a direction, m.
pub(super) fn reach(corners: &[[f64; 2]; 4], along: [f64; 2]) -> f64 {
    corners.iter().map(|&corner| dot(corner, along)).fold(f64::NEG_INFINITY, f64::max)
}

/// Part of a polygon within a convex one whose corners are in counter-clockwise order (algorithm of
/// Sutherland and Hodgman). The parts of one that is not convex are joined by sides without an area.
pub(super) fn clip(subject: &[[f64; 2]], window: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut polygon = subject.to_vec();
    for (i, &a) in window.iter().enumerate() {
        let b = window[(i + 1) % window.len()];
        let inside = |p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        let mut clipped = Vec::with_capacity(polygon.len() + 1);
        for (j, &p) in polygon.iter().enumerate() {
            let q = polygon[(j + 1) % polygon.len()];
            let (dp, dq) = (inside(p), inside(q));
            if dp >= 0.0 {
                clipped.push(p);
            }
            if (dp > 0.0 && dq < 0.0) || (dp < 0.0 && dq > 0.0) {
                let t = dp / (dp - dq);
                clipped.push([0, 1].map(|k| p[k] + t * (q[k] - p[k])));
            }
        }
        polygon = clipped;
    }
    polygon
}

/// Centroid of a polygon with counter-clockwise corners; `None` if it has no area.
pub(super) fn centroid(polygon: &[[f64; 2]]) -> Option<[f64; 2]> {
    let origin = *polygon.first()?;
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    for pair in polygon.windows(2) {
        let [p, q] = [0, 1].map(|k| [pair[k][0] - origin[0], pair[k][1] - origin[1]]);
        let cross = p[0] * q[1] - p[1] * q[0];
        area += cross;
        for k in 0..2 {
            moment[k] += (p[k] + q[k]) * cross / 3.0;
        }
    }
    (area > 0.0).then(|| [0, 1].map(|k| origin[k] + moment[k] / area))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_that_overlap_share_a_rectangle() {
        let square = |x: f64, y: f64| [[x, y], [x + 2.0, y], [x + 2.0, y + 2.0], [x, y + 2.0]];
        let shared = clip(&square(0.0, 0.0), &square(1.0, 1.5));
        assert_eq!(centroid(&shared), Some([1.5, 1.75]), "{shared:?}");
        assert_eq!(centroid(&clip(&square(0.0, 0.0), &square(2.5, 0.0))), None);
        assert_eq!(reach(&square(1.0, 1.5), direction(0.0)), 3.0);
    }
}
