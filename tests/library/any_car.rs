//! Cars that the shipped response network has not learned from, and inputs far from what it knows.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::collision::{ContactLocation, Scenario, Side};
use impactlab_core::data::{Channel, Outcome};
use impactlab_core::uncertainty::CaveatKind;
use impactlab_core::vehicle::sheet::{SheetQuantity, VehicleClass};
use impactlab_core::vehicle::{
    CollisionForce, ContactPoint, DataSheet, VehicleInput, VehicleParameters, VehicleState,
    WheelEffort,
};
use impactlab_networks::learning::{LearningError, TEST_SHARE, TrainingSet};
use impactlab_networks::response::evaluate::{
    ComparisonSettings, MotionModelKind, compare_on_unseen_cars,
};
use impactlab_networks::response::{
    ResponseCase, ResponseModel, ResponseTrainingSet, STEP_S, TuningConfig, average_error_m,
    condition, rollout,
};
use impactlab_networks::shipped::ModelSource;
use impactlab_study::analysis::PulseSetup;
use impactlab_study::{
    Answer, Event, ForceSource, Library, MotionSource, PredictMotionReport, PredictMotionRequest,
    Question, ScenarioChoice, StudyError,
};
use proptest::prelude::*;

fn shipped() -> ResponseModel {
    ModelSource::Shipped.response_model().expect("the shipped network")
}

fn load(folder: &str) -> Vec<ResponseCase> {
    let mut go_on = |_| ControlFlow::Continue(());
    match ResponseCase::load_all(Path::new(folder), None, &mut go_on).expect("a data set") {
        Outcome::Complete(cases) => cases,
        Outcome::Cancelled => panic!("nothing cancels"),
    }
}

/// A push of a tenth of a second at the rear quarter.
pub(crate) fn struck(
    delta_v_m_s: [f64; 2],
    vehicle: &VehicleParameters,
    n_steps: usize,
) -> Vec<VehicleInput<f64>> {
    let contact = ContactPoint {
        x_body_m: -vehicle.geometry.cg_to_rear_axle_m,
        y_body_m: -vehicle.geometry.outer_width_m / 2.0,
        height_m: 0.5,
    };
    struck_at(contact, delta_v_m_s, vehicle, n_steps)
}

/// The middle of a face of a car, or a point of it away from the middle, and the direction into it.
///
/// - `face`: front, left, rear, right;
/// - `place`: from −1 to 1 along it.
fn point_of(vehicle: &VehicleParameters, face: usize, place: f64) -> (ContactPoint, [f64; 2]) {
    let geometry = &vehicle.geometry;
    let half = [geometry.outer_length_m / 2.0, geometry.outer_width_m / 2.0];
    let ([x, y], inwards) = match face {
        0 => ([half[0], place * half[1]], [-1.0, 0.0]),
        1 => ([place * half[0], half[1]], [0.0, -1.0]),
        2 => ([-half[0], place * half[1]], [1.0, 0.0]),
        _ => ([place * half[0], -half[1]], [0.0, 1.0]),
    };
    (ContactPoint { x_body_m: x, y_body_m: y, height_m: 0.5 }, inwards)
}

/// A push of a tenth of a second at a point.
fn struck_at(
    contact: ContactPoint,
    delta_v_m_s: [f64; 2],
    vehicle: &VehicleParameters,
    n_steps: usize,
) -> Vec<VehicleInput<f64>> {
    let n_struck = 10;
    let force_n = delta_v_m_s.map(|dv| dv * vehicle.mass.mass_kg / (n_struck as f64 * STEP_S));
    let collision = CollisionForce { force_n, in_world_axes: false, yaw_moment_n_m: None, contact };
    let input = |i| VehicleInput {
        collision: (i < n_struck).then_some(collision),
        ..VehicleInput::released()
    };
    (0..n_steps).map(input).collect()
}

pub(crate) fn car(mass_kg: f64, friction: f64) -> VehicleParameters {
    DataSheet::new("drawn", VehicleClass::Any)
        .with(SheetQuantity::Mass, mass_kg)
        .vehicle()
        .with_friction(friction)
}

