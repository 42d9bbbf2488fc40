//! Whether the cars met as those of the collisions on which the intervals were tried.

use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_reconstruct::evidence::Evidence;
use impactlab_reconstruct::{QuantityEstimate, ReconstructedQuantity};

/// Angle between the headings of 38 of the 40 collisions of `datasets/staged`, degrees; 5.1 and 34.9 were the others.
const TRIED_ANGLE_DEG: [f64; 2] = [5.9, 34.1];

/// By how much the striking car was faster in them, −0.4 to 3.5 m/s, and 2 m/s more to either side, by which the medians
/// of a reconstruction may be off.
const TRIED_DIFFERENCE_M_S: [f64; 2] = [-2.4, 5.5];

/// That the cars met otherwise than those of every collision that was tried, as in a sideswipe: by the angle that is
/// stated, or else by what was reconstructed.
pub(super) fn untried_course(
    evidence: &Evidence,
    quantities: &[QuantityEstimate],
) -> Option<Caveat> {
    let median = |of: ReconstructedQuantity| {
        let found = quantities.iter().find(|quantity| quantity.name == of.key());
        found.map(|quantity| quantity.estimate.median)
    };
    let stated = evidence.damage.angle().map(|angle| angle.value);
    let angle = stated.or_else(|| median(ReconstructedQuantity::HeadingDifference));
    let angle = angle.map(|angle| {
        let size = angle.sin().atan2(angle.cos()).abs();
        (
            Quantity::Angle,
            "relative heading of the cars",
            size,
            TRIED_ANGLE_DEG.map(f64::to_radians),
        )
    });
    let striking = median(ReconstructedQuantity::StrikingSpeed);
    let speeds = striking.zip(median(ReconstructedQuantity::StruckSpeed));
    let difference = speeds.map(|(striking, struck)| {
        (Quantity::Speed, "striking car faster by", striking - struck, TRIED_DIFFERENCE_M_S)
    });
    let (quantity, name, value, [low, high]) = [angle, difference]
        .into_iter()
        .flatten()
        .find(|(_, _, value, [low, high])| !(*low..=*high).contains(value))?;
    let number = |value| match quantity {
        Quantity::Angle => PhraseValue::fixed(quantity, value, 1).in_unit("deg"),
        _ => PhraseValue::fixed(quantity, value, 1),
    };
    let text = Phrase::new(
        "{0}: {1}; how often intervals hold was tried at {2} to {3} alone, and here it is not known",
        "{0}: {1}. Wie oft die Intervalle zutreffen, ist nur bei {2} bis {3} geprüft und hier nicht bekannt",
    )
    .with(PhraseValue::Term(name.to_owned()))
    .with(number(value))
    .with(number(low).bare())
    .with(number(high));
    Some(Caveat::new(CaveatKind::OutsideDomain, text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::examples::spin;
    use impactlab_core::units::Estimate;
    use impactlab_reconstruct::evidence::Stated;

    /// Beside a sideswipe stood how often intervals of cars that were pushed at 6 to 34° had held.
    #[test]
    fn a_sideswipe_is_like_none_of_the_collisions_that_were_tried() {
        let said = |stated_deg: Option<f64>, heading_deg: f64, speeds_m_s: [f64; 2]| {
            let mut evidence = spin();
            let value = stated_deg.map(f64::to_radians);
            evidence.damage.angle_rad = value.map(|_| Stated { value, sigma: None });
            let of = |of: ReconstructedQuantity, median| QuantityEstimate {
                name: of.key(),
                unit: of.unit(),
                estimate: Estimate { median, intervals: Vec::new() },
            };
            let quantities = [
                of(ReconstructedQuantity::StruckSpeed, speeds_m_s[0]),
                of(ReconstructedQuantity::StrikingSpeed, speeds_m_s[1]),
                of(ReconstructedQuantity::HeadingDifference, heading_deg.to_radians()),
            ];
            untried_course(&evidence, &quantities).map(|caveat| caveat.text)
        };
        let by_angle = said(Some(5.0), 9.0, [20.0, 21.0]).unwrap();
        let begin = "relative heading of the cars: 5.0 deg; how often intervals";
        assert!(by_angle.starts_with(begin) && by_angle.contains(" 5.9 to 34.1 deg"), "{by_angle}");
        assert!(said(None, -3.0, [20.0, 21.0]).is_some());
        assert!(said(None, 175.0, [20.0, 21.0]).is_some());
        let by_speed = said(None, 9.0, [20.0, 32.0]).unwrap();
        assert!(by_speed.starts_with("striking car faster by: 12.0 m/s; "), "{by_speed}");
        for heading_deg in [9.0, -20.0, 33.0] {
            assert_eq!(said(None, heading_deg, [20.0, 21.0]), None, "{heading_deg}");
        }
    }
}
