//! Drivers and systems in whole motions.

use super::striking_driver::PitState;
use super::*;
use crate::data::Channel;
use crate::units::{Language, NumberFormat, Phrase, UnitSystem};
use crate::vehicle::{
    Braking, Controls, Ending, HeldSteer, Integrator, Manoeuvre, Motion, PathLimit, Preset,
    SimulationRun, SteerHistory, VehicleParameters, VehicleState, WheelEffort, simulate_batch,
    simulate_paths,
};

fn manoeuvre(vehicle: &VehicleParameters, ending: &Ending, x: VehicleState<f64>) -> Manoeuvre {
    Manoeuvre {
        initial: x,
        controls: ending.controls(vehicle),
        duration_s: 8.0,
        ..Manoeuvre::default()
    }
}

fn motion(vehicle: &VehicleParameters, ending: &Ending, x: VehicleState<f64>) -> Motion {
    vehicle.simulate(&manoeuvre(vehicle, ending, x), Integrator::Rk4).unwrap()
}

fn column(motion: &Motion, channel: Channel) -> &[f64] {
    motion.series.require(channel).unwrap()
}

fn last(motion: &Motion, channel: Channel) -> f64 {
    *column(motion, channel).last().unwrap()
}

/// A car that has been pushed at its rear: it turns to the left.
fn pushed(yaw_rate_rad_s: f64) -> VehicleState<f64> {
    VehicleState { yaw_rate_rad_s, vy_body_m_s: -0.5, ..VehicleState::driving_straight(25.0) }
}

fn everything() -> Ending {
    Ending {
        esc: Some(StabilityControl::default()),
        countersteer: Some(Countersteer::default()),
        brake: Some(Braking::new(1.5, 1.3, 0.3)),
        ..Ending::default()
    }
}

#[test]
fn a_mirrored_motion_has_mirrored_drivers() {
    let vehicle = Preset::Reference.parameters();
    let x = pushed(0.9);
    let mirrored =
        VehicleState { yaw_rate_rad_s: -x.yaw_rate_rad_s, vy_body_m_s: -x.vy_body_m_s, ..x };
    let [left, right] = [x, mirrored].map(|x| motion(&vehicle, &everything(), x));
    for channel in [Channel::Y, Channel::Yaw, Channel::YawRate, Channel::SteerFl] {
        let pairs = column(&left, channel).iter().zip(column(&right, channel));
        let difference = pairs.map(|(a, b)| (a + b).abs()).fold(0.0, f64::max);
        assert!(difference < 1e-9, "{channel:?}: {difference}");
    }
    let [left, right] = [&left, &right].map(|motion| {
        motion.applied_controls.as_ref().unwrap().wheels.as_ref().unwrap().wheels.clone()
    });
    let is_braked = |at: &[WheelEffort<f64>; 4]| at[1].braking_n > 100.0 && at[0].braking_n == 0.0;
    assert!(left.iter().any(is_braked), "the outer wheel alone is braked at first");
    for (left, right) in left.iter().zip(&right) {
        assert!((left[0].braking_n - right[1].braking_n).abs() < 1e-6, "{left:?} {right:?}");
        assert!((left[3].braking_n - right[2].braking_n).abs() < 1e-6, "{left:?} {right:?}");
    }
}

#[test]
fn stability_control_leaves_a_stable_car_alone() {
    let vehicle = Preset::Reference.parameters();
    let steer = HeldSteer { start_s: 0.5, rise_s: 0.3, road_wheel_rad: 0.02 };
    let plain = Ending { steer: Some(steer), ..Ending::default() };
    let esc = Ending { esc: Some(StabilityControl::default()), ..plain.clone() };
    let x = VehicleState::driving_straight(28.0);
    let [plain, esc] = [plain, esc].map(|ending| motion(&vehicle, &ending, x));
    assert!(last(&plain, Channel::YawRate).abs() > 0.08, "it turns");
    assert_eq!(esc.applied_controls.as_ref().unwrap().wheels, None);
    assert!((last(&plain, Channel::X) - last(&esc, Channel::X)).abs() < 1e-6);
}

