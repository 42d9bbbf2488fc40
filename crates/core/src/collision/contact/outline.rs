//! The outline of a vehicle in plan view as the contact law sees it: a rectangle with rounded corners,
//! cut into elements.
//!
//! Where a point lies inside of the outline, its depth is that below the face that is entered. Each face
//! owns the band of the outline that can be seen along its normal, its two corners
//! included:
//!
//! ```text
//! D = (y_b(x) − y) n_y(x)        y_b: the face with its rounded corners, n: its outward normal there
//! ```
//!
//! (for the left side; x, y in body axes). On the flat part that is the distance from the face; towards
//! the end of the face the normal turns and the depth fades to zero, so that a vehicle that slides off
//! the end of another one is let go without a jump.
//! Leaves out: the wheels, the taper of nose and tail, everything above and below the bumpers.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use crate::collision::{Footprint, FootprintError, Side};
use crate::vehicle::VehicleParameters;

/// Radius of the corners of a car in plan view over its width, where nobody says it: some 0.65 m. It
/// stands for the bow of the bumpers and for the taper of nose and tail. Fitted to pushing pairs with the
/// stiffness of the faces.
pub const USUAL_CORNER_SHARE: f64 = 0.37;

/// Longest element of an outline where nobody says it, m.
pub const USUAL_ELEMENT_M: f64 = 0.08;

/// Piece of an outline that the contact law treats as one strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlineElement {
    /// Reference point `[x, y]` in body axes, m: the middle of the element before any deformation.
    pub point_body_m: [f64; 2],
    /// Outward normal `[x, y]` in body axes.
    pub normal_body: [f64; 2],
    /// Width w along the outline, m.
    pub width_m: f64,
    /// The face whose law it has: at a corner the one that it looks to more.
    pub face: Side,
}

/// Outline of a vehicle, cut into elements.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactOutline {
    footprint: Footprint,
    corner_radius_m: f64,
    /// Counter-clockwise from the right end of the flat part of the front.
    elements: Vec<OutlineElement>,
    /// Elements of the flat parts of front and rear, of the sides, and of a corner.
    counts: [usize; 3],
    /// Sines of the angles that divide a corner, from the first to the last.
    corner_sines: Vec<f64>,
    /// Circles about neighbouring elements, by which those are found that may touch.
    groups: Vec<ElementGroup>,
}

/// Neighbouring elements with a circle about their reference points.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ElementGroup {
    /// Their numbers.
    pub elements: Range<usize>,
    /// Middle of the circle in body axes, m.
    pub middle_body_m: [f64; 2],
    /// Its radius, m.
    pub radius_m: f64,
}

/// Elements of a group.
const GROUP: usize = 8;

impl ElementGroup {
    fn new(first: usize, elements: &[OutlineElement]) -> Self {
        let n = elements.len().max(1) as f64;
        let mean = |axis: usize| elements.iter().map(|it| it.point_body_m[axis]).sum::<f64>() / n;
        let middle_body_m = [mean(0), mean(1)];
        let off_m = |it: &OutlineElement| {
            let [x, y] = it.point_body_m;
            (x - middle_body_m[0]).hypot(y - middle_body_m[1])
        };
        let radius_m = elements.iter().map(off_m).fold(0.0, f64::max);
        Self { elements: first..first + elements.len(), middle_body_m, radius_m }
    }
}

/// Where a point inside of an outline came from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Foot {
    /// Depth D below the face, m.
    pub depth_m: f64,
    /// Outward normal of the outline at the foot, body axes.
    pub normal_body: [f64; 2],
    /// Number of the element at the foot.
    pub element: usize,
}