/// Area of the standard ellipse of the position at the end, m², and the mean end.
pub(crate) fn end(
    model: &ResponseModel,
    (vehicle, initial, inputs): (&VehicleParameters, &VehicleState<f64>, &[VehicleInput<f64>]),
) -> (f64, VehicleState<f64>) {
    let motion = model.predictor(vehicle).expect("a predictor").forecast(initial, inputs);
    let covariance = motion.covariance(inputs.len());
    let area = covariance[(0, 0)] * covariance[(1, 1)] - covariance[(0, 1)].powi(2);
    (area.max(0.0).sqrt(), motion.mean(inputs.len()))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn nothing_within_the_ranges_diverges_or_is_answered_without_a_word(
        mass_kg in 700.0..4000.0_f64, speed_m_s in 0.0..70.0_f64, friction in 0.05..1.2_f64,
        push_m_s in 0.5..20.0_f64, oblique in -0.8..0.8_f64, yaw_rate_rad_s in -1.0..1.0_f64,
        face in 0..4_usize, place in -1.0..1.0_f64, brakes in any::<bool>(),
    ) {
        let model = shipped();
        let vehicle = car(mass_kg, friction);
        let initial = VehicleState { yaw_rate_rad_s, ..VehicleState::driving_straight(speed_m_s) };
        let (contact, [nx, ny]) = point_of(&vehicle, face, place);
        let push = [push_m_s * (nx - oblique * ny), push_m_s * (ny + oblique * nx)];
        let mut inputs = struck_at(contact, push, &vehicle, 200);
        if brakes {
            let braking_n = 0.2 * friction * mass_kg * 9.81;
            let wheels = [WheelEffort { braking_n, ..WheelEffort::none() }; 4];
            inputs.iter_mut().for_each(|input| input.wheels = Some(wheels));
        }
        let predictor = model.predictor(&vehicle).expect("a predictor");
        let (area, mean) = end(&model, (&vehicle, &initial, &inputs));
        prop_assert!(area.is_finite() && area > 0.0, "{area}");
        prop_assert!(mean.to_array().iter().all(|value| value.is_finite()), "{mean:?}");
        let path = predictor.central_path(&initial, &inputs);
        // After the force nothing gains energy.
        let energy = |x: &VehicleState<f64>| {
            let mass = &vehicle.mass;
            mass.mass_kg * (x.vx_body_m_s.powi(2) + x.vy_body_m_s.powi(2))
                + mass.yaw_inertia_kg_m2 * x.yaw_rate_rad_s.powi(2)
        };
        for pair in path[12..].windows(2) {
            prop_assert!(energy(&pair[1]) <= energy(&pair[0]) * (1.0 + 1e-9) + 1e-6);
        }
        let of = predictor.applicability(&initial, &inputs);
        prop_assert_eq!(of.value < 1.0, !of.outside.is_empty());
        let is_slick = friction < 0.19;
        let is_named = |name: &str| of.outside.iter().any(|outside| outside.quantity == name);
        prop_assert!(!is_slick || is_named("friction"), "{of:?}");
        prop_assert!(speed_m_s < 47.0 || is_named("speed [m/s]"), "{of:?}");
        prop_assert!(mass_kg < 3000.0 || is_named("mass [kg]"), "{of:?}");
        prop_assert!(push_m_s < 12.0 || is_named("velocity change by the impact [m/s]"), "{of:?}");
        // Far outside the bands are as wide as what a tenth of the grip, or of the impulse, does.
        if of.value < 0.05 {
            let end_of = |vehicle: &VehicleParameters, share: f64| {
                let mut inputs = inputs.clone();
                for collision in inputs.iter_mut().filter_map(|input| input.collision.as_mut()) {
                    collision.force_n = collision.force_n.map(|force_n| force_n * share);
                }
                let states = rollout(vehicle, initial, &inputs, [0.0; 4]);
                states.last().map(|x| [x.x_m, x.y_m]).expect("an end")
            };
            let here = end_of(&vehicle, 1.0);
            let away = |[x, y]: [f64; 2]| (x - here[0]).hypot(y - here[1]);
            let slicker = end_of(&vehicle.clone().with_friction(0.9 * friction), 1.0);
            let off_m = away(slicker).min(away(end_of(&vehicle, 1.1)));
            let motion = predictor.forecast(&initial, &inputs);
            let covariance = motion.covariance(inputs.len());
            let std_m = (covariance[(0, 0)] + covariance[(1, 1)]).sqrt();
            prop_assert!(std_m > 0.25 * off_m, "{std_m} m where the physics is off by {off_m} m");
        }
    }
}