#[test]
fn stability_control_saves_a_car_that_spins_without_it() {
    let vehicle = Preset::Reference.parameters();
    let esc = Ending { esc: Some(StabilityControl::default()), ..Ending::default() };
    // The smallest push after which the car spins by itself.
    let turned = |ending: &Ending, yaw_rate_rad_s: f64| {
        let motion = motion(&vehicle, ending, pushed(yaw_rate_rad_s));
        column(&motion, Channel::Yaw).iter().fold(0.0, |most: f64, yaw| most.max(yaw.abs()))
    };
    let pushes = (5..40).map(|tenths| f64::from(tenths) / 10.0);
    let spins = |push: &f64| turned(&Ending::default(), *push) > 1.5;
    let push = { pushes }.find(spins).unwrap();
    let saved = turned(&esc, push);
    assert!(saved < 1.0, "{saved} rad after {push} rad/s");
    // A system that gives up at once, and one for higher speeds, are none.
    let usual = StabilityControl::default();
    let weak = StabilityControl { gives_up_sideslip_rad: Some(0.0), ..usual };
    let fast = StabilityControl { least_speed_m_s: Some(39.0), ..usual };
    for none in [weak, fast] {
        let turned = turned(&Ending { esc: Some(none), ..Ending::default() }, push);
        assert!(turned > 1.5, "{turned} rad with {none:?}");
    }
}

#[test]
fn a_driver_countersteers_after_the_reaction_and_within_limits() {
    let vehicle = Preset::Reference.parameters();
    let mut turned = Vec::new();
    for delay_s in [0.3, 0.8, 1.5] {
        let driver = Countersteer { delay_s: Some(delay_s), ..Countersteer::default() };
        let ending = Ending { countersteer: Some(driver), ..Ending::default() };
        let motion = motion(&vehicle, &ending, pushed(0.7));
        let steer = column(&motion, Channel::SteerFl);
        let first = steer.iter().position(|rad| *rad != 0.0).unwrap();
        assert_eq!(first, (delay_s * 100.0).round() as usize, "delay {delay_s} s");
        assert!(steer[first] < 0.0, "against the turn to the left");
        let largest_step = 500_f64.to_radians() / 16.0 * 0.01;
        let steps = steer.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        assert!(steps.fold(0.0, f64::max) < largest_step * (1.0 + 1e-9));
        assert!(steer.iter().all(|rad| rad.abs() <= 360_f64.to_radians() / 16.0 + 1e-12));
        turned.push(column(&motion, Channel::Yaw).iter().fold(0.0, |a: f64, b| a.max(b.abs())));
    }
    assert!(turned[0] < 0.8 * turned[1] && turned[1] <= turned[2] + 1e-9, "{turned:?}");
}

#[test]
fn an_anti_lock_system_stops_shorter_than_locked_wheels_and_lets_the_car_be_steered() {
    let mut vehicle = Preset::Reference.parameters();
    vehicle.tires.sliding_friction_ratio = 0.8;
    let steer = HeldSteer { start_s: 0.5, rise_s: 0.3, road_wheel_rad: 0.05 };
    let braked = |abs: Option<AntiLock>| {
        let brake = Braking { abs, ..Braking::new(0.0, 1.5, 0.2) };
        let ending = Ending { brake: Some(brake), steer: Some(steer), ..Ending::default() };
        motion(&vehicle, &ending, VehicleState::driving_straight(25.0))
    };
    let [locked, held] = [None, Some(AntiLock::default())].map(braked);
    let way = |motion: &Motion| last(motion, Channel::X).hypot(last(motion, Channel::Y));
    assert!(last(&held, Channel::Vx).abs() < 0.05, "it stops");
    assert!(way(&held) < 0.95 * way(&locked), "{} {} m", way(&held), way(&locked));
    let [straight, turned] = [&locked, &held].map(|motion| last(motion, Channel::Y));
    assert!(straight.abs() < 0.3 && turned > 1.0, "{straight} {turned} m");
    // v²/(2 · 0.95 μ g), and half of the rise.
    let least_m = 25.0 * 25.0 / (2.0 * 0.95 * vehicle.tires.friction * 9.806_65);
    assert!((least_m * 0.98..least_m * 1.15).contains(&way(&held)), "{} {least_m}", way(&held));
    // An engine brakes on, which the system cannot release.
    let abs = AntiLock::default().acting();
    assert_eq!(abs.allowed_n(5000.0, 800.0, 4000.0, 20.0), 3000.0);
    assert_eq!(abs.allowed_n(5000.0, 4800.0, 4000.0, 20.0), 0.0);
    assert_eq!(abs.allowed_n(5000.0, 0.0, 4000.0, 1.0), 5000.0);
}

