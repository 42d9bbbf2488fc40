use super::*;
use crate::vehicle::Preset;

/// The 2018 Toyota Camry of NHTSA test v10146, 57.09 km/h, over the width of the car.
const CAMRY: BarrierTest = BarrierTest {
    mass_kg: 1719.0,
    width_m: 1.837,
    speed_m_s: 57.09 / 3.6,
    no_damage_speed_m_s: 5.0 * 0.447_04,
    crush_m: [0.380, 0.466, 0.511, 0.518, 0.489, 0.370],
};

#[test]
fn a_barrier_test_gives_the_stiffness_and_the_stiffness_the_speed() {
    let stiffness = CAMRY.stiffness().unwrap();
    let (a, b) = (stiffness.onset_n_per_m, stiffness.stiffness_n_per_m2);
    assert!((a / 604e2 - 1.0).abs() < 2e-3 && (b / 78.0e4 - 1.0).abs() < 2e-3, "{stiffness:?}");
    // The energy that the law takes up to the mean crush, with A²/(2B) as its constant, is that
    // of the test.
    let depth = CAMRY.mean_crush_m();
    let absorbed_j = CAMRY.width_m * (a * depth + b * depth * depth / 2.0 + a * a / b / 2.0);
    let speed_m_s = (2.0 * absorbed_j / CAMRY.mass_kg).sqrt();
    assert!((speed_m_s - CAMRY.speed_m_s).abs() < 1e-9, "{speed_m_s}");
    for (bad, name) in [
        (BarrierTest { mass_kg: 0.0, ..CAMRY }, "mass_kg"),
        (BarrierTest { width_m: f64::NAN, ..CAMRY }, "width_m"),
        (BarrierTest { speed_m_s: 2.0, ..CAMRY }, "speed_m_s"),
        (BarrierTest { crush_m: [0.0; 6], ..CAMRY }, "mean crush"),
    ] {
        assert_eq!(bad.stiffness().unwrap_err().name, name);
    }
}

/// What is no test of a front against a wall gives no stiffness of a front.
#[test]
fn a_pole_a_side_or_an_angle_is_refused() {
    let row = |code: &str| {
        let mut fields = vec!["0"; 60];
        for (idx, text) in [(0, "1"), (10, "1500"), (14, "1800"), (41, "56.0"), (53, code)] {
            fields[idx] = text;
        }
        fields[47..53].fill("400");
        fields.join("|")
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("v1.EV5");
    let of = |barrier: &str, code: &str| {
        let text = format!(
            "----- EV5 -----\n----- TEST -----\nV5|A|B\n----- VEHICLE -----\n{}\n----- BARRIER -----\n\
             {barrier}\n----- END -----\n",
            row(code)
        );
        std::fs::write(&path, text).unwrap();
        BarrierTest::from_crash_test(&CrashTest::read(&path).unwrap())
    };
    assert!(of("R|LCB|0|0|WALL", "12FDEW2").is_ok());
    assert!(of("R|LCB|0|0|WALL", "0").is_ok());
    // A depth that was not measured made the mean of the others a fifth less.
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replacen("|400|400|", "|400|0|", 1)).unwrap();
    let why = BarrierTest::from_crash_test(&CrashTest::read(&path).unwrap()).unwrap_err();
    assert!(why.contains("C2 to C5 is 0"), "{why}");
    for (barrier, code, part) in [
        ("R|POL|0|254|POLE", "12FCEN3", "a pole"),
        ("R|LCB|30|0|WALL", "12FDEW2", "at an angle"),
        ("R|LCB|0|0|WALL", "06BDEW2", "on the face B"),
        ("D|LCB|0|0|WALL", "12FDEW2", "rigid"),
        // Of the offset test the width of the whole car was taken as that of its crush.
        ("R|LCB|0|0|WALL", "12FYEW4", "the damage 12FYEW4 is on a part of the face"),
        ("R|LCB|0|0|WALL", "11FLEE5", "on a part of the face"),
    ] {
        let why = of(barrier, code).unwrap_err();
        assert!(why.contains(part), "{part}: {why}");
    }
}