#[test]
fn far_outside_only_the_physics_is_left_and_the_bands_are_wider() {
    let model = shipped();
    let initial = VehicleState::driving_straight(20.0);
    let known = car(1500.0, 0.7);
    let slick = car(4000.0, 0.05);
    let [near, far] = [&known, &slick].map(|vehicle| {
        let inputs = struck([0.5, 2.0], vehicle, 300);
        let (area, _) = end(&model, (vehicle, &initial, &inputs));
        let path = model.predictor(vehicle).unwrap().central_path(&initial, &inputs);
        let physics = rollout(vehicle, initial, &inputs, [0.0; 4]);
        (area, average_error_m(&path, &physics))
    });
    assert!(far.1 < 0.1, "{} m from the 4DOF model", far.1);
    assert!(near.1 > 0.2, "{} m from the 4DOF model", near.1);
    // On ice the tires hardly matter; of a heavy car nothing is known of them on any road.
    let of = |mass_kg: f64| {
        let vehicle = car(mass_kg, 0.7);
        let inputs = struck([0.5, 2.0], &vehicle, 300);
        end(&model, (&vehicle, &initial, &inputs)).0
    };
    assert!(of(4000.0) > of(2000.0), "{} {}", of(4000.0), of(2000.0));
}

#[test]
fn trajectories_of_a_car_narrow_its_bands_and_leave_other_cars_alone() {
    let model = shipped();
    let cases = load("datasets/trajectories-fleet/van");
    // As another car, of which the network knows nothing.
    let cases: Vec<ResponseCase> = cases
        .into_iter()
        .map(|mut case| {
            case.vehicle.mass.yaw_inertia_kg_m2 *= 1.001;
            case.digest = format!("other {}", case.digest);
            case
        })
        .collect();
    let set = TrainingSet::from_split("van".to_owned(), &cases, 0, TEST_SHARE);
    let set = set.choose(Some(3), 0).expect("three trajectories");
    let conditioned = condition(&model, &set).expect("a conditioned network");
    let known = conditioned.known_car(&cases[0].vehicle).expect("a known car");
    assert_eq!(known.n_trajectories, 3);
    let unseen =
        cases.iter().find(|case| !conditioned.is_trained_on(case)).expect("another trajectory");
    let n = unseen.inputs.len().min(300);
    let ask = |model: &ResponseModel| {
        end(model, (&unseen.vehicle, &unseen.states[0], &unseen.inputs[..n])).0
    };
    assert!(ask(&conditioned) < ask(&model), "{} {}", ask(&conditioned), ask(&model));
    let other = car(1500.0, 0.7);
    let inputs = struck([0.5, 2.0], &other, 100);
    let initial = VehicleState::driving_straight(20.0);
    let of = |model: &ResponseModel| end(model, (&other, &initial, &inputs));
    assert_eq!(of(&conditioned), of(&model));
    // The same trajectories say nothing twice.
    let again = condition(&conditioned, &set).unwrap_err();
    assert!(matches!(again, LearningError::NothingNew), "{again}");
}

