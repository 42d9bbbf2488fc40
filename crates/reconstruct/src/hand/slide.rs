//! Sliding to rest, or to a known speed: a skid over one or several surfaces, and a spin-out.
//!
//! ```text
//! v² = v_end² + v_other² + Σ_i 2 g d_i (s μ_i + G_i)/√(1 + G_i²)
//! ```
//!
//! d: distance along the surface; μ: drag factor of locked wheels there; s: share of it that brakes the vehicle,
//! 1 with all wheels locked, and the rolling factor of a vehicle that spins with wheels that turn; G: grade,
//! positive uphill. v_other combines the speed of another phase, such as the EES, with that of this one: phases
//! add their energies, not their speeds.
//!
//! Source: [`Brach2011`], drag factors and the critical drag of a spinning car.

use crate::hand::HandField;
use crate::hand::method::{Formula, HandOutput, accept, violated};
use crate::hand::values::HandValues;
use impactlab_core::bibliography::Brach2011;
use impactlab_core::numerics::is_quarter_turn;
use impactlab_core::ranges::{
    EVIDENCE_HEADING, EVIDENCE_SPEED, FRICTION_SHARE, HAND_DISTANCE, HAND_GRADE, ROAD_FRICTION,
};
use impactlab_core::units::{Phrase, PhraseValue, Quantity, STANDARD_GRAVITY_M_S2};

/// Drag of a spinning car whose wheels turn over the friction of the road, mean over a spin.
pub(super) const SPIN_DRAG: f64 = 0.5;
/// Standard deviation of the same.
pub(super) const SPIN_DRAG_SIGMA: f64 = 0.15;

/// Standard deviation of a distance where none is stated, m.
const DISTANCE_SIGMA_M: f64 = 0.5;
/// Standard deviation of a drag factor where none is stated.
const DRAG_SIGMA: f64 = 0.07;
/// Standard deviation of a grade where none is stated.
const GRADE_SIGMA: f64 = 0.01;

/// Standard deviation of the share of the braked wheels where none is stated, over what lacks to all wheels: how the load
/// of the car and of its braking divide between axles is seldom known. A rule of ours.
const BRAKED_SHARE_SIGMA: f64 = 0.25;

/// Keys of distance, friction and grade of each surface.
const SURFACES: [[&str; 3]; 4] = [
    ["distance", "friction", "grade"],
    ["distance_2", "friction_2", "grade_2"],
    ["distance_3", "friction_3", "grade_3"],
    ["distance_4", "friction_4", "grade_4"],
];

/// The rule for the standard deviation of a drag factor, by which those of all surfaces are off together.
const DRAG_FACTORS: &str = "drag factors";

const DISTANCE: HandField =
    HandField::new("distance", "distance of the slide", HAND_DISTANCE, DISTANCE_SIGMA_M);
const FRICTION: HandField =
    HandField::new("friction", "drag factor of locked wheels", ROAD_FRICTION, DRAG_SIGMA)
        .by_rule(DRAG_FACTORS);
const GRADE: HandField = HandField::new("grade", "grade, uphill positive", HAND_GRADE, GRADE_SIGMA);
const END_SPEED: HandField =
    HandField::relative("end_speed", "speed at the end of the slide", EVIDENCE_SPEED, 0.1);

const SPEED: HandOutput = HandOutput {
    key: "speed_m_s",
    label: "speed at the start of the slide",
    quantity: Quantity::Speed,
};
const DECELERATION: HandOutput = HandOutput {
    key: "deceleration_m_s2",
    label: "deceleration on the first surface",
    quantity: Quantity::Acceleration,
};

