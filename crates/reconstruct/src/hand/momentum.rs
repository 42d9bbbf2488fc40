//! Momentum of two vehicles: speeds before the impact from those after it.
//!
//! ```text
//! m₁ v₁ + m₂ v₂ = m₁ v₁' + m₂ v₂'
//! in one line       v₁ = (m₁ v₁' + m₂ v₂' − m₂ v₂)/m₁
//! at an angle       v₁ = (P_x sin θ₂ − P_y cos θ₂)/(m₁ sin(θ₂ − θ₁))      P = m₁ v₁' + m₂ v₂'
//!                   v₂ = (P_y cos θ₁ − P_x sin θ₁)/(m₂ sin(θ₂ − θ₁))
//! ```
//!
//! θ: courses before the impact. Forces of the tires during the impact are neglected.
//!
//! Source: [`Brach2011`].

use crate::hand::HandField;
use crate::hand::method::{Formula, HandOutput, accept, violated};
use crate::hand::values::HandValues;
use impactlab_core::bibliography::Brach2011;
use impactlab_core::ranges::{BODY_MASS, HEADING, SPEED};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};

/// Angle between the courses up to which they are one line as they are stated, but for rounding, rad.
const ONE_LINE_RAD: f64 = 1e-6;

/// Least angle between the courses at which momentum gives both speeds, rad: 20°.
pub(super) const LEAST_ANGLE_RAD: f64 = 0.35;

const MASS_1: HandField = HandField::relative("mass_1", "mass of vehicle 1", BODY_MASS, 0.03);
const MASS_2: HandField = HandField::relative("mass_2", "mass of vehicle 2", BODY_MASS, 0.03);
/// The rule for the standard deviation of a speed after the impact: both follow from the drag of one road.
const SPEEDS_AFTER: &str = "speeds after the impact";
const SPEED_AFTER_1: HandField =
    HandField::relative("speed_after_1", "speed of vehicle 1 after the impact", SPEED, 0.1)
        .by_rule(SPEEDS_AFTER);
const SPEED_AFTER_2: HandField =
    HandField::relative("speed_after_2", "speed of vehicle 2 after the impact", SPEED, 0.1)
        .by_rule(SPEEDS_AFTER);
/// Standard deviation of a course where none is stated, rad: 3°.
const COURSE_SIGMA_RAD: f64 = 0.052;

const SPEED_1: HandOutput = HandOutput {
    key: "speed_1_m_s",
    label: "speed of vehicle 1 before the impact",
    quantity: Quantity::Speed,
};
const DELTA_V_1: HandOutput =
    HandOutput { key: "delta_v_1_m_s", label: "Δv of vehicle 1", quantity: Quantity::Speed };
const DELTA_V_2: HandOutput =
    HandOutput { key: "delta_v_2_m_s", label: "Δv of vehicle 2", quantity: Quantity::Speed };
const LOSS: HandOutput = HandOutput {
    key: "energy_loss_j",
    label: "kinetic energy lost in the impact",
    quantity: Quantity::Energy,
};

pub(super) const IN_LINE: Formula = Formula {
    label: "momentum in one line",
    equation: "v1 = (m1 v1' + m2 v2' − m2 v2)/m1",
    holds: [
        "both vehicles move along one line before and after the impact, speeds backwards are negative, \
         and the forces of the tires during the contact are small",
        "Beide Fahrzeuge bewegen sich vor und nach dem Stoß auf einer Linie, Geschwindigkeiten rückwärts \
         sind negativ, und die Reifenkräfte während des Kontakts sind klein",
    ],
    sources: &[Brach2011::TEXT],
    fields: &[
        MASS_1,
        MASS_2,
        SPEED_AFTER_1,
        SPEED_AFTER_2,
        HandField::relative("speed_2", "speed of vehicle 2 before the impact", SPEED, 0.1),
    ],
    outputs: &[
        SPEED_1,
        DELTA_V_1,
        DELTA_V_2,
        LOSS,
        HandOutput {
            key: "restitution",
            label: "restitution that this implies",
            quantity: Quantity::Ratio,
        },
    ],
    solve: solve_in_line,
    refuse: accept,
    warn: warn_in_line,
};

