//! How much of the face of the striking vehicle meets the struck side.

use impactlab_core::collision::{ContactLocation, Scenario, Side};
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};

/// Angle between face and struck side up to which they are parallel, rad.
const PARALLEL_RAD: f64 = 1e-6;
/// Angle beyond which it is a corner that meets the side, rad: 30°.
const LARGEST_RAD: f64 = std::f64::consts::FRAC_PI_6;

/// How much of the face of the striking vehicle meets the struck side, of a scenario that says where on
/// that side the vehicles touch. That place is one of a corner where the face is at an angle to the side, and
/// of its middle where they are parallel: from 180° to 175° an oncoming car moves by half of its width.
///
/// `None` where the place is said otherwise, or face and side are parallel or more than 30° apart.
pub(crate) fn covered_part(scenario: &Scenario) -> Option<Caveat> {
    let ContactLocation::Side { side, offset_m } = scenario.contact.location else { return None };
    if scenario.striking.fixed.is_some() {
        return None;
    }
    let geometry = scenario.geometry().ok()?;
    let struck = scenario.struck.footprint();
    let (middle_m, (sin, cos)) = (struck.side_middle_m(side), side.outward_angle_rad().sin_cos());
    let half_m = match side {
        Side::Front | Side::Rear => struck.width_m / 2.0,
        Side::Left | Side::Right => struck.length_m / 2.0,
    };
    // Distance of each corner from the struck side, and its place along it.
    let mut corners = scenario.striking.footprint().corners_m(&geometry.striking).map(|corner| {
        let [x, y] = geometry.struck.body_from_world(corner);
        let [dx, dy] = [x - middle_m[0], y - middle_m[1]];
        [dx * cos + dy * sin, dy * cos - dx * sin]
    });
    corners.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let [[near_m, first_m], [far_m, second_m], ..] = corners;
    let angle_rad = (far_m - near_m).atan2((second_m - first_m).abs());
    if !(PARALLEL_RAD..LARGEST_RAD).contains(&angle_rad) {
        return None;
    }
    let [from_m, to_m] = [first_m.min(second_m), first_m.max(second_m)];
    let meets_m = (to_m.min(half_m) - from_m.max(-half_m)).max(0.0);
    let width_m = (far_m - near_m).hypot(second_m - first_m);
    let text = Phrase::new(
        "{0} from the middle of the struck side is where a corner of the striking vehicle touches: of its \
         face of {1} there, {2} meet that side. Were they parallel, the middle of the face would be at that \
         place",
        "{0} von der Mitte der gestoßenen Seite berührt eine Ecke des stoßenden Fahrzeugs: Von seiner dortigen \
         Front- oder Seitenfläche, {1} breit, treffen {2} diese Seite. Stünden beide parallel, läge dort die \
         Mitte der Fläche",
    )
    .with(PhraseValue::fixed(Quantity::Length, offset_m, 2))
    .with(PhraseValue::fixed(Quantity::Length, width_m, 2))
    .with(PhraseValue::fixed(Quantity::Length, meets_m, 2));
    Some(Caveat::new(CaveatKind::Note, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two cars head-on, the striking one with a heading.
    fn head_on(heading_deg: f64) -> Scenario {
        let mut scenario = Scenario::example();
        scenario.struck.width_m = 1.8;
        scenario.struck.vx_world_m_s = 14.0;
        scenario.struck.heading_rad = 0.0;
        scenario.striking.width_m = 1.85;
        scenario.striking.heading_rad = heading_deg.to_radians();
        scenario.striking.vx_world_m_s = -16.0;
        scenario.striking.vy_world_m_s = 0.0;
        scenario.contact.location = ContactLocation::Side { side: Side::Front, offset_m: 0.4 };
        scenario
    }

    /// A place 0.4 m beside the middle was a quarter of the fronts at 175° and three quarters at 180°, and
    /// nothing said so.
    #[test]
    fn a_corner_that_touches_says_how_much_of_the_face_meets_the_side() {
        let text = |heading_deg| covered_part(&head_on(heading_deg)).map(|caveat| caveat.text);
        let told = text(175.0).unwrap();
        assert!(told.contains("face of 1.85 m there, 0.50 m meet"), "{told}");
        // The other corner touches, and the car lies across the middle.
        let told = text(-175.0).unwrap();
        assert!(told.contains("face of 1.85 m there, 1.30 m meet"), "{told}");
        assert_eq!(text(180.0), None);
        assert_eq!(text(140.0), None);
    }
}