#[test]
fn printed_cars_have_their_own_values_and_heavier_cars_more_of_them() {
    let large = class_stiffness(VehicleClass::Car, 1922.0);
    let off_road = class_stiffness(VehicleClass::Suv, 2207.0);
    for (got, expected) in [(large, LARGE_SALOON.stiffness), (off_road, OFF_ROADER.stiffness)] {
        for side in Side::ALL {
            let (got, expected) = (got.at(side), expected.at(side));
            let off = got.stiffness_n_per_m2 / expected.stiffness_n_per_m2 - 1.0;
            assert!(off.abs() < 1e-12, "{side:?}: {got:?}, printed {expected:?}");
        }
    }
    for class in [VehicleClass::Car, VehicleClass::Suv] {
        let mut before = 0.0;
        for i in 0..40 {
            let mass_kg = 600.0 + 75.0 * f64::from(i);
            let front = class_stiffness(class, mass_kg).rear.onset_n_per_m;
            assert!(front > before, "{class:?} of {mass_kg} kg: {front} after {before}");
            before = front;
        }
    }
}

#[test]
fn what_a_file_says_of_a_face_takes_the_place_of_the_rule() {
    let mut vehicle = Preset::Reference.parameters();
    let by_rule = FaceLaws::by_class(&vehicle).unwrap();
    let FaceStiffness { onset_n_per_m, stiffness_n_per_m2 } = CAMRY.stiffness().unwrap();
    vehicle.crush.front = Some(CrushStiffness { onset_n_per_m, stiffness_n_per_m2 });
    let said = FaceLaws::by_class(&vehicle).unwrap();
    let [factor, _] = PRINTED_FACTORS.front;
    assert!((said.front.onset_n_per_m() / onset_n_per_m / factor - 1.0).abs() < 1e-12);
    assert_eq!((said.side, said.rear), (by_rule.side, by_rule.rear));
    let sigma = stiffness_log_sigma(&vehicle.crush);
    assert_eq!([sigma.front, sigma.side], [TESTED_LOG_SIGMA, STIFFNESS_LOG_SIGMA.side]);
}

#[test]
fn an_estimate_by_class_has_the_median_and_the_scatter_of_the_rule() {
    let by_rule = class_stiffness(VehicleClass::Suv, 1900.0);
    for face in CrushFace::ALL {
        let [onset, stiffness] = class_estimates(VehicleClass::Suv, 1900.0, face);
        let FaceStiffness { onset_n_per_m, stiffness_n_per_m2 } = *by_rule.at_face(face);
        assert_eq!([onset.median, stiffness.median], [onset_n_per_m, stiffness_n_per_m2]);
        for estimate in [onset, stiffness] {
            let [low, high] = estimate.ninety();
            let spread = (high / low).ln() / STIFFNESS_LOG_SIGMA.at_face(face);
            assert!((spread - 2.0 * 1.644_853_6).abs() < 1e-6, "{face:?}: {spread}");
            assert!((low * high / estimate.median.powi(2) - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn a_draw_scales_each_face_by_its_own_scatter() {
    let laws = class_stiffness(VehicleClass::Car, 1500.0).laws().unwrap();
    let latents = ByFace { front: 1.0, side: -2.0, rear: 0.0 };
    let drawn = laws.drawn(latents, STIFFNESS_LOG_SIGMA);
    let ratio = |side| drawn.at(side).onset_n_per_m() / laws.at(side).onset_n_per_m();
    assert!((ratio(Side::Front) - 0.25_f64.exp()).abs() < 1e-12);
    assert!((ratio(Side::Right) - (-0.8_f64).exp()).abs() < 1e-12);
    assert_eq!(drawn.rear, laws.rear);
}
