use super::*;
use crate::evidence::examples::{SPIN, read};
use crate::evidence::{Bounds, Stated};
use crate::{Cars, EvidenceTerm, ForwardModel, Latent, ReconstructionTarget};
use impactlab_core::vehicle::{TireMark, Wheel};

/// The spin, of which the left front wheel of the striking car was found blocked.
fn blocked() -> Evidence {
    let mut evidence = read(SPIN);
    evidence.striking_after.blocked_wheels = Some(vec![Wheel::FrontLeft]);
    evidence
}

fn mark(points_m: Vec<[f64; 2]>) -> Mark {
    Mark { wheel: Wheel::FrontLeft, kind: None, points_m, sigma_m: None }
}

fn target(evidence: &Evidence) -> ReconstructionTarget {
    let model = ForwardModel::new(evidence, Cars::new(evidence, None, None));
    ReconstructionTarget::new(evidence.clone(), model, Discrepancy::default())
}

/// The medians, but for the speed difference, which is by so many standard deviations off.
fn particle(target: &ReconstructionTarget, faster: f64) -> Vec<f64> {
    let is_difference = |latent| [Latent::SpeedDifference, Latent::StrikingSpeed].contains(&latent);
    let components = target.model().prior().components().iter();
    components.map(|it| if is_difference(it.latent) { faster } else { 0.0 }).collect()
}

fn motion(target: &ReconstructionTarget, z: Vec<f64>) -> CollisionMotion {
    target.model().motions(&[z], |motion| motion).pop().expect("one motion")
}

/// Some points of the longest mark of the blocked wheel.
fn longest(marks: &[TireMark]) -> Vec<[f64; 2]> {
    let of_wheel = marks.iter().filter(|mark| mark.wheel == Wheel::FrontLeft);
    let longest = of_wheel.max_by(|a, b| a.length_m().total_cmp(&b.length_m())).expect("a mark");
    let every = longest.points.len() / 5;
    longest.points.iter().step_by(every.max(1)).map(|point| point.place_m).collect()
}

/// Each item that the striking car of a motion leaves, by itself.
fn left_behind(own: &CollisionMotion) -> [(&'static str, Evidence); 3] {
    let striking = own.striking.as_ref().expect("it is followed");
    let last = striking.path.points.last().expect("a path");
    let heading_rad = Some(Stated { value: Some(last.yaw_rad), sigma: None });
    let rest =
        RestPose { x_m: Some(last.x_m), y_m: Some(last.y_m), heading_rad, ..RestPose::default() };
    let track = Track::from_path(&striking.path).expect("a path");
    let [x, y] =
        track.recorded_delta_v_m_s([0.0; 2], own.values.get(Latent::PulseDuration)).unwrap();
    let about = |value: f64| -> Option<Bounds> { Some([Some(value - 0.05), Some(value + 0.05)]) };
    let edr = Edr {
        speed_before_m_s: Some(Stated {
            value: Some(own.impact.unwrap().striking_speed_m_s),
            sigma: None,
        }),
        delta_v_x_m_s: about(x),
        delta_v_y_m_s: about(y),
        ..Edr::default()
    };
    let marks = vec![mark(longest(&striking.tire_marks()))];
    [
        ("rest", Evidence { striking_rest: Some(rest), ..blocked() }),
        ("mark", Evidence { striking_marks: marks, ..blocked() }),
        ("EDR", Evidence { striking_edr: Some(edr), ..blocked() }),
    ]
}

/// What the striking car of a motion leaves is likelier in this motion than in one in which it is faster,
/// and is told as that of the striking car.
#[test]
fn evidence_of_the_striking_car_tells_how_fast_it_was() {
    let followed = Evidence { striking_rest: Some(RestPose::default()), ..blocked() };
    let prior = target(&followed);
    let own = motion(&prior, particle(&prior, 0.0));
    for (item, evidence) in left_behind(&own) {
        assert!(evidence.follows_striking_car(), "{item}");
        let target = target(&evidence);
        let of_struck =
            ReconstructionTarget::new(blocked(), target.model().clone(), Discrepancy::default());
        let gain = |faster: f64| {
            let motion = motion(&target, particle(&target, faster));
            target.log_likelihood(&motion) - of_struck.log_likelihood(&motion)
        };
        let (at_truth, faster) = (gain(0.0), gain(2.0));
        assert!(at_truth.is_finite() && at_truth > faster + 1.0, "{item}: {at_truth} {faster}");
        let terms = target.terms(&motion(&target, particle(&target, 0.0)));
        let own_terms: Vec<&EvidenceTerm> = terms
            .iter()
            .filter(|term| term.name.starts_with(&format!("striking car {item}")))
            .collect();
        assert!(!own_terms.is_empty(), "{item}: {terms:?}");
        assert!(own_terms.iter().all(|term| term.distance < 4.0), "{item}: {own_terms:?}");
    }
}

/// The errors of rest and marks of one car go together, those of both cars do not.
#[test]
fn each_car_has_errors_of_the_path_of_its_own() {
    let followed = Evidence { striking_rest: Some(RestPose::default()), ..blocked() };
    let prior = target(&followed);
    let own = motion(&prior, particle(&prior, 0.0));
    let [(_, rest), (_, marks), _] = left_behind(&own);
    let both = Evidence { striking_marks: marks.striking_marks.clone(), ..rest.clone() };
    let value = |evidence: &Evidence| target(evidence).log_likelihood(&own);
    let nothing =
        ReconstructionTarget::new(blocked(), prior.model().clone(), Discrepancy::default())
            .log_likelihood(&own);
    let apart = value(&rest) + value(&marks) - nothing;
    assert!((value(&both) - apart).abs() > 0.1, "{} {apart}", value(&both));
    // What is found of the struck car says the same beside either.
    let mut moved = blocked();
    moved.rest.as_mut().unwrap().y_m = Some(0.0);
    let with_rest = Evidence { striking_rest: rest.striking_rest, ..moved.clone() };
    let of_struck = value(&moved) - nothing;
    let beside = value(&with_rest) - value(&rest);
    assert!((of_struck - beside).abs() < 1e-9, "{of_struck} {beside}");
}

#[test]
fn what_the_recorders_say_and_marks_are_left_out_for_both_cars() {
    let mut evidence = blocked();
    evidence.striking_marks = vec![mark(vec![[0.0, 0.0], [9.0, 0.0]])];
    let stated = Some(Stated { value: Some(20.0), sigma: None });
    evidence.striking_edr = Some(Edr { speed_before_m_s: stated, ..Edr::default() });
    assert_eq!(evidence.without_edr().striking_edr, None);
    assert_eq!(evidence.without_edr().striking_marks, evidence.striking_marks);
    let rest = evidence.rest_only();
    assert!(rest.striking_edr.is_none() && rest.striking_marks.is_empty(), "{rest:?}");
    assert!(!rest.follows_striking_car());
}

#[test]
fn the_places_of_the_striking_car_are_told_apart() {
    let mut evidence = blocked();
    evidence.marks = vec![mark(vec![[1.0, 0.0], [9.0, 0.0]])];
    evidence.striking_marks = vec![mark(vec![[2.0, 3.0], [8.0, 3.0]])];
    let places = evidence.places();
    let marks = places.iter().filter(|place| place.is_line);
    let told: Vec<_> =
        marks.map(|place| (place.name.as_str(), place.is_of_striking_car())).collect();
    let expected =
        [("tire mark, front left", false), ("tire mark of the striking car, front left", true)];
    assert_eq!(told, expected);
}
