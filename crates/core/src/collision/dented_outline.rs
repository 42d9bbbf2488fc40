//! Outlines of two vehicles that overlap, each dented by the other.
//!
//! Rigid outlines overlap where crushed vehicles would touch. The part of each outline that lies inside
//! the other vehicle is replaced by one common line between both parts,
//!
//! ```text
//! c(s) = (1 − q) a(s) + q b(s)        0 ≤ s ≤ 1, the share of the way from where the outlines cross
//! ```
//!
//! with the part a of the first outline, the part b of the second one, and the share q of the
//! penetration that the first vehicle takes. This divides the overlap; it is no computation of damage:
//! nothing of it comes from stiffness, and rigid outlines overlap as far as the motions say.

use crate::collision::{Footprint, Pose};
use crate::numerics::line_length;

/// Places along the common line.
const N_PLACES: usize = 25;

/// Points of a line `[X, Y]`, m.
type Line = Vec<[f64; 2]>;

/// Outlines of two vehicles in world axes, each dented by the other.
#[derive(Debug, Clone, PartialEq)]
pub struct DentedOutlines {
    /// The common line `[X, Y]`, m, from where the outlines cross to where they cross again.
    pub dent_m: Vec<[f64; 2]>,
    /// The whole outlines `[X, Y]`, m, closed: the last point is the first one.
    pub outlines_m: [Vec<[f64; 2]>; 2],
}

impl DentedOutlines {
    /// Divides the overlap of two outlines; `None` if they do not cross at exactly two places.
    ///
    /// - `share_of_first`: share q of the penetration that the first vehicle takes, 0 to 1.
    pub fn new([first, second]: [(&Footprint, &Pose); 2], share_of_first: f64) -> Option<Self> {
        let [a, b] = [first, second].map(|(footprint, pose)| footprint.corners_m(pose));
        let [p, q] = crossings(&a, &b)?;
        let (inside_a, outside_a) = parts(&a, [p.on_first, q.on_first], &b)?;
        let (inside_b, outside_b) = parts(&b, [p.on_second, q.on_second], &a)?;
        let dent_m: Vec<[f64; 2]> = (0..N_PLACES)
            .map(|i| i as f64 / (N_PLACES - 1) as f64)
            .map(|share| {
                let (a, b) = (along(&inside_a, share), along(&inside_b, share));
                [0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * share_of_first)
            })
            .collect();
        let outlines_m = [outside_a, outside_b].map(|outside| closed(outside, &dent_m));
        Some(Self { dent_m, outlines_m })
    }
}

/// A place where two outlines cross: number of the side, from 0, and share of the way along it, on each.
#[derive(Clone, Copy)]
struct Crossing {
    on_first: f64,
    on_second: f64,
}

/// The crossings of two outlines, if there are two.
fn crossings(a: &[[f64; 2]; 4], b: &[[f64; 2]; 4]) -> Option<[Crossing; 2]> {
    let mut found = Vec::new();
    for i in 0..4 {
        for j in 0..4 {
            let (from, to) = (a[i], a[(i + 1) % 4]);
            let (start, end) = (b[j], b[(j + 1) % 4]);
            let [ax, ay] = [to[0] - from[0], to[1] - from[1]];
            let [bx, by] = [end[0] - start[0], end[1] - start[1]];
            let cross = ax * by - ay * bx;
            let [dx, dy] = [start[0] - from[0], start[1] - from[1]];
            let (along_a, along_b) = ((dx * by - dy * bx) / cross, (dx * ay - dy * ax) / cross);
            if (0.0..1.0).contains(&along_a) && (0.0..1.0).contains(&along_b) {
                let (on_first, on_second) = (i as f64 + along_a, j as f64 + along_b);
                found.push(Crossing { on_first, on_second });
            }
        }
    }
    found.try_into().ok()
}

/// The part of an outline inside another one, from the first of two places on it to the second, and the
/// part outside, from the second to the first.
fn parts(outline: &[[f64; 2]; 4], [p, q]: [f64; 2], other: &[[f64; 2]; 4]) -> Option<(Line, Line)> {
    let forwards = walk(outline, p, q);
    let mut backwards = walk(outline, q, p);
    let is_inside = |part: &[[f64; 2]]| holds(other, along(part, 0.5));
    match (is_inside(&forwards), is_inside(&backwards)) {
        (true, false) => Some((forwards, backwards)),
        (false, true) => {
            backwards.reverse();
            let mut outside = forwards;
            outside.reverse();
            Some((backwards, outside))
        }
        _ => None,
    }
}

