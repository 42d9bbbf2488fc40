//! Curves of a drawing as points.

use std::f64::consts::TAU;

/// Angle of an arc between two of its points, at most, rad: 5°.
const ARC_STEP_RAD: f64 = TAU / 72.0;
/// Chords of an arc, at most: enough for 5 mm along a whole circle of 100 km radius.
const MAX_CHORDS: f64 = 10_000.0;
/// Points of a spline between two of its control points.
const N_PER_CONTROL: usize = 8;
/// Largest degree of a spline.
const MAX_DEGREE: usize = 15;

/// Points of an arc of an ellipse, from a start to an end, counter-clockwise.
///
/// - `axes`: both half axes as vectors;
/// - `[start_rad, end_rad]`: parameters; an end before the start is a turn later;
/// - `error`: largest distance from the arc to its chords.
pub(super) fn arc(
    centre: [f64; 2],
    axes: [[f64; 2]; 2],
    [start_rad, end_rad]: [f64; 2],
    error: f64,
) -> Vec<[f64; 2]> {
    let whole = (end_rad - start_rad).rem_euclid(TAU);
    let sweep_rad = if whole < 1e-9 { TAU } else { whole };
    let radius = axes.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
    let n = n_chords(sweep_rad, radius, error);
    let at = |i: usize| {
        let (sin, cos) = (start_rad + sweep_rad * i as f64 / n).sin_cos();
        std::array::from_fn(|k| centre[k] + cos * axes[0][k] + sin * axes[1][k])
    };
    (0..=n as usize).map(at).collect()
}

/// Number of chords of an arc, whole and at least one.
///
/// A chord over the parameter Δt is off by at most r Δt² / 8, with r the larger half axis: that bounds the
/// second derivative of the arc.
fn n_chords(sweep_rad: f64, radius: f64, error: f64) -> f64 {
    let step_rad = (8.0 * error / radius).sqrt().min(ARC_STEP_RAD);
    // A sweep or a radius that is no number has one chord.
    let n = (sweep_rad / step_rad).ceil().clamp(1.0, MAX_CHORDS);
    if n.is_nan() { 1.0 } else { n }
}

/// Points of the side of a polyline after its start, with the end.
///
/// - `bulge`: tangent of a quarter of the angle of the arc, positive to the left; 0 for a straight side;
/// - `error`: largest distance from the arc to its chords.
pub(super) fn bulged([from, to]: [[f64; 2]; 2], bulge: f64, error: f64) -> Vec<[f64; 2]> {
    let angle_rad = 4.0 * bulge.atan();
    if angle_rad == 0.0 || !angle_rad.is_finite() {
        return vec![to];
    }
    // The centre lies on the perpendicular bisector of the chord.
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let reach = (1.0 / bulge - bulge) / 4.0;
    let centre = [(from[0] + to[0]) / 2.0 - reach * dy, (from[1] + to[1]) / 2.0 + reach * dx];
    let off = [from[0] - centre[0], from[1] - centre[1]];
    let n = n_chords(angle_rad.abs(), off[0].hypot(off[1]), error);
    let at = |i: usize| {
        let (sin, cos) = (angle_rad * i as f64 / n).sin_cos();
        [centre[0] + cos * off[0] - sin * off[1], centre[1] + sin * off[0] + cos * off[1]]
    };
    (1..n as usize).map(at).chain([to]).collect()
}

