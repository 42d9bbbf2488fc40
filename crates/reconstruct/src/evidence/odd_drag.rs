//! Drag factors of a skid or of locked wheels that are above the friction that is stated of the road. Each is taken as
//! stated, so that neither the fit nor the intervals of an answer tell that they contradict each other.

use crate::evidence::{Evidence, Measured, Section, SkidBefore, road, skid};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};

/// Drag over the peak friction of a road from which the two contradict each other: tires differ by a tenth or so, and
/// locked wheels drag with less than the peak.
const MOST: f64 = 1.2;

impl Evidence {
    /// The drag factors that the stated friction of the road does not allow, in words.
    pub(super) fn odd_drags(&self) -> Vec<Phrase> {
        let Some(friction) = self.road_friction() else { return Vec::new() };
        let of_skid = |skid: &Option<SkidBefore>| skid.as_ref().and_then(SkidBefore::drag_factor);
        let drags = [
            (road::SECTION, self.drag_factor()),
            (skid::STRUCK, of_skid(&self.skid_before)),
            (skid::STRIKING, of_skid(&self.striking_skid_before)),
        ];
        let ratio = |of: Measured| PhraseValue::fixed(Quantity::Ratio, of.value, 2);
        let odd = |(section, drag): (Section, Option<Measured>)| {
            let drag = drag.filter(|drag| drag.value > MOST * friction.value)?;
            let text = Phrase::new(
                "{0}: the drag factor is {1} and the friction of the road {2}, and no car slows down by more than \
                 the road holds: one of them is wrong, or of other ground",
                "{0}: Der Verzögerungsfaktor beträgt {1}, der Reibbeiwert der Fahrbahn {2}. Kein Fahrzeug verzögert \
                 mehr, als die Fahrbahn hält: Einer von beiden ist falsch oder gilt für anderen Untergrund",
            );
            let text = text.with(PhraseValue::Term(section.title.to_owned()));
            Some(text.with(ratio(drag)).with(ratio(friction)))
        };
        drags.into_iter().filter_map(odd).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::examples::{SPIN, read};
    use crate::evidence::{Road, Stated};

    #[test]
    fn a_drag_factor_above_the_friction_of_the_road_is_said() {
        let mut evidence = read(SPIN);
        assert!(evidence.odd_drags().is_empty(), "{:?}", evidence.odd_drags());
        let stated = |value| Some(Stated { value: Some(value), sigma: None });
        evidence.friction = Some(Road { value: Some(0.4), ..Road::default() });
        for (drag, n_said) in [(0.8, 1), (0.45, 0), (0.3, 0)] {
            let skid = SkidBefore { drag_factor: stated(drag), ..SkidBefore::default() };
            evidence.striking_skid_before = Some(skid);
            assert_eq!(evidence.odd_drags().len(), n_said, "{drag}");
        }
        evidence.friction = Some(Road { drag_factor: stated(0.9), ..evidence.friction.unwrap() });
        let said = evidence.odd_drags()[0].say(&Default::default());
        assert!(said.starts_with("friction of the road: the drag factor is 0.90 and"), "{said}");
        // Without a friction of the road there is nothing to compare with.
        evidence.friction = Some(Road { drag_factor: stated(0.9), ..Road::default() });
        assert!(evidence.odd_drags().is_empty());
    }
}
