use crate::data::{Channel, ForceAxes, ForceHistory, Sampling};
use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::{
    Braking, ContactLoad, ContactPoint, Controls, Ending, FrictionZone, FrictionZoneError,
    HeldSteer, Integrator, Manoeuvre, Motion, PathEnd, PathLimit, Preset, SimulationError,
    SimulationRun, VehicleParameters, VehicleState, WheelEffort, WheelHistory, simulate_paths,
};

fn zone([x0, y0]: [f64; 2], [x1, y1]: [f64; 2], friction: f64) -> FrictionZone {
    let border_m = vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
    FrictionZone { name: "zone".to_owned(), border_m, friction }
}

/// Friction of 0.1 wherever the cars of these tests go.
fn ice() -> FrictionZone {
    zone([-1e3, -1e3], [1e3, 1e3], 0.1)
}

fn all_locked() -> Controls {
    let wheels = vec![[WheelEffort { locked: 1.0, ..WheelEffort::none() }; 4]];
    Controls { wheels: Some(WheelHistory { time_s: vec![0.0], wheels }), ..Controls::default() }
}

fn locked_from(speed_m_s: f64, friction_zones: Vec<FrictionZone>) -> Manoeuvre {
    Manoeuvre {
        initial: VehicleState::driving_straight(speed_m_s),
        controls: all_locked(),
        duration_s: 30.0,
        ends_at_rest: true,
        friction_zones,
        ..Manoeuvre::default()
    }
}

fn simulate(vehicle: &VehicleParameters, manoeuvre: &Manoeuvre) -> Motion {
    vehicle.simulate(manoeuvre, Integrator::Rk4).unwrap()
}

fn end(motion: &Motion, channel: Channel) -> f64 {
    *motion.series.require(channel).unwrap().last().unwrap()
}

#[test]
fn wholly_on_ice_a_car_moves_as_on_a_road_with_that_friction() {
    let vehicle = Preset::Reference.parameters();
    let steer = Some(HeldSteer { start_s: 0.2, rise_s: 0.3, road_wheel_rad: 0.08 });
    let turning = Ending { steer, ..Ending::default() }.controls(&vehicle);
    for controls in [all_locked(), turning] {
        let on_zone = Manoeuvre { controls, ..locked_from(20.0, vec![ice()]) };
        let on_road = Manoeuvre { friction_zones: Vec::new(), ..on_zone.clone() };
        let got = simulate(&vehicle, &on_zone);
        let expected = simulate(&vehicle.clone().with_friction(0.1), &on_road);
        assert_eq!(got.series.n_samples(), expected.series.n_samples());
        for channel in [Channel::X, Channel::Y, Channel::Yaw] {
            let (got, expected) = (end(&got, channel), end(&expected, channel));
            assert!((got - expected).abs() < 1e-6, "{channel:?}: {got} against {expected}");
        }
    }
}

#[test]
fn with_its_left_wheels_on_ice_a_braked_car_turns_to_the_right() {
    let vehicle = Preset::Reference.parameters();
    for (on_ice, sign) in [([0.0, 50.0], -1.0), ([-50.0, 0.0], 1.0)] {
        let side = zone([-10.0, on_ice[0]], [300.0, on_ice[1]], 0.1);
        let manoeuvre = Manoeuvre { duration_s: 0.5, ..locked_from(20.0, vec![side]) };
        let yaw_rad = end(&simulate(&vehicle, &manoeuvre), Channel::Yaw);
        assert!(sign * yaw_rad > 0.1, "ice from y = {on_ice:?}: yaw of {yaw_rad} rad");
    }
}

/// The energy of the car is the work of the road: over the way before the front wheels reach the
/// border, over the wheelbase between front and rear wheels, and after it. The loads of the axles
/// follow from the deceleration a: F_front = m (g l_r + h a)/(l_f + l_r).
#[test]
fn a_locked_stop_across_a_border_is_as_long_as_the_energy_says() {
    let vehicle = Preset::Reference.parameters();
    let (tires, geometry) = (vehicle.tires, &vehicle.geometry);
    let sliding = tires.sliding_friction_ratio * tires.longitudinal_friction_ratio;
    let (lf, lr, h) =
        (geometry.cg_to_front_axle_m, geometry.cg_to_rear_axle_m, geometry.cg_height_m);
    let g = STANDARD_GRAVITY_M_S2;
    for (friction, border_m) in [(0.2, 12.0), (1.1, 18.0)] {
        let manoeuvre = locked_from(25.0, vec![zone([border_m, -9.0], [500.0, 9.0], friction)]);
        let motion = simulate(&vehicle, &manoeuvre);
        assert!(motion.rest_s.is_some());
        let [before, after] = [tires.friction, friction].map(|friction| friction * sliding);
        let between = g * (after * lr + before * lf) / (lf + lr - h * (after - before));
        let energy = 25.0_f64.powi(2) / 2.0 - before * g * (border_m - lf) - between * (lf + lr);
        let expected = border_m + lr + energy / (after * g);
        let got = end(&motion, Channel::X);
        assert!((got / expected - 1.0).abs() < 2e-3, "μ {friction}: {got} m, expected {expected}");
    }
}