impl ContactOutline {
    /// Cuts a rectangle with rounded corners into elements of equal width on each part.
    ///
    /// - `corner_radius_m`: 0 up to half of the shorter edge;
    /// - `longest_element_m`: more than 0.
    ///
    /// # Errors
    /// [`FootprintError::Range`] for the first number that is out of range.
    pub fn new(
        footprint: Footprint,
        corner_radius_m: f64,
        longest_element_m: f64,
    ) -> Result<Self, FootprintError> {
        footprint.check()?;
        let half_m = footprint.length_m.min(footprint.width_m) / 2.0;
        for (is_good, name, value, expected) in [
            (
                (0.0..half_m).contains(&corner_radius_m),
                "corner_radius_m",
                corner_radius_m,
                "0 to half of the shorter edge",
            ),
            (
                longest_element_m.is_finite() && longest_element_m > 1e-3,
                "longest_element_m",
                longest_element_m,
                "more than 0.001",
            ),
        ] {
            if !is_good {
                return Err(FootprintError::Range { name, value, expected });
            }
        }
        let n = |length_m: f64| (length_m / longest_element_m).ceil() as usize;
        let counts = [
            n(footprint.width_m - 2.0 * corner_radius_m).max(1),
            n(footprint.length_m - 2.0 * corner_radius_m).max(1),
            n(FRAC_PI_2 * corner_radius_m),
        ];
        let n_corner = counts[2];
        let corner_sines =
            (1..n_corner).map(|i| (FRAC_PI_2 * i as f64 / n_corner as f64).sin_cos().0).collect();
        let mut outline = Self {
            footprint,
            corner_radius_m,
            elements: Vec::new(),
            counts,
            corner_sines,
            groups: Vec::new(),
        };
        for (face, quarter) in
            [(Side::Front, 0), (Side::Left, 1), (Side::Rear, 2), (Side::Right, 3)]
        {
            outline.add_face(face, quarter);
            outline.add_corner(quarter);
        }
        let groups = outline.elements.chunks(GROUP).enumerate();
        outline.groups = groups.map(|(i, group)| ElementGroup::new(i * GROUP, group)).collect();
        Ok(outline)
    }

    /// The outline of a vehicle with the usual corners and elements.
    ///
    /// # Errors
    /// [`FootprintError::Range`] if the outer dimensions of the vehicle are out of range.
    pub fn from_vehicle(vehicle: &VehicleParameters) -> Result<Self, FootprintError> {
        Self::of_elements(vehicle, USUAL_ELEMENT_M)
    }

    /// The same with elements of another length.
    ///
    /// - `longest_element_m`: more than 0.001.
    ///
    /// # Errors
    /// [`FootprintError::Range`], likewise.
    pub fn of_elements(
        vehicle: &VehicleParameters,
        longest_element_m: f64,
    ) -> Result<Self, FootprintError> {
        let footprint = Footprint::from(&vehicle.geometry);
        let shorter_m = footprint.width_m.min(footprint.length_m);
        Self::new(footprint, USUAL_CORNER_SHARE * shorter_m, longest_element_m)
    }

    /// The elements, counter-clockwise from the right end of the front.
    pub fn elements(&self) -> &[OutlineElement] {
        &self.elements
    }

    /// All elements in groups of neighbours.
    pub(super) fn groups(&self) -> &[ElementGroup] {
        &self.groups
    }

    /// The rectangle.
    pub fn footprint(&self) -> Footprint {
        self.footprint
    }

    /// Radius of the corners, m.
    pub fn corner_radius_m(&self) -> f64 {
        self.corner_radius_m
    }

    /// Halves of length and width, m.
    pub(super) fn half_m(&self) -> [f64; 2] {
        [self.footprint.length_m / 2.0, self.footprint.width_m / 2.0]
    }

    /// x of the middle of the outline in body axes, m.
    pub(super) fn middle_x_m(&self) -> f64 {
        self.footprint.cg_from_front_m - self.footprint.length_m / 2.0
    }

    /// Appends the flat part of a face, whose outward normal is turned by quarters from x.
    fn add_face(&mut self, face: Side, quarter: usize) {
        let [half_length_m, half_width_m] = self.half_m();
        let is_end = quarter.is_multiple_of(2);
        let (out_m, half_flat_m, n) = match is_end {
            true => (half_length_m, half_width_m - self.corner_radius_m, self.counts[0]),
            false => (half_width_m, half_length_m - self.corner_radius_m, self.counts[1]),
        };
        let width_m = 2.0 * half_flat_m / n as f64;
        for i in 0..n {
            let along_m = width_m * (i as f64 + 0.5) - half_flat_m;
            self.add(quarter, [out_m, along_m], [1.0, 0.0], width_m, face);
        }
    }

    /// Appends the corner that follows a face.
    fn add_corner(&mut self, quarter: usize) {
        let [half_length_m, half_width_m] = self.half_m();
        let radius_m = self.corner_radius_m;
        let is_end = quarter.is_multiple_of(2);
        let (out_m, side_m) =
            if is_end { (half_length_m, half_width_m) } else { (half_width_m, half_length_m) };
        let n = self.counts[2];
        let step_rad = FRAC_PI_2 / n.max(1) as f64;
        let width_m = 2.0 * radius_m * (step_rad / 2.0).sin_cos().0;
        for i in 0..n {
            let (sin, cos) = (step_rad * (i as f64 + 0.5)).sin_cos();
            let place_m = [out_m - radius_m + radius_m * cos, side_m - radius_m + radius_m * sin];
            // The middle of a corner belongs to the end of the vehicle, on the left as on the right.
            let margin = if is_end { 1e-9 } else { -1e-9 };
            let side = Side::ALL[if sin < cos + margin { quarter } else { (quarter + 1) % 4 }];
            self.add(quarter, place_m, [cos, sin], width_m, side);
        }
    }

