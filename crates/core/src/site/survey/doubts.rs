//! What the coordinates of a survey say that a slip of the hand explains better: columns that are swapped, so that the
//! ground is mirrored, a wrong digit within a line, a unit, degrees.

use std::collections::BTreeMap;

use crate::site::MapShape;
use crate::site::survey::found::Thing;

/// Eastings and northings of a place whose columns are swapped, m. Eastings of UTM lie between 100 and 900 km, and
/// northings of the north from 30° on above 3000 km.
const SWAPPED_EASTING_M: std::ops::Range<f64> = 3e6..1e7;
const SWAPPED_NORTHING_M: std::ops::Range<f64> = 1e5..9e5;

/// The same in Gauss-Krüger zones 2 to 4 of Germany, whose systems count to the north first: eastings begin with the
/// number of the zone, and northings lie between 5200 and 6100 km.
const SWAPPED_GAUSS_KRUEGER_M: [std::ops::Range<f64>; 2] = [5.2e6..6.1e6, 2.3e6..4.8e6];

/// Step of a line from which it may be a wrong digit, m, and its ratio to those that are usual there.
const LONG_STEP_M: f64 = 100.0;
const LONG_RATIO: f64 = 20.0;

/// Distance from the first point that the place of a collision hardly has, m.
const FAR_M: f64 = 5000.0;

/// Distance from the first point within which no ground lies, m: as degrees it is 2 km.
const NEAR_M: f64 = 0.02;

/// Distance of two measurements of one point, at most, m.
const SAME_POINT_M: f64 = 0.1;

/// Most names of points that are shown.
const MAX_NAMES: usize = 6;

/// Where the numbered points of a table are, and which of them are elsewhere, too.
#[derive(Default)]
pub(super) struct Places {
    first_m: BTreeMap<String, [f64; 2]>,
    elsewhere: Vec<String>,
}

impl Places {
    /// Takes a point, m. A name without a digit may be that of a kind of point.
    pub fn take(&mut self, point: &Thing) {
        let Some(at_m) = point.at.first().filter(|_| point.name.contains(char::is_numeric)) else {
            return;
        };
        let first_m = self.first_m.entry(point.name.clone()).or_insert(*at_m);
        let apart_m = distance(first_m, at_m);
        if apart_m > SAME_POINT_M {
            self.elsewhere.push(format!("{} ({apart_m:.2} m apart)", point.name));
        }
    }

    /// That names stand at several places.
    pub fn note(&self) -> Option<String> {
        let shown: Vec<&str> = self.elsewhere.iter().take(MAX_NAMES).map(String::as_str).collect();
        let more = match self.elsewhere.len().saturating_sub(shown.len()) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        (!shown.is_empty()).then(|| {
            format!(
                "points of one number stand at more than one place: {}{more}; which is meant is not in the file",
                shown.join(", ")
            )
        })
    }
}

/// What is in doubt, a sentence each.
///
/// - `things`: to the east and to the north;
/// - `unit_m`: length of the unit of their coordinates, m.
pub(super) fn doubts(things: &[Thing], unit_m: f64) -> Vec<String> {
    let lines = things.iter().filter(|thing| thing.shape == MapShape::Line);
    let long_steps = lines.filter_map(|line| long_step(line, unit_m));
    let extent = far(things, unit_m).or_else(|| in_degrees(things, unit_m));
    swapped(things, unit_m).into_iter().chain(long_steps).chain(extent).collect()
}