/// Points of a B-spline by de Boor's algorithm; `None` if knots, weights and control points do not fit
/// together.
///
/// - `weights`: of the control points; empty if all are 1.
pub(super) fn spline(
    degree: usize,
    knots: &[f64],
    weights: &[f64],
    control: &[[f64; 2]],
) -> Option<Vec<[f64; 2]>> {
    let n = control.len();
    let fits = (1..=MAX_DEGREE).contains(&degree)
        && n > degree
        && knots.len() == n + degree + 1
        && (weights.is_empty() || weights.len() == n)
        && knots.windows(2).all(|pair| pair[0] <= pair[1]);
    if !fits {
        return None;
    }
    let (first, last) = (knots[degree], knots[n]);
    let n_points = N_PER_CONTROL * (n - degree);
    let at = |i: usize| {
        let t = first + (last - first) * i as f64 / n_points as f64;
        // The span of knots that holds the parameter.
        let span = (degree..n).rev().find(|k| knots[*k] <= t).unwrap_or(degree);
        let mut d: Vec<[f64; 3]> = (0..=degree)
            .map(|j| {
                let idx = span - degree + j;
                let weight = weights.get(idx).copied().unwrap_or(1.0);
                [control[idx][0] * weight, control[idx][1] * weight, weight]
            })
            .collect();
        for level in 1..=degree {
            for j in (level..=degree).rev() {
                let low = knots[span - degree + j];
                let width = knots[span + 1 + j - level] - low;
                let share = if width > 0.0 { (t - low) / width } else { 0.0 };
                d[j] = std::array::from_fn(|k| (1.0 - share) * d[j - 1][k] + share * d[j][k]);
            }
        }
        let [x, y, weight] = d[degree];
        [x / weight, y / weight]
    };
    let points: Vec<[f64; 2]> = (0..=n_points).map(at).collect();
    points.iter().flatten().all(|value| value.is_finite()).then_some(points)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn near(a: [f64; 2], b: [f64; 2]) -> bool {
        (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9
    }

    #[test]
    fn arcs_lie_on_their_circle_and_run_counter_clockwise() {
        let points = arc([1.0, 2.0], [[3.0, 0.0], [0.0, 3.0]], [0.0, FRAC_PI_2], 0.005);
        assert!(near(points[0], [4.0, 2.0]) && near(points[points.len() - 1], [1.0, 5.0]));
        assert!(points.iter().all(|p| ((p[0] - 1.0).hypot(p[1] - 2.0) - 3.0).abs() < 1e-9));
        let circle = arc([0.0; 2], [[1.0, 0.0], [0.0, 1.0]], [0.0, TAU], 0.005);
        assert!(circle.len() == 73 && near(circle[0], circle[72]));
    }

    #[test]
    fn the_chords_of_large_arcs_stay_within_the_error() {
        let farthest = |points: &[[f64; 2]], centre: [f64; 2], radius: f64| {
            let middles = points.windows(2).map(|pair| {
                let middle = [0, 1].map(|k| (pair[0][k] + pair[1][k]) / 2.0 - centre[k]);
                radius - middle[0].hypot(middle[1])
            });
            middles.fold(0.0, f64::max)
        };
        for radius in [0.3, 12.0, 1000.0, 50_000.0] {
            let circle = arc([0.0; 2], [[radius, 0.0], [0.0, radius]], [0.0, FRAC_PI_2], 0.005);
            let off = farthest(&circle, [0.0; 2], radius);
            assert!(off <= 0.005, "radius {radius}: {off}");
            // The same quarter of a circle as a side with a bulge.
            let ends = [[radius, 0.0], [0.0, radius]];
            let mut side = vec![ends[0]];
            side.extend(bulged(ends, f64::tan(FRAC_PI_2 / 4.0), 0.005));
            let off = farthest(&side, [0.0; 2], radius);
            assert!(off <= 0.005 + 1e-6, "bulge, radius {radius}: {off}");
        }
        let endless = arc([0.0; 2], [[1e300, 0.0], [0.0, 1e300]], [0.0, TAU], 0.005);
        assert!(endless.len() <= 10_001, "{}", endless.len());
    }

    #[test]
    fn a_bulge_of_one_is_a_half_circle_to_the_right_of_the_chord() {
        // Positive bulges turn to the left, so that the arc lies to the right of its chord.
        let points = bulged([[0.0, 0.0], [2.0, 0.0]], 1.0, 0.005);
        assert!(near(points[points.len() - 1], [2.0, 0.0]));
        assert!(points.iter().all(|p| ((p[0] - 1.0).hypot(p[1]) - 1.0).abs() < 1e-9));
        assert!(points.iter().all(|p| p[1] < 1e-9), "{points:?}");
        assert_eq!(bulged([[0.0, 0.0], [2.0, 0.0]], 0.0, 0.005), [[2.0, 0.0]]);
    }

    #[test]
    fn a_spline_of_one_span_is_a_bezier_curve() {
        let control = [[0.0, 0.0], [1.0, 2.0], [3.0, 2.0], [4.0, 0.0]];
        let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        let points = spline(3, &knots, &[], &control).unwrap();
        assert!(near(points[0], [0.0, 0.0]) && near(points[points.len() - 1], [4.0, 0.0]));
        assert!(near(points[points.len() / 2], [2.0, 1.5]), "{points:?}");
        assert_eq!(spline(3, &knots[..7], &[], &control), None);
    }
}
