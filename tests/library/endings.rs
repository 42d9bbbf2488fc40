//! How motions end: brakes, dragged and locked wheels, rest, against closed forms.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use impactlab_core::data::{Channel, TimeSeries};
use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::{
    Braking, DamagedWheel, DrivenAxle, Ending, EngineBraking, Integrator, Manoeuvre, Motion,
    Preset, VehicleParameters, VehicleState, Wheel,
};
use proptest::prelude::*;

/// The reference car without rolling resistance and air drag.
fn frictionless_rolling() -> VehicleParameters {
    let mut vehicle = Preset::Reference.parameters();
    vehicle.tires.rolling_resistance = 0.0;
    vehicle.tires.rolling_resistance_s2_m2 = 0.0;
    vehicle
}

fn brake(share_of_friction: f64, start_s: f64) -> Ending {
    let brake = Braking::new(start_s, share_of_friction, 0.01);
    Ending { brake: Some(brake), ..Ending::default() }
}

fn damaged(wheels: &[(Wheel, Option<f64>)]) -> Ending {
    let damage = wheels.iter().map(|&(wheel, drag_share_of_friction)| DamagedWheel {
        wheel,
        start_s: 0.0,
        drag_share_of_friction,
    });
    Ending { damage: damage.collect(), ..Ending::default() }
}

fn motion(vehicle: &VehicleParameters, initial: VehicleState<f64>, ending: &Ending) -> Motion {
    let manoeuvre = Manoeuvre {
        initial,
        controls: ending.controls(vehicle),
        duration_s: 60.0,
        ends_at_rest: true,
        friction_zones: Vec::new(),
        ..Manoeuvre::default()
    };
    vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap()
}

fn last(series: &TimeSeries, channel: Channel) -> f64 {
    *series.require(channel).unwrap().last().unwrap()
}

#[test]
fn a_straight_stop_takes_the_square_of_the_speed_over_twice_the_deceleration() {
    let vehicle = frictionless_rolling();
    let tires = &vehicle.tires;
    let sliding = tires.friction * tires.sliding_friction_ratio;
    for (share, friction) in [(1.5, sliding), (0.9, 0.9 * tires.friction), (0.3, 0.3 * 0.8)] {
        for speed_m_s in [5.0_f64, 20.0, 40.0] {
            let initial = VehicleState::driving_straight(speed_m_s);
            let stop = motion(&vehicle, initial, &brake(share, 0.0));
            let expected = speed_m_s.powi(2) / (2.0 * friction * STANDARD_GRAVITY_M_S2);
            // The brakes rise over 0.01 s, in which the car moves on.
            let got = last(&stop.series, Channel::X) - 0.005 * speed_m_s;
            assert!(
                (got / expected - 1.0).abs() < 0.01,
                "{share} from {speed_m_s}: {got} {expected}"
            );
            assert!(last(&stop.series, Channel::Y).abs() < 1e-9);
            let rest_s = stop.rest_s.unwrap();
            let expected_s = speed_m_s / (friction * STANDARD_GRAVITY_M_S2);
            assert!((rest_s - expected_s).abs() < 0.05, "{rest_s} {expected_s}");
        }
    }
}

/// Until its wheels lock, a car brakes with nearly what the road can hold; then with sliding friction.
#[test]
fn wheels_may_take_their_time_to_lock() {
    let mut vehicle = frictionless_rolling();
    vehicle.tires.longitudinal_friction_ratio = 1.1;
    let brake = Braking { lock_delay_s: 0.5, ..Braking::new(0.0, 1.6, 0.01) };
    let ending = Ending { brake: Some(brake), ..Ending::default() };
    let stop = motion(&vehicle, VehicleState::driving_straight(20.0), &ending).series;
    let speeds = stop.require(Channel::Vx).unwrap();
    let friction = |from: usize, to: usize| {
        (speeds[from] - speeds[to]) / (0.01 * (to - from) as f64) / STANDARD_GRAVITY_M_S2
    };
    let tires = &vehicle.tires;
    let (held, sliding) =
        (1.1 * tires.friction, 1.1 * tires.friction * tires.sliding_friction_ratio);
    assert!((friction(5, 45) / (0.97 * held) - 1.0).abs() < 0.01, "{}", friction(5, 45));
    assert!((friction(60, 120) / sliding - 1.0).abs() < 0.01, "{}", friction(60, 120));
}

