//! Tests of the face law.

use proptest::prelude::*;
use pulp::{Simd, WithSimd};

use super::*;
use crate::numerics::{MAX_LANES, Packed};

fn law(onset: f64, stiffness: f64, elastic_depth_m: f64, saturation_depth_m: f64) -> FaceLaw {
    FaceLaw::new(FaceParameters {
        onset_n_per_m: onset,
        stiffness_n_per_m2: stiffness,
        elastic_depth_m,
        saturation_depth_m,
        recovery: Recovery::default(),
    })
    .unwrap()
}

/// Laws with and without elastic branch and saturation.
fn laws() -> impl Strategy<Value = FaceLaw> {
    let depths = (prop_oneof![Just(0.0), 0.02..0.08], prop_oneof![Just(f64::INFINITY), 0.1..0.8]);
    (1e3..6e4, 1e5..1.2e6, depths)
        .prop_map(|(a, b, (elastic_m, end_m))| law(a, b, elastic_m, end_m))
}

fn depths() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), 0.0..0.1, 0.0..1.0]
}

#[test]
fn the_virgin_curve_has_its_three_branches() {
    let law = law(40e3, 6e5, 0.05, 0.5);
    for (deflection_m, expected) in
        [(0.0, 0.0), (0.025, 20e3), (0.05, 40e3), (0.25, 160e3), (0.5, 310e3), (0.9, 310e3)]
    {
        let got = law.virgin_load_n_per_m(deflection_m);
        assert!((got - expected).abs() < 1e-6, "{deflection_m} m: {got}, expected {expected}");
        let by_strip = law.after(0.0).load_n_per_m(deflection_m);
        assert!((by_strip - expected).abs() < 1e-6, "{deflection_m} m: {by_strip}");
    }
}

#[test]
fn recovery_is_that_of_edsmac_once_the_face_is_crushed() {
    let law = law(40e3, 6e5, 0.05, 2.0);
    assert_eq!(law.recovery_share(0.02), ELASTIC_RECOVERY);
    for inches in [5.0, 10.0, 20.0, 30.0, 52.5, 60.0_f64] {
        let depth = inches.min(52.5);
        let printed = 0.04606 - 0.001_754_7 * depth + 0.000_016_711 * depth * depth;
        let got = law.recovery_share(inches * 0.0254);
        assert!((got - printed).abs() < 3e-6, "{inches} in: {got}, printed {printed}");
    }
    let shares: Vec<f64> = (0..100).map(|i| law.recovery_share(f64::from(i) * 0.002)).collect();
    assert!(shares.windows(2).all(|pair| pair[1] <= pair[0]), "{shares:?}");
}

proptest! {
    #[test]
    fn a_strip_with_a_dent_was_pressed_in_so_far_that_the_dent_stays(law in laws(), dent_m in 0.001..1.0_f64) {
        let strip = law.with_dent(dent_m);
        prop_assert!((strip.dent_m - dent_m).abs() < 1e-6, "{strip:?}");
        prop_assert_eq!(strip.load_n_per_m(strip.dent_m), 0.0);
    }
}

#[test]
fn numbers_out_of_range_are_named() {
    let good = FaceParameters {
        onset_n_per_m: 4e4,
        stiffness_n_per_m2: 6e5,
        elastic_depth_m: 0.05,
        saturation_depth_m: 0.5,
        recovery: Recovery::default(),
    };
    for (bad, name) in [
        (FaceParameters { onset_n_per_m: -1.0, ..good }, "onset_n_per_m"),
        (FaceParameters { stiffness_n_per_m2: 0.0, ..good }, "stiffness_n_per_m2"),
        (FaceParameters { elastic_depth_m: f64::NAN, ..good }, "elastic_depth_m"),
        (FaceParameters { saturation_depth_m: 0.04, ..good }, "saturation_depth_m"),
        (FaceParameters { recovery: Recovery::constant(1.5), ..good }, "recovery.elastic"),
    ] {
        assert_eq!(FaceLaw::new(bad).unwrap_err().name, name);
    }
}

#[test]
fn a_strip_gives_back_the_share_rho_of_a_linear_law() {
    let law = FaceLaw::linear(8e5, Recovery::constant(0.09)).unwrap();
    let strip = law.after(0.3);
    // Trapezoids of straight pieces are exact.
    let work =
        |from: f64, to: f64, load: &dyn Fn(f64) -> f64| (load(from) + load(to)) / 2.0 * (to - from);
    let taken_j = work(0.0, 0.3, &|depth| law.virgin_load_n_per_m(depth));
    let given_j = work(strip.dent_m, 0.3, &|depth| strip.load_n_per_m(depth));
    assert!((given_j / taken_j - 0.09).abs() < 1e-12, "{given_j} of {taken_j}");
    assert_eq!(strip.load_n_per_m(0.2), 0.0);
    assert!((strip.unloading_compliance_m2_per_n() - 0.09 / 8e5).abs() < 1e-15);
}

