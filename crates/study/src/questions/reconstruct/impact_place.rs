//! The place of the impact on the road, from which all places of the evidence count.

use impactlab_core::uncertainty::{Caveat, CaveatSubject};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_reconstruct::evidence::Evidence;

/// Ways to rest on which an error of 1 m in the place of the impact is told, m: on longer ones it moves the speed by less
/// than 2.5 %, and on shorter ones nothing follows from the way.
const SHORT_WAY_M: [f64; 2] = [1.0, 20.0];

/// That the place of the impact counts as exact, where the struck car came to rest so near to it that this matters.
///
/// ```text
/// v = √(2 a d)        dv/v = dd/(2 d)        d: way to rest
/// ```
pub(super) fn impact_place(evidence: &Evidence) -> Option<Caveat> {
    if evidence.is_single_car() {
        return None;
    }
    let [x_m, y_m] = evidence.free_rest()?.place_m()?;
    let way_m = x_m.hypot(y_m);
    let [shortest_m, longest_m] = SHORT_WAY_M;
    let value = Phrase::new(
        "place of the impact on the road: exact",
        "Ort des Anstoßes auf der Fahrbahn: genau",
    );
    let reason = Phrase::new(
        "all places count from it; an error of {0} along the way of {1} to the rest moves the speed after the impact \
         by {2}, which no interval has",
        "alle Orte zählen von dort; ein Fehler von {0} auf dem Weg von {1} bis zur Endlage ändert die Geschwindigkeit \
         nach dem Anstoß um {2}, was in keinem Intervall enthalten ist",
    )
    .with(PhraseValue::given(Quantity::Length, 1.0))
    .with(PhraseValue::fixed(Quantity::Length, way_m, 1))
    .with(PhraseValue::Share(0.5 / way_m));
    let is_short = (shortest_m..longest_m).contains(&way_m);
    is_short.then(|| Caveat::assumed(CaveatSubject::ContactPoint, value, reason))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::examples::spin;
    use impactlab_reconstruct::evidence::{EvidenceKind, RestPose};

    #[test]
    fn a_place_of_the_impact_that_moves_the_speed_is_an_assumption() {
        let mut evidence = spin();
        assert_eq!(impact_place(&evidence), None, "45 m away");
        let (x_m, y_m) = (Some(9.6), Some(-2.8));
        evidence.rest = Some(RestPose { x_m, y_m, ..RestPose::default() });
        let text = impact_place(&evidence).unwrap().to_string();
        assert!(text.contains("place of the impact on the road: exact"), "{text}");
        assert!(text.contains("of 1 m along the way of 10.0 m to the rest"), "{text}");
        assert!(text.contains("by 5.0 %"), "{text}");
        evidence.kind = EvidenceKind::SingleCar;
        assert_eq!(impact_place(&evidence), None);
        evidence.kind = EvidenceKind::Collision;
        evidence.rest = None;
        assert_eq!(impact_place(&evidence), None);
    }
}
