//! Tests of the tire: its curve, the friction circle, rolling, braking and locking.

use proptest::prelude::*;

use super::*;

const TIRE: TireParameters = TireParameters {
    cornering_coefficient_front_per_rad: 13.0,
    cornering_coefficient_rear_per_rad: 20.0,
    friction: 0.8,
    sliding_friction_ratio: 0.8,
    rolling_resistance: 0.01,
    rolling_resistance_s_m: 1e-4,
    rolling_resistance_s2_m2: 2e-5,
    rolling_radius_m: 0.31,
    wheel_inertia_kg_m2: 1.2,
    longitudinal_friction_ratio: 1.0,
};

fn driven(drive_n: f64) -> WheelEffort<f64> {
    WheelEffort { drive_n, ..WheelEffort::none() }
}

fn braked(braking_n: f64) -> WheelEffort<f64> {
    WheelEffort { braking_n, ..WheelEffort::none() }
}

fn free_n(slip: WheelSlip<f64>, vertical_load_n: f64) -> [f64; 2] {
    slip.free().force_n(vertical_load_n)
}

fn slip(tire: &TireParameters, coefficient: f64, velocity_m_s: [f64; 2]) -> WheelSlip<f64> {
    turning(tire, coefficient, velocity_m_s, 0.0)
}

fn turning(
    tire: &TireParameters,
    coefficient: f64,
    velocity_m_s: [f64; 2],
    yaw_rate_rad_s: f64,
) -> WheelSlip<f64> {
    tire.constants().slip(coefficient / tire.friction, velocity_m_s, yaw_rate_rad_s)
}

#[test]
fn a_wheel_lags_behind_a_fast_rotation_and_drags() {
    // Rolling backwards after half a turn, the wheel still brakes, and has less side force.
    let [fx, fy] = free_n(turning(&TIRE, 20.0, [-15.0, -8.0], 4.0), 5e3);
    let [_, steady] = free_n(slip(&TIRE, 20.0, [-15.0, -8.0]), 5e3);
    assert!(fx > 300.0 && fx < 700.0 && fy > 0.0 && fy < steady, "{fx} {fy} {steady}");
    // In a gentle curve the drag is the inertia force of the wheel, −m_w r w.
    let [fx, _] = free_n(turning(&TIRE, 20.0, [20.0, 0.5], 0.2), 5e3);
    let [rolling, _] = free_n(slip(&TIRE, 20.0, [20.0, 0.5]), 5e3);
    let expected = -TIRE.wheel_mass_kg() * 0.2 * 0.5;
    assert!(((fx - rolling) / expected - 1.0).abs() < 0.15, "{} {expected}", fx - rolling);
}

#[test]
fn the_slope_at_zero_slip_is_the_cornering_stiffness() {
    let tire = TireParameters { rolling_resistance_s2_m2: 0.0, ..TIRE };
    let (u, w) = (1e3, 1e-3);
    let [fx, fy] = slip(&tire, 13.0, [u, -w]).force_n(5e3, &driven(0.0));
    let free_of_rolling = (1.0 - (fx / (0.8 * 5e3)).powi(2)).sqrt();
    assert!((fy / (13.0 * 5e3 * w / u * free_of_rolling) - 1.0).abs() < 1e-3, "{fy} {fx}");
}

#[test]
fn a_wheel_that_slides_sideways_has_sliding_friction() {
    let [_, fy] = slip(&TIRE, 20.0, [0.0, 10.0]).force_n(4000.0, &driven(0.0));
    let [full, sliding] = [0.8 * 4000.0, 0.8 * 0.8 * 4000.0];
    assert!(fy < 0.0 && fy.abs() < 1.01 * sliding && fy.abs() < full, "{fy}");
}

#[test]
fn a_lifted_wheel_has_no_force() {
    assert_eq!(slip(&TIRE, 20.0, [5.0, 3.0]).force_n(0.0, &driven(0.0)), [0.0, 0.0]);
}

#[test]
fn a_wheel_locks_by_more_than_the_road_holds_and_then_slides() {
    let (load, full) = (5e3, 0.8 * 5e3);
    let along = |braking_n| slip(&TIRE, 20.0, [20.0, 0.0]).force_n(load, &braked(braking_n))[0];
    assert!((along(0.9 * full) + 0.9 * full).abs() < 0.03 * full, "{}", along(0.9 * full));
    assert!((along(1.2 * full) + 0.8 * full).abs() < 1.0, "{}", along(1.2 * full));
    // Sliding sideways, a tenth of that locks it, and the force is against the sliding.
    let [fx, fy] = slip(&TIRE, 20.0, [1.0, 12.0]).force_n(load, &braked(0.1 * full));
    assert!((fy / fx - 12.0).abs() < 1e-6 && fx < 0.0, "{fx} {fy}");
    let size = f64::hypot(fx, fy);
    assert!((size - 0.64 * load).abs() < 1.0, "{size}");
}