proptest! {
    #[test]
    fn deflection_is_the_inverse_of_the_load(law in laws(), h in depths(), share in 0.0..1.0) {
        let strip = law.after(h);
        let end = if law.saturation_n_per_m.is_finite() { law.saturation_n_per_m } else { 5e5 };
        let load = share * end;
        let deflection = strip.deflection_m(load);
        prop_assert!(deflection >= strip.dent_m - 1e-12);
        // A law without elastic branch has its first load at no deflection.
        let is_jump = deflection < 1e-9 && law.elastic_depth_m == 0.0;
        let back = strip.load_n_per_m(deflection);
        prop_assert!(is_jump || (back - load).abs() < 1e-6 * end, "{load} gives {back}");
    }

    #[test]
    fn two_strips_share_the_overlap_at_one_load(
        a in laws(), b in laws(), ha in depths(), hb in depths(), overlap_m in 0.0..1.5,
    ) {
        let (a, b) = (a.after(ha), b.after(hb));
        let pressed = press_together([&a, &b], overlap_m);
        let [da, db] = pressed.deflections_m;
        let load = pressed.load_n_per_m;
        prop_assert!(load >= 0.0 && load <= a.saturation_n_per_m.min(b.saturation_n_per_m));
        if overlap_m <= a.dent_m + b.dent_m {
            prop_assert_eq!(load, 0.0);
        } else {
            prop_assert!((da + db - overlap_m).abs() < 1e-9, "{da} + {db} of {overlap_m}");
            for (strip, deflection) in [(a, da), (b, db)] {
                let own = strip.load_n_per_m(deflection);
                let is_jump = deflection < 1e-9;
                let is_vertical = strip.greatest_m - strip.dent_m < 1e-6;
                prop_assert!(
                    is_jump || is_vertical || (own - load).abs() < 1e-5 * (load + 1.0),
                    "{own} of {load} at {deflection} m of {strip:?}"
                );
            }
        }
        // Exchanged strips have exchanged deflections.
        let exchanged = press_together([&b, &a], overlap_m);
        prop_assert!((exchanged.load_n_per_m - load).abs() <= 1e-9 * (load + 1.0));
        prop_assert!((exchanged.deflections_m[0] - db).abs() < 1e-9);
    }

    #[test]
    fn a_load_grows_with_the_overlap(a in laws(), b in laws(), ha in depths(), hb in depths()) {
        let (a, b) = (a.after(ha), b.after(hb));
        let loads: Vec<f64> = (0..200)
            .map(|i| press_together([&a, &b], f64::from(i) * 0.008).load_n_per_m)
            .collect();
        prop_assert!(loads.windows(2).all(|pair| pair[1] >= pair[0] - 1e-6), "{loads:?}");
    }
}

struct SideBySide {
    laws: [FaceLaw; 2],
    histories_m: [[f64; MAX_LANES]; 2],
    overlap_m: [f64; MAX_LANES],
}

impl WithSimd for SideBySide {
    type Output = Result<(), TestCaseError>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let [a, b] = [0, 1].map(|i| self.laws[i].after(Packed::new(simd, &self.histories_m[i])));
        let got = press_together([&a, &b], Packed::new(simd, &self.overlap_m));
        for lane in 0..Packed::<S>::N {
            let [a, b] = [0, 1].map(|i| self.laws[i].after(self.histories_m[i][lane]));
            let alone = press_together([&a, &b], self.overlap_m[lane]);
            let load = got.load_n_per_m.to_array()[lane];
            prop_assert_eq!(load.to_bits(), alone.load_n_per_m.to_bits(), "lane {}", lane);
            for i in 0..2 {
                let deflection = got.deflections_m[i].to_array()[lane];
                prop_assert_eq!(deflection.to_bits(), alone.deflections_m[i].to_bits());
            }
        }
        Ok(())
    }
}

proptest! {
    #[test]
    fn a_lane_is_the_pair_of_strips_by_itself_to_the_last_digit(
        laws in [laws(), laws()],
        histories_m in [prop::array::uniform8(depths()), prop::array::uniform8(depths())],
        overlap_m in prop::array::uniform8(0.0..1.2),
    ) {
        let work = SideBySide { laws, histories_m, overlap_m };
        pulp::Arch::new().dispatch(work)?;
    }
}
