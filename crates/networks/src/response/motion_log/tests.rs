//! Logs of simulated scaled vehicles against what was simulated.

use std::path::Path;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use crate::response::{ForceOrigin, LogSettings, LoggedImpact, MotionLog};
use impactlab_core::collision::{Pulse, PulseShape};
use impactlab_core::data::{Channel, TimeSeries};
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, Integrator, Manoeuvre, Preset, VehicleParameters, VehicleState,
};

/// First contact, s.
const CONTACT_S: f64 = 0.2;
/// Of x and y, m; of the yaw, rad; of the yaw rate, rad/s.
const NOISE: [f64; 3] = [0.02, 0.008_727, 0.017_453];

fn truth_vehicle() -> VehicleParameters {
    let mut vehicle = Preset::ScaledStruck.parameters().with_friction(0.6);
    vehicle.mass.yaw_inertia_kg_m2 *= 1.2;
    vehicle
}

/// A right rear quarter struck to the left.
fn load() -> ContactLoad {
    let pulse = Pulse::new(PulseShape::HalfSine, [15.0, 120.0], CONTACT_S, 0.09).unwrap();
    let contact = ContactPoint { x_body_m: -0.7, y_body_m: -0.3, height_m: 0.126 };
    ContactLoad { force: pulse.to_history(1e-3).unwrap(), contact, recorded_moment: false }
}

fn simulated(
    vehicle: &VehicleParameters,
    load: Option<ContactLoad>,
    duration_s: f64,
) -> TimeSeries {
    let initial = VehicleState::driving_straight(6.0);
    let manoeuvre = Manoeuvre { initial, contact_load: load, duration_s, ..Manoeuvre::default() };
    vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap().series
}

/// Every `stride`-th sample with noise.
fn log(motion: &TimeSeries, stride: usize, seed: u64, channels: &[(Channel, f64)]) -> MotionLog {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let time_s = motion.time_s().iter().copied().step_by(stride).collect();
    let mut series = TimeSeries::new(time_s).unwrap();
    for (channel, std) in channels {
        let exact = motion.get(*channel).unwrap().iter().step_by(stride);
        let noisy = exact.map(|value| value + std * rng.sample::<f64, _>(StandardNormal));
        series.insert(*channel, noisy.collect()).unwrap();
    }
    MotionLog { path: Path::new("log.csv").to_owned(), series }
}

fn gnss_imu() -> Vec<(Channel, f64)> {
    let [position, yaw, yaw_rate] = NOISE;
    vec![
        (Channel::X, position),
        (Channel::Y, position),
        (Channel::Yaw, yaw),
        (Channel::YawRate, yaw_rate),
    ]
}

fn settings() -> LogSettings {
    let vehicle = Preset::ScaledStruck.parameters();
    LogSettings { vehicle, has_impact: true, impact_s: None, duration_s: 4.0 }
}

/// Root mean square errors of position along one axis, velocity along one axis, yaw, yaw rate.
fn errors(found: &LoggedImpact, motion: &TimeSeries) -> [f64; 4] {
    let at = |channel, time_s| {
        impactlab_core::numerics::interpolate(motion.time_s(), motion.get(channel).unwrap(), time_s)
            .unwrap()
    };
    let mut squares = [0.0; 4];
    for (i, state) in found.case.states.iter().enumerate() {
        let time_s = found.start_s + 0.01 * i as f64;
        let off = |channel, value: f64| (value - at(channel, time_s)).powi(2);
        squares[0] += (off(Channel::X, state.x_m) + off(Channel::Y, state.y_m)) / 2.0;
        squares[1] +=
            (off(Channel::Vx, state.vx_body_m_s) + off(Channel::Vy, state.vy_body_m_s)) / 2.0;
        squares[2] += off(Channel::Yaw, state.yaw_rad);
        squares[3] += off(Channel::YawRate, state.yaw_rate_rad_s);
    }
    squares.map(|sum| (sum / found.case.states.len() as f64).sqrt())
}

#[test]
fn smoothed_states_are_nearer_the_truth_than_the_samples() {
    // 100 samples each: 1 s at 100 Hz, 4 s at 25 Hz, where the grid lies between the samples.
    for (stride, duration_s, [of_position, of_yaw, of_rate]) in
        [(1, 0.99, [0.4, 0.25, 0.6]), (4, 3.96, [0.6, 0.4, 2.0])]
    {
        let motion = simulated(&truth_vehicle(), Some(load()), duration_s);
        for seed in 0..5 {
            let log = log(&motion, stride, seed, &gnss_imu());
            assert_eq!(log.series.n_samples(), 100);
            let found = LoggedImpact::from_log(&log, None, &settings()).unwrap();
            let [position, velocity, yaw, yaw_rate] = errors(&found, &motion);
            let case = format!("{stride} {seed}: {position} {velocity} {yaw} {yaw_rate}");
            assert!(position < of_position * NOISE[0] && yaw < of_yaw * NOISE[1], "{case}");
            assert!(velocity < 0.12 && yaw_rate < of_rate * NOISE[2], "{case}");
            let noise = found.noise;
            let known = [noise.position_m, noise.yaw_rad, noise.yaw_rate_rad_s.unwrap()];
            for (known, truth) in known.into_iter().zip(NOISE) {
                assert!((known / truth).ln().abs() < 0.3, "{case} {known} {truth}");
            }
        }
    }
}

