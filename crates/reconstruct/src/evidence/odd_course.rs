//! Marks that lead back to where a collision was, from which cars move away, or away from where a single car came to
//! rest.

use crate::evidence::{Evidence, Mark, Section, mark};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};

/// How much nearer to the origin, the CG of the struck car at first contact, a mark of it may end than it begins, m: a
/// wheel that turns about the CG comes nearer by up to twice its distance from it.
const BACK_M: f64 = 4.0;
/// The same of the striking car, whose wheels begin up to a car's length and a half away and may pass the origin, m.
const STRIKING_BACK_M: f64 = 10.0;

impl Evidence {
    /// The marks that lead back to the impact, or of a single car away from its rest, in words.
    pub fn odd_courses(&self) -> Vec<Phrase> {
        if self.is_single_car() {
            let rest_m = self.rest.and_then(|rest| rest.place_m());
            return rest_m.map_or_else(Vec::new, |rest_m| away_from_rest(&self.marks, rest_m));
        }
        let struck = odd_marks(mark::STRUCK, &self.marks, BACK_M);
        let striking = odd_marks(mark::STRIKING, &self.striking_marks, STRIKING_BACK_M);
        struck.chain(striking).collect()
    }
}

/// Marks of a single car that end farther from its rest than they begin; where it started may follow from them alone.
fn away_from_rest(marks: &[Mark], [rest_x, rest_y]: [f64; 2]) -> Vec<Phrase> {
    let off_m = |[x, y]: [f64; 2]| (x - rest_x).hypot(y - rest_y);
    let told = |(idx, mark): (usize, &Mark)| {
        let away_m = off_m(*mark.points_m.last()?) - off_m(*mark.points_m.first()?);
        let text = Phrase::new(
            "{0} {1} ends {2} farther from the place at rest than it begins, and the car moved towards there: give its \
             points in the order of time",
            "{0} {1} endet {2} weiter von der Endlage entfernt, als sie beginnt, das Fahrzeug bewegte sich aber dorthin: \
             die Punkte in zeitlicher Reihenfolge angeben",
        )
        .with(PhraseValue::Term(mark::STRUCK.title.to_owned()))
        .with(PhraseValue::Name((idx + 1).to_string()))
        .with(PhraseValue::fixed(Quantity::Length, away_m, 1));
        (away_m > BACK_M).then_some(text)
    };
    marks.iter().enumerate().filter_map(told).collect()
}

fn odd_marks(section: Section, marks: &[Mark], most_m: f64) -> impl Iterator<Item = Phrase> {
    marks.iter().enumerate().filter_map(move |(idx, mark)| {
        let ([first_x, first_y], [last_x, last_y]) = (*mark.points_m.first()?, *mark.points_m.last()?);
        let back_m = first_x.hypot(first_y) - last_x.hypot(last_y);
        let text = Phrase::new(
            "{0} {1} ends {2} nearer to the place of the impact than it begins, and cars move away from there: give \
             its points in the order of time; one from before the impact belongs to the skid before it",
            "{0} {1} endet {2} näher am Ort des Anstoßes, als sie beginnt, Fahrzeuge entfernen sich aber von dort: die \
             Punkte in zeitlicher Reihenfolge angeben; eine Spur von vor dem Anstoß gehört zur Bremsspur vor dem \
             Anstoß",
        )
        .with(PhraseValue::Term(section.title.to_owned()))
        .with(PhraseValue::Name((idx + 1).to_string()))
        .with(PhraseValue::fixed(Quantity::Length, back_m, 1));
        (back_m > most_m).then_some(text)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::EvidenceKind;
    use crate::evidence::examples::{SPIN, read};

    /// Told from their ends, and left by braking before the impact.
    #[test]
    fn marks_that_lead_to_the_impact_are_told() {
        let mut evidence = read(SPIN);
        let mark = |points_m: &[[f64; 2]]| Mark { points_m: points_m.to_vec(), ..Mark::default() };
        evidence.marks = vec![
            mark(&[[1.0, -0.7], [20.0, -2.0]]),
            // A rear wheel that swings round the front as the car turns.
            mark(&[[-1.4, -0.8], [0.2, 1.5]]),
            mark(&[[40.0, -5.0], [27.0, -2.5], [5.0, -1.0]]),
            mark(&[[-25.0, 0.7], [-1.5, 0.7]]),
        ];
        evidence.striking_marks = vec![mark(&[[-6.0, -0.8], [3.0, 0.5]])];
        let found: Vec<String> =
            evidence.odd_courses().iter().map(|of| of.say(&Default::default())).collect();
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].starts_with("tire mark 3 ends 35.2 m nearer to the place"), "{found:?}");
        assert!(found[1].starts_with("tire mark 4 ends 23.4 m nearer to the place"), "{found:?}");
        // The axes of a single car are free, and its rest is known.
        evidence.kind = EvidenceKind::SingleCar;
        let found: Vec<String> =
            evidence.odd_courses().iter().map(|of| of.say(&Default::default())).collect();
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            found[0].starts_with("tire mark 3 ends 35.2 m farther from the place"),
            "{found:?}"
        );
        evidence.rest = None;
        assert!(evidence.odd_courses().is_empty());
    }

    #[test]
    fn no_mark_of_the_staged_collisions_leads_back() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../datasets/staged/evidence");
        let mut n_marks = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let evidence = Evidence::load(&entry.unwrap().path()).unwrap();
            n_marks += evidence.marks.len();
            let found = [evidence.odd_courses(), evidence.odd_copies()].concat();
            assert_eq!(found, [], "{}", evidence.case);
        }
        assert!(n_marks > 100, "{n_marks}");
    }
}
