//! A part of the ground on which the tires grip differently: ice, a wet patch, gravel, a verge.

use serde::{Deserialize, Serialize};

use crate::numerics::{polygon_area, polygon_holds};
use crate::ranges::{OutOfRange, POSITION, ROAD_FRICTION};
use crate::units::{Phrase, PhraseValue};

/// Most corners of a border: more than any outline in a plan of a scene has.
pub const MAX_BORDER_CORNERS: usize = 1000;

/// Standard deviation of the logarithm of the friction of zones over that which a site says, in all zones alike:
/// ours. Grass, gravel and wet patches are known less well than a road.
pub const ZONE_FRICTION_LOG_SIGMA: f64 = 0.15;

/// Smallest area of a zone, m².
const LEAST_AREA_M2: f64 = 1e-4;

/// Places along each side of the rectangle about a zone at which it is looked at.
const N_ACROSS: usize = 20;

/// A part of the ground with its own friction. Where zones overlap, the last of a list holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrictionZone {
    /// What it is, such as “verge”.
    pub name: String,
    /// Corners `[X, Y]` of its border in either sense, m; the last is joined to the first.
    pub border_m: Vec<[f64; 2]>,
    /// Peak friction coefficient μ between tire and ground in it, in the range
    /// [`ROAD_FRICTION`](crate::ranges::ROAD_FRICTION).
    pub friction: f64,
}

/// Reason for which a zone is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FrictionZoneError {
    /// The friction is out of range.
    #[error("friction zone {zone:?}")]
    Friction {
        /// Name of the zone.
        zone: String,
        /// The value and its range.
        source: OutOfRange,
    },
    /// A coordinate is not finite or too large.
    #[error("friction zone {zone:?}: corner {corner} of border_m")]
    Corner {
        /// Name of the zone.
        zone: String,
        /// Number of the corner, from 1.
        corner: usize,
        /// The value and its range.
        source: OutOfRange,
    },
    /// There are too few different corners for an area, or too many.
    #[error(
        "friction zone {zone:?}: border_m has {n_corners} corners, expected 3 to {MAX_BORDER_CORNERS} \
         different ones"
    )]
    Corners {
        /// Name of the zone.
        zone: String,
        /// Number of corners; corners that repeat the one before count once.
        n_corners: usize,
    },
    /// The corners lie on one line.
    #[error("friction zone {zone:?}: border_m encloses no area, expected one of 1 cm² or more")]
    NoArea {
        /// Name of the zone.
        zone: String,
    },
    /// Two sides of the border cross each other.
    #[error(
        "friction zone {zone:?}: the sides of border_m from corner {first} and from corner {second} \
         cross, expected corners in their order along the border"
    )]
    Crossing {
        /// Name of the zone.
        zone: String,
        /// Number of the corner at which one side begins, from 1.
        first: usize,
        /// The same of the other side.
        second: usize,
    },
}

impl FrictionZone {
    /// What a zone of a survey is called that has no name there.
    pub const UNNAMED: &'static str = "friction zone";