pub(super) const AT_ANGLES: Formula = Formula {
    label: "momentum at an angle",
    equation: "m1 v1 + m2 v2 = m1 v1' + m2 v2' along x and y",
    holds: [
        "courses before and after the impact are known, those before it differ by 20° or more from one \
         line, and the forces of the tires during the contact are small",
        "Die Richtungen vor und nach dem Stoß sind bekannt, die vor dem Stoß weichen um 20° oder mehr von \
         einer Linie ab, und die Reifenkräfte während des Kontakts sind klein",
    ],
    sources: &[Brach2011::TEXT],
    fields: &[
        MASS_1,
        MASS_2,
        SPEED_AFTER_1,
        SPEED_AFTER_2,
        HandField::new("course_1", "course of vehicle 1 before", HEADING, COURSE_SIGMA_RAD).or(0.0),
        HandField::new("course_2", "course of vehicle 2 before", HEADING, COURSE_SIGMA_RAD),
        HandField::new("course_after_1", "course of vehicle 1 after", HEADING, COURSE_SIGMA_RAD),
        HandField::new("course_after_2", "course of vehicle 2 after", HEADING, COURSE_SIGMA_RAD),
    ],
    outputs: &[
        SPEED_1,
        HandOutput {
            key: "speed_2_m_s",
            label: "speed of vehicle 2 before the impact",
            quantity: Quantity::Speed,
        },
        DELTA_V_1,
        DELTA_V_2,
        LOSS,
    ],
    solve: solve_at_angles,
    refuse: refuse_one_line,
    warn: warn_at_angles,
};

/// Speed of a vehicle along a line before the impact.
///
/// - `momentum_n_s`: of both vehicles along the line;
/// - `other_n_s`: of the other one before the impact.
pub(super) fn speed_in_line(momentum_n_s: f64, mass_1_kg: f64, other_n_s: f64) -> f64 {
    (momentum_n_s - other_n_s) / mass_1_kg
}

/// Speeds of both vehicles before the impact.
///
/// - `[x, y]`: momentum of both vehicles, N s;
/// - `course_rad`: their courses before the impact.
pub(super) fn speeds_at_angles(
    [x, y]: [f64; 2],
    mass_kg: [f64; 2],
    course_rad: [f64; 2],
) -> [f64; 2] {
    let [(sin_1, cos_1), (sin_2, cos_2)] = course_rad.map(f64::sin_cos);
    let across = (course_rad[1] - course_rad[0]).sin();
    [
        (x * sin_2 - y * cos_2) / (mass_kg[0] * across),
        (y * cos_1 - x * sin_1) / (mass_kg[1] * across),
    ]
}

fn solve_in_line(values: &HandValues<'_>) -> Vec<f64> {
    let [m1, m2] = ["mass_1", "mass_2"].map(|key| values.number(key));
    let [after_1, after_2] = ["speed_after_1", "speed_after_2"].map(|key| values.number(key));
    let before_2 = values.number("speed_2");
    let before_1 = speed_in_line(m1 * after_1 + m2 * after_2, m1, m2 * before_2);
    let energy = |v1: f64, v2: f64| 0.5 * (m1 * v1 * v1 + m2 * v2 * v2);
    let loss = energy(before_1, before_2) - energy(after_1, after_2);
    let restitution = (after_2 - after_1) / (before_1 - before_2);
    vec![before_1, (after_1 - before_1).abs(), (after_2 - before_2).abs(), loss, restitution]
}

fn solve_at_angles(values: &HandValues<'_>) -> Vec<f64> {
    let mass_kg = ["mass_1", "mass_2"].map(|key| values.number(key));
    let after = ["speed_after_1", "speed_after_2"].map(|key| values.number(key));
    let course = ["course_1", "course_2"].map(|key| values.number(key));
    let course_after = ["course_after_1", "course_after_2"].map(|key| values.number(key));
    let vector = |speed: f64, course: f64| [speed * course.cos(), speed * course.sin()];
    let [u1, u2] = [0, 1].map(|i| vector(after[i], course_after[i]));
    let momentum = [0, 1].map(|axis| mass_kg[0] * u1[axis] + mass_kg[1] * u2[axis]);
    let before = speeds_at_angles(momentum, mass_kg, course);
    let [v1, v2] = [0, 1].map(|i| vector(before[i], course[i]));
    let change = |u: [f64; 2], v: [f64; 2]| (u[0] - v[0]).hypot(u[1] - v[1]);
    let energy = |speed: [f64; 2]| {
        0.5 * (mass_kg[0] * speed[0] * speed[0] + mass_kg[1] * speed[1] * speed[1])
    };
    vec![before[0], before[1], change(u1, v1), change(u2, v2), energy(before) - energy(after)]
}

