//! How numbers are written, in both languages and systems of units.

use super::*;

const EN: NumberFormat = NumberFormat { units: UnitSystem::Si, language: Language::En };
const DE_US: NumberFormat = NumberFormat { units: UnitSystem::Us, language: Language::De };

#[test]
fn numbers_are_shown_with_four_digits() {
    for (value, expected) in [
        (123_456.7, "123457"),
        (12.3456, "12.35"),
        (-0.012_345_6, "-0.01235"),
        (0.0, "0"),
        (-1e-9, "0"),
    ] {
        assert_eq!(significant(value), expected);
    }
    assert_eq!(EN.value(Quantity::Force, 12_345.0), "12.35 kN");
    assert_eq!(DE_US.value(Quantity::Speed, -2.7e-6), "0 mph");
    assert_eq!(EN.vector(Quantity::Length, [3.0, 4.0], ["x", "y"]), "5.000 m (x 3.000, y 4.000)");
    let german = NumberFormat { units: UnitSystem::Si, language: Language::De };
    assert_eq!(
        german.vector(Quantity::Length, [3.0, 4.0], ["x", "y"]),
        "5,000 m (x 3,000; y 4,000)"
    );
}

#[test]
fn an_interval_decides_the_digits() {
    let shown = |median, ninety: [f64; 2]| {
        EN.estimate_in_words(Quantity::Length, &Estimate::new(median, ninety, ninety))
    };
    assert_eq!(shown(30.741, [26.52, 57.24]), "31 (26 to 58) m");
    assert_eq!(shown(-0.004, [-0.31, 0.27]), "0.00 (-0.31 to 0.27) m");
    assert_eq!(shown(0.5, [0.3, 0.1 + 0.6]), "0.50 (0.30 to 0.70) m");
    assert_eq!(shown(52.22, [51.55, 52.86]), "52.2 (51.5 to 52.9) m");
    assert_eq!(shown(2.0, [2.0, 2.0]), "2.000 m");
    // What does not move was told as “0.000000 (0.000000 to 0.000000) m”.
    assert_eq!(shown(8e-17, [-6e-14, 2e-14]), "0 m");
    assert_eq!(shown(2.0, [1.0, f64::INFINITY]), "2 (1 to inf) m");
    // A force that is known to some half of itself was “25583 (14837 to 41287) lbf”.
    let us = NumberFormat::english(UnitSystem::Us);
    let force = Estimate::new(113_800.0, [90e3, 140e3], [66e3, 183.65e3]);
    assert_eq!(us.estimate_in_words(Quantity::Force, &force), "26000 (14000 to 42000) lbf");
    let text = us.estimate(Quantity::Force, &force);
    assert_eq!((&*text.median, &*text.intervals[0].range), ("26000 lbf", "20000 to 32000 lbf"));
    assert_eq!(us.measured(Quantity::Force, 113_800.0, 12_000.0), "25600 ± 2700 lbf");
    let narrow = Estimate::new(3843.0, [3000.0, 4000.0], [2958.0, 5400.0]);
    assert_eq!(us.estimate_in_words(Quantity::Impulse, &narrow), "864 (664 to 1214) lbf s");
    let nested = Estimate::new(32.209, [30.11, 34.52], [26.789, 37.193]);
    let text = EN.estimate(Quantity::Length, &nested);
    let ranges: Vec<&str> = text.intervals.iter().map(|interval| interval.range.as_str()).collect();
    assert_eq!((&*text.median, &*ranges), ("32 m", &["30 to 35 m", "26 to 38 m"][..]));
    assert_eq!(EN.measured(Quantity::Speed, 12.34, 0.876), "44.4 ± 3.2 km/h");
}

