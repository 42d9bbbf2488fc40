//! The outline of the front of the striking vehicle in plan view, and its division into the
//! elements (springs) of the crush model.

use std::f64::consts::FRAC_PI_2;

use serde::{Deserialize, Serialize};

/// Magnitude of the slope dy/dx of the outline at which the curved corner ends and the straight
/// front begins.
const FRONT_SLOPE: f64 = 1.2;
/// Length of an element of the straight parts of the outline, m.
const STRAIGHT_ELEMENT_M: f64 = 0.1;
const N_CORNER: usize = 12;

/// Length of the side behind the corner, past the front wheel, and width of the front beyond the corner,
/// nearly to the other one, m.
pub(super) const OUTLINE_M: [f64; 2] = [1.1, 1.4];
/// The same of laws that do not store them.
pub(super) const OUTLINE_BEFORE_M: [f64; 2] = [0.8, 0.6];

/// Number of marks along the outline at which stiffness factors are given: rear end of the side;
/// start, middle and end of the corner; inner end of the front.
pub(super) const N_OUTLINE_FACTORS: usize = 5;

/// Outline of the left front corner of a vehicle in plan view: a straight side, a parabolic corner
/// and a straight front.
///
/// ```text
/// y(x) = y₀ − (x − x₀)² / 2R     for x ≥ x₀, until its slope reaches 1.2
/// ```
///
/// Coordinates are in body axes with the origin at the CG, x forward and y to the left. The
/// parabola agrees with the points of first contact of the shipped finite-element runs to within 3
/// mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Nose {
    /// x₀: coordinate x at which the side begins to curve inwards, m.
    pub corner_x_m: f64,
    /// y₀: half of the width of the vehicle, m.
    pub half_width_m: f64,
    /// R: radius of curvature of the corner at x₀, m, positive.
    pub radius_m: f64,
}

impl Default for Nose {
    /// The outline of a mid-size car.
    fn default() -> Self {
        Self { corner_x_m: 1.7, half_width_m: 0.95, radius_m: 0.42 }
    }
}

/// One element of the outline, which acts as one spring.
#[derive(Debug, Clone, Copy)]
pub(super) struct SkinElement {
    /// Position of its middle in body axes of the striking vehicle, m.
    pub position_body_m: [f64; 2],
    /// Outward unit normal in body axes of the striking vehicle.
    pub normal_body: [f64; 2],
    /// Length of the element along the outline, m.
    pub length_m: f64,
    /// Factor on the stiffness of the skins.
    pub factor: f64,
}

impl Nose {
    /// Point of the outline that first touches a straight wall, in body axes, m: the point with
    /// `dy/dx = −tan(angle)`.
    ///
    /// - `angle_rad`: angle between the longitudinal axis of the vehicle and the wall, rad; 0 if
    ///   the wall is parallel to the side. The slope is limited to that of the corner, also where the front
    ///   is turned beyond square to the wall.
    pub fn touching_point_m(&self, angle_rad: f64) -> [f64; 2] {
        let slope = match angle_rad < FRAC_PI_2 {
            true => angle_rad.tan().clamp(0.0, FRONT_SLOPE),
            // The tangent changes its sign there.
            false => FRONT_SLOPE,
        };
        self.corner_point_m(slope)
    }

    /// Fits the outline to points of first contact by linear least squares: the coordinates of
    /// these points are linear in x₀, y₀ and R.
    ///
    /// - `contacts`: for each contact the angle of the wall, rad, and the point in body axes, m. Walls
    ///   that are met by the front, beyond the end of the corner, or by the side say nothing of the corner
    ///   and are left out.
    /// - returns `None` for fewer than two of the others, if the parameters are not determined by the
    ///   contacts, or if R or y₀ is not positive.
    pub fn fit(contacts: &[(f64, [f64; 2])]) -> Option<Self> {
        let of_corner = |(angle, _): &&(f64, [f64; 2])| (0.0..=FRONT_SLOPE.atan()).contains(angle);
        let contacts: Vec<_> = contacts.iter().filter(of_corner).collect();
        if contacts.len() < 2 {
            return None;
        }
        // The equations of a contact are x = x₀ + R t and y = y₀ − R t²/2 with t = tan(angle).
        let rows = contacts.iter().flat_map(|(angle, [x, y])| {
            let t = angle.tan();
            [([1.0, 0.0, t], *x), ([0.0, 1.0, -t * t / 2.0], *y)]
        });
        let mut normal = nalgebra::Matrix3::<f64>::zeros();
        let mut right = nalgebra::Vector3::<f64>::zeros();
        for (row, value) in rows {
            let row = nalgebra::Vector3::from(row);
            normal += row * row.transpose();
            right += row * value;
        }
        let solution = normal.cholesky()?.solve(&right);
        let nose =
            Self { corner_x_m: solution[0], half_width_m: solution[1], radius_m: solution[2] };
        (nose.radius_m > 0.0 && nose.half_width_m > 0.0).then_some(nose)
    }

    fn corner_point_m(&self, slope: f64) -> [f64; 2] {
        let along = self.radius_m * slope;
        [self.corner_x_m + along, self.half_width_m - along * slope / 2.0]
    }

