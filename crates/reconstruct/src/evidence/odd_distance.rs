//! Marks that lie farther from each other than the wheels that left them.

use crate::evidence::{Evidence, Mark, Section, mark};
use crate::{Car, Cars};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};

/// Distance of two marks over that of their wheels beyond which one of them is in another unit or of another wheel:
/// wheels keep their distance however the car turns, and paths beside each other are as near or nearer. The marks of
/// the staged cases reach 1.06; feet that are read as metres have up to 3.3.
const MOST: f64 = 1.2;
/// Standard deviations of both marks that come on top.
const REACH: f64 = 3.0;
/// Points of a mark that have to lie beside the other one.
const LEAST_POINTS: usize = 2;

impl Evidence {
    /// The two marks of each car that lie the farthest beyond the distance of their wheels, in words.
    ///
    /// - `cars`: where their wheels are.
    pub fn odd_distances(&self, cars: &Cars) -> Vec<Phrase> {
        let struck = farthest(mark::STRUCK, &self.marks, &cars.struck);
        let striking = farthest(mark::STRIKING, &self.striking_marks, &cars.striking);
        struck.into_iter().chain(striking).collect()
    }
}

/// Two marks, by their numbers from 0.
struct Apart {
    marks: [usize; 2],
    apart_m: f64,
    wheels_m: f64,
    /// Their distance over the largest one that wheels and errors explain.
    excess: f64,
}

fn farthest(section: Section, marks: &[Mark], car: &Car) -> Option<Phrase> {
    let numbers = 0..marks.len();
    let pairs = numbers.clone().flat_map(|a| numbers.clone().map(move |b| [a, b]));
    let apart = pairs.filter_map(|pair| apart(pair, marks, car));
    let worst = apart.max_by(|a, b| a.excess.total_cmp(&b.excess))?;
    let [first, second] = worst.marks.map(|idx| PhraseValue::Name((idx + 1).to_string()));
    let text = Phrase::new(
        "{0} {1} lies at least {2} beside number {3}, and their wheels are {4} apart: check the unit of the points, and \
         which wheel of which car left them",
        "{0} {1} liegt mindestens {2} neben Nummer {3}, die Räder sind aber {4} voneinander entfernt: prüfen, in welcher \
         Einheit die Punkte sind und welches Rad welches Fahrzeugs sie hinterließ",
    )
    .with(PhraseValue::Term(section.title.to_owned()))
    .with(first)
    .with(PhraseValue::fixed(Quantity::Length, worst.apart_m, 1))
    .with(second)
    .with(PhraseValue::fixed(Quantity::Length, worst.wheels_m, 1));
    (worst.excess > 1.0).then_some(text)
}

/// How far the first of two marks of different wheels lies beside the second one; `None` where it does not.
fn apart(pair: [usize; 2], marks: &[Mark], car: &Car) -> Option<Apart> {
    let [Some(first), Some(second)] = pair.map(|idx| marks.get(idx)) else { return None };
    if first.wheel == second.wheel {
        return None;
    }
    let beside = first.points_m.iter().filter_map(|point| beside_m(*point, &second.points_m));
    let beside: Vec<f64> = beside.collect();
    let apart_m = beside.iter().copied().min_by(f64::total_cmp)?;
    let places = [first, second].map(|of| car.parameters.geometry.wheel_place_m(of.wheel));
    let [[ax_m, ay_m], [bx_m, by_m]] = places;
    let wheels_m = (ax_m - bx_m).hypot(ay_m - by_m);
    let errors_m = REACH * first.sigma_m().hypot(second.sigma_m());
    let excess = apart_m / (MOST * wheels_m + errors_m);
    let apart = Apart { marks: pair, apart_m, wheels_m, excess };
    (beside.len() >= LEAST_POINTS).then_some(apart)
}

/// Distance of a point from a line, m; `None` where it lies before its start or beyond its end.
fn beside_m([x, y]: [f64; 2], line: &[[f64; 2]]) -> Option<f64> {
    let last = line.len().checked_sub(2)?;
    let to_piece = |(idx, pair): (usize, &[[f64; 2]])| {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        let [dx, dy] = [bx - ax, by - ay];
        let squared = dx * dx + dy * dy;
        let along = ((x - ax) * dx + (y - ay) * dy) / squared;
        let share = along.clamp(0.0, 1.0);
        let is_off = (idx == 0 && along < 0.0) || (idx == last && along > 1.0);
        let distance_m = (x - ax - share * dx).hypot(y - ay - share * dy);
        (squared > 0.0).then_some((distance_m, is_off))
    };
    let pieces = line.windows(2).enumerate().filter_map(to_piece);
    let (distance_m, is_off) = pieces.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (!is_off).then_some(distance_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::examples::{SPIN, read};
    use impactlab_core::vehicle::Wheel;

    const FEET: f64 = 3.28;

    /// The same evidence from a sketch in feet.
    fn in_feet(evidence: &Evidence) -> Evidence {
        let mut evidence = evidence.clone();
        for mark in &mut evidence.marks {
            mark.points_m.iter_mut().flatten().for_each(|coordinate| *coordinate *= FEET);
        }
        evidence
    }

    #[test]
    fn marks_farther_apart_than_their_wheels_are_told() {
        let mut evidence = read(SPIN);
        let cars = Cars::new(&evidence, None, None);
        let half_m = cars.struck.parameters.geometry.track_width_m / 2.0;
        let mark = |wheel, y: f64, [from, to]: [f64; 2]| {
            let points_m = vec![[from, y], [0.5 * (from + to), y], [to, y]];
            Mark { wheel, points_m, ..Mark::default() }
        };
        evidence.marks = vec![
            mark(Wheel::FrontLeft, half_m, [2.0, 20.0]),
            mark(Wheel::FrontRight, -half_m, [3.0, 21.0]),
            // One that begins where the others have ended.
            mark(Wheel::RearRight, -9.0, [30.0, 40.0]),
        ];
        assert_eq!(evidence.odd_distances(&cars), []);
        let found = in_feet(&evidence).odd_distances(&cars);
        let texts: Vec<String> = found.iter().map(|of| of.say(&Default::default())).collect();
        assert_eq!(texts.len(), 1, "{texts:?}");
        assert!(texts[0].contains(" beside number "), "{texts:?}");
        // A mark of another car that passed beside.
        evidence.marks[1] = mark(Wheel::FrontRight, -5.0, [3.0, 21.0]);
        assert_eq!(evidence.odd_distances(&cars).len(), 1);
        // Of one wheel there may be several.
        evidence.marks[1].wheel = Wheel::FrontLeft;
        assert_eq!(evidence.odd_distances(&cars), []);
    }

    #[test]
    fn marks_of_the_staged_collisions_are_told_in_feet_alone() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../datasets/staged/evidence");
        let mut n_in_feet = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let evidence = Evidence::load(&entry.unwrap().path()).unwrap();
            let cars = Cars::new(&evidence, None, None);
            assert_eq!(evidence.odd_distances(&cars), [], "{}", evidence.case);
            n_in_feet += in_feet(&evidence).odd_distances(&cars).len();
        }
        assert!(n_in_feet >= 20, "{n_in_feet} of 40");
    }
}