    /// Appends an element, given in axes that are turned by quarters.
    fn add(
        &mut self,
        quarter: usize,
        place_m: [f64; 2],
        normal: [f64; 2],
        width_m: f64,
        face: Side,
    ) {
        let turned = |[x, y]: [f64; 2]| match quarter {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        };
        let [x, y] = turned(place_m);
        self.elements.push(OutlineElement {
            point_body_m: [x + self.middle_x_m(), y],
            normal_body: turned(normal),
            width_m,
            face,
        });
    }

    /// Whether a point lies inside.
    ///
    /// - `point`: in body axes, m.
    pub(super) fn holds_body_point(&self, [x, y]: [f64; 2]) -> bool {
        let [half_length_m, half_width_m] = self.half_m();
        let off_m = [(x - self.middle_x_m()).abs() - half_length_m, y.abs() - half_width_m];
        let [beyond_x, beyond_y] = off_m.map(|off_m| (off_m + self.corner_radius_m).max(0.0));
        off_m.iter().all(|off_m| *off_m < 0.0) && beyond_x.hypot(beyond_y) <= self.corner_radius_m
    }

    /// Depth of a point below the nearest place of the outline, m: the distance from it, less than 0 outside.
    ///
    /// - `point`: in body axes, m.
    pub fn depth_of_body_point_m(&self, [x, y]: [f64; 2]) -> f64 {
        let [half_length_m, half_width_m] = self.half_m();
        let [off_x, off_y] = [
            (x - self.middle_x_m()).abs() - half_length_m + self.corner_radius_m,
            y.abs() - half_width_m + self.corner_radius_m,
        ];
        let outside_m = off_x.max(0.0).hypot(off_y.max(0.0));
        self.corner_radius_m - outside_m - off_x.max(off_y).min(0.0)
    }

    /// Depth of a point below the flat part of each face, m, in the order of [`Side::ALL`].
    ///
    /// - `point`: from the middle of the outline in body axes, m.
    pub(super) fn depths_m(&self, [x, y]: [f64; 2]) -> [f64; 4] {
        let [half_length_m, half_width_m] = self.half_m();
        [half_length_m - x, half_width_m - y, half_length_m + x, half_width_m + y]
    }

    /// The foot of a point on a face; `None` where the point lies beside the face or outside of it.
    ///
    /// - `point`: from the middle of the outline in body axes, m.
    pub(super) fn foot(&self, face: Side, [x, y]: [f64; 2]) -> Option<Foot> {
        let [half_length_m, half_width_m] = self.half_m();
        // Axes of the face: out along its normal, along to the left of it.
        let (quarter, [out, along], [out_m, side_m]) = match face {
            Side::Front => (0, [x, y], [half_length_m, half_width_m]),
            Side::Left => (1, [y, -x], [half_width_m, half_length_m]),
            Side::Rear => (2, [-x, -y], [half_length_m, half_width_m]),
            Side::Right => (3, [-y, x], [half_width_m, half_length_m]),
        };
        let radius_m = self.corner_radius_m;
        let beyond_flat_m = along.abs() - (side_m - radius_m);
        let (sin, cos) = if beyond_flat_m > 0.0 {
            if beyond_flat_m >= radius_m {
                return None;
            }
            let sin = beyond_flat_m / radius_m;
            (sin, (1.0 - sin * sin).sqrt())
        } else {
            (0.0, 1.0)
        };
        let depth_m = (out_m - radius_m + radius_m * cos - out) * cos;
        if depth_m <= 0.0 {
            return None;
        }
        let turn = if along < 0.0 { -sin } else { sin };
        let normal_body = match quarter {
            0 => [cos, turn],
            1 => [-turn, cos],
            2 => [-cos, -turn],
            _ => [turn, -cos],
        };
        let element = self.element_at(quarter, along, side_m - radius_m, sin);
        Some(Foot { depth_m, normal_body, element })
    }

