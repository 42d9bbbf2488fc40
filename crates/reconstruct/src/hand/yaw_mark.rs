//! Critical speed from a yaw mark.
//!
//! ```text
//! v = k √(g cos γ R (μ + e)/(1 − μ e))
//! R = c²/(8 h) + h/2 − b        or of the circle through points by least squares, less b
//! ```
//!
//! c, h: chord and middle ordinate of the mark; b: how much smaller the radius of the path of the CG is, half a
//! track for the mark of an outer wheel; μ: drag factor of locked wheels from a test skid; e: superelevation,
//! positive where the outside is higher; tan γ: grade along the path, which lowers the load of the wheels alone;
//! k: factor of the formula, 1 on the average of no test.
//!
//! The scatter of k is ours: field studies report biases within 10 % to 15 % on the average, towards speeds
//! that are too low ([`Davis2014`]), which count as two standard deviations. What comes of marks that are none
//! of this kind says [`Richardson2012`]. Source of the formula: [`Brach2011`].

use nalgebra::{Matrix3, Vector3};

use crate::hand::HandField;
use crate::hand::field::POINTS;
use crate::hand::method::{Formula, HandOutput, violated};
use crate::hand::values::HandValues;
use impactlab_core::bibliography::{Brach2011, Davis2014, Richardson2012};
use impactlab_core::ranges::{
    FORMULA_FACTOR, HAND_GRADE, MARK_CHORD, MARK_RADIUS, MARK_TO_CG, MIDDLE_ORDINATE,
    POSITION_SIGMA, ROAD_FRICTION,
};
use impactlab_core::units::{Phrase, PhraseValue, Quantity, STANDARD_GRAVITY_M_S2};

/// Half a track: from the mark of an outer wheel to the path of the CG, m.
pub(super) const MARK_TO_CG_M: f64 = 0.75;
/// Middle ordinate below which an error of 1 cm is one of 10 % of the radius, m.
const LEAST_ORDINATE_M: f64 = 0.1;
/// Root mean square of the distances of points from their circle beyond which they lie on none, m.
const LARGEST_RESIDUAL_M: f64 = 0.1;
/// Steps of the fit of a circle.
const FIT_STEPS: usize = 20;

pub(super) const YAW_MARK: Formula = Formula {
    label: "critical speed from a yaw mark",
    equation: "v = k √(g cos γ R (μ + e)/(1 − μ e)); R = c²/(8 h) + h/2 − b, or by least squares through points",
    holds: [
        "the mark is that of a wheel that rolls and slides sideways, with oblique striations and the rear wheel \
         outside of the front one, at its start, without brake or throttle, and μ is from a test skid there",
        "Die Spur stammt von einem rollenden, seitlich gleitenden Rad, mit schrägen Streifen und dem Hinterrad \
         außerhalb des Vorderrads, an ihrem Beginn, ohne Bremse oder Gas, und μ aus einem Bremsversuch dort",
    ],
    sources: &[Brach2011::TEXT, Davis2014::TEXT, Richardson2012::TEXT],
    fields: &[
        HandField::new("chord", "chord of the mark", MARK_CHORD, 0.05).open(),
        HandField::new("middle_ordinate", "middle ordinate", MIDDLE_ORDINATE, 0.02).open(),
        HandField::relative("radius", "radius of the mark", MARK_RADIUS, 0.05).open(),
        HandField::new("friction", "drag factor of locked wheels", ROAD_FRICTION, 0.07),
        HandField::new(
            "superelevation",
            "superelevation, outside higher positive",
            HAND_GRADE,
            0.01,
        )
        .or(0.0),
        HandField::new("grade", "grade, uphill positive", HAND_GRADE, 0.01).or(0.0),
        HandField::new("mark_to_cg", "from the mark to the path of the CG", MARK_TO_CG, 0.1)
            .or(MARK_TO_CG_M),
        HandField::new("formula", "factor of the formula", FORMULA_FACTOR, 0.06).or(1.0),
        HandField::new("point_error", "standard deviation of a point", POSITION_SIGMA, 0.0)
            .or(0.05)
            .only_with(POINTS),
    ],
    outputs: &[
        HandOutput {
            key: "speed_m_s",
            label: "speed at the start of the mark",
            quantity: Quantity::Speed,
        },
        HandOutput {
            key: "radius_m",
            label: "radius of the path of the CG",
            quantity: Quantity::Length,
        },
    ],
    solve,
    refuse,
    warn,
};