    /// The same with another friction, within what a ground has.
    ///
    /// - `factor`: on that which the site says.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let friction = (self.friction * factor).clamp(ROAD_FRICTION.low, ROAD_FRICTION.high);
        Self { friction, ..self.clone() }
    }

    /// Checks friction and border. Sides of the border may touch each other, as around a hole, but not
    /// cross.
    ///
    /// # Errors
    /// [`FrictionZoneError`], which names the zone and what is expected.
    pub fn check(&self) -> Result<(), FrictionZoneError> {
        let zone = || self.name.clone();
        ROAD_FRICTION
            .check(self.friction)
            .map_err(|source| FrictionZoneError::Friction { zone: zone(), source })?;
        for (idx, corner) in self.border_m.iter().enumerate() {
            for value in *corner {
                let corner = idx + 1;
                POSITION.check(value).map_err(|source| FrictionZoneError::Corner {
                    zone: zone(),
                    corner,
                    source,
                })?;
            }
        }
        let corners = self.different_corners();
        if !(3..=MAX_BORDER_CORNERS).contains(&corners.len()) {
            return Err(FrictionZoneError::Corners { zone: zone(), n_corners: corners.len() });
        }
        if let Some([first, second]) = crossing(&corners) {
            return Err(FrictionZoneError::Crossing { zone: zone(), first, second });
        }
        if polygon_area(&self.border_m) < LEAST_AREA_M2 {
            return Err(FrictionZoneError::NoArea { zone: zone() });
        }
        Ok(())
    }

    /// Whether the zone holds a place `[X, Y]`, m. Of a place on the border nothing is promised.
    pub fn holds(&self, place_m: [f64; 2]) -> bool {
        polygon_holds(&self.border_m, place_m)
    }

    /// Places in it, evenly spread; none in one that is narrower than they are apart.
    fn places(&self) -> impl Iterator<Item = [f64; 2]> {
        let ends = |axis: usize| {
            let along = self.border_m.iter().map(|corner| corner[axis]);
            [along.clone().fold(f64::INFINITY, f64::min), along.fold(f64::NEG_INFINITY, f64::max)]
        };
        let [x_m, y_m] = [ends(0), ends(1)];
        let at = |[low, high]: [f64; 2], i: usize| {
            low + (high - low) * (i as f64 + 0.5) / N_ACROSS as f64
        };
        let cells = 0..N_ACROSS * N_ACROSS;
        let places = cells.map(move |cell| [at(x_m, cell / N_ACROSS), at(y_m, cell % N_ACROSS)]);
        places.filter(move |place| self.holds(*place))
    }

    /// The corners with their numbers from 1, without those that repeat the corner before.
    fn different_corners(&self) -> Vec<(usize, [f64; 2])> {
        let mut corners: Vec<(usize, [f64; 2])> = Vec::with_capacity(self.border_m.len());
        for (idx, corner) in self.border_m.iter().enumerate() {
            if corners.last().is_none_or(|(_, before)| before != corner) {
                corners.push((idx + 1, *corner));
            }
        }
        while let ([(_, first), _, ..], Some((_, last))) = (&corners[..], corners.last())
            && first == last
        {
            corners.pop();
        }
        corners
    }
}

/// Peak friction of the ground at a place `[X, Y]`, m.
///
/// - `zones`: where they overlap, the last one holds;
/// - `elsewhere`: friction where there is no zone.
pub fn friction_at(zones: &[FrictionZone], place_m: [f64; 2], elsewhere: f64) -> f64 {
    let zone = zones.iter().rev().find(|zone| zone.holds(place_m));
    zone.map_or(elsewhere, |zone| zone.friction)
}

/// The zones that hold nowhere, since later ones of another friction lie over all of them, in words.
///
/// - `zones`: where they overlap, the last one holds.
pub fn hidden_zones(zones: &[FrictionZone]) -> Vec<Phrase> {
    let is_hidden = |(idx, zone): &(usize, &FrictionZone)| {
        let later = zones.get(idx + 1..).unwrap_or_default();
        let is_over = |place| friction_at(later, place, zone.friction) != zone.friction;
        zone.places().next().is_some() && zone.places().all(is_over)
    };
    let told = |(_, zone): (usize, &FrictionZone)| {
        Phrase::new(
            "the friction of the zone {0} counts nowhere: zones after it lie over all of it, and where zones overlap, \
             the last one holds; put it after them",
            "Der Reibbeiwert des Bereichs {0} gilt nirgends: Spätere Bereiche überdecken ihn ganz, und wo Bereiche \
             einander überdecken, gilt der letzte; ihn hinter sie stellen",
        )
        .with(PhraseValue::Name(format!("{:?}", zone.name)))
    };
    zones.iter().enumerate().filter(is_hidden).map(told).collect()
}

/// The numbers of the corners at which two sides begin that cross; `None` if no sides do.
fn crossing(corners: &[(usize, [f64; 2])]) -> Option<[usize; 2]> {
    let n = corners.len();
    let side = |i: usize| (corners[i].0, corners[i].1, corners[(i + 1) % n].1);
    for i in 0..n {
        let (first, a, b) = side(i);
        for j in i + 2..n {
            let (second, c, d) = side(j);
            if cross(a, b, c, d) {
                return Some([first, second]);
            }
        }
    }
    None
}