#[test]
fn velocities_are_of_use() {
    let motion = simulated(&truth_vehicle(), Some(load()), 0.99);
    let mut channels = gnss_imu();
    let without =
        LoggedImpact::from_log(&log(&motion, 1, 0, &channels), None, &settings()).unwrap();
    channels.extend([(Channel::Vx, 0.03), (Channel::Vy, 0.03)]);
    let with = LoggedImpact::from_log(&log(&motion, 1, 0, &channels), None, &settings()).unwrap();
    let [without_m_s, with_m_s] = [&without, &with].map(|found| errors(found, &motion)[1]);
    assert!(with_m_s < 0.02 && with_m_s < 0.5 * without_m_s, "{with_m_s} {without_m_s}");
    let noise_m_s = with.noise.velocity_m_s.unwrap();
    assert!((noise_m_s / 0.03).ln().abs() < 0.25, "{noise_m_s}");
    // The impulse is what the other vehicle gave, not what the tires took.
    let [px, py] = with.impulse_n_s;
    assert!((px - 15.0).abs() < 10.0 && (py - 120.0).abs() < 15.0, "{px} {py}");
}

#[test]
fn contact_is_found_where_it_was_and_nowhere_else() {
    let truth = truth_vehicle();
    for seed in 0..5 {
        let motion = simulated(&truth, Some(load()), 1.5);
        let struck = log(&motion, 1, seed, &gnss_imu());
        let found = LoggedImpact::from_log(&struck, None, &settings()).unwrap();
        assert_eq!(found.force, ForceOrigin::Estimated);
        let [start_s, end_s] = found.contact_s.unwrap();
        assert!(
            (start_s - CONTACT_S).abs() < 0.05 && (end_s - 0.29).abs() < 0.06,
            "{start_s} {end_s}"
        );
        let known = LogSettings { impact_s: Some(0.21), ..settings() };
        assert_eq!(LoggedImpact::from_log(&struck, None, &known).unwrap().start_s, 0.21);
        let free = log(&simulated(&truth, None, 1.5), 1, seed, &gnss_imu());
        let found = LoggedImpact::from_log(&free, None, &settings()).unwrap();
        assert_eq!((found.force, found.contact_s, found.start_s), (ForceOrigin::None, None, 0.0));
        assert!(found.case.inputs.iter().all(|input| input.collision.is_none()));
    }
}

#[test]
fn a_motion_without_an_impact_has_no_force_wherever_it_is_lively() {
    let motion = simulated(&truth_vehicle(), Some(load()), 1.5);
    let struck = log(&motion, 1, 0, &gnss_imu());
    let drive = LogSettings { has_impact: false, ..settings() };
    let found = LoggedImpact::from_log(&struck, None, &drive).unwrap();
    assert_eq!((found.force, found.contact_s, found.start_s), (ForceOrigin::None, None, 0.0));
    assert!(found.case.inputs.iter().all(|input| input.collision.is_none()));
}

#[test]
fn a_recorded_force_keeps_its_impulse_and_its_clock() {
    let motion = simulated(&truth_vehicle(), Some(load()), 1.5);
    let log = log(&motion, 4, 0, &gnss_imu());
    let found = LoggedImpact::from_log(&log, Some(load()), &settings()).unwrap();
    assert_eq!(found.force, ForceOrigin::Recorded);
    assert!((found.start_s - CONTACT_S).abs() < 2e-3, "{}", found.start_s);
    let forces = found.case.inputs.iter().filter_map(|input| input.collision);
    let impulse: f64 = forces.map(|collision| collision.force_n[1] * 0.01).sum();
    assert!((impulse - 120.0).abs() < 1e-6, "{impulse}");
    assert_eq!(found.case.states.len(), found.case.inputs.len() + 1);
    // 1.48 s is the last of every fourth sample.
    assert_eq!(found.case.states.len(), 129);
}

#[test]
fn roll_is_the_models_where_it_was_not_recorded() {
    let motion = simulated(&Preset::ScaledStruck.parameters(), Some(load()), 1.5);
    let mut channels = gnss_imu();
    let trajectory = |channels: &[(Channel, f64)]| {
        let log = log(&motion, 1, 0, channels);
        LoggedImpact::from_log(&log, Some(load()), &settings()).unwrap()
    };
    let roll = |found: &LoggedImpact| {
        let truth = motion.get(Channel::Roll).unwrap();
        let states = found.case.states.iter().zip(truth.iter().skip(20));
        let square: f64 = states.map(|(state, roll)| (state.roll_rad - roll).powi(2)).sum();
        (square / found.case.states.len() as f64).sqrt()
    };
    let largest = motion.get(Channel::Roll).unwrap().iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let of_model = roll(&trajectory(&channels));
    assert!(of_model < 0.2 * largest, "{of_model} of {largest}");
    channels.push((Channel::Roll, 0.005));
    let recorded = roll(&trajectory(&channels));
    assert!(recorded < 0.5 * 0.005, "{recorded}");
}

#[test]
fn what_cannot_be_used_is_said() {
    let motion = simulated(&truth_vehicle(), Some(load()), 0.5);
    let log = log(&motion, 1, 0, &gnss_imu());
    let error = |settings: LogSettings| {
        LoggedImpact::from_log(&log, None, &settings).unwrap_err().to_string()
    };
    let late = LogSettings { impact_s: Some(0.45), ..settings() };
    assert!(error(late).starts_with("log.csv: 0.050 s of motion from the first contact at 0.45 s"));
    let outside = LogSettings { impact_s: Some(35.59), ..settings() };
    assert!(error(outside).contains("expected between 0 s and 0.5 s as the log"));
}
