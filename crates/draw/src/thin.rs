//! Reduction of long lines to fewer points for drawing, so that a frame does not take long. The
//! picture looks the same, since the extremes of every part of the line are kept. The figure itself
//! keeps every point, for example for its CSV.

use std::borrow::Cow;

/// Number of points above which a line is reduced: several points for every pixel of a wide screen.
const MAX_POINTS: usize = 12_000;
/// Number of parts into which a long line is divided; each keeps its first, lowest, highest and
/// last point.
const N_PARTS: usize = 3_000;

/// The points of a line if there are at most [`MAX_POINTS`], else a subset of at most this size, in
/// order, which holds the extremes of every part of the line.
pub fn thinned(points: &[[f64; 2]]) -> Cow<'_, [[f64; 2]]> {
    if points.len() <= MAX_POINTS {
        return Cow::Borrowed(points);
    }
    let part_length = points.len().div_ceil(N_PARTS);
    Cow::Owned(points.chunks(part_length).flat_map(outline).collect())
}

/// The first, lowest, highest and last point of a part, in order and without repetition.
fn outline(part: &[[f64; 2]]) -> impl Iterator<Item = [f64; 2]> + '_ {
    let by_height = |a: &usize, b: &usize| part[*a][1].total_cmp(&part[*b][1]);
    let lowest = (0..part.len()).min_by(by_height).unwrap_or(0);
    let highest = (0..part.len()).max_by(by_height).unwrap_or(0);
    let mut positions = [0, lowest, highest, part.len().saturating_sub(1)];
    positions.sort_unstable();
    let is_new =
        move |position: &usize| *position == 0 || positions[*position] != positions[*position - 1];
    (0..positions.len())
        .filter(is_new)
        .filter_map(move |position| part.get(positions[position]).copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_of_one_sample_in_a_million_stays() {
        let mut points: Vec<[f64; 2]> =
            (0..1_000_000).map(|i| [f64::from(i), f64::from(i % 7)]).collect();
        points[654_321][1] = 1e6;
        points[123_456][1] = -1e6;
        let thin = thinned(&points);
        assert!(thin.len() <= MAX_POINTS, "{}", thin.len());
        assert!(thin.contains(&points[654_321]) && thin.contains(&points[123_456]));
        assert_eq!((thin.first(), thin.last()), (points.first(), points.last()));
        assert!(thin.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    }

    #[test]
    fn a_short_line_is_left_alone() {
        let points = vec![[0.0, 1.0]; 100];
        assert!(matches!(thinned(&points), Cow::Borrowed(_)));
    }
}