/// “28.30 km/h” was the mean of a forecast whose places were known to some metres.
#[test]
fn what_is_drawn_and_has_no_interval_has_two_digits() {
    let rough = |value| EN.rough(Quantity::Length, value);
    assert_eq!(
        [28.3, -0.098_63, 13_602.0, 9.96, 0.0, -1e-9].map(rough),
        ["28 m", "-0.099 m", "13602 m", "10 m", "0 m", "0 m"]
    );
    // A place 43 m off was told, and one that stood still was said to turn.
    assert_eq!([99.6, -1243.2].map(rough), ["100 m", "-1243 m"]);
    assert_eq!(EN.rough(Quantity::Angle, 187.4_f64.to_radians()), "187 deg");
    // A car that had been steered left and right was said to head 0.077 deg to the left.
    let heading = |deg: f64| EN.rough(Quantity::Angle, deg.to_radians());
    assert_eq!([0.077, -0.04, -0.66].map(heading), ["0.1 deg", "0 deg", "-0.7 deg"]);
    assert_eq!(EN.rough(Quantity::Force, 123_400.0), "120 kN");
    assert_eq!(EN.rough(Quantity::AngularVelocity, -5.6e-7), "0 deg/s");
    assert_eq!(
        EN.rough_vector(Quantity::Impulse, [1124.0, 2810.0], ["x", "y"]),
        "3.0 kN s (x 1.1, y 2.8)"
    );
    // The components of a place had two digits each, beside its distance in full.
    assert_eq!(
        EN.rough_vector(Quantity::Length, [163.4, -7.43], ["x", "y"]),
        "164 m (x 163, y -7.4)"
    );
    let estimate = Estimate::new(30.741, [26.52, 57.24], [26.52, 57.24]);
    let drawn = |of: &Estimate| EN.drawn_in_words(Quantity::Length, of);
    assert_eq!(drawn(&estimate), "31 (26 to 58) m");
    assert_eq!(drawn(&estimate.without_intervals()), "31 m");
}

#[test]
fn german_has_its_decimal_sign_and_degrees() {
    assert_eq!(DE_US.value(Quantity::Speed, 44.704), "100,0 mph");
    assert_eq!(DE_US.value(Quantity::Angle, 0.5), "28,65°");
    assert_eq!(DE_US.local("2.5 kN. v1.x 3.0"), "2,5 kN. v1.x 3,0");
    let turn = Estimate::new(0.5, [0.4, 0.6], [0.3, 0.7]);
    assert_eq!(DE_US.estimate(Quantity::Angle, &turn).intervals[1].range, "17° bis 41°");
    assert_eq!(DE_US.estimate_in_words(Quantity::Angle, &turn), "29° (17° bis 41°)");
}

#[test]
fn what_was_given_keeps_its_digits() {
    assert_eq!(EN.given(Quantity::Mass, 1999.4567), "1999.4567 kg");
    assert_eq!(EN.given(Quantity::Length, -1.234567), "-1.234567 m");
    assert_eq!(EN.given(Quantity::Speed, 15.0), "54 km/h");
    // A distance of 30 m was 98.425197 ft.
    assert_eq!(DE_US.given(Quantity::Length, 30.0), "98,43 ft");
    assert_eq!(DE_US.given(Quantity::Length, 30.48), "100 ft");
    assert_eq!(EN.given_number(0.1 + 0.2), "0.3");
    assert_eq!(EN.given_number(0.0), "0");
    assert_eq!([-0.02, -0.06, 0.0].map(|value| EN.fixed(value, 1)), ["0.0", "-0.1", "0.0"]);
    assert_eq!(EN.rounded(Quantity::Mass, 1999.4567), "1999 kg");
}

#[test]
fn a_share_has_one_decimal_and_no_negative_zero() {
    assert_eq!([0.1234, 1.0, -1e-17, -0.0].map(percent), ["12.3 %", "100.0 %", "0.0 %", "0.0 %"]);
    assert_eq!(percent(-0.05), "-5.0 %");
    assert_eq!(EN.chance(1.0, Some(0.000_2)), "100.0 % ± 0.1 %");
    assert_eq!(EN.chance(0.999_7, None), "> 99.9 %");
    assert_eq!(DE_US.chance(0.0, None), "< 0,1 %");
    assert_eq!(DE_US.chance(0.123, Some(0.0401)), "12,3 % ± 4,1 %");
}
