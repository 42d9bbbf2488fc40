//! Forecasts of the struck vehicle, with the shipped network.

use std::f64::consts::FRAC_PI_2;
use std::ops::ControlFlow;

use super::*;
use crate::analysis::MotionBands;
use crate::{Event, ForceSource, Library, MotionSource, PredictMotionRequest, Question};
use impactlab_core::data::Sampling;
use impactlab_core::vehicle::{DataSheet, Preset, SheetQuantity};
use impactlab_networks::response::{RESISTANCE_SCATTER, RestSearch, SettledMotion};
use impactlab_networks::shipped::ModelSource;

/// The forecast of a car that is pushed to the side at its rear, by forces of 16 to 24 kN.
fn pushed(n_forces: usize) -> MotionForecast {
    pushed_car(Preset::Reference.parameters(), n_forces, 0)
}

/// The same of some car.
fn pushed_car(vehicle: VehicleParameters, n_forces: usize, n_vehicles: usize) -> MotionForecast {
    let force = |i: usize| ForceHistory {
        axes: ForceAxes::World,
        sampling: Sampling::Instant,
        time_s: vec![0.0, 0.05, 0.1],
        fx_n: vec![0.0; 3],
        fy_n: vec![0.0, 16e3 + 8e3 * (i as f64 + 0.5) / n_forces as f64, 0.0],
        mz_n_m: None,
    };
    let struck = StruckVehicle {
        vehicle,
        initial: VehicleState::driving_straight(15.0),
        contact: ContactPoint { x_body_m: -1.5, y_body_m: -0.8, height_m: 0.5 },
        controls: Controls::default(),
        friction_zones: Vec::new(),
    };
    let settings = MotionForecastSettings {
        n_curves: n_forces,
        n_vehicles,
        duration_s: 2.0,
        until_rest: false,
        road: None,
        seed: 1,
    };
    let forces: Vec<ForceHistory> = (0..n_forces).map(force).collect();
    let model = ModelSource::Shipped.response_model().unwrap();
    forecast_forces(&forces, &model, &struck, &settings).unwrap()
}

#[test]
fn several_motions_under_each_force_say_what_one_under_each_of_many_says() {
    let [few, many] = [60, 240].map(pushed);
    let end = few.distribution.n_instants() - 1;
    assert_eq!(many.distribution.n_instants() - 1, end);
    let planar = |forecast: &MotionForecast| forecast.distribution.mean(end).planar();
    let off = planar(&few).into_iter().zip(planar(&many));
    let covariances = [&few, &many].map(|forecast| forecast.distribution.covariance(end));
    for (axis, (few, many)) in off.enumerate().take(3) {
        let [of_few, std] = covariances.map(|covariance| covariance[(axis, axis)].sqrt());
        // Four standard errors of the difference of 240 draws each: 0.37 and 0.26 of a deviation.
        assert!((many - few).abs() < 0.37 * std, "{axis}: {few} {many}, deviation {std}");
        assert!((of_few / std - 1.0).abs() < 0.3, "{axis}: deviations {of_few}, {std}");
    }
}

/// “front cornering coefficient 14.36” was told of a car that has another by its sheet: it was that of a draw.
#[test]
fn what_lies_outside_is_told_of_the_car_and_not_of_a_draw() {
    let heavy = DataSheet::default().with(SheetQuantity::Mass, 4500.0).vehicle();
    let [known, drawn] = [0, 20].map(|n| pushed_car(heavy.clone(), 1, n));
    assert_eq!((known.n_vehicles, drawn.n_vehicles), (0, 20));
    assert!(!known.applicability.outside.is_empty());
    assert_eq!(drawn.applicability.outside, known.applicability.outside);
}

#[test]
fn bands_end_with_the_intervals_of_the_outcome() {
    let MotionForecast { distribution, outcome, .. } = pushed(5);
    let bands = MotionBands::new(&distribution, 50);
    let [x_m, y_m, ..] = *bands.intervals.last().unwrap();
    assert_eq!(x_m, [outcome.x_m.ninety(), outcome.x_m.half()]);
    assert_eq!(y_m, [outcome.y_m.ninety(), outcome.y_m.half()]);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let [one, many] = [1, 3].map(|n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| pushed(7))
    });
    assert_eq!(one.distribution, many.distribution);
    assert_eq!((one.outcome, one.paths), (many.outcome, many.paths));
}

/// A stable car far outside of what the network learned from. By the unscented transform of its state it
/// turned with a probability of 1e-8.
#[test]
fn a_car_that_spins_in_few_motions_does_so_as_often_as_in_many_more() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets/fea-road");
    let source = MotionSource::Case { dataset: root, case: "d002".to_owned() };
    let mut request = PredictMotionRequest::new(source, ForceSource::Given);
    request.motion.vehicle_draws = Some(0);
    let mut go_on = |_: Event<'_>| ControlFlow::Continue(());
    let answer = request.answer(&Library::default(), &mut go_on).unwrap().complete().unwrap();
    let (struck, force) = (answer.analysis.struck.unwrap(), &answer.forecast.forces[0]);
    let inputs = struck.inputs(force, request.motion.duration_s).unwrap();
    let predictor =
        ModelSource::Shipped.response_model().unwrap().predictor(&struck.vehicle).unwrap();
    let search = RestSearch { seed: 1, resistance_scatter: RESISTANCE_SCATTER };
    let numbers: Vec<usize> = (0..2000).collect();
    let many = predictor.settled(&struck.initial, &inputs, &numbers, &search).draws;
    let has_turned = |motion: &&SettledMotion| {
        let end_rad = motion.states.last().unwrap().yaw_rad;
        (end_rad - struck.initial.yaw_rad).abs() >= FRAC_PI_2
    };
    let expected = many.iter().filter(has_turned).count() as f64 / 2000.0;
    let share = answer.forecast.outcome.p_quarter_turn.unwrap();
    let error = (expected * (1.0 - expected) * (1.0 / 240.0 + 1.0 / 2000.0)).sqrt();
    assert!(share > 0.0 && expected > 0.01, "{share} {expected}");
    assert!((share - expected).abs() < 4.0 * error, "{share} {expected}");
}

#[test]
fn a_force_is_turned_into_world_axes() {
    let curve = ForceCurve { fx_n: vec![0.0; 250], fy_n: vec![1e3; 250], duration_s: 0.1 };
    let history = in_world(&curve, std::f64::consts::FRAC_PI_2);
    assert!((history.fx_n[3] + 1e3).abs() < 1e-9 && history.fy_n[3].abs() < 1e-9);
}

/// A ripple of 1.3 % of the peak counted as contact up to the end of the grid, at 0.25 s.
#[test]
fn a_drawn_pulse_ends_with_its_duration() {
    let fx_n = vec![0.0, 3e3, 1e3, 40.0, -40.0];
    let pulse = ForceCurve { fx_n, fy_n: vec![10.0; 5], duration_s: 0.003 };
    let ended = ended(&pulse);
    assert_eq!(ended.fx_n, [0.0, 3e3, 1e3, 0.0, 0.0]);
    assert_eq!(ended.fy_n, [10.0, 10.0, 10.0, 0.0, 0.0]);
}