/// The circle through points of a mark by least squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarkCircle {
    /// Radius, m.
    pub radius_m: f64,
    /// Root mean square of the distances of the points from it, m.
    pub residual_m: f64,
}

impl MarkCircle {
    /// The circle with the least squares of the distances of the points; `None` for less than three points and
    /// for points on a straight line.
    pub fn fit(points_m: &[[f64; 2]]) -> Option<Self> {
        let n = points_m.len();
        if n < 3 {
            return None;
        }
        let mean = [0, 1].map(|axis| points_m.iter().map(|p| p[axis]).sum::<f64>() / n as f64);
        let points: Vec<[f64; 2]> =
            points_m.iter().map(|p| [p[0] - mean[0], p[1] - mean[1]]).collect();
        let mut circle = algebraic(&points)?;
        for _ in 0..FIT_STEPS {
            let step = geometric_step(&points, circle)?;
            circle -= step;
            if step.norm() < 1e-9 * circle.z.abs() {
                break;
            }
        }
        let (x, y, radius_m) = (circle.x, circle.y, circle.z);
        let distance = |p: &[f64; 2]| (p[0] - x).hypot(p[1] - y) - radius_m;
        let squares: f64 = points.iter().map(|p| distance(p).powi(2)).sum();
        let residual_m = (squares / n as f64).sqrt();
        // Points on a straight line have a radius that is nothing but rounding.
        let is_circle = MARK_RADIUS.contains(radius_m) && residual_m.is_finite();
        is_circle.then_some(Self { radius_m, residual_m })
    }
}

/// Centre and radius with x² + y² = 2 a x + 2 b y + c at the points by least squares.
fn algebraic(points: &[[f64; 2]]) -> Option<Vector3<f64>> {
    let (mut normal, mut right) = (Matrix3::<f64>::zeros(), Vector3::<f64>::zeros());
    for [x, y] in points {
        let row = Vector3::new(2.0 * x, 2.0 * y, 1.0);
        normal += row * row.transpose();
        right += row * (x * x + y * y);
    }
    let solved = normal.lu().solve(&right)?;
    let (a, b, c) = (solved.x, solved.y, solved.z);
    Some(Vector3::new(a, b, (c + a * a + b * b).sqrt()))
}

/// A step of Gauss and Newton towards the least distances.
fn geometric_step(points: &[[f64; 2]], circle: Vector3<f64>) -> Option<Vector3<f64>> {
    let (mut normal, mut right) = (Matrix3::<f64>::zeros(), Vector3::<f64>::zeros());
    for [px, py] in points {
        let (dx, dy) = (circle.x - px, circle.y - py);
        let distance = dx.hypot(dy);
        let row = Vector3::new(dx / distance, dy / distance, -1.0);
        normal += row * row.transpose();
        right += row * (distance - circle.z);
    }
    normal.lu().solve(&right)
}

/// Critical speed on a level road, m/s.
pub(super) fn critical_speed_m_s(friction: f64, radius_m: f64) -> f64 {
    (STANDARD_GRAVITY_M_S2 * radius_m * friction).sqrt()
}

/// Radius of the mark, m.
fn mark_radius_m(values: &HandValues<'_>) -> Option<f64> {
    if !values.points_m.is_empty() {
        return MarkCircle::fit(values.points_m).map(|circle| circle.radius_m);
    }
    match [values.get("chord"), values.get("middle_ordinate")] {
        [Some(chord), Some(ordinate)] => Some(chord * chord / (8.0 * ordinate) + ordinate / 2.0),
        _ => values.get("radius"),
    }
}