/// Wheels that are braked beyond their part of the load lock first: with most of the force on the rear
/// axle the car keeps less than sliding friction on all wheels would give, and never more.
#[test]
fn the_axle_with_too_much_of_the_brakes_locks_first() {
    let vehicle = frictionless_rolling();
    let full = vehicle.tires.friction * STANDARD_GRAVITY_M_S2;
    let deceleration = |front_share| {
        let brake = Braking { front_share, ..Braking::new(0.0, 0.9, 0.01) };
        let ending = Ending { brake: Some(brake), ..Ending::default() };
        let stop = motion(&vehicle, VehicleState::driving_straight(20.0), &ending).series;
        let speeds = stop.require(Channel::Vx).unwrap();
        (speeds[10] - speeds[60]) / 0.5
    };
    assert!((deceleration(None) / (0.9 * full) - 1.0).abs() < 0.01);
    let rear_first = deceleration(Some(0.4));
    assert!(rear_first < 0.85 * full && rear_first > 0.5 * full, "{rear_first} of {full}");
}

#[test]
fn a_locked_spin_loses_energy_at_the_friction_of_its_sliding_wheels() {
    let mut vehicle = frictionless_rolling();
    // So low and so centred that all wheels carry the same.
    vehicle.geometry.cg_height_m = 0.15;
    vehicle.suspension.roll_arm_m = 0.01;
    vehicle.geometry.cg_to_rear_axle_m = vehicle.geometry.cg_to_front_axle_m;
    let all = Wheel::ALL.map(|wheel| (wheel, None));
    let initial =
        VehicleState { vx_body_m_s: 12.0, yaw_rate_rad_s: 4.0, ..VehicleState::default() };
    let spin = motion(&vehicle, initial, &damaged(&all)).series;
    let state = |i: usize| {
        let at = |channel| spin.require(channel).unwrap()[i];
        VehicleState {
            vx_body_m_s: at(Channel::Vx),
            vy_body_m_s: at(Channel::Vy),
            yaw_rate_rad_s: at(Channel::YawRate),
            ..VehicleState::default()
        }
    };
    let patch_speed = |x: &VehicleState<f64>| {
        let speeds = Wheel::ALL.map(|wheel| {
            let [px, py] = wheel.position_m(&vehicle);
            (x.vx_body_m_s - x.yaw_rate_rad_s * py).hypot(x.vy_body_m_s + x.yaw_rate_rad_s * px)
        });
        speeds.iter().sum::<f64>() / 4.0
    };
    let (tires, mass_kg) = (&vehicle.tires, vehicle.mass.mass_kg);
    let force_n = tires.friction * tires.sliding_friction_ratio * mass_kg * STANDARD_GRAVITY_M_S2;
    let (from, to) = (10, 110); // 0.1 s to 1.1 s
    let work: f64 = (from..to)
        .map(|i| force_n * 0.005 * (patch_speed(&state(i)) + patch_speed(&state(i + 1))))
        .sum();
    let lost = vehicle.energy_j(&state(from)) - vehicle.energy_j(&state(to));
    assert!((lost / work - 1.0).abs() < 0.01, "{lost} J lost, {work} J expected");
    // The wheels slide against their velocity, so that the car stops on its course.
    assert!(last(&spin, Channel::Y).abs() < 0.05 * last(&spin, Channel::X));
}

#[test]
fn a_dragged_or_locked_wheel_turns_the_car_to_its_side() {
    let vehicle = Preset::Reference.parameters();
    for (wheel, sign) in [
        (Wheel::FrontLeft, 1.0),
        (Wheel::FrontRight, -1.0),
        (Wheel::RearLeft, 1.0),
        (Wheel::RearRight, -1.0),
    ] {
        for drag in [Some(0.3), Some(0.8), None] {
            let initial = VehicleState::driving_straight(20.0);
            let turned = motion(&vehicle, initial, &damaged(&[(wheel, drag)])).series;
            let yaw = turned.require(Channel::Yaw).unwrap();
            assert!(yaw[100] * sign > 0.01, "{wheel:?} {drag:?}: {}", yaw[100]);
        }
    }
}