fn struck() -> ContactLoad {
    let time_s: Vec<f64> = (0..12).map(|i| f64::from(i) * 0.01).collect();
    let force = ForceHistory {
        axes: ForceAxes::World,
        sampling: Sampling::Instant,
        fx_n: vec![1e4; 12],
        fy_n: vec![4e4; 12],
        mz_n_m: None,
        time_s,
    };
    let contact = ContactPoint { x_body_m: -1.6, y_body_m: -0.8, height_m: 0.5 };
    ContactLoad { force, contact, recorded_moment: false }
}

#[test]
fn a_zone_where_no_wheel_comes_changes_no_bit() {
    let vehicle = Preset::Reference.parameters();
    let brake = Some(Braking::new(0.3, 1.4, 0.2));
    for ending in [Ending::default(), Ending { brake, ..Ending::default() }] {
        let without = Manoeuvre {
            contact_load: Some(struck()),
            controls: ending.controls(&vehicle),
            ..locked_from(20.0, Vec::new())
        };
        let elsewhere = zone([900.0, 900.0], [910.0, 910.0], 0.1);
        let with = Manoeuvre { friction_zones: vec![elsewhere], ..without.clone() };
        assert!(simulate(&vehicle, &with) == simulate(&vehicle, &without));
    }
}

#[test]
fn paths_side_by_side_know_the_zones() {
    let vehicle = Preset::Reference.parameters();
    let zones = [Vec::new(), vec![ice()], vec![zone([15.0, -9.0], [500.0, 0.0], 0.2)]];
    let manoeuvres = zones.map(|zones| locked_from(15.0, zones));
    let runs: Vec<SimulationRun<'_>> =
        manoeuvres.iter().map(|manoeuvre| SimulationRun { vehicle: &vehicle, manoeuvre }).collect();
    let limit = PathLimit { distance_m: 1e3 };
    let ends = simulate_paths(&runs, limit, |_, path| (path.end, path.points.last().copied()));
    for ((path_end, last), manoeuvre) in ends.into_iter().zip(&manoeuvres) {
        assert_eq!(path_end, PathEnd::Rest);
        let (last, motion) = (last.unwrap(), simulate(&vehicle, manoeuvre));
        for (got, channel, most) in [
            (last.x_m, Channel::X, 0.1),
            (last.y_m, Channel::Y, 0.1),
            (last.yaw_rad, Channel::Yaw, 0.02),
        ] {
            let expected = end(&motion, channel);
            assert!((got - expected).abs() < most, "{channel:?}: {got} against {expected}");
        }
    }
}

#[test]
fn a_zone_that_is_none_gives_no_motion() {
    let vehicle = Preset::Reference.parameters();
    let manoeuvre = locked_from(15.0, vec![zone([0.0, 0.0], [1.0, 1.0], 7.0)]);
    let error = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap_err();
    assert!(
        matches!(error, SimulationError::FrictionZone(FrictionZoneError::Friction { .. })),
        "{error}"
    );
    let run = SimulationRun { vehicle: &vehicle, manoeuvre: &manoeuvre };
    let ends = simulate_paths(&[run], PathLimit { distance_m: 1e3 }, |_, path| path.end);
    assert_eq!(ends, [PathEnd::Failed]);
}

#[test]
fn a_zone_that_the_car_never_reaches_changes_nothing() {
    let vehicle = Preset::Reference.parameters();
    let far = zone([900.0, 900.0], [950.0, 950.0], 0.1);
    let [bare, with_zone] = [vec![], vec![far]].map(|zones| locked_from(20.0, zones));
    let limit = PathLimit { distance_m: f64::INFINITY };
    let runs = [&bare, &with_zone].map(|manoeuvre| SimulationRun { vehicle: &vehicle, manoeuvre });
    let paths = simulate_paths(&runs, limit, |_, path| path);
    assert_eq!(paths[0], paths[1]);
}