fn distance(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn swapped(things: &[Thing], unit_m: f64) -> Option<String> {
    let [east_m, north_m] = things.first()?.at.first()?.map(|value| value * unit_m);
    let is_within = |[east, north]: [std::ops::Range<f64>; 2]| {
        east.contains(&east_m) && north.contains(&north_m)
    };
    let is_swapped =
        is_within([SWAPPED_EASTING_M, SWAPPED_NORTHING_M]) || is_within(SWAPPED_GAUSS_KRUEGER_M);
    is_swapped.then(|| {
        format!(
            "an easting of {east_m:.0} m and a northing of {north_m:.0} m are the other way round in most grids: if the \
             columns are swapped, the ground is mirrored"
        )
    })
}

/// A step of a line that is far longer than the others.
fn long_step(line: &Thing, unit_m: f64) -> Option<String> {
    let steps = line.at.iter().zip(line.at.iter().skip(1));
    let mut steps_m: Vec<f64> = steps.map(|(a, b)| unit_m * distance(a, b)).collect();
    steps_m.sort_by(f64::total_cmp);
    let usual_m = *steps_m.get(steps_m.len().checked_sub(1)? / 2)?;
    let longest_m = *steps_m.last()?;
    (steps_m.len() > 1 && longest_m > LONG_STEP_M.max(LONG_RATIO * usual_m)).then(|| {
        format!(
            "two neighbouring points of the line {:?} are {longest_m:.0} m apart, and others {usual_m:.1} m: is a digit \
             wrong, or are there two lines of one code?",
            line.name
        )
    })
}

fn far(things: &[Thing], unit_m: f64) -> Option<String> {
    let farthest_m = farthest_m(things, unit_m)?;
    (farthest_m > FAR_M).then(|| {
        format!("the points lie up to {farthest_m:.0} m from the first one: is the unit right, and are all of one place?")
    })
}

/// Points in a grid that could be longitudes and latitudes and lie within a fingertip.
fn in_degrees(things: &[Thing], unit_m: f64) -> Option<String> {
    let farthest_m = farthest_m(things, unit_m)?;
    let mut all = things.iter().flat_map(|thing| &thing.at);
    let could_be = all.all(|at| at.iter().all(|value| (value * unit_m).abs() <= 180.0));
    (could_be && farthest_m > 0.0 && farthest_m < NEAR_M).then(|| {
        format!(
            "all points lie within {:.1} mm: if the coordinates are longitude and latitude, the ground is far too small",
            1e3 * farthest_m
        )
    })
}

/// Distance of the point that is farthest from the first one, m.
fn farthest_m(things: &[Thing], unit_m: f64) -> Option<f64> {
    let first = things.first()?.at.first()?;
    let all = things.iter().flat_map(|thing| &thing.at);
    Some(all.map(|at| unit_m * distance(first, at)).fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(at: &[[f64; 2]]) -> Thing {
        Thing {
            name: "KERB1".to_owned(),
            shape: MapShape::Line,
            at: at.to_vec(),
            ..Thing::default()
        }
    }

    #[test]
    fn slips_of_the_hand_are_told_and_a_survey_is_not() {
        let place = [[512_345.1, 5_423_456.8], [512_347.1, 5_423_460.8], [512_350.2, 5_423_466.1]];
        assert_eq!(doubts(&[line(&place)], 1.0), Vec::<String>::new());
        let swapped = doubts(&[line(&place.map(|[east, north]| [north, east]))], 1.0);
        assert!(swapped.len() == 1 && swapped[0].contains("mirrored"), "{swapped:?}");
        let mut typed = place;
        typed[2][0] = 512_850.2;
        let digit = doubts(&[line(&typed)], 1.0);
        assert!(digit.len() == 1 && digit[0].contains("\"KERB1\" are 503 m apart"), "{digit:?}");
        let in_mm =
            place.map(|[east, north]| [1e3 * (east - 512_300.0), 1e3 * (north - 5_423_400.0)]);
        let unit = doubts(&[line(&in_mm)], 1.0);
        assert!(unit.len() == 1 && unit[0].contains("is the unit right"), "{unit:?}");
        assert_eq!(doubts(&[line(&in_mm)], 1e-3), Vec::<String>::new());
    }

    /// A table with E and N above degrees was a ground of a millimetre, without a word.
    #[test]
    fn degrees_in_columns_of_a_grid_are_told() {
        let degrees = [[8.65, 49.87], [8.651, 49.87], [8.651, 49.8705]];
        let found = doubts(&[line(&degrees)], 1.0);
        let begin = "all points lie within 1.1 mm: if";
        assert!(found.len() == 1 && found[0].starts_with(begin), "{found:?}");
        let in_metres = degrees.map(|at| at.map(|value| 1e3 * (value - 8.0)));
        assert_eq!(doubts(&[line(&in_metres)], 1.0), Vec::<String>::new());
        assert_eq!(doubts(&[line(&degrees[..1])], 1.0), Vec::<String>::new());
    }
}