#[test]
fn engine_braking_slows_a_straight_car_as_it_says() {
    let vehicle = frictionless_rolling();
    for axle in [DrivenAxle::Front, DrivenAxle::Rear, DrivenAxle::All] {
        let engine = Some(EngineBraking { deceleration_m_s2: 0.5, axle });
        let ending = Ending { engine, ..Ending::default() };
        let slow = motion(&vehicle, VehicleState::driving_straight(10.0), &ending);
        let expected = 10.0_f64.powi(2) / (2.0 * 0.5);
        let got = last(&slow.series, Channel::X);
        assert!((got / expected - 1.0).abs() < 0.01, "{axle:?}: {got} {expected}");
    }
}

#[test]
fn what_stands_stays_and_what_has_stopped_does_not_chatter() {
    let vehicle = Preset::Reference.parameters();
    let locked = damaged(&Wheel::ALL.map(|wheel| (wheel, None)));
    for ending in [&brake(1.5, 0.0), &locked, &Ending::default()] {
        let parked = motion(&vehicle, VehicleState::default(), ending);
        assert_eq!(last(&parked.series, Channel::X), 0.0);
        assert!(parked.rest_s.is_some());
    }
    for ending in [brake(1.5, 0.0), locked] {
        let manoeuvre = Manoeuvre {
            initial: VehicleState {
                vx_body_m_s: 6.0,
                yaw_rate_rad_s: 2.0,
                ..VehicleState::default()
            },
            controls: ending.controls(&vehicle),
            duration_s: 10.0,
            ..Manoeuvre::default()
        };
        let stopped = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap();
        let rest = (stopped.rest_s.unwrap() / 0.01).round() as usize;
        for channel in [Channel::Vx, Channel::Vy, Channel::YawRate] {
            let after = &stopped.series.require(channel).unwrap()[rest..];
            let falls = after.windows(2).all(|pair| pair[1].abs() <= pair[0].abs() + 1e-3);
            assert!(falls, "{channel:?}: {:?}", &after[..10]);
            // What is left is the body that rolls out on its springs.
            assert!(after[100..].iter().all(|v| v.abs() < 1e-4), "{channel:?}");
        }
        let x = stopped.series.require(Channel::X).unwrap();
        assert!((x[rest] - x.last().unwrap()).abs() < 1e-3, "it creeps");
    }
}

#[test]
fn a_spun_car_that_rolled_backwards_for_hundreds_of_metres_stops_when_it_brakes() {
    let mut vehicle = Preset::Reference.parameters();
    vehicle.tires.friction = 0.5;
    let spun = VehicleState { vx_body_m_s: -15.0, yaw_rate_rad_s: 0.2, ..VehicleState::default() };
    let coasting = motion(&vehicle, spun, &Ending::default());
    assert!(last(&coasting.series, Channel::X) < -100.0);
    let braked = motion(&vehicle, spun, &brake(0.8, 1.0));
    let expected = 15.0 + 15.0_f64.powi(2) / (2.0 * 0.8 * 0.5 * STANDARD_GRAVITY_M_S2);
    let path = last(&braked.series, Channel::X).hypot(last(&braked.series, Channel::Y));
    assert!((path / expected - 1.0).abs() < 0.1, "{path} {expected}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn no_ending_puts_energy_in_and_every_braked_car_comes_to_rest(
        speed in 0.0..50.0_f64, course in -3.2..3.2_f64, yaw_rate in -6.0..6.0_f64,
        share in 0.2..1.5_f64, start_s in 0.0..1.0_f64, wheel in 0..4_usize,
        drag in prop::option::of(0.0..1.5_f64), friction in 0.05..1.2_f64,
    ) {
        let mut vehicle = Preset::Reference.parameters();
        vehicle.tires.friction = friction;
        let ending = Ending {
            damage: vec![DamagedWheel {
                wheel: Wheel::ALL[wheel], start_s: 0.0, drag_share_of_friction: drag,
            }],
            ..brake(share, start_s)
        };
        let (sin, cos) = course.sin_cos();
        let initial = VehicleState {
            vx_body_m_s: speed * cos, vy_body_m_s: speed * sin, yaw_rate_rad_s: yaw_rate,
            ..VehicleState::default()
        };
        // A gain of energy or a state that is not finite would be an error.
        let motion = motion(&vehicle, initial, &ending);
        let slowest = speed + 3.0 * yaw_rate.abs();
        let limit_s = start_s + slowest / (0.15 * friction * STANDARD_GRAVITY_M_S2) + 3.0;
        let rest_s = motion.rest_s.unwrap_or(f64::INFINITY);
        prop_assert!(rest_s <= limit_s || limit_s > 59.0, "{rest_s} after {limit_s}");
    }
}