/// Before, a network that knew the cars was trained once more and then said to have seen none of them.
#[test]
fn a_network_that_knows_cars_is_compared_on_new_ones_as_it_is() {
    let model = shipped();
    let mut config = model.config().clone();
    config.tuning = TuningConfig { particles: 4, iterations: 2, ..config.tuning };
    let settings = ComparisonSettings { config, trajectories: vec![1], n_choices: 1, seed: 0 };
    let compare = |folders: &[&str]| {
        let (name, train) = (String::new(), folders.iter().copied().flat_map(load).collect());
        let set = ResponseTrainingSet { name, train, test: Vec::new() };
        compare_on_unseen_cars(&set, &model, &settings, &mut |_| ControlFlow::Continue(()))
    };
    let new =
        ["car-005", "car-008"].map(|car| format!("datasets/trajectories-cars-held-out/{car}"));
    let new = compare(&new.each_ref().map(String::as_str)).expect("answers");
    let new = new.expect("nothing cancels");
    let mut asked: Vec<(MotionModelKind, usize)> =
        new.models.iter().map(|of| (of.kind, of.trajectories)).collect();
    asked.sort_by_key(|(kind, n)| (*n, *kind));
    let [untuned, tuned, network] =
        [MotionModelKind::Untuned, MotionModelKind::Tuned, MotionModelKind::Network];
    assert_eq!(asked, [(untuned, 0), (network, 0), (tuned, 1), (network, 1)]);
    // Clusters of one car are not those of all: a row stood in another one than its motion.
    for row in &new.cases {
        let of_case = new.test.iter().find(|case| case.name == row.case).expect("a motion");
        assert_eq!(row.cluster, of_case.cluster, "{}", row.case);
    }
    let seen = compare(&["datasets/trajectories-fleet/van"]).unwrap_err();
    assert!(matches!(seen, LearningError::SeenCar { .. }), "{seen}");
}

/// Two cars that meet anywhere, as the command line asks about them.
fn scenario(
    [struck_kg, striking_kg]: [f64; 2],
    [struck_m_s, striking_m_s]: [f64; 2],
    (side, place, angle_rad): (Side, f64, f64),
) -> Scenario {
    let mut scenario = Scenario::example();
    let outwards_rad = match side {
        Side::Front => 0.0,
        Side::Left => FRAC_PI_2,
        Side::Rear => PI,
        Side::Right => -FRAC_PI_2,
    };
    let half_m = match side {
        Side::Front | Side::Rear => scenario.struck.width_m / 2.0,
        Side::Left | Side::Right => scenario.struck.length_m / 2.0,
    };
    // The striking vehicle heads for the side, up to some angle off its normal.
    let heading_rad = outwards_rad + PI + angle_rad;
    for (vehicle, mass_kg, speed_m_s, heading_rad) in [
        (&mut scenario.struck, struck_kg, struck_m_s, 0.0),
        (&mut scenario.striking, striking_kg, striking_m_s, heading_rad),
    ] {
        (vehicle.mass_kg, vehicle.yaw_inertia_kg_m2) = (mass_kg, 1.8 * mass_kg);
        vehicle.heading_rad = heading_rad;
        vehicle.vx_world_m_s = speed_m_s * heading_rad.cos();
        vehicle.vy_world_m_s = speed_m_s * heading_rad.sin();
    }
    scenario.contact.location = ContactLocation::Side { side, offset_m: 0.9 * place * half_m };
    scenario
}

/// The forecast of a scenario with one drawn force.
fn forecast(
    scenario: Scenario,
    friction: f64,
    until_rest: bool,
) -> Result<Answer<PredictMotionReport>, StudyError> {
    let scenario = ScenarioChoice::Inline(Box::new(scenario));
    let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
    let shipped = ForceSource::Predicted(ModelSource::Shipped.into());
    let mut request = PredictMotionRequest::new(source, shipped);
    (request.draws, request.motion.vehicle_draws) = (2, Some(2));
    request.motion.friction = Some(friction);
    (request.motion.duration_s, request.motion.until_rest) = (3.0, until_rest);
    let mut go_on = |_: Event<'_>| ControlFlow::Continue(());
    let answer = request.answer(&Library::default(), &mut go_on)?;
    Ok(answer.complete().expect("nothing cancels").report)
}

