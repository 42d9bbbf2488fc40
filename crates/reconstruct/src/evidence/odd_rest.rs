//! Rest poses at which no locked wheel stands where its mark ends.

use crate::evidence::{Evidence, Mark, MarkKind, RestPose, Section, rest};
use crate::{Car, Cars};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};

/// How far from its wheel a mark may end that leads to the rest, m: from a bumper to the CG, or across a car that is
/// turned around.
const NEAR_M: f64 = 4.0;
/// How far it ends by errors alone, m: of 66 marks of locked wheels of the staged cases 64 end within 0.7 m, and the others
/// beyond 4 m.
const BY_ERRORS_M: f64 = 1.0;
/// Standard deviations of the pose and of the mark that count as errors where they are larger.
const REACH: f64 = 3.0;
/// Marks that have to say so.
const LEAST_MARKS: usize = 2;

impl Evidence {
    /// The rest poses that the marks of locked wheels contradict, in words.
    ///
    /// - `cars`: where their wheels are.
    pub fn odd_rests(&self, cars: &Cars) -> Vec<Phrase> {
        let section = if self.is_single_car() { rest::SINGLE } else { rest::STRUCK };
        let own = self.rest.and_then(|at| odd_rest((section, at), &self.marks, &cars.struck));
        let striking = self.striking_rest.map(|at| (rest::STRIKING, at));
        let striking = striking.and_then(|at| odd_rest(at, &self.striking_marks, &cars.striking));
        own.into_iter().chain(striking).collect()
    }
}

impl Evidence {
    /// Cars that a further obstacle stopped, in words: their rest says nothing of their speeds.
    pub(crate) fn stopped_rests(&self) -> Vec<Phrase> {
        let own = if self.is_single_car() { rest::SINGLE } else { rest::STRUCK };
        let both = [(own, self.rest), (rest::STRIKING, self.striking_rest)];
        let stopped = both.into_iter().filter(|(_, at)| at.is_some_and(|at| !at.is_free()));
        let text = Phrase::new(
            "{0}: a further obstacle stopped it, so that its speed does not follow from there and the rest is left out; \
             what the obstacle took is in no speed, and marks and positions count as those of a car that moves freely: \
             leave out those from after it",
            "{0}: Ein weiteres Hindernis hielt es auf. Aus dieser Endlage folgt keine Geschwindigkeit, sie bleibt außer \
             Betracht. Was das Hindernis aufnahm, ist in keiner Geschwindigkeit enthalten, und Spuren und Orte gelten \
             als die eines frei bewegten Fahrzeugs: jene von danach weglassen",
        );
        let named = |(section, _): (Section, _)| {
            text.clone().with(PhraseValue::Term(section.title.to_owned()))
        };
        stopped.map(named).collect()
    }
}

fn odd_rest((section, at): (Section, RestPose), marks: &[Mark], car: &Car) -> Option<Phrase> {
    let locked = marks.iter().filter(|mark| mark.kind == Some(MarkKind::Locked));
    let ends: Vec<[f64; 2]> = locked.filter_map(|mark| end_off_wheel_m(mark, &at, car)).collect();
    let near = || ends.iter().filter(|[off_m, _]| *off_m < NEAR_M);
    let n_near = near().count();
    if n_near < LEAST_MARKS || near().any(|[off_m, by_errors_m]| off_m < by_errors_m) {
        return None;
    }
    let nearest_m = near().map(|[off_m, _]| *off_m).fold(f64::INFINITY, f64::min);
    let text = Phrase::new(
        "{0}: {1} marks of locked wheels end near it, and none where its wheel stands, the nearest {2} beside: check \
         that the position is that of the CG and not of a bumper or a wheel, that the heading counts from X to the \
         left, and that the car was not moved",
        "{0}: {1} Spuren blockierter Räder enden in der Nähe, keine dort, wo ihr Rad steht, die nächste {2} daneben: \
         prüfen, ob die Position die des Schwerpunkts und nicht die eines Stoßfängers oder Rads ist, ob der Winkel von \
         X nach links zählt und ob das Fahrzeug nicht bewegt wurde",
    );
    let text = text.with(PhraseValue::Term(section.title.to_owned()));
    let text = text.with(PhraseValue::Name(n_near.to_string()));
    Some(text.with(PhraseValue::fixed(Quantity::Length, nearest_m, 1)))
}

