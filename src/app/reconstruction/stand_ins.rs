//! What stands in a field until the user enters what was found. Nothing is reconstructed from it, and it
//! is not written to a file: a place that nobody measured would be an answer that nobody could trust.

use impactlab_core::collision::Side;
use impactlab_core::vehicle::Wheel;
use impactlab_reconstruct::evidence::{
    After, CarEvidence, DEFAULT_EDR_SPEED_SHARE, DEFAULT_MARK_SIGMA_M, DEFAULT_REST_SIGMA_M,
    DEFAULT_VIDEO_SIGMA_M, Damage, Edr, Evidence, Mark, Measured, PriorRanges, RestPose,
    VideoPosition,
};

/// Place of rest ahead of the first contact, m.
const REST_M: f64 = 30.0;
/// Time and place of a position in a video, s and m.
const POSITION_S_M: [f64; 2] = [1.0, 15.0];
/// Recorded speed, m/s.
const RECORDED_SPEED_M_S: f64 = 15.0;
/// Bounds of a recorded change of velocity, m/s.
pub(in crate::app) const RECORDED_DELTA_V_M_S: [f64; 2] = [-1.0, 1.0];
/// Place of the contact behind the CG with a standard deviation that covers the rear quarter, m: it may
/// stand.
const CONTACT_M: Measured = Measured { value: -1.5, sigma: 0.5 };

/// An empty form: a flank hit behind the CG, and a car at rest that has not been placed.
pub(super) fn empty_evidence() -> Evidence {
    Evidence {
        case: "new reconstruction".to_owned(),
        friction: None,
        struck_car: CarEvidence::default(),
        striking_car: CarEvidence::default(),
        damage: Damage { side: Side::Right, along_m: CONTACT_M, depth_m: None, angle_rad: None },
        shared_scale_sigma: None,
        rest: Some(rest_pose()),
        striking_rest: None,
        after: After::default(),
        marks: Vec::new(),
        edr: Edr::default(),
        positions: Vec::new(),
        prior: PriorRanges::default(),
    }
}

/// A car at rest that has not been placed.
pub(in crate::app) fn rest_pose() -> RestPose {
    let position_sigma_m = DEFAULT_REST_SIGMA_M;
    RestPose { x_m: REST_M, y_m: 0.0, position_sigma_m, heading_rad: None }
}

/// A mark without points.
pub(in crate::app) fn mark() -> Mark {
    let (wheel, sigma_m) = (Wheel::RearRight, DEFAULT_MARK_SIGMA_M);
    Mark { wheel, kind: None, points_m: Vec::new(), sigma_m }
}

/// A recorded speed that has not been entered.
pub(in crate::app) fn recorded_speed() -> Measured {
    let value = RECORDED_SPEED_M_S;
    Measured { value, sigma: DEFAULT_EDR_SPEED_SHARE * value }
}

/// A position in a video that has not been entered.
pub(in crate::app) fn video_position() -> VideoPosition {
    let [time_s, x_m] = POSITION_S_M;
    VideoPosition { time_s, x_m, y_m: 0.0, sigma_m: DEFAULT_VIDEO_SIGMA_M }
}

/// What evidence lacks that nothing can stand in for; `None` if it can be run.
pub(in crate::app) fn missing(evidence: &Evidence) -> Option<String> {
    for (name, rest) in [("struck", &evidence.rest), ("striking", &evidence.striking_rest)] {
        let stood_in = rest_pose();
        if rest.is_some_and(|rest| (rest.x_m, rest.y_m) == (stood_in.x_m, stood_in.y_m)) {
            return Some(format!(
                "the {name} car at rest has not been placed: drag its dot in the scene or type X and Y; \
                 remove the card if its place is not known"
            ));
        }
    }
    if let Some(mark) = evidence.marks.iter().find(|mark| mark.points_m.len() < 2) {
        return Some(format!(
            "the mark of the {} wheel needs at least two points: Add points, then click along it in \
             the scene",
            mark.wheel.label()
        ));
    }
    let Edr { speed_before_m_s, delta_v_x_m_s, delta_v_y_m_s, .. } = &evidence.edr;
    if speed_before_m_s.is_some_and(|speed| speed.value == RECORDED_SPEED_M_S) {
        let why = "the recorded speed has not been entered: type it, or remove its tick";
        return Some(why.to_owned());
    }
    let delta_v = [("ahead", delta_v_x_m_s), ("to the left", delta_v_y_m_s)];
    if let Some((where_to, _)) = delta_v.iter().find(|(_, of)| **of == Some(RECORDED_DELTA_V_M_S)) {
        return Some(format!(
            "the recorded change of velocity {where_to} has not been entered: type its bounds, or \
             remove its tick"
        ));
    }
    let stood_in = evidence.positions.iter().position(|at| *at == video_position());
    stood_in.map(|idx| {
        format!("position {} in a video has not been entered: type its time and place", idx + 1)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_run_from_what_a_form_put_in() {
        let mut evidence = empty_evidence();
        let mut lacks = |change: fn(&mut Evidence)| {
            change(&mut evidence);
            missing(&evidence).unwrap_or_default()
        };
        assert!(lacks(|_| {}).contains("struck car at rest has not been placed"));
        let place = |of: &mut Evidence| {
            of.rest.iter_mut().chain(&mut of.striking_rest).for_each(|rest| rest.y_m = -4.0);
        };
        assert_eq!(lacks(place), "");
        assert!(lacks(|of| of.striking_rest = Some(rest_pose())).contains("striking car at rest"));
        assert_eq!(lacks(place), "");
        assert!(lacks(|of| of.marks.push(mark())).contains("at least two points"));
        assert_eq!(lacks(|of| of.marks[0].points_m = vec![[1.0, 0.0], [9.0, 1.0]]), "");
        let record = |of: &mut Evidence| of.edr.speed_before_m_s = Some(recorded_speed());
        assert!(lacks(record).contains("recorded speed"));
        let bounds = |of: &mut Evidence| {
            of.edr = Edr { delta_v_y_m_s: Some(RECORDED_DELTA_V_M_S), ..Edr::default() };
        };
        assert!(lacks(bounds).contains("change of velocity to the left"));
        assert_eq!(lacks(|of| of.edr.delta_v_y_m_s = Some([-1.0, 1.5])), "");
        assert!(lacks(|of| of.positions.push(video_position())).contains("position 1"));
        assert_eq!(lacks(|of| of.positions[0].y_m = 0.5), "");
    }
}
