use std::path::Path;

use super::*;
use crate::data::{Channel, TomlFile};
use crate::vehicle::{
    Controls, Integrator, Manoeuvre, Motion, PathEnd, PathLimit, Preset, SimulationRun,
    VehicleParameters, VehicleState, WheelEffort, WheelHistory, simulate_batch, simulate_paths,
};

const G: f64 = STANDARD_GRAVITY_M_S2;

fn car(grade: f64, cross_slope: f64) -> VehicleParameters {
    Preset::Reference.parameters().on_slope(RoadSlope { grade, cross_slope })
}

fn all_locked() -> Controls {
    let wheels = vec![[WheelEffort { locked: 1.0, ..WheelEffort::none() }; 4]];
    Controls { wheels: Some(WheelHistory { time_s: vec![0.0], wheels }), ..Controls::default() }
}

fn driving(speed_m_s: f64, controls: Controls, duration_s: f64) -> Manoeuvre {
    let initial = VehicleState::driving_straight(speed_m_s);
    Manoeuvre { initial, controls, duration_s, ends_at_rest: true, ..Manoeuvre::default() }
}

fn simulate(vehicle: &VehicleParameters, manoeuvre: &Manoeuvre) -> Motion {
    vehicle.simulate(manoeuvre, Integrator::Rk4).unwrap()
}

fn end(motion: &Motion, channel: Channel) -> f64 {
    *motion.series.require(channel).unwrap().last().unwrap()
}

/// `s = v²/(2 g (f + G)/√(1 + G²))` on locked wheels.
#[test]
fn locked_wheels_slide_by_the_drag_factor_and_the_grade() {
    let speed_m_s = 20.0;
    let slid_m = |grade| {
        end(&simulate(&car(grade, 0.0), &driving(speed_m_s, all_locked(), 20.0)), Channel::X)
    };
    let drag = speed_m_s * speed_m_s / (2.0 * G * slid_m(0.0));
    for grade in [-0.2_f64, -0.05, 0.05, 0.2] {
        let deceleration_m_s2 = G * (drag + grade) / (1.0 + grade * grade).sqrt();
        let expected_m = speed_m_s * speed_m_s / (2.0 * deceleration_m_s2);
        let got_m = slid_m(grade);
        assert!((got_m / expected_m - 1.0).abs() < 3e-3, "{grade}: {got_m}, {expected_m} m");
    }
}

#[test]
fn a_car_that_rolls_without_resistance_gains_what_the_weight_gives() {
    let mut vehicle = car(-0.06, 0.0);
    let tires = &mut vehicle.tires;
    (tires.rolling_resistance, tires.rolling_resistance_s_m) = (0.0, 0.0);
    tires.rolling_resistance_s2_m2 = 0.0;
    let motion = simulate(&vehicle, &driving(5.0, Controls::default(), 4.0));
    let along_m_s2 = vehicle.slope.gravity_m_s2()[0];
    assert!((along_m_s2 - G * 0.06 / 1.0036_f64.sqrt()).abs() < 1e-12, "{along_m_s2}");
    let expected_m_s = 5.0 + 4.0 * along_m_s2;
    assert!((end(&motion, Channel::Vx) - expected_m_s).abs() < 1e-9);
    let squared = expected_m_s * expected_m_s - 25.0;
    assert!((squared - 2.0 * along_m_s2 * end(&motion, Channel::X)).abs() < 1e-6);
}

#[test]
fn a_road_that_rises_along_x_pushes_a_car_that_slides_across_it_back() {
    let initial = VehicleState { vy_body_m_s: 10.0, ..VehicleState::default() };
    let manoeuvre = Manoeuvre { initial, ..driving(0.0, all_locked(), 10.0) };
    let motion = simulate(&car(0.1, 0.0), &manoeuvre);
    let (x_m, y_m) = (end(&motion, Channel::X), end(&motion, Channel::Y));
    assert!(y_m > 3.0 && x_m < -0.1 && x_m > -0.3 * y_m, "{x_m} {y_m}");
    let turned = VehicleState {
        yaw_rad: std::f64::consts::FRAC_PI_2,
        ..VehicleState::driving_straight(10.0)
    };
    let turned = Manoeuvre { initial: turned, ..manoeuvre };
    let motion = simulate(&car(0.1, 0.0), &turned);
    assert!(end(&motion, Channel::X) < -0.1, "the slope is one of the world, not of the car");
}

