//! Tests of vehicles that come to rest, stand, or would not come to rest.

use super::*;
use crate::collision::Footprint;
use crate::collision::contact::test_pairs::{
    TestCar, alike, free_body, last_state, on_level_tires, pit_manoeuvre, simulate,
};
use crate::collision::contact::{CoupledSettings, FaceLaw, FaceLaws, Recovery};
use crate::vehicle::{Braking, DrivenAxle, Driving, Ending};

const BOX: Footprint = Footprint { length_m: 4.2, width_m: 1.6, cg_from_front_m: 2.0 };

/// A car that stands is not at rest as long as another one comes towards it.
#[test]
fn the_motion_ends_where_both_cars_have_come_to_rest() {
    let mut cars = pit_manoeuvre(0.08);
    cars[0].manoeuvre.initial.vx_body_m_s = 0.0;
    cars[1].manoeuvre.initial =
        VehicleState { x_m: -14.0, y_m: 0.4, ..VehicleState::driving_straight(10.0) };
    for (car, start_s) in cars.iter_mut().zip([0.0, 1.2]) {
        let brake = Some(Braking::new(start_s, 0.7, 0.2));
        car.manoeuvre.controls = Ending { brake, ..Ending::default() }.controls(&car.vehicle);
        (car.manoeuvre.duration_s, car.manoeuvre.ends_at_rest) = (20.0, true);
    }
    let motion = simulate([&cars[0], &cars[1]], ContactConditions::default(), 1).unwrap();
    let [first, ..] = motion.phases[..] else { panic!("no contact") };
    assert!((0.5..1.2).contains(&first.start_s), "{first:?}");
    let [struck, striking] = &motion.motions;
    let ends_s = [struck, striking].map(|motion| *motion.series.time_s().last().unwrap());
    assert_eq!(ends_s[0], ends_s[1]);
    assert!(ends_s[0] > first.start_s + 0.5 && ends_s[0] < 6.0, "{ends_s:?}");
    assert!(struck.rest_s.is_some() && striking.rest_s.is_some(), "{ends_s:?}");
    let pushed_m = last_state(struck).x_m;
    assert!(pushed_m > 1.0, "pushed by {pushed_m} m");
}

/// Residual accelerations that would drive and spin a coasting car without end leave it at least half of
/// what its tires take, and noise that gives as often as it takes is hardly changed.
#[test]
fn what_the_equations_miss_does_not_drive_a_vehicle() {
    let mut cars = pit_manoeuvre(0.08);
    cars[1].manoeuvre.initial.y_m = 30.0;
    cars.iter_mut().for_each(|car| car.manoeuvre.duration_s = 12.0);
    cars[0].manoeuvre.initial.yaw_rate_rad_s = 2.0;
    let energy_j = |residual: &dyn Fn(usize) -> [f64; N_ACCELERATION]| {
        let vehicles = [&cars[0], &cars[1]].map(TestCar::in_pair);
        let (conditions, settings) = (ContactConditions::default(), CoupledSettings::default());
        let pair = VehiclePair { vehicles, conditions, settings };
        let mut run = PairRun::new(&pair).unwrap();
        let mut instant = 0;
        while run.goes_on(&[residual(instant), [0.0; N_ACCELERATION]]).unwrap() {
            instant += 1;
        }
        cars[0].vehicle.energy_j(&last_state(&run.finish().unwrap().motions[0]))
    };
    let start_j = cars[0].vehicle.energy_j(&cars[0].manoeuvre.initial);
    let lost_j = start_j - energy_j(&|_| [0.0; N_ACCELERATION]);
    for driving in [[3.0, 0.0, 0.0, 0.0], [0.0, 0.0, 4.0, 0.0], [3.0, 2.0, -4.0, 0.0]] {
        let driven_j = start_j - energy_j(&|_| driving);
        assert!(driven_j > 0.2 * lost_j, "{driving:?}: {driven_j} J of {lost_j} J are lost");
    }
    let noisy_j = start_j
        - energy_j(&|instant| {
            let sign = if instant.is_multiple_of(2) { 0.2 } else { -0.2 };
            [sign, sign, sign, 0.0]
        });
    assert!((noisy_j / lost_j - 1.0).abs() < 0.02, "{noisy_j} J of {lost_j} J");
}

/// A blow of 6 ms is over before anybody looks again whether the car rests.
#[test]
fn a_short_blow_moves_a_car_that_is_at_rest() {
    let law = FaceLaw::linear(1.5e8 / BOX.width_m, Recovery::constant(0.03)).unwrap();
    let mut cars = [(1500.0, 0.0, 0.0), (1200.0, -6.66, 12.0)].map(|(mass_kg, x_m, speed_m_s)| {
        let initial = VehicleState { x_m, ..VehicleState::driving_straight(speed_m_s) };
        TestCar::new(free_body(mass_kg, 2500.0, BOX), [0.0, 0.1], alike(law), initial)
    });
    cars.iter_mut().for_each(|car| car.manoeuvre.ends_at_rest = true);
    let undamped = ContactConditions { damping_s_m: 0.0, ..ContactConditions::default() };
    let motion = simulate([&cars[0], &cars[1]], undamped, 1).unwrap();
    let [phase] = motion.phases[..] else { panic!("{:?}", motion.phases) };
    // The parked car counts as at rest from 0.1 s on.
    assert!(phase.start_s > 0.2, "{phase:?}");
    assert!(phase.end_s.is_some_and(|end_s| end_s - phase.start_s < 0.01), "{phase:?}");
    let [struck, striking] = motion.motions.each_ref().map(last_state);
    let momentum_n_s = 1500.0 * struck.vx_body_m_s + 1200.0 * striking.vx_body_m_s;
    assert!((momentum_n_s - 1200.0 * 12.0).abs() < 0.1, "{momentum_n_s} N s");
    assert!(struck.vx_body_m_s > 5.0, "{struck:?}");
}

/// A car that its engine moves off gently is as slow as one at rest for a while.
#[test]
fn a_car_that_moves_off_is_not_held_where_it_stands() {
    let mut cars = [(0.0, 0.0), (40.0, 20.0)].map(|(y_m, speed_m_s)| {
        let vehicle = on_level_tires(1500.0, 2600.0, BOX);
        let faces = FaceLaws::by_class(&vehicle).unwrap();
        let initial = VehicleState { y_m, ..VehicleState::driving_straight(speed_m_s) };
        TestCar::new(vehicle, [0.25, 0.1], faces, initial)
    });
    let drive = Driving { torque_n_m: 60.0, axle: DrivenAxle::Front, start_s: 0.5, rise_s: 0.1 };
    let ending = Ending { drive: Some(drive), ..Ending::default() };
    cars[0].manoeuvre.controls = ending.controls(&cars[0].vehicle);
    for car in &mut cars {
        (car.manoeuvre.duration_s, car.manoeuvre.ends_at_rest) = (5.0, true);
    }
    let vehicles = [&cars[0], &cars[1]].map(TestCar::in_pair);
    let settings = CoupledSettings { until_both_rest: true, ..CoupledSettings::default() };
    let pair = VehiclePair { vehicles, conditions: ContactConditions::default(), settings };
    let motion = pair.simulate().unwrap();
    let force_n = drive.torque_n_m / cars[0].vehicle.tires.rolling_radius_m;
    let expected_m_s = force_n / 1500.0 * (5.0 - 0.55);
    let got_m_s = last_state(&motion.motions[0]).vx_body_m_s;
    assert!((got_m_s / expected_m_s - 1.0).abs() < 0.02, "{got_m_s}, expected {expected_m_s} m/s");
}
