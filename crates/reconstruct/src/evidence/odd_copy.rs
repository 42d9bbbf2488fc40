//! What was found once and stands in two items, where it would count twice, or for a car that it is not of.

use crate::evidence::{Evidence, Mark, Section, mark};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};

/// Distance between the CGs of two cars at rest below which one would stand within the other, m: side by side half of
/// both widths lie between them, of which crush takes a third at the most.
const WITHIN_M: f64 = 1.2;

/// A mark with its section and its number there, from 0.
type Numbered<'a> = (Section, usize, &'a Mark);

impl Evidence {
    /// The items that hold what belongs to another one, in words.
    pub fn odd_copies(&self) -> Vec<Phrase> {
        let of_both_cars = self.rests_within().into_iter().chain(self.same_records());
        self.same_marks().into_iter().chain(of_both_cars).collect()
    }

    /// Marks with the points of an earlier one, whichever wheels and cars they are said to be of.
    fn same_marks(&self) -> Vec<Phrase> {
        let struck = self.marks.iter().enumerate().map(|(idx, of)| (mark::STRUCK, idx, of));
        let striking = self.striking_marks.iter().enumerate();
        let striking = striking.map(|(idx, of)| (mark::STRIKING, idx, of));
        let all: Vec<Numbered<'_>> = struck.chain(striking).collect();
        let again = |(at, later): (usize, &Numbered<'_>)| {
            let first = all.iter().take(at).find(|first| has_same_points(first.2, later.2))?;
            let text = Phrase::new(
                "{0} and {1} have the same points, and what was measured once would count twice: keep the one whose \
                 wheel left it",
                "{0} und {1} haben dieselben Punkte, was einmal gemessen wurde, zählte doppelt: nur die behalten, \
                 deren Rad sie hinterließ",
            );
            Some(text.with(name(first)).with(name(later)))
        };
        all.iter().enumerate().filter_map(again).collect()
    }

    /// Cars that are both at rest at one place.
    fn rests_within(&self) -> Option<Phrase> {
        let (struck, striking) = (self.rest?, self.striking_rest?);
        let ([x_m, y_m], [other_x_m, other_y_m]) = (struck.place_m()?, striking.place_m()?);
        let apart_m = (x_m - other_x_m).hypot(y_m - other_y_m);
        let sigma_m = struck.position_sigma_m().hypot(striking.position_sigma_m());
        let text = Phrase::new(
            "the CGs of both cars at rest lie {0} apart, and no car stands within another: check which of them was \
             found there",
            "Die Schwerpunkte beider Fahrzeuge liegen in der Endlage {0} auseinander, und kein Fahrzeug steht in einem \
             anderen: prüfen, welches dort gefunden wurde",
        );
        let text = text.with(PhraseValue::fixed(Quantity::Length, apart_m, 2));
        (apart_m + sigma_m < WITHIN_M).then_some(text)
    }

    /// Recorders of both cars with one record, the change of velocity included.
    fn same_records(&self) -> Option<Phrase> {
        let (struck, striking) = (self.edr?, self.striking_edr?);
        let has_delta_v = struck.delta_v_x().is_some() || struck.delta_v_y().is_some();
        let text = Phrase::new(
            "the event data recorders of both cars have the same record: check which car it is of",
            "Die Unfalldatenspeicher beider Fahrzeuge enthalten dieselbe Aufzeichnung: prüfen, von welchem Fahrzeug \
             sie ist",
        );
        (has_delta_v && struck == striking).then_some(text)
    }
}

/// Whether two marks have the same points, from whichever end they are told.
fn has_same_points(a: &Mark, b: &Mark) -> bool {
    a.points_m == b.points_m || a.points_m.iter().eq(b.points_m.iter().rev())
}

/// What a person calls a mark, with its number from 1.
fn name((section, idx, _): &Numbered<'_>) -> PhraseValue {
    let title = PhraseValue::Term(section.title.to_owned());
    let number = PhraseValue::Name((idx + 1).to_string());
    PhraseValue::phrase(Phrase::new("{0} {1}", "{0} {1}").with(title).with(number))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::examples::{SPIN, read};
    use crate::evidence::{Edr, RestPose};
    use impactlab_core::vehicle::Wheel;

    fn said(evidence: &Evidence) -> Vec<String> {
        evidence.odd_copies().iter().map(|of| of.say(&Default::default())).collect()
    }

    /// A mark of other wheels, of the other car or from its other end counted as one more that was found.
    #[test]
    fn a_mark_that_was_measured_once_counts_once() {
        let mut evidence = read(SPIN);
        let mark = |wheel, points_m: &[[f64; 2]]| Mark {
            wheel,
            points_m: points_m.to_vec(),
            ..Mark::default()
        };
        let points_m = [[1.0, 0.0], [9.0, 1.0], [15.0, 3.0]];
        let [from_end, other] = [[points_m[2], points_m[1], points_m[0]], [[1.0, 0.0]; 3]];
        evidence.marks = vec![mark(Wheel::FrontLeft, &points_m), mark(Wheel::RearLeft, &other)];
        assert_eq!(said(&evidence), Vec::<String>::new());
        evidence.marks.push(mark(Wheel::FrontRight, &points_m));
        evidence.striking_marks = vec![mark(Wheel::FrontLeft, &from_end)];
        let found = said(&evidence);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].starts_with("tire mark 1 and tire mark 3 have the same"), "{found:?}");
        let of_other_car = "tire mark 1 and tire mark of the striking car 1 have the same";
        assert!(found[1].starts_with(of_other_car), "{found:?}");
    }

    #[test]
    fn no_car_stands_within_another() {
        let mut evidence = read(SPIN);
        let mut found = |y_m| {
            let (x_m, y_m) = (Some(45.0), Some(y_m));
            evidence.striking_rest = Some(RestPose { x_m, y_m, ..RestPose::default() });
            said(&evidence)
        };
        assert_eq!(found(-6.0).len(), 1);
        assert!(found(-6.3)[0].starts_with("the CGs of both cars at rest lie 0.30 m apart"));
        // Side by side with both flanks crushed.
        assert!(found(-7.3).is_empty(), "{:?}", found(-7.3));
    }

    #[test]
    fn a_record_of_both_cars_is_that_of_one() {
        let mut evidence = read(SPIN);
        let record = Edr { delta_v_x_m_s: Some([Some(-9.0), Some(-8.0)]), ..Edr::default() };
        evidence.edr = Some(record);
        evidence.striking_edr = Some(record);
        assert_eq!(said(&evidence).len(), 1);
        let delta_v_x_m_s = Some([Some(-7.0), Some(-6.0)]);
        evidence.striking_edr = Some(Edr { delta_v_x_m_s, ..record });
        assert!(said(&evidence).is_empty());
        // Two cars may well have had one speed.
        let speed = Edr { delta_v_x_m_s: None, ..evidence.recorder() };
        (evidence.edr, evidence.striking_edr) = (Some(speed), Some(speed));
        assert!(said(&evidence).is_empty());
    }
}