#[test]
fn the_driver_of_a_pit_steers_a_pulse_and_keeps_the_speed() {
    let vehicle = Preset::Reference.parameters();
    let driver = PitDriver {
        start_s: Some(-0.1),
        steering_wheel_rad: Some(-2.0),
        turn_s: Some(0.4),
        longest_s: Some(1.0),
        ..PitDriver::default()
    };
    let run = |end| {
        let ending =
            Ending { pit: Some(PitDriver { end: Some(end), ..driver }), ..Ending::default() };
        motion(&vehicle, &ending, VehicleState::driving_straight(20.0))
    };
    for &end in PitEnd::ALL {
        let motion = run(end);
        let steer = column(&motion, Channel::SteerFl);
        assert!(
            (steer[0] + 2.0 / 16.0 / 4.0).abs() < 1e-12,
            "a quarter is turned at first contact"
        );
        assert!((steer[60] + 2.0 / 16.0).abs() < 1e-12, "{}", steer[60]);
        let is_pushing = end == PitEnd::KeepPushing;
        assert_eq!(steer[150] == 0.0, !is_pushing, "{end:?}: {}", steer[150]);
        let vx = column(&motion, Channel::Vx);
        assert!((vx[95] - 20.0).abs() < 1.5, "{end:?}: {} m/s", vx[95]);
        let is_stopped = vx[799].abs() < 0.1;
        assert_eq!(is_stopped, end == PitEnd::Brake, "{end:?}: {} m/s", vx[799]);
    }
}

#[test]
fn the_driver_of_a_pit_ends_when_the_struck_car_has_turned() {
    let vehicle = Preset::Reference.parameters();
    let x = VehicleState::driving_straight(20.0);
    for (turn_rad, end, ends) in [
        (None, PitEnd::Brake, false),
        (Some(0.7), PitEnd::Brake, false),
        (Some(-0.8), PitEnd::Brake, true),
        (Some(0.8), PitEnd::Straighten, true),
        (Some(2.0), PitEnd::KeepPushing, false),
    ] {
        let driver = PitDriver { end: Some(end), ..PitDriver::default() };
        let mut state = PitState::default();
        let demand = state.sample(&driver.acting(), &vehicle, 1.0, &x, 0.1, turn_rad);
        assert_eq!(demand.steer_rad.unwrap() < 0.1, ends, "{turn_rad:?} {end:?}");
        assert_eq!(demand.brake.is_some(), ends && end == PitEnd::Brake, "{turn_rad:?} {end:?}");
    }
}