/// How far the courses before the impact lie off one line, as a sine.
fn sine_between(values: &HandValues<'_>) -> f64 {
    (values.number("course_2") - values.number("course_1")).sin().abs()
}

fn refuse_one_line(values: &HandValues<'_>) -> Option<&'static str> {
    (sine_between(values) < ONE_LINE_RAD).then_some(
        "the courses before the impact lie on one line, along which momentum gives one speed and not both: use \
         momentum-in-line, or check the courses",
    )
}

/// Energy that an impact brings forth.
fn gain(loss_j: f64) -> (bool, Phrase) {
    let phrase = Phrase::new(
        "the impact would gain {0} of kinetic energy: masses, speeds or courses do not go together",
        "Der Stoß gewänne {0} an kinetischer Energie: Massen, Geschwindigkeiten oder Richtungen passen nicht \
         zusammen",
    );
    (loss_j < 0.0, phrase.with(PhraseValue::three_digits(Quantity::Energy, -loss_j)))
}

fn warn_in_line(_: &HandValues<'_>, outputs: &[f64]) -> Vec<Phrase> {
    in_line_warnings(outputs)
}

fn in_line_warnings(outputs: &[f64]) -> Vec<Phrase> {
    let &[_, _, _, loss_j, restitution] = outputs else { return Vec::new() };
    let phrase = Phrase::new(
        "the speeds imply a restitution of {0}, expected 0 to 1: they do not go together",
        "Aus den Geschwindigkeiten folgt eine Stoßziffer von {0}, erwartet 0 bis 1: sie passen nicht zusammen",
    );
    let phrase = phrase.with(PhraseValue::three_digits(Quantity::Ratio, restitution));
    let apart = Phrase::new(
        "both vehicles have one speed before the impact: they do not close in on each other",
        "Beide Fahrzeuge haben vor dem Stoß dieselbe Geschwindigkeit: sie nähern sich einander nicht",
    );
    let told = if restitution.is_finite() { phrase } else { apart };
    violated([gain(loss_j), (!(0.0..=1.0).contains(&restitution), told)])
}

fn warn_at_angles(values: &HandValues<'_>, outputs: &[f64]) -> Vec<Phrase> {
    let &[speed_1, speed_2, _, _, loss_j] = outputs else { return Vec::new() };
    let across = sine_between(values);
    let flat = Phrase::new(
        "the courses before the impact lie only {0} off one line: small errors of courses and masses move both \
         speeds far; the method is not made for that",
        "Die Richtungen vor dem Stoß weichen nur um {0} von einer Linie ab: kleine Fehler von Richtungen und \
         Massen verschieben beide Geschwindigkeiten weit; dafür ist das Verfahren nicht gemacht",
    );
    let angle = PhraseValue::fixed(Quantity::Angle, across.asin(), 0).in_unit("deg");
    let backwards = Phrase::new(
        "a vehicle would have moved against its stated course",
        "Ein Fahrzeug hätte sich gegen seine angegebene Richtung bewegt",
    );
    violated([
        (across < LEAST_ANGLE_RAD.sin(), flat.with(angle)),
        (speed_1 < 0.0 || speed_2 < 0.0, backwards),
        gain(loss_j),
    ])
}

#[cfg(test)]
mod tests {
    use crate::evidence::Stated;
    use crate::hand::HandMethod::{Momentum, MomentumInLine};
    use crate::hand::HandQuestion;
    use crate::hand::calculation::tests::{near, solved};
    use impactlab_core::units::{NumberFormat, UnitSystem};

    /// A car of 1500 kg at 20 m/s and one of 1000 kg at rest that stay together: both leave with 12 m/s.
    #[test]
    fn a_plastic_impact_in_line_comes_back() {
        let outputs = solved(
            MomentumInLine,
            &[
                ("mass_1_kg", 1500.0),
                ("mass_2_kg", 1000.0),
                ("speed_after_1_m_s", 12.0),
                ("speed_after_2_m_s", 12.0),
                ("speed_2_m_s", 0.0),
            ],
        );
        near(&outputs, &[20.0, 8.0, 12.0, 0.5 * 600.0 * 400.0, 0.0]);
    }

    /// Equal masses that give everything back exchange their speeds.
    #[test]
    fn an_elastic_impact_exchanges_the_speeds_of_equal_masses() {
        let outputs = solved(
            MomentumInLine,
            &[
                ("mass_1_kg", 1200.0),
                ("mass_2_kg", 1200.0),
                ("speed_after_1_m_s", 5.0),
                ("speed_after_2_m_s", 20.0),
                ("speed_2_m_s", 5.0),
            ],
        );
        near(&outputs, &[20.0, 15.0, 15.0, 0.0, 1.0]);
    }

    /// Head-on: the heavier one pushes the other back.
    #[test]
    fn speeds_against_each_other_have_signs() {
        let outputs = solved(
            MomentumInLine,
            &[
                ("mass_1_kg", 2000.0),
                ("mass_2_kg", 1000.0),
                ("speed_after_1_m_s", 5.0),
                ("speed_after_2_m_s", 5.0),
                ("speed_2_m_s", -15.0),
            ],
        );
        near(&outputs, &[15.0, 10.0, 20.0, 0.5 * 2000.0 / 3.0 * 900.0, 0.0]);
    }

    /// Standard deviation of each output to first order, and the width of its interval of 90 %.
    ///
    /// - `sigma`: of both speeds after the impact, as shares; `None` for that of the program.
    fn spread(after_m_s: [f64; 2], sigma: Option<f64>) -> Vec<[f64; 2]> {
        let stated = |value: f64, sigma| Stated { value: Some(value), sigma };
        let [after_1, after_2] =
            after_m_s.map(|speed| stated(speed, sigma.map(|share: f64| share * speed.abs())));
        let inputs = [
            ("mass_1_kg", stated(1500.0, Some(0.0))),
            ("mass_2_kg", stated(1200.0, Some(0.0))),
            ("speed_after_1_m_s", after_1),
            ("speed_after_2_m_s", after_2),
            ("speed_2_m_s", stated(-5.0, Some(0.0))),
        ];
        let inputs = inputs.into_iter().map(|(key, stated)| (key.to_owned(), stated)).collect();
        let question = HandQuestion { method: MomentumInLine, inputs: &inputs, points_m: &[] };
        let quantities = question.answer(20_000, 3).unwrap().quantities;
        let told = quantities.iter().map(|of| {
            let [low, high] = of.estimate.interval(0.9).unwrap();
            [of.sigma.unwrap(), high - low]
        });
        told.collect()
    }

    /// v₁ = v₁' + 0.8 (v₂' − v₂): one road has both speeds after the impact too high or too low together, and each
    /// had an error of its own, with an interval that was some 30 % too narrow. Where that makes them cancel, as
    /// in the restitution or of vehicles that part in opposite directions, they stay independent.
    #[test]
    fn speeds_of_one_road_are_off_together_where_that_is_wider() {
        const WIDTH: f64 = 2.0 * 1.644_853_6;
        let own = spread([8.0, 9.0], None);
        let measured = spread([8.0, 9.0], Some(0.1));
        for (found, sigma) in [
            (own[0], 0.8 + 0.8 * 0.9),
            (measured[0], 0.8_f64.hypot(0.8 * 0.9)),
            (spread([-8.0, 9.0], None)[0], 0.8_f64.hypot(0.8 * 0.9)),
            (spread([-8.0, -3.0], None)[0], 0.8 + 0.8 * 0.3),
        ] {
            let [first_order, width] = found;
            assert!((first_order / sigma - 1.0).abs() < 1e-6, "{first_order}, expected {sigma}");
            let expected = WIDTH * sigma;
            assert!((width / expected - 1.0).abs() < 0.03, "{width}, expected {expected}");
        }
        let [own, measured] = [own, measured].map(|of| of[4]);
        assert!((own[0] / measured[0] - 1.0).abs() < 1e-9, "{own:?}, expected {measured:?}");
        assert!((own[1] / measured[1] - 1.0).abs() < 0.03, "{own:?}, expected {measured:?}");
    }

    fn angled(course_deg: [f64; 2], before: [f64; 2], mass_kg: [f64; 2]) -> Vec<f64> {
        let vector = |i: usize| {
            let course = course_deg[i].to_radians();
            [before[i] * course.cos(), before[i] * course.sin()]
        };
        let total = mass_kg[0] + mass_kg[1];
        let [v1, v2] = [vector(0), vector(1)];
        let common = [0, 1].map(|axis| (mass_kg[0] * v1[axis] + mass_kg[1] * v2[axis]) / total);
        let (speed, course) = (common[0].hypot(common[1]), common[1].atan2(common[0]));
        solved(
            Momentum,
            &[
                ("mass_1_kg", mass_kg[0]),
                ("mass_2_kg", mass_kg[1]),
                ("speed_after_1_m_s", speed),
                ("speed_after_2_m_s", speed),
                ("course_1_rad", course_deg[0].to_radians()),
                ("course_2_rad", course_deg[1].to_radians()),
                ("course_after_1_rad", course),
                ("course_after_2_rad", course),
            ],
        )
    }

    /// Vehicles that stay together, of any courses: the speeds come back, and the energy that is lost is that
    /// of the velocity between them.
    #[test]
    fn both_speeds_come_back_for_courses_all_around() {
        for (course_deg, before, mass_kg) in [
            ([0.0, 90.0], [20.0, 10.0], [1500.0, 1500.0]),
            ([30.0, 250.0], [12.0, 27.0], [1100.0, 2300.0]),
            ([-160.0, 60.0], [8.0, 33.0], [1800.0, 900.0]),
        ] {
            let outputs = angled(course_deg, before, mass_kg);
            near(&outputs[..2], &before);
            let angle = (course_deg[1] - course_deg[0]).to_radians();
            let between = before[0] * before[0] + before[1] * before[1]
                - 2.0 * before[0] * before[1] * angle.cos();
            let reduced = mass_kg[0] * mass_kg[1] / (mass_kg[0] + mass_kg[1]);
            near(&outputs[4..], &[0.5 * reduced * between]);
        }
    }

    /// The sine of 180° is not quite 0: both speeds came out at 10¹⁷ km/h.
    #[test]
    fn courses_on_one_line_give_no_two_speeds() {
        let refused = |course_1: f64, course_2: f64| {
            let inputs = [
                ("mass_1_kg", 1500.0),
                ("mass_2_kg", 1200.0),
                ("speed_after_1_m_s", 12.0),
                ("speed_after_2_m_s", 9.0),
                ("course_1_rad", course_1.to_radians()),
                ("course_2_rad", course_2.to_radians()),
                ("course_after_1_rad", 0.4),
                ("course_after_2_rad", 0.7),
            ];
            let stated = |&(key, value): &(&str, f64)| {
                (key.to_owned(), Stated { value: Some(value), sigma: None })
            };
            let inputs = inputs.iter().map(stated).collect();
            let question = HandQuestion { method: Momentum, inputs: &inputs, points_m: &[] };
            question.numbers().err().map(|error| error.to_string())
        };
        for course in [0.0, 180.0, -180.0, 360.0] {
            let error = refused(10.0, 10.0 + course).unwrap();
            assert!(error.contains("use momentum-in-line"), "{course}°: {error}");
        }
        assert_eq!(refused(10.0, 11.0), None);
    }

    /// “A restitution of NaN, expected 0 to 1” was the warning.
    #[test]
    fn vehicles_of_one_speed_have_no_restitution() {
        let told = |restitution| super::in_line_warnings(&[10.0, 0.0, 0.0, 0.0, restitution]);
        assert!(told(0.5).is_empty());
        for restitution in [f64::NAN, f64::INFINITY] {
            let phrases = told(restitution);
            let texts: Vec<String> =
                phrases.iter().map(|it| it.say(&NumberFormat::english(UnitSystem::Si))).collect();
            assert_eq!(texts.len(), 1, "{texts:?}");
            assert!(texts[0].starts_with("both vehicles have one speed"), "{texts:?}");
        }
    }
}