/// How far a mark ends from where its wheel is at rest, and how far it may end from there by errors, m.
fn end_off_wheel_m(mark: &Mark, at: &RestPose, car: &Car) -> Option<[f64; 2]> {
    let [end_x_m, end_y_m] = *mark.points_m.last()?;
    let ([x_m, y_m], heading) = (at.place_m()?, at.heading()?);
    let [along_m, across_m] = car.parameters.geometry.wheel_place_m(mark.wheel);
    let (sin, cos) = heading.value.sin_cos();
    let wheel_x_m = x_m + along_m * cos - across_m * sin;
    let wheel_y_m = y_m + along_m * sin + across_m * cos;
    let by_heading_m = along_m.hypot(across_m) * heading.sigma;
    let sigma_m = at.position_sigma_m().hypot(mark.sigma_m()).hypot(by_heading_m);
    let off_m = (end_x_m - wheel_x_m).hypot(end_y_m - wheel_y_m);
    Some([off_m, BY_ERRORS_M.max(REACH * sigma_m)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::Stated;
    use crate::evidence::examples::{SPIN, read};
    use impactlab_core::vehicle::Wheel;
    use std::f64::consts::PI;

    /// A spun car at rest, whose locked wheels left marks up to there and one before.
    fn spun() -> (Evidence, Cars) {
        let mut evidence = read(SPIN);
        let cars = Cars::new(&evidence, None, None);
        let (sin, cos) = (-2.9_f64).sin_cos();
        let mark = |wheel, short_m: f64| {
            let [along, across] = cars.struck.parameters.geometry.wheel_place_m(wheel);
            let x = 45.0 + along * cos - across * sin - short_m;
            let end = [x, -6.0 + along * sin + across * cos];
            let kind = Some(MarkKind::Locked);
            Mark { wheel, kind, points_m: vec![[5.0, -1.0], end], sigma_m: None }
        };
        evidence.marks = vec![
            mark(Wheel::FrontLeft, 0.2),
            mark(Wheel::RearLeft, 0.1),
            mark(Wheel::RearRight, 9.0),
        ];
        (evidence, cars)
    }

    /// A rest position at the front bumper, and headings that count otherwise, moved the speed and were explained.
    #[test]
    fn a_pose_at_which_no_wheel_stands_at_its_mark_is_told() {
        let (evidence, cars) = spun();
        assert_eq!(evidence.odd_rests(&cars), []);
        let told = |x_m: f64, y_m: f64, heading_rad: f64, sigma_m: Option<f64>| {
            let mut evidence = evidence.clone();
            evidence.rest = Some(RestPose {
                x_m: Some(x_m),
                y_m: Some(y_m),
                position_sigma_m: sigma_m,
                heading_rad: Some(Stated { value: Some(heading_rad), sigma: None }),
                ..RestPose::default()
            });
            let found = evidence.odd_rests(&cars);
            found.iter().map(|of| of.say(&Default::default())).collect::<Vec<_>>()
        };
        let [bumper_x, bumper_y] = [45.0 + 2.2 * (-2.9_f64).cos(), -6.0 + 2.2 * (-2.9_f64).sin()];
        let found = told(bumper_x, bumper_y, -2.9, None);
        assert_eq!(found.len(), 1, "{found:?}");
        let begin = "struck car at rest: 2 marks of locked wheels end near it, and none where";
        assert!(found[0].starts_with(begin), "{found:?}");
        assert_eq!(told(45.0, -6.0, -2.9 + PI, None).len(), 1);
        // From a compass: clockwise from Y.
        assert_eq!(told(45.0, -6.0, PI / 2.0 + 2.9, None).len(), 1);
        // Within the errors of a pace.
        assert!(told(bumper_x, bumper_y, -2.9, Some(0.9)).is_empty());
        assert!(told(45.3, -6.2, -2.85, None).is_empty());
    }

    /// A car that a pole stopped after 12 m was as slow as one that slid no farther.
    #[test]
    fn a_rest_that_an_obstacle_made_is_left_out_and_told() {
        use crate::evaluate::KnownEvidence;
        use crate::evidence::StoppedBy;
        use crate::{Discrepancy, ForwardModel, HandCalculation, ReconstructionTarget};
        let free = read(SPIN);
        assert_eq!(free.stopped_rests(), []);
        let mut stopped = free.clone();
        stopped.rest.as_mut().unwrap().stopped_by = Some(StoppedBy::Obstacle);
        let again = read(&stopped.to_toml());
        assert_eq!(again, stopped);
        let told: Vec<String> =
            stopped.stopped_rests().iter().map(|text| text.say(&Default::default())).collect();
        let begin = "struck car at rest: a further obstacle stopped it";
        assert!(told.len() == 1 && told[0].starts_with(begin), "{told:?}");
        let has_rest = |evidence: &Evidence| {
            let cars = Cars::new(evidence, None, None);
            let by_hand = HandCalculation::new(evidence, &cars, &[]).is_some();
            let is_known = KnownEvidence::like(evidence, &cars).is_some();
            let model = ForwardModel::new(evidence, cars);
            let z = vec![vec![0.0; model.prior().components().len()]];
            let target =
                ReconstructionTarget::new(evidence.clone(), model.clone(), Discrepancy::default());
            let names: Vec<String> = model
                .motions(&z, |motion| target.terms(&motion))
                .concat()
                .into_iter()
                .map(|term| term.name)
                .collect();
            assert!(!names.is_empty());
            [by_hand, is_known, names.iter().any(|name| name == "rest x")]
        };
        assert_eq!(has_rest(&free), [true; 3]);
        assert_eq!(has_rest(&stopped), [false; 3]);
        stopped.striking_rest = stopped.rest;
        assert!(!stopped.follows_striking_car() && stopped.stopped_rests().len() == 2);
    }

    #[test]
    fn no_pose_of_the_staged_collisions_is_told() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../datasets/staged/evidence");
        let mut n_moved = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let mut evidence = Evidence::load(&entry.unwrap().path()).unwrap();
            let cars = Cars::new(&evidence, None, None);
            assert_eq!(evidence.odd_rests(&cars), [], "{}", evidence.case);
            if let Some(RestPose { x_m: Some(x_m), .. }) = &mut evidence.rest {
                *x_m += 2.2;
                n_moved += evidence.odd_rests(&cars).len();
            }
        }
        // Those with two marks that lead up to the rest.
        assert!(n_moved >= 15, "{n_moved}");
    }
}