/// Motions with drivers are the same alone and beside others, those without are untouched, and paths
/// with longer steps come close.
#[test]
fn lanes_and_paths_have_the_drivers_of_a_single_motion() {
    let vehicle = Preset::Reference.parameters();
    let esc = Some(StabilityControl::default());
    let endings = [
        everything(),
        Ending::default(),
        Ending { esc, ..Ending::default() },
        Ending { countersteer: Some(Countersteer::default()), ..Ending::default() },
        Ending { pit: Some(PitDriver::default()), ..Ending::default() },
    ];
    let manoeuvres: Vec<Manoeuvre> = (0..15)
        .map(|i| manoeuvre(&vehicle, &endings[i % 5], pushed(0.2 + 0.07 * i as f64)))
        .collect();
    let runs: Vec<SimulationRun<'_>> =
        manoeuvres.iter().map(|manoeuvre| SimulationRun { vehicle: &vehicle, manoeuvre }).collect();
    let alone: Vec<Motion> = manoeuvres
        .iter()
        .map(|manoeuvre| vehicle.simulate(manoeuvre, Integrator::Rk4).unwrap())
        .collect();
    for (i, (motion, alone)) in simulate_batch(&runs).iter().zip(&alone).enumerate() {
        assert_eq!(motion.as_ref().unwrap(), alone, "run {i}");
    }
    let limit = PathLimit { distance_m: 1e4 };
    let ends = simulate_paths(&runs, limit, |_, path| path.points.last().copied().unwrap());
    for (i, (end, alone)) in ends.iter().zip(&alone).enumerate() {
        let [dx, dy] = [(end.x_m, Channel::X), (end.y_m, Channel::Y)]
            .map(|(value, channel)| value - last(alone, channel));
        assert!(dx.hypot(dy) < 1.0, "run {i}: {dx} {dy} m");
    }
}

/// What drivers and systems did, replayed as histories, gives nearly the same motion.
#[test]
fn applied_controls_are_those_of_the_motion() {
    let vehicle = Preset::Reference.parameters();
    let with_drivers = manoeuvre(&vehicle, &everything(), pushed(0.7));
    let controls = vehicle.applied_controls(&with_drivers).unwrap();
    assert!(controls.closed_loop.is_none() && controls.is_steered() && controls.wheels.is_some());
    let motion = vehicle.simulate(&with_drivers, Integrator::Rk4).unwrap();
    let replayed = Manoeuvre { controls, ..with_drivers.clone() };
    let replayed = vehicle.simulate(&replayed, Integrator::Rk4).unwrap();
    for (channel, tolerance) in [(Channel::X, 0.5), (Channel::Y, 0.5), (Channel::Yaw, 0.05)] {
        let difference = last(&motion, channel) - last(&replayed, channel);
        assert!(difference.abs() < tolerance, "{channel:?}: {difference}");
    }
    let steer = Some(SteerHistory { time_s: vec![0.0], steer_rad: vec![0.01] });
    let plain = Controls { steer, ..Controls::default() };
    let manoeuvre = Manoeuvre { controls: plain.clone(), ..with_drivers };
    assert_eq!(vehicle.applied_controls(&manoeuvre).unwrap(), plain);
}

