//! Tests of the calculation by hand, and what the tests of its methods share.

use super::*;

fn stated(value: f64, sigma: f64) -> Stated {
    Stated { value: Some(value), sigma: Some(sigma) }
}

fn exact(inputs: &[(&'static str, f64)]) -> HandInputs {
    inputs.iter().map(|(key, value)| ((*key).to_owned(), stated(*value, 0.0))).collect()
}

/// The outputs of a method at exact inputs.
pub fn solved(method: HandMethod, inputs: &[(&'static str, f64)]) -> Vec<f64> {
    solved_with(method, inputs, &[])
}

/// The same with points of a mark.
pub fn solved_with(
    method: HandMethod,
    inputs: &[(&'static str, f64)],
    points_m: &[[f64; 2]],
) -> Vec<f64> {
    let inputs = exact(inputs);
    let question = HandQuestion { method, inputs: &inputs, points_m };
    let table = question.table(&question.numbers().unwrap());
    (method.formula().solve)(&question.values(&table, points_m))
}

/// Whether numbers agree but for rounding.
pub fn near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?}, expected {expected:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-9 * b.abs().max(1.0), "{found:?}, expected {expected:?}");
    }
}

fn skid(distance: Stated, friction: Stated) -> HandInputs {
    BTreeMap::from([
        ("distance_m".to_owned(), distance),
        ("friction".to_owned(), friction),
        ("grade".to_owned(), stated(0.0, 0.0)),
        ("end_speed_m_s".to_owned(), stated(0.0, 0.0)),
        ("other_speed_m_s".to_owned(), stated(0.0, 0.0)),
    ])
}

fn answer(inputs: &HandInputs) -> HandAnswer {
    let question = HandQuestion { method: HandMethod::Skid, inputs, points_m: &[] };
    question.answer(20_000, 7).unwrap()
}

/// v goes with the root of the distance: half of its relative error, and the draws agree.
#[test]
fn first_order_and_draws_agree_where_errors_are_small() {
    let inputs = skid(stated(30.0, 0.6), stated(0.7, 0.014));
    let answer = answer(&inputs);
    let speed = &answer.quantities[0];
    let expected = speed.value * 0.01 * 2_f64.sqrt();
    assert!((speed.sigma.unwrap() / expected - 1.0).abs() < 1e-3, "{speed:?}");
    let [low, high] = speed.estimate.interval(0.9).unwrap();
    let half = 1.644_853_6 * expected;
    assert!(((high - low) / 2.0 / half - 1.0).abs() < 0.03, "{low} to {high}, expected ± {half}");
    let of = |key: &str| answer.sensitivities.iter().find(|of| of.input == key).unwrap();
    let change = of("distance_m").changes[0].unwrap();
    assert!((change / (0.01 * speed.value) - 1.0).abs() < 1e-3, "{change}");
    assert_eq!((answer.n_unsolved, answer.avoided_share), (0, None));
}

#[test]
fn the_same_seed_draws_the_same_and_exact_inputs_have_no_interval() {
    let inputs = skid(stated(30.0, 0.6), stated(0.7, 0.05));
    assert_eq!(answer(&inputs), answer(&inputs));
    let exact = answer(&skid(stated(30.0, 0.0), stated(0.7, 0.0)));
    assert!(exact.quantities[0].estimate.intervals.is_empty());
    assert_eq!(exact.quantities[0].sigma, Some(0.0));
}

/// With all wheels braked, the end of its range, 1 % less of them and their standard deviation moved a result by
/// half of what they do.
#[test]
fn an_input_at_the_end_of_its_range_moves_a_result_by_its_whole_step() {
    for (share, sigma) in [(1.0, 0.0), (1.0, 0.15), (0.6, 0.15)] {
        let mut inputs = skid(stated(30.0, 0.0), stated(0.7, 0.0));
        inputs.insert("braked_share".to_owned(), stated(share, sigma));
        let answer = answer(&inputs);
        let of = answer.sensitivities.iter().find(|of| of.input == "braked_share").unwrap();
        let step = if sigma > 0.0 { sigma } else { 0.01 };
        let per_step = 0.7 * 9.806_65 * step;
        let change = of.changes[1].unwrap();
        assert!((change / per_step - 1.0).abs() < 1e-9, "{share} ± {sigma}: {change}");
        let found = answer.quantities[1].sigma.unwrap();
        let expected = 0.7 * 9.806_65 * sigma;
        assert!((found - expected).abs() < 1e-9, "{share} ± {sigma}: {found}");
    }
}

/// Friction of 0.05 ± 0.2 is cut off at the least friction that a road has.
#[test]
fn no_draw_leaves_the_range_of_its_input() {
    let answer = answer(&skid(stated(30.0, 0.0), stated(0.05, 0.2)));
    let least = (2.0 * 9.806_65 * 0.01 * 30.0_f64).sqrt();
    assert!(answer.quantities[0].estimate.interval(0.95).unwrap()[0] >= least);
}

/// A sixth of the draws would land above the line of take-off, where the speed has no bound: an interval of the
/// others would be too narrow.
#[test]
fn draws_without_an_answer_are_not_left_out_in_silence() {
    let drop = |sigma: f64| {
        let inputs = BTreeMap::from([
            ("distance_m".to_owned(), stated(10.0, 0.0)),
            ("drop_m".to_owned(), stated(0.1, sigma)),
            ("angle_rad".to_owned(), stated(0.0, 0.0)),
        ]);
        let method = HandMethod::Airborne;
        HandQuestion { method, inputs: &inputs, points_m: &[] }.answer(5000, 3)
    };
    assert!(matches!(drop(0.1), Err(HandError::Unsolved { .. })), "{:?}", drop(0.1));
    let n_unsolved = drop(0.05).unwrap().n_unsolved;
    assert!((50..250).contains(&n_unsolved), "{n_unsolved} of 5000, expected 2.3 %");
}

/// A normal braking distance about the distance that there is: half of the draws stop in time.
#[test]
fn chances_to_stop_are_those_of_the_draws() {
    let inputs = BTreeMap::from([
        ("speed_m_s".to_owned(), stated(20.0, 0.0)),
        ("reaction_s".to_owned(), stated(1.0, 0.2)),
        ("deceleration_m_s2".to_owned(), stated(8.0, 0.0)),
        ("distance_m".to_owned(), stated(45.0, 0.0)),
    ]);
    let method = HandMethod::TimeDistance;
    let question = HandQuestion { method, inputs: &inputs, points_m: &[] };
    let share = question.answer(20_000, 1).unwrap().avoided_share.unwrap();
    assert!((share - 0.5).abs() < 0.02, "{share}");
}

#[test]
fn inputs_that_are_wrong_are_named() {
    let ask = |method: HandMethod, inputs: &[(&'static str, f64)]| {
        let inputs = exact(inputs);
        let question = HandQuestion { method, inputs: &inputs, points_m: &[] };
        question.answer(1000, 0).unwrap_err().to_string()
    };
    for (method, inputs, part) in [
        (HandMethod::Skid, &[("speed_m_s", 3.0)][..], "\"speed_m_s\" is no input"),
        (HandMethod::Skid, &[("distance_m", 3.0)][..], "drag factor of locked wheels (friction)"),
        (HandMethod::Skid, &[("distance_m", 3.0), ("friction", 9.0)][..], "friction"),
        (
            HandMethod::Skid,
            &[("distance_m", 3.0), ("friction", 0.7), ("distance_2_m", 5.0)][..],
            "both its distance and its drag factor",
        ),
        (HandMethod::YawMark, &[("friction", 0.7)][..], "the radius is open"),
        (
            HandMethod::YawMark,
            &[("friction", 0.7), ("chord_m", 20.0), ("radius_m", 50.0)][..],
            "only one of them",
        ),
        (HandMethod::Airborne, &[("distance_m", 20.0), ("drop_m", -1.0)][..], "lands on or above"),
    ] {
        let error = ask(method, inputs);
        assert!(error.contains(part), "{part}: {error}");
    }
}

/// Half of a skid on the same surface had a drag factor of its own, and the interval was a quarter narrower.
#[test]
fn a_skid_told_as_two_surfaces_has_the_interval_of_one() {
    let asked = |inputs: &[(&str, Stated)]| {
        let inputs = inputs.iter().map(|(key, stated)| ((*key).to_owned(), *stated)).collect();
        let question = HandQuestion { method: HandMethod::Skid, inputs: &inputs, points_m: &[] };
        let answer = question.answer(20_000, 7).unwrap();
        let speed = &answer.quantities[0];
        let [low, high] = speed.estimate.interval(0.9).unwrap();
        [speed.value, high - low, speed.sigma.unwrap()]
    };
    let by_rule = Stated { value: Some(0.7), sigma: None };
    let usual = [
        ("grade", stated(0.0, 0.0)),
        ("end_speed_m_s", stated(0.0, 0.0)),
        ("other_speed_m_s", stated(0.0, 0.0)),
    ];
    let with = |more: &[(&'static str, Stated)]| asked(&[&usual[..], more].concat());
    let one = with(&[("distance_m", stated(30.0, 0.0)), ("friction", by_rule)]);
    let halves = |friction: Stated| {
        with(&[
            ("distance_m", stated(15.0, 0.0)),
            ("friction", friction),
            ("distance_2_m", stated(15.0, 0.0)),
            ("friction_2", friction),
            ("grade_2", stated(0.0, 0.0)),
        ])
    };
    let [value, width, sigma] = halves(by_rule);
    assert!((value / one[0] - 1.0).abs() < 1e-12, "{value}");
    assert!((width / one[1] - 1.0).abs() < 1e-9, "{width}, expected {}", one[1]);
    assert!((sigma / one[2] - 1.0).abs() < 1e-3, "{sigma}, expected {}", one[2]);
    // Two that were measured are independent.
    let [_, measured, _] = halves(stated(0.7, 0.07));
    assert!((measured / one[1] - 0.5_f64.sqrt()).abs() < 0.03, "{measured} of {}", one[1]);
}

/// Restitution and effective masses were read beside one vehicle and changed nothing, as did the error of the
/// points of a mark without points and a standard deviation without its value.
#[test]
fn an_input_without_the_other_that_gives_it_a_meaning_is_refused() {
    let ask = |method: HandMethod, inputs: &HandInputs| {
        let question = HandQuestion { method, inputs, points_m: &[] };
        question.numbers().map(|numbers| numbers.len())
    };
    let crush = exact(&[
        ("mass_1_kg", 1500.0),
        ("stiffness_a_n_per_m", 5e4),
        ("stiffness_b_n_per_m2", 6e5),
        ("width_m", 1.5),
        ("c1_m", 0.4),
        ("c2_m", 0.3),
    ]);
    let yaw = exact(&[("friction", 0.7), ("radius_m", 50.0)]);
    let lone_sigma = Stated { value: None, sigma: Some(3.0) };
    for (method, inputs, key, number, part) in [
        (HandMethod::CrushEnergy, &crush, "restitution", stated(0.3, 0.0), "without mass_2_kg"),
        (HandMethod::CrushEnergy, &crush, "gamma_1", stated(0.8, 0.0), "without mass_2_kg"),
        (HandMethod::CrushEnergy, &crush, "gamma_2", stated(0.8, 0.0), "without mass_2_kg"),
        (HandMethod::CrushEnergy, &crush, "mass_2_kg", lone_sigma, "needs mass of vehicle 2"),
        (HandMethod::YawMark, &yaw, "point_error_m", stated(0.1, 0.0), "without points_m"),
    ] {
        let n_alone = ask(method, inputs).unwrap();
        let field = method.fields().iter().find(|field| field.si_key() == key).unwrap();
        let mut more = inputs.clone();
        more.insert(key.to_owned(), Stated::default());
        assert_eq!(ask(method, &more), Ok(n_alone), "{key}: a field that is left empty");
        more.insert(key.to_owned(), number);
        let error = ask(method, &more).unwrap_err().to_string();
        assert!(error.contains(part) && error.contains(&field.si_key()), "{key}: {error}");
    }
    let mut both = crush;
    both.extend(exact(&[("mass_2_kg", 1200.0), ("energy_2_j", 5e4), ("restitution", 0.3)]));
    assert!(ask(HandMethod::CrushEnergy, &both).is_ok());
}

/// What is asked and what is printed have each a key of their own, and a default that is possible.
#[test]
fn every_method_is_described() {
    for method in HandMethod::ALL {
        let mut keys: Vec<String> = method.fields().iter().map(HandField::si_key).collect();
        keys.sort();
        let n = keys.len();
        keys.dedup();
        assert_eq!(keys.len(), n, "{method:?}");
        for field in method.fields() {
            if let HandDefault::Value(value) = field.default {
                assert!(field.range.contains(value), "{method:?} {}", field.key);
            }
        }
        assert!(!method.outputs().is_empty() && !method.sources().is_empty(), "{method:?}");
    }
}