    /// Number of the element at a place of a face and its corners.
    ///
    /// - `along`: from the middle of the face to its left, m;
    /// - `sin`: of the angle of the corner, 0 on the flat part.
    fn element_at(&self, quarter: usize, along: f64, half_flat_m: f64, sin: f64) -> usize {
        let [n_end, n_side, n_corner] = self.counts;
        let n_flat = if quarter.is_multiple_of(2) { n_end } else { n_side };
        let before = [0, n_end, n_end + n_side, 2 * n_end + n_side][quarter] + quarter * n_corner;
        if sin > 0.0 {
            let place = self.corner_sines.iter().take_while(|&&end| end < sin).count();
            return match along < 0.0 {
                false => before + n_flat + place,
                // The corner before the face, from its end backwards.
                true => {
                    let first = if quarter == 0 { self.elements.len() } else { before };
                    first - 1 - place
                }
            };
        }
        let place = (along + half_flat_m) / (2.0 * half_flat_m) * n_flat as f64;
        before + (place.max(0.0) as usize).min(n_flat - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collision::footprint::examples::CAR;

    #[test]
    fn the_elements_go_around_the_outline() {
        for (radius_m, longest_m) in [(0.0, 0.1), (0.25, 0.08), (0.4, 0.05)] {
            let outline = ContactOutline::new(CAR, radius_m, longest_m).unwrap();
            let elements = outline.elements();
            let around_m: f64 = elements.iter().map(|element| element.width_m).sum();
            let edges_m = 2.0 * (CAR.length_m + CAR.width_m);
            let exact_m = edges_m - (8.0 - std::f64::consts::TAU) * radius_m;
            assert!((around_m / exact_m - 1.0).abs() < 2e-3, "{around_m} m, {exact_m} m");
            // What each face shows along its normal is its width.
            let shown = |axis: usize| -> f64 {
                let widths = elements.iter().map(|it| it.width_m * it.normal_body[axis].max(0.0));
                widths.sum()
            };
            assert!((shown(0) - CAR.width_m).abs() < 1e-9, "{}", shown(0));
            assert!((shown(1) - CAR.length_m).abs() < 1e-9, "{}", shown(1));
            // Neighbours touch, and the outline closes.
            for (i, element) in elements.iter().enumerate() {
                let next = elements[(i + 1) % elements.len()];
                let [x, y] = element.point_body_m;
                let gap_m = (next.point_body_m[0] - x).hypot(next.point_body_m[1] - y);
                let widths_m = (element.width_m + next.width_m) / 2.0;
                assert!(element.width_m <= longest_m, "element {i}");
                assert!(gap_m <= 1.002 * widths_m, "element {i}: {gap_m} m to the next");
            }
        }
    }

    #[test]
    fn the_foot_of_a_point_under_an_element_is_that_element() {
        let outline = ContactOutline::new(CAR, 0.3, 0.07).unwrap();
        for (i, element) in outline.elements().iter().enumerate() {
            let depth_m = 0.01;
            let [x, y] = element.point_body_m;
            let [nx, ny] = element.normal_body;
            let point = [x - depth_m * nx - outline.middle_x_m(), y - depth_m * ny];
            let foot = outline.foot(element.face, point).unwrap();
            assert_eq!(foot.element, i, "{element:?}");
            let off = (foot.depth_m - depth_m).abs();
            assert!(off < 1.2e-3, "element {i}: {foot:?}");
            let [fx, fy] = foot.normal_body;
            assert!((fx - nx).hypot(fy - ny) < 0.05, "element {i}: {foot:?}, {element:?}");
            let outside = [point[0] + 2.0 * depth_m * nx, point[1] + 2.0 * depth_m * ny];
            assert_eq!(outline.foot(element.face, outside), None, "element {i}");
        }
    }

    #[test]
    fn the_depth_fades_towards_the_end_of_a_face() {
        let outline = ContactOutline::new(CAR, 0.25, 0.08).unwrap();
        let [half_length_m, half_width_m] = outline.half_m();
        let y = half_width_m - 0.4;
        let depths: Vec<f64> = (0..=100)
            .map(|i| half_length_m - 0.3 + 0.003 * f64::from(i))
            .map(|x| outline.foot(Side::Left, [x, y]).map_or(0.0, |foot| foot.depth_m))
            .collect();
        assert!((depths[0] - 0.4).abs() < 1e-12 && depths[100] == 0.0, "{depths:?}");
        let largest = depths.windows(2).map(|pair| pair[0] - pair[1]).fold(0.0, f64::max);
        assert!(largest < 0.03 && depths.windows(2).all(|pair| pair[1] <= pair[0]), "{largest}");
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        for (radius_m, longest_m, expected) in [
            (-0.1, 0.1, "corner_radius_m"),
            (0.9, 0.1, "corner_radius_m"),
            (0.2, 0.0, "longest_element_m"),
        ] {
            match ContactOutline::new(CAR, radius_m, longest_m) {
                Err(FootprintError::Range { name, .. }) => assert_eq!(name, expected),
                other => panic!("{other:?}"),
            }
        }
    }
}