pub(super) const SPIN_OUT: Formula = Formula {
    label: "spin-out to rest",
    equation: "v = √(v_end² + 2 g d (r μ + G)/√(1 + G²))",
    holds: [
        "the vehicle spins by 90° or more on one surface with wheels that turn; a rolling factor of 0.5 is the \
         mean over spins, and damaged or braked wheels raise it up to 1",
        "Das Fahrzeug dreht sich auf einer Fläche um 90° oder mehr mit rollenden Rädern; ein Rollfaktor von \
         0,5 ist das Mittel über Drehungen, und beschädigte oder gebremste Räder erhöhen ihn bis auf 1",
    ],
    sources: &[Brach2011::TEXT],
    fields: &[
        DISTANCE,
        FRICTION,
        HandField::new("rolling_factor", "rolling factor", FRICTION_SHARE, SPIN_DRAG_SIGMA)
            .or(SPIN_DRAG),
        GRADE.or(0.0),
        END_SPEED.or(0.0),
        HandField::new("turn", "turn until rest", EVIDENCE_HEADING, 0.1).open(),
    ],
    outputs: &[SPEED, DECELERATION],
    solve: |values| slide(values, values.number("rolling_factor")),
    refuse: accept,
    warn: warn_spin,
};

pub(super) const SKID: Formula = Formula {
    label: "skid to stop, and phases together",
    equation: "v = √(v_end² + v_other² + Σ 2 g d (s μ + G)/√(1 + G²))",
    holds: [
        "the marks begin where the wheels lock, all wheels brake as the share says, and μ is that of the tires, \
         the surface and the speed at hand; the speed lost before the marks begin is not in it",
        "Die Spuren beginnen dort, wo die Räder blockieren, alle Räder bremsen mit dem angegebenen Anteil, und μ \
         gilt für diese Reifen, Fläche und Geschwindigkeit; was vor Beginn der Spuren verloren ging, ist nicht \
         enthalten",
    ],
    sources: &[Brach2011::TEXT],
    fields: &[
        DISTANCE,
        FRICTION,
        GRADE.or(0.0),
        HandField::part(
            "braked_share",
            "share of the braked wheels",
            FRICTION_SHARE,
            BRAKED_SHARE_SIGMA,
        )
        .or(1.0),
        END_SPEED.or(0.0),
        HandField::relative(
            "other_speed",
            "speed equivalent of another phase",
            EVIDENCE_SPEED,
            0.1,
        )
        .or(0.0),
        HandField::new("distance_2", "distance on surface 2", HAND_DISTANCE, DISTANCE_SIGMA_M)
            .open(),
        HandField::new("friction_2", "drag factor of surface 2", ROAD_FRICTION, DRAG_SIGMA)
            .open()
            .by_rule(DRAG_FACTORS),
        HandField::new("grade_2", "grade of surface 2", HAND_GRADE, GRADE_SIGMA).open(),
        HandField::new("distance_3", "distance on surface 3", HAND_DISTANCE, DISTANCE_SIGMA_M)
            .open(),
        HandField::new("friction_3", "drag factor of surface 3", ROAD_FRICTION, DRAG_SIGMA)
            .open()
            .by_rule(DRAG_FACTORS),
        HandField::new("grade_3", "grade of surface 3", HAND_GRADE, GRADE_SIGMA).open(),
        HandField::new("distance_4", "distance on surface 4", HAND_DISTANCE, DISTANCE_SIGMA_M)
            .open(),
        HandField::new("friction_4", "drag factor of surface 4", ROAD_FRICTION, DRAG_SIGMA)
            .open()
            .by_rule(DRAG_FACTORS),
        HandField::new("grade_4", "grade of surface 4", HAND_GRADE, GRADE_SIGMA).open(),
    ],
    outputs: &[SPEED, DECELERATION],
    solve: |values| slide(values, values.number("braked_share")),
    refuse: refuse_skid,
    warn: warn_skid,
};

/// Speed from which a slide ends at rest, m/s.
///
/// - `drag`: mean drag factor on the way.
pub(super) fn slide_speed_m_s(drag: f64, distance_m: f64) -> f64 {
    (2.0 * STANDARD_GRAVITY_M_S2 * drag * distance_m).sqrt()
}

/// Deceleration over g on a grade.
fn drag_on_grade(drag: f64, grade: f64) -> f64 {
    (drag + grade) / grade.hypot(1.0)
}

/// Deceleration over g on a surface.
///
/// - `share`: of its drag that brakes the vehicle.
fn drag_on(values: &HandValues<'_>, share: f64, [_, friction, grade]: [&str; 3]) -> f64 {
    drag_on_grade(share * values.number(friction), values.get(grade).unwrap_or(0.0))
}