/// At 288 km/h the car turns nearly three times within 4 s, nobody knows how often exactly.
#[test]
fn a_car_that_spins_fast_goes_where_the_physics_takes_it() {
    let mut fast = Scenario::example();
    for (vehicle, speed_m_s) in [(&mut fast.struck, 80.0), (&mut fast.striking, 296.0 / 3.6)] {
        let (sin, cos) = vehicle.heading_rad.sin_cos();
        (vehicle.vx_world_m_s, vehicle.vy_world_m_s) = (speed_m_s * cos, speed_m_s * sin);
    }
    let scenario = ScenarioChoice::Inline(Box::new(fast));
    let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
    let request = PredictMotionRequest::new(source, ForceSource::Given);
    let mut go_on = |_: Event<'_>| ControlFlow::Continue(());
    let answer = request.answer(&Library::default(), &mut go_on).expect("an answer");
    let answer = answer.complete().expect("nothing cancels");
    let series = &answer.analysis.simulation.expect("a simulation").series;
    let x = series.require(Channel::X).expect("x").last().copied().expect("an end");
    let [low, high] = answer.report.outcome.x_m.ninety();
    assert!((low..high).contains(&x) && high - low < 60.0, "{x} {:?}", answer.report.outcome);
    assert_eq!(answer.forecast.distribution.n_instants(), 401);
    assert!(answer.report.applicability < 0.05 && answer.report.rest.is_none());
}

/// The shipped barrier, 57 km/h of Δv, ended in "the predicted motion diverges".
#[test]
fn a_hard_frontal_crash_is_answered_with_wide_bands_and_a_warning() {
    let text = std::fs::read_to_string("assets/scenarios/carpenter_welcher_barrier.toml");
    let path = Path::new("barrier.toml");
    let barrier = Scenario::from_toml(&text.expect("the scenario"), path).expect("a scenario");
    let report = forecast(barrier, 0.8, false).expect("an answer");
    let [low, high] = report.outcome.x_m.ninety();
    assert!(high - low > 2.0, "{:?}", report.outcome);
    let named = |quantity: &str| {
        report.caveats.iter().any(|caveat| caveat.quantity.as_deref() == Some(quantity))
    };
    assert!(named("velocity change by the impact [m/s]"), "{:?}", report.caveats);
    assert!(report.applicability < 0.1 && report.force_applicability.is_some_and(|of| of < 0.1));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn every_scenario_within_the_ranges_is_answered_or_refused_by_its_name(
        masses_kg in prop::array::uniform2(700.0..4000.0_f64),
        speeds_m_s in prop::array::uniform2(0.0..70.0_f64),
        friction in 0.05..1.2_f64, angle_rad in -1.2..1.2_f64, place in -1.0..1.0_f64,
        side in prop::sample::select(vec![Side::Front, Side::Left, Side::Rear, Side::Right]),
        until_rest in any::<bool>(),
    ) {
        let scenario = scenario(masses_kg, speeds_m_s, (side, place, angle_rad));
        // Two that do not approach each other where they touch have no impact.
        prop_assume!(scenario.impact().is_ok());
        let report = forecast(scenario, friction, until_rest);
        let report = report.map_err(|error| TestCaseError::fail(error.to_string()))?;
        match report.outcome.x_m.interval(0.9) {
            Some([low, high]) => {
                prop_assert!(report.is_end_known() && low < high, "{:?}", report.outcome);
            }
            None => prop_assert!(!report.is_end_known(), "{:?}", report.outcome),
        }
        let is_outside = report.applicability < 1.0
            || report.force_applicability.is_some_and(|of| of < 1.0);
        let has_caveat = report.caveats.has(CaveatKind::OutsideDomain);
        prop_assert!(!is_outside || has_caveat, "{:?}", report.caveats);
        prop_assert_eq!(report.rest.is_some(), until_rest);
    }
}