#[test]
fn a_car_on_locked_wheels_stays_where_it_is_and_one_on_free_wheels_does_not() {
    let parked = simulate(&car(0.1, 0.05), &driving(0.0, all_locked(), 5.0));
    assert!(
        parked.rest_s.is_some() && end(&parked, Channel::X).abs() < 0.05,
        "{:?}",
        parked.rest_s
    );
    // It stops uphill, and rolls back.
    let (uphill, free) = (car(0.05, 0.0), driving(2.0, Controls::default(), 12.0));
    let rolls = simulate(&uphill, &free);
    assert!(rolls.rest_s.is_none() && end(&rolls, Channel::Vx) < -0.5, "{:?}", rolls.rest_s);
    let run = SimulationRun { vehicle: &uphill, manoeuvre: &free };
    let paths = simulate_paths(&[run], PathLimit { distance_m: 1e3 }, |_, path| path.end);
    assert_eq!(paths, [PathEnd::Time]);
}

#[test]
fn a_path_on_a_slope_ends_where_the_reference_steps_end() {
    for grade in [-0.1, 0.1] {
        let (vehicle, manoeuvre) = (car(grade, 0.04), driving(15.0, all_locked(), 20.0));
        let run = SimulationRun { vehicle: &vehicle, manoeuvre: &manoeuvre };
        let paths = simulate_paths(&[run], PathLimit { distance_m: 1e3 }, |_, path| path);
        let last = *paths[0].points.last().unwrap();
        let reference = simulate(&vehicle, &manoeuvre);
        let off_m =
            (last.x_m - end(&reference, Channel::X)).hypot(last.y_m - end(&reference, Channel::Y));
        assert!(paths[0].end == PathEnd::Rest && off_m < 0.05, "{grade}: {off_m} m");
    }
}

#[test]
fn motions_side_by_side_do_not_change_each_other_where_some_roads_are_level() {
    let cars: Vec<VehicleParameters> =
        (0..9).map(|i| car(if i % 2 == 0 { 0.0 } else { 0.01 * f64::from(i) }, 0.0)).collect();
    let manoeuvre = driving(12.0, Controls::default(), 1.0);
    let runs: Vec<SimulationRun<'_>> =
        cars.iter().map(|vehicle| SimulationRun { vehicle, manoeuvre: &manoeuvre }).collect();
    for (vehicle, got) in cars.iter().zip(simulate_batch(&runs)) {
        assert!(got == vehicle.simulate(&manoeuvre, Integrator::Rk4), "{:?}", vehicle.slope);
    }
    assert_eq!(cars[0], Preset::Reference.parameters());
}

#[test]
fn a_slope_survives_another_mass_and_other_draws() {
    let sheet = crate::vehicle::LibraryVehicle::ALL[0].parameters();
    for vehicle in [sheet, Preset::Reference.parameters()] {
        let slope = RoadSlope { grade: 0.04, cross_slope: -0.01 };
        let vehicle = vehicle.on_slope(slope);
        assert_eq!(vehicle.drawn(&[0.5]).slope, slope);
        assert_eq!(vehicle.with_friction(0.5).with_mass(1700.0, None).slope, slope);
    }
}

#[test]
fn a_section_is_read_in_ratios_or_percent_and_refused_with_its_range() {
    let read = |text: &str| -> Result<RoadSlope, TomlError> {
        let file = TomlFile { path: Path::new("s.toml"), text };
        let root = file.parse()?;
        RoadSlope::read(TomlTable::root(file, &root))
    };
    let slope = read("grade_percent = 5\ncross_slope = -0.02").unwrap();
    assert_eq!(slope, RoadSlope { grade: 0.05, cross_slope: -0.02 });
    for (text, expected) in [
        ("", "grade (or cross_slope) is missing"),
        ("grade_percent = 40", "grade_percent is 40, expected "),
        ("grade = 0.1\nsteep = 1", "steep is not known here"),
    ] {
        let error = read(text).unwrap_err().to_string();
        assert!(error.contains(expected), "{text}: {error}");
    }
}