    /// Divides the outline into elements, from the rear end of the side to the inner end of the
    /// front.
    ///
    /// - `log_factors`: logarithms of the stiffness factors at the five marks of
    ///   [`N_OUTLINE_FACTORS`]; they are interpolated linearly in between.
    /// - `side_and_front_m`: length of the side and width of the front, m.
    pub(super) fn elements(
        &self,
        log_factors: &[f64; N_OUTLINE_FACTORS],
        side_and_front_m: [f64; 2],
    ) -> Vec<SkinElement> {
        let [n_side, n_front] = side_and_front_m
            .map(|length_m| (length_m / STRAIGHT_ELEMENT_M).round().max(1.0) as usize);
        let between = |mark: usize, share: f64| {
            (log_factors[mark] * (1.0 - share) + log_factors[mark + 1] * share).exp()
        };
        let middle = |i: usize| i as f64 + 0.5;
        let element = |i: usize| {
            if i < n_side {
                let behind = n_side as f64 - middle(i);
                SkinElement {
                    position_body_m: [
                        self.corner_x_m - STRAIGHT_ELEMENT_M * behind,
                        self.half_width_m,
                    ],
                    normal_body: [0.0, 1.0],
                    length_m: STRAIGHT_ELEMENT_M,
                    factor: between(0, middle(i) / n_side as f64),
                }
            } else if i < n_side + N_CORNER {
                let share = middle(i - n_side) / N_CORNER as f64;
                let slope = FRONT_SLOPE * share;
                let length = slope.hypot(1.0);
                SkinElement {
                    position_body_m: self.corner_point_m(slope),
                    normal_body: [slope / length, 1.0 / length],
                    length_m: self.radius_m * FRONT_SLOPE / N_CORNER as f64 * length,
                    factor: if share < 0.5 {
                        between(1, 2.0 * share)
                    } else {
                        between(2, 2.0 * share - 1.0)
                    },
                }
            } else {
                let inwards = middle(i - n_side - N_CORNER);
                let [x, y] = self.corner_point_m(FRONT_SLOPE);
                SkinElement {
                    position_body_m: [x, y - STRAIGHT_ELEMENT_M * inwards],
                    normal_body: [1.0, 0.0],
                    length_m: STRAIGHT_ELEMENT_M,
                    factor: between(3, inwards / n_front as f64),
                }
            }
        };
        (0..n_side + N_CORNER + n_front).map(element).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nose_is_found_again_from_its_points_of_contact() {
        let nose = Nose { corner_x_m: 1.63, half_width_m: 0.94, radius_m: 0.42 };
        let contacts: Vec<_> = (1..8)
            .map(|i| f64::from(i) * 0.08)
            .map(|angle| (angle, nose.touching_point_m(angle)))
            .collect();
        let fitted = Nose::fit(&contacts).unwrap();
        assert!((fitted.corner_x_m - 1.63).abs() < 1e-9, "{fitted:?}");
        assert!((fitted.radius_m - 0.42).abs() < 1e-9, "{fitted:?}");
        assert_eq!(Nose::fit(&contacts[..1]), None);
        // A front that meets a flank at 80° touches it anywhere: of a corner it says nothing.
        let across = [(1.4, [2.1, 0.2]), (1.55, [2.2, -0.4])];
        // So does a car that comes the other way, although the tangent of its angle is that of a corner.
        let oncoming = [(std::f64::consts::PI + 0.3, [-2.3, 0.6]), (-2.9, [-2.1, 0.8])];
        let all: Vec<_> = contacts.iter().copied().chain(across).chain(oncoming).collect();
        assert_eq!(Nose::fit(&all), Nose::fit(&contacts));
    }

    /// By the rounding of a heading of 90° a front touched with its flank, and a predicted impulse was larger
    /// by a third.
    #[test]
    fn a_front_that_is_square_to_a_flank_touches_it_with_the_front() {
        let nose = Nose::default();
        let [x, y] = nose.touching_point_m(FRAC_PI_2 - 1e-3);
        for angle_rad in [FRAC_PI_2 - 1e-12, FRAC_PI_2, FRAC_PI_2 + 1e-12, FRAC_PI_2 + 1e-3] {
            let [at_x, at_y] = nose.touching_point_m(angle_rad);
            assert!((at_x - x).hypot(at_y - y) < 1e-9, "{angle_rad}: {at_x} {at_y}");
        }
    }

    #[test]
    fn elements_follow_the_outline_with_unit_normals() {
        let nose = Nose::default();
        let elements = nose.elements(&[0.0; N_OUTLINE_FACTORS], OUTLINE_M);
        for pair in elements.windows(2) {
            let [[x0, y0], [x1, y1]] = [pair[0].position_body_m, pair[1].position_body_m];
            assert!(x1 >= x0 - 1e-12 && y1 <= y0 + 1e-12, "{pair:?}");
        }
        for element in elements {
            assert!((element.normal_body[0].hypot(element.normal_body[1]) - 1.0).abs() < 1e-12);
            assert_eq!(element.factor, 1.0);
        }
    }
}
