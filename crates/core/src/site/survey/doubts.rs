//! What the coordinates of a survey say that a slip of the hand explains better: columns that are swapped, so that the
//! ground is mirrored, a wrong digit within a line, a unit.

use crate::site::MapShape;
use crate::site::survey::found::Thing;

/// Eastings and northings of a place whose columns are swapped, m. Eastings of UTM lie between 100 and 900 km, and
/// northings of the north from 30° on above 3000 km.
const SWAPPED_EASTING_M: std::ops::Range<f64> = 3e6..1e7;
const SWAPPED_NORTHING_M: std::ops::Range<f64> = 1e5..9e5;

/// Step of a line from which it may be a wrong digit, m, and its ratio to those that are usual there.
const LONG_STEP_M: f64 = 100.0;
const LONG_RATIO: f64 = 20.0;

/// Distance from the first point that the place of a collision hardly has, m.
const FAR_M: f64 = 5000.0;

/// What is in doubt, a sentence each.
///
/// - `things`: to the east and to the north;
/// - `unit_m`: length of the unit of their coordinates, m.
pub(super) fn doubts(things: &[Thing], unit_m: f64) -> Vec<String> {
    let lines = things.iter().filter(|thing| thing.shape == MapShape::Line);
    let long_steps = lines.filter_map(|line| long_step(line, unit_m));
    swapped(things, unit_m).into_iter().chain(long_steps).chain(far(things, unit_m)).collect()
}

fn distance(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn swapped(things: &[Thing], unit_m: f64) -> Option<String> {
    let [east_m, north_m] = things.first()?.at.first()?.map(|value| value * unit_m);
    let is_swapped = SWAPPED_EASTING_M.contains(&east_m) && SWAPPED_NORTHING_M.contains(&north_m);
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
    let first = things.first()?.at.first()?;
    let all = things.iter().flat_map(|thing| &thing.at);
    let farthest_m = all.map(|at| unit_m * distance(first, at)).fold(0.0, f64::max);
    (farthest_m > FAR_M).then(|| {
        format!("the points lie up to {farthest_m:.0} m from the first one: is the unit right, and are all of one place?")
    })
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
}