/// Whether the ends of each of two sides lie on different sides of the other one.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    let turn = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    };
    turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn zone(border_m: &[[f64; 2]], friction: f64) -> FrictionZone {
        FrictionZone { name: "ice".to_owned(), border_m: border_m.to_vec(), friction }
    }

    /// An L with its corner at the origin, 4 m long and 1 m wide.
    const BENT: [[f64; 2]; 6] =
        [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]];

    #[test]
    fn a_concave_zone_holds_what_lies_in_it_in_either_sense() {
        let mut reversed = BENT;
        reversed.reverse();
        let mut closed = BENT.to_vec();
        closed.push(BENT[0]);
        for border in [&BENT[..], &reversed[..], &closed[..]] {
            let zone = zone(border, 0.1);
            zone.check().unwrap();
            for (place, holds) in [
                ([0.5, 0.5], true),
                ([3.5, 0.5], true),
                ([0.5, 3.5], true),
                ([2.0, 2.0], false),
                ([1.5, 1.5], false),
                ([-0.1, 0.5], false),
                ([5.0, 0.5], false),
            ] {
                assert_eq!(zone.holds(place), holds, "{place:?} in {border:?}");
            }
        }
    }

    #[test]
    fn the_last_zone_holds_where_two_overlap() {
        let square = |low: f64, high: f64| [[low, low], [high, low], [high, high], [low, high]];
        let zones = [zone(&square(0.0, 2.0), 0.1), zone(&square(1.0, 3.0), 0.4)];
        for (place, friction) in [(0.5, 0.1), (1.5, 0.4), (2.5, 0.4), (3.5, 0.8)] {
            assert_eq!(friction_at(&zones, [place; 2], 0.8), friction, "at {place}");
        }
    }

    /// A verge that is drawn after a patch of ice on it takes the ice away, and nothing said so.
    #[test]
    fn a_zone_that_later_ones_lie_over_is_told() {
        let strip = |[low, high]: [f64; 2]| [[low, 0.0], [high, 0.0], [high, 2.0], [low, 2.0]];
        let [ice, left, right] = [strip([4.0, 6.0]), strip([0.0, 5.0]), strip([5.0, 9.0])];
        let n_hidden = |zones: &[FrictionZone]| hidden_zones(zones).len();
        // Of two halves that lie over it only both hide it, and they have its border in part.
        assert_eq!(n_hidden(&[zone(&ice, 0.1), zone(&left, 0.5)]), 0);
        assert_eq!(n_hidden(&[zone(&ice, 0.1), zone(&left, 0.5), zone(&right, 0.4)]), 1);
        assert_eq!(n_hidden(&[zone(&left, 0.5), zone(&right, 0.4), zone(&ice, 0.1)]), 0);
        // The same outline twice, and one friction, of which it does not matter who has it.
        let said = hidden_zones(&[zone(&BENT, 0.1), zone(&BENT, 0.5)]);
        let texts: Vec<String> = said.iter().map(|of| of.say(&Default::default())).collect();
        assert_eq!(texts.len(), 1, "{texts:?}");
        assert!(texts[0].starts_with("the friction of the zone \"ice\" counts"), "{texts:?}");
        assert_eq!(n_hidden(&[zone(&BENT, 0.1), zone(&BENT, 0.1)]), 0);
        assert_eq!(n_hidden(&[zone(&BENT, 0.1)]), 0);
    }

    #[test]
    fn what_is_no_area_with_a_friction_is_refused() {
        let bow_tie = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
        let on_a_line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]];
        let repeated = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]];
        let lost = [[0.0, 0.0], [1.0, f64::NAN], [1.0, 1.0]];
        let many: Vec<[f64; 2]> =
            (0..1001).map(|i| f64::from(i) / 160.0).map(|rad| [rad.cos(), rad.sin()]).collect();
        for (border, friction, expected) in [
            (&BENT[..], 3.0, "friction zone \"ice\""),
            (&BENT[..], f64::NAN, "friction zone \"ice\""),
            (&bow_tie, 0.1, "from corner 1 and from corner 3 cross"),
            (&on_a_line, 0.1, "encloses no area"),
            (&repeated, 0.1, "has 2 corners, expected 3"),
            (&[], 0.1, "has 0 corners"),
            (&lost, 0.1, "corner 2 of border_m"),
            (&many[..], 0.1, "has 1001 corners"),
        ] {
            let error = zone(border, friction).check().unwrap_err();
            assert!(error.to_string().contains(expected), "{error} for {expected}");
        }
    }
}