#[test]
fn a_locked_wheel_pushes_against_its_velocity() {
    let locked = WheelEffort { locked: 1.0, ..WheelEffort::none() };
    for [u, w] in [[10.0, 0.0], [-3.0, 4.0], [0.0, -7.0]] {
        let [fx, fy] = slip(&TIRE, 20.0, [u, w]).force_n(5e3, &locked);
        let speed = f64::hypot(u, w);
        let expected = [u, w].map(|v| -0.64 * 5e3 * v / speed);
        assert!((fx - expected[0]).abs() < 1.0 && (fy - expected[1]).abs() < 1.0, "{fx} {fy}");
    }
    assert_eq!(slip(&TIRE, 20.0, [0.0, 0.0]).force_n(5e3, &locked), [0.0, 0.0]);
}

#[test]
fn a_wheel_may_hold_more_along_its_plane_than_across_it() {
    let tire = TireParameters { longitudinal_friction_ratio: 1.15, ..TIRE };
    let locked = WheelEffort { locked: 1.0, ..WheelEffort::none() };
    let [fx, fy] = slip(&tire, 20.0, [6.0, 8.0]).force_n(5e3, &locked);
    let across = -0.64 * 5e3;
    assert!((fx - 1.15 * across * 0.6).abs() < 1.0 && (fy - across * 0.8).abs() < 1.0, "{fx} {fy}");
    // Rolling straight, it brakes with what would lock it otherwise.
    let torque = braked(1.1 * 0.8 * 5e3);
    let [fx, _] = slip(&tire, 20.0, [20.0, 0.0]).force_n(5e3, &torque);
    assert!((fx + torque.braking_n).abs() < 0.03 * torque.braking_n, "{fx}");
    let [fx, _] = slip(&TIRE, 20.0, [20.0, 0.0]).force_n(5e3, &torque);
    assert!(-fx < 0.8 * 5e3, "{fx}");
}

proptest! {
    #[test]
    fn a_tire_never_puts_energy_in(
        u in -60.0..60.0, w in -60.0..60.0, load in 0.0..2e4, braking_n in 0.0..2e4,
        locked in 0.0..1.0, yaw_rate in -10.0..10.0,
    ) {
        let effort = WheelEffort { drive_n: 0.0, braking_n, locked };
        let [fx, fy] = turning(&TIRE, 13.0, [u, w], yaw_rate).force_n(load, &effort);
        prop_assert!(fx * u + fy * w <= 0.0);
    }

    #[test]
    fn a_brake_pulls_no_more_than_it_is_asked_for_until_the_wheel_locks(
        u in 1.0..60.0, w in -60.0..60.0, braking_n in 0.0..2e4,
    ) {
        let tire = TireParameters { rolling_resistance: 0.0, rolling_resistance_s_m: 0.0,
            rolling_resistance_s2_m2: 0.0, ..TIRE };
        let [fx, _] = slip(&tire, 13.0, [u, w]).force_n(5e3, &braked(braking_n));
        prop_assert!(-fx <= braking_n * (1.0 + 1e-9) && fx <= 0.0, "{fx}");
    }

    #[test]
    fn the_force_stays_in_the_friction_circle(
        u in -60.0..60.0, w in -60.0..60.0, load in 0.0..2e4, drive_n in -2e4..2e4,
        braking_n in 0.0..2e4, locked in 0.0..1.0, yaw_rate in -10.0..10.0,
    ) {
        let effort = WheelEffort { drive_n, braking_n, locked };
        let [fx, fy] = turning(&TIRE, 13.0, [u, w], yaw_rate).force_n(load, &effort);
        prop_assert!(f64::hypot(fx, fy) <= 0.8 * load * (1.0 + 1e-12));
    }

    #[test]
    fn backwards_is_the_mirror_of_forwards(u in 0.1..60.0, w in -60.0..60.0) {
        let [fx, fy] = slip(&TIRE, 13.0, [u, w]).force_n(5e3, &driven(0.0));
        let [bx, by] = slip(&TIRE, 13.0, [-u, w]).force_n(5e3, &driven(0.0));
        prop_assert!((fx + bx).abs() < 1e-9 && (fy - by).abs() < 1e-9);
    }
}
