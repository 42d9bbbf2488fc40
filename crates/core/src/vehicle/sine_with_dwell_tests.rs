use super::*;
use crate::vehicle::{Preset, USUAL_STEERING_RATIO, angle_at_third_g_rad};

/// The reference car with tires of the rear axle that are as soft as they make it oversteer.
fn oversteering() -> VehicleParameters {
    let mut vehicle = Preset::Reference.parameters();
    vehicle.tires.cornering_coefficient_rear_per_rad *= 0.8;
    vehicle
}

fn series(vehicle: &VehicleParameters) -> (f64, Vec<f64>) {
    let angle_rad = angle_at_third_g_rad(vehicle);
    assert!(angle_rad > 0.0);
    (angle_rad, sine_with_dwell_amplitudes_rad(angle_rad, USUAL_STEERING_RATIO))
}

/// FMVSS 126: an oversteering car fails without stability control and passes with it, to either side.
#[test]
fn an_oversteering_car_passes_the_standard_with_stability_control_alone() {
    let vehicle = oversteering();
    let (angle_rad, amplitudes) = series(&vehicle);
    let largest_deg = (amplitudes.last().unwrap() * USUAL_STEERING_RATIO).to_degrees();
    assert!((largest_deg - 270.0).abs() < 1e-9, "{largest_deg}");
    let outcome = |amplitude, esc| sine_with_dwell_outcome(&vehicle, amplitude, esc).unwrap();
    let mut n_failed = 0;
    for &amplitude in &amplitudes {
        let alone = outcome(amplitude, None);
        n_failed += usize::from(!alone.is_stable());
        for amplitude in [amplitude, -amplitude] {
            let controlled = outcome(amplitude, Some(StabilityControl::default()));
            assert!(controlled.is_stable(), "{amplitude} rad: {controlled:?}");
            let counts = amplitude.abs() >= 5.0 * angle_rad - 1e-12;
            assert!(!counts || controlled.is_responsive(), "{amplitude} rad: {controlled:?}");
            assert!(controlled.largest_sideslip_rad < 15_f64.to_radians(), "{controlled:?}");
        }
    }
    assert!(n_failed * 2 > amplitudes.len(), "{n_failed} of {}", amplitudes.len());
    let spun = outcome(*amplitudes.last().unwrap(), None);
    assert!(spun.largest_sideslip_rad > 45_f64.to_radians(), "{spun:?}");
}

/// Systems as they are drawn pass with the largest amplitude, too.
#[test]
fn systems_of_unknown_cars_pass_the_standard() {
    let vehicle = oversteering();
    let amplitude = *series(&vehicle).1.last().unwrap();
    for z in [-1.5, -0.7, 0.7, 1.5] {
        let esc = StabilityControl::default().drawn([z; StabilityControl::N_DRAWN]);
        let outcome = sine_with_dwell_outcome(&vehicle, amplitude, Some(esc)).unwrap();
        assert!(outcome.is_stable() && outcome.is_responsive(), "{z}: {outcome:?}");
    }
}

#[test]
fn the_steering_is_a_sine_with_a_pause_at_its_second_peak() {
    let steer = sine_with_dwell(0.2);
    let at = |time_s: f64| interpolate(&steer.time_s, &steer.steer_rad, time_s).unwrap();
    let period_s = 1.0 / 0.7;
    for (time_s, expected) in [
        (0.0, 0.0),
        (period_s / 4.0, 0.2),
        (period_s / 2.0, 0.0),
        (0.75 * period_s, -0.2),
        (0.75 * period_s + 0.25, -0.2),
        (0.75 * period_s + 0.5, -0.2),
        (period_s + 0.5, 0.0),
        (9.0, 0.0),
    ] {
        assert!((at(time_s) - expected).abs() < 2e-3, "{time_s} s: {}", at(time_s));
    }
    assert_eq!(sine_with_dwell_amplitudes_rad(0.02, 16.0).first(), Some(&0.03));
    // 6.5 A are more than 300° of the steering wheel.
    let last_rad = *sine_with_dwell_amplitudes_rad(0.06, 16.0).last().unwrap();
    assert!((last_rad - 300_f64.to_radians() / 16.0).abs() < 1e-12, "{last_rad}");
}