/// The line along an outline from one place to another, in the sense of its corners.
fn walk(outline: &[[f64; 2]; 4], from: f64, to: f64) -> Vec<[f64; 2]> {
    let at = |place: f64| {
        let (side, share) = (place.floor() as usize % 4, place.fract());
        let (start, end) = (outline[side], outline[(side + 1) % 4]);
        [0, 1].map(|axis| start[axis] + (end[axis] - start[axis]) * share)
    };
    let to_ahead = if to > from { to } else { to + 4.0 };
    let corners = (from.floor() as usize + 1..).take_while(|corner| (*corner as f64) < to_ahead);
    let mut line = vec![at(from)];
    line.extend(corners.map(|corner| outline[corner % 4]));
    line.push(at(to));
    line
}

/// Whether a place lies inside a convex outline with corners in counter-clockwise order.
fn holds(outline: &[[f64; 2]; 4], [x, y]: [f64; 2]) -> bool {
    (0..4).all(|i| {
        let (a, b) = (outline[i], outline[(i + 1) % 4]);
        (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) > 0.0
    })
}

/// The place at a share of the length of a line, which has points.
fn along(line: &[[f64; 2]], share: f64) -> [f64; 2] {
    let mut left = share * line_length(line);
    for pair in line.windows(2) {
        let piece = line_length(pair);
        if left <= piece && piece > 0.0 {
            return [0, 1]
                .map(|axis| pair[0][axis] + (pair[1][axis] - pair[0][axis]) * left / piece);
        }
        left -= piece;
    }
    line.last().copied().unwrap_or_default()
}

/// An outline of its part outside and the dent, which begins where that ends, and ends where it begins.
fn closed(outside: Vec<[f64; 2]>, dent: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let between = outside.len().saturating_sub(2);
    let corners = outside.into_iter().skip(1).take(between);
    dent.last().copied().into_iter().chain(corners).chain(dent.iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collision::footprint::examples::{CAR, pose};
    use crate::numerics::polygon_area;

    #[test]
    fn the_overlap_is_divided_and_nothing_else_changes() {
        let car_m2 = CAR.length_m * CAR.width_m;
        // A corner in a side, a front in a front with an offset, a side in a corner.
        for (struck, striking) in [
            (pose(0.0, 0.0, 0.0), pose(-4.3, -1.3, 20.0)),
            (pose(0.0, 0.0, 0.0), pose(4.0, 0.7, 180.0)),
            (pose(1.0, 2.0, 70.0), pose(-0.5, -0.6, -10.0)),
        ] {
            let cars = [(&CAR, &struck), (&CAR, &striking)];
            let none = DentedOutlines::new(cars, 0.0).unwrap();
            let all = DentedOutlines::new(cars, 1.0).unwrap();
            let half = DentedOutlines::new(cars, 0.5).unwrap();
            let overlap_m2 = car_m2 - polygon_area(&all.outlines_m[0]);
            assert!(overlap_m2 > 0.01, "{struck:?}: overlap of {overlap_m2} m²");
            assert!((polygon_area(&none.outlines_m[0]) - car_m2).abs() < 1e-2, "{struck:?}");
            assert!((polygon_area(&none.outlines_m[1]) - car_m2 + overlap_m2).abs() < 2e-2);
            let lost: Vec<f64> =
                half.outlines_m.iter().map(|outline| car_m2 - polygon_area(outline)).collect();
            assert!((lost[0] + lost[1] - overlap_m2).abs() < 2e-2, "{lost:?} of {overlap_m2} m²");
            assert!(lost.iter().all(|lost| *lost > 0.0), "{lost:?}");
            for outline in &half.outlines_m {
                assert_eq!(outline.first(), outline.last(), "{struck:?}");
                assert!(half.dent_m.iter().all(|place| outline.contains(place)));
            }
        }
    }

    #[test]
    fn outlines_that_do_not_cross_have_no_dent() {
        let (struck, apart, inside) =
            (pose(0.0, 0.0, 0.0), pose(0.0, 5.0, 0.0), pose(0.0, 0.0, 90.0));
        for other in [apart, inside] {
            assert_eq!(DentedOutlines::new([(&CAR, &struck), (&CAR, &other)], 0.5), None);
        }
    }
}