#[test]
fn numbers_have_the_names_of_the_fields_and_draws_lie_in_their_ranges() {
    let z = |value: f64| (0..9).map(move |i| if i % 2 == 0 { value } else { -value });
    let array = |value: f64| std::array::from_fn::<f64, 9, _>(|i| z(value).nth(i).unwrap());
    for value in [-4.0, -1.0, 0.0, 1.0, 4.0] {
        let [a, b, c, d, e, f, g, ..] = array(value);
        let ending = Ending {
            esc: Some(StabilityControl::default().drawn([a, b, c, d, e, f, g])),
            countersteer: Some(Countersteer::default().drawn([a, b, c, d, e])),
            pit: Some(
                PitDriver { longest_s: Some(2.0), ..PitDriver::default() }.drawn([a, b, c, d, e]),
            ),
            brake: Some(Braking {
                abs: Some(AntiLock::default().drawn([a])),
                ..Braking::new(0.0, 1.0, 0.3)
            }),
            ..Ending::default()
        };
        let json = serde_json::to_value(&ending).unwrap();
        for (name, value, range) in ending.ranges() {
            assert!(range.contains(value), "{name} is {value}");
            let pointer = format!("/{}", name.replace('.', "/"));
            assert_eq!(
                json.pointer(&pointer).and_then(serde_json::Value::as_f64),
                Some(value),
                "{name}"
            );
        }
        assert_eq!(serde_json::from_value::<Ending>(json).unwrap(), ending);
    }
    let usual: Ending =
        serde_json::from_str(r#"{ "esc": {}, "countersteer": {}, "pit": {} }"#).unwrap();
    assert_eq!(usual.esc, Some(StabilityControl::default()));
    assert_eq!(usual.anti_lock(), Some(AntiLock::default()), "a stability control has one");
}

/// Nine of ten reaction times lie from 0.4 to 1.8 s, and a third of the systems never give up.
#[test]
fn draws_have_the_distributions_that_are_stated() {
    let n = 20_000;
    let quantile = |i: usize| crate::numerics::normal_quantile((i as f64 + 0.5) / n as f64);
    let share = |is_it: &dyn Fn(f64) -> bool| {
        (0..n).filter(|i| is_it(quantile(*i))).count() as f64 / n as f64
    };
    let delay = |z: f64| Countersteer::default().drawn([z, 0.0, 0.0, 0.0, 0.0]).delay_s.unwrap();
    assert!((delay(0.0) - 0.8).abs() < 1e-12);
    let within = share(&|z| (0.4..=1.8).contains(&delay(z)));
    assert!((within - 0.9).abs() < 2e-3, "{within}");
    let gives_up = |z: f64| {
        let drawn = StabilityControl::default().drawn([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, z]);
        drawn.gives_up_sideslip_rad.unwrap().to_degrees()
    };
    assert!((share(&|z| gives_up(z) > 89.0) - 1.0 / 3.0).abs() < 2e-3);
    assert!((share(&|z| (30.0..=60.01).contains(&gives_up(z))) - 2.0 / 3.0).abs() < 2e-3);
}

/// Also where it is the usual value.
#[test]
fn what_is_stated_of_a_driver_is_not_drawn() {
    let z = [1.3; ClosedLoop::N_DRAWN];
    let usual_rad_s = StabilityControl::default().acting().threshold_rad_s;
    let esc = StabilityControl { threshold_rad_s: Some(usual_rad_s), ..Default::default() };
    let usual = PitDriver::default().acting();
    let pit = PitDriver {
        steering_wheel_rad: Some(usual.steering_wheel_rad),
        end: Some(usual.end),
        ..PitDriver::default()
    };
    let countersteer = Countersteer { delay_s: Some(0.8), ..Countersteer::default() };
    let abs = AntiLock { share_of_peak: Some(0.95), ..AntiLock::default() };
    let stated = ClosedLoop {
        esc: Some(esc),
        pit: Some(pit),
        countersteer: Some(countersteer),
        abs: Some(abs),
        ..ClosedLoop::default()
    };
    let drawn = stated.drawn(z);
    let (of_esc, of_pit) = (drawn.esc.unwrap(), drawn.pit.unwrap());
    assert_eq!(of_esc.threshold_rad_s, esc.threshold_rad_s);
    assert_eq!((of_pit.steering_wheel_rad, of_pit.end), (pit.steering_wheel_rad, pit.end));
    assert_eq!(drawn.countersteer.unwrap().delay_s, Some(0.8));
    assert_eq!(drawn.abs, Some(abs));
    // Nothing of it is stated, and the draw is another value than the usual one.
    let acting = (of_esc.acting(), StabilityControl::default().acting());
    assert!(acting.0.dead_time_s != acting.1.dead_time_s, "{of_esc:?}");
    assert!(of_pit.turn_s.is_some_and(|turn_s| turn_s != usual.turn_s), "{of_pit:?}");
    let drawn = Phrase::joined(stated.distributions(), "; ");
    let words = drawn.say(&NumberFormat::default());
    for (of_what, is_drawn) in [
        ("threshold", false),
        ("dead time 0.1 to 0.2 s", true),
        ("anti-lock", false),
        ("after 0.4", false),
        ("gain on side slip", true),
        ("90 to 180 deg of the steering wheel", false),
        ("turned within 0.2 to 0.5 s", true),
        ("equally likely", false),
    ] {
        assert_eq!(words.contains(of_what), is_drawn, "{of_what}: {words}");
    }
    // It stood in English in German reports.
    let words = drawn.say(&NumberFormat { units: UnitSystem::Si, language: Language::De });
    for (of_what, is_drawn) in [
        ("Schwelle", false),
        ("Fahrdynamikregelung (ESC): ", true),
        ("Totzeit 0,1 bis 0,2 s", true),
        ("innerhalb von 0,2 bis 0,5 s", true),
    ] {
        assert_eq!(words.contains(of_what), is_drawn, "{of_what}: {words}");
    }
    let nothing = ClosedLoop {
        esc: Some(StabilityControl::default()),
        countersteer: Some(Countersteer::default()),
        ..ClosedLoop::default()
    };
    let drawn = nothing.drawn(z);
    assert!(drawn.esc.unwrap().threshold_rad_s.is_some_and(|value| value != usual_rad_s));
    assert!(drawn.countersteer.unwrap().delay_s.is_some_and(|value| value != 0.8));
    assert!(drawn.pit.is_none() && drawn.abs.is_none());
    assert_eq!(drawn.drawn([-0.4; ClosedLoop::N_DRAWN]), drawn, "a draw is not drawn again");
}

/// A driver of whom nothing but the side is stated.
#[test]
fn a_driver_who_is_drawn_turns_to_the_side_that_is_stated() {
    for (side, sign) in [(TurnSide::Left, 1.0), (TurnSide::Right, -1.0)] {
        let driver = PitDriver { side: Some(side), ..PitDriver::default() };
        let usual_rad = driver.acting().steering_wheel_rad;
        let drawn_rad = driver.drawn([1.3; PitDriver::N_DRAWN]).acting().steering_wheel_rad;
        assert!(usual_rad * sign > 0.0 && drawn_rad * sign > usual_rad * sign, "{side:?}");
    }
}

#[test]
fn stability_control_is_standard_from_the_year_of_the_law_on() {
    for (year, market, expected) in [
        (2011, Market::UnitedStates, false),
        (2012, Market::UnitedStates, true),
        (2014, Market::EuropeanUnion, false),
        (2015, Market::EuropeanUnion, true),
    ] {
        assert_eq!(esc_is_standard(year, market), expected, "{year} {market:?}");
    }
}

#[test]
fn the_reference_yaw_rate_is_that_of_a_car_that_does_not_oversteer() {
    let mut vehicle = Preset::Reference.parameters();
    let esc = StabilityControl::default().acting();
    let wheelbase_m = vehicle.geometry.wheelbase_m();
    let slow = esc.reference_yaw_rate_rad_s(&vehicle, 1.0, 0.01);
    assert!((slow * wheelbase_m / 0.01 - 1.0).abs() < 0.01, "{slow}");
    let limit = 0.85 * vehicle.tires.friction * 9.806_65 / 30.0;
    assert_eq!(esc.reference_yaw_rate_rad_s(&vehicle, 30.0, -0.3), -limit);
    vehicle.tires.cornering_coefficient_rear_per_rad *= 0.3;
    let neutral = esc.reference_yaw_rate_rad_s(&vehicle, 30.0, 0.001);
    assert!((neutral - 0.03 / wheelbase_m).abs() < 1e-12, "{neutral}");
}

/// English mixed “90°” with “500 deg/s” in one row.
#[test]
fn degrees_of_what_is_drawn_have_one_form_in_a_language() {
    let all = ClosedLoop {
        esc: Some(StabilityControl::default()),
        countersteer: Some(Countersteer::default()),
        pit: Some(PitDriver::default()),
        ..ClosedLoop::default()
    };
    let say = |language| {
        let format = NumberFormat { units: UnitSystem::Si, language };
        Phrase::joined(all.distributions(), "; ").say(&format)
    };
    let english = say(Language::En);
    for of_what in ["90 to 180 deg of", "30 to 90 deg", "30 to 60 deg", "180 to 540 deg", "deg/s"] {
        assert!(english.contains(of_what), "{of_what}: {english}");
    }
    assert!(!english.contains('°'), "{english}");
    let german = say(Language::De);
    assert!(german.contains('°') && !german.contains("deg"), "{german}");
}
