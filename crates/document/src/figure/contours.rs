//! Lines of equal value over a grid whose points lie at any distances.
//!
//! Each rectangle of four points is two triangles, in which the value is linear, so that a line is never
//! ambiguous. Where a corner has no value there is no line.

/// The lines on which a value is reached.
///
/// - `x`, `y`: coordinates of the points, rising;
/// - `values`: row by row from the lowest y upwards.
pub(super) fn contours(
    [x, y]: [&[f64]; 2],
    values: &[Option<f64>],
    level: f64,
) -> Vec<Vec<[f64; 2]>> {
    let width = x.len();
    let corner = |i: usize, j: usize| -> Option<[f64; 3]> {
        let value = values.get(j * width + i).copied().flatten()?;
        Some([*x.get(i)?, *y.get(j)?, value])
    };
    let mut segments = Vec::new();
    for j in 0..y.len().saturating_sub(1) {
        for i in 0..width.saturating_sub(1) {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let [Some(a), Some(b), Some(c), Some(d)] = corners.map(|(i, j)| corner(i, j)) else {
                continue;
            };
            segments.extend(segment([a, b, c], level));
            segments.extend(segment([a, c, d], level));
        }
    }
    joined(segments)
}

/// The line through a triangle of points [x, y, value].
fn segment(triangle: [[f64; 3]; 3], level: f64) -> Option<[[f64; 2]; 2]> {
    let [a, b, c] = triangle;
    let ends: Vec<[f64; 2]> =
        [(a, b), (b, c), (c, a)].into_iter().filter_map(|(a, b)| crossing(a, b, level)).collect();
    match ends[..] {
        [from, to] if from != to => Some([from, to]),
        _ => None,
    }
}

/// Where the value is reached between two points, the same whichever comes first.
fn crossing(a: [f64; 3], b: [f64; 3], level: f64) -> Option<[f64; 2]> {
    let (low, high) = if a[2] <= b[2] { (a, b) } else { (b, a) };
    if !(low[2] < level && level <= high[2]) {
        return None;
    }
    let share = (level - low[2]) / (high[2] - low[2]);
    Some([0, 1].map(|axis| low[axis] + share * (high[axis] - low[axis])))
}

/// Lines through segments that have ends in common.
fn joined(mut segments: Vec<[[f64; 2]; 2]>) -> Vec<Vec<[f64; 2]>> {
    let mut lines = Vec::new();
    while let Some([from, to]) = segments.pop() {
        let mut line = vec![from, to];
        // Once from its end, and once from its beginning.
        for _ in 0..2 {
            while let Some(next) = line.last().and_then(|end| take_next(&mut segments, *end)) {
                line.push(next);
            }
            line.reverse();
        }
        lines.push(line);
    }
    lines
}

/// Takes a segment with this end, and returns its other one.
fn take_next(segments: &mut Vec<[[f64; 2]; 2]>, end: [f64; 2]) -> Option<[f64; 2]> {
    let found = segments.iter().position(|[from, to]| *from == end || *to == end)?;
    let [from, to] = segments.swap_remove(found);
    Some(if from == end { to } else { from })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_has_one_straight_line_at_each_level() {
        let (x, y) = ([0.0, 1.0, 3.0, 4.0], [0.0, 2.0, 3.0]);
        let value = |x: f64, y: f64| Some(2.0 * x + y);
        let values: Vec<Option<f64>> =
            y.iter().flat_map(|y| x.iter().map(move |x| value(*x, *y))).collect();
        let lines = contours([&x, &y], &values, 4.5);
        assert_eq!(lines.len(), 1, "{lines:?}");
        assert!(lines[0].iter().all(|[x, y]| (2.0 * x + y - 4.5).abs() < 1e-12), "{lines:?}");
        let ends = [lines[0].first().unwrap()[1], lines[0].last().unwrap()[1]];
        assert_eq!(ends[0].min(ends[1]), 0.0);
        assert_eq!(ends[0].max(ends[1]), 3.0);
        assert!(contours([&x, &y], &values, 20.0).is_empty());
    }

    #[test]
    fn a_hill_has_a_closed_line_and_a_missing_corner_has_none() {
        let x: Vec<f64> = (0..9).map(f64::from).collect();
        let mut values: Vec<Option<f64>> =
            x.iter().flat_map(|y| x.iter().map(move |x| Some(-(x - 4.0).hypot(y - 4.0)))).collect();
        let lines = contours([&x, &x], &values, -2.5);
        assert_eq!(lines.len(), 1, "{lines:?}");
        assert_eq!(lines[0].first(), lines[0].last());
        values[4 * 9 + 2] = None;
        assert!(contours([&x, &x], &values, -2.5).iter().all(|line| line.first() != line.last()));
    }
}