fn solve(values: &HandValues<'_>) -> Vec<f64> {
    let [friction, superelevation] = ["friction", "superelevation"].map(|key| values.number(key));
    let radius_m = mark_radius_m(values).unwrap_or(f64::NAN) - values.number("mark_to_cg");
    let banked = (friction + superelevation) / (1.0 - friction * superelevation);
    let cos = 1.0 / values.number("grade").hypot(1.0);
    vec![values.number("formula") * critical_speed_m_s(banked * cos, radius_m), radius_m]
}

fn refuse(values: &HandValues<'_>) -> Option<&'static str> {
    let [chord, ordinate, radius] =
        ["chord", "middle_ordinate", "radius"].map(|key| values.get(key));
    if chord.is_some() != ordinate.is_some() {
        return Some("chord and middle ordinate go together, and only one of them is given");
    }
    let n_ways = [!values.points_m.is_empty(), chord.is_some(), radius.is_some()];
    match n_ways.into_iter().filter(|is_given| *is_given).count() {
        0 => {
            return Some(
                "the radius is open: give chord and middle ordinate, points, or the radius",
            );
        }
        1 => {}
        _ => {
            return Some(
                "the radius is given twice: give chord and middle ordinate, points, or the radius",
            );
        }
    }
    if let (Some(chord), Some(ordinate)) = (chord, ordinate)
        && ordinate > chord / 2.0
    {
        return Some(
            "the middle ordinate is more than half of the chord, which is more than half a circle",
        );
    }
    match values.points_m.len() {
        1 | 2 => Some("a circle needs three points of the mark or more"),
        _ if mark_radius_m(values).is_none() => {
            Some("the points of the mark lie on a straight line")
        }
        _ => None,
    }
}

fn warn(values: &HandValues<'_>, outputs: &[f64]) -> Vec<Phrase> {
    let ordinate = values.get("middle_ordinate").unwrap_or(f64::INFINITY);
    let short = Phrase::new(
        "a middle ordinate of {0} is not measured well enough: 1 cm moves the radius by 10 % or more; take a \
         longer chord",
        "Ein Stichmaß von {0} ist zu klein, um gut gemessen zu sein: 1 cm ändert den Radius um 10 % oder mehr; \
         eine längere Sehne ist nötig",
    );
    let circle = MarkCircle::fit(values.points_m);
    let residual_m = circle.map_or(0.0, |circle| circle.residual_m);
    let uneven = Phrase::new(
        "the points lie {0} off their circle on the average: the mark does not have one radius",
        "Die Punkte liegen im Mittel {0} neben ihrem Kreis: die Spur hat nicht einen Radius",
    );
    let widens = Phrase::new(
        "the second half of the mark has a larger radius than the first: a vehicle in a critical turn loses speed \
         and turns ever tighter, so that this is a mark of steering rather than of yaw",
        "Die zweite Hälfte der Spur hat einen größeren Radius als die erste: ein Fahrzeug in kritischer \
         Kurvenfahrt wird langsamer und fährt immer enger, dies ist eher eine Lenk- als eine Driftspur",
    );
    let tight = Phrase::new(
        "a path of {0} in radius is that of a turn at low speed or of a spin: the formula is made for neither",
        "Ein Bahnradius von {0} gehört zu langsamer Kurvenfahrt oder zum Schleudern um die Hochachse: für beides \
         ist die Formel nicht gemacht",
    );
    let radius_m = outputs.get(1).copied().unwrap_or(f64::NAN);
    let length = |m: f64| PhraseValue::three_digits(Quantity::Length, m);
    violated([
        (ordinate < LEAST_ORDINATE_M, short.with(length(ordinate))),
        (residual_m > LARGEST_RESIDUAL_M, uneven.with(length(residual_m))),
        (does_widen(values.points_m), widens),
        (radius_m < 15.0, tight.with(length(radius_m))),
    ])
}

/// Whether the radius of the second half of a mark is clearly larger than that of the first.
fn does_widen(points_m: &[[f64; 2]]) -> bool {
    if points_m.len() < 8 {
        return false;
    }
    let (first, second) = points_m.split_at(points_m.len() / 2);
    match (MarkCircle::fit(first), MarkCircle::fit(second)) {
        (Some(first), Some(second)) => second.radius_m > 1.3 * first.radius_m,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::HandMethod::YawMark;
    use crate::hand::calculation::tests::{near, solved, solved_with};

    const G: f64 = STANDARD_GRAVITY_M_S2;

    fn arc(radius_m: f64, angles: impl Iterator<Item = f64>) -> Vec<[f64; 2]> {
        angles.map(|at| [300.0 + radius_m * at.cos(), -80.0 + radius_m * at.sin()]).collect()
    }

    /// A chord of 24 m with an ordinate of 1.5 m is of a circle of 48.75 m: 24²/12 + 0.75.
    #[test]
    fn chord_and_ordinate_give_radius_and_speed() {
        let inputs = [
            ("chord_m", 24.0),
            ("middle_ordinate_m", 1.5),
            ("friction", 0.7),
            ("mark_to_cg_m", 0.75),
        ];
        near(&solved(YawMark, &inputs), &[(G * 48.0 * 0.7).sqrt(), 48.0]);
    }

    /// On a bank whose outside is higher by the friction angle both angles add:
    /// tan(α + β) = (μ + e)/(1 − μ e).
    #[test]
    fn superelevation_adds_its_angle_to_that_of_friction() {
        let (friction, bank) = (0.6_f64, 0.1_f64);
        let inputs = [
            ("radius_m", 80.0),
            ("friction", friction),
            ("superelevation", bank),
            ("mark_to_cg_m", 0.0),
        ];
        let expected = (G * 80.0 * (friction.atan() + bank.atan()).tan()).sqrt();
        near(&solved(YawMark, &inputs)[..1], &[expected]);
        // A slope of 5 in 12 along the path takes the load to 12/13.
        let inputs = [
            ("radius_m", 80.0),
            ("friction", friction),
            ("grade", 5.0 / 12.0),
            ("mark_to_cg_m", 0.0),
        ];
        near(&solved(YawMark, &inputs)[..1], &[(G * 80.0 * friction * 12.0 / 13.0).sqrt()]);
    }

    /// Points of a circle, wherever it lies and however short the arc is.
    #[test]
    fn points_of_a_circle_give_its_radius() {
        for (radius_m, span) in [(40.0, 0.5), (90.0, 0.2), (25.0, 2.0)] {
            let points = arc(radius_m, (0..11).map(|i| 0.7 + span * f64::from(i) / 10.0));
            let inputs = [("friction", 0.65), ("mark_to_cg_m", 0.0)];
            let outputs = solved_with(YawMark, &inputs, &points);
            let expected = [(G * radius_m * 0.65).sqrt(), radius_m];
            for (output, expected) in outputs.iter().zip(expected) {
                assert!((output / expected - 1.0).abs() < 1e-6, "{outputs:?}, {expected}");
            }
        }
        assert_eq!(MarkCircle::fit(&[[0.0, 0.0], [1.0, 1.0]]), None);
    }

    /// Points that err to both sides in turn leave the radius nearly as it is.
    #[test]
    fn the_fit_is_that_of_distances() {
        let radius_m = 60.0;
        let points: Vec<[f64; 2]> = (0..21)
            .flat_map(|i| {
                let at = 0.4 * f64::from(i) / 20.0;
                let off = if i % 2 == 0 { 0.02 } else { -0.02 };
                arc(radius_m + off, std::iter::once(at))
            })
            .collect();
        let circle = MarkCircle::fit(&points).unwrap();
        assert!((circle.radius_m / radius_m - 1.0).abs() < 0.02, "{circle:?}");
        assert!((circle.residual_m - 0.02).abs() < 0.002, "{circle:?}");
    }

    #[test]
    fn a_mark_that_widens_is_named() {
        let tightening = |sign: f64| -> Vec<[f64; 2]> {
            let (mut course, mut at) = (0.0_f64, [0.0, 0.0]);
            let mut points = vec![at];
            for i in 0..40 {
                course += 0.5 * (0.02 + sign * 0.0003 * f64::from(i - 20));
                at = [at[0] + 0.5 * course.cos(), at[1] + 0.5 * course.sin()];
                points.push(at);
            }
            points
        };
        assert!(does_widen(&tightening(-1.0)));
        assert!(!does_widen(&tightening(1.0)));
    }
}