fn slide(values: &HandValues<'_>, share: f64) -> Vec<f64> {
    let lost = |surface: [&'static str; 3]| {
        let distance_m = values.get(surface[0])?;
        Some(2.0 * STANDARD_GRAVITY_M_S2 * drag_on(values, share, surface) * distance_m)
    };
    let squares: f64 = SURFACES.into_iter().filter_map(lost).sum();
    let other = values.get("other_speed").unwrap_or(0.0);
    let end = values.number("end_speed");
    let speed = (squares + end * end + other * other).sqrt();
    vec![speed, STANDARD_GRAVITY_M_S2 * drag_on(values, share, SURFACES[0])]
}

fn refuse_skid(values: &HandValues<'_>) -> Option<&'static str> {
    let is_half = |[distance, friction, grade]: [&str; 3]| {
        let [distance, friction, grade] = [distance, friction, grade].map(|key| values.get(key));
        distance.is_some() != friction.is_some() || (grade.is_some() && distance.is_none())
    };
    let is_any_half = SURFACES.into_iter().any(is_half);
    is_any_half.then_some("a surface needs both its distance and its drag factor")
}

/// The first surface on which nothing slows down.
fn no_drag(values: &HandValues<'_>, share: f64) -> (bool, Phrase) {
    let is_without = |surface: &[&'static str; 3]| {
        values.get(surface[0]).is_some() && drag_on(values, share, *surface) <= 0.0
    };
    let idx = SURFACES.iter().position(is_without);
    let phrase = Phrase::new(
        "the vehicle would gain speed on surface {0}: the grade is steeper than its drag, and no vehicle comes to rest \
         there",
        "Das Fahrzeug würde auf Fläche {0} schneller: das Gefälle ist größer als die Verzögerung, und kein Fahrzeug \
         kommt dort zum Stillstand",
    );
    (idx.is_some(), phrase.with(PhraseValue::Name((idx.unwrap_or(0) + 1).to_string())))
}

fn warn_spin(values: &HandValues<'_>, _: &[f64]) -> Vec<Phrase> {
    let turn = values.get("turn").map_or(f64::INFINITY, f64::abs);
    let straight = Phrase::new(
        "the vehicle turned by {0} only: the drag of a car that rolls straight on is far less than that of one \
         that spins",
        "Das Fahrzeug drehte sich nur um {0}: ein geradeaus rollendes Fahrzeug verzögert weit weniger als ein \
         schleuderndes",
    );
    let angle = PhraseValue::fixed(Quantity::Angle, turn, 0).in_unit("deg");
    violated([
        (!is_quarter_turn(turn), straight.with(angle)),
        no_drag(values, values.number("rolling_factor")),
    ])
}

fn warn_skid(values: &HandValues<'_>, outputs: &[f64]) -> Vec<Phrase> {
    let fast = Phrase::new(
        "at {0} the friction of locked wheels is below that of a test at town speed: take it from a skid at a \
         similar speed",
        "Bei {0} ist der Reibbeiwert blockierter Räder kleiner als bei einem Versuch mit Stadtgeschwindigkeit: \
         er ist bei ähnlicher Geschwindigkeit zu messen",
    );
    let speed = outputs.first().copied().unwrap_or_default();
    let slippery = Phrase::new(
        "a drag factor above 1 is that of few road tires",
        "Einen Reibbeiwert über 1 haben wenige Straßenreifen",
    );
    violated([
        (speed > 40.0, fast.with(PhraseValue::three_digits(Quantity::Speed, speed))),
        (values.number("friction") > 1.0, slippery),
        no_drag(values, values.number("braked_share")),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::Stated;
    use crate::hand::HandMethod::{Skid, SpinOut};
    use crate::hand::calculation::tests::{near, solved};
    use crate::hand::{HandInputs, HandQuestion};
    use impactlab_core::units::NumberFormat;

    const G: f64 = STANDARD_GRAVITY_M_S2;

    /// 30 m on 0.7: v = √(2 · 9.80665 · 0.7 · 30).
    #[test]
    fn a_level_skid_has_the_root_of_twice_its_work() {
        let outputs = solved(Skid, &[("distance_m", 30.0), ("friction", 0.7)]);
        near(&outputs, &[411.8793_f64.sqrt(), 0.7 * G]);
    }

    /// Two phases add their energies, as 60² + 80² = 100².
    #[test]
    fn phases_add_their_squares() {
        let way = |speed: f64, drag: f64| speed * speed / (2.0 * G * drag);
        let outputs = solved(
            Skid,
            &[
                ("distance_m", way(60.0, 0.8)),
                ("friction", 0.8),
                ("distance_2_m", way(48.0, 0.4)),
                ("friction_2", 0.4),
                ("other_speed_m_s", 64.0),
            ],
        );
        near(&outputs[..1], &[100.0]);
    }

    /// On a slope of 3 in 4 the weight has 0.8 of itself across and 0.6 along: a = g (0.8 μ + 0.6), here not
    /// as steep: 5 in 12, 12/13 and 5/13.
    #[test]
    fn a_grade_counts_with_its_sine_and_its_cosine() {
        for (grade, sign) in [(5.0 / 12.0, 1.0), (-5.0 / 12.0, -1.0)] {
            let inputs = [("distance_m", 13.0), ("friction", 0.75), ("grade", grade)];
            let deceleration = G * (0.75 * 12.0 + sign * 5.0) / 13.0;
            let end = [("end_speed_m_s", 7.0)];
            let inputs: Vec<_> = inputs.into_iter().chain(end).collect();
            near(&solved(Skid, &inputs), &[(49.0 + 26.0 * deceleration).sqrt(), deceleration]);
        }
    }

    /// A spin with a rolling factor of one is a skid, with a quarter it has half of the speed, and from the
    /// begin to a known speed it adds as a phase does.
    #[test]
    fn a_spin_out_is_a_skid_with_part_of_the_drag() {
        let with = |factor: f64, end: f64| {
            solved(
                SpinOut,
                &[
                    ("distance_m", 25.0),
                    ("friction", 0.72),
                    ("rolling_factor", factor),
                    ("end_speed_m_s", end),
                ],
            )[0]
        };
        let skid = solved(Skid, &[("distance_m", 25.0), ("friction", 0.72)])[0];
        near(&[with(1.0, 0.0), with(0.25, 0.0)], &[skid, skid / 2.0]);
        near(&[with(1.0, 10.0)], &[skid.hypot(10.0)]);
    }

    /// A car of which only the front wheels braked counted as known to the last digit, and nothing said so.
    #[test]
    fn a_part_of_the_wheels_has_an_error_and_all_of_them_have_none() {
        let sigma = |share: Option<f64>| {
            let stated = |value: f64| Stated { value: Some(value), sigma: None };
            let mut inputs = HandInputs::new();
            inputs.insert("distance_m".to_owned(), stated(30.0));
            inputs.insert("friction".to_owned(), stated(0.7));
            inputs.extend(share.map(|share| ("braked_share".to_owned(), stated(share))));
            let question = HandQuestion { method: Skid, inputs: &inputs, points_m: &[] };
            let numbers = question.numbers().unwrap();
            numbers.iter().find(|of| of.field.key == "braked_share").unwrap().sigma
        };
        near(&[sigma(None), sigma(Some(1.0)), sigma(Some(0.6))], &[0.0, 0.0, 0.1]);
    }

    /// Only the first of several surfaces was looked at.
    #[test]
    fn a_surface_that_is_steeper_than_its_drag_is_told() {
        let told = |friction_2: f64| -> Vec<String> {
            let inputs = [
                ("distance_m", 30.0),
                ("friction", 0.7),
                ("distance_2_m", 20.0),
                ("friction_2", friction_2),
                ("grade_2", -0.4),
            ];
            let stated = |(key, value): (&str, f64)| {
                (key.to_owned(), Stated { value: Some(value), sigma: Some(0.0) })
            };
            let inputs = inputs.into_iter().map(stated).collect();
            let question = HandQuestion { method: Skid, inputs: &inputs, points_m: &[] };
            let violated = question.answer(100, 0).unwrap().violated;
            violated.iter().map(|phrase| phrase.say(&NumberFormat::default())).collect()
        };
        assert_eq!(told(0.5), Vec::<String>::new());
        let found = told(0.3);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with("the vehicle would gain speed on surface 2: "), "{found:?}");
    }
}
