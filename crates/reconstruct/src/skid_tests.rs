use super::*;
use crate::Cars;
use crate::evidence::examples::{SPIN, read};

const G: f64 = STANDARD_GRAVITY_M_S2;

/// The model of a case with a section added, and the values of its medians.
fn at_medians(section: &str) -> (ForwardModel, LatentValues) {
    let evidence = read(&format!("{SPIN}\n{section}\n"));
    let model = ForwardModel::new(&evidence, Cars::new(&evidence, None, None));
    let values = model.prior().values(&vec![0.0; model.prior().components().len()]);
    (model, values)
}

#[test]
fn the_speed_before_a_skid_is_that_of_its_energy() {
    for (section, grade) in [
        ("[skid_before]\nlength_m = 20", 0.0),
        ("[skid_before]\nlength_m = 20\ngrade = 0.06", 0.06),
        ("[skid_before]\nlength_m = 20\ngrade_percent = -8", -0.08),
    ] {
        let (model, values) = at_medians(section);
        let impact = model.impact(&values);
        let [Some(before_m_s), none] = impact.speeds_before_skid_m_s else { panic!("a skid") };
        let deceleration_m_s2 = G * (values.locked_drag() + grade) / f64::hypot(1.0, grade);
        let expected = impact.struck_speed_m_s.powi(2) + 2.0 * deceleration_m_s2 * 20.0;
        assert!((before_m_s - expected.sqrt()).abs() < 1e-6, "{section}: {before_m_s}");
        assert_eq!(none, None, "the striking car has no skid");
    }
}

#[test]
fn a_drag_factor_of_the_skid_stands_for_road_and_wheels() {
    let (model, values) = at_medians(
        "[striking_skid_before]\nlength_m = 12\ndrag_factor = 0.5\nlocked_wheels = [\"FL\"]",
    );
    let impact = model.impact(&values);
    let expected = impact.striking_speed_m_s.powi(2) + 2.0 * G * 0.5 * 12.0;
    let [None, Some(before_m_s)] = impact.speeds_before_skid_m_s else { panic!("one skid") };
    assert!((before_m_s - expected.sqrt()).abs() < 1e-6, "{before_m_s}");
}

/// With the front wheels locked, f satisfies `f = μ (l_r + h f)/(l_f + l_r)`.
#[test]
fn locked_wheels_of_one_axle_drag_by_the_load_that_braking_puts_on_them() {
    let car = impactlab_core::vehicle::Preset::Reference.parameters();
    let geometry = &car.geometry;
    let (drag, wheelbase_m, h_m) = (0.7, geometry.wheelbase_m(), geometry.cg_height_m);
    let all = drag_of_locked([1.0, 1.0], drag, &car);
    assert!((all - drag).abs() < 1e-12, "{all}");
    let front = drag_of_locked([1.0, 0.0], drag, &car);
    let load = (geometry.cg_to_rear_axle_m + h_m * front) / wheelbase_m;
    assert!((front - drag * load).abs() < 1e-12, "{front}");
    let rear = drag_of_locked([0.0, 1.0], drag, &car);
    assert!(rear < front && front < drag && drag_of_locked([0.0; 2], drag, &car) == 0.0);
}

/// Friction is common to the road: where it is higher, the speed before the skid is too.
#[test]
fn the_slope_of_the_road_counts_along_the_course_and_the_friction_of_the_road_is_common() {
    let (level, values) = at_medians("[skid_before]\nlength_m = 20");
    let before = |model: &ForwardModel, values: &LatentValues| {
        model.impact(values).speeds_before_skid_m_s[0].unwrap()
    };
    let uphill =
        level.clone().on_slope(impactlab_core::vehicle::RoadSlope { grade: 0.1, cross_slope: 0.2 });
    let (low, high) = (before(&level, &values), before(&uphill, &values));
    let gained = (high * high - low * low) / 40.0;
    let drag = values.locked_drag();
    let expected = G * ((drag + 0.1) / f64::hypot(1.0, 0.1) - drag);
    assert!((gained - expected).abs() < 1e-6, "{gained}, {expected}");
    let mut rough = values;
    rough.set(Latent::RoadFriction, values.get(Latent::RoadFriction) * 1.2);
    assert!(before(&level, &rough) > low + 0.5);
}

#[test]
fn a_case_without_a_skid_is_asked_for_what_it_was() {
    use crate::{Posterior, ReconstructedQuantity};
    let names = |section: &str| -> Vec<&'static str> {
        let (model, _) = at_medians(section);
        let z = vec![vec![0.1; model.prior().components().len()]; 3];
        let posterior = Posterior::from_points(&model, &z);
        posterior.quantities().iter().map(|quantity| quantity.name).collect()
    };
    let usual: Vec<_> = ReconstructedQuantity::ALL.iter().map(|quantity| quantity.key()).collect();
    assert_eq!(names(""), usual);
    let with_skid = names("[skid_before]\nlength_m = 20");
    assert_eq!(with_skid.last(), Some(&"target_speed_before_skid_m_s"));
    assert_eq!(with_skid.len(), usual.len() + 1);
}

#[test]
fn a_car_goes_farther_downhill_from_the_same_impact() {
    let reach_m = |road: &str| {
        let evidence = read(&SPIN.replace("friction = 0.7", &format!("friction = 0.7\n{road}")));
        let model = ForwardModel::new(&evidence, Cars::new(&evidence, None, None));
        let mut z = vec![0.0; model.prior().components().len()];
        // 20 m/s.
        z[0] = -0.43;
        let motions = model.motions(&[z], |motion| motion.path.points.last().map(|last| last.x_m));
        motions[0].unwrap()
    };
    let [down_m, level_m, up_m] = ["grade = -0.05", "grade = 0", "grade = 0.05"].map(reach_m);
    assert!(down_m > level_m + 1.0 && level_m > up_m + 1.0, "{down_m} {level_m} {up_m} m");
}
